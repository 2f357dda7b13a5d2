//! From a mesh to tubes: ends, field, limbs, and a stack of level lines for each limb.

use super::divide::Division;
use super::ends::{Ends, Tip};
use super::field::Flows;
use super::flat::Course;
use super::levels::Levels;
use super::limb::{self, Root};
use super::tree::{Limb, Tree};
use super::way::Way;
use super::{Fault, Field, Mesh};
use crate::ir::Gauge;
use crate::shape::branch::Branch;
use crate::shape::measure::area_of;
use crate::shape::ring::Ring;
use crate::shape::solid::Solid;
use crate::shape::stack::Stack;
use crate::shape::{Attachment, End, Joint, ParametricSurface, Reversed, is_revolution};
use glam::DVec3;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Shortest limb, in rows.
const LEAST_ROWS: f64 = 3.0;
/// Shortest stretch between two forks, in rows; below it the forks are one.
const LEAST_TRUNK: f64 = 2.5;
/// Level lines beside a fork are this share of the field's range away from it.
pub(super) const ASIDE: f64 = 1e-7;
/// The ring nearest to a pole lies this far from it, in row heights.
pub(super) const FIRST_RING: f64 = 0.4;
/// Samples to a stitch width around.
const SAMPLES_A_STITCH: f64 = 1.5;

/// Limbs that are thinner than this against a body are no continuation of it.
const THINNER: f64 = 0.6;
/// Shortest body against its girth.
const LEAST_BODY: f64 = 0.15;
/// Limbs between which a body ends lie apart by more than this share of their width, from middle to middle.
const APART: f64 = 1.5;
/// Lines that lie farther apart than this, in their spacing, are no neighbors.
const LEAP: f64 = 3.0;
/// Tubes that are larger than this against their mesh do not run along it; and the samples by which that is seen.
const MOST_AREA: f64 = 1.25;
const SAMPLES: [u32; 2] = [8, 16];
/// A limb is clear of the surface that it grows from where it lies this far (stitches) from it.
const LEAVES: f64 = 1.0;
/// How far (stitches) the first row of a limb may lie off the rim in which it meets its parent.
const GIVE: f64 = 1.0;

/// Most openings of a mesh that is cut while faulty ones are sought.
const FEW_OPENINGS: usize = 8;

/// Closed ends that lie farther from their axis than this (rows) are moved to it.
const OFF: f64 = 0.5;
/// How often flows are poured again at most.
const POURS: u32 = 2;

/// Meshes of more triangles than this are made coarser where their edges are shorter than this share of a stitch; tubes that are
/// neither round nor have limbs to about as many triangles at least. It is worth it where edges are shorter than so on average.
const MANY: usize = 20_000;
const COARSE: f64 = 0.8;
const FINER: f64 = 0.7;

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
#[derive(Debug)]
pub struct Piece {
    /// Its name.
    pub name: String,
    /// Its surface.
    pub surface: Box<dyn ParametricSurface>,
    /// How its ends are closed.
    pub ends: [End; 2],
    /// The piece that it grows out of, by index, and how.
    pub attachment: Option<Attachment>,
    /// Whether its level lines follow each other without a leap.
    pub(super) even: bool,
}

/// What became of a mesh.
#[derive(Debug)]
pub struct Cut {
    /// The tubes, each behind the one that it grows from.
    pub pieces: Vec<Piece>,
    /// The start, and the other ends; with whether it is an opening.
    pub ends: Vec<(DVec3, bool)>,
    /// Limbs too short to be made, by their tips.
    pub dropped: Vec<DVec3>,
}

/// What is to be done with a mesh.
enum Next {
    /// It begins elsewhere, or has one more end.
    Ends,
    /// The limbs at these ends are cut off, in this order; and the end to which the surface goes on.
    Limbs(Vec<(usize, Root)>, Option<usize>),
    /// It falls into these pieces; none where limbs are to be cut off before.
    Pieces(Vec<Piece>),
}

/// A limb to be stacked, the piece that divides into it with the line that it begins with, and its name.
type Waiting = (usize, Option<(usize, Ring)>, String);

