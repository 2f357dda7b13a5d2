//! The Cholesky factor of a sparse system, in an order found by nested dissection: made once, it serves many right sides.

use super::solver::Matrix;
use super::soup::{NONE, rising};
use glam::DVec3;

/// Sets of at most this many unknowns are not divided.
const SMALL: usize = 16;
/// A set is cut across sides of at least this share of its longest one, into parts of at least one in so many.
const NARROW: f64 = 0.4;
const LEAST_SHARE: usize = 3;

/// A factor L with L L^T = A, by columns.
#[derive(Debug)]
pub(super) struct Factor {
    /// The unknown that each place of the order has.
    order: Vec<u32>,
    /// Where the column of each place begins, below its diagonal.
    starts: Vec<usize>,
    rows: Vec<u32>,
    values: Vec<f64>,
    /// One over the diagonal.
    inverse: Vec<f64>,
}

impl Factor {
    /// Factors a matrix whose unknowns lie at `places`; those of `last` have many neighbors. `None` where a pivot is not
    /// positive.
    pub(super) fn new(matrix: &Matrix, places: &[DVec3], last: &[u32]) -> Option<Self> {
        let order = dissect(matrix, places, last);
        let mut place = vec![0_u32; order.len()];
        for (k, unknown) in order.iter().enumerate() {
            place[*unknown as usize] = k as u32;
        }
        let parent = elimination_tree(matrix, &order, &place);
        let mut reach = Reach { parent: &parent, mark: vec![NONE; order.len()], stack: Vec::new() };
        let mut starts = vec![0_usize; order.len() + 1];
        for k in 0..order.len() {
            for column in reach.of(matrix, &order, &place, k) {
                starts[*column as usize + 1] += 1;
            }
        }
        for k in 1..starts.len() {
            starts[k] += starts[k - 1];
        }
        let filled = starts.last().copied().unwrap_or(0);
        let (mut rows, mut values) = (vec![0_u32; filled], vec![0.0; filled]);
        let mut ends = starts.clone();
        let mut inverse = vec![0.0; order.len()];
        let mut x = vec![0.0; order.len()];
        reach.mark.fill(NONE);
        for k in 0..order.len() {
            let unknown = order[k] as usize;
            for (other, value) in matrix.row(unknown) {
                // A group may see another one across several edges.
                x[place[other] as usize] += value;
            }
            let mut pivot = matrix.diagonal[unknown];
            reach.of(matrix, &order, &place, k);
            // From the root of the tree the columns come out in falling order of depth.
            for &column in reach.stack.iter().rev() {
                let j = column as usize;
                let value = x[j] * inverse[j];
                x[j] = 0.0;
                let range = starts[j]..ends[j];
                for (row, entry) in rows[range.clone()].iter().zip(&values[range]) {
                    x[*row as usize] -= entry * value;
                }
                pivot -= value * value;
                rows[ends[j]] = k as u32;
                values[ends[j]] = value;
                ends[j] += 1;
            }
            // What was scattered above the diagonal belongs to later rows.
            for (other, _) in matrix.row(unknown) {
                x[place[other] as usize] = 0.0;
            }
            x[k] = 0.0;
            if pivot.is_nan() || pivot <= 0.0 {
                return None;
            }
            inverse[k] = 1.0 / pivot.sqrt();
        }
        Some(Self { order, starts, rows, values, inverse })
    }

    /// The solution for one right side.
    pub(super) fn solve(&self, right: &[f64]) -> Vec<f64> {
        let mut x: Vec<f64> = self.order.iter().map(|unknown| right[*unknown as usize]).collect();
        for j in 0..x.len() {
            let value = x[j] * self.inverse[j];
            x[j] = value;
            if value != 0.0 {
                let range = self.starts[j]..self.starts[j + 1];
                for (row, entry) in self.rows[range.clone()].iter().zip(&self.values[range]) {
                    x[*row as usize] -= entry * value;
                }
            }
        }
        for j in (0..x.len()).rev() {
            let range = self.starts[j]..self.starts[j + 1];
            let entries = self.rows[range.clone()].iter().zip(&self.values[range]);
            let sum: f64 = entries.map(|(row, entry)| entry * x[*row as usize]).sum();
            x[j] = (x[j] - sum) * self.inverse[j];
        }
        let mut solution = vec![0.0; x.len()];
        for (unknown, value) in self.order.iter().zip(x) {
            solution[*unknown as usize] = value;
        }
        solution
    }
}

