//! The yarns of a piece: a carrier for each color, brought in with its first stitch and let go when that can be done.

use super::emit::Emitter;
use super::tube::{ItemId, Stuck, Tube};
use crate::ir::machine::profile::BringIn;
use crate::ir::machine::{Bed, CarrierId, CarrierSet, Instruction, Machine};

#[derive(Debug)]
pub(super) struct Yarns<'m> {
    machine: &'m Machine,
    /// The carrier of each color.
    palette: Vec<CarrierId>,
    /// For each color the needle of its last stitch, while its carrier is in.
    last: Vec<Option<i32>>,
    color: u16,
    /// What the hook holds, and the bed of its first stitch.
    hook: Option<(CarrierSet, Bed)>,
}

/// Carriers that can knit pieces: that of the profile first, those of waste yarn and draw thread never.
pub(super) fn palette(machine: &Machine) -> Vec<CarrierId> {
    let names = || machine.carriers.names.iter().enumerate();
    let waste = |name: &String| {
        machine
            .waste
            .as_ref()
            .is_some_and(|waste| waste.rows > 0 && (*name == waste.carrier || *name == waste.draw))
    };
    let first = names().filter(|(_, name)| **name == machine.carriers.yarn);
    let others = names().filter(|(_, name)| **name != machine.carriers.yarn && !waste(name));
    first.chain(others).map(|(id, _)| id as CarrierId).collect()
}

impl<'m> Yarns<'m> {
    pub(super) fn new(machine: &'m Machine, color: u16) -> Self {
        let palette = palette(machine);
        let last = vec![None; palette.len()];
        Self { machine, palette, last, color, hook: None }
    }

    /// The carrier in use.
    pub(super) fn carrier(&self) -> CarrierId {
        self.palette.get(usize::from(self.color)).copied().unwrap_or(0)
    }

    fn last(&mut self) -> Option<&mut Option<i32>> {
        self.last.get_mut(usize::from(self.color))
    }

    /// Brings a carrier in; it is used next.
    pub(super) fn bring_in(machine: &Machine, carrier: CarrierId, emitter: &mut Emitter) {
        let set = CarrierSet::one(carrier);
        emitter.rest();
        emitter.push(match machine.entry.bring_in {
            BringIn::Hook => Instruction::InHook(set),
            BringIn::Gripper => Instruction::In(set),
        });
    }

    pub(super) fn take_out(machine: &Machine, carrier: CarrierId, emitter: &mut Emitter) {
        let set = CarrierSet::one(carrier);
        emitter.push(match machine.entry.bring_in {
            BringIn::Hook => Instruction::OutHook(set),
            BringIn::Gripper => Instruction::Out(set),
        });
    }

    /// The carrier has been brought in and stands at this needle.
    pub(super) fn stands_at(&mut self, needle: i32) {
        if let Some(last) = self.last() {
            *last = Some(needle);
        }
    }

    /// Works an item in a color.
    pub(super) fn stitch(
        &mut self,
        tube: &mut Tube,
        id: ItemId,
        forward: bool,
        color: u16,
        emitter: &mut Emitter,
    ) -> Result<(), Stuck> {
        let needle = tube.needle(id);
        if color != self.color {
            self.settle(emitter);
            self.color = color;
            let limit = self.machine.limits.float as i32;
            let carrier = self.carrier();
            // A yarn that would float too far across is cut and begun anew.
            if let Some(last) = self.last()
                && last.is_some_and(|last| limit > 0 && (last - needle.index).abs() > limit)
            {
                *last = None;
                Self::take_out(self.machine, carrier, emitter);
            }
        }
        tube.set_carriers(CarrierSet::one(self.carrier()));
        if self.last().is_some_and(|last| last.is_none()) {
            if self.start(tube, id, forward, emitter)? {
                self.stands_at(needle.index);
                return Ok(());
            }
        } else if self.hook.is_some_and(|(_, bed)| bed != needle.bed) {
            self.settle(emitter);
        }
        tube.work(id, forward, emitter);
        self.stands_at(needle.index);
        Ok(())
    }

    /// True where the yarn in use goes on at an item, after it moved to its bed; false where it would have to come in.
    pub(super) fn goes_on_at(
        &mut self,
        tube: &mut Tube,
        id: ItemId,
        color: u16,
        emitter: &mut Emitter,
    ) -> bool {
        if color != self.color || !self.last().is_some_and(|last| last.is_some()) {
            return false;
        }
        let needle = tube.needle(id);
        if self.hook.is_some_and(|(_, bed)| bed != needle.bed) {
            self.settle(emitter);
        }
        // The old loop moves to the other bed, which the hook would be in the way of.
        if self.hook.is_some() {
            return false;
        }
        tube.set_carriers(CarrierSet::one(self.carrier()));
        self.stands_at(needle.index);
        true
    }

    /// Brings the carrier in for an item. Where the course runs against the first direction of a yarn, the yarn is
    /// first laid on that needle, and the hook lets go at once. True when that was the item's loop already.
    fn start(
        &mut self,
        tube: &mut Tube,
        id: ItemId,
        forward: bool,
        emitter: &mut Emitter,
    ) -> Result<bool, Stuck> {
        let set = CarrierSet::one(self.carrier());
        Self::bring_in(self.machine, self.carrier(), emitter);
        let first = self.machine.entry.first_direction.direction();
        let item = tube.item(id);
        let along = tube.direction(id, forward) == first;
        let hooked = self.machine.entry.bring_in == BringIn::Hook;
        if along != item.ghost {
            self.hook = hooked.then_some((set, item.bed));
            return Ok(false);
        }
        tube.wrap(id, first, None, emitter)?;
        tube.change(id, |item| item.ghost = false);
        if hooked {
            emitter.push(Instruction::ReleaseHook(set));
        }
        Ok(item.ghost)
    }

    /// The hook lets go, before loops move or the yarn is done with.
    pub(super) fn settle(&mut self, emitter: &mut Emitter) {
        if let Some((set, _)) = self.hook.take() {
            emitter.push(Instruction::ReleaseHook(set));
        }
    }

    /// New loops on empty needles, in one pass from the side of the yarn.
    pub(super) fn cast_on(&mut self, tube: &mut Tube, mut items: Vec<ItemId>, emitter: &mut Emitter) {
        let direction = self.machine.entry.first_direction.direction();
        let sign = if direction == crate::ir::machine::Direction::Minus { -1 } else { 1 };
        items.sort_by_key(|&id| sign * tube.needle(id).index);
        let set = CarrierSet::one(self.carrier());
        Self::bring_in(self.machine, self.carrier(), emitter);
        for &id in &items {
            emitter.tuck(direction, tube.needle(id), set);
            tube.change(id, |item| {
                item.ghost = false;
                item.loops = 1;
            });
        }
        if let Some(&last) = items.last() {
            let needle = tube.needle(last);
            self.stands_at(needle.index);
            // It lets go when the course comes to the other bed.
            self.hook = (self.machine.entry.bring_in == BringIn::Hook).then_some((set, Bed::Front));
        }
    }

    /// True once a carrier is in.
    pub(super) fn started(&self) -> bool {
        self.last.iter().any(Option::is_some)
    }

    /// Takes out all carriers that are in.
    pub(super) fn finish(&mut self, emitter: &mut Emitter) {
        self.settle(emitter);
        for (&carrier, last) in self.palette.iter().zip(&mut self.last) {
            if last.take().is_some() {
                Self::take_out(self.machine, carrier, emitter);
            }
        }
    }
}
