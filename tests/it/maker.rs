//! Patterns for one maker: left-handed work, and stitches that lean.

use super::branches::{read_back, written};
use super::command::{Folder, run, stderr, stdout};
use super::snapshots::{load, shapes};
use glam::DVec3;
use picot::Options;
use picot::diag::{Sink, Sources};
use picot::frontend::{Input, reader};
use picot::ir::joins::pairs;
use picot::ir::maker::mirrored;
use picot::ir::verify::verify;
use picot::ir::{Graph, Hand, Kind, PartId, Program};
use picot::math::{TAU, sin_cos};
use picot::preview::{Mesh, Places, Scene, View};
use picot::shape::{Drift, ParametricSurface, Shape, girth};
use std::path::Path;

/// A bent, flat, lopsided claw; `y` is 1, or -1 for its mirror image. It begins nearly along z, with x across, so that
/// profiles of both lie alike.
fn claw(y: f64) -> String {
    format!(
        "name = 'claw'\nunit = 'mm'\n[gauge]\nstitch = {{ width = 4, height = 3.6 }}\n[trunk]\nend = 'closed'\n\
         interpolation = 'smooth'\ncurve = [[0, 0, 0], [5, {}, 50], [50, {}, 90], [10, {}, 140]]\n\
         section = [{{ at = 0, ellipse = [22, 18], offset = [2, {}] }}, {{ at = 0.6, circle = 14, offset = [1, {}] }}, \
         {{ at = 1, circle = 0 }}]\n",
        8.0 * y,
        30.0 * y,
        60.0 * y,
        3.0 * y,
        -2.0 * y
    )
}

pub(crate) fn shape(toml: &str) -> Shape {
    let nothing = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    let mut sources = Sources::new(&nothing);
    let source = sources.add("shape.toml", toml.as_bytes().to_vec()).expect("small");
    of(&source, &mut sources)
}

pub(crate) fn at(path: &Path) -> Shape {
    let mut sources = Sources::new(&load);
    let source = sources.open(path.to_str().expect("plain names")).expect("readable");
    of(&source, &mut sources)
}

fn of(source: &picot::diag::Source, sources: &mut Sources<'_>) -> Shape {
    let mut sink = Sink::new();
    match picot::read(source, reader("shape").expect("listed"), &Options::default(), sources, &mut sink) {
        Some(Input::Shape(shape)) => *shape,
        _ => panic!("{:?}", sink.diagnostics()),
    }
}

fn with(hand: Hand) -> Options {
    let mut options = Options::default();
    options.generate.hand = Some(hand);
    options
}

pub(crate) fn make(shape: &Shape, options: &Options) -> Program {
    let mut sink = Sink::new();
    let program = picot::program(shape, options, &mut sink);
    let program = program.unwrap_or_else(|| panic!("{}: {:?}", shape.name, sink.diagnostics()));
    assert!(verify(&program, &mut sink).is_some(), "{}: {:?}", shape.name, sink.diagnostics());
    program
}

pub(crate) fn written_rounds(program: &Program) -> Vec<String> {
    written(program).lines().filter(|line| line.starts_with("Rnd")).map(str::to_owned).collect()
}

fn off(a: &Graph, b: &Graph) -> f64 {
    let pairs = a.nodes.iter().zip(&b.nodes);
    pairs.map(|(a, b)| a.position.distance(b.position)).fold(0.0, f64::max)
}

#[test]
fn the_left_hand_gets_the_words_of_the_mirror_image() {
    let designed = shape(&claw(1.0));
    let left = make(&designed, &with(Hand::Left));
    let right = make(&designed, &with(Hand::Right));
    let image = make(&shape(&claw(-1.0)), &with(Hand::Right));
    assert_eq!(left.maker.hand, Hand::Left);
    assert_eq!(written_rounds(&left), written_rounds(&image));
    assert_eq!(left.pattern, image.pattern);
    assert_ne!(left.pattern, right.pattern, "a claw of this kind is not symmetric");
    // Positions are those of what comes out: the designed object.
    let back = image.graphs[0].clone().mirrored();
    assert!(off(&left.graphs[0], &back) < 1e-9);
    let surface = &*designed.tubes[0].surface;
    for node in &left.graphs[0].nodes {
        assert!((0.0..1.0).contains(&node.v));
        assert!(surface.point(node.u, node.v).distance(node.position) < 1e-6);
    }
}

