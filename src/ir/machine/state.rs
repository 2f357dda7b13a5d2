//! Loops on needles: where each loop hangs, which yarn it is of, and which loop was pulled through it.

use super::{Bed, CarrierId, Instruction, MAX_NEEDLE, Needle, Rack};

/// A loop, as its place in the order of making.
pub type LoopId = u32;
/// No loop.
pub const NONE: LoopId = u32::MAX;

/// How a loop was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Made {
    /// Pulled through the loops of its needle, or formed on an empty needle by a knit.
    Knit,
    /// Laid on an empty needle.
    Tuck,
    /// Laid on a needle that held loops already.
    Wrap,
    /// Made by a split.
    Split,
}

/// One loop.
#[derive(Clone, Copy, Debug)]
pub struct Loop {
    /// The instruction that made it.
    pub op: u32,
    /// Its yarn.
    pub carrier: CarrierId,
    /// How it was made.
    pub made: Made,
    /// The first loop that was pulled through it; [`NONE`] while it hangs and after it was dropped.
    pub into: LoopId,
    /// The loop that the same yarn made before.
    pub before: LoopId,
    /// The loop that the same yarn made after.
    pub after: LoopId,
    cell: u32,
    below: LoopId,
    crossing: bool,
}

const NOWHERE: u32 = u32::MAX;

#[derive(Clone, Copy, Debug)]
struct Cell {
    top: LoopId,
    count: u32,
}

/// The needles with the loops on them, and every loop that was ever made.
#[derive(Debug)]
pub struct Needles {
    first: i32,
    width: i32,
    cells: Vec<Cell>,
    pub(super) loops: Vec<Loop>,
    crossing: Vec<LoopId>,
}

impl Needles {
    /// Empty needles for a program. Only the needles that it names exist, so memory follows from its own reach.
    pub(super) fn for_program(ops: &[Instruction]) -> Self {
        let (mut first, mut last) = (i32::MAX, i32::MIN);
        for needle in ops.iter().flat_map(Instruction::needles) {
            first = first.min(needle.index);
            last = last.max(needle.index);
        }
        let first = first.clamp(-MAX_NEEDLE, MAX_NEEDLE);
        let width = (last.clamp(-MAX_NEEDLE, MAX_NEEDLE) - first + 1).max(0);
        let empty = Cell { top: NONE, count: 0 };
        Self { first, width, cells: vec![empty; width as usize * 4], loops: Vec::new(), crossing: Vec::new() }
    }

    fn cell(&self, needle: Needle) -> Option<usize> {
        let offset = needle.index.checked_sub(self.first)?;
        let row = match (needle.bed, needle.slider) {
            (Bed::Front, false) => 0,
            (Bed::Back, false) => 1,
            (Bed::Front, true) => 2,
            (Bed::Back, true) => 3,
        };
        (0..self.width).contains(&offset).then(|| (row * self.width + offset) as usize)
    }

    fn needle_of(&self, cell: u32) -> Needle {
        let (row, offset) = (cell as i32 / self.width, cell as i32 % self.width);
        let bed = if row % 2 == 0 { Bed::Front } else { Bed::Back };
        Needle { bed, slider: row >= 2, index: self.first + offset }
    }

    /// Loops on a needle.
    pub fn count(&self, needle: Needle) -> u32 {
        self.cell(needle).and_then(|cell| self.cells.get(cell)).map_or(0, |cell| cell.count)
    }

