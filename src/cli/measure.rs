//! `picot measure`: how close the stitches of an input come to its shape.

use super::args::{Algorithm, Measure as Arguments};
use super::build::{rounds, rounds_of};
use super::plan::reader_of;
use super::progress::{Bar, Watch};
use super::report::{self, Report};
use super::route::route;
use super::{Failure, Status, files, print, print_json};
use picot::diag::{Sink, Sources};
use picot::frontend::Input;
use picot::generate::capunaman::Baseline;
use picot::ir::verify::verify;
use picot::metrics::{Measure, Readability, Stats};
use picot::preview::predict::Fit;
use picot::shape::Shape;
use serde_json::{Value, json};
use std::fmt::Write;
use std::time::Duration;

/// What is known of one run of an algorithm.
pub(crate) struct Measured {
    pub(crate) measure: Measure,
    /// Name, rounds and measure of each part.
    pub(crate) parts: Vec<(String, u64, Measure)>,
    pub(crate) rounds: u64,
    pub(crate) readability: Option<Readability>,
    /// The first round that cannot be worked, with 0 for one that is not known.
    pub(crate) unworkable: Option<u64>,
    /// How far the predicted shape is from the target, or why there is none.
    pub(crate) predicted: Option<Result<Fit, String>>,
}

pub(crate) fn run(arguments: &Arguments, report: Report) -> Result<Status, Failure> {
    if arguments.predict && arguments.algorithm == Algorithm::Capunaman {
        return Err(Failure::usage("only patterns by picot can be predicted").help("leave out --algorithm"));
    }
    let reader = reader_of(&arguments.input, arguments.reading.from.as_deref())?;
    let routed = route(&arguments.reading, &[])?;
    let stdin = files::stdin_if_named([&arguments.input].into_iter())?;
    let bar = Bar::new(1, report.quiet());
    let watch = Watch::new(Some(&bar));
    let mut sources = Sources::new(&files::load);
    let mut sink = Sink::with_observer(&watch);
    let source = files::open(&mut sources, &arguments.input, &stdin)?;
    let mut options = routed.options;
    options.generate.settle = arguments.relaxed;
    let input = picot::read(&source, reader, &options, &mut sources, &mut sink);
    let measured = match &input {
        Some(Input::Shape(shape)) => {
            measure(shape, arguments.algorithm, arguments.predict, &options, &mut sink)
                .map(|measured| (shape, measured))
        }
        Some(other @ (Input::Program(_) | Input::Code(_))) => {
            let what = if matches!(other, Input::Code(_)) { "machine code" } else { "a pattern" };
            return Err(Failure::usage(format!("`{}` is {what}, not a shape", arguments.input))
                .help("what is measured is how stitches lie on a shape"));
        }
        None => None,
    };
    bar.clear();
    report::print(&report.render(&sources, sink.diagnostics()));
    let Some((shape, measured)) = measured else {
        return Ok(Status::InputErrors);
    };
    let times = watch.times();
    if arguments.json {
        return print_json(&to_json(shape, arguments.algorithm, &measured, &times)?);
    }
    print(table(shape, arguments.algorithm, &measured, &times).as_bytes())
}

/// Lays stitches on a shape and measures them; those of other algorithms are settled first where the options say so.
pub(crate) fn measure(
    shape: &Shape,
    algorithm: Algorithm,
    predict: bool,
    options: &picot::Options,
    sink: &mut Sink<'_>,
) -> Option<Measured> {
    match algorithm {
        Algorithm::Picot | Algorithm::Paper => {
            let mut options = options.clone();
            options.generate.paper = algorithm == Algorithm::Paper;
            let program = picot::program(shape, &options, sink)?;
            sink.stage("verify");
            let mut findings = Sink::new();
            let verified = verify(&program, &mut findings);
            let workable = verified.is_some();
            let fit = |verified| match picot::predict(&verified, sink) {
                Ok(fit) => fit.ok_or_else(|| "there is nothing to compare".to_owned()),
                Err(refused) => Err(refused.to_string()),
            };
            let predicted = verified.filter(|_| predict).map(fit);
            let round = findings.diagnostics().iter().find_map(|finding| finding.place.as_ref()?.round);
            for finding in findings.take() {
                sink.push(finding);
            }
            sink.stage("measure");
            Some(Measured {
                measure: picot::measure(shape, &program),
                parts: picot::measure_parts(shape, &program)
                    .into_iter()
                    .zip(&program.pattern.parts)
                    .map(|(measure, part)| (part.name.clone(), rounds_of(part), measure))
                    .collect(),
                rounds: rounds(&program),
                readability: Some(Readability::of(&program.pattern, &program.graphs)),
                unworkable: (!workable).then(|| u64::from(round.unwrap_or(0))),
                predicted,
            })
        }
        Algorithm::Capunaman => {
            let mut nets = picot::baseline(shape, sink)?;
            if options.generate.settle {
                picot::settle_baseline(shape, &mut nets, options);
            }
            sink.stage("measure");
            Some(Measured {
                measure: picot::measure_baseline(shape, &nets),
                parts: picot::measure_baseline_parts(shape, &nets)
                    .into_iter()
                    .zip(shape.tubes.iter().zip(&nets))
                    .map(|(measure, (tube, net))| (tube.name.clone(), baseline_rounds(net), measure))
                    .collect(),
                rounds: nets.iter().map(baseline_rounds).sum(),
                readability: None,
                unworkable: nets.iter().find_map(Baseline::unworkable_row).map(|row| row as u64),
                predicted: None,
            })
        }
    }
}

