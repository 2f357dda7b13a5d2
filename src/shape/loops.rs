//! Closed loops of points: made smooth, spread evenly by arc length, turned to each other, and stacked.

use super::phase::Samples;
use super::spec::{Fault, Profile, Section};
use super::spline::Spline;
use super::{Jet, smooth};
use crate::math::{TAU, sin_cos};
use glam::{DVec2, DVec3};

/// Points a loop may have.
const MOST_POINTS: usize = 1 << 20;

/// A smooth closed line with period 1, given by its values and derivatives at evenly spread parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedLine {
    /// Value and derivative by the step from knot to knot.
    knots: Vec<[DVec3; 2]>,
}

impl ClosedLine {
    /// The smooth closed line through points (a periodic cubic spline over the chords), with `count` knots evenly
    /// spread by arc length. `None` for fewer than three distinct points, or numbers that are not finite.
    pub fn through(points: &[DVec3], count: usize) -> Option<Self> {
        if points.len() > MOST_POINTS || count < 3 {
            return None;
        }
        let center = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
        let extent = points.iter().map(|p| p.distance(center)).fold(0.0, f64::max);
        let mut distinct: Vec<DVec3> = Vec::with_capacity(points.len());
        for &point in points {
            if distinct.last().is_none_or(|last| last.distance(point) > 1e-9 * extent) {
                distinct.push(point);
            }
        }
        while distinct.len() > 1 && distinct[0].distance(distinct[distinct.len() - 1]) <= 1e-9 * extent {
            distinct.pop();
        }
        if distinct.len() < 3 || !extent.is_finite() {
            return None;
        }
        let spline = Spline::new(&distinct);
        let total = *spline.lengths.last()?;
        let step = total / count as f64;
        let mut knots = Vec::with_capacity(count);
        let mut piece = 0;
        for k in 0..count {
            let target = step * k as f64;
            while piece + 2 < spline.lengths.len() && spline.lengths[piece + 1] <= target {
                piece += 1;
            }
            let (point, direction) = spline.at_length(piece, target);
            knots.push([point, direction * step]);
        }
        knots.iter().all(|[a, b]| a.is_finite() && b.is_finite()).then_some(Self { knots })
    }

    /// The line through even samples, with derivatives of fourth order from them.
    fn from_samples(samples: &[DVec3]) -> Self {
        let count = samples.len();
        let mut around = Vec::with_capacity(count + 4);
        around.extend_from_slice(&samples[count - 2..]);
        around.extend_from_slice(samples);
        around.extend_from_slice(&samples[..2]);
        let knot = |five: &[DVec3]| [five[2], (8.0 * (five[3] - five[1]) - (five[4] - five[0])) / 12.0];
        Self { knots: around.windows(5).map(knot).collect() }
    }

    fn constant(value: DVec3, count: usize) -> Self {
        Self { knots: vec![[value, DVec3::ZERO]; count] }
    }

    /// Point and derivative by v.
    #[inline]
    pub fn eval(&self, v: f64) -> (DVec3, DVec3) {
        self.eval_at(Knot::at(v, self.knots.len()))
    }

    #[inline]
    fn eval_at(&self, knot: Knot) -> (DVec3, DVec3) {
        let [a, da] = self.knots[knot.index];
        let [b, db] = self.knots[knot.next];
        let rise = b - a;
        let [value, slope] = [knot.value, knot.slope];
        (
            a + (rise * value[0] + da * value[1] + db * value[2]),
            (rise * slope[0] + da * slope[1] + db * slope[2]) * self.knots.len() as f64,
        )
    }

    /// The point alone.
    #[inline]
    pub(super) fn point(&self, v: f64) -> DVec3 {
        self.point_at(Knot::at(v, self.knots.len()))
    }

    #[inline]
    fn point_at(&self, knot: Knot) -> DVec3 {
        let [a, da] = self.knots[knot.index];
        let [b, db] = self.knots[knot.next];
        a + ((b - a) * knot.value[0] + da * knot.value[1] + db * knot.value[2])
    }

    /// Mean of the points.
    pub fn center(&self) -> DVec3 {
        self.knots.iter().map(|knot| knot[0]).sum::<DVec3>() / self.knots.len() as f64
    }

