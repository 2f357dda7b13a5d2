//! Single edits of right patterns: whenever an edit makes rows, loops and counts disagree, the reader has to refuse it.
//!
//! Whether they disagree is told by a second reader of the plain subset, written here from its meaning alone.

use crate::examples::check;
use picot::frontend::crochet::Conventions;
use std::fmt::Write;

/// Loops worked and made by a list of clauses such as `(2 sc, inc) x 6, 3 sc`; `None` when it cannot be read.
fn list(text: &str) -> Option<(i64, i64)> {
    let (mut works, mut makes) = (0, 0);
    let mut rest = text.trim();
    loop {
        let (clause, after) = if rest.starts_with('(') {
            let close = rest.find(')')?;
            let (w, m) = list(rest.get(1..close)?)?;
            let tail = rest.get(close + 1..)?;
            let times = tail.strip_prefix(" x ")?;
            let digits = times.find(|c: char| !c.is_ascii_digit()).unwrap_or(times.len());
            let count: i64 = times.get(..digits)?.parse().ok()?;
            if count == 0 {
                return None;
            }
            ((w * count, m * count), times.get(digits..)?)
        } else {
            let end = rest.find(", ").unwrap_or(rest.len());
            (clause(rest.get(..end)?)?, rest.get(end..)?)
        };
        works += clause.0;
        makes += clause.1;
        if after.is_empty() {
            return Some((works, makes));
        }
        rest = after.strip_prefix(", ")?;
    }
}

fn clause(text: &str) -> Option<(i64, i64)> {
    let digits = text.find(|c: char| !c.is_ascii_digit())?;
    let (count, word) = if digits == 0 {
        (1, text)
    } else {
        (text.get(..digits)?.parse().ok()?, text.get(digits..)?.strip_prefix(' ')?)
    };
    if count == 0 {
        return None;
    }
    match word {
        "sc" | "hdc" => Some((count, count)),
        "inc" => Some((count, 2 * count)),
        "dec" => Some((2 * count, count)),
        _ => None,
    }
}

/// True when every row fits the one below, its count and its number.
fn consistent(text: &str) -> bool {
    follow(text).is_some()
}

fn follow(text: &str) -> Option<()> {
    let mut below: Option<i64> = None;
    let mut next = 1;
    for line in text.lines() {
        let (label, row) = line.split_once(": ")?;
        let (first, last) = if let Some(range) = label.strip_prefix("Rnds ") {
            let (first, last) = range.split_once('-')?;
            (first.parse().ok()?, last.parse::<i64>().ok()?)
        } else {
            let number = label.strip_prefix("Rnd ")?.parse().ok()?;
            (number, number)
        };
        let row = row.strip_suffix(')')?;
        let (body, count) = row.rsplit_once(" (")?;
        let count: i64 = count.parse().ok()?;
        if first != next || last < first || (label.starts_with("Rnds") && last == first) {
            return None;
        }
        next = last + 1;
        let made = match body.strip_suffix(" sc in MR") {
            Some(ring) if below.is_none() => ring.parse::<i64>().ok().filter(|ring| *ring > 0)?,
            Some(_) => return None,
            None => {
                let (works, makes) = list(body)?;
                if Some(works) != below {
                    return None;
                }
                makes
            }
        };
        if made != count || (last > first && Some(made) != below) {
            return None;
        }
        below = Some(made);
    }
    Some(())
}

/// A right pattern of growing, even and shrinking rounds.
fn pattern(seed: u32) -> String {
    let segments = 5 + seed % 4;
    let mut text = format!("Rnd 1: {segments} sc in MR ({segments})\n");
    let mut loops = segments;
    let mut round = 2;
    let mut line = |body: String, count: u32, rounds: u32| {
        let label =
            if rounds == 1 { format!("Rnd {round}") } else { format!("Rnds {round}-{}", round + rounds - 1) };
        let _ = writeln!(text, "{label}: {body} ({count})");
        round += rounds;
    };
    for step in 0..4 + seed % 3 {
        let body =
            if step == 0 { format!("{segments} inc") } else { format!("({step} sc, inc) x {segments}") };
        loops += segments;
        line(body, loops, 1);
        if (seed + step).is_multiple_of(3) {
            line(format!("{loops} sc"), loops, 2 + seed % 3);
        }
        if (seed + step) % 4 == 1 {
            line(format!("inc, {} sc, dec", loops - 3), loops, 1);
        }
        if (seed + step) % 5 == 2 {
            line(format!("{} sc, 2 hdc, inc", loops - 3), loops + 1, 1);
            line(format!("{} sc, dec", loops - 1), loops, 1);
        }
    }
    while loops > segments {
        let rest = loops / segments - 2;
        let body =
            if rest == 0 { format!("{segments} dec") } else { format!("({rest} sc, dec) x {segments}") };
        loops -= segments;
        line(body, loops, 1);
    }
    text
}

