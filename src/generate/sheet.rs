//! The growing sheet of stitches: nodes with their place on the surface, edges and tiles to relax, and the work log.

use crate::ir::{Gauge, NodeId, Stitch};
use crate::shape::{Jet, ParametricSurface};
use glam::DVec3;

/// What an edge asks for in the relaxation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EdgeKind {
    /// Along the yarn; rest length one stitch width.
    Course,
    /// Up a stitch; rest length one stitch height.
    Wale,
    /// Up or down the step at a short row's end: a soft pull that closes it.
    Step,
}

/// Two nodes that pull at each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    pub a: NodeId,
    pub b: NodeId,
    pub kind: EdgeKind,
}

/// How four nodes of two successive wales span a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TileKind {
    /// Two wales side by side; an increase or a decrease has two equal corners.
    Wales,
    /// The same across the step at a short row's end.
    Step,
    /// The turn at the left end of a back pass: only the first wale stands for the height.
    TurnLeft,
    /// The turn at the right end: only the second wale does.
    TurnRight,
}

/// Base left, base right, top left, top right.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quad {
    pub corners: [NodeId; 4],
    pub kind: TileKind,
}

impl Quad {
    /// Twice the area of the tile times its normal; `None` for turns and tiles of three corners.
    pub(super) fn area(&self, at: impl Fn(NodeId) -> DVec3) -> Option<DVec3> {
        let [b0, b1, t0, t1] = self.corners;
        if !matches!(self.kind, TileKind::Wales | TileKind::Step) || b0 == b1 || t0 == t1 {
            return None;
        }
        let [left, right, top_left, top_right] = self.corners.map(at);
        Some((right - top_left).cross(top_right - left))
    }
}

/// One stitch in the log: bases and tops in the order of a forward row; unused places repeat the first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Work {
    pub stitch: Stitch,
    pub base: [NodeId; 2],
    pub top: [NodeId; 2],
}

/// A short row: after the forward stitch that made `after`, a back pass and a forward pass over it.
#[derive(Clone, Debug)]
pub(crate) struct ShortRow {
    pub after: NodeId,
    /// The back pass, stitches from left to right, so in reverse of working order.
    pub back: Vec<Work>,
    /// The forward pass in working order.
    pub forward: Vec<Work>,
}

/// Marks the top of an increase or of a decrease, so that the next row does not undo it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Shaped {
    #[default]
    No,
    Inc,
    Dec,
}

/// The part along the surface of a unit vector that is as good as across it.
const NO_WAY: f64 = 1e-6;

/// Everything that grows while rows are added. Node arrays run in parallel.
#[derive(Debug)]
pub(crate) struct Sheet {
    pub width: f64,
    pub height: f64,
    /// Surface parameter along the tube.
    pub u: Vec<f64>,
    /// Turns around the tube, not wrapped.
    pub v: Vec<f64>,
    pub point: Vec<DVec3>,
    /// Derivatives of the surface at the node, as of the last full look.
    pub du: Vec<DVec3>,
    pub dv: Vec<DVec3>,
    pub shaped: Vec<Shaped>,
    /// True when the yarn steps down behind this node, at the end of a short row.
    pub steps: Vec<bool>,
    /// The edge that brings the yarn to this node, where there is one.
    pub arrival: Vec<u32>,
    pub edges: Vec<Edge>,
    pub quads: Vec<Quad>,
    /// The forward stitches of the helix in order.
    pub main: Vec<Work>,
    /// The short rows in working order.
    pub short_rows: Vec<ShortRow>,
}

/// A place for a node that is not yet one, with the surface's derivatives nearby.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Foot {
    pub u: f64,
    pub v: f64,
    pub point: DVec3,
    pub du: DVec3,
    pub dv: DVec3,
    /// Unit vector along the course.
    pub along: DVec3,
}

/// The coordinates (du, dv) of a small displacement in the tangent plane.
#[inline]
pub(crate) fn pull_back(du: DVec3, dv: DVec3, d: DVec3) -> (f64, f64) {
    let (e, f, g) = (du.dot(du), du.dot(dv), dv.dot(dv));
    let (x, y) = (d.dot(du), d.dot(dv));
    let det = (e * g - f * f).max(1e-12 * e * g).max(1e-30);
    ((g * x - f * y) / det, (e * y - f * x) / det)
}

impl Foot {
    /// Moves a little along the course, to first order.
    pub(crate) fn shifted(&self, distance: f64) -> Self {
        let d = self.along * distance;
        let (x, y) = pull_back(self.du, self.dv, d);
        Self { u: self.u + x, v: self.v + y, point: self.point + d, ..*self }
    }
}

impl Sheet {
    /// With room for about so many stitches.
    pub(crate) fn new(gauge: &Gauge, stitches: usize) -> Self {
        // What the shape merely claims costs no more than this; beyond, arrays grow.
        let nodes = stitches.min(1 << 18) / 8 * 9;
        Self {
            width: gauge.width,
            height: gauge.height,
            u: Vec::with_capacity(nodes),
            v: Vec::with_capacity(nodes),
            point: Vec::with_capacity(nodes),
            du: Vec::with_capacity(nodes),
            dv: Vec::with_capacity(nodes),
            shaped: Vec::with_capacity(nodes),
            steps: Vec::with_capacity(nodes),
            arrival: Vec::with_capacity(nodes),
            edges: Vec::with_capacity(2 * nodes),
            quads: Vec::with_capacity(nodes),
            main: Vec::with_capacity(nodes),
            short_rows: Vec::new(),
        }
    }

