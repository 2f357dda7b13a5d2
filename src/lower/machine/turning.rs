//! Tubes that turn on the beds, come apart and grow together: what limbs need.
//!
//! Loops that another limb will need are set aside at the edge far from the yarn, as a tube of their own that waits on
//! its needles. For that the tube is turned in place until the loops lie around that edge: at both edges the last loop
//! goes over to the other bed, and the beds move by one slot against each other to make room.

use super::emit::Emitter;
use super::tube::{ItemId, Stuck, Tube};
use crate::ir::machine::{Bed, CarrierSet};
use std::collections::VecDeque;

impl Tube {
    /// Slots from the leftmost to the rightmost.
    pub(super) fn extent(&self) -> (i32, i32) {
        let (front, back) = (self.edges(Bed::Front), self.edges(Bed::Back));
        match (self.front.is_empty(), self.back.is_empty()) {
            (false, true) => front,
            (true, false) => back,
            _ => (front.0.min(back.0), front.1.max(back.1)),
        }
    }

    /// All items in course order, from the edge on this side.
    pub(super) fn circle(&self, from_right: bool) -> Vec<ItemId> {
        let (front, back) = (self.front.iter().rev(), self.back.iter());
        if from_right { front.chain(back).copied().collect() } else { back.chain(front).copied().collect() }
    }

    /// Where an item lies in course order, counted from the edge on this side.
    fn place_in_course(&self, id: ItemId, from_right: bool) -> usize {
        self.circle(from_right).iter().position(|&other| other == id).unwrap_or(0)
    }

    /// Moves the whole piece sideways, as far at once as the machine may.
    pub(super) fn move_by(&mut self, slots: i32, emitter: &mut Emitter) {
        // Both beds in step, or the yarn that runs from one to the other is stretched.
        let mut left = slots;
        while left != 0 {
            let by = left.clamp(-self.bounds.stride, self.bounds.stride);
            self.move_bed(Bed::Front, by, emitter);
            self.move_bed(Bed::Back, by, emitter);
            left -= by;
        }
    }

    fn move_bed(&mut self, bed: Bed, slots: i32, emitter: &mut Emitter) {
        let mut left = slots;
        while left != 0 && !self.row(bed).0.is_empty() {
            let by = left.clamp(-self.bounds.stride, self.bounds.stride);
            let (from, to) = self.edges(bed);
            self.shift(bed, from, to, by, emitter);
            *self.row_mut(bed).1 += by;
            left -= by;
        }
    }

    /// Takes the outermost item of a bed over to the outer end of the other one.
    fn over(&mut self, from: Bed, at_left: bool, emitter: &mut Emitter) -> Result<(), Stuck> {
        if self.row(from).0.len() < 2 {
            return Err(Stuck::Narrow);
        }
        let to = from.other();
        let slot = if at_left { self.edges(to).0 - 1 } else { self.edges(to).1 + 1 };
        let (row, left) = self.row_mut(from);
        let id = if at_left {
            *left += 1;
            row.pop_front()
        } else {
            row.pop_back()
        };
        let id = id.ok_or(Stuck::Narrow)?;
        let before = self.needle(id);
        let ghost = self.item(id).ghost;
        self.change(id, |item| {
            item.bed = to;
            item.slot = slot;
        });
        if !ghost {
            emitter.xfer(before, self.needle(id));
        }
        let (row, left) = self.row_mut(to);
        if at_left {
            row.push_front(id);
            *left -= 1;
        } else {
            row.push_back(id);
        }
        Ok(())
    }

    /// Turns the tube in place: every loop goes `by` places on along the course, back for a negative number. One slot
    /// beyond the free edge must be empty.
    pub(super) fn turn(&mut self, by: i32, emitter: &mut Emitter) -> Result<(), Stuck> {
        let (slack, onward) = (self.outward, by > 0);
        // The bed that first makes room moves towards the free edge; then each edge gives a loop to the other bed.
        let first = if (slack > 0) == onward { Bed::Back } else { Bed::Front };
        let (left_from, right_from) = if onward { (Bed::Front, Bed::Back) } else { (Bed::Back, Bed::Front) };
        if by != 0 {
            self.movable()?;
        }
        for _ in 0..by.abs() {
            self.move_bed(first, slack, emitter);
            self.over(left_from, true, emitter)?;
            self.over(right_from, false, emitter)?;
            self.move_bed(first.other(), -slack, emitter);
        }
        Ok(())
    }

    /// Turns the tube until the loop that is worked next is the first of the course from the edge on this side.
    pub(super) fn begin_at(&mut self, right: bool, emitter: &mut Emitter) -> Result<(), Stuck> {
        let Some(&first) = self.ahead.front() else { return Err(Stuck::Underflow) };
        let at = self.place_in_course(first, right) as i32;
        self.turn(shorter(-at, self.items_on_needles()), emitter)
    }

    fn items_on_needles(&self) -> i32 {
        (self.front.len() + self.back.len()) as i32
    }

