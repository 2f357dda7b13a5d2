//! Planar cross-sections along a control curve, the way of the paper (section 3.1).

use super::cut::{Cut, Piece, Plan, samples_around};
use super::levels::Levels;
use super::soup::NONE;
use super::{Fault, Mesh};
use crate::math::{TAU, atan2};
use crate::shape::Bezier;
use crate::shape::ring::Ring;
use crate::shape::stack::Stack;
use glam::DVec3;

/// Steps of a segment by which its length is tabled.
const STEPS: u32 = 64;
/// An end with a loop of fewer stitches than this is drawn shut.
const SHUT: f64 = 9.0;

impl Mesh {
    /// Cuts the mesh by planes across a curve, a row height apart, into one tube.
    pub fn slice(&self, curve: &[Bezier], plan: &Plan) -> Result<Cut, Fault> {
        let stations = stations(curve, plan.gauge.height);
        let mut rings: Vec<Ring> = Vec::new();
        let mut places: Vec<(DVec3, DVec3)> = Vec::new();
        let mut missed = None;
        for &(point, tangent) in &stations {
            let Some(ring) = self.section(point, tangent) else {
                missed = missed.or((!rings.is_empty()).then_some(point));
                continue;
            };
            if let Some(at) = missed {
                return Err(Fault::NoSlice { at });
            }
            rings.push(ring);
            places.push((point, tangent));
        }
        let (Some(&(first, up)), Some(&(last, on))) = (places.first(), places.last()) else {
            return Err(Fault::NoSlice { at: stations.first().map_or(DVec3::ZERO, |station| station.0) });
        };
        // Planes that cross within the object run backward on the inner side of a bend.
        for (k, pair) in rings.windows(2).enumerate() {
            let below = pair[0].samples(48, 0.0);
            let above = pair[1].beside(&below);
            if below.iter().zip(&above).any(|(a, b)| (*b - *a).dot(places[k].1) <= 0.0) {
                return Err(Fault::Fold { at: places[k].0 });
            }
        }
        let mut ends = Vec::new();
        let mut poles = [None; 2];
        let sides = [(first, -up, rings.first().cloned()), (last, on, rings.last().cloned())];
        for (side, (point, outward, ring)) in sides.into_iter().enumerate() {
            let Some(ring) = ring else { continue };
            let width = ring.length() / std::f64::consts::PI;
            let near =
                |p: DVec3| p.distance(point) < width && (p - point).dot(outward) > -0.5 * plan.gauge.height;
            let opening = self.boundaries().iter().find(|edge| near(self.center(edge)));
            if let Some(edge) = opening {
                let reach = (self.center(edge) - ring.center()).dot(outward);
                if reach > 0.3 * plan.gauge.height
                    && let Some(edge) = self.opening(edge, side == 1)
                {
                    if side == 0 { rings.insert(0, edge) } else { rings.push(edge) }
                }
                ends.push((point, true));
            } else if ring.length() < SHUT * plan.gauge.width {
                let apex = (0..self.points.len() as u32).map(|v| self.point(v)).filter(|p| near(*p));
                let apex = apex.max_by(|a, b| a.dot(outward).total_cmp(&b.dot(outward))).unwrap_or(point);
                poles[side] = Some(apex);
                ends.push((apex, false));
            } else {
                ends.push((point, true));
            }
        }
        if let (Some(seam), Some(ring)) = (plan.seam, rings.first_mut()) {
            *ring = ring.begun_near(seam);
        }
        let around = samples_around(rings.iter(), plan);
        let mut stack = Stack::new(&rings, poles, around).ok_or(Fault::NoRows { at: last })?;
        stack.revolve(plan.gauge.width, &self.points, &self.patches);
        Ok(Cut {
            pieces: vec![Piece {
                name: "trunk".to_owned(),
                ends: stack.ends(),
                surface: Box::new(stack),
                attachment: None,
                even: true,
            }],
            ends,
            dropped: Vec::new(),
        })
    }

    /// The section by a plane that runs around the point; clockwise seen against the tangent's way back.
    fn section(&self, point: DVec3, tangent: DVec3) -> Option<Ring> {
        let side: Vec<f64> = self.points.iter().map(|p| (*p - point).dot(tangent)).collect();
        let levels = Levels { mesh: self, field: &side };
        let rises = |h: u32| side[self.from(h) as usize] < 0.0 && side[self.to(h) as usize] >= 0.0;
        let mut seen = std::collections::BTreeSet::new();
        let mut best: Option<(f64, Ring)> = None;
        for h in 0..self.twins.len() as u32 {
            if self.twins[h as usize] == NONE || !rises(h) || seen.contains(&h) {
                continue;
            }
            let Some(ring) = levels.walk(h, 0.0, |h| _ = seen.insert(h)) else { continue };
            if turns(&ring, point, tangent) != 0 {
                // Of several around the point the nearest.
                let near = ring.points().iter().map(|p| p.distance(point)).fold(f64::MAX, f64::min);
                if best.as_ref().is_none_or(|(other, _)| near < *other) {
                    best = Some((near, ring));
                }
            }
        }
        best.map(|(_, ring)| ring)
    }
}

/// How often a ring runs around an axis.
fn turns(ring: &Ring, point: DVec3, axis: DVec3) -> i32 {
    let first = axis.any_orthonormal_vector();
    let second = axis.cross(first);
    let flat: Vec<(f64, f64)> =
        ring.points().iter().map(|p| ((*p - point).dot(first), (*p - point).dot(second))).collect();
    let sum: f64 = flat
        .iter()
        .zip(flat.iter().cycle().skip(1))
        .map(|(a, b)| atan2(a.0 * b.1 - a.1 * b.0, a.0 * b.0 + a.1 * b.1))
        .sum();
    (sum / TAU).round() as i32
}

/// Points and unit tangents along a curve, evenly spread by length, about `step` apart; the ends lie a hair inside.
fn stations(curve: &[Bezier], step: f64) -> Vec<(DVec3, DVec3)> {
    let mut table: Vec<(f64, usize, f64)> = vec![(0.0, 0, 0.0)];
    let mut length = 0.0;
    for (index, segment) in curve.iter().enumerate() {
        for k in 0..STEPS {
            let (a, b) = (f64::from(k) / f64::from(STEPS), f64::from(k + 1) / f64::from(STEPS));
            length += segment.point(a).distance(segment.point(b));
            table.push((length, index, b));
        }
    }
    let count = ((length / step).round() as usize).clamp(2, 20_000);
    let at = |k: usize| -> Option<(DVec3, DVec3)> {
        let share = (k as f64 / count as f64).clamp(1e-3 / count as f64, 1.0 - 1e-3 / count as f64);
        let target = share * length;
        let i = table.partition_point(|entry| entry.0 < target).clamp(1, table.len() - 1);
        let (from, to) = (table[i - 1], table[i]);
        let begin = if from.1 == to.1 { from.2 } else { 0.0 };
        let t = begin + (to.2 - begin) * (target - from.0) / (to.0 - from.0).max(1e-300);
        let segment = curve.get(to.1)?;
        Some((segment.point(t), segment.derivative(t).normalize_or_zero()))
    };
    (0..=count).filter_map(at).filter(|(_, tangent)| *tangent != DVec3::ZERO).collect()
}
