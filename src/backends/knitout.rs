//! Knitout (`.k`): machine code in the common format of V-bed knitting machines.

use crate::ir::machine::{CarrierSet, Code, Instruction};
use std::io::{self, Write};

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
