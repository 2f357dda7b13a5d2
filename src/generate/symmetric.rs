//! Surfaces of revolution, shaped as a designer would: every round repeats one short sequence, staggered from round to round.
//!
//! The stitch count of each round comes from a dynamic program over the rounds: it stays near the girth, and it changes only
//! where the number of shapings divides the round, so that each round is one clean repeat such as `(2 sc, inc, 2 sc) x 6`.

use super::rows::Rows;
use super::sheet::{Foot, Shaped, Sheet, Work};
use super::staircase::beside;
use crate::ir::{NodeId, Stitch};
use crate::shape::ParametricSurface;

/// Price of a shaped round, in stitch-weighted squared strain; what is added for shaping in few places, for a number of
/// places that does not go with the magic ring or is a part of it, and, on an open tube, for one that is no multiple of six.
const PRICE: f64 = 0.012;
const LOPSIDED: f64 = 0.25;
const OUT_OF_STEP: f64 = 0.5;
const PART_OF_STEP: f64 = 0.2;
const OUT_OF_SIX: f64 = 0.05;
/// How many times dearer a shaped round is with full ease, and one out of step with the others: more rounds are plain then.
const DEARER: f64 = 40.0;
const STEP_DEARER: f64 = 4.0;
/// How far a round may be from its girth.
const BAND: f64 = 0.16;
const BAND_LEAST: f64 = 3.0;
const BAND_MOST: f64 = 160.0;

/// Stitches of each round, the first row included; `None` when no sequence of clean rounds follows the girth.
/// `ring` fixes the first round.
pub(crate) fn plan_counts(girths: &[f64], ring: Option<u32>, ease: f64) -> Option<Vec<u32>> {
    let band = |k: usize| -> (u32, u32) {
        if k == 0
            && let Some(ring) = ring
        {
            return (ring, ring);
        }
        let reach = (BAND * girths[k]).clamp(BAND_LEAST, BAND_MOST);
        ((girths[k] - reach).ceil().max(3.0) as u32, (girths[k] + reach).floor().max(3.0) as u32)
    };
    let strain = |k: usize, n: u32| {
        let off = (f64::from(n) - girths[k]) / girths[k];
        f64::from(n) * off * off
    };
    let (low, high) = band(0);
    let mut cost: Vec<f64> = (low..=high).map(|n| strain(0, n)).collect();
    // Before the sum there is nothing; then one row of back pointers a round.
    let mut lows = vec![low];
    let mut from: Vec<Vec<u32>> = vec![Vec::new()];
    for k in 1..girths.len() {
        let (low, high) = band(k);
        let before = lows[k - 1];
        let mut best = vec![f64::MAX; (high - low + 1) as usize];
        let mut back = vec![0; best.len()];
        for (i, &so_far) in cost.iter().enumerate() {
            if so_far == f64::MAX {
                continue;
            }
            let n = before + i as u32;
            let mut consider = |to: u32, price: f64| {
                if (low..=high).contains(&to) {
                    let total = so_far + price + strain(k, to);
                    let slot = (to - low) as usize;
                    if total < best[slot] - 1e-12 {
                        (best[slot], back[slot]) = (total, n);
                    }
                }
            };
            consider(n, 0.0);
            // Shapings come in a number that divides the round.
            for repeats in 1..=(high.saturating_sub(n)).max(n.saturating_sub(low)).min(n) {
                if n.is_multiple_of(repeats) {
                    let price = shaping_price(repeats, ring, ease);
                    consider(n + repeats, price);
                    if n / repeats >= 2 {
                        consider(n - repeats, price);
                    }
                }
            }
        }
        cost = best;
        lows.push(low);
        from.push(back);
    }
    let (i, total) = cost.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1))?;
    if *total == f64::MAX {
        return None;
    }
    let mut counts = vec![lows[girths.len() - 1] + i as u32];
    for k in (1..girths.len()).rev() {
        let n = counts[counts.len() - 1];
        counts.push(from[k][(n - lows[k]) as usize]);
    }
    counts.reverse();
    Some(counts)
}

fn shaping_price(repeats: u32, ring: Option<u32>, ease: f64) -> f64 {
    let lopsided = if repeats < 4 { LOPSIDED / f64::from(repeats) } else { 0.0 };
    let odd = match ring {
        Some(ring) if repeats.is_multiple_of(ring) => 0.0,
        Some(ring) if ring.is_multiple_of(repeats) => PART_OF_STEP,
        Some(_) => OUT_OF_STEP,
        None if repeats.is_multiple_of(6) => 0.0,
        None => OUT_OF_SIX,
    };
    PRICE * (1.0 + DEARER * ease) + lopsided + odd * (1.0 + STEP_DEARER * ease)
}

