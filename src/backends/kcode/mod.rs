//! k-code (`.kc`): what a Kniterate reads, written in the five-field dialect with 252 cells a bed.

mod schedule;

use super::knitout::program_code;
use super::{Backend, Error, Format};
use crate::diag::{Code as Finding, Diagnostic, Sink};
use crate::ir::machine::{Bed, Checked, Choice, Code, Direction, Rack};
use crate::ir::verify::Verified;
use crate::lower::machine::Options;
use schedule::{Act, CELLS, Job, Pass, schedule};
use std::fmt::Write as _;
use std::io::{self, Write};

/// Machine code for the Kniterate.
#[derive(Clone, Debug, Default, PartialEq, serde::Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Kcode {
    /// The machine; `kniterate` when none is named.
    pub machine: Option<Choice>,
    /// Stitches without an exact counterpart become knit loops, each with a warning.
    pub approximate: bool,
    /// Leaves out the waste section that the machine's profile asks for.
    pub no_waste: bool,
}

impl Format for Kcode {
    const NAME: &'static str = "kcode";
    const EXTENSION: &'static str = "kc";
    const ABOUT: &'static str = "machine code for the Kniterate; each stitch becomes a knit loop";
}

impl Backend for Kcode {
    fn emit(&self, program: &Verified<'_>, out: &mut dyn Write, sink: &mut Sink<'_>) -> Result<(), Error> {
        let options = Options { approximate: self.approximate, no_waste: self.no_waste };
        let code = program_code(program, self.machine.as_ref(), "kniterate", &options, Self::NAME, sink)?;
        write(&code, out, sink)
    }

    fn emit_code(&self, code: &Checked<'_>, out: &mut dyn Write, sink: &mut Sink<'_>) -> Result<(), Error> {
        write(code, out, sink)
    }
}

/// Cells of the margin at each side of a bed line.
const MARGIN: usize = 15;
/// Speed of the carriage when it moves alone.
const MOVE_SPEED: u32 = 300;

/// Why a program cannot be written as k-code.
#[derive(Debug)]
struct Refusal {
    op: Option<usize>,
    what: String,
}

/// Writes a program as passes of the carriage. What a Kniterate cannot do is refused, with its line in the sink.
pub fn write(code: &Code, out: &mut dyn Write, sink: &mut Sink<'_>) -> Result<(), Error> {
    let passes = schedule(code).map_err(|Refusal { op, what }| {
        let span = op.map(|op| code.span(op)).unwrap_or_default();
        sink.push(Diagnostic::new(Finding::NotKcode, what.clone()).at(span, ""));
        Error::Unsupported { backend: "kcode", what }
    })?;
    let mut out = io::BufWriter::new(out);
    out.write_all(b"HOME\nRACK:0\n")?;
    let mut rack = Rack::default();
    let mut line = String::new();
    for pass in &passes {
        line.clear();
        for text in &pass.before {
            line += text;
            line.push('\n');
        }
        if pass.rack != rack {
            rack = pass.rack;
            let _ = writeln!(line, "RACK:{rack}");
        }
        print(pass, &mut line);
        out.write_all(line.as_bytes())?;
    }
    out.flush()?;
    Ok(())
}

fn print(pass: &Pass, line: &mut String) {
    let transfer = matches!(pass.job, Job::Transfer(_)) && pass.carrier == 0;
    let size = if transfer { pass.settings.xfer_stitch } else { pass.settings.stitch };
    let glyphs = glyphs(pass);
    for (bed, sizes, cells) in [("FRNT:", "STIF:", &pass.front), ("REAR:", "STIR:", &pass.back)] {
        line.push_str(bed);
        bed_line(cells, &glyphs, line);
        line.push('\n');
        line.push_str(sizes);
        let value = if cells.is_empty() { '0' } else { size };
        line.extend(std::iter::repeat_n(value, CELLS as usize + 2 * MARGIN));
        line.push('\n');
    }
    let way = match pass.direction {
        Direction::Plus => ">>",
        Direction::Minus => "<<",
    };
    let (speed, roller) = match pass.job {
        Job::Form { .. } => (pass.settings.speed, pass.settings.roller),
        Job::Transfer(_) if pass.carrier != 0 => (pass.settings.speed, pass.settings.roller),
        Job::Transfer(_) | Job::Drop | Job::Kick => (pass.settings.speed, 0.0),
        Job::Move => (f64::from(MOVE_SPEED), 0.0),
    };
    let _ = writeln!(line, "{way} {} {} {speed} {roller}", kind(pass), pass.carrier);
}

/// The type of a pass: what the front bed does, what the back bed does.
fn kind(pass: &Pass) -> String {
    let letter = if pass.direction == Direction::Plus { 'r' } else { 'l' };
    let act = |act: Option<Act>, other: Option<Act>| match act.or(other) {
        Some(Act::Tuck) => "Tu",
        Some(Act::Knit) | None => "Kn",
    };
    match pass.job {
        Job::Form { front, back } => format!("{}-{}", act(front, back), act(back, front)),
        Job::Transfer(Bed::Front) => format!("Tr-R{letter}"),
        Job::Transfer(Bed::Back) => format!("R{letter}-Tr"),
        Job::Kick => "Tu-Tu".to_owned(),
        Job::Drop | Job::Move => "Kn-Kn".to_owned(),
    }
}

/// Stop marks with the number of characters of the bare line before them, in the order in which they stand.
fn glyphs(pass: &Pass) -> Vec<(usize, char)> {
    let before = |place: f64| (place + 0.5 + MARGIN as f64).max(0.0) as usize;
    let digit = |carrier: u8| char::from(b'0' + carrier.min(9));
    let mut marks = vec![(before(pass.stops.0), '/')];
    if let Some((start, stop)) = pass.carrier_stops {
        let (low, high) = if start <= stop { (start, stop) } else { (stop, start) };
        marks.push((before(low), digit(pass.carrier)));
        marks.push((before(high), digit(pass.carrier)));
    }
    marks.push((before(pass.stops.1), '\\'));
    // Stable: on equal places the carriage's own marks stay outside.
    marks.sort_by_key(|&(at, _)| at);
    marks
}

fn bed_line(cells: &[i32], glyphs: &[(usize, char)], line: &mut String) {
    let width = CELLS as usize + 2 * MARGIN;
    let mut bare = [b'.'; CELLS as usize + 2 * MARGIN];
    if let Some(bed) = bare.get_mut(MARGIN..width - MARGIN) {
        bed.fill(b'_');
        for &cell in cells {
            if let Some(place) = usize::try_from(cell).ok().and_then(|cell| bed.get_mut(cell)) {
                *place = b'-';
            }
        }
    }
    let mut marks = glyphs.iter().peekable();
    for (at, &cell) in bare.iter().enumerate() {
        while let Some((_, mark)) = marks.next_if(|(place, _)| *place <= at) {
            line.push(*mark);
        }
        line.push(char::from(cell));
    }
    line.extend(marks.map(|(_, mark)| *mark));
}
