//! The ends of an object: open edges, and the tips of its limbs, found as far points that stand out.

use super::Mesh;
use super::soup::{NONE, meeting, rising};
use glam::DVec3;
use std::collections::BTreeMap;

/// Least height of a limb over its surroundings, in row heights, and as a share of the radius of a disk as large as it.
const LEAST_ROWS: f64 = 3.0;
const LEAST_ASPECT: f64 = 0.6;
/// Least radius of the cap of a closed end, in row heights; and its radius as a share of the girth of the limb.
const CAP: f64 = 1.0;
const SPREAD: f64 = 0.2;
/// The girth of a limb is measured within this share of the longest way.
const NEAR: f64 = 0.25;
/// Ends as broad as this share of the broadest may be the start; among them the lowest is.
const BROAD: f64 = 0.8;

/// One end of the object.
#[derive(Clone, Debug)]
pub(super) struct Tip {
    /// The tip, or the vertices of an open edge.
    pub(super) ring: Vec<u32>,
    /// True for an open edge.
    pub(super) open: bool,
    /// Distance from the start.
    pub(super) at: f64,
    /// Circumference of the limb, roughly.
    pub(super) girth: f64,
    /// Radius of the cap of a closed end.
    pub(super) cap: f64,
    /// True for the end of a body between limbs, which is one however short.
    pub(super) between: bool,
    /// Limbs on the way to it that are to be cut off: indices in [`Ends::off`].
    pub(super) bears: Vec<usize>,
}

impl Tip {
    fn new(ring: Vec<u32>, open: bool) -> Self {
        Self { ring, open, at: 0.0, girth: 0.0, cap: 0.0, between: false, bears: Vec::new() }
    }

    /// Measures the limb: the area within reach of its end, by the reach.
    fn measure(&mut self, mesh: &Mesh, reach: f64, row: f64) {
        if self.open {
            self.girth = mesh.length(&self.ring);
            return;
        }
        let near = mesh.distances(&self.ring, reach);
        let inside = |face: &[u32; 3]| face.iter().all(|v| near[*v as usize] <= reach);
        let faces = mesh.faces.iter().enumerate().filter(|(_, face)| inside(face));
        let area: f64 = faces.map(|(f, _)| 0.5 * mesh.normal(f as u32).length()).sum();
        // A cap of a ball has the area of a disk of its reach, or of a tube around it.
        self.girth = (area / reach.max(f64::MIN_POSITIVE)).max(row);
        self.cap = (CAP * row).max(SPREAD * self.girth).min(0.5 * reach);
    }
}

/// The start, the other ends, and how far everything is from the start.
#[derive(Clone, Debug)]
pub(super) struct Ends {
    pub(super) start: Tip,
    pub(super) others: Vec<Tip>,
    /// The ends of limbs that are to be cut off: they are on the mesh still, but nothing flows to them.
    pub(super) off: Vec<Tip>,
    /// Empty where nobody has asked since limbs were cut off.
    pub(super) distance: Vec<f64>,
    /// Whether fields keep to the maximum principle at the cost of distortion.
    pub(super) strict: bool,
    /// Whether the mesh is as it was: where limbs were cut off, lines run over the places that were closed.
    pub(super) whole: bool,
    /// How often closed ends have been moved to the axis of a tube.
    pub(super) aims: u32,
}

impl Ends {
    /// Finds the ends. `start` and `poles` are points that the user named; with `poles` no tips are searched for.
    pub(super) fn find(mesh: &Mesh, row: f64, start: Option<DVec3>, poles: &[DVec3]) -> Self {
        let nearest = |p: DVec3| -> Tip {
            let of_ring =
                |ring: &Vec<u32>| ring.iter().map(|v| mesh.point(*v).distance(p)).fold(f64::MAX, f64::min);
            let vertex = (0..mesh.points.len() as u32)
                .min_by(|a, b| mesh.point(*a).distance(p).total_cmp(&mesh.point(*b).distance(p)))
                .unwrap_or(0);
            let gap = mesh.point(vertex).distance(p);
            // The middle of an opening, or a point on its edge, means the opening.
            let opening = mesh.boundaries().iter().find(|ring| {
                let radius = mesh.length(ring) / 6.0;
                of_ring(ring) <= gap * (1.0 + 1e-9) || mesh.center(ring).distance(p) < 0.5 * radius
            });
            match opening {
                Some(ring) => Tip::new(ring.clone(), true),
                None => Tip::new(vec![vertex], false),
            }
        };
        let (start, known) = match start {
            Some(point) => (nearest(point), None),
            None => Self::broadest(mesh, row),
        };
        let distance = known.unwrap_or_else(|| mesh.distances(&start.ring, f64::INFINITY));
        let mut others: Vec<Tip> = mesh
            .boundaries()
            .iter()
            .filter(|ring| !(start.open && start.ring.first() == ring.first()))
            .map(|ring| Tip::new(ring.clone(), true))
            .collect();
        let mut heights = BTreeMap::new();
        if poles.is_empty() {
            for (tip, height) in mesh.tips(&distance, row) {
                heights.insert(tip, height);
                others.push(Tip::new(vec![tip], false));
            }
        } else {
            for &pole in poles {
                let tip = nearest(pole);
                if !tip.open && tip.ring != start.ring && others.iter().all(|other| other.ring != tip.ring) {
                    others.push(tip);
                }
            }
        }
        let mut ends = Self { start, others, off: Vec::new(), distance, strict: false, whole: true, aims: 0 };
        ends.place();
        let far = ends.others.iter().map(|tip| tip.at).fold(0.0, f64::max);
        ends.start.measure(mesh, NEAR * far, row);
        for i in 0..ends.others.len() {
            let height = heights.get(&ends.others[i].ring[0]).copied().unwrap_or(far);
            ends.others[i].measure(mesh, height.min(NEAR * far), row);
        }
        ends
    }

