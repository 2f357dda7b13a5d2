//! Parsers for clauses: groups, stars, chains, and what steers them; stitches have a file of their own.

use super::lex::Tok;
use super::op::{entry, every_nth, is_ring_tag, op, word};
use super::parse::{FaultKind, Res, Tokens, any_key, int, key, name, separator, unit};
use super::place::{fill, join, multiplier, place, times_mark};
use super::syntax::{Clause, Counts, Node, Nodes, Num, Place, Sep, Times};
use super::words::Key;
use crate::ir::{Direction, MAX_NESTING};
use nom::branch::alt;
use nom::combinator::{map, opt};
use nom::sequence::preceded;
use nom::{Err, Parser};
use smallvec::SmallVec;

/// Clauses with what separates them, up to what is no clause.
pub(crate) fn body(input: Tokens<'_>) -> Res<'_, Nodes> {
    let mut nodes: SmallVec<[Node; 6]> = SmallVec::new();
    let (mut input, mut back) = (input, false);
    loop {
        let outer = input.depth == 0;
        if outer && !nodes.is_empty() && super::row::count_ahead(input, back) {
            break;
        }
        let (start, sep) = match separator(input) {
            Ok((rest, sep)) if !nodes.is_empty() => (rest, sep),
            _ => (input, Sep::None),
        };
        if start.is_empty() || (outer && sep != Sep::None && super::row::count_ahead(start, back)) {
            break;
        }
        // Two runs without anything between them are a slip of the pen.
        let run = matches!(start.tok(0), Some(Tok::Int(_) | Tok::Stitch(_)));
        if sep == Sep::None && run && matches!(nodes.last(), Some(Node { what: Clause::Op(_), .. })) {
            break;
        }
        match clause(start) {
            Ok((rest, what)) => {
                match what {
                    Clause::Mark(Direction::Back) => back = true,
                    Clause::Mark(Direction::Forward) => back = false,
                    _ => {}
                }
                nodes.push(Node { at: start.until(rest), sep, what });
                input = rest;
            }
            Err(Err::Error(())) if !nodes.is_empty() => break,
            Err(error) => return Err(error),
        }
    }
    Ok((input, input.context.keep(&nodes)))
}

fn clause(input: Tokens<'_>) -> Res<'_, Clause> {
    let simple = |what| Ok((input.skip(1), what));
    match input.tok(0) {
        Some(Tok::Key(word)) => match word {
            Key::Open(_) => group(input, None),
            Key::Star => star(input),
            Key::Stop => simple(Clause::Stop),
            Key::Back => simple(Clause::Mark(Direction::Back)),
            Key::Fwd => simple(Clause::Mark(Direction::Forward)),
            Key::Turn => simple(Clause::Turn),
            Key::Fo => simple(Clause::FastenOff),
            Key::Closed => simple(Clause::DrawShut),
            Key::Pm => simple(Clause::Marker),
            Key::Mr => ring(input),
            Key::Ch => chain(input),
            Key::Sk => skip(input),
            Key::Leave => leave(input),
            Key::Hold => hold(input),
            Key::Join => map(join, |ring| Clause::Join { ring }).parse(input),
            Key::With | Key::Change => color(input.skip(1)),
            Key::Do
                if input.key(1) == Some(Key::Not) && matches!(input.key(2), Some(Key::Turn | Key::Join)) =>
            {
                Ok((input.skip(3), Clause::DoNot))
            }
            Key::On if input.key(1) == Some(Key::OtherWord) && input.key(2) == Some(Key::Side) => {
                let (rest, _) = opt(key(Key::Ch)).parse(input.skip(3))?;
                Ok((rest, Clause::OtherSide))
            }
            // In a back pass chains and skips may have its sign too.
            Key::Neg if matches!(input.key(1), Some(Key::Ch)) => chain(input.skip(1)),
            Key::Neg if matches!(input.key(1), Some(Key::Sk)) => skip(input.skip(1)),
            Key::Rep if !input.in_star => repeat_all(input),
            Key::Blo | Key::Flo => Ok(loops(input)),
            Key::In if matches!(input.key(1), Some(Key::Blo | Key::Flo)) => Ok(loops(input.skip(1))),
            Key::In if matches!(input.tok(1), Some(Tok::Letter | Tok::Color(_))) => color(input.skip(1)),
            Key::In => map(preceded(key(Key::In), place), Clause::Again).parse(input),
            Key::Each => every_nth(input),
            _ => op(input),
        },
        Some(Tok::Int(_)) => {
            let after = input.skip(1);
            if after.key(0) == Some(Key::Ch) && !matches!(after.key(1), Some(Key::Hyphen | Key::Sp)) {
                return chain(input);
            }
            let bracket = match times_mark(after) {
                Ok((rest, ())) => rest,
                Err(_) if after.key(0) == Some(Key::Star) => after.skip(1),
                Err(_) => after,
            };
            if matches!(bracket.key(0), Some(Key::Open(_))) && !is_ring_tag(bracket) {
                let (_, n) = int(input)?;
                return group(bracket, Some(n));
            }
            op(input)
        }
        // `MC, 6 sc`: a declared color by itself.
        Some(Tok::Color(_)) => simple(Clause::Color(input.at(0))),
        Some(_) => {
            if let Ok((rest, ring)) = join(input) {
                return Ok((rest, Clause::Join { ring }));
            }
            op(input)
        }
        None => input.fail("an instruction"),
    }
}

fn group(input: Tokens<'_>, before: Option<Num>) -> Res<'_, Clause> {
    let Some(Key::Open(brace)) = input.key(0) else { return input.fail("a bracket") };
    let open = input.at(0);
    if u32::from(input.depth) >= MAX_NESTING {
        return input.stop(FaultKind::Deep(open));
    }
    let inner = Tokens { depth: input.depth + 1, in_star: false, ..input.skip(1) };
    let (rest, nodes) = match body(inner) {
        Ok(parsed) => parsed,
        Err(Err::Error(())) if !closes(inner, brace) => return input.stop(FaultKind::Unbalanced(open)),
        Err(error) => return Err(error),
    };
    let rest = match rest.key(0) {
        Some(Key::Comma | Key::Semi | Key::Dot) => rest.skip(1),
        _ => rest,
    };
    if rest.key(0) != Some(Key::Close(brace)) {
        if !closes(rest, brace) {
            return input.stop(FaultKind::Unbalanced(open));
        }
        return rest.fail("the closing bracket");
    }
    let rest = Tokens { depth: input.depth, in_star: input.in_star, ..rest.skip(1) };
    let (rest, after) = suffix(rest, before.is_some())?;
    let times = match (before, after) {
        (Some(_), Times::N(second) | Times::More(second) | Times::Rep(second)) => {
            return rest.stop(FaultKind::TwoMultipliers(second.at));
        }
        (Some(n), Times::Unsaid) => Times::N(n),
        (Some(_), Times::Fill(_) | Times::Place(_)) => return rest.stop(FaultKind::TwoMultipliers(open)),
        (None, times) => times,
    };
    Ok((rest, Clause::Group { brace, body: nodes, times }))
}

/// True when a bracket of this kind is closed before the line ends.
fn closes(input: Tokens<'_>, brace: u8) -> bool {
    let mut depth = 0_usize;
    for token in input.rest() {
        match token.tok {
            Tok::Key(Key::Open(other)) if other == brace => depth += 1,
            Tok::Key(Key::Close(other)) if other == brace => {
                if depth == 0 {
                    return true;
                }
                depth -= 1;
            }
            _ => {}
        }
    }
    false
}

/// What may stand behind a closing bracket.
fn suffix(input: Tokens<'_>, counted: bool) -> Res<'_, Times> {
    // In a star, `*` before a number multiplies a bracket unless `times` follows, which closes the star.
    let starred = input.in_star
        && input.key(0) == Some(Key::Star)
        && matches!(input.tok(1), Some(Tok::Int(_)))
        && !matches!(input.key(2), Some(Key::TimesWord | Key::More));
    if starred {
        let (rest, n) = int(input.skip(1))?;
        return Ok((rest, Times::N(n)));
    }
    match multiplier(input) {
        Ok(parsed) => return Ok(parsed),
        Err(Err::Error(())) => {}
        Err(error) => return Err(error),
    }
    if let Ok((rest, end)) = fill(input) {
        return Ok((rest, Times::Fill(end)));
    }
    if let Ok((after, _)) = separator(input)
        && matches!(after.key(0), Some(Key::Rep))
        && !(input.in_star || counted)
    {
        match alt((map(fill, Times::Fill), multiplier)).parse(after) {
            Ok(parsed) => return Ok(parsed),
            Err(Err::Error(())) => {}
            Err(error) => return Err(error),
        }
    }
    if input.key(0) == Some(Key::In) || input.key(0) == Some(Key::Each) {
        let (rest, _) = opt(key(Key::In)).parse(input)?;
        if let Ok((rest, place)) = place(rest) {
            return Ok((rest, Times::Place(place)));
        }
    }
    Ok((input, Times::Unsaid))
}

fn star(input: Tokens<'_>) -> Res<'_, Clause> {
    let open = input.at(0);
    let repeats = separator(input.skip(1)).is_ok_and(|(rest, _)| rest.key(0) == Some(Key::Rep));
    if input.in_star && repeats {
        return input.fail("the end of the star");
    }
    if input.in_star
        && matches!(input.tok(1), None | Some(Tok::Int(_) | Tok::Key(Key::Times | Key::Rep | Key::Around)))
    {
        let number = matches!(input.tok(1), Some(Tok::Int(_)));
        if !number || matches!(input.key(2), Some(Key::TimesWord | Key::More | Key::Times)) || input.glued(0)
        {
            return input.fail("the end of the star");
        }
    }
    if u32::from(input.depth) >= MAX_NESTING {
        return input.stop(FaultKind::Deep(open));
    }
    let inner = Tokens { depth: input.depth + 1, in_star: true, ..input.skip(1) };
    let inner = separator(inner).map_or(inner, |(rest, _)| rest);
    let (rest, nodes) = body(inner)?;
    let outer = Tokens { depth: input.depth, in_star: input.in_star, ..rest };
    let (rest, times) = match star_end(outer) {
        Ok(parsed) => parsed,
        Err(Err::Error(())) if outer.is_empty() || super::row::count_ahead(outer, false) => {
            return outer.stop(FaultKind::Star(open));
        }
        Err(error) => return Err(error),
    };
    let (rest, to_stop) = opt(stop_end).parse(rest)?;
    Ok((rest, Clause::Star { body: nodes, times, to_stop: to_stop.is_some() }))
}

/// `* x 7`, `* 7 times`, `; rep from * around`, `* rep from * to * across`.
fn star_end(input: Tokens<'_>) -> Res<'_, Times> {
    let number = |input| alt((multiplier, map(fill, Times::Fill))).parse(input);
    let before = if input.key(0) == Some(Key::Star) { input } else { skip_end(input) };
    if before.key(0) == Some(Key::Star) {
        let rest = before.skip(1);
        // `*3 sc, inc* 7` and `*3 sc, inc*7`.
        if let (Some(Tok::Int(_)), false) =
            (rest.tok(0), matches!(rest.key(1), Some(Key::TimesWord | Key::More | Key::Times)))
        {
            let (rest, n) = int(rest)?;
            return Ok((rest, Times::N(n)));
        }
        match number(rest) {
            Ok((rest, times)) => {
                let from = rest.key(0) == Some(Key::From);
                if !from {
                    return Ok((rest, times));
                }
            }
            Err(Err::Error(())) => {}
            Err(error) => return Err(error),
        }
        return rep_from(skip_end(rest));
    }
    rep_from(before)
}

fn skip_end(input: Tokens<'_>) -> Tokens<'_> {
    separator(input).map_or(input, |(rest, _)| rest)
}

/// `rep from * 4 more times`.
fn rep_from(input: Tokens<'_>) -> Res<'_, Times> {
    let (rest, _) = key(Key::Rep)(input)?;
    let (rest, _) = opt(key(Key::From)).parse(rest)?;
    let (rest, star) = opt(key(Key::Star)).parse(rest)?;
    let (rest, _) = opt((key(Key::To), key(Key::Star))).parse(rest)?;
    let said = star.is_some();
    let (rest, times) =
        alt((multiplier, map(fill, Times::Fill))).parse(rest).or_else(|error| match error {
            Err::Error(()) if said => rest.fail("how often to repeat"),
            error => Err(error),
        })?;
    Ok((rest, if let (Times::N(n), true) = (times, said) { Times::Rep(n) } else { times }))
}

/// `, ending last rep at **`.
fn stop_end(input: Tokens<'_>) -> Res<'_, ()> {
    let (rest, _) = opt(separator).parse(input)?;
    let (rest, _) = (key(Key::End), opt(key(Key::Last)), opt(key(Key::Rep))).parse(rest)?;
    let (rest, _) = (opt(key(Key::AtWord)), key(Key::Stop)).parse(rest)?;
    Ok((rest, ()))
}

fn repeat_all(input: Tokens<'_>) -> Res<'_, Clause> {
    if matches!(input.key(1), Some(Key::From | Key::Star)) {
        return input.stop(FaultKind::Star(input.at(0)));
    }
    let (rest, _) = fill(input)?;
    Ok((rest, Clause::RepeatAll))
}

/// `blo`, alone or before stitches.
fn loops(at: Tokens<'_>) -> (Tokens<'_>, Clause) {
    let entry = entry(at.key(0));
    if let Ok((rest, Clause::Op(mut op))) = op(at.skip(1)) {
        op.entry = Some(entry);
        return (rest, Clause::Op(op));
    }
    (at.skip(1), Clause::Loop(entry))
}

fn color(input: Tokens<'_>) -> Res<'_, Clause> {
    match input.tok(0) {
        Some(Tok::Letter | Tok::Color(_) | Tok::Word | Tok::Quoted | Tok::Key(Key::Mr)) => {
            Ok((input.skip(1), Clause::Color(input.at(0))))
        }
        _ => input.fail("a color"),
    }
}

fn ring(input: Tokens<'_>) -> Res<'_, Clause> {
    let rest = input.skip(1);
    if input.depth == 0 && super::row::count_ahead(rest, false) {
        return Ok((rest, Clause::Ring { n: None, word: None }));
    }
    let after = separator(rest).map_or(rest, |(after, _)| after);
    let (after, _) = opt(key(Key::With)).parse(after)?;
    let number_first = |input| (int, opt(word)).parse(input);
    let word_first = |input| (word, int).map(|(word, n)| (n, Some(word))).parse(input);
    if let Ok((end, (n, word))) = alt((number_first, word_first)).parse(after)
        && !matches!(end.key(0), Some(Key::In | Key::Ch | Key::Hyphen | Key::Times))
    {
        return Ok((end, Clause::Ring { n: Some(n), word }));
    }
    Ok((rest, Clause::Ring { n: None, word: None }))
}

fn chain(input: Tokens<'_>) -> Res<'_, Clause> {
    let (rest, n) = if let Some(Tok::Int(_)) = input.tok(0) {
        let (rest, n) = int(input)?;
        (rest.skip(1), Some(n))
    } else {
        let rest = if input.key(1) == Some(Key::Hyphen) { input.skip(2) } else { input.skip(1) };
        opt(int).parse(rest)?
    };
    let (rest, counts) = opt(counts).parse(rest)?;
    Ok((rest, Clause::Chain { n, counts: counts.unwrap_or(Counts::Unsaid) }))
}

/// `(counts as dc)`, `(counts as 3 sts)`, `(does not count)`.
fn counts(input: Tokens<'_>) -> Res<'_, Counts> {
    let (rest, _) = key(Key::Open(b'('))(input)?;
    if rest.key(0) == Some(Key::Does) {
        let (mut rest, _) = (key(Key::Does), key(Key::Not), key(Key::Count)).parse(rest)?;
        if rest.key(0) == Some(Key::As) {
            rest = unit(opt(int).parse(rest.skip(1))?.0)?.0;
        }
        let (rest, _) = key(Key::Close(b'('))(rest)?;
        return Ok((rest, Counts::Not));
    }
    let (rest, _) = (key(Key::Counts), key(Key::As)).parse(rest)?;
    let (rest, counts) = if let Some(Tok::Stitch(spelled)) = rest.tok(0) {
        (rest.skip(1), Counts::As(spelled))
    } else {
        let (rest, n) = int(rest)?;
        if let (1, Some(Tok::Stitch(spelled))) = (n.value, rest.tok(0)) {
            (rest.skip(1), Counts::As(spelled))
        } else {
            (unit(rest)?.0, Counts::Stitches(n))
        }
    };
    let (rest, _) = opt((key(Key::And), key(Key::Ch), opt(key(Key::Hyphen)), int)).parse(rest)?;
    let (rest, _) = key(Key::Close(b'('))(rest)?;
    Ok((rest, counts))
}

fn skip(input: Tokens<'_>) -> Res<'_, Clause> {
    let mut rest = input.skip(1);
    while matches!(rest.key(0), Some(Key::Next | Key::First | Key::Last | Key::Over)) {
        rest = rest.skip(1);
    }
    if matches!(rest.key(0), Some(Key::Ch | Key::Sp))
        && let Ok((end, Place::Space(_))) = place(rest)
    {
        return Ok((end, Clause::Skip { n: None, space: true }));
    }
    let (rest, n) = opt(int).parse(rest)?;
    let (rest, _) = opt(unit).parse(rest)?;
    Ok((rest, Clause::Skip { n, space: false }))
}

fn leave(input: Tokens<'_>) -> Res<'_, Clause> {
    let (rest, _) = opt(key(Key::Last)).parse(input.skip(1))?;
    let (rest, n) = int(rest)?;
    let (rest, _) = opt(unit).parse(rest)?;
    let (rest, _) = key(Key::Unworked)(rest)?;
    Ok((rest, Clause::Leave { n }))
}

fn hold(input: Tokens<'_>) -> Res<'_, Clause> {
    let (rest, (n, (), _, name)) = (int, unit, any_key(&[Key::For, Key::To]), name).parse(input.skip(1))?;
    Ok((rest, Clause::Hold { n, name }))
}