/// All single edits: a number, a stitch, a bracket, a count, a row.
fn edits(text: &str) -> Vec<String> {
    let mut all = Vec::new();
    let bytes = text.as_bytes();
    let mut at = 0;
    while at < bytes.len() {
        if bytes[at].is_ascii_digit() {
            let end = at + bytes[at..].iter().take_while(|byte| byte.is_ascii_digit()).count();
            let value: i64 = text[at..end].parse().unwrap_or(0);
            for other in [value + 1, value - 1, value * 2, value + 10, value * 10, value / 10] {
                if other != value && other >= 0 {
                    all.push(format!("{}{other}{}", &text[..at], &text[end..]));
                }
            }
            all.push(format!("{}{}", &text[..at], &text[end..]));
            at = end;
            continue;
        }
        if matches!(bytes[at], b'(' | b')' | b',' | b'x' | b':') {
            all.push(format!("{}{}", &text[..at], &text[at + 1..]));
        }
        for (from, to) in
            [("inc", "dec"), ("dec", "inc"), ("inc", "sc"), ("sc", "inc"), ("sc", "dec"), ("dec", "sc")]
        {
            if text[at..].starts_with(from) {
                all.push(format!("{}{to}{}", &text[..at], &text[at + from.len()..]));
            }
        }
        at += 1;
    }
    let lines: Vec<&str> = text.lines().collect();
    for index in 0..lines.len() {
        let mut dropped = lines.clone();
        dropped.remove(index);
        all.push(dropped.join("\n"));
        let mut doubled = lines.clone();
        doubled.insert(index, lines[index]);
        all.push(doubled.join("\n"));
        if index > 0 {
            let mut swapped = lines.clone();
            swapped.swap(index, index - 1);
            all.push(swapped.join("\n"));
        }
    }
    all
}

#[test]
fn edits_that_change_a_count_are_refused() {
    let (mut wrong, mut refused, mut false_alarms) = (0_u32, 0_u32, 0_u32);
    let mut survivors = Vec::new();
    for seed in 0..12 {
        let text = pattern(seed);
        assert!(consistent(&text), "{text}");
        let (errors, _) = check(&text, &Conventions::default());
        assert!(errors.is_empty(), "{errors:?}\n{text}");
        for other in edits(&text) {
            let (errors, _) = check(&other, &Conventions::default());
            if consistent(&other) {
                false_alarms += u32::from(!errors.is_empty());
                continue;
            }
            wrong += 1;
            if errors.is_empty() {
                let line = other.lines().zip(text.lines()).find(|(a, b)| a != b);
                survivors.push(line.map_or_else(|| other.clone(), |(edited, _)| edited.to_owned()));
            } else {
                refused += 1;
            }
        }
    }
    let rate = f64::from(refused) / f64::from(wrong);
    println!("{refused} of {wrong} refused ({:.2} %), {false_alarms} harmless edits refused", rate * 100.0);
    println!("survivors:\n{}", survivors.join("\n"));
    assert!(rate >= 0.995, "{rate}: survivors:\n{}", survivors.join("\n"));
}

#[test]
fn the_row_at_fault_is_named_first() {
    let (mut faults, mut named) = (0_u32, 0_u32);
    for seed in 0..12 {
        let text = pattern(seed);
        let lines: Vec<&str> = text.lines().collect();
        for index in 2..lines.len() - 1 {
            for (from, to) in [
                (" x 5", " x 4"),
                (" x 6", " x 7"),
                (" x 7", " x 6"),
                (" x 8", " x 9"),
                ("inc", "dec"),
                ("dec", "inc"),
            ] {
                let broken = lines[index].replacen(from, to, 1);
                if broken == lines[index] {
                    continue;
                }
                let mut other = lines.clone();
                other[index] = &broken;
                let other = other.join("\n");
                if consistent(&other) {
                    continue;
                }
                faults += 1;
                let round: String = lines[index]
                    .chars()
                    .skip_while(|c| !c.is_ascii_digit())
                    .take_while(char::is_ascii_digit)
                    .collect();
                let (errors, _) = check(&other, &Conventions::default());
                named += u32::from(errors.len() == 1 && errors[0].contains(&format!("round {round} ")));
            }
        }
    }
    println!("{named} of {faults} planted faults are the only finding and name their round");
    assert!(f64::from(named) >= 0.95 * f64::from(faults), "{named} of {faults}");
}
