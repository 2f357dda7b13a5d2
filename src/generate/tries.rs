//! Several tries at one part, of which the best is kept: which stitch carries a shaping is a matter of small differences,
//! and so is how well all of them fit in the end.

use super::options::{Options, Preset};
use super::score::{FEW_OF, Score, inverted, some_length_error};
use super::sheet::Sheet;
use super::site::Laid;
use super::staircase::Ridge;
use crate::diag::Sink;
use rayon::prelude::*;

/// Parts of more stitches get one try, or, where it has inverted tiles, a few: the luck of single shapings evens out there.
const MOST_STITCHES: f64 = 5_000.0;
const MOST_RESCUED: f64 = 50_000.0;
/// What is good enough after one try, after two, and so on: a try costs as much time again, and promises less each time. Where
/// tries are cheap, or hard to come out well, the first is what is asked for, and the second what has to do with more.
const GOOD: [f64; 4] = [2.2, 2.5, 2.9, 3.3];
/// Rows between the highest and the lowest loop of the last turn at which no more tries are made.
const EVEN: f64 = 1.0;
/// Mean absolute length error, mean skew, unevenness of the last turn (rows) and share of increases on others at which a
/// harsh surface has come out well: no tries bring it to a good score. With each try a little more length error will do, for
/// the trimming of the last stitches most often takes some away.
const FINE: [f64; 4] = [0.05, 0.12, 1.0, 0.08];
const PATIENCE: f64 = 0.0005;
/// A score that is so bad that pulling the last turn level has torn it.
const BAD: f64 = 4.0;
/// A try whose score is so much worse than the best before its rows have settled is given up.
const BAR: f64 = 0.1;
/// Parts on which tries are cheap.
const SMALL: f64 = 400.0;
/// Further tries where the surface is harsh; where they are cheap, or all are bad; and where all have inverted tiles, also on very
/// large parts.
const MORE: usize = 2;
const MOST_MORE: usize = 8;
const RESCUES: usize = 20;
const FEW_RESCUES: usize = 4;
/// How many times worse even rounds may be than what has inverted tiles, and be kept instead.
const TANGLED: f64 = 2.0;
/// So many inverted tiles, or one of so many, are mended before a try is judged.
const MENDED: usize = 4;
const ONE_OF: usize = 300;
/// In a hurry one edge of so many is looked at, and a mean length error from here on is worth a second look.
const SOME: usize = 8;
const FAR_OFF: f64 = 0.08;
/// On harsh surfaces tries after the first are made side by side, so many at a time whatever the number of threads.
const BESIDE: usize = 2;

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

/// How a try differs from what was asked for.
#[derive(Clone, Copy)]
struct Change {
    /// Where its helix begins, in turns from there.
    turn: f64,
    /// Factors of the activation threshold, of the tolerance, and of the longest short row.
    short_rows: [f64; 3],
    /// Factors of the weight of square tiles and of the final sweeps.
    squareness: f64,
    sweeps: f64,
    /// Sweeps over the newest rows that it has less.
    fewer: u32,
    level: bool,
    opens: bool,
    tail: bool,
}

/// What is asked for.
const USUAL: Change = Change {
    turn: 0.0,
    short_rows: [1.0; 3],
    squareness: 1.0,
    sweeps: 1.0,
    fewer: 0,
    level: true,
    opens: false,
    tail: true,
};

/// In the order in which each makes up best for those before it, of 66 ways, over 209 parts of many shapes and gauges, most of them
/// tubes along random curves.
const CHANGES: [Change; 12] = [
    USUAL,
    Change { short_rows: [1.5, 0.84, 1.0], squareness: 0.85, sweeps: 1.43, fewer: 2, opens: true, ..USUAL },
    Change { turn: 0.2, short_rows: [1.47, 1.26, 1.16], sweeps: 1.43, opens: true, ..USUAL },
    Change { turn: -0.1, short_rows: [1.28, 0.88, 0.88], sweeps: 1.43, ..USUAL },
    Change { turn: 0.1, opens: true, ..USUAL },
    Change { short_rows: [1.35, 0.88, 1.19], sweeps: 1.43, fewer: 2, tail: false, ..USUAL },
    Change { turn: -0.2, short_rows: [1.3, 1.3, 1.1], opens: true, ..USUAL },
    Change { short_rows: [1.6, 1.3, 1.15], opens: true, ..USUAL },
    Change { turn: 0.3, short_rows: [1.24, 1.0, 1.16], opens: true, ..USUAL },
    Change { short_rows: [1.3, 1.3, 1.0], opens: true, ..USUAL },
    Change { turn: 0.03, short_rows: [1.3, 0.6, 1.16], opens: true, ..USUAL },
    Change { turn: -0.2, opens: true, ..USUAL },
];

