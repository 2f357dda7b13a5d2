//! Relaxation on the surface: block-Jacobi Gauss-Newton with momentum; the topology stays as it is.
//!
//! Energy: the sum over course and wale edges of (length / rest - 1)^2, over step links with a small weight, and over
//! tiles of `squareness` times the squared cosine between their mid-segments. Unknowns are (u, v) of each node.
//!
//! Sweeps run in single precision, relative to a node of the part that relaxes: four lanes to a vector, and an error of a
//! ten-thousandth of a stitch at worst. The places (u, v) themselves stay in double precision, and points are looked up
//! again from them.

use super::rows::Rows;
use super::sheet::{Edge, Quad, Sheet, TileKind};
use crate::shape::ParametricSurface;
use glam::{DVec3, Vec3A, Vec3Swizzles};

/// Weight of the soft links that close the steps at short-row ends, and their rest length in stitch widths.
const STEP_WEIGHT: f32 = 0.2;
const STEP_REST: f64 = 0.9;
/// Tiles across a step count half.
const STEP_TILE: f32 = 0.5;
/// In the final sweeps a tile that has less than this share of its area left is pushed open, with this weight.
const NARROW: f32 = 0.3;
const NARROW_WEIGHT: f32 = 2.0;
/// Pull of the last turn of tops toward its level.
const LEVEL_WEIGHT: f64 = 0.3;
/// The last turn of tops begins a hair behind a whole turn before the end.
const LAST_TURN: f64 = 0.999;
/// Derivatives of the surface and the matrices are taken anew every so many sweeps; between them points move to first
/// order.
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

#[inline]
fn dot(a: Vec3A, b: Vec3A) -> f32 {
    // In this order on every machine; the vector's own product adds in another one on some.
    let product = a * b;
    product.x + product.y + product.z
}

/// Gauss-Newton matrix of one node in space: six entries of a symmetric matrix.
#[derive(Clone, Copy, Default)]
struct Stiffness {
    diagonal: Vec3A,
    /// yz, zx, xy.
    off: Vec3A,
}

impl Stiffness {
    /// Adds `weight` times the outer product of a vector with itself.
    #[inline]
    fn add(&mut self, a: Vec3A, weight: f32) {
        let w = a * weight;
        self.diagonal += a * w;
        self.off += a.yzx() * w.zxy();
    }
    #[inline]
    fn quadratic(&self, a: Vec3A, b: Vec3A) -> f64 {
        let (turned_a, turned_b) = (a.zxy(), b.zxy());
        let (next_a, next_b) = (a.yzx(), b.yzx());
        f64::from(dot(a * b, self.diagonal) + dot(next_a * turned_b + turned_a * next_b, self.off))
    }
}

/// Buffers that live as long as the generation, so that a window costs no allocation.
#[derive(Default)]
pub(crate) struct Relaxer {
    /// Points from the lowest node that a free one hangs on.
    point: Vec<Vec3A>,
    /// From the first free node on: derivatives of the surface, gradient and matrix.
    du: Vec<Vec3A>,
    dv: Vec<Vec3A>,
    gradient: Vec<Vec3A>,
    stiffness: Vec<Stiffness>,
    /// Inverse of each node's matrix in (u, v): uu, uv, vv.
    inverse: Vec<[f32; 3]>,
    /// The way of each node in its last sweep.
    last: Vec<[f64; 2]>,
    /// For each tile the factor from the difference of its squared diagonals to its cosine, doubled.
    slant: Vec<f32>,
}

/// What one edge asks for: one over its rest length, and its weight.
#[derive(Clone, Copy)]
struct Rest {
    inverse: f32,
    weight: f32,
}

/// The part of a sheet that relaxes.
#[derive(Clone, Copy)]
struct Field<'s> {
    edges: &'s [Edge],
    quads: &'s [Quad],
    rests: [Rest; 3],
    /// The least node that a point is kept of, and the number of those before the first free one.
    low: usize,
    fringe: usize,
    origin: DVec3,
    width: f32,
    height: f32,
    squareness: f32,
    /// Narrow tiles are pushed open.
    opens: bool,
    /// The magic ring: its center, and how many of the free nodes have their posts in it.
    ring: Option<(Vec3A, usize)>,
}

