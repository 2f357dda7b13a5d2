//! Reader of k-code (`.kc`), the format of the Kniterate, in its three dialects.
//!
//! Every pass becomes the instructions it stands for. Carriers come in before their first pass and go out after their
//! last, and where a pass without stitches brings them to their parking place; other moves of the carriage alone and of
//! a carrier leave no trace, since Knitout implies them.

use super::findings::Findings;
use super::{Input, Reader};
use crate::diag::{Code as Finding, Sink, Source, Sources, Span};
use crate::ir::machine::{Bed, CarrierSet, Code, Direction, Instruction, Needle, Rack};

/// This reader.
pub const READER: Reader = Reader {
    name: "kcode",
    extensions: &["kc", "kcode"],
    about: "machine code of the Kniterate, all three dialects",
    read: |source, _: &mut Sources<'_>, sink| read(source, sink).map(|code| Input::Code(Box::new(code))),
};

/// Characters of the margin at each side of a bed line.
const MARGIN: usize = 15;
/// Needles of a bed; one public writer makes lines one cell too wide.
const CELLS: usize = 252;

/// Reads a program; `None` with the reasons in the sink when a line cannot be understood.
pub fn read(source: &Source, sink: &mut Sink<'_>) -> Option<Code> {
    let found = Findings::new(source, sink)?;
    let text = found.text;
    let mut parser = Parser {
        found,
        fields: Fields::default(),
        rack: Rack::default(),
        last: None,
        steps: Vec::new(),
        home: false,
    };
    let mut rest = text;
    while !rest.is_empty() {
        let (line, next) = rest.split_once('\n').unwrap_or((rest, ""));
        rest = next;
        parser.line(line.strip_suffix('\r').unwrap_or(line));
    }
    parser.end();
    parser.found.end().then(|| assemble(&parser.steps))
}

/// What stands between two passes, or a pass.
enum Step<'a> {
    Remark(&'a str),
    Pause(&'a str),
    Pass(Box<Pass>),
}

/// One pass as it was written.
struct Pass {
    direction: Direction,
    /// Actions of the front and the back half of the type.
    kind: [Act; 2],
    /// 0 for none.
    carrier: u8,
    speed: f64,
    roller: f64,
    rack: Rack,
    /// Marked cells of both beds.
    cells: [Vec<i32>; 2],
    /// The carrier ends at its parking place.
    parked: bool,
    /// Stitch size at the first marked cell.
    size: Option<char>,
    span: Span,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Act {
    Knit,
    Tuck,
    Transfer,
    Receive,
}

#[derive(Default)]
struct Fields<'a> {
    values: [Option<&'a str>; 4],
}

const NAMES: [&str; 4] = ["FRNT:", "STIF:", "REAR:", "STIR:"];

struct Parser<'a, 's, 'o> {
    found: Findings<'a, 's, 'o>,
    fields: Fields<'a>,
    rack: Rack,
    last: Option<Direction>,
    steps: Vec<Step<'a>>,
    home: bool,
}

/// One bed line, taken apart.
struct BedLine<'a> {
    cells: Vec<i32>,
    /// Marks with their places.
    marks: Vec<(usize, char)>,
    text: &'a str,
}

impl<'a> Parser<'a, '_, '_> {
    fn line(&mut self, line: &'a str) {
        if line.trim().is_empty() {
        } else if let Some(comment) = line.strip_prefix("//") {
            self.steps.push(Step::Remark(comment));
        } else if line.trim() == "HOME" {
            self.home = true;
        } else if let Some(value) = line.strip_prefix("RACK:") {
            self.rack(value.trim());
        } else if let Some(field) = NAMES.iter().position(|name| line.starts_with(name)) {
            let value = line.get(NAMES.get(field).map_or(0, |name| name.len())..).unwrap_or_default();
            let place = self.fields.values.get_mut(field);
            if place.is_some_and(|place| place.replace(value).is_some()) {
                self.found.say(Finding::KcodePass, line, "the pass has this line twice", "");
            }
        } else if line.starts_with(">>") || line.starts_with("<<") {
            self.pass(line);
        } else if self.fields.values.iter().any(Option::is_some) {
            let help = "a pass is FRNT, STIF, REAR, STIR and a move such as `>> Kn-Kn 2 300 100`";
            self.found.say(Finding::KcodePass, line, "this line breaks a pass", help);
        } else {
            self.steps.push(Step::Pause(line.trim()));
        }
    }

