//! Stacks that are all but round: made exactly round, so that they get the even repeats of a designer.

use super::End;
use super::stack::Stack;
use crate::math::{TAU, sin_cos};
use glam::{DMat4, DVec2, DVec3, DVec4};

/// Greatest distance from a round tube, in stitch widths, and as a share of the radius for tubes of many stitches.
const TOLERANCE: f64 = 0.2;
const SHARE: f64 = 0.02;
/// Steps in which the axis is moved to where the surface lies best around it; and how firmly it stays where that is all one,
/// as it is on a ball.
const STEPS: usize = 16;
const STAYS: f64 = 1e-3;
/// A step that moves the ends of the axis by less than this (stitch widths) is the last one.
const STILL: f64 = 1e-4;
/// Points of a row that tell where the axis is; what is off by so many times the tolerance even so needs no steps.
const FEW: usize = 32;
const FAR: f64 = 8.0;
/// One of so many points of a row are enough to tell how it runs.
const TELLING: usize = 4;
/// Stretches of the meridian to both sides on which the foot of a point is sought.
const BESIDE: usize = 3;

impl Stack {
    /// Makes the tube a surface of revolution when it is one but for less than what stitches of this width can show.
    /// The lines that it is a stack of need not be level: it is the surface that counts. True when it is one.
    ///
    /// `corners` are those of the triangles that it was cut from, if it was: the lines lie on the triangles, a little inside
    /// of what these stand for. What was mended is made up, and tells nothing.
    pub(crate) fn revolve(&mut self, width: f64, corners: &[DVec3], mended: &[Mended]) -> bool {
        let Some((axis, meridian, first)) = self.round(width, mended) else { return false };
        let corners = corners.iter().filter(|p| is_given(**p, mended));
        let meridian = drawn_to(&meridian, corners.map(|p| axis.split(*p).0), TOLERANCE * width);
        let around = self.rows().next().map_or(1, <[DVec3]>::len);
        // Clockwise seen from the end of the tube.
        let second = -axis.way.cross(first);
        self.set(|row, k| {
            let (sin, cos) = sin_cos(TAU * k as f64 / around as f64);
            let place = meridian[row];
            axis.origin + axis.way * place.x + (first * cos + second * sin) * place.y
        });
        self.respace();
        true
    }

    /// The axis of a tube that is round within the tolerance, its meridian, and where its first line lies around it.
    fn round(&self, width: f64, mended: &[Mended]) -> Option<(Axis, Vec<DVec2>, DVec3)> {
        let rows: Vec<&[DVec3]> = self.rows().collect();
        let closed = self.ends().map(|end| end == End::Closed);
        let mut axis = Axis::of(&rows)?;
        let parts: Vec<Vec<DVec3>> = match mended {
            [] => Vec::new(),
            _ => rows.iter().map(|row| given(row, mended)).collect(),
        };
        let rows = if mended.is_empty() { rows } else { parts.iter().map(Vec::as_slice).collect() };
        // Most tubes are not round by far.
        let limit = |radius: f64| (TOLERANCE * width).max(SHARE * radius);
        let mut meridian = axis.meridian(&rows, closed);
        let near = |(row, middle): (&&[DVec3], &DVec2)| {
            let off = |p: &DVec3| (axis.split(*p).0.y - middle.y).abs();
            middle.y == 0.0 || few(row).all(|p| off(p) <= FAR * limit(middle.y))
        };
        if !rows.iter().zip(&meridian).all(near) {
            return None;
        }
        for _ in 0..STEPS {
            let before = axis;
            axis = axis.moved(&rows, &meridian)?;
            meridian = axis.meridian(&rows, closed);
            let still = |end: Option<&DVec2>| {
                end.is_none_or(|end| axis.at(end.x).distance(before.at(end.x)) <= STILL * width)
            };
            if still(meridian.first()) && still(meridian.last()) {
                break;
            }
        }
        for (i, row) in rows.iter().enumerate() {
            let most = limit(meridian[i].y);
            if row.iter().any(|p| foot(&meridian, i, axis.split(*p).0).0.length() > most) {
                return None;
            }
        }
        let widest = (0..rows.len()).max_by(|a, b| meridian[*a].y.total_cmp(&meridian[*b].y))?;
        let first = self.rows().nth(widest)?.first().map(|p| axis.split(*p).1)?;
        (first != DVec3::ZERO).then_some((axis, meridian, first))
    }
}

/// Where a surface was closed: in a ball, beyond a plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mended {
    middle: DVec3,
    radius: f64,
    /// Across the plane, and how far beyond the middle it lies.
    way: DVec3,
    low: f64,
}

