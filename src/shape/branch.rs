//! Where a branch leaves its parent: the rim in which the two tubes meet, and the part of the branch beyond it.

use super::beads::Beads;
use super::solid::{Foot, Known, Side, Solid, around, lines};
use super::{Jet, ParametricSurface};
use crate::math;
use glam::DVec3;
use rayon::prelude::*;

/// Places around a branch at which its rim is sought.
pub(super) const AROUND: usize = 64;
/// Fewest of them that are worth being handed to another thread.
pub(super) const TOGETHER: usize = 8;
/// Steps along a branch in which its way out of the parent is sought.
pub(super) const ALONG: u32 = 48;
/// How far a branch that begins on the surface of its parent may be continued backward into it, in its own girths.
const BACKWARD: f64 = 0.75;
/// Depth (mm) at which tubes that touch begin to cross.
const TOUCH: f64 = 1e-3;
/// Share of a branch next to its rim that is not asked whether it lies in the parent.
const RIM: f64 = 0.1;
/// Reach (stitch widths) over which a rim is rounded: yarn makes no finer corners.
pub(super) const ROUNDED: f64 = 1.2;
/// Halvings by which the way out of the parent is found between two looks, and the distance (in u) from it at which rounding
/// decides on which side a place lies.
const HALVINGS: u32 = 40;
const ROUNDING: f64 = 2e-15;

/// Why a tube is no branch of another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Misfit {
    /// It does not touch its parent.
    Apart {
        /// Least distance of the two, in mm.
        distance: f64,
    },
    /// It leaves the parent on some sides only: it is too wide, or too far to one side.
    Beside {
        /// Share of its girth that does not come out of the parent.
        share: f64,
    },
    /// It leaves through an open end of the parent.
    OpenEnd,
    /// It does not come out of the parent.
    Inside,
    /// It comes back into its parent.
    Returns {
        /// Where, in mm.
        at: DVec3,
    },
}

/// The visible part of a branch: S'(u, v) = S(m + (1 - m) u + (u0(v) - m) b(u), v), where S(u0(v), v) is the rim on the
/// parent and m the mean of u0. The rows follow the rim at first and come level toward the tip, as b falls from 1 to 0.
#[derive(Debug)]
pub struct Branch<S> {
    pub(super) surface: S,
    /// u0 at evenly spaced v, and its slope there.
    rim: Vec<[f64; 2]>,
    pub(super) mean: f64,
    /// b(u) = (1 - u) (1 - q u): with q = 1 rows come level soon, with q = 0 as late as can be.
    ease: f64,
    /// v at which the branch begins, in turns.
    phase: f64,
}

impl<S: ParametricSurface> Branch<S> {
    /// Cuts a branch off at the surface of its parent. Rims have no corners finer than a stitch of
    /// `width` (mm), and rows may lie off them by `give` stitches, for fabric yields. The surface lies within the beads.
    ///
    /// The line v = 0 begins at the place of the rim that a round of the parent comes to first.
    pub(crate) fn new(
        surface: S,
        beads: &Beads,
        parent: &Solid<'_>,
        [width, give]: [f64; 2],
    ) -> Result<Self, Misfit> {
        let girth = super::girth(&surface, 0.0, 32);
        let length = super::length_along(&surface, 0.0, 0.0..1.0, 8).max(1e-9);
        let back = BACKWARD * girth / length;
        // Lines beside each other share what they find.
        let ways = |first: usize| -> Vec<Way> {
            let mut known = Known::default();
            let lines = first..(first + TOGETHER).min(AROUND);
            lines.map(|k| Way::out(&surface, parent, turn(k, AROUND), back, &mut known)).collect()
        };
        let ways: Vec<Vec<Way>> =
            (0..AROUND.div_ceil(TOGETHER)).into_par_iter().map(|k| ways(k * TOGETHER)).collect();
        let mut outs = Vec::with_capacity(AROUND);
        for way in ways.iter().flatten() {
            match *way {
                Way::Out(u, foot) => outs.push((u, foot)),
                Way::Never => {}
                Way::OpenEnd => return Err(Misfit::OpenEnd),
                Way::Inside => return Err(Misfit::Inside),
            }
        }
        if outs.is_empty() {
            let lines = (0..AROUND).map(|k| distance(&surface, parent, turn(k, AROUND), back));
            return Err(Misfit::Apart { distance: lines.fold(f64::INFINITY, f64::min) });
        }
        if outs.len() < AROUND {
            return Err(Misfit::Beside { share: 1.0 - outs.len() as f64 / AROUND as f64 });
        }
        let places: Vec<f64> = outs.iter().map(|out| out.0).collect();
        let sharp = Self { rim: with_slopes(&places), mean: mean(&places), ease: 0.0, phase: 0.0, surface };
        let outside = beads.outside(parent);
        let [low, high] = sharp.range();
        let near = lines(RIM).filter(|u| {
            // Rows lie between those of the least and of the greatest place of the rim.
            let [low, high] = [low, high].map(|place| place + (1.0 - place) * u);
            !outside.between(low, high)
        });
        if let Some(at) = parent.first_within(near.flat_map(|u| around(&sharp, u)), TOUCH) {
            return Err(Misfit::Returns { at });
        }
        let feet: Vec<Foot> = outs.iter().map(|out| out.1).collect();
        Ok(Self::along(sharp.surface, places, &feet, [girth, length], [width, give]))
    }

