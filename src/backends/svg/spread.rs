//! Places along a line that keep their distance: the least-squares answer, by pooling neighbors.

/// Places nearest to `wished` (by squares) of which each lies at least its `gap` behind the one before, and the first
/// not before `least`. Linear time.
pub(super) fn spread(wished: &[f64], gap: impl Fn(usize) -> f64, least: f64) -> Vec<f64> {
    // Without the gaps the places need only be in order: isotonic regression.
    let mut offset = 0.0;
    let mut pools: Vec<(f64, f64)> = Vec::with_capacity(wished.len());
    let mut offsets = Vec::with_capacity(wished.len());
    for (index, place) in wished.iter().enumerate() {
        if index > 0 {
            offset += gap(index);
        }
        offsets.push(offset);
        let mut pool = (place - offset, 1.0);
        while let Some((mean, weight)) = pools.pop_if(|(mean, _)| *mean > pool.0) {
            let sum = weight + pool.1;
            pool = ((mean * weight + pool.0 * pool.1) / sum, sum);
        }
        pools.push(pool);
    }
    let means = pools.into_iter().flat_map(|(mean, weight)| std::iter::repeat_n(mean, weight as usize));
    means.zip(offsets).map(|(mean, offset)| mean.max(least) + offset).collect()
}

#[cfg(test)]
mod tests {
    use super::spread;

    #[test]
    fn crowds_spread_evenly_around_their_middle() {
        let far = f64::NEG_INFINITY;
        assert_eq!(spread(&[0.0, 0.0, 0.0], |_| 1.0, far), [-1.0, 0.0, 1.0]);
        assert_eq!(spread(&[0.0, 5.0, 5.0], |_| 1.0, far), [0.0, 4.5, 5.5]);
        assert_eq!(spread(&[0.0, 3.0], |_| 1.0, 2.0), [2.0, 3.0]);
        assert!(spread(&[], |_| 1.0, far).is_empty());
    }
}
