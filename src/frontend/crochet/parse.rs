//! The parser's ground: tokens as nom input, the furthest fault, and the smallest parsers.

use super::lex::{At, Tok, Token};
use super::syntax::{Node, Nodes, Num, Sep};
use super::words::Key;
use crate::ir::Kind;
use nom::{Err, IResult};
use std::cell::{Cell, RefCell};

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
pub(crate) struct Context<'t> {
    pub tokens: &'t [Token],
    pub furthest: Cell<Fault>,
    /// All clauses read so far, those of a group before those around it.
    pub nodes: &'t RefCell<Vec<Node>>,
}

impl Context<'_> {
    /// Keeps clauses that stand in a row.
    pub(crate) fn keep(&self, nodes: &[Node]) -> Nodes {
        let mut all = self.nodes.borrow_mut();
        let from = all.len() as u32;
        all.extend_from_slice(nodes);
        Nodes { from, count: nodes.len() as u32 }
    }
}

/// The rest of a line. Small, for it is handed on and back by every parser.
#[derive(Clone, Copy)]
pub(crate) struct Tokens<'t> {
    pub context: &'t Context<'t>,
    /// Tokens read so far.
    pub done: u32,
    pub depth: u8,
    /// Directly inside a `*` that is open.
    pub in_star: bool,
}

impl<'t> Tokens<'t> {
    pub(crate) fn new(context: &'t Context<'t>) -> Self {
        Self { context, done: 0, depth: 0, in_star: false }
    }
    /// The tokens that are left.
    pub(crate) fn rest(self) -> &'t [Token] {
        self.context.tokens.get(self.done()..).unwrap_or_default()
    }
    #[inline]
    fn token(self, index: usize) -> Option<&'t Token> {
        self.context.tokens.get(self.done() + index)
    }
    #[inline]
    pub(crate) fn tok(self, index: usize) -> Option<Tok> {
        self.token(index).map(|token| token.tok)
    }
    #[inline]
    pub(crate) fn key(self, index: usize) -> Option<Key> {
        match self.tok(index) {
            Some(Tok::Key(key)) => Some(key),
            _ => None,
        }
    }
    #[inline]
    pub(crate) fn at(self, index: usize) -> At {
        self.token(index).map(|token| token.at).unwrap_or_default()
    }
    #[inline]
    pub(crate) fn glued(self, index: usize) -> bool {
        self.token(index).is_some_and(|token| token.glued)
    }
    #[inline]
    pub(crate) fn done(self) -> usize {
        self.done as usize
    }
    /// Number of tokens that are left.
    pub(crate) fn len(self) -> usize {
        self.context.tokens.len() - self.done()
    }
    #[inline]
    pub(crate) fn is_empty(self) -> bool {
        self.done() >= self.context.tokens.len()
    }
    /// The input after `count` tokens.
    #[inline]
    pub(crate) fn skip(self, count: usize) -> Self {
        let done = (self.done() + count).min(self.context.tokens.len());
        Self { done: done as u32, ..self }
    }
    /// The range from the next token to the last one before `end`.
    pub(crate) fn until(self, end: Self) -> At {
        let first = self.at(0);
        match end.done().checked_sub(1).and_then(|last| self.context.tokens.get(last)) {
            Some(last) if end.done > self.done => first.to(last.at),
            _ => At::new(first.start as usize, first.start as usize),
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
        let furthest = self.context.furthest.get().done;
        if done > furthest || furthest == 0 {
            self.context.furthest.set(Fault { done, kind });
        }
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
        if !matches!(rest.key(0), Some(Key::And | Key::Then)) {
            break;
        }
        rest = rest.skip(1);
        sep = Sep::And;
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
            Some(Tok::Int(_)) if end.done > input.done => {}
            Some(Tok::Key(Key::Hyphen | Key::Slash | Key::Neg)) if end.done > input.done && end.glued(0) => {}
            Some(Tok::Key(key)) if is_word(key) => {}
            _ => break,
        }
        end = end.skip(1);
    }
    if end.done == input.done {
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
