//! What operations do to the loops, composed without unfolding them.

use crate::ir::{Block, Direction, Op};

/// Largest number of loops that is followed; beyond it everything is too large.
const CAP: i64 = 1 << 40;

/// The change of the loops ahead of the hook and behind it, and how many must be there at the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Effect {
    pub need_ahead: i64,
    pub need_behind: i64,
    pub ahead: i64,
    pub behind: i64,
    /// Loops left or held rather than worked.
    pub left: i64,
    pub held: i64,
}

/// Why an effect cannot be computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fault {
    /// Numbers beyond all use.
    TooLarge,
    /// A mark in the direction that already holds.
    Mark(usize),
    /// A repeat that ends in another direction than it began.
    Unbalanced(usize),
}

impl Effect {
    /// This, then the other.
    pub(crate) fn then(self, next: Self) -> Option<Self> {
        let sum = Self {
            need_ahead: self.need_ahead.max(next.need_ahead.checked_sub(self.ahead)?),
            need_behind: self.need_behind.max(next.need_behind.checked_sub(self.behind)?),
            ahead: self.ahead.checked_add(next.ahead)?,
            behind: self.behind.checked_add(next.behind)?,
            left: self.left.checked_add(next.left)?,
            held: self.held.checked_add(next.held)?,
        };
        sum.small().then_some(sum)
    }

    fn small(self) -> bool {
        [self.need_ahead, self.need_behind, self.ahead, self.behind].iter().all(|value| value.abs() < CAP)
    }

    /// This, `times` times.
    pub(crate) fn times(self, times: i64) -> Option<Self> {
        if times <= 0 {
            return Some(Self::default());
        }
        let need = |need: i64, change: i64| {
            let last = if change < 0 { change.checked_neg()?.checked_mul(times - 1)? } else { 0 };
            Some(if need == 0 && change >= 0 { 0 } else { need.checked_add(last)? })
        };
        let product = Self {
            need_ahead: need(self.need_ahead, self.ahead)?,
            need_behind: need(self.need_behind, self.behind)?,
            ahead: self.ahead.checked_mul(times)?,
            behind: self.behind.checked_mul(times)?,
            left: self.left.checked_mul(times)?,
            held: self.held.checked_mul(times)?,
        };
        product.small().then_some(product)
    }

    /// Loops of the row below that are used up, beyond those that the row itself makes ahead.
    pub(crate) fn works(self) -> i64 {
        -self.ahead
    }
}

/// The effect of a block that begins in `direction`, with `bridge` loops taken by each turn.
pub(crate) fn of(block: &Block, direction: &mut Direction, bridge: bool) -> Result<Effect, Fault> {
    let mut sum = Effect::default();
    if block.is_empty() {
        return Ok(sum);
    }
    for (index, op) in block.ops().iter().enumerate() {
        let next = match op {
            Op::Work { stitch, times } if *direction == Direction::Forward => {
                // What nearly all operations are, without the general case.
                let works = i64::from(stitch.works) * i64::from(*times);
                let makes = i64::from(stitch.makes) * i64::from(*times);
                sum.need_ahead = sum.need_ahead.max(works - sum.ahead);
                sum.need_behind = sum.need_behind.max(-sum.behind);
                sum.ahead -= works;
                sum.behind += makes;
                if !sum.small() {
                    return Err(Fault::TooLarge);
                }
                continue;
            }
            Op::Work { stitch, times } => {
                let (works, makes) = (i64::from(stitch.works), i64::from(stitch.makes));
                let one = Effect { need_behind: works, behind: -works, ahead: makes, ..Effect::default() };
                one.times(i64::from(*times))
            }
            Op::Repeat { body, times } => {
                let before = *direction;
                let one = of(body, direction, bridge)?;
                if *direction != before {
                    return Err(Fault::Unbalanced(index));
                }
                one.times(i64::from(*times))
            }
            Op::Turn(to) => {
                if to == direction {
                    return Err(Fault::Mark(index));
                }
                *direction = *to;
                Some(match (bridge, to) {
                    (true, Direction::Back) => Effect { need_ahead: 1, ..Effect::default() },
                    (true, Direction::Forward) => Effect { need_behind: 1, ..Effect::default() },
                    (false, _) => Effect::default(),
                })
            }
            Op::Hold { loops, .. } => {
                let loops = i64::from(*loops);
                Some(Effect { need_ahead: loops, ahead: -loops, held: loops, ..Effect::default() })
            }
            Op::Leave { loops } => {
                let loops = i64::from(*loops);
                Some(Effect { need_ahead: loops, ahead: -loops, left: loops, ..Effect::default() })
            }
            Op::Color(_) => Some(Effect::default()),
        };
        sum = next.and_then(|next| sum.then(next)).ok_or(Fault::TooLarge)?;
    }
    Ok(sum)
}

/// True when a block turns anywhere.
pub(crate) fn has_turn(block: &Block) -> bool {
    block.ops().iter().any(|op| match op {
        Op::Turn(_) => true,
        Op::Repeat { body, .. } => has_turn(body),
        Op::Work { .. } | Op::Hold { .. } | Op::Leave { .. } | Op::Color(_) => false,
    })
}
