//! How many of the open loops are worked at once: a short row must not cross the end of a batch, or a cusp grows there that
//! never gets one; so the end moves to where the fabric is most advanced, as seen one row ahead where rows lie far apart.

/// Missing height by which the ring's start must lag behind its most advanced place to move the seam there.
const SEAM: f64 = 0.4;
/// Fewest loops of a ring that is divided.
const LEAST: usize = 6;
/// Loops on either side over which missing heights are smoothed.
const REACH: usize = 2;
const NEAR: usize = 2 * REACH + 1;

/// The length of the next batch; `missing` has the missing heights of the open loops, in stitch heights, with what the next row adds.
pub(super) fn length(missing: &[f64]) -> usize {
    let n = missing.len();
    if n < LEAST {
        return n;
    }
    let mean = |near: &[f64]| near.iter().sum::<f64>() / NEAR as f64;
    // The ring goes on around its ends.
    let around = |i: usize| -> [f64; NEAR] { std::array::from_fn(|k| missing[(i + n + k - REACH) % n]) };
    let first = mean(&around(0));
    let (mut least, mut at_least) = (0, first);
    for i in 1..n {
        let here = match missing.get(i.wrapping_sub(REACH)..i + REACH + 1) {
            Some(near) => mean(near),
            None => mean(&around(i)),
        };
        if here < at_least - 1e-9 {
            (least, at_least) = (i, here);
        }
    }
    if first - at_least > SEAM && least > REACH && least + REACH < n { least } else { n }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_moves_to_the_most_advanced_place() {
        let wave = |shift: usize| -> Vec<f64> {
            (0..40).map(|i| crate::math::sin_cos_turns((i + shift) as f64 / 40.0).1).collect()
        };
        assert_eq!(length(&wave(0)), 20, "the start lags most");
        assert_eq!(length(&wave(20)), 40, "the start is the most advanced place");
        assert_eq!(length(&[0.1; 40]), 40);
        assert_eq!(length(&[1.0, 1.0, 0.0, 0.0, 1.0]), 5, "too few to divide");
    }
}
