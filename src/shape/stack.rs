//! A tube through a stack of loops: bicubic between even samples, smooth through its poles.

use super::ring::{Ring, gap};
use super::{End, Jet, ParametricSurface};
use glam::DVec3;

/// A tube S(u, v) through loops in order; v is the share of a loop's length, u the share of the mean distance.
///
/// Between loops and between samples it is a cubic with Catmull-Rom slopes (centripetal in u by the distances of the
/// loops). At a closed end the loops shrink to a point, and the cubic goes on through it to the loop's other side.
#[derive(Clone, Debug)]
pub struct Stack {
    /// u of each row of samples.
    places: Vec<f64>,
    /// What does not depend on the sample, for each stretch between two rows.
    stretches: Vec<Stretch>,
    /// Rows of `around` samples, one after the other; before each the last of the row, behind it the first two.
    samples: Vec<DVec3>,
    around: usize,
    ends: [End; 2],
    /// Length from end to end, mean over v, in the unit of the loops.
    length: f64,
}

/// Slopes of a cubic over two rows, from values at up to four rows.
#[derive(Clone, Copy, Debug, Default)]
struct Stretch {
    /// Weights of the outer row, the near and the far row in the slope at the near one; and which row is the outer one,
    /// turned by how many samples.
    ends: [Outer; 2],
}

/// One end of a stretch.
#[derive(Clone, Copy, Debug, Default)]
struct Outer {
    near: [f64; 3],
    row: Option<(u32, u32)>,
}

/// Samples that each row has beside its own.
const BESIDE: usize = 3;

/// Most rows of samples.
const MOST_LOOPS: usize = 100_000;
/// Most samples around.
const MOST_AROUND: usize = 512;

impl Stack {
    /// A tube through closed lines, all run through in the sense that v has (clockwise seen from the end of the tube
    /// back to its start), each turned against the one before. A closed end goes on to a point: give it as `poles`.
    ///
    /// `None` for fewer than two rows, or loops that all lie in one place.
    pub fn new(loops: &[Ring], poles: [Option<DVec3>; 2], around: usize) -> Option<Self> {
        let around = around.clamp(8, MOST_AROUND);
        let mut rows: Vec<Vec<DVec3>> = Vec::with_capacity(loops.len());
        for ring in loops.iter().take(MOST_LOOPS) {
            let row = match rows.last() {
                Some(before) => ring.beside(before),
                None => ring.samples(around, 0.0),
            };
            rows.push(row);
        }
        Self::of_rows(rows, poles)
    }

    /// The same through lines whose phases are known: where [`Ring::turned`] puts each of them against the one before.
    pub(crate) fn turned(loops: &[(Ring, f64)], poles: [Option<DVec3>; 2], around: usize) -> Option<Self> {
        let around = around.clamp(8, MOST_AROUND);
        let loops = loops.iter().take(MOST_LOOPS);
        Self::of_rows(loops.map(|(ring, phase)| ring.samples(around, *phase)).collect(), poles)
    }

    /// A tube through rows of samples that lie beside each other already.
    pub(crate) fn of_rows(mut rows: Vec<Vec<DVec3>>, poles: [Option<DVec3>; 2]) -> Option<Self> {
        let around = rows.first()?.len();
        if let Some(pole) = poles[0] {
            rows.insert(0, vec![pole; around]);
        }
        if let Some(pole) = poles[1] {
            rows.push(vec![pole; around]);
        }
        let mut kept: Vec<Vec<DVec3>> = Vec::with_capacity(rows.len());
        let mut places: Vec<f64> = Vec::with_capacity(rows.len());
        let mut total = 0.0;
        for row in rows {
            let step = kept.last().map_or(0.0, |before| gap(before, &row).0);
            // Loops in the same place have no direction between them.
            if !kept.is_empty() && step <= 1e-9 * (1.0 + total) {
                continue;
            }
            total += step;
            places.push(total);
            kept.push(row);
        }
        if kept.len() < 2 || !total.is_finite() || total <= 0.0 || around < 8 {
            return None;
        }
        for place in &mut places {
            *place /= total;
        }
        let ends = poles.map(|pole| if pole.is_some() { End::Closed } else { End::Open });
        let mut samples = Vec::with_capacity(kept.len() * (around + BESIDE));
        for row in &kept {
            samples.push(row[around - 1]);
            samples.extend(row);
            samples.extend(&row[..BESIDE - 1]);
        }
        if !samples.iter().all(|p| p.is_finite()) {
            return None;
        }
        let mut stack = Self { places, stretches: Vec::new(), samples, around, ends, length: total };
        stack.stretches = stack.find_stretches();
        Some(stack)
    }

