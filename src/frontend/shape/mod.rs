//! Shape files: TOML with a gauge, a control curve and sections along it, read into a swept tube.
//!
//! The keys are described in `grammar/shape.md`. Lengths are converted to mm here, once. Several faults of a file are
//! reported in one run, in the order of the file, each on the key or the value that is at fault.

mod branch;
mod curve;
mod fit;
mod gauge;
mod maker;
mod mesh;
mod pair;
mod section;
mod tube;
mod walk;

use super::unit::Unit;
use super::{Input, Reader};
use crate::diag::{Code, Diagnostic, Sink, Source, Sources};
use crate::ir::Gauge;
use crate::shape::{Shape, Wishes};
use std::ops::Range;
use toml::Spanned;
use toml::de::DeTable;
use walk::{Value, Walk, misspelled, quote};

/// The reader of shape files.
pub(crate) const READER: Reader = Reader {
    name: "shape",
    extensions: &["toml"],
    about: "shape files: a control curve with sections along it, and a gauge",
    read,
};

/// Faults of the TOML itself that are looked at.
const MOST_SYNTAX_ERRORS: usize = 32;
/// Most characters of a name.
const LONGEST_NAME: usize = 200;

/// What a shape file describes.
enum Document {
    Shape(Shape),
    Mesh(mesh::Request, Wishes),
}

fn read(source: &Source, sources: &mut Sources<'_>, sink: &mut Sink<'_>) -> Option<Input> {
    read_at(source, None, sources, sink)
}

/// Reads a shape file; `gauge` takes the place of its own: where branches and meshes are cut depends on it.
pub(crate) fn read_at(
    source: &Source,
    gauge: Option<Gauge>,
    sources: &mut Sources<'_>,
    sink: &mut Sink<'_>,
) -> Option<Input> {
    let mut walk = Walk::new(source);
    let document = parse(source, gauge, &mut walk);
    let errors = sink.errors();
    walk.finish().into_iter().for_each(|diagnostic| sink.push(diagnostic));
    let shape = match document.filter(|_| sink.errors() == errors)? {
        Document::Shape(shape) => shape,
        Document::Mesh(request, wishes) => Shape { wishes, ..request.fulfill(source, sources, sink)? },
    };
    Some(Input::Shape(Box::new(shape)))
}

fn parse(source: &Source, gauge: Option<Gauge>, walk: &mut Walk<'_>) -> Option<Document> {
    let text = match source.text() {
        Ok(text) => text,
        Err(offset) => {
            let byte = source.bytes().get(offset).copied().unwrap_or_default();
            let span = walk.span(offset..offset + 1);
            let message = format!("the file is not UTF-8: byte 0x{byte:02X}");
            walk.fault(Code::NotUtf8, span, message, "", "save it as UTF-8 text");
            return None;
        }
    };
    let (document, errors) = DeTable::parse_recoverable(text);
    if errors.is_empty() {
        return document_of(walk, &document, gauge, source.name());
    }
    // What follows on a line that is broken already says nothing new.
    let line = |at: usize| text.bytes().take(at).filter(|byte| *byte == b'\n').count();
    let mut lines = Vec::new();
    for error in errors.iter().take(MOST_SYNTAX_ERRORS) {
        let range = error.span().unwrap_or_default();
        let line = line(range.start);
        if !lines.contains(&line) {
            lines.push(line);
            if !syntax(walk, text, error.message(), range) {
                break;
            }
        }
    }
    None
}

/// Reports a fault of the TOML itself; true when what comes after it may be worth a word.
fn syntax(walk: &mut Walk<'_>, text: &str, message: &str, range: Range<usize>) -> bool {
    let span = walk.span(range.clone());
    let mut lines = message.lines().map(str::trim).filter(|line| !line.is_empty());
    let first = lines.next().unwrap_or("unreadable");
    if !first.starts_with("duplicate key") {
        let rest: Vec<&str> = lines.collect();
        walk.fault(Code::TomlSyntax, span, format!("not TOML: {first}"), &rest.join(", "), "");
        return true;
    }
    let key = text.get(range.clone()).unwrap_or_default();
    let mut diagnostic = Diagnostic::new(Code::DuplicateKey, format!("`{}` is given twice", quote(key)));
    diagnostic = diagnostic.at(span, "given again here");
    if let Some(before) = first_of(text, key, range.start) {
        diagnostic = diagnostic.at(walk.span(before), "given here");
    }
    walk.report(diagnostic.help("keep one of the two"));
    // All keys of a table that stands twice would follow.
    false
}

