//! Relaxation on the surface: block-Jacobi Gauss-Newton with momentum; the topology stays as it is.
//!
//! Energy: the sum over course and wale edges of (length / rest - 1)^2, over step links with a small weight, and over
//! tiles of `squareness` times the squared cosine between their mid-segments. Unknowns are (u, v) of each node.
//!
//! Sweeps run in single precision, relative to a node of the part that relaxes: many nodes or wales at a time, and an
//! error of a ten-thousandth of a stitch at worst. The places (u, v) themselves stay in double precision, and points are
//! looked up again from them.

#![expect(clippy::inline_always, reason = "what is inlined is compiled for wider instructions")]

mod chunks;
mod columns;
mod lanes;
mod loose;

use super::rows::Rows;
use super::sheet::{Sheet, TileKind};
use crate::shape::ParametricSurface;
use columns::{Columns, Loose};
use glam::{DVec3, Vec3A};
use lanes::{Matrices, Vectors, dot, larger, quadratic, smaller, square};
use pulp::{Arch, NullaryFnOnce};

/// Weight of the soft links that close the steps at short-row ends, and their rest length in stitch widths.
pub(super) const STEP_WEIGHT: f32 = 0.2;
pub(super) const STEP_REST: f32 = 0.9;
/// So many shares have tiles; those across a step count half.
const SHARES: u8 = 2;
/// The last turn of tops begins a hair behind a whole turn before the end.
const LAST_TURN: f64 = 0.999;
/// The same where the pull is firm: with those that will be the last when a sliver of a round has been taken off.
const LAST_TURNS: f64 = LAST_TURN + super::top::SLIVER;
/// Derivatives of the surface and the matrices are taken anew after so many sweeps, and then after twice as many each time;
/// between them points move to first order.
const REFRESH: u32 = 7;
/// Largest momentum.
const MOMENTUM: f32 = 0.85;
/// Longest step of a sweep, in stitch heights.
const LONGEST: f32 = 0.3;
/// Nodes are moved so many at a time.
const LANES: usize = 8;
/// Squares of lengths below this count as this, against quotients of nothing.
const TINY: f32 = 1e-18;

/// Where a relaxation begins: everything added to the sheet since then is free.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Mark {
    pub nodes: usize,
    pub edges: usize,
    pub quads: usize,
}

impl Mark {
    pub(crate) fn of(sheet: &Sheet) -> Self {
        Self { nodes: sheet.len(), edges: sheet.edges.len(), quads: sheet.quads.len() }
    }
}

/// What is free to move: all that was added to a sheet between two marks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stretch {
    pub from: Mark,
    pub until: Mark,
}

impl Stretch {
    /// From a mark to the end.
    pub(crate) fn since(from: Mark, sheet: &Sheet) -> Self {
        Self { from, until: Mark::of(sheet) }
    }
}

/// What holds the ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ends<'r> {
    /// Least and greatest u that a node may take.
    pub range: [f64; 2],
    /// The magic ring: its center, and the number of nodes whose posts stand in it.
    pub ring: Option<(DVec3, usize)>,
    /// In the final relaxation, what the tops of the last turn are pulled to.
    pub level: Option<Brink<'r>>,
    /// Narrow tiles are pushed open also before.
    pub opens: bool,
}

/// The last turn of tops, which settles level.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Brink<'r> {
    pub rows: &'r Rows,
    /// By how many rows they lie behind their helix.
    pub lag: f64,
    /// Where these tops begin; with none, the sweeps are final and there is no pull.
    pub top: usize,
    pub firm: Firm,
    /// Long and short edges pull more than in proportion, so that few are far off.
    pub tail: bool,
}

/// How hard the last turn is pulled to its level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Firm {
    No,
    /// Hard, also far away.
    Yes,
    /// So, and with little slack.
    Closely,
}

impl Ends<'_> {
    fn tail(&self) -> bool {
        self.level.is_some_and(|level| level.tail)
    }
}

/// How long and how square.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    pub sweeps: u32,
    pub squareness: f64,
}

/// Sizes and weights of a relaxation.
#[derive(Clone, Copy, Debug)]
struct Scales {
    width: f32,
    height: f32,
    squareness: f32,
}

