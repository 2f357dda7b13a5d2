//! Control curves: Bézier segments of degree 1 to 3 and chains of them, with exact derivatives and arc length.

use crate::math;
use glam::DVec3;

/// One Bézier segment of degree 1 to 3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bezier {
    points: [DVec3; 4],
    degree: u8,
}

impl Bezier {
    /// A segment by its control points in mm; `None` unless there are two, three or four of them.
    pub fn new(points: &[DVec3]) -> Option<Self> {
        match *points {
            [a, b] => Some(Self::line(a, b)),
            [a, b, c] => Some(Self { points: [a, b, c, c], degree: 2 }),
            [a, b, c, d] => Some(Self { points: [a, b, c, d], degree: 3 }),
            _ => None,
        }
    }

    /// A straight segment.
    pub fn line(start: DVec3, end: DVec3) -> Self {
        Self { points: [start, end, end, end], degree: 1 }
    }

    /// The control points, in mm.
    pub fn points(&self) -> &[DVec3] {
        self.points.split_at(usize::from(self.degree) + 1).0
    }

    /// The degree, 1 to 3.
    pub fn degree(&self) -> u8 {
        self.degree
    }

    /// Position at `t` in mm.
    pub fn point(&self, t: f64) -> DVec3 {
        bernstein3(&self.cubic(), t)
    }

    /// First derivative by `t`.
    pub fn derivative(&self, t: f64) -> DVec3 {
        bernstein2(&self.hodograph(), t)
    }

    /// Second derivative by `t`.
    pub fn second_derivative(&self, t: f64) -> DVec3 {
        let [a, b, c] = self.hodograph();
        2.0 * ((b - a) * (1.0 - t) + (c - b) * t)
    }

    /// Arc length of `t` in [0, 1] in mm, to about 1e-9 of it for curves without cusps.
    pub fn length(&self) -> f64 {
        let hodograph = self.hodograph();
        (0..16)
            .map(|i| {
                integrate(f64::from(i) / 16.0, f64::from(i + 1) / 16.0, |t| {
                    bernstein2(&hodograph, t).length()
                })
            })
            .sum()
    }

    /// The same curve as a cubic: its four control points.
    fn cubic(&self) -> [DVec3; 4] {
        let [a, b, c, d] = self.points;
        match self.degree {
            1 => [a, a.lerp(b, 1.0 / 3.0), a.lerp(b, 2.0 / 3.0), b],
            2 => [a, (a + 2.0 * b) / 3.0, (2.0 * b + c) / 3.0, c],
            _ => [a, b, c, d],
        }
    }

    /// Coefficients of the first derivative in the Bernstein basis of degree 2.
    fn hodograph(&self) -> [DVec3; 3] {
        let [a, b, c, d] = self.points;
        match self.degree {
            1 => [b - a; 3],
            2 => [2.0 * (b - a), c - a, 2.0 * (c - b)],
            _ => [3.0 * (b - a), 3.0 * (c - b), 3.0 * (d - c)],
        }
    }
}

#[inline]
fn bernstein3(c: &[DVec3; 4], t: f64) -> DVec3 {
    let s = 1.0 - t;
    c[0] * (s * s * s) + c[1] * (3.0 * s * s * t) + c[2] * (3.0 * s * t * t) + c[3] * (t * t * t)
}

#[inline]
fn bernstein2(c: &[DVec3; 3], t: f64) -> DVec3 {
    let s = 1.0 - t;
    c[0] * (s * s) + c[1] * (2.0 * s * t) + c[2] * (t * t)
}

/// Five-point Gauss-Legendre quadrature of `f` over [`a`, `b`]: exact for polynomials up to degree 9.
pub fn integrate(a: f64, b: f64, f: impl FnMut(f64) -> f64) -> f64 {
    weigh(a, b, nodes(a, b).map(f))
}

