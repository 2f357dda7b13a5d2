//! The parser's ground: tokens as nom input, the furthest fault, and the smallest parsers.

use super::lex::{At, Tok, Token};
use super::syntax::{Num, Sep};
use super::words::Key;
use crate::ir::Kind;
use nom::{Err, IResult, Input, Needed};
use std::cell::Cell;
use std::iter::{Copied, Enumerate};
use std::slice::Iter;

/// What a parser gives. Faults are kept beside it, in the context, so that backtracking costs nothing.
pub(crate) type Res<'t, T> = IResult<Tokens<'t>, T, ()>;

/// Why a line could not be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FaultKind {
    /// Something else was expected.
    Expected(&'static str),
    /// A bracket without its partner.
    Unbalanced(At),
    /// `rep from *` without a `*`, or the other way around.
    Star(At),
    /// A multiplier without its number.
    Multiplier(At),
    /// A multiplier before and after.
    TwoMultipliers(At),
    /// A number without a stitch.
    NoStitch(At),
    /// Brackets too deep.
    Deep(At),
}

/// A fault and how far the parser had come.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fault {
    pub done: usize,
    pub kind: FaultKind,
}

/// What all parsers of a line share.
pub(crate) struct Context {
    pub total: usize,
    pub furthest: Cell<Fault>,
}

/// The rest of a line.
#[derive(Clone, Copy)]
pub(crate) struct Tokens<'t> {
    pub rest: &'t [Token],
    pub context: &'t Context,
    pub depth: u8,
    /// Directly inside a `*` that is open.
    pub in_star: bool,
}

impl<'t> Tokens<'t> {
    pub(crate) fn new(rest: &'t [Token], context: &'t Context) -> Self {
        Self { rest, context, depth: 0, in_star: false }
    }
    pub(crate) fn tok(self, index: usize) -> Option<Tok> {
        self.rest.get(index).map(|token| token.tok)
    }
    pub(crate) fn key(self, index: usize) -> Option<Key> {
        match self.tok(index) {
            Some(Tok::Key(key)) => Some(key),
            _ => None,
        }
    }
    pub(crate) fn at(self, index: usize) -> At {
        self.rest.get(index).map(|token| token.at).unwrap_or_default()
    }
    pub(crate) fn glued(self, index: usize) -> bool {
        self.rest.get(index).is_some_and(|token| token.glued)
    }
    pub(crate) fn done(self) -> usize {
        self.context.total - self.rest.len()
    }
    pub(crate) fn is_empty(self) -> bool {
        self.rest.is_empty()
    }
    /// The input after `count` tokens.
    pub(crate) fn skip(self, count: usize) -> Self {
        Self { rest: self.rest.get(count..).unwrap_or_default(), ..self }
    }
    /// The range from the next token to the last one before `end`.
    pub(crate) fn until(self, end: Self) -> At {
        let taken = self.rest.len() - end.rest.len();
        match (self.rest.first(), taken.checked_sub(1).and_then(|last| self.rest.get(last))) {
            (Some(first), Some(last)) => first.at.to(last.at),
            _ => At { start: self.at(0).start, end: self.at(0).start },
        }
    }
    /// Fails here, and another way of reading may be tried.
    pub(crate) fn fail<T>(self, expected: &'static str) -> Res<'t, T> {
        self.note(FaultKind::Expected(expected));
        Err(Err::Error(()))
    }
    /// Fails for good.
    pub(crate) fn stop<T>(self, kind: FaultKind) -> Res<'t, T> {
        self.context.furthest.set(Fault { done: usize::MAX, kind });
        Err(Err::Failure(()))
    }
    /// Remembers a fault if none was found further on.
    pub(crate) fn note(self, kind: FaultKind) {
        let done = self.done();
        if done > self.context.furthest.get().done || self.context.furthest.get().done == 0 {
            self.context.furthest.set(Fault { done, kind });
        }
    }
}

impl<'t> Input for Tokens<'t> {
    type Item = Token;
    type Iter = Copied<Iter<'t, Token>>;
    type IterIndices = Enumerate<Self::Iter>;

    fn input_len(&self) -> usize {
        self.rest.len()
    }
    fn take(&self, index: usize) -> Self {
        Self { rest: self.rest.get(..index).unwrap_or(self.rest), ..*self }
    }
    fn take_from(&self, index: usize) -> Self {
        self.skip(index)
    }
    fn take_split(&self, index: usize) -> (Self, Self) {
        (self.take_from(index), self.take(index))
    }
    fn position<P: Fn(Token) -> bool>(&self, predicate: P) -> Option<usize> {
        self.rest.iter().position(|token| predicate(*token))
    }
    fn iter_elements(&self) -> Self::Iter {
        self.rest.iter().copied()
    }
    fn iter_indices(&self) -> Self::IterIndices {
        self.rest.iter().copied().enumerate()
    }
    fn slice_index(&self, count: usize) -> Result<usize, Needed> {
        if count <= self.rest.len() { Ok(count) } else { Err(Needed::new(count - self.rest.len())) }
    }
}

