//! The time of a stitch by the size of the whole: shape D with ever finer stitches, from text to text.

use super::super::measure::milliseconds;
use super::super::progress::{Bar, Watch, now};
use super::super::report::Report;
use super::super::{Failure, Status, print};
use super::printed::{PRINTED, Printed};
use picot::diag::Sink;
use picot::ir::Gauge;
use serde_json::{Value, json};
use std::fmt::Write;
use std::time::Duration;

/// About so many stitches.
const COUNTS: [u32; 9] = [1_000, 1_500, 2_700, 6_000, 10_000, 25_000, 100_000, 1_000_000, 10_000_000];
/// Rounds in which each size has its turn, where nothing else is asked.
const ROUNDS: u32 = 5;
/// Small sizes are compiled so long in each of their turns.
const TURN: Duration = Duration::from_millis(400);

/// One size.
struct Size {
    /// Side of a stitch in mm.
    side: f64,
    stitches: u64,
    /// The least of all runs.
    time: Duration,
    runs: u64,
}

impl Size {
    /// Microseconds a stitch.
    fn per_stitch(&self) -> f64 {
        super::per_stitch(self.time, self.stitches)
    }
}

/// Sizes up to about `most` stitches. They take turns and the least time counts, for the clock of most machines swings by more
/// than they differ.
pub(super) fn run(
    most: u32,
    rounds: Option<u32>,
    json: Option<&str>,
    report: Report,
) -> Result<Status, Failure> {
    let rounds = rounds.unwrap_or(ROUNDS);
    let mut sizes = sizes(most)?;
    let bar = Bar::new(u64::from(rounds) * sizes.len() as u64, report.quiet());
    for _ in 0..rounds {
        for size in &mut sizes {
            let name = format!("{:.3} mm", size.side);
            turn(size, report)?;
            bar.advance(&name);
        }
    }
    bar.clear();
    let machine = super::machine();
    let file = || Ok(to_json(&sizes, rounds, &machine));
    if let Some(status) = super::write_json(json, file)? {
        return Ok(status);
    }
    let footer = super::footer("the least", &format!("{rounds} rounds in turns"), &machine);
    print(format!("{}{footer}\n", table(&sizes)).as_bytes())
}

/// Those of the sizes that have no more stitches.
fn sizes(most: u32) -> Result<Vec<Size>, Failure> {
    let printed = printed();
    let mut sink = Sink::new();
    let shape = super::shape(printed, &picot::Options::default(), &mut sink);
    let shape = shape.ok_or_else(|| super::broken(printed))?;
    let area: f64 = shape.tubes.iter().map(|tube| picot::shape::area(&*tube.surface, 64, 64)).sum();
    let counts = COUNTS.into_iter().filter(|count| *count <= most);
    let size = |count: u32| Size {
        side: (area / f64::from(count)).sqrt(),
        stitches: 0,
        time: Duration::MAX,
        runs: 0,
    };
    Ok(counts.map(size).collect())
}

fn printed() -> &'static Printed {
    let [.., last] = &PRINTED;
    last
}

fn turn(size: &mut Size, report: Report) -> Result<(), Failure> {
    let gauge = Gauge::new(size.side, size.side);
    let options = picot::Options { gauge: Some(gauge), ..picot::Options::default() };
    let start = now();
    loop {
        let begin = now();
        size.stitches = super::whole(printed(), &options, &Watch::new(None), report)?;
        size.time = size.time.min(begin.elapsed());
        size.runs += 1;
        if start.elapsed() >= TURN {
            return Ok(());
        }
    }
}

/// The longest time of a stitch by the shortest.
fn spread(sizes: &[Size]) -> f64 {
    let (least, most) = sizes
        .iter()
        .map(Size::per_stitch)
        .fold((f64::INFINITY, 0.0_f64), |(least, most), time| (least.min(time), most.max(time)));
    most / least
}

fn table(sizes: &[Size]) -> String {
    let mut text = format!("{:>10}{:>12}{:>12}{:>12}{:>8}\n", "mm", "stitches", "us/stitch", "ms", "runs");
    for size in sizes {
        let Size { side, stitches, time, runs } = size;
        let (each, whole) = (size.per_stitch(), time.as_secs_f64() * 1e3);
        let _ = writeln!(text, "{side:>10.4}{stitches:>12}{each:>12.3}{whole:>12.3}{runs:>8}");
    }
    let _ = writeln!(text, "\nthe largest is {:.2} times the least", spread(sizes));
    text
}

fn to_json(sizes: &[Size], rounds: u32, machine: &str) -> Value {
    let list: Vec<Value> = sizes
        .iter()
        .map(|size| {
            json!({ "stitch_mm": size.side, "stitches": size.stitches, "us_per_stitch": size.per_stitch(),
                "total_ms": milliseconds(size.time), "runs": size.runs })
        })
        .collect();
    json!({ "schema": "picot.scale/1", "version": env!("CARGO_PKG_VERSION"), "machine": machine, "rounds": rounds,
        "debug": cfg!(debug_assertions), "spread": spread(sizes), "sizes": list })
}
