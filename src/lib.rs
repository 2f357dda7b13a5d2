//! Picot, a compiler from 3D shapes to textile instructions.
//!
//! The whole pipeline: a [reader](frontend) turns a file into a shape or a pattern; [`generate`] lays stitches on the
//! shape's surface, one graph a tube; [`lower`] follows the yarn through the graph and writes down what the hook does;
//! [`passes`] fold that for people to read; [`ir::verify`] works the pattern loop by loop; and a [backend](backends)
//! prints what came through. Faults of the input are [diagnostics](diag) in a sink, never panics.
//!
//! ```
//! use picot::diag::{Sink, Sources};
//! use picot::{Options, backends, frontend, ir::verify::verify};
//!
//! let shape = r#"
//!     name = "cuff"
//!     unit = "cm"
//!     [gauge]
//!     stitch = { width = 0.5, height = 0.5 }
//!     [trunk]
//!     curve = [[0, 0, 0], [0, 0, 5]]
//!     section = [{ at = 0, circle = 3.2 }]
//! "#;
//!
//! // The core does no IO: files come through a loader, of which this shape needs none.
//! let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
//! let mut sources = Sources::new(&no_files);
//! let mut sink = Sink::new();
//! let source = sources.add("cuff.toml", shape.into())?;
//! let reader = frontend::reader_for_extension("toml").ok_or("no reader")?;
//!
//! let program = picot::compile(&source, reader, &Options::default(), &mut sources, &mut sink);
//! let program = program.ok_or_else(|| format!("{:?}", sink.diagnostics()))?;
//! let verified = verify(&program, &mut sink).ok_or("cannot be worked")?;
//!
//! let target = backends::target("crochet").ok_or("no target")?;
//! let mut text = Vec::new();
//! target.configure("terms = 'uk'".parse()?)?.emit(&verified, &mut text, &mut sink)?;
//! assert!(String::from_utf8(text)?.contains("Rnds 1-9: 40 dc (40)"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod backends;
pub mod diag;
pub mod frontend;
pub mod generate;
pub mod ir;
pub mod lower;
pub mod math;
pub mod metrics;
pub mod passes;
pub mod preview;
pub mod process;
pub mod settings;
pub mod shape;

use diag::{Code, Diagnostic, Sink, Source, Sources};
use frontend::crochet::{self, Conventions};
use frontend::mesh;
use frontend::{Input, Reader};
use generate::capunaman::Baseline;
use ir::verify::Verified;
use ir::{Finish, Gauge, Graph, Maker, Part, PartId, Pattern, Program, Start};
use lower::divide::{Parent, Share};
use metrics::{Measure, Mesh, Sampler};
use preview::{Refused, predict};
use rayon::prelude::*;
use shape::{Attachment, End, Joint, Shape, Tube, for_maker};
use std::borrow::Cow;

/// What the stages before printing may be told.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// A gauge that takes the place of the file's own.
    pub gauge: Option<Gauge>,
    /// Options of the generator.
    pub generate: generate::Options,
    /// Conventions of written patterns; what a file declares itself comes first.
    pub conventions: Conventions,
    /// How to read a mesh that is given directly.
    pub mesh: mesh::Reading,
}

/// From an opened file to a program, ready for [`ir::verify::verify`]; `None` when the sink has the reason.
pub fn compile(
    source: &Source,
    reader: &Reader,
    options: &Options,
    sources: &mut Sources<'_>,
    sink: &mut Sink<'_>,
) -> Option<Program> {
    let input = read(source, reader, options, sources, sink)?;
    compile_input(input, source, options, sink)
}

/// From what was read to a program; `source` is where it was read.
pub fn compile_input(
    input: Input,
    source: &Source,
    options: &Options,
    sink: &mut Sink<'_>,
) -> Option<Program> {
    match input {
        Input::Shape(shape) => program(&shape, options, sink),
        Input::Program(program) => Some(*program),
        Input::Code(_) => {
            sink.push(
                Diagnostic::new(Code::NoPattern, "machine code holds no pattern")
                    .at(source.span(0..0), "")
                    .help("it can be checked, and converted between knitout and kcode"),
            );
            None
        }
    }
}

/// From an opened file to a shape or a pattern.
pub fn read(
    source: &Source,
    reader: &Reader,
    options: &Options,
    sources: &mut Sources<'_>,
    sink: &mut Sink<'_>,
) -> Option<Input> {
    sink.stage("read");
    let errors = sink.errors();
    let input = if reader.name == crochet::READER.name {
        crochet::read(source, &options.conventions, sink)
    } else if mesh::is_mesh(reader) {
        mesh::read(source, reader, options.mesh, options.gauge, sources, sink)
    } else if reader.name == frontend::loops::READER.name {
        frontend::loops::read_at(source, options.gauge, sink)
    } else if reader.name == frontend::shape::READER.name {
        frontend::shape::read_at(source, options.gauge, sources, sink)
    } else {
        (reader.read)(source, sources, sink)
    };
    let mut input = input.filter(|_| sink.errors() == errors)?;
    match &mut input {
        // Our own readers have done so, for they cut by it; one from elsewhere knows nothing of options.
        Input::Shape(shape) => shape.gauge = options.gauge.unwrap_or(shape.gauge),
        Input::Program(program) => program.gauge = options.gauge.or(program.gauge),
        Input::Code(_) => {}
    }
    Some(input)
}

