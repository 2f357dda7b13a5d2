//! Surfaces in closed form, with lengths and areas known: oracles for tests, and examples of the trait.
//!
//! All of them run up along +z but for the torus arc, and turn with v as the trait asks.

use super::{Jet, ParametricSurface, measure};
use crate::math::{PI, TAU, atan2, cos, ln, sin, sin_cos, sin_cos_turns};
use glam::DVec3;

/// A point on the unit circle at `v` turns and its derivative by v.
#[inline]
fn around(v: f64) -> (DVec3, DVec3) {
    let (sin, cos) = sin_cos_turns(v);
    (DVec3::new(cos, -sin, 0.0), DVec3::new(-sin, -cos, 0.0) * TAU)
}

/// A surface around the z axis with radius `r` and height `z`, given with their derivatives by u and, for `r`, by v.
#[inline]
fn revolved(v: f64, [r, ru, rv]: [f64; 3], [z, zu]: [f64; 2]) -> Jet {
    let (arm, turn) = around(v);
    Jet { point: arm * r + DVec3::Z * z, du: arm * ru + DVec3::Z * zu, dv: turn * r + arm * rv }
}

macro_rules! by_jet {
    ($($surface:ty),*) => {$(
        impl ParametricSurface for $surface {
            fn point(&self, u: f64, v: f64) -> DVec3 {
                self.form(u, v).point
            }
            fn jet(&self, u: f64, v: f64) -> Jet {
                self.form(u, v)
            }
        }
    )*};
}
by_jet!(Cylinder, Cone, Sphere, SphereZone, Ellipsoid, TorusArc, Fluted, Bulge);

/// A straight cylinder; lengths in mm.
#[derive(Clone, Copy, Debug)]
pub struct Cylinder {
    /// Radius.
    pub radius: f64,
    /// Length.
    pub length: f64,
}

impl Cylinder {
    fn form(self, u: f64, v: f64) -> Jet {
        revolved(v, [self.radius, 0.0, 0.0], [self.length * u, self.length])
    }
    /// Area of the side in mm^2.
    pub fn area(&self) -> f64 {
        TAU * self.radius * self.length
    }
    /// Length of a line along it in mm.
    pub fn slant(&self) -> f64 {
        self.length
    }
}

/// A straight cone or frustum, open or with an apex; lengths in mm.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    /// Radius at u = 0.
    pub start: f64,
    /// Radius at u = 1.
    pub end: f64,
    /// Height.
    pub length: f64,
}

impl Cone {
    fn form(self, u: f64, v: f64) -> Jet {
        let growth = self.end - self.start;
        revolved(v, [self.start + growth * u, growth, 0.0], [self.length * u, self.length])
    }
    /// Length of a line along it in mm.
    pub fn slant(&self) -> f64 {
        (self.length * self.length + (self.end - self.start) * (self.end - self.start)).sqrt()
    }
    /// Area of the side in mm^2.
    pub fn area(&self) -> f64 {
        PI * (self.start + self.end) * self.slant()
    }
}

/// A whole sphere from pole to pole; u is the polar angle in half turns.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    /// Radius in mm.
    pub radius: f64,
}

impl Sphere {
    fn form(self, u: f64, v: f64) -> Jet {
        SphereZone { radius: self.radius, from: 0.0, to: PI }.form(u, v)
    }
    /// Area in mm^2.
    pub fn area(&self) -> f64 {
        2.0 * TAU * self.radius * self.radius
    }
    /// Length of a line from pole to pole in mm.
    pub fn slant(&self) -> f64 {
        PI * self.radius
    }
}

/// A part of a sphere between two circles of latitude.
#[derive(Clone, Copy, Debug)]
pub struct SphereZone {
    /// Radius in mm.
    pub radius: f64,
    /// Angle of the first circle from the lower pole in radians.
    pub from: f64,
    /// Angle of the last circle from the lower pole in radians.
    pub to: f64,
}

impl SphereZone {
    fn form(self, u: f64, v: f64) -> Jet {
        let rate = self.to - self.from;
        let (sin, cos) = sin_cos(self.from + rate * u);
        let (high, wide) = (self.radius * sin, self.radius * cos);
        revolved(v, [high, wide * rate, 0.0], [-wide, high * rate])
    }
    /// Area in mm^2.
    pub fn area(&self) -> f64 {
        TAU * self.radius * self.radius * (cos(self.from) - cos(self.to))
    }
    /// Length of a line along it in mm.
    pub fn slant(&self) -> f64 {
        self.radius * (self.to - self.from)
    }
}