    fn end(&mut self) {
        let end = self.found.text.get(self.found.text.len()..).unwrap_or_default();
        if self.fields.values.iter().any(Option::is_some) {
            self.found.say(Finding::KcodePass, end, "the file ends inside a pass", "");
        }
        if !self.home {
            let start = self.found.text.get(..0).unwrap_or_default();
            self.found.say(Finding::KcodeHead, start, "there is no HOME line at the top", "is this k-code?");
        }
    }

    fn rack(&mut self, value: &'a str) {
        let number = number(value.strip_prefix(['+']).unwrap_or(value));
        match number.and_then(Rack::from_needles) {
            Some(rack) if rack.0 % 2 == 0 => self.rack = rack,
            _ => self.found.say(
                Finding::KcodeNumber,
                value,
                "this is no rack",
                "racks are whole or half numbers of needles, as in `RACK:-1` or `RACK:0.5`",
            ),
        }
    }

    fn pass(&mut self, line: &'a str) {
        let fields = std::mem::take(&mut self.fields);
        let [Some(front), Some(front_sizes), Some(back), Some(back_sizes)] = fields.values else {
            let missing: Vec<&str> = NAMES
                .iter()
                .zip(fields.values)
                .filter(|(_, value)| value.is_none())
                .map(|(name, _)| *name)
                .collect();
            let message = format!("the pass lacks {}", missing.join(" "));
            return self.found.say(Finding::KcodePass, line, &message, "");
        };
        let Some((direction, kind, carrier, speed, roller)) = self.move_line(line) else { return };
        let (Some(front), Some(back)) = (self.bed(front), self.bed(back)) else { return };
        self.sizes(front_sizes);
        self.sizes(back_sizes);
        if front.marks != back.marks {
            self.found.say(Finding::KcodeMarks, back.text, "FRNT and REAR have different stop marks", "");
        }
        let Some(carrier) = self.carrier(carrier, &front, line) else { return };
        if self.last.is_none() && direction != Direction::Plus {
            self.found.say(
                Finding::KcodeDirection,
                line,
                "the first pass does not go right",
                "the carriage waits at the left",
            );
        }
        if self.last == Some(direction) {
            let help = "put a move of the carriage alone between: `<< Kn-Kn 0 300 0` with nothing marked";
            self.found.say(Finding::KcodeDirection, line, "two passes in a row go the same way", help);
        }
        self.last = Some(direction);
        let size = [(&front, front_sizes), (&back, back_sizes)].into_iter().find_map(|(bed, sizes)| {
            let cell = usize::try_from(*bed.cells.first()?).ok()?;
            sizes.as_bytes().get(MARGIN + cell).map(|&byte| char::from(byte))
        });
        let span = self.found.span(line);
        let rests = front.marks.iter().find(|(_, mark)| mark.is_ascii_digit()).map(|(at, _)| *at);
        let bare = front.cells.is_empty() && back.cells.is_empty();
        let parked = bare && direction == Direction::Minus && rests == parking(carrier);
        let pass = Pass {
            direction,
            kind,
            carrier,
            speed,
            roller,
            rack: self.rack,
            cells: [front.cells, back.cells],
            parked,
            size,
            span,
        };
        self.transfers(&pass, line);
        self.steps.push(Step::Pass(Box::new(pass)));
    }

