//! The lines of `cases/examples.tsv` give their counts, or are refused for the reason that stands there.

#![expect(
    clippy::unwrap_used,
    clippy::format_push_string,
    reason = "a test that cannot set up its input has failed"
)]

use picot::diag::{Severity, Sink, Sources};
use picot::frontend::crochet::{Checked, Conventions, Document};

const EXAMPLES: &str = include_str!("cases/examples.tsv");

/// Checks a text; the codes of its errors, and what was counted.
pub(crate) fn check(text: &str, conventions: &Conventions) -> (Vec<String>, Option<Checked>) {
    let loader = |_: &str| Err(std::io::Error::other("no files"));
    let mut sources = Sources::new(&loader);
    let source = sources.add("pattern.txt", text.as_bytes().to_vec()).unwrap();
    let mut sink = Sink::new();
    let checked = Document::parse(&source, conventions.language, &mut sink)
        .map(|document| document.check(conventions, &mut sink));
    let errors = sink.diagnostics().iter().filter(|found| found.severity == Severity::Error);
    (errors.map(|found| format!("{} {}", found.code.as_str(), found.message)).collect(), checked)
}

/// The category of an error code in the lists of rejected lines.
pub(crate) fn category(code: &str) -> &'static str {
    match &code[..5] {
        "E0001" => "unknown",
        "E0002" | "E0003" | "E0004" | "E0005" | "E0006" => "syntax",
        "E0007" => "terms",
        "E0008" => "ambiguous",
        "E0009" | "E0010" => "text",
        "E0101" => "over-consume",
        "E0102" => "under-consume",
        "E0103" => "count",
        "E0104" => "indivisible",
        "E0105" => "no-foundation",
        "E0106" => "chain",
        "E0107" => "fill",
        "E0201" | "E0202" => "range",
        "E0203" | "E0204" | "E0205" => "sequence",
        "E0206" => "hold",
        "E0207" => "join",
        "E0301" | "E0302" | "E0303" => "short-row",
        other => panic!("{other} belongs to no category"),
    }
}

/// A file in which the line stands on `prev` loops.
pub(crate) fn around(prev: &str, line: &str, convention: &str) -> String {
    let mut text = String::new();
    for setting in convention.split(';').filter(|setting| *setting != "default" && !setting.is_empty()) {
        let (key, value) = setting.split_once('=').unwrap();
        match key {
            "lang" | "terms" => text.push_str(&format!("{key}: {value}\n")),
            "segments" => {
                let mut pieces: Vec<(String, u32)> = Vec::new();
                for piece in value.split('+') {
                    let (name, loops) = piece.split_once(':').unwrap();
                    pieces.push((name.to_owned(), loops.parse().unwrap()));
                }
                for (name, loops) in pieces.iter().filter(|(name, _)| name != "ch") {
                    text.push_str(&format!("{name}:\nRnd 1: {loops} sc in MR ({loops})\n"));
                }
                let join: Vec<String> = pieces
                    .iter()
                    .map(|(name, loops)| if name == "ch" { format!("ch {loops}") } else { name.clone() })
                    .collect();
                text.push_str(&format!("Body: join {}\n", join.join(" + ")));
            }
            _ => text.push_str(&format!("convention: {key}={value}\n")),
        }
    }
    if !prev.is_empty() && !convention.contains("segments") {
        // Loops to stand on, without any word of stitches that could tell the terms.
        text.push_str(&format!("MR {prev}\n"));
    }
    text.push_str(line);
    text.push('\n');
    text
}

/// Runs a table of cases: how many there are, and what came out otherwise.
pub(crate) fn run(rows: &str) -> (usize, Vec<String>) {
    let mut wrong = Vec::new();
    let mut lines = 0;
    for row in rows.lines().skip(1) {
        let columns: Vec<&str> = row.split('\t').collect();
        let [prev, text, expect, convention] = columns[..] else { panic!("{row}") };
        lines += 1;
        let (errors, checked) = check(&around(prev, text, convention), &Conventions::default());
        let produced = checked.and_then(|checked| {
            checked.parts.last().and_then(|part| part.rounds.last().and_then(|round| round.produces))
        });
        let got = match errors.first() {
            Some(error) => format!("reject:{}", category(error)),
            None => produced.map_or("nothing".to_owned(), |count| count.to_string()),
        };
        if got != expect {
            wrong.push(format!(
                "{prev:>3} | {text} | {convention} | expected {expect}, got {got}; {errors:?}"
            ));
        }
    }
    (lines, wrong)
}

#[test]
fn examples_give_their_counts_and_rejections() {
    let (lines, wrong) = run(EXAMPLES);
    assert_eq!(lines, 55);
    assert!(wrong.is_empty(), "{} of {lines}:\n{}", wrong.len(), wrong.join("\n"));
}
