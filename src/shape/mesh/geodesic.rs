//! Distances along the surface, by fast marching (Kimmel and Sethian 1998).

use super::Mesh;
use glam::DVec3;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

impl Mesh {
    /// Distance of every vertex from the nearest source along the surface, in units of the mesh; infinite beyond `limit`.
    pub(super) fn distances(&self, sources: &[u32], limit: f64) -> Vec<f64> {
        let mut distance = vec![f64::INFINITY; self.points.len()];
        let mut known = vec![false; self.points.len()];
        let mut heap = BinaryHeap::new();
        for &source in sources {
            distance[source as usize] = 0.0;
            heap.push(Reverse((0_u64, source)));
        }
        while let Some(Reverse((bits, vertex))) = heap.pop() {
            if known[vertex as usize] || f64::from_bits(bits) > limit {
                continue;
            }
            known[vertex as usize] = true;
            // Every neighbor may now be reached through a face that it shares with this vertex, or along the edge.
            for &h in self.corners(vertex) {
                let (next, last) = (self.to(h), self.from(Self::before(h)));
                for (target, other) in [(next, last), (last, next)] {
                    if known[target as usize] {
                        continue;
                    }
                    let mut best =
                        distance[vertex as usize] + self.point(vertex).distance(self.point(target));
                    if known[other as usize] {
                        best = best.min(self.through(target, vertex, other, &distance));
                    } else {
                        best = best.min(self.unfolded(h, target, vertex, &distance, &known));
                    }
                    if best < distance[target as usize] {
                        distance[target as usize] = best;
                        heap.push(Reverse((best.to_bits(), target)));
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

    /// Distance at `target` by the straight front that passes two vertices of its face.
    fn through(&self, target: u32, a: u32, b: u32, distance: &[f64]) -> f64 {
        front(
            self.point(target),
            [self.point(a), self.point(b)],
            [distance[a as usize], distance[b as usize]],
        )
    }

    /// Distance at `target` when of its face with half-edge `h` only one vertex is known: a front over the edge between
    /// that vertex and the one across, unfolded into the plane of the face. Helps where the angle at the target is wide.
    fn unfolded(&self, h: u32, target: u32, from: u32, distance: &[f64], known: &[bool]) -> f64 {
        // The edge opposite to the target joins `from` and the third vertex; behind it lies the apex.
        let face = h / 3;
        let side = (3 * face..3 * face + 3).find(|s| self.from(*s) != target && self.to(*s) != target);
        let Some(side) = side else { return f64::INFINITY };
        let twin = self.twins[side as usize];
        if twin == super::soup::NONE {
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
        front(t, [self.point(from), flat], [distance[from as usize], distance[apex as usize]])
    }
}

/// When a straight front that passes `points` at `times` with speed 1 passes the target; along the edges where it would
/// come from outside of the triangle.
fn front(target: DVec3, points: [DVec3; 2], times: [f64; 2]) -> f64 {
    let [a, b] = points.map(|p| p - target);
    let along = (times[0] + a.length()).min(times[1] + b.length());
    // In the plane of the triangle: n with n . a = t0 - t and n . b = t1 - t, |n| = 1. With the inverse Gram matrix Q and
    // s = sum, t^2 (1 Q 1) - 2 t (1 Q T) + T Q T = 1.
    let (aa, ab, bb) = (a.length_squared(), a.dot(b), b.length_squared());
    let det = aa * bb - ab * ab;
    if det <= 1e-12 * aa * bb {
        return along;
    }
    let (qaa, qab, qbb) = (bb / det, -ab / det, aa / det);
    let one = [qaa + qab, qab + qbb];
    let (x, y, z) = (
        one[0] + one[1],
        one[0] * times[0] + one[1] * times[1],
        qaa * times[0] * times[0] + 2.0 * qab * times[0] * times[1] + qbb * times[1] * times[1] - 1.0,
    );
    let root = y * y - x * z;
    if root < 0.0 || x <= 0.0 {
        return along;
    }
    let time = (y + root.sqrt()) / x;
    // The front comes through the edge when both weights of its direction are against it.
    let (da, db) = (times[0] - time, times[1] - time);
    if qaa * da + qab * db > 0.0 || qab * da + qbb * db > 0.0 || time < times[0].max(times[1]) {
        return along;
    }
    time.min(along)
}
