//! A surface as bicubic patches: exact at the corners of a grid about as fine as the stitches, and quick to look up between them.
//!
//! A tube is looked up some thirty times a stitch, most of it for tries that are thrown away. Between the corners the
//! error is a fourth power: of an arc of a quarter radian, 1e-5 of its radius. In the end all nodes are put on the surface
//! itself.

use crate::ir::Gauge;
use crate::math;
use crate::shape::{End, Jet, ParametricSurface};
use glam::{DVec3, Vec3A};

/// Rows of patches at a closed end that are looked up on the surface itself, for it may have any power of u at a pole.
const MARGIN: usize = 1;
/// Stitches that a patch is long and wide, and the same while someone waits.
pub(super) const USUAL: f64 = 2.0;
pub(super) const LARGE: f64 = 3.0;
/// Fewest patches along and around, and most of all.
const LEAST: [usize; 2] = [8, 16];
const MOST: f64 = 30_000.0;
/// Farthest that patches larger than wished for may be off in the middle, in stitches.
const WAY_OFF: f64 = 0.02;
/// Of a ring of places that are so many times fewer than the patches around, each is looked up by itself.
const FEW: usize = 2;
/// Looks at the surface along and around that tell its size.
const LOOKS: usize = 10;

/// Position and derivatives at a corner by shares of a patch, in mm from the origin.
#[derive(Clone, Copy, Debug)]
struct Corner {
    point: Vec3A,
    du: Vec3A,
    dv: Vec3A,
    duv: Vec3A,
}

/// A patch: by powers of the share along it, cubics of the share around it, lowest power first.
type Patch = [Cubic; 4];
type Cubic = [Vec3A; 4];

/// Patches over the whole of a tube.
#[derive(Debug)]
pub(super) struct Patches<'s> {
    surface: &'s dyn ParametricSurface,
    origin: DVec3,
    /// Patches along and around, also as numbers.
    around: usize,
    numbers: [f64; 2],
    /// Where along they begin and end.
    first: usize,
    range: [f64; 2],
    /// The least girth of a ring of corners, in mm.
    pub(super) thinnest: f64,
    /// By rows around.
    each: Vec<Patch>,
}

impl<'s> Patches<'s> {
    /// Patches of about so many `stitches` along and around, or more on a large tube; `None` where these would be far off, or
    /// the surface has no sound derivatives.
    pub(super) fn new(
        surface: &'s dyn ParametricSurface,
        ends: [End; 2],
        gauge: &Gauge,
        stitches: f64,
    ) -> Option<Self> {
        let ([along, around], coarse) =
            Self::size(surface, [stitches * gauge.height, stitches * gauge.width]);
        let [first, margin] = ends.map(|end| if end == End::Closed { MARGIN } else { 0 });
        let last = along - margin;
        let origin = surface.point(0.5, 0.0);
        let mut each = Vec::with_capacity((last - first) * around);
        let mut ring = vec![Jet::default(); around];
        let mut thinnest = f64::INFINITY;
        let (mut below, mut corners) = (Vec::with_capacity(around), Vec::with_capacity(around));
        for i in first..=last {
            std::mem::swap(&mut below, &mut corners);
            surface.ring(i as f64 / along as f64, 0.0, &mut ring);
            let girth = ring.iter().map(|jet| jet.dv.length()).sum::<f64>() / around as f64;
            thinnest = thinnest.min(girth);
            fill(&mut corners, &ring, origin, 1.0 / along as f64, 1.0 / around as f64);
            if !corners.iter().all(Corner::is_finite) {
                return None;
            }
            let sides = below.iter().zip(&corners);
            let next = below.iter().zip(&corners).cycle().skip(1);
            each.extend(sides.zip(next).map(|((a, c), (b, d))| patch([a, b, c, d])));
        }
        let (numbers, range) = ([along as f64, around as f64], [first as f64, last as f64]);
        let patches = Self { surface, origin, around, numbers, first, range, thinnest, each };
        let close = !coarse || patches.is_close(WAY_OFF * gauge.width, &mut ring);
        close.then_some(patches)
    }

