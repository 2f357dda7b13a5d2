//! The inside of a tube: signed distances from its surface.

use super::{End, Jet, ParametricSurface};
use glam::DVec3;
use rayon::prelude::*;
use std::fmt;
use std::sync::{Arc, OnceLock};

/// Places around the tube in the table of its points.
const AROUND: u32 = 32;
/// Least and greatest number of places along it.
const ALONG: [u32; 2] = [16, 256];
/// Places of a row of the table that have a box together.
const BLOCK: usize = 8;
/// Fewest of all places that are worth being handed to another thread.
const TOGETHER: usize = 256;
/// Places along a tube and around it at which it is asked whether it runs into another one.
const CROSSING: [u32; 2] = [40, 24];
/// Cosine to the normal at the nearest place of the table by which a point is certainly on that side of the surface.
const STEEP: f64 = 0.5;
/// The same at a foot that is nearly found, and how nearly (in u and v).
const UPRIGHT: f64 = 0.9;
const ROUGHLY: f64 = 1e-2;
/// Balls without surface that are kept in mind.
const BALLS: usize = 8;
/// Rows of the table next to an end where that is not certain: points may lie beyond it, and poles have no normal.
const EDGE: usize = 2;
/// Steps that refine a foot.
const STEPS: u32 = 8;
/// Steps that find where a line comes through the surface, how small they are (in u and v) when one more is enough, and the
/// least sine at which a line may cross.
const MOST_STEPS: u32 = 12;
const NEARLY: f64 = 1e-8;
const FLAT: f64 = 0.02;
/// Nearest to an end that derivatives are taken, for a pole has none.
const INSET: f64 = 1e-5;

/// A tube as a body that points can be inside of.
pub(crate) struct Solid<'s> {
    surface: &'s dyn ParametricSurface,
    ends: [End; 2],
    table: Arc<Table>,
}

impl fmt::Debug for Solid<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Solid")
            .field("low", &self.table.low)
            .field("high", &self.table.high)
            .finish_non_exhaustive()
    }
}

/// What is known of a tube without looking at its surface again: all that asks about one tube can share it.
pub(crate) struct Table {
    /// Rows of so many places, evenly from the start to the end; one more than `along`.
    points: Vec<DVec3>,
    along: u32,
    /// Around each row, and around each block of it.
    rows: Vec<Bounds>,
    blocks: Vec<Bounds>,
    low: DVec3,
    high: DVec3,
    /// No place of the surface is farther than that from one of the table.
    cell: f64,
    /// Balls around the open ends.
    openings: Vec<(DVec3, f64)>,
    /// Points all over the tube, once they are asked for.
    all_over: OnceLock<Vec<DVec3>>,
}

/// A box.
#[derive(Clone, Copy)]
struct Bounds {
    low: DVec3,
    high: DVec3,
}

impl Bounds {
    fn of(points: &[DVec3]) -> Self {
        let (low, high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        points
            .iter()
            .fold(Self { low, high }, |it, point| Self { low: it.low.min(*point), high: it.high.max(*point) })
    }

    /// Square of the distance from a point, rounded like that to a point inside: never greater.
    fn distance_squared(&self, point: DVec3) -> f64 {
        // Numbers that are none count as 0: one instruction each.
        let out = |low: f64, high: f64, at: f64| {
            let (below, above) = (low - at, at - high);
            let out = if below > above { below } else { above };
            if out > 0.0 { out } else { 0.0 }
        };
        let x = out(self.low.x, self.high.x, point.x);
        let y = out(self.low.y, self.high.y, point.y);
        let z = out(self.low.z, self.high.z, point.z);
        x * x + y * y + z * z
    }
}

impl Table {
    /// Tabulates a tube.
    pub(crate) fn new(surface: &dyn ParametricSurface, ends: [End; 2]) -> Self {
        let girth = super::girth(surface, 0.5, 16).max(1e-6);
        let length = super::length_along(surface, 0.0, 0.0..1.0, 8);
        let along =
            (f64::from(AROUND) * length / girth).clamp(f64::from(ALONG[0]), f64::from(ALONG[1])) as u32;
        let all = (0..(along + 1) * AROUND).into_par_iter().with_min_len(TOGETHER);
        let points: Vec<DVec3> = all
            .map(|index| {
                let (u, v) = place(index as usize, along);
                surface.point(u, v)
            })
            .collect();
        let rows: Vec<Bounds> = points.chunks(AROUND as usize).map(Bounds::of).collect();
        let blocks = points.chunks(BLOCK).map(Bounds::of).collect();
        let (low, high) = rows
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |it, row| (it.0.min(row.low), it.1.max(row.high)));
        // The table cuts corners of the body; its box gets a little room for them.
        let room = DVec3::splat(0.05 * (high - low).max_element().max(1e-6));
        let ring = |row: &[DVec3]| {
            let center = row.iter().sum::<DVec3>() / row.len() as f64;
            (center, row.iter().map(|point| point.distance(center)).fold(0.0, f64::max))
        };
        let each: Vec<&[DVec3]> = points.chunks(AROUND as usize).collect();
        let cell = each.windows(2).map(|pair| widest_cell(pair[0], pair[1])).fold(0.0, f64::max);
        let edges = [each.first(), each.last()].into_iter().flatten().zip(ends);
        let open = edges.filter(|(_, end)| *end == End::Open);
        // A surface bulges out of its chords.
        let openings =
            open.map(|(row, _)| ring(row)).map(|(center, radius)| (center, 1.1 * radius)).collect();
        Self {
            along,
            rows,
            blocks,
            low: low - room,
            high: high + room,
            cell: 1.1 * cell,
            openings,
            all_over: OnceLock::new(),
            points,
        }
    }

