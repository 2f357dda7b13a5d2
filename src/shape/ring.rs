//! Closed lines through points: even samples by arc length, and the phase that turns one least against another.

use glam::DVec3;

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
        for (i, point) in points.iter().enumerate() {
            lengths.push(total);
            total += point.distance(points[(i + 1) % points.len()]);
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
        let count = self.points.len();
        let sum: DVec3 = (0..count)
            .map(|i| {
                let (a, b) = (self.points[i], self.points[(i + 1) % count]);
                0.5 * (a + b) * (self.lengths[i + 1] - self.lengths[i])
            })
            .sum();
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
        let mut samples = Vec::with_capacity(count);
        let mut lap = 0.0;
        for k in 0..count {
            let mut target = (begin + k as f64 / count as f64) * total - lap;
            if target >= total {
                (target, lap, i) = (target - total, lap + total, 0);
            }
            while i + 1 < self.points.len() && self.lengths[i + 1] <= target {
                i += 1;
            }
            let span = self.lengths[i + 1] - self.lengths[i];
            let t = if span > 0.0 { ((target - self.lengths[i]) / span).clamp(0.0, 1.0) } else { 0.0 };
            samples.push(self.points[i].lerp(self.points[(i + 1) % self.points.len()], t));
        }
        samples
    }

    /// Even samples turned least against those of the ring before: the phase minimizes the sum of squared distances.
    pub fn beside(&self, before: &[DVec3]) -> Vec<DVec3> {
        let count = before.len();
        let rough = self.samples(count, 0.0);
        let stride = (count / 32).max(1);
        let cost = |shift: usize| -> f64 {
            (0..count).step_by(stride).map(|i| before[i].distance_squared(rough[(i + shift) % count])).sum()
        };
        let mut best = (f64::INFINITY, 0);
        for shift in (0..count).step_by(stride) {
            let cost = cost(shift);
            if cost < best.0 * (1.0 - 1e-9) {
                best = (cost, shift);
            }
        }
        let mut phase = best.1 as f64 / count as f64;
        let mut samples = if best.1 == 0 { rough } else { self.samples(count, phase) };
        // Newton steps: the derivative of a sample by the phase is the tangent there.
        for _ in 0..3 {
            let (mut slope, mut bend) = (0.0, 0.0);
            for i in 0..count {
                let tangent =
                    (samples[(i + 1) % count] - samples[(i + count - 1) % count]) * (0.5 * count as f64);
                slope += (samples[i] - before[i]).dot(tangent);
                bend += tangent.length_squared();
            }
            let step = if bend > 0.0 { slope / bend } else { 0.0 };
            // Equal rings differ by rounding only: they stay as they are.
            if step.abs() < 1e-9 {
                break;
            }
            phase -= step.clamp(-0.5 / count as f64, 0.5 / count as f64);
            samples = self.samples(count, phase);
        }
        samples
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
