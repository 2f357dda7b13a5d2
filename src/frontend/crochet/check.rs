//! What a file means: every row on the loops of the one below, part by part, into a program.

use super::Document;
use super::conventions::{Conventions, Setting};
use super::gather::stated;
use super::lex::At;
use super::lines::fold_name;
use super::lower::{Begin, Below, File, Place0};
use super::plan::{self, Item, Part, What};
use super::solve::{Job, Reading, Solved};
use super::syntax::{Node, RowLine};
use crate::diag::{Code, Diagnostic, Sink};
use crate::ir::{self, Block, Entry, Finish, Kind, Op, PartId, Program, Row, Segment, Start, Stitch};
use std::collections::BTreeMap;

/// Most loops of a file.
pub const MAX_FILE_LOOPS: u64 = 10_000_000;

/// Flat rows of one range that are followed one by one.
const MAX_FLAT: u32 = 100_000;

/// One line of rounds, as counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Round {
    /// First round; 0 for a line without a number.
    pub first: u32,
    /// Last round.
    pub last: u32,
    /// Loops of the row below that each round uses up, where they could be told.
    pub consumes: Option<u32>,
    /// Loops that it makes.
    pub produces: Option<u32>,
    /// The count that is written.
    pub stated: Option<u32>,
}

impl Round {
    /// The number or numbers: `7`, `7-12`; empty for a line without.
    pub fn label(&self) -> String {
        match (self.first, self.last) {
            (0, _) => String::new(),
            (first, last) if last > first => format!("{first}-{last}"),
            (first, _) => first.to_string(),
        }
    }
}

/// The rounds of a part.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartRounds {
    /// Name of the part.
    pub name: String,
    /// Its lines in order.
    pub rounds: Vec<Round>,
}

/// What checking a document gives.
#[derive(Debug)]
pub struct Checked {
    /// Every part with its counts.
    pub parts: Vec<PartRounds>,
    /// The pattern, when it has no error.
    pub program: Option<Program>,
}

/// Holds of one part: row, first loop, number of loops.
#[derive(Clone, Copy)]
pub(super) struct Held {
    pub from: PartId,
    pub by: PartId,
    pub row: u32,
    pub first: i64,
    pub loops: u32,
    pub at: At,
}

/// A file while it is checked.
pub(super) struct Checker<'d> {
    pub document: &'d Document<'d>,
    pub file: &'d File<'d>,
    pub conventions: &'d Conventions,
    pub colors: Vec<String>,
    pub color: Option<u16>,
    pub total: u64,
    pub held: Vec<Held>,
    pub found: Vec<Diagnostic>,
    pub decided: BTreeMap<Setting, &'static str>,
    /// Loops that each finished part leaves.
    pub open: Vec<Option<i64>>,
    /// Rounds of the finished parts with the loops they make.
    pub made: Vec<Vec<(u32, u32, i64)>>,
    pub taken: Vec<u32>,
}

/// Where a part stands between two rows.
pub(super) struct State {
    pub have: Option<i64>,
    pub below: Below,
    /// Loops behind these that earlier flat rows left.
    pub beyond: i64,
    /// Loops that flat rows left on the side where the next row ends.
    pub other_side: i64,
    pub chain_counted: bool,
    /// Chain spaces of the row below.
    pub spaces: Option<u32>,
    pub dominant: Kind,
    pub start: Option<Start>,
    pub rows: Vec<Row>,
    pub rounds: Vec<Round>,
    /// Rounds with the loops that lie open after each: made, or left by it.
    pub opens: Vec<(u32, u32, i64)>,
    pub segments: Vec<(String, Segment)>,
    pub shut: bool,
    /// Place of the row below.
    pub last_at: Option<At>,
}

