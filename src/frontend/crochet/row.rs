//! Parsers for a whole line: its label from the left, its count from the right, the body between.

use super::clause::body;
use super::lex::Tok;
use super::parse::{Context, FaultKind, Res, Tokens, any_key, int, key, name};
use super::place::multiplier;
use super::syntax::{
    AgainLine, Clause, Count, CountUnit, Label, Node, Nodes, Num, Numbers, Origin, PartHead, Piece, RowKind,
    RowLine, Sep, Spot, Times,
};
use super::words::Key;
use nom::Parser;
use nom::combinator::opt;
use nom::sequence::{pair, preceded};
use smallvec::{SmallVec, smallvec};

/// What stands before the body of a row.
pub(crate) struct Head {
    label: Option<Label>,
    /// The line is a row of a table.
    table: bool,
}

/// The beginning of a row, up to and with its label.
pub(crate) fn head(input: Tokens<'_>) -> (Tokens<'_>, Head) {
    let bold = input.key(0) == Some(Key::Stop);
    let (input, table) = bullet(input);
    match label(input, table) {
        // `**Rnd 2:** 6 sc`: bold type ends.
        Ok((rest, label)) if bold && rest.key(0) == Some(Key::Stop) => {
            (rest.skip(1), Head { label: Some(label), table })
        }
        Ok((rest, label)) => (rest, Head { label: Some(label), table }),
        Err(_) => (input, Head { label: None, table }),
    }
}

impl Head {
    /// True when the row is called by a number.
    pub(crate) fn is_labeled(&self) -> bool {
        self.label.is_some()
    }
}

/// What the label of a row may stand before.
pub(crate) enum Labeled {
    Row(RowLine),
    Again(Box<AgainLine>),
}