    /// The place nearest to a point, the first of those alike, and the square of its distance. It is found sooner beside the
    /// row that is looked at first.
    fn nearest(&self, point: DVec3, first: usize) -> (usize, f64) {
        let mut best = (usize::MAX, f64::INFINITY);
        let mut look = |row: usize| {
            let blocks = AROUND as usize / BLOCK;
            for block in row * blocks..(row + 1) * blocks {
                if self.blocks[block].distance_squared(point) > best.1 {
                    continue;
                }
                let begin = block * BLOCK;
                for (k, place) in self.points[begin..begin + BLOCK].iter().enumerate() {
                    let distance = place.distance_squared(point);
                    if distance < best.1 || (distance == best.1 && begin + k < best.0) {
                        best = (begin + k, distance);
                    }
                }
            }
            best.1
        };
        let first = first.min(self.rows.len() - 1);
        let mut least = look(first);
        // From there in both directions.
        for row in (first + 1..self.rows.len()).chain((0..first).rev()) {
            if self.rows[row].distance_squared(point) <= least {
                least = look(row);
            }
        }
        if best.0 == usize::MAX { (0, f64::INFINITY) } else { best }
    }

    /// Cosine between the way to a point and the outward normal at a place of the table.
    fn steepness(&self, index: usize, point: DVec3) -> f64 {
        let around = AROUND as usize;
        let (row, k) = (index / around, index % around);
        let at = |row: usize, k: usize| self.points[row * around + k % around];
        let du = at((row + 1).min(self.along as usize), k) - at(row.saturating_sub(1), k);
        let dv = at(row, k + 1) - at(row, k + around - 1);
        let (normal, way) = (du.cross(dv), point - self.points[index]);
        normal.dot(way) / (normal.length() * way.length())
    }
}

/// u and v of a place of a table.
fn place(index: usize, along: u32) -> (f64, f64) {
    let index = index as u32;
    let share = |k: u32, of: u32| f64::from(k) / f64::from(of);
    (share(index / AROUND, along), share(index % AROUND, AROUND))
}

/// Half of the longest diagonal of the cells between two rows.
fn widest_cell(row: &[DVec3], next: &[DVec3]) -> f64 {
    let count = row.len();
    let cells = (0..count).map(|k| {
        let other = if k + 1 == count { 0 } else { k + 1 };
        row[k].distance_squared(next[other]).max(row[other].distance_squared(next[k]))
    });
    0.5 * cells.fold(0.0, f64::max).sqrt()
}

/// The side by the cosine between the way to a point and the outward normal, if it is steep enough.
fn decided(cosine: f64, least: f64) -> Option<Side> {
    if cosine > least {
        Some(Side::Outside)
    } else if cosine < -least {
        Some(Side::Inside)
    } else {
        None
    }
}

/// Where a point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// In the body.
    Inside,
    /// Out of it, and perhaps beyond an open end if only known by other points.
    Outside,
    /// Beyond an open end, where the surface says nothing of inside and outside.
    Beyond,
}

/// A ball that the surface does not run through: all its points lie on one side.
#[derive(Clone, Copy, Debug)]
struct Clear {
    center: DVec3,
    radius: f64,
    side: Side,
}

