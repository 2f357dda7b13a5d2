//! Parts that grow from others: which stitch of the one each first loop of the other is worked into (paper, section 3.4).

use super::couple::{couple, cycle};
use crate::diag::{Code, Diagnostic, Sink, Span};
use crate::ir::graph::Corners;
use crate::ir::joins::Leaves;
use crate::ir::{
    Block, Entry, Graph, Kind, NodeId, Op, Part, PartId, Program, Segment, Start, Step, Stitch, Tile,
};
use glam::DVec3;

/// A chain that counts as a stitch.
pub(super) const CHAIN: Stitch = Stitch { kind: Kind::Ch, works: 0, makes: 1, entry: Entry::Both };
/// Farthest that a first loop may lie from the stitch it is worked into, in stitches.
const REACH: f64 = 4.0;
/// Farthest that a slit may lie from the middle of the branch that grows from it, in stitches.
const SLIT_REACH: f64 = 3.0;
/// Most of a round that may be held for a branch.
const SLIT_SHARE: f64 = 0.75;

/// Joins a part to the surface of an earlier one: each of its first loops is picked up around the stitch that the
/// coupling of least total distance gives it. `None` with the reason in the sink when the stitches do not meet.
pub fn on_surface(program: &mut Program, part: PartId, to: PartId, sink: &mut Sink<'_>) -> Option<()> {
    let reach = stitch_size(program);
    let parent = program.pattern.parts.get(to.0 as usize)?;
    let base = program.graphs.get(to.0 as usize)?;
    let graph = program.graphs.get(part.0 as usize)?;
    let rim: Vec<DVec3> = graph.nodes.iter().take(graph.start as usize).map(|node| node.position).collect();
    let stitches = named(parent, base, &rim, REACH * reach);
    let places: Vec<DVec3> = stitches.iter().map(|stitch| stitch.position).collect();
    let ring = cycle(&rim, &places);
    let on_ring: Vec<DVec3> = ring.iter().filter_map(|index| places.get(*index)).copied().collect();
    let chosen = couple(&rim, &on_ring);
    let mut picked: Vec<(u32, u32)> = Vec::with_capacity(rim.len());
    let mut farthest = f64::INFINITY;
    if chosen.len() == rim.len() {
        farthest = 0.0;
        for (point, index) in rim.iter().zip(&chosen) {
            let stitch = ring.get(*index).and_then(|index| stitches.get(*index))?;
            farthest = farthest.max(point.distance(stitch.position));
            picked.push((stitch.round, stitch.place));
        }
    }
    if farthest > REACH * reach {
        return far(program, part, to, farthest, sink);
    }
    let segments = segments(to, &picked);
    program.pattern.parts.get_mut(part.0 as usize)?.start = Start::Join { segments };
    Some(())
}

/// Joins a part to an earlier one through a slit: stitches of one round are held for it, chains go over them, and it
/// begins on the held loops and the other side of the chains.
pub fn through_slit(program: &mut Program, part: PartId, to: PartId, sink: &mut Sink<'_>) -> Option<()> {
    let reach = stitch_size(program);
    let graph = program.graphs.get(part.0 as usize)?;
    let rim: Vec<DVec3> = graph.nodes.iter().take(graph.start as usize).map(|node| node.position).collect();
    let middle = rim.iter().sum::<DVec3>() / rim.len().max(1) as f64;
    let Some(slit) = slit(
        program.pattern.parts.get(to.0 as usize)?,
        program.graphs.get(to.0 as usize)?,
        graph.start,
        middle,
    ) else {
        return far(program, part, to, f64::INFINITY, sink);
    };
    if slit.distance > SLIT_REACH * reach {
        return far(program, part, to, slit.distance, sink);
    }
    let parent = program.pattern.parts.get_mut(to.0 as usize)?;
    let number = parent.first_number().saturating_add(slit.row as u32);
    let row = parent.rows.get_mut(slit.row)?;
    row.body = opened(&row.body, &slit, part);
    let base = program.graphs.get_mut(to.0 as usize)?;
    let chains: Vec<Tile> = base
        .tiles
        .get(slit.tiles.clone())?
        .iter()
        .flat_map(|tile| {
            let top = tile.top;
            (0..top.len()).map(move |k| Tile {
                stitch: Some(CHAIN),
                direction: tile.direction,
                base: Corners::default(),
                top: Corners::one(top[k]),
            })
        })
        .collect();
    base.tiles.splice(slit.tiles.clone(), chains);
    let segments = vec![
        Segment::Held { part: to, loops: slit.works },
        Segment::Surface { part: to, round: number, first: slit.made + 1, loops: slit.makes, back: true },
    ];
    program.pattern.parts.get_mut(part.0 as usize)?.start = Start::Join { segments };
    Some(())
}

