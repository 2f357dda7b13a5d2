//! A last round of a few stitches is dropped: it would cost the maker a line and give the object next to nothing.

use crate::ir::{Graph, Part, Step};

/// A last round that works at most this many loops, or this share of those there are, is a sliver.
const FEW: u32 = 3;
const SHARE: u32 = 6;

/// Drops the last round of a freshly traced part, and its end of the graph, when it is a sliver without a short row.
pub fn trim(graph: &mut Graph, part: &mut Part) {
    let Some(row) = part.rows.last() else { return };
    let (mut stitches, mut works, mut makes, mut left) = (0_usize, 0_u32, 0_u32, None);
    for step in row.body.steps() {
        match step {
            Step::Work(stitch) => {
                stitches += 1;
                works += u32::from(stitch.works);
                makes += u32::from(stitch.makes);
            }
            Step::Leave { loops } => left = Some(loops),
            Step::Turn(_) | Step::Hold { .. } | Step::Color(_) => return,
        }
    }
    let Some(left) = left else { return };
    let sliver = works <= FEW.max((works + left) / SHARE) && works < left;
    let tiles = graph.tiles.len().checked_sub(stitches);
    let nodes = graph.nodes.len().checked_sub(makes as usize);
    if let (true, Some(tiles), Some(nodes), true) =
        (sliver, tiles, nodes, part.rows.len() > 1 && row.times == 1)
    {
        graph.tiles.truncate(tiles);
        graph.nodes.truncate(nodes);
        part.rows.pop();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ir::graph::Corners;
    use crate::ir::{Direction, Finish, Node, Op, Stitch, Tile};
    use crate::lower::trace;
    use glam::DVec3;

    /// True when the last operation leaves loops unworked.
    fn ends_early(part: &Part) -> bool {
        let last = part.rows.last().and_then(|row| row.body.ops().last());
        matches!(last, Some(Op::Leave { .. }))
    }

    /// A plain tube of `around` loops with `stitches` worked.
    fn tube(around: u32, stitches: u32) -> Graph {
        let node = Node { position: DVec3::ZERO, u: 0.0, tau: 0.0, v: 0.0 };
        let tile = |k| Tile {
            stitch: Some(Stitch::SC),
            direction: Direction::Forward,
            base: Corners::one(k),
            top: Corners::one(k + around),
        };
        Graph {
            nodes: vec![node; (around + stitches) as usize],
            tiles: (0..stitches).map(tile).collect(),
            start: around,
            ..Graph::default()
        }
    }

    #[test]
    fn a_sliver_goes_and_a_real_part_of_a_round_stays() {
        for (stitches, rows, early) in
            [(62, 3, false), (67, 4, true), (80, 4, false), (19, 1, true), (2, 1, true)]
        {
            let mut graph = tube(20, stitches);
            let mut part = trace("tube", &graph, Finish::Open);
            trim(&mut graph, &mut part);
            assert_eq!((part.rows.len(), ends_early(&part)), (rows, early), "{stitches} stitches");
            let worked: u64 = part.rows.iter().filter_map(|row| row.body.step_count()).sum();
            assert_eq!(worked - u64::from(early), graph.tiles.len() as u64);
            assert_eq!(graph.nodes.len(), 20 + graph.tiles.len());
        }
    }
}
