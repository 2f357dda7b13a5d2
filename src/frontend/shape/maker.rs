//! `[maker]`: whom the pattern is for.

use super::short;
use super::walk::Walk;
use crate::diag::Code;
use crate::ir::Hand;
use crate::ir::maker::MOST_LEAN;
use crate::shape::Wishes;
use toml::de::DeTable;

/// Reads `[maker]`, which may be left out, as may each of its keys.
pub(super) fn read(walk: &mut Walk<'_>, top: &DeTable<'_>) -> Option<Wishes> {
    let mut wishes = Wishes::default();
    let Some((_, value)) = walk.get(top, "maker") else { return Some(wishes) };
    let table = walk.table(value, "maker", "a table such as { hand = \"left\" }")?;
    walk.known(table, "`maker`", &["hand", "lean", "readability"]);
    if let Some((_, value)) = walk.get(table, "hand") {
        wishes.hand = walk.word(value, "hand", Hand::WORDS);
    }
    wishes.lean = number(walk, table, "lean", [-MOST_LEAN, MOST_LEAN]);
    wishes.readability = number(walk, table, "readability", [0.0, 1.0]);
    Some(wishes)
}

/// A number that may be left out. One that is wrong is reported, and no shape comes of the file then.
fn number(walk: &mut Walk<'_>, table: &DeTable<'_>, key: &str, [low, high]: [f64; 2]) -> Option<f64> {
    let (_, value) = walk.get(table, key)?;
    let number = walk.number(value, key)?;
    if (low..=high).contains(&number.value) {
        return Some(number.value);
    }
    let message = format!("`{key}` is {}", short(number.value));
    let expected = format!("expected a number from {low} to {high}");
    walk.fault(Code::BadNumber, number.span, message, &expected, "");
    None
}
