//! Tags one after another: attributes in the order in which they are given, shortest floats, no allocation a tag.

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};
use std::borrow::Cow;
use std::fmt::Write as _;
use std::io;

/// Writes tags. The text of the tag under way is kept in one buffer that is used again.
pub(super) struct Tags<W: io::Write> {
    writer: Writer<W>,
    text: String,
    /// Length of the tag's name in `text`.
    name: usize,
}

impl<W: io::Write> Tags<W> {
    /// Begins a document.
    pub(super) fn new(out: W) -> io::Result<Self> {
        let mut writer = Writer::new_with_indent(out, b' ', 2);
        writer.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
        Ok(Self { writer, text: String::new(), name: 0 })
    }
    /// Begins a tag.
    pub(super) fn tag(&mut self, name: &str) -> &mut Self {
        self.text.clear();
        self.text.push_str(name);
        self.name = name.len();
        self
    }
    /// An attribute with any text.
    pub(super) fn text(&mut self, name: &str, value: &str) -> &mut Self {
        self.begin(name);
        escape(value, &mut self.text);
        self.end()
    }
    /// An attribute with a number of things.
    pub(super) fn count(&mut self, name: &str, value: u32) -> &mut Self {
        self.begin(name);
        let _ = write!(self.text, "{value}"); // writing to a String cannot fail
        self.end()
    }
    /// An attribute with the shortest decimal that reads back to the same bits.
    pub(super) fn real(&mut self, name: &str, value: f64) -> &mut Self {
        self.begin(name);
        real(value, &mut self.text);
        self.end()
    }
    /// An attribute with ids between spaces.
    pub(super) fn list(&mut self, name: &str, ids: &[u32]) -> &mut Self {
        self.begin(name);
        for (index, id) in ids.iter().enumerate() {
            let space = if index == 0 { "" } else { " " };
            let _ = write!(self.text, "{space}{id}"); // writing to a String cannot fail
        }
        self.end()
    }
    /// Ends the tag; children follow.
    pub(super) fn open(&mut self) -> io::Result<()> {
        self.writer.write_event(Event::Start(BytesStart::from_content(&*self.text, self.name)))
    }
    /// Ends the tag and the element.
    pub(super) fn empty(&mut self) -> io::Result<()> {
        self.writer.write_event(Event::Empty(BytesStart::from_content(&*self.text, self.name)))
    }
    /// Ends an element with children.
    pub(super) fn close(&mut self, name: &str) -> io::Result<()> {
        self.writer.write_event(Event::End(BytesEnd::new(name)))
    }
    /// Ends the document.
    pub(super) fn finish(mut self) -> io::Result<()> {
        self.writer.write_event(Event::Text(BytesText::from_escaped("\n")))
    }

    fn begin(&mut self, name: &str) {
        self.text.push(' ');
        self.text.push_str(name);
        self.text.push_str("=\"");
    }
    fn end(&mut self) -> &mut Self {
        self.text.push('"');
        self
    }
}

/// True for a character that XML 1.0 can hold.
pub(super) fn is_xml_char(c: char) -> bool {
    matches!(c, '\t' | '\n' | '\r' | ' '..='\u{d7ff}' | '\u{e000}'..='\u{fffd}' | '\u{10000}'..)
}

/// Tabs and line ends become references too, because a reader of attributes turns plain ones into spaces.
fn escape(value: &str, out: &mut String) {
    let escaped: Cow<'_, str> = quick_xml::escape::escape(value);
    for c in escaped.chars() {
        match c {
            '\t' => out.push_str("&#9;"),
            '\n' => out.push_str("&#10;"),
            c => out.push(c),
        }
    }
}

fn real(value: f64, out: &mut String) {
    let from = out.len();
    let _ = write!(out, "{value:?}"); // writing to a String cannot fail
    if out.ends_with(".0") && out.len() > from + 2 {
        out.truncate(out.len() - 2);
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn floats_are_short_and_read_back_to_the_same_bits() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "-0"),
            (2.5, "2.5"),
            (-10.0, "-10"),
            (1e300, "1e300"),
            (1.0 / 3.0, "0.3333333333333333"),
            (f64::MIN_POSITIVE / 8.0, "2.781342323134e-309"),
        ] {
            let mut out = String::new();
            super::real(value, &mut out);
            assert_eq!(out, text);
            assert_eq!(out.parse::<f64>().map(f64::to_bits), Ok(value.to_bits()));
        }
    }
}
