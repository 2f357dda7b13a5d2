//! Planes that turn evenly from one opening of a tube to the other: flat openings tell how the rows between them lie.

use super::Mesh;
use super::flat::{Course, Flat, Spread, TILTED, TOGETHER};
use super::levels::{Levels, Lines};
use crate::math::atan2;
use crate::shape::ring::Ring;
use glam::DVec3;
use rayon::prelude::*;

/// Lines in such planes lie this much more evenly than those that the mesh was cut along: in a bend both lie alike.
const EVENER: f64 = 0.9;
/// Openings turned against each other by less than this (radians) have parallel planes.
const PARALLEL: f64 = 1e-6;

/// The planes through the line in which those of two openings meet.
struct Fan {
    /// The middles of the openings, and the directions of the tube there.
    places: [(DVec3, DVec3); 2],
    /// The angle between these, its sine and its cosine.
    turn: [f64; 3],
}

impl Mesh {
    /// The lines of a tube in the planes between its openings, where these are flat and the lines lie more evenly by far than
    /// those along which it was cut: a body that bulges to one side has no axis, but its openings tell its planes.
    pub(super) fn fanned(&self, before: &Lines, level: &Spread, course: &Course<'_>) -> Option<Flat> {
        let (first, last) = (course.first.as_ref()?, course.last.as_ref()?);
        let fan = Fan::between(first, last, TILTED * course.row)?;
        // Where the tube winds, planes meet it more than once.
        if !before.rings.is_sorted_by_key(|(ring, _)| fan.share(ring.center())) {
            return None;
        }
        let vertices = (0..self.points.len() as u32).into_par_iter().with_min_len(TOGETHER);
        let field: Vec<f64> = vertices.map(|v| fan.share(self.point(v))).collect();
        // The planes may run across a finer mesh than the lines did.
        let edge = |ring: &Ring| {
            let far = |edge: &&Vec<u32>| self.center(edge).distance_squared(ring.center());
            self.boundaries().iter().min_by(|a, b| far(a).total_cmp(&far(b)))
        };
        let way = self.descent(*edge(last)?.first()?, &field, edge(first)?);
        let course = Course { way: &way, first: course.first.clone(), last: course.last.clone(), ..*course };
        let lines = Levels { mesh: self, field: &field }.along([0.0, 1.0], &course);
        let spread = Spread::of(&lines.rings);
        (spread.covers(level) && spread.uneven < EVENER * level.uneven).then_some(Flat { lines, field })
    }
}

impl Fan {
    /// The planes between two openings; `None` where one of them is off its own by more than `most`.
    fn between(first: &Ring, last: &Ring, most: f64) -> Option<Self> {
        // Lines run clockwise seen from the end of the tube.
        let place = |ring: &Ring| {
            let (middle, way) = (ring.center(), -ring.area().normalize_or_zero());
            let flat = ring.points().iter().all(|p| (*p - middle).dot(way).abs() <= most);
            (flat && way != DVec3::ZERO).then_some((middle, way))
        };
        let places = [place(first)?, place(last)?];
        let (from, to) = (places[0].1, places[1].1);
        let (sine, cosine) = (from.cross(to).length(), from.dot(to));
        Some(Self { places, turn: [atan2(sine, cosine), sine, cosine] })
    }

    /// In which of the planes a point lies: as the share of the angle from the first one to the last one.
    fn share(&self, p: DVec3) -> f64 {
        let [from, to] = self.places.map(|(middle, way)| (p - middle).dot(way));
        let [angle, sine, cosine] = self.turn;
        if angle < PARALLEL { from / (from - to) } else { atan2(from * sine, from * cosine - to) / angle }
    }
}
