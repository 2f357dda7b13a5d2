//! How pleasant a pattern is to work, from its folded rows and its graph.

use crate::ir::increases::Increases;
use crate::ir::{Block, Graph, Kind, Op, Pattern, Step};
use serde::Serialize;

/// Numbers on the reading of a pattern.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Readability {
    /// Words of the folded pattern for each stitch: a run, a repeat and a turn are one each.
    pub words_per_stitch: f64,
    /// Most words in one round.
    pub most_words: usize,
    /// Share of rounds equal to the one before.
    pub equal_rounds: f64,
    /// Share of increases within one stitch of an increase one round below; stacked ones draw a visible ridge.
    pub stacked_increases: f64,
    /// The same among those that could stand clear: where a round has more increases than stitches with none beside them in
    /// the round below, as around a magic ring, some are stacked wherever they are put, and these are left out.
    pub stacked_by_choice: f64,
    /// Short rows for each thousand stitches.
    pub short_rows_per_thousand: f64,
    /// Longest run of equal stitches that has to be counted, where it is not the whole round.
    pub longest_run: u32,
    /// How unevenly increases and decreases lie in a round: standard deviation of the stitches between them as a share
    /// of their mean, averaged over the rounds that have two or more. 0 is even.
    pub uneven_shaping: f64,
}

impl Readability {
    /// Reads a pattern and, where it has them, its graphs.
    pub fn of(pattern: &Pattern, graphs: &[Graph]) -> Self {
        let mut words = 0_usize;
        let (mut rounds, mut equal, mut stitches, mut turns) = (0_u64, 0_u64, 0_u64, 0_u64);
        let (mut longest_run, mut most_words) = (0, 0);
        let (mut uneven, mut shaped) = (0.0, 0_u64);
        for part in &pattern.parts {
            let mut before: Option<&Block> = None;
            for row in &part.rows {
                let folded = words_of(&row.body);
                words += folded;
                most_words = most_words.max(folded);
                let times = u64::from(row.times);
                rounds += times;
                equal += times.saturating_sub(1) + u64::from(before == Some(&row.body));
                before = Some(&row.body);
                let (worked, turned) = count(&row.body);
                stitches += worked.saturating_mul(times);
                turns += turned.saturating_mul(times);
                if let Some(variation) = variation(&row.body) {
                    uneven += variation * times as f64;
                    shaped += times;
                }
                if row.body.ops().len() > 1 {
                    longest_run = longest_run.max(longest(&row.body));
                }
            }
        }
        let increases = Increases::of(graphs);
        let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
        Self {
            words_per_stitch: share(words as f64, stitches as f64),
            most_words,
            equal_rounds: share(equal as f64, rounds as f64),
            stacked_increases: share(increases.stacked as f64, increases.all as f64),
            stacked_by_choice: increases.by_choice(),
            short_rows_per_thousand: share(500.0 * turns as f64, stitches as f64),
            longest_run,
            uneven_shaping: share(uneven, shaped as f64),
        }
    }
}

/// Variation of the distances between the shapings of a round, around it; `None` where it has fewer than two.
fn variation(block: &Block) -> Option<f64> {
    let (mut place, mut first, mut before) = (0_u64, None, 0_u64);
    let (mut gaps, mut sum, mut squares) = (0.0, 0.0, 0.0);
    let mut gap = |length: u64| {
        let length = length as f64;
        (gaps, sum, squares) = (gaps + 1.0, sum + length, squares + length * length);
    };
    for step in block.steps() {
        let Step::Work(stitch) = step else { continue };
        if stitch.works != stitch.makes && stitch.kind != Kind::Skip {
            match first {
                Some(_) => gap(place - before),
                None => first = Some(place),
            }
            before = place;
        }
        place += 1;
    }
    let first = first.filter(|first| *first != before)?;
    gap(first + place - before);
    let mean: f64 = sum / gaps;
    Some((squares / gaps - mean * mean).max(0.0).sqrt() / mean)
}

fn words_of(block: &Block) -> usize {
    block
        .ops()
        .iter()
        .map(|op| match op {
            Op::Repeat { body, .. } => 1 + words_of(body),
            Op::Work { .. } | Op::Turn(_) | Op::Hold { .. } | Op::Leave { .. } | Op::Color(_) => 1,
        })
        .sum()
}

/// Stitches and turns, multiplied out.
fn count(block: &Block) -> (u64, u64) {
    block.ops().iter().fold((0_u64, 0_u64), |(stitches, turns), op| match op {
        Op::Work { times, .. } => (stitches.saturating_add(u64::from(*times)), turns),
        Op::Turn(_) => (stitches, turns + 1),
        Op::Repeat { body, times } => {
            let (inner, turned) = count(body);
            let times = u64::from(*times);
            (
                stitches.saturating_add(inner.saturating_mul(times)),
                turns.saturating_add(turned.saturating_mul(times)),
            )
        }
        Op::Hold { .. } | Op::Leave { .. } | Op::Color(_) => (stitches, turns),
    })
}

fn longest(block: &Block) -> u32 {
    block
        .ops()
        .iter()
        .map(|op| match op {
            Op::Work { times, .. } => *times,
            Op::Repeat { body, .. } => longest(body),
            Op::Turn(_) | Op::Hold { .. } | Op::Leave { .. } | Op::Color(_) => 0,
        })
        .max()
        .unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Span;
    use crate::ir::Stitch;

    #[test]
    fn even_repeats_vary_by_nothing() {
        let run = |stitch, times| (Op::Work { stitch, times }, Span::NONE);
        let block = |ops: Vec<(Op, Span)>| {
            let mut block = Block::default();
            for (op, span) in ops {
                block.push(op, span);
            }
            block
        };
        let even = Op::repeat(block(vec![run(Stitch::SC, 5), run(Stitch::INC, 1)]), 6);
        assert_eq!(variation(&block(vec![(even, Span::NONE)])), Some(0.0));
        // Gaps of 1 and 3: mean 2, deviation 1.
        let uneven = vec![run(Stitch::INC, 2), run(Stitch::SC, 2)];
        assert_eq!(variation(&block(uneven)), Some(0.5));
        assert_eq!(variation(&block(vec![run(Stitch::INC, 1), run(Stitch::SC, 2)])), None);
    }
}
