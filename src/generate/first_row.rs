//! The first row, a ring or a stretch of the helix, and the lengths that count its stitches.

use super::rows::Rows;
use super::sheet::{Foot, Shaped, Sheet};
use crate::ir::Gauge;
use crate::shape::ParametricSurface;
use glam::DVec3;

/// Fewest stitches of an open first row.
const LEAST_AROUND: f64 = 4.0;

/// Length of one turn of the helix on a surface of revolution.
pub(super) fn turn_length(surface: &dyn ParametricSurface, rows: &Rows, round: u32) -> f64 {
    const SAMPLES: u32 = 8;
    let mut length = 0.0;
    for k in 0..SAMPLES {
        let tau = f64::from(round) + (f64::from(k) + 0.5) / f64::from(SAMPLES);
        let half = 0.5 / f64::from(SAMPLES);
        let jet = surface.jet(rows.at(tau), tau);
        let slope = (rows.at(tau + half) - rows.at(tau - half)) * f64::from(SAMPLES);
        length += (jet.du * slope + jet.dv).length();
    }
    length / f64::from(SAMPLES)
}

/// Stitches of a magic ring: the girth one row from the pole, 4 to 8, and the customary 6 when that is within one.
pub(super) fn ring_size(surface: &dyn ParametricSurface, rows: &Rows, gauge: &Gauge) -> u32 {
    let u = rows.at(0.5);
    let girth: f64 = (0..24).map(|k| surface.jet(u, f64::from(k) / 24.0).dv.length()).sum::<f64>() / 24.0;
    let count = (girth / gauge.width).round().clamp(4.0, 8.0) as u32;
    if count.abs_diff(6) <= 1 { 6 } else { count }
}

/// Places of the first row, at equal arc length along the first turn of the helix (paper, section 3.2); their number
/// is a multiple of `step`.
pub(super) fn even_places(surface: &dyn ParametricSurface, rows: &Rows, width: f64, step: u32) -> Vec<f64> {
    const SAMPLES: usize = 720;
    let mut lengths = Vec::with_capacity(SAMPLES + 1);
    lengths.push(0.0);
    let mut before = surface.point(rows.at(0.0), 0.0);
    for i in 1..=SAMPLES {
        let tau = i as f64 / SAMPLES as f64;
        let point = surface.point(rows.at(tau), tau);
        lengths.push(lengths[i - 1] + point.distance(before));
        before = point;
    }
    let total = lengths[SAMPLES];
    let step = f64::from(step.max(1));
    let count = ((total / (width * step)).round() * step).max(LEAST_AROUND) as usize;
    let mut j = 0;
    (0..count)
        .map(|i| {
            let target = total * i as f64 / count as f64;
            while j + 1 < SAMPLES && lengths[j + 1] < target {
                j += 1;
            }
            let span = lengths[j + 1] - lengths[j];
            let share = if span > 0.0 { (target - lengths[j]) / span } else { 0.0 };
            (j as f64 + share) / SAMPLES as f64
        })
        .collect()
}

/// Places of `count` stitches around a turn, each in the middle of its share.
pub(super) fn centered_places(count: u32) -> impl Iterator<Item = f64> {
    (0..count).map(move |j| (f64::from(j) + 0.5) / f64::from(count))
}

/// Adds the first row on the helix.
pub(super) fn lay(
    surface: &dyn ParametricSurface,
    sheet: &mut Sheet,
    places: impl Iterator<Item = f64>,
    rows: &Rows,
) {
    for tau in places {
        let u = rows.at(tau);
        let jet = surface.jet(u, tau);
        let foot = Foot { u, v: tau, point: jet.point, du: jet.du, dv: jet.dv, along: DVec3::ZERO };
        let id = sheet.add(&foot, Shaped::No);
        if id > 0 {
            sheet.course(id - 1, id);
        }
    }
}
