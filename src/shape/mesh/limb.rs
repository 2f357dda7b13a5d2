//! Cutting a limb off: where it leaves the object, its level lines, and the object with the place closed smoothly.

use super::cut::{Plan, samples_around};
use super::ends::{Ends, Tip};
use super::field::{Flows, Lone};
use super::levels::Levels;
use super::patch::Patch;
use super::soup::{NONE, Soup, meeting, rising};
use super::way::Way;
use super::{Fault, Field, Mesh};
use crate::math::atan2;
use crate::shape::revolve::Mended;
use crate::shape::ring::Ring;
use crate::shape::stack::Stack;
use glam::DVec3;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Level lines that are measured to find where a limb begins.
const LINES: usize = 64;
/// Lines that grow by more than this with the way down are no longer around the limb; a disk in a plane has 2 pi.
const GROWTH: f64 = 1.6;
/// A limb is no thicker where it begins than this many times the lower third of its lines.
const THICKEST: f64 = 1.8;
/// Length of the line along which a limb is cut off, against its girth.
const WIDER: f64 = 1.65;
/// A patch looks at its surroundings as far as this share of the girth.
const MARGIN: f64 = 0.15;
/// Tries at a narrower cut.
const TRIES: u32 = 4;
/// Fewest points of a patch that are worth being handed to another thread.
const TOGETHER: usize = 32;
/// Rings of triangles that a patch has unless its edges are shortest, and most of all; shortest and longest edges in stitches.
const LEAST_RINGS: f64 = 7.0;
const MOST_RINGS: usize = 48;
const EDGES: [f64; 2] = [0.5, 1.6];

/// A limb that was cut off.
#[derive(Clone, Debug)]
pub(super) struct Limb {
    /// Its level lines as a tube, from the object that it was cut off to its end; `None` where they make none.
    pub(super) stack: Option<Stack>,
    /// Where its end is.
    pub(super) end: DVec3,
}

/// Where a limb begins, and the field that tells.
pub(super) struct Root {
    field: Vec<f64>,
    way: Way,
    /// The level of its end.
    high: f64,
    /// The level along which it is cut off, and the one at which it begins.
    levels: [f64; 2],
    /// The middle of the line at which it begins.
    pub(super) middle: DVec3,
    /// The length of that line.
    pub(super) girth: f64,
    /// Where it leads from there.
    direction: DVec3,
}

/// What is left when a limb is cut off.
struct Severed {
    /// The object without it, and its ends.
    mesh: Mesh,
    ends: Ends,
    /// For each vertex before its number now.
    place: Vec<u32>,
}

impl Mesh {
    /// The limbs at a fork by the ends that they go to, those that turn most against the direction before first.
    pub(super) fn roots(
        &self,
        flows: &mut Flows<'_>,
        ends: &Ends,
        leaves: &[usize],
        (before, row): (DVec3, f64),
    ) -> Result<Vec<(usize, Root)>, Fault> {
        let lone: Vec<Lone> = leaves.iter().map(|leaf| flows.lone(ends, *leaf)).collect();
        let found = leaves.par_iter().zip(lone).map(|(leaf, lone)| self.root(lone, ends, *leaf, row));
        let found: Vec<Result<Root, Fault>> = found.collect();
        let mut roots = Vec::with_capacity(leaves.len());
        for (&leaf, root) in leaves.iter().zip(found) {
            let root = root?;
            let turn = atan2(before.cross(root.direction).length(), before.dot(root.direction));
            // A body goes on to its own end, if it has one.
            let turn = if ends.others[leaf].between { -1.0 } else { turn };
            roots.push((turn, leaf, root));
        }
        roots.sort_by(|a, b| b.0.total_cmp(&a.0).then(b.1.cmp(&a.1)));
        Ok(roots.into_iter().map(|(_, leaf, root)| (leaf, root)).collect())
    }

