//! Equal rounds in one line: three times `Rnd: 36 sc` becomes `Rnds 7-9: 36 sc`.

use super::Pass;
use crate::ir::{Op, Row};

pub(super) const PASS: Pass = Pass {
    name: "rows",
    about: "equal rounds in one line: Rnds 7-12: 36 sc (36)",
    run: |program, _| {
        for part in &mut program.pattern.parts {
            part.rows.dedup_by(|row, before| {
                let times = before.times.checked_add(row.times).filter(|_| equal(row, before));
                if let Some(times) = times {
                    (before.times, before.span) = (times, before.span.to(row.span));
                }
                times.is_some()
            });
        }
    },
};

/// One count stands for all rounds of a line, so a row that leaves or holds loops stays alone.
fn equal(row: &Row, before: &Row) -> bool {
    let count = |row: &Row| row.stated.map(|(count, _)| count);
    let plain = |op: &Op| !matches!(op, Op::Leave { .. } | Op::Hold { .. });
    row.body == before.body && count(row) == count(before) && row.body.ops().iter().all(plain)
}
