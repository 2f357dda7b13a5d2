//! Sparse symmetric systems with positive diagonal: conjugate gradients with an aggregation multigrid in front.
//!
//! The matrices are Laplacians of meshes with some values fixed. Unknowns are joined in pairs twice from level to level, and
//! the cycle is a W, which keeps the number of steps nearly independent of the size (Notay 2010, plain aggregation).

use super::soup::NONE;

/// Unknowns of the coarsest level.
const COARSEST: usize = 24;
const MOST_STEPS: usize = 400;

/// A symmetric matrix by rows; the diagonal stands apart.
#[derive(Debug, Default)]
pub(super) struct Matrix {
    pub(super) diagonal: Vec<f64>,
    pub(super) starts: Vec<u32>,
    pub(super) columns: Vec<u32>,
    pub(super) values: Vec<f64>,
}

impl Matrix {
    fn size(&self) -> usize {
        self.diagonal.len()
    }

    pub(super) fn row(&self, i: usize) -> impl DoubleEndedIterator<Item = (usize, f64)> {
        let range = self.starts[i] as usize..self.starts[i + 1] as usize;
        self.columns[range.clone()].iter().map(|j| *j as usize).zip(self.values[range].iter().copied())
    }

    fn multiply(&self, x: &[f64], out: &mut [f64]) {
        for (i, out) in out.iter_mut().enumerate() {
            *out = self.diagonal[i] * x[i] + self.row(i).map(|(j, a)| a * x[j]).sum::<f64>();
        }
    }

    fn relax(&self, right: &[f64], x: &mut [f64], backward: bool) {
        let mut step = |i: usize| {
            let sum: f64 = self.row(i).map(|(j, a)| a * x[j]).sum();
            x[i] = (right[i] - sum) / self.diagonal[i];
        };
        if backward {
            (0..self.size()).rev().for_each(&mut step);
        } else {
            (0..self.size()).for_each(&mut step);
        }
    }

    /// Pairs every unknown with the free neighbor that it hangs on most; returns the pairs' numbers and their count.
    fn pairs(&self) -> (Vec<u32>, usize) {
        let mut group = vec![NONE; self.size()];
        let mut count = 0;
        for i in 0..self.size() {
            if group[i] != NONE {
                continue;
            }
            let mut best = (0.0, None);
            for (j, a) in self.row(i) {
                if group[j] == NONE && -a > best.0 {
                    best = (-a, Some(j));
                }
            }
            group[i] = count;
            if let Some(j) = best.1 {
                group[j] = count;
            }
            count += 1;
        }
        (group, count as usize)
    }

    /// The matrix of groups: sums over their members.
    fn gather(&self, group: &[u32], count: usize) -> Self {
        let mut starts = vec![0_u32; count + 1];
        for &g in group {
            starts[g as usize + 1] += 1;
        }
        for i in 1..=count {
            starts[i] += starts[i - 1];
        }
        let mut fill = starts.clone();
        let mut members = vec![0_u32; group.len()];
        for (i, &g) in group.iter().enumerate() {
            members[fill[g as usize] as usize] = i as u32;
            fill[g as usize] += 1;
        }
        let mut coarse = Self { starts: vec![0], ..Self::default() };
        let mut slot = vec![NONE; count];
        for g in 0..count {
            let begin = coarse.columns.len();
            let mut diagonal = 0.0;
            for &i in &members[starts[g] as usize..starts[g + 1] as usize] {
                diagonal += self.diagonal[i as usize];
                for (j, a) in self.row(i as usize) {
                    let other = group[j] as usize;
                    if other == g {
                        diagonal += a;
                    } else if slot[other] != NONE && slot[other] as usize >= begin {
                        coarse.values[slot[other] as usize] += a;
                    } else {
                        slot[other] = coarse.columns.len() as u32;
                        coarse.columns.push(other as u32);
                        coarse.values.push(a);
                    }
                }
            }
            coarse.diagonal.push(diagonal);
            coarse.starts.push(coarse.columns.len() as u32);
        }
        coarse
    }
}

