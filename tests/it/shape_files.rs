//! Shape files: every shipped one reads without a remark, every bad one says what is wrong, and no bytes break the reader.

use picot::diag::position::Positions;
use picot::diag::render::{short, terminal};
use picot::diag::{Code, Diagnostic, Sink, Sources};
use picot::frontend::{Input, reader};
use picot::math;
use picot::shape::Shape;
use proptest::prelude::*;
use std::io;
use std::path::{Path, PathBuf};

fn nothing(_: &str) -> io::Result<Vec<u8>> {
    Err(io::ErrorKind::NotFound.into())
}

/// Reads one file; every diagnostic is rendered in both forms.
fn read(name: &str, bytes: &[u8]) -> (Option<Shape>, Vec<Diagnostic>, String) {
    let mut sources = Sources::new(&nothing);
    let source = sources.add(name, bytes.to_vec()).expect("small");
    let mut sink = Sink::new();
    let input = (reader("shape").expect("listed").read)(&source, &mut sources, &mut sink);
    let positions = Positions::new(&sources);
    let found = sink.take();
    let lines: Vec<String> = found.iter().map(|it| short::short(it, &positions)).collect();
    let blocks: Vec<String> = found.iter().map(|it| terminal::terminal(it, &positions, false)).collect();
    let shape = match input {
        Some(Input::Shape(shape)) => Some(*shape),
        Some(_) => panic!("a shape file gave something else"),
        None => None,
    };
    (shape, found, format!("{}\n\n{}", lines.join("\n"), blocks.join("\n\n")))
}

/// Every TOML file under a folder of the package, sorted.
fn toml_files(folder: &str) -> Vec<PathBuf> {
    fn walk(folder: &Path, files: &mut Vec<PathBuf>) {
        for entry in folder.read_dir().expect("a folder").flatten() {
            let path = entry.path();
            if path.is_dir() {
                walk(&path, files);
            } else if path.extension().is_some_and(|extension| extension == "toml") {
                files.push(path);
            }
        }
    }
    let mut files = Vec::new();
    walk(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), &mut files);
    files.sort();
    files
}

#[expect(clippy::disallowed_methods, reason = "tests read their cases from the disk")]
fn bytes(path: &Path) -> Vec<u8> {
    std::fs::read(path).expect("readable")
}

fn stem(path: &Path) -> &str {
    path.file_stem().and_then(|stem| stem.to_str()).expect("plain names")
}

#[test]
fn every_shipped_shape_reads_without_a_remark() {
    let files = toml_files("shapes");
    assert!(files.len() >= 20, "{}", files.len());
    for path in files {
        let (shape, found, text) = read(stem(&path), &bytes(&path));
        assert!(shape.is_some() && found.is_empty(), "{}\n{text}", path.display());
    }
}

/// The formulas of the two stand-ins, in the words of their files.
#[test]
fn the_stand_ins_of_the_paper_follow_their_formulas() {
    use std::f64::consts::{PI, TAU};
    type Radius = fn(f64, f64) -> f64;
    let a: Radius = |u, v| {
        let (dents, waves) = (math::sin(TAU * v + 4.0 * u) * math::sin(5.0 * u), math::cos(6.0 * u));
        16.0 * (1.0 + 0.10 * dents + 0.06 * waves)
    };
    let b: Radius = |u, v| {
        let (belly, side) = (math::sin(PI * u).powi(2), (0.5 + 0.5 * math::cos(TAU * v)).powi(2));
        6.0 + belly * (9.0 + 8.0 * side)
    };
    for (name, length, radius) in [("a", 122.0, a), ("b", 75.0, b)] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("shapes/paper/{name}.toml"));
        let shape = read(name, &bytes(&path)).0.expect("a shape");
        let mut worst = 0.0_f64;
        for i in 0..=97 {
            for k in 0..101 {
                let point = shape.tubes[0].surface.point(f64::from(i) / 97.0, f64::from(k) / 101.0);
                let v = math::atan2(point.y, point.x) / TAU;
                let expected = radius(point.z / length, v);
                worst = worst.max((point.x.hypot(point.y) / expected - 1.0).abs());
            }
        }
        assert!(worst < 0.002, "{name}: {worst}");
    }
}

