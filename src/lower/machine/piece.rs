//! One piece from its first loops to its end: the driver that keeps the loops on the needles in the order of the pattern.

use super::begin::{self, Begin};
use super::bench::Bench;
use super::bind_off;
use super::emit::Origin;
use super::plan::{self, Action, Leg};
use super::refuse::Reason;
use super::tube::{ItemId, Stuck, Tube};
use super::yarns::{Yarns, palette};
use super::{Options, carrier};
use crate::diag::{Code as Finding, Diagnostic, Sink};
use crate::ir::machine::profile::{BringIn, Increase, Transfer, Waste};
use crate::ir::machine::{Bed, CarrierId, CarrierSet, Instruction, Machine, Needle};
use crate::ir::{Direction, Finish, Part, PartId, Pattern};
use std::collections::{BTreeSet, VecDeque};

/// Knits a piece on the bench. `unwrapped` are turns whose wrap would overload a needle; what went wrong comes back.
pub(super) fn knit(
    piece: begin::Piece,
    pattern: &Pattern,
    bench: &mut Bench<'_>,
    options: &Options,
    unwrapped: &BTreeSet<u32>,
    sink: &mut Sink<'_>,
) -> Result<(), Reason> {
    let Some(part) = pattern.parts.get(piece.part as usize) else { return Ok(()) };
    bench.emitter.origin = Origin { part: piece.part, round: 0, stitch: 0 };
    let machine = bench.machine;
    let yarns = Yarns::new(machine, begin::first_color(part));
    let worker = Worker {
        part,
        id: PartId(piece.part),
        kept: piece.kept,
        pattern,
        options,
        bench,
        yarns,
        unwrapped,
        shapings: 0,
        turns: 0,
    };
    worker.run(sink)
}

struct Worker<'a, 'm> {
    part: &'a Part,
    id: PartId,
    kept: bool,
    pattern: &'a Pattern,
    options: &'a Options,
    bench: &'a mut Bench<'m>,
    yarns: Yarns<'m>,
    unwrapped: &'a BTreeSet<u32>,
    /// Increases and decreases of the current course.
    shapings: u32,
    /// Turns so far.
    turns: u32,
}

