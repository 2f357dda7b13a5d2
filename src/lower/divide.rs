//! A part whose last loops divide between two others: every loop goes to one of them, and both go on along a chain that
//! lies across, one on each side of it.

use super::join::CHAIN;
use crate::diag::Span;
use crate::ir::graph::Corners;
use crate::ir::joins::Leaves;
use crate::ir::{Block, Direction, Graph, Node, NodeId, Op, Part, PartId, Row, Segment, Step, Stitch, Tile};
use glam::DVec3;
use std::collections::BTreeMap;

/// Fewest loops that either gets.
const LEAST: usize = 3;

/// A part that others share.
#[derive(Debug)]
pub struct Parent<'p> {
    /// The part.
    pub part: &'p mut Part,
    /// Its graph.
    pub graph: &'p mut Graph,
    /// Its place in the pattern.
    pub id: PartId,
}

/// What one of the two begins with.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Share {
    /// Where its loops come from.
    pub segments: Vec<Segment>,
    /// Where these lie, in working order, in mm.
    pub loops: Vec<DVec3>,
}

/// Divides a part between two others, given points along the lines with which those begin and the size of a stitch (mm).
///
/// The work goes on to where the stretch of the one begins, the inner one, sets it aside, and goes across it over chains.
/// There the outer one begins: with what is left of the round, the stitches just made and the chains, all of which a row
/// more sets aside for it. The inner one begins with its stretch and the other side of the chains.
///
/// `None` when one of the two would get next to nothing.
pub fn divide(
    parent: &mut Parent<'_>,
    children: [(PartId, &[DVec3]); 2],
    [width, height]: [f64; 2],
) -> Option<[Share; 2]> {
    complete(parent.part, parent.graph, height);
    let open = Leaves::of(parent.part, parent.graph).open;
    let loops: Vec<DVec3> = open.iter().filter_map(|id| place(parent.graph, *id)).collect();
    let count = loops.len();
    let near = |p: DVec3, line: &[DVec3]| {
        line.iter().map(|q| q.distance_squared(p)).fold(f64::INFINITY, f64::min).sqrt()
    };
    let [(_, one), (_, other)] = children;
    let lead: Vec<f64> = loops.iter().map(|p| near(*p, other) - near(*p, one)).collect();
    let (first, taken) = crate::math::stretch(&lead);
    if taken < LEAST || count < taken + LEAST {
        return None;
    }
    // The loops of the inner one do not lie across the round's start.
    let across = first + taken > count;
    let (inner, outer) = if across { (1, 0) } else { (0, 1) };
    let (from, to) = if across { ((first + taken) % count, first) } else { (first, first + taken) };
    let [inner_id, outer_id] = [children[inner].0, children[outer].0];
    let mut body = Block::default();
    if from > 0 {
        body.push(Op::Work { stitch: Stitch::SC, times: from as u32 }, Span::NONE);
        work_on(parent.graph, open.get(..from)?, height);
    }
    let made: Vec<DVec3> =
        parent.graph.nodes.iter().rev().take(from).rev().map(|node| node.position).collect();
    let middle = |a: Option<&DVec3>, b: Option<&DVec3>| Some(0.5 * (*a? + *b?));
    let start = middle(made.last().or(loops.last()), loops.get(from))?;
    let end = middle(loops.get(to - 1), loops.get(to).or(made.first()).or(loops.first()))?;
    let chains = (start.distance(end) / width).round() as usize;
    let chain: Vec<DVec3> = (0..chains).map(|k| start.lerp(end, (k as f64 + 0.5) / chains as f64)).collect();
    if chains > 0 {
        body.push(Op::Work { stitch: CHAIN, times: chains as u32 }, Span::NONE);
        lay_chain(parent.graph, &chain);
    }
    let held = |loops: usize, by| Op::Hold { loops: loops as u32, by };
    body.push(held(to - from, inner_id), Span::NONE);
    if count > to {
        body.push(held(count - to, outer_id), Span::NONE);
    }
    let part = &mut *parent.part;
    let number = part
        .numbered_rows()
        .last()
        .map_or(part.first_number(), |(number, row)| number.saturating_add(row.times));
    part.rows.push(Row::new(body));
    if from + chains > 0 {
        part.rows.push(Row::new([held(from + chains, outer_id)].into_iter().collect()));
    }
    let held = |loops: usize| Segment::Held { part: parent.id, loops: loops as u32 };
    let back = Segment::Surface {
        part: parent.id,
        round: number,
        first: from as u32 + 1,
        loops: chains as u32,
        back: true,
    };
    let of = |segments: Vec<Segment>, loops: Vec<DVec3>| Share {
        segments: segments.into_iter().filter(|segment| segment.loops() > 0).collect(),
        loops,
    };
    let (stretch, rest) = (loops.get(from..to)?, loops.get(to..)?);
    let mut shares = [Share::default(), Share::default()];
    shares[inner] =
        of(vec![held(to - from), back], stretch.iter().chain(chain.iter().rev()).copied().collect());
    shares[outer] = of(
        vec![held(count - to), held(from + chains)],
        rest.iter().chain(&made).chain(&chain).copied().collect(),
    );
    Some(shares)
}

