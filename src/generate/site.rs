//! What a part is laid on, as the generator sees it, and the ways of laying stitches there: woven row by row, or in even rounds.

use super::options::{Options, Preset};
use super::relax::{Brink, Effort, Ends, Firm, Mark, Relaxer, Stretch};
use super::rows::Rows;
use super::seam::Turned;
use super::sheet::{Foot, Sheet};
use super::tries::Judge;
use super::untangle::Untangler;
use super::weave::{Outcome, Weaver};
use super::{first_row, symmetric};
use crate::diag::Sink;
use crate::ir::Gauge;
use crate::shape::{End, ParametricSurface};
use glam::DVec3;

/// Nodes may slide this far over an open end while they settle.
const OVERHANG: [f64; 2] = [-0.02, 1.06];
/// At a pole they keep this share of the first row's distance.
const POLE_DISTANCE: f64 = 0.3;
/// Factor of the weight of square tiles in even rounds without and with one or two open ends: there lengths can give.
const EVEN_SQUARENESS: [f64; 3] = [0.9, 1.0, 1.1];
/// Rows by which a given first row counts as higher, for each turn that a try would turn another one by.
const LIFT: f64 = 1.0;
/// So many times as many nodes as there should be, and more, have run away.
const MOST_TIMES: usize = 3;
const MOST_MORE: usize = 10_000;

/// A tube on which stitches can be laid.
#[derive(Clone, Copy)]
pub(super) struct Site<'s> {
    /// The surface as it is looked up, from where the helix begins.
    pub turned: &'s Turned<'s>,
    /// Where the nodes lie in the end, and the surface as it is without being widened.
    pub exact: &'s dyn ParametricSurface,
    pub outside: &'s dyn ParametricSurface,
    /// What is looked up are patches.
    pub on_patches: bool,
    pub ends: [End; 2],
    pub rows: &'s Rows,
    /// How far the first and the last row lie off the ends, in rows.
    pub leads: [f64; 2],
    pub gauge: &'s Gauge,
    /// The first row is worked into a slit.
    pub slit: bool,
    /// The first row, where it is picked up.
    pub first: Option<&'s [Foot]>,
    /// About how many stitches there will be.
    pub expected: f64,
}

impl Site<'_> {
    /// In even rounds; `None` where that cannot be.
    pub(super) fn lay_evenly(&self, options: &Options, sink: &Sink<'_>) -> Option<Laid> {
        let lifted = self.rows.of_even(self.ends);
        let rows = lifted.as_ref().unwrap_or(self.rows);
        let (mut sheet, start) = self.ground(self.turned, rows, options).lay_evenly(sink)?;
        if self.on_patches {
            sheet.put_on(self.exact, self.turned.by);
        }
        Some(Laid { sheet, start, spread: 0.0, turn: self.turned.by, lifted })
    }

    /// Row by row, from so far around the tube; `None` when the rows run away. Where the place of the first row is given, its
    /// height is varied.
    pub(super) fn weave(&self, options: &Options, turn: f64, judge: Judge, sink: &Sink<'_>) -> Option<Laid> {
        let Self { turned, first, slit, gauge, leads, .. } = *self;
        let lifted = first.and_then(|_| Rows::new(turned, [leads[0] + LIFT * turn, leads[1]], gauge));
        let fixed = slit || first.is_some();
        let turned = Turned { surface: turned.surface, by: turned.by + if fixed { 0.0 } else { turn } };
        let rows = lifted.as_ref().unwrap_or(self.rows);
        let (mut sheet, start, spread) = self.ground(&turned, rows, options).weave(judge, sink)?;
        // In a hurry they stay on the patches.
        if options.preset == Preset::Std {
            sheet.put_on(self.exact, turned.by);
        }
        Some(Laid { sheet, start, spread, turn: turned.by, lifted })
    }

    /// Moves loops of inverted tiles, and looks at tiles closely if asked. Returns the inverted ones before and after.
    pub(super) fn untangle(&self, laid: &mut Laid, close: bool) -> [usize; 2] {
        let Self { exact, outside, .. } = *self;
        let Laid { sheet, start, turn, .. } = laid;
        let (range, pole) = (self.range(self.rows), self.poles()[0]);
        Untangler { on: exact, outside, turn: *turn, range, start: *start, pole, close }.untangle(sheet)
    }

    /// The points at the closed ends.
    pub(super) fn poles(&self) -> [Option<DVec3>; 2] {
        let pole = |end: End, u: f64| (end == End::Closed).then(|| self.turned.point(u, 0.0));
        [pole(self.ends[0], 0.0), pole(self.ends[1], 1.0)]
    }

    /// Least and greatest u of a node.
    fn range(&self, rows: &Rows) -> [f64; 2] {
        let limit = |end: End, open: f64, row: f64, pole: f64| {
            if end == End::Closed { pole + POLE_DISTANCE * (row - pole) } else { open }
        };
        let lowest = limit(self.ends[0], OVERHANG[0], rows.at(0.0), 0.0);
        let feet = self.first.unwrap_or_default();
        [
            feet.iter().fold(lowest, |least, foot| least.min(foot.u)),
            limit(self.ends[1], OVERHANG[1], rows.at(rows.count), 1.0),
        ]
    }

    fn ground<'g>(
        &'g self,
        surface: &'g dyn ParametricSurface,
        rows: &'g Rows,
        options: &'g Options,
    ) -> Ground<'g> {
        let Self { gauge, slit, first, expected, .. } = *self;
        let (poles, range, expected) = (self.poles(), self.range(rows), expected as usize);
        Ground { surface, rows, gauge, options, poles, range, slit, first, expected }
    }
}