    fn move_line(&mut self, line: &'a str) -> Option<(Direction, [Act; 2], u8, f64, f64)> {
        let help = "a move is `>> Kn-Kn 2 300 100`: direction, type, carrier, speed, roller";
        let words: Vec<&str> = line.split_ascii_whitespace().take(8).collect();
        let (direction, kind, carrier, speed, roller) = match *words.as_slice() {
            [direction, kind, carrier, speed, roller] => (direction, kind, carrier, speed, roller),
            [direction, kind, carrier, speed, roller, last] if number(last).is_some() => {
                (direction, kind, carrier, speed, roller)
            }
            _ => {
                self.found.say(
                    Finding::KcodeMove,
                    line,
                    "a move has five fields, or six in one dialect",
                    help,
                );
                return None;
            }
        };
        let direction = match direction {
            ">>" => Direction::Plus,
            "<<" => Direction::Minus,
            _ => {
                self.found.say(Finding::KcodeMove, direction, "this is no direction", help);
                return None;
            }
        };
        let receive = if direction == Direction::Plus { "Rr" } else { "Rl" };
        let act = |word: &str| match word {
            "Kn" => Some(Act::Knit),
            "Tu" => Some(Act::Tuck),
            "Tr" => Some(Act::Transfer),
            _ if word == receive => Some(Act::Receive),
            _ => None,
        };
        let acts = kind.split_once('-').and_then(|(front, back)| Some([act(front)?, act(back)?]));
        let forming = |act: Act| matches!(act, Act::Knit | Act::Tuck);
        let acts = acts.filter(|&[front, back]| {
            (forming(front) && forming(back))
                || [front, back] == [Act::Transfer, Act::Receive]
                || [front, back] == [Act::Receive, Act::Transfer]
        });
        let Some(acts) = acts else {
            let help =
                "types are Kn-Kn, Kn-Tu, Tu-Kn, Tu-Tu; to the right Tr-Rr, Rr-Tr, to the left Tr-Rl, Rl-Tr";
            self.found.say(Finding::KcodeMove, kind, "this type does not fit the direction", help);
            return None;
        };
        let numbers =
            carrier.parse::<u8>().ok().filter(|&carrier| carrier <= 6).zip(number(speed)).zip(number(roller));
        let Some(((carrier, speed), roller)) = numbers else {
            self.found.say(Finding::KcodeNumber, line, "carrier, speed or roller is out of range", help);
            return None;
        };
        Some((direction, acts, carrier, speed, roller))
    }

