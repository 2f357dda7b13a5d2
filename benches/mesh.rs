//! Meshes, from the bytes of a file to the text of a pattern: a cactus at three gauges, and closed forms with ever more
//! triangles.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group};
use glam::DVec3;
use picot::backends::target;
use picot::diag::{Sink, Sources};
use picot::frontend::mesh::{Reading, Up};
use picot::frontend::{Unit, reader};
use picot::ir::Gauge;
use picot::ir::verify::verify;
use picot::math::{PI, cos, exp, sin};
use solids::{Solid, capsule, union};
use std::hint::black_box;

#[expect(dead_code, reason = "made for the tests")]
#[path = "../tests/it/solids.rs"]
mod solids;

/// Compiles an OBJ file to text; the number of stitches.
fn compile(file: &[u8], unit: Unit, size: f64) -> u64 {
    let loader = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    let mut sources = Sources::new(&loader);
    let mut sink = Sink::new();
    let options = picot::Options {
        gauge: Some(Gauge::new(size, size)),
        mesh: Reading { unit: Some(unit), up: Some(Up::Z) },
        ..picot::Options::default()
    };
    let source = sources.add("mesh.obj", file.to_vec()).expect("small");
    let reader = reader("obj").expect("listed");
    let program = picot::compile(&source, reader, &options, &mut sources, &mut sink);
    let program = program.unwrap_or_else(|| panic!("{:?}", sink.diagnostics()));
    let verified = verify(&program, &mut sink).expect("verifies");
    let backend = target("crochet").expect("listed").configure(toml::Table::new()).expect("defaults");
    let mut out = Vec::new();
    backend.emit(&verified, &mut out, &mut sink).expect("prints");
    black_box(out);
    verified.facts().stitches(&verified)
}

/// A surface given by a function of two shares, closed at both ends.
fn tube(rows: u32, around: u32, point: impl Fn(f64, f64) -> DVec3) -> Vec<u8> {
    let share = |k: u32, all: u32| f64::from(k) / f64::from(all);
    let ring = |i: u32| (0..around).map(|j| point(share(i, rows), share(j, around))).collect();
    let rings: Vec<Vec<DVec3>> = (1..rows).map(ring).collect();
    Solid::tube(&rings, [Some(point(0.0, 0.0)), Some(point(1.0, 0.0))]).obj()
}

/// A capsule of radius 45 mm along an arc of radius 150 mm.
fn bent(u: f64, v: f64) -> DVec3 {
    const RADIUS: f64 = 45.0;
    const ARC: f64 = 150.0;
    const ANGLE: f64 = 0.75 * PI;
    let cap = 0.5 * PI * RADIUS;
    let at = u * (ARC * ANGLE + 2.0 * cap);
    let (radius, past, angle) = if at < cap {
        (RADIUS * sin(at / RADIUS), -RADIUS * cos(at / RADIUS), 0.0)
    } else if at > cap + ARC * ANGLE {
        let rest = (at - cap - ARC * ANGLE) / RADIUS;
        (RADIUS * cos(rest), RADIUS * sin(rest), ANGLE)
    } else {
        (RADIUS, 0.0, (at - cap) / ARC)
    };
    let (out, along) = (DVec3::new(cos(angle), 0.0, sin(angle)), DVec3::new(-sin(angle), 0.0, cos(angle)));
    let turn = 2.0 * PI * v;
    out * (ARC + radius * cos(turn)) + DVec3::Y * (radius * sin(turn)) + along * past
}

/// A ball of radius 60 mm with four limbs, seen from its middle.
fn limbs(u: f64, v: f64) -> DVec3 {
    let (polar, turn) = (PI * u, 2.0 * PI * v);
    let way = DVec3::new(sin(polar) * cos(turn), sin(polar) * sin(turn), -cos(polar));
    let limb = |k: u32| {
        let angle = 0.5 * PI * f64::from(k);
        let cosine = way.dot(DVec3::new(cos(angle), sin(angle), 0.0)).max(0.0);
        // A smooth bump about 20 degrees wide.
        90.0 * exp(-(1.0 - cosine) / 0.045)
    };
    way * (60.0 + (0..4).map(limb).sum::<f64>())
}

fn cactus(criterion: &mut Criterion) {
    gauges(criterion, "cactus", &cactus_mesh(), Unit::Mm);
}

/// A mesh of one's own: the file that `PICOT_MESH` names, in centimeters.
#[expect(clippy::disallowed_methods, reason = "the mesh to time is named from the outside")]
fn given(criterion: &mut Criterion) {
    let Some(path) = std::env::var_os("PICOT_MESH") else { return };
    gauges(criterion, "given", &std::fs::read(path).expect("an OBJ file"), Unit::Cm);
}

fn gauges(criterion: &mut Criterion, name: &str, text: &[u8], unit: Unit) {
    let mut group = criterion.benchmark_group(name);
    for size in [2.5, 2.0, 1.5] {
        group.throughput(Throughput::Elements(compile(text, unit, size)));
        group.bench_with_input(BenchmarkId::from_parameter(size), &size, |bencher, size| {
            bencher.iter(|| compile(text, unit, *size));
        });
    }
    group.finish();
}

/// A trunk of 10 cm with an arm that bends up, about as many triangles as a modeling tool would give it.
fn cactus_mesh() -> Vec<u8> {
    let at = DVec3::new;
    let shape = |p: DVec3| {
        let arm = capsule(p, at(0., 0., 10.), at(40., 0., 10.), 9.4).min(capsule(
            p,
            at(40., 0., 10.),
            at(40., 0., 40.),
            9.4,
        ));
        union(capsule(p, at(0., 0., -31.), at(0., 0., 51.), 9.4), arm, 3.0)
    };
    Solid::level_set(shape, at(-12., -12., -44.), at(52., 12., 64.), 5.0).obj()
}

fn large(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("triangles");
    group.sample_size(10);
    for (rows, around) in [(80, 64), (250, 200), (830, 600)] {
        for (name, text) in [("bent", tube(rows, around, bent)), ("limbs", tube(rows, around, limbs))] {
            let triangles = u64::from(2 * (rows - 1) * around);
            group.throughput(Throughput::Elements(triangles));
            group.bench_with_input(BenchmarkId::new(name, triangles), &text, |bencher, text| {
                bencher.iter(|| compile(text, Unit::Mm, 5.0));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, cactus, given, large);

/// As the program does it.
fn main() {
    picot::process::set_up();
    benches();
    Criterion::default().configure_from_args().final_summary();
}
