//! Closed loops of points: made smooth, spread evenly by arc length, turned to each other, and stacked.

use super::spec::{Fault, Profile, Section};
use super::{Jet, smooth};
use crate::math::{TAU, atan2, sin_cos};
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
        let at = |i: usize| samples[i % count];
        let knots = (0..count)
            .map(|i| {
                let slope =
                    (8.0 * (at(i + 1) - at(i + count - 1)) - (at(i + 2) - at(i + 2 * count - 2))) / 12.0;
                [samples[i], slope]
            })
            .collect();
        Self { knots }
    }

    fn constant(value: DVec3, count: usize) -> Self {
        Self { knots: vec![[value, DVec3::ZERO]; count] }
    }

    /// Point and derivative by v.
    #[inline]
    pub fn eval(&self, v: f64) -> (DVec3, DVec3) {
        let count = self.knots.len();
        // Truncation is cheaper than floor; v beyond the integers has no fraction to lose.
        let fraction = v - (v as i64) as f64;
        let scaled = (if fraction < 0.0 { fraction + 1.0 } else { fraction }) * count as f64;
        let index = (scaled as usize).min(count - 1);
        let t = scaled - index as f64;
        let [a, da] = self.knots[index];
        let [b, db] = self.knots[if index + 1 == count { 0 } else { index + 1 }];
        let rise = b - a;
        let (square, cube) = (3.0 * rise - 2.0 * da - db, da + db - 2.0 * rise);
        (a + t * (da + t * (square + t * cube)), (da + t * (2.0 * square + t * 3.0 * cube)) * count as f64)
    }

    /// Mean of the points.
    pub fn center(&self) -> DVec3 {
        self.knots.iter().map(|knot| knot[0]).sum::<DVec3>() / self.knots.len() as f64
    }

    /// How often the line turns around as seen along z: 1 counterclockwise, -1 clockwise, anything else for a
    /// line that crosses itself.
    pub fn turns(&self) -> i32 {
        let mut angle = 0.0;
        let count = self.knots.len();
        let slopes: Vec<DVec2> = (0..count)
            .map(|i| (self.knots[(i + 1) % count][0] - self.knots[i][0]).truncate())
            .filter(|slope| slope.length_squared() > 0.0)
            .collect();
        for (i, slope) in slopes.iter().enumerate() {
            let next = slopes[(i + 1) % slopes.len()];
            angle += atan2(slope.perp_dot(next), slope.dot(next));
        }
        (angle / TAU).round() as i32
    }

    /// Area enclosed as seen along z, positive counterclockwise.
    fn area(&self) -> f64 {
        let count = self.knots.len();
        let center = self.center();
        let at = |i: usize| (self.knots[i % count][0] - center).truncate();
        (0..count).map(|i| 0.5 * at(i).perp_dot(at(i + 1))).sum()
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
        const SAMPLES: u32 = 64;
        let sample = |line: &Self| -> Vec<DVec3> {
            let center = line.center();
            (0..SAMPLES).map(|k| line.eval(f64::from(k) / f64::from(SAMPLES)).0 - center).collect()
        };
        let fixed = sample(other);
        let mine = sample(self);
        let cost = |shift: usize| -> f64 {
            fixed.iter().enumerate().map(|(i, p)| p.distance_squared(mine[(i + shift) % mine.len()])).sum()
        };
        let costs: Vec<f64> = (0..mine.len()).map(cost).collect();
        let mut best = 0;
        for (i, cost) in costs.iter().enumerate() {
            // A tie goes to the smaller shift, so that equal loops stay as they are.
            if *cost < costs[best] * (1.0 - 1e-9) {
                best = i;
            }
        }
        let (before, after) =
            (costs[(best + costs.len() - 1) % costs.len()], costs[(best + 1) % costs.len()]);
        let bow = before + after - 2.0 * costs[best];
        let shift = if bow > 0.0 { (0.5 * (before - after) / bow).clamp(-0.5, 0.5) } else { 0.0 };
        // Equal neighbors differ by rounding only: no shift then.
        let shift = if shift.abs() < 1e-9 { 0.0 } else { shift };
        (best as f64 + shift) / f64::from(SAMPLES)
    }
}

