//! Shapings at equal distances, so that a row folds into a repeat such as `(5 sc, inc) x 6`.

use super::sheet::Shaped;
use super::staircase::{Shaping, Taste, allowed};

/// A row to be shaped.
pub(crate) struct Row<'r> {
    /// Missing stitches up to each base.
    pub curve: &'r [f64],
    /// How the bases came about.
    pub below: &'r [Shaped],
    /// Increases, or with a minus decreases.
    pub goal: i32,
    /// Plain bases that shapings need between them.
    pub cooldown: usize,
    /// What the row is asked for.
    pub taste: Taste,
}

/// Bases at equal distances.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Places {
    first: usize,
    gap: usize,
    count: usize,
}

impl Places {
    /// True for one of them.
    pub(crate) fn contains(self, base: usize) -> bool {
        base.checked_sub(self.first)
            .is_some_and(|past| past.is_multiple_of(self.gap) && past / self.gap < self.count)
    }

    fn iter(self) -> impl Iterator<Item = usize> {
        (0..self.count).map(move |k| self.first + k * self.gap)
    }
}

impl Row<'_> {
    /// The cheapest even places, if they cost no more than `most`; `price` is that of one shaping.
    pub(crate) fn spread(&self, price: f64, most: f64) -> Option<Places> {
        let n = self.curve.len();
        let count = self.goal.unsigned_abs() as usize;
        let gap = n.checked_div(count).filter(|gap| *gap > self.cooldown.max(1))?;
        let sums = Sums::new(self.curve);
        let last = n - (count - 1) * gap;
        let all = (1..last).map(|first| Places { first, gap, count });
        let priced = all.filter_map(|places| Some((self.cost(places, price, &sums)?, places)));
        let best = priced.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (best.0 <= most).then_some(best.1)
    }

    fn cost(&self, places: Places, price: f64, sums: &Sums) -> Option<f64> {
        let kind = if self.goal > 0 { Shaping::Inc } else { Shaping::Dec };
        let step = f64::from(self.goal.signum());
        let (mut cost, mut level, mut from) = (0.0, 0.0, 0);
        for place in places.iter() {
            if !allowed(kind, self.below, place) || (kind == Shaping::Dec && self.taste.marker == Some(place))
            {
                return None;
            }
            cost += sums.off(from, place, level);
            (from, level) = (place, level + step);
            cost += price + self.taste.beside(kind, self.below, place);
        }
        Some(cost + sums.off(from, self.curve.len(), level))
    }
}

/// Sums and sums of squares, so that a stretch is priced at once.
struct Sums(Vec<[f64; 2]>);

impl Sums {
    fn new(curve: &[f64]) -> Self {
        let mut sum = [0.0; 2];
        let mut sums = Vec::with_capacity(curve.len() + 1);
        sums.push(sum);
        sums.extend(curve.iter().map(|s| {
            sum = [sum[0] + s, sum[1] + s * s];
            sum
        }));
        Self(sums)
    }

    /// Sum of squared distances from a level.
    fn off(&self, from: usize, to: usize, level: f64) -> f64 {
        let ([a, aa], [b, bb]) = (self.0[from], self.0[to]);
        (bb - aa) - 2.0 * level * (b - a) + level * level * (to - from) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(curve: &[f64], below: &[Shaped], goal: i32) -> Option<Places> {
        Row { curve, below, goal, cooldown: 4, taste: Taste::default() }.spread(1.5, 1e9)
    }

    #[test]
    fn even_growth_is_spread_evenly_and_stays_clear_of_the_row_below() {
        let curve: Vec<f64> = (1..=36).map(|i| f64::from(i) / 6.0).collect();
        let plain = vec![Shaped::No; 36];
        let places = row(&curve, &plain, 6).expect("room");
        assert_eq!((places.gap, places.count), (6, 6));
        let mut below = plain;
        for place in places.iter() {
            below[place] = Shaped::Inc;
        }
        let next = row(&curve, &below, 6).expect("room");
        assert!(next.iter().all(|place| {
            (place as i32 - places.first as i32)
                .rem_euclid(6)
                .min((places.first as i32 - place as i32).rem_euclid(6))
                > 1
        }));
    }

    #[test]
    fn growth_on_one_side_costs_more_than_is_allowed() {
        let curve: Vec<f64> = (0..40).map(|i| f64::from((i - 30_i32).max(0)) / 2.0).collect();
        let below = vec![Shaped::No; 40];
        assert!(
            Row { curve: &curve, below: &below, goal: 5, cooldown: 2, taste: Taste::default() }
                .spread(1.5, 20.0)
                .is_none()
        );
        assert!(row(&curve, &below, 40).is_none(), "no room between them");
    }

    #[test]
    fn sums_are_those_of_the_terms() {
        let curve = [0.5, -1.0, 2.0, 0.25];
        let sums = Sums::new(&curve);
        let plain: f64 = curve[1..3].iter().map(|s| (s - 0.5_f64) * (s - 0.5)).sum();
        assert!((sums.off(1, 3, 0.5) - plain).abs() < 1e-12);
    }
}
