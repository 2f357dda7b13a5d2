//! What the writer writes, the reader reads: the same steps in every language, for every shape and for arbitrary patterns.

use crate::arbitrary;
use crate::snapshots::shapes;
use picot::backends::Backend;
use picot::backends::crochet::{Arrows, Crochet, Language, Style, Terms};
use picot::diag::{Severity, Sink, Sources};
use picot::frontend::crochet::{Conventions, Document};
use picot::frontend::reader;
use picot::ir::verify::verify;
use picot::ir::{
    Block, Direction, Entry, Finish, Hand, Kind, Op, Part, PartId, Pattern, Program, Row, Segment, Start,
    Step, Stitch,
};
use proptest::prelude::*;

/// A part as it is compared: everything but how rows are folded.
#[derive(Debug, PartialEq)]
struct Plain {
    name: Option<String>,
    start: Start,
    finish: Finish,
    flat: bool,
    copies: u32,
    rows: Vec<(u32, Vec<Told>)>,
}

/// A step with colors by name.
#[derive(Clone, Debug, PartialEq)]
enum Told {
    Step(Step),
    Color(String),
}

fn plain(program: &Program) -> Vec<Plain> {
    let mut sink = Sink::new();
    let verified = verify(program, &mut sink).unwrap_or_else(|| panic!("{sink:?}"));
    let named = program.pattern.parts.len() > 1;
    let parts = program.pattern.parts.iter().zip(&verified.facts().parts);
    let told = |step: Step| match step {
        Step::Color(color) => {
            let letter = || char::from(b'A' + (color % 26) as u8).to_string();
            Told::Color(program.colors.get(usize::from(color)).cloned().unwrap_or_else(letter))
        }
        Step::Work(_) | Step::Turn(_) | Step::Hold { .. } | Step::Leave { .. } => Told::Step(step),
    };
    parts
        .map(|(part, facts)| Plain {
            name: named.then(|| part.name.clone()),
            start: part.start.clone(),
            finish: part.finish,
            flat: part.flat,
            copies: part.copies,
            rows: part
                .rows
                .iter()
                .zip(&facts.rows)
                .flat_map(|(row, facts)| {
                    let steps: Vec<Told> = row.body.steps().map(told).collect();
                    vec![(facts.produces, steps); row.times as usize]
                })
                .collect(),
        })
        .collect()
}

fn forms() -> Vec<Crochet> {
    let mut forms = Vec::new();
    for (index, language) in Language::ALL.iter().enumerate() {
        for (other, terms) in [Terms::Us, Terms::Uk].into_iter().enumerate() {
            let arrows = [Arrows::Unicode, Arrows::Ascii, Arrows::Words][(index + other) % 3];
            let style = if (index + other) % 4 == 3 { Style::Paper } else { Style::Maker };
            forms.push(Crochet { terms, language: *language, arrows, style, ..Crochet::default() });
        }
    }
    forms
}

fn read(text: &str) -> (Option<Program>, Vec<String>) {
    let loader = |_: &str| Err(std::io::Error::other("no files"));
    let mut sources = Sources::new(&loader);
    let source = sources.add("pattern.txt", text.as_bytes().to_vec()).expect("small");
    let mut sink = Sink::new();
    let conventions = Conventions::default();
    let document = Document::parse(&source, conventions.language, &mut sink).expect("text");
    let program = document.check(&conventions, &mut sink).program;
    let told = sink.diagnostics().iter().filter(|found| found.severity != Severity::Note);
    (program, told.map(|found| format!("{} {}", found.code.as_str(), found.message)).collect())
}

