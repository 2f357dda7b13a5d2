//! A smooth surface over a hole: the implicit function that has given points for zeros and given normals for slopes there
//! (Hermite interpolation by the radial function r^3; Macedo, Gois and Velho 2011).

use glam::{DMat3, DVec3};
use pulp::{Arch, NullaryFnOnce};

/// Most points that a patch is laid through.
const MOST: usize = 26;
/// Steps to the surface.
const STEPS: u32 = 8;
/// A step of this share of the patch is the last one.
const NEAR: f64 = 1e-4;

/// The function, in coordinates that are centered and scaled.
#[derive(Clone, Debug)]
pub(super) struct Patch {
    points: Vec<DVec3>,
    /// Weights of the radial functions and of their slopes.
    weights: Vec<(f64, DVec3)>,
    /// The linear part.
    constant: f64,
    linear: DVec3,
    origin: DVec3,
    scale: f64,
}

impl Patch {
    /// The function through points with unit normals; of many points, some are taken that lie far from each other.
    /// `None` when they do not determine one.
    pub(super) fn new(all: &[(DVec3, DVec3)]) -> Option<Self> {
        let chosen = spread(all);
        let origin = chosen.iter().map(|(p, _)| *p).sum::<DVec3>() / chosen.len().max(1) as f64;
        let reach = chosen.iter().map(|(p, _)| p.distance(origin)).fold(0.0, f64::max);
        if chosen.len() < 4 || reach.is_nan() || reach <= 0.0 {
            return None;
        }
        let scale = 1.0 / reach;
        let points: Vec<DVec3> = chosen.iter().map(|(p, _)| (*p - origin) * scale).collect();
        let count = points.len();
        let size = 4 * count + 4;
        let mut system = vec![0.0; size * (size + 1)];
        let mut set = |row: usize, column: usize, value: f64| system[row * (size + 1) + column] = value;
        for (i, (p, (_, normal))) in points.iter().zip(&chosen).enumerate() {
            for (j, q) in points.iter().enumerate() {
                let (value, slope, bend) = radial(*p - *q);
                set(4 * i, 4 * j, value);
                for a in 0..3 {
                    set(4 * i, 4 * j + 1 + a, slope[a]);
                    set(4 * i + 1 + a, 4 * j, slope[a]);
                    for b in 0..3 {
                        set(4 * i + 1 + a, 4 * j + 1 + b, bend.col(b)[a]);
                    }
                }
            }
            set(4 * i, 4 * count, 1.0);
            set(4 * count, 4 * i, 1.0);
            for a in 0..3 {
                set(4 * i, 4 * count + 1 + a, p[a]);
                set(4 * i + 1 + a, 4 * count + 1 + a, 1.0);
                // No weight may see a linear function.
                set(4 * count + 1 + a, 4 * i, p[a]);
                set(4 * count + 1 + a, 4 * i + 1 + a, -1.0);
                set(4 * i + 1 + a, size, normal[a]);
            }
        }
        let x = eliminate(system, size)?;
        let vector = |at: usize| DVec3::new(x[at], x[at + 1], x[at + 2]);
        let weights = (0..count).map(|i| (x[4 * i], vector(4 * i + 1))).collect();
        let linear = vector(4 * count + 1);
        Some(Self { points, weights, constant: x[4 * count], linear, origin, scale })
    }

    /// Value and slope.
    fn at(&self, p: DVec3) -> (f64, DVec3) {
        let (mut value, mut slope) = (self.constant + self.linear.dot(p), self.linear);
        for (q, (weight, lean)) in self.points.iter().zip(&self.weights) {
            let (v, s, b) = radial(p - *q);
            value += weight * v + lean.dot(s);
            slope += *weight * s + b * *lean;
        }
        (value, slope)
    }

    /// The point of the surface that lies down the slope from a place.
    pub(super) fn project(&self, place: DVec3) -> DVec3 {
        let mut p = (place - self.origin) * self.scale;
        for _ in 0..STEPS {
            let (value, slope) = self.at(p);
            let step = -slope * (value / slope.length_squared().max(1e-6));
            p += step * (0.3 / step.length().max(0.3));
            if step.length() < NEAR {
                break;
            }
        }
        self.origin + p / self.scale
    }
}

