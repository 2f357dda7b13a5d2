//! Wavefront OBJ through `tobj`; where a line is at fault, this finds it.

use super::MOST;
use crate::diag::{Code, Diagnostic, Source};
use crate::shape::mesh::Soup;
use glam::DVec3;
use tobj::{LoadError, LoadOptions};

/// Reads the polygons of all objects and groups.
pub(super) fn read(source: &Source) -> Result<Soup, Diagnostic> {
    let bytes = source.bytes();
    if let Some(zero) = bytes.iter().take(4096).position(|byte| *byte == 0) {
        let message = "this is no OBJ file: it is not text";
        return Err(Diagnostic::new(Code::MeshSyntax, message)
            .at(source.span(zero..zero + 1), "")
            .help("name the format with --from, or export the mesh as OBJ"));
    }
    let options = LoadOptions { ignore_points: true, ignore_lines: true, ..LoadOptions::default() };
    let loaded = tobj::load_obj_buf(&mut &*bytes, &options, |_| Err(LoadError::OpenFileFailed));
    let models = match loaded {
        Ok((models, _)) => models,
        Err(error) => return Err(explain(source, error)),
    };
    let mut soup = Soup::default();
    let mut number = 0;
    for model in models {
        let mesh = model.mesh;
        let base = soup.points.len();
        if base + mesh.positions.len() / 3 > MOST {
            return Err(Diagnostic::new(Code::MeshTooLarge, format!("more than {MOST} vertices")));
        }
        let point = |p: &[f64]| DVec3::new(p[0], p[1], p[2]);
        soup.points.extend(mesh.positions.chunks_exact(3).map(point));
        let mut rest = mesh.indices.as_slice();
        let triangles = mesh.face_arities.is_empty();
        let mut arities = mesh.face_arities.iter();
        while !rest.is_empty() {
            let arity = if triangles { 3 } else { arities.next().copied().unwrap_or(3) as usize };
            let (corners, after) = rest.split_at(arity.clamp(1, rest.len()));
            rest = after;
            let corners: Vec<u32> = corners.iter().map(|v| v + base as u32).collect();
            soup.polygon(&corners, number);
            number += 1;
        }
    }
    Ok(soup)
}

/// Finds the first line that `tobj` could not take.
fn explain(source: &Source, error: LoadError) -> Diagnostic {
    let (mut start, mut vertices) = (0, 0_i64);
    let bytes = source.bytes();
    for line in bytes.split_inclusive(|byte| *byte == b'\n') {
        let range = start..start + line.len();
        start = range.end;
        let Ok(text) = std::str::from_utf8(line) else {
            return Diagnostic::new(Code::MeshSyntax, "a line of the OBJ file is not text")
                .at(source.span(range), "");
        };
        let mut words = text.split_whitespace();
        let place = source.span(range.start..range.start + text.trim_end().len());
        match words.next() {
            Some("v") => {
                vertices += 1;
                let numbers = words.clone().take(3).filter(|word| word.parse::<f64>().is_ok()).count();
                if numbers < 3 {
                    let message = format!("vertex {vertices} has no three coordinates");
                    let place = Diagnostic::new(Code::MeshSyntax, message).at(place, "");
                    return place.help("the file is cut off or was edited by hand: export it again");
                }
            }
            Some("f") => {
                for word in words {
                    let index = word.split('/').next().and_then(|index| index.parse::<i64>().ok());
                    let Some(index) = index else {
                        let message = "a corner of a face is no vertex number";
                        return Diagnostic::new(Code::MeshSyntax, message).at(place, "");
                    };
                    let known = if index < 0 { -index <= vertices } else { (1..=vertices).contains(&index) };
                    if !known {
                        let message =
                            format!("a face names vertex {index}, and there are {vertices} before it");
                        return Diagnostic::new(Code::MeshIndex, message)
                            .at(place, "")
                            .help("the file is cut off or was edited by hand: export it again");
                    }
                }
            }
            _ => {}
        }
    }
    Diagnostic::new(Code::MeshSyntax, format!("the OBJ file cannot be read: {error}"))
        .help("export it again, without materials and normals")
}
