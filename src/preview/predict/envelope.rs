//! Cholesky factors of a symmetric matrix, stored from each row's first entry to the diagonal. Along the yarn the
//! neighbors of a loop are at most about one round away, so the helix itself is a good order of the unknowns.
//!
//! The factor only leads the way of a search that ends at its own measure, so single precision is enough; and unknowns
//! come in threes, so nine products are summed for six numbers that are read.

use glam::{DVec3, Vec3, Vec4};

/// A symmetric positive definite matrix of blocks of 3 by 3, then its factor.
pub(super) struct Envelope {
    /// First block of each row of blocks.
    first: Vec<u32>,
    /// Where each row of blocks begins in `values`: three rows of numbers, as long as each other.
    start: Vec<usize>,
    values: Vec<f32>,
}

impl Envelope {
    /// The first block of each row for nodes joined by these edges, and how many numbers the matrix needs.
    pub(super) fn size(count: usize, edges: impl Iterator<Item = [u32; 2]>) -> (Vec<u32>, u64) {
        let mut first: Vec<u32> = (0..count as u32).collect();
        for [a, b] in edges {
            let (low, high) = (a.min(b), a.max(b));
            first[high as usize] = first[high as usize].min(low);
        }
        let size =
            first.iter().enumerate().map(|(row, first)| 9 * (row as u64 - u64::from(*first) + 1)).sum();
        (first, size)
    }

    /// A matrix of zeros with these first blocks.
    pub(super) fn new(first: Vec<u32>) -> Self {
        let mut start = Vec::with_capacity(first.len());
        let mut size = 0;
        for (row, first) in first.iter().enumerate() {
            start.push(size);
            size += 9 * (row - *first as usize + 1);
        }
        Self { first, start, values: vec![0.0; size] }
    }

    /// Sets all entries to zero.
    pub(super) fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// Adds a symmetric block at a row and a column of blocks; of the two orders it is told one.
    pub(super) fn add(&mut self, row: usize, column: usize, block: [[f64; 3]; 3]) {
        let (row, column) = (row.max(column), row.min(column));
        let first = self.first[row] as usize;
        let (length, at) = (3 * (row - first + 1), self.start[row] + 3 * (column - first));
        for (i, line) in block.iter().enumerate() {
            for (to, value) in self.values[at + i * length..][..3].iter_mut().zip(line) {
                *to += *value as f32;
            }
        }
    }

    /// Factors the matrix in place; false when it is not positive definite.
    pub(super) fn factor(&mut self) -> bool {
        for row in 0..self.first.len() {
            let first = self.first[row] as usize;
            let (done, current) = self.values.split_at_mut(self.start[row]);
            let length = 3 * (row - first + 1);
            for column in first..row {
                let other_first = self.first[column] as usize;
                let from = first.max(other_first);
                let other_length = 3 * (column - other_first + 1);
                let (at, other_at) = (3 * (from - first), self.start[column] + 3 * (from - other_first));
                let count = 3 * (column - from);
                let own: [&[f32]; 3] = std::array::from_fn(|i| &current[i * length + at..][..count]);
                let other: [&[f32]; 3] =
                    std::array::from_fn(|j| &done[other_at + j * other_length..][..count + 3]);
                let sums = products(own, other);
                let [l0, l1, l2] = other.map(|line| &line[count..]);
                for (i, sums) in sums.iter().enumerate() {
                    let line = &mut current[i * length + at + count..][..3];
                    line[0] = (line[0] - sums[0]) / l0[0];
                    line[1] = (line[1] - sums[1] - line[0] * l1[0]) / l1[1];
                    line[2] = (line[2] - sums[2] - line[0] * l2[0] - line[1] * l2[1]) / l2[2];
                }
            }
            let count = length - 3;
            let own: [&[f32]; 3] = std::array::from_fn(|i| &current[i * length..][..count]);
            let sums = products(own, own);
            for i in 0..3 {
                for j in 0..=i {
                    let mut rest = current[i * length + count + j] - sums[i][j];
                    for k in 0..j {
                        rest -= current[i * length + count + k] * current[j * length + count + k];
                    }
                    current[i * length + count + j] = if i > j {
                        rest / current[j * length + count + j]
                    } else if rest > 0.0 {
                        rest.sqrt()
                    } else {
                        return false;
                    };
                }
            }
        }
        true
    }

