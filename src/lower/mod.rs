//! From one level of the intermediate representation to the next.

pub mod machine;
pub mod trace;
pub mod trim;

pub use trace::trace;
pub use trim::trim;
