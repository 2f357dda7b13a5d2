//! Diagnostics with the source beside them, in the manner of rustc: the only user of annotate-snippets.

mod excerpt;

use super::{place, printable};
use crate::diag::position::{Location, Positions};
use crate::diag::{Diagnostic, Fix, Label, Severity};
use annotate_snippets::{AnnotationKind, Group, Level, Origin, Patch, Renderer, Snippet, Title};

/// Labels shown of one diagnostic; the rest is counted.
const MOST_LABELS: usize = 12;
/// Terminal columns to which long source lines are cut.
const WIDTH: usize = 120;

/// The diagnostic as a block of text, without a line feed at its end. Long lines, bytes that are no UTF-8 and control
/// characters are safe: what is shown is cut and cleaned. `color` adds ANSI escapes.
pub fn terminal(diagnostic: &Diagnostic, positions: &Positions<'_>, color: bool) -> String {
    let renderer = if color { Renderer::styled() } else { Renderer::plain() };
    let message = printable(&diagnostic.message);
    let title = level(diagnostic.severity).primary_title(message).id(diagnostic.code.as_str());
    let mut report = vec![body(title, diagnostic, positions)];
    report.extend(diagnostic.fixes.iter().map(|fix| repair(fix, positions)));
    renderer.term_width(WIDTH).render(&report)
}

/// Text of several lines.
fn lines(text: &str) -> String {
    text.lines().map(printable).collect::<Vec<_>>().join("\n")
}

fn level(severity: Severity) -> Level<'static> {
    match severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Note => Level::NOTE,
    }
}

/// The finding itself: its places with the text around them, and what would make it right.
fn body<'a>(title: Title<'a>, diagnostic: &Diagnostic, positions: &Positions<'_>) -> Group<'a> {
    let mut group = Group::with_title(title);
    let labels: Vec<(Location<'_>, &Label, bool)> = diagnostic
        .labels
        .iter()
        .take(MOST_LABELS)
        .enumerate()
        .filter_map(|(index, label)| Some((positions.locate(label.span)?, label, index == 0)))
        .collect();
    for excerpt in excerpt::around(labels.iter().map(|(location, ..)| location)) {
        let inside = || labels.iter().filter(|(location, ..)| excerpt.covers(location));
        let Some((first, ..)) = inside().next() else { continue };
        let name = printable(first.source.name());
        let mut snippet = Snippet::source(excerpt.text.clone()).line_start(excerpt.line);
        if excerpt.cut {
            let origin = Origin::path(name).line(first.line).char_column(first.column);
            group = group.element(origin);
        } else {
            snippet = snippet.path(name);
        }
        group = group.element(snippet.annotations(inside().map(|(location, label, primary)| {
            let kind = if *primary { AnnotationKind::Primary } else { AnnotationKind::Context };
            let message = (!label.message.is_empty()).then(|| printable(&label.message));
            kind.span(excerpt.map(location.range.clone())).label(message)
        })));
    }
    if diagnostic.labels.len() > MOST_LABELS {
        let rest = diagnostic.labels.len() - MOST_LABELS;
        group = group.element(Level::NOTE.message(format!("and {rest} more places")));
    }
    if let (true, Some(at)) = (labels.is_empty(), &diagnostic.place) {
        group = group.element(Level::NOTE.message(format!("in {}", printable(&place(at)))));
    }
    if let Some(help) = &diagnostic.help {
        group = group.element(Level::HELP.message(lines(help)));
    }
    group
}

/// A repair: its title, and the changed lines where they are few and near each other.
fn repair<'a>(fix: &Fix, positions: &Positions<'_>) -> Group<'a> {
    let group = Group::with_title(Level::HELP.secondary_title(printable(&fix.title)));
    let places: Option<Vec<Location<'_>>> =
        fix.edits.iter().map(|edit| positions.locate(edit.span)).collect();
    let Some(places) = places.filter(|places| !places.is_empty()) else { return group };
    let mut excerpts = excerpt::around(places.iter()).into_iter();
    let (Some(excerpt), None) = (excerpts.next(), excerpts.next()) else { return group };
    if !excerpt.exact || fix.edits.iter().any(|edit| edit.replacement.contains(char::is_control)) {
        return group;
    }
    let patches = places
        .iter()
        .zip(&fix.edits)
        .map(|(location, edit)| Patch::new(excerpt.map(location.range.clone()), edit.replacement.clone()));
    group.element(Snippet::source(excerpt.text.clone()).line_start(excerpt.line).patches(patches))
}
