//! From spans to lines and columns, in bounded time a look-up whatever the length of the lines.

use super::{Source, Sources, Span};
use std::cell::OnceCell;
use std::ops::Range;

/// Where a span stands, as people and editors count.
#[derive(Clone, Debug)]
pub struct Location<'s> {
    /// The file.
    pub source: &'s Source,
    /// Byte range within the file.
    pub range: Range<usize>,
    /// Line of the first byte, from 1.
    pub line: usize,
    /// Column of the first byte in Unicode scalar values, from 1.
    pub column: usize,
}

/// Looks lines and columns up. Each file is walked once, when it is first asked for.
#[derive(Debug)]
pub struct Positions<'s> {
    sources: &'s Sources<'s>,
    marks: Vec<OnceCell<Marks>>,
}

impl<'s> Positions<'s> {
    /// Look-up in the files opened so far.
    pub fn new(sources: &'s Sources<'_>) -> Self {
        Self { sources, marks: sources.files().map(|_| OnceCell::new()).collect() }
    }

    /// The place of a span; `None` for a span of no file.
    pub fn locate(&self, span: Span) -> Option<Location<'s>> {
        let (index, source, range) = self.sources.find(span)?;
        let marks = self.marks.get(index)?.get_or_init(|| Marks::new(source.bytes()));
        let (line, start) = marks.line(source.bytes(), range.start);
        let column = marks.scalars(source.bytes(), range.start) - marks.scalars(source.bytes(), start) + 1;
        Some(Location { source, range, line, column })
    }
}

/// Bytes between two marks: what one look-up walks at most.
const STRIDE: usize = 4096;

/// What is known at every [`STRIDE`]th byte.
#[derive(Debug)]
struct Marks(Vec<Mark>);

#[derive(Clone, Copy, Debug, Default)]
struct Mark {
    /// Line feeds before this byte.
    lines: usize,
    /// Where the line of this byte starts.
    line_start: usize,
    /// Scalar values that start before this byte.
    scalars: usize,
}

impl Mark {
    /// The mark after the bytes that follow it.
    fn over(self, at: usize, bytes: &[u8]) -> Self {
        let feeds = bytes.split(|byte| *byte == b'\n').count() - 1;
        let last = bytes.iter().rposition(|byte| *byte == b'\n');
        Self {
            lines: self.lines + feeds,
            line_start: last.map_or(self.line_start, |index| at + index + 1),
            scalars: self.scalars + scalars(bytes),
        }
    }
}

impl Marks {
    fn new(bytes: &[u8]) -> Self {
        let mut marks = vec![Mark::default()];
        let mut mark = Mark::default();
        for (index, chunk) in bytes.chunks(STRIDE).enumerate() {
            mark = mark.over(index * STRIDE, chunk);
            marks.push(mark);
        }
        Self(marks)
    }

    /// What is known at any byte.
    fn at(&self, bytes: &[u8], offset: usize) -> Mark {
        let offset = offset.min(bytes.len());
        let index = offset / STRIDE;
        let mark = self.0.get(index).copied().unwrap_or_default();
        mark.over(index * STRIDE, bytes.get(index * STRIDE..offset).unwrap_or_default())
    }

    /// Line number from 1 and the byte at which that line starts.
    fn line(&self, bytes: &[u8], offset: usize) -> (usize, usize) {
        let mark = self.at(bytes, offset);
        (mark.lines + 1, mark.line_start)
    }

    fn scalars(&self, bytes: &[u8], offset: usize) -> usize {
        self.at(bytes, offset).scalars
    }
}

/// Scalar values that start in these bytes: all bytes but UTF-8's continuation bytes.
fn scalars(bytes: &[u8]) -> usize {
    bytes.iter().filter(|byte| **byte & 0xC0 != 0x80).count()
}
