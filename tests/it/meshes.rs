//! Meshes: what comes in as triangles goes out as tubes, and what is no surface is refused with its reason.

use crate::solids::{Solid, capsule, circle, union};
use glam::DVec3;
use picot::diag::{Code, Diagnostic, Sink, Sources};
use picot::frontend::{Input, Unit, mesh::Reading, mesh::Up, reader_for_extension};
use picot::ir::verify::verify;
use picot::ir::{Gauge, Program};
use picot::math::{TAU, cos, sin};
use picot::shape::{End, Joint, ParametricSurface, Shape, girth};
use picot::{Options, measure, measure_parts, read};
use std::fmt::Write;
use std::io;

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn options(stitch: f64) -> Options {
    let mesh = Reading { unit: Some(Unit::Mm), up: Some(Up::Z) };
    Options { gauge: Some(Gauge::new(stitch, stitch)), mesh, ..Options::default() }
}

/// Reads a file of the given name.
fn load(name: &str, bytes: &[u8], options: &Options) -> (Option<Shape>, Vec<Diagnostic>) {
    load_beside(name, bytes, options, &|_| Err(io::ErrorKind::NotFound.into()))
}

fn load_beside(
    name: &str,
    bytes: &[u8],
    options: &Options,
    loader: &dyn Fn(&str) -> io::Result<Vec<u8>>,
) -> (Option<Shape>, Vec<Diagnostic>) {
    let loader = |name: &str| loader(name);
    let mut sources = Sources::new(&loader);
    let source = sources.add(name, bytes.to_vec()).expect("small");
    let mut sink = Sink::new();
    let extension = name.rsplit('.').next().expect("an extension");
    let reader = reader_for_extension(extension).expect("listed");
    let shape = match read(&source, reader, options, &mut sources, &mut sink) {
        Some(Input::Shape(shape)) => Some(*shape),
        Some(_) => panic!("a mesh gave something else"),
        None => None,
    };
    (shape, sink.take())
}

fn shape_of(solid: &Solid, stitch: f64) -> Shape {
    let (shape, found) = load("solid.obj", &solid.obj(), &options(stitch));
    shape.unwrap_or_else(|| panic!("{found:#?}"))
}

/// From a shape to a pattern that can be worked.
fn pattern(shape: Shape, options: &Options) -> (Shape, Program) {
    let mut sink = Sink::new();
    let program = picot::program(&shape, options, &mut sink);
    let program = program.unwrap_or_else(|| panic!("{:#?}", sink.diagnostics()));
    assert!(verify(&program, &mut sink).is_some(), "{:#?}", sink.diagnostics());
    (shape, program)
}

fn rounds(program: &Program) -> Vec<usize> {
    rounds_of(program, 0)
}

/// Stitches of each round of a part.
fn rounds_of(program: &Program, part: usize) -> Vec<usize> {
    let part = &program.pattern.parts[part];
    let counts = part.rows.iter().flat_map(|row| {
        let works = row.body.steps().filter(|step| matches!(step, picot::ir::Step::Work(_))).count();
        std::iter::repeat_n(works, row.times as usize)
    });
    counts.collect()
}

fn stitches(program: &Program) -> usize {
    rounds(program).iter().sum()
}

fn peanut(p: DVec3) -> f64 {
    union(p.distance(v(0., 0., -20.)) - 20.0, p.distance(v(0., 0., 20.)) - 20.0, 15.0)
}

/// A tube of radius 15 along a quarter circle with straight legs, round at both ends.
fn bent(p: DVec3) -> f64 {
    let arc = (0..=32).map(|k| {
        let angle = TAU / 4.0 * f64::from(k) / 32.0;
        p.distance(v(50.0 - 50.0 * cos(angle), 0.0, 50.0 * sin(angle)))
    });
    let legs =
        capsule(p, v(0., 0., -30.), DVec3::ZERO, 0.0).min(capsule(p, v(50., 0., 50.), v(80., 0., 50.), 0.0));
    arc.fold(legs, f64::min) - 15.0
}

/// The pattern of a shape covers it, and its lengths are about right.
fn covers(name: &str, shape: Shape, size: f64) {
    let (shape, program) = pattern(shape, &options(size));
    let figures = measure(&shape, &program);
    assert!((0.97..=1.03).contains(&figures.coverage), "{name}: {}", figures.coverage);
    assert!(figures.length_error.chord.mean_abs < 0.05, "{name}: {:?}", figures.length_error.chord);
    for (tube, figures) in shape.tubes.iter().zip(measure_parts(&shape, &program)) {
        // Stitches are straight: ten of them around a thin limb, and its drawn tip, lie inside of the round surface.
        let widest =
            (0..=16).map(|k| girth(&*tube.surface, f64::from(k) / 16.0, 32) / size).fold(0.0, f64::max);
        // And in the sixty stitches of an ear every shaping shows.
        let (least, skew) = if widest < 13.0 { (0.91, 0.17) } else { (0.97, 0.12) };
        let name = format!("{name}, {}: {widest:.1} stitches around", tube.name);
        assert!((least..=1.03).contains(&figures.coverage), "{name}: {}", figures.coverage);
        assert!(figures.skew.all.mean < skew, "{name}: {:?}", figures.skew.all);
    }
}

#[test]
fn single_tubes_become_patterns_that_cover_them() {
    let cases = [
        ("ball", Solid::ball(30.0, 24)),
        (
            "ball of a grid",
            Solid::level_set(|p| p.length() - 30.0, v(-33., -33., -33.), v(33., 33., 33.), 4.0),
        ),
        ("peanut", Solid::level_set(peanut, v(-24., -24., -44.), v(24., 24., 44.), 4.0)),
        ("bent", Solid::level_set(bent, v(-19., -19., -49.), v(99., 19., 69.), 4.0)),
    ];
    for (name, solid) in cases {
        let shape = shape_of(&solid, 5.0);
        assert_eq!(shape.tubes.len(), 1, "{name}");
        covers(name, shape, 5.0);
    }
}

