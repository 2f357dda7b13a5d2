//! Balls in a row that hold a tube: enough to tell that most tubes lie apart.

use super::solid::{Known, Solid};
use glam::DVec3;

/// Share of the distance of two neighboring points, beyond each, that the balls have for what lies between.
const BETWEEN: f64 = 0.6;

/// A ball for each of some rings that lie evenly along a tube: together they hold it.
#[derive(Clone, Debug)]
pub(crate) struct Beads {
    balls: Vec<Ball>,
}

#[derive(Clone, Copy, Debug)]
struct Ball {
    center: DVec3,
    radius: f64,
}

impl Beads {
    /// By points around a tube, `around` of them at each place, evenly from u = 0 to u = 1.
    pub(crate) fn new(points: &[DVec3], around: usize) -> Self {
        let rings: Vec<&[DVec3]> = points.chunks_exact(around.max(1)).collect();
        let ball = |(index, ring): (usize, &&[DVec3])| {
            let center = ring.iter().sum::<DVec3>() / ring.len() as f64;
            let turned = ring.iter().skip(1).chain(ring.first());
            let mut gap = ring.iter().zip(turned).map(|(a, b)| a.distance_squared(*b)).fold(0.0, f64::max);
            let beside = [index.checked_sub(1), Some(index + 1)];
            for other in beside.into_iter().flatten().filter_map(|other| rings.get(other)) {
                let steps = ring.iter().zip(*other).map(|(a, b)| a.distance_squared(*b));
                gap = steps.fold(gap, f64::max);
            }
            let reach = ring.iter().map(|point| point.distance_squared(center)).fold(0.0, f64::max).sqrt();
            Ball { center, radius: reach + BETWEEN * gap.sqrt() }
        };
        Self { balls: rings.iter().enumerate().map(ball).collect() }
    }

    /// Those of the tube from `u` on; `None` where it begins before its first ball.
    pub(crate) fn from(mut self, u: f64) -> Option<Self> {
        self.balls.drain(..place(u, self.balls.len()) as usize);
        (u >= 0.0).then_some(self)
    }

    /// False when the tubes certainly lie apart.
    pub(crate) fn meet(&self, other: &Self) -> bool {
        let [one, all] = [self, other].map(Self::around);
        let touch = |a: &Ball, b: &Ball| {
            let reach = a.radius + b.radius;
            a.center.distance_squared(b.center) <= reach * reach
        };
        let near = self.balls.iter().filter(|ball| touch(ball, &all));
        let others: Vec<&Ball> = other.balls.iter().filter(|ball| touch(ball, &one)).collect();
        near.into_iter().any(|ball| others.iter().any(|other| touch(ball, other)))
    }

    /// A ball around all.
    fn around(&self) -> Ball {
        let center =
            self.balls.iter().map(|ball| ball.center).sum::<DVec3>() / self.balls.len().max(1) as f64;
        let reach = self.balls.iter().map(|ball| ball.center.distance(center) + ball.radius);
        Ball { center, radius: reach.fold(0.0, f64::max) }
    }

    /// Which balls lie outside of a body.
    pub(crate) fn outside(&self, body: &Solid<'_>) -> Outside {
        let mut known = Known::default();
        Outside(self.balls.iter().map(|ball| body.avoids(ball.center, ball.radius, &mut known)).collect())
    }
}

/// The place of one of so many balls, or between two, at `u`.
fn place(u: f64, count: usize) -> f64 {
    u.clamp(0.0, 1.0) * count.saturating_sub(1) as f64
}

/// Which parts of a tube lie outside of a body.
#[derive(Debug)]
pub(crate) struct Outside(Vec<bool>);

impl Outside {
    /// True when all between two places certainly does.
    pub(crate) fn between(&self, low: f64, high: f64) -> bool {
        let [low_place, high_place] = [low, high].map(|u| place(u, self.0.len()));
        let (first, last) = (low_place.floor() as usize, high_place.ceil() as usize);
        low >= 0.0 && self.0.get(first..=last).is_some_and(|part| part.iter().all(|clear| *clear))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::analytic::Cylinder;
    use crate::shape::{End, ParametricSurface};

    #[test]
    fn beads_tell_what_lies_apart() {
        let tube = Cylinder { radius: 5.0, length: 60.0 };
        let beads_of = |turn: fn(DVec3) -> DVec3, shift: DVec3| {
            let at = |i: u32, k: u32| turn(tube.point(f64::from(i) / 40.0, f64::from(k) / 24.0)) + shift;
            let points: Vec<DVec3> = (0..=40).flat_map(|i| (0..24).map(move |k| at(i, k))).collect();
            Beads::new(&points, 24)
        };
        let beads = |shift: DVec3| beads_of(|point| point, shift);
        let here = beads(DVec3::ZERO);
        assert!(here.meet(&beads(DVec3::X * 9.9)), "they cross");
        assert!(!here.meet(&beads(DVec3::X * 13.5)), "they do not");
        // Cut off above 30 mm, it is out of the way of one that ends below.
        let below = beads(DVec3::new(3.0, 0.0, -40.0));
        assert!(here.meet(&below) && here.clone().from(0.75).is_some_and(|rest| !rest.meet(&below)));
        let body = Solid::new(&tube, [End::Closed; 2]);
        // Out of its side.
        let outside = beads_of(|point| DVec3::new(point.z, point.x, point.y), DVec3::Z * 30.0).outside(&body);
        assert!(outside.between(0.6, 1.0) && !outside.between(0.1, 1.0));
    }
}
