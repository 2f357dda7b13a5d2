//! The object as binary glTF 2.0: a mesh a piece, a material a color, and what each stitch is.

use super::crochet::words::Words;
use super::crochet::{Arrows, Terms};
use super::{Backend, Error, Format};
use crate::diag::Sink;
use crate::ir::verify::Verified;
use crate::ir::{Hand, Language};
use crate::preview::{Mesh, Model, Scene, Stitch, View, kind_color};
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::{self, Write};

/// Options of the target `gltf`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(transparent)]
pub struct Gltf(pub Model);

/// Triangles beyond which the detail goes down by itself.
const BUDGET: u64 = 1_000_000;
/// Most bytes of a file: its lengths are 32 bits.
const MAX_BYTES: usize = 1 << 30;

impl Backend for Gltf {
    fn emit(&self, program: &Verified<'_>, out: &mut dyn Write, sink: &mut Sink<'_>) -> Result<(), Error> {
        let (scene, mesh) =
            self.0.lay(program, BUDGET, sink).map_err(|what| Error::refused(Self::NAME, &what))?;
        let (mut document, bytes) = File::new(&scene, &mesh, self.0.view).finish();
        if let Some(object) = document["nodes"].as_array_mut().and_then(|nodes| nodes.last_mut()) {
            object["extras"] = json!({ "picot": extras(program, &scene) });
        }
        let mut text = document.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let total = 12 + 8 + text.len() + 8 + bytes.len();
        if total > MAX_BYTES {
            let what = format!("{total} bytes are more than {MAX_BYTES}; lower `detail` (1 to 5)");
            return Err(Error::Unsupported { backend: Self::NAME, what });
        }
        let mut out = io::BufWriter::with_capacity(1 << 16, out);
        let number = |value: usize| (value as u32).to_le_bytes();
        out.write_all(b"glTF")?;
        out.write_all(&number(2))?;
        out.write_all(&number(total))?;
        out.write_all(&number(text.len()))?;
        out.write_all(b"JSON")?;
        out.write_all(&text)?;
        out.write_all(&number(bytes.len()))?;
        out.write_all(b"BIN\0")?;
        out.write_all(&bytes)?;
        out.flush()?;
        Ok(())
    }
}

impl Format for Gltf {
    const NAME: &'static str = "gltf";
    const EXTENSION: &'static str = "glb";
    const ABOUT: &'static str =
        "the finished object with materials and stitch data, for viewers (binary glTF)";
    const BINARY: bool = true;
}

/// The pattern in words, with the gauge.
fn extras(program: &Verified<'_>, scene: &Scene) -> Value {
    let parts = program.pattern.parts.iter().zip(&program.facts().parts).map(|(part, facts)| {
        let words = Words::new(program, part, Terms::Us, Language::English, Arrows::Unicode);
        let rounds = part.rows.iter().zip(&facts.rows).map(|(row, counts)| {
            json!({
                "first": counts.number,
                "last": counts.number.saturating_add(row.times - 1),
                "stitches": counts.produces,
                "text": words.row(&row.body, false),
            })
        });
        let rounds: Vec<Value> = rounds.collect();
        json!({ "name": part.name, "copies": part.copies, "rounds": rounds })
    });
    let parts: Vec<Value> = parts.collect();
    let [width, height] = scene.gauge;
    let mut extras = json!({
        "schema": "picot.model/1",
        "version": env!("CARGO_PKG_VERSION"),
        "name": program.name,
        "unit": "mm",
        "stitches": program.facts().stitches(program),
        "gauge": { "width": width, "height": height, "assumed": scene.gauge_assumed },
        "positions": scene.origin(),
        "yarn": { "thickness": scene.yarn, "interpenetrating": true },
        "kinds": kinds(scene).into_keys().collect::<Vec<_>>(),
        "parts": parts,
    });
    if program.maker.hand == Hand::Left {
        extras["hand"] = program.maker.hand.word().into();
    }
    if program.maker.lean != 0.0 {
        extras["lean"] = program.maker.lean.into();
    }
    extras
}

/// What stitches are, by name, with the number that stands for it.
fn kinds(scene: &Scene) -> BTreeMap<String, usize> {
    let mut roles: Vec<String> = Vec::new();
    let mut last = None;
    for stitch in &scene.stitches {
        if last.replace(stitch.role) != Some(stitch.role) {
            roles.push(stitch.role.to_string());
        }
    }
    roles.sort();
    roles.dedup();
    roles.into_iter().enumerate().map(|(index, name)| (name, index)).collect()
}

/// The document and its buffer while they grow.
struct File {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
    materials: Vec<Value>,
}

const FLOAT: u32 = 5126;
const UNSIGNED: u32 = 5125;

