//! What the gate says, in words: where in the unit and axes of the file, and what to do in a modeling tool.

use super::super::unit::Unit;
use super::{Up, Wish};
use crate::diag::{Code, Diagnostic, Sink, Span};
use crate::ir::Gauge;
use crate::shape::mesh::{Cut, Fault, Field, Repairs};
use glam::DVec3;
use std::fmt::Write;

/// Where along the trunk its seam is told: a pole is in no place around it.
const SEAM: f64 = 0.01;
const NAME_ENDS: &str = "name the ends: `start` and `poles` of a shape file with [mesh]";

/// Unit and axes of a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units {
    pub(super) unit: Unit,
    pub(super) up: Up,
}

impl Units {
    /// A point in the file's own coordinates; `raw` when it is in them already.
    fn at(self, p: DVec3, raw: bool) -> String {
        let p = if raw { p } else { self.up.back(p) / self.unit.mm() };
        format!("({}, {}, {})", number(p.x), number(p.y), number(p.z))
    }

    fn length(self, length: f64, raw: bool) -> String {
        number(if raw { length } else { length / self.unit.mm() })
    }

    /// A fault of the mesh; `raw` when its positions are those of the file.
    pub(super) fn fault(self, fault: &Fault, raw: bool) -> Diagnostic {
        let at = |p: &DVec3| self.at(*p, raw);
        let new = |code, message: String, help: &str| Diagnostic::new(code, message).help(help);
        match fault {
            Fault::Empty => new(
                Code::MeshEmpty,
                "the mesh has no face with an area".into(),
                "export the object as a mesh with faces; curves and points alone cannot be worked",
            ),
            Fault::NotFinite { vertex } => new(
                Code::MeshNumber,
                format!("vertex {vertex} has a coordinate that is no usable number"),
                "export the mesh again; in Blender, apply all modifiers and the scale first",
            ),
            Fault::OutOfRange { face, vertex, vertices } => new(
                Code::MeshIndex,
                format!("face {face} names vertex {vertex}, and there are {vertices}"),
                "the file is cut off or was edited by hand: export it again",
            ),
            Fault::Edge { vertices: [a, b], faces, face, at: place } => new(
                Code::NotManifold,
                format!(
                    "not a surface: the edge between vertices {a} and {b} at {} has {faces} faces",
                    at(place)
                ),
                &format!(
                    "face {face} is one of them; in Blender: edit mode, Select > All by Trait > Non Manifold, and delete the inner faces"
                ),
            ),
            Fault::Vertex { vertex, fans, at: place } => new(
                Code::NotManifold,
                format!(
                    "not a surface: at vertex {vertex}, {}, {fans} parts of it touch in one point",
                    at(place)
                ),
                "pull the parts apart, or join them by faces; in Blender: Vertex > Rip Vertices",
            ),
            Fault::Components { count, largest } => {
                let list: Vec<String> = largest
                    .iter()
                    .map(|(faces, place)| format!("{faces} faces around {}", at(place)))
                    .collect();
                let more = if *count as usize > largest.len() { ", and more" } else { "" };
                new(
                    Code::MeshPieces,
                    format!("the mesh is in {count} pieces: {}{more}", list.join("; ")),
                    "export one piece, or unite them; in Blender: modifier Boolean > Union, or Mesh > Separate > By Loose Parts",
                )
            }
            Fault::OneSided { face, at: place } => new(
                Code::OneSided,
                format!(
                    "the surface has one side only: its front becomes its back at face {face}, {}",
                    at(place)
                ),
                "a fabric has two sides: cut the strip open there, and take out the half twist",
            ),
            Fault::Genus { genus, at: place, length, vertex } => {
                let handles = if *genus == 1 { "a handle".to_owned() } else { format!("{genus} handles") };
                new(
                    Code::MeshHandle,
                    format!(
                        "the surface has {handles}: a loop of length {} around {}, past vertex {vertex}, leads around one",
                        self.length(*length, raw),
                        at(place)
                    ),
                    "cut the handle open there and close both ends by faces; they can be sewn together afterwards",
                )
            }
            Fault::Hole { at: place, length, edges, vertex } => new(
                Code::MeshHole,
                format!(
                    "the surface has a hole at {}: {edges} edges around it, {} long, past vertex {vertex}",
                    at(place),
                    self.length(*length, raw)
                ),
                "close it, in Blender: select its edge and Face > Fill; if it is an opening to work from, name it in `poles` of a shape file with [mesh]",
            ),
            Fault::NoEnds { .. }
            | Fault::NoSlice { .. }
            | Fault::Fold { .. }
            | Fault::Fork { .. }
            | Fault::NoRows { .. } => self.unworkable(fault, raw),
        }
    }

    /// A sound surface that no rows can be laid on.
    fn unworkable(self, fault: &Fault, raw: bool) -> Diagnostic {
        let at = |p: &DVec3| self.at(*p, raw);
        let (message, help) = match fault {
            Fault::NoSlice { at: place } => (
                format!("the plane across the curve at {} meets no loop of the mesh around it", at(place)),
                "lead the curve through the inside of the mesh, from end to end; or leave `curve` out",
            ),
            Fault::Fold { at: place } => (
                format!("curve too tight at {}: planes across it cross within the mesh", at(place)),
                "bend the curve more gently, or leave `curve` out: the field \"harmonic\" follows any bend",
            ),
            Fault::Fork { at: place } => (
                format!("where the limb that ends at {} begins cannot be told", at(place)),
                "make it longer or thinner where it begins, or move it away from other limbs and openings",
            ),
            Fault::NoRows { at: place } => (
                format!("no rows fit on the limb that ends at {}", at(place)),
                "make the limb longer, or the stitch smaller",
            ),
            Fault::NoEnds { at: place }
            | Fault::Edge { at: place, .. }
            | Fault::Vertex { at: place, .. }
            | Fault::OneSided { at: place, .. }
            | Fault::Genus { at: place, .. }
            | Fault::Hole { at: place, .. } => {
                (format!("the mesh has no second end besides {}", at(place)), NAME_ENDS)
            }
            Fault::Empty | Fault::NotFinite { .. } | Fault::OutOfRange { .. } | Fault::Components { .. } => {
                ("the mesh has no ends".to_owned(), NAME_ENDS)
            }
        };
        Diagnostic::new(Code::MeshUnworkable, message).help(help)
    }

