//! The way of the yarn through each kind of stitch, in the unit cube: x in working direction, y up, z outward.
//!
//! The curves are Picot's own. The yarn of a single crochet runs along its top as one link of a chain, the front strand
//! on and the back strand back again, then down behind the work, through under the link of the stitch below, up the front
//! as one leg, over behind its own link, down as the other leg, back through, and up behind to the next stitch. The
//! points were pushed apart until, in flat fabric, no two strands of yarn 0.3 stitches thick come nearer than 0.9 of
//! their thickness. The length, 9.8 stitch widths, is near that of real yarn.

use crate::ir::Kind;

/// A point in the unit cube.
pub(super) type Key = [f64; 3];

/// Height at which the hook goes in: below the top of the stitch below.
const UNDER: f64 = -0.30;

/// Turns of yarn around the post.
fn wraps(kind: Kind) -> u32 {
    let rows = kind.height().round() as u32;
    if matches!(kind, Kind::Hdc | Kind::Fphdc | Kind::Bphdc | Kind::Ehdc) {
        1
    } else {
        rows.saturating_sub(2)
    }
}

/// The yarn of one leg of a stitch: from the row's back strand into the loops below and up again. `first` and `last`
/// are the places of the first and last loop worked, across the base.
pub(super) fn post(kind: Kind, first: f64, last: f64, out: &mut Vec<Key>) {
    // Feet keep off each other by a yarn's thickness.
    let apart = if first == last { 0.13 } else { 0.0 };
    let (left, right) = (first - apart, last + apart);
    if kind == Kind::SlSt {
        slip(left, right, out);
    } else if matches!(kind, Kind::Bobble | Kind::Popcorn | Kind::Puff | Kind::Cluster) {
        bulge(left, right, out);
    } else if kind.height() >= 1.5 {
        tall(kind, left, right, out);
    } else {
        out.extend([
            [0.00, 0.80, 0.44],
            [0.22, 1.04, 0.72],
            [0.54, 1.14, 0.80],
            [0.85, 1.20, 0.74],
            [1.01, 1.25, 0.49],
            [0.95, 1.13, 0.34],
            [0.57, 1.17, 0.38],
            [0.17, 0.96, 0.15],
            [0.17, 0.49, -0.09],
            [left + 0.03, 0.05, -0.11],
            [left + 0.03, -0.51, 0.23],
            [left + 0.03, -0.60, 0.82],
            [left - 0.09, -0.06, 1.14],
            [0.13, 0.33, 1.05],
            [0.11, 0.47, 0.82],
            [0.35, 0.74, 0.54],
            [0.67, 0.89, 0.59],
            [0.92, 0.74, 0.94],
            [0.81, 0.41, 1.12],
            [right, -0.04, 1.14],
            [right + 0.02, -0.42, 0.74],
            [right + 0.04, -0.38, 0.29],
            [right + 0.11, 0.03, -0.06],
            [0.91, 0.45, 0.12],
        ]);
    }
}

/// A slip stitch lies flat on the row below.
fn slip(left: f64, right: f64, out: &mut Vec<Key>) {
    out.extend([
        [0.00, 0.95, 0.27],
        [0.30, 0.90, 0.22],
        [left, -0.6, 0.30],
        [left, -0.6, 0.75],
        [0.20, 0.40, 0.90],
        [0.32, 1.05, 0.66],
        [0.68, 1.05, 0.66],
        [0.80, 0.40, 0.90],
        [right, -0.6, 0.75],
        [right, -0.6, 0.30],
    ]);
}

/// Tall stitches: a post of two strands with yarn wound around it, once for each yarn over.
fn tall(kind: Kind, left: f64, right: f64, out: &mut Vec<Key>) {
    let height = kind.height().max(1.0);
    // Lengths that do not grow with the stitch.
    let unit = 1.0 / height;
    out.extend([
        [0.00, 1.0 - 0.02 * unit, 0.27],
        [0.28, 1.0 + 0.02 * unit, 0.22],
        [0.40, 1.0 - 0.40 * unit, 0.17],
        [0.44, 0.40, 0.18],
        [left, UNDER * unit, 0.34],
        [left, (UNDER + 0.02) * unit, 0.72],
        [left + 0.02, 0.10 * unit, 0.86],
        [0.38, 0.7 * unit, 0.72],
    ]);
    let wraps = wraps(kind);
    for wrap in 0..wraps {
        let y = 0.9 * unit + (1.0 - 1.8 * unit) * (f64::from(wrap) + 0.5) / f64::from(wraps);
        let rise = 0.28 * unit;
        out.extend([
            [0.22, y - rise, 0.80],
            [0.50, y, 0.98],
            [0.78, y + rise, 0.72],
            [0.72, y + 0.6 * rise, 0.30],
            [0.40, y + 0.4 * rise, 0.12],
            [0.30, y + 1.3 * rise, 0.50],
        ]);
    }
    out.extend([
        [0.20, 1.0 - 0.46 * unit, 0.86],
        [0.13, 1.0 - 0.16 * unit, 0.80],
        [0.30, 1.0 + 0.08 * unit, 0.68],
        [0.70, 1.0 + 0.08 * unit, 0.68],
        [0.87, 1.0 - 0.16 * unit, 0.80],
        [0.76, 1.0 - 0.6 * unit, 0.88],
        [0.62, 0.4, 0.74],
        [right, 0.0, 0.80],
        [right, UNDER * unit, 0.62],
        [right, UNDER * unit, 0.30],
        [0.62, 0.3, 0.26],
        [0.74, 1.0 - 0.4 * unit, 0.15],
    ]);
}

/// Several stitches closed together: strands that bulge outward side by side.
fn bulge(left: f64, right: f64, out: &mut Vec<Key>) {
    out.extend([[0.00, 0.99, 0.27], [0.28, 1.0, 0.22], [left, UNDER / 3.0, 0.34]]);
    for strand in 0..5 {
        let x = 0.14 + 0.18 * f64::from(strand);
        let bow = 1.5 + 0.25 * (2.0 - (f64::from(strand) - 2.0).abs());
        out.extend([
            [0.4 + 0.05 * f64::from(strand), -0.06, 0.7],
            [x, 0.25, bow],
            [x, 0.7, bow],
            [0.5, 0.97, 0.75],
        ]);
    }
    out.extend([[0.70, 1.03, 0.68], [0.80, 0.9, 0.5], [right, UNDER / 3.0, 0.30], [0.72, 0.8, 0.15]]);
}

/// A chain: one loop drawn through the one before.
pub(super) fn chain(out: &mut Vec<Key>) {
    out.extend([
        [0.00, 0.30, 0.30],
        [0.35, 0.55, 0.62],
        [0.85, 1.00, 0.75],
        [1.20, 0.85, 0.45],
        [0.95, 0.35, 0.30],
        [0.50, 0.22, 0.66],
        [0.62, 0.40, 0.20],
    ]);
}

/// The yarn's way up between two passes.
pub(super) fn turn(out: &mut Vec<Key>) {
    out.extend([[0.55, 0.35, 0.75], [0.75, 0.75, 0.25]]);
}

/// The tail that draws the last round shut goes through the front strand of each loop.
pub(super) fn close(out: &mut Vec<Key>) {
    out.extend([[0.15, 0.20, 0.85], [0.50, -0.05, 0.55], [0.80, 0.25, 0.35]]);
}
