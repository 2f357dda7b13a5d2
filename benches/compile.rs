//! Whole compiles, from the text of a shape to the text of a pattern: the paper's shapes at its stitch sizes, and ever
//! finer stitches on one shape to show that the cost of a stitch stays the same; and the generator alone, in a hurry and
//! without settling.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group};
use picot::backends::target;
use picot::diag::{Sink, Sources};
use picot::frontend::{Input, reader};
use picot::generate::Preset;
use picot::ir::Gauge;
use picot::ir::verify::verify;
use picot::shape::{Shape, area};
use std::hint::black_box;

const SHAPES: [(&str, &str); 4] = [
    ("a", include_str!("../shapes/paper/a.toml")),
    ("b", include_str!("../shapes/paper/b.toml")),
    ("c", include_str!("../shapes/paper/c.toml")),
    ("d", include_str!("../shapes/paper/d.toml")),
];

/// Compiles to text; the number of stitches.
fn compile(text: &str, size: f64) -> u64 {
    let loader = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    let mut sources = Sources::new(&loader);
    let mut sink = Sink::new();
    let options = picot::Options { gauge: Some(Gauge::new(size, size)), ..picot::Options::default() };
    let source = sources.add("shape", text.as_bytes().to_vec()).expect("small");
    let reader = reader("shape").expect("listed");
    let program = picot::compile(&source, reader, &options, &mut sources, &mut sink).expect("compiles");
    let verified = verify(&program, &mut sink).expect("verifies");
    let backend = target("crochet").expect("listed").configure(toml::Table::new()).expect("defaults");
    let mut out = Vec::new();
    backend.emit(&verified, &mut out, &mut sink).expect("prints");
    black_box(out);
    verified.facts().stitches(&verified)
}

fn read(text: &str, options: &picot::Options) -> Shape {
    let loader = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    let mut sources = Sources::new(&loader);
    let source = sources.add("shape", text.as_bytes().to_vec()).expect("small");
    let reader = reader("shape").expect("listed");
    let input = picot::read(&source, reader, options, &mut sources, &mut Sink::new());
    let Some(Input::Shape(shape)) = input else { panic!("a shape") };
    *shape
}

fn paper(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("paper");
    for (name, text) in SHAPES {
        for size in [2.5, 2.0, 1.5] {
            group.throughput(Throughput::Elements(compile(text, size)));
            let id = BenchmarkId::new(name, size);
            group.bench_with_input(id, &size, |bencher, size| bencher.iter(|| compile(text, *size)));
        }
    }
    group.finish();
}

fn scale(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("scale");
    group.sample_size(10);
    let (_, text) = SHAPES[3];
    let shape = read(text, &picot::Options::default());
    let area: f64 = shape.tubes.iter().map(|tube| area(&*tube.surface, 64, 64)).sum();
    for size in [2.4, 2.0, 1.5, 1.0, 0.78, 0.5, 0.247, 0.0782, 0.0248] {
        // To a hundredth or so: to count them takes a compile, which a filter would not spare.
        group.throughput(Throughput::Elements((area / (size * size)) as u64));
        group.bench_with_input(BenchmarkId::new("d", size), &size, |bencher, size| {
            bencher.iter(|| compile(text, *size));
        });
    }
    group.finish();
}

fn generator(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("generator");
    for (name, text) in &SHAPES[2..] {
        let mut sink = Sink::new();
        let mut options = picot::Options { gauge: Some(Gauge::new(1.5, 1.5)), ..picot::Options::default() };
        let shape = read(text, &options);
        for way in ["std", "fast", "not settled"] {
            options.generate = picot::generate::Options::default();
            match way {
                "fast" => options.generate.preset = Preset::Fast,
                "not settled" => (options.generate.sweeps, options.generate.window_sweeps) = (0, 0),
                _ => {}
            }
            let stitches = |program: &picot::ir::Program| program.graphs[0].nodes.len() as u64;
            let once = picot::program(&shape, &options, &mut sink).expect("generates");
            group.throughput(Throughput::Elements(stitches(&once)));
            group.bench_with_input(BenchmarkId::new(*name, way), &options, |bencher, options| {
                bencher.iter(|| black_box(picot::program(&shape, options, &mut Sink::new())));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, paper, scale, generator);

/// As the program does it.
fn main() {
    picot::process::set_up();
    benches();
    Criterion::default().configure_from_args().final_summary();
}
