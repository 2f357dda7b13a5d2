//! A second, plainer walk over a machine program that only keeps which loops hang where.

use crate::ir::machine::{Bed, Code, Instruction, LoopId, Made, Needle, Needles};
use std::collections::{BTreeMap, BTreeSet};

/// Needles and their loops after some instruction.
pub(super) struct Replay<'a> {
    code: &'a Code,
    needles: &'a Needles,
    at: usize,
    held: BTreeMap<Needle, Vec<LoopId>>,
    next: LoopId,
}

impl<'a> Replay<'a> {
    pub(super) fn new(code: &'a Code, needles: &'a Needles) -> Self {
        Self { code, needles, at: 0, held: BTreeMap::new(), next: 0 }
    }

    /// The loops of this set that hang after an instruction, in order around the beds: over the front bed from right
    /// to left, then over the back bed. Of a stack the newest stitch counts.
    pub(super) fn around(&mut self, op: u32, set: &BTreeSet<LoopId>) -> Vec<LoopId> {
        self.advance(op as usize);
        let top = |(_, stack): (&Needle, &Vec<LoopId>)| {
            let stitch = |id: &&LoopId| {
                set.contains(id) && self.needles.get(**id).is_some_and(|found| found.made != Made::Wrap)
            };
            stack.iter().rfind(stitch).copied()
        };
        let front = self.held.iter().filter(|(needle, _)| needle.bed == Bed::Front).rev().filter_map(top);
        let back = self.held.iter().filter(|(needle, _)| needle.bed == Bed::Back).filter_map(top);
        front.chain(back).collect()
    }

    /// The stitch that the split at this place moves to the facing needle.
    pub(super) fn moved_by_split(&mut self, op: u32) -> Option<LoopId> {
        self.advance((op as usize).checked_sub(1)?);
        let Some(&Instruction::Split(_, from, _, _)) = self.code.ops().get(op as usize) else { return None };
        let stitch = |id: &&LoopId| self.needles.get(**id).is_some_and(|found| found.made != Made::Wrap);
        self.held.get(&from)?.iter().rfind(stitch).copied()
    }

    /// Goes on over the transfers that bring the loops of splits to their needles.
    pub(super) fn settle(&mut self, op: u32, moved: &BTreeSet<LoopId>) {
        self.advance(op as usize);
        while let Some(&instruction) = self.code.ops().get(self.at) {
            let holds =
                |from| self.held.get(&from).is_some_and(|stack| stack.iter().any(|id| moved.contains(id)));
            if !matches!(instruction, Instruction::Rack(_))
                && !matches!(instruction, Instruction::Xfer(from, _) if holds(from))
            {
                return;
            }
            self.advance(self.at);
        }
    }

    fn advance(&mut self, op: usize) {
        while self.at <= op
            && let Some(instruction) = self.code.ops().get(self.at)
        {
            match *instruction {
                Instruction::Knit(_, needle, carriers) => {
                    self.held.remove(&needle);
                    self.form(needle, carriers.len());
                }
                Instruction::Tuck(_, needle, carriers) => self.form(needle, carriers.len()),
                Instruction::Split(_, from, to, carriers) => {
                    self.transfer(from, to);
                    self.form(from, carriers.len());
                }
                Instruction::Xfer(from, to) => self.transfer(from, to),
                Instruction::Drop(needle) => {
                    self.held.remove(&needle);
                }
                Instruction::In(_)
                | Instruction::InHook(_)
                | Instruction::ReleaseHook(_)
                | Instruction::Out(_)
                | Instruction::OutHook(_)
                | Instruction::Stitch(..)
                | Instruction::Rack(_)
                | Instruction::Amiss(_)
                | Instruction::Miss(..)
                | Instruction::Pause(_)
                | Instruction::Extension(_) => {}
            }
            self.at += 1;
        }
    }

    fn form(&mut self, needle: Needle, loops: usize) {
        if loops > 0 {
            let next = self.next;
            self.held.entry(needle).or_default().extend(next..next + loops as LoopId);
            self.next += loops as LoopId;
        }
    }

    fn transfer(&mut self, from: Needle, to: Needle) {
        if let Some(moved) = self.held.remove(&from) {
            self.held.entry(to).or_default().extend(moved);
        }
    }
}
