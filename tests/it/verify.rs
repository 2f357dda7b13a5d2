//! The verifier against an independent simulation, and each of its rules by a pattern that breaks it.

use crate::arbitrary::{self, Shape, Tape, program, unfolded};
use crate::loops::simulate;
use picot::diag::{Code, Severity, Sink, Sources};
use picot::ir::verify::verify;
use picot::ir::{
    Block, Direction, Entry, Finish, Kind, Op, Part, PartId, Program, Row, Segment, Start, Step, Stitch,
};
use proptest::prelude::*;

const SC: Stitch = Stitch::SC;
const INC: Stitch = Stitch::INC;
const DEC: Stitch = Stitch::DEC;

fn work(stitch: Stitch, times: u32) -> Op {
    Op::Work { stitch, times }
}
fn repeat(times: u32, ops: impl IntoIterator<Item = Op>) -> Op {
    Op::repeat(ops.into_iter().collect(), times)
}
fn row(ops: impl IntoIterator<Item = Op>) -> Row {
    Row::new(ops.into_iter().collect())
}
fn short(before: u32, back: u32, after: u32) -> Row {
    let turn = |direction| Op::Turn(direction);
    let (back, after) = (work(SC, back), work(SC, after));
    row([work(SC, before), turn(Direction::Back), back, turn(Direction::Forward), after])
}
fn ring(loops: u32, rows: impl IntoIterator<Item = Row>) -> Program {
    program(Start::Ring { loops }, rows)
}

/// What the verifier says, as `E0101 round 2 ...`; empty when it passes.
fn says(program: &Program) -> Vec<String> {
    let mut sink = Sink::new();
    let passed = verify(program, &mut sink).is_some();
    assert_eq!(passed, !sink.has_errors());
    sink.diagnostics().iter().map(|found| format!("{} {}", found.code.as_str(), found.message)).collect()
}

#[test]
fn good_rows_pass_and_are_counted() {
    let six = row([repeat(6, [work(INC, 1)])]);
    let twelve = Row { times: 4, ..row([work(SC, 12)]) };
    let program = ring(6, [six, twelve, row([repeat(6, [work(DEC, 1)])])]);
    let mut sink = Sink::new();
    let verified = verify(&program, &mut sink).unwrap();
    let facts = &verified.facts().parts[0];
    let line = |row: &picot::ir::verify::RowFacts| (row.number, row.consumes, row.produces, row.total);
    assert_eq!(
        facts.rows.iter().map(line).collect::<Vec<_>>(),
        [(2, 6, 12, 12), (3, 12, 12, 60), (7, 12, 6, 66)]
    );
    assert_eq!((facts.open, facts.stitches), (6, 66));
    assert_eq!(facts.yarn, 600 + 1200 + 4800 + 6 * 155);
}

#[test]
fn rows_that_do_not_fit_are_told_once() {
    let program = ring(6, [row([work(SC, 7)]), row([work(SC, 7)]), row([work(SC, 6)])]);
    assert_eq!(
        says(&program),
        ["E0101 round 2 works 7 loops, 6 are there", "E0102 round 4 works 6 of the 7 loops below"]
    );
    let program = ring(6, [row([work(INC, 6)]), row([work(SC, 11)]), row([work(SC, 11)])]);
    assert_eq!(says(&program), ["E0102 round 3 works 11 of the 12 loops below"]);
}

#[test]
fn a_wrong_count_is_told_and_either_count_carries_on() {
    let counted = |row: Row, count| Row { stated: Some((count, picot::diag::Span::NONE)), ..row };
    let made = ring(6, [counted(row([work(INC, 6)]), 13), row([work(SC, 12)])]);
    let meant = ring(6, [counted(row([work(INC, 6)]), 13), row([work(SC, 13)])]);
    for program in [made, meant] {
        assert_eq!(says(&program), ["E0103 round 2 states 13 and makes 12"]);
    }
}

