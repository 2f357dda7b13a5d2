//! Triangles for slicers and CAD: binary STL, in mm.

use super::{Backend, Error, Format};
use crate::diag::Sink;
use crate::ir::verify::Verified;
use crate::preview::Model;
use glam::Vec3;
use serde::Deserialize;
use std::io::{self, Write};

/// Options of the target `stl`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(transparent)]
pub struct Stl(pub Model);

/// Triangles beyond which the detail goes down by itself: 50 MB.
const BUDGET: u64 = 1_000_000;

impl Backend for Stl {
    fn emit(&self, program: &Verified<'_>, out: &mut dyn Write, sink: &mut Sink<'_>) -> Result<(), Error> {
        let (_, mesh) =
            self.0.lay(program, BUDGET, sink).map_err(|what| Error::refused(Self::NAME, &what))?;
        let mut out = io::BufWriter::with_capacity(1 << 16, out);
        // Readers take a file that begins with `solid` for text.
        let mut header = [b' '; 80];
        header[..20].copy_from_slice(b"Picot, binary STL, m");
        header[20] = b'm';
        out.write_all(&header)?;
        out.write_all(&(mesh.triangles.len() as u32).to_le_bytes())?;
        for triangle in &mesh.triangles {
            let corners = triangle.map(|k| mesh.positions[k as usize]);
            let [a, b, c] = corners.map(Vec3::from_array);
            let normal = (b - a).cross(c - a).normalize_or_zero().to_array();
            let mut facet = [0; 50];
            let numbers = normal.into_iter().chain(corners.into_iter().flatten());
            for (place, number) in facet.chunks_exact_mut(4).zip(numbers) {
                place.copy_from_slice(&number.to_le_bytes());
            }
            out.write_all(&facet)?;
        }
        out.flush()?;
        Ok(())
    }
}

impl Format for Stl {
    const NAME: &'static str = "stl";
    const EXTENSION: &'static str = "stl";
    const ABOUT: &'static str = "the finished object as closed triangles, for slicers and CAD";
    const BINARY: bool = true;
}
