//! Whole patterns in ten manners: as written they check clean, and a broken copy of each names the round at fault first.

use picot::diag::position::Positions;
use picot::diag::render::terminal::terminal;
use picot::diag::{Severity, Sink, Source, Sources};
use picot::frontend::crochet::{Conventions, Document};
use picot::ir::verify::verify;
use std::path::Path;

fn load(path: &Path) -> std::io::Result<Vec<u8>> {
    #[expect(clippy::disallowed_methods, reason = "the cases are files")]
    std::fs::read(path)
}

fn check(source: &Source, sink: &mut Sink<'_>) -> (Option<picot::ir::Program>, String) {
    let conventions = Conventions::default();
    let document = Document::parse(source, conventions.language, sink).expect("cases are text");
    let checked = document.check(&conventions, sink);
    (checked.program, document.format())
}

fn with(path: &Path, run: impl FnOnce(&Source, &Sources<'_>)) {
    let loader = |_: &str| Err(std::io::Error::other("no files"));
    let mut sources = Sources::new(&loader);
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let source = sources.add(&name, load(path).expect("a case can be read")).expect("cases are small");
    run(&source, &sources);
}

#[test]
fn whole_patterns_check_clean() {
    let mut patterns = 0;
    insta::glob!("cases/patterns/*.txt", |path| {
        patterns += 1;
        with(path, |source, sources| {
            let mut sink = Sink::new();
            let (program, formatted) = check(source, &mut sink);
            let positions = Positions::new(sources);
            let wrong: Vec<String> = sink
                .diagnostics()
                .iter()
                .filter(|found| found.severity > Severity::Note)
                .map(|found| terminal(found, &positions, false))
                .collect();
            assert!(wrong.is_empty(), "{}", wrong.join("\n"));
            let program = program.expect("a clean pattern is a program");
            let mut sink = Sink::new();
            let verified = verify(&program, &mut sink);
            assert!(verified.is_some(), "{:?}", sink.diagnostics());
            let rounds: u32 =
                program.pattern.parts.iter().flat_map(|part| &part.rows).map(|row| row.times).sum();
            assert!(rounds >= 14, "{rounds} rounds after the first");
            insta::assert_snapshot!(format!("{}\n---\n{formatted}", source.text().unwrap_or_default()));
        });
    });
    assert_eq!(patterns, 10);
}

#[test]
fn broken_patterns_name_the_fault_first() {
    insta::glob!("cases/broken/*.txt", |path| {
        with(path, |source, sources| {
            let mut sink = Sink::new();
            let (program, _) = check(source, &mut sink);
            assert!(program.is_none());
            let positions = Positions::new(sources);
            let errors: Vec<_> =
                sink.diagnostics().iter().filter(|found| found.severity == Severity::Error).collect();
            let first = errors.first().expect("a broken pattern has an error");
            insta::assert_snapshot!(format!(
                "{}\n\n{} error(s)",
                terminal(first, &positions, false),
                errors.len()
            ));
        });
    });
}

#[test]
fn formatting_is_idempotent_and_keeps_the_steps() {
    insta::glob!("cases/patterns/*.txt", |path| {
        with(path, |source, _| {
            let mut sink = Sink::new();
            let (program, once) = check(source, &mut sink);
            let loader = |_: &str| Err(std::io::Error::other("no files"));
            let mut sources = Sources::new(&loader);
            let again = sources.add(source.name(), once.clone().into_bytes()).expect("small");
            let (other, twice) = check(&again, &mut sink);
            assert_eq!(once, twice);
            let steps = |program: &picot::ir::Program| {
                let parts = program.pattern.parts.iter();
                parts
                    .map(|part| {
                        let rows =
                            part.rows.iter().map(|row| (row.times, row.body.steps().collect::<Vec<_>>()));
                        (part.start.clone(), rows.collect::<Vec<_>>())
                    })
                    .collect::<Vec<_>>()
            };
            assert_eq!(program.as_ref().map(steps), other.as_ref().map(steps));
        });
    });
}
