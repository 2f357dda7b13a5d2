//! Parts, start lines, rounds, and what is to do between and after them.

use super::words::Words;
use super::{Arrows, Crochet, Style, Terms};
use crate::ir::verify::{PartFacts, RowFacts, Verified};
use crate::ir::{Finish, Kind, Op, Part, PartId, Program, Row, Segment, Start, Step};
use std::fmt::Write as _;
use std::io::{self, Write};

/// Lines under way: rounds as they are, prose wrapped behind `//`.
pub(super) struct Text<'t> {
    out: &'t mut dyn Write,
    width: usize,
    prose: bool,
}

impl<'t> Text<'t> {
    pub(super) fn new(options: &Crochet, out: &'t mut dyn Write) -> Self {
        let width = usize::from(options.line_width).max(24);
        Self { out, width, prose: options.style == Style::Maker }
    }

    /// A line that is read back.
    pub(super) fn line(&mut self, text: &str) -> io::Result<()> {
        writeln!(self.out, "{text}")
    }

    /// An empty line between sections, for people.
    pub(super) fn gap(&mut self) -> io::Result<()> {
        if self.prose { writeln!(self.out) } else { Ok(()) }
    }

    /// A remark for people only; further lines are indented.
    pub(super) fn prose(&mut self, text: &str) -> io::Result<()> {
        if !self.prose {
            return Ok(());
        }
        let mut line = String::from("//");
        let mut begun = false;
        for word in text.split_whitespace() {
            if begun && line.chars().count() + 1 + word.chars().count() > self.width {
                writeln!(self.out, "{line}")?;
                line = String::from("//  ");
            }
            line.push(' ');
            line.push_str(word);
            begun = true;
        }
        writeln!(self.out, "{line}")
    }
}

/// A name as the language reads it: bare when it is words, else in quotes.
pub(super) fn name(name: &str) -> String {
    let bare = name.chars().all(|c| c.is_alphanumeric() || c == ' ')
        && name.starts_with(char::is_alphabetic)
        && !name.ends_with(' ')
        && !name.contains("  ");
    if bare { name.to_owned() } else { format!("\"{}\"", clean(name).replace('"', "'")) }
}

