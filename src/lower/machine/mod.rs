//! From a verified pattern to knitting: each stitch becomes a knit loop, and transfers shape the tube.
//!
//! What comes out is executed on the model of the machine before anyone sees it: a program that would break a rule is
//! refused with the round and the stitch where it would.

mod bind_off;
mod emit;
mod piece;
pub mod plan;
mod tube;
pub mod validate;

pub use emit::Origin;

use crate::diag::{Code as Finding, Diagnostic, Sink, Span};
use crate::ir::machine::{CarrierId, Code, Instruction, Machine, Report, execute};
use crate::ir::{Part, Program, Start};
use emit::Emitter;

/// Most loops that one stitch works together or makes in one place.
pub const MOST_IN_ONE: u16 = 3;
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
    let mut code = header(program, machine);
    let mut origins = Vec::new();
    if !machine.bed.half_gauge {
        refuse(
            machine,
            "bed.half_gauge",
            "false",
            "tubes need every second needle for their transfers",
            sink,
        );
        return None;
    }
    for (index, part) in program.pattern.parts.iter().enumerate() {
        let mut emitter = piece::knit(index as u32, part, machine, options, sink)?;
        if code.ops().len() + emitter.ops.len() > MAX_OPERATIONS {
            let message = format!("more than {MAX_OPERATIONS} instructions");
            sink.push(Diagnostic::new(Finding::TooLarge, message).in_round(&part.name, None));
            return None;
        }
        if part.copies > 1 {
            code.remark(format!("make {} of this: {}", part.copies, part.name));
        } else {
            code.remark(format!("part: {}", part.name));
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

/// True for a part whose first loops another part left.
fn joined(part: &Part) -> bool {
    matches!(part.start, Start::Join { .. })
}
