//! Where the handles of a surface are: the shortest of the loops that no face fills.

use super::Mesh;
use super::gate::Fault;
use super::soup::{NONE, find};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

impl Mesh {
    /// Refuses a surface with handles.
    ///
    /// Vertices - edges + faces = 2 - 2 genus - boundaries, for one piece with two sides.
    pub(super) fn genus(&self) -> Result<(), Fault> {
        let open: usize = self.twins.iter().filter(|twin| **twin == NONE).count();
        let edges = usize::midpoint(self.twins.len(), open);
        let chi = self.points.len() as i64 - edges as i64 + self.faces.len() as i64;
        let twice = 2 - self.boundaries.len() as i64 - chi;
        if twice <= 0 {
            return Ok(());
        }
        let ring = self.loop_of_handle();
        Err(Fault::Genus {
            genus: (twice / 2) as u32,
            at: self.center(&ring),
            length: self.length(&ring),
            vertex: ring.first().map_or(0, |v| self.number(*v)),
        })
    }

    /// A short loop around or through a handle: a tree of shortest paths, a tree of faces that crosses none of its edges,
    /// and of the edges in neither the one that closes the shortest loop (Eppstein 2003, tree and cotree).
    fn loop_of_handle(&self) -> Vec<u32> {
        let (distance, parent) = self.paths();
        let in_tree = |a: u32, b: u32| parent[a as usize] == b || parent[b as usize] == a;
        // The longest loops are given to the tree of faces first, so that short ones are left.
        let mut edges: Vec<(Reverse<u64>, u32)> = Vec::new();
        for (h, &twin) in self.twins.iter().enumerate() {
            let h = h as u32;
            let (a, b) = (self.from(h), self.to(h));
            if twin != NONE && h < twin && !in_tree(a, b) {
                let length =
                    distance[a as usize] + distance[b as usize] + self.point(a).distance(self.point(b));
                edges.push((Reverse(length.to_bits()), h));
            }
        }
        edges.sort_unstable();
        // All openings count as one face, and so as closed.
        let outside = self.faces.len() as u32;
        let mut leader: Vec<u32> = (0..=outside).collect();
        for (h, &twin) in self.twins.iter().enumerate() {
            let h = h as u32;
            if twin == NONE && !in_tree(self.from(h), self.to(h)) {
                let (a, b) = (find(&mut leader, h / 3), find(&mut leader, outside));
                leader[a as usize] = b;
            }
        }
        let mut shortest = None;
        for (_, h) in edges {
            let (a, b) = (find(&mut leader, h / 3), find(&mut leader, self.twins[h as usize] / 3));
            if a == b {
                shortest = Some(h);
            } else {
                leader[a as usize] = b;
            }
        }
        let Some(h) = shortest else { return Vec::new() };
        let up = |mut v: u32| {
            let mut path = vec![v];
            while parent[v as usize] != NONE && path.len() <= self.points.len() {
                v = parent[v as usize];
                path.push(v);
            }
            path
        };
        let (mut one, mut other) = (up(self.from(h)), up(self.to(h)));
        let mut joint = None;
        while let (Some(a), Some(b)) = (one.last(), other.last()) {
            if a != b {
                break;
            }
            joint = Some(*a);
            one.pop();
            other.pop();
        }
        one.extend(joint);
        one.extend(other.into_iter().rev());
        one
    }

    /// Distance along edges from the first vertex, and the vertex before on the way.
    fn paths(&self) -> (Vec<f64>, Vec<u32>) {
        let mut distance = vec![f64::INFINITY; self.points.len()];
        let mut parent = vec![NONE; self.points.len()];
        let mut heap = BinaryHeap::new();
        if let Some(first) = distance.first_mut() {
            *first = 0.0;
            heap.push(Reverse((0_u64, 0_u32)));
        }
        // Bits of numbers that are not negative are in the order of the numbers.
        while let Some(Reverse((bits, vertex))) = heap.pop() {
            let here = f64::from_bits(bits);
            if here > distance[vertex as usize] {
                continue;
            }
            for next in self.neighbors(vertex) {
                let there = here + self.point(vertex).distance(self.point(next));
                if there < distance[next as usize] {
                    distance[next as usize] = there;
                    parent[next as usize] = vertex;
                    heap.push(Reverse((there.to_bits(), next)));
                }
            }
        }
        (distance, parent)
    }
}
