//! Diagnostics as data: sources with their spans, findings with labels and fixes, and the sink that collects them.

pub mod code;
pub mod position;
pub mod render;

pub use code::{Code, Severity};

use std::{fmt, io, ops::Range, rc::Rc};

/// A byte range in one of the opened sources. Offsets run on from file to file and start at 1,
/// so a span names its file, and 0..0 is free for [`Span::NONE`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Span {
    start: u32,
    end: u32,
}

impl Span {
    /// The span of what no one wrote.
    pub const NONE: Self = Self { start: 0, end: 0 };

    /// True for [`Span::NONE`].
    pub fn is_none(self) -> bool {
        self.start == 0
    }

    /// The smallest span that covers both; `NONE` is neutral.
    #[must_use]
    pub fn to(self, other: Self) -> Self {
        match (self.is_none(), other.is_none()) {
            (true, _) => other,
            (_, true) => self,
            _ => Self { start: self.start.min(other.start), end: self.end.max(other.end) },
        }
    }
}

impl fmt::Debug for Span {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_none() { f.write_str("-") } else { write!(f, "{}..{}", self.start, self.end) }
    }
}

/// One opened file: its name as the user gave it, and its bytes.
#[derive(Debug)]
pub struct Source {
    name: String,
    bytes: Vec<u8>,
    base: u32,
}

impl Source {
    /// The name under which the file was opened.
    pub fn name(&self) -> &str {
        &self.name
    }
    /// The raw bytes.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }
    /// The text, when the bytes are UTF-8; else the offset of the first byte that is not.
    pub fn text(&self) -> Result<&str, usize> {
        std::str::from_utf8(&self.bytes).map_err(|e| e.valid_up_to())
    }
    /// The span of a byte range of this file. Ranges beyond the end are cut to it.
    pub fn span(&self, range: Range<usize>) -> Span {
        let clip = |offset: usize| self.base + offset.min(self.bytes.len()) as u32;
        Span { start: clip(range.start), end: clip(range.end).max(clip(range.start)) }
    }
    /// The byte range of a span in this file; `None` when the span lies in another file.
    pub fn range(&self, span: Span) -> Option<Range<usize>> {
        let last = self.base + self.bytes.len() as u32;
        (!span.is_none() && span.start >= self.base && span.end <= last)
            .then(|| (span.start - self.base) as usize..(span.end - self.base) as usize)
    }
}

/// Where files come from: the disk for the command line, a map for tests and for the web.
pub trait Loader {
    /// The bytes of the file `name`.
    fn load(&self, name: &str) -> io::Result<Vec<u8>>;
}

impl<F: Fn(&str) -> io::Result<Vec<u8>>> Loader for F {
    fn load(&self, name: &str) -> io::Result<Vec<u8>> {
        self(name)
    }
}

/// All files of one run, in the order in which they were opened.
pub struct Sources<'l> {
    loader: &'l dyn Loader,
    files: Vec<Rc<Source>>,
}

impl fmt::Debug for Sources<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.files.iter().map(|file| &file.name)).finish()
    }
}

impl<'l> Sources<'l> {
    /// No file yet; later ones come through `loader`.
    pub fn new(loader: &'l dyn Loader) -> Self {
        Self { loader, files: Vec::new() }
    }

    /// Opens a file through the loader. A shape file reaches its mesh through this.
    pub fn open(&mut self, name: &str) -> io::Result<Rc<Source>> {
        let bytes = self.loader.load(name)?;
        self.add(name, bytes)
    }

    /// Adds a file whose bytes are at hand. Fails when all files together pass 4 GiB.
    pub fn add(&mut self, name: &str, bytes: Vec<u8>) -> io::Result<Rc<Source>> {
        let base = self.files.last().map_or(1, |file| u64::from(file.base) + file.bytes.len() as u64 + 1);
        let end = base + bytes.len() as u64;
        let (Ok(base), true) = (u32::try_from(base), end < u64::from(u32::MAX)) else {
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, "input larger than 4 GiB"));
        };
        let source = Rc::new(Source { name: name.to_owned(), bytes, base });
        self.files.push(Rc::clone(&source));
        Ok(source)
    }

    /// The file and the byte range of a span.
    pub fn locate(&self, span: Span) -> Option<(&Source, Range<usize>)> {
        self.find(span).map(|(_, file, range)| (file, range))
    }

    /// The file of a span with its number in the order of opening.
    fn find(&self, span: Span) -> Option<(usize, &Source, Range<usize>)> {
        let index = self.files.partition_point(|file| file.base <= span.start).checked_sub(1)?;
        let file = self.files.get(index)?;
        Some((index, file, file.range(span)?))
    }

    /// The opened files in order.
    pub fn files(&self) -> impl Iterator<Item = &Source> {
        self.files.iter().map(|file| &**file)
    }
}