/// Where the key or the table header that stands again at `again` stands for the first time.
fn first_of(text: &str, key: &str, again: usize) -> Option<Range<usize>> {
    let before = text.get(..again)?;
    let header = before.trim_end_matches([' ', '\t']).ends_with('[');
    // A key is given twice within its table, a table within the file.
    let start = if header { 0 } else { before.rfind("\n[").unwrap_or(0) };
    let mut at = start;
    for line in before.get(start..)?.split_inclusive('\n') {
        let name = line.trim_start();
        let name = if header { name.strip_prefix('[').map(str::trim_start) } else { Some(name) };
        let rest = name.and_then(|name| name.strip_prefix(key)).map(str::trim_start);
        if rest.is_some_and(|rest| rest.starts_with(if header { ']' } else { '=' })) {
            let begin = at + line.find(key)?;
            return Some(begin..begin + key.len());
        }
        at += line.len();
    }
    None
}

fn document_of(
    walk: &mut Walk<'_>,
    document: &Spanned<DeTable<'_>>,
    chosen: Option<Gauge>,
    file: &str,
) -> Option<Document> {
    let top = document.get_ref();
    let home = walk.span(0..0);
    walk.known(top, "a shape file", &["name", "unit", "gauge", "maker", "trunk", "branch", "mesh"]);
    if let Some((_, value)) = walk.get(top, "unit") {
        walk.unit = walk.word(value, "unit", Unit::WORDS)?;
    } else {
        let note = Diagnostic::new(Code::UnitAssumed, "the file names no unit, lengths are taken as mm");
        walk.report(note.at(home, "").help("add `unit = \"mm\"`, \"cm\" or \"in\" at the top"));
    }
    let name = name(walk, top, file);
    let gauge = gauge::read(walk, top, home).map(|(own, span)| (chosen.unwrap_or(own), span));
    let wishes = maker::read(walk, top);
    if let Some((place, value)) = walk.get(top, "mesh") {
        let request = mesh::read(walk, top, value, place);
        let (request, name, (gauge, _), wishes) = (request?, name?, gauge?, wishes?);
        return Some(Document::Mesh(request.of(name, gauge), wishes));
    }
    let trunk = if let Some((place, value)) = walk.get(top, "trunk") {
        tube::read(walk, value, place, "trunk")
    } else {
        if !misspelled(top, "trunk") {
            let message = "the file has no `trunk`".to_owned();
            let help = "add\n[trunk]\ncurve = [[0, 0, 0], [0, 0, 10]]\nsection = [{ at = 0, circle = 2 }]";
            walk.fault(Code::MissingKey, home, message, "", help);
        }
        None
    };
    let limbs = branch::read(walk, top);
    let (trunk, name, gauge, wishes) = (trunk?, name?, gauge?, wishes?);
    let tubes = branch::grow(walk, trunk, limbs?, (&gauge.0, gauge.1))?;
    Some(Document::Shape(Shape { name, gauge: gauge.0, tubes, wishes }))
}

/// The name of the object: the file's own name where none is given.
fn name(walk: &mut Walk<'_>, top: &DeTable<'_>, file: &str) -> Option<String> {
    let Some((_, value)) = walk.get(top, "name") else {
        let last = file.rsplit(['/', '\\']).next().unwrap_or(file);
        return Some(last.strip_suffix(".toml").unwrap_or(last).to_owned());
    };
    line(walk, value)
}

/// A name: one line of text.
fn line(walk: &mut Walk<'_>, value: &Value<'_>) -> Option<String> {
    let text = walk.text(value, "name", "a text")?;
    let fault = if text.trim().is_empty() {
        "the name is empty"
    } else if text.chars().any(char::is_control) {
        "the name has line breaks or control characters"
    } else if text.chars().count() > LONGEST_NAME {
        "the name is longer than 200 characters"
    } else {
        return Some(text.to_owned());
    };
    let span = walk.of(value);
    walk.fault(Code::BadName, span, fault.to_owned(), "", "a name is one line of text");
    None
}

/// A number for a message: up to three decimals, no trailing zeros.
fn short(number: f64) -> String {
    let text = format!("{number:.3}");
    match text.split_once('.') {
        Some(_) => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        None => text,
    }
}
