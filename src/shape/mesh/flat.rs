//! Level lines laid flat: a field whose levels are planes across the axis of a tube, where those of the first one are tilted.

use super::Mesh;
use super::ends::{Ends, Tip};
use super::levels::{Levels, Lines};
use crate::shape::ring::{Ring, gap};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Samples of a line by which its tilt is seen, and how unevenly lines lie.
const AROUND: usize = 16;
/// Fewest lines that tell an axis.
const FEWEST: usize = 5;
/// Lines that are off their planes by less than this (rows) stay as they are.
pub(super) const TILTED: f64 = 0.1;
/// How often lines are laid flat at most: the middles of tilted lines are a little off the axis.
const PASSES: u32 = 2;
/// A line is part of a tube where the axis goes on by at least this share of the way to the next one, and where its points lie
/// off its plane by at most this share of its radius.
const ADVANCE: f64 = 0.5;
const FARTHEST: f64 = 0.8;
/// On the inner side of a bend planes come no closer than this share of their distance at the axis.
const CLOSEST: f64 = 0.25;
/// Where lines begin to be laid flat, they come closer by at most this share.
const RAMP: f64 = 0.4;
/// Laid flat once more, lines may lie this much less evenly: the axis of a tube stays where it is. Where a body bulges to one
/// side, the middles of its lines are no axis, and run away.
const RUNS_AWAY: f64 = 1.1;
/// Flat lines may lie this much less evenly than tilted ones, unless the tube is this many times longer than thick: in an S the
/// tilted ones cut corners, and so they may on a body.
const UNEVEN: f64 = 1.03;
const SLIM: f64 = 8.0;
/// The area between them stays the same within this share.
const GAINED: f64 = 0.05;
/// Newton steps to the plane of a point, and the share of a stretch to within which it is found.
const STEPS: u32 = 6;
const NEAR: f64 = 1e-6;
/// How often the poles of a tube are moved to its axis, and from how far off it (rows).
const AIMS: u32 = 3;
const OFF: f64 = 0.3;
/// Fewest vertices that are worth being handed to another thread.
pub(super) const TOGETHER: usize = 512;

/// A limb from its first line to its last one.
pub(super) struct Course<'c> {
    /// The way down along which its lines are sought.
    pub(super) way: &'c [u32],
    /// How far lines lie from each other, and the height of a row.
    pub(super) spacing: f64,
    pub(super) row: f64,
    /// The lines that it begins and ends with, where they are given.
    pub(super) first: Option<Ring>,
    pub(super) last: Option<Ring>,
}

/// A tube whose lines have been laid flat.
pub(super) struct Flat {
    pub(super) lines: Lines,
    /// On the mesh that they were taken from.
    pub(super) field: Vec<f64>,
}

/// The axis of a tube, from line to line.
struct Axis {
    stations: Vec<Station>,
    /// By how much the lines are off their planes at most, where they are to be laid flat.
    tilt: f64,
}

/// Where the axis passes a line.
#[derive(Clone, Copy, Debug)]
struct Station {
    /// The level of the line.
    level: f64,
    /// Mean length along the surface up to here.
    at: f64,
    middle: DVec3,
    /// By the length along the surface.
    slope: DVec3,
    /// Across the plane.
    normal: DVec3,
    /// How far lines are moved to their planes, from not at all to wholly.
    weight: f64,
}

impl Levels<'_> {
    /// Lines along a limb.
    pub(super) fn along(&self, range: [f64; 2], course: &Course<'_>) -> Lines {
        self.stack(range, course.way, course.spacing, course.first.clone(), course.last.as_ref())
    }

    /// The lines of a tube laid flat; `None` where they are flat, or are no tube's. `given` is the mesh before it was made
    /// coarser, if it was.
    pub(super) fn laid_flat(&self, given: &Mesh, lines: &Lines, course: &Course<'_>) -> Option<Flat> {
        let level = Spread::of(&lines.rings);
        if let Some(fanned) = given.fanned(lines, &level, course) {
            return Some(fanned);
        }
        let even = |spread: &Spread| spread.uneven <= UNEVEN * level.uneven || level.slimness() >= SLIM;
        let sound = |(_, spread): &(Flat, Spread)| spread.covers(&level) && even(spread);
        let mut flat: Option<(Flat, Spread)> = None;
        for _ in 0..PASSES {
            let (lines, field) = match &flat {
                Some((flat, _)) => (&flat.lines, flat.field.as_slice()),
                None => (lines, self.field),
            };
            let Some(axis) = Axis::of(lines).filter(|axis| axis.tilt >= TILTED * course.row) else { break };
            let ends = [axis.stations.first()?.at, axis.stations.last()?.at];
            let vertices = (0..field.len()).into_par_iter().with_min_len(TOGETHER);
            let field: Vec<f64> = vertices.map(|v| axis.moved(self.mesh.point(v as u32), field[v])).collect();
            let lines = Levels { mesh: self.mesh, field: &field }.along(ends, course);
            let spread = Spread::of(&lines.rings);
            if flat.as_ref().is_some_and(|(_, before)| spread.uneven > RUNS_AWAY * before.uneven) {
                // On uneven triangles the middles sway: then those before are even enough.
                flat = flat.filter(|(_, before)| before.uneven <= level.uneven);
                break;
            }
            flat = Some((Flat { lines, field }, spread));
        }
        flat.filter(sound).map(|(flat, _)| flat)
    }
}