    /// Patches along and around, for their size where rows are densest; and whether that would be too many, so that they are
    /// larger.
    fn size(surface: &dyn ParametricSurface, [height, width]: [f64; 2]) -> ([usize; 2], bool) {
        let (mut longest, mut widest) = (0.0_f64, 0.0_f64);
        let mut ring = [Jet::default(); LOOKS];
        for i in 0..LOOKS {
            surface.ring((i as f64 + 0.5) / LOOKS as f64, 0.0, &mut ring);
            let (mut speed, mut girth) = (0.0_f64, 0.0);
            for jet in &ring {
                speed = speed.max(jet.du.length());
                girth += jet.dv.length() / LOOKS as f64;
            }
            longest = longest.max(speed);
            widest = widest.max(girth);
        }
        let least = LEAST.map(|least| least as f64);
        let (along, around) = ((longest / height).max(least[0]), (widest / width).max(least[1]));
        let by = (along * around / MOST).sqrt().max(1.0);
        let around = (around / by).max(least[1]).min(MOST / least[0]);
        let along = (along / by).max(least[0]).min(MOST / around);
        ([along.ceil() as usize + 2 * MARGIN, around.ceil() as usize], by > 1.0)
    }
}

impl Patches<'_> {
    /// The middle of no patch is farther from the surface. The ring is room to work in.
    fn is_close(&self, distance: f64, ring: &mut [Jet]) -> bool {
        let [along, around] = self.numbers;
        let rows = self.first..self.first + self.each.len() / self.around;
        rows.into_iter().all(|i| {
            let u = (i as f64 + 0.5) / along;
            self.surface.ring(u, 0.5 / around, ring);
            (0_u32..)
                .zip(&*ring)
                .all(|(j, jet)| self.point(u, (f64::from(j) + 0.5) / around).distance(jet.point) <= distance)
        })
    }
}

impl Corner {
    fn is_finite(&self) -> bool {
        [self.point, self.dv, self.duv].iter().all(|d| d.is_finite())
    }
}

/// The corners of a ring, with the mixed derivative by differences of fourth order.
fn fill(corners: &mut Vec<Corner>, ring: &[Jet], origin: DVec3, by_u: f64, by_v: f64) {
    corners.clear();
    corners.extend(ring.iter().map(|jet| Corner {
        point: (jet.point - origin).as_vec3a(),
        du: (jet.du * by_u).as_vec3a(),
        dv: (jet.dv * by_v).as_vec3a(),
        duv: Vec3A::ZERO,
    }));
    let count = corners.len();
    let [mut a, mut b, mut c, mut d] = [count - 2, count - 1, 0, 1].map(|j| corners[j].du);
    for j in 0..count {
        let next = if j + 2 < count { j + 2 } else { j + 2 - count };
        let e = corners[next].du;
        corners[j].duv = ((d - b) * 8.0 - (e - a)) / 12.0;
        (a, b, c, d) = (b, c, d, e);
    }
}

/// The cubic with such values and slopes at 0 and at 1.
#[inline]
fn cubic(p: Vec3A, q: Vec3A, dp: Vec3A, dq: Vec3A) -> Cubic {
    let rise = q - p;
    [p, dp, rise * 3.0 - dp * 2.0 - dq, dp + dq - rise * 2.0]
}

/// The patch between two corners below and two above.
fn patch([a, b, c, d]: [&Corner; 4]) -> Patch {
    let low = cubic(a.point, b.point, a.dv, b.dv);
    let high = cubic(c.point, d.point, c.dv, d.dv);
    let slope_low = cubic(a.du, b.du, a.duv, b.duv);
    let slope_high = cubic(c.du, d.du, c.duv, d.duv);
    let by_t: [Cubic; 4] = std::array::from_fn(|j| cubic(low[j], high[j], slope_low[j], slope_high[j]));
    std::array::from_fn(|i| by_t.map(|powers| powers[i]))
}

#[inline]
fn value([a, b, c, d]: &Cubic, x: f32) -> Vec3A {
    ((*d * x + *c) * x + *b) * x + *a
}

#[inline]
fn slope([_, b, c, d]: &Cubic, [twice, thrice]: [f32; 2]) -> Vec3A {
    *d * thrice + *c * twice + *b
}

/// The slopes of the square and of the cube.
#[inline]
fn rates(x: f32) -> [f32; 2] {
    [2.0 * x, 3.0 * x * x]
}

impl Patches<'_> {
    /// The row of patches at u, and the share along it.
    #[inline]
    fn row(&self, u: f64) -> Option<(usize, f32)> {
        let x = u * self.numbers[0];
        // No number is in no range.
        (x >= self.range[0] && x < self.range[1]).then(|| {
            let (i, share) = math::split(x);
            (i - self.first, share as f32)
        })
    }

    /// The patch around, and the share of it.
    #[inline]
    fn column(&self, v: f64) -> (usize, f32) {
        let (j, share) = math::split(math::fraction(v) * self.numbers[1]);
        // A hair below a whole turn may be one.
        if j < self.around { (j, share as f32) } else { (self.around - 1, 1.0) }
    }

    #[inline]
    fn jet_of(&self, point: Vec3A, du: Vec3A, dv: Vec3A) -> Jet {
        Jet {
            point: self.origin + point.as_dvec3(),
            du: du.as_dvec3() * self.numbers[0],
            dv: dv.as_dvec3() * self.numbers[1],
        }
    }
}

