//! `[gauge]`: the size of a stitch, given, measured on a swatch, or guessed from yarn and hook.

use super::walk::{Value, Walk, list, misspelled, quote, replace};
use crate::diag::{Code, Diagnostic, Span, did_you_mean};
use crate::ir::yarn::{Estimate, Hook, YARNS, Yarn};
use crate::ir::{Gauge, GaugeOrigin};
use toml::de::{DeFloat, DeInteger, DeTable};

/// The three ways of giving a gauge.
const FORMS: &[&str] = &["stitch", "swatch", "yarn"];
/// Stitch sizes that a hand or a machine can make, in mm.
const POSSIBLE: std::ops::RangeInclusive<f64> = 0.2..=100.0;

/// Reads `[gauge]`: the gauge and the place that the user should look at when it does not fit the shape.
pub(super) fn read(walk: &mut Walk<'_>, top: &DeTable<'_>, home: Span) -> Option<(Gauge, Span)> {
    const EXAMPLE: &str = "[gauge]\nstitch = { width = 0.6, height = 0.55 }";
    let Some((place, value)) = walk.get(top, "gauge") else {
        if misspelled(top, "gauge") {
            return None;
        }
        let help = format!("add\n{EXAMPLE}");
        walk.fault(Code::GaugeMissing, home, "the file has no `gauge`".to_owned(), "", &help);
        return None;
    };
    let table = walk.table(value, "gauge", "a table with `stitch`, `swatch` or `yarn`")?;
    walk.known(table, "`gauge`", FORMS);
    let given: Vec<(Span, &Value<'_>, &str)> = FORMS
        .iter()
        .filter_map(|form| walk.get(table, form).map(|(span, value)| (span, value, *form)))
        .collect();
    let [(span, value, form)] = given.as_slice() else {
        if !(given.is_empty() && FORMS.iter().any(|form| misspelled(table, form))) {
            several(walk, place, &given);
        }
        return None;
    };
    let gauge = match *form {
        "stitch" => stitch(walk, value, *span),
        "swatch" => swatch(walk, value, *span),
        _ => yarn(walk, value, *span),
    }?;
    possible(walk, &gauge, *span).then_some((gauge, *span))
}

/// Reports a gauge that is given in no way, or in more than one.
fn several(walk: &mut Walk<'_>, place: Span, given: &[(Span, &Value<'_>, &str)]) {
    let [(first, _, one), (second, _, other), ..] = given else {
        let help = "give one of `stitch`, `swatch` and `yarn`";
        walk.fault(Code::GaugeMissing, place, "`gauge` gives no stitch size".to_owned(), "", help);
        return;
    };
    walk.report(
        Diagnostic::new(Code::GaugeConflict, format!("the gauge is given as `{one}` and as `{other}`"))
            .at((*first).max(*second), "given again here")
            .at((*first).min(*second), "given here")
            .help("keep the one that you know best: a swatch, then a stitch size, then the yarn"),
    );
}

fn stitch(walk: &mut Walk<'_>, value: &Value<'_>, span: Span) -> Option<Gauge> {
    const HOME: &str = "`stitch`";
    let table = walk.table(value, "stitch", "a table such as { width = 0.6, height = 0.55 }")?;
    walk.known(table, HOME, &["width", "height"]);
    let width = walk.need(table, "width", (HOME, span), "width = 0.6");
    let height = walk.need(table, "height", (HOME, span), "height = 0.55");
    let width = width.and_then(|(_, value)| walk.size(value, "width"));
    let height = height.and_then(|(_, value)| walk.size(value, "height"));
    Some(Gauge::new(width?.value, height?.value))
}

fn swatch(walk: &mut Walk<'_>, value: &Value<'_>, span: Span) -> Option<Gauge> {
    const HOME: &str = "`swatch`";
    const EXPECTED: &str = "a table such as { width = 6, height = 5.5, stitches = 10, rows = 10 }";
    let table = walk.table(value, "swatch", EXPECTED)?;
    walk.known(table, HOME, &["width", "height", "stitches", "rows"]);
    let mut size = |key: &'static str, example: &str| {
        let found = walk.need(table, key, (HOME, span), example);
        found.and_then(|(_, value)| walk.size(value, key))
    };
    let (width, height) = (size("width", "width = 6"), size("height", "height = 5.5"));
    let mut count = |key: &'static str, example: &str| {
        let (_, value) = walk.need(table, key, (HOME, span), example)?;
        let number = walk.number(value, key)?;
        walk.positive(number, key)
    };
    let (stitches, rows) = (count("stitches", "stitches = 10"), count("rows", "rows = 10"));
    let gauge = Gauge {
        width: width?.value / stitches?.value,
        height: height?.value / rows?.value,
        origin: GaugeOrigin::Swatch,
    };
    Some(gauge)
}

