//! Parts that start from other parts: joined pieces, held loops, stitches picked up.

use super::Document;
use super::check::{Checker, State};
use super::lex::At;
use super::lines::fold_name;
use super::lower::Below;
use super::plan::{Part, What};
use super::syntax::{Clause, Node, Nodes, Num, Origin, Piece};
use crate::diag::{Code, Diagnostic};
use crate::ir::{self, Finish, PartId, Segment, Start};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry as Slot;

/// Parts that only a `hold` names; they are entered behind the others.
pub(super) fn absent_parts(
    planned: &[Part<'_>],
    document: &Document<'_>,
    names: &mut BTreeMap<String, PartId>,
) -> Vec<(String, At)> {
    fn holds(nodes: Nodes, all: &[Node], out: &mut Vec<At>) {
        for node in nodes.of(all) {
            match &node.what {
                Clause::Hold { name, .. } => out.push(*name),
                Clause::Group { body, .. } | Clause::Star { body, .. } => holds(*body, all, out),
                _ => {}
            }
        }
    }
    let mut absent = Vec::new();
    let mut all = Vec::new();
    for item in planned.iter().flat_map(|part| &part.items) {
        if let What::Row(row) = item.what {
            holds(row.body, &document.tree.nodes, &mut all);
        }
    }
    for at in all {
        let name = document.text.get(at.range()).unwrap_or_default().trim_matches('"');
        if let Slot::Vacant(slot) = names.entry(fold_name(name)) {
            slot.insert(PartId((planned.len() + absent.len()) as u32));
            absent.push((name.to_owned(), at));
        }
    }
    absent
}

impl Checker<'_> {
    /// Pieces of a join, or loops taken from another part.
    pub(super) fn origin(&mut self, head: &super::syntax::PartHead, id: PartId, state: &mut State) {
        let segments = match &head.origin {
            Origin::Own => return,
            Origin::Join { pieces } => self.join(pieces, id),
            Origin::From { name, spots } => self.from(*name, spots, id),
        };
        let loops: i64 = segments.iter().map(|(_, segment)| i64::from(segment.loops())).sum();
        state.have = if segments.is_empty() { None } else { Some(loops) };
        state.below = Below::Loops;
        state.start = Some(Start::Join { segments: segments.iter().map(|(_, segment)| *segment).collect() });
        state.segments = segments;
    }

    fn join(&mut self, pieces: &[Piece], id: PartId) -> Vec<(String, Segment)> {
        let mut segments = Vec::new();
        for piece in pieces {
            match piece {
                // `+ ch 0` says that the chain is worked on one side only.
                Piece::Chain(Num { value: 0, .. }) => {}
                Piece::Chain(n) => segments.push(("ch".to_owned(), Segment::Chain { loops: n.value })),
                Piece::Part(at) => {
                    let Some((part, name)) = self.earlier(*at, id) else { return Vec::new() };
                    let Some(loops) = self.open.get(part.0 as usize).copied().flatten() else {
                        return Vec::new();
                    };
                    if let Some(taken) = self.taken.get_mut(part.0 as usize) {
                        *taken += 1;
                    }
                    segments.push((
                        name,
                        Segment::Open { part, loops: loops.clamp(0, i64::from(u32::MAX)) as u32 },
                    ));
                }
            }
        }
        // A chain between two pieces is worked on both sides.
        if pieces.len() == segments.len()
            && let [(_, Segment::Open { .. }), chain @ (_, Segment::Chain { .. }), (_, Segment::Open { .. })] =
                segments.as_slice()
        {
            let back = chain.clone();
            segments.push(back);
        }
        segments
    }

    fn from(&mut self, name: At, spots: &[super::syntax::Spot], id: PartId) -> Vec<(String, Segment)> {
        let Some((part, name)) = self.earlier(name, id) else { return Vec::new() };
        let mut segments = Vec::new();
        if spots.is_empty() {
            // `from Body held`: all that was set aside for this part.
            let all = self.held.iter().filter(|held| held.from == part && held.by == id);
            segments.extend(all.map(|held| (name.clone(), Segment::Held { part, loops: held.loops })));
        }
        for spot in spots {
            let back = spot.last.value < spot.first.value;
            let (low, high) = (spot.first.value.min(spot.last.value), spot.first.value.max(spot.last.value));
            let loops = (high - low).saturating_add(1);
            let made = self.made.get(part.0 as usize).and_then(|rounds| {
                rounds
                    .iter()
                    .find(|(first, last, _)| (*first..=*last).contains(&spot.round.value))
                    .map(|(.., made)| *made)
            });
            let Some(made) = made else {
                let message = format!("`{name}` has no round {}", spot.round.value);
                self.say(Diagnostic::new(Code::NoSuchPart, message), spot.round.at, "");
                continue;
            };
            if low == 0 || i64::from(high) > made {
                let message = format!("round {} of `{name}` has {made} stitches", spot.round.value);
                self.say(Diagnostic::new(Code::JoinLoops, message), spot.first.at.to(spot.last.at), "");
                continue;
            }
            if spot.held {
                let fits = self.held.iter().any(|held| {
                    held.from == part
                        && held.by == id
                        && held.row == spot.round.value.saturating_add(1)
                        && held.first == i64::from(spot.first.value)
                        && held.loops == loops
                });
                if !fits {
                    let message = format!(
                        "stitches {} to {} of round {} are not held for this part",
                        spot.first.value, spot.last.value, spot.round.value
                    );
                    let found = Diagnostic::new(Code::HeldLoops, message);
                    let right = self.held.iter().find(|held| held.from == part && held.by == id).copied();
                    let found = match right {
                        Some(right) => found.help(format!(
                            "held are `rnd {} sts {}-{}`",
                            right.row.saturating_sub(1),
                            right.first,
                            right.first + i64::from(right.loops) - 1
                        )),
                        None => found.help(format!("hold them first: `hold {loops} sts for ..` in `{name}`")),
                    };
                    self.say(found, spot.first.at.to(spot.last.at), "");
                }
                segments.push((name.clone(), Segment::Held { part, loops }));
            } else {
                let round = spot.round.value;
                segments.push((name.clone(), Segment::Surface { part, round, first: low, loops, back }));
            }
        }
        segments
    }

    /// A part that was made before this one.
    fn earlier(&mut self, at: At, id: PartId) -> Option<(PartId, String)> {
        let name = self.document.text.get(at.range()).unwrap_or_default().trim_matches('"');
        let folded = fold_name(name);
        match self.file.parts.get(&folded) {
            Some(part) if *part < id => Some((*part, folded)),
            _ => {
                let message = format!("no part `{name}` before this line");
                self.say(Diagnostic::new(Code::NoSuchPart, message), at, "");
                None
            }
        }
    }

    /// Every held loop is taken once, by the part it is held for; a part is joined once.
    pub(super) fn check_held(&mut self, planned: &[Part<'_>]) {
        for held in self.held.clone() {
            let Some(part) = planned.get(held.by.0 as usize) else { continue };
            let takes = part.head.is_some_and(
                |head| matches!(&head.origin, Origin::From { spots, .. } if spots.is_empty() || spots.iter().any(|spot| spot.held)),
            );
            if !takes {
                let message =
                    format!("{} loops are held for `{}`, which does not take them", held.loops, part.name);
                let help = format!(
                    "open the part with `{}: from .. rnd {} sts {}-{} held`",
                    part.name,
                    held.row.saturating_sub(1),
                    held.first,
                    held.first + i64::from(held.loops) - 1
                );
                self.say(Diagnostic::new(Code::HeldLoops, message).help(help), held.at, "");
            }
        }
        for (part, taken) in planned.iter().zip(self.taken.clone()) {
            let copies = part.head.and_then(|head| head.copies).map_or(1, |n| n.value);
            if taken > copies {
                let message = format!("`{}` is joined {taken} times, and made {copies} times", part.name);
                let help = format!("make {taken} of it: `{} (make {taken}):`", part.name);
                self.say(Diagnostic::new(Code::JoinLoops, message).help(help), part.at, "");
            }
        }
    }

    /// Parts that only a `hold` names: they start from what is held for them and have no rows.
    pub(super) fn absent(&mut self, absent: &[(String, At)], first: usize) -> Vec<ir::Part> {
        let mut parts = Vec::new();
        for (index, (name, at)) in absent.iter().enumerate() {
            let id = PartId((first + index) as u32);
            let segments = self.held.iter().filter(|held| held.by == id);
            let segments =
                segments.map(|held| Segment::Held { part: held.from, loops: held.loops }).collect();
            let message = format!("loops are held for `{name}`, which the file does not have");
            self.say(
                Diagnostic::new(Code::HeldForNobody, message)
                    .help(format!("write the part: `{name}: from .. held`")),
                *at,
                "",
            );
            parts.push(ir::Part {
                name: name.clone(),
                start: Start::Join { segments },
                rows: Vec::new(),
                finish: Finish::Open,
                flat: false,
                copies: 1,
            });
        }
        parts
    }
}
