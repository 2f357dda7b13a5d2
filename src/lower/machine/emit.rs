//! The pen of the lowering: writes instructions, racks when a transfer needs it, and remembers where each comes from.

use crate::ir::machine::{Bed, CarrierSet, Direction, Instruction, Needle, Rack};

/// The stitch for which an instruction was written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Origin {
    /// Place of the part in the pattern.
    pub part: u32,
    /// Round as the pattern numbers it; 0 for cast-on and waste.
    pub round: u32,
    /// Stitch of the round, from 1; 0 where none is meant.
    pub stitch: u32,
}

/// Instructions of one piece, on needles that are still to be placed on the bed.
#[derive(Debug, Default)]
pub(super) struct Emitter {
    pub(super) ops: Vec<Instruction>,
    pub(super) origins: Vec<Origin>,
    pub(super) origin: Origin,
    /// Comments, as place and text.
    pub(super) remarks: Vec<(u32, String)>,
    /// Extensions, as place and text.
    pub(super) extensions: Vec<(u32, String)>,
    rack: Rack,
    first: Option<i32>,
    last: i32,
}

impl Emitter {
    pub(super) fn push(&mut self, instruction: Instruction) {
        for needle in instruction.needles() {
            self.last = self.first.map_or(needle.index, |_| self.last.max(needle.index));
            self.first = Some(self.first.map_or(needle.index, |first| first.min(needle.index)));
        }
        self.ops.push(instruction);
        self.origins.push(self.origin);
    }

    pub(super) fn remark(&mut self, text: String) {
        self.remarks.push((self.ops.len() as u32, text));
    }

    pub(super) fn extension(&mut self, text: String) {
        self.extensions.push((self.ops.len() as u32, text));
    }

    /// First and last needle touched so far.
    pub(super) fn reach(&self) -> Option<(i32, i32)> {
        Some((self.first?, self.last))
    }

    fn rack(&mut self, needles: i32) {
        let rack = Rack::whole(needles);
        if self.rack != rack {
            self.rack = rack;
            self.push(Instruction::Rack(rack));
        }
    }

    /// Leaves the beds as they were found.
    pub(super) fn rest(&mut self) {
        self.rack(0);
    }

    pub(super) fn knit(&mut self, direction: Direction, needle: Needle, carriers: CarrierSet) {
        self.rack(0);
        self.push(Instruction::Knit(direction, needle, carriers));
    }

    pub(super) fn tuck(&mut self, direction: Direction, needle: Needle, carriers: CarrierSet) {
        self.rack(0);
        self.push(Instruction::Tuck(direction, needle, carriers));
    }

    /// Knits a needle while its loops move to the facing one.
    pub(super) fn split(&mut self, direction: Direction, from: Needle, to: Needle, carriers: CarrierSet) {
        self.rack(0);
        self.push(Instruction::Split(direction, from, to, carriers));
    }

    /// Transfers to a needle of the other bed, racked as that takes.
    pub(super) fn xfer(&mut self, from: Needle, to: Needle) {
        self.rack(match from.bed {
            Bed::Front => from.index - to.index,
            Bed::Back => to.index - from.index,
        });
        self.push(Instruction::Xfer(from, to));
    }
}
