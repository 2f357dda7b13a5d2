//! From patterns to machine programs: tubes of every kind are knit, executed and compared with the pattern.
#![expect(clippy::unwrap_used, reason = "helpers of tests")]

use picot::backends::{kcode, knitout};
use picot::diag::{Sink, Sources};
use picot::frontend;
use picot::ir::machine::{Code, Instruction, Machine, execute};
use picot::ir::{
    Block, Direction, Finish, Kind, Maker, Op, Part, Pattern, Program, Row, Start, Step, Stitch,
};
use picot::lower::machine::{Lowered, Options, lower, validate::validate};
use proptest::prelude::*;
use std::io;

pub(super) fn program(start: Start, rows: Vec<Vec<Op>>, finish: Finish) -> Program {
    let rows = rows.into_iter().map(|ops| Row::new(ops.into_iter().collect::<Block>())).collect();
    let part = Part { name: "body".to_owned(), start, rows, finish, flat: false, copies: 1 };
    Program {
        name: "test".to_owned(),
        gauge: None,
        maker: Maker::default(),
        colors: Vec::new(),
        pattern: Pattern { parts: vec![part] },
        graphs: Vec::new(),
    }
}

pub(super) fn work(stitch: Stitch, times: u32) -> Op {
    Op::Work { stitch, times }
}

pub(super) fn sc(times: u32) -> Op {
    work(Stitch::SC, times)
}

/// A ball 6-12-...-36, five even rounds, and back.
fn ball() -> Program {
    let each = |k: u32, stitch: Stitch| {
        let body: Block =
            if k > 0 { vec![sc(k), work(stitch, 1)] } else { vec![work(stitch, 1)] }.into_iter().collect();
        vec![Op::repeat(body, 6)]
    };
    let mut rows: Vec<Vec<Op>> = (0..5).map(|k| each(k, Stitch::INC)).collect();
    rows.extend((0..5).map(|_| vec![sc(36)]));
    rows.extend((0..5).rev().map(|k| each(k, Stitch::DEC)));
    program(Start::Ring { loops: 6 }, rows, Finish::DrawnShut)
}

pub(super) fn machines() -> [Machine; 2] {
    [Machine::named("swg091n2").unwrap(), Machine::named("kniterate").unwrap()]
}

pub(super) fn lowered(program: &Program, machine: &Machine) -> Result<Lowered, Vec<String>> {
    let mut sink = Sink::new();
    let options = Options { no_waste: true, ..Options::default() };
    lower(program, machine, &options, &mut sink).ok_or_else(|| {
        sink.take()
            .iter()
            .map(|found| format!("{} {} {:?}", found.code.as_str(), found.message, found.place))
            .collect()
    })
}

pub(super) fn faults(program: &Program, code: &Code, machine: &Machine) -> Vec<String> {
    let mut sink = Sink::new();
    validate(program, code, Some(machine), &Options::default(), &mut sink);
    sink.take().iter().map(|found| format!("{} {:?}", found.message, found.place)).collect()
}

