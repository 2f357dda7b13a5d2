//! `picot bench`: times of every stage, and the paper's tables beside our numbers.

mod fidelity;
mod printed;
mod reading;
mod scale;
mod tables;

use super::args::{Algorithm, Bench};
use super::files::{self, Place};
use super::measure::{self, Measured, milliseconds};
use super::progress::{Bar, Watch, now};
use super::report::{self, Report};
use super::{Failure, Status, print, print_json};
use picot::backends::target;
use picot::diag::{Sink, Sources};
use picot::frontend::{Input, reader};
use picot::ir::{Gauge, verify::verify};
use picot::shape::Shape;
use printed::{NOTES, PRINTED, Printed};
use serde_json::{Value, json};
use std::path::PathBuf;
use std::time::Duration;

/// Runs of each case, where nothing else is asked.
const RUNS: u32 = 20;
/// Stitch sizes of the paper in mm.
const SIZES: [f64; 3] = [2.5, 2.0, 1.5];

/// One shape at one stitch size.
struct Case {
    printed: &'static Printed,
    size: f64,
    picot: Measured,
    baseline: Measured,
    /// Our stitches before they settle.
    unsettled: Measured,
    /// The baseline settled as ours are.
    baseline_settled: Measured,
    /// The rules of the paper's text, as laid and settled.
    paper: [Measured; 2],
    /// Median time of each stage.
    stages: Vec<(&'static str, Duration)>,
    /// Median time of a whole run, from the text of the shape to the text of the pattern.
    total: Duration,
    baseline_time: Duration,
}

impl Case {
    /// Time of the generator.
    fn generate(&self) -> Duration {
        self.stages.iter().filter(|(stage, _)| is_generator(stage)).map(|(_, time)| *time).sum()
    }

    /// Microseconds a stitch.
    fn per_stitch(&self, time: Duration) -> f64 {
        per_stitch(time, self.picot.measure.stitches as u64)
    }
}

/// Microseconds a stitch.
fn per_stitch(time: Duration, stitches: u64) -> f64 {
    time.as_secs_f64() * 1e6 / stitches.max(1) as f64
}

/// The generator announces stages of its own between those of the pipeline.
fn is_generator(stage: &str) -> bool {
    !matches!(stage, "read" | "trace" | "passes" | "verify" | "emit")
}

pub(crate) fn run(arguments: &Bench, report: Report) -> Result<Status, Failure> {
    if !arguments.readability.is_empty() {
        return reading::run(&arguments.readability, arguments.json.as_deref(), report);
    }
    if let Some(most) = arguments.scale {
        return scale::run(most, arguments.runs, arguments.json.as_deref(), report);
    }
    let runs = arguments.runs.unwrap_or(RUNS);
    let bar = Bar::new((PRINTED.len() * SIZES.len()) as u64, report.quiet());
    let mut cases = Vec::new();
    for printed in &PRINTED {
        for size in SIZES {
            cases.push(case(printed, size, runs, report)?);
            bar.advance(printed.name);
        }
    }
    let fidelity = if arguments.paper { fidelity::rows()? } else { Vec::new() };
    bar.clear();
    let machine = machine();
    let json = arguments.json.as_deref();
    if let Some(status) = write_json(json, || to_json(&cases, &fidelity, runs, &machine))? {
        return Ok(status);
    }
    let text = if arguments.paper {
        format!("{}{}", fidelity::table(&fidelity), tables::paper(&cases))
    } else {
        tables::times(&cases)
    };
    print(format!("{text}\n{}\n", footer("medians", &format!("{runs} runs"), &machine)).as_bytes())
}

/// What the times are, and of what they were taken.
fn footer(what: &str, of: &str, machine: &str) -> String {
    let build = if cfg!(debug_assertions) { "debug build: times say little; " } else { "" };
    format!("{build}{what} of {of} on {machine}")
}

/// Writes JSON where it is asked for; where that is stdout, nothing else goes there, and the status of that is returned.
fn write_json(
    path: Option<&str>,
    value: impl FnOnce() -> Result<Value, Failure>,
) -> Result<Option<Status>, Failure> {
    let Some(path) = path else { return Ok(None) };
    let value = value()?;
    if path == "-" {
        return print_json(&value).map(Some);
    }
    files::write_all(&[(Place::File(PathBuf::from(path)), format!("{value:#}\n").into_bytes())])?;
    Ok(None)
}

fn case(printed: &'static Printed, size: f64, runs: u32, report: Report) -> Result<Case, Failure> {
    let options = picot::Options { gauge: Some(Gauge::new(size, size)), ..picot::Options::default() };
    let mut stages: Vec<(&'static str, Vec<Duration>)> = Vec::new();
    let mut totals = Vec::new();
    for _ in 0..runs {
        let watch = Watch::new(None);
        let begin = now();
        whole(printed, &options, &watch, report)?;
        totals.push(begin.elapsed());
        for (stage, time) in watch.times() {
            match stages.iter_mut().find(|(known, _)| *known == stage) {
                Some((_, times)) => times.push(time),
                None => stages.push((stage, vec![time])),
            }
        }
    }
    let mut sink = Sink::new();
    let shape = shape(printed, &options, &mut sink).ok_or_else(|| broken(printed))?;
    let mut baseline_times = Vec::new();
    for _ in 0..runs {
        let begin = now();
        picot::baseline(&shape, &mut sink).ok_or_else(|| broken(printed))?;
        baseline_times.push(begin.elapsed());
    }
    let mut measured = |algorithm, settle| {
        let mut options = options.clone();
        options.generate.settle = settle;
        if algorithm == Algorithm::Picot && !settle {
            options.generate.sweeps = 0;
        }
        measure::measure(&shape, algorithm, false, &options, &mut sink).ok_or_else(|| broken(printed))
    };
    let mut both = |algorithm| Ok([measured(algorithm, false)?, measured(algorithm, true)?]);
    let [baseline, baseline_settled] = both(Algorithm::Capunaman)?;
    let paper = both(Algorithm::Paper)?;
    let [unsettled, picot] = both(Algorithm::Picot)?;
    Ok(Case {
        printed,
        size,
        picot,
        baseline,
        baseline_settled,
        paper,
        unsettled,
        stages: stages.into_iter().map(|(stage, times)| (stage, median(times))).collect(),
        total: median(totals),
        baseline_time: median(baseline_times),
    })
}

/// From the text of the shape to the text of the pattern; the number of its stitches.
fn whole(
    printed: &Printed,
    options: &picot::Options,
    watch: &Watch<'_>,
    report: Report,
) -> Result<u64, Failure> {
    let loader = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    let mut sources = Sources::new(&loader);
    let mut sink = Sink::with_observer(watch);
    let outcome = (|| {
        let source = sources.add(printed.name, printed.source.as_bytes().to_vec()).ok()?;
        let program = picot::compile(&source, reader("shape")?, options, &mut sources, &mut sink)?;
        sink.stage("verify");
        let verified = verify(&program, &mut sink)?;
        sink.stage("emit");
        let backend = target("crochet")?.configure(toml::Table::new()).ok()?;
        let mut text = Vec::new();
        backend.emit(&verified, &mut text, &mut sink).ok()?;
        Some(verified.facts().stitches(&verified))
    })();
    outcome.ok_or_else(|| {
        report::print(&report.render(&sources, sink.diagnostics()));
        broken(printed)
    })
}

fn shape(printed: &Printed, options: &picot::Options, sink: &mut Sink<'_>) -> Option<Box<Shape>> {
    let loader = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    let mut sources = Sources::new(&loader);
    let source = sources.add(printed.name, printed.source.as_bytes().to_vec()).ok()?;
    match picot::read(&source, reader("shape")?, options, &mut sources, sink)? {
        Input::Shape(shape) => Some(shape),
        Input::Program(_) | Input::Code(_) => None,
    }
}

fn broken(printed: &Printed) -> Failure {
    Failure::Impossible {
        message: format!("shape {} does not compile: this is a bug", printed.name),
        help: None,
    }
}

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort_unstable();
    times.get(times.len() / 2).copied().unwrap_or_default()
}

/// What the times were taken on.
#[expect(clippy::disallowed_methods, reason = "times mean nothing without their machine")]
fn machine() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let read = |path| std::fs::read_to_string(path).unwrap_or_default();
    let info = read("/proc/cpuinfo");
    let model = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    let model = model.map_or("an unknown processor", |(_, model)| model.trim());
    let load = read("/proc/loadavg");
    match load.split_whitespace().next() {
        Some(load) => format!("{model}, {cores} cores, load {load}"),
        None => format!("{model}, {cores} cores"),
    }
}

