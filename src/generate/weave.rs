//! The general generator: one row of the helix after the other, each placed on the surface, shaped, settled and filled up
//! with short rows before the next.
//!
//! The state is the ring: the open loops in working order. A batch works some or all of them once. What was decided in
//! earlier rows is settled again within the window, so that gaps and missing heights are true when they are decided.

mod settle;

use super::batch;
use super::marker::Marker;
use super::options::{Options, Preset};
use super::relax::{Mark, Relaxer};
use super::rows::{Rows, row_speed};
use super::sheet::{Edge, EdgeKind, Foot, Quad, Shaped, Sheet, ShortRow, TileKind, Work};
use super::short_rows::{GAP, Planner, Rules, Stretch};
use super::stacked::Stacked;
use super::staircase::{Ridge, Shaping, Staircase, Taste};
use super::stout::LEAST_LOOPS;
use super::top;
use super::tries::Judge;
use crate::ir::{NodeId, Stitch};
use crate::shape::{End, ParametricSurface};
use glam::DVec3;
use std::ops::Range;

/// Neighbors on either side that give the course direction at a base, at most; never more than a sixth of a turn away.
const REACH: usize = 3;
/// How far a stitch stretches or shrinks toward the level of its neighbors, per stitch height of difference, and at most.
const LEVELING: f64 = 0.858;
const LEVELING_MOST: f64 = 0.313;
/// Added to missing heights before short rows are planned: it is better to be a little early.
const EAGER: f64 = 0.328;
/// Distance of two rows, in stitch heights, over which short rows will lie between them.
const FAR: f64 = 1.5;
/// Share of the usual price of short-row ends in the last two rows, so that the top comes out level.
const LAST_ROWS_PRICE: f64 = 0.4;
const LAST_ROWS: f64 = 2.0;
/// A lag of the last row behind the helix that is worth more stitches, in rows.
const LEAST_LAG: f64 = 0.15;
/// Stitches more that a pass of a short row may be off before it is shaped, with full ease.
const PLAIN_PASSES: f64 = 1.5;
/// Stitches more that it may be off where an increase would stand on one of the pass below.
const PASS_RIDGE: f64 = 0.6;
/// How many times dearer the ends of short rows are with full ease.
const FEWER_ENDS: f64 = 1.0;
/// Fewest loops of a batch that short rows may lie on.
const LEAST_RING: usize = 9;
/// Most short rows over each other in one round.
const MOST_NESTED: u32 = 6;

/// How the weaving ended.
pub(crate) enum Outcome {
    /// All rows lie.
    Done,
    /// More nodes than any sensible count for this surface: it folds, or the gauge makes no sense here.
    Runaway,
    /// The first sweeps over the whole leave it worse than asked for, or a hurried try has inverted tiles.
    Outdone,
}

pub(crate) struct Weaver<'s> {
    surface: &'s dyn ParametricSurface,
    rows: &'s Rows,
    options: &'s Options,
    pub(crate) sheet: Sheet,
    relaxer: Relaxer,
    /// Open loops in working order.
    ring: Vec<NodeId>,
    /// Where each batch began.
    marks: Vec<Mark>,
    /// The bases worked last, newest first.
    behind: Vec<NodeId>,
    last_wale: Option<(NodeId, NodeId)>,
    last_foot: Option<DVec3>,
    /// Recent short-row ends.
    ends: Stacked,
    ring_center: Option<(DVec3, usize)>,
    marker: Marker,
    range: [f64; 2],
    part_batch: bool,
    /// By how many rows the work lies behind its helix at an open end: so much farther it goes on.
    lag: f64,
    end: End,
    opens: bool,
    tail: bool,
    ridge: Ridge,
    most: usize,
    // Buffers of one batch.
    feet: Vec<Foot>,
    gaps: Vec<f64>,
    missing: Vec<f64>,
    ahead: Vec<f64>,
    below: Vec<Shaped>,
    staircase: Staircase,
    planner: Planner,
}

