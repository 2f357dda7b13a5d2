//! How the fabric lies at each loop: its course direction, its outside, and where one stitch ends and the next begins.

use super::net::{NONE, Net, Role};
use crate::math::TAU;
use glam::DVec3;

/// A point of the fabric's middle surface with its outward direction.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Point {
    pub(super) at: DVec3,
    pub(super) out: DVec3,
}

impl Point {
    pub(super) fn lerp(self, other: Self, share: f64) -> Self {
        Self {
            at: self.at.lerp(other.at, share),
            out: self.out.lerp(other.out, share).try_normalize().unwrap_or(self.out),
        }
    }
}

/// The frames of all loops of a piece.
pub(super) struct Frames<'n> {
    net: &'n Net,
    places: &'n [DVec3],
    width: f64,
    /// Course direction, of unit length.
    pub(super) along: Vec<DVec3>,
    /// Outside, of unit length.
    pub(super) out: Vec<DVec3>,
}

/// Neighbors further apart than this many widths are no neighbors in space.
const FAR: f64 = 2.5;

impl<'n> Frames<'n> {
    /// Frames from places, one for each loop; `pole` is the center of a magic ring.
    pub(super) fn new(net: &'n Net, places: &'n [DVec3], pole: Option<DVec3>, width: f64) -> Self {
        let count = places.len();
        let at = |id: u32| places.get(id as usize).copied();
        let mut along = vec![DVec3::ZERO; count];
        for (id, along) in along.iter_mut().enumerate() {
            let here = places[id];
            let side = |neighbor: Option<&u32>| {
                let neighbor = neighbor.and_then(|id| at(*id))?;
                (neighbor.distance(here) <= FAR * width).then_some(neighbor)
            };
            let before = side(net.before.get(id)).unwrap_or(here);
            let after = side(net.after.get(id)).unwrap_or(here);
            *along = (after - before).normalize_or_zero();
        }
        let mut up = vec![DVec3::ZERO; count];
        let mut add = |id: u32, way: DVec3| {
            if let Some(up) = up.get_mut(id as usize) {
                *up += way.normalize_or_zero();
            }
        };
        for step in &net.worked {
            for top in Net::top(step) {
                let Some(to) = at(top) else { continue };
                for &base in net.base(step) {
                    let Some(from) = at(base) else { continue };
                    add(top, to - from);
                    add(base, to - from);
                }
                if let (Role::Ring, Some(pole)) = (step.role, pole) {
                    add(top, to - pole);
                }
            }
        }
        let raw: Vec<DVec3> =
            up.iter().zip(&along).map(|(up, along)| up.cross(*along).normalize_or_zero()).collect();
        let mut frames = Self { net, places, width, along, out: raw };
        frames.smooth();
        frames.mend();
        frames
    }

    /// Evens the outside out between neighbors, so that yarn bends gently.
    fn smooth(&mut self) {
        let mut sum: Vec<DVec3> = self.out.iter().map(|out| *out * 2.0).collect();
        let mut add = |to: u32, from: u32| {
            if let (Some(sum), Some(out)) = (sum.get_mut(to as usize), self.out.get(from as usize)) {
                *sum += *out;
            }
        };
        for id in 0..self.out.len() as u32 {
            add(id, self.net.before[id as usize]);
            add(id, self.net.after[id as usize]);
        }
        for step in &self.net.worked {
            for top in Net::top(step) {
                for &base in self.net.base(step) {
                    add(top, base);
                    add(base, top);
                }
            }
        }
        for (out, sum) in self.out.iter_mut().zip(sum) {
            *out = sum.try_normalize().unwrap_or(*out);
        }
    }

    /// Gives loops without a direction of their own that of a neighbor along the yarn.
    fn mend(&mut self) {
        let mut last = (DVec3::X, DVec3::Z);
        let known = |along: DVec3, out: DVec3| along != DVec3::ZERO && out != DVec3::ZERO;
        if let Some(first) =
            self.along.iter().zip(&self.out).find(|(along, out)| known(**along, **out)).map(|(a, o)| (*a, *o))
        {
            last = first;
        }
        for (along, out) in self.along.iter_mut().zip(&mut self.out) {
            if *along == DVec3::ZERO {
                *along = last.0;
            }
            if *out == DVec3::ZERO {
                *out = last.1;
            }
            last = (*along, *out);
        }
    }

    /// The loop's own point.
    pub(super) fn middle(&self, id: u32) -> Point {
        let index = id as usize;
        Point {
            at: self.places.get(index).copied().unwrap_or_default(),
            out: self.out.get(index).copied().unwrap_or(DVec3::Z),
        }
    }

    /// The way up the wale at a loop, of unit length.
    pub(super) fn up(&self, id: u32) -> DVec3 {
        let along = self.along.get(id as usize).copied().unwrap_or(DVec3::X);
        along.cross(self.middle(id).out).try_normalize().unwrap_or(DVec3::Y)
    }

    /// Where the stitch of a loop ends against the course direction.
    pub(super) fn left(&self, id: u32) -> Point {
        self.edge(id, &self.net.before, -0.5)
    }

    /// Where the stitch of a loop ends in course direction.
    pub(super) fn right(&self, id: u32) -> Point {
        self.edge(id, &self.net.after, 0.5)
    }

    fn edge(&self, id: u32, neighbors: &[u32], side: f64) -> Point {
        let here = self.middle(id);
        let neighbor = neighbors.get(id as usize).copied().unwrap_or(NONE);
        if (neighbor as usize) < self.places.len() {
            let there = self.middle(neighbor);
            if there.at.distance(here.at) <= FAR * self.width {
                return here.lerp(there, 0.5);
            }
        }
        let along = self.along.get(id as usize).copied().unwrap_or(DVec3::X);
        Point { at: here.at + along * (side * self.width), out: here.out }
    }

    /// A point beside a pole, towards a point further out.
    pub(super) fn beside(pole: DVec3, outer: Point, radius: f64) -> Point {
        Point { at: pole + (outer.at - pole).normalize_or_zero() * radius, out: outer.out }
    }
}

/// Radius of a ring of so many stitches.
pub(super) fn ring_radius(loops: u32, width: f64) -> f64 {
    f64::from(loops.max(1)) * width / TAU
}
