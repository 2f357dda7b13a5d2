//! The chart of a machine program: every pass of the carriage as a line of needles on both beds, with what each does.
//!
//! It is read upward. A pass is drawn as knitters draw it: a dot for each needle, the back bed above the front bed and
//! moved by the rack, the yarn between the beds with its loops around the needles, transfers as arrows from bed to bed.

use super::pen::{Escaped, N, P, Path};
use super::sheet::ACCENT;
use crate::ir::machine::passes::{Job, Passes, job};
use crate::ir::machine::{Bed, CarrierSet, Code, Direction, Instruction, Needle, Rack};
use crate::lower::machine::Origin;
use std::fmt::Write as _;

/// Most operations that a chart shows.
pub const MAX_OPERATIONS: usize = 100_000;

/// From needle to needle.
const STEP: f64 = 13.0;
/// From pass to pass.
const LINE: f64 = 38.0;
/// The beds above and below the yarn.
const BED: f64 = 8.0;
/// Repeats of passes are told in one up to this length.
const LONGEST: usize = 12;
/// Colors of yarns, by carrier.
const YARNS: [&str; 6] = ["#1f5fa8", "#b8500f", "#2b7a4b", "#7a3fa0", "#a02c48", "#5a5a1e"];

/// Operations that one run of the carriage does together, and what is said before them.
#[derive(Debug, PartialEq)]
struct Pass {
    job: Option<Job>,
    rack: Rack,
    ops: Vec<Instruction>,
    /// Carriers brought in, let go or taken out before.
    notes: Vec<String>,
}

/// A pass where it stands in the program.
struct Placed {
    pass: Pass,
    /// The number of the pass, from 1.
    number: usize,
    /// Comments before it: parts, waste, bind-off.
    heads: Vec<String>,
    /// Part and round of the pattern.
    round: Option<(u32, u32)>,
}

/// Passes that are worked several times.
struct Run {
    from: usize,
    length: usize,
    times: usize,
}

/// Draws a program; `origins` are the stitches that its operations stand for, where that is known.
pub(super) fn draw(name: &str, code: &Code, origins: Option<&[Origin]>) -> String {
    let passes = passes(code, origins);
    let runs = runs(&passes);
    let places =
        || passes.iter().flat_map(|placed| placed.pass.ops.iter().map(|op| spots(op, placed.pass.rack)));
    let ends = places().flatten().fold(None, |ends: Option<(f64, f64)>, (_, x)| {
        let (low, high) = ends.unwrap_or((x, x));
        Some((low.min(x), high.max(x)))
    });
    let (first, last) = ends.unwrap_or((0.0, 0.0));
    let mut sheet = Sheet { first, last, y: 0.0, body: String::new(), code, widest: 0.0 };
    let mut shown = None;
    for run in &runs {
        let (floor, slice) = (sheet.y, passes.get(run.from..run.from + run.length).unwrap_or_default());
        let end = passes.get(run.from + run.length * run.times - 1).and_then(|placed| placed.round);
        for (nth, placed) in slice.iter().enumerate() {
            for head in &placed.heads {
                sheet.head(head);
            }
            let label = match (placed.round, end) {
                (Some((_, first)), Some((_, last))) if run.times > 1 && nth == 0 && first < last => {
                    Some(format!("Rnds {first}-{last}"))
                }
                (Some((_, round)), _) if placed.round != shown => Some(format!("Rnd {round}")),
                _ => None,
            };
            shown = placed.round.or(shown);
            sheet.pass(placed, label);
        }
        if run.times > 1 {
            sheet.bracket(floor, run.times);
            shown = end;
        }
    }
    sheet.finish(name, passes.len())
}

