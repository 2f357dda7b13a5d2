//! Where rounds begin among the loops of a batch: a text is easiest to read when nothing is worked across the marker.

use crate::ir::NodeId;

/// The marker, as a number of loops ahead of the hook.
#[derive(Debug)]
pub(crate) struct Marker {
    /// Loops of the round under way that are still to be worked; `None` where no one asks.
    ahead: Option<usize>,
}

impl Marker {
    /// A marker on the first of so many loops.
    pub(crate) fn new(wanted: bool, loops: usize) -> Self {
        Self { ahead: wanted.then_some(loops) }
    }

    /// The base among the next `length` of `ring` loops at which a round begins, unless it is the first.
    pub(crate) fn within(&mut self, length: usize, ring: usize) -> Option<usize> {
        let ahead = self.ahead.as_mut()?;
        if *ahead == 0 {
            *ahead = ring;
        }
        (length > *ahead).then_some(*ahead)
    }

    /// After a batch of so many bases: `first` is the first loop of the round that began in it.
    pub(crate) fn moved(&mut self, length: usize, first: Option<NodeId>, ring: &[NodeId]) {
        let Some(ahead) = &mut self.ahead else { return };
        *ahead = match first.and_then(|first| ring.iter().position(|id| *id == first)) {
            Some(before) => before,
            None => ahead.saturating_sub(length),
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_are_told_among_batches() {
        let mut marker = Marker::new(true, 10);
        // The whole ring of ten is one round.
        assert_eq!(marker.within(10, 10), None);
        marker.moved(10, None, &[]);
        // A batch of six of twelve, then one of the twelve that are there: the round ends within it.
        assert_eq!(marker.within(6, 12), None);
        marker.moved(6, None, &[]);
        assert_eq!(marker.within(12, 12), Some(6));
        marker.moved(12, Some(7), &[1, 2, 3, 7, 8]);
        assert_eq!(marker.within(5, 5), Some(3));
        assert_eq!(Marker::new(false, 10).within(20, 20), None);
    }
}
