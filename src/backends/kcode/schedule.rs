//! From instructions to carriage passes of a Kniterate: one carrier and one action a bed, alternating directions,
//! carriers brought to the side from which they are needed.

use super::Refusal;
use crate::ir::machine::{Bed, CarrierId, CarrierSet, Code, Direction, Instruction, Needle, Rack};

/// Needles of a bed.
pub(super) const CELLS: i32 = 252;
/// Where the carriage waits left of the bed, and where it turns right of it.
const ENDS: (f64, f64) = (-11.5, 262.5);
/// A carrier stops this far beyond the last needle of its pass.
const STOP: f64 = 2.5;
/// A carrier keeps this far from another one.
const SPACING: f64 = 2.0;

/// What one bed does in a pass that makes loops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Act {
    Knit,
    Tuck,
}

/// What a pass does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Job {
    /// Loops are made; an idle bed has no act.
    Form { front: Option<Act>, back: Option<Act> },
    /// Loops go over from a bed, and where only the source is marked it is knit.
    Transfer(Bed),
    /// Loops are let go.
    Drop,
    /// A carrier is moved.
    Kick,
    /// The carriage moves alone.
    Move,
}

/// One run of the carriage.
#[derive(Clone, Debug)]
pub(super) struct Pass {
    pub(super) job: Job,
    pub(super) direction: Direction,
    /// 0 for none.
    pub(super) carrier: u8,
    pub(super) rack: Rack,
    /// Marked cells, from 0.
    pub(super) front: Vec<i32>,
    pub(super) back: Vec<i32>,
    pub(super) settings: Settings,
    /// Where the carrier starts and stops.
    pub(super) carrier_stops: Option<(f64, f64)>,
    /// Where the carriage turns, left and right.
    pub(super) stops: (f64, f64),
    /// Lines before the pass: comments and words for the operator.
    pub(super) before: Vec<String>,
}

/// Values that extensions set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Settings {
    pub(super) stitch: char,
    pub(super) xfer_stitch: char,
    pub(super) speed: f64,
    pub(super) roller: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { stitch: '5', xfer_stitch: '3', speed: 100.0, roller: 100.0 }
    }
}

/// Plans the passes of a program.
pub(super) fn schedule(code: &Code) -> Result<Vec<Pass>, Refusal> {
    let shift = shift(code)?;
    let mut planner = Planner {
        code,
        shift,
        rack: Rack::default(),
        settings: Settings::default(),
        two_pass: false,
        carriers: [None; 7],
        open: None,
        passes: Vec::new(),
        before: Vec::new(),
        extra_roller: 0.0,
        place: 0,
    };
    let mut remarks = code.comments.iter().peekable();
    for (op, instruction) in code.ops().iter().enumerate() {
        while let Some(comment) = remarks.next_if(|comment| comment.at as usize <= op) {
            planner.close();
            planner.before.push(format!("//{}", comment.text));
        }
        planner.step(op, instruction)?;
    }
    planner.close();
    if let Some(left) = (1..=6).find(|&id| planner.carriers.get(id).is_some_and(Option::is_some)) {
        return Err(Refusal { op: None, what: format!("carrier {left} is left in at the end") });
    }
    let mut passes = planner.passes;
    turn_points(&mut passes);
    Ok(passes)
}

/// How far needle numbers are moved to become cells, as the Position header asks.
fn shift(code: &Code) -> Result<i32, Refusal> {
    let indexes = || code.ops().iter().flat_map(Instruction::needles).map(|needle| needle.index);
    let (Some(min), Some(max)) = (indexes().min(), indexes().max()) else { return Ok(-1) };
    let shift = match code.header("Position").map(str::trim) {
        Some("Left") => -min,
        Some("Right") => CELLS - 1 - max,
        Some("Center") => (CELLS - max - min).div_euclid(2),
        _ => -1,
    };
    if min + shift < 0 || max + shift >= CELLS {
        let what = format!("needles {min} to {max} do not lie on a bed of 1 to {CELLS}");
        let outside = |needle: Needle| !(0..CELLS).contains(&(needle.index + shift));
        let op = code.ops().iter().position(|op| op.needles().any(outside));
        return Err(Refusal { op, what });
    }
    Ok(shift)
}

