//! The beds while several limbs hang on them: which loops wait for a limb, where, and how a limb begins on them.

use super::begin::{self, Source};
use super::emit::Emitter;
use super::refuse::Reason;
use super::tube::{Bounds, ItemId, Stuck, Tube};
use super::yarns::Yarns;
use crate::ir::PartId;
use crate::ir::machine::profile::{BringIn, Side};
use crate::ir::machine::{CarrierSet, Machine};

/// Empty slots between a limb and loops that wait beside it.
const GAP: i32 = 3;

/// Loops that wait on their needles.
#[derive(Debug)]
struct Waiting {
    /// The part whose loops they are.
    from: PartId,
    /// The part for which they were set aside; `None` for the open loops at the end.
    by: Option<PartId>,
    /// How many were left before.
    turn: u32,
    tube: Tube,
}

/// The pieces of one group share needles, so they share the pen.
#[derive(Debug)]
pub(super) struct Bench<'m> {
    pub(super) machine: &'m Machine,
    pub(super) emitter: Emitter,
    pub(super) from_right: bool,
    /// From left to right.
    waiting: Vec<Waiting>,
    left_so_far: u32,
}

impl<'m> Bench<'m> {
    pub(super) fn new(machine: &'m Machine) -> Self {
        let from_right = machine.entry.parking == Side::Right;
        Self { machine, emitter: Emitter::default(), from_right, waiting: Vec::new(), left_so_far: 0 }
    }

    /// Leaves loops on their needles.
    pub(super) fn leave(&mut self, from: PartId, by: Option<PartId>, tube: Tube) {
        let at = self.waiting.partition_point(|other| other.tube.extent().0 < tube.extent().0);
        self.left_so_far += 1;
        self.waiting.insert(at, Waiting { from, by, turn: self.left_so_far, tube });
    }

    fn take(&mut self, source: Source, to: PartId, more: usize) -> Option<Tube> {
        let wanted = |waiting: &Waiting| match source {
            Source::Open(from) => waiting.from == from && waiting.by.is_none(),
            Source::Held(from, _) => waiting.from == from && waiting.by == Some(to),
            Source::Chain(_) => false,
        };
        let mut fitting: Vec<(u32, usize)> = self
            .waiting
            .iter()
            .enumerate()
            .filter(|(_, waiting)| wanted(waiting))
            .map(|(at, waiting)| (waiting.turn, at))
            .collect();
        fitting.sort_unstable();
        let &(_, at) = fitting.get(fitting.len().checked_sub(more + 1)?)?;
        let whole = match source {
            Source::Held(_, loops) => self.waiting.get(at)?.tube.ahead.len() == loops as usize,
            Source::Open(_) | Source::Chain(_) => true,
        };
        if !whole {
            return None;
        }
        Some(self.waiting.remove(at).tube)
    }

    /// A new piece is laid out beside what waits, towards the yarn, and grows away from it.
    pub(super) fn place_new(&mut self, tube: &mut Tube) {
        let (Some(first), Some(last)) = (self.waiting.first(), self.waiting.last()) else { return };
        let (left, right) = tube.extent();
        let by = if self.from_right {
            last.tube.extent().1 + GAP + 1 - left
        } else {
            first.tube.extent().0 - GAP - 1 - right
        };
        for item in &mut tube.items {
            item.slot += by;
        }
        tube.front_left += by;
        tube.back_left += by;
        self.face(tube);
    }

    /// A tube grows away from the loops that wait beside it.
    fn face(&self, tube: &mut Tube) {
        let (left, right) = tube.extent();
        let on_left = self.waiting.iter().any(|other| other.tube.extent().1 < left);
        let on_right = self.waiting.iter().any(|other| other.tube.extent().0 > right);
        match (on_left, on_right) {
            (true, _) => tube.outward = 1,
            (false, true) => tube.outward = -1,
            (false, false) => {}
        }
    }

    /// Moves what waits at the free edge of a tube until that has so many empty slots.
    pub(super) fn make_room(&mut self, tube: &Tube, slots: i32) {
        let (left, right) = tube.extent();
        let outward = tube.outward;
        let beyond = |other: &Waiting| {
            if outward > 0 { other.tube.extent().0 > right } else { other.tube.extent().1 < left }
        };
        let gap = |other: &Waiting| {
            if outward > 0 { other.tube.extent().0 - right - 1 } else { left - other.tube.extent().1 - 1 }
        };
        let nearest = self.waiting.iter().filter(|other| beyond(other)).map(gap).min();
        let Some(missing) = nearest.map(|gap| slots - gap).filter(|missing| *missing > 0) else { return };
        let mut moved: Vec<&mut Waiting> = self.waiting.iter_mut().filter(|other| beyond(other)).collect();
        // The outermost goes first.
        if outward > 0 {
            moved.reverse();
        }
        for other in moved {
            other.tube.move_by(outward * missing, &mut self.emitter);
        }
    }