/// A periodic cubic spline over chord length, and its arc length at four places a span.
struct Spline {
    points: Vec<DVec3>,
    slopes: Vec<DVec3>,
    chords: Vec<f64>,
    lengths: Vec<f64>,
}

const PARTS: usize = 4;

impl Spline {
    fn new(points: &[DVec3]) -> Self {
        let count = points.len();
        let chords: Vec<f64> = (0..count).map(|i| points[i].distance(points[(i + 1) % count])).collect();
        let secant = |i: usize| (points[(i + 1) % count] - points[i]) / chords[i];
        // Row i: chord_i m_(i-1) + 2 (chord_(i-1) + chord_i) m_i + chord_(i-1) m_(i+1) = right hand side.
        let before = |i: usize| (i + count - 1) % count;
        let diagonal: Vec<f64> = (0..count).map(|i| 2.0 * (chords[before(i)] + chords[i])).collect();
        let right: Vec<DVec3> = (0..count)
            .map(|i| 3.0 * (chords[i] * secant(before(i)) + chords[before(i)] * secant(i)))
            .collect();
        let slopes =
            cyclic(&chords, &diagonal, &(0..count).map(|i| chords[before(i)]).collect::<Vec<_>>(), &right);
        let mut spline = Self { points: points.to_vec(), slopes, chords, lengths: vec![0.0] };
        let mut total = 0.0;
        for piece in 0..count * PARTS {
            let from = (piece % PARTS) as f64 / PARTS as f64;
            total += spline.length(piece / PARTS, from, from + 1.0 / PARTS as f64);
            spline.lengths.push(total);
        }
        spline
    }

    /// Point and derivative by the span's parameter in [0, 1].
    fn at(&self, span: usize, t: f64) -> (DVec3, DVec3) {
        let next = (span + 1) % self.points.len();
        let chord = self.chords[span];
        let (a, da, db) = (self.points[span], self.slopes[span] * chord, self.slopes[next] * chord);
        let rise = self.points[next] - a;
        let (square, cube) = (3.0 * rise - 2.0 * da - db, da + db - 2.0 * rise);
        (a + t * (da + t * (square + t * cube)), da + t * (2.0 * square + t * 3.0 * cube))
    }

    fn length(&self, span: usize, from: f64, to: f64) -> f64 {
        super::bezier::integrate(from, to, |t| self.at(span, t).1.length())
    }

    /// Point and unit direction at an arc length that lies in the given piece.
    fn at_length(&self, piece: usize, target: f64) -> (DVec3, DVec3) {
        let (span, from) = (piece / PARTS, (piece % PARTS) as f64 / PARTS as f64);
        let size = self.lengths[piece + 1] - self.lengths[piece];
        let mut t = from + (target - self.lengths[piece]) / size.max(f64::MIN_POSITIVE) / PARTS as f64;
        for _ in 0..2 {
            let miss = self.lengths[piece] + self.length(span, from, t) - target;
            let speed = self.at(span, t).1.length();
            if speed > 0.0 {
                t = (t - miss / speed).clamp(from, from + 1.0 / PARTS as f64);
            }
        }
        let (point, slope) = self.at(span, t);
        (point, slope.normalize_or_zero())
    }
}