pub(super) fn check(document: &Document<'_>, options: &Conventions, sink: &mut Sink<'_>) -> Checked {
    let mut found = Vec::new();
    let mut conventions = options.clone();
    let mut heading = super::heading::read(document, &mut conventions, &mut found);
    for setting in [Setting::ImplicitRepeat] {
        if matches!(
            document.tree.language,
            ir::Language::Portuguese | ir::Language::Spanish | ir::Language::French
        ) {
            conventions.default_to(setting, "fill");
        }
    }
    let terms = super::heading::terms(document, &conventions, &mut found);
    let restart = !conventions.is(Setting::Restart, "error");
    let planned = plan::parts(&document.tree, document.source, document.text, restart, &mut found);
    let mut names: BTreeMap<String, PartId> = BTreeMap::new();
    for (index, part) in planned.iter().enumerate() {
        names.entry(fold_name(&part.name)).or_insert(PartId(index as u32));
    }
    let absent = if document.tree.holds {
        super::origins::absent_parts(&planned, document, &mut names)
    } else {
        Vec::new()
    };
    let file = File {
        source: document.source,
        text: document.text,
        terms,
        defs: &document.tree.defs,
        nodes: &document.tree.nodes,
        parts: &names,
    };
    let mut checker = Checker {
        document,
        file: &file,
        conventions: &conventions,
        colors: document.tree.colors.clone(),
        color: None,
        total: 0,
        held: Vec::new(),
        found,
        decided: BTreeMap::new(),
        open: Vec::new(),
        made: Vec::new(),
        taken: vec![0; planned.len()],
    };
    let mut parts = Vec::new();
    let mut counted = Vec::new();
    for (index, part) in planned.iter().enumerate() {
        let (part, rounds) = checker.part(part, PartId(index as u32));
        counted.push(PartRounds { name: part.name.clone(), rounds });
        parts.push(part);
    }
    parts.extend(checker.absent(&absent, planned.len()));
    checker.check_held(&planned);
    checker.prose();
    let mut failed = document.failed;
    for diagnostic in std::mem::take(&mut checker.found) {
        failed |= diagnostic.severity == crate::diag::Severity::Error;
        sink.push(diagnostic);
    }
    heading.colors = checker.colors;
    let program = (!failed).then(|| Program {
        name: heading.title,
        gauge: heading.gauge,
        maker: heading.maker,
        colors: heading.colors,
        pattern: ir::Pattern { parts },
        graphs: Vec::new(),
    });
    Checked { parts: counted, program }
}