pub(super) fn text(code: &Code) -> String {
    let mut bytes = Vec::new();
    knitout::write(code, &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

/// Through k-code and back.
pub(super) fn through_kcode(code: &Code) -> Code {
    let mut bytes = Vec::new();
    let mut sink = Sink::new();
    kcode::write(code, &mut bytes, &mut sink).unwrap();
    let loader = |_: &str| -> io::Result<Vec<u8>> { Err(io::ErrorKind::NotFound.into()) };
    let mut sources = Sources::new(&loader);
    let source = sources.add("test.kc", bytes).unwrap();
    let again = frontend::kcode::read(&source, &mut sink);
    assert!(sink.diagnostics().is_empty(), "{:?}", sink.diagnostics());
    again.unwrap()
}

#[test]
fn a_ball_is_knit_on_both_machines() {
    for machine in machines() {
        let made = lowered(&ball(), &machine).unwrap();
        println!("{} {:?}", machine.name, made.report);
        assert_eq!(faults(&ball(), &made.code, &machine), [""; 0]);
        assert_eq!(made.report.held, 0);
    }
}

/// A tube at random: for each row the deque of open loops decides what can be worked.
fn tube() -> impl Strategy<Value = Program> {
    let row = (0_u8..10, proptest::collection::vec(0_u8..20, 64), any::<u16>(), any::<u16>());
    (4_u32..=60, 0_u8..3, any::<bool>(), proptest::collection::vec(row, 1..9)).prop_map(
        |(loops, start, shut, rows)| {
            let start = match start {
                0 => Start::Ring { loops },
                1 => Start::Chain { loops, joined: true },
                _ => Start::Chain { loops, joined: false },
            };
            let mut open = loops;
            let rows = rows
                .iter()
                .map(|(kind, choices, a, b)| random_row(&mut open, *kind, choices, *a, *b))
                .collect();
            program(start, rows, if shut { Finish::DrawnShut } else { Finish::Open })
        },
    )
}

fn random_row(open: &mut u32, kind: u8, choices: &[u8], a: u16, b: u16) -> Vec<Op> {
    let mut ops = Vec::new();
    // Every second row of the random ones is plain, as patterns are.
    if kind < 3 {
        ops.push(sc(*open));
        return ops;
    }
    let mut made = 0;
    let run = |ops: &mut Vec<Op>, mut left: u32, shaping: bool, total: u32| {
        let (mut made, mut quiet) = (0_u32, 1_u32);
        let mut choices = choices.iter().cycle();
        while left > 0 {
            let choice = choices.next().copied().unwrap_or(0);
            let (stitch, works) = match choice {
                0 if shaping && quiet == 0 && total < 60 => (Stitch::INC, 1),
                1 if shaping && quiet == 0 && left > 2 && total > 12 => (Stitch::DEC, 2),
                _ => (Stitch::SC, 1),
            };
            quiet = if stitch == Stitch::SC { quiet.saturating_sub(1) } else { 2 };
            ops.push(work(stitch, 1));
            left -= works;
            made += u32::from(stitch.makes);
        }
        made
    };
    if kind >= 8 && *open >= 8 {
        // Forward, back over a part of it, forward to the end of the round.
        let ahead = 4 + u32::from(a) % (*open - 6);
        let back = 2 + u32::from(b) % (ahead - 2).max(1);
        let first = run(&mut ops, ahead, false, *open);
        ops.push(Op::Turn(Direction::Back));
        let second = run(&mut ops, back, false, *open);
        ops.push(Op::Turn(Direction::Forward));
        let rest = second + (*open - ahead);
        made += first - back;
        made += run(&mut ops, rest, kind == 9, *open);
    } else {
        made += run(&mut ops, *open, true, *open);
    }
    *open = made;
    ops
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(11), ..ProptestConfig::default() })]

    #[test]
    fn random_tubes_are_knit_as_the_pattern_says(program in tube()) {
        for machine in machines() {
            match lowered(&program, &machine) {
                Ok(made) => {
                    prop_assert_eq!(faults(&program, &made.code, &machine), [""; 0], "{}", text(&made.code));
                    if machine.name == "kniterate" {
                        let again = through_kcode(&made.code);
                        prop_assert_eq!(faults(&program, &again, &machine), [""; 0], "{}", text(&made.code));
                        let mut sink = Sink::new();
                        let run = execute(&again, Some(&machine), &mut sink);
                        prop_assert_eq!(run.report.loops, made.report.loops);
                        prop_assert!(sink.diagnostics().is_empty(), "{:?}", sink.diagnostics());
                    }
                }
                Err(reasons) => prop_assert!(false, "{:?}\n{:?}", reasons, program.pattern),
            }
        }
    }

    /// Sliders hold the loops that move where all needles are taken; without them a tube that needs no such move, as a
    /// plain one, ends on waste yarn, and any other is refused.
    #[test]
    fn random_tubes_are_knit_on_all_needles(program in tube()) {
        let [mut slider, mut plain] = machines();
        (slider.bed.half_gauge, plain.bed.half_gauge) = (false, false);
        let made = lowered(&program, &slider).map_err(|reasons| TestCaseError::fail(reasons.join("; ")))?;
        prop_assert_eq!(faults(&program, &made.code, &slider), [""; 0], "{}", text(&made.code));
        let [half, _] = machines();
        let wide = lowered(&program, &half).map_err(|reasons| TestCaseError::fail(reasons.join("; ")))?;
        prop_assert!(width(&made.code) <= width(&wide.code) / 2 + 4);
        let mut sink = Sink::new();
        let shaped = program.pattern.parts[0].rows.iter().any(|row| {
            row.body.steps().any(|step| matches!(step, Step::Work(stitch) if stitch != Stitch::SC))
        });
        match lower(&program, &plain, &Options::default(), &mut sink) {
            Some(made) => {
                prop_assert!(!shaped);
                prop_assert_eq!(faults(&program, &made.code, &plain), [""; 0], "{}", text(&made.code));
                prop_assert_eq!(made.report.held, 0);
                let again = through_kcode(&made.code);
                prop_assert_eq!(faults(&program, &again, &plain), [""; 0], "{}", text(&made.code));
            }
            None => prop_assert!(shaped, "{:?}", sink.diagnostics()),
        }
    }

    #[test]
    fn any_bytes_are_answered_as_kcode(bytes in proptest::collection::vec(any::<u8>(), 0..300), at in any::<u16>()) {
        let line = format!("FRNT:{0}{1}{0}\nSTIF:{2}\nREAR:{0}{1}{0}\nSTIR:{2}\n>> Kn-Kn 1 300 100\n", ".".repeat(15), "-".repeat(252), "5".repeat(282));
        let mut text = format!("HOME\n{line}").into_bytes();
        let at = usize::from(at) % text.len();
        text.splice(at..at, bytes.iter().copied());
        let loader = |_: &str| -> io::Result<Vec<u8>> { Err(io::ErrorKind::NotFound.into()) };
        for bytes in [text, bytes] {
            let mut sources = Sources::new(&loader);
            let source = sources.add("a.kc", bytes).unwrap();
            let mut sink = Sink::new();
            let code = frontend::kcode::read(&source, &mut sink);
            prop_assert_eq!(code.is_some(), !sink.has_errors());
        }
    }
}

