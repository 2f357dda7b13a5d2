//! By how much one closed line is turned against another: where all shifts of its samples are told, and most are told apart soon.

use super::loops::ClosedLine;

/// Places around a line at which it is compared with another, seen from its center.
pub(super) struct Samples {
    /// Three rows of coordinates, twice around: all shifts of one point are told in one go.
    rows: [[f64; 2 * SAMPLES]; 3],
}

const SAMPLES: usize = 64;
/// Shifts at a time, and points after which they are told to be worse than one before.
const LANES: usize = 4;
const STRETCH: usize = 8;

impl Samples {
    pub(super) fn of(line: &ClosedLine) -> Self {
        let center = line.center();
        let mut rows = [[0.0; 2 * SAMPLES]; 3];
        for k in 0..SAMPLES {
            let arm = line.point(k as f64 / SAMPLES as f64) - center;
            for (row, value) in rows.iter_mut().zip(arm.to_array()) {
                (row[k], row[k + SAMPLES]) = (value, value);
            }
        }
        Self { rows }
    }

    /// Squared distances from another line, summed, for shifts from `first` on. What exceeds `most` for all of them need not be
    /// told to its end.
    fn costs(&self, other: &Self, first: usize, most: f64) -> [f64; LANES] {
        let ([x, y, z], [a, b, c]) = (&self.rows, &other.rows);
        let mut sums = [0.0; LANES];
        for stretch in 0..SAMPLES / STRETCH {
            for i in stretch * STRETCH..(stretch + 1) * STRETCH {
                let lane = |row: &[f64], at: f64| -> [f64; LANES] {
                    std::array::from_fn(|k| (row[first + i + k] - at) * (row[first + i + k] - at))
                };
                let (x, y, z) = (lane(x, a[i]), lane(y, b[i]), lane(z, c[i]));
                sums = std::array::from_fn(|k| sums[k] + (x[k] + y[k] + z[k]));
            }
            if sums.iter().all(|sum| *sum > most) {
                break;
            }
        }
        sums
    }

    /// As [`ClosedLine::phase_against`].
    pub(super) fn phase_against(&self, other: &Self) -> f64 {
        let (mut best, mut least) = (0, f64::INFINITY);
        for first in (0..SAMPLES).step_by(LANES) {
            for (i, cost) in self.costs(other, first, least).into_iter().enumerate() {
                // A tie goes to the smaller shift, so that equal loops stay as they are.
                if first + i == 0 || cost < least * (1.0 - 1e-9) {
                    (best, least) = (first + i, cost);
                }
            }
        }
        let cost = |shift: usize| {
            let lane = shift % LANES;
            self.costs(other, shift % SAMPLES - lane, f64::INFINITY)[lane]
        };
        let (before, after) = (cost(best + SAMPLES - 1), cost(best + 1));
        let bow = before + after - 2.0 * least;
        let shift = if bow > 0.0 { (0.5 * (before - after) / bow).clamp(-0.5, 0.5) } else { 0.0 };
        // Equal neighbors differ by rounding only: no shift then.
        let shift = if shift.abs() < 1e-9 { 0.0 } else { shift };
        (best as f64 + shift) / SAMPLES as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{TAU, sin_cos};
    use glam::DVec3;

    /// A line with some lobes, and a little of a second form.
    fn lobed(lobes: f64, depth: f64, begin: f64) -> Samples {
        let at = |k: u32| {
            let turn = TAU * (f64::from(k) / 90.0 + begin);
            let radius = 10.0 + depth * sin_cos(lobes * turn).1 + 0.3 * depth * sin_cos(turn).0;
            let (sin, cos) = sin_cos(-turn);
            DVec3::new(radius * cos, radius * sin, depth * sin_cos(2.0 * turn).0)
        };
        Samples::of(&ClosedLine::through(&(0..90).map(at).collect::<Vec<_>>(), 96).unwrap())
    }

    #[test]
    fn the_best_shift_is_that_of_all_shifts() {
        for k in 0..200 {
            let begin = f64::from(k) / 200.0;
            let (other, line) = (lobed(3.0, 2.0, 0.0), lobed(3.0, 1.5, begin));
            let all = (0..SAMPLES).step_by(LANES).flat_map(|first| line.costs(&other, first, f64::INFINITY));
            let all: Vec<f64> = all.collect();
            let best = (0..SAMPLES).min_by(|a, b| all[*a].total_cmp(&all[*b])).unwrap();
            let phase = line.phase_against(&other);
            let off = (phase * SAMPLES as f64 - best as f64).abs();
            assert!(off <= 0.5, "{begin}: {phase} and {best}");
            let apart = (phase + begin).rem_euclid(1.0);
            assert!(apart.min(1.0 - apart) < 2e-2, "{begin}: {phase}");
        }
        let line = lobed(3.0, 2.0, 0.4);
        assert_eq!(line.phase_against(&line), 0.0);
    }
}
