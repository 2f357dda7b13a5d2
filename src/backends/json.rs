//! The whole program as JSON, schema `picot.program/1`, for scripts.

use super::crochet::words::Words;
use super::crochet::{Arrows, Language, Terms};
use super::{Backend, Error, Format};
use crate::diag::Sink;
use crate::ir::verify::{PartFacts, RowFacts, Verified};
use crate::ir::yarn::SPARE;
use crate::ir::{
    Block, Direction, Entry, Finish, Graph, Kind, Maker, NodeId, Part, PartId, Program, Row, Segment, Start,
    Step, Stitch,
};
use serde::Deserialize;
use std::io::{self, Write};

/// Options of the target `json`: none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Json {}

impl Backend for Json {
    fn emit(&self, program: &Verified<'_>, out: &mut dyn Write, _: &mut Sink<'_>) -> Result<(), Error> {
        let mut out = io::BufWriter::with_capacity(1 << 16, out);
        document(program, &mut out)?;
        out.flush()?;
        Ok(())
    }
}

impl Format for Json {
    const NAME: &'static str = "json";
    const EXTENSION: &'static str = "json";
    const ABOUT: &'static str =
        "everything about the pattern, with the stitch graph, for scripts (picot.program/1)";
}

fn document(program: &Verified<'_>, out: &mut impl Write) -> io::Result<()> {
    write!(
        out,
        "{{\n\"schema\": \"picot.program/1\",\n\"name\": {},\n\"unit\": \"mm\",\n",
        quoted(&program.name)
    )?;
    match &program.gauge {
        None => out.write_all(b"\"gauge\": null,\n")?,
        Some(gauge) => {
            let (width, height) = (Number(gauge.width), Number(gauge.height));
            writeln!(
                out,
                "\"gauge\": {{\"width\": {width}, \"height\": {height}, \"estimated\": {}}},",
                gauge.estimated()
            )?;
            let yarn = Number(program.facts().yarn(program, gauge.width));
            writeln!(out, "\"yarn\": {{\"length\": {yarn}, \"spare\": {SPARE}, \"estimated\": true}},")?;
        }
    }
    if !program.maker.is_usual() {
        let Maker { hand, lean } = program.maker;
        writeln!(out, "\"maker\": {{\"hand\": \"{}\", \"lean\": {}}},", hand.word(), Fraction(lean))?;
    }
    writeln!(out, "\"colors\": {},", List(program.colors.iter().map(|color| quoted(color))))?;
    writeln!(out, "\"stitches\": {},", program.facts().stitches(program))?;
    out.write_all(b"\"parts\": [")?;
    for (index, (part, facts)) in program.pattern.parts.iter().zip(&program.facts().parts).enumerate() {
        out.write_all(if index == 0 { b"\n" } else { b",\n" })?;
        write_part(program, part, facts, program.graphs.get(index), out)?;
    }
    out.write_all(b"\n],\n\"joins\": [")?;
    joins(program, out)?;
    out.write_all(b"]\n}\n")
}

fn write_part(
    program: &Verified<'_>,
    part: &Part,
    facts: &PartFacts,
    graph: Option<&Graph>,
    out: &mut impl Write,
) -> io::Result<()> {
    let start = match part.start {
        Start::Chain { .. } => "chain",
        Start::Ring { .. } => "ring",
        Start::Join { .. } => "pickup",
    };
    let finish = match part.finish {
        Finish::Open => "open",
        Finish::DrawnShut => "closed",
    };
    writeln!(
        out,
        "{{\"name\": {}, \"copies\": {}, \"flat\": {},",
        quoted(&part.name),
        part.copies,
        part.flat
    )?;
    writeln!(out, "\"start\": {{\"kind\": \"{start}\", \"loops\": {}}},", facts.start)?;
    writeln!(out, "\"finish\": {{\"kind\": \"{finish}\", \"loops\": {}}},", facts.open)?;
    out.write_all(b"\"rounds\": [")?;
    let words = Words::new(program, part, Terms::Us, Language::English, Arrows::Unicode);
    let mut first = true;
    for (place, (row, counts)) in part.rows.iter().zip(&facts.rows).enumerate() {
        let begins = place == 0 && matches!(part.start, Start::Ring { loops: 0 });
        let body = round_body(program, row, counts, &words, begins);
        for round in 0..row.times {
            let comma = if std::mem::take(&mut first) { "" } else { "," };
            write!(out, "{comma}\n{{\"number\": {}, {body}}}", counts.number.saturating_add(round))?;
        }
    }
    out.write_all(b"\n]")?;
    if let Some(graph) = graph {
        out.write_all(b",\n\"graph\": {\n\"nodes\": [")?;
        nodes(graph, out)?;
        out.write_all(b"\n],\n\"edges\": [")?;
        edges(graph, out)?;
        out.write_all(b"\n],\n\"stitches\": [")?;
        stitches(part, facts, graph, out)?;
        out.write_all(b"\n]}")?;
    }
    out.write_all(b"}")
}