impl<'s> Weaver<'s> {
    /// Starts from a sheet that holds the first row.
    pub(crate) fn new(
        surface: &'s dyn ParametricSurface,
        rows: &'s Rows,
        options: &'s Options,
        sheet: Sheet,
        poles: [Option<DVec3>; 2],
        range: [f64; 2],
        most: usize,
    ) -> Self {
        let first_row = sheet.len();
        Self {
            surface,
            rows,
            options,
            ring: (0..first_row as NodeId).collect(),
            sheet,
            relaxer: Relaxer::default(),
            marks: Vec::new(),
            behind: Vec::new(),
            last_wale: None,
            last_foot: None,
            ends: Stacked::default(),
            ring_center: poles[0].map(|pole| (pole, first_row)),
            marker: Marker::new(options.ease() > 0.0, first_row),
            range,
            part_batch: false,
            lag: 0.0,
            end: if poles[1].is_some() { End::Closed } else { End::Open },
            opens: false,
            tail: true,
            ridge: Ridge::default(),
            most,
            feet: Vec::new(),
            gaps: Vec::new(),
            missing: Vec::new(),
            ahead: Vec::new(),
            below: Vec::new(),
            staircase: Staircase::default(),
            planner: Planner::default(),
        }
    }

    /// Weaves all rows and settles the whole. `progress` hears of rows done.
    ///
    /// When its score is over the bar after the first sweeps it is given up.
    pub(crate) fn run(&mut self, judge: Judge, mut progress: impl FnMut(u64, u64)) -> Outcome {
        (self.opens, self.tail, self.ridge) = (judge.opens, judge.tail, judge.ridge);
        loop {
            self.look_for_missing();
            self.look_for_lag();
            let length = self.batch_length();
            self.part_batch = length < self.ring.len();
            self.marks.push(Mark::of(&self.sheet));
            let marker = self.marker.within(length, self.ring.len());
            let rest = self.ring.split_off(length);
            let bases = std::mem::replace(&mut self.ring, rest);
            let worked = self.place_feet(&bases);
            if worked == 0 {
                self.ring.splice(0..0, bases);
                break;
            }
            let before = self.behind.first().map_or(Shaped::No, |id| self.sheet.shaped[*id as usize]);
            let ease = self.options.ease();
            let taste = Taste { ease, marker, ridge: judge.ridge, before };
            let (tops, top_base) = self.work(&bases[..worked], taste);
            self.settle_window();
            let marked = marker.and_then(|base| top_base.iter().position(|id| *id == bases[base]));
            let first = marked.map(|top| tops[top]);
            if self.options.short_rows && tops.len() >= LEAST_RING {
                self.fill_up(tops, &top_base);
            } else {
                self.ring.extend_from_slice(&tops);
            }
            self.marker.moved(length, first, &self.ring);
            if self.sheet.len() > self.most || !self.sheet.point.last().is_some_and(|p| p.is_finite()) {
                return Outcome::Runaway;
            }
            progress(self.marks.len() as u64, self.rows.count as u64);
            if worked < bases.len() {
                self.ring.splice(0..0, bases[worked..].iter().copied());
                break;
            }
        }
        self.sheet.close();
        self.settle_whole(judge)
    }

    /// Rows between the highest and the lowest open loop, each against its place on the helix.
    pub(crate) fn spread(&self) -> f64 {
        top::spread(&self.sheet, self.rows, &self.ring)
    }

    /// The row of the helix at which the work ends.
    pub(crate) fn last_row(&self) -> f64 {
        self.rows.count + self.lag
    }

    /// How far behind its helix the ring lies, once that is worth another part of a row.
    fn look_for_lag(&mut self) {
        if self.end == End::Closed
            || self.options.paper
            || self.marks.len() as f64 + LAST_ROWS < self.rows.count
        {
            return;
        }
        let lag = top::lags(&self.sheet, self.rows, &self.ring).sum::<f64>() / self.ring.len() as f64;
        self.lag = if lag > LEAST_LAG { lag.min(1.0) } else { 0.0 };
    }

    /// Missing height at a node against its place on the helix, in stitch heights.
    fn missing_at(&self, id: NodeId) -> f64 {
        let i = id as usize;
        (self.rows.at(self.sheet.v[i]) - self.sheet.u[i]) * row_speed(&self.sheet.jet(id)) / self.sheet.height
    }

