//! Smooth interpolation of numbers at given places, without overshoot.

/// A cubic in t = (x - `start`) `inverse`, lowest power first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cubic {
    pub(super) start: f64,
    pub(super) inverse: f64,
    pub(super) coefficients: [f64; 4],
}

/// Cubics over [0, 1] through the values at the places (ascending, at least one), constant before the first and
/// after the last: straight, or smooth. A `positive` quantity is kept well above zero between positive values.
pub(super) fn cubics(places: &[f64], values: &[f64], smooth: bool, positive: bool) -> Vec<Cubic> {
    let mut slopes = vec![0.0; places.len()];
    if smooth {
        slopes = Slopes::new(places).through(values, 1).to_vec();
        if positive {
            keep_above(places, values, &mut slopes);
        }
    }
    let (Some(&first), Some(&last)) = (places.first(), places.last()) else { return Vec::new() };
    let (low, high) = (values[0], values[values.len() - 1]);
    if first > 0.0 {
        slopes[0] = 0.0;
    }
    if last < 1.0 {
        slopes[values.len() - 1] = 0.0;
    }
    let flat = |start: f64, end: f64, value: f64| Cubic {
        start,
        inverse: 1.0 / (end - start),
        coefficients: [value, 0.0, 0.0, 0.0],
    };
    let mut result = Vec::with_capacity(places.len() + 1);
    if first > 0.0 {
        result.push(flat(0.0, first, low));
    }
    for i in 1..places.len() {
        let width = places[i] - places[i - 1];
        let (from, rise) = (values[i - 1], values[i] - values[i - 1]);
        let coefficients = if smooth {
            hermite(from, rise, slopes[i - 1] * width, slopes[i] * width)
        } else {
            [from, rise, 0.0, 0.0]
        };
        result.push(Cubic { start: places[i - 1], inverse: 1.0 / width, coefficients });
    }
    if last < 1.0 {
        result.push(flat(last, 1.0, high));
    }
    if result.is_empty() {
        result.push(flat(0.0, 1.0, low));
    }
    result
}

fn hermite(from: f64, rise: f64, start: f64, end: f64) -> [f64; 4] {
    [from, start, 3.0 * rise - 2.0 * start - end, start + end - 2.0 * rise]
}

/// Slopes of smooth curves through values at given places, ascending.
///
/// By the limiter M3-A of Huynh (1993): third order even at a smooth extremum, so that a parabola is kept exactly, and monotone
/// where the values are.
#[derive(Debug)]
pub(super) struct Slopes<'p> {
    places: &'p [f64],
    /// Of the values last seen: first divided differences, second ones around the inner places, and slopes.
    secants: Vec<f64>,
    seconds: Vec<f64>,
    result: Vec<f64>,
}

impl<'p> Slopes<'p> {
    pub(super) fn new(places: &'p [f64]) -> Self {
        Self { places, secants: Vec::new(), seconds: Vec::new(), result: Vec::new() }
    }

    /// The slopes at the places of so many curves at once: rows of values in, a row for each place, and rows of slopes out.
    pub(super) fn through(&mut self, values: &[f64], curves: usize) -> &[f64] {
        let Self { places, secants, seconds, result: slopes } = self;
        let count = places.len().min(values.len() / curves.max(1));
        slopes.clear();
        slopes.resize(count * curves, 0.0);
        if count < 2 {
            return slopes;
        }
        let row = |i: usize| i * curves..(i + 1) * curves;
        divide(secants, values, curves, |i| places[i + 1] - places[i]);
        if count == 2 {
            slopes[row(0)].copy_from_slice(secants);
            slopes[row(1)].copy_from_slice(secants);
            return slopes;
        }
        divide(seconds, secants, curves, |i| places[i + 2] - places[i]);
        // Around place i, beyond the ends the nearest one.
        let second = |i: usize| &seconds[row(i.clamp(1, count - 2) - 1)];
        for i in 1..count - 1 {
            let (back, forth) = (places[i] - places[i - 1], places[i] - places[i + 1]);
            let (before, after) = (&secants[row(i - 1)], &secants[row(i)]);
            let (low, here, high) = (second(i - 1), second(i), second(i + 1));
            // Nothing beyond the outermost values says that they belong to a smooth extremum.
            let (first, last) = (i == 1, i == count - 2);
            for (k, slope) in slopes[row(i)].iter_mut().enumerate() {
                let left = before[k] + minmod(low[k], here[k]) * back;
                let right = after[k] + minmod(here[k], high[k]) * forth;
                let limit = 3.0 * minmod(before[k], after[k]).abs();
                let wide = minmod(left, right);
                let size = (0.5 * (left + right)).abs().min(limit.max(1.5 * wide.abs()));
                let inner = if wide == 0.0 { 0.0 } else { size.copysign(wide) };
                let inner = if first { minmod(inner, 3.0 * before[k]) } else { inner };
                *slope = if last { minmod(inner, 3.0 * after[k]) } else { inner };
            }
        }
        let mut end = |at: usize, step: f64| {
            let (secants, seconds) = (&secants[row(at.min(count - 2))], second(at));
            for (k, slope) in slopes[row(at)].iter_mut().enumerate() {
                *slope = minmod(secants[k] + seconds[k] * step, 3.0 * secants[k]);
            }
        };
        end(0, places[0] - places[1]);
        end(count - 1, places[count - 1] - places[count - 2]);
        slopes
    }
}

