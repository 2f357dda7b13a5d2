//! `--set KEY=VALUE` finds its owner: the generator's options, or the options of a target.

use super::args::Reading;
use super::{Failure, files};
use picot::backends::{TARGETS, Target};
use picot::diag::{Sink, Sources, did_you_mean};
use picot::frontend::crochet::{Conventions, Setting};
use picot::frontend::{Unit, mesh};
use picot::generate;
use picot::ir::machine::{Hand, MACHINES, Machine, Profile};

/// The settings of a run, each with its owner.
#[derive(Debug)]
pub(crate) struct Routed {
    /// For the stages before printing.
    pub(crate) options: picot::Options,
    /// For the targets, in the order in which they were asked for.
    pub(crate) tables: Vec<toml::Table>,
    /// The knitting machine that `--machine` names.
    pub(crate) machine: Option<Machine>,
    /// The hand that it names.
    pub(crate) hand: Option<Hand>,
}

/// The machine of a name or a profile file.
fn machine(named: &str) -> Result<(Profile, toml::Value), Failure> {
    if let Some(machine) = Machine::named(named) {
        return Ok((Profile::VBed(Box::new(machine)), toml::Value::String(named.to_owned())));
    }
    if !std::path::Path::new(named).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) {
        let known = || MACHINES.iter().map(|(name, _)| *name);
        let failure = Failure::usage(format!("there is no machine `{named}`"));
        return Err(match did_you_mean(named, known()) {
            Some(near) => failure.help(format!("did you mean `{near}`?")),
            None => failure
                .help(format!("one of {}, or a profile FILE.toml", known().collect::<Vec<_>>().join(", "))),
        });
    }
    let mut sources = Sources::new(&files::load);
    let source = sources.open(named).map_err(|error| Failure::file(named, error))?;
    let mut sink = Sink::new();
    let machine = Profile::read(&source, &mut sink);
    let table = source.text().ok().and_then(|text| text.parse::<toml::Table>().ok());
    if let (Some(machine), Some(table)) = (machine, table) {
        return Ok((machine, toml::Value::Table(table)));
    }
    let message = sink.take().first().map(|found| found.message.clone()).unwrap_or_default();
    Err(Failure::usage(format!("{named}: {message}"))
        .help("`picot list machines` shows every field of a profile"))
}

/// Hands each setting to all who have its key. A key that no one has, or a value of the wrong type, is wrong usage.
pub(crate) fn route(reading: &Reading, targets: &[&'static Target]) -> Result<Routed, Failure> {
    let generator = picot::settings::keys::<generate::Options>();
    let mut general = toml::Table::new();
    let mut conventions = Conventions::default();
    let mut tables = vec![toml::Table::new(); targets.len()];
    let left_handed = reading.left_handed.then(|| ("hand".to_owned(), toml::Value::from("left")));
    for (key, value) in reading.set.iter().chain(&left_handed) {
        let mut known = false;
        let mut printed = false;
        if generator.contains(&key.as_str()) {
            known = true;
            let alone = toml::Table::from_iter([(key.clone(), value.clone())]);
            alone.try_into::<generate::Options>().map_err(|error| wrong_value(key, &error))?;
            general.insert(key.clone(), value.clone());
        }
        for (target, table) in targets.iter().zip(&mut tables) {
            if target.keys().contains(&key.as_str()) {
                (known, printed) = (true, true);
                let alone = toml::Table::from_iter([(key.clone(), value.clone())]);
                target.configure(alone).map_err(|error| wrong_value(key, &error))?;
                table.insert(key.clone(), value.clone());
            }
        }
        let convention = key == "lang" || Setting::ALL.iter().any(|setting| setting.name() == key);
        // Terms of a target are those that it writes.
        if convention && !printed {
            known = true;
            let value = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
            let declared = conventions.set(key, &value);
            declared.map_err(|right| Failure::usage(format!("--set {key}={value}: expected {right}")))?;
        }
        if !known {
            return Err(unknown(key, generator, targets));
        }
    }
    let machine = reading.machine.as_deref().map(machine).transpose()?;
    if let Some(machine) = &machine {
        let value = &machine.1;
        for (target, table) in targets.iter().zip(&mut tables) {
            if target.keys().contains(&"machine") {
                if let Profile::Hand(hand) = &machine.0 {
                    // A chart is of stitches too.
                    if target.keys().contains(&"chart") {
                        continue;
                    }
                    let message =
                        format!("`{}` crochets; {} is for knitting machines", hand.name, target.name);
                    let help = "write the pattern: --to crochet".to_owned();
                    return Err(Failure::Impossible { message, help: Some(help) });
                }
                table.insert("machine".to_owned(), value.clone());
            }
        }
    }
    for (target, table) in targets.iter().zip(&tables) {
        target.configure(table.clone()).map_err(|error| wrong_value(target.name, &error))?;
    }
    let generate: generate::Options =
        general.try_into().map_err(|error| wrong_value("the generator", &error))?;
    if let Some((key, right)) = generate.fault() {
        return Err(
            Failure::usage(format!("--set {key}: out of range")).help(format!("give it a value {right}"))
        );
    }
    let (machine, hand) = match machine {
        Some((Profile::VBed(machine), _)) => (Some(*machine), None),
        Some((Profile::Hand(hand), _)) => (None, Some(hand)),
        None => (None, None),
    };
    let mesh = mesh::Reading {
        unit: named(Unit::WORDS, reading.unit.as_deref()),
        up: named(mesh::Up::WORDS, reading.up.as_deref()),
    };
    let options = picot::Options { gauge: reading.gauge, generate, conventions, mesh };
    Ok(Routed { options, tables, machine, hand })
}

fn named<T: Copy>(words: &[(&str, T)], name: Option<&str>) -> Option<T> {
    words.iter().find(|(word, _)| Some(*word) == name).map(|(_, value)| *value)
}

fn wrong_value(key: &str, error: &toml::de::Error) -> Failure {
    let message = error.message().lines().next().unwrap_or("wrong value");
    let message = ["invalid type: ", "invalid value: "]
        .into_iter()
        .find_map(|what| message.strip_prefix(what))
        .unwrap_or(message);
    // The reader names a type as the language does.
    let message = match message.rsplit_once("expected ") {
        Some((found, "f64" | "f32")) => format!("{found}expected a number, as 0.5"),
        Some((found, "u8" | "u16" | "u32" | "u64" | "usize")) => {
            format!("{found}expected a whole number, 0 or more")
        }
        _ => message.to_owned(),
    };
    Failure::usage(format!("--set {key}: {message}"))
}

fn unknown(key: &str, generator: &[&'static str], targets: &[&'static Target]) -> Failure {
    let failure = Failure::usage(format!("--set {key}: there is no such option"));
    let owners: Vec<&str> =
        TARGETS.iter().filter(|target| target.keys().contains(&key)).map(|target| target.name).collect();
    if !owners.is_empty() {
        return failure.help(format!("it belongs to the target {}", owners.join(", ")));
    }
    let keys =
        || generator.iter().copied().chain(targets.iter().flat_map(|target| target.keys().iter().copied()));
    match did_you_mean(key, keys()) {
        Some(near) => failure.help(format!("did you mean `{near}`?")),
        None => failure.help(format!("the options are {}", keys().collect::<Vec<_>>().join(", "))),
    }
}
