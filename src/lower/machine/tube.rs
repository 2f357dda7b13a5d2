//! A tube on both beds at half gauge: where its loops hang, and the transfers that make and take room.
//!
//! Loops lie in slots. The front loop of slot i hangs on f(2i) and the back loop on b(2i - 1), so each has an empty
//! needle straight opposite, its *park* needle. Course order runs over the front bed from right to left, then over
//! the back bed from left to right. At both edges the beds differ by at most one slot, so that the yarn always goes
//! from bed to bed over one needle. One edge is anchored; room is made and taken at the other, the free one.

use super::emit::Emitter;
use crate::ir::machine::{Bed, CarrierSet, Direction, Needle};
use std::collections::VecDeque;

/// A needle with its loops, or a ghost: a needle kept free for the second loop of an increase.
pub(super) type ItemId = u32;

#[derive(Clone, Copy, Debug)]
struct Item {
    bed: Bed,
    slot: i32,
    loops: u32,
    ghost: bool,
}

/// Why a tube cannot go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stuck {
    /// A bed has run out of loops.
    Narrow,
    /// A needle would hold this many loops.
    Stack(u32),
    /// The pattern works loops that are not there.
    Underflow,
}

#[derive(Debug)]
pub(super) struct Tube {
    items: Vec<Item>,
    front: VecDeque<ItemId>,
    back: VecDeque<ItemId>,
    front_left: i32,
    back_left: i32,
    /// Open loops in working order: the next one in front, the newest at the back.
    pub(super) open: VecDeque<ItemId>,
    /// -1 when the left edge is free, 1 when the right one is.
    outward: i32,
    /// Most loops that a needle may hold.
    limit: u32,
    carriers: CarrierSet,
}

impl Tube {
    /// Lays out a tube, its loops to be cast on in course order. Yarn from the right begins at the right of the front
    /// bed, yarn from the left at the left of the back bed, and the edge where it begins is the anchor.
    pub(super) fn new(loops: u32, from_right: bool, limit: u32, carriers: CarrierSet) -> Self {
        let (larger, smaller) = (loops.div_ceil(2) as i32, (loops / 2) as i32);
        let (front, back) = if from_right { (larger, smaller) } else { (smaller, larger) };
        let mut tube = Self {
            items: Vec::with_capacity(loops as usize),
            front: VecDeque::new(),
            back: VecDeque::new(),
            front_left: if from_right { -front } else { 0 },
            back_left: if from_right { -back } else { 0 },
            open: VecDeque::new(),
            outward: if from_right { -1 } else { 1 },
            limit: if limit == 0 { u32::MAX } else { limit },
            carriers,
        };
        for slot in tube.front_left..tube.front_left + front {
            let id = tube.add(Bed::Front, slot, false);
            tube.front.push_back(id);
        }
        for slot in tube.back_left..tube.back_left + back {
            let id = tube.add(Bed::Back, slot, false);
            tube.back.push_back(id);
        }
        let (right_to_left, left_to_right) = (tube.front.iter().rev(), tube.back.iter());
        tube.open = if from_right {
            right_to_left.chain(left_to_right).copied().collect()
        } else {
            left_to_right.chain(right_to_left).copied().collect()
        };
        tube
    }

    fn add(&mut self, bed: Bed, slot: i32, ghost: bool) -> ItemId {
        self.items.push(Item { bed, slot, loops: u32::from(!ghost), ghost });
        (self.items.len() - 1) as ItemId
    }

    fn item(&self, id: ItemId) -> Item {
        let missing = Item { bed: Bed::Front, slot: 0, loops: 0, ghost: true };
        self.items.get(id as usize).copied().unwrap_or(missing)
    }

    fn change(&mut self, id: ItemId, change: impl FnOnce(&mut Item)) {
        if let Some(item) = self.items.get_mut(id as usize) {
            change(item);
        }
    }

    fn row(&self, bed: Bed) -> (&VecDeque<ItemId>, i32) {
        match bed {
            Bed::Front => (&self.front, self.front_left),
            Bed::Back => (&self.back, self.back_left),
        }
    }

    fn row_mut(&mut self, bed: Bed) -> (&mut VecDeque<ItemId>, &mut i32) {
        match bed {
            Bed::Front => (&mut self.front, &mut self.front_left),
            Bed::Back => (&mut self.back, &mut self.back_left),
        }
    }

