//! Polygon meshes: OBJ, STL, PLY and glTF, through maintained readers, into tubes.

mod explain;
#[expect(clippy::result_large_err, reason = "made once a file, at most")]
mod gltf;
#[expect(clippy::result_large_err, reason = "made once a file, at most")]
mod obj;
#[expect(clippy::result_large_err, reason = "made once a file, at most")]
mod ply;
#[expect(clippy::result_large_err, reason = "made once a file, at most")]
mod stl;

use super::unit::Unit;
use super::{Input, Reader};
use crate::diag::{Code, Diagnostic, Sink, Source, Sources, Span};
use crate::ir::Gauge;
use crate::shape::mesh::{Cut, Field, Mesh, Piece, Plan, Soup};
use crate::shape::{Attachment, Bezier, Shape, Tube, Wishes};
use glam::DVec3;

/// The reader of Wavefront OBJ.
pub(super) const OBJ: Reader =
    Reader { name: "obj", extensions: &["obj"], about: "meshes: Wavefront OBJ", read: read_obj };
/// The reader of STL.
pub(super) const STL: Reader =
    Reader { name: "stl", extensions: &["stl"], about: "meshes: STL, binary or text", read: read_stl };
/// The reader of PLY.
pub(super) const PLY: Reader =
    Reader { name: "ply", extensions: &["ply"], about: "meshes: PLY, binary or text", read: read_ply };
/// The reader of glTF.
pub(super) const GLTF: Reader = Reader {
    name: "gltf",
    extensions: &["glb", "gltf"],
    about: "meshes: glTF 2.0, in meters and Y up by the standard",
    read: read_gltf,
};

/// Most vertices and most triangles of a mesh.
const MOST: usize = 20_000_000;

/// The axis of a file that points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Up {
    /// X.
    X,
    /// Y.
    Y,
    /// Z.
    #[default]
    Z,
}

impl Up {
    /// The axes by their words.
    pub const WORDS: &'static [(&'static str, Self)] = &[("x", Self::X), ("y", Self::Y), ("z", Self::Z)];

    /// A point with this axis up, turned to have z up.
    pub(super) fn turn(self, p: DVec3) -> DVec3 {
        match self {
            Self::X => DVec3::new(p.y, p.z, p.x),
            Self::Y => DVec3::new(p.x, -p.z, p.y),
            Self::Z => p,
        }
    }

    /// The other way round.
    fn back(self, p: DVec3) -> DVec3 {
        match self {
            Self::X => DVec3::new(p.z, p.x, p.y),
            Self::Y => DVec3::new(p.x, p.z, -p.y),
            Self::Z => p,
        }
    }
}

/// What a file of triangles does not say itself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reading {
    /// Unit of its coordinates.
    pub unit: Option<Unit>,
    /// The axis that points up.
    pub up: Option<Up>,
}

/// How to make tubes of a mesh; lengths are in the unit of the file, points in its axes.
#[derive(Clone, Debug, Default)]
pub(super) struct Wish {
    pub(super) field: Field,
    pub(super) start: Option<DVec3>,
    pub(super) poles: Vec<DVec3>,
    pub(super) seam: Option<DVec3>,
    /// Segments of the control curve, for planar sections.
    pub(super) curve: Vec<Vec<DVec3>>,
}

/// True for the readers of meshes.
pub(crate) fn is_mesh(reader: &Reader) -> bool {
    [OBJ.name, STL.name, PLY.name, GLTF.name].contains(&reader.name)
}

fn read_obj(source: &Source, sources: &mut Sources<'_>, sink: &mut Sink<'_>) -> Option<Input> {
    read(source, &OBJ, Reading::default(), None, sources, sink)
}

fn read_stl(source: &Source, sources: &mut Sources<'_>, sink: &mut Sink<'_>) -> Option<Input> {
    read(source, &STL, Reading::default(), None, sources, sink)
}

fn read_ply(source: &Source, sources: &mut Sources<'_>, sink: &mut Sink<'_>) -> Option<Input> {
    read(source, &PLY, Reading::default(), None, sources, sink)
}

fn read_gltf(source: &Source, sources: &mut Sources<'_>, sink: &mut Sink<'_>) -> Option<Input> {
    read(source, &GLTF, Reading::default(), None, sources, sink)
}

/// Reads a mesh that is given directly.
pub(crate) fn read(
    source: &Source,
    reader: &Reader,
    reading: Reading,
    gauge: Option<Gauge>,
    sources: &mut Sources<'_>,
    sink: &mut Sink<'_>,
) -> Option<Input> {
    let home = source.span(0..0);
    let soup = soup(source, reader, sources, sink)?;
    let Some(gauge) = gauge else {
        sink.push(
            Diagnostic::new(Code::GaugeMissing, "a mesh does not say how large a stitch is")
                .at(home, "")
                .help("add --gauge, for example --gauge 5mmx5mm"),
        );
        return None;
    };
    let (unit, up) = assumed(&soup, reader, reading, home, sink);
    let last = source.name().rsplit(['/', '\\']).next().unwrap_or_default();
    let name = last.rsplit_once('.').map_or(last, |(stem, _)| stem).to_owned();
    let shape = shape(soup, name, gauge, (unit, up), &Wish::default(), home, sink)?;
    Some(Input::Shape(Box::new(shape)))
}

