//! The swept tube: sections carried along a control curve on rotation-minimizing frames.

use super::bezier::{Chain, JOINT_GAP, Place};
use super::frame::Frames;
use super::meridian::Meridian;
use super::profile::Stack;
use super::spec::{Fault, TubeSpec};
use super::{End, Jet, ParametricSurface, fold};
use crate::math;
use glam::DVec3;
use std::fmt;
use std::ops::{Range, RangeInclusive};

/// Segments a curve may have.
const MOST_SEGMENTS: usize = 2048;
/// Part of u next to a point where the surface is a cone through the ring at its edge, for derivatives by the curve
/// parameter have no limit there. A sphere differs from it by 1e-10 of its radius.
const TIP: f64 = 1e-5;

/// A tube made of sections along a curve.
///
/// Where it shrinks to a point at a closed end that point is its pole; a closed end with a size is shut by a flat
/// cap with a rounded rim, for yarn holds no sharp edge, so u in [0, 1] covers cap, tube and cap in proportion to their lengths. The parameter of a single
/// segment with open ends is the curve parameter; with several segments or closed ends u follows the
/// length of the meridian, so that its speed is even, whatever the speeds of the segments are. Beyond an open end
/// the surface goes on straight, beyond a pole on the other side.
#[derive(Clone)]
pub struct Sweep {
    chain: Chain,
    frames: Frames,
    stack: Stack,
    meridian: Meridian,
    start: Tip,
    end: Tip,
}

impl fmt::Debug for Sweep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The tables would fill pages.
        f.debug_struct("Sweep")
            .field("segments", &self.chain.segments())
            .field("length", &self.chain.length())
            .field("tube", &self.tube_range())
            .field("start", &self.start)
            .field("end", &self.end)
            .finish_non_exhaustive()
    }
}

/// Radius of a cap's rounded rim as a share of its radius: usual, least and greatest.
const ROUNDED: f64 = 0.2;
const ROUNDED_RANGE: [f64; 2] = [0.1, 0.5];

/// Length of the meridian of a cap in radii.
fn cap_length(rounded: f64) -> f64 {
    1.0 - rounded + 0.5 * math::PI * rounded
}

/// Meridian of a cap: a flat disk, then a quarter turn down to the wall.
struct Cap {
    /// Distance from the axis as a share of the radius, and its slope.
    share: f64,
    share_slope: f64,
    /// Height over the wall's end in radii of the rim, and its slope.
    rise: f64,
    rise_slope: f64,
}

impl Cap {
    /// At a share of the meridian, from 0 at the pole to 1 at the wall.
    fn at(x: f64, rounded: f64) -> Self {
        let total = cap_length(rounded);
        let length = x * total;
        let angle = (length - (1.0 - rounded)) / rounded;
        if angle <= 0.0 {
            return Self { share: length, share_slope: total, rise: 1.0, rise_slope: 0.0 };
        }
        let (sin, cos) = math::sin_cos(angle);
        let speed = total / rounded;
        Self {
            share: 1.0 - rounded + rounded * sin,
            share_slope: speed * rounded * cos,
            rise: cos,
            rise_slope: -speed * sin,
        }
    }
}

/// How the surface goes on at an end.
#[derive(Clone, Copy, Debug, Default)]
struct Tip {
    closed: bool,
    /// Part of u that the cap takes.
    width: f64,
    /// The pole, and the unit vector out of the tube there.
    center: DVec3,
    outward: DVec3,
    /// Radius of the rounded rim in mm, and as a share of the cap's radius.
    rim: f64,
    rounded: f64,
    /// Greatest rate at which a straight continuation narrows.
    shrink: f64,
}

impl Tip {
    /// The place on a cap that belongs to one of its rim; `slope` is the share of the cap by u.
    fn on_cap(&self, cap: &Cap, slope: f64, rim: &Jet) -> Jet {
        let arm = rim.point - (self.center - self.outward * self.rim);
        Jet {
            point: self.center + arm * cap.share + self.outward * (self.rim * (cap.rise - 1.0)),
            du: (arm * cap.share_slope + self.outward * (self.rim * cap.rise_slope)) * slope,
            dv: rim.dv * cap.share,
        }
    }
}

