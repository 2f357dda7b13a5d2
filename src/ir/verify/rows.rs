//! The loops of a part, row by row.

use super::facts::{CHAIN, yarn};
use super::{PartFacts, RowFacts};
use crate::diag::{Code, Diagnostic, Severity, Sink, Span};
use crate::ir::{Block, Direction, Kind, MAX_ROW, Op, Part, Row, Segment, Start, Stitch};

/// Follows the loops through all rows of a part; faults go to the sink.
pub(super) fn check(part: &Part, generated: bool, sink: &mut Sink<'_>) -> PartFacts {
    let mut facts = PartFacts { start: part.start.loops(), ..PartFacts::default() };
    (facts.stitches, facts.yarn) = begin(&part.start);
    facts.rows.reserve_exact(part.rows.len());
    let mut hook = Hook { own: u64::from(facts.start), beyond: 0, other_side: 0 };
    let mut faulty: Option<&Row> = None;
    let mut below = Span::NONE;
    for (number, row) in part.numbered_rows() {
        let (mut done, mut counts) = (0, RowFacts::default());
        while done < row.times {
            let mut tally = Tally::over(hook.loops(), &row.body);
            if let Some(before) = faulty.take()
                && !hook.fits(&tally, part.flat)
            {
                // One fault is told once: this row may rest on the count that was stated below, or on the row as meant.
                let stated = before.stated.map(|(count, _)| u64::from(count));
                let meant = (tally.consumed() + tally.left as i64).max(0) as u64;
                hook =
                    Hook { own: stated.filter(|count| *count == meant).unwrap_or(meant), beyond: 0, ..hook };
                tally = Tally::over(hook.loops(), &row.body);
            }
            let at = At { part, row, number: number.saturating_add(done), hook, below, generated };
            if !at.judge(&tally, sink) {
                faulty = Some(row);
            }
            counts = tally.facts(number, hook.loops());
            let next = hook.after(&tally, part.flat);
            let rounds = if next == hook && faulty.is_none() { row.times - done } else { 1 };
            facts.stitches = facts.stitches.saturating_add(u64::from(counts.stitches) * u64::from(rounds));
            facts.yarn = facts.yarn.saturating_add(counts.yarn.saturating_mul(u64::from(rounds)));
            hook = next;
            done += rounds;
            if faulty.is_some() {
                break;
            }
        }
        counts.total = facts.stitches;
        facts.rows.push(counts);
        below = row.span;
    }
    facts.open = (hook.loops() + hook.other_side).min(u64::from(u32::MAX)) as u32;
    facts
}

/// The open loops between two rows.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Hook {
    /// Loops that the row before made or, in a round, left for this one.
    own: u64,
    /// Loops further on that earlier flat rows left.
    beyond: u64,
    /// Loops that earlier flat rows left on the side where the next row ends.
    other_side: u64,
}

impl Hook {
    fn loops(self) -> u64 {
        self.own + self.beyond
    }

    /// True when the row uses up the loops it has to, or says what it leaves.
    fn fits(self, tally: &Tally, flat: bool) -> bool {
        let accounted = tally.consumed() + tally.left as i64;
        let loops = self.loops() as i64;
        if flat { (self.own as i64..=loops).contains(&accounted) } else { accounted == loops }
    }

    fn after(self, tally: &Tally, flat: bool) -> Self {
        let made = tally.produced().max(0) as u64;
        let rest = self.loops().saturating_sub(tally.consumed().max(0) as u64);
        if flat {
            Self { own: made, beyond: self.other_side, other_side: rest }
        } else {
            Self { own: made + rest, beyond: 0, other_side: 0 }
        }
    }
}

/// Stitches and yarn of a start.
fn begin(start: &Start) -> (u64, u64) {
    match start {
        Start::Ring { loops } => (u64::from(*loops), u64::from(*loops) * 100),
        Start::Chain { loops, .. } => (0, u64::from(*loops) * CHAIN),
        Start::Join { segments } => {
            let chains = segments.iter().map(|segment| match segment {
                Segment::Chain { loops } => u64::from(*loops),
                Segment::Open { .. } | Segment::Held { .. } | Segment::Surface { .. } => 0,
            });
            (0, chains.sum::<u64>() * CHAIN)
        }
    }
}

/// The first thing that goes wrong within a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fault {
    Exhausted,
    Behind { works: u64, behind: i64 },
    Unbalanced(Direction),
    EmptyPass,
    AfterLeave,
    LeaveBack,
}

/// Loops and counts while a row is worked. Signed, so that a fault does not hide the totals.
struct Tally {
    ahead: i64,
    behind: i64,
    direction: Direction,
    forward: (u64, u64),
    back: (u64, u64),
    /// Loops that the current back pass has worked.
    pass: u64,
    longest: u64,
    longest_at: Span,
    /// Loops of the last back pass that are still ahead.
    raised: i64,
    spanning: Option<Span>,
    held: u64,
    left: u64,
    ended: bool,
    stitches: u64,
    tiles: u64,
    short_rows: u64,
    yarn: u64,
    fault: Option<(Fault, Span)>,
}

