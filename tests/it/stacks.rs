//! The text format of loops: what is written is read again, surfaces come out as sound meshes, and faults are named.

use crate::solids::circle;
use glam::DVec3;
use picot::diag::{Diagnostic, Sink, Sources};
use picot::frontend::{Input, reader_for_extension};
use picot::ir::verify::verify;
use picot::math::TAU;
use picot::shape::{Shape, export, measure::area};
use picot::{Options, read};
use std::fmt::Write;
use std::io;

fn load(name: &str, bytes: &[u8], options: &Options) -> (Option<Shape>, Vec<Diagnostic>) {
    let loader = |_: &str| Err(io::ErrorKind::NotFound.into());
    let mut sources = Sources::new(&loader);
    let source = sources.add(name, bytes.to_vec()).expect("small");
    let mut sink = Sink::new();
    let reader = reader_for_extension(name.rsplit('.').next().unwrap_or_default()).expect("listed");
    let shape = match read(&source, reader, options, &mut sources, &mut sink) {
        Some(Input::Shape(shape)) => Some(*shape),
        Some(_) => panic!("no shape"),
        None => None,
    };
    (shape, sink.take())
}

fn shapes() -> Vec<(&'static str, Shape)> {
    let names = ["ball", "pear", "bottle", "goose", "horn", "paper/d", "cactus"];
    let shape = |name: &&'static str| {
        let path = format!("{}/shapes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        #[expect(clippy::disallowed_methods, reason = "tests read their cases from the disk")]
        let text = std::fs::read(path).expect("readable");
        (*name, load("x.toml", &text, &Options::default()).0.expect("a sound file"))
    };
    names.iter().map(shape).collect()
}

fn stitches(shape: &Shape) -> usize {
    let mut sink = Sink::new();
    let program = picot::program(shape, &Options::default(), &mut sink).expect("sound");
    assert!(verify(&program, &mut sink).is_some(), "{:#?}", sink.diagnostics());
    program.graphs[0].nodes.len()
}

#[test]
fn what_is_written_is_read_again() {
    for (name, shape) in shapes() {
        let tube = &shape.tubes[0];
        let text = export::loops(&shape.name, tube, &shape.gauge);
        let (again, found) = load("x.loops", text.as_bytes(), &Options::default());
        let again = again.unwrap_or_else(|| panic!("{name}: {found:#?}"));
        assert_eq!((&again.name, again.gauge), (&shape.name, shape.gauge), "{name}");
        let other = &again.tubes[0];
        assert_eq!([other.start, other.end], [tube.start, tube.end], "{name}");
        let [one, two] = [&tube.surface, &other.surface].map(|surface| area(&**surface, 60, 48));
        assert!((two / one - 1.0).abs() < 0.01, "{name}: {one} {two}");
        // The second time nothing changes but rounding.
        let single = Shape { tubes: shape.tubes.into_iter().take(1).collect(), ..again };
        let (one, two) = (
            stitches(&single),
            stitches(&load("x.loops", text.as_bytes(), &Options::default()).0.expect("read")),
        );
        assert!((two as f64 / one as f64 - 1.0).abs() < 0.03, "{name}: {one} {two}");
    }
}

#[test]
fn a_surface_is_written_as_a_sound_mesh() {
    for (name, shape) in
        shapes().into_iter().filter(|(name, shape)| shape.tubes.len() == 1 && *name != "goose")
    {
        let text = export::obj(&shape);
        let options = Options { gauge: Some(shape.gauge), ..Options::default() };
        let (again, found) = load("x.obj", text.as_bytes(), &options);
        let again = again.unwrap_or_else(|| panic!("{name}: {found:#?}"));
        assert!(found.iter().all(|it| it.code.as_str() != "N4301"), "{name}: nothing to repair: {found:#?}");
        assert_eq!(again.tubes.len(), 1, "{name}");
        let [one, two] = [&shape, &again].map(|shape| area(&*shape.tubes[0].surface, 60, 48));
        assert!((two / one - 1.0).abs() < 0.03, "{name}: {one} {two}");
    }
}