/// A pass that still takes needles.
struct Open {
    pass: Pass,
    last: i32,
    /// Every second marked needle goes into a pass of its own.
    split_classes: bool,
}

struct Planner<'c> {
    code: &'c Code,
    shift: i32,
    rack: Rack,
    settings: Settings,
    two_pass: bool,
    /// Where each carrier stands; `None` while it is out.
    carriers: [Option<f64>; 7],
    open: Option<Open>,
    passes: Vec<Pass>,
    before: Vec<String>,
    extra_roller: f64,
    /// The instruction at hand.
    place: usize,
}

impl Planner<'_> {
    fn step(&mut self, op: usize, instruction: &Instruction) -> Result<(), Refusal> {
        self.place = op;
        match *instruction {
            Instruction::In(carriers) => {
                self.close();
                for &id in carriers.iter() {
                    let carrier = self.number(id)?;
                    if let Some(place) = self.carriers.get_mut(usize::from(carrier)) {
                        *place = Some(parking(carrier));
                    }
                }
            }
            Instruction::Out(carriers) => {
                self.close();
                for &id in carriers.iter() {
                    let carrier = self.number(id)?;
                    self.park(carrier);
                }
            }
            Instruction::InHook(_) | Instruction::ReleaseHook(_) | Instruction::OutHook(_) => {
                return self.refuse("the Kniterate has no inserting hook; use `in` and `out`");
            }
            Instruction::Rack(rack) => {
                if !(rack.is_whole() || rack.0.rem_euclid(4) == 2) {
                    return self.refuse(&format!("rack {rack} is no whole or half number of needles"));
                }
                self.close();
                self.rack = rack;
            }
            Instruction::Knit(_, needle, carriers) if carriers.is_empty() => self.drop_loops(needle)?,
            Instruction::Drop(needle) => self.drop_loops(needle)?,
            Instruction::Knit(direction, needle, carriers) => {
                self.form(direction, needle, carriers, Act::Knit)?;
            }
            Instruction::Tuck(_, _, carriers) if carriers.is_empty() => {}
            Instruction::Tuck(direction, needle, carriers) => {
                self.form(direction, needle, carriers, Act::Tuck)?;
            }
            Instruction::Split(_, from, to, carriers) if carriers.is_empty() => self.transfer(from, to)?,
            Instruction::Split(direction, from, to, carriers) => self.split(direction, from, to, carriers)?,
            Instruction::Xfer(from, to) => self.transfer(from, to)?,
            Instruction::Miss(direction, needle, carriers) => {
                self.close();
                for &id in carriers.iter() {
                    let carrier = self.number(id)?;
                    self.kick(carrier, direction, self.slot(needle));
                }
            }
            Instruction::Stitch(..) => {
                return self.refuse("`stitch` has no counterpart; use x-stitch-number");
            }
            Instruction::Amiss(_) => self.close(),
            Instruction::Pause(text) => {
                self.close();
                let words = self.code.texts.get(text as usize).map_or("", String::as_str);
                self.before.push(if words.is_empty() {
                    "pause".to_owned()
                } else {
                    format!("pause: {words}")
                });
            }
            Instruction::Extension(text) => self.extension(text),
        }
        Ok(())
    }

    fn refuse<T>(&self, what: &str) -> Result<T, Refusal> {
        Err(Refusal { op: Some(self.place), what: what.to_owned() })
    }

    /// The number of a carrier on the machine.
    fn number(&self, id: CarrierId) -> Result<u8, Refusal> {
        let name = self.code.carrier(id);
        match name.parse() {
            Ok(number @ 1..=6) => Ok(number),
            _ => self.refuse(&format!("carrier `{name}` is not one of 1 to 6")),
        }
    }

    fn one(&self, carriers: CarrierSet) -> Result<u8, Refusal> {
        match *carriers {
            [id] => self.number(id),
            _ => self.refuse("two carriers in one operation"),
        }
    }

    fn cell(&self, needle: Needle) -> Result<i32, Refusal> {
        if needle.slider {
            return self.refuse("the Kniterate has no sliders");
        }
        Ok(needle.index + self.shift)
    }

    /// Place along the bed in half cells: the back bed is moved by the rack.
    fn slot(&self, needle: Needle) -> f64 {
        let rack = if needle.bed == Bed::Back { self.rack.needles() } else { 0.0 };
        f64::from(needle.index + self.shift) + rack
    }

    fn fresh(&mut self, job: Job, direction: Direction, carrier: u8) -> Pass {
        Pass {
            job,
            direction,
            carrier,
            rack: self.rack,
            front: Vec::new(),
            back: Vec::new(),
            settings: Settings { roller: self.settings.roller + self.extra_roller, ..self.settings },
            carrier_stops: None,
            stops: (0.0, 0.0),
            before: std::mem::take(&mut self.before),
        }
    }

    fn form(
        &mut self,
        direction: Direction,
        needle: Needle,
        carriers: CarrierSet,
        act: Act,
    ) -> Result<(), Refusal> {
        let (carrier, cell) = (self.one(carriers)?, self.cell(needle)?);
        let place = needle.place(self.rack);
        let fits = |open: &Open| {
            let here = match open.pass.job {
                Job::Form { front, back } => {
                    let acting = if needle.bed == Bed::Front { front } else { back };
                    acting.is_none_or(|acting| acting == act)
                }
                Job::Transfer(bed) => open.pass.carrier != 0 && bed == needle.bed && act == Act::Knit,
                Job::Drop | Job::Kick | Job::Move => false,
            };
            here && open.pass.direction == direction
                && open.pass.carrier == carrier
                && ahead(direction, open.last, place)
        };
        if !self.open.as_ref().is_some_and(fits) {
            self.close();
            let pass = self.fresh(Job::Form { front: None, back: None }, direction, carrier);
            self.open = Some(Open { pass, last: place, split_classes: false });
        }
        let Some(open) = &mut self.open else { return Ok(()) };
        open.last = place;
        if let Job::Form { front, back } = &mut open.pass.job {
            *(if needle.bed == Bed::Front { front } else { back }) = Some(act);
        }
        mark(&mut open.pass, needle.bed, cell);
        Ok(())
    }

    fn split(
        &mut self,
        direction: Direction,
        from: Needle,
        to: Needle,
        carriers: CarrierSet,
    ) -> Result<(), Refusal> {
        let (carrier, cell, target) = (self.one(carriers)?, self.cell(from)?, self.cell(to)?);
        let place = from.place(self.rack);
        // Knits of the same bed may have gone before; knits of the other may not.
        let fits = |open: &Open| {
            let here = match open.pass.job {
                Job::Form { front, back } => match from.bed {
                    Bed::Front => back.is_none() && front == Some(Act::Knit),
                    Bed::Back => front.is_none() && back == Some(Act::Knit),
                },
                Job::Transfer(bed) => open.pass.carrier != 0 && bed == from.bed,
                Job::Drop | Job::Kick | Job::Move => false,
            };
            here && open.pass.direction == direction
                && open.pass.carrier == carrier
                && ahead(direction, open.last, place)
        };
        if !self.open.as_ref().is_some_and(fits) {
            self.close();
            let pass = self.fresh(Job::Transfer(from.bed), direction, carrier);
            self.open = Some(Open { pass, last: place, split_classes: false });
        }
        let Some(open) = &mut self.open else { return Ok(()) };
        open.last = place;
        open.pass.job = Job::Transfer(from.bed);
        mark(&mut open.pass, from.bed, cell);
        mark(&mut open.pass, to.bed, target);
        Ok(())
    }

    fn transfer(&mut self, from: Needle, to: Needle) -> Result<(), Refusal> {
        let (source, target) = (self.cell(from)?, self.cell(to)?);
        let split_classes = !self.two_pass;
        let fits = |open: &Open| {
            let sources = if from.bed == Bed::Front { &open.pass.front } else { &open.pass.back };
            open.pass.job == Job::Transfer(from.bed) && open.pass.carrier == 0 && !sources.contains(&source)
        };
        if !self.open.as_ref().is_some_and(fits) {
            self.close();
            let pass = self.fresh(Job::Transfer(from.bed), Direction::Plus, 0);
            self.open = Some(Open { pass, last: 0, split_classes });
        }
        if let Some(open) = &mut self.open {
            mark(&mut open.pass, from.bed, source);
            mark(&mut open.pass, to.bed, target);
        }
        Ok(())
    }

    fn drop_loops(&mut self, needle: Needle) -> Result<(), Refusal> {
        let cell = self.cell(needle)?;
        if !self.open.as_ref().is_some_and(|open| open.pass.job == Job::Drop) {
            self.close();
            let pass = self.fresh(Job::Drop, Direction::Plus, 0);
            self.open = Some(Open { pass, last: 0, split_classes: false });
        }
        if let Some(open) = &mut self.open {
            mark(&mut open.pass, needle.bed, cell);
        }
        Ok(())
    }

    /// The direction in which the carriage goes next of itself.
    fn next_direction(&self) -> Direction {
        self.passes.last().map_or(Direction::Plus, |pass| pass.direction.reverse())
    }

    /// Finishes the open pass: carriers come to its side, and the carriage too.
    fn close(&mut self) {
        let Some(Open { mut pass, split_classes, .. }) = self.open.take() else { return };
        self.extra_roller = 0.0;
        if pass.carrier == 0 {
            let classes = if split_classes { halves(&pass) } else { vec![pass] };
            for mut class in classes {
                class.direction = self.next_direction();
                self.passes.push(class);
            }
            return;
        }
        let rack = pass.rack.needles();
        let source_only = match pass.job {
            Job::Transfer(bed) => Some(bed),
            Job::Form { .. } | Job::Drop | Job::Kick | Job::Move => None,
        };
        let front = pass.front.iter().filter(|_| source_only != Some(Bed::Back)).map(|&cell| f64::from(cell));
        let back =
            pass.back.iter().filter(|_| source_only != Some(Bed::Front)).map(|&cell| f64::from(cell) + rack);
        let (low, high) = front
            .chain(back)
            .fold((f64::MAX, f64::MIN), |(low, high), place| (low.min(place), high.max(place)));
        let (first, last) = match pass.direction {
            Direction::Plus => (low, high),
            Direction::Minus => (high, low),
        };
        let carrier = pass.carrier;
        let stands =
            self.carriers.get(usize::from(carrier)).copied().flatten().unwrap_or_else(|| parking(carrier));
        let wrong_side = match pass.direction {
            Direction::Plus => stands > first,
            Direction::Minus => stands < first,
        };
        if wrong_side {
            self.kick(carrier, pass.direction.reverse(), first);
        }
        self.face(pass.direction);
        let starts = self.carriers.get(usize::from(carrier)).copied().flatten().unwrap_or(stands);
        let stop = self.stop(carrier, pass.direction, last);
        pass.carrier_stops = Some((starts, stop));
        self.set(carrier, Some(stop));
        self.passes.push(pass);
    }

    /// Moves the carriage over when it would go the same way twice.
    fn face(&mut self, direction: Direction) {
        if self.next_direction() != direction {
            let pass = self.fresh(Job::Move, direction.reverse(), 0);
            self.passes.push(pass);
        }
    }

    fn set(&mut self, carrier: u8, place: Option<f64>) {
        if let Some(slot) = self.carriers.get_mut(usize::from(carrier)) {
            *slot = place;
        }
    }

    /// Where a carrier stops beyond a needle, clear of the others.
    fn stop(&self, carrier: u8, direction: Direction, last: f64) -> f64 {
        let sign = if direction == Direction::Plus { 1.0 } else { -1.0 };
        // Stops lie between cells; at half racks a needle does too.
        let mut stop = (last * sign).ceil() * sign + sign * STOP;
        let taken = |stop: f64| {
            self.carriers
                .iter()
                .enumerate()
                .any(|(id, place)| id != usize::from(carrier) && *place == Some(stop))
        };
        while taken(stop) {
            stop += sign * SPACING;
        }
        stop.clamp(ENDS.0, ENDS.1)
    }

    /// Moves a carrier beyond a place.
    fn kick(&mut self, carrier: u8, direction: Direction, beyond: f64) {
        self.face(direction);
        let starts =
            self.carriers.get(usize::from(carrier)).copied().flatten().unwrap_or_else(|| parking(carrier));
        let stop = self.stop(carrier, direction, beyond);
        let mut pass = self.fresh(Job::Kick, direction, carrier);
        pass.carrier_stops = Some((starts, stop));
        self.set(carrier, Some(stop));
        self.passes.push(pass);
    }

    /// Moves a carrier to its parking place, on a pass to the left.
    fn park(&mut self, carrier: u8) {
        let Some(starts) = self.carriers.get(usize::from(carrier)).copied().flatten() else { return };
        self.face(Direction::Minus);
        let mut pass = self.fresh(Job::Kick, Direction::Minus, carrier);
        pass.carrier_stops = Some((starts, parking(carrier)));
        self.set(carrier, None);
        self.passes.push(pass);
    }

    fn extension(&mut self, text: u32) {
        self.close();
        let words = self.code.texts.get(text as usize).map_or("", String::as_str);
        let mut words = words.split_ascii_whitespace();
        let (name, value) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
        let size = || {
            let mut letters = value.chars();
            letters.next().filter(|letter| letter.is_ascii_digit() || letter.is_ascii_uppercase())
        };
        let number = || value.parse::<f64>().ok().filter(|number| (0.0..=10_000.0).contains(number));
        let settings = &mut self.settings;
        match name {
            "x-stitch-number" => settings.stitch = size().unwrap_or(settings.stitch),
            "x-xfer-stitch-number" => settings.xfer_stitch = size().unwrap_or(settings.xfer_stitch),
            "x-speed-number" => settings.speed = number().unwrap_or(settings.speed),
            "x-roller-advance" => settings.roller = number().unwrap_or(settings.roller),
            "x-add-roller-advance" => self.extra_roller += number().unwrap_or(0.0),
            "x-xfer-style" => self.two_pass = value == "two-pass",
            _ => {}
        }
    }
}

