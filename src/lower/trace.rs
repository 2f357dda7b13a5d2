//! From a stitch graph to the rows of a part, along the yarn.

use crate::diag::Span;
use crate::ir::{Block, Direction, Finish, Graph, Op, Part, Row, Start, Step, Stitch, Tile};
use std::ops::Range;

/// Writes down what the hook does in a graph, stitch by stitch, cut into rounds. Runs of equal stitches are counted,
/// nothing else is folded.
///
/// The marker of a round sits on its first loop; when a stitch is worked into that loop, the marker moves up to the
/// stitch's first top. In numbers: a round of n loops ends when its forward stitches have worked n loops and those that
/// its back passes made. Two things cannot be worked in such a round: a short row that goes back over the marker, and a
/// decrease of the last loop with the marked one. There the round before ends some loops early, with [`Op::Leave`], and
/// the marker moves back. The last round ends with `Leave` too when the yarn ends before its marker.
pub fn trace(name: &str, graph: &Graph, finish: Finish) -> Part {
    let loops = graph.start;
    let start =
        if graph.pole.is_some() { Start::Ring { loops } } else { Start::Chain { loops, joined: true } };
    let rows = rounds(&graph.tiles, u64::from(loops));
    Part {
        name: name.to_owned(),
        start,
        rows: rows.into_iter().map(|round| Row::new(block(&graph.tiles, &round))).collect(),
        finish,
        flat: false,
        copies: 1,
    }
}

/// A round: its tiles, and the loops at its start and end.
#[derive(Clone, Debug)]
struct Round {
    tiles: Range<usize>,
    /// Loops ahead at its start.
    below: u64,
    /// Loops ahead at its end.
    left: u64,
    /// Loops it made.
    made: u64,
}

/// How far a walk over a round came.
enum Walk {
    /// To its end.
    Done(Round),
    /// To a turn at this tile, whose back pass goes over more loops than are behind.
    TooFarBack(usize, u64),
}

fn rounds(tiles: &[Tile], start: u64) -> Vec<Round> {
    let mut rounds: Vec<Round> = Vec::new();
    let (mut first, mut below) = (0, start);
    while first < tiles.len() {
        match walk(tiles, first, below, true) {
            Walk::Done(round) => {
                (first, below) = (round.tiles.end, round.left + round.made);
                rounds.push(round);
            }
            Walk::TooFarBack(turn, reach) => {
                let earlier = rounds.last().and_then(|before| earlier_end(tiles, before, turn, reach));
                if let (Some(end), Some(before)) = (earlier, rounds.last_mut()) {
                    *before = cut(tiles, before, end);
                    (first, below) = (end, before.left + before.made);
                } else if let Walk::Done(round) = walk(tiles, first, below, false) {
                    // No cut helps: the verifier will say so.
                    (first, below) = (round.tiles.end, round.left + round.made);
                    rounds.push(round);
                }
            }
        }
    }
    rounds
}

/// Walks one round from its first tile.
fn walk(tiles: &[Tile], first: usize, below: u64, strict: bool) -> Walk {
    let (mut ahead, mut behind) = (below, 0_u64);
    let mut back = false;
    let mut end = tiles.len();
    for (index, tile) in tiles.iter().enumerate().skip(first) {
        match tile.stitch {
            None => {
                back = tile.direction == Direction::Back;
                let reach = if back && strict { pass(tiles, index + 1) } else { 0 };
                if reach > behind {
                    return Walk::TooFarBack(index, reach);
                }
            }
            Some(stitch) if back => {
                behind = behind.saturating_sub(stitch.works.into());
                ahead += u64::from(stitch.makes);
            }
            Some(stitch) => {
                // Nothing ahead ends the round; one loop for a decrease of two ends it early.
                if index > first && (ahead == 0 || ahead < stitch.works.into()) {
                    end = index;
                    break;
                }
                ahead = ahead.saturating_sub(stitch.works.into());
                behind += u64::from(stitch.makes);
            }
        }
    }
    Walk::Done(Round { tiles: first..end, below, left: ahead, made: behind })
}

/// Loops that the back pass after a turn works.
fn pass(tiles: &[Tile], first: usize) -> u64 {
    tiles.iter().skip(first).map_while(|tile| tile.stitch).map(|stitch| u64::from(stitch.works)).sum()
}

/// The last tile of the round before at which that round can end so that the back pass after `turn` finds its loops.
fn earlier_end(tiles: &[Tile], before: &Round, turn: usize, reach: u64) -> Option<usize> {
    let mut behind = 0_i64;
    let mut back = false;
    for index in (before.tiles.start + 1..turn).rev() {
        let Tile { stitch, direction, .. } = tiles[index];
        match stitch {
            None => back = direction == Direction::Forward,
            Some(stitch) if back => behind -= i64::from(stitch.works),
            Some(stitch) => behind += i64::from(stitch.makes),
        }
        let starts_forward = !back && stitch.is_some();
        if index < before.tiles.end && starts_forward && behind >= reach as i64 {
            return Some(index);
        }
    }
    None
}

/// The round, ended early.
fn cut(tiles: &[Tile], round: &Round, end: usize) -> Round {
    let Range { start, .. } = round.tiles;
    match walk(&tiles[..end], start, round.below, false) {
        Walk::Done(cut) => cut,
        Walk::TooFarBack(..) => round.clone(),
    }
}

fn block(tiles: &[Tile], round: &Round) -> Block {
    let mut block = Block::default();
    let mut run: Option<(Stitch, u32)> = None;
    let mut flush = |run: &mut Option<(Stitch, u32)>, next: Option<Step>| {
        if let Some((stitch, times)) = run.take() {
            block.push(Op::Work { stitch, times }, Span::NONE);
        }
        match next {
            Some(Step::Turn(direction)) => block.push(Op::Turn(direction), Span::NONE),
            Some(Step::Leave { loops }) => block.push(Op::Leave { loops }, Span::NONE),
            _ => {}
        }
    };
    for tile in tiles.get(round.tiles.clone()).unwrap_or_default() {
        match (tile.stitch, &mut run) {
            (Some(stitch), Some((same, times))) if stitch == *same => *times += 1,
            (Some(stitch), _) => {
                flush(&mut run, None);
                run = Some((stitch, 1));
            }
            (None, _) => flush(&mut run, Some(Step::Turn(tile.direction))),
        }
    }
    let left = (round.left > 0).then_some(Step::Leave { loops: round.left.min(u32::MAX.into()) as u32 });
    flush(&mut run, left);
    block
}