/// Sections of a sphere, smoothly joined, are a sphere.
#[test]
fn the_ball_is_a_ball() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("shapes/ball.toml");
    let shape = read("ball", &bytes(&path)).0.expect("a shape");
    let radius = 36.0 * 6.0 / (2.0 * std::f64::consts::PI);
    let center = glam::DVec3::new(0.0, 0.0, radius);
    for i in 0..=50 {
        for k in 0..12 {
            let point = shape.tubes[0].surface.point(f64::from(i) / 50.0, f64::from(k) / 12.0);
            assert!((point.distance(center) / radius - 1.0).abs() < 0.002, "{i} {k} {point}");
        }
    }
}

#[test]
fn every_bad_file_says_what_is_wrong() {
    for path in toml_files("tests/it/cases/bad/shape") {
        let name = stem(&path);
        let content = bytes(&path);
        let (shape, found, text) = read(&format!("{name}.toml"), &content);
        assert!(!found.is_empty(), "{name} is not bad");
        let outcome = if shape.is_some() { "read" } else { "refused" };
        let shown: String = String::from_utf8_lossy(&content).chars().take(1200).collect();
        let snapshot = format!("{}\n---- {outcome}\n{text}", shown.trim_end());
        insta::with_settings!({ snapshot_path => "snapshots/bad_shape", prepend_module_to_snapshot => false }, {
            insta::assert_snapshot!(name, snapshot);
        });
    }
}

#[test]
fn every_code_of_the_reader_has_a_case() {
    let mut seen: Vec<Code> = toml_files("tests/it/cases/bad/shape")
        .iter()
        .flat_map(|path| read(stem(path), &bytes(path)).1)
        .map(|diagnostic| diagnostic.code)
        .collect();
    seen.sort_unstable();
    seen.dedup();
    let reader = |code: &Code| {
        let name = code.as_str();
        *code != Code::TooManyEntries
            && ["E10", "E11", "W12", "N12"].iter().any(|group| name.starts_with(group))
            || *code == Code::NotUtf8
    };
    let missing: Vec<&str> = Code::ALL
        .iter()
        .filter(|code| reader(code) && !seen.contains(code))
        .map(|code| code.as_str())
        .collect();
    assert_eq!(missing, Vec::<&str>::new());
}

#[test]
fn long_lists_are_refused() {
    let points = "[1, 0], [0, 1], [-1, 0], ".repeat(4000);
    let text = GOOD.replace("circle = 1.0", &format!("loop = [{points}]"));
    let (shape, found, _) = read("x.toml", text.as_bytes());
    assert!(shape.is_none());
    assert_eq!(found.iter().map(|it| it.code).collect::<Vec<_>>(), [Code::TooManyEntries]);
}

#[test]
fn every_code_explains_itself_with_an_example() {
    for code in Code::ALL {
        let page = code.explanation();
        let lines = page.lines().filter(|line| !line.trim().is_empty()).count();
        assert!(lines >= 3, "{} has {lines} lines:\n{page}", code.as_str());
        assert!(page.contains('`') || page.contains(": "), "{} has no example", code.as_str());
    }
}

const GOOD: &str = r#"name = "d"
unit = "cm"
[gauge]
stitch = { width = 0.25, height = 0.25 }
[trunk]
curve = [[0, 0, 0], [0, 0, 9], [0, 10, 0]]
section = [{ at = 0.0, circle = 1.0 }, { at = 1.0, circle = 0.4 }]
"#;