impl Sweep {
    /// The tube that `spec` describes. Takes about a millisecond.
    pub fn new(spec: &TubeSpec) -> Result<Self, Fault> {
        Self::build(spec, |_| ROUNDED)
    }

    /// The same with the radius (mm) of the rounded rims of caps: what the fabric can turn around. It is kept between a
    /// tenth and a half of the cap's radius.
    pub fn with_rim(spec: &TubeSpec, rim: f64) -> Result<Self, Fault> {
        Self::build(spec, |radius| {
            if radius > 0.0 { (rim / radius).clamp(ROUNDED_RANGE[0], ROUNDED_RANGE[1]) } else { ROUNDED }
        })
    }

    fn build(spec: &TubeSpec, rounded: impl Fn(f64) -> f64) -> Result<Self, Fault> {
        let finite = |p: DVec3| p.is_finite() && p.abs().max_element() <= 1e7;
        if spec.curve.iter().any(|segment| !segment.points().iter().copied().all(finite)) {
            return Err(Fault::NotFinite);
        }
        if spec.curve.is_empty() || spec.sections.is_empty() {
            return Err(Fault::Empty);
        }
        if spec.curve.len() > MOST_SEGMENTS {
            return Err(Fault::TooMany { limit: MOST_SEGMENTS });
        }
        for (joint, pair) in spec.curve.windows(2).enumerate() {
            let distance = pair[0].point(1.0).distance(pair[1].point(0.0));
            if distance > JOINT_GAP {
                return Err(Fault::Gap { segment: joint + 1, distance });
            }
        }
        let chain = Chain::new(&spec.curve).map_err(|segment| Fault::ZeroLength { segment })?;
        let stack = Stack::new(spec)?;
        let frames = Frames::new(&chain).map_err(|jump| Fault::Kink { u: jump.u, degrees: jump.degrees })?;
        let breaks = breaks(&chain, &stack);
        fold::check(&chain, &frames, &stack, &breaks)?;
        let points = stack.points_at_ends();
        let plain = Meridian::new(&[0.0, 1.0], true, [0.0; 2], |_| 1.0);
        let mut sweep =
            Self { chain, frames, stack, meridian: plain, start: Tip::default(), end: Tip::default() };
        let ends = [(spec.start, points.0, 0.0), (spec.end, points.1, 1.0)];
        let disks = ends.map(|(end, point, w)| match end {
            End::Open => (DVec3::ZERO, 0.0),
            End::Closed => {
                let (center, radius) = sweep.disk(w);
                (center, if point { 0.0 } else { radius })
            }
        });
        let meridian = {
            let pace = |w: f64| {
                let speed = sweep.chain.at(w).speed;
                (speed * speed + sweep.stack.pace_squared(w)).sqrt()
            };
            Meridian::new(
                &breaks,
                spec.curve.len() == 1,
                disks.map(|disk| disk.1 * cap_length(rounded(disk.1))),
                pace,
            )
        };
        let body = meridian.body();
        sweep.meridian = meridian;
        let tip = |(end, point, w): (End, bool, f64), (center, radius): (DVec3, f64), cap: f64| {
            let outward = sweep.chain.at(w).tangent * (2.0 * w - 1.0);
            let rounded = rounded(radius);
            let rim = rounded * radius;
            Tip {
                closed: end == End::Closed,
                width: if point { TIP } else { cap },
                center: center + outward * rim,
                outward,
                rim,
                rounded,
                shrink: 0.0,
            }
        };
        let tips = [tip(ends[0], disks[0], body.start), tip(ends[1], disks[1], 1.0 - body.end)];
        [sweep.start, sweep.end] = tips;
        sweep.start.shrink = sweep.shrink(0.0, -1.0);
        sweep.end.shrink = sweep.shrink(1.0, 1.0);
        Ok(sweep)
    }