/// r^3 of an arm with its first and second derivatives.
fn radial(d: DVec3) -> (f64, DVec3, DMat3) {
    let r = d.length();
    let outer = DMat3::from_cols(d * d.x, d * d.y, d * d.z);
    let bend =
        if r > 0.0 { (DMat3::from_diagonal(DVec3::splat(r)) + outer * (1.0 / r)) * 3.0 } else { DMat3::ZERO };
    (r * r * r, 3.0 * r * d, bend)
}

/// Points far from each other: each next one is the farthest from those before.
fn spread(all: &[(DVec3, DVec3)]) -> Vec<(DVec3, DVec3)> {
    let mut distance = vec![f64::INFINITY; all.len()];
    let mut chosen: Vec<(DVec3, DVec3)> = Vec::new();
    let mut next = 0;
    while let Some(&pair) = all.get(next) {
        if chosen.len() >= MOST || distance[next] <= 0.0 {
            break;
        }
        chosen.push(pair);
        for (distance, (p, _)) in distance.iter_mut().zip(all) {
            *distance = distance.min(p.distance_squared(pair.0));
        }
        next = (0..all.len())
            .max_by(|a, b| distance[*a].total_cmp(&distance[*b]).then(b.cmp(a)))
            .unwrap_or(all.len());
    }
    chosen
}

/// Rows from which the top one is taken so often that nothing is left in a column: compiled for instructions as wide as there are.
struct Rows<'r> {
    top: &'r [f64],
    rest: &'r mut [f64],
    column: usize,
}

impl NullaryFnOnce for Rows<'_> {
    type Output = ();

    #[expect(clippy::inline_always, reason = "what is inlined is compiled for wider instructions")]
    #[inline(always)]
    fn call(self) {
        let Self { top, rest, column } = self;
        for row in rest.chunks_exact_mut(top.len()) {
            let factor = row[column] / top[column];
            if factor != 0.0 {
                for (x, y) in row[column..].iter_mut().zip(&top[column..]) {
                    *x -= factor * y;
                }
            }
        }
    }
}

/// Solves a dense system by elimination with row exchange; the right side is the last column.
pub(super) fn eliminate(mut system: Vec<f64>, size: usize) -> Option<Vec<f64>> {
    let (arch, width) = (Arch::new(), size + 1);
    for column in 0..size {
        let pivot = (column..size).max_by(|a, b| {
            system[a * width + column].abs().total_cmp(&system[b * width + column].abs()).then(b.cmp(a))
        })?;
        if system[pivot * width + column].abs() < 1e-12 {
            return None;
        }
        if pivot != column {
            let (low, high) = system.split_at_mut(pivot * width);
            low[column * width..(column + 1) * width].swap_with_slice(&mut high[..width]);
        }
        let (done, rest) = system.split_at_mut((column + 1) * width);
        let top = &done[column * width..];
        arch.dispatch(Rows { top, rest, column });
    }
    let mut x = vec![0.0; size];
    for row in (0..size).rev() {
        let line = &system[row * width..(row + 1) * width];
        let sum: f64 = (row + 1..size).map(|k| line[k] * x[k]).sum();
        x[row] = (line[size] - sum) / line[row];
    }
    x.iter().all(|x| x.is_finite()).then_some(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{TAU, cos, sin};

    #[test]
    fn a_hole_in_a_tube_is_closed_round() {
        // A tube of radius 3, its front half missing over a length of 6.
        let mut all = Vec::new();
        for i in -8..=8_i32 {
            for k in 0..24 {
                let angle = TAU * f64::from(k) / 24.0;
                let (z, out) = (f64::from(i) * 0.75, DVec3::new(cos(angle), sin(angle), 0.0));
                if z.abs() >= 3.0 || out.x < -0.3 {
                    all.push((out * 3.0 + DVec3::Z * z, out));
                }
            }
        }
        let patch = Patch::new(&all).unwrap();
        for place in [DVec3::new(3.5, 0.0, 0.0), DVec3::new(3.2, 1.0, 1.0), DVec3::new(2.0, 2.4, -2.0)] {
            let p = patch.project(place);
            assert!((p.truncate().length() - 3.0).abs() < 0.25, "{p}");
        }
    }
}
