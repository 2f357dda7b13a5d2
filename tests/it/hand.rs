//! Profiles of a hand: what a crocheting hand or machine bears, told at part, round and stitch.

use crate::command::{Folder, picot};
use picot::diag::{Sink, Sources};
use picot::frontend::crochet::{self, Conventions};
use picot::ir::machine::Profile;
use picot::ir::verify::verify;
use std::io;

pub(crate) const HAND: &str = "name = \"arm\"\nkind = \"hand\"\nstitches = [\"sc\", \"inc\", \"dec\", \"ring\"]\nmax_increases = 6\n\
                    max_decreases = 3\nmin_round = 6\nmax_round = 20\n";

/// What a profile says of a pattern.
fn told(profile: &str, pattern: &str) -> Vec<String> {
    let loader = |_: &str| -> io::Result<Vec<u8>> { Err(io::ErrorKind::NotFound.into()) };
    let mut sources = Sources::new(&loader);
    let mut sink = Sink::new();
    let source = sources.add("arm.toml", profile.into()).expect("room");
    let text = sources.add("frog.txt", pattern.into()).expect("room");
    if let Some(Profile::Hand(hand)) = Profile::read(&source, &mut sink) {
        let read = crochet::read(&text, &Conventions::default(), &mut sink);
        let Some(picot::frontend::Input::Program(program)) = read else { panic!("{:?}", sink.diagnostics()) };
        let verified = verify(&program, &mut sink).expect("workable");
        let before = sink.errors();
        let makes = hand.makes(&verified, &mut sink);
        assert_eq!(makes, sink.errors() == before);
    }
    let line = |found: &picot::diag::Diagnostic| {
        let round = found.place.as_ref().and_then(|place| place.round).unwrap_or(0);
        format!("{} {round}: {}; {}", found.code.as_str(), found.message, found.help.as_deref().unwrap_or(""))
    };
    sink.diagnostics().iter().filter(|found| found.code.as_str().starts_with('E')).map(line).collect()
}

#[test]
fn each_limit_is_told_with_its_place_and_its_field() {
    let fits = "Rnd 1: 6 sc in MR\nRnd 2: 6 inc (12)\nRnd 3: (inc, sc) x 6 (18)\nRnd 4: 18 sc (18)\n";
    assert_eq!(told(HAND, fits), [""; 0]);
    let cases = [
        (
            "Rnd 1: 6 sc in MR\nRnd 2: 6 inc (12)\nRnd 3: 12 inc (24)\n",
            vec![
                "E2202 3: 12 increases in one round; `max_increases` of `arm` is 6",
                "E2202 3: the round has 24 stitches; `max_round` of `arm` is 20",
            ],
        ),
        (
            "Rnd 1: 6 sc in MR\nRnd 2: 6 inc (12)\nRnd 3: 6 dec (6)\nRnd 4: 3 dec (3)\n",
            vec![
                "E2202 3: 6 decreases in one round; `max_decreases` of `arm` is 3",
                "E2202 4: the round has 3 stitches; `min_round` of `arm` is 6",
            ],
        ),
        (
            "Rnd 1: 6 sc in MR\nRnd 2: 4 sc, 2 hdc (6)\n",
            vec!["E2202 2: stitch 5 needs `hdc`; `stitches` of `arm` is sc, inc, dec, ring"],
        ),
        (
            "Rnd 1: ch 8, join with sl st\nRnd 2: 8 sc (8)\nRnd 3: 4 sc, <-, 2 sc, ->, 6 sc (8)\n",
            vec![
                "E2202 1: the part begins with `ch`; `stitches` of `arm` is sc, inc, dec, ring",
                "E2202 2: stitch 5 needs `turn`; `stitches` of `arm` is sc, inc, dec, ring",
            ],
        ),
    ];
    for (pattern, expected) in cases {
        assert_eq!(told(HAND, pattern), expected, "{pattern}");
    }
}

#[test]
fn a_broken_profile_says_what_is_wrong() {
    let pattern = "Rnd 1: 6 sc in MR\n";
    for (from, to, says) in [
        ("\"dec\"", "\"decc\"", "`stitches` lists `decc`, which is no US abbreviation; did you mean `dec`?"),
        ("max_round = 20", "max_round = 5", "`max_round` is less than `min_round`"),
        ("max_round", "max_rounds", "unknown field `max_rounds`"),
        ("min_round = 6", "min_round = -6", "invalid value: integer `-6`"),
    ] {
        let found = told(&HAND.replace(from, to), pattern);
        assert!(found.len() == 1 && found[0].starts_with(&format!("E2190 0: {says}")), "{found:?}");
    }
    let sizes = format!("{HAND}[gauge]\nwidth = [3.0, 2.0]\nheight = [2.0, 9.0]\n");
    assert!(told(&sizes, pattern)[0].contains("`gauge` needs"), "{:?}", told(&sizes, pattern));
}

#[test]
fn shapes_are_refused_with_status_4_and_no_machine_code_is_written_for_a_hand() {
    let folder = Folder::new();
    let hand = HAND.replace("max_decreases = 3", "max_decreases = 6");
    let sizes = "[gauge]\nwidth = [2.0, 20.0]\nheight = [2.0, 20.0]\n";
    let profile = folder.file("arm.toml", format!("{hand}{sizes}"));
    let profile = profile.as_str();
    let run = |arguments: &[&str]| picot(arguments).assert().get_output().clone();
    let ball = ["build", "shapes/ball.toml", "--machine", profile, "--to", "crochet"];
    let output = run(&ball);
    assert_eq!(output.status.code(), Some(4));
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(text.contains("`max_round` of `arm` is 20") && output.stdout.is_empty(), "{text}");
    let output = run(&["build", "shapes/ball.toml", "--machine", profile, "--to", "knitout"]);
    assert_eq!(output.status.code(), Some(4));
    // Larger stitches fit.
    let output =
        run(&["build", "shapes/ball.toml", "--machine", profile, "--to", "crochet", "--gauge", "14mmx14mm"]);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{text}");
}
