//! Arbitrary programs for property tests: workable by construction, with every kind of start, step and finish.
//!
//! A program is grown from a tape of numbers. A used-up tape answers 0, the simplest choice, so that a shorter tape is
//! a simpler program and proptest shrinks well.

use glam::DVec3;
use picot::diag::Span;
use picot::ir::graph::Corners;
use picot::ir::yarn::Hook;
use picot::ir::{
    Block, Direction, Entry, Finish, Gauge, GaugeOrigin, Graph, Hand, Kind, Maker, Node, Op, Part, PartId,
    Pattern, Program, Row, Segment, Start, Step, Stitch, Tile,
};
use proptest::prelude::*;
use std::collections::VecDeque;

/// Any program, with or without a graph.
pub(crate) fn programs() -> impl Strategy<Value = Program> {
    proptest::collection::vec(any::<u32>(), 0..300).prop_map(|tape| program(&tape))
}

/// The program that a tape stands for.
pub(crate) fn program(tape: &[u32]) -> Program {
    Grower { tape: tape.iter().copied().collect(), with_graph: false, colors: 0 }.program()
}

/// The same program as if no one had written it: equality of rows looks at their places too.
pub(crate) fn without_places(mut program: Program) -> Program {
    for row in program.pattern.parts.iter_mut().flat_map(|part| &mut part.rows) {
        row.span = Span::NONE;
        row.stated = row.stated.map(|(count, _)| (count, Span::NONE));
    }
    program
}

struct Grower {
    tape: VecDeque<u32>,
    with_graph: bool,
    colors: u16,
}

impl Grower {
    /// A choice below `n`; 0 when the tape is used up.
    fn below(&mut self, n: u32) -> u32 {
        self.tape.pop_front().unwrap_or(0) % n.max(1)
    }
    fn one_in(&mut self, n: u32) -> bool {
        self.below(n) == n - 1
    }
    fn real(&mut self) -> f64 {
        let (a, b) = (self.below(u32::MAX), self.below(u32::MAX));
        match a % 8 {
            0 => 0.0,
            1 => -0.0,
            2 => f64::from(b) / 3.0,
            3 => -f64::from(b) * 1e-12,
            4 => f64::from_bits(u64::from(b)), // subnormal
            5 => f64::from(b) * 1e290,
            _ => f64::from(b % 1000) / 8.0,
        }
    }

    fn program(mut self) -> Program {
        const NAMES: [&str; 6] = [
            "cup",
            "a <b> & \"c\" 'd'",
            "tab\there,\nline",
            "Hütchen 帽子 🧶",
            "",
            "  spaces \u{85}\u{2028} ",
        ];
        const COLORS: [&str; 3] = ["red", "<&>", ""];
        self.with_graph = self.below(2) == 1;
        self.colors = self.below(4) as u16;
        let name = NAMES[self.below(6) as usize].to_owned();
        let gauge = match self.below(4) {
            0 => None,
            1 => Some(GaugeOrigin::Given),
            2 => Some(GaugeOrigin::Swatch),
            _ => Some(GaugeOrigin::Estimated {
                weight: self.below(8) as u8,
                hook: Hook::from_mm(0.4 + f64::from(self.below(5000)) / 100.0).expect("a hook"),
                in_range: self.below(2) == 0,
            }),
        };
        let size = |grower: &mut Self| 0.5 + f64::from(grower.below(1000)) / 97.0;
        let gauge = gauge.map(|origin| Gauge { width: size(&mut self), height: size(&mut self), origin });
        let colors = (0..self.colors).map(|color| COLORS[color as usize].to_owned()).collect();
        let count = 1 + self.below(4);
        let mut parts: Vec<Part> = Vec::new();
        // Loops that a part left open at its end, and loops held for the next part.
        let (mut open, mut held) = (Vec::new(), None);
        for index in 0..count {
            let (mut part, mut loops) = self.begin(index, &parts, &mut open, held.take());
            let rows = self.below(5);
            for _ in 0..rows {
                if loops == 0 || loops > 400 {
                    break;
                }
                let (row, left) = self.row(
                    loops,
                    (index + 1 < count && part.copies == 1).then_some(index + 1),
                    &mut held,
                    index,
                    part.flat,
                );
                part.rows.push(row);
                loops = left;
            }
            part.finish = if self.below(2) == 1 && loops > 0 { Finish::DrawnShut } else { Finish::Open };
            open.push(if part.finish == Finish::Open && !part.flat { loops } else { 0 });
            parts.push(part);
        }
        let graphs =
            if self.with_graph { parts.iter().map(|part| self.graph(part)).collect() } else { Vec::new() };
        let hand = if self.one_in(3) { Hand::Left } else { Hand::Right };
        let lean = if self.one_in(3) { f64::from(self.below(2001)) / 1000.0 - 1.0 } else { 0.0 };
        Program { name, gauge, maker: Maker { hand, lean }, colors, pattern: Pattern { parts }, graphs }
    }

