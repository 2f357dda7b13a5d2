//! A picture, from Picot's own renderer.

use super::{Backend, Error, Format};
use crate::diag::Sink;
use crate::ir::verify::Verified;
use crate::preview::{Camera, Model, Places, Refused, View, picture};
use serde::{Deserialize, Deserializer, de};
use std::io::{self, Write};

/// Options of the target `png`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Png {
    /// Yarn or tiles.
    pub view: View,
    /// Fineness of the yarn, 1 to 5.
    pub detail: Option<u8>,
    /// Width and height in pixels, as `1000x750`.
    #[serde(deserialize_with = "size")]
    pub size: [u32; 2],
    /// Degrees around, from the front to the right.
    pub azimuth: f64,
    /// Degrees above.
    pub elevation: f64,
    /// Thickness of the yarn in mm.
    pub yarn: Option<f64>,
    /// Where the stitches are drawn.
    pub places: Places,
}

impl Default for Png {
    fn default() -> Self {
        let Camera { azimuth, elevation } = Camera::default();
        Self {
            view: View::default(),
            detail: None,
            size: [1000, 750],
            azimuth,
            elevation,
            yarn: None,
            places: Places::default(),
        }
    }
}

/// Triangles beyond which a picture shows no more.
const BUDGET: u64 = 2_000_000;
const BACKGROUND: [u8; 3] = [246, 243, 238];

impl Backend for Png {
    fn emit(&self, program: &Verified<'_>, out: &mut dyn Write, sink: &mut Sink<'_>) -> Result<(), Error> {
        let refused = |what: Refused| Error::refused(Self::NAME, &what);
        let model = Model { view: self.view, detail: self.detail, yarn: self.yarn, places: self.places };
        let (scene, mesh) = model.lay(program, BUDGET, sink).map_err(refused)?;
        let camera = Camera { azimuth: self.azimuth, elevation: self.elevation };
        let picture = picture(&scene, &mesh, self.view, camera, self.size, BACKGROUND).map_err(refused)?;
        let mut encoder = png::Encoder::new(out, picture.width, picture.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let wrong = |error: png::EncodingError| io::Error::other(error);
        let mut writer = encoder.write_header().map_err(wrong)?;
        writer.write_image_data(&picture.pixels).map_err(wrong)?;
        writer.finish().map_err(wrong)?;
        Ok(())
    }
}

impl Format for Png {
    const NAME: &'static str = "png";
    const EXTENSION: &'static str = "png";
    const ABOUT: &'static str = "a picture of the finished object";
    const BINARY: bool = true;
}

fn size<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[u32; 2], D::Error> {
    let text = String::deserialize(deserializer)?;
    let (width, height) = text
        .split_once(['x', 'X'])
        .ok_or_else(|| de::Error::custom("expected WIDTHxHEIGHT, such as 1000x750"))?;
    match (width.trim().parse(), height.trim().parse()) {
        (Ok(width @ 1..=8192), Ok(height @ 1..=8192)) => Ok([width, height]),
        _ => Err(de::Error::custom("a picture is 1 to 8192 pixels wide and high")),
    }
}
