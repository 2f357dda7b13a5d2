//! `picot completions`: the script that teaches a shell our commands.

use super::args::{Cli, Completions};
use super::{Failure, Status, print};
use clap::CommandFactory;

pub(crate) fn run(arguments: &Completions) -> Result<Status, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Cli::command(), "picot", &mut script);
    print(&script)
}
