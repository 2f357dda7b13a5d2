//! PLY through `ply-rs-bw`, with elements that keep only what is needed.

use super::MOST;
use crate::diag::{Code, Diagnostic, Source};
use crate::shape::mesh::Soup;
use glam::DVec3;
use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{PropertyAccess, PropertyAccessResult};

/// A vertex or a face, whichever the element is.
#[derive(Debug, Default)]
struct Element {
    point: DVec3,
    corners: Vec<u32>,
}

impl Element {
    fn number(&mut self, name: &str, value: f64) -> PropertyAccessResult {
        match name {
            "x" => self.point.x = value,
            "y" => self.point.y = value,
            "z" => self.point.z = value,
            _ => return PropertyAccessResult::Ignored,
        }
        PropertyAccessResult::Set
    }

    fn list(&mut self, name: &str, values: impl Iterator<Item = i64>) -> PropertyAccessResult {
        if name != "vertex_indices" && name != "vertex_index" {
            return PropertyAccessResult::Ignored;
        }
        // What is no index becomes one that no file has.
        self.corners = values.map(|value| u32::try_from(value).unwrap_or(u32::MAX)).collect();
        PropertyAccessResult::Set
    }
}

macro_rules! setters {
    ($($scalar:ident, $list:ident: $kind:ty;)+) => {
        impl PropertyAccess for Element {
            fn new() -> Self {
                Self::default()
            }
            $(
                fn $scalar(&mut self, name: &str, value: $kind) -> PropertyAccessResult {
                    self.number(name, f64::from(value))
                }
                fn $list(&mut self, name: &str, value: Vec<$kind>) -> PropertyAccessResult {
                    self.list(name, value.into_iter().map(i64::from))
                }
            )+
            fn set_float(&mut self, name: &str, value: f32) -> PropertyAccessResult {
                self.number(name, f64::from(value))
            }
            fn set_double(&mut self, name: &str, value: f64) -> PropertyAccessResult {
                self.number(name, value)
            }
        }
    };
}
setters! {
    set_char, set_list_char: i8;
    set_uchar, set_list_uchar: u8;
    set_short, set_list_short: i16;
    set_ushort, set_list_ushort: u16;
    set_int, set_list_int: i32;
    set_uint, set_list_uint: u32;
}

/// Reads vertices and faces; what else the file holds is passed over.
pub(super) fn read(source: &Source) -> Result<Soup, Diagnostic> {
    let bytes = source.bytes();
    if !bytes.starts_with(b"ply") {
        return Err(wrong("this is no PLY file: it does not begin with `ply`"));
    }
    let parser = Parser::<Element>::new();
    let mut reader = Reader::new(bytes);
    let header = parser
        .read_header(&mut reader)
        .map_err(|error| wrong(format!("the header of the PLY file cannot be read: {error}")))?;
    let mut soup = Soup::default();
    for (name, element) in &header.elements {
        // Every vertex and face takes a byte at least.
        if element.count > bytes.len() {
            let message =
                format!("the PLY file claims {} of `{name}` in {} bytes", element.count, bytes.len());
            return Err(wrong(message));
        }
        if element.count > MOST {
            let message = format!("{} of `{name}` are too many", element.count);
            return Err(Diagnostic::new(Code::MeshTooLarge, message));
        }
        let elements = parser
            .read_payload_for_element(&mut reader, element, &header)
            .map_err(|error| wrong(format!("`{name}` of the PLY file cannot be read: {error}")))?;
        match name.as_str() {
            "vertex" => soup.points.extend(elements.iter().map(|element| element.point)),
            "face" => {
                for (number, element) in elements.iter().enumerate() {
                    soup.polygon(&element.corners, number as u32);
                }
            }
            _ => {}
        }
    }
    Ok(soup)
}

fn wrong(message: impl AsRef<str>) -> Diagnostic {
    let message = message.as_ref().lines().next().unwrap_or_default().to_owned();
    Diagnostic::new(Code::MeshSyntax, message)
        .help("the file is cut off or of another format: export it again")
}
