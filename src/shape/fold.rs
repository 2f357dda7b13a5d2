//! Whether a swept tube is a surface that can be made: no cross-sections that meet, no tube through itself.

use super::bezier::Chain;
use super::frame::Frames;
use super::profile::Stack;
use super::spec::Fault;
use super::sweep::carry;
use glam::{DVec2, DVec3};

/// Refuses tubes that fold or run through themselves.
pub(super) fn check(chain: &Chain, frames: &Frames, stack: &Stack, breaks: &[f64]) -> Result<(), Fault> {
    if chain.is_straight() && stack.flat() {
        // Planes across a line never meet.
        return Ok(());
    }
    tight(chain, frames, stack, breaks)?;
    crossing(chain, frames, stack)
}

/// Curvature times the reach of the section toward the inner side; at 1 neighboring sections meet.
fn ratio(chain: &Chain, frames: &Frames, stack: &Stack, w: f64, samples: u32) -> f64 {
    let (segment, t) = chain.locate(w);
    let place = chain.place(segment, t);
    let round = stack.half_axes(w).filter(|[a, b]| a == b);
    let axis = || frames.axis(segment, t, &place);
    // How far neighboring sections fall behind each other on the worst side, a unit of the parameter.
    let lag = if let Some([radius, _]) = round {
        radius.abs() * place.turn.length()
    } else if stack.planar() {
        let axis = axis();
        let other = place.tangent.cross(axis);
        stack.reach(w, DVec2::new(place.turn.dot(axis), place.turn.dot(other)))
    } else {
        let axis = axis();
        let behind = |k: u32| {
            let jet = carry::<false>(&place, axis, &stack.eval(w, f64::from(k) / f64::from(samples)));
            place.speed - jet.du.dot(place.tangent)
        };
        (0..samples).map(behind).fold(f64::NEG_INFINITY, f64::max)
    };
    if lag <= 1e-9 * (chain.length() + place.speed) { 0.0 } else { lag / place.speed }
}

fn tight(chain: &Chain, frames: &Frames, stack: &Stack, breaks: &[f64]) -> Result<(), Fault> {
    let panels = breaks.len().saturating_sub(1).max(1);
    let steps = if stack.planar() { (512 / panels).clamp(8, 192) } else { (192 / panels).clamp(6, 64) };
    let (mut worst, mut at, mut reach) = (0.0, 0.0, 0.0);
    for pair in breaks.windows(2) {
        let width = pair[1] - pair[0];
        for k in 0..=steps {
            let w = pair[0] + width * (k as f64 / steps as f64).clamp(1e-9, 1.0 - 1e-9);
            let ratio = ratio(chain, frames, stack, w, 16);
            if ratio > worst || ratio.is_nan() {
                (worst, at, reach) = (ratio, w, width / steps as f64);
            }
            if ratio.is_nan() {
                break;
            }
        }
    }
    // Golden section around the worst sample.
    let (mut low, mut high) = ((at - reach).max(0.0), (at + reach).min(1.0));
    for _ in 0..16 {
        let (a, b) = (high - 0.618_034 * (high - low), low + 0.618_034 * (high - low));
        let (at_a, at_b) = (ratio(chain, frames, stack, a, 48), ratio(chain, frames, stack, b, 48));
        let better = if at_a > at_b { (at_a, a) } else { (at_b, b) };
        if better.0 > worst {
            (worst, at) = better;
        }
        if at_a > at_b {
            high = b;
        } else {
            low = a;
        }
    }
    if worst < 1.0 { Ok(()) } else { Err(Fault::Fold { u: at, ratio: worst }) }
}

/// A slice of the tube.
struct Slice {
    w: f64,
    center: DVec3,
    tangent: DVec3,
    /// Radius of a circle within the section.
    radius: f64,
}

/// Slices looked at: closer than the tube is thick, within these limits.
const FEW_SLICES: u32 = 192;
const MOST_SLICES: u32 = 1024;

/// Places at which it is asked where a curve leads, and the least cosine to its mean direction with which it leads on.
const LOOKS: u32 = 96;
const ONWARD: f64 = 0.4;

