//! More tries where increases stand on increases although they need not: stacked ones draw a ridge.

use super::score::{area, p95};
use super::tries::Made;
use rayon::prelude::*;

/// Share of increases on others, of those that could stand clear, that draws no ridge.
const FEW: f64 = 0.05;
/// What a try may be worse by, as much as the luck of single shapings makes in any two: mean and 95th percentile of the absolute
/// length error, skew, and rows between the highest and the lowest loop of the last turn, of which so many are free.
const LUCK: [f64; 4] = [0.003, 0.007, 0.007, 0.25];
const LEVEL_FREE: f64 = 0.75;
/// How much more or less its tiles may cover, as a share.
const COVERED: f64 = 0.008;
/// A try whose score is so much worse before its rows have settled is given up: tiles may still turn over.
const BAR: f64 = 2.3;
/// Tries that are made two at a time: the change, and the fewest bases between two increases of a row. Increases side by side make
/// a bump of their own, so they are not tried first. In the order in which fewest do, over 98 parts: five shapes at 13
/// gauges, and tubes along random planar curves.
const TRIES: [[(usize, usize); 2]; 8] = [
    [(2, 1), (10, 1)],
    [(3, 2), (6, 1)],
    [(5, 0), (10, 0)],
    [(0, 0), (6, 0)],
    [(7, 0), (8, 0)],
    [(1, 0), (9, 1)],
    [(2, 0), (5, 1)],
    [(11, 0), (11, 1)],
];
/// How many of these are made on large parts.
const ON_LARGE: usize = 2;

/// A try with hardly any increases on others that is as good as the best one or nearly so, where that has many. `make` makes one with
/// a change, the fewest bases between increases, and the score over which it is given up.
pub(super) fn without(
    best: &Made,
    large: bool,
    make: impl Fn(usize, usize, f64) -> Option<Made> + Sync,
) -> Option<Made> {
    if best.0.inverted > 0 || !has_ridges(best) {
        return None;
    }
    let bar = best.0.total + BAR;
    let mut good: Option<Made> = None;
    for tries in TRIES.into_iter().take(if large { ON_LARGE } else { TRIES.len() }) {
        let made: Vec<Option<Made>> =
            tries.into_par_iter().map(|(change, apart)| make(change, apart, bar)).collect();
        for made in made.into_iter().flatten() {
            let is_best = good.as_ref().is_none_or(|good| made.0.total < good.0.total);
            if is_best && is_as_good(&made, best) && !has_ridges(&made) {
                good = Some(made);
            }
        }
        if good.as_ref().is_some_and(|good| good.0.total <= best.0.total) {
            break;
        }
    }
    good
}

fn has_ridges((_, laid): &Made) -> bool {
    laid.increases().by_choice() > FEW
}

fn is_as_good((score, laid): &Made, (best, best_laid): &Made) -> bool {
    let [length, tail, skew, level] = LUCK;
    score.inverted == 0
        && score.length <= best.length + length
        && p95(&laid.sheet) <= p95(&best_laid.sheet) + tail
        && (area(&laid.sheet) / area(&best_laid.sheet) - 1.0).abs() <= COVERED
        && score.skew <= best.skew + skew
        && laid.spread <= (best_laid.spread + level).max(LEVEL_FREE)
}