/// All of a round but its number, which folded rounds share.
fn round_body(program: &Program, row: &Row, counts: &RowFacts, words: &Words<'_>, begins: bool) -> String {
    let mut body = format!(
        "\"consumes\": {}, \"produces\": {}, \"text\": {}, \"steps\": [",
        counts.consumes,
        counts.produces,
        quoted(&words.row(&row.body, begins))
    );
    use std::fmt::Write as _;
    let mut first = true;
    runs(&row.body, |step, times| {
        body.push_str(if std::mem::take(&mut first) { "{" } else { ", {" });
        // Writing to a string does not fail.
        let _ = match step {
            Step::Work(stitch) => write!(body, "{}, \"times\": {times}}}", Operation(stitch)),
            Step::Turn(direction) => {
                write!(body, "\"op\": \"turn\", \"direction\": \"{}\"}}", word(direction))
            }
            Step::Hold { loops, by } => {
                write!(body, "\"op\": \"hold\", \"loops\": {loops}, \"part\": {}}}", part_name(program, by))
            }
            Step::Leave { loops } => write!(body, "\"op\": \"leave\", \"loops\": {loops}}}"),
            Step::Color(color) => {
                let name = program.colors.get(usize::from(color)).map_or("", String::as_str);
                write!(body, "\"op\": \"color\", \"color\": {}}}", quoted(name))
            }
        };
    });
    body.push(']');
    body
}

/// Steps with equal stitches counted.
fn runs(block: &Block, mut tell: impl FnMut(Step, u32)) {
    let mut run: Option<(Step, u32)> = None;
    for step in block.steps() {
        match &mut run {
            Some((same, times)) if *same == step && matches!(step, Step::Work(_)) => *times += 1,
            _ => {
                if let Some((step, times)) = run.replace((step, 1)) {
                    tell(step, times);
                }
            }
        }
    }
    if let Some((step, times)) = run {
        tell(step, times);
    }
}

fn nodes(graph: &Graph, out: &mut impl Write) -> io::Result<()> {
    for (id, node) in graph.nodes.iter().enumerate() {
        let comma = if id == 0 { "" } else { "," };
        let [x, y, z] = node.position.to_array().map(Number);
        let [tau, u, v] = [node.tau, node.u, node.v].map(Fraction);
        write!(
            out,
            "{comma}\n{{\"id\": {id}, \"position\": [{x}, {y}, {z}], \"tau\": {tau}, \"u\": {u}, \"v\": {v}}}"
        )?;
    }
    Ok(())
}

fn edges(graph: &Graph, out: &mut impl Write) -> io::Result<()> {
    let mut comma = "";
    let mut write = |pair: (NodeId, NodeId), kind: &str| {
        write!(out, "{comma}\n{{\"from\": {}, \"to\": {}, \"kind\": \"{kind}\"}}", pair.0, pair.1)?;
        comma = ",";
        io::Result::Ok(())
    };
    graph.courses().try_for_each(|pair| write(pair, "course"))?;
    graph.wales().try_for_each(|pair| write(pair, "wale"))?;
    graph.turns().try_for_each(|pair| write(pair, "turn"))
}

fn stitches(part: &Part, facts: &PartFacts, graph: &Graph, out: &mut impl Write) -> io::Result<()> {
    let mut tiles = graph.tiles.iter();
    let mut comma = "";
    for (row, counts) in part.rows.iter().zip(&facts.rows) {
        for done in 0..row.times {
            let round = counts.number.saturating_add(done);
            for tile in tiles.by_ref().take(counts.tiles as usize) {
                write!(out, "{comma}\n{{")?;
                comma = ",";
                match tile.stitch {
                    Some(stitch) => write!(out, "{}", Operation(stitch))?,
                    None => out.write_all(b"\"op\": \"turn\"")?,
                }
                let (base, top) = (List(tile.base.iter()), List(tile.top.iter()));
                let direction = word(tile.direction);
                write!(
                    out,
                    ", \"round\": {round}, \"direction\": \"{direction}\", \"base\": {base}, \"top\": {top}}}"
                )?;
            }
        }
    }
    Ok(())
}

