//! A branch that begins as a part of its parent's surface: where it leaves it, and how its rows lie from there on.

use super::axis::Axis;
use super::branch::{ALONG, AROUND, Branch, Misfit, ROUNDED, TOGETHER, mean, soften, turn};
use super::ring::Ring;
use super::solid::{Foot, Solid};
use super::stack::Stack;
use super::{End, ParametricSurface};
use glam::DVec3;
use rayon::prelude::*;

/// How much longer than on average a line of a limb may be for a change of u; how exactly feet are followed along it (in u
/// and v); and steps by which the place is found where it leaves its parent.
const STRETCH: f64 = 2.0;
const NEARLY: f64 = 1e-5;
const BETWEEN: u32 = 5;
/// How far such a limb is continued back at most, against its distance; and least distance of its next row, in rows.
const BACK: f64 = 2.5;
const LEAST_STEP: f64 = 0.5;
/// A limb that leads away from its parent leads along its axis by at least this share.
const LEAST_PACE: f64 = 0.5;

impl Branch<Stack> {
    /// Cuts off a branch that begins as a part of its parent's surface. It is a branch where it lies farther than `reach`
    /// (mm) from the parent; from there it is continued straight back into it, and its rim is where it comes out.
    /// Rows of samples lie `row` (mm) apart or more. Otherwise as [`Branch::new`].
    pub(crate) fn leaving(
        surface: Stack,
        parent: &Solid<'_>,
        [width, give]: [f64; 2],
        reach: f64,
        row: f64,
    ) -> Result<Self, Misfit> {
        let (mut clear, mut feet) = clear_of(&surface, parent, reach)?;
        let girth = super::girth(&surface, mean(&clear), 32);
        soften(&mut clear, ROUNDED * width * AROUND as f64 / girth.max(1e-9));
        let clear = Branch::from_places(surface, &clear);
        let away: DVec3 = (0..AROUND).map(|k| clear.jet(0.0, turn(k, AROUND)).du.normalize_or_zero()).sum();
        let away = away.normalize_or_zero();
        let back: Vec<f64> = feet
            .par_iter_mut()
            .with_min_len(TOGETHER)
            .enumerate()
            .map(|(k, foot)| way_back(clear.point(0.0, turn(k, AROUND)), away, foot, parent, reach))
            .collect();
        let leaving = Leaving { clear, away, back, reach, row };
        let (stack, places) = leaving.flat().or_else(|| leaving.leaning()).ok_or(Misfit::Inside)?;
        let girth = super::girth(&stack, mean(&places), 32);
        let length = stack.length();
        Ok(Self::along(stack, places, &feet, [girth, length], [width, give]))
    }
}

/// A limb from where it is clear of its parent.
struct Leaving {
    clear: Branch<Stack>,
    /// Which way it leads there.
    away: DVec3,
    /// How far straight back its parent lies, at places around it.
    back: Vec<f64>,
    reach: f64,
    row: f64,
}

impl Leaving {
    /// The limb and the way back to its parent as one tube, and the places in it at which the parent lies; rows run as the
    /// limb's do.
    fn leaning(&self) -> Option<(Stack, Vec<f64>)> {
        let (clear, surface) = (&self.clear, &self.clear.surface);
        let far = self.back.iter().copied().fold(0.5 * self.reach, f64::max) + 0.5 * self.reach;
        let around = surface.rows().next().map_or(AROUND, <[DVec3]>::len);
        let line = |u: f64| -> Vec<DVec3> { (0..around).map(|k| clear.point(u, turn(k, around))).collect() };
        let first = line(0.0);
        let mut rows = vec![first.iter().map(|point| *point - self.away * far).collect(), first];
        let closed = surface.ends()[1] == End::Closed;
        // The rows of the branch where they lie, the first one not right beside its begin.
        let (places, least) = (surface.places(), LEAST_STEP * self.row / surface.length());
        let places = &places[..places.len() - usize::from(closed)];
        let rest = &places[places.partition_point(|place| *place <= clear.mean + least)..];
        rows.par_extend(rest.par_iter().map(|place| line((place - clear.mean) / (1.0 - clear.mean))));
        let pole = closed.then(|| surface.point(1.0, 0.0));
        let stack = Stack::of_rows(rows, [None, pole])?;
        let clear = stack.places().get(1).copied().unwrap_or(0.0);
        let places: Vec<f64> = self.back.iter().map(|back| clear * (1.0 - back / far)).collect();
        Some((stack, places))
    }