#[test]
fn symmetric_shapes_have_one_pattern_for_both_hands() {
    for (name, path) in shapes() {
        if !["ball", "vase", "cone", "capsule", "cylinder"].contains(&name.as_str()) {
            continue;
        }
        let shape = at(&path);
        let [left, right] = [Hand::Left, Hand::Right].map(|hand| make(&shape, &with(hand)));
        assert_eq!(left.pattern, right.pattern, "{name}");
    }
}

#[test]
fn every_shape_comes_out_as_well_with_either_hand() {
    for (name, path) in shapes() {
        let shape = at(&path);
        let [left, right] = [Hand::Left, Hand::Right].map(|hand| make(&shape, &with(hand)));
        let [l, r] = [&left, &right].map(|program| picot::measure(&shape, program));
        let about = |a: f64, b: f64, give: f64| assert!((a - b).abs() < give, "{name}: {a} and {b}");
        about(l.length_error.chord.mean_abs, r.length_error.chord.mean_abs, 0.015);
        about(l.skew.all.mean, r.skew.all.mean, 0.04);
        about(l.coverage, r.coverage, 0.012);
        about(l.level.missing, r.level.missing, 0.6);
        assert!(l.inverted_tiles <= r.inverted_tiles + 2, "{name}: {}", l.inverted_tiles);
        // Parts are joined to stitches as near as on the other hand.
        let gap = |program: &Program| {
            let all = pairs(program);
            let places = |part: usize, node: u32| program.graphs[part].nodes[node as usize].position;
            let mut farthest = 0.0_f64;
            for (part, pairs) in all {
                let PartId(own) = part;
                for pair in pairs {
                    let to = pair.to.0 as usize;
                    farthest = farthest.max(places(own as usize, pair.node).distance(places(to, pair.base)));
                }
            }
            farthest
        };
        about(gap(&left), gap(&right), 2.5 * shape.gauge.width.max(shape.gauge.height));
    }
}

#[test]
fn pictures_show_what_comes_out() {
    let left = make(&shape(&claw(1.0)), &with(Hand::Left));
    let image = make(&shape(&claw(-1.0)), &with(Hand::Right));
    for places in [Places::Target, Places::Predicted] {
        let scene = |program: &Program| {
            let mut sink = Sink::new();
            Scene::new(&verify(program, &mut sink).expect("sound"), None, places, &sink).expect("a scene")
        };
        let (left, image) = (scene(&left), scene(&image));
        assert_eq!(left.stitches.len(), image.stitches.len());
        for (a, b) in left.stitches.iter().zip(&image.stitches) {
            for (a, b) in a.corners.iter().zip(&b.corners) {
                assert!(a.distance(mirrored(*b)) < 1e-6);
            }
            assert!((a.skew - b.skew).abs() < 1e-6);
        }
        for view in [View::Realistic, View::Wireframe] {
            let [a, b] =
                [&left, &image].map(|scene| Mesh::of(scene, view, Some(4), 1 << 20).expect("triangles"));
            let (a, b) = (volume(&a), volume(&b));
            assert!(a > 0.0 && (a - b).abs() < 0.02 * b, "triangles look outward: {a} and {b}");
        }
    }
}

fn volume(mesh: &Mesh) -> f64 {
    let at = |id: u32| DVec3::from(mesh.positions[id as usize].map(f64::from));
    mesh.triangles.iter().map(|[a, b, c]| at(*a).dot(at(*b).cross(at(*c))) / 6.0).sum()
}

#[test]
fn text_tells_the_hand_and_reads_back() {
    let left = make(&shape(&claw(1.0)), &with(Hand::Left));
    let text = written(&left);
    assert!(text.contains("convention: turn-mark=bare, hand=left\n"), "{text}");
    assert!(text.contains("For left-handed work"), "{text}");
    let again = read_back(&text);
    assert_eq!(again.maker, left.maker);
    let right = make(&shape(&claw(1.0)), &with(Hand::Right));
    assert!(!written(&right).contains("left-handed"));
    assert_eq!(read_back(&written(&right)).maker.hand, Hand::Right);
}