impl Mesh {
    /// Cuts the mesh into tubes. `progress` hears of steps done and of all there are, as far as they are known.
    pub fn cut(&self, plan: &Plan, mut progress: impl FnMut(u64, u64)) -> Result<Cut, Fault> {
        // On a large mesh, or with an end for each of many openings, what is in vain would cost more than the search.
        if self.boundaries.len() > FEW_OPENINGS || self.faces.len() > MANY {
            self.holes(plan)?;
            return self.cut_coarse(plan, &mut progress);
        }
        // Most often there is no fault, so the rest does not wait for the search: that begins when what all else waits for is there,
        // beside what one thread does.
        let mut holes = None;
        let cut = rayon::in_place_scope(|scope| {
            let mut place = Some(&mut holes);
            let mut progress = |done, all| {
                if (done > 0 || all == 1)
                    && let Some(place) = place.take()
                {
                    scope.spawn(|_| *place = Some(self.holes(plan)));
                }
                progress(done, all);
            };
            self.cut_coarse(plan, &mut progress)
        });
        holes.unwrap_or_else(|| self.holes(plan))?;
        cut
    }

    /// Cuts the mesh, or a coarser one where it is finer than its stitches need.
    fn cut_coarse(&self, plan: &Plan, progress: &mut impl FnMut(u64, u64)) -> Result<Cut, Fault> {
        let length = COARSE * plan.gauge.height.min(plan.gauge.width);
        let edge = if self.faces.len() > MANY { self.mean_edge() } else { f64::INFINITY };
        if edge >= FINER * length {
            return self.cut_whole(self, plan, progress);
        }
        // The first half is the way to fewer triangles.
        let Some(coarse) = self.coarse(length, |done, all| progress(done, 2 * all)) else {
            return self.cut_whole(self, plan, progress);
        };
        let cut = coarse.cut_whole(self, plan, |done, all| progress(all + done, 2 * all))?;
        let bent =
            |cut: &Cut| cut.pieces.len() == 1 && cut.pieces.iter().all(|it| !is_revolution(&*it.surface));
        let enough = edge * (self.faces.len() as f64 / MANY as f64).sqrt();
        if !bent(&cut) || enough >= length {
            return Ok(cut);
        }
        // On few triangles, which are uneven by now, lines lean here and there, and rounds come out another way.
        let finer = if edge < FINER * enough { self.coarse(enough, |_, _| ()) } else { None };
        let finer = finer.as_ref().unwrap_or(self).cut_whole(self, plan, |_, _| ());
        Ok(finer.ok().filter(bent).unwrap_or(cut))
    }

    /// Cuts this mesh, which is the given one or a coarser one of the same surface.
    fn cut_whole(&self, given: &Self, plan: &Plan, mut progress: impl FnMut(u64, u64)) -> Result<Cut, Fault> {
        // The true field lies best; on bad triangles it has eddies in which limbs are lost.
        let sound = |cut: &Cut| {
            let [steps, samples] = SAMPLES;
            let parts = cut.pieces.par_iter().flat_map(|piece| {
                (0..steps).into_par_iter().map(|part| area_of(&*piece.surface, part, steps, samples))
            });
            // Where only one tube can be laid, a leap in it is better than none.
            let even = cut.pieces.len() == 1 || cut.pieces.iter().all(|piece| piece.even);
            // Summed in order: for any number of threads the same.
            even && parts.collect::<Vec<f64>>().iter().sum::<f64>() < MOST_AREA * self.area()
        };
        let fault = match self.cut_along(given, plan, false, &mut progress) {
            Ok(cut) if sound(&cut) && cut.pieces.iter().all(|piece| piece.even) => return Ok(cut),
            Ok(cut) => Fault::Fork { at: cut.ends.last().map_or(DVec3::ZERO, |end| end.0) },
            Err(fault) => fault,
        };
        self.cut_along(given, plan, true, &mut progress).ok().filter(sound).ok_or(fault)
    }