impl Mended {
    /// The place within a closed line, toward a point over it.
    pub(crate) fn within(edge: &[DVec3], apex: DVec3) -> Self {
        let middle = edge.iter().sum::<DVec3>() / edge.len().max(1) as f64;
        let arms = || edge.iter().map(|p| *p - middle);
        let way =
            arms().zip(arms().cycle().skip(1)).map(|(a, b)| a.cross(b)).sum::<DVec3>().normalize_or_zero();
        let way = if way.dot(apex - middle) < 0.0 { -way } else { way };
        let radius = arms().map(DVec3::length).fold(0.0, f64::max);
        let low = arms().map(|arm| arm.dot(way)).fold(0.0, f64::min);
        Self { middle, radius, way, low }
    }

    fn holds(&self, p: DVec3) -> bool {
        let arm = p - self.middle;
        arm.length_squared() <= self.radius * self.radius && arm.dot(self.way) >= self.low
    }
}

/// True where nothing was mended.
fn is_given(p: DVec3, mended: &[Mended]) -> bool {
    !mended.iter().any(|place| place.holds(p))
}

/// The points of a row where nothing was mended, if they are enough to tell how it runs.
fn given(row: &[DVec3], mended: &[Mended]) -> Vec<DVec3> {
    let given: Vec<DVec3> = row.iter().copied().filter(|p| is_given(*p, mended)).collect();
    if TELLING * given.len() < row.len() { row.to_vec() } else { given }
}

/// Some points of a row, evenly around it.
fn few(row: &[DVec3]) -> impl Iterator<Item = &DVec3> {
    row.iter().step_by((row.len() / FEW).max(1))
}

/// A line in space.
#[derive(Clone, Copy, Debug)]
struct Axis {
    origin: DVec3,
    way: DVec3,
}

impl Axis {
    /// Through the middles of the rows, across them.
    fn of(rows: &[&[DVec3]]) -> Option<Self> {
        // Twice the area of each row as a vector, all of them summed: the axis, against the sense of v.
        let area = |row: &[DVec3]| -> DVec3 {
            row.iter().zip(row.iter().cycle().skip(1)).map(|(a, b)| (*a - row[0]).cross(*b - row[0])).sum()
        };
        let areas: Vec<DVec3> = rows.iter().map(|row| area(row)).collect();
        let way = -areas.iter().sum::<DVec3>().normalize_or_zero();
        let center = |row: &[DVec3]| row.iter().sum::<DVec3>() / row.len() as f64;
        let weight: f64 = areas.iter().map(|area| area.length()).sum();
        let centers = rows.iter().zip(&areas).map(|(row, area)| center(row) * area.length());
        let origin = centers.sum::<DVec3>() / weight;
        (way != DVec3::ZERO).then_some(Self { origin, way })
    }

    /// A place of the axis.
    fn at(&self, height: f64) -> DVec3 {
        self.origin + self.way * height
    }

    /// Height along the axis and distance from it; and the direction away from it.
    fn split(&self, p: DVec3) -> (DVec2, DVec3) {
        let arm = p - self.origin;
        let height = arm.dot(self.way);
        let out = arm - self.way * height;
        let radius = out.length();
        (DVec2::new(height, radius), if radius > 0.0 { out / radius } else { DVec3::ZERO })
    }

    /// Mean height and mean radius of each row; a closed end lies on the axis.
    fn meridian(&self, rows: &[&[DVec3]], closed: [bool; 2]) -> Vec<DVec2> {
        let mean =
            |row: &[DVec3]| row.iter().map(|p| self.split(*p).0).sum::<DVec2>() / row.len().max(1) as f64;
        let mut meridian: Vec<DVec2> = rows.iter().map(|row| mean(row)).collect();
        let [first, last] = closed;
        meridian.first_mut().filter(|_| first).into_iter().for_each(|place| place.y = 0.0);
        meridian.last_mut().filter(|_| last).into_iter().for_each(|place| place.y = 0.0);
        meridian
    }

