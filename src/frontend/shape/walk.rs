//! Walking a TOML value with diagnostics: every accessor says what was expected and what was found, and where.

use super::super::unit::Unit;
use crate::diag::{Code, Diagnostic, Edit, Fix, Source, Span, did_you_mean};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeInteger, DeTable, DeValue};

/// A value with its place.
pub(super) type Value<'i> = Spanned<DeValue<'i>>;

/// Findings kept of one file; a file with more is broken in a way that more would not explain.
const MOST_FINDINGS: usize = 64;
/// Longest quote of the input in a message, in characters.
const LONGEST_QUOTE: usize = 40;

/// A number with its place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Number {
    /// The value.
    pub(super) value: f64,
    /// Where it stands.
    pub(super) span: Span,
}

/// The reading of one file: its findings so far, and the unit of its lengths.
#[derive(Debug)]
pub(super) struct Walk<'s> {
    source: &'s Source,
    found: Vec<Diagnostic>,
    dropped: usize,
    /// The unit of every length in the file.
    pub(super) unit: Unit,
}

impl<'s> Walk<'s> {
    pub(super) fn new(source: &'s Source) -> Self {
        Self { source, found: Vec::new(), dropped: 0, unit: Unit::Mm }
    }

    /// The span of a byte range of the file.
    pub(super) fn span(&self, range: Range<usize>) -> Span {
        self.source.span(range)
    }

    /// The span of a value.
    pub(super) fn of(&self, value: &Value<'_>) -> Span {
        self.span(value.span())
    }

    /// Takes a finding.
    pub(super) fn report(&mut self, diagnostic: Diagnostic) {
        if self.found.len() < MOST_FINDINGS {
            self.found.push(diagnostic);
        } else {
            self.dropped += 1;
        }
    }

    /// All findings in the order of the file.
    pub(super) fn finish(mut self) -> Vec<Diagnostic> {
        self.found.sort_by_key(|diagnostic| diagnostic.labels.first().map(|label| label.span));
        if self.dropped > 0 {
            let message = format!("{} more findings in this file are not shown", self.dropped);
            self.found.push(Diagnostic::new(Code::MoreFindings, message));
        }
        self.found
    }

    /// A finding on a value.
    pub(super) fn fault(&mut self, code: Code, span: Span, message: String, label: &str, help: &str) {
        let diagnostic = Diagnostic::new(code, message).at(span, label);
        self.report(if help.is_empty() { diagnostic } else { diagnostic.help(help) });
    }

    /// The value under `key` with the place of the key.
    pub(super) fn get<'t, 'i>(&self, table: &'t DeTable<'i>, key: &str) -> Option<(Span, &'t Value<'i>)> {
        let (key, value) = table.get_key_value(key)?;
        Some((self.span(key.span()), value))
    }

    /// The value under a key that must be there. `home` names the table, `place` is where it stands.
    pub(super) fn need<'t, 'i>(
        &mut self,
        table: &'t DeTable<'i>,
        key: &'static str,
        (home, place): (&str, Span),
        example: &str,
    ) -> Option<(Span, &'t Value<'i>)> {
        let found = self.get(table, key);
        if found.is_none() && !misspelled(table, key) {
            let message = format!("{home} has no `{key}`");
            self.fault(Code::MissingKey, place, message, "", &format!("add `{example}`"));
        }
        found
    }