impl Tally {
    fn over(loops: u64, body: &Block) -> Self {
        let mut tally = Self {
            ahead: loops as i64,
            behind: 0,
            direction: Direction::Forward,
            forward: (0, 0),
            back: (0, 0),
            pass: 0,
            longest: 0,
            longest_at: Span::NONE,
            raised: 0,
            spanning: None,
            held: 0,
            left: 0,
            ended: false,
            stitches: 0,
            tiles: 0,
            short_rows: 0,
            yarn: 0,
            fault: None,
        };
        tally.block(body);
        tally
    }

    fn block(&mut self, block: &Block) {
        for (op, span) in block.spanned() {
            if self.ended && !matches!(op, Op::Color(_)) {
                self.fail(Fault::AfterLeave, span);
            }
            match op {
                Op::Work { stitch, times } => self.work(*stitch, u64::from(*times), span),
                Op::Repeat { body, times } => (0..*times).for_each(|_| self.block(body)),
                Op::Turn(direction) => self.turn(*direction, span),
                Op::Hold { loops, .. } => {
                    self.held += u64::from(*loops);
                    self.take(u64::from(*loops), span);
                }
                Op::Leave { loops } => {
                    self.left += u64::from(*loops);
                    self.ended = true;
                    if self.direction == Direction::Back {
                        self.fail(Fault::LeaveBack, span);
                    }
                }
                Op::Color(_) => {}
            }
        }
    }

    fn work(&mut self, stitch: Stitch, times: u64, span: Span) {
        let (works, makes) = (u64::from(stitch.works), u64::from(stitch.makes));
        self.stitches += if stitch.kind == Kind::Skip { 0 } else { times };
        self.tiles += times;
        self.yarn += yarn(stitch) * times;
        match self.direction {
            Direction::Forward => {
                // A run of stitches that work several loops spans the step when it passes it unevenly.
                let passes = (works * times) as i64 > self.raised;
                if works > 1 && passes && self.raised % works as i64 != 0 {
                    self.spanning.get_or_insert(span);
                }
                self.take(works * times, span);
                self.behind += (makes * times) as i64;
                self.forward.0 += works * times;
                self.forward.1 += makes * times;
            }
            Direction::Back => {
                self.pass += works * times;
                if self.behind < (works * times) as i64 {
                    let (works, behind) =
                        (self.pass, self.pass as i64 + self.behind - (works * times) as i64);
                    self.fail(Fault::Behind { works, behind }, span);
                }
                self.behind -= (works * times) as i64;
                self.ahead += (makes * times) as i64;
                self.raised += (makes * times) as i64;
                self.back.0 += works * times;
                self.back.1 += makes * times;
                if self.pass > self.longest {
                    (self.longest, self.longest_at) = (self.pass, span);
                }
            }
        }
    }

    fn take(&mut self, loops: u64, span: Span) {
        self.ahead -= loops as i64;
        self.raised = (self.raised - loops as i64).max(0);
        if self.ahead < 0 {
            self.fail(Fault::Exhausted, span);
        }
    }

    fn turn(&mut self, direction: Direction, span: Span) {
        self.tiles += 1;
        if self.direction == direction {
            self.fail(Fault::Unbalanced(direction), span);
        } else if direction == Direction::Forward && self.pass == 0 {
            self.fail(Fault::EmptyPass, span);
        }
        if direction == Direction::Back {
            (self.pass, self.raised) = (0, 0);
            self.short_rows += 1;
        }
        self.direction = direction;
    }

    fn fail(&mut self, fault: Fault, span: Span) {
        self.fault.get_or_insert((fault, span));
    }

    /// Loops of the row below that are used up.
    fn consumed(&self) -> i64 {
        self.forward.0 as i64 - self.back.1 as i64 + self.held as i64
    }

    /// Loops that the row leaves made.
    fn produced(&self) -> i64 {
        self.forward.1 as i64 - self.back.0 as i64
    }

    fn facts(&self, number: u32, below: u64) -> RowFacts {
        let clip = |count: u64| count.min(u64::from(u32::MAX)) as u32;
        RowFacts {
            number,
            below: clip(below),
            consumes: clip(self.consumed().max(0) as u64),
            produces: clip(self.produced().max(0) as u64),
            left: clip(self.left),
            held: clip(self.held),
            stitches: clip(self.stitches),
            tiles: clip(self.tiles),
            short_rows: clip(self.short_rows),
            longest: clip(self.longest),
            total: 0,
            yarn: self.yarn,
        }
    }
}

/// A row in its place, for what is said about it.
struct At<'p> {
    part: &'p Part,
    row: &'p Row,
    number: u32,
    hook: Hook,
    below: Span,
    generated: bool,
}