    /// First and last slot of a bed.
    fn edges(&self, bed: Bed) -> (i32, i32) {
        let (row, left) = self.row(bed);
        (left, left + row.len() as i32 - 1)
    }

    pub(super) fn needle(&self, id: ItemId) -> Needle {
        let item = self.item(id);
        place(item.bed, item.slot)
    }

    pub(super) fn bed(&self, id: ItemId) -> Bed {
        self.item(id).bed
    }

    /// Direction of the carriage on the bed of an item, for work along the course or against it.
    pub(super) fn direction(&self, id: ItemId, forward: bool) -> Direction {
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
        });
    }

    /// Lays the yarn over an item without knitting it.
    pub(super) fn wrap(&mut self, id: ItemId, forward: bool, emitter: &mut Emitter) -> Result<(), Stuck> {
        emitter.tuck(self.direction(id, forward), self.needle(id), self.carriers);
        self.grow(id, 1)
    }

    fn grow(&mut self, id: ItemId, by: u32) -> Result<(), Stuck> {
        let loops = self.item(id).loops + by;
        self.change(id, |item| item.loops = loops);
        if loops > self.limit { Err(Stuck::Stack(loops)) } else { Ok(()) }
    }

    pub(super) fn set_carriers(&mut self, carriers: CarrierSet) {
        self.carriers = carriers;
    }

    /// Moves the loops of the slots `from..=to` by one slot: over to their park needles, rack, and back.
    fn shift(&mut self, bed: Bed, from: i32, to: i32, by: i32, emitter: &mut Emitter) {
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
                let needle = place(item.bed, item.slot);
                let park = Needle::on(item.bed.other(), needle.index);
                if pass == 0 {
                    emitter.xfer(needle, park);
                } else {
                    emitter.xfer(park, place(item.bed, item.slot + by));
                }
            }
        }
        for id in slice {
            self.change(id, |item| item.slot += by);
        }
    }

    /// Keeps a needle free after an item in course order, for the second loop of an increase.
    pub(super) fn open(&mut self, id: ItemId, emitter: &mut Emitter) -> Result<ItemId, Stuck> {
        let Item { bed, slot, .. } = self.item(id);
        let (left, right) = self.edges(bed);
        let along = if bed == Bed::Front { -1 } else { 1 };
        let index = (slot - left) as usize;
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

    /// Puts two neighbors in course order on one needle, which is the one that stays.
    pub(super) fn close(
        &mut self,
        first: ItemId,
        second: ItemId,
        emitter: &mut Emitter,
    ) -> Result<ItemId, Stuck> {
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
        let first_outer = (a.slot - b.slot) * self.outward > 0;
        let (outer, inner) = if first_outer { (first, second) } else { (second, first) };
        let slot = self.item(outer).slot;
        let (left, right) = self.edges(bed);
        let (from, to) = if self.outward < 0 { (left, slot) } else { (slot, right) };
        self.shift(bed, from, to, -self.outward, emitter);
        let outward = self.outward;
        let (row, row_left) = self.row_mut(bed);
        row.remove((slot - left) as usize);
        if outward < 0 {
            *row_left += 1;
        }
        self.grow(inner, self.item(outer).loops)?;
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
        self.grow(stays, self.item(moved).loops)?;
        self.roll(emitter)?;
        Ok(stays)
    }

    /// Brings the free edge back to where the beds differ by at most one slot.
    fn roll(&mut self, emitter: &mut Emitter) -> Result<(), Stuck> {
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
            let target = place(from.other(), slot);
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
        self.grow(onto, self.item(from).loops)
    }

    /// Moves the one loop of a bound-off needle onto a neighbor.
    pub(super) fn chain(&mut self, from: ItemId, onto: ItemId, emitter: &mut Emitter) -> Result<(), Stuck> {
        let (start, end) = (self.needle(from), self.needle(onto));
        if start.bed == end.bed {
            let park = Needle::on(start.bed.other(), start.index);
            emitter.xfer(start, park);
            emitter.xfer(park, end);
        } else {
            emitter.xfer(start, end);
        }
        self.grow(onto, 1)
    }
}

/// The needle of a slot.
fn place(bed: Bed, slot: i32) -> Needle {
    match bed {
        Bed::Front => Needle::front(2 * slot),
        Bed::Back => Needle::back(2 * slot - 1),
    }
}
