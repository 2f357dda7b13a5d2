//! Several tries at one part, of which the best is kept: which stitch carries a shaping is a matter of small differences,
//! and so is how well all of them fit in the end.

use super::Laid;
use super::options::{Options, Preset};
use super::ridges;
use super::score::{FEW_OF, Score, inverted, some_length_error};
use super::sheet::Sheet;
use super::staircase::Ridge;
use crate::diag::Sink;
use rayon::prelude::*;

/// Parts of more stitches get one try, or, where it has inverted tiles, a few: the luck of single shapings evens out there.
const MOST_STITCHES: f64 = 5_000.0;
const MOST_RESCUED: f64 = 50_000.0;
/// A score that needs no further try, and one that needs none beyond those asked for.
const GOOD: f64 = 2.1;
const POOR: f64 = 2.5;
/// Mean absolute length error, mean skew, unevenness of the last turn (rows) and share of increases on others at which a
/// harsh surface has come out well: no tries bring it to a good score. With each try a little more length error will do, for
/// the trimming of the last stitches most often takes some away.
const FINE: [f64; 4] = [0.05, 0.12, 1.0, 0.08];
const PATIENCE: f64 = 0.0005;
/// A score that is so bad that pulling the last turn level has torn it.
const BAD: f64 = 4.0;
/// A try whose score is so much worse than the best before its rows have settled is given up.
const BAR: f64 = 0.1;
/// Further tries for parts on which all are poor, or have inverted tiles, and for very large ones that have these: there tiles
/// that are pushed open after each row push others over.
const RESCUES: usize = 8;
const FEW_RESCUES: usize = 4;
/// After so many of them what is not bad hardly gets better, unless it is harsh, or small and cheap to try at.
const USEFUL: usize = 2;
const SMALL: f64 = 400.0;
/// How many times worse even rounds may be than what has inverted tiles, and be kept instead.
const TANGLED: f64 = 2.0;
/// In a hurry one edge of so many is looked at, and a mean length error from here on is worth a second look.
const SOME: usize = 8;
const FAR_OFF: f64 = 0.08;
/// Tries after the first are made side by side, so many at a time whatever the number of threads.
const BESIDE: usize = 2;
/// Sweeps of a rescue: inverted tiles open slowly.
const RESCUE_SWEEPS: u32 = 3;

/// What a try is held to.
#[derive(Clone, Copy)]
pub(super) struct Judge {
    /// The score after the first sweeps over the whole over which it is given up.
    pub bar: f64,
    /// The last turn is pulled level, at the price of tiles that it may press flat.
    pub level: bool,
    /// What it costs that increases stand on others.
    pub ridge: Ridge,
    /// Narrow tiles are pushed open after each row, not only in the end.
    pub opens: bool,
    /// In the end long and short edges pull more than in proportion.
    pub tail: bool,
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

/// The same for harsh surfaces, in the order in which fewest tries bring the arms of three cacti at 16 gauges out well: they are
/// better off with fewer and longer short rows from the first try on.
const HARSH: [Change; 12] = [
    change(0.0, 1.239, 0.99, 1.157),
    change(0.0, 1.356, 0.72, 1.157),
    change(0.2, 1.356, 1.26, 1.24),
    change(-0.03, 1.627, 1.17, 1.322),
    change(0.3, 1.123, 0.72, 1.19),
    change(0.2, 1.0, 1.0, 1.0),
    change(0.2, 1.472, 1.26, 1.157),
    change(0.0, 1.627, 1.17, 1.322),
    change(0.3, 1.356, 1.26, 1.24),
    change(0.4, 1.123, 0.72, 1.19),
    change(-0.03, 1.627, 0.72, 1.157),
    change(0.5, 1.472, 0.72, 1.24),
];
/// Factors of the weight of square tiles and of the final sweeps on harsh surfaces: their lengths suffer more than their angles,
/// and have a longer way to go. There all edges pull in proportion: to keep the worst ones near costs all others.
const HARSH_SQUARENESS: f64 = 0.75;
const HARSH_SWEEPS: f64 = 1.43;

/// What is tried at.
#[derive(Clone, Copy)]
pub(super) struct Part {
    /// Stitches that it takes, about.
    pub expected: f64,
    /// The first row is given: all tries are made.
    pub given: bool,
    /// Rows lie far closer on one side than on the other ([`Rows::is_harsh`](super::rows::Rows::is_harsh)).
    pub harsh: bool,
}

impl Part {
    /// The options of a try, and how far around the tube its helix begins.
    fn variant(self, base: &Options, index: usize, rescue: bool) -> (Options, f64) {
        // Where all come out badly the usual ones may do better.
        let harsh = self.harsh && !rescue;
        let changes = if harsh { &HARSH } else { &CHANGES };
        let change = &changes[index % changes.len()];
        let mut options = base.clone();
        options.activation *= change.activation;
        options.tolerance = (options.tolerance * change.tolerance).min(options.activation);
        options.max_short_row *= change.longest;
        if harsh {
            options.squareness *= HARSH_SQUARENESS;
            options.sweeps = (f64::from(options.sweeps) * HARSH_SWEEPS) as u32;
        }
        if rescue {
            options.sweeps = options.sweeps.saturating_mul(RESCUE_SWEEPS);
        }
        (options, change.turn)
    }

    /// True for a harsh surface that has come out well, for so many tries.
    fn is_fine(self, (score, laid): &Made, tries: usize) -> bool {
        let [length, skew, spread, stacked] = FINE;
        let length = length + PATIENCE * tries.saturating_sub(1) as f64;
        let fits =
            score.length <= length && score.skew <= skew && laid.spread <= spread && score.stacked <= stacked;
        self.harsh && !self.given && score.inverted == 0 && fits
    }

