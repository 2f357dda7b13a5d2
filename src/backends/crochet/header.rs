//! What stands above the rounds: size, gauge, materials, abbreviations, notes.

use super::rows::{Text, Uses, clean, full_name, name, special, spiral, widest};
use super::{Crochet, Style, Terms};
use crate::ir::verify::Verified;
use crate::ir::yarn::{SPARE, Yarn};
use crate::ir::{Finish, Gauge, GaugeOrigin, Kind, Start};
use glam::DVec3;
use std::io;

/// Writes the head of a pattern.
pub(super) fn write(options: &Crochet, program: &Verified<'_>, text: &mut Text<'_>) -> io::Result<()> {
    let uses = Uses::of(program);
    text.line(&format!("title: {}", clean(&program.name)))?;
    text.line(&format!("terms: {}", options.terms.name()))?;
    if let Some(gauge) = &program.gauge {
        text.line(&format!("gauge: {}", gauge_line(gauge)))?;
    }
    if uses.short_rows {
        // A turn of ours neither works nor skips a loop; the other habit is to bridge one.
        text.line("convention: turn-mark=bare")?;
    }
    for (kind, works, makes) in &uses.special {
        text.line(&format!("def {} = {works} -> {makes}", special(*kind, *works, *makes)))?;
    }
    if options.style == Style::Paper {
        return Ok(());
    }
    text.gap()?;
    if let Some(gauge) = &program.gauge {
        if let Some(size) = size(program, gauge) {
            text.prose(&format!("Finished size: {size}."))?;
        }
        if gauge.estimated() {
            text.prose(
                "The gauge is estimated from yarn and hook. Make a swatch, and build the pattern again with the \
                 measured gauge if the size matters.",
            )?;
        }
        text.prose(&format!("Materials: {}.", materials(program, gauge)))?;
    }
    text.prose(&format!(
        "Abbreviations ({} terms): {}.",
        options.terms.name().to_uppercase(),
        abbreviations(options.terms, &uses, program)
    ))?;
    for note in notes(&uses, program) {
        text.prose(note)?;
    }
    if program.pattern.parts.len() > 1 {
        let list = program.pattern.parts.iter().map(|part| match part.copies {
            1 => name(&part.name),
            copies => format!("{} (make {copies})", name(&part.name)),
        });
        text.prose(&format!("Parts, in this order: {}.", list.collect::<Vec<_>>().join(", ")))?;
    }
    Ok(())
}

/// `2.5 x 2.5 mm a stitch, 40 sts x 40 rnds in 10 cm`.
fn gauge_line(gauge: &Gauge) -> String {
    let (width, height) = (gauge.width, gauge.height);
    let mut line = format!(
        "{} x {} mm a stitch, {} sts x {} rnds in 10 cm",
        short(width, 2),
        short(height, 2),
        short(100.0 / width, 1),
        short(100.0 / height, 1)
    );
    match gauge.origin {
        GaugeOrigin::Given => {}
        GaugeOrigin::Swatch => line.push_str(", measured on a swatch"),
        GaugeOrigin::Estimated { in_range: true, .. } => line.push_str(", estimated from yarn and hook"),
        GaugeOrigin::Estimated { in_range: false, .. } => {
            line.push_str(", estimated: the hook is not among the usual ones for this yarn");
        }
    }
    line
}

/// Extents and girth; from and to where the gauge is estimated.
fn size(program: &Verified<'_>, gauge: &Gauge) -> Option<String> {
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
    let around = |scale: f64| short(girth * scale / 10.0, 1);
    extent.is_finite().then(|| {
        if off == 0.0 {
            format!("{} cm, {} cm around at the widest", box_of(1.0), around(1.0))
        } else {
            format!(
                "about {} cm, {} cm around at the widest; with an estimated gauge anything from {} to {} cm",
                box_of(1.0),
                around(1.0),
                box_of(1.0 - off),
                box_of(1.0 + off)
            )
        }
    })
}

fn materials(program: &Verified<'_>, gauge: &Gauge) -> String {
    let length = program.facts().yarn(program, gauge.width) * (1.0 + SPARE);
    let meters = (length / 1000.0).ceil().max(1.0);
    let mut list = Vec::new();
    if let GaugeOrigin::Estimated { weight, hook, .. } = gauge.origin {
        let yarn = Yarn::of_weight(weight);
        let mass = yarn.and_then(|yarn| yarn.mass(length)).map_or_else(String::new, |[least, most]| {
            format!(", {} to {} g", short(least.ceil(), 0), short(most.ceil(), 0))
        });
        let kind = yarn.map_or("", Yarn::name);
        list.push(format!(
            "about {meters} m of {kind} yarn (weight {weight}){mass}, estimated with 10 % to spare"
        ));
        list.push(format!("a {hook} hook"));
    } else {
        list.push(format!("about {meters} m of yarn, estimated with 10 % to spare"));
        list.push("a hook that gives the gauge".to_owned());
    }
    if spiral(program) {
        list.push("a stitch marker".to_owned());
    }
    list.push("a yarn needle".to_owned());
    if program.pattern.parts.iter().any(|part| part.finish == Finish::DrawnShut && !part.flat) {
        list.push("stuffing".to_owned());
    }
    list.join("; ")
}

fn abbreviations(terms: Terms, uses: &Uses, program: &Verified<'_>) -> String {
    let base = |kind: Kind| match terms {
        Terms::Us => kind.us(),
        Terms::Uk => kind.uk(),
    };
    let mut list: Vec<String> = Vec::new();
    for kind in uses.kinds.iter().filter(|kind| **kind != Kind::Special) {
        list.push(format!("{} = {}", base(*kind), full_name(*kind, terms)));
    }
    let sc = base(Kind::Sc);
    if uses.increase {
        list.push(format!("inc = increase: 2 {sc} in one stitch"));
    }
    if uses.decrease {
        list.push(format!("dec = decrease: 2 stitches worked together as one {sc}"));
    }
    list.push("st(s) = stitch(es)".to_owned());
    if spiral(program) {
        list.push("rnd(s) = round(s)".to_owned());
    }
    if uses.repeats {
        list.push("( ) x 6 = work what is in the brackets 6 times".to_owned());
    }
    list.push("number at the end of a line = stitches of that round".to_owned());
    list.join("; ")
}

fn notes(uses: &Uses, program: &Verified<'_>) -> Vec<&'static str> {
    let mut notes = Vec::new();
    if spiral(program) {
        notes.push(
            "Work in one continuous spiral: do not join the rounds and do not turn, except where it says so. Mark the \
             first stitch of a round, and move the marker up each time you come back to it.",
        );
    }
    if uses.decrease {
        notes.push(
            "The decrease is least seen as an invisible one: work through the front loops of both stitches.",
        );
    }
    if uses.left {
        notes.push(
            "Where a round leaves stitches unworked, the marker moves back: the next round begins with these stitches.",
        );
    }
    let open_start = |part: &crate::ir::Part| matches!(part.start, Start::Chain { joined: true, .. });
    if program.pattern.parts.iter().any(open_start) {
        notes.push(
            "The foundation may be worked in foundation stitches instead of chains; it then gives more.",
        );
    }
    notes
}

/// A number with at most so many decimals and no zeros at their end.
fn short(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
