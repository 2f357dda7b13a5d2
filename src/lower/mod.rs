//! From one level of the intermediate representation to the next.

pub mod trace;

pub use trace::trace;
