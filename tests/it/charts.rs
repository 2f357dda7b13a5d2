//! Charts: every sign of a round is there, names cannot leave their place, and what is too large is refused.

use super::snapshots::{program, shapes};
use picot::backends::target;
use picot::diag::{Sink, Sources};
use picot::frontend::reader;
use picot::ir::Kind;
use picot::ir::machine::Machine;
use picot::ir::pattern::Step;
use picot::ir::verify::{Verified, verify};
use picot::ir::{Program, Start};
use picot::lower::machine::{Options, lower};
use quick_xml::Reader;
use quick_xml::events::Event;
use std::collections::BTreeMap;

fn chart(program: &Verified<'_>, options: &str) -> String {
    let target = target("svg").expect("listed");
    let mut bytes = Vec::new();
    let backend = target.configure(options.parse().expect("TOML")).expect("known options");
    backend.emit(program, &mut bytes, &mut Sink::new()).expect("it can be drawn");
    String::from_utf8(bytes).expect("UTF-8")
}

/// A written pattern.
pub(crate) fn written(text: &str) -> Program {
    let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    let mut sources = Sources::new(&no_files);
    let mut sink = Sink::new();
    let source = sources.add("pattern.txt", text.into()).expect("UTF-8");
    let reader = reader("crochet").expect("listed");
    let program = picot::compile(&source, reader, &picot::Options::default(), &mut sources, &mut sink);
    program.unwrap_or_else(|| panic!("{:?}", sink.diagnostics()))
}

/// Number of signs in the group of each round, by its id; well-formed XML on the way.
fn signs(chart: &str) -> BTreeMap<String, usize> {
    let mut reader = Reader::from_str(chart);
    let mut groups: Vec<Option<String>> = Vec::new();
    let mut signs = BTreeMap::new();
    loop {
        let event = reader.read_event().expect("well-formed");
        let id = |tag: &quick_xml::events::BytesStart<'_>| {
            let id = tag.try_get_attribute("id").expect("well-formed")?;
            Some(id.value.into_owned())
        };
        match event {
            Event::Start(tag) => {
                let id = id(&tag).filter(|_| tag.name().as_ref() == "g");
                if let Some(id) = &id {
                    assert!(signs.insert(id.clone(), 0).is_none(), "{id} twice");
                }
                groups.push(id);
            }
            Event::Empty(tag) if tag.name().as_ref() == "path" => {
                if let Some(id) = groups.iter().rev().flatten().next() {
                    *signs.get_mut(id).expect("open") += 1;
                }
            }
            Event::End(_) => drop(groups.pop()),
            Event::Eof => return signs,
            Event::Empty(_)
            | Event::Text(_)
            | Event::CData(_)
            | Event::Comment(_)
            | Event::Decl(_)
            | Event::PI(_)
            | Event::DocType(_)
            | Event::GeneralRef(_) => {}
        }
    }
}

/// The pattern itself, counted without the chart's walk.
fn expected(program: &Program) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for (index, part) in program.pattern.parts.iter().enumerate() {
        let start = part.start.loops();
        if start > 0 {
            let number = u32::from(matches!(part.start, Start::Ring { .. }));
            counts.insert(format!("p{index}r{number}"), start as usize);
        }
        for (number, row) in part.numbered_rows() {
            let drawn = |step: &Step| matches!(step, Step::Work(stitch) if stitch.kind != Kind::Skip);
            let signs = row.body.steps().filter(drawn).count();
            for round in number..number + row.times {
                counts.insert(format!("p{index}r{round}"), signs);
            }
        }
    }
    counts
}

fn holds(program: &Program, options: &str, name: &str) {
    let verified = verify(program, &mut Sink::new()).expect("can be worked");
    let chart = chart(&verified, options);
    let mut found = signs(&chart);
    found.retain(|id, _| id.contains('r'));
    assert_eq!(found, expected(program), "{name} {options}");
}

#[test]
fn every_stitch_has_its_sign_in_the_group_of_its_round() {
    for (name, path) in shapes() {
        let program = program(&path);
        for options in ["", "chart = 'round'", "chart = 'rows'\nsc-symbol = 'plus'\nterms = 'uk'"] {
            holds(&program, options, &name);
        }
    }
}

#[test]
fn written_patterns_of_every_kind_of_stitch_have_charts() {
    let flat =
        "Ch 11\nRow 1: sc in 2nd ch from hook, 9 sc (10)\nRow 2: ch 1, turn, 4 hdc, 2 dc, 2 tr, dc2tog (9)\n";
    let round =
        "terms: us\nRnd 1: 6 sc in magic ring (6)\nRnd 2: 6 inc (12)\nRnd 3: (BLO sc, inc) x 6 (18)\n";
    let ring = "terms: us\nRnd 1: 12 sc in magic ring (12)\nRnd 2: (2 FPdc, bo) x 4 (12)\n";
    for (name, text) in [("flat", flat), ("round", round), ("ring", ring)] {
        for options in ["", "chart = 'round'", "chart = 'rows'"] {
            holds(&written(text), options, name);
        }
    }
}

