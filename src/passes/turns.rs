//! Direction marks in the open: `(9 sc <- -4 sc -> 4 sc) x 2` becomes `9 sc <- -4 sc -> 13 sc <- -4 sc -> 4 sc`.

use super::{Pass, each_row, unfoldable};
use crate::ir::{Block, Op};

pub(super) const PASS: Pass = Pass {
    name: "turns",
    about: "short rows out of repeats: (9 sc <- -4 sc -> 4 sc) x 2 is written out, so that every mark stands in the line",
    run: |program, _| {
        for row in each_row(program) {
            let hidden = row.body.ops().iter().any(|op| matches!(op, Op::Repeat { .. }) && turns(op));
            if hidden && unfoldable(&row.body) {
                let mut open = Block::default();
                unfold(&row.body, &mut open);
                row.body = open;
            }
        }
    },
};

fn turns(op: &Op) -> bool {
    match op {
        Op::Turn(_) => true,
        Op::Repeat { body, .. } => body.ops().iter().any(turns),
        Op::Work { .. } | Op::Hold { .. } | Op::Leave { .. } | Op::Color(_) => false,
    }
}

fn unfold(block: &Block, open: &mut Block) {
    for (op, span) in block.spanned() {
        match op {
            Op::Repeat { body, times } if turns(op) => (0..*times).for_each(|_| unfold(body, open)),
            Op::Work { .. }
            | Op::Repeat { .. }
            | Op::Turn(_)
            | Op::Hold { .. }
            | Op::Leave { .. }
            | Op::Color(_) => open.push(op.clone(), span),
        }
    }
}