    /// A branch whose lines begin at the given places, on these feet, with a rim that is rounded and leveled.
    pub(super) fn along(
        surface: S,
        mut places: Vec<f64>,
        feet: &[Foot],
        [girth, length]: [f64; 2],
        [width, give]: [f64; 2],
    ) -> Self {
        soften(&mut places, ROUNDED * width * AROUND as f64 / girth.max(1e-9));
        level(&mut places, give * width / length);
        Self { phase: first_met(feet), ..Self::from_places(surface, &places) }
    }

    /// A branch whose lines begin at the given places.
    pub(super) fn from_places(surface: S, places: &[f64]) -> Self {
        let mean = mean(places);
        let highest = places.iter().copied().fold(mean, f64::max);
        // Rows nowhere come nearer to each other than a fifth of their mean distance.
        let ease = (0.8 * (1.0 - mean) / (highest - mean).max(1e-9) - 1.0).clamp(0.0, 1.0);
        Self { rim: with_slopes(places), mean, ease, phase: 0.0, surface }
    }

    /// Least and greatest place of the rim; a cubic may swing out a little between its places.
    pub(super) fn range(&self) -> [f64; 2] {
        let swing = self.rim.iter().map(|[_, slope]| 0.5 * slope.abs()).fold(0.0, f64::max);
        let places = self.rim.iter().map(|[place, _]| *place);
        let (low, high) =
            places.fold((f64::INFINITY, f64::NEG_INFINITY), |it, place| (it.0.min(place), it.1.max(place)));
        [low - swing, high + swing]
    }

    /// The part of the surface's beads that holds the branch; `None` for one that begins before them.
    pub(crate) fn beads(&self, beads: Beads) -> Option<Beads> {
        beads.from(self.range()[0])
    }

    /// The underlying u at a visible u, with its slopes by u and v.
    fn place(&self, u: f64, v: f64) -> (f64, f64, f64) {
        let (rim, slope) = self.rim(v);
        let (rest, off) = (1.0 - u, rim - self.mean);
        let (b, fall) = (rest * (1.0 - self.ease * u), -1.0 - self.ease + 2.0 * self.ease * u);
        (self.mean + (1.0 - self.mean) * u + off * b, 1.0 - self.mean + off * fall, slope * b)
    }

    /// u0 and its slope.
    pub(super) fn rim(&self, v: f64) -> (f64, f64) {
        let count = self.rim.len();
        let x = (v - v.floor()) * count as f64;
        let before = (x as usize).min(count - 1);
        let t = x - before as f64;
        let ([a, da], [b, db]) = (self.rim[before], self.rim[(before + 1) % count]);
        let rise = b - a;
        let (square, cube) = (3.0 * rise - 2.0 * da - db, da + db - 2.0 * rise);
        (a + t * (da + t * (square + t * cube)), (da + t * (2.0 * square + t * 3.0 * cube)) * count as f64)
    }
}

impl<S: ParametricSurface> ParametricSurface for Branch<S> {
    fn point(&self, u: f64, v: f64) -> DVec3 {
        let v = v + self.phase;
        self.surface.point(self.place(u, v).0, v)
    }

    fn jet(&self, u: f64, v: f64) -> Jet {
        let v = v + self.phase;
        let (place, along, around) = self.place(u, v);
        let jet = self.surface.jet(place, v);
        Jet { point: jet.point, du: jet.du * along, dv: jet.dv + jet.du * around }
    }
}

/// The `k`-th of so many places around, in turns.
pub(super) fn turn(k: usize, of: usize) -> f64 {
    k as f64 / of as f64
}

/// Where a tube runs into another one, if it does; in mm.
pub(crate) fn crossing(tube: &Solid<'_>, other: &Solid<'_>) -> Option<DVec3> {
    other.first_within(tube.all_over().iter().copied(), TOUCH)
}

/// How one line of a branch leaves its parent.
enum Way {
    /// At this u, over this place of the parent.
    Out(f64, Foot),
    /// It never is inside.
    Never,
    OpenEnd,
    Inside,
}

/// Places at which a line is looked at that begins outside: backward, for a branch that begins on the surface goes back into
/// its parent, and then forward, for only one that begins apart reaches it later.
fn looks(back: f64) -> impl Iterator<Item = f64> {
    let step = 1.0 / f64::from(ALONG);
    let backward = (1..=ALONG).map(move |k| -back * f64::from(k) * step);
    backward.chain((1..ALONG).map(move |k| f64::from(k) * step))
}

