//! The order of work: which lines make up which part, and which rows each line stands for.

use super::gather::is_work;
use super::lex::At;
use super::lines::{Tree, fold_name};
use super::syntax::{AgainLine, Clause, Content, Label, Line, Node, Num, Origin, PartHead, RowKind, RowLine};
use crate::diag::{Code, Diagnostic, Source};
use std::collections::{BTreeMap, BTreeSet};

/// Most rows that lines such as `Rows 6-9: rep rows 4 and 5` list in a file.
const MAX_ROWS: usize = 1_000_000;

/// A part and its rows.
pub(crate) struct Part<'t> {
    pub name: String,
    pub head: Option<&'t PartHead>,
    pub at: At,
    pub items: Vec<Item<'t>>,
    pub flat: bool,
    pub joined: bool,
    /// First numbers of the rows with their places in `items`, as far as they are entered.
    index: BTreeMap<u32, usize>,
    indexed: usize,
}

/// One row, or several equal ones.
#[derive(Clone, Copy)]
pub(crate) struct Item<'t> {
    /// `None` for a row without a label.
    pub first: Option<u32>,
    pub last: Option<u32>,
    pub what: What<'t>,
    pub label: Option<&'t Label>,
    /// The whole line.
    pub at: At,
}

impl<'t> Part<'t> {
    fn new(name: String, head: Option<&'t PartHead>, at: At) -> Self {
        Self {
            name,
            head,
            at,
            items: Vec::new(),
            flat: false,
            joined: false,
            index: BTreeMap::new(),
            indexed: 0,
        }
    }

    /// The row of this number, the last where there are several. The index is made when it is first asked for.
    fn row(&mut self, number: u32) -> Option<&'t RowLine> {
        for (at, item) in self.items.iter().enumerate().skip(self.indexed) {
            if let (Some(first), What::Row(_) | What::Again(..)) = (item.first, item.what) {
                self.index.insert(first, at);
            }
        }
        self.indexed = self.items.len();
        let (_, at) = self.index.range(..=number).next_back()?;
        let item = self.items.get(*at).filter(|item| item.last.is_some_and(|last| last >= number))?;
        match item.what {
            What::Row(row) | What::Again(row, _) => Some(row),
            What::Broken(_) => None,
        }
    }
}

impl Item<'_> {
    /// Rows it stands for.
    pub(crate) fn times(&self) -> u32 {
        match (self.first, self.last) {
            (Some(first), Some(last)) if last >= first => last - first + 1,
            _ => 1,
        }
    }
}

/// What an item says.
#[derive(Clone, Copy)]
pub(crate) enum What<'t> {
    Row(&'t RowLine),
    /// A row that is worked again; the line that says so.
    Again(&'t RowLine, &'t AgainLine),
    /// A line that could not be read, with its stated count.
    Broken(Option<u32>),
}

/// Sorts the lines of a file into parts. Faults of numbers and ranges go to `found`.
pub(crate) fn parts<'t>(
    tree: &'t Tree,
    source: &Source,
    text: &str,
    restart: bool,
    found: &mut Vec<Diagnostic>,
) -> Vec<Part<'t>> {
    let mut parts: Vec<Part<'t>> = Vec::new();
    let mut names = BTreeSet::new();
    let mut room = MAX_ROWS;
    for (index, line) in tree.lines.iter().enumerate() {
        let above = index.checked_sub(1).and_then(|index| tree.lines.get(index)).map(|line| line.at);
        match &line.what {
            Content::Part(head) => {
                let name = text.get(head.name.range()).unwrap_or_default().trim_matches('"').to_owned();
                if !names.insert(fold_name(&name)) {
                    let message = format!("part `{name}` comes twice");
                    found.push(
                        Diagnostic::new(Code::RoundTwice, message).at(source.span(head.name.range()), ""),
                    );
                }
                parts.push(Part::new(name, Some(head), line.at));
                continue;
            }
            Content::Row(_) => {
                let Some(row) = tree.row(&line.what) else { continue };
                let begins = row.label.as_ref().is_some_and(|label| label.first() == 1);
                let again =
                    || parts.last().is_some_and(|part| part.items.iter().any(|item| item.first.is_some()));
                // The same line twice in a row is a slip, not a new part.
                let twice =
                    || above.is_some_and(|above| text.get(above.range()) == text.get(line.at.range()));
                if begins && again() && !twice() && starts(row, &tree.nodes) {
                    let span = source.span(row.label.as_ref().map_or(line.at, |label| label.at).range());
                    let name = format!("piece {}", parts.len() + 1);
                    if restart {
                        let message = format!("round 1 again: a new part, called `{name}` here");
                        found.push(
                            Diagnostic::new(Code::PartUnnamed, message)
                                .at(span, "")
                                .help("name it: `Arm:` on a line of its own"),
                        );
                    } else {
                        found.push(Diagnostic::new(Code::RoundTwice, "round 1 comes twice").at(span, ""));
                    }
                    names.insert(fold_name(&name));
                    parts.push(Part::new(name, None, line.at));
                }
            }
            Content::Again(_) | Content::Broken(Some(_)) => {}
            _ => continue,
        }
        if parts.is_empty() {
            let name = "piece".to_owned();
            names.insert(fold_name(&name));
            parts.push(Part::new(name, None, line.at));
        }
        let Some(part) = parts.last_mut() else { continue };
        add(part, line, tree, source, &mut room, found);
    }
    for part in &mut parts {
        order(part, source, found);
        part.flat = is_flat(part, &tree.nodes);
        part.joined = part.items.iter().any(|item| match item.what {
            What::Row(row) => {
                row.body.of(&tree.nodes).iter().any(|node| matches!(node.what, Clause::Join { .. }))
            }
            What::Again(..) | What::Broken(_) => false,
        });
    }
    parts
}

