//! Relaxation on the surface: block-Jacobi Gauss-Newton with momentum; the topology stays as it is.
//!
//! Energy: the sum over course and wale edges of (length / rest - 1)^2, over step links with a small weight, and over
//! tiles of `squareness` times the squared cosine between their mid-segments. Unknowns are (u, v) of each node.

use super::rows::Rows;
use super::sheet::{Edge, EdgeKind, Quad, Sheet, TileKind};
use crate::shape::ParametricSurface;
use glam::DVec3;

/// Weight of the soft links that close the steps at short-row ends, and their rest length in stitch widths.
const STEP_WEIGHT: f64 = 0.2;
const STEP_REST: f64 = 0.9;
/// Tiles across a step count half.
const STEP_TILE: f64 = 0.5;
/// Pull of the last turn of tops toward its level.
const LEVEL_WEIGHT: f64 = 0.3;
/// Derivatives of the surface are looked up again every so many sweeps; between them points move to first order. They are
/// fresh at the start, for every relaxation leaves them so.
const REFRESH: u32 = 6;
/// Largest momentum.
const MOMENTUM: f64 = 0.85;
/// Longest step of a sweep, in stitch heights.
const LONGEST: f64 = 0.3;

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

/// What holds the ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ends<'r> {
    /// Least and greatest u that a node may take.
    pub range: [f64; 2],
    /// The magic ring: its center, and the number of nodes whose posts stand in it.
    pub ring: Option<(DVec3, usize)>,
    /// In the final relaxation, the rows that the tops of the last turn are pulled to, and where these begin.
    pub level: Option<(&'r Rows, usize)>,
}

/// How long and how square.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    pub sweeps: u32,
    pub squareness: f64,
}

/// Gradient and Gauss-Newton matrix of one node in space: six entries of a symmetric matrix.
#[derive(Clone, Copy, Default)]
struct Pull {
    g: DVec3,
    diagonal: DVec3,
    /// yz, xz, xy.
    off: DVec3,
}

impl Pull {
    #[inline]
    fn add(&mut self, gradient: DVec3, diagonal: DVec3, off: DVec3) {
        self.g += gradient;
        self.diagonal += diagonal;
        self.off += off;
    }
    #[inline]
    fn quadratic(&self, a: DVec3, b: DVec3) -> f64 {
        (a * b).dot(self.diagonal)
            + (a.y * b.z + a.z * b.y) * self.off.x
            + (a.x * b.z + a.z * b.x) * self.off.y
            + (a.x * b.y + a.y * b.x) * self.off.z
    }
}

#[inline]
fn outer(a: DVec3, weight: f64) -> (DVec3, DVec3) {
    let w = a * weight;
    (a * w, DVec3::new(a.y * w.z, a.x * w.z, a.x * w.y))
}

/// Buffers that live as long as the generation, so that a window costs no allocation.
#[derive(Default)]
pub(crate) struct Relaxer {
    pulls: Vec<Pull>,
    /// Where each free node was at the start of the sweep before.
    last: Vec<(f64, f64)>,
}

impl Relaxer {
    /// Relaxes all nodes from `from.nodes` on and leaves exact points and derivatives behind.
    pub(crate) fn relax(
        &mut self,
        surface: &dyn ParametricSurface,
        sheet: &mut Sheet,
        from: Mark,
        effort: Effort,
        ends: Ends<'_>,
    ) {
        let first = from.nodes;
        if first >= sheet.len() {
            return;
        }
        self.last.clear();
        self.last.extend(sheet.u[first..].iter().copied().zip(sheet.v[first..].iter().copied()));
        for sweep in 0..effort.sweeps {
            let momentum =
                if sweep == 0 { 0.0 } else { MOMENTUM.min(f64::from(sweep) / (f64::from(sweep) + 3.0)) };
            self.advance(
                surface,
                sheet,
                first,
                momentum,
                sweep > 0 && sweep.is_multiple_of(REFRESH),
                ends.range,
            );
            self.gather(sheet, from, effort.squareness);
            self.solve(sheet, first, &ends);
        }
        for i in first..sheet.len() {
            look(surface, sheet, i);
        }
    }

    /// Carries every node on along its last move, and brings points (and derivatives, when due) up to date.
    fn advance(
        &mut self,
        surface: &dyn ParametricSurface,
        sheet: &mut Sheet,
        first: usize,
        momentum: f64,
        refresh: bool,
        range: [f64; 2],
    ) {
        for (k, last) in self.last.iter_mut().enumerate() {
            let i = first + k;
            let now = (sheet.u[i], sheet.v[i]);
            let step = (momentum * (now.0 - last.0), momentum * (now.1 - last.1));
            *last = now;
            let u = (now.0 + step.0).clamp(range[0], range[1]);
            sheet.v[i] = now.1 + step.1;
            sheet.u[i] = u;
            if refresh {
                look(surface, sheet, i);
            } else {
                sheet.point[i] += sheet.du[i] * (u - now.0) + sheet.dv[i] * step.1;
            }
        }
    }

