//! The preset for live editing: as sound as the default, and not much coarser.

use picot::diag::{Sink, Sources};
use picot::frontend::{Input, reader};
use picot::generate::Preset;
use picot::ir::Gauge;
use picot::ir::verify::verify;
use std::fs;
use std::path::Path;

/// Every shape that we ship comes out in a hurry: it can be worked, hardly a tile lies with its inside out, and edges are off
/// by less than a twentieth on average, as by default they are by a thirtieth.
#[test]
#[expect(clippy::disallowed_methods, reason = "the shapes are files")]
fn a_hurried_try_is_sound() {
    let (mut sum, mut count, mut inverted) = (0.0, 0.0, 0);
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("shapes");
    for folder in [root.clone(), root.join("paper")] {
        let mut files: Vec<_> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        for file in files.iter().filter(|file| file.extension().is_some_and(|it| it == "toml")) {
            let loader = |name: &str| fs::read(folder.join(name));
            let mut sources = Sources::new(&loader);
            let mut sink = Sink::new();
            let source = sources.add("shape", fs::read(file).unwrap()).unwrap();
            let mut options = picot::Options::default();
            options.generate.preset = Preset::Fast;
            let read = picot::read(&source, reader("shape").unwrap(), &options, &mut sources, &mut sink);
            let Some(Input::Shape(shape)) = read else { panic!("{}", file.display()) };
            let program = picot::program(&shape, &options, &mut sink).expect("generates");
            assert!(verify(&program, &mut sink).is_some(), "{}", file.display());
            let measure = picot::measure(&shape, &program);
            inverted += measure.inverted_tiles;
            assert!(measure.inverted_tiles <= 1, "{}", file.display());
            sum += measure.length_error.chord.mean_abs;
            count += 1.0;
        }
    }
    assert!(inverted <= 3, "{inverted}");
    assert!(count > 20.0 && sum / count < 0.05, "{}", sum / count);
}

/// A tight bend on few stitches comes out a seventh too long in a hurry: then it is made without.
#[test]
#[expect(clippy::disallowed_methods, reason = "the shape is a file")]
fn a_hurried_try_that_is_far_off_is_made_again() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("shapes/elbow.toml");
    let loader = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    let mut sources = Sources::new(&loader);
    let mut sink = Sink::new();
    let source = sources.add("shape", fs::read(file).unwrap()).unwrap();
    let mut options = picot::Options { gauge: Some(Gauge::new(2.5, 2.5)), ..picot::Options::default() };
    options.generate.preset = Preset::Fast;
    let read = picot::read(&source, reader("shape").unwrap(), &options, &mut sources, &mut sink);
    let Some(Input::Shape(shape)) = read else { panic!("{:?}", sink.diagnostics()) };
    let program = picot::program(&shape, &options, &mut sink).expect("generates");
    let measure = picot::measure(&shape, &program);
    assert!(measure.length_error.chord.mean_abs < 0.07, "{:?}", measure.length_error.chord);
}