/// Rows of a baseline net that are worked into another one.
fn baseline_rounds(net: &Baseline) -> u64 {
    net.rows.len().saturating_sub(2) as u64
}

pub(crate) fn name(algorithm: Algorithm) -> &'static str {
    match algorithm {
        Algorithm::Picot => "picot",
        Algorithm::Paper => "paper",
        Algorithm::Capunaman => "capunaman",
    }
}

fn to_json(
    shape: &Shape,
    algorithm: Algorithm,
    measured: &Measured,
    times: &[(&'static str, Duration)],
) -> Result<Value, Failure> {
    let mut value = json!({
        "schema": "picot.measure/1",
        "name": shape.name,
        "algorithm": name(algorithm),
        "version": env!("CARGO_PKG_VERSION"),
        "gauge": { "width": shape.gauge.width, "height": shape.gauge.height, "estimated": shape.gauge.estimated() },
        "time_ms": times.iter().map(|(stage, time)| ((*stage).to_owned(), milliseconds(*time))).collect::<serde_json::Map<_, _>>(),
    });
    let facts = facts(measured)?;
    if let (Value::Object(value), Value::Object(facts)) = (&mut value, facts) {
        value.extend(facts);
    }
    Ok(value)
}

/// Counts and metrics as JSON.
pub(crate) fn facts(measured: &Measured) -> Result<Value, Failure> {
    let wrong = |error| Failure::file("the measures", std::io::Error::other::<serde_json::Error>(error));
    let mut value = serde_json::to_value(&measured.measure).map_err(wrong)?;
    value["rounds"] = measured.rounds.into();
    value["workable"] = measured.unworkable.is_none().into();
    if let Some(round) = measured.unworkable {
        value["unworkable_round"] = round.into();
    }
    let mut parts = Vec::new();
    for (name, rounds, measure) in &measured.parts {
        let mut part = json!({ "name": name, "rounds": rounds });
        if let (Value::Object(part), Value::Object(facts)) =
            (&mut part, serde_json::to_value(measure).map_err(wrong)?)
        {
            part.extend(facts);
        }
        parts.push(part);
    }
    value["parts"] = parts.into();
    if let Some(predicted) = &measured.predicted {
        value["predict"] = match predicted {
            Ok(fit) if fit.rest.converged => json!({
                "converged": true, "chamfer": fit.chamfer, "hausdorff": fit.hausdorff, "rms": fit.rms,
                "residual": fit.rest.residual, "strain": fit.rest.strain, "steps": fit.rest.steps,
            }),
            Ok(fit) => json!({ "converged": false, "residual": fit.rest.residual, "steps": fit.rest.steps }),
            Err(why) => json!({ "converged": false, "refused": why }),
        };
    }
    if let Some(readability) = &measured.readability {
        value["readability"] = serde_json::to_value(readability).map_err(wrong)?;
    }
    Ok(value)
}

pub(crate) fn milliseconds(time: Duration) -> Value {
    json!((time.as_secs_f64() * 1e6).round() / 1e3)
}

/// The line about the shape predicted from the pattern alone; empty when none was asked for.
fn predicted(measured: &Measured) -> String {
    match &measured.predicted {
        None => String::new(),
        Some(Ok(fit)) if fit.rest.converged => format!(
            "predicted {:.2} stitch heights from the target in the mean, {:.2} at most (residual {:.1e}, strain {:.1} %)\n",
            fit.chamfer,
            fit.hausdorff,
            fit.rest.residual,
            100.0 * fit.rest.strain
        ),
        Some(Ok(fit)) => format!(
            "predicted not converged (residual {:.1e} after {} steps)\n",
            fit.rest.residual, fit.rest.steps
        ),
        Some(Err(why)) => format!("predicted no: {why}\n"),
    }
}

fn table(
    shape: &Shape,
    algorithm: Algorithm,
    measured: &Measured,
    times: &[(&'static str, Duration)],
) -> String {
    let Measured { measure, .. } = measured;
    let mut text = String::new();
    let _ = writeln!(
        text,
        "{} by {}: {} rounds, {} stitches, {} short rows, {} increases, {} decreases",
        shape.name,
        name(algorithm),
        measured.rounds,
        measure.stitches,
        measure.short_rows,
        measure.increases,
        measure.decreases
    );
    let _ = writeln!(
        text,
        "\n{:<28}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}",
        "percent", "mean", "sd", "|mean|", "rms", "p95", "max", "count"
    );
    let mut line = |name: &str, stats: &Stats| {
        if stats.count > 0 {
            let _ = write!(text, "{name:<28}{:>+8.2}", 100.0 * stats.mean);
            for value in [stats.sd, stats.mean_abs, stats.rms, stats.p95, stats.max] {
                let _ = write!(text, "{:>8.2}", 100.0 * value);
            }
            let _ = writeln!(text, "{:>8}", stats.count);
        }
    };
    let (length, skew) = (&measure.length_error, &measure.skew);
    line("length error", &length.chord);
    line("  along the yarn", &length.course.chord);
    line("  from row to row", &length.wale.chord);
    line("  steps at short rows", &length.step.chord);
    line("length error on the surface", &length.surface);
    line("length error as in the paper", &length.paper.all);
    line("skew", &skew.all);
    line("  stitch beside stitch", &skew.quad);
    line("  increases", &skew.inc);
    line("  decreases", &skew.dec);
    line("  steps at short rows", &skew.step);
    line("  turns", &skew.turn);
    line("skew as in the paper", &skew.paper);
    if measured.parts.len() > 1 {
        let _ = writeln!(
            text,
            "\n{:<28}{:>8}{:>8}{:>8}{:>8}{:>8}",
            "part by part", "rounds", "stitches", "length", "skew", "covered"
        );
        for (name, rounds, part) in &measured.parts {
            let name: String = name.chars().take(27).collect();
            let _ = writeln!(
                text,
                "{name:<28}{rounds:>8}{:>8}{:>8.2}{:>8.2}{:>8.1}",
                part.stitches,
                100.0 * part.length_error.chord.mean_abs,
                100.0 * part.skew.all.mean,
                100.0 * part.coverage
            );
        }
    }
    let _ = writeln!(
        text,
        "\ncoverage  {:.1} % by area, {:.1} % by count",
        100.0 * measure.coverage,
        100.0 * measure.coverage_by_count
    );
    let _ = writeln!(
        text,
        "level     {:+.2} rows missing at the end, spread {:.2}",
        measure.level.missing, measure.level.spread
    );
    if let Some(read) = &measured.readability {
        let _ = writeln!(
            text,
            "reading   {:.2} words a stitch, at most {} a round, longest run {}, {:.0} % of increases stacked ({:.0} % of those with room), shaping uneven by {:.2}",
            read.words_per_stitch,
            read.most_words,
            read.longest_run,
            100.0 * read.stacked_increases,
            100.0 * read.stacked_by_choice,
            read.uneven_shaping
        );
    }
    text.push_str(&predicted(measured));
    let workable = match measured.unworkable {
        None => "yes".to_owned(),
        Some(0) => "no".to_owned(),
        Some(round) => format!("no, round {round}"),
    };
    let _ = writeln!(text, "workable  {workable}");
    if measure.inverted_tiles + measure.crossings > 0 {
        let _ = writeln!(
            text,
            "flaws     {} inverted tiles, {} crossing wales",
            measure.inverted_tiles, measure.crossings
        );
    }
    let stages: Vec<String> =
        times.iter().map(|(stage, time)| format!("{stage} {:.1}", time.as_secs_f64() * 1e3)).collect();
    let _ = writeln!(text, "time, ms  {}", stages.join(", "));
    text
}
