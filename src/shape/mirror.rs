//! A surface seen in a mirror, for those who work with the other hand.

use super::{Jet, ParametricSurface};
use crate::ir::maker::mirrored;
use glam::DVec3;

/// The mirror image of a surface, with v the other way around, so that du x dv points outward again:
/// M(u, v) = R S(u, -v).
///
/// A pattern for the mirror image, worked with the left hand, which mirrors it once more, gives the surface itself.
#[derive(Clone, Copy, Debug)]
pub struct Mirrored<'s>(pub &'s dyn ParametricSurface);

impl ParametricSurface for Mirrored<'_> {
    fn point(&self, u: f64, v: f64) -> DVec3 {
        mirrored(self.0.point(u, -v))
    }
    fn jet(&self, u: f64, v: f64) -> Jet {
        let jet = self.0.jet(u, -v);
        Jet { point: mirrored(jet.point), du: mirrored(jet.du), dv: -mirrored(jet.dv) }
    }
}