    fn begin(
        &mut self,
        index: u32,
        parts: &[Part],
        open: &mut [u32],
        held: Option<(u32, u32)>,
    ) -> (Part, u32) {
        const NAMES: [&str; 4] = ["body", "left ear", "arm <1>", "\"tail\" & tip"];
        let loops = 1 + self.below(20);
        let mut segments = Vec::new();
        if let Some((from, loops)) = held {
            segments.push(Segment::Held { part: PartId(from), loops });
        }
        if index > 0 && self.below(3) > 0 {
            let from = self.below(index);
            let left = open[from as usize];
            if left > 0 && self.below(2) == 0 {
                segments.push(Segment::Open {
                    part: PartId(from),
                    loops: std::mem::take(&mut open[from as usize]),
                });
            } else if let Some((round, loops)) = first_round(&parts[from as usize]) {
                let first = 1 + self.below(loops);
                let loops = 1 + self.below(loops - first + 1);
                let back = self.below(2) == 1;
                segments.push(Segment::Surface { part: PartId(from), round, first, loops, back });
            }
            if self.below(2) == 1 {
                segments.push(Segment::Chain { loops });
            }
        }
        let start = match self.below(3) {
            _ if !segments.is_empty() => Start::Join { segments },
            0 => Start::Ring { loops },
            1 => Start::Chain { loops, joined: true },
            _ => Start::Chain { loops, joined: false },
        };
        let part = Part {
            name: NAMES[index as usize].to_owned(),
            flat: matches!(start, Start::Chain { joined: false, .. }),
            copies: if matches!(start, Start::Join { .. }) { 1 } else { 1 + self.below(3) / 2 },
            rows: Vec::new(),
            finish: Finish::Open,
            start,
        };
        let loops = part.start.loops();
        (part, loops)
    }

    /// A row on `loops` open loops, and the loops that it leaves.
    fn row(
        &mut self,
        loops: u32,
        next: Option<u32>,
        held: &mut Option<(u32, u32)>,
        index: u32,
        flat: bool,
    ) -> (Row, u32) {
        let (mut ops, mut ahead, mut made) = (Vec::new(), loops, 0_u32);
        let mut even = true;
        while ahead > 0 {
            match self.below(9) {
                0 => {
                    let times = 1 + self.below(ahead);
                    ops.push(work(self.plain(), times));
                    (ahead, made) = (ahead - times, made + times);
                }
                1 => {
                    let body = [work(self.plain(), 1), work(Stitch::INC, 1)];
                    let times = ahead / 2;
                    if times > 0 {
                        ops.push(repeat(body, times));
                        (ahead, made) = (ahead - 2 * times, made + 3 * times);
                    }
                }
                2 if ahead >= 2 => {
                    let works = 2 + self.below(2).min(ahead - 2);
                    ops.push(work(Stitch { works: works as u16, ..Stitch::DEC }, 1));
                    (ahead, made) = (ahead - works, made + 1);
                }
                3 => {
                    let makes = 2 + self.below(2);
                    let kind = self.kind();
                    ops.push(work(Stitch { kind, works: 1, makes: makes as u16, entry: self.entry() }, 1));
                    (ahead, made) = (ahead - 1, made + makes);
                }
                4 if made > 0 && !flat => {
                    // There and back, then on over the loops of the back pass.
                    let back = 1 + self.below(made);
                    ops.extend([
                        Op::Turn(Direction::Back),
                        work(Stitch::SC, back),
                        Op::Turn(Direction::Forward),
                    ]);
                    ops.push(work(Stitch::SC, back));
                }
                5 if self.colors > 0 => ops.push(Op::Color(self.below(self.colors.into()) as u16)),
                6 => ops.push(work(Stitch::plain(Kind::Ch), 1 + self.below(3))),
                7 if held.is_none() && next.is_some() && made > 0 && ahead > 1 => {
                    let loops = 1 + self.below(ahead - 1);
                    let by = PartId(next.unwrap_or_default());
                    ops.push(Op::Hold { loops, by });
                    *held = Some((index, loops));
                    (ahead, even) = (ahead - loops, false);
                }
                8 if flat && made > 0 => {
                    ops.push(Op::Leave { loops: ahead });
                    (ahead, even) = (0, false);
                }
                _ => {
                    ops.push(work(self.plain(), ahead));
                    (ahead, made) = (0, made + ahead);
                }
            }
        }
        let mut row = Row::new(ops.into_iter().collect());
        if even && made == loops && self.one_in(3) {
            row.times = 1 + self.below(5);
        }
        row.stated = (self.below(2) == 1).then_some((made, Span::NONE));
        (row, made)
    }

