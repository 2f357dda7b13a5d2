//! From shapes to the text and the JSON that makers and scripts read.

use crate::{arbitrary, loops};
use glam::DVec2;
use glam::DVec3;
use picot::backends::crochet::{Arrows, Crochet, Style, Terms};
use picot::backends::{Backend, json::Json};
use picot::diag::Sink;
use picot::generate::{Options, generate};
use picot::ir::verify::verify;
use picot::ir::{
    Direction, Entry, Finish, Gauge, GaugeOrigin, Kind, Maker, Op, Part, PartId, Pattern, Program, Row,
    Segment, Start, Step, Stitch,
};
use picot::lower::trace;
use picot::shape::analytic::{Sphere, TorusArc};
use picot::shape::{Bezier, End, Interpolation, ParametricSurface, Profile, Section, Sweep, Tube, TubeSpec};
use proptest::prelude::*;
use serde_json::Value;

fn tube(surface: impl ParametricSurface + 'static, start: End, end: End) -> Tube {
    Tube::new("trunk", Box::new(surface), [start, end])
}

/// Shape D of the paper.
pub(crate) fn horn() -> Tube {
    let points = [DVec3::ZERO, DVec3::new(0.0, 0.0, 90.0), DVec3::new(0.0, 100.0, 0.0)];
    let section =
        |at, radius| Section { at, profile: Profile::Ellipse { axes: [radius; 2], offset: DVec2::ZERO } };
    let spec = TubeSpec {
        curve: vec![Bezier::new(&points).expect("a curve")],
        sections: vec![section(0.0, 10.0), section(1.0, 4.0)],
        interpolation: Interpolation::Linear,
        start: End::Open,
        end: End::Open,
    };
    tube(Sweep::new(&spec).expect("a tube"), End::Open, End::Open)
}

pub(crate) fn ball(radius: f64) -> Tube {
    tube(Sphere { radius }, End::Closed, End::Closed)
}

pub(crate) fn compiled(name: &str, tube: &Tube, gauge: Gauge) -> Program {
    let mut sink = Sink::new();
    let graph = generate(tube, &gauge, &Options::default(), &mut sink).expect("a graph");
    let finish = if tube.end == End::Closed { Finish::DrawnShut } else { Finish::Open };
    let part = trace(&tube.name, &graph, finish);
    let pattern = Pattern { parts: vec![part] };
    let mut program = Program {
        name: name.into(),
        gauge: Some(gauge),
        maker: Maker::default(),
        colors: Vec::new(),
        pattern,
        graphs: vec![graph],
    };
    picot::passes::run(&mut program, &mut sink);
    program
}

pub(crate) fn emitted(program: &Program, backend: &dyn Backend) -> String {
    let mut sink = Sink::new();
    let verified = verify(program, &mut sink).unwrap_or_else(|| panic!("{sink:?}"));
    let mut bytes = Vec::new();
    backend.emit(&verified, &mut bytes, &mut sink).expect("written");
    String::from_utf8(bytes).expect("text")
}

/// Rounds of a text: number, steps, count. Written for these tests from the grammar's canonical subset alone.
fn rounds(text: &str) -> Vec<(u32, Vec<Step>, u32)> {
    let mut rounds = Vec::new();
    for line in text.lines().filter(|line| line.starts_with("Rnd") && !line.contains("magic ring")) {
        let (label, rest) = line.split_once(": ").expect("a label");
        let rest = rest.strip_suffix(", close").unwrap_or(rest);
        let (body, count) = rest.rsplit_once(" (").expect("a count");
        let count = count.trim_end_matches(')').parse().expect("a number");
        let numbers = label.trim_start_matches("Rnds ").trim_start_matches("Rnd ");
        let (first, last) = numbers.split_once('-').unwrap_or((numbers, numbers));
        let [first, last] = [first, last].map(|number| number.parse::<u32>().expect("a number"));
        assert_eq!(label.starts_with("Rnds"), first < last);
        let mut steps = Vec::new();
        let mut back = false;
        let rest = body_steps(body, &mut back, &mut steps);
        assert!(rest.is_empty() && !back, "{line}");
        (first..=last).for_each(|number| rounds.push((number, steps.clone(), count)));
    }
    rounds
}

