//! From the sheet to the graph: nodes renumbered into the order in which the yarn makes them.

use super::rows::Rows;
use super::sheet::{Sheet, ShortRow, Work};
use crate::ir::graph::Corners;
use crate::ir::{Direction, Graph, Node, NodeId, Tile};
use crate::math;
use glam::DVec3;
use std::collections::BTreeMap;

/// The graph of a finished sheet. `start` is the number of nodes of the first row.
/// `turn` is the place around the tube where the helix began.
pub(crate) fn graph(
    mut sheet: Sheet,
    rows: &Rows,
    start: usize,
    poles: [Option<DVec3>; 2],
    turn: f64,
) -> Graph {
    sheet.keep_work();
    let order = Order::of(&sheet, start);
    let mut nodes = vec![Node { position: DVec3::ZERO, u: 0.0, tau: 0.0, v: 0.0 }; sheet.len()];
    let mut knot = 0;
    for (old, &new) in order.new_id.iter().enumerate() {
        if let Some(node) = nodes.get_mut(new as usize) {
            let v = math::fraction(sheet.v[old] + turn);
            // A hair below zero rounds up to a whole turn.
            let v = if v < 1.0 { v } else { 0.0 };
            *node = Node {
                position: sheet.point[old],
                u: sheet.u[old],
                tau: rows.tau(sheet.u[old], &mut knot),
                v,
            };
        }
    }
    Graph { nodes, tiles: order.tiles, start: start as u32, pole: poles[0], end_pole: poles[1] }
}

/// The short rows by the node after which they turn.
struct Turns<'s> {
    sheet: &'s Sheet,
    /// One look tells for most nodes that no short row follows.
    turning: Vec<bool>,
    by_node: BTreeMap<NodeId, usize>,
}

impl<'s> Turns<'s> {
    fn new(sheet: &'s Sheet) -> Self {
        let mut turning = vec![false; sheet.len()];
        for short_row in &sheet.short_rows {
            turning[short_row.after as usize] = true;
        }
        let by_node =
            sheet.short_rows.iter().enumerate().map(|(k, short_row)| (short_row.after, k)).collect();
        Self { sheet, turning, by_node }
    }

    fn after(&self, node: NodeId) -> Option<&'s ShortRow> {
        if !self.turning[node as usize] {
            return None;
        }
        self.by_node.get(&node).map(|k| &self.sheet.short_rows[*k])
    }
}

struct Order {
    new_id: Vec<NodeId>,
    next: NodeId,
    tiles: Vec<Tile>,
}

impl Order {
    fn of(sheet: &Sheet, start: usize) -> Self {
        let mut order = Self { new_id: vec![NodeId::MAX; sheet.len()], next: 0, tiles: Vec::new() };
        order.tiles.reserve(sheet.main.len() + sheet.main.len() / 16);
        for id in 0..start {
            order.number(id as NodeId);
        }
        let turns = Turns::new(sheet);
        // What is still to be worked after a short row: the rest of the pass that it interrupted.
        let mut passes = vec![sheet.main.iter()];
        while let Some(pass) = passes.last_mut() {
            let Some(work) = pass.next() else {
                passes.pop();
                continue;
            };
            order.stitch(work, Direction::Forward);
            if let Some(short_row) = turns.after(work.top[1]) {
                order.turn(Direction::Back);
                for work in short_row.back.iter().rev() {
                    order.stitch(work, Direction::Back);
                }
                order.turn(Direction::Forward);
                passes.push(short_row.forward.iter());
            }
        }
        order
    }

    fn number(&mut self, old: NodeId) -> NodeId {
        let id = &mut self.new_id[old as usize];
        if *id == NodeId::MAX {
            *id = self.next;
            self.next += 1;
        }
        *id
    }

    fn corners(&mut self, ids: [NodeId; 2], direction: Direction) -> Corners {
        if ids[0] == ids[1] {
            return Corners::one(self.number(ids[0]));
        }
        // New tops are numbered as the yarn makes them, and listed from left to right.
        if direction == Direction::Back {
            let right = self.number(ids[1]);
            let left = self.number(ids[0]);
            return Corners::two(left, right);
        }
        let left = self.number(ids[0]);
        Corners::two(left, self.number(ids[1]))
    }

    fn stitch(&mut self, work: &Work, direction: Direction) {
        let base = self.corners(work.base, direction);
        let top = self.corners(work.top, direction);
        self.tiles.push(Tile { stitch: Some(work.stitch), direction, base, top });
    }

    /// The turn joins the last loop made with the next one.
    fn turn(&mut self, direction: Direction) {
        let last = self.next - 1;
        let (base, top) = (Corners::one(last), Corners::one(last + 1));
        self.tiles.push(Tile { stitch: None, direction, base, top });
    }
}
