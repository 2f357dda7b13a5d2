//! Where the level lines of a field divide: the merge tree of its ends.

use super::Mesh;
use super::ends::Ends;
use super::soup::{NONE, find, meeting};

/// A stretch of the object between two forks, or a fork and an end: its level lines are single rings.
#[derive(Clone, Debug)]
pub(super) struct Limb {
    /// Field value where it begins: the fork, or the start.
    pub(super) low: f64,
    /// Field value where it ends: the next fork, or its end.
    pub(super) high: f64,
    /// The limbs that it divides into.
    pub(super) children: Vec<usize>,
    /// One of the ends that lie beyond it: index in [`Ends::others`].
    pub(super) leaf: usize,
    /// Whether it goes to that end itself.
    pub(super) last: bool,
}

/// The limbs of an object; the root is the one that begins at the start.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    pub(super) limbs: Vec<Limb>,
    pub(super) root: usize,
}

impl Tree {
    /// True for a limb that divides into limbs that do not.
    pub(super) fn is_last_fork(&self, limb: &Limb) -> bool {
        !limb.children.is_empty() && limb.children.iter().all(|child| self.limbs[*child].last)
    }
}

impl Tree {
    /// The limbs that divide, upward from the root.
    pub(super) fn forks(&self) -> impl Iterator<Item = usize> {
        let mut open = vec![self.root];
        std::iter::from_fn(move || {
            loop {
                let index = open.pop()?;
                let children = &self.limbs.get(index)?.children;
                open.extend(children);
                if !children.is_empty() {
                    return Some(index);
                }
            }
        })
    }
}

impl Mesh {
    /// The limbs of the object under a field: components of what lies above a level, as the level falls.
    pub(super) fn tree(&self, field: &[f64], ends: &Ends) -> Option<Tree> {
        let count = self.points.len();
        let mut order: Vec<u32> = (0..count as u32).collect();
        order.sort_unstable_by(|a, b| field[*b as usize].total_cmp(&field[*a as usize]).then(b.cmp(a)));
        let mut leader = vec![NONE; count];
        // The limb that grows down from each component.
        let mut limb = vec![NONE; count];
        let mut limbs: Vec<Limb> = Vec::new();
        let mut end_of = vec![NONE; count];
        for (i, tip) in ends.others.iter().enumerate() {
            tip.ring.iter().for_each(|v| end_of[*v as usize] = i as u32);
        }
        for &vertex in &order {
            if leader[vertex as usize] == NONE {
                leader[vertex as usize] = vertex;
            }
            let end = end_of[vertex as usize];
            if end != NONE {
                let ring = &ends.others[end as usize].ring;
                let top = find(&mut leader, vertex);
                if limb[top as usize] == NONE
                    && ring.iter().all(|v| *v == vertex || leader[*v as usize] == NONE)
                {
                    limb[top as usize] = limbs.len() as u32;
                    let high = ring.iter().map(|v| field[*v as usize]).fold(f64::MAX, f64::min);
                    limbs.push(Limb {
                        low: f64::NAN,
                        high,
                        children: Vec::new(),
                        leaf: end as usize,
                        last: true,
                    });
                    // An opening is one end as a whole.
                    for &other in ring {
                        if leader[other as usize] == NONE {
                            leader[other as usize] = top;
                        }
                    }
                }
            }
            let value = field[vertex as usize];
            for other in self.neighbors(vertex) {
                let Some((a, b)) = meeting(&mut leader, vertex, other) else { continue };
                let (one, two) = (limb[a as usize], limb[b as usize]);
                let joined = match (one, two) {
                    (NONE, kept) | (kept, NONE) => kept,
                    (one, two) => {
                        for child in [one, two] {
                            limbs[child as usize].low = value;
                        }
                        let (one, two) = (one as usize, two as usize);
                        limbs.push(Limb {
                            low: f64::NAN,
                            high: value,
                            children: vec![one, two],
                            leaf: limbs[one].leaf,
                            last: false,
                        });
                        limbs.len() as u32 - 1
                    }
                };
                leader[b as usize] = a;
                limb[a as usize] = joined;
            }
        }
        let last = find(&mut leader, *order.last()?);
        let root = limb[last as usize];
        let limb = limbs.get_mut(root as usize)?;
        limb.low = field.iter().copied().fold(f64::MAX, f64::min);
        Some(Tree { limbs, root: root as usize })
    }

    /// A way down from a vertex to the start along which the field falls.
    pub(super) fn descent(&self, from: u32, field: &[f64], start: &[u32]) -> Vec<u32> {
        let mut path = vec![from];
        let mut at = from;
        let below = |a: u32, b: u32| (field[a as usize], a) < (field[b as usize], b);
        while !start.contains(&at) && path.len() <= self.points.len() {
            // The steepest way, not the lowest neighbor: long edges are no advantage.
            let rate = |v: u32| {
                (field[at as usize] - field[v as usize]) / self.point(at).distance(self.point(v)).max(1e-300)
            };
            let next = self
                .neighbors(at)
                .filter(|v| below(*v, at))
                .max_by(|a, b| rate(*a).total_cmp(&rate(*b)).then(b.cmp(a)));
            if let Some(next) = next {
                path.push(next);
                at = next;
            } else {
                let Some(way) = self.out_of_pit(at, field) else { break };
                at = *way.last().unwrap_or(&at);
                path.extend(way);
            }
        }
        path
    }

    /// The way with fewest edges to a vertex that lies lower.
    fn out_of_pit(&self, from: u32, field: &[f64]) -> Option<Vec<u32>> {
        let mut before = std::collections::BTreeMap::from([(from, NONE)]);
        let mut queue = std::collections::VecDeque::from([from]);
        while let Some(vertex) = queue.pop_front() {
            if (field[vertex as usize], vertex) < (field[from as usize], from) {
                let mut way = vec![vertex];
                let mut at = vertex;
                while let Some(&last) = before.get(&at).filter(|last| **last != NONE && **last != from) {
                    way.push(last);
                    at = last;
                }
                way.reverse();
                return Some(way);
            }
            for next in self.neighbors(vertex) {
                before.entry(next).or_insert_with(|| {
                    queue.push_back(next);
                    vertex
                });
            }
        }
        None
    }
}
