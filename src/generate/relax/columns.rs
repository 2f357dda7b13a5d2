//! The wales in working order: each carries its own pull, that of the course between its top and the top before it, and
//! that of the tile between it and the wale before it.

use super::chunks::{CHUNK, Gains, WaleEnds};
use super::lanes::{GROUP, Matrices, Places, Vectors};
use super::{Scales, shares};
use crate::generate::sheet::{Edge, EdgeKind, Quad, TileKind};
use crate::ir::NodeId;

/// So many wales are not kept beside their blocks.
const MANY: usize = 1 << 16;

/// The wales of a sheet from a mark on, with what hangs between neighbors.
#[derive(Debug, Default)]
pub(super) struct Columns {
    wales: Vec<Wale>,
    /// Bases and tops, counted from the lowest node.
    groups: Vec<[Places; 2]>,
    /// Weights of each, and of the tiles in shares: a byte each, for they outweigh the nodes of a large part.
    wale: Vec<u8>,
    course: Vec<u8>,
    tile: Vec<u8>,
    /// What the tiles pull with, good for a few sweeps: see [`Columns::stiffen`].
    slant: Vec<f32>,
    /// Room for a chunk.
    ends: WaleEnds,
    pulls: Gains<3>,
    matrices: Gains<6>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Wale {
    base: NodeId,
    top: NodeId,
    /// Its weight. A tile whose left wale is not the one before has a copy of that there, of no weight.
    weight: u8,
    /// Weight of the course to the top before.
    course: u8,
    /// Weight of the tile, in shares.
    tile: u8,
}

/// What is not between neighbors: steps, courses of a first row, turns.
#[derive(Debug, Default)]
pub(super) struct Loose {
    pub(super) edges: Vec<Edge>,
    pub(super) turns: Vec<Quad>,
}

impl Columns {
    /// Takes up the edges and tiles from a mark on. Returns the lowest of their nodes and of `first`.
    pub(super) fn take(&mut self, edges: &[Edge], quads: &[Quad], first: usize, loose: &mut Loose) -> usize {
        loose.edges.clear();
        loose.turns.clear();
        self.wales.clear();
        self.wales.reserve(quads.len() + quads.len() / 8 + 8);
        // The first lane has no wale before it.
        self.wales.push(Wale::default());
        let mut quads = quads.iter().peekable();
        let mut course: Option<&Edge> = None;
        let mut before = Wale { base: NodeId::MAX, top: NodeId::MAX, ..Wale::default() };
        let mut low = first as NodeId;
        for edge in edges {
            if edge.kind != EdgeKind::Wale {
                loose.edges.extend(course.take());
                if edge.kind == EdgeKind::Course {
                    course = Some(edge);
                } else {
                    loose.edges.push(*edge);
                }
                continue;
            }
            let mut own = Wale { base: edge.a, top: edge.b, weight: 1, ..Wale::default() };
            while let Some(quad) = quads.next_if(|quad| is_turn(quad) || spans(quad, edge)) {
                if is_turn(quad) {
                    loose.turns.push(*quad);
                    continue;
                }
                let [base, _, top, _] = quad.corners;
                own.tile = shares(quad.kind);
                if (before.base, before.top) != (base, top) {
                    before = Wale { base, top, ..Wale::default() };
                    self.wales.push(before);
                    low = low.min(base).min(top);
                }
                break;
            }
            if let Some(course) = course.take() {
                if course.b == own.top && course.a == before.top {
                    own.course = 1;
                } else {
                    loose.edges.push(*course);
                }
            }
            low = low.min(own.base).min(own.top);
            self.wales.push(own);
            before = own;
        }
        loose.edges.extend(course);
        loose.turns.extend(quads);
        low = loose.edges.iter().fold(low, |low, edge| low.min(edge.a).min(edge.b));
        low = loose.turns.iter().flat_map(|quad| quad.corners).fold(low, NodeId::min);
        while !self.wales.len().is_multiple_of(4) {
            self.wales.push(Wale::default());
        }
        let groups = self.wales.as_chunks::<GROUP>().0.iter();
        self.groups.clear();
        self.groups.extend(groups.map(|wales| {
            let places = |node: fn(&Wale) -> NodeId| {
                Places::new(wales.each_ref().map(|wale| node(wale).saturating_sub(low)))
            };
            [places(|wale| wale.base), places(|wale| wale.top)]
        }));
        let weights = |to: &mut Vec<u8>, weight: fn(&Wale) -> u8| {
            to.clear();
            to.extend(self.wales.iter().map(weight));
        };
        weights(&mut self.wale, |wale| wale.weight);
        weights(&mut self.course, |wale| wale.course);
        weights(&mut self.tile, |wale| wale.tile);
        self.slant.clear();
        self.slant.resize(self.wales.len(), 0.0);
        if self.wales.len() > MANY {
            self.wales = Vec::new();
        }
        low as usize
    }

