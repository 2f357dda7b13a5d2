//! From a verified pattern to knitting: each stitch becomes a knit loop, and transfers shape the tube.
//!
//! What comes out is executed on the model of the machine before anyone sees it: a program that would break a rule is
//! refused with the round and the stitch where it would.

pub mod begin;
mod bench;
mod bind_off;
mod emit;
mod piece;
pub mod plan;
mod refuse;
mod replay;
mod tube;
mod turning;
pub mod validate;
mod yarns;

pub use emit::Origin;

use crate::diag::{Code as Finding, Diagnostic, Sink, Span};
use crate::ir::machine::{CarrierId, Code, Instruction, Machine, Report, execute};
use crate::ir::{Hand, Pattern, Program};
use bench::Bench;
use emit::Emitter;
use refuse::Reason;
use std::collections::{BTreeMap, BTreeSet};
use tube::Stuck;

/// Most loops that one stitch works together or makes in one place.
pub const MOST_IN_ONE: u16 = 3;
/// Most pieces of a program.
const MAX_PIECES: u64 = 1000;
/// Most wraps that are left out of one group of pieces.
const MAX_UNWRAPPED: usize = 500;
/// Most instructions of a program.
const MAX_OPERATIONS: usize = 40_000_000;

/// What the lowering may be told.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Stitches without an exact counterpart become knit loops, with a warning for each; else they are refused.
    pub approximate: bool,
    /// Leaves the waste section of the profile out.
    pub no_waste: bool,
}

/// A program with the stitch for which each instruction was written.
#[derive(Debug)]
pub struct Lowered {
    /// The program.
    pub code: Code,
    /// One origin for each instruction.
    pub origins: Vec<Origin>,
    /// What the program amounts to.
    pub report: Report,
}

/// Lowers all parts of a program, one after the other; `None` with the reasons in the sink when the machine cannot
/// make them.
pub fn lower(
    program: &Program,
    machine: &Machine,
    options: &Options,
    sink: &mut Sink<'_>,
) -> Option<Lowered> {
    if !program.maker.is_usual() {
        let (message, help) = match program.maker.hand {
            Hand::Left => (
                format!("the pattern is for left-handed work, and `{}` knits its mirror image", machine.name),
                "a machine knows no hand: build it without `hand = left`",
            ),
            Hand::Right => (
                format!("the pattern is for stitches that lean, and those of `{}` do not", machine.name),
                "build it without `lean`",
            ),
        };
        sink.push(Diagnostic::new(Finding::ForHands, message).help(help));
        return None;
    }
    let mut code = header(program, machine);
    let mut origins = Vec::new();
    let pieces = program.pattern.parts.iter().map(|part| u64::from(part.copies)).sum::<u64>();
    if pieces > MAX_PIECES {
        let message = format!("{pieces} pieces are more than one program can hold");
        sink.push(
            Diagnostic::new(Finding::TooLarge, message)
                .help(format!("at most {MAX_PIECES}; run the program of one piece that often")),
        );
        return None;
    }
    if machine.rack.preferred.min(machine.rack.max) < 2.0 {
        let what = "loops are moved to their neighbors by racks of 2 needles";
        let (field, value) = if machine.rack.max < 2.0 {
            ("rack.max", machine.rack.max)
        } else {
            ("rack.preferred", machine.rack.preferred)
        };
        refuse(machine, field, &value.to_string(), what, sink);
        return None;
    }
    for group in begin::order(&program.pattern) {
        let mut emitter = knit_group(&group, &program.pattern, machine, options, sink)?;
        if code.ops().len() + emitter.ops.len() > MAX_OPERATIONS {
            let message = format!("more than {MAX_OPERATIONS} instructions");
            sink.push(Diagnostic::new(Finding::TooLarge, message));
            return None;
        }
        append(&mut code, &mut origins, &mut emitter, machine);
    }
    if code.ops().is_empty() {
        sink.push(Diagnostic::new(Finding::NotKnittable, "the pattern has no part"));
        return None;
    }
    let report = inspect(program, machine, &code, &origins, sink)?;
    sink.push(
        Diagnostic::new(Finding::KnitInstead, "re-lowered to knitting; not run on hardware")
            .help("each crochet stitch is a knit loop; take the gauge from a swatch knit on that machine"),
    );
    Some(Lowered { code, origins, report })
}

