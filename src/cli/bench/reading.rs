//! What the option `readability` does: words and fidelity of many shapes at five values, as a table for the manual.

use super::super::args::Algorithm;
use super::super::files;
use super::super::measure::{self, Measured};
use super::super::plan::reader_of;
use super::super::progress::Bar;
use super::super::report::Report;
use super::super::{Failure, Status, print};
use picot::diag::{Sink, Sources};
use picot::frontend::Input;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::fmt::Write;

/// The values that are compared.
const VALUES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// A shape at each of the values.
struct Case {
    name: String,
    measured: Vec<Measured>,
}

pub(super) fn run(inputs: &[String], json: Option<&str>, report: Report) -> Result<Status, Failure> {
    let bar = Bar::new(inputs.len() as u64, report.quiet());
    let case = |input: &String| {
        let done = case(input);
        bar.advance(input);
        done
    };
    let cases = inputs.par_iter().map(case).collect::<Result<Vec<_>, _>>()?;
    bar.clear();
    if let Some(status) = super::write_json(json, || to_json(&cases))? {
        return Ok(status);
    }
    print(table(&cases).as_bytes())
}

fn case(input: &str) -> Result<Case, Failure> {
    let reader = reader_of(input, None)?;
    let mut sources = Sources::new(&files::load);
    let mut sink = Sink::new();
    let source = files::open(&mut sources, input, &[])?;
    let broken = || {
        Failure::usage(format!("`{input}` is no shape that can be made")).help("try `picot build` with it")
    };
    let options = picot::Options::default();
    let Some(Input::Shape(shape)) = picot::read(&source, reader, &options, &mut sources, &mut sink) else {
        return Err(broken());
    };
    let at = |value: f64| {
        let mut options = options.clone();
        options.generate.readability = Some(value);
        measure::measure(&shape, Algorithm::Picot, false, &options, &mut Sink::new()).ok_or_else(broken)
    };
    let measured = VALUES.into_iter().map(at).collect::<Result<_, _>>()?;
    Ok(Case { name: shape.name.clone(), measured })
}

/// A column: its head, and what stands in it for one pattern.
type Column = (&'static str, fn(&Measured) -> f64, usize);

const COLUMNS: [Column; 10] = [
    ("words a stitch", |it| reading(it).map_or(0.0, |read| read.words_per_stitch), 4),
    ("equal rounds %", |it| 100.0 * reading(it).map_or(0.0, |read| read.equal_rounds), 1),
    ("stacked %", |it| 100.0 * reading(it).map_or(0.0, |read| read.stacked_increases), 1),
    ("by choice %", |it| 100.0 * reading(it).map_or(0.0, |read| read.stacked_by_choice), 1),
    ("uneven", |it| reading(it).map_or(0.0, |read| read.uneven_shaping), 3),
    ("short rows / 1000", |it| reading(it).map_or(0.0, |read| read.short_rows_per_thousand), 2),
    ("longest run", |it| reading(it).map_or(0.0, |read| f64::from(read.longest_run)), 1),
    ("length %", |it| 100.0 * it.measure.length_error.chord.mean_abs, 2),
    ("skew %", |it| 100.0 * it.measure.skew.all.mean, 2),
    ("coverage", |it| it.measure.coverage, 3),
];

fn reading(measured: &Measured) -> Option<&picot::metrics::Readability> {
    measured.readability.as_ref()
}

/// Means over all shapes.
fn table(cases: &[Case]) -> String {
    let mut text = String::from("| readability |");
    for (head, ..) in COLUMNS {
        let _ = write!(text, " {head} |");
    }
    text.push_str("\n|---|");
    text.push_str(&"---|".repeat(COLUMNS.len()));
    for (index, value) in VALUES.iter().enumerate() {
        let _ = write!(text, "\n| {value} |");
        for (_, of, digits) in COLUMNS {
            let all = cases.iter().filter_map(|case| case.measured.get(index)).map(of);
            let _ = write!(text, " {:.digits$} |", all.sum::<f64>() / cases.len().max(1) as f64);
        }
    }
    let _ = writeln!(text, "\n\nmeans over {} shapes", cases.len());
    text
}

fn to_json(cases: &[Case]) -> Result<Value, Failure> {
    let mut list = Vec::new();
    for case in cases {
        let mut values = Vec::new();
        for (value, measured) in VALUES.iter().zip(&case.measured) {
            values.push(json!({ "readability": value, "measure": measure::facts(measured)? }));
        }
        list.push(json!({ "name": case.name, "values": values }));
    }
    Ok(json!({ "schema": "picot.readability/1", "cases": list }))
}
