//! Relaxation on the surface: block-Jacobi Gauss-Newton with momentum; the topology stays as it is.
//!
//! Energy: the sum over course and wale edges of (length / rest - 1)^2, over step links with a small weight, and over
//! tiles of `squareness` times the squared cosine between their mid-segments. Unknowns are (u, v) of each node.
//!
//! Sweeps run in single precision, relative to a node of the part that relaxes: four nodes or wales at a time, and an
//! error of a ten-thousandth of a stitch at worst. The places (u, v) themselves stay in double precision, and points are
//! looked up again from them.

mod columns;
mod lanes;
mod loose;

use super::rows::Rows;
use super::sheet::{Sheet, TileKind};
use crate::shape::ParametricSurface;
use columns::{Columns, Loose};
use glam::{DVec3, Vec4, Vec4Swizzles};
use lanes::{Four, Matrices, root};

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
    columns: Columns,
    loose: Loose,
    /// Points from the lowest node that a free one hangs on, relative to `origin`, and the pull at each, or the two parts of its
    /// matrix. Both are filled up to whole blocks of free nodes.
    point: Vec<Vec4>,
    gradient: Vec<Vec4>,
    /// Blocks of four free nodes.
    nodes: Vec<Nodes>,
    /// Free tops of the last turn.
    level: Vec<Level>,
    narrow: Vec<loose::Narrow>,
}

/// Four free nodes.
#[derive(Clone, Copy, Debug, Default)]
struct Nodes {
    /// Derivatives of the surface.
    du: Four,
    dv: Four,
    /// Inverse of each node's matrix in (u, v): uu, uv, vv.
    inverse: [Vec4; 3],
    /// Where along u they were at the last look at the surface, and the way since then.
    start: Vec4,
    way: [Vec4; 2],
    /// The way of the last sweep.
    last: [Vec4; 2],
}

impl Nodes {
    #[inline]
    fn begin(&mut self, du: [Vec4; 4], dv: [Vec4; 4], u: &[f64; 4]) {
        self.du = Four::new(du);
        self.dv = Four::new(dv);
        self.way = [Vec4::ZERO; 2];
        self.start = Vec4::from_array(u.map(|u| u as f32));
    }
}

/// A node that is pulled to its level.
#[derive(Clone, Copy, Debug)]
struct Level {
    /// Index among the free nodes.
    node: usize,
    /// The change of its point whose product with `du` is one and with `dv` zero, times the weight.
    dual: Vec4,
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
    fn local(&self, point: DVec3) -> Vec4 {
        (point - self.origin).as_vec3().extend(0.0)
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
        self.nodes.resize(span.count.div_ceil(4), Nodes::default());
        self.take(sheet, &span);
        let mut refresh = REFRESH;
        for sweep in 0..effort.sweeps {
            if sweep == 0 || sweep == refresh {
                if sweep > 0 {
                    refresh *= 2;
                    self.commit(sheet, &span, ends.range);
                    for i in first..end {
                        look(surface, sheet, i);
                    }
                    self.take(sheet, &span);
                }
                self.stiffen(sheet, &span, &scales, &ends);
            }
            self.gradient.clear();
            self.gradient.resize(self.point.len(), Vec4::ZERO);
            if ends.tail() {
                self.columns.pull::<true>(&self.point, &mut self.gradient, &scales);
            } else {
                self.columns.pull::<false>(&self.point, &mut self.gradient, &scales);
            }
            self.pull_loose(&span, &scales, &ends);
            let next = sweep as f32 + 1.0;
            let momentum = if sweep + 1 == effort.sweeps { 0.0 } else { MOMENTUM.min(next / (next + 3.0)) };
            self.step(span.fringe(), momentum, LONGEST * scales.height, ends.range);
        }
        self.commit(sheet, &span, ends.range);
        let settled = first.max(exact).min(end);
        for (point, own) in sheet.point[first..settled].iter_mut().zip(&self.point[span.fringe()..]) {
            *point = span.origin + own.xyz().as_dvec3();
        }
        for i in settled..end {
            look(surface, sheet, i);
        }
    }

    /// Takes up points and derivatives; the nodes have gone no way yet.
    fn take(&mut self, sheet: &Sheet, span: &Span) {
        self.point.clear();
        self.point.extend(sheet.point[span.low..span.end()].iter().map(|point| span.local(*point)));
        self.point.resize(span.fringe() + 4 * self.nodes.len(), Vec4::ZERO);
        let vector = |d: &DVec3| d.as_vec3().extend(0.0);
        let free = sheet.du[span.first..span.end()].chunks(4).zip(sheet.dv[span.first..span.end()].chunks(4));
        let us = sheet.u[span.first..span.end()].chunks(4);
        for ((nodes, (du, dv)), u) in self.nodes.iter_mut().zip(free).zip(us) {
            if let (Ok(du), Ok(dv), Ok(u)) = (<&[_; 4]>::try_from(du), <&[_; 4]>::try_from(dv), u.try_into())
            {
                nodes.begin(du.each_ref().map(vector), dv.each_ref().map(vector), u);
            } else {
                let padded = |d: &[DVec3]| std::array::from_fn(|lane| d.get(lane).map_or(Vec4::ZERO, vector));
                let u = std::array::from_fn(|lane| u.get(lane).copied().unwrap_or_default());
                nodes.begin(padded(du), padded(dv), &u);
            }
        }
    }

