//! `picot explain`: the page of a diagnostic.

use super::args::Explain;
use super::{Failure, Status, print};
use picot::diag::{Code, did_you_mean};

pub(crate) fn run(arguments: &Explain) -> Result<Status, Failure> {
    let Some(code) = Code::parse(&arguments.code) else {
        let upper = arguments.code.to_uppercase();
        let nearest = did_you_mean(&upper, Code::ALL.iter().map(|code| code.as_str()));
        let help = nearest.map_or_else(
            || "`picot list codes` shows all".to_owned(),
            |near| format!("did you mean `{near}`? `picot list codes` shows all"),
        );
        return Err(Failure::usage(format!("no diagnostic has the code `{}`", arguments.code)).help(help));
    };
    let page = code.explanation().lines().map(|line| line.strip_prefix(' ').unwrap_or(line));
    let page = page.collect::<Vec<_>>().join("\n");
    print(
        format!("{} ({}): {}\n\n{}\n", code.as_str(), code.severity().name(), code.title(), page.trim_end())
            .as_bytes(),
    )
}
