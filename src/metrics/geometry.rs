//! Lengths, angles and areas of edges, tiles and poles.

use super::mesh::{Class, Mesh};
use crate::ir::{Node, NodeId};
use crate::shape::ParametricSurface;
use glam::DVec3;

/// Samples along and around for the area of the surface.
const AREA_SAMPLES: [u32; 2] = [512, 64];

/// Length of the straight way in (u, v) on the surface, by `steps` chords; v goes the short way round.
pub(super) fn along(surface: &dyn ParametricSurface, from: &Node, to: &Node, steps: u32) -> f64 {
    let dv = to.v - from.v;
    let dv = dv - dv.round();
    let mut length = 0.0;
    let mut before = from.position;
    for i in 1..=steps {
        let share = f64::from(i) / f64::from(steps);
        let point = if i == steps {
            to.position
        } else {
            surface.point(from.u + share * (to.u - from.u), from.v + share * dv)
        };
        length += point.distance(before);
        before = point;
    }
    length
}

/// Absolute cosine between the middle lines of a tile; at a turn the upright one is the turn's own wale.
pub(super) fn skew([base_left, base_right, top_left, top_right]: [DVec3; 4], class: Class) -> f64 {
    let up = match class {
        Class::TurnLeft => top_left - base_left,
        Class::TurnRight => top_right - base_right,
        Class::Quad | Class::Inc | Class::Dec | Class::Step => top_left + top_right - base_left - base_right,
    };
    let across = base_right + top_right - base_left - top_left;
    up.normalize_or_zero().dot(across.normalize_or_zero()).abs()
}

pub(super) fn triangle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    0.5 * (b - a).cross(c - a).length()
}

/// Area around a pole: the fan over its ring, and the wedge by which the helix leaves the ring.
pub(super) fn disc(mesh: &Mesh<'_>, ring: &[NodeId], pole: DVec3, beyond: Option<&Node>) -> f64 {
    let points: Vec<DVec3> = ring.iter().filter_map(|id| mesh.node(*id)).map(|node| node.position).collect();
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else { return 0.0 };
    let fan: f64 = points.windows(2).map(|pair| triangle(pole, pair[0], pair[1])).sum();
    fan + triangle(pole, last, first) + beyond.map_or(0.0, |node| triangle(last, first, node.position))
}

/// Area of a tube by the midpoint rule.
pub(super) fn area(surface: &dyn ParametricSurface) -> f64 {
    let [along, around] = AREA_SAMPLES;
    let mut sum = 0.0;
    for i in 0..along {
        for j in 0..around {
            let jet = surface.jet((f64::from(i) + 0.5) / f64::from(along), f64::from(j) / f64::from(around));
            sum += jet.du.cross(jet.dv).length();
        }
    }
    sum / f64::from(along * around)
}