    /// The part of [0, 1] that the curve takes; flat caps at closed ends have the rest.
    pub fn tube_range(&self) -> Range<f64> {
        self.meridian.body()
    }

    /// The curve parameter at surface parameter `u`: that of the nearest end on a cap.
    pub fn curve_parameter(&self, u: f64) -> f64 {
        let body = self.meridian.body();
        self.meridian.eval(u.clamp(body.start, body.end)).0
    }

    /// The surface parameter at curve parameter `w` in [0, 1].
    pub fn surface_parameter(&self, w: f64) -> f64 {
        self.meridian.invert(w)
    }

    /// Center and mean radius of the section at curve parameter `w`.
    fn disk(&self, w: f64) -> (DVec3, f64) {
        const SAMPLES: usize = 64;
        let mut ring = [DVec3::ZERO; SAMPLES];
        self.body_points(w, &mut ring);
        let center = ring.iter().sum::<DVec3>() / SAMPLES as f64;
        let radius = ring.iter().map(|point| point.distance(center)).sum::<f64>() / SAMPLES as f64;
        (center, radius)
    }

    /// Greatest rate (a unit of u) at which the ring at an open end comes closer to its center when u goes on.
    fn shrink(&self, u: f64, sign: f64) -> f64 {
        const SAMPLES: usize = 16;
        let mut ring = [Jet::default(); SAMPLES];
        self.tube_ring(u, 0.0, &mut ring);
        let mean = ring.iter().fold((DVec3::ZERO, DVec3::ZERO), |(p, d), jet| (p + jet.point, d + jet.du));
        let (center, drift) = (mean.0 / SAMPLES as f64, mean.1 / SAMPLES as f64);
        ring.iter()
            .map(|jet| {
                let arm = jet.point - center;
                -sign * (jet.du - drift).dot(arm) / arm.length_squared().max(1e-12)
            })
            .fold(0.0, f64::max)
    }

    /// Point and derivatives, `du` by the curve parameter.
    #[inline]
    fn body(&self, w: f64, v: f64) -> Jet {
        let (segment, t) = self.chain.locate(w);
        let place = self.chain.place(segment, t);
        let axis = self.frames.axis(segment, t, &place);
        let profile = self.stack.eval(w, v);
        if self.stack.planar() {
            carry::<true>(&place, axis, &profile)
        } else {
            carry::<false>(&place, axis, &profile)
        }
    }

    /// The same around a whole turn.
    fn body_ring(&self, w: f64, from: f64, jets: &mut [Jet]) {
        let (segment, t) = self.chain.locate(w);
        let place = self.chain.place(segment, t);
        let axis = self.frames.axis(segment, t, &place);
        let line = self.stack.at(w);
        let count = jets.len() as f64;
        for (k, jet) in jets.iter_mut().enumerate() {
            let profile = line.eval(from + k as f64 / count);
            *jet = if self.stack.planar() {
                carry::<true>(&place, axis, &profile)
            } else {
                carry::<false>(&place, axis, &profile)
            };
        }
    }

    /// The points of the same, from v = 0 on.
    fn body_points(&self, w: f64, points: &mut [DVec3]) {
        let (segment, t) = self.chain.locate(w);
        let (center, tangent) = self.chain.stand(segment, t);
        let axis = self.frames.across(segment, t, tangent);
        let other = tangent.cross(axis);
        let line = self.stack.at(w);
        let count = points.len() as f64;
        for (k, place) in points.iter_mut().enumerate() {
            let point = line.point(k as f64 / count);
            let across = axis * point.x + other * point.y;
            *place = center + if self.stack.planar() { across } else { across + tangent * point.z };
        }
    }

    /// Points around the tube, evenly from v = 0 on: those of a ring without their derivatives.
    pub(crate) fn points_around(&self, u: f64, points: &mut [DVec3]) {
        if self.curved().contains(&u) {
            return self.body_points(self.meridian.eval(u).0, points);
        }
        let mut jets = vec![Jet::default(); points.len()];
        self.ring(u, 0.0, &mut jets);
        for (point, jet) in points.iter_mut().zip(jets) {
            *point = jet.point;
        }
    }

