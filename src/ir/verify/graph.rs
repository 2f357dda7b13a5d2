//! Pattern and graph tell the same stitches, loop by loop.

use crate::diag::{Code, Diagnostic, Sink};
use crate::ir::{Direction, Graph, NodeId, Part, Program, Step, Stitch, Tile};
use std::collections::VecDeque;

/// Checks each graph against the part it belongs to. The rows themselves are sound already.
pub(super) fn check(program: &Program, sink: &mut Sink<'_>) {
    let parts = &program.pattern.parts;
    if parts.len() != program.graphs.len() {
        let message = format!("{} parts have {} graphs", parts.len(), program.graphs.len());
        sink.push(Diagnostic::new(Code::BrokenProgram, message));
        return;
    }
    for (part, graph) in parts.iter().zip(&program.graphs) {
        if let Err((message, round)) = follow(part, graph) {
            sink.push(Diagnostic::new(Code::BrokenProgram, message).in_round(&part.name, round));
        }
    }
}

fn follow(part: &Part, graph: &Graph) -> Result<(), (String, Option<u32>)> {
    let start = part.start.loops();
    if graph.start != start || (graph.nodes.len() as u64) < u64::from(start) {
        return Err((format!("the graph starts with {} loops, the pattern with {start}", graph.start), None));
    }
    let finite = |node: &crate::ir::Node| {
        node.position.is_finite() && [node.tau, node.u, node.v].iter().all(|value| value.is_finite())
    };
    if let Some(index) = graph.nodes.iter().position(|node| !finite(node)) {
        return Err((format!("node {index} has no finite place"), None));
    }
    let mut loops = Loops { ahead: (0..start).collect(), next: start, ..Loops::default() };
    let mut tiles = graph.tiles.iter();
    let mut seen = 0_u64;
    for (number, row) in part.numbered_rows() {
        for done in 0..row.times {
            let at = |message: String| (message, Some(number.saturating_add(done)));
            for step in row.body.steps() {
                if let Step::Work(_) | Step::Turn(_) = step {
                    seen += 1;
                    let tile = tiles.next().ok_or_else(|| at(format!("stitch {seen} has no tile")))?;
                    loops.step(step, tile).map_err(|what| at(format!("tile {seen} {what}")))?;
                } else if let Step::Hold { loops: held, .. } = step {
                    loops.ahead.drain(..(held as usize).min(loops.ahead.len()));
                }
            }
            loops.row_ends(part.flat);
        }
    }
    if tiles.next().is_some() {
        return Err((format!("the graph goes on after the pattern's {seen} stitches"), None));
    }
    if graph.tiles.last().is_some_and(|tile| tile.stitch.is_none()) {
        return Err(("the graph ends with a turn, which leads nowhere".to_owned(), None));
    }
    if loops.next as usize != graph.nodes.len() {
        return Err((
            format!("the pattern makes {} loops, the graph has {}", loops.next, graph.nodes.len()),
            None,
        ));
    }
    Ok(())
}

/// The open loops by name.
#[derive(Default)]
struct Loops {
    ahead: VecDeque<NodeId>,
    behind: VecDeque<NodeId>,
    direction: Direction,
    next: NodeId,
}

impl Loops {
    fn step(&mut self, step: Step, tile: &Tile) -> Result<(), &'static str> {
        match (step, tile.stitch) {
            (Step::Work(stitch), Some(found)) if stitch == found => self.work(stitch, tile),
            (Step::Turn(direction), None) => {
                self.direction = direction;
                let sound = tile.direction == direction
                    && tile.base.iter().copied().eq([self.next.wrapping_sub(1)])
                    && tile.top.iter().copied().eq([self.next]);
                if sound { Ok(()) } else { Err("does not turn where the pattern does") }
            }
            _ => Err("is another stitch than the pattern's"),
        }
    }

    fn work(&mut self, stitch: Stitch, tile: &Tile) -> Result<(), &'static str> {
        if tile.direction != self.direction {
            return Err("is worked in another direction");
        }
        let forward = self.direction == Direction::Forward;
        let in_order = |ids: &[NodeId], index: usize| {
            ids.get(if forward { index } else { ids.len().wrapping_sub(index + 1) }).copied()
        };
        // Corners hold three loops; what works or makes more, or works where the stitch before did, shows no base of its own.
        let compare = |count: u16| (1..=3).contains(&count);
        if (compare(stitch.works) && tile.base.len() != usize::from(stitch.works))
            || (compare(stitch.makes) && tile.top.len() != usize::from(stitch.makes))
            || tile.base.iter().any(|&id| id >= self.next)
        {
            return Err("has other corners than its stitch");
        }
        for index in 0..usize::from(stitch.works) {
            let popped = if forward { self.ahead.pop_front() } else { self.behind.pop_back() };
            let popped = popped.ok_or("works a loop that is not there")?;
            if compare(stitch.works) && in_order(&tile.base, index) != Some(popped) {
                return Err("is worked into other loops");
            }
        }
        for index in 0..usize::from(stitch.makes) {
            if compare(stitch.makes) && in_order(&tile.top, index) != Some(self.next) {
                return Err("leaves other loops");
            }
            if forward {
                self.behind.push_back(self.next);
            } else {
                self.ahead.push_front(self.next);
            }
            self.next += 1;
        }
        Ok(())
    }

    /// What is behind lies ahead of the next row; after a turn in the opposite order.
    fn row_ends(&mut self, flat: bool) {
        if flat {
            std::mem::swap(&mut self.ahead, &mut self.behind);
            self.ahead.make_contiguous().reverse();
            self.behind.make_contiguous().reverse();
        } else {
            self.ahead.append(&mut self.behind);
        }
    }
}
