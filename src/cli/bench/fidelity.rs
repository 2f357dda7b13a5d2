//! How well our stitches fit shapes C and D of the paper, from its own sizes down to a tenth of them, and for stitches that are
//! lower or higher than wide.

use super::super::args::Algorithm;
use super::super::measure::{self, Measured};
use super::printed::{PRINTED, Printed};
use super::{Failure, SIZES, broken, shape};
use picot::diag::Sink;
use picot::ir::Gauge;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::fmt::Write;

/// Finer stitches than the paper's, in mm.
const FINE: [f64; 3] = [1.0, 0.5, 0.25];
/// Heights of stitches by their widths, beside 1.
const RATIOS: [f64; 2] = [0.7, 1.4];

/// A shape with one gauge.
pub(super) struct Row {
    name: &'static str,
    gauge: Gauge,
    measured: Measured,
}

/// Measures all rows.
pub(super) fn rows() -> Result<Vec<Row>, Failure> {
    let square = SIZES.into_iter().chain(FINE).map(|size| Gauge::new(size, size));
    let others = RATIOS.into_iter().flat_map(|ratio| SIZES.map(|size| Gauge::new(size, ratio * size)));
    let gauges: Vec<Gauge> = square.chain(others).collect();
    let shapes = PRINTED.iter().filter(|printed| !printed.name.ends_with('\''));
    let all: Vec<_> = shapes.flat_map(|shape| gauges.iter().map(move |gauge| (shape, *gauge))).collect();
    all.into_par_iter().map(|(printed, gauge)| row(printed, gauge)).collect()
}

fn row(printed: &'static Printed, gauge: Gauge) -> Result<Row, Failure> {
    let options = picot::Options { gauge: Some(gauge), ..picot::Options::default() };
    let mut sink = Sink::new();
    let shape = shape(printed, &options, &mut sink).ok_or_else(|| broken(printed))?;
    let measured = measure::measure(&shape, Algorithm::Picot, false, &options, &mut sink);
    Ok(Row { name: printed.name, gauge, measured: measured.ok_or_else(|| broken(printed))? })
}

/// The rows as a table, with the means over C and D of each ratio at the paper's sizes.
pub(super) fn table(rows: &[Row]) -> String {
    let mut text =
        String::from("Fidelity: chords of all edges, skew of all tiles, the last round's level in rows\n");
    let _ = writeln!(
        text,
        "{:<6}{:>6}{:>6} |{:>10}{:>10}{:>10}{:>8}{:>8}{:>8}{:>10}{:>10}{:>8}",
        "",
        "cm",
        "h/w",
        "stitches",
        "|e| %",
        "signed %",
        "SD",
        "p95",
        "skew %",
        "coverage",
        "inverted",
        "level"
    );
    for row in rows {
        let measure = &row.measured.measure;
        let chord = &measure.length_error.chord;
        let _ = writeln!(
            text,
            "{:<6}{:>6.3}{:>6.1} |{:>10}{:>10.2}{:>+10.2}{:>8.3}{:>8.3}{:>8.2}{:>10.3}{:>10}{:>8.2}",
            row.name,
            row.gauge.width / 10.0,
            row.gauge.height / row.gauge.width,
            measure.stitches,
            100.0 * chord.mean_abs,
            100.0 * chord.mean,
            chord.sd,
            chord.p95,
            100.0 * measure.skew.all.mean,
            measure.coverage,
            measure.inverted_tiles,
            measure.level.spread,
        );
    }
    for ratio in RATIOS.into_iter().chain([1.0]) {
        let (mut length, mut skew, mut count) = (0.0, 0.0, 0.0);
        for row in rows.iter().filter(|row| {
            (row.gauge.height / row.gauge.width - ratio).abs() < 1e-9 && SIZES.contains(&row.gauge.width)
        }) {
            length += row.measured.measure.length_error.chord.mean_abs;
            skew += row.measured.measure.skew.all.mean;
            count += 1.0;
        }
        let _ = writeln!(
            text,
            "mean of C and D at .25, .20 and .15 cm, h/w {ratio:.1}: length {:.2} %, skew {:.2} %",
            100.0 * length / count,
            100.0 * skew / count
        );
    }
    text.push('\n');
    text
}

/// The rows for other programs.
pub(super) fn to_json(rows: &[Row]) -> Result<Value, Failure> {
    let row = |row: &Row| {
        let measure = measure::facts(&row.measured)?;
        Ok(json!({ "shape": row.name, "stitch_mm": [row.gauge.width, row.gauge.height], "measure": measure }))
    };
    Ok(Value::Array(rows.iter().map(row).collect::<Result<_, Failure>>()?))
}
