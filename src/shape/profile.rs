//! Profiles along a curve: the closed line around it at any parameter, interpolated between sections.

use super::loops::{Cut, LoopStack};
use super::smooth;
use super::spec::{Fault, Interpolation, Profile, TubeSpec};
use super::{End, Jet};
use crate::math::{TAU, sin_cos_turns};
use glam::{DVec2, DVec3};

/// Sections a tube may have.
const MOST_SECTIONS: usize = 1024;
/// A closed end thinner than this part of the thickest section is a point.
const POINT: f64 = 1e-3;

/// The profile at every curve parameter.
#[derive(Clone, Debug)]
pub(super) struct Stack {
    kind: Kind,
    /// Parameters of the sections with 0 and 1 around them, ascending.
    breaks: Vec<f64>,
    start_point: bool,
    end_point: bool,
}

#[derive(Clone, Debug)]
enum Kind {
    Ellipses { spans: Vec<Span>, squared: bool },
    Loops(LoopStack),
}

/// A stretch of the curve with one cubic for each number of the profile: two radii and two offsets.
#[derive(Clone, Copy, Debug)]
struct Span {
    start: f64,
    inverse: f64,
    cubics: [[f64; 4]; 4],
}

impl Span {
    /// Value and slope of a number; `squared` if the cubic is of its square.
    #[inline]
    fn number(&self, index: usize, w: f64, squared: bool) -> (f64, f64) {
        let c = &self.cubics[index];
        let t = (w - self.start) * self.inverse;
        let value = c[0] + t * (c[1] + t * (c[2] + t * c[3]));
        let slope = (c[1] + t * (2.0 * c[2] + t * 3.0 * c[3])) * self.inverse;
        if squared {
            let root = value.max(1e-30).sqrt();
            (root, 0.5 * slope / root)
        } else {
            (value, slope)
        }
    }

    /// The two radii; `squared` if the cubics are of their squares.
    fn half_axes(&self, w: f64, squared: bool) -> [f64; 2] {
        [0, 1].map(|index| self.number(index, w, squared).0)
    }

    /// Whether there are no offsets.
    fn centered(&self) -> bool {
        self.cubics[2..].iter().flatten().all(|number| *number == 0.0)
    }
}

impl Stack {
    pub(super) fn new(spec: &TubeSpec) -> Result<Self, Fault> {
        let sections = &spec.sections;
        if sections.len() > MOST_SECTIONS {
            return Err(Fault::TooMany { limit: MOST_SECTIONS });
        }
        let mut places: Vec<f64> = Vec::with_capacity(sections.len());
        for (section, it) in sections.iter().enumerate() {
            if !it.at.is_finite() {
                return Err(Fault::NotFinite);
            }
            if !(0.0..=1.0).contains(&it.at) || places.last().is_some_and(|&last| it.at - last < 1e-9) {
                return Err(Fault::SectionOrder { section });
            }
            places.push(it.at);
        }
        let points = Self::points(spec)?;
        let start_point = points.first().copied().unwrap_or(false);
        let end_point = points.last().copied().unwrap_or(false);
        let smooth = spec.interpolation == Interpolation::Smooth;
        let kind = if sections.iter().any(|it| matches!(it.profile, Profile::Loop(_))) {
            Kind::Loops(LoopStack::new(sections, &points, smooth)?)
        } else {
            Kind::Ellipses { spans: ellipse_spans(spec, &points, smooth), squared: smooth }
        };
        let mut breaks = places;
        if breaks.first().is_none_or(|&at| at > 0.0) {
            breaks.insert(0, 0.0);
        }
        if breaks.last().is_none_or(|&at| at < 1.0) {
            breaks.push(1.0);
        }
        Ok(Self { kind, breaks, start_point, end_point })
    }

