//! The executor's half about yarn: carriers and the inserting hook, floats, and what the profile says of operations.

use super::execute::{Carrier, Executor, Hook};
use super::profile::BringIn;
use super::{CarrierId, CarrierSet, Code, Direction, Instruction, Machine, Needle};
use crate::diag::Code as Finding;

impl Executor<'_, '_, '_> {
    /// Operation and number of carriers, against the profile.
    pub(super) fn allowed(&mut self, op: usize, instruction: &Instruction) {
        let Some(machine) = self.machine else { return };
        let (Instruction::In(carriers)
        | Instruction::InHook(carriers)
        | Instruction::ReleaseHook(carriers)
        | Instruction::Out(carriers)
        | Instruction::OutHook(carriers)
        | Instruction::Knit(_, _, carriers)
        | Instruction::Tuck(_, _, carriers)
        | Instruction::Split(_, _, _, carriers)
        | Instruction::Miss(_, _, carriers)) = instruction
        else {
            return self.performed(op, instruction);
        };
        let most = machine.carriers.per_op;
        if carriers.len() > most as usize {
            let count = carriers.len();
            self.findings.push(
                Finding::TooManyCarriers,
                Some(op),
                |_| format!("{count} carriers in one operation"),
                Some(("carriers.per_op", most.to_string())),
                "work the needle once for each carrier",
            );
        }
        self.performed(op, instruction);
    }

    pub(super) fn performed(&mut self, op: usize, instruction: &Instruction) {
        if let Some(machine) = self.machine
            && !machine.performs(instruction.opcode())
        {
            let list = machine.operations.join(", ");
            self.findings.push(
                Finding::OperationNotPerformed,
                Some(op),
                |_| format!("the machine does not {}", instruction.opcode()),
                Some(("operations", list)),
                "",
            );
        }
    }

    pub(super) fn bring_in(&mut self, op: usize, carriers: CarrierSet, hooked: bool) {
        let by = self.machine.map(|machine| machine.entry.bring_in);
        if hooked && by == Some(BringIn::Gripper) {
            self.no_hook(op);
        } else if !hooked && by == Some(BringIn::Hook) && !carriers.is_empty() {
            self.findings.push(
                Finding::LooseYarn,
                Some(op),
                |_| "the yarn comes in without the hook that would hold its end".to_owned(),
                Some(("entry.bring_in", "hook".to_owned())),
                "use `inhook`",
            );
        }
        if carriers.is_empty() {
            self.say(Finding::NoCarrier, op, |_| "the operation names no carrier".to_owned(), "");
        }
        for &id in carriers.iter() {
            let Some(carrier) = self.carriers.get_mut(usize::from(id)) else { continue };
            if carrier.inside {
                let message = |code: &Code| format!("carrier {} is in already", code.carrier(id));
                self.say(Finding::CarrierInTwice, op, message, "take it out before it comes in again");
                continue;
            }
            let ever = carrier.ever;
            *carrier = Carrier { inside: true, brought: Some(op as u32), ever, ..Carrier::default() };
        }
        if hooked && by != Some(BringIn::Gripper) {
            if self.hook.is_some() {
                let message = |_: &Code| "the hook still holds another yarn".to_owned();
                self.say(Finding::HookOccupied, op, message, "`releasehook` it first");
            }
            self.hook = Some(Hook { carriers, parked: None, formed: false, transfer_told: false });
        }
    }

    pub(super) fn no_hook(&mut self, op: usize) {
        self.findings.push(
            Finding::NoHook,
            Some(op),
            |_| "the machine has no inserting hook".to_owned(),
            Some(("entry.bring_in", "gripper".to_owned())),
            "use `in` and `out`; `releasehook` is not needed",
        );
    }

    pub(super) fn release(&mut self, op: usize, carriers: CarrierSet) {
        if self.machine.is_some_and(|machine| machine.entry.bring_in == BringIn::Gripper) {
            return self.no_hook(op);
        }
        let mut named: Vec<CarrierId> = carriers.to_vec();
        named.sort_unstable();
        match self.hook.take() {
            Some(hook) if sorted(&hook.carriers) == named => {
                if !hook.formed {
                    let message = |_: &Code| "the hook lets go before the yarn has made a loop".to_owned();
                    self.say(
                        Finding::HookReleasedEarly,
                        op,
                        message,
                        "release it after the first bed of loops",
                    );
                }
            }
            other => {
                self.hook = other;
                let message = |_: &Code| "the hook does not hold these yarns".to_owned();
                self.say(
                    Finding::HookEmpty,
                    op,
                    message,
                    "`releasehook` names the carriers of the `inhook` before it",
                );
            }
        }
    }

    pub(super) fn take_out(&mut self, op: usize, carriers: CarrierSet, hooked: bool) {
        if hooked && self.machine.is_some_and(|machine| machine.entry.bring_in == BringIn::Gripper) {
            self.no_hook(op);
        }
        if carriers.is_empty() {
            self.say(Finding::NoCarrier, op, |_| "the operation names no carrier".to_owned(), "");
        }
        for &id in carriers.iter() {
            let Some(&carrier) = self.carriers.get(usize::from(id)) else { continue };
            if !carrier.inside {
                let message = |code: &Code| format!("carrier {} is not in", code.carrier(id));
                self.say(Finding::CarrierNotIn, op, message, "");
                continue;
            }
            if self.hook.as_ref().is_some_and(|hook| hook.carriers.contains(&id)) {
                let message = |code: &Code| format!("carrier {} is still in the hook", code.carrier(id));
                self.say(Finding::CarrierInHook, op, message, "`releasehook` it first");
                self.hook = None;
            }
            if let (false, Some(brought)) = (carrier.used, carrier.brought) {
                let message =
                    |code: &Code| format!("carrier {} is brought in and not used", code.carrier(id));
                self.say(Finding::CarrierUnused, brought as usize, message, "");
            }
            if let Some(carrier) = self.carriers.get_mut(usize::from(id)) {
                *carrier = Carrier { ever: carrier.ever, ..Carrier::default() };
            }
        }
    }

    /// Carriers come in before use, the first pass goes the machine's way, and no needle lies under the hook.
    pub(super) fn use_carriers(
        &mut self,
        op: usize,
        direction: Direction,
        needle: Needle,
        carriers: CarrierSet,
    ) {
        for &id in carriers.iter() {
            let Some(carrier) = self.carriers.get_mut(usize::from(id)) else { continue };
            (carrier.used, carrier.ever) = (true, true);
            if !carrier.inside {
                carrier.inside = true;
                let message = |code: &Code| format!("carrier {} is used while out", code.carrier(id));
                self.say(Finding::CarrierOut, op, message, "bring it in first");
            }
        }
        let place = needle.place(self.rack);
        let entry = self.machine.map(|machine| &machine.entry);
        let first_pass = match &mut self.hook {
            Some(hook) => {
                let first = hook.parked.is_none() && sorted(&hook.carriers) == sorted(&carriers);
                if first {
                    hook.parked = Some(place);
                }
                first
            }
            None => self.report.loops == 0 && entry.is_some_and(|entry| entry.bring_in == BringIn::Gripper),
        };
        let Some(entry) = entry else { return };
        let wanted = entry.first_direction.direction();
        if first_pass && direction != wanted {
            self.findings.push(
                Finding::FirstDirection,
                Some(op),
                |_| format!("the first pass of the yarn goes {}", direction.sign()),
                Some(("entry.first_direction", wanted.sign().to_string())),
                "begin at the other side",
            );
        }
        if let Some(parked) = self.hook.as_ref().and_then(|hook| hook.parked)
            && place > parked
            && place <= parked.saturating_add(4 * entry.hook_width)
        {
            self.findings.push(
                Finding::NeedleUnderHook,
                Some(op),
                |_| format!("needle {needle} lies under the parked hook"),
                Some(("entry.hook_width", entry.hook_width.to_string())),
                "`releasehook` first, or begin further right",
            );
        }
    }

    pub(super) fn set_position(&mut self, id: CarrierId, needle: Needle) {
        if let Some(carrier) = self.carriers.get_mut(usize::from(id)) {
            carrier.position = Some(needle);
        }
    }

    pub(super) fn float(&mut self, op: usize, id: CarrierId, needle: Needle) {
        let Some(carrier) = self.carriers.get(usize::from(id)) else { return };
        let Some(from) = self.needles.needle(carrier.last).or(carrier.position) else { return };
        let distance = (from.place(self.rack) - needle.place(self.rack)).abs();
        let needles = f64::from(distance) / 4.0;
        self.report.longest_float = self.report.longest_float.max(needles);
        let limit = self.machine.map_or(0, |machine| machine.limits.float);
        if limit > 0 && needles > f64::from(limit) {
            self.findings.push(
                Finding::LongFloat,
                Some(op),
                |_| format!("the yarn floats over {needles} needles from {from} to {needle}"),
                Some(("limits.float", limit.to_string())),
                "tuck the yarn in between",
            );
        }
    }

    pub(super) fn extension(&mut self, op: usize, text: u32) {
        let words = self.code.texts.get(text as usize).map_or("", String::as_str);
        let mut tokens = words.split_whitespace();
        let name = tokens.next().unwrap_or("x-").to_owned();
        let known = |machine: &Machine| machine.extensions.contains(&name);
        let fine = match self.machine {
            Some(machine) => known(machine),
            None => super::MACHINES
                .iter()
                .filter_map(|(name, _)| Machine::named(name))
                .any(|machine| known(&machine)),
        };
        if !fine {
            let message = |_: &Code| format!("extension `{name}` is not known and does nothing");
            let field = self.machine.map(|machine| ("extensions", machine.extensions.join(", ")));
            self.findings.push(Finding::UnknownExtension, Some(op), message, field, "");
        }
        if name == "x-speed-number"
            && let Some(speed) = self.machine.and_then(|machine| machine.speed.as_ref())
        {
            let [least, greatest] = speed.range;
            let value = tokens.next().and_then(|word| word.parse::<u32>().ok());
            if value.is_none_or(|value| !(least..=greatest).contains(&value)) {
                let message = |_: &Code| "the speed is out of range".to_owned();
                let field = Some(("speed.range", format!("{least} to {greatest}")));
                self.findings.push(Finding::ValueOutOfRange, Some(op), message, field, "");
            }
        }
    }
}

fn sorted(carriers: &CarrierSet) -> Vec<CarrierId> {
    let mut ids = carriers.to_vec();
    ids.sort_unstable();
    ids
}