/// For each place the next one that its elimination touches.
fn elimination_tree(matrix: &Matrix, order: &[u32], place: &[u32]) -> Vec<u32> {
    let mut parent = vec![NONE; order.len()];
    let mut ancestor = vec![NONE; order.len()];
    for (k, unknown) in order.iter().enumerate() {
        for (other, _) in matrix.row(*unknown as usize) {
            let mut i = place[other];
            while i != NONE && (i as usize) < k {
                let next = ancestor[i as usize];
                ancestor[i as usize] = k as u32;
                if next == NONE {
                    parent[i as usize] = k as u32;
                }
                i = next;
            }
        }
    }
    parent
}

/// The columns that have an entry in a row of the factor.
struct Reach<'p> {
    parent: &'p [u32],
    mark: Vec<u32>,
    stack: Vec<u32>,
}

impl Reach<'_> {
    /// Those of row `k`, to be worked from the last to the first.
    fn of(&mut self, matrix: &Matrix, order: &[u32], place: &[u32], k: usize) -> &[u32] {
        self.stack.clear();
        self.mark[k] = k as u32;
        for (other, _) in matrix.row(order[k] as usize) {
            let mut i = place[other];
            if i as usize >= k {
                continue;
            }
            let begin = self.stack.len();
            while self.mark[i as usize] != k as u32 {
                self.mark[i as usize] = k as u32;
                self.stack.push(i);
                i = self.parent[i as usize];
            }
            // A path found later hangs below one found before, and is worked first.
            self.stack[begin..].reverse();
        }
        &self.stack
    }
}

