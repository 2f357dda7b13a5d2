//! What the readers of machine code share: the text of a file, places in it, and findings that do not repeat endlessly.

use crate::diag::{Code, Diagnostic, Sink, Source, Span};
use std::collections::BTreeMap;

/// Findings of one kind that are reported one by one.
const SHOWN: u32 = 20;

/// Reports faults of a text.
pub(super) struct Findings<'a, 's, 'o> {
    source: &'a Source,
    /// The whole file.
    pub text: &'a str,
    sink: &'s mut Sink<'o>,
    before: usize,
    seen: BTreeMap<Code, u32>,
}

impl<'a, 's, 'o> Findings<'a, 's, 'o> {
    /// Begins a file; `None`, with the reason reported, when it is no text.
    pub(super) fn new(source: &'a Source, sink: &'s mut Sink<'o>) -> Option<Self> {
        match source.text() {
            Ok(text) => {
                let before = sink.errors();
                Some(Self { source, text, sink, before, seen: BTreeMap::new() })
            }
            Err(offset) => {
                sink.push(
                    Diagnostic::new(Code::MachineCodeNotText, "the file is not UTF-8 text")
                        .at(source.span(offset..offset + 1), "this byte"),
                );
                None
            }
        }
    }

    /// The place of a piece of the text.
    pub(super) fn span(&self, part: &str) -> Span {
        let start = (part.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize);
        self.source.span(start..start + part.len())
    }

    /// Reports a fault at a piece of the text; an empty `help` says nothing.
    pub(super) fn say(&mut self, finding: Code, part: &str, message: impl Into<String>, help: &str) {
        let count = self.seen.entry(finding).or_default();
        *count += 1;
        if *count <= SHOWN {
            let mut diagnostic = Diagnostic::new(finding, message).at(self.span(part), "");
            if !help.is_empty() {
                diagnostic = diagnostic.help(help);
            }
            self.sink.push(diagnostic);
        }
    }

    /// Tells how many findings were held back; true when the file has no error.
    pub(super) fn end(self) -> bool {
        for (finding, count) in self.seen {
            if let Some(more) = count.checked_sub(SHOWN).filter(|more| *more > 0) {
                let message = format!("{more} more of the same: {}", finding.title());
                self.sink.push(Diagnostic::new(finding, message));
            }
        }
        self.sink.errors() == self.before
    }
}