impl<'m> Worker<'_, 'm> {
    fn machine(&self) -> &'m Machine {
        self.bench.machine
    }

    fn run(mut self, sink: &mut Sink<'_>) -> Result<(), Reason> {
        let machine = self.machine();
        let begin = begin::begin(self.pattern, self.part, self.options, sink).ok_or(Reason::Told)?;
        self.bench.emitter.origin.round = 1;
        self.settings();
        let skipped = if let Begin::Fresh { skipped, .. } = begin { skipped } else { 0 };
        let mut tube = self.begin(&begin)?;
        self.wide()?;
        let mut narrowest = tube.open_loops();
        let mut color = begin::first_color(self.part);
        for (number, row) in self.part.numbered_rows().skip(skipped) {
            for (copy, number) in (number..number.saturating_add(row.times)).enumerate() {
                // Equal rows say the same of their stitches; once is enough.
                let mut silent = Sink::new();
                let heard = if copy == 0 { &mut *sink } else { &mut silent };
                let plan =
                    plan::row(self.part, row, number, color, self.options, heard).ok_or(Reason::Told)?;
                color = plan.color;
                self.bench.emitter.origin.round = number;
                self.shapings = 0;
                let depth = machine.limits.short_row_depth;
                if depth > 0 && plan.legs.len() > depth as usize {
                    self.depth(&plan.legs, tube.ahead.len())?;
                }
                self.row(&mut tube, &plan.legs)?;
                for _ in 0..plan.plain_rounds {
                    let plain = Leg::plain(tube.ahead.len(), color);
                    self.row(&mut tube, &[plain])?;
                }
                narrowest = narrowest.min(tube.open_loops());
            }
        }
        self.bench.emitter.origin.stitch = 0;
        if tube.heading.is_none() && narrowest < machine.tube.min_loops as usize {
            let message = format!("the tube narrows to {narrowest} loops");
            let (least, name) = (machine.tube.min_loops, &machine.name);
            sink.push(
                Diagnostic::new(Finding::NarrowTube, message)
                    .in_round(&self.part.name, None)
                    .help(format!("`tube.min_loops` of `{name}` is {least}; watch the take-down there")),
            );
        }
        if self.kept {
            self.yarns.finish(&mut self.bench.emitter);
            self.bench.emitter.rest();
            self.bench.leave(self.id, None, tube);
        } else {
            if !self.yarns.started() {
                let plain = Leg::plain(tube.ahead.len(), color);
                self.row(&mut tube, &[plain])?;
            }
            self.finish(&mut tube)?;
        }
        self.wide()
    }

    /// The first loops on their needles.
    fn begin(&mut self, begin: &Begin) -> Result<Tube, Reason> {
        let (machine, from_right) = (self.machine(), self.bench.from_right);
        if usize::from(begin::first_color(self.part)) >= palette(machine).len() {
            return Err(Reason::Colors(u32::from(begin::first_color(self.part)) + 1));
        }
        let (loops, closed) = match begin {
            Begin::Join(_) if self.part.flat => return Err(Reason::FlatJoin),
            Begin::Join(sources) => return self.bench.join(sources, self.id, &mut self.yarns),
            &Begin::Fresh { loops, closed, .. } => (loops, closed),
        };
        let yarn = CarrierSet::one(self.yarns.carrier());
        let [first, last] = machine.bed.needles;
        if self.part.flat {
            if i64::from(loops) > i64::from(last) - i64::from(first) + 1 {
                return Err(Reason::Wide(loops.min(i32::MAX as u32) as i32));
            }
            let mut sheet = Tube::sheet(loops, from_right, self.bench.bounds(), yarn);
            if loops == 0 {
                return Err(Stuck::Underflow.into());
            }
            self.cast_on(&mut sheet, false);
            sheet.behind = std::mem::take(&mut sheet.ahead);
            sheet.end_row();
            return Ok(sheet);
        }
        if loops < 2 {
            return Err(Stuck::Narrow.into());
        }
        if loops > machine.tube.max_loops {
            return Err(Reason::Loops(loops));
        }
        let mut tube = Tube::new(loops, from_right, self.bench.bounds(), yarn);
        self.bench.place_new(&mut tube);
        self.bench.yarn_reaches(&tube)?;
        self.cast_on(&mut tube, closed);
        Ok(tube)
    }

    /// Stitch size, speed and take-down where the profile has them.
    fn settings(&mut self) {
        let machine = self.machine();
        let emitter = &mut self.bench.emitter;
        let mut say = |name: &str, value: Option<u32>| {
            if let Some(value) = value
                && machine.extensions.iter().any(|known| known == name)
            {
                emitter.extension(format!("{name} {value}"));
            }
        };
        let sizes = machine.stitch_number.as_ref();
        say("x-stitch-number", sizes.map(|sizes| u32::from(sizes.default)));
        say("x-xfer-stitch-number", sizes.map(|sizes| u32::from(sizes.xfer)));
        say("x-speed-number", machine.speed.as_ref().and_then(|speed| speed.default));
        say("x-roller-advance", machine.roller.as_ref().map(|roller| roller.default));
        let style = "x-xfer-style";
        if machine.methods.transfer == Transfer::TwoPass
            && machine.extensions.iter().any(|known| known == style)
        {
            emitter.extension(format!("{style} two-pass"));
        }
    }

    fn cast_on(&mut self, tube: &mut Tube, closed: bool) {
        let machine = self.machine();
        let circle: Vec<ItemId> = tube.ahead.iter().copied().collect();
        let yarn = self.yarns.carrier();
        if let Some(waste) = waste_yarn(machine, self.options) {
            self.waste(waste, tube, &circle);
            self.bench.emitter.remark("the piece; unravel the waste by pulling the draw thread".to_owned());
            Yarns::bring_in(machine, yarn, &mut self.bench.emitter);
        } else {
            Yarns::bring_in(machine, yarn, &mut self.bench.emitter);
            let tucks = if closed { self.closed(tube) } else { every_second(&circle, tube) };
            for &(id, forward) in &tucks {
                self.bench.emitter.tuck(tube.direction(id, forward), tube.needle(id), CarrierSet::one(yarn));
            }
        }
        self.plain_course(tube, &circle, yarn, true);
        if let Some(&last) = circle.last() {
            self.yarns.stands_at(tube.needle(last).index);
        }
    }

    /// Items in the order of a closed cast-on: away from the yarn on alternating beds, and back over the others. With
    /// each, whether it is tucked along the course: one bed of each pass is not.
    fn closed(&self, tube: &Tube) -> Vec<(ItemId, bool)> {
        let from_right = self.bench.from_right;
        let mut slots = tube.slots();
        if from_right {
            slots.reverse();
        }
        let (mut there, mut back) = (Vec::new(), Vec::new());
        for (place, &(front, rear)) in slots.iter().enumerate() {
            let (first, second) = if (place % 2 == 0) == from_right { (front, rear) } else { (rear, front) };
            there.extend(first);
            back.extend(second);
        }
        // A missing partner at the edge goes with the first pass.
        while there.len() < back.len() {
            let Some(id) = back.pop() else { break };
            there.push(id);
        }
        back.reverse();
        let near = if from_right { Bed::Front } else { Bed::Back };
        let first = there.into_iter().map(|id| (id, tube.bed(id) == near));
        let second = back.into_iter().map(|id| (id, tube.bed(id) != near));
        first.chain(second).collect()
    }

    /// A course of plain loops; where `hooked`, the hook lets go after its first bed.
    fn plain_course(&mut self, tube: &mut Tube, circle: &[ItemId], yarn: CarrierId, hooked: bool) {
        tube.set_carriers(CarrierSet::one(yarn));
        let mut held = hooked && self.machine().entry.bring_in == BringIn::Hook;
        let first = circle.first().map(|&id| tube.bed(id));
        for &id in circle {
            if held && first != Some(tube.bed(id)) {
                held = false;
                self.bench.emitter.push(Instruction::ReleaseHook(CarrierSet::one(yarn)));
            }
            tube.work(id, true, &mut self.bench.emitter);
        }
        if held {
            self.bench.emitter.push(Instruction::ReleaseHook(CarrierSet::one(yarn)));
        }
    }

    fn waste(&mut self, waste: &Waste, tube: &mut Tube, circle: &[ItemId]) {
        let machine = self.machine();
        let (yarn, draw) = (carrier(machine, &waste.carrier), carrier(machine, &waste.draw));
        let heading = tube.heading;
        self.bench.emitter.remark("waste section".to_owned());
        Yarns::bring_in(machine, yarn, &mut self.bench.emitter);
        for (id, forward) in every_second(circle, tube) {
            self.bench.emitter.tuck(tube.direction(id, forward), tube.needle(id), CarrierSet::one(yarn));
        }
        let back: Vec<ItemId> = circle.iter().rev().copied().collect();
        for course in 0..waste.rows {
            let turned = heading.is_some() && course % 2 == 1;
            self.plain_course(tube, if turned { &back } else { circle }, yarn, course == 0);
            tube.heading = tube.heading.map(crate::ir::machine::Direction::reverse);
        }
        tube.heading = heading;
        Yarns::take_out(machine, yarn, &mut self.bench.emitter);
        self.bench.emitter.remark("draw thread".to_owned());
        Yarns::bring_in(machine, draw, &mut self.bench.emitter);
        self.plain_course(tube, circle, draw, true);
        Yarns::take_out(machine, draw, &mut self.bench.emitter);
    }

    /// Works the legs of one row.
    fn row(&mut self, tube: &mut Tube, legs: &[Leg]) -> Result<(), Reason> {
        self.bench.emitter.origin.stitch = 0;
        let growth: i32 = legs
            .iter()
            .flat_map(|leg| &leg.actions)
            .map(|action| i32::from(action.makes) - i32::from(action.works))
            .filter(|growth| *growth > 0)
            .sum();
        self.bench.make_room(tube, growth + 2);
        for (index, leg) in legs.iter().enumerate() {
            if leg.hold.is_some_and(|(loops, _)| loops as usize >= tube.open_loops()) {
                return Err(Reason::NothingLeft);
            }
            if let Some((loops, by)) = leg.hold {
                self.yarns.settle(&mut self.bench.emitter);
                // The limb nearest to the yarn goes on, so what waits lies at the far edge.
                let far_left = self.bench.from_right;
                self.bench.make_room(tube, 2);
                let aside = tube.set_aside(loops, far_left, &mut self.bench.emitter)?;
                self.bench.leave(self.id, Some(by), aside);
                self.wide()?;
            }
            self.leg(tube, leg)?;
            self.wide()?;
            if legs.get(index + 1).is_some_and(|next| next.direction != leg.direction) {
                self.wrap(tube, leg.direction == Direction::Forward)?;
            }
        }
        self.yarns.settle(&mut self.bench.emitter);
        tube.end_row();
        let loops = tube.open_loops() as u32;
        if tube.heading.is_none() && loops > self.machine().tube.max_loops {
            return Err(Reason::Loops(loops));
        }
        Ok(())
    }

    /// The wrap of a turn, on the loop that the leg would have come to next.
    fn wrap(&mut self, tube: &mut Tube, forward: bool) -> Result<(), Reason> {
        let turn = self.turns;
        self.turns += 1;
        let next = if forward {
            tube.ahead.front()
        } else {
            tube.behind.back().or(if tube.heading.is_some() { tube.rest.front() } else { tube.ahead.back() })
        };
        match next {
            Some(&next) if !self.unwrapped.contains(&turn) => {
                let direction = tube.direction(next, forward);
                Ok(tube.wrap(next, direction, Some(turn), &mut self.bench.emitter)?)
            }
            Some(_) => {
                let why = "no wrap at this turn: its needle would hold too many loops";
                self.bench.emitter.remark(why.to_owned());
                Ok(())
            }
            None => Ok(()),
        }
    }

    /// Works one leg.
    fn leg(&mut self, tube: &mut Tube, leg: &Leg) -> Result<(), Reason> {
        let forward = leg.direction == Direction::Forward;
        let base = self.bench.emitter.origin.stitch;
        if leg.actions.iter().any(|action| action.works != 1 || action.makes != 1) {
            self.yarns.settle(&mut self.bench.emitter);
        }
        // A needle with its stitch; `None` for chains, which have no needle yet.
        let mut work: Vec<(Option<ItemId>, usize)> = Vec::with_capacity(leg.actions.len());
        let mut taken = VecDeque::new();
        for (at, action) in leg.actions.iter().enumerate() {
            self.bench.emitter.origin.stitch = base + at as u32 + 1;
            if usize::from(action.color) >= palette(self.machine()).len() {
                return Err(Reason::Colors(u32::from(action.color) + 1));
            }
            taken.clear();
            for _ in 0..action.works {
                let next = if forward { tube.ahead.pop_front() } else { tube.behind.pop_back() };
                taken.push_back(next.ok_or(Stuck::Underflow)?);
            }
            let mut kept = taken.pop_front();
            while let (Some(before), Some(next)) = (kept, taken.pop_front()) {
                self.count_shaping()?;
                let (first, second) = if forward { (before, next) } else { (next, before) };
                kept = Some(tube.close(first, second, &mut self.bench.emitter)?);
            }
            work.push((kept, at));
        }
        let mut tops: Vec<(ItemId, usize)> = Vec::with_capacity(work.len());
        for &(kept, at) in &work {
            let Some(action) = leg.actions.get(at) else { continue };
            self.bench.emitter.origin.stitch = base + at as u32 + 1;
            let from = tops.len();
            let before =
                kept.or_else(|| tops.last().map(|(id, _)| *id)).or_else(|| tube.behind.back().copied());
            let Some(before) = before else { return Err(Reason::NoLoopBefore) };
            for _ in u16::from(kept.is_some())..action.makes {
                self.count_shaping()?;
                let ghost = tube.open(before, &mut self.bench.emitter)?;
                tops.insert(from, (ghost, at));
            }
            if let Some(kept) = kept {
                tops.insert(from, (kept, at));
            }
            if !forward && let Some(group) = tops.get_mut(from..) {
                group.reverse();
            }
        }
        let mut split: Vec<(Needle, ItemId, usize)> = Vec::new();
        let mut order = tops.iter().copied().peekable();
        while let Some((id, at)) = order.next() {
            self.bench.emitter.origin.stitch = base + at as u32 + 1;
            let color = leg.actions.get(at).map_or(0, |action| action.color);
            let second = order.peek().filter(|(_, other)| *other == at).map(|(second, _)| *second);
            if let Some(second) = second
                && let Some(park) = self.split(tube, leg.actions.get(at), id, second, forward)
            {
                order.next();
                split.push((park, second, at));
            } else {
                self.yarns.stitch(tube, id, forward, color, &mut self.bench.emitter)?;
            }
        }
        if !split.is_empty() {
            self.yarns.settle(&mut self.bench.emitter);
        }
        for (park, second, at) in split {
            self.bench.emitter.origin.stitch = base + at as u32 + 1;
            let needle = tube.needle(second);
            self.bench.emitter.xfer(park, needle);
            tube.change(second, |item| item.ghost = false);
        }
        self.bench.emitter.origin.stitch = base + leg.actions.len() as u32;
        let tops = tops.into_iter().map(|(id, _)| id);
        if forward {
            tube.behind.extend(tops);
        } else {
            tops.for_each(|top| tube.ahead.push_front(top));
        }
        Ok(())
    }

    /// Makes both loops of an increase by a split where the profile asks for it: the new loop stays on the needle, and
    /// the old one waits on the facing needle until the leg is done. `None` where the two needles are no neighbors or the
    /// yarn only begins.
    fn split(
        &mut self,
        tube: &mut Tube,
        action: Option<&Action>,
        first: ItemId,
        second: ItemId,
        forward: bool,
    ) -> Option<Needle> {
        let two = action.is_some_and(|action| action.works == 1 && action.makes == 2);
        let (kept, ghost) = (first, second);
        let (a, b) = (tube.item(kept), tube.item(ghost));
        let neighbors = a.bed == b.bed && (a.slot - b.slot).abs() == 1 && !a.ghost && b.ghost;
        let able = self.machine().methods.increase == Increase::Split && self.machine().performs("split");
        if tube.packed() || !able || !two || !neighbors || !forward {
            return None;
        }
        let color = action.map_or(0, |action| action.color);
        self.yarns.goes_on_at(tube, kept, color, &mut self.bench.emitter).then(|| {
            let park = tube.split(kept, forward, &mut self.bench.emitter);
            tube.change(ghost, |item| {
                item.loops = a.loops;
                item.wrap = a.wrap;
            });
            park
        })
    }

    fn count_shaping(&mut self) -> Result<(), Reason> {
        self.shapings += 1;
        let limit = self.machine().limits.shapings_per_course;
        if limit > 0 && self.shapings > limit { Err(Reason::Shapings(self.shapings)) } else { Ok(()) }
    }

    /// The most courses that some needles are knit while others wait, over the legs of one row.
    fn depth(&self, legs: &[Leg], open: usize) -> Result<(), Reason> {
        let (mut ahead, mut behind): (VecDeque<u32>, VecDeque<u32>) = (vec![0; open].into(), VecDeque::new());
        let mut deepest = 0;
        for leg in legs {
            let forward = leg.direction == Direction::Forward;
            let held = leg.hold.map_or(0, |(loops, _)| loops as usize).min(ahead.len());
            ahead.drain(..held);
            for action in &leg.actions {
                let taken = (0..action.works)
                    .filter_map(|_| if forward { ahead.pop_front() } else { behind.pop_back() })
                    .max()
                    .unwrap_or(0);
                deepest = deepest.max(taken + 1);
                for _ in 0..action.makes {
                    if forward {
                        behind.push_back(taken + 1);
                    } else {
                        ahead.push_front(taken + 1);
                    }
                }
            }
        }
        if deepest > self.machine().limits.short_row_depth { Err(Reason::Depth(deepest)) } else { Ok(()) }
    }

    fn wide(&self) -> Result<(), Reason> {
        let [first, last] = self.machine().bed.needles;
        match self.bench.emitter.reach() {
            Some((left, right)) if right - left > last - first => Err(Reason::Wide(right - left + 1)),
            _ => Ok(()),
        }
    }

    fn finish(&mut self, tube: &mut Tube) -> Result<(), Reason> {
        let machine = self.machine();
        let closed = self.part.finish == Finish::DrawnShut;
        if !bind_off::can_bind_off(tube, closed)
            && let Some(waste) = waste_yarn(machine, self.options)
        {
            self.end_on_waste(tube, waste, closed);
            return Ok(());
        }
        let emitter = &mut self.bench.emitter;
        if let Some(sizes) = &machine.stitch_number
            && machine.extensions.iter().any(|known| known == "x-stitch-number")
        {
            emitter.extension(format!("x-stitch-number {}", sizes.bind_off));
        }
        emitter.remark("bind off".to_owned());
        if let Some(heading) = tube.heading
            && !tube.rest.is_empty()
        {
            // Loops that the last row left lie before the yarn; a plain course over them brings it to the end.
            tube.heading = Some(heading.reverse());
            let rest: Vec<ItemId> = tube.rest.drain(..).collect();
            for &id in &rest {
                tube.work(id, true, emitter);
                tube.ahead.push_front(id);
            }
            tube.heading = Some(heading);
        }
        let last = bind_off::bind_off(tube, closed, emitter)?;
        for step in 0..bind_off::TAIL {
            tube.work(last, step % 2 == 1, emitter);
        }
        self.yarns.finish(emitter);
        emitter.push(Instruction::Drop(tube.needle(last)));
        emitter.rest();
        Ok(())
    }

    /// Courses of waste yarn hold the last loops until they are secured by hand.
    fn end_on_waste(&mut self, tube: &mut Tube, waste: &Waste, closed: bool) {
        let machine = self.machine();
        self.yarns.finish(&mut self.bench.emitter);
        let by_hand = if closed { "draw a yarn through the last loops" } else { "bind the last loops off" };
        self.bench.emitter.remark(format!("waste section: {by_hand} by hand, then unravel the waste"));
        let yarn = carrier(machine, &waste.carrier);
        let circle = tube.circle(self.bench.from_right);
        Yarns::bring_in(machine, yarn, &mut self.bench.emitter);
        for course in 0..waste.rows {
            self.plain_course(tube, &circle, yarn, course == 0);
        }
        Yarns::take_out(machine, yarn, &mut self.bench.emitter);
        for id in circle {
            self.bench.emitter.push(Instruction::Drop(tube.needle(id)));
        }
        self.bench.emitter.rest();
    }
}

/// The waste yarn of the profile, unless it is not wanted.
fn waste_yarn<'m>(machine: &'m Machine, options: &Options) -> Option<&'m Waste> {
    machine.waste.as_ref().filter(|waste| waste.rows > 0 && !options.no_waste)
}

/// Every second place, then the others: the tucks of an open cast-on hang in nothing but each other. Around a tube both
/// times along the course; along a flat piece there and back.
fn every_second(circle: &[ItemId], tube: &Tube) -> Vec<(ItemId, bool)> {
    let first = circle.iter().step_by(2).map(|&id| (id, true));
    let others = circle.iter().skip(1).step_by(2);
    if tube.heading.is_some() {
        first.chain(others.rev().map(|&id| (id, false))).collect()
    } else {
        first.chain(others.map(|&id| (id, true))).collect()
    }
}
