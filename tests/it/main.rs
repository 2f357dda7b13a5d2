//! The one test binary.

mod arbitrary;
mod loops;
mod render;
mod surfaces;
mod trace;
mod verify;
