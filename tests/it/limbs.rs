//! Several pieces on one machine: limbs that are set aside and joined, flat pieces, colors, and what stays impossible.

use super::machine::{faults, lowered, machines, program, sc, text, through_kcode, work};
use picot::backends::kcode;
use picot::diag::{Sink, Sources};
use picot::frontend::{self, Input};
use picot::ir::machine::profile::{Increase, Transfer};
use picot::ir::machine::{Code, execute};
use picot::ir::{Finish, Kind, Op, Part, PartId, Pattern, Program, Segment, Start, Stitch};
use picot::lower::machine::{Options, lower, validate::validate};
use std::io;
use std::path::Path;

/// Several parts as a program.
fn parts(parts: Vec<Part>) -> Program {
    Program { pattern: Pattern { parts }, ..program(Start::Ring { loops: 6 }, Vec::new(), Finish::Open) }
}

fn part(name: &str, start: Start, rows: Vec<Vec<Op>>, finish: Finish) -> Part {
    let mut parts = program(start, rows, finish).pattern.parts;
    Part { name: name.to_owned(), ..parts.remove(0) }
}

fn held(from: u32, loops: u32) -> Segment {
    Segment::Held { part: PartId(from), loops }
}

fn open(from: u32, loops: u32) -> Segment {
    Segment::Open { part: PartId(from), loops }
}

fn hold(loops: u32, by: u32) -> Op {
    Op::Hold { loops, by: PartId(by) }
}

fn join(segments: Vec<Segment>) -> Start {
    Start::Join { segments }
}

/// Lowers for both machines, compares with the pattern, and for the Kniterate once more through k-code.
fn knit_on_both(program: &Program) {
    for machine in machines() {
        let made =
            lowered(program, &machine).unwrap_or_else(|reasons| panic!("{}: {reasons:?}", machine.name));
        assert_eq!(faults(program, &made.code, &machine), [""; 0], "{}\n{}", machine.name, text(&made.code));
        assert_eq!(made.report.held, 0);
        assert!(made.report.widest_rack.needles() <= 3.0, "{:?}", made.report);
        if machine.name == "kniterate" {
            let again = through_kcode(&made.code);
            assert_eq!(faults(program, &again, &machine), [""; 0]);
            let mut sink = Sink::new();
            assert_eq!(execute(&again, Some(&machine), &mut sink).report.loops, made.report.loops);
            assert!(sink.diagnostics().is_empty(), "{:?}", sink.diagnostics());
        }
    }
}

/// A hand of 24 loops that sets loops aside for a thumb after `before` stitches of its sixth round.
fn mitten(before: u32, thumb: u32) -> Program {
    let rounds = |count: u32, loops: u32| (0..count).map(move |_| vec![sc(loops)]);
    let mut hand: Vec<Vec<Op>> = rounds(5, 24).collect();
    hand.push(vec![sc(before), hold(thumb, 1), sc(24 - thumb - before)]);
    hand.extend(rounds(4, 24 - thumb));
    let mut finger: Vec<Vec<Op>> = rounds(3, thumb + 2).collect();
    finger.push(vec![sc(thumb), work(Stitch::DEC, 1)]);
    parts(vec![
        part("hand", Start::Chain { loops: 24, joined: true }, hand, Finish::DrawnShut),
        part("thumb", join(vec![held(0, thumb), Segment::Chain { loops: 2 }]), finger, Finish::DrawnShut),
    ])
}

#[test]
fn a_mitten_gets_its_thumb_wherever_it_sits() {
    for before in 0..=16 {
        knit_on_both(&mitten(before, 8));
    }
    knit_on_both(&mitten(3, 5));
    knit_on_both(&mitten(10, 7));
}

/// Two legs from one trunk: half of the round waits, and comes first or last.
#[test]
fn trousers_split() {
    let rounds = |count: u32, loops: u32| (0..count).map(move |_| vec![sc(loops)]).collect::<Vec<_>>();
    for before in [0, 4, 15] {
        let mut body = rounds(3, 30);
        body.push(vec![sc(before), hold(15, 1), sc(15 - before)]);
        body.extend(rounds(3, 15));
        let mut leg = rounds(2, 18);
        leg.insert(1, vec![sc(4), work(Stitch::INC, 2), sc(8), work(Stitch::DEC, 2)]);
        knit_on_both(&parts(vec![
            part("body", Start::Chain { loops: 30, joined: true }, body, Finish::Open),
            part(
                "leg",
                join(vec![Segment::Chain { loops: 1 }, held(0, 15), Segment::Chain { loops: 2 }]),
                leg,
                Finish::Open,
            ),
        ]));
    }
}

