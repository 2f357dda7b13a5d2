//! Closed lines through points: even samples by arc length, and the phase that turns one least against another.

use glam::DVec3;

/// The phase of samples is found to within this share of their distance.
const NEAR: f64 = 0.01;
/// Samples by which the phase is found where the number of all is a multiple of it.
const FEW: usize = 32;
/// Places around a ring at which it is first compared with another one.
const WIDE: usize = 10;

/// A closed polyline with the lengths along it.
#[derive(Clone, Debug)]
pub struct Ring {
    points: Vec<DVec3>,
    /// Length up to each point, and in the end the whole.
    lengths: Vec<f64>,
}

impl Ring {
    /// The closed line through points; `None` for fewer than three distinct ones, or numbers that are not finite.
    pub fn new(mut points: Vec<DVec3>) -> Option<Self> {
        points.dedup();
        while points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        if points.len() < 3 {
            return None;
        }
        let mut lengths = Vec::with_capacity(points.len() + 1);
        let mut total = 0.0;
        for (point, next) in points.iter().zip(points.iter().skip(1).chain(points.first())) {
            lengths.push(total);
            total += point.distance(*next);
        }
        lengths.push(total);
        (total.is_finite() && total > 0.0).then_some(Self { points, lengths })
    }

    /// Its length.
    pub fn length(&self) -> f64 {
        self.lengths[self.points.len()]
    }

    /// The points.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Middle of the line, by length.
    pub fn center(&self) -> DVec3 {
        let edges = self.points.iter().zip(self.points.iter().skip(1).chain(self.points.first()));
        let lengths = self.lengths.windows(2).map(|pair| pair[1] - pair[0]);
        let sum: DVec3 = edges.zip(lengths).map(|((a, b), length)| 0.5 * (*a + *b) * length).sum();
        sum / self.length()
    }

    /// The area that the line encloses as a vector; its direction is the normal for which it runs counterclockwise.
    pub fn area(&self) -> DVec3 {
        let (count, first) = (self.points.len(), self.points[0]);
        let arm = |i: usize| self.points[i % count] - first;
        (0..count).map(|i| 0.5 * arm(i).cross(arm(i + 1))).sum()
    }

