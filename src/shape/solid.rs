//! The inside of a tube: signed distances from its surface.

use super::{End, Jet, ParametricSurface};
use glam::DVec3;
use rayon::prelude::*;
use std::fmt;

/// Places around the tube in the table of its points.
const AROUND: u32 = 32;
/// Least and greatest number of places along it.
const ALONG: [u32; 2] = [16, 256];
/// Fewest of all places that are worth being handed to another thread.
const TOGETHER: usize = 256;
/// Steps that refine a foot.
const STEPS: u32 = 8;
/// Nearest to an end that derivatives are taken, for a pole has none.
const INSET: f64 = 1e-5;

/// A tube as a body that points can be inside of.
pub(crate) struct Solid<'s> {
    surface: &'s dyn ParametricSurface,
    ends: [End; 2],
    grid: Vec<(f64, f64, DVec3)>,
    low: DVec3,
    high: DVec3,
}

impl fmt::Debug for Solid<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Solid").field("low", &self.low).field("high", &self.high).finish_non_exhaustive()
    }
}

/// The nearest place of the surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Foot {
    /// Along the tube.
    pub(crate) u: f64,
    /// Around it.
    pub(crate) v: f64,
    /// Distance from the surface in mm, negative inside.
    pub(crate) distance: f64,
    /// The point lies beyond an open end, where the surface says nothing of inside and outside.
    pub(crate) beyond: bool,
}

impl<'s> Solid<'s> {
    /// Tabulates a tube.
    pub(crate) fn new(surface: &'s dyn ParametricSurface, ends: [End; 2]) -> Self {
        let girth = super::girth(surface, 0.5, 16).max(1e-6);
        let length = super::length_along(surface, 0.0, 0.0..1.0, 8);
        let along =
            (f64::from(AROUND) * length / girth).clamp(f64::from(ALONG[0]), f64::from(ALONG[1])) as u32;
        let place = |index: u32| {
            let share = |k: u32, of: u32| f64::from(k) / f64::from(of);
            let (u, v) = (share(index / AROUND, along), share(index % AROUND, AROUND));
            (u, v, surface.point(u, v))
        };
        let all = (0..(along + 1) * AROUND).into_par_iter().with_min_len(TOGETHER);
        let grid: Vec<(f64, f64, DVec3)> = all.map(place).collect();
        let (low, high) =
            grid.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), (_, _, point)| {
                (low.min(*point), high.max(*point))
            });
        // The table cuts corners of the body; its box gets a little room for them.
        let room = DVec3::splat(0.05 * (high - low).max_element().max(1e-6));
        Self { surface, ends, grid, low: low - room, high: high + room }
    }

    /// False when the point is certainly outside.
    pub(crate) fn near(&self, point: DVec3) -> bool {
        point.cmpge(self.low).all() && point.cmple(self.high).all()
    }

    /// False when two bodies certainly lie apart.
    pub(crate) fn meets(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }

    /// The place of the surface nearest to a point.
    pub(crate) fn foot(&self, point: DVec3) -> Foot {
        let mut best = (f64::INFINITY, 0.0, 0.0);
        for (u, v, place) in &self.grid {
            let distance = place.distance_squared(point);
            if distance < best.0 {
                best = (distance, *u, *v);
            }
        }
        self.refine(point, best.1, best.2)
    }

    /// The same from a place near by.
    pub(crate) fn refine(&self, point: DVec3, u: f64, v: f64) -> Foot {
        self.refine_to(point, u, v, 1e-12)
    }

    /// The same to a tolerance in u and v.
    pub(crate) fn refine_to(&self, point: DVec3, mut u: f64, mut v: f64, tolerance: f64) -> Foot {
        let mut jet = self.jet(u, v);
        let mut least = jet.point.distance_squared(point);
        for _ in 0..STEPS {
            let d = point - jet.point;
            let (e, f, g) = (jet.du.length_squared(), jet.du.dot(jet.dv), jet.dv.length_squared());
            let (a, b) = (d.dot(jet.du), d.dot(jet.dv));
            let (e, g) = (e + 1e-12, g * (1.0 + 1e-9) + 1e-12);
            let determinant = (e * g - f * f).max(1e-9 * e * g);
            let mut step = ((g * a - f * b) / determinant, (e * b - f * a) / determinant);
            let long = (step.0.abs() / 0.1).max(step.1.abs() / 0.1).max(1.0);
            step = (step.0 / long, step.1 / long);
            // The surface curves away: a step that leads astray is shortened.
            let mut moved = false;
            for _ in 0..5 {
                let (next_u, next_v) = ((u + step.0).clamp(0.0, 1.0), v + step.1);
                let next = self.jet(next_u, next_v);
                let distance = next.point.distance_squared(point);
                if distance < least {
                    (u, v, jet, least, moved) = (next_u, next_v, next, distance, true);
                    break;
                }
                step = (0.4 * step.0, 0.4 * step.1);
            }
            if !moved || step.0.abs().max(step.1.abs()) < tolerance {
                break;
            }
        }
        let d = point - jet.point;
        let outward = jet.du.cross(jet.dv);
        let beyond = |at: f64, edge: f64, end: End, sign: f64| {
            end == End::Open && (at - edge).abs() < 1e-9 && sign * d.dot(jet.du) > 1e-6 * jet.du.length()
        };
        let beyond = beyond(u, 0.0, self.ends[0], -1.0) || beyond(u, 1.0, self.ends[1], 1.0);
        let distance = if d.dot(outward) < 0.0 { -d.length() } else { d.length() };
        Foot { u, v, distance, beyond }
    }

    /// True for a point within the body, at least `depth` (mm) deep.
    pub(crate) fn contains(&self, point: DVec3, depth: f64) -> bool {
        if !self.near(point) {
            return false;
        }
        let foot = self.foot(point);
        !foot.beyond && foot.distance < -depth
    }

    fn jet(&self, u: f64, v: f64) -> Jet {
        let inside = u.clamp(INSET, 1.0 - INSET);
        let jet = self.surface.jet(inside, v);
        if inside == u { jet } else { Jet { point: self.surface.point(u, v), ..jet } }
    }
}