/// Nodes of the quadrature over [0, 1] by their distances from the middle in halves, and their weights.
const NODES: [(f64, f64); 3] = [
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

/// Where [`integrate`] looks at a function.
#[inline]
pub(super) fn nodes(a: f64, b: f64) -> [f64; 5] {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let [_, (inner, _), (outer, _)] = NODES;
    [middle, middle - half * inner, middle + half * inner, middle - half * outer, middle + half * outer]
}

/// The integral from the values at the [`nodes`].
#[inline]
pub(super) fn weigh(a: f64, b: f64, [middle, low, high, lowest, highest]: [f64; 5]) -> f64 {
    let [(_, center), (_, inner), (_, outer)] = NODES;
    0.5 * (b - a) * (center * middle + inner * (low + high) + outer * (lowest + highest))
}

/// A place on a [`Chain`]: position, unit tangent and their rates of change by the chain's parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Position in mm.
    pub point: DVec3,
    /// Unit tangent.
    pub tangent: DVec3,
    /// Length of the first derivative: mm a unit of the parameter.
    pub speed: f64,
    /// Derivative of the unit tangent: curvature times speed, toward the inner side.
    pub turn: DVec3,
}

impl Place {
    /// Curvature in 1/mm; infinite where the curve stands still and turns.
    pub fn curvature(&self) -> f64 {
        let turn = self.turn.length();
        if turn == 0.0 { 0.0 } else { turn / self.speed }
    }
}

/// One segment ready for evaluation. Its derivative is `t^rise (1 - t)^fall` times `direction`, and `direction`
/// does not vanish at the ends, so the tangent is sound where control points coincide.
#[derive(Clone, Copy, Debug)]
struct Piece {
    /// Coefficients of the powers of `t`.
    point: [DVec3; 4],
    /// The same of `direction`.
    direction: [DVec3; 3],
    rise: u8,
    fall: u8,
}

impl Piece {
    /// `None` for a segment without extent.
    fn new(points: &[DVec3; 4]) -> Option<Self> {
        let [p, q, r, s] = *points;
        let [a, b, c] = [3.0 * (q - p), 3.0 * (r - q), 3.0 * (s - r)];
        let scale = a.length().max(b.length()).max(c.length());
        let none = |e: DVec3| e.length() <= 1e-9 * scale;
        if scale.is_nan() || scale <= 0.0 {
            return None;
        }
        let linear = |p: DVec3, q: DVec3| [p, (p + q) * 0.5, q];
        let (direction, rise, fall) = match (none(a), none(b), none(c)) {
            (false, _, false) => ([a, b, c], 0, 0),
            (true, false, true) => ([2.0 * b; 3], 1, 1),
            (true, true, _) => ([c; 3], 2, 0),
            (false, true, true) => ([a; 3], 0, 2),
            (true, false, false) => (linear(2.0 * b, c), 1, 0),
            (false, false, true) => (linear(a, 2.0 * b), 0, 1),
        };
        let point = [p, a, b - a, s - p - 3.0 * (r - q)];
        let [a, b, c] = direction;
        Some(Self { point, direction: [a, 2.0 * (b - a), (a + c) - 2.0 * b], rise, fall })
    }

    #[inline]
    fn at(&self, t: f64) -> DVec3 {
        let [a, b, c, d] = self.point;
        a + (b + (c + d * t) * t) * t
    }

    #[inline]
    fn pace(&self, t: f64) -> f64 {
        if self.rise | self.fall == 0 {
            return 1.0;
        }
        let power = |x: f64, n: u8| match n {
            0 => 1.0,
            1 => x,
            _ => x * x,
        };
        power(t, self.rise) * power(1.0 - t, self.fall)
    }
}

/// Makes a joint smooth that is so but for the rounding of numbers in a file: a gap of up to [`JOINT_GAP`], a corner
/// of up to [`JOINT_DEGREES`]. The handles next to the joint turn to a common direction.
fn heal(before: &mut [DVec3; 4], after: &mut [DVec3; 4]) {
    if before[3].distance(after[0]) <= JOINT_GAP {
        after[0] = before[3];
    }
    let (inner, outer) = (before[3] - before[2], after[1] - after[0]);
    let (Some(a), Some(b)) = (inner.try_normalize(), outer.try_normalize()) else { return };
    if math::atan2(a.cross(b).length(), a.dot(b)).to_degrees() <= JOINT_DEGREES {
        let common = (a + b).normalize();
        before[2] = before[3] - common * inner.length();
        after[1] = after[0] + common * outer.length();
    }
}