/// What is known of points by others near them, above all the last few balls, by turns.
#[derive(Debug, Default)]
pub(crate) struct Known {
    balls: [Option<Clear>; BALLS],
    next: usize,
    /// Row of the table in which a place was found last.
    row: usize,
}

impl Known {
    /// The side of a point, if a ball tells it.
    fn side(&self, point: DVec3) -> Option<Side> {
        let holds = |ball: &&Clear| point.distance_squared(ball.center) < ball.radius * ball.radius;
        self.balls.iter().flatten().find(holds).map(|ball| ball.side)
    }

    fn add(&mut self, ball: Clear) {
        if ball.radius > 0.0 {
            self.balls[self.next] = Some(ball);
            self.next = (self.next + 1) % BALLS;
        }
    }
}

/// The nearest place of the surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Foot {
    /// Along the tube.
    pub(crate) u: f64,
    /// Around it.
    pub(crate) v: f64,
    /// Distance from the surface in mm, negative inside.
    pub(crate) distance: f64,
    /// Cosine between the way to the point and the normal: 1 or -1 unless the foot lies on an edge or is not found.
    cosine: f64,
    /// The point lies beyond an open end, where the surface says nothing of inside and outside.
    pub(crate) beyond: bool,
}

impl<'s> Solid<'s> {
    /// A tube and its table.
    pub(crate) fn new(surface: &'s dyn ParametricSurface, ends: [End; 2]) -> Self {
        Self::with_table(surface, ends, Arc::new(Table::new(surface, ends)))
    }

    /// The same with the table that it has already.
    pub(crate) fn with_table(surface: &'s dyn ParametricSurface, ends: [End; 2], table: Arc<Table>) -> Self {
        Self { surface, ends, table }
    }

    /// False when the point is certainly outside.
    pub(crate) fn near(&self, point: DVec3) -> bool {
        point.cmpge(self.table.low).all() && point.cmple(self.table.high).all()
    }

    /// False when two bodies certainly lie apart.
    pub(crate) fn meets(&self, other: &Self) -> bool {
        let (one, other) = (&self.table, &other.table);
        one.low.cmple(other.high).all() && other.low.cmple(one.high).all()
    }

    /// The place of the surface nearest to a point.
    pub(crate) fn foot(&self, point: DVec3) -> Foot {
        let (u, v) = self.place_near(point);
        self.refine(point, u, v)
    }

    /// The same from a place near by.
    pub(crate) fn refine(&self, point: DVec3, u: f64, v: f64) -> Foot {
        self.refine_to(point, u, v, 1e-12)
    }

    /// The same to a tolerance in u and v.
    pub(crate) fn refine_to(&self, point: DVec3, mut u: f64, mut v: f64, tolerance: f64) -> Foot {
        let mut jet = self.jet(u, v);
        let mut least = jet.point.distance_squared(point);
        for _ in 0..STEPS {
            let d = point - jet.point;
            let (e, f, g) = (jet.du.length_squared(), jet.du.dot(jet.dv), jet.dv.length_squared());
            let (a, b) = (d.dot(jet.du), d.dot(jet.dv));
            let (e, g) = (e + 1e-12, g * (1.0 + 1e-9) + 1e-12);
            let determinant = (e * g - f * f).max(1e-9 * e * g);
            let mut step = ((g * a - f * b) / determinant, (e * b - f * a) / determinant);
            let long = (step.0.abs() / 0.1).max(step.1.abs() / 0.1).max(1.0);
            step = (step.0 / long, step.1 / long);
            // The surface curves away: a step that leads astray is shortened.
            let mut moved = false;
            for _ in 0..5 {
                let (next_u, next_v) = ((u + step.0).clamp(0.0, 1.0), v + step.1);
                let next = self.jet(next_u, next_v);
                let distance = next.point.distance_squared(point);
                if distance < least {
                    (u, v, jet, least, moved) = (next_u, next_v, next, distance, true);
                    break;
                }
                step = (0.4 * step.0, 0.4 * step.1);
            }
            if !moved || step.0.abs().max(step.1.abs()) < tolerance {
                break;
            }
        }
        let d = point - jet.point;
        let outward = jet.du.cross(jet.dv);
        let beyond = |at: f64, edge: f64, end: End, sign: f64| {
            end == End::Open && (at - edge).abs() < 1e-9 && sign * d.dot(jet.du) > 1e-6 * jet.du.length()
        };
        let beyond = beyond(u, 0.0, self.ends[0], -1.0) || beyond(u, 1.0, self.ends[1], 1.0);
        let height = d.dot(outward);
        let distance = if height < 0.0 { -d.length() } else { d.length() };
        Foot { u, v, distance, cosine: height / (d.length() * outward.length()), beyond }
    }