impl Scales {
    #[inline]
    fn tile(&self, kind: TileKind) -> f32 {
        self.squareness * (f32::from(shares(kind)) / f32::from(SHARES))
    }
}

/// The weight of a tile in shares.
#[inline]
fn shares(kind: TileKind) -> u8 {
    if kind == TileKind::Step { SHARES / 2 } else { SHARES }
}

/// Buffers that live as long as the generation, so that a window costs no allocation.
#[derive(Default)]
pub(crate) struct Relaxer {
    /// How wide the instructions are.
    arch: Arch,
    columns: Columns,
    loose: Loose,
    /// Points from the lowest node that a free one hangs on, relative to `origin`, the pull at each, and its matrix. All are filled
    /// up to whole blocks of free nodes.
    point: Vectors<3>,
    gradient: Vectors<3>,
    stiffness: Matrices,
    /// Blocks of free nodes.
    nodes: Vec<Nodes>,
    /// Free tops of the last turn.
    level: Vec<Level>,
    narrow: Vec<loose::Narrow>,
}

/// A number of each node of a block.
type Each = [f32; LANES];

/// A block of free nodes.
#[derive(Clone, Copy, Debug, Default)]
struct Nodes {
    /// Derivatives of the surface.
    du: [Each; 3],
    dv: [Each; 3],
    /// Inverse of each node's matrix in (u, v): uu, uv, vv.
    inverse: [Each; 3],
    /// Where along u they were at the last look at the surface, and the way since then.
    start: Each,
    way: [Each; 2],
    /// The way of the last sweep.
    last: [Each; 2],
}

impl Nodes {
    /// Takes up the inverse of each matrix, between the derivatives.
    #[inline(always)]
    fn invert(&mut self, matrices: [&Each; 6]) {
        for k in 0..LANES {
            let at = |axes: &[Each; 3]| [axes[0][k], axes[1][k], axes[2][k]];
            let (du, dv, matrix) = (at(&self.du), at(&self.dv), matrices.map(|axis| axis[k]));
            let damped = |h: f32| h * 1.001 + 1e-12;
            let (huu, huv, hvv) = (
                damped(quadratic(matrix, du, du)),
                quadratic(matrix, du, dv),
                damped(quadratic(matrix, dv, dv)),
            );
            let det = huu * hvv - huv * huv;
            // Without a branch, so that many are inverted at a time.
            let scale = f32::from(u8::from(det > 0.0)) / larger(det, f32::MIN_POSITIVE);
            self.inverse[0][k] = hvv * scale;
            self.inverse[1][k] = -huv * scale;
            self.inverse[2][k] = huu * scale;
        }
    }

    /// One damped Newton step per node in its own (u, v), and its momentum; points follow to first order.
    #[inline(always)]
    fn step(&mut self, points: [&mut Each; 3], gradients: [&Each; 3], stride: &Stride) {
        let mut moved = [Each::default(); 3];
        for k in 0..LANES {
            let at = |axes: &[Each; 3]| [axes[0][k], axes[1][k], axes[2][k]];
            let (du, dv, [uu, uv, vv]) = (at(&self.du), at(&self.dv), at(&self.inverse));
            let gradient = [gradients[0][k], gradients[1][k], gradients[2][k]];
            let along = |by_u: f32, by_v: f32| std::array::from_fn(|axis| du[axis] * by_u + dv[axis] * by_v);
            let (low, high) =
                (smaller(stride.range[0] - self.start[k], 0.0), larger(stride.range[1] - self.start[k], 0.0));
            let (gu, gv) = (dot(gradient, du), dot(gradient, dv));
            let (x, y) = (-(uu * gu + uv * gv), -(uv * gu + vv * gv));
            let length = larger(square(along(x, y)), stride.longest);
            let scale = (stride.longest / length).sqrt();
            // The sweep began ahead of where the last one ended, by the momentum that it was given.
            let (u, v) = (self.way[0][k], self.way[1][k]);
            let new_u = smaller(larger(u + x * scale, low), high);
            let new_v = v + y * scale;
            let ahead_u = smaller(larger(new_u + stride.momentum * (new_u - u + self.last[0][k]), low), high);
            let ahead_v = new_v + stride.momentum * (new_v - v + self.last[1][k]);
            self.last[0][k] = ahead_u - new_u;
            self.last[1][k] = ahead_v - new_v;
            self.way[0][k] = ahead_u;
            self.way[1][k] = ahead_v;
            let way: [f32; 3] = along(ahead_u - u, ahead_v - v);
            for (moved, way) in moved.iter_mut().zip(way) {
                moved[k] = way;
            }
        }
        for (points, moved) in points.into_iter().zip(moved) {
            for (point, moved) in points.iter_mut().zip(moved) {
                *point += moved;
            }
        }
    }
}