/// The passes of a program.
fn passes(code: &Code, origins: Option<&[Origin]>) -> Vec<Placed> {
    let mut merging = Passes::default();
    let mut found: Vec<Placed> = Vec::new();
    let (mut rack, mut number) = (Rack::default(), 0);
    let (mut notes, mut heads) = (Vec::new(), Vec::new());
    let mut comments = code.comments.iter().peekable();
    for (at, op) in code.ops().iter().enumerate() {
        while let Some(comment) = comments.next_if(|comment| comment.at as usize <= at) {
            if !comment.trailing && !comment.text.trim().is_empty() {
                heads.push(comment.text.trim().to_owned());
            }
        }
        let begins = merging.add(op, rack);
        match op {
            Instruction::Rack(to) => rack = *to,
            Instruction::In(set)
            | Instruction::InHook(set)
            | Instruction::ReleaseHook(set)
            | Instruction::Out(set)
            | Instruction::OutHook(set) => notes.push(format!("{} {}", op.opcode(), carriers(code, set))),
            Instruction::Pause(text) => {
                let words = code.texts.get(*text as usize).map_or("", String::as_str);
                notes.push(format!("pause {words}").trim_end().to_owned());
            }
            Instruction::Stitch(..) | Instruction::Extension(_) => {}
            Instruction::Knit(..)
            | Instruction::Tuck(..)
            | Instruction::Split(..)
            | Instruction::Drop(_)
            | Instruction::Amiss(_)
            | Instruction::Xfer(..)
            | Instruction::Miss(..) => {
                if begins || found.is_empty() {
                    number += 1;
                    let round = origins
                        .and_then(|origins| origins.get(at))
                        .filter(|origin| origin.round > 0)
                        .map(|origin| (origin.part, origin.round));
                    let (notes, heads) = (std::mem::take(&mut notes), std::mem::take(&mut heads));
                    // Without yarn there is no direction to show.
                    let job = job(op)
                        .map(|(job, _)| job)
                        .filter(|job| !matches!(job, Job::Form(_, set) if set.is_empty()));
                    let pass = Pass { job, rack, ops: Vec::new(), notes };
                    found.push(Placed { pass, number, heads, round });
                }
                if let Some(placed) = found.last_mut() {
                    placed.pass.ops.push(*op);
                }
            }
        }
    }
    if !notes.is_empty() || !heads.is_empty() {
        let pass = Pass { job: None, rack, ops: Vec::new(), notes };
        found.push(Placed { pass, number, heads, round: None });
    }
    found
}

fn carriers(code: &Code, set: &CarrierSet) -> String {
    set.iter().map(|id| code.carrier(*id)).collect::<Vec<_>>().join(" ")
}

/// Finds passes that are worked again and again: the shortest such group at each place.
fn runs(passes: &[Placed]) -> Vec<Run> {
    let same = |a: usize, b: usize| match (passes.get(a), passes.get(b)) {
        (Some(a), Some(b)) => a.pass == b.pass && b.heads.is_empty(),
        _ => false,
    };
    let (mut runs, mut at) = (Vec::new(), 0);
    while at < passes.len() {
        let found = (1..=LONGEST).find_map(|length| {
            let equal = (at + length..passes.len()).take_while(|k| same(k - length, *k)).count();
            let times = equal / length + 1;
            (times > 2 || (times == 2 && length > 1)).then_some(Run { from: at, length, times })
        });
        let run = found.unwrap_or(Run { from: at, length: 1, times: 1 });
        at += run.length * run.times;
        runs.push(run);
    }
    runs
}

/// The needles of an operation with their places; those of the back bed are moved by the rack.
fn spots(op: &Instruction, rack: Rack) -> impl Iterator<Item = (Needle, f64)> {
    op.needles().map(move |needle| (needle, spot(needle, rack)))
}

fn spot(needle: Needle, rack: Rack) -> f64 {
    let moved = if needle.bed == Bed::Back { rack.needles() } else { 0.0 };
    f64::from(needle.index) + moved
}

