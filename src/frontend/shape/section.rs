//! `section`: the profiles along a curve.

use super::curve::point;
use super::walk::{Number, Value, Walk, count, list, misspelled};
use crate::diag::{Code, Diagnostic, Span};
use crate::shape::{Profile, Section};
use glam::{DVec2, DVec3};
use toml::de::DeTable;

/// Most sections of a tube.
const MOST_SECTIONS: usize = 1024;
/// Most points of a loop.
const MOST_POINTS: usize = 10_000;
const FORMS: &[&str] = &["circle", "ellipse", "loop"];

/// A section with the places that a fault may point at.
#[derive(Clone, Debug)]
pub(super) struct Placed {
    /// The section, lengths in mm.
    pub(super) section: Section,
    /// The whole entry.
    pub(super) span: Span,
    /// The value of `at`.
    pub(super) at: Span,
    /// The value of `circle`, `ellipse` or `loop`.
    pub(super) size: Span,
}

impl Placed {
    /// The same at another place of the curve.
    pub(super) fn moved(mut self, at: f64) -> Self {
        self.section.at = at;
        self
    }
}

/// Reads `section`: entries in ascending order of `at`.
pub(super) fn read(walk: &mut Walk<'_>, value: &Value<'_>) -> Option<Vec<Placed>> {
    const EXPECTED: &str = "a list such as [{ at = 0, circle = 1 }]";
    let entries = walk.list(value, "section", EXPECTED, MOST_SECTIONS)?;
    let read: Vec<Option<Placed>> = entries.iter().map(|entry| section(walk, entry)).collect();
    let sections: Vec<Placed> = read.into_iter().collect::<Option<_>>()?;
    ascending(walk, &sections).then_some(sections)
}

fn section(walk: &mut Walk<'_>, value: &Value<'_>) -> Option<Placed> {
    const HOME: &str = "a section";
    let table = walk.table(value, "section", "a table such as { at = 0, circle = 1 }")?;
    let span = walk.of(value);
    walk.known(table, HOME, &["at", "circle", "ellipse", "loop", "offset"]);
    let at = walk.need(table, "at", (HOME, span), "at = 0");
    let at = at.and_then(|(_, value)| place(walk, value));
    let offset = match walk.get(table, "offset") {
        Some((_, value)) => offset(walk, value),
        None => Some(DVec2::ZERO),
    };
    let form = form(walk, table, span);
    let profile = form.and_then(|(name, value)| profile(walk, name, value, offset.unwrap_or_default()));
    offset?;
    let (at, profile) = (at?, profile?);
    let size = form.map_or(span, |(_, value)| walk.of(value));
    Some(Placed { section: Section { at: at.value, profile }, span, at: at.span, size })
}

/// The curve parameter of a section.
fn place(walk: &mut Walk<'_>, value: &Value<'_>) -> Option<Number> {
    let at = walk.number(value, "at")?;
    if (0.0..=1.0).contains(&at.value) {
        return Some(at);
    }
    let message = format!("a section lies at {}, outside of the curve", super::short(at.value));
    let help = "`at` counts from 0 at the start of the curve to 1 at its end, whatever the unit";
    walk.fault(Code::SectionPlace, at.span, message, "expected 0 to 1", help);
    None
}

/// The one of `circle`, `ellipse` and `loop` that is given.
fn form<'t, 'i>(
    walk: &mut Walk<'_>,
    table: &'t DeTable<'i>,
    span: Span,
) -> Option<(&'static str, &'t Value<'i>)> {
    let given: Vec<(&'static str, Span, &Value<'i>)> = FORMS
        .iter()
        .filter_map(|form| walk.get(table, form).map(|(span, value)| (*form, span, value)))
        .collect();
    match given.as_slice() {
        [(name, _, value)] => Some((name, value)),
        [] => {
            if FORMS.iter().any(|form| misspelled(table, form)) {
                return None;
            }
            let message = "a section has no profile".to_owned();
            let help = format!("give one of {}", list(FORMS, "or"));
            walk.fault(Code::SectionForm, span, message, "", &help);
            None
        }
        [(one, first, _), (other, second, _), ..] => {
            walk.report(
                Diagnostic::new(Code::SectionForm, format!("a section is a `{one}` and a `{other}`"))
                    .at((*first).max(*second), "given again here")
                    .at((*first).min(*second), "given here")
                    .help("keep one of them"),
            );
            None
        }
    }
}