    /// Finds where the limb begins that goes to one of the ends: downward from its tip its level lines keep their length,
    /// and then they spread out over what it grows from.
    fn root(&self, Lone { field, ground }: Lone, ends: &Ends, which: usize, row: f64) -> Result<Root, Fault> {
        let tip = &ends.others[which];
        let way = self.way(tip, &ground, &field);
        let saddle = self.saddle(&field, ends, which);
        let lines = Levels { mesh: self, field: &field };
        let total = way.down_to(saddle);
        let step = total / LINES as f64;
        // From the saddle up.
        let at = |i: usize| way.level_at(total - step * (i as f64 + 0.5));
        let rings: Vec<Option<Ring>> = (0..LINES).map(|i| lines.line(at(i), &way.vertices)).collect();
        let ring = |i: usize| rings.get(i).and_then(Option::as_ref);
        let length = |i: usize| ring(i).map_or(0.0, Ring::length);
        let growth = |i: usize| {
            let window = ((0.1 * length(i) / step) as usize).clamp(1, 8).min(i).max(1);
            if i < window || i + window >= LINES {
                return f64::INFINITY;
            }
            (length(i - window) - length(i + window)) / (2.0 * window as f64 * step)
        };
        // Of the stretches that keep their length, the lowest that is no thicker than what lies above it: the widest lines of
        // a body keep theirs, too.
        let keeps = |i: &usize| growth(*i) < GROWTH;
        let begins = || {
            (0..LINES * 7 / 8).filter(|i| keeps(i) && !i.checked_sub(1).is_some_and(|below| keeps(&below)))
        };
        let usual = |i: usize| {
            let mut above: Vec<f64> = (i..LINES).map(length).collect();
            let low = above.len() / 3;
            *above.select_nth_unstable_by(low, f64::total_cmp).1
        };
        let begin = begins().find(|i| length(*i) < THICKEST * usual(*i)).or_else(|| begins().next());
        // A limb without a neck begins a third up.
        let begin = begin.unwrap_or(LINES / 3);
        let girth = length(begin);
        let low = (0..=begin).rev().find(|i| length(*i) >= WIDER * girth).unwrap_or(0);
        let up = ((girth / std::f64::consts::PI / step) as usize).clamp(1, LINES);
        let center = |i: usize| ring(i.min(LINES - 1)).map(Ring::center);
        let fault = Fault::Fork { at: self.middle(tip) };
        let Some(middle) = center(begin).filter(|_| girth > 0.0) else { return Err(fault) };
        let end = center(begin + up).unwrap_or_else(|| self.middle(tip));
        let direction = (end - middle).normalize_or_zero();
        let levels = [at(low), at(begin)];
        let high = if tip.open {
            tip.ring.iter().map(|v| field[*v as usize]).fold(f64::MAX, f64::min)
        } else {
            way.level(&|v| field[v as usize], super::cut::FIRST_RING * row, true)
        };
        Ok(Root { field, way, high, levels, middle, girth, direction })
    }

    /// Cuts limbs off one after the other. Returns what is left, and its ends.
    pub(super) fn without(
        &self,
        ends: Ends,
        roots: Vec<Root>,
        plan: &Plan,
        limbs: &mut Vec<Limb>,
    ) -> Result<(Self, Ends), Fault> {
        // The ends of limbs stand behind the others, in the order in which they go.
        let which = ends.others.len();
        let mut ends = ends;
        let off = std::mem::take(&mut ends.off);
        ends.others.iter_mut().for_each(|tip| tip.bears.clear());
        ends.others.extend(off.iter().map(|tip| Tip { bears: Vec::new(), ..tip.clone() }));
        let mut now: Option<(Self, Vec<u32>)> = None;
        for (tip, root) in off.into_iter().zip(roots) {
            let (severed, limb) = match &now {
                None => self.sever(&ends, which, &root, (self, &tip, &root), plan)?,
                Some((mesh, place)) => {
                    if let Some(still) = self.still(&tip, &root, place, mesh.points.len()) {
                        mesh.sever(&ends, which, &still, (self, &tip, &root), plan)?
                    } else {
                        // It bore other limbs, or one has been too near.
                        let lone = Flows::new(mesh, ends.strict).lone(&ends, which);
                        let root = mesh.root(lone, &ends, which, plan.gauge.height)?;
                        let tip = ends.others[which].clone();
                        mesh.sever(&ends, which, &root, (mesh, &tip, &root), plan)?
                    }
                }
            };
            limbs.push(limb);
            let mut place = severed.place;
            if let Some((_, before)) = now {
                let moved = |v: &u32| place.get(*v as usize).copied().unwrap_or(NONE);
                place = before.iter().map(moved).collect();
            }
            ends = severed.ends;
            now = Some((severed.mesh, place));
        }
        let (mesh, _) = now.ok_or(Fault::Fork { at: self.middle(&ends.start) })?;
        if plan.field == Field::Geodesic {
            ends.distance = mesh.distances(&ends.start.ring, f64::INFINITY);
        }
        Ok((mesh, ends))
    }