struct Sheet<'c> {
    /// The outermost places.
    first: f64,
    last: f64,
    /// How high the drawing is so far.
    y: f64,
    body: String,
    code: &'c Code,
    /// How far words reach right of the needles.
    widest: f64,
}

impl Sheet<'_> {
    fn x(&self, place: f64) -> f64 {
        (place - self.first) * STEP
    }

    fn at(&self, needle: Needle, rack: Rack) -> P {
        let off = if needle.bed == Bed::Back { BED } else { -BED };
        P(self.x(spot(needle, rack)), -self.y - 0.5 * LINE - off)
    }

    fn words(&mut self, x: f64, y: f64, look: &str, words: &str) {
        text(&mut self.body, P(x, y), look, words);
    }

    /// A line of words above what was drawn.
    fn head(&mut self, words: &str) {
        self.words(0.0, -self.y - 6.0, " font-weight=\"bold\"", words);
        self.widest = self.widest.max(words.chars().count() as f64 * 6.6 - self.x(self.last));
        self.y += 20.0;
    }

    fn pass(&mut self, placed: &Placed, round: Option<String>) {
        let Placed { pass, number, .. } = placed;
        if !pass.notes.is_empty() {
            let notes = pass.notes.join(", ");
            self.words(0.0, -self.y - 5.0, " font-size=\"9\" fill-opacity=\".7\"", &notes);
            self.y += 14.0;
        }
        let middle = -self.y - 0.5 * LINE;
        if let Some(round) = round {
            self.words(-62.0, middle + 4.0, " text-anchor=\"end\" font-weight=\"bold\"", &round);
        }
        if pass.ops.is_empty() {
            return;
        }
        let _ = writeln!(self.body, "<g><title>pass {number}: {}</title>", Escaped(&self.title(pass)));
        self.needles(pass.rack, middle);
        let mut strokes = Path::default();
        let mut ends: Option<(f64, f64)> = None;
        for op in &pass.ops {
            self.sign(op, pass.rack, middle, &mut strokes, &mut ends);
        }
        let (color, way) = match pass.job {
            Some(Job::Form(direction, set)) => {
                let color = YARNS[set.first().map_or(0, |id| usize::from(*id) % YARNS.len())];
                if let Some((low, high)) = ends {
                    strokes.line(P(low - 5.0, middle), P(high + 5.0, middle));
                }
                (color, Some((direction, carriers(self.code, &set))))
            }
            Some(Job::Transfer(_) | Job::Drop) | None => (ACCENT, None),
        };
        let _ = writeln!(
            self.body,
            "<path fill=\"none\" stroke=\"{color}\" stroke-width=\"1.4\" stroke-linecap=\"round\" d=\"{}\"/>",
            strokes.data()
        );
        self.words(
            -24.0,
            middle + 4.0,
            " text-anchor=\"end\" font-size=\"9\" fill-opacity=\".6\"",
            &number.to_string(),
        );
        let right = self.x(self.last) + 14.0;
        let words = match (&way, pass.rack == Rack::default()) {
            (Some((Direction::Minus, carriers)), _) => format!("\u{2190} {carriers}"),
            (Some((Direction::Plus, carriers)), _) => format!("\u{2192} {carriers}"),
            (None, true) => String::new(),
            (None, false) => format!("rack {}", pass.rack),
        };
        if !words.is_empty() {
            self.words(right, middle + 4.0, &format!(" font-size=\"10\" fill=\"{color}\""), &words);
            self.widest = self.widest.max(14.0 + words.chars().count() as f64 * 6.0);
        }
        self.body.push_str("</g>\n");
        self.y += LINE;
    }

    /// What a pass does, in words.
    fn title(&self, pass: &Pass) -> String {
        let mut counts: Vec<(&str, u64)> = Vec::new();
        for op in &pass.ops {
            let opcode = op.opcode();
            match counts.iter_mut().find(|(known, _)| *known == opcode) {
                Some((_, count)) => *count += 1,
                None => counts.push((opcode, 1)),
            }
        }
        let mut words: Vec<String> =
            counts.iter().map(|(opcode, count)| format!("{count} {opcode}")).collect();
        if let Some(Job::Form(direction, set)) = pass.job {
            let way = if direction == Direction::Plus { "right" } else { "left" };
            words.push(format!("carrier {} to the {way}", carriers(self.code, &set)));
        }
        if pass.rack != Rack::default() {
            words.push(format!("rack {}", pass.rack));
        }
        words.join(", ")
    }

    /// A dot for each needle of both beds.
    fn needles(&mut self, rack: Rack, middle: f64) {
        for (y, moved) in [(middle - BED, rack.needles().rem_euclid(1.0)), (middle + BED, 0.0)] {
            let from = self.first.ceil() - 1.0 + moved;
            let count = (self.last - from).floor().max(0.0);
            let _ = write!(
                self.body,
                "<path class=\"needles\" d=\"M{} {}h{}\"/>",
                N(self.x(from)),
                N(y),
                N((count + 1.0).max(1.0) * STEP)
            );
        }
        self.body.push('\n');
    }

    /// One operation; `ends` are those of the yarn.
    fn sign(
        &mut self,
        op: &Instruction,
        rack: Rack,
        middle: f64,
        strokes: &mut Path,
        ends: &mut Option<(f64, f64)>,
    ) {
        let mut along = |x: f64| {
            let (low, high) = ends.unwrap_or((x, x));
            *ends = Some((low.min(x), high.max(x)));
        };
        match *op {
            Instruction::Knit(_, needle, set) if !set.is_empty() => {
                let at = self.at(needle, rack);
                along(at.0);
                knit(at, middle, strokes);
            }
            Instruction::Split(_, from, to, set) if !set.is_empty() => {
                let at = self.at(from, rack);
                along(at.0);
                knit(at, middle, strokes);
                arrow(at, self.at(to, rack), strokes);
            }
            Instruction::Tuck(_, needle, _) => {
                let at = self.at(needle, rack);
                along(at.0);
                tuck(at, middle, strokes);
            }
            Instruction::Miss(_, needle, _) => along(self.at(needle, rack).0),
            Instruction::Xfer(from, to) | Instruction::Split(_, from, to, _) => {
                arrow(self.at(from, rack), self.at(to, rack), strokes);
            }
            Instruction::Knit(_, needle, _) | Instruction::Drop(needle) | Instruction::Amiss(needle) => {
                cross(self.at(needle, rack), strokes);
            }
            Instruction::In(_)
            | Instruction::InHook(_)
            | Instruction::ReleaseHook(_)
            | Instruction::Out(_)
            | Instruction::OutHook(_)
            | Instruction::Stitch(..)
            | Instruction::Rack(_)
            | Instruction::Pause(_)
            | Instruction::Extension(_) => {}
        }
    }

    /// Tells how often the passes since a height are worked.
    fn bracket(&mut self, floor: f64, times: usize) {
        let x = self.x(self.last) + 62.0;
        let _ = writeln!(
            self.body,
            "<path fill=\"none\" stroke=\"currentColor\" d=\"M{} {}h5v{}h-5\"/>",
            N(x),
            N(-floor - 4.0),
            N(floor + 8.0 - self.y)
        );
        self.words(x + 10.0, -0.5 * (floor + self.y) + 4.0, " font-weight=\"bold\"", &format!("x {times}"));
        self.widest = self.widest.max(62.0 + 50.0);
    }

    fn finish(self, name: &str, passes: usize) -> String {
        let (left, legend) = (120.0, legend());
        let width = (left + self.x(self.last) + self.widest + 24.0).max(left + 520.0);
        let name = Escaped(name);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"picot-chart\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" \
             role=\"img\" aria-labelledby=\"chart-title chart-desc\" font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" \
             font-size=\"11\" color=\"#1d1d1f\">\n<title id=\"chart-title\">{name}: needles</title>\n\
             <desc id=\"chart-desc\">Machine chart. {passes} passes on needles {2} to {3}.</desc>\n\
             <style>.needles{{fill:none;stroke:#9a958c;stroke-width:2.4;stroke-linecap:round;stroke-dasharray:0 {STEP}}}</style>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n\
             <g fill=\"currentColor\" transform=\"translate({4} {5})\">\n{6}{legend}</g>\n</svg>\n",
            N(width.ceil()),
            N((self.y + 120.0).ceil()),
            self.first.ceil(),
            self.last.floor(),
            N(left),
            N(self.y + 20.0),
            self.body
        )
    }
}

