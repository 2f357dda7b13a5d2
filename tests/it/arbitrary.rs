//! Arbitrary workable patterns: a tape of bytes decides, loop by loop, what is worked next. Written from the meaning of
//! turns and loops alone; it shares no code with the library.

use glam::DVec3;
use picot::ir::graph::Corners;
use picot::ir::{
    Block, Direction, Finish, Graph, Maker, Node, Op, Part, Pattern, Program, Row, Start, Step, Stitch, Tile,
};
use std::collections::VecDeque;

/// Decisions, which shrink towards plain rows of single crochet.
pub(crate) struct Tape<'t>(pub(crate) std::slice::Iter<'t, u8>);

impl Tape<'_> {
    fn below(&mut self, bound: u32) -> u32 {
        u32::from(self.0.next().copied().unwrap_or(0)) % bound.max(1)
    }
}

/// How many rows, and what they may do.
#[derive(Clone, Copy)]
pub(crate) struct Shape {
    pub(crate) start: u32,
    pub(crate) rows: u32,
    /// A short row may go back over the start of its round.
    pub(crate) crossing: bool,
    /// The last row may end early.
    pub(crate) early: bool,
}

/// Rows of steps on `start` loops in a spiral.
pub(crate) fn rows(tape: &mut Tape<'_>, shape: Shape) -> Vec<Vec<Step>> {
    let mut below = shape.start;
    let mut rows = Vec::new();
    for index in 0..shape.rows {
        let mut row = Vec::new();
        let (mut ahead, mut behind) = (i64::from(below), 0_i64);
        let mut raised = 0;
        let mut turns = 0;
        let last = index + 1 == shape.rows;
        loop {
            let choice = tape.below(16);
            let limit = if shape.crossing && index > 0 { i64::from(below) * 6 / 10 } else { behind };
            let limit = limit.min(behind + ahead).min(i64::from(below) * 6 / 10);
            if choice == 15 && turns < 3 && limit > 0 && !row.is_empty() && raised == 0 {
                turns += 1;
                let reach = 1 + i64::from(tape.below(limit as u32));
                row.push(Step::Turn(Direction::Back));
                let mut left = reach;
                while left > 0 {
                    let stitch = match tape.below(8) {
                        7 if left > 1 => Stitch::DEC,
                        6 => Stitch::INC,
                        _ => Stitch::SC,
                    };
                    left -= i64::from(stitch.works);
                    raised += i64::from(stitch.makes);
                    row.push(Step::Work(stitch));
                }
                behind -= reach;
                ahead += raised;
                row.push(Step::Turn(Direction::Forward));
            }
            if ahead == 0 {
                break;
            }
            if shape.early && last && matches!(row.last(), Some(Step::Work(_))) && tape.below(32) == 31 {
                row.push(Step::Leave { loops: ahead as u32 });
                break;
            }
            let stitch = match tape.below(8) {
                7 if ahead > 1 && raised != 1 => Stitch::DEC,
                6 if below < 40 => Stitch::INC,
                _ => Stitch::SC,
            };
            ahead -= i64::from(stitch.works);
            raised = (raised - i64::from(stitch.works)).max(0);
            behind += i64::from(stitch.makes);
            row.push(Step::Work(stitch));
        }
        below = behind as u32;
        rows.push(row);
    }
    rows
}

/// The stitch graph of a spiral of steps; positions are made up.
pub(crate) fn graph(start: u32, rows: &[Vec<Step>]) -> Graph {
    let mut graph = Graph { start, ..Graph::default() };
    let mut ring: VecDeque<u32> = (0..start).collect();
    let mut next = start;
    let mut held: Vec<u32> = Vec::new();
    let mut direction = Direction::Forward;
    for step in rows.iter().flatten() {
        match *step {
            Step::Work(stitch) => {
                let back = direction == Direction::Back;
                let mut base: Vec<u32> = (0..stitch.works)
                    .filter_map(|_| if back { ring.pop_back() } else { ring.pop_front() })
                    .collect();
                let mut top: Vec<u32> = (0..u32::from(stitch.makes)).map(|made| next + made).collect();
                next += u32::from(stitch.makes);
                if back {
                    held.extend(&top);
                    base.reverse();
                    top.reverse();
                } else {
                    ring.extend(&top);
                }
                let [base, top] = [base, top].map(|ids| Corners::new(&ids).unwrap_or_default());
                graph.tiles.push(Tile { stitch: Some(stitch), direction, base, top });
            }
            Step::Turn(new) => {
                direction = new;
                held.drain(..).for_each(|id| ring.push_front(id));
                let (base, top) = (Corners::one(next - 1), Corners::one(next));
                graph.tiles.push(Tile { stitch: None, direction, base, top });
            }
            Step::Leave { .. } | Step::Hold { .. } | Step::Color(_) => {}
        }
    }
    let place = |id: u32| {
        let tau = f64::from(id) / f64::from(start.max(1));
        Node { position: DVec3::new(f64::from(id), 0.0, tau), tau, u: 0.0, v: tau.fract() }
    };
    graph.nodes = (0..next).map(place).collect();
    graph
}

/// The steps as unfolded operations.
pub(crate) fn unfolded(steps: &[Step]) -> Block {
    steps
        .iter()
        .map(|step| match *step {
            Step::Work(stitch) => Op::Work { stitch, times: 1 },
            Step::Turn(direction) => Op::Turn(direction),
            Step::Hold { loops, by } => Op::Hold { loops, by },
            Step::Leave { loops } => Op::Leave { loops },
            Step::Color(color) => Op::Color(color),
        })
        .collect()
}

/// A program of one part in rounds, without graph.
pub(crate) fn program(start: Start, rows: impl IntoIterator<Item = Row>) -> Program {
    let part = Part {
        name: "body".into(),
        start,
        rows: rows.into_iter().collect(),
        finish: Finish::Open,
        flat: false,
        copies: 1,
    };
    Program {
        name: "thing".into(),
        gauge: None,
        maker: Maker::default(),
        colors: Vec::new(),
        pattern: Pattern { parts: vec![part] },
        graphs: Vec::new(),
    }
}

/// Runs that are the same every time.
pub(crate) fn config(cases: u32) -> proptest::test_runner::Config {
    proptest::test_runner::Config {
        cases,
        rng_seed: proptest::test_runner::RngSeed::Fixed(2026),
        failure_persistence: None,
        ..Default::default()
    }
}
