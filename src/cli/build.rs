//! `picot build`: inputs to targets. Every output is computed before any is written.

use super::args::{Build, Level};
use super::files::{self, Place};
use super::progress::{Bar, Watch};
use super::report::{self, Report};
use super::route::{Routed, route};
use super::{Failure, Status};
use picot::backends::{self, TARGETS, Target, target, target_for_extension};
use picot::diag::{Sink, Sources, did_you_mean};
use picot::frontend::{READERS, Reader, reader, reader_for_extension};
use picot::ir::verify::{Verified, verify};
use picot::ir::{Part, Program};
use rayon::prelude::*;
use std::fmt::Write;
use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};

/// One input with how to read it and what it becomes.
#[derive(Debug)]
pub(crate) struct Job {
    pub(crate) input: String,
    pub(crate) reader: &'static Reader,
    /// Index of the target in [`Plan::targets`], and the place.
    pub(crate) outputs: Vec<(usize, Place)>,
}

/// All that a run will do.
#[derive(Debug)]
struct Plan {
    targets: Vec<&'static Target>,
    jobs: Vec<Job>,
}

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
    let Some(program) = picot::compile(&source, job.reader, &routed.options, sources, sink) else {
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
    sink.stage("emit");
    for (index, _) in &job.outputs {
        let target = plan.targets[*index];
        let backend = target
            .configure(routed.tables[*index].clone())
            .map_err(|error| Failure::usage(error.message().to_owned()))?;
        let mut bytes = Vec::new();
        backend.emit(&verified, &mut bytes, sink).map_err(|error| match error {
            backends::Error::Io(error) => Failure::file(&job.input, error),
            backends::Error::Unsupported { .. } => {
                Failure::Impossible { message: format!("{}: {error}", job.input), help: None }
            }
        })?;
        done.outputs.push(bytes);
    }
    done.summary = summary(&verified);
    Ok(())
}

fn plan(arguments: &Build) -> Result<Plan, Failure> {
    let mut plan = Plan { targets: Vec::new(), jobs: Vec::new() };
    for (index, input) in arguments.inputs.iter().enumerate() {
        if arguments.inputs[..index].contains(input) {
            return Err(Failure::usage(format!("input `{input}` is named twice")));
        }
        let reader = reader_of(input, arguments.reading.from.as_deref())?;
        plan.jobs.push(Job { input: input.clone(), reader, outputs: Vec::new() });
    }
    if arguments.dump.is_some() {
        if arguments.inputs.len() > 1 {
            return Err(Failure::usage("--dump takes one input"));
        }
        plan.jobs[0].outputs.push((0, Place::Stdout));
        return Ok(plan);
    }
    let pairs = pair(arguments)?;
    for (target, output) in pairs {
        let index = plan.targets.len();
        plan.targets.push(target);
        for job in &mut plan.jobs {
            let place = match output {
                None | Some("-") => Place::Stdout,
                Some(path) if is_directory(path) => Place::File(inside(path, &job.input, target)),
                Some(path) => Place::File(PathBuf::from(path)),
            };
            job.outputs.push((index, place));
        }
    }
    check_places(&plan)?;
    Ok(plan)
}

/// Each output with its target: named by `--to`, else by the extension; without `-o` one target goes to stdout.
fn pair(arguments: &Build) -> Result<Vec<(&'static Target, Option<&str>)>, Failure> {
    let named = arguments
        .to
        .iter()
        .map(|name| target(name).ok_or_else(|| Failure::usage(format!("there is no target `{name}`"))))
        .collect::<Result<Vec<_>, _>>()?;
    if arguments.output.is_empty() {
        return match named.as_slice() {
            [] => Ok(vec![(
                target("crochet")
                    .ok_or_else(|| Failure::usage("no target is named").help("add --to TARGET"))?,
                None,
            )]),
            [one] => Ok(vec![(one, None)]),
            _ => Err(Failure::usage("two targets cannot both go to stdout").help("add -o FILE for each")),
        };
    }
    let mut free = named.clone();
    let mut pairs: Vec<(Option<&'static Target>, &str)> = Vec::new();
    for output in &arguments.output {
        let by_extension = extension(output).and_then(target_for_extension);
        let claimed = by_extension
            .and_then(|target| free.iter().position(|other| other.name == target.name))
            .filter(|_| !is_directory(output));
        pairs.push((claimed.map(|index| free.remove(index)), output));
    }
    let mut all = Vec::new();
    for (claimed, output) in pairs {
        if is_directory(output) {
            let targets =
                if named.is_empty() { target("crochet").into_iter().collect() } else { named.clone() };
            free.clear();
            all.extend(targets.into_iter().map(|target| (target, Some(output))));
            continue;
        }
        let target = match claimed {
            Some(target) => target,
            None if !free.is_empty() => free.remove(0),
            None => by_name(output)?,
        };
        all.push((target, Some(output)));
    }
    if let Some(target) = free.first() {
        return Err(
            Failure::usage(format!("--to {} has no output", target.name)).help("add -o FILE for each")
        );
    }
    Ok(all)
}

fn by_name(output: &str) -> Result<&'static Target, Failure> {
    if output == "-" {
        return target("crochet").ok_or_else(|| Failure::usage("stdout needs --to TARGET"));
    }
    let Some(extension) = extension(output) else {
        return Err(Failure::usage(format!("`{output}` has no extension that names a target"))
            .help(format!("add --to with one of {}", names(TARGETS.iter().map(|target| target.name)))));
    };
    target_for_extension(extension).ok_or_else(|| {
        let failure = Failure::usage(format!("no target writes `.{extension}`"));
        match did_you_mean(extension, TARGETS.iter().map(|target| target.extension)) {
            Some(near) => failure.help(format!("did you mean `.{near}`?")),
            None => failure
                .help(format!("add --to with one of {}", names(TARGETS.iter().map(|target| target.name)))),
        }
    })
}

