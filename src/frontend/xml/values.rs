//! Attributes as values, and children as a content model: what is unknown, missing, repeated or misplaced is named.

use super::cursor::{Attribute, Cursor, Element, Next, Stop};
use crate::diag::{Code, Diagnostic, Span, did_you_mean};
use std::borrow::Cow;
use std::ops::RangeInclusive;

/// What may stand in an element.
pub(super) struct Model {
    /// Names of the children.
    pub(super) names: &'static [&'static str],
    /// Those of them that stand once only.
    pub(super) once: &'static [&'static str],
    /// So many of them, from the first on, stand in this order; the rest follow in any order.
    pub(super) ordered: usize,
}

/// The content of an element with attributes alone.
pub(super) const LEAF: Model = Model { names: &[], once: &[], ordered: 0 };

/// An element whose children are being read.
pub(super) struct Children<'t> {
    parent: Element<'t>,
    model: &'static Model,
    /// Place in the order of the last child, plus one.
    reached: usize,
    /// Bit per child of the model: it stood here already.
    seen: u32,
}

impl<'t> Children<'t> {
    /// Begins with the children of an element.
    pub(super) fn of(parent: Element<'t>, model: &'static Model) -> Self {
        Self { parent, model, reached: 0, seen: 0 }
    }
    /// True when a child with this name stood here.
    pub(super) fn had(&self, name: &str) -> bool {
        self.model.names.iter().position(|&known| known == name).is_some_and(|i| self.seen >> i & 1 == 1)
    }
}

impl<'t> Cursor<'t, '_, '_> {
    /// The next child that the model knows; others are reported and skipped.
    pub(super) fn child(&mut self, children: &mut Children<'t>) -> Result<Option<Element<'t>>, Stop> {
        loop {
            let element = match self.next()? {
                Next::Open(element) => element,
                Next::Close | Next::End => return Ok(None),
            };
            let model = children.model;
            let index = model.names.iter().position(|&name| element.ours && name == element.name);
            let Some(index) = index else {
                self.unknown_element(element, children)?;
                self.skip()?;
                continue;
            };
            let again = children.seen >> index & 1 == 1;
            children.seen |= 1 << index;
            let rank = index.min(model.ordered);
            if again && model.once.contains(&element.name) {
                let message = format!("a second <{}>", element.name);
                self.at(
                    Code::XmlDuplicate,
                    message,
                    element.span,
                    format!("<{}> stands once here", element.name),
                )?;
                self.skip()?;
                continue;
            }
            if rank + 1 < children.reached {
                let after = model.names.get(children.reached - 1).copied().unwrap_or_default();
                let message = format!("<{}> stands after <{after}>", element.name);
                let order = model.names.join(">, <");
                self.at(Code::XmlElement, message, element.span, format!("the order is <{order}>"))?;
            }
            children.reached = children.reached.max(rank + 1);
            return Ok(Some(element));
        }
    }

    fn unknown_element(&mut self, element: Element<'_>, children: &Children<'_>) -> Result<(), Stop> {
        let (parent, names) = (children.parent.name, children.model.names);
        if self.newer && element.ours {
            return self.ignored(format!("<{}> in <{parent}> is ignored", element.name), element.span);
        }
        let message = if element.ours {
            format!("<{}> is unknown in <{parent}>", element.name)
        } else {
            format!("<{}> in <{parent}> is not in the namespace of Picot", element.name)
        };
        let help = match did_you_mean(element.name, names.iter().copied()) {
            Some(name) if element.ours => format!("did you mean <{name}>?"),
            _ if names.is_empty() => format!("<{parent}> has no children"),
            _ => format!("<{parent}> holds <{}>", names.join(">, <")),
        };
        self.at(Code::XmlElement, message, element.span, help)
    }

    /// Reads over the rest of the element opened last.
    pub(super) fn skip(&mut self) -> Result<(), Stop> {
        let mut depth = 1_u32;
        while depth > 0 {
            match self.next()? {
                Next::Open(_) => depth += 1,
                Next::Close => depth -= 1,
                Next::End => return Ok(()),
            }
        }
        Ok(())
    }

    /// Reads the end of an element that has no children.
    pub(super) fn leaf(&mut self, element: Element<'t>) -> Result<(), Stop> {
        self.child(&mut Children::of(element, &LEAF)).map(|_| ())
    }

    /// A fault at a place.
    pub(super) fn at(
        &mut self,
        code: Code,
        message: impl Into<String>,
        span: Span,
        help: impl Into<String>,
    ) -> Result<(), Stop> {
        self.report(Diagnostic::new(code, message).at(span, "").help(help))
    }

    fn ignored(&mut self, message: String, span: Span) -> Result<(), Stop> {
        const MOST: u32 = 10;
        self.warned += 1;
        if self.warned > MOST {
            return Ok(());
        }
        self.at(Code::XmlIgnored, message, span, "a newer Picot wrote this file and may say more about it")
    }

    /// Reports the attributes of an element that are not among `names`.
    pub(super) fn only(&mut self, element: Element<'t>, names: &[&str]) -> Result<(), Stop> {
        for index in 0..self.attributes().len() {
            let Some(&attribute) = self.attributes().get(index) else { break };
            if names.contains(&attribute.name) {
                continue;
            }
            let span = self.name_span(attribute);
            let message = format!("<{}> has no attribute `{}`", element.name, attribute.name);
            if self.newer && !attribute.name.contains(':') {
                self.ignored(format!("`{}` of <{}> is ignored", attribute.name, element.name), span)?;
                continue;
            }
            let help = match did_you_mean(attribute.name, names.iter().copied()) {
                Some(name) => format!("did you mean `{name}`?"),
                None if names.is_empty() => format!("<{}> has no attributes", element.name),
                None => format!("<{}> has `{}`", element.name, names.join("`, `")),
            };
            self.at(Code::XmlAttribute, message, span, help)?;
        }
        Ok(())
    }

    /// An attribute by name.
    pub(super) fn get(&self, name: &str) -> Option<Attribute<'t>> {
        self.attributes().iter().find(|attribute| attribute.name == name).copied()
    }

