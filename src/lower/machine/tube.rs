//! A tube on both beds: where its loops hang, and the transfers that make and take room.
//!
//! Loops lie in slots. At half gauge the front loop of slot i hangs on f(2i) and the back loop on b(2i - 1), so each has
//! an empty needle straight opposite, its *park* needle. At full gauge they hang on f(i) and b(i), and the park needle is
//! the slider opposite; without sliders loops stay where they are. Course order runs over the front bed from right to left, then over
//! the back bed from left to right. At both edges the beds differ by at most one slot, so that the yarn always goes
//! from bed to bed over one needle. One edge is anchored; room is made and taken at the other, the free one.
//!
//! A flat piece is the plain case of this: one bed at full gauge, slot i on f(i), and both edges free.

use super::emit::Emitter;
use crate::ir::machine::{Bed, CarrierSet, Direction, Machine, Needle};
use std::collections::VecDeque;

/// A needle with its loops, or a ghost: a needle kept free for the second loop of an increase.
pub(super) type ItemId = u32;

#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    pub(super) bed: Bed,
    pub(super) slot: i32,
    pub(super) loops: u32,
    pub(super) ghost: bool,
    /// The turn whose wrap hangs here too.
    pub(super) wrap: Option<u32>,
}

/// Why a tube cannot go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stuck {
    /// A bed has run out of loops.
    Narrow,
    /// A needle would hold this many loops; the wrap of this turn is among them.
    Stack(u32, Option<u32>),
    /// The pattern works loops that are not there.
    Underflow,
    /// A loop of a tube on all needles has nowhere to wait on its way to another needle.
    Packed,
}

/// Where a loop of a tube waits on its way to another needle of its bed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Park {
    /// On the needle opposite, which half gauge leaves empty.
    Needle,
    /// On the slider opposite.
    Slider,
    Nowhere,
}

/// What a machine lets a piece do.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// Most loops on a needle.
    stack: u32,
    /// Slots that loops are moved by at once.
    pub(super) stride: i32,
    /// Needles from slot to slot of a tube.
    pitch: i32,
    park: Park,
}

impl Bounds {
    pub(super) fn of(machine: &Machine) -> Self {
        // Simulators warn when a needle reaches the limit, so one loop less is planned with, though never less than 3,
        // which is a double decrease.
        let stack = match machine.limits.loops_per_needle {
            0 => 0,
            limit => limit.saturating_sub(1).max(limit.min(3)),
        };
        let (pitch, park) = match (machine.bed.half_gauge, machine.bed.sliders) {
            (true, _) => (2, Park::Needle),
            (false, true) => (1, Park::Slider),
            (false, false) => (1, Park::Nowhere),
        };
        // Neighbors of a shifted loop stand up to a slot away before.
        let stretch = match machine.limits.link_stretch {
            0 => i32::MAX,
            limit => (limit.min(1000) as i32 - pitch) / (2 * pitch),
        };
        let rack = machine.rack.preferred.min(machine.rack.max).min(1000.0) as i32 / pitch;
        let stack = if stack == 0 { u32::MAX } else { stack };
        Self { stack, stride: rack.min(stretch).max(1), pitch, park }
    }
}

#[derive(Debug)]
pub(super) struct Tube {
    pub(super) items: Vec<Item>,
    pub(super) front: VecDeque<ItemId>,
    pub(super) back: VecDeque<ItemId>,
    pub(super) front_left: i32,
    pub(super) back_left: i32,
    /// Open loops that the hook has before it, the next one in front.
    pub(super) ahead: VecDeque<ItemId>,
    /// Loops of the current row, the newest at the back.
    pub(super) behind: VecDeque<ItemId>,
    /// Of a flat piece: loops that rows left on the side from which the current row goes away, the nearest in front.
    pub(super) rest: VecDeque<ItemId>,
    /// -1 when the left edge is free, 1 when the right one is.
    pub(super) outward: i32,
    /// Of a flat piece: direction of the current row.
    pub(super) heading: Option<Direction>,
    pub(super) bounds: Bounds,
    carriers: CarrierSet,
}

