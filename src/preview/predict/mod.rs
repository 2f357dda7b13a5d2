//! The shape that a pattern will really take, from the pattern alone: no surface is looked at.
//!
//! Loops are joined by springs of the stitch's width and height, the fabric resists bending, and stuffing presses on
//! it. The start stacks the rounds as rigid rings, each tilted by what its short rows lift; from there a quasi-Newton
//! method with one factored matrix goes to rest.

mod compare;
mod envelope;
mod solve;
mod start;
mod system;

use super::net::{NONE, Net, nets};
use super::scene::{MAX_STITCHES, Refused};
use crate::diag::Sink;
use crate::ir::Graph;
use crate::ir::verify::Verified;
use glam::DVec3;
use system::System;

pub use compare::Fit;

/// How far a prediction came to rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rest {
    /// Root mean square of the forces left, where 1 stretches a stitch by its own height.
    pub residual: f64,
    /// Mean absolute strain of the stitches, as a fraction.
    pub strain: f64,
    /// Steps taken.
    pub steps: u32,
    /// The forces left are too small to matter.
    pub converged: bool,
}

/// Predicts the shape of a program from its pattern and compares it with the places in its graphs. `None` when there
/// are none.
pub fn fit(program: &Verified<'_>, gauge: [f64; 2], sink: &Sink<'_>) -> Result<Option<Fit>, Refused> {
    if program.graphs.is_empty() {
        return Ok(None);
    }
    if program.maker.lean != 0.0 {
        return Err(Refused::Leans);
    }
    let nets = nets(program, MAX_STITCHES);
    let (places, rest) = places(&nets, gauge, sink)?;
    let target: Vec<Vec<DVec3>> =
        program.graphs.iter().map(|graph| positions(&graph.right_handed(program.maker.hand))).collect();
    Ok(compare::fit(&nets, &places, &target, gauge[1], rest))
}

fn positions(graph: &Graph) -> Vec<DVec3> {
    graph.nodes.iter().map(|node| node.position).collect()
}

/// Predicted places of the loops of every piece.
pub(super) fn places(
    nets: &[Net],
    gauge: [f64; 2],
    sink: &Sink<'_>,
) -> Result<(Vec<Vec<DVec3>>, Rest), Refused> {
    let numbers = Numbers::new(nets);
    let mut x = vec![DVec3::ZERO; numbers.count];
    start::place(nets, &numbers, gauge, &mut x);
    // Lengths in stitch heights, so that forces are plain numbers.
    let scale = gauge[1];
    for place in &mut x {
        *place /= scale;
    }
    let system = System::new(nets, &numbers, gauge[0] / scale);
    let rest = solve::relax(&system, &mut x, sink)?;
    for place in &mut x {
        *place *= scale;
    }
    numbers.arrange(nets, gauge[0], &mut x);
    let places = numbers.ids.iter().map(|ids| ids.iter().map(|id| x[*id as usize]).collect()).collect();
    Ok((places, rest))
}

/// The numbers of all loops and poles in one row; loops that pieces share have one number.
pub(super) struct Numbers {
    /// For each piece and loop.
    ids: Vec<Vec<u32>>,
    /// For each piece the pole of its magic ring and the one where it is drawn shut.
    poles: Vec<[Option<u32>; 2]>,
    count: usize,
}

impl Numbers {
    fn new(nets: &[Net]) -> Self {
        let mut numbers = Self { ids: Vec::new(), poles: Vec::new(), count: 0 };
        let mut fresh = || {
            numbers.count += 1;
            numbers.count as u32 - 1
        };
        for net in nets {
            let start = net.has_ring().then(&mut fresh);
            let mut ids: Vec<u32> = Vec::with_capacity(net.loops as usize);
            for id in 0..net.loops as usize {
                let shared = net.shared.get(id).copied().flatten();
                let known = shared
                    .and_then(|(piece, other)| numbers.ids.get(piece as usize)?.get(other as usize).copied());
                ids.push(known.unwrap_or_else(&mut fresh));
            }
            let end = net.is_shut().then(&mut fresh);
            numbers.ids.push(ids);
            numbers.poles.push([start, end]);
        }
        numbers
    }

    /// For each number the first piece that it hangs together with.
    fn owners(&self, nets: &[Net]) -> Vec<usize> {
        let mut group: Vec<usize> = (0..nets.len()).collect();
        for (piece, net) in nets.iter().enumerate() {
            for (other, _) in net.shared.iter().flatten() {
                let (a, b) = (group[piece], group.get(*other as usize).copied().unwrap_or(piece));
                let (low, high) = (a.min(b), a.max(b));
                group.iter_mut().filter(|of| **of == high).for_each(|of| *of = low);
            }
        }
        let mut owner = vec![usize::MAX; self.count];
        for (piece, ids) in self.ids.iter().enumerate() {
            let poles = self.poles[piece].iter().flatten();
            for id in ids.iter().chain(poles) {
                owner[*id as usize] = group[piece];
            }
        }
        owner
    }

    /// Sets pieces that hang together beside the others, on the ground.
    fn arrange(&self, nets: &[Net], width: f64, x: &mut [DVec3]) {
        let owner = self.owners(nets);
        let mut right = None;
        for of in 0..nets.len() {
            let members = || (0..x.len()).filter(|id| owner[*id] == of);
            let ends = members().fold(None, |ends: Option<[DVec3; 2]>, id| {
                let [low, high] = ends.unwrap_or([x[id]; 2]);
                Some([low.min(x[id]), high.max(x[id])])
            });
            let Some([low, high]) = ends else { continue };
            let to = right.map_or(0.5 * (low.x - high.x), |right: f64| right + 2.0 * width);
            right = Some(to + high.x - low.x);
            let shift = DVec3::new(to - low.x, -0.5 * (low.y + high.y), -low.z);
            for (place, _) in x.iter_mut().zip(&owner).filter(|(_, owner)| **owner == of) {
                *place += shift;
            }
        }
    }

    fn id(&self, piece: usize, id: u32) -> Option<u32> {
        if id == NONE { None } else { self.ids.get(piece)?.get(id as usize).copied() }
    }
}
