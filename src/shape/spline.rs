//! The smooth closed curve through points, and places on it by arc length.

use super::bezier;
use glam::DVec3;

/// A periodic cubic spline over chord length, and its arc length at four places a span.
pub(super) struct Spline {
    /// Coefficients of the powers of each span's parameter in [0, 1].
    spans: Vec<[DVec3; 4]>,
    /// Arc length up to each piece, and the whole.
    pub(super) lengths: Vec<f64>,
    /// Lengths of the derivative at both ends of each piece.
    speeds: Vec<[f64; 2]>,
}

/// Pieces of a span.
const PARTS: usize = 4;
/// Share of a span that each of them has.
const PART: f64 = 1.0 / PARTS as f64;

impl Spline {
    /// Through three points or more, no two neighbors of them alike.
    pub(super) fn new(points: &[DVec3]) -> Self {
        let count = points.len();
        let next = |i: usize| if i + 1 == count { 0 } else { i + 1 };
        let before = |i: usize| if i == 0 { count - 1 } else { i - 1 };
        let chords: Vec<f64> = (0..count).map(|i| points[i].distance(points[next(i)])).collect();
        let secants: Vec<DVec3> = (0..count).map(|i| (points[next(i)] - points[i]) / chords[i]).collect();
        // Row i: chord_i m_(i-1) + 2 (chord_(i-1) + chord_i) m_i + chord_(i-1) m_(i+1) = right hand side.
        let diagonal: Vec<f64> = (0..count).map(|i| 2.0 * (chords[before(i)] + chords[i])).collect();
        let right: Vec<DVec3> = (0..count)
            .map(|i| 3.0 * (chords[i] * secants[before(i)] + chords[before(i)] * secants[i]))
            .collect();
        let slopes =
            cyclic(&chords, &diagonal, &(0..count).map(|i| chords[before(i)]).collect::<Vec<_>>(), &right);
        let cubic = |i: usize| {
            let next = next(i);
            let (a, da, db) = (points[i], slopes[i] * chords[i], slopes[next] * chords[i]);
            let rise = points[next] - a;
            [a, da, 3.0 * rise - 2.0 * da - db, da + db - 2.0 * rise]
        };
        let pieces = count * PARTS;
        let mut spline = Self {
            spans: (0..count).map(cubic).collect(),
            lengths: Vec::with_capacity(pieces + 1),
            speeds: Vec::with_capacity(pieces),
        };
        spline.lengths.push(0.0);
        let mut total = 0.0;
        for span in 0..count {
            let mut last = spline.speeds(span, [0.0])[0];
            for part in 0..PARTS {
                let (from, to) = (part as f64 * PART, (part + 1) as f64 * PART);
                let [a, b, c, d, e] = bezier::nodes(from, to);
                let [a, b, c, d, e, speed] = spline.speeds(span, [a, b, c, d, e, to]);
                total += bezier::weigh(from, to, [a, b, c, d, e]);
                spline.lengths.push(total);
                spline.speeds.push([last, speed]);
                last = speed;
            }
        }
        spline
    }

    /// Derivative by the span's parameter.
    fn slope(&self, span: usize, t: f64) -> DVec3 {
        let [_, line, square, cube] = self.spans[span];
        line + t * (2.0 * square + t * 3.0 * cube)
    }

    /// Its length at several parameters, coordinate by coordinate: several at a time.
    #[inline]
    fn speeds<const N: usize>(&self, span: usize, t: [f64; N]) -> [f64; N] {
        let [_, line, square, cube] = self.spans[span];
        let [mut x, mut y, mut z] = [[0.0; N]; 3];
        for k in 0..N {
            let three = t[k] * 3.0;
            x[k] = line.x + t[k] * (2.0 * square.x + three * cube.x);
            y[k] = line.y + t[k] * (2.0 * square.y + three * cube.y);
            z[k] = line.z + t[k] * (2.0 * square.z + three * cube.z);
        }
        std::array::from_fn(|k| (x[k] * x[k] + y[k] * y[k] + z[k] * z[k]).sqrt())
    }

    /// Point and unit direction at an arc length that lies in the given piece.
    pub(super) fn at_length(&self, piece: usize, target: f64) -> (DVec3, DVec3) {
        let (span, from) = (piece / PARTS, (piece % PARTS) as f64 * PART);
        let size = self.lengths[piece + 1] - self.lengths[piece];
        let share = (target - self.lengths[piece]) / size.max(f64::MIN_POSITIVE);
        // A cubic of the length, with one by the speeds as slopes, comes so near that one step of Newton does the rest.
        let [low, high] = self.speeds[piece].map(|speed| (size / (speed * PART)).min(3.0));
        let cubic = share * (low + share * (3.0 - 2.0 * low - high + share * (low + high - 2.0)));
        let mut t = from + cubic.clamp(0.0, 1.0) * PART;
        let [a, b, c, d, e] = bezier::nodes(from, t);
        let [a, b, c, d, e, speed] = self.speeds(span, [a, b, c, d, e, t]);
        let miss = self.lengths[piece] + bezier::weigh(from, t, [a, b, c, d, e]) - target;
        if speed > 0.0 {
            t = (t - miss / speed).clamp(from, from + PART);
        }
        let [start, line, square, cube] = self.spans[span];
        (start + t * (line + t * (square + t * cube)), self.slope(span, t).normalize_or_zero())
    }
}

/// Solves a cyclic tridiagonal system (diagonally dominant) by the Sherman-Morrison formula.
fn cyclic(lower: &[f64], diagonal: &[f64], upper: &[f64], right: &[DVec3]) -> Vec<DVec3> {
    let count = diagonal.len();
    let gamma = -diagonal[0];
    let corner_low = upper[count - 1];
    let corner_high = lower[0];
    let mut changed = diagonal.to_vec();
    changed[0] -= gamma;
    changed[count - 1] -= corner_low * corner_high / gamma;
    let mut ratio = vec![0.0; count];
    let mut first = vec![DVec3::ZERO; count];
    let mut second = vec![0.0; count];
    for i in 0..count {
        let unit = match i {
            0 => gamma,
            _ if i + 1 == count => corner_low,
            _ => 0.0,
        };
        let (low, last, last_unit, last_ratio) = match i.checked_sub(1) {
            Some(j) => (lower[i], first[j], second[j], ratio[j]),
            None => (0.0, DVec3::ZERO, 0.0, 0.0),
        };
        let pivot = changed[i] - low * last_ratio;
        ratio[i] = upper[i] / pivot;
        first[i] = (right[i] - low * last) / pivot;
        second[i] = (unit - low * last_unit) / pivot;
    }
    for i in (0..count - 1).rev() {
        first[i] = first[i] - ratio[i] * first[i + 1];
        second[i] -= ratio[i] * second[i + 1];
    }
    let weight = corner_high / gamma;
    let factor = (first[0] + weight * first[count - 1]) / (1.0 + second[0] + weight * second[count - 1]);
    first.iter().zip(&second).map(|(a, b)| *a - factor * *b).collect()
}