/// Level circles at the given heights, all turned the same way.
fn stack(heights: &[f64], clockwise: bool) -> String {
    let mut text = "picot-loops 1\nunit mm\ngauge 5 5\n".to_owned();
    for height in heights {
        text.push_str("loop # a level circle\r\n");
        let mut ring = circle(20.0, *height, 32);
        if clockwise {
            ring.reverse();
        }
        for p in ring {
            let _ = writeln!(text, "{:.4} {:.4} {:.4}", p.x, p.y, p.z);
        }
    }
    text
}

#[test]
fn loops_may_run_either_way() {
    for clockwise in [true, false] {
        let text = stack(&[0.0, 20.0, 40.0], clockwise);
        let shape = load("x.loops", text.as_bytes(), &Options::default()).0.expect("sound");
        let jet = shape.tubes[0].surface.jet(0.5, 0.3);
        assert!(jet.du.cross(jet.dv).dot(DVec3::new(jet.point.x, jet.point.y, 0.0)) > 0.0);
        assert!((area(&*shape.tubes[0].surface, 20, 32) / (TAU * 20.0 * 40.0) - 1.0).abs() < 0.01);
    }
}

#[test]
fn faults_of_loops_are_named() {
    let fine = stack(&[0.0, 20.0, 40.0], true);
    let crossing = {
        let (head, ring) = fine.rsplit_once("loop").expect("a loop");
        // The last loop is tilted through the one before it.
        let mut tilted = String::new();
        for line in ring.lines().skip(1) {
            let x: f64 = line.split(' ').next().and_then(|x| x.parse().ok()).expect("a number");
            let (rest, _) = line.rsplit_once(' ').expect("three numbers");
            let _ = writeln!(tilted, "{rest} {}", 21.0 + 1.5 * x);
        }
        format!("{head}loop\n{tilted}")
    };
    let cases = [
        (String::new(), "E4006"),
        ("picot-loops 2\n".to_owned(), "E4006"),
        ("picot-loops 1\ngauge 5 5\n".to_owned(), "E4006"),
        ("picot-loops 1\n1 2 3\n".to_owned(), "E4006"),
        ("picot-loops 1\ngauge 5 5\nloop\n1 2 3\n1 2 3\nloop\n".to_owned(), "E4006"),
        (fine.replace("unit mm", "unit yd"), "E4006"),
        (fine.replace("gauge 5 5", "gauge 5 0"), "E4006"),
        (fine.replace("gauge 5 5", "gauge 5 5\ngauge 5 5"), "E4006"),
        (fine.replacen("0.0000", "nan", 1), "E4006"),
        (fine.replace("gauge 5 5\n", ""), "E0108"),
        (crossing, "E4107"),
    ];
    for (text, code) in cases {
        let (shape, found) = load("x.loops", text.as_bytes(), &Options::default());
        assert!(shape.is_none(), "{text:.200}");
        assert_eq!(found.len(), 1, "{found:#?}");
        assert!(found[0].help.is_some() && !found[0].labels.is_empty(), "{found:#?}");
        if code != "E0108" {
            assert_eq!(found[0].code.as_str(), code, "{found:#?}");
        }
    }
}

#[test]
fn no_text_breaks_the_reader_of_loops() {
    let fine = stack(&[0.0, 10.0], true).into_bytes();
    let mut seed = 5_u32;
    let mut random = |below: usize| {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as usize % below
    };
    for _ in 0..400 {
        let mut bytes = fine.clone();
        for _ in 0..=random(6) {
            let at = random(bytes.len());
            match random(4) {
                0 => bytes[at] = random(256) as u8,
                1 => drop(bytes.drain(at..(at + random(40)).min(bytes.len()))),
                2 => bytes.truncate(at.max(1)),
                _ => bytes.insert(at, b"0123456789.e- \nloop"[random(19)]),
            }
        }
        let (shape, found) = load("x.loops", &bytes, &Options::default());
        assert!(shape.is_some() || !found.is_empty());
    }
}
