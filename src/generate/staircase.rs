//! Shaping of one row: increases and decreases as an integer staircase under the curve of missing stitches.
//!
//! The gaps between neighboring feet tell how many stitches too few or too many the row has so far. A dynamic program
//! follows that curve with integer levels: one level up is an increase, one down a decrease. Shaping has a price, keeps a
//! distance from the shaping before, and never undoes that of the row below.

use super::even;
use super::sheet::Shaped;

/// What happens at a base.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Shaping {
    #[default]
    Plain,
    Inc,
    /// This base is worked together with the one before.
    Dec,
}

/// Price of one shaping, in squared stitches; and on top of one below.
const PRICE: f64 = 1.5;
const STACKED: f64 = 0.1;
/// Part of the row's total that is never worth a stitch.
const DEAD_BAND: f64 = 0.1;

/// How dear an increase beside one of the row below is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Ridge {
    /// So much that any clear place is better, also the first base of a row, or one beside another increase.
    #[default]
    Dear,
    /// Little: other things matter more.
    Cheap,
}

impl Ridge {
    fn price(self) -> f64 {
        match self {
            Self::Dear => DEAR_RIDGE,
            Self::Cheap => CHEAP_RIDGE,
        }
    }

    /// Longest distance between shapings, in bases.
    fn cooldown(self) -> usize {
        match self {
            Self::Dear => 0,
            Self::Cheap => COOLDOWN,
        }
    }
}

/// What a row is asked for beside its width.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Taste {
    /// How much simpler words are worth, from 0 to 1.
    pub ease: f64,
    /// The first base of a new round, which is not worked together with the last of the one before.
    pub marker: Option<usize>,
    /// What it costs that an increase stands on one of the row below.
    pub ridge: Ridge,
    /// How the base before the first came about.
    pub before: Shaped,
}

impl Taste {
    /// Stitches of a row of `n` that come in one round instead of several. The total of a row tells how many are missing
    /// from it as a whole, so what waits is not lost, and what comes early is not made again.
    fn waiting(self, n: usize) -> f64 {
        self.ease * (WAITING_SHARE * n as f64).min(WAITING_MOST)
    }

    /// Price of a shaping.
    fn price(self, n: usize) -> f64 {
        PRICE * (1.0 + self.ease * (n as f64 / USUAL_ROW).min(DEARER))
    }

    /// What a shaping at base `i` costs more for those of the row below, of which any at the base itself is one.
    fn stacking(self, shaping: Shaping, below: &[Shaped], i: usize) -> f64 {
        let own = if below[i] == Shaped::No { 0.0 } else { STACKED };
        own + self.beside(shaping, below, i)
    }

    /// What it costs more beside those of the row below: stacked ones draw a ridge.
    pub(super) fn beside(self, shaping: Shaping, below: &[Shaped], i: usize) -> f64 {
        let ridge = |shaped| shaped == Shaped::Inc;
        if shaping == Shaping::Inc && (beside(below, i, ridge) || i == 0 && ridge(self.before)) {
            self.ridge.price()
        } else if self.ease > 0.0 && beside(below, i, |shaped| shaped != Shaped::No) {
            self.ease * PLAIN_RIDGE
        } else {
            0.0
        }
    }

    /// What a row may cost more, in squared stitches, if its shapings are spread evenly.
    fn evenness(self, n: usize) -> f64 {
        self.ease * EVEN * n as f64
    }
}

/// Stitches that come together with full ease: as a share of the row, and at most.
const WAITING_SHARE: f64 = 0.09;
const WAITING_MOST: f64 = 3.6;
/// Stitches of a usual row, and how many times dearer shapings are in long ones with full ease.
const USUAL_ROW: f64 = 15.0;
const DEARER: f64 = 2.0;
/// Prices of an increase beside one of the row below; and of any shaping beside another with full ease.
const DEAR_RIDGE: f64 = 20.0;
const CHEAP_RIDGE: f64 = 0.5;
const PLAIN_RIDGE: f64 = 3.0;
/// Mean squared distance from where a shaping belongs that evenly spread ones may have more with full ease.
const EVEN: f64 = 0.6;
/// Levels on either side of the curve that are tried.
const REACH: i32 = 4;
const LEVELS: usize = 2 * REACH as usize + 1;
/// What a way may cost more than the cheapest up to the same base: more than a few shapings that bring both together.
const HOPELESS: f64 = 8.0;
/// Longest distance between shapings, in bases.
const COOLDOWN: usize = 4;
const WAITS: usize = COOLDOWN + 1;

