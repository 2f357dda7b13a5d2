//! The signs in use with their names in US and UK terms, and how the chart is read.

use super::super::crochet::Terms;
use super::pen::{Escaped, N, P, Path};
use super::sheet::{ACCENT, UNIT};
use super::{Svg, symbols};
use crate::ir::verify::Verified;
use crate::ir::{Block, Entry, Hand, Kind, Op, Start, Stitch};
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// Which kinds of chart there are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reading {
    pub(super) spirals: bool,
    pub(super) unrolled: bool,
    pub(super) back: bool,
}

/// The drawn legend and its extents.
#[derive(Debug)]
pub(super) struct Legend {
    pub(super) body: String,
    pub(super) width: f64,
    pub(super) below: f64,
}

const LINE: f64 = 24.0;

/// Draws the legend at a height, in as many columns as fit the width.
pub(super) fn draw(options: &Svg, program: &Verified<'_>, reading: Reading, width: f64, top: f64) -> Legend {
    let uses = uses(program);
    let entries: Vec<(Stitch, String)> =
        uses.iter().map(|stitch| (*stitch, words(*stitch, options.terms))).collect();
    let longest = entries.iter().map(|(_, words)| words.chars().count()).max().unwrap_or(0) as f64;
    let column = 52.0 + longest * 6.2;
    let columns = ((width - 32.0) / column).floor().max(1.0) as usize;
    let rows = entries.len().div_ceil(columns).max(1);
    let mut body = format!(
        "<g id=\"legend\" font-size=\"12\" fill=\"currentColor\">\n<text x=\"16\" y=\"{}\" font-weight=\"bold\">Legend</text>\n",
        N(top + 10.0)
    );
    for (index, (stitch, words)) in entries.iter().enumerate() {
        let x = 16.0 + column * (index / rows) as f64;
        let y = top + 22.0 + LINE * (index % rows) as f64;
        let (low, high) = (y + 17.0, y + 17.0 - UNIT);
        let spread = |count: u16, y: f64| -> Vec<P> {
            let middle = (f64::from(count.min(4)) - 1.0) / 2.0;
            (0..count.min(4)).map(|nth| P(x + 16.0 + (f64::from(nth) - middle) * 12.0, y)).collect()
        };
        let tall = high - (symbols::height(stitch.kind) - 1.0).min(0.5) * UNIT;
        let base = if stitch.makes == 0 { vec![P(x + 16.0, tall)] } else { spread(stitch.works.max(1), low) };
        let mut path = Path::default();
        let up = P(0.0, -1.0);
        let unit = UNIT / symbols::height(stitch.kind).max(1.0).sqrt();
        let filled = symbols::draw(
            *stitch,
            options.sc_symbol,
            &base,
            &spread(stitch.makes, tall),
            up,
            unit,
            &mut path,
        );
        let fill = if filled { "currentColor" } else { "none" };
        let _ = writeln!(
            body,
            "<path fill=\"{fill}\" stroke=\"currentColor\" stroke-width=\"1.25\" stroke-linecap=\"round\" d=\"{}\"/>\
             <text x=\"{}\" y=\"{}\">{}</text>",
            path.data(),
            N(x + 40.0),
            N(y + 13.0),
            Escaped(words)
        );
    }
    let mut below = top + 22.0 + LINE * rows as f64 + 12.0;
    let mut widest = 32.0 + column * entries.len().div_ceil(rows) as f64;
    let mut say = |text: &str, accent: bool| {
        let color = if accent { format!(" fill=\"{ACCENT}\"") } else { String::new() };
        for line in wrapped(text, ((width - 32.0) / 5.6).max(60.0) as usize) {
            widest = widest.max(32.0 + line.chars().count() as f64 * 5.8);
            let _ = writeln!(
                body,
                "<text x=\"16\" y=\"{}\" font-size=\"11\"{color}>{}</text>",
                N(below + 4.0),
                Escaped(&line)
            );
            below += 15.0;
        }
    };
    let left = program.maker.hand == Hand::Left;
    if reading.spirals {
        let way = if left { "clockwise, as left-handed" } else { "counterclockwise, as right-handed" };
        let text = format!(
            "Read the spiral from the middle outward and {way} crochet grows. A round begins at its number; its stitch count is \
             in parentheses."
        );
        say(&text, false);
    }
    if reading.unrolled && left {
        say("For left-handed work: rounds are drawn from left to right, as the left hand works them.", false);
    }
    if reading.unrolled {
        say(
            "Read upward, in the direction of the arrows, the right side facing; a round without an arrow runs from left to right, \
             like the text. Its number stands at its beginning, its stitch count at its end.",
            false,
        );
    }
    if reading.back {
        say(
            "Short rows stand above their round: \u{2190} turn and go back, \u{2192} turn again and go on, over them first.",
            true,
        );
    }
    body.push_str("</g>\n");
    Legend { body, width: widest, below }
}

