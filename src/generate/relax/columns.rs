//! The wales in working order, four at a time: each carries its own pull, that of the course between its top and the top
//! before it, and that of the tile between it and the wale before it.

use super::lanes::{Four, Matrices, Places, root};
use super::{SHARES, Scales, TINY, shares};
use crate::generate::sheet::{Edge, EdgeKind, Quad, TileKind};
use crate::ir::NodeId;
use glam::Vec4;

/// In most final sweeps a strain pulls more than in proportion, so that few edges are far off: by this times its square,
/// and at most by so much.
const TAIL_WEIGHT: f32 = 17.7;
const TAIL_MOST: f32 = 0.198;
/// So many wales are not kept beside their blocks.
const MANY: usize = 1 << 16;

/// The wales of a sheet from a mark on, with what hangs between neighbors.
#[derive(Debug, Default)]
pub(super) struct Columns {
    wales: Vec<Wale>,
    blocks: Vec<Block>,
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

/// Four wales; places count from the lowest node.
#[derive(Clone, Copy, Debug, Default)]
struct Block {
    base: Places,
    top: Places,
    wale: Weights,
    course: Weights,
    /// In shares.
    tile: Weights,
    /// What the tile pulls with, good for a few sweeps: see [`Columns::stiffen`].
    slant: Vec4,
}

/// Weights of four: a byte each, for the blocks of a large part outweigh its nodes.
#[derive(Clone, Copy, Debug, Default)]
struct Weights([u8; 4]);

impl Weights {
    #[inline]
    fn get(self) -> Vec4 {
        Vec4::from_array(self.0.map(f32::from))
    }
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
        self.blocks.clear();
        self.blocks.extend(self.wales.as_chunks().0.iter().map(|wales: &[Wale; 4]| {
            let weights = |weight: fn(&Wale) -> u8| Weights(wales.each_ref().map(weight));
            Block {
                base: Places::new(wales.map(|wale| wale.base.saturating_sub(low))),
                top: Places::new(wales.map(|wale| wale.top.saturating_sub(low))),
                wale: weights(|wale| wale.weight),
                course: weights(|wale| wale.course),
                tile: weights(|wale| wale.tile),
                slant: Vec4::ZERO,
            }
        }));
        if self.wales.len() > MANY {
            self.wales = Vec::new();
        }
        low as usize
    }

    /// The nodes of each tile of weight, as places: base left, base right, top left, top right.
    pub(super) fn tiles(&self) -> impl Iterator<Item = [usize; 4]> {
        let wales = self.blocks.iter().flat_map(|block| {
            let places = block.base.each.into_iter().zip(block.top.each);
            places.zip(block.tile.0).map(|((base, top), tile)| (base as usize, top as usize, tile))
        });
        let before = std::iter::once((0, 0, 0)).chain(wales.clone());
        before
            .zip(wales)
            .filter(|(_, (.., tile))| *tile > 0)
            .map(|((b0, t0, _), (b1, t1, _))| [b0, b1, t0, t1])
    }

    /// Sums the pulls of all wales, courses and tiles at their nodes. With `TAIL`, long and short edges pull more than in
    /// proportion.
    pub(super) fn pull<const TAIL: bool>(&self, point: &[Vec4], gradient: &mut [Vec4], scales: &Scales) {
        let (height, width) = (Vec4::splat(scales.height.recip()), Vec4::splat(scales.width.recip()));
        let (mut bases, mut tops) = (Four::default(), Four::default());
        let mut last = Pending::<Four>::default();
        for block in &self.blocks {
            let (b1, t1) = (Four::gather(point, &block.base), Four::gather(point, &block.top));
            let (b0, t0) = (b1.behind(bases), t1.behind(tops));
            (bases, tops) = (b1, t1);
            let up = t1 - b1;
            let up = up.times(block.wale.get() * tension::<TAIL>(up, height));
            let along = t1 - t0;
            let along = along.times(block.course.get() * tension::<TAIL>(along, width));
            let (rising, falling) = (t1 - b0, t0 - b1);
            let pull = block.slant * (rising.dot(rising) - falling.dot(falling));
            let (rising, falling) = (rising.times(pull), falling.times(pull));
            // In the end the signs of what the wales before get are turned.
            let left = [rising, along + falling];
            last.right[0] = last.right[0] - last.left[0].ahead(left[0]);
            last.right[1] = last.right[1] - last.left[1].ahead(left[1]);
            last.right[0].scatter(gradient, &last.at[0]);
            last.right[1].scatter(gradient, &last.at[1]);
            last = Pending { at: [block.base, block.top], right: [falling - up, up + along + rising], left };
        }
        // The last lane of all has no wale after it.
        last.right[0] = last.right[0] - last.left[0].ahead(Four::default());
        last.right[1] = last.right[1] - last.left[1].ahead(Four::default());
        last.right[0].scatter(gradient, &last.at[0]);
        last.right[1].scatter(gradient, &last.at[1]);
    }

