//! Reading written patterns: bytes of text parsed and checked each second.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use picot::diag::{Sink, Sources};
use picot::frontend::crochet::{Conventions, Document};
use std::fmt::Write;

/// Rounds as people write them, with repeats, ranges and counts.
fn pattern(rounds: u32) -> String {
    let mut text = String::from("Rnd 1: 6 sc in MR (6)\nRnd 2: inc around (12)\nRnd 3: (sc, inc) x 6 (18)\n");
    for round in 4..=rounds {
        let body = match round % 3 {
            0 => "(5 sc, dec, inc) x 2, 2 sc",
            1 => "sc in each st around",
            _ => "*sc in next 4 sts, inc, dec; rep from * to last 4 sts, 4 sc",
        };
        let _ = writeln!(text, "Rnd {round}: {body} (18)");
    }
    text
}

fn read(criterion: &mut Criterion) {
    let text = pattern(20_000).into_bytes();
    let loader = |_: &str| Err(std::io::Error::other("no files"));
    let mut sources = Sources::new(&loader);
    let Ok(source) = sources.add("bench.txt", text.clone()) else { return };
    let conventions = Conventions::default();
    let mut group = criterion.benchmark_group("read");
    group.throughput(Throughput::Bytes(text.len() as u64)).sample_size(20);
    group.bench_function("parse", |bencher| {
        bencher.iter(|| Document::parse(&source, conventions.language, &mut Sink::new()).is_some());
    });
    group.bench_function("parse and check", |bencher| {
        bencher.iter(|| {
            let mut sink = Sink::new();
            let document = Document::parse(&source, conventions.language, &mut sink);
            document.is_some_and(|document| document.check(&conventions, &mut sink).program.is_some())
        });
    });
    group.finish();
}

criterion_group!(benches, read);
criterion_main!(benches);
