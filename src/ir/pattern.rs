//! What the hook does: parts, rows and folded operations, and their one meaning, the sequence of steps.

use super::Stitch;
use crate::diag::Span;
use smallvec::{SmallVec, smallvec};

/// Index of a part in [`Pattern::parts`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PartId(pub u32);

/// The parts of an object in working order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pattern {
    /// The parts; a part is picked up only from an earlier one.
    pub parts: Vec<Part>,
}

/// One part, worked in one go.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Name, unique in the pattern.
    pub name: String,
    /// How it begins.
    pub start: Start,
    /// Its rows in order.
    pub rows: Vec<Row>,
    /// How it ends.
    pub finish: Finish,
    /// Worked in rows that turn, not in rounds.
    pub flat: bool,
    /// How many equal copies are made; at least 1.
    pub copies: u32,
}

impl Part {
    /// Number of the first row in [`Part::rows`]: the stitches of a magic ring are round 1, so its rows begin with 2.
    pub fn first_number(&self) -> u32 {
        match self.start {
            Start::Ring { loops: 1.. } => 2,
            Start::Ring { loops: 0 } | Start::Chain { .. } | Start::Join { .. } => 1,
        }
    }
    /// Each row with the number of its first round; a folded row counts `times`.
    pub fn numbered_rows(&self) -> impl Iterator<Item = (u32, &Row)> {
        self.rows.iter().scan(self.first_number(), |next, row| {
            let number = *next;
            *next = next.saturating_add(row.times);
            Some((number, row))
        })
    }
}

/// How a part begins.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Start {
    /// A magic ring with single crochets in it.
    Ring {
        /// Stitches worked into the ring, which is round 1. 0 for a ring that other stitches than plain single
        /// crochets go into: row 1 then lists them, each working no loop.
        loops: u32,
    },
    /// A chain.
    Chain {
        /// Chains that are worked into; 0 where the stitches of row 1 bring their own chain.
        loops: u32,
        /// Joined to a ring, for work in the round.
        joined: bool,
    },
    /// Loops that other parts left, and chains between them, in working order.
    Join {
        /// Where the loops come from.
        segments: Vec<Segment>,
    },
}

/// A stretch of the loops that a joined part starts from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Segment {
    /// All open loops at the end of a part (or of one of its copies).
    Open {
        /// The part.
        part: PartId,
        /// Loops it leaves.
        loops: u32,
    },
    /// Loops that an [`Op::Hold`] of the part set aside for this one.
    Held {
        /// The part.
        part: PartId,
        /// Loops taken.
        loops: u32,
    },
    /// Loops picked up around stitches of a finished part, which stay as they are (the paper's interlocking).
    Surface {
        /// The part.
        part: PartId,
        /// Number of the round whose stitches are worked around.
        round: u32,
        /// First stitch of that round, from 1; the least of them whatever the direction.
        first: u32,
        /// Loops picked up.
        loops: u32,
        /// Picked up against the direction of the round: the last stitch first.
        back: bool,
    },
    /// Chains.
    Chain {
        /// How many.
        loops: u32,
    },
}

impl Segment {
    /// The part that the loops come from; none for chains.
    pub fn part(self) -> Option<PartId> {
        match self {
            Self::Open { part, .. } | Self::Held { part, .. } | Self::Surface { part, .. } => Some(part),
            Self::Chain { .. } => None,
        }
    }

    /// Loops of this stretch.
    pub fn loops(self) -> u32 {
        match self {
            Self::Open { loops, .. }
            | Self::Held { loops, .. }
            | Self::Surface { loops, .. }
            | Self::Chain { loops } => loops,
        }
    }
}

impl Start {
    /// Open loops before the first row.
    pub fn loops(&self) -> u32 {
        match self {
            Self::Ring { loops } | Self::Chain { loops, .. } => *loops,
            Self::Join { segments } => {
                segments.iter().fold(0, |sum, segment| sum.saturating_add(segment.loops()))
            }
        }
    }
}

/// How a part ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Finish {
    /// The last round stays open: slip stitch to level, fasten off.
    #[default]
    Open,
    /// The yarn is drawn through the last loops and pulled tight.
    DrawnShut,
}

/// One row, or several equal ones in a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What is worked.
    pub body: Block,
    /// How many equal rows this stands for (`Rnds 7-12` is 6); at least 1.
    pub times: u32,
    /// The count that a person wrote, with its place.
    pub stated: Option<(u32, Span)>,
    /// Where the row stands in the text.
    pub span: Span,
}

impl Row {
    /// A row that no one wrote.
    pub fn new(body: Block) -> Self {
        Self { body, times: 1, stated: None, span: Span::NONE }
    }
}

/// Operations with their places beside them, so that equality and passes never trip over spans.
#[derive(Clone, Debug, Default)]
pub struct Block {
    // Most rows of written and of generated patterns take no more.
    ops: SmallVec<[Op; 3]>,
    spans: SmallVec<[Span; 3]>,
}

impl PartialEq for Block {
    fn eq(&self, other: &Self) -> bool {
        self.ops == other.ops
    }
}

impl FromIterator<Op> for Block {
    fn from_iter<I: IntoIterator<Item = Op>>(ops: I) -> Self {
        let mut block = Self::default();
        ops.into_iter().for_each(|op| block.push(op, Span::NONE));
        block
    }
}

