//! The view that metrics take of a graph: every yarn edge, turn and step of a short row is found once.

use super::baseline::shape;
use picot::diag::Sink;
use picot::generate::{Options, generate};
use picot::ir::graph::Corners;
use picot::ir::{Direction, Gauge, Graph, Node, Stitch, Tile};
use picot::metrics::{Class, Mesh, Readability, measure};

fn count(mesh: &Mesh<'_>, classes: &[Class]) -> usize {
    mesh.tiles.iter().filter(|tile| classes.contains(&tile.class)).count()
}

#[test]
fn short_rows_have_two_turns_two_gaps_and_one_step_each() {
    for (name, width) in [("c", 2.0), ("d", 2.5), ("d", 1.5)] {
        let tube = shape(name);
        let graph = generate(&tube, &Gauge::new(width, width), &Options::default(), &mut Sink::new());
        let graph = graph.expect("generates");
        let mesh = Mesh::of_graph(&graph);
        let turns = mesh.wales.iter().filter(|wale| wale.joins_levels).count();
        let steps = mesh.courses.iter().filter(|course| course.joins_levels).count();
        assert!(mesh.short_rows > 0);
        assert_eq!(turns, 2 * mesh.short_rows, "{name} {width}");
        assert_eq!(steps, mesh.short_rows, "{name} {width}");
        assert_eq!(mesh.fills.len(), 2 * mesh.short_rows, "{name} {width}");
        assert_eq!(count(&mesh, &[Class::TurnLeft, Class::TurnRight]), 2 * mesh.short_rows);
        // The yarn has an edge between any two successive loops: a course, or the wale of a turn.
        assert_eq!(mesh.courses.len() + turns, graph.nodes.len() - 1, "{name} {width}");
        assert_eq!(mesh.wales.len(), graph.wales().count(), "{name} {width}");
        let increases =
            graph.tiles.iter().filter_map(|tile| tile.stitch).filter(|it| it.is_increase()).count();
        assert_eq!(count(&mesh, &[Class::Inc]), increases, "{name} {width}");
    }
}

/// Six loops, six on them, and a short row of three over the second to fourth.
fn patch() -> Graph {
    let mut graph = Graph { start: 6, ..Graph::default() };
    let mut node = |x: f64, y: f64| {
        let position = glam::DVec3::new(x, y, 0.0);
        graph.nodes.push(Node { position, u: y / 10.0, tau: y, v: x / 10.0 });
        graph.nodes.len() as u32 - 1
    };
    let base: Vec<u32> = (0..6).map(|i| node(f64::from(i), 0.0)).collect();
    let mut tiles = Vec::new();
    let mut sc = |base: u32, top: u32, direction| {
        let (base, top) = (Corners::one(base), Corners::one(top));
        tiles.push(Tile { stitch: Some(Stitch::SC), direction, base, top });
    };
    let first: Vec<u32> = (0..4).map(|i| node(f64::from(i), 1.0)).collect();
    for i in 0..4 {
        sc(base[i], first[i], Direction::Forward);
    }
    let back: Vec<u32> = (1..4).rev().map(|i| node(f64::from(i), 2.0)).collect();
    for i in 0..3 {
        sc(first[3 - i], back[i], Direction::Back);
    }
    let third: Vec<u32> = (1..4).map(|i| node(f64::from(i), 3.0)).collect();
    for i in 0..3 {
        sc(back[2 - i], third[i], Direction::Forward);
    }
    for (i, loop_below) in base.iter().enumerate().skip(4) {
        let top = node(i as f64, 1.0);
        sc(*loop_below, top, Direction::Forward);
    }
    let turn = |from: u32, direction| Tile {
        stitch: None,
        direction,
        base: Corners::one(from),
        top: Corners::one(from + 1),
    };
    tiles.insert(4, turn(first[3], Direction::Back));
    tiles.insert(8, turn(back[2], Direction::Forward));
    graph.tiles = tiles;
    graph
}

#[test]
fn a_flat_patch_with_a_short_row() {
    let graph = patch();
    let mesh = Mesh::of_graph(&graph);
    assert_eq!(mesh.short_rows, 1);
    // Five quads below, two and two in the short row.
    assert_eq!(count(&mesh, &[Class::Quad]), 9);
    assert_eq!(count(&mesh, &[Class::TurnLeft]), 1);
    assert_eq!(count(&mesh, &[Class::TurnRight]), 1);
    let steps: Vec<_> = mesh.courses.iter().filter(|it| it.joins_levels).map(|it| (it.from, it.to)).collect();
    assert_eq!(steps, [(15, 16)]);
    // The gap on the left lies between the first loop and the three levels, the one on the right mirrors it.
    assert_eq!(mesh.fills, [[6, 7, 12, 13], [16, 9, 10, 15]]);
    assert_eq!(mesh.open, [6, 13, 14, 15, 16, 17]);
    let readability = Readability::of(&picot::ir::Pattern::default(), std::slice::from_ref(&graph));
    assert_eq!(readability.stacked_increases, 0.0);
}

#[test]
fn measures_do_not_panic_on_broken_graphs() {
    let tube = shape("c");
    let gauge = Gauge::new(2.5, 2.5);
    let whole = patch();
    for cut in 0..whole.nodes.len() {
        let mut graph = whole.clone();
        graph.nodes.truncate(cut);
        measure(&tube, &gauge, &graph);
    }
    for gone in 0..whole.tiles.len() {
        let mut graph = whole.clone();
        graph.tiles.remove(gone);
        measure(&tube, &gauge, &graph);
    }
    measure(&tube, &gauge, &Graph::default());
}
