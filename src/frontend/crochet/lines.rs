//! From a file to its lines: headers, comments, prose, parts and rows, each line by itself.

use super::hints::Hints;
use super::lex::{self, At, Tok, Token};
use super::packed::Packed;
use super::parse::{Context, Fault, FaultKind, Tokens};
use super::row;
use super::scan;
use super::syntax::{Clause, Content, Header, Line, Node, Nodes, Num, Pair, RowLine, Stump};
use super::terms::Evidence;
use super::words::{Words, fold_word};
use crate::ir::Language;
use std::cell::{Cell, RefCell};

/// Longest line that is read, in bytes.
pub(crate) const MAX_LINE: usize = 1 << 20;

impl Tree {
    /// The row of a line that is one.
    pub(crate) fn row(&self, content: &Content) -> Option<&RowLine> {
        match content {
            Content::Row(row) => self.rows.get(*row as usize),
            _ => None,
        }
    }
}

/// A fault of a line, before it becomes a diagnostic.
#[derive(Debug)]
pub(crate) enum LineFault {
    /// The parser stopped; the token at which it did.
    Syntax { kind: FaultKind, token: Option<(Tok, At)>, line: At },
    /// A character that text must not hold.
    Character(At),
    /// The line is longer than [`MAX_LINE`].
    Long(At),
    /// A header whose value means nothing.
    Header { at: At, what: &'static str },
}

/// A file in lines, with the names that it declares.
pub(crate) struct Tree {
    pub lines: Vec<Line>,
    pub rows: Vec<RowLine>,
    /// The clauses of all rows.
    pub nodes: Vec<Node>,
    pub faults: Vec<LineFault>,
    pub language: Language,
    pub colors: Vec<String>,
    pub defs: Vec<Definition>,
    /// What the words of the rows tell of their terms; found here while they are at hand.
    pub evidence: Evidence,
    /// A row sets loops aside for another part.
    pub holds: bool,
}

/// A stitch that a file declares.
pub(crate) struct Definition {
    /// The stitch it is made of, when it is named after one: `sc-b-a`.
    pub base: Option<super::words::Spelled>,
    pub works: u16,
    pub makes: u16,
}

/// What the lines of a file use one after another.
#[derive(Default)]
struct Room {
    tokens: Vec<Token>,
    nodes: RefCell<Vec<Node>>,
    /// Below the heading of a list of text.
    heading: bool,
}

/// Parses a whole text. `language` applies until the file names its own.
pub(crate) fn parse(text: &str, language: Language) -> (Tree, Words) {
    let mut tree = Tree {
        lines: Vec::new(),
        rows: Vec::new(),
        nodes: Vec::new(),
        faults: Vec::new(),
        language,
        colors: Vec::new(),
        defs: Vec::new(),
        evidence: Evidence::default(),
        holds: false,
    };
    let mut words = Words::new(language);
    let mut room = Room::default();
    // About what patterns need. Room that stays unused is never touched.
    let ends = memchr::memchr_iter(b'\n', text.as_bytes()).count();
    tree.lines.reserve_exact(ends + 1);
    tree.rows.reserve_exact(ends.min(text.len() / 16) + 1);
    room.nodes.get_mut().reserve_exact(text.len() / 16);
    for (start, end) in lines(text) {
        let at = At::new(start, end);
        if end - start > MAX_LINE {
            tree.faults.push(LineFault::Long(At::new(start, start)));
            tree.lines.push(Line { at, what: Content::Broken(None), remark: None });
            continue;
        }
        let raw = text.get(start..end).unwrap_or_default();
        let round = is_round(raw);
        if !round && is_comment(raw) {
            tree.lines.push(Line { at, what: Content::Comment, remark: None });
            continue;
        }
        let (content_end, remark) = remark(raw);
        let (content_end, remark) = (start + content_end, remark.map(|from| At::new(start + from, end)));
        let what = if !round && raw.trim_start().is_empty() {
            room.heading = false;
            Content::Blank
        } else if let Some(header) = (!round).then(|| header(raw, start, &mut tree, &mut words)).flatten() {
            header
        } else {
            line(text, start, content_end, &words, &mut room, &mut tree)
        };
        let remark = remark.filter(|_| !matches!(what, Content::Comment));
        tree.lines.push(Line { at, what, remark });
    }
    tree.nodes = room.nodes.into_inner();
    (tree, words)
}

/// True when a clause sets loops aside.
fn holds(nodes: Nodes, all: &[Node]) -> bool {
    nodes.of(all).iter().any(|node| match &node.what {
        Clause::Hold { .. } => true,
        Clause::Group { body, .. } | Clause::Star { body, .. } => holds(*body, all),
        _ => false,
    })
}

/// Starts and ends of lines; a line ends at LF, CR LF, CR, and at the separators of Unicode.
fn lines(text: &str) -> impl Iterator<Item = (usize, usize)> {
    let bytes = text.as_bytes();
    let mut next = Some(if text.starts_with('\u{feff}') { 3 } else { 0 });
    std::iter::from_fn(move || {
        let start = next?;
        let rest = bytes.get(start..)?;
        if let Some(length) = scan::find(rest, |byte| byte.wrapping_sub(b'\n') < 4) {
            let end = start + length;
            let two = bytes.get(end..end + 2) == Some(b"\r\n");
            next = Some(end + if two { 2 } else { 1 });
            Some((start, end))
        } else {
            next = None;
            (!rest.is_empty()).then_some((start, bytes.len()))
        }
    })
}

/// Where the content of a line ends, and where a `//` remark begins.
fn remark(raw: &str) -> (usize, Option<usize>) {
    let slashes =
        memchr::memchr(b'/', raw.as_bytes()).and_then(|first| Some(first + raw.get(first..)?.find("//")?));
    match slashes {
        // A web address is no remark.
        Some(at) if !raw.get(..at).is_some_and(|before| before.ends_with(':')) => (at, Some(at)),
        _ => (raw.len(), None),
    }
}

/// True for the line that patterns are made of, which no header or heading begins like: `Rnd 7`, `Rows 3`, `5.`.
fn is_round(raw: &str) -> bool {
    let bytes = raw.as_bytes().trim_ascii_start();
    let Some((word, length)) = Packed::letters(bytes) else { return false };
    let rest = bytes.get(length..).unwrap_or_default();
    let rest = rest.strip_prefix(b".").unwrap_or(rest).trim_ascii_start();
    rest.first().is_some_and(u8::is_ascii_digit)
        && [b"rnd".as_slice(), b"rnds", b"r", b"", b"row", b"rows", b"round", b"rounds"]
            .into_iter()
            .any(|known| Packed::of(known) == Some(word))
}

fn is_comment(raw: &str) -> bool {
    let trimmed = raw.trim_start();
    trimmed.starts_with("//")
        || trimmed.starts_with('#')
        || trimmed.split_once(':').is_some_and(|(key, _)| {
            key.len() <= 24 && PROSE.iter().any(|word| key.trim_end().eq_ignore_ascii_case(word))
        })
}

/// Headings whose line is text for people.
const PROSE: &[&str] = &[
    "note",
    "notes",
    "tip",
    "size",
    "finished size",
    "materials",
    "abbreviations",
    "stuffing",
    "assembly",
    "finishing",
    "difficulty",
    "skill level",
    "designer",
    "copyright",
    "tension",
];

/// Headings under which a list of text follows, up to the next blank line.
const LISTS: &[&str] =
    &["abbreviations", "materials", "stitches used", "special stitches", "notes", "stitch key"];

fn trim(raw: &str, base: usize) -> At {
    let lead = raw.len() - raw.trim_start().len();
    At::new(base + lead, base + lead + raw.trim().len())
}

fn header(raw: &str, base: usize, tree: &mut Tree, words: &mut Words) -> Option<Content> {
    let trimmed = raw.trim_start();
    let lead = raw.len() - trimmed.len();
    let word_end = trimmed.find(|c: char| !c.is_ascii_alphabetic())?;
    let word = trimmed.get(..word_end)?;
    let after = trimmed.get(word_end..)?;
    let after_base = base + lead + word_end;
    let pair = PAIRS.iter().find(|(name, _)| word.eq_ignore_ascii_case(name));
    if let (Some((_, pair)), Some(value)) = (pair, after.trim_start().strip_prefix(':')) {
        let value_base = after_base + (after.len() - after.trim_start().len()) + 1;
        let at = trim(value, value_base);
        if *pair == Pair::Lang {
            match Language::parse(value.trim()) {
                Some(language) => {
                    tree.language = language;
                    words.change(language);
                }
                None => tree
                    .faults
                    .push(LineFault::Header { at, what: "a language: en, es, pt, fr, de, no, letters" }),
            }
        }
        return Some(header_of(Header::Pair { key: *pair, value: at }));
    }
    if word.eq_ignore_ascii_case("convention") {
        let value = after.trim_start().strip_prefix(':')?;
        let value_base = after_base + (after.len() - after.trim_start().len()) + 1;
        return Some(convention(value, value_base, tree));
    }
    if word.eq_ignore_ascii_case("color") || word.eq_ignore_ascii_case("colour") {
        let (name, value) = after.split_once('=')?;
        let at = trim(name, after_base);
        let value_at = trim(value, after_base + name.len() + 1);
        if name.trim().is_empty() || value.trim().is_empty() {
            tree.faults.push(LineFault::Header { at: trim(raw, base), what: "`color NAME = #RRGGBB`" });
        } else if tree.colors.len() < usize::from(u16::MAX) {
            words.declare(name.trim(), Tok::Color(tree.colors.len() as u16));
            tree.colors.push(name.trim().to_owned());
        }
        return Some(header_of(Header::Color { name: at, value: value_at }));
    }
    if word.eq_ignore_ascii_case("def") && after.starts_with(char::is_whitespace) {
        return def(after, after_base, raw, base, tree, words);
    }
    let list = trimmed.trim_end().trim_end_matches(':');
    if LISTS.iter().any(|name| list.eq_ignore_ascii_case(name)) {
        return None;
    }
    None
}

fn header_of(header: Header) -> Content {
    Content::Header(Box::new(header))
}

fn convention(value: &str, base: usize, tree: &mut Tree) -> Content {
    let mut settings = Vec::new();
    let mut offset = base;
    for piece in value.split([',', ';']) {
        match piece.split_once('=') {
            Some((key, choice)) => {
                settings.push((trim(key, offset), trim(choice, offset + key.len() + 1)));
            }
            None => tree.faults.push(LineFault::Header { at: trim(piece, offset), what: "`setting=value`" }),
        }
        offset += piece.len() + 1;
    }
    header_of(Header::Convention { settings })
}

/// `def shell = 1 -> 5 5 dc in one stitch`.
fn def(
    after: &str,
    after_base: usize,
    raw: &str,
    base: usize,
    tree: &mut Tree,
    words: &mut Words,
) -> Option<Content> {
    let (name, value) = after.split_once('=')?;
    let name_at = trim(name, after_base);
    let numbers = |text: &str, from: usize| {
        let lead = text.len() - text.trim_start().len();
        let digits: usize = text.trim_start().bytes().take_while(u8::is_ascii_digit).count();
        let value = text.get(lead..lead + digits)?.parse::<u16>().ok()?;
        Some((Num { value: u32::from(value), at: At::new(from + lead, from + lead + digits) }, lead + digits))
    };
    let value_base = after_base + name.len() + 1;
    let parsed = (|| {
        let (works, taken) = numbers(value, value_base)?;
        let rest = value.get(taken..)?;
        let lead = rest.len() - rest.trim_start().len();
        let arrow = ["->", "→", "=>"].iter().find(|arrow| rest.trim_start().starts_with(**arrow))?;
        let makes_from = taken + lead + arrow.len();
        let (makes, length) = numbers(value.get(makes_from..)?, value_base + makes_from)?;
        let text = value.get(makes_from + length..)?;
        Some((works, makes, trim(text, value_base + makes_from + length)))
    })();
    let single = !name.trim().is_empty() && name.trim().chars().all(|c| c.is_alphabetic() || c == '-');
    match parsed {
        Some((works, makes, text)) if single => {
            if tree.defs.len() < usize::from(u16::MAX) {
                words.declare(name.trim(), Tok::Def(tree.defs.len() as u16));
                let stem = name.trim().split('-').next().filter(|stem| stem.len() < name.trim().len());
                let base = stem.and_then(|stem| Words::english_stitch(&fold_word(stem)));
                tree.defs.push(Definition { base, works: works.value as u16, makes: makes.value as u16 });
            }
            Some(header_of(Header::Def { name: name_at, works, makes, text }))
        }
        _ => {
            tree.faults.push(LineFault::Header { at: trim(raw, base), what: "`def NAME = WORKS -> MAKES`" });
            Some(Content::Broken(None))
        }
    }
}

const PAIRS: &[(&str, Pair)] = &[
    ("title", Pair::Title),
    ("terms", Pair::Terms),
    ("lang", Pair::Lang),
    ("language", Pair::Lang),
    ("gauge", Pair::Gauge),
    ("lean", Pair::Lean),
    ("yarn", Pair::Yarn),
    ("hook", Pair::Hook),
];

/// A line that is no header: a part, a row, or prose.
fn line(text: &str, start: usize, end: usize, words: &Words, room: &mut Room, tree: &mut Tree) -> Content {
    let Room { tokens, nodes, heading } = room;
    let seen = match lex::line(text, start, end, words, tokens) {
        Ok(seen) => seen,
        Err(at) => {
            tree.faults.push(LineFault::Character(at));
            return Content::Broken(None);
        }
    };
    let fault = Fault { done: 0, kind: FaultKind::Expected("an instruction") };
    let context = Context { tokens, furthest: Cell::new(fault), nodes };
    let input = Tokens::new(&context);
    if input.is_empty() {
        return Content::Blank;
    }
    let (mut rest, mut head) = row::head(input);
    if head.is_labeled() {
        *heading = false;
    } else {
        let raw = text.get(start..end).unwrap_or_default().trim();
        if LISTS.iter().any(|name| raw.trim_end_matches(':').trim_end().eq_ignore_ascii_case(name)) {
            *heading = true;
            return Content::Comment;
        }
        if *heading {
            return Content::Comment;
        }
        if let Ok((_, head)) = row::part(input) {
            return Content::Part(Box::new(head));
        }
        if row::is_abbreviation(input) || !row::has_stitch_word(input) {
            // A part whose origin is wrong is no prose.
            if !row::opens_part(input) {
                return Content::Prose;
            }
        }
        if row::opens_part(input) {
            return broken(input, start, end, tree);
        }
        context.furthest.set(fault);
        (rest, head) = row::head(input);
    }
    match row::row(rest, head) {
        Ok((_, row::Labeled::Row(row))) => {
            let nodes = nodes.borrow();
            if tree.evidence.wants(seen) {
                tree.evidence.nodes(row.body, &nodes);
            }
            tree.holds |= seen.has(Hints::HOLD) && holds(row.body, &nodes);
            tree.rows.push(row);
            Content::Row(tree.rows.len() as u32 - 1)
        }
        Ok((_, row::Labeled::Again(again))) => Content::Again(again),
        Err(_) => broken(input, start, end, tree),
    }
}

fn broken(input: Tokens<'_>, start: usize, end: usize, tree: &mut Tree) -> Content {
    let fault = input.context.furthest.get();
    let line = At::new(start, end);
    let unread =
        |token: &&Token| token.tok == Tok::Word || token.tok == Tok::Key(super::words::Key::Tunisian);
    // A word that is not known explains more than what it led to.
    let word = match fault.kind {
        FaultKind::Deep(_) => None,
        _ => input.rest().iter().find(unread).filter(|_| input.len() < 4096),
    };
    let token = word.or(input.rest().get(fault.done)).map(|token| (token.tok, token.at));
    tree.faults.push(LineFault::Syntax { kind: fault.kind, token, line });
    let (label, count) = row::frame(input);
    Content::Broken(label.map(|label| Box::new(Stump { label, count })))
}

/// The name of a part, folded so that spelling differences do not matter.
pub(crate) fn fold_name(name: &str) -> String {
    let folded: Vec<String> = name.trim().trim_matches('"').split_whitespace().map(fold_word).collect();
    folded.join(" ")
}
