//! `[trunk]` and `[[branch]]`: the keys of one tube, and what the geometry has against them.

use super::curve::{self, Segment};
use super::section::{self, Placed};
use super::short;
use super::walk::{Value, Walk};
use crate::diag::{Code, Diagnostic, Span};
use crate::math;
use crate::shape::{Bezier, End, Fault, Interpolation, Profile, Sweep, TubeSpec};
use glam::DVec3;

const KEYS: &[&str] = &["curve", "start", "end", "section", "interpolation"];
const BRANCH_KEYS: &[&str] =
    &["curve", "start", "end", "section", "interpolation", "name", "from", "on", "join"];
const ENDS: &[(&str, End)] = &[("open", End::Open), ("closed", End::Closed)];
const INTERPOLATIONS: &[(&str, Interpolation)] =
    &[("linear", Interpolation::Linear), ("smooth", Interpolation::Smooth)];

/// Radius of the corner between a tube and the one that carries it on, in radii of the tube, and the greatest share
/// of a segment that it takes.
const CORNER: f64 = 1.6;
const LONGEST_CORNER: f64 = 0.45;

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
    curve: Vec<Segment>,
    sections: Vec<Station>,
}

/// Where a section stands, along the curve and in the file, and how far it reaches from the curve in mm.
#[derive(Clone, Copy, Debug)]
struct Station {
    at: f64,
    span: Span,
    reach: f64,
}

impl Places {
    /// Where the tube stands.
    pub(super) fn home(&self) -> Span {
        self.home
    }

    /// Where the beginning of the curve stands.
    pub(super) fn curve(&self) -> Span {
        self.curve.first().map_or(self.home, |segment| segment.span)
    }

    /// The point of the curve at a parameter, in mm.
    pub(super) fn point(&self, at: f64) -> DVec3 {
        let x = at.clamp(0.0, 1.0) * self.curve.len() as f64;
        let index = (x as usize).min(self.curve.len().saturating_sub(1));
        self.curve.get(index).map_or(DVec3::ZERO, |segment| segment.bezier.point(x - index as f64))
    }

    /// How far the tube reaches from its curve at a parameter, in mm.
    pub(super) fn radius(&self, at: f64) -> f64 {
        let after = self.sections.iter().find(|section| section.at >= at).or(self.sections.last());
        let before = self.sections.iter().rev().find(|section| section.at <= at).or(self.sections.first());
        let (Some(before), Some(after)) = (before, after) else { return 0.0 };
        let span = after.at - before.at;
        let share = if span > 0.0 { (at - before.at) / span } else { 0.0 };
        before.reach + (after.reach - before.reach) * share
    }