/// Lays the rounds over the first row that the sheet holds. Positions are the regular ones on the helix.
pub(crate) fn lay_rounds(
    surface: &dyn ParametricSurface,
    sheet: &mut Sheet,
    rows: &Rows,
    counts: &[u32],
    mut progress: impl FnMut(u32),
) {
    let mut bases = 0..counts[0] as NodeId;
    let mut wale = None;
    let mut yarn = bases.end - 1;
    let mut shaped_rounds = 0_u32;
    // Each round is turned so that its wales stand upright on average: square on the slanted courses of the helix, and
    // without the lean that a shaping off the middle of its repeat gives them.
    let mut drift = 0.0;
    for (k, pair) in counts.windows(2).enumerate() {
        let (n, m) = (pair[0], pair[1]);
        let repeats = n.abs_diff(m);
        let rule = Repeat::new(n, m, shaped_rounds).clear_of(&sheet.shaped[bases.start as usize..], n);
        shaped_rounds += u32::from(repeats > 0);
        let first = sheet.len() as NodeId;
        let slant = sheet.height / (sheet.width * f64::from(n.max(m)));
        drift += slant * slant + rule.lean() / f64::from(n / rule.period);
        let mut made = 0;
        let mut i = 0;
        while i < n {
            let stitch = rule.at(i);
            let base = [bases.start + i, bases.start + i + u32::from(stitch.works) - 1];
            let mut top = [0; 2];
            for slot in &mut top[..usize::from(stitch.makes)] {
                let v = k as f64 + 1.0 + (f64::from(made) + 0.5) / f64::from(m) - drift;
                let u = rows.at(v);
                let jet = surface.jet(u, v);
                let foot = Foot { u, v, point: jet.point, du: jet.du, dv: jet.dv, along: jet.dv };
                let shaped = match stitch.makes {
                    2 => Shaped::Inc,
                    _ if stitch.works == 2 => Shaped::Dec,
                    _ => Shaped::No,
                };
                let id = sheet.add(&foot, shaped);
                sheet.course(yarn, id);
                yarn = id;
                *slot = id;
                made += 1;
            }
            if stitch.makes == 1 {
                top[1] = top[0];
            }
            for (b, t) in [(base[0], top[0]), (base[1], top[1])] {
                if wale != Some((b, t)) {
                    sheet.wale(wale, b, t);
                    wale = Some((b, t));
                }
            }
            sheet.main.push(Work { stitch, base, top });
            i += u32::from(stitch.works);
        }
        bases = first..first + m;
        progress(k as u32 + 1);
    }
}

/// The sequence that a round repeats: plain stitches with one shaping among them.
#[derive(Debug, Clone, Copy)]
struct Repeat {
    /// Bases of one repeat.
    period: u32,
    /// Bases before the shaping.
    lead: u32,
    shaping: Stitch,
}

impl Repeat {
    /// From `n` to `m` stitches. Odd shaped rounds hold the shaping at the end of the repeat, even ones in its middle, so that
    /// shapings do not stand in columns and the fabric shows no edges.
    fn new(n: u32, m: u32, shaped_before: u32) -> Self {
        let repeats = n.abs_diff(m);
        if repeats == 0 {
            return Self { period: 1, lead: 0, shaping: Stitch::SC };
        }
        let shaping = if m > n { Stitch::INC } else { Stitch::DEC };
        let period = n / repeats;
        let plain = period - u32::from(shaping.works);
        Self { period, lead: if shaped_before.is_multiple_of(2) { plain } else { plain / 2 }, shaping }
    }

    /// The same with the shaping where fewest increases stand on one of the round `below`, as near as may be; where that
    /// helps no more than a few, it stays.
    fn clear_of(self, below: &[Shaped], n: u32) -> Self {
        if self.shaping != Stitch::INC {
            return self;
        }
        let stacked = |lead: u32| {
            let places = (lead..n).step_by(self.period as usize);
            let near = places.filter(|base| beside(below, *base as usize, |shaped| shaped == Shaped::Inc));
            near.count()
        };
        let moves = [0, -1, 1, -2, 2, -3, 3].map(|by| self.lead.checked_add_signed(by));
        let leads = moves.into_iter().flatten().filter(|lead| *lead < self.period);
        let lead = leads.min_by_key(|lead| stacked(*lead)).unwrap_or(self.lead);
        if 2 * stacked(lead) > stacked(self.lead) { self } else { Self { lead, ..self } }
    }

    /// Mean lean of the wales to the working direction when bases and tops both stand evenly, in repeats.
    fn lean(&self) -> f64 {
        let (works, makes) = (u32::from(self.shaping.works), u32::from(self.shaping.makes));
        let tops = self.period - works + makes;
        let (mut top, mut base, mut sum, mut wales) = (0, 0, 0.0, 0.0);
        while base < self.period {
            let stitch = self.at(base);
            for b in 0..stitch.works {
                for t in 0..stitch.makes {
                    let place = (f64::from(top + u32::from(t)) + 0.5) / f64::from(tops);
                    sum += place - (f64::from(base + u32::from(b)) + 0.5) / f64::from(self.period);
                    wales += 1.0;
                }
            }
            base += u32::from(stitch.works);
            top += u32::from(stitch.makes);
        }
        sum / wales
    }

    fn at(&self, base: u32) -> Stitch {
        if base % self.period == self.lead { self.shaping } else { Stitch::SC }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math;

    #[test]
    fn a_ball_grows_by_six() {
        let girths: Vec<f64> =
            (1..24).map(|k| 24.0 * 2.0 * math::sin(math::PI * f64::from(k) / 24.0)).collect();
        let counts = plan_counts(&girths, Some(6), 0.0).unwrap();
        assert_eq!(counts[..6], [6, 12, 18, 24, 30, 36]);
        assert_eq!(counts[counts.len() - 1], 6);
        assert!(counts.iter().all(|n| n % 6 == 0), "{counts:?}");
    }

    #[test]
    fn a_cylinder_keeps_its_girth() {
        assert_eq!(plan_counts(&[37.7; 10], None, 0.0).unwrap(), [38; 10]);
    }

    #[test]
    fn a_funnel_too_steep_for_clean_rounds_has_no_plan() {
        assert_eq!(plan_counts(&[10.0, 60.0, 10.0], None, 0.0), None);
    }
}
