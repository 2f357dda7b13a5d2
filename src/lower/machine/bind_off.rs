//! The end of a tube: a chain over the last loops, which secures each of them.

use super::emit::Emitter;
use super::tube::{ItemId, Stuck, Tube};
use crate::ir::machine::Bed;

/// Loops of the tail after the last chain loop.
pub(super) const TAIL: usize = 4;
/// A drawn-shut end of at most this many loops is bound off flat; a wider one would need too long a float to its start.
pub(super) const FLAT: usize = 12;

/// Whether a chain can secure the last loops.
pub(super) fn can_bind_off(tube: &Tube, closed: bool) -> bool {
    tube.movable().is_ok() || is_flat(tube, closed)
}

fn is_flat(tube: &Tube, closed: bool) -> bool {
    closed && tube.heading.is_none() && tube.ahead.len() <= FLAT
}

/// Binds all loops off; returns the needle with the last chain loop.
pub(super) fn bind_off(tube: &mut Tube, closed: bool, emitter: &mut Emitter) -> Result<ItemId, Stuck> {
    if is_flat(tube, closed) { flat(tube, emitter) } else { round(tube, emitter) }
}

/// The chain runs along the round, and the tube stays open.
fn round(tube: &mut Tube, emitter: &mut Emitter) -> Result<ItemId, Stuck> {
    let order: Vec<ItemId> = tube.ahead.drain(..).collect();
    let (&first, rest) = order.split_first().ok_or(Stuck::Underflow)?;
    tube.work(first, true, emitter);
    let mut last = first;
    for &next in rest {
        tube.chain(last, next, false, emitter)?;
        tube.work(next, true, emitter);
        last = next;
    }
    Ok(last)
}

/// Front and back loops are taken together, which closes the tube, and the chain runs over the front bed.
fn flat(tube: &mut Tube, emitter: &mut Emitter) -> Result<ItemId, Stuck> {
    let newest = tube.ahead.back().copied();
    // Where both beds have a loop, the front needle takes them; a back loop without partner is chained as it is.
    let mut line: Vec<ItemId> = Vec::new();
    let mut pairs: Vec<(ItemId, ItemId)> = Vec::new();
    for (front, back) in tube.slots() {
        if let (Some(front), Some(back)) = (front, back) {
            pairs.push((back, front));
        }
        line.extend(front.or(back));
    }
    // The yarn goes on at the end that is nearer to it.
    let yarn_at = newest.map_or(0, |id| tube.needle(id).index);
    let distance = |end: Option<&ItemId>| end.map_or(i32::MAX, |&id| (tube.needle(id).index - yarn_at).abs());
    let to_left = distance(line.last()) <= distance(line.first());
    for (back, front) in pairs {
        tube.gather(back, front, emitter)?;
    }
    if to_left {
        line.reverse();
    }
    tube.ahead.clear();
    // The course runs to the left on the front bed and to the right on the back bed.
    let forward = |tube: &Tube, id: ItemId| (tube.bed(id) == Bed::Front) == to_left;
    let (&first, rest) = line.split_first().ok_or(Stuck::Underflow)?;
    tube.work(first, forward(tube, first), emitter);
    let mut last = first;
    for &next in rest {
        tube.chain(last, next, true, emitter)?;
        tube.work(next, forward(tube, next), emitter);
        last = next;
    }
    Ok(last)
}
