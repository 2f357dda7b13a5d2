//! Where the helix begins around the tube: on the side where rows lie closest, so that short rows stay clear of the round's start.

use super::rows::row_speed;
use crate::shape::{Jet, ParametricSurface};
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
        const SIDES: u32 = 48;
        const STATIONS: u32 = 16;
        let mut best = (f64::MAX, 0.0);
        for side in 0..SIDES {
            let v = f64::from(side) / f64::from(SIDES);
            let stations = (0..STATIONS).map(|i| (f64::from(i) + 0.5) / f64::from(STATIONS));
            let speed: f64 = stations.map(|u| row_speed(&surface.jet(u, v))).sum();
            if speed < best.0 - 1e-6 * speed {
                best = (speed, v);
            }
        }
        Self { surface, by: best.1 }
    }
}

impl ParametricSurface for Turned<'_> {
    fn point(&self, u: f64, v: f64) -> DVec3 {
        self.surface.point(u, v + self.by)
    }
    fn jet(&self, u: f64, v: f64) -> Jet {
        self.surface.jet(u, v + self.by)
    }
}