fn place(graph: &Graph, id: NodeId) -> Option<DVec3> {
    graph.nodes.get(id as usize).map(|node| node.position)
}

/// Adds chains.
fn lay_chain(graph: &mut Graph, chain: &[DVec3]) {
    let last = graph.nodes.last().copied();
    for place in chain {
        let id = graph.nodes.len() as NodeId;
        graph.nodes.extend(last.map(|node| Node { position: *place, ..node }));
        graph.tiles.push(Tile {
            stitch: Some(CHAIN),
            direction: Direction::Forward,
            base: Corners::default(),
            top: Corners::one(id),
        });
    }
}

/// Makes the last round whole: what is left of it is worked, or, when that is the larger half, the round is taken back.
fn complete(part: &mut Part, graph: &mut Graph, height: f64) {
    while let Some(row) = part.rows.last_mut() {
        let Some(&Op::Leave { loops }) = row.body.ops().last() else { return };
        let (mut tiles, mut made, mut worked) = (0_usize, 0_usize, 0_u32);
        for step in row.body.steps() {
            if let Step::Work(stitch) = step {
                made += usize::from(stitch.makes);
                worked = worked.saturating_add(u32::from(stitch.works));
            }
            tiles += usize::from(matches!(step, Step::Work(_) | Step::Turn(_)));
        }
        if loops > worked && part.rows.len() > 1 {
            graph.tiles.truncate(graph.tiles.len().saturating_sub(tiles));
            graph.nodes.truncate(graph.nodes.len().saturating_sub(made));
            part.rows.pop();
            continue;
        }
        let ahead = Leaves::of(part, graph).open;
        if let Some(row) = part.rows.last_mut() {
            let _ = row.body.split_off(row.body.ops().len().saturating_sub(1));
            row.body.push(Op::Work { stitch: Stitch::SC, times: loops }, Span::NONE);
        }
        work_on(graph, ahead.get(..loops as usize).unwrap_or(&ahead), height);
        return;
    }
}

