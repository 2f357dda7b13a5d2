//! Distances along the surface, by fast marching (Kimmel and Sethian 1998).

use super::Mesh;
use super::soup::NONE;
use glam::DVec3;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// What distances are measured along.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Along {
    Faces,
    Edges,
}

impl Mesh {
    /// Distance of every vertex from the nearest source along the surface, in units of the mesh; infinite beyond `limit`.
    pub(super) fn distances(&self, sources: &[u32], limit: f64) -> Vec<f64> {
        self.march(sources, limit, Along::Faces)
    }

    /// The vertex farthest from another one along edges.
    pub(super) fn far_from(&self, vertex: u32) -> u32 {
        let distance = self.march(&[vertex], f64::INFINITY, Along::Edges);
        (0..distance.len()).max_by(|a, b| distance[*a].total_cmp(&distance[*b])).unwrap_or(0) as u32
    }

    fn march(&self, sources: &[u32], limit: f64, along: Along) -> Vec<f64> {
        let mut distance = vec![f64::INFINITY; self.points.len()];
        let mut known = vec![false; self.points.len()];
        let mut heap = BinaryHeap::new();
        for &source in sources {
            distance[source as usize] = 0.0;
            heap.push(Reverse((0_u64, source)));
        }
        while let Some(Reverse((bits, vertex))) = heap.pop() {
            let time = f64::from_bits(bits);
            if known[vertex as usize] || time > limit {
                continue;
            }
            known[vertex as usize] = true;
            let here = self.point(vertex);
            let mut arrive = |target: u32, time: f64, distance: &mut [f64]| {
                if time < distance[target as usize] {
                    distance[target as usize] = time;
                    heap.push(Reverse((time.to_bits(), target)));
                }
            };
            // Every neighbor may now be reached through a face that it shares with this vertex, or along the edge.
            for &h in self.corners(vertex) {
                let before = Self::before(h);
                let (next, last) = (self.to(h), self.from(before));
                let (to_next, to_last) = (self.point(next) - here, self.point(last) - here);
                if !known[next as usize] {
                    arrive(next, time + to_next.length(), &mut distance);
                }
                // The other edge is the first one of the face beside, if there is one.
                if self.twins[before as usize] == NONE && !known[last as usize] {
                    arrive(last, time + to_last.length(), &mut distance);
                }
                if along == Along::Edges {
                    continue;
                }
                for (target, other, way, side) in
                    [(next, last, to_next, to_last), (last, next, to_last, to_next)]
                {
                    if known[target as usize] {
                        continue;
                    }
                    if known[other as usize] {
                        if let Some(time) = front([-way, side - way], [time, distance[other as usize]]) {
                            arrive(target, time, &mut distance);
                        }
                    } else {
                        let time = self.unfolded(h, target, vertex, &distance, &known);
                        arrive(target, time, &mut distance);
                    }
                }
            }
        }
        for (distance, known) in distance.iter_mut().zip(&known) {
            if !known {
                *distance = f64::INFINITY;
            }
        }
        distance
    }

    /// Distance at `target` when of its face with half-edge `h` only one vertex is known: a front over the edge between
    /// that vertex and the one across, unfolded into the plane of the face. Helps where the angle at the target is wide.
    fn unfolded(&self, h: u32, target: u32, from: u32, distance: &[f64], known: &[bool]) -> f64 {
        // The edge opposite to the target joins `from` and the third vertex; behind it lies the apex.
        let face = h / 3;
        let side = (3 * face..3 * face + 3).find(|s| self.from(*s) != target && self.to(*s) != target);
        let Some(side) = side else { return f64::INFINITY };
        let twin = self.twins[side as usize];
        if twin == NONE {
            return f64::INFINITY;
        }
        let apex = self.from(Self::before(twin));
        if !known[apex as usize] || apex == target {
            return f64::INFINITY;
        }
        let (a, b) = (self.point(self.from(side)), self.point(self.to(side)));
        let along = (b - a).normalize_or_zero();
        let foot = |p: DVec3| a + along * (p - a).dot(along);
        let (t, p) = (self.point(target), self.point(apex));
        let inward = (t - foot(t)).normalize_or_zero();
        let flat = foot(p) - inward * p.distance(foot(p));
        // The straight line to the apex must pass the shared edge.
        let (up, down) = ((t - foot(t)).length(), p.distance(foot(p)));
        if up + down <= 0.0 {
            return f64::INFINITY;
        }
        let cross = foot(t).lerp(foot(p), up / (up + down));
        let place = (cross - a).dot(along);
        if !(0.0..=a.distance(b)).contains(&place) {
            return f64::INFINITY;
        }
        let arms = [self.point(from) - t, flat - t];
        let times = [distance[from as usize], distance[apex as usize]];
        front(arms, times).unwrap_or_else(|| times[1] + arms[1].length())
    }
}

/// When a straight front that passes two points at `times` with speed 1 passes the third corner of their triangle, from
/// which `arms` lead to them; `None` where it would come from outside of the triangle.
fn front([a, b]: [DVec3; 2], times: [f64; 2]) -> Option<f64> {
    // In the plane of the triangle: n with n . a = t0 - t and n . b = t1 - t, |n| = 1. With the inverse Gram matrix Q and
    // s = sum, t^2 (1 Q 1) - 2 t (1 Q T) + T Q T = 1.
    let (aa, ab, bb) = (a.length_squared(), a.dot(b), b.length_squared());
    let det = aa * bb - ab * ab;
    if det <= 1e-12 * aa * bb {
        return None;
    }
    let inverse = 1.0 / det;
    let (qaa, qab, qbb) = (bb * inverse, -ab * inverse, aa * inverse);
    let one = [qaa + qab, qab + qbb];
    let (x, y, z) = (
        one[0] + one[1],
        one[0] * times[0] + one[1] * times[1],
        qaa * times[0] * times[0] + 2.0 * qab * times[0] * times[1] + qbb * times[1] * times[1] - 1.0,
    );
    let root = y * y - x * z;
    if root < 0.0 || x <= 0.0 {
        return None;
    }
    let time = (y + root.sqrt()) / x;
    // The front comes through the edge when both weights of its direction are against it.
    let (da, db) = (times[0] - time, times[1] - time);
    let through = qaa * da + qab * db <= 0.0 && qab * da + qbb * db <= 0.0;
    (through && time >= times[0].max(times[1])).then_some(time)
}