    /// How the ends are closed.
    pub fn ends(&self) -> [End; 2] {
        self.ends
    }

    /// Mean length from end to end.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The rows of samples, poles included, from start to end.
    pub fn rows(&self) -> impl DoubleEndedIterator<Item = &[DVec3]> {
        self.samples.chunks_exact(self.around + BESIDE).map(|row| &row[1..=self.around])
    }

    /// The places of the rows in u.
    pub fn places(&self) -> &[f64] {
        &self.places
    }

    /// Where around the tube rows lie closest, in turns: found between samples, so that it does not depend on where these begin.
    pub(crate) fn slowest_side(&self) -> f64 {
        super::slowest_side(self, true)
    }

    /// Replaces the samples, row by row.
    pub(super) fn set(&mut self, f: impl Fn(usize, usize) -> DVec3) {
        for (i, row) in self.samples.chunks_exact_mut(self.around + BESIDE).enumerate() {
            for (k, sample) in row.iter_mut().enumerate() {
                *sample = f(i, (k + self.around - 1) % self.around);
            }
        }
    }

    /// Spaces the rows in u by their mean distances again.
    pub(super) fn respace(&mut self) {
        let rows: Vec<Vec<DVec3>> = self.rows().map(<[DVec3]>::to_vec).collect();
        let mut total = 0.0;
        for (i, place) in self.places.iter_mut().enumerate() {
            total += if i == 0 { 0.0 } else { gap(&rows[i - 1], &rows[i]).0 };
            *place = total;
        }
        for place in &mut self.places {
            *place /= total;
        }
        self.length = total;
        self.stretches = self.find_stretches();
    }

    /// Row `i` of the stack for the cubic: beyond a pole the other side of the next loop, beyond an open end nothing.
    fn row(&self, i: isize) -> Option<(f64, usize, usize)> {
        let last = self.places.len() as isize - 1;
        if i < 0 {
            return (self.ends[0] == End::Closed)
                .then(|| (-self.places[(-i) as usize], (-i) as usize, self.around / 2));
        }
        if i > last {
            let j = (2 * last - i) as usize;
            return (self.ends[1] == End::Closed).then(|| (2.0 - self.places[j], j, self.around / 2));
        }
        Some((self.places[i as usize], i as usize, 0))
    }

    /// A slope is that of the parabola through three rows.
    fn find_stretches(&self) -> Vec<Stretch> {
        let stretch = |(i, pair): (usize, &[f64])| {
            let (start, end) = (pair[0], pair[1]);
            let width = end - start;
            let outer = |row: Option<(f64, usize, usize)>, sign: f64| match row {
                Some((at, row, turn)) => {
                    let (h0, h1) = (if sign > 0.0 { start - at } else { at - end }, width);
                    let sum = h0 + h1;
                    let near = [-h1 / (h0 * sum), (h1 - h0) / (h0 * h1), h0 / (h1 * sum)];
                    Outer { near: near.map(|weight| sign * weight), row: Some((row as u32, turn as u32)) }
                }
                None => Outer { near: [0.0, -sign / width, sign / width], row: None },
            };
            let i = i as isize;
            Stretch { ends: [outer(self.row(i - 1), 1.0), outer(self.row(i + 2), -1.0)] }
        };
        self.places.windows(2).enumerate().map(stretch).collect()
    }

