//! How far a predicted shape is from another one with the same loops.

use super::system::System;
use super::{Numbers, Rest};
use crate::preview::net::Net;
use glam::{DMat3, DVec3};

/// Distances between a predicted shape and its target, after the best rigid motion (no reflection) of each piece that
/// hangs together. They go from the loops of one to the fabric of the other, both ways, in stitch heights.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fit {
    /// Mean distance, both ways.
    pub chamfer: f64,
    /// Largest distance, both ways.
    pub hausdorff: f64,
    /// Root mean square distance of each loop from its own place.
    pub rms: f64,
    /// How far the prediction came to rest; the distances say nothing when it did not.
    pub rest: Rest,
}

/// Compares the places of all pieces that have a target.
pub(super) fn fit(
    nets: &[Net],
    places: &[Vec<DVec3>],
    target: &[Vec<DVec3>],
    height: f64,
    rest: Rest,
) -> Option<Fit> {
    let numbers = Numbers::new(nets);
    let surface = System::new(nets, &numbers, 1.0).surface();
    let mut pairs: Vec<Option<[DVec3; 2]>> = vec![None; numbers.count];
    for ((ids, places), target) in numbers.ids.iter().zip(places).zip(target) {
        for ((id, place), target) in ids.iter().zip(places).zip(target) {
            pairs[*id as usize].get_or_insert([*place, *target]);
        }
    }
    let owner = numbers.owners(nets);
    let (mut ways, mut far, mut square) = ([0.0, 0.0], 0.0_f64, 0.0);
    let mut count = 0.0;
    for group in 0..nets.len() {
        let of = |id: usize| if owner[id] == group { pairs[id] } else { None };
        let members: Vec<[DVec3; 2]> = (0..pairs.len()).filter_map(of).collect();
        if members.len() < 3 {
            continue;
        }
        let motion = Motion::best(&members);
        let triangles: Vec<[[DVec3; 2]; 3]> = surface
            .iter()
            .filter_map(|ids| {
                let [a, b, c] = ids.map(|id| of(id as usize).map(|[from, to]| [motion.apply(from), to]));
                Some([a?, b?, c?])
            })
            .collect();
        let sheet = |side: usize| {
            Sheet::new(triangles.iter().map(|corners| corners.map(|pair| pair[side])).collect(), 1.5 * height)
        };
        let sheets = [sheet(0), sheet(1)];
        for pair in &members {
            let pair = [motion.apply(pair[0]), pair[1]];
            square += pair[0].distance_squared(pair[1]);
            for (side, place) in pair.into_iter().enumerate() {
                let off = sheets[1 - side].distance(place);
                ways[side] += off;
                far = far.max(off);
            }
        }
        count += members.len() as f64;
    }
    (count > 0.0).then(|| Fit {
        chamfer: 0.5 * (ways[0] + ways[1]) / count / height,
        hausdorff: far / height,
        rms: (square / count).sqrt() / height,
        rest,
    })
}

/// A rotation and a shift.
struct Motion {
    turn: DMat3,
    from: DVec3,
    to: DVec3,
}

impl Motion {
    /// The motion that brings the first of each pair nearest to the second (Horn 1987, by unit quaternions, which
    /// hold no reflection).
    fn best(pairs: &[[DVec3; 2]]) -> Self {
        let share = 1.0 / pairs.len() as f64;
        let middle = |side: usize| pairs.iter().map(|pair| pair[side]).sum::<DVec3>() * share;
        let (from, to) = (middle(0), middle(1));
        let mut s = [[0.0; 3]; 3];
        for pair in pairs {
            let (a, b) = ((pair[0] - from).to_array(), (pair[1] - to).to_array());
            for (row, a) in s.iter_mut().zip(a) {
                for (entry, b) in row.iter_mut().zip(b) {
                    *entry += a * b;
                }
            }
        }
        let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = s;
        let mut n = [
            [xx + yy + zz, yz - zy, zx - xz, xy - yx],
            [yz - zy, xx - yy - zz, xy + yx, zx + xz],
            [zx - xz, xy + yx, yy - xx - zz, yz + zy],
            [xy - yx, zx + xz, yz + zy, zz - xx - yy],
        ];
        let [w, x, y, z] = greatest(&mut n);
        let turn = DMat3::from_cols(
            DVec3::new(w * w + x * x - y * y - z * z, 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)),
            DVec3::new(2.0 * (x * y - w * z), w * w - x * x + y * y - z * z, 2.0 * (y * z + w * x)),
            DVec3::new(2.0 * (x * z + w * y), 2.0 * (y * z - w * x), w * w - x * x - y * y + z * z),
        );
        Self { turn, from, to }
    }

    fn apply(&self, place: DVec3) -> DVec3 {
        self.turn * (place - self.from) + self.to
    }
}

