//! Profiles of `kind = "hand"`: what a crocheting hand or crafting machine makes, the constraints that the paper leaves to future work.

use crate::diag::{Code, Diagnostic, Sink, did_you_mean};
use crate::ir::verify::Verified;
use crate::ir::{Block, Direction, Kind, Op, Start};
use serde::Deserialize;
use std::collections::BTreeMap;

/// Words of `stitches` beside the abbreviations of the stitches.
const WORDS: [&str; 4] = ["inc", "dec", "ring", "turn"];
/// Findings of one limit that are reported one by one.
const SHOWN: usize = 10;

/// What can be made by hand rules. `FIELDS` of the profiles says what each field means.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(
    missing_docs,
    reason = "the fields are documented once, in FIELDS, which is also what the user sees"
)]
pub struct Hand {
    pub name: String,
    pub kind: HandKind,
    pub stitches: Vec<String>,
    #[serde(default)]
    pub max_increases: u32,
    #[serde(default)]
    pub max_decreases: u32,
    #[serde(default)]
    pub min_round: u32,
    #[serde(default)]
    pub max_round: u32,
    pub gauge: Option<Sizes>,
}

/// Sizes of a stitch that can be made, in millimeters: least and greatest.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields are documented once, in FIELDS")]
pub struct Sizes {
    pub width: [f64; 2],
    pub height: [f64; 2],
}

/// The one word of `kind`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum HandKind {
    /// Crochet, by hand or by a machine that works as a hand does.
    #[serde(rename = "hand")]
    Hand,
}

/// What a row does that a limit may forbid.
#[derive(Default)]
struct Use {
    /// The stitches go into a magic ring, which is no increase.
    ring: bool,
    increases: u64,
    decreases: u64,
    /// Words of the list that are needed, with the first stitch that needs each, from 1.
    words: BTreeMap<&'static str, u64>,
    stitches: u64,
}

impl Hand {
    /// What makes no sense in the profile.
    pub(super) fn fault(&self) -> Option<String> {
        let known = || Kind::ALL.iter().map(|kind| kind.us()).chain(WORDS);
        for word in &self.stitches {
            if !known().any(|other| other == word) {
                let near = did_you_mean(word, known());
                let near = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
                return Some(format!("`stitches` lists `{word}`, which is no US abbreviation{near}"));
            }
        }
        if self.max_round > 0 && self.max_round < self.min_round {
            return Some("`max_round` is less than `min_round`".to_owned());
        }
        let sound = |[least, most]: [f64; 2]| least > 0.0 && least <= most && most.is_finite();
        if self.gauge.is_some_and(|sizes| !(sound(sizes.width) && sound(sizes.height))) {
            return Some("`gauge` needs a least and a greatest width and height in millimeters".to_owned());
        }
        None
    }

    /// Tells every place where a pattern asks for more than can be made; true when there is none.
    pub fn makes(&self, program: &Verified<'_>, sink: &mut Sink<'_>) -> bool {
        let before = sink.errors();
        let mut report = Report { hand: self, sink, seen: BTreeMap::new() };
        if let (Some(sizes), Some(gauge)) = (self.gauge, program.gauge) {
            for (field, value, [least, most]) in
                [("gauge.width", gauge.width, sizes.width), ("gauge.height", gauge.height, sizes.height)]
            {
                if value < least || value > most {
                    report.say(
                        field,
                        Diagnostic::new(Code::BeyondMachine, format!("a stitch of {value:.2} mm")),
                        &format!("{least} to {most} mm"),
                    );
                }
            }
        }
        for (part, facts) in program.pattern.parts.iter().zip(&program.facts().parts) {
            let start = match part.start {
                Start::Ring { .. } => Some("ring"),
                Start::Chain { loops: 1.., .. } => Some("ch"),
                Start::Chain { .. } | Start::Join { .. } => None,
            };
            if let Some(word) = start
                && !self.lists(word)
            {
                let found = Diagnostic::new(Code::BeyondMachine, format!("the part begins with `{word}`"));
                report.say("stitches", found.in_round(&part.name, Some(1)), &self.stitches.join(", "));
            }
            if let Start::Ring { loops: loops @ 1.. } = part.start {
                report.round(&part.name, 1, loops, crate::diag::Span::NONE);
            }
            for (row, facts) in part.rows.iter().zip(&facts.rows) {
                let ring = matches!(part.start, Start::Ring { loops: 0 }) && facts.number == 1;
                let mut used = Use { ring, ..Use::default() };
                used.block(&row.body, 1);
                report.row(&part.name, facts.number, &used, row.span);
                report.round(&part.name, facts.number, facts.produces, row.span);
            }
        }
        report.end();
        sink.errors() == before
    }