/// The plan of one row with its buffers.
#[derive(Debug, Default)]
pub(crate) struct Staircase {
    /// What happens at each base.
    pub plan: Vec<Shaping>,
    /// Missing stitches left over up to each base, in stitches.
    pub rest: Vec<f64>,
    curve: Vec<f64>,
    /// The curve in whole stitches.
    whole: Vec<i32>,
    /// How the states of each base were reached, a byte a level: see [`RESTED`] and its kin.
    reached: Vec<[u8; LEVELS]>,
}

/// The cheapest ways to one level.
#[derive(Clone, Copy, Debug)]
struct Ways {
    /// By the bases that still have to be plain.
    waits: [f64; WAITS],
    /// By way of a shaping at this base.
    shaped: f64,
    /// The cheapest of all.
    least: f64,
}

/// What it costs where no way leads.
const LOST: f64 = f64::MAX;
const NOWHERE: Ways = Ways { waits: [LOST; WAITS], shaped: LOST, least: LOST };
/// In the byte of a level: the state that waits no more waited for this base,
const RESTED: u8 = 1;
/// the state just shaped is of a decrease, not of an increase,
const FELL: u8 = 2;
/// and it came from one that waited for this base.
const EARLY: u8 = 4;

impl Staircase {
    /// Plans a row. `gaps[i]` is the signed distance from the foot before to foot i in stitch widths, `below` tells
    /// how the bases themselves came about, and it may go on beyond the row.
    pub(crate) fn solve(&mut self, gaps: &[f64], below: &[Shaped], taste: Taste) {
        let n = gaps.len();
        let goal = self.fill_curve(gaps, taste);
        let full = taste.price(n);
        self.plan.clear();
        self.plan.resize(n, Shaping::Plain);
        self.rest.clear();
        self.rest.extend_from_slice(&self.curve);
        let spreads = taste.ease > 0.0 && goal.abs() >= 2;
        if !spreads && self.curve.iter().map(|s| s * s).sum::<f64>() < full {
            // Any shaping costs more than none.
            return;
        }
        let total = self.curve.last().copied().unwrap_or(0.0).abs().max(1.0);
        let cooldown = ((n as f64 / (2.0 * total)) as usize).min(taste.ridge.cooldown());
        // Even where every base is shaped, a decrease needs a plain stitch to join.
        let rested = cooldown.max(1);
        self.whole.clear();
        self.whole.extend(self.curve.iter().map(|s| whole(*s)));
        self.reached.clear();
        self.reached.resize(n, [0; LEVELS]);
        let (mut ways, mut next) = (&mut [NOWHERE; LEVELS], &mut [NOWHERE; LEVELS]);
        ways[REACH as usize] = START;
        // Levels that still have a way worth following.
        let mut live = [REACH as usize; 2];
        let (mut middle, mut cheapest) = (0, 0.0);
        let dear = taste.ridge == Ridge::Dear;
        let hopeless_by = (HOPELESS + 2.0 * taste.ridge.price()).max(3.0 * full);
        let bases = self.curve.iter().zip(&self.whole).zip(&mut self.reached);
        for (i, ((curve, here), reached)) in bases.enumerate() {
            let price = |shaping: Shaping| {
                let bars = i == 0 && (shaping == Shaping::Dec || !dear) || !allowed(shaping, below, i);
                let marked = shaping == Shaping::Dec && taste.marker == Some(i);
                if bars || marked { LOST } else { full + taste.stacking(shaping, below, i) }
            };
            let (inc, dec) = (price(Shaping::Inc), price(Shaping::Dec));
            let shift = middle - here;
            let place = |level: usize, by: i32| (level as i32 + shift + by).clamp(0, LEVELS as i32) as usize;
            let targets = place(live[0], -1)..place(live[1], 2);
            next[targets.clone()].fill(NOWHERE);
            for (level, from) in ways.iter().enumerate().take(live[1] + 1).skip(live[0]) {
                let Ways { waits: [a, b, c, d, e], least, .. } = *from;
                if least > cheapest + hopeless_by {
                    continue;
                }
                let off = curve - f64::from(middle + level as i32 - REACH);
                let to = (level as i32 + shift) as usize;
                let waited = b < a;
                let ready = if waited { b } else { a };
                if let (Some(next), Some(reached)) = (next.get_mut(to), reached.get_mut(to)) {
                    let cost = off * off;
                    next.waits = [ready + cost, c + cost, d + cost, e + cost, LOST];
                    next.least = least + cost;
                    *reached |= u8::from(waited) * RESTED;
                }
                let mut shape = |to: usize, from: f64, off: f64, price: f64, how: u8| {
                    if let (Some(next), Some(reached)) = (next.get_mut(to), reached.get_mut(to)) {
                        let cost = from + off * off + price;
                        if cost < next.shaped {
                            next.shaped = cost;
                            *reached = *reached & RESTED | how;
                        }
                    }
                };
                let (from, early) = if cooldown == 0 && waited { (b, EARLY) } else { (a, 0) };
                shape(to.wrapping_add(1), from, off - 1.0, inc, early);
                shape(to.wrapping_sub(1), a, off + 1.0, dec, FELL);
            }
            std::mem::swap(&mut ways, &mut next);
            cheapest = LOST;
            live = [LEVELS, 0];
            for to in targets {
                let ways = &mut ways[to];
                ways.waits[rested] = ways.shaped;
                ways.least = ways.least.min(ways.shaped);
                if ways.least < LOST {
                    cheapest = cheapest.min(ways.least);
                    live = [live[0].min(to), to];
                }
            }
            middle = *here;
            if live[0] > live[1] {
                // The curve jumps by more than the levels reach: all ways are lost, and the row goes on from there.
                live = [REACH as usize; 2];
                ways[REACH as usize] = START;
                cheapest = 0.0;
            }
        }
        self.trace_back(ways, live, rested);
        if spreads {
            let most = cheapest + taste.evenness(n);
            let row = even::Row { curve: &self.curve, below, goal, cooldown, taste };
            if let Some(places) = row.spread(full, most) {
                let kind = if goal > 0 { Shaping::Inc } else { Shaping::Dec };
                self.plan.fill(Shaping::Plain);
                let mut level = 0.0;
                for i in 0..n {
                    if places.contains(i) {
                        self.plan[i] = kind;
                        level += f64::from(goal.signum());
                    }
                    self.rest[i] = self.curve[i] - level;
                }
            }
        }
    }

