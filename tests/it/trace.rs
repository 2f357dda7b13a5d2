//! Tracing a graph gives back the steps that made it, in rounds that can be worked.

use crate::arbitrary::{self, Shape, Tape, program, unfolded};
use picot::diag::Sink;
use picot::ir::verify::verify;
use picot::ir::{Finish, Part, Row, Start, Step};
use picot::lower::trace;
use proptest::prelude::*;

fn steps(part: &Part) -> Vec<Vec<Step>> {
    part.rows.iter().map(|row| row.body.steps().collect()).collect()
}

/// Stitches and turns only.
fn worked(rows: &[Vec<Step>]) -> Vec<Step> {
    let worked = |step: &Step| matches!(step, Step::Work(_) | Step::Turn(_));
    rows.iter().flatten().copied().filter(worked).collect()
}

proptest! {
    #![proptest_config(arbitrary::config(256))]

    #[test]
    fn rounds_come_back_as_they_were(tape in prop::collection::vec(any::<u8>(), 0..500), start in 1_u32..30, count in 1_u32..7) {
        let shape = Shape { start, rows: count, crossing: false, early: true };
        let rows = arbitrary::rows(&mut Tape(tape.iter()), shape);
        let graph = arbitrary::graph(start, &rows);
        let part = trace("body", &graph, Finish::Open);
        prop_assert_eq!(steps(&part), rows);
    }

    #[test]
    fn a_marker_in_the_way_of_a_short_row_moves_back(tape in prop::collection::vec(any::<u8>(), 0..500), start in 6_u32..30, count in 2_u32..7) {
        let shape = Shape { start, rows: count, crossing: true, early: false };
        let rows = arbitrary::rows(&mut Tape(tape.iter()), shape);
        let graph = arbitrary::graph(start, &rows);
        let part = trace("body", &graph, Finish::Open);
        prop_assert_eq!(worked(&steps(&part)), worked(&rows));
        let mut program = program(Start::Ring { loops: 6 }, []);
        program.pattern.parts = vec![part];
        program.graphs = vec![graph];
        let mut sink = Sink::new();
        prop_assert!(verify(&program, &mut sink).is_some(), "{:?}", sink);
    }
}

#[test]
fn a_decrease_over_the_marker_waits_for_the_next_round() {
    use picot::ir::{Op, Stitch};
    let sc = |count| vec![Step::Work(Stitch::SC); count];
    let rows = [[sc(7), vec![Step::Work(Stitch::DEC)], sc(6)].concat()];
    let part = trace("body", &arbitrary::graph(8, &rows), Finish::Open);
    let expected = [
        Row::new([Op::Work { stitch: Stitch::SC, times: 7 }, Op::Leave { loops: 1 }].into_iter().collect()),
        Row::new(
            [Op::Work { stitch: Stitch::DEC, times: 1 }, Op::Work { stitch: Stitch::SC, times: 6 }]
                .into_iter()
                .collect(),
        ),
    ];
    assert_eq!(part.rows, expected);
    assert_eq!(part.start, Start::Chain { loops: 8, joined: true });
    assert_eq!(unfolded(&rows[0]).step_count(), Some(14));
}