    /// All ends but one of the others, and but those on its way.
    pub(super) fn beside(&self, which: usize) -> impl Iterator<Item = &Tip> {
        let mut borne = vec![false; self.off.len()];
        let mut open: Vec<usize> = self.others.get(which).map(|tip| tip.bears.clone()).unwrap_or_default();
        while let Some(index) = open.pop() {
            if let (Some(borne), Some(tip)) = (borne.get_mut(index), self.off.get(index))
                && !std::mem::replace(borne, true)
            {
                open.extend(&tip.bears);
            }
        }
        let rest = self.others.iter().enumerate().filter(move |(i, _)| *i != which).map(|(_, tip)| tip);
        let off = self.off.iter().zip(borne).filter(|(_, borne)| !borne).map(|(tip, _)| tip);
        rest.chain([&self.start]).chain(off)
    }

    /// Sets ends apart whose limbs are to be cut off; they are on the way to the one that goes on.
    pub(super) fn set_off(&mut self, leaves: &[usize], goes_on: Option<usize>) {
        for leaf in leaves {
            if let Some(tip) = self.others.get(*leaf) {
                self.off.push(tip.clone());
                let index = self.off.len() - 1;
                if let Some(bearer) = goes_on.and_then(|leaf| self.others.get_mut(leaf)) {
                    bearer.bears.push(index);
                }
            }
        }
        let mut leaf = 0..;
        self.others.retain(|_| leaf.next().is_none_or(|leaf| !leaves.contains(&leaf)));
    }

    fn place(&mut self) {
        for tip in &mut self.others {
            let sum: f64 = tip.ring.iter().map(|v| self.distance[*v as usize]).sum();
            tip.at = sum / tip.ring.len().max(1) as f64;
        }
        self.others.sort_by(|a, b| b.at.total_cmp(&a.at).then(a.ring.cmp(&b.ring)));
    }

    /// The end to begin at: the largest opening, else the broadest tip; of those that are alike the lowest. With the
    /// distances from there, if they are known.
    fn broadest(mesh: &Mesh, row: f64) -> (Tip, Option<Vec<f64>>) {
        let height =
            |tip: &Tip| tip.ring.iter().map(|v| mesh.point(*v).z).sum::<f64>() / tip.ring.len() as f64;
        let mut known = None;
        let (tips, sizes): (Vec<Tip>, Vec<f64>) = if mesh.boundaries().is_empty() {
            let lowest = (0..mesh.points.len() as u32)
                .min_by(|a, b| mesh.point(*a).z.total_cmp(&mesh.point(*b).z))
                .unwrap_or(0);
            let farthest = |distance: &[f64]| -> u32 {
                let most = (0..distance.len()).max_by(|a, b| distance[*a].total_cmp(&distance[*b]));
                most.unwrap_or(0) as u32
            };
            // From one end to the other and back: most often it is the lowest one in the end.
            let one = farthest(&mesh.distances(&[mesh.far_from(lowest)], f64::INFINITY));
            let distance = mesh.distances(&[one], f64::INFINITY);
            let two = farthest(&distance);
            let mut tips: Vec<u32> = mesh.tips(&distance, row).into_iter().map(|(tip, _)| tip).collect();
            tips.push(one);
            if !tips.contains(&two) {
                tips.push(two);
            }
            let reach = 0.25 * distance[two as usize];
            let size = |tip: u32| {
                let near = mesh.distances(&[tip], reach);
                let inside = |face: u32| mesh.faces[face as usize].iter().all(|v| near[*v as usize] <= reach);
                (0..mesh.faces.len() as u32).filter(|f| inside(*f)).map(|f| mesh.normal(f).length()).sum()
            };
            let sizes = tips.iter().map(|tip| size(*tip)).collect();
            known = Some((one, distance));
            (tips.into_iter().map(|tip| Tip::new(vec![tip], false)).collect(), sizes)
        } else {
            let rings = mesh.boundaries();
            let tips = rings.iter().map(|ring| Tip::new(ring.clone(), true)).collect();
            (tips, rings.iter().map(|ring| mesh.length(ring)).collect())
        };
        let most = sizes.iter().copied().fold(0.0, f64::max);
        let broad = tips.into_iter().zip(sizes).filter(|(_, size)| *size >= BROAD * most).map(|(tip, _)| tip);
        let lowest = broad.min_by(|a, b| height(a).total_cmp(&height(b)).then(a.ring.cmp(&b.ring)));
        let lowest = lowest.unwrap_or(Tip::new(vec![0], false));
        let known = known.filter(|(vertex, _)| lowest.ring == [*vertex]).map(|(_, distance)| distance);
        (lowest, known)
    }
}

