//! Passes over a pattern: each keeps the steps, and says so in [`PASSES`].

mod repeats;
mod rows;
mod runs;
mod turns;

use crate::diag::Sink;
use crate::ir::{Block, MAX_NESTING, MAX_ROW, Op, Pattern, Program, Row, Step};

/// One pass. Adding one is one file and one line of [`PASSES`].
#[derive(Debug)]
pub struct Pass {
    /// Name, for what it does.
    pub name: &'static str,
    /// One line: before and after.
    pub about: &'static str,
    /// Does it.
    pub run: fn(&mut Program, &mut Sink<'_>),
}

/// The passes in the order in which they run; each line carries its reason.
pub static PASSES: &[Pass] = &[
    turns::PASS,   // first: marks must be in the open before the stretches between them are folded
    repeats::PASS, // before runs: counted runs would hide longer repeats
    runs::PASS,    // what no repeat took
    rows::PASS,    // last: rounds are equal when their folded forms are
];

/// Runs all passes. Debug builds hold each to its promise to keep the steps.
pub fn run(program: &mut Program, sink: &mut Sink<'_>) {
    for pass in PASSES {
        let before = cfg!(debug_assertions).then(|| program.pattern.clone());
        (pass.run)(program, sink);
        if let Some(before) = before {
            debug_assert!(same_steps(&before, &program.pattern), "pass {} changes the steps", pass.name);
        }
    }
}

/// True when two patterns mean the same: equal rounds of equal steps in the same parts. Patterns too large to walk count
/// as the same.
pub fn same_steps(before: &Pattern, after: &Pattern) -> bool {
    const WALK: u64 = 10_000_000;
    let size = |pattern: &Pattern| {
        pattern.parts.iter().flat_map(|part| &part.rows).try_fold(0_u64, |sum, row| {
            sum.checked_add(row.body.step_count()?.checked_mul(u64::from(row.times))?)
        })
    };
    match (size(before), size(after)) {
        (Some(before), Some(after)) if before != after => return false,
        (Some(steps), _) if steps <= WALK => {}
        _ => return true,
    }
    let rounds = |row: &Row| u64::from(row.times);
    before.parts.len() == after.parts.len()
        && before.parts.iter().zip(&after.parts).all(|(before, after)| {
            before.rows.iter().map(rounds).sum::<u64>() == after.rows.iter().map(rounds).sum::<u64>()
                && steps(&before.rows).eq(steps(&after.rows))
        })
}

/// Every step of some rows, with `None` between rounds.
fn steps(rows: &[Row]) -> impl Iterator<Item = Option<Step>> {
    rows.iter()
        .flat_map(|row| (0..row.times).flat_map(|_| row.body.steps().map(Some).chain(std::iter::once(None))))
}

/// True when a row may be unfolded: a pass must not allocate by what a number in the input claims.
fn unfoldable(block: &Block) -> bool {
    nests_within(block, MAX_NESTING)
        && block.step_count().is_some_and(|count| count <= 4 * u64::from(MAX_ROW))
}

fn nests_within(block: &Block, nesting: u32) -> bool {
    block.ops().iter().all(|op| match op {
        Op::Repeat { body, .. } => nesting > 0 && nests_within(body, nesting - 1),
        Op::Work { .. } | Op::Turn(_) | Op::Hold { .. } | Op::Leave { .. } | Op::Color(_) => true,
    })
}

/// Every row of a program.
fn each_row(program: &mut Program) -> impl Iterator<Item = &mut Row> {
    program.pattern.parts.iter_mut().flat_map(|part| &mut part.rows)
}
