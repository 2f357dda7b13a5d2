//! The levels as short, stable text, for snapshots and `--dump`.

use super::{Block, Direction, Entry, Graph, Op, Part, Pattern, Segment, Start, Stitch, Tile};
use std::fmt::{self, Write as _};

/// A pattern: a line a row, with the operations folded as they are.
pub fn pattern(pattern: &Pattern) -> String {
    let mut text = String::new();
    for (index, part) in pattern.parts.iter().enumerate() {
        // Writing to a string does not fail.
        let _ = part_lines(index, part, &mut text);
    }
    text
}

fn part_lines(index: usize, part: &Part, text: &mut String) -> fmt::Result {
    write!(text, "part {index} {:?}", part.name)?;
    if part.copies != 1 {
        write!(text, " copies {}", part.copies)?;
    }
    if part.flat {
        write!(text, " flat")?;
    }
    match &part.start {
        Start::Ring { loops } => write!(text, " ring {loops}")?,
        Start::Chain { loops, joined } => {
            write!(text, " chain {loops}{}", if *joined { " joined" } else { "" })?;
        }
        Start::Join { segments } => {
            for segment in segments {
                match segment {
                    Segment::Open { part, loops } => write!(text, " open {loops} of {}", part.0)?,
                    Segment::Held { part, loops } => write!(text, " held {loops} of {}", part.0)?,
                    Segment::Surface { part, round, first, loops, back } => {
                        let way = if *back { "down to" } else { "from" };
                        write!(text, " surface {loops} of {} round {round} {way} {first}", part.0)?;
                    }
                    Segment::Chain { loops } => write!(text, " chain {loops}")?,
                }
            }
        }
    }
    writeln!(text, " finish {:?}", part.finish)?;
    for (number, row) in part.numbered_rows() {
        write!(text, "  {number}")?;
        if row.times != 1 {
            write!(text, " x{}", row.times)?;
        }
        write!(text, ":")?;
        block(&row.body, text)?;
        match row.stated {
            Some((count, _)) => writeln!(text, " = {count}")?,
            None => writeln!(text)?,
        }
    }
    Ok(())
}

fn block(ops: &Block, text: &mut String) -> fmt::Result {
    for op in ops.ops() {
        match op {
            Op::Work { stitch, times: 1 } => write!(text, " {}", Short(*stitch))?,
            Op::Work { stitch, times } => write!(text, " {times}{}", Short(*stitch))?,
            Op::Repeat { body, times } => {
                write!(text, " {times}[")?;
                block(body, text)?;
                write!(text, " ]")?;
            }
            Op::Turn(Direction::Back) => write!(text, " <")?,
            Op::Turn(Direction::Forward) => write!(text, " >")?,
            Op::Hold { loops, by } => write!(text, " hold {loops} for {}", by.0)?,
            Op::Leave { loops } => write!(text, " leave {loops}")?,
            Op::Color(color) => write!(text, " color {color}")?,
        }
    }
    Ok(())
}

/// A graph: its size, then a line a tile, `sc 12 > 40` for a stitch from loop 12 to loop 40. Nodes follow with `at`.
pub fn graph(graph: &Graph) -> String {
    let mut text = String::new();
    let _ = graph_lines(graph, &mut text);
    text
}

fn graph_lines(graph: &Graph, text: &mut String) -> fmt::Result {
    writeln!(text, "graph start {} nodes {} tiles {}", graph.start, graph.nodes.len(), graph.tiles.len())?;
    for (name, pole) in [("pole", graph.pole), ("end pole", graph.end_pole)] {
        if let Some(pole) = pole {
            writeln!(text, "  {name} {:.3} {:.3} {:.3}", pole.x, pole.y, pole.z)?;
        }
    }
    for Tile { stitch, direction, base, top } in &graph.tiles {
        match stitch {
            Some(stitch) => write!(text, "  {}", Short(*stitch))?,
            None => write!(text, "  turn")?,
        }
        let arrow = if *direction == Direction::Forward { ">" } else { "<" };
        for (ids, lead) in [(base, ""), (top, arrow)] {
            if !lead.is_empty() {
                write!(text, " {lead}")?;
            }
            ids.iter().try_for_each(|id| write!(text, " {id}"))?;
        }
        writeln!(text)?;
    }
    for (id, node) in graph.nodes.iter().enumerate() {
        let [x, y, z] = node.position.to_array();
        writeln!(text, "  at {id} {x:.3} {y:.3} {z:.3} tau {:.4} v {:.4}", node.tau, node.v)?;
    }
    Ok(())
}

/// A stitch in one word: its US abbreviation, with the loops it works and makes where these are not the kind's own.
struct Short(Stitch);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Stitch { kind, works, makes, entry } = self.0;
        match self.0 {
            Stitch::INC => f.write_str("inc")?,
            Stitch::DEC => f.write_str("dec")?,
            stitch if stitch == (Stitch { entry, ..Stitch::plain(kind) }) => {
                f.write_str(&kind.us().replace(' ', "-"))?;
            }
            _ => write!(f, "{}:{works}:{makes}", kind.us().replace(' ', "-"))?,
        }
        f.write_str(match entry {
            Entry::Both => "",
            Entry::Front => "/front",
            Entry::Back => "/back",
            Entry::Space => "/space",
        })
    }
}
