//! Picot XML: everything that a program holds, written so that reading it back gives the same program bit for bit.
//!
//! The form is described in `grammar/xml.md` and held by `grammar/picot.xsd`, `picot.rng` and `picot.sch`.

mod tag;

use super::{Backend, Error, Format};
use crate::diag::Sink;
use crate::ir::exchange::{MAJOR, MINOR, NAMESPACE, Words};
use crate::ir::verify::{PartFacts, Verified};
use crate::ir::{
    Block, Direction, Entry, Gauge, GaugeOrigin, Graph, Hand, Op, Part, PartId, Program, Segment, Start,
    Stitch,
};
use std::io;
use tag::Tags;

/// The XML backend.
#[derive(Clone, Debug, PartialEq, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Xml {
    /// Write the stitch graph too, where the program has one. Default: true.
    pub graph: bool,
}

impl Default for Xml {
    fn default() -> Self {
        Self { graph: true }
    }
}

impl Format for Xml {
    const NAME: &'static str = "xml";
    const EXTENSION: &'static str = "xml";
    const ABOUT: &'static str = "Picot XML: the whole program, lossless";
}

impl Backend for Xml {
    fn emit(
        &self,
        program: &Verified<'_>,
        out: &mut dyn io::Write,
        _sink: &mut Sink<'_>,
    ) -> Result<(), Error> {
        self.write(program, out)
    }
}

impl Xml {
    fn write(&self, program: &Verified<'_>, out: &mut dyn io::Write) -> Result<(), Error> {
        holdable(program)?;
        let mut out = io::BufWriter::with_capacity(1 << 16, out);
        let writer = Writer { tags: Tags::new(&mut out)?, words: Words::new(), program };
        writer.program(self.graph)?;
        io::Write::flush(&mut out)?;
        Ok(())
    }
}

/// Looks for what XML cannot hold before the first byte is written.
fn holdable(program: &Program) -> Result<(), Error> {
    let refuse = |what: String| Err(Error::Unsupported { backend: Xml::NAME, what });
    let names = std::iter::once(("the object's name".to_owned(), program.name.as_str()))
        .chain(
            program
                .colors
                .iter()
                .enumerate()
                .map(|(i, name)| (format!("the name of color {}", i + 1), &**name)),
        )
        .chain(
            program
                .pattern
                .parts
                .iter()
                .enumerate()
                .map(|(i, part)| (format!("the name of part {}", i + 1), part.name.as_str())),
        );
    for (what, name) in names {
        if let Some(bad) = name.chars().find(|&c| !tag::is_xml_char(c)) {
            return refuse(format!(
                "{what} holds U+{:04X}, a character that no XML file can hold",
                u32::from(bad)
            ));
        }
    }
    for (part, graph) in program.graphs.iter().enumerate() {
        if ![graph.pole, graph.end_pole].into_iter().flatten().all(glam::DVec3::is_finite) {
            return refuse(format!("a pole in the graph of part {} is not finite", part + 1));
        }
    }
    let mut seen = std::collections::BTreeSet::new();
    for part in &program.pattern.parts {
        if !seen.insert(&*part.name) {
            return refuse(format!("two parts are named {:?}, and parts are referred to by name", part.name));
        }
    }
    Ok(())
}

struct Writer<'p, W: io::Write> {
    tags: Tags<W>,
    words: Words,
    program: &'p Verified<'p>,
}