    /// How often the line turns around as seen along z: 1 counterclockwise, -1 clockwise, anything else for a
    /// line that crosses itself.
    pub fn turns(&self) -> i32 {
        // As often as the slope turns past the direction of x.
        let mut slopes =
            self.knots.iter().zip(self.knots.iter().cycle().skip(1)).filter_map(|(knot, next)| {
                let slope = (next[0] - knot[0]).truncate();
                (slope.length_squared() > 0.0).then_some(slope)
            });
        let Some(first) = slopes.next() else { return 0 };
        let (turns, last) = slopes.fold((0, first), |(turns, last), next| (turns + passed(last, next), next));
        turns + passed(last, first)
    }

    /// Area enclosed as seen along z, positive counterclockwise.
    fn area(&self) -> f64 {
        let center = self.center();
        let arms = || self.knots.iter().map(|knot| (knot[0] - center).truncate());
        arms().zip(arms().cycle().skip(1)).map(|(arm, next)| 0.5 * arm.perp_dot(next)).sum()
    }

    fn reverse(&mut self) {
        self.knots.reverse();
        for knot in &mut self.knots {
            knot[1] = -knot[1];
        }
    }

    /// The same line begun `phase` later.
    #[must_use]
    pub fn shifted(&self, phase: f64) -> Self {
        let count = self.knots.len();
        let knots = (0..count)
            .map(|i| {
                let (point, slope) = self.eval(i as f64 / count as f64 + phase);
                [point, slope / count as f64]
            })
            .collect();
        Self { knots }
    }

    /// The phase that turns this line least against `other`, both seen from their centers.
    pub fn phase_against(&self, other: &Self) -> f64 {
        Samples::of(self).phase_against(&Samples::of(other))
    }
}

/// Whether the least turn from one slope to the next passes the direction of x: 1 counterclockwise, -1 clockwise, 0 if not.
fn passed(slope: DVec2, next: DVec2) -> i32 {
    if (slope.y < 0.0) == (next.y < 0.0) {
        return 0;
    }
    let cross = slope.perp_dot(next);
    // Along one line it is the sides that tell, and what turns back turns counterclockwise.
    let left =
        if cross == 0.0 { slope.dot(next) < 0.0 || (slope.x > 0.0) == (slope.y < 0.0) } else { cross > 0.0 };
    match (slope.y < 0.0, left) {
        (true, true) => 1,
        (false, false) => -1,
        _ => 0,
    }
}

/// A place between two knots of a line, and the weights of the rise between them and of their slopes.
#[derive(Clone, Copy)]
struct Knot {
    index: usize,
    next: usize,
    /// In the way from the first knot.
    value: [f64; 3],
    /// In the derivative by the step from knot to knot.
    slope: [f64; 3],
}

impl Knot {
    #[inline]
    fn at(v: f64, count: usize) -> Self {
        // Truncation is cheaper than floor; v beyond the integers has no fraction to lose.
        let fraction = v - (v as i64) as f64;
        let scaled = (if fraction < 0.0 { fraction + 1.0 } else { fraction }) * count as f64;
        let index = (scaled as usize).min(count - 1);
        let t = scaled - index as f64;
        let (t2, t3) = (t * t, t * t * t);
        Self {
            index,
            next: if index + 1 == count { 0 } else { index + 1 },
            value: [3.0 * t2 - 2.0 * t3, t - 2.0 * t2 + t3, t3 - t2],
            slope: [6.0 * (t - t2), 1.0 - 4.0 * t + 3.0 * t2, 3.0 * t2 - 2.0 * t],
        }
    }
}

/// A stack of loops along a curve.
#[derive(Clone, Debug)]
pub(super) struct LoopStack {
    places: Vec<f64>,
    lines: Vec<ClosedLine>,
    smooth: Option<Smooth>,
}

/// For smooth stacks a loop is `center + size line`; the lines have size 1.
#[derive(Clone, Debug)]
struct Smooth {
    /// How the lines change at each section, a unit of the curve parameter.
    slopes: Vec<ClosedLine>,
    /// Cubics of the center's three coordinates and of the squared size, in every span.
    numbers: Vec<[smooth::Cubic; 4]>,
}

impl LoopStack {
    /// Whether each loop lies in a plane across the curve.
    pub(super) fn flat(&self) -> bool {
        self.lines.iter().flat_map(|line| &line.knots).all(|[point, slope]| point.z == 0.0 && slope.z == 0.0)
    }

