//! Whom a pattern is for, as far as stitches depend on it.

use glam::DVec3;
use serde::Deserialize;

/// What a pattern takes for granted about the one who works it. Other makers get another object from the same words.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Maker {
    /// The hand that holds the hook.
    pub hand: Hand,
    /// Stitches by which columns drift in each round, positive in working direction; 0 for stitches that stand straight.
    pub lean: f64,
}

/// Greatest lean of a maker's stitches that is believed, in stitches a round.
pub const MOST_LEAN: f64 = 1.0;

impl Maker {
    /// True where nothing has to be said: right-handed, and stitches that stand straight.
    pub fn is_usual(&self) -> bool {
        *self == Self::default()
    }
}

/// The hand that holds the hook. The same words, worked with the other hand, give the mirror image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Hand {
    /// Rounds run to the left, seen from outside.
    #[default]
    Right,
    /// Rounds run to the right.
    Left,
}

impl Hand {
    /// The hands with their words in files and options.
    pub const WORDS: &'static [(&'static str, Self)] = &[("right", Self::Right), ("left", Self::Left)];

    /// The word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Left => "left",
        }
    }
}

/// A point seen in the mirror of the plane y = 0. Which plane it is does not matter: mirror images differ by a motion.
pub fn mirrored(point: DVec3) -> DVec3 {
    DVec3::new(point.x, -point.y, point.z)
}
