//! The rasterizer: triangles to a buffer with the nearest surface at each pixel.

use super::camera::Lens;
use super::mesh::Mesh;
use glam::Vec3;

/// What lies at each pixel.
#[derive(Debug)]
pub(super) struct Buffer {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Distance from the eye; infinite where there is nothing.
    pub(super) depth: Vec<f32>,
    /// Normals as the eye sees them, in 127ths.
    pub(super) normal: Vec<[i8; 3]>,
    /// Lightness of the yarn's strands, 0 to 255, with 128 for plain.
    pub(super) grain: Vec<u8>,
    /// Stitch of the surface.
    pub(super) stitch: Vec<u32>,
}

impl Buffer {
    /// An empty buffer.
    pub(super) fn new(width: usize, height: usize) -> Self {
        let pixels = width * height;
        Self {
            width,
            height,
            depth: vec![f32::INFINITY; pixels],
            normal: vec![[0; 3]; pixels],
            grain: vec![128; pixels],
            stitch: vec![u32::MAX; pixels],
        }
    }

    /// Draws all triangles that face the eye.
    pub(super) fn draw(&mut self, mesh: &Mesh, lens: &Lens) {
        let projected: Vec<[f32; 3]> = mesh.positions.iter().map(|point| lens.project(*point)).collect();
        let turned: Vec<Vec3> = mesh.normals.iter().map(|normal| lens.turn(*normal)).collect();
        for triangle in &mesh.triangles {
            let at = triangle.map(|k| k as usize);
            let corners = at.map(|k| projected[k]);
            let normals = at.map(|k| turned[k]);
            let mut twist = at.map(|k| mesh.twist.get(k).copied().unwrap_or(f32::NAN));
            for k in 1..3 {
                // The twist is periodic, and jumps where it closes around the yarn or a whole turn of it.
                let jump = ((twist[0] - twist[k]) / (2.0 * TURN)).round();
                twist[k] += jump * 2.0 * TURN;
            }
            self.triangle(corners, normals, twist, mesh.stitches[at[0]]);
        }
    }

    fn triangle(&mut self, [a, b, c]: [[f32; 3]; 3], normals: [Vec3; 3], twist: [f32; 3], stitch: u32) {
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        // Rows run downward, so what turns left in space has a negative area here.
        if area >= -1e-12 {
            return;
        }
        let low = |axis: usize| a[axis].min(b[axis]).min(c[axis]);
        let high = |axis: usize| a[axis].max(b[axis]).max(c[axis]);
        let clip = |value: f32, end: usize| (value.max(0.0) as usize).min(end);
        let (left, right) =
            (clip((low(0) - 0.5).ceil(), self.width), clip((high(0) + 0.5).floor(), self.width));
        let (top, bottom) =
            (clip((low(1) - 0.5).ceil(), self.height), clip((high(1) + 0.5).floor(), self.height));
        let scale = 1.0 / area;
        for row in top..bottom {
            let y = row as f32 + 0.5;
            for column in left..right {
                let x = column as f32 + 0.5;
                let wa = ((b[0] - x) * (c[1] - y) - (b[1] - y) * (c[0] - x)) * scale;
                let wb = ((c[0] - x) * (a[1] - y) - (c[1] - y) * (a[0] - x)) * scale;
                let wc = 1.0 - wa - wb;
                if wa < 0.0 || wb < 0.0 || wc < 0.0 {
                    continue;
                }
                let depth = wa * a[2] + wb * b[2] + wc * c[2];
                let pixel = row * self.width + column;
                if depth >= self.depth[pixel] {
                    continue;
                }
                self.depth[pixel] = depth;
                let normal =
                    (normals[0] * wa + normals[1] * wb + normals[2] * wc).normalize_or_zero() * 127.0;
                self.normal[pixel] = [normal.x as i8, normal.y as i8, normal.z as i8];
                let phase = wa * twist[0] + wb * twist[1] + wc * twist[2];
                self.grain[pixel] = if phase.is_nan() { 128 } else { (128.0 + 100.0 * wave(phase)) as u8 };
                self.stitch[pixel] = stitch;
            }
        }
    }
}

/// A full turn.
const TURN: f32 = std::f32::consts::TAU;

/// A smooth wave of period 2 pi between -1 and 1: parabolas in place of a sine.
fn wave(phase: f32) -> f32 {
    let turns = phase / TURN;
    let x = 2.0 * (turns - turns.floor()) - 1.0;
    4.0 * x * (1.0 - x.abs())
}
