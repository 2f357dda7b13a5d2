//! What a swept tube is made of, as a reader builds it, and what may be wrong with it.

use super::End;
use super::bezier::Bezier;
use glam::{DVec2, DVec3};
use std::fmt;

/// A tube as a user describes it: a control curve with sections along it. Lengths are mm.
#[derive(Clone, Debug, PartialEq)]
pub struct TubeSpec {
    /// The control curve: segments in order, each with an equal share of the curve parameter in [0, 1].
    pub curve: Vec<Bezier>,
    /// The sections, `at` ascending; one is enough. Before the first and after the last the tube keeps its section.
    pub sections: Vec<Section>,
    /// What lies between the sections.
    pub interpolation: Interpolation,
    /// The end at parameter 0.
    pub start: End,
    /// The end at parameter 1.
    pub end: End,
}

/// A profile at a place of the curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// Curve parameter in [0, 1].
    pub at: f64,
    /// The closed line around the curve there.
    pub profile: Profile,
}

/// A closed line in the local frame of the curve: x and y across, z along the tangent. Seen against the tangent,
/// x points right and y up; for a curve along +z they are the global x and y.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// `offset + (axes[0] cos a, -axes[1] sin a)` with a = 2 pi v: the axes are radii. A circle has equal axes; both may be 0 at a closed end.
    Ellipse {
        /// Radii along x and y.
        axes: [f64; 2],
        /// Center.
        offset: DVec2,
    },
    /// A smooth closed line through at least three points, planar or not, in either direction.
    Loop(Vec<DVec3>),
}

/// How profiles change between sections.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// Every number of the profile is linear in the curve parameter.
    #[default]
    Linear,
    /// Smooth and without ripples: where the sections grow, so does the tube. Sizes are interpolated by their squares,
    /// so that the tube is round, not pointed, where it shrinks to nothing at a closed end: sections of a sphere, with
    /// size 0 at both ends, give a sphere, and those of a cone a cone.
    Smooth,
}

/// Why a description gives no tube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    /// A number is not finite, or beyond 10 km.
    NotFinite,
    /// There is no segment, or no section.
    Empty,
    /// There are more segments, sections or points than `limit`.
    TooMany {
        /// The greatest number allowed.
        limit: usize,
    },
    /// A segment of the curve has no length.
    ZeroLength {
        /// Index of the segment.
        segment: usize,
    },
    /// A segment of the curve does not begin where the one before ends.
    Gap {
        /// Index of the segment.
        segment: usize,
        /// Distance in mm.
        distance: f64,
    },
    /// The place of a section is outside of [0, 1], or not after the one before.
    SectionOrder {
        /// Index of the section.
        section: usize,
    },
    /// A section has a negative size, or no size where the tube is not closed.
    SectionSize {
        /// Index of the section.
        section: usize,
    },
    /// A loop that does not run around once: fewer than three distinct points, a figure eight, a double turn.
    SectionNotEnclosing {
        /// Index of the section.
        section: usize,
    },
    /// The curve has a corner or turns back on the spot.
    Kink {
        /// Curve parameter.
        u: f64,
        /// Angle in degrees.
        degrees: f64,
    },
    /// The curve bends so tightly that neighboring cross-sections meet on its inner side.
    Fold {
        /// Curve parameter of the worst place.
        u: f64,
        /// Curvature times the distance of the surface from the curve toward the inner side, there; must be below 1.
        ratio: f64,
    },
    /// The tube runs through itself.
    SelfIntersect {
        /// Curve parameter of one of the two places.
        u: f64,
        /// Curve parameter of the other place.
        other_u: f64,
    },
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotFinite => write!(f, "a number is not finite or beyond 10 km"),
            Self::Empty => write!(f, "no curve or no section"),
            Self::TooMany { limit } => write!(f, "more than {limit} entries"),
            Self::ZeroLength { segment } => write!(f, "curve segment {} has no length", segment + 1),
            Self::Gap { segment, distance } => {
                write!(
                    f,
                    "curve segment {} begins {distance:.2} mm from the end of the one before",
                    segment + 1
                )
            }
            Self::SectionOrder { section } => write!(f, "section {} is out of order", section + 1),
            Self::SectionSize { section } => write!(f, "section {} has no size", section + 1),
            Self::SectionNotEnclosing { section } => {
                write!(f, "the loop of section {} does not run around once", section + 1)
            }
            Self::Kink { u, degrees } => {
                write!(f, "the curve turns by {degrees:.1} degrees on the spot at {u:.3}")
            }
            Self::Fold { u, ratio } => {
                write!(f, "the curve is too tight at {u:.3}: curvature x radius = {ratio:.2}, must be < 1")
            }
            Self::SelfIntersect { u, other_u } => {
                write!(f, "the tube at {u:.3} runs through itself at {other_u:.3}")
            }
        }
    }
}

impl std::error::Error for Fault {}
