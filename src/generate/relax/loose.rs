//! The few pulls that do not lie between neighboring wales: steps and other lone edges, turns, narrow tiles, the magic
//! ring and the level of the last turn.

use super::lanes::{Matrices, Vectors};
use super::{Brink, Ends, Firm, LANES, Level, Relaxer, STEP_REST, STEP_WEIGHT, Scales, Span, TINY};
use crate::generate::sheet::{EdgeKind, Quad, Sheet, TileKind};
use glam::{DVec3, Vec3A};

/// A tile that has less than this share of its area left is pushed open, with this weight.
const NARROW: f32 = 0.3;
const NARROW_WEIGHT: f32 = 2.0;

/// How the last turn of tops is pulled toward its level, and the same where it is to be firm.
const PULL: Pull = Pull { weight: 2.8, slack: 0.29, far: 1.0 };
const FIRM_PULL: Pull = Pull { weight: 10.0, slack: 0.25, far: 1.6 };
const CLOSE_SLACK: f64 = 0.1;
/// How much higher than the helix that level lies, in rows.
const LEVEL_SHIFT: f64 = 0.15;
/// How much farther than the slack the pull grows, in this slack.
const LEVEL_CAP: f32 = 1.2;

/// A pull toward the level.
#[derive(Clone, Copy, Debug)]
struct Pull {
    weight: f64,
    /// How far a top may be off its level for nothing, and from where on the pull is no use, in rows.
    slack: f64,
    far: f64,
}

/// A tile that has little of its area left.
#[derive(Clone, Copy, Debug)]
pub(super) struct Narrow {
    corners: [usize; 4],
    /// The surface's normal there, over twice the area of a stitch.
    normal: Vec3A,
}

impl Narrow {
    /// The share of its area that the tile has, and the derivatives of that by its diagonals.
    #[inline(always)]
    fn share(&self, point: &Vectors<3>) -> (f32, Vec3A, Vec3A) {
        let [b0, b1, t0, t1] = self.corners.map(|i| point.get(i));
        let (rising, falling) = (t1 - b0, t0 - b1);
        let (by_rising, by_falling) = (falling.cross(self.normal), self.normal.cross(rising));
        (dot(rising, by_rising), by_rising, by_falling)
    }
}

#[inline]
fn dot(a: Vec3A, b: Vec3A) -> f32 {
    // In this order on every machine; the vector's own product adds in another one on some.
    let product = a * b;
    product.x + product.y + product.z
}

impl Relaxer {
    /// What loose edges and turns add to the matrices; and the narrow tiles and the level nodes, for the next few sweeps.
    pub(super) fn stiffen_loose(
        &mut self,
        stiffness: &mut Matrices,
        sheet: &Sheet,
        span: &Span,
        scales: &Scales,
        ends: &Ends<'_>,
    ) {
        let point = |i: usize| self.point.get(i);
        for edge in &self.loose.edges {
            let (a, b) = (edge.a as usize - span.low, edge.b as usize - span.low);
            let (inverse, weight) = rest(edge.kind, scales);
            let d = point(b) - point(a);
            let weight = 2.0 * weight * inverse * inverse / dot(d, d).max(TINY);
            for i in [a, b] {
                stiffness.add_outer(i, d, weight);
            }
        }
        for quad in &self.loose.turns {
            let at = quad.corners.map(|id| id as usize - span.low);
            let (_, slopes) = turn(quad, at.map(point), scales);
            for (i, slope) in at.into_iter().zip(slopes) {
                stiffness.add_outer(i, slope, 4.0 * scales.tile(quad.kind));
            }
        }
        self.narrow.clear();
        self.level.clear();
        if ends.opens || ends.level.is_some() {
            self.stiffen_narrow(stiffness, sheet, span, scales);
        }
        if let Some(Brink { rows, lag, top, firm, .. }) = ends.level {
            let pull = match firm {
                Firm::No => PULL,
                Firm::Yes => FIRM_PULL,
                Firm::Closely => Pull { slack: CLOSE_SLACK, ..FIRM_PULL },
            };
            let mut knot = rows.count as usize;
            for i in top.max(span.first)..span.end() {
                if !ends.pulls_level(sheet, i) {
                    continue;
                }
                let row = sheet.v[i] - lag;
                if (rows.tau(sheet.u[i], &mut knot) - row).abs() > pull.far {
                    continue;
                }
                let (du, dv) = (sheet.du[i], sheet.dv[i]);
                // The matrix takes the whole weight along u; that it also takes some across is no harm.
                let weight = pull.weight / sheet.height.powi(2);
                stiffness.add_outer(i - span.low, du.normalize_or_zero().as_vec3a(), weight as f32);
                let across = du - dv * (du.dot(dv) / dv.length_squared().max(1e-30));
                let dual = across / across.length_squared().max(1e-30);
                let slack = rows.at(row + pull.slack) - rows.at(row);
                self.level.push(Level {
                    slack: slack as f32,
                    node: i - span.first,
                    dual: (dual * (weight * du.length_squared())).as_vec3a(),
                    way: (rows.at(row + LEVEL_SHIFT) - sheet.u[i]) as f32,
                });
            }
        }
        if let Some((pole, count)) = ring(span, ends) {
            for i in span.fringe()..span.fringe() + count {
                let d = self.point.get(i) - pole;
                let weight = 1.0 / (scales.height * scales.height * dot(d, d).max(TINY));
                stiffness.add_outer(i, d, weight);
            }
        }
    }

