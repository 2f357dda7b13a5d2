//! Passes over a pattern: each keeps the steps, and says so in [`PASSES`].

use crate::diag::Sink;
use crate::ir::Program;

/// One pass. Adding one is one file and one line of [`PASSES`].
#[derive(Debug)]
pub struct Pass {
    /// Name, for what it does.
    pub name: &'static str,
    /// One line: before and after.
    pub about: &'static str,
    /// Does it.
    pub run: fn(&mut Program, &mut Sink<'_>),
}

/// The passes in the order in which they run; each line carries its reason.
pub static PASSES: &[Pass] = &[];
