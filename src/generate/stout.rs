//! A surface no thinner than a tube of a few stitches: where it is, it is widened about its middle.
//!
//! Rounds of one or two stitches are no tube, and five are the fewest that a person works without trouble. So the tip of a
//! spike, a very thin neck, and all of a tube that is thin as a cord come out as thick as the yarn makes them.

use crate::ir::Gauge;
use crate::shape::{Jet, ParametricSurface, girth};
use glam::DVec3;

/// Fewest loops of a round.
pub(super) const LEAST_LOOPS: usize = 5;
/// Girth of a round of so few, in stitch widths.
const LEAST_GIRTH: f64 = LEAST_LOOPS as f64;
/// Places along the tube, and looks around it.
const PLACES: usize = 256;
const LOOKS: u32 = 12;
/// Places at which one that is nowhere near as thin is told.
const FEW_PLACES: u32 = 16;
/// What is wider by less than this, or over fewer rows, no one sees.
const SEEN: f64 = 1.1;
const SEEN_ROWS: f64 = 3.0;
/// Places this near a pole are as thick as the next: every tip is thin, and closes with a ring. In stitch heights.
const POLE: f64 = 0.75;

/// The middle of a section, and by how much it is widened.
#[derive(Clone, Copy, Debug)]
struct Place {
    middle: DVec3,
    scale: f64,
}

/// A surface, widened where it is too thin.
#[derive(Debug)]
pub(super) struct Stout<'s> {
    surface: &'s dyn ParametricSurface,
    /// At even steps of u from 0 to 1.
    places: Vec<Place>,
}

impl<'s> Stout<'s> {
    /// The surface widened; `None` where it is thick enough as it is, or has no size at all. Its least girth (mm) away from
    /// the poles saves most looks where it is known.
    pub(super) fn new(
        surface: &'s dyn ParametricSurface,
        thinnest: Option<f64>,
        gauge: &Gauge,
    ) -> Option<Self> {
        let least = LEAST_GIRTH * gauge.width;
        let thick = |u: f64| girth(surface, u, LOOKS) >= 2.0 * least;
        let is_thick = || (1..FEW_PLACES).all(|k| thick(f64::from(k) / f64::from(FEW_PLACES)));
        if thinnest.map_or_else(is_thick, |girth| girth >= least) {
            return None;
        }
        let ends = [0.0, 1.0].map(|u| surface.point(u, 0.0));
        let mut ring = [Jet::default(); LOOKS as usize];
        let place = |k: usize| {
            surface.ring(k as f64 / PLACES as f64, 0.0, &mut ring);
            let middle = ring.iter().map(|jet| jet.point).sum::<DVec3>() / f64::from(LOOKS);
            let around = ring.iter().map(|jet| jet.dv.length()).sum::<f64>() / f64::from(LOOKS);
            let near = ends.map(|end| middle.distance(end)).into_iter().fold(f64::INFINITY, f64::min);
            let pole = around < least && near < POLE * gauge.height;
            let scale = (least / around).max(1.0);
            (Place { middle, scale }, !pole && scale.is_finite())
        };
        let mut places: Vec<(Place, bool)> = (0..=PLACES).map(place).collect();
        if !places.iter().any(|(place, known)| *known && place.scale > 1.0) {
            return None;
        }
        // Poles take over the scale of what is next to them.
        for reverse in [false, true] {
            let mut last = None;
            let mut take = |(place, known): &mut (Place, bool)| match last {
                Some(scale) if !*known => (place.scale, *known) = (scale, true),
                _ if *known => last = Some(place.scale),
                _ => {}
            };
            if reverse {
                places.iter_mut().rev().for_each(&mut take);
            } else {
                places.iter_mut().for_each(&mut take);
            }
        }
        Some(Self { surface, places: places.into_iter().map(|(place, _)| place).collect() })
    }
}

impl Stout<'_> {
    /// Length in mm over which the tube is visibly wider than asked for, and by how many times at most; `None` for what no one
    /// sees.
    pub(super) fn wider(&self, gauge: &Gauge) -> Option<(f64, f64)> {
        let seen = |pair: &&[Place]| pair.iter().all(|place| place.scale > SEEN);
        let length: f64 =
            self.places.windows(2).filter(seen).map(|pair| pair[0].middle.distance(pair[1].middle)).sum();
        let most = self.places.iter().map(|place| place.scale).fold(1.0, f64::max);
        (length > SEEN_ROWS * gauge.height).then_some((length, most))
    }
}

impl ParametricSurface for Stout<'_> {
    fn point(&self, u: f64, v: f64) -> DVec3 {
        self.jet(u, v).point
    }

    fn jet(&self, u: f64, v: f64) -> Jet {
        let jet = self.surface.jet(u, v);
        let x = u.clamp(0.0, 1.0) * PLACES as f64;
        let i = (x as usize).min(PLACES - 1);
        let (a, b) = (&self.places[i], &self.places[i + 1]);
        let share = x - i as f64;
        let middle = a.middle.lerp(b.middle, share);
        let scale = a.scale + (b.scale - a.scale) * share;
        let by_u = PLACES as f64;
        let (drift, growth) = ((b.middle - a.middle) * by_u, (b.scale - a.scale) * by_u);
        let out = jet.point - middle;
        Jet {
            point: middle + out * scale,
            du: drift + (jet.du - drift) * scale + out * growth,
            dv: jet.dv * scale,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::analytic::Cone;

    #[test]
    fn a_spike_is_as_thick_as_five_stitches_and_a_blunt_cone_stays_as_it_is() {
        let gauge = Gauge::new(3.0, 3.0);
        let spike = Cone { start: 0.0, end: 10.0, length: 100.0 };
        let stout = Stout::new(&spike, None, &gauge).expect("a thin tip");
        // It is less than 15 mm around, divided by 1.1, from 22 mm below its tip.
        let (length, most) = stout.wider(&gauge).expect("seen");
        assert!((length - 21.7).abs() < 1.0 && most > 2.0, "{length} {most}");
        for k in 4..=100 {
            let u = f64::from(k) / 100.0;
            let (girth, own) = (girth(&stout, u, 12), girth(&spike, u, 12));
            assert!((girth - own.max(15.0)).abs() < 0.5, "{u}: {girth} and {own}");
            let (jet, beside) = (stout.jet(u - 0.001, 0.3), stout.jet(u - 0.0011, 0.3));
            assert!((jet.point - beside.point).distance(jet.du * 1e-4) < 1e-3, "{u}");
        }
        assert!(Stout::new(&Cone { start: 0.0, end: 30.0, length: 10.0 }, None, &gauge).is_none());
    }
}