impl Mesh {
    /// Moves closed ends of a tube to where its axis comes out of the surface, where they may: the lines that told them were
    /// tilted, too. True when one was moved.
    pub(super) fn aim(&self, ends: &mut Ends, may: [bool; 2], flat: &Flat, row: f64) -> bool {
        if ends.aims >= AIMS {
            return false;
        }
        let Some(axis) = Axis::of(&flat.lines) else { return false };
        let mut moved = false;
        for side in [0, 1].into_iter().filter(|side| may[*side]) {
            let tip = if side == 0 { Some(&mut ends.start) } else { ends.others.first_mut() };
            let Some(tip) = tip.filter(|tip| !tip.open && !tip.between) else { continue };
            let Some(vertex) = self.pole(flat, tip, &axis, side) else { continue };
            if self.middle(tip).distance(self.point(vertex)) > OFF * row {
                tip.ring = vec![vertex];
                moved = true;
            }
        }
        ends.aims += u32::from(moved);
        moved
    }

    /// The vertex beyond the last flat line at which the axis comes out, if it goes on turning as it did before.
    fn pole(&self, flat: &Flat, tip: &Tip, axis: &Axis, side: usize) -> Option<u32> {
        let wholly = |station: &Station| station.weight >= 1.0;
        let (i, sign) = match side {
            0 => (axis.stations.iter().position(wholly)?, -1.0),
            _ => (axis.stations.iter().rposition(wholly)?, 1.0),
        };
        let station = &axis.stations[i];
        let way = station.normal * sign;
        let radius = flat.lines.rings.get(i)?.0.length() / TAU;
        let far = |other: &&Station| (station.at - other.at) * sign >= radius;
        let before = if side == 0 { axis.stations.iter().find(far) } else { axis.stations.iter().rfind(far) };
        let turn = before.map_or(DVec3::ZERO, |before| {
            (way - before.normal * sign).reject_from_normalized(way) / (station.at - before.at).abs()
        });
        let field: Vec<f64> = flat.field.iter().map(|value| value * sign).collect();
        let inside = self.reached(&field, station.at * sign, tip);
        let beyond = |v: u32| {
            let arm = self.point(v) - station.middle;
            let along = arm.dot(way);
            let off = arm - way * along - turn * (0.5 * along * along);
            (inside[v as usize] && along > 0.0).then_some((off.length_squared(), v))
        };
        let all = (0..self.points.len() as u32).filter_map(beyond);
        all.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, v)| v)
    }
}

/// How lines lie from one end to the other.
pub(super) struct Spread {
    /// Mean length along the surface, and the area.
    length: f64,
    area: f64,
    /// How much the distances of lines differ around them, as a share.
    pub(super) uneven: f64,
}

impl Spread {
    pub(super) fn of(rings: &[(Ring, f64)]) -> Self {
        let (mut length, mut area, mut sum) = (0.0, 0.0, 0.0);
        let mut before: Option<(Vec<DVec3>, f64)> = None;
        for (ring, phase) in rings {
            let (samples, girth) = (ring.samples(AROUND, *phase), ring.length());
            if let Some((before, thick)) = &before {
                let mean = gap(before, &samples).0;
                let off = before.iter().zip(&samples).map(|(a, b)| (a.distance(*b) - mean).abs());
                sum += off.sum::<f64>() / AROUND as f64;
                length += mean;
                area += 0.5 * mean * (thick + girth);
            }
            before = Some((samples, girth));
        }
        Self { length, area, uneven: sum / length.max(f64::MIN_POSITIVE) }
    }

    /// Whether these lines go over as much of the surface as others.
    pub(super) fn covers(&self, other: &Self) -> bool {
        (self.area / other.area - 1.0).abs() < GAINED
    }

    /// How many times longer than thick the tube is.
    fn slimness(&self) -> f64 {
        PI * self.length * self.length / self.area.max(f64::MIN_POSITIVE)
    }
}

