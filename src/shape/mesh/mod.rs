//! Polygon meshes: a gate that repairs or refuses, a field of rows over the surface, and the tubes cut along it.

mod coarse;
mod cut;
mod divide;
mod ends;
mod factor;
mod fan;
mod field;
mod flat;
mod gate;
mod geodesic;
mod handle;
mod holes;
mod levels;
mod limb;
mod link;
mod middle;
mod patch;
mod slice;
mod solver;
mod soup;
mod tree;
mod way;

pub use cut::{Cut, Piece, Plan};
pub use field::Field;
pub use gate::Fault;
pub use soup::Soup;

use crate::shape::revolve::Mended;
use glam::DVec3;

/// What was repaired; all of it leaves the shape as it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Repairs {
    /// Vertices that lay in the place of another.
    pub welded: u32,
    /// Faces with two corners in one place.
    pub degenerate: u32,
    /// Faces that stood twice.
    pub doubled: u32,
    /// Faces turned to agree with their neighbors.
    pub flipped: u32,
    /// Whether all faces looked inward.
    pub inside_out: bool,
}

/// A sound surface of triangles: one piece, two sides, no handles, at most two faces at an edge.
///
/// A half-edge has the number 3 f + k, runs from corner k of face f to the next corner, and has the face on its left seen
/// from outside.
#[derive(Clone, Debug)]
pub struct Mesh {
    points: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
    /// For each vertex its number in the file, from 1.
    vertices: Vec<u32>,
    /// The half-edge on the other side; `NONE` at an open edge.
    twins: Vec<u32>,
    /// Where the half-edges that leave a vertex begin in `leaving`.
    starts: Vec<u32>,
    leaving: Vec<u32>,
    boundaries: Vec<Vec<u32>>,
    /// Where the mesh was made coarser: the normals that its vertices had before, for edges cut the surface short. Zero where
    /// they are not known; empty where none is.
    normals: Vec<DVec3>,
    /// Where limbs were cut off and the surface was closed.
    patches: Vec<Mended>,
}