/// Which parts begin on loops of which, a stretch at a time. Pairs name a node of the part and one of the part that it
/// grows from, and are known where there are graphs.
fn joins(program: &Program, out: &mut impl Write) -> io::Result<()> {
    let mut comma = "";
    let pairs = crate::ir::joins::pairs(program);
    for (index, part) in program.pattern.parts.iter().enumerate() {
        let Start::Join { segments } = &part.start else { continue };
        let pairs = pairs.get(&PartId(index as u32)).map_or(&[][..], Vec::as_slice);
        let mut node = 0;
        for segment in segments {
            let first = node;
            node += segment.loops();
            let (to, kind) = match segment {
                Segment::Open { part, .. } => (part, "open"),
                Segment::Held { part, .. } => (part, "held"),
                Segment::Surface { part, .. } => (part, "surface"),
                Segment::Chain { .. } => continue,
            };
            let own = pairs.iter().filter(|pair| (first..node).contains(&pair.node));
            write!(
                out,
                "{comma}\n{{\"part\": {}, \"to\": {}, \"kind\": \"{kind}\", \"loops\": {}, \"pairs\": {}}}",
                quoted(&part.name),
                part_name(program, *to),
                segment.loops(),
                List(own.map(|pair| format!("[{}, {}]", pair.node, pair.base)))
            )?;
            comma = ",";
        }
    }
    Ok(())
}

fn word(direction: Direction) -> &'static str {
    match direction {
        Direction::Forward => "forward",
        Direction::Back => "back",
    }
}

fn part_name(program: &Program, part: PartId) -> String {
    quoted(program.pattern.parts.get(part.0 as usize).map_or("", |part| part.name.as_str()))
}

fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

/// `"op": "inc"`; other stitches by their US abbreviation, with what they work and make.
struct Operation(Stitch);

impl std::fmt::Display for Operation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Stitch { kind, works, makes, entry } = self.0;
        let plain = entry == Entry::Both && kind == Kind::Sc;
        match (works, makes) {
            (1, 1) if plain => return f.write_str("\"op\": \"sc\""),
            (1, 2) if plain => return f.write_str("\"op\": \"inc\""),
            (2, 1) if plain => return f.write_str("\"op\": \"dec\""),
            _ => write!(f, "\"op\": \"{}\", \"works\": {works}, \"makes\": {makes}", kind.us())?,
        }
        match entry {
            Entry::Both => Ok(()),
            Entry::Front => f.write_str(", \"loop\": \"front\""),
            Entry::Back => f.write_str(", \"loop\": \"back\""),
            Entry::Space => f.write_str(", \"loop\": \"space\""),
        }
    }
}

/// A length in mm, rounded to a tenth of a micrometer.
struct Number(f64);

impl std::fmt::Display for Number {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        decimals(f, self.0, 1e4, 4)
    }
}

/// A coordinate on the surface, rounded to a millionth.
struct Fraction(f64);

impl std::fmt::Display for Fraction {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        decimals(f, self.0, 1e6, 6)
    }
}

/// Rounded to so many decimals, zeros at the end left off; never `-0`.
fn decimals(f: &mut std::fmt::Formatter<'_>, value: f64, scale: f64, digits: usize) -> std::fmt::Result {
    let scaled = (value * scale).round();
    if scaled.abs() >= 9e15 {
        return write!(f, "{value:e}");
    }
    let (sign, scaled) = (if scaled < 0.0 { "-" } else { "" }, scaled.abs() as u64);
    let (whole, rest) = (scaled / scale as u64, scaled % scale as u64);
    if rest == 0 {
        return write!(f, "{sign}{whole}.0");
    }
    let (mut rest, mut digits) = (rest, digits);
    while rest % 10 == 0 {
        (rest, digits) = (rest / 10, digits - 1);
    }
    write!(f, "{sign}{whole}.{rest:0digits$}")
}

/// Items in brackets.
struct List<I>(I);

impl<I: Iterator<Item: std::fmt::Display> + Clone> std::fmt::Display for List<I> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("[")?;
        for (index, item) in self.0.clone().enumerate() {
            write!(f, "{}{item}", if index == 0 { "" } else { ", " })?;
        }
        f.write_str("]")
    }
}
