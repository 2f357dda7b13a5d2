//! Short-row ends of the last rows: ends right over each other make a visible seam, so they cost more.

use crate::math;
use std::ops::Range;

/// Price of a short-row end right over one of the row before, its reach in stitches, and how fast it fades per batch.
const PRICE: f64 = 1.5;
const REACH: f64 = 3.0;
const FADE: f64 = 0.6;
/// What is left of one that is forgotten.
const FORGOTTEN: f64 = 0.1;

/// Recent ends: the place of each around the tube, in turns, and its weight.
#[derive(Debug, Default)]
pub(super) struct Stacked(Vec<(f64, f64)>);

impl Stacked {
    /// Another batch lies over them.
    pub(super) fn fade(&mut self) {
        for end in &mut self.0 {
            end.1 *= FADE;
        }
        self.0.retain(|end| end.1 > FORGOTTEN);
    }

    /// A new one.
    pub(super) fn push(&mut self, v: f64) {
        self.0.push((v, 1.0));
    }

    /// Extra prices of an end at places along a round of so many stitches.
    pub(super) fn prices(&self, places: &[f64], around: f64) -> Vec<f64> {
        let mut prices = vec![0.0; places.len()];
        if self.0.is_empty() {
            return prices;
        }
        let near = Near::new(places);
        let reach = FAR * REACH / around;
        for &(end, weight) in &self.0 {
            for (turn, range) in near.ranges(end, reach) {
                for (price, v) in prices[range.clone()].iter_mut().zip(&places[range]) {
                    let nearest = math::nearest(v - end);
                    let off = (v - end - nearest).abs() * around / REACH;
                    // What lies as near on another turn has its price there.
                    if nearest == turn && off <= FAR {
                        *price += PRICE * weight * bell(off);
                    }
                }
            }
        }
        prices
    }
}

/// Where to look for places that rise, but for a little to and fro.
struct Near {
    /// The greatest of the places up to each, and the least from each on.
    greatest: Vec<f64>,
    least: Vec<f64>,
}

impl Near {
    fn new(places: &[f64]) -> Self {
        let along = |most: &mut f64, v: &f64| {
            *most = most.max(*v);
            Some(*most)
        };
        let back = |most: &mut f64, v: &f64| {
            *most = most.min(*v);
            Some(*most)
        };
        let greatest = places.iter().scan(f64::NEG_INFINITY, along).collect();
        let mut least: Vec<f64> = places.iter().rev().scan(f64::INFINITY, back).collect();
        least.reverse();
        Self { greatest, least }
    }

    /// The whole turns by which places may be away from another one, and among which places those are that lie within `reach` of
    /// it then.
    fn ranges(&self, place: f64, reach: f64) -> impl Iterator<Item = (f64, Range<usize>)> {
        // A hair more, for rounding.
        let reach = reach.min(0.5) + 1e-9;
        let first = self.least.first().map_or(0.0, |least| (least - reach - place).ceil());
        let last = self.greatest.last().map_or(-1.0, |greatest| (greatest + reach - place).floor());
        (first as i64..=last as i64).map(move |turn| {
            let at = place + turn as f64;
            let from = self.greatest.partition_point(|v| *v < at - reach);
            let until = self.least.partition_point(|v| *v <= at + reach);
            (turn as f64, from..until.max(from))
        })
    }
}

const FAR: f64 = 4.0;

/// `exp(-x^2)` for |x| up to [`FAR`], to a hundredth of itself.
fn bell(x: f64) -> f64 {
    // The series for a sixteenth of the exponent, and four squares.
    let y = x * x / 16.0;
    let root =
        1.0 - y * (1.0 - y / 2.0 * (1.0 - y / 3.0 * (1.0 - y / 4.0 * (1.0 - y / 5.0 * (1.0 - y / 6.0)))));
    let square = |x: f64| x * x;
    square(square(square(square(root))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bell_is_that_of_gauss() {
        for k in 0..=400 {
            let x = f64::from(k) / 100.0;
            let exact = math::exp(-x * x);
            assert!((bell(x) - exact).abs() <= 0.01 * exact, "{x}");
        }
    }

    #[test]
    fn ends_over_each_other_cost_more_for_a_while() {
        let mut ends = Stacked::default();
        ends.push(0.99);
        let prices = ends.prices(&[2.5, 2.99, 3.02], 40.0);
        assert!(prices[0] == 0.0 && prices[1] > 1.4 && prices[2] > 0.5, "{prices:?}");
        for _ in 0..6 {
            ends.fade();
        }
        assert_eq!(ends.prices(&[0.99], 40.0), [0.0]);
    }

    #[test]
    fn every_end_has_its_price_at_every_place_near_it() {
        let mut ends = Stacked::default();
        for k in 0..40 {
            ends.push(math::sin(f64::from(k)) + f64::from(k / 10));
        }
        for around in [3.0, 11.0, 24.0, 30.0, 400.0] {
            // Rising, but for a little to and fro.
            let count = 300;
            let place =
                |k: u32| 2.7 + 1.1 * f64::from(k) / f64::from(count) + 0.01 * math::sin(f64::from(7 * k));
            let places: Vec<f64> = (0..count).map(place).collect();
            let prices = ends.prices(&places, around);
            for (v, price) in places.iter().zip(prices) {
                let each = ends.0.iter().map(|&(end, weight)| {
                    let off = (v - end - math::nearest(v - end)).abs() * around / REACH;
                    if off > FAR { 0.0 } else { PRICE * weight * bell(off) }
                });
                assert_eq!(price, each.sum::<f64>(), "{v} {around}");
            }
        }
    }
}
