//! `[trunk]` and `[[branch]]`: the keys of one tube, and what the geometry has against them.

use super::curve::{self, Segment};
use super::section::{self, Placed};
use super::short;
use super::walk::{Value, Walk};
use crate::diag::{Code, Diagnostic, Span};
use crate::shape::{End, Fault, Interpolation, Profile, Sweep, TubeSpec};

const KEYS: &[&str] = &["curve", "start", "end", "section", "interpolation"];
const BRANCH_KEYS: &[&str] = &["curve", "start", "end", "section", "interpolation", "name", "from"];
const ENDS: &[(&str, End)] = &[("open", End::Open), ("closed", End::Closed)];
const INTERPOLATIONS: &[(&str, Interpolation)] =
    &[("linear", Interpolation::Linear), ("smooth", Interpolation::Smooth)];

/// The keys of one tube with their places.
#[derive(Debug)]
pub(super) struct Tube {
    segments: Vec<Segment>,
    sections: Vec<Placed>,
    interpolation: Interpolation,
    places: Places,
}

/// Where the parts of a tube stand in the file, and its ends.
#[derive(Debug)]
pub(super) struct Places {
    /// The end at u = 0.
    pub(super) start: End,
    /// The end at u = 1.
    pub(super) end: End,
    home: Span,
    sections: Vec<(f64, Span)>,
}

impl Places {
    /// Where the section nearest to a curve parameter stands.
    pub(super) fn section(&self, at: f64) -> Span {
        let near = self.sections.iter().min_by(|a, b| (a.0 - at).abs().total_cmp(&(b.0 - at).abs()));
        near.map_or(self.home, |(_, span)| *span)
    }
}

/// Reads a tube; `place` is its key.
pub(super) fn read(walk: &mut Walk<'_>, value: &Value<'_>, place: Span, home: &str) -> Option<Tube> {
    let table = walk.table(value, home, "a table with `curve` and `section`")?;
    let known = if home == "branch" { BRANCH_KEYS } else { KEYS };
    let home = format!("`{home}`");
    walk.known(table, &home, known);
    let found = walk.need(table, "curve", (&home, place), "curve = [[0, 0, 0], [0, 0, 10]]");
    let segments = found.and_then(|(_, value)| curve::read(walk, value));
    let found = walk.need(table, "section", (&home, place), "section = [{ at = 0, circle = 1 }]");
    let sections = found.and_then(|(_, value)| section::read(walk, value));
    let mut end = |key: &str| match walk.get(table, key) {
        Some((_, value)) => walk.word(value, key, ENDS),
        None => Some(End::Open),
    };
    let (start, end) = (end("start"), end("end"));
    let interpolation = match walk.get(table, "interpolation") {
        Some((_, value)) => walk.word(value, "interpolation", INTERPOLATIONS),
        None => Some(Interpolation::Linear),
    };
    let (segments, sections, start, end) = (segments?, sections?, start?, end?);
    sizes(walk, &sections, start, end).then_some(())?;
    let stations = sections.iter().map(|section| (section.section.at, section.span)).collect();
    let places = Places { start, end, home: place, sections: stations };
    Some(Tube { segments, sections, interpolation: interpolation?, places })
}

/// A tube may shrink to a point only where it is closed.
fn sizes(walk: &mut Walk<'_>, sections: &[Placed], start: End, end: End) -> bool {
    let mut sound = true;
    for placed in sections {
        let Profile::Ellipse { axes: [a, b], .. } = placed.section.profile else { continue };
        let at = placed.section.at;
        let closed = (at == 0.0 && start == End::Closed) || (at == 1.0 && end == End::Closed);
        if (a > 0.0 && b > 0.0) || (closed && a == b) {
            continue;
        }
        sound = false;
        let help = if at == 0.0 && a == b {
            "a tube that starts from a point has `start = \"closed\"`"
        } else if at == 1.0 && a == b {
            "a tube that ends in a point has `end = \"closed\"`"
        } else {
            "only a closed end may shrink to a point, with all radii 0"
        };
        let message = format!("the section at {} has radius 0", short(at));
        walk.fault(Code::SizeNotPositive, placed.size, message, "expected a radius above zero", help);
    }
    sound
}

