//! The middles of closed ends: where the axis of what leads to an end comes out of the surface.

use super::Mesh;
use super::ends::{Ends, Tip};
use super::levels::Levels;

/// The line around an end that tells its axis lies this far from it, in its girths: a ball's quarter and a radius. Where
/// other ends lie above it, it is tried this much nearer, so often.
const BEHIND: f64 = 0.41;
const NEARER: f64 = 0.75;
const TRIES: u32 = 3;
/// And no farther than this share of the way to the other end.
const MOST: f64 = 0.4;

impl Mesh {
    /// Moves closed ends that lie farther than `far` from their middles there: the start if it may, and the others if
    /// these may. True when one was moved.
    pub(super) fn centered(&self, field: &[f64], ends: &mut Ends, may: [bool; 2], far: f64) -> bool {
        let mut moved = Vec::new();
        if may[0] {
            let down: Vec<f64> = field.iter().map(|value| -value).collect();
            let goals: Vec<u32> = ends.others.iter().flat_map(|tip| tip.ring.iter().copied()).collect();
            moved.push((None, self.axis_end(&down, ends, &ends.start, &goals)));
        }
        if may[1] {
            let goals = &ends.start.ring;
            let of = |tip: &Tip| self.axis_end(field, ends, tip, goals);
            moved.extend(ends.others.iter().enumerate().map(|(i, tip)| (Some(i), of(tip))));
        }
        let mut any = false;
        for (which, vertex) in moved {
            let tip = which.map_or(Some(&mut ends.start), |i| ends.others.get_mut(i));
            let (Some(tip), Some(vertex)) = (tip, vertex) else { continue };
            if self.middle(tip).distance(self.point(vertex)) > far {
                tip.ring = vec![vertex];
                any = true;
            }
        }
        any
    }

    /// The vertex of a closed end that is nearest to the axis of a line around that end alone.
    fn axis_end(&self, field: &[f64], ends: &Ends, tip: &Tip, goals: &[u32]) -> Option<u32> {
        if tip.open || tip.between {
            return None;
        }
        let way = self.way(tip, goals, field);
        let levels = Levels { mesh: self, field };
        let mut length = (BEHIND * tip.girth).min(MOST * way.total());
        for _ in 0..TRIES {
            let level = way.level_at(length);
            length *= NEARER;
            let inside = self.reached(field, level, tip);
            let mut rest = ends.others.iter().chain(&ends.off).chain([&ends.start]);
            if rest.any(|other| other.ring != tip.ring && other.ring.iter().any(|v| inside[*v as usize])) {
                continue;
            }
            let ring = levels.line(level, &way.vertices)?;
            let (middle, axis) = (ring.center(), ring.area().normalize_or_zero());
            let axis = if axis.dot(self.middle(tip) - middle) < 0.0 { -axis } else { axis };
            let off = |v: &u32| (self.point(*v) - middle).reject_from_normalized(axis).length_squared();
            let above = |v: &u32| inside[*v as usize] && (self.point(*v) - middle).dot(axis) > 0.0;
            let all = (0..self.points.len() as u32).filter(above);
            return all.min_by(|a, b| off(a).total_cmp(&off(b)));
        }
        None
    }
}