    /// Weights of up to four rows for point and slope at u.
    fn weights(&self, u: f64) -> [(usize, usize, f64, f64); 4] {
        let last = self.places.len() - 1;
        let i = self.places.partition_point(|place| *place <= u).clamp(1, last) - 1;
        let (start, end) = (self.places[i], self.places[i + 1]);
        let width = end - start;
        let t = (u - start) / width;
        // Hermite basis with slopes by the unit of u; beyond an open end the line goes on straight.
        let (value, slope) = if (0.0..=1.0).contains(&t) {
            let (t2, t3) = (t * t, t * t * t);
            (
                [
                    2.0 * t3 - 3.0 * t2 + 1.0,
                    (t3 - 2.0 * t2 + t) * width,
                    3.0 * t2 - 2.0 * t3,
                    (t3 - t2) * width,
                ],
                [
                    (6.0 * t2 - 6.0 * t) / width,
                    3.0 * t2 - 4.0 * t + 1.0,
                    (6.0 * t - 6.0 * t2) / width,
                    3.0 * t2 - 2.0 * t,
                ],
            )
        } else if t < 0.0 {
            ([1.0, u - start, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0])
        } else {
            ([0.0, 0.0, 1.0, u - end], [0.0, 0.0, 0.0, 1.0])
        };
        let mut rows =
            [(i, 0, value[0], slope[0]), (i + 1, 0, value[2], slope[2]), (i, 0, 0.0, 0.0), (i, 0, 0.0, 0.0)];
        for (side, outer) in self.stretches[i].ends.iter().enumerate() {
            let [w_out, w_here, w_next] = outer.near;
            let (v, s) = (value[2 * side + 1], slope[2 * side + 1]);
            let (here, next) = (side, 1 - side);
            rows[here].2 += w_here * v;
            rows[here].3 += w_here * s;
            rows[next].2 += w_next * v;
            rows[next].3 += w_next * s;
            if let Some((row, turn)) = outer.row {
                rows[2 + side] = (row as usize, turn as usize, w_out * v, w_out * s);
            }
        }
        rows
    }

    /// The first of four samples around v that a cubic runs through, and the place between the middle ones.
    fn column(&self, v: f64) -> (usize, f64) {
        let scaled = (v - v.floor()) * self.around as f64;
        let j = (scaled as usize).min(self.around - 1);
        (j, scaled - j as f64)
    }

    /// The four samples of a row from column `j` on, turned by so many.
    #[inline]
    fn four(&self, row: usize, j: usize, turn: usize) -> &[DVec3; 4] {
        let column = if j + turn < self.around { j + turn } else { j + turn - self.around };
        let first = row * (self.around + BESIDE) + column;
        self.samples[first..].first_chunk().unwrap_or(&[DVec3::ZERO; 4])
    }

    fn place(&self, u: f64, v: f64) -> DVec3 {
        let (j, t) = self.column(v);
        let along = values(t);
        let mut place = DVec3::ZERO;
        for (row, turn, value, _) in self.weights(u) {
            if value == 0.0 {
                continue;
            }
            let mut point = DVec3::ZERO;
            for (sample, along) in self.four(row, j, turn).iter().zip(&along) {
                point += *sample * *along;
            }
            place += point * value;
        }
        place
    }

    /// The `k`-th line along the tube, which goes through a sample of each row.
    pub(crate) fn on_line(&self, u: f64, k: usize) -> DVec3 {
        let mut place = DVec3::ZERO;
        for (row, turn, value, _) in self.weights(u) {
            if value != 0.0 {
                place += self.four(row, k, turn)[1] * value;
            }
        }
        place
    }

    fn eval(&self, rows: &[(usize, usize, f64, f64); 4], v: f64) -> Jet {
        let (j, t) = self.column(v);
        let t2 = t * t;
        let along = values(t);
        let per = 0.5 * self.around as f64;
        let slope = [
            per * (4.0 * t - 1.0 - 3.0 * t2),
            per * (9.0 * t2 - 10.0 * t),
            per * (1.0 + 8.0 * t - 9.0 * t2),
            per * (3.0 * t2 - 2.0 * t),
        ];
        // Point and slope side by side, so that both are taken at a time.
        let (mut jet, mut du) = ([[0.0; 2]; 3], [0.0; 3]);
        for (row, turn, value, rise) in rows {
            if *value == 0.0 && *rise == 0.0 {
                continue;
            }
            let mut sums = [[0.0; 2]; 3];
            for (sample, (along, slope)) in self.four(*row, j, *turn).iter().zip(along.iter().zip(&slope)) {
                for (sum, x) in sums.iter_mut().zip(sample.to_array()) {
                    sum[0] += x * along;
                    sum[1] += x * slope;
                }
            }
            for axis in 0..3 {
                jet[axis][0] += sums[axis][0] * value;
                jet[axis][1] += sums[axis][1] * value;
                du[axis] += sums[axis][0] * rise;
            }
        }
        let [point, dv] = [0, 1].map(|k| DVec3::from_array(jet.map(|axis| axis[k])));
        Jet { point, du: DVec3::from_array(du), dv }
    }
}

