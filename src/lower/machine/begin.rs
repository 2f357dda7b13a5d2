//! How parts begin on a machine, and in which order their pieces are knit: what hangs on the needles at that moment.

use super::Options;
use crate::diag::{Code as Finding, Diagnostic, Sink};
use crate::ir::{Block, Op, Part, PartId, Pattern, Segment, Start, Step};

/// The first loops of a piece.
#[derive(Clone, Debug, PartialEq)]
pub enum Begin {
    /// Cast on.
    Fresh {
        /// Loops of the first course.
        loops: u32,
        /// Both sides of a chain are worked, so the cast-on joins the beds.
        closed: bool,
        /// Rows of the part that the cast-on already stands for.
        skipped: usize,
    },
    /// Loops that hang on their needles, and new ones between them, in working order.
    Join(Vec<Source>),
}

/// A stretch of the loops that a piece begins on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// All loops at the end of a part.
    Open(PartId),
    /// Loops that a part set aside.
    Held(PartId, u32),
    /// New loops, cast on.
    Chain(u32),
}

/// One piece to be knit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Piece {
    /// Its part.
    pub part: u32,
    /// Its loops stay on the needles at the end, for another part.
    pub kept: bool,
}

/// All pieces in the order of knitting, in groups: the pieces of a group hang on the beds together, and when a group
/// ends the beds are empty. A part of which several are made is knit that often.
pub fn order(pattern: &Pattern) -> Vec<Vec<Piece>> {
    let parts = &pattern.parts;
    let mut uses = vec![0_u32; parts.len()];
    let mut group: Vec<usize> = (0..parts.len()).collect();
    for (index, part) in parts.iter().enumerate() {
        let Start::Join { segments } = &part.start else { continue };
        for segment in segments {
            let (Segment::Open { part: from, .. } | Segment::Held { part: from, .. }) = segment else {
                continue;
            };
            let from = from.0 as usize;
            if let (Segment::Open { .. }, Some(count)) = (segment, uses.get_mut(from)) {
                *count = count.saturating_add(part.copies);
            }
            // A part joins the group of the earliest part that it hangs together with.
            if let (Some(&a), Some(&b)) = (group.get(from), group.get(index)) {
                let (first, other) = (a.min(b), a.max(b));
                group.iter_mut().filter(|of| **of == other).for_each(|of| *of = first);
            }
        }
    }
    let mut groups = Vec::new();
    for lead in 0..parts.len() {
        let mut members: Vec<usize> =
            (0..parts.len()).filter(|&index| group.get(index) == Some(&lead)).collect();
        nearest_first(pattern, &mut members);
        let pieces: Vec<Piece> = members
            .into_iter()
            .flat_map(|index| {
                let copies = parts.get(index).map_or(0, |part| part.copies);
                let uses = uses.get(index).copied().unwrap_or(0);
                (0..copies).map(move |copy| Piece { part: index as u32, kept: copy < uses })
            })
            .collect();
        if !pieces.is_empty() {
            groups.push(pieces);
        }
    }
    groups
}

/// Limbs that grow from one part and stand next to each other in the pattern begin with the one whose loops were set
/// aside last: it hangs nearest to the yarn, which so never lies across loops that wait.
fn nearest_first(pattern: &Pattern, members: &mut [usize]) {
    let from = |&index: &usize| match &pattern.parts.get(index)?.start {
        Start::Join { segments } => {
            let mut held = segments.iter().filter(|segment| !matches!(segment, Segment::Chain { .. }));
            let Segment::Held { part, .. } = *held.next()? else { return None };
            held.all(|other| matches!(other, Segment::Held { part: other, .. } if *other == part))
                .then_some(part)
        }
        Start::Ring { .. } | Start::Chain { .. } => None,
    };
    for run in members.chunk_by_mut(|a, b| from(a).is_some() && from(a) == from(b)) {
        let mut order = Vec::new();
        if let Some(part) = run.first().and_then(from).and_then(|part| pattern.parts.get(part.0 as usize)) {
            part.rows.iter().for_each(|row| holds(&row.body, &mut order));
        }
        let place = |index: usize| order.iter().rposition(|by| by.0 as usize == index);
        run.sort_by_key(|&index| std::cmp::Reverse(place(index)));
    }
}

