//! One walk over the rounds of a part, which finds for every stitch the loops that it works and makes.

use crate::ir::{Direction, Part, Start, Step, Stitch};
use smallvec::SmallVec;
use std::collections::VecDeque;

/// A loop of a part, numbered in the order in which the yarn makes them: the nodes of its graph where it has one.
pub(crate) type Loop = u32;

/// The stitches of a part, folded rounds unfolded, with their loops.
#[derive(Debug, Default)]
pub(crate) struct Trace {
    /// Loops before the first round.
    pub(crate) start: u32,
    /// Loops in all.
    pub(crate) loops: u32,
    /// The rounds in working order.
    pub(crate) rounds: Vec<Round>,
}

/// One round.
#[derive(Debug)]
pub(crate) struct Round {
    /// Its number.
    pub(crate) number: u32,
    /// The row of the part that it comes from.
    pub(crate) row: usize,
    /// A flat row that is worked against the direction of the first.
    pub(crate) reversed: bool,
    /// Loops that are ready when it begins, in working order.
    pub(crate) below: Vec<Loop>,
    /// How many of these, at the beginning, an earlier round left.
    pub(crate) left: usize,
    /// Loops that it leaves for the next one.
    pub(crate) unworked: usize,
    /// Loops that it makes: its stitch count.
    pub(crate) made: usize,
    /// Its stitches in working order.
    pub(crate) stitches: Vec<Worked>,
    /// Levels that its short rows pile up; 1 without any.
    pub(crate) levels: u32,
}

impl Round {
    /// Its stitches from turn to turn.
    pub(crate) fn passes(&self) -> impl Iterator<Item = &[Worked]> {
        self.stitches.chunk_by(|_, next| !next.turned)
    }
}

/// One stitch in its place.
#[derive(Debug)]
pub(crate) struct Worked {
    /// Its number among the steps of the part that have a tile.
    pub(crate) tile: u32,
    /// What is worked.
    pub(crate) stitch: Stitch,
    /// Against the direction of its round: on the way back in a short row.
    pub(crate) back: bool,
    /// The first of its pass behind a turn.
    pub(crate) turned: bool,
    /// How many stitches of this round lie under it.
    pub(crate) level: u32,
    /// Loops worked into, in working order.
    pub(crate) base: SmallVec<[Loop; 3]>,
    /// The first loop made.
    pub(crate) top: Loop,
    /// The color that begins here.
    pub(crate) color: Option<u16>,
}

impl Worked {
    /// The loops made, in working order.
    pub(crate) fn tops(&self) -> std::ops::Range<Loop> {
        self.top..self.top + Loop::from(self.stitch.makes)
    }
}

/// Follows the yarn through a part.
pub(crate) fn trace(part: &Part) -> Trace {
    let start = part.start.loops();
    let mut walk = Walk {
        ahead: (0..start).collect(),
        behind: Vec::new(),
        other_side: VecDeque::new(),
        levels: vec![None; start as usize],
        tile: 0,
        same: SmallVec::new(),
        color: None,
    };
    let mut trace = Trace { start, loops: start, rounds: Vec::new() };
    let mut left = 0;
    for (row, (number, body)) in part.numbered_rows().enumerate() {
        for done in 0..body.times {
            let reversed = part.flat && trace.rounds.len() % 2 == 1;
            let mut round = Round {
                number: number.saturating_add(done),
                row,
                reversed,
                below: walk.ahead.iter().copied().collect(),
                left,
                unworked: 0,
                made: 0,
                stitches: Vec::new(),
                levels: 1,
            };
            walk.round(&body.body, &mut round);
            (round.unworked, round.made) = (walk.ahead.len(), walk.behind.len());
            left = walk.next(part.flat);
            trace.rounds.push(round);
        }
    }
    trace.loops = walk.levels.len() as u32;
    trace
}

/// True when the first loops of the part are stitches themselves, in a magic ring.
pub(crate) fn rings(part: &Part) -> bool {
    matches!(part.start, Start::Ring { .. })
}

struct Walk {
    ahead: VecDeque<Loop>,
    behind: Vec<Loop>,
    /// Loops that flat rows left on the side where the next row ends.
    other_side: VecDeque<Loop>,
    /// Level of each loop within the round under way; `None` for loops of earlier rounds.
    levels: Vec<Option<u32>>,
    tile: u32,
    /// Loops that the stitch before was worked into.
    same: SmallVec<[Loop; 3]>,
    color: Option<u16>,
}

impl Walk {
    fn round(&mut self, body: &crate::ir::Block, round: &mut Round) {
        let first = self.levels.len();
        let (mut back, mut turned, mut level) = (false, false, 0);
        for step in body.steps() {
            match step {
                Step::Work(stitch) => {
                    let worked = self.work(stitch, back, std::mem::take(&mut turned), &mut level);
                    round.levels = round.levels.max(worked.level + 1);
                    round.stitches.push(worked);
                }
                Step::Turn(direction) => {
                    self.tile += 1;
                    (back, turned) = (direction == Direction::Back, true);
                }
                Step::Hold { loops, .. } => {
                    self.ahead.drain(..(loops as usize).min(self.ahead.len()));
                }
                Step::Leave { .. } => {}
                Step::Color(color) => self.color = Some(color),
            }
        }
        self.levels[first..].fill(None);
    }

    fn work(&mut self, stitch: Stitch, back: bool, turned: bool, level: &mut u32) -> Worked {
        if stitch.works > 0 {
            self.same.clear();
            for _ in 0..stitch.works {
                let base = if back { self.behind.pop() } else { self.ahead.pop_front() };
                self.same.extend(base);
            }
            let under =
                self.same.iter().filter_map(|base| self.levels.get(*base as usize).copied().flatten());
            *level = under.max().map_or(0, |under| under + 1);
        }
        let top = self.levels.len() as Loop;
        for _ in 0..stitch.makes {
            let made = self.levels.len() as Loop;
            self.levels.push(Some(*level));
            if back {
                self.ahead.push_front(made);
            } else {
                self.behind.push(made);
            }
        }
        let tile = self.tile;
        self.tile += 1;
        Worked {
            tile,
            stitch,
            back,
            turned,
            level: *level,
            base: self.same.clone(),
            top,
            color: self.color.take(),
        }
    }

    /// Goes on to the next round; tells how many loops an earlier one leaves it.
    fn next(&mut self, flat: bool) -> usize {
        let made = std::mem::take(&mut self.behind);
        self.same.clear();
        if flat {
            let rest = std::mem::take(&mut self.ahead);
            self.ahead = made.into_iter().rev().chain(self.other_side.drain(..)).collect();
            self.other_side = rest;
            0
        } else {
            let left = self.ahead.len();
            self.ahead.extend(made);
            left
        }
    }
}