    fn cut_along(
        &self,
        given: &Self,
        plan: &Plan,
        strict: bool,
        progress: &mut impl FnMut(u64, u64),
    ) -> Result<Cut, Fault> {
        let row = plan.gauge.height;
        let find = || Ends::find(self, row, plan.start, &plan.poles);
        let (mut ends, flows) = rayon::join(find, || Flows::new(self, strict));
        let mut flows = Some(flows);
        ends.strict = strict;
        if ends.others.is_empty() {
            return Err(Fault::NoEnds { at: self.middle(&ends.start) });
        }
        let mut all = vec![(self.middle(&ends.start), ends.start.open)];
        let mut dropped = Vec::new();
        let mut limbs = Vec::new();
        let mut rest: Option<Self> = None;
        let pieces = loop {
            let mesh = rest.as_ref().unwrap_or(self);
            let mut flows = flows.take().unwrap_or_else(|| Flows::new(mesh, strict));
            // Limbs that are to be cut off stay on the mesh for now.
            let mut off: Vec<Root> = Vec::new();
            let pieces = loop {
                let done = (limbs.len() + off.len()) as u64;
                progress(done, done + ends.others.len() as u64);
                match mesh.next((given, plan), &mut flows, &mut ends, &mut dropped)? {
                    Next::Ends => {}
                    Next::Limbs(roots, goes_on) => {
                        let leaves: Vec<usize> = roots.iter().map(|(leaf, _)| *leaf).collect();
                        ends.set_off(&leaves, goes_on);
                        off.extend(roots.into_iter().map(|(_, root)| root));
                    }
                    Next::Pieces(pieces) => break pieces,
                }
            };
            if off.is_empty() {
                all[0] = (mesh.middle(&ends.start), ends.start.open);
                all.extend(ends.others.iter().map(|tip| (mesh.middle(tip), tip.open)));
                break pieces;
            }
            all.extend(ends.off.iter().map(|tip| (mesh.middle(tip), tip.open)));
            let (smaller, fewer) = mesh.without(ends, off, plan, &mut limbs)?;
            (rest, ends) = (Some(smaller), fewer);
        };
        // What is made side by side there is handed over more quickly from within.
        let mut pieces = rayon::scope(|_| grow(pieces, limbs, plan))?;
        if plan.start.is_none() && plan.poles.is_empty() {
            let turned;
            (pieces, turned) = from_its_pole(pieces);
            if turned {
                all.reverse();
            }
        }
        Ok(Cut { pieces, ends: all, dropped })
    }

    /// What is to be done with a mesh: some limbs are cut off, or it is stacked as it is.
    fn next(
        &self,
        (given, plan): (&Self, &Plan),
        flows: &mut Flows<'_>,
        ends: &mut Ends,
        dropped: &mut Vec<DVec3>,
    ) -> Result<Next, Fault> {
        let row = plan.gauge.height;
        let (field, tree, ways) = loop {
            let field = self.flow(plan, flows, ends);
            let tree = self.tree(&field, ends).ok_or(Fault::NoEnds { at: self.middle(&ends.start) })?;
            let ways: Vec<Way> =
                ends.others.iter().map(|tip| self.way(tip, &ends.start.ring, &field)).collect();
            match short(&tree, ends, &ways, row) {
                Some(leaf) if plan.poles.is_empty() && ends.others.len() > 1 => {
                    dropped.push(self.middle(&ends.others[leaf]));
                    ends.others.remove(leaf);
                }
                _ => break (field, tree, ways),
            }
        };
        let tree = merge_forks(tree, &ways, LEAST_TRUNK * row);
        let levels = Levels { mesh: self, field: &field };
        let divides = |i: usize| Some((i, levels.division(&tree, tree.limbs.get(i)?, &ways, plan.gauge)?));
        let divisions: BTreeMap<usize, Division> = tree.forks().filter_map(divides).collect();
        let all_divide = tree.forks().all(|i| divisions.contains_key(&i));
        let mut last: Vec<usize> = tree.forks().filter(|i| tree.is_last_fork(&tree.limbs[*i])).collect();
        // What divides is cut up only where it hangs on something that does not.
        last.sort_by_key(|i| (divisions.contains_key(i), *i));
        let Some(fork) = last.first().filter(|_| !all_divide).map(|i| &tree.limbs[*i]) else {
            if !ends.off.is_empty() {
                return Ok(Next::Pieces(Vec::new()));
            }
            let pieces = self.pieces(&tree, &field, ends, &ways, (given, plan, &divisions))?;
            return Ok(pieces.map_or(Next::Ends, Next::Pieces));
        };
        let (before, girth) = levels.course(fork, &ways, false);
        let leaves: Vec<usize> = fork.children.iter().map(|child| tree.limbs[*child].leaf).collect();
        let mut roots = self.roots(flows, ends, &leaves, (before, row))?;
        // A body between limbs that are all thinner ends in its own right, and so it begins.
        let between = |leaf: usize| ends.others.get(leaf).is_some_and(|tip| tip.between);
        let middle = |roots: &[(usize, Root)]| {
            roots.iter().map(|(_, root)| root.middle).sum::<DVec3>() / roots.len().max(1) as f64
        };
        let length = ways[fork.leaf].length(fork.low, fork.high);
        if length > LEAST_BODY * girth
            && !roots.iter().any(|(leaf, _)| between(*leaf))
            && roots.iter().all(|(_, root)| root.girth < THINNER * girth)
            && far_apart(&roots.iter().map(|(_, root)| (root.middle, root.girth)).collect::<Vec<_>>())
            && ends.add_between(self, middle(&roots), false, row).is_some()
        {
            return Ok(Next::Ends);
        }
        let goes_on = roots.pop().map(|(leaf, _)| leaf);
        let found = plan.start.is_none() && !ends.start.open && !ends.start.between;
        let on = fork.children.iter().find(|child| Some(tree.limbs[**child].leaf) == goes_on);
        if let (true, true, Some(on)) = (found, std::ptr::eq(fork, &raw const tree.limbs[tree.root]), on) {
            let (_, body) = levels.course(&tree.limbs[*on], &ways, true);
            let (own, thin) = levels.neck(fork, &ways);
            let mut places: Vec<(DVec3, f64)> =
                roots.iter().map(|(_, root)| (root.middle, root.girth)).collect();
            places.push((own, thin));
            let first = places.iter().map(|place| place.0).sum::<DVec3>() / places.len() as f64;
            if thin < THINNER * body
                && far_apart(&places)
                && ends.add_between(self, first, true, row).is_some()
            {
                return Ok(Next::Ends);
            }
        }
        Ok(Next::Limbs(roots, goes_on))
    }

