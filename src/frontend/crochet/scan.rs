//! Bytes looked for in text, a chunk at a time: without a branch a byte, compilers take many of them at once.

/// The place of the first byte of this kind.
#[inline]
pub(crate) fn find(bytes: &[u8], wanted: impl Fn(u8) -> bool) -> Option<usize> {
    let (chunks, _) = bytes.as_chunks::<16>();
    let whole = chunks.iter().take_while(|chunk| !chunk.iter().fold(false, |any, byte| any | wanted(*byte)));
    let from = whole.count() * 16;
    Some(from + bytes.get(from..)?.iter().position(|byte| wanted(*byte))?)
}

/// Number of bytes of this value.
pub(crate) fn count(bytes: &[u8], wanted: u8) -> usize {
    let (chunks, rest) = bytes.as_chunks::<32>();
    let of = |bytes: &[u8]| usize::from(bytes.iter().map(|byte| u8::from(*byte == wanted)).sum::<u8>());
    chunks.iter().map(|chunk| of(chunk)).sum::<usize>() + of(rest)
}

#[cfg(test)]
mod tests {
    use super::{count, find};

    #[test]
    fn every_place_is_found() {
        let mut text = vec![b'x'; 100];
        assert_eq!((find(&text, |byte| byte == b'/'), count(&text, b'/')), (None, 0));
        for at in (0..100).rev() {
            text[at] = b'/';
            assert_eq!((find(&text, |byte| byte == b'/'), count(&text, b'/')), (Some(at), 100 - at));
        }
    }
}
