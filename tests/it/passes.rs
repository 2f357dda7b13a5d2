//! Passes keep the steps of arbitrary patterns, and fold the way designers write.

use crate::arbitrary;
use picot::diag::{Sink, Span};
use picot::ir::{Block, Direction, Op, PartId, Program, Row, Start, Step, Stitch};
use picot::passes::{self, PASSES};
use proptest::prelude::*;

/// A block in the notation of patterns, for reading tests.
fn text(block: &Block) -> String {
    let word = |op: &Op| match op {
        Op::Work { stitch, times } => {
            let name = match (stitch.works, stitch.makes) {
                (1, 2) => "inc",
                (2, 1) => "dec",
                _ => stitch.kind.us(),
            };
            if *times == 1 { name.to_owned() } else { format!("{times} {name}") }
        }
        Op::Repeat { body, times } => format!("({}) x {times}", text(body)),
        Op::Turn(Direction::Back) => "<-".into(),
        Op::Turn(Direction::Forward) => "->".into(),
        Op::Hold { loops, .. } => format!("hold {loops}"),
        Op::Leave { loops } => format!("leave {loops}"),
        Op::Color(color) => format!("color {color}"),
    };
    block.ops().iter().map(word).collect::<Vec<_>>().join(", ")
}

fn work(stitch: Stitch, times: u32) -> Op {
    Op::Work { stitch, times }
}

/// A row as a generator leaves it: `5` are five single crochets, `i` and `d` an increase and a decrease.
fn raw(words: &str) -> Row {
    let op = |word: &str| match word {
        "i" => work(Stitch::INC, 1),
        "d" => work(Stitch::DEC, 1),
        "<" => Op::Turn(Direction::Back),
        ">" => Op::Turn(Direction::Forward),
        count => work(Stitch::SC, count.parse().expect("a number")),
    };
    Row::new(words.split_whitespace().map(op).collect())
}

fn folded(rows: Vec<Row>) -> Vec<String> {
    let mut program = arbitrary::program(Start::Ring { loops: 6 }, rows);
    passes::run(&mut program, &mut Sink::new());
    let line = |row: &Row| {
        format!(
            "{}{}",
            if row.times > 1 { format!("{}: ", row.times) } else { String::new() },
            text(&row.body)
        )
    };
    program.pattern.parts[0].rows.iter().map(line).collect()
}

fn fold(words: &str) -> String {
    folded(vec![raw(words)]).remove(0)
}

#[test]
fn even_shaping_folds_to_one_repeat() {
    assert_eq!(fold("i i i i i i"), "6 inc");
    assert_eq!(fold("1 i 1 i 1 i 1 i 1 i 1 i"), "(sc, inc) x 6");
    assert_eq!(fold("2 i 2 i 2 i 2 i 2 i 2 i"), "(2 sc, inc) x 6");
    assert_eq!(fold("36"), "36 sc");
    assert_eq!(fold("4 d 4 d 4 d 4 d"), "(4 sc, dec) x 4");
}

#[test]
fn staggered_shaping_cuts_its_runs() {
    assert_eq!(fold("2 i 4 i 4 i 4 i 4 i 4 i 2"), "(2 sc, inc, 2 sc) x 6");
    assert_eq!(fold("3 i 5 i 5 i 5 i 5"), "3 sc, (inc, 5 sc) x 4");
    assert_eq!(fold("3 5 i 5 i 5 i 5 i 2"), "3 sc, (5 sc, inc) x 4, 2 sc");
    assert_eq!(fold("1 i 4 i 4 i 4 i 4 i 4 i 3"), "(sc, inc, 3 sc) x 6");
    assert_eq!(fold("7 i 4 i 4 i 4 i 4 i 4 i 9"), "3 sc, (4 sc, inc) x 6, 9 sc");
}

#[test]
fn mixed_gaps_and_mixed_shaping_fold_too() {
    assert_eq!(fold("4 i 5 i 4 i 5 i 4 i 5 i"), "(4 sc, inc, 5 sc, inc) x 3");
    assert_eq!(fold("4 i 4 i 4 i 9 d 2 d 2 d 2 d"), "(4 sc, inc) x 3, 7 sc, (2 sc, dec) x 4");
    assert_eq!(fold("4 i 5 d 7"), "4 sc, inc, 5 sc, dec, 7 sc");
}

#[test]
fn short_rows_cut_a_row_into_stretches() {
    assert_eq!(fold("9 9 < 6 > 6 1 i 1 i 1 i"), "18 sc, <-, 6 sc, ->, 6 sc, (sc, inc) x 3");
    let hidden = Op::repeat(raw("9 < 4 > 4").body, 2);
    assert_eq!(
        folded(vec![Row::new([hidden].into_iter().collect())]),
        ["9 sc, <-, 4 sc, ->, 13 sc, <-, 4 sc, ->, 4 sc"]
    );
}

#[test]
fn equal_rounds_share_a_line() {
    let rows = vec![raw("i i i i i i"), raw("12"), raw("6 6"), raw("12"), raw("1 i 1 i 1 i 1 i 1 i 1 i")];
    assert_eq!(folded(rows), ["6 inc", "3: 12 sc", "(sc, inc) x 6"]);
    let stated = |count| Row { stated: Some((count, Span::NONE)), ..raw("12") };
    assert_eq!(folded(vec![stated(12), stated(12), stated(13)]), ["2: 12 sc", "12 sc"]);
}