    /// True for a point within the body, at least `depth` (mm) deep.
    #[cfg(test)]
    fn contains(&self, point: DVec3, depth: f64) -> bool {
        let foot = self.foot(point);
        self.near(point) && !foot.beyond && foot.distance < -depth
    }

    /// On which side of the surface a point lies; and u and v of a place of the surface near it where one was looked up, which
    /// what is known of points near by may spare. That grows by what is found here.
    pub(crate) fn side(&self, point: DVec3, known: &mut Known) -> (Side, Option<(f64, f64)>) {
        if let Some(side) = known.side(point) {
            return (side, None);
        }
        let (index, square) = self.table.nearest(point, known.row);
        known.row = index / AROUND as usize;
        let (u, v) = place(index, self.table.along);
        let sound = !self.at_edge(index);
        if sound && let Some(side) = decided(self.table.steepness(index, point), STEEP) {
            known.add(self.clear(point, square, side));
            return (side, Some((u, v)));
        }
        if sound {
            let foot = self.refine_to(point, u, v, ROUGHLY);
            let sound = foot.distance.abs() > 1e-9 * self.table.cell && foot.u > 0.0 && foot.u < 1.0;
            if let Some(side) = decided(foot.cosine, UPRIGHT).filter(|_| sound) {
                return (side, Some((foot.u, foot.v)));
            }
        }
        let foot = self.refine(point, u, v);
        let side = if foot.beyond {
            Side::Beyond
        } else if foot.distance < 0.0 {
            Side::Inside
        } else {
            Side::Outside
        };
        (side, Some((foot.u, foot.v)))
    }

    /// True when a ball certainly lies outside.
    pub(crate) fn avoids(&self, center: DVec3, radius: f64, known: &mut Known) -> bool {
        let holds =
            |ball: &Clear| ball.side == Side::Outside && center.distance(ball.center) + radius < ball.radius;
        if known.balls.iter().flatten().any(holds) {
            return true;
        }
        let (index, square) = self.table.nearest(center, known.row);
        known.row = index / AROUND as usize;
        if self.at_edge(index) || decided(self.table.steepness(index, center), STEEP) != Some(Side::Outside) {
            return false;
        }
        let ball = self.clear(center, square, Side::Outside);
        known.add(ball);
        holds(&ball)
    }

    /// Whether a place of the table is so near to an end that points over it may lie beyond that, or over a pole.
    fn at_edge(&self, index: usize) -> bool {
        let row = index / AROUND as usize;
        let near = |end: usize, away: usize| away < if self.ends[end] == End::Open { EDGE } else { 1 };
        near(0, row) || near(1, self.table.along as usize - row)
    }

    /// The ball around a point, so far from the nearest place of the table, in which the side is the same.
    fn clear(&self, center: DVec3, square: f64, side: Side) -> Clear {
        let openings = self.table.openings.iter().map(|(at, radius)| center.distance(*at) - radius);
        let radius = openings.fold(square.sqrt() - self.table.cell, f64::min).max(0.0);
        Clear { center, radius, side }
    }

    /// The first of some points that lies within the body, at least `depth` (mm) deep.
    pub(crate) fn first_within(&self, points: impl IntoIterator<Item = DVec3>, depth: f64) -> Option<DVec3> {
        let mut known = Known::default();
        points.into_iter().find(|point| {
            if !self.near(*point) || self.side(*point, &mut known).0 != Side::Inside {
                return false;
            }
            let foot = self.foot(*point);
            !foot.beyond && foot.distance < -depth
        })
    }

    /// A place of the surface near a point, as u and v.
    pub(crate) fn place_near(&self, point: DVec3) -> (f64, f64) {
        place(self.table.nearest(point, self.table.rows.len() / 2).0, self.table.along)
    }

    /// Points all over the tube.
    pub(crate) fn all_over(&self) -> &[DVec3] {
        self.table.all_over.get_or_init(|| points(self.surface, 0.0).collect())
    }