impl Relaxer {
    /// Relaxes all nodes from `from.nodes` on. Nodes from `exact` on have exact points and derivatives in the end; those
    /// before stay where the last look at the surface put them, to first order.
    pub(crate) fn relax(
        &mut self,
        surface: &dyn ParametricSurface,
        sheet: &mut Sheet,
        from: Mark,
        exact: usize,
        effort: Effort,
        ends: Ends<'_>,
    ) {
        let first = from.nodes;
        if first >= sheet.len() {
            return;
        }
        // The edges are looked up anew in each sweep, for the sheet changes in between.
        let edges = std::mem::take(&mut sheet.edges);
        let quads = std::mem::take(&mut sheet.quads);
        let mut field = Field::new(
            sheet,
            &edges[from.edges..],
            &quads[from.quads..],
            first,
            effort.squareness,
            ends.ring,
        );
        field.opens = ends.level.is_some();
        self.last.clear();
        self.last.resize(sheet.len() - first, [0.0; 2]);
        self.point.clear();
        self.point.extend(sheet.point[field.low..].iter().map(|point| (*point - field.origin).as_vec3a()));
        for sweep in 0..effort.sweeps {
            if sweep.is_multiple_of(REFRESH) {
                if sweep > 0 {
                    for i in first..sheet.len() {
                        look(surface, sheet, i);
                    }
                    let points = sheet.point[first..].iter();
                    self.point.truncate(field.fringe);
                    self.point.extend(points.map(|point| (*point - field.origin).as_vec3a()));
                }
                self.stiffen(sheet, &field, &ends);
            }
            self.pull(&field);
            let next = f64::from(sweep) + 1.0;
            let momentum = if sweep + 1 == effort.sweeps { 0.0 } else { MOMENTUM.min(next / (next + 3.0)) };
            self.step(sheet, first, field.fringe, momentum, &ends);
        }
        let settled = first.max(exact).min(sheet.len());
        for (point, own) in sheet.point[first..settled].iter_mut().zip(&self.point[field.fringe..]) {
            *point = field.origin + own.as_dvec3();
        }
        (sheet.edges, sheet.quads) = (edges, quads);
        for i in settled..sheet.len() {
            look(surface, sheet, i);
        }
    }

