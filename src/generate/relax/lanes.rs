//! Vectors of space with their coordinates apart, so that a loop over many of them is one of wide instructions.

use glam::{Vec3A, Vec4};

/// The larger of two, and the second where one is no number: one instruction.
#[inline(always)]
pub(super) fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The smaller of two, likewise.
#[inline(always)]
pub(super) fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
pub(super) fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The length of a vector, squared.
#[inline(always)]
pub(super) fn square(a: [f32; 3]) -> f32 {
    dot(a, a)
}

/// Vectors of `N` numbers: all the first ones, all the second ones, and so on.
#[derive(Debug)]
pub(super) struct Vectors<const N: usize>(pub(super) [Vec<f32>; N]);

impl<const N: usize> Default for Vectors<N> {
    fn default() -> Self {
        Self(std::array::from_fn(|_| Vec::new()))
    }
}

impl<const N: usize> Vectors<N> {
    pub(super) fn len(&self) -> usize {
        self.0[0].len()
    }

    /// So many zeros.
    pub(super) fn reset(&mut self, count: usize) {
        for axis in &mut self.0 {
            axis.clear();
            axis.resize(count, 0.0);
        }
    }

    /// The numbers from a place on.
    #[inline(always)]
    pub(super) fn axes(&self, first: usize) -> [&[f32]; N] {
        self.0.each_ref().map(|axis| &axis[first..])
    }

    #[inline(always)]
    pub(super) fn axes_mut(&mut self, first: usize) -> [&mut [f32]; N] {
        self.0.each_mut().map(|axis| &mut axis[first..])
    }
}

impl Vectors<3> {
    /// These, and zeros after them up to `count`.
    pub(super) fn refill(&mut self, vectors: impl Iterator<Item = Vec3A>, count: usize) {
        self.reset(count);
        let [x, y, z] = &mut self.0;
        for (((x, y), z), vector) in x.iter_mut().zip(y).zip(z).zip(vectors) {
            [*x, *y, *z] = vector.to_array();
        }
    }

    #[inline(always)]
    pub(super) fn get(&self, i: usize) -> Vec3A {
        let [x, y, z] = &self.0;
        Vec3A::new(x[i], y[i], z[i])
    }

    #[inline(always)]
    pub(super) fn add(&mut self, i: usize, vector: Vec3A) {
        for (axis, own) in self.0.iter_mut().zip(vector.to_array()) {
            axis[i] += own;
        }
    }
}

/// Symmetric matrices: their diagonals, and yz, zx, xy.
pub(super) type Matrices = Vectors<6>;

impl Matrices {
    /// Adds `weight` times the outer product of a vector with itself.
    pub(super) fn add_outer(&mut self, i: usize, a: Vec3A, weight: f32) {
        for (axis, own) in self.0.iter_mut().zip(outer(a.to_array(), weight)) {
            axis[i] += own;
        }
    }
}

/// `weight` times the outer product of a vector with itself.
#[inline(always)]
pub(super) fn outer(a: [f32; 3], weight: f32) -> [f32; 6] {
    let [x, y, z] = a.map(|a| a * weight);
    [a[0] * x, a[1] * y, a[2] * z, a[1] * z, a[2] * x, a[0] * y]
}

/// a M b.
#[inline(always)]
pub(super) fn quadratic([xx, yy, zz, yz, zx, xy]: [f32; 6], a: [f32; 3], b: [f32; 3]) -> f32 {
    let straight = [a[0] * b[0], a[1] * b[1], a[2] * b[2]];
    let crossed = [a[1] * b[2] + a[2] * b[1], a[2] * b[0] + a[0] * b[2], a[0] * b[1] + a[1] * b[0]];
    dot(straight, [xx, yy, zz]) + dot(crossed, [yz, zx, xy])
}

/// Places in an array that are looked up together.
pub(super) const GROUP: usize = 4;

/// Where a group of vectors lies.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Places {
    pub(super) each: [u32; GROUP],
    /// They follow each other.
    run: bool,
}

impl Places {
    #[inline]
    pub(super) fn new(each: [u32; GROUP]) -> Self {
        Self { each, run: each.is_sorted_by(|a, b| *b == a + 1) }
    }

    #[inline(always)]
    fn first(&self) -> usize {
        self.each[0] as usize
    }

    #[inline(always)]
    pub(super) fn gather(&self, from: &[f32]) -> Vec4 {
        if self.run
            && let Some(group) = from.get(self.first()..self.first() + GROUP)
        {
            return Vec4::from_slice(group);
        }
        Vec4::from_array(self.each.map(|i| from[i as usize]))
    }

    #[inline(always)]
    pub(super) fn scatter(&self, own: Vec4, to: &mut [f32]) {
        if self.run
            && let Some(to) = to.get_mut(self.first()..self.first() + GROUP)
        {
            (Vec4::from_slice(to) + own).write_to_slice(to);
            return;
        }
        for (i, own) in self.each.into_iter().zip(own.to_array()) {
            to[i as usize] += own;
        }
    }
}