#[derive(Debug)]
struct Level {
    matrix: Matrix,
    /// Group of the next level for each unknown; empty at the coarsest.
    group: Vec<u32>,
    right: Vec<f64>,
    x: Vec<f64>,
    rest: Vec<f64>,
}

/// A matrix, ready to be solved for several right hand sides.
#[derive(Debug)]
pub(super) struct Solver {
    levels: Vec<Level>,
}

impl Solver {
    pub(super) fn new(matrix: Matrix) -> Self {
        let level = |matrix: Matrix, group: Vec<u32>| {
            let size = matrix.size();
            Level { matrix, group, right: vec![0.0; size], x: vec![0.0; size], rest: vec![0.0; size] }
        };
        let mut levels = Vec::new();
        let mut matrix = matrix;
        loop {
            let size = matrix.size();
            if size <= COARSEST {
                break;
            }
            let (first, count) = matrix.pairs();
            let half = matrix.gather(&first, count);
            let (second, count) = half.pairs();
            // Unknowns without neighbors cannot be joined.
            if count * 10 > size * 9 {
                break;
            }
            let coarse = half.gather(&second, count);
            let group = first.iter().map(|g| second[*g as usize]).collect();
            levels.push(level(std::mem::replace(&mut matrix, coarse), group));
        }
        levels.push(level(matrix, Vec::new()));
        Self { levels }
    }

    /// Solves to a relative residual of `tolerance`, starting from `x`.
    pub(super) fn solve(&mut self, right: &[f64], x: &mut [f64], tolerance: f64) {
        let size = x.len();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut rest = vec![0.0; size];
        let mut image = vec![0.0; size];
        self.levels[0].matrix.multiply(x, &mut rest);
        for (rest, right) in rest.iter_mut().zip(right) {
            *rest = right - *rest;
        }
        let goal = tolerance * dot(right, right).sqrt().max(f64::MIN_POSITIVE);
        let mut direction = vec![0.0; size];
        let mut before = 0.0;
        for step in 0..MOST_STEPS {
            if dot(&rest, &rest).sqrt() <= goal {
                break;
            }
            let better = self.improve(&rest);
            let now = dot(&rest, better);
            let keep = if step == 0 || before == 0.0 { 0.0 } else { now / before };
            for (direction, better) in direction.iter_mut().zip(better) {
                *direction = better + keep * *direction;
            }
            before = now;
            self.levels[0].matrix.multiply(&direction, &mut image);
            let curve = dot(&direction, &image);
            if curve <= 0.0 || !curve.is_finite() {
                break;
            }
            let length = now / curve;
            for i in 0..size {
                x[i] += length * direction[i];
                rest[i] -= length * image[i];
            }
        }
    }

    /// One cycle from zero.
    fn improve(&mut self, right: &[f64]) -> &[f64] {
        self.levels[0].right.copy_from_slice(right);
        self.levels[0].x.fill(0.0);
        cycle(&mut self.levels);
        &self.levels[0].x
    }
}

fn cycle(levels: &mut [Level]) {
    let Some((fine, coarser)) = levels.split_first_mut() else { return };
    let Some(next) = coarser.first_mut() else {
        // The coarsest level is tiny: relaxed there and back until it is as good as solved.
        for _ in 0..12 {
            fine.matrix.relax(&fine.right, &mut fine.x, false);
            fine.matrix.relax(&fine.right, &mut fine.x, true);
        }
        return;
    };
    fine.matrix.relax(&fine.right, &mut fine.x, false);
    fine.matrix.multiply(&fine.x, &mut fine.rest);
    next.right.fill(0.0);
    for (i, g) in fine.group.iter().enumerate() {
        next.right[*g as usize] += fine.right[i] - fine.rest[i];
    }
    next.x.fill(0.0);
    cycle(coarser);
    cycle(coarser);
    for (i, g) in fine.group.iter().enumerate() {
        fine.x[i] += coarser[0].x[*g as usize];
    }
    fine.matrix.relax(&fine.right, &mut fine.x, true);
}