/// A place that a diagnostic points at, with what to say there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// Where.
    pub span: Span,
    /// What; may be empty on the primary label.
    pub message: String,
}

/// Part and round of a generated pattern, which has no text to point into.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Name of the part.
    pub part: String,
    /// Round number as the pattern prints it.
    pub round: Option<u32>,
}

/// One replacement on the original bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edit {
    /// What goes.
    pub span: Span,
    /// What comes.
    pub replacement: String,
}

/// A repair of the input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fix {
    /// What the repair does, in a few words.
    pub title: String,
    /// The replacements; they do not overlap.
    pub edits: Vec<Edit>,
    /// True when `check --fix` may apply it unasked.
    pub certain: bool,
}

/// One finding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// What kind of fault; a row of the table in [`code`].
    pub code: Code,
    /// How bad; the code's own severity unless changed.
    pub severity: Severity,
    /// One short phrase, lower case, no full stop, with the numbers that matter.
    pub message: String,
    /// Places; the first is primary.
    pub labels: Vec<Label>,
    /// Part and round where there is no text.
    pub place: Option<Place>,
    /// What would make it right.
    pub help: Option<String>,
    /// Repairs.
    pub fixes: Vec<Fix>,
}

impl Diagnostic {
    /// A finding with no place yet.
    pub fn new(code: Code, message: impl Into<String>) -> Self {
        Self {
            code,
            severity: code.severity(),
            message: message.into(),
            labels: Vec::new(),
            place: None,
            help: None,
            fixes: Vec::new(),
        }
    }
    /// Adds a label; the first one is primary. A label without a place is dropped.
    #[must_use]
    pub fn at(mut self, span: Span, message: impl Into<String>) -> Self {
        if !span.is_none() {
            self.labels.push(Label { span, message: message.into() });
        }
        self
    }
    /// Names part and round.
    #[must_use]
    pub fn in_round(mut self, part: &str, round: Option<u32>) -> Self {
        self.place = Some(Place { part: part.to_owned(), round });
        self
    }
    /// Says what would make it right.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
    /// Adds a repair.
    #[must_use]
    pub fn fix(mut self, fix: Fix) -> Self {
        self.fixes.push(fix);
        self
    }
}

/// Hears of stages and progress. The core has no clock; whoever listens may have one.
pub trait Observer {
    /// A stage of the pipeline begins.
    fn stage(&self, name: &'static str);
    /// `done` of `total` units of the current stage are finished.
    fn step(&self, done: u64, total: u64);
}

/// Collects diagnostics and passes progress on. Context comes first in argument lists, the sink last.
#[derive(Default)]
pub struct Sink<'o> {
    diagnostics: Vec<Diagnostic>,
    errors: usize,
    observer: Option<&'o dyn Observer>,
}

impl fmt::Debug for Sink<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(&self.diagnostics).finish()
    }
}

impl<'o> Sink<'o> {
    /// An empty sink that no one listens to.
    pub fn new() -> Self {
        Self::default()
    }
    /// An empty sink whose stages and steps `observer` hears.
    pub fn with_observer(observer: &'o dyn Observer) -> Self {
        Self { observer: Some(observer), ..Self::default() }
    }
    /// Takes a finding.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.errors += usize::from(diagnostic.severity == Severity::Error);
        self.diagnostics.push(diagnostic);
    }
    /// True when an error was pushed.
    pub fn has_errors(&self) -> bool {
        self.errors > 0
    }
    /// Number of errors so far; compare before and after to see whether a stage failed.
    pub fn errors(&self) -> usize {
        self.errors
    }
    /// All findings in order.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }
    /// Hands the findings over.
    pub fn take(&mut self) -> Vec<Diagnostic> {
        self.errors = 0;
        std::mem::take(&mut self.diagnostics)
    }
    /// Announces a stage.
    pub fn stage(&self, name: &'static str) {
        if let Some(observer) = self.observer {
            observer.stage(name);
        }
    }
    /// Announces progress within the stage.
    pub fn step(&self, done: u64, total: u64) {
        if let Some(observer) = self.observer {
            observer.step(done, total);
        }
    }
}

/// The candidate nearest to `word` in spelling: distance 1, or 2 from six letters on; none for a single letter.
pub fn did_you_mean<'c>(word: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    let limit = match word.chars().count() {
        0 | 1 => return None,
        2..6 => 1,
        _ => 2,
    };
    candidates
        .into_iter()
        .map(|candidate| (strsim::damerau_levenshtein(word, candidate), candidate))
        .filter(|(distance, _)| *distance <= limit)
        .min()
        .map(|(_, candidate)| candidate)
}