/// True for a row that makes its own first loops.
fn starts(row: &RowLine, all: &[Node]) -> bool {
    let first =
        row.body.of(all).iter().find(|node| {
            is_work(&node.what) || matches!(node.what, Clause::Chain { .. } | Clause::Ring { .. })
        });
    first.is_some_and(|node| match &node.what {
        Clause::Ring { .. } | Clause::Chain { .. } => true,
        Clause::Op(op) => {
            matches!(op.place, Some(super::syntax::Place::Ring))
                || op.word.base.is_some_and(|base| base.us == Some(crate::ir::Kind::Fsc))
        }
        _ => false,
    })
}

fn add<'t>(
    part: &mut Part<'t>,
    line: &'t Line,
    tree: &'t Tree,
    source: &Source,
    room: &mut usize,
    found: &mut Vec<Diagnostic>,
) {
    let at = line.at;
    match &line.what {
        Content::Row(_) => {
            let Some(row) = tree.row(&line.what) else { return };
            let what = What::Row(row);
            let Some(label) = &row.label else {
                part.items.push(Item { first: None, last: None, what, label: None, at });
                return;
            };
            check_range(label, &part.name, source, found);
            for (first, last) in spans(&label.set) {
                part.items.push(Item { first: Some(first), last: Some(last), what, label: Some(label), at });
            }
        }
        Content::Again(again) => repeat(part, at, again, source, room, found),
        Content::Broken(Some(stump)) => {
            let label = &stump.label;
            let what = What::Broken(stump.count.as_ref().and_then(super::gather::stated).map(|n| n.value));
            for (first, last) in spans(&label.set) {
                part.items.push(Item { first: Some(first), last: Some(last), what, label: Some(label), at });
            }
        }
        _ => {}
    }
}

fn check_range(label: &Label, part: &str, source: &Source, found: &mut Vec<Diagnostic>) {
    let mut before: Option<u32> = None;
    for (first, last) in &label.set {
        let end = last.map_or(first.value, |last| last.value);
        let span = source.span(last.map_or(first.at, |last| first.at.to(last.at)).range());
        if last.is_some() && end <= first.value {
            let message = format!("the range {} to {end} runs backward", first.value);
            found.push(
                Diagnostic::new(Code::BadRange, message).at(span, "").in_round(part, Some(first.value)),
            );
        } else if before.is_some_and(|before| first.value <= before) {
            let message = format!("round {} is listed twice or out of order", first.value);
            found.push(
                Diagnostic::new(Code::BadRange, message).at(span, "").in_round(part, Some(first.value)),
            );
        }
        before = Some(end);
    }
    let rows = numbered(&label.set);
    if let Some(said) = label.tags.as_ref().and_then(|tags| tags.rounds)
        && u64::from(said.value) != rows
    {
        let message = format!("{rows} rounds are listed, {} stated", said.value);
        found.push(
            Diagnostic::new(Code::BadRange, message)
                .at(source.span(said.at.range()), "")
                .in_round(part, Some(label.first())),
        );
    }
}

