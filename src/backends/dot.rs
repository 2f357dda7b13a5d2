//! The stitch graph as Graphviz DOT with the places of its loops, for `neato -n` and other graph tools.

use super::{Backend, Error, Format};
use crate::diag::Sink;
use crate::ir::verify::Verified;
use serde::Deserialize;
use std::io::{self, Write};

/// Options of the target `dot`: none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Dot {}

impl Backend for Dot {
    fn emit(&self, program: &Verified<'_>, out: &mut dyn Write, _: &mut Sink<'_>) -> Result<(), Error> {
        if program.graphs.is_empty() {
            let what = "a pattern that was written by hand has no stitch graph".to_owned();
            return Err(Error::Unsupported { backend: Self::NAME, what });
        }
        let mut out = io::BufWriter::with_capacity(1 << 16, out);
        writeln!(out, "digraph {} {{", quoted(&program.name))?;
        writeln!(out, "  node [shape=point, width=0.05];\n  edge [arrowhead=none];")?;
        for (index, (part, graph)) in program.pattern.parts.iter().zip(&program.graphs).enumerate() {
            writeln!(out, "  subgraph {} {{", quoted(&format!("cluster_{index}")))?;
            writeln!(out, "    label={};", quoted(&part.name))?;
            for (id, node) in graph.nodes.iter().enumerate() {
                let [x, y, z] = node.position.to_array();
                // A place in the plane in points, seen from the side; the place in space in mm beside it.
                writeln!(
                    out,
                    "    p{index}n{id} [pos=\"{:.2},{:.2}\", position=\"{x:.4} {y:.4} {z:.4}\"];",
                    (x + 0.35 * y) * 4.0 + 0.0,
                    (z + 0.35 * y) * 4.0 + 0.0
                )?;
            }
            let mut edge = |kind: &str, color: &str, (from, to): (u32, u32)| {
                writeln!(out, "    p{index}n{from} -> p{index}n{to} [class={kind}, color=\"{color}\"];")
            };
            graph.courses().try_for_each(|ends| edge("course", "#b8500f", ends))?;
            graph.wales().try_for_each(|ends| edge("wale", "#2f6db5", ends))?;
            graph.turns().try_for_each(|ends| edge("turn", "#7a2f8f", ends))?;
            writeln!(out, "  }}")?;
        }
        writeln!(out, "}}")?;
        out.flush()?;
        Ok(())
    }
}

impl Format for Dot {
    const NAME: &'static str = "dot";
    const EXTENSION: &'static str = "dot";
    const ABOUT: &'static str = "stitch graph for Graphviz, with positions";
}

/// A DOT string: only the quote and the backslash mean something in it.
fn quoted(text: &str) -> String {
    let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}