impl Checker<'_> {
    fn part(&mut self, part: &Part<'_>, id: PartId) -> (ir::Part, Vec<Round>) {
        let mut state = State {
            have: Some(0),
            below: Below::Nothing,
            beyond: 0,
            other_side: 0,
            chain_counted: false,
            spaces: None,
            dominant: Kind::Sc,
            start: None,
            rows: Vec::new(),
            rounds: Vec::new(),
            opens: Vec::new(),
            segments: Vec::new(),
            shut: false,
            last_at: None,
        };
        if let Some(head) = part.head {
            self.origin(head, id, &mut state);
        }
        state.rows.reserve_exact(part.items.len());
        state.rounds.reserve_exact(part.items.len());
        state.opens.reserve_exact(part.items.len());
        for index in 0..part.items.len() {
            if self.total > MAX_FILE_LOOPS {
                let Some(item) = part.items.get(index) else { break };
                let message = format!("the file has more than {MAX_FILE_LOOPS} loops");
                self.say(Diagnostic::new(Code::Limit, message), item.at, "");
                break;
            }
            self.item(part, index, id, &mut state);
        }
        self.open.push(state.have.filter(|_| state.below != Below::Nothing || !state.rounds.is_empty()));
        self.made.push(state.opens);
        let copies = part.head.and_then(|head| head.copies).map_or(1, |n| n.value);
        if copies == 0 || copies > 10_000 {
            let at = part.head.and_then(|head| head.copies).map_or(part.at, |n| n.at);
            self.say(Diagnostic::new(Code::BadMultiplier, format!("{copies} copies of a part")), at, "");
        }
        let built = ir::Part {
            name: part.name.clone(),
            start: state.start.unwrap_or(Start::Chain { loops: 0, joined: false }),
            rows: state.rows,
            finish: if state.shut { Finish::DrawnShut } else { Finish::Open },
            flat: part.flat,
            copies: copies.max(1),
        };
        (built, state.rounds)
    }

    /// A diagnostic at a place of the file.
    pub(super) fn say(&mut self, diagnostic: Diagnostic, at: At, label: &str) {
        let span = self.document.source.span(at.range());
        let primary = !diagnostic.labels.is_empty();
        let mut diagnostic = diagnostic.at(span, label);
        if primary {
            diagnostic.labels.rotate_right(1);
        }
        self.found.push(diagnostic);
    }

    pub(super) fn place<'s>(&self, part: &Part<'_>, state: &'s State) -> Place0<'s> {
        Place0 {
            below: state.below,
            flat: part.flat,
            joined: part.joined,
            chain_counted: state.chain_counted,
            dominant: state.dominant,
            color: self.color,
            spaces: state.spaces,
            beyond: state.beyond,
            segments: if state.rows.is_empty() { &state.segments } else { &[] },
        }
    }

    fn item(&mut self, part: &Part<'_>, index: usize, id: PartId, state: &mut State) {
        let Some(item) = part.items.get(index).copied() else { return };
        let (row, count) = match item.what {
            What::Row(row) => (row, row.count.as_ref()),
            What::Again(row, again) => {
                let ends = part.items.get(index + 1).is_none_or(|next| next.at != item.at);
                (row, again.count.as_ref().filter(|_| ends))
            }
            What::Broken(stated) => {
                std::mem::swap(&mut state.beyond, &mut state.other_side);
                state.have = stated.map(i64::from);
                state.below = Below::Loops;
                state.chain_counted = false;
                if stated.is_some() {
                    let text = "the next row starts from the stated count of this one";
                    self.say(Diagnostic::new(Code::FromStated, text), item.at, "");
                }
                state.start.get_or_insert(Start::Chain { loops: stated.unwrap_or(0), joined: !part.flat });
                state.rounds.push(round(&item, None, stated));
                return;
            }
        };
        let place = self.place(part, state);
        let body = row.body.of(self.file.nodes);
        let at = body_at(body, item.at);
        let job = Job { body, count, at, file: self.file, place: &place, have: state.have };
        let reading = job.read(self.conventions, &mut self.colors);
        match reading {
            Reading::Plain(solved) if solved.fault.is_none() => {
                self.accept(part, item, row, solved, id, state);
            }
            Reading::Decided(solved, setting, value) if solved.fault.is_none() => {
                self.decided(part, setting, value, &item, at);
                self.accept(part, item, row, solved, id, state);
            }
            Reading::Plain(solved) | Reading::Decided(solved, ..) => {
                let leaves = self.fault(part, index, &job, Ok(&solved), state);
                let begun = solved.lowered.begin.is_some() || solved.lowered.usable.is_some();
                state.rounds.push(round(&item, Some(&solved), solved.stated));
                state.opens.push((item.first.unwrap_or(0), item.last.unwrap_or(0), solved.makes));
                if begun || state.start.is_none() {
                    state.start.get_or_insert(Start::Chain { loops: 0, joined: !part.flat });
                }
                self.remember(&solved, state);
                std::mem::swap(&mut state.beyond, &mut state.other_side);
                state.have = leaves;
                state.below = Below::Loops;
                state.last_at = Some(item.at);
            }
            Reading::Trouble(trouble) => {
                let leaves = self.fault(part, index, &job, Err(&trouble), state);
                state.rounds.push(round(&item, None, count.and_then(stated).map(|n| n.value)));
                state.start.get_or_insert(Start::Chain { loops: 0, joined: !part.flat });
                std::mem::swap(&mut state.beyond, &mut state.other_side);
                state.have = leaves;
                state.below = Below::Loops;
                state.last_at = Some(item.at);
            }
        }
    }

    fn remember(&mut self, solved: &Solved, state: &mut State) {
        state.chain_counted = solved.lowered.chain_counted;
        state.spaces = super::solve::spaces(&solved.lowered.block);
        if let Some(kind) = solved.lowered.dominant {
            state.dominant = kind;
        } else if let Some(kind) = main_kind(&solved.lowered.block) {
            state.dominant = kind;
        }
        self.color = solved.lowered.color;
    }

    /// Takes a row that fits.
    fn accept(
        &mut self,
        part: &Part<'_>,
        item: Item<'_>,
        row: &RowLine,
        solved: Solved,
        id: PartId,
        state: &mut State,
    ) {
        self.remarks(part, &item, row, &solved);
        let times = item.times();
        let leaves = solved.leaves(part.flat);
        if times > 1 && solved.lowered.begin.is_some() {
            let message = format!("a part begins once, not in each of {times} rounds");
            let at = item.label.map_or(item.at, |label| label.at);
            let found = Diagnostic::new(Code::RangeChangesCount, message).in_round(&part.name, item.first);
            self.say(found.help("give the beginning a round of its own"), at, "");
        }
        if times > 1 && state.have != Some(leaves) && solved.lowered.begin.is_none() {
            let have = state.have.unwrap_or(0);
            let message =
                format!("{times} rounds under one count, but each goes from {have} to {leaves} loops");
            let at = item.label.map_or(item.at, |label| label.at);
            let found = Diagnostic::new(Code::RangeChangesCount, message).in_round(&part.name, item.first);
            self.say(found.help("write one line a round"), at, "");
        }
        self.total = self.total.saturating_add((solved.makes.max(0) as u64).saturating_mul(u64::from(times)));
        state.rounds.push(round(&item, Some(&solved), solved.stated));
        state.opens.push((item.first.unwrap_or(0), item.last.unwrap_or(0), leaves));
        self.holds(&solved.lowered.block, id, item.first.unwrap_or(0));
        Self::begin(&solved, state);
        self.remember(&solved, state);
        state.shut |= solved.lowered.shut;
        let chain_only =
            matches!(solved.lowered.begin, Some(Begin::Chain { .. })) && !makes_loops(&solved.lowered.block);
        if part.flat {
            let mut own = if solved.lowered.begin.is_some() { solved.have } else { state.have };
            // Rows of a range go back and forth over the same loops.
            for _ in 0..times.min(MAX_FLAT) {
                let rest = own.map_or(0, |own| (own + state.beyond - solved.works).max(0));
                (state.beyond, state.other_side) = (state.other_side, rest);
                own = Some(leaves);
            }
        }
        state.have = Some(leaves);
        state.last_at = Some(item.at);
        if chain_only {
            return;
        }
        state.below = Below::Loops;
        if solved.lowered.block.is_empty() || (state.rows.is_empty() && ring_of(&solved).is_some()) {
            return;
        }
        let span = self.document.source.span(item.at.range());
        let stated = solved.stated.filter(|stated| i64::from(*stated) == solved.makes);
        let count_at = row.count.as_ref().map_or(item.at, |count| count.total.at);
        let stated = stated.map(|stated| (stated, self.document.source.span(count_at.range())));
        state.rows.push(Row { body: solved.lowered.block, times, stated, span });
    }

    /// How the part starts, when this row says it.
    fn begin(solved: &Solved, state: &mut State) {
        let lowered = &solved.lowered;
        let joined_before = matches!(state.start, Some(Start::Chain { joined: true, .. }));
        match (&lowered.begin, lowered.usable) {
            (Some(Begin::Ring), _) => {
                state.start = Some(Start::Ring { loops: ring_of(solved).unwrap_or(0) });
            }
            (begin, Some(usable)) => {
                let joined = joined_before || matches!(begin, Some(Begin::Chain { joined: true, .. }));
                let side = usable.div_ceil(2);
                state.start = Some(if lowered.other_side {
                    Start::Join {
                        segments: vec![
                            Segment::Chain { loops: side },
                            Segment::Chain { loops: side.saturating_sub(1) },
                        ],
                    }
                } else {
                    Start::Chain { loops: usable, joined }
                });
            }
            (Some(Begin::Chain { chains, joined }), None) => {
                state.start = Some(Start::Chain { loops: *chains, joined: *joined });
                state.below = Below::Chain { chains: *chains, joined: *joined };
            }
            (None, None) => {
                state.start.get_or_insert(Start::Chain { loops: 0, joined: false });
            }
        }
    }

    /// Notes the loops that a row sets aside.
    fn holds(&mut self, block: &Block, from: PartId, row: u32) {
        if !block.ops().iter().any(|op| matches!(op, Op::Hold { .. })) {
            return;
        }
        let mut worked = 0_i64;
        let mut whole = Block::default();
        for (op, span) in block.spanned() {
            if let Op::Hold { loops, by } = op {
                let at = self
                    .document
                    .source
                    .range(span)
                    .map(|range| At::new(range.start, range.end))
                    .unwrap_or_default();
                self.held.push(Held { from, by: *by, row, first: worked + 1, loops: *loops, at });
            }
            whole.push(op.clone(), span);
            let mut direction = ir::Direction::Forward;
            worked =
                super::effect::of(&whole, &mut direction, false).map_or(worked, super::effect::Effect::works);
        }
    }
}