    /// The axis around which the rows lie nearer to the meridian: a step of Gauss and Newton.
    ///
    /// Moved by t and tilted by w, both across it, it sees a point at height h and radius r in direction e at h + r e w and
    /// r - e t - h e w.
    fn moved(self, rows: &[&[DVec3]], meridian: &[DVec2]) -> Option<Self> {
        let across = self.way.any_orthonormal_pair();
        let (mut matrix, mut right) = (DMat4::ZERO, DVec4::ZERO);
        for (i, row) in rows.iter().enumerate() {
            for p in few(row) {
                let (place, out) = self.split(*p);
                let (off, normal) = foot(meridian, i, place);
                let e = DVec2::new(out.dot(across.0), out.dot(across.1));
                let (t, w) = (e * normal.y, e * (normal.y * place.x - normal.x * place.y));
                let slope = DVec4::new(t.x, t.y, w.x, w.y);
                // Samples are denser where a row is short.
                let weighted = slope * place.y;
                matrix += DMat4::from_cols(
                    weighted * slope.x,
                    weighted * slope.y,
                    weighted * slope.z,
                    weighted * slope.w,
                );
                right += weighted * off.dot(normal);
            }
        }
        let diagonal = DVec4::new(matrix.x_axis.x, matrix.y_axis.y, matrix.z_axis.z, matrix.w_axis.w) * STAYS;
        let step = (matrix + DMat4::from_diagonal(diagonal)).inverse() * right;
        let along = |x: f64, y: f64| across.0 * x + across.1 * y;
        let origin = self.origin + along(step.x, step.y);
        let way = (self.way + along(step.z, step.w)).normalize_or_zero();
        (origin.is_finite() && way != DVec3::ZERO).then_some(Self { origin, way })
    }
}

/// The meridian moved across itself to where the places near it lie on average; those that are farther off than `reach` do
/// not count.
fn drawn_to(meridian: &[DVec2], places: impl Iterator<Item = DVec2>, reach: f64) -> Vec<DVec2> {
    let stretches: Vec<Stretch> = (1..meridian.len()).map(|i| Stretch::new(meridian, i)).collect();
    // By height, or what is flat by radius, so that few have to be looked at.
    let range = |key: fn(&DVec2) -> f64| {
        let all = || meridian.iter().map(key);
        [all().fold(f64::INFINITY, f64::min) - reach, all().fold(f64::NEG_INFINITY, f64::max) + reach]
    };
    let (along, across) = (range(|place| place.x), range(|place| place.y));
    let flat = along[1] - along[0] < across[1] - across[0];
    let [low, high] = if flat { across } else { along };
    let key = |place: &DVec2| if flat { place.y } else { place.x };
    let count = stretches.len();
    let bin = |key: f64| (((key - low) / (high - low) * count as f64) as usize).min(count - 1);
    let mut bins = vec![Vec::new(); count];
    for (i, pair) in meridian.windows(2).enumerate() {
        let [a, b] = [key(&pair[0]), key(&pair[1])];
        bins[bin(a.min(b) - reach)..=bin(a.max(b) + reach)].iter_mut().for_each(|bin| bin.push(i));
    }
    let mut sums = vec![[0.0; 2]; meridian.len()];
    for place in places.filter(|place| (low..=high).contains(&key(place))) {
        let near = bins[bin(key(&place))].iter().map(|i| (*i, stretches[*i].foot(place)));
        let Some((i, (t, off))) = near.min_by(|a, b| a.1.1.abs().total_cmp(&b.1.1.abs())) else { continue };
        if off.abs() <= reach {
            for (node, weight) in [(i, 1.0 - t), (i + 1, t)] {
                sums[node][0] += weight * off;
                sums[node][1] += weight;
            }
        }
    }
    let last = meridian.len() - 1;
    let normal = |i: usize| {
        let around = [i.checked_sub(1), (i < last).then_some(i)].into_iter().flatten();
        around.map(|i| stretches[i].normal).sum::<DVec2>().normalize_or_zero()
    };
    let moved = |(i, [sum, weight]): (usize, &[f64; 2])| {
        let on_axis = meridian[i].y == 0.0;
        let normal = if on_axis { DVec2::new(normal(i).x.signum(), 0.0) } else { normal(i) };
        meridian[i] + normal * if *weight > 0.0 { sum / weight } else { 0.0 }
    };
    sums.iter().enumerate().map(moved).collect()
}

/// One stretch of a meridian, between two rows.
struct Stretch {
    from: DVec2,
    along: DVec2,
    normal: DVec2,
    /// How far it bulges along the normal: 4 t (1 - t) times this.
    bulge: f64,
}

impl Stretch {
    /// The one that ends at row `i`.
    fn new(meridian: &[DVec2], i: usize) -> Self {
        let (from, to) = (meridian[i - 1], meridian[i]);
        let along = to - from;
        let normal = DVec2::new(along.y, -along.x).normalize_or_zero();
        // Beyond a pole the meridian goes on as its mirror image.
        let beyond = |other: Option<&DVec2>, end: DVec2, inner: DVec2| {
            other.copied().or((end.y == 0.0).then_some(DVec2::new(inner.x, -inner.y)))
        };
        let before = beyond(i.checked_sub(2).and_then(|i| meridian.get(i)), from, to);
        let after = beyond(meridian.get(i + 1), to, from);
        // Second derivative by t, from three rows.
        let bend = |a: DVec2, b: DVec2, c: DVec2| {
            let (left, right) = (a.distance(b).max(1e-12), b.distance(c).max(1e-12));
            ((c - b) / right - (b - a) / left) * (2.0 / (left + right))
        };
        let bends = [before.map(|before| bend(before, from, to)), after.map(|after| bend(from, to, after))];
        let known = bends.iter().flatten().count().max(1) as f64;
        let mean = bends.into_iter().flatten().sum::<DVec2>() / known;
        Self { from, along, normal, bulge: -mean.dot(normal) * along.length_squared() / 8.0 }
    }

