//! Parts, start lines, rounds, and what is to do between and after them.

use super::words::Words;
use super::{Arrows, Crochet, Style};
use crate::ir::dialect::fill;
use crate::ir::verify::{PartFacts, RowFacts, Verified};
use crate::ir::{
    Entry, Finish, Kind, Language, Op, Part, PartId, Program, Row, Segment, Start, Step, Stitch, Terms,
};
use std::fmt::Write as _;
use std::io::{self, Write};

/// Lines under way: rounds as they are, prose wrapped behind `//`.
pub(super) struct Text<'t> {
    out: Out<'t>,
    width: usize,
    prose: bool,
}

/// Where lines go.
enum Out<'t> {
    Writer(&'t mut dyn Write),
    Lines(&'t mut Vec<Line>),
}

/// A line of a pattern, for whoever lays it out in another way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::backends) enum Line {
    /// What the reader reads back.
    Code(String),
    /// A remark, not wrapped.
    Prose(String),
    /// Room between sections.
    Gap,
    /// The row of a part, with its label.
    Round {
        /// Index of the part.
        part: usize,
        /// Index of its row.
        row: usize,
        /// `Rnds 7-12`.
        label: String,
        /// It begins a part in a ring.
        begins: bool,
        /// `(36)`, and what ends a part.
        end: String,
    },
}

impl<'t> Text<'t> {
    pub(super) fn new(options: &Crochet, out: &'t mut dyn Write) -> Self {
        let width = usize::from(options.line_width).max(24);
        Self { out: Out::Writer(out), width, prose: options.style == Style::Maker }
    }

    /// Collects lines instead of writing them.
    pub(super) fn collect(lines: &'t mut Vec<Line>) -> Self {
        Self { out: Out::Lines(lines), width: usize::MAX, prose: true }
    }

    /// A line that is read back.
    pub(super) fn line(&mut self, text: &str) -> io::Result<()> {
        match &mut self.out {
            Out::Writer(out) => return writeln!(out, "{text}"),
            Out::Lines(lines) => lines.push(Line::Code(text.to_owned())),
        }
        Ok(())
    }

    /// An empty line between sections, for people.
    pub(super) fn gap(&mut self) -> io::Result<()> {
        match &mut self.out {
            Out::Writer(out) if self.prose => return writeln!(out),
            Out::Writer(_) => {}
            Out::Lines(lines) => lines.push(Line::Gap),
        }
        Ok(())
    }

    /// A remark for people only; further lines are indented.
    pub(super) fn prose(&mut self, text: &str) -> io::Result<()> {
        if !self.prose {
            return Ok(());
        }
        let out = match &mut self.out {
            Out::Writer(out) => out,
            Out::Lines(lines) => {
                lines.push(Line::Prose(text.to_owned()));
                return Ok(());
            }
        };
        let mut line = String::from("//");
        let mut begun = false;
        for word in text.split_whitespace() {
            if begun && line.chars().count() + 1 + word.chars().count() > self.width {
                writeln!(out, "{line}")?;
                line = String::from("//  ");
            }
            line.push(' ');
            line.push_str(word);
            begun = true;
        }
        writeln!(out, "{line}")
    }
}

/// A name as the language reads it: bare when it is words that mean nothing else, else in quotes.
pub(super) fn name(name: &str, language: Language) -> String {
    let word = |(index, word): (usize, &str)| {
        let number = index > 0 && word.bytes().all(|byte| byte.is_ascii_digit());
        let letters =
            word.len() > 1 && word.bytes().all(|byte| byte.is_ascii_alphabetic()) && !language.knows(word);
        !word.is_empty() && (number || letters)
    };
    let bare = !name.is_empty() && name.split(' ').enumerate().all(word);
    if bare { name.to_owned() } else { format!("\"{}\"", clean(name).replace('"', "'")) }
}