/// How far a sweep goes.
struct Stride {
    momentum: f32,
    /// Longest step, squared.
    longest: f32,
    range: [f32; 2],
}

/// A node that is pulled to its level.
#[derive(Clone, Copy, Debug)]
struct Level {
    /// Index among the free nodes.
    node: usize,
    /// The change of its point whose product with `du` is one and with `dv` zero, times the weight.
    dual: Vec3A,
    /// The way along u to its level, and how far off it may stay.
    way: f32,
    slack: f32,
}

/// Where the part that relaxes lies in the sheet.
#[derive(Clone, Copy)]
struct Span {
    /// The least node that a point is kept of, and the first free one.
    low: usize,
    first: usize,
    count: usize,
    origin: DVec3,
}

impl Span {
    fn end(&self) -> usize {
        self.first + self.count
    }
    /// Kept nodes before the first free one.
    fn fringe(&self) -> usize {
        self.first - self.low
    }
    fn local(&self, point: DVec3) -> Vec3A {
        (point - self.origin).as_vec3a()
    }
}

impl Relaxer {
    /// Relaxes the nodes of a stretch. Those from `exact` on have exact points and derivatives in the end; those
    /// before stay where the last look at the surface put them, to first order.
    pub(crate) fn relax(
        &mut self,
        surface: &dyn ParametricSurface,
        sheet: &mut Sheet,
        Stretch { from, until }: Stretch,
        exact: usize,
        effort: Effort,
        ends: Ends<'_>,
    ) {
        let (first, end) = (from.nodes, until.nodes);
        if effort.sweeps == 0 || first >= end {
            for i in first.max(exact)..end {
                look(surface, sheet, i);
            }
            return;
        }
        let (edges, quads) = (&sheet.edges[from.edges..until.edges], &sheet.quads[from.quads..until.quads]);
        let scales = Scales {
            width: sheet.width as f32,
            height: sheet.height as f32,
            squareness: effort.squareness as f32,
        };
        let low = self.columns.take(edges, quads, first, &mut self.loose);
        let span = Span { low, first, count: end - first, origin: sheet.point[first] };
        self.nodes.clear();
        self.nodes.resize(span.count.div_ceil(LANES), Nodes::default());
        self.arch.dispatch(Sweeps { relaxer: self, surface, sheet, span, scales, effort, ends });
        self.commit(sheet, &span, ends.range);
        let settled = first.max(exact).min(end);
        for (i, point) in (span.fringe()..).zip(&mut sheet.point[first..settled]) {
            *point = span.origin + self.point.get(i).as_dvec3();
        }
        for i in settled..end {
            look(surface, sheet, i);
        }
    }

    /// All sweeps of a relaxation.
    #[inline(always)]
    fn sweep(
        &mut self,
        surface: &dyn ParametricSurface,
        sheet: &mut Sheet,
        span: &Span,
        scales: &Scales,
        effort: Effort,
        ends: &Ends<'_>,
    ) {
        self.take(sheet, span);
        let mut refresh = REFRESH;
        for sweep in 0..effort.sweeps {
            if sweep == 0 || sweep == refresh {
                if sweep > 0 {
                    refresh *= 2;
                    self.commit(sheet, span, ends.range);
                    for i in span.first..span.end() {
                        look(surface, sheet, i);
                    }
                    self.take(sheet, span);
                }
                self.stiffen(sheet, span, scales, ends);
            }
            self.gradient.reset(self.point.len());
            if ends.tail() {
                self.columns.pull::<true>(&self.point, &mut self.gradient, scales);
            } else {
                self.columns.pull::<false>(&self.point, &mut self.gradient, scales);
            }
            self.pull_loose(span, scales, ends);
            let next = sweep as f32 + 1.0;
            let momentum = if sweep + 1 == effort.sweeps { 0.0 } else { MOMENTUM.min(next / (next + 3.0)) };
            let longest = (LONGEST * scales.height).powi(2);
            self.step(span.fringe(), &Stride { momentum, longest, range: ends.range.map(|u| u as f32) });
        }
    }