    /// A stack of sections; `points` says which of them are points.
    pub(super) fn new(sections: &[Section], points: &[bool], smooth: bool) -> Result<Self, Fault> {
        let points_of = |it: &Section| match &it.profile {
            Profile::Loop(points) => points.len(),
            Profile::Ellipse { .. } => 0,
        };
        let most = sections.iter().map(points_of).max().unwrap_or_default();
        // A few knots to each point that is given.
        let count = if sections.len() > 64 { 64 } else { (4 * most.min(64)).clamp(96, 256) };
        let mut lines: Vec<ClosedLine> = Vec::with_capacity(sections.len());
        let mut last: Option<Samples> = None;
        for (section, it) in sections.iter().enumerate() {
            if let (true, Profile::Ellipse { offset, .. }) = (points[section], &it.profile) {
                lines.push(ClosedLine::constant(offset.extend(0.0), count));
                continue;
            }
            let fault = Fault::SectionNotEnclosing { section };
            let line = match &it.profile {
                Profile::Loop(points) if points.len() > MOST_POINTS => {
                    return Err(Fault::TooMany { limit: MOST_POINTS });
                }
                Profile::Loop(points) => ClosedLine::through(points, count),
                Profile::Ellipse { axes, offset } => {
                    let around = |k: u32| {
                        let (sin, cos) = sin_cos(-TAU * f64::from(k) / 256.0);
                        (*offset + DVec2::new(axes[0] * cos, axes[1] * sin)).extend(0.0)
                    };
                    ClosedLine::through(&(0..256).map(around).collect::<Vec<_>>(), count)
                }
            };
            let mut line = line.ok_or(fault)?;
            let area = line.area();
            if area > 0.0 {
                line.reverse();
            }
            let girth: f64 = line.knots.iter().map(|knot| knot[1].length()).sum();
            if line.turns() != -1 || area.abs() < 1e-6 * girth * girth {
                return Err(fault);
            }
            let mut samples = Samples::of(&line);
            let phase = match &last {
                Some(last) => samples.phase_against(last),
                None => phase_of_x(&line),
            };
            if phase != 0.0 {
                line = line.shifted(phase);
                samples = Samples::of(&line);
            }
            last = Some(samples);
            lines.push(line);
        }
        let places: Vec<f64> = sections.iter().map(|it| it.at).collect();
        let smooth = smooth.then(|| Smooth::new(&places, &mut lines, points));
        Ok(Self { places, lines, smooth })
    }

    /// The line at a place along the curve.
    #[inline]
    pub(super) fn at(&self, w: f64) -> Cut<'_> {
        let after = self.places.partition_point(|&at| at <= w);
        let before = after.max(1) - 1;
        let after = after.min(self.places.len() - 1);
        let between = (before != after).then(|| {
            let inverse = 1.0 / (self.places[after] - self.places[before]);
            let slopes = self.smooth.as_ref().map(|smooth| [&smooth.slopes[before], &smooth.slopes[after]]);
            Between::new(&self.lines[after], slopes, (w - self.places[before]) * inverse, inverse)
        });
        Cut { line: &self.lines[before], between, frame: self.smooth.as_ref().map(|smooth| smooth.frame(w)) }
    }
}

/// One line of a stack.
pub(super) struct Cut<'s> {
    line: &'s ClosedLine,
    between: Option<Between<'s>>,
    frame: Option<Frame>,
}

/// The way from a section's line to the next one.
struct Between<'s> {
    next: &'s ClosedLine,
    /// How the lines change at both, where the way is smooth.
    slopes: Option<[&'s ClosedLine; 2]>,
    /// Weights of the rise from line to line and of these in the way, and in its derivative.
    value: [f64; 3],
    slope: [f64; 3],
}