    /// The same with rows in planes across its axis, as those of a branch of a shape file are, also where its own lines lean
    /// because they follow what it grows from; `None` where it has no axis.
    fn flat(&self) -> Option<(Stack, Vec<f64>)> {
        let limb = Upright::new(self)?;
        let rim = |k: usize| {
            let begin = self.clear.rim(turn(k, AROUND)).0;
            limb.at(self.clear.surface.point(begin, turn(k, AROUND)), begin) - self.back[k] * limb.pace
        };
        let rims: Vec<f64> = (0..AROUND).map(rim).collect();
        let first = limb.axis.stations[0].at;
        let bottom = rims.iter().copied().fold(first, f64::min) - 0.5 * self.reach;
        let before = ((first - bottom) / self.row).ceil().max(1.0);
        let planes = (0..before as usize).map(|i| bottom + (first - bottom) * i as f64 / before);
        let planes: Vec<f64> = planes.chain(limb.axis.stations.iter().map(|station| station.at)).collect();
        let lines: Vec<Vec<DVec3>> = (0..limb.around)
            .into_par_iter()
            .with_min_len(TOGETHER)
            .map(|k| Some(limb.points(&planes, k, &limb.line(k)?)))
            .collect::<Option<_>>()?;
        let row = |i: usize| lines.iter().map(|line| line[i]).collect();
        let rows: Vec<Vec<DVec3>> = (0..planes.len()).map(row).collect();
        let surface = &self.clear.surface;
        let pole = (surface.ends()[1] == End::Closed).then(|| surface.point(1.0, 0.0));
        let count = rows.len() + usize::from(pole.is_some());
        let stack = Stack::of_rows(rows, [None, pole]).filter(|stack| stack.places().len() == count)?;
        let place = |at: f64| {
            let i = planes.partition_point(|plane| *plane <= at).clamp(1, planes.len() - 1);
            let [a, b] = [i - 1, i].map(|i| stack.places()[i]);
            a + (b - a) * (at - planes[i - 1]) / (planes[i] - planes[i - 1])
        };
        let places = rims.into_iter().map(place).collect();
        Some((stack, places))
    }
}

/// A place of a line along a limb: its u, and where along the axis the plane lies that it is in.
#[derive(Clone, Copy, Debug)]
struct Knot {
    at: f64,
    u: f64,
}

/// A limb with planes across its axis.
struct Upright<'l> {
    of: &'l Leaving,
    axis: Axis,
    /// Its rows of samples without its pole, their places, and how many samples each has.
    rows: Vec<&'l [DVec3]>,
    places: &'l [f64],
    around: usize,
    /// How far planes go on along the axis for each mm straight away from the parent.
    pace: f64,
}

impl<'l> Upright<'l> {
    fn new(of: &'l Leaving) -> Option<Self> {
        let surface = &of.clear.surface;
        let mut rows: Vec<&[DVec3]> = surface.rows().collect();
        rows.truncate(rows.len() - usize::from(surface.ends()[1] == End::Closed));
        let places = &surface.places()[..rows.len()];
        // The axis goes through lines that are clear of the parent all around.
        let clear = of.clear.range()[1];
        let whole = places.partition_point(|place| *place <= clear);
        let ring = |row: &&[DVec3]| Some((Ring::new(row.to_vec())?, 0.0));
        let rings: Vec<(Ring, f64)> = rows[whole..].iter().map(ring).collect::<Option<_>>()?;
        let axis = Axis::of(&rings, &places[whole..], [false, true])?;
        let first = axis.stations.first()?;
        let pace = of.away.dot(first.normal) / first.slope.dot(first.normal);
        let around = rows.first()?.len();
        (first.weight >= 1.0 && pace > LEAST_PACE).then_some(Self { of, axis, rows, places, around, pace })
    }

    /// Where along the axis a point of a row lies; before the first whole line the axis goes on straight.
    fn at(&self, p: DVec3, place: f64) -> f64 {
        let first = &self.axis.stations[0];
        let at = self.axis.moved(p, place.max(first.level));
        if at >= first.at {
            return at;
        }
        let straight = first.at + (p - first.middle).dot(first.normal) / first.slope.dot(first.normal);
        straight.min(first.at)
    }

    /// The `k`-th line along the limb from where it is clear of the parent; `None` where it turns back.
    fn line(&self, k: usize) -> Option<Vec<Knot>> {
        let v = turn(k, self.around);
        let surface = &self.of.clear.surface;
        let begin = self.of.clear.rim(v).0;
        let next = begin + LEAST_STEP * self.of.row / surface.length();
        let rest = self.places.partition_point(|place| *place <= next);
        let knot = |p: DVec3, u: f64| Knot { at: self.at(p, u), u };
        let mut line = Vec::with_capacity(self.rows.len() + 1 - rest);
        line.push(knot(surface.on_line(begin, k), begin));
        line.extend((rest..self.rows.len()).map(|i| knot(self.rows[i][k], self.places[i])));
        line.is_sorted_by(|a, b| a.at < b.at).then_some(line)
    }