/// Text in one line.
pub(super) fn clean(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// A color as rows name it: its own name when that is one capital letter, else the letter of its place.
pub(super) fn color(program: &Program, color: u16) -> String {
    match program.colors.get(usize::from(color)).map(String::as_str) {
        Some(name) if name.len() == 1 && name.chars().all(|c| c.is_ascii_uppercase()) => name.to_owned(),
        Some(given) => name(given),
        None => char::from(b'A' + (color % 26) as u8).to_string(),
    }
}

/// Name of a stitch that the language has no word for; the header defines it.
pub(super) fn special(kind: Kind, works: u16, makes: u16) -> String {
    let letter = |count: u16| char::from(b'a' + (count % 26) as u8);
    format!("{}-{}-{}", kind.us().replace(' ', "-"), letter(works), letter(makes))
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
    let words = Words::new(program, part, options.terms, options.arrows);
    text.gap()?;
    if program.pattern.parts.len() > 1 || part.copies > 1 || matches!(part.start, Start::Join { .. }) {
        text.line(&head(program, part))?;
    }
    start(part, &words, text)?;
    let stuff = stuffing(part, facts);
    let mut explained = false;
    for (place, ((number, row), counts)) in part.numbered_rows().zip(&facts.rows).enumerate() {
        if counts.short_rows > 0 && !std::mem::replace(&mut explained, true) {
            explain_short_rows(options, text)?;
        }
        if stuff == Some(place) {
            text.prose(
                "Stuff firmly now, before the opening gets small, and a little more as you close it.",
            )?;
        }
        if options.style == Style::Paper {
            let body = words.plain_row(&row.body);
            for round in 0..row.times {
                let label = label(part, number.saturating_add(round), 1);
                text.line(&format!("{label}: {body} ({})", counts.produces))?;
            }
        } else {
            let body = words.row(&row.body);
            text.line(&format!("{}: {body} ({})", label(part, number, row.times), counts.produces))?;
        }
    }
    finish(part, facts, &words, text)
}

/// `Rnd 7` or `Rnds 7-12`, `Row 7` in flat work.
fn label(part: &Part, number: u32, times: u32) -> String {
    let kind = if part.flat { "Row" } else { "Rnd" };
    if times == 1 {
        format!("{kind} {number}")
    } else {
        format!("{kind}s {number}-{}", number.saturating_add(times - 1))
    }
}

/// The line that opens a part.
fn head(program: &Program, part: &Part) -> String {
    let mut line = name(&part.name);
    if part.copies > 1 {
        let _ = write!(line, " (make {})", part.copies);
    }
    line.push(':');
    let Start::Join { segments } = &part.start else { return line };
    let of = |id: &PartId| program.pattern.parts.get(id.0 as usize);
    let from = |segment: &Segment| match segment {
        Segment::Held { part, .. } | Segment::Surface { part, .. } => of(part),
        Segment::Open { .. } | Segment::Chain { .. } => None,
    };
    if let Some(source) = segments.first().and_then(from) {
        let mut held = program
            .pattern
            .parts
            .iter()
            .position(|other| std::ptr::eq(other, part))
            .map_or_else(Vec::new, |own| holds(source, PartId(own as u32)));
        held.reverse();
        let mut how = "held";
        let places = segments.iter().filter_map(|segment| match segment {
            Segment::Held { .. } => held.pop(),
            Segment::Surface { round, first, loops, .. } => {
                how = "surface";
                Some((*round, *first, first.saturating_add(loops.saturating_sub(1))))
            }
            Segment::Open { .. } | Segment::Chain { .. } => None,
        });
        let places: Vec<String> = places
            .map(|(round, first, last)| match last {
                last if last == first => format!("rnd {round} st {first}"),
                last => format!("rnd {round} sts {first}-{last}"),
            })
            .collect();
        let _ = write!(line, " from {} {} {how}", name(&source.name), places.join(", "));
        return line;
    }
    // The chain between two parts is worked on both sides, so its second side is not written.
    let segments = match segments.as_slice() {
        [first @ .., Segment::Chain { loops }] if matches!(first, [Segment::Open { .. }, Segment::Chain { loops: between }, Segment::Open { .. }] if between == loops) => {
            first
        }
        all => all,
    };
    let pieces = segments.iter().map(|segment| match segment {
        Segment::Chain { loops } => format!("ch {loops}"),
        Segment::Open { part, .. } | Segment::Held { part, .. } | Segment::Surface { part, .. } => {
            of(part).map_or_else(String::new, |part| name(&part.name))
        }
    });
    let _ = write!(line, " join {}", pieces.collect::<Vec<_>>().join(" + "));
    line
}

/// Where a part holds loops for another: the round below, first and last of its loops.
fn holds(part: &Part, by: PartId) -> Vec<(u32, u32, u32)> {
    let mut places = Vec::new();
    for (number, row) in part.numbered_rows() {
        let mut worked = 0_u32;
        let mut direction = crate::ir::Direction::Forward;
        for step in row.body.steps() {
            match step {
                Step::Work(stitch) if direction == crate::ir::Direction::Forward => {
                    worked = worked.saturating_add(stitch.works.into());
                }
                Step::Work(stitch) => worked = worked.saturating_sub(stitch.makes.into()),
                Step::Turn(new) => direction = new,
                Step::Hold { loops, by: taker } => {
                    if taker == by {
                        places.push((number.saturating_sub(1), worked + 1, worked.saturating_add(loops)));
                    }
                    worked = worked.saturating_add(loops);
                }
                Step::Leave { .. } | Step::Color(_) => {}
            }
        }
    }
    places
}

fn start(part: &Part, words: &Words<'_>, text: &mut Text<'_>) -> io::Result<()> {
    match part.start {
        Start::Ring { loops } => {
            let sc = words.base(Kind::Sc);
            text.line(&format!("Rnd 1: {loops} {sc} in magic ring ({loops})"))
        }
        Start::Chain { loops, joined: true } => {
            text.line(&format!("Ch {loops}, join with a sl st to form a ring"))?;
            text.prose("Take care that the chain is not twisted. The first round is worked into its chains.")
        }
        Start::Chain { loops, joined: false } => text.line(&format!("Ch {loops}")),
        Start::Join { .. } => Ok(()),
    }
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
    let (back, forward) = match options.arrows {
        Arrows::Unicode => ("At ←", "at →"),
        Arrows::Ascii => ("At <-", "at ->"),
        Arrows::Words => ("At the first turn", "at the second"),
    };
    let sign = if options.arrows == Arrows::Words { "" } else { " (the ones with a minus)" };
    text.prose(&format!(
        "Short rows: {back} turn the work and go back over the stitches just made{sign}; {forward} turn again \
         and go on, over these stitches first. Turn without a chain. Each turn leaves a step of one row; on the next \
         round, put the hook through the edge of the turned row too as you work the stitch at the step, so that no hole stays."
    ))
}

fn finish(part: &Part, facts: &PartFacts, words: &Words<'_>, text: &mut Text<'_>) -> io::Result<()> {
    let slip = words.base(Kind::SlSt);
    let left = facts.rows.last().map_or(0, |row| row.left);
    text.prose(&match part.finish {
        Finish::DrawnShut => format!(
            "Cut the yarn. Thread the tail through the front loops of the last {} stitches, pull tight and weave it in.",
            facts.open
        ),
        Finish::Open if part.flat => "Fasten off and weave in the ends.".to_owned(),
        Finish::Open if left > 0 => format!(
            "The yarn ends {left} {} before the marker. Work a {slip} into each of the next 2 stitches to step down to the \
             round below, fasten off and weave in the ends.",
            if left == 1 { "stitch" } else { "stitches" }
        ),
        Finish::Open => format!(
            "Work a {slip} into the next stitch to level the edge, fasten off and weave in the ends."
        ),
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
    pub(super) repeats: bool,
    pub(super) special: Vec<(Kind, u16, u16)>,
}

impl Uses {
    pub(super) fn of(program: &Program) -> Self {
        let mut uses = Self::default();
        for part in &program.pattern.parts {
            let rows = part.rows.len();
            for (index, row) in part.rows.iter().enumerate() {
                uses.block(&row.body, index + 1 == rows);
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

    fn block(&mut self, block: &crate::ir::Block, last: bool) {
        for op in block.ops() {
            match op {
                Op::Work { stitch, .. } => {
                    self.kind(stitch.kind);
                    let own = (stitch.kind.works(), stitch.kind.makes());
                    match (stitch.works, stitch.makes) {
                        arity if arity == own => {}
                        (1, makes) if makes > 1 => self.increase = true,
                        (works, 1) if works > 1 => self.decrease = true,
                        (0, 1) => {}
                        _ if matches!(stitch.kind, Kind::Skip | Kind::Ch | Kind::SlSt) => {}
                        (works, makes) => {
                            let special = (stitch.kind, works, makes);
                            if !self.special.contains(&special) {
                                self.special.push(special);
                            }
                        }
                    }
                }
                Op::Repeat { body, .. } => {
                    self.repeats = true;
                    self.block(body, last);
                }
                Op::Turn(_) => self.short_rows = true,
                Op::Leave { .. } => self.left |= !last,
                Op::Hold { .. } | Op::Color(_) => {}
            }
        }
    }
}

/// Widest row of all parts, in stitches.
pub(super) fn widest(program: &Verified<'_>) -> u32 {
    let rows = program.facts().parts.iter().flat_map(|part| &part.rows);
    rows.map(|row: &RowFacts| row.produces)
        .chain(program.facts().parts.iter().map(|part| part.start))
        .max()
        .unwrap_or(0)
}

/// `single crochet` in the terms of the text.
pub(super) fn full_name(kind: Kind, terms: Terms) -> &'static str {
    match terms {
        Terms::Us => kind.us_name(),
        Terms::Uk => kind.uk_name(),
    }
}

/// True when some row of the program is worked in rounds.
pub(super) fn spiral(program: &Program) -> bool {
    program.pattern.parts.iter().any(|part| !part.flat && part.rows.iter().any(|row: &Row| row.times > 0))
}
