//! Diagnostics as text: what a person sees, what an editor reads, and that no input can break either.

use picot::diag::position::Positions;
use picot::diag::render::{json, short, terminal};
use picot::diag::{Code, Diagnostic, Edit, Fix, Sources};
use proptest::prelude::*;
use std::io;

fn nothing(_: &str) -> io::Result<Vec<u8>> {
    Err(io::ErrorKind::NotFound.into())
}

const FROG: &str =
    "Frog\n\nRnd 1: 6 sc in a magic ring (6)\nRnd 2: inc x 6 (13)\nRnd 3: (sc, inc) x 7 (18) # größer\n";

fn find(text: &str, part: &str) -> std::ops::Range<usize> {
    let start = text.find(part).expect("part of the text");
    start..start + part.len()
}

/// Runs `make` on a source with this content and renders every format.
fn rendered(content: &[u8], make: impl Fn(&picot::diag::Source) -> Diagnostic) -> [String; 4] {
    let mut sources = Sources::new(&nothing);
    let source = sources.add("frog.txt", content.to_vec()).expect("small");
    let diagnostic = make(&source);
    let positions = Positions::new(&sources);
    [
        terminal::terminal(&diagnostic, &positions, false),
        terminal::terminal(&diagnostic, &positions, true),
        short::short(&diagnostic, &positions),
        serde_json::to_string_pretty(&json::object(&diagnostic, &positions)).expect("plain data"),
    ]
}

fn frog(source: &picot::diag::Source) -> Diagnostic {
    Diagnostic::new(Code::LoopsExhausted, "round 3 works 14 loops, round 2 left 12")
        .at(source.span(find(FROG, "(sc, inc) x 7")), "works 14")
        .at(source.span(find(FROG, "inc x 6")), "left 12")
        .in_round("body", Some(3))
        .help("repeat it 6 times")
        .fix(Fix {
            title: "repeat it 6 times".into(),
            edits: vec![Edit { span: source.span(find(FROG, "7")), replacement: "6".into() }],
            certain: false,
        })
}

#[test]
fn a_diagnostic_reads_like_rustc() {
    let [plain, color, short, json] = rendered(FROG.as_bytes(), frog);
    insta::assert_snapshot!("frog_terminal", plain);
    insta::assert_snapshot!("frog_short", short);
    insta::assert_snapshot!("frog_json", json);
    assert!(color.contains("\u{1b}[") && !plain.contains('\u{1b}'));
}

#[test]
fn columns_count_scalar_values_on_lines_of_any_length() {
    let mut line = "ö".repeat(100_000);
    line.push_str("X\nY");
    let [_, _, short, json] = rendered(line.as_bytes(), |source| {
        Diagnostic::new(Code::LoopsLeft, "here").at(source.span(200_000..200_001), "")
    });
    assert_eq!(short, "frog.txt:1:100001: error[E0102]: here");
    assert!(json.contains("\"start\": 200000"));
    let [_, _, short, _] = rendered(line.as_bytes(), |source| {
        Diagnostic::new(Code::LoopsLeft, "here").at(source.span(200_002..200_003), "")
    });
    assert_eq!(short, "frog.txt:2:1: error[E0102]: here");
}

#[test]
fn a_giant_line_is_cut_and_keeps_its_column() {
    let mut line = vec![b'a'; 30_000_000];
    line.extend_from_slice(b"FAULT");
    line.resize(60_000_000, b'b');
    let [plain, ..] = rendered(&line, |source| {
        Diagnostic::new(Code::LoopsLeft, "here").at(source.span(30_000_000..30_000_005), "this")
    });
    assert!(plain.len() < 2000, "{}", plain.len());
    assert!(plain.contains("frog.txt:1:30000001") && plain.contains("FAULT") && plain.contains("^^^^^"));
}

#[test]
fn many_diagnostics_on_a_big_file_take_no_square_time() {
    let text = "Rnd 1: 6 sc\n".repeat(200_000);
    let mut sources = Sources::new(&nothing);
    let source = sources.add("big.txt", text.into_bytes()).expect("small");
    let positions = Positions::new(&sources);
    for line in (0..200_000).step_by(20) {
        let diagnostic =
            Diagnostic::new(Code::LoopsLeft, "left").at(source.span(line * 12..line * 12 + 3), "");
        let expected = format!("big.txt:{}:1: error[E0102]: left", line + 1);
        assert_eq!(short::short(&diagnostic, &positions), expected);
    }
}

#[test]
fn what_has_no_text_names_part_and_round() {
    let [plain, _, short, json] = rendered(b"", |_| {
        Diagnostic::new(Code::BackPassTooLong, "a back pass of 25 on 26 loops").in_round("trunk", Some(48))
    });
    insta::assert_snapshot!("no_text", format!("{plain}\n\n{short}\n\n{json}"));
}

#[test]
fn control_characters_of_the_input_do_not_reach_the_terminal() {
    let text = "x\u{1b}[2Jy\u{202e}z\u{7}\r\n";
    let [plain, _, short, _] = rendered(text.as_bytes(), |source| {
        Diagnostic::new(Code::LoopsLeft, format!("`{text}`")).at(source.span(0..text.len()), text).help(text)
    });
    for out in [plain, short] {
        assert!(!out.contains(['\u{1b}', '\u{7}', '\u{202e}', '\r']), "{out:?}");
    }
}

#[test]
fn files_that_are_no_utf8_are_shown_with_replacements() {
    let [plain, ..] = rendered(b"Rnd 1: 6 s\xC3( (6)\n", |source| {
        Diagnostic::new(Code::LoopsLeft, "not UTF-8").at(source.span(10..11), "byte 0xC3")
    });
    insta::assert_snapshot!("no_utf8", plain);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, rng_seed: proptest::test_runner::RngSeed::Fixed(1), ..ProptestConfig::default() })]

    /// Any bytes, any spans, any edits: every renderer gives text.
    #[test]
    fn renderers_never_panic(
        content in prop_oneof![
            proptest::collection::vec(any::<u8>(), 0..200),
            "[a\n\r\t äé🧶\u{301}(){}\\[\\]/]{0,120}".prop_map(String::into_bytes),
            "[a\n ]{0,20}".prop_map(|line| line.repeat(200).into_bytes()),
        ],
        labels in proptest::collection::vec((0..2000_usize, 0..2000_usize, "[ -~\n]{0,10}"), 0..6),
        edits in proptest::collection::vec((0..2000_usize, 0..40_usize, "[ -~\n]{0,10}"), 0..4),
    ) {
        let length = content.len() + 1;
        rendered(&content, |source| {
            let mut diagnostic = Diagnostic::new(Code::LoopsLeft, "x");
            for (start, end, message) in &labels {
                let (start, end) = (start % length, end % length);
                diagnostic = diagnostic.at(source.span(start.min(end)..start.max(end)), message.clone());
            }
            let edits = edits.iter().map(|(start, len, text)| Edit {
                span: source.span(start % length..start % length + len),
                replacement: text.clone(),
            });
            diagnostic.fix(Fix { title: "t".into(), edits: edits.collect(), certain: true })
        });
    }
}
