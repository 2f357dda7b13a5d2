//! Parsers for how often and where: multipliers, fills and places.

use super::lex::Tok;
use super::parse::{FaultKind, Res, Tokens, any_key, int, is_slip, key, name, ordinal, unit};
use super::syntax::{Fill, Num, Place, Times};
use super::words::Key;
use nom::branch::alt;
use nom::combinator::{map, opt, value};
use nom::sequence::{pair, preceded, terminated};
use nom::{Err, Parser};

/// `x`, `×`, or a `*` that cannot be a star.
pub(crate) fn times_mark(input: Tokens<'_>) -> Res<'_, ()> {
    match input.key(0) {
        Some(Key::Times) => Ok((input.skip(1), ())),
        Some(Key::Star) if !input.in_star && matches!(input.tok(1), Some(Tok::Int(_))) => {
            Ok((input.skip(1), ()))
        }
        _ => Err(Err::Error(())),
    }
}

/// `x 7`, `7x`, `7 times`, `repeat 7 times`, `6 more times`, `twice`, `once more`.
pub(crate) fn multiplier(input: Tokens<'_>) -> Res<'_, Times> {
    if let Ok((rest, ())) = times_mark(input) {
        let Ok((rest, n)) = int(rest) else { return input.stop(FaultKind::Multiplier(input.at(0))) };
        let (rest, _) = opt(key(Key::TimesWord)).parse(rest)?;
        return Ok((rest, Times::N(n)));
    }
    let lead = opt(any_key(&[Key::For, Key::Rep]));
    let number = |input| alt((map(int, |n| (n, false)), map(adverb, |n| (n, true)))).parse(input);
    let (rest, (lead, (n, adverb))) = pair(lead, number).parse(input)?;
    if !adverb
        && lead.is_none()
        && matches!(rest.key(0), Some(Key::Times))
        && !matches!(rest.tok(1), Some(Tok::Int(_)))
    {
        return Ok((rest.skip(1), Times::N(n)));
    }
    let (rest, more) = opt(key(Key::More)).parse(rest)?;
    let (rest, word) = opt(key(Key::TimesWord)).parse(rest)?;
    let said = adverb || word.is_some() || lead == Some(Key::Rep);
    match (said, more) {
        (true, Some(_)) => Ok((rest, Times::More(n))),
        (true, None) => Ok((rest, Times::N(n))),
        (false, _) => rest.fail("`times`"),
    }
}

/// `once`, `twice`, `thrice`.
fn adverb(input: Tokens<'_>) -> Res<'_, Num> {
    let (rest, word) = any_key(&[Key::Once, Key::Twice, Key::Thrice])(input)?;
    let value = match word {
        Key::Twice => 2,
        Key::Thrice => 3,
        _ => 1,
    };
    Ok((rest, Num { value, at: input.at(0) }))
}

/// `around`, `across`, `to end`, `to last 3 sts`.
pub(crate) fn open_end(input: Tokens<'_>) -> Res<'_, Fill> {
    let whole = (
        alt((
            value(Fill::End, any_key(&[Key::Around, Key::Across])),
            value(Fill::End, pair(key(Key::To), key(Key::End))),
        )),
        opt(any_key(&[Key::Rnd, Key::Row])),
    )
        .map(|(fill, _)| fill);
    let last = terminated(preceded(pair(key(Key::To), key(Key::Last)), int), opt(unit));
    alt((whole, map(last, Fill::Last))).parse(input)
}

/// A fill: an open end, with or without `rep`, or a bare `rep`.
pub(crate) fn fill(input: Tokens<'_>) -> Res<'_, Fill> {
    alt((preceded(opt(key(Key::Rep)), open_end), bare_repeat)).parse(input)
}

fn bare_repeat(input: Tokens<'_>) -> Res<'_, Fill> {
    let (rest, _) = key(Key::Rep)(input)?;
    match rest.tok(0) {
        Some(
            Tok::Key(
                Key::From
                | Key::Star
                | Key::Rnd
                | Key::Row
                | Key::R
                | Key::To
                | Key::Once
                | Key::Twice
                | Key::Thrice,
            )
            | Tok::Int(_),
        ) => Err(Err::Error(())),
        _ => Ok((rest, Fill::End)),
    }
}

/// A place after `in`, or one that says `next` or `each` by itself.
pub(crate) fn place(input: Tokens<'_>) -> Res<'_, Place> {
    match input.tok(0) {
        Some(Tok::Key(Key::Next)) => next(input),
        Some(Tok::Key(Key::Each)) => each(input),
        Some(Tok::Key(Key::First)) => {
            let (rest, n) = terminated(opt(int), opt(unit)).parse(input.skip(1))?;
            Ok((rest, Place::Next(n, false)))
        }
        Some(Tok::Key(Key::Last)) => {
            let (rest, n) = terminated(opt(int), opt(unit)).parse(input.skip(1))?;
            Ok((rest, Place::Last(n)))
        }
        Some(Tok::Key(Key::Same)) => same(input),
        Some(Tok::Key(Key::Ring | Key::Mr)) => Ok((input.skip(1), Place::Ring)),
        Some(Tok::Key(Key::Top)) => {
            let (rest, ()) = chain_top(input)?;
            Ok((rest, Place::TopOfChain))
        }
        Some(Tok::Key(Key::Ch | Key::Sp)) => space(input),
        Some(Tok::Ord(1)) if !matches!(input.key(1), Some(Key::Ch)) || input.key(2) != Some(Key::From) => {
            let (rest, _) = opt(unit).parse(input.skip(1))?;
            Ok((rest, Place::Next(None, false)))
        }
        Some(Tok::Int(_) | Tok::Ord(_)) => alt((from_hook, counted)).parse(input),
        _ => input.fail("a place such as `next st`"),
    }
}

fn next(input: Tokens<'_>) -> Res<'_, Place> {
    let rest = input.skip(1);
    if rest.key(0) == Some(Key::Ch) && matches!(rest.key(1), Some(Key::Hyphen | Key::Sp)) {
        return space(rest);
    }
    if rest.key(0) == Some(Key::Sp)
        || (rest.key(0) == Some(Key::Ch)
            && matches!(rest.tok(1), Some(Tok::Int(_)))
            && rest.key(2) == Some(Key::Sp))
    {
        return space(rest);
    }
    let (rest, n) = terminated(opt(int), opt(unit)).parse(rest)?;
    let (rest, only) = opt(key(Key::Only)).parse(rest)?;
    Ok((rest, Place::Next(n, only.is_some())))
}

fn each(input: Tokens<'_>) -> Res<'_, Place> {
    let rest = input.skip(1);
    if rest.key(0) == Some(Key::OtherWord) {
        let (after, _) = pair(unit, opt(open_end)).parse(rest.skip(1))?;
        return Ok((after, Place::EveryNth(Num { value: 2, at: rest.at(0) })));
    }
    if let Ok((after, n)) = ordinal(rest)
        && let Ok((after, _)) = pair(unit, opt(open_end)).parse(after)
    {
        return Ok((after, Place::EveryNth(n)));
    }
    let (rest, _) = opt(key(Key::Next)).parse(rest)?;
    let (rest, n) = opt(int).parse(rest)?;
    let (rest, said) = opt(unit).parse(rest)?;
    if let Some(n) = n {
        return Ok((rest, Place::Each(n)));
    }
    let (rest, end) = opt(open_end).parse(rest)?;
    if said.is_none() && end.is_none() {
        return rest.fail("`st` or a number");
    }
    Ok((rest, Place::EachFill(end.unwrap_or(Fill::End))))
}

fn same(input: Tokens<'_>) -> Res<'_, Place> {
    let (rest, _) = opt(alt((unit, value((), key(Key::Sp))))).parse(input.skip(1))?;
    match pair(key(Key::As), key(Key::Join)).parse(rest) {
        Ok((rest, _)) => Ok((rest, Place::SameAsJoin)),
        Err(_) => Ok((rest, Place::Same)),
    }
}

/// `top of tch`, `top of beg ch-3`.
pub(crate) fn chain_top(input: Tokens<'_>) -> Res<'_, ()> {
    let (rest, _) = (key(Key::Top), opt(key(Key::Beg)), any_key(&[Key::Tch, Key::Ch])).parse(input)?;
    let (rest, _) = opt((key(Key::Hyphen), int)).parse(rest)?;
    Ok((rest, ()))
}

/// `ch-1 sp`, `ch sp`, `ch-sp`, `sp`.
fn space(input: Tokens<'_>) -> Res<'_, Place> {
    if input.key(0) == Some(Key::Sp) {
        return Ok((input.skip(1), Place::Space(None)));
    }
    let number = opt(preceded(opt(key(Key::Hyphen)), int));
    let (rest, (_, n, _, _)) = (key(Key::Ch), number, opt(key(Key::Hyphen)), key(Key::Sp)).parse(input)?;
    Ok((rest, Place::Space(n)))
}

/// `2nd ch from hook`.
fn from_hook(input: Tokens<'_>) -> Res<'_, Place> {
    let (rest, n) = ordinal(input)?;
    let (rest, _) = (key(Key::Ch), key(Key::From), key(Key::Hook)).parse(rest)?;
    Ok((rest, Place::FromHook(n, false)))
}

/// `4 held sts`, `5 sts`.
fn counted(input: Tokens<'_>) -> Res<'_, Place> {
    let (rest, n) = int(input)?;
    let (rest, held) = opt(any_key(&[Key::Held, Key::Unworked])).parse(rest)?;
    let (rest, ()) = unit(rest)?;
    Ok((rest, if held.is_some() { Place::Held(n) } else { Place::Next(Some(n), false) }))
}

/// `over next 2 sts`, `over ch`, `over Leg 1`.
pub(crate) fn over(input: Tokens<'_>) -> Res<'_, Place> {
    let (rest, _) = key(Key::Over)(input)?;
    let number = terminated(preceded(opt(key(Key::Next)), int), opt(unit));
    alt((map(number, Place::Over), over_chain, map(name, Place::OverPart))).parse(rest)
}

fn over_chain(input: Tokens<'_>) -> Res<'_, Place> {
    let (rest, _) = key(Key::Ch)(input)?;
    match rest.tok(0) {
        None | Some(Tok::Key(_)) => Ok((rest, Place::OverChain)),
        Some(_) => Err(Err::Error(())),
    }
}

/// Where a joining slip stitch goes; the flag tells that a chain becomes a ring.
pub(crate) fn joint(input: Tokens<'_>) -> Res<'_, bool> {
    let (rest, _) = any_key(&[Key::In, Key::To])(input)?;
    if let Ok((rest, _)) =
        pair(opt(any_key(&[Key::Form, Key::Make])), any_key(&[Key::Ring, Key::Mr])).parse(rest)
    {
        return Ok((rest, true));
    }
    if let Ok((rest, ())) = chain_top(rest) {
        return Ok((rest, false));
    }
    match rest.key(0) {
        Some(Key::Join) => Ok((rest.skip(1), false)),
        Some(Key::First | Key::Beg) if !matches!(rest.tok(1), Some(Tok::Int(_))) => {
            let (rest, _) = opt(unit).parse(rest.skip(1))?;
            Ok((rest, false))
        }
        _ if matches!(rest.tok(0), Some(Tok::Ord(1))) => {
            let (rest, _) = opt(unit).parse(rest.skip(1))?;
            Ok((rest, false))
        }
        _ => rest.fail("where to join"),
    }
}

/// `join`, `join with sl st in first sc`, `sl st to join`; the flag tells that a chain becomes a ring.
pub(crate) fn join(input: Tokens<'_>) -> Res<'_, bool> {
    if is_slip(input.tok(0)) {
        return joint(input.skip(1));
    }
    let (rest, _) = key(Key::Join)(input)?;
    let rest = match rest.key(0) {
        Some(Key::With) if is_slip(rest.tok(1)) => rest.skip(2),
        _ => rest,
    };
    let (rest, ring) = opt(joint).parse(rest)?;
    Ok((rest, ring.unwrap_or(false)))
}
