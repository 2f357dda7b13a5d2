//! Reads Picot XML back into a program: strict, with a place for every fault, and nothing allocated by a number that
//! the file only claims.
//!
//! The form is described in `grammar/xml.md`. Whether the pattern can be worked is for the verifier to say.

mod cursor;
mod graph;
mod part;
mod values;

use super::{Input, Reader};
use crate::diag::{Code, Sink, Source, Sources, Span, did_you_mean};
use crate::ir::exchange::{MAJOR, MINOR, NAMESPACE, Words};
use crate::ir::maker::MOST_LEAN;
use crate::ir::yarn::Hook;
use crate::ir::{
    Block, Gauge, GaugeOrigin, Graph, Hand, Maker, Op, Part, PartId, Pattern, Program, Segment, Start,
};
use cursor::{Cursor, Element, Next, Stop};
use std::borrow::Cow;
use std::collections::BTreeMap;
use values::{Children, Model, quoted};

/// Reads `*.xml`.
pub const READER: Reader =
    Reader { name: "xml", extensions: &["xml"], about: "Picot XML: a whole program", read };

fn read(source: &Source, _sources: &mut Sources<'_>, sink: &mut Sink<'_>) -> Option<Input> {
    let mut document = Document {
        cursor: Cursor::new(source, sink).ok()?,
        words: Words::new(),
        yarns: BTreeMap::new(),
        parts: Parts::default(),
        steps: 0,
    };
    let program = document.read().ok()?;
    document.cursor.clean().then(|| Input::Program(Box::new(program)))
}

/// A file under way.
struct Document<'t, 's, 'o> {
    cursor: Cursor<'t, 's, 'o>,
    words: Words,
    /// Ids of the colors.
    yarns: BTreeMap<Cow<'t, str>, u16>,
    parts: Parts<'t>,
    /// Steps of all rounds so far.
    steps: u64,
}

/// Parts by name. A part may be spoken of before it is read, so ids are given by first mention and put right at the end.
#[derive(Default)]
struct Parts<'t> {
    ids: BTreeMap<Cow<'t, str>, u32>,
    mentions: Vec<Mention>,
}

struct Mention {
    span: Span,
    /// Index of the part, once read.
    index: Option<u32>,
    /// Its rounds count the magic ring as 0, one less than ours.
    shifted: bool,
}

impl<'t> Parts<'t> {
    fn mention(&mut self, name: Cow<'t, str>, span: Span) -> PartId {
        let next = self.mentions.len() as u32;
        let id = *self.ids.entry(name).or_insert(next);
        if id == next {
            self.mentions.push(Mention { span, index: None, shifted: false });
        }
        PartId(id)
    }
}

static PROGRAM: Model = Model { names: &["gauge", "yarn", "part"], once: &["gauge"], ordered: 3 };

impl<'t> Document<'t, '_, '_> {
    fn read(&mut self) -> Result<Program, Stop> {
        let Next::Open(root) = self.cursor.next()? else { return Err(Stop) };
        self.version(root)?;
        self.cursor.only(root, &["version", "name", "unit", "hand", "lean"])?;
        let name = self.cursor.text_of(root, "name")?.0.into_owned();
        self.cursor.word_of(root, "unit", &[("mm", ())])?;
        let mut maker =
            Maker { hand: self.cursor.word("hand", Hand::WORDS)?.unwrap_or_default(), ..Maker::default() };
        if let Some(attribute) = self.cursor.get("lean") {
            maker.lean = self.cursor.real_of(root, "lean")?;
            if maker.lean.abs() > MOST_LEAN {
                let (message, span) =
                    (format!("`lean` is {}", maker.lean), self.cursor.value_span(attribute));
                self.cursor.at(
                    Code::XmlValue,
                    message,
                    span,
                    "stitches lean by at most one stitch a round",
                )?;
            }
        }
        let (mut gauge, mut colors) = (None, Vec::new());
        let (mut parts, mut graphs) = (Vec::new(), Vec::new());
        let mut children = Children::of(root, &PROGRAM);
        while let Some(child) = self.cursor.child(&mut children)? {
            match child.name {
                "gauge" => gauge = self.gauge(child)?,
                "yarn" => colors.push(self.yarn(child, colors.len())?),
                _ => {
                    let (part, graph) = self.part(child, parts.len() as u32)?;
                    parts.push(part);
                    graphs.push((child, graph));
                }
            }
        }
        if parts.is_empty() {
            self.cursor.at(
                Code::XmlMissing,
                "<program> has no <part>",
                root.span,
                "a program has at least one part",
            )?;
        }
        while !matches!(self.cursor.next()?, Next::End) {}
        self.resolve(&mut parts)?;
        let graphs = self.all_or_none(graphs)?;
        Ok(Program { name, gauge, maker, colors, pattern: Pattern { parts }, graphs })
    }