    /// Takes up points and derivatives; the nodes have gone no way yet.
    fn take(&mut self, sheet: &Sheet, span: &Span) {
        let count = span.fringe() + LANES * self.nodes.len();
        self.point.refill(sheet.point[span.low..span.end()].iter().map(|point| span.local(*point)), count);
        let free = span.first..span.end();
        let derivatives = sheet.du[free.clone()].chunks(LANES).zip(sheet.dv[free.clone()].chunks(LANES));
        let places = derivatives.zip(sheet.u[free].chunks(LANES));
        for (nodes, ((du, dv), u)) in self.nodes.iter_mut().zip(places) {
            *nodes = Nodes { inverse: nodes.inverse, last: nodes.last, ..Nodes::default() };
            for (k, ((du, dv), u)) in du.iter().zip(dv).zip(u).enumerate() {
                for axis in 0..3 {
                    nodes.du[axis][k] = du[axis] as f32;
                    nodes.dv[axis][k] = dv[axis] as f32;
                }
                nodes.start[k] = *u as f32;
            }
        }
    }

    /// Writes the way of the nodes into the sheet.
    fn commit(&self, sheet: &mut Sheet, span: &Span, [low, high]: [f64; 2]) {
        let free = span.first..span.end();
        let places = sheet.u[free.clone()].chunks_mut(LANES).zip(sheet.v[free].chunks_mut(LANES));
        for ((us, vs), nodes) in places.zip(&self.nodes) {
            let ways = nodes.way[0].into_iter().zip(nodes.way[1]);
            for ((u, v), (by_u, by_v)) in us.iter_mut().zip(vs).zip(ways) {
                if by_u != 0.0 {
                    *u = (*u + f64::from(by_u)).clamp(low, high);
                }
                *v += f64::from(by_v);
            }
        }
    }

    /// Takes up the inverse matrices and what else is good for a few sweeps.
    #[inline(always)]
    fn stiffen(&mut self, sheet: &Sheet, span: &Span, scales: &Scales, ends: &Ends<'_>) {
        let mut stiffness = std::mem::take(&mut self.stiffness);
        stiffness.reset(self.point.len());
        if ends.tail() {
            self.columns.stiffen::<true>(&self.point, &mut stiffness, scales);
        } else {
            self.columns.stiffen::<false>(&self.point, &mut stiffness, scales);
        }
        self.stiffen_loose(&mut stiffness, sheet, span, scales, ends);
        let own = stiffness.axes(span.fringe()).map(|axis| axis.as_chunks().0);
        for (block, nodes) in self.nodes.iter_mut().enumerate() {
            nodes.invert(own.map(|axis| &axis[block]));
        }
        self.stiffness = stiffness;
    }

    /// A step of each node.
    #[inline(always)]
    fn step(&mut self, fringe: usize, stride: &Stride) {
        let [x, y, z] = self.point.axes_mut(fringe).map(|axis| axis.as_chunks_mut::<LANES>().0);
        let [gx, gy, gz] = self.gradient.axes(fringe).map(|axis| axis.as_chunks::<LANES>().0);
        let points = x.iter_mut().zip(y).zip(z);
        let gradients = gx.iter().zip(gy).zip(gz);
        for ((nodes, ((x, y), z)), ((gx, gy), gz)) in self.nodes.iter_mut().zip(points).zip(gradients) {
            nodes.step([x, y, z], [gx, gy, gz], stride);
        }
    }
}

/// All sweeps of a relaxation, compiled once for processors with wider instructions. These round as the others do.
struct Sweeps<'r, 's, 'e> {
    relaxer: &'r mut Relaxer,
    surface: &'s dyn ParametricSurface,
    sheet: &'r mut Sheet,
    span: Span,
    scales: Scales,
    effort: Effort,
    ends: Ends<'e>,
}