#[test]
fn a_ball_of_triangles_is_worked_as_a_ball() {
    let made = |solid: &Solid| rounds(&pattern(shape_of(solid, 5.0), &options(5.0)).1);
    let smooth = made(&Solid::ball(30.0, 32));
    let grid = made(&Solid::level_set(|p| p.length() - 30.0, v(-33., -33., -33.), v(33., 33., 33.), 4.0));
    assert_eq!(smooth, grid);
    assert_eq!(smooth[..4], [6, 12, 18, 24], "{smooth:?}");
}

/// Rows and columns of a mesh that is cut as it is, and of one that is made coarser first.
const PLAIN: [u32; 2] = [80, 64];
const FINE: [u32; 2] = [300, 200];

/// The surface of a shape as triangles.
fn triangles(surface: &dyn ParametricSurface, closed: [bool; 2], [rows, around]: [u32; 2]) -> Solid {
    let at =
        |k: u32, j: u32| surface.point(f64::from(k) / f64::from(rows), -f64::from(j) / f64::from(around));
    let rings: Vec<Vec<DVec3>> = (0..=rows)
        .filter(|k| !(closed[0] && *k == 0 || closed[1] && *k == rows))
        .map(|k| (0..around).map(|j| at(k, j)).collect())
        .collect();
    let pole = |side: usize, u: f64| closed[side].then(|| surface.point(u, 0.0));
    Solid::tube(&rings, [pole(0, 0.0), pole(1, 1.0)])
}

/// The stitch count of the ring or chain and of each round, as patterns state it.
fn counts(program: &Program) -> Vec<usize> {
    let mut sink = Sink::new();
    let verified = verify(program, &mut sink).expect("a sound pattern");
    let facts = &verified.facts().parts[0];
    let rows = program.pattern.parts[0].rows.iter().zip(&facts.rows);
    let counts = rows.flat_map(|(row, facts)| (0..row.times).map(|_| facts.produces));
    std::iter::once(facts.start).chain(counts).map(|count| count as usize).collect()
}