    /// The part of u on which the curve alone makes the surface.
    #[inline]
    fn curved(&self) -> RangeInclusive<f64> {
        let low = if self.start.closed { self.start.width } else { 0.0 };
        let high = if self.end.closed { 1.0 - self.end.width } else { 1.0 };
        low..=high
    }

    /// The surface on the curve's part of u.
    #[inline]
    fn tube(&self, u: f64, v: f64) -> Jet {
        let (w, rate) = self.meridian.eval(u);
        let jet = self.body(w, v);
        Jet { point: jet.point, du: jet.du * rate, dv: jet.dv }
    }

    /// The same around a whole turn.
    fn tube_ring(&self, u: f64, from: f64, jets: &mut [Jet]) {
        let (w, rate) = self.meridian.eval(u);
        self.body_ring(w, from, jets);
        for jet in jets {
            jet.du *= rate;
        }
    }

    /// The end that is nearer to a place outside of the curve's part of u; its u, and the sign of the way into the tube.
    fn tip(&self, u: f64) -> (&Tip, f64, f64) {
        // A wide cap on a short tube takes more than half of u.
        let curved = self.curved();
        let at_start = u < 0.5 * (curved.start() + curved.end());
        if at_start { (&self.start, 0.0, 1.0) } else { (&self.end, 1.0, -1.0) }
    }

    /// The surface outside of the curve's part of u: caps, poles and what lies beyond the ends.
    #[cold]
    fn beyond(&self, u: f64, v: f64) -> Jet {
        let (tip, edge, sign) = self.tip(u);
        if tip.closed {
            // The distance from the pole; on its other side the opposite half turn.
            let depth = sign * (u - edge);
            let (depth, v, flip) = if depth < 0.0 { (-depth, v + 0.5, -1.0) } else { (depth, v, 1.0) };
            let depth = depth.min(tip.width.max(0.5));
            if depth >= tip.width {
                let jet = self.tube(edge + sign * depth, v);
                return Jet { du: jet.du * flip, ..jet };
            }
            let cap = Cap::at(depth / tip.width, tip.rounded);
            return tip.on_cap(&cap, flip * sign / tip.width, &self.tube(edge + sign * tip.width, v));
        }
        const STEP: f64 = 1e-5;
        let jet = self.tube(edge, v);
        let twist = (self.tube(edge, v + STEP).du - self.tube(edge, v - STEP).du) / (2.0 * STEP);
        // A narrowing end never closes: the step bends toward the distance at which it would.
        let step = u - edge;
        let factor = 1.0 / (1.0 + tip.shrink * step.abs());
        Jet {
            point: jet.point + jet.du * (step * factor),
            du: jet.du * (factor * factor),
            dv: jet.dv + twist * (step * factor),
        }
    }
}

/// A profile carried into space; `FLAT` if it has no part along the tangent. The frame turns about the tangent nowhere,
/// so its vectors change along the tangent only.
#[inline]
pub(super) fn carry<const FLAT: bool>(place: &Place, axis: DVec3, profile: &Jet) -> Jet {
    let other = place.tangent.cross(axis);
    let globe = |q: DVec3| {
        let across = axis * q.x + other * q.y;
        if FLAT { across } else { across + place.tangent * q.z }
    };
    let arm = globe(profile.point);
    // The tangent's turn is across it, so the part of the arm along the tangent does not count.
    let along = place.tangent * (place.speed - place.turn.dot(arm));
    let lift = if FLAT { DVec3::ZERO } else { place.turn * profile.point.z };
    Jet { point: place.point + arm, du: globe(profile.du) + along + lift, dv: globe(profile.dv) }
}

/// Parameters of all joints and sections, ascending, from 0 to 1.
fn breaks(chain: &Chain, stack: &Stack) -> Vec<f64> {
    let segments = chain.segments();
    let mut breaks: Vec<f64> = (0..=segments).map(|k| k as f64 / segments as f64).collect();
    breaks.extend_from_slice(stack.breaks());
    breaks.sort_by(f64::total_cmp);
    breaks.dedup_by(|b, a| *b - *a < 1e-9);
    if let Some(last) = breaks.last_mut() {
        *last = 1.0;
    }
    breaks
}

