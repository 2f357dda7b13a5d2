//! `[maker]`: whom the pattern is for.

use super::short;
use super::walk::Walk;
use crate::diag::Code;
use crate::ir::Hand;
use crate::shape::Wishes;
use toml::de::DeTable;

/// Reads `[maker]`, which may be left out, as may each of its keys.
pub(super) fn read(walk: &mut Walk<'_>, top: &DeTable<'_>) -> Option<Wishes> {
    let mut wishes = Wishes::default();
    let Some((_, value)) = walk.get(top, "maker") else { return Some(wishes) };
    let table = walk.table(value, "maker", "a table such as { hand = \"left\" }")?;
    walk.known(table, "`maker`", &["hand", "readability"]);
    if let Some((_, value)) = walk.get(table, "hand") {
        wishes.hand = walk.word(value, "hand", Hand::WORDS);
    }
    if let Some((_, value)) = walk.get(table, "readability") {
        let number = walk.number(value, "readability")?;
        if !(0.0..=1.0).contains(&number.value) {
            let message = format!("`readability` is {}", short(number.value));
            walk.fault(Code::BadNumber, number.span, message, "expected a number from 0 to 1", "");
            return None;
        }
        wishes.readability = Some(number.value);
    }
    Some(wishes)
}
