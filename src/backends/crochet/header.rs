//! What stands above the rounds: size, gauge, materials, abbreviations, notes.

use super::rows::{Text, Uses, clean, name, special, spiral, widest};
use super::{Crochet, Language, Style};
use crate::ir::dialect::{Prose, fill};
use crate::ir::verify::Verified;
use crate::ir::yarn::{SPARE, Yarn};
use crate::ir::{Finish, Gauge, GaugeOrigin, Hand, Kind, Start, Stitch};
use glam::DVec3;
use std::io;

/// Writes the head of a pattern.
pub(super) fn write(options: &Crochet, program: &Verified<'_>, text: &mut Text<'_>) -> io::Result<()> {
    let uses = Uses::of(program);
    let vocabulary = options.language.vocabulary();
    let prose = vocabulary.prose;
    text.line(&format!("title: {}", clean(&program.name)))?;
    text.line(&format!("terms: {}", options.terms.name()))?;
    if options.language != Language::English {
        text.line(&format!("lang: {}", vocabulary.code))?;
    }
    if let Some(gauge) = &program.gauge {
        text.line(&format!("gauge: {}", gauge_line(gauge, prose)))?;
    }
    // A turn of ours neither works nor skips a loop; the other habit is to bridge one.
    let bare = uses.short_rows.then_some("turn-mark=bare");
    let left = (program.maker.hand == Hand::Left).then_some("hand=left");
    let conventions: Vec<&str> = bare.into_iter().chain(left).collect();
    if program.maker.lean != 0.0 {
        text.line(&format!("lean: {}", lean(program)))?;
    }
    if !conventions.is_empty() {
        text.line(&format!("convention: {}", conventions.join(", ")))?;
    }
    for (kind, works, makes) in &uses.special {
        text.line(&format!("def {} = {works} -> {makes}", special(*kind, *works, *makes, options.terms)))?;
    }
    if options.style == Style::Paper {
        return Ok(());
    }
    text.gap()?;
    if let Some(gauge) = &program.gauge {
        if let Some(size) = size(program, gauge, prose) {
            text.prose(&size)?;
        }
        if gauge.estimated() {
            text.prose(prose.swatch)?;
        }
        text.prose(&fill(prose.materials, &[("list", &materials(program, gauge, prose))]))?;
    }
    if program.maker.hand == Hand::Left {
        text.prose(prose.left_handed)?;
    }
    if program.maker.lean != 0.0 {
        text.prose(&fill(prose.lean, &[("lean", &lean(program))]))?;
    }
    let terms = options.terms.name().to_uppercase();
    let list = abbreviations(options, &uses, program);
    text.prose(&fill(prose.abbreviations, &[("terms", &terms), ("list", &list)]))?;
    for note in notes(&uses, program, prose) {
        text.prose(note)?;
    }
    if uses.held && options.language == Language::English {
        text.prose(
            "Where stitches are held for another part, skip them and leave them open, on a stitch holder or a thread. Chains \
             that count as stitches go over the gap; the next round is worked into them.",
        )?;
    }
    if program.pattern.parts.len() > 1 {
        let list = program.pattern.parts.iter().map(|part| {
            let name = name(&part.name, options.language);
            match part.copies {
                1 => name,
                copies => format!("{name} ({})", fill(vocabulary.forms.make, &[("n", &copies.to_string())])),
            }
        });
        text.prose(&fill(prose.parts, &[("list", &list.collect::<Vec<_>>().join(", "))]))?;
    }
    Ok(())
}

/// Stitches a round with a sign; as many digits as read back to the same.
fn lean(program: &Verified<'_>) -> String {
    format!("{:+}", program.maker.lean)
}

/// `2.5 x 2.5 mm a stitch, 40 sts x 40 rnds in 10 cm`.
fn gauge_line(gauge: &Gauge, prose: &Prose) -> String {
    let (width, height) = (gauge.width, gauge.height);
    let [w, h, sts, rnds] =
        [short(width, 2), short(height, 2), short(100.0 / width, 1), short(100.0 / height, 1)];
    let mut line = fill(prose.gauge, &[("w", &w), ("h", &h), ("sts", &sts), ("rnds", &rnds)]);
    line.push_str(match gauge.origin {
        GaugeOrigin::Given => "",
        GaugeOrigin::Swatch => prose.measured,
        GaugeOrigin::Estimated { in_range: true, .. } => prose.estimated,
        GaugeOrigin::Estimated { in_range: false, .. } => prose.unusual,
    });
    line
}

