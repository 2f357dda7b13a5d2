//! From bytes to elements: what XML itself demands, and what Picot refuses of it (DOCTYPE, instructions, entities, text).

use crate::diag::{Code, Diagnostic, Sink, Source, Span};
use crate::ir::MAX_NESTING;
use crate::ir::exchange::NAMESPACE;
use quick_xml::XmlVersion;
use quick_xml::errors::{Error, IllFormedError};
use quick_xml::escape::EscapeError;
use quick_xml::events::attributes::AttrError;
use quick_xml::events::{BytesDecl, BytesStart, Event};
use quick_xml::name::{Namespace, ResolveResult};
use quick_xml::reader::NsReader;
use std::borrow::Cow;
use std::ops::Range;

/// Deepest nesting of elements: program, part, round, repeats, step.
const MAX_DEPTH: usize = MAX_NESTING as usize + 8;
/// Most attributes of one element.
const MAX_ATTRIBUTES: usize = 32;
/// After so many faults the rest of the file is not read.
const MAX_FAULTS: usize = 50;
const SCHEMA_INSTANCE: &str = "http://www.w3.org/2001/XMLSchema-instance";

/// A fault after which reading makes no sense; it is already in the sink.
pub(super) struct Stop;

/// An opened element; its attributes stand in [`Cursor::attributes`] until the next one is read.
#[derive(Clone, Copy)]
pub(super) struct Element<'t> {
    /// Name without prefix.
    pub(super) name: &'t str,
    /// The start tag.
    pub(super) span: Span,
    /// Belongs to the namespace of Picot.
    pub(super) ours: bool,
}

/// One attribute as written.
#[derive(Clone, Copy)]
pub(super) struct Attribute<'t> {
    /// Name with prefix.
    pub(super) name: &'t str,
    raw: &'t str,
    /// Offset of the raw value in the text.
    at: usize,
    name_at: usize,
}

/// What comes next.
pub(super) enum Next<'t> {
    /// An element begins.
    Open(Element<'t>),
    /// The innermost element ends.
    Close,
    /// The document ends.
    End,
}

/// Walks over the elements of a document.
pub(super) struct Cursor<'t, 's, 'o> {
    reader: NsReader<&'t [u8]>,
    text: &'t str,
    /// Length of the byte order mark before the text.
    mark: usize,
    source: &'t Source,
    sink: &'s mut Sink<'o>,
    open: Vec<Element<'t>>,
    attributes: Vec<Attribute<'t>>,
    rooted: bool,
    /// Namespace of the root element; empty when it has none.
    pub(super) namespace: String,
    faults: usize,
    /// A newer minor version wrote the file: unknown names are no faults.
    pub(super) newer: bool,
    /// Warnings about such names so far.
    pub(super) warned: u32,
    /// Part and round under way, for the diagnostics.
    pub(super) place: Option<(String, Option<u32>)>,
}

impl<'t, 's, 'o> Cursor<'t, 's, 'o> {
    /// Starts at the top of a file.
    pub(super) fn new(source: &'t Source, sink: &'s mut Sink<'o>) -> Result<Self, Stop> {
        let text = match source.text() {
            Ok(text) => text,
            Err(at) => {
                let fault = Diagnostic::new(Code::XmlEncoding, format!("byte {at} is no UTF-8"));
                sink.push(fault.at(source.span(at..at + 1), "").help("save the file as UTF-8"));
                return Err(Stop);
            }
        };
        let body = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut reader = NsReader::from_str(body);
        let config = reader.config_mut();
        config.enable_all_checks(true);
        config.expand_empty_elements = true;
        let mut cursor = Self {
            reader,
            text: body,
            mark: text.len() - body.len(),
            source,
            sink,
            open: Vec::new(),
            attributes: Vec::new(),
            rooted: false,
            namespace: String::new(),
            faults: 0,
            newer: false,
            warned: 0,
            place: None,
        };
        if let Some((at, c)) = body.char_indices().find(|&(_, c)| !is_xml_char(c)) {
            let message = format!("U+{:04X} is no character of XML", u32::from(c));
            cursor.fault(Code::XmlSyntax, message, at..at + c.len_utf8(), "remove it")?;
            return Err(Stop);
        }
        Ok(cursor)
    }

    /// True when nothing was found so far.
    pub(super) fn clean(&self) -> bool {
        self.faults == 0
    }