fn to_json(cases: &[Case], fidelity: &[fidelity::Row], runs: u32, machine: &str) -> Result<Value, Failure> {
    let mut list = Vec::new();
    for case in cases {
        let printed = case.printed;
        let by = |rows: &[[f64; 2]; 3]| {
            let row = |row: [f64; 2]| json!({ "mean": row[0] / 100.0, "sd": row[1] });
            json!({ "capunaman": row(rows[0]), "proposed": row(rows[1]), "wu": row(rows[2]) })
        };
        let index = SIZES.iter().position(|size| *size == case.size).unwrap_or(0);
        let time = |scale: f64, row: [f64; 3]| row[index] * scale;
        let stages: serde_json::Map<_, _> =
            case.stages.iter().map(|(stage, time)| ((*stage).to_owned(), milliseconds(*time))).collect();
        list.push(json!({
            "shape": printed.name,
            "stand_in": printed.name.ends_with('\''),
            "stitch_mm": case.size,
            "picot": { "measure": measure::facts(&case.picot)?, "time_ms": stages,
                "generate_ms": milliseconds(case.generate()), "total_ms": milliseconds(case.total),
                "us_per_stitch": case.per_stitch(case.total) },
            "capunaman": { "measure": measure::facts(&case.baseline)?, "generate_ms": milliseconds(case.baseline_time),
                "relaxed": measure::facts(&case.baseline_settled)? },
            "paper": { "measure": measure::facts(&case.paper[0])?, "relaxed": measure::facts(&case.paper[1])? },
            "unrelaxed": measure::facts(&case.unsettled)?,
            "printed": { "length_error": by(&printed.length), "skew": by(&printed.skew),
                "time_ms": { "capunaman": time(1.0, printed.time[0]), "proposed": time(1.0, printed.time[1]),
                    "wu": time(1000.0, printed.time[2]) } },
        }));
    }
    Ok(
        json!({ "schema": "picot.bench/1", "version": env!("CARGO_PKG_VERSION"), "machine": machine, "runs": runs,
        "debug": cfg!(debug_assertions), "notes": NOTES, "cases": list, "fidelity": fidelity::to_json(fidelity)? }),
    )
}