/// The unit eigenvector of the greatest eigenvalue of a symmetric matrix, by Jacobi rotations.
fn greatest(n: &mut [[f64; 4]; 4]) -> [f64; 4] {
    let mut vectors: [[f64; 4]; 4] =
        std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    for _ in 0..24 {
        for p in 0..3 {
            for q in p + 1..4 {
                if n[p][q].abs() <= 1e-300 {
                    continue;
                }
                let theta = (n[q][q] - n[p][p]) / (2.0 * n[p][q]);
                let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let c = 1.0 / (t * t + 1.0).sqrt();
                let s = t * c;
                for row in &mut *n {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
                let (upper, lower) = (n[p], n[q]);
                n[p] = std::array::from_fn(|k| c * upper[k] - s * lower[k]);
                n[q] = std::array::from_fn(|k| s * upper[k] + c * lower[k]);
                for row in &mut vectors {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
            }
        }
    }
    let best = (1..4).fold(0, |best, k| if n[k][k] > n[best][best] { k } else { best });
    vectors.map(|row| row[best])
}

/// Triangles in a grid of cells.
struct Sheet {
    triangles: Vec<[DVec3; 3]>,
    low: DVec3,
    cell: f64,
    size: [i64; 3],
    /// Where the triangles of each cell begin in `inside`.
    offsets: Vec<u32>,
    inside: Vec<u32>,
}

/// Most cells.
const CELLS: f64 = 1e6;

impl Sheet {
    fn new(triangles: Vec<[DVec3; 3]>, cell: f64) -> Self {
        let corners = || triangles.iter().flatten().copied();
        let low = corners().reduce(DVec3::min).unwrap_or_default();
        let extent = corners().reduce(DVec3::max).unwrap_or_default() - low;
        let mut cell = cell.max(1e-9);
        while ((extent / cell).floor() + 1.0).to_array().into_iter().product::<f64>() > CELLS {
            cell *= 1.5;
        }
        let size = ((extent / cell).floor() + 1.0).to_array().map(|cells| cells as i64);
        let mut sheet = Self { triangles, low, cell, size, offsets: Vec::new(), inside: Vec::new() };
        let cells = size.iter().product::<i64>() as usize;
        let mut counts = vec![0_u32; cells + 1];
        let spans: Vec<[[i64; 3]; 2]> = sheet
            .triangles
            .iter()
            .map(|[a, b, c]| [sheet.place(a.min(*b).min(*c)), sheet.place(a.max(*b).max(*c))])
            .collect();
        for span in &spans {
            sheet.each(*span, |cell| counts[cell + 1] += 1);
        }
        for k in 0..cells {
            counts[k + 1] += counts[k];
        }
        let mut next = counts.clone();
        let mut inside = vec![0_u32; counts[cells] as usize];
        for (index, span) in spans.iter().enumerate() {
            sheet.each(*span, |cell| {
                inside[next[cell] as usize] = index as u32;
                next[cell] += 1;
            });
        }
        (sheet.offsets, sheet.inside) = (counts, inside);
        sheet
    }

    fn place(&self, point: DVec3) -> [i64; 3] {
        ((point - self.low) / self.cell).floor().to_array().map(|cell| cell as i64)
    }

    /// Tells each cell of a box that lies in the grid.
    fn each(&self, [from, to]: [[i64; 3]; 2], mut tell: impl FnMut(usize)) {
        let [nx, ny, nz] = self.size;
        for z in from[2].max(0)..=to[2].min(nz - 1) {
            for y in from[1].max(0)..=to[1].min(ny - 1) {
                for x in from[0].max(0)..=to[0].min(nx - 1) {
                    tell(((z * ny + y) * nx + x) as usize);
                }
            }
        }
    }

    /// Distance of a point from the nearest triangle.
    fn distance(&self, point: DVec3) -> f64 {
        let here = self.place(point);
        let most = self
            .size
            .iter()
            .zip(here)
            .map(|(size, here)| here.abs().max((size - here).abs()))
            .max()
            .unwrap_or(0);
        let mut best = f64::INFINITY;
        let mut reach = 1;
        loop {
            let span = [here.map(|k| k - reach), here.map(|k| k + reach)];
            self.each(span, |cell| {
                for index in &self.inside[self.offsets[cell] as usize..self.offsets[cell + 1] as usize] {
                    best = best.min(nearest(point, &self.triangles[*index as usize]));
                }
            });
            // What was not looked at is at least this far.
            let sure = reach as f64 * self.cell;
            if best <= sure * sure || reach > most {
                return best.sqrt();
            }
            reach *= 2;
        }
    }
}

/// Square of the distance of a point from a triangle (Ericson 2005, section 5.1.5).
fn nearest(p: DVec3, [a, b, c]: &[DVec3; 3]) -> f64 {
    let (ab, ac, ap) = (*b - *a, *c - *a, p - *a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return ap.length_squared();
    }
    let bp = p - *b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return bp.length_squared();
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (ap - ab * (d1 / (d1 - d3))).length_squared();
    }
    let cp = p - *c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return cp.length_squared();
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (ap - ac * (d2 / (d2 - d6))).length_squared();
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return (bp - (*c - *b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)))).length_squared();
    }
    let scale = 1.0 / (va + vb + vc);
    (ap - ab * (vb * scale) - ac * (vc * scale)).length_squared()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sin_cos;

    #[test]
    fn a_motion_is_found_again_and_a_mirror_is_not() {
        let (sin, cos) = sin_cos(0.7);
        let moved = |p: DVec3| {
            DVec3::new(cos * p.x - sin * p.y, p.z, -(sin * p.x + cos * p.y)) + DVec3::new(3.0, 1.0, 2.0)
        };
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y * 2.0, DVec3::Z * 3.0, DVec3::ONE];
        let pairs = points.map(|point| [point, moved(point)]);
        let motion = Motion::best(&pairs);
        for [from, to] in pairs {
            assert!(motion.apply(from).distance(to) < 1e-12);
        }
        let mirrored = points.map(|point| [point, DVec3::new(-point.x, point.y, point.z)]);
        let motion = Motion::best(&mirrored);
        assert!((motion.turn.determinant() - 1.0).abs() < 1e-12);
        assert!(mirrored.iter().any(|[from, to]| motion.apply(*from).distance(*to) > 0.1));
    }

    #[test]
    fn distances_to_a_sheet_agree_with_all_pairs() {
        let triangles: Vec<[DVec3; 3]> = (0..40)
            .map(|k| {
                let at = DVec3::new(f64::from(k * 7 % 11), f64::from(k * 5 % 13), f64::from(k % 5));
                [at, at + DVec3::new(1.5, 0.2, 0.0), at + DVec3::new(0.3, 1.1, 0.4)]
            })
            .collect();
        let sheet = Sheet::new(triangles.clone(), 1.0);
        for k in 0..60 {
            let point =
                DVec3::new(f64::from(k % 17) - 3.0, f64::from(k * 3 % 19) - 2.0, f64::from(k % 9) - 2.0)
                    * 1.3;
            let all = triangles.iter().map(|triangle| nearest(point, triangle)).fold(f64::INFINITY, f64::min);
            assert!((sheet.distance(point) - all.sqrt()).abs() < 1e-12);
        }
    }
}
