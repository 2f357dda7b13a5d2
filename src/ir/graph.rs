//! Where each stitch lies: nodes are open loops in working order, tiles are the stitches between them.

use super::{Direction, Hand, Stitch};
use glam::DVec3;
use std::borrow::Cow;

/// Index of a node in [`Graph::nodes`].
pub type NodeId = u32;

/// The stitch graph of one part (paper, section 3.2). Nodes stand in the order in which the yarn makes them, so the
/// yarn runs from node to node; wales follow from the tiles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Graph {
    /// The loops; the first [`Graph::start`] of them are the first row.
    pub nodes: Vec<Node>,
    /// The stitches and turns in working order.
    pub tiles: Vec<Tile>,
    /// Loops of the first row.
    pub start: u32,
    /// The center of the magic ring when the part has one.
    pub pole: Option<DVec3>,
    /// Where the closed end is drawn shut.
    pub end_pole: Option<DVec3>,
}

/// One open loop: the top of a stitch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Position in mm.
    pub position: DVec3,
    /// Surface parameter along the tube, in [0, 1].
    pub u: f64,
    /// Row coordinate: rows from the start of the surface, fractional (the paper's tau).
    pub tau: f64,
    /// Position around the tube in [0, 1).
    pub v: f64,
}

/// A stitch or a turn with its corner loops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tile {
    /// What is worked; `None` for the turn between two passes of a short row.
    pub stitch: Option<Stitch>,
    /// Direction of work; for a turn the new direction.
    pub direction: Direction,
    /// Loops worked into, in the order of a forward row. For a turn: the last loop made.
    pub base: Corners,
    /// Loops made, in the order of a forward row. For a turn: the first loop made after it.
    pub top: Corners,
}

/// Up to three node ids in place.
#[derive(Clone, Copy, PartialEq, Eq, Default)]
pub struct Corners {
    ids: [NodeId; 3],
    len: u32,
}

impl Corners {
    /// Takes the ids of a slice; `None` when there are more than three.
    pub fn new(ids: &[NodeId]) -> Option<Self> {
        let mut corners = Self::default();
        corners.ids.get_mut(..ids.len())?.copy_from_slice(ids);
        corners.len = ids.len() as u32;
        Some(corners)
    }
    /// One id.
    pub fn one(id: NodeId) -> Self {
        Self { ids: [id, 0, 0], len: 1 }
    }
    /// Two ids.
    pub fn two(a: NodeId, b: NodeId) -> Self {
        Self { ids: [a, b, 0], len: 2 }
    }
}

impl std::ops::Deref for Corners {
    type Target = [NodeId];
    fn deref(&self) -> &[NodeId] {
        &self.ids[..self.len as usize]
    }
}

impl std::fmt::Debug for Corners {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

impl Graph {
    /// The graph as it would be if the same words were worked with the right hand.
    pub fn right_handed(&self, hand: Hand) -> Cow<'_, Self> {
        match hand {
            Hand::Right => Cow::Borrowed(self),
            Hand::Left => Cow::Owned(self.clone().mirrored()),
        }
    }

    /// The graph seen in a mirror ([`maker::mirrored`](super::maker::mirrored)): v runs the other way around.
    #[must_use]
    pub fn mirrored(mut self) -> Self {
        use super::maker::mirrored;
        for node in &mut self.nodes {
            node.position = mirrored(node.position);
            // A hair above zero rounds up to a whole turn.
            node.v = Some(1.0 - node.v).filter(|v| *v < 1.0).unwrap_or(0.0);
        }
        self.pole = self.pole.map(mirrored);
        self.end_pole = self.end_pole.map(mirrored);
        self
    }
    /// Edges along the yarn: successive nodes that are not joined by a turn.
    pub fn courses(&self) -> impl Iterator<Item = (NodeId, NodeId)> + '_ {
        let mut turns =
            self.tiles.iter().filter(|tile| tile.stitch.is_none()).map(|tile| tile.base[0]).peekable();
        (1..self.nodes.len() as NodeId).filter_map(move |to| {
            let from = to - 1;
            if turns.peek() == Some(&from) {
                turns.next();
                return None;
            }
            Some((from, to))
        })
    }
    /// Edges from a loop worked into to a loop made in it.
    pub fn wales(&self) -> impl Iterator<Item = (NodeId, NodeId)> + '_ {
        self.tiles.iter().filter(|tile| tile.stitch.is_some()).flat_map(|tile| {
            tile.base.iter().flat_map(move |&from| tile.top.iter().map(move |&to| (from, to)))
        })
    }
    /// The yarn's step from the last loop of one pass to the first of the next.
    pub fn turns(&self) -> impl Iterator<Item = (NodeId, NodeId)> + '_ {
        self.tiles.iter().filter(|tile| tile.stitch.is_none()).map(|tile| (tile.base[0], tile.top[0]))
    }
}
