//! `[maker]`: whom the pattern is for.

use super::walk::Walk;
use crate::ir::Hand;
use crate::shape::Wishes;
use toml::de::DeTable;

/// Reads `[maker]`, which may be left out, as may each of its keys.
pub(super) fn read(walk: &mut Walk<'_>, top: &DeTable<'_>) -> Option<Wishes> {
    let mut wishes = Wishes::default();
    let Some((_, value)) = walk.get(top, "maker") else { return Some(wishes) };
    let table = walk.table(value, "maker", "a table such as { hand = \"left\" }")?;
    walk.known(table, "`maker`", &["hand"]);
    if let Some((_, value)) = walk.get(table, "hand") {
        wishes.hand = Some(walk.word(value, "hand", Hand::WORDS)?);
    }
    Some(wishes)
}
