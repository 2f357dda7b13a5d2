//! Loops that go from part to part.

use super::Facts;
use crate::diag::{Code, Diagnostic, Sink};
use crate::ir::{Block, Finish, Op, Part, PartId, Program, Segment, Start};
use std::collections::BTreeMap;

/// Loops by giving and taking part.
type Ledger = BTreeMap<(PartId, PartId), u64>;

/// Checks what parts start from against what other parts leave.
pub(super) fn check(program: &Program, facts: &Facts, sink: &mut Sink<'_>) {
    let parts = &program.pattern.parts;
    let (mut given, mut taken) = (Ledger::new(), Ledger::new());
    let mut uses = vec![0_u64; parts.len()];
    for (index, part) in parts.iter().enumerate() {
        let id = PartId(index as u32);
        for row in &part.rows {
            hold(&row.body, u64::from(row.times) * u64::from(part.copies), &mut |by, loops| {
                *given.entry((id, by)).or_default() += loops;
            });
        }
        let Start::Join { segments } = &part.start else { continue };
        for segment in segments {
            let fault = match *segment {
                Segment::Chain { .. } => None,
                Segment::Open { part: from, .. }
                | Segment::Held { part: from, .. }
                | Segment::Surface { part: from, .. }
                    if from >= id || from.0 as usize >= parts.len() =>
                {
                    Some((Code::BrokenProgram, "it starts from a part that is not made before it".into()))
                }
                Segment::Open { part: from, loops } => {
                    uses[from.0 as usize] += u64::from(part.copies);
                    open(&parts[from.0 as usize], loops, facts.parts[from.0 as usize].open)
                }
                Segment::Held { part: from, loops } => {
                    *taken.entry((from, id)).or_default() += u64::from(loops) * u64::from(part.copies);
                    None
                }
                Segment::Surface { part: from, round, first, loops, .. } => {
                    surface(&parts[from.0 as usize], &facts.parts[from.0 as usize], round, first, loops)
                }
            };
            if let Some((code, message)) = fault {
                sink.push(Diagnostic::new(code, message).in_round(&part.name, None));
            }
        }
    }
    for (part, uses) in parts.iter().zip(uses) {
        if uses > u64::from(part.copies) {
            let message =
                format!("the open loops of {} are used {uses} times, {} made", part.name, part.copies);
            let help = format!("make {uses} of it: `{} (make {uses}):`", part.name);
            sink.push(Diagnostic::new(Code::JoinLoops, message).in_round(&part.name, None).help(help));
        }
    }
    for &(from, by) in given.keys().chain(taken.keys().filter(|key| !given.contains_key(key))) {
        let count = |ledger: &Ledger| ledger.get(&(from, by)).copied().unwrap_or(0);
        let (held, used) = (count(&given), count(&taken));
        let name = |id: PartId| parts.get(id.0 as usize).map_or("a missing part", |part| part.name.as_str());
        if held != used || by <= from {
            let message = format!("{} holds {held} loops for {}, which takes {used}", name(from), name(by));
            sink.push(Diagnostic::new(Code::HeldLoops, message).in_round(name(from), None));
        }
    }
}

fn hold(block: &Block, times: u64, give: &mut impl FnMut(PartId, u64)) {
    for op in block.ops() {
        match op {
            Op::Hold { loops, by } => give(*by, u64::from(*loops).saturating_mul(times)),
            Op::Repeat { body, times: again } => hold(body, times.saturating_mul(u64::from(*again)), give),
            Op::Work { .. } | Op::Turn(_) | Op::Leave { .. } | Op::Color(_) => {}
        }
    }
}

fn open(from: &Part, loops: u32, open: u32) -> Option<(Code, String)> {
    if from.finish == Finish::DrawnShut {
        return Some((Code::JoinLoops, format!("{} is drawn shut and leaves no open loops", from.name)));
    }
    (loops != open).then(|| (Code::JoinLoops, format!("{} leaves {open} loops, not {loops}", from.name)))
}

fn surface(
    from: &Part,
    facts: &super::PartFacts,
    round: u32,
    first: u32,
    loops: u32,
) -> Option<(Code, String)> {
    let made = if round.checked_add(1) == Some(from.first_number()) {
        facts.start
    } else {
        let row = from.numbered_rows().zip(&facts.rows);
        row.filter(|((number, row), _)| (*number..number.saturating_add(row.times)).contains(&round))
            .map(|(_, facts)| facts.produces)
            .next()
            .unwrap_or(0)
    };
    let last = u64::from(first) + u64::from(loops);
    (first == 0 || loops == 0 || last > u64::from(made) + 1).then(|| {
        let message =
            format!("stitches {first} to {} of round {round} of {}", last.saturating_sub(1), from.name);
        (Code::JoinLoops, format!("{message}, which has {made}"))
    })
}