#[test]
fn the_command_line_and_the_file_name_a_hand() {
    let folder = Folder::new();
    let plain = folder.file("claw.toml", claw(1.0));
    let of_file = folder.file("left.toml", claw(1.0) + "[maker]\nhand = 'left'\n");
    let image = folder.file("image.toml", claw(-1.0));
    let rounds = |arguments: &[&str]| -> Vec<String> {
        let text = stdout(&run(arguments).success());
        text.lines().filter(|line| line.starts_with("Rnd")).map(str::to_owned).collect()
    };
    let expected = rounds(&["build", &image]);
    assert_eq!(rounds(&["build", &plain, "--left-handed"]), expected);
    assert_eq!(rounds(&["build", &plain, "--set", "hand=left"]), expected);
    assert_eq!(rounds(&["build", &of_file]), expected);
    assert_eq!(rounds(&["build", &of_file, "--set", "hand=right"]), rounds(&["build", &plain]));
    let wrong = run(&["build", &plain, "--set", "hand=both"]);
    assert!(stderr(&wrong.code(2)).contains("hand"));
    let wrong = folder.file("wrong.toml", claw(1.0) + "[maker]\nhand = 'lift'\n");
    assert!(stderr(&run(&["build", &wrong]).code(1)).contains("did you mean \"left\"?"));

    // XML keeps it, JSON tells it, charts are drawn the other way around, and a machine refuses.
    let xml = folder.path("left.xml");
    run(&["build", &of_file, "-o", &xml]).success();
    assert_eq!(rounds(&["build", &xml, "--to", "crochet"]), expected);
    assert!(stdout(&run(&["build", &xml, "--to", "crochet"])).contains("hand=left"));
    let json: serde_json::Value =
        serde_json::from_str(&stdout(&run(&["build", &xml, "--to", "json"]))).expect("JSON");
    assert_eq!(json["maker"]["hand"], "left");
    let knit = run(&["build", &xml, "--machine", "swg091n2", "--to", "knitout"]).code(4);
    assert!(stderr(&knit).contains("E2207"));
    // A written pattern is worked with the hand that someone names.
    let text = folder.path("plain.txt");
    run(&["build", &plain, "-o", &text]).success();
    assert!(stdout(&run(&["build", &text, "--to", "crochet", "--left-handed"])).contains("hand=left"));
}

fn leaning(lean: f64) -> Options {
    let mut options = Options::default();
    options.generate.lean = Some(lean);
    options
}

/// A straight vase with a belly on one side; the worst distance from it of a point that lies somewhere on a round.
const BELLY: &str = "name = 'belly'\nunit = 'mm'\n[gauge]\nstitch = { width = 3, height = 3 }\n[trunk]\n\
    curve = [[0, 0, 0], [0, 0, 120]]\ninterpolation = 'smooth'\nsection = [{ at = 0, circle = 18 }, \
    { at = 0.3, circle = 20 }, { at = 0.6, circle = 28, offset = [9, 0] }, { at = 1, circle = 16 }]\n";

/// Root mean square distance of points from a surface.
fn distance(surface: &dyn ParametricSurface, points: impl Iterator<Item = DVec3>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for point in points {
        let at = |u: f64, v: f64| surface.point(u, v).distance_squared(point);
        let mut best = (f64::MAX, 0.0, 0.0);
        for i in 0..=40 {
            for k in 0..48 {
                let (u, v) = (f64::from(i) / 40.0, f64::from(k) / 48.0);
                if at(u, v) < best.0 {
                    best = (at(u, v), u, v);
                }
            }
        }
        let mut step = 0.02;
        while step > 1e-5 {
            let (_, u, v) = best;
            let near = [(u + step, v), (u - step, v), (u, v + step), (u, v - step)];
            let next = near.into_iter().map(|(u, v)| (at(u, v), u, v)).min_by(|a, b| a.0.total_cmp(&b.0));
            match next.filter(|next| next.0 < best.0) {
                Some(next) => best = next,
                None => step *= 0.5,
            }
        }
        sum += best.0;
        count += 1.0;
    }
    f64::sqrt(sum / count)
}