/// Least distance of a line from a parent that it does not touch.
fn distance(surface: &dyn ParametricSurface, parent: &Solid<'_>, v: f64, back: f64) -> f64 {
    let places = std::iter::once(0.0).chain(looks(back));
    places.map(|u| parent.foot(surface.point(u, v)).distance.abs()).fold(f64::INFINITY, f64::min)
}

impl Way {
    fn out(
        surface: &dyn ParametricSurface,
        parent: &Solid<'_>,
        v: f64,
        back: f64,
        known: &mut Known,
    ) -> Self {
        let mut at = |u: f64| parent.side(surface.point(u, v), known);
        let step = 1.0 / f64::from(ALONG);
        let mut last = 0.0;
        if at(0.0).0 != Side::Inside {
            let mut out = 0.0;
            let mut found = false;
            for u in looks(back) {
                if u > 0.0 && out < 0.0 {
                    out = 0.0;
                }
                let (side, near) = at(u);
                if side == Side::Inside {
                    if u < 0.0 {
                        return Self::between(parent, surface, v, [u, out], near);
                    }
                    (found, last) = (true, u);
                    break;
                }
                out = u;
            }
            if !found {
                return Self::Never;
            }
        }
        let start = (last / step) as u32 + 1;
        for u in (start..=ALONG).map(|k| f64::from(k) * step) {
            match at(u) {
                (Side::Inside, _) => last = u,
                (Side::Beyond, _) => return Self::OpenEnd,
                (Side::Outside, None) if parent.foot(surface.point(u, v)).beyond => return Self::OpenEnd,
                (Side::Outside, near) => return Self::between(parent, surface, v, [last, u], near),
            }
        }
        Self::Inside
    }

    /// The way out between a place inside and one outside.
    fn between(
        parent: &Solid<'_>,
        surface: &dyn ParametricSurface,
        v: f64,
        [mut inside, mut outside]: [f64; 2],
        near: Option<(f64, f64)>,
    ) -> Self {
        let near = near.unwrap_or_else(|| parent.place_near(surface.point(outside, v)));
        let place = parent.pierced(|u| surface.jet(u, v), [inside, outside], near);
        let begin = outside;
        let start = || parent.foot(surface.point(begin, v));
        let mut foot = None;
        // The interval is halved until rounding stops it, looking only where the place found does not tell the side.
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            match place {
                Some((out, ..)) if middle < out - ROUNDING => inside = middle,
                Some((out, ..)) if middle > out + ROUNDING => outside = middle,
                _ => {
                    let (u, v_on) = place.map_or_else(
                        || {
                            let foot: &Foot = foot.get_or_insert_with(start);
                            (foot.u, foot.v)
                        },
                        |(_, u, v)| (u, v),
                    );
                    let next = parent.refine(surface.point(middle, v), u, v_on);
                    if next.distance < 0.0 {
                        inside = middle;
                    } else {
                        (outside, foot) = (middle, Some(next));
                    }
                }
            }
        }
        let foot = match place {
            Some((_, u, v_on)) => parent.refine(surface.point(outside, v), u, v_on),
            None => foot.unwrap_or_else(start),
        };
        if foot.beyond { Self::OpenEnd } else { Self::Out(outside, foot) }
    }
}

/// Rounds off what is finer than `reach` places: binomial smoothing of that deviation.
pub(super) fn soften(places: &mut [f64], reach: f64) {
    let count = places.len();
    // One pass has a variance of 1/2.
    for _ in 0..((2.0 * reach * reach).round() as usize).min(4 * count) {
        let before = places.to_vec();
        for (k, place) in places.iter_mut().enumerate() {
            *place = 0.25 * (before[(k + count - 1) % count] + 2.0 * before[k] + before[(k + 1) % count]);
        }
    }
}

/// Brings values nearer to their mean, by `give` at most.
fn level(places: &mut [f64], give: f64) {
    let mean = mean(places);
    for place in places {
        let off = *place - mean;
        *place -= off.signum() * give * (1.0 - math::exp(-off.abs() / give.max(1e-12)));
    }
}

pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Values with the slopes of a periodic cubic through them, a place.
fn with_slopes(places: &[f64]) -> Vec<[f64; 2]> {
    let count = places.len();
    (0..count)
        .map(|k| [places[k], 0.5 * (places[(k + 1) % count] - places[(k + count - 1) % count])])
        .collect()
}

/// The place of a rim, in turns, that a round of the parent comes to first: the one of least v on the parent, halfway up.
fn first_met(feet: &[Foot]) -> f64 {
    let turn = |v: f64| v - v.round();
    let origin = feet.first().map_or(0.0, |foot| foot.v);
    let mean = feet.iter().map(|foot| turn(foot.v - origin)).sum::<f64>() / feet.len().max(1) as f64;
    let least = feet
        .iter()
        .enumerate()
        .min_by(|a, b| turn(a.1.v - origin - mean).total_cmp(&turn(b.1.v - origin - mean)));
    least.map_or(0.0, |(k, _)| k as f64 / feet.len() as f64)
}