    /// The loops on a needle, newest first.
    pub fn stack(&self, needle: Needle) -> impl Iterator<Item = LoopId> + '_ {
        let top = self.cell(needle).and_then(|cell| self.cells.get(cell)).map_or(NONE, |cell| cell.top);
        std::iter::successors(self.get(top).map(|_| top), |&id| {
            self.get(id).map(|found| found.below).filter(|&below| below != NONE)
        })
    }

    /// A loop.
    pub fn get(&self, id: LoopId) -> Option<&Loop> {
        self.loops.get(id as usize)
    }

    /// All loops in the order of making.
    pub fn loops(&self) -> &[Loop] {
        &self.loops
    }

    /// The needle on which a loop hangs.
    pub fn needle(&self, id: LoopId) -> Option<Needle> {
        let found = self.get(id)?;
        (found.cell != NOWHERE).then(|| self.needle_of(found.cell))
    }

    /// Needles that hold loops, front bed first, with how many.
    pub fn held(&self) -> impl Iterator<Item = (Needle, u32)> + '_ {
        self.cells
            .iter()
            .enumerate()
            .filter(|(_, cell)| cell.count > 0)
            .map(|(index, cell)| (self.needle_of(index as u32), cell.count))
    }

    /// Makes a loop on a needle; the needle must be one of the program's.
    pub(super) fn make(
        &mut self,
        needle: Needle,
        op: u32,
        carrier: CarrierId,
        made: Made,
        before: LoopId,
    ) -> Option<LoopId> {
        let index = self.cell(needle)?;
        let id = self.loops.len() as LoopId;
        let cell = self.cells.get_mut(index)?;
        let below = cell.top;
        *cell = Cell { top: id, count: cell.count + 1 };
        if let Some(previous) = self.loops.get_mut(before as usize) {
            previous.after = id;
        }
        self.loops.push(Loop {
            op,
            carrier,
            made,
            into: NONE,
            before,
            after: NONE,
            cell: index as u32,
            below,
            crossing: false,
        });
        self.note_crossing(before, id);
        Some(id)
    }

    /// Takes all loops off a needle; `through` is the loop pulled through them. Returns how many there were.
    pub(super) fn take(&mut self, needle: Needle, through: LoopId) -> u32 {
        let Some(cell) = self.cell(needle).and_then(|cell| self.cells.get_mut(cell)) else { return 0 };
        let (mut id, count) = (cell.top, cell.count);
        *cell = Cell { top: NONE, count: 0 };
        while let Some(found) = self.loops.get_mut(id as usize) {
            found.cell = NOWHERE;
            found.into = through;
            id = std::mem::replace(&mut found.below, NONE);
        }
        count
    }

    /// Moves all loops of a needle on top of those of another. Returns how many moved.
    pub(super) fn transfer(&mut self, from: Needle, to: Needle) -> u32 {
        let (Some(source), Some(target)) = (self.cell(from), self.cell(to)) else { return 0 };
        if source == target {
            return 0;
        }
        let Some(cell) = self.cells.get_mut(source) else { return 0 };
        let (top, count) = (cell.top, cell.count);
        *cell = Cell { top: NONE, count: 0 };
        if count == 0 {
            return 0;
        }
        let under = self.cells.get(target).map_or(NONE, |cell| cell.top);
        let mut id = top;
        while let Some(found) = self.loops.get_mut(id as usize) {
            found.cell = target as u32;
            let (below, before, after) = (found.below, found.before, found.after);
            if below == NONE {
                found.below = under;
            }
            self.note_crossing(before, id);
            self.note_crossing(id, after);
            id = below;
        }
        if let Some(cell) = self.cells.get_mut(target) {
            cell.top = top;
            cell.count += count;
        }
        count
    }

    /// Remembers the link of two neighboring loops when it runs from bed to bed, so that racking finds it at once.
    fn note_crossing(&mut self, earlier: LoopId, later: LoopId) {
        let (Some(a), Some(b)) = (self.needle(earlier), self.needle(later)) else { return };
        if a.bed != b.bed
            && let Some(found) = self.loops.get_mut(later as usize)
            && !found.crossing
        {
            found.crossing = true;
            self.crossing.push(later);
        }
    }

    /// The distance of a hanging loop from the one before it, in quarter needles, while that hangs too.
    pub(super) fn link(&self, later: LoopId, rack: Rack) -> Option<i32> {
        let a = self.needle(self.get(later)?.before)?;
        let b = self.needle(later)?;
        Some((a.place(rack) - b.place(rack)).abs())
    }

    /// Calls `seen` with the distance of every link from bed to bed, in quarter needles.
    pub(super) fn each_crossing(&mut self, rack: Rack, mut seen: impl FnMut(LoopId, i32)) {
        let mut crossing = std::mem::take(&mut self.crossing);
        crossing.retain(|&later| {
            let ends =
                self.get(later).and_then(|found| Some((self.needle(found.before)?, self.needle(later)?)));
            if let Some((a, b)) = ends
                && a.bed != b.bed
            {
                seen(later, (a.place(rack) - b.place(rack)).abs());
                return true;
            }
            if let Some(found) = self.loops.get_mut(later as usize) {
                found.crossing = false;
            }
            false
        });
        self.crossing = crossing;
    }
}