/// What becomes of stitches that stand as laid once each round has drifted by its lean: all that lies above a round turns
/// by so many of its stitches about its middle. Told from the stitches alone.
fn drifted(program: &Program, laid: &Graph, lean: f64) -> Vec<DVec3> {
    let height = program.gauge.expect("known").height;
    let counts = leaves(program);
    let mut rounds: Vec<(f64, DVec3, DVec3)> = Vec::new();
    for (k, count) in counts.iter().enumerate() {
        let of = |node: &&picot::ir::Node| (k as f64..k as f64 + 1.0).contains(&node.tau);
        let mut row: Vec<(f64, DVec3)> =
            laid.nodes.iter().filter(of).map(|node| (node.v, node.position)).collect();
        row.sort_by(|a, b| a.0.total_cmp(&b.0));
        if row.len() < 3 {
            break;
        }
        let center = row.iter().map(|(_, at)| *at).sum::<DVec3>() / row.len() as f64;
        // A round climbs by a row; the axis is that of its level.
        let area = |row: &[(f64, DVec3)]| -> DVec3 {
            let next = row.iter().cycle().skip(1);
            row.iter().zip(next).map(|(a, b)| (a.1 - center).cross(b.1 - center)).sum()
        };
        let down = area(&row).normalize();
        let mut level: Vec<(f64, DVec3)> = Vec::new();
        for node in laid.nodes.iter().filter(of) {
            level.push((node.v, node.position + down * ((node.tau - k as f64 - 0.5) * height)));
        }
        level.sort_by(|a, b| a.0.total_cmp(&b.0));
        let area = area(&level);
        rounds.push((lean / count, center, area.normalize()));
    }
    let turned = |node: &picot::ir::Node| {
        // The highest round comes first: its axis is as laid.
        rounds.iter().enumerate().rev().fold(node.position, |at, (k, (turns, center, axis))| {
            let (sin, cos) = sin_cos(TAU * turns * (node.tau - k as f64).clamp(0.0, 1.0));
            let arm = at - *center;
            *center + arm * cos + axis.cross(arm) * sin + *axis * (axis.dot(arm) * (1.0 - cos))
        })
    };
    laid.nodes.iter().map(turned).collect()
}

/// Stitches of each round.
fn leaves(program: &Program) -> Vec<f64> {
    let mut sink = Sink::new();
    let verified = verify(program, &mut sink).expect("sound");
    let part = &verified.facts().parts[0];
    let rows = program.pattern.parts[0].rows.iter().zip(&part.rows);
    rows.flat_map(|(row, facts)| (0..row.times).map(|_| f64::from(facts.produces))).collect()
}

#[test]
fn drift_twists_a_leaning_pattern_back_to_the_shape() {
    let (_, d) = shapes().into_iter().find(|(name, _)| name == "paper-d").expect("shipped");
    for (designed, lean) in [(shape(BELLY), 0.15), (shape(BELLY), -0.3), (at(&d), 0.1)] {
        let surface = &*designed.tubes[0].surface;
        let straight = make(&designed, &leaning(0.0));
        let program = make(&designed, &leaning(lean));
        assert!((program.maker.lean - lean).abs() < 1e-12);
        let drift = Drift::new(surface, &designed.gauge, lean);
        let laid = drift.as_laid(program.graphs[0].clone());
        let good = distance(surface, straight.graphs[0].nodes.iter().map(|node| node.position));
        let ignored = distance(surface, drifted(&straight, &straight.graphs[0], lean).into_iter());
        let unturned = distance(surface, laid.nodes.iter().map(|node| node.position));
        let compensated = distance(surface, drifted(&program, &laid, lean).into_iter());
        assert!(good < 3e-3, "stitches lie on the shape: {good}");
        println!("{}, lean {lean}: {ignored:.3} mm ignored, {compensated:.3} mm compensated", designed.name);
        assert!(ignored > 0.8 && unturned > 0.8, "the drift matters: {ignored}, {unturned}");
        assert!(
            compensated < 0.15 * ignored,
            "at {lean}: {compensated} mm, {ignored} mm where it is ignored"
        );
        // Pictures show what comes out: the shape.
        let shown = distance(surface, program.graphs[0].nodes.iter().map(|node| node.position));
        assert!(shown < 3e-3, "{shown}");
        for node in &program.graphs[0].nodes {
            assert!(surface.point(node.u, node.v).distance(node.position) < 1e-3);
        }
        assert_ne!(straight.pattern, program.pattern, "the shaping moves");
    }
}

#[test]
fn lean_changes_nothing_on_what_is_round() {
    for (name, path) in shapes() {
        if !["ball", "vase", "cone", "capsule", "pear"].contains(&name.as_str()) {
            continue;
        }
        let shape = at(&path);
        assert_eq!(make(&shape, &leaning(0.2)).pattern, make(&shape, &leaning(0.0)).pattern, "{name}");
    }
}