fn round(item: &Item<'_>, solved: Option<&Solved>, stated: Option<u32>) -> Round {
    let clip = |count: i64| u32::try_from(count).ok();
    let (first, last) = (item.first.unwrap_or(0), item.last.unwrap_or(0));
    let consumes = solved.and_then(|solved| clip(solved.works));
    Round { first, last, consumes, produces: solved.and_then(|solved| clip(solved.makes)), stated }
}

pub(super) fn body_at(body: &[Node], or: At) -> At {
    match (body.first(), body.last()) {
        (Some(first), Some(last)) => first.at.to(last.at),
        _ => or,
    }
}

/// The number of single crochets, when a ring holds nothing else.
fn ring_of(solved: &Solved) -> Option<u32> {
    const PLAIN: Stitch = Stitch { kind: Kind::Sc, works: 0, makes: 1, entry: Entry::Both };
    match (solved.lowered.block.ops(), &solved.lowered.begin) {
        ([Op::Work { stitch, times }], Some(Begin::Ring)) if *stitch == PLAIN => Some(*times),
        _ => None,
    }
}

fn makes_loops(block: &Block) -> bool {
    block.ops().iter().any(|op| match op {
        Op::Work { stitch, .. } => stitch.works + stitch.makes > 0,
        Op::Repeat { body, .. } => makes_loops(body),
        Op::Hold { .. } | Op::Leave { .. } => true,
        Op::Turn(_) | Op::Color(_) => false,
    })
}

/// The kind that a row is mostly made of, at its first level.
fn main_kind(block: &Block) -> Option<Kind> {
    block.ops().iter().find_map(|op| match op {
        Op::Work { stitch, .. }
            if stitch.works == 1 && stitch.kind.height() >= 1.0 && stitch.kind != Kind::Special =>
        {
            Some(stitch.kind)
        }
        Op::Repeat { body, .. } => main_kind(body),
        _ => None,
    })
}
