//! The last turn, made level where it is ragged when the whole has settled.
//!
//! Short rows leave steps two rows high, and the last ones have no row above them that would hide them. The sweeps over the whole
//! level short steps; long ones, as in rounds of many fine stitches, take the rows below with them, and more sweeps.

use super::relax::{Brink, Effort, Ends, Firm, Mark, Relaxer, Stretch};
use super::rows::Rows;
use super::score::Fit;
use super::sheet::{Sheet, Work};
use crate::ir::NodeId;
use crate::shape::ParametricSurface;

/// Rows that settle with the top.
pub(super) const ROWS: usize = 12;
/// Highest minus lowest open loop from which on it is worth the while, in rows; and the same while someone waits.
const RAGGED: f64 = 0.77;
const VERY_RAGGED: f64 = 1.2;
/// On parts of so many stitches the top is a small share of the whole, and worth it from here on.
const MANY: usize = 5_000;
const UNEVEN: f64 = 0.3;
/// What the whole may lose by that, as a score.
const PRICE: f64 = 0.1;
/// Sweeps at once, and how many times these.
const SWEEPS: u32 = 20;
const TIMES: usize = 3;

/// What there is to settle.
pub(super) struct Top<'w> {
    pub surface: &'w dyn ParametricSurface,
    pub rows: &'w Rows,
    /// By how many rows it lies behind its helix.
    pub lag: f64,
    /// The open loops, and those under the last few: see [`open`].
    pub ring: &'w [NodeId],
    /// Where the last rows begin.
    pub mark: Mark,
    pub ends: Ends<'w>,
    pub squareness: f64,
    /// Only what is very ragged is worth it.
    pub quick: bool,
    /// Long and short edges pull more than in proportion.
    pub tail: bool,
}

impl Top<'_> {
    /// Pulls the open loops firmly to their level until they are, unless that costs too much elsewhere or presses tiles flat.
    pub(super) fn settle(&self, relaxer: &mut Relaxer, sheet: &mut Sheet) {
        let many = sheet.len() > MANY;
        let firm = if many { Firm::Closely } else { Firm::Yes };
        let brink = Brink { rows: self.rows, lag: self.lag, top: first(self.ring), firm, tail: self.tail };
        let ends = Ends { level: Some(brink), ..self.ends };
        let effort = Effort { sweeps: SWEEPS, squareness: self.squareness };
        let ragged = match self.quick {
            true => VERY_RAGGED,
            false if many => UNEVEN,
            false => RAGGED,
        };
        let rows = Stretch::since(self.mark, sheet);
        // What lies below does not move.
        let mut below = None;
        for _ in 0..TIMES {
            let off = spread(sheet, self.rows, self.ring);
            if off <= ragged {
                return;
            }
            let before = Places::of(sheet, self.mark.nodes);
            let Mark { edges, quads, .. } = self.mark;
            let below =
                *below.get_or_insert_with(|| Fit::of(sheet, &sheet.edges[..edges], &sheet.quads[..quads]));
            let score = |sheet: &Sheet| {
                below.and(Fit::of(sheet, &sheet.edges[edges..], &sheet.quads[quads..])).score()
            };
            let fit = score(sheet);
            relaxer.relax(self.surface, sheet, rows, 0, effort, ends);
            let mut after = score(sheet);
            if after.inverted > fit.inverted {
                // Softly, what was pressed flat opens again.
                let soft = Ends { level: Some(Brink { firm: Firm::No, ..brink }), ..ends };
                relaxer.relax(self.surface, sheet, rows, 0, effort, soft);
                after = score(sheet);
            }
            let worse = spread(sheet, self.rows, self.ring) > off;
            if worse || after.inverted > fit.inverted || after.total > fit.total + PRICE {
                return before.restore(sheet);
            }
        }
    }
}

/// Share of a turn that may be taken off again at the end (`lower::trim`).
pub(super) const SLIVER: f64 = 1.0 / 6.0;

/// The open loops, and those that will be open where the last few stitches are taken off again.
pub(super) fn open(sheet: &Sheet, end: f64, ring: &[NodeId]) -> Vec<NodeId> {
    let mut open = ring.to_vec();
    let late = |work: &&Work| sheet.v[work.top[1] as usize] >= end - SLIVER;
    for work in sheet.main.iter().rev().take_while(late) {
        open.extend(&work.base[..if work.base[0] == work.base[1] { 1 } else { 2 }]);
    }
    open
}

/// The first of the open loops.
pub(super) fn first(ring: &[NodeId]) -> usize {
    ring.iter().copied().min().unwrap_or(0) as usize
}

/// Rows between the highest and the lowest open loop, each against its place on the helix.
pub(super) fn spread(sheet: &Sheet, rows: &Rows, ring: &[NodeId]) -> f64 {
    let off = lags(sheet, rows, ring);
    let (low, high) = off.fold((f64::MAX, f64::MIN), |(low, high), off| (low.min(off), high.max(off)));
    (high - low).max(0.0)
}

/// Rows by which each of the open loops lies behind its place on the helix.
pub(super) fn lags<'s>(
    sheet: &'s Sheet,
    rows: &'s Rows,
    ring: &'s [NodeId],
) -> impl Iterator<Item = f64> + 's {
    let mut knot = rows.count as usize;
    ring.iter().map(|id| *id as usize).map(move |i| sheet.v[i] - rows.tau(sheet.u[i], &mut knot))
}

/// Where the last nodes were.
struct Places {
    u: Vec<f64>,
    v: Vec<f64>,
    point: Vec<glam::DVec3>,
    du: Vec<glam::DVec3>,
    dv: Vec<glam::DVec3>,
}

impl Places {
    fn of(sheet: &Sheet, first: usize) -> Self {
        Self {
            u: sheet.u[first..].to_vec(),
            v: sheet.v[first..].to_vec(),
            point: sheet.point[first..].to_vec(),
            du: sheet.du[first..].to_vec(),
            dv: sheet.dv[first..].to_vec(),
        }
    }

    fn restore(self, sheet: &mut Sheet) {
        let first = sheet.len() - self.u.len();
        sheet.u.splice(first.., self.u);
        sheet.v.splice(first.., self.v);
        sheet.point.splice(first.., self.point);
        sheet.du.splice(first.., self.du);
        sheet.dv.splice(first.., self.dv);
    }
}
