//! One part from cast-on to fasten-off: the driver that keeps the loops on the needles in the order of the pattern.

use super::bind_off;
use super::emit::{Emitter, Origin};
use super::plan::{self, Leg, PLAIN};
use super::tube::{ItemId, Stuck, Tube};
use super::{Options, carrier, joined};
use crate::diag::{Code as Finding, Diagnostic, Sink};
use crate::ir::machine::profile::{BringIn, Side, Waste};
use crate::ir::machine::{Bed, CarrierId, CarrierSet, Instruction, Machine};
use crate::ir::{Direction, Finish, Part, Start};
use std::collections::VecDeque;

/// Knits a part; `None` with the reason in the sink when the machine cannot.
pub(super) fn knit(
    index: u32,
    part: &Part,
    machine: &Machine,
    options: &Options,
    sink: &mut Sink<'_>,
) -> Option<Emitter> {
    let mut piece = Piece {
        part,
        machine,
        options,
        emitter: Emitter::default(),
        yarn: carrier(machine, &machine.carriers.yarn),
        from_right: machine.entry.parking == Side::Right,
        shapings: 0,
    };
    piece.emitter.origin = Origin { part: index, round: 0, stitch: 0 };
    match piece.run(sink) {
        Ok(()) => Some(piece.emitter),
        Err(reason) => {
            piece.refuse(&reason, sink);
            None
        }
    }
}

/// Why a part cannot be knit.
enum Reason {
    /// The sink has it.
    Told,
    Stuck(Stuck),
    /// This many needles on each bed are needed.
    Wide(i32),
    /// A tube of this many loops.
    Loops(u32),
    Flat,
    Joined,
    Shapings(u32),
    Depth(u32),
}

impl From<Stuck> for Reason {
    fn from(stuck: Stuck) -> Self {
        Self::Stuck(stuck)
    }
}

struct Piece<'a> {
    part: &'a Part,
    machine: &'a Machine,
    options: &'a Options,
    emitter: Emitter,
    yarn: CarrierId,
    from_right: bool,
    /// Increases and decreases of the current course.
    shapings: u32,
}

