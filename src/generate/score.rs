//! How good a settled sheet is, in one number, so that the best of several tries can be kept.

use super::sheet::{Edge, EdgeKind, Quad, Shaped, Sheet, ShortRow, TileKind, Work};
use crate::ir::Stitch;
use glam::DVec3;

/// Mean length error, its root mean square, and skew that weigh the same.
const USUAL_LENGTH: f64 = 0.04;
const USUAL_SPREAD: f64 = 0.055;
const USUAL_SKEW: f64 = 0.09;
/// Mean length error and skew that no one overlooks, and the price of more.
const MOST_LENGTH: f64 = 0.05;
const MOST_SKEW: f64 = 0.12;
const STRETCHED: f64 = 50.0;
const SLANTED: f64 = 30.0;
/// A signed mean over this makes the whole too large or too small; its price.
const BIAS_FREE: f64 = 0.004;
const BIAS: f64 = 100.0;
/// Words a stitch that are usual, and their weight with full ease.
const USUAL_WORDS: f64 = 0.12;
const WORDS: f64 = 0.6;
/// Rows between the highest and the lowest loop of the last turn that are free, and the price of one more.
const LEVEL_FREE: f64 = 0.75;
const LEVEL: f64 = 0.7;
/// Price of increases that stand on others without need, as a share of all.
const STACKED: f64 = 2.0;
/// Price of an inverted tile as a share of all tiles, and of one at all.
const INVERTED: f64 = 40.0;
const ANY_INVERTED: f64 = 2.0;

/// A tile with less than this share of its area is flat.
const FLAT: f64 = 0.05;
/// Of large parts one tile of so many may be inverted until all is settled, and is mended then (`untangle`).
pub(super) const FEW_OF: usize = 10_000;

/// What a try came to: lower is better.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Score {
    pub total: f64,
    /// The total of edges and tiles alone.
    pub fit: f64,
    pub inverted: usize,
    /// Mean absolute length error, and mean skew.
    pub length: f64,
    pub skew: f64,
    /// Share of the increases that stand on others without need.
    pub stacked: f64,
}

impl Score {
    /// Mean absolute length error with its spread, and mean skew, each by its usual size; a bias and inverted tiles cost extra,
    /// so do increases that stand on others, and so do words, with so much ease.
    pub(super) fn of(sheet: &Sheet, ease: f64) -> Self {
        let fit = Self::of_fit(sheet);
        let stacked = stacked(sheet);
        let over =
            STRETCHED * (fit.length - MOST_LENGTH).max(0.0) + SLANTED * (fit.skew - MOST_SKEW).max(0.0);
        Self { total: fit.total + over + STACKED * stacked, stacked, ..fit }.with_words(sheet, ease)
    }

    /// The same with so much weight on few words: runs of stitches, and four words for each short row.
    fn with_words(self, sheet: &Sheet, ease: f64) -> Self {
        let kind = |work: &Work| work.stitch;
        let changes =
            |works: &[Work]| works.windows(2).filter(|pair| kind(&pair[0]) != kind(&pair[1])).count();
        let of = |row: &ShortRow| 4 + changes(&row.back) + changes(&row.forward);
        let words = changes(&sheet.main) + sheet.short_rows.iter().map(of).sum::<usize>();
        let share = words as f64 / sheet.len().max(1) as f64;
        Self { total: self.total + ease * WORDS * share / USUAL_WORDS, ..self }
    }

    /// The same with the price of a last turn that lies so many rows from even.
    pub(super) fn with_level(self, spread: f64) -> Self {
        Self { total: self.total + LEVEL * (spread - LEVEL_FREE).max(0.0), ..self }
    }

    /// The same without what only a maker sees.
    pub(super) fn of_fit(sheet: &Sheet) -> Self {
        Fit::of(sheet, &sheet.edges, &sheet.quads).score()
    }
}

/// Sums over some edges and tiles; those of the parts of a sheet add up.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Fit {
    edges: usize,
    length: f64,
    sum: f64,
    square: f64,
    quads: usize,
    skew: f64,
    inverted: usize,
}

impl Fit {
    pub(super) fn of(sheet: &Sheet, edges: &[Edge], quads: &[Quad]) -> Self {
        let mut fit = Self { edges: edges.len(), quads: quads.len(), ..Self::default() };
        for edge in edges {
            let error = length_error(sheet, edge);
            fit.length += error.abs();
            fit.sum += error;
            fit.square += error * error;
        }
        for quad in quads {
            let [b0, b1, t0, t1] = quad.corners.map(|id| sheet.point[id as usize]);
            let across = (b1 - b0) + (t1 - t0);
            let up = match quad.kind {
                TileKind::Wales | TileKind::Step => (t0 - b0) + (t1 - b1),
                TileKind::TurnLeft => t0 - b0,
                TileKind::TurnRight => t1 - b1,
            };
            let size = (across.length_squared() * up.length_squared()).sqrt();
            fit.skew += if size > 0.0 { (across.dot(up) / size).abs() } else { 0.0 };
            fit.inverted += usize::from(is_inverted(sheet, quad));
        }
        fit
    }