/// The larger side of a stitch in mm.
fn stitch_size(program: &Program) -> f64 {
    program.gauge.as_ref().map_or(1.0, |gauge| gauge.width.max(gauge.height))
}

fn far(program: &Program, part: PartId, to: PartId, distance: f64, sink: &mut Sink<'_>) -> Option<()> {
    let name = |id: PartId| program.pattern.parts.get(id.0 as usize).map_or("?", |part| part.name.as_str());
    let message = if distance.is_finite() {
        format!("the stitches of {} next to {} are {distance:.1} mm away", name(to), name(part))
    } else {
        format!("{} has no run of stitches that {} could grow from", name(to), name(part))
    };
    sink.push(Diagnostic::new(Code::JoinMissesStitches, message).in_round(name(part), None).help(
        "use a smaller stitch, make the branch thinner where it begins, or move it away from ends and short rows; \
         `join = \"surface\"` asks for the least",
    ));
    None
}

/// A stitch that can be named: by its round and its place in it.
struct Named {
    round: u32,
    /// From 1.
    place: u32,
    position: DVec3,
}

/// The stitches of a part around a ring of points, the start chain left out.
fn named(part: &Part, graph: &Graph, rim: &[DVec3], reach: f64) -> Vec<Named> {
    let room = DVec3::splat(reach);
    let (low, high) = rim.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), point| {
        (low.min(*point), high.max(*point))
    });
    let (low, high) = (low - room, high + room);
    let leaves = Leaves::of(part, graph);
    let worked = matches!(part.start, Start::Ring { .. });
    let mut list = Vec::new();
    for (index, round) in leaves.rounds.iter().enumerate().skip(usize::from(!worked)) {
        let number = leaves.first.saturating_add(index as u32);
        for (place, node) in (1..).zip(round) {
            if let Some(node) = graph.nodes.get(*node as usize)
                && node.position.cmpge(low).all()
                && node.position.cmple(high).all()
            {
                list.push(Named { round: number, place, position: node.position });
            }
        }
    }
    list
}

/// Stretches of stitches side by side, in either direction.
fn segments(part: PartId, picked: &[(u32, u32)]) -> Vec<Segment> {
    let mut list = Vec::new();
    let mut rest = picked;
    while let Some((&(round, first), mut tail)) = rest.split_first() {
        let mut last = first;
        let mut step = None;
        while let Some((&(next_round, next), after)) = tail.split_first() {
            let this = i64::from(next) - i64::from(last);
            if next_round != round || this.abs() != 1 || step.is_some_and(|step| step != this) {
                break;
            }
            (step, last, tail) = (Some(this), next, after);
        }
        let (low, high) = (first.min(last), first.max(last));
        list.push(Segment::Surface { part, round, first: low, loops: high - low + 1, back: last < first });
        rest = tail;
    }
    list
}

/// A run of stitches in one row that chains can take the place of.
struct Slit {
    row: usize,
    /// Index of its first stitch among the steps of the row, and how many stitches there are.
    first: usize,
    count: usize,
    /// Its tiles.
    tiles: std::ops::Range<usize>,
    /// Loops it works, loops it makes, loops that the row makes before.
    works: u32,
    makes: u32,
    made: u32,
    /// From its middle to the middle of the branch, in mm.
    distance: f64,
}

