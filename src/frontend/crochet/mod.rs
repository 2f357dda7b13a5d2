//! The written crochet pattern language: text to tree, tree to pattern.
//!
//! A [`Document`] is a file as written, line by line, with comments and places kept. Its grammar is
//! `grammar/crochet.ebnf`. What the lines mean is worked out from it row by row; what they look like in canonical form
//! is printed from it.

#![expect(
    clippy::wildcard_enum_match_arm,
    reason = "a parser asks for the few words it can use at a place; the rest is one case"
)]

mod blame;
mod check;
mod clause;
mod close;
pub mod conventions;
mod effect;
mod fmt;
mod gather;
mod groups;
mod heading;
mod hints;
mod lex;
mod lines;
mod lower;
mod mend;
mod op;
mod origins;
mod packed;
mod parse;
mod phrases;
mod place;
mod plan;
mod remarks;
mod report;
mod ring;
mod row;
mod scan;
mod solve;
mod stitches;
mod syntax;
mod terms;
mod verdict;
mod words;

pub use check::{Checked, MAX_FILE_LOOPS, PartRounds, Round};
pub use conventions::{Conventions, Setting};
pub use mend::mend;

use super::{Input, Reader};
use crate::diag::{Code, Diagnostic, Severity, Sink, Source};
use crate::ir::Language;

/// Largest file that is read, in bytes.
pub const MAX_FILE: usize = 64 << 20;

/// A pattern as written.
pub struct Document<'s> {
    source: &'s Source,
    text: &'s str,
    tree: lines::Tree,
    /// A line could not be read.
    failed: bool,
}

/// The reader of written patterns.
pub const READER: Reader = Reader {
    name: "crochet",
    extensions: &["txt"],
    about: "a written crochet pattern, in English and six other notations",
    read: |source, _, sink| read(source, &Conventions::default(), sink),
};

/// Reads a file under conventions other than the usual ones.
pub fn read(source: &Source, conventions: &Conventions, sink: &mut Sink<'_>) -> Option<Input> {
    let document = Document::parse(source, conventions.language, sink)?;
    let program = document.check(conventions, sink).program?;
    Some(Input::Program(Box::new(program)))
}

impl std::fmt::Debug for Document<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Document")
            .field("name", &self.source.name())
            .field("lines", &self.tree.lines.len())
            .finish()
    }
}

impl<'s> Document<'s> {
    /// Parses a file. Lines that cannot be read are reported and kept as they are; `None` only for what is no text.
    pub fn parse(source: &'s Source, language: Language, sink: &mut Sink<'_>) -> Option<Self> {
        let bytes = source.bytes();
        if bytes.len() > MAX_FILE {
            let message = format!("the file has {} bytes, more than {MAX_FILE}", bytes.len());
            sink.push(Diagnostic::new(Code::Limit, message).at(source.span(0..0), ""));
            return None;
        }
        let text = match source.text() {
            Ok(text) => text,
            Err(offset) => {
                let byte = bytes.get(offset).copied().unwrap_or_default();
                let message = format!("byte {byte:#04x} at offset {offset} is not UTF-8");
                let help = "save the file as UTF-8 text";
                let span = source.span(offset..offset + 1);
                sink.push(Diagnostic::new(Code::BadText, message).at(span, "").help(help));
                return None;
            }
        };
        let (tree, words) = lines::parse(text, language);
        let mut failed = false;
        for fault in &tree.faults {
            let found = report::line_fault(fault, source, text, &words);
            failed |= found.severity == Severity::Error;
            sink.push(found);
        }
        Some(Self { source, text, tree, failed })
    }

    /// Works out what every row does on the loops of the one below.
    pub fn check(&self, conventions: &Conventions, sink: &mut Sink<'_>) -> Checked {
        check::check(self, conventions, sink)
    }
}