    /// Where a line of another surface comes through this one: u on that line, and a place of this surface near it as the
    /// start; `None` where the steps of Newton do not find one between `low` and `high`.
    pub(crate) fn pierced(
        &self,
        line: impl Fn(f64) -> Jet,
        [low, high]: [f64; 2],
        (mut u, mut v): (f64, f64),
    ) -> Option<(f64, f64, f64)> {
        let mut t = high;
        let mut near = false;
        for _ in 0..MOST_STEPS {
            let (there, here) = (line(t), self.jet(u, v));
            let miss = here.point - there.point;
            let normal = here.du.cross(here.dv);
            let rise = there.du.dot(normal);
            // The line is to leave the body, not along its surface.
            if rise.is_nan() || rise <= FLAT * there.du.length() * normal.length() {
                return None;
            }
            let step = miss.dot(normal) / rise;
            let off = there.du * step - miss;
            let square = normal.length_squared();
            let (along, around) =
                (off.cross(here.dv).dot(normal) / square, here.du.cross(off).dot(normal) / square);
            (t, u, v) = (t + step, u + along, v + around);
            let inside = (low..=high).contains(&t) && (INSET..=1.0 - INSET).contains(&u);
            if !inside {
                return None;
            }
            if near {
                return Some((t, u, v));
            }
            near = step.abs() < NEARLY && along.abs().max(around.abs()) < NEARLY;
        }
        None
    }

    fn jet(&self, u: f64, v: f64) -> Jet {
        let inside = u.clamp(INSET, 1.0 - INSET);
        let jet = self.surface.jet(inside, v);
        if inside == u { jet } else { Jet { point: self.surface.point(u, v), ..jet } }
    }
}

/// Points all over a tube, from a share of its length on.
pub(crate) fn points(
    tube: &(impl ParametricSurface + ?Sized),
    from: f64,
) -> impl Iterator<Item = DVec3> + '_ {
    lines(from).flat_map(|u| around(tube, u))
}

/// Places along a tube at which it is asked whether it runs into another one, from a share of its length on.
pub(crate) fn lines(from: f64) -> impl Iterator<Item = f64> {
    let along = CROSSING[0];
    (0..=along).map(move |i| from + (1.0 - from) * f64::from(i) / f64::from(along))
}

/// Points around a tube at one of these.
pub(crate) fn around(tube: &(impl ParametricSurface + ?Sized), u: f64) -> impl Iterator<Item = DVec3> + '_ {
    let around = CROSSING[1];
    (0..around).map(move |k| tube.point(u, f64::from(k) / f64::from(around)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::analytic::TorusArc;

    /// Points all over a box, near the surface and far from it.
    fn everywhere() -> impl Iterator<Item = DVec3> {
        let at = |k: u32, of: f64| f64::from(k) / of - 0.5;
        (0..14_000).map(move |k| {
            DVec3::new(140.0 * at(k % 20, 19.0), 140.0 * at(k / 20 % 25, 24.0), 60.0 * at(k / 500, 27.0))
        })
    }

    #[test]
    fn the_nearest_place_is_that_of_all() {
        let tube = TorusArc { major: 40.0, minor: 11.0, angle: 2.0 };
        let table = Table::new(&tube, [End::Open; 2]);
        for point in everywhere().step_by(7) {
            let all = table.points.iter().map(|place| place.distance_squared(point)).enumerate();
            let least =
                all.fold((usize::MAX, f64::INFINITY), |it, next| if next.1 < it.1 { next } else { it });
            for first in [0, 3, 100] {
                assert_eq!(table.nearest(point, first), least, "{point}");
            }
        }
    }

    #[test]
    fn sides_are_those_of_feet() {
        let tube = TorusArc { major: 40.0, minor: 11.0, angle: 2.0 };
        for ends in [[End::Open; 2], [End::Closed; 2], [End::Open, End::Closed]] {
            let solid = Solid::new(&tube, ends);
            let mut known = Known::default();
            let mut inside = 0;
            for point in everywhere() {
                let foot = solid.foot(point);
                // Right behind the disk of an open end no foot tells.
                if (foot.u == 0.0 || foot.u == 1.0) && foot.cosine.abs() < 0.99 {
                    continue;
                }
                let side = match foot {
                    Foot { beyond: true, .. } => Side::Beyond,
                    Foot { distance, .. } if distance < 0.0 => Side::Inside,
                    _ => Side::Outside,
                };
                let (found, near) = solid.side(point, &mut known);
                let alike = near.is_none() && found == Side::Outside && side == Side::Beyond;
                assert!(alike || found == side, "{point} {foot:?} {found:?}");
                inside += u32::from(side == Side::Inside);
            }
            assert!(inside > 100, "{inside}");
            let first = everywhere().find(|point| solid.contains(*point, 2.0));
            assert!(first.is_some());
            assert_eq!(solid.first_within(everywhere(), 2.0), first);
        }
    }
}
