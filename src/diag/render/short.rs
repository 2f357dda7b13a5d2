//! One line a diagnostic: `file:line:column: error[E0101]: message`, as editors and `grep` like it.

use super::{head, place, printable};
use crate::diag::{Diagnostic, position::Positions};

/// The line, without a line feed.
pub fn short(diagnostic: &Diagnostic, positions: &Positions<'_>) -> String {
    let text = format!("{}: {}", head(diagnostic), printable(&diagnostic.message));
    let location = diagnostic.labels.first().and_then(|label| positions.locate(label.span));
    match (location, &diagnostic.place) {
        (Some(at), _) => format!("{}:{}:{}: {text}", printable(at.source.name()), at.line, at.column),
        (None, Some(at)) => format!("{}: {text}", printable(&place(at))),
        (None, None) => text,
    }
}
