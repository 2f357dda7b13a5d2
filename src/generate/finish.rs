//! From the sheet to the graph: nodes renumbered into the order in which the yarn makes them.

use super::rows::Rows;
use super::sheet::{Sheet, Work};
use crate::ir::graph::Corners;
use crate::ir::{Direction, Graph, Node, NodeId, Tile};
use glam::DVec3;

/// The graph of a finished sheet. `start` is the number of nodes of the first row.
/// `turn` is the place around the tube where the helix began.
pub(crate) fn graph(sheet: &Sheet, rows: &Rows, start: usize, poles: [Option<DVec3>; 2], turn: f64) -> Graph {
    let mut order = Order { new_id: vec![NodeId::MAX; sheet.len()], next: 0, tiles: Vec::new() };
    order.tiles.reserve(sheet.main.len() + sheet.main.len() / 16);
    for id in 0..start {
        order.number(id as NodeId);
    }
    let mut short_rows = sheet.short_rows.iter().peekable();
    for work in &sheet.main {
        order.stitch(work, Direction::Forward);
        while let Some(short_row) = short_rows.next_if(|short_row| short_row.after == work.top[1]) {
            let last = order.next - 1;
            order.turn(last, Direction::Back);
            for work in short_row.back.iter().rev() {
                order.stitch(work, Direction::Back);
            }
            let last = order.next - 1;
            order.turn(last, Direction::Forward);
            for work in &short_row.forward {
                order.stitch(work, Direction::Forward);
            }
        }
    }
    let mut nodes = vec![Node { position: DVec3::ZERO, u: 0.0, tau: 0.0, v: 0.0 }; sheet.len()];
    for (old, &new) in order.new_id.iter().enumerate() {
        if let Some(node) = nodes.get_mut(new as usize) {
            let v = (sheet.v[old] + turn).rem_euclid(1.0);
            // A hair below zero rounds up to a whole turn.
            let v = if v < 1.0 { v } else { 0.0 };
            *node = Node { position: sheet.point[old], u: sheet.u[old], tau: rows.tau(sheet.u[old]), v };
        }
    }
    Graph { nodes, tiles: order.tiles, start: start as u32, pole: poles[0], end_pole: poles[1] }
}

struct Order {
    new_id: Vec<NodeId>,
    next: NodeId,
    tiles: Vec<Tile>,
}

impl Order {
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
    fn turn(&mut self, last: NodeId, direction: Direction) {
        let (base, top) = (Corners::one(last), Corners::one(last + 1));
        self.tiles.push(Tile { stitch: None, direction, base, top });
    }
}
