//! A chunk of wales at a time, in loops that compile to wide instructions: what their bases and tops get.

use super::lanes::{GROUP, Places, larger, outer, smaller, square};
use super::{SHARES, Scales, TINY};
use glam::Vec4;

/// In most final sweeps a strain pulls more than in proportion, so that few edges are far off: by this times its square,
/// and at most by so much.
const TAIL_WEIGHT: f32 = 17.7;
const TAIL_MOST: f32 = 0.198;
/// So many wales are pulled at a time.
pub(super) const CHUNK: usize = 64;

/// A number of each wale of a chunk and of the group before it, whose last wale has to do with the first of the chunk.
type Line = [f32; GROUP + CHUNK];
const ZEROS: Line = [0.0; GROUP + CHUNK];

/// Where wales begin and end.
#[derive(Debug)]
pub(super) struct WaleEnds {
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
    pub(super) fn begin(&mut self) {
        for line in self.base.iter_mut().chain(&mut self.top) {
            line[..GROUP].fill(0.0);
        }
    }

    /// After a chunk of so many groups.
    #[inline(always)]
    pub(super) fn go_on(&mut self, groups: usize) {
        for line in self.base.iter_mut().chain(&mut self.top) {
            go_on(line, groups);
        }
    }

    #[inline(always)]
    pub(super) fn gather(&mut self, groups: &[[Places; 2]], point: [&[f32]; 3]) {
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
pub(super) struct Gains<const N: usize> {
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
    pub(super) fn begin(&mut self) {
        for line in self.own.as_flattened_mut() {
            line[..GROUP].fill(0.0);
        }
        for line in self.before.as_flattened_mut() {
            line[..GROUP].fill(0.0);
        }
    }

    /// Gives the nodes of all but the last group what they get, and those of the `last` one before.
    #[inline(always)]
    pub(super) fn give(&mut self, groups: &[[Places; 2]], last: &mut [Places; 2], to: &mut [&mut [f32]; N]) {
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
    pub(super) fn end(&mut self, last: &[Places; 2], to: &mut [&mut [f32]; N]) {
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
    pub(super) fn of<const TAIL: bool>(
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
    pub(super) fn of<const TAIL: bool>(
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
