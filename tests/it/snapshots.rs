//! Every shape of `shapes/` through every target. A snapshot shows the input, then what came of it.

use super::tidy::{files, text};
use picot::backends::TARGETS;
use picot::diag::position::Positions;
use picot::diag::render::terminal::terminal;
use picot::diag::{Sink, Sources};
use picot::frontend::reader;
use picot::ir::Program;
use picot::ir::verify::verify;
use serde_json::Value;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Outputs longer than this are shown by their beginning.
const LONG: usize = 24_000;

/// Name and path of every shape file; the name of a nested one has its folder in front.
pub(crate) fn shapes() -> Vec<(String, PathBuf)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("shapes");
    let name = |path: &Path| {
        let inner = path.strip_prefix(&root).expect("inside").with_extension("");
        inner.to_string_lossy().replace(['/', '\\'], "-")
    };
    files("shapes", "toml").into_iter().map(|path| (name(&path), path)).collect()
}

#[expect(clippy::disallowed_methods, reason = "tests read their cases from the disk")]
pub(crate) fn load(name: &str) -> std::io::Result<Vec<u8>> {
    std::fs::read(name)
}

/// What each target makes of a shape, with the diagnostics on the way.
fn compile(path: &Path) -> (Vec<(Vec<u8>, String)>, String) {
    let mut sources = Sources::new(&load);
    let mut sink = Sink::new();
    let source = sources.open(path.to_str().expect("plain names")).expect("readable");
    let reader = reader("shape").expect("listed");
    let program = picot::compile(&source, reader, &picot::Options::default(), &mut sources, &mut sink);
    let mut outputs = Vec::new();
    if let Some(program) = &program
        && let Some(verified) = verify(program, &mut sink)
    {
        for target in TARGETS {
            let backend = target.configure(options(target.name)).expect("sound options");
            let mut bytes = Vec::new();
            let mut remarks = Sink::new();
            if let Err(error) = backend.emit(&verified, &mut bytes, &mut remarks) {
                bytes = format!("refused: {error}").into_bytes();
            }
            outputs.push((bytes, remarks));
        }
    }
    let positions = Positions::new(&sources);
    let here = path.parent().and_then(Path::to_str).unwrap_or_default();
    let messages = |sink: &Sink<'_>| {
        let all = sink.diagnostics().iter().map(|finding| terminal(finding, &positions, false) + "\n");
        all.collect::<String>().replace(here, "shapes")
    };
    let outputs = outputs.iter().map(|(bytes, remarks)| (bytes.clone(), messages(remarks))).collect();
    (outputs, messages(&sink))
}

/// Defaults, but models are coarse here and pictures small.
fn options(target: &str) -> toml::Table {
    let options = match target {
        "png" => "size = '160x120'\ndetail = 1",
        "gltf" | "obj" | "stl" => "detail = 1",
        _ => "",
    };
    options.parse().expect("TOML")
}

/// The program of a shape file.
pub(crate) fn program(path: &Path) -> Program {
    let mut sources = Sources::new(&load);
    let mut sink = Sink::new();
    let source = sources.open(path.to_str().expect("plain names")).expect("readable");
    let reader = reader("shape").expect("listed");
    picot::compile(&source, reader, &picot::Options::default(), &mut sources, &mut sink).expect("it compiles")
}

#[test]
fn every_shape_through_every_target() {
    for (name, path) in shapes() {
        let (outputs, messages) = compile(&path);
        assert_eq!(outputs.len(), TARGETS.len(), "{name} does not compile:\n{messages}");
        let (again, _) = compile(&path);
        for ((target, (bytes, remarks)), (again, _)) in TARGETS.iter().zip(&outputs).zip(&again) {
            assert!(bytes == again, "{name} to {}: two runs differ", target.name);
            let shown = match target.name {
                "json" => summary(bytes),
                "obj" => size(bytes),
                "html" => page(bytes),
                _ if target.binary => size(bytes),
                _ => shortened(bytes),
            };
            let messages = format!("{messages}{remarks}");
            let messages = if messages.is_empty() { String::new() } else { format!("\n{messages}") };
            let snapshot = format!("{}\n{:-<80}{messages}\n{shown}", text(&path).trim_end(), "");
            let mut settings = insta::Settings::clone_current();
            settings.set_prepend_module_to_snapshot(false);
            settings.set_omit_expression(true);
            settings.set_snapshot_path(format!("snapshots/{}", target.name));
            settings.bind(|| insta::assert_snapshot!(name.as_str(), snapshot));
        }
    }
}

/// Size and a hash (FNV-1a), for what no one reads.
fn size(bytes: &[u8]) -> String {
    let hash = bytes.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    });
    format!("{} bytes, hash {hash:016x}", bytes.len())
}

fn shortened(bytes: &[u8]) -> String {
    let text = std::str::from_utf8(bytes).expect("a text target writes UTF-8");
    if text.len() <= LONG {
        return text.to_owned();
    }
    let shown: String = text.lines().take(60).fold(String::new(), |shown, line| shown + line + "\n");
    format!("{shown}... {} lines, {}", text.lines().count(), size(bytes))
}

/// The words of a page: its pattern whole; script, style, charts and data by their hash.
fn page(bytes: &[u8]) -> String {
    let text = std::str::from_utf8(bytes).expect("a text target writes UTF-8");
    let (_, rest) = text.split_once("<section id=\"pattern\"").expect("a pattern");
    let (pattern, after) = rest.split_once("</section>").expect("closed");
    let data = after.split_once("id=\"picot-data\">").and_then(|(_, rest)| rest.split_once("</script>"));
    let data = data.map_or(after, |(data, _)| data);
    format!("data: {}\n<section{pattern}", size(data.as_bytes()))
}

/// The parts of a program without the numbers of its graph.
fn summary(bytes: &[u8]) -> String {
    let value: Value = serde_json::from_slice(bytes).expect("JSON");
    let mut text = format!("{}\n{}\n", size(bytes), value["schema"]);
    for part in value["parts"].as_array().into_iter().flatten() {
        let length = |value: &Value| value.as_array().map_or(0, Vec::len);
        let graph = &part["graph"];
        let _ = writeln!(
            text,
            "{}: start {}, {} rounds, {} nodes, {} edges, {} stitches",
            part["name"],
            part["start"],
            length(&part["rounds"]),
            length(&graph["nodes"]),
            length(&graph["edges"]),
            length(&graph["stitches"])
        );
        for round in part["rounds"].as_array().into_iter().flatten() {
            let _ = writeln!(
                text,
                "{:>4} {:>4} -> {:<4} {}",
                round["number"],
                round["consumes"],
                round["produces"],
                round["text"].as_str().unwrap_or_default()
            );
        }
    }
    text
}
