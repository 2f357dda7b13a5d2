//! Reader of Knitout (`.k`), document version 0.6: header, every operation, extensions; comments are kept.
//!
//! What one line alone can tell is checked here; what takes the machine's state is found by `ir::machine::check`.

use super::findings::Findings;
use super::{Input, Reader};
use crate::diag::{Code as Finding, Sink, Source, Sources, did_you_mean};
use crate::ir::machine::{
    CarrierId, CarrierSet, Code, Comment, Direction, Header, Instruction, MAX_CARRIERS, MAX_NEEDLE, Needle,
    Rack,
};
use std::collections::{BTreeMap, BTreeSet};

/// This reader.
pub const READER: Reader = Reader {
    name: "knitout",
    extensions: &["k", "knitout"],
    about: "machine code for V-bed knitting machines, version 2",
    read: |source, _: &mut Sources<'_>, sink| read(source, sink).map(|code| Input::Code(Box::new(code))),
};

/// The version of the magic line that is fully known.
const VERSION: u32 = 2;

const OPCODES: &[&str] = &[
    "in",
    "inhook",
    "releasehook",
    "out",
    "outhook",
    "stitch",
    "rack",
    "knit",
    "tuck",
    "split",
    "drop",
    "amiss",
    "xfer",
    "miss",
    "pause",
];

/// Reads a program; `None` with the reasons in the sink when a line cannot be understood.
pub fn read(source: &Source, sink: &mut Sink<'_>) -> Option<Code> {
    let mut reader = Parser {
        found: Findings::new(source, sink)?,
        code: Code::default(),
        names: BTreeMap::new(),
        open_carriers: true,
        unknown: BTreeSet::new(),
    };
    reader.file();
    reader.found.end().then_some(reader.code)
}

struct Parser<'a, 's, 'o> {
    found: Findings<'a, 's, 'o>,
    code: Code,
    names: BTreeMap<&'a str, CarrierId>,
    /// No `Carriers` header: carriers are taken as they come.
    open_carriers: bool,
    unknown: BTreeSet<&'a str>,
}

impl<'a> Parser<'a, '_, '_> {
    fn file(&mut self) {
        let text = self.found.text;
        let mut rest = text;
        let mut returns = false;
        let (mut first, mut in_header) = (true, true);
        while !rest.is_empty() || first {
            let (line, next) = rest.split_once('\n').unwrap_or((rest, ""));
            rest = next;
            let bare = line.strip_suffix('\r').unwrap_or(line);
            if bare.len() < line.len() && !returns {
                returns = true;
                let help = "save the file with LF line ends".to_owned();
                self.found.say(Finding::CarriageReturns, bare, "lines end in CR LF".to_owned(), &help);
            }
            if first {
                first = false;
                self.magic(bare);
                if bare.starts_with(";;") {
                    in_header = self.header(bare);
                }
            } else {
                in_header = in_header && self.header(bare);
                if !in_header {
                    self.line(bare);
                }
            }
        }
        if self.open_carriers {
            let help = "add `;;Carriers: 1 2 3 4 5 6` below the first line, with the carriers of the machine";
            let start = text.get(..0).unwrap_or_default();
            let message = "the header does not name the carriers".to_owned();
            self.found.say(Finding::CarriersHeaderMissing, start, message, help);
        }
    }

    fn magic(&mut self, line: &'a str) {
        let version = line.strip_prefix(";!knitout-").map(str::trim_end).filter(|digits| {
            !digits.is_empty() && digits.len() < 10 && digits.bytes().all(|byte| byte.is_ascii_digit())
        });
        if let Some(version) = version.and_then(|digits| digits.parse().ok()) {
            self.code.version = version;
            if version > VERSION {
                let message = format!("knitout-{version} is newer than knitout-{VERSION}");
                self.found.say(Finding::NewerKnitout, line, message, "it is read as version 2");
            }
        } else {
            let help = "the first line must be `;!knitout-2`";
            self.found.say(Finding::KnitoutMagic, line, "this is no Knitout file".to_owned(), help);
        }
    }

    /// Takes a line of the comment header; false when the header has ended.
    fn header(&mut self, line: &'a str) -> bool {
        let Some(content) = line.strip_prefix(";;") else { return false };
        let Some((name, value)) = content.split_once(": ") else {
            let message = "this line ends the header".to_owned();
            self.found.say(Finding::MalformedHeader, line, message, "a header is `;;NAME: VALUE`");
            return false;
        };
        let known = matches!(name, "Carriers" | "Machine" | "Gauge" | "Position" | "Width")
            || name.starts_with("Yarn-")
            || name.starts_with("X-");
        if !known {
            let message = format!("header `{name}` is not known");
            self.found.say(Finding::UnknownHeader, line, message, "it is kept and ignored");
        }
        if self.code.header(name).is_some() {
            let message = format!("header `{name}` is given twice");
            self.found.say(Finding::DuplicateHeader, line, message, "the last one counts");
        }
        let span = self.found.span(line);
        self.code.headers.push(Header { name: name.to_owned(), value: value.trim().to_owned(), span });
        if name == "Carriers" {
            self.carriers(value);
        }
        true
    }

