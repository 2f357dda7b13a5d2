//! A surface as bicubic patches: exact at the corners of a grid about as fine as the stitches, and quick to look up between them.
//!
//! A tube is looked up some thirty times a stitch, most of it for tries that are thrown away. Between the corners the
//! error is a fourth power: of an arc of a quarter radian, 1e-5 of its radius. In the end all nodes are put on the surface
//! itself.

use crate::ir::Gauge;
use crate::shape::{Jet, ParametricSurface};
use glam::{DVec3, Vec3A};

/// Rows of patches at either end that are looked up on the surface itself, for it may have any power of u at a pole.
const MARGIN: usize = 1;
/// Stitches that a patch is long and wide.
const STITCHES: f64 = 2.0;
/// Fewest patches along and around, and most of all.
const LEAST: [usize; 2] = [8, 16];
const MOST: f64 = 30_000.0;
/// Looks at the surface along and around that tell its size.
const LOOKS: u32 = 10;

/// Position and derivatives at a corner by shares of a patch, in mm from the origin.
#[derive(Clone, Copy, Debug)]
struct Corner {
    point: Vec3A,
    du: Vec3A,
    dv: Vec3A,
    duv: Vec3A,
}

/// Patches over the whole of a tube.
#[derive(Debug)]
pub(super) struct Patches<'s> {
    surface: &'s dyn ParametricSurface,
    origin: DVec3,
    /// Patches along and around.
    along: usize,
    around: usize,
    /// By rows around; each row ends with its first corner again.
    corners: Vec<Corner>,
}

impl<'s> Patches<'s> {
    /// Patches of a few stitches; `None` where these are too many, or the surface has no sound derivatives.
    pub(super) fn new(surface: &'s dyn ParametricSurface, gauge: &Gauge) -> Option<Self> {
        let [along, around] = Self::size(surface, gauge)?;
        let (by_u, by_v) = (1.0 / along as f64, 1.0 / around as f64);
        let origin = surface.point(0.5, 0.0);
        let mut corners: Vec<Corner> = Vec::with_capacity((along + 1) * (around + 1));
        // With the last row of corners, which ends the last row of patches.
        let last = along - MARGIN;
        for i in MARGIN..=last {
            let row = corners.len();
            for j in 0..around {
                let jet = surface.jet(i as f64 * by_u, j as f64 * by_v);
                corners.push(Corner {
                    point: (jet.point - origin).as_vec3a(),
                    du: (jet.du * by_u).as_vec3a(),
                    dv: (jet.dv * by_v).as_vec3a(),
                    duv: Vec3A::ZERO,
                });
            }
            let row = &mut corners[row..];
            for j in 0..around {
                let beside = |k: usize| row[(j + around + k - 2) % around].du;
                row[j].duv = ((beside(3) - beside(1)) * 8.0 - (beside(4) - beside(0))) / 12.0;
            }
            if !row.iter().all(|corner| [corner.point, corner.dv, corner.duv].iter().all(|d| d.is_finite())) {
                return None;
            }
            let first = row.first().copied();
            corners.extend(first);
        }
        Some(Self { surface, origin, along, around, corners })
    }

    /// Patches along and around, for their size where rows are densest.
    fn size(surface: &dyn ParametricSurface, gauge: &Gauge) -> Option<[usize; 2]> {
        let (mut longest, mut widest) = (0.0_f64, 0.0_f64);
        for i in 0..LOOKS {
            let u = (f64::from(i) + 0.5) / f64::from(LOOKS);
            let jets = (0..LOOKS).map(|j| surface.jet(u, f64::from(j) / f64::from(LOOKS)));
            let (mut speed, mut girth) = (0.0_f64, 0.0);
            for jet in jets {
                speed = speed.max(jet.du.length());
                girth += jet.dv.length() / f64::from(LOOKS);
            }
            longest = longest.max(speed);
            widest = widest.max(girth);
        }
        let (along, around) = (longest / (STITCHES * gauge.height), widest / (STITCHES * gauge.width));
        let fits = along.max(LEAST[0] as f64) * around.max(LEAST[1] as f64) <= MOST;
        fits.then(|| {
            let count = |stitches: f64, least| (stitches.ceil() as usize).max(least);
            [count(along, LEAST[0]) + 2 * MARGIN, count(around, LEAST[1])]
        })
    }
}

