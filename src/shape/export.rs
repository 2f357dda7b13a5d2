//! Surfaces as text: triangles in OBJ for modeling tools, and loops in Picot's own format.

use super::{End, Shape, Tube, girth, length_along};
use crate::ir::Gauge;
use glam::DVec3;
use std::fmt::Write;

/// Rows of samples to a row of stitches, and samples around to a stitch.
const FINENESS: f64 = 2.0;
/// Least and most of each.
const ROWS: [f64; 2] = [16.0, 2000.0];
const AROUND: [f64; 2] = [24.0, 256.0];

/// A grid of samples: rows from end to end, a closed end as a point of its own.
struct Grid {
    rows: Vec<Vec<DVec3>>,
    poles: [Option<DVec3>; 2],
}

impl Grid {
    fn new(tube: &Tube, gauge: &Gauge) -> Self {
        let surface = &*tube.surface;
        let length = length_along(surface, 0.0, 0.0..1.0, 32).max(length_along(surface, 0.5, 0.0..1.0, 32));
        let widest = (0..=16).map(|k| girth(surface, f64::from(k) / 16.0, 32)).fold(0.0, f64::max);
        let rows = (FINENESS * length / gauge.height).clamp(ROWS[0], ROWS[1]) as u32;
        let around = (FINENESS * widest / gauge.width).clamp(AROUND[0], AROUND[1]) as u32;
        let closed = [tube.start == End::Closed, tube.end == End::Closed];
        let row = |i: u32| {
            let u = f64::from(i) / f64::from(rows);
            (0..around).map(|k| surface.point(u, f64::from(k) / f64::from(around))).collect()
        };
        let inner = u32::from(closed[0])..rows + 1 - u32::from(closed[1]);
        let pole = |side: usize, u: f64| closed[side].then(|| surface.point(u, 0.0));
        Self { rows: inner.map(row).collect(), poles: [pole(0, 0.0), pole(1, 1.0)] }
    }
}

/// The surface of a shape as Wavefront OBJ, in millimeters with Z up: an object for each part.
pub fn obj(shape: &Shape) -> String {
    let mut text = format!("# {} in mm, Z up\n", line(&shape.name));
    let mut base = 1;
    for tube in &shape.tubes {
        let grid = Grid::new(tube, &shape.gauge);
        let _ = writeln!(text, "o {}", line(&tube.name));
        let around = grid.rows.first().map_or(0, Vec::len);
        let mut count = 0;
        for p in grid.rows.iter().flatten().chain(grid.poles.iter().flatten()) {
            let _ = writeln!(text, "v {:.5} {:.5} {:.5}", p.x, p.y, p.z);
            count += 1;
        }
        let at = |row: usize, k: usize| base + row * around + k % around.max(1);
        for row in 1..grid.rows.len() {
            for k in 0..around {
                // v runs to the left seen from outside.
                let [a, b, c, d] = [at(row - 1, k), at(row - 1, k + 1), at(row, k + 1), at(row, k)];
                let _ = writeln!(text, "f {d} {c} {b} {a}");
            }
        }
        let first = base + grid.rows.len() * around;
        let sides = (0..2).filter(|side: &usize| grid.poles[*side].is_some());
        for (pole, side) in (first..).zip(sides) {
            let row = if side == 0 { 0 } else { grid.rows.len().saturating_sub(1) };
            for k in 0..around {
                let [a, b] = [at(row, k), at(row, k + 1)];
                let _ = if side == 0 {
                    writeln!(text, "f {a} {b} {pole}")
                } else {
                    writeln!(text, "f {b} {a} {pole}")
                };
            }
        }
        base += count;
    }
    text
}

/// A tube in the text format of loops.
pub fn loops(name: &str, tube: &Tube, gauge: &Gauge) -> String {
    let grid = Grid::new(tube, gauge);
    let mut text = format!("picot-loops 1\nname {}\nunit mm\n", line(name));
    let _ = writeln!(text, "gauge {} {}", gauge.width, gauge.height);
    for (word, pole) in ["start", "end"].into_iter().zip(grid.poles) {
        if let Some(p) = pole {
            let _ = writeln!(text, "{word} {:.5} {:.5} {:.5}", p.x, p.y, p.z);
        }
    }
    for row in &grid.rows {
        text.push_str("loop\n");
        for p in row {
            let _ = writeln!(text, "{:.5} {:.5} {:.5}", p.x, p.y, p.z);
        }
    }
    text
}

/// A name that keeps to its line.
fn line(name: &str) -> String {
    name.chars().filter(|c| !c.is_control() && *c != '#').collect()
}