    /// Takes up the derivatives, the slants of the tiles and the inverse matrices, all good for a few sweeps.
    fn stiffen(&mut self, sheet: &Sheet, field: &Field<'_>, ends: &Ends<'_>) {
        let first = field.low + field.fringe;
        self.du.clear();
        self.du.extend(sheet.du[first..].iter().map(|d| d.as_vec3a()));
        self.dv.clear();
        self.dv.extend(sheet.dv[first..].iter().map(|d| d.as_vec3a()));
        self.stiffness.clear();
        self.stiffness.resize(sheet.len() - first, Stiffness::default());
        let (point, stiffness) = (&self.point[..], &mut self.stiffness[..]);
        // Two nodes share the residual of an edge, four that of a tile: that many times the outer product majorizes, so that
        // no line search is needed.
        for edge in field.edges {
            let (a, b) = (edge.a as usize, edge.b as usize);
            let rest = field.rests[edge.kind as usize];
            let d = point[b - field.low] - point[a - field.low];
            let weight = 2.0 * rest.weight * rest.inverse * rest.inverse / dot(d, d).max(1e-18);
            for i in [a, b] {
                if let Some(own) = stiffness.get_mut(i.wrapping_sub(first)) {
                    own.add(d, weight);
                }
            }
        }
        self.slant.clear();
        if field.squareness > 0.0 {
            for quad in field.quads {
                let (slant, gradients) = field.slope(point, quad);
                self.slant.push(slant);
                if field.opens
                    && let Some((share, by_rising, by_falling)) = field.open(point, &self.du, &self.dv, quad)
                    && share < 2.0 * NARROW
                {
                    let slopes = [by_rising, by_falling, by_falling, by_rising];
                    for (id, slope) in quad.corners.into_iter().zip(slopes) {
                        if let Some(own) = stiffness.get_mut((id as usize).wrapping_sub(first)) {
                            own.add(slope, 4.0 * NARROW_WEIGHT);
                        }
                    }
                }
                let weight = 4.0 * field.weight(quad.kind);
                for (id, d) in quad.corners.into_iter().zip(gradients) {
                    if let Some(own) = stiffness.get_mut((id as usize).wrapping_sub(first)) {
                        own.add(d, weight);
                    }
                }
            }
        }
        if let Some((pole, count)) = field.ring {
            for (own, point) in stiffness.iter_mut().zip(&point[field.fringe..]).take(count) {
                let d = *point - pole;
                own.add(d, 1.0 / (field.height * field.height * dot(d, d).max(1e-18)));
            }
        }
        self.inverse.clear();
        self.inverse.extend(stiffness.iter().zip(&self.du).zip(&self.dv).enumerate().map(
            |(k, ((own, &du), &dv))| {
                let (mut huu, huv, hvv) =
                    (own.quadratic(du, du), own.quadratic(du, dv), own.quadratic(dv, dv));
                if ends.pulls_level(sheet, first + k) {
                    huu += LEVEL_WEIGHT * sheet.du[first + k].length_squared() / sheet.height.powi(2);
                }
                let (huu, hvv) = (1.001 * huu + 1e-12, 1.001 * hvv + 1e-12);
                let det = huu * hvv - huv * huv;
                let scale = if det > 0.0 { 1.0 / det } else { 0.0 };
                [(hvv * scale) as f32, (-huv * scale) as f32, (huu * scale) as f32]
            },
        ));
    }

    /// Sums the pulls of all edges and tiles at the free nodes.
    fn pull(&mut self, field: &Field<'_>) {
        let Field { low, fringe, .. } = *field;
        let point = &self.point[..];
        self.gradient.clear();
        self.gradient.resize(point.len(), Vec3A::ZERO);
        // Same length, so that one check serves both. What the fringe gets is not looked at.
        let gradient = &mut self.gradient[..point.len()];
        for edge in field.edges {
            let (a, b) = (edge.a as usize - low, edge.b as usize - low);
            let rest = field.rests[edge.kind as usize];
            let d = point[b] - point[a];
            let length = dot(d, d).sqrt().max(1e-9);
            let pull = d * (rest.weight * rest.inverse * (rest.inverse - 1.0 / length));
            gradient[b] += pull;
            gradient[a] -= pull;
        }
        for (quad, slant) in field.quads.iter().zip(&self.slant) {
            let weight = field.weight(quad.kind);
            let [b0, b1, t0, t1] = quad.corners.map(|id| id as usize - low);
            if matches!(quad.kind, TileKind::TurnLeft | TileKind::TurnRight) {
                field.pull_turn(point, quad, gradient);
                continue;
            }
            if field.opens
                && let Some((share, by_rising, by_falling)) = field.open(point, &self.du, &self.dv, quad)
                && share < NARROW
            {
                let (rising, falling) = (
                    by_rising * (NARROW_WEIGHT * (share - NARROW)),
                    by_falling * (NARROW_WEIGHT * (share - NARROW)),
                );
                gradient[t1] += rising;
                gradient[t0] += falling;
                gradient[b0] -= rising;
                gradient[b1] -= falling;
            }
            let (rising, falling) = (point[t1] - point[b0], point[t0] - point[b1]);
            let pull = 0.5 * weight * slant * slant * (dot(rising, rising) - dot(falling, falling));
            let (rising, falling) = (rising * pull, falling * pull);
            gradient[t1] += rising;
            gradient[t0] -= falling;
            gradient[b0] -= rising;
            gradient[b1] += falling;
        }
        if let Some((pole, count)) = field.ring {
            for (own, point) in gradient[fringe..].iter_mut().zip(&point[fringe..]).take(count) {
                let d = *point - pole;
                let length = dot(d, d).sqrt().max(1e-9);
                *own += d * ((1.0 / field.height - 1.0 / length) / field.height);
            }
        }
    }

