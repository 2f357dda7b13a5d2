//! Profiles along a curve: the closed line around it at any parameter, interpolated between sections.

use super::spec::{Fault, Interpolation, Profile, TubeSpec};
use super::{End, Jet};
use crate::math::{TAU, sin_cos};
use glam::DVec3;

/// The profile at every curve parameter.
#[derive(Clone, Debug)]
pub(super) struct Stack {
    spans: Vec<Span>,
}

/// A stretch of the curve with one cubic for each number of the profile: two radii and two offsets.
#[derive(Clone, Copy, Debug)]
struct Span {
    start: f64,
    inverse: f64,
    cubics: [[f64; 4]; 4],
}

impl Stack {
    pub(super) fn new(spec: &TubeSpec) -> Result<Self, Fault> {
        let mut knots: Vec<(f64, [f64; 4])> = Vec::with_capacity(spec.sections.len() + 2);
        for (section, it) in spec.sections.iter().enumerate() {
            if !it.at.is_finite()
                || !(0.0..=1.0).contains(&it.at)
                || knots.last().is_some_and(|k| k.0 >= it.at)
            {
                return Err(Fault::SectionOrder { section });
            }
            let Profile::Ellipse { axes: [a, b], offset } = it.profile else {
                return Err(Fault::SectionNotEnclosing { section });
            };
            let numbers = [a, b, offset.x, offset.y];
            if numbers.iter().any(|n| !n.is_finite() || n.abs() > 1e7) {
                return Err(Fault::NotFinite);
            }
            let closed = (section == 0 && spec.start == End::Closed)
                || (section + 1 == spec.sections.len() && spec.end == End::Closed);
            if a < 0.0 || b < 0.0 || (!closed && (a == 0.0 || b == 0.0)) {
                return Err(Fault::SectionSize { section });
            }
            knots.push((it.at, numbers));
        }
        if let (Some(&first), Some(&last)) = (knots.first(), knots.last()) {
            if first.0 > 0.0 {
                knots.insert(0, (0.0, first.1));
            }
            if last.0 < 1.0 {
                knots.push((1.0, last.1));
            }
        }
        let spans = knots
            .windows(2)
            .map(|pair| {
                let inverse = 1.0 / (pair[1].0 - pair[0].0);
                let mut cubics = [[0.0; 4]; 4];
                for (cubic, (a, b)) in cubics.iter_mut().zip(pair[0].1.iter().zip(pair[1].1)) {
                    let rise = b - a;
                    *cubic = match spec.interpolation {
                        Interpolation::Linear => [*a, rise, 0.0, 0.0],
                        Interpolation::Smooth => [*a, 0.0, 3.0 * rise, -2.0 * rise],
                    };
                }
                Span { start: pair[0].0, inverse, cubics }
            })
            .collect();
        Ok(Self { spans })
    }

    /// The profile in the local frame at curve parameter `w`, with its derivatives by `w` and `v`.
    #[inline]
    pub(super) fn eval(&self, w: f64, v: f64) -> Jet {
        let index = self.spans.partition_point(|span| span.start <= w).max(1) - 1;
        let span = &self.spans[index];
        let t = (w - span.start) * span.inverse;
        let value = |c: &[f64; 4]| c[0] + t * (c[1] + t * (c[2] + t * c[3]));
        let slope = |c: &[f64; 4]| (c[1] + t * (2.0 * c[2] + t * 3.0 * c[3])) * span.inverse;
        let [a, b, x, y] = &span.cubics;
        let (sin, cos) = sin_cos(-TAU * v);
        let (long, wide) = (value(a), value(b));
        Jet {
            point: DVec3::new(value(x) + long * cos, value(y) + wide * sin, 0.0),
            du: DVec3::new(slope(x) + slope(a) * cos, slope(y) + slope(b) * sin, 0.0),
            dv: DVec3::new(TAU * long * sin, -TAU * wide * cos, 0.0),
        }
    }
}