    /// A decrease: its top moves to the middle between its own place and the foot of the second base.
    pub(crate) fn join_top(&mut self, top: NodeId, other: DVec3) {
        let i = top as usize;
        let d = 0.5 * (other - self.point[i]);
        let (x, y) = pull_back(self.du[i], self.dv[i], d);
        self.u[i] += x;
        self.v[i] += y;
        self.point[i] += d;
        self.shaped[i] = Shaped::Dec;
    }

    /// Puts all nodes on another surface at the same parameters, with v farther on by so much. Derivatives stay.
    pub(crate) fn put_on(&mut self, surface: &dyn ParametricSurface, further: f64) {
        for ((point, u), v) in self.point.iter_mut().zip(&self.u).zip(&self.v) {
            *point = surface.point(*u, v + further);
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.u.len()
    }

    /// Adds a node.
    pub(crate) fn add(&mut self, foot: &Foot, shaped: Shaped) -> NodeId {
        let id = self.len() as NodeId;
        self.u.push(foot.u);
        self.v.push(foot.v);
        self.point.push(foot.point);
        self.du.push(foot.du);
        self.dv.push(foot.dv);
        self.shaped.push(shaped);
        self.steps.push(false);
        self.arrival.push(u32::MAX);
        id
    }

    /// No stitch is added from now on: what only that needs is let go.
    pub(crate) fn close(&mut self) {
        (self.steps, self.arrival) = Default::default();
    }

    /// Nothing settles from now on: of a large part that is half of all it holds.
    pub(crate) fn keep_work(&mut self) {
        (self.du, self.dv, self.edges, self.quads) = Default::default();
    }

    /// Adds the yarn's edge from one node to the next.
    pub(crate) fn course(&mut self, a: NodeId, b: NodeId) {
        self.arrival[b as usize] = self.edges.len() as u32;
        self.edges.push(Edge { a, b, kind: EdgeKind::Course });
    }

    /// Adds a wale, and the tile that it spans with the wale before it.
    pub(crate) fn wale(&mut self, before: Option<(NodeId, NodeId)>, base: NodeId, top: NodeId) {
        if let Some((b, t)) = before {
            let kind = if b != base && t != top && self.steps[b as usize] {
                TileKind::Step
            } else {
                TileKind::Wales
            };
            self.quads.push(Quad { corners: [b, base, t, top], kind });
        }
        self.edges.push(Edge { a: base, b: top, kind: EdgeKind::Wale });
    }

    /// Position and derivatives of a node as they were last seen.
    #[inline]
    pub(crate) fn jet(&self, id: NodeId) -> Jet {
        let i = id as usize;
        Jet { point: self.point[i], du: self.du[i], dv: self.dv[i] }
    }

    /// From a node, `distance` in the direction `direction` along the surface: a midpoint step. The surface is looked up
    /// in the middle only; derivatives go on from there as they came, and the relaxation settles the rest.
    pub(crate) fn walk(
        &self,
        surface: &dyn ParametricSurface,
        from: NodeId,
        direction: DVec3,
        distance: f64,
        along: DVec3,
    ) -> Foot {
        let i = from as usize;
        let (x, y) = pull_back(self.du[i], self.dv[i], direction * distance);
        let middle = surface.jet(self.u[i] + 0.5 * x, self.v[i] + 0.5 * y);
        // The part of the direction along the surface there, made as long again.
        let (x, y) = pull_back(middle.du, middle.dv, direction);
        let way = middle.du * x + middle.dv * y;
        let length = way.length();
        let scale = if length > NO_WAY { distance / length } else { distance };
        Foot {
            u: self.u[i] + x * scale,
            v: self.v[i] + y * scale,
            point: self.point[i] + way * scale,
            du: middle.du * 2.0 - self.du[i],
            dv: middle.dv * 2.0 - self.dv[i],
            along,
        }
    }

    /// The same with one look, at the end: its length is right, its heading that of the start.
    pub(crate) fn step(
        &self,
        surface: &dyn ParametricSurface,
        from: NodeId,
        direction: DVec3,
        distance: f64,
        along: DVec3,
    ) -> Foot {
        let i = from as usize;
        let (x, y) = pull_back(self.du[i], self.dv[i], direction * distance);
        let end = surface.jet(self.u[i] + x, self.v[i] + y);
        let way = ((self.du[i] + end.du) * x + (self.dv[i] + end.dv) * y) * 0.5;
        let length = way.length();
        let scale = if length > NO_WAY * distance { distance / length } else { 1.0 };
        Foot {
            u: self.u[i] + x * scale,
            v: self.v[i] + y * scale,
            point: end.point + (end.du * x + end.dv * y) * (scale - 1.0),
            du: end.du,
            dv: end.dv,
            along,
        }
    }

    /// Tangent along the course and direction up the fabric at a node between two neighbors. At a node where neighbors
    /// coincide the surface's own directions stand in.
    pub(crate) fn directions(&self, at: NodeId, left: NodeId, right: NodeId) -> (DVec3, DVec3) {
        let jet = self.jet(at);
        let normal = jet.du.cross(jet.dv).normalize_or_zero();
        let chord = self.point[right as usize] - self.point[left as usize];
        let along = (chord - normal * chord.dot(normal)).try_normalize();
        let along = along.unwrap_or_else(|| jet.dv.normalize_or_zero());
        let up = normal.cross(along);
        (along, if up.dot(jet.du) < 0.0 { -up } else { up })
    }
}