impl<W: io::Write> Writer<'_, W> {
    fn program(mut self, graph: bool) -> io::Result<()> {
        let program = self.program;
        self.tags.tag("program").text("xmlns", NAMESPACE).text("version", &format!("{MAJOR}.{MINOR}"));
        self.tags.text("name", &program.name).text("unit", "mm");
        if program.maker.hand != Hand::Right {
            self.tags.text("hand", program.maker.hand.word());
        }
        if program.maker.lean != 0.0 {
            self.tags.real("lean", program.maker.lean);
        }
        self.tags.open()?;
        if let Some(gauge) = &program.gauge {
            self.gauge(gauge)?;
        }
        for (index, name) in program.colors.iter().enumerate() {
            self.tags.tag("yarn").text("id", &yarn_id(index)).text("name", name).empty()?;
        }
        for (index, (part, facts)) in program.pattern.parts.iter().zip(&program.facts().parts).enumerate() {
            self.part(part, facts, program.graphs.get(index).filter(|_| graph))?;
        }
        self.tags.close("program")?;
        self.tags.finish()
    }

    fn gauge(&mut self, gauge: &Gauge) -> io::Result<()> {
        let tag = self.tags.tag("gauge").real("width", gauge.width).real("height", gauge.height);
        match gauge.origin {
            GaugeOrigin::Given => tag.text("origin", "given"),
            GaugeOrigin::Swatch => tag.text("origin", "swatch"),
            GaugeOrigin::Estimated { weight, hook, in_range } => tag
                .text("origin", "estimated")
                .count("weight", weight.into())
                .real("hook", hook.mm())
                .text("usual", if in_range { "true" } else { "false" }),
        }
        .empty()
    }

    fn part(&mut self, part: &Part, facts: &PartFacts, graph: Option<&Graph>) -> io::Result<()> {
        let tag = self.tags.tag("part").text("name", &part.name);
        let tag = if part.flat { tag.text("flat", "true") } else { tag };
        if part.copies == 1 { tag } else { tag.count("copies", part.copies) }.open()?;
        self.start(&part.start)?;
        for ((number, row), facts) in part.numbered_rows().zip(&facts.rows) {
            let tag = self.tags.tag("round").count("number", number);
            let tag =
                if row.times > 1 { tag.count("last", number.saturating_add(row.times - 1)) } else { tag };
            let tag = tag.count("consumes", facts.consumes).count("produces", facts.produces);
            if let Some((stated, _)) = row.stated { tag.count("stated", stated) } else { tag }.open()?;
            self.block(&row.body)?;
            self.tags.close("round")?;
        }
        self.tags.tag("finish").text("kind", part.finish.word()).empty()?;
        if let Some(graph) = graph {
            self.graph(graph)?;
        }
        self.tags.close("part")
    }

    fn start(&mut self, start: &Start) -> io::Result<()> {
        let tag = self.tags.tag("start");
        match start {
            Start::Ring { loops } => tag.text("kind", "ring").count("loops", *loops).empty(),
            Start::Chain { loops, joined } => {
                let joined = if *joined { "true" } else { "false" };
                tag.text("kind", "chain").count("loops", *loops).text("joined", joined).empty()
            }
            Start::Join { segments } => {
                tag.text("kind", "pickup").count("loops", start.loops()).open()?;
                for segment in segments {
                    self.segment(*segment)?;
                }
                self.tags.close("start")
            }
        }
    }

    fn segment(&mut self, segment: Segment) -> io::Result<()> {
        match segment {
            Segment::Open { part, loops } => {
                self.tags.tag("open").text("part", name(self.program, part)).count("loops", loops)
            }
            Segment::Held { part, loops } => {
                self.tags.tag("held").text("part", name(self.program, part)).count("loops", loops)
            }
            Segment::Surface { part, round, first, loops, back } => {
                let tags = self
                    .tags
                    .tag("surface")
                    .text("part", name(self.program, part))
                    .count("round", round)
                    .count("first", first)
                    .count("loops", loops);
                if back { tags.text("direction", Direction::Back.word()) } else { tags }
            }
            Segment::Chain { loops } => self.tags.tag("chain").count("loops", loops),
        }
        .empty()
    }

    fn block(&mut self, block: &Block) -> io::Result<()> {
        for op in block.ops() {
            match op {
                Op::Work { stitch, times } => {
                    self.tags.tag("work");
                    self.stitch(*stitch);
                    if *times != 1 {
                        self.tags.count("times", *times);
                    }
                    self.tags.empty()?;
                }
                Op::Repeat { body, times } => {
                    self.tags.tag("repeat").count("times", *times).open()?;
                    self.block(body)?;
                    self.tags.close("repeat")?;
                }
                Op::Turn(direction) => self.tags.tag("turn").text("direction", direction.word()).empty()?,
                Op::Hold { loops, by } => {
                    self.tags
                        .tag("hold")
                        .count("loops", *loops)
                        .text("by", name(self.program, *by))
                        .empty()?;
                }
                Op::Leave { loops } => self.tags.tag("leave").count("loops", *loops).empty()?,
                Op::Color(color) => self.tags.tag("color").text("yarn", &yarn_id((*color).into())).empty()?,
            }
        }
        Ok(())
    }

    /// The attributes of a stitch; what its word already says is left out.
    fn stitch(&mut self, stitch: Stitch) {
        let (word, plain) = self.words.word(stitch);
        self.tags.text("op", word);
        if stitch.works != plain.works {
            self.tags.count("works", stitch.works.into());
        }
        if stitch.makes != plain.makes {
            self.tags.count("makes", stitch.makes.into());
        }
        if stitch.entry != Entry::Both {
            self.tags.text("into", stitch.entry.word());
        }
    }

    fn graph(&mut self, graph: &Graph) -> io::Result<()> {
        self.tags.tag("graph").count("start", graph.start).open()?;
        for (name, pole) in [("pole", graph.pole), ("end-pole", graph.end_pole)] {
            if let Some(at) = pole {
                self.tags.tag(name).real("x", at.x).real("y", at.y).real("z", at.z).empty()?;
            }
        }
        for (id, node) in graph.nodes.iter().enumerate() {
            let at = node.position;
            let tag = self.tags.tag("node").count("id", id as u32).real("x", at.x).real("y", at.y);
            tag.real("z", at.z).real("u", node.u).real("tau", node.tau).real("v", node.v).empty()?;
        }
        for tile in &graph.tiles {
            if let Some(stitch) = tile.stitch {
                self.tags.tag("stitch");
                self.stitch(stitch);
                if tile.direction == Direction::Back {
                    self.tags.text("direction", tile.direction.word());
                }
            } else {
                self.tags.tag("turn").text("direction", tile.direction.word());
            }
            self.tags.list("base", &tile.base).list("top", &tile.top).empty()?;
        }
        self.tags.close("graph")
    }
}

fn name(program: &Program, part: PartId) -> &str {
    program.pattern.parts.get(part.0 as usize).map_or("", |part| &part.name)
}

fn yarn_id(color: usize) -> String {
    format!("y{}", color + 1)
}
