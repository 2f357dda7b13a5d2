//! Level lines laid flat: a field whose levels are planes across the axis of a tube, where those of the first one are tilted.

use super::Mesh;
use super::ends::{Ends, Tip};
use super::levels::{Levels, Lines};
use crate::shape::axis::{Axis, Station};
use crate::shape::ring::{Ring, gap};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Samples of a line by which its tilt is seen, and how unevenly lines lie.
const AROUND: usize = 16;
/// Lines that are off their planes by less than this (rows) stay as they are.
pub(super) const TILTED: f64 = 0.1;
/// How often lines are laid flat at most: the middles of tilted lines are a little off the axis.
const PASSES: u32 = 2;
/// Laid flat once more, lines may lie this much less evenly: the axis of a tube stays where it is. Where a body bulges to one
/// side, the middles of its lines are no axis, and run away.
const RUNS_AWAY: f64 = 1.1;
/// Flat lines may lie this much less evenly than tilted ones, unless the tube is this many times longer than thick: in an S the
/// tilted ones cut corners, and so they may on a body.
const UNEVEN: f64 = 1.03;
const SLIM: f64 = 8.0;
/// The area between them stays the same within this share.
const GAINED: f64 = 0.05;
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
            let Some(axis) = axis(lines).filter(|axis| axis.tilt >= TILTED * course.row) else { break };
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
        let Some(axis) = axis(&flat.lines) else { return false };
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

/// The axis of a tube; its first and its last line stay as they are.
fn axis(lines: &Lines) -> Option<Axis> {
    Axis::of(&lines.rings, &lines.levels, [true; 2])
}
