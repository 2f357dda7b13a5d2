//! Translation validation: the loops that a machine program makes are the loops of the pattern.
//!
//! The program is executed and its history read back, with no help from the lowering: the loops of the pieces' yarns in
//! the order of making, and for each the loops it was pulled through. The pattern is worked loop by loop beside it.
//! Both must give the same stitches in the same order, of the same colors, through the same loops; at the end of every
//! row the open loops must hang around the beds in the pattern's order; and in the end every loop must be secured.

use super::Options;
use super::begin::{self, Begin, Source};
use super::plan::{self, Action, Leg};
use super::replay::Replay;
use crate::diag::{Code as Finding, Diagnostic, Sink};
use crate::ir::machine::{CarrierId, Code, Instruction, LoopId, Machine, Made, NONE, Needles, execute};
use crate::ir::{Direction, Part, PartId, Program};
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// Compares a program with the pattern it was made from. True when they agree; else the sink has the first difference.
/// The program is taken to be free of violations.
pub fn validate(
    program: &Program,
    code: &Code,
    machine: Option<&Machine>,
    options: &Options,
    sink: &mut Sink<'_>,
) -> bool {
    let run = execute(code, machine, &mut Sink::new());
    let needles = &run.needles;
    let (stitches, fresh) = stitches(code, needles, machine);
    let sources = Sources::new(needles, &stitches);
    let mut walk = Walk {
        program,
        options,
        needles,
        stitches: &stitches,
        fresh: &fresh,
        next: 0,
        sources,
        replay: Replay::new(code, needles),
        all: BTreeSet::new(),
        ends: BTreeMap::new(),
        held: BTreeMap::new(),
        colors: BTreeMap::new(),
        moved: BTreeSet::new(),
        open: Open::default(),
        round: 0,
        stitch: 0,
    };
    for piece in begin::order(&program.pattern).into_iter().flatten() {
        let Some(part) = program.pattern.parts.get(piece.part as usize) else { continue };
        if let Err(difference) = walk.piece(part, piece) {
            let Difference { message, op } = difference;
            let at = if walk.stitch > 0 { format!(" at stitch {}", walk.stitch) } else { String::new() };
            let mut diagnostic = Diagnostic::new(Finding::NotTheSame, format!("{message}{at}"))
                .in_round(&part.name, Some(walk.round));
            if let Some(op) = op {
                diagnostic = diagnostic.at(code.span(op as usize), "here");
            }
            sink.push(diagnostic);
            return false;
        }
    }
    let more = walk.more();
    let loose = walk.all.iter().find(|&&id| needles.get(id).is_none_or(|found| found.into == NONE));
    let (message, op) = match loose {
        Some(&id) => (
            "a loop of the pattern is not secured at the end",
            needles.get(id).map(|found| found.op as usize),
        ),
        None if more => ("the program knits more pieces than the pattern has", None),
        None => return true,
    };
    let span = op.map(|op| code.span(op)).unwrap_or_default();
    sink.push(Diagnostic::new(Finding::NotTheSame, message).at(span, ""));
    false
}

struct Difference {
    message: String,
    op: Option<u32>,
}

/// The loops of the pieces in the order of making, without wraps, and those of them with which a yarn begins. Waste yarn
/// and draw thread do not count.
fn stitches(code: &Code, needles: &Needles, machine: Option<&Machine>) -> (Vec<LoopId>, BTreeSet<LoopId>) {
    let waste = machine.and_then(|machine| machine.waste.as_ref());
    let is_piece = |id: CarrierId| {
        waste.is_none_or(|waste| code.carrier(id) != waste.carrier && code.carrier(id) != waste.draw)
    };
    let mut brought = Vec::new();
    for (op, instruction) in code.ops().iter().enumerate() {
        if let Instruction::In(set) | Instruction::InHook(set) = instruction {
            brought.extend(set.iter().map(|&id| (op as u32, id)));
        }
    }
    let (mut stitches, mut fresh) = (Vec::new(), BTreeSet::new());
    let mut begun: BTreeSet<CarrierId> = BTreeSet::new();
    let mut next = brought.iter().peekable();
    for (id, found) in needles.loops().iter().enumerate() {
        while let Some(&(_, carrier)) = next.next_if(|(op, _)| *op < found.op) {
            begun.insert(carrier);
        }
        if !is_piece(found.carrier) || found.made == Made::Wrap {
            continue;
        }
        if begun.remove(&found.carrier) {
            fresh.insert(id as LoopId);
        }
        stitches.push(id as LoopId);
    }
    (stitches, fresh)
}

