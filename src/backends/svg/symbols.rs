//! The signs of stitches: posts between the loops below and above, with the strokes that tell their kind.

use super::ScSymbol;
use super::pen::{P, Path};
use crate::ir::{Entry, Kind, Stitch};

/// How a kind is drawn on its post.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Sign {
    /// Nothing.
    None,
    /// An oval along the row.
    Oval,
    /// A filled dot.
    Dot,
    /// A cross without a post; with a foot for extended, a wave for reverse, an oval for foundation stitches.
    Cross(Extra),
    /// A post with a bar on top and so many slashes.
    Post { slashes: u32, foot: Extra },
    /// A closed lens with so many lines in it.
    Lens { lines: u32, bar: bool },
    /// A ring on the row.
    Ring,
    /// A diamond: the pattern says what it is.
    Diamond,
}

/// What a sign has besides.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Extra {
    Plain,
    Extended,
    Wave,
    Oval,
    FrontPost,
    BackPost,
}

fn sign(kind: Kind) -> Sign {
    let post = |slashes, foot| Sign::Post { slashes, foot };
    match kind {
        Kind::Skip => Sign::None,
        Kind::Ch => Sign::Oval,
        Kind::SlSt => Sign::Dot,
        Kind::Sc => Sign::Cross(Extra::Plain),
        Kind::Esc => Sign::Cross(Extra::Extended),
        Kind::Rsc => Sign::Cross(Extra::Wave),
        Kind::Fsc => Sign::Cross(Extra::Oval),
        Kind::Fpsc => Sign::Cross(Extra::FrontPost),
        Kind::Bpsc => Sign::Cross(Extra::BackPost),
        Kind::Hdc => post(0, Extra::Plain),
        Kind::Dc => post(1, Extra::Plain),
        Kind::Tr => post(2, Extra::Plain),
        Kind::Dtr => post(3, Extra::Plain),
        Kind::Trtr => post(4, Extra::Plain),
        Kind::Ehdc => post(0, Extra::Extended),
        Kind::Edc => post(1, Extra::Extended),
        Kind::Etr => post(2, Extra::Extended),
        Kind::Fphdc => post(0, Extra::FrontPost),
        Kind::Fpdc => post(1, Extra::FrontPost),
        Kind::Fptr => post(2, Extra::FrontPost),
        Kind::Fpdtr => post(3, Extra::FrontPost),
        Kind::Bphdc => post(0, Extra::BackPost),
        Kind::Bpdc => post(1, Extra::BackPost),
        Kind::Bptr => post(2, Extra::BackPost),
        Kind::Bpdtr => post(3, Extra::BackPost),
        Kind::Bobble => Sign::Lens { lines: 1, bar: false },
        Kind::Popcorn => Sign::Lens { lines: 0, bar: true },
        Kind::Puff => Sign::Lens { lines: 2, bar: false },
        Kind::Cluster => Sign::Lens { lines: 3, bar: true },
        Kind::Picot => Sign::Ring,
        Kind::Special => Sign::Diamond,
    }
}

/// Room that a stitch needs, in rows of single crochet.
pub(super) fn height(kind: Kind) -> f64 {
    match sign(kind) {
        Sign::Post { slashes, foot } => {
            1.25 + 0.4 * f64::from(slashes) + if foot == Extra::Extended { 0.2 } else { 0.0 }
        }
        Sign::Lens { .. } => 1.5,
        Sign::Cross(Extra::Extended | Extra::Oval | Extra::FrontPost | Extra::BackPost) => 1.3,
        Sign::None | Sign::Oval | Sign::Dot | Sign::Cross(_) | Sign::Ring | Sign::Diamond => 1.0,
    }
}

/// Draws a stitch from the loops below to the loops above; true when it is to be filled. `unit` is the width of a cell.
pub(super) fn draw(
    stitch: Stitch,
    sc: ScSymbol,
    base: &[P],
    tops: &[P],
    up: P,
    unit: f64,
    path: &mut Path,
) -> bool {
    let sign = sign(stitch.kind);
    if sign == Sign::None {
        return false;
    }
    let mut filled = false;
    let along = P(-up.1, up.0);
    match (base, tops) {
        // A single post with nothing shared stands upright.
        (_, [top]) if base.len() <= 1 => filled = one(sign, sc, *top, up, unit, path),
        // Neither made nor counted: on the row.
        (_, []) => {
            if let Some(at) = middle(base) {
                filled = one(sign, sc, at, up, unit, path);
            }
        }
        (_, _) => {
            let Some(foot) = middle(base).or_else(|| middle(tops)) else { return false };
            if tops.len() > 1 {
                for top in tops {
                    leg(sign, foot, *top, unit, path);
                }
            }
            if base.len() > 1 {
                let Some(top) = middle(tops) else { return false };
                for foot in base {
                    leg(sign, *foot, top, unit, path);
                }
            }
        }
    }
    let foot = middle(base).or_else(|| middle(tops)).unwrap_or(P(0.0, 0.0));
    let foot = if base.len() <= 1 && tops.len() == 1 { tops[0].plus(up, -0.9 * unit) } else { foot };
    let arc = |bend: f64, path: &mut Path| {
        let (left, right) = (foot.plus(along, -0.28 * unit), foot.plus(along, 0.28 * unit));
        path.curve(left, foot.plus(up, bend * unit), right);
    };
    match stitch.entry {
        Entry::Both | Entry::Space => {}
        Entry::Front => arc(-0.3, path),
        Entry::Back => arc(0.3, path),
    }
    filled
}

