//! Previews: pictures and predicted shapes of tubes of growing size.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use picot::backends::{html, svg, target};
use picot::diag::{Sink, Sources};
use picot::frontend::reader;
use picot::ir::Program;
use picot::ir::verify::verify;
use std::hint::black_box;

/// A straight tube of 60 stitches a round.
fn tube(stitches: u32) -> Program {
    let length = f64::from(stitches) / 60.0 * 0.25;
    let shape = format!(
        "name = 'tube'\nunit = 'cm'\n[gauge]\nstitch = {{ width = 0.25, height = 0.25 }}\n[trunk]\n\
         curve = [[0, 0, 0], [0, 0, {length}]]\nsection = [{{ at = 0, circle = 2.39 }}]\n"
    );
    let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    let mut sources = Sources::new(&no_files);
    let source = sources.add("tube.toml", shape.into_bytes()).expect("small");
    let reader = reader("shape").expect("listed");
    picot::compile(&source, reader, &picot::Options::default(), &mut sources, &mut Sink::new())
        .expect("a tube")
}

fn outputs(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("preview");
    group.sample_size(10);
    for stitches in [4_000, 100_000] {
        let program = tube(stitches);
        let verified = verify(&program, &mut Sink::new()).expect("workable");
        for name in ["png", "svg", "gltf", "stl", "html"] {
            // Pages and charts have limits, below which they stay usable.
            let most = match name {
                "html" => html::MAX_STITCHES,
                "svg" => svg::MAX_STITCHES,
                _ => u64::MAX,
            };
            if verified.facts().stitches(&verified) > most {
                continue;
            }
            let backend = target(name).expect("listed").configure(toml::Table::new()).expect("defaults");
            group.bench_with_input(BenchmarkId::new(name, stitches), &(), |bencher, ()| {
                bencher.iter(|| {
                    let mut bytes = Vec::new();
                    backend.emit(&verified, &mut bytes, &mut Sink::new()).expect("written");
                    black_box(bytes.len())
                });
            });
        }
    }
    group.finish();
}

fn prediction(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("predict");
    group.sample_size(10);
    for stitches in [1_000, 4_000] {
        let program = tube(stitches);
        let verified = verify(&program, &mut Sink::new()).expect("workable");
        group.bench_with_input(BenchmarkId::from_parameter(stitches), &(), |bencher, ()| {
            bencher.iter(|| black_box(picot::predict(&verified, &Sink::new()).expect("predicted")));
        });
    }
}

criterion_group!(benches, outputs, prediction);
criterion_main!(benches);