/// The four cubics of Hermite at x, and their slopes: value at 0, at 1, slope at 0, at 1.
#[inline]
fn hermite(x: f32) -> ([f32; 4], [f32; 4]) {
    let rest = 1.0 - x;
    let over = x * x * (3.0 - 2.0 * x);
    let hill = 6.0 * x * rest;
    (
        [1.0 - over, over, x * rest * rest, -x * x * rest],
        [-hill, hill, rest * (1.0 - 3.0 * x), x * (3.0 * x - 2.0)],
    )
}

#[inline]
fn blend(c: &[f32; 4], [a, b, da, db]: [Vec3A; 4]) -> Vec3A {
    a * c[0] + b * c[1] + da * c[2] + db * c[3]
}

impl ParametricSurface for Patches<'_> {
    fn point(&self, u: f64, v: f64) -> DVec3 {
        self.jet(u, v).point
    }

    fn jet(&self, u: f64, v: f64) -> Jet {
        let x = u * self.along as f64;
        let margin = MARGIN as f64;
        // No number is in no range.
        if !(x >= margin && x < self.along as f64 - margin) {
            return self.surface.jet(u, v);
        }
        let whole = v as i64 as f64;
        let y = (v - if whole > v { whole - 1.0 } else { whole }) * self.around as f64;
        let (i, j) = (x as usize - MARGIN, (y as usize).min(self.around - 1));
        let (s, s_slope) = hermite((x - (i + MARGIN) as f64) as f32);
        let (t, t_slope) = hermite((y - j as f64) as f32);
        let width = self.around + 1;
        let at = i * width + j;
        let (Some([a, b]), Some([c, d])) =
            (self.corners.get(at..at + 2), self.corners.get(at + width..at + width + 2))
        else {
            return self.surface.jet(u, v);
        };
        // Along v first: the values and the slopes by u at both rows.
        let rows = [[a.point, b.point, a.dv, b.dv], [c.point, d.point, c.dv, d.dv]];
        let slopes = [[a.du, b.du, a.duv, b.duv], [c.du, d.du, c.duv, d.duv]];
        let at =
            |t: &[f32; 4]| [blend(t, rows[0]), blend(t, rows[1]), blend(t, slopes[0]), blend(t, slopes[1])];
        let (value, by_v) = (at(&t), at(&t_slope));
        Jet {
            point: self.origin + blend(&s, value).as_dvec3(),
            du: blend(&s_slope, value).as_dvec3() * self.along as f64,
            dv: blend(&s, by_v).as_dvec3() * self.around as f64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::analytic::TorusArc;

    #[test]
    fn patches_differ_from_the_surface_by_next_to_nothing() {
        let surface = TorusArc { major: 30.0, minor: 12.0, angle: 2.0 };
        let gauge = Gauge::new(3.0, 3.0);
        let patches = Patches::new(&surface, &gauge).unwrap();
        for i in 0..1000 {
            let (u, v) = (f64::from(i) / 999.0, 0.618 * f64::from(i) - 100.0);
            let (near, exact) = (patches.jet(u, v), surface.jet(u, v));
            assert!(near.point.distance(exact.point) < 5e-4 * gauge.width, "{u} {v}");
            assert!(near.du.distance(exact.du) < 1e-3 * exact.du.length(), "{u} {v}");
            assert!(near.dv.distance(exact.dv) < 1e-3 * exact.dv.length(), "{u} {v}");
        }
    }
}