impl ParametricSurface for Sweep {
    #[inline]
    fn point(&self, u: f64, v: f64) -> DVec3 {
        if !self.curved().contains(&u) {
            return self.beyond(u, v).point;
        }
        let (w, _) = self.meridian.eval(u);
        let (segment, t) = self.chain.locate(w);
        let (center, tangent) = self.chain.stand(segment, t);
        let axis = self.frames.across(segment, t, tangent);
        let point = self.stack.at(w).point(v);
        let across = axis * point.x + tangent.cross(axis) * point.y;
        center + if self.stack.planar() { across } else { across + tangent * point.z }
    }

    #[inline]
    fn jet(&self, u: f64, v: f64) -> Jet {
        if self.curved().contains(&u) { self.tube(u, v) } else { self.beyond(u, v) }
    }

    fn ring(&self, u: f64, from: f64, jets: &mut [Jet]) {
        let (tip, edge, sign) = self.tip(u);
        let depth = sign * (u - edge);
        if self.curved().contains(&u) {
            self.tube_ring(u, from, jets);
        } else if tip.closed && (0.0..tip.width).contains(&depth) {
            // A cap hangs on its rim.
            self.tube_ring(edge + sign * tip.width, from, jets);
            let cap = Cap::at(depth / tip.width, tip.rounded);
            for jet in jets {
                *jet = tip.on_cap(&cap, sign / tip.width, jet);
            }
        } else {
            let count = jets.len() as f64;
            for (k, jet) in jets.iter_mut().enumerate() {
                *jet = self.beyond(u, from + k as f64 / count);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Bezier, Interpolation, Profile, Section, TubeSpec};
    use glam::DVec2;

    #[test]
    fn a_ring_is_made_of_its_jets_on_tubes_caps_and_points() {
        let ellipse = |at: f64, a: f64, b: f64| Section {
            at,
            profile: Profile::Ellipse { axes: [a, b], offset: DVec2::new(0.2 * a, 0.0) },
        };
        let corner = |k: u32| {
            let (sin, cos) = math::sin_cos(-math::TAU * f64::from(k) / 12.0);
            DVec3::new(9.0 * cos, (7.0 + cos) * sin, 0.0)
        };
        let ring = Section { at: 0.4, profile: Profile::Loop((0..12).map(corner).collect()) };
        let points = [[0.0; 3], [0.0, 0.0, 40.0], [0.0, 30.0, 80.0]].map(DVec3::from);
        for middle in [ellipse(0.4, 9.0, 7.0), ring] {
            for (start, end) in [(6.0, 4.0), (0.0, 4.0), (5.0, 0.0)] {
                let spec = TubeSpec {
                    curve: vec![Bezier::new(&points).unwrap()],
                    sections: vec![ellipse(0.0, start, start), middle.clone(), ellipse(1.0, end, end)],
                    interpolation: Interpolation::Smooth,
                    start: End::Closed,
                    end: if end == 4.0 { End::Open } else { End::Closed },
                };
                let sweep = Sweep::new(&spec).unwrap();
                for u in [-0.01, 0.0, 1e-7, 0.01, 0.02, 0.3, 0.5, 0.97, 0.99, 1.0 - 1e-7, 1.0, 1.02] {
                    let mut jets = [Jet::default(); 20];
                    sweep.ring(u, 0.1, &mut jets);
                    for (k, jet) in jets.iter().enumerate() {
                        let v = 0.1 + k as f64 / 20.0;
                        assert_eq!(*jet, sweep.jet(u, v), "{u} {v}");
                    }
                    let mut points = [DVec3::ZERO; 20];
                    sweep.points_around(u, &mut points);
                    for (k, point) in points.iter().enumerate() {
                        assert_eq!(*point, sweep.jet(u, k as f64 / 20.0).point, "{u} {k}");
                    }
                }
            }
        }
    }
}