    /// Sums the missing stitches, rounds the row's total and spreads what is left over evenly: as stretch, not carried on.
    fn fill_curve(&mut self, gaps: &[f64], taste: Taste) -> i32 {
        self.curve.clear();
        let mut sum = 0.0;
        self.curve.extend(gaps.iter().map(|gap| {
            sum += gap - 1.0;
            sum
        }));
        let early = 0.5 * taste.waiting(gaps.len());
        let missing = sum.abs() - DEAD_BAND;
        // Half of what may wait has waited; the other half comes early, so that rows are right on average.
        let goal = if missing < 0.5 + early { 0.0 } else { (missing + early).round().copysign(sum) };
        let slope = (sum - goal) / gaps.len().max(1) as f64;
        for (i, s) in self.curve.iter_mut().enumerate() {
            *s -= slope * (i as f64 + 1.0);
        }
        goal as i32
    }

    fn trace_back(&mut self, ways: &[Ways; LEVELS], live: [usize; 2], rested: usize) {
        let mut state = (live[0], 0);
        for level in live[0]..=live[1] {
            for (wait, cost) in ways[level].waits.iter().enumerate() {
                if *cost < ways[state.0].waits[state.1] {
                    state = (level, wait);
                }
            }
        }
        for i in (0..self.plan.len()).rev() {
            let (level, wait) = state;
            let q = self.whole[i] + level as i32 - REACH;
            self.rest[i] = self.curve[i] - f64::from(q);
            let how = self.reached[i][level];
            let (shaping, step, before) = if wait == rested {
                let (shaping, step) = if how & FELL == 0 { (Shaping::Inc, 1) } else { (Shaping::Dec, -1) };
                (shaping, step, usize::from(how & EARLY != 0))
            } else if wait == 0 {
                (Shaping::Plain, 0, usize::from(how & RESTED != 0))
            } else {
                (Shaping::Plain, 0, wait + 1)
            };
            self.plan[i] = shaping;
            let middle = if i == 0 { 0 } else { self.whole[i - 1] };
            state = ((q - step - middle + REACH).clamp(0, LEVELS as i32 - 1) as usize, before);
        }
    }
}

/// The start of a row, and of one that goes on where all ways were lost.
const START: Ways = Ways { waits: [0.0, LOST, LOST, LOST, LOST], shaped: LOST, least: 0.0 };