impl File {
    fn new(scene: &Scene, mesh: &Mesh, view: View) -> Self {
        let mut file = Self {
            bytes: Vec::with_capacity(mesh.positions.len() * 36 + mesh.triangles.len() * 12),
            views: Vec::new(),
            accessors: Vec::new(),
            meshes: Vec::new(),
            nodes: Vec::new(),
            materials: Vec::new(),
        };
        let color = |stitch: &Stitch| match view {
            View::Realistic => scene.colors.get(usize::from(stitch.color)).copied().unwrap_or_default(),
            View::Wireframe => kind_color(stitch.role),
        };
        let mut colors: BTreeMap<[u8; 3], usize> =
            scene.stitches.iter().map(|stitch| (color(stitch), 0)).collect();
        for (index, (color, number)) in colors.iter_mut().enumerate() {
            *number = index;
            file.material(*color);
        }
        let kinds = kinds(scene);
        let kind: Vec<f32> = kinds_of(scene, &kinds);
        for (index, piece) in scene.pieces.iter().enumerate() {
            let Some(part) = mesh.pieces.get(index).filter(|part| !part.triangles.is_empty()) else {
                continue;
            };
            let vertices = part.vertices.clone();
            let positions = &mesh.positions[vertices.clone()];
            let stitches = &mesh.stitches[vertices.clone()];
            let of = |stitch: &u32| scene.stitches.get(*stitch as usize);
            let position = file.floats3(positions, true);
            let normal = file.floats3(&mesh.normals[vertices.clone()], false);
            let number = file.floats(stitches.iter().map(|stitch| *stitch as f32), stitches.len());
            let round =
                file.floats(stitches.iter().map(|k| of(k).map_or(0.0, |s| s.round as f32)), stitches.len());
            let kind = file.floats(
                stitches.iter().map(|k| kind.get(*k as usize).copied().unwrap_or(0.0)),
                stitches.len(),
            );
            let mut by_color: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
            let first = vertices.start as u32;
            for triangle in &mesh.triangles[part.triangles.clone()] {
                let stitch = mesh.stitches.get(triangle[0] as usize).and_then(of);
                let material = stitch.and_then(|stitch| colors.get(&color(stitch))).copied().unwrap_or(0);
                by_color.entry(material).or_default().extend(triangle.map(|k| k - first));
            }
            let primitives = by_color.into_iter().map(|(material, indices)| {
                let indices = file.indices(&indices);
                json!({
                    "attributes": {
                        "POSITION": position, "NORMAL": normal, "_STITCH": number, "_ROUND": round, "_KIND": kind,
                    },
                    "indices": indices,
                    "material": material,
                })
            });
            let primitives: Vec<Value> = primitives.collect();
            file.nodes.push(json!({ "name": piece.name, "mesh": file.meshes.len() }));
            file.meshes.push(json!({ "name": piece.name, "primitives": primitives }));
        }
        file
    }

    /// A rough material without metal.
    fn material(&mut self, color: [u8; 3]) {
        let [red, green, blue] =
            color.map(|byte| (f64::from(byte) / 255.0 * f64::from(byte) / 255.0 * 1e4).round() / 1e4);
        self.materials.push(json!({
            "name": format!("#{:02x}{:02x}{:02x}", color[0], color[1], color[2]),
            "pbrMetallicRoughness": {
                "baseColorFactor": [red, green, blue, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9,
            },
        }));
    }

    /// Adds a view over the bytes since `start`.
    fn view(&mut self, start: usize, target: u32) -> usize {
        let length = self.bytes.len() - start;
        self.views.push(json!({ "buffer": 0, "byteOffset": start, "byteLength": length, "target": target }));
        self.views.len() - 1
    }

    fn accessor(&mut self, value: Value) -> usize {
        self.accessors.push(value);
        self.accessors.len() - 1
    }

    fn floats3(&mut self, values: &[[f32; 3]], bounds: bool) -> usize {
        let start = self.bytes.len();
        let (mut low, mut high) = ([f32::MAX; 3], [f32::MIN; 3]);
        for value in values {
            for (k, number) in value.iter().enumerate() {
                low[k] = low[k].min(*number);
                high[k] = high[k].max(*number);
                self.bytes.extend(number.to_le_bytes());
            }
        }
        let view = self.view(start, 34962);
        let mut accessor =
            json!({ "bufferView": view, "componentType": FLOAT, "count": values.len(), "type": "VEC3" });
        if bounds {
            accessor["min"] = json!(low.map(f64::from));
            accessor["max"] = json!(high.map(f64::from));
        }
        self.accessor(accessor)
    }

    fn floats(&mut self, values: impl Iterator<Item = f32>, count: usize) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(values.flat_map(f32::to_le_bytes));
        let view = self.view(start, 34962);
        self.accessor(json!({ "bufferView": view, "componentType": FLOAT, "count": count, "type": "SCALAR" }))
    }

    fn indices(&mut self, indices: &[u32]) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(indices.iter().flat_map(|index| index.to_le_bytes()));
        let view = self.view(start, 34963);
        self.accessor(
            json!({ "bufferView": view, "componentType": UNSIGNED, "count": indices.len(), "type": "SCALAR" }),
        )
    }

    /// The document without extras, and the buffer. glTF is in meters with y up.
    fn finish(mut self) -> (Value, Vec<u8>) {
        let children: Vec<usize> = (0..self.nodes.len()).collect();
        let half = std::f64::consts::FRAC_1_SQRT_2;
        self.nodes.push(json!({
            "name": "object", "children": children, "rotation": [-half, 0.0, 0.0, half], "scale": [0.001, 0.001, 0.001],
        }));
        let document = json!({
            "asset": { "version": "2.0", "generator": concat!("Picot ", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [{ "nodes": [self.nodes.len() - 1] }],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "materials": self.materials,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{ "byteLength": self.bytes.len() }],
        });
        (document, self.bytes)
    }
}

/// The number of each stitch's kind.
fn kinds_of(scene: &Scene, kinds: &BTreeMap<String, usize>) -> Vec<f32> {
    let mut last: Option<(crate::preview::Role, f32)> = None;
    let number = |stitch: &Stitch| match last {
        Some((role, number)) if role == stitch.role => number,
        _ => {
            let number = kinds.get(&stitch.role.to_string()).map_or(0.0, |k| *k as f32);
            last = Some((stitch.role, number));
            number
        }
    };
    scene.stitches.iter().map(number).collect()
}
