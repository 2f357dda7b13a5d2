//! From a mesh to tubes: ends, field, limbs, and a stack of level lines for each limb.

use super::ends::{Ends, Tip};
use super::levels::Levels;
use super::tree::{Limb, Tree};
use super::way::Way;
use super::{Fault, Field, Mesh};
use crate::ir::Gauge;
use crate::shape::ring::Ring;
use crate::shape::stack::Stack;
use glam::DVec3;

/// Shortest limb, in rows.
const LEAST_ROWS: f64 = 3.0;
/// Shortest stretch between two forks, in rows; below it the forks are one.
const LEAST_TRUNK: f64 = 2.5;
/// Level lines beside a fork are this share of the field's range away from it.
const ASIDE: f64 = 1e-7;
/// The ring nearest to a pole lies this far from it, in row heights.
const FIRST_RING: f64 = 0.4;
/// Samples to a stitch width around.
const SAMPLES_A_STITCH: f64 = 1.5;

/// How a mesh is cut into tubes; lengths are those of the mesh, millimeters by now.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Stitch size.
    pub gauge: Gauge,
    /// Where the rows come from.
    pub field: Field,
    /// The first end, where one is named.
    pub start: Option<DVec3>,
    /// The other ends, where they are named; else they are found.
    pub poles: Vec<DVec3>,
    /// A point at which rounds begin.
    pub seam: Option<DVec3>,
}

/// One tube of a mesh.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Its name.
    pub name: String,
    /// Its surface.
    pub stack: Stack,
    /// The piece that it grows out of, by index; it shares the last loop of that piece with its siblings.
    pub parent: Option<usize>,
}

/// What became of a mesh.
#[derive(Clone, Debug)]
pub struct Cut {
    /// The tubes, each behind the one that it grows from.
    pub pieces: Vec<Piece>,
    /// The start, and the other ends; with whether it is an opening.
    pub ends: Vec<(DVec3, bool)>,
    /// Limbs too short to be made, by their tips.
    pub dropped: Vec<DVec3>,
}

impl Mesh {
    /// Cuts the mesh into tubes.
    pub fn cut(&self, plan: &Plan) -> Result<Cut, Fault> {
        self.holes(plan)?;
        let row = plan.gauge.height;
        let mut ends = Ends::find(self, row, plan.start, &plan.poles);
        if ends.others.is_empty() {
            return Err(Fault::NoEnds { at: self.middle(&ends.start) });
        }
        let mut dropped = Vec::new();
        let (field, tree, ways) = loop {
            let field = self.flow(plan, &mut ends);
            let tree = self.tree(&field, &ends).ok_or(Fault::NoEnds { at: self.middle(&ends.start) })?;
            let ways: Vec<Way> = ends.others.iter().map(|tip| self.way(tip, &ends.start, &field)).collect();
            match short(&tree, &ends, &ways, row) {
                Some(leaf) if plan.poles.is_empty() && ends.others.len() > 1 => {
                    dropped.push(self.middle(&ends.others[leaf]));
                    ends.others.remove(leaf);
                }
                _ => break (field, tree, ways),
            }
        };
        let tree = merge_forks(tree, &ways, LEAST_TRUNK * row);
        let mut pieces = Vec::new();
        self.pieces(&tree, &field, &ends, &ways, plan, &mut pieces)?;
        let mut all = vec![(self.middle(&ends.start), ends.start.open)];
        all.extend(ends.others.iter().map(|tip| (self.middle(tip), tip.open)));
        Ok(Cut { pieces, ends: all, dropped })
    }

    /// The field, with every closed end at its extremum. The farthest point of a bent limb lies on its inner side, so
    /// the flow is poured a second time around where the first one says that the middle is.
    fn flow(&self, plan: &Plan, ends: &mut Ends) -> Vec<f64> {
        let before = ends.clone();
        let field = self.field(plan.field, ends);
        self.climb(&field, ends);
        let far = |a: &Tip, b: &Tip| self.middle(a).distance(self.middle(b)) > 0.5 * plan.gauge.height;
        let moved =
            far(&before.start, &ends.start) || before.others.iter().zip(&ends.others).any(|(a, b)| far(a, b));
        if !moved {
            return field;
        }
        let field = self.field(plan.field, ends);
        self.climb(&field, ends);
        field
    }

    fn middle(&self, tip: &Tip) -> DVec3 {
        match tip.ring.as_slice() {
            [vertex] => self.point(*vertex),
            ring => self.center(ring),
        }
    }