#[test]
fn two_legs_are_joined_to_a_body_with_an_arm() {
    let leg = Part {
        copies: 2,
        ..part(
            "leg",
            Start::Ring { loops: 7 },
            vec![vec![work(Stitch::INC, 7)], vec![sc(14)], vec![sc(14)]],
            Finish::Open,
        )
    };
    for (between, twice) in [(0, 0), (3, 3), (2, 1)] {
        let chain = |loops: u32| (loops > 0).then_some(Segment::Chain { loops });
        let segments =
            [Some(open(0, 14)), chain(between), Some(open(0, 14)), chain(twice)].into_iter().flatten();
        let all = 28 + between + twice;
        let body = vec![
            vec![sc(all)],
            vec![sc(5), hold(8, 2), work(Stitch { kind: Kind::Ch, works: 0, ..Stitch::SC }, 3), sc(all - 13)],
            vec![sc(all - 5)],
        ];
        knit_on_both(&parts(vec![
            leg.clone(),
            part("body", join(segments.collect()), body, Finish::Open),
            part(
                "arm",
                join(vec![held(1, 8)]),
                vec![vec![sc(8)], vec![work(Stitch::INC, 1), sc(7)], vec![sc(9)]],
                Finish::DrawnShut,
            ),
        ]));
    }
}

#[test]
fn arms_on_both_sides_and_a_head_that_goes_on() {
    let rounds = |count: u32, loops: u32| (0..count).map(move |_| vec![sc(loops)]).collect::<Vec<_>>();
    let mut body = rounds(2, 36);
    body.push(vec![sc(5), hold(6, 1), sc(12), hold(6, 1), sc(7)]);
    body.push(vec![sc(24)]);
    let arm = Part { copies: 2, ..part("arm", join(vec![held(0, 6)]), rounds(5, 6), Finish::DrawnShut) };
    let head = part("head", join(vec![open(0, 24)]), rounds(3, 24), Finish::DrawnShut);
    let body = part("body", Start::Chain { loops: 36, joined: true }, body, Finish::Open);
    // The body is bound off; its arms begin with the one nearest to the yarn.
    knit_on_both(&parts(vec![body.clone(), arm.clone()]));
    // The body goes on as a head, which is worked before the arms on a machine without hook.
    let arm = Part { start: join(vec![held(0, 6)]), ..arm };
    let program = parts(vec![body, arm, head]);
    let [swg, kniterate] = machines();
    assert_eq!(faults(&program, &lowered(&program, &swg).unwrap().code, &swg), [""; 0]);
    let reasons = lowered(&program, &kniterate).unwrap_err();
    assert!(reasons[0].starts_with("E2206 the yarn would lie across open loops of body"), "{reasons:?}");
}

#[test]
fn flat_pieces_go_back_and_forth() {
    let flat = |start: Start, rows: Vec<Vec<Op>>| {
        let mut program = program(start, rows, Finish::Open);
        program.pattern.parts[0].flat = true;
        program
    };
    let chain = |loops: u32| Start::Chain { loops, joined: false };
    knit_on_both(&flat(chain(20), (0..6).map(|_| vec![sc(20)]).collect()));
    let shaped = vec![
        vec![sc(5), work(Stitch::INC, 1), sc(6)],
        vec![work(Stitch::INC, 1), sc(11), work(Stitch::INC, 1)],
        vec![sc(15)],
        vec![work(Stitch::DEC, 1), sc(3), work(Stitch::DEC, 1), sc(8)],
        vec![sc(2), work(Stitch { works: 3, ..Stitch::SC }, 1), sc(8)],
    ];
    knit_on_both(&flat(chain(12), shaped));
    // A step at each side: loops that rows leave are worked later or bound off.
    let leave = |loops: u32| Op::Leave { loops };
    let steps = vec![
        vec![sc(12)],
        vec![sc(9), leave(3)],
        vec![sc(6), leave(3)],
        vec![sc(6), sc(3)],
        vec![sc(9), sc(3)],
    ];
    knit_on_both(&flat(chain(12), steps));
    knit_on_both(&flat(chain(12), vec![vec![sc(12)], vec![sc(9), leave(3)]]));
}

