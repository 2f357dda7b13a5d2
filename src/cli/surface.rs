//! `picot surface`: the surface that stitches are laid on, for modeling tools and as loops.

use super::args::Surface;
use super::files::{self, Place};
use super::plan::reader_of;
use super::report::{self, Report};
use super::route::route;
use super::{Failure, Status};
use picot::diag::{Sink, Sources, did_you_mean};
use picot::frontend::{Input, mesh};
use picot::shape::{Shape, Tube, export};
use std::path::{Path, PathBuf};

pub(crate) fn run(arguments: &Surface, report: Report) -> Result<Status, Failure> {
    let loops = match arguments
        .output
        .rsplit_once('.')
        .map(|(_, extension)| extension.to_lowercase())
        .as_deref()
    {
        Some("obj") => false,
        Some("loops") => true,
        Some("toml") => return shape_file(arguments, report),
        _ => {
            return Err(Failure::usage(format!("`{}` is not .obj, .loops or .toml", arguments.output)).help(
                "`-o shape.obj` is for modeling tools, `-o shape.loops` the text format of loops, and \
                         `-o shape.toml` the shape file of a mesh",
            ));
        }
    };
    let reader = reader_of(&arguments.input, arguments.reading.from.as_deref())?;
    let routed = route(&arguments.reading, &[])?;
    let stdin = files::stdin_if_named([&arguments.input].into_iter())?;
    let mut sources = Sources::new(&files::load);
    let mut sink = Sink::new();
    let source = files::open(&mut sources, &arguments.input, &stdin)?;
    let input = picot::read(&source, reader, &routed.options, &mut sources, &mut sink);
    report::print(&report.render(&sources, sink.diagnostics()));
    let shape = match input {
        Some(Input::Shape(shape)) => shape,
        Some(Input::Program(_) | Input::Code(_)) => {
            return Err(Failure::usage(format!("`{}` has no surface", arguments.input))
                .help("a shape file, a mesh or a file of loops has one"));
        }
        None => return Ok(Status::InputErrors),
    };
    let text = if loops {
        export::loops(&shape.name, chosen(&shape, arguments.part.as_deref())?, &shape.gauge)
    } else {
        export::obj(&shape)
    };
    files::write_all(&[(Place::File(PathBuf::from(&arguments.output)), text.into_bytes())])?;
    Ok(Status::Fine)
}

/// Writes what is found in a mesh as a shape file.
fn shape_file(arguments: &Surface, report: Report) -> Result<Status, Failure> {
    let reader = reader_of(&arguments.input, arguments.reading.from.as_deref())?;
    if !["obj", "stl", "ply", "gltf"].contains(&reader.name) || arguments.input == "-" {
        return Err(Failure::usage(format!("`{}` is no mesh", arguments.input))
            .help("a shape file is written of what is found in a mesh: .obj, .stl, .ply, .glb or .gltf"));
    }
    let routed = route(&arguments.reading, &[])?;
    let Some(gauge) = routed.options.gauge else {
        return Err(Failure::usage("a mesh does not say how large a stitch is".to_owned())
            .help("add --gauge, for example --gauge 5mmx5mm"));
    };
    let mut sources = Sources::new(&files::load);
    let mut sink = Sink::new();
    let source = files::open(&mut sources, &arguments.input, &[])?;
    let file = beside(Path::new(&arguments.input), Path::new(&arguments.output));
    let reading = routed.options.mesh;
    let text = mesh::shape_file(&source, reader, reading, gauge, &file, &mut sources, &mut sink);
    report::print(&report.render(&sources, sink.diagnostics()));
    let Some(text) = text else { return Ok(Status::InputErrors) };
    files::write_all(&[(Place::File(PathBuf::from(&arguments.output)), text.into_bytes())])?;
    Ok(Status::Fine)
}

/// The name of a file as one in the folder of another one has it.
fn beside(file: &Path, other: &Path) -> String {
    let folder = |path: &Path| {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        folder.unwrap_or(Path::new(".")).canonicalize().ok()
    };
    let name = file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    match (folder(file), folder(other)) {
        (Some(own), Some(other)) if own == other => name,
        (Some(own), _) => own.join(name).to_string_lossy().into_owned(),
        (None, _) => file.to_string_lossy().into_owned(),
    }
}

/// The part to write: the named one, or the only one.
fn chosen<'s>(shape: &'s Shape, part: Option<&str>) -> Result<&'s Tube, Failure> {
    let names = || shape.tubes.iter().map(|tube| tube.name.as_str());
    match (part, shape.tubes.as_slice()) {
        (None, [tube]) => Ok(tube),
        (None, _) => {
            Err(Failure::usage(format!("a file of loops is one tube, and there are {}", shape.tubes.len()))
                .help(format!("choose with --part: {}", names().collect::<Vec<_>>().join(", "))))
        }
        (Some(part), tubes) => tubes.iter().find(|tube| tube.name == part).ok_or_else(|| {
            let near = did_you_mean(part, names());
            let help = near.map_or_else(
                || format!("the parts: {}", names().collect::<Vec<_>>().join(", ")),
                |near| format!("did you mean `{near}`?"),
            );
            Failure::usage(format!("there is no part `{part}`")).help(help)
        }),
    }
}