fn text(out: &mut String, at: P, look: &str, words: &str) {
    let _ = writeln!(out, "<text x=\"{}\" y=\"{}\"{look}>{}</text>", N(at.0), N(at.1), Escaped(words));
}

/// The signs and how the chart is read, below the drawing.
fn legend() -> String {
    let (mut strokes, mut words) = (Path::default(), String::new());
    let y = 36.0;
    for (name, x) in [("knit", 0.0), ("tuck", 78.0), ("transfer", 156.0), ("drop", 258.0)] {
        let at = P(x + 4.0, y - BED);
        match name {
            "knit" => knit(at, y, &mut strokes),
            "tuck" => tuck(at, y, &mut strokes),
            "transfer" => arrow(P(at.0, y + BED), at, &mut strokes),
            _ => cross(at, &mut strokes),
        }
        text(&mut words, P(x + 20.0, y + 1.0), "", name);
    }
    let lines = [
        "Read upward. A line is one pass of the carriage: the dots are needles, those of the back bed above, moved by",
        "the rack; the yarn runs between the beds. Left is the number of the pass, right its direction and carrier.",
    ];
    for (line, sentence) in lines.into_iter().enumerate() {
        text(&mut words, P(0.0, y + 34.0 + 15.0 * line as f64), " font-size=\"10\"", sentence);
    }
    format!(
        "<g id=\"legend\">\n<path fill=\"none\" stroke=\"currentColor\" stroke-width=\"1.4\" stroke-linecap=\"round\" \
         d=\"{}\"/>\n{words}</g>\n",
        strokes.data()
    )
}

