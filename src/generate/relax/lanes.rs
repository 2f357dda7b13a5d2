//! Four vectors at a time: one lane each of a coordinate, gathered from and scattered to arrays of points.

use glam::{Mat4, Vec4};
use std::ops::{Add, AddAssign, Mul, Sub};

/// The square root of each.
#[inline]
pub(super) fn root(square: Vec4) -> Vec4 {
    // The vector's own may call a library.
    Vec4::from_array(square.to_array().map(f32::sqrt))
}

/// Four places in an array.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Places {
    pub(super) each: [u32; 4],
    /// They follow each other.
    run: bool,
}

impl Places {
    #[inline]
    pub(super) fn new(each: [u32; 4]) -> Self {
        let [a, b, c, d] = each;
        Self { each, run: b == a + 1 && c == b + 1 && d == c + 1 }
    }

    #[inline]
    fn first(&self) -> usize {
        self.each[0] as usize
    }
}

/// Four vectors of space: the x of all, the y of all, the z of all.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Four {
    pub(super) x: Vec4,
    pub(super) y: Vec4,
    pub(super) z: Vec4,
}

impl Four {
    #[inline]
    pub(super) fn new(points: [Vec4; 4]) -> Self {
        let [a, b, c, d] = points;
        let turned = Mat4::from_cols(a, b, c, d).transpose();
        Self { x: turned.x_axis, y: turned.y_axis, z: turned.z_axis }
    }

    #[inline]
    pub(super) fn gather(from: &[Vec4], at: &Places) -> Self {
        if at.run
            && let Some(Ok(points)) = from.get(at.first()..at.first() + 4).map(<[Vec4; 4]>::try_from)
        {
            return Self::new(points);
        }
        Self::new(at.each.map(|i| from[i as usize]))
    }

    /// The vectors one by one; their fourth number is 0.
    #[inline]
    pub(super) fn each(self) -> [Vec4; 4] {
        let turned = Mat4::from_cols(self.x, self.y, self.z, Vec4::ZERO).transpose();
        [turned.x_axis, turned.y_axis, turned.z_axis, turned.w_axis]
    }

    #[inline]
    pub(super) fn scatter(self, to: &mut [Vec4], at: &Places) {
        let each = self.each();
        if at.run
            && let Some(to) = to.get_mut(at.first()..at.first() + 4)
        {
            for (to, own) in to.iter_mut().zip(each) {
                *to += own;
            }
            return;
        }
        for (i, own) in at.each.into_iter().zip(each) {
            to[i as usize] += own;
        }
    }

    #[inline]
    pub(super) fn dot(self, other: Self) -> Vec4 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline]
    fn map(self, other: Self, f: impl Fn(Vec4, Vec4) -> Vec4) -> Self {
        Self { x: f(self.x, other.x), y: f(self.y, other.y), z: f(self.z, other.z) }
    }

    /// Each lane has the vector of the lane before it; the first one the last of `before`.
    #[inline]
    pub(super) fn behind(self, before: Self) -> Self {
        self.map(before, |own, before| Vec4::new(before.w, own.x, own.y, own.z))
    }

    /// Each lane has the vector of the lane after it; the last one the first of `next`.
    #[inline]
    pub(super) fn ahead(self, next: Self) -> Self {
        self.map(next, |own, next| Vec4::new(own.y, own.z, own.w, next.x))
    }

    /// Each vector times a number of its own.
    #[inline]
    pub(super) fn times(self, factor: Vec4) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

impl Add for Four {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        self.map(other, |a, b| a + b)
    }
}

impl AddAssign for Four {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Four {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self.map(other, |a, b| a - b)
    }
}

impl Mul for Four {
    type Output = Self;
    /// Number by number.
    #[inline]
    fn mul(self, other: Self) -> Self {
        self.map(other, |a, b| a * b)
    }
}

/// Symmetric matrices of four nodes: the diagonal, and yz, zx, xy.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Matrices {
    pub(super) diagonal: Four,
    pub(super) off: Four,
}

impl Matrices {
    /// The outer product of each vector with itself, weighted.
    #[inline]
    pub(super) fn outer(a: Four, weight: Vec4) -> Self {
        let w = a.times(weight);
        let next = Four { x: a.y, y: a.z, z: a.x };
        let turned = Four { x: w.z, y: w.x, z: w.y };
        Self { diagonal: a * w, off: next * turned }
    }

    #[inline]
    pub(super) fn ahead(self, next: Self) -> Self {
        Self { diagonal: self.diagonal.ahead(next.diagonal), off: self.off.ahead(next.off) }
    }

    /// a M b of each.
    #[inline]
    pub(super) fn quadratic(&self, a: Four, b: Four) -> Vec4 {
        let crossed = Four { x: a.y * b.z + a.z * b.y, y: a.z * b.x + a.x * b.z, z: a.x * b.y + a.y * b.x };
        (a * b).dot(self.diagonal) + crossed.dot(self.off)
    }
}

impl Add for Matrices {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self { diagonal: self.diagonal + other.diagonal, off: self.off + other.off }
    }
}