    /// Missing heights of the open loops.
    fn look_for_missing(&mut self) {
        let mut missing = std::mem::take(&mut self.missing);
        missing.clear();
        missing.extend(self.ring.iter().map(|id| self.missing_at(*id)));
        self.missing = missing;
    }

    /// How much of the ring the next batch takes.
    fn batch_length(&mut self) -> usize {
        let n = self.ring.len();
        let whole = !self.options.short_rows || self.options.paper;
        if whole || self.part_batch || self.marks.is_empty() {
            return n;
        }
        self.look_ahead();
        batch::length(&self.ahead)
    }

    /// Missing heights of the open loops, and what the next row adds where rows lie so far apart that short rows fill up between
    /// them soon.
    fn look_ahead(&mut self) {
        self.ahead.clear();
        self.ahead.extend_from_slice(&self.missing);
        let ends = [self.ring.first(), self.ring.last()];
        let [first, last] = ends.map(|id| id.map_or(0.0, |id| self.sheet.v[*id as usize]));
        if self.rows.farthest([first, last + 1.0]) <= FAR {
            return;
        }
        for (ahead, id) in self.ahead.iter_mut().zip(&self.ring) {
            let v = self.sheet.v[*id as usize];
            let next = self.rows.at(v + 1.0).min(1.0);
            let speed = row_speed(&self.surface.jet(next, v));
            let apart = (next - self.rows.at(v)) * speed / self.sheet.height;
            *ahead += (apart - FAR).max(0.0);
        }
    }

    /// Feet of the stitches over the bases: an offset of the front, leveled a little. Returns how many bases still lie below
    /// the last row.
    fn place_feet(&mut self, bases: &[NodeId]) -> usize {
        let n = bases.len();
        if self.options.paper {
            let places = bases.iter().map(|id| (self.sheet.u[*id as usize], self.sheet.v[*id as usize]));
            self.feet = super::paper::feet(self.surface, self.rows, self.sheet.height, places);
            return self.feet.len();
        }
        // Those of the bases: what else there is goes beyond.
        self.missing.truncate(n);
        self.feet.clear();
        let reach = reach(n + self.ring.len());
        let mut neighbors = 0.0;
        for k in 0..n.min(reach) {
            neighbors += self.missing[k];
        }
        for (i, &base) in bases.iter().enumerate() {
            // `neighbors` is the sum over i - reach ..= i + reach, cut at the ends.
            if let Some(enters) = self.missing.get(i + reach) {
                neighbors += enters;
            }
            if i > reach {
                neighbors -= self.missing[i - reach - 1];
            }
            if self.sheet.v[base as usize] + 1.0 > self.last_row() {
                return i;
            }
            let left = if i >= reach {
                bases[i - reach]
            } else {
                self.behind.get(reach - i - 1).or(self.behind.last()).copied().unwrap_or(bases[0])
            };
            let right = bases.get(i + reach).or(self.ring.get(i + reach - n.min(i + reach)));
            let right = right.copied().unwrap_or(bases[n - 1]);
            let (along, up) = self.sheet.directions(base, left, right);
            let others = i.min(reach) + (n - 1 - i).min(reach);
            let lag = if others > 0 {
                self.missing[i] - (neighbors - self.missing[i]) / others as f64
            } else {
                0.0
            };
            let stretch = 1.0 + (LEVELING * lag).clamp(-LEVELING_MOST, LEVELING_MOST);
            let mut foot = self.walk(base, up, self.sheet.height * stretch, along);
            foot.v += 1.0;
            self.feet.push(foot);
        }
        n
    }

    /// Up from a base along the surface.
    fn walk(&self, base: NodeId, up: DVec3, distance: f64, along: DVec3) -> Foot {
        let walk = if self.quick() { Sheet::step } else { Sheet::walk };
        walk(&self.sheet, self.surface, base, up, distance, along)
    }

    /// Someone waits: feet are looked up once, and nodes that settle stay on their planes until the end.
    fn quick(&self) -> bool {
        self.options.preset == Preset::Fast
    }