    /// Reports every key that is not among `known`.
    pub(super) fn known(&mut self, table: &DeTable<'_>, home: &str, known: &[&'static str]) {
        for (key, _) in table {
            let name: &str = key.get_ref();
            if known.contains(&name) {
                continue;
            }
            let span = self.span(key.span());
            let message = format!("unknown key `{}` in {home}", quote(name));
            let diagnostic = Diagnostic::new(Code::UnknownKey, message);
            self.report(match did_you_mean(&name.to_lowercase(), known.iter().copied()) {
                Some(near) => diagnostic.at(span, format!("did you mean `{near}`?")).fix(replace(
                    format!("write `{near}`"),
                    span,
                    near,
                )),
                None => {
                    diagnostic.at(span, "not known here").help(format!("{home} knows {}", list(known, "and")))
                }
            });
        }
    }

    /// Reports a value of the wrong type.
    pub(super) fn mismatch(&mut self, value: &Value<'_>, what: &str, expected: &str) {
        let span = self.of(value);
        let message = format!("`{what}` is {}, expected {expected}", kind(value.get_ref()));
        let diagnostic = Diagnostic::new(Code::WrongType, message).at(span, "");
        let text = value.get_ref().as_str().filter(|_| expected.contains("number"));
        let number = text.and_then(|text| text.trim().parse::<f64>().ok());
        self.report(match number.filter(|number| number.is_finite()) {
            Some(number) => diagnostic.help("take the quotes away").fix(replace(
                "write it without quotes".to_owned(),
                span,
                &number.to_string(),
            )),
            None if expected.starts_with("a list") && value.get_ref().is_table() => {
                diagnostic.help("put it into brackets, even if it is the only one")
            }
            None => diagnostic,
        });
    }

    /// A table.
    pub(super) fn table<'t, 'i>(
        &mut self,
        value: &'t Value<'i>,
        what: &str,
        expected: &str,
    ) -> Option<&'t DeTable<'i>> {
        let found = value.get_ref().as_table();
        if found.is_none() {
            self.mismatch(value, what, expected);
        }
        found
    }

    /// A list of at least one and at most `most` entries.
    pub(super) fn list<'t, 'i>(
        &mut self,
        value: &'t Value<'i>,
        what: &str,
        expected: &str,
        most: usize,
    ) -> Option<&'t [Value<'i>]> {
        let Some(entries) = value.get_ref().as_array() else {
            self.mismatch(value, what, expected);
            return None;
        };
        let entries: &[Value<'i>] = entries;
        let span = self.of(value);
        if entries.is_empty() {
            self.fault(
                Code::EmptyList,
                span,
                format!("`{what}` is empty"),
                &format!("expected {expected}"),
                "",
            );
            return None;
        }
        if entries.len() > most {
            let message = format!("`{what}` has {} entries, at most {most} are read", entries.len());
            self.fault(Code::TooManyEntries, span, message, "", "");
            return None;
        }
        Some(entries)
    }

    /// Text.
    pub(super) fn text<'t>(&mut self, value: &'t Value<'_>, what: &str, expected: &str) -> Option<&'t str> {
        let found = value.get_ref().as_str();
        if found.is_none() {
            self.mismatch(value, what, expected);
        }
        found
    }

    /// One of some words.
    pub(super) fn word<T: Copy>(
        &mut self,
        value: &Value<'_>,
        what: &str,
        choices: &[(&'static str, T)],
    ) -> Option<T> {
        let words: Vec<&'static str> = choices.iter().map(|(word, _)| *word).collect();
        let text = self.text(value, what, &list(&words, "or"))?;
        if let Some((_, choice)) = choices.iter().find(|(word, _)| *word == text) {
            return Some(*choice);
        }
        let span = self.of(value);
        let message = format!("`{what}` cannot be \"{}\"", quote(text));
        let diagnostic = Diagnostic::new(Code::UnknownWord, message);
        self.report(match did_you_mean(&text.to_lowercase(), words.iter().copied()) {
            Some(near) => diagnostic.at(span, format!("did you mean \"{near}\"?")).fix(replace(
                format!("write \"{near}\""),
                span,
                &format!("\"{near}\""),
            )),
            None => diagnostic.at(span, format!("expected {}", list(&words, "or"))),
        });
        None
    }

    /// A finite number.
    pub(super) fn number(&mut self, value: &Value<'_>, what: &str) -> Option<Number> {
        let span = self.of(value);
        let written = value.get_ref();
        let float = written.as_float().map(|float| float.as_str().parse().unwrap_or(f64::NAN));
        let Some(value) = written.as_integer().map(integer_value).or(float) else {
            self.mismatch(value, what, "a number");
            return None;
        };
        if !value.is_finite() {
            let message = format!("`{what}` is no finite number");
            self.fault(Code::BadNumber, span, message, "expected a finite number", "");
            return None;
        }
        Some(Number { value, span })
    }

    /// A length in mm, converted from the unit of the file; of any sign, at most 10 km.
    pub(super) fn length(&mut self, value: &Value<'_>, what: &str) -> Option<Number> {
        let number = self.number(value, what)?;
        let millimeters = number.value * self.unit.mm();
        if millimeters.abs() > 1e7 {
            let message = format!("`{what}` is beyond 10 km");
            self.fault(Code::BadNumber, number.span, message, "", "is `unit` right?");
            return None;
        }
        Some(Number { value: millimeters, ..number })
    }

    /// A length in mm above zero.
    pub(super) fn size(&mut self, value: &Value<'_>, what: &str) -> Option<Number> {
        let size = self.length(value, what)?;
        self.positive(size, what)
    }

    /// Refuses zero and less.
    pub(super) fn positive(&mut self, number: Number, what: &str) -> Option<Number> {
        if number.value > 0.0 {
            return Some(number);
        }
        let message = format!("`{what}` must be above zero");
        self.fault(Code::SizeNotPositive, number.span, message, "", "");
        None
    }
}

/// True when the table has an unknown key that looks like `key`: its absence then has its diagnostic already.
pub(super) fn misspelled(table: &DeTable<'_>, key: &'static str) -> bool {
    table.keys().any(|written| {
        let written: &str = written.get_ref();
        written != key && did_you_mean(&written.to_lowercase(), [key]).is_some()
    })
}

/// A repair that replaces one place.
pub(super) fn replace(title: String, span: Span, replacement: &str) -> Fix {
    Fix { title, edits: vec![Edit { span, replacement: replacement.to_owned() }], certain: false }
}

/// Text of the input for a message: not longer than a message can bear.
pub(super) fn quote(text: &str) -> String {
    match text.char_indices().nth(LONGEST_QUOTE) {
        Some((end, _)) => format!("{}...", text.get(..end).unwrap_or_default()),
        None => text.to_owned(),
    }
}

/// "`a`, `b` and `c`".
pub(super) fn list(words: &[&str], last_joint: &str) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
    match quoted.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} {last_joint} {last}", rest.join(", ")),
        _ => quoted.concat(),
    }
}

/// "1 point", "2 points".
pub(super) fn count(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}

/// What a value is, with its article.
fn kind(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a text",
        DeValue::Integer(_) | DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "true or false",
        DeValue::Datetime(_) => "a date or time",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}

/// The value of an integer in any base; infinite beyond the range of 128 bits.
fn integer_value(integer: &DeInteger<'_>) -> f64 {
    i128::from_str_radix(integer.as_str(), integer.radix()).map_or(f64::INFINITY, |value| value as f64)
}
