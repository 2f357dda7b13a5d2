//! The conformance corpus of `tests/corpus/`: accepted lines give their counts, the others are refused for their reason.

use crate::examples::run;

const ACCEPT: &str = include_str!("../corpus/accept.tsv");
const REJECT: &str = include_str!("../corpus/reject.tsv");

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
