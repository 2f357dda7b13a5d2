//! Ways down from the ends to the start, by which limbs are measured and their level lines found.

use super::Mesh;
use super::ends::{Ends, Tip};

/// A way along edges from an end down to the start.
#[derive(Clone, Debug)]
pub(super) struct Way {
    pub(super) vertices: Vec<u32>,
    /// Field value at each vertex.
    values: Vec<f64>,
    /// Length from the end up to each vertex.
    lengths: Vec<f64>,
}

impl Way {
    /// Length from the end down to a level.
    pub(super) fn down_to(&self, level: f64) -> f64 {
        let i =
            self.values.partition_point(|value| *value >= level).min(self.lengths.len().saturating_sub(1));
        let Some(before) = i.checked_sub(1) else { return 0.0 };
        let (a, b) = (self.values[before], self.values[i]);
        let t = if a > b { ((a - level) / (a - b)).clamp(0.0, 1.0) } else { 0.0 };
        self.lengths[before] + t * (self.lengths[i] - self.lengths[before])
    }

    /// The level at a length down from the end.
    pub(super) fn level_at(&self, length: f64) -> f64 {
        let i = self.lengths.partition_point(|at| *at < length).clamp(1, self.lengths.len().max(2) - 1);
        let (Some(&a), Some(&b)) = (self.values.get(i - 1), self.values.get(i)) else { return 0.0 };
        let span = self.lengths[i] - self.lengths[i - 1];
        let t = if span > 0.0 { ((length - self.lengths[i - 1]) / span).clamp(0.0, 1.0) } else { 0.0 };
        a + t * (b - a)
    }

    /// Length of the whole way.
    pub(super) fn total(&self) -> f64 {
        self.lengths.last().copied().unwrap_or(0.0)
    }

    /// Length between two levels.
    pub(super) fn length(&self, low: f64, high: f64) -> f64 {
        (self.down_to(low) - self.down_to(high)).max(0.0)
    }

    /// The level at a distance from the end, or from the start.
    pub(super) fn level(&self, field: &impl Fn(u32) -> f64, distance: f64, from_end: bool) -> f64 {
        let total = self.total();
        let distance = distance.min(0.3 * total);
        let target = if from_end { distance } else { total - distance };
        let i =
            self.lengths.partition_point(|length| *length < target).clamp(1, self.lengths.len().max(2) - 1);
        let (Some(&a), Some(&b)) = (self.vertices.get(i - 1), self.vertices.get(i)) else { return 0.0 };
        let span = self.lengths[i] - self.lengths[i - 1];
        let t = if span > 0.0 { (target - self.lengths[i - 1]) / span } else { 0.0 };
        field(a) + t * (field(b) - field(a))
    }
}

impl Mesh {
    /// The way from an end to the start.
    pub(super) fn way(&self, tip: &Tip, start: &[u32], field: &[f64]) -> Way {
        let vertices = self.descent(tip.ring[0], field, start);
        let mut lengths = Vec::with_capacity(vertices.len());
        let mut length = 0.0;
        for (i, &vertex) in vertices.iter().enumerate() {
            length += i.checked_sub(1).map_or(0.0, |i| self.point(vertices[i]).distance(self.point(vertex)));
            lengths.push(length);
        }
        let values = vertices.iter().map(|v| field[*v as usize]).collect();
        Way { vertices, values, lengths }
    }

    /// Moves every closed end to the extremum of the field beside it.
    pub(super) fn climb(&self, field: &[f64], ends: &mut Ends) {
        let go = |tip: &mut Tip, sign: f64| {
            if tip.open {
                return;
            }
            let value = |v: u32| (sign * field[v as usize], v);
            let mut at = tip.ring[0];
            while let Some(next) = self
                .neighbors(at)
                .filter(|next| value(*next) > value(at))
                .max_by(|a, b| value(*a).0.total_cmp(&value(*b).0).then(a.cmp(b)))
            {
                at = next;
            }
            tip.ring = vec![at];
        };
        go(&mut ends.start, -1.0);
        for tip in &mut ends.others {
            go(tip, 1.0);
        }
    }
}