impl ParametricSurface for Patches<'_> {
    fn point(&self, u: f64, v: f64) -> DVec3 {
        self.jet(u, v).point
    }

    fn jet(&self, u: f64, v: f64) -> Jet {
        let Some((i, s)) = self.row(u) else { return self.surface.jet(u, v) };
        let (j, t) = self.column(v);
        let Some([a, b, c, d]) = self.each.get(i * self.around + j) else {
            return self.surface.jet(u, v);
        };
        let t_rates = rates(t);
        let along = [value(a, t), value(b, t), value(c, t), value(d, t)];
        let around = [slope(a, t_rates), slope(b, t_rates), slope(c, t_rates), slope(d, t_rates)];
        self.jet_of(value(&along, s), slope(&along, rates(s)), value(&around, s))
    }

    fn ring(&self, u: f64, from: f64, jets: &mut [Jet]) {
        let row = self.row(u).and_then(|(i, s)| {
            let row = self.each.get(i * self.around..(i + 1) * self.around)?;
            Some((row, s))
        });
        let Some((row, s)) = row else { return self.surface.ring(u, from, jets) };
        let share = 1.0 / jets.len() as f64;
        if FEW * jets.len() < self.around {
            for (k, jet) in (0_u32..).zip(jets) {
                *jet = self.jet(u, from + f64::from(k) * share);
            }
            return;
        }
        let s_rates = rates(s);
        // At this place along each of them, what is left are cubics around.
        let columns: Vec<(Cubic, Cubic)> = row
            .iter()
            .map(|[a, b, c, d]| {
                let along: [Cubic; 4] = std::array::from_fn(|j| [a[j], b[j], c[j], d[j]]);
                (along.each_ref().map(|along| value(along, s)), along.map(|along| slope(&along, s_rates)))
            })
            .collect();
        for (k, jet) in (0_u32..).zip(jets) {
            let (j, t) = self.column(from + f64::from(k) * share);
            let (values, slopes) = &columns[j];
            *jet = self.jet_of(value(values, t), value(slopes, t), slope(values, rates(t)));
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
        // The second has two million stitches, so that its patches are larger.
        for stitch in [3.0, 0.05] {
            let gauge = Gauge::new(stitch, stitch);
            let patches = Patches::new(&surface, [End::Open; 2], &gauge, USUAL).unwrap();
            assert!(patches.each.len() as f64 <= 1.1 * MOST);
            for i in 0..1000 {
                let (u, v) = (f64::from(i) / 999.0, 0.618 * f64::from(i) - 100.0);
                let (near, exact) = (patches.jet(u, v), surface.jet(u, v));
                assert!(near.point.distance(exact.point) < 5e-4 * gauge.width, "{u} {v}");
                assert!(near.du.distance(exact.du) < 1e-3 * exact.du.length(), "{u} {v}");
                assert!(near.dv.distance(exact.dv) < 1e-3 * exact.dv.length(), "{u} {v}");
            }
        }
    }

    /// A torus with a sharp edge all along.
    #[derive(Debug)]
    struct Edged(TorusArc);

    impl ParametricSurface for Edged {
        fn point(&self, u: f64, v: f64) -> DVec3 {
            self.jet(u, v).point
        }

        fn jet(&self, u: f64, v: f64) -> Jet {
            let (bulge, slope) = (6.0 * math::fraction(v), 6.0);
            let (inner, outer) =
                (self.0.jet(u, v), TorusArc { minor: self.0.minor + bulge, ..self.0 }.jet(u, v));
            let out = (inner.point - self.0.jet(u, v + 0.5).point) / (2.0 * self.0.minor);
            Jet { dv: outer.dv + out * slope, ..outer }
        }
    }

    #[test]
    fn large_patches_that_would_be_far_off_are_none() {
        let edged = Edged(TorusArc { major: 30.0, minor: 12.0, angle: 2.0 });
        assert!(Patches::new(&edged, [End::Open; 2], &Gauge::new(0.05, 0.05), USUAL).is_none());
    }
}
