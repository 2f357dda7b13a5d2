//! Where short rows go: disjoint runs of a new row that lag behind the surface, chosen by a dynamic program.
//!
//! A short row adds two rows over its run. The cost of a plan is the sum of squared missing heights after it, plus a
//! price per run end. That is the paper's double threshold: a run of least length opens when its mean missing height passes
//! the activation threshold, and a gap between two runs is bridged when its mean passes the tolerance threshold.

use crate::ir::NodeId;
use std::collections::VecDeque;
use std::ops::Range;

/// Least stitches between two runs, and between a run and the end of the row.
pub(crate) const GAP: usize = 3;

/// A stretch of the ring that short rows may lie on.
pub(crate) struct Stretch {
    /// Its place in the ring.
    pub start: usize,
    pub tops: Vec<NodeId>,
    /// Where a run may begin or end: not between the two tops of one increase.
    pub cut: Vec<bool>,
}

/// What the plan has to keep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rules {
    /// Least and greatest length of a run.
    pub length: [usize; 2],
    /// Missing height at which adding two rows is worth as much as leaving it.
    pub break_even: f64,
    /// Price of one end of a run, in squared stitch heights.
    pub end_price: f64,
}

impl Rules {
    /// Rules with the paper's two thresholds, stated for runs of `least` stitches and gaps of [`GAP`].
    pub(crate) fn from_thresholds(activation: f64, tolerance: f64, least: usize, greatest: usize) -> Self {
        // The price shifts both thresholds: activation = even + price / (2 least), tolerance = even - price / (2 GAP).
        const NOMINAL: f64 = 8.0;
        let end_price = (activation - tolerance) / (0.5 / NOMINAL + 0.5 / GAP as f64);
        let break_even = activation - 0.5 * end_price / NOMINAL;
        Self { length: [least, greatest.max(least)], break_even, end_price }
    }

    /// Some run may be worth its two ends.
    pub(crate) fn may_pay(&self, missing: &[f64]) -> bool {
        let (mut best, mut sum) = (0.0_f64, 0.0_f64);
        for d in missing {
            sum = (sum + (d - self.break_even)).max(0.0);
            best = best.max(sum);
        }
        4.0 * best > 2.0 * self.end_price
    }
}

/// Plans the runs of one row.
#[derive(Debug, Default)]
pub(crate) struct Planner {
    best: Vec<f64>,
    from: Vec<u32>,
    prefix: Vec<f64>,
    window: VecDeque<(u32, f64)>,
}

const NONE: u32 = u32::MAX;

impl Planner {
    /// The runs of cheapest total cost, in ascending order, into `runs`. `missing[k]` is the missing height at top k in stitch
    /// heights, `extra[k]` an extra price for an end there, and `cut[k]` tells whether a run may begin or end before top k.
    pub(crate) fn solve(
        &mut self,
        missing: &[f64],
        extra: &[f64],
        cut: &[bool],
        rules: &Rules,
        runs: &mut Vec<Range<usize>>,
    ) {
        let n = missing.len();
        runs.clear();
        let Self { best, from, prefix, window } = self;
        prefix.clear();
        prefix.push(0.0);
        let mut sum = 0.0;
        prefix.extend(missing.iter().map(|d| {
            sum += 4.0 * (rules.break_even - d);
            sum
        }));
        best.clear();
        best.resize(n + 1, 0.0);
        from.clear();
        from.resize(n + 1, NONE);
        window.clear();
        let [least, greatest] = rules.length;
        for i in 1..=n {
            best[i] = best[i - 1];
            let Some(end) = i.checked_sub(GAP) else { continue };
            // The start that just became far enough away joins the window; those too far leave it.
            if let Some(start) = end.checked_sub(least).filter(|start| *start >= GAP && cut[*start]) {
                let key = best[start] - prefix[start] + extra[start];
                while window.back().is_some_and(|last| last.1 > key) {
                    window.pop_back();
                }
                window.push_back((start as u32, key));
            }
            while window.front().is_some_and(|first| (first.0 as usize) + greatest < end) {
                window.pop_front();
            }
            if end < n
                && cut[end]
                && let Some(&(start, key)) = window.front()
            {
                let cost = key + prefix[end] + extra[end - 1] + 2.0 * rules.end_price;
                if cost < best[i] - 1e-9 {
                    best[i] = cost;
                    from[i] = start;
                }
            }
        }
        let mut i = n;
        while i > 0 {
            if from[i] == NONE {
                i -= 1;
            } else {
                let start = from[i] as usize;
                runs.push(start..i - GAP);
                i = start;
            }
        }
        runs.reverse();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(missing: &[f64]) -> Vec<Range<usize>> {
        let n = missing.len();
        let mut runs = Vec::new();
        let rules = Rules::from_thresholds(1.125, 2.0 / 3.0, 8, n * 6 / 10);
        Planner::default().solve(missing, &vec![0.0; n], &vec![true; n], &rules, &mut runs);
        runs
    }

    fn row(n: usize, hills: &[(Range<usize>, f64)]) -> Vec<f64> {
        let mut row = vec![0.0; n];
        for (range, height) in hills {
            row[range.clone()].fill(*height);
        }
        row
    }

    #[test]
    fn a_level_row_needs_none() {
        assert!(plan(&[0.4; 50]).is_empty());
    }

    #[test]
    fn a_hill_over_the_activation_threshold_opens_one() {
        assert_eq!(plan(&row(40, &[(10..18, 1.2)])), vec![10..18]);
        assert!(plan(&row(40, &[(10..18, 1.1)])).is_empty());
    }

    #[test]
    fn close_hills_merge_when_the_valley_is_within_tolerance() {
        assert_eq!(plan(&row(60, &[(10..18, 1.5), (18..21, 0.8), (21..29, 1.5)])), vec![10..29]);
        assert_eq!(plan(&row(60, &[(10..18, 1.5), (18..21, 0.5), (21..29, 1.5)])), vec![10..18, 21..29]);
    }

    #[test]
    fn the_window_finds_what_a_full_search_finds() {
        let mut seed = 1_u64;
        let mut random = || {
            seed ^= seed << 13;
            seed ^= seed >> 7;
            seed ^= seed << 17;
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        for _ in 0..200 {
            let n = 20 + (random() * 40.0) as usize;
            let mut level = 0.0;
            let missing: Vec<f64> = (0..n)
                .map(|_| {
                    level = 0.8 * level + random() - 0.35;
                    2.0 * level
                })
                .collect();
            let rules = Rules::from_thresholds(1.125, 2.0 / 3.0, 8, n * 6 / 10);
            let mut best = vec![0.0; n + 1];
            for i in 1..=n {
                best[i] = best[i - 1];
                for start in GAP..n {
                    let Some(end) = i.checked_sub(GAP) else { continue };
                    if end >= n || end < start + rules.length[0] || end > start + rules.length[1] {
                        continue;
                    }
                    let gain: f64 = missing[start..end].iter().map(|d| 4.0 * (rules.break_even - d)).sum();
                    best[i] = f64::min(best[i], best[start] + gain + 2.0 * rules.end_price);
                }
            }
            let mut planner = Planner::default();
            planner.solve(&missing, &vec![0.0; n], &vec![true; n], &rules, &mut Vec::new());
            assert!((planner.best[n] - best[n]).abs() < 1e-6);
            assert!(rules.may_pay(&missing) || best[n] > -1e-9);
        }
    }
}