/// A loop around a needle.
fn knit(at: P, middle: f64, strokes: &mut Path) {
    let up = (at.1 - middle).signum();
    let (left, right) = (P(at.0 - 2.0, middle), P(at.0 + 2.0, middle));
    let (wide_left, wide_right) = (P(at.0 - 4.4, at.1), P(at.0 + 4.4, at.1));
    strokes.curve(left, P(at.0 + 1.0, at.1 - 3.0 * up), wide_left);
    strokes.curve(wide_left, P(at.0, at.1 + 9.0 * up), wide_right);
    strokes.curve(wide_right, P(at.0 - 1.0, at.1 - 3.0 * up), right);
}

/// Loops that go over to the other bed.
fn arrow(from: P, to: P, strokes: &mut Path) {
    let up = (to.1 - from.1).signum();
    strokes.line(from, to);
    for side in [-2.6, 2.6] {
        strokes.line(to, P(to.0 + side, to.1 - 4.0 * up));
    }
}

/// A loop laid on a needle.
fn tuck(at: P, middle: f64, strokes: &mut Path) {
    let top = P(at.0, at.1 + (at.1 - middle).signum());
    strokes.line(P(at.0 - 4.5, middle), top);
    strokes.line(top, P(at.0 + 4.5, middle));
}

/// A needle that lets go of its loops.
fn cross(P(x, y): P, strokes: &mut Path) {
    strokes.line(P(x - 3.5, y - 3.5), P(x + 3.5, y + 3.5));
    strokes.line(P(x - 3.5, y + 3.5), P(x + 3.5, y - 3.5));
}
