//! What is measured: nodes with edges by kind, and the tiles between neighboring wales.

use super::walk::walk;
use crate::ir::{Graph, Node, NodeId};
use glam::DVec3;

/// An edge between two loops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// Where it begins.
    pub from: NodeId,
    /// Where it ends.
    pub to: NodeId,
    /// It joins two levels at the end of a short row: the yarn's step down (a course), or the turn (a wale).
    pub joins_levels: bool,
}

/// The kinds of tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// Two stitches side by side.
    Quad,
    /// Two tops on one base.
    Inc,
    /// One top on two bases.
    Dec,
    /// Across the end of a short row: the bases are of different levels.
    Step,
    /// The end of a short row where the work turns, on the right.
    TurnRight,
    /// The same on the left.
    TurnLeft,
}

/// Four loops around a piece of the surface, some of which may be one: base left, base right, top left, top right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tile {
    /// The loops.
    pub corners: [NodeId; 4],
    /// Which of them differ, and how they came about.
    pub class: Class,
}

/// A net of loops to be measured, from a [`Graph`] or from an algorithm whose wales may cross.
#[derive(Clone, Debug, Default)]
pub struct Mesh<'g> {
    /// The loops.
    pub nodes: &'g [Node],
    /// Loops of the first row.
    pub start: usize,
    /// Edges along the yarn.
    pub courses: Vec<Edge>,
    /// Edges from a loop to one worked into it.
    pub wales: Vec<Edge>,
    /// The tiles.
    pub tiles: Vec<Tile>,
    /// Polygons that close the gaps beside a short row's ends.
    pub fills: Vec<[NodeId; 4]>,
    /// Loops that nothing is worked into, in working order.
    pub open: Vec<NodeId>,
    /// Short rows.
    pub short_rows: usize,
    /// Whether the first and the last row lie elsewhere than a helix begins and ends.
    pub ragged: [bool; 2],
}

impl<'g> Mesh<'g> {
    /// The edges and tiles of a graph, in one walk along the yarn.
    pub fn of_graph(graph: &'g Graph) -> Self {
        let mut mesh = Self {
            nodes: &graph.nodes,
            start: (graph.start as usize).min(graph.nodes.len()),
            courses: Vec::with_capacity(graph.nodes.len()),
            wales: Vec::with_capacity(graph.nodes.len()),
            tiles: Vec::with_capacity(graph.nodes.len()),
            ..Self::default()
        };
        walk(graph, &mut mesh);
        mesh.find_open();
        mesh
    }

    /// The same net with its first, and its last row, where they lie: not as a helix begins and ends.
    #[must_use]
    pub fn ragged(self, ragged: [bool; 2]) -> Self {
        Self { ragged, ..self }
    }

    /// The edges and tiles of a net that is given by its wales, sorted by base; the yarn runs from node to node.
    /// Tiles follow the paper: a course edge whose ends both have wales has one, between the last top of its first end
    /// and the first top of its second; and two tops on one base have one.
    pub fn of_wales(nodes: &'g [Node], start: usize, wales: &[(NodeId, NodeId)]) -> Self {
        let last = nodes.len().saturating_sub(1);
        let mut mesh = Self { nodes, start: start.min(nodes.len()), ..Self::default() };
        mesh.courses =
            (0..last as NodeId).map(|from| Edge { from, to: from + 1, joins_levels: false }).collect();
        mesh.wales = wales.iter().map(|&(from, to)| Edge { from, to, joins_levels: false }).collect();
        for pair in wales.windows(2) {
            let ((left, top_left), (right, top_right)) = (pair[0], pair[1]);
            let class = if left == right {
                Class::Inc
            } else if left + 1 != right {
                continue;
            } else if top_left == top_right {
                Class::Dec
            } else {
                Class::Quad
            };
            mesh.tiles.push(Tile { corners: [left, right, top_left, top_right], class });
        }
        mesh.find_open();
        mesh
    }

    fn find_open(&mut self) {
        let mut worked = vec![false; self.nodes.len()];
        for wale in &self.wales {
            if let Some(worked) = worked.get_mut(wale.from as usize) {
                *worked = true;
            }
        }
        self.open = (0..self.nodes.len() as NodeId).filter(|id| !worked[*id as usize]).collect();
    }

    /// Loops that were worked into another one.
    pub(super) fn worked(&self) -> usize {
        let mut tops: Vec<NodeId> = self.wales.iter().map(|wale| wale.to).collect();
        tops.sort_unstable();
        tops.dedup();
        tops.len()
    }

    pub(super) fn node(&self, id: NodeId) -> Option<&Node> {
        self.nodes.get(id as usize)
    }

    pub(super) fn corners(&self, tile: &Tile) -> Option<[DVec3; 4]> {
        let [a, b, c, d] = tile.corners.map(|id| self.node(id).map(|node| node.position));
        Some([a?, b?, c?, d?])
    }
}