    /// Signed distance between two feet along the course, in stitch widths. Unsigned, crossed feet would look like growth.
    fn gap(&self, before: DVec3, foot: &Foot) -> f64 {
        let d = foot.point - before;
        let along = d.dot(foot.along);
        // The paper compares vertices of one level; of two levels the distance along the course stands for it.
        (if along > 0.0 && !self.options.paper { d.length() } else { along }) / self.sheet.width
    }

    /// Works one row over the bases: shaping, tops, edges and tiles. Returns the tops and the base of each.
    fn work(&mut self, bases: &[NodeId], taste: Taste) -> (Vec<NodeId>, Vec<NodeId>) {
        let all_feet = std::mem::take(&mut self.feet);
        let feet = &all_feet[..bases.len()];
        self.gaps.clear();
        for (i, foot) in feet.iter().enumerate() {
            let before = if i == 0 { self.last_foot } else { Some(feet[i - 1].point) };
            let gap = before.map_or(1.0, |before| self.gap(before, foot));
            self.gaps.push(gap);
        }
        self.below.clear();
        // The loop after the last is a neighbor too.
        let bases_and_next = bases.iter().chain(self.ring.first());
        self.below.extend(bases_and_next.map(|id| self.sheet.shaped[*id as usize]));
        if self.options.paper {
            let Staircase { plan, rest, .. } = &mut self.staircase;
            super::paper::shape(&self.gaps, &self.below, plan, rest);
        } else {
            self.staircase.solve(&self.gaps, &self.below, taste);
        }
        let mut tops = Vec::with_capacity(bases.len() + 8);
        let mut top_base = Vec::with_capacity(bases.len() + 8);
        let width = self.sheet.width;
        for (i, (&base, foot)) in bases.iter().zip(feet).enumerate() {
            let plan = self.staircase.plan[i];
            let left = tops.len() + self.ring.len() + bases.len() - i;
            if plan == Shaping::Dec
                && left > LEAST_LOOPS
                && let Some(&top) = tops.last()
                && let Some(work) = self.sheet.main.last_mut()
            {
                work.stitch = Stitch::DEC;
                work.base[1] = base;
                self.sheet.join_top(top, foot.point);
                self.sheet.wale(self.last_wale, base, top);
                self.last_wale = Some((base, top));
            } else {
                let inc = plan == Shaping::Inc;
                let offsets: &[f64] = if inc { &[-0.45, 0.45] } else { &[-0.5 * self.staircase.rest[i]] };
                let mut made = [0; 2];
                for (z, offset) in offsets.iter().enumerate() {
                    let place = foot.shifted(offset * width);
                    let top = self.sheet.add(&place, if inc { Shaped::Inc } else { Shaped::No });
                    let yarn = self.last_wale.map_or(top - 1, |(_, top)| top);
                    self.sheet.course(yarn, top);
                    self.sheet.wale(self.last_wale, base, top);
                    self.last_wale = Some((base, top));
                    made[z] = top;
                    tops.push(top);
                    top_base.push(base);
                }
                if !inc {
                    made[1] = made[0];
                }
                let stitch = if inc { Stitch::INC } else { Stitch::SC };
                self.sheet.main.push(Work { stitch, base: [base; 2], top: made });
            }
        }
        self.last_foot = feet.last().map(|foot| foot.point);
        // The next row has use for the room.
        self.feet = all_feet;
        self.behind.clear();
        self.behind.extend(bases.iter().rev().take(REACH));
        (tops, top_base)
    }

    /// Puts the new tops into the ring, with short rows over them where they lag behind, and short rows over these where
    /// even they do: a tight bend asks for many rows on its outer side.
    fn fill_up(&mut self, tops: Vec<NodeId>, top_base: &[NodeId]) {
        self.ends.fade();
        let around = tops.len() + self.ring.len();
        let cut = (0..tops.len()).map(|k| k > 0 && top_base[k] != top_base[k - 1]).collect();
        let start = self.ring.len();
        self.ring.extend_from_slice(&tops);
        let mut stretches = vec![Stretch { start, tops, cut }];
        for _ in 0..MOST_NESTED {
            let mut raised = Vec::new();
            // From right to left, so that places in the ring stay true.
            for stretch in stretches.iter().rev() {
                self.raise(stretch, around, &mut raised);
            }
            if raised.is_empty() {
                break;
            }
            raised.reverse();
            // Stretches to the left may have moved those to the right.
            let mut moved = 0;
            for stretch in &mut raised {
                stretch.0.start = (stretch.0.start as isize + moved) as usize;
                moved += stretch.1;
            }
            self.settle_window();
            stretches = raised.into_iter().map(|(stretch, _)| stretch).collect();
        }
    }

