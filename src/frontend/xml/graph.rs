//! The stitch graph of one part: every number to the last bit, every id within the graph.

use super::Document;
use super::cursor::{Element, Stop};
use super::values::{BLANK, Children, Model, quoted};
use crate::diag::Code;
use crate::ir::graph::Corners;
use crate::ir::{Direction, Graph, MAX_LOOPS, Node, Tile};
use glam::DVec3;

static GRAPH: Model =
    Model { names: &["pole", "end-pole", "node", "stitch", "turn"], once: &["pole", "end-pole"], ordered: 3 };

impl<'t> Document<'t, '_, '_> {
    /// Reads a graph.
    pub(super) fn graph(&mut self, element: Element<'t>) -> Result<Graph, Stop> {
        self.cursor.only(element, &["start"])?;
        let mut graph =
            Graph { start: self.cursor.count_of(element, "start", 0..=MAX_LOOPS)?, ..Graph::default() };
        let start_span = self.cursor.get("start").map(|attribute| self.cursor.value_span(attribute));
        let mut children = Children::of(element, &GRAPH);
        while let Some(child) = self.cursor.child(&mut children)? {
            match child.name {
                "pole" => graph.pole = Some(self.pole(child)?),
                "end-pole" => graph.end_pole = Some(self.pole(child)?),
                "node" => {
                    let node = self.node(child, graph.nodes.len() as u32)?;
                    graph.nodes.push(node);
                }
                _ => {
                    let tile = self.tile(child, graph.nodes.len() as u32)?;
                    graph.tiles.push(tile);
                }
            }
        }
        if let (true, Some(span)) = (graph.start as usize > graph.nodes.len(), start_span) {
            let message =
                format!("the first row has {} loops, the graph {} nodes", graph.start, graph.nodes.len());
            self.cursor.at(Code::XmlReference, message, span, "`start` counts the first nodes")?;
        }
        Ok(graph)
    }

    fn position(&mut self, element: Element<'t>) -> Result<DVec3, Stop> {
        let x = self.cursor.real_of(element, "x")?;
        let y = self.cursor.real_of(element, "y")?;
        Ok(DVec3::new(x, y, self.cursor.real_of(element, "z")?))
    }

    fn pole(&mut self, element: Element<'t>) -> Result<DVec3, Stop> {
        self.cursor.only(element, &["x", "y", "z"])?;
        let position = self.position(element)?;
        self.cursor.leaf(element)?;
        Ok(position)
    }

    fn node(&mut self, element: Element<'t>, next: u32) -> Result<Node, Stop> {
        self.cursor.only(element, &["id", "x", "y", "z", "u", "tau", "v"])?;
        let id = self.cursor.count_of(element, "id", 0..=MAX_LOOPS)?;
        if let Some(attribute) = self.cursor.get("id").filter(|_| id != next) {
            let message = format!("node {id} stands where node {next} is due");
            let span = self.cursor.value_span(attribute);
            self.cursor.at(Code::XmlReference, message, span, "ids count from 0 without gaps")?;
        }
        let node = Node {
            position: self.position(element)?,
            u: self.cursor.real_of(element, "u")?,
            tau: self.cursor.real_of(element, "tau")?,
            v: self.cursor.real_of(element, "v")?,
        };
        self.cursor.leaf(element)?;
        Ok(node)
    }

    fn tile(&mut self, element: Element<'t>, nodes: u32) -> Result<Tile, Stop> {
        let turn = element.name == "turn";
        let words = Direction::ALL.map(|direction| (direction.word(), direction));
        let (stitch, direction) = if turn {
            self.cursor.only(element, &["direction", "base", "top"])?;
            (None, self.cursor.word_of(element, "direction", &words)?)
        } else {
            self.cursor.only(element, &["op", "works", "makes", "into", "direction", "base", "top"])?;
            (Some(self.stitch(element)?), self.cursor.word("direction", &words)?)
        };
        let mut ends = [Corners::default(); 2];
        for (corners, name) in ends.iter_mut().zip(["base", "top"]) {
            *corners = self.corners(element, name, nodes, turn)?;
        }
        self.cursor.leaf(element)?;
        Ok(Tile { stitch, direction: direction.unwrap_or_default(), base: ends[0], top: ends[1] })
    }

    /// The nodes at one end of a stitch; exactly one at each end of a turn.
    fn corners(&mut self, element: Element<'t>, name: &str, nodes: u32, turn: bool) -> Result<Corners, Stop> {
        let (list, span) = self.cursor.text_of(element, name)?;
        if span.is_none() {
            return Ok(Corners::one(0));
        }
        let (mut ids, mut len) = ([0; 3], 0);
        let mut fits = true;
        for word in list.split(BLANK).filter(|word| !word.is_empty()) {
            match (word.parse::<u32>(), ids.get_mut(len)) {
                (Ok(id), Some(slot)) => *slot = id,
                _ => fits = false,
            }
            len += 1;
        }
        let ids = ids.get(..len.min(3)).unwrap_or_default();
        if !fits || (turn && len != 1) {
            let message = format!("`{name}` is {}", quoted(&list));
            let help =
                if turn { "a turn has one node at each end" } else { "write up to three ids of nodes" };
            self.cursor.at(Code::XmlValue, message, span, help)?;
            return Ok(Corners::one(0));
        }
        if let Some(id) = ids.iter().find(|&&id| id >= nodes) {
            let message = format!("`{name}` names node {id}, there are {nodes} nodes");
            self.cursor.at(Code::XmlReference, message, span, "name a node of this graph")?;
        }
        Ok(Corners::new(ids).unwrap_or_default())
    }
}