    /// Calls a function with the nodes of each tile of weight, as places: base left, base right, top left, top right.
    #[inline(always)]
    pub(super) fn for_tiles(&self, mut act: impl FnMut([usize; 4])) {
        let (mut base, mut top) = (0, 0);
        for ([bases, tops], tiles) in self.groups.iter().zip(self.tile.as_chunks::<GROUP>().0) {
            for ((right_base, right_top), tile) in bases.each.into_iter().zip(tops.each).zip(tiles) {
                if *tile > 0 {
                    act([base, right_base, top, right_top].map(|i| i as usize));
                }
                (base, top) = (right_base, right_top);
            }
        }
    }

    /// Sums the pulls of all wales, courses and tiles at their nodes. With `TAIL`, long and short edges pull more than in
    /// proportion.
    #[inline(always)]
    pub(super) fn pull<const TAIL: bool>(
        &mut self,
        point: &Vectors<3>,
        gradient: &mut Vectors<3>,
        scales: &Scales,
    ) {
        let rest = [scales.height.recip(), scales.width.recip()];
        let (point, mut gradient) = (point.axes(0), gradient.axes_mut(0));
        let Self { ends, pulls, .. } = self;
        let mut last = [Places::default(); 2];
        ends.begin();
        pulls.begin();
        let wales = self.wale.chunks(CHUNK).zip(self.course.chunks(CHUNK)).zip(self.slant.chunks(CHUNK));
        for (groups, ((wale, course), slant)) in self.groups.chunks(CHUNK / GROUP).zip(wales) {
            ends.gather(groups, point);
            pulls.of::<TAIL>(ends, [wale, course], slant, rest);
            pulls.give(groups, &mut last, &mut gradient);
            ends.go_on(groups.len());
        }
        pulls.end(&last, &mut gradient);
    }

    /// Adds up the Gauss-Newton matrices of the nodes, and takes up the slants of the tiles: the factor from the difference of
    /// the squared diagonals to the cosine, squared, halved and weighted.
    ///
    /// Middle lines of a tile are half the sum and half the difference of its diagonals, so their product is a quarter of the
    /// difference of the squared diagonals: no root, no quotient.
    #[inline(always)]
    pub(super) fn stiffen<const TAIL: bool>(
        &mut self,
        point: &Vectors<3>,
        stiffness: &mut Matrices,
        scales: &Scales,
    ) {
        let (point, mut stiffness) = (point.axes(0), stiffness.axes_mut(0));
        let Self { ends, matrices, .. } = self;
        let mut last = [Places::default(); 2];
        ends.begin();
        matrices.begin();
        let wales = self.wale.chunks(CHUNK).zip(self.course.chunks(CHUNK)).zip(self.tile.chunks(CHUNK));
        let wales = wales.zip(self.slant.chunks_mut(CHUNK));
        for (groups, (((wale, course), tile), slant)) in self.groups.chunks(CHUNK / GROUP).zip(wales) {
            ends.gather(groups, point);
            matrices.of::<TAIL>(ends, [wale, course, tile], slant, scales);
            matrices.give(groups, &mut last, &mut stiffness);
            ends.go_on(groups.len());
        }
        matrices.end(&last, &mut stiffness);
    }
}

fn is_turn(quad: &Quad) -> bool {
    matches!(quad.kind, TileKind::TurnLeft | TileKind::TurnRight)
}

/// The wale is the right side of the tile.
fn spans(quad: &Quad, wale: &Edge) -> bool {
    quad.corners[1] == wale.a && quad.corners[3] == wale.b
}