    /// Where the section nearest to a curve parameter stands.
    pub(super) fn section(&self, at: f64) -> Span {
        let near = self.sections.iter().min_by(|a, b| (a.at - at).abs().total_cmp(&(b.at - at).abs()));
        near.map_or(self.home, |section| section.span)
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
    let places = Places { start, end, home: place, curve: Vec::new(), sections: Vec::new() };
    Some(Tube { segments, sections, interpolation: interpolation?, places })
}

/// Unit direction of a segment at one of its ends, where control points may coincide.
fn direction(bezier: &Bezier, t: f64) -> DVec3 {
    let inside = if t < 0.5 { 1e-6 } else { 1.0 - 1e-6 };
    bezier.derivative(t).try_normalize().unwrap_or_else(|| bezier.derivative(inside).normalize_or_zero())
}

/// The two parts of a segment, before and after a parameter (de Casteljau).
fn split(bezier: &Bezier, t: f64) -> (Bezier, Bezier) {
    let mut points = bezier.points().to_vec();
    let (mut before, mut after) = (Vec::new(), Vec::new());
    while let (Some(first), Some(last)) = (points.first().copied(), points.last().copied()) {
        before.push(first);
        after.push(last);
        points = points.windows(2).map(|pair| pair[0].lerp(pair[1], t)).collect();
    }
    after.reverse();
    (Bezier::new(&before).unwrap_or(*bezier), Bezier::new(&after).unwrap_or(*bezier))
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

/// Greatest distance of a profile from the curve.
fn reach(profile: &Profile) -> f64 {
    match profile {
        Profile::Ellipse { axes, offset } => axes[0].max(axes[1]) + offset.length(),
        Profile::Loop(points) => points.iter().map(|point| point.length()).fold(0.0, f64::max),
    }
}

impl Tube {
    /// Where its parts stand.
    pub(super) fn places(&self) -> &Places {
        &self.places
    }

    /// Segments of its curve.
    pub(super) fn segment_count(&self) -> usize {
        self.segments.len()
    }

    /// Where its curve leads at its start.
    pub(super) fn direction_at_start(&self) -> DVec3 {
        self.segments.first().map_or(DVec3::ZERO, |segment| direction(&segment.bezier, 0.0))
    }

    /// Where its curve leads at its end.
    pub(super) fn direction_at_end(&self) -> DVec3 {
        self.segments.last().map_or(DVec3::ZERO, |segment| direction(&segment.bezier, 1.0))
    }

    /// Goes on with another tube from its end, around a rounded corner. Returns the index of that tube's first segment.
    pub(super) fn carry_on(&mut self, next: Self) -> usize {
        let (own, theirs) = (self.segments.len(), next.segments.len());
        let first = own + 1;
        let all = (first + theirs) as f64;
        let (Some(last), Some(begin)) = (self.segments.last_mut(), next.segments.first()) else { return own };
        let width = |tube: &[Placed], end: bool| {
            let placed = if end { tube.last() } else { tube.first() };
            placed.map_or(0.0, |placed| reach(&placed.section.profile))
        };
        let radius = width(&self.sections, true).max(width(&next.sections, false));
        let (inward, outward) = (direction(&last.bezier, 1.0), direction(&begin.bezier, 0.0));
        let half = 0.5 * math::atan2(inward.cross(outward).length(), inward.dot(outward));
        let (sin, cos) = math::sin_cos(half);
        let room = (CORNER * radius * (sin / cos.max(0.1))).max(0.3 * radius);
        let cut = |length: f64| (room / length.max(1e-9)).min(LONGEST_CORNER);
        let (end, start) = (1.0 - cut(last.bezier.length()), cut(begin.bezier.length()));
        let mut before = split(&last.bezier, end).0;
        let after = split(&begin.bezier, start).1;
        std::mem::swap(&mut last.bezier, &mut before);
        let (a, d) = (last.bezier.point(1.0), after.point(0.0));
        let handle = a.distance(d) / (3.0 * cos.max(0.3));
        let (out, back) = (direction(&last.bezier, 1.0) * handle, direction(&after, 0.0) * handle);
        let span = begin.span;
        if let Some(bezier) = Bezier::new(&[a, a + out, d - back, d]) {
            self.segments.push(Segment { bezier, span });
        }
        let mut others = next.segments;
        if let Some(first) = others.first_mut() {
            first.bezier = after;
        }
        self.segments.append(&mut others);
        // A tube keeps its last section to its end, and its first from its start.
        let mut sections = std::mem::take(&mut self.sections);
        let mut more = next.sections;
        if let Some(last) = sections.last().filter(|last| last.section.at < 1.0).cloned() {
            sections.push(last.moved(1.0));
        }
        if let Some(first) = more.first().filter(|first| first.section.at > 0.0).cloned() {
            more.insert(0, first.moved(0.0));
        }
        let mine = sections.into_iter().map(|placed| {
            let at = placed.section.at * own as f64 / all;
            placed.moved(at)
        });
        let new = more.into_iter().map(|placed| {
            let at = (first as f64 + placed.section.at * theirs as f64) / all;
            placed.moved(at)
        });
        self.sections = mine.chain(new).collect();
        self.places.end = next.places.end;
        first
    }

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
            Ok(sweep) => {
                let station = |placed: &Placed| Station {
                    at: placed.section.at,
                    span: placed.span,
                    reach: reach(&placed.section.profile),
                };
                let sections = self.sections.iter().map(station).collect();
                Some((sweep, Places { curve: self.segments, sections, ..self.places }))
            }
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