    /// Sums the pulls of all edges and tiles at the free nodes.
    fn gather(&mut self, sheet: &Sheet, from: Mark, squareness: f64) {
        self.pulls.clear();
        self.pulls.resize(sheet.len() - from.nodes, Pull::default());
        let pulls = &mut self.pulls[..];
        let first = from.nodes;
        for edge in &sheet.edges[from.edges..] {
            pull_edge(pulls, first, sheet, edge);
        }
        if squareness > 0.0 {
            for quad in &sheet.quads[from.quads..] {
                pull_quad(pulls, first, sheet, quad, squareness);
            }
        }
    }

    /// One damped Newton step per node in its own (u, v); points follow to first order.
    fn solve(&mut self, sheet: &mut Sheet, first: usize, ends: &Ends<'_>) {
        let longest = LONGEST * sheet.height;
        for (k, pull) in self.pulls.iter_mut().enumerate() {
            let i = first + k;
            let (du, dv) = (sheet.du[i], sheet.dv[i]);
            if let Some((pole, count)) = ends.ring
                && i < count
            {
                let d = sheet.point[i] - pole;
                let length = d.length().max(1e-9);
                let j = d / (length * sheet.height);
                let (diagonal, off) = outer(j, 1.0);
                pull.add(j * (length / sheet.height - 1.0), diagonal, off);
            }
            let (mut huu, huv, hvv) =
                (pull.quadratic(du, du), pull.quadratic(du, dv), pull.quadratic(dv, dv));
            let (mut gu, gv) = (pull.g.dot(du), pull.g.dot(dv));
            if let Some((rows, top)) = ends.level
                && i >= top
                && sheet.v[i] >= rows.count - 0.999
            {
                let speed = du.length() / sheet.height;
                huu += LEVEL_WEIGHT * speed * speed;
                gu += LEVEL_WEIGHT * speed * speed * (sheet.u[i] - rows.at(sheet.v[i]));
            }
            huu += 1e-3 * huu + 1e-12;
            let hvv = hvv + 1e-3 * hvv + 1e-12;
            let det = huu * hvv - huv * huv;
            if det <= 0.0 {
                continue;
            }
            let x = (huv * gv - hvv * gu) / det;
            let y = (huv * gu - huu * gv) / det;
            let length = (du * x + dv * y).length();
            let scale = if length > longest { longest / length } else { 1.0 };
            let u = (sheet.u[i] + x * scale).clamp(ends.range[0], ends.range[1]);
            let moved = u - sheet.u[i];
            sheet.u[i] = u;
            sheet.v[i] += y * scale;
            sheet.point[i] += du * moved + dv * (y * scale);
        }
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

#[inline]
fn pull_edge(pulls: &mut [Pull], first: usize, sheet: &Sheet, edge: &Edge) {
    let (rest, weight) = match edge.kind {
        EdgeKind::Course => (sheet.width, 1.0),
        EdgeKind::Wale => (sheet.height, 1.0),
        EdgeKind::Step => (STEP_REST * sheet.width, STEP_WEIGHT),
    };
    let (a, b) = (edge.a as usize, edge.b as usize);
    let d = sheet.point[b] - sheet.point[a];
    let length = d.length().max(1e-9);
    let j = d / (length * rest);
    let gradient = j * (weight * (length / rest - 1.0));
    // Two nodes share the residual: twice the outer product majorizes, so that no line search is needed.
    let (diagonal, off) = outer(j, 2.0 * weight);
    if b >= first {
        pulls[b - first].add(gradient, diagonal, off);
    }
    if a >= first {
        pulls[a - first].add(-gradient, diagonal, off);
    }
}

#[inline]
fn pull_quad(pulls: &mut [Pull], first: usize, sheet: &Sheet, quad: &Quad, squareness: f64) {
    let [b0, b1, t0, t1] = quad.corners.map(|id| sheet.point[id as usize]);
    let across = 0.5 * ((b1 - b0) + (t1 - t0));
    let up = match quad.kind {
        TileKind::Wales | TileKind::Step => 0.5 * ((t0 - b0) + (t1 - b1)),
        TileKind::TurnLeft => t0 - b0,
        TileKind::TurnRight => t1 - b1,
    };
    let weight = if quad.kind == TileKind::Step { STEP_TILE * squareness } else { squareness };
    let up_length = up.length().max(0.3 * sheet.height);
    let across_length = across.length().max(0.2 * sheet.width);
    let (up, across) = (up / up_length, across / across_length);
    let cos = up.dot(across);
    let by_up = (across - up * cos) / up_length;
    let by_across = (up - across * cos) * (0.5 / across_length);
    let gradients = match quad.kind {
        TileKind::Wales | TileKind::Step => {
            let by_up = 0.5 * by_up;
            let (sum, difference) = (by_up + by_across, by_up - by_across);
            [-sum, -difference, difference, sum]
        }
        TileKind::TurnLeft => [-by_up - by_across, by_across, by_up - by_across, by_across],
        TileKind::TurnRight => [-by_across, by_across - by_up, -by_across, by_across + by_up],
    };
    for (id, j) in quad.corners.into_iter().zip(gradients) {
        let i = id as usize;
        if i >= first {
            let (diagonal, off) = outer(j, 4.0 * weight);
            pulls[i - first].add(j * (weight * cos), diagonal, off);
        }
    }
}
