//! Written patterns on the command line: `check`, `check --fix`, `fmt`, and text of every kind of strangeness.

use crate::command::{self, Folder, picot, run, stderr, stdout};
use serde_json::{Value, json};
use std::path::Path;

/// Status and findings of `check` for text on stdin, one a line.
fn check(text: impl AsRef<[u8]>) -> (i32, String) {
    let command = picot(&["check", "-", "--format", "short"]).stdin(text.as_ref());
    let output = command.assert().get_output().clone();
    (output.status.code().expect("no signal"), String::from_utf8(output.stdout).expect("UTF-8"))
}

/// A file as text.
fn read(path: impl AsRef<Path>) -> String {
    String::from_utf8(command::read(path)).expect("UTF-8")
}

const BALL: &str = "Rnd 1: 6 sc in MR (6)\nRnd 2: inc around (12)\nRnd 3: (1 sc, inc) x 6 (18)\n";
/// Round 3 needs six passes; comments, spacing and line ends are the maker's own.
const SLIP: &str = "// mine\r\nRnd 1:  6 sc in MR (6)\nRnd 2: inc x 6 (12)   \nRnd 3: (sc, inc) x 5 (18)\r\nRnd 4: 18 sc (18)";
/// What `incc` stands for is a guess.
const GUESS: &str = "Rnd 1: 6 sc in MR (6)\nRnd 2: inc around (12)\nRnd 3: (1 sc, incc) x 6 (18)\n";

#[test]
fn a_certain_fix_changes_its_bytes_and_no_others() {
    let folder = Folder::new();
    let path = folder.file("ball.txt", SLIP);
    run(&["check", "--fix", &path]).code(0).stdout_eq("");
    assert_eq!(read(&path), SLIP.replace("x 5", "x 6"));
    run(&["check", "--fix", &path]).code(0);
    assert_eq!(read(&path), SLIP.replace("x 5", "x 6"));
}

#[test]
fn an_uncertain_fix_is_offered_and_not_applied() {
    let folder = Folder::new();
    let path = folder.file("ball.txt", GUESS);
    let output = run(&["check", "--fix", &path]).code(1).stdout_eq("");
    assert!(stderr(&output).contains("did you mean `inc`"), "{}", stderr(&output));
    assert_eq!(read(&path), GUESS);
}

#[test]
fn fmt_check_names_what_is_not_canonical() {
    let folder = Folder::new();
    let good = folder.file("good.txt", BALL);
    let loose = "rnd 1 : 6sc in MR [6]\nR2: inc in each st around (12)\n";
    let other = folder.file("loose.txt", loose);
    run(&["fmt", "--check", &good]).code(0).stdout_eq("");
    let output = run(&["fmt", "--check", &good, &other]).code(1);
    assert_eq!(stdout(&output).trim_end(), other);
    assert_eq!(read(&other), loose);
    run(&["fmt", &other]).code(0).stdout_eq("");
    run(&["fmt", "--check", &other]).code(0).stdout_eq("");
}

#[test]
fn fmt_is_a_filter() {
    let command = picot(&["fmt", "-"]).stdin("rnd 1: 6sc in MR [6]   // soft yarn\nRnd 2: inc around (12)\n");
    let text = stdout(&command.assert().code(0));
    assert!(text.starts_with("Rnd 1: 6 sc in MR (6)") && text.contains("// soft yarn"), "{text}");
    let again = picot(&["fmt", "-"]).stdin(text.clone()).assert().code(0);
    assert_eq!(stdout(&again), text);
    picot(&["fmt", "-", "--check"]).stdin(text).assert().code(0);
}