    fn lists(&self, word: &str) -> bool {
        self.stitches.iter().any(|known| known == word)
    }
}

struct Report<'r, 's> {
    hand: &'r Hand,
    sink: &'r mut Sink<'s>,
    seen: BTreeMap<&'static str, usize>,
}

impl Report<'_, '_> {
    fn say(&mut self, field: &'static str, found: Diagnostic, limit: &str) {
        let seen = self.seen.entry(field).or_default();
        *seen += 1;
        if *seen <= SHOWN {
            self.sink.push(found.help(format!("`{field}` of `{}` is {limit}", self.hand.name)));
        }
    }

    fn row(&mut self, part: &str, round: u32, used: &Use, span: crate::diag::Span) {
        let found = |message: String| {
            Diagnostic::new(Code::BeyondMachine, message).in_round(part, Some(round)).at(span, "")
        };
        for (word, stitch) in &used.words {
            if !self.hand.lists(word) {
                let list = self.hand.stitches.join(", ");
                self.say("stitches", found(format!("stitch {stitch} needs `{word}`")), &list);
            }
        }
        let (increases, decreases) = (self.hand.max_increases, self.hand.max_decreases);
        if increases > 0 && used.increases > u64::from(increases) {
            let found = found(format!("{} increases in one round", used.increases));
            self.say("max_increases", found, &increases.to_string());
        }
        if decreases > 0 && used.decreases > u64::from(decreases) {
            let found = found(format!("{} decreases in one round", used.decreases));
            self.say("max_decreases", found, &decreases.to_string());
        }
    }

    fn round(&mut self, part: &str, round: u32, loops: u32, span: crate::diag::Span) {
        let (least, most) = (self.hand.min_round, self.hand.max_round);
        let (field, limit) = if loops < least {
            ("min_round", least)
        } else if most > 0 && loops > most {
            ("max_round", most)
        } else {
            return;
        };
        let message = format!("the round has {loops} stitches");
        let found = Diagnostic::new(Code::BeyondMachine, message).in_round(part, Some(round));
        self.say(field, found.at(span, ""), &limit.to_string());
    }

    fn end(self) {
        for (field, seen) in self.seen {
            if let Some(more @ 1..) = seen.checked_sub(SHOWN) {
                let message = format!("{more} more places beyond `{field}`");
                self.sink.push(Diagnostic::new(Code::BeyondMachine, message));
            }
        }
    }
}

impl Use {
    fn need(&mut self, word: &'static str) {
        let stitch = self.stitches + 1;
        self.words.entry(word).or_insert(stitch);
    }

    fn block(&mut self, block: &Block, times: u64) {
        for op in block.ops() {
            match op {
                Op::Work { stitch, times: run } => {
                    let run = u64::from(*run).saturating_mul(times);
                    self.need(stitch.kind.us());
                    if stitch.makes > stitch.works && stitch.kind != Kind::Ch && !self.ring {
                        self.need("inc");
                        self.increases = self.increases.saturating_add(run);
                    } else if stitch.works > stitch.makes && stitch.kind != Kind::Skip {
                        self.need("dec");
                        self.decreases = self.decreases.saturating_add(run);
                    }
                    self.stitches = self.stitches.saturating_add(run);
                }
                Op::Repeat { body, times: again } => {
                    self.block(body, times.saturating_mul(u64::from(*again)));
                }
                Op::Turn(to) => {
                    if *to == Direction::Back {
                        self.need("turn");
                    }
                }
                Op::Hold { .. } | Op::Leave { .. } | Op::Color(_) => {}
            }
        }
    }
}
