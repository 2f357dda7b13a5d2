//! The yarn of a piece: one smooth line through the stitches, in the order in which the hook makes them.

use glam::DVec3;

/// A cubic Bézier curve of the yarn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bezier {
    /// Its control points, in mm.
    pub points: [DVec3; 4],
    /// Index in [`super::Scene::stitches`] of the stitch that it belongs to.
    pub stitch: u32,
}

impl Bezier {
    /// The point at `t` in [0, 1].
    pub fn at(&self, t: f64) -> DVec3 {
        let [a, b, c, d] = self.points;
        let s = 1.0 - t;
        a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t)
    }
    /// The derivative at `t`.
    pub fn slope(&self, t: f64) -> DVec3 {
        let [a, b, c, d] = self.points;
        let s = 1.0 - t;
        ((b - a) * (s * s) + (c - b) * (2.0 * s * t) + (d - c) * (t * t)) * 3.0
    }
}

/// The line of a piece's yarn.
///
/// It is kept as the points through which it goes. Between two of them runs a cubic Bézier curve whose handles follow
/// from the points beside, so neighbors agree in position and tangent everywhere, across the ends of stitches too.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Yarn {
    points: Vec<DVec3>,
    stitches: Vec<u32>,
    strands: Vec<Strand>,
    ways: Vec<Vec<[f64; 3]>>,
}

/// A tile that the yarn goes through. The points of the yarn are those of its way, mapped between its corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strand {
    /// Index in [`super::Scene::stitches`].
    pub stitch: u32,
    /// Corners, numbered as those of a [`super::Stitch`].
    pub corners: [DVec3; 8],
    /// Index in [`Yarn::ways`].
    pub way: u32,
}

impl Yarn {
    /// Goes on through a point of a stitch. Points that fall together are one.
    pub(super) fn push(&mut self, point: DVec3, stitch: u32) {
        if self.points.last().is_none_or(|last| last.distance_squared(point) > 1e-12) {
            self.points.push(point);
            self.stitches.push(stitch);
        }
    }

    /// Takes all points to their mirror image.
    pub(super) fn mirror(&mut self) {
        let corners = self.strands.iter_mut().flat_map(|strand| &mut strand.corners);
        for point in self.points.iter_mut().chain(corners) {
            *point = crate::ir::maker::mirrored(*point);
        }
    }

    /// Notes the tile that the points to come are mapped into, and their way through the unit cube.
    pub(super) fn strand(&mut self, stitch: u32, corners: [DVec3; 8], way: &[[f64; 3]]) {
        let way = self.ways.iter().position(|known| known == way).unwrap_or_else(|| {
            self.ways.push(way.to_vec());
            self.ways.len() - 1
        });
        self.strands.push(Strand { stitch, corners, way: way as u32 });
    }

    /// The tiles in the order in which the yarn goes through them.
    pub fn strands(&self) -> &[Strand] {
        &self.strands
    }

    /// The different ways through the unit cube: x in course direction, y up, z outward.
    pub fn ways(&self) -> &[Vec<[f64; 3]>] {
        &self.ways
    }

    /// Number of curves.
    pub fn len(&self) -> usize {
        self.points.len().saturating_sub(1)
    }

    /// True when there is no yarn.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The curve at an index below [`Self::len`].
    pub fn curve(&self, index: usize) -> Option<Bezier> {
        let (from, to) = (*self.points.get(index)?, *self.points.get(index + 1)?);
        let before = index.checked_sub(1).and_then(|index| self.points.get(index)).copied();
        let after = self.points.get(index + 2).copied();
        let third = from.distance(to) / 3.0;
        let handles =
            [from + direction(before, from, Some(to)) * third, to - direction(Some(from), to, after) * third];
        Some(Bezier { points: [from, handles[0], handles[1], to], stitch: *self.stitches.get(index)? })
    }

    /// All curves in order.
    pub fn curves(&self) -> impl Iterator<Item = Bezier> + '_ {
        (0..self.len()).filter_map(|index| self.curve(index))
    }

    /// Length in mm, by chords of `parts` to a curve.
    pub fn length(&self, parts: u32) -> f64 {
        let parts = parts.max(1);
        let at = |k: u32| f64::from(k) / f64::from(parts);
        let of =
            |curve: Bezier| (0..parts).map(|k| curve.at(at(k)).distance(curve.at(at(k + 1)))).sum::<f64>();
        self.curves().map(of).sum()
    }
}

/// The direction of the yarn at a point: between the ways to and from it, nearer to that of the shorter.
fn direction(before: Option<DVec3>, at: DVec3, after: Option<DVec3>) -> DVec3 {
    match (before, after) {
        (Some(before), Some(after)) => {
            let (to, from) = (at - before, after - at);
            let (long, short) = (to.length(), from.length());
            let way = to.normalize_or_zero() * short + from.normalize_or_zero() * long;
            way.try_normalize().unwrap_or_else(|| from.normalize_or_zero())
        }
        (Some(before), None) => (at - before).normalize_or_zero(),
        (None, Some(after)) => (after - at).normalize_or_zero(),
        (None, None) => DVec3::ZERO,
    }
}