/// Reads clauses up to a closing bracket or the end; gives what is left.
fn body_steps<'t>(mut rest: &'t str, back: &mut bool, steps: &mut Vec<Step>) -> &'t str {
    loop {
        rest = rest.trim_start_matches([',', ' ']);
        if rest.is_empty() || rest.starts_with(')') {
            return rest;
        }
        let mark =
            [("←", Some(true)), ("<-", Some(true)), ("→", Some(false)), ("->", Some(false)), ("turn", None)];
        if let Some((word, to)) = mark.into_iter().find(|(word, _)| rest.starts_with(word)) {
            *back = to.unwrap_or(!*back);
            steps.push(Step::Turn(if *back { Direction::Back } else { Direction::Forward }));
            rest = &rest[word.len()..];
        } else if let Some(inner) = rest.strip_prefix('(') {
            let mut body = Vec::new();
            rest = body_steps(inner, back, &mut body).strip_prefix(") x ").expect("a repeat");
            let digits = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
            let times: usize = rest[..digits].parse().expect("a number");
            steps.extend(body.repeat(times));
            rest = &rest[digits..];
        } else {
            let end = rest.find([',', ')', '←', '→']).unwrap_or(rest.len());
            let end = [" <-", " ->"].iter().filter_map(|mark| rest.find(mark)).fold(end, usize::min);
            clause(rest[..end].trim(), steps);
            rest = &rest[end..];
        }
    }
}

fn clause(words: &str, steps: &mut Vec<Step>) {
    let words = words.trim_start_matches('-');
    if let Some(rest) = words.strip_prefix("leave last ") {
        let loops = rest.split(' ').next().and_then(|count| count.parse().ok()).expect("a number");
        return steps.push(Step::Leave { loops });
    }
    let (count, name) =
        words.split_once(' ').map_or((1, words), |(count, name)| (count.parse().expect("a number"), name));
    let stitch = match name {
        "sc" => Stitch::SC,
        "inc" => Stitch::INC,
        "dec" => Stitch::DEC,
        _ => panic!("{words}"),
    };
    steps.extend(vec![Step::Work(stitch); count]);
}

fn expected(program: &Program) -> Vec<Vec<Step>> {
    let rows = &program.pattern.parts[0].rows;
    rows.iter().flat_map(|row| vec![row.body.steps().collect(); row.times as usize]).collect()
}

fn forms() -> Vec<Crochet> {
    let ascii = Crochet { arrows: Arrows::Ascii, ..Crochet::default() };
    let words = Crochet { arrows: Arrows::Words, line_width: 24, ..Crochet::default() };
    vec![Crochet::default(), ascii, words, Crochet { style: Style::Paper, ..Crochet::default() }]
}

/// The text tells the steps of the program, with the counts of an independent simulation.
fn assert_readable(program: &Program) {
    let start = program.pattern.parts[0].start.loops();
    for form in forms() {
        let text = emitted(program, &form);
        let rounds = rounds(&text);
        let steps: Vec<_> = rounds.iter().map(|(_, steps, _)| steps.clone()).collect();
        assert_eq!(steps, expected(program), "{text}");
        let mut all = Vec::new();
        for (index, (number, steps, count)) in rounds.iter().enumerate() {
            assert_eq!(*number, program.pattern.parts[0].first_number() + index as u32);
            all.extend(steps);
            let left = steps
                .iter()
                .map(|step| if let Step::Leave { loops } = step { *loops } else { 0 })
                .sum::<u32>();
            assert_eq!(loops::simulate(start, &all, (0, 0)), Ok((count + left) as usize), "{text}");
        }
    }
}