#[test]
fn lengths_are_converted_once() {
    let shape = |unit: &str, gauge: &str| {
        let text =
            GOOD.replace("unit = \"cm\"", unit).replace("stitch = { width = 0.25, height = 0.25 }", gauge);
        let (shape, found, text) = read("d.toml", text.as_bytes());
        assert!(found.is_empty(), "{text}");
        shape.expect("a shape")
    };
    let cm = shape("unit = \"cm\"", "stitch = { width = 0.25, height = 0.3 }");
    assert_eq!((cm.gauge.width, cm.gauge.height), (2.5, 3.0));
    let end = cm.tubes[0].surface.point(1.0, 0.0);
    assert!((end.y - 100.0).abs() <= 4.01 && end.x.abs() <= 4.01, "{end}");
    let inches = shape("unit = \"in\"", "swatch = { width = 1, height = 1.2, stitches = 10, rows = 12 }");
    assert!((inches.gauge.width - 2.54).abs() < 1e-12 && (inches.gauge.height - 2.54).abs() < 1e-12);
    let ratio = inches.tubes[0].surface.point(0.3, 0.1) / cm.tubes[0].surface.point(0.3, 0.1);
    assert!((ratio - glam::DVec3::splat(2.54)).abs().max_element() < 1e-9, "{ratio}");
}

#[test]
fn a_chain_of_segments_is_the_curve_it_was_cut_from() {
    // The quadratic of `GOOD`, cut in the middle by de Casteljau.
    let cut = "curve = [[[0, 0, 0], [0, 0, 4.5], [0, 2.5, 4.5]], [[0, 2.5, 4.5], [0, 5, 4.5], [0, 10, 0]]]";
    let whole = read("d.toml", GOOD.as_bytes()).0.expect("a shape");
    let text = GOOD.replace("curve = [[0, 0, 0], [0, 0, 9], [0, 10, 0]]", cut);
    let chain = read("d.toml", text.as_bytes()).0.expect("a shape");
    // The chain's parameter follows its length, so a point is looked for along the whole.
    for step in 0..=20 {
        let (u, v) = (f64::from(step) / 20.0, f64::from(step) * 0.37);
        let point = chain.tubes[0].surface.point(u, v);
        let along = |k: u32| whole.tubes[0].surface.point(f64::from(k) / 8000.0, v).distance(point);
        let nearest = (0..=8000).map(along).fold(f64::INFINITY, f64::min);
        assert!(nearest < 0.02, "{u} {nearest}");
    }
}

/// The examples of the reference are the truth, so they must be read.
#[test]
fn the_examples_of_the_reference_are_read() {
    let text = String::from_utf8(bytes(&Path::new(env!("CARGO_MANIFEST_DIR")).join("grammar/shape.md")))
        .expect("UTF-8");
    let mut examples = 0;
    for block in text.split("```toml\n").skip(1) {
        let example = block.split("```").next().expect("closed");
        let (shape, found, text) = read("example.toml", example.as_bytes());
        let silent = found.iter().all(|it| it.severity < picot::diag::Severity::Error);
        assert!(shape.is_some() && silent, "{example}\n{text}");
        examples += 1;
    }
    assert!(examples >= 4, "{examples}");
}

#[test]
fn every_key_of_the_reader_stands_in_the_reference() {
    let text = String::from_utf8(bytes(&Path::new(env!("CARGO_MANIFEST_DIR")).join("grammar/shape.md")))
        .expect("UTF-8");
    // An unknown key that is near to nothing makes the reader list what it knows.
    let probes = [
        "zzzzzz = 1\nunit = \"cm\"\n".to_owned(),
        "unit = \"cm\"\n[gauge]\nzzzzzz = 1\n".to_owned(),
        "unit = \"cm\"\n[gauge]\nstitch = { zzzzzz = 1 }\n".to_owned(),
        "unit = \"cm\"\n[gauge]\nswatch = { zzzzzz = 1 }\n".to_owned(),
        "unit = \"cm\"\n[gauge]\nyarn = { zzzzzz = 1 }\n".to_owned(),
        GOOD.replace("[trunk]", "[trunk]\nzzzzzz = 1"),
        GOOD.replace("circle = 1.0", "circle = 1.0, zzzzzz = 1"),
        format!("{GOOD}\n[[branch]]\nzzzzzz = 1\n"),
        format!("{GOOD}\n[mesh]\nzzzzzz = 1\n"),
    ];
    for probe in probes {
        let (_, found, _) = read("probe.toml", probe.as_bytes());
        let help = found.iter().find(|it| it.code == Code::UnknownKey).and_then(|it| it.help.clone());
        let help = help.expect("the keys");
        for key in help.split('`').skip(1).step_by(2) {
            assert!(
                text.contains(&format!("`{key}`")) || text.contains(&format!("{key}]`")),
                "{key}: {help}"
            );
        }
    }
}

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, rng_seed: proptest::test_runner::RngSeed::Fixed(2), ..ProptestConfig::default() }
}