/// Emits in every form and reads back; tells what differs. Warnings are allowed only where the pattern deserves them.
fn round_trip(program: &Program) -> Result<(), String> {
    let expected = plain(program);
    for form in forms() {
        let mut sink = Sink::new();
        let verified = verify(program, &mut sink).expect("verified");
        let mut bytes = Vec::new();
        form.emit(&verified, &mut bytes, &mut sink).expect("written");
        let text = String::from_utf8(bytes).expect("text");
        let (read, found) = read(&text);
        let wrong = |found: &&String| found.starts_with('E') || found.contains("read as");
        if let Some(wrong) = found.iter().find(wrong) {
            return Err(format!("{wrong} in\n{text}"));
        }
        let read = read.ok_or_else(|| format!("nothing was read from\n{text}"))?;
        let told = plain(&read);
        if told != expected || read.name != program.name || read.maker != program.maker {
            let parts = told.iter().zip(&expected).find(|(told, expected)| told != expected);
            return Err(format!("differs: {parts:?} in\n{text}"));
        }
    }
    Ok(())
}

fn assert_round_trip(program: &Program) {
    if let Err(difference) = round_trip(program) {
        panic!("{difference}");
    }
}

#[test]
fn every_shape_reads_back_as_its_steps_in_every_language() {
    #[expect(clippy::disallowed_methods, reason = "tests read their cases from the disk")]
    let load = |name: &str| std::fs::read(name);
    for (name, path) in shapes() {
        let mut sources = Sources::new(&load);
        let mut sink = Sink::new();
        let source = sources.open(path.to_str().expect("plain names")).expect("readable");
        let reader = reader("shape").expect("listed");
        let options = picot::Options::default();
        let program = picot::compile(&source, reader, &options, &mut sources, &mut sink);
        let program = program.unwrap_or_else(|| panic!("{name}: {sink:?}"));
        assert_round_trip(&program);
    }
}

/// Decisions, which shrink towards plain rounds.
struct Tape<'t>(std::slice::Iter<'t, u8>);

impl Tape<'_> {
    fn below(&mut self, bound: u32) -> u32 {
        let high = self.0.next().copied().unwrap_or(0);
        let low = if bound > 256 { self.0.next().copied().unwrap_or(0) } else { 0 };
        (u32::from(low) * 256 + u32::from(high)) % bound.max(1)
    }
    fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len() as u32) as usize]
    }
}

const KINDS: &[Kind] = &[
    Kind::Sc,
    Kind::Sc,
    Kind::Sc,
    Kind::Hdc,
    Kind::Dc,
    Kind::Tr,
    Kind::Dtr,
    Kind::Trtr,
    Kind::Esc,
    Kind::Edc,
    Kind::Rsc,
    Kind::SlSt,
    Kind::Fpdc,
    Kind::Bphdc,
    Kind::Fptr,
    Kind::Bobble,
    Kind::Popcorn,
    Kind::Puff,
    Kind::Cluster,
    Kind::Special,
];

const ARITIES: &[(u16, u16)] = &[
    (1, 1),
    (1, 1),
    (1, 1),
    (1, 2),
    (2, 1),
    (1, 3),
    (3, 1),
    (1, 5),
    (0, 1),
    (2, 2),
    (2, 3),
    (1, 0),
    (0, 2),
    (3, 2),
];

/// Makes rows on some loops.
struct Maker<'t, 'd> {
    tape: &'d mut Tape<'t>,
    ahead: u32,
    behind: u32,
    colors: u16,
    mixed: bool,
}

impl Maker<'_, '_> {
    fn stitch(&mut self) -> Stitch {
        let kind = if self.mixed { self.tape.pick(KINDS) } else { Kind::Sc };
        let (works, makes) =
            if self.tape.below(3) > 0 { (kind.works(), kind.makes()) } else { self.tape.pick(ARITIES) };
        let entry = match self.tape.below(8) {
            5 => Entry::Front,
            6 => Entry::Back,
            7 if works == 0 => Entry::Space,
            _ => Entry::Both,
        };
        match (kind, (works, makes), self.tape.below(24)) {
            (.., 20) => Stitch::plain(Kind::Skip),
            (.., 21) => Stitch::plain(Kind::Ch),
            (.., 22) => Stitch { makes: 1, ..Stitch::plain(Kind::Ch) },
            (.., 23) if self.mixed => Stitch::plain(Kind::Picot),
            _ => Stitch { kind, works, makes, entry },
        }
    }

