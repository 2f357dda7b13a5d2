//! Shapes as continuous surfaces: the trait that any parametric surface implements, and the object made of them.

pub mod analytic;
pub mod bezier;
mod fold;
pub mod frame;
pub mod loops;
pub mod measure;
mod meridian;
mod profile;
mod smooth;
pub mod spec;
pub mod sweep;

pub use bezier::Bezier;
pub use measure::{area, girth, is_revolution, length_along};
pub use spec::{Fault, Interpolation, Profile, Section, TubeSpec};
pub use sweep::Sweep;

use crate::ir::Gauge;
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

/// One tube of an object.
#[derive(Debug)]
pub struct Tube {
    /// Name of the part.
    pub name: String,
    /// The surface in mm.
    pub surface: Box<dyn ParametricSurface>,
    /// The end at u = 0.
    pub start: End,
    /// The end at u = 1.
    pub end: End,
}

/// An object to make: its tubes (trunk first) and the maker's gauge.
#[derive(Debug)]
pub struct Shape {
    /// Name of the object.
    pub name: String,
    /// Stitch size, in mm.
    pub gauge: Gauge,
    /// The tubes.
    pub tubes: Vec<Tube>,
}