impl Piece<'_> {
    fn run(&mut self, sink: &mut Sink<'_>) -> Result<(), Reason> {
        if self.part.flat {
            return Err(Reason::Flat);
        }
        if joined(self.part) {
            return Err(Reason::Joined);
        }
        let (loops, skipped) = plan::cast_on(self.part);
        self.emitter.origin.round = 1;
        if loops < 2 {
            return Err(Reason::Stuck(Stuck::Narrow));
        }
        if loops > self.machine.tube.max_loops {
            return Err(Reason::Loops(loops));
        }
        let mut narrowest = loops;
        let limit = self.machine.limits.loops_per_needle;
        let mut tube = Tube::new(loops, self.from_right, limit, CarrierSet::one(self.yarn));
        self.settings();
        self.cast_on(&mut tube);
        self.wide()?;
        let rows = self.part.numbered_rows().skip(skipped);
        for (number, row) in rows {
            for (copy, number) in (number..number.saturating_add(row.times)).enumerate() {
                // Equal rows say the same of their stitches; once is enough.
                let mut silent = Sink::new();
                let heard = if copy == 0 { &mut *sink } else { &mut silent };
                let plan = plan::row(self.part, row, number, self.options, heard).ok_or(Reason::Told)?;
                self.emitter.origin.round = number;
                self.shapings = 0;
                let turns = plan.legs.len() / 2;
                if self.machine.limits.short_row_depth > 0
                    && 2 * turns > self.machine.limits.short_row_depth as usize
                {
                    self.depth(&plan.legs, tube.open.len())?;
                }
                self.row(&mut tube, &plan.legs)?;
                for _ in 0..plan.plain_rounds {
                    let plain = Leg { direction: Direction::Forward, actions: vec![PLAIN; tube.open.len()] };
                    self.row(&mut tube, &[plain])?;
                }
                narrowest = narrowest.min(tube.open.len() as u32);
            }
        }
        self.emitter.origin.stitch = 0;
        self.finish(&mut tube)?;
        self.wide()?;
        if narrowest < self.machine.tube.min_loops {
            let message = format!("the tube narrows to {narrowest} loops");
            let (least, name) = (self.machine.tube.min_loops, &self.machine.name);
            sink.push(
                Diagnostic::new(Finding::NarrowTube, message)
                    .in_round(&self.part.name, None)
                    .help(format!("`tube.min_loops` of `{name}` is {least}; watch the take-down there")),
            );
        }
        Ok(())
    }

    /// Stitch size, speed and take-down where the profile has them.
    fn settings(&mut self) {
        let machine = self.machine;
        let mut say = |name: &str, value: Option<u32>| {
            if let Some(value) = value
                && machine.extensions.iter().any(|known| known == name)
            {
                self.emitter.extension(format!("{name} {value}"));
            }
        };
        let sizes = machine.stitch_number.as_ref();
        say("x-stitch-number", sizes.map(|sizes| u32::from(sizes.default)));
        say("x-xfer-stitch-number", sizes.map(|sizes| u32::from(sizes.xfer)));
        say("x-speed-number", machine.speed.as_ref().and_then(|speed| speed.default));
        say("x-roller-advance", machine.roller.as_ref().map(|roller| roller.default));
    }

    fn cast_on(&mut self, tube: &mut Tube) {
        let circle: Vec<ItemId> = tube.open.iter().copied().collect();
        let waste = self.machine.waste.clone().filter(|waste| waste.rows > 0 && !self.options.no_waste);
        if let Some(waste) = waste {
            self.waste(&waste, tube, &circle);
            self.emitter.remark("the piece; unravel the waste by pulling the draw thread".to_owned());
            self.bring_in(self.yarn);
        } else {
            self.bring_in(self.yarn);
            let closed = matches!(self.part.start, Start::Chain { joined: false, .. });
            let tucks = if closed { self.closed(tube) } else { every_second(&circle) };
            for (id, direction) in tucks.iter().map(|&id| (id, true)) {
                let forward = direction != (closed && self.against_course(tube, &tucks, id));
                self.emitter.tuck(tube.direction(id, forward), tube.needle(id), CarrierSet::one(self.yarn));
            }
        }
        self.plain_round(tube, &circle, self.yarn);
    }

    /// In a closed cast-on both beds are tucked in one pass, so on one of them against the course.
    fn against_course(&self, tube: &Tube, tucks: &[ItemId], id: ItemId) -> bool {
        let half = tucks.len().div_ceil(2);
        let first_pass = tucks.iter().take(half).any(|&tuck| tuck == id);
        let first_bed = if self.from_right { Bed::Front } else { Bed::Back };
        (tube.bed(id) == first_bed) != first_pass
    }

    /// Items in the order of a closed cast-on: away from the yarn on alternating beds, and back over the others.
    fn closed(&self, tube: &Tube) -> Vec<ItemId> {
        let mut slots = tube.slots();
        if self.from_right {
            slots.reverse();
        }
        let (mut there, mut back) = (Vec::new(), Vec::new());
        for (place, &(front, rear)) in slots.iter().enumerate() {
            let (first, second) =
                if (place % 2 == 0) == self.from_right { (front, rear) } else { (rear, front) };
            there.extend(first);
            back.extend(second);
        }
        // The two passes are told apart by their length, so a missing partner at the edge goes with the first.
        while there.len() < back.len() {
            let Some(id) = back.pop() else { break };
            there.push(id);
        }
        back.reverse();
        there.into_iter().chain(back).collect()
    }

    fn bring_in(&mut self, yarn: CarrierId) {
        let set = CarrierSet::one(yarn);
        self.emitter.rest();
        self.emitter.push(match self.machine.entry.bring_in {
            BringIn::Hook => Instruction::InHook(set),
            BringIn::Gripper => Instruction::In(set),
        });
    }

    fn take_out(&mut self, yarn: CarrierId) {
        let set = CarrierSet::one(yarn);
        self.emitter.push(match self.machine.entry.bring_in {
            BringIn::Hook => Instruction::OutHook(set),
            BringIn::Gripper => Instruction::Out(set),
        });
    }

    /// A round of plain loops; the hook lets go after its first bed.
    fn plain_round(&mut self, tube: &mut Tube, circle: &[ItemId], yarn: CarrierId) {
        tube.set_carriers(CarrierSet::one(yarn));
        let hook = self.machine.entry.bring_in == BringIn::Hook;
        let first = circle.first().map(|&id| tube.bed(id));
        let mut held = hook;
        for &id in circle {
            if held && first != Some(tube.bed(id)) {
                held = false;
                self.emitter.push(Instruction::ReleaseHook(CarrierSet::one(yarn)));
            }
            tube.work(id, true, &mut self.emitter);
        }
        if held {
            self.emitter.push(Instruction::ReleaseHook(CarrierSet::one(yarn)));
        }
    }

    fn waste(&mut self, waste: &Waste, tube: &mut Tube, circle: &[ItemId]) {
        let (yarn, draw) = (carrier(self.machine, &waste.carrier), carrier(self.machine, &waste.draw));
        self.emitter.remark("waste section".to_owned());
        self.bring_in(yarn);
        for id in every_second(circle) {
            self.emitter.tuck(tube.direction(id, true), tube.needle(id), CarrierSet::one(yarn));
        }
        for round in 0..waste.rows {
            if round == 0 {
                self.plain_round(tube, circle, yarn);
            } else {
                for &id in circle {
                    tube.work(id, true, &mut self.emitter);
                }
            }
        }
        self.take_out(yarn);
        self.emitter.remark("draw thread".to_owned());
        self.bring_in(draw);
        self.plain_round(tube, circle, draw);
        self.take_out(draw);
    }

    /// Works the legs of one row.
    fn row(&mut self, tube: &mut Tube, legs: &[Leg]) -> Result<(), Reason> {
        self.emitter.origin.stitch = 0;
        for (index, leg) in legs.iter().enumerate() {
            let forward = leg.direction == Direction::Forward;
            let tops = self.leg(tube, leg)?;
            if forward {
                tube.open.extend(tops);
            } else {
                for top in tops {
                    tube.open.push_front(top);
                }
            }
            self.wide()?;
            if index + 1 < legs.len() {
                let next = if forward { tube.open.front() } else { tube.open.back() };
                if let Some(&next) = next {
                    tube.wrap(next, forward, &mut self.emitter)?;
                }
            }
        }
        let loops = tube.open.len() as u32;
        if loops > self.machine.tube.max_loops {
            return Err(Reason::Loops(loops));
        }
        Ok(())
    }

    /// Works one leg; returns the needles of its loops in working order.
    fn leg(&mut self, tube: &mut Tube, leg: &Leg) -> Result<Vec<ItemId>, Reason> {
        let forward = leg.direction == Direction::Forward;
        let base = self.emitter.origin.stitch;
        let mut work: Vec<(ItemId, u16)> = Vec::with_capacity(leg.actions.len());
        let mut taken = VecDeque::new();
        for (at, action) in leg.actions.iter().enumerate() {
            taken.clear();
            for _ in 0..action.works {
                let next = if forward { tube.open.pop_front() } else { tube.open.pop_back() };
                taken.push_back(next.ok_or(Stuck::Underflow)?);
            }
            self.emitter.origin.stitch = base + at as u32 + 1;
            let Some(mut kept) = taken.pop_front() else { continue };
            while let Some(next) = taken.pop_front() {
                self.count_shaping()?;
                let (first, second) = if forward { (kept, next) } else { (next, kept) };
                kept = tube.close(first, second, &mut self.emitter)?;
            }
            work.push((kept, action.makes));
        }
        let mut tops = Vec::with_capacity(work.len());
        for (at, &(kept, makes)) in work.iter().enumerate() {
            self.emitter.origin.stitch = base + at as u32 + 1;
            let from = tops.len();
            for _ in 1..makes {
                self.count_shaping()?;
                let ghost = tube.open(kept, &mut self.emitter)?;
                tops.insert(from, (ghost, at));
            }
            tops.insert(from, (kept, at));
            if !forward && let Some(group) = tops.get_mut(from..) {
                group.reverse();
            }
        }
        for &(id, at) in &tops {
            self.emitter.origin.stitch = base + at as u32 + 1;
            tube.work(id, forward, &mut self.emitter);
        }
        Ok(tops.into_iter().map(|(id, _)| id).collect())
    }

    fn count_shaping(&mut self) -> Result<(), Reason> {
        self.shapings += 1;
        let limit = self.machine.limits.shapings_per_course;
        if limit > 0 && self.shapings > limit { Err(Reason::Shapings(self.shapings)) } else { Ok(()) }
    }

    /// The most courses that some needles are knit while others wait, over the legs of one row.
    fn depth(&self, legs: &[Leg], open: usize) -> Result<(), Reason> {
        let mut ahead: VecDeque<u32> = vec![0; open].into();
        let mut deepest = 0;
        for leg in legs {
            let forward = leg.direction == Direction::Forward;
            let mut tops = Vec::new();
            for action in &leg.actions {
                let taken = (0..action.works)
                    .filter_map(|_| if forward { ahead.pop_front() } else { ahead.pop_back() })
                    .max()
                    .unwrap_or(0);
                deepest = deepest.max(taken + 1);
                tops.extend(std::iter::repeat_n(taken + 1, usize::from(action.makes)));
            }
            if forward {
                ahead.extend(tops);
            } else {
                for top in tops {
                    ahead.push_front(top);
                }
            }
        }
        if deepest > self.machine.limits.short_row_depth { Err(Reason::Depth(deepest)) } else { Ok(()) }
    }

    fn wide(&self) -> Result<(), Reason> {
        let [first, last] = self.machine.bed.needles;
        match self.emitter.reach() {
            Some((left, right)) if right - left > last - first => Err(Reason::Wide(right - left + 1)),
            _ => Ok(()),
        }
    }

    fn finish(&mut self, tube: &mut Tube) -> Result<(), Reason> {
        if let Some(sizes) = &self.machine.stitch_number
            && self.machine.extensions.iter().any(|known| known == "x-stitch-number")
        {
            self.emitter.extension(format!("x-stitch-number {}", sizes.bind_off));
        }
        self.emitter.remark("bind off".to_owned());
        let closed = self.part.finish == Finish::DrawnShut;
        let last = bind_off::bind_off(tube, closed, &mut self.emitter)?;
        for step in 0..bind_off::TAIL {
            tube.work(last, step % 2 == 1, &mut self.emitter);
        }
        self.take_out(self.yarn);
        self.emitter.push(Instruction::Drop(tube.needle(last)));
        self.emitter.rest();
        Ok(())
    }

    fn refuse(&self, reason: &Reason, sink: &mut Sink<'_>) {
        let (machine, name) = (self.machine, &self.machine.name);
        let [first, last] = machine.bed.needles;
        let limit = |field: &str, value: u32| format!("`{field}` of `{name}` is {value}");
        let (finding, message, help) = match *reason {
            Reason::Told => return,
            Reason::Stuck(Stuck::Narrow) => (
                Finding::BeyondMachine,
                "the tube is too narrow to lie on two beds".to_owned(),
                "4 loops are the least; close the tube earlier".to_owned(),
            ),
            Reason::Stuck(Stuck::Stack(loops)) => (
                Finding::BeyondMachine,
                format!("a needle would hold {loops} loops"),
                format!(
                    "{}; a plain round between decreases helps",
                    limit("limits.loops_per_needle", machine.limits.loops_per_needle)
                ),
            ),
            Reason::Stuck(Stuck::Underflow) => (
                Finding::BrokenProgram,
                "the row works loops that are not there".to_owned(),
                "check the pattern first".to_owned(),
            ),
            Reason::Wide(needles) => (
                Finding::BeyondMachine,
                format!("{needles} needles are needed at half gauge; `{name}` has {}", last - first + 1),
                format!(
                    "`bed.needles` is {first} to {last}: the widest round this machine can hold is about {}; \
                     use coarser stitches, or split the tube",
                    last - first
                ),
            ),
            Reason::Loops(loops) => (
                Finding::BeyondMachine,
                format!("the round has {loops} loops"),
                format!(
                    "{}, the widest round this machine can hold; use coarser stitches, or split the tube",
                    limit("tube.max_loops", machine.tube.max_loops)
                ),
            ),
            Reason::Flat => (
                Finding::NotKnittable,
                "the part is worked in rows that turn; only tubes are knit".to_owned(),
                "work it in the round".to_owned(),
            ),
            Reason::Joined => (
                Finding::NotKnittable,
                "the part begins on loops of another part".to_owned(),
                "only parts with a start of their own are knit".to_owned(),
            ),
            Reason::Shapings(count) => (
                Finding::BeyondMachine,
                format!("the course has {count} increases and decreases or more"),
                limit("limits.shapings_per_course", machine.limits.shapings_per_course),
            ),
            Reason::Depth(courses) => (
                Finding::BeyondMachine,
                format!("needles wait while others knit {courses} courses"),
                limit("limits.short_row_depth", machine.limits.short_row_depth),
            ),
        };
        let Origin { round, stitch, .. } = self.emitter.origin;
        let at = if stitch > 0 { format!(" at stitch {stitch}") } else { String::new() };
        sink.push(
            Diagnostic::new(finding, format!("{message}{at}"))
                .in_round(&self.part.name, Some(round))
                .help(help),
        );
    }
}

/// Every second place of the circle, then the others: the tucks of an open cast-on hang in nothing but each other.
fn every_second(circle: &[ItemId]) -> Vec<ItemId> {
    circle.iter().step_by(2).chain(circle.iter().skip(1).step_by(2)).copied().collect()
}
