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

    /// What a shaping at base `i` costs more for those of the row below.
    fn stacking(self, below: &[Shaped], i: usize) -> f64 {
        let own = if below[i] == Shaped::No { 0.0 } else { STACKED };
        if self.ease == 0.0 || !beside(below, i) { own } else { own + self.ease * RIDGE }
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
/// Price of a shaping beside one of the row below, with full ease.
const RIDGE: f64 = 3.0;
/// Mean squared distance from where a shaping belongs that evenly spread ones may have more with full ease.
const EVEN: f64 = 0.6;
/// Levels on either side of the curve that are tried.
const REACH: i32 = 4;
const LEVELS: usize = 2 * REACH as usize + 1;
/// Longest distance between shapings, in bases.
const COOLDOWN: usize = 4;
const STATES: usize = LEVELS * (COOLDOWN + 1);

/// The plan of one row with its buffers.
#[derive(Debug, Default)]
pub(crate) struct Staircase {
    /// What happens at each base.
    pub plan: Vec<Shaping>,
    /// Missing stitches left over up to each base, in stitches.
    pub rest: Vec<f64>,
    curve: Vec<f64>,
    /// How each state was reached: shaping in the low two bits, cooldown before in the rest.
    reached: Vec<[u8; STATES]>,
}

impl Staircase {
    /// Plans a row. `gaps[i]` is the signed distance from the foot before to foot i in stitch widths, `below` tells
    /// how the bases themselves came about.
    pub(crate) fn solve(&mut self, gaps: &[f64], below: &[Shaped], taste: Taste) {
        let n = gaps.len();
        let goal = self.fill_curve(gaps, taste);
        let full = taste.price(n);
        let total = self.curve.last().copied().unwrap_or(0.0).abs().max(1.0);
        let cooldown = ((n as f64 / (2.0 * total)) as usize).min(COOLDOWN);
        // Even where every base is shaped, a decrease needs a plain stitch to join.
        let rested = cooldown.max(1);
        let center = |i: usize| self.curve[i].round() as i32;
        let mut cost = [f64::MAX; STATES];
        let mut next = [f64::MAX; STATES];
        self.reached.clear();
        self.reached.resize(n, [0; STATES]);
        let start = REACH as usize;
        cost[start * (COOLDOWN + 1)] = 0.0;
        let mut middle = 0;
        for i in 0..n {
            next.fill(f64::MAX);
            let here = center(i);
            let price = full + taste.stacking(below, i);
            for level in 0..LEVELS {
                let q = middle + level as i32 - REACH;
                for wait in 0..=rested {
                    let so_far = cost[level * (COOLDOWN + 1) + wait];
                    if so_far == f64::MAX {
                        continue;
                    }
                    for (shaping, step) in [(Shaping::Plain, 0), (Shaping::Inc, 1), (Shaping::Dec, -1)] {
                        if shaping != Shaping::Plain
                            && (i == 0 || !allowed(shaping, wait, cooldown, below, i))
                        {
                            continue;
                        }
                        if shaping == Shaping::Dec && taste.marker == Some(i) {
                            continue;
                        }
                        let to = q + step - here + REACH;
                        if !(0..LEVELS as i32).contains(&to) {
                            continue;
                        }
                        let (wait_after, paid) = if shaping == Shaping::Plain {
                            (wait.saturating_sub(1), 0.0)
                        } else {
                            (rested, price)
                        };
                        let off = self.curve[i] - f64::from(q + step);
                        let total = so_far + off * off + paid;
                        let state = to as usize * (COOLDOWN + 1) + wait_after;
                        if total < next[state] {
                            next[state] = total;
                            self.reached[i][state] = shaping as u8 | (wait as u8) << 2;
                        }
                    }
                }
            }
            std::mem::swap(&mut cost, &mut next);
            middle = here;
        }
        self.trace_back(&cost, n);
        if taste.ease > 0.0 && goal.abs() >= 2 {
            let least = cost.iter().copied().fold(f64::MAX, f64::min);
            let most = least + taste.evenness(n);
            let row = even::Row {
                curve: &self.curve,
                below,
                goal,
                marker: taste.marker,
                cooldown,
                ridge: taste.ease * RIDGE,
            };
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

    fn trace_back(&mut self, cost: &[f64; STATES], n: usize) {
        self.plan.clear();
        self.plan.resize(n, Shaping::Plain);
        self.rest.clear();
        self.rest.resize(n, 0.0);
        let mut state = 0;
        for (k, c) in cost.iter().enumerate() {
            if *c < cost[state] {
                state = k;
            }
        }
        for i in (0..n).rev() {
            let here = self.curve[i].round() as i32;
            let q = here + (state / (COOLDOWN + 1)) as i32 - REACH;
            self.rest[i] = self.curve[i] - f64::from(q);
            let reached = self.reached[i][state];
            let (shaping, step) = match reached & 3 {
                1 => (Shaping::Inc, 1),
                2 => (Shaping::Dec, -1),
                _ => (Shaping::Plain, 0),
            };
            self.plan[i] = shaping;
            let before = if i == 0 { 0 } else { self.curve[i - 1].round() as i32 };
            let level = (q - step - before + REACH).clamp(0, LEVELS as i32 - 1);
            state = level as usize * (COOLDOWN + 1) + usize::from(reached >> 2);
        }
    }
}

/// True where a base or one beside it is of a shaping of the row below: stacked ones draw a ridge.
pub(super) fn beside(below: &[Shaped], i: usize) -> bool {
    let near = below.get(i.saturating_sub(1)..(i + 2).min(below.len()));
    near.is_some_and(|near| near.iter().any(|shaped| *shaped != Shaped::No))
}

/// A shaping may stand at base `i`, and does not undo the row below.
pub(super) fn allowed(shaping: Shaping, wait: usize, cooldown: usize, below: &[Shaped], i: usize) -> bool {
    match shaping {
        Shaping::Plain => true,
        Shaping::Inc => (wait == 0 || cooldown == 0) && below[i] != Shaped::Dec,
        Shaping::Dec => wait == 0 && below[i] != Shaped::Inc && below[i - 1] != Shaped::Inc,
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
}