/// Largest distance between the ends of two segments that passes for rounding, in mm.
pub const JOINT_GAP: f64 = 0.05;
/// Largest corner between two segments that passes for rounding, in degrees.
pub const JOINT_DEGREES: f64 = 2.0;

/// A chain of segments with one parameter in [0, 1], of which every segment takes an equal share; the parameter
/// of a single segment is the plain Bézier parameter.
#[derive(Clone, Debug)]
pub struct Chain {
    pieces: Vec<Piece>,
    /// Arc length at the ends of equal shares of the parameter, `STEPS` a segment.
    lengths: Vec<f64>,
}

/// Entries of the arc length table a segment.
const STEPS: usize = 32;

impl Chain {
    /// A chain of the given segments; the index of the first segment without extent otherwise (0 if there is
    /// no segment at all). Joints are healed where only rounding spoils them, and not checked otherwise.
    pub fn new(segments: &[Bezier]) -> Result<Self, usize> {
        if segments.is_empty() {
            return Err(0);
        }
        let mut pieces = Vec::with_capacity(segments.len());
        let mut cubics: Vec<[DVec3; 4]> = segments.iter().map(Bezier::cubic).collect();
        for joint in 1..cubics.len() {
            let (before, after) = cubics.split_at_mut(joint);
            if let (Some(before), Some(after)) = (before.last_mut(), after.first_mut()) {
                heal(before, after);
            }
        }
        for (i, points) in cubics.iter().enumerate() {
            pieces.push(Piece::new(points).ok_or(i)?);
        }
        let mut chain = Self { pieces, lengths: Vec::new() };
        let count = segments.len() * STEPS;
        let mut total = 0.0;
        let mut lengths = Vec::with_capacity(count + 1);
        lengths.push(0.0);
        for k in 0..count {
            let at = |i: usize| i as f64 / count as f64;
            total += integrate(at(k), at(k + 1), |u| chain.at(u).speed);
            lengths.push(total);
        }
        chain.lengths = lengths;
        Ok(chain)
    }

    /// Whether the chain runs straight on: all its control points lie in order on one line.
    pub(super) fn is_straight(&self) -> bool {
        // From control point to control point, three times.
        let mut steps = self.pieces.iter().flat_map(|piece| {
            let [_, a, b, c] = piece.point;
            [a, a + b, a + 2.0 * b + 3.0 * c]
        });
        let Some(way) = steps.clone().sum::<DVec3>().try_normalize() else { return false };
        steps.all(|step| step.dot(way) >= 0.0 && step.cross(way).length() <= 1e-12 * self.length())
    }

    /// Number of segments.
    pub fn segments(&self) -> usize {
        self.pieces.len()
    }

    /// The segment that holds parameter `u` and the segment's own parameter there. A joint belongs to the
    /// segment after it.
    #[inline]
    pub fn locate(&self, u: f64) -> (usize, f64) {
        let scaled = u.clamp(0.0, 1.0) * self.pieces.len() as f64;
        let last = self.pieces.len() - 1;
        let (segment, t) = math::split(scaled);
        if segment <= last { (segment, t) } else { (last, scaled - last as f64) }
    }

    /// The place at parameter `u`, which is clamped to [0, 1].
    #[inline]
    pub fn at(&self, u: f64) -> Place {
        let (segment, t) = self.locate(u);
        self.place(segment, t)
    }

