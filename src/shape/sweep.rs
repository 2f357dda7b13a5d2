//! The swept tube: sections carried along a control curve on rotation-minimizing frames.

use super::bezier::{Chain, Place};
use super::frame::Frames;
use super::profile::Stack;
use super::spec::{Fault, TubeSpec};
use super::{Jet, ParametricSurface};
use glam::DVec3;
use std::ops::Range;

/// A tube made of sections along a curve. Beyond an open end the surface goes on straight.
#[derive(Clone, Debug)]
pub struct Sweep {
    chain: Chain,
    frames: Frames,
    stack: Stack,
}

impl Sweep {
    /// The tube that `spec` describes.
    pub fn new(spec: &TubeSpec) -> Result<Self, Fault> {
        let finite = |p: DVec3| p.is_finite() && p.abs().max_element() <= 1e7;
        if spec.curve.iter().any(|segment| !segment.points().iter().copied().all(finite)) {
            return Err(Fault::NotFinite);
        }
        if spec.curve.is_empty() || spec.sections.is_empty() {
            return Err(Fault::Empty);
        }
        let chain = Chain::new(&spec.curve).map_err(|segment| Fault::ZeroLength { segment })?;
        let stack = Stack::new(spec)?;
        let frames = Frames::new(&chain).map_err(|jump| Fault::Kink { u: jump.u, degrees: jump.degrees })?;
        Ok(Self { chain, frames, stack })
    }

    /// The part of [0, 1] that the curve takes; caps at closed ends have the rest.
    pub fn tube_range(&self) -> Range<f64> {
        0.0..1.0
    }

    /// The curve parameter at surface parameter `u`.
    pub fn curve_parameter(&self, u: f64) -> f64 {
        u.clamp(0.0, 1.0)
    }

    /// The surface parameter at curve parameter `w`.
    pub fn surface_parameter(&self, w: f64) -> f64 {
        w.clamp(0.0, 1.0)
    }

    /// Point and derivatives, `du` by the curve parameter.
    #[inline]
    fn body(&self, w: f64, v: f64) -> Jet {
        let (segment, t) = self.chain.locate(w);
        let place: Place = self.chain.place(segment, t);
        let axis = self.frames.axis(segment, t, &place);
        let other = place.tangent.cross(axis);
        let profile = self.stack.eval(w, v);
        let (p, pu, pv) = (profile.point, profile.du, profile.dv);
        let bend = p.x * place.turn.dot(axis) + p.y * place.turn.dot(other);
        let globe = |q: DVec3| axis * q.x + other * q.y + place.tangent * q.z;
        Jet {
            point: place.point + globe(p),
            du: globe(pu) + place.tangent * (place.speed - bend) + place.turn * p.z,
            dv: globe(pv),
        }
    }
}

impl ParametricSurface for Sweep {
    fn point(&self, u: f64, v: f64) -> DVec3 {
        self.jet(u, v).point
    }

    fn jet(&self, u: f64, v: f64) -> Jet {
        if (0.0..=1.0).contains(&u) {
            return self.body(u, v);
        }
        let edge = u.clamp(0.0, 1.0);
        let beyond = u - edge;
        let jet = self.body(edge, v);
        const STEP: f64 = 1e-5;
        let twist = (self.body(edge, v + STEP).du - self.body(edge, v - STEP).du) / (2.0 * STEP);
        Jet { point: jet.point + beyond * jet.du, du: jet.du, dv: jet.dv + beyond * twist }
    }
}
