//! What the verifier counts on its way, so that no backend counts again.

use crate::ir::{Kind, Stitch};

/// Counts of a whole pattern.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Facts {
    /// Counts of each part, in the order of the parts.
    pub parts: Vec<PartFacts>,
}

/// Counts of one part, for one copy of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PartFacts {
    /// Counts of each row of [`crate::ir::Part::rows`].
    pub rows: Vec<RowFacts>,
    /// Loops before the first row.
    pub start: u32,
    /// Loops that are open at the end.
    pub open: u32,
    /// Stitches worked, ring stitches included.
    pub stitches: u64,
    /// Yarn of everything, start included, in hundredths of a single crochet; see [`Facts::yarn`].
    pub yarn: u64,
}

/// Counts of one row; those of a folded row are the same in each of its rounds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RowFacts {
    /// Number of the first round that the row stands for.
    pub number: u32,
    /// Loops below, ready to be worked when the row begins.
    pub below: u32,
    /// Loops of the row below that are used up, held ones included.
    pub consumes: u32,
    /// Loops made: the stitch count of the row.
    pub produces: u32,
    /// Loops below that stay for the next row.
    pub left: u32,
    /// Loops held for other parts.
    pub held: u32,
    /// Stitches worked, all passes together.
    pub stitches: u32,
    /// Steps that have a tile: stitches and turns.
    pub tiles: u32,
    /// Short rows: back passes.
    pub short_rows: u32,
    /// Widest short row, in loops.
    pub longest: u32,
    /// Stitches of all rows so far, those of this one (and all its rounds) included.
    pub total: u64,
    /// Yarn of one round, in hundredths of a single crochet.
    pub yarn: u64,
}

impl Facts {
    /// Stitches of all parts and copies.
    pub fn stitches(&self, program: &crate::ir::Program) -> u64 {
        self.sum(program, |part| part.stitches)
    }

    /// Estimated yarn length in mm for stitches of this width, all parts and copies. A single crochet takes 8.4 of its
    /// widths: one measurement in worsted yarn with a 5 mm hook, so a rough guide; no allowance is added.
    pub fn yarn(&self, program: &crate::ir::Program, width: f64) -> f64 {
        self.sum(program, |part| part.yarn) as f64 / 100.0 * 8.4 * width
    }

    fn sum(&self, program: &crate::ir::Program, count: impl Fn(&PartFacts) -> u64) -> u64 {
        let parts = program.pattern.parts.iter().zip(&self.parts);
        parts.fold(0, |sum, (part, facts)| {
            sum.saturating_add(count(facts).saturating_mul(u64::from(part.copies)))
        })
    }
}

/// Yarn of a chain, in hundredths of a single crochet: 5 widths of yarn a chain.
pub(super) const CHAIN: u64 = 60;

/// Yarn of a stitch in hundredths of a single crochet. Twice as much for two in one loop, 1.55 for two together.
pub(super) fn yarn(stitch: Stitch) -> u64 {
    if stitch.kind == Kind::Skip {
        return 0;
    }
    if stitch.kind == Kind::Ch {
        return CHAIN;
    }
    // Heights are positive, so this rounds.
    let plain = (100.0 * stitch.kind.height() + 0.5) as u64;
    let posts = 100 * u64::from(stitch.makes.max(1)) + 55 * u64::from(stitch.works.max(1) - 1);
    plain * posts / 100
}
