//! The written crochet pattern: what a maker works from, and what Picot's own reader reads back.

mod header;
mod rows;
pub(super) mod words;

pub(super) use rows::Line;

use super::{Backend, Error, Format};
use crate::diag::Sink;
pub use crate::ir::{Language, Terms};

use crate::ir::verify::Verified;
use serde::Deserialize;
use std::io;

/// Options of the target `crochet`.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Crochet {
    /// The English vocabulary, `us` or `uk`. The same word means different stitches: US `sc` is UK `dc`.
    pub terms: Terms,
    /// The language: `en`, `es`, `pt`, `fr`, `de`, `no`, or `letters` for the notation X V A.
    pub language: Language,
    /// How much is said.
    pub style: Style,
    /// How changes of direction are marked.
    pub arrows: Arrows,
    /// Where remarks are wrapped, in characters; rounds stay in one line.
    pub line_width: u16,
}

impl Default for Crochet {
    fn default() -> Self {
        Self {
            terms: Terms::Us,
            language: Language::English,
            style: Style::Maker,
            arrows: Arrows::Unicode,
            line_width: 80,
        }
    }
}

/// How much is said.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Style {
    /// A whole pattern: size, gauge, materials, notes, folded rounds with counts, finishing.
    #[default]
    Maker,
    /// The plain form of the paper: a line a row, equal neighbors counted, arrows; nothing is folded.
    Paper,
}

/// How changes of direction are marked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Arrows {
    /// `←` and `→`.
    #[default]
    Unicode,
    /// `<-` and `->`.
    Ascii,
    /// `turn`.
    Words,
}

impl Backend for Crochet {
    fn emit(&self, program: &Verified<'_>, out: &mut dyn io::Write, _: &mut Sink<'_>) -> Result<(), Error> {
        let mut out = io::BufWriter::new(out);
        let mut text = rows::Text::new(self, &mut out);
        header::write(self, program, &mut text)?;
        for index in 0..program.pattern.parts.len() {
            rows::part(self, program, index, &mut text)?;
        }
        io::Write::flush(&mut out)?;
        Ok(())
    }
}

impl Crochet {
    /// The lines of a whole pattern, with the number of those that are its head.
    pub(super) fn lines(&self, program: &Verified<'_>) -> (Vec<Line>, usize) {
        let mut lines = Vec::new();
        let mut text = rows::Text::collect(&mut lines);
        // Collecting does not fail.
        let _ = header::write(self, program, &mut text);
        let mut head = 0;
        for index in 0..program.pattern.parts.len() {
            let mut part = Vec::new();
            let _ = rows::part(self, program, index, &mut rows::Text::collect(&mut part));
            if index == 0 {
                head = lines.len();
            }
            lines.append(&mut part);
        }
        (lines, head)
    }
}

impl Format for Crochet {
    const NAME: &'static str = "crochet";
    const EXTENSION: &'static str = "txt";
    const ABOUT: &'static str =
        "written pattern to crochet from; terms = us, uk; language = en, es, pt, fr, de, no, letters";
}
