//! The forces: springs between loops, resistance against bending, and stuffing.

use super::Numbers;
use super::envelope::Envelope;
use crate::ir::Kind;
use crate::preview::net::{NONE, Net, Role};
use glam::DVec3;
use smallvec::SmallVec;

/// A spring between two loops; lengths are in stitch heights.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spring {
    pub(super) ends: [u32; 2],
    pub(super) rest: f64,
    pub(super) stiffness: f64,
    /// A side of a stitch, whose strain counts.
    pub(super) side: bool,
}

/// A closed fabric with its forces.
#[derive(Default)]
pub(super) struct System {
    pub(super) count: usize,
    springs: Vec<Spring>,
    /// Pieces of the surface, turning left seen from outside.
    quads: Vec<[u32; 4]>,
    triangles: Vec<[u32; 3]>,
    /// Openings, each closed by a fan around its middle, turning left seen from outside.
    lids: Vec<Vec<u32>>,
    /// What resists bending: a loop, with the two beside it and those above and below.
    bends: Vec<Bend>,
}

/// A loop with neighbors on all four sides. Several below or above count as one in their middle.
struct Bend {
    middle: u32,
    beside: [u32; 2],
    below: SmallVec<[u32; 2]>,
    above: SmallVec<[u32; 2]>,
}

/// Stiffness of a diagonal, of a yarn's step at the end of a short row, and of the yarn that draws a hole shut.
const DIAGONAL: f64 = 0.02;
const STEP: f64 = 0.3;
const DRAWN: f64 = 1.0;
/// Bending stiffness: stuffed work keeps its outline.
const BENDING: f64 = 0.2;
/// Pressure of the stuffing: less than one percent of strain.
const PRESSURE: f64 = 0.0005;
/// Loops left out between two stitches that still stand side by side.
const SKIPPED: usize = 6;

impl System {
    /// The forces of all pieces; `width` is in stitch heights.
    pub(super) fn new(nets: &[Net], numbers: &Numbers, width: f64) -> Self {
        let mut system = Self { count: numbers.count, ..Self::default() };
        for (piece, net) in nets.iter().enumerate() {
            system.piece(net, piece, numbers, width);
        }
        system
    }

    fn spring(&mut self, a: u32, b: u32, rest: f64, stiffness: f64, side: bool) {
        if a != b {
            self.springs.push(Spring { ends: [a, b], rest, stiffness, side });
        }
    }

    fn piece(&mut self, net: &Net, piece: usize, numbers: &Numbers, width: f64) {
        let number = |id: u32| numbers.id(piece, id);
        let count = net.loops as usize;
        let (mut first, mut last) = (vec![NONE; count], vec![NONE; count]);
        let [start, end] = numbers.poles[piece];
        for step in &net.worked {
            let base = net.base(step);
            let kind = match step.role {
                Role::Work(stitch) => stitch.kind,
                Role::Chain | Role::Ring | Role::Turn(_) | Role::Close => Kind::Sc,
            };
            for top in Net::top(step) {
                let Some(to) = number(top) else { continue };
                if let (Some(left), Some(right)) = (base.first(), base.last()) {
                    first[top as usize] = *left;
                    last[top as usize] = *right;
                }
                for from in base.iter().filter_map(|id| number(*id)) {
                    self.spring(from, to, kind.height().max(0.2), 1.0, true);
                }
                if let (Role::Ring, Some(pole)) = (step.role, start) {
                    self.spring(pole, to, 0.9, 1.0, false);
                }
            }
            if step.makes > 0 {
                for pair in base.windows(2) {
                    if let (Some(a), Some(b), Some(top)) =
                        (number(pair[0]), number(pair[1]), number(step.top))
                    {
                        self.triangles.push([a, top, b]);
                    }
                }
            }
            if let (Role::Close, Some(pole)) = (step.role, end) {
                for id in base.iter().filter_map(|id| number(*id)) {
                    self.spring(id, pole, 0.35 * width, DRAWN, false);
                }
            }
        }
        // Whether a loop and the one after it are held together by a stitch, not by a step of the yarn.
        let mut joined = vec![true; count];
        for left in 0..net.loops {
            let right = net.after[left as usize];
            let (Some(a), Some(b)) = (number(left), number(right)) else { continue };
            let below = [last[left as usize], first[right as usize]];
            let [Some(under), Some(next)] = below.map(number) else {
                self.spring(a, b, width, 1.0, true);
                if let (Some(pole), true) = (start, right < net.start) {
                    self.triangles.push([pole, a, b]);
                }
                continue;
            };
            if under == next {
                self.spring(a, b, width, 1.0, true);
                self.triangles.push([under, a, b]);
            } else if beside(net, below[0], below[1]) {
                self.spring(a, b, width, 1.0, true);
                self.quads.push([under, a, b, next]);
                let diagonal = (1.0 + width * width).sqrt();
                if net.after[below[0] as usize] == below[1] {
                    self.spring(under, b, diagonal, DIAGONAL, false);
                    self.spring(next, a, diagonal, DIAGONAL, false);
                }
            } else {
                joined[left as usize] = false;
                self.spring(a, b, 1.2 * width.max(1.0), STEP, false);
            }
        }
        self.bend(net, piece, numbers, &joined);
        self.close(net, piece, numbers);
    }

