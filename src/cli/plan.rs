//! What a run of `picot build` will read and write, and with which readers and targets.

use super::Failure;
use super::args::Build;
use super::files::{self, Place};
use picot::backends::{TARGETS, Target, target, target_for_extension};
use picot::diag::did_you_mean;
use picot::frontend::{READERS, Reader, reader, reader_for_extension};
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
pub(crate) struct Plan {
    pub(crate) targets: Vec<&'static Target>,
    pub(crate) jobs: Vec<Job>,
}

/// Settles readers, targets and places before anything is read.
pub(crate) fn plan(arguments: &Build) -> Result<Plan, Failure> {
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