    /// The tube of a limb above the level along which it is cut off.
    fn limb(&self, tip: &Tip, root: &Root, level: f64, plan: &Plan) -> Limb {
        let levels = Levels { mesh: self, field: &root.field };
        let spacing = plan.gauge.height.max(0.4 * self.mean_edge());
        let (last, pole) =
            if tip.open { (self.opening(&tip.ring, true), None) } else { (None, Some(self.middle(tip))) };
        let rings = levels.stack([level, root.high], &root.way.vertices, spacing, None, last.as_ref()).rings;
        let end = pole.or_else(|| rings.last().map(|(ring, _)| ring.center())).unwrap_or_default();
        let around = samples_around(rings.iter().map(|(ring, _)| ring), plan);
        Limb { stack: Stack::turned(&rings, [None, pole], around), end }
    }

    /// Cuts off the limb that goes to one of the ends; its level lines are those of a mesh on which it is whole.
    fn sever(
        &self,
        ends: &Ends,
        which: usize,
        root: &Root,
        whole: (&Self, &Tip, &Root),
        plan: &Plan,
    ) -> Result<(Severed, Limb), Fault> {
        let tip = &ends.others[which];
        let fault = || Fault::Fork { at: self.middle(tip) };
        let [wide, narrow] = root.levels;
        // The place is cut out as widely as its surroundings allow.
        let tries = (0..=TRIES).map(|k| wide + (narrow - wide) * f64::from(k) / f64::from(TRIES));
        let cut = tries.filter(|level| *level < root.high).find_map(|level| {
            let (kept, edge) = self.rest(self.reached(&root.field, level, tip), ends, which)?;
            Some((level, kept, edge))
        });
        let (level, kept, edge) = cut.ok_or_else(fault)?;
        let edges = EDGES.map(|stitches| stitches * plan.gauge.width.min(plan.gauge.height));
        let close = || self.closed(&kept, &edge, (root.middle, root.girth), edges);
        let (on, whole_tip, whole_root) = whole;
        let ((mesh, place), limb) = rayon::join(close, || on.limb(whole_tip, whole_root, level, plan));
        let new = |tip: &Tip| {
            let ring = tip.ring.iter().map(|v| place[*v as usize]).filter(|v| *v != NONE).collect();
            Tip { ring, ..tip.clone() }
        };
        let start = new(&ends.start);
        let others: Vec<Tip> =
            ends.others.iter().enumerate().filter(|(i, _)| *i != which).map(|(_, tip)| new(tip)).collect();
        if others.iter().chain([&start]).any(|tip| tip.ring.is_empty()) {
            return Err(fault());
        }
        let (off, distance) = (Vec::new(), Vec::new());
        let ends = Ends { start, others, off, distance, strict: ends.strict, whole: false, aims: 0 };
        Ok((Severed { mesh, ends, place }, limb))
    }

    /// A root on what is left of the mesh; `None` where something of the limb is gone.
    fn still(&self, tip: &Tip, root: &Root, place: &[u32], count: usize) -> Option<Root> {
        let whole = |level: f64| {
            let inside = self.reached(&root.field, level, tip);
            inside.iter().zip(place).all(|(inside, place)| !*inside || *place != NONE)
        };
        let [wide, narrow] = root.levels;
        let wide = (0..=TRIES)
            .map(|k| wide + (narrow - wide) * f64::from(k) / f64::from(TRIES))
            .find(|it| whole(*it))?;
        // What is new lies low.
        let mut field = vec![f64::MIN; count];
        for (value, place) in root.field.iter().zip(place).filter(|(_, place)| **place != NONE) {
            field[*place as usize] = *value;
        }
        Some(Root { field, way: root.way.clone(), levels: [wide, narrow], ..*root })
    }

