//! What the generator may be told; each option says what it changes and what it costs.

use crate::ir::maker::MOST_LEAN;
use crate::ir::{Hand, Maker};
use crate::shape::Wishes;
use serde::Deserialize;

/// From the first to the second of these numbers of nodes parts get more and more sweeps, up to so many times more; from the third
/// to the fourth fewer again, down to this share of them.
const SMALL: [usize; 2] = [800, 1_450];
const LARGE: [usize; 2] = [4_500, 6_000];
const LONGER: f64 = 1.43;
const LESS: f64 = 0.4;
/// Over rows of more nodes than this, this share of the window settles.
const LONG_ROW: usize = 1_000;
const FEWER_ROWS: [u32; 2] = [2, 3];

/// How far a number has come from the first to the second of two, as a share.
fn past(number: usize, [from, to]: [usize; 2]) -> f64 {
    (number.saturating_sub(from) as f64 / (to - from) as f64).min(1.0)
}

/// A set of options under one name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// The options as they stand.
    #[default]
    Std,
    /// For live editing: one try with fewer sweeps and looks at the surface.
    Fast,
}

/// Options of the generator. The defaults serve every shape; the names follow the paper where it has one.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own")]
pub struct Options {
    /// `fast` makes one hurried try, and others only where that has tiles inside out.
    pub preset: Preset,
    /// Short rows on or off. Without them a bent tube keeps one count of rows on both sides and its tiles shear.
    pub short_rows: bool,
    /// Least stitches of one pass of a short row (paper, section 3.3: 4). Shorter ones make more turns for little shape.
    pub min_short_row: u32,
    /// Longest pass of a short row as a share of its round. Above one half the two ends come near each other.
    pub max_short_row: f64,
    /// Missing height, in stitch heights, from which a short row of least length opens (paper: activation threshold).
    pub activation: f64,
    /// Missing height over which two close short rows are merged into one (paper: tolerance threshold).
    pub tolerance: f64,
    /// Rows that are settled again after each new row (paper: the moving window), a third fewer of rows over 1,000 stitches.
    pub window: u32,
    /// Sweeps over the window after each row.
    pub window_sweeps: u32,
    /// Sweeps over the whole part at the end; parts over 800 stitches get up to 2.4 times as many.
    pub sweeps: u32,
    /// Weight of a square tile against exact lengths in the final sweeps: higher trades length error for skew.
    pub squareness: f64,
    /// Tries at a part, with small differences, of which the best is kept; a good one ends them, parts over 5,000
    /// stitches get one, and small or bad ones a few more.
    pub tries: u32,
    /// Shaping of rotationally symmetric shapes as a designer writes it: even repeats, staggered from round to round.
    pub symmetric: bool,
    /// The hand that holds the hook, `right` or `left`; where nothing is said, what the shape file says, and else the right
    /// one. For the left hand the pattern is that of the mirror image, so that the object comes out as designed.
    pub hand: Option<Hand>,
    /// Stitches by which columns drift in each round of a maker, positive in working direction; where nothing is said, what
    /// the shape file says, and else 0. The pattern is that of the shape twisted the other way.
    pub lean: Option<f64>,
    /// How much pleasant words are worth, from 0 to 1; where nothing is said, what the shape file says, and else 0. Counts
    /// change in fewer rounds, shapings lie at equal distances, and short rows are plain, at the price of fidelity.
    pub readability: Option<f64>,
    /// The rules of the paper's own algorithm instead of ours; most other options then have no effect.
    #[serde(skip)]
    pub paper: bool,
    /// The paper's algorithm with our own settling at its end.
    #[serde(skip)]
    pub settle: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            preset: Preset::Std,
            short_rows: true,
            min_short_row: 8,
            max_short_row: 0.605,
            activation: 1.291,
            tolerance: 0.556,
            window: 3,
            window_sweeps: 6,
            sweeps: 14,
            squareness: 0.274,
            tries: 4,
            symmetric: true,
            hand: None,
            lean: None,
            readability: None,
            paper: false,
            settle: false,
        }
    }
}

