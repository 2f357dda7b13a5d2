//! Carriage passes: which instructions one run of the carriage can do together.

use super::{Bed, CarrierSet, Direction, Instruction, Needle, Rack};

/// What a pass does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Job {
    /// Loops are made, or carriers moved, in this direction with these carriers.
    Form(Direction, CarrierSet),
    /// Loops go over from this bed.
    Transfer(Bed),
    /// Loops are dropped.
    Drop,
}

/// What an instruction that a pass can do does there, and its needle.
pub fn job(instruction: &Instruction) -> Option<(Job, Needle)> {
    let none = CarrierSet::default();
    Some(match *instruction {
        Instruction::Knit(_, needle, carriers) if carriers.is_empty() => (Job::Drop, needle),
        Instruction::Split(_, from, _, carriers) if carriers.is_empty() => (Job::Transfer(from.bed), from),
        Instruction::Knit(direction, needle, carriers)
        | Instruction::Tuck(direction, needle, carriers)
        | Instruction::Miss(direction, needle, carriers)
        | Instruction::Split(direction, needle, _, carriers) => (Job::Form(direction, carriers), needle),
        Instruction::Xfer(from, _) => (Job::Transfer(from.bed), from),
        Instruction::Drop(needle) => (Job::Drop, needle),
        Instruction::Amiss(needle) => (Job::Form(Direction::Plus, none), needle),
        Instruction::In(_)
        | Instruction::InHook(_)
        | Instruction::ReleaseHook(_)
        | Instruction::Out(_)
        | Instruction::OutHook(_)
        | Instruction::Stitch(..)
        | Instruction::Rack(_)
        | Instruction::Pause(_)
        | Instruction::Extension(_) => return None,
    })
}

/// Merges instructions into passes: same job and rack, needles in monotone order and none twice.
#[derive(Debug, Default)]
pub struct Passes {
    current: Option<(Job, Rack)>,
    last: i32,
    trend: Option<Direction>,
    /// Passes so far.
    pub count: u64,
}

impl Passes {
    /// Takes the next instruction; true when it opens a new pass.
    pub fn add(&mut self, instruction: &Instruction, rack: Rack) -> bool {
        let Some((job, needle)) = job(instruction) else {
            self.current = None;
            return false;
        };
        self.place(job, needle, rack)
    }

    fn place(&mut self, job: Job, needle: Needle, rack: Rack) -> bool {
        let place = needle.place(rack);
        let along = if place > self.last { Direction::Plus } else { Direction::Minus };
        let fits = self.current == Some((job, rack))
            && place != self.last
            && match job {
                Job::Form(direction, _) => along == direction,
                Job::Transfer(_) | Job::Drop => self.trend.is_none_or(|trend| trend == along),
            };
        self.trend = fits.then_some(along);
        self.last = place;
        self.current = Some((job, rack));
        self.count += u64::from(!fits);
        !fits
    }
}