/// Differences of neighboring rows of values, divided by a number for each two rows.
fn divide(out: &mut Vec<f64>, values: &[f64], width: usize, by: impl Fn(usize) -> f64) {
    out.clear();
    for (i, (row, next)) in values.chunks_exact(width).zip(values.chunks_exact(width).skip(1)).enumerate() {
        let by = by(i);
        out.extend(row.iter().zip(next).map(|(value, next)| (next - value) / by));
    }
}

/// Slopes of squares of sizes, eased where these would come close to zero between values that do not; between two of them that of
/// the square of a straight line, where it is a square and not of a point.
fn keep_above(places: &[f64], values: &[f64], slopes: &mut [f64]) {
    if let (&[start, end], &[low, high]) = (places, values) {
        if low > 0.0 && high > 0.0 {
            let roots = [low.sqrt(), high.sqrt()];
            let slope = 2.0 * (roots[1] - roots[0]) / (end - start);
            slopes.copy_from_slice(&roots.map(|root| root * slope));
        }
        return;
    }
    for i in 0..values.len().saturating_sub(1) {
        let (width, rise) = (places[i + 1] - places[i], values[i + 1] - values[i]);
        let floor = 0.5 * values[i].min(values[i + 1]);
        let [a, b, c, d] = hermite(values[i], rise, slopes[i] * width, slopes[i + 1] * width);
        let low = (1..32).map(|k| f64::from(k) / 32.0).any(|t| a + t * (b + t * (c + t * d)) < floor);
        if low {
            let secant = rise / width;
            slopes[i] = minmod(slopes[i], 3.0 * secant);
            slopes[i + 1] = minmod(slopes[i + 1], 3.0 * secant);
        }
    }
}

/// The smaller of two numbers of one sign, otherwise 0.
#[inline]
fn minmod(a: f64, b: f64) -> f64 {
    let least = if a.abs() < b.abs() { a } else { b };
    if a * b <= 0.0 { 0.0 } else { least }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(cubics: &[Cubic], x: f64) -> f64 {
        let cubic = cubics.iter().rev().find(|cubic| cubic.start <= x).unwrap();
        let t = (x - cubic.start) * cubic.inverse;
        let [a, b, c, d] = cubic.coefficients;
        a + t * (b + t * (c + t * d))
    }

    #[test]
    fn rising_values_give_a_rising_curve() {
        let mut seed = 1_u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1 << 24)
        };
        for round in 0..2000 {
            let (mut places, mut values) = (vec![0.0], vec![random() + 0.01]);
            for _ in 0..2 + round % 9 {
                places.push(places[places.len() - 1] + 0.01 + random());
                let step = random();
                // Cliffs and flats too.
                values.push(values[values.len() - 1] + if step < 0.3 { 0.0 } else { step.powi(6) * 100.0 });
            }
            let last = places[places.len() - 1];
            for place in &mut places {
                *place /= last;
            }
            let cubics = cubics(&places, &values, true, true);
            let mut before = values[0];
            for k in 0..=500 {
                let now = value(&cubics, f64::from(k) / 500.0);
                assert!(now >= before - 1e-9 * values[values.len() - 1], "{places:?} {values:?} {k}");
                before = now;
            }
        }
    }

    #[test]
    fn a_parabola_and_a_cone_are_kept() {
        let places = [0.0, 0.1, 0.35, 0.5, 0.9, 1.0];
        let values = places.map(|x| x * (1.0 - x));
        let curve = cubics(&places, &values, true, true);
        let cone = cubics(&[0.0, 1.0], &[4.0, 81.0], true, true);
        for k in 0..=100 {
            let x = f64::from(k) / 100.0;
            assert!((value(&curve, x) - x * (1.0 - x)).abs() < 1e-12, "{x}");
            assert!((value(&cone, x) - (2.0 + 7.0 * x) * (2.0 + 7.0 * x)).abs() < 1e-12, "{x}");
        }
    }

    #[test]
    fn curves_side_by_side_are_as_each_by_itself() {
        let places = [0.0, 0.1, 0.35, 0.5, 0.9, 1.0];
        for count in 1..=places.len() {
            let places = &places[..count];
            let value = |place: usize, curve: usize| ((7 * place * place + 5 * curve) % 11) as f64 - 4.0;
            let rows: Vec<f64> =
                (0..count).flat_map(|place| (0..9).map(move |curve| value(place, curve))).collect();
            let all = Slopes::new(places).through(&rows, 9).to_vec();
            for curve in 0..9 {
                let values: Vec<f64> = (0..count).map(|place| value(place, curve)).collect();
                let own: Vec<f64> = all.iter().skip(curve).step_by(9).copied().collect();
                assert_eq!(Slopes::new(places).through(&values, 1), own, "{values:?}");
            }
        }
    }
}
