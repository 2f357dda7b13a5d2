//! What goes to stderr: diagnostics, failures and remarks.

use super::Failure;
use super::args::{Color, Global};
use picot::diag::position::Positions;
use picot::diag::render::terminal::terminal;
use picot::diag::{Code, Diagnostic, Severity, Sources};
use std::fmt::Write as _;
use std::io::{self, IsTerminal, Write as _};

/// How to speak on stderr.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Report {
    color: bool,
    quiet: bool,
}

impl Report {
    /// Looks at the flags, the terminal and the environment once.
    pub(crate) fn new(global: &Global) -> Self {
        let color = match global.color {
            Color::Always => true,
            Color::Never => false,
            Color::Auto => {
                set("CLICOLOR_FORCE") || (io::stderr().is_terminal() && !set("NO_COLOR") && !dumb_terminal())
            }
        };
        Self { color, quiet: global.quiet }
    }

    /// True when only errors and warnings are wanted.
    pub(crate) fn quiet(self) -> bool {
        self.quiet
    }

    /// Renders findings, so that a worker can hand them over as text.
    pub(crate) fn render(self, sources: &Sources<'_>, diagnostics: &[Diagnostic]) -> String {
        let positions = Positions::new(sources);
        let mut text = String::new();
        for diagnostic in diagnostics {
            if self.quiet && diagnostic.severity == Severity::Note {
                continue;
            }
            text.push_str(&terminal(diagnostic, &positions, self.color));
            text.push_str("\n\n");
        }
        text
    }

    /// A remark, left out with `-q`.
    pub(crate) fn remark(self, text: &str) {
        if !self.quiet {
            print(&format!("{text}\n"));
        }
    }

    /// Tells why a command stopped.
    pub(crate) fn failure(self, failure: &Failure) {
        let (code, message, help) = match failure {
            Failure::Usage { message, help } | Failure::Impossible { message, help } => {
                (String::new(), message.clone(), help.as_deref())
            }
            Failure::File { error, .. } if error.kind() == io::ErrorKind::BrokenPipe => return,
            Failure::File { name, error } => {
                (format!("[{}]", Code::FileFails.as_str()), format!("{name}: {}", plain(error)), None)
            }
        };
        let (open, close) = if self.color { ("\x1b[1m\x1b[91m", "\x1b[0m") } else { ("", "") };
        let mut text = format!("{open}error{code}{close}: {message}\n");
        if let Some(help) = help {
            let _ = writeln!(text, "  help: {help}");
        }
        print(&text);
    }
}

/// Prints text on stderr as it is.
pub(crate) fn print(text: &str) {
    // Nothing can be told to someone whose stderr is closed.
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

/// An error of the system in lower case, without its number.
fn plain(error: &io::Error) -> String {
    let text = error.to_string();
    let text = text.split(" (os error").next().unwrap_or_default();
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_lowercase().chain(letters).collect())
}

#[expect(clippy::disallowed_methods, reason = "whether to color is told by the environment")]
fn set(name: &str) -> bool {
    std::env::var_os(name).is_some_and(|value| !value.is_empty() && value != "0")
}

#[expect(clippy::disallowed_methods, reason = "whether to color is told by the environment")]
fn dumb_terminal() -> bool {
    std::env::var_os("TERM").is_some_and(|value| value == "dumb")
}
