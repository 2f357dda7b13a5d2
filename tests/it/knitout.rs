//! Knitout: verdicts on whole programs, an accepting and a rejecting case for each rule, and any bytes at all.
#![expect(clippy::unwrap_used, reason = "helpers of tests")]

use picot::diag::{Sink, Sources};
use picot::frontend::knitout;
use picot::ir::machine::{self, Machine, Report};
use proptest::prelude::*;
use std::fmt::Write as _;
use std::io;

/// Reads and runs a program; findings as `CODE@line`, in order, and the report when it could be run.
fn judge(bytes: &[u8], machine: Option<&Machine>) -> (Vec<String>, Option<Report>) {
    let loader = |_: &str| -> io::Result<Vec<u8>> { Err(io::ErrorKind::NotFound.into()) };
    let mut sources = Sources::new(&loader);
    let source = sources.add("test.k", bytes.to_vec()).unwrap();
    let mut sink = Sink::new();
    let report = knitout::read(&source, &mut sink).map(|code| {
        let named = code.header("Machine").and_then(Machine::named);
        machine::execute(&code, machine.or(named.as_ref()), &mut sink).report
    });
    let findings = sink
        .take()
        .iter()
        .map(|finding| {
            let line = finding
                .labels
                .first()
                .and_then(|label| source.range(label.span))
                .map_or(0, |range| 1 + bytes[..range.start].split(|byte| *byte == b'\n').count() - 1);
            format!("{}@{line}", finding.code.as_str())
        })
        .collect();
    (findings, report)
}

#[expect(clippy::disallowed_methods, reason = "the test reads its own cases")]
fn program(name: &str) -> Vec<u8> {
    let path = format!("{}/tests/it/cases/knitout/{name}.k", env!("CARGO_MANIFEST_DIR"));
    std::fs::read(path).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Every program with what it must give. `E` rejects, `W` warns; nothing else may be said.
const VERDICTS: &[(&str, &[&str])] = &[
    ("good_01_flat", &[]),
    ("good_03_incdec", &[]),
    ("good_05_shortrows", &[]),
    ("good_07_stripes", &[]),
    ("kn_01_flat", &[]),
    ("kn_03_incdec", &[]),
    ("kn_05_shortrows", &[]),
    ("kn_07_stripes", &[]),
    ("spec_01_extensions", &[]),
    ("spec_03_amiss", &[]),
    ("spec_05_named_carriers", &[]),
    ("spec_07_quarter_rack", &[]),
    ("bad_01_no_magic", &["E2001@1"]),
    ("bad_03_unknown_carrier", &["E2007@6"]),
    ("bad_05_knit_without_inhook", &["E2101@6"]),
    // The program racks to 0 three times at its end.
    ("bad_07_xfer_onto_occupied_stack", &["W2416@42", "W2419@45", "W2419@46", "W2411@47"]),
    ("bad_09_rack_not_number", &["E2006@28"]),
    ("bad_11_unknown_op", &["E2002@28"]),
    ("bad_13_missing_direction", &["E2005@28"]),
    ("bad_15_outhook_not_in", &["E2103@28", "W2411@29"]),
    ("bad_17_release_before_knit", &["E2105@7"]),
    ("bad_19_knit_empty_needle", &["W2413@28", "W2413@29", "W2411@30"]),
    ("bad_21_loops_left_on_needles", &["W2411@98"]),
    ("bad_23_slider_knit", &["E2110@28", "W2411@29"]),
    ("bad_25_truncated_line", &["E2003@28"]),
    ("bad_27_crlf", &["W2403@1"]),
    ("bad_29_carriers_after_op", &["W2402@3", "W2402@4", "W2402@5", "W2402@6", "W2401@1"]),
    ("bad_31_hook_blocks_needle", &["E2116@26"]),
    ("knbad_01_no_magic", &["E2001@1"]),
    ("knbad_03_unknown_carrier", &["E2007@6"]),
    ("knbad_05_knit_without_inhook", &["E2101@6"]),
    ("knbad_07_xfer_onto_occupied_stack", &["W2416@41", "W2419@44", "W2419@45", "W2411@46"]),
    ("knbad_09_rack_not_number", &["E2006@27"]),
    ("knbad_11_unknown_op", &["E2002@27"]),
    ("knbad_13_missing_direction", &["E2005@27"]),
    ("knbad_15_outhook_not_in", &["E2103@27", "W2411@28"]),
    ("knbad_19_knit_empty_needle", &["W2413@27", "W2413@28", "W2411@29"]),
    ("knbad_21_loops_left_on_needles", &["W2411@97"]),
    ("knbad_23_slider_knit", &["E2110@27", "W2411@28"]),
    ("knbad_25_truncated_line", &["E2003@27"]),
    ("knbad_33_inhook_on_kniterate", &["E2113@6"]),
    // Both yarns tuck on each needle and none is dropped.
    ("knbad_35_two_carriers_one_op", &["E2114@6", "W2411@18", "E2114@18"]),
];

#[test]
fn programs_get_their_verdicts() {
    let mut wrong = String::new();
    for (name, expected) in VERDICTS {
        let (found, _) = judge(&program(name), None);
        if found != *expected {
            let _ = writeln!(wrong, "{name}: {found:?}, expected {expected:?}");
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}

#[test]
fn every_program_has_a_verdict() {
    let folder = format!("{}/tests/it/cases/knitout", env!("CARGO_MANIFEST_DIR"));
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        assert!(VERDICTS.iter().any(|(known, _)| *known == name), "{name} has no verdict");
    }
}

const HEAD: &str = ";!knitout-2\n;;Carriers: 1 2 3\n";

/// A rule: lines that keep it, lines that break it, and what is then said. Lines follow [`HEAD`], so they begin with 3.
struct Rule {
    keeps: &'static str,
    breaks: &'static str,
    says: &'static [&'static str],
    machine: Option<&'static str>,
}

const fn rule(keeps: &'static str, breaks: &'static str, says: &'static [&'static str]) -> Rule {
    Rule { keeps, breaks, says, machine: None }
}