    /// The same line run through the other way.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let mut points = self.points.clone();
        points.reverse();
        let last = self.points.len() - 1;
        let mut lengths: Vec<f64> =
            self.lengths[..=last].iter().rev().map(|length| self.lengths[last] - length).collect();
        lengths.push(self.length());
        Self { points, lengths }
    }

    /// The same line begun at the point on it that is nearest to `near`.
    #[must_use]
    pub fn begun_near(&self, near: DVec3) -> Self {
        let count = self.points.len();
        let mut best = (f64::INFINITY, 0, self.points[0]);
        for i in 0..count {
            let (a, b) = (self.points[i], self.points[(i + 1) % count]);
            let t = ((near - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            let foot = a.lerp(b, t);
            if foot.distance(near) < best.0 {
                best = (foot.distance(near), i, foot);
            }
        }
        let mut points = vec![best.2];
        points.extend((1..=count).map(|k| self.points[(best.1 + k) % count]));
        Self::new(points).unwrap_or_else(|| self.clone())
    }

    /// `count` points evenly spread along the line, the first at `phase` (in turns).
    pub fn samples(&self, count: usize, phase: f64) -> Vec<DVec3> {
        let total = self.length();
        let begin = phase - phase.floor();
        let mut i =
            self.lengths.partition_point(|length| *length <= begin * total).clamp(1, self.points.len()) - 1;
        let (first, step) = (begin * total, total / count as f64);
        let end = |i: usize| self.points.get(i + 1).or(self.points.first()).copied().unwrap_or_default();
        let stretch = |i: usize| {
            let span = self.lengths[i + 1] - self.lengths[i];
            (if span > 0.0 { 1.0 / span } else { 0.0 }, self.points[i], end(i) - self.points[i])
        };
        let (mut per, mut from, mut way) = stretch(i);
        let mut samples = Vec::with_capacity(count);
        let mut lap = 0.0;
        for k in 0..count {
            let mut target = first + k as f64 * step - lap;
            let before = i;
            if target >= total {
                (target, lap, i) = (target - total, lap + total, 0);
            }
            while i + 1 < self.points.len() && self.lengths[i + 1] <= target {
                i += 1;
            }
            if i != before {
                (per, from, way) = stretch(i);
            }
            let t = ((target - self.lengths[i]) * per).clamp(0.0, 1.0);
            samples.push(from + way * t);
        }
        samples
    }

    /// Even samples turned least against those of the ring before: the phase minimizes the sum of squared distances.
    pub fn beside(&self, before: &[DVec3]) -> Vec<DVec3> {
        self.turned(before).1
    }

    /// The same with the phase.
    pub(crate) fn turned(&self, before: &[DVec3]) -> (f64, Vec<DVec3>) {
        let count = before.len();
        // A few samples tell the phase.
        let stride = if count.is_multiple_of(FEW) { count / FEW } else { 1 };
        let before: Vec<DVec3> = before.iter().copied().step_by(stride.max(1)).collect();
        let few = before.len();
        let mut samples = self.samples(few, 0.0);
        let skip = (few / FEW).max(1);
        let cost = |shift: usize| -> f64 {
            let (mut sum, mut at) = (0.0, shift);
            for point in before.iter().step_by(skip) {
                sum += point.distance_squared(samples[at]);
                at += skip;
                if at >= few {
                    at -= few;
                }
            }
            sum
        };
        let mut best = (f64::INFINITY, 0);
        let mut look = |shift: usize| {
            let cost = cost(shift);
            if cost < best.0 * (1.0 - 1e-9) {
                best = (cost, shift);
            }
            best.1
        };
        // The cost changes slowly: first in wide steps, then around the best.
        let wide = (few / WIDE).max(skip) / skip * skip;
        let rough_best = (0..few).step_by(wide).fold(0, |_, shift| look(shift));
        for step in (skip..wide).step_by(skip) {
            look((rough_best + step) % few);
            look((rough_best + few - step) % few);
        }
        let mut phase = best.1 as f64 / few as f64;
        samples.rotate_left(best.1);
        let mut moved = false;
        // Newton steps: the derivative of a sample by the phase is the tangent there.
        for _ in 0..3 {
            let (mut slope, mut bend) = (0.0, 0.0);
            let after = samples.iter().skip(1).chain(samples.first());
            let last = samples.last().into_iter().chain(&samples);
            for (((sample, before), after), last) in samples.iter().zip(&before).zip(after).zip(last) {
                let tangent = *after - *last;
                slope += (*sample - *before).dot(tangent);
                bend += tangent.length_squared();
            }
            // The tangents are those of two samples' way.
            let step = if bend > 0.0 { slope / (bend * 0.5 * few as f64) } else { 0.0 };
            // Equal rings differ by rounding only: they stay as they are.
            if step.abs() < 1e-9 {
                break;
            }
            phase -= step.clamp(-0.5 / few as f64, 0.5 / few as f64);
            moved = true;
            if step.abs() * (count as f64) < NEAR {
                break;
            }
            samples = self.samples(few, phase);
        }
        let same = !moved && few == count;
        (phase, if same { samples } else { self.samples(count, phase) })
    }
}

/// Mean and greatest distance of samples.
pub(crate) fn gap(a: &[DVec3], b: &[DVec3]) -> (f64, f64) {
    let (mut sum, mut most) = (0.0, 0.0_f64);
    for (a, b) in a.iter().zip(b) {
        let distance = a.distance(*b);
        sum += distance;
        most = most.max(distance);
    }
    (sum / a.len().max(1) as f64, most)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math;

    fn circle(turn: f64, count: u32) -> Ring {
        let at = |k: u32| {
            let (sin, cos) = math::sin_cos(math::TAU * (f64::from(k) / f64::from(count) + turn));
            DVec3::new(cos, sin, 0.0)
        };
        Ring::new((0..count).map(at).collect()).unwrap()
    }

    #[test]
    fn samples_are_even_and_the_phase_is_found() {
        let before = circle(0.0, 256).samples(64, 0.0);
        for turn in [0.0, 0.013, 0.3, 0.77] {
            let turned = circle(turn, 200).beside(&before);
            assert!(gap(&turned, &before).1 < 2e-3, "{turn}: {:?}", gap(&turned, &before));
        }
    }

    #[test]
    fn a_phase_serves_any_number_of_samples() {
        let before = circle(0.0, 256).samples(32, 0.0);
        let (phase, few) = circle(0.3, 200).turned(&before);
        let many = circle(0.3, 200).samples(96, phase);
        assert!(few.iter().zip(many.iter().step_by(3)).all(|(a, b)| a.distance(*b) < 1e-12));
    }

    #[test]
    fn reversing_keeps_the_line() {
        let ring =
            Ring::new([[0., 0.], [4., 0.], [4., 1.], [0., 2.]].map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec())
                .unwrap();
        let back = ring.reversed();
        assert!((back.length() - ring.length()).abs() < 1e-12);
        assert!((back.area() + ring.area()).length() < 1e-12);
        let fresh = Ring::new(back.points.clone()).unwrap();
        assert_eq!(format!("{:.9?}", back.lengths), format!("{:.9?}", fresh.lengths));
    }
}