    /// The level above which what lies around the limb does not reach around what it grows from: below it the rest of the
    /// object falls apart.
    fn saddle(&self, field: &[f64], ends: &Ends, which: usize) -> f64 {
        let count = self.points.len();
        let order = rising(field.iter().copied().zip(0..));
        let mut leader = vec![NONE; count];
        let mut end = vec![NONE; count];
        for (i, tip) in (0..).zip(ends.beside(which)) {
            tip.ring.iter().for_each(|v| end[*v as usize] = i);
        }
        let mut last = 0.0;
        for vertex in order {
            leader[vertex as usize] = vertex;
            for other in self.neighbors(vertex) {
                let Some((a, b)) = meeting(&mut leader, vertex, other) else { continue };
                let (one, two) = (end[a as usize], end[b as usize]);
                if one != NONE && two != NONE && one != two {
                    last = field[vertex as usize];
                }
                leader[b as usize] = a;
                end[a as usize] = if one == NONE { two } else { one };
            }
        }
        last
    }

    /// The vertices above a level that hang together with a tip.
    pub(super) fn reached(&self, field: &[f64], level: f64, tip: &Tip) -> Vec<bool> {
        let mut inside = vec![false; self.points.len()];
        let mut open = tip.ring.clone();
        for vertex in &open {
            inside[*vertex as usize] = true;
        }
        while let Some(vertex) = open.pop() {
            for next in self.neighbors(vertex) {
                if !inside[next as usize] && field[next as usize] >= level {
                    inside[next as usize] = true;
                    open.push(next);
                }
            }
        }
        inside
    }