impl Ends {
    /// Adds an end between limbs: where the surface is nearest to a point. It takes the place of the start if `first`;
    /// else it is one more end. None when there is an end already.
    pub(super) fn add_between(&mut self, mesh: &Mesh, point: DVec3, first: bool, row: f64) -> Option<()> {
        let vertex = (0..mesh.points.len() as u32)
            .min_by(|a, b| mesh.point(*a).distance(point).total_cmp(&mesh.point(*b).distance(point)))?;
        if self.others.iter().chain([&self.start]).any(|tip| tip.ring.contains(&vertex)) {
            return None;
        }
        if self.distance.is_empty() {
            self.distance = mesh.distances(&self.start.ring, f64::INFINITY);
        }
        let mut tip = Tip { between: true, ..Tip::new(vec![vertex], false) };
        let far = self.others.iter().map(|tip| tip.at).fold(0.0, f64::max);
        tip.measure(mesh, NEAR * far, row);
        // The limbs beside it shall not lie in its cap.
        tip.cap = CAP * row;
        if first {
            self.others.push(std::mem::replace(&mut self.start, tip));
            self.distance = mesh.distances(&self.start.ring, f64::INFINITY);
        } else {
            self.others.push(tip);
        }
        self.place();
        Some(())
    }
}

impl Mesh {
    /// Far points that stand out: maxima of the distance, each with how far one must come back to get to a higher one.
    fn tips(&self, distance: &[f64], row: f64) -> Vec<(u32, f64)> {
        let count = self.points.len();
        let mut order = rising(distance.iter().copied().zip(0..));
        order.reverse();
        let share = self.vertex_areas();
        let mut leader = vec![NONE; count];
        let peak: Vec<u32> = (0..count as u32).collect();
        let mut area = vec![0.0; count];
        let mut tips = Vec::new();
        let on_edge = {
            let mut on_edge = vec![false; count];
            self.boundaries().iter().flatten().for_each(|v| on_edge[*v as usize] = true);
            on_edge
        };
        let mut consider = |peak: u32, low: f64, area: f64, all: bool| {
            let height = distance[peak as usize] - low;
            let broad = LEAST_ASPECT * (area / std::f64::consts::PI).sqrt();
            if !on_edge[peak as usize] && (all || (height > LEAST_ROWS * row && height > broad)) {
                tips.push((peak, height));
            }
        };
        for &vertex in &order {
            leader[vertex as usize] = vertex;
            area[vertex as usize] = share[vertex as usize];
            for other in self.neighbors(vertex) {
                let Some((a, b)) = meeting(&mut leader, vertex, other) else { continue };
                // The lower peak ends here.
                let (high, low) =
                    if distance[peak[a as usize] as usize] >= distance[peak[b as usize] as usize] {
                        (a, b)
                    } else {
                        (b, a)
                    };
                if peak[low as usize] != vertex {
                    consider(peak[low as usize], distance[vertex as usize], area[low as usize], false);
                }
                leader[low as usize] = high;
                area[high as usize] += area[low as usize];
            }
        }
        // The highest peak of all stands out from nothing: without an opening it is the other end.
        if let Some(&highest) = order.first() {
            let closed = self.boundaries().is_empty() || self.boundaries().len() == 1;
            let whole: f64 = share.iter().sum();
            consider(highest, 0.0, whole, closed);
        }
        tips
    }

    /// A third of the area of its faces for every vertex.
    fn vertex_areas(&self) -> Vec<f64> {
        let mut areas = vec![0.0; self.points.len()];
        for (face, corners) in self.faces.iter().enumerate() {
            let third = self.normal(face as u32).length() / 6.0;
            for corner in corners {
                areas[*corner as usize] += third;
            }
        }
        areas
    }
}