/// The reader for an input: named by `--from`, else by its extension.
pub(crate) fn reader_of(input: &str, from: Option<&str>) -> Result<&'static Reader, Failure> {
    if let Some(name) = from {
        return reader(name).ok_or_else(|| Failure::usage(format!("there is no reader `{name}`")));
    }
    let all = || names(READERS.iter().map(|reader| reader.name));
    if input == "-" {
        return Err(Failure::usage("input `-` needs --from READER").help(format!("one of {}", all())));
    }
    let Some(extension) = extension(input) else {
        return Err(Failure::usage(format!("`{input}` has no extension that names a reader"))
            .help(format!("add --from with one of {}", all())));
    };
    reader_for_extension(extension).ok_or_else(|| {
        let failure = Failure::usage(format!("no reader reads `.{extension}`"));
        match did_you_mean(extension, READERS.iter().flat_map(|reader| reader.extensions).copied()) {
            Some(near) => failure.help(format!("did you mean `.{near}`?")),
            None => failure.help(format!("add --from with one of {}", all())),
        }
    })
}

/// Refuses two outputs in one place, an output over an input, and bytes that would garble a terminal.
fn check_places(plan: &Plan) -> Result<(), Failure> {
    let mut seen = Vec::new();
    for job in &plan.jobs {
        for (index, place) in &job.outputs {
            let target = plan.targets[*index];
            match place {
                Place::Stdout if target.binary && io::stdout().is_terminal() => {
                    return Err(Failure::usage(format!(
                        "{} is binary and stdout is a terminal",
                        target.name
                    ))
                    .help(format!("add -o FILE.{}", target.extension)));
                }
                Place::File(path) => {
                    if let Some(input) =
                        plan.jobs.iter().find(|job| files::same_file(Path::new(&job.input), path))
                    {
                        return Err(Failure::usage(format!("output `{}` is an input", path.display()))
                            .help(format!("`{}` would be overwritten; choose another name", input.input)));
                    }
                }
                Place::Stdout => {}
            }
            seen.push(place);
        }
    }
    seen.sort();
    for pair in seen.windows(2) {
        if pair[0] == pair[1] {
            return Err(match pair[0] {
                Place::Stdout => Failure::usage("two outputs cannot both go to stdout")
                    .help("add -o DIRECTORY/ for one file for each input"),
                Place::File(path) => Failure::usage(format!("two outputs are named `{}`", path.display())),
            });
        }
    }
    Ok(())
}

fn extension(path: &str) -> Option<&str> {
    Path::new(path).extension()?.to_str()
}

fn is_directory(path: &str) -> bool {
    path.ends_with(['/', std::path::MAIN_SEPARATOR]) || Path::new(path).is_dir()
}

fn inside(directory: &str, input: &str, target: &Target) -> PathBuf {
    let stem = Path::new(input).file_stem().filter(|_| input != "-");
    let mut name = stem.map_or_else(|| "stdin".into(), std::ffi::OsStr::to_owned);
    name.push(".");
    name.push(target.extension);
    Path::new(directory).join(name)
}

fn names<'n>(all: impl Iterator<Item = &'n str>) -> String {
    all.collect::<Vec<_>>().join(", ")
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
    let of = |part: &Part| {
        let rows: u64 = part.rows.iter().map(|row| u64::from(row.times)).sum();
        rows + u64::from(part.first_number()) - 1
    };
    program.pattern.parts.iter().map(of).sum()
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