/// An ellipsoid with its poles on the z axis; u is the eccentric angle in half turns.
#[derive(Clone, Copy, Debug)]
pub struct Ellipsoid {
    /// Half axes along x, y and z in mm.
    pub axes: DVec3,
}

impl Ellipsoid {
    fn form(self, u: f64, v: f64) -> Jet {
        let jet = Sphere { radius: 1.0 }.form(u, v);
        Jet { point: jet.point * self.axes, du: jet.du * self.axes, dv: jet.dv * self.axes }
    }
    /// Area in mm^2: in closed form for equal axes along x and y, by quadrature (to about 1e-10) otherwise.
    pub fn area(&self) -> f64 {
        let DVec3 { x: a, y: b, z: c } = self.axes;
        if a != b {
            return measure::area(self, 64, 256);
        }
        let square = (a * a - c * c).abs();
        let size = square.sqrt();
        if size <= 1e-6 * a {
            return 2.0 * TAU * a * a;
        }
        if c > a {
            return TAU * a * (a + c * c / size * atan2(size, a));
        }
        TAU * a * (a + c * c / size * ln((a + size) / c))
    }
}

/// A part of a torus: a tube bent along a circle in the plane of x and z. It starts at the origin, goes up along
/// +z and bends toward +x.
#[derive(Clone, Copy, Debug)]
pub struct TorusArc {
    /// Radius of the circle that the middle of the tube follows, in mm.
    pub major: f64,
    /// Radius of the tube in mm.
    pub minor: f64,
    /// Angle of the bend in radians.
    pub angle: f64,
}

impl TorusArc {
    fn form(self, u: f64, v: f64) -> Jet {
        let (arm, turn) = around(v);
        let (sin, cos) = sin_cos(self.angle * u);
        let (across, along) = (DVec3::new(cos, 0.0, -sin), DVec3::new(sin, 0.0, cos));
        let globe = |q: DVec3| across * q.x + DVec3::Y * q.y;
        let center = DVec3::new(self.major * (1.0 - cos), 0.0, self.major * sin);
        Jet {
            point: center + globe(arm) * self.minor,
            du: along * (self.angle * (self.major - self.minor * arm.x)),
            dv: globe(turn) * self.minor,
        }
    }
    /// Area in mm^2.
    pub fn area(&self) -> f64 {
        TAU * self.minor * self.major * self.angle
    }
    /// Length of the line at `v` in mm.
    pub fn slant(&self, v: f64) -> f64 {
        self.angle * (self.major - self.minor * cos(TAU * v))
    }
}

/// A slender tube with shallow flutes that wander around it: radius
/// `1.6 (1 + 0.10 sin(2 pi v + 4 u) sin(5 u) + 0.06 cos(6 u))` and length 12.2, times `scale`.
#[derive(Clone, Copy, Debug)]
pub struct Fluted {
    /// Millimeters a unit; 10 for the size of the paper's figures.
    pub scale: f64,
}

impl Fluted {
    fn form(self, u: f64, v: f64) -> Jet {
        let phase = TAU * v + 4.0 * u;
        let (flute, envelope) = (sin_cos(phase), sin_cos(5.0 * u));
        let size = 1.6 * self.scale;
        let radius = 1.0 + 0.10 * flute.0 * envelope.0 + 0.06 * cos(6.0 * u);
        let along = 0.10 * (4.0 * flute.1 * envelope.0 + 5.0 * flute.0 * envelope.1) - 0.36 * sin(6.0 * u);
        let about = 0.10 * TAU * flute.1 * envelope.0;
        let length = 12.2 * self.scale;
        revolved(v, [size * radius, size * along, size * about], [length * u, length])
    }
}

/// A belly with one steep and one gentle side: radius `0.6 + b (0.9 + 0.8 (0.5 + 0.5 cos(2 pi v))^2)` with
/// b = sin^2(pi u), length 7.5, times `scale`.
#[derive(Clone, Copy, Debug)]
pub struct Bulge {
    /// Millimeters a unit; 10 for the size of the paper's figures.
    pub scale: f64,
}

impl Bulge {
    fn form(self, u: f64, v: f64) -> Jet {
        let (rise, rate) = (sin(PI * u), PI * sin(TAU * u));
        let (sin, cos) = sin_cos(TAU * v);
        let side = 0.5 + 0.5 * cos;
        let belly = 0.9 + 0.8 * side * side;
        let radius = 0.6 + rise * rise * belly;
        let about = -rise * rise * 0.8 * side * sin * TAU;
        let (size, length) = (self.scale, 7.5 * self.scale);
        revolved(v, [size * radius, size * rate * belly, size * about], [length * u, length])
    }
}