    /// Adds short rows over a stretch of the ring. What they raise goes to `raised`, rightmost first, with the number of
    /// loops that the ring gained.
    fn raise(&mut self, stretch: &Stretch, around: usize, raised: &mut Vec<(Stretch, isize)>) {
        let tops = &stretch.tops;
        let size = around as f64;
        let eager = if self.options.paper { super::paper::EAGER } else { EAGER };
        let missing: Vec<f64> = tops.iter().map(|id| self.missing_at(*id) + eager).collect();
        let least = (self.options.min_short_row as usize).min((0.3 * size) as usize).max(3);
        let greatest = (self.options.max_short_row * size) as usize;
        let (activation, tolerance) = (self.options.activation, self.options.tolerance);
        let mut rules = Rules::from_thresholds(activation, tolerance, least, greatest);
        if self.marks.len() as f64 > self.rows.count - LAST_ROWS {
            rules.end_price *= LAST_ROWS_PRICE;
        }
        rules.end_price *= 1.0 + FEWER_ENDS * self.options.ease();
        if !rules.may_pay(&missing) {
            return;
        }
        let places: Vec<f64> = tops.iter().map(|id| self.sheet.v[*id as usize]).collect();
        let extra = self.ends.prices(&places, size);
        let mut runs = Vec::new();
        self.planner.solve(&missing, &extra, &stretch.cut, &rules, &mut runs);
        for run in runs.iter().rev() {
            let (open, cut) = self.short_row(tops, run.clone());
            let start = stretch.start + run.start;
            self.ring.splice(start..start + run.len(), open.iter().copied());
            let gained = open.len() as isize - run.len() as isize;
            raised.push((Stretch { start, tops: open, cut }, gained));
        }
    }

    /// Adds one short row over a run of tops: back over it, forward over that. Returns the loops now open there, and where
    /// among them another run may begin or end.
    fn short_row(&mut self, tops: &[NodeId], run: Range<usize>) -> (Vec<NodeId>, Vec<bool>) {
        let (first, last) = (run.start, run.end - 1);
        for top in [first, last].map(|end| tops[end] as usize) {
            self.ends.push(self.sheet.v[top]);
        }
        let (back_tops, back) = self.pass(&tops[run], TileKind::TurnRight);
        let (open, forward) = self.pass(&back_tops, TileKind::TurnLeft);
        let mut cut = Vec::with_capacity(open.len());
        for work in &forward {
            cut.push(!cut.is_empty());
            if work.top[0] != work.top[1] {
                cut.push(false);
            }
        }
        self.sheet.short_rows.push(ShortRow { after: tops[last], back, forward });
        // The yarn goes down a step behind the run, and the fabric goes up one before it.
        let (before, end, next) = (tops[first - 1], open[open.len() - 1], tops[last + 1]);
        self.sheet.steps[before as usize] = true;
        self.sheet.steps[end as usize] = true;
        let arrival = self.sheet.arrival[next as usize] as usize;
        self.sheet.edges[arrival] = Edge { a: end, b: next, kind: EdgeKind::Step };
        self.sheet.edges.push(Edge { a: before, b: open[0], kind: EdgeKind::Step });
        (open, cut)
    }

    /// One of these loops is of an increase.
    fn beside_increase(&self, loops: &[NodeId]) -> bool {
        loops.iter().any(|id| self.sheet.shaped[*id as usize] == Shaped::Inc)
    }