    /// The field, with every closed end at its extremum. The farthest point of a limb lies to one side of its end, so the
    /// flow is poured again around where the first one says that the middle is.
    fn flow(&self, plan: &Plan, flows: &mut Flows<'_>, ends: &mut Ends) -> Vec<f64> {
        let mut field = flows.field(plan.field, ends);
        let found = free(plan);
        for _ in 0..POURS {
            self.climb(&field, ends);
            let may = plan.field == Field::Harmonic && ends.aims == 0;
            if !may || !self.centered(&field, ends, found, OFF * plan.gauge.height) {
                return field;
            }
            field = flows.field(plan.field, ends);
        }
        self.climb(&field, ends);
        field
    }

    pub(super) fn middle(&self, tip: &Tip) -> DVec3 {
        match tip.ring.as_slice() {
            [vertex] => self.point(*vertex),
            ring => self.center(ring),
        }
    }

    /// Stacks the level lines of every limb, trunk first; `None` where its ends have been moved.
    fn pieces(
        &self,
        tree: &Tree,
        field: &[f64],
        ends: &mut Ends,
        ways: &[Way],
        (given, plan, divisions): (&Self, &Plan, &BTreeMap<usize, Division>),
    ) -> Result<Option<Vec<Piece>>, Fault> {
        let mut pieces: Vec<Piece> = Vec::new();
        let levels = Levels { mesh: self, field };
        let field_at = |v: u32| field[v as usize];
        let row = plan.gauge.height;
        let spacing = row.max(0.4 * self.mean_edge());
        let range = range(tree);
        // Depth first: the limb that goes on, then what branches off.
        let mut open: Vec<Waiting> = vec![(tree.root, None, "trunk".to_owned())];
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
                first = parent.as_ref().map(|(_, rim)| rim.clone());
            }
            let division = divisions.get(&index);
            if let Some(division) = division {
                high = division.level;
                last = Some(division.last.clone());
            } else if tip.open {
                last = self.opening(&tip.ring, true);
            } else {
                poles[1] = Some(self.middle(tip));
                high = ways[limb.leaf].level(&field_at, FIRST_RING * row, true);
            }
            let course = Course { way: &ways[limb.leaf].vertices, spacing, row, first, last };
            let mut lines = levels.along([low, high], &course);
            let seam = plan.seam.filter(|_| parent.is_none());
            let none = Fault::NoRows { at: self.middle(tip) };
            let mut stack = stacked(&lines.rings, poles, seam, plan).ok_or(none)?;
            let whole = parent.is_none() && division.is_none();
            if whole && !stack.revolve(plan.gauge.width, &self.points, &self.patches) && ends.whole {
                if let Some(flat) = levels.laid_flat(given, &lines, &course) {
                    if plan.field == Field::Harmonic && self.aim(ends, free(plan), &flat, row) {
                        return Ok(None);
                    }
                    lines = flat.lines;
                    stack = stacked(&lines.rings, poles, seam, plan).unwrap_or(stack);
                }
                if seam.is_none() {
                    let by = stack.slowest_side();
                    lines.rings.iter_mut().for_each(|(_, phase)| *phase += by);
                    stack = stacked(&lines.rings, poles, seam, plan).unwrap_or(stack);
                }
            }
            let here = pieces.len();
            let ends = stack.ends();
            let attachment = parent.map(|(parent, _)| Attachment { parent, joint: Joint::Split });
            let leap = stack.places().windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
            let even = leap * stack.length() < LEAP * spacing;
            pieces.push(Piece { name: name.clone(), surface: Box::new(stack), ends, attachment, even });
            let rims = division.map(|division| division.rims.clone()).into_iter().flatten();
            let mut next = Vec::new();
            for (child, rim) in limb.children.iter().zip(rims) {
                let name =
                    letters.next().map_or_else(|| format!("limb {child}"), |letter| format!("limb {letter}"));
                next.push((*child, Some((here, rim)), name));
            }
            open.extend(next.into_iter().rev());
        }
        Ok(Some(pieces))
    }

    /// An open edge as the first (or last) loop: clockwise seen from the end of the tube.
    pub(super) fn opening(&self, ring: &[u32], last: bool) -> Option<Ring> {
        let points: Vec<DVec3> = ring.iter().map(|v| self.point(*v)).collect();
        let ring = Ring::new(points)?;
        // The surface lies on the left of an open edge; it shall lie on the right at the start.
        Some(if last { ring } else { ring.reversed() })
    }
}

