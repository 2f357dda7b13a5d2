//! Machine code: lowering and writing tubes of growing size, reading Knitout, and executing it.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use picot::backends::knitout;
use picot::diag::{Sink, Sources};
use picot::frontend;
use picot::ir::machine::{Code, Machine, execute};
use picot::ir::{Block, Finish, Maker, Op, Part, Pattern, Program, Row, Start, Stitch};
use picot::lower::machine::{Options, lower};
use std::hint::black_box;

/// A tube of 60 loops: every sixth row has six increases or decreases, the others are plain.
fn tube(stitches: u32) -> Program {
    let work = |stitch: Stitch, times: u32| Op::Work { stitch, times };
    let shaped = |stitch: Stitch, plain: u32| -> Block {
        let body: Block = [work(Stitch::SC, plain), work(stitch, 1)].into_iter().collect();
        [Op::repeat(body, 6)].into_iter().collect()
    };
    let rows = (0..stitches / 60).map(|row| {
        Row::new(match row % 12 {
            5 => shaped(Stitch::INC, 9),
            6..11 => [work(Stitch::SC, 66)].into_iter().collect(),
            11 => shaped(Stitch::DEC, 9),
            _ => [work(Stitch::SC, 60)].into_iter().collect(),
        })
    });
    let part = Part {
        name: "tube".to_owned(),
        start: Start::Chain { loops: 60, joined: true },
        rows: rows.collect(),
        finish: Finish::Open,
        flat: false,
        copies: 1,
    };
    Program {
        name: "tube".to_owned(),
        gauge: None,
        maker: Maker::default(),
        colors: Vec::new(),
        pattern: Pattern { parts: vec![part] },
        graphs: Vec::new(),
    }
}

fn code(stitches: u32, machine: &Machine) -> Code {
    lower(&tube(stitches), machine, &Options::default(), &mut Sink::new()).expect("it can be knit").code
}

fn text(code: &Code) -> Vec<u8> {
    let mut bytes = Vec::new();
    knitout::write(code, &mut bytes).expect("memory");
    bytes
}

fn lowering(criterion: &mut Criterion) {
    let machine = Machine::named("swg091n2").expect("built in");
    let mut group = criterion.benchmark_group("lower and write knitout");
    group.sample_size(10);
    for stitches in [1_550, 100_000] {
        let program = tube(stitches);
        group.throughput(Throughput::Elements(u64::from(stitches)));
        group.bench_with_input(BenchmarkId::from_parameter(stitches), &program, |bencher, program| {
            bencher.iter(|| {
                let made = lower(program, &machine, &Options::default(), &mut Sink::new());
                black_box(text(&made.expect("it can be knit").code))
            });
        });
    }
}

fn reading_and_executing(criterion: &mut Criterion) {
    let machine = Machine::named("swg091n2").expect("built in");
    let code = code(100_000, &machine);
    let bytes = text(&code);
    let mut group = criterion.benchmark_group("knitout");
    group.sample_size(10);
    group.throughput(Throughput::Bytes(bytes.len() as u64));
    group.bench_function("read", |bencher| {
        let loader = |_: &str| Err(std::io::ErrorKind::NotFound.into());
        let mut sources = Sources::new(&loader);
        let source = sources.add("tube.k", bytes.clone()).expect("small");
        bencher.iter(|| black_box(frontend::knitout::read(&source, &mut Sink::new())));
    });
    group.throughput(Throughput::Elements(code.ops().len() as u64));
    group.bench_function("execute", |bencher| {
        bencher.iter(|| black_box(execute(&code, Some(&machine), &mut Sink::new()).report));
    });
}

criterion_group!(benches, lowering, reading_and_executing);
criterion_main!(benches);