    /// Says what was repaired.
    pub(super) fn repairs(repairs: &Repairs, home: Span, sink: &mut Sink<'_>) {
        let mut done = Vec::new();
        let mut count = |number: u32, one: &str, many: &str| {
            if number > 0 {
                done.push(if number == 1 { format!("1 {one}") } else { format!("{number} {many}") });
            }
        };
        count(
            repairs.welded,
            "vertex welded to another in its place",
            "vertices welded to others in their place",
        );
        count(repairs.degenerate, "face without an area dropped", "faces without an area dropped");
        count(repairs.doubled, "face dropped that stood twice", "faces dropped that stood twice");
        count(
            repairs.flipped,
            "face turned to agree with its neighbors",
            "faces turned to agree with their neighbors",
        );
        if repairs.inside_out {
            done.push("all faces turned to look outward".to_owned());
        }
        // Files of loose triangles are welded without a word.
        let loose = repairs.welded > 0 && done.len() == 1;
        if !done.is_empty() && !loose {
            let message = format!("the mesh was repaired: {}", done.join(", "));
            let help = "the shape is the same; mend it in the modeling tool to silence this";
            sink.push(Diagnostic::new(Code::MeshRepaired, message).at(home, "").help(help));
        }
    }

    /// A shape file with what the program chose.
    pub(super) fn file(self, cut: &Cut, gauge: &Gauge, field: Field, file: &str) -> String {
        let point = |p: DVec3| {
            let p = self.up.back(p) / self.unit.mm();
            format!("[{}, {}, {}]", number(p.x), number(p.y), number(p.z))
        };
        let word = |words: &[(&'static str, Up)]| {
            words.iter().find(|(_, up)| *up == self.up).map_or("z", |(word, _)| *word)
        };
        let quoted = |text: &str| toml::Value::from(text).to_string();
        let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
        let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
        let mut text = format!(
            "# The ends, the field and the seam that Picot found in {}. Change a line and build this file.\n",
            name.replace(char::is_control, " ")
        );
        let _ = write!(
            text,
            "name = {}\nunit = \"mm\"\n\n[gauge]\nstitch = {{ width = {}, height = {} }}\n\n[mesh]\nfile = {}\nunit = \"{}\"\nup = \"{}\"\nfield = \"{}\"\n",
            quoted(stem),
            number(gauge.width),
            number(gauge.height),
            quoted(file),
            self.unit.word(),
            word(Up::WORDS),
            word_of(field),
        );
        if let Some((start, rest)) = cut.ends.split_first() {
            let poles: Vec<String> = rest.iter().map(|(p, _)| point(*p)).collect();
            let _ = write!(text, "start = {}\npoles = [{}]\n", point(start.0), poles.join(", "));
        }
        if let Some(trunk) = cut.pieces.first() {
            let _ = writeln!(text, "seam = {}", point(trunk.surface.point(SEAM, 0.0)));
        }
        text
    }

    /// Says what the program chose, in words that a shape file takes.
    pub(super) fn chosen(self, cut: &Cut, wish: &Wish, home: Span, sink: &mut Sink<'_>) {
        let point = |p: DVec3| {
            let p = self.up.back(p) / self.unit.mm();
            format!("[{}, {}, {}]", number(p.x), number(p.y), number(p.z))
        };
        let ends: Vec<String> = cut.ends.iter().map(|(p, _)| point(*p)).collect();
        if let (Some((start, rest)), true) =
            (ends.split_first(), wish.curve.is_empty() && (wish.poles.is_empty() || wish.start.is_none()))
        {
            let field = word_of(wish.field);
            let message = format!(
                "rows run from start = {start} to poles = [{}] by field = \"{field}\": {}",
                rest.join(", "),
                if cut.pieces.len() == 1 {
                    "one tube".to_owned()
                } else {
                    format!("{} tubes", cut.pieces.len())
                },
            );
            let help = "to choose others, write them in the [mesh] of a shape file";
            sink.push(Diagnostic::new(Code::MeshEnds, message).at(home, "").help(help));
        }
        for tip in &cut.dropped {
            let message = format!(
                "the limb that ends at {} has fewer than 3 rounds and becomes a bulge",
                self.at(*tip, false)
            );
            let help = "use a smaller stitch to keep it";
            sink.push(Diagnostic::new(Code::LimbDropped, message).at(home, "").help(help));
        }
    }
}

/// The word of a field.
fn word_of(field: Field) -> &'static str {
    match field {
        Field::Harmonic => "harmonic",
        Field::Geodesic => "geodesic",
    }
}

/// Up to four digits behind the point, no trailing zeros.
fn number(x: f64) -> String {
    if x != 0.0 && (x.abs() < 1e-3 || x.abs() >= 1e9) {
        return format!("{x:.3e}");
    }
    let text = format!("{x:.4}");
    let short = text.trim_end_matches('0').trim_end_matches('.');
    if short == "-0" { "0".to_owned() } else { short.to_owned() }
}