/// The run of plain rounds nearest to a point whose stitches work and make so many loops together.
fn slit(part: &Part, graph: &Graph, loops: u32, middle: DVec3) -> Option<Slit> {
    let mut best: Option<Slit> = None;
    let mut tile = 0;
    for (row_index, row) in part.rows.iter().enumerate() {
        let steps: Vec<Step> = row.body.steps().collect();
        let tiles = steps.iter().filter(|step| matches!(step, Step::Work(_) | Step::Turn(_))).count();
        let begin = tile;
        tile += tiles;
        // Stitches only: a slit crosses no turn, and no loops that are held already.
        let stitches: Vec<Stitch> = steps
            .iter()
            .map_while(|step| match step {
                Step::Work(stitch) if stitch.works > 0 => Some(*stitch),
                Step::Work(_) | Step::Turn(_) | Step::Hold { .. } | Step::Leave { .. } | Step::Color(_) => {
                    None
                }
            })
            .collect();
        let rest = steps.get(stitches.len()..).unwrap_or_default();
        if row.times != 1 || !rest.iter().all(|step| matches!(step, Step::Leave { .. })) {
            continue;
        }
        let below: u32 = stitches.iter().map(|stitch| u32::from(stitch.works)).sum();
        let position = |id: &NodeId| graph.nodes.get(*id as usize).map(|node| node.position);
        // Sums of the places of bases and tops up to each stitch.
        let mut sums = vec![(DVec3::ZERO, 0_u32, 0_u32)];
        for (offset, stitch) in stitches.iter().enumerate() {
            let Some(tile) = graph.tiles.get(begin + offset) else { return best };
            let points = tile.base.iter().chain(tile.top.iter()).filter_map(position);
            let (sum, works, makes) = sums.last().copied().unwrap_or_default();
            sums.push((
                sum + points.sum::<DVec3>(),
                works + u32::from(stitch.works),
                makes + u32::from(stitch.makes),
            ));
        }
        let mut end = 0;
        for (first, (sum, works, makes)) in sums.iter().enumerate() {
            while end < sums.len() && sums[end].1 + sums[end].2 - works - makes < loops {
                end += 1;
            }
            let Some(after) = sums.get(end) else { break };
            let (held, chained) = (after.1 - works, after.2 - makes);
            if held + chained != loops || f64::from(held) > SLIT_SHARE * f64::from(below) {
                continue;
            }
            let distance = ((after.0 - sum) / f64::from(loops)).distance(middle);
            if best.as_ref().is_none_or(|best| distance < best.distance) {
                best = Some(Slit {
                    row: row_index,
                    first,
                    count: end - first,
                    tiles: begin + first..begin + end,
                    works: held,
                    makes: chained,
                    made: *makes,
                    distance,
                });
            }
        }
    }
    best
}

/// The row with a slit for another part.
fn opened(body: &Block, slit: &Slit, by: PartId) -> Block {
    let mut block = Block::default();
    let mut run: Option<(Stitch, u32)> = None;
    let flush = |run: &mut Option<(Stitch, u32)>, block: &mut Block| {
        if let Some((stitch, times)) = run.take() {
            block.push(Op::Work { stitch, times }, Span::NONE);
        }
    };
    for (index, step) in body.steps().enumerate() {
        if index == slit.first {
            flush(&mut run, &mut block);
            block.push(Op::Hold { loops: slit.works, by }, Span::NONE);
            block.push(Op::Work { stitch: CHAIN, times: slit.makes }, Span::NONE);
        }
        if (slit.first..slit.first + slit.count).contains(&index) {
            continue;
        }
        match (step, &mut run) {
            (Step::Work(stitch), Some((same, times))) if stitch == *same => *times += 1,
            (Step::Work(stitch), _) => {
                flush(&mut run, &mut block);
                run = Some((stitch, 1));
            }
            (Step::Leave { loops }, _) => {
                flush(&mut run, &mut block);
                block.push(Op::Leave { loops }, Span::NONE);
            }
            (Step::Turn(_) | Step::Hold { .. } | Step::Color(_), _) => {}
        }
    }
    flush(&mut run, &mut block);
    block
}