/// The nearest whole number, halves away from zero; far ones are cut off.
fn whole(x: f64) -> i32 {
    const MOST: f64 = 1e6;
    // The greatest number below one half, so that what lies a hair below it is not rounded up.
    (x + 0.499_999_999_999_999_94_f64.copysign(x)).clamp(-MOST, MOST) as i32
}

/// True where a base or one beside it came about in such a way.
pub(super) fn beside(below: &[Shaped], i: usize, such: impl Fn(Shaped) -> bool) -> bool {
    let near = below.get(i.saturating_sub(1)..(i + 2).min(below.len()));
    near.is_some_and(|near| near.iter().any(|shaped| such(*shaped)))
}

/// The row below lets a shaping stand at base `i`: it does not undo what is there.
pub(super) fn allowed(shaping: Shaping, below: &[Shaped], i: usize) -> bool {
    match shaping {
        Shaping::Plain => true,
        Shaping::Inc => below[i] != Shaped::Dec,
        Shaping::Dec => below[i] != Shaped::Inc && below[i - 1] != Shaped::Inc,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn net(gaps: &[f64]) -> (usize, usize) {
        let mut staircase = Staircase::default();
        staircase.solve(gaps, &vec![Shaped::No; gaps.len()], Taste::default());
        let count = |kind| staircase.plan.iter().filter(|shaping| **shaping == kind).count();
        (count(Shaping::Inc), count(Shaping::Dec))
    }

    #[test]
    fn a_row_of_right_width_stays_plain() {
        assert_eq!(net(&[1.0; 40]), (0, 0));
        assert_eq!(net(&[1.01; 40]), (0, 0));
    }

    #[test]
    fn the_net_count_follows_the_width() {
        assert_eq!(net(&[1.2; 30]), (6, 0));
        assert_eq!(net(&[0.8; 30]), (0, 6));
        assert_eq!(net(&[2.0; 6]), (5, 0), "the foot of the first base is where it belongs");
    }

    #[test]
    fn decreases_keep_a_plain_stitch_between_them() {
        let mut staircase = Staircase::default();
        staircase.solve(&[0.5; 12], &[Shaped::No; 12], Taste::default());
        for pair in staircase.plan.windows(2) {
            assert_ne!(pair, [Shaping::Dec, Shaping::Dec]);
        }
    }

    #[test]
    fn an_increase_moves_aside_for_one_below() {
        // All of one stitch is missing at one place.
        let mut gaps = [1.0; 30];
        gaps[15] = 2.0;
        let place = |gaps: &[f64], below: &[Shaped], taste: Taste| {
            let mut staircase = Staircase::default();
            staircase.solve(gaps, below, taste);
            staircase.plan.iter().position(|shaping| *shaping == Shaping::Inc)
        };
        let mut below = [Shaped::No; 30];
        assert_eq!(place(&gaps, &below, Taste::default()), Some(15));
        below[15..17].fill(Shaped::Inc);
        let aside = place(&gaps, &below, Taste::default()).expect("worked somewhere");
        assert!([13, 18].contains(&aside), "{aside}");
        assert_eq!(place(&gaps, &below, Taste { ridge: Ridge::Cheap, ..Taste::default() }), Some(15));
        below.fill(Shaped::Inc);
        gaps[15] = 4.0;
        assert!(place(&gaps, &below, Taste::default()).is_some(), "where there is no other place, it stays");
    }

    #[test]
    fn ridges_are_gone_round_as_far_as_it_takes() {
        // Two stitches are missing at one place of a row that is clear at its beginning only.
        let increases = |place: usize, clear: usize, before: Shaped| {
            let mut gaps = [1.0; 40];
            gaps[place..place + 2].fill(2.0);
            let mut below = [Shaped::Inc; 40];
            below[..=clear].fill(Shaped::No);
            let mut staircase = Staircase::default();
            staircase.solve(&gaps, &below, Taste { before, ..Taste::default() });
            let places = 0..gaps.len();
            places.filter(|i| staircase.plan[*i] == Shaping::Inc).collect::<Vec<_>>()
        };
        assert_eq!(increases(9, 5, Shaped::No), [3, 4]);
        assert_eq!(increases(4, 2, Shaped::No), [0, 1]);
        let beside = increases(4, 2, Shaped::Inc);
        assert!(beside[0] > 0, "the base before is a neighbor too: {beside:?}");
    }
}
