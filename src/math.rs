//! The only sine, cosine and their kin, thin names over `libm`, so that every platform gives the same bits; and small sums.

/// Full turn in radians.
pub const TAU: f64 = core::f64::consts::TAU;
/// Half turn in radians.
pub const PI: f64 = core::f64::consts::PI;

/// Sine and cosine of an angle in radians.
#[inline]
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}
/// Sine of an angle in radians.
#[inline]
pub fn sin(x: f64) -> f64 {
    libm::sin(x)
}
/// Cosine of an angle in radians.
#[inline]
pub fn cos(x: f64) -> f64 {
    libm::cos(x)
}
/// Angle in radians whose cosine is `x`; `x` is clamped to [-1, 1] first.
#[inline]
pub fn acos(x: f64) -> f64 {
    libm::acos(x.clamp(-1.0, 1.0))
}
/// Angle in radians of the point (`x`, `y`), in (-pi, pi].
#[inline]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}
/// e to the power of `x`.
#[inline]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}
/// `x` to the power of `y`.
#[inline]
pub fn pow(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}
/// Natural logarithm of `x`.
#[inline]
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}
/// Sine and cosine of an angle in turns: exact at quarter turns, otherwise to about one unit in the last place,
/// and several times as fast as by way of radians.
#[inline]
pub fn sin_cos_turns(turns: f64) -> (f64, f64) {
    // Adding and subtracting 1.5 * 2^52 rounds to the nearest integer.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    // Coefficients of the usual minimax polynomials on an eighth of a turn to both sides.
    const SIN: [f64; 6] = [
        -1.666_666_666_666_663_2e-1,
        8.333_333_333_322_49e-3,
        -1.984_126_982_985_795e-4,
        2.755_731_370_707_006_8e-6,
        -2.505_076_025_340_686_3e-8,
        1.589_690_995_211_55e-10,
    ];
    const COS: [f64; 6] = [
        4.166_666_666_666_66e-2,
        -1.388_888_888_887_411e-3,
        2.480_158_728_947_673e-5,
        -2.755_731_435_139_066_3e-7,
        2.087_572_321_298_175e-9,
        -1.135_964_755_778_819_5e-11,
    ];
    let turns = if turns.abs() < 1e9 { turns } else { turns - turns.floor() };
    let quarters = turns * 4.0 + ROUND - ROUND;
    let x = (turns - quarters * 0.25) * TAU;
    let z = x * x;
    let power = |c: &[f64; 6]| c[0] + z * (c[1] + z * (c[2] + z * (c[3] + z * (c[4] + z * c[5]))));
    let sin = x + x * z * power(&SIN);
    let cos = 1.0 - (0.5 * z - z * z * power(&COS));
    match quarters as i64 & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// The whole part of a number and what is left; of one below zero, or none at all, zero and all of it. Numbers are below 2^31.
#[inline]
pub(crate) fn split(x: f64) -> (usize, f64) {
    // Through 32 bits, for which every machine has an instruction either way.
    let whole = (x as i32).max(0);
    (whole as usize, x - f64::from(whole))
}

/// The nearest whole number, of two the even one; for numbers below 2^51.
#[inline]
pub(crate) fn nearest(x: f64) -> f64 {
    // Adding and subtracting 1.5 * 2^52 rounds.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    x + ROUND - ROUND
}

/// What is left of a number above the whole one below it: from 0 to 1, which a hair below a whole number rounds up to.
#[inline]
pub(crate) fn fraction(x: f64) -> f64 {
    let rest = x - nearest(x);
    if rest < 0.0 { rest + 1.0 } else { rest }
}

/// The stretch of a ring of numbers with the greatest sum: its first index, and how many there are; none where no number
/// is positive.
pub(crate) fn stretch(values: &[f64]) -> (usize, usize) {
    let best_of = |sign: f64| {
        let (mut best, mut sum, mut first) = ((0.0, 0, 0), 0.0, 0);
        for (i, value) in values.iter().enumerate() {
            if sum <= 0.0 {
                (sum, first) = (0.0, i);
            }
            sum += sign * value;
            if sum > best.0 {
                best = (sum, first, i + 1 - first);
            }
        }
        best
    };
    // What lies across the beginning is all but a stretch with the least sum.
    let (most, least) = (best_of(1.0), best_of(-1.0));
    let total: f64 = values.iter().sum();
    let count = values.len();
    if total + least.0 > most.0 + 1e-9 && least.2 < count {
        ((least.1 + least.2) % count, count - least.2)
    } else {
        (most.1, most.2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_agree_with_radians() {
        for k in -4000..4000 {
            let turns = f64::from(k) * 0.000_731;
            let (sin, cos) = sin_cos_turns(turns);
            let exact = sin_cos(turns * TAU);
            assert!((sin - exact.0).abs() < 3e-15 && (cos - exact.1).abs() < 3e-15, "{turns}");
            assert!((sin * sin + cos * cos - 1.0).abs() < 1e-15);
        }
        let quarters = [0.0, 0.25, 0.5, 0.75, 1.0, -0.25].map(sin_cos_turns);
        assert_eq!(quarters, [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)]);
        assert!(sin_cos_turns(f64::NAN).0.is_nan());
    }

    #[test]
    fn numbers_are_taken_apart() {
        for k in -4000..4000 {
            let x = f64::from(k) * 0.37;
            assert!((fraction(x) - (x - x.floor())).abs() < 1e-12, "{x}");
            assert!((nearest(x) - x).abs() <= 0.5);
            let (whole, rest) = split(x);
            assert_eq!(whole, x.floor().max(0.0) as usize);
            assert_eq!(whole as f64 + rest, x);
        }
        assert_eq!(split(f64::NAN).0, 0);
        assert_eq!([fraction(-1e-20), fraction(3.0), fraction(-3.0)], [1.0, 0.0, 0.0]);
    }

    #[test]
    fn the_best_stretch_may_lie_across_the_beginning() {
        assert_eq!(stretch(&[1.0, 2.0, -5.0, 3.0]), (3, 3));
        assert_eq!(stretch(&[-1.0, 2.0, 1.0, -4.0, 1.0]), (1, 2));
        assert_eq!(stretch(&[-1.0, -2.0]).1, 0);
        assert_eq!(stretch(&[1.0, 1.0]).1, 2);
    }
}
