//! Several tries at one part, of which the best is kept: which stitch carries a shaping is a matter of small differences,
//! and so is how well all of them fit in the end.

use super::Laid;
use super::options::{Options, Preset};
use super::score::Score;

/// Parts of more stitches get one try, or, where it has inverted tiles, a few: the luck of single shapings evens out there.
const MOST_STITCHES: f64 = 5_000.0;
const MOST_RESCUED: f64 = 50_000.0;
/// A score that needs no further try, and one that needs none beyond those asked for.
const GOOD: f64 = 2.1;
const POOR: f64 = 2.5;
/// A score that is so bad that pulling the last turn level has torn it.
const BAD: f64 = 4.0;
/// A try whose score is so much worse than the best before its rows have settled is given up.
const BAR: f64 = 0.1;
/// Further tries for parts on which all are poor, or have inverted tiles.
const RESCUES: usize = 8;
/// Sweeps of a rescue: inverted tiles open slowly.
const RESCUE_SWEEPS: u32 = 3;

/// What a try is held to.
#[derive(Clone, Copy)]
pub(super) struct Judge {
    /// The score after the first sweeps over the whole over which it is given up.
    pub bar: f64,
    /// The last turn is pulled level, at the price of tiles that it may press flat.
    pub level: bool,
    /// Increases may stand on others for little.
    pub stacks: bool,
    /// Narrow tiles are pushed open after each row, not only in the end.
    pub opens: bool,
}

/// How a try differs from the first: where its helix begins, in turns from there; the factor of the activation threshold,
/// and that of the tolerance; the longest short row as a share of that asked for.
struct Change {
    turn: f64,
    activation: f64,
    tolerance: f64,
    longest: f64,
}

const fn change(turn: f64, activation: f64, tolerance: f64, longest: f64) -> Change {
    Change { turn, activation, tolerance, longest }
}

/// In the order in which they best make up for those before, over 111 parts of many shapes and gauges: fewer and longer short rows are
/// the first thing to try where the usual ones come out badly.
const CHANGES: [Change; 12] = [
    change(0.0, 1.0, 1.0, 1.0),
    change(0.03, 1.3, 0.6, 1.16),
    change(-0.2, 1.3, 1.3, 1.1),
    change(0.0, 1.6, 1.3, 1.15),
    change(0.0, 1.3, 1.3, 1.0),
    change(0.3, 1.24, 1.0, 1.16),
    change(0.1, 1.0, 1.0, 1.0),
    change(0.0, 1.3, 1.3, 1.16),
    change(0.0, 1.24, 1.0, 1.16),
    change(-0.2, 1.0, 1.0, 1.0),
    change(-0.1, 0.9, 1.2, 1.1),
    change(-0.03, 1.3, 0.6, 0.8),
];

/// The options of a try, and how far around the tube its helix begins.
fn variant(base: &Options, index: usize, rescue: bool) -> (Options, f64) {
    let change = &CHANGES[index % CHANGES.len()];
    let mut options = base.clone();
    options.activation *= change.activation;
    options.tolerance = (options.tolerance * change.tolerance).min(options.activation);
    options.max_short_row *= change.longest;
    if rescue {
        options.sweeps = options.sweeps.saturating_mul(RESCUE_SWEEPS);
    }
    (options, change.turn)
}

/// The best of the tries that `lay` makes, in a hurry the only one; `None` when none comes to an end. Where the first row is `given`, all tries
/// are made.
pub(super) fn best(
    options: &Options,
    expected: f64,
    given: bool,
    mut lay: impl FnMut(&Options, f64, Judge) -> Option<Laid>,
) -> Option<Laid> {
    let tries = if expected > MOST_STITCHES { 1 } else { options.tries as usize };
    let most = if options.tries > 1 && expected <= MOST_RESCUED { tries + RESCUES } else { tries };
    let first = Judge { bar: f64::INFINITY, level: true, stacks: false, opens: false };
    if options.preset == Preset::Fast {
        return lay(&options.hurried(), 0.0, first);
    }
    if most == 1 {
        return lay(options, 0.0, first);
    }
    let mut best: Option<(Score, Laid)> = None;
    for index in 0..most {
        let enough = match index < tries {
            true if given => 0.0,
            true => GOOD,
            false => POOR,
        };
        if best.as_ref().is_some_and(|(score, _)| score.inverted == 0 && score.total <= enough) {
            break;
        }
        let bad = best.as_ref().is_none_or(|(score, _)| score.inverted > 0 || score.total > BAD);
        let rescue = index >= tries && bad;
        let (options, turn) = variant(options, index, rescue);
        let bar = match &best {
            Some((score, _)) if score.inverted == 0 => score.total + BAR,
            _ => f64::INFINITY,
        };
        let stacks = rescue && index % 2 == 1;
        let judge = Judge { bar, level: !rescue, stacks, opens: index > 0 };
        let Some(laid) = lay(&options, turn, judge) else { continue };
        let score = Score::of(&laid.sheet, options.ease()).with_level(laid.spread);
        if best.as_ref().is_none_or(|(so_far, _)| so_far.total.is_nan() || score.total < so_far.total - 1e-9)
        {
            best = Some((score, laid));
        }
    }
    best.map(|(_, laid)| laid)
}
