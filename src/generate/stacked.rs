//! Short-row ends of the last rows: ends right over each other make a visible seam, so they cost more.

use crate::math;

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

    /// Extra price of an end at a place in a round of so many stitches.
    pub(super) fn price(&self, v: f64, around: f64) -> f64 {
        let each = self.0.iter().map(|&(end, weight)| {
            let turn = (v - end) - math::nearest(v - end);
            let off = turn.abs() * around / REACH;
            if off > FAR { 0.0 } else { PRICE * weight * bell(off) }
        });
        each.sum()
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
        assert!(ends.price(2.99, 40.0) > 1.4 && ends.price(3.02, 40.0) > 0.5);
        assert_eq!(ends.price(0.5, 40.0), 0.0);
        for _ in 0..6 {
            ends.fade();
        }
        assert_eq!(ends.price(0.99, 40.0), 0.0);
    }
}
