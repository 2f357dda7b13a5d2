//! When what is woven settles: the newest rows after each, the whole in the end, and its top where that is ragged.

use super::{Outcome, Weaver};
use crate::generate::relax::{Brink, Effort, Ends, Firm, Mark, Stretch};
use crate::generate::score::{FEW_OF, Score, any_inverted, inverted};
use crate::generate::top::{self, Top};
use crate::generate::tries::Judge;

/// Weight of square tiles while rows settle.
const WINDOW_SQUARENESS: f64 = 0.675;
/// Sweeps in which inverted tiles of a hurried try or a large part shall open, and how many times these.
const OPENING_SWEEPS: u32 = 14;
const OPENINGS: u32 = 4;
/// Those of the first time on a large part: most often they are enough.
const FEW_SWEEPS: u32 = 5;
/// Parts of so many stitches have few tries.
const MANY: usize = 50_000;
/// Large parts settle by bands of rows, so many nodes at a time, which the processor keeps near; and each band with so many rows
/// of the next, which then settle once more: what hangs over its edge is far enough away. A band has several times as many rows,
/// and of long ones no more, for they would not stay near.
const BAND: usize = 1 << 16;
const OVERLAP: usize = 5;
const ROWS: usize = 5 * OVERLAP;
/// Sweeps over the whole after which a try is judged.
const FIRST_SWEEPS: u32 = 4;

impl Weaver<'_> {
    /// Settles what has been woven; over the bar after the first sweeps it is given up.
    pub(super) fn settle_whole(&mut self, judge: Judge) -> Outcome {
        let first = if judge.bar < f64::INFINITY { self.options.sweeps.min(FIRST_SWEEPS) } else { 0 };
        if first > 0 {
            self.settle_all(first, judge.level);
            let score = Score::of(&self.sheet, self.options.ease());
            if score.total > judge.bar {
                return Outcome::Outdone;
            }
        }
        // Tries of their own, on harsh parts and against inverted tiles, have sweeps of their own.
        let usual = judge.level && judge.tail;
        let sweeps = if usual { self.options.sweeps_over(self.sheet.len()) } else { self.options.sweeps };
        self.settle_all(sweeps - first, judge.level);
        if self.options.sweeps == 0 {
            return Outcome::Done;
        }
        // Tries at a large part are dear: it settles longer instead.
        if self.sheet.len() > MANY && inverted(&self.sheet) > self.sheet.len() / FEW_OF {
            self.open(FEW_SWEEPS, judge.level);
        }
        self.settle_top();
        if self.quick() && !self.open(OPENING_SWEEPS, judge.level) { Outcome::Outdone } else { Outcome::Done }
    }

    /// Settles longer while there are inverted tiles, by so many sweeps first; false when some stay.
    fn open(&mut self, sweeps: u32, level: bool) -> bool {
        (0..=OPENINGS).any(|k| {
            if k > 0 {
                self.settle_all(if k == 1 { sweeps } else { OPENING_SWEEPS }, level);
            }
            !any_inverted(&self.sheet)
        })
    }

    fn ends(&self) -> Ends<'static> {
        Ends { range: self.range, ring: self.ring_center, level: None, opens: self.opens }
    }

    /// The first row of an open tube stays where it is.
    fn free(&self, mut mark: Mark) -> Mark {
        if self.ring_center.is_none()
            && let Some(first) = self.marks.first()
        {
            mark.nodes = mark.nodes.max(first.nodes);
        }
        mark
    }

    pub(super) fn settle_window(&mut self) {
        // Someone waits: twice the sweeps every second time are as good, and have less to set up.
        if self.quick() && !self.marks.len().is_multiple_of(2) {
            return;
        }
        let row = match *self.marks.as_slice() {
            [.., before, newest] => newest.nodes - before.nodes,
            _ => 0,
        };
        let oldest = self.marks.len().saturating_sub(self.options.window_over(row));
        let Some(&mark) = self.marks.get(oldest) else { return };
        let mark = if oldest == 0 { self.free(Mark::default()) } else { self.free(mark) };
        let effort = Effort { sweeps: self.options.window_sweeps, squareness: WINDOW_SQUARENESS };
        let ends = self.ends();
        // What lies two rows down hardly moves any more.
        let newest = self.marks.last().map_or(0, |mark| mark.nodes);
        let exact = if self.quick() { usize::MAX } else { newest };
        let rows = Stretch::since(mark, &self.sheet);
        self.relaxer.relax(self.surface, &mut self.sheet, rows, exact, effort, ends);
    }

    /// Settles the whole; points are left to first order, if they are not the last.
    fn settle_all(&mut self, sweeps: u32, level: bool) {
        if sweeps == 0 {
            return;
        }
        let effort = Effort { sweeps, squareness: self.options.squareness };
        let top = if level { top::first(&self.ring) } else { usize::MAX };
        let level = Some(Brink { rows: self.rows, lag: self.lag, top, firm: Firm::No, tail: self.tail });
        let ends = Ends { level, ..self.ends() };
        let exact = if self.quick() { 0 } else { usize::MAX };
        let end = Mark::of(&self.sheet);
        let (mut from, mut next) = (self.free(Mark::default()), 0);
        loop {
            next = self.marks.partition_point(|mark| mark.nodes < from.nodes + BAND).max(next + ROWS);
            let until = self.marks.get(next + OVERLAP).copied().unwrap_or(end);
            let band = Stretch { from, until };
            self.relaxer.relax(self.surface, &mut self.sheet, band, exact, effort, ends);
            if until.nodes == end.nodes {
                break;
            }
            from = self.free(self.marks[next]);
        }
    }

    /// Settles the last rows once more where they end ragged.
    fn settle_top(&mut self) {
        let last = self.marks.len().saturating_sub(top::ROWS);
        let mark = self.free(self.marks.get(last).copied().unwrap_or_default());
        let ring = &top::open(&self.sheet, self.last_row(), &self.ring);
        let (surface, rows, ends) = (self.surface, self.rows, self.ends());
        let (squareness, quick, tail) = (self.options.squareness, self.quick(), self.tail);
        let lag = self.lag;
        let top = Top { surface, rows, lag, ring, mark, ends, squareness, quick, tail };
        top.settle(&mut self.relaxer, &mut self.sheet);
    }
}
