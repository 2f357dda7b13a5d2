//! Meshes for tests, made here: tubes of rings, level sets of formulas, and the formats they are written in.

use glam::DVec3;
use picot::math::{PI, TAU, cos, sin};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Vertices and triangles.
#[derive(Clone, Debug, Default)]
pub(crate) struct Solid {
    pub(crate) points: Vec<DVec3>,
    pub(crate) faces: Vec<[u32; 3]>,
}

impl Solid {
    /// A tube through rings of equally many points, each end open or closed to a point.
    pub(crate) fn tube(rings: &[Vec<DVec3>], ends: [Option<DVec3>; 2]) -> Self {
        let around = rings[0].len() as u32;
        let mut solid = Self { points: rings.concat(), faces: Vec::new() };
        for i in 0..rings.len() as u32 - 1 {
            for j in 0..around {
                let (a, b) = (i * around + j, i * around + (j + 1) % around);
                solid.faces.extend([[a, b, b + around], [a, b + around, a + around]]);
            }
        }
        let last = (rings.len() as u32 - 1) * around;
        for (side, end) in ends.into_iter().enumerate() {
            let Some(point) = end else { continue };
            let pole = solid.points.len() as u32;
            solid.points.push(point);
            for j in 0..around {
                let next = (j + 1) % around;
                solid.faces.push(if side == 0 { [pole, next, j] } else { [pole, last + j, last + next] });
            }
        }
        solid
    }

    /// What lies between two heights, open at both.
    pub(crate) fn between(mut self, low: f64, high: f64) -> Self {
        let points = &self.points;
        self.faces.retain(|face| face.iter().any(|v| (low..=high).contains(&points[*v as usize].z)));
        for point in &mut self.points {
            point.z = point.z.clamp(low, high);
        }
        self
    }

    /// A ball around the origin.
    pub(crate) fn ball(radius: f64, stacks: u32) -> Self {
        let ring = |i: u32| {
            let angle = PI * f64::from(i) / f64::from(stacks);
            circle(radius * sin(angle), -radius * cos(angle), 2 * stacks)
        };
        let poles = [Some(DVec3::Z * -radius), Some(DVec3::Z * radius)];
        Self::tube(&(1..stacks).map(ring).collect::<Vec<_>>(), poles)
    }