impl Tube {
    /// Lays out a tube, its loops to be cast on in course order. Yarn from the right begins at the right of the front
    /// bed, yarn from the left at the left of the back bed, and the edge where it begins is the anchor.
    pub(super) fn new(loops: u32, from_right: bool, bounds: Bounds, carriers: CarrierSet) -> Self {
        let (larger, smaller) = (loops.div_ceil(2) as i32, (loops / 2) as i32);
        let (front, back) = if from_right { (larger, smaller) } else { (smaller, larger) };
        let mut tube = Self::empty(bounds, carriers, if from_right { -1 } else { 1 });
        tube.front_left = if from_right { -front } else { 0 };
        tube.back_left = if from_right { -back } else { 0 };
        for slot in tube.front_left..tube.front_left + front {
            let id = tube.add(Bed::Front, slot, false);
            tube.front.push_back(id);
        }
        for slot in tube.back_left..tube.back_left + back {
            let id = tube.add(Bed::Back, slot, false);
            tube.back.push_back(id);
        }
        let (right_to_left, left_to_right) = (tube.front.iter().rev(), tube.back.iter());
        tube.ahead = if from_right {
            right_to_left.chain(left_to_right).copied().collect()
        } else {
            left_to_right.chain(right_to_left).copied().collect()
        };
        tube
    }

    /// Lays out a flat piece on the front bed, to be cast on from the side of the yarn.
    pub(super) fn sheet(loops: u32, from_right: bool, bounds: Bounds, carriers: CarrierSet) -> Self {
        let mut sheet = Self::empty(bounds, carriers, if from_right { -1 } else { 1 });
        for slot in 0..loops as i32 {
            let id = sheet.add(Bed::Front, slot, false);
            sheet.front.push_back(id);
        }
        sheet.heading = Some(if from_right { Direction::Minus } else { Direction::Plus });
        let order = sheet.front.iter().copied();
        sheet.ahead = if from_right { order.rev().collect() } else { order.collect() };
        sheet
    }

    pub(super) fn empty(bounds: Bounds, carriers: CarrierSet, outward: i32) -> Self {
        Self {
            items: Vec::new(),
            front: VecDeque::new(),
            back: VecDeque::new(),
            front_left: 0,
            back_left: 0,
            ahead: VecDeque::new(),
            behind: VecDeque::new(),
            rest: VecDeque::new(),
            outward,
            heading: None,
            bounds,
            carriers,
        }
    }

    /// Ends a row: what it made is what the next one works. A flat piece turns.
    pub(super) fn end_row(&mut self) {
        match self.heading {
            None => self.ahead.append(&mut self.behind),
            Some(heading) => {
                self.heading = Some(heading.reverse());
                let left = std::mem::take(&mut self.ahead);
                self.ahead = self.behind.drain(..).rev().collect();
                self.ahead.append(&mut self.rest);
                self.rest = left;
            }
        }
    }

    /// Loops that hang open.
    pub(super) fn open_loops(&self) -> usize {
        self.ahead.len() + self.behind.len() + self.rest.len()
    }

    pub(super) fn add(&mut self, bed: Bed, slot: i32, ghost: bool) -> ItemId {
        self.items.push(Item { bed, slot, loops: u32::from(!ghost), ghost, wrap: None });
        (self.items.len() - 1) as ItemId
    }

    pub(super) fn item(&self, id: ItemId) -> Item {
        let missing = Item { bed: Bed::Front, slot: 0, loops: 0, ghost: true, wrap: None };
        self.items.get(id as usize).copied().unwrap_or(missing)
    }

    pub(super) fn change(&mut self, id: ItemId, change: impl FnOnce(&mut Item)) {
        if let Some(item) = self.items.get_mut(id as usize) {
            change(item);
        }
    }

    pub(super) fn row(&self, bed: Bed) -> (&VecDeque<ItemId>, i32) {
        match bed {
            Bed::Front => (&self.front, self.front_left),
            Bed::Back => (&self.back, self.back_left),
        }
    }

    pub(super) fn row_mut(&mut self, bed: Bed) -> (&mut VecDeque<ItemId>, &mut i32) {
        match bed {
            Bed::Front => (&mut self.front, &mut self.front_left),
            Bed::Back => (&mut self.back, &mut self.back_left),
        }
    }

    /// First and last slot of a bed.
    pub(super) fn edges(&self, bed: Bed) -> (i32, i32) {
        let (row, left) = self.row(bed);
        (left, left + row.len() as i32 - 1)
    }

    pub(super) fn needle(&self, id: ItemId) -> Needle {
        let item = self.item(id);
        self.place(item.bed, item.slot)
    }

