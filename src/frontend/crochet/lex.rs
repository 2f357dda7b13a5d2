//! From the bytes of a line to folded tokens that keep their places in the original.

use super::hints::Hints;
use super::packed::Packed;
use super::words::{Key, Known, Spelled, Words};
use crate::ir::{Kind, Language};
use std::num::NonZeroU32;

/// A byte range of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct At {
    pub start: u32,
    /// One more than the end, so that a place that may be absent takes no more room.
    behind: NonZeroU32,
}

impl Default for At {
    fn default() -> Self {
        Self::new(0, 0)
    }
}

impl At {
    #[inline]
    pub(crate) fn new(start: usize, end: usize) -> Self {
        Self { start: start as u32, behind: NonZeroU32::MIN.saturating_add(end as u32) }
    }
    pub(crate) fn end(self) -> u32 {
        self.behind.get() - 1
    }
    /// The smallest range that covers both.
    #[inline]
    pub(crate) fn to(self, other: Self) -> Self {
        Self { start: self.start.min(other.start), behind: self.behind.max(other.behind) }
    }
    pub(crate) fn range(self) -> std::ops::Range<usize> {
        self.start as usize..self.end() as usize
    }
}

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tok {
    Int(u32),
    /// `2nd`, `3ª`.
    Ord(u32),
    Stitch(Spelled),
    /// A letter that stands for a shaped stitch.
    Shaped(Kind, u16, u16),
    Color(u16),
    Def(u16),
    /// One capital letter that means nothing else.
    Letter,
    Quoted,
    Word,
    Key(Key),
}

/// A token and where it stands.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Token {
    pub tok: Tok,
    pub at: At,
    /// Touches the token before it.
    pub glued: bool,
}

/// A number too large to mean anything is held as this.
pub(crate) const TOO_BIG: u32 = u32::MAX;

/// Lexes the line `text[start..end]` into `out`, and tells what its words promise. The error is the place of a character
/// that text must not hold.
pub(crate) fn line(
    text: &str,
    start: usize,
    end: usize,
    words: &Words,
    out: &mut Vec<Token>,
) -> Result<Hints, At> {
    out.clear();
    let text = text.get(..end).unwrap_or_default();
    let bytes = text.as_bytes();
    let mut lexer =
        Lexer { text, bytes, at: start, words, out, last_end: usize::MAX, seen: Hints::default() };
    lexer.run()?;
    let seen = lexer.seen;
    if seen.has(Hints::PHRASE) {
        super::phrases::fold(out);
    }
    Ok(seen)
}

struct Lexer<'l> {
    /// The text up to the end of the line.
    text: &'l str,
    bytes: &'l [u8],
    at: usize,
    words: &'l Words,
    out: &'l mut Vec<Token>,
    /// End of the token before, dropped words included.
    last_end: usize,
    seen: Hints,
}