    /// Writes the way of the nodes into the sheet.
    fn commit(&self, sheet: &mut Sheet, span: &Span, [low, high]: [f64; 2]) {
        let free = span.first..span.end();
        let places = sheet.u[free.clone()].chunks_mut(4).zip(sheet.v[free].chunks_mut(4));
        for ((us, vs), nodes) in places.zip(&self.nodes) {
            let [by_u, by_v] = nodes.way.map(|way| way.to_array());
            for (lane, (u, v)) in us.iter_mut().zip(vs).enumerate() {
                if by_u[lane] != 0.0 {
                    *u = (*u + f64::from(by_u[lane])).clamp(low, high);
                }
                *v += f64::from(by_v[lane]);
            }
        }
    }

    /// Takes up the inverse matrices and what else is good for a few sweeps.
    fn stiffen(&mut self, sheet: &Sheet, span: &Span, scales: &Scales, ends: &Ends<'_>) {
        // The matrices lie where the pulls will.
        let mut matrices = std::mem::take(&mut self.gradient);
        matrices.clear();
        matrices.resize(2 * self.point.len(), Vec4::ZERO);
        let stiffness = matrices.as_chunks_mut::<2>().0;
        if ends.tail() {
            self.columns.stiffen::<true>(&self.point, stiffness, scales);
        } else {
            self.columns.stiffen::<false>(&self.point, stiffness, scales);
        }
        self.stiffen_loose(stiffness, sheet, span, scales, ends);
        let own = stiffness[span.fringe()..].chunks_exact(4);
        for (nodes, own) in self.nodes.iter_mut().zip(own) {
            let part = |i: usize| Four::new([own[0][i], own[1][i], own[2][i], own[3][i]]);
            let matrices = Matrices { diagonal: part(0), off: part(1) };
            let (du, dv) = (nodes.du, nodes.dv);
            let damped = |h: Vec4| h * 1.001 + Vec4::splat(1e-12);
            let (huu, huv, hvv) = (
                damped(matrices.quadratic(du, du)),
                matrices.quadratic(du, dv),
                damped(matrices.quadratic(dv, dv)),
            );
            let det = huu * hvv - huv * huv;
            let scale = Vec4::select(det.cmpgt(Vec4::ZERO), det.recip(), Vec4::ZERO);
            nodes.inverse = [hvv * scale, -huv * scale, huu * scale];
        }
        self.gradient = matrices;
    }

    /// One damped Newton step per node in its own (u, v), and its momentum; points follow to first order.
    fn step(&mut self, fringe: usize, momentum: f32, longest: f32, range: [f64; 2]) {
        let range = range.map(|u| Vec4::splat(u as f32));
        let (momentum, longest) = (Vec4::splat(momentum), Vec4::splat(longest * longest));
        let points = self.point[fringe..].chunks_exact_mut(4);
        let gradients = self.gradient[fringe..].chunks_exact(4);
        for ((nodes, points), gradients) in self.nodes.iter_mut().zip(points).zip(gradients) {
            let Nodes { du, dv, inverse: [uu, uv, vv], start, way: [u, v], last } = *nodes;
            let (low, high) = ((range[0] - start).min(Vec4::ZERO), (range[1] - start).max(Vec4::ZERO));
            let gradient = Four::new([gradients[0], gradients[1], gradients[2], gradients[3]]);
            let (gu, gv) = (gradient.dot(du), gradient.dot(dv));
            let (x, y) = (-(uu * gu + uv * gv), -(uv * gu + vv * gv));
            let way = du.times(x) + dv.times(y);
            let length = way.dot(way).max(longest);
            let scale = root(longest / length);
            // The sweep began ahead of where the last one ended, by the momentum that it was given.
            let new_u = (u + x * scale).max(low).min(high);
            let new_v = v + y * scale;
            let ahead_u = (new_u + momentum * (new_u - u + last[0])).max(low).min(high);
            let ahead_v = new_v + momentum * (new_v - v + last[1]);
            nodes.last = [ahead_u - new_u, ahead_v - new_v];
            nodes.way = [ahead_u, ahead_v];
            let moved = du.times(ahead_u - u) + dv.times(ahead_v - v);
            for (point, way) in points.iter_mut().zip(moved.each()) {
                *point += way;
            }
        }
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