    /// An attribute that must be there; its absence is reported.
    pub(super) fn need(&mut self, element: Element<'t>, name: &str) -> Result<Option<Attribute<'t>>, Stop> {
        let found = self.get(name);
        if found.is_none() {
            let message = format!("<{}> lacks `{name}`", element.name);
            self.at(Code::XmlMissing, message, element.span, format!("add `{name}=\"..\"`"))?;
        }
        Ok(found)
    }

    /// A text that must be there, with its place.
    pub(super) fn text_of(&mut self, element: Element<'t>, name: &str) -> Result<(Cow<'t, str>, Span), Stop> {
        match self.need(element, name)? {
            Some(attribute) => Ok((self.value(attribute)?, self.value_span(attribute))),
            None => Ok((Cow::Borrowed(""), Span::NONE)),
        }
    }

    /// A whole number within a range, when the attribute is there.
    pub(super) fn count(&mut self, name: &str, range: RangeInclusive<u32>) -> Result<Option<u32>, Stop> {
        let Some(attribute) = self.get(name) else { return Ok(None) };
        let value = self.value(attribute)?;
        let text = value.trim_matches(BLANK);
        let (low, high) = (*range.start(), *range.end());
        match text.parse::<u32>() {
            Ok(number) if range.contains(&number) => return Ok(Some(number)),
            Ok(number) if number < low => {
                let message = format!("`{name}` is {number}, less than {low}");
                self.at(Code::XmlValue, message, self.value_span(attribute), format!("{low} is the least"))?;
            }
            Err(_) if text.is_empty() || !text.bytes().all(|b| b.is_ascii_digit()) => {
                let message = format!("`{name}` is {}, not a whole number", quoted(text));
                let help = format!("write a whole number from {low} to {high}");
                self.at(Code::XmlValue, message, self.value_span(attribute), help)?;
            }
            Ok(_) | Err(_) => {
                let message = format!("`{name}` is {}, more than {high}", shortened(text));
                self.at(
                    Code::XmlTooLarge,
                    message,
                    self.value_span(attribute),
                    format!("{high} is the most"),
                )?;
            }
        }
        Ok(Some(low))
    }

    /// A whole number that must be there. After a fault it is the least of the range.
    pub(super) fn count_of(
        &mut self,
        element: Element<'t>,
        name: &str,
        range: RangeInclusive<u32>,
    ) -> Result<u32, Stop> {
        let low = *range.start();
        self.need(element, name)?;
        Ok(self.count(name, range)?.unwrap_or(low))
    }

    /// A finite number that must be there. After a fault it is 1.
    pub(super) fn real_of(&mut self, element: Element<'t>, name: &str) -> Result<f64, Stop> {
        let Some(attribute) = self.need(element, name)? else { return Ok(1.0) };
        let value = self.value(attribute)?;
        let text = value.trim_matches(BLANK);
        // Rust reads words such as `inf` too.
        let plain = text.bytes().all(|b| matches!(b, b'0'..=b'9' | b'+' | b'-' | b'.' | b'e' | b'E'));
        match text.parse::<f64>() {
            Ok(number) if plain && number.is_finite() => Ok(number),
            _ => {
                let message = format!("`{name}` is {}, not a finite number", quoted(text));
                self.at(
                    Code::XmlValue,
                    message,
                    self.value_span(attribute),
                    "write a number such as 2.5 or 1e-3",
                )?;
                Ok(1.0)
            }
        }
    }

    /// One of a few words, when the attribute is there; after a fault the first.
    pub(super) fn word<T: Copy>(&mut self, name: &str, words: &[(&str, T)]) -> Result<Option<T>, Stop> {
        let Some(attribute) = self.get(name) else { return Ok(None) };
        let value = self.value(attribute)?;
        let text = value.trim_matches(BLANK);
        if let Some((_, found)) = words.iter().find(|(word, _)| *word == text) {
            return Ok(Some(*found));
        }
        let known = || words.iter().map(|(word, _)| *word);
        let help = match did_you_mean(text, known()) {
            Some(word) => format!("did you mean `{word}`?"),
            None => format!("write `{}`", known().collect::<Vec<_>>().join("`, `")),
        };
        let message = format!("`{name}` is {}", quoted(text));
        self.at(Code::XmlValue, message, self.value_span(attribute), help)?;
        Ok(words.first().map(|(_, first)| *first))
    }

    /// One of a few words that must be there.
    pub(super) fn word_of<T: Copy>(
        &mut self,
        element: Element<'t>,
        name: &str,
        words: &[(&str, T)],
    ) -> Result<Option<T>, Stop> {
        self.need(element, name)?;
        self.word(name, words)
    }

    /// Yes or no, with a default.
    pub(super) fn flag(&mut self, name: &str, default: bool) -> Result<bool, Stop> {
        let words = [("true", true), ("false", false), ("1", true), ("0", false)];
        Ok(self.word(name, &words)?.unwrap_or(default))
    }
}

/// The blanks that XML strips from a number.
pub(super) const BLANK: [char; 4] = [' ', '\t', '\n', '\r'];

/// A value for a message, cut to a bearable length.
pub(super) fn quoted(text: &str) -> String {
    format!("`{}`", shortened(text))
}

fn shortened(text: &str) -> String {
    const MOST: usize = 24;
    if text.chars().count() <= MOST {
        return text.to_owned();
    }
    text.chars().take(MOST).chain("..".chars()).collect()
}