/// A row behind its head, with its count; the whole line must be read.
pub(crate) fn row(input: Tokens<'_>, head: Head) -> Res<'_, Labeled> {
    let Head { label, table } = head;
    if label.is_some()
        && input.key(0) == Some(Key::Rep)
        && let Ok((rest, again)) = again(input, label.clone())
    {
        return Ok((rest, Labeled::Again(Box::new(again))));
    }
    if input.is_empty() {
        return input.fail("an instruction");
    }
    let (rest, nodes) = body(input)?;
    let rest = end_mark(rest);
    let rest = if table && rest.key(0) == Some(Key::Pipe) { rest.skip(1) } else { rest };
    let (rest, count) = opt(|input| count(input, table)).parse(rest)?;
    let mut line = RowLine { label, body: nodes, count, cue: None };
    let rest = if table && rest.key(0) == Some(Key::Pipe) { rest.skip(1) } else { end_mark(rest) };
    // Without a count only what cannot be an instruction may follow.
    let stuffs = pause(pause(rest)).key(0) == Some(Key::Stuff);
    let rest = if line.count.is_some() || stuffs { cue(rest, &mut line) } else { rest };
    if !rest.is_empty() {
        return leftover(rest);
    }
    Ok((rest, Labeled::Row(line)))
}

/// The label and the count of a line whose body cannot be read.
pub(crate) fn frame(input: Tokens<'_>) -> (Option<Label>, Option<Count>) {
    let (input, table) = bullet(input);
    let (input, label) = match label(input, table) {
        Ok((rest, label)) => (rest, Some(label)),
        Err(_) => (input, None),
    };
    let from = input.len().saturating_sub(8);
    let found = (from..input.len()).find_map(|index| {
        let (rest, found) = count(input.skip(index), table).ok()?;
        end_mark(rest).is_empty().then_some(found)
    });
    (label, found)
}

fn leftover<T>(rest: Tokens<'_>) -> Res<'_, T> {
    rest.note(FaultKind::Expected("the end of the line"));
    Err(nom::Err::Error(()))
}

fn end_mark(input: Tokens<'_>) -> Tokens<'_> {
    match input.key(0) {
        Some(Key::Comma | Key::Semi | Key::Dot) if !count_ahead(input, false) => input.skip(1),
        _ => input,
    }
}

/// A bullet, the first bar of a table row, or the beginning of bold type.
fn bullet(input: Tokens<'_>) -> (Tokens<'_>, bool) {
    match input.key(0) {
        Some(Key::Middot | Key::Dash) => (input.skip(1), false),
        Some(Key::Pipe) => (input.skip(1), true),
        Some(Key::Star | Key::Stop) if label(input.skip(1), false).is_ok() => (input.skip(1), false),
        _ => (input, false),
    }
}

fn row_kind(input: Tokens<'_>) -> Res<'_, RowKind> {
    let kind = match input.key(0) {
        Some(Key::Rnd) => RowKind::Rnd,
        Some(Key::Row) => RowKind::Row,
        Some(Key::R) => RowKind::R,
        _ => return Err(nom::Err::Error(())),
    };
    Ok((input.skip(1), kind))
}

fn row_number(input: Tokens<'_>) -> Res<'_, Num> {
    let (rest, _) = opt(any_key(&[Key::R, Key::Rnd])).parse(input)?;
    match rest.tok(0) {
        Some(Tok::Int(value) | Tok::Ord(value)) => Ok((rest.skip(1), Num { value, at: rest.at(0) })),
        _ => Err(nom::Err::Error(())),
    }
}

/// Row numbers: `5, 7 and 9`, `4-6`.
fn row_set(input: Tokens<'_>) -> Res<'_, Numbers> {
    let (mut rest, first) = row_number(input)?;
    let mut set: Numbers = smallvec![(first, None)];
    loop {
        let range = match rest.key(0) {
            Some(Key::Hyphen | Key::To) => true,
            // A spaced dash may also end the label: `3 - 8 sc`.
            Some(Key::Dash) => {
                let after = row_number(rest.skip(1)).map(|(after, _)| after);
                after.is_ok_and(|after| {
                    matches!(
                        after.key(0),
                        Some(Key::Colon | Key::Dot | Key::Rnd | Key::Row | Key::Close(b'('))
                    ) || (matches!(after.key(0), Some(Key::Open(b'(')))
                        && matches!(after.key(2), Some(Key::Rnd | Key::Row)))
                })
            }
            _ => false,
        };
        if range {
            let (after, last) = row_number(rest.skip(1))?;
            match set.last_mut() {
                Some((_, to @ None)) => *to = Some(last),
                _ => return Err(nom::Err::Error(())),
            }
            rest = after;
            continue;
        }
        let comma = match (rest.key(0), rest.key(1)) {
            (Some(Key::Comma), Some(Key::And)) => 2,
            (Some(Key::Comma | Key::And), _) => 1,
            _ => return Ok((rest, set)),
        };
        match row_number(rest.skip(comma)) {
            Ok((after, next)) => {
                set.push((next, None));
                rest = after;
            }
            Err(_) => return Ok((rest, set)),
        }
    }
}

/// `Rnds 7-12 (6 rnds):`.
pub(crate) fn label(input: Tokens<'_>, table: bool) -> Res<'_, Label> {
    // `Rnd 7:`, as most labels are.
    if let (Ok((rest, kind)), Some(Key::Colon)) = (row_kind(input), input.key(2))
        && let Some(Tok::Int(_)) = rest.tok(0)
    {
        let (rest, number) = int(rest)?;
        let at = input.at(0).to(number.at);
        let label = Label { kind, set: smallvec![(number, None)], tags: None, at };
        return Ok((rest.skip(1), label));
    }
    let (rest, before) = opt(row_kind).parse(input)?;
    let (rest, _) = if before.is_some() { opt(key(Key::Dot)).parse(rest)? } else { (rest, None) };
    let (rest, set) = row_set(rest)?;
    let (mut rest, mut kind) = (rest, before);
    let dotted = if rest.key(0) == Some(Key::Dot) { rest.skip(1) } else { rest };
    if let Ok((after, found)) = row_kind(dotted) {
        (rest, kind) = (after, kind.or(Some(found)));
        // `carr.` ends its own abbreviation.
        if rest.key(0) == Some(Key::Dot) && matches!(rest.key(1), Some(Key::Colon)) {
            rest = rest.skip(1);
        }
    }
    let mut label = Label { kind: kind.unwrap_or(RowKind::None), set, tags: None, at: input.at(0) };
    while let Some(Key::Open(brace)) = rest.key(0) {
        let inside = rest.skip(1);
        let close = inside.rest().iter().position(|token| token.tok == Tok::Key(Key::Close(brace)));
        let Some(length) = close else { break };
        match (length, inside.tok(0), inside.key(1)) {
            (2, Some(Tok::Int(value)), Some(Key::Rnd | Key::Row | Key::R)) => {
                label.tags.get_or_insert_default().rounds = Some(Num { value, at: inside.at(0) });
            }
            (0, ..) | (_, Some(Tok::Stitch(_)), _) => return Err(nom::Err::Error(())),
            (1..=4, ..) => {
                label.tags.get_or_insert_default().others.push(inside.until(inside.skip(length)));
            }
            _ => return Err(nom::Err::Error(())),
        }
        rest = inside.skip(length + 1);
    }
    let ended = match rest.key(0) {
        Some(Key::Colon | Key::Dot | Key::Dash) => true,
        Some(Key::Close(b'(')) => before.is_some() || kind.is_none(),
        Some(Key::Pipe) => table,
        _ => false,
    };
    if !ended {
        return rest.fail("`:` after the round number");
    }
    label.at = input.until(rest);
    Ok((rest.skip(1), label))
}

/// `rep rows 4 and 5 twice`.
fn again(input: Tokens<'_>, label: Option<Label>) -> Res<'_, AgainLine> {
    let (rest, _) = key(Key::Rep)(input)?;
    let (rest, _) = row_kind(rest)?;
    let (rest, set) = row_set(rest)?;
    let (rest, times) = opt(multiplier).parse(rest)?;
    let rest = end_mark(rest);
    let (rest, count) = opt(|input| count(input, false)).parse(rest)?;
    let rest = end_mark(rest);
    if !rest.is_empty() {
        return leftover(rest);
    }
    let (times, more) = match times {
        Some(Times::N(n) | Times::Rep(n)) => (Some(n), false),
        Some(Times::More(n)) => (Some(n), true),
        _ => (None, false),
    };
    Ok((rest, AgainLine { label, set, times, more, count, at: input.until(rest) }))
}

/// An amount and what it counts.
fn amount(input: Tokens<'_>) -> Res<'_, (Num, CountUnit)> {
    let (rest, n) = match input.tok(0) {
        // `21st` is 21 stitches here.
        Some(Tok::Ord(value)) => (input.skip(1), Num { value, at: input.at(0) }),
        _ => int(input)?,
    };
    let one = |unit| Ok((rest.skip(1), (n, unit)));
    match rest.tok(0) {
        Some(Tok::Key(Key::St | Key::Loop)) => {
            let after = rest.skip(1);
            let (after, _) = opt(key(Key::Total)).parse(after)?;
            Ok((after, (n, CountUnit::Stitches)))
        }
        Some(Tok::Key(Key::Total)) => one(CountUnit::Stitches),
        Some(Tok::Key(Key::Rnd | Key::Row | Key::R)) => one(CountUnit::Rounds),
        Some(Tok::Stitch(spelled)) => one(CountUnit::Kind(spelled)),
        Some(Tok::Key(Key::Ch)) => {
            let after = rest.skip(1);
            let (after, _) = opt(pair(opt(key(Key::Hyphen)), int)).parse(after)?;
            let (after, hyphen) = opt(key(Key::Hyphen)).parse(after)?;
            match (after.key(0), hyphen) {
                (Some(Key::Sp), _) => Ok((after.skip(1), (n, CountUnit::Spaces))),
                (_, None) => one(CountUnit::Chains),
                _ => after.fail("`sp`"),
            }
        }
        _ => Ok((rest, (n, CountUnit::Stitches))),
    }
}

/// The count of a row.
pub(crate) fn count(input: Tokens<'_>, table: bool) -> Res<'_, Count> {
    match input.key(0) {
        Some(Key::Open(brace))
            if matches!(input.tok(1), Some(Tok::Int(_))) && input.key(2) == Some(Key::Close(brace)) =>
        {
            let (_, total) = int(input.skip(1))?;
            let at = input.at(0).to(input.at(2));
            Ok((input.skip(3), Count { total, unit: CountUnit::Stitches, others: Box::default(), at }))
        }
        Some(Key::Open(brace)) => {
            let (mut rest, first) = amount(input.skip(1))?;
            let mut others = Vec::new();
            while matches!(rest.key(0), Some(Key::Comma | Key::Semi | Key::And | Key::Slash)) {
                let (after, next) = amount(rest.skip(1))?;
                others.push(next);
                rest = after;
            }
            let (rest, _) = key(Key::Close(brace))(rest)?;
            let (total, unit) = first;
            Ok((rest, Count { total, unit, others: others.into(), at: input.until(rest) }))
        }
        Some(Key::Eq | Key::FatArrow | Key::Fwd | Key::Dash | Key::Colon) => {
            amount(input.skip(1)).map(|(rest, first)| finish(input, rest, first))
        }
        Some(Key::Comma | Key::Semi | Key::Dot | Key::Middot) => {
            let rest = input.skip(1);
            if rest.key(0) == Some(Key::You) {
                return said(input, rest);
            }
            let (after, first) = amount(rest)?;
            if after.done == rest.done + 1 || matches!(first.1, CountUnit::Kind(_)) {
                return input.fail("`st` after the count");
            }
            Ok(finish(input, after, first))
        }
        Some(Key::You) => said(input, input),
        _ if table => amount(input).map(|(rest, first)| finish(input, rest, first)),
        _ => input.fail("a count"),
    }
}

/// `You will have 8 stitches`.
fn said<'t>(start: Tokens<'t>, input: Tokens<'t>) -> Res<'t, Count> {
    let lead = (key(Key::You), opt(key(Key::Will)), opt(key(Key::Have)), opt(key(Key::Total)));
    let (rest, first) = preceded(lead, amount).parse(input)?;
    Ok(finish(start, rest, first))
}

/// A count of one amount.
fn finish<'t>(from: Tokens<'t>, rest: Tokens<'t>, (total, unit): (Num, CountUnit)) -> (Tokens<'t>, Count) {
    (rest, Count { total, unit, others: Box::default(), at: from.until(rest) })
}

/// True when a count follows and the line ends behind it.
#[inline]
pub(crate) fn count_ahead(input: Tokens<'_>, back: bool) -> bool {
    let possible = match input.key(0) {
        Some(Key::Open(_)) => matches!(input.tok(1), Some(Tok::Int(_) | Tok::Ord(_))),
        Some(Key::Eq | Key::FatArrow | Key::You) => true,
        // In a back pass an arrow with stitches behind it goes forward.
        Some(Key::Fwd) => !back || !matches!(input.tok(2), Some(Tok::Stitch(_) | Tok::Shaped(..))),
        Some(Key::Comma | Key::Semi | Key::Dot | Key::Middot) => {
            matches!(
                (input.tok(1), input.tok(2)),
                (Some(Tok::Int(_) | Tok::Ord(_)), Some(Tok::Key(Key::St | Key::Total)))
            ) || input.key(1) == Some(Key::You)
        }
        Some(Key::Dash) => {
            matches!(input.tok(1), Some(Tok::Int(_) | Tok::Ord(_)))
                && !matches!(input.tok(2), Some(Tok::Stitch(_)))
        }
        _ => false,
    };
    possible && ends_in_count(input)
}

/// A count, and nothing behind it but what may follow one. A mark that goes forward counts only at the end of the line.
fn ends_in_count(input: Tokens<'_>) -> bool {
    count(input, false).is_ok_and(|(rest, _)| {
        let rest = pause(pause(rest));
        rest.is_empty() || is_cue(rest)
    })
}

/// Steps over a mark between a count and what follows it.
fn pause(input: Tokens<'_>) -> Tokens<'_> {
    match input.key(0) {
        Some(Key::Comma | Key::Semi | Key::Dot | Key::Middot | Key::Dash | Key::And | Key::Then) => {
            input.skip(1)
        }
        _ => input,
    }
}

fn is_cue(input: Tokens<'_>) -> bool {
    match input.tok(0) {
        Some(Tok::Key(
            Key::Fo
            | Key::Turn
            | Key::Stuff
            | Key::Pm
            | Key::Join
            | Key::Change
            | Key::Do
            | Key::Closed
            | Key::Ch,
        )) => true,
        tok => super::parse::is_slip(tok),
    }
}

/// What follows a count: clauses that work no loop, or text that begins with a known word.
fn cue<'t>(input: Tokens<'t>, line: &mut RowLine) -> Tokens<'t> {
    let start = pause(pause(input));
    if start.is_empty() || !is_cue(start) {
        return input;
    }
    if let Ok((rest, nodes)) = body(start)
        && end_mark(rest).is_empty()
        && let Some(body) = with_cue(input.context, line.body, nodes)
    {
        line.body = body;
        return end_mark(rest);
    }
    match start.key(0) {
        Some(Key::Fo | Key::Stuff | Key::Pm | Key::Join | Key::Do | Key::Closed) => {
            let end = start.skip(start.len());
            line.cue = Some(start.until(end));
            end
        }
        _ => input,
    }
}

/// The clauses of a row with those behind its count, if these only steer.
fn with_cue(context: &Context<'_>, body: Nodes, cue: Nodes) -> Option<Nodes> {
    let mut all: SmallVec<[Node; 6]> = SmallVec::from_slice(body.of(&context.nodes.borrow()));
    for node in cue.of(&context.nodes.borrow()) {
        if !steers(&node.what) {
            return None;
        }
        all.push(Node { sep: Sep::Dot, ..*node });
    }
    Some(context.keep(&all))
}

/// A clause that neither works nor makes a loop.
fn steers(clause: &Clause) -> bool {
    matches!(
        clause,
        Clause::Turn
            | Clause::Color(_)
            | Clause::Chain { .. }
            | Clause::Join { .. }
            | Clause::FastenOff
            | Clause::DrawShut
            | Clause::Marker
            | Clause::DoNot
    )
}

/// The line that opens a part.
pub(crate) fn part(input: Tokens<'_>) -> Res<'_, PartHead> {
    let (rest, name) = name(input)?;
    let (rest, copies) = match (rest.key(0), rest.key(1)) {
        (Some(Key::Open(b'(')), Some(Key::Make | Key::Times)) => {
            let (rest, n) = int(rest.skip(2))?;
            let (rest, _) = key(Key::Close(b'('))(rest)?;
            (rest, Some(n))
        }
        _ => (rest, None),
    };
    let (rest, colon) = opt(key(Key::Colon)).parse(rest)?;
    if colon.is_none() && copies.is_none() {
        return rest.fail("`:` after the name of the part");
    }
    let (rest, origin) = match rest.key(0) {
        Some(Key::From) => from(rest)?,
        Some(Key::Join) => join(rest)?,
        _ => (rest, Origin::Own),
    };
    let (rest, _) = opt(key(Key::Dot)).parse(rest)?;
    if !rest.is_empty() {
        return leftover(rest);
    }
    Ok((rest, PartHead { name, copies, origin }))
}

fn from(input: Tokens<'_>) -> Res<'_, Origin> {
    let (rest, name) = name(input.skip(1))?;
    if rest.key(0) == Some(Key::Held) {
        return Ok((rest.skip(1), Origin::From { name, spots: Vec::new() }));
    }
    let (mut rest, mut spots) = stretch(rest)?;
    while matches!(rest.key(0), Some(Key::Comma | Key::And)) {
        let (after, mut more) = stretch(rest.skip(1))?;
        spots.append(&mut more);
        rest = after;
    }
    Ok((rest, Origin::From { name, spots }))
}

/// `rnd 2 sts 6-13, rnd 3 st 4 held`.
fn stretch(input: Tokens<'_>) -> Res<'_, Vec<Spot>> {
    let (mut rest, first) = spot(input)?;
    let mut spots = vec![first];
    while matches!(rest.key(0), Some(Key::Comma | Key::And)) {
        let (after, next) = spot(rest.skip(1))?;
        spots.push(next);
        rest = after;
    }
    let held = match rest.key(0) {
        Some(Key::Held) => true,
        Some(Key::Surface) => false,
        _ => return rest.fail("`held` or `surface`"),
    };
    for spot in &mut spots {
        spot.held = held;
    }
    Ok((rest.skip(1), spots))
}

/// `rnd 2 sts 6-13`.
fn spot(input: Tokens<'_>) -> Res<'_, Spot> {
    let (rest, _) = row_kind(input)?;
    let (rest, round) = int(rest)?;
    let (rest, _) = key(Key::St)(rest)?;
    let (rest, first) = int(rest)?;
    let (rest, last) = opt(preceded(any_key(&[Key::Hyphen, Key::To, Key::Dash]), int)).parse(rest)?;
    Ok((rest, Spot { round, first, last: last.unwrap_or(first), held: false }))
}

fn piece(input: Tokens<'_>) -> Res<'_, Piece> {
    if input.key(0) == Some(Key::Ch) && matches!(input.tok(1), Some(Tok::Int(_))) {
        let (_, n) = int(input.skip(1))?;
        return Ok((input.skip(2), Piece::Chain(n)));
    }
    name.map(Piece::Part).parse(input)
}

fn join(input: Tokens<'_>) -> Res<'_, Origin> {
    let (mut rest, first) = piece(input.skip(1))?;
    let mut pieces = vec![first];
    while rest.key(0) == Some(Key::Plus) {
        let (after, next) = piece(rest.skip(1))?;
        pieces.push(next);
        rest = after;
    }
    Ok((rest, Origin::Join { pieces }))
}

/// True for a line that can only be meant to open a part: `NAME: from ..`, `NAME: join ..`.
pub(crate) fn opens_part(input: Tokens<'_>) -> bool {
    let Ok((rest, _)) = name(input) else { return false };
    rest.key(0) == Some(Key::Colon)
        && matches!(rest.key(1), Some(Key::From | Key::Join))
        && !super::parse::is_slip(rest.tok(3))
}

/// True when something on the line can only be an instruction.
pub(crate) fn has_stitch_word(input: Tokens<'_>) -> bool {
    input.rest().iter().any(|token| {
        matches!(
            token.tok,
            Tok::Stitch(_)
                | Tok::Shaped(..)
                | Tok::Def(_)
                | Tok::Key(Key::Inc | Key::Dec | Key::Invdec | Key::Ch | Key::Mr | Key::Sk | Key::Tunisian)
        )
    })
}

/// `sc = single crochet`: a line of a list of abbreviations.
pub(crate) fn is_abbreviation(input: Tokens<'_>) -> bool {
    let input = bullet(input).0;
    let term = input.rest().iter().take_while(|token| {
        matches!(
            token.tok,
            Tok::Stitch(_)
                | Tok::Shaped(..)
                | Tok::Key(
                    Key::Inc
                        | Key::Dec
                        | Key::Invdec
                        | Key::Ch
                        | Key::Mr
                        | Key::Sk
                        | Key::Tog
                        | Key::Slash
                        | Key::St
                        | Key::Sp
                        | Key::Hyphen
                        | Key::Comma
                )
                | Tok::Int(_)
        )
    });
    let length = term.count();
    (1..=6).contains(&length)
        && !matches!(input.tok(0), Some(Tok::Int(_)))
        && matches!(input.key(length), Some(Key::Eq | Key::Colon | Key::Dash))
        && !matches!(input.tok(length + 1), Some(Tok::Int(_)) | None)
}
