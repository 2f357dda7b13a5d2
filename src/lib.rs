//! Picot, a compiler from 3D shapes to textile instructions.
//!
//! The whole pipeline: a [reader](frontend) turns a file into a shape or a pattern; [`generate`] lays stitches on the
//! shape's surface, one graph a tube; [`lower`] follows the yarn through the graph and writes down what the hook does;
//! [`passes`] fold that for people to read; [`ir::verify`] works the pattern loop by loop; and a [backend](backends)
//! prints what came through. Faults of the input are [diagnostics](diag) in a sink, never panics.

pub mod backends;
pub mod diag;
pub mod frontend;
pub mod generate;
pub mod ir;
pub mod lower;
pub mod math;
pub mod metrics;
pub mod passes;
pub mod settings;
pub mod shape;

use diag::{Sink, Source, Sources};
use frontend::{Input, Reader};
use ir::{Gauge, Pattern, Program};
use shape::Shape;

/// What the stages before printing may be told.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// A gauge that takes the place of the file's own.
    pub gauge: Option<Gauge>,
    /// Options of the generator.
    pub generate: generate::Options,
}

/// From an opened file to a program, ready for [`ir::verify::verify`]; `None` when the sink has the reason.
pub fn compile(
    source: &Source,
    reader: &Reader,
    options: &Options,
    sources: &mut Sources<'_>,
    sink: &mut Sink<'_>,
) -> Option<Program> {
    sink.stage("read");
    let errors = sink.errors();
    let input = (reader.read)(source, sources, sink)?;
    if sink.errors() > errors {
        return None;
    }
    match input {
        Input::Shape(mut shape) => {
            shape.gauge = options.gauge.unwrap_or(shape.gauge);
            program(&shape, options, sink)
        }
        Input::Program(mut program) => {
            program.gauge = options.gauge.or(program.gauge);
            Some(*program)
        }
    }
}

/// From a shape to a program: a graph and a part for each tube, folded by the passes.
pub fn program(shape: &Shape, options: &Options, sink: &mut Sink<'_>) -> Option<Program> {
    let mut program = Program {
        name: shape.name.clone(),
        gauge: Some(shape.gauge),
        colors: Vec::new(),
        pattern: Pattern::default(),
        graphs: Vec::new(),
    };
    sink.stage("generate");
    for tube in &shape.tubes {
        program.graphs.push(generate::generate(tube, &shape.gauge, &options.generate, sink)?);
    }
    fold(&mut program, sink);
    Some(program)
}

/// Runs all [passes](passes::PASSES) in order.
pub fn fold(program: &mut Program, sink: &mut Sink<'_>) {
    sink.stage("passes");
    passes::run(program, sink);
}