    /// The needle of a slot.
    fn place(&self, bed: Bed, slot: i32) -> Needle {
        match (self.heading, bed) {
            (Some(_), _) => Needle::on(bed, slot),
            (None, Bed::Front) => Needle::front(self.bounds.pitch * slot),
            (None, Bed::Back) => Needle::back(self.bounds.pitch * slot + 1 - self.bounds.pitch),
        }
    }

    /// Where the loops of a needle wait while they move along its bed.
    fn park(&self, needle: Needle) -> Needle {
        let slider = self.heading.is_none() && self.bounds.park == Park::Slider;
        Needle { slider, ..Needle::on(needle.bed.other(), needle.index) }
    }

    /// Whether a loop can be moved past its neighbors.
    pub(super) fn movable(&self) -> Result<(), Stuck> {
        if self.packed() && self.bounds.park == Park::Nowhere { Err(Stuck::Packed) } else { Ok(()) }
    }

    /// Whether needles straight opposite both hold loops of this tube.
    pub(super) fn packed(&self) -> bool {
        self.heading.is_none() && self.bounds.pitch == 1
    }

    pub(super) fn bed(&self, id: ItemId) -> Bed {
        self.item(id).bed
    }

    /// Direction of the carriage on the bed of an item, for work along the course or against it.
    pub(super) fn direction(&self, id: ItemId, forward: bool) -> Direction {
        if let Some(heading) = self.heading {
            return if forward { heading } else { heading.reverse() };
        }
        match (self.item(id).bed, forward) {
            (Bed::Front, true) | (Bed::Back, false) => Direction::Minus,
            (Bed::Back, true) | (Bed::Front, false) => Direction::Plus,
        }
    }

    /// Knits an item, or makes the loop of a ghost by a tuck against the pass.
    pub(super) fn work(&mut self, id: ItemId, forward: bool, emitter: &mut Emitter) {
        let (needle, direction) = (self.needle(id), self.direction(id, forward));
        if self.item(id).ghost {
            emitter.tuck(direction.reverse(), needle, self.carriers);
        } else {
            emitter.knit(direction, needle, self.carriers);
        }
        self.change(id, |item| {
            item.loops = 1;
            item.ghost = false;
            item.wrap = None;
        });
    }

    /// Knits an item while its old loops move to the facing needle, which comes back.
    pub(super) fn split(&mut self, id: ItemId, forward: bool, emitter: &mut Emitter) -> Needle {
        let needle = self.needle(id);
        let park = Needle::on(needle.bed.other(), needle.index);
        emitter.split(self.direction(id, forward), needle, park, self.carriers);
        self.change(id, |item| {
            item.loops = 1;
            item.wrap = None;
        });
        park
    }

    /// Lays the yarn over an item without knitting it, which is the wrap of a turn.
    pub(super) fn wrap(
        &mut self,
        id: ItemId,
        direction: Direction,
        turn: Option<u32>,
        emitter: &mut Emitter,
    ) -> Result<(), Stuck> {
        emitter.tuck(direction, self.needle(id), self.carriers);
        self.grow(id, 1, turn)
    }

    fn grow(&mut self, id: ItemId, by: u32, wrap: Option<u32>) -> Result<(), Stuck> {
        let loops = self.item(id).loops + by;
        let wrap = wrap.or(self.item(id).wrap);
        self.change(id, |item| {
            item.loops = loops;
            item.wrap = wrap;
        });
        if loops > self.bounds.stack { Err(Stuck::Stack(loops, wrap)) } else { Ok(()) }
    }

    pub(super) fn set_carriers(&mut self, carriers: CarrierSet) {
        self.carriers = carriers;
    }

    /// Moves the loops of the slots `from..=to` by some slots: over to their park needles, rack, and back.
    pub(super) fn shift(&mut self, bed: Bed, from: i32, to: i32, by: i32, emitter: &mut Emitter) {
        let (row, left) = self.row(bed);
        let slice: Vec<ItemId> = row
            .iter()
            .skip((from - left).max(0) as usize)
            .take((to - from + 1).max(0) as usize)
            .copied()
            .collect();
        // The far end goes first, so that a loop never crosses one that still hangs.
        let far_first = |by: i32, slice: &[ItemId]| -> Vec<ItemId> {
            if by < 0 { slice.to_vec() } else { slice.iter().rev().copied().collect() }
        };
        let order = far_first(by, &slice);
        for pass in 0..2 {
            for &id in &order {
                let item = self.item(id);
                if item.ghost {
                    continue;
                }
                let needle = self.place(item.bed, item.slot);
                let park = self.park(needle);
                if pass == 0 {
                    emitter.xfer(needle, park);
                } else {
                    emitter.xfer(park, self.place(item.bed, item.slot + by));
                }
            }
        }
        for id in slice {
            self.change(id, |item| item.slot += by);
        }
    }