/// One word or mark.
pub(crate) fn key<'t>(wanted: Key) -> impl Fn(Tokens<'t>) -> Res<'t, At> + Copy {
    move |input| {
        if input.key(0) == Some(wanted) { Ok((input.skip(1), input.at(0))) } else { Err(Err::Error(())) }
    }
}

/// One of several words.
pub(crate) fn any_key<'t>(wanted: &'static [Key]) -> impl Fn(Tokens<'t>) -> Res<'t, Key> + Copy {
    move |input| match input.key(0) {
        Some(key) if wanted.contains(&key) => Ok((input.skip(1), key)),
        _ => Err(Err::Error(())),
    }
}

/// A number.
pub(crate) fn int(input: Tokens<'_>) -> Res<'_, Num> {
    match input.tok(0) {
        Some(Tok::Int(value)) => Ok((input.skip(1), Num { value, at: input.at(0) })),
        _ => input.fail("a number"),
    }
}

/// A number that touches the word before it.
pub(crate) fn glued(input: Tokens<'_>) -> Res<'_, Num> {
    if input.glued(0) { int(input) } else { Err(Err::Error(())) }
}

/// `2nd`.
pub(crate) fn ordinal(input: Tokens<'_>) -> Res<'_, Num> {
    match (input.tok(0), input.tok(1)) {
        (Some(Tok::Ord(value)), _) => Ok((input.skip(1), Num { value, at: input.at(0) })),
        // German writes `4.` for `4th`.
        (Some(Tok::Int(value)), Some(Tok::Key(Key::Dot))) if input.glued(1) => {
            Ok((input.skip(2), Num { value, at: input.at(0) }))
        }
        _ => input.fail("an ordinal such as `2nd`"),
    }
}

/// What stands between clauses.
pub(crate) fn separator(input: Tokens<'_>) -> Res<'_, Sep> {
    let (mut rest, mut sep) = match input.key(0) {
        Some(Key::Comma | Key::Semi | Key::Colon | Key::Middot | Key::Dash) => (input.skip(1), Sep::Comma),
        Some(Key::Dot) => (input.skip(1), Sep::Dot),
        Some(Key::And | Key::Then) => (input.skip(1), Sep::And),
        _ => return input.fail("a comma"),
    };
    // `pb., aum`: the period belongs to the abbreviation.
    if sep == Sep::Dot && matches!(rest.key(0), Some(Key::Comma | Key::Semi | Key::Dot)) {
        rest = rest.skip(1);
        sep = Sep::Comma;
    }
    for _ in 0..2 {
        if matches!(rest.key(0), Some(Key::And | Key::Then)) {
            rest = rest.skip(1);
            sep = Sep::And;
        }
    }
    Ok((rest, sep))
}

/// What a place is counted in: `st`, `ch`, or a stitch name.
pub(crate) fn unit(input: Tokens<'_>) -> Res<'_, ()> {
    match input.tok(0) {
        Some(Tok::Key(Key::St | Key::Ch | Key::Loop | Key::Tch) | Tok::Stitch(_)) => Ok((input.skip(1), ())),
        _ => input.fail("`st`"),
    }
}

/// True for the word of a slip stitch.
pub(crate) fn is_slip(tok: Option<Tok>) -> bool {
    matches!(tok, Some(Tok::Stitch(spelled)) if spelled.us == Some(Kind::SlSt))
}

/// A name: words up to the next mark.
pub(crate) fn name(input: Tokens<'_>) -> Res<'_, At> {
    let mut end = input;
    loop {
        match end.tok(0) {
            Some(
                Tok::Word
                | Tok::Letter
                | Tok::Quoted
                | Tok::Stitch(_)
                | Tok::Color(_)
                | Tok::Def(_)
                | Tok::Shaped(..),
            ) => {}
            Some(Tok::Int(_)) if end.rest.len() < input.rest.len() => {}
            Some(Tok::Key(Key::Hyphen | Key::Slash | Key::Neg))
                if end.rest.len() < input.rest.len() && end.glued(0) => {}
            Some(Tok::Key(key)) if is_word(key) => {}
            _ => break,
        }
        end = end.skip(1);
    }
    if end.rest.len() == input.rest.len() {
        return input.fail("a name");
    }
    Ok((end, input.until(end)))
}

/// Words, as opposed to marks. `rnd`, `row`, `held` and `surface` end a name: they say where a part comes from.
fn is_word(key: Key) -> bool {
    !matches!(
        key,
        Key::Comma
            | Key::Semi
            | Key::Dot
            | Key::Colon
            | Key::Middot
            | Key::Star
            | Key::Stop
            | Key::Times
            | Key::Hyphen
            | Key::Dash
            | Key::Neg
            | Key::Back
            | Key::Fwd
            | Key::Eq
            | Key::FatArrow
            | Key::Plus
            | Key::Slash
            | Key::Pipe
            | Key::Open(_)
            | Key::Close(_)
            | Key::Other
            | Key::Rnd
            | Key::Row
            | Key::R
            | Key::Held
            | Key::Surface
            | Key::And
            | Key::Then
    )
}
