//! The wales in working order, four at a time: each carries its own pull, that of the course between its top and the top
//! before it, and that of the tile between it and the wale before it.

use super::lanes::{GROUP, Matrices, Places, Vectors, larger, outer, smaller, square};
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

/// So many wales are pulled at a time.
const CHUNK: usize = 64;

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

/// A number of each wale of a chunk and of the group before it, whose last wale has to do with the first of the chunk.
type Line = [f32; GROUP + CHUNK];
const ZEROS: Line = [0.0; GROUP + CHUNK];

/// Where wales begin and end.
#[derive(Debug)]
struct WaleEnds {
    base: [Line; 3],
    top: [Line; 3],
}

impl Default for WaleEnds {
    fn default() -> Self {
        Self { base: [ZEROS; 3], top: [ZEROS; 3] }
    }
}

impl WaleEnds {
    /// Before the first chunk.
    #[inline(always)]
    fn begin(&mut self) {
        for line in self.base.iter_mut().chain(&mut self.top) {
            line[..GROUP].fill(0.0);
        }
    }

    /// After a chunk of so many groups.
    #[inline(always)]
    fn go_on(&mut self, groups: usize) {
        for line in self.base.iter_mut().chain(&mut self.top) {
            go_on(line, groups);
        }
    }

    #[inline(always)]
    fn gather(&mut self, groups: &[[Places; 2]], point: [&[f32]; 3]) {
        for (k, [base, top]) in groups.iter().enumerate() {
            let at = GROUP * (k + 1);
            for (axis, point) in point.into_iter().enumerate() {
                base.gather(point).write_to_slice(&mut self.base[axis][at..]);
                top.gather(point).write_to_slice(&mut self.top[axis][at..]);
            }
        }
    }

    /// The sides of the tile between a wale and the one before: up its own wale, along the tops, and both diagonals, from the base
    /// before and from its own.
    #[inline(always)]
    fn sides(&self, i: usize) -> [[f32; 3]; 4] {
        let at = |line: &[Line; 3], i: usize| [line[0][i], line[1][i], line[2][i]];
        let way = |to: [f32; 3], from: [f32; 3]| [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
        let (b0, t0) = (at(&self.base, i - 1), at(&self.top, i - 1));
        let (b1, t1) = (at(&self.base, i), at(&self.top, i));
        [way(t1, b1), way(t1, t0), way(t1, b0), way(t0, b1)]
    }
}

/// The last group of a chunk is the one before the next.
#[inline(always)]
fn go_on(line: &mut Line, groups: usize) {
    line.copy_within(GROUP * groups..GROUP * groups + GROUP, 0);
}

/// What bases and tops of wales get: from their own wales, and, to be taken away, the wale before from each.
#[derive(Debug)]
struct Gains<const N: usize> {
    own: [[Line; N]; 2],
    before: [[Line; N]; 2],
}

impl<const N: usize> Default for Gains<N> {
    fn default() -> Self {
        Self { own: [[ZEROS; N]; 2], before: [[ZEROS; N]; 2] }
    }
}

impl<const N: usize> Gains<N> {
    /// There is nothing before the first chunk.
    #[inline(always)]
    fn begin(&mut self) {
        for line in self.own.as_flattened_mut() {
            line[..GROUP].fill(0.0);
        }
        for line in self.before.as_flattened_mut() {
            line[..GROUP].fill(0.0);
        }
    }

    /// Gives the nodes of all but the last group what they get, and those of the `last` one before.
    #[inline(always)]
    fn give(&mut self, groups: &[[Places; 2]], last: &mut [Places; 2], to: &mut [&mut [f32]; N]) {
        let count = (GROUP * groups.len()).min(CHUNK);
        for (own, before) in self.own.as_flattened_mut().iter_mut().zip(self.before.as_flattened()) {
            for i in 0..count {
                own[i] -= before[i + 1];
            }
        }
        for (k, group) in groups.iter().enumerate() {
            self.scatter(last, GROUP * k, to);
            *last = *group;
        }
        for line in self.own.as_flattened_mut() {
            go_on(line, groups.len());
        }
        for line in self.before.as_flattened_mut() {
            go_on(line, groups.len());
        }
    }

    /// The last wale of all has none after it.
    #[inline(always)]
    fn end(&mut self, last: &[Places; 2], to: &mut [&mut [f32]; N]) {
        for (own, before) in self.own.as_flattened_mut().iter_mut().zip(self.before.as_flattened()) {
            for i in 0..GROUP - 1 {
                own[i] -= before[i + 1];
            }
        }
        self.scatter(last, 0, to);
    }