/// The parts for which a block sets loops aside, in order.
fn holds(block: &Block, order: &mut Vec<PartId>) {
    for op in block.ops() {
        match op {
            Op::Hold { by, .. } => order.push(*by),
            Op::Repeat { body, .. } => holds(body, order),
            Op::Work { .. } | Op::Turn(_) | Op::Leave { .. } | Op::Color(_) => {}
        }
    }
}

/// How many stretches of the same kind a piece takes after this one. Of equal stretches a piece takes the last ones,
/// for they hang nearest to the yarn.
pub(super) fn more_of(sources: &[Source], at: usize) -> usize {
    let key = |source: &Source| match *source {
        Source::Open(part) => Some((part, true)),
        Source::Held(part, _) => Some((part, false)),
        Source::Chain(_) => None,
    };
    let this = sources.get(at).and_then(key);
    sources.iter().skip(at + 1).filter(|source| key(source) == this).count()
}

/// How a part begins. `None` with the reason in the sink when it begins on loops that no needle holds.
pub fn begin(pattern: &Pattern, part: &Part, options: &Options, sink: &mut Sink<'_>) -> Option<Begin> {
    let Start::Join { segments } = &part.start else { return Some(fresh(part)) };
    let mut sources: Vec<Source> = Vec::new();
    let (mut sewn, mut places) = (0_u64, Vec::new());
    for segment in segments {
        let source = match *segment {
            Segment::Open { part, .. } => Source::Open(part),
            Segment::Held { part, loops } => Source::Held(part, loops),
            Segment::Chain { loops } => Source::Chain(loops),
            Segment::Surface { part: from, round, first, loops, .. } => {
                let name = pattern.parts.get(from.0 as usize).map_or("?", |from| from.name.as_str());
                let last = first.saturating_add(loops.saturating_sub(1));
                let (stitches, are, them) = match loops {
                    1 => (format!("stitch {first}"), "is", "it"),
                    _ => (format!("stitches {first} to {last}"), "are", "them"),
                };
                let place = format!("{stitches} of round {round} of {name}");
                if !options.approximate {
                    sink.push(
                        Diagnostic::new(
                            Finding::LoopsFinished,
                            format!("{place} {are} finished, and no needle can pick {them} up"),
                        )
                        .in_round(&part.name, None)
                        .help(
                            "--set approximate=true knits the part from a cast-on of its own, to be sewn there; \
                             or let the round hold its loops for the part",
                        ),
                    );
                    return None;
                }
                sewn += u64::from(loops);
                places.push(place);
                Source::Chain(loops)
            }
        };
        match (sources.last_mut(), source) {
            (Some(Source::Chain(before)), Source::Chain(loops)) => *before = before.saturating_add(loops),
            (_, source) => sources.push(source),
        }
    }
    if sewn > 0 {
        let loops = if sewn == 1 { "1 loop is" } else { &format!("{sewn} loops are") };
        let message = format!("{loops} cast on, to be sewn to {}", places.join(", "));
        let found = Diagnostic::new(Finding::SewOn, message).in_round(&part.name, None);
        sink.push(found.help("leave a long tail, and sew loop to loop"));
    }
    match sources.as_slice() {
        [] => Some(fresh(part)),
        &[Source::Chain(loops)] => Some(Begin::Fresh { loops, closed: false, skipped: 0 }),
        _ => Some(Begin::Join(sources)),
    }
}

fn fresh(part: &Part) -> Begin {
    let closed = matches!(part.start, Start::Chain { joined: false, .. }) && !part.flat;
    match part.start.loops() {
        0 => {
            let steps = part.rows.first().map(|row| row.body.steps());
            let loops = steps.into_iter().flatten().fold(0_u32, |sum, step| match step {
                Step::Work(stitch) => sum.saturating_add(u32::from(stitch.makes)),
                Step::Turn(_) | Step::Hold { .. } | Step::Leave { .. } | Step::Color(_) => sum,
            });
            Begin::Fresh { loops, closed, skipped: 1 }
        }
        loops => Begin::Fresh { loops, closed, skipped: 0 },
    }
}

/// The color of the first stitch.
pub fn first_color(part: &Part) -> u16 {
    let steps = part.rows.iter().flat_map(|row| row.body.steps());
    steps
        .take_while(|step| !matches!(step, Step::Work(_)))
        .filter_map(|step| if let Step::Color(color) = step { Some(color) } else { None })
        .last()
        .unwrap_or(0)
}