impl Levels<'_> {
    /// Where a limb leads, and how thick it is: after it begins, or before it divides. The lines bulge toward the limbs on
    /// both sides of a fork, so it is looked at away from there.
    pub(super) fn course(&self, limb: &Limb, ways: &[Way], lower: bool) -> (DVec3, f64) {
        let way = &ways[limb.leaf];
        let [low, high] = [way.down_to(limb.low), way.down_to(limb.high)];
        let line = |length: f64| self.line(way.level_at(length), &way.vertices);
        let width = line(0.5 * (low + high)).map_or(0.0, |ring| ring.length() / std::f64::consts::PI);
        let length = low - high;
        let at = |from: f64| line(if lower { low - from } else { high + from });
        let [near, far] = [at(width.min(0.4 * length)), at((2.0 * width).min(0.9 * length))];
        let center = |ring: &Option<Ring>| ring.as_ref().map_or(DVec3::ZERO, Ring::center);
        let up = (center(&near) - center(&far)).normalize_or_zero();
        (if lower { -up } else { up }, near.map_or(0.0, |ring| ring.length()))
    }
}

impl Levels<'_> {
    /// How thick a limb is that begins at the start, and the middle of the line at which it gets thicker.
    fn neck(&self, limb: &Limb, ways: &[Way]) -> (DVec3, f64) {
        const LINES: u32 = 24;
        let way = &ways[limb.leaf];
        let [low, high] = [way.down_to(limb.low), way.down_to(limb.high)];
        let at = |i: u32| low + (high - low) * (0.25 + 0.75 * f64::from(i) / f64::from(LINES));
        let rings: Vec<Ring> =
            (0..LINES).filter_map(|i| self.line(way.level_at(at(i)), &way.vertices)).collect();
        let thin = rings.iter().map(Ring::length).fold(f64::INFINITY, f64::min);
        // A cap gets wider all along, and is no limb.
        let even = rings.iter().filter(|ring| ring.length() < 1.25 * thin).count();
        let thin = if 3 * even < rings.len() { f64::INFINITY } else { thin };
        let last = rings.iter().rev().find(|ring| ring.length() < 1.25 * thin);
        (last.map_or(DVec3::ZERO, Ring::center), thin)
    }
}

/// Whether the start and the other ends may be moved: where they are not named.
fn free(plan: &Plan) -> [bool; 2] {
    [plan.start.is_none(), plan.poles.is_empty()]
}

