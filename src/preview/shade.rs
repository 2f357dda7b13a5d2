//! Light: from what lies at each pixel to a picture, with shade in the hollows, smoothed by averaging.

use super::camera::Camera;
use super::mesh::{Mesh, View};
use super::net::Role;
use super::raster::Buffer;
use super::scene::{Refused, Scene, Stitch};
use crate::ir::Direction;
use glam::Vec3;

/// Pixels as red, green, blue, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Three bytes a pixel.
    pub pixels: Vec<u8>,
}

/// Largest side of a picture.
pub const MAX_SIDE: u32 = 8192;
/// Samples a pixel in each direction.
const SAMPLES: u32 = 2;
/// Pixels beyond which samples are not worth their memory.
const FINE: u64 = 6_000_000;

/// Draws a mesh of a scene.
pub fn picture(
    scene: &Scene,
    mesh: &Mesh,
    view: View,
    camera: Camera,
    size: [u32; 2],
    background: [u8; 3],
) -> Result<Picture, Refused> {
    let [width, height] = size;
    if width == 0 || height == 0 || width > MAX_SIDE || height > MAX_SIDE {
        return Err(Refused::PictureSize);
    }
    let samples = if u64::from(width) * u64::from(height) > FINE { 1 } else { SAMPLES };
    let fine = [width * samples, height * samples];
    let mut buffer = Buffer::new(fine[0] as usize, fine[1] as usize);
    let background = background.map(linear);
    if let Some(bounds) = mesh.bounds() {
        let lens = camera.lens(&mesh.positions, bounds, fine);
        buffer.draw(mesh, &lens);
        let palette: Vec<Vec3> = scene.stitches.iter().map(|stitch| color(scene, stitch, view)).collect();
        let reach = (scene.yarn as f32 * lens.pixels() * 1.2).clamp(2.0, 0.06 * fine[0] as f32);
        let light = Light {
            buffer: &buffer,
            palette,
            reach,
            size: scene.yarn as f32,
            background: Vec3::from_array(background),
        };
        return Ok(light.picture(width, height, samples));
    }
    let light = Light {
        buffer: &buffer,
        palette: Vec::new(),
        reach: 1.0,
        size: 1.0,
        background: Vec3::from_array(background),
    };
    Ok(light.picture(width, height, samples))
}

/// The color of a stitch, linear.
fn color(scene: &Scene, stitch: &Stitch, view: View) -> Vec3 {
    let own = || scene.colors.get(usize::from(stitch.color)).copied().unwrap_or([200, 160, 120]);
    let bytes = match view {
        View::Realistic => own(),
        View::Wireframe => kind_color(stitch.role),
    };
    Vec3::from_array(bytes.map(linear))
}

/// Colors by kind that those who see no red or no green can tell apart (after Okabe and Ito).
pub fn kind_color(role: Role) -> [u8; 3] {
    match role {
        Role::Chain => [150, 150, 150],
        Role::Turn(Direction::Back | Direction::Forward) => [204, 121, 167],
        Role::Close => [120, 120, 120],
        Role::Ring => [214, 200, 170],
        Role::Work(stitch) if stitch.is_increase() => [0, 158, 115],
        Role::Work(stitch) if stitch.is_decrease() => [213, 94, 0],
        Role::Work(stitch) if stitch.kind.height() > 1.5 => [86, 180, 233],
        Role::Work(_) => [224, 212, 186],
    }
}

struct Light<'b> {
    buffer: &'b Buffer,
    palette: Vec<Vec3>,
    /// How far hollows are looked for, in samples.
    reach: f32,
    /// Thickness of the yarn in mm.
    size: f32,
    background: Vec3,
}