const fn on(
    machine: &'static str,
    keeps: &'static str,
    breaks: &'static str,
    says: &'static [&'static str],
) -> Rule {
    Rule { keeps, breaks, says, machine: Some(machine) }
}

const RULES: &[Rule] = &[
    // Words.
    rule("x-vis-color #ff00ff 1\npause stop here; now", "KNIT + f1 1", &["E2002@3"]),
    rule("\t in  1\n\n;\n\ttuck +\tf-2 1\nout 1\ndrop f-2", "in 1 1", &["E2008@3"]),
    rule("rack +1\nrack -0.25\nrack 0.75", "rack 0.3", &["E2006@3"]),
    rule("stitch 3 -4.5", "stitch 3", &["E2003@3"]),
    rule("stitch +3 .5", "stitch 3 4e1", &["E2006@3"]),
    rule("amiss fs1", "amiss f", &["E2004@3"]),
    rule("amiss b32767", "amiss b32768", &["E2004@3"]),
    rule("amiss bs-1", "amiss g1", &["E2004@3"]),
    rule("amiss f1", "amiss f1 1", &["E2003@3"]),
    rule("rack 1", "rack 1 2", &["E2003@3"]),
    rule("in 1\ntuck + f1 1\nout 1\ndrop f1", "in 1\ntuck f1 1", &["E2005@4"]),
    rule("", "in 4\nin 4", &["E2007@3"]),
    // Carriers and hook.
    rule("in 1\ntuck + f1 1\nout 1\ndrop f1", "tuck + f1 1\nout 1\ndrop f1", &["E2101@3"]),
    rule(
        "in 1\ntuck + f1 1\nout 1\nin 1\nknit + f1 1\nout 1\ndrop f1",
        "in 1\ntuck + f1 1\nout 1\nknit + f1 1\nout 1\ndrop f1",
        &["E2101@6"],
    ),
    rule("in 1 2\ntuck + f1 1 2\nout 1 2\ndrop f1", "in 1\nin 1\ntuck + f1 1\nout 1\ndrop f1", &["E2102@4"]),
    rule("", "out 2", &["E2103@3"]),
    rule("inhook 1\ntuck - f1 1\nreleasehook 1\nouthook 1\ndrop f1", "releasehook 1", &["E2104@3"]),
    rule(
        "inhook 1\ntuck - f1 1\nreleasehook 1\ninhook 2\ntuck - f1 2\nreleasehook 2\nouthook 1\nouthook 2\ndrop f1",
        "inhook 1\ntuck - f1 1\ninhook 2\ntuck - f1 2\nreleasehook 2\nouthook 1\nouthook 2\ndrop f1",
        &["E2106@5"],
    ),
    rule("", "inhook 1\ntuck - f1 1\nouthook 1\ndrop f1", &["E2107@5"]),
    rule("", "in 1\nout 1", &["W2420@3"]),
    rule("", "in 1\ntuck + f1 1\ndrop f1", &["W2412@3"]),
    rule("", "in", &["W2409@3"]),
    // Transfers.
    rule(
        "in 1\ntuck + f1 1\nxfer f1 b1\nrack 1\nxfer b1 f2\nrack 0\nout 1\ndrop f2",
        "in 1\ntuck + f1 1\nxfer f1 b1\nxfer b1 f2\nout 1\ndrop f2",
        &["E2109@6"],
    ),
    rule(
        "in 1\ntuck + f1 1\nsplit + f1 b1 1\nout 1\ndrop f1\ndrop b1",
        "in 1\ntuck + f1 1\nxfer f1 f2\nout 1\ndrop f2",
        &["E2108@5"],
    ),
    rule(
        "in 1\ntuck + f1 1\nxfer f1 bs1\nxfer bs1 f1\nout 1\ndrop f1",
        "in 1\ntuck + fs1 1\nout 1\ndrop f1",
        &["E2110@4"],
    ),
    rule("", "drop f1", &["W2414@3"]),
    rule("", "xfer f1 b1", &["W2414@3"]),
    rule("", "inhook 1\ntuck - f1 1\nxfer f1 b1\nreleasehook 1\nouthook 1\ndrop b1", &["W2415@5"]),
    rule(
        "in 1\ntuck + f1 1\nout 1\nrack 1\nrack 0\ndrop f1",
        "in 1\ntuck + f1 1\nout 1\nrack 0\ndrop f1",
        &["W2419@6"],
    ),
    // Profiles.
    on(
        "kniterate",
        "in 1\ntuck + f252 1\nout 1\ndrop f252",
        "in 1\ntuck + f253 1\nout 1\ndrop f253",
        &["E2111@4", "E2111@6"],
    ),
    on("kniterate", "rack 0.5", "rack 0.25", &["E2112@3"]),
    on("swg091n2", "rack 4\nrack -0.75", "rack 25", &["E2112@3"]),
    on("kniterate", "in 1\ntuck + f1 1\nout 1\ndrop f1", "in 1\ntuck - f1 1\nout 1\ndrop f1", &["E2115@4"]),
    on(
        "swg091n2",
        "inhook 1\ntuck - f10 1\ntuck - f9 1\nreleasehook 1\nouthook 1\ndrop f9\ndrop f10",
        "inhook 1\ntuck + f10 1\nreleasehook 1\nouthook 1\ndrop f10",
        &["E2115@4"],
    ),
    on("kniterate", "", "in 1\ntuck + f1 1\nxfer f1 bs1\nout 1\ndrop bs1", &["E2110@5"]),
    on("swg091n2", "", "in 1\ntuck - f1 1\nout 1\ndrop f1", &["W2421@3"]),
    on("swg091n2", "x-speed-number 15", "x-speed-number 16", &["W2422@3"]),
    on("swg091n2", "x-presser-mode on", "x-vis-color #fff 1", &["W2405@3"]),
    on(
        "kniterate",
        "in 1\ntuck + f10 1\ntuck + f30 1\nout 1\ndrop f10\ndrop f30",
        "in 1\ntuck + f10 1\ntuck + f31 1\nout 1\ndrop f10\ndrop f31",
        &["W2417@5"],
    ),
    on(
        "kniterate",
        "in 1\ntuck + f10 1\ntuck + b14 1\nrack 2\nrack 0\nout 1\ndrop f10\ndrop b14",
        "in 1\ntuck + f10 1\ntuck + b14 1\nrack 3\nrack 0\nout 1\ndrop f10\ndrop b14",
        &["W2418@6"],
    ),
];

