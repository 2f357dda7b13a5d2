//! The connections of a mesh: half-edges, fans, boundaries, sizes.

use super::Mesh;
use super::soup::{NONE, Soup};
use glam::DVec3;

impl Mesh {
    /// Links oriented triangles; vertices that no face has are left out.
    pub(super) fn link(soup: Soup) -> Self {
        let mut place = vec![NONE; soup.points.len()];
        let (mut points, mut vertices) = (Vec::new(), Vec::new());
        let mut faces = soup.faces;
        for corner in faces.as_flattened() {
            place[*corner as usize] = 0;
        }
        for (i, place) in place.iter_mut().enumerate() {
            if *place != NONE {
                *place = points.len() as u32;
                points.push(soup.points[i]);
                vertices.push(i as u32 + 1);
            }
        }
        for corner in faces.as_flattened_mut() {
            *corner = place[*corner as usize];
        }
        let mut mesh = Self {
            points,
            faces,
            vertices,
            twins: Vec::new(),
            starts: Vec::new(),
            leaving: Vec::new(),
            boundaries: Vec::new(),
            normals: Vec::new(),
            patches: Vec::new(),
        };
        mesh.connect();
        mesh
    }

    fn connect(&mut self) {
        let halves = 3 * self.faces.len();
        let mut starts = vec![0_u32; self.points.len() + 1];
        for corner in self.faces.as_flattened() {
            starts[*corner as usize + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut fill = starts.clone();
        let mut leaving = vec![0_u32; halves];
        for (h, corner) in self.faces.as_flattened().iter().enumerate() {
            let slot = &mut fill[*corner as usize];
            leaving[*slot as usize] = h as u32;
            *slot += 1;
        }
        self.starts = starts;
        self.leaving = leaving;
        self.twins = (0..halves as u32)
            .map(|h| {
                let (from, to) = (self.from(h), self.to(h));
                let mut back = self.corners(to).iter().copied();
                back.find(|other| self.to(*other) == from).unwrap_or(NONE)
            })
            .collect();
    }

    pub(super) fn inside_out(mut self) -> Self {
        for face in &mut self.faces {
            face.swap(1, 2);
        }
        self.connect();
        self
    }

    /// The half-edge after this one in its face.
    pub(super) fn after(h: u32) -> u32 {
        if h % 3 == 2 { h - 2 } else { h + 1 }
    }

    /// The half-edge before this one in its face.
    pub(super) fn before(h: u32) -> u32 {
        if h.is_multiple_of(3) { h + 2 } else { h - 1 }
    }

    /// Where a half-edge starts.
    pub(super) fn from(&self, h: u32) -> u32 {
        self.faces[h as usize / 3][h as usize % 3]
    }

    /// Where a half-edge ends.
    pub(super) fn to(&self, h: u32) -> u32 {
        self.from(Self::after(h))
    }

    /// The half-edges that leave a vertex.
    pub(super) fn corners(&self, vertex: u32) -> &[u32] {
        &self.leaving[self.starts[vertex as usize] as usize..self.starts[vertex as usize + 1] as usize]
    }

    /// The neighbors of a vertex.
    pub(super) fn neighbors(&self, vertex: u32) -> impl Iterator<Item = u32> {
        let open = |h: &u32| self.twins[Self::before(*h) as usize] == NONE;
        let corners = self.corners(vertex);
        // Along an open edge the half-edge runs the other way only.
        let behind = if self.boundaries.is_empty() { &[] } else { corners };
        let behind = behind.iter().filter(move |h| open(h)).map(|h| self.from(Self::before(*h)));
        corners.iter().map(|h| self.to(*h)).chain(behind)
    }

    /// The number of a vertex in the file, from 1.
    pub(super) fn number(&self, vertex: u32) -> u32 {
        self.vertices.get(vertex as usize).copied().unwrap_or(0)
    }

    pub(super) fn point(&self, vertex: u32) -> DVec3 {
        self.points[vertex as usize]
    }

    /// A point of the surface above an edge: on the edge itself, or on the cubic that leaves both of its ends at right angles
    /// to the normals there (Vlachos et al. 2001).
    pub(super) fn above(&self, low: u32, high: u32, t: f64) -> DVec3 {
        let (a, b) = (self.point(low), self.point(high));
        let flat = a.lerp(b, t);
        let (Some(m), Some(n)) = (self.normals.get(low as usize), self.normals.get(high as usize)) else {
            return flat;
        };
        let edge = b - a;
        flat + (*n * (t * edge.dot(*n)) - *m * ((1.0 - t) * edge.dot(*m))) * (t * (1.0 - t))
    }

    /// Normals of the vertices, of length 1.
    pub(super) fn vertex_normals(&self) -> Vec<DVec3> {
        let around = |v: u32| self.corners(v).iter().map(|h| self.normal(h / 3)).sum::<DVec3>();
        (0..self.points.len() as u32).map(|v| around(v).normalize_or_zero()).collect()
    }

    /// Walks along every open edge.
    pub(super) fn find_boundaries(&mut self) {
        self.boundaries.clear();
        let mut seen = vec![false; self.twins.len()];
        for first in 0..self.twins.len() as u32 {
            if self.twins[first as usize] != NONE || seen[first as usize] {
                continue;
            }
            let mut ring = Vec::new();
            let mut h = first;
            while !seen[h as usize] {
                seen[h as usize] = true;
                ring.push(self.from(h));
                // The next open edge leaves from the end of this one: turn around it.
                h = Self::after(h);
                while self.twins[h as usize] != NONE {
                    h = Self::after(self.twins[h as usize]);
                }
            }
            self.boundaries.push(ring);
        }
    }

    /// The open edges: rings of vertices, the surface on the left seen from outside.
    pub fn boundaries(&self) -> &[Vec<u32>] {
        &self.boundaries
    }

    /// Number of triangles.
    pub fn faces(&self) -> usize {
        self.faces.len()
    }

    /// Twice the area of a face times its normal.
    pub(super) fn normal(&self, face: u32) -> DVec3 {
        let [a, b, c] = self.faces[face as usize].map(|v| self.points[v as usize]);
        (b - a).cross(c - a)
    }

    /// Area of the surface.
    pub fn area(&self) -> f64 {
        (0..self.faces.len() as u32).map(|face| 0.5 * self.normal(face).length()).sum()
    }

    /// The volume inside, with every opening closed by a fan from its middle.
    pub(super) fn volume(&self) -> f64 {
        let origin = self.points.first().copied().unwrap_or_default();
        let mut six: f64 = 0.0;
        for face in &self.faces {
            let [a, b, c] = face.map(|v| self.points[v as usize] - origin);
            six += a.dot(b.cross(c));
        }
        for ring in &self.boundaries {
            let center = self.center(ring) - origin;
            for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
                six += center.dot((self.point(*b) - origin).cross(self.point(*a) - origin));
            }
        }
        six / 6.0
    }

    /// Mean of the points of a ring, by length.
    pub(super) fn center(&self, ring: &[u32]) -> DVec3 {
        let (mut sum, mut length) = (DVec3::ZERO, 0.0);
        for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            let (a, b) = (self.point(*a), self.point(*b));
            sum += 0.5 * (a + b) * a.distance(b);
            length += a.distance(b);
        }
        if length > 0.0 { sum / length } else { DVec3::ZERO }
    }

    /// Length of a ring.
    pub(super) fn length(&self, ring: &[u32]) -> f64 {
        ring.iter()
            .zip(ring.iter().cycle().skip(1))
            .map(|(a, b)| self.point(*a).distance(self.point(*b)))
            .sum()
    }

    /// Mean length of the edges.
    pub(super) fn mean_edge(&self) -> f64 {
        let sum: f64 = (0..self.twins.len() as u32)
            .map(|h| self.point(self.from(h)).distance(self.point(self.to(h))))
            .sum();
        sum / self.twins.len().max(1) as f64
    }

    /// Moves every point.
    pub fn map(&mut self, f: impl Fn(DVec3) -> DVec3) {
        for point in &mut self.points {
            *point = f(*point);
        }
    }
}