    /// Keeps a needle free after an item in course order, for the second loop of an increase.
    pub(super) fn open(&mut self, id: ItemId, emitter: &mut Emitter) -> Result<ItemId, Stuck> {
        self.movable()?;
        let Item { bed, slot, .. } = self.item(id);
        let (left, right) = self.edges(bed);
        let along = if self.direction(id, true) == Direction::Minus { -1 } else { 1 };
        let index = (slot - left) as usize;
        self.nearer_edge(slot, left, right);
        // On the bed that runs away from the anchor the item stays and the ones beyond it move; on the other it moves.
        let stays = along == self.outward;
        let (from, to) = match (self.outward, stays) {
            (-1, true) => (left, slot - 1),
            (-1, false) => (left, slot),
            (_, true) => (slot + 1, right),
            (_, false) => (slot, right),
        };
        let ghost_slot = if stays { slot + self.outward } else { slot };
        self.shift(bed, from, to, self.outward, emitter);
        let ghost = self.add(bed, ghost_slot, true);
        let outward = self.outward;
        let (row, left) = self.row_mut(bed);
        let at = match (outward, stays) {
            (-1, true) | (1, false) => index,
            _ => index + 1,
        };
        row.insert(at.min(row.len()), ghost);
        if outward < 0 {
            *left -= 1;
        }
        self.roll(emitter)?;
        Ok(ghost)
    }

    /// Both edges of a flat piece are free, and fewer loops move at the nearer one.
    fn nearer_edge(&mut self, slot: i32, left: i32, right: i32) {
        if self.heading.is_some() {
            self.outward = if slot - left < right - slot { -1 } else { 1 };
        }
    }

    /// Puts two neighbors in course order on one needle, which is the one that stays.
    pub(super) fn close(
        &mut self,
        first: ItemId,
        second: ItemId,
        emitter: &mut Emitter,
    ) -> Result<ItemId, Stuck> {
        self.movable()?;
        let (a, b) = (self.item(first), self.item(second));
        if a.bed == b.bed && self.row(a.bed).0.len() > 1 {
            self.close_on_bed(a.bed, first, second, emitter)
        } else {
            self.close_at_edge(a.bed, first, second, emitter)
        }
    }

    fn close_on_bed(
        &mut self,
        bed: Bed,
        first: ItemId,
        second: ItemId,
        emitter: &mut Emitter,
    ) -> Result<ItemId, Stuck> {
        let (a, b) = (self.item(first), self.item(second));
        if (a.slot - b.slot).abs() != 1 {
            return Err(Stuck::Underflow);
        }
        let (left, right) = self.edges(bed);
        self.nearer_edge(a.slot, left, right);
        let first_outer = (a.slot - b.slot) * self.outward > 0;
        let (outer, inner) = if first_outer { (first, second) } else { (second, first) };
        let slot = self.item(outer).slot;
        let (from, to) = if self.outward < 0 { (left, slot) } else { (slot, right) };
        self.shift(bed, from, to, -self.outward, emitter);
        let outward = self.outward;
        let (row, row_left) = self.row_mut(bed);
        row.remove((slot - left) as usize);
        if outward < 0 {
            *row_left += 1;
        }
        self.grow(inner, self.item(outer).loops, self.item(outer).wrap)?;
        self.roll(emitter)?;
        Ok(inner)
    }

