//! The field over a mesh whose level lines become rows.

use super::Mesh;
use super::ends::{Ends, Tip};
use super::solver::{Matrix, Solver};
use super::soup::NONE;

/// Where the rows of a mesh come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Field {
    /// Harmonic between the ends: no extrema but the ends, so a tube or a branch for each, and rows that are uneven where
    /// the thickness changes, which short rows take up.
    #[default]
    Harmonic,
    /// Distance from the start: even rows, but ragged where fronts meet behind an obstacle.
    Geodesic,
}

const TOLERANCE: f64 = 1e-7;
/// Cotangents of slivers are cut to this.
const FLATTEST: f64 = 1e3;
/// Weights are positive where obtuse triangles would make an extremum that is no end.
const LEAST_WEIGHT: f64 = 1e-4;
/// Rounds of that, after which all weights are.
const MENDS: u32 = 3;

impl Mesh {
    /// The value of every vertex: least at the start, greatest at the other ends.
    pub(super) fn field(&self, field: Field, ends: &Ends) -> Vec<f64> {
        match field {
            Field::Geodesic => ends.distance.clone(),
            Field::Harmonic => self.harmonic(ends),
        }
    }

    /// The field of a flow that enters at the start and leaves at the other ends, through each as much as fits its girth:
    /// so it rises by about 1 a unit of length on every limb, and each tip is a maximum. At closed ends the flow is spread
    /// evenly over a cap, around whose middle the level lines are rings; on an open edge the field has one value.
    fn harmonic(&self, ends: &Ends) -> Vec<f64> {
        let rings: Vec<&[u32]> = ends.others.iter().filter(|tip| tip.open).map(|tip| &tip.ring[..]).collect();
        let mut source = vec![0.0; self.points.len()];
        let mut total = 0.0;
        for tip in &ends.others {
            total += tip.girth;
            self.pour(tip, tip.girth, &mut source);
        }
        if !ends.start.open {
            self.pour(&ends.start, -total, &mut source);
        }
        self.potential(&ends.start.ring, &rings, &source, ends.strict, |v| ends.distance[v as usize])
    }

    /// The field of a flow that leaves at one end and enters at all others alike: around the limb that goes to that end the
    /// level lines are rings, and where it leaves the object they spread out evenly. Also the vertices at which it is 0.
    pub(super) fn lone(&self, ends: &Ends, which: usize) -> (Vec<f64>, Vec<u32>) {
        let mut ground = Vec::new();
        let rest = ends.others.iter().enumerate().filter(|(i, _)| *i != which).map(|(_, tip)| tip);
        for tip in rest.chain([&ends.start]) {
            if tip.open {
                ground.extend(&tip.ring);
            } else {
                let near = self.distances(&tip.ring, tip.cap);
                ground.extend((0..near.len() as u32).filter(|v| near[*v as usize] <= tip.cap));
            }
        }
        ground.sort_unstable();
        ground.dedup();
        let mut source = vec![0.0; self.points.len()];
        let tip = &ends.others[which];
        self.pour(tip, tip.girth, &mut source);
        let rings = if tip.open { vec![&tip.ring[..]] } else { Vec::new() };
        let field = self.potential(&ground, &rings, &source, ends.strict, |_| 0.0);
        (field, ground)
    }

