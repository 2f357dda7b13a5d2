//! Repeated sequences folded the way designers write them: `(2 sc, inc) x 6`, `3 sc, (5 sc, inc) x 4, 2 sc`.
//!
//! Among all ways to fold a stretch into repeats that do not overlap or nest, the one with the fewest words is taken: a word is a
//! clause between commas, and a repeat costs one more for its number. Runs may be cut, so that staggered rounds read
//! `(2 sc, inc, 2 sc) x 6`. Where two ways are equally short, the one whose repeat ends with the shaping wins.

use super::{Pass, each_row, unfoldable};
use crate::diag::Span;
use crate::ir::{Block, Op, Stitch};

pub(super) const PASS: Pass = Pass {
    name: "repeats",
    about: "repeated sequences in brackets, fewest words first: 2 sc, inc, 2 sc, inc becomes (2 sc, inc) x 2",
    run: |program, _| {
        let mut folder = Folder::default();
        for row in each_row(program) {
            if !matches!(row.body.ops(), [Op::Work { .. }]) && unfoldable(&row.body) {
                row.body = folder.fold(&row.body);
            }
        }
    },
};

/// Most runs in the body of a repeat; a longer one is not found again by eye.
const MAX_PERIOD: usize = 12;

/// What a stretch is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Atom {
    Stitch(Stitch),
    Color(u16),
}

/// A run of equal atoms.
#[derive(Clone, Copy, Debug)]
struct Run {
    atom: Atom,
    times: u32,
    span: Span,
}

impl Run {
    fn same(&self, other: &Self) -> bool {
        self.atom == other.atom && self.times == other.times
    }
}

/// A possible repeat: steps `from..to`, in bodies of `period` steps.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    from: u32,
    to: u32,
    period: u32,
    cost: u32,
}

/// The cheapest way to write all steps before a place, with a plain clause or with a repeat as its end.
#[derive(Clone, Copy, Debug)]
struct Best {
    plain: u32,
    /// The clause before the plain one is a repeat.
    after_repeat: bool,
    repeat: u32,
    candidate: u32,
}

const NEVER: u32 = u32::MAX / 2;
/// Words weigh more than looks.
const WORD: u32 = 8;

/// Working memory for one row after the other.
#[derive(Default)]
struct Folder {
    runs: Vec<Run>,
    /// Where each run begins, in steps; one more for the end.
    starts: Vec<u32>,
    candidates: Vec<Candidate>,
    places: Vec<u32>,
    best: Vec<Best>,
}

impl Folder {
    fn fold(&mut self, block: &Block) -> Block {
        let mut out = Block::default();
        self.runs.clear();
        self.gather(block, &mut out);
        self.close(&mut out);
        out
    }

    /// Collects runs; what is neither stitch nor color ends a stretch.
    fn gather(&mut self, block: &Block, out: &mut Block) {
        for (op, span) in block.spanned() {
            match op {
                Op::Work { stitch, times } => self.run(Atom::Stitch(*stitch), *times, span),
                Op::Color(color) => self.run(Atom::Color(*color), 1, span),
                Op::Repeat { body, times } => (0..*times).for_each(|_| self.gather(body, out)),
                Op::Turn(_) | Op::Hold { .. } | Op::Leave { .. } => {
                    self.close(out);
                    out.push(op.clone(), span);
                }
            }
        }
    }

    fn run(&mut self, atom: Atom, times: u32, span: Span) {
        match self.runs.last_mut() {
            Some(last) if last.atom == atom => {
                last.times += times;
                last.span = last.span.to(span);
            }
            _ if times > 0 => self.runs.push(Run { atom, times, span }),
            _ => {}
        }
    }

    /// Folds the stretch that has been collected.
    fn close(&mut self, out: &mut Block) {
        self.starts.clear();
        self.starts.push(0);
        let mut end = 0;
        for run in &self.runs {
            end += run.times;
            self.starts.push(end);
        }
        self.find();
        if self.candidates.is_empty() {
            self.write(0, end, out);
        } else {
            self.choose(out);
        }
        self.runs.clear();
    }

    /// All stretches of at least two equal bodies, each in the few phases that can read well.
    fn find(&mut self) {
        self.candidates.clear();
        let count = self.runs.len();
        for period in 2..=MAX_PERIOD.min(count.saturating_sub(1)) {
            let mut first = 0;
            while first + period < count {
                let mut end = first;
                while end + period < count && self.runs[end].same(&self.runs[end + period]) {
                    end += 1;
                }
                if end > first {
                    self.stretch(first, end, period);
                }
                first = end + 1;
            }
        }
    }

