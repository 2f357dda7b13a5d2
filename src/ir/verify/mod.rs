//! The verifier: the rules that every emitted pattern keeps, as prose first, then as code.
//!
//! It simulates the open loops and shares no code with what makes patterns, so that a fault there cannot hide here.
//!
//! **Sizes.** Repeats nest at most [`super::MAX_NESTING`] deep, a row has at most [`super::MAX_ROW`] loops, a pattern at
//! most [`super::MAX_LOOPS`] stitches and [`MAX_ROUNDS`] rounds. The counts are multiplied out with checked arithmetic before anything
//! is walked. A run, a repeat, a row and a part are worked at least once; a repeat and a row are not empty.
//!
//! **Rows.** A part's first row is worked into the loops of its start, every other into the loops of the row before.
//! - At the start of a row no loop lies behind the hook, and all loops below lie ahead.
//! - A stitch forward takes loops ahead and leaves loops behind; a stitch back takes the newest loops behind and leaves
//!   its own ahead. No stitch runs out of loops; so a back pass is never longer than what lies behind.
//! - Turns alternate, a back pass has a stitch, and a row ends facing forward.
//! - No stitch works loops on both sides of a turn together: an error in a program with graphs, a warning in a written one.
//! - A round ends when no loop is ahead. Otherwise its last operation says so: `Leave`, with the number that is left;
//!   the next round begins with these. A back pass over more than 0.6 of the round is a warning.
//! - In a flat part the work turns between rows. A row works at least the loops that the row before made (or leaves
//!   some), and may go on over loops that an earlier row left on that side.
//! - A stated count is the number of loops that the row makes.
//!
//! **Parts.** A part refers to earlier parts only. All open loops of a part are used at most once, all held loops exactly
//! once and by the part they are held for. Stitches picked up on a surface exist.
//!
//! **Graph.** Where there are graphs there is one a part. The k-th working step or turn has the k-th tile: the same
//! stitch, the loops it works as base, the loops it makes as top. Nodes stand in the order in which they are made,
//! none is missing or left over, and their coordinates are finite.

mod facts;
mod graph;
mod parts;
mod rows;
mod sizes;

pub use facts::{Facts, PartFacts, RowFacts};

use super::Program;
use crate::diag::Sink;
use std::ops::Deref;

/// Most rounds of a pattern.
pub const MAX_ROUNDS: u32 = 1_000_000;

/// A program that can be worked. Only [`verify`] makes one, and only through it backends get a program.
#[derive(Debug)]
pub struct Verified<'p> {
    program: &'p Program,
    facts: Facts,
}

impl Verified<'_> {
    /// What the verifier counted on its way.
    pub fn facts(&self) -> &Facts {
        &self.facts
    }
}

impl Deref for Verified<'_> {
    type Target = Program;
    fn deref(&self) -> &Program {
        self.program
    }
}

/// Checks a program against the rules; faults go to the sink, and none makes it verified.
pub fn verify<'p>(program: &'p Program, sink: &mut Sink<'_>) -> Option<Verified<'p>> {
    let before = sink.errors();
    if !sizes::check(program, sink) {
        return None;
    }
    let generated = !program.graphs.is_empty();
    let parts: Vec<_> = program.pattern.parts.iter().map(|part| rows::check(part, generated, sink)).collect();
    let facts = Facts { parts };
    if sink.errors() == before {
        parts::check(program, &facts, sink);
    }
    if sink.errors() == before && generated {
        graph::check(program, sink);
    }
    (sink.errors() == before).then_some(Verified { program, facts })
}