    /// The attributes of the element opened last.
    pub(super) fn attributes(&self) -> &[Attribute<'t>] {
        &self.attributes
    }

    /// Takes a finding; too many errors end the reading.
    pub(super) fn report(&mut self, mut finding: Diagnostic) -> Result<(), Stop> {
        if let Some((part, round)) = &self.place {
            finding = finding.in_round(part, *round);
        }
        self.faults += usize::from(finding.severity == crate::diag::Severity::Error);
        self.sink.push(finding);
        if self.faults < MAX_FAULTS { Ok(()) } else { Err(Stop) }
    }

    fn fault(
        &mut self,
        code: Code,
        message: impl Into<String>,
        at: Range<usize>,
        help: &str,
    ) -> Result<(), Stop> {
        let span = self.span(at);
        self.report(Diagnostic::new(code, message).at(span, "").help(help))
    }

    fn stop<T>(
        &mut self,
        code: Code,
        message: impl Into<String>,
        at: Range<usize>,
        help: &str,
    ) -> Result<T, Stop> {
        self.fault(code, message, at, help)?;
        Err(Stop)
    }

    fn span(&self, at: Range<usize>) -> Span {
        self.source.span(at.start + self.mark..at.end + self.mark)
    }
    /// The place of an attribute's name.
    pub(super) fn name_span(&self, attribute: Attribute<'_>) -> Span {
        self.span(attribute.name_at..attribute.name_at + attribute.name.len())
    }
    /// The place of an attribute's value.
    pub(super) fn value_span(&self, attribute: Attribute<'_>) -> Span {
        self.span(attribute.at..attribute.at + attribute.raw.len())
    }

    /// Where a slice of the text begins.
    fn offset(&self, slice: &str) -> usize {
        (slice.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize)
    }

