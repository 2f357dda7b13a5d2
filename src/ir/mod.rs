//! The intermediate representation: what a shape or a written pattern becomes before it is printed.
//!
//! Two typed levels stand here. A [`Graph`] says where each stitch lies: its nodes are open loops (stitch tops) in
//! working order, its tiles tell which loops a stitch was worked into and which it left. A [`Pattern`] says what the
//! hook does: parts, rows, and operations folded into runs and repeats. The meaning of a row is its sequence of
//! [`Step`]s ([`Block::steps`]); two rows with equal steps are the same row.
//!
//! - A **loop** is the top of a stitch, open until a stitch is worked into it. A stitch *works* some loops and *makes* some.
//! - A **part** starts from a magic ring, a chain, or loops of another part, and is worked along one helix.
//! - A **row** (round) begins when the first loop of the round before is next on the hook, and ends when all of that
//!   round's loops have been worked.
//! - A **turn** changes the direction. After [`Direction::Back`] stitches are worked into the loops just made, newest
//!   first; after [`Direction::Forward`] the hook goes on in working direction, over the loops of the back pass first.
//!   A turn itself neither works nor makes a loop.

pub mod dialect;
pub mod dump;
pub mod exchange;
pub mod graph;
pub(crate) mod increases;
pub mod joins;
pub mod machine;
pub mod maker;
pub mod pattern;
pub mod stitch;
pub mod verify;
pub mod yarn;

pub use dialect::{Language, Terms};
pub use graph::{Graph, Node, NodeId, Tile};
pub use maker::{Hand, Maker};
pub use pattern::{Block, Direction, Finish, Op, Part, PartId, Pattern, Row, Segment, Start, Step};
pub use stitch::{Entry, Kind, Stitch};

/// Most loops that one row may have.
pub const MAX_ROW: u32 = 100_000;
/// Most loops that a whole pattern may have.
pub const MAX_LOOPS: u32 = 50_000_000;
/// Deepest nesting of repeats.
pub const MAX_NESTING: u32 = 16;

/// Size of one stitch, and where it comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gauge {
    /// Width of a stitch along the course, in mm.
    pub width: f64,
    /// Height of a stitch along the wale, in mm.
    pub height: f64,
    /// How the sizes are known.
    pub origin: GaugeOrigin,
}

/// How the gauge is known. Estimates are marked as such in every output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GaugeOrigin {
    /// The stitch size itself was given.
    Given,
    /// Measured on a swatch.
    Swatch,
    /// Estimated from yarn weight and hook; `in_range` is false for a hook that the yarn's table row does not list.
    Estimated {
        /// Craft Yarn Council weight number, 0 to 7.
        weight: u8,
        /// The hook.
        hook: yarn::Hook,
        /// The hook is among the usual ones for this weight.
        in_range: bool,
    },
}

impl Gauge {
    /// A gauge given as stitch size in mm.
    pub fn new(width: f64, height: f64) -> Self {
        Self { width, height, origin: GaugeOrigin::Given }
    }
    /// True when the sizes are a guess from yarn and hook.
    pub fn estimated(&self) -> bool {
        matches!(self.origin, GaugeOrigin::Estimated { .. })
    }
}

/// A whole pattern with what is known about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// Name of the object.
    pub name: String,
    /// Stitch size; `None` for a written pattern that does not tell it.
    pub gauge: Option<Gauge>,
    /// Whom the pattern is for.
    pub maker: Maker,
    /// Names of the yarn colors that steps refer to; empty when there is one unnamed color.
    pub colors: Vec<String>,
    /// What the hook does.
    pub pattern: Pattern,
    /// Where the stitches lie, one graph a part in the order of the parts; empty for a pattern written by hand.
    pub graphs: Vec<Graph>,
}
