//! Parsers for stitches: how many, which, and where they go.

use super::lex::Tok;
use super::parse::{FaultKind, Res, Tokens, glued, int, key};
use super::place::{fill, multiplier, over, place};
use super::syntax::{Clause, Op, Place, Shape, Times, Word};
use super::words::Key;
use crate::ir::{Entry, Kind};
use nom::combinator::opt;
use nom::{Err, Parser};

/// `(magic circle)` behind stitches.
pub(crate) fn is_ring_tag(input: Tokens<'_>) -> bool {
    matches!(input.key(0), Some(Key::Open(b'(')))
        && input.key(1) == Some(Key::Mr)
        && matches!(input.key(2), Some(Key::Close(b'(')))
}

pub(crate) fn entry(key: Option<Key>) -> Entry {
    if key == Some(Key::Flo) { Entry::Front } else { Entry::Back }
}

/// German: `jede 4. M verdoppeln`.
pub(crate) fn every_nth(input: Tokens<'_>) -> Res<'_, Clause> {
    let (rest, place) = place(input)?;
    let Place::EveryNth(_) = place else { return input.fail("a stitch") };
    let (rest, word) = word(rest)?;
    let op = Op { entry: None, back: None, n: None, word, place: Some(place), evenly: false, hue: None };
    Ok((rest, Clause::Op(op)))
}

/// A stitch name with its shape.
pub(crate) fn word(input: Tokens<'_>) -> Res<'_, Word> {
    let at = input.at(0);
    let finish = |rest, base, shape| Ok((rest, Word { base, shape, at: input.until(rest) }));
    match input.tok(0) {
        Some(Tok::Stitch(spelled)) => {
            let rest = input.skip(1);
            match rest.tok(0) {
                Some(Tok::Int(_)) if rest.key(1) == Some(Key::Tog) => {
                    let (rest, n) = int(rest)?;
                    return finish(rest.skip(1), Some(spelled), Shape::Tog(n));
                }
                Some(Tok::Key(Key::Hyphen | Key::Inc | Key::Dec | Key::Invdec | Key::Shell)) => {}
                _ => return Ok((rest, Word { base: Some(spelled), shape: Shape::Plain, at })),
            }
            let after = if rest.key(0) == Some(Key::Hyphen) { rest.skip(1) } else { rest };
            if let Some(shape @ (Key::Inc | Key::Dec | Key::Invdec)) = after.key(0) {
                let (rest, n) = opt(glued).parse(after.skip(1))?;
                let shape = if shape == Key::Inc { Shape::Inc(n) } else { Shape::Dec(n) };
                return finish(rest, Some(spelled), shape);
            }
            if after.key(0) == Some(Key::Shell) {
                let (rest, n) = glued(after.skip(1))?;
                return finish(rest, Some(spelled), Shape::Inc(Some(n)));
            }
            Ok((rest, Word { base: Some(spelled), shape: Shape::Plain, at }))
        }
        Some(Tok::Key(Key::Inc)) => {
            let (rest, n) = opt(glued).parse(input.skip(1))?;
            finish(rest, None, Shape::Inc(n))
        }
        Some(Tok::Key(Key::Dec)) => {
            let (rest, n) = opt(glued).parse(input.skip(1))?;
            finish(rest, None, Shape::Dec(n))
        }
        Some(Tok::Key(Key::Invdec)) => finish(input.skip(1), None, Shape::Dec(None)),
        Some(Tok::Key(Key::Even)) => finish(input.skip(1), None, Shape::Even),
        Some(Tok::Def(def)) => finish(input.skip(1), None, Shape::Def(def)),
        Some(Tok::Shaped(kind, works, makes)) => {
            finish(input.skip(1), None, Shape::Letter(kind, works, makes))
        }
        _ => input.fail("a stitch"),
    }
}

/// Kinds that a stitch name before them only describes: `5-dc bobble`.
fn is_bunch(tok: Option<Tok>) -> bool {
    let bunch = [Kind::Bobble, Kind::Popcorn, Kind::Puff, Kind::Cluster];
    matches!(tok, Some(Tok::Stitch(spelled)) if bunch.contains(&spelled.any()))
}

/// Stitches: how many, which, where.
pub(crate) fn op(input: Tokens<'_>) -> Res<'_, Clause> {
    let (rest, back) = opt(key(Key::Neg)).parse(input)?;
    let hyphened = rest.key(1) == Some(Key::Hyphen) && is_bunch(rest.tok(3));
    if let (Some(Tok::Int(_)), true) = (rest.tok(0), hyphened) {
        let (after, word) = word(rest.skip(3))?;
        return op_tail(
            after,
            Op { entry: None, back, n: None, word, place: None, evenly: false, hue: None },
        );
    }
    let (rest, mut n) = match rest.tok(0) {
        Some(Tok::Int(_)) => opt(int).parse(rest)?,
        _ => (rest, None),
    };
    let (rest, before) = loop_word(rest);
    let (mut rest, word) = match word(rest) {
        Ok(parsed) => parsed,
        Err(Err::Error(())) => {
            if let Some(n) = n
                && !matches!(rest.tok(0), Some(Tok::Word))
            {
                rest.note(FaultKind::NoStitch(n.at));
            }
            return Err(Err::Error(()));
        }
        Err(error) => return Err(error),
    };
    if ends(rest) {
        if n.is_none() {
            rest.note(FaultKind::Expected("a number"));
        }
        let op = Op { entry: before, back, n, word, place: None, evenly: false, hue: None };
        return Ok((rest, Clause::Op(op)));
    }
    let (after, mut entry) = loop_word(rest);
    rest = after;
    entry = entry.or(before);
    if n.is_none() && !may_multiply(rest) {
        rest.note(FaultKind::Expected("a number"));
    } else if n.is_none() {
        match multiplier(rest) {
            Ok((after, Times::N(number) | Times::Rep(number))) => (rest, n) = (after, Some(number)),
            Ok(_) | Err(Err::Error(()) | Err::Incomplete(_)) => {
                if let Ok((after, number)) = int(rest) {
                    (rest, n) = (after, Some(number));
                }
            }
            Err(error) => return Err(error),
        }
    }
    let (rest, after) = loop_word(rest);
    op_tail(rest, Op { entry: after.or(entry), back, n, word, place: None, evenly: false, hue: None })
}

/// True where a multiplier or a number may stand.
fn may_multiply(input: Tokens<'_>) -> bool {
    match input.tok(0) {
        Some(Tok::Int(_)) => true,
        Some(Tok::Key(key)) => {
            matches!(key, Key::Times | Key::Star | Key::For | Key::Rep | Key::Once | Key::Twice | Key::Thrice)
        }
        _ => false,
    }
}

/// True where nothing can follow that belongs to the stitches.
fn ends(input: Tokens<'_>) -> bool {
    match input.tok(0) {
        None => true,
        Some(Tok::Key(key)) => matches!(
            key,
            Key::Comma
                | Key::Semi
                | Key::Dot
                | Key::And
                | Key::Then
                | Key::Close(_)
                | Key::Stop
                | Key::Back
                | Key::Fwd
                | Key::Eq
        ),
        Some(_) => false,
    }
}

fn loop_word(input: Tokens<'_>) -> (Tokens<'_>, Option<Entry>) {
    match input.key(0) {
        Some(word @ (Key::Blo | Key::Flo)) => (input.skip(1), Some(entry(Some(word)))),
        _ => (input, None),
    }
}

/// Where the stitches go, and their color.
fn op_tail(input: Tokens<'_>, mut op: Op) -> Res<'_, Clause> {
    let (mut rest, starting) = opt(key(Key::Starting)).parse(input)?;
    if rest.key(0) == Some(Key::In) {
        let (after, entry) = loop_word(rest.skip(1));
        match place(after) {
            Ok((after, place)) => {
                op.entry = entry.or(op.entry);
                op.place = Some(match place {
                    Place::FromHook(n, _) => Place::FromHook(n, starting.is_some()),
                    place => place,
                });
                rest = after;
            }
            Err(_) if entry.is_some() => {
                op.entry = entry;
                rest = after;
                if let Ok((end_of_fill, end)) = fill(after) {
                    (rest, op.place) = (end_of_fill, Some(Place::Fill(end)));
                }
            }
            Err(error) if matches!(rest.tok(1), Some(Tok::Letter | Tok::Color(_))) => {
                let _ = error;
            }
            Err(error) => return Err(error),
        }
    } else if matches!(rest.key(0), Some(Key::Next | Key::Each)) {
        let (after, place) = place(rest)?;
        (rest, op.place) = (after, Some(place));
    } else if rest.key(0) == Some(Key::Over) {
        let (after, place) = over(rest)?;
        (rest, op.place) = (after, Some(place));
    } else if rest.key(0) == Some(Key::Evenly) {
        op.evenly = true;
        rest = rest.skip(1);
        if matches!(rest.key(0), Some(Key::Around | Key::Across)) {
            rest = rest.skip(1);
        }
    } else if is_ring_tag(rest) {
        op.place = Some(Place::Ring);
        rest = rest.skip(3);
    } else if !matches!(rest.key(0), Some(Key::Rep))
        && let Ok((after, end)) = fill(rest)
    {
        (rest, op.place) = (after, Some(Place::Fill(end)));
    }
    // `sc next 2 sts together`.
    if let (Some(Place::Next(Some(n), _)), Some(Key::Tog)) = (op.place, rest.key(0)) {
        op.word.shape = Shape::Tog(n);
        op.place = None;
        rest = rest.skip(1);
    }
    let said = usize::from(matches!(rest.key(0), Some(Key::In | Key::With)));
    if let Some(Tok::Letter | Tok::Color(_)) = rest.tok(said) {
        op.hue = Some(rest.at(said));
        rest = rest.skip(said + 1);
    }
    Ok((rest, Clause::Op(op)))
}
