//! Level lines of a field, walked from edge to edge, and stacked along a limb.

use super::Mesh;
use super::soup::NONE;
use crate::shape::ring::{Ring, gap};
use glam::DVec3;

/// Most level lines of one limb.
const MOST_LEVELS: usize = 8192;
/// Most levels at which there may be no line.
const MOST_MISSED: u32 = 64;
/// Samples by which level lines are compared.
const SAMPLES: usize = 32;

/// What level lines are taken from.
pub(super) struct Levels<'m> {
    pub(super) mesh: &'m Mesh,
    pub(super) field: &'m [f64],
}

/// Lines from one end of a limb to the other, with the phase of each, and their levels.
pub(super) struct Lines {
    pub(super) rings: Vec<(Ring, f64)>,
    pub(super) levels: Vec<f64>,
}

impl Levels<'_> {
    /// The line at a level that passes the given way down; its points run clockwise seen from above the level.
    pub(super) fn line(&self, level: f64, way: &[u32]) -> Option<Ring> {
        let high = |v: u32| self.field[v as usize] >= level;
        // The way falls, but for detours out of pits: the last crossing is the one that counts.
        let at = way.partition_point(|v| high(*v));
        let found = |at: usize| {
            let (above, below) = (*way.get(at.checked_sub(1)?)?, *way.get(at)?);
            if !high(above) || high(below) {
                return None;
            }
            let mesh = self.mesh;
            mesh.corners(below).iter().copied().find(|h| mesh.to(*h) == above).or_else(|| {
                // Along an open edge the half-edge runs the other way only.
                let back = mesh.corners(above).iter().copied().find(|h| mesh.to(*h) == below);
                back.filter(|h| mesh.twins[*h as usize] != NONE).map(|h| mesh.twins[h as usize])
            })
        };
        let first = found(at).or_else(|| (1..way.len()).rev().find_map(found))?;
        self.walk(first, level, |_| ())
    }

    /// Walks a level line from a half-edge that rises through the level.
    pub(super) fn walk(&self, first: u32, level: f64, mut pass: impl FnMut(u32)) -> Option<Ring> {
        let mesh = self.mesh;
        let value = |v: u32| self.field[v as usize];
        let mut points = Vec::new();
        let mut h = first;
        loop {
            pass(h);
            let (low, high) = (mesh.from(h), mesh.to(h));
            let (a, b) = (value(low), value(high));
            let t = if b > a { ((level - a) / (b - a)).clamp(0.0, 1.0) } else { 0.5 };
            points.push(mesh.above(low, high, t));
            let (next, last) = (Mesh::after(h), Mesh::before(h));
            // Of the other two edges one falls through the level.
            let out = if value(mesh.to(next)) < level { next } else { last };
            h = mesh.twins[out as usize];
            if h == NONE || points.len() > mesh.twins.len() {
                return None;
            }
            if h == first {
                return Ring::new(points);
            }
        }
    }

    /// Lines from `low` to `high` along a way, about `spacing` apart, with the phase (in turns) of each beside the one before;
    /// those of the ends are `first` and `last` where given.
    pub(super) fn stack(
        &self,
        [low, high]: [f64; 2],
        way: &[u32],
        spacing: f64,
        first: Option<Ring>,
        last: Option<&Ring>,
    ) -> Lines {
        let range = high - low;
        let least = 1e-4 * range;
        let mut rings: Vec<(Ring, f64)> = Vec::new();
        let mut at_levels = Vec::new();
        let mut at = low;
        let mut step = spacing.min(range);
        let mut samples: Option<Vec<DVec3>> = None;
        if let Some(ring) = first.or_else(|| self.line(low, way)) {
            samples = Some(ring.samples(SAMPLES, 0.0));
            rings.push((ring, 0.0));
            at_levels.push(low);
        }
        let mut missed = 0;
        while at < high && rings.len() < MOST_LEVELS && missed < MOST_MISSED {
            let mut next = at + step;
            if next + 0.4 * step >= high {
                next = high;
            }
            let ring = if next >= high {
                last.cloned().or_else(|| self.line(high, way))
            } else {
                self.line(next, way)
            };
            let Some(ring) = ring else {
                at = next;
                missed += 1;
                continue;
            };
            let (phase, placed) = samples
                .as_ref()
                .map_or_else(|| (0.0, ring.samples(SAMPLES, 0.0)), |before| ring.turned(before));
            let (mean, most) = samples.as_ref().map_or((spacing, spacing), |before| gap(before, &placed));
            let far = (mean / spacing).max(most / (2.5 * spacing));
            // The last step may be 1.4 of the least, for a shorter one would leave too little behind it.
            if far > 1.35 && next - at > 1.5 * least {
                step = ((next - at) * (0.9 / far).clamp(0.2, 0.8)).max(least);
                continue;
            }
            step = ((next - at) * (1.0 / far.max(0.3)).clamp(0.5, 2.0)).max(least);
            at = next;
            rings.push((ring, phase));
            at_levels.push(at);
            samples = Some(placed);
        }
        Lines { rings, levels: at_levels }
    }
}