/// A text in lines of so many characters.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let full = lines
            .last()
            .is_some_and(|line| !line.is_empty() && line.chars().count() + word.chars().count() >= width);
        if full {
            lines.push(String::new());
        }
        if let Some(line) = lines.last_mut() {
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
    }
    lines
}

/// The different stitches of a program.
fn uses(program: &Verified<'_>) -> BTreeSet<Stitch> {
    fn block(body: &Block, uses: &mut BTreeSet<Stitch>) {
        for op in body.ops() {
            match op {
                Op::Work { stitch, .. } if stitch.kind != Kind::Skip => {
                    // Stitches worked in the same place as the one before look like any other of their kind.
                    let works = if stitch.works == 0 && stitch.makes > 0 { 1 } else { stitch.works };
                    uses.insert(Stitch { works, ..*stitch });
                }
                Op::Repeat { body, .. } => block(body, uses),
                Op::Work { .. } | Op::Turn(_) | Op::Hold { .. } | Op::Leave { .. } | Op::Color(_) => {}
            }
        }
    }
    let mut uses = BTreeSet::new();
    for part in &program.pattern.parts {
        match part.start {
            Start::Ring { loops: 1.. } => drop(uses.insert(Stitch::SC)),
            Start::Chain { loops: 1.., .. } => drop(uses.insert(Stitch::plain(Kind::Ch))),
            Start::Ring { .. } | Start::Chain { .. } | Start::Join { .. } => {}
        }
        part.rows.iter().for_each(|row| block(&row.body, &mut uses));
    }
    uses
}

/// `sc single crochet (UK dc double crochet)`.
fn words(stitch: Stitch, terms: Terms) -> String {
    let Stitch { kind, works, makes, entry } = stitch;
    let form = |short: &str, name: &str| match (works, makes) {
        (works, makes) if (works, makes) == (kind.works(), kind.makes()) => format!("{short} = {name}"),
        (1, 2) if kind == Kind::Sc => format!("inc = 2 {short} in one stitch"),
        (1, makes) if makes > 1 => format!("{makes} {short} in one stitch"),
        (2, 1) if kind == Kind::Sc => format!("dec = 2 {short} worked together"),
        (works, 1) if works > 1 => format!("{works} {short} worked together"),
        _ => format!("{short} = {name}"),
    };
    let (us, uk) = (form(kind.us(), kind.us_name()), form(kind.uk(), kind.uk_name()));
    let place = match entry {
        Entry::Both => "",
        Entry::Front => ", front loop only",
        Entry::Back => ", back loop only",
        Entry::Space => ", into the chain space",
    };
    let (first, second, tag) = match terms {
        Terms::Us => (us, uk, "UK"),
        Terms::Uk => (uk, us, "US"),
    };
    if first == second { format!("{first}{place}") } else { format!("{first}{place} ({tag}: {second})") }
}
