//! From where a picture is taken: a mild perspective from the front, the side and a little above.

use crate::math::sin_cos;
use glam::{DVec3, Vec3};

/// A place to look from. z is up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Degrees around, from the front (-y) to the right (+x).
    pub azimuth: f64,
    /// Degrees above.
    pub elevation: f64,
}

impl Default for Camera {
    fn default() -> Self {
        Self { azimuth: 32.0, elevation: 24.0 }
    }
}

/// Where points come to lie in a picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lens {
    right: Vec3,
    up: Vec3,
    /// From the scene to the eye.
    back: Vec3,
    center: Vec3,
    distance: f32,
    scale: f32,
    middle: [f32; 2],
}

/// Distance of the eye in radii of the scene.
const DISTANCE: f32 = 4.5;
/// Part of the picture that stays free on each side.
const MARGIN: f32 = 0.06;

impl Camera {
    /// A lens that shows all points in a picture of this size.
    pub(super) fn lens(self, points: &[[f32; 3]], bounds: [[f32; 3]; 2], [width, height]: [u32; 2]) -> Lens {
        let (sin_a, cos_a) = sin_cos(self.azimuth.to_radians());
        let (sin_e, cos_e) = sin_cos(self.elevation.to_radians());
        let back = DVec3::new(sin_a * cos_e, -cos_a * cos_e, sin_e);
        let right = DVec3::new(cos_a, sin_a, 0.0);
        let up = back.cross(right);
        let [low, high] = bounds.map(Vec3::from_array);
        let center = (low + high) * 0.5;
        let radius = (high - low).length().max(1e-6) * 0.5;
        let mut lens = Lens {
            right: right.as_vec3(),
            up: up.as_vec3(),
            back: back.as_vec3(),
            center,
            distance: DISTANCE * radius,
            scale: 1.0,
            middle: [0.0, 0.0],
        };
        let mut ends = [[f32::MAX; 2], [f32::MIN; 2]];
        for point in points {
            let [x, y, _] = lens.project(*point);
            for (axis, value) in [x, y].into_iter().enumerate() {
                ends[0][axis] = ends[0][axis].min(value);
                ends[1][axis] = ends[1][axis].max(value);
            }
        }
        let room = 1.0 - 2.0 * MARGIN;
        let extent = |axis: usize| (ends[1][axis] - ends[0][axis]).max(1e-9);
        let (width, height) = (width as f32, height as f32);
        lens.scale = (room * width / extent(0)).min(room * height / extent(1));
        let middle = |axis: usize| 0.5 * (ends[0][axis] + ends[1][axis]) * lens.scale;
        lens.middle = [0.5 * width - middle(0), 0.5 * height - middle(1)];
        lens
    }
}

impl Lens {
    /// Picture coordinates in pixels, and the distance from the eye's plane in mm, growing away.
    pub(super) fn project(&self, point: [f32; 3]) -> [f32; 3] {
        let from = Vec3::from_array(point) - self.center;
        let depth = self.distance - from.dot(self.back);
        let zoom = self.scale * self.distance / depth;
        [from.dot(self.right) * zoom + self.middle[0], -from.dot(self.up) * zoom + self.middle[1], depth]
    }
    /// A direction as the eye sees it: right, up, towards it.
    pub(super) fn turn(&self, direction: [f32; 3]) -> Vec3 {
        let direction = Vec3::from_array(direction);
        Vec3::new(direction.dot(self.right), direction.dot(self.up), direction.dot(self.back))
    }
    /// Pixels of a millimeter in the middle of the scene.
    pub(super) fn pixels(&self) -> f32 {
        self.scale
    }
}
