//! Picot XML: lossless there and back, broken files refused at their place, any bytes survived, schemas in step.

#![expect(clippy::disallowed_methods, reason = "tests read cases and schemas from the disk")]

use crate::programs;
use picot::backends::{self, Error};
use picot::diag::{Diagnostic, Sink, Sources};
use picot::frontend::{Input, READERS};
use picot::ir::exchange::Words;
use picot::ir::{Program, verify};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

fn no_files(_: &str) -> std::io::Result<Vec<u8>> {
    Err(std::io::ErrorKind::NotFound.into())
}

/// Reads bytes as Picot XML.
fn read(bytes: &[u8]) -> (Option<Program>, Vec<Diagnostic>) {
    let mut sources = Sources::new(&no_files);
    let source = sources.add("test.xml", bytes.to_vec()).expect("small");
    let mut sink = Sink::new();
    let reader = READERS.iter().find(|reader| reader.name == "xml").expect("listed");
    let input = (reader.read)(&source, &mut sources, &mut sink);
    let program = input.map(|input| match input {
        Input::Program(program) => *program,
        other @ (Input::Shape(_) | Input::Code(_)) => panic!("XML is a program, not {other:?}"),
    });
    assert!(program.is_some() != sink.has_errors(), "a program or an error, never both nor neither");
    (program, sink.take())
}

fn try_write(program: &Program, options: &str) -> Result<Vec<u8>, Error> {
    let mut sink = Sink::new();
    let verified = verify::verify(program, &mut sink).unwrap_or_else(|| panic!("not verified: {sink:?}"));
    let target = backends::target("xml").expect("listed");
    let backend = target.configure(options.parse().expect("options")).expect("options");
    let mut out = Vec::new();
    backend.emit(&verified, &mut out, &mut sink)?;
    Ok(out)
}

fn write(program: &Program) -> Vec<u8> {
    try_write(program, "").expect("writable")
}

/// Why a program does not come back from XML as it was; `None` when it does.
pub(crate) fn loses(program: &Program) -> Option<String> {
    let bytes = write(program);
    let (back, found) = read(&bytes);
    let Some(back) = back else { return Some(listing(&bytes, &found)) };
    let same =
        write(&back) == bytes && programs::without_places(back) == programs::without_places(program.clone());
    (!same).then(|| "another program came back".to_owned())
}

/// A listing of diagnostics: code, line and column, message, help.
fn listing(text: &[u8], diagnostics: &[Diagnostic]) -> String {
    let mut sources = Sources::new(&no_files);
    let source = sources.add("test.xml", text.to_vec()).expect("small");
    let mut out = String::new();
    for found in diagnostics {
        let range = found.labels.first().and_then(|label| source.range(label.span)).unwrap_or(0..0);
        let before = text.get(..range.start).unwrap_or_default();
        let line = before.split(|&b| b == b'\n').count();
        let column = before.iter().rev().take_while(|&&b| b != b'\n').count() + 1;
        let shown = String::from_utf8_lossy(text.get(range).unwrap_or_default()).replace('\n', " ");
        let help = found.help.as_deref().unwrap_or("-");
        let _ = writeln!(
            out,
            "{} {line}:{column} {}\n  at:   {shown}\n  help: {help}",
            found.code.as_str(),
            found.message
        );
    }
    out
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, rng_seed: proptest::test_runner::RngSeed::Fixed(1), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_is_written_reads_back_the_same(program in programs::programs()) {
        let bytes = write(&program);
        let (back, found) = read(&bytes);
        prop_assert!(found.is_empty(), "{}\n{}", listing(&bytes, &found), String::from_utf8_lossy(&bytes));
        let back = back.expect("no findings");
        // Equal bytes hold the floats to the last bit, which `==` does not (-0.0 == 0.0).
        prop_assert_eq!(write(&back), bytes);
        prop_assert_eq!(programs::without_places(back), programs::without_places(program));
    }

    #[test]
    fn changed_bytes_never_panic(program in programs::programs(), edits in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0_u8..5), 1..6)) {
        let mut bytes = write(&program);
        for (at, byte, kind) in edits {
            if bytes.is_empty() { break; }
            let at = at.index(bytes.len());
            match kind {
                0 => bytes[at] = byte,
                1 => { bytes.remove(at); }
                2 => bytes.insert(at, byte),
                3 => bytes.truncate(at),
                // A digit for a digit and a quote for a letter get past the XML layer more often.
                _ => if bytes[at].is_ascii_digit() { bytes[at] = b'0' + byte % 10 } else { bytes.insert(at, b'9') },
            }
        }
        read(&bytes);
    }

    #[test]
    fn any_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        read(&bytes);
    }
}

