//! Triangles as a file gives them, and the repairs that cannot change the shape: welding, and dropping faces without a side.

use glam::DVec3;

/// Points nearer to each other than this share of the diagonal are one.
const SAME: f64 = 1e-6;
/// No vertex, half-edge or face.
pub(super) const NONE: u32 = u32::MAX;

/// Polygons as they stand in a file, in its unit and axes.
#[derive(Clone, Debug, Default)]
pub struct Soup {
    /// The vertices.
    pub points: Vec<DVec3>,
    /// Triangles by vertex, counterclockwise from outside.
    pub faces: Vec<[u32; 3]>,
    /// The number of the face of the file that each triangle belongs to, counted from 0; empty when they are the same.
    pub polygons: Vec<u32>,
}

impl Soup {
    /// The face of the file that a triangle belongs to, counted from 1 as modeling tools do.
    pub(super) fn number(&self, face: u32) -> u32 {
        self.polygons.get(face as usize).copied().unwrap_or(face) + 1
    }

    /// Adds a polygon as a fan of triangles; `number` is its place in the file, counted from 0.
    pub fn polygon(&mut self, corners: &[u32], number: u32) {
        let Some((&first, rest)) = corners.split_first() else { return };
        for pair in rest.windows(2) {
            self.faces.push([first, pair[0], pair[1]]);
            self.polygons.push(number);
        }
    }

    /// Least and greatest coordinates; `None` without points.
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        let first = *self.points.first()?;
        Some(self.points.iter().fold([first; 2], |[low, high], &p| [low.min(p), high.max(p)]))
    }

    /// Makes one vertex of those that lie in the same place. Returns how many went.
    pub(super) fn weld(&mut self) -> u32 {
        let Some([low, high]) = self.bounds() else { return 0 };
        let cell = 2.0 * SAME * (high - low).length();
        if cell <= 0.0 {
            return 0;
        }
        let mut leader: Vec<u32> = (0..self.points.len() as u32).collect();
        // Neighbors on both sides of a cell's wall share a cell of the shifted grid.
        for shift in [0.0, 0.5] {
            let key = |i: u32| {
                let at = (self.points[i as usize] - low) / cell + shift;
                [at.x as u32, at.y as u32, at.z as u32]
            };
            let mut order: Vec<([u32; 3], u32)> =
                (0..self.points.len() as u32).map(|i| (key(i), i)).collect();
            order.sort_unstable();
            for pair in order.windows(2) {
                if pair[0].0 == pair[1].0 {
                    let (a, b) = (find(&mut leader, pair[0].1), find(&mut leader, pair[1].1));
                    leader[a.max(b) as usize] = a.min(b);
                }
            }
        }
        let mut gone = 0;
        for i in 0..leader.len() as u32 {
            gone += u32::from(find(&mut leader, i) != i);
        }
        if gone > 0 {
            for corner in self.faces.as_flattened_mut() {
                *corner = find(&mut leader, *corner);
            }
        }
        gone
    }

    /// Drops triangles that have two corners in one place, and those that stand twice. Returns how many of each.
    pub(super) fn drop_degenerate(&mut self) -> [u32; 2] {
        let before = self.faces.len();
        let keep = |faces: &mut Self, fine: &dyn Fn(usize, [u32; 3]) -> bool| {
            let mut at = 0;
            let polygons = faces.polygons.clone();
            let all = std::mem::take(&mut faces.faces);
            faces.polygons.clear();
            for (i, face) in all.into_iter().enumerate() {
                if fine(i, face) {
                    faces.faces.push(face);
                    faces.polygons.push(polygons.get(i).copied().unwrap_or(i as u32));
                    at += 1;
                }
            }
            at
        };
        let distinct = |f: [u32; 3]| f[0] != f[1] && f[1] != f[2] && f[2] != f[0];
        let left =
            if self.faces.iter().all(|f| distinct(*f)) { before } else { keep(self, &|_, f| distinct(f)) };
        // The same corners in the same sense, whichever comes first.
        let mut order: Vec<([u32; 3], u32)> =
            self.faces.iter().enumerate().map(|(i, f)| (turned(*f), i as u32)).collect();
        order.sort_unstable();
        let mut twice = vec![false; self.faces.len()];
        for pair in order.windows(2) {
            if pair[0].0 == pair[1].0 {
                twice[pair[1].1 as usize] = true;
            }
        }
        let copies = twice.iter().filter(|twice| **twice).count();
        if copies > 0 {
            keep(self, &|i, _| !twice[i]);
        }
        [(before - left) as u32, copies as u32]
    }
}

/// The triangle begun at its least corner.
fn turned(f: [u32; 3]) -> [u32; 3] {
    if f[0] < f[1] && f[0] < f[2] {
        f
    } else if f[1] < f[2] {
        [f[1], f[2], f[0]]
    } else {
        [f[2], f[0], f[1]]
    }
}

/// The leader of a set, with the path to it halved.
pub(super) fn find(leader: &mut [u32], mut i: u32) -> u32 {
    while leader[i as usize] != i {
        leader[i as usize] = leader[leader[i as usize] as usize];
        i = leader[i as usize];
    }
    i
}

/// The leaders of two sets that an edge joins, the first that of `a`; `None` where `b` is in no set yet, or in the same.
pub(super) fn meeting(leader: &mut [u32], a: u32, b: u32) -> Option<(u32, u32)> {
    if leader[b as usize] == NONE {
        return None;
    }
    let (a, b) = (find(leader, a), find(leader, b));
    (a != b).then_some((a, b))
}

/// Numbers in the order of their values, equal ones as they are.
pub(super) fn rising(values: impl Iterator<Item = (f64, u32)>) -> Vec<u32> {
    // Whole numbers in the order of `f64::total_cmp`, which are quicker to compare.
    let key = |value: f64| {
        let bits = value.to_bits() as i64;
        bits ^ ((bits >> 63) as u64 >> 1) as i64
    };
    let mut keyed: Vec<(i64, u32)> = values.map(|(value, number)| (key(value), number)).collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, number)| number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_rise_as_floats_do() {
        let values = [0.5, -1.0, f64::INFINITY, -0.0, 0.0, -2.5, 0.5, f64::MIN];
        let mut order: Vec<u32> = (0..values.len() as u32).collect();
        order.sort_by(|a, b| values[*a as usize].total_cmp(&values[*b as usize]));
        assert_eq!(rising(values.into_iter().zip(0..)), order);
    }
}