    /// One pass of a short row over `bases`, from left to right whatever its direction of work.
    fn pass(&mut self, bases: &[NodeId], turn: TileKind) -> (Vec<NodeId>, Vec<Work>) {
        const LEAK: f64 = 0.9;
        const COOLDOWN: i32 = 4;
        // Short rows are easier to work without shaping.
        let threshold = 0.5 + PLAIN_PASSES * self.options.ease();
        let n = bases.len();
        let reach = reach(n);
        let feet: Vec<Foot> = (0..n)
            .map(|i| {
                let (left, right) = (bases[i.saturating_sub(reach)], bases[(i + reach).min(n - 1)]);
                let (along, up) = self.sheet.directions(bases[i], left, right);
                self.walk(bases[i], up, self.sheet.height, along)
            })
            .collect();
        let mut tops: Vec<NodeId> = Vec::with_capacity(n + 2);
        let mut works: Vec<Work> = Vec::with_capacity(n);
        let mut wales: [Option<(NodeId, NodeId)>; 4] = [None; 4]; // first two, last two
        let mut note = |count: usize, wale| {
            if count < 2 {
                wales[count] = Some(wale);
            }
            (wales[2], wales[3]) = (wales[3], Some(wale));
        };
        let (mut error, mut wait, mut before, mut count) = (0.0, 2, None, 0);
        for i in 0..n {
            let mut plan = Shaping::Plain;
            if i > 0 {
                error = (error + self.gap(feet[i - 1].point, &feet[i]) - 1.0) * LEAK;
                if wait <= 0 && i + 2 < n {
                    let (own, left) =
                        (self.sheet.shaped[bases[i] as usize], self.sheet.shaped[bases[i - 1] as usize]);
                    let beside = self.beside_increase(&bases[i - 1..i + 2]);
                    let most = if self.ridge == Ridge::Dear { f64::INFINITY } else { PASS_RIDGE };
                    let ridge = if beside { most } else { 0.0 };
                    if error > threshold + ridge && own != Shaped::Dec {
                        plan = Shaping::Inc;
                        error -= 1.0;
                        wait = COOLDOWN;
                    } else if error < -threshold && own != Shaped::Inc && left != Shaped::Inc {
                        plan = Shaping::Dec;
                        error += 1.0;
                        wait = COOLDOWN;
                    }
                }
                wait -= 1;
            }
            if plan == Shaping::Dec
                && let Some(&top) = tops.last()
                && let Some(work) = works.last_mut()
            {
                work.stitch = Stitch::DEC;
                work.base[1] = bases[i];
                self.sheet.join_top(top, feet[i].point);
                self.sheet.wale(before, bases[i], top);
                before = Some((bases[i], top));
                note(count, (bases[i], top));
                count += 1;
                continue;
            }
            let inc = plan == Shaping::Inc;
            let offsets: &[f64] = if inc { &[-0.5, 0.5] } else { &[0.0] };
            let mut made = [0; 2];
            for (z, offset) in offsets.iter().enumerate() {
                let place = feet[i].shifted(offset * self.sheet.width);
                let top = self.sheet.add(&place, if inc { Shaped::Inc } else { Shaped::No });
                if let Some(&left) = tops.last() {
                    self.sheet.course(left, top);
                }
                self.sheet.wale(before, bases[i], top);
                before = Some((bases[i], top));
                note(count, (bases[i], top));
                count += 1;
                made[z] = top;
                tops.push(top);
            }
            if !inc {
                made[1] = made[0];
            }
            works.push(Work {
                stitch: if inc { Stitch::INC } else { Stitch::SC },
                base: [bases[i]; 2],
                top: made,
            });
        }
        let pair = if turn == TileKind::TurnRight { [wales[2], wales[3]] } else { [wales[0], wales[1]] };
        if let [Some(left), Some(right)] = pair {
            self.sheet.quads.push(Quad { corners: [left.0, right.0, left.1, right.1], kind: turn });
        }
        (tops, works)
    }
}

/// Neighbors that give the course direction in a ring of `size` loops.
fn reach(size: usize) -> usize {
    (size / 4).clamp(1, REACH)
}

const _: () = assert!(GAP >= 2, "a short row needs a neighbor on either side");
