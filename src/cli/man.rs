//! `picot man`: the manual pages in roff.

use super::args::{Cli, Man};
use super::{Failure, Status, print};
use clap::{Command, CommandFactory};
use picot::diag::did_you_mean;

pub(crate) fn run(arguments: &Man) -> Result<Status, Failure> {
    let mut root = Cli::command();
    root.build();
    let command = match &arguments.command {
        None => &root,
        Some(name) => root.find_subcommand(name).ok_or_else(|| unknown(name, &root))?,
    };
    let mut page = Vec::new();
    clap_mangen::Man::new(command.clone())
        .render(&mut page)
        .map_err(|error| Failure::file("the manual page", error))?;
    print(&page)
}

fn unknown(name: &str, root: &Command) -> Failure {
    let names: Vec<&str> = root.get_subcommands().map(Command::get_name).collect();
    let failure = Failure::usage(format!("there is no command `{name}`"));
    match did_you_mean(name, names.iter().copied()) {
        Some(near) => failure.help(format!("did you mean `{near}`?")),
        None => failure.help(format!("the commands are {}", names.join(", "))),
    }
}