impl NullaryFnOnce for Sweeps<'_, '_, '_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { relaxer, surface, sheet, span, scales, effort, ends } = self;
        relaxer.sweep(surface, sheet, &span, &scales, effort, &ends);
    }
}

impl Ends<'_> {
    /// The node is among the tops of the last turn, which settle level.
    #[inline]
    fn pulls_level(&self, sheet: &Sheet, i: usize) -> bool {
        self.level.is_some_and(|brink| {
            let turn = if brink.firm == Firm::No { LAST_TURN } else { LAST_TURNS };
            i >= brink.top && sheet.v[i] >= brink.rows.count + brink.lag - turn
        })
    }
}

/// Brings a node's point and derivatives up to date.
#[inline]
fn look(surface: &dyn ParametricSurface, sheet: &mut Sheet, i: usize) {
    let jet = surface.jet(sheet.u[i], sheet.v[i]);
    sheet.point[i] = jet.point;
    sheet.du[i] = jet.du;
    sheet.dv[i] = jet.dv;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::sheet::{Foot, Shaped};
    use crate::ir::{Gauge, NodeId};
    use crate::shape::analytic::TorusArc;

    /// Rounds on a bent tube, crooked, with two tops on every seventh base.
    fn crooked(surface: &dyn ParametricSurface) -> Sheet {
        let mut sheet = Sheet::new(&Gauge::new(2.0, 2.0), 500);
        let add = |sheet: &mut Sheet, round: usize, place: usize, of: usize| {
            let jolt = ((round * 31 + place * 17) % 11) as f64 / 11.0 - 0.5;
            let (u, v) = (0.1 + 0.05 * round as f64 + 0.02 * jolt, (place as f64 + 0.6 * jolt) / of as f64);
            let jet = surface.jet(u, v);
            sheet.add(&Foot { u, v, point: jet.point, du: jet.du, dv: jet.dv, ..Foot::default() }, Shaped::No)
        };
        let mut bases: Vec<NodeId> = (0..19).map(|place| add(&mut sheet, 0, place, 19)).collect();
        for round in 1..12 {
            let pairs: Vec<NodeId> = bases
                .iter()
                .enumerate()
                .flat_map(|(k, base)| vec![*base; 1 + usize::from(k % 7 == 6)])
                .collect();
            let mut before = None;
            let mut tops: Vec<NodeId> = Vec::new();
            for (place, base) in pairs.iter().enumerate() {
                let top = add(&mut sheet, round, place, pairs.len());
                if let Some(last) = tops.last() {
                    sheet.course(*last, top);
                }
                sheet.wale(before, *base, top);
                before = Some((*base, top));
                tops.push(top);
            }
            bases = tops;
        }
        sheet
    }

    #[test]
    fn wide_instructions_give_the_same_bits() {
        let surface = TorusArc { major: 30.0, minor: 7.0, angle: 1.5 };
        let settled = |arch: Arch, tail: bool| {
            let mut sheet = crooked(&surface);
            let mut relaxer = Relaxer { arch, ..Relaxer::default() };
            let all = Stretch::since(Mark { nodes: 19, ..Mark::default() }, &sheet);
            let rows = &Rows::new(&surface, [0.0; 2], &Gauge::new(2.0, 2.0)).unwrap();
            let level = Some(Brink { rows, lag: 0.0, top: usize::MAX, firm: Firm::No, tail });
            let ends = Ends { range: [0.0, 1.0], ring: None, level, opens: true };
            relaxer.relax(&surface, &mut sheet, all, 0, Effort { sweeps: 20, squareness: 0.3 }, ends);
            sheet.u.iter().chain(&sheet.v).map(|x| x.to_bits()).collect::<Vec<u64>>()
        };
        let before: Vec<u64> =
            crooked(&surface).u.iter().chain(&crooked(&surface).v).map(|x| x.to_bits()).collect();
        for tail in [false, true] {
            let narrow = settled(Arch::Scalar, tail);
            assert_eq!(narrow, settled(Arch::new(), tail));
            let moved = narrow.iter().zip(&before).filter(|(a, b)| a != b).count();
            assert!(moved > before.len() / 2, "{moved} of {}", before.len());
        }
    }
}