/// Unit and axis, with a note for what is assumed.
fn assumed(soup: &Soup, reader: &Reader, reading: Reading, home: Span, sink: &mut Sink<'_>) -> (Unit, Up) {
    let gltf = reader.name == GLTF.name;
    let unit = reading.unit.unwrap_or(if gltf { Unit::Meter } else { Unit::Mm });
    let up = reading.up.unwrap_or(if gltf { Up::Y } else { Up::Z });
    if gltf || (reading.unit.is_some() && reading.up.is_some()) {
        return (unit, up);
    }
    let size = soup.bounds().map_or(DVec3::ZERO, |[low, high]| up.turn(high - low).abs() * unit.mm() / 10.0);
    let message = match (reading.unit, reading.up) {
        (None, None) => "the mesh is read in mm with Z up",
        (None, _) => "the mesh is read in mm",
        _ => "the mesh is read with Z up",
    };
    let message = format!("{message}: {:.1} x {:.1} x {:.1} cm", size.x, size.y, size.z);
    sink.push(
        Diagnostic::new(Code::UnitAssumed, message)
            .at(home, "")
            .help("say it with --unit mm|cm|in and --up x|y|z"),
    );
    (unit, up)
}

/// The triangles of a file; `None` when the sink has the reason.
pub(super) fn soup(
    source: &Source,
    reader: &Reader,
    sources: &mut Sources<'_>,
    sink: &mut Sink<'_>,
) -> Option<Soup> {
    sink.stage("mesh file");
    let read = match reader.name {
        "stl" => stl::read(source),
        "ply" => ply::read(source),
        "gltf" => gltf::read(source, sources),
        _ => obj::read(source),
    };
    let mut refuse = |diagnostic: Diagnostic| {
        let placed =
            if diagnostic.labels.is_empty() { diagnostic.at(source.span(0..0), "") } else { diagnostic };
        sink.push(placed);
    };
    match read {
        Ok(soup) if soup.points.len() > MOST || soup.faces.len() > MOST => {
            let (points, faces) = (soup.points.len(), soup.faces.len());
            let message = format!("{points} vertices and {faces} triangles are too many");
            let help = format!("at most {MOST} are read: simplify the mesh (in Blender: modifier Decimate)");
            refuse(Diagnostic::new(Code::MeshTooLarge, message).help(help));
            None
        }
        Ok(soup) => Some(soup),
        Err(diagnostic) => {
            refuse(diagnostic);
            None
        }
    }
}

/// The text of a shape file that says of a mesh what is found by itself: the field, its ends, and where rounds begin.
/// `file` is the name of the mesh in it. `None` with the reason in the sink when no tubes can be made.
pub fn shape_file(
    source: &Source,
    reader: &Reader,
    reading: Reading,
    gauge: Gauge,
    file: &str,
    sources: &mut Sources<'_>,
    sink: &mut Sink<'_>,
) -> Option<String> {
    let home = source.span(0..0);
    let soup = soup(source, reader, sources, sink)?;
    let (unit, up) = assumed(&soup, reader, reading, home, sink);
    let wish = Wish::default();
    let cut = cut(soup, gauge, (unit, up), &wish, home, sink)?;
    Some(explain::Units { unit, up }.file(&cut, &gauge, wish.field, file))
}

/// A shape of tubes from triangles; `home` is what faults of the mesh point at.
pub(super) fn shape(
    soup: Soup,
    name: String,
    gauge: Gauge,
    axes: (Unit, Up),
    wish: &Wish,
    home: Span,
    sink: &mut Sink<'_>,
) -> Option<Shape> {
    let cut = cut(soup, gauge, axes, wish, home, sink)?;
    Some(Shape { name, gauge, tubes: tubes(cut), wishes: Wishes::default() })
}

/// The mesh in tubes, with notes of what was chosen.
fn cut(
    soup: Soup,
    gauge: Gauge,
    (unit, up): (Unit, Up),
    wish: &Wish,
    home: Span,
    sink: &mut Sink<'_>,
) -> Option<Cut> {
    sink.stage("mesh");
    let units = explain::Units { unit, up };
    let (mut mesh, repairs) = match Mesh::new(soup) {
        Ok(mesh) => mesh,
        Err(fault) => {
            sink.push(units.fault(&fault, true).at(home, ""));
            return None;
        }
    };
    explain::Units::repairs(&repairs, home, sink);
    let inward = |p: DVec3| up.turn(p) * unit.mm();
    mesh.map(inward);
    let area = mesh.area() / (gauge.width * gauge.height);
    if area.is_nan() || area > f64::from(crate::ir::MAX_LOOPS) {
        let message =
            format!("this takes about {area:.0} stitches, at most {} are made", crate::ir::MAX_LOOPS);
        let help = format!("use a larger stitch, or check the unit: the mesh is read in {}", unit.name());
        sink.push(Diagnostic::new(Code::ShapeTooLarge, message).at(home, "").help(help));
        return None;
    }
    sink.stage("field");
    let plan = Plan {
        gauge,
        field: wish.field,
        start: wish.start.map(inward),
        poles: wish.poles.iter().map(|p| inward(*p)).collect(),
        seam: wish.seam.map(inward),
    };
    let curve: Vec<Bezier> = wish
        .curve
        .iter()
        .filter_map(|segment| Bezier::new(&segment.iter().map(|p| inward(*p)).collect::<Vec<_>>()))
        .collect();
    let cut = if curve.is_empty() {
        mesh.cut(&plan, |done, all| sink.step(done, all))
    } else {
        mesh.slice(&curve, &plan)
    };
    let cut = match cut {
        Ok(cut) => cut,
        Err(fault) => {
            sink.push(units.fault(&fault, false).at(home, ""));
            return None;
        }
    };
    units.chosen(&cut, wish, home, sink);
    Some(cut)
}

fn tubes(cut: Cut) -> Vec<Tube> {
    let tube = |piece: Piece| {
        let tube = Tube::new(piece.name, piece.surface, piece.ends);
        match piece.attachment {
            Some(Attachment { parent, joint }) => tube.on(parent, joint),
            None => tube,
        }
    };
    cut.pieces.into_iter().map(tube).collect()
}