impl Tube {
    /// The surface with rims of radius `rim` (mm) on its caps, and where its parts stand; `None` when the geometry cannot
    /// be, with the reason reported.
    pub(super) fn sweep(self, rim: f64, walk: &mut Walk<'_>) -> Option<(Sweep, Places)> {
        let spec = TubeSpec {
            curve: self.segments.iter().map(|segment| segment.bezier).collect(),
            sections: self.sections.iter().map(|placed| placed.section.clone()).collect(),
            interpolation: self.interpolation,
            start: self.places.start,
            end: self.places.end,
        };
        match Sweep::with_rim(&spec, rim) {
            Ok(sweep) => Some((sweep, self.places)),
            Err(fault) => {
                let diagnostic = self.explain(fault);
                walk.report(diagnostic);
                None
            }
        }
    }

    fn explain(&self, fault: Fault) -> Diagnostic {
        match fault {
            Fault::NotFinite => {
                Diagnostic::new(Code::BadNumber, fault.to_string()).at(self.places.home, "in here")
            }
            Fault::Empty => {
                Diagnostic::new(Code::EmptyList, fault.to_string()).at(self.places.home, "in here")
            }
            Fault::TooMany { limit } => {
                let message = format!("the tube has more than {limit} segments, sections or points");
                Diagnostic::new(Code::TooManyEntries, message).at(self.places.home, "in here")
            }
            Fault::ZeroLength { segment } => {
                let span = self.segments.get(segment).map_or(self.places.home, |segment| segment.span);
                Diagnostic::new(Code::SegmentLength, "a curve segment has no length").at(span, "")
            }
            Fault::Gap { segment, distance } => {
                let span = self.segments.get(segment).map_or(self.places.home, |segment| segment.span);
                let message =
                    format!("a curve segment starts {} mm away from the one before", short(distance));
                Diagnostic::new(Code::CurveGap, message).at(span, "starts here")
            }
            Fault::SectionOrder { section } => {
                let message = "a section is out of order";
                Diagnostic::new(Code::SectionOrder, message).at(self.placed(section), "")
            }
            Fault::SectionSize { section } => {
                let message = "a section has no size";
                Diagnostic::new(Code::SizeNotPositive, message).at(self.placed(section), "")
            }
            Fault::SectionNotEnclosing { section } => {
                let message = "a loop does not run around once";
                Diagnostic::new(Code::SectionLoop, message)
                    .at(self.placed(section), "it crosses itself, turns twice, or has no inside")
                    .help("list the points in the order in which they lie around the tube")
            }
            Fault::Kink { u, degrees } => {
                let message = if degrees.is_finite() {
                    format!("the curve turns by {degrees:.0} degrees on the spot at u = {u:.2}")
                } else {
                    format!("the curve turns back on the spot at u = {u:.2}")
                };
                let (last, first) = (self.segment(u - 1e-9), self.segment(u));
                let diagnostic = Diagnostic::new(Code::CurveKink, message).at(first, "turns here");
                let diagnostic =
                    if last == first { diagnostic } else { diagnostic.at(last, "from the end of this one") };
                diagnostic.help("let the segments meet in one line: the last two points of one and the first two of the next")
            }
            Fault::Fold { u, ratio } => {
                let message =
                    format!("curve too tight at u = {u:.2}: curvature x radius = {ratio:.2} (must be < 1)");
                let section = self.places.section(u);
                Diagnostic::new(Code::CurveTooTight, message)
                    .at(self.segment(u), "the curve bends here")
                    .at(section, "and this is the section nearest to it")
                    .help("bend the curve more gently, or make the tube thinner there")
            }
            Fault::SelfIntersect { u, other_u } => {
                let message = format!("the tube at u = {u:.2} runs through itself at u = {other_u:.2}");
                let (one, other) = (self.segment(u), self.segment(other_u));
                let diagnostic = Diagnostic::new(Code::TubeCrossesItself, message).at(one, "here");
                let diagnostic = if one == other { diagnostic } else { diagnostic.at(other, "and here") };
                diagnostic.help("lead the curve around the tube, or make the tube thinner")
            }
        }
    }

    /// Where a section stands.
    fn placed(&self, section: usize) -> Span {
        self.sections.get(section).map_or(self.places.home, |placed| placed.size)
    }

    /// Where the segment at a curve parameter stands.
    fn segment(&self, u: f64) -> Span {
        let index = (u.clamp(0.0, 1.0) * self.segments.len() as f64) as usize;
        let segment = self.segments.get(index).or(self.segments.last());
        segment.map_or(self.places.home, |segment| segment.span)
    }
}
