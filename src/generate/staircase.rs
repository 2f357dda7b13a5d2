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

/// What a row is asked for beside its width.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Taste {
    /// How much simpler words are worth, from 0 to 1.
    pub ease: f64,
    /// The first base of a new round, which is not worked together with the last of the one before.
    pub marker: Option<usize>,
    /// Increases may stand on those of the row below for little.
    pub stacks: bool,
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
        own + self.ridge(shaping, below, i)
    }

    /// What it costs more beside those of the row below: stacked ones draw a ridge.
    pub(super) fn ridge(self, shaping: Shaping, below: &[Shaped], i: usize) -> f64 {
        if shaping == Shaping::Inc && beside(below, i, |shaped| shaped == Shaped::Inc) {
            if self.stacks { LOW_RIDGE } else { RIDGE }
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
/// Price of an increase beside one of the row below, which is that of a few stitches' way to a place that is clear; the same
/// where increases may stack; and of any shaping beside another with full ease.
const RIDGE: f64 = 4.0;
const LOW_RIDGE: f64 = 0.5;
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
    /// How each state was reached: shaping in the low two bits, cooldown before in the rest.
    reached: Vec<[[u8; WAITS]; LEVELS]>,
}

impl Staircase {
    /// Plans a row. `gaps[i]` is the signed distance from the foot before to foot i in stitch widths, `below` tells
    /// how the bases themselves came about, and it may go on beyond the row.
    pub(crate) fn solve(&mut self, gaps: &[f64], below: &[Shaped], taste: Taste) {
        let n = gaps.len();
        let goal = self.fill_curve(gaps, taste);
        let full = taste.price(n);
        let total = self.curve.last().copied().unwrap_or(0.0).abs().max(1.0);
        let cooldown = ((n as f64 / (2.0 * total)) as usize).min(COOLDOWN);
        // Even where every base is shaped, a decrease needs a plain stitch to join.
        let rested = cooldown.max(1);
        let center = |i: usize| self.curve[i].round() as i32;
        let mut cost = [[f64::MAX; WAITS]; LEVELS];
        cost[REACH as usize][0] = 0.0;
        self.reached.clear();
        self.reached.resize(n, [[0; WAITS]; LEVELS]);
        let mut middle = 0;
        let mut cheapest = 0.0;
        let hopeless_by = HOPELESS.max(3.0 * full);
        // Levels that still have a way worth following.
        let mut live = [REACH as usize; 2];
        for i in 0..n {
            let mut next = [[f64::MAX; WAITS]; LEVELS];
            let here = center(i);
            let shift = middle - here;
            let hopeless = cheapest + hopeless_by;
            cheapest = f64::MAX;
            let price = |shaping| full + taste.stacking(shaping, below, i);
            let may_inc = i > 0 && allowed(Shaping::Inc, below, i);
            let may_dec = i > 0 && allowed(Shaping::Dec, below, i) && taste.marker != Some(i);
            let (inc, dec) = (price(Shaping::Inc), price(Shaping::Dec));
            let mut reach = [LEVELS, 0];
            let levels = cost.iter().enumerate().take(live[1] + 1).skip(live[0]);
            for (level, waits) in levels {
                let to = level as i32 + shift;
                let off = self.curve[i] - f64::from(here + to - REACH);
                for (wait, &so_far) in waits.iter().enumerate().take(rested + 1) {
                    if so_far > hopeless {
                        continue;
                    }
                    let mut reaches = |to: i32, wait_after: usize, total: f64, shaping: Shaping| {
                        if !(0..LEVELS as i32).contains(&to) {
                            return;
                        }
                        let to = to as usize;
                        if total < next[to][wait_after] {
                            next[to][wait_after] = total;
                            self.reached[i][to][wait_after] = shaping as u8 | (wait as u8) << 2;
                            cheapest = cheapest.min(total);
                            reach = [reach[0].min(to), reach[1].max(to)];
                        }
                    };
                    reaches(to, wait.saturating_sub(1), so_far + off * off, Shaping::Plain);
                    if may_inc && (wait == 0 || cooldown == 0) {
                        let off = off - 1.0;
                        reaches(to + 1, rested, so_far + off * off + inc, Shaping::Inc);
                    }
                    if may_dec && wait == 0 {
                        let off = off + 1.0;
                        reaches(to - 1, rested, so_far + off * off + dec, Shaping::Dec);
                    }
                }
            }
            live = reach;
            cost = next;
            middle = here;
            if live[0] > live[1] {
                // The curve jumps by more than the levels reach: all ways are lost, and the row goes on from there.
                live = [REACH as usize; 2];
                cost[REACH as usize][0] = 0.0;
                cheapest = 0.0;
            }
        }
        self.trace_back(&cost, n);
        if taste.ease > 0.0 && goal.abs() >= 2 {
            let least = cost.iter().flatten().copied().fold(f64::MAX, f64::min);
            let most = least + taste.evenness(n);
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

    fn trace_back(&mut self, cost: &[[f64; WAITS]; LEVELS], n: usize) {
        self.plan.clear();
        self.plan.resize(n, Shaping::Plain);
        self.rest.clear();
        self.rest.resize(n, 0.0);
        let mut state = (0, 0);
        for (level, waits) in cost.iter().enumerate() {
            for (wait, c) in waits.iter().enumerate() {
                if *c < cost[state.0][state.1] {
                    state = (level, wait);
                }
            }
        }
        for i in (0..n).rev() {
            let here = self.curve[i].round() as i32;
            let q = here + state.0 as i32 - REACH;
            self.rest[i] = self.curve[i] - f64::from(q);
            let reached = self.reached[i][state.0][state.1];
            let (shaping, step) = match reached & 3 {
                1 => (Shaping::Inc, 1),
                2 => (Shaping::Dec, -1),
                _ => (Shaping::Plain, 0),
            };
            self.plan[i] = shaping;
            let before = if i == 0 { 0 } else { self.curve[i - 1].round() as i32 };
            let level = (q - step - before + REACH).clamp(0, LEVELS as i32 - 1);
            state = (level as usize, usize::from(reached >> 2).min(COOLDOWN));
        }
    }
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
        assert_eq!(net(&[2.0; 6]), (5, 0), "the first base of a row is never shaped");
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
        let place = |below: &[Shaped], taste: Taste| {
            let mut staircase = Staircase::default();
            staircase.solve(&gaps, below, taste);
            staircase.plan.iter().position(|shaping| *shaping == Shaping::Inc)
        };
        let mut below = [Shaped::No; 30];
        assert_eq!(place(&below, Taste::default()), Some(15));
        below[15..17].fill(Shaped::Inc);
        let aside = place(&below, Taste::default()).expect("worked somewhere");
        assert!([13, 18].contains(&aside), "{aside}");
        assert_eq!(place(&below, Taste { stacks: true, ..Taste::default() }), Some(15));
        below.fill(Shaped::Inc);
        assert!(place(&below, Taste::default()).is_some(), "where there is no other place, it stays");
    }
}
