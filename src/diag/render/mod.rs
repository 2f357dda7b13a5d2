//! Diagnostics as text: one file a format. Nothing here asks for the terminal or the environment; the caller says what it wants.

pub mod json;
pub mod short;
pub mod terminal;

use super::{Diagnostic, Place};

/// Part and round in words, for what has no text to point into.
fn place(place: &Place) -> String {
    match place.round {
        Some(round) => format!("{}, round {round}", place.part),
        None => place.part.clone(),
    }
}

/// `error[E0101]`.
fn head(diagnostic: &Diagnostic) -> String {
    format!("{}[{}]", diagnostic.severity.name(), diagnostic.code.as_str())
}

/// Text of the input inside a message: control characters must not reach a terminal.
fn printable(text: &str) -> String {
    text.chars()
        .map(|c| match c {
            '\n' | '\r' | '\t' => ' ',
            c if c.is_control() || is_direction_mark(c) => '\u{FFFD}',
            c => c,
        })
        .collect()
}

/// Characters that reorder the text around them, which lets a message lie about what it quotes.
fn is_direction_mark(c: char) -> bool {
    matches!(c, '\u{200E}' | '\u{200F}' | '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}')
}
