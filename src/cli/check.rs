//! `picot check`: what is wrong with patterns and machine programs. Writes nothing but its findings.

use super::args::{Check, CheckFormat};
use super::files::Place;
use super::plan::reader_of;
use super::progress::Watch;
use super::report::{self, Report};
use super::route::{Routed, route};
use super::{Failure, Status, files, print, print_json};
use picot::backends;
use picot::diag::position::Positions;
use picot::diag::render::{json::object, short::short};
use picot::diag::{Diagnostic, Severity, Sink, Source, Sources};
use picot::frontend::Input;
use picot::frontend::crochet::{self, Conventions, Document, PartRounds, Round};
use picot::ir::machine::{self, Hand, Machine};
use picot::ir::{Direction, Part, Program, Row, Step, verify::verify};
use picot::lower::machine::{Options, validate::validate};
use serde_json::{Value, json};
use std::path::PathBuf;

pub(crate) fn run(arguments: &Check, report: Report) -> Result<Status, Failure> {
    // A program is compared with the pattern as the options of its target lower it.
    let lowered: Vec<_> = arguments.against.iter().filter_map(|_| backends::target("knitout")).collect();
    let routed = route(&arguments.reading, &lowered)?;
    let stdin = files::stdin_if_named(arguments.files.iter())?;
    let mut status = Status::Fine;
    let mut values = Vec::new();
    let mut lines = String::new();
    for path in &arguments.files {
        let mut sources = Sources::new(&files::load);
        let watch = Watch::new(None);
        let mut sink = Sink::with_observer(&watch);
        let held = check(path, arguments, &routed, &stdin, &mut sources, &mut sink)?;
        if sink.has_errors() {
            status = Status::InputErrors;
        }
        let found = sink.diagnostics();
        match arguments.format {
            CheckFormat::Human => {
                report::print(&report.render(&sources, found));
                report.remark(&format!("{path}: {}{}", verdict(found), held.summary()));
            }
            CheckFormat::Short => {
                let positions = Positions::new(&sources);
                for diagnostic in found {
                    lines += &short(diagnostic, &positions);
                    lines.push('\n');
                }
            }
            CheckFormat::Json => values.push(file(path, &held, found, &sources)?),
        }
    }
    match arguments.format {
        CheckFormat::Human => {}
        CheckFormat::Short => {
            print(lines.as_bytes())?;
        }
        CheckFormat::Json => {
            let ok = status == Status::Fine;
            print_json(&json!({ "schema": "picot.check/1", "ok": ok, "files": values }))?;
        }
    }
    Ok(status)
}

/// What a file holds, beside its findings.
#[derive(Default)]
struct Held {
    /// Parts of a pattern with their rounds.
    parts: Vec<PartRounds>,
    /// What a machine program amounts to, with the machine that it was run on.
    run: Option<(machine::Report, Option<String>)>,
}

impl Held {
    fn parts(parts: Vec<PartRounds>) -> Self {
        Self { parts, run: None }
    }

    /// The figures of a machine program in a few words.
    fn summary(&self) -> String {
        let Some((run, _)) = &self.run else { return String::new() };
        format!(
            "; {} operations in {} passes, {} loops, widest rack {}, largest stack {}",
            run.operations, run.passes, run.loops, run.widest_rack, run.largest_stack
        )
    }

    fn run_object(&self) -> Option<Value> {
        let (run, machine) = self.run.as_ref()?;
        Some(
            json!({ "machine": machine, "operations": run.operations, "passes": run.passes, "loops": run.loops,
            "transfers": run.transfers, "widest_rack": run.widest_rack.needles(), "largest_stack": run.largest_stack,
            "longest_float": run.longest_float, "longest_link": run.longest_link, "held": run.held }),
        )
    }
}

/// Findings in a few words.
fn verdict(found: &[Diagnostic]) -> String {
    let count =
        |severity: Severity| found.iter().filter(|diagnostic| diagnostic.severity == severity).count();
    let some = |count: usize, what: &str| match count {
        0 => None,
        1 => Some(format!("1 {what}")),
        _ => Some(format!("{count} {what}s")),
    };
    let parts = [some(count(Severity::Error), "error"), some(count(Severity::Warning), "warning")];
    let text = parts.into_iter().flatten().collect::<Vec<_>>().join(", ");
    if text.is_empty() { "ok".to_owned() } else { text }
}

/// Checks one file; returns what it holds.
fn check(
    path: &str,
    arguments: &Check,
    routed: &Routed,
    stdin: &[u8],
    sources: &mut Sources<'_>,
    sink: &mut Sink<'_>,
) -> Result<Held, Failure> {
    let from = arguments.reading.from.as_deref();
    let reader = reader_of(path, from.or_else(|| (path == "-").then(|| likely(stdin))))?;
    if reader.name == crochet::READER.name && arguments.against.is_none() {
        let conventions = &routed.options.conventions;
        if arguments.fix {
            mend(path, conventions)?;
        }
        let source = files::open(sources, path, stdin)?;
        return Ok(Held::parts(written(&source, conventions, routed.hand.as_ref(), sink)));
    }
    let source = files::open(sources, path, stdin)?;
    let input = picot::read(&source, reader, &routed.options, sources, sink);
    if let (Some(shape), Some(Input::Program(_) | Input::Shape(_))) = (&arguments.against, &input) {
        return Err(Failure::usage(format!("`{path}` is no machine code to compare with `{shape}`")));
    }
    match input {
        Some(Input::Code(code)) => {
            let named = code.header("Machine").and_then(Machine::named);
            let machine = routed.machine.as_ref().or(named.as_ref());
            let before = sink.errors();
            let run = machine::execute(&code, machine, sink).report;
            let sound = sink.errors() == before;
            if let (true, Some(shape)) = (sound, &arguments.against) {
                let reader = reader_of(shape, None)?;
                let source = files::open(sources, shape, stdin)?;
                if let Some(program) = picot::compile(&source, reader, &routed.options, sources, sink) {
                    validate(&program, &code, machine, &lowering(routed), sink);
                }
            }
            let name = machine.map(|machine| machine.name.clone());
            Ok(Held { parts: Vec::new(), run: Some((run, name)) })
        }
        Some(Input::Program(program)) => {
            if let (Some(verified), Some(hand)) = (verify(&program, sink), &routed.hand) {
                hand.makes(&verified, sink);
            }
            Ok(Held::parts(parts(&program)))
        }
        Some(Input::Shape(_)) | None => Ok(Held::default()),
    }
}