    /// The next element or end.
    pub(super) fn next(&mut self) -> Result<Next<'t>, Stop> {
        loop {
            let before = self.reader.buffer_position() as usize;
            let (resolved, event) = match self.reader.read_resolved_event() {
                Ok(pair) => pair,
                Err(error) => return self.syntax(&error),
            };
            let ours = resolved == ResolveResult::Bound(Namespace(NAMESPACE));
            if let (false, ResolveResult::Bound(Namespace(name))) = (self.rooted, resolved) {
                name.clone_into(&mut self.namespace);
            }
            let after = self.reader.buffer_position() as usize;
            let at = before..after;
            match event {
                Event::Start(tag) => return self.start(&tag, ours, at),
                Event::End(_) => {
                    self.open.pop();
                    return Ok(Next::Close);
                }
                Event::Eof => return self.end(),
                Event::Comment(_) | Event::Empty(_) => {} // empty ones are expanded into start and end
                Event::Text(text) => self.text(&text, at)?,
                Event::Decl(decl) => self.declaration(&decl, at)?,
                Event::CData(_) => self.fault(Code::XmlText, "text between elements", at, NO_TEXT)?,
                Event::GeneralRef(name) => {
                    let known = name.is_char_ref() || matches!(&*name, "lt" | "gt" | "amp" | "apos" | "quot");
                    if known {
                        self.fault(Code::XmlText, "text between elements", at, NO_TEXT)?;
                    } else {
                        let message = format!("entity `&{};` is not allowed", &*name);
                        return self.stop(Code::XmlForbidden, message, at, NO_ENTITY);
                    }
                }
                Event::DocType(_) => {
                    let message = "a DOCTYPE is not allowed";
                    return self.stop(
                        Code::XmlForbidden,
                        message,
                        at,
                        "remove it; the schema is in grammar/picot.xsd",
                    );
                }
                Event::PI(_) => {
                    self.fault(
                        Code::XmlForbidden,
                        "a processing instruction is not allowed",
                        at,
                        "remove it",
                    )?;
                }
            }
        }
    }

    fn start(&mut self, tag: &BytesStart<'t>, ours: bool, at: Range<usize>) -> Result<Next<'t>, Stop> {
        if self.open.is_empty() && self.rooted {
            return self.stop(Code::XmlSyntax, "a second root element", at, "a file holds one program");
        }
        if self.open.len() >= MAX_DEPTH {
            let message = format!("elements are nested more than {MAX_DEPTH} deep");
            return self.stop(Code::XmlTooLarge, message, at, "repeats go 16 deep at most");
        }
        self.rooted = true;
        let from = self.offset(tag);
        let content: &'t str = self.text.get(from..from + tag.len()).unwrap_or_default();
        let local = tag.local_name().as_ref().len();
        let whole = tag.name().as_ref().len();
        let element = Element {
            name: content.get(whole - local..whole).unwrap_or_default(),
            span: self.span(from.saturating_sub(1)..from + whole),
            ours,
        };
        self.open.push(element);
        self.read_attributes(tag, content, from)?;
        Ok(Next::Open(element))
    }

    fn read_attributes(&mut self, tag: &BytesStart<'_>, content: &'t str, from: usize) -> Result<(), Stop> {
        self.attributes.clear();
        for attribute in tag.attributes() {
            let attribute = match attribute {
                Ok(attribute) => attribute,
                Err(error) => return self.attribute_fault(&error, content, from),
            };
            let (name_at, at) = (self.offset(attribute.key.0), self.offset(&attribute.value));
            let attribute = Attribute {
                name: self.text.get(name_at..name_at + attribute.key.0.len()).unwrap_or_default(),
                raw: self.text.get(at..at + attribute.value.len()).unwrap_or_default(),
                at,
                name_at,
            };
            if attribute.name == "xmlns"
                || attribute.name.starts_with("xmlns:")
                || self.is_hint(attribute.name)
            {
                continue;
            }
            if let Some(offset) = attribute.raw.find('<') {
                let at = attribute.at + offset;
                return self.stop(
                    Code::XmlSyntax,
                    "`<` in the value of an attribute",
                    at..at + 1,
                    "write `&lt;`",
                );
            }
            if self.attributes.len() == MAX_ATTRIBUTES {
                let at = attribute.name_at..attribute.name_at + attribute.name.len();
                let message = format!("an element has more than {MAX_ATTRIBUTES} attributes");
                return self.stop(Code::XmlTooLarge, message, at, "no element of Picot XML has that many");
            }
            self.attributes.push(attribute);
        }
        Ok(())
    }

    /// A hint where the schema is, which says nothing about the program.
    fn is_hint(&self, name: &str) -> bool {
        name.ends_with(":schemaLocation") && {
            let (resolved, local) = self.reader.resolver().resolve_attribute(quick_xml::name::QName(name));
            local.as_ref() == "schemaLocation" && resolved == ResolveResult::Bound(Namespace(SCHEMA_INSTANCE))
        }
    }

    /// The value of an attribute, with references resolved.
    pub(super) fn value(&mut self, attribute: Attribute<'t>) -> Result<Cow<'t, str>, Stop> {
        if !attribute.raw.bytes().any(|b| matches!(b, b'&' | b'\t' | b'\n' | b'\r')) {
            return Ok(Cow::Borrowed(attribute.raw));
        }
        let at = attribute.at..attribute.at + attribute.raw.len();
        let raw = quick_xml::events::attributes::Attribute {
            key: quick_xml::name::QName(attribute.name),
            value: Cow::Borrowed(attribute.raw),
        };
        match raw.normalized_value(XmlVersion::Explicit1_0) {
            Ok(value) => {
                if let Some(c) = value.chars().find(|&c| !is_xml_char(c)) {
                    let message =
                        format!("a reference to U+{:04X}, which is no character of XML", u32::from(c));
                    self.fault(Code::XmlSyntax, message, at, "remove it")?;
                }
                Ok(Cow::Owned(value.into_owned()))
            }
            Err(Error::Escape(EscapeError::UnrecognizedEntity(_, name))) => {
                self.stop(Code::XmlForbidden, format!("entity `&{name};` is not allowed"), at, NO_ENTITY)
            }
            Err(Error::Escape(EscapeError::InvalidCharRef(_))) => {
                self.stop(Code::XmlSyntax, "a reference to no character of XML", at, "remove it")
            }
            Err(_) => self.stop(
                Code::XmlSyntax,
                "an ampersand that begins no reference",
                at,
                "write `&amp;` for an ampersand",
            ),
        }
    }

    fn text(&mut self, text: &str, at: Range<usize>) -> Result<(), Stop> {
        if text.bytes().all(|b| matches!(b, b' ' | b'\t' | b'\n' | b'\r')) {
            return Ok(());
        }
        let lead = text.len() - text.trim_start().len();
        let from = at.start + lead;
        let at = from..from + text.trim().len();
        if self.open.is_empty() {
            let message =
                if self.rooted { "text after the root element" } else { "text before the root element" };
            return self.stop(Code::XmlSyntax, message, at, "a Picot XML file holds one <program> element");
        }
        self.fault(Code::XmlText, "text between elements", at, NO_TEXT)
    }

    fn declaration(&mut self, decl: &BytesDecl<'_>, at: Range<usize>) -> Result<(), Stop> {
        if at.start != 0 {
            return self.stop(
                Code::XmlSyntax,
                "an XML declaration that is not at the very start",
                at,
                "remove it",
            );
        }
        if decl.version().ok().as_deref() != Some("1.0") {
            return self.stop(Code::XmlSyntax, "this is not XML 1.0", at, "write `<?xml version=\"1.0\"?>`");
        }
        let utf8 = match decl.encoding() {
            None => true,
            Some(encoding) => encoding.is_ok_and(|name| name.eq_ignore_ascii_case("utf-8")),
        };
        if !utf8 {
            let message = "the XML declaration names another encoding than UTF-8";
            return self.stop(Code::XmlEncoding, message, at, "save the file as UTF-8 and say so");
        }
        Ok(())
    }

    fn end(&mut self) -> Result<Next<'t>, Stop> {
        if let Some(element) = self.open.last() {
            let message = format!("the file ends inside <{}>", element.name);
            let span = element.span;
            self.report(
                Diagnostic::new(Code::XmlSyntax, message)
                    .at(span, "opened here")
                    .help("the file was cut short: write it again"),
            )?;
            return Err(Stop);
        }
        if !self.rooted {
            return self.stop(
                Code::XmlSyntax,
                "the file holds no element",
                0..self.text.len().min(1),
                "write a <program>",
            );
        }
        Ok(Next::End)
    }

    fn syntax<T>(&mut self, error: &Error) -> Result<T, Stop> {
        let end = self.reader.buffer_position() as usize;
        let start = (self.reader.error_position() as usize).min(end);
        let end = end.min(start + 40).max(start);
        let end = (start..=end).rev().find(|&i| self.text.is_char_boundary(i)).unwrap_or(start);
        let message = match error {
            Error::IllFormed(IllFormedError::MismatchedEndTag { expected, found }) => {
                format!("`</{found}>` stands where `</{expected}>` is due")
            }
            Error::IllFormed(IllFormedError::UnmatchedEndTag(found)) => {
                format!("`</{found}>` closes nothing")
            }
            Error::IllFormed(IllFormedError::MissingEndTag(tag)) => format!("<{tag}> is never closed"),
            Error::Syntax(error) => error.to_string().replace('\n', " "),
            Error::IllFormed(error) => error.to_string(),
            Error::InvalidAttr(error) => error.to_string(),
            Error::Escape(error) => error.to_string(),
            Error::Namespace(error) => error.to_string(),
            Error::Io(_) | Error::Encoding(_) => "unreadable XML".to_owned(),
        };
        self.stop(Code::XmlSyntax, message, start..end, "the file is no well-formed XML")
    }

    fn attribute_fault(&mut self, error: &AttrError, content: &str, from: usize) -> Result<(), Stop> {
        let (message, offset) = match *error {
            AttrError::ExpectedEq(at) => ("an attribute without `=`", at),
            AttrError::ExpectedValue(at) => ("an attribute without a value", at),
            AttrError::UnquotedValue(at) => ("an attribute whose value has no quotes", at),
            AttrError::ExpectedQuote(at, _) => ("the value of an attribute is not closed", at),
            AttrError::Duplicated(at, _) => ("an attribute is given twice", at),
        };
        let at = from + offset.min(content.len());
        let end = (at + 1..=from + content.len()).find(|&i| self.text.is_char_boundary(i)).unwrap_or(at);
        self.stop(Code::XmlSyntax, message, at..end, "the file is no well-formed XML")
    }
}

const NO_TEXT: &str = "all values stand in attributes; notes can stand in comments `<!-- -->`";
const NO_ENTITY: &str =
    "only &lt; &gt; &amp; &apos; &quot; and references to characters such as &#228; are read";

/// True for a character that XML 1.0 can hold.
fn is_xml_char(c: char) -> bool {
    matches!(c, '\t' | '\n' | '\r' | ' '..='\u{d7ff}' | '\u{e000}'..='\u{fffd}' | '\u{10000}'..)
}