#[test]
fn short_rows_stay_within_their_round() {
    assert!(says(&ring(12, [short(8, 6, 10)])).is_empty());
    assert_eq!(
        says(&ring(26, [short(10, 12, 28)])),
        ["E0302 round 2 works back over 12 stitches where 10 lie behind"]
    );
    assert_eq!(says(&ring(12, [short(9, 8, 11)])), ["W0408 a back pass of 8 stitches in round 2 of 12"]);
    let late =
        row([work(SC, 8), work(SC, 5), Op::Turn(Direction::Back), work(SC, 1), Op::Turn(Direction::Forward)]);
    assert_eq!(
        says(&ring(12, [late])),
        ["E0101 round 2 runs out of its 12 loops before its short row gives new ones"]
    );
}

#[test]
fn turns_come_in_pairs() {
    let back = Op::Turn(Direction::Back);
    let forward = Op::Turn(Direction::Forward);
    let says = |ops: Vec<Op>| says(&ring(26, [row(ops)])).join("; ");
    assert!(says(vec![work(SC, 10), forward.clone(), work(SC, 16)]).starts_with("E0301"));
    assert!(says(vec![work(SC, 10), back.clone(), work(SC, 5)]).starts_with("E0301"));
    assert!(says(vec![work(SC, 10), back.clone(), forward.clone(), work(SC, 16)]).starts_with("E0301"));
    let nested = vec![work(SC, 9), back.clone(), work(SC, 2), back, work(SC, 2), forward, work(SC, 21)];
    assert!(says(nested).starts_with("E0301"));
}

#[test]
fn a_decrease_over_a_turn_is_remarked_in_writing_and_refused_in_a_graph() {
    let body = |dec: Stitch| {
        let (back, forward) = (Op::Turn(Direction::Back), Op::Turn(Direction::Forward));
        row([work(SC, 12), back, work(SC, 4), forward, work(SC, 3), work(dec, 1), work(SC, 7)])
    };
    let mut program = ring(20, [body(DEC)]);
    assert_eq!(says(&program), ["W0409 round 2 works loops on both sides of a turn together"]);
    let steps: Vec<_> = program.pattern.parts[0].rows[0].body.steps().collect();
    program.graphs = vec![arbitrary::graph(20, &[steps])];
    let mut sink = Sink::new();
    assert!(verify(&program, &mut sink).is_none());
    assert_eq!(sink.diagnostics()[0].severity, Severity::Error);
}

#[test]
fn a_round_ends_early_only_when_it_says_so() {
    let leave = |loops| row([work(SC, 9), Op::Leave { loops }]);
    assert!(says(&ring(12, [leave(3), row([work(SC, 12)])])).is_empty());
    assert_eq!(says(&ring(12, [leave(2)])), ["E0102 round 2 works 9 of the 12 loops below"]);
    assert_eq!(says(&ring(12, [leave(4)])), ["E0101 round 2 works 13 loops, 12 are there"]);
    let after = row([work(SC, 9), Op::Leave { loops: 2 }, work(SC, 1)]);
    assert_eq!(says(&ring(12, [after])), ["E0901 round 2 goes on after its last loops are left unworked"]);
}

#[test]
fn flat_rows_turn_and_may_leave_steps() {
    let flat = |rows: Vec<Row>| {
        let mut program = program(Start::Chain { loops: 10, joined: false }, rows);
        program.pattern.parts[0].flat = true;
        says(&program).join("; ")
    };
    let step = |count, loops| row([work(SC, count), Op::Leave { loops }]);
    // Row 2 works the 6 stitches of row 1; row 3 goes on over the 4 chains that row 1 left.
    assert_eq!(flat(vec![step(6, 4), row([work(SC, 6)]), row([work(SC, 10)])]), "");
    assert_eq!(flat(vec![step(6, 4), row([work(SC, 6)]), row([work(SC, 6)]), row([work(SC, 6)])]), "");
    assert_eq!(flat(vec![step(6, 4), row([work(SC, 7)])]), "E0101 row 2 works 7 loops, 6 are there");
    assert_eq!(flat(vec![row([work(SC, 9)])]), "E0102 row 1 works 9 of the 10 loops below");
}

