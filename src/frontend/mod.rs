//! Readers: from bytes to a value, with spans and diagnostics. A reader is one file and one line of [`READERS`].

pub mod crochet;
mod findings;
pub mod kcode;
pub mod knitout;
pub(crate) mod loops;
pub mod mesh;
pub(crate) mod shape;
mod unit;
pub mod xml;

pub use unit::Unit;

use crate::diag::{Sink, Source, Sources};
use crate::ir::Program;
use crate::ir::machine;
use crate::shape::Shape;

/// What a file turned out to be.
#[derive(Debug)]
pub enum Input {
    /// Something to compile.
    Shape(Box<Shape>),
    /// A pattern that is already one.
    Program(Box<Program>),
    /// Machine code, which is checked and converted only.
    Code(Box<machine::Code>),
}

/// One readable format.
#[derive(Debug)]
pub struct Reader {
    /// Name, as in `picot list readers`.
    pub name: &'static str,
    /// File extensions without the dot.
    pub extensions: &'static [&'static str],
    /// One line about it.
    pub about: &'static str,
    /// Reads one opened file. It returns what it could read; faults go to the sink.
    pub read: fn(&Source, &mut Sources<'_>, &mut Sink<'_>) -> Option<Input>,
}

/// Every reader.
pub static READERS: &[Reader] = &[
    crochet::READER,
    shape::READER,
    kcode::READER,
    knitout::READER,
    xml::READER,
    mesh::OBJ,
    mesh::STL,
    mesh::PLY,
    mesh::GLTF,
    loops::READER,
];

/// The reader with this name.
pub fn reader(name: &str) -> Option<&'static Reader> {
    READERS.iter().find(|reader| reader.name == name)
}

/// The reader that a file extension (without the dot, in any case) stands for.
pub fn reader_for_extension(extension: &str) -> Option<&'static Reader> {
    READERS.iter().find(|reader| reader.extensions.iter().any(|known| known.eq_ignore_ascii_case(extension)))
}

/// The name of a file that another one names: relative names count from the folder of the other.
fn beside(home: &str, name: &str) -> String {
    if name.starts_with(['/', '\\']) || name.contains(':') {
        return name.to_owned();
    }
    match home.rfind(['/', '\\']) {
        Some(end) => format!("{}{name}", home.get(..=end).unwrap_or_default()),
        None => name.to_owned(),
    }
}