impl Axis {
    /// The axis through the middles of lines; `None` where they are too few, or one lies where another does.
    fn of(Lines { rings, levels }: &Lines) -> Option<Self> {
        let samples: Vec<Vec<DVec3>> =
            rings.iter().map(|(ring, phase)| ring.samples(AROUND, *phase)).collect();
        let mut at = vec![0.0];
        at.extend(samples.windows(2).map(|pair| gap(&pair[0], &pair[1]).0).scan(0.0, |sum, step| {
            *sum += step;
            Some(*sum)
        }));
        let rises = |values: &[f64]| values.windows(2).all(|pair| pair[1] > pair[0]);
        if rings.len() < FEWEST || !rises(&at) || !rises(levels) {
            return None;
        }
        let middles: Vec<DVec3> = rings.iter().map(|(ring, _)| ring.center()).collect();
        let last = rings.len() - 1;
        let step = |i: usize| (middles[i + 1] - middles[i]) / (at[i + 1] - at[i]);
        let slope = |i: usize| match i {
            0 => step(0),
            i if i == last => step(last - 1),
            // That of the parabola through three middles.
            i => {
                let share = (at[i] - at[i - 1]) / (at[i + 1] - at[i - 1]);
                step(i - 1).lerp(step(i), share)
            }
        };
        let station = |i: usize| {
            let slope = slope(i);
            let normal = slope.normalize_or_zero();
            Station { level: levels[i], at: at[i], middle: middles[i], slope, normal, weight: 0.0 }
        };
        let mut axis = Self { stations: (0..=last).map(station).collect(), tilt: 0.0 };
        axis.weigh(rings, &samples);
        Some(axis)
    }

    /// Finds where lines are to be moved to their planes, and how far they are off.
    fn weigh(&mut self, rings: &[(Ring, f64)], samples: &[Vec<DVec3>]) {
        let last = self.stations.len() - 1;
        // The ends stay as they are, and so does what is no tube.
        let off = |i: usize| {
            let station = &self.stations[i];
            if i == 0 || i == last || station.slope.length() < ADVANCE {
                return None;
            }
            let off = |p: &DVec3| self.place(*p, i, station.at).map(|at| (at - station.at).abs());
            let most = samples[i].iter().try_fold(0.0, |most: f64, p| off(p).map(|off| most.max(off)))?;
            (most <= FARTHEST * rings[i].0.length() / TAU).then_some(most)
        };
        let off: Vec<Option<f64>> = (0..=last).map(off).collect();
        // From what stays on, weights rise as fast as the lines can be moved.
        let mut weights = vec![1.0_f64; last + 1];
        let mut ramp = |order: &mut dyn Iterator<Item = usize>| {
            let (mut weight, mut before) = (0.0, self.stations[0].at);
            for i in order {
                let step = (self.stations[i].at - before).abs();
                before = self.stations[i].at;
                weight = off[i].map_or(0.0, |off: f64| (weight + RAMP * step / off.max(1e-9)).min(1.0));
                weights[i] = weights[i].min(weight);
            }
        };
        ramp(&mut (0..=last));
        ramp(&mut (0..=last).rev());
        let tilts = off.iter().zip(&weights).map(|(off, weight)| off.unwrap_or(0.0) * weight);
        self.tilt = tilts.fold(0.0, f64::max);
        for (station, weight) in self.stations.iter_mut().zip(weights) {
            station.weight = weight;
        }
    }

    /// Where along the tube a point of a level comes to lie.
    fn moved(&self, p: DVec3, level: f64) -> f64 {
        let last = self.stations.len() - 1;
        let i = self.stations.partition_point(|other| other.level <= level).clamp(1, last) - 1;
        let (a, b) = (&self.stations[i], &self.stations[i + 1]);
        let t = (level - a.level) / (b.level - a.level);
        let at = a.at + (b.at - a.at) * t;
        let weight = a.weight + (b.weight - a.weight) * t;
        if weight <= 0.0 || !(0.0..=1.0).contains(&t) {
            return at;
        }
        self.place(p, i, at).map_or(at, |flat| at + (flat - at) * weight)
    }

    /// The place along the tube in whose plane a point lies, sought from another place behind station `i`; `None` where planes
    /// come too close to each other.
    fn place(&self, p: DVec3, mut i: usize, from: f64) -> Option<f64> {
        let last = self.stations.len() - 2;
        let mut at = from;
        for _ in 0..STEPS {
            i = i.min(last);
            while i < last && self.stations[i + 1].at <= at {
                i += 1;
            }
            while i > 0 && self.stations[i].at > at {
                i -= 1;
            }
            let (a, b) = (&self.stations[i], &self.stations[i + 1]);
            let width = b.at - a.at;
            let t = ((at - a.at) / width).clamp(-1.0, 2.0);
            let (t2, t3) = (t * t, t * t * t);
            let rise = b.middle - a.middle;
            let middle = a.middle
                + rise * (3.0 * t2 - 2.0 * t3)
                + (a.slope * (t - 2.0 * t2 + t3) + b.slope * (t3 - t2)) * width;
            let slope = rise * (6.0 * (t - t2) / width)
                + a.slope * (1.0 - 4.0 * t + 3.0 * t2)
                + b.slope * (3.0 * t2 - 2.0 * t);
            let turn = b.normal - a.normal;
            let normal = a.normal + turn * t;
            let arm = p - middle;
            let (pace, rate) = (slope.dot(normal), arm.dot(turn) / width);
            if pace - rate < CLOSEST * pace {
                return None;
            }
            let step = arm.dot(normal) / (pace - rate);
            at += step;
            if step.abs() < NEAR * width {
                break;
            }
        }
        at.is_finite().then_some(at)
    }
}