#[test]
fn numbers_are_multiplied_out_before_anything_is_walked() {
    let huge = ring(6, [row([repeat(99_999, [repeat(99_999, [work(SC, 1)])])])]);
    assert_eq!(says(&huge), ["E0902 a row of more than 50000000 stitches"]);
    let rounds = Row { times: u32::MAX, ..row([work(SC, 6)]) };
    assert!(says(&ring(6, [rounds]))[0].starts_with("E0902"));
    let many = ring(6, (0..400).map(|_| Row { times: 10_000, ..row([work(SC, 6)]) }));
    assert!(says(&many)[0].starts_with("E0902"));
    let deep = (0..17).fold(work(SC, 1), |op, _| repeat(1, [op]));
    assert_eq!(says(&ring(1, [row([deep])])), ["E0902 repeats nest deeper than 16"]);
    let sixteen = (0..16).fold(work(SC, 1), |op, _| repeat(1, [op]));
    assert!(says(&ring(1, [row([sixteen])])).is_empty());
    assert!(says(&ring(100_001, [row([work(SC, 100_001)])]))[0].starts_with("E0902"));
    let wide = ring(90_000, [row([work(INC, 90_000)])]);
    assert_eq!(says(&wide), ["E0902 round 2 makes 180000 loops, the limit is 100000"]);
}

#[test]
fn nothing_is_worked_no_times() {
    let broken = |rows: Vec<Row>| assert!(says(&ring(6, rows))[0].starts_with("E0901"));
    broken(vec![row([work(SC, 0)])]);
    broken(vec![row([repeat(0, [work(SC, 6)])])]);
    broken(vec![row([repeat(6, [])])]);
    broken(vec![row([])]);
    broken(vec![Row { times: 0, ..row([work(SC, 6)]) }]);
}

#[test]
fn a_folded_row_that_grows_does_not_repeat() {
    let grows = Row { times: 3, ..row([repeat(6, [work(INC, 1)])]) };
    assert_eq!(says(&ring(6, [grows])), ["E0102 round 3 works 6 of the 12 loops below"]);
}

#[test]
fn joins_and_holds_are_balanced() {
    let part = |name: &str, start, rows, copies| Part {
        name: name.into(),
        start,
        rows,
        finish: Finish::Open,
        flat: false,
        copies,
    };
    let leg = part("leg", Start::Ring { loops: 7 }, vec![row([work(INC, 7)])], 2);
    let (open, chain) = (Segment::Open { part: PartId(0), loops: 14 }, Segment::Chain { loops: 3 });
    let hold = Op::Hold { loops: 8, by: PartId(2) };
    let join = |segments| Start::Join { segments };
    let body =
        part("body", join(vec![open, chain, open, chain]), vec![row([work(SC, 5), hold, work(SC, 21)])], 1);
    let arm = |loops| {
        part("arm", join(vec![Segment::Held { part: PartId(1), loops }]), vec![row([work(SC, loops)])], 1)
    };
    let whole = |parts: Vec<Part>| {
        let mut program = ring(6, []);
        program.pattern.parts = parts;
        says(&program).join("; ")
    };
    assert_eq!(whole(vec![leg.clone(), body.clone(), arm(8)]), "");
    assert_eq!(
        whole(vec![leg.clone(), body.clone(), arm(7)]),
        "E0206 body holds 8 loops for arm, which takes 7"
    );
    assert_eq!(
        whole(vec![leg.clone(), body.clone()]),
        "E0206 body holds 8 loops for a missing part, which takes 0"
    );
    let single = Part { copies: 1, ..leg.clone() };
    assert_eq!(
        whole(vec![single, body.clone(), arm(8)]),
        "E0207 the open loops of leg are used 2 times, 1 made"
    );
    let shut = Part { finish: Finish::DrawnShut, ..leg };
    assert!(whole(vec![shut, body, arm(8)]).contains("E0207 leg is drawn shut"));
    let early = part("first", join(vec![Segment::Open { part: PartId(0), loops: 6 }]), vec![], 1);
    assert!(whole(vec![early]).starts_with("E0901"));
}

#[test]
fn faults_point_into_the_text() {
    let loader = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    let mut sources = Sources::new(&loader);
    let file = sources.add("ball.txt", b"Rnd 2: 7 sc".to_vec()).unwrap();
    let mut body = Block::default();
    body.push(work(SC, 7), file.span(7..11));
    let program = ring(6, [Row { span: file.span(0..11), ..Row::new(body) }]);
    let mut sink = Sink::new();
    assert!(verify(&program, &mut sink).is_none());
    assert_eq!(sink.diagnostics()[0].code, Code::LoopsExhausted);
    assert_eq!(file.range(sink.diagnostics()[0].labels[0].span), Some(7..11));
}