impl<'s> Between<'s> {
    /// A share `t` of the way, of which the whole is one by `inverse` long.
    #[inline]
    fn new(next: &'s ClosedLine, slopes: Option<[&'s ClosedLine; 2]>, t: f64, inverse: f64) -> Self {
        let (value, slope) = if slopes.is_none() {
            ([t, 0.0, 0.0], [inverse, 0.0, 0.0])
        } else {
            let (t2, t3, width) = (t * t, t * t * t, 1.0 / inverse);
            (
                [3.0 * t2 - 2.0 * t3, (t - 2.0 * t2 + t3) * width, (t3 - t2) * width],
                [6.0 * (t - t2) * inverse, 1.0 - 4.0 * t + 3.0 * t2, 3.0 * t2 - 2.0 * t],
            )
        };
        Self { next, slopes, value, slope }
    }

    /// What lies between two of a kind, with their slopes where the way is smooth.
    #[inline]
    fn point(&self, a: DVec3, b: DVec3, slopes: Option<[DVec3; 2]>) -> DVec3 {
        let [rise, low, high] = self.value;
        match slopes {
            None => a + (b - a) * rise,
            Some([before, after]) => a + ((b - a) * rise + before * low + after * high),
        }
    }

    /// The same, and how it changes.
    #[inline]
    fn mix(&self, a: DVec3, b: DVec3, slopes: Option<[DVec3; 2]>) -> (DVec3, DVec3) {
        let [rise, low, high] = self.slope;
        let slope = match slopes {
            None => (b - a) * rise,
            Some([before, after]) => (b - a) * rise + before * low + after * high,
        };
        (self.point(a, b, slopes), slope)
    }
}

/// Center and size of a line, and how they change.
struct Frame {
    center: [DVec3; 2],
    size: f64,
    growth: f64,
}

impl Cut<'_> {
    /// The derivative by the curve parameter at a knot, as [`Cut::eval`] has it there.
    fn drift(&self, knot: usize) -> DVec3 {
        let at = |line: &ClosedLine| line.knots[knot][0];
        let a = at(self.line);
        let (point, slope) = match &self.between {
            None => (a, DVec3::ZERO),
            Some(way) => way.mix(a, at(way.next), way.slopes.map(|slopes| slopes.map(at))),
        };
        match &self.frame {
            None => slope,
            Some(Frame { center: [_, drift], size, growth }) => *drift + point * *growth + slope * *size,
        }
    }

    /// Mean square of the derivative by the curve parameter, from four places.
    pub(super) fn pace_squared(&self) -> f64 {
        let count = self.line.knots.len();
        (0..4).map(|k| self.drift(count * k / 4).length_squared()).sum::<f64>() / 4.0
    }

    /// The point alone.
    #[inline]
    pub(super) fn point(&self, v: f64) -> DVec3 {
        let knot = Knot::at(v, self.line.knots.len());
        let a = self.line.point_at(knot);
        let point = match &self.between {
            None => a,
            Some(way) => way.point(
                a,
                way.next.point_at(knot),
                way.slopes.map(|slopes| slopes.map(|line| line.point_at(knot))),
            ),
        };
        match &self.frame {
            None => point,
            Some(Frame { center: [center, _], size, .. }) => *center + point * *size,
        }
    }

    /// Point and derivatives, `du` by the curve parameter.
    #[inline]
    pub(super) fn eval(&self, v: f64) -> Jet {
        // All lines of a stack have as many knots.
        let knot = Knot::at(v, self.line.knots.len());
        let (a, av) = self.line.eval_at(knot);
        let line = match &self.between {
            None => Jet { point: a, du: DVec3::ZERO, dv: av },
            Some(way) => {
                let (b, bv) = way.next.eval_at(knot);
                let slopes = way.slopes.map(|slopes| slopes.map(|line| line.eval_at(knot)));
                let (point, du) = way.mix(a, b, slopes.map(|slopes| slopes.map(|slope| slope.0)));
                Jet { point, du, dv: way.point(av, bv, slopes.map(|slopes| slopes.map(|slope| slope.1))) }
            }
        };
        match &self.frame {
            None => line,
            Some(Frame { center: [center, drift], size, growth }) => Jet {
                point: *center + line.point * *size,
                du: *drift + line.point * *growth + line.du * *size,
                dv: line.dv * *size,
            },
        }
    }
}