/// Extents and girth; from and to where the gauge is estimated.
fn size(program: &Verified<'_>, gauge: &Gauge, prose: &Prose) -> Option<String> {
    let points = program.graphs.iter().flat_map(|graph| {
        graph.nodes.iter().map(|node| node.position).chain(graph.pole).chain(graph.end_pole)
    });
    let (low, high) = points
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), point| (low.min(point), high.max(point)));
    let extent = high - low;
    let girth = f64::from(widest(program)) * gauge.width;
    let off = match gauge.origin {
        GaugeOrigin::Given | GaugeOrigin::Swatch => 0.0,
        GaugeOrigin::Estimated { weight, hook, in_range } => Yarn::of_weight(weight)
            .map_or(if in_range { 0.15 } else { 0.20 }, |yarn| yarn.estimate(hook).uncertainty),
    };
    let box_of = |scale: f64| {
        let sides = [extent.x, extent.y, extent.z].map(|side| short(side * scale / 10.0, 1));
        sides.join(" x ")
    };
    let around = short(girth / 10.0, 1);
    extent.is_finite().then(|| {
        let template = if off == 0.0 { prose.size } else { prose.about };
        let [own, low, high] = [box_of(1.0), box_of(1.0 - off), box_of(1.0 + off)];
        fill(template, &[("box", &own), ("around", &around), ("low", &low), ("high", &high)])
    })
}

fn materials(program: &Verified<'_>, gauge: &Gauge, prose: &Prose) -> String {
    let length = program.facts().yarn(program, gauge.width) * (1.0 + SPARE);
    let meters = (length / 1000.0).ceil().max(1.0).to_string();
    let mut list = Vec::new();
    if let GaugeOrigin::Estimated { weight, hook, .. } = gauge.origin {
        let yarn = Yarn::of_weight(weight);
        let mass = yarn.and_then(|yarn| yarn.mass(length)).map_or_else(String::new, |[least, most]| {
            fill(prose.mass, &[("least", &short(least.ceil(), 0)), ("most", &short(most.ceil(), 0))])
        });
        let (kind, weight) = (yarn.map_or("", Yarn::name), weight.to_string());
        let values = [("m", meters.as_str()), ("kind", kind), ("weight", &weight), ("mass", &mass)];
        list.push(fill(prose.yarn_of, &values));
        list.push(fill(prose.hook, &[("hook", &hook.to_string())]));
    } else {
        list.push(fill(prose.yarn, &[("m", &meters)]));
        list.push(prose.any_hook.to_owned());
    }
    if spiral(program) {
        list.push(prose.marker.to_owned());
    }
    list.push(prose.needle.to_owned());
    if program.pattern.parts.iter().any(|part| part.finish == Finish::DrawnShut && !part.flat) {
        list.push(prose.stuffing.to_owned());
    }
    list.join("; ")
}

fn abbreviations(options: &Crochet, uses: &Uses, program: &Verified<'_>) -> String {
    let (language, terms) = (options.language, options.terms);
    let prose = language.vocabulary().prose;
    let mut list: Vec<String> = Vec::new();
    for kind in uses.kinds.iter().copied().filter(|kind| *kind != Kind::Special) {
        let short = super::words::abbreviation(kind, language, terms);
        let name = language.full_name(kind, terms);
        if short != name {
            list.push(format!("{short} = {name}"));
        }
    }
    let sc = language.abbreviation(Kind::Sc, terms);
    let letters = |works, makes| language.letters(Stitch { works, makes, ..Stitch::SC });
    if uses.increase {
        let inc = letters(1, 2).unwrap_or(language.say("inc"));
        list.push(format!("{inc} = {}", fill(prose.inc, &[("sc", sc)])));
    }
    if uses.decrease {
        let dec = letters(2, 1).unwrap_or(language.say("dec"));
        list.push(format!("{dec} = {}", fill(prose.dec, &[("sc", sc)])));
    }
    list.push(prose.st.to_owned());
    if spiral(program) {
        list.push(if language == Language::Letters { "R = round" } else { prose.rnd }.to_owned());
    }
    if uses.repeats {
        list.push(prose.repeat.to_owned());
    }
    list.push(prose.count.to_owned());
    list.join("; ")
}

fn notes(uses: &Uses, program: &Verified<'_>, prose: &'static Prose) -> Vec<&'static str> {
    let mut notes = Vec::new();
    if spiral(program) {
        notes.push(prose.spiral);
    }
    if uses.decrease {
        notes.push(prose.invisible);
    }
    if uses.left {
        notes.push(prose.unworked);
    }
    let open_start = |part: &crate::ir::Part| matches!(part.start, Start::Chain { joined: true, .. });
    if program.pattern.parts.iter().any(open_start) {
        notes.push(prose.foundation);
    }
    notes
}

/// A number with at most so many decimals and no zeros at their end.
fn short(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
