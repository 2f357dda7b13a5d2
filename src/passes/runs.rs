//! Equal neighbors counted: `sc, sc, sc` becomes `3 sc`.

use super::{Pass, each_row, nests_within};
use crate::diag::Span;
use crate::ir::{Block, MAX_NESTING, Op};

pub(super) const PASS: Pass = Pass {
    name: "runs",
    about: "equal stitches in a row are counted: sc, sc, sc becomes 3 sc",
    run: |program, _| {
        for row in each_row(program) {
            if nests_within(&row.body, MAX_NESTING) && !counted(&row.body) {
                row.body = count(&row.body);
            }
        }
    },
};

/// True when there is nothing to do.
fn counted(block: &Block) -> bool {
    block.ops().windows(2).all(|pair| match pair {
        [Op::Work { stitch, .. }, Op::Work { stitch: next, .. }] => stitch != next,
        _ => true,
    }) && block.ops().iter().all(|op| match op {
        Op::Repeat { body, times } => *times != 1 && folded_run(body, *times).is_none() && counted(body),
        Op::Work { .. } | Op::Turn(_) | Op::Hold { .. } | Op::Leave { .. } | Op::Color(_) => true,
    })
}

/// The run that a repeat of one run is.
fn folded_run(body: &Block, times: u32) -> Option<Op> {
    match body.ops() {
        [Op::Work { stitch, times: each }] => {
            Some(Op::Work { stitch: *stitch, times: each.checked_mul(times)? })
        }
        _ => None,
    }
}

fn count(block: &Block) -> Block {
    let mut out = Counted::default();
    add(block, &mut out);
    out.flush();
    out.block
}

fn add(block: &Block, out: &mut Counted) {
    for (op, span) in block.spanned() {
        match op {
            Op::Repeat { body, times: 1 } => add(body, out),
            Op::Repeat { body, times } => {
                let body = count(body);
                match folded_run(&body, *times) {
                    Some(run) => out.push(run, span),
                    None => out.push(Op::repeat(body, *times), span),
                }
            }
            Op::Work { .. } | Op::Turn(_) | Op::Hold { .. } | Op::Leave { .. } | Op::Color(_) => {
                out.push(op.clone(), span);
            }
        }
    }
}

/// A block under way, its last operation still open.
#[derive(Default)]
struct Counted {
    block: Block,
    last: Option<(Op, Span)>,
}

impl Counted {
    fn push(&mut self, op: Op, span: Span) {
        if let (Some((Op::Work { stitch, times }, at)), Op::Work { stitch: next, times: more }) =
            (&mut self.last, &op)
            && stitch == next
            && let Some(sum) = times.checked_add(*more)
        {
            (*times, *at) = (sum, at.to(span));
            return;
        }
        self.flush();
        self.last = Some((op, span));
    }

    fn flush(&mut self) {
        if let Some((op, span)) = self.last.take() {
            self.block.push(op, span);
        }
    }
}