/// The same for harsh surfaces, in the order in which fewest tries bring the arms of three cacti at 16 gauges out well: they are
/// better off with fewer and longer short rows from the first try on.
const HARSH: [Change; 6] = [
    harsh(0.0, [1.239, 0.99, 1.157]),
    harsh(0.0, [1.356, 0.72, 1.157]),
    harsh(0.2, [1.356, 1.26, 1.24]),
    harsh(-0.03, [1.627, 1.17, 1.322]),
    harsh(0.3, [1.123, 0.72, 1.19]),
    harsh(0.2, [1.0, 1.0, 1.0]),
];

/// Lengths of harsh surfaces suffer more than their angles, and have a longer way to go. There all edges pull in proportion: to
/// keep the worst ones near costs all others.
const fn harsh(turn: f64, short_rows: [f64; 3]) -> Change {
    Change { turn, short_rows, squareness: 0.75, sweeps: 1.43, tail: false, ..USUAL }
}

/// Where all of these come out badly the usual ones may do better, settled longer, for inverted tiles open slowly, and without a
/// pull to the level.
const LAST: [Change; 12] = [
    last(0.0, [1.3, 1.3, 1.0]),
    last(0.3, [1.24, 1.0, 1.16]),
    last(0.1, [1.0, 1.0, 1.0]),
    last(0.0, [1.3, 1.3, 1.16]),
    last(0.0, [1.24, 1.0, 1.16]),
    last(-0.2, [1.0, 1.0, 1.0]),
    last(-0.1, [0.9, 1.2, 1.1]),
    last(-0.03, [1.3, 0.6, 0.8]),
    last(0.0, [1.0, 1.0, 1.0]),
    last(0.03, [1.3, 0.6, 1.16]),
    last(-0.2, [1.3, 1.3, 1.1]),
    last(0.0, [1.6, 1.3, 1.15]),
];

const fn last(turn: f64, short_rows: [f64; 3]) -> Change {
    Change { turn, short_rows, sweeps: 3.0, level: false, opens: true, ..USUAL }
}

impl Change {
    /// The options of a try.
    fn options(&self, base: &Options) -> Options {
        let [activation, tolerance, longest] = self.short_rows;
        let activation = base.activation * activation;
        Options {
            activation,
            tolerance: (base.tolerance * tolerance).min(activation),
            max_short_row: base.max_short_row * longest,
            squareness: base.squareness * self.squareness,
            sweeps: (f64::from(base.sweeps) * self.sweeps) as u32,
            window_sweeps: base.window_sweeps.saturating_sub(self.fewer),
            ..base.clone()
        }
    }
}

/// What is tried at.
#[derive(Clone, Copy)]
pub(super) struct Part {
    /// Stitches that it takes, about.
    pub expected: f64,
    /// The first row is given: on harsh surfaces all tries are made.
    pub given: bool,
    /// Rows lie far closer on one side than on the other ([`Rows::is_harsh`](super::rows::Rows::is_harsh)).
    pub harsh: bool,
}

impl Part {
    fn is_large(self) -> bool {
        self.expected > MOST_STITCHES
    }

    fn is_huge(self) -> bool {
        self.expected > MOST_RESCUED
    }

