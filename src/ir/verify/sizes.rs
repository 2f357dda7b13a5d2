//! Caps and emptiness, by checked arithmetic and without walking.

use super::MAX_ROUNDS;
use crate::diag::{Code, Diagnostic, Sink, Span};
use crate::ir::{Block, MAX_LOOPS, MAX_NESTING, MAX_ROW, Op, Part, Program, Row, Start};

/// What is wrong with the size of a row.
enum Fault {
    Nested,
    Never(&'static str),
    Steps,
}

/// True when every count is within its cap, so that walking is safe.
pub(super) fn check(program: &Program, sink: &mut Sink<'_>) -> bool {
    let before = sink.errors();
    let mut steps = 0_u64;
    let mut rounds = 0_u64;
    for part in &program.pattern.parts {
        if part.copies == 0 {
            sink.push(broken("a part is made no times").in_round(&part.name, None));
        }
        let start = part.start.loops();
        // The stitches of a first row may go into a ring, or bring their own chain.
        let bare = matches!(part.start, Start::Ring { loops: 0 } | Start::Chain { loops: 0, .. });
        if start > MAX_ROW || (start == 0 && (!bare || part.rows.is_empty())) {
            let code = if start == 0 { Code::BrokenProgram } else { Code::TooLarge };
            let message = format!("{} starts with {start} loops, not 1 to {MAX_ROW}", part.name);
            sink.push(Diagnostic::new(code, message).in_round(&part.name, None));
        }
        for (number, row) in part.numbered_rows() {
            rounds += u64::from(row.times);
            match size(row) {
                Ok(count) => steps = steps.saturating_add(count),
                Err((fault, span)) => report(&fault, span, part, number, row, sink),
            }
        }
        steps = steps.saturating_add(u64::from(start)).saturating_mul(u64::from(part.copies.max(1)));
    }
    if sink.errors() == before && (steps > u64::from(MAX_LOOPS) || rounds > u64::from(MAX_ROUNDS)) {
        let message = format!("{steps} stitches in {rounds} rounds, limits {MAX_LOOPS} and {MAX_ROUNDS}");
        sink.push(
            Diagnostic::new(Code::TooLarge, message).help("split the pattern, or use coarser stitches"),
        );
    }
    sink.errors() == before
}

/// Steps of all rounds of a row.
fn size(row: &Row) -> Result<u64, (Fault, Span)> {
    if row.times == 0 {
        return Err((Fault::Never("a row is worked no times"), row.span));
    }
    if row.body.is_empty() {
        return Err((Fault::Never("a row is empty"), row.span));
    }
    sound(&row.body, MAX_NESTING)?;
    row.body
        .step_count()
        .and_then(|count| count.checked_mul(u64::from(row.times)))
        .filter(|count| *count <= u64::from(MAX_LOOPS))
        .ok_or((Fault::Steps, row.span))
}

fn sound(block: &Block, nesting: u32) -> Result<(), (Fault, Span)> {
    for (op, span) in block.spanned() {
        match op {
            Op::Work { times: 0, .. } => return Err((Fault::Never("a stitch is worked no times"), span)),
            Op::Repeat { times: 0, .. } => return Err((Fault::Never("a repeat is worked no times"), span)),
            Op::Repeat { body, .. } if body.is_empty() => {
                return Err((Fault::Never("a repeat is empty"), span));
            }
            Op::Repeat { .. } if nesting == 0 => return Err((Fault::Nested, span)),
            Op::Repeat { body, .. } => sound(body, nesting - 1)?,
            Op::Work { .. } | Op::Turn(_) | Op::Hold { .. } | Op::Leave { .. } | Op::Color(_) => {}
        }
    }
    Ok(())
}

fn report(fault: &Fault, span: Span, part: &Part, number: u32, row: &Row, sink: &mut Sink<'_>) {
    let diagnostic = match fault {
        Fault::Nested => Diagnostic::new(Code::TooLarge, format!("repeats nest deeper than {MAX_NESTING}"))
            .help("write the inner repeats out, or repeat whole rounds"),
        Fault::Never(message) => broken(message),
        Fault::Steps => Diagnostic::new(Code::TooLarge, format!("a row of more than {MAX_LOOPS} stitches"))
            .help(format!("a row has at most {MAX_ROW} loops")),
    };
    sink.push(
        diagnostic.at(if span.is_none() { row.span } else { span }, "").in_round(&part.name, Some(number)),
    );
}

fn broken(message: &str) -> Diagnostic {
    Diagnostic::new(Code::BrokenProgram, message)
}