/// Needles from the first to the last that a program touches.
fn width(code: &Code) -> i32 {
    let needles = || code.ops().iter().flat_map(Instruction::needles).map(|needle| needle.index);
    needles().max().unwrap() - needles().min().unwrap()
}

/// Every line that makes, moves or drops a loop is needed: without it the program is unsound or makes something else.
#[test]
fn a_program_without_one_of_its_lines_is_found_out() {
    let machine = Machine::named("swg091n2").unwrap();
    let made = lowered(&ball(), &machine).unwrap();
    let whole = text(&made.code);
    let lines: Vec<&str> = whole.lines().collect();
    let loader = |_: &str| -> io::Result<Vec<u8>> { Err(io::ErrorKind::NotFound.into()) };
    let mut removed = 0;
    // A chain that takes two loops at once still secures both, so the bind-off is left alone.
    let end = lines.iter().position(|line| *line == ";bind off").unwrap();
    for (at, line) in lines.iter().enumerate().take(end).step_by(3) {
        // A transfer may be one of two that lead to the same needle; loops may not be missing.
        if !["knit", "tuck"].iter().any(|op| line.starts_with(op)) {
            continue;
        }
        let rest: Vec<&str> =
            lines.iter().enumerate().filter(|(other, _)| *other != at).map(|(_, line)| *line).collect();
        let mut sources = Sources::new(&loader);
        let source = sources.add("cut.k", (rest.join("\n") + "\n").into_bytes()).unwrap();
        let mut sink = Sink::new();
        let code = frontend::knitout::read(&source, &mut sink).unwrap();
        execute(&code, Some(&machine), &mut sink);
        let sound = sink.diagnostics().is_empty();
        assert!(!sound || !faults(&ball(), &code, &machine).is_empty(), "line {}: {line}", at + 1);
        removed += 1;
    }
    assert!(removed > 100);
}