fn tape() -> impl Strategy<Value = Vec<u8>> {
    prop::collection::vec(any::<u8>(), 0..400)
}

fn of_rows(start: u32, rows: &[Vec<Step>]) -> Program {
    ring(start, rows.iter().map(|steps| Row::new(unfolded(steps))))
}

proptest! {
    #![proptest_config(arbitrary::config(256))]

    #[test]
    fn workable_rows_pass_with_the_counts_of_the_deque(tape in tape(), start in 1_u32..30, rows in 1_u32..6) {
        let shape = Shape { start, rows, crossing: false, early: true };
        let rows = arbitrary::rows(&mut Tape(tape.iter()), shape);
        let mut program = of_rows(start, &rows);
        program.graphs = vec![arbitrary::graph(start, &rows)];
        let mut sink = Sink::new();
        let verified = verify(&program, &mut sink);
        prop_assert!(verified.is_some(), "{:?}", sink);
        let mut steps = Vec::new();
        for (row, facts) in rows.iter().zip(&verified.unwrap().facts().parts[0].rows) {
            steps.extend(row);
            let open = simulate(start, &steps, (0, 0)).unwrap();
            prop_assert_eq!(open as u32, facts.produces + facts.left);
        }
    }

    #[test]
    fn one_changed_step_is_refused_or_moves_the_count(tape in tape(), start in 2_u32..30, at in any::<prop::sample::Index>(), to in 0_usize..4) {
        let shape = Shape { start, rows: 4, crossing: false, early: false };
        let mut rows = arbitrary::rows(&mut Tape(tape.iter()), shape);
        let graph = arbitrary::graph(start, &rows);
        let row = rows.len() / 2;
        let at = at.index(rows[row].len());
        let steps = [Step::Work(SC), Step::Work(INC), Step::Work(DEC), Step::Turn(Direction::Back)];
        prop_assume!(rows[row][at] != steps[to]);
        rows[row][at] = steps[to];
        let mut program = of_rows(start, &rows);
        program.graphs = vec![graph];
        prop_assert!(!says(&program).is_empty());
    }

    #[test]
    fn one_changed_corner_is_refused(tape in tape(), start in 2_u32..30, at in any::<prop::sample::Index>(), top in any::<bool>()) {
        let shape = Shape { start, rows: 3, crossing: false, early: false };
        let rows = arbitrary::rows(&mut Tape(tape.iter()), shape);
        let mut program = of_rows(start, &rows);
        let mut graph = arbitrary::graph(start, &rows);
        let at = at.index(graph.tiles.len());
        let tile = &mut graph.tiles[at];
        let corners = if top { &mut tile.top } else { &mut tile.base };
        let changed: Vec<u32> = corners.iter().map(|id| id + 1).collect();
        *corners = picot::ir::graph::Corners::new(&changed).unwrap();
        program.graphs = vec![graph];
        prop_assert!(says(&program)[0].starts_with("E0901"));
    }

    #[test]
    fn arbitrary_operations_never_panic(ops in prop::collection::vec((0_u8..8, 0_u32..9, 0_u16..9, 0_u16..9), 0..40), times in 0_u32..3, flat in any::<bool>()) {
        let mut stack = vec![Block::default()];
        for (what, times, works, makes) in ops {
            let stitch = Stitch { kind: Kind::ALL[usize::from(works) % Kind::ALL.len()], works, makes, entry: Entry::Both };
            let op = match what {
                0..=2 => Op::Work { stitch, times },
                3 => Op::Turn(Direction::Back),
                4 => Op::Turn(Direction::Forward),
                5 => Op::Hold { loops: times, by: PartId(times) },
                6 if times == 1 => Op::Leave { loops: works.into() },
                6 => { stack.push(Block::default()); continue }
                _ => {
                    let body = if stack.len() > 1 { stack.pop().unwrap() } else { continue };
                    Op::repeat(body, times)
                }
            };
            stack.last_mut().unwrap().push(op, picot::diag::Span::NONE);
        }
        let mut program = ring(12, stack.into_iter().map(|block| Row { times, ..Row::new(block) }));
        program.pattern.parts[0].flat = flat;
        says(&program);
    }
}