    /// One damped Newton step per node in its own (u, v), and its momentum; points follow to first order.
    fn step(&mut self, sheet: &mut Sheet, first: usize, fringe: usize, momentum: f64, ends: &Ends<'_>) {
        let longest = (LONGEST * sheet.height).powi(2) as f32;
        let [low, high] = ends.range;
        let level = ends.level.map_or(usize::MAX, |(_, top)| top);
        let gradients = self.gradient[fringe..].iter();
        let points = self.point[fringe..].iter_mut();
        let surface = self.du.iter().zip(&self.dv);
        let places = sheet.u[first..].iter_mut().zip(&mut sheet.v[first..]);
        let nodes = gradients.zip(points).zip(surface).zip(places).zip(&self.inverse).zip(&mut self.last);
        for (k, (((((gradient, point), (&du, &dv)), (u, v)), inverse), last)) in nodes.enumerate() {
            let (mut gu, gv) = (dot(*gradient, du), dot(*gradient, dv));
            if first + k >= level
                && let Some((rows, _)) = ends.level
                && *v >= rows.count - LAST_TURN
            {
                let speed = f64::from(dot(du, du)) / (sheet.height * sheet.height);
                gu += (LEVEL_WEIGHT * speed * (*u - rows.at(*v))) as f32;
            }
            let (mut x, mut y) = (-(inverse[0] * gu + inverse[1] * gv), -(inverse[1] * gu + inverse[2] * gv));
            let way = du * x + dv * y;
            let length = dot(way, way);
            if length > longest {
                let scale = (longest / length).sqrt();
                (x, y) = (x * scale, y * scale);
            }
            // The sweep began ahead of where the last one ended, by the momentum that it was given.
            let (new_u, new_v) = ((*u + f64::from(x)).clamp(low, high), *v + f64::from(y));
            let whole = [new_u - *u + last[0], new_v - *v + last[1]];
            *last = [momentum * whole[0], momentum * whole[1]];
            let ahead = (new_u + last[0]).clamp(low, high);
            last[0] = ahead - new_u;
            *point += du * ((ahead - *u) as f32) + dv * ((new_v + last[1] - *v) as f32);
            *u = ahead;
            *v = new_v + last[1];
        }
    }
}

impl<'s> Field<'s> {
    fn new(
        sheet: &Sheet,
        edges: &'s [Edge],
        quads: &'s [Quad],
        first: usize,
        squareness: f64,
        ring: Option<(DVec3, usize)>,
    ) -> Self {
        let rest = |length: f64, weight| Rest { inverse: (1.0 / length) as f32, weight };
        let low = edges.iter().fold(first, |low, edge| low.min(edge.a as usize).min(edge.b as usize));
        let low = quads
            .iter()
            .fold(low, |low, quad| quad.corners.iter().fold(low, |low, &id| low.min(id as usize)));
        let origin = sheet.point[first];
        Self {
            edges,
            quads,
            rests: [
                rest(sheet.width, 1.0),
                rest(sheet.height, 1.0),
                rest(STEP_REST * sheet.width, STEP_WEIGHT),
            ],
            low,
            fringe: first - low,
            origin,
            width: sheet.width as f32,
            height: sheet.height as f32,
            squareness: squareness as f32,
            opens: false,
            ring: ring.map(|(pole, count)| ((pole - origin).as_vec3a(), count.saturating_sub(first))),
        }
    }

    #[inline]
    fn weight(&self, kind: TileKind) -> f32 {
        if kind == TileKind::Step { STEP_TILE * self.squareness } else { self.squareness }
    }