#[test]
fn what_cannot_be_knit_is_refused_with_its_place() {
    let [swg, kniterate] = machines();
    let reason =
        |program: &Program, machine: &Machine| lowered(program, machine).err().unwrap_or_default().join("; ");
    let ring = |loops: u32, rows: Vec<Vec<Op>>| program(Start::Ring { loops }, rows, Finish::Open);
    let wide = ring(130, vec![vec![work(Stitch::INC, 130)]]);
    assert!(reason(&wide, &kniterate).starts_with("E2202 "), "{}", reason(&wide, &kniterate));
    assert!(reason(&wide, &kniterate).contains("round: Some(2)"));
    let round = ring(300, Vec::new());
    assert!(reason(&round, &kniterate).starts_with("E2202 the round has 300 loops"));
    let tall = ring(12, vec![vec![work(Stitch::plain(Kind::Dc), 12)]]);
    assert!(
        reason(&tall, &swg)
            .starts_with("E2201 double crochet has no exact counterpart in knitting at stitch 1")
    );
    let closing =
        ring(8, vec![vec![work(Stitch::DEC, 4)], vec![work(Stitch::DEC, 2)], vec![work(Stitch::DEC, 1)]]);
    assert!(reason(&closing, &swg).contains("too narrow"), "{}", reason(&closing, &swg));
}

#[test]
fn tall_stitches_are_approximated_when_asked_each_with_a_warning() {
    let machine = Machine::named("swg091n2").unwrap();
    let tall =
        program(Start::Ring { loops: 12 }, vec![vec![work(Stitch::plain(Kind::Dc), 12)]], Finish::Open);
    let options = Options { approximate: true, ..Options::default() };
    let mut sink = Sink::new();
    let made = lower(&tall, &machine, &options, &mut sink).unwrap();
    let warnings = sink.diagnostics().iter().filter(|found| found.code.as_str() == "W2431").count();
    assert_eq!(warnings, 12);
    assert!(validate(&tall, &made.code, Some(&machine), &options, &mut sink));
    // Cast-on, its round, three courses for the height of 3, the chain of 12 and the tail of 4.
    assert_eq!(made.report.loops, 12 + 12 + 3 * 12 + 12 + 4);
}

#[test]
fn a_waste_section_comes_before_the_piece_where_the_profile_has_one() {
    let machine = Machine::named("kniterate").unwrap();
    let mut sink = Sink::new();
    let made = lower(&ball(), &machine, &Options::default(), &mut sink).unwrap();
    let plain = lowered(&ball(), &machine).unwrap();
    assert_eq!(made.report.loops, plain.report.loops + 6 * 70 + 6);
    assert_eq!(faults(&ball(), &made.code, &machine), [""; 0]);
    assert_eq!(faults(&ball(), &through_kcode(&made.code), &machine), [""; 0]);
}

#[test]
fn broken_kcode_is_refused_where_it_breaks() {
    let machine = Machine::named("kniterate").unwrap();
    let mut good = Vec::new();
    kcode::write(&lowered(&ball(), &machine).unwrap().code, &mut good, &mut Sink::new()).unwrap();
    let good = String::from_utf8(good).unwrap();
    let loader = |_: &str| -> io::Result<Vec<u8>> { Err(io::ErrorKind::NotFound.into()) };
    let first = |text: String| {
        let mut sources = Sources::new(&loader);
        let source = sources.add("a.kc", text.into_bytes()).unwrap();
        let mut sink = Sink::new();
        frontend::kcode::read(&source, &mut sink);
        sink.diagnostics().first().map(|found| found.code.as_str()).unwrap_or_default()
    };
    assert_eq!(first(good.clone()), "");
    assert_eq!(first(good.replacen("STIR:5", "STIR:", 1)), "W2433");
    for (from, to, code) in [
        ("HOME\n", "", "E2301"),
        ("REAR:", "BACK:", "E2302"),
        ("FRNT:....", "FRNT:...", "E2303"),
        ("STIF:0", "STIF:a", "E2303"),
        (">> Tr-Rr", ">> Tr-Rl", "E2304"),
        ("RACK:-1\n", "RACK:-0.25\n", "E2305"),
        ("<<", ">>", "E2306"),
        ("FRNT:....", "FRNT:..7..", "E2307"),
        ("RACK:-2\n", "RACK:-1\n", "E2308"),
    ] {
        assert!(good.contains(from), "{from}");
        assert_eq!(first(good.replacen(from, to, 1)), code, "{from:?} to {to:?}");
    }
}
