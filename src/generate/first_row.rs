//! The first row, a ring or a stretch of the helix, and the lengths that count its stitches.

use super::rows::Rows;
use super::sheet::{Foot, Shaped, Sheet};
use super::stout::LEAST_LOOPS;
use crate::ir::Gauge;
use crate::shape::{ParametricSurface, girth};
use glam::DVec3;

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

/// Stitches of a magic ring: the girth one row from the pole, 5 to 8, and the customary 6 when that is within one.
pub(super) fn ring_size(surface: &dyn ParametricSurface, rows: &Rows, gauge: &Gauge) -> u32 {
    let count =
        (girth(surface, rows.at(0.5), 24) / gauge.width).round().clamp(LEAST_LOOPS as f64, 8.0) as u32;
    if count.abs_diff(6) <= 1 { 6 } else { count }
}

/// Places of the first row, at equal arc length along the first turn of the helix (paper, section 3.2); their number
/// is a multiple of `step`.
pub(super) fn even_places(surface: &dyn ParametricSurface, rows: &Rows, width: f64, step: u32) -> Vec<f64> {
    const A_STITCH: f64 = 4.0;
    const RANGE: [f64; 2] = [96.0, 720.0];
    let stitches = girth(surface, rows.at(0.5), 24) / width;
    let samples = (A_STITCH * stitches).clamp(RANGE[0], RANGE[1]).round() as usize;
    let mut lengths = Vec::with_capacity(samples + 1);
    let mut total = 0.0;
    lengths.push(total);
    let mut before = surface.point(rows.at(0.0), 0.0);
    for i in 1..=samples {
        let tau = i as f64 / samples as f64;
        let point = surface.point(rows.at(tau), tau);
        total += point.distance(before);
        lengths.push(total);
        before = point;
    }
    let step = f64::from(step.max(1));
    let count = ((total / (width * step)).round() * step).max(LEAST_LOOPS as f64) as usize;
    let mut j = 0;
    (0..count)
        .map(|i| {
            let target = total * i as f64 / count as f64;
            while j + 1 < samples && lengths[j + 1] < target {
                j += 1;
            }
            let span = lengths[j + 1] - lengths[j];
            let share = if span > 0.0 { (target - lengths[j]) / span } else { 0.0 };
            (j as f64 + share) / samples as f64
        })
        .collect()
}

/// Places of `count` stitches around a turn, each in the middle of its share.
pub(super) fn centered_places(count: u32) -> impl Iterator<Item = f64> {
    (0..count).map(move |j| (f64::from(j) + 0.5) / f64::from(count))
}

/// The place of a first row that is picked up from points beside the start of a surface: where around it that row begins,
/// and its stitches on the surface turned so, the row before the helix.
pub(super) fn picked_up(surface: &dyn ParametricSurface, points: &[DVec3]) -> (f64, Vec<Foot>) {
    const SAMPLES: usize = 512;
    let line: Vec<DVec3> = (0..SAMPLES).map(|k| surface.point(0.0, k as f64 / SAMPLES as f64)).collect();
    // The foot of a point on the line, sought from a sample on for so many.
    let foot = |point: DVec3, from: usize, reach: usize| {
        let mut best = (f64::INFINITY, 0.0);
        for k in from..from + reach {
            let (a, b) = (line[k % SAMPLES], line[(k + 1) % SAMPLES]);
            let t = ((point - a).dot(b - a) / (b - a).length_squared().max(1e-300)).clamp(0.0, 1.0);
            let distance = a.lerp(b, t).distance_squared(point);
            if distance < best.0 {
                best = (distance, (k as f64 + t) / SAMPLES as f64);
            }
        }
        best.1
    };
    let turn = points.first().map_or(0.0, |point| foot(*point, 0, SAMPLES));
    let mut last = turn;
    let feet = points.iter().map(|point| {
        // They follow each other once around.
        let rest = ((turn + 1.0 - last) * SAMPLES as f64).ceil().max(1.0) as usize;
        last = foot(*point, (last * SAMPLES as f64) as usize, rest.min(SAMPLES / 2)).clamp(last, turn + 1.0);
        let (u, v) = nearest(surface, *point, last);
        let jet = surface.jet(u, v);
        Foot { u, v: v - turn - 1.0, point: *point, du: jet.du, dv: jet.dv, along: DVec3::ZERO }
    });
    let feet = feet.collect();
    (turn, feet)
}

/// The place halfway around the start of a surface from v = 0, along the line there, in turns.
pub(super) fn opposite(surface: &dyn ParametricSurface) -> f64 {
    const SAMPLES: u32 = 256;
    let at = |k: u32| surface.point(0.0, f64::from(k) / f64::from(SAMPLES));
    let total: f64 = (0..SAMPLES).map(|k| at(k).distance(at(k + 1))).sum();
    let mut length = 0.0;
    for k in 0..SAMPLES {
        let step = at(k).distance(at(k + 1));
        if length + step >= 0.5 * total {
            return (f64::from(k) + (0.5 * total - length) / step.max(1e-300)) / f64::from(SAMPLES);
        }
        length += step;
    }
    0.5
}

/// The place of the surface next to a point beside its start, sought from a place on the line there.
fn nearest(surface: &dyn ParametricSurface, point: DVec3, line: f64) -> (f64, f64) {
    const STEPS: u32 = 12;
    const MOST: f64 = 0.05;
    let (mut u, mut v) = (0.0, line);
    let mut jet = surface.jet(u, v);
    for _ in 0..STEPS {
        let (x, y) = super::sheet::pull_back(jet.du, jet.dv, point - jet.point);
        let long = (x.abs().max(y.abs()) / MOST).max(1.0);
        let (mut x, mut y) = (x / long, y / long);
        let mut moved = false;
        for _ in 0..5 {
            let next = surface.jet(u + x, v + y);
            if next.point.distance_squared(point) < jet.point.distance_squared(point) {
                (u, v, jet, moved) = (u + x, v + y, next, true);
                break;
            }
            (x, y) = (0.4 * x, 0.4 * y);
        }
        if !moved {
            break;
        }
    }
    (u, v)
}

/// How many rows a first row that is picked up lies farther along the tube than the end of a helix does.
pub(super) fn lead(surface: &dyn ParametricSurface, feet: &[Foot], height: f64) -> f64 {
    let past = |foot: &Foot| {
        let jet = surface.jet(0.0, foot.v);
        (foot.point - jet.point).dot(jet.du.normalize_or_zero()) / height
    };
    let mean = feet.iter().map(past).sum::<f64>() / feet.len().max(1) as f64;
    (mean + 0.5).clamp(-0.5, 1.5)
}

/// Adds a first row that is picked up.
pub(super) fn lay_picked_up(sheet: &mut Sheet, feet: &[Foot]) {
    for foot in feet {
        let id = sheet.add(foot, Shaped::No);
        if id > 0 {
            sheet.course(id - 1, id);
        }
    }
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