/// Weights of four samples in a cubic between the middle two.
fn values(t: f64) -> [f64; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [
        0.5 * (2.0 * t2 - t - t3),
        0.5 * (3.0 * t3 - 5.0 * t2 + 2.0),
        0.5 * (t + 4.0 * t2 - 3.0 * t3),
        0.5 * (t3 - t2),
    ]
}

impl ParametricSurface for Stack {
    fn point(&self, u: f64, v: f64) -> DVec3 {
        self.place(u, v)
    }
    fn jet(&self, u: f64, v: f64) -> Jet {
        self.eval(&self.weights(u), v)
    }
    fn ring(&self, u: f64, from: f64, jets: &mut [Jet]) {
        let (rows, count) = (self.weights(u), jets.len() as f64);
        for (k, jet) in jets.iter_mut().enumerate() {
            *jet = self.eval(&rows, from + k as f64 / count);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math;
    use crate::shape::measure;

    #[test]
    fn a_ball_of_loops_is_a_ball() {
        let around = |k: u32, angle: f64| {
            let (sin, cos) = math::sin_cos(-math::TAU * f64::from(k) / 256.0);
            DVec3::new(cos * math::sin(angle), sin * math::sin(angle), -math::cos(angle)) * 20.0
        };
        let rings: Vec<Ring> = (1..20)
            .map(|i| {
                Ring::new((0..256).map(|k| around(k, math::PI * f64::from(i) / 20.0)).collect()).unwrap()
            })
            .collect();
        let stack = Stack::new(&rings, [Some(DVec3::Z * -20.0), Some(DVec3::Z * 20.0)], 64).unwrap();
        let area = measure::area(&stack, 40, 32);
        assert!((area / (math::TAU * 2.0 * 400.0) - 1.0).abs() < 2e-3, "{area}");
        for (u, v) in [(0.01, 0.1), (0.33, 0.6), (0.985, 0.9), (0.5, 0.0)] {
            let jet = stack.jet(u, v);
            assert!((jet.point.length() / 20.0 - 1.0).abs() < 2e-3, "{u} {v} {jet:?}");
            assert!(jet.du.cross(jet.dv).dot(jet.point) > 0.0);
            let step = 1e-6;
            let slope = (stack.point(u + step, v) - stack.point(u - step, v)) / (2.0 * step);
            assert!(slope.distance(jet.du) < 1e-4 * slope.length(), "{slope} {}", jet.du);
            let slope = (stack.point(u, v + step) - stack.point(u, v - step)) / (2.0 * step);
            assert!(slope.distance(jet.dv) < 1e-4 * slope.length().max(1.0), "{slope} {}", jet.dv);
        }
    }

    #[test]
    fn lines_and_rings_are_those_of_single_places() {
        let around = |k: u32, angle: f64, radius: f64| {
            let (sin, cos) = math::sin_cos(-math::TAU * f64::from(k) / 96.0);
            DVec3::new(radius * cos + 0.2 * angle * angle, 0.8 * radius * sin, 3.0 * angle)
        };
        let rings: Vec<Ring> = (0..9)
            .map(|i| (f64::from(i), 4.0 + math::sin(f64::from(i))))
            .map(|(angle, radius)| Ring::new((0..96).map(|k| around(k, angle, radius)).collect()).unwrap())
            .collect();
        let stack = Stack::new(&rings, [None, Some(DVec3::new(16.0, 0.0, 27.0))], 32).unwrap();
        for u in [-0.01, 0.0, 0.3, 0.77, 0.999, 1.0] {
            for k in 0..32 {
                let point = stack.point(u, k as f64 / 32.0);
                assert!(stack.on_line(u, k).distance(point) < 1e-12);
            }
            let mut jets = [Jet::default(); 24];
            stack.ring(u, 0.4, &mut jets);
            for (k, jet) in jets.iter().enumerate() {
                assert_eq!(format!("{jet:?}"), format!("{:?}", stack.jet(u, 0.4 + k as f64 / 24.0)));
                assert!(jet.point.distance(stack.point(u, 0.4 + k as f64 / 24.0)) < 1e-12);
            }
        }
    }
}
