//! Which row is to blame: a shortest path over the ways in which rows may be wrong.

use super::conventions::Conventions;
use super::lex::At;
use super::lower::Change;
use super::solve::{Job, Reading, Solved};
use super::syntax::{Clause, Node, Num, Place, Shape, Times};
use crate::diag::Code;

/// What would make a row fit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Cure {
    /// It fits as written.
    None,
    /// Another stated count.
    Stated { at: At, count: i64 },
    /// Another number in the row.
    Number { at: At, from: u32, to: u32 },
    /// A row is missing before it.
    Missing { works: i64 },
    /// It is the row before once more.
    Doubled,
    /// `inc` for `dec`, or the other way around.
    Flip(At),
    /// Nothing simple.
    Unknown,
}

impl Cure {
    fn cost(&self) -> u32 {
        match self {
            Self::None => 0,
            Self::Stated { .. } => 2,
            Self::Number { .. } => 3,
            Self::Missing { .. } | Self::Doubled => 4,
            Self::Flip(_) => 5,
            Self::Unknown => 10,
        }
    }
}

/// One way through a row.
#[derive(Clone, Debug)]
pub(crate) struct Way {
    pub cure: Cure,
    /// Loops handed on.
    pub leaves: i64,
}

/// Most numbers of a row that are tried.
const MAX_NUMBERS: usize = 48;

/// The ways through a row, the likeliest first.
pub(crate) fn ways(
    job: &Job<'_>,
    before: Option<&[Node]>,
    conventions: &Conventions,
    colors: &mut Vec<String>,
) -> Vec<Way> {
    let flat = job.place.flat;
    let (solved, setting) = match job.read(conventions, colors) {
        Reading::Plain(solved) => (Some(solved), None),
        Reading::Decided(solved, setting, value) => (Some(solved), Some((setting, value))),
        Reading::Trouble(_) => (None, None),
    };
    let read_with = setting.map(|(setting, value)| conventions.with(setting, value));
    let conventions = read_with.as_ref().unwrap_or(conventions);
    let mut ways = Vec::new();
    if let Some(solved) = &solved {
        match &solved.fault {
            None => {
                ways.push(Way { cure: Cure::None, leaves: solved.leaves(flat) });
                return ways;
            }
            Some(fault) => {
                let fits = solved.have.is_some_and(|have| solved.works + solved.left == have);
                if matches!(fault.code, Code::CountDiffers | Code::ChainLength) && fits {
                    let at = job.count.map_or(fault.at, |count| count.total.at);
                    ways.push(Way {
                        cure: Cure::Stated { at, count: solved.makes },
                        leaves: solved.leaves(flat),
                    });
                }
            }
        }
        let mut all = Vec::new();
        numbers(job.body, job.file.nodes, &mut all);
        for n in all.iter().take(MAX_NUMBERS) {
            if let Some((to, leaves)) = candidate(job, solved, *n, conventions, colors) {
                ways.push(Way { cure: Cure::Number { at: n.at, from: n.value, to }, leaves });
            }
        }
        if before.is_some_and(|before| same(before, job.body, job.file.nodes)) {
            if let Some(have) = job.have {
                ways.push(Way { cure: Cure::Doubled, leaves: have });
            }
        } else if solved.lowered.site.is_none()
            && solved.stated.is_none_or(|stated| i64::from(stated) == solved.makes)
        {
            let works = solved.works + solved.left;
            if works > 0 && solved.lowered.usable.is_none() {
                ways.push(Way { cure: Cure::Missing { works }, leaves: solved.leaves(flat) });
            }
        }
        let mut shapes = Vec::new();
        flips(job.body, job.file.nodes, &mut shapes);
        for at in shapes.iter().take(8) {
            if let Ok(other) = job.solve(conventions, colors, Some(Change::Flip(*at)))
                && other.fault.is_none()
            {
                ways.push(Way { cure: Cure::Flip(*at), leaves: other.leaves(flat) });
            }
        }
    }
    let stated = job.count.and_then(super::gather::stated).map(|n| i64::from(n.value));
    let made = solved.as_ref().map(|solved| solved.leaves(flat));
    if let Some(leaves) = stated.or(made).or(job.have) {
        ways.push(Way { cure: Cure::Unknown, leaves });
    }
    ways
}

/// The value of a number for which the row fits; works and makes are affine in it, so two samples tell.
fn candidate(
    job: &Job<'_>,
    solved: &Solved,
    n: Num,
    conventions: &Conventions,
    colors: &mut Vec<String>,
) -> Option<(u32, i64)> {
    let next = job.solve(conventions, colors, Some(Change::Number(n.at, n.value.checked_add(1)?))).ok()?;
    let off = |solved: &Solved| Some(solved.works + solved.left - solved.have?);
    let (here, there) = (off(solved)?, off(&next)?);
    let slope = there - here;
    let steps = if slope != 0 {
        (here % slope == 0).then(|| -here / slope)?
    } else {
        let slope = next.makes - solved.makes;
        let wanted = i64::from(solved.stated?) - solved.makes;
        (slope != 0 && wanted % slope == 0).then(|| wanted / slope)?
    };
    let to = u32::try_from(i64::from(n.value) + steps).ok().filter(|to| *to > 0 && *to != n.value)?;
    let fixed = job.solve(conventions, colors, Some(Change::Number(n.at, to))).ok()?;
    fixed.fault.is_none().then(|| (to, fixed.leaves(job.place.flat)))
}

