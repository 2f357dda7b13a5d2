//! The grammar file is alive: sentences drawn from it are read.

#![expect(clippy::unwrap_used, reason = "a test that cannot set up its input has failed")]

use crate::ebnf::{Grammar, Sampler};
use picot::diag::{Severity, Sink, Sources};
use picot::frontend::crochet::Document;
use picot::ir::Language;

const GRAMMAR: &str = include_str!("../../grammar/crochet.ebnf");

fn faults(text: &str) -> Vec<String> {
    let loader = |_: &str| Err(std::io::Error::other("no files"));
    let mut sources = Sources::new(&loader);
    let source = sources.add("sentence", text.as_bytes().to_vec()).unwrap();
    let mut sink = Sink::new();
    assert!(Document::parse(&source, Language::English, &mut sink).is_some());
    let errors = sink.diagnostics().iter().filter(|found| found.severity == Severity::Error);
    errors.map(|found| format!("{}: {}", found.code.as_str(), found.message)).collect()
}

const HEAD: &str = "color white = #ffffff\ndef flurb = 2 -> 1\n";

#[test]
fn sentences_of_the_grammar_parse() {
    let grammar = Grammar::read(GRAMMAR);
    let mut failed = Vec::new();
    let mut sampler = Sampler::new(&grammar, 0x9E37_79B9_7F4A_7C15);
    for _ in 0..30_000 {
        let sentence = sampler.draw("line");
        let found = faults(&format!("{HEAD}{sentence}\n"));
        if !found.is_empty() {
            failed.push(format!("{sentence}\n    {}", found.join("; ")));
        }
    }
    assert!(
        failed.is_empty(),
        "{} sentences were refused:\n{}",
        failed.len(),
        failed[..failed.len().min(30)].join("\n")
    );
    // Lines are drawn here, whole files below: the three choices of `pattern` itself are not among these.
    let never = sampler.taken.iter().filter(|choice| choice.is_empty() || choice.contains(&0)).count();
    assert_eq!(never, 3, "some alternatives were never drawn");
}

#[test]
fn whole_files_of_the_grammar_parse() {
    let grammar = Grammar::read(GRAMMAR);
    for seed in 1..60_u64 {
        let mut sampler = Sampler::new(&grammar, seed.wrapping_mul(0xD134_2543_DE82_EF95));
        let text = sampler.draw("pattern");
        // A file that changes its language in the middle speaks two languages; the sentences after it are English.
        let text: Vec<&str> =
            text.split('\n').filter(|line| !line.trim_start().starts_with("lang")).collect();
        let text = format!("{HEAD}{}", text.join("\n"));
        let found = faults(&text);
        assert!(found.is_empty(), "{text}\n{found:?}");
    }
}

#[test]
fn the_sampler_finds_what_the_parser_lacks() {
    // A production that the parser does not read must show up as a refusal.
    let broken = GRAMMAR.replace("ring     = \"mr\"", "ring     = \"flubber\" INT | \"mr\"");
    let grammar = Grammar::read(&broken);
    let mut sampler = Sampler::new(&grammar, 7);
    let refused =
        (0..200).filter(|_| !faults(&format!("{HEAD}{}\n", sampler.draw("row"))).is_empty()).count();
    assert!(refused > 0);
}