#[test]
fn a_huge_repeat_is_left_alone() {
    let huge = Op::repeat(raw("1 i").body, u32::MAX);
    assert_eq!(folded(vec![Row::new([huge].into_iter().collect())]), ["(sc, inc) x 4294967295"]);
}

#[test]
fn wide_rows_fold_in_linear_time() {
    // 60,000 increases at gaps that never repeat, and the same with gaps that do.
    let mut seed = 1_u64;
    let mut gap = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        1 + (seed >> 40) as u32 % 3
    };
    let uneven: Block = (0..60_000).flat_map(|_| [work(Stitch::SC, gap()), work(Stitch::INC, 1)]).collect();
    let even: Block = (0..60_000).flat_map(|_| [work(Stitch::SC, 2), work(Stitch::INC, 1)]).collect();
    let lines = folded(vec![Row::new(uneven), Row::new(even)]);
    assert_eq!(lines[1], "(2 sc, inc) x 60000");
    assert!(lines[0].len() > 1000);
}

fn op() -> impl Strategy<Value = Op> {
    let stitch = prop::sample::select(vec![Stitch::SC, Stitch::SC, Stitch::INC, Stitch::DEC]);
    let leaf = prop_oneof![
        8 => (stitch, 1_u32..4).prop_map(|(stitch, times)| work(stitch, times)),
        1 => prop::bool::ANY.prop_map(|back| Op::Turn(if back { Direction::Back } else { Direction::Forward })),
        1 => (0_u16..3).prop_map(Op::Color),
        1 => (1_u32..3).prop_map(|loops| Op::Hold { loops, by: PartId(1) }),
        1 => (1_u32..3).prop_map(|loops| Op::Leave { loops }),
    ];
    leaf.prop_recursive(3, 40, 6, |inner| {
        (prop::collection::vec(inner, 1..6), 1_u32..5)
            .prop_map(|(ops, times)| Op::repeat(ops.into_iter().collect(), times))
    })
}

fn programs() -> impl Strategy<Value = Program> {
    let row = (prop::collection::vec(op(), 1..12), 1_u32..3, prop::option::of(1_u32..3));
    let row = row.prop_map(|(ops, times, stated)| Row {
        times,
        stated: stated.map(|count| (count, Span::NONE)),
        ..Row::new(ops.into_iter().collect())
    });
    let twice = (row, 1_usize..3).prop_map(|(row, times)| vec![row; times]);
    prop::collection::vec(twice, 0..4)
        .prop_map(|rows| arbitrary::program(Start::Ring { loops: 6 }, rows.into_iter().flatten()))
}

fn steps(program: &Program) -> Vec<Vec<Step>> {
    let rows = program.pattern.parts.iter().flat_map(|part| &part.rows);
    rows.flat_map(|row| (0..row.times).map(|_| row.body.steps().collect())).collect()
}

proptest! {
    #![proptest_config(arbitrary::config(512))]

    #[test]
    fn every_pass_keeps_the_steps_and_has_nothing_to_do_twice(program in programs()) {
        for pass in PASSES {
            let mut once = program.clone();
            (pass.run)(&mut once, &mut Sink::new());
            prop_assert!(passes::same_steps(&program.pattern, &once.pattern));
            prop_assert_eq!(steps(&program), steps(&once), "{}", pass.name);
            let mut twice = once.clone();
            (pass.run)(&mut twice, &mut Sink::new());
            prop_assert_eq!(once, twice, "{}", pass.name);
        }
        let mut all = program.clone();
        passes::run(&mut all, &mut Sink::new());
        prop_assert_eq!(steps(&program), steps(&all));
        let mut again = all.clone();
        passes::run(&mut again, &mut Sink::new());
        prop_assert_eq!(all, again);
    }

    #[test]
    fn a_changed_step_is_noticed(program in programs(), row in any::<prop::sample::Index>(), stitch in 0_usize..2) {
        let mut changed = program.clone();
        let rows = &mut changed.pattern.parts[0].rows;
        prop_assume!(!rows.is_empty());
        let row = row.index(rows.len());
        rows[row].body.push(work([Stitch::SC, Stitch::INC][stitch], 1), Span::NONE);
        prop_assert!(!passes::same_steps(&program.pattern, &changed.pattern));
    }

    #[test]
    fn repeats_never_add_words(program in programs()) {
        let words = |program: &Program| -> usize {
            program.pattern.parts[0].rows.iter().map(|row| text(&row.body).split(", ").count()).sum()
        };
        let mut plain = program.clone();
        for row in &mut plain.pattern.parts[0].rows {
            row.body = arbitrary::unfolded(&row.body.steps().collect::<Vec<_>>());
        }
        let runs = PASSES.iter().find(|pass| pass.name == "runs").expect("listed");
        (runs.run)(&mut plain, &mut Sink::new());
        let mut folded = plain.clone();
        passes::run(&mut folded, &mut Sink::new());
        prop_assert!(words(&folded) <= words(&plain));
    }
}