    /// The potential of a flow out of `source` that is 0 on `ground` and has one value on each of the rings.
    fn potential(
        &self,
        ground: &[u32],
        rings: &[&[u32]],
        source: &[f64],
        strict: bool,
        guess: impl Fn(u32) -> f64,
    ) -> Vec<f64> {
        let count = self.points.len();
        let mut slot = vec![NONE; count];
        let mut groups: Vec<Vec<u32>> = Vec::new();
        let mut join = |ring: &[u32], slot: &mut Vec<u32>| {
            for vertex in ring {
                slot[*vertex as usize] = groups.len() as u32;
            }
            groups.push(ring.to_vec());
        };
        // The ground is group 0.
        join(ground, &mut slot);
        for ring in rings {
            join(ring, &mut slot);
        }
        for vertex in 0..count as u32 {
            if slot[vertex as usize] == NONE {
                join(&[vertex], &mut slot);
            }
        }
        let mut weights = self.weights();
        let mut x: Vec<f64> = groups.iter().skip(1).map(|group| guess(group[0])).collect();
        for round in if strict { MENDS } else { 0 }.. {
            if round == MENDS {
                for weight in &mut weights {
                    *weight = weight.max(LEAST_WEIGHT);
                }
            }
            let matrix = self.laplacian(&groups, &slot, &weights);
            let right: Vec<f64> =
                groups.iter().skip(1).map(|group| group.iter().map(|v| source[*v as usize]).sum()).collect();
            Solver::new(matrix).solve(&right, &mut x, TOLERANCE);
            let value = |v: u32| {
                slot[v as usize].checked_sub(1).and_then(|i| x.get(i as usize)).copied().unwrap_or(0.0)
            };
            let free = |v: &u32| {
                let slot = slot[*v as usize] as usize;
                slot > 0 && source[*v as usize] == 0.0 && groups[slot].len() == 1
            };
            let wrong: Vec<u32> = (0..count as u32)
                .filter(free)
                .filter(|v| {
                    let (mut above, mut below) = (false, false);
                    for other in self.neighbors(*v) {
                        above |= value(other) > value(*v);
                        below |= value(other) < value(*v);
                    }
                    !(above && below)
                })
                .collect();
            if wrong.is_empty() || round >= MENDS {
                break;
            }
            for h in wrong.iter().flat_map(|v| self.corners(*v)).flat_map(|h| [*h, Self::before(*h)]) {
                let twin = self.twins[h as usize];
                let least = weights[h as usize].max(LEAST_WEIGHT);
                weights[h as usize] = least;
                if twin != NONE {
                    weights[twin as usize] = least;
                }
            }
        }
        let value = |slot: u32| slot.checked_sub(1).and_then(|i| x.get(i as usize)).copied().unwrap_or(0.0);
        slot.into_iter().map(value).collect()
    }

    /// The Laplacian of the groups but the first, whose value is 0.
    fn laplacian(&self, groups: &[Vec<u32>], slot: &[u32], weights: &[f64]) -> Matrix {
        let mut matrix = Matrix { starts: vec![0], ..Matrix::default() };
        for (row, group) in groups.iter().enumerate().skip(1) {
            let mut diagonal = 0.0;
            let mut add = |other: u32, weight: f64| {
                let column = slot[other as usize];
                if column as usize == row {
                    return;
                }
                diagonal += weight;
                if column > 0 {
                    matrix.columns.push(column - 1);
                    matrix.values.push(-weight);
                }
            };
            for &vertex in group {
                for &h in self.corners(vertex) {
                    add(self.to(h), weights[h as usize]);
                    // An open edge is seen from one of its ends only.
                    let back = Self::before(h);
                    if self.twins[back as usize] == NONE {
                        add(self.from(back), weights[back as usize]);
                    }
                }
            }
            matrix.diagonal.push(diagonal);
            matrix.starts.push(matrix.columns.len() as u32);
        }
        matrix
    }

    /// Spreads a flow over an end.
    fn pour(&self, tip: &Tip, flow: f64, source: &mut [f64]) {
        let Some(&first) = tip.ring.first().filter(|_| !tip.open) else {
            if let Some(&first) = tip.ring.first() {
                source[first as usize] += flow;
            }
            return;
        };
        let near = self.distances(&[first], tip.cap);
        let share = |v: u32| self.corners(v).iter().map(|h| self.normal(h / 3).length()).sum::<f64>();
        let cap: Vec<(u32, f64)> =
            (0..near.len() as u32).filter(|v| near[*v as usize] <= tip.cap).map(|v| (v, share(v))).collect();
        let whole: f64 = cap.iter().map(|(_, share)| share).sum();
        for (vertex, share) in cap {
            source[vertex as usize] += flow * share / whole.max(f64::MIN_POSITIVE);
        }
    }

    /// For every half-edge half the sum of the cotangents across it.
    fn weights(&self) -> Vec<f64> {
        let cotangent: Vec<f64> = (0..self.twins.len() as u32)
            .map(|h| {
                let apex = self.point(self.from(Self::before(h)));
                let (a, b) = (self.point(self.from(h)) - apex, self.point(self.to(h)) - apex);
                let sine = a.cross(b).length();
                if sine > 0.0 { (a.dot(b) / sine).clamp(-FLATTEST, FLATTEST) } else { 0.0 }
            })
            .collect();
        let sum = |h: usize| {
            let twin = self.twins[h];
            0.5 * (cotangent[h] + if twin == NONE { 0.0 } else { cotangent[twin as usize] })
        };
        (0..cotangent.len()).map(sum).collect()
    }
}