    fn bed(&mut self, text: &'a str) -> Option<BedLine<'a>> {
        let mut cells = Vec::new();
        let mut marks = Vec::new();
        let mut width = 0_usize;
        let mut fine = true;
        for letter in text.chars() {
            match letter {
                '/' | '\\' | '0'..='9' => marks.push((width, letter)),
                '.' | '_' | '-' => {
                    if letter == '-' {
                        cells.push(width as i32 - MARGIN as i32);
                    }
                    width += 1;
                }
                _ => fine = false,
            }
        }
        let bed = width.checked_sub(2 * MARGIN);
        if !fine || !matches!(bed, Some(CELLS | 253)) || !dots(text, width) {
            let message = format!(
                "a bed line has 15 dots, {CELLS} cells of `_` or `-`, and 15 dots; this one has {width} characters"
            );
            self.found.say(
                Finding::KcodeBed,
                text,
                &message,
                "stop marks (`/`, `\\`, digits) stand between and do not count",
            );
            return None;
        }
        if cells.last().is_some_and(|&cell| cell >= CELLS as i32) {
            self.found.say(Finding::KcodeBed, text, "a needle beyond the bed of 252 is marked", "");
            return None;
        }
        Some(BedLine { cells, marks, text })
    }

    fn sizes(&mut self, text: &'a str) {
        if !text.bytes().all(|byte| byte.is_ascii_digit() || byte.is_ascii_uppercase()) {
            self.found.say(Finding::KcodeBed, text, "stitch sizes are 0-9 and A-Z, one for each cell", "");
        } else if !matches!(text.len().checked_sub(2 * MARGIN), Some(CELLS | 253)) {
            let message = format!("{} stitch sizes do not match the bed line", text.len());
            self.found.say(Finding::KcodeSizes, text, &message, "");
        }
    }

    /// The carrier of a pass: the field, or the digits of the bed lines in the dialect where the field is always 0.
    fn carrier(&mut self, named: u8, bed: &BedLine<'a>, line: &'a str) -> Option<u8> {
        let mut digits = bed.marks.iter().filter_map(|&(_, mark)| mark.to_digit(10)).map(|digit| digit as u8);
        let first = digits.next();
        let odd =
            |digit: u8| !(1..=6).contains(&digit) || (named != 0 && digit != named) || Some(digit) != first;
        if first.is_some_and(odd) || digits.any(odd) {
            self.found.say(
                Finding::KcodeMarks,
                line,
                "the stop marks name another carrier than the move",
                "",
            );
            return None;
        }
        let stops = |mark: char| bed.marks.iter().filter(|(_, other)| *other == mark).count();
        if stops('/') > 1 || stops('\\') > 1 {
            self.found.say(Finding::KcodeMarks, bed.text, "the carriage stops twice at one side", "");
            return None;
        }
        Some(if named == 0 { first.unwrap_or(0) } else { named })
    }

    /// A transfer needs a whole rack, and its receiving needles marked.
    fn transfers(&mut self, pass: &Pass, line: &'a str) {
        let Some((_, source, target)) = direction_of_transfer(pass) else { return };
        if !pass.rack.is_whole() {
            let message = format!("at rack {} needles do not face each other", pass.rack);
            return self.found.say(Finding::KcodeTransfer, line, &message, "");
        }
        let by = shift(pass);
        let lost = source.iter().find(|&&cell| target.binary_search(&(cell + by)).is_err());
        if let (0, Some(cell)) = (pass.carrier, lost) {
            let message = format!("the needle that faces needle {} is not marked", cell + 1);
            self.found.say(Finding::KcodeTransfer, line, &message, "both needles of a transfer are marked");
        }
    }
}

/// Dots at both ends and none between.
fn dots(text: &str, width: usize) -> bool {
    let bare = text.bytes().filter(|byte| matches!(byte, b'.' | b'_' | b'-'));
    bare.enumerate().all(|(at, byte)| (byte == b'.') == (at < MARGIN || at + MARGIN >= width))
}

/// Source bed, marked sources and marked targets of a transfer or split.
fn direction_of_transfer(pass: &Pass) -> Option<(Bed, &[i32], &[i32])> {
    let [front, back] = &pass.cells;
    match pass.kind {
        [Act::Transfer, _] => Some((Bed::Front, front, back)),
        [_, Act::Transfer] => Some((Bed::Back, back, front)),
        _ => None,
    }
}

/// From the cell of a source to the cell that faces it.
fn shift(pass: &Pass) -> i32 {
    let whole = pass.rack.0 / 4;
    if pass.kind.first() == Some(&Act::Transfer) { -whole } else { whole }
}

fn number(text: &str) -> Option<f64> {
    let digits = text.strip_prefix('-').unwrap_or(text);
    let plain = !digits.is_empty()
        && digits.len() <= 12
        && digits.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.')
        && digits.bytes().next().is_some_and(|byte| byte.is_ascii_digit());
    if plain { text.parse().ok() } else { None }
}

/// Characters before the mark of a carrier that waits in its lane left of the bed.
fn parking(carrier: u8) -> Option<usize> {
    match carrier {
        1 => Some(4),
        2 | 3 => Some(6),
        4..=6 => Some(8),
        _ => None,
    }
}

/// The program that the passes stand for.
fn assemble(steps: &[Step<'_>]) -> Code {
    let mut code = Code::with_carriers((1..=6).map(|id| id.to_string()).collect());
    for (name, value) in [("Machine", "kniterate"), ("Gauge", "7"), ("Position", "Keep")] {
        code.set_header(name, value);
    }
    let mut last = [0_usize; 7];
    for (at, step) in steps.iter().enumerate() {
        if let Step::Pass(pass) = step
            && pass.cells.iter().any(|cells| !cells.is_empty())
            && let Some(last) = last.get_mut(usize::from(pass.carrier))
        {
            *last = at;
        }
    }
    let mut inside = [false; 7];
    let mut writer = Assembler { code, rack: Rack::default(), settings: [None, None, None, None] };
    for (at, step) in steps.iter().enumerate() {
        match step {
            Step::Remark(text) => writer.code.remark(*text),
            Step::Pause(words) => {
                let words = words.strip_prefix("pause").unwrap_or(words).trim_start_matches(':').trim();
                let text = writer.code.text(words);
                writer.code.push(Instruction::Pause(text), Span::NONE);
            }
            Step::Pass(pass) => {
                let id = usize::from(pass.carrier);
                let set = CarrierSet::one(pass.carrier.saturating_sub(1));
                let Some(inside) = inside.get_mut(id).filter(|_| id > 0) else {
                    writer.pass(pass, set);
                    continue;
                };
                if !*inside && pass.cells.iter().any(|cells| !cells.is_empty()) {
                    *inside = true;
                    writer.code.push(Instruction::In(set), pass.span);
                }
                writer.pass(pass, set);
                if *inside && (pass.parked || last.get(id) == Some(&at)) {
                    *inside = false;
                    writer.code.push(Instruction::Out(set), pass.span);
                }
            }
        }
    }
    writer.code
}

struct Assembler {
    code: Code,
    rack: Rack,
    /// Stitch, transfer stitch, speed and roller as they were last set.
    settings: [Option<String>; 4],
}

impl Assembler {
    fn set(&mut self, which: usize, name: &str, value: String, span: Span) {
        if let Some(known) = self.settings.get_mut(which)
            && known.as_deref() != Some(&value)
        {
            let text = self.code.text(format!("{name} {value}"));
            *known = Some(value);
            self.code.push(Instruction::Extension(text), span);
        }
    }

    fn pass(&mut self, pass: &Pass, carriers: CarrierSet) {
        if pass.cells.iter().all(Vec::is_empty) {
            return;
        }
        let span = pass.span;
        let moves = direction_of_transfer(pass).is_some() && pass.carrier == 0;
        if let Some(size) = pass.size {
            let (which, name) = if moves { (1, "x-xfer-stitch-number") } else { (0, "x-stitch-number") };
            self.set(which, name, size.to_string(), span);
        }
        if pass.carrier > 0 {
            self.set(2, "x-speed-number", pass.speed.to_string(), span);
            self.set(3, "x-roller-advance", pass.roller.to_string(), span);
        }
        if self.rack != pass.rack {
            self.rack = pass.rack;
            self.code.push(Instruction::Rack(pass.rack), span);
        }
        if let Some((bed, sources, targets)) = direction_of_transfer(pass) {
            let by = shift(pass);
            let mut order = sources.to_vec();
            if pass.direction == Direction::Minus {
                order.reverse();
            }
            for cell in order {
                let from = Needle::on(bed, cell + 1);
                let to = Needle::on(bed.other(), cell + by + 1);
                let instruction = if pass.carrier == 0 {
                    Instruction::Xfer(from, to)
                } else if targets.binary_search(&(cell + by)).is_ok() {
                    Instruction::Split(pass.direction, from, to, carriers)
                } else {
                    Instruction::Knit(pass.direction, from, carriers)
                };
                self.code.push(instruction, span);
            }
            return;
        }
        let [front, back] = &pass.cells;
        let mut needles: Vec<Needle> = front.iter().map(|cell| Needle::front(cell + 1)).collect();
        needles.extend(back.iter().map(|cell| Needle::back(cell + 1)));
        needles.sort_by_key(|needle| needle.place(pass.rack));
        if pass.direction == Direction::Minus {
            needles.reverse();
        }
        for needle in needles {
            let act = pass.kind[usize::from(needle.bed == Bed::Back)];
            self.code.push(
                match (pass.carrier, act) {
                    (0, _) => Instruction::Drop(needle),
                    (_, Act::Tuck) => Instruction::Tuck(pass.direction, needle, carriers),
                    _ => Instruction::Knit(pass.direction, needle, carriers),
                },
                span,
            );
        }
    }
}