    fn close_at_edge(
        &mut self,
        bed: Bed,
        first: ItemId,
        second: ItemId,
        emitter: &mut Emitter,
    ) -> Result<ItemId, Stuck> {
        let ((front_left, front_right), (back_left, back_right)) =
            (self.edges(Bed::Front), self.edges(Bed::Back));
        let at_left = bed == Bed::Front;
        let (front, back) = if at_left { (first, second) } else { (second, first) };
        let (front_moves, at_edge) = if at_left {
            let at_edge = self.front.front() == Some(&front) && self.back.front() == Some(&back);
            (back_left - front_left == 1, at_edge)
        } else {
            let at_edge = self.front.back() == Some(&front) && self.back.back() == Some(&back);
            (back_right - front_right != 1, at_edge)
        };
        if !at_edge {
            return Err(Stuck::Underflow);
        }
        let (moved, stays) = if front_moves { (front, back) } else { (back, front) };
        let moved_bed = self.item(moved).bed;
        if self.row(moved_bed).0.len() < 2 {
            return Err(Stuck::Narrow);
        }
        emitter.xfer(self.needle(moved), self.needle(stays));
        let (row, left) = self.row_mut(moved_bed);
        if at_left {
            row.pop_front();
            *left += 1;
        } else {
            row.pop_back();
        }
        self.grow(stays, self.item(moved).loops, self.item(moved).wrap)?;
        self.roll(emitter)?;
        Ok(stays)
    }

    /// Brings the free edge back to where the beds differ by at most one slot.
    pub(super) fn roll(&mut self, emitter: &mut Emitter) -> Result<(), Stuck> {
        if self.heading.is_some() {
            return Ok(());
        }
        loop {
            let ((front_left, front_right), (back_left, back_right)) =
                (self.edges(Bed::Front), self.edges(Bed::Back));
            let ahead = if self.outward < 0 { back_left - front_left } else { front_right - back_right + 1 };
            // `ahead` counts how far the back bed begins right of the front one, seen towards the tube: 0 or 1 is fine.
            let (from, slot) = match (self.outward < 0, ahead) {
                (_, 0 | 1) => return Ok(()),
                (true, 2..) => (Bed::Front, back_left - 1),
                (true, _) => (Bed::Back, front_left - 1),
                (false, 2..) => (Bed::Front, back_right + 1),
                (false, _) => (Bed::Back, front_right + 1),
            };
            if self.row(from).0.len() < 2 {
                return Err(Stuck::Narrow);
            }
            let outward = self.outward;
            let (row, left) = self.row_mut(from);
            let id = if outward < 0 {
                *left += 1;
                row.pop_front()
            } else {
                row.pop_back()
            };
            let Some(id) = id else { return Err(Stuck::Narrow) };
            let target = self.place(from.other(), slot);
            if !self.item(id).ghost {
                emitter.xfer(self.needle(id), target);
            }
            self.change(id, |item| {
                item.bed = from.other();
                item.slot = slot;
            });
            let (row, left) = self.row_mut(from.other());
            if outward < 0 {
                row.push_front(id);
                *left -= 1;
            } else {
                row.push_back(id);
            }
        }
    }

    /// The slots of both beds from left to right, each with its front and its back item.
    pub(super) fn slots(&self) -> Vec<(Option<ItemId>, Option<ItemId>)> {
        let ((front_left, front_right), (back_left, back_right)) =
            (self.edges(Bed::Front), self.edges(Bed::Back));
        let at = |row: &VecDeque<ItemId>, left: i32, slot: i32| {
            usize::try_from(slot - left).ok().and_then(|index| row.get(index).copied())
        };
        (front_left.min(back_left)..=front_right.max(back_right))
            .map(|slot| (at(&self.front, front_left, slot), at(&self.back, back_left, slot)))
            .collect()
    }

    /// Takes an item's loops over to another needle's.
    pub(super) fn gather(&mut self, from: ItemId, onto: ItemId, emitter: &mut Emitter) -> Result<(), Stuck> {
        emitter.xfer(self.needle(from), self.needle(onto));
        self.grow(onto, self.item(from).loops, self.item(from).wrap)
    }

    /// Moves the one loop of a bound-off needle onto a neighbor, over the needle opposite where that is `free`.
    pub(super) fn chain(
        &mut self,
        from: ItemId,
        onto: ItemId,
        free: bool,
        emitter: &mut Emitter,
    ) -> Result<(), Stuck> {
        let (start, end) = (self.needle(from), self.needle(onto));
        if start.bed == end.bed {
            let park = if free {
                Needle::on(start.bed.other(), start.index)
            } else {
                self.movable()?;
                self.park(start)
            };
            emitter.xfer(start, park);
            emitter.xfer(park, end);
        } else {
            emitter.xfer(start, end);
        }
        self.grow(onto, 1, None)
    }
}