    /// Finds the narrow tiles, and what they add to the matrices.
    fn stiffen_narrow(&mut self, stiffness: &mut Matrices, sheet: &Sheet, span: &Span, scales: &Scales) {
        let unit = 0.5 / (scales.width * scales.height);
        let (point, narrow) = (&self.point, &mut self.narrow);
        self.columns.for_tiles(|corners| {
            let [b0, b1, t0, t1] = corners;
            let id = b0 + span.low;
            if b0 == b1 || t0 == t1 || id < span.first {
                return;
            }
            let mut tile = Narrow { corners, normal: sheet.dv[id].cross(sheet.du[id]).as_vec3a() };
            // Most tiles are wide, and need no quotient.
            let length = dot(tile.normal, tile.normal).sqrt();
            if tile.share(point).0 * unit < 2.0 * NARROW * length {
                tile.normal *= unit / length.max(f32::MIN_POSITIVE);
                let (_, by_rising, by_falling) = tile.share(point);
                let slopes = [by_rising, by_falling, by_falling, by_rising];
                for (i, slope) in corners.into_iter().zip(slopes) {
                    stiffness.add_outer(i, slope, 4.0 * NARROW_WEIGHT);
                }
                narrow.push(tile);
            }
        });
    }

    /// Their pulls.
    pub(super) fn pull_loose(&mut self, span: &Span, scales: &Scales, ends: &Ends<'_>) {
        let (points, gradient) = (&self.point, &mut self.gradient);
        let point = |i: usize| points.get(i);
        for edge in &self.loose.edges {
            let (a, b) = (edge.a as usize - span.low, edge.b as usize - span.low);
            let (inverse, weight) = rest(edge.kind, scales);
            let d = point(b) - point(a);
            let length = dot(d, d).max(TINY).sqrt();
            let pull = d * (weight * inverse * (inverse - 1.0 / length));
            gradient.add(b, pull);
            gradient.add(a, -pull);
        }
        for quad in &self.loose.turns {
            let at = quad.corners.map(|id| id as usize - span.low);
            let (cos, slopes) = turn(quad, at.map(point), scales);
            for (i, slope) in at.into_iter().zip(slopes) {
                gradient.add(i, slope * (scales.tile(quad.kind) * cos));
            }
        }
        for tile in &self.narrow {
            let (share, by_rising, by_falling) = tile.share(points);
            if share < NARROW {
                let pull = NARROW_WEIGHT * (share - NARROW);
                let (rising, falling) = (by_rising * pull, by_falling * pull);
                let [b0, b1, t0, t1] = tile.corners;
                gradient.add(t1, rising);
                gradient.add(t0, falling);
                gradient.add(b0, -rising);
                gradient.add(b1, -falling);
            }
        }
        for level in &self.level {
            let off = self.nodes[level.node / LANES].way[0][level.node % LANES] - level.way;
            let cap = level.slack * LEVEL_CAP;
            let beyond = (off - off.clamp(-level.slack, level.slack)).clamp(-cap, cap);
            gradient.add(span.fringe() + level.node, level.dual * beyond);
        }
        if let Some((pole, count)) = ring(span, ends) {
            for i in span.fringe()..span.fringe() + count {
                let d = points.get(i) - pole;
                let length = dot(d, d).max(TINY).sqrt();
                gradient.add(i, d * ((1.0 / scales.height - 1.0 / length) / scales.height));
            }
        }
    }
}

/// The center of the magic ring, and how many of the first free nodes have their posts in it.
fn ring(span: &Span, ends: &Ends<'_>) -> Option<(Vec3A, usize)> {
    let (pole, count): (DVec3, usize) = ends.ring?;
    Some((span.local(pole), count.saturating_sub(span.first).min(span.count)))
}

/// One over the rest length of an edge, and its weight.
fn rest(kind: EdgeKind, scales: &Scales) -> (f32, f32) {
    match kind {
        EdgeKind::Course => (scales.width.recip(), 1.0),
        EdgeKind::Wale => (scales.height.recip(), 1.0),
        EdgeKind::Step => ((STEP_REST * scales.width).recip(), STEP_WEIGHT),
    }
}

/// The cosine between the middle lines of a turn's tile, and its derivative by each corner. None of the lines counts as
/// next to nothing.
fn turn(quad: &Quad, [b0, b1, t0, t1]: [Vec3A; 4], scales: &Scales) -> (f32, [Vec3A; 4]) {
    let across = 0.5 * ((b1 - b0) + (t1 - t0));
    let left = quad.kind == TileKind::TurnLeft;
    let up = if left { t0 - b0 } else { t1 - b1 };
    let up_length = dot(up, up).sqrt().max(0.3 * scales.height);
    let across_length = dot(across, across).sqrt().max(0.2 * scales.width);
    let (up, across) = (up / up_length, across / across_length);
    let cos = dot(up, across);
    let by_up = (across - up * cos) / up_length;
    let by_across = (up - across * cos) * (0.5 / across_length);
    let slopes = if left {
        [-by_up - by_across, by_across, by_up - by_across, by_across]
    } else {
        [-by_across, by_across - by_up, -by_across, by_across + by_up]
    };
    (cos, slopes)
}