/// Works plain stitches into loops, each straight up from the stitch below.
fn work_on(graph: &mut Graph, bases: &[NodeId], height: f64) {
    let mut below: BTreeMap<NodeId, NodeId> = BTreeMap::new();
    for tile in graph.tiles.iter().filter(|tile| tile.stitch.is_some()) {
        if let Some(base) = tile.base.first() {
            below.extend(tile.top.iter().map(|top| (*top, *base)));
        }
    }
    let mut up = DVec3::Z;
    for &base in bases {
        let node = |id: NodeId| graph.nodes.get(id as usize).copied();
        let Some(here) = node(base) else { return };
        let under = below.get(&base).and_then(|id| node(*id));
        let (mut u, mut tau) = (here.u, here.tau);
        if let Some(under) = under {
            up = (here.position - under.position).normalize_or(up);
            (u, tau) = (2.0 * u - under.u, 2.0 * tau - under.tau);
        }
        let id = graph.nodes.len() as NodeId;
        graph.nodes.push(Node { position: here.position + up * height, u, tau, v: here.v });
        graph.tiles.push(Tile {
            stitch: Some(Stitch::SC),
            direction: Direction::Forward,
            base: Corners::one(base),
            top: Corners::one(id),
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ir::Finish;
    use crate::lower::trace;
    use crate::math::{TAU, cos, sin};

    /// A flat ring of `around` loops, an oval 40 wide and 10 deep, with `stitches` worked in it.
    fn body(around: u32, stitches: u32, begin: f64) -> Graph {
        let nodes = (0..around + stitches).map(|k| {
            let turn = f64::from(k) / f64::from(around);
            let angle = -TAU * (turn + begin);
            Node {
                position: DVec3::new(20.0 * cos(angle), 5.0 * sin(angle), turn),
                u: 0.0,
                tau: turn,
                v: turn % 1.0,
            }
        });
        let tile = |k| Tile {
            stitch: Some(Stitch::SC),
            direction: Direction::Forward,
            base: Corners::one(k),
            top: Corners::one(k + around),
        };
        Graph {
            nodes: nodes.collect(),
            tiles: (0..stitches).map(tile).collect(),
            start: around,
            ..Graph::default()
        }
    }

    #[test]
    fn every_loop_goes_to_one_of_the_two_and_the_chain_to_both() {
        for (stitches, begin) in [(40, 0.0), (40, 0.25), (40, 0.6), (57, 0.1), (44, 0.9), (38, 0.5)] {
            let mut graph = body(20, stitches, begin);
            let mut part = trace("body", &graph, Finish::Open);
            let legs = [-10.0, 10.0].map(|x| vec![DVec3::new(x, 0.0, 2.0)]);
            let mut parent = Parent { part: &mut part, graph: &mut graph, id: PartId(0) };
            let shares =
                divide(&mut parent, [(PartId(1), &legs[0]), (PartId(2), &legs[1])], [3.0, 1.0]).unwrap();
            let (mut held, mut chains, mut worked) = ([0; 2], 0, 0);
            let last = part.rows.len() - 2;
            for step in part.rows[last..].iter().flat_map(|row| row.body.steps()) {
                match step {
                    Step::Hold { loops, by } => held[by.0 as usize - 1] += loops,
                    Step::Work(stitch) if stitch == CHAIN => chains += 1,
                    Step::Work(_) => worked += 1,
                    Step::Turn(_) | Step::Leave { .. } | Step::Color(_) => panic!("{step:?}"),
                }
            }
            // What is held: the loops of the round, and the chain.
            assert_eq!(held[0] + held[1], 20 + chains);
            assert!(worked < 20);
            assert!((2..=4).contains(&chains), "{chains}");
            let open = Leaves::of(&part, &graph).open;
            assert!(open.is_empty(), "no loop is left over");
            for (share, held) in shares.iter().zip(held) {
                let sum: u32 = share.segments.iter().map(|segment| segment.loops()).sum();
                let other_side = share.segments.iter().any(|it| matches!(it, Segment::Surface { .. }));
                assert_eq!(sum, held + if other_side { chains } else { 0 });
                assert_eq!(sum as usize, share.loops.len());
                // The loops follow each other around: no step is longer than two stitches of the ring.
                let around = share.loops.iter().zip(share.loops.iter().cycle().skip(1));
                assert!(around.clone().all(|(a, b)| a.distance(*b) < 14.0), "{begin} {:?}", share.loops);
            }
            assert_eq!(graph.nodes.len() as u32, 20 + graph.tiles.len() as u32);
        }
    }
}
