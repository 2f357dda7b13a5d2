//! How good a stitch graph is: length error, skew, coverage, level and counts, each by a stated definition.
//!
//! Two conventions stand side by side. The *paper's* measures lengths by three chords along the surface, leaves out the
//! edges that join levels at the ends of short rows, and counts skew on quads and decreases only. *Ours* counts every
//! edge and every tile, with lengths by the chord and by the surface. An error is (L - l) / l for an edge of length L
//! where the gauge asks for l: the stitch width along courses, the height along wales (paper, equation 2). Skew is the
//! absolute cosine of the angle between the middle lines of a tile (paper, equation 3); 0 is square.

mod geometry;
mod mesh;
mod readability;
mod sampler;
mod stats;
mod walk;

pub use mesh::{Class, Edge, Mesh, Tile};
pub use readability::Readability;
pub use sampler::Sampler;
pub use stats::Stats;

use crate::ir::{Gauge, Graph};
use crate::shape::Tube;
use serde::Serialize;

/// All numbers of a stitch graph. Errors and skew are fractions.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Measure {
    /// Loops, with those of a chain that the first round is worked into.
    pub nodes: usize,
    /// Stitches worked: loops without the chain.
    pub stitches: usize,
    /// Short rows.
    pub short_rows: usize,
    /// Increases.
    pub increases: usize,
    /// Decreases.
    pub decreases: usize,
    /// Length errors.
    pub length_error: LengthError,
    /// Skew.
    pub skew: Skew,
    /// Area of all tiles as a share of the area that stitches can cover.
    pub coverage: f64,
    /// Stitch count times stitch area as a share of the same area.
    pub coverage_by_count: f64,
    /// How level the last round ends.
    pub level: Level,
    /// Tiles whose outside lies inside.
    pub inverted_tiles: usize,
    /// Pairs of wales that cross; a workable pattern has none.
    pub crossings: usize,
}

/// Length errors of all edges, and of courses and wales.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LengthError {
    /// All edges, straight from loop to loop.
    pub chord: Stats,
    /// All edges, along the surface.
    pub surface: Stats,
    /// Edges along the yarn, with its steps at the ends of short rows.
    pub course: Lengths,
    /// Edges from row to row, with the turns.
    pub wale: Lengths,
    /// The yarn's steps at the ends of short rows alone.
    pub step: Lengths,
    /// In the paper's convention.
    pub paper: PaperLengths,
}

/// Errors by the two kinds of length.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Lengths {
    /// Straight from loop to loop.
    pub chord: Stats,
    /// Along the surface.
    pub surface: Stats,
}

/// Length errors in the paper's convention.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PaperLengths {
    /// All edges that count there.
    pub all: Stats,
    /// Along the yarn.
    pub course: Stats,
    /// From row to row.
    pub wale: Stats,
}

/// Skew of all tiles, in the paper's convention, and by kind.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Skew {
    /// All tiles.
    pub all: Stats,
    /// The tiles that count in the paper: those over an edge of a row whose ends both have wales.
    pub paper: Stats,
    /// Two stitches side by side.
    pub quad: Stats,
    /// Increases.
    pub inc: Stats,
    /// Decreases.
    pub dec: Stats,
    /// Across the ends of short rows.
    pub step: Stats,
    /// At the turns.
    pub turn: Stats,
}

/// How level the last round ends, in rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Level {
    /// Mean height that is missing below where the last turn of a helix to the rim lies, at a closed end below the helix;
    /// negative where the work stands above it.
    pub missing: f64,
    /// Highest minus lowest place of the last round against the helix.
    pub spread: f64,
}

/// Measures the graph of one tube.
pub fn measure(tube: &Tube, gauge: &Gauge, graph: &Graph) -> Measure {
    let mut sampler = Sampler::new(*gauge);
    sampler.add(tube, &Mesh::of_graph(graph));
    sampler.count(graph);
    sampler.finish()
}