/// Carriers wait left of the bed, in three lanes.
fn parking(carrier: u8) -> f64 {
    match carrier {
        1 => -11.5,
        2 | 3 => -9.5,
        _ => -7.5,
    }
}

fn ahead(direction: Direction, last: i32, place: i32) -> bool {
    match direction {
        Direction::Plus => place > last,
        Direction::Minus => place < last,
    }
}

fn mark(pass: &mut Pass, bed: Bed, cell: i32) {
    match bed {
        Bed::Front => pass.front.push(cell),
        Bed::Back => pass.back.push(cell),
    }
}

/// The even and the odd ones of the marked needles as passes of their own: neighbors do not transfer at once.
fn halves(pass: &Pass) -> Vec<Pass> {
    let mut pairs: Vec<(i32, i32)> = pass.front.iter().copied().zip(pass.back.iter().copied()).collect();
    pairs.sort_unstable();
    let class = |odd: usize| {
        let (front, back): (Vec<i32>, Vec<i32>) = pairs.iter().copied().skip(odd).step_by(2).unzip();
        let before = if odd == 0 { pass.before.clone() } else { Vec::new() };
        Pass { front, back, before, ..pass.clone() }
    };
    [class(0), class(1)].into_iter().filter(|class| !class.front.is_empty()).collect()
}

