//! Short words as two numbers, and the table that finds what they mean.

use super::words::Known;

/// A folded word of up to 16 bytes, none of them 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Packed {
    low: u64,
    high: u64,
}

const ONES: u64 = 0x0101_0101_0101_0101;

impl Packed {
    /// The word, unless it is too long.
    pub(crate) fn of(word: &[u8]) -> Option<Self> {
        let mut packed = Self::default();
        word.iter().enumerate().all(|(at, byte)| packed.put(at, *byte)).then_some(packed)
    }

    /// Puts the byte at its place; false beyond the last.
    fn put(&mut self, at: usize, byte: u8) -> bool {
        match at {
            0..8 => self.low |= u64::from(byte) << (8 * at),
            8..16 => self.high |= u64::from(byte) << (8 * (at - 8)),
            _ => return false,
        }
        true
    }

    /// The letters from A to Z that `text` begins with, folded, and their number; `None` when they are too many.
    #[inline]
    pub(crate) fn letters(text: &[u8]) -> Option<(Self, usize)> {
        if let Some(chunk) = text.first_chunk() {
            // Eight bytes at a time: the high bit of each tells that it is a letter.
            let bytes = u64::from_le_bytes(*chunk);
            let small = bytes | (0x20 * ONES);
            let from_a = (small & (0x7f * ONES)) + 0x1f * ONES;
            let beyond_z = (small & (0x7f * ONES)) + 0x05 * ONES;
            let others = !(from_a & !beyond_z & !bytes) & (0x80 * ONES);
            if others != 0 {
                let length = others.trailing_zeros() / 8;
                return Some((Self { low: small & ((1 << (8 * length)) - 1), high: 0 }, length as usize));
            }
        }
        Self::one_by_one(text)
    }

    #[cold]
    #[inline(never)]
    fn one_by_one(text: &[u8]) -> Option<(Self, usize)> {
        let mut packed = Self::default();
        for (at, byte) in text.iter().enumerate() {
            if !byte.is_ascii_alphabetic() {
                return Some((packed, at));
            }
            if !packed.put(at, byte | 0x20) {
                return None;
            }
        }
        Some((packed, text.len()))
    }

    /// The bytes again, and their number.
    pub(crate) fn bytes(self) -> ([u8; 16], usize) {
        let whole = u128::from(self.low) | u128::from(self.high) << 64;
        (whole.to_le_bytes(), self.len() as usize)
    }

    /// Number of bytes.
    fn len(self) -> u32 {
        16 - if self.high == 0 { 8 + self.low.leading_zeros() / 8 } else { self.high.leading_zeros() / 8 }
    }

    /// The word without its last letter, when that is an `s` behind at least two others.
    pub(crate) fn singular(self) -> Option<Self> {
        let last = self.len().checked_sub(1).filter(|last| *last >= 2)?;
        let (low, high) = (self.low, self.high);
        let (half, at) = if last < 8 { (low, last) } else { (high, last - 8) };
        if (half >> (8 * at)) as u8 != b's' {
            return None;
        }
        let rest = half & ((1 << (8 * at)) - 1);
        Some(if last < 8 { Self { low: rest, high } } else { Self { low, high: rest } })
    }
}

/// Words in one open-addressed table.
pub(crate) struct Table {
    slots: Vec<(Packed, Known)>,
}

/// Several times the number of words.
const SLOTS: usize = 2048;

fn slot(word: &Packed) -> usize {
    let folded = word.low ^ word.high.rotate_left(29);
    (folded.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 53) as usize
}

impl Table {
    pub(crate) fn new() -> Self {
        Self { slots: vec![(Packed::default(), Known::WORD); SLOTS] }
    }

    #[inline]
    pub(crate) fn get(&self, word: &Packed) -> Option<Known> {
        let mut at = slot(word);
        for _ in 0..SLOTS {
            match self.slots.get(at)? {
                (Packed { low: 0, .. }, _) => return None,
                (found, known) if found == word => return Some(*known),
                _ => at = (at + 1) % SLOTS,
            }
        }
        None
    }

    pub(crate) fn set(&mut self, word: &Packed, known: Known) {
        let mut at = slot(word);
        for _ in 0..SLOTS {
            match self.slots.get_mut(at) {
                Some(found) if found.0 == *word || found.0.low == 0 => {
                    *found = (*word, known);
                    return;
                }
                _ => at = (at + 1) % SLOTS,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Packed;

    #[test]
    fn letters_are_taken_eight_at_a_time_as_one_by_one() {
        for text in [
            "sc",
            "SC in",
            "stitches",
            "stitches,",
            "Increase2",
            "a",
            "",
            "@[`{",
            "schön stand",
            "decr\u{e9}mente",
        ] {
            assert_eq!(Packed::letters(text.as_bytes()), Packed::one_by_one(text.as_bytes()), "{text}");
        }
        assert_eq!(Packed::letters(b"abcdefghijklmnopq"), None);
        let (word, length) = Packed::letters(b"increases in").unwrap_or_default();
        assert_eq!((word.singular(), length), (Packed::of(b"increase"), 9));
        assert_eq!(Packed::of(b"ss").and_then(Packed::singular), None);
        assert_eq!(Packed::of(b"bobbles").and_then(Packed::singular), Packed::of(b"bobble"));
    }
}