#[test]
fn json_of_check() {
    let folder = Folder::new();
    let (good, bad) = (folder.file("good.txt", BALL), folder.file("bad.txt", SLIP));
    let output = run(&["check", "--format", "json", &good, &bad]).code(1).stderr_eq("");
    let value: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    assert_eq!((&value["schema"], &value["ok"]), (&"picot.check/1".into(), &false.into()));
    let files = value["files"].as_array().expect("files");
    assert_eq!(files.len(), 2);
    assert_eq!((&files[0]["path"], &files[0]["ok"]), (&good.into(), &true.into()));
    assert_eq!((&files[1]["path"], &files[1]["ok"]), (&bad.into(), &false.into()));
    let round = &files[0]["parts"][0]["rounds"][1];
    let expected =
        json!({ "label": "2", "first": 2, "last": 2, "consumes": 6, "produces": 12, "stated": 12 });
    assert_eq!(round, &expected);

    let found = &files[1]["diagnostics"][0];
    assert_eq!((&found["code"], &found["severity"]), (&"E0102".into(), &"error".into()));
    assert_eq!(found["round"], 3);
    assert!(found["message"].is_string() && found["help"].is_string(), "{found}");
    assert!(found["labels"].as_array().is_some_and(|labels| labels.len() > 1), "{found}");
    let edit = &found["fixes"][0]["edits"][0];
    assert!(found["fixes"][0]["title"].is_string());
    let five = SLIP.find("x 5").expect("planted") + 2;
    let span = json!({ "start": five, "end": five + 1, "line": 4, "column": 20 });
    assert_eq!((&edit["span"], &edit["replacement"]), (&span, &"6".into()));
    assert_eq!(found["span"]["line"], 4);
}

#[test]
fn each_file_has_its_verdict_and_one_bad_file_fails_all() {
    let folder = Folder::new();
    let (good, bad) = (folder.file("good.txt", BALL), folder.file("bad.txt", GUESS));
    let output = run(&["check", &good, &bad, &good]).code(1).stdout_eq("");
    let text = stderr(&output);
    assert_eq!(text.matches("good.txt: ok").count(), 2, "{text}");
    assert!(text.contains("bad.txt: 1 error"), "{text}");
    run(&["check", &good]).code(0);
    run(&["check", &good, &folder.path("missing.txt")]).code(3);
}

#[test]
fn a_pattern_on_stdin_needs_no_name() {
    assert_eq!(check(BALL), (0, String::new()));
    let (status, found) = check(GUESS);
    assert_eq!(status, 1);
    assert!(found.contains("E0001"), "{found}");
    // Other input tells its kind at its start.
    let (_, found) = check(";!knitout-2\nfrob\n");
    assert!(!found.contains("E0001"), "{found}");
}

#[test]
fn labels_and_counts_of_many_hands() {
    for text in [
        "**Rnd 1:** 6 sc in MR (6)",
        "Rnd 1) 6 sc in MR (6)",
        "Rnd 1: 6 sc in MR {6}",
        "Rnd 1: 6 sc in MR <6>",
    ] {
        assert_eq!(check(text), (0, String::new()), "{text}");
        let (status, _) =
            check(text.replace("sc in MR", "sc in MR, sl st").replace('6', "7").replacen('7', "6", 1));
        assert_eq!(status, 1, "{text}: a false count stays false");
    }
}

#[test]
fn text_from_other_machines_is_read() {
    for (what, text) in [
        ("old Mac line ends", BALL.replace('\n', "\r")),
        ("Windows line ends", BALL.replace('\n', "\r\n")),
        ("a mark of byte order", format!("\u{feff}{BALL}")),
        ("full-width digits", BALL.replace('6', "\u{ff16}").replace('1', "\u{ff11}")),
        ("smart quotes in a note", format!("note: “soft” yarn, ‘loose’ hand\n{BALL}")),
    ] {
        assert_eq!(check(&text), (0, String::new()), "{what}");
        let (status, _) = check(text.replace(['8', '\u{ff18}'], "9"));
        assert_eq!(status, 1, "{what}: the counts are checked");
    }
}