    fn carriers(&mut self, value: &'a str) {
        self.names.clear();
        self.code.carriers.clear();
        self.open_carriers = false;
        for rail in value.split_whitespace() {
            for name in rail.split([',', ';']).filter(|name| !name.is_empty()) {
                if self.names.contains_key(name) {
                    let message = format!("carrier `{name}` is named twice");
                    self.found.say(Finding::RepeatedCarrier, name, message, "");
                } else if !self.add_carrier(name) {
                    return;
                }
            }
        }
    }

    fn add_carrier(&mut self, name: &'a str) -> bool {
        if self.code.carriers.len() >= MAX_CARRIERS {
            let message = format!("more than {MAX_CARRIERS} carriers");
            self.found.say(Finding::TooLarge, name, message, "");
            return false;
        }
        self.names.insert(name, self.code.carriers.len() as CarrierId);
        self.code.carriers.push(name.to_owned());
        true
    }

    fn line(&mut self, line: &'a str) {
        let (operation, comment) = match line.split_once(';') {
            Some((operation, comment)) => (operation, Some(comment)),
            None => (line, None),
        };
        let mut words = operation.split_ascii_whitespace();
        let Some(opcode) = words.next() else {
            if let Some(comment) = comment {
                self.late_header(line, comment);
                self.code.remark(comment);
            }
            return;
        };
        if let Some(comment) = comment {
            let at = self.code.ops().len() as u32;
            self.code.comments.push(Comment { at, trailing: true, text: comment.to_owned() });
        }
        if let Some(instruction) = self.operation(opcode, words, operation) {
            let trimmed = operation.trim_ascii();
            let span = self.found.span(trimmed);
            self.code.push(instruction, span);
        }
    }

    fn late_header(&mut self, line: &'a str, comment: &'a str) {
        let name = comment.strip_prefix(';').and_then(|content| content.split_once(": "));
        let is_name = |name: &str| {
            name.starts_with(|first: char| first.is_ascii_alphabetic())
                && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'-')
        };
        if let Some((name, _)) = name
            && is_name(name)
        {
            let message = format!("`{name}` stands after the header and is not read");
            let help = "move it up: the header ends at the first line that does not begin with `;;`";
            self.found.say(Finding::LateHeader, line, message, help);
        }
    }

    fn operation(
        &mut self,
        opcode: &'a str,
        words: std::str::SplitAsciiWhitespace<'a>,
        line: &'a str,
    ) -> Option<Instruction> {
        let mut arguments = Arguments { parser: self, words, opcode, line };
        let instruction = match opcode {
            "knit" => {
                let (direction, needle) = arguments.place()?;
                Instruction::Knit(direction, needle, arguments.carriers()?)
            }
            "tuck" => {
                let (direction, needle) = arguments.place()?;
                Instruction::Tuck(direction, needle, arguments.carriers()?)
            }
            "miss" => {
                let (direction, needle) = arguments.place()?;
                Instruction::Miss(direction, needle, arguments.carriers()?)
            }
            "split" => {
                let (direction, needle) = arguments.place()?;
                let to = arguments.needle()?;
                Instruction::Split(direction, needle, to, arguments.carriers()?)
            }
            "xfer" => {
                let from = arguments.needle()?;
                let to = arguments.needle()?;
                Instruction::Xfer(from, to)
            }
            "drop" => Instruction::Drop(arguments.needle()?),
            "amiss" => Instruction::Amiss(arguments.needle()?),
            "rack" => Instruction::Rack(arguments.rack()?),
            "stitch" => {
                let leading = arguments.number()?;
                let trailing = arguments.number()?;
                Instruction::Stitch(leading, trailing)
            }
            "in" => Instruction::In(arguments.carriers()?),
            "inhook" => Instruction::InHook(arguments.carriers()?),
            "releasehook" => Instruction::ReleaseHook(arguments.carriers()?),
            "out" => Instruction::Out(arguments.carriers()?),
            "outhook" => Instruction::OutHook(arguments.carriers()?),
            "pause" => {
                let words = line.trim_ascii().strip_prefix("pause").unwrap_or_default().trim_ascii();
                return Some(Instruction::Pause(self.code.text(words)));
            }
            _ if opcode.starts_with("x-") => {
                return Some(Instruction::Extension(self.code.text(line.trim_ascii())));
            }
            _ => {
                self.unknown_operation(opcode);
                return None;
            }
        };
        arguments.end()?;
        Some(instruction)
    }

    fn unknown_operation(&mut self, opcode: &'a str) {
        let lower = opcode.to_ascii_lowercase();
        let help = match OPCODES.iter().find(|known| **known == lower) {
            Some(known) => format!("opcodes are lower case: `{known}`"),
            None => did_you_mean(&lower, OPCODES.iter().copied()).map_or_else(
                || "extensions begin with `x-`".to_owned(),
                |known| format!("did you mean `{known}`?"),
            ),
        };
        self.found.say(Finding::UnknownOperation, opcode, format!("there is no operation `{opcode}`"), &help);
    }

    fn carrier(&mut self, name: &'a str) -> Option<CarrierId> {
        if let Some(&id) = self.names.get(name) {
            return Some(id);
        }
        if self.open_carriers {
            return self.add_carrier(name).then(|| self.names.get(name).copied()).flatten();
        }
        if self.unknown.insert(name) {
            let help = format!("the header names {}", self.code.carriers.join(" "));
            let message = format!("carrier `{name}` is not in the header");
            self.found.say(Finding::UnknownCarrier, name, message, &help);
        }
        None
    }
}

