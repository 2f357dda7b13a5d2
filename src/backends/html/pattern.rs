//! The pattern as a list to print and to tick off; each run of stitches tells which stitches it stands for.

use crate::backends::crochet::words::Words;
use crate::backends::crochet::{Arrows, Crochet, Line};
use crate::backends::svg::pen::Escaped;
use crate::ir::verify::Verified;
use crate::ir::{Block, Language, Op, Terms};
use std::fmt::Write as _;

/// Writes the pattern: what it needs, then its rounds.
pub(super) fn write(program: &Verified<'_>, terms: Terms, out: &mut String) {
    let options = Crochet { terms, ..Crochet::default() };
    let (lines, head) = options.lines(program);
    out.push_str("<div class=\"needs\">\n");
    for line in lines.iter().take(head) {
        need(line, out);
    }
    out.push_str("</div>\n<div class=\"rounds\">\n");
    let mut list = false;
    for (index, line) in lines.iter().enumerate().skip(head) {
        let ring = ring(line).and_then(|words| Some((part_of(&lines[index..])?, words)));
        let round = ring.is_some() || matches!(line, Line::Round { .. });
        if round != list {
            out.push_str(if round { "<ol class=\"list\">\n" } else { "</ol>\n" });
            list = round;
        }
        if let Some((part, (label, rest))) = ring {
            begin(part, "-1", "round", label, out);
            let (words, count) = rest.rsplit_once(" (").unwrap_or((rest, ""));
            let count = count.strip_suffix(')').unwrap_or(count);
            let _ = writeln!(out, "{} <b class=\"count\">({})</b></li>", Escaped(words), Escaped(count));
            continue;
        }
        match line {
            Line::Gap => {}
            Line::Prose(text) => {
                let _ = writeln!(out, "<p class=\"remark\">{}</p>", Escaped(text));
            }
            Line::Code(text) => {
                let _ = writeln!(out, "<p class=\"step\">{}</p>", Escaped(text));
            }
            Line::Round { part, row, label, begins, end } => {
                item(program, terms, (*part, *row), label, *begins, end, out);
            }
        }
    }
    out.push_str(if list { "</ol>\n</div>\n" } else { "</div>\n" });
}

/// Label and words of the round that is worked in a magic ring.
fn ring(line: &Line) -> Option<(&str, &str)> {
    let Line::Code(text) = line else { return None };
    let (label, rest) = text.split_once(": ")?;
    let number = label.split_whitespace().next_back()?;
    (number == "1" && rest.ends_with(')')).then_some((label, rest))
}

/// The part that the next round belongs to.
fn part_of(lines: &[Line]) -> Option<usize> {
    lines.iter().find_map(|line| match line {
        Line::Round { part, .. } => Some(*part),
        Line::Code(_) | Line::Prose(_) | Line::Gap => None,
    })
}

/// A box to tick and the label of a round.
fn begin(part: usize, row: &str, class: &str, label: &str, out: &mut String) {
    let _ = write!(
        out,
        "<li class=\"{class}\" id=\"l{part}-{row}\" data-part=\"{part}\" data-row=\"{row}\"><input type=\"checkbox\" \
         aria-label=\"{0} done\"> <button type=\"button\" class=\"rnd\">{0}</button>: ",
        Escaped(label)
    );
}

/// A line of the head: `Materials: this; that.` becomes a heading with a list.
fn need(line: &Line, out: &mut String) {
    let (Line::Prose(text) | Line::Code(text)) = line else { return };
    let (title, rest) = text.split_once(": ").unwrap_or(("", text));
    match (line, title) {
        // The page shows the name and has its own reader.
        (Line::Code(_), "title" | "convention" | "lean") => {}
        (Line::Code(_), "terms") => {
            let _ = writeln!(out, "<p><b>Terms</b> {}</p>", Escaped(&rest.to_uppercase()));
        }
        (Line::Code(_), "gauge") => {
            let _ = writeln!(out, "<p><b>Gauge</b> {}</p>", Escaped(rest));
        }
        (_, title) if title == "Materials" || title.starts_with("Abbreviations") => {
            let _ = write!(out, "<p><b>{}</b></p><ul>", Escaped(title));
            for item in rest.trim_end_matches('.').split("; ") {
                let _ = write!(out, "<li>{}</li>", Escaped(item));
            }
            out.push_str("</ul>\n");
        }
        (_, "Finished size") => {
            let _ = writeln!(out, "<p><b>Finished size</b> {}</p>", Escaped(rest));
        }
        _ => {
            let _ = writeln!(out, "<p class=\"remark\">{}</p>", Escaped(text));
        }
    }
}

