//! Parts that grow from others: quality, the way there and back through text, and what cannot be made.

use super::snapshots::shapes;
use super::tidy::text;
use picot::diag::{Sink, Sources};
use picot::frontend::crochet::{Conventions, Document};
use picot::frontend::{Input, reader};
use picot::ir::joins::{Pair, pairs};
use picot::ir::verify::verify;
use picot::ir::{Block, Gauge, Kind, PartId, Program, Segment, Start, Step};
use picot::shape::{Joint, Shape};
use picot::{Options, backends};
use proptest::prelude::*;
use std::fmt::Write;
use std::io;
use std::path::Path;

fn nothing(_: &str) -> io::Result<Vec<u8>> {
    Err(io::ErrorKind::NotFound.into())
}

/// Reads a shape and makes its program; else the codes and messages of what is wrong.
fn make(toml: &str) -> Result<(Shape, Program), Vec<String>> {
    let mut sources = Sources::new(&nothing);
    let source = sources.add("shape.toml", toml.as_bytes().to_vec()).expect("small");
    let mut sink = Sink::new();
    let input = (reader("shape").expect("listed").read)(&source, &mut sources, &mut sink);
    if let Some(Input::Shape(shape)) = input
        && let Some(program) = picot::program(&shape, &Options::default(), &mut sink)
        && verify(&program, &mut sink).is_some()
    {
        return Ok((*shape, program));
    }
    let found = sink.diagnostics().iter().map(|it| format!("{} {}", it.code.as_str(), it.message));
    Err(found.collect())
}

#[test]
fn another_gauge_cuts_branches_as_its_own_would() {
    let toml = text(Path::new("shapes/bear.toml"));
    let own = "stitch = { width = 0.2, height = 0.2 }";
    let line = toml.lines().find(|line| line.starts_with("stitch")).expect("a gauge");
    let (_, finer) = make(&toml.replace(line, own)).expect("sound");
    let options = Options { gauge: Some(Gauge::new(2.0, 2.0)), ..Options::default() };
    let mut sources = Sources::new(&nothing);
    let source = sources.add("shape.toml", toml.into_bytes()).expect("small");
    let reader = reader("shape").expect("listed");
    let chosen = picot::compile(&source, reader, &options, &mut sources, &mut Sink::new()).expect("sound");
    assert_eq!(written(&chosen), written(&finer));
}

/// Every shipped shape with branches.
fn branched() -> Vec<(String, Shape, Program)> {
    let made = shapes().into_iter().filter_map(|(name, path)| {
        let toml = text(&path);
        toml.contains("[[branch]]").then(|| {
            let (shape, program) = make(&toml).unwrap_or_else(|found| panic!("{name}: {found:?}"));
            (name, shape, program)
        })
    });
    made.collect()
}

pub(crate) fn written(program: &Program) -> String {
    let mut sink = Sink::new();
    let verified = verify(program, &mut sink).expect("sound");
    let target =
        backends::target("crochet").expect("listed").configure(toml::Table::new()).expect("defaults");
    let mut bytes = Vec::new();
    target.emit(&verified, &mut bytes, &mut sink).expect("in memory");
    String::from_utf8(bytes).expect("text")
}

pub(crate) fn read_back(pattern: &str) -> Program {
    let mut sources = Sources::new(&nothing);
    let source = sources.add("pattern.txt", pattern.as_bytes().to_vec()).expect("small");
    let mut sink = Sink::new();
    let conventions = Conventions::default();
    let document = Document::parse(&source, conventions.language, &mut sink).expect("reads");
    let program = document.check(&conventions, &mut sink).program;
    assert_eq!(sink.errors(), 0, "{:?}\n{pattern}", sink.diagnostics());
    program.expect("checks")
}

#[test]
fn joined_text_reads_back_to_the_same_steps() {
    let all = branched();
    assert!(all.len() >= 6);
    for (name, _, program) in all {
        let again = read_back(&written(&program));
        assert_eq!(again.pattern.parts.len(), program.pattern.parts.len(), "{name}");
        for (there, back) in program.pattern.parts.iter().zip(&again.pattern.parts) {
            assert_eq!(there.start, back.start, "{name}, {}", there.name);
            let steps = |rows: &[picot::ir::Row]| -> Vec<Step> {
                let body = |row: &picot::ir::Row| (row.times, row.body.clone());
                let each = rows.iter().map(body).collect::<Vec<(u32, Block)>>();
                each.iter()
                    .flat_map(|(times, body)| (0..*times).flat_map(|_| body.steps().collect::<Vec<_>>()))
                    .collect()
            };
            assert_eq!(steps(&there.rows), steps(&back.rows), "{name}, {}", there.name);
        }
    }
}