/// One operation, folded or not.
#[derive(Clone, Debug, PartialEq)]
pub enum Op {
    /// A run of equal stitches.
    Work {
        /// The stitch.
        stitch: Stitch,
        /// How often; at least 1.
        times: u32,
    },
    /// A repeated sequence.
    Repeat {
        /// What is repeated; not empty. Boxed, so that a run takes little room.
        body: Box<Block>,
        /// How often; at least 1.
        times: u32,
    },
    /// A change of direction.
    Turn(Direction),
    /// Loops next to be worked are set aside for another part.
    Hold {
        /// How many.
        loops: u32,
        /// The part that picks them up.
        by: PartId,
    },
    /// Loops next to be worked stay unworked; the row ends here.
    Leave {
        /// How many.
        loops: u32,
    },
    /// The yarn changes to this color of [`super::Program::colors`].
    Color(u16),
}

impl Op {
    /// A repeated sequence.
    pub fn repeat(body: Block, times: u32) -> Self {
        Self::Repeat { body: Box::new(body), times }
    }
}

/// The direction of work after a turn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Direction {
    /// The helix's own direction.
    #[default]
    Forward,
    /// Back over the loops just made.
    Back,
}

/// One unfolded operation: the meaning of a pattern is its sequence of steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// One stitch.
    Work(Stitch),
    /// A change of direction.
    Turn(Direction),
    /// Loops are set aside for another part.
    Hold {
        /// How many.
        loops: u32,
        /// The part that picks them up.
        by: PartId,
    },
    /// Loops stay unworked.
    Leave {
        /// How many.
        loops: u32,
    },
    /// The yarn changes.
    Color(u16),
}

impl Block {
    /// The operations.
    pub fn ops(&self) -> &[Op] {
        &self.ops
    }
    /// The operations with their places.
    pub fn spanned(&self) -> impl Iterator<Item = (&Op, Span)> {
        self.ops.iter().zip(self.spans.iter().copied())
    }
    /// Adds an operation.
    pub fn push(&mut self, op: Op, span: Span) {
        self.ops.push(op);
        self.spans.push(span);
    }
    /// Takes the operations from `at` on out of the block.
    #[must_use]
    pub fn split_off(&mut self, at: usize) -> Self {
        if at == 0 {
            return std::mem::take(self);
        }
        if at >= self.ops.len() {
            return Self::default();
        }
        Self { ops: self.ops.drain(at..).collect(), spans: self.spans.drain(at..).collect() }
    }
    /// Adds all operations of another block.
    pub fn append(&mut self, mut other: Self) {
        if self.is_empty() {
            *self = other;
            return;
        }
        self.ops.append(&mut other.ops);
        self.spans.append(&mut other.spans);
    }
    /// True when nothing is worked.
    pub fn is_empty(&self) -> bool {
        self.ops.is_empty()
    }
    /// The meaning: every step in order, lazily.
    pub fn steps(&self) -> Steps<'_> {
        Steps { stack: smallvec![Frame { ops: &self.ops, next: 0, done: 0, times: 1 }] }
    }
    /// Number of steps without walking them; `None` on overflow.
    pub fn step_count(&self) -> Option<u64> {
        self.ops.iter().try_fold(0_u64, |sum, op| {
            sum.checked_add(match op {
                Op::Work { times, .. } => u64::from(*times),
                Op::Repeat { body, times } => body.step_count()?.checked_mul(u64::from(*times))?,
                Op::Turn(_) | Op::Hold { .. } | Op::Leave { .. } | Op::Color(_) => 1,
            })
        })
    }
}

/// Iterator over the steps of a block.
#[derive(Clone, Debug)]
pub struct Steps<'b> {
    stack: SmallVec<[Frame<'b>; 2]>,
}

#[derive(Clone, Debug)]
struct Frame<'b> {
    ops: &'b [Op],
    next: usize,
    /// Repetitions finished of the operation at `next` (a run), or of this whole frame.
    done: u32,
    times: u32,
}

impl Iterator for Steps<'_> {
    type Item = Step;

    fn next(&mut self) -> Option<Step> {
        loop {
            let frame = self.stack.last_mut()?;
            let Some(op) = frame.ops.get(frame.next) else {
                frame.times -= 1;
                if frame.times > 0 && !frame.ops.is_empty() {
                    frame.next = 0;
                } else {
                    self.stack.pop();
                }
                continue;
            };
            match op {
                Op::Work { stitch, times } => {
                    if frame.done < *times {
                        frame.done += 1;
                        return Some(Step::Work(*stitch));
                    }
                    frame.done = 0;
                    frame.next += 1;
                }
                Op::Turn(direction) => {
                    frame.next += 1;
                    return Some(Step::Turn(*direction));
                }
                Op::Hold { loops, by } => {
                    frame.next += 1;
                    return Some(Step::Hold { loops: *loops, by: *by });
                }
                Op::Leave { loops } => {
                    frame.next += 1;
                    return Some(Step::Leave { loops: *loops });
                }
                Op::Color(color) => {
                    frame.next += 1;
                    return Some(Step::Color(*color));
                }
                Op::Repeat { body, times } => {
                    frame.next += 1;
                    if *times > 0 {
                        let frame = Frame { ops: &body.ops, next: 0, done: 0, times: *times };
                        self.stack.push(frame);
                    }
                }
            }
        }
    }
}
