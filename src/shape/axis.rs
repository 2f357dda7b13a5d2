//! The axis of a tube that lines run around: planes across it, and where along the tube a point lies in one of them.

use super::ring::{Ring, gap};
use glam::DVec3;
use std::f64::consts::TAU;

/// Samples of a line by which its tilt is seen.
const AROUND: usize = 16;
/// Fewest lines that tell an axis.
const FEWEST: usize = 5;
/// A line is part of a tube where the axis goes on by at least this share of the way to the next one, and where its points lie
/// off its plane by at most this share of its radius.
const ADVANCE: f64 = 0.5;
const FARTHEST: f64 = 0.8;
/// On the inner side of a bend planes come no closer than this share of their distance at the axis.
const CLOSEST: f64 = 0.25;
/// Where lines begin to be laid flat, they come closer by at most this share.
const RAMP: f64 = 0.4;
/// Newton steps to the plane of a point, and the share of a stretch to within which it is found.
const STEPS: u32 = 6;
const NEAR: f64 = 1e-6;

/// The axis of a tube, from line to line.
pub(crate) struct Axis {
    pub(crate) stations: Vec<Station>,
    /// By how much the lines are off their planes at most, where they are to be laid flat.
    pub(crate) tilt: f64,
}

/// Where the axis passes a line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Station {
    /// The level of the line.
    pub(crate) level: f64,
    /// Mean length along the surface up to here.
    pub(crate) at: f64,
    pub(crate) middle: DVec3,
    /// By the length along the surface.
    pub(crate) slope: DVec3,
    /// Across the plane.
    pub(crate) normal: DVec3,
    /// How far lines are moved to their planes, from not at all to wholly.
    pub(crate) weight: f64,
}

impl Axis {
    /// The axis through the middles of lines at the given levels, each with its phase; `None` where they are too few, or one
    /// lies where another does. Lines at ends that are `held` stay as they are.
    pub(crate) fn of(rings: &[(Ring, f64)], levels: &[f64], held: [bool; 2]) -> Option<Self> {
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
        axis.weigh(rings, &samples, held);
        Some(axis)
    }

    /// Finds where lines are to be moved to their planes, and how far they are off.
    fn weigh(&mut self, rings: &[(Ring, f64)], samples: &[Vec<DVec3>], held: [bool; 2]) {
        let last = self.stations.len() - 1;
        // What is no tube stays as it is.
        let off = |i: usize| {
            let station = &self.stations[i];
            if (held[0] && i == 0) || (held[1] && i == last) || station.slope.length() < ADVANCE {
                return None;
            }
            let off = |p: &DVec3| self.place(*p, i, station.at).map(|at| (at - station.at).abs());
            let most = samples[i].iter().try_fold(0.0, |most: f64, p| off(p).map(|off| most.max(off)))?;
            (most <= FARTHEST * rings[i].0.length() / TAU).then_some(most)
        };
        let off: Vec<Option<f64>> = (0..=last).map(off).collect();
        // From what stays on, weights rise as fast as the lines can be moved.
        let mut weights = vec![1.0_f64; last + 1];
        let mut ramp = |order: &mut dyn Iterator<Item = usize>, held: bool| {
            let (mut weight, mut before) = (if held { 0.0 } else { 1.0 }, self.stations[0].at);
            for i in order {
                let step = (self.stations[i].at - before).abs();
                before = self.stations[i].at;
                weight = off[i].map_or(0.0, |off: f64| (weight + RAMP * step / off.max(1e-9)).min(1.0));
                weights[i] = weights[i].min(weight);
            }
        };
        ramp(&mut (0..=last), held[0]);
        ramp(&mut (0..=last).rev(), held[1]);
        let tilts = off.iter().zip(&weights).map(|(off, weight)| off.unwrap_or(0.0) * weight);
        self.tilt = tilts.fold(0.0, f64::max);
        for (station, weight) in self.stations.iter_mut().zip(weights) {
            station.weight = weight;
        }
    }

    /// Where along the tube a point of a level comes to lie.
    pub(crate) fn moved(&self, p: DVec3, level: f64) -> f64 {
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