/// Whether a curve leads on into one direction all the way. Then slices around it lie apart by 0.4 of the way along it, and
/// those that [`crossing`] compares never meet: these are more than 3 radii and 2 spacings apart.
fn onward(chain: &Chain) -> bool {
    let tangents: Vec<DVec3> =
        (0..=LOOKS).map(|k| chain.at(f64::from(k) / f64::from(LOOKS)).tangent).collect();
    let mean = tangents.iter().sum::<DVec3>().normalize_or_zero();
    tangents.iter().all(|tangent| tangent.dot(mean) > ONWARD)
}

fn crossing(chain: &Chain, frames: &Frames, stack: &Stack) -> Result<(), Fault> {
    if stack.centered() && onward(chain) {
        return Ok(());
    }
    let slice = |w: f64| {
        let (segment, t) = chain.locate(w);
        let place = chain.place(segment, t);
        if let Some([a, b]) = stack.half_axes(w) {
            return Slice { w, center: place.point, tangent: place.tangent, radius: a.abs().min(b.abs()) };
        }
        let axis = frames.axis(segment, t, &place);
        let line = stack.at(w);
        let ring: [DVec3; 8] =
            std::array::from_fn(|k| carry::<false>(&place, axis, &line.eval(k as f64 / 8.0)).point);
        let center = ring.iter().sum::<DVec3>() / 8.0;
        let radius = ring.iter().map(|p| p.distance(center)).fold(f64::INFINITY, f64::min);
        Slice { w, center, tangent: place.tangent, radius }
    };
    let cut = |count: u32| -> Vec<Slice> {
        (0..count).map(|k| slice(chain.parameter_of_share((f64::from(k) + 0.5) / f64::from(count)))).collect()
    };
    let mut slices = cut(FEW_SLICES);
    let thick = slices.iter().map(|it| it.radius).fold(0.0, f64::max);
    let wanted = (chain.length() / thick).clamp(f64::from(FEW_SLICES), f64::from(MOST_SLICES)) as u32;
    if wanted > FEW_SLICES {
        slices = cut(wanted);
    }
    let spacing = chain.length() / slices.len() as f64;
    // Sweep along the longest side of the box around all centers.
    let low = slices.iter().fold(DVec3::INFINITY, |low, it| low.min(it.center));
    let high = slices.iter().fold(DVec3::NEG_INFINITY, |high, it| high.max(it.center));
    let extent = high - low;
    let side = if extent.x >= extent.y && extent.x >= extent.z {
        0
    } else if extent.y >= extent.z {
        1
    } else {
        2
    };
    let most = slices.iter().map(|it| it.radius).fold(0.0, f64::max);
    let order: Vec<usize> = {
        let mut order: Vec<usize> = (0..slices.len()).collect();
        order.sort_by(|&a, &b| slices[a].center[side].total_cmp(&slices[b].center[side]).then(a.cmp(&b)));
        order
    };
    let inside = |a: &Slice, b: &Slice| {
        let gap = b.center - a.center;
        let along = gap.dot(a.tangent);
        let across = (gap - a.tangent * along).length();
        along.abs() <= 0.6 * spacing && across < 0.8 * a.radius.min(b.radius)
    };
    let mut found: Option<(f64, f64)> = None;
    for (k, &i) in order.iter().enumerate() {
        for &j in &order[k + 1..] {
            let (a, b) = (&slices[i.min(j)], &slices[i.max(j)]);
            if slices[j].center[side] - slices[i].center[side] > most + spacing {
                break;
            }
            let apart = (i.abs_diff(j) as f64) * spacing;
            if apart > 3.0 * a.radius.max(b.radius) + 2.0 * spacing
                && (inside(a, b) || inside(b, a))
                && found.is_none_or(|(w, _)| a.w < w)
            {
                found = Some((a.w, b.w));
            }
        }
    }
    match found {
        Some((u, other_u)) => Err(Fault::SelfIntersect { u, other_u }),
        None => Ok(()),
    }
}