    /// Runs `first..end` are equal to those `period` runs later. The runs before and behind may belong to it in part.
    fn stretch(&mut self, first: usize, end: usize, period: usize) {
        let shared = |a: usize, b: usize| match (self.runs.get(a), self.runs.get(b)) {
            (Some(a), Some(b)) if a.atom == b.atom => a.times.min(b.times),
            _ => 0,
        };
        let before = shared(first.wrapping_sub(1), first.wrapping_sub(1).wrapping_add(period));
        let behind = shared(end, end + period);
        let from = self.starts[first] - before;
        let to = self.starts[end + period] + behind;
        let steps = self.starts[first + period] - self.starts[first];
        let times = (to - from) / steps;
        if times < 2 {
            return;
        }
        let slack = (to - from) % steps;
        let boundaries = self.starts[first..].iter().map(|start| start - from);
        let last = (self.starts[end + period] - from).checked_sub(times * steps);
        let phases = boundaries.take_while(|phase| *phase < slack).chain([0, slack]).chain(last);
        let mut phases: [Option<u32>; MAX_PERIOD + 4] = {
            let mut some = [None; MAX_PERIOD + 4];
            some.iter_mut()
                .zip(phases.filter(|phase| *phase <= slack))
                .for_each(|(slot, phase)| *slot = Some(phase));
            some
        };
        phases.sort_unstable();
        let mut previous = None;
        for phase in phases.into_iter().flatten() {
            if previous.replace(phase) != Some(phase) {
                let from = from + phase;
                let cost = self.cost(from, steps);
                self.candidates.push(Candidate { from, to: from + times * steps, period: steps, cost });
            }
        }
    }

    /// Words and looks of a repeat whose body is these steps.
    fn cost(&self, from: u32, period: u32) -> u32 {
        let run = |step: u32| self.starts.partition_point(|start| *start <= step) - 1;
        let (first, last) = (run(from), run(from + period - 1));
        let shapes = |index: usize| match self.runs[index].atom {
            Atom::Stitch(stitch) => stitch.is_increase() || stitch.is_decrease(),
            Atom::Color(_) => false,
        };
        let looks = match (shapes(first), shapes(last)) {
            (false, true) => 1,
            (false, false) | (true, true) => 2,
            (true, false) => 3,
        };
        (last - first + 2) as u32 * WORD + looks
    }

    /// The cheapest sequence of plain clauses and repeats: places from left to right, each from the places before.
    fn choose(&mut self, out: &mut Block) {
        self.candidates.sort_unstable_by_key(|candidate| (candidate.to, candidate.from, candidate.period));
        self.places.clear();
        self.places.extend(&self.starts);
        self.places.extend(self.candidates.iter().flat_map(|candidate| [candidate.from, candidate.to]));
        self.places.sort_unstable();
        self.places.dedup();
        self.best.clear();
        self.best.push(Best { plain: NEVER, after_repeat: false, repeat: 0, candidate: u32::MAX });
        let mut boundary = self.starts.iter().peekable();
        let mut next = 0;
        for index in 1..self.places.len() {
            let place = self.places[index];
            let left = self.places[index - 1];
            while boundary.peek().is_some_and(|start| **start < left) {
                boundary.next();
            }
            let begins = boundary.peek() == Some(&&left);
            let before = self.best[index - 1];
            let go_on = before.plain + if begins { WORD } else { 0 };
            let anew = before.repeat + WORD;
            let mut best = Best {
                plain: go_on.min(anew),
                after_repeat: anew < go_on,
                repeat: NEVER,
                candidate: u32::MAX,
            };
            while let Some(candidate) = self.candidates.get(next).filter(|candidate| candidate.to == place) {
                let from = self.best[self.places.partition_point(|place| *place < candidate.from)];
                let cost = from.plain.min(from.repeat) + candidate.cost;
                if cost < best.repeat {
                    (best.repeat, best.candidate) = (cost, next as u32);
                }
                next += 1;
            }
            self.best.push(best);
        }
        self.trace(out);
    }

    /// Follows the choices back and writes them down.
    fn trace(&self, out: &mut Block) {
        let mut pieces = Vec::new();
        let mut index = self.places.len() - 1;
        let mut repeat = self.best[index].repeat < self.best[index].plain;
        let mut plain_end = self.places[index];
        while index > 0 {
            let best = self.best[index];
            if repeat {
                let candidate = self.candidates[best.candidate as usize];
                pieces.push((candidate.from, candidate.to, Some(candidate.period)));
                index = self.places.partition_point(|place| *place < candidate.from);
                plain_end = self.places[index];
                repeat = self.best[index].repeat < self.best[index].plain;
            } else {
                index -= 1;
                repeat = best.after_repeat;
                if repeat || index == 0 {
                    pieces.push((self.places[index], plain_end, None));
                    // The first place counts as a repeat that costs nothing.
                    repeat = index > 0;
                }
            }
        }
        for (from, to, period) in pieces.into_iter().rev() {
            if let Some(period) = period {
                let mut body = Block::default();
                let span = self.write(from, from + period, &mut body);
                out.push(Op::repeat(body, (to - from) / period), span);
            } else {
                self.write(from, to, out);
            }
        }
    }

    /// Writes the steps `from..to` as plain clauses; gives their span.
    fn write(&self, from: u32, to: u32, out: &mut Block) -> Span {
        let mut all = Span::NONE;
        let first = self.starts.partition_point(|start| *start <= from).saturating_sub(1);
        for (run, start) in self.runs.iter().zip(&self.starts).skip(first) {
            if *start >= to {
                break;
            }
            let times = (start + run.times).min(to) - (*start).max(from);
            all = all.to(run.span);
            match run.atom {
                Atom::Stitch(stitch) => out.push(Op::Work { stitch, times }, run.span),
                Atom::Color(color) => (0..times).for_each(|_| out.push(Op::Color(color), run.span)),
            }
        }
        all
    }
}