#[test]
fn parts_without_joins_are_knit_one_after_the_other_as_often_as_they_are_made() {
    let ear = Part {
        copies: 2,
        ..part("ear", Start::Ring { loops: 6 }, vec![vec![work(Stitch::INC, 6)]], Finish::Open)
    };
    let mut patch =
        part("patch", Start::Chain { loops: 9, joined: false }, vec![vec![sc(9)], vec![sc(9)]], Finish::Open);
    patch.flat = true;
    let program = parts(vec![ear, patch]);
    knit_on_both(&program);
    let made = lowered(&program, &machines()[0]).unwrap();
    let titles: Vec<&str> = made
        .code
        .comments
        .iter()
        .map(|comment| comment.text.as_str())
        .filter(|text| text.starts_with("part: "))
        .collect();
    assert_eq!(titles, ["part: ear, 1 of 2", "part: ear, 2 of 2", "part: patch"]);
    // A program that knits one piece less or more is another one.
    let single =
        Program { pattern: Pattern { parts: program.pattern.parts[1..].to_vec() }, ..program.clone() };
    assert!(!faults(&single, &made.code, &machines()[0]).is_empty());
    let less = lowered(&single, &machines()[0]).unwrap();
    assert!(!faults(&program, &less.code, &machines()[0]).is_empty());
}

#[test]
fn colors_have_a_carrier_each() {
    let stripes = |colors: u16, start: Start, rows: Vec<Vec<Op>>| Program {
        colors: (0..colors).map(|color| format!("color {color}")).collect(),
        ..program(start, rows, Finish::Open)
    };
    let color = Op::Color;
    let round = Start::Chain { loops: 20, joined: true };
    let rows = vec![
        vec![sc(20)],
        vec![color(1), sc(20)],
        vec![color(0), sc(13), color(2), sc(7)],
        vec![sc(20)],
        vec![color(1), sc(4), color(0), sc(16)],
    ];
    knit_on_both(&stripes(3, round.clone(), rows.clone()));
    let mut flat = stripes(3, Start::Chain { loops: 20, joined: false }, rows);
    flat.pattern.parts[0].flat = true;
    knit_on_both(&flat);
    // The Kniterate has four carriers beside waste yarn and draw thread.
    let many = stripes(5, round, (0..5).map(|at| vec![color(at), sc(20)]).collect());
    let [swg, kniterate] = machines();
    assert!(lowered(&many, &swg).is_ok());
    let reasons = lowered(&many, &kniterate).unwrap_err();
    assert!(reasons[0].starts_with("E2205 color 5 has no carrier at stitch 1"), "{reasons:?}");
}

#[test]
fn loops_of_finished_fabric_are_refused_or_sewn() {
    let body = part("body", Start::Ring { loops: 20 }, vec![vec![sc(20)], vec![sc(20)]], Finish::Open);
    let surface = Segment::Surface { part: PartId(0), round: 2, first: 3, loops: 8, back: false };
    let arm = part("arm", join(vec![surface]), vec![vec![sc(8)]], Finish::Open);
    let program = parts(vec![body, arm]);
    for machine in machines() {
        let reasons = lowered(&program, &machine).unwrap_err();
        let expected =
            "E2204 stitches 3 to 10 of round 2 of body are finished, and no needle can pick them up";
        assert!(reasons.iter().any(|reason| reason.starts_with(expected)), "{reasons:?}");
        let options = Options { approximate: true, no_waste: true };
        let mut sink = Sink::new();
        let made = lower(&program, &machine, &options, &mut sink).unwrap();
        let found: Vec<String> = sink.diagnostics().iter().map(|found| found.message.clone()).collect();
        assert!(
            found
                .iter()
                .any(|message| message.starts_with("8 loops are cast on, to be sewn to stitches 3 to 10")),
            "{found:?}"
        );
        assert!(validate(&program, &made.code, Some(&machine), &options, &mut sink));
    }
}