impl Lexer<'_> {
    fn run(&mut self) -> Result<(), At> {
        while let Some(byte) = self.byte(0) {
            match byte {
                b' ' | b'\t' => self.at += 1,
                b'0'..=b'9' => self.number(),
                b'a'..=b'z' | b'A'..=b'Z' | b'&' => self.word(),
                0..=0x7f => self.punctuation(byte)?,
                _ => self.beyond_ascii()?,
            }
        }
        Ok(())
    }

    fn byte(&self, ahead: usize) -> Option<u8> {
        self.bytes.get(self.at + ahead).copied()
    }

    fn char(&self) -> Option<char> {
        self.text.get(self.at..)?.chars().next()
    }

    #[inline]
    fn push(&mut self, tok: Tok, from: usize) {
        self.out.push(Token { tok, at: At::new(from, self.at), glued: self.last_end == from });
        self.last_end = self.at;
        // What nearly always follows.
        self.at += usize::from(self.byte(0) == Some(b' '));
    }

    fn key(&mut self, key: Key, bytes: usize) {
        let from = self.at;
        self.at += bytes;
        self.push(Tok::Key(key), from);
    }

    /// A decimal digit, ASCII or full-width, and its length.
    fn digit(&self) -> Option<(u32, usize)> {
        match self.byte(0)? {
            byte @ b'0'..=b'9' => Some((u32::from(byte - b'0'), 1)),
            0xef => {
                let c = self.char()?;
                ('\u{ff10}'..='\u{ff19}').contains(&c).then(|| (c as u32 - 0xff10, 3))
            }
            _ => None,
        }
    }

    #[inline]
    fn number(&mut self) {
        let from = self.at;
        let (mut value, mut at) = (0_u32, from);
        while let Some(byte @ b'0'..=b'9') = self.bytes.get(at)
            && at - from < 9
        {
            value = value * 10 + u32::from(byte - b'0');
            at += 1;
        }
        if let Some(b'0'..=b'9' | b'a'..=b'z' | b'A'..=b'Z' | 0x80..) = self.bytes.get(at) {
            return self.long_number();
        }
        self.at = at;
        self.push(Tok::Int(value), from);
    }

    /// A number of any length, in any digits, or an ordinal.
    #[cold]
    fn long_number(&mut self) {
        let from = self.at;
        let mut value = 0_u64;
        while let Some((digit, length)) = self.digit() {
            value = value.saturating_mul(10).saturating_add(u64::from(digit));
            self.at += length;
        }
        let value = u32::try_from(value).unwrap_or(TOO_BIG);
        let suffix = self.bytes.get(self.at..).unwrap_or_default();
        let letter = |index: usize| suffix.get(index).map(u8::to_ascii_lowercase);
        let alone = self
            .text
            .get(self.at + 2..)
            .is_none_or(|rest| rest.chars().next().is_none_or(|c| !c.is_ascii_digit() && !is_letter(c)));
        let ordinal = match (letter(0), letter(1)) {
            (Some(b's'), Some(b't')) => value % 10 == 1 && value % 100 != 11,
            (Some(b'n' | b'r'), Some(b'd')) | (Some(b't'), Some(b'h')) => true,
            _ => false,
        };
        if ordinal && alone {
            self.at += 2;
            self.push(Tok::Ord(value), from);
        } else if let Some(mark @ ('ª' | 'º' | '°')) = self.char() {
            self.at += mark.len_utf8();
            self.push(Tok::Ord(value), from);
        } else {
            self.push(Tok::Int(value), from);
        }
    }

    #[inline]
    fn word(&mut self) {
        let from = self.at;
        let letters = self.bytes.get(from..).and_then(Packed::letters);
        let Some((word, length)) = letters else { return self.any_word() };
        if length == 0 || matches!(self.bytes.get(from + length), Some(b'-' | 0x80..)) {
            return self.any_word();
        }
        self.at = from + length;
        let known = self.words.get(&word);
        if length == 1 || self.words.language == Language::Letters {
            return self.letter(known, from);
        }
        self.known(known, from);
    }

    /// A word with other letters than those from A to Z, with hyphens, or of any length.
    #[cold]
    fn any_word(&mut self) {
        let from = self.at;
        if self.byte(0) == Some(b'&') {
            self.at += 1;
        } else {
            while let Some(c) =
                self.char().filter(|c| c.is_ascii_alphabetic() || !c.is_ascii() && is_letter(*c))
            {
                self.at += c.len_utf8();
            }
        }
        // `sl-st`, `demi-b`: a compound that the vocabulary has as one word.
        if self.byte(0) == Some(b'-')
            && self.byte(1).is_some_and(|byte| byte.is_ascii_alphabetic())
            && let Some((known, end)) = self.compound(from)
        {
            self.at = end;
            self.known(known, from);
            return;
        }
        let written = self.text.get(from..self.at).unwrap_or_default();
        let known = self.words.spelled(written);
        if written.len() == 1 || self.words.language == Language::Letters {
            return self.letter(known, from);
        }
        self.known(known, from);
    }

    /// A word where capitals may matter: a single letter, or any in the notation of letters.
    #[inline(never)]
    fn letter(&mut self, known: Known, from: usize) {
        let written = self.text.get(from..self.at).unwrap_or_default();
        if written.bytes().all(|byte| byte.is_ascii_uppercase()) {
            if let Some(capital) = self.words.capital(written) {
                return self.known(capital, from);
            }
            // A capital `A` is a color, never the article.
            if written.len() == 1 && matches!(known.tok, Tok::Word | Tok::Key(Key::Drop)) {
                return self.push(Tok::Letter, from);
            }
        }
        self.known(known, from);
    }

    /// A word with hyphens in it that the vocabulary knows as one; the longest counts.
    fn compound(&self, from: usize) -> Option<(Known, usize)> {
        let rest = self.text.get(self.at..)?;
        let length: usize =
            rest.chars().take_while(|c| is_letter(*c) || *c == '-').take(32).map(char::len_utf8).sum();
        let mut end = self.at + length;
        while end > self.at + 1 {
            let written = self.text.get(from..end)?;
            let known = self.words.spelled(written);
            if known.tok != Tok::Word && !written.ends_with('-') {
                return Some((known, end));
            }
            end = from + written.rfind('-')?;
        }
        None
    }

    /// Takes a word for what it means.
    #[inline]
    fn known(&mut self, known: Known, from: usize) {
        self.seen = self.seen.with(known.hints);
        if known.hints == Hints::DROP {
            self.last_end = usize::MAX;
        } else {
            self.push(known.tok, from);
        }
    }

    fn punctuation(&mut self, byte: u8) -> Result<(), At> {
        match byte {
            b',' => self.key(Key::Comma, 1),
            b';' => self.key(Key::Semi, 1),
            b'.' => self.key(Key::Dot, 1),
            b':' => self.key(Key::Colon, 1),
            b'*' if self.byte(1) == Some(b'*') => self.key(Key::Stop, 2),
            b'*' => self.key(Key::Star, 1),
            b'+' => self.key(Key::Plus, 1),
            b'/' => self.key(Key::Slash, 1),
            b'|' => self.key(Key::Pipe, 1),
            b'(' | b'[' | b'{' => self.key(Key::Open(byte), 1),
            b')' => self.key(Key::Close(b'('), 1),
            b']' => self.key(Key::Close(b'['), 1),
            b'}' => self.key(Key::Close(b'{'), 1),
            b'<' if self.byte(1) == Some(b'-') => self.key(Key::Back, 2),
            b'<' => self.key(Key::Open(b'<'), 1),
            b'>' => self.key(Key::Close(b'<'), 1),
            b'=' if self.byte(1) == Some(b'>') => self.key(Key::FatArrow, 2),
            b'=' => self.key(Key::Eq, 1),
            b'-' if self.byte(1) == Some(b'>') => self.key(Key::Fwd, 2),
            // In `ch--> 3 sc` the arrow has its own hyphen.
            b'-' if self.byte(1) == Some(b'-') && self.byte(2) != Some(b'>') => self.key(Key::Dash, 2),
            b'-' => self.minus(1),
            b'"' => self.quoted(),
            0..=0x1f | 0x7f => return Err(At::new(self.at, self.at + 1)),
            _ => self.key(Key::Other, 1),
        }
        Ok(())
    }

    /// A minus, by what stands around it: a range or hyphen, a dash between clauses, or the sign of a back pass.
    fn minus(&mut self, bytes: usize) {
        let before_glued =
            self.last_end == self.at && self.out.last().is_some_and(|token| !is_separator(token.tok));
        let after = self.text.get(self.at + bytes..).and_then(|rest| rest.chars().next());
        let after_space = after.is_none_or(char::is_whitespace);
        self.key(
            if before_glued {
                Key::Hyphen
            } else if after_space {
                Key::Dash
            } else {
                Key::Neg
            },
            bytes,
        );
    }

    fn quoted(&mut self) {
        let from = self.at;
        let close = self.text.get(from + 1..).and_then(|rest| rest.find('"'));
        match close {
            Some(length) => {
                self.at = from + length + 2;
                self.push(Tok::Quoted, from);
            }
            None => self.key(Key::Other, 1),
        }
    }

    fn beyond_ascii(&mut self) -> Result<(), At> {
        let Some(c) = self.char() else {
            self.at += 1;
            return Ok(());
        };
        let length = c.len_utf8();
        match c {
            // Marks without width say nothing, wherever they come from.
            '\u{200b}'..='\u{200f}' | '\u{2060}' | '\u{feff}' | '\u{ad}' => {
                if self.last_end == self.at {
                    self.last_end += length;
                }
                self.at += length;
            }
            // Text that shows in another order than it stands cannot be checked by eye.
            '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => {
                return Err(At::new(self.at, self.at + length));
            }
            '\u{80}'..='\u{84}' | '\u{86}'..='\u{9f}' => return Err(At::new(self.at, self.at + length)),
            '\u{2190}' | '\u{27f5}' | '\u{21d0}' => self.key(Key::Back, length),
            '\u{2192}' | '\u{27f6}' => self.key(Key::Fwd, length),
            '\u{21d2}' => self.key(Key::FatArrow, length),
            '\u{2014}' | '\u{2015}' => self.key(Key::Dash, length),
            '\u{2010}'..='\u{2013}' | '\u{2212}' | '\u{ff0d}' | '\u{fe63}' => self.minus(length),
            '×' | '✕' | '✖' => self.key(Key::Times, length),
            '·' | '•' | '‧' | '∙' | '▪' | '◦' | '●' => self.key(Key::Middot, length),
            '，' | '、' => self.key(Key::Comma, length),
            '；' => self.key(Key::Semi, length),
            '：' => self.key(Key::Colon, length),
            '…' | '。' | '．' => self.key(Key::Dot, length),
            '（' => self.key(Key::Open(b'('), length),
            '）' => self.key(Key::Close(b'('), length),
            '［' | '【' => self.key(Key::Open(b'['), length),
            '］' | '】' => self.key(Key::Close(b'['), length),
            '＊' => self.key(Key::Star, length),
            '＝' => self.key(Key::Eq, length),
            '＋' => self.key(Key::Plus, length),
            '\u{ff10}'..='\u{ff19}' => self.long_number(),
            _ if c.is_whitespace() => self.at += length,
            _ if is_letter(c) => self.any_word(),
            _ => self.key(Key::Other, length),
        }
        Ok(())
    }
}

fn is_letter(c: char) -> bool {
    (c.is_alphabetic() && c != 'ª' && c != 'º') || ('\u{300}'..='\u{36f}').contains(&c)
}

fn is_separator(tok: Tok) -> bool {
    matches!(
        tok,
        Tok::Key(
            Key::Comma
                | Key::Semi
                | Key::Dot
                | Key::Colon
                | Key::Middot
                | Key::Dash
                | Key::Back
                | Key::Fwd
                | Key::Open(_)
                | Key::Star
                | Key::Stop
                | Key::Neg
        )
    )
}