    #[inline(always)]
    fn scatter(&self, places: &[Places; 2], at: usize, to: &mut [&mut [f32]; N]) {
        for (places, own) in places.iter().zip(&self.own) {
            for (own, to) in own.iter().zip(&mut *to) {
                places.scatter(Vec4::from_slice(&own[at..]), to);
            }
        }
    }
}

impl Gains<3> {
    /// The pulls of wales, courses and tiles, with signs turned; given one over the rest lengths of wales and courses.
    #[inline(always)]
    fn of<const TAIL: bool>(
        &mut self,
        ends: &WaleEnds,
        [wale, course]: [&[u8]; 2],
        slant: &[f32],
        [height, width]: [f32; 2],
    ) {
        let count = wale.len().min(course.len()).min(slant.len()).min(CHUNK);
        for k in 0..count {
            let i = k + GROUP;
            let [up, along, rising, falling] = ends.sides(i);
            let by_up = f32::from(wale[k]) * tension::<TAIL>(square(up), height);
            let by_along = f32::from(course[k]) * tension::<TAIL>(square(along), width);
            let pull = slant[k] * (square(rising) - square(falling));
            for axis in 0..3 {
                let (up, along) = (up[axis] * by_up, along[axis] * by_along);
                let (rising, falling) = (rising[axis] * pull, falling[axis] * pull);
                self.before[0][axis][i] = rising;
                self.before[1][axis][i] = along + falling;
                self.own[0][axis][i] = falling - up;
                self.own[1][axis][i] = up + along + rising;
            }
        }
    }
}

impl Gains<6> {
    /// The matrices of wales, courses and tiles, and the slants of the tiles.
    #[inline(always)]
    fn of<const TAIL: bool>(
        &mut self,
        ends: &WaleEnds,
        [wale, course, tile]: [&[u8]; 3],
        slants: &mut [f32],
        scales: &Scales,
    ) {
        let share = scales.squareness / f32::from(SHARES);
        // Two nodes share the residual of an edge, four that of a tile: that many times the outer product majorizes, so that
        // no line search is needed.
        let (by_height, by_width) = (scales.height.recip(), scales.width.recip());
        let (least_up, least_across) = (0.3 * scales.height, 0.2 * scales.width);
        let count = wale.len().min(course.len()).min(tile.len()).min(slants.len()).min(CHUNK);
        for k in 0..count {
            let i = k + GROUP;
            let [up, along, rising, falling] = ends.sides(i);
            let length = |a: [f32; 3], least: f32| larger(square(a).sqrt(), least);
            let middle = std::array::from_fn(|axis| (rising[axis] + falling[axis]) * 0.5);
            let across = std::array::from_fn(|axis| (rising[axis] - falling[axis]) * 0.5);
            let slant = 0.5 / (length(middle, least_up) * length(across, least_across));
            let weight = f32::from(tile[k]) * share * slant * slant;
            slants[k] = 0.5 * weight;
            let up = outer(up, f32::from(wale[k]) * stiffness_of::<TAIL>(square(up), by_height));
            let along = outer(along, f32::from(course[k]) * stiffness_of::<TAIL>(square(along), by_width));
            let (rising, falling) = (outer(rising, weight * 4.0), outer(falling, weight * 4.0));
            for axis in 0..6 {
                self.before[0][axis][i] = -rising[axis];
                self.before[1][axis][i] = -(along[axis] + falling[axis]);
                self.own[0][axis][i] = falling[axis] + up[axis];
                self.own[1][axis][i] = up[axis] + along[axis] + rising[axis];
            }
        }
    }
}

fn is_turn(quad: &Quad) -> bool {
    matches!(quad.kind, TileKind::TurnLeft | TileKind::TurnRight)
}

/// The wale is the right side of the tile.
fn spans(quad: &Quad, wale: &Edge) -> bool {
    quad.corners[1] == wale.a && quad.corners[3] == wale.b
}

/// What an edge of this squared length pulls with, by one over its rest length: the derivative of half the squared strain by
/// its vector is so many times that.
#[inline(always)]
fn tension<const TAIL: bool>(square: f32, rest: f32) -> f32 {
    let square = larger(square, TINY);
    let by_length = 1.0 / square.sqrt();
    let tension = rest * (rest - by_length);
    if TAIL { tension * (1.0 + tail(square * by_length * rest)) } else { tension }
}

/// Bounds the second derivative of the same: so many times the outer product, for each of two nodes.
#[inline(always)]
fn stiffness_of<const TAIL: bool>(square: f32, rest: f32) -> f32 {
    let square = larger(square, TINY);
    let stiffness = 2.0 * rest * rest / square;
    if TAIL { stiffness * (1.0 + 3.0 * tail(square.sqrt() * rest)) } else { stiffness }
}

/// How much more than in proportion an edge of this length, in rest lengths, pulls.
#[inline(always)]
fn tail(length: f32) -> f32 {
    let strain = length - 1.0;
    smaller(TAIL_WEIGHT * strain * strain, TAIL_MOST)
}
