//! Reading written patterns: bytes of text parsed, checked and verified each second (a MB is a million bytes).

#![expect(clippy::disallowed_methods, reason = "the shapes and the patterns are files")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use picot::backends::target;
use picot::diag::{Sink, Source, Sources};
use picot::frontend::crochet::{Conventions, Document};
use picot::frontend::reader;
use picot::ir::verify::verify;
use std::fmt::Write;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// Files of one folder by their ending, in order.
fn files(folder: &str, ending: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = folder.read_dir().expect("a folder of the package").flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    paths.retain(|path| path.extension().is_some_and(|found| found == ending));
    paths.sort();
    paths
}

/// The pattern of a shape, whole: header, remarks and rounds.
fn printed(shape: &Path) -> Vec<u8> {
    let loader = |name: &str| std::fs::read(name);
    let mut sources = Sources::new(&loader);
    let mut sink = Sink::new();
    let source = sources.open(&shape.to_string_lossy()).expect("a shape");
    let reader = reader("shape").expect("listed");
    let options = picot::Options::default();
    let program = picot::compile(&source, reader, &options, &mut sources, &mut sink).expect("compiles");
    let verified = verify(&program, &mut sink).expect("verifies");
    let backend = target("crochet").expect("listed").configure(toml::Table::new()).expect("defaults");
    let mut out = Vec::new();
    backend.emit(&verified, &mut out, &mut sink).expect("prints");
    out
}

/// Files as they are read in practice: the patterns of all shapes, and patterns by hand in the manners of ten makers.
fn patterns() -> Vec<Vec<u8>> {
    let shapes = files("shapes", "toml");
    let by_hand = files("tests/it/cases/patterns", "txt");
    let texts = by_hand.iter().map(|path| std::fs::read(path).expect("a pattern"));
    shapes.iter().map(|shape| printed(shape)).chain(texts).collect()
}

/// One file of nothing but rounds, in the words of makers: no remark or heading to skip over.
fn rounds(count: u32) -> Vec<u8> {
    let mut text = String::from("Rnd 1: 6 sc in MR (6)\nRnd 2: inc around (12)\nRnd 3: (sc, inc) x 6 (18)\n");
    for round in 4..=count {
        let body = match round % 3 {
            0 => "(5 sc, dec, inc) x 2, 2 sc",
            1 => "sc in each st around",
            _ => "*sc in next 4 sts, inc, dec; rep from * to last 4 sts, 4 sc",
        };
        let _ = writeln!(text, "Rnd {round}: {body} (18)");
    }
    text.into_bytes()
}

fn parse(source: &Source, conventions: &Conventions) {
    black_box(Document::parse(source, conventions.language, &mut Sink::new()));
}

fn parse_and_verify(source: &Source, conventions: &Conventions) {
    let mut sink = Sink::new();
    let document = Document::parse(source, conventions.language, &mut sink).expect("text");
    let program = document.check(conventions, &mut sink).program.expect("no errors");
    black_box(verify(&program, &mut sink).expect("it can be worked"));
}

fn read(criterion: &mut Criterion) {
    let loader = |_: &str| Err(std::io::Error::other("no files"));
    let conventions = Conventions::default();
    let mut group = criterion.benchmark_group("read");
    for (name, texts) in [("patterns", patterns()), ("rounds", vec![rounds(20_000)])] {
        let mut sources = Sources::new(&loader);
        let open = |text: Vec<u8>| sources.add("bench.txt", text).expect("small");
        let opened: Vec<Rc<Source>> = texts.into_iter().map(open).collect();
        let bytes = opened.iter().map(|source| source.bytes().len() as u64).sum();
        group.throughput(Throughput::BytesDecimal(bytes)).sample_size(20);
        for (what, run) in
            [("parse", parse as fn(&Source, &Conventions)), ("parse and verify", parse_and_verify)]
        {
            group.bench_function(BenchmarkId::new(what, name), |bencher| {
                bencher.iter(|| opened.iter().for_each(|source| run(source, &conventions)));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, read);
criterion_main!(benches);
