//! Scenes, their yarn and triangles, and predicted shapes.

use super::charts::written;
use super::snapshots::shapes;
use picot::backends::target;
use picot::diag::{Sink, Sources};
use picot::frontend::reader;
use picot::ir::Program;
use picot::ir::verify::verify;
use picot::preview::{Mesh, Places, Refused, Scene, View};
use std::collections::BTreeMap;
use std::path::Path;

#[expect(clippy::disallowed_methods, reason = "tests read their cases from the disk")]
fn load(name: &str) -> std::io::Result<Vec<u8>> {
    std::fs::read(name)
}

fn compile(path: &Path, kind: &str, options: &picot::Options) -> Option<Program> {
    let mut sources = Sources::new(&load);
    let mut sink = Sink::new();
    let source = sources.open(path.to_str()?).ok()?;
    picot::compile(&source, reader(kind)?, options, &mut sources, &mut sink)
}

fn shape(name: &str) -> Program {
    let path = shapes().into_iter().find(|(shape, _)| shape == name).expect("a shape").1;
    compile(&path, "shape", &picot::Options::default()).expect("it compiles")
}

fn scene(program: &Program) -> Result<Scene, Refused> {
    let verified = verify(program, &mut Sink::new()).expect("workable");
    Scene::new(&verified, None, Places::Target, &Sink::new())
}

fn patterns() -> Vec<std::path::PathBuf> {
    super::tidy::files("tests/it/cases/patterns", "txt")
}

#[test]
fn yarn_goes_on_in_place_and_direction_along_every_piece() {
    for (name, path) in shapes() {
        let program = compile(&path, "shape", &picot::Options::default()).expect("it compiles");
        let scene = scene(&program).expect("a scene");
        for piece in &scene.pieces {
            let curves: Vec<_> = piece.yarn.curves().collect();
            let stitches: Vec<u32> = curves.iter().map(|curve| curve.stitch).collect();
            assert!(stitches.is_sorted(), "{name}: the yarn goes back");
            assert_eq!(stitches.first().map(|k| *k as usize), Some(piece.stitches.start), "{name}");
            for pair in curves.windows(2) {
                let gap = pair[0].at(1.0).distance(pair[1].at(0.0));
                let (into, out) = (pair[0].slope(1.0), pair[1].slope(0.0));
                let angle = into.angle_between(out).to_degrees();
                assert!(
                    gap <= 1e-9 && angle < 0.01,
                    "{name}, stitch {}: {gap} mm, {angle} degrees",
                    pair[1].stitch
                );
            }
        }
    }
}

/// Every edge once in each direction, and a volume inside.
fn closed(mesh: &Mesh, name: &str) {
    // Corners of a box have a vertex for each face.
    let place = |k: u32| mesh.positions[k as usize].map(f32::to_bits);
    let mut edges: BTreeMap<([u32; 3], [u32; 3]), i32> = BTreeMap::new();
    let mut volume = 0.0;
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|k| glam::Vec3::from_array(mesh.positions[k as usize]).as_dvec3());
        volume += a.dot(b.cross(c)) / 6.0;
        for (from, to) in [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (place(triangle[a]), place(triangle[b]))) {
            if from == to {
                continue;
            }
            *edges.entry((from.min(to), from.max(to))).or_default() += if from < to { 1 } else { -1 };
        }
    }
    assert!(volume > 0.0, "{name}: inside out");
    let open = edges.values().filter(|sum| **sum != 0).count();
    assert_eq!(open, 0, "{name}: {open} open edges of {}", edges.len());
}

#[test]
fn triangles_are_closed_and_turn_outward() {
    for name in ["ball", "paper-c", "paper-d", "goose", "cane"] {
        let program = shape(name);
        let scene = scene(&program).expect("a scene");
        for view in [View::Realistic, View::Wireframe] {
            let mesh = Mesh::of(&scene, view, Some(1), 0).expect("small");
            assert!(mesh.positions.iter().flatten().all(|x| x.is_finite()), "{name}");
            closed(&mesh, name);
        }
    }
}

#[test]
fn written_patterns_have_a_scene() {
    for path in patterns() {
        let Some(program) = compile(&path, "crochet", &picot::Options::default()) else { continue };
        let Some(verified) = verify(&program, &mut Sink::new()) else { continue };
        let scene = Scene::new(&verified, None, Places::Target, &Sink::new());
        let scene = scene.unwrap_or_else(|refused| panic!("{}: {refused}", path.display()));
        let rest = scene.predicted.expect("no graph");
        assert!(rest.residual.is_finite() && rest.strain.is_finite(), "{}: {rest:?}", path.display());
        assert!(scene.stitches.iter().flat_map(|stitch| stitch.corners).all(glam::DVec3::is_finite));
    }
}

fn fit(program: &Program) -> picot::preview::predict::Fit {
    let verified = verify(program, &mut Sink::new()).expect("workable");
    picot::predict(&verified, &Sink::new()).expect("predicted").expect("a target")
}

#[test]
fn predictions_come_near_the_target() {
    for name in ["cylinder", "paper-a", "paper-b", "paper-c", "paper-d", "ball", "horn"] {
        let fit = fit(&shape(name));
        assert!(fit.rest.converged && fit.chamfer <= 0.5, "{name}: {fit:?}");
    }
}

