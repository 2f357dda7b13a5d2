//! `picot build`: inputs to targets. Every output is computed before any is written.

use super::args::{Build, Level};
use super::files::{self, Place};
use super::plan::{Job, Plan, plan};
use super::progress::{Bar, Watch};
use super::report::{self, Report};
use super::route::{Routed, route};
use super::{Failure, Status};
use picot::backends;
use picot::diag::{Sink, Sources};
use picot::frontend::Input;
use picot::ir::machine;
use picot::ir::verify::{Verified, verify};
use picot::ir::{Part, Program};
use rayon::prelude::*;
use std::fmt::Write;
use std::path::Path;

/// What became of one input.
struct Done {
    status: Status,
    /// Diagnostics, rendered.
    messages: String,
    /// In the order of [`Job::outputs`].
    outputs: Vec<Vec<u8>>,
    summary: String,
    timings: String,
    failure: Option<Failure>,
}

pub(crate) fn run(arguments: &Build, report: Report) -> Result<Status, Failure> {
    let plan = plan(arguments)?;
    let routed = route(&arguments.reading, &plan.targets)?;
    let stdin = files::stdin_if_named(arguments.inputs.iter())?;
    let bar = Bar::new(plan.jobs.len() as u64, report.quiet());
    let results: Vec<Done> = if let [job] = plan.jobs.as_slice() {
        let watch = Watch::new(Some(&bar));
        vec![compile(job, &plan, &routed, arguments, &stdin, &watch, report)]
    } else {
        let work = |job: &Job| {
            let done = compile(job, &plan, &routed, arguments, &stdin, &Watch::new(None), report);
            bar.advance(&job.input);
            done
        };
        plan.jobs.par_iter().map(work).collect()
    };
    bar.clear();

    let mut status = Status::Fine;
    for (job, done) in plan.jobs.iter().zip(&results) {
        report::print(&done.messages);
        if let Some(failure) = &done.failure {
            report.failure(failure);
        }
        if arguments.timings && done.status == Status::Fine {
            report::print(&format!("{}\n{}", job.input, done.timings));
        }
        status = status.max(done.status);
    }
    if status != Status::Fine {
        if plan.jobs.len() > 1 {
            let failed = results.iter().filter(|done| done.status != Status::Fine).count();
            report::print(&format!("{failed} of {} inputs failed; nothing is written\n", plan.jobs.len()));
        }
        return Ok(status);
    }
    let mut writes = Vec::new();
    let mut summaries = Vec::new();
    for (job, done) in plan.jobs.iter().zip(results) {
        writes.extend(job.outputs.iter().map(|(_, place)| place.clone()).zip(done.outputs));
        summaries.push(done.summary);
    }
    files::write_all(&writes)?;
    if arguments.dump.is_none() {
        for summary in summaries {
            report.remark(&summary);
        }
        report.remark(&format!("Next: {}", next(&plan)));
    }
    Ok(Status::Fine)
}

/// Targets that are looked at.
const PREVIEWS: [&str; 5] = ["html", "png", "stl", "gltf", "obj"];

/// `picot preview`: a build to what is looked at.
pub(crate) fn preview(arguments: &Build, report: Report) -> Result<Status, Failure> {
    if arguments.output.is_empty() {
        return Err(Failure::usage("a preview needs a file").help("add -o FILE.png"));
    }
    let plan = plan(arguments)?;
    if let Some(target) = plan.targets.iter().find(|target| !PREVIEWS.contains(&target.name)) {
        return Err(Failure::usage(format!("{} is no preview", target.name))
            .help(format!("`picot build` writes .{}", target.extension)));
    }
    run(arguments, report)
}

/// One input through all stages to the bytes of its outputs.
fn compile(
    job: &Job,
    plan: &Plan,
    routed: &Routed,
    arguments: &Build,
    stdin: &[u8],
    watch: &Watch<'_>,
    report: Report,
) -> Done {
    let mut done = Done {
        status: Status::Fine,
        messages: String::new(),
        outputs: Vec::new(),
        summary: String::new(),
        timings: String::new(),
        failure: None,
    };
    let mut sources = Sources::new(&files::load);
    let mut sink = Sink::with_observer(watch);
    let outcome = stages(job, plan, routed, arguments, stdin, &mut sources, &mut sink, &mut done);
    if let Err(failure) = outcome {
        done.status = failure.status();
        done.failure = Some(failure);
    } else if sink.has_errors() {
        done.status = Status::InputErrors;
    }
    done.messages = report.render(&sources, sink.diagnostics());
    done.timings = watch.table();
    done
}

