//! The one test binary.

mod arbitrary;
mod baseline;
#[cfg(feature = "cli")]
mod cli;
mod knitout;
mod loops;
mod machine;
mod metrics;
mod passes;
mod programs;
mod properties;
mod render;
mod shape_files;
mod snapshots;
mod surfaces;
mod tidy;
mod trace;
mod verify;
mod written;
mod xml;
