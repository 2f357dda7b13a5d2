//! Knitout (`.k`): machine code in the common format of V-bed knitting machines.

use super::{Backend, Error, Format};
use crate::diag::Sink;
use crate::ir::machine::{CarrierSet, Checked, Choice, Code, Instruction, Machine};
use crate::ir::verify::Verified;
use crate::lower::machine::{Options, lower};
use std::io::{self, Write};

/// Machine code for a V-bed knitting machine.
#[derive(Clone, Debug, Default, PartialEq, serde::Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Knitout {
    /// The machine; `swg091n2` when none is named.
    pub machine: Option<Choice>,
    /// Stitches without an exact counterpart become knit loops, each with a warning.
    pub approximate: bool,
    /// Leaves out the waste section that the machine's profile asks for.
    pub no_waste: bool,
}

impl Format for Knitout {
    const NAME: &'static str = "knitout";
    const EXTENSION: &'static str = "k";
    const ABOUT: &'static str = "machine code for V-bed knitting machines; each stitch becomes a knit loop";
}

impl Backend for Knitout {
    fn emit(&self, program: &Verified<'_>, out: &mut dyn Write, sink: &mut Sink<'_>) -> Result<(), Error> {
        let options = Options { approximate: self.approximate, no_waste: self.no_waste };
        let code = program_code(program, self.machine.as_ref(), "swg091n2", &options, Self::NAME, sink)?;
        Ok(write(&code, out)?)
    }

    fn emit_code(&self, code: &Checked<'_>, out: &mut dyn Write, _: &mut Sink<'_>) -> Result<(), Error> {
        Ok(write(code, out)?)
    }
}

/// Lowers a program for a machine. What it cannot make is a refusal, with the place in the sink.
pub(super) fn program_code(
    program: &Verified<'_>,
    machine: Option<&Choice>,
    usual: &str,
    options: &Options,
    backend: &'static str,
    sink: &mut Sink<'_>,
) -> Result<Code, Error> {
    let refused = |what: String| Error::Unsupported { backend, what };
    let machine = match machine {
        Some(Choice(machine)) => machine.clone(),
        None => Machine::named(usual).ok_or_else(|| refused("no machine is named".to_owned()))?,
    };
    let lowered = lower(program, &machine, options, sink);
    Ok(lowered.ok_or_else(|| refused(format!("`{}` cannot make it", machine.name)))?.code)
}

/// Writes a program: magic line, header, one instruction a line, comments where they stood.
pub fn write(code: &Code, out: &mut dyn Write) -> io::Result<()> {
    let mut out = io::BufWriter::new(out);
    writeln!(out, ";!knitout-{}", code.version)?;
    for header in &code.headers {
        writeln!(out, ";;{}: {}", header.name, header.value)?;
    }
    let mut comments = code.comments.iter().peekable();
    for (at, op) in code.ops().iter().enumerate() {
        while let Some(comment) = comments.next_if(|comment| comment.at as usize <= at && !comment.trailing) {
            writeln!(out, ";{}", comment.text)?;
        }
        instruction(code, op, &mut out)?;
        match comments.next_if(|comment| comment.at as usize <= at) {
            Some(comment) => writeln!(out, ";{}", comment.text)?,
            None => writeln!(out)?,
        }
    }
    for comment in comments {
        writeln!(out, ";{}", comment.text)?;
    }
    out.flush()
}

/// Writes one instruction without its line end.
fn instruction(code: &Code, op: &Instruction, out: &mut impl Write) -> io::Result<()> {
    let opcode = op.opcode();
    match op {
        Instruction::In(carriers)
        | Instruction::InHook(carriers)
        | Instruction::ReleaseHook(carriers)
        | Instruction::Out(carriers)
        | Instruction::OutHook(carriers) => {
            write!(out, "{opcode}")?;
            names(code, carriers, out)
        }
        Instruction::Stitch(leading, trailing) => write!(out, "{opcode} {leading} {trailing}"),
        Instruction::Rack(rack) => write!(out, "{opcode} {rack}"),
        Instruction::Knit(direction, needle, carriers)
        | Instruction::Tuck(direction, needle, carriers)
        | Instruction::Miss(direction, needle, carriers) => {
            write!(out, "{opcode} {} {needle}", direction.sign())?;
            names(code, carriers, out)
        }
        Instruction::Split(direction, from, to, carriers) => {
            write!(out, "{opcode} {} {from} {to}", direction.sign())?;
            names(code, carriers, out)
        }
        Instruction::Drop(needle) | Instruction::Amiss(needle) => write!(out, "{opcode} {needle}"),
        Instruction::Xfer(from, to) => write!(out, "{opcode} {from} {to}"),
        Instruction::Pause(text) => {
            write!(out, "{opcode}")?;
            match code.texts.get(*text as usize) {
                Some(words) if !words.is_empty() => write!(out, " {words}"),
                _ => Ok(()),
            }
        }
        Instruction::Extension(text) => {
            out.write_all(code.texts.get(*text as usize).map_or("", String::as_str).as_bytes())
        }
    }
}

fn names(code: &Code, carriers: &CarrierSet, out: &mut impl Write) -> io::Result<()> {
    carriers.iter().try_for_each(|id| write!(out, " {}", code.carrier(*id)))
}