/// Solves a cyclic tridiagonal system (diagonally dominant) by the Sherman-Morrison formula.
fn cyclic(lower: &[f64], diagonal: &[f64], upper: &[f64], right: &[DVec3]) -> Vec<DVec3> {
    let count = diagonal.len();
    let gamma = -diagonal[0];
    let corner_low = upper[count - 1];
    let corner_high = lower[0];
    let mut changed = diagonal.to_vec();
    changed[0] -= gamma;
    changed[count - 1] -= corner_low * corner_high / gamma;
    let mut ratio = vec![0.0; count];
    let mut first = vec![DVec3::ZERO; count];
    let mut second = vec![0.0; count];
    for i in 0..count {
        let unit = match i {
            0 => gamma,
            _ if i + 1 == count => corner_low,
            _ => 0.0,
        };
        let (low, last, last_unit, last_ratio) = match i.checked_sub(1) {
            Some(j) => (lower[i], first[j], second[j], ratio[j]),
            None => (0.0, DVec3::ZERO, 0.0, 0.0),
        };
        let pivot = changed[i] - low * last_ratio;
        ratio[i] = upper[i] / pivot;
        first[i] = (right[i] - low * last) / pivot;
        second[i] = (unit - low * last_unit) / pivot;
    }
    for i in (0..count - 1).rev() {
        first[i] = first[i] - ratio[i] * first[i + 1];
        second[i] -= ratio[i] * second[i + 1];
    }
    let weight = corner_high / gamma;
    let factor = (first[0] + weight * first[count - 1]) / (1.0 + second[0] + weight * second[count - 1]);
    first.iter().zip(&second).map(|(a, b)| *a - factor * *b).collect()
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
        let mut last: Option<usize> = None;
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
            if line.area() > 0.0 {
                line.reverse();
            }
            let girth: f64 = line.knots.iter().map(|knot| knot[1].length()).sum();
            if line.turns() != -1 || line.area().abs() < 1e-6 * girth * girth {
                return Err(fault);
            }
            let phase = match last {
                Some(last) => line.phase_against(&lines[last]),
                None => phase_of_x(&line),
            };
            if phase != 0.0 {
                line = line.shifted(phase);
            }
            last = Some(lines.len());
            lines.push(line);
        }
        let places: Vec<f64> = sections.iter().map(|it| it.at).collect();
        let smooth = smooth.then(|| Smooth::new(&places, &mut lines, points));
        Ok(Self { places, lines, smooth })
    }

    #[inline]
    pub(super) fn eval(&self, w: f64, v: f64) -> Jet {
        let after = self.places.partition_point(|&at| at <= w);
        let before = after.max(1) - 1;
        let after = after.min(self.places.len() - 1);
        let (a, av) = self.lines[before].eval(v);
        let line = if before == after {
            Jet { point: a, du: DVec3::ZERO, dv: av }
        } else {
            let (b, bv) = self.lines[after].eval(v);
            let inverse = 1.0 / (self.places[after] - self.places[before]);
            let t = (w - self.places[before]) * inverse;
            match &self.smooth {
                None => Jet { point: a + (b - a) * t, du: (b - a) * inverse, dv: av + (bv - av) * t },
                Some(smooth) => {
                    let (ma, mav) = smooth.slopes[before].eval(v);
                    let (mb, mbv) = smooth.slopes[after].eval(v);
                    let width = 1.0 / inverse;
                    let (s, s2, s3) = (t, t * t, t * t * t);
                    let blend = [s - 2.0 * s2 + s3, 3.0 * s2 - 2.0 * s3, s3 - s2];
                    let mix = |a: DVec3, ma: DVec3, b: DVec3, mb: DVec3| {
                        a + (b - a) * blend[1] + (ma * blend[0] + mb * blend[2]) * width
                    };
                    let slope = (b - a) * ((6.0 * s - 6.0 * s2) * inverse)
                        + ma * (1.0 - 4.0 * s + 3.0 * s2)
                        + mb * (3.0 * s2 - 2.0 * s);
                    Jet { point: mix(a, ma, b, mb), du: slope, dv: mix(av, mav, bv, mbv) }
                }
            }
        };
        match &self.smooth {
            None => line,
            Some(smooth) => smooth.place(w, &line),
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
        for knot in 0..count {
            for axis in 0..3 {
                let values: Vec<f64> = lines.iter().map(|line| line.knots[knot][0][axis]).collect();
                for (row, slope) in samples.iter_mut().zip(smooth::slopes(places, &values, false)) {
                    row[knot][axis] = slope;
                }
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

    fn place(&self, w: f64, line: &Jet) -> Jet {
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
        Jet {
            point: DVec3::new(value(0), value(1), value(2)) + line.point * size,
            du: DVec3::new(slope(0), slope(1), slope(2)) + line.point * growth + line.du * size,
            dv: line.dv * size,
        }
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
