//! The lines around some places of a file, cut to a bounded size and cleaned for display.

use crate::diag::Source;
use crate::diag::position::Location;
use std::ops::Range;

/// Bytes shown on a line before a place and after it.
const BESIDE: usize = 400;
/// Bytes of a place that are shown; the rest of a longer one is not.
const LONGEST: usize = 2000;
/// Places nearer than this, in bytes, share an excerpt.
const NEAR: usize = 800;

/// A piece of a file.
#[derive(Debug)]
pub(super) struct Excerpt<'s> {
    source: &'s Source,
    window: Range<usize>,
    /// Number of the first line.
    pub(super) line: usize,
    /// What is shown: valid UTF-8 without carriage returns.
    pub(super) text: String,
    /// True when the text starts in the middle of a line, so that columns in it are not the file's.
    pub(super) cut: bool,
    /// True when the text is the file's own, whole lines, byte by byte.
    pub(super) exact: bool,
}

/// The excerpts that show these places, in the order in which a place first asks for one.
pub(super) fn around<'l, 's: 'l>(locations: impl Iterator<Item = &'l Location<'s>>) -> Vec<Excerpt<'s>> {
    let mut windows: Vec<(&Source, Range<usize>, usize)> = Vec::new();
    for location in locations {
        let (window, line) = window(location);
        let near = |(source, other, _): &(&Source, Range<usize>, usize)| {
            std::ptr::eq(*source, location.source)
                && window.start <= other.end.saturating_add(NEAR)
                && other.start <= window.end.saturating_add(NEAR)
        };
        match windows.iter_mut().find(|known| near(known)) {
            Some((_, known, first)) => {
                *first = (*first).min(line);
                *known = known.start.min(window.start)..known.end.max(window.end);
            }
            None => windows.push((location.source, window, line)),
        }
    }
    windows.into_iter().map(|(source, window, line)| Excerpt::new(source, window, line)).collect()
}

/// The bytes to show for one place, and the number of their first line.
fn window(location: &Location<'_>) -> (Range<usize>, usize) {
    let bytes = location.source.bytes();
    let low = location.range.start.saturating_sub(BESIDE);
    let before = bytes.get(low..location.range.start).unwrap_or_default();
    let start = match before.iter().rposition(|byte| *byte == b'\n') {
        Some(index) => low + index + 1,
        // A cut in the middle of a line falls on the start of a scalar value.
        None => low + before.iter().take_while(|byte| **byte & 0xC0 == 0x80).count(),
    };
    let last = location.range.end.min(location.range.start + LONGEST);
    let after = bytes.get(last..).unwrap_or_default();
    let length = after.iter().take(BESIDE).position(|byte| *byte == b'\n');
    (start..last + length.unwrap_or(BESIDE.min(after.len())), location.line)
}

impl<'s> Excerpt<'s> {
    fn new(source: &'s Source, window: Range<usize>, line: usize) -> Self {
        let bytes = source.bytes();
        let shown = bytes.get(window.clone()).unwrap_or_default();
        let text = clean(shown);
        let whole_start = window.start.checked_sub(1).is_none_or(|at| bytes.get(at) == Some(&b'\n'));
        let whole_end = bytes.get(window.end).is_none_or(|byte| *byte == b'\n');
        let cut = !whole_start;
        let exact = whole_start && whole_end && text.as_bytes() == shown;
        Self { source, window, line, text, cut, exact }
    }

    /// True when the place starts in here.
    pub(super) fn covers(&self, location: &Location<'_>) -> bool {
        std::ptr::eq(self.source, location.source)
            && self.window.start <= location.range.start
            && location.range.start <= self.window.end
    }

    /// The byte range of [`Self::text`] that shows a byte range of the file.
    pub(super) fn map(&self, range: Range<usize>) -> Range<usize> {
        let place = |offset: usize| {
            let end = offset.clamp(self.window.start, self.window.end);
            let mut length = clean(self.source.bytes().get(self.window.start..end).unwrap_or_default())
                .len()
                .min(self.text.len());
            while !self.text.is_char_boundary(length) {
                length -= 1;
            }
            length
        };
        let start = place(range.start);
        start..place(range.end).max(start)
    }
}

/// The bytes as text: replacement characters for what is no UTF-8, nothing for carriage returns.
fn clean(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len());
    for chunk in bytes.utf8_chunks() {
        text.extend(chunk.valid().chars().filter(|c| *c != '\r'));
        if !chunk.invalid().is_empty() {
            text.push('\u{FFFD}');
        }
    }
    text
}
