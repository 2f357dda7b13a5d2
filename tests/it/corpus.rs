//! The conformance corpus of `tests/corpus/`: accepted lines give their counts, the others are refused for their reason.

use crate::examples::{around, category, check};
use picot::frontend::crochet::Conventions;

const ACCEPT: &str = include_str!("../corpus/accept.tsv");
const REJECT: &str = include_str!("../corpus/reject.tsv");

fn run(rows: &str) -> (usize, Vec<String>) {
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
fn accepted_lines_give_their_counts() {
    let (lines, wrong) = run(ACCEPT);
    assert!(lines >= 400, "{lines}");
    assert!(wrong.is_empty(), "{} of {lines}:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn rejected_lines_are_refused_for_their_reason() {
    let (lines, wrong) = run(REJECT);
    assert!(lines >= 200, "{lines}");
    assert!(wrong.is_empty(), "{} of {lines}:\n{}", wrong.len(), wrong.join("\n"));
}
