//! What the object will look like: tiles and yarn in space, for pictures, models and the page.
//!
//! A [`Scene`] holds each stitch with the eight corners of its tile and each piece's yarn as one continuous line from
//! the first stitch to the last. Positions are those of the stitch graph; a pattern without graph is
//! [predicted](predict).

mod camera;
mod frame;
mod mesh;
mod net;
pub mod predict;
mod raster;
mod remark;
mod scene;
mod shade;
mod stitch;
mod sweep;
mod yarn;

pub use camera::Camera;
pub use mesh::{MAX_TRIANGLES, Mesh, Model, View};
pub use net::Role;
pub use scene::{DEFAULT_GAUGE, MAX_STITCHES, Piece, Places, Refused, Scene, Stitch};
pub use shade::{MAX_SIDE, Picture, kind_color, picture};
pub use yarn::{Bezier, Strand, Yarn};