/// The open loops of a piece, as the hook sees them.
#[derive(Default)]
struct Open {
    ahead: VecDeque<LoopId>,
    behind: VecDeque<LoopId>,
    /// Of a flat piece: loops left on the side from which the row goes away.
    rest: VecDeque<LoopId>,
}

struct Walk<'a> {
    program: &'a Program,
    options: &'a Options,
    needles: &'a Needles,
    stitches: &'a [LoopId],
    fresh: &'a BTreeSet<LoopId>,
    /// Place of the next stitch.
    next: usize,
    sources: Sources,
    replay: Replay<'a>,
    /// All loops of the pattern.
    all: BTreeSet<LoopId>,
    /// Loops that pieces left open, by part.
    ends: BTreeMap<PartId, VecDeque<VecDeque<LoopId>>>,
    /// Loops set aside, by giving and taking part.
    held: BTreeMap<(PartId, PartId), VecDeque<VecDeque<LoopId>>>,
    colors: BTreeMap<u16, CarrierId>,
    /// Loops that splits of the row have moved.
    moved: BTreeSet<LoopId>,
    open: Open,
    round: u32,
    stitch: u32,
}

impl Walk<'_> {
    fn fail<T>(&self, message: &str, id: Option<LoopId>) -> Result<T, Difference> {
        let op = id.and_then(|id| self.needles.get(id)).map(|found| found.op);
        Err(Difference { message: message.to_owned(), op })
    }

    fn made(&self, id: LoopId) -> Option<Made> {
        self.needles.get(id).map(|found| found.made)
    }

    fn take(&mut self, count: usize) -> Vec<LoopId> {
        let found: Vec<LoopId> = self.stitches.iter().skip(self.next).take(count).copied().collect();
        self.next += found.len();
        found
    }

    /// Passes over the loops of a bind-off; true when another yarn begins.
    fn more(&mut self) -> bool {
        while let Some(id) = self.stitches.get(self.next)
            && !self.fresh.contains(id)
        {
            self.next += 1;
        }
        self.next < self.stitches.len()
    }

    fn piece(&mut self, part: &Part, piece: begin::Piece) -> Result<(), Difference> {
        (self.round, self.stitch) = (0, 0);
        self.open = Open::default();
        if !self.more() {
            return self.fail("the program knits fewer pieces than the pattern has", None);
        }
        let pattern = &self.program.pattern;
        let begin = begin::begin(pattern, part, self.options, &mut Sink::new());
        let mut skipped = 0;
        match begin {
            None => return self.fail("the part begins on loops that no needle holds", None),
            Some(Begin::Fresh { loops, skipped: rows, .. }) => {
                skipped = rows;
                self.cast_on(part, loops)?;
            }
            Some(Begin::Join(sources)) => self.join(&sources, PartId(piece.part))?,
        }
        let mut color = begin::first_color(part);
        for (number, row) in part.numbered_rows().skip(skipped) {
            for number in number..number.saturating_add(row.times) {
                (self.round, self.stitch) = (number, 0);
                let Some(plan) = plan::row(part, row, number, color, self.options, &mut Sink::new()) else {
                    return self.fail("the round cannot be knit", None);
                };
                color = plan.color;
                self.row(part, PartId(piece.part), &plan.legs)?;
                for _ in 0..plan.plain_rounds {
                    let plain = Leg::plain(self.open.ahead.len(), color);
                    self.row(part, PartId(piece.part), &[plain])?;
                }
            }
        }
        self.stitch = 0;
        if piece.kept {
            let open = std::mem::take(&mut self.open.ahead);
            self.ends.entry(PartId(piece.part)).or_default().push_back(open);
        }
        Ok(())
    }

    /// Tucks in the air, and the first course through them.
    fn cast_on(&mut self, part: &Part, loops: u32) -> Result<(), Difference> {
        self.round = 1;
        while let Some(&id) = self.stitches.get(self.next)
            && self.made(id) != Some(Made::Knit)
        {
            self.next += 1;
        }
        let first = self.take(loops as usize);
        if first.len() < loops as usize || first.iter().any(|&id| self.made(id) != Some(Made::Knit)) {
            let message =
                format!("the first round has {loops} loops in the pattern and other ones on the needles");
            return self.fail(&message, first.first().copied());
        }
        self.all.extend(&first);
        self.open.ahead = if part.flat { first.into_iter().rev().collect() } else { first.into() };
        Ok(())
    }

    /// Loops that other pieces left, and new ones, which are found by where they hang.
    fn join(&mut self, sources: &[Source], to: PartId) -> Result<(), Difference> {
        let mut begin: Vec<Option<LoopId>> = Vec::new();
        for (at, source) in sources.iter().enumerate() {
            let more = begin::more_of(sources, at);
            let last = |waiting: &mut VecDeque<VecDeque<LoopId>>| {
                waiting.remove(waiting.len().checked_sub(more + 1)?)
            };
            let loops = match *source {
                Source::Open(from) => self.ends.get_mut(&from).and_then(last),
                Source::Held(from, _) => self.held.get_mut(&(from, to)).and_then(last),
                Source::Chain(loops) => {
                    begin.extend(std::iter::repeat_n(None, loops as usize));
                    continue;
                }
            };
            let Some(loops) = loops else { return self.fail("no loops wait for the part", None) };
            if let Source::Held(_, count) = *source
                && loops.len() != count as usize
            {
                return self.fail("other loops wait for the part", None);
            }
            begin.extend(loops.into_iter().map(Some));
        }
        let new = begin.iter().filter(|place| place.is_none()).count();
        if new == 0 {
            self.open.ahead = begin.into_iter().flatten().collect();
            return Ok(());
        }
        let chains = self.take(new);
        if chains.len() < new || chains.iter().any(|&id| self.made(id) != Some(Made::Tuck)) {
            return self.fail("the chains of the start are not cast on", chains.first().copied());
        }
        let set: BTreeSet<LoopId> = begin.iter().flatten().chain(&chains).copied().collect();
        let op = chains.last().and_then(|&id| self.needles.get(id)).map_or(0, |found| found.op);
        let mut around = self.replay.around(op, &set);
        let known = begin.iter().position(Option::is_some);
        let turned = known.and_then(|at| {
            let id = *begin.get(at)?;
            let found = around.iter().position(|other| Some(*other) == id)?;
            Some((found + around.len() - at) % around.len())
        });
        around.rotate_left(turned.unwrap_or(0));
        let fits =
            |(place, id): (&Option<LoopId>, &LoopId)| place.map_or(chains.contains(id), |known| known == *id);
        if around.len() != begin.len() || !begin.iter().zip(&around).all(fits) {
            return self.fail(
                "the loops of the start do not hang in the order of the pattern",
                chains.last().copied(),
            );
        }
        self.all.extend(&chains);
        self.open.ahead = around.into();
        Ok(())
    }

    fn row(&mut self, part: &Part, id: PartId, legs: &[Leg]) -> Result<(), Difference> {
        let mut last = None;
        for leg in legs {
            if let Some((loops, by)) = leg.hold {
                let loops = (loops as usize).min(self.open.ahead.len());
                let aside = self.open.ahead.drain(..loops).collect();
                self.held.entry((id, by)).or_default().push_back(aside);
            }
            let forward = leg.direction == Direction::Forward;
            for &action in &leg.actions {
                self.stitch += 1;
                let tops = self.action(action, forward)?;
                last = tops.last().copied().or(last);
                if forward {
                    self.open.behind.extend(tops);
                } else {
                    for top in tops {
                        self.open.ahead.push_front(top);
                    }
                }
            }
        }
        self.stitch = 0;
        if let Some(last) = last
            && !self.hang_in_order(part, last)
        {
            return self.fail("the loops do not hang in the order of the pattern", Some(last));
        }
        let open = &mut self.open;
        if part.flat {
            let left = std::mem::take(&mut open.ahead);
            open.ahead = open.behind.drain(..).rev().collect();
            open.ahead.append(&mut open.rest);
            open.rest = left;
        } else {
            open.ahead.append(&mut open.behind);
        }
        Ok(())
    }

    /// One stitch: its loops, which must be pulled through those that the pattern works.
    fn action(&mut self, action: Action, forward: bool) -> Result<Vec<LoopId>, Difference> {
        let open = &mut self.open;
        let mut parents: Vec<LoopId> = (0..action.works)
            .filter_map(|_| if forward { open.ahead.pop_front() } else { open.behind.pop_back() })
            .collect();
        parents.sort_unstable();
        if let (2, &[parent]) = (action.makes, parents.as_slice())
            && let Some(made) = self.split(parent, action)?
        {
            return Ok(if forward { vec![made, parent] } else { vec![parent, made] });
        }
        let made = self.take(usize::from(action.makes));
        let first = made.first().copied();
        if made.len() < usize::from(action.makes) {
            return self.fail("the program has fewer loops than the pattern", first);
        }
        let worked: Vec<LoopId> =
            made.iter().copied().filter(|&id| self.made(id) == Some(Made::Knit)).collect();
        match (action.works, worked.as_slice()) {
            (0, []) => {}
            (1.., &[worked]) => {
                if self.sources.of(worked) != parents {
                    let message = "the loop is not pulled through the loops that the pattern works";
                    return self.fail(message, first);
                }
            }
            _ => return self.fail("an increase is not one knit loop and tucks beside it", first),
        }
        if self.program.colors.len() > 1 {
            self.colored(action.color, &made)?;
        }
        self.all.extend(&made);
        Ok(made)
    }

    /// An increase made by a split: the new loop, while the old one stays open beside it.
    fn split(&mut self, parent: LoopId, action: Action) -> Result<Option<LoopId>, Difference> {
        let Some(&id) = self.stitches.get(self.next).filter(|&&id| self.made(id) == Some(Made::Split)) else {
            return Ok(None);
        };
        self.next += 1;
        let op = self.needles.get(id).map_or(0, |found| found.op);
        if self.replay.moved_by_split(op) != Some(parent) {
            return self.fail("the loop is not split off the loop that the pattern works", Some(id));
        }
        if self.program.colors.len() > 1 {
            self.colored(action.color, &[id])?;
        }
        self.all.insert(id);
        self.moved.insert(parent);
        Ok(Some(id))
    }

    /// Each color has a carrier of its own.
    fn colored(&mut self, color: u16, made: &[LoopId]) -> Result<(), Difference> {
        for &id in made {
            let Some(carrier) = self.needles.get(id).map(|found| found.carrier) else { continue };
            let known = *self.colors.entry(color).or_insert(carrier);
            let other = self.colors.iter().any(|(of, used)| *of != color && *used == carrier);
            if known != carrier || other {
                return self.fail("the loop is of another color", Some(id));
            }
        }
        Ok(())
    }

    /// True when, after the last loop of a row, the open loops hang in the order of the pattern.
    fn hang_in_order(&mut self, part: &Part, last: LoopId) -> bool {
        let Open { ahead, behind, rest } = &self.open;
        let expected: Vec<LoopId> = if part.flat {
            rest.iter().rev().chain(behind).chain(ahead).copied().collect()
        } else {
            ahead.iter().chain(behind).copied().collect()
        };
        let set: BTreeSet<LoopId> = expected.iter().copied().collect();
        let op = self.needles.get(last).map_or(0, |found| found.op);
        let moved = std::mem::take(&mut self.moved);
        if !moved.is_empty() {
            self.replay.settle(op, &moved);
        }
        let mut around = self.replay.around(op, &set);
        if part.flat {
            return around == expected || around.iter().rev().eq(expected.iter());
        }
        match expected.first().and_then(|first| around.iter().position(|id| id == first)) {
            Some(start) => around.rotate_left(start),
            None => return expected.is_empty() && around.is_empty(),
        }
        around == expected
    }
}

/// For each loop the loops it was pulled through, wraps left out.
struct Sources {
    /// Loops sorted by what was pulled through them.
    into: Vec<(LoopId, LoopId)>,
}

impl Sources {
    fn new(needles: &Needles, stitches: &[LoopId]) -> Self {
        let mut into: Vec<(LoopId, LoopId)> = stitches
            .iter()
            .filter_map(|&id| needles.get(id).map(|found| (found.into, id)))
            .filter(|&(into, _)| into != NONE)
            .collect();
        into.sort_unstable();
        Self { into }
    }

    fn of(&self, id: LoopId) -> Vec<LoopId> {
        let start = self.into.partition_point(|&(into, _)| into < id);
        self.into.iter().skip(start).take_while(|&&(into, _)| into == id).map(|&(_, source)| source).collect()
    }
}