    /// Adds up the Gauss-Newton matrices of the nodes, and takes up the slants of the tiles: the factor from the difference of
    /// the squared diagonals to the cosine, squared, halved and weighted.
    ///
    /// Middle lines of a tile are half the sum and half the difference of its diagonals, so their product is a quarter of the
    /// difference of the squared diagonals: no root, no quotient.
    pub(super) fn stiffen<const TAIL: bool>(
        &mut self,
        point: &[Vec4],
        stiffness: &mut [[Vec4; 2]],
        scales: &Scales,
    ) {
        let half = Vec4::splat(0.5);
        let share = Vec4::splat(scales.squareness / f32::from(SHARES));
        let (height, width) = (scales.height, scales.width);
        // Two nodes share the residual of an edge, four that of a tile: that many times the outer product majorizes, so that
        // no line search is needed.
        let (by_height, by_width) = (Vec4::splat(height.recip()), Vec4::splat(width.recip()));
        let (least_up, least_across) = (Vec4::splat(0.3 * height), Vec4::splat(0.2 * width));
        let (mut bases, mut tops) = (Four::default(), Four::default());
        let mut last = Pending::<Matrices>::default();
        let mut give = |last: &Pending<Matrices>, next: [Matrices; 2]| {
            let sides = last.right.into_iter().zip(last.left).zip(next).zip(last.at);
            for (((right, left), next), at) in sides {
                let own = right + left.ahead(next);
                let each = own.diagonal.each().into_iter().zip(own.off.each());
                for (place, (diagonal, off)) in at.each.into_iter().zip(each) {
                    let place = &mut stiffness[place as usize];
                    place[0] += diagonal;
                    place[1] += off;
                }
            }
        };
        for block in &mut self.blocks {
            let (b1, t1) = (Four::gather(point, &block.base), Four::gather(point, &block.top));
            let (b0, t0) = (b1.behind(bases), t1.behind(tops));
            (bases, tops) = (b1, t1);
            let up = t1 - b1;
            let up = Matrices::outer(up, block.wale.get() * stiffness_of::<TAIL>(up, by_height));
            let along = t1 - t0;
            let along = Matrices::outer(along, block.course.get() * stiffness_of::<TAIL>(along, by_width));
            let (rising, falling) = (t1 - b0, t0 - b1);
            let (middle, across) = ((rising + falling).times(half), (rising - falling).times(half));
            let length = |d: Four, least: Vec4| root(d.dot(d)).max(least);
            let slant = half / (length(middle, least_up) * length(across, least_across));
            let square = block.tile.get() * share * slant * slant;
            block.slant = half * square;
            let weight = square * Vec4::splat(4.0);
            let (rising, falling) = (Matrices::outer(rising, weight), Matrices::outer(falling, weight));
            let left = [rising, along + falling];
            give(&last, left);
            last = Pending { at: [block.base, block.top], right: [falling + up, up + along + rising], left };
        }
        give(&last, Default::default());
    }
}

/// Four wales, what their nodes get, bases and tops, and what those of the wales before each get from them.
#[derive(Default)]
struct Pending<T> {
    at: [Places; 2],
    right: [T; 2],
    left: [T; 2],
}

fn is_turn(quad: &Quad) -> bool {
    matches!(quad.kind, TileKind::TurnLeft | TileKind::TurnRight)
}

/// The wale is the right side of the tile.
fn spans(quad: &Quad, wale: &Edge) -> bool {
    quad.corners[1] == wale.a && quad.corners[3] == wale.b
}

/// What the vectors of edges pull with, by one over their rest length: the derivative of half the squared strain by the
/// vector is so many times that.
#[inline]
fn tension<const TAIL: bool>(edge: Four, rest: Vec4) -> Vec4 {
    let square = edge.dot(edge).max(Vec4::splat(TINY));
    let by_length = Vec4::ONE / root(square);
    let tension = rest * (rest - by_length);
    if TAIL { tension * (Vec4::ONE + tail(square * by_length * rest)) } else { tension }
}

/// Bounds the second derivative of the same: so many times the outer product, for each of two nodes.
#[inline]
fn stiffness_of<const TAIL: bool>(edge: Four, rest: Vec4) -> Vec4 {
    let square = edge.dot(edge).max(Vec4::splat(TINY));
    let stiffness = Vec4::splat(2.0) * rest * rest / square;
    if TAIL { stiffness * (Vec4::ONE + Vec4::splat(3.0) * tail(root(square) * rest)) } else { stiffness }
}

/// How much more than in proportion edges of these lengths, in rest lengths, pull.
#[inline]
fn tail(length: Vec4) -> Vec4 {
    let strain = length - Vec4::ONE;
    (Vec4::splat(TAIL_WEIGHT) * strain * strain).min(Vec4::splat(TAIL_MOST))
}