    /// Solves with the factor, in place.
    pub(super) fn solve(&self, way: &mut [DVec3]) {
        let mut x: Vec<f32> = way.iter().flat_map(|way| way.as_vec3().to_array()).collect();
        for row in 0..self.first.len() {
            let (first, [a, b, c]) = self.lines(row);
            let (known, rest) = x.split_at_mut(3 * row);
            let known = &known[3 * first..];
            let count = known.len();
            let [sa, sb, sc] = products([a, b, c].map(|line| &line[..count]), [known; 3]).map(|sums| sums[0]);
            let [x0, x1, x2, ..] = rest else { break };
            *x0 = (*x0 - sa) / a[count];
            *x1 = (*x1 - sb - *x0 * b[count]) / b[count + 1];
            *x2 = (*x2 - sc - *x0 * c[count] - *x1 * c[count + 1]) / c[count + 2];
        }
        for row in (0..self.first.len()).rev() {
            let (first, [a, b, c]) = self.lines(row);
            let (left, rest) = x.split_at_mut(3 * row);
            let left = &mut left[3 * first..];
            let count = left.len();
            let [x0, x1, x2, ..] = rest else { break };
            *x2 /= c[count + 2];
            *x1 = (*x1 - *x2 * c[count + 1]) / b[count + 1];
            *x0 = (*x0 - *x2 * c[count] - *x1 * b[count]) / a[count];
            for (((left, a), b), c) in left.iter_mut().zip(a).zip(b).zip(c) {
                *left -= *x0 * a + *x1 * b + *x2 * c;
            }
        }
        for (way, x) in way.iter_mut().zip(x.chunks_exact(3)) {
            *way = Vec3::from_slice(x).as_dvec3();
        }
    }

    /// The first block of a row of blocks, and its three rows of numbers.
    fn lines(&self, row: usize) -> (usize, [&[f32]; 3]) {
        let first = self.first[row] as usize;
        let length = 3 * (row - first + 1);
        (first, std::array::from_fn(|i| &self.values[self.start[row] + i * length..][..length]))
    }
}

/// The sums of products of each of three rows with each of three others, which may be longer. In four lanes, so that
/// the processor can keep up; always in the same order.
fn products(a: [&[f32]; 3], b: [&[f32]; 3]) -> [[f32; 3]; 3] {
    let count = a[0].len();
    fn fours(line: &[f32], count: usize) -> &[[f32; 4]] {
        line[..count].as_chunks().0
    }
    let ([a0, a1, a2], [b0, b1, b2]) = (a.map(|line| fours(line, count)), b.map(|line| fours(line, count)));
    let mut lanes = [[Vec4::ZERO; 3]; 3];
    for (((((a0, a1), a2), b0), b1), b2) in a0.iter().zip(a1).zip(a2).zip(b0).zip(b1).zip(b2) {
        let a = [a0, a1, a2].map(|four| Vec4::from_array(*four));
        let b = [b0, b1, b2].map(|four| Vec4::from_array(*four));
        for (lanes, a) in lanes.iter_mut().zip(a) {
            for (lanes, b) in lanes.iter_mut().zip(b) {
                *lanes += a * b;
            }
        }
    }
    let mut sums = lanes.map(|lanes| lanes.map(|lanes| (lanes.x + lanes.y) + (lanes.z + lanes.w)));
    for at in count / 4 * 4..count {
        for (sums, a) in sums.iter_mut().zip(a) {
            for (sum, b) in sums.iter_mut().zip(b) {
                *sum += a[at] * b[at];
            }
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chain_with_a_far_edge_is_solved() {
        const N: usize = 18;
        let edges = [[0_u32, 1_u32], [1, 2], [2, 3], [3, 4], [0, 4], [4, 5]];
        let (first, size) = Envelope::size(6, edges.iter().copied());
        assert_eq!(size, 9 * (1 + 2 + 2 + 2 + 5 + 2));
        let mut matrix = Envelope::new(first);
        let mut full = [[0.0; N]; N];
        let mut add = |row: usize, column: usize, block: [[f64; 3]; 3]| {
            matrix.add(row, column, block);
            for i in 0..3 {
                for j in 0..3 {
                    full[3 * row + i][3 * column + j] += block[i][j];
                    if row != column {
                        full[3 * column + j][3 * row + i] += block[i][j];
                    }
                }
            }
        };
        let own = [[1.0, 0.2, 0.1], [0.2, 1.1, 0.0], [0.1, 0.0, 0.9]];
        let between = own.map(|line| line.map(|value: f64| -0.9 * value));
        for [a, b] in edges.map(|edge| edge.map(|node| node as usize)) {
            add(a, a, own);
            add(b, b, own);
            add(b, a, between);
        }
        for k in 0..6 {
            add(k, k, [[0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.5]]);
        }
        assert!(matrix.factor());
        let wanted: [DVec3; 6] = std::array::from_fn(|k| DVec3::new(1.0, k as f64, 2.0 - k as f64));
        let flat: Vec<f64> = wanted.iter().flat_map(DVec3::to_array).collect();
        let mut x: Vec<DVec3> = full
            .chunks_exact(3)
            .map(|lines| {
                let [x, y, z] = std::array::from_fn(|i| lines[i].iter().zip(&flat).map(|(a, x)| a * x).sum());
                DVec3::new(x, y, z)
            })
            .collect();
        matrix.solve(&mut x);
        assert!(x.iter().zip(wanted).all(|(x, wanted)| x.distance(wanted) < 1e-4), "{x:?}");
    }

    #[test]
    fn what_is_not_positive_is_refused() {
        let mut matrix = Envelope::new(vec![0]);
        matrix.add(0, 0, [[1.0, 2.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        assert!(!matrix.factor());
    }
}
