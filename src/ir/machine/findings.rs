//! Findings of a run: each with its line and the field of the profile that it breaks, and never a flood of equal ones.

use super::{Code, Machine};
use crate::diag::{Code as Finding, Diagnostic, Sink, Span};
use std::collections::BTreeMap;

/// Findings of one kind that are reported one by one; the rest is counted.
const SHOWN: u32 = 10;

pub(super) struct Findings<'a, 's, 'o> {
    code: &'a Code,
    machine: Option<&'a Machine>,
    sink: &'s mut Sink<'o>,
    seen: BTreeMap<Finding, (u32, Span)>,
    /// The instruction of each finding that was pushed.
    places: Vec<Option<usize>>,
}

impl<'a, 's, 'o> Findings<'a, 's, 'o> {
    pub(super) fn new(code: &'a Code, machine: Option<&'a Machine>, sink: &'s mut Sink<'o>) -> Self {
        Self { code, machine, sink, seen: BTreeMap::new(), places: Vec::new() }
    }

    /// Reports a finding at an instruction. `field` names the profile field that it breaks, with its value.
    pub(super) fn push(
        &mut self,
        finding: Finding,
        op: Option<usize>,
        message: impl FnOnce(&Code) -> String,
        field: Option<(&str, String)>,
        help: &str,
    ) {
        let span = op.map(|op| self.code.span(op)).unwrap_or_default();
        let (count, last) = self.seen.entry(finding).or_default();
        *count += 1;
        *last = span;
        if *count > shown(finding) {
            return;
        }
        let mut text = message(self.code);
        if let Some(op) = op
            && span.is_none()
        {
            text = format!("{text} (instruction {})", op + 1);
        }
        let limit = field.map(|(key, value)| {
            let name = self.machine.map_or("", |machine| machine.name.as_str());
            format!("`{key}` of `{name}` is {value}")
        });
        let mut diagnostic = Diagnostic::new(finding, text).at(span, limit.clone().unwrap_or_default());
        let advice = match (limit, help) {
            (Some(limit), help) if span.is_none() && help.is_empty() => limit,
            (Some(limit), help) if span.is_none() => format!("{limit}; {help}"),
            (_, help) => help.to_owned(),
        };
        if !advice.is_empty() {
            diagnostic = diagnostic.help(advice);
        }
        self.places.push(op);
        self.sink.push(diagnostic);
    }

    /// Says how many findings were counted only.
    pub(super) fn finish(self) -> Vec<Option<usize>> {
        for (finding, (count, last)) in self.seen {
            if let Some(more) = count.checked_sub(shown(finding)).filter(|more| *more > 0) {
                let message = format!("{more} more of the same: {}", finding.title());
                self.sink.push(Diagnostic::new(finding, message).at(last, "the last one"));
            }
        }
        self.places
    }
}

/// A program for another machine breaks this rule on every line; once tells it.
fn shown(finding: Finding) -> u32 {
    if finding == Finding::TooManyCarriers { 1 } else { SHOWN }
}