    /// Stitches of one direction that work at most `limit` loops; what they work and make.
    fn run(&mut self, limit: u32, out: &mut Block) -> (u32, u32) {
        let stitch = self.stitch();
        let works = u32::from(stitch.works);
        if works > limit {
            return (0, 0);
        }
        let most = limit.checked_div(works).unwrap_or(3);
        let times = 1 + self.tape.below(most.min(12));
        out.push(Op::Work { stitch, times }, picot::diag::Span::NONE);
        (works * times, u32::from(stitch.makes) * times)
    }

    fn one(&mut self, out: &mut Block) {
        match self.tape.below(16) {
            12 if self.behind > 1 => {
                // A short row: back over some loops, and forward again.
                out.push(Op::Turn(Direction::Back), picot::diag::Span::NONE);
                let (mut worked, mut made) = (0, 0);
                let reach = 1 + self.tape.below(self.behind.min(9));
                while worked < reach {
                    let (works, makes) = self.run(reach - worked, out);
                    if works == 0 {
                        out.push(Op::Work { stitch: Stitch::SC, times: 1 }, picot::diag::Span::NONE);
                        (worked, made) = (worked + 1, made + 1);
                    }
                    (worked, made) = (worked + works, made + makes);
                }
                self.behind -= worked;
                self.ahead += made;
                out.push(Op::Turn(Direction::Forward), picot::diag::Span::NONE);
            }
            13 => {
                let mut body = Block::default();
                let (mut works, mut makes) = (0, 0);
                for _ in 0..=self.tape.below(3) {
                    let (w, m) = self.run(self.ahead.saturating_sub(works).min(6), &mut body);
                    (works, makes) = (works + w, makes + m);
                }
                if self.tape.below(4) == 3 && works > 1 && makes > 1 && self.ahead > works {
                    // The passes overlap by a short row.
                    body.push(Op::Turn(Direction::Back), picot::diag::Span::NONE);
                    body.push(Op::Work { stitch: Stitch::SC, times: 1 }, picot::diag::Span::NONE);
                    body.push(Op::Turn(Direction::Forward), picot::diag::Span::NONE);
                    (works, makes) = (works - 1, makes - 1);
                }
                let most = (self.ahead.saturating_sub(1)) / works.max(1);
                let times = if works == 0 { 2 } else { most.min(1 + self.tape.below(5)) };
                if !body.is_empty() && times > 0 {
                    self.ahead -= works * times;
                    self.behind += makes * times;
                    out.push(Op::repeat(body, times), picot::diag::Span::NONE);
                }
            }
            14 if self.colors > 0 => {
                let color = self.tape.below(u32::from(self.colors)) as u16;
                out.push(Op::Color(color), picot::diag::Span::NONE);
            }
            _ => {
                let (works, makes) = self.run(self.ahead, out);
                self.ahead -= works;
                self.behind += makes;
            }
        }
    }
}

fn sc(times: u32) -> Op {
    Op::Work { stitch: Stitch::SC, times }
}