    /// Looks at the root element: is it ours, and of a version that we know?
    fn version(&mut self, root: Element<'t>) -> Result<(), Stop> {
        let namespace = std::mem::take(&mut self.cursor.namespace);
        let stem = NAMESPACE.trim_end_matches(|c: char| c.is_ascii_digit());
        if namespace != NAMESPACE && namespace.starts_with(stem) {
            let message = format!("namespace {} is another version of Picot XML", quoted(&namespace));
            let help = format!("this Picot reads {NAMESPACE}");
            self.cursor.at(Code::XmlVersion, message, root.span, help)?;
            return Err(Stop);
        }
        if !root.ours || root.name != "program" {
            let message = match (root.name, namespace.as_str()) {
                ("program", "") => "<program> names no namespace".to_owned(),
                ("program", _) => format!("<program> is in the namespace {}", quoted(&namespace)),
                (name, _) => format!("<{name}> is not the root of a Picot XML file"),
            };
            let help = format!(
                "a Picot XML file begins with <program xmlns=\"{NAMESPACE}\" version=\"{MAJOR}.{MINOR}\" ..>"
            );
            self.cursor.at(Code::XmlNamespace, message, root.span, help)?;
            return Err(Stop);
        }
        let (version, span) = self.cursor.text_of(root, "version")?;
        if span.is_none() {
            return Ok(());
        }
        let number =
            |text: &str| text.bytes().all(|b| b.is_ascii_digit()).then(|| text.parse::<u32>().ok()).flatten();
        let help = format!("this Picot reads version {MAJOR}.{MINOR}");
        match version.split_once('.').map(|(major, minor)| (number(major), number(minor))) {
            Some((Some(MAJOR), Some(minor))) => {
                if minor > MINOR {
                    self.cursor.newer = true;
                    let message = format!("version {version} is newer than {MAJOR}.{MINOR}");
                    self.cursor.at(
                        Code::XmlNewer,
                        message,
                        span,
                        "unknown names are ignored, each with a warning",
                    )?;
                }
                Ok(())
            }
            Some((Some(_), Some(_))) => {
                self.cursor.at(
                    Code::XmlVersion,
                    format!("version {} is unknown", quoted(&version)),
                    span,
                    help,
                )?;
                Err(Stop)
            }
            _ => self.cursor.at(Code::XmlVersion, format!("{} is no version", quoted(&version)), span, help),
        }
    }

    fn gauge(&mut self, element: Element<'t>) -> Result<Option<Gauge>, Stop> {
        self.cursor.only(element, &["width", "height", "origin", "weight", "hook", "usual"])?;
        let mut sizes = [1.0; 2];
        for (size, name) in sizes.iter_mut().zip(["width", "height"]) {
            *size = self.cursor.real_of(element, name)?;
            if *size <= 0.0 {
                let span =
                    self.cursor.get(name).map_or(element.span, |attribute| self.cursor.value_span(attribute));
                self.cursor.at(
                    Code::XmlValue,
                    format!("`{name}` is {size}"),
                    span,
                    "a stitch is larger than 0 mm",
                )?;
            }
        }
        let estimated =
            Hook::from_mm(1.0).map(|hook| GaugeOrigin::Estimated { weight: 0, hook, in_range: true });
        let origins = [
            ("given", GaugeOrigin::Given),
            ("swatch", GaugeOrigin::Swatch),
            ("estimated", estimated.unwrap_or(GaugeOrigin::Given)),
        ];
        let mut origin = self.cursor.word("origin", &origins)?.unwrap_or(GaugeOrigin::Given);
        if let GaugeOrigin::Estimated { weight, hook, in_range } = &mut origin {
            *weight = self.cursor.count_of(element, "weight", 0..=7)? as u8;
            *in_range = self.cursor.flag("usual", true)?;
            let mm = self.cursor.real_of(element, "hook")?;
            if let Some(known) = Hook::from_mm(mm) {
                *hook = known;
            } else {
                let span = self.cursor.get("hook").map_or(element.span, |at| self.cursor.value_span(at));
                self.cursor.at(Code::XmlValue, format!("`hook` is {mm}"), span, "a hook has 0.4 to 60 mm")?;
            }
        } else {
            for name in ["weight", "hook", "usual"] {
                if let Some(attribute) = self.cursor.get(name) {
                    let message = format!("`{name}` on a gauge that is no estimate");
                    let span = self.cursor.name_span(attribute);
                    self.cursor.at(Code::XmlAttribute, message, span, "it goes with origin=\"estimated\"")?;
                }
            }
        }
        self.cursor.leaf(element)?;
        Ok(Some(Gauge { width: sizes[0], height: sizes[1], origin }))
    }

