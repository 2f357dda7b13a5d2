//! Small facts about clauses and blocks: what works loops, and several stitches put into one place.

use super::lex::At;
use super::lower::Trouble;
use super::syntax::{Clause, Count, CountUnit, Node, Num, Sep, Shape};
use crate::diag::Code;
use crate::ir::{Block, Entry, Kind, Op, Stitch};

/// A slip stitch that joins a round: it neither works nor makes a loop.
pub(crate) const JOIN: Stitch = Stitch { kind: Kind::SlSt, works: 0, makes: 0, entry: Entry::Both };

pub(crate) fn two_fills(at: At) -> Trouble {
    Trouble::new(Code::TwoFills, at, "an open-ended repeat beside or inside another one")
        .help("give all but one of them a number")
}

/// True for a clause that works or makes loops.
pub(crate) fn is_work(clause: &Clause) -> bool {
    match clause {
        Clause::Ring { n, .. } => n.is_some(),
        Clause::Group { .. }
        | Clause::Star { .. }
        | Clause::Op(_)
        | Clause::Again(_)
        | Clause::RepeatAll
        | Clause::Skip { .. }
        | Clause::Hold { .. }
        | Clause::Leave { .. } => true,
        Clause::Chain { .. }
        | Clause::Loop(_)
        | Clause::Color(_)
        | Clause::Turn
        | Clause::Join { .. }
        | Clause::FastenOff
        | Clause::DrawShut
        | Clause::Marker
        | Clause::OtherSide
        | Clause::DoNot
        | Clause::Mark(_)
        | Clause::Stop => false,
    }
}

/// `. 13 sc` at the end of a line.
pub(crate) fn tail_count(node: &Node) -> Option<Num> {
    match &node.what {
        Clause::Op(op)
            if node.sep == Sep::Dot
                && op.place.is_none()
                && op.word.shape == Shape::Plain
                && op.entry.is_none() =>
        {
            op.n.filter(|n| n.at.start == node.at.start)
        }
        _ => None,
    }
}

/// The block with every stitch in one place: the first works `first` loops, all others none.
pub(crate) fn gather(block: &Block, first: u16) -> Option<Block> {
    let mut out = Block::default();
    let mut first = first;
    for (op, span) in block.spanned() {
        match op {
            Op::Work { stitch, times } => {
                if stitch.kind == Kind::Skip {
                    return None;
                }
                let rest = Stitch { works: 0, ..*stitch };
                if stitch.works > 0 && first > 0 {
                    out.push(Op::Work { stitch: Stitch { works: first, ..*stitch }, times: 1 }, span);
                    first = 0;
                    if *times > 1 {
                        out.push(Op::Work { stitch: rest, times: times - 1 }, span);
                    }
                } else {
                    out.push(Op::Work { stitch: rest, times: *times }, span);
                }
            }
            Op::Repeat { body, times } => {
                let rest = gather(body, 0)?;
                if first > 0 {
                    let head = gather(body, first)?;
                    if head != rest {
                        first = 0;
                    }
                    out.append(head);
                    if *times > 1 {
                        out.push(Op::repeat(rest, times - 1), span);
                    }
                } else {
                    out.push(Op::repeat(rest, *times), span);
                }
            }
            Op::Color(color) => out.push(Op::Color(*color), span),
            Op::Turn(_) | Op::Hold { .. } | Op::Leave { .. } => return None,
        }
    }
    Some(out)
}

/// The block with every stitch in a chain space.
pub(crate) fn space(block: &Block) -> Block {
    let mut out = Block::default();
    for (op, span) in block.spanned() {
        let op = match op {
            Op::Work { stitch, times } if stitch.kind != Kind::Ch => {
                Op::Work { stitch: Stitch { entry: Entry::Space, ..*stitch }, times: *times }
            }
            Op::Repeat { body, times } => Op::repeat(space(body), *times),
            other => other.clone(),
        };
        out.push(op, span);
    }
    out
}

/// What a count of stitches counts, when it names kinds.
pub(crate) fn stated(count: &Count) -> Option<Num> {
    matches!(count.unit, CountUnit::Stitches | CountUnit::Kind(_)).then_some(count.total)
}