    /// On a machine that brings yarn in from one side without a hook, it would lie across loops on that side.
    pub(super) fn yarn_reaches(&self, tube: &Tube) -> Result<(), Reason> {
        if self.machine.entry.bring_in == BringIn::Hook {
            return Ok(());
        }
        let (left, right) = tube.extent();
        let between = |other: &&Waiting| {
            let extent = other.tube.extent();
            if self.from_right { extent.0 > right } else { extent.1 < left }
        };
        match self.waiting.iter().find(between) {
            Some(other) => Err(Reason::Across(other.from)),
            None => Ok(()),
        }
    }

    /// Takes the loops of a limb together, with needles for new loops between them, and casts those on.
    pub(super) fn join(
        &mut self,
        sources: &[Source],
        to: PartId,
        yarns: &mut Yarns<'_>,
    ) -> Result<Tube, Reason> {
        // New loops before the first waiting ones, and after each.
        let mut first = 0_u32;
        let mut limbs: Vec<(Tube, u32)> = Vec::new();
        for (at, &source) in sources.iter().enumerate() {
            match (source, limbs.last_mut()) {
                (Source::Chain(loops), None) => first = first.saturating_add(loops),
                (Source::Chain(loops), Some((_, after))) => *after = after.saturating_add(loops),
                (Source::Open(_) | Source::Held(..), _) => {
                    let tube = self
                        .take(source, to, begin::more_of(sources, at))
                        .ok_or(Reason::NotWaiting(source))?;
                    limbs.push((tube, 0));
                }
            }
        }
        let new = limbs.iter().fold(first, |sum, (_, after)| sum.saturating_add(*after));
        if new > self.machine.tube.max_loops {
            return Err(Reason::Loops(new));
        }
        let mut limbs = limbs.into_iter();
        let (mut tube, ghosts) = match (limbs.next(), limbs.next(), limbs.next()) {
            (Some((tube, after)), None, _) => self.lengthen(tube, first, after)?,
            (Some((a, after_a)), Some((b, after_b)), None) => self.merge(a, after_a, b, after_b, first)?,
            (_, _, third) => {
                return Err(if third.is_some() { Reason::ThreeLimbs } else { Stuck::Narrow.into() });
            }
        };
        self.face(&mut tube);
        self.yarn_reaches(&tube)?;
        tube.set_carriers(CarrierSet::one(yarns.carrier()));
        if !ghosts.is_empty() {
            yarns.cast_on(&mut tube, ghosts, &mut self.emitter);
        }
        Ok(tube)
    }

    /// One stretch of loops, closed to a tube by new ones.
    fn lengthen(&mut self, mut tube: Tube, first: u32, after: u32) -> Result<(Tube, Vec<ItemId>), Reason> {
        let new = first + after;
        if new == 0 {
            return Ok((tube, Vec::new()));
        }
        self.face(&mut tube);
        self.make_room(&tube, new as i32 / 2 + GAP);
        tube.begin_at(self.from_right, &mut self.emitter)?;
        let ghosts = tube.reserve_at_edge(new, self.from_right);
        let (behind, before) = ghosts.split_at((after as usize).min(ghosts.len()));
        tube.ahead = before.iter().chain(&tube.ahead).chain(behind).copied().collect();
        Ok((tube, ghosts))
    }

    /// Two stretches side by side become one tube.
    fn merge(
        &mut self,
        a: Tube,
        after_a: u32,
        b: Tube,
        after_b: u32,
        first: u32,
    ) -> Result<(Tube, Vec<ItemId>), Reason> {
        let (a_at, b_at) = (a.extent(), b.extent());
        let (low, high) = (a_at.1.min(b_at.1), a_at.0.max(b_at.0));
        if let Some(other) = self.waiting.iter().find(|other| (low..=high).contains(&other.tube.extent().0)) {
            return Err(Reason::Between(other.from));
        }
        let a_left = a_at.0 < b_at.0;
        // New loops before the first stretch come after the last one, as the round closes.
        let last = after_b.saturating_add(first);
        let (mut left, mut right, new) =
            if a_left { (a, b, [after_a, last]) } else { (b, a, [last, after_a]) };
        (left.outward, right.outward) = (-1, 1);
        self.make_room(&left, GAP);
        self.make_room(&right, GAP);
        let own = left.ahead.clone();
        let [mut after_left, others, mut after_right] = left.unite(right, new, &mut self.emitter)?;
        let ghosts: Vec<ItemId> = after_left.iter().chain(&after_right).copied().collect();
        let tail = if a_left { &mut after_right } else { &mut after_left };
        let head = tail.split_off((after_b as usize).min(tail.len()));
        let order = if a_left {
            [head, own.into(), after_left, others, after_right]
        } else {
            [head, others, after_right, own.into(), after_left]
        };
        left.ahead = order.into_iter().flatten().collect();
        left.outward = if self.from_right { -1 } else { 1 };
        Ok((left, ghosts))
    }

    /// Slots between which nothing else may hang.
    pub(super) fn bounds(&self) -> Bounds {
        Bounds::of(self.machine)
    }
}