/// The arguments of one operation.
struct Arguments<'p, 'a, 's, 'o> {
    parser: &'p mut Parser<'a, 's, 'o>,
    words: std::str::SplitAsciiWhitespace<'a>,
    opcode: &'a str,
    line: &'a str,
}

impl<'a> Arguments<'_, 'a, '_, '_> {
    fn next(&mut self, what: &str) -> Option<&'a str> {
        let word = self.words.next();
        if word.is_none() {
            let message = format!("`{}` lacks its {what}", self.opcode);
            self.parser.found.say(Finding::WrongArguments, self.line.trim_ascii(), message, self.usage());
        }
        word
    }

    fn usage(&self) -> &'static str {
        match self.opcode {
            "knit" => "it is written `knit + f10 1`: direction, needle, carriers",
            "tuck" => "it is written `tuck + f10 1`: direction, needle, carriers",
            "miss" => "it is written `miss + f10 1`: direction, needle, carriers",
            "split" => "it is written `split + f10 b10 1`: direction, needle, facing needle, carriers",
            "xfer" => "it is written `xfer f10 b10`: needle, facing needle",
            "stitch" => "it is written `stitch 3 4`: two numbers",
            "rack" => "it is written `rack -1`: one number",
            "drop" | "amiss" => "it takes one needle, as in `drop f10`",
            _ => "",
        }
    }

    fn end(&mut self) -> Option<()> {
        let Some(word) = self.words.next() else { return Some(()) };
        let message = format!("`{}` takes no more after that", self.opcode);
        self.parser.found.say(Finding::WrongArguments, word, message, self.usage());
        None
    }

    fn place(&mut self) -> Option<(Direction, Needle)> {
        let word = self.next("direction")?;
        let direction = match word {
            "+" => Direction::Plus,
            "-" => Direction::Minus,
            _ => {
                let message = format!("`{word}` is no direction");
                self.parser.found.say(Finding::BadDirection, word, message, self.usage());
                return None;
            }
        };
        Some((direction, self.needle()?))
    }

    fn needle(&mut self) -> Option<Needle> {
        let word = self.next("needle")?;
        let needle = Needle::parse(word).filter(|needle| needle.index.abs() <= MAX_NEEDLE);
        if needle.is_none() {
            let message = format!("`{word}` is no needle");
            let help = "a needle is f, b, fs or bs and a number, such as f10, at most 32767";
            self.parser.found.say(Finding::BadNeedle, word, message, help);
        }
        needle
    }

    fn number(&mut self) -> Option<f64> {
        let word = self.next("number")?;
        let value = number(word);
        if value.is_none() {
            let message = format!("`{word}` is no number");
            self.parser.found.say(Finding::BadMachineNumber, word, message, self.usage());
        }
        value
    }

    fn rack(&mut self) -> Option<Rack> {
        let word = self.next("number")?;
        let Some(needles) = number(word) else {
            let message = format!("`{word}` is no number");
            self.parser.found.say(Finding::BadMachineNumber, word, message, self.usage());
            return None;
        };
        let rack = Rack::from_needles(needles);
        if rack.is_none() {
            let message = format!("no machine racks to {word}");
            let help = "racks are multiples of a quarter needle, such as 1, -2 or 0.25";
            self.parser.found.say(Finding::BadMachineNumber, word, message, help);
        }
        rack
    }

    fn carriers(&mut self) -> Option<CarrierSet> {
        let mut set = CarrierSet::default();
        let mut fine = true;
        for word in self.words.by_ref() {
            let Some(id) = self.parser.carrier(word) else {
                fine = false;
                continue;
            };
            if set.contains(&id) {
                let message = format!("carrier `{word}` is named twice");
                self.parser.found.say(Finding::RepeatedCarrier, word, message, "");
                fine = false;
            } else if !set.push(id) {
                let message = format!("more than {} carriers in one operation", set.len());
                self.parser.found.say(Finding::TooLarge, word, message, "");
                return None;
            }
        }
        fine.then_some(set)
    }
}

/// A decimal number as the format writes it: no exponent, no infinity.
fn number(word: &str) -> Option<f64> {
    let digits = word.strip_prefix(['+', '-']).unwrap_or(word);
    let plain = digits.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.')
        && digits.bytes().any(|byte| byte.is_ascii_digit())
        && word.len() <= 32;
    if plain { word.parse().ok() } else { None }
}
