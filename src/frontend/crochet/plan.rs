//! The order of work: which lines make up which part, and which rows each line stands for.

use super::gather::is_work;
use super::lex::At;
use super::lines::{Tree, fold_name};
use super::syntax::{AgainLine, Clause, Content, Label, Origin, PartHead, RowKind, RowLine};
use crate::diag::{Code, Diagnostic, Source};

/// A part and its rows.
pub(crate) struct Part<'t> {
    pub name: String,
    pub head: Option<&'t PartHead>,
    pub at: At,
    pub items: Vec<Item<'t>>,
    pub flat: bool,
    pub joined: bool,
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
    let mut unnamed = 0;
    for (index, line) in tree.lines.iter().enumerate() {
        let above = index.checked_sub(1).and_then(|index| tree.lines.get(index)).map(|line| line.at);
        match &line.what {
            Content::Part(head) => {
                let name = text.get(head.name.range()).unwrap_or_default().trim_matches('"').to_owned();
                if parts.iter().any(|part| fold_name(&part.name) == fold_name(&name)) {
                    let message = format!("part `{name}` comes twice");
                    found.push(
                        Diagnostic::new(Code::RoundTwice, message).at(source.span(head.name.range()), ""),
                    );
                }
                parts.push(Part {
                    name,
                    head: Some(head),
                    at: line.at,
                    items: Vec::new(),
                    flat: false,
                    joined: false,
                });
                continue;
            }
            Content::Row(row) => {
                let begins = row.label.as_ref().is_some_and(|label| label.first() == 1);
                let again =
                    parts.last().is_some_and(|part| part.items.iter().any(|item| item.first.is_some()));
                // The same line twice in a row is a slip, not a new part.
                let twice = above.is_some_and(|above| text.get(above.range()) == text.get(line.at.range()));
                if begins && again && !twice && starts(row) {
                    let span = source.span(row.label.as_ref().map_or(line.at, |label| label.at).range());
                    unnamed += 1;
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
                    parts.push(Part {
                        name,
                        head: None,
                        at: line.at,
                        items: Vec::new(),
                        flat: false,
                        joined: false,
                    });
                }
            }
            Content::Again(_) | Content::Broken { label: Some(_), .. } => {}
            _ => continue,
        }
        if parts.is_empty() {
            unnamed += 1;
            let name = "piece".to_owned();
            parts.push(Part { name, head: None, at: line.at, items: Vec::new(), flat: false, joined: false });
        }
        let Some(part) = parts.last_mut() else { continue };
        add(part, line.at, &line.what, source, found);
    }
    let _ = unnamed;
    for part in &mut parts {
        order(part, source, found);
        part.flat = is_flat(part);
        part.joined = part.items.iter().any(|item| match item.what {
            What::Row(row) => row.body.iter().any(|node| matches!(node.what, Clause::Join { .. })),
            What::Again(..) | What::Broken(_) => false,
        });
    }
    parts
}

/// True for a row that makes its own first loops.
fn starts(row: &RowLine) -> bool {
    let first = row
        .body
        .iter()
        .find(|node| is_work(&node.what) || matches!(node.what, Clause::Chain { .. } | Clause::Ring { .. }));
    first.is_some_and(|node| match &node.what {
        Clause::Ring { .. } | Clause::Chain { .. } => true,
        Clause::Op(op) => {
            matches!(op.place, Some(super::syntax::Place::Ring))
                || op.word.base.is_some_and(|base| base.us == Some(crate::ir::Kind::Fsc))
        }
        _ => false,
    })
}

fn add<'t>(part: &mut Part<'t>, at: At, content: &'t Content, source: &Source, found: &mut Vec<Diagnostic>) {
    match content {
        Content::Row(row) => match &row.label {
            Some(label) => {
                check_range(label, &part.name, source, found);
                for (first, last) in &label.set {
                    let last = last.map_or(first.value, |last| last.value).max(first.value);
                    let item = Item {
                        first: Some(first.value),
                        last: Some(last),
                        what: What::Row(row),
                        label: Some(label),
                        at,
                    };
                    part.items.push(item);
                }
            }
            None => part.items.push(Item { first: None, last: None, what: What::Row(row), label: None, at }),
        },
        Content::Again(again) => repeat(part, at, again, source, found),
        Content::Broken { label: Some(label), count } => {
            let what = What::Broken(count.as_ref().and_then(super::gather::stated).map(|n| n.value));
            for (first, last) in &label.set {
                let last = last.map_or(first.value, |last| last.value).max(first.value);
                part.items.push(Item {
                    first: Some(first.value),
                    last: Some(last),
                    what,
                    label: Some(label),
                    at,
                });
            }
        }
        _ => {}
    }
}

fn check_range(label: &Label, part: &str, source: &Source, found: &mut Vec<Diagnostic>) {
    let mut before: Option<u32> = None;
    let mut rows = 0_u64;
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
        rows += u64::from(end.saturating_sub(first.value)) + 1;
        before = Some(end);
    }
    if let Some(said) = label.rounds
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
    found: &mut Vec<Diagnostic>,
) {
    let Some(label) = &again.label else { return };
    check_range(label, &part.name, source, found);
    let mut numbers: Vec<u32> = Vec::new();
    for (first, last) in &again.set {
        let last = last.map_or(first.value, |last| last.value);
        numbers.extend((first.value..=last.max(first.value)).take(10_000));
    }
    let rows: u64 = label
        .set
        .iter()
        .map(|(first, last)| {
            u64::from(last.map_or(first.value, |last| last.value).saturating_sub(first.value)) + 1
        })
        .sum();
    let passes = again.times.map(|times| u64::from(times.value) + u64::from(again.more));
    let fits = passes.map_or(rows.is_multiple_of(numbers.len().max(1) as u64), |passes| {
        passes * numbers.len() as u64 == rows
    });
    if !fits {
        let message = format!(
            "{rows} rows are listed, the repeat gives {}",
            passes.unwrap_or(1) * numbers.len() as u64
        );
        found.push(
            Diagnostic::new(Code::BadRange, message)
                .at(source.span(label.at.range()), "")
                .in_round(&part.name, Some(label.first())),
        );
    }
    let all =
        label.set.iter().flat_map(|(first, last)| first.value..=last.map_or(first.value, |last| last.value));
    for (index, number) in all.take(100_000).enumerate() {
        let Some(wanted) = numbers.get(index % numbers.len().max(1)) else { return };
        let known = part.items.iter().rev().find_map(|item| {
            let inside = item.first.is_some_and(|first| first <= *wanted)
                && item.last.is_some_and(|last| last >= *wanted);
            match item.what {
                What::Row(row) | What::Again(row, _) if inside => Some(row),
                _ => None,
            }
        });
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
fn is_flat(part: &Part<'_>) -> bool {
    let kind = part.items.iter().find_map(|item| item.label.map(|label| label.kind));
    match kind {
        Some(RowKind::Row) => true,
        Some(RowKind::Rnd) => false,
        Some(RowKind::R | RowKind::None) | None => part.items.iter().any(|item| match item.what {
            What::Row(row) => {
                let first = row.body.iter().position(|node| is_work(&node.what));
                let last = row.body.iter().rposition(|node| is_work(&node.what));
                let edge = |index: usize| {
                    first.is_none_or(|first| index < first) || last.is_none_or(|last| index > last)
                };
                row.body
                    .iter()
                    .enumerate()
                    .any(|(index, node)| matches!(node.what, Clause::Turn) && edge(index))
            }
            What::Again(..) | What::Broken(_) => false,
        }),
    }
}
