//! Cholesky factors of a symmetric matrix, stored from each row's first entry to the diagonal. Along the yarn the
//! neighbors of a loop are at most about one round away, so the helix itself is a good order of the unknowns.

/// A symmetric positive definite matrix, then its factor.
pub(super) struct Envelope {
    /// First column of each row.
    first: Vec<u32>,
    /// Where each row begins in `values`.
    start: Vec<usize>,
    values: Vec<f64>,
}

impl Envelope {
    /// First columns for unknowns that come in threes, one three a node, joined by these edges; and the entries that
    /// the matrix needs.
    pub(super) fn size(count: usize, edges: impl Iterator<Item = [u32; 2]>) -> (Vec<u32>, u64) {
        let mut first: Vec<u32> = (0..count as u32).collect();
        for [a, b] in edges {
            let (low, high) = (a.min(b), a.max(b));
            first[high as usize] = first[high as usize].min(low);
        }
        let first: Vec<u32> = first.iter().flat_map(|first| [3 * first; 3]).collect();
        let size = first.iter().enumerate().map(|(row, first)| row as u64 - u64::from(*first) + 1).sum();
        (first, size)
    }

    /// Sets all entries to zero.
    pub(super) fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// A matrix of zeros with these first columns.
    pub(super) fn new(first: Vec<u32>) -> Self {
        let mut start = Vec::with_capacity(first.len());
        let mut size = 0;
        for (row, first) in first.iter().enumerate() {
            start.push(size);
            size += row - *first as usize + 1;
        }
        Self { first, start, values: vec![0.0; size] }
    }

    /// Adds to an entry of the lower triangle.
    pub(super) fn add(&mut self, row: usize, column: usize, value: f64) {
        let (row, column) = (row.max(column), row.min(column));
        self.values[self.start[row] + column - self.first[row] as usize] += value;
    }

    /// Factors the matrix in place; false when it is not positive definite.
    pub(super) fn factor(&mut self) -> bool {
        for row in 0..self.first.len() {
            let first = self.first[row] as usize;
            let (done, current) = self.values.split_at_mut(self.start[row]);
            let mut square = 0.0;
            for column in first..row {
                let other_first = self.first[column] as usize;
                let from = first.max(other_first);
                let shift = self.start[column];
                let other = &done[shift + from - other_first..=shift + column - other_first];
                let own = &current[from - first..column - first];
                let (pivot, other) =
                    other.split_last().map_or((1.0, other), |(pivot, other)| (*pivot, other));
                let sum = current[column - first] - dot(own, other);
                let value = sum / pivot;
                current[column - first] = value;
                square += value * value;
            }
            let rest = current[row - first] - square;
            if rest.is_nan() || rest <= 0.0 {
                return false;
            }
            current[row - first] = rest.sqrt();
        }
        true
    }

    /// Solves with the factor, in place.
    pub(super) fn solve(&self, x: &mut [f64]) {
        for row in 0..self.first.len() {
            let first = self.first[row] as usize;
            let values = &self.values[self.start[row]..=self.start[row] + row - first];
            let (known, rest) = x.split_at_mut(row);
            rest[0] = (rest[0] - dot(&values[..row - first], &known[first..])) / values[row - first];
        }
        for row in (0..self.first.len()).rev() {
            let first = self.first[row] as usize;
            let values = &self.values[self.start[row]..=self.start[row] + row - first];
            let solved = x[row] / values[row - first];
            x[row] = solved;
            for (value, left) in values[..row - first].iter().zip(&mut x[first..row]) {
                *left -= solved * *value;
            }
        }
    }
}

/// Sum of products, in four lanes so that the processor can keep up; always in the same order.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut lanes = [0.0; 4];
    let (fours, others) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = fours.remainder().iter().zip(others.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in fours.zip(others) {
        for (lane, (a, b)) in lanes.iter_mut().zip(a.iter().zip(b)) {
            *lane += a * b;
        }
    }
    (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]) + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chain_with_a_far_edge_is_solved() {
        const N: usize = 18;
        let edges = [[0_u32, 1_u32], [1, 2], [2, 3], [3, 4], [0, 4], [4, 5]];
        let (first, size) = Envelope::size(6, edges.iter().copied());
        assert_eq!(size, 9 * (1 + 1 + 1 + 4 + 1) + 6 * 6);
        let mut matrix = Envelope::new(first);
        let mut full = [[0.0; N]; N];
        let mut add = |row: usize, column: usize, value: f64| {
            matrix.add(row, column, value);
            full[row][column] += value;
            if row != column {
                full[column][row] += value;
            }
        };
        for [a, b] in edges.map(|edge| edge.map(|node| 3 * node as usize)) {
            for k in 0..3 {
                for (row, column, value) in [(a, a, 1.0), (b, b, 1.0), (a, b, -0.9)] {
                    add(row + k, column + k, value);
                }
            }
            add(b, a + 1, 0.3);
        }
        for k in 0..N {
            add(k, k, 0.5);
        }
        assert!(matrix.factor());
        let right: [f64; N] = std::array::from_fn(|k| (k * k % 7) as f64 - 2.0);
        let mut x = right;
        matrix.solve(&mut x);
        for (row, right) in full.iter().zip(&right) {
            let back: f64 = row.iter().zip(&x).map(|(value, x)| x * value).sum();
            assert!((back - right).abs() < 1e-12);
        }
    }

    #[test]
    fn what_is_not_positive_is_refused() {
        let (first, _) = Envelope::size(1, std::iter::empty());
        assert!(!Envelope::new(first).factor());
    }
}
