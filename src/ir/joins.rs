//! Which loops of a part begin on which loops of another one, node by node.

use super::{Direction, Graph, NodeId, Op, Part, PartId, Program, Segment, Start, Step};
use std::collections::{BTreeMap, VecDeque};

/// A loop of the first row of a part, and the loop of another part that it was picked up from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pair {
    /// Node of the part that begins.
    pub node: NodeId,
    /// The part that it grows from.
    pub to: PartId,
    /// Node there.
    pub base: NodeId,
}

/// The loops that a part leaves for others.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Leaves {
    /// Loops that each round makes, in the order of the round; the first is round [`Leaves::first`].
    pub rounds: Vec<Vec<NodeId>>,
    /// Number of the first round in `rounds`: that before the first row.
    pub first: u32,
    /// Loops held for each part, in the order of the holds.
    pub held: BTreeMap<PartId, Vec<NodeId>>,
    /// Loops that are open at the end, the next to be worked first.
    pub open: Vec<NodeId>,
}

impl Leaves {
    /// Follows the loops of a part through its graph.
    pub fn of(part: &Part, graph: &Graph) -> Self {
        let mut leaves = Self { first: part.first_number().saturating_sub(1), ..Self::default() };
        let mut ahead: VecDeque<NodeId> = (0..graph.start).collect();
        let mut behind: VecDeque<NodeId> = VecDeque::new();
        leaves.rounds.push(ahead.iter().copied().collect());
        let mut next = graph.start;
        for row in &part.rows {
            for _ in 0..row.times {
                let mut direction = Direction::Forward;
                for step in row.body.steps() {
                    match step {
                        Step::Work(stitch) => {
                            for _ in 0..stitch.works {
                                match direction {
                                    Direction::Forward => ahead.pop_front(),
                                    Direction::Back => behind.pop_back(),
                                };
                            }
                            for _ in 0..stitch.makes {
                                match direction {
                                    Direction::Forward => behind.push_back(next),
                                    Direction::Back => ahead.push_front(next),
                                }
                                next = next.saturating_add(1);
                            }
                        }
                        Step::Turn(new) => direction = new,
                        Step::Hold { loops, by } => {
                            let loops = (loops as usize).min(ahead.len());
                            leaves.held.entry(by).or_default().extend(ahead.drain(..loops));
                        }
                        Step::Leave { .. } | Step::Color(_) => {}
                    }
                }
                leaves.rounds.push(behind.iter().copied().collect());
                if part.flat {
                    std::mem::swap(&mut ahead, &mut behind);
                    ahead.make_contiguous().reverse();
                    behind.make_contiguous().reverse();
                } else {
                    ahead.append(&mut behind);
                }
            }
        }
        ahead.append(&mut behind);
        leaves.open = ahead.into_iter().collect();
        leaves
    }

    /// The loops of a round.
    pub fn round(&self, number: u32) -> &[NodeId] {
        let index = number.checked_sub(self.first).map(|index| index as usize);
        index.and_then(|index| self.rounds.get(index)).map_or(&[], Vec::as_slice)
    }
}

/// The pairs of each part that begins on others, in the order of its loops; chains have none. Empty without graphs.
pub fn pairs(program: &Program) -> BTreeMap<PartId, Vec<Pair>> {
    let mut leaves: BTreeMap<PartId, Leaves> = BTreeMap::new();
    let mut taken: BTreeMap<(PartId, PartId), usize> = BTreeMap::new();
    let mut all = BTreeMap::new();
    for (index, part) in program.pattern.parts.iter().enumerate() {
        let Start::Join { segments } = &part.start else { continue };
        let own = PartId(index as u32);
        let mut list = Vec::new();
        let mut node = 0;
        for segment in segments {
            let first = node;
            node += segment.loops();
            let Some(to) = segment.part() else { continue };
            let (Some(source), Some(graph)) =
                (program.pattern.parts.get(to.0 as usize), program.graphs.get(to.0 as usize))
            else {
                continue;
            };
            let leaves = leaves.entry(to).or_insert_with(|| Leaves::of(source, graph));
            let none = Vec::new();
            let bases: Vec<NodeId> = match *segment {
                Segment::Open { .. } => leaves.open.clone(),
                Segment::Held { loops, .. } => {
                    let taken = taken.entry((to, own)).or_default();
                    let held = leaves.held.get(&own).unwrap_or(&none).iter().skip(*taken);
                    *taken += loops as usize;
                    held.take(loops as usize).copied().collect()
                }
                Segment::Surface { round, first, loops, back, .. } => {
                    let round = leaves.round(round).iter().skip(first.saturating_sub(1) as usize);
                    let mut bases: Vec<NodeId> = round.take(loops as usize).copied().collect();
                    if back {
                        bases.reverse();
                    }
                    bases
                }
                Segment::Chain { .. } => none,
            };
            list.extend((first..node).zip(bases).map(|(node, base)| Pair { node, to, base }));
        }
        all.insert(own, list);
    }
    all
}

/// True where a part sets loops aside for another one.
pub fn holds(part: &Part) -> bool {
    fn any(ops: &[Op]) -> bool {
        ops.iter().any(|op| match op {
            Op::Hold { .. } => true,
            Op::Repeat { body, .. } => any(body.ops()),
            Op::Work { .. } | Op::Turn(_) | Op::Leave { .. } | Op::Color(_) => false,
        })
    }
    part.rows.iter().any(|row| any(row.body.ops()))
}