#[test]
fn what_the_profile_asks_for_is_done() {
    let grown = program(
        Start::Chain { loops: 16, joined: true },
        vec![
            vec![sc(3), work(Stitch::INC, 1), sc(7), work(Stitch::INC, 1), sc(4)],
            vec![sc(18)],
            vec![sc(1), work(Stitch::INC, 1), sc(10), work(Stitch::INC, 1), sc(5)],
            vec![sc(20)],
        ],
        Finish::Open,
    );
    let count = |code: &Code, opcode: &str| code.ops().iter().filter(|op| op.opcode() == opcode).count();
    for mut machine in machines() {
        let tucked = lowered(&grown, &machine).unwrap();
        assert_eq!(count(&tucked.code, "split"), 0);
        machine.methods.increase = Increase::Split;
        let split = lowered(&grown, &machine).unwrap();
        assert_eq!(faults(&grown, &split.code, &machine), [""; 0], "{}", text(&split.code));
        assert!(count(&split.code, "split") >= 3, "{}", text(&split.code));
        if machine.name == "kniterate" {
            assert_eq!(faults(&grown, &through_kcode(&split.code), &machine), [""; 0]);
            // Transfers in two passes instead of four.
            let passes = |code: &Code| {
                let mut bytes = Vec::new();
                kcode::write(code, &mut bytes, &mut Sink::new()).unwrap();
                String::from_utf8(bytes).unwrap().matches("\nFRNT:").count()
            };
            machine.methods.transfer = Transfer::TwoPass;
            let two = lowered(&grown, &machine).unwrap();
            assert!(passes(&two.code) < passes(&split.code));
            assert_eq!(faults(&grown, &through_kcode(&two.code), &machine), [""; 0]);
        }
    }
    let [mut machine, _] = machines();
    let rounds = vec![vec![sc(14)], vec![sc(14)]];
    let leg =
        Part { copies: 2, ..part("leg", Start::Chain { loops: 14, joined: true }, rounds, Finish::Open) };
    let body = part("body", join(vec![open(0, 14), open(0, 14)]), vec![vec![sc(28)]], Finish::Open);
    let legs = parts(vec![leg, body]);
    let plain = lowered(&legs, &machine).unwrap();
    (machine.rack.preferred, machine.limits.link_stretch) = (4.0, 12);
    let wide = lowered(&legs, &machine).unwrap();
    assert_eq!(faults(&legs, &wide.code, &machine), [""; 0]);
    assert!(wide.report.widest_rack > plain.report.widest_rack, "{:?} {:?}", wide.report, plain.report);
    machine.rack.preferred = 1.0;
    let reasons = lowered(&legs, &machine).unwrap_err();
    assert!(reasons[0].starts_with("E2202 loops are moved to their neighbors by racks of 2"), "{reasons:?}");
    let [mut machine, _] = machines();
    machine.bed.half_gauge = false;
    let packed = lowered(&legs, &machine).unwrap();
    assert_eq!(faults(&legs, &packed.code, &machine), [""; 0]);
    machine.bed.sliders = false;
    let reasons = lowered(&legs, &machine).unwrap_err();
    assert!(reasons[0].starts_with("E2202 loops of a tube on all needles cannot change"), "{reasons:?}");
}

#[test]
#[expect(clippy::disallowed_methods, reason = "the cases are files")]
fn written_patterns_with_limbs_are_knit() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it/cases/machine");
    let mut seen = 0;
    for entry in folder.read_dir().unwrap().flatten() {
        let loader = |_: &str| -> io::Result<Vec<u8>> { Err(io::ErrorKind::NotFound.into()) };
        let mut sources = Sources::new(&loader);
        let source = sources.add("pattern.txt", std::fs::read(entry.path()).unwrap()).unwrap();
        let mut sink = Sink::new();
        let input = picot::read(
            &source,
            &frontend::crochet::READER,
            &picot::Options::default(),
            &mut sources,
            &mut sink,
        );
        let Some(Input::Program(program)) = input else {
            panic!("{}: {:?}", entry.path().display(), sink.take())
        };
        assert!(!sink.has_errors(), "{}: {:?}", entry.path().display(), sink.take());
        knit_on_both(&program);
        seen += 1;
    }
    assert!(seen >= 4);
}