/// One row on `have` loops, and the loops it leaves; `hold` sets loops aside for a part.
fn row(
    tape: &mut Tape<'_>,
    have: u32,
    flat: bool,
    colors: u16,
    hold: Option<PartId>,
) -> (Row, u32, Option<u32>) {
    let none = picot::diag::Span::NONE;
    let mut body = Block::default();
    let mixed = tape.below(2) == 1;
    let mut maker = Maker { tape, ahead: have, behind: 0, colors, mixed };
    if have > 1 && maker.mixed && maker.tape.below(6) == 5 {
        // A chain that stands for the first stitch.
        let high = maker.tape.below(8);
        if high > 0 {
            body.push(Op::Work { stitch: Stitch::plain(Kind::Ch), times: high }, none);
        }
        body.push(
            Op::Work { stitch: Stitch { works: 1, makes: 1, ..Stitch::plain(Kind::Ch) }, times: 1 },
            none,
        );
        (maker.ahead, maker.behind) = (have - 1, 1);
    }
    for _ in 0..maker.tape.below(6) {
        maker.one(&mut body);
    }
    let mut held = None;
    if let Some(by) = hold
        && maker.ahead > 3
    {
        let loops = 2 + maker.tape.below(maker.ahead - 3);
        body.push(Op::Hold { loops, by }, none);
        maker.ahead -= loops;
        held = Some(loops);
    }
    let leave = maker.tape.below(5) == 4 && maker.ahead > 0 && maker.behind > 0;
    let mut left = 0;
    if leave {
        left = 1 + maker.tape.below(maker.ahead);
        maker.ahead -= left;
    }
    if maker.ahead > 0 || maker.behind == 0 {
        if maker.ahead > 0 {
            body.push(sc(maker.ahead), none);
        }
        if maker.ahead == 0 {
            body.push(Op::Work { stitch: Stitch { makes: 1, ..Stitch::plain(Kind::Ch) }, times: 2 }, none);
            maker.behind += 2;
        }
        maker.behind += maker.ahead;
    }
    if leave {
        body.push(Op::Leave { loops: left }, none);
    } else if maker.tape.below(8) == 7 {
        body.push(
            Op::Work { stitch: Stitch { works: 0, makes: 0, ..Stitch::plain(Kind::SlSt) }, times: 1 },
            none,
        );
    }
    let leaves = if flat { maker.behind } else { maker.behind + left };
    (Row::new(body), leaves, held)
}

const NAMES: &[&str] = &[
    "Leg",
    "Left arm",
    "body",
    "Part 2",
    "r2",
    "Rnd",
    "the head",
    "Back",
    "V",
    "turn",
    "Ärmel",
    "x",
    "hook",
    "dc",
    "Size",
    "Ohr 3",
    "and so",
    "7 up",
    "a",
    "M",
    "Mit Punkt.",
];

/// A part with its rows, and the loops that it holds and leaves.
fn part(
    tape: &mut Tape<'_>,
    name: &str,
    start: Option<Start>,
    colors: u16,
    hold: Option<PartId>,
) -> (Part, u32, Option<u32>) {
    let flat = tape.below(3) == 2;
    let mut rows = Vec::new();
    let start = start.unwrap_or_else(|| match tape.below(6) {
        0 | 1 => Start::Ring { loops: 3 + tape.below(20) },
        2 => Start::Chain { loops: 2 + tape.below(40), joined: !flat },
        3 => Start::Chain { loops: 2 + tape.below(40), joined: false },
        4 => Start::Chain { loops: 0, joined: false },
        _ => Start::Ring { loops: 0 },
    });
    let mut have = start.loops();
    let first = match start {
        Start::Chain { loops: 0, .. } => {
            let count = 2 + tape.below(30);
            have = count;
            Some(vec![Op::Work { stitch: Stitch::plain(Kind::Fsc), times: count }])
        }
        Start::Ring { loops: 0 } => {
            let stitch = Stitch { works: 0, ..Stitch::plain(tape.pick(&[Kind::Dc, Kind::Hdc, Kind::Tr])) };
            let chain = Stitch { makes: 1, ..Stitch::plain(Kind::Ch) };
            let (a, b) = (1 + tape.below(9), tape.below(4));
            have = a;
            let mut ops = vec![Op::Work { stitch, times: a }];
            if b > 0 {
                have += 2 * b;
                let work = Op::Work { stitch, times: 1 };
                let body = [work, Op::Work { stitch: chain, times: 1 }].into_iter().collect();
                ops.insert(0, Op::repeat(body, b));
            }
            Some(ops)
        }
        Start::Ring { .. } | Start::Chain { .. } | Start::Join { .. } => None,
    };
    rows.extend(first.map(|ops| Row::new(ops.into_iter().collect())));
    let mut held = None;
    for index in 0..=tape.below(5) {
        let hold = hold.filter(|_| index == 1);
        let (mut row, leaves, loops) = row(tape, have, flat, colors, hold);
        held = held.or(loops);
        if leaves == have
            && loops.is_none()
            && !row.body.ops().iter().any(|op| matches!(op, Op::Leave { .. }))
        {
            row.times = 1 + tape.below(3);
        }
        rows.push(row);
        have = leaves;
        if have == 0 {
            break;
        }
    }
    if have == 0 {
        let stitch = Stitch { makes: 1, ..Stitch::plain(Kind::Ch) };
        rows.push(Row::new([Op::Work { stitch, times: 3 }].into_iter().collect()));
        have = 3;
    }
    let shut = tape.below(4) == 3
        && !rows.iter().any(|row| row.body.spanned().any(|(op, _)| matches!(op, Op::Leave { .. })));
    let finish = if shut { Finish::DrawnShut } else { Finish::Open };
    let part = Part { name: name.to_owned(), start, rows, finish, flat, copies: 1 };
    (part, have, held)
}

