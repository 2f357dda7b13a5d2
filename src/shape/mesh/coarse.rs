//! Fewer triangles where they are far smaller than a stitch: short edges shrink to points of the same surface.

use super::Mesh;
use super::soup::{NONE, Soup};
use glam::DVec3;
use smallvec::SmallVec;

/// Shares of the wanted length up to which edges shrink, one after the other, and sweeps over the vertices for each.
const STEPS: [f64; 4] = [0.25, 0.5, 0.75, 1.0];
const SWEEPS: u32 = 3;
/// A sweep that takes less than this share of the vertices is the last of its step.
const LITTLE: f64 = 0.02;
/// Longest edge that may come about, in wanted lengths; most edges of a vertex.
const LONGEST: f64 = 1.7;
const MOST_EDGES: usize = 10;
/// Faces turn by less than the angle of this cosine, and stay this high against their longest side.
const TURN: f64 = 0.6;
const FLATTEST: f64 = 0.2;

/// Triangles that are being joined.
struct Work {
    points: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
    /// Faces around each vertex; none for a vertex that is gone.
    around: Vec<SmallVec<[u32; 8]>>,
    /// Vertices on open edges, which stay.
    fixed: Vec<bool>,
}

impl Mesh {
    /// The same surface with edges of about `length` where its own are shorter; its vertices are some of those there are.
    /// `None` when it would hardly have fewer.
    pub(super) fn coarse(&self, length: f64, mut progress: impl FnMut(u64, u64)) -> Option<Self> {
        let mut fixed = vec![false; self.points.len()];
        self.boundaries().iter().flatten().for_each(|v| fixed[*v as usize] = true);
        let around =
            (0..self.points.len() as u32).map(|v| self.corners(v).iter().map(|h| h / 3).collect()).collect();
        let mut work = Work { points: self.points.clone(), faces: self.faces.clone(), around, fixed };
        let mut left = self.points.len();
        for (done, step) in (0..).zip(STEPS) {
            progress(done, STEPS.len() as u64);
            for _ in 0..SWEEPS {
                let gone = work.sweep(step * length, LONGEST * length);
                left -= gone;
                if (gone as f64) < LITTLE * left as f64 {
                    break;
                }
            }
        }
        if left * 2 > self.points.len() {
            return None;
        }
        let faces = work.faces.into_iter().filter(|face| face[0] != NONE).collect();
        let mut mesh = Self::link(Soup { points: work.points, faces, ..Soup::default() });
        let normals = self.vertex_normals();
        mesh.normals = mesh.vertices.iter().map(|vertex| normals[*vertex as usize - 1]).collect();
        for vertex in &mut mesh.vertices {
            *vertex = self.number(*vertex - 1);
        }
        mesh.find_boundaries();
        Some(mesh)
    }
}

impl Work {
    /// Shrinks edges up to a length, at most one at each vertex; returns how many.
    fn sweep(&mut self, length: f64, longest: f64) -> usize {
        let mut gone = 0;
        for v in 0..self.points.len() as u32 {
            if self.fixed[v as usize] || self.around[v as usize].is_empty() {
                continue;
            }
            let at = self.points[v as usize];
            let short = |u: &u32| *u != v && self.points[*u as usize].distance_squared(at) < length * length;
            if !self.around[v as usize].iter().any(|f| self.faces[*f as usize].iter().any(short)) {
                continue;
            }
            let ring = self.ring(v);
            let mut near: SmallVec<[(f64, u32); 12]> = ring
                .iter()
                .map(|u| (self.points[*u as usize].distance_squared(self.points[v as usize]), *u))
                .filter(|(square, _)| *square < length * length)
                .collect();
            near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let to = near.iter().take(3).map(|(_, u)| *u).find(|u| self.may(v, *u, &ring, longest));
            if let Some(u) = to {
                self.shrink(v, u);
                gone += 1;
            }
        }
        gone
    }

    /// The neighbors of a vertex, each once.
    fn ring(&self, v: u32) -> SmallVec<[u32; 12]> {
        let mut ring = SmallVec::new();
        for f in &self.around[v as usize] {
            for u in self.faces[*f as usize] {
                if u != v && !ring.contains(&u) {
                    ring.push(u);
                }
            }
        }
        ring
    }

    /// Whether a vertex may move to its neighbor: the surface stays one sheet, no face turns over or becomes a sliver.
    fn may(&self, v: u32, u: u32, ring: &[u32], longest: f64) -> bool {
        let at = self.points[u as usize];
        if ring.iter().any(|w| self.points[*w as usize].distance_squared(at) > longest * longest) {
            return false;
        }
        let other = self.ring(u);
        let common = ring.iter().filter(|w| other.contains(w)).count();
        if common != 2 || ring.len() + other.len() - common - 2 > MOST_EDGES {
            return false;
        }
        self.around[v as usize].iter().map(|f| self.faces[*f as usize]).filter(|face| !face.contains(&u)).all(
            |face| {
                let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
                let before = normal(face.map(|w| self.points[w as usize]));
                let corners = face.map(|w| if w == v { at } else { self.points[w as usize] });
                let after = normal(corners);
                let [a, b, c] = corners;
                let side = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
                after.length() > FLATTEST * side
                    && after.dot(before) > TURN * after.length() * before.length()
            },
        )
    }

    /// Moves a vertex to its neighbor; the faces on their edge go.
    fn shrink(&mut self, v: u32, u: u32) {
        for f in std::mem::take(&mut self.around[v as usize]) {
            let face = &mut self.faces[f as usize];
            if face.contains(&u) {
                let face = std::mem::replace(face, [NONE; 3]);
                for w in face.into_iter().filter(|w| *w != v) {
                    self.around[w as usize].retain(|other| *other != f);
                }
            } else {
                for w in face {
                    if *w == v {
                        *w = u;
                    }
                }
                self.around[u as usize].push(f);
            }
        }
    }
}