    fn yarn(&mut self, element: Element<'t>, index: usize) -> Result<String, Stop> {
        self.cursor.only(element, &["id", "name"])?;
        let (id, span) = self.cursor.text_of(element, "id")?;
        let name = self.cursor.text_of(element, "name")?.0.into_owned();
        let Ok(index) = u16::try_from(index) else {
            let message = format!("more than {} yarns", u32::from(u16::MAX) + 1);
            self.cursor.at(Code::XmlTooLarge, message, element.span, "use fewer colors")?;
            return Err(Stop);
        };
        if !span.is_none() && self.yarns.contains_key(&id) {
            let message = format!("a second yarn has the id {}", quoted(&id));
            self.cursor.at(Code::XmlDuplicate, message, span, "give each yarn an id of its own")?;
        }
        self.yarns.insert(id, index);
        self.cursor.leaf(element)?;
        Ok(name)
    }

    /// Turns ids by mention into indices of parts.
    fn resolve(&mut self, parts: &mut [Part]) -> Result<(), Stop> {
        for (name, &id) in &self.parts.ids {
            let Some(mention) = self.parts.mentions.get(id as usize) else { continue };
            if mention.index.is_none() {
                let known = parts.iter().map(|part| part.name.as_str());
                let help = match did_you_mean(name, known) {
                    Some(name) => format!("did you mean {}?", quoted(name)),
                    None => "name a part of this file".to_owned(),
                };
                let message = format!("there is no part {}", quoted(name));
                self.cursor.at(Code::XmlReference, message, mention.span, help)?;
            }
        }
        let mentions = &self.parts.mentions;
        let index = |id: PartId| PartId(mentions.get(id.0 as usize).and_then(|m| m.index).unwrap_or(0));
        let shifted = |id: PartId| mentions.get(id.0 as usize).is_some_and(|mention| mention.shifted);
        let sorted = mentions.iter().enumerate().all(|(id, mention)| mention.index == Some(id as u32));
        for part in parts {
            if let Start::Join { segments } = &mut part.start {
                for segment in segments {
                    match segment {
                        Segment::Open { part, .. } | Segment::Held { part, .. } => *part = index(*part),
                        Segment::Surface { part, round, .. } => {
                            *round += u32::from(shifted(*part));
                            *part = index(*part);
                        }
                        Segment::Chain { .. } => {}
                    }
                }
            }
            for row in part.rows.iter_mut().filter(|_| !sorted) {
                if holds(&row.body) {
                    row.body = renamed(&row.body, &index);
                }
            }
        }
        Ok(())
    }

    fn all_or_none(&mut self, graphs: Vec<(Element<'t>, Option<Graph>)>) -> Result<Vec<Graph>, Stop> {
        if graphs.iter().all(|(_, graph)| graph.is_none()) {
            return Ok(Vec::new());
        }
        let mut all = Vec::new();
        for (element, graph) in graphs {
            if let Some(graph) = graph {
                all.push(graph);
            } else {
                let message = "this part has no <graph>, another has one";
                self.cursor.at(
                    Code::XmlMissing,
                    message,
                    element.span,
                    "either every part has a graph, or none",
                )?;
            }
        }
        Ok(all)
    }
}

fn holds(block: &Block) -> bool {
    block.ops().iter().any(|op| match op {
        Op::Hold { .. } => true,
        Op::Repeat { body, .. } => holds(body),
        Op::Work { .. } | Op::Turn(_) | Op::Leave { .. } | Op::Color(_) => false,
    })
}

fn renamed(block: &Block, index: &impl Fn(PartId) -> PartId) -> Block {
    let mut out = Block::default();
    for (op, span) in block.spanned() {
        let op = match op {
            Op::Hold { loops, by } => Op::Hold { loops: *loops, by: index(*by) },
            Op::Repeat { body, times } => Op::repeat(renamed(body, index), *times),
            Op::Work { .. } | Op::Turn(_) | Op::Leave { .. } | Op::Color(_) => op.clone(),
        };
        out.push(op, span);
    }
    out
}
