//! The reader on input of any kind: it never panics, it refuses what is too large, and its time is linear.

#![expect(clippy::unwrap_used, clippy::disallowed_methods, reason = "fuzzing stops by the clock")]

use crate::examples::check;
use picot::diag::{Sink, Sources};
use picot::frontend::crochet::{Conventions, Document};
use std::fmt::Write;
use std::time::{Duration, Instant};

fn read(bytes: &[u8]) -> Vec<String> {
    let loader = |_: &str| Err(std::io::Error::other("no files"));
    let mut sources = Sources::new(&loader);
    let source = sources.add("pattern.txt", bytes.to_vec()).unwrap();
    let mut sink = Sink::new();
    let conventions = Conventions::default();
    if let Some(document) = Document::parse(&source, conventions.language, &mut sink) {
        let checked = document.check(&conventions, &mut sink);
        if let Some(program) = &checked.program {
            picot::ir::verify::verify(program, &mut sink);
        }
        let _ = document.format();
    }
    for found in sink.diagnostics() {
        for label in &found.labels {
            let (file, range) = sources.locate(label.span).expect("a label lies in a file");
            if let Ok(text) = file.text() {
                assert!(text.is_char_boundary(range.start) && text.is_char_boundary(range.end), "{found:?}");
            }
        }
    }
    sink.diagnostics().iter().map(|found| found.code.as_str().to_owned()).collect()
}

/// A small generator of numbers, the same every time.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % bound.max(1)
    }
}

const SEEDS: &[&str] = &[
    "Rnd 1: 6 sc in MR (6)\nRnd 2: inc around (12)\nRnd 3: (sc, inc) x 6 (18)\nRnds 4-6: 18 sc (18)\n",
    "terms: uk\nRow 1: ch 29, htr in 3rd ch from hook and in each ch across (27)\nRow 2: ch 2, turn, *3 tr, dec; rep from * to last 2 sts, 2 tr\n",
    "lang: letters\nR1: 6X in MR\nR2: 6V (12)\nR3: (X, V)*6\nR4: 18X <- -6X -> 6X\n",
    "Leg (make 2):\nRnd 1: 7 sc in MR (7)\nBody: join Leg + ch 3 + Leg\nRnd 1: 7 sc over Leg, 3 sc over ch, 7 sc over Leg, 3 sc over ch (20)\nRnd 2: 5 sc, hold 8 sts for Arm, 7 sc\nArm: from Body rnd 1 sts 6-13 held\nRnds 1-9: 8 sc (8)\n",
    "lang: es\nV1: 6 pb en AM\nV2: 6 aum = 12\nV3: *1 pb, 1 aum* 6 veces = 18 pb // ya\n",
    "color white = #fff\nRnd 1: ch 9, sc in 2nd ch from hook, sc in next 6 ch, 3 sc in last ch, on other side of ch: sc in next 6 ch, 2 sc in last ch (18)\nRnd 2: with A, 5 sc BLO, change to white, (2 dc, ch 1, 2 dc) in next st, sk 2 sts, 10 sc (20)\n",
];

const WORDS: &[&str] = &[
    "sc",
    "inc",
    "dec",
    "(",
    ")",
    "[",
    "]",
    "*",
    "**",
    "x",
    "7",
    "999999999",
    ",",
    ";",
    ".",
    ":",
    "rep",
    "from",
    "around",
    "<-",
    "->",
    "ch",
    "turn",
    "in",
    "next",
    "each",
    "st",
    "to",
    "last",
    "evenly",
    "MR",
    "Rnd",
    "Row",
    "=",
    "-",
    "—",
    "→",
    "same",
    "hold",
    "for",
    "leave",
    "unworked",
    "join",
    "\n",
    "over",
    "2nd",
    "hook",
    "sk",
    "tog",
    "blo",
    "lang:",
    "0",
    "\u{202e}",
    "ﬁ",
];

fn fuzz(random: &mut Random) -> Vec<u8> {
    let mut bytes: Vec<u8> = match random.below(4) {
        0 => (0..random.below(200)).map(|_| random.below(256) as u8).collect(),
        1 => {
            let words: Vec<&str> = (0..random.below(40)).map(|_| WORDS[random.below(WORDS.len())]).collect();
            let joined = words.join(if random.below(2) == 0 { " " } else { "" });
            format!("Rnd 1: 6 sc in MR\nRnd 2: {joined}\n").into_bytes()
        }
        _ => SEEDS[random.below(SEEDS.len())].as_bytes().to_vec(),
    };
    for _ in 0..random.below(6) {
        let at = random.below(bytes.len() + 1);
        match random.below(4) {
            0 if at < bytes.len() => bytes[at] = random.below(256) as u8,
            1 if at < bytes.len() => {
                bytes.remove(at);
            }
            2 => {
                let word = WORDS[random.below(WORDS.len())];
                bytes.splice(at..at, word.bytes());
            }
            _ => {
                let from = random.below(bytes.len() + 1).min(at);
                let copy = bytes[from..at].to_vec();
                bytes.splice(at..at, copy.into_iter().take(80));
            }
        }
    }
    bytes
}