#[test]
fn without_its_short_rows_a_bent_tube_is_predicted_straight() {
    let with = fit(&shape("paper-d"));
    let path = shapes().into_iter().find(|(shape, _)| shape == "paper-d").expect("a shape").1;
    let mut options = picot::Options::default();
    options.generate.short_rows = false;
    let without = fit(&compile(&path, "shape", &options).expect("it compiles"));
    assert!(with.chamfer <= 0.5, "{with:?}");
    assert!(without.chamfer > 5.0 * with.chamfer, "{with:?} {without:?}");
}

#[test]
fn glb_and_stl_say_what_they_hold() {
    let program = shape("ball");
    let verified = verify(&program, &mut Sink::new()).expect("workable");
    let emit = |name: &str, options: &str| {
        let mut bytes = Vec::new();
        let backend =
            target(name).expect("listed").configure(options.parse().expect("TOML")).expect("options");
        backend.emit(&verified, &mut bytes, &mut Sink::new()).expect("written");
        bytes
    };
    let word =
        |bytes: &[u8], at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four")) as usize;
    let stl = emit("stl", "view = 'wireframe'");
    assert_eq!(stl.len(), 84 + 50 * word(&stl, 80));
    let glb = emit("gltf", "detail = 1");
    assert_eq!((&glb[..4], word(&glb, 8)), (&b"glTF"[..], glb.len()));
    let text = &glb[20..20 + word(&glb, 12)];
    let document: serde_json::Value = serde_json::from_slice(text).expect("JSON");
    let stitches = scene(&program).expect("a scene").stitches.len();
    let attributes = &document["meshes"][0]["primitives"][0]["attributes"];
    let accessor = &document["accessors"][attributes["_STITCH"].as_u64().expect("an index") as usize];
    let view = &document["bufferViews"][accessor["bufferView"].as_u64().expect("an index") as usize];
    let start = 28 + word(&glb, 12) + view["byteOffset"].as_u64().expect("a number") as usize;
    let ids: Vec<f32> = (0..accessor["count"].as_u64().expect("a number") as usize)
        .map(|k| f32::from_bits(word(&glb, start + 4 * k) as u32))
        .collect();
    assert_eq!(ids.iter().copied().fold(0.0, f32::max) as usize, stitches - 1);
}

/// Distances in yarn thicknesses from points along the yarn to the nearest other piece of yarn, more than three
/// thicknesses away along it. The first and last tenth are left out.
fn gaps(scene: &Scene) -> Vec<f64> {
    const PARTS: u32 = 6;
    let thick = scene.yarn;
    let mut points: Vec<(f64, glam::DVec3)> = Vec::new();
    for curve in scene.pieces[0].yarn.curves() {
        for k in 0..PARTS {
            let at = curve.at(f64::from(k) / f64::from(PARTS));
            let way = points.last().map_or(0.0, |(way, last)| way + last.distance(at));
            points.push((way, at));
        }
    }
    let cell = |at: glam::DVec3| (at / (2.0 * thick)).floor().to_array().map(|k| k as i64);
    let mut cells: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
    for (index, (_, at)) in points.iter().enumerate() {
        cells.entry(cell(*at)).or_default().push(index);
    }
    let gap = |&(way, at): &(f64, glam::DVec3)| {
        let [x, y, z] = cell(at);
        let near = (0..27).filter_map(|k| cells.get(&[x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]));
        near.flatten()
            .map(|other| points[*other])
            .filter(|(other, _)| (way - other).abs() > 3.0 * thick)
            .map(|(_, other)| other.distance(at) / thick)
            .fold(2.0, f64::min)
    };
    let tenth = points.len() / 10;
    points[tenth..points.len() - tenth].iter().map(gap).collect()
}

#[test]
fn strands_of_yarn_hardly_pass_through_each_other() {
    for (name, deep, half) in [("cylinder", 0.005, 0.5), ("ball", 0.06, 0.3), ("paper-d", 0.08, 0.3)] {
        let gaps = gaps(&scene(&shape(name)).expect("a scene"));
        let share = |below: f64| gaps.iter().filter(|gap| **gap < below).count() as f64 / gaps.len() as f64;
        let least = gaps.iter().copied().fold(2.0, f64::min);
        assert!(share(half) <= deep, "{name}: least {least}, {} {} {}", share(0.3), share(0.5), share(0.8));
    }
}

#[test]
fn too_fine_is_refused_with_the_option_that_helps() {
    let message = Refused::TooFine { triangles: 20_000_000 }.to_string();
    assert!(message.contains("12000000") && message.contains("detail"), "{message}");
}

#[test]
fn what_cannot_be_drawn_is_refused_with_the_limit() {
    let refused =
        |program: &Program| scene(program).err().map(|refused| refused.to_string()).unwrap_or_default();
    let mut holes = shape("ball");
    let nodes = holes.graphs[0].nodes.len();
    holes.graphs[0].nodes.truncate(nodes - 3);
    let mut sink = Sink::new();
    assert!(verify(&holes, &mut sink).is_none());
    let told: Vec<&str> = sink.diagnostics().iter().map(|found| found.message.as_str()).collect();
    assert_eq!(told, ["the pattern makes 432 loops, the graph has 429"]);
    let tall = written("Rnd 1: ch 600, join\nRnds 2-5000: 600 sc (600)\n");
    assert!(refused(&tall).contains("the limit is 300000"), "{}", refused(&tall));
    let wide = written(
        "Ch 2501\nRow 1: sc in 2nd ch from hook, 2499 sc (2500)\nRows 2-40: ch 1, turn, 2500 sc (2500)\n",
    );
    assert!(refused(&wide).contains("more than 240 MB"), "{}", refused(&wide));
}
