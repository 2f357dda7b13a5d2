//! The one table of diagnostics: a code, its title, and the page that `picot explain` shows; one file for each group.

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Something the reader assumed or did not check.
    Note,
    /// It works, but the outcome may not be what is wanted.
    Warning,
    /// Nothing is written.
    Error,
}

impl Severity {
    /// `error`, `warning` or `note`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

/// Declares all diagnostics. The first letter of a code is its severity: E, W or N. Codes keep their meaning once published.
macro_rules! codes {
    (() $($(#[doc = $doc:literal])+ $name:ident = $code:literal, $title:literal;)+) => {
        /// What is wrong. One row of the table each.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Code { $($(#[doc = $doc])+ $name,)+ }

        impl Code {
            /// Every code, in the order of the table.
            pub const ALL: &'static [Self] = &[$(Self::$name,)+];
            /// The published code, such as `E0101`.
            pub fn as_str(self) -> &'static str {
                match self { $(Self::$name => $code,)+ }
            }
            /// A short title.
            pub fn title(self) -> &'static str {
                match self { $(Self::$name => $title,)+ }
            }
            /// The page that `picot explain` shows: what it means, a wrong and a right example.
            pub fn explanation(self) -> &'static str {
                match self { $(Self::$name => concat!($($doc, "\n",)+),)+ }
            }
        }
    };
}

impl Code {
    /// The severity that the first letter names.
    pub fn severity(self) -> Severity {
        match self.as_str().as_bytes()[0] {
            b'E' => Severity::Error,
            b'W' => Severity::Warning,
            _ => Severity::Note,
        }
    }
    /// The code with this published name, in any case.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|code| code.as_str().eq_ignore_ascii_case(name))
    }
}

// A group of numbers a file; what the numbers mean stands at the head of each. A new diagnostic is a new row there.
mod general;
mod machine;
mod mesh;
mod pattern;
mod preview;
mod shape;
mod xml;

use general::general;
use machine::machine;
use mesh::mesh;
use pattern::pattern;
use preview::preview;
use shape::shape;
use xml::xml;

pattern! { (shape mesh preview machine xml general codes) }
