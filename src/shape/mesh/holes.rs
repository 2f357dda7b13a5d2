//! Openings that are no ends of tubes: holes in a surface.

use super::cut::Plan;
use super::{Fault, Mesh};

/// Growth of the surface around an opening within its diameter if it is round, against a tube of its width: 1 for a tube,
/// 2 for a hole in a plane; and the same within its radius, where a hole in a plane has 1.5.
const FLAT: f64 = 1.8;
const FLAT_NEAR: f64 = 1.4;
/// Fewest stitches around an opening.
const LEAST_AROUND: f64 = 4.0;

impl Mesh {
    /// Refuses openings that nothing can be worked from: too small, or in the middle of a flat piece. Ends that the user
    /// named are taken as they are, unless too small.
    pub(super) fn holes(&self, plan: &Plan) -> Result<(), Fault> {
        for ring in self.boundaries() {
            let length = self.length(ring);
            let center = self.center(ring);
            let named = |p: &glam::DVec3| p.distance(center) < length / 6.0;
            let small = length < LEAST_AROUND * plan.gauge.width;
            let fine = plan.start.iter().chain(&plan.poles).any(named);
            if small || (!fine && self.flat_around(ring, length)) {
                let vertex = ring.first().map_or(0, |v| self.number(*v));
                return Err(Fault::Hole { at: center, length, edges: ring.len() as u32, vertex });
            }
        }
        Ok(())
    }

    fn flat_around(&self, ring: &[u32], length: f64) -> bool {
        let diameter = length / std::f64::consts::PI;
        // A small piece may end before the diameter is reached; a few triangles do not tell.
        let edge = self.mean_edge();
        let fine = 0.5 * diameter > 2.0 * edge;
        let distance = self.distances(ring, 2.0 * (diameter + edge));
        let flare = |reach: f64| self.flare(&distance, reach, 2.0 * (reach + edge)) / (length * reach);
        flare(diameter) > FLAT || (fine && flare(0.5 * diameter) > FLAT_NEAR)
    }

    /// Area within reach of an opening, by distances that are known up to a limit.
    fn flare(&self, distance: &[f64], reach: f64, limit: f64) -> f64 {
        let mut area = 0.0;
        for (face, corners) in self.faces.iter().enumerate() {
            // The share of a face within reach, as if the distance were even over it.
            let at =
                corners.map(|v| Some(distance[v as usize]).filter(|d| *d <= limit).unwrap_or(f64::INFINITY));
            let (near, far) = (at.into_iter().fold(f64::MAX, f64::min), at.into_iter().fold(0.0, f64::max));
            let share = if far <= reach {
                1.0
            } else if near >= reach || !near.is_finite() {
                0.0
            } else {
                let far = if far.is_finite() { far } else { 2.0 * reach };
                (reach - near) / (far - near).max(1e-300)
            };
            area += 0.5 * share * self.normal(face as u32).length();
        }
        area
    }
}