/// The files of a directory of cases, in order of their names.
fn cases(folder: &str) -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/xml").join(folder);
    let entries = std::fs::read_dir(&folder).expect("the folder of cases");
    let mut files: Vec<_> = entries.map(|entry| entry.expect("readable").path()).collect();
    files.sort();
    let name = |path: &Path| path.file_name().expect("a file").to_string_lossy().into_owned();
    files.iter().map(|path| (name(path), std::fs::read(path).expect("readable"))).collect()
}

#[test]
fn broken_files_are_refused_with_their_code() {
    let files = cases("bad");
    assert!(files.len() >= 20);
    let mut report = String::new();
    for (name, bytes) in files {
        let (program, found) = read(&bytes);
        assert!(program.is_none(), "{name} was read");
        let code = name.split('-').next().expect("a code");
        assert!(
            found.iter().all(|found| found.code.as_str() == code),
            "{name}:\n{}",
            listing(&bytes, &found)
        );
        let _ = writeln!(report, "{name}\n{}", listing(&bytes, &found));
    }
    insta::assert_snapshot!(report);
}

#[test]
fn sound_files_are_read_and_written_again_the_same() {
    for (name, bytes) in cases("good") {
        let (program, found) = read(&bytes);
        let program = program.unwrap_or_else(|| panic!("{name}:\n{}", listing(&bytes, &found)));
        if name.starts_with('W') {
            let codes: Vec<_> = found.iter().map(|found| found.code.as_str()).collect();
            assert_eq!(codes.first().copied(), name.split('-').next(), "{name}");
        } else {
            assert!(found.is_empty(), "{name}:\n{}", listing(&bytes, &found));
            assert_eq!(String::from_utf8(write(&program)), String::from_utf8(bytes), "{name}");
        }
    }
}

#[test]
fn several_faults_are_told_in_one_run() {
    let text = br#"<program xmlns="urn:picot:program:1" version="1.0" nmae="x" unit="cm">
  <part name="a" copies="0"><start kind="rng" loops="-3"/><round number="2" consumes="6" produces="6"><wrk/><turn direction="bck"/></round></part>
</program>"#;
    let (_, found) = read(text);
    let codes: Vec<_> = found.iter().map(|found| found.code.as_str()).collect();
    assert_eq!(codes, ["E3007", "E3008", "E3009", "E3009", "E3009", "E3009", "E3006", "E3009"]);
}

#[test]
fn bombs_are_refused_at_once() {
    let wrap = |steps: &str| {
        format!(
            "<program xmlns='urn:picot:program:1' version='1.0' name='' unit='mm'><part name='a'><start kind='ring' loops='6'/><round number='2' consumes='6' produces='6'>{steps}</round></part></program>"
        )
    };
    let deep = |n: usize| "<repeat times='9'>".repeat(n) + "<work op='sc'/>" + &"</repeat>".repeat(n);
    let turns = "<turn direction='back'/><turn direction='forward'/>";
    let wide = (0..100_000).fold(String::new(), |text, i| text + &format!(" a{i}='1'"));
    for (what, text, code) in [
        ("depth beyond the repeats", wrap(&deep(100_000)), "E3010"),
        ("repeats too deep", wrap(&deep(17)), "E3010"),
        (
            "steps by multiplication",
            wrap(&format!("<repeat times='50000000'><repeat times='9'>{turns}</repeat></repeat>")),
            "E3010",
        ),
        ("a count past u32", wrap("<work op='sc' times='99999999999999999999'/>"), "E3010"),
        ("attributes", wrap(&format!("<work op='sc'{wide}/>")), "E3010"),
        ("faults without end", wrap(&"<wrok/>".repeat(100_000)), "E3006"),
        (
            "billion laughs",
            format!("<!DOCTYPE l [<!ENTITY a 'ha'><!ENTITY b '&a;&a;'>]>{}", wrap("")),
            "E3002",
        ),
    ] {
        let (_, found) = read(text.as_bytes());
        assert_eq!(found.last().map(|found| found.code.as_str()), Some(code), "{what}");
        assert!(found.len() <= 50, "{what}: {} findings", found.len());
    }
}

