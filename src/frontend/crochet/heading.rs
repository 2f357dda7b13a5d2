//! What the head of a file declares: title, gauge, terms and conventions.

use super::Document;
use super::conventions::{Conventions, Setting};
use super::lex::At;
use super::syntax::{Content, Header, Pair};
use crate::diag::{Code, Diagnostic};
use crate::ir::maker::MOST_LEAN;
use crate::ir::{Gauge, Hand, Language, Maker, Terms};

/// Declarations that become part of the program.
pub(super) struct Heading {
    pub title: String,
    pub gauge: Option<Gauge>,
    pub maker: Maker,
    pub colors: Vec<String>,
}

/// Reads all headers of a file.
pub(super) fn read(
    document: &Document<'_>,
    conventions: &mut Conventions,
    found: &mut Vec<Diagnostic>,
) -> Heading {
    let stem = document.source.name().rsplit(['/', '\\']).next().unwrap_or_default();
    let stem = stem.rsplit_once('.').map_or(stem, |(stem, _)| stem);
    let mut heading =
        Heading { title: stem.to_owned(), gauge: None, maker: Maker::default(), colors: Vec::new() };
    let text = |at: At| document.text.get(at.range()).unwrap_or_default().trim();
    let mut wrong = |at: At, what: String| {
        let span = document.source.span(at.range());
        found.push(Diagnostic::new(Code::BadHeader, format!("expected {what}")).at(span, ""));
    };
    for line in &document.tree.lines {
        let Content::Header(header) = &line.what else { continue };
        match &**header {
            Header::Pair { key: Pair::Title, value } => text(*value).clone_into(&mut heading.title),
            Header::Pair { key: Pair::Terms, value } => {
                if let Err(right) = conventions.set("terms", text(*value)) {
                    wrong(*value, right);
                }
            }
            Header::Pair { key: Pair::Gauge, value } => heading.gauge = gauge(text(*value)).or(heading.gauge),
            Header::Pair { key: Pair::Lean, value } => {
                let lean: Option<f64> = text(*value).parse().ok();
                match lean.filter(|lean| lean.abs() <= MOST_LEAN) {
                    Some(lean) => heading.maker.lean = lean,
                    None => wrong(*value, "stitches a round, from -1 to 1".to_owned()),
                }
            }
            Header::Convention { settings } => {
                for (key, value) in settings {
                    if let Err(right) = conventions.set(text(*key), text(*value)) {
                        wrong(key.to(*value), right);
                    }
                }
            }
            Header::Pair { .. } | Header::Color { .. } | Header::Def { .. } => {}
        }
    }
    heading.maker.hand = if conventions.is(Setting::Hand, "left") { Hand::Left } else { Hand::Right };
    heading
}

/// `2.5 mm x 2.5 mm` as the size of a stitch; other ways of telling the gauge stay text.
fn gauge(text: &str) -> Option<Gauge> {
    let (width, height) = text.split_once(['x', '×'])?;
    let split = |text: &str| {
        let text = text.trim();
        let unit_at = text.find(char::is_alphabetic).unwrap_or(text.len());
        let value: Option<f64> = text.get(..unit_at)?.trim().parse().ok();
        Some((value?, text.get(unit_at..)?.split([' ', ',']).next().unwrap_or_default().to_owned()))
    };
    // `2.5 x 2.5 mm`: one unit may stand for both.
    let ((wide, wide_unit), (high, high_unit)) = (split(width)?, split(height)?);
    let length = |value: f64, unit: &str| {
        let factor = match if unit.is_empty() { high_unit.as_str() } else { unit } {
            "mm" => 1.0,
            "cm" => 10.0,
            "in" | "inch" | "inches" => 25.4,
            _ => return None,
        };
        let millimeters = value * factor;
        (millimeters.is_finite() && millimeters > 0.0 && millimeters < 1000.0).then_some(millimeters)
    };
    Some(Gauge::new(length(wide, &wide_unit)?, length(high, &high_unit)?))
}

/// The terms of the file, by declaration or by its words.
pub(super) fn terms(
    document: &Document<'_>,
    conventions: &Conventions,
    found: &mut Vec<Diagnostic>,
) -> Terms {
    let evidence = document.tree.evidence;
    let span = |at: At| document.source.span(at.range());
    let said = |at: At| document.text.get(at.range()).unwrap_or_default();
    let declared = match conventions.get(Setting::Terms) {
        "us" => Some((Terms::Us, evidence.uk)),
        "uk" => Some((Terms::Uk, evidence.us)),
        _ => None,
    };
    if let Some((terms, contrary)) = declared {
        if let Some(at) = contrary {
            let other = if terms == Terms::Us { "UK" } else { "US" };
            let message = format!(
                "`{}` is a {other} term, and the pattern is in {} terms",
                said(at),
                terms.name().to_uppercase()
            );
            found.push(
                Diagnostic::new(Code::TermsUndecided, message)
                    .at(span(at), "")
                    .help(format!("declare `terms: {}`, or use one vocabulary", other.to_lowercase())),
            );
        }
        return terms;
    }
    match (evidence.terms(), evidence.us, evidence.uk) {
        (Some(terms), ..) => terms,
        (None, Some(us), Some(uk)) => {
            let message = format!("`{}` is a US term and `{}` a UK term", said(us), said(uk));
            found.push(
                Diagnostic::new(Code::TermsUndecided, message)
                    .at(span(uk), "UK")
                    .at(span(us), "US")
                    .help("use one vocabulary, and declare it: `terms: us` or `terms: uk`"),
            );
            Terms::Us
        }
        _ => {
            let english = document.tree.language == Language::English;
            let at = evidence.open.unwrap_or_default();
            let message = format!(
                "`{}` is one stitch in US terms and another in UK terms, and nothing tells which",
                said(at)
            );
            let lang = if english { "" } else { ", or say it in the language of the pattern" };
            found.push(
                Diagnostic::new(Code::TermsUndecided, message)
                    .at(span(at), "")
                    .help(format!("declare `terms: us` or `terms: uk`{lang}")),
            );
            Terms::Us
        }
    }
}