    /// The place at parameter `t` of one segment; this way both sides of a joint can be seen.
    #[inline]
    pub fn place(&self, segment: usize, t: f64) -> Place {
        let piece = &self.pieces[segment.min(self.pieces.len() - 1)];
        let count = self.pieces.len() as f64;
        let [a, b, c] = piece.direction;
        let direction = a + (b + c * t) * t;
        let change = b + c * (2.0 * t);
        let size = direction.length();
        let inverse = 1.0 / size;
        let tangent = direction * inverse;
        Place {
            point: piece.at(t),
            tangent,
            speed: size * piece.pace(t) * count,
            turn: (change - tangent * change.dot(tangent)) * (inverse * count),
        }
    }

    /// The point and the unit tangent of [`Chain::place`].
    #[inline]
    pub(super) fn stand(&self, segment: usize, t: f64) -> (DVec3, DVec3) {
        let piece = &self.pieces[segment.min(self.pieces.len() - 1)];
        let [a, b, c] = piece.direction;
        let direction = a + (b + c * t) * t;
        (piece.at(t), direction * (1.0 / direction.length()))
    }

    /// Position at parameter `u` in mm.
    pub fn point(&self, u: f64) -> DVec3 {
        let (segment, t) = self.locate(u);
        self.pieces[segment].at(t)
    }

    /// Arc length of the whole chain in mm.
    pub fn length(&self) -> f64 {
        self.lengths.last().copied().unwrap_or(0.0)
    }

    /// The parameter at a share in [0, 1] of the arc length, to a thousandth or so: for even samples.
    pub(super) fn parameter_of_share(&self, share: f64) -> f64 {
        let count = self.lengths.len() - 1;
        let length = share * self.length();
        let step = self.lengths.partition_point(|&l| l <= length).clamp(1, count) - 1;
        let within = (length - self.lengths[step]) / (self.lengths[step + 1] - self.lengths[step]);
        ((step as f64 + within.clamp(0.0, 1.0)) / count as f64).clamp(0.0, 1.0)
    }

    /// Arc length from the start to parameter `u` in mm.
    pub fn length_to(&self, u: f64) -> f64 {
        let count = self.lengths.len() - 1;
        let scaled = u.clamp(0.0, 1.0) * count as f64;
        let step = (scaled as usize).min(count - 1);
        let from = step as f64 / count as f64;
        self.lengths[step] + integrate(from, scaled / count as f64, |u| self.at(u).speed)
    }

    /// The parameter at arc length `length` in mm: the inverse of [`Chain::length_to`], clamped to [0, 1].
    pub fn parameter_at(&self, length: f64) -> f64 {
        let count = self.lengths.len() - 1;
        let step = self.lengths.partition_point(|&l| l <= length).clamp(1, count) - 1;
        let (mut low, mut high) = (step as f64 / count as f64, (step + 1) as f64 / count as f64);
        let share = (length - self.lengths[step]) / (self.lengths[step + 1] - self.lengths[step]);
        let mut u = low + (high - low) * share.clamp(0.0, 1.0);
        // Newton inside a shrinking bracket, for the speed may vanish at an end.
        for _ in 0..40 {
            let miss = self.length_to(u) - length;
            if miss > 0.0 {
                high = u;
            } else {
                low = u;
            }
            if miss.abs() <= 1e-13 * self.length() {
                break;
            }
            let next = u - miss / self.at(u).speed;
            u = if next > low && next < high { next } else { 0.5 * (low + high) };
        }
        u.clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_runs_on_in_one_direction_is_straight() {
        let at = DVec3::new;
        let straight = |segments: &[Bezier]| Chain::new(segments).expect("sound").is_straight();
        let curve = |points: &[DVec3]| Bezier::new(points).expect("two to four points");
        let (a, b, c) = (at(1.0, 2.0, 3.0), at(3.0, 6.0, 9.0), at(4.0, 8.0, 12.0));
        assert!(straight(&[Bezier::line(a, c)]));
        assert!(straight(&[curve(&[a, b, c])]));
        assert!(straight(&[Bezier::line(a, b), Bezier::line(b, c)]));
        assert!(!straight(&[curve(&[a, c, b])]), "it turns back");
        assert!(!straight(&[curve(&[a, b, at(4.0, 8.0, 12.1)])]));
    }
}