/// Where the carriage turns: beyond what this pass and the next one need.
fn turn_points(passes: &mut [Pass]) {
    let reach: Vec<(f64, f64)> = passes.iter().map(extent).collect();
    let mut from = ENDS.0;
    for (at, pass) in passes.iter_mut().enumerate() {
        let here = reach.get(at).copied().unwrap_or(ENDS);
        let next = reach.get(at + 1).copied().unwrap_or(here);
        let to = match pass.direction {
            Direction::Plus => here.1.max(next.1).max(from),
            Direction::Minus => here.0.min(next.0).min(from),
        };
        pass.stops = if from <= to { (from, to) } else { (to, from) };
        from = to;
    }
}

/// The places that the carriage must pass.
fn extent(pass: &Pass) -> (f64, f64) {
    let rack = pass.rack.needles();
    let cells = pass
        .front
        .iter()
        .map(|&cell| f64::from(cell))
        .chain(pass.back.iter().map(|&cell| f64::from(cell) + rack));
    let needles = cells.flat_map(|place| [place.floor() - STOP, place.ceil() + STOP]);
    let carrier = pass.carrier_stops.into_iter().flat_map(|(start, stop)| [start, stop]);
    let (low, high) = needles
        .chain(carrier)
        .fold((f64::MAX, f64::MIN), |(low, high), place| (low.min(place), high.max(place)));
    if low > high { (0.5, 0.5) } else { (low.max(ENDS.0), high.min(ENDS.1)) }
}