    /// The middle lines of a tile: up and across, and their lengths, none of them next to nothing.
    #[inline]
    fn middle(&self, point: &[Vec3A], quad: &Quad) -> (Vec3A, Vec3A, f32, f32) {
        let [b0, b1, t0, t1] = quad.corners.map(|id| point[id as usize - self.low]);
        let across = 0.5 * ((b1 - b0) + (t1 - t0));
        let up = match quad.kind {
            TileKind::Wales | TileKind::Step => 0.5 * ((t0 - b0) + (t1 - b1)),
            TileKind::TurnLeft => t0 - b0,
            TileKind::TurnRight => t1 - b1,
        };
        let (up_length, across_length) = (dot(up, up).sqrt(), dot(across, across).sqrt());
        (up, across, up_length.max(0.3 * self.height), across_length.max(0.2 * self.width))
    }

    /// The area of a tile with four corners seen from outside, as a share of a stitch, and its derivatives by the diagonals.
    #[inline]
    fn open(&self, point: &[Vec3A], du: &[Vec3A], dv: &[Vec3A], quad: &Quad) -> Option<(f32, Vec3A, Vec3A)> {
        let [b0, b1, t0, t1] = quad.corners.map(|id| id as usize - self.low);
        if b0 == b1 || t0 == t1 || matches!(quad.kind, TileKind::TurnLeft | TileKind::TurnRight) {
            return None;
        }
        let own = b0.wrapping_sub(self.fringe);
        let normal = dv.get(own)?.cross(*du.get(own)?);
        let scale = 0.5 / (self.width * self.height * dot(normal, normal).sqrt().max(1e-12));
        let (rising, falling) = (point[t1] - point[b0], point[t0] - point[b1]);
        let (by_rising, by_falling) = (falling.cross(normal) * scale, normal.cross(rising) * scale);
        Some((dot(rising, by_rising), by_rising, by_falling))
    }

    #[cold]
    fn pull_turn(&self, point: &[Vec3A], quad: &Quad, gradient: &mut [Vec3A]) {
        let (up, across, up_length, across_length) = self.middle(point, quad);
        let pull = self.weight(quad.kind) * dot(up, across) / (up_length * across_length);
        let (_, slopes) = self.slope(point, quad);
        for (id, slope) in quad.corners.into_iter().zip(slopes) {
            gradient[id as usize - self.low] += slope * pull;
        }
    }

    /// The slant of a tile, and the derivative of its cosine by each corner.
    ///
    /// Its middle lines are half the sum and half the difference of its diagonals, so their product is a quarter of the
    /// difference of the squared diagonals: no root, no quotient.
    #[inline]
    fn slope(&self, point: &[Vec3A], quad: &Quad) -> (f32, [Vec3A; 4]) {
        let (up, across, up_length, across_length) = self.middle(point, quad);
        let slant = 0.5 / (up_length * across_length);
        match quad.kind {
            TileKind::Wales | TileKind::Step => {
                let (rising, falling) = ((up + across) * slant, (up - across) * slant);
                (slant, [-rising, falling, -falling, rising])
            }
            TileKind::TurnLeft | TileKind::TurnRight => {
                let (up, across) = (up / up_length, across / across_length);
                let cos = dot(up, across);
                let by_up = (across - up * cos) / up_length;
                let by_across = (up - across * cos) * (0.5 / across_length);
                let slopes = if quad.kind == TileKind::TurnLeft {
                    [-by_up - by_across, by_across, by_up - by_across, by_across]
                } else {
                    [-by_across, by_across - by_up, -by_across, by_across + by_up]
                };
                (slant, slopes)
            }
        }
    }
}

impl Ends<'_> {
    /// The node is among the tops of the last turn, which settle level.
    #[inline]
    fn pulls_level(&self, sheet: &Sheet, i: usize) -> bool {
        self.level.is_some_and(|(rows, top)| i >= top && sheet.v[i] >= rows.count - LAST_TURN)
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
