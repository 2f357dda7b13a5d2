//! The one table of yarn facts: weights, hooks, gauge, thickness and mass.
//!
//! Weights follow the standard of the Craft Yarn Council (10.16 cm are the 4 inches of its gauge column). Figures
//! made from the table are estimates, never measurements.

use std::fmt;

/// Size of a crochet hook.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Hook(u16);

impl Hook {
    /// A hook by its shaft diameter in mm, 0.4 to 60; `None` outside of that.
    pub fn from_mm(mm: f64) -> Option<Self> {
        (0.4..=60.0).contains(&mm).then(|| Self((mm * 100.0).round() as u16))
    }
    /// Shaft diameter in mm.
    pub fn mm(self) -> f64 {
        f64::from(self.0) / 100.0
    }
    /// The hook with this US name: a letter, a number after `US`, or both (`H`, `I-9`, `US 7`, `steel 7`).
    pub fn from_us(name: &str) -> Option<Self> {
        let name = name.trim().to_ascii_uppercase();
        let bare = name.strip_prefix("US").map_or(name.as_str(), str::trim_start);
        let key: String = bare.chars().filter(|c| !matches!(c, ' ' | '-' | '/')).collect();
        let (_, mm) = US_HOOKS.iter().find(|(names, _)| names.contains(&key.as_str()))?;
        Self::from_mm(*mm)
    }
}

impl fmt::Display for Hook {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} mm", self.mm())
    }
}

/// US names of hooks, without spaces and dashes, and their diameters in mm.
static US_HOOKS: &[(&[&str], f64)] = &[
    (&["STEEL8"], 1.4),
    (&["STEEL7"], 1.5),
    (&["STEEL6"], 1.6),
    (&["B", "B1", "1"], 2.25),
    (&["C", "C2", "2"], 2.75),
    (&["D", "D3", "3"], 3.25),
    (&["E", "E4", "4"], 3.5),
    (&["F", "F5", "5"], 3.75),
    (&["G", "G6", "6"], 4.0),
    (&["7"], 4.5),
    (&["H", "H8", "8"], 5.0),
    (&["I", "I9", "9"], 5.5),
    (&["J", "J10", "10"], 6.0),
    (&["K", "K10.5", "10.5", "K10½", "10½"], 6.5),
    (&["L", "L11", "11"], 8.0),
    (&["M", "M13", "MN13", "13"], 9.0),
    (&["N", "N15", "NP15", "15"], 10.0),
    (&["P", "PQ"], 15.0),
    (&["Q"], 16.0),
    (&["S", "S35", "35"], 19.0),
    (&["T", "TUX", "U"], 25.0),
];

/// One weight of the standard.
#[derive(Debug, PartialEq)]
pub struct Yarn {
    /// Number, 0 to 7.
    pub weight: u8,
    /// Names in lower case; the first is the standard's own.
    pub names: &'static [&'static str],
    /// Single crochets in 4 inches, fewest and most; for weight 0 they are double crochets. The fewest go with the
    /// largest usual hook.
    pub stitches: [f64; 2],
    /// Smallest and largest usual hook, in mm.
    pub hooks: [f64; 2],
    /// Wraps an inch, fewest and most; equal where the standard has one bound only, `None` where it has none.
    pub wraps: Option<[f64; 2]>,
    /// Meters a gram, least and most; as `wraps`.
    pub meters_per_gram: Option<[f64; 2]>,
}

/// Every weight. The range of weight 7 goes on to the largest hook sold, with the width a hook of its own first entry.
pub static YARNS: [Yarn; 8] = [
    Yarn {
        weight: 0,
        names: &["lace", "thread", "cobweb", "lace weight"],
        stitches: [32.0, 42.0],
        hooks: [1.4, 2.25],
        wraps: Some([18.0, 18.0]),
        meters_per_gram: Some([4.84, 4.84]),
    },
    Yarn {
        weight: 1,
        names: &["super fine", "sock", "fingering", "superfine"],
        stitches: [21.0, 32.0],
        hooks: [2.25, 3.5],
        wraps: Some([16.0, 18.0]),
        meters_per_gram: Some([3.83, 4.84]),
    },
    Yarn {
        weight: 2,
        names: &["fine", "sport", "baby"],
        stitches: [16.0, 20.0],
        hooks: [3.5, 4.5],
        wraps: Some([14.0, 15.0]),
        meters_per_gram: Some([2.42, 3.83]),
    },
    Yarn {
        weight: 3,
        names: &["light", "dk", "light worsted", "double knitting"],
        stitches: [12.0, 17.0],
        hooks: [4.5, 5.5],
        wraps: Some([12.0, 13.0]),
        meters_per_gram: Some([1.82, 2.42]),
    },
    Yarn {
        weight: 4,
        names: &["medium", "worsted", "aran", "afghan"],
        stitches: [11.0, 14.0],
        hooks: [5.5, 6.5],
        wraps: Some([10.0, 11.0]),
        meters_per_gram: Some([1.21, 1.81]),
    },
    Yarn {
        weight: 5,
        names: &["bulky", "chunky", "craft", "rug"],
        stitches: [8.0, 11.0],
        hooks: [6.5, 9.0],
        wraps: Some([8.0, 9.0]),
        meters_per_gram: Some([0.81, 1.21]),
    },
    Yarn {
        weight: 6,
        names: &["super bulky", "roving", "superbulky"],
        stitches: [6.0, 9.0],
        hooks: [9.0, 16.0],
        wraps: Some([7.0, 7.0]),
        meters_per_gram: Some([0.81, 0.81]),
    },
    Yarn {
        weight: 7,
        names: &["jumbo"],
        stitches: [3.25, 5.0],
        hooks: [16.0, 25.0],
        wraps: None,
        meters_per_gram: None,
    },
];

