//! What words promise of their line, so that only few lines are searched for rare things.

use super::lex::Tok;
use super::words::Key;

/// A set of promises.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Hints(u8);

impl Hints {
    pub(crate) const NONE: Self = Self(0);
    /// The word says nothing.
    pub(crate) const DROP: Self = Self(1);
    /// A phrase may begin here.
    pub(crate) const PHRASE: Self = Self(2);
    /// Loops may be set aside.
    pub(crate) const HOLD: Self = Self(4);
    /// Chains may be said to count.
    pub(crate) const COUNTS: Self = Self(8);
    /// A stitch name of US terms only.
    pub(crate) const US: Self = Self(16);
    /// A stitch name of UK terms only.
    pub(crate) const UK: Self = Self(32);
    /// A stitch name that means another stitch in each.
    pub(crate) const OPEN: Self = Self(64);

    /// What a word promises that means this.
    pub(crate) fn of(tok: Tok) -> Self {
        match tok {
            Tok::Key(Key::Drop) => Self::DROP,
            Tok::Key(Key::Hold) => Self::HOLD,
            Tok::Key(Key::Counts) => Self::COUNTS,
            Tok::Key(key) if super::phrases::starts_phrase(key) => Self::PHRASE,
            Tok::Stitch(spelled) => match (spelled.us, spelled.uk) {
                (Some(us), Some(uk)) if us != uk => Self::OPEN,
                (Some(_), None) => Self::US,
                (None, Some(_)) => Self::UK,
                _ => Self::NONE,
            },
            _ => Self::NONE,
        }
    }

    /// These and the others.
    pub(crate) fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// True when one of the others is among them.
    pub(crate) fn has(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }
}
