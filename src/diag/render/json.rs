//! The diagnostic objects of the schema `picot.check/1`.

use crate::diag::{Diagnostic, Span, position::Positions};
use serde::Serialize;

/// One diagnostic as the schema has it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Object {
    code: &'static str,
    severity: &'static str,
    message: String,
    /// Name of the part, where the finding belongs to one.
    #[serde(skip_serializing_if = "Option::is_none")]
    part: Option<String>,
    round: Option<u32>,
    span: Option<SpanObject>,
    labels: Vec<LabelObject>,
    help: Option<String>,
    fixes: Vec<FixObject>,
}

/// Bytes of a file, and where they start as people count.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
struct SpanObject {
    start: usize,
    end: usize,
    line: usize,
    column: usize,
    /// The file, where it is not the one that the diagnostic is listed under.
    #[serde(skip_serializing_if = "Option::is_none")]
    path: Option<String>,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
struct LabelObject {
    span: SpanObject,
    message: String,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
struct FixObject {
    title: String,
    edits: Vec<EditObject>,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
struct EditObject {
    span: SpanObject,
    replacement: String,
}

/// The object of a diagnostic. A place without text is `null`; a span in another file than the primary one names its file.
pub fn object(diagnostic: &Diagnostic, positions: &Positions<'_>) -> Object {
    let primary = diagnostic.labels.first().and_then(|label| positions.locate(label.span));
    let home = primary.as_ref().map(|at| at.source.name());
    let span = |span: Span| {
        let at = positions.locate(span)?;
        Some(SpanObject {
            start: at.range.start,
            end: at.range.end,
            line: at.line,
            column: at.column,
            path: (home != Some(at.source.name())).then(|| at.source.name().to_owned()),
        })
    };
    let place = diagnostic.place.as_ref();
    Object {
        code: diagnostic.code.as_str(),
        severity: diagnostic.severity.name(),
        message: diagnostic.message.clone(),
        part: place.map(|place| place.part.clone()),
        round: place.and_then(|place| place.round),
        span: diagnostic.labels.first().and_then(|label| span(label.span)),
        labels: diagnostic
            .labels
            .iter()
            .filter_map(|label| Some(LabelObject { span: span(label.span)?, message: label.message.clone() }))
            .collect(),
        help: diagnostic.help.clone(),
        fixes: diagnostic
            .fixes
            .iter()
            .map(|fix| FixObject {
                title: fix.title.clone(),
                edits: fix
                    .edits
                    .iter()
                    .filter_map(|edit| {
                        Some(EditObject { span: span(edit.span)?, replacement: edit.replacement.clone() })
                    })
                    .collect(),
            })
            .collect(),
    }
}