/// Width of the 4 inches over which the standard counts stitches, in mm.
const FOUR_INCHES: f64 = 101.6;
/// Height of a single crochet in its widths, where nothing was measured: two swatches in worsted gave 0.80 and 0.87.
const HEIGHT_OF_WIDTH: f64 = 0.85;
/// A stitch cannot be narrower than its two legs.
const LEAST_WIDTH_IN_DIAMETERS: f64 = 1.9;
/// What to buy beyond the yarn that the stitches take: tails, tension, a lost round.
pub const SPARE: f64 = 0.10;

/// A stitch size guessed from yarn and hook.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Width of a stitch in mm.
    pub width: f64,
    /// Height of a stitch in mm.
    pub height: f64,
    /// The hook is among the usual ones for this weight.
    pub in_range: bool,
    /// Fraction by which the sizes may be off, either way.
    pub uncertainty: f64,
}

impl Yarn {
    /// The row of a weight number.
    pub fn of_weight(weight: u8) -> Option<&'static Self> {
        YARNS.get(usize::from(weight))
    }
    /// The row of a number or a name, in any case.
    pub fn parse(name: &str) -> Option<&'static Self> {
        let name = name.trim().to_lowercase().replace(['-', '_'], " ");
        match name.parse() {
            Ok(number) => Self::of_weight(number),
            Err(_) => YARNS.iter().find(|yarn| yarn.names.contains(&name.as_str())),
        }
    }
    /// The standard's own name.
    pub fn name(&self) -> &'static str {
        self.names.first().copied().unwrap_or_default()
    }

    /// The stitch size with a hook. Inside the usual hooks the width is linear in the hook; outside it keeps the
    /// ratio of the nearest end, for the slope of a row is far too steep there. Crocheters of toys use small hooks
    /// on purpose, so out of range is normal.
    pub fn estimate(&self, hook: Hook) -> Estimate {
        let [fewest, most] = self.stitches;
        let [small, large] = self.hooks;
        let (narrow, wide) = (FOUR_INCHES / most, FOUR_INCHES / fewest);
        let mm = hook.mm();
        let in_range = (small..=large).contains(&mm);
        let width = if in_range {
            narrow + (wide - narrow) * (mm - small) / (large - small)
        } else if mm < small {
            narrow / small * mm
        } else {
            wide / large * mm
        };
        let least = LEAST_WIDTH_IN_DIAMETERS * self.diameter().unwrap_or_default();
        let width = width.max(least);
        let uncertainty = if in_range { 0.15 } else { 0.20 };
        Estimate { width, height: HEIGHT_OF_WIDTH * width, in_range, uncertainty }
    }

    /// Thickness of the yarn in mm: an inch by its wraps. `None` where the standard has no wraps.
    pub fn diameter(&self) -> Option<f64> {
        self.wraps.map(|[fewest, most]| 25.4 * 2.0 / (fewest + most))
    }

    /// Mass in grams, from and to, of so many millimeters of yarn.
    pub fn mass(&self, length: f64) -> Option<[f64; 2]> {
        self.meters_per_gram.map(|[least, most]| [length / 1000.0 / most, length / 1000.0 / least])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_usual_hooks_give_the_stitches_of_the_standard() {
        let worsted = Yarn::parse("Worsted").expect("known");
        let small = worsted.estimate(Hook::from_mm(5.5).expect("a hook"));
        let large = worsted.estimate(Hook::from_us("K-10.5").expect("a hook"));
        assert!((101.6 / small.width - 14.0).abs() < 1e-9 && small.in_range && small.uncertainty == 0.15);
        assert!((101.6 / large.width - 11.0).abs() < 1e-9);
    }

    #[test]
    fn a_small_hook_keeps_the_ratio_and_never_squeezes_the_yarn() {
        let worsted = Yarn::of_weight(4).expect("known");
        let toy = worsted.estimate(Hook::from_mm(3.5).expect("a hook"));
        assert!((toy.width - 4.62).abs() < 0.01 && !toy.in_range && toy.uncertainty == 0.20, "{toy:?}");
        let tiny = worsted.estimate(Hook::from_mm(1.0).expect("a hook"));
        assert!((tiny.width - 1.9 * 25.4 / 10.5).abs() < 1e-9);
    }

    #[test]
    fn every_row_is_in_order_and_every_name_is_unique() {
        let mut names: Vec<&str> = YARNS.iter().flat_map(|yarn| yarn.names).copied().collect();
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count);
        for (weight, yarn) in YARNS.iter().enumerate() {
            assert_eq!(usize::from(yarn.weight), weight);
            assert!(yarn.stitches[0] < yarn.stitches[1] && yarn.hooks[0] < yarn.hooks[1]);
            for name in yarn.names {
                assert_eq!(Yarn::parse(name), Some(yarn));
            }
        }
    }

    #[test]
    fn hooks_know_their_american_names() {
        for (name, mm) in [("H", 5.0), ("us i-9", 5.5), ("US 7", 4.5), ("K10.5", 6.5), ("M/N-13", 9.0)] {
            assert_eq!(Hook::from_us(name), Hook::from_mm(mm), "{name}");
        }
        assert_eq!(Hook::from_us("Z"), None);
        assert_eq!(Hook::from_mm(f64::NAN), None);
        assert_eq!(Hook::from_mm(2.25).map(|hook| hook.to_string()).as_deref(), Some("2.25 mm"));
    }
}