    /// Where a formula is 0, by marching through tetrahedra of a grid: always closed, every edge with two faces.
    pub(crate) fn level_set(formula: impl Fn(DVec3) -> f64, low: DVec3, high: DVec3, step: f64) -> Self {
        // Off the round numbers, so that no corner lies on the surface.
        let low = low + DVec3::splat(0.0131);
        let count = ((high - low) / step).to_array().map(|cells| cells.ceil() as u32 + 1);
        let place = |c: [u32; 3]| low + DVec3::from_array(c.map(f64::from)) * step;
        let index = |c: [u32; 3]| ((c[2] * count[1] + c[1]) * count[0] + c[0]) as usize;
        let mut values = vec![0.0; (count[0] * count[1] * count[2]) as usize];
        for z in 0..count[2] {
            for y in 0..count[1] {
                for x in 0..count[0] {
                    values[index([x, y, z])] = formula(place([x, y, z]));
                }
            }
        }
        let mut solid = Self::default();
        let mut made: BTreeMap<(usize, usize), u32> = BTreeMap::new();
        for z in 0..count[2] - 1 {
            for y in 0..count[1] - 1 {
                for x in 0..count[0] - 1 {
                    let corner = |q: u32| [x + (q & 1), y + (q >> 1 & 1), z + (q >> 2 & 1)];
                    for tetrahedron in
                        [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]]
                    {
                        let corners = tetrahedron.map(corner);
                        let (inside, outside): (Vec<_>, Vec<_>) =
                            corners.into_iter().partition(|c| values[index(*c)] < 0.0);
                        let mut vertex = |a: [u32; 3], b: [u32; 3]| {
                            let (a, b) = if index(a) < index(b) { (a, b) } else { (b, a) };
                            *made.entry((index(a), index(b))).or_insert_with(|| {
                                let (va, vb) = (values[index(a)], values[index(b)]);
                                let t = (va / (va - vb)).clamp(0.05, 0.95);
                                solid.points.push(place(a).lerp(place(b), t));
                                solid.points.len() as u32 - 1
                            })
                        };
                        let ring: Vec<u32> = match (inside.as_slice(), outside.as_slice()) {
                            ([a], [x, y, z]) => vec![vertex(*a, *x), vertex(*a, *y), vertex(*a, *z)],
                            ([a, b, c], [x]) => vec![vertex(*a, *x), vertex(*b, *x), vertex(*c, *x)],
                            ([a, b], [x, y]) => {
                                vec![vertex(*a, *x), vertex(*a, *y), vertex(*b, *y), vertex(*b, *x)]
                            }
                            _ => continue,
                        };
                        // Outward: away from what is inside.
                        let at = |v: u32| solid.points[v as usize];
                        let normal = (at(ring[1]) - at(ring[0])).cross(at(ring[2]) - at(ring[0]));
                        let outward = normal.dot(at(ring[0]) - place(inside[0])) > 0.0;
                        for pair in ring[1..].windows(2) {
                            solid.faces.push(if outward {
                                [ring[0], pair[0], pair[1]]
                            } else {
                                [ring[0], pair[1], pair[0]]
                            });
                        }
                    }
                }
            }
        }
        solid
    }

    /// Both, without a connection.
    pub(crate) fn and(mut self, other: &Self) -> Self {
        let base = self.points.len() as u32;
        self.points.extend(&other.points);
        self.faces.extend(other.faces.iter().map(|face| face.map(|v| v + base)));
        self
    }

    pub(crate) fn moved(mut self, by: DVec3) -> Self {
        self.points.iter_mut().for_each(|p| *p += by);
        self
    }

    pub(crate) fn obj(&self) -> Vec<u8> {
        let mut text = String::new();
        for p in &self.points {
            let _ = writeln!(text, "v {:.7} {:.7} {:.7}", p.x, p.y, p.z);
        }
        for [a, b, c] in &self.faces {
            let _ = writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1);
        }
        text.into_bytes()
    }

    pub(crate) fn stl(&self) -> Vec<u8> {
        let mut bytes = vec![b' '; 80];
        bytes.extend((self.faces.len() as u32).to_le_bytes());
        for face in &self.faces {
            bytes.extend([0; 12]);
            for v in face {
                let p = self.points[*v as usize];
                bytes.extend([p.x, p.y, p.z].iter().flat_map(|x| (*x as f32).to_le_bytes()));
            }
            bytes.extend([0; 2]);
        }
        bytes
    }

    pub(crate) fn stl_text(&self) -> Vec<u8> {
        let mut text = "solid thing\n".to_owned();
        for face in &self.faces {
            text.push_str("facet normal 0 0 0\nouter loop\n");
            for v in face {
                let p = self.points[*v as usize];
                let _ = writeln!(text, "vertex {:.6e} {:.6e} {:.6e}", p.x, p.y, p.z);
            }
            text.push_str("endloop\nendfacet\n");
        }
        text.push_str("endsolid thing\n");
        text.into_bytes()
    }

    fn ply_header(&self, format: &str) -> String {
        format!(
            "ply\nformat {format} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
             element face {}\nproperty list uchar int vertex_indices\nend_header\n",
            self.points.len(),
            self.faces.len()
        )
    }

    pub(crate) fn ply(&self) -> Vec<u8> {
        let mut text = self.ply_header("ascii");
        for p in &self.points {
            let _ = writeln!(text, "{:.6} {:.6} {:.6}", p.x, p.y, p.z);
        }
        for [a, b, c] in &self.faces {
            let _ = writeln!(text, "3 {a} {b} {c}");
        }
        text.into_bytes()
    }

    pub(crate) fn ply_binary(&self) -> Vec<u8> {
        let mut bytes = self.ply_header("binary_little_endian").into_bytes();
        for p in &self.points {
            bytes.extend([p.x, p.y, p.z].iter().flat_map(|x| (*x as f32).to_le_bytes()));
        }
        for face in &self.faces {
            bytes.push(3);
            bytes.extend(face.iter().flat_map(|v| v.to_le_bytes()));
        }
        bytes
    }

    /// In meters with Y up, as the standard wants, from millimeters with Z up.
    pub(crate) fn glb(&self) -> Vec<u8> {
        let mut data = Vec::new();
        let to_y = |p: &DVec3| [p.x / 1000.0, p.z / 1000.0, -p.y / 1000.0];
        for p in &self.points {
            data.extend(to_y(p).iter().flat_map(|x| (*x as f32).to_le_bytes()));
        }
        let split = data.len();
        data.extend(self.faces.iter().flatten().flat_map(|v| v.to_le_bytes()));
        let (low, high) =
            self.points.iter().map(to_y).fold(([f64::MAX; 3], [f64::MIN; 3]), |(mut l, mut h), p| {
                for k in 0..3 {
                    (l[k], h[k]) = (l[k].min(f64::from(p[k] as f32)), h[k].max(f64::from(p[k] as f32)));
                }
                (l, h)
            });
        let mut json = format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3","min":{low:?},"max":{high:?}}},
            {{"bufferView":1,"componentType":5125,"count":{},"type":"SCALAR"}}],
            "bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":{split}}},
            {{"buffer":0,"byteOffset":{split},"byteLength":{}}}],"buffers":[{{"byteLength":{}}}]}}"#,
            self.points.len(),
            3 * self.faces.len(),
            data.len() - split,
            data.len()
        );
        while !json.len().is_multiple_of(4) {
            json.push(' ');
        }
        let mut bytes = b"glTF\x02\0\0\0".to_vec();
        bytes.extend((28 + json.len() as u32 + data.len() as u32).to_le_bytes());
        bytes.extend((json.len() as u32).to_le_bytes());
        bytes.extend(b"JSON");
        bytes.extend(json.bytes());
        bytes.extend((data.len() as u32).to_le_bytes());
        bytes.extend(b"BIN\0");
        bytes.extend(data);
        bytes
    }
}

/// A level circle.
pub(crate) fn circle(radius: f64, height: f64, count: u32) -> Vec<DVec3> {
    let at = |k: u32| {
        let angle = TAU * f64::from(k) / f64::from(count);
        DVec3::new(radius * cos(angle), radius * sin(angle), height)
    };
    (0..count).map(at).collect()
}

/// Distance from a capsule: a segment with a radius.
pub(crate) fn capsule(p: DVec3, a: DVec3, b: DVec3, radius: f64) -> f64 {
    let along = b - a;
    let t = if along == DVec3::ZERO {
        0.0
    } else {
        ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0)
    };
    p.distance(a + along * t) - radius
}

/// The smaller of two distances, rounded over `soft` where they meet.
pub(crate) fn union(a: f64, b: f64, soft: f64) -> f64 {
    let h = (0.5 + 0.5 * (b - a) / soft).clamp(0.0, 1.0);
    b + (a - b) * h - soft * h * (1.0 - h)
}