proptest! {
    #![proptest_config(config(2000))]

    #[test]
    fn arbitrary_bytes_never_panic(content in proptest::collection::vec(any::<u8>(), 0..300)) {
        read("x.toml", &content);
    }

    /// Good files with some bytes overwritten, taken out or doubled.
    #[test]
    fn mutated_files_never_panic(
        which in any::<prop::sample::Index>(),
        edits in proptest::collection::vec((any::<prop::sample::Index>(), 0..3_u8, prop_oneof![
            any::<u8>(), prop::sample::select(b"0123456789-.e[]{}=,\"\n ".to_vec())
        ]), 1..6),
    ) {
        let files = [GOOD.as_bytes().to_vec()];
        let mut content = files[which.index(files.len())].clone();
        for (at, kind, byte) in edits {
            let at = at.index(content.len());
            match kind {
                0 => content[at] = byte,
                1 => drop(content.remove(at)),
                _ => content.insert(at, byte),
            }
            if content.is_empty() {
                content.push(byte);
            }
        }
        let (shape, found, _) = read("x.toml", &content);
        prop_assert!(shape.is_some() || !found.is_empty());
    }

    /// Any numbers in any place: a finding or a shape, never a panic, and the shape is finite.
    #[test]
    fn any_numbers_never_panic(
        numbers in proptest::collection::vec(prop_oneof![
            Just("nan".to_owned()), Just("inf".to_owned()), Just("-inf".to_owned()), Just("0".to_owned()),
            Just("1e308".to_owned()), Just("-1e-308".to_owned()), Just("9223372036854775808".to_owned()),
            any::<f64>().prop_map(|number| format!("{number:e}")),
            (-50.0..50.0_f64).prop_map(|number| format!("{number:.2}")),
            (0.0..1.0_f64).prop_map(|number| format!("{number:.2}")),
        ], 16),
        smooth in any::<bool>(),
        ends in 0..4_u8,
    ) {
        let n = |index: usize| numbers[index].as_str();
        let word = |bit: u8| if ends & bit == 0 { "open" } else { "closed" };
        let text = format!(
            "unit = \"cm\"\n[gauge]\nstitch = {{ width = {}, height = {} }}\n[trunk]\ncurve = [[{}, {}, {}], [{}, {}, {}], [{}, {}, {}]]\ninterpolation = \"{}\"\nstart = \"{}\"\nend = \"{}\"\nsection = [{{ at = {}, circle = {} }}, {{ at = 1, ellipse = [{}, {}], offset = [{}, 0] }}]\n",
            n(0), n(1), n(2), n(3), n(4), n(5), n(6), n(7), n(8), n(9), n(10),
            if smooth { "smooth" } else { "linear" }, word(1), word(2), n(11), n(12), n(13), n(14), n(15),
        );
        let (shape, found, _) = read("x.toml", text.as_bytes());
        prop_assert!(shape.is_some() || !found.is_empty());
        if let Some(shape) = shape {
            for step in 0..=16 {
                prop_assert!(shape.tubes[0].surface.point(f64::from(step) / 16.0, 0.3).is_finite());
            }
        }
    }
}