/// Text in one line.
pub(super) fn clean(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// A color as rows name it: its own name when that is one capital letter, else the letter of its place.
pub(super) fn color(program: &Program, color: u16, language: Language) -> String {
    let letter = char::from(b'A' + (color % 26) as u8).to_string();
    let given = program.colors.get(usize::from(color)).map_or(letter.as_str(), String::as_str);
    // `A` is the English article, but a capital is a color; in letters it is a decrease.
    let free = |name: &str| language != Language::Letters && (name == "A" || !language.knows(name));
    match given {
        given if given.len() == 1 && given.bytes().all(|byte| byte.is_ascii_uppercase()) && free(given) => {
            given.to_owned()
        }
        given if given.contains(' ') => format!("\"{}\"", clean(given).replace('"', "'")),
        given => name(given, language),
    }
}

/// Name of a stitch that the language has no word for; the header defines it.
pub(super) fn special(kind: Kind, works: u16, makes: u16, terms: Terms) -> String {
    let letters = |count: u16| {
        let mut text = String::new();
        let mut rest = count;
        loop {
            text.insert(0, char::from(b'a' + (rest % 26) as u8));
            rest /= 26;
            if rest == 0 {
                return text;
            }
        }
    };
    let base = Language::English.abbreviation(kind, terms).replace(' ', "");
    format!("{base}-{}-{}", letters(works), letters(makes))
}

/// Writes a part.
pub(super) fn part(
    options: &Crochet,
    program: &Verified<'_>,
    index: usize,
    text: &mut Text<'_>,
) -> io::Result<()> {
    let (Some(part), Some(facts)) = (program.pattern.parts.get(index), program.facts().parts.get(index))
    else {
        return Ok(());
    };
    let words = Words::new(program, part, options.terms, options.language, options.arrows);
    text.gap()?;
    if program.pattern.parts.len() > 1 || part.copies > 1 || matches!(part.start, Start::Join { .. }) {
        text.line(&head(program, part, options.language))?;
    }
    start(part, &words, text)?;
    let (forms, prose) = (options.language.vocabulary().forms, options.language.vocabulary().prose);
    let rows = part.rows.len();
    let end = |place: usize| {
        let last = place + 1 == rows && part.finish == Finish::DrawnShut;
        if last { format!(", {}", forms.close) } else { String::new() }
    };
    let stuff = stuffing(part, facts);
    let mut explained = false;
    for (place, ((number, row), counts)) in part.numbered_rows().zip(&facts.rows).enumerate() {
        if counts.short_rows > 0 && !std::mem::replace(&mut explained, true) {
            explain_short_rows(options, text)?;
        }
        if stuff == Some(place) {
            text.prose(prose.stuff)?;
        }
        let begins = place == 0 && matches!(part.start, Start::Ring { loops: 0 });
        let (made, end) = (counts.produces, end(place));
        if options.style == Style::Paper {
            let body = words.plain_row(&row.body, begins);
            for round in 0..row.times {
                let label = label(part, number.saturating_add(round), 1, options.language);
                let end = if round + 1 == row.times { end.as_str() } else { "" };
                text.line(&format!("{label}: {body} ({made}){end}"))?;
            }
        } else {
            let label = label(part, number, row.times, options.language);
            let end = format!("({made}){end}");
            if let Out::Lines(lines) = &mut text.out {
                lines.push(Line::Round { part: index, row: place, label, begins, end });
            } else {
                let body = words.row(&row.body, begins);
                text.line(&format!("{label}: {body} {end}"))?;
            }
        }
    }
    finish(part, facts, &words, text)
}

/// `Rnd 7` or `Rnds 7-12`, `Row 7` in flat work.
fn label(part: &Part, number: u32, times: u32, language: Language) -> String {
    let forms = language.vocabulary().forms;
    let [one, several] = if part.flat { forms.row } else { forms.rnd };
    let space = if forms.glued && !part.flat { "" } else { " " };
    if times == 1 {
        format!("{one}{space}{number}")
    } else {
        format!("{several}{space}{number}-{}", number.saturating_add(times - 1))
    }
}

/// The line that opens a part.
fn head(program: &Program, part: &Part, language: Language) -> String {
    let forms = language.vocabulary().forms;
    let mut line = name(&part.name, language);
    if part.copies > 1 {
        let _ = write!(line, " ({})", fill(forms.make, &[("n", &part.copies.to_string())]));
    }
    line.push(':');
    let Start::Join { segments } = &part.start else { return line };
    let of = |id: &PartId| program.pattern.parts.get(id.0 as usize);
    if let Some(source) = source(segments).and_then(|id| of(&id)) {
        let own = program.pattern.parts.iter().position(|other| std::ptr::eq(other, part));
        let mut held = own.map_or_else(Vec::new, |own| holds(source, PartId(own as u32)));
        let [held_word, around] = forms.taken;
        let (from, source) = (forms.origin[1], name(&source.name, language));
        let _ = write!(line, " {from} {source}");
        if held.iter().any(|(_, first, _)| *first == 0) {
            // Loops of a short row are of no round below.
            let _ = write!(line, " {held_word}");
            return line;
        }
        held.reverse();
        let noun =
            if language == Language::German { forms.rnd[0].to_owned() } else { forms.rnd[0].to_lowercase() };
        let [one, several] = forms.st;
        let mut before = None;
        for segment in segments {
            let (how, spot) = match segment {
                Segment::Surface { round, first, loops, back, .. } => {
                    let last = first.saturating_add(loops.saturating_sub(1));
                    (around, Some(if *back { (*round, last, *first) } else { (*round, *first, last) }))
                }
                Segment::Held { .. } => (held_word, held.pop()),
                Segment::Open { .. } | Segment::Chain { .. } => continue,
            };
            let Some((round, first, last)) = spot else { continue };
            if let Some(before) = before.replace(how) {
                if before != how {
                    let _ = write!(line, " {before}");
                }
                line.push(',');
            }
            let _ = match last {
                last if last == first => write!(line, " {noun} {round} {one} {first}"),
                last => write!(line, " {noun} {round} {several} {first}-{last}"),
            };
        }
        let _ = write!(line, " {}", before.unwrap_or_default());
        return line;
    }
    // The chain between two parts is worked on both sides, so its second side is not written.
    let segments = match segments.as_slice() {
        [first @ .., Segment::Chain { loops }] if matches!(first, [Segment::Open { .. }, Segment::Chain { loops: between }, Segment::Open { .. }] if between == loops) => {
            first
        }
        all => all,
    };
    // Where the second side is not worked, a chain of nothing says so.
    let one_side = matches!(segments, [Segment::Open { .. }, Segment::Chain { .. }, Segment::Open { .. }])
        && matches!(&part.start, Start::Join { segments } if segments.len() == 3);
    let chain = language.abbreviation(Kind::Ch, Terms::Us);
    let end = one_side.then(|| format!("{chain} 0"));
    let pieces = segments.iter().map(|segment| match segment {
        Segment::Chain { loops } => format!("{chain} {loops}"),
        Segment::Open { part, .. } | Segment::Held { part, .. } | Segment::Surface { part, .. } => {
            of(part).map_or_else(String::new, |part| name(&part.name, language))
        }
    });
    let _ = write!(line, " {} {}", forms.origin[0], pieces.chain(end).collect::<Vec<_>>().join(" + "));
    line
}

/// The part that a start picks its loops up from, held or around stitches, when there is one such part and nothing else.
fn source(segments: &[Segment]) -> Option<PartId> {
    let picked = |segment: &Segment| match segment {
        Segment::Held { part, .. } | Segment::Surface { part, .. } => Some(*part),
        Segment::Open { .. } | Segment::Chain { .. } => None,
    };
    let first = segments.first().and_then(picked)?;
    segments.iter().all(|segment| picked(segment) == Some(first)).then_some(first)
}

/// Where a part holds loops for another: the round below, first and last of its loops.
fn holds(part: &Part, by: PartId) -> Vec<(u32, u32, u32)> {
    let mut places = Vec::new();
    for (number, row) in part.numbered_rows() {
        // A short row over chains may give back more than the row has used up.
        let mut worked = 0_i64;
        let place = |worked: i64| u32::try_from(worked).unwrap_or(0);
        let mut direction = crate::ir::Direction::Forward;
        for step in row.body.steps() {
            match step {
                Step::Work(stitch) if direction == crate::ir::Direction::Forward => {
                    worked += i64::from(stitch.works);
                }
                Step::Work(stitch) => worked -= i64::from(stitch.makes),
                Step::Turn(new) => direction = new,
                Step::Hold { loops, by: taker } => {
                    if taker == by {
                        let (first, last) = (place(worked + 1), place(worked + i64::from(loops)));
                        places.push((number.saturating_sub(1), first, last));
                    }
                    worked += i64::from(loops);
                }
                Step::Leave { .. } | Step::Color(_) => {}
            }
        }
    }
    places
}

fn start(part: &Part, words: &Words<'_>, text: &mut Text<'_>) -> io::Result<()> {
    let vocabulary = words.language.vocabulary();
    let (forms, prose) = (vocabulary.forms, vocabulary.prose);
    let slip = words.base(Kind::SlSt);
    match part.start {
        // The first row says what goes into the ring.
        Start::Ring { loops: 0 } | Start::Chain { loops: 0, joined: false } => Ok(()),
        Start::Join { ref segments } => pick_up(words, part, segments, text),
        Start::Ring { loops } => {
            let space = if forms.glued { "" } else { " " };
            let stitch = format!("{loops}{space}{}", words.base(Kind::Sc));
            let body = fill(forms.in_ring, &[("stitch", &stitch)]);
            let shut = part.rows.is_empty() && part.finish == Finish::DrawnShut;
            let end = if shut { format!(", {}", forms.close) } else { String::new() };
            text.line(&format!("{}: {body} ({loops}){end}", label(part, 1, 1, words.language)))
        }
        Start::Chain { loops, joined: true } => {
            text.line(&fill(forms.tube, &[("n", &loops.to_string()), ("slip", slip)]))?;
            text.prose(prose.twist)
        }
        Start::Chain { loops, joined: false } => {
            text.line(&fill(forms.foundation, &[("n", &loops.to_string())]))
        }
    }
}

/// Says how the first loops of a part are picked up.
fn pick_up(words: &Words<'_>, part: &Part, segments: &[Segment], text: &mut Text<'_>) -> io::Result<()> {
    if words.language != Language::English {
        return Ok(());
    }
    let held = segments.iter().any(|segment| matches!(segment, Segment::Held { .. }));
    let around = segments.iter().any(|segment| matches!(segment, Segment::Surface { .. }));
    let source_part = source(segments).and_then(|id| words.program.pattern.parts.get(id.0 as usize));
    let Some(source) = source_part.map(|part| name(&part.name, words.language)) else { return Ok(()) };
    let own = words.program.pattern.parts.iter().position(|other| std::ptr::eq(other, part));
    let places = match (own, source_part) {
        (Some(own), Some(source)) => holds(source, PartId(own as u32)),
        _ => Vec::new(),
    };
    let rounds: Vec<u32> = places.iter().map(|(round, ..)| *round).collect();
    text.prose(&if rounds.first() != rounds.last() {
        format!(
            "Join the yarn at the first held stitch of {source}, where its chain ends. Round 1 goes into the held stitches in \
             this order; the chain comes last and leads back to where the round began."
        )
    } else if held && around {
        format!(
            "Join the yarn at the first held stitch of {source}. Round 1 goes into the held stitches, then into the other \
             side of the chains above them, back to where it began."
        )
    } else if held {
        format!("Join the yarn at the first held stitch of {source}. Round 1 goes into the held stitches.")
    } else {
        format!(
            "Join the yarn to the outside of {source}. Work round 1 around the posts of the stitches named, in this order, \
             which leads once around; a stitch that is named twice gets two. There is nothing to sew."
        )
    })
}

/// The row before which a closed piece is stuffed: the first behind the widest with fewer than 12 stitches or less than
/// a third of the greatest width.
fn stuffing(part: &Part, facts: &PartFacts) -> Option<usize> {
    if part.finish != Finish::DrawnShut || part.flat {
        return None;
    }
    let most = facts.rows.iter().map(|row| row.produces).max()?;
    let widest = facts.rows.iter().rposition(|row| row.produces == most)?;
    let small = |row: &RowFacts| row.produces < 12 || row.produces * 3 < most;
    facts.rows.iter().skip(widest).position(small).map(|after| widest + after)
}

fn explain_short_rows(options: &Crochet, text: &mut Text<'_>) -> io::Result<()> {
    let prose = options.language.vocabulary().prose;
    let [back, forward] = match options.arrows {
        Arrows::Unicode => ["←", "→"],
        Arrows::Ascii => ["<-", "->"],
        Arrows::Words => return text.prose(prose.short_rows_words),
    };
    text.prose(&fill(prose.short_rows, &[("back", back), ("forward", forward)]))
}

fn finish(part: &Part, facts: &PartFacts, words: &Words<'_>, text: &mut Text<'_>) -> io::Result<()> {
    let vocabulary = words.language.vocabulary();
    let prose = vocabulary.prose;
    let slip = words.base(Kind::SlSt);
    let left = facts.rows.last().map_or(0, |row| row.left);
    let stitches = prose.stitches[usize::from(left != 1)];
    text.prose(&match part.finish {
        Finish::DrawnShut => fill(prose.shut, &[("n", &facts.open.to_string())]),
        Finish::Open if part.flat => prose.fasten_off.to_owned(),
        // All stitches are held for others: there is no rim.
        Finish::Open if facts.open == 0 && words.language == Language::English => format!(
            "Here the work divides, and no stitch is left over. Fasten the end of the chain to the next open stitch with a \
             {slip} and fasten off; every held stitch stays open."
        ),
        Finish::Open if facts.open == 0 => prose.fasten_off.to_owned(),
        Finish::Open if left > 0 => {
            fill(prose.step_down, &[("n", &left.to_string()), ("st", stitches), ("slip", slip)])
        }
        Finish::Open => fill(prose.level, &[("slip", slip)]),
    })
}

/// What a pattern makes use of, for its list of abbreviations and its notes.
#[derive(Default)]
#[expect(clippy::struct_excessive_bools, reason = "each says of one thing whether it occurs")]
pub(super) struct Uses {
    pub(super) kinds: Vec<Kind>,
    pub(super) increase: bool,
    pub(super) decrease: bool,
    pub(super) short_rows: bool,
    pub(super) left: bool,
    pub(super) held: bool,
    pub(super) repeats: bool,
    pub(super) special: Vec<(Kind, u16, u16)>,
}

impl Uses {
    pub(super) fn of(program: &Program) -> Self {
        let mut uses = Self::default();
        for part in &program.pattern.parts {
            let rows = part.rows.len();
            for (index, row) in part.rows.iter().enumerate() {
                let mut place = Place {
                    last: index + 1 == rows,
                    ring: index == 0 && matches!(part.start, Start::Ring { loops: 0 }),
                    stands: super::words::stands(&row.body),
                    worked: false,
                };
                uses.block(&row.body, &mut place);
            }
            match part.start {
                Start::Ring { .. } => uses.kind(Kind::Sc),
                Start::Chain { joined, .. } => {
                    uses.kind(Kind::Ch);
                    if joined {
                        uses.kind(Kind::SlSt);
                    }
                }
                Start::Join { .. } => {}
            }
        }
        uses.kinds.sort_unstable();
        uses
    }

    fn kind(&mut self, kind: Kind) {
        if !self.kinds.contains(&kind) {
            self.kinds.push(kind);
        }
    }

    fn block(&mut self, block: &crate::ir::Block, place: &mut Place) {
        for op in block.ops() {
            match op {
                Op::Work { stitch, .. } => {
                    self.kind(stitch.kind);
                    self.stitch(*stitch, place);
                    let loose =
                        stitch.works + stitch.makes == 0 && matches!(stitch.kind, Kind::Ch | Kind::SlSt);
                    place.worked |= !loose;
                }
                Op::Repeat { body, .. } => {
                    self.repeats = true;
                    self.block(body, place);
                }
                Op::Turn(_) => self.short_rows = true,
                Op::Leave { .. } => self.left |= !place.last,
                Op::Hold { .. } => {
                    place.worked = true;
                    self.held = true;
                }
                Op::Color(_) => {}
            }
        }
    }

    fn stitch(&mut self, stitch: Stitch, place: &Place) {
        let arity = (stitch.works, stitch.makes);
        let chain = stitch.kind == Kind::Ch;
        let said = super::words::is_common(stitch.kind, arity)
            || (arity == (0, 1)
                && stitch.kind != Kind::Special
                && (place.ring || place.worked || chain || stitch.entry == Entry::Space))
            || (arity == (1, 1) && chain && place.stands && !place.worked)
            || (arity == (0, 0) && stitch.kind == Kind::SlSt);
        match arity {
            _ if !said => {
                let special = (stitch.kind, stitch.works, stitch.makes);
                if !self.special.contains(&special) {
                    self.special.push(special);
                }
            }
            (1, makes) if makes > 1 => self.increase = true,
            (works, 1) if works > 1 => self.decrease = true,
            _ => {}
        }
    }
}

/// Where in its row a stitch stands.
#[expect(clippy::struct_excessive_bools, reason = "each says of one thing whether it is so")]
struct Place {
    /// The row is the last of its part.
    last: bool,
    /// It begins the part in a ring.
    ring: bool,
    /// It begins with a chain that stands for a stitch.
    stands: bool,
    /// Something was worked already.
    worked: bool,
}

/// Widest row of all parts, in stitches.
pub(super) fn widest(program: &Verified<'_>) -> u32 {
    let rows = program.facts().parts.iter().flat_map(|part| &part.rows);
    rows.map(|row: &RowFacts| row.produces)
        .chain(program.facts().parts.iter().map(|part| part.start))
        .max()
        .unwrap_or(0)
}

/// True when some row of the program is worked in rounds.
pub(super) fn spiral(program: &Program) -> bool {
    program.pattern.parts.iter().any(|part| !part.flat && part.rows.iter().any(|row: &Row| row.times > 0))
}
