//! `picot fmt`: written patterns in canonical form.

use super::args::Fmt;
use super::files::{self, Place};
use super::report::{self, Report};
use super::route::route;
use super::{Failure, Status, print};
use picot::diag::{Sink, Sources};
use picot::frontend::crochet::Document;
use std::path::PathBuf;

pub(crate) fn run(arguments: &Fmt, report: Report) -> Result<Status, Failure> {
    let conventions = route(&arguments.reading, &[])?.options.conventions;
    let stdin = files::stdin_if_named(arguments.files.iter())?;
    let mut status = Status::Fine;
    let mut writes = Vec::new();
    let mut changed = Vec::new();
    for name in &arguments.files {
        let mut sources = Sources::new(&files::load);
        let mut sink = Sink::new();
        let source = files::open(&mut sources, name, &stdin)?;
        let document = Document::parse(&source, conventions.language, &mut sink);
        report::print(&report.render(&sources, sink.diagnostics()));
        let (Some(document), false) = (document, sink.has_errors()) else {
            status = Status::InputErrors;
            continue;
        };
        let text = document.format();
        if name == "-" && !arguments.check {
            writes.push((Place::Stdout, text.into_bytes()));
        } else if text.as_bytes() != source.bytes() {
            changed.push(name.clone());
            writes.push((Place::File(PathBuf::from(name)), text.into_bytes()));
        }
    }
    if arguments.check {
        for name in &changed {
            print(format!("{name}\n").as_bytes())?;
        }
        if !changed.is_empty() {
            status = Status::InputErrors;
        }
        return Ok(status);
    }
    files::write_all(&writes)?;
    for name in changed {
        report.remark(&format!("{name}: formatted"));
    }
    Ok(status)
}