    /// Closes what is open at the start and the end, so that there is something to stuff.
    fn close(&mut self, net: &Net, piece: usize, numbers: &Numbers) {
        if net.flat {
            return;
        }
        let ring = |ids: &mut dyn Iterator<Item = u32>| -> Vec<u32> {
            ids.filter_map(|id| numbers.id(piece, id)).collect()
        };
        let [start, end] = numbers.poles[piece];
        if start.is_none() && net.shared.iter().all(Option::is_none) && net.start > 2 {
            self.lids.push(ring(&mut (0..net.start)));
        }
        let top = ring(&mut net.open.iter().rev().copied());
        match end {
            Some(pole) => {
                for (k, id) in top.iter().enumerate() {
                    self.triangles.push([pole, *id, top[(k + 1) % top.len()]]);
                }
            }
            None if !net.taken && top.len() > 2 => self.lids.push(top),
            None => {}
        }
    }

    /// Finds what resists bending: loops with neighbors on all four sides.
    fn bend(&mut self, net: &Net, piece: usize, numbers: &Numbers, joined: &[bool]) {
        let count = net.loops as usize;
        let mut below: Vec<SmallVec<[u32; 2]>> = vec![SmallVec::new(); count];
        let mut above = below.clone();
        for step in net.worked.iter().filter(|step| matches!(step.role, Role::Work(_))) {
            for top in Net::top(step) {
                for base in net.base(step) {
                    let (Some(to), Some(from)) = (numbers.id(piece, top), numbers.id(piece, *base)) else {
                        continue;
                    };
                    if let (Some(below), Some(above)) =
                        (below.get_mut(top as usize), above.get_mut(*base as usize))
                    {
                        below.push(from);
                        above.push(to);
                    }
                }
            }
        }
        for (id, (below, above)) in below.into_iter().zip(above).enumerate() {
            let beside = [net.before[id], net.after[id]].map(|id| numbers.id(piece, id));
            if let ([Some(before), Some(after)], Some(middle)) = (beside, numbers.id(piece, id as u32))
                && !below.is_empty()
                && !above.is_empty()
                && joined.get(net.before[id] as usize) == Some(&true)
                && joined[id]
            {
                self.bends.push(Bend { middle, beside: [before, after], below, above });
            }
        }
    }

    /// The edges of all springs.
    pub(super) fn edges(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        self.springs.iter().map(|spring| spring.ends)
    }

    /// The stiffness at these places, as far as it is positive; bending as that of edges.
    pub(super) fn stiffness(&self, x: &[DVec3], matrix: &mut Envelope) {
        for spring in &self.springs {
            let [a, b] = spring.ends.map(|end| end as usize);
            let way = x[b] - x[a];
            let length = way.length().max(1e-9);
            let way = (way / length).to_array();
            let tense = (1.0 - spring.rest / length).max(if spring.side { 0.5 * BENDING } else { 0.0 });
            let block: [[f64; 3]; 3] = std::array::from_fn(|i| {
                std::array::from_fn(|j| {
                    let plain = if i == j { tense } else { 0.0 };
                    spring.stiffness * (plain + (1.0 - tense) * way[i] * way[j])
                })
            });
            matrix.add(a, a, block);
            matrix.add(b, b, block);
            matrix.add(a, b, block.map(|line| line.map(|value| -value)));
        }
    }