fn program(tape: &mut Tape<'_>) -> Program {
    let palette = ["white", "B", "dark red", "A", "dc", "E"];
    let colors = tape.below(palette.len() as u32 + 1) as u16;
    let first_name = tape.below(NAMES.len() as u32) as usize;
    let name = |index: usize| NAMES[(first_name + index) % NAMES.len()];
    let mut parts = Vec::new();
    let shape = tape.below(4);
    // A part that is picked up stays open, and is one piece.
    let hold = (shape == 1).then_some(PartId(1));
    let (mut first, open, held) = part(tape, name(0), None, colors, hold);
    match (shape, held) {
        (1, Some(loops)) => {
            first.finish = Finish::Open;
            parts.push(first);
            let start = Start::Join { segments: vec![Segment::Held { part: PartId(0), loops }] };
            parts.push(part(tape, name(1), Some(start), colors, None).0);
        }
        (2, _) => {
            first.finish = Finish::Open;
            let (mut second, more, _) = part(tape, name(1), None, colors, None);
            second.finish = Finish::Open;
            let chain = Segment::Chain { loops: 1 + tape.below(5) };
            let (a, b) = (
                Segment::Open { part: PartId(0), loops: open },
                Segment::Open { part: PartId(1), loops: more },
            );
            let segments = match tape.below(4) {
                0 => vec![a, chain, b, chain],
                1 => vec![a, chain, b],
                2 => vec![a, b],
                _ => vec![a, Segment::Chain { loops: 3 }],
            };
            parts.push(first);
            parts.push(second);
            parts.push(part(tape, name(2), Some(Start::Join { segments }), colors, None).0);
        }
        (3, _) => {
            first.copies = 2 + tape.below(3);
            parts.push(first);
            parts.push(part(tape, name(1), None, colors, None).0);
        }
        _ => {
            parts.push(first);
        }
    }
    let colors = palette.iter().take(usize::from(colors)).map(|color| (*color).to_owned()).collect();
    let maker = picot::ir::Maker {
        hand: if tape.below(3) == 2 { Hand::Left } else { Hand::Right },
        lean: if tape.below(3) == 2 { f64::from(tape.below(2001)) / 1000.0 - 1.0 } else { 0.0 },
    };
    Program {
        name: "thing".into(),
        gauge: None,
        maker,
        colors,
        pattern: Pattern { parts },
        graphs: Vec::new(),
    }
}

proptest! {
    #![proptest_config(arbitrary::config(250))]

    #[test]
    fn arbitrary_patterns_read_back_in_every_language(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let program = program(&mut Tape(bytes.iter()));
        let mut sink = Sink::new();
        // The verifier has the last word on what is a pattern.
        if verify(&program, &mut sink).is_none() {
            return Err(TestCaseError::reject("not a pattern"));
        }
        prop_assert!(round_trip(&program).is_ok(), "{}", round_trip(&program).unwrap_err());
    }
}