#[test]
fn fuzz_for_about_a_second() {
    let mut random = Random(0x5EED_CAFE_F00D_1234);
    let begun = Instant::now();
    let mut inputs = 0_u32;
    while begun.elapsed() < Duration::from_secs(1) {
        read(&fuzz(&mut random));
        inputs += 1;
    }
    assert!(inputs > 100);
}

/// Runs for as many inputs as `PICOT_FUZZ` says, ten million by default: `cargo test --release -- --ignored fuzz_long`.
#[test]
#[ignore = "runs for minutes to hours"]
fn fuzz_long() {
    let inputs =
        std::env::var("PICOT_FUZZ").ok().and_then(|count| count.parse().ok()).unwrap_or(10_000_000_u64);
    let seed =
        std::env::var("PICOT_SEED").ok().and_then(|seed| seed.parse().ok()).unwrap_or(0x1234_5678_9ABC_DEF1);
    let mut random = Random(seed);
    let begun = Instant::now();
    for _ in 0..inputs {
        read(&fuzz(&mut random));
    }
    println!("{inputs} inputs in {:?}", begun.elapsed());
}

#[test]
fn repeats_of_repeats_are_refused_with_a_reason() {
    for body in [
        "((((sc x 999999999) x 999999999)",
        "((((sc x 999999999) x 999999999) x 999999999) x 999999999)",
        "999999999 sc",
        "99999999999999999999999999 sc",
        "(inc x 99999) x 99999",
        "(sc, inc4000000000) x 3",
    ] {
        let (errors, checked) =
            check(&format!("Rnd 1: 6 sc in MR\nRnd 2: {body}\n"), &Conventions::default());
        assert!(!errors.is_empty(), "{body}");
        assert!(checked.unwrap().program.is_none());
    }
    let (errors, _) = check(
        "Rnd 1: 6 sc in MR\nRnd 2: (((sc x 999999999) x 999999999) x 999999999)\n",
        &Conventions::default(),
    );
    assert!(errors[0].starts_with("E0006"), "{errors:?}");
    let deep = format!("Rnd 1: 6 sc in MR\nRnd 2: {}6 sc{}\n", "(".repeat(100_000), ")".repeat(100_000));
    let (errors, _) = check(&deep, &Conventions::default());
    assert!(errors[0].starts_with("E0006"), "{errors:?}");
}

#[test]
fn text_of_all_kinds_is_read_or_refused() {
    assert_eq!(read(b"Rnd 1: 6 sc in MR (6)\xff\n"), ["E0009"]);
    assert_eq!(read(b"Rnd 1: 6 sc in MR (6)\0\n")[0], "E0009");
    assert_eq!(read("Rnd 1: 6 sc \u{202e}in MR (6)\n".as_bytes())[0], "E0009");
    let plain: &[&str] = &[];
    for text in [
        "Rnd 1: 6 sc in MR (6)\r\nRnd 2: inc around (12)\r\n",
        "Rnd 1: 6 sc in MR (6)\rRnd 2: inc around (12)\r",
        "\u{feff}Rnd 1: 6 sc in MR (6)\nRnd 2: inc around (12)",
        "Rnd 1: 6 sc in MR (6)\nRnd\u{a0}2: inc around\u{200e} (12)\n",
        "Ｒnd １: ６ sc in MR (６)\nRnd 2: （inc） x ６ (12)\n",
        "Rnd 1: 6 sc in MR (6)\nRnd 2: inc around – 12\n",
        "Rnd 1: 6 sc in MR (6)\nRnd 2: inc around — 12 sts\n",
        "// “smart quotes” and ‘others’\nRnd 1: 6 sc in MR (6)\n\u{201c}Left Leg\u{201d}: \n",
    ] {
        let found = read(text.as_bytes());
        let errors: Vec<&String> = found.iter().filter(|code| code.starts_with('E')).collect();
        assert_eq!(errors, plain, "{text:?}");
    }
}

fn rounds(count: u32) -> String {
    let mut text = String::from("Rnd 1: 6 sc in MR (6)\nRnd 2: inc around (12)\nRnd 3: (sc, inc) x 6 (18)\n");
    for round in 4..=count {
        let body = match round % 3 {
            0 => "(5 sc, dec, inc) x 2, 2 sc",
            1 => "18 sc",
            _ => "(sc, inc, 2 sc, dec) x 3",
        };
        writeln!(text, "Rnd {round}: {body} (18)").unwrap();
    }
    text
}

#[test]
fn a_hundred_thousand_rounds_take_linear_time() {
    let time = |text: &str| {
        let begun = Instant::now();
        let found = read(text.as_bytes());
        assert!(found.is_empty(), "{:?}", &found[..found.len().min(3)]);
        begun.elapsed()
    };
    let small = time(&rounds(10_000));
    let large = time(&rounds(100_000));
    // Ten times the text: a quadratic reader would take a hundred times as long.
    assert!(large < small * 40 + Duration::from_millis(500), "{small:?} then {large:?}");
}