/// From a shape to a program: a graph and a part for each tube, folded by the passes.
pub fn program(shape: &Shape, options: &Options, sink: &mut Sink<'_>) -> Option<Program> {
    let options = &Options { generate: options.generate.granting(&shape.wishes), ..options.clone() };
    let mut program = Program {
        name: shape.name.clone(),
        gauge: Some(shape.gauge),
        maker: options.generate.maker(),
        colors: Vec::new(),
        pattern: Pattern::default(),
        graphs: Vec::new(),
    };
    for (graph, part) in lay(shape, options, sink)? {
        program.pattern.parts.push(part);
        program.graphs.push(graph);
    }
    sink.stage("join");
    for (index, tube) in shape.tubes.iter().enumerate() {
        let Some(Attachment { parent, joint }) = tube.attachment else { continue };
        let (part, to) = (PartId(index as u32), PartId(parent as u32));
        match joint {
            Joint::Surface => lower::join::on_surface(&mut program, part, to, sink)?,
            Joint::Opening => lower::join::through_slit(&mut program, part, to, sink)?,
            // They were begun on their loops.
            Joint::Split => {}
        }
    }
    sink.stage("passes");
    passes::run(&mut program, sink);
    Some(program)
}

/// A graph and a part for each tube. Tubes do not see each other, so they are laid in parallel; only those into which
/// another one divides begin on its last loops, and wait for it.
fn lay(shape: &Shape, options: &Options, sink: &mut Sink<'_>) -> Option<Vec<(Graph, Part)>> {
    sink.stage("generate");
    let one = |tube: &Tube, share: Option<&Share>, sink: &mut Sink<'_>| {
        let mut graph = match share {
            Some(share) => generate::generate_on(tube, &share.loops, &shape.gauge, &options.generate, sink)?,
            None => generate::generate(tube, &shape.gauge, &options.generate, sink)?,
        };
        sink.stage("trace");
        let finish = match tube.end {
            End::Open => Finish::Open,
            End::Closed => Finish::DrawnShut,
        };
        let mut part = lower::trace(&tube.name, &graph, finish);
        lower::trim(&mut graph, &mut part);
        if let Some(share) = share {
            part.start = Start::Join { segments: share.segments.clone() };
        }
        Some((graph, part))
    };
    if let [tube] = shape.tubes.as_slice() {
        return Some(vec![one(tube, None, sink)?]);
    }
    let divides = |tube: &Tube| tube.attachment.is_some_and(|it| it.joint == Joint::Split);
    let done: Vec<_> = shape
        .tubes
        .par_iter()
        .map(|tube| {
            let mut findings = Sink::new();
            let laid = if divides(tube) { None } else { Some(one(tube, None, &mut findings)) };
            (laid, findings.take())
        })
        .collect();
    let mut laid: Vec<Option<(Graph, Part)>> = Vec::with_capacity(done.len());
    for (tube, findings) in done {
        for finding in findings {
            sink.push(finding);
        }
        laid.push(match tube {
            Some(tube) => Some(tube?),
            None => None,
        });
    }
    for parent in 0..shape.tubes.len() {
        let on = |tube: &Tube| divides(tube) && tube.attachment.is_some_and(|it| it.parent == parent);
        let children: Vec<usize> = (0..shape.tubes.len()).filter(|i| on(&shape.tubes[*i])).collect();
        if children.is_empty() {
            continue;
        }
        let shares = divide(shape, parent, &children, laid.get_mut(parent)?.as_mut()?, sink)?;
        for (child, share) in children.iter().zip(&shares) {
            let tube = shape.tubes.get(*child)?;
            *laid.get_mut(*child)? = Some(one(tube, Some(share), sink)?);
        }
    }
    laid.into_iter().collect()
}

/// Divides the last loops of a tube between the two that it divides into.
fn divide(
    shape: &Shape,
    parent: usize,
    children: &[usize],
    (graph, part): &mut (Graph, Part),
    sink: &mut Sink<'_>,
) -> Option<[Share; 2]> {
    const AROUND: u32 = 128;
    let odd = |message: String, help: &str, sink: &mut Sink<'_>| {
        let name = shape.tubes.get(parent).map_or("?", |tube| &tube.name);
        sink.push(Diagnostic::new(Code::DividesOddly, message).in_round(name, None).help(help));
        None
    };
    let &[one, other] = children else {
        let message = format!("a tube divides among {}, not two", children.len());
        return odd(message, "let it divide in two, and one of these again", sink);
    };
    let line = |child: usize| -> Vec<glam::DVec3> {
        let point = |k: u32| shape.tubes[child].surface.point(0.0, f64::from(k) / f64::from(AROUND));
        (0..AROUND).map(point).collect()
    };
    let (first, second) = (line(one), line(other));
    let mut whole = Parent { part, graph, id: PartId(parent as u32) };
    let children = [(PartId(one as u32), first.as_slice()), (PartId(other as u32), second.as_slice())];
    let size = [shape.gauge.width, shape.gauge.height];
    let shares = lower::divide::divide(&mut whole, children, size);
    if shares.is_none() {
        let name = |child: usize| shape.tubes.get(child).map_or("?", |tube| tube.name.as_str());
        let message = format!("too few loops to divide between {} and {}", name(one), name(other));
        return odd(message, "use a smaller stitch, or make both about as wide", sink);
    }
    shares
}

