//! The rules of the paper's own algorithm (sections 3.2 and 3.3), built from its text, for comparison.
//!
//! New vertices lie straight above their bases, one stitch height up or on the helix where that is near; where the way up
//! to the helix takes three stitches or more, a short row fills it (activation and tolerance thresholds, at least four
//! stitches); the distance to the vertex before decides between plain stitch, increase and decrease. Nothing is relaxed.
//! The text leaves the thresholds open: short rows take three heights to open and one and a half to merge, and a stitch is
//! split or joined where two, or none, fit the gap better than one; what is left of the gap is carried on.

use super::options::{Options, Preset};
use super::rows::Rows;
use super::sheet::{Foot, Shaped};
use super::staircase::Shaping;
use crate::shape::ParametricSurface;
use std::ops::Range;

/// Way up, in stitch heights, from which a vertex asks for a short row.
const ACTIVATION: f64 = 3.0;
/// Way up that all vertices between two of these must have for one short row over all.
const TOLERANCE: f64 = 1.5;
/// The helix draws a vertex that comes this near to it, in stitch heights.
const SNAP: f64 = 0.3;
/// Least stitches of a short row.
const LEAST: usize = 4;
/// Steps of the polyline along which the way up is measured.
const STEPS: u32 = 3;

/// Added to missing heights.
pub(super) const EAGER: f64 = 0.15;

/// Options under which the generator follows the paper.
pub(super) fn options(base: &Options) -> Options {
    Options {
        preset: Preset::Std,
        paper: true,
        min_short_row: LEAST as u32,
        max_short_row: 0.9,
        activation: 1.6,
        tolerance: 0.5,
        window: 6,
        window_sweeps: 0,
        sweeps: if base.settle { base.sweeps } else { 0 },
        squareness: base.squareness,
        tries: 1,
        symmetric: false,
        short_rows: base.short_rows,
        hand: base.hand,
        lean: base.lean,
        ..Options::default()
    }
}

/// The feet of a row of bases at (u, v), up to the first whose target lies above the last row.
pub(super) fn feet(
    surface: &dyn ParametricSurface,
    rows: &Rows,
    height: f64,
    bases: impl Iterator<Item = (f64, f64)>,
) -> Vec<Foot> {
    let bases: Vec<(f64, f64)> = bases.take_while(|(_, v)| v + 1.0 <= rows.count).collect();
    let ways: Vec<f64> = bases.iter().map(|&(u, v)| way(surface, u, rows.at(v + 1.0), v) / height).collect();
    let raised = short_rows(&ways);
    let foot = |(i, &(u, v)): (usize, &(f64, f64))| {
        let raised = raised.iter().any(|run| run.contains(&i));
        let share = if !raised && ways[i] < 1.0 + SNAP { 1.0 } else { 1.0 / ways[i] };
        let u = u + (rows.at(v + 1.0) - u) * share;
        let jet = surface.jet(u, v);
        Foot { u, v: v + 1.0, point: jet.point, du: jet.du, dv: jet.dv, along: jet.dv.normalize_or_zero() }
    };
    bases.iter().enumerate().map(foot).collect()
}

/// The way along the surface from one place to another at the same v.
fn way(surface: &dyn ParametricSurface, from: f64, to: f64, v: f64) -> f64 {
    let at = |step: u32| surface.point(from + (to - from) * f64::from(step) / f64::from(STEPS), v);
    (0..STEPS).map(|step| at(step).distance(at(step + 1))).sum()
}

/// The runs of bases under short rows (paper, figure 7).
fn short_rows(ways: &[f64]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for (i, _) in ways.iter().enumerate().filter(|(_, way)| **way >= ACTIVATION) {
        match runs.last_mut() {
            Some(run) if ways[run.end..i].iter().all(|way| *way >= TOLERANCE) => run.end = i + 1,
            _ => runs.push(i..i + 1),
        }
    }
    runs.retain(|run| run.len() >= LEAST);
    runs
}

/// Shaping from the distance to the vertex before, and what is left of it. A decrease joins a plain stitch.
pub(super) fn shape(gaps: &[f64], below: &[Shaped], plan: &mut Vec<Shaping>, rest: &mut Vec<f64>) {
    plan.clear();
    rest.clear();
    let mut carried = 0.0;
    for (i, gap) in gaps.iter().enumerate() {
        let distance = gap + carried;
        let joins = i > 0 && plan[i - 1] == Shaping::Plain && below[i] != Shaped::Inc;
        let shaping = match distance {
            _ if i == 0 => Shaping::Plain,
            1.5.. => Shaping::Inc,
            ..0.5 if joins => Shaping::Dec,
            _ => Shaping::Plain,
        };
        carried = match shaping {
            Shaping::Plain => distance - 1.0,
            Shaping::Inc => distance - 2.0,
            Shaping::Dec => distance,
        };
        carried = carried.clamp(-2.0, 2.0);
        plan.push(shaping);
        rest.push(carried);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn close_hills_merge_and_small_ones_are_dropped() {
        let hill = |way: f64, n: usize| vec![way; n];
        let row = [
            hill(1.0, 5),
            hill(3.2, 4),
            hill(2.0, 3),
            hill(3.5, 4),
            hill(1.0, 9),
            hill(3.1, 3),
            hill(1.0, 5),
        ];
        assert_eq!(short_rows(&row.concat()), vec![5..16]);
        let apart = [hill(3.2, 4), hill(1.4, 3), hill(3.5, 4)].concat();
        assert_eq!(short_rows(&apart), vec![0..4, 7..11]);
    }

    #[test]
    fn the_net_shaping_follows_the_gaps() {
        let net = |gap: f64, n: usize| {
            let (mut plan, mut rest) = (Vec::new(), Vec::new());
            shape(&vec![gap; n], &vec![Shaped::No; n], &mut plan, &mut rest);
            let count = |kind| plan.iter().filter(|shaping| **shaping == kind).count();
            (count(Shaping::Inc), count(Shaping::Dec))
        };
        assert_eq!(net(1.0, 40), (0, 0));
        assert_eq!(net(1.2, 30), (6, 0));
        assert_eq!(net(0.8, 30), (0, 6));
    }
}
