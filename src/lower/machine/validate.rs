//! Translation validation: the loops that a machine program makes are the loops of the pattern.
//!
//! The program is executed and its history read back, with no help from the lowering: the loops of the piece's yarn in
//! the order of making, and for each the loops it was pulled through. The pattern is worked loop by loop beside it.
//! Both must give the same stitches in the same order, through the same loops; at the end of every row the open loops
//! must hang around the beds in the pattern's order; and at the end of the part every loop must be secured.

use super::plan::{self, Leg};
use super::{Options, joined};
use crate::diag::{Code as Finding, Diagnostic, Sink};
use crate::ir::machine::{
    Bed, CarrierId, Code, Instruction, LoopId, Machine, Made, NONE, Needle, Needles, execute,
};
use crate::ir::{Direction, Part, Program};
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// Compares a program with the pattern it was made from. True when they agree; else the sink has the first difference
/// of each part. The program is taken to be free of violations.
pub fn validate(
    program: &Program,
    code: &Code,
    machine: Option<&Machine>,
    options: &Options,
    sink: &mut Sink<'_>,
) -> bool {
    let run = execute(code, machine, &mut Sink::new());
    let mut segments = segments(code, &run.needles, machine);
    let parts = &program.pattern.parts;
    if segments.len() != parts.len() {
        let message =
            format!("the program knits {} pieces, the pattern has {} parts", segments.len(), parts.len());
        sink.push(Diagnostic::new(Finding::NotTheSame, message));
        return false;
    }
    let mut replay = Replay { code, needles: &run.needles, at: 0, held: BTreeMap::new(), next: 0 };
    let mut same = true;
    for (part, loops) in parts.iter().zip(&mut segments) {
        if let Err(difference) = compare(part, loops, &mut replay, options) {
            let Difference { round, stitch, message, op } = difference;
            let at = if stitch > 0 { format!(" at stitch {stitch}") } else { String::new() };
            let mut diagnostic = Diagnostic::new(Finding::NotTheSame, format!("{message}{at}"))
                .in_round(&part.name, Some(round));
            if let Some(op) = op {
                diagnostic = diagnostic.at(code.span(op), "here");
            }
            sink.push(diagnostic);
            same = false;
        }
    }
    same
}

struct Difference {
    round: u32,
    stitch: u32,
    message: String,
    op: Option<usize>,
}

/// The loops of each piece: what one yarn makes from coming in to going out. Waste yarn and draw thread do not count.
fn segments(code: &Code, needles: &Needles, machine: Option<&Machine>) -> Vec<Vec<LoopId>> {
    let mut brought: Vec<(u32, CarrierId)> = Vec::new();
    for (op, instruction) in code.ops().iter().enumerate() {
        if let Instruction::In(set) | Instruction::InHook(set) = instruction {
            brought.extend(set.iter().map(|&id| (op as u32, id)));
        }
    }
    let is_piece = |id: CarrierId| {
        let waste = machine.and_then(|machine| machine.waste.as_ref());
        waste.is_none_or(|waste| code.carrier(id) != waste.carrier && code.carrier(id) != waste.draw)
    };
    brought.retain(|&(_, id)| is_piece(id));
    let mut segments: Vec<Vec<LoopId>> = vec![Vec::new(); brought.len()];
    // For each carrier the piece that it is knitting, as loops come in the order of their instructions.
    let mut current: BTreeMap<CarrierId, usize> = BTreeMap::new();
    let mut next = 0;
    for (id, found) in needles.loops().iter().enumerate() {
        while let Some(&(_, carrier)) = brought.get(next).filter(|(op, _)| *op < found.op) {
            current.insert(carrier, next);
            next += 1;
        }
        if let Some(segment) = current.get(&found.carrier).and_then(|&at| segments.get_mut(at)) {
            segment.push(id as LoopId);
        }
    }
    segments.retain(|segment| !segment.is_empty());
    segments
}

