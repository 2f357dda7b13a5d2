//! Repairs: the certain fixes of a pattern, each applied only if a fresh check then finds less.

use super::{Conventions, Document};
use crate::diag::{Diagnostic, Severity, Sink, Source, Sources};

/// Most repairs of one file.
const MAX_REPAIRS: usize = 1000;

/// Applies certain fixes until none is left; returns the text and what was done.
pub fn mend(name: &str, text: &str, conventions: &Conventions) -> (String, Vec<String>) {
    let mut text = text.to_owned();
    let mut done = Vec::new();
    let Some(mut found) = faults(name, &text, conventions) else { return (text, done) };
    let mut tried = 0;
    while done.len() < MAX_REPAIRS && tried < found.fixes.len() {
        let Some(fix) = found.fixes.get(tried) else { break };
        let mut other = text.clone();
        for (range, replacement) in &fix.edits {
            other.replace_range(range.clone(), replacement);
        }
        match faults(name, &other, conventions) {
            Some(after) if after.errors < found.errors => {
                done.push(fix.title.clone());
                (text, found, tried) = (other, after, 0);
            }
            _ => tried += 1,
        }
    }
    (text, done)
}

/// Errors of a text, and the certain fixes among them.
struct Faults {
    errors: usize,
    fixes: Vec<Edits>,
}

struct Edits {
    title: String,
    /// The last one first, so that places stay right.
    edits: Vec<(std::ops::Range<usize>, String)>,
}

fn faults(name: &str, text: &str, conventions: &Conventions) -> Option<Faults> {
    let loader = |_: &str| Err(std::io::Error::from(std::io::ErrorKind::NotFound));
    let mut sources = Sources::new(&loader);
    let source = sources.add(name, text.as_bytes().to_vec()).ok()?;
    let mut sink = Sink::new();
    let document = Document::parse(&source, conventions.language, &mut sink)?;
    document.check(conventions, &mut sink);
    let errors = sink.diagnostics().iter().filter(|found| found.severity == Severity::Error).count();
    let fixes = sink.diagnostics().iter().flat_map(|found| certain(found, &source)).collect();
    Some(Faults { errors, fixes })
}

fn certain(found: &Diagnostic, source: &Source) -> Vec<Edits> {
    let place = found.place.as_ref().and_then(|place| place.round);
    let fixes = found.fixes.iter().filter(|fix| fix.certain);
    fixes
        .filter_map(|fix| {
            let mut edits: Vec<_> = fix
                .edits
                .iter()
                .map(|edit| Some((source.range(edit.span)?, edit.replacement.clone())))
                .collect::<Option<_>>()?;
            edits.sort_by_key(|(range, _)| std::cmp::Reverse(range.start));
            let title =
                place.map_or_else(|| fix.title.clone(), |round| format!("round {round}: {}", fix.title));
            Some(Edits { title, edits })
        })
        .collect()
}