/// A tube through lines, begun near a point where one is named.
fn stacked(
    lines: &[(Ring, f64)],
    poles: [Option<DVec3>; 2],
    seam: Option<DVec3>,
    plan: &Plan,
) -> Option<Stack> {
    let around = samples_around(lines.iter().map(|(ring, _)| ring), plan);
    let Some(seam) = seam else { return Stack::turned(lines, poles, around) };
    let mut rings: Vec<Ring> = lines.iter().map(|(ring, _)| ring.clone()).collect();
    if let Some(ring) = rings.first_mut() {
        *ring = ring.begun_near(seam);
    }
    Stack::new(&rings, poles, around)
}

/// True when there is room for a body between limbs of these middles and girths.
fn far_apart(limbs: &[(DVec3, f64)]) -> bool {
    limbs.iter().enumerate().all(|(i, (middle, girth))| {
        let room = APART * girth / std::f64::consts::PI;
        limbs.iter().enumerate().all(|(j, (other, _))| i == j || middle.distance(*other) > room)
    })
}

/// Samples around a tube through these lines.
pub(super) fn samples_around<'r>(rings: impl Iterator<Item = &'r Ring>, plan: &Plan) -> usize {
    let most = rings.map(Ring::length).fold(0.0, f64::max);
    let around = (SAMPLES_A_STITCH * most / plan.gauge.width).clamp(48.0, 256.0) as usize;
    around.next_multiple_of(32)
}

/// Lets the limbs that were cut off grow from the pieces again, the last one first.
fn grow(mut pieces: Vec<Piece>, limbs: Vec<limb::Limb>, plan: &Plan) -> Result<Vec<Piece>, Fault> {
    let used = pieces.len() - 1;
    let mut letters = ('A'..='Z').chain('a'..='z').skip(used);
    for (number, limb) in limbs.into_iter().rev().enumerate() {
        let at = limb.end;
        let stack = limb.stack.ok_or(Fault::NoRows { at })?;
        let base: Vec<DVec3> = (0..16).map(|k| stack.point(0.0, f64::from(k) / 16.0)).collect();
        let ends = stack.ends();
        let solids = pieces.iter().map(|piece| Solid::new(&*piece.surface, piece.ends));
        let off = |solid: &Solid<'_>| -> f64 {
            // With one piece there is no choice.
            let base = if pieces.len() > 1 { base.as_slice() } else { &[] };
            base.iter().map(|point| solid.foot(*point).distance.abs()).sum()
        };
        let (parent, solid) = solids
            .enumerate()
            .map(|(index, solid)| (off(&solid), index, solid))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, index, solid)| (index, solid))
            .ok_or(Fault::Fork { at })?;
        let size = plan.gauge.width.max(plan.gauge.height);
        let spacing = plan.gauge.height;
        let branch = Branch::leaving(stack, &solid, [plan.gauge.width, GIVE], LEAVES * size, spacing);
        let branch = branch.map_err(|_| Fault::Fork { at })?;
        let name = letters
            .next()
            .map_or_else(|| format!("limb {}", used + number), |letter| format!("limb {letter}"));
        pieces.push(Piece {
            name,
            surface: Box::new(branch),
            ends,
            attachment: Some(Attachment { parent, joint: Joint::Surface }),
            even: true,
        });
    }
    Ok(pieces)
}

/// Turns a single round tube that begins at an opening and ends at a pole, so that it begins with the ring of the pole, as
/// bowls and hats do. Also tells whether it is one.
fn from_its_pole(pieces: Vec<Piece>) -> (Vec<Piece>, bool) {
    let [Piece { ends: [End::Open, End::Closed], surface, .. }] = pieces.as_slice() else {
        return (pieces, false);
    };
    if !is_revolution(&**surface) {
        return (pieces, false);
    }
    let turned =
        |it: Piece| Piece { surface: Box::new(Reversed(it.surface)), ends: [End::Closed, End::Open], ..it };
    (pieces.into_iter().map(turned).collect(), true)
}

/// The greatest value of the field.
pub(super) fn range(tree: &Tree) -> f64 {
    tree.limbs.iter().map(|limb| limb.high).fold(0.0, f64::max)
}

/// The end of a closed limb that is too short to be made.
fn short(tree: &Tree, ends: &Ends, ways: &[Way], row: f64) -> Option<usize> {
    let limbs = tree.limbs.iter().enumerate();
    let closed = limbs.filter(|(i, limb)| {
        let tip = &ends.others[limb.leaf];
        *i != tree.root && limb.last && !tip.open && !tip.between
    });
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