    /// Energy at these places, and its slope.
    pub(super) fn energy(&self, x: &[DVec3], slope: &mut [DVec3]) -> f64 {
        slope.fill(DVec3::ZERO);
        let mut energy = 0.0;
        for spring in &self.springs {
            let [a, b] = spring.ends.map(|end| end as usize);
            let way = x[b] - x[a];
            let length = way.length();
            let off = length - spring.rest;
            energy += 0.5 * spring.stiffness * off * off;
            let force = way * (spring.stiffness * off / length.max(1e-9));
            slope[a] -= force;
            slope[b] += force;
        }
        let mean = |ids: &[u32]| ids.iter().map(|id| x[*id as usize]).sum::<DVec3>() / ids.len() as f64;
        for Bend { middle, beside, below, above } in &self.bends {
            let around = 0.25 * (mean(beside) * 2.0 + mean(below) + mean(above));
            let bend = around - x[*middle as usize];
            energy += 0.5 * BENDING * bend.length_squared();
            slope[*middle as usize] -= bend * BENDING;
            let each = bend * (0.25 * BENDING);
            for id in beside {
                slope[*id as usize] += each;
            }
            for side in [below, above] {
                let each = each / side.len() as f64;
                for id in side {
                    slope[*id as usize] += each;
                }
            }
        }
        energy - PRESSURE * self.volume(x, slope)
    }

    /// The volume inside; its slope, times the pressure, is taken off.
    fn volume(&self, x: &[DVec3], slope: &mut [DVec3]) -> f64 {
        let mut volume = 0.0;
        for quad in &self.quads {
            let [a, b, c, d] = quad.map(|id| x[id as usize]);
            let (u, v, middle) = (c - a, d - b, a + b + c + d);
            let area = u.cross(v);
            volume += middle.dot(area) / 24.0;
            let (by_u, by_v) = (v.cross(middle) / 24.0, middle.cross(u) / 24.0);
            let each = area / 24.0;
            for (id, way) in quad.iter().zip([each - by_u, each - by_v, each + by_u, each + by_v]) {
                slope[*id as usize] -= way * PRESSURE;
            }
        }
        let mut triangle = |ids: [u32; 3], x: [DVec3; 3], slope: &mut [DVec3]| {
            let [a, b, c] = x;
            volume += a.dot(b.cross(c)) / 6.0;
            let ways = [b.cross(c), c.cross(a), a.cross(b)];
            for (id, way) in ids.iter().zip(ways) {
                if *id != NONE {
                    slope[*id as usize] -= way * (PRESSURE / 6.0);
                }
            }
            ways[2] / 6.0
        };
        for ids in &self.triangles {
            triangle(*ids, ids.map(|id| x[id as usize]), slope);
        }
        for lid in &self.lids {
            let share = 1.0 / lid.len() as f64;
            let middle: DVec3 = lid.iter().map(|id| x[*id as usize]).sum::<DVec3>() * share;
            let mut pull = DVec3::ZERO;
            for (k, id) in lid.iter().enumerate() {
                let next = lid[(k + 1) % lid.len()];
                pull += triangle([*id, next, NONE], [x[*id as usize], x[next as usize], middle], slope);
            }
            for id in lid {
                slope[*id as usize] -= pull * (share * PRESSURE);
            }
        }
        volume
    }

    /// The fabric as triangles.
    pub(super) fn surface(&self) -> Vec<[u32; 3]> {
        let halves = self.quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
        halves.chain(self.triangles.iter().copied()).collect()
    }

    /// Mean absolute strain of the sides of stitches.
    pub(super) fn strain(&self, x: &[DVec3]) -> f64 {
        let mut sum = (0.0, 0.0);
        for spring in self.springs.iter().filter(|spring| spring.side) {
            let [a, b] = spring.ends.map(|end| x[end as usize]);
            sum = (sum.0 + (a.distance(b) - spring.rest).abs() / spring.rest, sum.1 + 1.0);
        }
        sum.0 / f64::max(sum.1, 1.0)
    }
}

/// True when one loop follows another, perhaps over a few that no stitch was worked into.
fn beside(net: &Net, from: u32, to: u32) -> bool {
    let mut here = from;
    for _ in 0..=SKIPPED {
        here = net.after.get(here as usize).copied().unwrap_or(NONE);
        if here == to {
            return true;
        }
    }
    false
}
