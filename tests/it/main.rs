//! The one test binary.

mod arbitrary;
mod baseline;
#[cfg(feature = "cli")]
mod cli;
mod corpus;
mod ebnf;
mod examples;
mod grammar;
mod knitout;
mod loops;
mod machine;
mod metrics;
mod mutation;
mod passes;
mod patterns;
mod programs;
mod properties;
mod reader;
mod render;
mod shape_files;
mod snapshots;
mod surfaces;
mod tidy;
mod trace;
mod verify;
mod written;
mod xml;
