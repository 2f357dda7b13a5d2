//! Where the helix begins around the tube: on the side where rows lie closest, so that short rows stay clear of the round's start.

use crate::shape::{Jet, ParametricSurface, slowest_side};
use glam::DVec3;

/// A surface turned about its axis: its v = 0 is the other's v = `by`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turned<'s> {
    pub surface: &'s dyn ParametricSurface,
    /// In turns.
    pub by: f64,
}

impl<'s> Turned<'s> {
    /// Turns a surface so that it begins on its slowest side. Where all sides are alike it stays as it is.
    pub(super) fn to_slowest_side(surface: &'s dyn ParametricSurface) -> Self {
        Self { surface, by: slowest_side(surface, false) }
    }
}

impl ParametricSurface for Turned<'_> {
    fn point(&self, u: f64, v: f64) -> DVec3 {
        self.surface.point(u, v + self.by)
    }
    fn jet(&self, u: f64, v: f64) -> Jet {
        self.surface.jet(u, v + self.by)
    }
    fn ring(&self, u: f64, from: f64, jets: &mut [Jet]) {
        self.surface.ring(u, from + self.by, jets);
    }
}