impl Smooth {
    /// Takes center and size out of the lines.
    fn new(places: &[f64], lines: &mut [ClosedLine], points: &[bool]) -> Self {
        let centers: Vec<DVec3> = lines.iter().map(ClosedLine::center).collect();
        let mut sizes = Vec::with_capacity(lines.len());
        for (line, center) in lines.iter_mut().zip(&centers) {
            let square = line.knots.iter().map(|k| k[0].distance_squared(*center)).sum::<f64>()
                / line.knots.len() as f64;
            sizes.push(square);
            let inverse = if square > 0.0 { 1.0 / square.sqrt() } else { 0.0 };
            for knot in &mut line.knots {
                *knot = [(knot[0] - *center) * inverse, knot[1] * inverse];
            }
        }
        // A point has the form of its neighbor.
        let last = lines.len() - 1;
        if last > 0 && points[0] {
            lines[0] = lines[1].clone();
        }
        if last > 0 && points[last] {
            lines[last] = lines[last - 1].clone();
        }
        let column = |values: Vec<f64>, positive| smooth::cubics(places, &values, true, positive);
        let [x, y, z] = [0, 1, 2].map(|i| column(centers.iter().map(|c| c[i]).collect(), false));
        let size = column(sizes, true);
        let numbers = (0..size.len()).map(|i| [x[i], y[i], z[i], size[i]]).collect();
        let count = lines[0].knots.len();
        let mut samples = vec![vec![DVec3::ZERO; count]; lines.len()];
        let mut slopes = smooth::Slopes::new(places);
        let mut values = vec![0.0; count * lines.len()];
        for axis in 0..3 {
            let all = lines.iter().flat_map(|line| &line.knots);
            for (value, knot) in values.iter_mut().zip(all) {
                *value = knot[0][axis];
            }
            // Loops in planes do not change along the curve.
            if values.iter().all(|value| *value == 0.0) {
                continue;
            }
            let slopes = slopes.through(&values, count);
            for (sample, slope) in samples.iter_mut().flatten().zip(slopes) {
                sample[axis] = *slope;
            }
        }
        if let (Some(first), true) = (samples.first_mut(), places[0] > 0.0) {
            first.fill(DVec3::ZERO);
        }
        if let (Some(end), true) = (samples.last_mut(), places[last] < 1.0) {
            end.fill(DVec3::ZERO);
        }
        Self { slopes: samples.iter().map(|row| ClosedLine::from_samples(row)).collect(), numbers }
    }

    #[inline]
    fn frame(&self, w: f64) -> Frame {
        let index = self.numbers.partition_point(|n| n[0].start <= w).max(1) - 1;
        let numbers = &self.numbers[index];
        let t = (w - numbers[0].start) * numbers[0].inverse;
        let value = |i: usize| {
            let c = &numbers[i].coefficients;
            c[0] + t * (c[1] + t * (c[2] + t * c[3]))
        };
        let slope = |i: usize| {
            let c = &numbers[i].coefficients;
            (c[1] + t * (2.0 * c[2] + t * 3.0 * c[3])) * numbers[i].inverse
        };
        let size = value(3).max(1e-30).sqrt();
        let growth = 0.5 * slope(3) / size;
        let vector = |[x, y, z]: [f64; 3]| DVec3::new(x, y, z);
        Frame { center: [vector([0, 1, 2].map(value)), vector([0, 1, 2].map(slope))], size, growth }
    }
}

/// Where the line lies in the direction of x from its center.
fn phase_of_x(line: &ClosedLine) -> f64 {
    let center = line.center();
    let count = line.knots.len();
    let arm = |i: usize| (line.knots[i % count][0] - center).truncate();
    for i in 0..count {
        let (a, b) = (arm(i), arm(i + 1));
        if a.x > 0.0 && a.y >= 0.0 && b.y < 0.0 {
            return (i as f64 + a.y / (a.y - b.y)) / count as f64;
        }
    }
    0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_turns_as_often_as_its_slope() {
        for (around, bow, turns) in [(1, 0.0, 1), (-1, 0.0, -1), (2, 0.0, 2), (-3, 0.0, -3), (0, 1.0, 0)] {
            for k in 0..40 {
                // Begun anywhere: slopes along x and y, too.
                let begin = f64::from(k) / 40.0;
                let at = |i: u32| {
                    let v = f64::from(i) / 96.0 + begin;
                    let (sin, cos) = sin_cos(TAU * v * f64::from(if around == 0 { 1 } else { around }));
                    let eight = sin_cos(2.0 * TAU * v).0;
                    DVec3::new(cos * 20.0, sin * 20.0 * (1.0 - bow) + eight * bow * 9.0, 0.0)
                };
                let line = ClosedLine::through(&(0..96).map(at).collect::<Vec<_>>(), 112).unwrap();
                assert_eq!(line.turns(), turns, "{around} {begin}");
            }
        }
        let square = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let flat = ClosedLine { knots: square.map(|corner| [corner, DVec3::ZERO]).to_vec() };
        assert_eq!(flat.turns(), -1);
    }
}