    /// True when none is needed beyond so many tries, or so many that were asked for.
    fn is_done(self, best: &Made, tries: usize, asked: usize) -> bool {
        let enough = match tries < asked {
            true if self.given => 0.0,
            true => GOOD,
            false => POOR,
        };
        best.0.inverted == 0 && best.0.total <= enough || self.is_fine(best, tries)
    }

    /// True when a try is better than the best one before.
    fn is_better(self, made: &Made, best: &Made, tries: usize) -> bool {
        let well = self.is_fine(made, tries);
        match self.is_fine(best, tries) {
            same if same == well => best.0.total.is_nan() || made.0.total < best.0.total - 1e-9,
            _ => well,
        }
    }
}

/// A try with its score.
pub(super) type Made = (Score, Laid);

/// False for a sheet so bad that anything else is worth a try.
pub(super) fn is_sound(sheet: &Sheet) -> bool {
    Score::of_fit(sheet).total <= BAD
}

/// False for a sheet whose edges are far off, as some of them tell.
fn is_close(sheet: &Sheet) -> bool {
    some_length_error(sheet, SOME) <= FAR_OFF
}

/// The best of the tries that `lay` makes, in a hurry the only one; `None` when none comes to a good end. A few are made at a time, and held to what those
/// before came to: so it is the same for any number of threads.
pub(super) fn best(
    options: &Options,
    part: Part,
    sink: &Sink<'_>,
    lay: impl Fn(&Options, f64, Judge, &Sink<'_>) -> Option<Laid> + Sync,
    even: impl Fn(&Sink<'_>) -> Option<Laid>,
) -> Option<Laid> {
    let tries = if part.expected > MOST_STITCHES { 1 } else { options.tries as usize };
    let huge = part.expected > MOST_RESCUED;
    let rescues = if huge { FEW_RESCUES } else { RESCUES };
    let most = if options.tries > 1 { tries + rescues } else { tries };
    let first = Judge { bar: f64::INFINITY, level: true, ridge: Ridge::Usual, opens: false, tail: true };
    if options.preset == Preset::Fast {
        return lay(&options.hurried(), 0.0, first, sink).filter(|laid| is_close(&laid.sheet));
    }
    if most == 1 {
        let (options, turn) = part.variant(options, 0, false);
        return lay(&options, turn, Judge { tail: !part.harsh, ..first }, sink);
    }
    let scored = |laid: Laid| {
        // A few can be mended at the end, and then nothing else is tried for.
        if huge && inverted(&laid.sheet) <= laid.sheet.len() / FEW_OF {
            return (Score::default(), laid);
        }
        (Score::of(&laid.sheet, options.ease()).with_level(laid.spread), laid)
    };
    let attempt = |index: usize, rescue: bool, judge: Judge, sink: &Sink<'_>| {
        let (options, turn) = part.variant(options, index, rescue);
        let judge = Judge { level: !rescue, tail: !part.harsh || rescue, ..judge };
        lay(&options, turn, judge, sink).map(scored)
    };
    let is_bad =
        |best: &Option<Made>| best.as_ref().is_none_or(|(score, _)| score.inverted > 0 || score.total > BAD);
    let mut best: Option<Made> = None;
    let mut next = 0;
    // Once more around where tiles are inverted, with increases free to stand on others where they were not.
    let last = if tries > 1 { most + CHANGES.len() } else { most };
    let done = |best: &Made, next: usize| {
        let hard = best.0.total > BAD || part.harsh || part.expected < SMALL;
        let useful = hard || next < tries + USEFUL;
        let enough = huge || next >= most || !useful;
        part.is_done(best, next, tries) || enough && best.0.inverted == 0
    };
    while next < last && !best.as_ref().is_some_and(|best| done(best, next)) {
        let bad = is_bad(&best);
        let bar = match &best {
            Some((score, _)) if score.inverted == 0 => score.total + BAR,
            _ => f64::INFINITY,
        };
        let make = |index: usize, sink: &Sink<'_>| {
            let rescue = index >= tries && bad && !huge;
            let stacks = rescue && (index + index / CHANGES.len()) % 2 == 1;
            let ridge = if stacks { Ridge::Low } else { Ridge::Usual };
            let opens = index > 0 && (bad || !part.harsh) && !huge;
            attempt(index, rescue, Judge { bar, ridge, opens, ..first }, sink)
        };
        let made: Vec<Option<Made>> = match next {
            0 => vec![make(0, sink)],
            _ => (next..last.min(next + if huge { 1 } else { BESIDE }))
                .into_par_iter()
                .map(|index| make(index, &Sink::new()))
                .collect(),
        };
        next += made.len();
        for made in made.into_iter().flatten() {
            if best.as_ref().is_none_or(|best| part.is_better(&made, best, next)) {
                best = Some(made);
            }
        }
    }
    if is_bad(&best)
        && let Some((score, laid)) = even(sink).map(scored)
    {
        let worth = |best: &Score| best.total * if best.inverted > score.inverted { TANGLED } else { 1.0 };
        if best.as_ref().is_none_or(|(best, _)| score.total < worth(best)) {
            best = Some((score, laid));
        }
    }
    let clear = best.as_ref().filter(|_| !huge).and_then(|best| {
        ridges::without(best, part.expected > MOST_STITCHES, |index, apart, bar| {
            let judge =
                Judge { bar, ridge: Ridge::Steep { apart }, opens: index > 0 && !part.harsh, ..first };
            attempt(index, false, judge, &Sink::new())
        })
    });
    clear.or(best).map(|(_, laid)| laid)
}