/// The JSON tells the same steps twice, in its rounds and in its graph, and every loop is worked once.
fn assert_sound_json(program: &Program) {
    let json: Value = serde_json::from_str(&emitted(program, &Json {})).expect("JSON");
    let part = &json["parts"][0];
    let number = |value: &Value| value.as_u64().expect("a number");
    let mut rounds = Vec::new();
    let mut before = number(&part["start"]["loops"]);
    for round in part["rounds"].as_array().expect("rounds") {
        let mut steps = Vec::new();
        let mut left = 0;
        for step in round["steps"].as_array().expect("steps") {
            match step["op"].as_str().expect("an op") {
                "leave" => left = number(&step["loops"]),
                "turn" => steps.push(("turn".to_owned(), round["number"].clone())),
                op => {
                    for _ in 0..number(&step["times"]) {
                        steps.push((op.to_owned(), round["number"].clone()));
                    }
                }
            }
        }
        assert_eq!(number(&round["consumes"]) + left, before);
        before = number(&round["produces"]) + left;
        rounds.extend(steps);
    }
    let graph = &part["graph"];
    let stitches = graph["stitches"].as_array().expect("stitches");
    let told: Vec<_> =
        stitches.iter().map(|s| (s["op"].as_str().expect("an op").to_owned(), s["round"].clone())).collect();
    assert_eq!(told, rounds);
    let edges = graph["edges"].as_array().expect("edges");
    let kind = |kind: &str| edges.iter().filter(|edge| edge["kind"] == kind).count();
    let turns = stitches.iter().filter(|stitch| stitch["op"] == "turn").count();
    let nodes = graph["nodes"].as_array().expect("nodes").len();
    assert_eq!((kind("course"), kind("turn")), (nodes - 1 - turns, turns));
    for turn in edges.iter().filter(|edge| edge["kind"] == "turn") {
        let wale = |edge: &&Value| {
            edge["kind"] == "wale" && edge["from"] == turn["from"] && edge["to"] == turn["to"]
        };
        assert!(edges.iter().any(|edge| wale(&edge)), "{turn}");
    }
    assert!(graph["nodes"].as_array().expect("nodes").iter().enumerate().all(|(id, node)| node["id"] == id));
}

#[test]
fn generated_patterns_read_back_as_their_steps() {
    let open = |surface| tube(surface, End::Open, End::Open);
    let oblong = Gauge::new(3.0, 2.4);
    let horn = horn();
    for (tube, gauge) in [
        (&ball(25.0), Gauge::new(2.5, 2.5)),
        (&ball(30.0), oblong),
        (&horn, Gauge::new(2.5, 2.5)),
        (&horn, Gauge::new(2.0, 2.0)),
        (&open(TorusArc { major: 40.0, minor: 15.0, angle: 2.0 }), oblong),
    ] {
        let program = compiled("thing", tube, gauge);
        assert_readable(&program);
        assert_sound_json(&program);
    }
}

proptest! {
    #![proptest_config(arbitrary::config(128))]

    #[test]
    fn arbitrary_patterns_read_back_as_their_steps(tape in prop::collection::vec(any::<u8>(), 0..300), start in 2_u32..30, count in 1_u32..6) {
        let shape = arbitrary::Shape { start, rows: count, crossing: false, early: true };
        let rows = arbitrary::rows(&mut arbitrary::Tape(tape.iter()), shape);
        let graph = arbitrary::graph(start, &rows);
        let part = trace("body", &graph, Finish::Open);
        let mut program = arbitrary::program(part.start.clone(), part.rows);
        program.graphs = vec![graph];
        picot::passes::run(&mut program, &mut Sink::new());
        assert_readable(&program);
        assert_sound_json(&program);
    }
}

#[test]
fn a_round_of_a_symmetric_shape_has_at_most_eight_words() {
    let program = compiled("ball", &ball(40.0), Gauge::new(2.5, 2.5));
    for line in emitted(&program, &Crochet::default()).lines().filter(|line| line.starts_with("Rnd ")) {
        let (_, body) = line.split_once(": ").expect("a label");
        let clauses = body.split([',', '(']).filter(|piece| piece.contains(char::is_alphabetic)).count();
        assert!(clauses <= 4 && body.split_whitespace().count() <= 11, "{line}");
    }
}

fn work(stitch: Stitch, times: u32) -> Op {
    Op::Work { stitch, times }
}

#[test]
fn stitches_have_their_words_in_both_vocabularies() {
    let dc = Stitch::plain(Kind::Dc);
    let ops = [
        work(Stitch { makes: 2, ..dc }, 1),
        work(Stitch { makes: 5, ..dc }, 2),
        work(Stitch { works: 3, ..dc }, 1),
        work(Stitch { entry: Entry::Back, ..dc }, 4),
        work(Stitch { works: 0, ..dc }, 1),
        work(Stitch::plain(Kind::Skip), 2),
        work(Stitch::plain(Kind::Ch), 3),
        work(Stitch { makes: 1, ..Stitch::plain(Kind::Ch) }, 3),
        work(Stitch::INC, 2),
        work(Stitch::DEC, 1),
        work(Stitch::plain(Kind::Fpdc), 1),
    ];
    let program = arbitrary::program(Start::Ring { loops: 17 }, [Row::new(ops.into_iter().collect())]);
    let line = |form: &Crochet| {
        emitted(&program, form).lines().find(|line| line.starts_with("Rnd 2")).map(str::to_owned)
    };
    let us = "Rnd 2: dc inc, 2 dc inc5, dc3tog, 4 dc BLO, dc in same st, sk 2, ch 3, ch 3 (counts as 3 sts), 2 sc inc, \
              sc2tog, FPdc (27)";
    let uk = "Rnd 2: tr inc, 2 tr inc5, tr3tog, 4 tr BLO, tr in same st, miss 2, ch 3, ch 3 (counts as 3 sts), 2 dc inc, \
              dc2tog, FPtr (27)";
    assert_eq!(line(&Crochet::default()).as_deref(), Some(us));
    assert_eq!(line(&Crochet { terms: Terms::Uk, ..Crochet::default() }).as_deref(), Some(uk));
}