#[test]
fn spirals_are_for_what_they_can_show() {
    let shown = |text: &str| {
        let program = written(text);
        let chart = chart(&verify(&program, &mut Sink::new()).expect("can be worked"), "");
        if chart.contains("Read the spiral") { "round" } else { "rows" }
    };
    assert_eq!(shown("Rnd 1: 6 sc in magic ring (6)\nRnds 2-20: 6 sc (6)\n"), "round");
    assert_eq!(shown("Rnd 1: 6 sc in magic ring (6)\nRnds 2-21: 6 sc (6)\n"), "rows");
    assert_eq!(shown("Ch 6, join with a sl st to form a ring\nRnds 1-3: 6 sc (6)\n"), "rows");
    assert_eq!(shown("Rnd 1: 6 sc in magic ring (6)\nRnd 2: 4 sc <- -2 sc -> 4 sc (6)\n"), "rows");
}

#[test]
fn a_name_stays_a_name() {
    let mut program = written("Rnd 1: 6 sc in magic ring (6)\nRnd 2: 6 inc (12)\n");
    program.name = "</title><script>alert(1)</script>\u{1}".into();
    program.pattern.parts[0].name = "\"><img src=x>".into();
    program.pattern.parts[0].copies = 2;
    let chart = chart(&verify(&program, &mut Sink::new()).expect("can be worked"), "");
    assert!(!chart.contains("<script") && !chart.contains("<img"), "{chart}");
    assert!(signs(&chart).len() > 2);
}

#[test]
fn what_no_one_could_read_is_refused_with_the_limit() {
    let program = written("Rnd 1: 6 sc in magic ring (6)\nRnds 2-40000: 6 sc (6)\n");
    let verified = verify(&program, &mut Sink::new()).expect("can be worked");
    let backend = target("svg").expect("listed").configure(toml::Table::new()).expect("defaults");
    let error = backend.emit(&verified, &mut Vec::new(), &mut Sink::new()).expect_err("too large");
    assert!(error.to_string().contains("240000 stitches, a chart holds 100000"), "{error}");
}

/// Passes that a machine chart shows, with the loops that each makes, repeats written out.
fn unfolded(chart: &str, passes: u64) -> Vec<u64> {
    let mut shown: Vec<(u64, u64)> = Vec::new();
    let mut brackets: Vec<(usize, u64)> = Vec::new();
    for line in chart.lines() {
        if let Some((_, pass)) = line.split_once("<title>pass ") {
            let (number, does) = pass.split_once(": ").expect("words");
            let loops = does.trim_end_matches("</title>").split(", ").filter_map(|words| {
                let (count, what) = words.split_once(' ')?;
                ["knit", "tuck", "split"].contains(&what).then(|| count.parse::<u64>().expect("a count"))
            });
            shown.push((number.parse().expect("a number"), loops.sum()));
        } else if let Some((_, times)) = line.split_once("font-weight=\"bold\">x ") {
            let times = times.trim_end_matches("</text>").parse().expect("a number");
            brackets.push((shown.len(), times));
        }
    }
    let mut all = Vec::new();
    for (at, (number, loops)) in shown.iter().enumerate() {
        assert_eq!(*number, all.len() as u64 + 1, "the pass after {all:?}");
        all.push(*loops);
        if let Some((_, times)) = brackets.iter().find(|(end, _)| *end == at + 1) {
            let next = shown.get(at + 1).map_or(passes + 1, |(number, _)| *number);
            let length = ((next - number - 1) / (times - 1)) as usize;
            let run = all[all.len() - length..].to_vec();
            (1..*times).for_each(|_| all.extend(&run));
        }
    }
    all
}

#[test]
fn machine_charts_show_every_pass() {
    for (text, folds) in [
        ("Rnd 1: 6 sc in MR (6)\nRnd 2: 6 inc (12)\nRnd 3: 12 sc (12)\nRnds 4-30: 12 sc (12)\n", true),
        (
            "Rnd 1: 6 sc in MR (6)\nRnd 2: 6 inc (12)\nRnd 3: (sc, inc) x 6 (18)\nRnd 4: 6 dec, 6 sc (12)\n",
            false,
        ),
    ] {
        let program = written(text);
        let verified = verify(&program, &mut Sink::new()).expect("workable");
        for machine in ["swg091n2", "kniterate"] {
            let chart = chart(&verified, &format!("machine = '{machine}'\nno-waste = true"));
            assert!(signs(&chart).contains_key("legend"));
            assert_eq!(chart.contains(">Rnds "), folds);
            let options = Options { no_waste: true, ..Options::default() };
            let machine = Machine::named(machine).expect("listed");
            let lowered = lower(&verified, &machine, &options, &mut Sink::new()).expect("knittable");
            let passes = unfolded(&chart, lowered.report.passes);
            assert_eq!(passes.len() as u64, lowered.report.passes);
            assert_eq!(passes.iter().sum::<u64>(), lowered.report.loops);
        }
        let rows = chart(&verified, "machine = 'kniterate'\nchart = 'rows'");
        assert_eq!(signs(&rows), signs(&chart(&verified, "chart = 'rows'")));
    }
}
