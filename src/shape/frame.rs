//! Rotation-minimizing frames along a chain by double reflection (Wang, Jüttler, Zheng and Liu 2008).

use super::bezier::{Chain, JOINT_DEGREES, Place};
use crate::math;
use glam::DVec3;

/// Frames of a chain: a table of stations made by double reflection, with cubics between them.
#[derive(Clone, Debug)]
pub struct Frames {
    /// For every step between stations the axis as a cubic, lowest power first.
    steps: Vec<[DVec3; 4]>,
    per_segment: usize,
}

#[derive(Clone, Copy, Debug)]
struct Station {
    point: DVec3,
    tangent: DVec3,
    axis: DVec3,
}

/// Where a chain has no sound frame: the tangent jumps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// Parameter of the chain.
    pub u: f64,
    /// Angle of the jump in degrees.
    pub degrees: f64,
}

/// Largest turn between two stations in radians; more stations are taken where there is more.
const STEP_TURN: f64 = 0.025;
const MOST_STATIONS: usize = 1 << 16;

impl Frames {
    /// The frames of a chain. The first axis is the coordinate axis that is most across the tangent, made orthogonal.
    pub fn new(chain: &Chain) -> Result<Self, Jump> {
        let segments = chain.segments();
        for joint in 1..segments {
            let (before, after) = (chain.place(joint - 1, 1.0), chain.place(joint, 0.0));
            let degrees = angle(before.tangent, after.tangent).to_degrees();
            if degrees.is_nan() || degrees > JOINT_DEGREES {
                return Err(Jump { u: joint as f64 / segments as f64, degrees });
            }
        }
        let mut per_segment = (256 / segments).clamp(8, 128);
        loop {
            let most = (MOST_STATIONS / segments).clamp(8, 8192);
            let (turn, u) = largest_turn(chain, per_segment);
            if turn.is_nan() || (turn > STEP_TURN && per_segment >= most && turn > 0.5) {
                return Err(Jump { u, degrees: turn.to_degrees() });
            }
            if turn <= STEP_TURN || per_segment >= most {
                break;
            }
            per_segment *= 2;
        }
        let mut steps = Vec::with_capacity(segments * per_segment);
        let first = chain.place(0, 0.0);
        let mut last = Station { point: first.point, tangent: first.tangent, axis: across(first.tangent) };
        // Of one step: the derivative of the chain's parameter.
        let share = 1.0 / (segments * per_segment) as f64;
        for segment in 0..segments {
            let mut place = chain.place(segment, 0.0);
            last = last.at(&place);
            for k in 1..=per_segment {
                let slope = |station: &Station, place: &Place| {
                    place.tangent * (-share * place.turn.dot(station.axis))
                };
                let (a, da) = (last.axis, slope(&last, &place));
                place = chain.place(segment, k as f64 / per_segment as f64);
                last = last.at(&place);
                let (rise, db) = (last.axis - a, slope(&last, &place));
                steps.push([a, da, 3.0 * rise - 2.0 * da - db, da + db - 2.0 * rise]);
            }
        }
        Ok(Self { steps, per_segment })
    }

    /// The axis of the frame at parameter `t` of a segment, where the chain is at `place`: a unit vector across
    /// the tangent. The third axis is tangent x axis. The frame turns about the tangent nowhere, so the
    /// derivative of any vector q fixed in its cross plane is -(turn . q) tangent.
    #[inline]
    pub fn axis(&self, segment: usize, t: f64, place: &Place) -> DVec3 {
        self.across(segment, t, place.tangent)
    }

    /// The same from the tangent alone.
    #[inline]
    pub(super) fn across(&self, segment: usize, t: f64, tangent: DVec3) -> DVec3 {
        let scaled = t * f64::from(self.per_segment as u32);
        let (step, x) = math::split(scaled);
        let last = self.per_segment - 1;
        let (step, x) = if step <= last { (step, x) } else { (last, scaled - last as f64) };
        let [a, b, c, d] = self.steps[(segment * self.per_segment + step).min(self.steps.len() - 1)];
        let axis = a + (b + (c + d * x) * x) * x;
        let axis = axis - tangent * axis.dot(tangent);
        let square = axis.length_squared();
        // So close to one that a step of Newton gives the root.
        let scale = if (square - 1.0).abs() < 1e-7 { 1.5 - 0.5 * square } else { 1.0 / square.sqrt() };
        axis * scale
    }

    /// The axis at parameter `u` of the chain these frames were made for.
    pub fn at(&self, chain: &Chain, u: f64) -> DVec3 {
        let (segment, t) = chain.locate(u);
        self.axis(segment, t, &chain.place(segment, t))
    }
}

impl Station {
    /// The station at another place.
    fn at(&self, place: &Place) -> Self {
        Self { point: place.point, tangent: place.tangent, axis: self.carry(place) }
    }

    /// The axis carried to another place by two reflections: the first in the plane halfway between the points,
    /// the second such that the tangents match.
    fn carry(&self, to: &Place) -> DVec3 {
        let chord = to.point - self.point;
        let square = chord.length_squared();
        let flat = |axis: DVec3, tangent: DVec3| {
            // No distance to reflect over: turn the axis by the least rotation that takes one tangent to the other.
            axis - (tangent + to.tangent) * (to.tangent.dot(axis) / (1.0 + tangent.dot(to.tangent)))
        };
        let axis = if square <= 1e-20 * (1.0 + self.point.length_squared()) {
            flat(self.axis, self.tangent)
        } else {
            let scale = 2.0 / square;
            let axis = self.axis - chord * (scale * chord.dot(self.axis));
            let tangent = self.tangent - chord * (scale * chord.dot(self.tangent));
            let mirror = to.tangent - tangent;
            let square = mirror.length_squared();
            if square < 1e-18 { axis } else { axis - mirror * (2.0 / square * mirror.dot(axis)) }
        };
        let axis = axis - to.tangent * axis.dot(to.tangent);
        axis * (1.0 / axis.length())
    }
}

/// Angle between two unit vectors in radians, exact for small angles too.
fn angle(a: DVec3, b: DVec3) -> f64 {
    math::atan2(a.cross(b).length(), a.dot(b))
}

/// Largest angle between the tangents of neighboring stations, with the parameter where it is.
fn largest_turn(chain: &Chain, per_segment: usize) -> (f64, f64) {
    let segments = chain.segments();
    let (mut most, mut at, mut widest) = (0.0, 0.0, 0.0);
    for segment in 0..segments {
        let (_, mut last) = chain.stand(segment, 0.0);
        for k in 1..=per_segment {
            let t = k as f64 / per_segment as f64;
            let (_, tangent) = chain.stand(segment, t);
            // Of unit vectors, those that are farther apart have the larger angle.
            let apart = last.distance_squared(tangent);
            if apart.is_nan() {
                return (f64::NAN, (segment as f64 + t) / segments as f64);
            }
            if apart > widest {
                (most, widest) = (angle(last, tangent), apart);
                at = (segment as f64 + t - 0.5 / per_segment as f64) / segments as f64;
            }
            last = tangent;
        }
    }
    (most, at)
}

/// The coordinate axis with the smallest component of the unit vector `tangent`, made orthogonal to it.
fn across(tangent: DVec3) -> DVec3 {
    let size = tangent.abs();
    let axis = if size.x <= size.y && size.x <= size.z {
        DVec3::X
    } else if size.y <= size.z {
        DVec3::Y
    } else {
        DVec3::Z
    };
    (axis - tangent * tangent.dot(axis)).normalize()
}