    pub(super) fn and(self, other: Self) -> Self {
        Self {
            edges: self.edges + other.edges,
            length: self.length + other.length,
            sum: self.sum + other.sum,
            square: self.square + other.square,
            quads: self.quads + other.quads,
            skew: self.skew + other.skew,
            inverted: self.inverted + other.inverted,
        }
    }

    pub(super) fn score(self) -> Score {
        let Self { edges, quads, inverted, .. } = self;
        let share = |sum: f64, count: usize| sum / count.max(1) as f64;
        let (length, skew) = (share(self.length, edges), share(self.skew, quads));
        let lengths = 0.5 * (length / USUAL_LENGTH + share(self.square, edges).sqrt() / USUAL_SPREAD);
        let bias = BIAS * (share(self.sum, edges).abs() - BIAS_FREE).max(0.0);
        let mut total = lengths + skew / USUAL_SKEW + bias;
        if inverted > 0 {
            total += ANY_INVERTED + INVERTED * share(inverted as f64, quads);
        }
        Score { total, fit: total, inverted, length, skew, stacked: 0.0 }
    }
}

fn length_error(sheet: &Sheet, edge: &Edge) -> f64 {
    let rest = if edge.kind == EdgeKind::Wale { sheet.height } else { sheet.width };
    let d = sheet.point[edge.b as usize].distance(sheet.point[edge.a as usize]);
    d / rest - 1.0
}

/// Mean absolute length error of one edge of so many.
pub(super) fn some_length_error(sheet: &Sheet, of: usize) -> f64 {
    let some = sheet.edges.iter().step_by(of);
    let count = some.len().max(1) as f64;
    some.map(|edge| length_error(sheet, edge).abs()).sum::<f64>() / count
}

/// A tile lies with its inside out, or is so flat that it may on a surface that is known better.
pub(super) fn any_inverted(sheet: &Sheet) -> bool {
    let flat = FLAT * 2.0 * sheet.width * sheet.height;
    sheet.quads.iter().any(|quad| {
        twice_area(sheet, quad)
            .is_some_and(|(area, normal)| area <= 0.0 || area * area <= flat * flat * normal.length_squared())
    })
}

/// How many tiles lie with their inside out.
pub(super) fn inverted(sheet: &Sheet) -> usize {
    sheet.quads.iter().filter(|quad| is_inverted(sheet, quad)).count()
}

/// The tile lies with its inside out; turns and those of three corners count as fine.
fn is_inverted(sheet: &Sheet, quad: &Quad) -> bool {
    twice_area(sheet, quad).is_some_and(|(area, _)| area <= 0.0)
}

/// Twice the area of a tile as seen from outside, times the length of the normal that comes with it; `None` for turns and tiles
/// of three corners.
fn twice_area(sheet: &Sheet, quad: &Quad) -> Option<(f64, DVec3)> {
    let area = quad.area(|id| sheet.point[id as usize])?;
    let jet = sheet.jet(quad.corners[0]);
    let normal = jet.dv.cross(jet.du);
    Some((normal.dot(area), normal))
}

/// The increases of the long rows that stand beside one of the row below although there are bases that are clear, as a
/// share of those that could.
fn stacked(sheet: &Sheet) -> f64 {
    let (mut all, mut stacked) = (0, 0);
    let mut first = sheet.main.first().map_or(0, |work| work.top[0]);
    let (mut increases, mut close, mut clear) = (0_usize, 0_usize, 0_usize);
    for (i, work) in sheet.main.iter().enumerate() {
        let base = work.base[0] as usize;
        let near = sheet.shaped.get(base.saturating_sub(1)..(base + 2).min(first as usize));
        let near = near.is_some_and(|near| near.contains(&Shaped::Inc));
        let increase = work.stitch == Stitch::INC;
        increases += usize::from(increase);
        close += usize::from(increase && near);
        clear += usize::from(!near);
        // A row ends where the next comes to its loops.
        if sheet.main.get(i + 1).is_none_or(|next| next.base[0] >= first) {
            let forced = increases.saturating_sub(clear).min(close);
            (all, stacked) = (all + increases - forced, stacked + close - forced);
            (increases, close, clear) = (0, 0, 0);
            first = sheet.main.get(i + 1).map_or(first, |next| next.top[0]);
        }
    }
    f64::from(stacked as u32) / f64::from(all.max(1) as u32)
}
