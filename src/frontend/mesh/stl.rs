//! STL through `stl_io`, binary and text told apart by the length that a binary file must have.

use super::MOST;
use crate::diag::{Code, Diagnostic, Source};
use crate::shape::mesh::Soup;
use glam::DVec3;
use std::io::Cursor;

/// Bytes before the triangles of a binary file, and of each triangle.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Reads the triangles, each with vertices of its own.
pub(super) fn read(source: &Source) -> Result<Soup, Diagnostic> {
    let bytes = source.bytes();
    let claimed =
        bytes.get(80..HEADER).and_then(|count| <[u8; 4]>::try_from(count).ok()).map(u32::from_le_bytes);
    let exact =
        claimed.is_some_and(|count| bytes.len() as u64 == HEADER as u64 + TRIANGLE as u64 * u64::from(count));
    let text = !exact && bytes.starts_with(b"solid") && !bytes.iter().take(512).any(|byte| *byte == 0);
    if !text {
        let Some(claimed) = claimed else {
            let message = format!("this is no STL file: it has {} bytes", bytes.len());
            return Err(wrong(message));
        };
        let there = (bytes.len() - HEADER) / TRIANGLE;
        if (claimed as usize) > there {
            return Err(wrong(format!("the STL file claims {claimed} triangles and holds {there}")));
        }
        if claimed as usize > MOST {
            return Err(Diagnostic::new(Code::MeshTooLarge, format!("{claimed} triangles are too many")));
        }
    }
    let mut soup = Soup::default();
    let mut add = |triangle: stl_io::Triangle| {
        let base = soup.points.len() as u32;
        soup.points.extend(triangle.vertices.iter().map(|v| DVec3::from_array(v.0.map(f64::from))));
        soup.faces.push([base, base + 1, base + 2]);
    };
    // A binary file may begin with the word of a text file: its header says nothing, so it is left out.
    let blank;
    let bytes = if !text && bytes.starts_with(b"solid") {
        blank = [&[b' '; 80], bytes.get(80..).unwrap_or_default()].concat();
        blank.as_slice()
    } else {
        bytes
    };
    let mut cursor = Cursor::new(bytes);
    let triangles = stl_io::create_stl_reader(&mut cursor).map_err(|error| broken(0, &error))?;
    for (number, triangle) in triangles.enumerate().take(MOST + 1) {
        add(triangle.map_err(|error| broken(number, &error))?);
    }
    if text && soup.faces.is_empty() && bytes.windows(5).any(|word| word == b"facet") {
        return Err(wrong("no facet of the STL file can be read".to_owned()));
    }
    Ok(soup)
}

fn wrong(message: String) -> Diagnostic {
    Diagnostic::new(Code::MeshSyntax, message)
        .help("the file is cut off or of another format: export it again")
}

fn broken(facet: usize, error: &std::io::Error) -> Diagnostic {
    wrong(format!("facet {} of the STL file cannot be read: {error}", facet + 1))
}
