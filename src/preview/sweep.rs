//! Yarn as a tube: rings around its line, carried along without twist, and a lid at each end.

use super::mesh::{Detail, Mesh};
use super::yarn::Yarn;
use crate::math::{TAU, sin_cos_turns};
use glam::DVec3;

/// The yarn turns once around itself in so many of its thicknesses.
const PITCH: f64 = 5.0;
/// Strands of the yarn.
const PLIES: f64 = 2.0;

/// Adds the tube of a yarn of this thickness.
pub(super) fn tube(yarn: &Yarn, thickness: f64, detail: Detail, mesh: &mut Mesh) {
    let Some(first) = yarn.curve(0) else { return };
    let sides: Vec<(f64, f64)> =
        (0..detail.sides).map(|k| sin_cos_turns(k as f64 / detail.sides as f64)).collect();
    let mut tube = Tube { mesh, sides, radius: 0.5 * thickness, ring: None, way: 0.0, last: None };
    let start = first.slope(0.0).try_normalize().unwrap_or(DVec3::X);
    let mut frame = (first.points[0], start, start.any_orthonormal_vector());
    tube.lid(frame, first.stitch, false);
    tube.ring(frame, first.stitch);
    let count = yarn.len();
    let mut index = 0;
    while index < count {
        let next = (index + detail.stride).min(count);
        let (Some(curve), Some(end)) = (yarn.curve(index), yarn.curve(next - 1)) else { break };
        for step in 1..=detail.steps {
            let (from, t) =
                if step == detail.steps { (end, 1.0) } else { (curve, step as f64 / detail.steps as f64) };
            let way = from.slope(t).try_normalize().unwrap_or(frame.1);
            frame = carried(frame, from.at(t), way);
            tube.ring(frame, from.stitch);
        }
        index = next;
    }
    let stitch = yarn.curve(count - 1).map_or(first.stitch, |curve| curve.stitch);
    tube.lid(frame, stitch, true);
}

/// Position, direction and a side.
type Frame = (DVec3, DVec3, DVec3);

/// The frame at the next point with the least twist (double reflection; Wang and others 2008).
fn carried((from, way, side): Frame, to: DVec3, next: DVec3) -> Frame {
    let step = to - from;
    let square = step.length_squared();
    if square <= 0.0 {
        return (to, way, side);
    }
    let reflect = |v: DVec3| v - step * (2.0 / square * step.dot(v));
    let (side_there, way_there) = (reflect(side), reflect(way));
    let turn = next - way_there;
    let square = turn.length_squared();
    let side =
        if square > 0.0 { side_there - turn * (2.0 / square * turn.dot(side_there)) } else { side_there };
    let side =
        (side - next * side.dot(next)).try_normalize().unwrap_or_else(|| next.any_orthonormal_vector());
    (to, next, side)
}

struct Tube<'m> {
    mesh: &'m mut Mesh,
    sides: Vec<(f64, f64)>,
    radius: f64,
    /// First vertex of the ring before.
    ring: Option<u32>,
    /// Length so far.
    way: f64,
    last: Option<DVec3>,
}

impl Tube<'_> {
    fn ring(&mut self, (at, way, side): Frame, stitch: u32) {
        self.way += self.last.replace(at).map_or(0.0, |last| last.distance(at));
        let other = way.cross(side);
        let first = self.mesh.positions.len() as u32;
        let turned = self.way / (PITCH * 2.0 * self.radius);
        for (k, (sin, cos)) in self.sides.iter().enumerate() {
            let out = side * *cos + other * *sin;
            self.mesh.vertex((at + out * self.radius).as_vec3(), out.as_vec3(), stitch);
            let phase = k as f64 / self.sides.len() as f64 - turned.fract();
            self.mesh.twist.push((TAU * PLIES * phase) as f32);
        }
        let sides = self.sides.len() as u32;
        if let Some(before) = self.ring.replace(first) {
            for k in 0..sides {
                let next = (k + 1) % sides;
                self.mesh.triangles.push([before + k, before + next, first + next]);
                self.mesh.triangles.push([before + k, first + next, first + k]);
            }
        }
    }

    /// A flat end; the one at the start comes before its ring.
    fn lid(&mut self, (at, way, _): Frame, stitch: u32, end: bool) {
        let center = self.mesh.positions.len() as u32;
        let out = if end { way } else { -way };
        self.mesh.vertex(at.as_vec3(), out.as_vec3(), stitch);
        self.mesh.twist.push(0.0);
        let sides = self.sides.len() as u32;
        let ring = if end { self.ring.unwrap_or(center) } else { center + 1 };
        for k in 0..sides {
            let next = (k + 1) % sides;
            let triangle =
                if end { [center, ring + k, ring + next] } else { [center, ring + next, ring + k] };
            self.mesh.triangles.push(triangle);
        }
    }
}
