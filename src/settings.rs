//! Options as text: which keys an options struct has, and what `KEY=VALUE` says.

use serde::de::{DeserializeOwned, Deserializer, Error as _, Visitor, value::Error};

/// The keys of an options struct, as its `Deserialize` names them; empty for a type that is no struct.
pub fn keys<T: DeserializeOwned>() -> &'static [&'static str] {
    let mut keys: &'static [&'static str] = &[];
    // The error is how the visit ends: nothing is read, only the field names are wanted.
    let _ = T::deserialize(FieldNames(&mut keys));
    keys
}

/// Splits `KEY=VALUE`. The value is a TOML boolean, number or array of such where it reads as one, a number where it is
/// written as people do (`.5`), else the text itself.
pub fn parse(text: &str) -> Option<(String, toml::Value)> {
    let (key, value) = text.split_once('=')?;
    let (key, value) = (key.trim(), value.trim());
    if key.is_empty() {
        return None;
    }
    let text = || toml::Value::String(value.to_owned());
    Some((key.to_owned(), scalar(value).or_else(|| loose_number(value)).unwrap_or_else(text)))
}

/// A number without a digit before or behind its point.
fn loose_number(text: &str) -> Option<toml::Value> {
    let digits = |c: char| c.is_ascii_digit() || matches!(c, '.' | '+' | '-');
    let number = text.chars().all(digits).then(|| text.parse().ok()).flatten();
    number.map(toml::Value::Float)
}

fn scalar(text: &str) -> Option<toml::Value> {
    if text.contains(['\n', '\r', '#']) {
        return None;
    }
    let mut table: toml::Table = format!("x = {text}").parse().ok()?;
    match table.remove("x")? {
        toml::Value::Datetime(_) | toml::Value::Table(_) => None,
        value @ (toml::Value::String(_)
        | toml::Value::Integer(_)
        | toml::Value::Float(_)
        | toml::Value::Boolean(_)
        | toml::Value::Array(_)) => Some(value),
    }
}

/// Deserializes nothing, but notes the field names that a derived implementation asks for.
struct FieldNames<'k>(&'k mut &'static [&'static str]);

impl<'de> Deserializer<'de> for FieldNames<'_> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, _visitor: V) -> Result<V::Value, Error> {
        Err(Error::custom("only the names of the fields are wanted"))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        *self.0 = fields;
        self.deserialize_any(visitor)
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map enum identifier ignored_any
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(serde::Deserialize)]
    #[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
    #[derive(Default)]
    struct Sample {
        _short_rows: bool,
        _lambda: f64,
    }

    #[test]
    fn keys_are_the_renamed_fields() {
        assert_eq!(keys::<Sample>(), ["-short-rows", "-lambda"]);
        assert!(keys::<u32>().is_empty());
    }

    #[test]
    fn values_are_toml_where_they_read_as_toml() {
        let value = |text| parse(text).unwrap().1;
        assert_eq!(value("a=true"), toml::Value::Boolean(true));
        assert_eq!(value("a = 2"), toml::Value::Integer(2));
        assert_eq!(value("a=0.5"), toml::Value::Float(0.5));
        assert_eq!(value("a=.5"), toml::Value::Float(0.5));
        assert_eq!(value("a=-2."), toml::Value::Float(-2.0));
        assert_eq!(value("a=1.2.3"), toml::Value::String("1.2.3".into()));
        assert_eq!(value("a=\"2\""), toml::Value::String("2".into()));
        assert_eq!(value("a=5.5 mm"), toml::Value::String("5.5 mm".into()));
        assert_eq!(value("a=b=c"), toml::Value::String("b=c".into()));
        assert_eq!(value("a=#ff0000"), toml::Value::String("#ff0000".into()));
        assert_eq!(value("a="), toml::Value::String(String::new()));
        assert_eq!(parse("a"), None);
        assert_eq!(parse("=1"), None);
    }
}