#[test]
fn every_first_loop_has_its_stitch_next_to_it() {
    for (name, shape, program) in branched() {
        let joins = pairs(&program);
        let reach = 4.0 * shape.gauge.width.max(shape.gauge.height);
        for (index, tube) in shape.tubes.iter().enumerate() {
            let Some(attachment) = tube.attachment else { continue };
            let (part, graph) = (&program.pattern.parts[index], &program.graphs[index]);
            let base = &program.graphs[attachment.parent];
            let Start::Join { segments } = &part.start else { panic!("{name}: {} joins nothing", part.name) };
            let pairs: &[Pair] = &joins[&PartId(index as u32)];
            let nodes: Vec<u32> = pairs.iter().map(|pair| pair.node).collect();
            assert_eq!(nodes, (0..graph.start).collect::<Vec<_>>(), "{name}, {}", part.name);
            for pair in pairs {
                assert_eq!(pair.to.0 as usize, attachment.parent);
                let distance = graph.nodes[pair.node as usize]
                    .position
                    .distance(base.nodes[pair.base as usize].position);
                // A slit lies across the hole that it opens into.
                let reach = if attachment.joint == Joint::Surface { reach } else { 2.0 * reach };
                assert!(distance < reach, "{name}, {}: {distance}", part.name);
            }
            if attachment.joint == Joint::Opening {
                let [Segment::Held { loops: held, .. }, Segment::Surface { loops: chains, back: true, .. }] =
                    segments.as_slice()
                else {
                    panic!("{name}: {segments:?}")
                };
                assert_eq!(held + chains, graph.start);
                let tiles = &program.graphs[attachment.parent].tiles;
                let bridging = tiles.iter().filter(|tile| tile.stitch.is_some_and(|it| it.kind == Kind::Ch));
                assert_eq!(bridging.count() as u32, *chains);
            }
        }
    }
}

/// Both parts of the cactus of the paper keep the quality of single tubes.
#[test]
fn the_cactus_of_the_paper_is_within_its_bounds() {
    let (_, path) = shapes().into_iter().find(|(name, _)| name == "paper-e").expect("shipped");
    for width in [0.25, 0.2, 0.15] {
        let gauge = format!("{{ width = {width}, height = {width} }}");
        let toml = text(&path).replace("{ width = 0.25, height = 0.25 }", &gauge);
        let (shape, program) = make(&toml).unwrap_or_else(|found| panic!("{width}: {found:?}"));
        for (measure, part) in picot::measure_parts(&shape, &program).iter().zip(&program.pattern.parts) {
            let (length, skew) = (measure.length_error.chord.mean_abs, measure.skew.all.mean);
            assert!(length <= 0.05 && skew <= 0.12, "{width}, {}: {length} {skew}", part.name);
            assert!(
                (0.95..=1.05).contains(&measure.coverage),
                "{width}, {}: {}",
                part.name,
                measure.coverage
            );
        }
    }
}

const HEAD: &str = "unit = \"cm\"\n[gauge]\nstitch = { width = 0.6, height = 0.6 }\n[trunk]\n\
                    curve = [[0, 0, 0], [0, 0, 14]]\nsection = [{ at = 0, circle = 3 }]\n";

fn branch(name: &str, from: f64, curve: &str, radius: f64, more: &str) -> String {
    format!(
        "[[branch]]\nname = \"{name}\"\nfrom = {from}\ncurve = {curve}\nsection = [{{ at = 0, circle = {radius} }}]\n{more}\n"
    )
}

