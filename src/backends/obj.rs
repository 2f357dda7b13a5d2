//! Triangles for modeling programs: Wavefront OBJ, in mm, with an object a part and a group a round.

use super::{Backend, Error, Format};
use crate::diag::Sink;
use crate::ir::verify::Verified;
use crate::preview::Model;
use serde::Deserialize;
use std::io::{self, Write};

/// Options of the target `obj`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(transparent)]
pub struct Obj(pub Model);

/// Triangles beyond which the detail goes down by itself.
const BUDGET: u64 = 600_000;

impl Backend for Obj {
    fn emit(&self, program: &Verified<'_>, out: &mut dyn Write, sink: &mut Sink<'_>) -> Result<(), Error> {
        let (scene, mesh) =
            self.0.lay(program, BUDGET, sink).map_err(|what| Error::refused(Self::NAME, &what))?;
        let mut out = io::BufWriter::with_capacity(1 << 16, out);
        writeln!(out, "# {}, in mm; made by Picot", word(&scene.name))?;
        for [x, y, z] in &mesh.positions {
            writeln!(out, "v {x:.4} {y:.4} {z:.4}")?;
        }
        for [x, y, z] in &mesh.normals {
            writeln!(out, "vn {x:.3} {y:.3} {z:.3}")?;
        }
        let (mut piece, mut round) = (None, None);
        for triangle in &mesh.triangles {
            let stitch =
                mesh.stitches.get(triangle[0] as usize).and_then(|k| scene.stitches.get(*k as usize));
            let Some(stitch) = stitch else { continue };
            if piece.replace(stitch.piece) != Some(stitch.piece) {
                let name = scene.pieces.get(stitch.piece as usize).map_or("", |piece| piece.name.as_str());
                writeln!(out, "o {}_{}", word(name), stitch.piece + 1)?;
                round = None;
            }
            if round.replace(stitch.round) != Some(stitch.round) {
                writeln!(out, "g piece_{}_round_{}", stitch.piece + 1, stitch.round)?;
            }
            let [a, b, c] = triangle.map(|k| k + 1);
            writeln!(out, "f {a}//{a} {b}//{b} {c}//{c}")?;
        }
        out.flush()?;
        Ok(())
    }
}

/// A name as one word.
fn word(name: &str) -> String {
    let plain = |c: char| if c.is_whitespace() || c.is_control() { '_' } else { c };
    let word: String = name.chars().map(plain).collect();
    if word.is_empty() { "part".to_owned() } else { word }
}

impl Format for Obj {
    const NAME: &'static str = "obj";
    const EXTENSION: &'static str = "obj";
    const ABOUT: &'static str = "the finished object as triangles, for modeling programs";
}