/// Knits the pieces of one group; `None` with the reason in the sink when the machine cannot.
fn knit_group(
    group: &[begin::Piece],
    pattern: &Pattern,
    machine: &Machine,
    options: &Options,
    sink: &mut Sink<'_>,
) -> Option<Emitter> {
    // Wraps that would overload a needle are left out. Which these are shows when the needle is next worked, so the
    // group is knit again without them.
    let mut unwrapped: BTreeMap<usize, BTreeSet<u32>> = BTreeMap::new();
    // What begins on finished stitches is told before anything that follows from it.
    let parts: BTreeSet<u32> = group.iter().map(|piece| piece.part).collect();
    for part in parts.iter().filter_map(|part| pattern.parts.get(*part as usize)) {
        let mut found = Sink::new();
        if begin::begin(pattern, part, options, &mut found).is_none() {
            found.take().into_iter().for_each(|found| sink.push(found));
            return None;
        }
    }
    let none = BTreeSet::new();
    loop {
        let mut bench = Bench::new(machine);
        let mut heard = Sink::new();
        let mut failed = None;
        for (index, piece) in group.iter().enumerate() {
            bench.emitter.remark(title(group, index, pattern));
            let unwrapped = unwrapped.get(&index).unwrap_or(&none);
            // Copies of a part say the same; once is enough.
            let copy = group.iter().take(index).any(|before| before.part == piece.part);
            let mut silent = Sink::new();
            let sink = if copy { &mut silent } else { &mut heard };
            if let Err(reason) = piece::knit(*piece, pattern, &mut bench, options, unwrapped, sink) {
                failed = Some((index, reason));
                break;
            }
        }
        let again = match &failed {
            Some((index, Reason::Stuck(Stuck::Stack(_, Some(turn))))) => {
                let left_out: usize = unwrapped.values().map(BTreeSet::len).sum();
                left_out < MAX_UNWRAPPED && unwrapped.entry(*index).or_default().insert(*turn)
            }
            _ => false,
        };
        if again {
            continue;
        }
        heard.take().into_iter().for_each(|found| sink.push(found));
        let Some((_, reason)) = failed else { return Some(bench.emitter) };
        refuse::refuse(&reason, bench.emitter.origin, pattern, machine, sink);
        return None;
    }
}

/// What a piece is, for the one at the machine.
fn title(group: &[begin::Piece], index: usize, pattern: &Pattern) -> String {
    let of = |piece: &begin::Piece| group.get(index).is_some_and(|this| this.part == piece.part);
    let part = group.get(index).and_then(|piece| pattern.parts.get(piece.part as usize));
    let name = part.map_or("", |part| part.name.as_str()).replace(['\n', '\r'], " ");
    let copies = group.iter().filter(|piece| of(piece)).count();
    if copies > 1 {
        let number = group.iter().take(index + 1).filter(|piece| of(piece)).count();
        format!("part: {name}, {number} of {copies}")
    } else {
        format!("part: {name}")
    }
}

fn header(program: &Program, machine: &Machine) -> Code {
    let mut code = Code::with_carriers(machine.carriers.names.clone());
    code.set_header("Machine", machine.header.as_ref().unwrap_or(&machine.name).clone());
    code.set_header("Gauge", machine.bed.gauge.to_string());
    code.set_header("Position", "Keep");
    code.remark("crochet re-lowered to V-bed knitting by picot; not run on hardware");
    if !program.name.is_empty() {
        code.remark(format!("object: {}", program.name.replace(['\n', '\r'], " ")));
    }
    code
}

/// Puts a piece on the bed, centered.
fn append(code: &mut Code, origins: &mut Vec<Origin>, emitter: &mut Emitter, machine: &Machine) {
    let [first, last] = machine.bed.needles;
    let by = emitter.reach().map_or(0, |(left, right)| {
        let room = (last - first + 1) - (right - left + 1);
        first + room / 2 - left
    });
    let mut remarks = std::mem::take(&mut emitter.remarks).into_iter().peekable();
    let mut extensions = std::mem::take(&mut emitter.extensions).into_iter().peekable();
    let ops = std::mem::take(&mut emitter.ops);
    for (at, mut op) in ops.into_iter().enumerate() {
        while let Some((_, text)) = remarks.next_if(|(place, _)| *place as usize <= at) {
            code.remark(text);
        }
        let origin = emitter.origins.get(at).copied().unwrap_or_default();
        while let Some((_, text)) = extensions.next_if(|(place, _)| *place as usize <= at) {
            let text = code.text(text);
            code.push(Instruction::Extension(text), Span::NONE);
            origins.push(origin);
        }
        op.shift(by);
        code.push(op, Span::NONE);
        origins.push(origin);
    }
}

/// Runs the program. Whatever the executor would say to a user is a refusal here, at its stitch.
fn inspect(
    program: &Program,
    machine: &Machine,
    code: &Code,
    origins: &[Origin],
    sink: &mut Sink<'_>,
) -> Option<Report> {
    let mut heard = Sink::new();
    let run = execute(code, Some(machine), &mut heard);
    let Some((diagnostic, op)) = heard.diagnostics().iter().zip(&run.places).next() else {
        return Some(run.report);
    };
    let origin = op.and_then(|op| origins.get(op)).copied().unwrap_or_default();
    let name = program.pattern.parts.get(origin.part as usize).map_or("", |part| part.name.as_str());
    let at = if origin.stitch > 0 { format!(" at stitch {}", origin.stitch) } else { String::new() };
    sink.push(
        Diagnostic::new(Finding::BeyondMachine, format!("{}{at}", diagnostic.message))
            .in_round(name, Some(origin.round))
            .help(
                diagnostic.help.clone().unwrap_or_else(|| "another machine, or a plainer shape".to_owned()),
            ),
    );
    None
}

fn refuse(machine: &Machine, field: &str, value: &str, what: &str, sink: &mut Sink<'_>) {
    let help = format!("`{field}` of `{}` is {value}", machine.name);
    sink.push(Diagnostic::new(Finding::BeyondMachine, what).help(help));
}

/// The place of a carrier in the header.
fn carrier(machine: &Machine, name: &str) -> CarrierId {
    machine.carriers.names.iter().position(|known| known == name).unwrap_or(0) as CarrierId
}