impl Options {
    /// The options with what they leave open as a shape wishes it.
    #[must_use]
    pub fn granting(&self, wishes: &Wishes) -> Self {
        Self {
            hand: self.hand.or(wishes.hand),
            lean: self.lean.or(wishes.lean),
            readability: self.readability.or(wishes.readability),
            ..self.clone()
        }
    }

    /// How much pleasant words are worth.
    pub(super) fn ease(&self) -> f64 {
        self.readability.unwrap_or(0.0)
    }

    /// Whom the pattern is for.
    pub fn maker(&self) -> Maker {
        Maker { hand: self.hand.unwrap_or_default(), lean: self.lean.unwrap_or(0.0) }
    }

    /// The options with what follows from others.
    pub(super) fn resolved(&self) -> Self {
        if self.paper {
            return super::paper::options(self);
        }
        if self.sweeps == 0 && self.window_sweeps == 0 {
            // There is nothing that another try could settle better.
            return Self { tries: 1, ..self.clone() };
        }
        self.clone()
    }

    /// While someone waits: the options of the first try.
    pub(super) fn hurried(&self) -> Self {
        match self.preset {
            Preset::Std => self.clone(),
            Preset::Fast => Self {
                window: self.window.min(2),
                window_sweeps: self.window_sweeps.min(2),
                sweeps: self.sweeps.min(5),
                ..self.clone()
            },
        }
    }

    /// Sweeps over a part of so many nodes: what is off at one end of a larger part takes longer to spread over it, and
    /// very large ones have less time for it. None of it in a hurry.
    pub(super) fn sweeps_over(&self, nodes: usize) -> u32 {
        let (rise, fall) = (past(nodes, SMALL), LESS * past(nodes, LARGE));
        let more = if self.preset == Preset::Fast { 0.0 } else { rise - fall };
        self.sweeps + (f64::from(self.sweeps) * LONGER * more) as u32
    }

    /// Rows that settle after one of so many nodes: the processor keeps fewer long ones near, and these need less of it, for they
    /// bend less from stitch to stitch.
    pub(super) fn window_over(&self, row: usize) -> usize {
        let [share, of] = if row > LONG_ROW { FEWER_ROWS } else { [1, 1] };
        (self.window * share).div_ceil(of) as usize
    }

    /// Without hurry.
    pub(super) fn unhurried(&self) -> Self {
        Self { preset: Preset::Std, ..self.clone() }
    }

    /// The first option out of range: its name and what would be right.
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        let between = |x: f64, low: f64, high: f64| (low..=high).contains(&x);
        [
            (self.min_short_row >= 3, "min-short-row", "at least 3"),
            (between(self.max_short_row, 0.1, 0.9), "max-short-row", "from 0.1 to 0.9"),
            (between(self.activation, 0.5, 10.0), "activation", "from 0.5 to 10 stitch heights"),
            (
                between(self.tolerance, 0.0, self.activation),
                "tolerance",
                "from 0 to the activation threshold",
            ),
            ((1..=64).contains(&self.window), "window", "from 1 to 64 rows"),
            (self.window_sweeps <= 1000, "window-sweeps", "at most 1000"),
            (self.sweeps <= 100_000, "sweeps", "at most 100000"),
            ((1..=1000).contains(&self.tries), "tries", "from 1 to 1000"),
            (between(self.squareness, 0.0, 100.0), "squareness", "from 0 to 100"),
            (between(self.ease(), 0.0, 1.0), "readability", "from 0 to 1"),
            (between(self.maker().lean.abs(), 0.0, MOST_LEAN), "lean", "from -1 to 1 stitches a round"),
        ]
        .into_iter()
        .find(|(fine, ..)| !fine)
        .map(|(_, name, right)| (name, right))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_third_fewer_of_long_rows_settle() {
        let over = |window: u32, row: usize| Options { window, ..Options::default() }.window_over(row);
        assert_eq!([over(3, 30), over(3, 1_000), over(3, 1_001), over(3, 5_000)], [3, 3, 2, 2]);
        assert_eq!([over(1, 5_000), over(2, 5_000), over(8, 5_000)], [1, 2, 6]);
    }
}