    /// Sets the next loops aside as a tube of their own, at the edge away from the yarn.
    pub(super) fn set_aside(
        &mut self,
        loops: u32,
        at_left: bool,
        emitter: &mut Emitter,
    ) -> Result<Self, Stuck> {
        if loops < 2 {
            return Err(Stuck::Narrow);
        }
        if self.ahead.len() < loops as usize {
            return Err(Stuck::Underflow);
        }
        // An odd loop goes where both parts keep their edges level.
        let ((front_left, front_right), (back_left, back_right)) =
            (self.edges(Bed::Front), self.edges(Bed::Back));
        let odd = (loops % 2) as i32;
        let half = loops as i32 / 2;
        let (on_front, on_back) = match (at_left, back_left - front_left, back_right - front_right) {
            (true, 0, _) | (false, _, 1) => (half, half + odd),
            _ => (half + odd, half),
        };
        if on_front >= self.front.len() as i32 || on_back >= self.back.len() as i32 {
            return Err(Stuck::Narrow);
        }
        let Some(&first) = self.ahead.front() else { return Err(Stuck::Underflow) };
        // Course order from the edge opposite to where the loops will lie.
        let now = self.place_in_course(first, at_left) as i32;
        let target =
            if at_left { self.front.len() as i32 - on_front } else { self.back.len() as i32 - on_back };
        self.outward = if at_left { 1 } else { -1 };
        self.turn(shorter(target - now, self.items_on_needles()), emitter)?;
        let mut aside = Self::empty(self.bounds, CarrierSet::default(), -self.outward);
        let arc: Vec<ItemId> = self.ahead.drain(..loops as usize).collect();
        for bed in [Bed::Front, Bed::Back] {
            let count = if bed == Bed::Front { on_front } else { on_back } as usize;
            let (row, left) = self.row_mut(bed);
            let (taken, from) = if at_left {
                let kept = row.split_off(count);
                let from = *left;
                *left += count as i32;
                (std::mem::replace(row, kept), from)
            } else {
                let at = row.len() - count;
                (row.split_off(at), *left + at as i32)
            };
            if taken.iter().any(|id| !arc.contains(id)) {
                return Err(Stuck::Underflow);
            }
            let (row, left) = aside.row_mut(bed);
            *row = taken;
            *left = from;
        }
        aside.items.clone_from(&self.items);
        aside.ahead = arc.into();
        Ok(aside)
    }

    /// Puts empty needles for `count` new loops between two neighbors in course order, `after` and the one behind it,
    /// at the edge on this side; returns them in course order.
    pub(super) fn reserve_at_edge(&mut self, count: u32, right: bool) -> Vec<ItemId> {
        // The course comes to the right edge on the back bed and leaves it on the front bed; at the left one it is
        // the other way round. Shared out so that the edge stays level.
        let (mut coming, mut leaving) = (VecDeque::new(), VecDeque::new());
        for _ in 0..count {
            let ((front_left, front_right), (back_left, back_right)) =
                (self.edges(Bed::Front), self.edges(Bed::Back));
            let bed = match (right, back_right - front_right, back_left - front_left) {
                (true, 1.., _) | (false, _, ..=0) => Bed::Front,
                _ => Bed::Back,
            };
            let slot = match (right, bed) {
                (true, Bed::Front) => front_right + 1,
                (true, Bed::Back) => back_right + 1,
                (false, Bed::Front) => front_left - 1,
                (false, Bed::Back) => back_left - 1,
            };
            let id = self.add(bed, slot, true);
            let (row, left) = self.row_mut(bed);
            if right {
                row.push_back(id);
            } else {
                row.push_front(id);
                *left -= 1;
            }
            // The first one out on a bed is the first that the course meets there, or the last.
            if (bed == Bed::Back) == right { coming.push_back(id) } else { leaving.push_front(id) }
        }
        coming.into_iter().chain(leaving).collect()
    }

    /// Grows together with the tube on its right. `new` are the loops to be made between them: after this tube's own
    /// loops, and after the other's. Returns the needles of both kinds of new loops, in course order, and between them
    /// the other tube's loops, all as items of this one.
    pub(super) fn unite(
        &mut self,
        mut other: Self,
        new: [u32; 2],
        emitter: &mut Emitter,
    ) -> Result<[Vec<ItemId>; 3], Stuck> {
        self.movable()?;
        self.begin_at(true, emitter)?;
        other.begin_at(false, emitter)?;
        // From this tube to the other the course runs on the back bed, and it returns on the front bed.
        let gap = |tube: &Self, other: &Self, bed: Bed, new: u32| {
            other.edges(bed).0 - tube.edges(bed).1 - 1 - new as i32
        };
        let (back, front) = (gap(self, &other, Bed::Back, new[0]), gap(self, &other, Bed::Front, new[1]));
        let both = if back.abs() < front.abs() { back } else { front };
        other.move_by(-both, emitter);
        other.move_bed(Bed::Back, both - back, emitter);
        other.move_bed(Bed::Front, both - front, emitter);
        let offset = self.items.len() as ItemId;
        let loops = other.ahead.iter().map(|id| id + offset).collect();
        self.items.append(&mut other.items);
        let own = self.extend(Bed::Back, new[0], &other.back, offset);
        let mut others = self.extend(Bed::Front, new[1], &other.front, offset);
        others.reverse();
        self.outward = 1;
        self.roll(emitter)?;
        Ok([own, loops, others])
    }

    /// Lengthens a bed to the right by empty needles and the items of another tube; returns the empty ones.
    fn extend(&mut self, bed: Bed, new: u32, row: &VecDeque<ItemId>, offset: ItemId) -> Vec<ItemId> {
        let mut ghosts = Vec::new();
        for _ in 0..new {
            let slot = self.edges(bed).1 + 1;
            let id = self.add(bed, slot, true);
            self.row_mut(bed).0.push_back(id);
            ghosts.push(id);
        }
        self.row_mut(bed).0.extend(row.iter().map(|id| id + offset));
        ghosts
    }
}

/// The shorter way round a circle of this many places.
fn shorter(by: i32, around: i32) -> i32 {
    let by = by.rem_euclid(around.max(1));
    if 2 * by > around { by - around } else { by }
}
