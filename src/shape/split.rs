//! Where a tube divides into two: the loop at its end, shared between them, with a crotch across.

use super::ring::Ring;
use glam::DVec3;

/// Samples of the loop that divides, and of the loops that it divides into.
const AROUND: usize = 256;
const TOWARD: usize = 64;
/// Least share of the loop that either takes.
const LEAST: f64 = 0.15;
/// How far (share of the loop) an end of the crotch may move to where the loop is narrow, and what a step costs against
/// the width that it saves.
const WINDOW: f64 = 0.08;
const STEP_PRICE: f64 = 0.25;

/// A loop that two tubes share.
#[derive(Clone, Debug)]
pub(crate) struct Shares {
    /// The loop that each begins with: its stretch of the loop that divides, closed by a straight line. It begins where
    /// that stretch does, and runs the same way.
    pub(crate) rims: [Ring; 2],
    /// Length of the straight line.
    pub(crate) crotch: f64,
}

/// Shares a loop between two others that run the same way: each gets the stretch next to it. `None` when one of them
/// gets next to nothing.
pub(crate) fn share(last: &Ring, toward: [&Ring; 2]) -> Option<Shares> {
    let points = last.samples(AROUND, 0.0);
    let others = toward.map(|ring| ring.samples(TOWARD, 0.0));
    let near = |p: DVec3, line: &[DVec3]| {
        line.iter().map(|q| q.distance_squared(p)).fold(f64::INFINITY, f64::min).sqrt()
    };
    let lead: Vec<f64> = points.iter().map(|p| near(*p, &others[1]) - near(*p, &others[0])).collect();
    let (first, count) = crate::math::stretch(&lead);
    let least = (LEAST * AROUND as f64) as usize;
    if count < least || AROUND - count < least {
        return None;
    }
    // Both ends of the crotch move to where it is short.
    let window = (WINDOW * AROUND as f64) as isize;
    let pace = last.length() / AROUND as f64;
    let at = |i: isize| points[i.rem_euclid(AROUND as isize) as usize];
    let (a, b) = (first as isize, (first + count) as isize);
    let mut best = (f64::INFINITY, a, b);
    for i in a - window..=a + window {
        for j in b - window..=b + window {
            let moved = ((i - a).abs() + (j - b).abs()) as f64 * pace;
            let cost = at(i).distance(at(j)) + STEP_PRICE * moved;
            if cost < best.0 - 1e-9 {
                best = (cost, i, j);
            }
        }
    }
    let (_, a, b) = best;
    let line = |from: isize, to: isize| Ring::new((from..=to).map(at).collect());
    let rims = [line(a, b)?, line(b, a + AROUND as isize)?];
    Some(Shares { rims, crotch: at(a).distance(at(b)) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{TAU, cos, sin};

    fn oval(center: DVec3, a: f64, b: f64) -> Ring {
        let at = |k: u32| -TAU * f64::from(k) / 300.0;
        Ring::new((0..300).map(|k| center + DVec3::new(a * cos(at(k)), b * sin(at(k)), 0.0)).collect())
            .unwrap()
    }

    #[test]
    fn an_oval_is_halved_between_two_legs() {
        let (body, left, right) = (
            oval(DVec3::ZERO, 20.0, 8.0),
            oval(DVec3::new(-10.0, 0.0, 6.0), 8.0, 8.0),
            oval(DVec3::new(10.0, 0.0, 6.0), 8.0, 8.0),
        );
        let shares = share(&body, [&left, &right]).unwrap();
        assert!((shares.crotch - 16.0).abs() < 0.5, "{}", shares.crotch);
        for rim in &shares.rims {
            assert!((rim.length() - (body.length() / 2.0 + 16.0)).abs() < 1.0, "{}", rim.length());
            assert!(rim.area().dot(body.area()) > 0.0);
        }
        assert!(shares.rims[0].center().x < -5.0 && shares.rims[1].center().x > 5.0);
        assert!(share(&body, [&left, &left]).is_none());
    }
}