/// A finished sheet, the stitches of its first row, and where around the tube the helix began.
pub(super) struct Laid {
    pub sheet: Sheet,
    pub start: usize,
    /// Rows between the highest and the lowest loop of the last turn.
    pub spread: f64,
    pub turn: f64,
    /// Other rows than planned.
    pub lifted: Option<Rows>,
}

/// What all ways of laying stitches share.
struct Ground<'s> {
    surface: &'s dyn ParametricSurface,
    rows: &'s Rows,
    gauge: &'s Gauge,
    options: &'s Options,
    /// The points at the closed ends.
    poles: [Option<DVec3>; 2],
    /// Least and greatest u of a node.
    range: [f64; 2],
    /// The first row is worked into a slit.
    slit: bool,
    /// The first row, where it is picked up.
    first: Option<&'s [Foot]>,
    /// About how many stitches there will be.
    expected: usize,
}

impl Ground<'_> {
    /// Even repeats on a surface of revolution, settled; with the stitches of the first row. `None` elsewhere.
    fn lay_evenly(&self, sink: &Sink<'_>) -> Option<(Sheet, usize)> {
        let Self { surface, rows, options, .. } = *self;
        let rounds = rows.count as u32;
        let girths: Vec<f64> =
            (0..rounds).map(|k| first_row::turn_length(surface, rows, k) / self.gauge.width).collect();
        let ring = self.poles[0].map(|_| first_row::ring_size(surface, rows, self.gauge));
        let counts = symmetric::plan_counts(&girths, ring, options.ease())?;
        let start = counts[0] as usize;
        let mut sheet = Sheet::new(self.gauge, counts.iter().map(|count| *count as usize).sum());
        first_row::lay(surface, &mut sheet, first_row::centered_places(counts[0]), rows);
        symmetric::lay_rounds(surface, &mut sheet, rows, &counts, |done| {
            sink.step(u64::from(done), u64::from(rounds));
        });
        let free = if self.poles[0].is_some() { 0 } else { start };
        let top = sheet.len() - counts[counts.len() - 1] as usize;
        let square = EVEN_SQUARENESS[self.poles.iter().filter(|pole| pole.is_none()).count()];
        let all = Stretch::since(Mark { nodes: free, ..Mark::default() }, &sheet);
        Relaxer::default().relax(
            surface,
            &mut sheet,
            all,
            0,
            Effort { sweeps: options.sweeps_over(all.until.nodes), squareness: options.squareness * square },
            Ends {
                range: self.range,
                ring: self.poles[0].map(|pole| (pole, start)),
                level: Some(Brink { rows, lag: 0.0, top, firm: Firm::No, tail: true }),
                opens: false,
            },
        );
        Some((sheet, start))
    }

    /// Row by row, for any surface; with the stitches of the first row, and the rows between the highest and the lowest loop
    /// of the last turn. `None` when the rows run away.
    fn weave(&self, judge: Judge, sink: &Sink<'_>) -> Option<(Sheet, usize, f64)> {
        let Self { surface, rows, options, .. } = *self;
        let mut sheet = Sheet::new(self.gauge, self.expected);
        if let Some(first) = self.first {
            first_row::lay_picked_up(&mut sheet, first);
        } else if self.poles[0].is_some() {
            let ring = first_row::ring_size(surface, rows, self.gauge);
            first_row::lay(surface, &mut sheet, first_row::centered_places(ring), rows);
        } else {
            let places =
                first_row::even_places(surface, rows, self.gauge.width, if self.slit { 2 } else { 1 });
            first_row::lay(surface, &mut sheet, places.into_iter(), rows);
        }
        let start = sheet.len();
        let most = MOST_TIMES * self.expected + MOST_MORE;
        let mut weaver = Weaver::new(surface, rows, options, sheet, self.poles, self.range, most);
        match weaver.run(judge, |done, total| sink.step(done, total)) {
            Outcome::Done => {
                let spread = weaver.spread();
                Some((weaver.sheet, start, spread))
            }
            Outcome::Runaway | Outcome::Outdone => None,
        }
    }
}
