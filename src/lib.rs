//! Picot, a compiler from 3D shapes to textile instructions.

pub mod backends;
pub mod diag;
pub mod frontend;
pub mod generate;
pub mod ir;
pub mod math;
pub mod passes;
pub mod shape;