/// How the program was lowered, as far as the options say.
fn lowering(routed: &Routed) -> Options {
    let said = |key: &str| {
        let value = routed.tables.first().and_then(|table| table.get(key));
        value.and_then(toml::Value::as_bool).unwrap_or(false)
    };
    Options { approximate: said("approximate"), no_waste: said("no-waste") }
}

/// The reader of text that comes without a name: the marks of machine code and XML stand at its very start.
fn likely(text: &[u8]) -> &'static str {
    if text.starts_with(b";!knitout") {
        "knitout"
    } else if text.trim_ascii_start().starts_with(b"<") {
        "xml"
    } else {
        crochet::READER.name
    }
}

/// Checks a written pattern row by row; its rounds are counted as far as they can be read.
fn written(
    source: &Source,
    conventions: &Conventions,
    hand: Option<&Hand>,
    sink: &mut Sink<'_>,
) -> Vec<PartRounds> {
    let Some(document) = Document::parse(source, conventions.language, sink) else { return Vec::new() };
    let checked = document.check(conventions, sink);
    let verified = checked.program.as_ref().and_then(|program| verify(program, sink));
    if let (Some(verified), Some(hand)) = (verified, hand) {
        hand.makes(&verified, sink);
    }
    checked.parts
}

/// Applies the certain fixes of a written pattern to its file.
fn mend(path: &str, conventions: &Conventions) -> Result<(), Failure> {
    if path == "-" {
        return Err(Failure::usage("`--fix` needs a file that it can change").help("name the file"));
    }
    let mut sources = Sources::new(&files::load);
    let source = files::open(&mut sources, path, &[])?;
    let Ok(text) = source.text() else { return Ok(()) };
    let (mended, done) = crochet::mend(path, text, conventions);
    if !done.is_empty() {
        files::write_all(&[(Place::File(PathBuf::from(path)), mended.into_bytes())])?;
        for title in done {
            report::print(&format!("{path}: {title}\n"));
        }
    }
    Ok(())
}

fn file(path: &str, held: &Held, found: &[Diagnostic], sources: &Sources<'_>) -> Result<Value, Failure> {
    let positions = Positions::new(sources);
    let ok = found.iter().all(|diagnostic| diagnostic.severity != Severity::Error);
    let diagnostics = found
        .iter()
        .map(|diagnostic| serde_json::to_value(object(diagnostic, &positions)))
        .collect::<Result<Vec<_>, _>>()
        .map_err(|error| Failure::usage(error.to_string()))?;
    let round = |round: &Round| {
        json!({ "label": round.label(), "first": round.first, "last": round.last, "consumes": round.consumes,
            "produces": round.produces, "stated": round.stated })
    };
    let part = |part: &PartRounds| json!({ "name": part.name, "rounds": part.rounds.iter().map(round).collect::<Vec<Value>>() });
    let parts: Vec<Value> = held.parts.iter().map(part).collect();
    let run = held.run_object();
    let mut value = json!({ "path": path, "ok": ok, "parts": parts, "diagnostics": diagnostics });
    if let (Some(run), Some(object)) = (run, value.as_object_mut()) {
        object.insert("run".to_owned(), run);
    }
    Ok(value)
}

/// The rounds of a program that no text was read for.
fn parts(program: &Program) -> Vec<PartRounds> {
    let round = |(first, row): (u32, &Row)| {
        let last = first.saturating_add(row.times.saturating_sub(1));
        let (consumes, produces) = loops(row);
        let stated = row.stated.map(|(count, _)| count);
        let (consumes, produces) = (u32::try_from(consumes).ok(), u32::try_from(produces).ok());
        Round { first, last, consumes, produces, stated }
    };
    let part = |part: &Part| PartRounds {
        name: part.name.clone(),
        rounds: part.numbered_rows().map(round).collect(),
    };
    program.pattern.parts.iter().map(part).collect()
}

/// Loops of the round below, and loops of this round: what goes back is worked into loops of the row itself.
fn loops(row: &Row) -> (i64, i64) {
    let (mut consumes, mut produces, mut forward) = (0_i64, 0_i64, true);
    for step in row.body.steps() {
        match step {
            Step::Work(stitch) if forward => {
                consumes += i64::from(stitch.works);
                produces += i64::from(stitch.makes);
            }
            Step::Work(stitch) => {
                consumes -= i64::from(stitch.makes);
                produces -= i64::from(stitch.works);
            }
            Step::Turn(direction) => forward = direction == Direction::Forward,
            Step::Hold { loops, .. } => consumes += i64::from(loops),
            Step::Leave { .. } | Step::Color(_) => {}
        }
    }
    (consumes, produces)
}
