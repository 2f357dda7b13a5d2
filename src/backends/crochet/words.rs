//! The words of a row: clauses, repeats and direction marks as `grammar/crochet.ebnf` has them.

use super::{Arrows, Terms};
use crate::ir::{Block, Direction, Entry, Kind, Op, Part, Program, Step, Stitch};
use std::fmt::Write as _;

/// How rows are put into words.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Words<'p> {
    pub(crate) program: &'p Program,
    pub(crate) terms: Terms,
    pub(crate) arrows: Arrows,
    /// A stitch other than single crochet is about, so that `inc` alone would not say of what.
    pub(crate) mixed: bool,
}

impl<'p> Words<'p> {
    /// The words for a part.
    pub(crate) fn new(program: &'p Program, part: &Part, terms: Terms, arrows: Arrows) -> Self {
        Self { program, terms, arrows, mixed: part.rows.iter().any(|row| mixed(&row.body)) }
    }

    /// A row, folded as it is.
    pub(crate) fn row(&self, block: &Block) -> String {
        let mut line = Line::default();
        for op in block.ops() {
            self.op(op, &mut line);
        }
        line.text
    }

    /// A row with runs counted and nothing else folded.
    pub(crate) fn plain_row(&self, block: &Block) -> String {
        let mut line = Line::default();
        let mut run: Option<(Stitch, u32)> = None;
        for step in block.steps() {
            match (step, &mut run) {
                (Step::Work(stitch), Some((same, times))) if stitch == *same => *times += 1,
                (step, _) => {
                    if let Some((stitch, times)) = run.take() {
                        self.op(&Op::Work { stitch, times }, &mut line);
                    }
                    match step {
                        Step::Work(stitch) => run = Some((stitch, 1)),
                        Step::Turn(direction) => self.op(&Op::Turn(direction), &mut line),
                        Step::Hold { loops, by } => self.op(&Op::Hold { loops, by }, &mut line),
                        Step::Leave { loops } => self.op(&Op::Leave { loops }, &mut line),
                        Step::Color(color) => self.op(&Op::Color(color), &mut line),
                    }
                }
            }
        }
        if let Some((stitch, times)) = run {
            self.op(&Op::Work { stitch, times }, &mut line);
        }
        line.text
    }

    fn op(&self, op: &Op, line: &mut Line) {
        match op {
            Op::Work { stitch, times } => {
                let words = self.clause(*stitch, *times);
                let sign = line.direction == Direction::Back && self.arrows != Arrows::Words;
                line.clause(if sign { "-" } else { "" });
                line.text.push_str(&words);
            }
            Op::Repeat { body, times } => {
                line.clause("(");
                line.open = true;
                body.ops().iter().for_each(|op| self.op(op, line));
                let _ = write!(line.text, ") x {times}");
                line.open = false;
            }
            Op::Turn(direction) => {
                line.direction = *direction;
                line.mark(match (self.arrows, direction) {
                    (Arrows::Unicode, Direction::Back) => "←",
                    (Arrows::Unicode, Direction::Forward) => "→",
                    (Arrows::Ascii, Direction::Back) => "<-",
                    (Arrows::Ascii, Direction::Forward) => "->",
                    (Arrows::Words, _) => return line.clause("turn"),
                });
            }
            Op::Hold { loops, by } => {
                let part = self.program.pattern.parts.get(by.0 as usize).map_or("?", |part| &part.name);
                line.clause("");
                let _ =
                    write!(line.text, "hold {loops} {} for {}", stitches(*loops), super::rows::name(part));
            }
            Op::Leave { loops } => {
                line.clause("");
                let _ = write!(line.text, "leave last {loops} {} unworked", stitches(*loops));
            }
            Op::Color(color) => {
                line.clause(if line.text.is_empty() { "with " } else { "change to " });
                line.text.push_str(&super::rows::color(self.program, *color));
            }
        }
    }

    /// `6 sc`, `inc`, `2 hdc2tog`.
    pub(crate) fn clause(&self, stitch: Stitch, times: u32) -> String {
        let loops = u64::from(times) * u64::from(stitch.works);
        if stitch.kind == Kind::Skip {
            return format!("{} {loops}", self.base(Kind::Skip));
        }
        if stitch.kind == Kind::Ch {
            let made = u64::from(times) * u64::from(stitch.makes);
            return match made {
                0 => format!("ch {times}"),
                1 => "ch 1 (counts as 1 st)".to_owned(),
                _ => format!("ch {times} (counts as {made} sts)"),
            };
        }
        if stitch.kind == Kind::SlSt && stitch.works + stitch.makes == 0 {
            return "join with sl st".to_owned();
        }
        let (name, place) = self.stitch(stitch);
        let entry = match stitch.entry {
            Entry::Both => "",
            Entry::Front => " FLO",
            Entry::Back => " BLO",
            Entry::Space => " in next ch-1 sp",
        };
        let count = if times == 1 { String::new() } else { format!("{times} ") };
        format!("{count}{name}{entry}{place}")
    }

    /// Name of a stitch, and where it goes when that is not the next loop.
    fn stitch(&self, stitch: Stitch) -> (String, &'static str) {
        let base = self.base(stitch.kind);
        let plain = !self.mixed && stitch.kind == Kind::Sc;
        let own = (stitch.kind.works(), stitch.kind.makes());
        let name = match (stitch.works, stitch.makes) {
            arity if arity == own => base.to_owned(),
            (1, 2) if plain => "inc".to_owned(),
            (1, 2) => format!("{base} inc"),
            (1, makes) if plain && makes > 2 => format!("inc{makes}"),
            (1, makes) if makes > 2 => format!("{base} inc{makes}"),
            (2, 1) if plain => "dec".to_owned(),
            (works, 1) if works > 1 => format!("{base}{works}tog"),
            (0, 1) => return (base.to_owned(), " in same st"),
            (works, makes) => super::rows::special(stitch.kind, works, makes),
        };
        (name, "")
    }

    /// Abbreviation of a kind in the terms of the text.
    pub(crate) fn base(&self, kind: Kind) -> &'static str {
        match self.terms {
            Terms::Us => kind.us(),
            Terms::Uk => kind.uk(),
        }
    }
}

fn stitches(count: u32) -> &'static str {
    if count == 1 { "st" } else { "sts" }
}

/// True when something else than single crochet is worked.
fn mixed(block: &Block) -> bool {
    block.ops().iter().any(|op| match op {
        Op::Work { stitch, .. } => !matches!(stitch.kind, Kind::Sc | Kind::Skip | Kind::Ch | Kind::SlSt),
        Op::Repeat { body, .. } => mixed(body),
        Op::Turn(_) | Op::Hold { .. } | Op::Leave { .. } | Op::Color(_) => false,
    })
}

/// A line under way.
#[derive(Default)]
struct Line {
    text: String,
    /// A bracket or a mark was just written, so no comma comes.
    open: bool,
    direction: Direction,
}

impl Line {
    fn clause(&mut self, start: &str) {
        if !self.text.is_empty() && !self.open {
            self.text.push_str(", ");
        }
        self.open = false;
        self.text.push_str(start);
    }

    fn mark(&mut self, mark: &str) {
        if !self.text.is_empty() && !self.open {
            self.text.push(' ');
        }
        self.text.push_str(mark);
        self.text.push(' ');
        self.open = true;
    }
}
