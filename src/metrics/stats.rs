//! Summary numbers of a sample.

use serde::Serialize;

/// What is told of a sample of signed fractions. A mean alone hides scatter, so it never stands alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Stats {
    /// Mean of the signed values.
    pub mean: f64,
    /// Population standard deviation of the signed values.
    pub sd: f64,
    /// Mean of the absolute values.
    pub mean_abs: f64,
    /// Root of the mean square.
    pub rms: f64,
    /// 95th percentile of the absolute values: the one at index floor(0.95 n) in order.
    pub p95: f64,
    /// Largest absolute value.
    pub max: f64,
    /// Size of the sample.
    pub count: usize,
}

impl Stats {
    /// Summarizes a sample, which it reorders; all zero for an empty one.
    pub fn of(sample: &mut [f64]) -> Self {
        let count = sample.len();
        if count == 0 {
            return Self::default();
        }
        let n = count as f64;
        let mean = sample.iter().sum::<f64>() / n;
        let square = sample.iter().map(|x| x * x).sum::<f64>() / n;
        let variance = sample.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n;
        for x in sample.iter_mut() {
            *x = x.abs();
        }
        let mean_abs = sample.iter().sum::<f64>() / n;
        let max = sample.iter().copied().fold(0.0, f64::max);
        let index = ((0.95 * n) as usize).min(count - 1);
        let (_, p95, _) = sample.select_nth_unstable_by(index, f64::total_cmp);
        Self { mean, sd: variance.sqrt(), mean_abs, rms: square.sqrt(), p95: *p95, max, count }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_forms() {
        let stats = Stats::of(&mut [-1.0, 1.0, 3.0]);
        assert_eq!((stats.mean, stats.count, stats.max, stats.p95), (1.0, 3, 3.0, 3.0));
        assert!((stats.sd - (8.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert!((stats.rms - (11.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert!((stats.mean_abs - 5.0 / 3.0).abs() < 1e-15);
        assert_eq!(Stats::of(&mut []), Stats::default());
        let mut hundred: Vec<f64> = (0..100).rev().map(f64::from).collect();
        assert_eq!(Stats::of(&mut hundred).p95, 95.0);
    }
}