    /// Which sections are points, after a look at all sizes.
    fn points(spec: &TubeSpec) -> Result<Vec<bool>, Fault> {
        let mut most = 0.0_f64;
        for (section, it) in spec.sections.iter().enumerate() {
            match &it.profile {
                Profile::Ellipse { axes: [a, b], offset } => {
                    if ![*a, *b, offset.x, offset.y].iter().all(|n| n.is_finite() && n.abs() <= 1e7) {
                        return Err(Fault::NotFinite);
                    }
                    if *a < 0.0 || *b < 0.0 {
                        return Err(Fault::SectionSize { section });
                    }
                    most = most.max(*a).max(*b);
                }
                Profile::Loop(points) => {
                    if !points.iter().all(|p| p.is_finite() && p.abs().max_element() <= 1e7) {
                        return Err(Fault::NotFinite);
                    }
                    most = points.iter().fold(most, |most, p| most.max(p.truncate().length()));
                }
            }
        }
        let last = spec.sections.len() - 1;
        let tip = |section: usize, at: f64| {
            (section == 0 && at < 1e-9 && spec.start == End::Closed)
                || (section == last && at > 1.0 - 1e-9 && spec.end == End::Closed)
        };
        let mut points = Vec::with_capacity(spec.sections.len());
        for (section, it) in spec.sections.iter().enumerate() {
            let mut point = false;
            if let Profile::Ellipse { axes: [a, b], .. } = it.profile {
                point = tip(section, it.at) && a.max(b) <= POINT * most;
                if !point && a.min(b) <= 1e-9 * most {
                    return Err(Fault::SectionSize { section });
                }
            }
            points.push(point);
        }
        if points.iter().all(|&point| point) {
            return Err(Fault::SectionSize { section: 0 });
        }
        Ok(points)
    }

    /// Parameters between which the profile is smooth, from 0 to 1.
    pub(super) fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    /// Whether the profile shrinks to a point at the start and at the end.
    pub(super) fn points_at_ends(&self) -> (bool, bool) {
        (self.start_point, self.end_point)
    }

    /// Whether each section lies in a plane across the curve.
    pub(super) fn flat(&self) -> bool {
        match &self.kind {
            Kind::Ellipses { .. } => true,
            Kind::Loops(stack) => stack.flat(),
        }
    }

    /// Whether the middle of each section certainly lies on the curve.
    pub(super) fn centered(&self) -> bool {
        match &self.kind {
            Kind::Ellipses { spans, .. } => spans.iter().all(Span::centered),
            Kind::Loops(_) => false,
        }
    }

    /// The half axes of the section, where its middle certainly lies on the curve.
    pub(super) fn half_axes(&self, w: f64) -> Option<[f64; 2]> {
        let Kind::Ellipses { spans, squared } = &self.kind else { return None };
        let span = span_at(spans, w);
        span.centered().then(|| span.half_axes(w, *squared))
    }

    /// Whether the profile has a part along the tangent.
    pub(super) fn planar(&self) -> bool {
        matches!(self.kind, Kind::Ellipses { .. })
    }

    /// Mean over v of the square of the profile's derivative by the curve parameter.
    pub(super) fn pace_squared(&self, w: f64) -> f64 {
        match &self.kind {
            Kind::Ellipses { spans, squared } => {
                let span = span_at(spans, w);
                let slope = |i: usize, squared| span.number(i, w, squared).1;
                let [a, b] = [slope(0, *squared), slope(1, *squared)];
                let [x, y] = [slope(2, false), slope(3, false)];
                0.5 * (a * a + b * b) + x * x + y * y
            }
            Kind::Loops(stack) => stack.at(w).pace_squared(),
        }
    }

