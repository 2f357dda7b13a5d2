//! Lengths and areas of surfaces by quadrature.

use super::bezier::integrate;
use super::{Jet, ParametricSurface};
use std::ops::Range;

/// Length of the closed line at `u`, in mm, from `samples` derivatives: exact to rounding for smooth lines and few samples.
pub fn girth<S: ParametricSurface + ?Sized>(surface: &S, u: f64, samples: u32) -> f64 {
    let mut jets = vec![Jet::default(); samples.max(1) as usize];
    surface.ring(u, 0.0, &mut jets);
    jets.iter().map(|jet| jet.dv.length()).sum::<f64>() / jets.len() as f64
}

/// Length of the line at `v` over a range of u, in mm, by 5-point quadrature on `steps` equal parts.
pub fn length_along<S: ParametricSurface + ?Sized>(
    surface: &S,
    v: f64,
    range: Range<f64>,
    steps: u32,
) -> f64 {
    let steps = steps.max(1);
    let at = |k: u32| range.start + (range.end - range.start) * f64::from(k) / f64::from(steps);
    (0..steps).map(|k| integrate(at(k), at(k + 1), |u| surface.jet(u, v).du.length())).sum()
}

/// Area over u in [0, 1], in mm^2, by 5-point quadrature on `steps` parts of u and `samples` of v.
pub fn area<S: ParametricSurface + ?Sized>(surface: &S, steps: u32, samples: u32) -> f64 {
    (0..steps.max(1)).map(|k| area_of(surface, k, steps, samples)).sum()
}

/// The same of one of the parts of u.
pub(super) fn area_of<S: ParametricSurface + ?Sized>(
    surface: &S,
    part: u32,
    steps: u32,
    samples: u32,
) -> f64 {
    let mut jets = vec![Jet::default(); samples.max(1) as usize];
    let mut ring = |u: f64| {
        surface.ring(u, 0.0, &mut jets);
        jets.iter().map(|jet| jet.du.cross(jet.dv).length()).sum::<f64>() / jets.len() as f64
    };
    let at = |k: u32| f64::from(k) / f64::from(steps.max(1));
    integrate(at(part), at(part + 1), &mut ring)
}

/// Whether the surface looks the same all around: the metric does not depend on v (to 1e-7 of itself, at 16 x 16
/// places) and the lines of u and v cross at right angles.
pub fn is_revolution<S: ParametricSurface + ?Sized>(surface: &S) -> bool {
    const SAMPLES: u32 = 16;
    const TOLERANCE: f64 = 1e-7;
    let mut ring = [Jet::default(); SAMPLES as usize];
    (0..SAMPLES).all(|i| {
        surface.ring((f64::from(i) + 0.5) / f64::from(SAMPLES), 0.0, &mut ring);
        let metric = |jet: &Jet| (jet.du.length_squared(), jet.du.dot(jet.dv), jet.dv.length_squared());
        let (e0, _, g0) = metric(&ring[0]);
        ring.iter().map(metric).all(|(e, f, g)| {
            (e - e0).abs() <= TOLERANCE * e0
                && (g - g0).abs() <= TOLERANCE * g0
                && f.abs() <= TOLERANCE * (e * g).sqrt()
        })
    })
}

/// Distance of neighboring rows for one unit of u: the part of `du` across the row.
#[inline]
pub(crate) fn row_speed(jet: &Jet) -> f64 {
    let around = jet.dv.length_squared();
    if around < 1e-24 {
        return jet.du.length();
    }
    let along = jet.du.dot(jet.dv);
    (jet.du.length_squared() - along * along / around).max(0.0).sqrt()
}

/// Sides of a tube of which one is the slowest, and places along it at which that is measured.
const SIDES: usize = 48;
const STATIONS: u32 = 16;

/// The side of a tube on which rows lie closest, in turns; the first of those that are alike. Found `between` the sides that are
/// looked at, it does not depend on where these begin.
pub(crate) fn slowest_side<S: ParametricSurface + ?Sized>(surface: &S, between: bool) -> f64 {
    let mut speeds = [0.0; SIDES];
    let mut ring = [Jet::default(); SIDES];
    for station in 0..STATIONS {
        surface.ring((f64::from(station) + 0.5) / f64::from(STATIONS), 0.0, &mut ring);
        for (sum, jet) in speeds.iter_mut().zip(&ring) {
            *sum += row_speed(jet);
        }
    }
    let (mut best, mut least) = (0, f64::MAX);
    for (side, speed) in speeds.into_iter().enumerate() {
        if speed < least - 1e-6 * speed {
            (best, least) = (side, speed);
        }
    }
    // The parabola through the sides beside it.
    let [low, here, high] = [SIDES - 1, 0, 1].map(|off| speeds[(best + off) % SIDES]);
    let bend = low - 2.0 * here + high;
    let off = if between && bend > 0.0 { (0.5 * (low - high) / bend).clamp(-0.5, 0.5) } else { 0.0 };
    (best as f64 + off) / SIDES as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::analytic::{Cylinder, TorusArc};
    use crate::shape::{End, Ring, Stack};
    use glam::DVec3;

    #[test]
    fn rows_lie_closest_on_the_inner_side_of_a_bend() {
        let bend = TorusArc { major: 60.0, minor: 20.0, angle: 1.5 };
        let speed = |v: f64| row_speed(&bend.jet(0.5, v));
        let least = (0..960).map(|k| speed(f64::from(k) / 960.0)).fold(f64::MAX, f64::min);
        for between in [false, true] {
            let side = slowest_side(&bend, between);
            assert!(speed(side) < least * 1.0001, "{side}");
        }
        // A stack of the same tube, begun anywhere, has that side at the same place.
        for begin in [0.0, 0.003, 0.2511, 0.7] {
            let ring = |k: u32| {
                let point = |j: u32| bend.point(f64::from(k) / 16.0, f64::from(j) / 96.0 + begin);
                Ring::new((0..96).map(point).collect::<Vec<DVec3>>()).unwrap()
            };
            let stack = Stack::new(&(0..=16).map(ring).collect::<Vec<_>>(), [None; 2], 64).unwrap();
            assert_eq!(stack.ends(), [End::Open; 2]);
            let (found, there) =
                (stack.point(0.5, stack.slowest_side()), bend.point(0.5, slowest_side(&bend, true)));
            assert!(found.distance(there) < 0.1, "{begin}: {found} {there}");
        }
        assert_eq!(slowest_side(&Cylinder { radius: 5.0, length: 20.0 }, true), 0.0);
    }
}