    /// Where the `k`-th line passes planes, which rise.
    fn points(&self, planes: &[f64], k: usize, line: &[Knot]) -> Vec<DVec3> {
        let surface = &self.of.clear.surface;
        let (begin, end) = (surface.on_line(line[0].u, k), self.rows[self.rows.len() - 1][k]);
        let mut next = 0;
        let point = |plane: &f64| {
            next += line[next..].iter().take_while(|knot| knot.at <= *plane).count();
            match (next.checked_sub(1).map(|i| line[i]), line.get(next)) {
                (None, _) => begin - self.of.away * ((line[0].at - plane) / self.pace),
                (_, None) => end,
                (Some(a), Some(b)) => surface.on_line(a.u + (b.u - a.u) * (plane - a.at) / (b.at - a.at), k),
            }
        };
        planes.iter().map(point).collect()
    }
}

/// How far straight back from a point of a branch its parent lies, which is no farther from it than `reach`; 0 where it
/// lies beside that way. The foot moves there.
fn way_back(point: DVec3, axis: DVec3, foot: &mut Foot, parent: &Solid<'_>, reach: f64) -> f64 {
    let most = BACK * reach;
    let look = |back: f64, foot: &Foot| parent.refine_to(point - axis * back, foot.u, foot.v, NEARLY);
    let mut out = (0.0, look(0.0, foot));
    let mut step = out.1.distance.max(0.0);
    for _ in 0..BETWEEN {
        let next = (out.0 + step).min(most);
        let there = look(next, &out.1);
        if there.distance <= 0.0 {
            // Straight through the surface, or nearly.
            let share = out.1.distance / (out.1.distance - there.distance).max(1e-12);
            *foot = there;
            return out.0 + (next - out.0) * share;
        }
        let fall = (out.1.distance - there.distance) / (next - out.0).max(1e-12);
        step = 1.1 * there.distance / fall.max(0.25);
        out = (next, there);
        if there.distance < 1e-3 * reach {
            *foot = there;
            return next;
        }
        if next >= most {
            break;
        }
    }
    0.0
}

/// Where the lines of a surface lie farther than `reach` from the parent for the first time, and the feet there.
fn clear_of(surface: &Stack, parent: &Solid<'_>, reach: f64) -> Result<(Vec<f64>, Vec<Foot>), Misfit> {
    let length = super::length_along(surface, 0.0, 0.0..1.0, 8).max(1e-9);
    let mut feet: Vec<Foot> = Vec::with_capacity(AROUND);
    for k in 0..AROUND {
        let begin = surface.point(0.0, turn(k, AROUND));
        // Beside the foot of the line before, if it lies there.
        let beside = feet.last().map(|foot| parent.refine_to(begin, foot.u, foot.v, NEARLY));
        feet.push(beside.filter(|foot| foot.distance.abs() < reach).unwrap_or_else(|| parent.foot(begin)));
    }
    // Along a line from its begin: the last place within reach, `None` where it goes on to the end, and the foot there.
    let follow = |(k, mut foot): (usize, Foot)| {
        let v = turn(k, AROUND);
        let next_to = |u: f64, foot: &Foot| parent.refine_to(surface.point(u, v), foot.u, foot.v, NEARLY);
        let (mut near, mut far) = (0.0, None);
        while near < 1.0 {
            // As far as the line may go before it can be out of reach, if it does not stretch.
            let safe = (reach - foot.distance.abs()) / (STRETCH * length);
            let u = (near + safe.max(0.5 / f64::from(ALONG))).min(1.0);
            let next = next_to(u, &foot);
            if next.distance > reach {
                far = Some((u, next.distance));
                break;
            }
            (near, foot) = (u, next);
        }
        let Some(mut far) = far else { return (None, foot) };
        for _ in 0..BETWEEN {
            // The distance grows nearly evenly.
            let share = (reach - foot.distance) / (far.1 - foot.distance).max(1e-12);
            let middle = near + (far.0 - near) * share.clamp(0.05, 0.95);
            let next = next_to(middle, &foot);
            if next.distance > reach {
                far = (middle, next.distance);
            } else {
                (near, foot) = (middle, next);
            }
        }
        (Some(near), foot)
    };
    let followed = feet.into_par_iter().with_min_len(TOGETHER).enumerate().map(follow);
    let (places, feet): (Vec<Option<f64>>, Vec<Foot>) = followed.unzip();
    // A line that runs along the parent all the way leaves it where the last of the others does.
    let last = places.iter().flatten().copied().fold(0.0, f64::max);
    let lost = places.iter().filter(|place| place.is_none()).count();
    if lost * 4 > AROUND || last >= 0.9 {
        return Err(Misfit::Inside);
    }
    Ok((places.into_iter().map(|place| place.unwrap_or(last)).collect(), feet))
}