impl Light<'_> {
    fn picture(&self, width: u32, height: u32, samples: u32) -> Picture {
        let mut pixels = Vec::with_capacity((width * height * 3) as usize);
        for y in 0..height {
            for x in 0..width {
                let mut sum = Vec3::ZERO;
                for sy in 0..samples {
                    for sx in 0..samples {
                        sum += self.sample((x * samples + sx) as usize, (y * samples + sy) as usize);
                    }
                }
                let color = sum / (samples * samples) as f32;
                pixels.extend(color.to_array().map(byte));
            }
        }
        Picture { width, height, pixels }
    }

    fn sample(&self, x: usize, y: usize) -> Vec3 {
        let buffer = self.buffer;
        let pixel = y * buffer.width + x;
        let stitch = buffer.stitch[pixel];
        if stitch == u32::MAX {
            return self.background;
        }
        let base = self.palette.get(stitch as usize).copied().unwrap_or(Vec3::splat(0.5));
        let [nx, ny, nz] = buffer.normal[pixel].map(|part| f32::from(part) / 127.0);
        let normal = Vec3::new(nx, ny, nz);
        const KEY: Vec3 = Vec3::new(-0.48, 0.66, 0.58);
        const FILL: Vec3 = Vec3::new(0.75, 0.10, 0.65);
        // Light that wraps around, as it does in fluff.
        let wrap = |light: Vec3| ((normal.dot(light) + 0.25) / 1.25).max(0.0);
        let sky = 0.5 + 0.5 * normal.y;
        let open = self.open(x, y, buffer.depth[pixel]);
        let grain = 1.0 + (f32::from(buffer.grain[pixel]) - 128.0) / 128.0 * 0.20;
        let light = 0.80 * wrap(KEY) * (0.45 + 0.55 * open) + (0.16 * wrap(FILL) + 0.14 + 0.16 * sky) * open;
        // Yarn is lighter at its rim.
        let rim = (1.0 - normal.z.clamp(0.0, 1.0)).powi(3) * 0.10 * open;
        base * (light * grain) + Vec3::splat(rim) * base
    }

    /// How much of the surroundings is no nearer to the eye: 1 in the open, less in a hollow.
    fn open(&self, x: usize, y: usize, depth: f32) -> f32 {
        // Directions on three circles, turned from pixel to pixel.
        const WAYS: [[f32; 2]; 12] = [
            [1.0, 0.0],
            [0.5, 0.866],
            [-0.5, 0.866],
            [-1.0, 0.0],
            [-0.5, -0.866],
            [0.5, -0.866],
            [0.55, 0.32],
            [0.0, 0.64],
            [-0.55, 0.32],
            [-0.55, -0.32],
            [0.0, -0.64],
            [0.55, -0.32],
        ];
        let turn = ((x * 7 + y * 3) % 4) as f32 * 0.13;
        let mut hidden = 0.0;
        for (index, way) in WAYS.iter().enumerate() {
            let reach = self.reach * if index % 2 == 0 { 1.0 } else { 2.2 };
            let dx = (way[0] - turn * way[1]) * reach;
            let dy = (way[1] + turn * way[0]) * reach;
            let (px, py) = (x as f32 + dx, y as f32 + dy);
            if px < 0.0 || py < 0.0 || px >= self.buffer.width as f32 || py >= self.buffer.height as f32 {
                continue;
            }
            let nearer = depth - self.buffer.depth[py as usize * self.buffer.width + px as usize];
            if nearer > 0.08 * self.size {
                // What is far in front hides little.
                let far = nearer / (3.0 * self.size);
                hidden += (nearer / self.size).min(1.0) / (1.0 + far * far);
            }
        }
        (1.0 - 0.95 * hidden / WAYS.len() as f32).clamp(0.05, 1.0)
    }
}

/// sRGB to linear, by its square.
fn linear(byte: u8) -> f32 {
    let share = f32::from(byte) / 255.0;
    share * share
}

/// Linear to sRGB, by the root.
fn byte(value: f32) -> u8 {
    (value.clamp(0.0, 1.0).sqrt() * 255.0 + 0.5) as u8
}