impl At<'_> {
    /// Reports the first fault of the row; true when there is none.
    fn judge(&self, tally: &Tally, sink: &mut Sink<'_>) -> bool {
        if let Some(diagnostic) = self.fault(tally) {
            sink.push(diagnostic);
            return false;
        }
        let loops = self.hook.loops();
        if tally.longest * 10 > loops * 6 {
            let message = format!("a back pass of {} stitches in {} of {loops}", tally.longest, self.name());
            let help = "short rows of at most 0.6 of the round lie flat and are easy to count";
            sink.push(self.diagnostic(Code::BackPassLong, message, tally.longest_at).help(help));
        }
        if let Some(span) = tally.spanning {
            let message = format!("{} works loops on both sides of a turn together", self.name());
            let mut diagnostic = self.diagnostic(Code::SpansTurn, message, span);
            if self.generated {
                diagnostic.severity = Severity::Error;
            }
            sink.push(diagnostic.help("shape one stitch before or after the turn"));
            return !self.generated;
        }
        true
    }

    fn fault(&self, tally: &Tally) -> Option<Diagnostic> {
        let loops = self.hook.loops();
        if let Some((fault, span)) = tally.fault {
            return Some(self.within(fault, span, tally));
        }
        if tally.direction == Direction::Back {
            let message = format!("{} ends while working back", self.name());
            let help = "turn forward again and work over the short row: `18 sc <- -8 sc -> 16 sc`";
            return Some(self.diagnostic(Code::UnbalancedTurn, message, self.row.span).help(help));
        }
        let (consumed, left) = (tally.consumed(), tally.left as i64);
        if consumed + left > loops as i64 {
            return Some(self.exhausted(consumed + left, self.row.span));
        }
        if !self.hook.fits(tally, self.part.flat) {
            let missing = self.hook.own as i64 - consumed - left;
            let message = format!("{} works {consumed} of the {} loops below", self.name(), self.hook.own);
            let help = format!("work {missing} more, or say so: `leave last {missing} sts unworked`");
            let diagnostic = self.diagnostic(Code::LoopsLeft, message, self.row.span);
            return Some(self.source(diagnostic).help(help));
        }
        let made = tally.produced();
        if made > i64::from(MAX_ROW) {
            let message = format!("{} makes {made} loops, the limit is {MAX_ROW}", self.name());
            return Some(self.diagnostic(Code::TooLarge, message, self.row.span));
        }
        let (stated, span) = self.row.stated?;
        (i64::from(stated) != made).then(|| {
            let message = format!("{} states {stated} and makes {made}", self.name());
            let help = format!("write ({made}), or change the {} so that it makes {stated}", self.kind());
            self.diagnostic(Code::CountDiffers, message, span).at(self.row.span, "").help(help)
        })
    }

    /// What went wrong at one operation.
    fn within(&self, fault: Fault, span: Span, tally: &Tally) -> Diagnostic {
        let name = self.name();
        match fault {
            Fault::Exhausted => self.exhausted(tally.consumed() + tally.left as i64, span),
            Fault::Behind { works, behind } => {
                let message = format!("{name} works back over {works} stitches where {behind} lie behind");
                self.diagnostic(Code::BackPassTooLong, message, span)
                    .help("a back pass is worked into stitches made since the start of the round")
            }
            Fault::Unbalanced(direction) => {
                let word = if direction == Direction::Back { "back" } else { "forward" };
                let message = format!("{name} turns {word} while already working {word}");
                self.diagnostic(Code::UnbalancedTurn, message, span)
                    .help("`<-` begins a back pass, `->` ends it: `18 sc <- -8 sc -> 16 sc`")
            }
            Fault::EmptyPass => {
                let message = format!("{name} turns back and forward without a stitch between");
                self.diagnostic(Code::UnbalancedTurn, message, span).help("leave both marks out")
            }
            Fault::AfterLeave => {
                let message = format!("{name} goes on after its last loops are left unworked");
                self.diagnostic(Code::BrokenProgram, message, span).help("leaving loops ends a row")
            }
            Fault::LeaveBack => {
                let message = format!("{name} leaves loops while working back");
                self.diagnostic(Code::UnbalancedTurn, message, span).help("turn forward first")
            }
        }
    }

    fn exhausted(&self, works: i64, span: Span) -> Diagnostic {
        let (name, loops) = (self.name(), self.hook.loops());
        let message = if works > loops as i64 {
            format!("{name} works {works} loops, {loops} are there")
        } else {
            format!("{name} runs out of its {loops} loops before its short row gives new ones")
        };
        let diagnostic = self.diagnostic(Code::LoopsExhausted, message, span);
        self.source(diagnostic).help(format!("the {} can work {loops}", self.kind()))
    }

    fn source(&self, diagnostic: Diagnostic) -> Diagnostic {
        let before = self.number.saturating_sub(1);
        diagnostic.at(self.below, format!("{} {before} leaves {}", self.kind(), self.hook.loops()))
    }

    fn diagnostic(&self, code: Code, message: String, span: Span) -> Diagnostic {
        let span = if span.is_none() { self.row.span } else { span };
        Diagnostic::new(code, message).at(span, "").in_round(&self.part.name, Some(self.number))
    }

    fn kind(&self) -> &'static str {
        if self.part.flat { "row" } else { "round" }
    }

    fn name(&self) -> String {
        format!("{} {}", self.kind(), self.number)
    }
}