fn yarn(walk: &mut Walk<'_>, value: &Value<'_>, span: Span) -> Option<Gauge> {
    const HOME: &str = "`yarn`";
    let table = walk.table(value, "yarn", "a table such as { weight = \"worsted\", hook = \"5.5 mm\" }")?;
    walk.known(table, HOME, &["weight", "hook"]);
    let yarn = walk.need(table, "weight", (HOME, span), "weight = \"worsted\"");
    let yarn = yarn.and_then(|(_, value)| weight(walk, value));
    let hook = walk.need(table, "hook", (HOME, span), "hook = \"5.5 mm\"");
    let hook = hook.and_then(|(_, value)| hook_size(walk, value));
    let (yarn, hook) = (yarn?, hook?);
    let estimate = yarn.estimate(hook);
    remarks(walk, yarn, hook, &estimate, span);
    let origin = GaugeOrigin::Estimated { weight: yarn.weight, hook, in_range: estimate.in_range };
    Some(Gauge { width: estimate.width, height: estimate.height, origin })
}

/// A weight by number or name.
fn weight(walk: &mut Walk<'_>, value: &Value<'_>) -> Option<&'static Yarn> {
    const EXPECTED: &str = "a weight such as \"worsted\" or 4";
    let text = match value.get_ref().as_integer() {
        Some(integer) => integer.as_str(),
        None => walk.text(value, "weight", EXPECTED)?,
    };
    let yarn = Yarn::parse(text);
    if yarn.is_none() {
        let span = walk.of(value);
        let names = || YARNS.iter().flat_map(|yarn| yarn.names).copied();
        let diagnostic =
            Diagnostic::new(Code::UnknownYarn, format!("no yarn weight is called \"{}\"", quote(text)));
        walk.report(if let Some(near) = did_you_mean(&text.to_lowercase(), names()) {
            let word = format!("\"{near}\"");
            let fix = replace(format!("write {word}"), span, &word);
            diagnostic.at(span, format!("did you mean {word}?")).fix(fix)
        } else {
            let standard: Vec<&str> = YARNS.iter().map(Yarn::name).collect();
            let names = list(&standard, "or");
            let help = format!("weights are 0 to 7, or {names}; most labels show the number");
            diagnostic.at(span, "not a weight").help(help)
        });
    }
    yarn
}

/// A hook in mm or by its US name. Hooks are sold by millimeters whatever the unit of the file, so a bare number is refused.
fn hook_size(walk: &mut Walk<'_>, value: &Value<'_>) -> Option<Hook> {
    const EXPECTED: &str = "a hook such as \"5.5 mm\" or \"I-9\"";
    let span = walk.of(value);
    let written = value.get_ref();
    let text = written.as_str().filter(|text| text.trim().parse::<f64>().is_ok());
    let number = written.as_integer().map(DeInteger::as_str).or(written.as_float().map(DeFloat::as_str));
    let bare = text.map(str::trim).or(number);
    if let Some(number) = bare {
        let message = format!("is `hook = {}` millimeters or a US size?", quote(number));
        let fix = format!("\"{number} mm\"");
        let fix = replace(format!("write {fix}"), span, &fix);
        walk.report(
            Diagnostic::new(Code::UnknownHook, message)
                .at(span, format!("expected {EXPECTED}"))
                .help("write millimeters as \"5.5 mm\" and US sizes as \"I-9\" or \"US 9\"")
                .fix(fix),
        );
        return None;
    }
    let text = walk.text(value, "hook", EXPECTED)?;
    let millimeters = text.trim().strip_suffix("mm").and_then(|number| number.trim_end().parse().ok());
    let hook = millimeters.map_or_else(|| Hook::from_us(text), Hook::from_mm);
    if hook.is_none() {
        let message = format!("no hook is called \"{}\"", quote(text));
        let help = "write millimeters, 0.4 to 60, as \"5.5 mm\", or a US size as \"I-9\"";
        walk.fault(Code::UnknownHook, span, message, &format!("expected {EXPECTED}"), help);
    }
    hook
}

/// Says that the gauge is a guess, and how good a guess.
fn remarks(walk: &mut Walk<'_>, yarn: &Yarn, hook: Hook, estimate: &Estimate, span: Span) {
    let percent = (estimate.uncertainty * 100.0).round();
    let (width, height) = (estimate.width, estimate.height);
    let why = if estimate.in_range {
        String::new()
    } else {
        let [small, large] = yarn.hooks;
        format!(": {hook} is outside of the usual hooks for {}, {small} to {large} mm", yarn.name())
    };
    walk.report(
        Diagnostic::new(Code::GaugeEstimated, format!("the gauge is estimated{why}"))
            .at(span, format!("taken as {width:.2} x {height:.2} mm a stitch, within {percent} %"))
            .help("work 12 x 12 stitches, measure the inner 10 x 10 and give it as `swatch`"),
    );
    if yarn.weight == 0 {
        walk.report(
            Diagnostic::new(
                Code::LaceGauge,
                "the gauge of lace weight is counted in double crochet, not single",
            )
            .at(span, "the estimate is weaker still here")
            .help("give a `swatch`"),
        );
    }
}

/// Refuses stitches that no one can make.
fn possible(walk: &mut Walk<'_>, gauge: &Gauge, span: Span) -> bool {
    let sizes = [("wide", gauge.width), ("high", gauge.height)];
    let Some((word, size)) = sizes.into_iter().find(|(_, size)| !POSSIBLE.contains(size)) else {
        return true;
    };
    let message = format!("a stitch {} mm {word} cannot be made", super::short(size));
    let unit = walk.unit.name();
    let help = format!("stitches are 0.2 to 100 mm; this file counts in {unit}, is that right?");
    walk.fault(Code::StitchSize, span, message, "", &help);
    false
}
