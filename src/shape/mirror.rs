//! A surface seen in a mirror, for those who work with the other hand; and one worked from its other end.

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

/// The same surface from its other end, with v the other way around, so that du x dv still points outward:
/// R(u, v) = S(1 - u, -v).
#[derive(Debug)]
pub(crate) struct Reversed(pub(crate) Box<dyn ParametricSurface>);

impl ParametricSurface for Reversed {
    fn point(&self, u: f64, v: f64) -> DVec3 {
        self.0.point(1.0 - u, -v)
    }
    fn jet(&self, u: f64, v: f64) -> Jet {
        let jet = self.0.jet(1.0 - u, -v);
        Jet { point: jet.point, du: -jet.du, dv: -jet.dv }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::analytic::Cone;

    #[test]
    fn a_surface_from_its_other_end_still_faces_outward() {
        let plain = Cone { start: 3.0, end: 5.0, length: 20.0 };
        let reversed = Reversed(Box::new(plain));
        for (u, v) in [(0.2, 0.1), (0.5, 0.7), (0.9, 0.4)] {
            let (jet, there) = (reversed.jet(u, v), plain.jet(1.0 - u, -v));
            assert!(jet.point == there.point && reversed.point(u, v) == there.point);
            assert!(jet.du.cross(jet.dv).dot(there.du.cross(there.dv)) > 0.0);
        }
    }
}