#[test]
fn parts_are_joined_by_name() {
    let plain = |name: &str, start, rows| Part {
        name: name.into(),
        start,
        rows,
        finish: Finish::Open,
        flat: false,
        copies: 1,
    };
    let row = |ops: Vec<Op>| Row::new(ops.into_iter().collect());
    let sc = |times| work(Stitch::SC, times);
    let leg =
        Part { copies: 2, ..plain("Leg", Start::Ring { loops: 7 }, vec![row(vec![work(Stitch::INC, 7)])]) };
    let (open, chain) = (Segment::Open { part: PartId(0), loops: 14 }, Segment::Chain { loops: 3 });
    let hold = Op::Hold { loops: 8, by: PartId(2) };
    let join = Start::Join { segments: vec![open, chain, open, chain] };
    let body = plain("Body", join, vec![row(vec![sc(34)]), row(vec![sc(5), hold, sc(21)])]);
    let held = Start::Join { segments: vec![Segment::Held { part: PartId(1), loops: 8 }] };
    let arm = plain("Left arm 2", held, vec![row(vec![sc(8)])]);
    let mut program = arbitrary::program(Start::Ring { loops: 6 }, []);
    program.pattern.parts = vec![leg, body, arm];
    let text = emitted(&program, &Crochet { style: Style::Paper, ..Crochet::default() });
    insta::assert_snapshot!("joined_parts", text);
    let json: Value = serde_json::from_str(&emitted(&program, &Json {})).expect("JSON");
    assert_eq!(json["joins"][2]["to"], "Body");
    assert_eq!(json["parts"][0]["rounds"][0]["number"], 2);
    assert!(json["parts"][0].get("graph").is_none() && json["gauge"].is_null());
}

#[test]
fn a_maker_finds_all_of_a_small_ball() {
    let rows = [
        row_of(&[work(Stitch::INC, 6)], 1),
        row_of(&[work(Stitch::SC, 12)], 3),
        row_of(&[work(Stitch::DEC, 6)], 1),
    ];
    let mut program = arbitrary::program(Start::Ring { loops: 6 }, rows);
    program.pattern.parts[0].finish = Finish::DrawnShut;
    let hook = picot::ir::yarn::Hook::from_mm(3.5).expect("a hook");
    let size = picot::ir::yarn::Yarn::of_weight(4).expect("worsted").estimate(hook);
    let origin = GaugeOrigin::Estimated { weight: 4, hook, in_range: size.in_range };
    program.gauge = Some(Gauge { width: size.width, height: size.height, origin });
    insta::assert_snapshot!("small_ball", emitted(&program, &Crochet::default()));
    insta::assert_snapshot!("small_ball_dump", picot::ir::dump::pattern(&program.pattern));
}

fn row_of(ops: &[Op], times: u32) -> Row {
    Row { times, ..Row::new(ops.iter().cloned().collect()) }
}

#[test]
fn options_are_checked() {
    let target = picot::backends::target("crochet").expect("listed");
    let set = |text: &str| target.configure(text.parse().expect("TOML")).map(|_| ());
    assert!(set("terms = 'uk'\nstyle = 'paper'\narrows = 'words'\nline-width = 60").is_ok());
    assert!(
        set("term = 'uk'").is_err()
            && set("terms = 'fr'").is_err()
            && set("language = 'xx'").is_err()
            && set("line-width = -1").is_err()
    );
    assert_eq!(target.keys(), ["terms", "language", "style", "arrows", "line-width"]);
}
