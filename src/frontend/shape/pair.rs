//! `join = "split"`: two branches that a part divides into at its end.

use super::tube::Places;
use super::walk::Walk;
use crate::diag::{Code, Diagnostic};
use crate::ir::Gauge;
use crate::shape::ring::{Ring, gap};
use crate::shape::solid::Solid;
use crate::shape::split::share;
use crate::shape::stack::Stack;
use crate::shape::sweep::Sweep;
use crate::shape::{self, End, ParametricSurface, girth, length_along};
use glam::DVec3;

/// Samples of a loop.
const AROUND: usize = 256;
/// Loops to a stitch height, and most of one branch.
const LOOPS_A_ROW: f64 = 2.0;
const MOST_LOOPS: f64 = 2000.0;
/// Samples to a stitch width around.
const SAMPLES_A_STITCH: f64 = 1.5;
/// Share of a branch by which it has taken its own form.
const SETTLED: f64 = 0.3;
/// Share of a branch from which on it must lie outside of the other, and how deep (stitches) is inside.
const APART: f64 = 0.2;
const DEEP: f64 = 0.5;

/// One of the two.
pub(super) struct Leg {
    pub(super) name: String,
    pub(super) sweep: Sweep,
    pub(super) places: Places,
}

/// The surfaces of the two: each begins with its share of the last loop of `base`, and takes its own form from there.
pub(super) fn legs(
    walk: &mut Walk<'_>,
    base: &shape::Tube,
    legs: [Leg; 2],
    gauge: &Gauge,
) -> Option<[(Stack, Leg); 2]> {
    let line = |surface: &dyn ParametricSurface, u: f64| {
        Ring::new((0..AROUND).map(|k| surface.point(u, k as f64 / AROUND as f64)).collect())
    };
    let last = line(&*base.surface, 1.0)?;
    let [one, other] = legs;
    let toward = [line(&one.sweep, 0.0)?, line(&other.sweep, 0.0)?];
    let Some(shares) = share(&last, [&toward[0], &toward[1]]) else {
        let message =
            format!("the end of `{}` does not divide between `{}` and `{}`", base.name, one.name, other.name);
        walk.report(
            Diagnostic::new(Code::DividesOddly, message)
                .at(one.places.curve(), "begins here")
                .at(other.places.curve(), "and this one here")
                .help(
                    "let each begin beside the middle of that end, on its own side, and about half as wide",
                ),
        );
        return None;
    };
    let [first, second] = shares.rims;
    let stacks = [stack(&one, &first, gauge)?, stack(&other, &second, gauge)?];
    let inside = |from: &Stack, of: &Stack, leg: &Leg| {
        let body = Solid::new(of, [End::Open, leg.places.end]);
        let points = (0..=24).flat_map(|i| {
            let u = APART + (1.0 - APART) * f64::from(i) / 24.0;
            (0..24).map(move |k| from.point(u, f64::from(k) / 24.0))
        });
        body.first_within(points, DEEP * gauge.width)
    };
    let at: Option<DVec3> =
        inside(&stacks[0], &stacks[1], &other).or_else(|| inside(&stacks[1], &stacks[0], &one));
    if let Some(at) = at {
        let at = super::branch::coordinates(walk, at);
        walk.report(
            Diagnostic::new(
                Code::TubesCross,
                format!("`{}` and `{}` run through each other at {at}", one.name, other.name),
            )
            .at(one.places.curve(), "the curve of one")
            .at(other.places.curve(), "and of the other")
            .help("lead them farther apart, or make them thinner"),
        );
        return None;
    }
    let [left, right] = stacks;
    Some([(left, one), (right, other)])
}

/// From a rim to the loops of a sweep.
fn stack(leg: &Leg, rim: &Ring, gauge: &Gauge) -> Option<Stack> {
    let length = length_along(&leg.sweep, 0.0, 0.0..1.0, 8).max(1e-9);
    let count = (LOOPS_A_ROW * length / gauge.height).clamp(8.0, MOST_LOOPS).ceil();
    let ring =
        |u: f64| Ring::new((0..AROUND).map(|k| leg.sweep.point(u, k as f64 / AROUND as f64)).collect());
    let before = rim.samples(64, 0.0);
    let (off, _) = gap(&before, &ring(0.0)?.beside(&before));
    let from = (off.max(gauge.height) / length).min(SETTLED);
    let closed = leg.places.end == End::Closed;
    let mut rings = vec![rim.clone()];
    for k in 0..=count as u32 {
        let u = from + (1.0 - from) * f64::from(k) / count;
        if u < 1.0 - 1e-9 || !closed {
            rings.extend(ring(u));
        }
    }
    let pole = closed.then(|| leg.sweep.point(1.0, 0.0));
    let around =
        (SAMPLES_A_STITCH * girth(&leg.sweep, 0.5, 32).max(rim.length()) / gauge.width).clamp(48.0, 256.0);
    Stack::new(&rings, [None, pole], (around as usize).next_multiple_of(16))
}