/// All numbers of a row that say how much is worked.
fn numbers(nodes: &[Node], all: &[Node], out: &mut Vec<Num>) {
    for node in nodes {
        match &node.what {
            Clause::Ring { n, .. } | Clause::Skip { n, .. } | Clause::Chain { n, .. } => out.extend(*n),
            Clause::Group { body, times, .. } | Clause::Star { body, times, .. } => {
                numbers(body.of(all), all, out);
                match times {
                    Times::N(n) | Times::Rep(n) | Times::More(n) => out.push(*n),
                    Times::Place(place) => out.extend(in_place(*place)),
                    Times::Unsaid | Times::Fill(_) => {}
                }
            }
            Clause::Op(op) => {
                out.extend(op.n);
                out.extend(op.place.and_then(in_place));
                match op.word.shape {
                    Shape::Inc(n) | Shape::Dec(n) => out.extend(n),
                    Shape::Tog(n) => out.push(n),
                    Shape::Plain | Shape::Even | Shape::Def(_) | Shape::Letter(..) => {}
                }
            }
            Clause::Again(place) => out.extend(in_place(*place)),
            Clause::Leave { n } | Clause::Hold { n, .. } => out.push(*n),
            _ => {}
        }
    }
}

fn in_place(place: Place) -> Option<Num> {
    match place {
        Place::Next(n, _) | Place::Last(n) => n,
        Place::Each(n) | Place::Held(n) | Place::Over(n) | Place::EveryNth(n) => Some(n),
        _ => None,
    }
}

fn flips(nodes: &[Node], all: &[Node], out: &mut Vec<At>) {
    for node in nodes {
        match &node.what {
            Clause::Group { body, .. } | Clause::Star { body, .. } => flips(body.of(all), all, out),
            Clause::Op(op) if matches!(op.word.shape, Shape::Inc(_) | Shape::Dec(_)) => out.push(op.word.at),
            _ => {}
        }
    }
}

/// True when two rows say the same, places aside.
fn same(a: &[Node], b: &[Node], all: &[Node]) -> bool {
    fn show(nodes: &[Node], all: &[Node], text: &mut String) {
        for node in nodes {
            let (mut node, mut inside) = (*node, None);
            if let Clause::Group { body, .. } | Clause::Star { body, .. } = &mut node.what {
                inside = Some(std::mem::take(body));
            }
            for part in format!("{node:?}").split("at: At") {
                text.push_str(part.split_once('}').map_or(part, |(_, rest)| rest));
            }
            if let Some(body) = inside {
                show(body.of(all), all, text);
                text.push(')');
            }
        }
    }
    let shown = |nodes: &[Node]| {
        let mut text = String::new();
        show(nodes, all, &mut text);
        text
    };
    a.len() == b.len() && a.len() < 64 && shown(a) == shown(b)
}

/// The cure of the first of several rows on the cheapest path, what it hands on, and whether it is beyond doubt.
pub(crate) struct Verdict {
    pub cure: Cure,
    pub leaves: Option<i64>,
    /// One cheapest cure, the next row fits it, and no other cure is near.
    pub certain: bool,
}

/// Chooses among the ways through a faulty row by how the rows after it fit.
pub(crate) fn judge(ways: &[Way], onward: &mut dyn FnMut(i64) -> Vec<u32>) -> Verdict {
    let mut best: Vec<(u32, usize)> = Vec::new();
    for (index, way) in ways.iter().enumerate() {
        let after = onward(way.leaves);
        best.push((way.cure.cost() + after.iter().sum::<u32>(), index));
    }
    best.sort_unstable();
    let Some((cost, index)) = best.first().copied() else {
        return Verdict { cure: Cure::Unknown, leaves: None, certain: false };
    };
    let Some(way) = ways.get(index) else {
        return Verdict { cure: Cure::Unknown, leaves: None, certain: false };
    };
    let near = best.get(1).is_some_and(|(second, _)| *second <= cost + 1);
    let after = onward(way.leaves);
    let vouched = after.first() == Some(&0);
    let simple = matches!(way.cure, Cure::Stated { .. } | Cure::Number { .. });
    Verdict { cure: way.cure.clone(), leaves: Some(way.leaves), certain: simple && vouched && !near }
}

/// The cost of a row as written on so many loops.
pub(crate) fn cost(job: &Job<'_>, conventions: &Conventions, colors: &mut Vec<String>) -> (u32, i64) {
    let mut ways = ways(job, None, conventions, colors);
    ways.sort_by_key(|way| way.cure.cost());
    ways.first().map_or((10, job.have.unwrap_or(0)), |way| (way.cure.cost(), way.leaves))
}

/// A number of a row that, changed a little, makes the row hand on `wanted` loops.
pub(crate) fn number_for(
    job: &Job<'_>,
    wanted: i64,
    conventions: &Conventions,
    colors: &mut Vec<String>,
) -> Option<At> {
    let mut all = Vec::new();
    numbers(job.body, job.file.nodes, &mut all);
    for n in all.iter().take(MAX_NUMBERS) {
        for step in [1, -1, 2, -2, 3, -3_i64] {
            let Ok(to) = u32::try_from(i64::from(n.value) + step) else { continue };
            let changed = job.solve(conventions, colors, Some(Change::Number(n.at, to.max(1))));
            if changed.is_ok_and(|solved| solved.fault.is_none() && solved.leaves(job.place.flat) == wanted) {
                return Some(n.at);
            }
        }
    }
    let mut shapes = Vec::new();
    flips(job.body, job.file.nodes, &mut shapes);
    shapes.into_iter().take(8).find(|at| {
        let changed = job.solve(conventions, colors, Some(Change::Flip(*at)));
        changed.is_ok_and(|solved| solved.fault.is_none() && solved.leaves(job.place.flat) == wanted)
    })
}