/// Measures the graphs of a program against the shape that they were generated from.
pub fn measure(shape: &Shape, program: &Program) -> Measure {
    let mut sampler = Sampler::new(shape.gauge);
    for (index, graph) in program.graphs.iter().enumerate() {
        sample(shape, index, graph, program.maker, &mut sampler);
    }
    sampler.finish()
}

/// Samples one tube as its stitches are laid: for the right hand, and standing straight.
fn sample(shape: &Shape, index: usize, graph: &Graph, maker: Maker, sampler: &mut Sampler) {
    let Some(tube) = shape.tubes.get(index) else { return };
    sampler.count(graph);
    let graph = graph.right_handed(maker.hand);
    for_maker(&*tube.surface, &shape.gauge, maker, |surface, drift| {
        let graph = match drift {
            Some(drift) => Cow::Owned(drift.as_laid(graph.into_owned())),
            None => graph,
        };
        sampler.add_on(surface, [tube.start, tube.end], &net(shape, index, &graph));
    });
}

/// Measures each part by itself, in the order of the tubes.
pub fn measure_parts(shape: &Shape, program: &Program) -> Vec<Measure> {
    let measure = |(index, graph): (usize, &Graph)| {
        let mut sampler = Sampler::new(shape.gauge);
        sample(shape, index, graph, program.maker, &mut sampler);
        sampler.finish()
    };
    program.graphs.iter().enumerate().map(measure).collect()
}

/// The net of one tube; where a tube divides, rows do not end as a helix does.
fn net<'g>(shape: &Shape, index: usize, graph: &'g Graph) -> Mesh<'g> {
    let splits = |tube: &Tube, parent: Option<usize>| {
        tube.attachment.is_some_and(|it| it.joint == Joint::Split && parent.is_none_or(|at| at == it.parent))
    };
    let begins = shape.tubes.get(index).is_some_and(|tube| splits(tube, None));
    let ends = shape.tubes.iter().any(|tube| splits(tube, Some(index)));
    Mesh::of_graph(graph).ragged([begins, ends])
}

/// Lays the [baseline](generate::capunaman) of the paper's tables on each tube of a shape.
pub fn baseline(shape: &Shape, sink: &mut Sink<'_>) -> Option<Vec<Baseline>> {
    sink.stage("generate");
    shape.tubes.iter().map(|tube| generate::capunaman::capunaman(tube, &shape.gauge, sink)).collect()
}

/// Settles baseline nets on their tubes by the relaxation that ends our own algorithm, for a comparison of like with like.
pub fn settle_baseline(shape: &Shape, nets: &mut [Baseline], options: &Options) {
    for (tube, net) in shape.tubes.iter().zip(nets) {
        net.settle(tube, &shape.gauge, &options.generate);
    }
}

/// Measures the baseline net of each tube by itself.
pub fn measure_baseline_parts(shape: &Shape, nets: &[Baseline]) -> Vec<Measure> {
    let nets = shape.tubes.iter().zip(nets);
    nets.map(|(tube, net)| baseline_of(&shape.gauge, [(tube, net)].into_iter())).collect()
}

/// Measures baseline nets, one for each tube of the shape.
pub fn measure_baseline(shape: &Shape, nets: &[Baseline]) -> Measure {
    baseline_of(&shape.gauge, shape.tubes.iter().zip(nets))
}

fn baseline_of<'s>(gauge: &Gauge, nets: impl Iterator<Item = (&'s Tube, &'s Baseline)>) -> Measure {
    let mut sampler = Sampler::new(*gauge);
    for (tube, net) in nets {
        sampler.add(tube, &Mesh::of_wales(&net.nodes, net.start(), &net.wales));
        let counts = net.counts();
        sampler.note(counts.increases, counts.decreases, counts.crossings);
    }
    sampler.finish()
}

/// Predicts the shape of a program from its pattern alone, and compares it with the shape that it was generated from.
/// `None` for a program without graphs or gauge.
pub fn predict(program: &Verified<'_>, sink: &Sink<'_>) -> Result<Option<predict::Fit>, Refused> {
    sink.stage("predict");
    let Some(gauge) = program.gauge else { return Ok(None) };
    predict::fit(program, [gauge.width, gauge.height], sink)
}
