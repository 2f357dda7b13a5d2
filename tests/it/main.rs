//! The one test binary.

mod arbitrary;
mod baseline;
mod knitout;
mod loops;
mod passes;
mod programs;
mod properties;
mod render;
mod shape_files;
mod surfaces;
mod trace;
mod verify;
mod written;
mod xml;