#[test]
fn faults_on_every_line_take_linear_time() {
    let mut text = String::from("Rnd 1: 6 sc in MR (6)\n");
    for round in 2..20_000 {
        writeln!(text, "Rnd {round}: (3 sc, inc) x {} ({})", round % 50, round % 70).unwrap();
    }
    let found = read(text.as_bytes());
    assert!(found.len() > 1000);
}

#[test]
fn parts_and_repeated_rows_take_linear_time() {
    let mut parts = String::new();
    for part in 0..20_000 {
        writeln!(parts, "Leg {part}:\nRnd 1: 6 sc in MR (6)").unwrap();
    }
    assert_eq!(read(parts.as_bytes()), [""; 0]);
    let flat = "Row 1: 6 fsc (6)\nRow 2: 6 sc (6)\nRow 3: 6 sc (6)\n";
    assert_eq!(read(format!("{flat}Rows 4-50003: rep rows 2 and 3\n").as_bytes()), [""; 0]);
    // Each line lists four thousand million rows; a quadratic reader would never come to an end.
    let bomb = "Rows 4-4294967295: rep rows 2-3\n".repeat(2_000);
    assert!(read(format!("{flat}{bomb}").as_bytes()).iter().any(|code| code == "E0006"));
}

#[test]
fn flat_rows_come_back_to_the_loops_that_short_ones_left() {
    let heel = |last: &str| {
        format!(
            "Row 1: 12 fsc, turn (12)\nRow 2: 8 sc, leave 4 sts unworked, turn (8)\n\
             Row 3: sc across, turn (8)\n{last}\nRow 5: sc across (12)\n"
        )
    };
    assert_eq!(read(heel("Row 4: 8 sc, 4 sc, turn (12)").as_bytes()), [""; 0]);
    assert_eq!(read(heel("Row 4: sc across, turn (12)").as_bytes()), ["W0401"]);
    assert_eq!(
        read(format!("convention: across-step=all\n{}", heel("Row 4: sc across, turn")).as_bytes()),
        [""; 0]
    );
    assert_eq!(read(heel("Row 4: 13 sc, turn (13)").as_bytes())[0], "E0101");
}

#[test]
fn mc_is_a_ring_or_a_color() {
    assert_eq!(read(b"Rnd 1: MC 6 (6)\nRnd 2: inc around (12)\n"), [""; 0]);
    assert_eq!(read(b"Rnd 1: 6 sc in MC (6)\n"), [""; 0]);
    assert_eq!(read(b"Rnd 1: 6 sc in MR (6)\nRnd 2: MC, 6 sc (6)\n"), ["E0008"]);
    let colors = "color MC = #ff0000\ncolor CC = #00ff00\n";
    assert_eq!(
        read(format!("{colors}Rnd 1: 6 sc in MR (6)\nRnd 2: CC, 3 sc, 3 sc in MC (6)\n").as_bytes()),
        [""; 0]
    );
    let said = "convention: mc=color\nRnd 1: 6 sc in MR (6)\nRnd 2: MC, 6 sc (6)\nRnd 3: 6 sc in MC (6)\n";
    assert_eq!(read(said.as_bytes()), [""; 0]);
}

#[test]
fn a_huge_line_and_a_huge_file_are_refused() {
    let line = format!("Rnd 1: {}\n", "sc, ".repeat(2 << 20));
    assert_eq!(read(line.as_bytes()), ["E0006"]);
    assert_eq!(read(&vec![b'x'; 100_000_000]), ["E0006"]);
}

#[test]
fn granny_squares_are_worked_space_by_space() {
    let square = |second: &str| {
        format!(
            "terms: us\nRnd 1: magic ring, ch 3 (counts as dc), 2 dc in ring, ch 2, (3 dc in ring, ch 2) x 3, join with sl st (12)\n\
             Rnd 2: {second}, join with sl st\n"
        )
    };
    let plain: &[&str] = &[];
    let checked = |text: &str| check(text, &Conventions::default()).1.unwrap();
    for (second, made) in [
        ("*(3 dc, ch 2, 3 dc) in next ch-2 sp, ch 1; rep from * around", 24),
        ("(3 dc in next ch-2 sp, ch 1) x 4", 12),
        (
            "(3 dc, ch 2, 3 dc) in next ch-2 sp, ch 1, *(3 dc, ch 2, 3 dc) in next ch-2 sp, ch 1; rep from * 2 more times",
            24,
        ),
    ] {
        let text = square(second);
        let found = read(text.as_bytes());
        let errors: Vec<&String> = found.iter().filter(|code| code.starts_with('E')).collect();
        assert_eq!(errors, plain, "{second}");
        let program = checked(&text).program.expect("a pattern");
        assert!(picot::ir::verify::verify(&program, &mut Sink::new()).is_some(), "{second}");
        assert_eq!(checked(&text).parts[0].rounds[1].produces, Some(made), "{second}");
    }
}