fn compare(
    part: &Part,
    loops: &[LoopId],
    replay: &mut Replay<'_>,
    options: &Options,
) -> Result<(), Difference> {
    let fail = |round: u32, stitch: u32, message: &str, op: Option<usize>| Difference {
        round,
        stitch,
        message: message.to_owned(),
        op,
    };
    if joined(part) {
        return Err(fail(0, 0, "the part begins on loops of another part, which cannot be compared", None));
    }
    let needles = replay.needles;
    let get = |id: LoopId| needles.get(id).copied();
    // Wraps are no stitches. The tucks of the cast-on come before all knit loops.
    let stitches: Vec<LoopId> =
        loops.iter().copied().filter(|&id| get(id).is_some_and(|found| found.made != Made::Wrap)).collect();
    let cast = stitches
        .iter()
        .position(|&id| get(id).is_some_and(|found| found.made == Made::Knit))
        .ok_or_else(|| fail(0, 0, "nothing is knit", None))?;
    let mut rest = stitches.get(cast..).unwrap_or_default().iter().copied();
    let (count, skipped) = plan::cast_on(part);
    let mut open: VecDeque<LoopId> = rest.by_ref().take(count as usize).collect();
    if open.len() < count as usize
        || open.iter().any(|&id| get(id).is_none_or(|found| found.made != Made::Knit))
    {
        let message =
            format!("the first round has {count} loops in the pattern and other ones on the needles");
        return Err(fail(1, 0, &message, None));
    }
    // Loop -> the pattern loop it stands for; the loops pulled through others are asked for their sources below.
    let sources = Sources::new(needles, &stitches, &open);
    let mut pattern_loops: BTreeSet<LoopId> = open.iter().copied().collect();
    for (number, row) in part.numbered_rows().skip(skipped) {
        for number in number..number.saturating_add(row.times) {
            let plan = plan::row(part, row, number, options, &mut Sink::new())
                .ok_or_else(|| fail(number, 0, "the round cannot be knit", None))?;
            let mut stitch = 0;
            let mut last_op = None;
            let extra = std::iter::repeat_n(None, plan.plain_rounds as usize);
            for leg in plan.legs.iter().map(Some).chain(extra) {
                let forward = leg.is_none_or(|leg| leg.direction == Direction::Forward);
                let plain = || Leg { direction: Direction::Forward, actions: vec![plan::PLAIN; open.len()] };
                let Leg { actions, .. } = leg.cloned().unwrap_or_else(plain);
                let mut tops = Vec::new();
                for action in &actions {
                    stitch += 1;
                    let mut parents: Vec<LoopId> = (0..action.works)
                        .filter_map(|_| if forward { open.pop_front() } else { open.pop_back() })
                        .collect();
                    parents.sort_unstable();
                    let made: Vec<LoopId> = rest.by_ref().take(usize::from(action.makes)).collect();
                    let op = made.first().and_then(|&id| get(id)).map(|found| found.op as usize);
                    if made.len() < usize::from(action.makes) {
                        return Err(fail(number, stitch, "the program has fewer loops than the pattern", op));
                    }
                    let knit = |id: LoopId| get(id).is_some_and(|found| found.made == Made::Knit);
                    let worked: Vec<LoopId> = made.iter().copied().filter(|&id| knit(id)).collect();
                    let [worked] = worked.as_slice() else {
                        let message = "an increase is not one knit loop and tucks beside it";
                        return Err(fail(number, stitch, message, op));
                    };
                    if sources.of(*worked) != parents {
                        let message = "the loop is not pulled through the loops that the pattern works";
                        return Err(fail(number, stitch, message, op));
                    }
                    pattern_loops.extend(&made);
                    last_op = made.last().and_then(|&id| get(id)).map(|found| found.op);
                    tops.extend(made);
                }
                if forward {
                    open.extend(tops);
                } else {
                    for top in tops {
                        open.push_front(top);
                    }
                }
            }
            if let Some(op) = last_op
                && !replay.hangs_as(&open, op)
            {
                let message = "the loops do not hang in the order of the pattern";
                return Err(fail(number, 0, message, Some(op as usize)));
            }
        }
    }
    secured(&pattern_loops, stitches.last().copied(), needles).map_err(|id| {
        let op = get(id).map(|found| found.op as usize);
        fail(0, 0, "a loop of the pattern is not secured at the end", op)
    })
}