/// `Rows 6-9: rep rows 4 and 5 twice`.
fn repeat<'t>(
    part: &mut Part<'t>,
    at: At,
    again: &'t AgainLine,
    source: &Source,
    room: &mut usize,
    found: &mut Vec<Diagnostic>,
) {
    let Some(label) = &again.label else { return };
    check_range(label, &part.name, source, found);
    let (rows, repeated) = (numbered(&label.set), numbered(&again.set));
    let passes = again.times.map(|times| u64::from(times.value) + u64::from(again.more));
    let fits =
        passes.map_or(rows.is_multiple_of(repeated), |passes| passes.checked_mul(repeated) == Some(rows));
    if !fits {
        let message = format!(
            "{rows} rows are listed, the repeat gives {}",
            passes.unwrap_or(1).saturating_mul(repeated)
        );
        found.push(
            Diagnostic::new(Code::BadRange, message)
                .at(source.span(label.at.range()), "")
                .in_round(&part.name, Some(label.first())),
        );
    }
    for (number, wanted) in each(&label.set).zip(each(&again.set).cycle()) {
        *room = room.saturating_sub(1);
        if *room == 0 {
            let message = format!("repeats list more than {MAX_ROWS} rows");
            let found_here = Diagnostic::new(Code::Limit, message).at(source.span(label.at.range()), "");
            found.push(found_here.in_round(&part.name, Some(number)));
            return;
        }
        let known = part.row(wanted);
        let Some(row) = known else {
            let message = format!("row {wanted} does not exist before this line");
            found.push(
                Diagnostic::new(Code::NoSuchPart, message)
                    .at(source.span(again.at.range()), "")
                    .in_round(&part.name, Some(number)),
            );
            return;
        };
        let item = Item {
            first: Some(number),
            last: Some(number),
            what: What::Again(row, again),
            label: Some(label),
            at,
        };
        part.items.push(item);
    }
}

/// First and last row of each range of a label; one that runs backward is its first row.
fn spans(set: &[(Num, Option<Num>)]) -> impl Iterator<Item = (u32, u32)> + Clone {
    set.iter()
        .map(|(first, last)| (first.value, last.map_or(first.value, |last| last.value).max(first.value)))
}

/// How many rows a label lists.
fn numbered(set: &[(Num, Option<Num>)]) -> u64 {
    spans(set).map(|(first, last)| u64::from(last - first) + 1).sum()
}

/// The rows that a label lists.
fn each(set: &[(Num, Option<Num>)]) -> impl Iterator<Item = u32> + Clone {
    spans(set).flat_map(|(first, last)| first..=last)
}

/// Puts the rows of lists such as `Rnds 5, 7 and 9` in their places and checks that no number is missing or double.
fn order(part: &mut Part<'_>, source: &Source, found: &mut Vec<Diagnostic>) {
    if part.items.iter().any(|item| item.label.is_some_and(|label| label.set.len() > 1)) {
        part.items.sort_by_key(|item| item.first.unwrap_or(0));
    }
    let own_start = part.head.is_none_or(|head| matches!(head.origin, Origin::Own));
    let mut next: Option<u32> = if own_start { None } else { Some(1) };
    for item in &part.items {
        let (Some(first), Some(last)) = (item.first, item.last) else { continue };
        let span = source.span(item.label.map_or(item.at, |label| label.at).range());
        let name = if item.label.is_some_and(|label| label.kind == RowKind::Row) { "row" } else { "round" };
        if let Some(next) = next {
            if first < next {
                let message = format!("{name} {first} comes twice");
                let help = format!("the next is {name} {next}");
                found.push(
                    Diagnostic::new(Code::RoundTwice, message)
                        .at(span, "")
                        .help(help)
                        .in_round(&part.name, Some(first)),
                );
            } else if first > next {
                let missing = if first == next + 1 {
                    format!("{name} {next} is missing")
                } else {
                    format!("{name}s {next} to {} are missing", first - 1)
                };
                let help = format!("the next is {name} {next}");
                found.push(
                    Diagnostic::new(Code::RoundMissing, missing)
                        .at(span, "")
                        .help(help)
                        .in_round(&part.name, Some(first)),
                );
            }
        }
        next = Some(last.max(next.unwrap_or(0).saturating_sub(1)).saturating_add(1));
    }
}

/// True when the part is worked in rows that turn.
fn is_flat(part: &Part<'_>, all: &[Node]) -> bool {
    let kind = part.items.iter().find_map(|item| item.label.map(|label| label.kind));
    match kind {
        Some(RowKind::Row) => true,
        Some(RowKind::Rnd) => false,
        Some(RowKind::R | RowKind::None) | None => part.items.iter().any(|item| match item.what {
            What::Row(row) => {
                let body = row.body.of(all);
                let first = body.iter().position(|node| is_work(&node.what));
                let last = body.iter().rposition(|node| is_work(&node.what));
                let edge = |index: usize| {
                    first.is_none_or(|first| index < first) || last.is_none_or(|last| index > last)
                };
                body.iter().enumerate().any(|(index, node)| matches!(node.what, Clause::Turn) && edge(index))
            }
            What::Again(..) | What::Broken(_) => false,
        }),
    }
}
