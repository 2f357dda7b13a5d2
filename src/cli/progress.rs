//! Progress and stage times: a bar on a terminal that appears only when a run takes long, and the clock.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use picot::diag::Observer;
use std::cell::RefCell;
use std::fmt::Write;
use std::time::{Duration, Instant};

/// A run shorter than this shows no bar.
const PATIENCE: Duration = Duration::from_millis(500);

/// The clock; the core has none.
#[expect(clippy::disallowed_methods, reason = "times are the command line's to take")]
pub(crate) fn now() -> Instant {
    Instant::now()
}

/// A bar over `total` units; hidden in pipes, with `-q`, and for the first half second.
#[derive(Debug)]
pub(crate) struct Bar {
    inner: ProgressBar,
    born: Instant,
    quiet: bool,
}

impl Bar {
    pub(crate) fn new(total: u64, quiet: bool) -> Self {
        let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos}/{len} {msg}") {
            bar.set_style(style);
        }
        Self { inner: bar, born: now(), quiet }
    }

    /// One more unit is done.
    pub(crate) fn advance(&self, what: &str) {
        self.show();
        self.inner.set_message(what.to_owned());
        self.inner.inc(1);
    }

    fn show(&self) {
        if !self.quiet && self.inner.is_hidden() && self.born.elapsed() > PATIENCE {
            self.inner.set_draw_target(ProgressDrawTarget::stderr());
        }
    }

    /// Takes the bar away.
    pub(crate) fn clear(&self) {
        self.inner.finish_and_clear();
    }
}

/// Takes the time of every stage, and moves a bar along when a single run takes long.
#[derive(Debug)]
pub(crate) struct Watch<'b> {
    marks: RefCell<Vec<(&'static str, Instant)>>,
    bar: Option<&'b Bar>,
}

impl<'b> Watch<'b> {
    pub(crate) fn new(bar: Option<&'b Bar>) -> Self {
        Self { marks: RefCell::default(), bar }
    }

    /// Time of each stage until now, in order; a stage that ran twice is counted once.
    pub(crate) fn times(&self) -> Vec<(&'static str, Duration)> {
        let marks = self.marks.borrow();
        let ends = marks.iter().skip(1).map(|mark| mark.1).chain([now()]);
        let mut times: Vec<(&'static str, Duration)> = Vec::new();
        for ((name, start), end) in marks.iter().zip(ends) {
            let time = end.saturating_duration_since(*start);
            match times.iter_mut().find(|(known, _)| known == name) {
                Some((_, sum)) => *sum += time,
                None => times.push((name, time)),
            }
        }
        times
    }

    /// The times as a table for people.
    pub(crate) fn table(&self) -> String {
        let times = self.times();
        let total: Duration = times.iter().map(|(_, time)| *time).sum();
        let mut text = String::new();
        for (name, time) in times.iter().chain([&("total", total)]) {
            let _ = writeln!(text, "{name:>10} {:9.3} ms", time.as_secs_f64() * 1e3);
        }
        text
    }
}

impl Observer for Watch<'_> {
    fn stage(&self, name: &'static str) {
        self.marks.borrow_mut().push((name, now()));
        if let Some(bar) = self.bar {
            bar.show();
            bar.inner.set_message(name);
        }
    }

    fn step(&self, done: u64, total: u64) {
        if let Some(bar) = self.bar {
            bar.show();
            bar.inner.set_length(total);
            bar.inner.set_position(done);
        }
    }
}