    /// How far along the stretch the foot of a place lies, and how far off the place is; infinitely where it is beside.
    fn foot(&self, place: DVec2) -> (f64, f64) {
        let arm = place - self.from;
        let t = (arm.dot(self.along) / self.along.length_squared()).clamp(0.0, 1.0);
        let off = arm - self.along * t;
        let beside = off.dot(self.along).abs() > 0.1 * self.along.length_squared();
        let off = off.dot(self.normal) - 4.0 * t * (1.0 - t) * self.bulge;
        (t, if beside || off.is_nan() { f64::INFINITY } else { off })
    }
}

/// From the meridian near a row of it to a place: the shortest way, and the normal of the stretch that it starts from.
fn foot(meridian: &[DVec2], row: usize, place: DVec2) -> (DVec2, DVec2) {
    let last = meridian.len() - 1;
    let near = &meridian[row.saturating_sub(BESIDE)..=(row + BESIDE).min(last)];
    let mut best = (place - meridian[row], DVec2::ZERO);
    for pair in near.windows(2) {
        let along = pair[1] - pair[0];
        let square = along.length_squared();
        if square > 0.0 {
            let t = ((place - pair[0]).dot(along) / square).clamp(0.0, 1.0);
            let off = place - pair[0] - along * t;
            if off.length_squared() <= best.0.length_squared() || best.1 == DVec2::ZERO {
                best = (off, DVec2::new(along.y, -along.x) / square.sqrt());
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math;
    use crate::shape::ring::Ring;
    use crate::shape::{ParametricSurface, is_revolution};

    /// A tube around a slanting axis, whose lines are tilted and whose first pole lies off it; `flat` as deep as wide.
    fn leaning(flat: f64) -> (Axis, Stack) {
        let axis = Axis { origin: DVec3::new(3.0, -2.0, 5.0), way: DVec3::new(0.3, -0.2, 0.9).normalize() };
        let first = axis.way.any_orthonormal_vector();
        let second = -axis.way.cross(first) * flat;
        let radius = |height: f64| 20.0 * (1.0 - (height / 30.0) * (height / 30.0)).max(0.0).sqrt();
        let place = |height: f64, k: u32| {
            let (sin, cos) = sin_cos(TAU * f64::from(k) / 64.0);
            let height = height + 0.03 * radius(height) * cos;
            axis.origin + axis.way * height + (first * cos + second * sin) * radius(height)
        };
        let rings: Vec<Ring> = (1..16)
            .map(|i| 30.0 * (f64::from(i) / 8.0 - 1.0))
            .filter_map(|height| Ring::new((0..64).map(|k| place(height, k)).collect()))
            .collect();
        let poles = [place(-29.97, 0), axis.origin + axis.way * 30.0].map(Some);
        (axis, Stack::new(&rings, poles, 32).expect("a tube"))
    }

    #[test]
    fn what_is_round_gets_its_axis_though_its_lines_are_tilted() {
        let (axis, mut stack) = leaning(1.0);
        assert!(stack.revolve(5.0, &[], &[]) && is_revolution(&stack));
        for u in [0.0, 1.0] {
            let off = axis.split(stack.point(u, 0.3)).0.y;
            assert!(off < 0.1, "{off}");
        }
        let (_, mut stack) = leaning(0.9);
        assert!(!stack.revolve(5.0, &[], &[]));
    }

    #[test]
    fn a_meridian_is_drawn_to_what_it_stands_for() {
        let at = |angle: f64, radius: f64| DVec2::new(-math::cos(angle), math::sin(angle)) * radius;
        let half = math::PI;
        let mut inside: Vec<DVec2> = (0..=12).map(|i| at(half * f64::from(i) / 12.0, 9.8)).collect();
        inside.iter_mut().step_by(12).for_each(|pole| pole.y = 0.0);
        let places = (0..=400).map(|i| at(half * f64::from(i) / 400.0, 10.0));
        for place in drawn_to(&inside, places, 1.0) {
            assert!((place.length() - 10.0).abs() < 0.02, "{place}");
        }
    }
}
