//! Triangles: a scene's tiles as boxes, or its yarn as a closed tube, at a level of detail.

use super::scene::{Places, Refused, Scene, Stitch};
use super::sweep;
use crate::diag::Sink;
use crate::ir::verify::Verified;
use glam::{DVec3, Vec3};
use serde::Deserialize;
use std::ops::Range;

/// What is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum View {
    /// The yarn itself.
    #[default]
    Realistic,
    /// One tile a stitch, with gaps between them, colored by what they are.
    Wireframe,
}

/// How fine the yarn is drawn. Each level has a number of points on a curve and around the yarn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Detail {
    /// Curves that are drawn as one.
    pub(super) stride: usize,
    /// Straight pieces a curve.
    pub(super) steps: usize,
    /// Corners around the yarn.
    pub(super) sides: usize,
}

impl Detail {
    /// The levels, coarse to fine.
    const LEVELS: [Self; 5] = [
        Self { stride: 3, steps: 1, sides: 3 },
        Self { stride: 1, steps: 1, sides: 4 },
        Self { stride: 1, steps: 2, sides: 5 },
        Self { stride: 1, steps: 2, sides: 8 },
        Self { stride: 1, steps: 4, sides: 10 },
    ];

    /// Triangles of a yarn of so many curves.
    fn triangles(self, curves: usize) -> u64 {
        (curves.div_ceil(self.stride) * self.steps * self.sides * 2) as u64
    }
}

/// Most triangles that are ever made.
pub const MAX_TRIANGLES: u64 = 12_000_000;

/// What is shown of a pattern as triangles; the options of the targets that write them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Model {
    /// Yarn or tiles.
    pub view: View,
    /// Fineness of the yarn, 1 to 5.
    pub detail: Option<u8>,
    /// Thickness of the yarn in mm.
    pub yarn: Option<f64>,
    /// Where the stitches are drawn.
    pub places: Places,
}

impl Model {
    /// The scene with its triangles; beyond `budget` of these the detail goes down by itself.
    pub fn lay(
        &self,
        program: &Verified<'_>,
        budget: u64,
        sink: &mut Sink<'_>,
    ) -> Result<(Scene, Mesh), Refused> {
        let scene = Scene::new(program, self.yarn, self.places, sink)?;
        scene.remark(sink);
        let mesh = Mesh::of(&scene, self.view, self.detail, budget)?;
        Ok((scene, mesh))
    }
}

/// A closed, consistently oriented surface: normals point outward, triangles turn left seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertices in mm.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals of the vertices.
    pub normals: Vec<[f32; 3]>,
    /// The stitch of each vertex, as index in [`Scene::stitches`].
    pub stitches: Vec<u32>,
    /// Twist of the yarn at each vertex, in radians of a double helix; empty for tiles.
    pub twist: Vec<f32>,
    /// Corners of the triangles.
    pub triangles: Vec<[u32; 3]>,
    /// What belongs to each piece of the scene.
    pub pieces: Vec<Part>,
}

/// The vertices and triangles of one piece.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// Range of the vertices.
    pub vertices: Range<usize>,
    /// Range of [`Mesh::triangles`].
    pub triangles: Range<usize>,
}

impl Mesh {
    /// Triangles of a scene. `level` is 1 to 5; without it the finest that stays below `budget` triangles is taken.
    pub fn of(scene: &Scene, view: View, level: Option<u8>, budget: u64) -> Result<Self, Refused> {
        let curves: usize = scene.pieces.iter().map(|piece| piece.yarn.len()).sum();
        if view == View::Wireframe {
            return Ok(Self::tiles(scene));
        }
        let fits = |detail: &&Detail| detail.triangles(curves) <= budget;
        let finest = || Detail::LEVELS[..4].iter().rev().find(fits).unwrap_or(&Detail::LEVELS[0]);
        let detail = *level.map_or_else(finest, |level| &Detail::LEVELS[usize::from(level.clamp(1, 5)) - 1]);
        let triangles = detail.triangles(curves);
        if triangles > MAX_TRIANGLES {
            return Err(Refused::TooFine { triangles });
        }
        let mut mesh = Self::default();
        mesh.reserve((triangles / 2) as usize, triangles as usize);
        for piece in &scene.pieces {
            let from = mesh.ends();
            sweep::tube(&piece.yarn, scene.yarn, detail, &mut mesh);
            mesh.part(from);
        }
        Ok(mesh)
    }

    fn ends(&self) -> [usize; 2] {
        [self.positions.len(), self.triangles.len()]
    }

    fn part(&mut self, [vertices, triangles]: [usize; 2]) {
        let to = self.ends();
        self.pieces.push(Part { vertices: vertices..to[0], triangles: triangles..to[1] });
    }

    fn reserve(&mut self, vertices: usize, triangles: usize) {
        self.positions.reserve(vertices);
        self.normals.reserve(vertices);
        self.stitches.reserve(vertices);
        self.triangles.reserve(triangles);
    }

    /// One box a stitch, a little smaller than its tile.
    fn tiles(scene: &Scene) -> Self {
        let mut mesh = Self::default();
        mesh.reserve(scene.stitches.len() * 24, scene.stitches.len() * 12);
        for piece in &scene.pieces {
            let from = mesh.ends();
            for index in piece.stitches.clone() {
                if let Some(stitch) = scene.stitches.get(index) {
                    mesh.tile(stitch, index as u32);
                }
            }
            mesh.part(from);
        }
        mesh
    }

    /// Adds a box; a tile without a volume has none.
    fn tile(&mut self, stitch: &Stitch, index: u32) {
        const GAP: f64 = 0.05;
        let near = |bit: usize| if bit == 0 { GAP } else { 1.0 - GAP };
        // A tile is thin: two fifths of the fabric.
        let z = |bit: usize| if bit == 0 { 0.3 } else { 0.7 };
        let corners: [DVec3; 8] =
            std::array::from_fn(|k| stitch.map([near(k & 1), near(k >> 1 & 1), z(k >> 2)]));
        let volume = (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(corners[4] - corners[0])
            - (corners[6] - corners[7]).cross(corners[5] - corners[7]).dot(corners[3] - corners[7]);
        let size = corners[0].distance(corners[7]);
        if volume.abs() <= 1e-6 * size * size * size {
            return;
        }
        // Course x wale points inside, so the corners as numbered turn right.
        const FACES: [[usize; 4]; 6] =
            [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
        for face in FACES {
            let mut face = face.map(|k| corners[k].as_vec3());
            if volume > 0.0 {
                face.reverse();
            }
            let normal = (face[2] - face[0]).cross(face[3] - face[1]).normalize_or(Vec3::Z);
            let first = self.positions.len() as u32;
            for corner in face {
                self.vertex(corner, normal, index);
            }
            self.triangles.push([first, first + 1, first + 2]);
            self.triangles.push([first, first + 2, first + 3]);
        }
    }

    pub(super) fn vertex(&mut self, position: Vec3, normal: Vec3, stitch: u32) {
        self.positions.push(position.to_array());
        self.normals.push(normal.to_array());
        self.stitches.push(stitch);
    }

    /// Least and greatest coordinates; `None` without vertices.
    pub fn bounds(&self) -> Option<[[f32; 3]; 2]> {
        let first = *self.positions.first()?;
        Some(self.positions.iter().fold([first, first], |[low, high], point| {
            let pick =
                |of: fn(f32, f32) -> f32, side: [f32; 3]| std::array::from_fn(|k| of(side[k], point[k]));
            [pick(f32::min, low), pick(f32::max, high)]
        }))
    }
}