#[expect(clippy::too_many_arguments, reason = "the stages of one run, joined in one place")]
fn stages(
    job: &Job,
    plan: &Plan,
    routed: &Routed,
    arguments: &Build,
    stdin: &[u8],
    sources: &mut Sources<'_>,
    sink: &mut Sink<'_>,
    done: &mut Done,
) -> Result<(), Failure> {
    let source = files::open(sources, &job.input, stdin)?;
    let Some(input) = picot::read(&source, job.reader, &routed.options, sources, sink) else {
        return Ok(());
    };
    if let (Input::Code(code), None) = (&input, arguments.dump) {
        return convert(code, job, plan, routed, sink, done);
    }
    let Some(program) = picot::compile_input(input, &source, &routed.options, sink) else {
        return Ok(());
    };
    if let Some(level) = arguments.dump {
        let text = match level {
            Level::Graph => format!("{:#?}\n", program.graphs),
            Level::Pattern => format!("{:#?}\n", program.pattern),
        };
        done.outputs.push(text.into_bytes());
        return Ok(());
    }
    sink.stage("verify");
    let Some(verified) = verify(&program, sink) else {
        return Ok(());
    };
    if let Some(hand) = &routed.hand
        && !hand.makes(&verified, sink)
    {
        let message = format!("{}: `{}` cannot make this", job.input, hand.name);
        return Err(Failure::Impossible { message, help: None });
    }
    sink.stage("emit");
    for (index, _) in &job.outputs {
        let target = plan.targets[*index];
        let backend = target
            .configure(routed.tables[*index].clone())
            .map_err(|error| Failure::usage(error.message().to_owned()))?;
        let mut bytes = Vec::new();
        backend.emit(&verified, &mut bytes, sink).map_err(|error| failure(&job.input, error))?;
        done.outputs.push(bytes);
    }
    done.summary = summary(&verified);
    Ok(())
}

fn failure(input: &str, error: backends::Error) -> Failure {
    match error {
        backends::Error::Io(error) => Failure::file(input, error),
        backends::Error::Unsupported { .. } => {
            Failure::Impossible { message: format!("{input}: {error}"), help: None }
        }
    }
}

/// Machine code from one format to another: it is executed first, and must be sound.
fn convert(
    code: &machine::Code,
    job: &Job,
    plan: &Plan,
    routed: &Routed,
    sink: &mut Sink<'_>,
    done: &mut Done,
) -> Result<(), Failure> {
    sink.stage("execute");
    let named = code.header("Machine").and_then(machine::Machine::named);
    let Some(checked) = machine::check(code, routed.machine.as_ref().or(named.as_ref()), sink) else {
        return Ok(());
    };
    sink.stage("emit");
    for (index, _) in &job.outputs {
        let backend = plan.targets[*index]
            .configure(routed.tables[*index].clone())
            .map_err(|error| Failure::usage(error.message().to_owned()))?;
        let mut bytes = Vec::new();
        backend.emit_code(&checked, &mut bytes, sink).map_err(|error| failure(&job.input, error))?;
        done.outputs.push(bytes);
    }
    let report = checked.report();
    done.summary = format!("{}: {} loops, {} passes", job.input, report.loops, report.passes);
    Ok(())
}

/// Rounds, stitches and yarn, for the last lines of a run.
pub(crate) fn summary(program: &Verified<'_>) -> String {
    let facts = program.facts();
    let mut text =
        format!("{}: {} rounds, {} stitches", program.name, rounds(program), facts.stitches(program));
    if let Some(gauge) = program.gauge {
        let _ = write!(text, ", about {:.0} m of yarn", facts.yarn(program, gauge.width) / 1000.0);
        if gauge.estimated() {
            text.push_str(" (the gauge is an estimate)");
        }
    }
    text
}

/// Rounds of all parts, each part once.
pub(crate) fn rounds(program: &Program) -> u64 {
    program.pattern.parts.iter().map(rounds_of).sum()
}

/// Rounds of a part.
pub(crate) fn rounds_of(part: &Part) -> u64 {
    let rows: u64 = part.rows.iter().map(|row| u64::from(row.times)).sum();
    rows + u64::from(part.first_number()) - 1
}

/// What a person would do now.
fn next(plan: &Plan) -> String {
    let first = plan.jobs.iter().flat_map(|job| &job.outputs).find_map(|(_, place)| match place {
        Place::File(path) => Some(path),
        Place::Stdout => None,
    });
    match (first, plan.jobs.first()) {
        (Some(path), _) => format!("open {}", path.display()),
        (None, Some(job)) if job.input != "-" => {
            let stem = Path::new(&job.input).file_stem().unwrap_or_default().to_string_lossy();
            format!("picot build {} -o {stem}.txt", job.input)
        }
        _ => "add -o FILE.txt to keep it".to_owned(),
    }
}