#[test]
fn what_cannot_be_made_is_refused_by_name() {
    let out = "[[0, 0, 7], [8, 0, 7]]";
    let other = "[[0, 0, 7], [-8, 0, 7]]";
    let arm = branch("arm", 0.5, out, 1.2, "");
    for (code, branches) in [
        ("E1020", branch("arm", 1.5, out, 1.2, "")),
        ("E1020", branch("arm", 0.1, out, 1.2, "")),
        ("E1020", branch("arm", 0.5, out, 1.2, "start = \"closed\"")),
        ("E1021", branch("arm", 0.5, out, 1.2, "on = \"lge\"")),
        ("E1021", branch("arm", 0.5, out, 1.2, "on = \"arm\"")),
        ("E1021", branch("a", 0.5, out, 1.2, "on = \"b\"") + &branch("b", 0.5, other, 1.2, "on = \"a\"")),
        ("E1022", arm.clone() + &branch("Arm", 0.5, other, 1.2, "")),
        ("E1022", branch("trunk", 0.5, out, 1.2, "")),
        ("E1005", branch("arm", 0.5, out, 1.2, "join = \"glue\"")),
        ("E1114", branch("arm", 0.5, "[[0, 0, 7], [2, 0, 7]]", 0.9, "")),
        ("E1115", branch("arm", 0.5, out, 3.2, "")),
        ("E1115", branch("arm", 0.98, "[[0, 0, 13.7], [8, 0, 13.7]]", 1.5, "")),
        ("E1116", arm.clone() + &branch("other", 0.6, "[[0, 0, 8.4], [8, 0, 8.4]]", 1.2, "")),
        (
            "E1116",
            branch(
                "arm",
                0.2,
                "[[[0, 0, 3], [5, 0, 3]], [[5, 0, 3], [12, 0, 3], [12, 0, 10], [0, 0, 10]]]",
                1.0,
                "",
            ),
        ),
    ] {
        let found = make(&format!("{HEAD}{branches}")).expect_err(&branches);
        assert!(found.iter().any(|it| it.starts_with(code)), "{code}: {found:?}\n{branches}");
    }
}

#[test]
fn of_a_fork_the_straighter_branch_carries_on() {
    let left = branch("left", 1.0, "[[0, 0, 14], [-4, 0, 24]]", 2.0, "end = \"closed\"");
    let right = branch("right", 1.0, "[[0, 0, 14], [9, 0, 18]]", 1.5, "");
    let (shape, program) = make(&format!("{HEAD}{right}{left}")).unwrap_or_else(|found| panic!("{found:?}"));
    let names: Vec<&str> = shape.tubes.iter().map(|tube| tube.name.as_str()).collect();
    assert_eq!(names, ["trunk", "right"]);
    let top = program.graphs[0].nodes.iter().map(|node| node.position.z).fold(0.0, f64::max);
    assert!(top > 230.0, "the trunk leads on to the left, up to {top}");
    // What leaves the continuation is counted along its own curve.
    let twig = branch("twig", 0.5, "[[-2, 0, 19], [-8, 0, 17]]", 0.9, "on = \"left\"");
    let (shape, _) = make(&format!("{HEAD}{left}{twig}")).unwrap_or_else(|found| panic!("{found:?}"));
    assert_eq!(shape.tubes.len(), 2);
}

#[test]
fn branches_grow_from_branches() {
    let bud = branch("bud", 0.7, "[[5.6, 0, 7], [5.6, 0, 11]]", 0.8, "on = \"Arm\"\njoin = \"opening\"");
    let arm = branch("arm", 0.5, "[[0, 0, 7], [8, 0, 7]]", 1.4, "");
    let (shape, program) = make(&format!("{HEAD}{bud}{arm}")).unwrap_or_else(|found| panic!("{found:?}"));
    let names: Vec<&str> = shape.tubes.iter().map(|tube| tube.name.as_str()).collect();
    assert_eq!(names, ["trunk", "arm", "bud"], "parents come first");
    let pattern = written(&program);
    assert!(pattern.contains("bud: from arm rnd") && pattern.contains("held, rnd"), "{pattern}");
    read_back(&pattern);
}