fn offset(walk: &mut Walk<'_>, value: &Value<'_>) -> Option<DVec2> {
    let [x, y] = pair(walk, value, "offset", "two lengths [dx, dy]")?;
    Some(DVec2::new(x.value, y.value))
}

fn pair(walk: &mut Walk<'_>, value: &Value<'_>, what: &str, expected: &str) -> Option<[Number; 2]> {
    let Some(entries) = value.get_ref().as_array() else {
        walk.mismatch(value, what, expected);
        return None;
    };
    let entries: &[Value<'_>] = entries;
    let [first, second] = entries else {
        let span = walk.of(value);
        let message = format!("`{what}` has {}", count(entries.len(), "number"));
        walk.fault(Code::PointForm, span, message, &format!("expected {expected}"), "");
        return None;
    };
    let (first, second) = (walk.length(first, what), walk.length(second, what));
    Some([first?, second?])
}

fn profile(walk: &mut Walk<'_>, form: &str, value: &Value<'_>, offset: DVec2) -> Option<Profile> {
    match form {
        "circle" => {
            let radius =
                walk.length(value, "circle").and_then(|radius| not_negative(walk, radius, "circle"))?;
            Some(Profile::Ellipse { axes: [radius.value; 2], offset })
        }
        "ellipse" => {
            let [a, b] = pair(walk, value, "ellipse", "two radii [a, b]")?;
            let (a, b) = (not_negative(walk, a, "ellipse"), not_negative(walk, b, "ellipse"));
            Some(Profile::Ellipse { axes: [a?.value, b?.value], offset })
        }
        _ => {
            let entries = walk.list(value, "loop", "a list of points [x, y, z]", MOST_POINTS)?;
            if entries.len() < 3 {
                let span = walk.of(value);
                let message = format!("a loop has {}", count(entries.len(), "point"));
                walk.fault(Code::SectionLoop, span, message, "expected three or more", "");
                return None;
            }
            let read: Vec<Option<DVec3>> =
                entries.iter().map(|entry| point(walk, entry, "loop", 2)).collect();
            let points: Vec<DVec3> = read.into_iter().collect::<Option<_>>()?;
            Some(Profile::Loop(points.into_iter().map(|point| point + offset.extend(0.0)).collect()))
        }
    }
}

fn not_negative(walk: &mut Walk<'_>, size: Number, what: &str) -> Option<Number> {
    if size.value >= 0.0 {
        return Some(size);
    }
    let message = format!("`{what}` is negative");
    walk.fault(Code::SizeNotPositive, size.span, message, "expected a radius above zero", "");
    None
}

/// Checks that `at` ascends.
fn ascending(walk: &mut Walk<'_>, sections: &[Placed]) -> bool {
    let mut sorted = true;
    for pair in sections.windows(2) {
        let (before, after) = (&pair[0], &pair[1]);
        if after.section.at <= before.section.at {
            sorted = false;
            let (low, high) = (super::short(after.section.at), super::short(before.section.at));
            let message = if low == high {
                format!("two sections lie at {low}")
            } else {
                format!("the section at {low} follows the one at {high}")
            };
            walk.report(
                Diagnostic::new(Code::SectionOrder, message)
                    .at(after.at, "must lie further along the curve")
                    .at(before.at, "than this one")
                    .help("list the sections from the start of the curve to its end"),
            );
        }
    }
    sorted
}
