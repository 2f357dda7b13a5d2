//! The executor: runs a program on a model of the machine and reports every violation, with its line and the field of
//! the profile that it breaks.
//!
//! Faults in what any machine does (a carrier used while out, a transfer between needles that do not face each other)
//! are found without a profile; limits need one. After a fault the run goes on as if the author had meant well, so
//! that one fault gives one finding.

use super::findings::Findings;
use super::passes::Passes;
use super::state::{Made, NONE, Needles};
use super::{CarrierId, CarrierSet, Code, Direction, Instruction, LoopId, MAX_NEEDLE, Machine, Needle, Rack};
use crate::diag::{Code as Finding, Sink};
use std::ops::Deref;

/// What a run of a program amounts to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// Instructions.
    pub operations: u64,
    /// Passes of the carriage, when neighboring instructions are merged.
    pub passes: u64,
    /// Loops made.
    pub loops: u64,
    /// Needles transferred from.
    pub transfers: u64,
    /// Largest rack either way.
    pub widest_rack: Rack,
    /// Most loops on one needle.
    pub largest_stack: u32,
    /// Longest float, in needles.
    pub longest_float: f64,
    /// Widest distance of neighboring loops of one yarn, in needles.
    pub longest_link: f64,
    /// Loops on needles at the end.
    pub held: u32,
}

/// A finished run: the figures and every loop with its history.
#[derive(Debug)]
pub struct Run {
    /// The figures.
    pub report: Report,
    /// The needles at the end, and all loops.
    pub needles: Needles,
    /// The instruction of each finding, in the order in which the sink got them; sums at the end have none.
    pub places: Vec<Option<usize>>,
}

/// A program that keeps the rules. Only [`check`] makes one.
#[derive(Debug)]
pub struct Checked<'c> {
    code: &'c Code,
    report: Report,
}

impl Deref for Checked<'_> {
    type Target = Code;
    fn deref(&self) -> &Code {
        self.code
    }
}

impl Checked<'_> {
    /// What the program amounts to.
    pub fn report(&self) -> &Report {
        &self.report
    }
}

/// Executes a program and vouches for it; warnings and errors go to the sink, an error denies the token.
pub fn check<'c>(code: &'c Code, machine: Option<&Machine>, sink: &mut Sink<'_>) -> Option<Checked<'c>> {
    let before = sink.errors();
    let run = execute(code, machine, sink);
    (sink.errors() == before).then_some(Checked { code, report: run.report })
}

/// Executes a program. Findings go to the sink; the run itself goes on to the end.
pub fn execute(code: &Code, machine: Option<&Machine>, sink: &mut Sink<'_>) -> Run {
    let mut executor = Executor {
        code,
        machine,
        findings: Findings::new(code, machine, sink),
        needles: Needles::for_program(code.ops()),
        carriers: vec![Carrier::default(); code.carriers.len()],
        hook: None,
        rack: Rack::default(),
        begun: false,
        passes: Passes::default(),
        report: Report::default(),
    };
    for (op, instruction) in code.ops().iter().enumerate() {
        executor.step(op, instruction);
    }
    executor.finish()
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Carrier {
    pub(super) inside: bool,
    /// The instruction that brought it in; `None` when it was used without.
    pub(super) brought: Option<u32>,
    pub(super) used: bool,
    pub(super) ever: bool,
    pub(super) last: LoopId,
    pub(super) position: Option<Needle>,
}

impl Default for Carrier {
    fn default() -> Self {
        Self { inside: false, brought: None, used: false, ever: false, last: NONE, position: None }
    }
}

#[derive(Debug)]
pub(super) struct Hook {
    pub(super) carriers: CarrierSet,
    /// Place of the first stitch, in quarter needles.
    pub(super) parked: Option<i32>,
    pub(super) formed: bool,
    pub(super) transfer_told: bool,
}

pub(super) struct Executor<'a, 's, 'o> {
    pub(super) code: &'a Code,
    pub(super) machine: Option<&'a Machine>,
    pub(super) findings: Findings<'a, 's, 'o>,
    pub(super) needles: Needles,
    pub(super) carriers: Vec<Carrier>,
    pub(super) hook: Option<Hook>,
    pub(super) rack: Rack,
    /// A needle has been worked.
    begun: bool,
    passes: Passes,
    pub(super) report: Report,
}