proptest! {
    #![proptest_config(crate::arbitrary::config(60))]

    /// Whatever grows from whatever: it is made and can be worked, or it is refused.
    #[test]
    fn random_branches_are_made_or_refused(
        trunk in (1.0..4.0_f64, 6.0..14.0_f64, -3.0..3.0_f64, any::<bool>()),
        limbs in proptest::collection::vec(
            (0.0..1.0_f64, 0.3..2.5_f64, 0.0..6.3_f64, 2.0..9.0_f64, -4.0..6.0_f64, any::<bool>(), 0..3_usize),
            1..4,
        ),
    ) {
        let (radius, height, lean, closed) = trunk;
        let end = if closed { "closed" } else { "open" };
        let mut toml = format!(
            "unit = \"cm\"\n[gauge]\nstitch = {{ width = 0.6, height = 0.55 }}\n[trunk]\ncurve = [[0, 0, 0], [0, 0, {}], \
             [{lean}, 0, {height}]]\nstart = \"{end}\"\nend = \"{end}\"\nsection = [{{ at = 0, circle = {radius} }}]\n",
            0.5 * height
        );
        for (index, (from, size, angle, length, rise, opening, on)) in limbs.iter().enumerate() {
            let (x, z) = (lean * from * from, height * from);
            let (dx, dy) = (length * picot::math::cos(*angle), length * picot::math::sin(*angle));
            let curve = format!("[[{x}, 0, {z}], [{}, {dy}, {z}], [{}, {dy}, {}]]", x + dx, x + dx, z + rise);
            let mut more = String::from("end = \"closed\"\n");
            let _ = write!(more, "join = \"{}\"", if *opening { "opening" } else { "surface" });
            if *on > 0 && index > 0 {
                let _ = write!(more, "\non = \"limb {}\"", index - 1);
            }
            toml += &branch(&format!("limb {index}"), *from, &curve, *size, &more);
        }
        match make(&toml) {
            Ok((_, program)) => {
                let again = read_back(&written(&program));
                prop_assert_eq!(again.pattern.parts.len(), program.pattern.parts.len());
            }
            Err(found) => prop_assert!(
                found.iter().any(|it| it.starts_with('E')) && !found.iter().any(|it| it.starts_with("E0")),
                "{:?}\n{}", found, toml
            ),
        }
    }
}

/// The trousers that are shipped, with something replaced.
fn trousers(old: &str, new: &str) -> Result<(Shape, Program), Vec<String>> {
    let (_, path) = shapes().into_iter().find(|(name, _)| name == "trousers").expect("shipped");
    let toml = text(&path);
    assert!(toml.contains(old), "{old}");
    make(&toml.replacen(old, new, 1))
}

#[test]
fn trousers_divide_without_a_loop_left_over() {
    let (shape, program) = trousers("", "").unwrap_or_else(|found| panic!("{found:?}"));
    let [trunk, left, right] = program.pattern.parts.as_slice() else { panic!("three parts") };
    let round = trunk.rows.iter().rev().nth(2).expect("rounds before the division");
    let leaves = picot::ir::joins::Leaves::of(trunk, &program.graphs[0]);
    assert!(leaves.open.is_empty(), "every loop is held");
    let made = round.body.steps().map(|step| if let Step::Work(it) = step { u32::from(it.makes) } else { 0 });
    let chains =
        program.graphs[0].tiles.iter().filter(|tile| tile.stitch.is_some_and(|it| it.kind == Kind::Ch));
    let chains = chains.count() as u32;
    assert!(chains > 0);
    // Each loop of the last round and each chain is below one leg, and the chain has its other side below the other.
    assert_eq!(left.start.loops() + right.start.loops(), made.sum::<u32>() + 2 * chains);
    let mut bases: Vec<u32> = pairs(&program)
        .values()
        .flatten()
        .filter(|pair| pair.to == PartId(0))
        .map(|pair| pair.base)
        .collect();
    let all = bases.len();
    bases.sort_unstable();
    bases.dedup();
    assert_eq!(bases.len() as u32, all as u32 - chains, "only chains are worked twice");
    for (measure, part) in picot::measure_parts(&shape, &program).iter().zip(&program.pattern.parts) {
        let (length, skew) = (measure.length_error.chord.mean_abs, measure.skew.all.mean);
        assert!(length <= 0.05 && skew <= 0.12, "{}: {length} {skew}", part.name);
        assert!((0.96..=1.04).contains(&measure.coverage), "{}: {}", part.name, measure.coverage);
    }
}

#[test]
fn what_cannot_divide_is_told() {
    let second = "\n[[branch]]\nname = \"right leg\"\nfrom = 1\njoin = \"split\"";
    let cases = [
        (second, "\n[[branch]]\nname = \"right leg\"\nfrom = 0.4", "E1305"),
        ("from = 1\n", "from = 0.5\n", "E1305"),
        ("interpolation = \"smooth\"\n", "interpolation = \"smooth\"\nend = \"closed\"\n", "E1305"),
        (
            "curve = [[4, 0, 9], [4.4, 0, 15], [5, 0, 22]]",
            "curve = [[-4, 0, 9], [-4.4, 0, 15], [-5, 0, 22]]",
            "E1305",
        ),
        ("[5, 0, 22]", "[-4.5, 0, 22]", "E1116"),
    ];
    for (old, new, code) in cases {
        let found = trousers(old, new).map(|_| ()).expect_err(new);
        assert!(found.iter().any(|it| it.starts_with(code)), "{new}: {found:?}");
    }
}