/// The rounds of a shape file, and those of its surface as triangles.
fn rounds_of_both(name: &str, fineness: [u32; 2]) -> [Vec<usize>; 2] {
    let path = format!("{}/shapes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    #[expect(clippy::disallowed_methods, reason = "tests read their cases from the disk")]
    let text = std::fs::read(path).expect("readable");
    let shape = load("x.toml", &text, &Options::default()).0.expect("a sound file");
    let closed = [shape.tubes[0].start, shape.tubes[0].end].map(|end| end == End::Closed);
    let solid = triangles(&*shape.tubes[0].surface, closed, fineness);
    let settings = Options { gauge: Some(shape.gauge), ..options(1.0) };
    let cut = load("x.obj", &solid.obj(), &settings).0.expect("a sound mesh");
    let (_, one) = pattern(shape, &Options::default());
    let (_, other) = pattern(cut, &settings);
    [counts(&one), counts(&other)]
}

/// Rounds of which one has more stitches than the other by more than one and by more than 3 %.
fn apart(one: &[usize], other: &[usize]) -> usize {
    let far = |(one, other): &(&usize, &usize)| one.abs_diff(**other) > (**one * 3 / 100).max(1);
    one.iter().zip(other).filter(far).count()
}

#[test]
fn a_shape_file_and_its_mesh_agree() {
    let names = [
        "ball",
        "egg",
        "capsule",
        "bowl",
        "vase",
        "beanie",
        "mushroom-cap",
        "mushroom-stem",
        "cylinder",
        "bell",
        "cord",
        "horn",
        "mitten",
        "paper/a",
    ];
    for name in names {
        let [one, other] = rounds_of_both(name, PLAIN);
        assert_eq!((one.len(), apart(&one, &other)), (other.len(), 0), "{name}: {one:?} {other:?}");
    }
    // A round or two may be shaped a little earlier or later at the same price, and so may short rows lie; and a mesh does not
    // say where to begin.
    for (name, turned) in [("pear", false), ("bottle", false), ("elbow", false), ("cone", true)] {
        let [one, mut other] = rounds_of_both(name, PLAIN);
        if turned {
            other.reverse();
        }
        assert_eq!(one.len(), other.len(), "{name}: {one:?} {other:?}");
        assert!(apart(&one, &other) <= 2, "{name}: {one:?} {other:?}");
    }
}

#[test]
fn a_shape_file_and_its_fine_mesh_agree() {
    for name in ["ball", "egg", "vase", "horn", "mitten", "paper/a"] {
        let [one, other] = rounds_of_both(name, FINE);
        assert_eq!((one.len(), apart(&one, &other)), (other.len(), 0), "{name}: {one:?} {other:?}");
    }
}

#[test]
fn a_bent_shape_file_and_its_mesh_agree_up_to_a_part_of_a_round() {
    for (name, grid) in [("paper/b", PLAIN), ("paper/b", FINE), ("paper/d", PLAIN), ("paper/d", FINE)] {
        let [one, other] = rounds_of_both(name, grid);
        // Of what comes after the last whole round one has at most half a round more.
        let whole = one.len().min(other.len()) - 1;
        let [rest, other_rest] = [&one, &other].map(|rounds| rounds[whole..].iter().sum::<usize>());
        // A short row more or less is a matter of next to nothing on fine triangles of the one with many.
        let off = usize::from(name == "paper/d" && grid == FINE);
        assert!(apart(&one[..whole], &other[..whole]) <= off, "{name}: {one:?} {other:?}");
        assert!(rest.abs_diff(other_rest) <= one[whole - 1] / 2, "{name}: {one:?} {other:?}");
    }
}

/// A shape file, and its surface as triangles from the same end on.
fn from_the_same_end(name: &str) -> [Shape; 2] {
    let path = format!("{}/shapes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    #[expect(clippy::disallowed_methods, reason = "tests read their cases from the disk")]
    let text = std::fs::read(path).expect("readable");
    let settings = Options { gauge: None, ..options(1.0) };
    let shape = load("x.toml", &text, &settings).0.expect("a sound file");
    let closed = [shape.tubes[0].start, shape.tubes[0].end].map(|end| end == End::Closed);
    let surface = &*shape.tubes[0].surface;
    let solid = triangles(surface, closed, PLAIN);
    let first = (0..32).map(|k| surface.point(0.0, f64::from(k) / 32.0)).sum::<DVec3>() / 32.0;
    let [x, y, z] = first.to_array();
    let Gauge { width, height, .. } = shape.gauge;
    let file = format!(
        "unit = \"mm\"\n[gauge]\nstitch = {{ width = {width}, height = {height} }}\n\
         [mesh]\nfile = \"x.obj\"\nunit = \"mm\"\nup = \"z\"\nstart = [{x}, {y}, {z}]\n"
    );
    let cut = load_beside("y.toml", file.as_bytes(), &settings, &|_| Ok(solid.obj()));
    [shape, cut.0.expect("a sound mesh")]
}

/// How far the line of a tube at u is off the plane across the axis there.
fn tilt(surface: &dyn ParametricSurface, u: f64) -> f64 {
    const AROUND: u32 = 32;
    let line = |u: f64| (0..AROUND).map(move |k| surface.point(u, f64::from(k) / f64::from(AROUND)));
    let middle = |u: f64| line(u).sum::<DVec3>() / f64::from(AROUND);
    let axis = (middle(u + 0.01) - middle(u - 0.01)).normalize();
    line(u).map(|p| (p - middle(u)).dot(axis).abs()).fold(0.0, f64::max)
}

#[test]
fn lines_of_a_bent_mesh_lie_across_its_axis() {
    for (name, most) in
        [("cane", 0.1), ("snake", 0.2), ("worm", 0.2), ("horn", 0.1), ("paper/c", 0.1), ("paper/d", 0.1)]
    {
        let [_, cut] = from_the_same_end(name);
        for k in 3..18 {
            let u = f64::from(k) / 20.0;
            let rows = tilt(&*cut.tubes[0].surface, u) / cut.gauge.height;
            assert!(rows < most, "{name}: {rows} rows at {u}");
        }
    }
}

#[test]
fn a_winding_shape_file_and_its_mesh_have_as_many_stitches() {
    // Where the axis winds, a short row that opens one round later moves those that follow: with stitches a thousandth larger or smaller
    // the files themselves have other counts in 6 and 7 (snake), 8 and 8 (worm), 4 and 0 (cane) of 40 to 50 rounds, and triangles
    // of 64 around cut off as much.
    for name in ["cane", "snake", "worm"] {
        let [shape, cut] = from_the_same_end(name);
        let settings = options(1.0);
        let [one, other] = [shape, cut].map(|shape| counts(&pattern(shape, &settings).1));
        let sums = [&one, &other].map(|rounds| rounds.iter().sum::<usize>() as f64);
        assert!((sums[1] / sums[0] - 1.0).abs() < 0.03, "{name}: {one:?} {other:?}");
        assert!(one.len().abs_diff(other.len()) <= 1, "{name}: {one:?} {other:?}");
        assert!(4 * apart(&one, &other) <= one.len(), "{name}: {one:?} {other:?}");
    }
}

#[test]
fn limbs_are_found() {
    let y = |p: DVec3| {
        let arms = union(
            capsule(p, DVec3::ZERO, v(45., 0., 45.), 12.0),
            capsule(p, DVec3::ZERO, v(-45., 0., 45.), 12.0),
            8.0,
        );
        union(capsule(p, v(0., 0., -60.), DVec3::ZERO, 15.0), arms, 8.0)
    };
    let cross = |p: DVec3| {
        union(
            capsule(p, v(-60., 0., 0.), v(60., 0., 0.), 13.0),
            capsule(p, v(0., 0., -60.), v(0., 0., 60.), 13.0),
            10.0,
        )
    };
    let teddy = |p: DVec3| {
        let mut d =
            union(capsule(p, v(0., 0., -10.), v(0., 0., 10.), 28.0), p.distance(v(0., 0., 55.)) - 24.0, 8.0);
        for side in [-1.0, 1.0] {
            d = union(d, capsule(p, v(side * 20., 0., 15.), v(side * 66., 0., -5.), 10.0), 6.0);
            d = union(d, capsule(p, v(side * 14., 0., -25.), v(side * 24., 0., -80.), 12.0), 6.0);
            d = union(d, capsule(p, v(side * 15., 0., 68.), v(side * 26., 0., 92.), 7.0), 5.0);
        }
        d
    };
    let octopus = |p: DVec3| {
        let arms = (0..8).map(|k| {
            let angle = TAU * (f64::from(k) + 0.5) / 8.0;
            let out = v(cos(angle), sin(angle), 0.0);
            capsule(p, out * 20.0, out * 85.0 - DVec3::Z * 12.0, 8.0)
        });
        arms.fold(capsule(p, v(0., 0., 5.), v(0., 0., 40.), 34.0), |body, arm| union(body, arm, 4.0))
    };
    let ears = |p: DVec3| {
        let side =
            |x: f64| capsule(p * v(1.0, 2.0, 1.0), v(x * 14., 0., 24.), v(x * 30., 0., 55.), 9.0) * 0.6;
        union(union(p.length() - 30.0, side(-1.0), 4.0), side(1.0), 4.0)
    };
    let cases: [(&str, Solid, usize); 5] = [
        ("y", Solid::level_set(y, v(-60., -18., -78.), v(60., 18., 60.), 4.0), 2),
        ("cross", Solid::level_set(cross, v(-76., -16., -76.), v(76., 16., 76.), 4.0), 3),
        ("teddy", Solid::level_set(teddy, v(-80., -32., -95.), v(80., 32., 102.), 4.0), 6),
        ("octopus", Solid::level_set(octopus, v(-97., -97., -33.), v(97., 97., 78.), 4.0), 9),
        ("ears", Solid::level_set(ears, v(-42., -34., -34.), v(42., 34., 66.), 3.0), 3),
    ];
    for (name, solid, tubes) in cases {
        let shape = shape_of(&solid, 4.0);
        let names = shape.tubes.iter().map(|tube| tube.name.as_str()).collect::<Vec<_>>();
        assert_eq!(shape.tubes.len(), tubes, "{name}: {names:?}");
        assert!(shape.tubes.iter().skip(1).all(|tube| tube.attachment.is_some()), "{name}");
        covers(name, shape, 4.0);
    }
}

#[test]
fn every_format_gives_the_same() {
    let solid = Solid::ball(30.0, 20);
    let settings = options(5.0);
    let counts = |name: &str, bytes: &[u8]| {
        let (shape, found) = load(name, bytes, &settings);
        rounds(&pattern(shape.unwrap_or_else(|| panic!("{name}: {found:#?}")), &settings).1)
    };
    let wanted = counts("ball.obj", &solid.obj());
    assert_eq!(counts("ball.stl", &solid.stl()), wanted);
    assert_eq!(counts("ball.stl", &solid.stl_text()), wanted);
    assert_eq!(counts("ball.ply", &solid.ply()), wanted);
    assert_eq!(counts("ball.ply", &solid.ply_binary()), wanted);
    let plain = Options { mesh: Reading::default(), ..options(5.0) };
    let (shape, found) = load("ball.glb", &solid.glb(), &plain);
    let shape = shape.unwrap_or_else(|| panic!("{found:#?}"));
    assert_eq!(rounds(&pattern(shape, &plain).1), wanted);
    // A header that begins like a text file.
    let mut header = solid.stl();
    header[..5].copy_from_slice(b"solid");
    assert_eq!(counts("ball.stl", &header), wanted);
}

fn codes(name: &str, bytes: &[u8]) -> Vec<&'static str> {
    let (shape, found) = load(name, bytes, &options(5.0));
    assert!(shape.is_none(), "{name} was taken");
    assert!(found.iter().all(|it| !it.labels.is_empty() && it.help.is_some()), "{found:#?}");
    found.iter().map(|it| it.code.as_str()).collect()
}

#[test]
fn what_is_no_surface_is_refused() {
    let torus = |p: DVec3, center: DVec3| {
        let q = p - center;
        v(v(q.x, q.y, 0.0).length() - 30.0, q.z, 0.0).length() - 10.0
    };
    let one = Solid::level_set(|p| torus(p, DVec3::ZERO), v(-42., -42., -12.), v(42., 42., 12.), 4.0);
    assert_eq!(codes("torus.obj", &one.obj()), ["E4104"]);
    let two = |p: DVec3| union(torus(p, v(-36., 0., 0.)), torus(p, v(36., 0., 0.)), 6.0);
    let two = Solid::level_set(two, v(-80., -44., -14.), v(80., 44., 14.), 4.0);
    let (_, found) = load("two.obj", &two.obj(), &options(5.0));
    assert!(found[0].message.contains("2 handles"), "{found:#?}");
    let apart = Solid::ball(20.0, 12).and(&Solid::ball(10.0, 8).moved(v(60., 0., 0.)));
    assert_eq!(codes("two.obj", &apart.obj()), ["E4102"]);

    // A flat grid with its middle cut out, and a ball without one face.
    let mut sheet = Solid::default();
    for j in 0..=12_u32 {
        sheet.points.extend((0..=12_u32).map(|i| v(f64::from(i) * 10.0, f64::from(j) * 10.0, 0.0)));
    }
    for (i, j) in (0..12).flat_map(|j| (0..12).map(move |i| (i, j))) {
        if !((4..8).contains(&i) && (4..8).contains(&j)) {
            let a = j * 13 + i;
            sheet.faces.extend([[a, a + 1, a + 14], [a, a + 14, a + 13]]);
        }
    }
    assert_eq!(codes("sheet.obj", &sheet.obj()), ["E4105"]);
    let mut open = Solid::ball(30.0, 24);
    open.faces.remove(400);
    assert_eq!(codes("ball.obj", &open.obj()), ["E4105"]);
    // A thousand holes are refused as soon: no ends are made of them.
    let mut sieve = Solid::ball(50.0, 110);
    let (mut number, around_poles) = (0, sieve.faces.len() - 440);
    sieve.faces.retain(|_| {
        number += 1;
        number % 37 != 0 || number > around_poles
    });
    assert_eq!(codes("sieve.obj", &sieve.obj()), ["E4105"]);

    let mut strip = Solid::default();
    for i in 0..40_u32 {
        let angle = TAU * f64::from(i) / 40.0;
        let (arm, up) = (v(cos(angle), sin(angle), 0.0), DVec3::Z);
        let across = arm * (10.0 * cos(angle / 2.0)) + up * (10.0 * sin(angle / 2.0));
        strip.points.extend([arm * 40.0 - across, arm * 40.0 + across]);
        let (a, b) = (2 * i, 2 * (i + 1));
        let [c, d] = if i == 39 { [1, 0] } else { [b, b + 1] };
        strip.faces.extend([[a, a + 1, c], [c, a + 1, d]]);
    }
    assert_eq!(codes("moebius.obj", &strip.obj()), ["E4103"]);

    let mut wall = Solid::ball(20.0, 12);
    let [a, b, _] = wall.faces[30];
    wall.points.push(DVec3::ZERO);
    wall.faces.push([a, b, wall.points.len() as u32 - 1]);
    assert_eq!(codes("wall.obj", &wall.obj()), ["E4101"]);
    let touching = Solid::ball(20.0, 12).and(&Solid::ball(20.0, 12).moved(v(0., 0., 40.)));
    assert_eq!(codes("touch.obj", &touching.obj()), ["E4102"]);
}

#[test]
fn what_can_be_repaired_is_repaired() {
    let sound = Solid::ball(30.0, 20);
    let wanted = rounds(&pattern(shape_of(&sound, 5.0), &options(5.0)).1);
    let mut worn = sound.clone();
    worn.faces.iter_mut().step_by(3).for_each(|face| face.swap(0, 1));
    worn.faces.push([5, 5, 9]);
    worn.faces.push(worn.faces[7]);
    let (shape, found) = load("worn.obj", &worn.obj(), &options(5.0));
    let repaired: Vec<_> = found.iter().filter(|it| it.code == Code::MeshRepaired).collect();
    assert_eq!(repaired.len(), 1, "{found:#?}");
    for word in ["1 face without an area", "stood twice", "turned to agree"] {
        assert!(repaired[0].message.contains(word), "{}", repaired[0].message);
    }
    assert_eq!(rounds(&pattern(shape.expect("repaired"), &options(5.0)).1), wanted);
    let mut inward = sound;
    inward.faces.iter_mut().for_each(|face| face.swap(0, 1));
    let (_, found) = load("inward.obj", &inward.obj(), &options(5.0));
    assert!(found.iter().any(|it| it.message.contains("look outward")), "{found:#?}");
}

#[test]
fn broken_files_are_refused_at_once() {
    for (name, bytes, code) in [
        ("a.obj", &b"v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n"[..], "E4003"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "E4002"),
        ("a.obj", b"v 0 0 0\nv 1 0\nf 1 1 1\n", "E4001"),
        ("a.obj", b"# nothing\n", "E4004"),
        ("a.obj", b"", "E4004"),
        ("a.obj", b"\x00\x01\x02", "E4001"),
        ("a.stl", b"", "E4001"),
        ("a.stl", b"solid", "E4001"),
        ("a.ply", b"plx\n", "E4001"),
        (
            "a.ply",
            b"ply\nformat ascii 1.0\nelement vertex 1000000000\nproperty float x\nend_header\n",
            "E4001",
        ),
        ("a.glb", b"glTF\x02\0\0\0\x04\0\0\0", "E4001"),
        ("a.gltf", b"{", "E4001"),
    ] {
        assert_eq!(codes(name, bytes), [code], "{name} {:?}", String::from_utf8_lossy(bytes));
    }
    let mut claim = vec![0; 84];
    claim[80..].copy_from_slice(&1_000_000_000_u32.to_le_bytes());
    claim.resize(100, 0);
    assert_eq!(codes("a.stl", &claim), ["E4001"]);
    let without = load("a.obj", &Solid::ball(20.0, 8).obj(), &Options::default());
    assert_eq!(without.1[0].code, Code::GaugeMissing);
}

#[test]
fn no_bytes_break_the_readers() {
    let solid = Solid::ball(20.0, 5);
    let files = [
        ("a.obj", solid.obj()),
        ("a.stl", solid.stl()),
        ("a.stl", solid.stl_text()),
        ("a.ply", solid.ply()),
        ("a.ply", solid.ply_binary()),
        ("a.glb", solid.glb()),
    ];
    let mut seed = 7_u32;
    let mut random = |below: usize| {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as usize % below
    };
    for (name, bytes) in files {
        for _ in 0..150 {
            let mut bytes = bytes.clone();
            for _ in 0..=random(3) {
                let at = random(bytes.len());
                match random(4) {
                    0 => bytes.truncate(at.max(1)),
                    1 => bytes[at] = random(256) as u8,
                    2 => bytes[at] = b"09.- \n{}\""[random(9)],
                    _ => drop(bytes.splice(at..at, [0xFF; 4])),
                }
            }
            load(name, &bytes, &options(5.0));
        }
    }
}

#[test]
fn a_shape_file_names_its_mesh_and_how_to_cut_it() {
    let solid = Solid::level_set(bent, v(-19., -19., -49.), v(99., 19., 69.), 4.0);
    let file = solid.obj();
    let loader = move |name: &str| {
        if name == "folder/bent.obj" { Ok(file.clone()) } else { Err(io::ErrorKind::NotFound.into()) }
    };
    let head = "unit = \"mm\"\n[gauge]\nstitch = { width = 5, height = 5 }\n[mesh]\nfile = \"bent.obj\"\n";
    let build = |rest: &str| {
        load_beside("folder/x.toml", format!("{head}{rest}").as_bytes(), &Options::default(), &loader)
    };
    let count = |rest: &str| {
        let (shape, found) = build(rest);
        let shape = shape.unwrap_or_else(|| panic!("{rest}: {found:#?}"));
        let (shape, program) = pattern(shape, &Options::default());
        let coverage = measure(&shape, &program).coverage;
        assert!((0.96..=1.04).contains(&coverage), "{rest}: {coverage}");
        (stitches(&program) as f64, shape.tubes[0].surface.point(0.0, 0.0))
    };
    let (harmonic, start) = count("");
    assert!(start.z < -40.0, "{start}");
    let (geodesic, _) = count("field = \"geodesic\"");
    let (plane, _) = count(
        "field = \"plane\"\ncurve = [[[0, 0, -45], [0, 0, 0]], [[0, 0, 0], [0, 0, 27.6], [22.4, 0, 50], [50, 0, 50]], [[50, 0, 50], [95, 0, 50]]]",
    );
    let (named, other) = count("start = [95, 0, 50]\npoles = [[0, 0, -45]]");
    assert!(other.x > 90.0, "{other}");
    for number in [geodesic, plane, named] {
        assert!((number / harmonic - 1.0).abs() < 0.1, "{harmonic} {number}");
    }
    let codes = |rest: &str| build(rest).1.iter().map(|it| it.code.as_str()).collect::<Vec<_>>();
    assert_eq!(codes("field = \"plane\""), ["E1003"]);
    assert_eq!(codes("field = \"plain\""), ["E1005"]);
    assert_eq!(codes("poles = [[1, 2]]"), ["E1010"]);
    assert_eq!(codes("field = \"plane\"\ncurve = [[0, 0, 200], [0, 0, 300]]"), ["E4106"]);
    let missing =
        load_beside("x.toml", head.as_bytes(), &Options::default(), &|_| Err(io::ErrorKind::NotFound.into()));
    assert_eq!(missing.1[0].code, Code::FileFails);
}

#[test]
fn blobs_become_tubes() {
    let mut seed = 11_u32;
    let mut random = |low: f64, high: f64| {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        low + (high - low) * f64::from(seed >> 8) / f64::from(1 << 24)
    };
    let mut loose = Vec::new();
    for round in 0..50 {
        // A ball with arms in directions far from each other.
        let count = round % 4;
        let mut arms: Vec<(DVec3, f64)> = Vec::new();
        while arms.len() < count {
            let arm = v(random(-1., 1.), random(-1., 1.), random(-1., 1.)).normalize_or_zero();
            if arm != DVec3::ZERO && arms.iter().all(|(other, _)| other.dot(arm) < 0.2) {
                arms.push((arm, random(8.0, 11.0)));
            }
        }
        let body = random(20.0, 24.0);
        let formula = |p: DVec3| {
            arms.iter().fold(p.length() - body, |d, (arm, radius)| {
                union(d, capsule(p, DVec3::ZERO, *arm * 50.0, *radius), 8.0)
            })
        };
        let solid = Solid::level_set(formula, DVec3::splat(-63.0), DVec3::splat(63.0), 4.5);
        let shape = shape_of(&solid, 4.0);
        // The trunk runs from arm to arm, or begins and ends between arms; the far side of the body may stand out, too.
        let (least, most) = (count.max(2) - 1, count + 1);
        assert!(
            (least..=most).contains(&shape.tubes.len()),
            "blob {round}: {count} arms, {}",
            shape.tubes.len()
        );
        let mut sink = Sink::new();
        let Some(program) = picot::program(&shape, &options(4.0), &mut sink) else {
            assert!(sink.has_errors(), "blob {round} was refused without a reason");
            loose.push((round, f64::NAN));
            continue;
        };
        assert!(verify(&program, &mut sink).is_some(), "{:#?}", sink.diagnostics());
        let coverage = measure(&shape, &program).coverage;
        if !(0.97..=1.03).contains(&coverage) {
            loose.push((round, coverage));
        }
    }
    assert!(loose.is_empty(), "{loose:?}");
}

#[test]
fn openings_are_ends() {
    let rings: Vec<Vec<DVec3>> = (0..16).map(|i| circle(20.0, 4.0 * f64::from(i), 24)).collect();
    let shape = shape_of(&Solid::tube(&rings, [None, None]), 5.0);
    assert_eq!((shape.tubes.len(), shape.tubes[0].start, shape.tubes[0].end), (1, End::Open, End::Open));
    // What is round begins at its pole, unless the file says otherwise.
    let cup = Solid::tube(&rings, [None, Some(v(0., 0., 62.))]);
    let ends = |shape: &Shape| (shape.tubes[0].start, shape.tubes[0].end);
    assert_eq!(ends(&shape_of(&cup, 5.0)), (End::Closed, End::Open));
    let text = b"unit = \"mm\"\n[gauge]\nstitch = { width = 5, height = 5 }\n[mesh]\nfile = \"cup.obj\"\nstart = [0, 0, 0]\n";
    let named = load_beside("cup.toml", text, &Options::default(), &|_| Ok(cup.obj())).0.expect("a cup");
    assert_eq!(ends(&named), (End::Open, End::Closed));
    let oval: Vec<Vec<DVec3>> =
        rings.iter().map(|ring| ring.iter().map(|p| *p * v(1.0, 0.7, 1.0)).collect()).collect();
    let oval = shape_of(&Solid::tube(&oval, [None, Some(v(0., 0., 62.))]), 5.0);
    assert_eq!(ends(&oval), (End::Open, End::Closed));
}

/// Poles of the limbs lie in the middles of their round ends, however they hang on the body.
#[test]
fn poles_lie_on_the_axes_of_limbs() {
    let limbs = [(v(20., 0., 15.), v(66., 0., -5.), 10.0), (v(-14., 0., -25.), v(-24., 0., -80.), 12.0)];
    let formula = |p: DVec3| {
        let body = capsule(p, v(0., 0., -10.), v(0., 0., 50.), 28.0);
        limbs.iter().fold(body, |body, (a, b, radius)| union(body, capsule(p, *a, *b, *radius), 6.0))
    };
    let shape = shape_of(&Solid::level_set(formula, v(-40., -32., -95.), v(80., 32., 82.), 3.0), 4.0);
    for (a, b, radius) in limbs {
        let tip = b + (b - a).normalize() * radius;
        let ends = shape.tubes.iter().flat_map(|tube| [0.0, 1.0].map(|u| tube.surface.point(u, 0.0)));
        let off = ends.map(|end| end.distance(tip)).fold(f64::INFINITY, f64::min);
        assert!(off < 3.5, "{off} off {tip}");
    }
}

#[test]
fn a_mesh_of_trousers_divides() {
    let body = |p: DVec3| {
        let legs = union(
            capsule(p, v(-38., 0., 40.), v(-46., 0., 160.), 26.0),
            capsule(p, v(38., 0., 40.), v(46., 0., 160.), 26.0),
            10.0,
        );
        union(capsule(p * v(0.6, 1., 1.), v(0., 0., -60.), v(0., 0., 20.), 36.0), legs, 12.0)
    };
    let whole = Solid::level_set(body, v(-82., -44., -64.), v(82., 44., 124.), 5.0);
    // The waist and the hems are open.
    let cut = whole.between(-40.0, 100.0);
    let shape = shape_of(&cut, 5.0);
    let names: Vec<&str> = shape.tubes.iter().map(|tube| tube.name.as_str()).collect();
    assert_eq!(names, ["trunk", "limb A", "limb B"]);
    assert!(
        shape.tubes.iter().skip(1).all(|tube| tube.attachment.is_some_and(|it| it.joint == Joint::Split))
    );
    let (shape, program) = pattern(shape, &options(5.0));
    let figures = measure(&shape, &program);
    assert!((0.97..=1.03).contains(&figures.coverage), "{}", figures.coverage);
    assert!(figures.length_error.chord.mean_abs < 0.05, "{:?}", figures.length_error.chord);
    assert!(figures.skew.all.mean < 0.12, "{:?}", figures.skew.all);
}

#[test]
fn what_is_found_can_be_written_as_a_shape_file() {
    use super::command::{Folder, read, run, stderr};
    let folder = Folder::new();
    let teddy = |p: DVec3| {
        let body = capsule(p, v(0., 0., -12.), v(0., 0., 30.), 26.0);
        let arm = |x: f64| capsule(p, v(x * 20., 0., 20.), v(x * 70., 0., 5.), 9.0);
        union(union(body, arm(-1.0), 5.0), arm(1.0), 5.0)
    };
    let solid = Solid::level_set(teddy, v(-84., -30., -42.), v(84., 30., 60.), 4.0);
    // One mesh twice, the second time in other axes.
    for (name, unit, up) in [("duck.obj", "mm", "z"), ("duck.obj", "cm", "x")] {
        let turned = |p: &DVec3| if up == "x" { v(p.z, p.x, p.y) / 10.0 } else { *p };
        let mesh = Solid { points: solid.points.iter().map(turned).collect(), faces: solid.faces.clone() };
        let (input, shape, text) =
            (folder.file(name, mesh.obj()), folder.path("duck.toml"), folder.path("duck.txt"));
        let from = ["--unit", unit, "--up", up, "--gauge", "5mmx5mm"];
        run(&[&["surface", input.as_str(), "-o", &shape], &from[..]].concat()).code(0);
        let file = String::from_utf8(read(&shape)).expect("text");
        for line in [format!("unit = \"{unit}\""), format!("up = \"{up}\""), "file = \"duck.obj\"".to_owned()]
        {
            assert!(file.contains(&line), "{file}");
        }
        assert!(file.contains("field = \"harmonic\"") && file.contains("seam = ["), "{file}");
        // `duck: 40 rounds, 900 stitches, about ..`
        let stitches = |arguments: &[&str]| -> f64 {
            let said = stderr(&run(arguments).code(0));
            let (before, _) = said.split_once(" stitches").expect("a summary");
            before.rsplit(' ').next().and_then(|count| count.parse().ok()).expect("a number")
        };
        let own = stitches(&[&["build", input.as_str(), "-o", &text], &from[..]].concat());
        let again = stitches(&["build", &shape, "-o", &text]);
        assert!((own / again - 1.0).abs() < 0.04, "{own} {again}");
    }
    run(&["surface", "shapes/ball.toml", "-o", &folder.path("ball.toml")]).code(2);
    let input = folder.path("duck.obj");
    run(&["surface", &input, "-o", &folder.path("x.toml")]).code(2);
}

#[test]
fn many_small_triangles_are_joined_without_a_loss() {
    let fine = Solid::ball(40.0, 160);
    let plain = Solid::ball(40.0, 24);
    let made = |solid: &Solid| {
        let (shape, program) = pattern(shape_of(solid, 5.0), &options(5.0));
        (rounds(&program), measure(&shape, &program).coverage)
    };
    let ((fine, covered), (plain, _)) = (made(&fine), made(&plain));
    assert!((0.97..=1.03).contains(&covered), "{covered}");
    let off: usize = fine.iter().zip(&plain).map(|(a, b)| a.abs_diff(*b)).sum();
    assert!(fine.len() == plain.len() && off * 33 < plain.iter().sum(), "{fine:?} {plain:?}");
}

/// Edges of a coarser mesh cut a thin tube short; its lines do not.
#[test]
fn joined_triangles_keep_the_girth_of_a_thin_tube() {
    let oval = |k: u32| -> Vec<DVec3> {
        circle(12.0, f64::from(k) * 0.5, 96).into_iter().map(|p| p * v(1.0, 0.8, 1.0)).collect()
    };
    let around = |ring: &[DVec3]| -> f64 {
        ring.iter().zip(ring.iter().cycle().skip(1)).map(|(a, b)| a.distance(*b)).sum()
    };
    let rings: Vec<Vec<DVec3>> = (0..=160).map(oval).collect();
    let shape = shape_of(&Solid::tube(&rings, [None, None]), 5.0);
    let share = girth(&*shape.tubes[0].surface, 0.5, 64) / around(&oval(0));
    assert!((0.99..1.003).contains(&share), "{share}");
}

/// An arm that leaves the side and bends up is no half of what it leaves.
#[test]
fn a_cactus_does_not_divide() {
    let cactus = |p: DVec3| {
        let arm = capsule(p, v(0., 0., 10.), v(40., 0., 10.), 9.4).min(capsule(
            p,
            v(40., 0., 10.),
            v(40., 0., 40.),
            9.4,
        ));
        union(capsule(p, v(0., 0., -40.), v(0., 0., 60.), 9.4), arm, 3.0)
    };
    let solid = Solid::level_set(cactus, v(-12., -12., -52.), v(52., 12., 72.), 3.0).between(-40.0, 80.0);
    let shape = shape_of(&solid, 2.5);
    let joints: Vec<Option<Joint>> =
        shape.tubes.iter().map(|tube| tube.attachment.map(|it| it.joint)).collect();
    assert_eq!(joints, [None, Some(Joint::Surface)]);
    let (shape, program) = pattern(shape, &options(2.5));
    for (tube, figures) in shape.tubes.iter().zip(measure_parts(&shape, &program)) {
        let (length, skew) = (figures.length_error.chord.mean_abs, figures.skew.all.mean);
        assert!(length <= 0.06 && skew <= 0.12, "{}: {length} {skew}", tube.name);
    }
}

/// A capsule as a tube of a shape file: its curve and its sections.
fn capsule_tube(a: DVec3, b: DVec3, radius: f64, start: bool) -> String {
    let way = (b - a).normalize();
    let (from, to) = (if start { a - way * radius } else { a }, b + way * radius);
    let length = from.distance(to);
    let mut section = String::new();
    let cap = |k: u32| {
        let angle = TAU / 4.0 * f64::from(k) / 16.0;
        (radius * (1.0 - cos(angle)) / length, radius * sin(angle))
    };
    let mut add = |at: f64, circle: f64| {
        let _ = writeln!(section, "  {{ at = {at}, circle = {circle} }},");
    };
    if start {
        (0..=16).map(cap).for_each(|(at, circle)| add(at, circle));
    } else {
        add(0.0, radius);
    }
    (0..=16).rev().map(cap).for_each(|(at, circle)| add(1.0 - at, circle));
    let point = |p: DVec3| format!("[{}, {}, {}]", p.x, p.y, p.z);
    format!("curve = [{}, {}]\nend = \"closed\"\nsection = [\n{section}]\n", point(from), point(to))
}

/// A capsule from its middle to its other middle, with its radius.
type Capsule = (DVec3, DVec3, f64);

/// A trunk with arms as a shape file, and as the mesh of a level set.
fn with_arms(trunk: Capsule, arms: [Capsule; 2], cell: f64) -> (Shape, Solid) {
    let mut text = "unit = \"mm\"\n[gauge]\nstitch = { width = 3.5, height = 3.5 }\n".to_owned();
    let _ = write!(text, "[trunk]\nstart = \"closed\"\n{}", capsule_tube(trunk.0, trunk.1, trunk.2, true));
    for (number, (a, b, radius)) in arms.into_iter().enumerate() {
        let from = (a.z + trunk.2) / (trunk.0.distance(trunk.1) + 2.0 * trunk.2);
        let tube = capsule_tube(a, b, radius, false);
        let _ = write!(text, "[[branch]]\nname = \"arm {number}\"\nfrom = {from}\n{tube}");
    }
    let (shape, found) = load("x.toml", text.as_bytes(), &Options::default());
    let all = [trunk, arms[0], arms[1]];
    let formula = |p: DVec3| all.iter().map(|(a, b, radius)| capsule(p, *a, *b, *radius)).fold(1e9, f64::min);
    let corner = |sign: f64, most: fn(DVec3, DVec3) -> DVec3| {
        let ends = all.iter().flat_map(|(a, b, radius)| [*a, *b].map(|p| p + DVec3::splat(sign * radius)));
        ends.reduce(most).unwrap_or_default() + DVec3::splat(5.0 * sign)
    };
    let solid = Solid::level_set(formula, corner(-1.0, DVec3::min), corner(1.0, DVec3::max), cell);
    (shape.unwrap_or_else(|| panic!("{found:#?}")), solid)
}

#[test]
fn a_shape_file_with_branches_and_its_mesh_agree() {
    let trunk = (DVec3::ZERO, v(0., 0., 80.), 20.0);
    let arms = [(v(0., 0., 30.), v(-60., 0., 60.), 9.0), (v(0., 0., 55.), v(70., 0., 75.), 11.0)];
    // The last one is made coarser first.
    for cell in [2.8, 2.6, 2.4, 1.1] {
        let (shape, solid) = with_arms(trunk, arms, cell);
        let (shape, program) = pattern(shape, &Options::default());
        let (cut, other) = pattern(shape_of(&solid, 3.5), &options(3.5));
        assert_eq!(cut.tubes.len(), 3);
        branches_agree((&shape, &program), (&cut, &other));
    }
}

/// The surface that closes the place of a thick arm bulges out, which is no reason for uneven rounds.
#[test]
fn a_round_trunk_stays_round_under_thick_arms() {
    let trunk = (DVec3::ZERO, v(0., 0., 87.6), 18.4);
    let arms = [(v(0., 0., 57.2), v(-46.5, 0., 91.2), 9.1), (v(0., 0., 27.5), v(49.8, 0., 11.2), 10.2)];
    let (shape, solid) = with_arms(trunk, arms, 2.6);
    let (_, program) = pattern(shape, &Options::default());
    let (cut, other) = pattern(shape_of(&solid, 3.5), &options(3.5));
    assert_eq!(cut.tubes.len(), 3);
    assert_eq!(rounds(&program), rounds(&other));
}

/// The parts of two programs have the same rounds; each is found by its tip.
fn branches_agree((shape, one): (&Shape, &Program), (cut, other): (&Shape, &Program)) {
    let tips = |shape: &Shape| -> Vec<DVec3> {
        shape.tubes.iter().map(|tube| tube.surface.point(1.0, 0.0)).collect()
    };
    let (ours, theirs) = (tips(shape), tips(cut));
    for (part, tip) in ours.iter().enumerate() {
        let far = |i: &usize| (theirs[*i].distance(*tip) * 1e3) as u64;
        let same = (0..theirs.len()).min_by_key(far).expect("a tube");
        let (one, other) = (rounds_of(one, part), rounds_of(other, same));
        let name = format!("part {part}: {one:?} {other:?}");
        // Short rows of one take the place of rounds of the other.
        let sums = [&one, &other].map(|rounds| rounds.iter().sum::<usize>() as f64);
        assert!(one.len().abs_diff(other.len()) <= 2, "{name}");
        assert!((sums[1] / sums[0] - 1.0).abs() < 0.03, "{name}");
        if part == 0 {
            assert_eq!((one.len(), apart(&one, &other)), (other.len(), 0), "{name}");
            continue;
        }
        // Up to the round that closes it every round has as many stitches, within 3 % or one. A short row goes over some twice,
        // and the rounds beside it make up for what it adds on one side.
        let middle = 1..one.len() - 4;
        let short = |i: usize| other[i] * 3 > one[i] * 4;
        let plain = middle.clone().filter(|i| !(i - 1..=i + 1).any(short));
        let rounds: Vec<usize> = plain.collect();
        assert!(2 * rounds.len() >= middle.len(), "{name}");
        assert!(rounds.iter().all(|i| apart(&one[*i..=*i], &other[*i..=*i]) == 0), "{name}");
    }
}