    /// Stacks the level lines of every limb, trunk first.
    fn pieces(
        &self,
        tree: &Tree,
        field: &[f64],
        ends: &Ends,
        ways: &[Way],
        plan: &Plan,
        pieces: &mut Vec<Piece>,
    ) -> Result<(), Fault> {
        let levels = Levels { mesh: self, field };
        let field_at = |v: u32| field[v as usize];
        let row = plan.gauge.height;
        let spacing = row.max(0.4 * self.mean_edge());
        let range = tree.limbs.iter().map(|limb| limb.high).fold(0.0, f64::max);
        // Depth first: the limb that goes on, then what branches off.
        let mut open = vec![(tree.root, None, "trunk".to_owned())];
        let mut letters = ('A'..='Z').chain('a'..='z');
        while let Some((index, parent, name)) = open.pop() {
            let limb = &tree.limbs[index];
            let tip = &ends.others[limb.leaf];
            let (mut low, mut high) = (limb.low, limb.high);
            let (mut first, mut last) = (None, None);
            let mut poles = [None; 2];
            if index == tree.root {
                if ends.start.open {
                    first = self.opening(&ends.start.ring, false);
                } else {
                    poles[0] = Some(self.middle(&ends.start));
                    low = ways[limb.leaf].level(&field_at, FIRST_RING * row, false);
                }
            } else {
                low += ASIDE * range;
            }
            if !limb.last {
                high -= ASIDE * range;
            } else if tip.open {
                last = self.opening(&tip.ring, true);
            } else {
                poles[1] = Some(self.middle(tip));
                high = ways[limb.leaf].level(&field_at, FIRST_RING * row, true);
            }
            let mut rings =
                levels.stack([low, high], &ways[limb.leaf].vertices, spacing, first, last.as_ref());
            if let (None, Some(seam), Some(ring)) = (parent, plan.seam, rings.first_mut()) {
                *ring = ring.begun_near(seam);
            }
            let most = rings.iter().map(Ring::length).fold(0.0, f64::max);
            let around = (SAMPLES_A_STITCH * most / plan.gauge.width).clamp(48.0, 256.0) as usize;
            let stack = Stack::new(&rings, poles, around.next_multiple_of(16));
            let Some(mut stack) = stack else {
                return Err(Fault::NoRows { at: self.middle(tip) });
            };
            stack.revolve(plan.gauge.width);
            let here = pieces.len();
            let end = rings.last().cloned();
            pieces.push(Piece { name: name.clone(), stack, parent });
            // The child that is most like the end of this limb goes on under its name.
            let mut children: Vec<(usize, f64)> = limb
                .children
                .iter()
                .map(|&child| {
                    let way = &ways[tree.limbs[child].leaf].vertices;
                    let ring = levels.line(tree.limbs[child].low + ASIDE * range, way);
                    (child, ring.zip(end.as_ref()).map_or(0.0, |(ring, _)| ring.length()))
                })
                .collect();
            children.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
            let mut next: Vec<(usize, Option<usize>, String)> = Vec::new();
            for (rank, (child, _)) in children.iter().enumerate() {
                let name = if rank == 0 {
                    continued(&name)
                } else {
                    letters.next().map_or_else(|| format!("limb {child}"), |letter| format!("limb {letter}"))
                };
                next.push((*child, Some(here), name));
            }
            open.extend(next.into_iter().rev());
        }
        Ok(())
    }

    /// An open edge as the first (or last) loop: clockwise seen from the end of the tube.
    pub(super) fn opening(&self, ring: &[u32], last: bool) -> Option<Ring> {
        let points: Vec<DVec3> = ring.iter().map(|v| self.point(*v)).collect();
        let ring = Ring::new(points)?;
        // The surface lies on the left of an open edge; it shall lie on the right at the start.
        Some(if last { ring } else { ring.reversed() })
    }
}

/// "trunk", "trunk 2", "trunk 3".
fn continued(name: &str) -> String {
    match name.rsplit_once(' ').and_then(|(stem, number)| Some((stem, number.parse::<u32>().ok()?))) {
        Some((stem, number)) => format!("{stem} {}", number + 1),
        None => format!("{name} 2"),
    }
}

/// The end of a closed limb that is too short to be made.
fn short(tree: &Tree, ends: &Ends, ways: &[Way], row: f64) -> Option<usize> {
    let limbs = tree.limbs.iter().enumerate();
    let closed = limbs.filter(|(i, limb)| *i != tree.root && limb.last && !ends.others[limb.leaf].open);
    let length = |limb: &Limb| ways[limb.leaf].length(limb.low, limb.high);
    let shortest = closed.map(|(_, limb)| (length(limb), limb.leaf)).min_by(|a, b| a.0.total_cmp(&b.0))?;
    (shortest.0 < LEAST_ROWS * row).then_some(shortest.1)
}

/// Joins forks that lie so close that no rows fit between them.
fn merge_forks(mut tree: Tree, ways: &[Way], least: f64) -> Tree {
    let mut order = vec![tree.root];
    let mut at = 0;
    while let Some(&index) = order.get(at) {
        // Children that are too short give their own children to this limb, which ends lower than they fork.
        loop {
            let thin = |limb: &Limb| !limb.last && ways[limb.leaf].length(limb.low, limb.high) < least;
            let Some(place) = tree.limbs[index].children.iter().position(|c| thin(&tree.limbs[*c])) else {
                break;
            };
            let child = tree.limbs[index].children.remove(place);
            let grand = std::mem::take(&mut tree.limbs[child].children);
            tree.limbs[index].children.extend(grand);
        }
        order.extend(tree.limbs[index].children.iter().copied());
        at += 1;
    }
    tree
}
