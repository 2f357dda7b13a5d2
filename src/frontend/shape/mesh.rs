//! `[mesh]`: a mesh file, how it is to be read, and how it is to be cut into tubes.

use super::super::mesh::{self, Up, Wish};
use super::super::unit::Unit;
use super::curve;
use super::walk::{Value, Walk, count};
use crate::diag::{Code, Diagnostic, Sink, Source, Sources, Span};
use crate::ir::Gauge;
use crate::shape::Shape;
use crate::shape::mesh::Field;
use glam::DVec3;
use toml::de::DeTable;

const KEYS: &[&str] = &["file", "unit", "up", "field", "start", "poles", "seam", "curve"];
const FIELDS: &[(&str, Option<Field>)] =
    &[("harmonic", Some(Field::Harmonic)), ("geodesic", Some(Field::Geodesic)), ("plane", None)];
/// Most poles of a mesh.
const MOST_POLES: usize = 256;
/// Keys of a swept tube, which a mesh takes the place of.
const INSTEAD: &[&str] = &["trunk", "branch"];

/// A mesh that a shape file asks for.
#[derive(Debug)]
pub(super) struct Request {
    name: String,
    gauge: Gauge,
    file: String,
    span: Span,
    unit: Unit,
    up: Up,
    wish: Wish,
}

/// Reads `[mesh]`; name and gauge are those of the whole file.
pub(super) fn read(
    walk: &mut Walk<'_>,
    top: &DeTable<'_>,
    value: &Value<'_>,
    place: Span,
) -> Option<Request> {
    let mut sound = true;
    for key in INSTEAD {
        if let Some((other, _)) = walk.get(top, key) {
            sound = false;
            walk.report(
                Diagnostic::new(
                    Code::DuplicateKey,
                    format!("the shape is given twice, by `mesh` and by `{key}`"),
                )
                .at(other, "given here")
                .at(place, "and here")
                .help("keep one of the two"),
            );
        }
    }
    let table = walk.table(value, "mesh", "a table with `file`")?;
    walk.known(table, "`mesh`", KEYS);
    let file = walk.need(table, "file", ("`mesh`", place), "file = \"duck.obj\"");
    let file = file.and_then(|(_, value)| Some((walk.text(value, "file", "a file name")?, walk.of(value))));
    let unit = match walk.get(table, "unit") {
        Some((_, value)) => walk.word(value, "unit", Unit::WORDS),
        None => Some(walk.unit),
    };
    let up = match walk.get(table, "up") {
        Some((_, value)) => walk.word(value, "up", Up::WORDS),
        None => Some(Up::default()),
    };
    let field = match walk.get(table, "field") {
        Some((_, value)) => walk.word(value, "field", FIELDS),
        None => Some(Some(Field::default())),
    };
    let mut named = |key: &str| match walk.get(table, key) {
        Some((_, value)) => point(walk, value, key).map(Some),
        None => Some(None),
    };
    let (start, seam) = (named("start"), named("seam"));
    let poles = match walk.get(table, "poles") {
        Some((_, value)) => poles(walk, value),
        None => Some(Vec::new()),
    };
    let curve = match walk.get(table, "curve") {
        Some((_, value)) => {
            // Like the poles, the curve is given in the unit of the mesh file.
            let unit = std::mem::replace(&mut walk.unit, Unit::Mm);
            let segments = curve::read(walk, value);
            walk.unit = unit;
            segments.map(|segments| segments.iter().map(|it| it.bezier.points().to_vec()).collect())
        }
        None => Some(Vec::new()),
    };
    let (field, curve): (Option<Field>, Vec<Vec<DVec3>>) = (field?, curve?);
    if field.is_none() && curve.is_empty() {
        walk.fault(
            Code::MissingKey,
            place,
            "the field \"plane\" has no `curve`".to_owned(),
            "",
            "add `curve = [[0, 0, 0], [0, 0, 10]]`: planes are laid across it",
        );
        return None;
    }
    let (start, poles, seam) = (start?, poles?, seam?);
    let ((file, span), wish) = (file?, Wish { field: field.unwrap_or_default(), start, poles, seam, curve });
    let request = Request {
        name: String::new(),
        gauge: Gauge::new(1.0, 1.0),
        file: file.to_owned(),
        span,
        unit: unit?,
        up: up?,
        wish,
    };
    sound.then_some(request)
}

fn poles(walk: &mut Walk<'_>, value: &Value<'_>) -> Option<Vec<DVec3>> {
    let entries = walk.list(value, "poles", "a list of points [[x, y, z], ...]", MOST_POLES)?;
    let read: Vec<Option<DVec3>> = entries.iter().map(|entry| point(walk, entry, "poles")).collect();
    read.into_iter().collect()
}

/// A point in the unit and axes of the mesh file.
fn point(walk: &mut Walk<'_>, value: &Value<'_>, what: &str) -> Option<DVec3> {
    let Some(entries) = value.get_ref().as_array() else {
        walk.mismatch(value, what, "a point [x, y, z]");
        return None;
    };
    let numbers: Vec<Option<f64>> =
        entries.iter().take(4).map(|entry| walk.number(entry, what).map(|number| number.value)).collect();
    let numbers: Vec<f64> = numbers.into_iter().collect::<Option<_>>()?;
    let Ok(numbers) = <[f64; 3]>::try_from(numbers) else {
        let span = walk.of(value);
        let message = format!("a point of `{what}` has {}", count(entries.len(), "number"));
        walk.fault(Code::PointForm, span, message, "expected a point [x, y, z]", "");
        return None;
    };
    Some(DVec3::from_array(numbers))
}

impl Request {
    /// With name and gauge of the whole file.
    pub(super) fn of(self, name: String, gauge: Gauge) -> Self {
        Self { name, gauge, ..self }
    }

    /// Opens the mesh, and cuts it for the gauge.
    pub(super) fn fulfill(
        self,
        source: &Source,
        sources: &mut Sources<'_>,
        sink: &mut Sink<'_>,
    ) -> Option<Shape> {
        let fault = |sink: &mut Sink<'_>, code, message: String, help: &str| {
            sink.push(Diagnostic::new(code, message).at(self.span, "").help(help));
            None
        };
        let extension = self.file.rsplit_once('.').map_or("", |(_, extension)| extension);
        let reader = super::super::reader_for_extension(extension).filter(|reader| mesh::is_mesh(reader));
        let Some(reader) = reader else {
            let message = format!("`{}` has no extension of a mesh", super::walk::quote(&self.file));
            return fault(sink, Code::UnknownWord, message, "meshes end in .obj, .stl, .ply, .glb or .gltf");
        };
        let name = super::super::beside(source.name(), &self.file);
        let file = match sources.open(&name) {
            Ok(file) => file,
            Err(error) => {
                let message = format!("the mesh `{name}` cannot be read: {error}");
                return fault(
                    sink,
                    Code::FileFails,
                    message,
                    "the name counts from the folder of the shape file",
                );
            }
        };
        let soup = mesh::soup(&file, reader, sources, sink)?;
        mesh::shape(soup, self.name, self.gauge, (self.unit, self.up), &self.wish, self.span, sink)
    }
}