#[test]
fn every_shape_comes_out_as_well_with_stitches_that_lean() {
    for (name, path) in shapes() {
        let shape = at(&path);
        let plain = picot::measure(&shape, &make(&shape, &leaning(0.0)));
        let mut options = leaning(0.08);
        if name.len() % 2 == 0 {
            options.generate.hand = Some(Hand::Left);
        }
        let program = make(&shape, &options);
        let leaning = picot::measure(&shape, &program);
        let no_worse = |a: f64, b: f64, give: f64| assert!(a < b + give, "{name}: {a} and {b}");
        no_worse(leaning.length_error.chord.mean_abs, plain.length_error.chord.mean_abs, 0.02);
        no_worse(leaning.skew.all.mean, plain.skew.all.mean, 0.05);
        no_worse((leaning.coverage - 1.0).abs(), (plain.coverage - 1.0).abs(), 0.05);
        assert!(
            leaning.level.missing.abs() < plain.level.missing.abs() + 1.4,
            "{name}: {}",
            leaning.level.missing
        );
        for (tube, graph) in shape.tubes.iter().zip(&program.graphs) {
            // Where five stitches do not fit around they lie beside the surface.
            let thick = |u: f64| girth(&*tube.surface, u, 12) > 5.5 * shape.gauge.width;
            let nodes = graph.nodes.iter().filter(|node| node.u > 0.0).take(surely_laid(graph));
            for node in nodes.filter(|node| thick(node.u)) {
                let off = tube.surface.point(node.u, node.v).distance(node.position);
                assert!(off < 0.01 * shape.gauge.width, "{name}, {}: {off}", tube.name);
            }
        }
    }
}

/// Nodes that are surely laid on the surface: chains across a fork are not.
fn surely_laid(graph: &Graph) -> usize {
    let chain = graph.tiles.iter().position(|tile| tile.stitch.is_some_and(|stitch| stitch.kind == Kind::Ch));
    chain.map_or(usize::MAX, |tile| tile.min(graph.nodes.len()) * 3 / 4)
}

#[test]
fn the_lean_is_told_everywhere() {
    let folder = Folder::new();
    let file = folder.file("belly.toml", BELLY.to_owned() + "[maker]\nlean = -0.06\n");
    let text = stdout(&run(&["build", &file]).success());
    assert!(text.contains("\nlean: -0.06\n") && text.contains("drift by -0.06 stitches a round"), "{text}");
    assert_eq!(read_back(&text).maker.lean, -0.06);
    let xml = folder.path("belly.xml");
    run(&["build", &file, "-o", &xml]).success();
    assert_eq!(stdout(&run(&["build", &xml, "--to", "crochet"])), text);
    let json: serde_json::Value =
        serde_json::from_str(&stdout(&run(&["build", &xml, "--to", "json"]))).expect("JSON");
    assert_eq!(json["maker"]["lean"], -0.06);
    assert!(
        stderr(&run(&["build", &xml, "--machine", "swg091n2", "--to", "knitout"]).code(4)).contains("E2207")
    );
    assert!(stderr(&run(&["build", &file, "--set", "lean=2"]).code(2)).contains("from -1 to 1"));
    assert!(stderr(&run(&["build", &file, "--set", "lean=0.9"]).success()).contains("W1306"));
    let measured = stdout(&run(&["measure", &file, "--predict"]).success());
    assert!(measured.contains("predicted no"), "{measured}");
    let picture = folder.path("belly.png");
    run(&["build", &file, "-o", &picture, "--set", "places=predicted"]).code(4);
    run(&["build", &file, "-o", &picture]).success();
}

#[test]
fn round_charts_turn_the_other_way() {
    let (name, path) = shapes().into_iter().find(|(name, _)| name == "ball").expect("shipped");
    let shape = at(&path);
    let [left, right] = [Hand::Left, Hand::Right].map(|hand| {
        let program = make(&shape, &with(hand));
        let mut sink = Sink::new();
        let verified = verify(&program, &mut sink).expect("sound");
        let target = picot::backends::target("svg").expect("listed");
        let chart = target.configure("chart = 'round'".parse().expect("TOML")).expect("sound");
        let mut bytes = Vec::new();
        chart.emit(&verified, &mut bytes, &mut sink).expect("in memory");
        String::from_utf8(bytes).expect("text")
    });
    assert!(
        left.contains("clockwise, as left-handed") && right.contains("counterclockwise, as right-handed")
    );
    // The counts of the rounds stand at mirrored places.
    let places = |chart: &str| -> Vec<f64> {
        let counts = chart.lines().filter(|line| line.contains("font-size=\"7.5\""));
        let x = |line: &str| line.split("x=\"").nth(1)?.split('"').next()?.parse().ok();
        counts.filter_map(x).collect()
    };
    let (left, right) = (places(&left), places(&right));
    assert!(left.len() > 8, "{name}");
    for (a, b) in left.iter().zip(&right) {
        assert!((a + b).abs() < 0.11, "{a} and {b}");
    }
}
