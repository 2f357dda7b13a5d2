//! The tables of `picot bench` as text.

use super::{Case, NOTES, SIZES};
use std::fmt::Write;

/// Times of all stages.
pub(crate) fn times(cases: &[Case]) -> String {
    let mut text = String::new();
    let stages: Vec<&str> =
        cases.first().map(|case| case.stages.iter().map(|(stage, _)| *stage).collect()).unwrap_or_default();
    let _ = write!(text, "{:<6}{:>6}{:>10}{:>10}", "shape", "mm", "stitches", "us/stitch");
    for stage in &stages {
        let _ = write!(text, "{stage:>10}");
    }
    let _ = writeln!(text, "{:>10} ms", "total");
    for case in cases {
        let _ = write!(
            text,
            "{:<6}{:>6.1}{:>10}{:>10.2}",
            case.printed.name,
            case.size,
            case.picot.measure.stitches,
            case.per_stitch(case.total)
        );
        for stage in &stages {
            let time =
                case.stages.iter().find(|(known, _)| known == stage).map_or(0.0, |(_, t)| t.as_secs_f64());
            let _ = write!(text, "{:>10.3}", time * 1e3);
        }
        let _ = writeln!(text, "{:>10.3}", case.total.as_secs_f64() * 1e3);
    }
    text
}

/// Tables 1 to 3 of the paper beside our numbers.
pub(crate) fn paper(cases: &[Case]) -> String {
    let mut text = String::new();
    quality(
        &mut text,
        "Table 1. Length error, percent: mean, and standard deviation as a fraction",
        cases,
        |case| case.printed.length,
        |case| {
            let stats = |measured: &super::Measured| {
                let stats = measured.measure.length_error.paper.all;
                [stats.mean, stats.sd]
            };
            let ours = case.picot.measure.length_error.chord.mean_abs;
            ([stats(&case.baseline), stats(&case.picot)], ours)
        },
        "mean |e|",
    );
    quality(
        &mut text,
        "Table 2. Skew, percent: mean, and standard deviation as a fraction",
        cases,
        |case| case.printed.skew,
        |case| {
            let stats = |measured: &super::Measured| {
                let stats = measured.measure.skew.paper;
                [stats.mean, stats.sd]
            };
            ([stats(&case.baseline), stats(&case.picot)], case.picot.measure.skew.all.mean)
        },
        "all tiles",
    );
    let _ = writeln!(text, "Table 3. Computation time, ms");
    let _ = writeln!(
        text,
        "{:<6}{:>6} |{:>12}{:>12}{:>12} |{:>12}{:>12}{:>12}",
        "", "cm", "Capunaman", "proposed", "Wu", "Capunaman", "Picot", "us/stitch"
    );
    for case in cases {
        let index = SIZES.iter().position(|size| *size == case.size).unwrap_or(0);
        let [capunaman, proposed, wu] = case.printed.time.map(|times| times[index]);
        let _ = writeln!(
            text,
            "{:<6}{:>6.2} |{capunaman:>12.0}{proposed:>12.0}{:>12.0} |{:>12.2}{:>12.2}{:>12.2}",
            case.printed.name,
            case.size / 10.0,
            wu * 1000.0,
            case.baseline_time.as_secs_f64() * 1e3,
            case.generate().as_secs_f64() * 1e3,
            case.per_stitch(case.generate())
        );
    }
    text.push('\n');
    alike(&mut text, cases);
    for note in NOTES {
        let _ = writeln!(text, "- {note}");
    }
    text.push_str("- Left of the bar: printed in the paper. Right of it: measured now, in the paper's convention; the last column is ours.\n");
    text
}

/// The algorithms as laid and as settled by the same relaxation, in our convention.
fn alike(text: &mut String, cases: &[Case]) {
    let _ = writeln!(
        text,
        "Like with like: mean |length error| / mean skew over all tiles, percent; as laid > settled by the same relaxation"
    );
    let _ = writeln!(
        text,
        "{:<6}{:>6} |{:>28}{:>28}{:>28}",
        "", "cm", "Capunaman", "rules of the paper", "Picot"
    );
    for case in cases {
        let cell = |measured: &super::Measured| {
            let measure = &measured.measure;
            format!(
                "{:.1} / {:.1}",
                100.0 * measure.length_error.chord.mean_abs,
                100.0 * measure.skew.all.mean
            )
        };
        let _ = write!(text, "{:<6}{:>6.2} |", case.printed.name, case.size / 10.0);
        for [laid, settled] in [
            [&case.baseline, &case.baseline_settled],
            [&case.paper[0], &case.paper[1]],
            [&case.unsettled, &case.picot],
        ] {
            let _ = write!(text, "{:>28}", format!("{} > {}", cell(laid), cell(settled)));
        }
        text.push('\n');
    }
    text.push('\n');
}

/// Numbers of one row: baseline and Picot in the paper's convention, and one number in ours.
type Ours = ([[f64; 2]; 2], f64);

fn quality(
    text: &mut String,
    title: &str,
    cases: &[Case],
    printed: impl Fn(&Case) -> [[f64; 2]; 3],
    ours: impl Fn(&Case) -> Ours,
    last: &str,
) {
    let _ = writeln!(text, "{title}");
    let _ = writeln!(
        text,
        "{:<6}{:>6} |{:>16}{:>16}{:>16} |{:>16}{:>16}{:>12}",
        "", "cm", "Capunaman", "proposed", "Wu", "Capunaman", "Picot", last
    );
    let cell = |[mean, sd]: [f64; 2]| format!("{mean:+.1} / {sd:.3}");
    for case in cases {
        let _ = write!(text, "{:<6}{:>6.2} |", case.printed.name, case.size / 10.0);
        for row in printed(case) {
            // One printed row stands for all sizes.
            let shown = if case.size == SIZES[0] { cell(row) } else { String::new() };
            let _ = write!(text, "{shown:>16}");
        }
        let (both, last) = ours(case);
        let _ = write!(text, " |");
        for [mean, sd] in both {
            let _ = write!(text, "{:>16}", cell([100.0 * mean, sd]));
        }
        let _ = writeln!(text, "{:>12.2}", 100.0 * last);
    }
    text.push('\n');
}
