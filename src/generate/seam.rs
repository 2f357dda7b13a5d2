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
        const SIDES: usize = 48;
        const STATIONS: u32 = 16;
        let mut speeds = [0.0; SIDES];
        let mut ring = [Jet::default(); SIDES];
        for i in 0..STATIONS {
            surface.ring((f64::from(i) + 0.5) / f64::from(STATIONS), 0.0, &mut ring);
            for (sum, jet) in speeds.iter_mut().zip(&ring) {
                *sum += row_speed(jet);
            }
        }
        let mut best = (f64::MAX, 0.0);
        for (side, speed) in speeds.into_iter().enumerate() {
            if speed < best.0 - 1e-6 * speed {
                best = (speed, side as f64 / SIDES as f64);
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
    fn ring(&self, u: f64, from: f64, jets: &mut [Jet]) {
        self.surface.ring(u, from + self.by, jets);
    }
}
