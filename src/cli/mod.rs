//! The command line: dispatch, exit status, and what happens when things go wrong. A client of the library like any other.

mod args;
mod bench;
mod build;
mod check;
mod completions;
mod explain;
mod files;
mod fmt;
mod list;
mod man;
mod measure;
mod plan;
mod progress;
mod report;
mod route;
mod surface;

use args::{Cli, Command};
use clap::Parser;
use std::io::{self, Write};
use std::process::ExitCode;

/// How a run ended; the number is the exit status.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
enum Status {
    /// All is well.
    Fine = 0,
    /// The input has errors, each reported.
    InputErrors = 1,
    /// The command line makes no sense.
    Usage = 2,
    /// A file could not be read or written.
    File = 3,
    /// The target machine or format cannot make this.
    Impossible = 4,
}

impl From<Status> for ExitCode {
    fn from(status: Status) -> Self {
        Self::from(status as u8)
    }
}

/// Why a command stopped before its end.
#[derive(Debug)]
enum Failure {
    /// The command line makes no sense; with a way out.
    Usage { message: String, help: Option<String> },
    /// A file could not be read or written.
    File { name: String, error: io::Error },
    /// The format cannot hold this, or the machine cannot make it.
    Impossible { message: String, help: Option<String> },
}

impl Failure {
    fn usage(message: impl Into<String>) -> Self {
        Self::Usage { message: message.into(), help: None }
    }

    fn file(name: impl Into<String>, error: io::Error) -> Self {
        Self::File { name: name.into(), error }
    }

    /// Adds a way out.
    fn help(mut self, text: impl Into<String>) -> Self {
        match &mut self {
            Self::Usage { help, .. } | Self::Impossible { help, .. } => *help = Some(text.into()),
            Self::File { .. } => {}
        }
        self
    }

    fn status(&self) -> Status {
        match self {
            Self::Usage { .. } => Status::Usage,
            // Whoever closes the pipe has read enough.
            Self::File { error, .. } if error.kind() == io::ErrorKind::BrokenPipe => Status::Fine,
            Self::File { .. } => Status::File,
            Self::Impossible { .. } => Status::Impossible,
        }
    }
}

/// Runs the command line.
pub(crate) fn main() -> ExitCode {
    std::panic::set_hook(Box::new(|panic| {
        let place = panic.location().map(|place| format!(" at {place}")).unwrap_or_default();
        let payload = panic.payload();
        let what = payload.downcast_ref::<&str>().copied();
        let what = what.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("unknown");
        let _ = writeln!(
            io::stderr(),
            "picot {}: this is a bug, please report it with the input: {what}{place}",
            env!("CARGO_PKG_VERSION")
        );
    }));
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(Status::Usage as u8));
        }
    };
    picot::process::set_up();
    let report = report::Report::new(&cli.global);
    let outcome = match &cli.command {
        Command::Build(arguments) => build::run(arguments, report),
        Command::Preview(arguments) => build::preview(arguments, report),
        Command::Check(arguments) => check::run(arguments, report),
        Command::Fmt(arguments) => fmt::run(arguments, report),
        Command::Measure(arguments) => measure::run(arguments, report),
        Command::Surface(arguments) => surface::run(arguments, report),
        Command::Bench(arguments) => bench::run(arguments, report),
        Command::List(arguments) => list::run(arguments),
        Command::Explain(arguments) => explain::run(arguments),
        Command::Completions(arguments) => completions::run(arguments),
        Command::Man(arguments) => man::run(arguments),
    };
    match outcome {
        Ok(status) => status.into(),
        Err(failure) => {
            report.failure(&failure);
            failure.status().into()
        }
    }
}

/// Writes data to stdout.
fn print(bytes: &[u8]) -> Result<Status, Failure> {
    let mut out = io::stdout().lock();
    out.write_all(bytes).and_then(|()| out.flush()).map_err(|error| Failure::file("stdout", error))?;
    Ok(Status::Fine)
}

/// Writes a JSON value to stdout, indented.
fn print_json(value: &serde_json::Value) -> Result<Status, Failure> {
    print(format!("{value:#}\n").as_bytes())
}
