//! Shapes as continuous surfaces: the trait that any parametric surface implements, and the object made of them.

pub mod analytic;
pub(crate) mod axis;
pub(crate) mod beads;
pub mod bezier;
pub mod branch;
pub mod drift;
pub mod export;
mod fold;
pub mod frame;
mod leaving;
pub mod loops;
pub mod measure;
mod meridian;
pub mod mesh;
mod mirror;
mod phase;
mod profile;
mod revolve;
pub(crate) mod ring;
mod smooth;
pub(crate) mod solid;
pub mod spec;
mod spline;
pub(crate) mod split;
pub(crate) mod stack;
pub mod sweep;

pub use bezier::Bezier;
pub use drift::{Drift, Twisted, for_maker};
pub use measure::{area, girth, is_revolution, length_along};
pub(crate) use measure::{row_speed, slowest_side};
pub use mirror::Mirrored;
pub(crate) use mirror::Reversed;
pub use ring::Ring;
pub use spec::{Fault, Interpolation, Profile, Section, TubeSpec};
pub use stack::Stack;
pub use sweep::Sweep;

use crate::ir::{Gauge, Hand};
use glam::DVec3;
use std::fmt;

/// A point of a surface with its first derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jet {
    /// Position in mm.
    pub point: DVec3,
    /// Derivative by u.
    pub du: DVec3,
    /// Derivative by v.
    pub dv: DVec3,
}

/// A tube S(u, v): u in [0, 1] runs along it, v in turns runs around it and has period 1.
///
/// Orientation: du x dv points OUTWARD. A right-handed maker, right side out, finds the next stitch to the left when u
/// points up; so v runs to the left seen from outside, which is clockwise for an eye that looks back from the end of the
/// tube to its start. A surface the other way round comes out mirrored.
///
/// (Paper, section 3.1: the target shape may be given in Rust; this trait is that way.)
pub trait ParametricSurface: fmt::Debug + Send + Sync {
    /// Position in mm. Defined a little beyond [0, 1] in u too, for the relaxation looks over the edge.
    fn point(&self, u: f64, v: f64) -> DVec3;

    /// Position and first derivatives; the default takes central differences.
    fn jet(&self, u: f64, v: f64) -> Jet {
        const STEP: f64 = 1e-5;
        let slope = |a: DVec3, b: DVec3| (b - a) / (2.0 * STEP);
        Jet {
            point: self.point(u, v),
            du: slope(self.point(u - STEP, v), self.point(u + STEP, v)),
            dv: slope(self.point(u, v - STEP), self.point(u, v + STEP)),
        }
    }

    /// Positions and derivatives around a whole turn, at equal distances of v from `from` on. A surface that shares work
    /// between them does better than the default, which takes one after the other.
    fn ring(&self, u: f64, from: f64, jets: &mut [Jet]) {
        let count = jets.len() as f64;
        for (k, jet) in jets.iter_mut().enumerate() {
            *jet = self.jet(u, from + k as f64 / count);
        }
    }
}

/// How an end of a tube is treated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum End {
    /// The tube stays open: a chain ring, or a last open round.
    #[default]
    Open,
    /// A pole: magic ring at the start, drawn shut at the end. At a closed end the surface itself shrinks to a point.
    Closed,
}

/// How a tube hangs on the tube that it grows from (paper, sections 3.1 and 3.4: sub-shapes and their merging).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Joint {
    /// A branch that leaves the side of its parent. The loop S(0, v) lies on the surface of the parent, where the two
    /// tubes meet; it need not be planar. The parent is a whole tube, and the branch is worked into its stitches
    /// along that loop (the paper's interlocking).
    Surface,
    /// As `Surface`, but the parent is worked with a slit that opens into the branch: stitches of one of its rounds are
    /// held for the branch, and the parent goes on over chains. The branch begins on the held loops and the
    /// other side of the chains.
    Opening,
    /// The parent ends where its last loop divides among two children, as a pair of trousers does. Both share its last
    /// loop S(1, v): each begins with a loop S(0, v) of its own, which follows the parent's loop for a stretch and
    /// closes along a straight line, the crotch. It is worked into the open loops of its stretch and along chains that
    /// lie across. The end of such a parent is [`End::Open`].
    Split,
}

/// Where a tube grows from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Attachment {
    /// Index of the parent in [`Shape::tubes`]; less than that of the tube itself.
    pub parent: usize,
    /// How the two are joined.
    pub joint: Joint,
}

/// One tube of an object.
#[derive(Debug)]
pub struct Tube {
    /// Name of the part; no other tube of the shape has it.
    pub name: String,
    /// The surface in mm. Of a tube with a parent it is the visible part, which begins at the parent.
    pub surface: Box<dyn ParametricSurface>,
    /// The end at u = 0; [`End::Open`] where the tube has a parent.
    pub start: End,
    /// The end at u = 1.
    pub end: End,
    /// The tube that it grows from; `None` for a tube that stands alone.
    pub attachment: Option<Attachment>,
}

impl Tube {
    /// A tube that stands alone.
    pub fn new(name: impl Into<String>, surface: Box<dyn ParametricSurface>, ends: [End; 2]) -> Self {
        Self { name: name.into(), surface, start: ends[0], end: ends[1], attachment: None }
    }

    /// The same tube, grown from another one of the shape: the `parent`-th.
    #[must_use]
    pub fn on(mut self, parent: usize, joint: Joint) -> Self {
        self.attachment = Some(Attachment { parent, joint });
        self
    }
}

/// An object to make: a tree of tubes and the maker's gauge.
#[derive(Debug)]
pub struct Shape {
    /// Name of the object.
    pub name: String,
    /// Stitch size, in mm.
    pub gauge: Gauge,
    /// The tubes in working order: the trunk first, each behind the one that it grows from.
    pub tubes: Vec<Tube>,
    /// How it shall be made.
    pub wishes: Wishes,
}

/// What a file says about the making; the options of a run come first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wishes {
    /// The hand that holds the hook.
    pub hand: Option<Hand>,
    /// Stitches by which columns drift in each round, positive in working direction.
    pub lean: Option<f64>,
    /// How much pleasant words are worth, from 0 to 1.
    pub readability: Option<f64>,
}