    /// How far the profile reaches into the direction of `toward`, times its length.
    pub(super) fn reach(&self, w: f64, toward: DVec2) -> f64 {
        match &self.kind {
            Kind::Ellipses { spans, squared } => {
                let span = span_at(spans, w);
                let [a, b] = span.half_axes(w, *squared);
                let offset = DVec2::new(span.number(2, w, false).0, span.number(3, w, false).0);
                offset.dot(toward) + (toward * DVec2::new(a, b)).length()
            }
            Kind::Loops(stack) => {
                let cut = stack.at(w);
                (0..64)
                    .map(|k| cut.point(f64::from(k) / 64.0).truncate().dot(toward))
                    .fold(f64::NEG_INFINITY, f64::max)
            }
        }
    }

    /// The profile in the local frame at curve parameter `w`, with its derivatives by `w` and `v`.
    #[inline]
    pub(super) fn eval(&self, w: f64, v: f64) -> Jet {
        self.at(w).eval(v)
    }

    /// The closed line at curve parameter `w`.
    #[inline]
    pub(super) fn at(&self, w: f64) -> Line<'_> {
        let (spans, squared) = match &self.kind {
            Kind::Ellipses { spans, squared } => (spans, *squared),
            Kind::Loops(stack) => return Line::Loop(stack.at(w)),
        };
        let span = span_at(spans, w);
        Line::Ellipse([
            span.number(0, w, squared),
            span.number(1, w, squared),
            span.number(2, w, false),
            span.number(3, w, false),
        ])
    }
}

/// One closed line of a stack.
pub(super) enum Line<'s> {
    /// Two radii and two offsets with their slopes.
    Ellipse([(f64, f64); 4]),
    Loop(Cut<'s>),
}

impl Line<'_> {
    /// As [`Stack::eval`].
    #[inline]
    pub(super) fn eval(&self, v: f64) -> Jet {
        match self {
            Self::Ellipse([(a, along), (b, across), (x, dx), (y, dy)]) => {
                let (sin, cos) = sin_cos_turns(-v);
                Jet {
                    point: DVec3::new(x + a * cos, y + b * sin, 0.0),
                    du: DVec3::new(dx + along * cos, dy + across * sin, 0.0),
                    dv: DVec3::new(TAU * a * sin, -TAU * b * cos, 0.0),
                }
            }
            Self::Loop(cut) => cut.eval(v),
        }
    }

    /// The point alone.
    #[inline]
    pub(super) fn point(&self, v: f64) -> DVec3 {
        match self {
            Self::Ellipse([(a, _), (b, _), (x, _), (y, _)]) => {
                let (sin, cos) = sin_cos_turns(-v);
                DVec3::new(x + a * cos, y + b * sin, 0.0)
            }
            Self::Loop(cut) => cut.point(v),
        }
    }
}

#[inline]
fn span_at(spans: &[Span], w: f64) -> &Span {
    let index = spans.partition_point(|span| span.start <= w).max(1) - 1;
    &spans[index]
}

fn ellipse_spans(spec: &TubeSpec, points: &[bool], smooth: bool) -> Vec<Span> {
    let places: Vec<f64> = spec.sections.iter().map(|it| it.at).collect();
    let numbers: Vec<[f64; 4]> = spec
        .sections
        .iter()
        .zip(points)
        .map(|(it, &point)| match it.profile {
            Profile::Ellipse { axes: [a, b], offset } => {
                let size = |n: f64| match (point, smooth) {
                    (true, _) => 0.0,
                    (_, true) => n * n,
                    _ => n,
                };
                [size(a), size(b), offset.x, offset.y]
            }
            Profile::Loop(_) => [0.0; 4],
        })
        .collect();
    let column = |i: usize| {
        let column: Vec<f64> = numbers.iter().map(|n| n[i]).collect();
        smooth::cubics(&places, &column, smooth, i < 2)
    };
    let columns = [column(0), column(1), column(2), column(3)];
    columns[0]
        .iter()
        .enumerate()
        .map(|(i, cubic)| Span {
            start: cubic.start,
            inverse: cubic.inverse,
            cubics: [
                cubic.coefficients,
                columns[1][i].coefficients,
                columns[2][i].coefficients,
                columns[3][i].coefficients,
            ],
        })
        .collect()
}
