//! Printers: from a verified program to bytes. A backend is one file and one line of [`TARGETS`].

pub mod crochet;
pub mod dot;
pub mod gltf;
pub mod html;
pub mod json;
pub mod kcode;
pub mod knitout;
pub mod obj;
pub mod png;
pub mod stl;
pub mod svg;
pub mod xml;

use crate::diag::Sink;
use crate::ir::machine::Checked;
use crate::ir::verify::Verified;
use crate::settings;
use serde::de::DeserializeOwned;
use std::io;

/// A configured backend. The value of a backend is its options.
pub trait Backend {
    /// Writes the program. Remarks (an approximation, an estimate) go to the sink.
    fn emit(&self, program: &Verified<'_>, out: &mut dyn io::Write, sink: &mut Sink<'_>)
    -> Result<(), Error>;

    /// Writes machine code that was read from a file. Only formats of machines can.
    fn emit_code(
        &self,
        _code: &Checked<'_>,
        _out: &mut dyn io::Write,
        _sink: &mut Sink<'_>,
    ) -> Result<(), Error> {
        let what = "machine code holds no pattern; it becomes knitout, kcode or svg".to_owned();
        Err(Error::Unsupported { backend: "this target", what })
    }
}

/// A kind of output: its facts, and options that come from `--set KEY=VALUE` through serde.
pub trait Format: Backend + DeserializeOwned + 'static {
    /// Name, as in `--to NAME`.
    const NAME: &'static str;
    /// File extension without the dot.
    const EXTENSION: &'static str;
    /// One line about it.
    const ABOUT: &'static str;
    /// True when the output is no text and must not go to a terminal.
    const BINARY: bool = false;
}

/// What a backend can fail with that is not the user's input.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The output could not be written.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The program lacks what this backend needs.
    #[error("{backend} cannot write this: {what}")]
    Unsupported {
        /// Name of the backend.
        backend: &'static str,
        /// What is missing.
        what: String,
    },
}

impl Error {
    /// What a backend does not write, with the reason.
    fn refused(backend: &'static str, what: &dyn std::fmt::Display) -> Self {
        Self::Unsupported { backend, what: what.to_string() }
    }
}

/// One row of the list of targets.
pub struct Target {
    /// Name, as in `--to NAME`.
    pub name: &'static str,
    /// File extension without the dot.
    pub extension: &'static str,
    /// One line about it.
    pub about: &'static str,
    /// True when the output is no text.
    pub binary: bool,
    configure: fn(toml::Table) -> Result<Box<dyn Backend>, toml::de::Error>,
    keys: fn() -> &'static [&'static str],
}

impl std::fmt::Debug for Target {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

impl Target {
    /// The row of a format.
    pub const fn of<F: Format>() -> Self {
        Self {
            name: F::NAME,
            extension: F::EXTENSION,
            about: F::ABOUT,
            binary: F::BINARY,
            configure: |table| Ok(Box::new(F::deserialize(table)?)),
            keys: settings::keys::<F>,
        }
    }
    /// The names of its options.
    pub fn keys(&self) -> &'static [&'static str] {
        (self.keys)()
    }
    /// The backend with the options of a table; unknown keys and wrong types are errors.
    pub fn configure(&self, options: toml::Table) -> Result<Box<dyn Backend>, toml::de::Error> {
        (self.configure)(options)
    }
}

/// Every target.
pub static TARGETS: &[Target] = &[
    Target::of::<crochet::Crochet>(),
    Target::of::<dot::Dot>(),
    Target::of::<gltf::Gltf>(),
    Target::of::<html::Html>(),
    Target::of::<json::Json>(),
    Target::of::<kcode::Kcode>(),
    Target::of::<knitout::Knitout>(),
    Target::of::<obj::Obj>(),
    Target::of::<png::Png>(),
    Target::of::<stl::Stl>(),
    Target::of::<svg::Svg>(),
    Target::of::<xml::Xml>(),
];

/// The target with this name.
pub fn target(name: &str) -> Option<&'static Target> {
    TARGETS.iter().find(|target| target.name == name)
}

/// The target that a file extension (without the dot, in any case) stands for.
pub fn target_for_extension(extension: &str) -> Option<&'static Target> {
    TARGETS.iter().find(|target| target.extension.eq_ignore_ascii_case(extension))
}
