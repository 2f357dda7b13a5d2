//! The end of a tube: a chain over the last loops, which secures each of them.

use super::emit::Emitter;
use super::tube::{ItemId, Stuck, Tube};

/// Loops of the tail after the last chain loop.
pub(super) const TAIL: usize = 4;
/// A drawn-shut end of at most this many loops is bound off flat; a wider one would need too long a float to its start.
const FLAT: usize = 12;

/// Binds all loops off; returns the needle with the last chain loop.
pub(super) fn bind_off(tube: &mut Tube, closed: bool, emitter: &mut Emitter) -> Result<ItemId, Stuck> {
    if closed && tube.open.len() <= FLAT { flat(tube, emitter) } else { round(tube, emitter) }
}

/// The chain runs along the round, and the tube stays open.
fn round(tube: &mut Tube, emitter: &mut Emitter) -> Result<ItemId, Stuck> {
    let order: Vec<ItemId> = tube.open.drain(..).collect();
    let (&first, rest) = order.split_first().ok_or(Stuck::Underflow)?;
    tube.work(first, true, emitter);
    let mut last = first;
    for &next in rest {
        tube.chain(last, next, emitter)?;
        tube.work(next, true, emitter);
        last = next;
    }
    Ok(last)
}

/// Front and back loops are taken together, which closes the tube, and the chain runs over the front bed.
fn flat(tube: &mut Tube, emitter: &mut Emitter) -> Result<ItemId, Stuck> {
    let slots = tube.slots();
    let newest = tube.open.back().copied();
    let mut pairs: Vec<(ItemId, ItemId)> = Vec::new();
    let mut alone = Vec::new();
    let mut fronts = Vec::new();
    for &(front, back) in &slots {
        match (front, back) {
            (Some(front), Some(back)) => pairs.push((back, front)),
            (None, Some(back)) => alone.push(back),
            (_, None) => {}
        }
        fronts.extend(front);
    }
    if fronts.is_empty() {
        return Err(Stuck::Narrow);
    }
    // The yarn goes on at the end that is nearer to it.
    let yarn_at = newest.map_or(0, |id| tube.needle(id).index);
    let (left, right) = (fronts.first().copied(), fronts.last().copied());
    let distance =
        |end: Option<ItemId>, tube: &Tube| end.map_or(i32::MAX, |id| (tube.needle(id).index - yarn_at).abs());
    let to_left = distance(right, tube) <= distance(left, tube);
    for (back, front) in pairs {
        tube.gather(back, front, emitter)?;
    }
    for back in alone {
        let onto =
            if tube.needle(back).index > right.map_or(0, |id| tube.needle(id).index) { right } else { left };
        tube.gather(back, onto.ok_or(Stuck::Narrow)?, emitter)?;
    }
    if to_left {
        fronts.reverse();
    }
    tube.open.clear();
    let (&first, rest) = fronts.split_first().ok_or(Stuck::Underflow)?;
    tube.work(first, to_left, emitter);
    let mut last = first;
    for &next in rest {
        tube.chain(last, next, emitter)?;
        tube.work(next, to_left, emitter);
        last = next;
    }
    Ok(last)
}
