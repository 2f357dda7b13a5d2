//! glTF 2.0 through `gltf`: all triangles of the default scene, placed by their nodes.

use super::MOST;
use crate::diag::{Code, Diagnostic, Source, Sources};
use crate::shape::mesh::Soup;
use glam::{DMat4, DVec3};
use gltf::accessor::{Accessor, DataType, Dimensions};
use gltf::buffer::Source as Place;
use gltf::mesh::Mode;
use gltf::{Gltf, Node, Semantic};

/// Deepest nesting of nodes.
const DEEPEST: usize = 64;

/// Reads the triangles of a `.gltf` or `.glb` file.
pub(super) fn read(source: &Source, sources: &mut Sources<'_>) -> Result<Soup, Diagnostic> {
    let bytes = source.bytes();
    if bytes.starts_with(b"glTF") {
        let length = bytes.get(8..12).and_then(|b| <[u8; 4]>::try_from(b).ok()).map_or(0, u32::from_le_bytes);
        if (length as usize) < 20 || length as usize > bytes.len() {
            return Err(wrong(format!("the GLB file claims {length} bytes and has {}", bytes.len())));
        }
    }
    let Gltf { document, blob } =
        Gltf::from_slice(bytes).map_err(|error| wrong(format!("the glTF file cannot be read: {error}")))?;
    let mut blob = blob;
    let mut buffers = Vec::new();
    for buffer in document.buffers() {
        buffers.push(match buffer.source() {
            Place::Bin => blob.take().unwrap_or_default(),
            Place::Uri(uri) => load(uri, source, sources)?,
        });
    }
    let mut scene = Scene { buffers, soup: Soup::default(), polygons: 0 };
    let Some(chosen) = document.default_scene().or_else(|| document.scenes().next()) else {
        return Err(wrong("the glTF file has no scene"));
    };
    for node in chosen.nodes() {
        scene.node(&node, DMat4::IDENTITY, 0)?;
    }
    Ok(scene.soup)
}

/// A buffer beside the file, or within its text.
fn load(uri: &str, source: &Source, sources: &mut Sources<'_>) -> Result<Vec<u8>, Diagnostic> {
    if let Some(rest) = uri.strip_prefix("data:") {
        let data = rest.split_once(";base64,").and_then(|(_, data)| base64(data));
        return data.ok_or_else(|| wrong("a buffer within the glTF file is no base64"));
    }
    let name = super::super::beside(source.name(), uri);
    let bytes = sources.open(&name).map_err(|error| {
        Diagnostic::new(
            Code::FileFails,
            format!("the buffer `{name}` of the glTF file cannot be read: {error}"),
        )
        .help("keep it beside the .gltf file, or export as .glb")
    })?;
    Ok(bytes.bytes().to_vec())
}

fn base64(text: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut count) = (0_u32, 0);
    for byte in text.bytes().filter(|byte| *byte != b'=') {
        let digit = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            _ => return None,
        };
        bits = bits << 6 | u32::from(digit);
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    Some(bytes)
}

struct Scene {
    buffers: Vec<Vec<u8>>,
    soup: Soup,
    polygons: u32,
}

impl Scene {
    fn node(&mut self, node: &Node<'_>, above: DMat4, depth: usize) -> Result<(), Diagnostic> {
        if depth > DEEPEST {
            return Err(wrong(format!("nodes of the glTF file are nested more than {DEEPEST} deep")));
        }
        let own = node.transform().matrix().map(|column| column.map(f64::from));
        let place = above * DMat4::from_cols_array_2d(&own);
        for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
            if !matches!(primitive.mode(), Mode::Triangles) {
                continue;
            }
            let Some(positions) = primitive.get(&Semantic::Positions) else { continue };
            let points = self.points(&positions)?;
            let indices = match primitive.indices() {
                Some(accessor) => self.indices(&accessor)?,
                None => (0..points.len() as u32).collect(),
            };
            let (base, count) = (self.soup.points.len() as u32, points.len() as u32);
            if self.soup.points.len() + points.len() > MOST
                || self.soup.faces.len() + indices.len() / 3 > MOST
            {
                return Err(Diagnostic::new(
                    Code::MeshTooLarge,
                    format!("more than {MOST} vertices or triangles"),
                ));
            }
            self.soup.points.extend(points.into_iter().map(|p| place.transform_point3(p)));
            for corners in indices.chunks_exact(3) {
                if let Some(wrong) = corners.iter().find(|v| **v >= count) {
                    let message = format!("face {} names vertex {wrong} of {count}", self.polygons + 1);
                    return Err(Diagnostic::new(Code::MeshIndex, message));
                }
                let corners: Vec<u32> = corners.iter().map(|v| v + base).collect();
                self.soup.polygon(&corners, self.polygons);
                self.polygons += 1;
            }
        }
        node.children().try_for_each(|child| self.node(&child, place, depth + 1))
    }

    /// The bytes of every element of an accessor.
    fn elements<'b>(
        &'b self,
        accessor: &Accessor<'_>,
    ) -> Result<impl Iterator<Item = &'b [u8]> + use<'b>, Diagnostic> {
        let what =
            || wrong(format!("accessor {} of the glTF file reaches beyond its buffer", accessor.index()));
        if accessor.sparse().is_some() {
            return Err(wrong("sparse accessors are not read").help("export without shape keys"));
        }
        let view = accessor.view().ok_or_else(what)?;
        let size = accessor.size();
        let stride = view.stride().unwrap_or(size).max(1);
        let buffer: &[u8] = self.buffers.get(view.buffer().index()).map_or(&[], Vec::as_slice);
        let inside = buffer.get(view.offset()..view.offset().saturating_add(view.length()));
        let bytes = inside.and_then(|bytes| bytes.get(accessor.offset()..)).ok_or_else(what)?;
        let count = accessor.count();
        let needed = count.checked_sub(1).map_or(Some(0), |n| n.checked_mul(stride)?.checked_add(size));
        if needed.is_none_or(|needed| needed > bytes.len()) {
            return Err(what());
        }
        Ok((0..count).filter_map(move |i| bytes.get(i * stride..i * stride + size)))
    }

    fn points(&self, accessor: &Accessor<'_>) -> Result<Vec<DVec3>, Diagnostic> {
        if accessor.data_type() != DataType::F32 || accessor.dimensions() != Dimensions::Vec3 {
            return Err(wrong("positions of the glTF file are no 32-bit numbers")
                .help("export without quantization and compression"));
        }
        let number = |b: &[u8], k: usize| {
            let bytes = b.get(4 * k..4 * k + 4).and_then(|b| <[u8; 4]>::try_from(b).ok());
            bytes.map_or(f64::NAN, |b| f64::from(f32::from_le_bytes(b)))
        };
        Ok(self.elements(accessor)?.map(|b| DVec3::new(number(b, 0), number(b, 1), number(b, 2))).collect())
    }

    fn indices(&self, accessor: &Accessor<'_>) -> Result<Vec<u32>, Diagnostic> {
        if accessor.dimensions() != Dimensions::Scalar {
            return Err(wrong("the indices of the glTF file are no single numbers"));
        }
        let whole = |b: &[u8]| b.iter().rev().fold(0_u32, |sum, byte| sum << 8 | u32::from(*byte));
        Ok(self.elements(accessor)?.map(whole).collect())
    }
}

fn wrong(message: impl AsRef<str>) -> Diagnostic {
    let message = message.as_ref().lines().next().unwrap_or_default().to_owned();
    Diagnostic::new(Code::MeshSyntax, message)
        .help("the file is cut off or of another format: export it again")
}
