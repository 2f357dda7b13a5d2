//! The one test binary.

mod render;
mod surfaces;