    /// The faces that stay, and the edge of the hole: each vertex to the next, the rest on its left. `None` unless it is
    /// one ring away from other openings.
    fn rest(&self, mut inside: Vec<bool>, ends: &Ends, which: usize) -> Option<(Vec<bool>, Vec<u32>)> {
        let home = *ends.start.ring.first()?;
        loop {
            let mut kept: Vec<bool> =
                self.faces.iter().map(|face| face.iter().all(|v| !inside[*v as usize])).collect();
            // What hangs together with the start.
            let mut seen = vec![false; self.faces.len()];
            let mut open: Vec<u32> =
                self.corners(home).iter().map(|h| h / 3).filter(|f| kept[*f as usize]).collect();
            for face in &open {
                seen[*face as usize] = true;
            }
            while let Some(face) = open.pop() {
                for twin in (3 * face..3 * face + 3).map(|h| self.twins[h as usize]) {
                    if twin != NONE && kept[twin as usize / 3] && !seen[twin as usize / 3] {
                        seen[twin as usize / 3] = true;
                        open.push(twin / 3);
                    }
                }
            }
            kept = seen;
            let mut stays = vec![false; self.points.len()];
            let corners = self.faces.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(face, _)| face);
            corners.flatten().for_each(|v| stays[*v as usize] = true);
            let mut changed = false;
            for (inside, stays) in inside.iter_mut().zip(&stays) {
                changed |= !*inside && !*stays;
                *inside |= !*stays;
            }
            let mut next: BTreeMap<u32, u32> = BTreeMap::new();
            let mut pinched = Vec::new();
            for h in 0..self.twins.len() as u32 {
                let twin = self.twins[h as usize];
                if kept[h as usize / 3]
                    && twin != NONE
                    && !kept[twin as usize / 3]
                    && next.insert(self.from(h), self.to(h)).is_some()
                {
                    pinched.push(self.from(h));
                }
            }
            if !pinched.is_empty() {
                for vertex in pinched {
                    inside[vertex as usize] = true;
                }
                continue;
            }
            if changed {
                continue;
            }
            let others = ends.others.iter().enumerate().filter(|(i, _)| *i != which).map(|(_, tip)| tip);
            if others.chain([&ends.start]).flat_map(|tip| &tip.ring).any(|v| inside[*v as usize]) {
                return None;
            }
            let first = *next.keys().next()?;
            let mut edge = vec![first];
            while let Some(&to) = next.get(edge.last()?).filter(|to| **to != first) {
                edge.push(to);
                if edge.len() > next.len() {
                    return None;
                }
            }
            let whole = edge.len() == next.len() && edge.len() >= 3;
            return whole.then_some((kept, edge));
        }
    }

    /// The kept faces with the hole closed by a smooth patch that bulges toward `apex`; and for each vertex its new number.
    /// Its edges are as long as those around it within the given bounds.
    fn closed(
        &self,
        kept: &[bool],
        edge: &[u32],
        (apex, girth): (DVec3, f64),
        [finest, coarsest]: [f64; 2],
    ) -> (Self, Vec<u32>) {
        let mut place = vec![NONE; self.points.len()];
        let mut soup = Soup::default();
        let mut known = Vec::new();
        for face in self.faces.iter().zip(kept).filter(|(_, kept)| **kept).map(|(face, _)| face) {
            let corners = face.map(|v| {
                let slot = &mut place[v as usize];
                if *slot == NONE {
                    *slot = soup.points.len() as u32;
                    soup.points.push(self.point(v));
                    known.extend(self.normals.get(v as usize));
                }
                *slot
            });
            soup.faces.push(corners);
        }
        let reach = (MARGIN * girth).max(1.6 * self.length(edge) / edge.len() as f64);
        let near = self.distances(edge, reach);
        let mut normals: BTreeMap<u32, DVec3> = BTreeMap::new();
        for (f, face) in self.faces.iter().enumerate().filter(|(f, _)| kept[*f]) {
            for v in face.iter().filter(|v| near[**v as usize] <= reach) {
                *normals.entry(*v).or_default() += self.normal(f as u32);
            }
        }
        let around: Vec<(DVec3, DVec3)> = normals
            .iter()
            .map(|(v, normal)| (self.point(*v), normal.normalize_or_zero()))
            .filter(|(_, normal)| *normal != DVec3::ZERO)
            .collect();
        let patch = Patch::new(&around);
        let onto = |p: DVec3| match &patch {
            // A patch that runs away from its hole is none.
            Some(patch) => Some(patch.project(p)).filter(|q| q.distance(p) < girth).unwrap_or(p),
            None => p,
        };
        let length = self.length(edge);
        let coarsest = coarsest.min(length / LEAST_RINGS / std::f64::consts::TAU).max(finest);
        let around = length / (length / edge.len() as f64).clamp(finest, coarsest);
        let rings = ((around / std::f64::consts::TAU) as usize).clamp(3, MOST_RINGS);
        let mut before: Vec<u32> = edge.iter().map(|v| place[*v as usize]).collect();
        let mut flat = Vec::new();
        let base = soup.points.len();
        for ring in 1..=rings {
            let share = ring as f64 / rings as f64;
            // As wide apart around as from ring to ring.
            let count = if ring == rings { 1 } else { ((around * (1.0 - share)) as usize).max(5) };
            let first = (base + flat.len()) as u32;
            flat.extend((0..count).map(|k| {
                let at = k as f64 / count as f64 * edge.len() as f64;
                let [a, b] = [at as usize, at as usize + 1].map(|k| self.point(edge[k % edge.len()]));
                a.lerp(b, at.fract()).lerp(apex, share)
            }));
            let here: Vec<u32> = (first..first + count as u32).collect();
            zip(&before, &here, &mut soup.faces);
            before = here;
        }
        soup.points.par_extend(flat.into_par_iter().with_min_len(TOGETHER).map(onto));
        let mut mesh = Self::link(soup);
        mesh.find_boundaries();
        if !known.is_empty() {
            known.resize(mesh.points.len(), DVec3::ZERO);
            mesh.normals = known;
        }
        let edge: Vec<DVec3> = edge.iter().map(|v| self.point(*v)).collect();
        mesh.patches.clone_from(&self.patches);
        mesh.patches.push(Mended::within(&edge, apex));
        (mesh, place)
    }
}

/// Triangles between two rings: the outer one, and one inside of it that may have fewer vertices.
fn zip(outer: &[u32], inner: &[u32], faces: &mut Vec<[u32; 3]>) {
    let (m, n) = (outer.len(), inner.len());
    let (mut i, mut j) = (0, 0);
    while i < m || (n > 1 && j < n) {
        let (a, b) = (outer[i % m], inner[j % n]);
        if i < m && (n == 1 || (i + 1) * n <= (j + 1) * m) {
            i += 1;
            faces.push([outer[i % m], a, b]);
        } else {
            j += 1;
            faces.push([a, b, inner[j % n]]);
        }
    }
}