    /// A stitch that makes as many loops as it works.
    fn plain(&mut self) -> Stitch {
        Stitch { works: 1, makes: 1, entry: self.entry(), kind: self.kind() }
    }
    fn kind(&mut self) -> Kind {
        let kinds: Vec<Kind> =
            Kind::ALL.iter().copied().filter(|kind| kind.works() == 1 && kind.makes() == 1).collect();
        kinds[self.below(kinds.len() as u32) as usize]
    }
    fn entry(&mut self) -> Entry {
        [Entry::Both, Entry::Both, Entry::Front, Entry::Back][self.below(4) as usize]
    }

    /// The graph of a part: its steps are worked on a line of loops, positions are any numbers.
    fn graph(&mut self, part: &Part) -> Graph {
        let mut graph = Graph { start: part.start.loops(), ..Graph::default() };
        for _ in 0..graph.start {
            self.node(&mut graph);
        }
        graph.pole = matches!(part.start, Start::Ring { .. }).then(|| DVec3::new(self.real(), 0.0, -0.0));
        graph.end_pole =
            (part.finish == Finish::DrawnShut).then(|| DVec3::new(1.0, self.real(), self.real()));
        let mut ahead: VecDeque<u32> = (0..graph.start).collect();
        let mut turn_from = None;
        let mut beyond = Vec::new();
        for row in &part.rows {
            for _ in 0..row.times {
                let mut made: Vec<u32> = Vec::new();
                let mut direction = Direction::Forward;
                for step in row.body.steps() {
                    match step {
                        Step::Work(stitch) => {
                            let base = take(&mut ahead, &mut made, stitch.works, direction);
                            let first = graph.nodes.len() as u32;
                            let mut top: Vec<u32> = (first..first + u32::from(stitch.makes)).collect();
                            for _ in 0..stitch.makes {
                                self.node(&mut graph);
                            }
                            if let (Some((base, direction)), Some(&top)) = (turn_from, top.first()) {
                                let tile = Tile {
                                    stitch: None,
                                    direction,
                                    base: Corners::one(base),
                                    top: Corners::one(top),
                                };
                                graph.tiles.push(tile);
                                turn_from = None;
                            }
                            match direction {
                                Direction::Forward => made.extend(&top),
                                Direction::Back => top.iter().for_each(|&id| ahead.push_front(id)),
                            }
                            if direction == Direction::Back {
                                top.reverse();
                            }
                            let corners = |ids: &[u32]| Corners::new(ids).expect("three loops at most");
                            let (base, top) = (corners(&base), corners(&top));
                            graph.tiles.push(Tile { stitch: Some(stitch), direction, base, top });
                        }
                        Step::Turn(to) => {
                            direction = to;
                            turn_from = Some((graph.nodes.len() as u32 - 1, to));
                        }
                        Step::Hold { loops, .. } => drop(ahead.drain(..loops as usize)),
                        Step::Leave { .. } | Step::Color(_) => {}
                    }
                }
                if part.flat {
                    // The work turns: what is behind lies ahead, newest first, and what is left lies on the other side.
                    made.reverse();
                    beyond.reverse();
                    let left: Vec<u32> = ahead.drain(..).rev().collect();
                    ahead = made.into_iter().chain(std::mem::replace(&mut beyond, left)).collect();
                } else {
                    ahead.extend(made);
                }
            }
        }
        graph
    }

    fn node(&mut self, graph: &mut Graph) {
        let id = graph.nodes.len() as f64;
        let position = if self.tape.is_empty() {
            DVec3::new(id / 7.0, -id, 0.1)
        } else {
            DVec3::new(self.real(), self.real(), self.real())
        };
        let v = (id / 11.0).fract();
        graph.nodes.push(Node { position, u: id / 1e3, tau: id / 13.0, v });
    }
}

fn take(ahead: &mut VecDeque<u32>, made: &mut Vec<u32>, works: u16, direction: Direction) -> Vec<u32> {
    let next = |_| match direction {
        Direction::Forward => ahead.pop_front(),
        Direction::Back => made.pop(),
    };
    let mut base: Vec<u32> = (0..works).map_while(next).collect();
    if direction == Direction::Back {
        base.reverse();
    }
    base
}

fn work(stitch: Stitch, times: u32) -> Op {
    Op::Work { stitch, times }
}

fn repeat(body: impl IntoIterator<Item = Op>, times: u32) -> Op {
    Op::repeat(body.into_iter().collect::<Block>(), times)
}

/// A round whose stitches can be worked around, and how many it has.
fn first_round(part: &Part) -> Option<(u32, u32)> {
    let (number, row) = part.numbered_rows().next()?;
    let made: Option<u32> = row
        .body
        .steps()
        .map(|step| match step {
            Step::Work(stitch) => Some(stitch.makes.into()),
            Step::Turn(_) => None,
            Step::Hold { .. } | Step::Leave { .. } | Step::Color(_) => Some(0),
        })
        .sum();
    let made = made?;
    (made > 0).then_some((number, made))
}