#[test]
fn every_rule_accepts_and_rejects() {
    let mut wrong = String::new();
    for Rule { keeps, breaks, says, machine } in RULES {
        let machine = machine.and_then(Machine::named);
        let (kept, _) = judge(format!("{HEAD}{keeps}\n").as_bytes(), machine.as_ref());
        let (broken, _) = judge(format!("{HEAD}{breaks}\n").as_bytes(), machine.as_ref());
        if !kept.is_empty() || broken != *says {
            let _ = writeln!(wrong, "{keeps:?}: {kept:?}\n{breaks:?}: {broken:?}, expected {says:?}\n");
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}

#[test]
fn headers_are_read_as_the_format_says() {
    let heads: &[(&str, &[&str])] = &[
        (";!knitout-2\n;;Carriers: A,B;C D\nin A B C D", &["W2412@3", "W2412@3", "W2412@3", "W2412@3"]),
        (";!knitout-9\n;;Carriers: 1\n", &["W2404@1"]),
        (";!knitout-2\n;;Carriers: 1\n;;Carriers: 2\n;;X-Mine: a; b\n", &["W2407@3"]),
        (";!knitout-2\n;;Carriers: 1\n;;Mood: good\n", &["W2406@3"]),
        (";!knitout-2\n;;Carriers: 1 1\n", &["E2008@2"]),
        (";!knitout-2\n;;Carriers 1\n", &["W2408@2", "W2401@1"]),
        (";!knitout-2\n;;Carriers: 1\n\n;;Machine: kniterate\n", &["W2402@4"]),
        (";!knitout-\n;;Carriers: 1\n", &["E2001@1"]),
        ("\u{feff};!knitout-2\n;;Carriers: 1\n", &["E2001@1"]),
        ("", &["E2001@1", "W2401@1"]),
    ];
    for (text, expected) in heads {
        assert_eq!(judge(text.as_bytes(), None).0, *expected, "{text:?}");
    }
    assert_eq!(judge(b";!knitout-2\n\xff", None).0, ["E2009@2"]);
}

#[test]
fn profiles_are_documented_field_by_field() {
    use machine::{MACHINES, profile::FIELDS};
    fn keys(table: &toml::Table, prefix: &str, out: &mut Vec<String>) {
        for (key, value) in table {
            match value.as_table() {
                Some(inner) => keys(inner, &format!("{prefix}{key}."), out),
                None => out.push(format!("{prefix}{key}")),
            }
        }
    }
    let mut used = Vec::new();
    for (name, text) in MACHINES {
        assert_eq!(Machine::named(name).map(|machine| machine.name).as_deref(), Some(*name));
        keys(&text.parse().unwrap(), "", &mut used);
    }
    let hand = format!("{}\ngauge = 1", crate::hand::HAND);
    keys(&hand.parse().unwrap(), "", &mut used);
    used.sort();
    used.dedup();
    let mut documented: Vec<_> = FIELDS.iter().map(|field| field.key.to_owned()).collect();
    documented.sort();
    assert_eq!(used, documented);
}

#[test]
fn broken_profiles_are_refused_at_their_place() {
    let text = machine::MACHINES[1].1;
    let loader = |_: &str| -> io::Result<Vec<u8>> { Err(io::ErrorKind::NotFound.into()) };
    for (from, to, says) in [
        ("per_op = 1", "per_op = 0", "`carriers.per_op` must be at least 1"),
        ("[1, 252]", "[252, 1]", "`bed.needles` must rise, within 32767 either way"),
        ("yarn = \"2\"", "yarn = \"9\"", "`carriers.yarn` is not among carriers.names"),
        ("max = 4.0", "max = nan", "`rack` needs positive numbers for max, preferred and step"),
        ("gauge = 7", "guage = 7", "unknown field `guage`"),
        ("\"gripper\"", "\"hand\"", "unknown variant `hand`"),
    ] {
        let mut sources = Sources::new(&loader);
        let source = sources.add("m.toml", text.replace(from, to).into_bytes()).unwrap();
        let mut sink = Sink::new();
        assert!(Machine::read(&source, &mut sink).is_none());
        assert!(sink.diagnostics()[0].message.starts_with(says), "{:?}", sink.diagnostics());
    }
}

/// Writing what was read and reading it again gives the same program, comments and all.
#[test]
fn what_is_written_reads_back() {
    let loader = |_: &str| -> io::Result<Vec<u8>> { Err(io::ErrorKind::NotFound.into()) };
    let read = |bytes: Vec<u8>| {
        let mut sources = Sources::new(&loader);
        let source = sources.add("a.k", bytes).unwrap();
        knitout::read(&source, &mut Sink::new())
    };
    let mut compared = 0;
    let extra = format!(
        "{HEAD};first\nin 1 ; with a comment\n;!source: a;b\nrack 0.25\nstitch 3 -4.5\npause stop\nmiss + b-3 1 2\n\
         split + fs1 bs1\nsplit - f1 b1 1\nknit + f1\nx-vis-color #fff 1\nreleasehook 1\nouthook 1;last\n;end\n;\n"
    );
    let all = VERDICTS.iter().map(|(name, _)| program(name)).chain([extra.into_bytes()]);
    for mut code in all.filter_map(read) {
        let mut text = Vec::new();
        picot::backends::knitout::write(&code, &mut text).unwrap();
        let mut again = read(text.clone()).unwrap();
        for code in [&mut code, &mut again] {
            code.headers.iter_mut().for_each(|header| header.span = picot::diag::Span::NONE);
            *code = code.without_spans();
        }
        assert_eq!(again, code, "{}", String::from_utf8_lossy(&text));
        compared += 1;
    }
    assert!(compared > 20);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(4), ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_get_an_answer(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        judge(&bytes, None);
        judge(&[HEAD.as_bytes(), &bytes].concat(), None);
    }

    #[test]
    fn broken_programs_get_an_answer(
        which in 0..VERDICTS.len(),
        edits in proptest::collection::vec((0_usize..6000, prop_oneof![
            Just(String::new()), "[a-z0-9+;: -]{1,4}", Just("\n".to_owned()), Just("xfer f10 b10\n".to_owned()), Just("f99999".to_owned()),
        ]), 1..6),
    ) {
        let mut bytes = program(VERDICTS[which].0);
        for (at, text) in &edits {
            let at = (*at).min(bytes.len());
            let end = (at + text.len()).min(bytes.len());
            bytes.splice(at..end, text.bytes());
        }
        judge(&bytes, Machine::named("kniterate").as_ref());
        judge(&bytes, None);
    }
}