#[test]
fn strange_bytes_are_refused_with_their_place() {
    for (what, text) in [
        ("NUL", &b"Rnd 1: 6 sc\0 in MR (6)\n"[..]),
        ("bytes that are no UTF-8", b"Rnd 1: 6 \xff\xfe sc in MR (6)\n"),
        ("half a character", b"Rnd 1: 6 sc in MR (6) \xe2\x80"),
        ("a right-to-left override inside a word", "Rnd 1: 6 s\u{202e}c in MR (6)\n".as_bytes()),
    ] {
        let (status, found) = check(text);
        assert_eq!(status, 1, "{what}: {found}");
        assert!(found.contains(":1:") && found.contains("error"), "{what}: {found}");
    }
}

#[test]
fn numbers_are_not_believed() {
    for text in [
        "Rnd 1: ((((sc x 999999999) x 999999999) x 999999999) x 999999999)\n",
        "((((sc x 999999999) x 999999999)\n",
        "Rnds 1-4294967295: 6 sc in MR (6)\n",
        "Rnd 1: 99999999999999999999999999 sc in MR\n",
    ] {
        let (status, found) = check(text);
        assert_eq!(status, 1, "{text}: {found}");
        assert!(found.contains("error"), "{text}: {found}");
    }
    let (status, _) = check(format!("6 sc {}", "(".repeat(100_000)));
    assert_eq!(status, 1);
}

#[test]
fn a_line_of_a_hundred_megabytes_ends() {
    let folder = Folder::new();
    let path = folder.file("long.txt", "sc, ".repeat(25 << 20));
    let output = run(&["check", "--format", "short", &path]).code(1);
    assert!(stdout(&output).contains("error"), "{}", stdout(&output));
    assert!(stdout(&output).len() < 10_000);
}

#[test]
fn a_pattern_in_uk_german_reads_back() {
    let folder = Folder::new();
    let (source, target) = (folder.file("frog.txt", BALL), folder.path("frosch.txt"));
    run(&["build", &source, "--to", "crochet", "--set", "terms=uk", "--set", "language=de", "-o", &target])
        .code(0);
    assert_ne!(read(&target), read(&source));
    let output = run(&["check", "--format", "json", &target]).code(0);
    let value: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let rounds = value["files"][0]["parts"][0]["rounds"].as_array().expect("rounds").clone();
    let made: Vec<i64> = rounds.iter().filter_map(|round| round["produces"].as_i64()).collect();
    assert_eq!(made, [6, 12, 18]);
}

#[test]
fn json_of_a_written_pattern() {
    let folder = Folder::new();
    let source =
        folder.file("frog.txt", "Rnd 1: 6 sc in MR (6)\nRnd 2: inc around (12)\nRnd 3: dec, 10 sc (11)\n");
    let output = run(&["build", &source, "--to", "json"]).code(0);
    let value: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    assert_eq!(value["schema"], "picot.program/1");
    let part = &value["parts"][0];
    assert!(part.get("graph").is_none(), "{part}");
    let facts = |round: &Value| {
        let steps = round["steps"].as_array().expect("steps").iter();
        let steps: Vec<(String, u64)> = steps
            .map(|step| (step["op"].as_str().unwrap_or("").to_owned(), step["times"].as_u64().unwrap_or(0)))
            .collect();
        (round["consumes"].as_u64(), round["produces"].as_u64(), steps)
    };
    let rounds: Vec<_> = part["rounds"].as_array().expect("rounds").iter().map(facts).collect();
    let op = |name: &str, times| (name.to_owned(), times);
    // The ring with its stitches is the start; rounds follow it.
    assert_eq!((&part["start"]["kind"], &part["start"]["loops"]), (&json!("ring"), &json!(6)));
    assert_eq!(part["rounds"][0]["number"], 2);
    assert_eq!(rounds[0], (Some(6), Some(12), vec![op("inc", 6)]));
    assert_eq!(rounds[1], (Some(12), Some(11), vec![op("dec", 1), op("sc", 10)]));
    assert_eq!(part["rounds"][1]["text"], "dec, 10 sc");
}