#[test]
fn what_xml_cannot_hold_is_refused_before_a_byte_is_written() {
    let mut program = programs::program(&[]);
    program.name = "bell\u{7}".into();
    let error = try_write(&program, "").expect_err("a control character");
    assert!(error.to_string().contains("U+0007"), "{error}");
}

#[test]
fn the_graph_may_be_left_out() {
    let tape: Vec<u32> = (0..60).map(|i| i * 7 + 1).collect();
    let with = (0..200)
        .map(|i| programs::program(&[&[i, 1], &tape[..]].concat()))
        .find(|program| !program.graphs.is_empty());
    let program = with.expect("one with a graph");
    let without = try_write(&program, "graph = false").expect("writable");
    let (back, _) = read(&without);
    assert!(back.expect("readable").graphs.is_empty());
    assert!(without.len() < write(&program).len());
}

/// Both schemas list the stitches of the table. `PICOT_BLESS=1` writes the lists.
#[test]
fn schemas_list_the_stitches_of_the_table() {
    const FROM: &str = "<!-- stitches -->\n";
    const TO: &str = "      <!-- /stitches -->";
    let words = Words::new();
    let list = |before: &str, after: &str| {
        words.all().fold(String::new(), |text, word| text + &format!("      {before}{word}{after}\n"))
    };
    for (file, wanted) in [
        ("grammar/picot.rng", list("<value>", "</value>")),
        ("grammar/picot.xsd", list("<xs:enumeration value=\"", "\"/>")),
    ] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
        let text = std::fs::read_to_string(&path).expect("the schema");
        let (head, rest) = text.split_once(FROM).expect("the first marker");
        let (found, tail) = rest.split_once(TO).expect("the last marker");
        if std::env::var_os("PICOT_BLESS").is_some() {
            std::fs::write(&path, [head, FROM, &wanted, TO, tail].concat()).expect("writable");
        } else {
            assert_eq!(found, wanted, "{file} lists other stitches: run the test again with PICOT_BLESS=1");
        }
    }
}

#[test]
fn words_of_stitches_are_distinct() {
    let words = Words::new();
    let mut all: Vec<_> = words.all().collect();
    all.sort_unstable();
    all.dedup();
    assert_eq!(all.len(), words.all().count());
}

/// Every arbitrary program passes all three schemas; skipped, and said so, where xmllint is missing.
#[test]
fn schemas_accept_what_is_written() {
    if Command::new("xmllint").arg("--version").output().is_err() {
        eprintln!("SKIPPED: no xmllint, install libxml2-utils");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let mut runner = proptest::test_runner::TestRunner::new(crate::arbitrary::config(0));
    let files: Vec<_> = (0..60)
        .map(|index| {
            let program = programs::programs().new_tree(&mut runner).expect("a program").current();
            let path = folder.path().join(format!("{index}.xml"));
            std::fs::write(&path, write(&program)).expect("writable");
            path
        })
        .collect();
    for (kind, schema) in
        [("--schema", "picot.xsd"), ("--relaxng", "picot.rng"), ("--schematron", "picot.sch")]
    {
        let schema = Path::new(env!("CARGO_MANIFEST_DIR")).join("grammar").join(schema);
        let run =
            Command::new("xmllint").args(["--nonet", "--noout", kind]).arg(&schema).args(&files).output();
        let run = run.expect("xmllint runs");
        assert!(
            run.status.success(),
            "{}",
            String::from_utf8_lossy(&run.stderr).chars().take(3000).collect::<String>()
        );
    }
}