fn middle(points: &[P]) -> Option<P> {
    let sum = points.iter().fold(P(0.0, 0.0), |sum, point| P(sum.0 + point.0, sum.1 + point.1));
    let count = points.len() as f64;
    (!points.is_empty()).then_some(P(sum.0 / count, sum.1 / count))
}

/// A sign that shares nothing, hung below the loop that it makes.
fn one(sign: Sign, sc: ScSymbol, top: P, up: P, unit: f64, path: &mut Path) -> bool {
    let along = P(-up.1, up.0);
    let center = top.plus(up, -0.5 * unit);
    let at = |x: f64, y: f64| center.plus(along, x * unit).plus(up, y * unit);
    match sign {
        Sign::None => {}
        Sign::Oval => path.ellipse(center, along, 0.34 * unit, 0.17 * unit),
        Sign::Ring => path.ellipse(center, along, 0.2 * unit, 0.2 * unit),
        Sign::Dot => {
            path.ellipse(center, along, 0.13 * unit, 0.13 * unit);
            return true;
        }
        Sign::Cross(extra) => {
            let r = 0.27;
            match sc {
                ScSymbol::X => {
                    path.line(at(-r, -r), at(r, r));
                    path.line(at(-r, r), at(r, -r));
                }
                ScSymbol::Plus => {
                    path.line(at(-0.33, 0.0), at(0.33, 0.0));
                    path.line(at(0.0, -0.33), at(0.0, 0.33));
                }
            }
            self::extra(extra, at(0.0, -0.45), at(0.0, 0.45), up, unit, path);
        }
        Sign::Post { slashes, foot } => {
            let low = top.plus(up, -(height_of_post(slashes, foot) - 0.15) * unit);
            post(slashes, low, top.plus(up, -0.1 * unit), unit, path);
            extra(foot, low, top.plus(up, -0.1 * unit), up, unit, path);
        }
        Sign::Lens { lines, bar } => {
            let (low, high) = (top.plus(up, -1.35 * unit), top.plus(up, -0.1 * unit));
            lens(lines, bar, low, high, unit, path);
        }
        Sign::Diamond => path.closed(&[at(0.0, -0.35), at(0.3, 0.0), at(0.0, 0.35), at(-0.3, 0.0)]),
    }
    false
}

fn height_of_post(slashes: u32, foot: Extra) -> f64 {
    1.25 + 0.4 * f64::from(slashes) + if foot == Extra::Extended { 0.2 } else { 0.0 }
}

/// A leg of several that share a loop.
fn leg(sign: Sign, foot: P, top: P, unit: f64, path: &mut Path) {
    let (low, high) = (foot.towards(top, 0.06), foot.towards(top, 0.94));
    match sign {
        Sign::None => {}
        Sign::Post { slashes, .. } => post(slashes, low, high, unit, path),
        Sign::Lens { lines, bar } => lens(lines, bar, low, high, unit, path),
        Sign::Cross(_) | Sign::Oval | Sign::Dot | Sign::Ring | Sign::Diamond => {
            path.line(low, high);
            let (middle, across) = (low.towards(high, 0.55), across(low, high));
            path.line(middle.plus(across, -0.2 * unit), middle.plus(across, 0.2 * unit));
        }
    }
}

/// The unit vector at a right angle to a line.
fn across(low: P, high: P) -> P {
    let (x, y) = (high.0 - low.0, high.1 - low.1);
    let length = (x * x + y * y).sqrt();
    if length > 0.0 { P(-y / length, x / length) } else { P(1.0, 0.0) }
}

fn post(slashes: u32, low: P, high: P, unit: f64, path: &mut Path) {
    let side = across(low, high);
    let bar = 0.25 * unit;
    path.line(low, high);
    path.line(high.plus(side, -bar), high.plus(side, bar));
    let up = P(side.1, -side.0);
    for slash in 0..slashes {
        let at = low.towards(high, 0.72 - 0.16 * f64::from(slash));
        let tilt = |sign: f64| at.plus(side, sign * 0.2 * unit).plus(up, sign * 0.1 * unit);
        path.line(tilt(-1.0), tilt(1.0));
    }
}

fn lens(lines: u32, bar: bool, low: P, high: P, unit: f64, path: &mut Path) {
    let side = across(low, high);
    let middle = low.towards(high, 0.5);
    for bend in [-0.75, 0.75] {
        path.curve(low, middle.plus(side, bend * unit), high);
    }
    for line in 0..lines {
        let bend = (f64::from(line) - (f64::from(lines) - 1.0) / 2.0) * 0.36;
        path.curve(low, middle.plus(side, bend * unit), high);
    }
    if bar {
        path.line(high.plus(side, -0.22 * unit), high.plus(side, 0.22 * unit));
    }
}

fn extra(extra: Extra, low: P, high: P, up: P, unit: f64, path: &mut Path) {
    let along = P(-up.1, up.0);
    match extra {
        Extra::Plain => {}
        Extra::Extended => {
            path.line(low.plus(along, -0.15 * unit), low.plus(along, 0.15 * unit));
        }
        Extra::Oval => path.ellipse(low, along, 0.26 * unit, 0.12 * unit),
        Extra::Wave => {
            let (left, right) = (high.plus(along, -0.3 * unit), high.plus(along, 0.3 * unit));
            path.curve(left, left.towards(high, 0.5).plus(up, 0.25 * unit), high);
            path.curve(high, high.towards(right, 0.5).plus(up, -0.25 * unit), right);
        }
        Extra::FrontPost | Extra::BackPost => {
            let side = if extra == Extra::FrontPost { 1.0 } else { -1.0 };
            let end = low.plus(along, 0.3 * side * unit).plus(up, 0.12 * unit);
            path.curve(low, low.plus(along, 0.32 * side * unit).plus(up, -0.2 * unit), end);
        }
    }
}