/// An order in which little fills in: both halves of every set, then what lies between them (George 1973). Sets are cut
/// by planes, where fewest unknowns touch the other side.
fn dissect(matrix: &Matrix, places: &[DVec3], last: &[u32]) -> Vec<u32> {
    let count = places.len();
    let mut side = vec![0_u32; count];
    for unknown in last {
        side[*unknown as usize] = NONE;
    }
    // The unknowns by each coordinate; all three lists are divided alike.
    let mut sorted = [0, 1, 2].map(|axis| {
        let among = (0..count as u32).filter(|i| side[*i as usize] != NONE);
        rising(among.map(|i| (places[i as usize][axis], i)))
    });
    let mut rank = vec![0_u32; count];
    let mut change: Vec<i32> = Vec::new();
    let mut swap: Vec<u32> = Vec::new();
    // Ranges still to be divided, each within a set of its own number.
    let mut open = vec![(0, count - last.len(), 0)];
    let mut number = 0;
    while let Some((from, to, set)) = open.pop() {
        let size = to - from;
        if size <= SMALL {
            continue;
        }
        let extent = |axis: usize| {
            let list = &sorted[axis][from..to];
            places[list[size - 1] as usize][axis] - places[list[0] as usize][axis]
        };
        let most = extent(0).max(extent(1)).max(extent(2));
        // The fewest that touch the other side, the axis, and how many lie below.
        let mut best = (usize::MAX, 0, size / 2);
        for axis in (0..3).filter(|axis| extent(*axis) >= NARROW * most) {
            let list = &sorted[axis][from..to];
            for (k, unknown) in (0..).zip(list) {
                rank[*unknown as usize] = k;
            }
            // An unknown of the lower side touches the upper one in all cuts between it and its last neighbor.
            change.clear();
            change.resize(size + 1, 0);
            for (k, unknown) in list.iter().enumerate() {
                let near = matrix.row(*unknown as usize).filter(|(other, _)| side[*other] == set);
                let farthest = near.map(|(other, _)| rank[other] as usize).max().unwrap_or(0);
                if farthest > k {
                    change[k + 1] += 1;
                    change[farthest + 1] -= 1;
                }
            }
            let mut touching = 0;
            for (cut, change) in change.iter().enumerate() {
                touching += change;
                let balanced = cut.min(size - cut) * LEAST_SHARE >= size;
                if balanced && (touching as usize) < best.0 {
                    best = (touching as usize, axis, cut);
                }
            }
        }
        let (between, axis, cut) = best;
        if between >= cut {
            continue;
        }
        let (below, above) = (number + 1, number + 2);
        number += 2;
        for (k, unknown) in sorted[axis][from..to].iter().enumerate() {
            side[*unknown as usize] = if k < cut { below } else { above };
        }
        for unknown in &sorted[axis][from..from + cut] {
            if matrix.row(*unknown as usize).any(|(other, _)| side[other] == above) {
                side[*unknown as usize] = NONE;
            }
        }
        for list in &mut sorted {
            let list = &mut list[from..to];
            swap.clear();
            for part in [below, above, NONE] {
                swap.extend(list.iter().filter(|unknown| side[**unknown as usize] == part));
            }
            list.copy_from_slice(&swap);
        }
        open.push((from, from + cut - between, below));
        open.push((from + cut - between, to - between, above));
    }
    let [mut order, ..] = sorted;
    order.extend(last);
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The Laplacian of a grid with diagonals, grounded at its first node; the last unknown is tied to many others.
    fn grid(side: u32) -> (Matrix, Vec<DVec3>) {
        let count = side * side;
        let mut edges: Vec<(u32, u32, f64)> = Vec::new();
        for k in 0..count {
            let (x, y) = (k % side, k / side);
            let weight = 0.3 + f64::from(k * 7 % 11);
            if x + 1 < side {
                edges.push((k, k + 1, weight));
            }
            if y + 1 < side {
                edges.push((k, k + side, 1.0));
            }
            if x + 1 < side && y + 1 < side {
                edges.push((k, k + side + 1, 0.1));
            }
            if k % 5 == 3 {
                edges.push((k, count, 0.7));
            }
        }
        let mut matrix = Matrix { starts: vec![0], ..Matrix::default() };
        for row in 1..=count {
            let mut diagonal = 0.0;
            for (a, b, weight) in &edges {
                if *a == row || *b == row {
                    let other = a + b - row;
                    diagonal += weight;
                    if other > 0 {
                        matrix.columns.push(other - 1);
                        matrix.values.push(-weight);
                    }
                }
            }
            matrix.diagonal.push(diagonal);
            matrix.starts.push(matrix.columns.len() as u32);
        }
        let place = |k: u32| DVec3::new(f64::from(k % side), f64::from(k / side), 0.0);
        (matrix, (1..=count).map(place).collect())
    }

    #[test]
    fn solutions_satisfy_their_equations() {
        for side in [2, 5, 30] {
            let (matrix, places) = grid(side);
            let count = places.len();
            let factor = Factor::new(&matrix, &places, &[count as u32 - 1]).unwrap();
            let mut order = factor.order.clone();
            order.sort_unstable();
            assert_eq!(order, (0..count as u32).collect::<Vec<_>>());
            for seed in 0..3 {
                let right: Vec<f64> = (0..count).map(|i| ((i * 31 + seed * 17) % 23) as f64 - 11.0).collect();
                let x = factor.solve(&right);
                for (i, right) in right.iter().enumerate() {
                    let sum: f64 = matrix.row(i).map(|(j, a)| a * x[j]).sum();
                    let rest = matrix.diagonal[i] * x[i] + sum - right;
                    assert!(rest.abs() < 1e-9, "{side} {i}: {rest}");
                }
            }
        }
    }

    #[test]
    fn little_fills_in() {
        let (matrix, places) = grid(64);
        let factor = Factor::new(&matrix, &places, &[places.len() as u32 - 1]).unwrap();
        // A band would have 64 entries a column.
        assert!(factor.rows.len() < 30 * places.len(), "{}", factor.rows.len() / places.len());
    }

    #[test]
    fn what_has_no_factor_is_refused() {
        let (mut matrix, places) = grid(5);
        matrix.diagonal[7] = -1.0;
        assert!(Factor::new(&matrix, &places, &[]).is_none());
    }
}
