//! Bytes of a kind looked for a chunk at a time: without a branch a byte, compilers take many of them at once.

/// The place of the first byte of this kind.
#[inline]
pub(crate) fn find(bytes: &[u8], wanted: impl Fn(u8) -> bool) -> Option<usize> {
    let (chunks, _) = bytes.as_chunks::<16>();
    let mut from = 0;
    for chunk in chunks {
        let mut any = false;
        for byte in chunk {
            any |= wanted(*byte);
        }
        if any {
            break;
        }
        from += chunk.len();
    }
    Some(from + bytes.get(from..)?.iter().position(|byte| wanted(*byte))?)
}

#[cfg(test)]
mod tests {
    use super::find;

    #[test]
    fn every_place_is_found() {
        let mut text = vec![b'x'; 100];
        assert_eq!(find(&text, |byte| byte == b'/'), None);
        for at in (0..100).rev() {
            text[at] = b'/';
            assert_eq!(find(&text, |byte| byte == b'/'), Some(at));
        }
    }
}