    /// The changes that are asked for first.
    fn changes(self) -> &'static [Change] {
        if self.harsh { &HARSH } else { &CHANGES }
    }

    /// True for a harsh surface that has come out well, for so many tries.
    fn is_fine(self, (score, laid): &Made, tries: usize) -> bool {
        let [length, skew, spread, stacked] = FINE;
        let length = length + PATIENCE * tries.saturating_sub(1) as f64;
        let fits =
            score.length <= length && score.skew <= skew && laid.spread <= spread && score.stacked <= stacked;
        self.harsh && !self.given && score.inverted == 0 && fits
    }

    /// True when none is needed beyond so many tries, of so many that were asked for.
    fn is_done(self, best: &Made, tries: usize, asked: usize) -> bool {
        let score = &best.0;
        let small = self.expected < SMALL;
        // Of the usual ones each is made once.
        let most = match self.harsh {
            _ if score.fit > BAD => asked + MOST_MORE,
            _ if small => self.changes().len().min(asked + MOST_MORE),
            true => self.changes().len().min(asked + MORE),
            false => asked,
        };
        let good = match self.harsh || small {
            true if self.harsh && self.given && tries < asked => 0.0,
            true if tries < asked => GOOD[0],
            true => GOOD[1],
            false => GOOD[tries.min(GOOD.len()) - 1],
        };
        let good = score.total <= good && (best.1.spread <= EVEN || tries >= asked);
        score.inverted == 0 && (good || tries >= most || self.is_fine(best, tries))
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
type Made = (Score, Laid);

/// False for a sheet so bad that anything else is worth a try.
pub(super) fn is_sound(sheet: &Sheet) -> bool {
    Score::of_fit(sheet).fit <= BAD
}

/// False for a sheet whose edges are far off, as some of them tell.
fn is_close(sheet: &Sheet) -> bool {
    some_length_error(sheet, SOME) <= FAR_OFF
}

/// The best of the tries that `lay` makes, in a hurry the only one; `None` when none comes to a good end. A few inverted tiles
/// are mended before a try is judged. A few may be made at a time, and are held to what those before came to: so it is the same
/// for any number of threads.
pub(super) fn best(
    options: &Options,
    part: Part,
    sink: &Sink<'_>,
    lay: impl Fn(&Options, f64, Judge, &Sink<'_>) -> Option<Laid> + Sync,
    mend: impl Fn(&mut Laid) + Sync,
    even: impl Fn(&Sink<'_>) -> Option<Laid>,
) -> Option<Laid> {
    let changes = part.changes();
    let asked = if part.is_large() { 1 } else { changes.len().min(options.tries as usize) };
    let attempt = |change: &Change, bar: f64, ridge: Ridge, opens: bool, sink: &Sink<'_>| {
        let judge =
            Judge { bar, level: change.level, ridge, opens: change.opens || opens, tail: change.tail };
        lay(&change.options(options), change.turn, judge, sink)
    };
    let first = |change: &Change, sink: &Sink<'_>| attempt(change, f64::INFINITY, Ridge::Dear, false, sink);
    if options.preset == Preset::Fast {
        let judge = Judge { bar: f64::INFINITY, level: true, ridge: Ridge::Dear, opens: false, tail: true };
        return lay(&options.hurried(), 0.0, judge, sink).filter(|laid| is_close(&laid.sheet));
    }
    // Where the only one comes to no end, more are better than none.
    if options.tries == 1
        && let Some(laid) = first(&changes[0], sink)
    {
        return Some(laid);
    }
    let ease = options.ease();
    if part.is_huge() {
        let more =
            LAST.iter().take(FEW_RESCUES).map(|change| Change { short_rows: change.short_rows, ..USUAL });
        return best_of_huge(ease, std::iter::once(changes[0]).chain(more), |change| first(change, sink));
    }
    let scored = |mut laid: Laid| {
        let mut score = Score::of(&laid.sheet, ease);
        if (1..=MENDED.max(laid.sheet.len() / ONE_OF)).contains(&score.inverted) {
            mend(&mut laid);
            score = Score::of(&laid.sheet, ease);
        }
        (score.with_level(laid.spread), laid)
    };
    let is_bad =
        |best: &Option<Made>| best.as_ref().is_none_or(|(score, _)| score.inverted > 0 || score.fit > BAD);
    let mut best: Option<Made> = None;
    let mut next = 0;
    let last = asked + RESCUES;
    while next < last && !best.as_ref().is_some_and(|best| part.is_done(best, next, asked)) {
        let bad = is_bad(&best);
        let bar = match &best {
            Some((score, laid)) if score.inverted == 0 && laid.spread <= EVEN => score.total + BAR,
            _ => f64::INFINITY,
        };
        let make = |index: usize, sink: &Sink<'_>| {
            let rescue = index.checked_sub(asked);
            // Every second one may have increases on others, and the other way round the second time.
            let stacks = rescue.is_some_and(|index| (index + index / LAST.len()) % 2 == 1);
            let ridge = if stacks && bad { Ridge::Cheap } else { Ridge::Dear };
            let change = match rescue {
                Some(index) if bad => &LAST[index % LAST.len()],
                _ => &changes[index % changes.len()],
            };
            attempt(change, bar, ridge, index > 0 && bad, sink).map(scored)
        };
        let made: Vec<Option<Made>> = match next {
            0 => vec![make(0, sink)],
            _ => (next..last.min(next + if part.harsh { BESIDE } else { 1 }))
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
    best.map(|(_, laid)| laid)
}

/// The first of some tries at a very large part with so few inverted tiles that they can be mended at the end, or the best.
fn best_of_huge(
    ease: f64,
    changes: impl Iterator<Item = Change>,
    make: impl Fn(&Change) -> Option<Laid>,
) -> Option<Laid> {
    let mut best: Option<(f64, Laid)> = None;
    for laid in changes.filter_map(|change| make(&change)) {
        if inverted(&laid.sheet) <= laid.sheet.len() / FEW_OF {
            return Some(laid);
        }
        let total = Score::of(&laid.sheet, ease).with_level(laid.spread).total;
        if best.as_ref().is_none_or(|(least, _)| total < *least) {
            best = Some((total, laid));
        }
    }
    best.map(|(_, laid)| laid)
}
