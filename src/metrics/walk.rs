//! One walk along the yarn of a graph, which finds its edges and tiles.

use super::mesh::{Class, Edge, Mesh, Tile};
use crate::ir::{Direction, Graph, NodeId};

/// Adds the edges, tiles and fills of a graph to its mesh.
pub(super) fn walk(graph: &Graph, mesh: &mut Mesh<'_>) {
    let start = mesh.start as NodeId;
    for to in 1..start {
        mesh.courses.push(Edge { from: to - 1, to, joins_levels: false });
    }
    let mut walk = Walk {
        mesh,
        passes: vec![Pass::default()],
        before_step: vec![false; graph.nodes.len()],
        behind: (0..start).collect(),
        yarn: Yarn::Runs,
        turned: false,
        turn: None,
        gap_left: None,
        gap_right: None,
    };
    for tile in &graph.tiles {
        match (tile.stitch, tile.direction) {
            (None, Direction::Back) => walk.turn_back(),
            (None, Direction::Forward) => walk.turn_forward(),
            (Some(_), Direction::Forward) => walk.forward(&tile.base, &tile.top),
            (Some(_), Direction::Back) => walk.back(&tile.base, &tile.top),
        }
    }
}

/// How the yarn comes to the next loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Yarn {
    /// Along the row.
    Runs,
    /// Down from the end of a short row.
    Steps,
    /// Up through a turn: the edge is the wale.
    Turns,
}

/// Wales in one direction at one level, as far as they are walked.
#[derive(Clone, Copy, Debug, Default)]
struct Pass {
    last: Option<(NodeId, NodeId)>,
    wales: u32,
    /// Loops made, in a back pass; loops still to be worked, in the forward pass over it.
    loops: usize,
}

struct Walk<'w, 'g> {
    mesh: &'w mut Mesh<'g>,
    /// The pass at the bottom goes around and around; on it lie those of open short rows.
    passes: Vec<Pass>,
    /// Loops whose right neighbor in the ring is of another level.
    before_step: Vec<bool>,
    /// Loops behind the hook, newest last.
    behind: Vec<NodeId>,
    yarn: Yarn,
    /// The next wale is a turn.
    turned: bool,
    /// The last turn's wale.
    turn: Option<(NodeId, NodeId)>,
    /// Corners of the gap at the left end of a short row that waits for its last.
    gap_left: Option<[NodeId; 3]>,
    /// The same at the right end, with the turn's wale and the upper end.
    gap_right: Option<[NodeId; 3]>,
}

impl Walk<'_, '_> {
    fn turn_back(&mut self) {
        self.passes.push(Pass::default());
        self.yarn = Yarn::Turns;
        self.gap_right = None;
        self.mesh.short_rows += 1;
    }

    fn turn_forward(&mut self) {
        let Some(back) = self.passes.pop() else { return };
        if self.passes.is_empty() {
            self.passes.push(Pass::default());
        }
        self.passes.push(Pass { loops: back.loops, ..Pass::default() });
        self.yarn = Yarn::Turns;
        if let (Some(&neighbor), Some((lower, middle))) = (self.behind.last(), back.last) {
            self.mark_step(neighbor);
            self.gap_left = Some([neighbor, lower, middle]);
        }
    }

    fn mark_step(&mut self, left: NodeId) {
        if let Some(mark) = self.before_step.get_mut(left as usize) {
            *mark = true;
        }
    }

    fn forward(&mut self, base: &[NodeId], top: &[NodeId]) {
        for &made in top {
            self.course(made);
            if let Some([neighbor, lower, middle]) = self.gap_left.take() {
                self.mesh.fills.push([neighbor, lower, middle, made]);
            }
            if let Some([lower, middle, upper]) = self.gap_right.take() {
                self.mesh.fills.push([made, lower, middle, upper]);
            }
        }
        if let (true, Some(pass)) = (base.is_empty(), self.passes.last_mut()) {
            // Chains over a slit stand on nothing, and no tile spans them.
            pass.last = None;
        }
        for &from in base {
            for &to in top {
                self.wale(from, to, Direction::Forward);
            }
        }
        self.behind.extend_from_slice(top);
        let in_short_row = self.passes.len() > 1;
        let Some(pass) = self.passes.last_mut().filter(|_| in_short_row) else { return };
        pass.loops = pass.loops.saturating_sub(base.len());
        if pass.loops == 0 {
            self.passes.pop();
            if let Some(&upper) = self.behind.last() {
                self.mark_step(upper);
                self.gap_right = self.turn.map(|(lower, middle)| [lower, middle, upper]);
            }
            self.yarn = Yarn::Steps;
        }
    }

    fn back(&mut self, base: &[NodeId], top: &[NodeId]) {
        for &made in top.iter().rev() {
            self.course(made);
        }
        for &from in base.iter().rev() {
            for &to in top.iter().rev() {
                self.wale(from, to, Direction::Back);
            }
        }
        self.behind.truncate(self.behind.len().saturating_sub(base.len()));
        if let Some(pass) = self.passes.last_mut() {
            pass.loops += top.len();
        }
    }

    /// The yarn comes to a new loop.
    fn course(&mut self, to: NodeId) {
        let Some(from) = to.checked_sub(1) else { return };
        match self.yarn {
            Yarn::Runs => self.mesh.courses.push(Edge { from, to, joins_levels: false }),
            Yarn::Steps => self.mesh.courses.push(Edge { from, to, joins_levels: true }),
            Yarn::Turns => self.turned = true,
        }
        self.yarn = Yarn::Runs;
    }

    fn wale(&mut self, from: NodeId, to: NodeId, direction: Direction) {
        let turned = std::mem::take(&mut self.turned);
        if turned && direction == Direction::Back {
            self.turn = Some((from, to));
        }
        self.mesh.wales.push(Edge { from, to, joins_levels: turned });
        let Some(pass) = self.passes.last_mut() else { return };
        let before = pass.last.replace((from, to));
        pass.wales += 1;
        let second_after_turn = pass.wales == 2;
        let Some(before) = before else { return };
        let ((left, top_left), (right, top_right)) = match direction {
            Direction::Forward => (before, (from, to)),
            Direction::Back => ((from, to), before),
        };
        let corners = [left, right, top_left, top_right];
        let class = if left == right {
            Class::Inc
        } else if top_left == top_right {
            Class::Dec
        } else if self.before_step.get(left as usize) == Some(&true) {
            Class::Step
        } else {
            Class::Quad
        };
        self.mesh.tiles.push(Tile { corners, class });
        if second_after_turn && self.passes.len() > 1 {
            let class = match direction {
                Direction::Forward => Class::TurnLeft,
                Direction::Back => Class::TurnRight,
            };
            self.mesh.tiles.push(Tile { corners, class });
        }
    }
}
