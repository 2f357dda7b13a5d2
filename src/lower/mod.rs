//! From one level of the intermediate representation to the next.

mod couple;
pub mod divide;
pub mod join;
pub mod machine;
pub mod trace;
pub mod trim;

pub use trace::trace;
pub use trim::trim;
