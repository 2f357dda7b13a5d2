//! `picot list`: the tables that the program itself uses.

use super::args::{List, Topic};
use super::{Failure, Status, print, print_json};
use picot::backends::TARGETS;
use picot::diag::Code;
use picot::frontend::READERS;
use picot::frontend::crochet::Setting;
use picot::ir::Kind;
use picot::ir::machine::{MACHINES, profile::FIELDS};
use picot::passes::PASSES;
use serde_json::{Value, json};
use std::fmt::Write;

pub(crate) fn run(arguments: &List) -> Result<Status, Failure> {
    let (name, rows) = rows(arguments.what);
    if arguments.json {
        return print_json(&json!({ "schema": "picot.list/1", name: rows }));
    }
    let mut text = String::new();
    let cells: Vec<Vec<String>> = rows.iter().map(|row| cells(arguments.what, row)).collect();
    let columns = cells.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        cells.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    for row in &cells {
        let mut line = String::new();
        for (cell, width) in row.iter().zip(&widths) {
            let _ = write!(line, "{cell:width$}  ");
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    if arguments.what == Topic::Targets {
        let _ = writeln!(text, "\nOptions for --set of the generator: {}", generator_keys().join(", "));
    }
    print(text.as_bytes())
}

fn generator_keys() -> &'static [&'static str] {
    picot::settings::keys::<picot::generate::Options>()
}

fn rows(topic: Topic) -> (&'static str, Vec<Value>) {
    match topic {
        Topic::Targets => (
            "targets",
            TARGETS
                .iter()
                .map(|target| {
                    json!({ "name": target.name, "extension": target.extension, "about": target.about,
                        "binary": target.binary, "options": target.keys() })
                })
                .collect(),
        ),
        Topic::Readers => (
            "readers",
            READERS
                .iter()
                .map(|reader| json!({ "name": reader.name, "extensions": reader.extensions, "about": reader.about }))
                .collect(),
        ),
        Topic::Passes => {
            ("passes", PASSES.iter().map(|pass| json!({ "name": pass.name, "about": pass.about })).collect())
        }
        Topic::Stitches => (
            "stitches",
            Kind::ALL
                .iter()
                .map(|kind| {
                    json!({ "us": kind.us(), "uk": kind.uk(), "us_name": kind.us_name(), "uk_name": kind.uk_name(),
                        "works": kind.works(), "makes": kind.makes(), "height": kind.height() })
                })
                .collect(),
        ),
        Topic::Machines => (
            "machines",
            MACHINES
                .iter()
                .map(|(name, profile)| json!({ "name": name, "profile": profile }))
                .chain(FIELDS.iter().map(|field| json!({ "field": field.key, "about": field.about })))
                .collect(),
        ),
        Topic::Conventions => (
            "conventions",
            Setting::ALL
                .iter()
                .map(|setting| {
                    json!({ "name": setting.name(), "values": setting.values(), "about": setting.about().trim() })
                })
                .collect(),
        ),
        Topic::Codes => (
            "codes",
            Code::ALL
                .iter()
                .map(|code| {
                    json!({ "code": code.as_str(), "severity": code.severity().name(), "title": code.title() })
                })
                .collect(),
        ),
    }
}

/// The cells of one row of the table for people.
fn cells(topic: Topic, row: &Value) -> Vec<String> {
    let text = |key: &str| match &row[key] {
        Value::String(text) => text.clone(),
        Value::Array(items) => items.iter().filter_map(Value::as_str).collect::<Vec<_>>().join(", "),
        other @ (Value::Null | Value::Bool(_) | Value::Number(_) | Value::Object(_)) => other.to_string(),
    };
    match topic {
        Topic::Targets => {
            let options = text("options");
            let options = if options.is_empty() { options } else { format!("[{options}]") };
            vec![text("name"), format!(".{}", text("extension")), text("about"), options]
        }
        Topic::Readers => vec![text("name"), text("extensions"), text("about")],
        Topic::Passes => vec![text("name"), text("about")],
        Topic::Stitches => vec![text("us"), text("us_name"), format!("UK {}", text("uk")), text("uk_name")],
        Topic::Machines if row["name"].is_string() => vec![text("name"), "built in".to_owned()],
        Topic::Machines => vec![text("field"), text("about")],
        Topic::Codes => vec![text("code"), text("title")],
        Topic::Conventions => vec![text("name"), text("values"), text("about")],
    }
}