fn item(
    program: &Verified<'_>,
    terms: Terms,
    (part, row): (usize, usize),
    label: &str,
    begins: bool,
    end: &str,
    out: &mut String,
) {
    let (Some(facts), Some(of)) = (program.facts().parts.get(part), program.pattern.parts.get(part)) else {
        return;
    };
    let (Some(counts), Some(body)) = (facts.rows.get(row), of.rows.get(row)) else { return };
    let class = if counts.short_rows > 0 { "round short" } else { "round" };
    begin(part, &row.to_string(), class, label, out);
    let words = Words::new(program, of, terms, Language::English, Arrows::Unicode);
    let (text, places) = words.runs(&body.body, begins);
    let mut runs = Vec::new();
    steps(&body.body, 0, &mut Vec::new(), &mut runs);
    let mut written = 0;
    for (run, place) in runs.iter().zip(places) {
        let Some(words) = text.get(place.clone()) else { continue };
        let skipped = words.len() - words.trim_start_matches([',', ' ', '(']).len();
        let (from, to) = (place.start + skipped, place.end);
        let (Some(before), Some(words)) = (text.get(written..from), text.get(from..to)) else { continue };
        if words.is_empty() {
            continue;
        }
        between(before, out);
        let _ = write!(out, "<span class=\"run\" data-s=\"{}\" data-n=\"{}\"", run.at, run.times);
        if !run.repeats.is_empty() {
            let every: Vec<String> =
                run.repeats.iter().map(|(period, times)| format!("{period},{times}")).collect();
            let _ = write!(out, " data-r=\"{}\"", every.join(";"));
        }
        let _ = write!(out, ">{}</span>", Escaped(words));
        written = to;
    }
    between(text.get(written..).unwrap_or_default(), out);
    let _ = writeln!(out, " <b class=\"count\">{}</b></li>", Escaped(end));
}

/// What stands between runs; turns stand out.
fn between(text: &str, out: &mut String) {
    for c in text.chars() {
        if matches!(c, '\u{2190}' | '\u{2192}') {
            let _ = write!(out, "<span class=\"turn\">{c}</span>");
        } else {
            let _ = write!(out, "{}", Escaped(c.encode_utf8(&mut [0; 4])));
        }
    }
}

/// A run of stitches among the steps of its row.
struct Run {
    /// Its first step.
    at: u64,
    times: u32,
    /// For each bracket around: how many steps one pass takes, and how often it is worked.
    repeats: Vec<(u64, u32)>,
}

/// Finds the runs of a block whose first step is `at`; returns the step behind it.
fn steps(block: &Block, mut at: u64, repeats: &mut Vec<(u64, u32)>, runs: &mut Vec<Run>) -> u64 {
    for op in block.ops() {
        match op {
            Op::Work { times, .. } => {
                runs.push(Run { at, times: *times, repeats: repeats.clone() });
                at += u64::from(*times);
            }
            Op::Repeat { body, times } => {
                let first = runs.len();
                repeats.push((0, *times));
                let period = steps(body, at, repeats, runs) - at;
                repeats.pop();
                let depth = repeats.len();
                for run in runs.iter_mut().skip(first) {
                    if let Some(own) = run.repeats.get_mut(depth) {
                        own.0 = period;
                    }
                }
                at += period * u64::from(*times);
            }
            Op::Turn(_) => at += 1,
            Op::Hold { .. } | Op::Leave { .. } | Op::Color(_) => {}
        }
    }
    at
}