/// Every loop but the last of the yarn has a loop pulled through it.
fn secured(loops: &BTreeSet<LoopId>, last: Option<LoopId>, needles: &Needles) -> Result<(), LoopId> {
    let loose = |id: LoopId| needles.get(id).is_none_or(|found| found.into == NONE);
    match loops.iter().copied().find(|&id| loose(id) && Some(id) != last) {
        Some(id) => Err(id),
        None => Ok(()),
    }
}

/// For each loop the loops it was pulled through, wraps left out.
struct Sources {
    /// Loops sorted by what was pulled through them.
    into: Vec<(LoopId, LoopId)>,
}

impl Sources {
    fn new(needles: &Needles, stitches: &[LoopId], first: &VecDeque<LoopId>) -> Self {
        let from = first.front().copied().unwrap_or(0);
        let mut into: Vec<(LoopId, LoopId)> = stitches
            .iter()
            .filter(|&&id| id >= from)
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

/// A second, plainer walk over the program that only keeps which loops hang where.
struct Replay<'a> {
    code: &'a Code,
    needles: &'a Needles,
    at: usize,
    held: BTreeMap<Needle, Vec<LoopId>>,
    next: LoopId,
}

impl Replay<'_> {
    /// True when, after instruction `op`, the open loops hang around the beds in this order, from some point on.
    fn hangs_as(&mut self, open: &VecDeque<LoopId>, op: u32) -> bool {
        self.advance(op as usize);
        let mut circle: Vec<LoopId> = Vec::with_capacity(open.len());
        let top = |(_, stack): (&Needle, &Vec<LoopId>)| {
            let stitch = |id: &&LoopId| self.needles.get(**id).is_some_and(|found| found.made != Made::Wrap);
            stack.iter().rfind(stitch).copied()
        };
        circle.extend(self.held.iter().filter(|(needle, _)| needle.bed == Bed::Front).rev().filter_map(top));
        circle.extend(self.held.iter().filter(|(needle, _)| needle.bed == Bed::Back).filter_map(top));
        let Some(start) = open.front().and_then(|first| circle.iter().position(|id| id == first)) else {
            return open.is_empty() && circle.is_empty();
        };
        circle.rotate_left(start);
        circle.iter().eq(open.iter())
    }

    fn advance(&mut self, op: usize) {
        while self.at <= op
            && let Some(instruction) = self.code.ops().get(self.at)
        {
            match *instruction {
                Instruction::Knit(_, needle, carriers) => {
                    self.held.remove(&needle);
                    self.form(needle, carriers.len());
                }
                Instruction::Tuck(_, needle, carriers) => self.form(needle, carriers.len()),
                Instruction::Split(_, from, to, carriers) => {
                    self.transfer(from, to);
                    self.form(from, carriers.len());
                }
                Instruction::Xfer(from, to) => self.transfer(from, to),
                Instruction::Drop(needle) => {
                    self.held.remove(&needle);
                }
                Instruction::In(_)
                | Instruction::InHook(_)
                | Instruction::ReleaseHook(_)
                | Instruction::Out(_)
                | Instruction::OutHook(_)
                | Instruction::Stitch(..)
                | Instruction::Rack(_)
                | Instruction::Amiss(_)
                | Instruction::Miss(..)
                | Instruction::Pause(_)
                | Instruction::Extension(_) => {}
            }
            self.at += 1;
        }
    }

    fn form(&mut self, needle: Needle, loops: usize) {
        if loops > 0 {
            let next = self.next;
            self.held.entry(needle).or_default().extend(next..next + loops as LoopId);
            self.next += loops as LoopId;
        }
    }

    fn transfer(&mut self, from: Needle, to: Needle) {
        if let Some(moved) = self.held.remove(&from) {
            self.held.entry(to).or_default().extend(moved);
        }
    }
}