impl Executor<'_, '_, '_> {
    fn step(&mut self, op: usize, instruction: &Instruction) {
        self.report.operations += 1;
        self.passes.add(instruction, self.rack);
        if self.machine.is_some() {
            self.allowed(op, instruction);
        }
        for needle in instruction.needles() {
            self.on_bed(op, needle);
        }
        match *instruction {
            Instruction::In(carriers) => self.bring_in(op, carriers, false),
            Instruction::InHook(carriers) => self.bring_in(op, carriers, true),
            Instruction::ReleaseHook(carriers) => self.release(op, carriers),
            Instruction::Out(carriers) => self.take_out(op, carriers, false),
            Instruction::OutHook(carriers) => self.take_out(op, carriers, true),
            Instruction::Rack(rack) => self.move_rack(op, rack),
            Instruction::Knit(direction, needle, carriers) => {
                if carriers.is_empty() {
                    self.drop_loops(op, needle);
                } else {
                    self.form(op, direction, needle, carriers, Made::Knit, None);
                }
            }
            Instruction::Tuck(direction, needle, carriers) => {
                if !carriers.is_empty() {
                    self.form(op, direction, needle, carriers, Made::Tuck, None);
                }
            }
            Instruction::Split(direction, from, to, carriers) => {
                if carriers.is_empty() {
                    self.transfer(op, from, to);
                } else {
                    self.form(op, direction, from, carriers, Made::Split, Some(to));
                }
            }
            Instruction::Drop(needle) => self.drop_loops(op, needle),
            Instruction::Xfer(from, to) => self.transfer(op, from, to),
            Instruction::Miss(direction, needle, carriers) => {
                self.use_carriers(op, direction, needle, carriers);
                for &id in carriers.iter() {
                    self.set_position(id, needle);
                }
            }
            Instruction::Extension(text) => self.extension(op, text),
            Instruction::Stitch(..) | Instruction::Amiss(_) | Instruction::Pause(_) => {}
        }
    }

    pub(super) fn say(
        &mut self,
        finding: Finding,
        op: usize,
        message: impl FnOnce(&Code) -> String,
        help: &str,
    ) {
        self.findings.push(finding, Some(op), message, None, help);
    }

    fn on_bed(&mut self, op: usize, needle: Needle) {
        let [first, last] = self.machine.map_or([-MAX_NEEDLE, MAX_NEEDLE], |machine| machine.bed.needles);
        if !(first..=last).contains(&needle.index) {
            let field = self
                .machine
                .map(|machine| ("bed.needles", format!("{} to {}", machine.bed.needles[0], last)));
            self.findings.push(
                Finding::NeedleOffBed,
                Some(op),
                |_| format!("needle {needle} lies beyond the bed of {first} to {last}"),
                field,
                "",
            );
        }
        self.begun = true;
    }

    fn move_rack(&mut self, op: usize, rack: Rack) {
        if rack == self.rack && self.begun {
            let message = |_: &Code| format!("the rack is {rack} already");
            self.say(Finding::RackRedundant, op, message, "leave the operation out");
        }
        if let Some(machine) = self.machine
            && !machine.can_rack(rack.needles())
        {
            let field = if rack.needles().abs() > machine.rack.max {
                ("rack.max", machine.rack.max)
            } else {
                ("rack.step", machine.rack.step)
            };
            let field = Some((field.0, field.1.to_string()));
            let message = |_: &Code| format!("the bed cannot rack to {rack}");
            self.findings.push(Finding::RackBeyond, Some(op), message, field, "");
        }
        self.rack = rack;
        self.report.widest_rack = self.report.widest_rack.max(Rack(rack.0.saturating_abs()));
        let limit = self.link_limit();
        let (mut widest, mut stretched) = (0, NONE);
        self.needles.each_crossing(rack, |id, distance| {
            if distance > widest {
                (widest, stretched) = (distance, id);
            }
        });
        self.report.longest_link = self.report.longest_link.max(f64::from(widest) / 4.0);
        if stretched != NONE && widest > limit {
            self.stretched(op, stretched, widest);
        }
    }

    /// The widest link that the profile allows, in quarter needles.
    fn link_limit(&self) -> i32 {
        match self.machine.map_or(0, |machine| machine.limits.link_stretch) {
            0 => i32::MAX,
            limit => limit.saturating_mul(4).min(i32::MAX as u32) as i32,
        }
    }

    fn stretched(&mut self, op: usize, id: LoopId, distance: i32) {
        let ends = self.needles.get(id).and_then(|found| self.needles.needle(found.before));
        let (from, to) = (ends, self.needles.needle(id));
        let limit = self.machine.map_or(0, |machine| machine.limits.link_stretch);
        self.findings.push(
            Finding::LinkStretched,
            Some(op),
            |_| {
                let name =
                    |needle: Option<Needle>| needle.map_or_else(String::new, |needle| needle.to_string());
                let distance = f64::from(distance) / 4.0;
                format!("the yarn from {} to {} is stretched over {distance} needles", name(from), name(to))
            },
            Some(("limits.link_stretch", limit.to_string())),
            "",
        );
    }

    fn form(
        &mut self,
        op: usize,
        direction: Direction,
        needle: Needle,
        carriers: CarrierSet,
        made: Made,
        onto: Option<Needle>,
    ) {
        self.use_carriers(op, direction, needle, carriers);
        let mut needle = needle;
        if std::mem::take(&mut needle.slider) {
            let needle = Needle { slider: true, ..needle };
            let message = |_: &Code| format!("a slider cannot form a loop, as {needle} should");
            self.say(Finding::LoopOnSlider, op, message, "use the needle itself");
        }
        let held = self.needles.count(needle);
        let made = if made == Made::Tuck && held > 0 { Made::Wrap } else { made };
        match (made, onto) {
            (Made::Split, Some(to)) => {
                self.facing(op, needle, to);
                if held == 0 {
                    self.empty(op, needle);
                }
                self.needles.transfer(needle, to);
                self.report.transfers += 1;
                self.after_transfer(op, to);
            }
            (Made::Knit, _) => {
                if held == 0 {
                    let message = |_: &Code| format!("needle {needle} holds no loop to knit through");
                    self.say(Finding::KnitOnEmpty, op, message, "start a new wale with a tuck");
                }
                let through = self.needles.loops().len() as LoopId;
                self.needles.take(needle, through);
            }
            _ => {}
        }
        for &id in carriers.iter() {
            self.float(op, id, needle);
            let last = self.carriers.get(usize::from(id)).map_or(NONE, |carrier| carrier.last);
            let Some(new) = self.needles.make(needle, op as u32, id, made, last) else { continue };
            self.report.loops += 1;
            if let Some(carrier) = self.carriers.get_mut(usize::from(id)) {
                carrier.last = new;
                carrier.position = Some(needle);
            }
        }
        if let Some(hook) = &mut self.hook
            && carriers.iter().any(|id| hook.carriers.contains(id))
        {
            hook.formed = true;
        }
        self.stacked(op, needle, if made == Made::Wrap { held } else { 0 });
    }

    fn stacked(&mut self, op: usize, needle: Needle, before: u32) {
        let count = self.needles.count(needle);
        self.report.largest_stack = self.report.largest_stack.max(count);
        let limit = self.machine.map_or(0, |machine| machine.limits.loops_per_needle);
        if limit > 0 && count > limit && before <= limit {
            self.findings.push(
                Finding::StackTooLarge,
                Some(op),
                |_| format!("needle {needle} holds {count} loops"),
                Some(("limits.loops_per_needle", limit.to_string())),
                "knit the needle before it takes more",
            );
        }
    }

    fn empty(&mut self, op: usize, needle: Needle) {
        self.say(Finding::NeedleEmpty, op, |_| format!("needle {needle} holds no loop"), "");
    }

    fn drop_loops(&mut self, op: usize, needle: Needle) {
        if self.needles.take(needle, NONE) == 0 {
            self.empty(op, needle);
        }
    }

    /// Transfers go from bed to bed, to the needle straight opposite.
    fn facing(&mut self, op: usize, from: Needle, to: Needle) {
        if from.bed == to.bed {
            let message = |_: &Code| format!("{from} and {to} lie on one bed");
            self.say(
                Finding::TransferWithinBed,
                op,
                message,
                "transfer to the other bed, rack, transfer back",
            );
        } else if from.place(self.rack) != to.place(self.rack) {
            let rack = self.rack;
            self.say(
                Finding::TransferUnaligned,
                op,
                |_| format!("{from} does not face {to} at rack {rack}"),
                "rack so that front needle = back needle + rack",
            );
        }
        let sliders = self.machine.is_none_or(|machine| machine.bed.sliders);
        if (from.slider || to.slider) && !sliders {
            self.findings.push(
                Finding::LoopOnSlider,
                Some(op),
                |_| "the machine has no sliders".to_owned(),
                Some(("bed.sliders", "false".to_owned())),
                "",
            );
        }
    }

    fn transfer(&mut self, op: usize, from: Needle, to: Needle) {
        self.facing(op, from, to);
        if let Some(hook) = &mut self.hook
            && !hook.transfer_told
        {
            hook.transfer_told = true;
            let message = |_: &Code| "loops move while the hook holds the yarn".to_owned();
            self.say(Finding::TransferWithHook, op, message, "`releasehook` first");
        }
        let before = self.needles.count(to);
        if self.needles.transfer(from, to) == 0 {
            self.empty(op, from);
        }
        self.report.transfers += 1;
        for carrier in &mut self.carriers {
            if carrier.position == Some(from) {
                carrier.position = Some(to);
            }
        }
        self.stacked(op, to, before);
        self.after_transfer(op, to);
    }

    fn after_transfer(&mut self, op: usize, to: Needle) {
        let limit = self.link_limit();
        let (mut widest, mut stretched) = (0, NONE);
        for id in self.needles.stack(to) {
            let after = self.needles.get(id).map_or(NONE, |found| found.after);
            for later in [id, after] {
                if let Some(distance) = self.needles.link(later, self.rack)
                    && distance > widest
                {
                    (widest, stretched) = (distance, later);
                }
            }
        }
        self.report.longest_link = self.report.longest_link.max(f64::from(widest) / 4.0);
        if widest > limit {
            self.stretched(op, stretched, widest);
        }
    }

    fn finish(mut self) -> Run {
        let held: Vec<(Needle, u32)> = self.needles.held().collect();
        self.report.held = held.iter().map(|(_, count)| count).sum();
        self.report.passes = self.passes.count;
        if let (Some((first, _)), Some((last, _))) = (held.first(), held.last()) {
            let (loops, on) = (self.report.held, held.len());
            let message = |_: &Code| {
                let needles =
                    if on == 1 { format!("{first}") } else { format!("{on} needles, {first} to {last}") };
                format!("{loops} loops are left on {needles}")
            };
            let end = self.code.ops().len().checked_sub(1);
            let help = "bind off or drop them, or they unravel";
            self.findings.push(Finding::LoopsLeftOnNeedles, end, message, None, help);
        }
        for (index, carrier) in self.carriers.clone().iter().enumerate() {
            if let (true, Some(brought)) = (carrier.inside, carrier.brought) {
                let id = index as CarrierId;
                let message = |code: &Code| format!("carrier {} is never taken out", code.carrier(id));
                self.say(Finding::CarrierLeftIn, brought as usize, message, "end with `out` or `outhook`");
            }
        }
        let used = self.carriers.iter().filter(|carrier| carrier.ever).count();
        if let Some(machine) = self.machine
            && used > machine.carriers.names.len()
        {
            let has = machine.carriers.names.len();
            let message = |_: &Code| format!("{used} carriers are used");
            let field = Some(("carriers.names", format!("{has} carriers")));
            self.findings.push(Finding::TooManyCarriers, None, message, field, "");
        }
        let places = self.findings.finish();
        Run { report: self.report, needles: self.needles, places }
    }
}
