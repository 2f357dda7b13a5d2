//! Charts as SVG: a spiral of rounds or an unrolled chart of rows, with a legend in US and UK terms, or the needles of a
//! machine.

mod legend;
pub mod needles;
pub(super) mod pen;
mod round;
mod rows;
mod sheet;
mod spread;
mod symbols;
pub(super) mod trace;

use super::crochet::words::Words;
use super::crochet::{Arrows, Language, Terms};
use super::{Backend, Error, Format};
use crate::diag::Sink;
use crate::ir::machine::{Checked, Choice, Code};
use crate::ir::verify::{PartFacts, Verified};
use crate::ir::{Hand, Part, Start};
use crate::lower;
use pen::{Escaped, N};
use serde::Deserialize;
use sheet::Sheet;
use std::fmt::Write as _;
use std::io::Write;

/// Most stitches that a chart is drawn of.
pub const MAX_STITCHES: u64 = 100_000;
/// A round chart of more rounds than this can hardly be read, so that it is drawn only where it is asked for.
pub const READABLE_ROUNDS: usize = 20;

/// Options of the target `svg`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Svg {
    /// What kind of chart.
    pub chart: Chart,
    /// The sign of single crochet.
    pub sc_symbol: ScSymbol,
    /// The vocabulary that the legend puts first; it always has both.
    pub terms: Terms,
    /// A machine whose passes are drawn instead of the stitches, unless a kind of chart is asked for.
    pub machine: Option<Choice>,
    /// As for the target `knitout`.
    pub approximate: bool,
    /// As for the target `knitout`.
    pub no_waste: bool,
}

/// A kind of chart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Chart {
    /// A round chart for up to [`READABLE_ROUNDS`] rounds without short rows that begin in a ring, else rows.
    #[default]
    Auto,
    /// A spiral, from the middle out.
    Round,
    /// Unrolled: x is the place in the round, y the round.
    Rows,
}

/// The sign of single crochet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ScSymbol {
    /// A slanted cross.
    #[default]
    X,
    /// An upright cross.
    Plus,
}

impl Backend for Svg {
    fn emit(&self, program: &Verified<'_>, out: &mut dyn Write, sink: &mut Sink<'_>) -> Result<(), Error> {
        if let (Some(Choice(machine)), Chart::Auto) = (&self.machine, self.chart) {
            let options = lower::machine::Options { approximate: self.approximate, no_waste: self.no_waste };
            let Some(lowered) = lower::machine::lower(program, machine, &options, sink) else {
                let what = format!("`{}` cannot make it", machine.name);
                return Err(Error::Unsupported { backend: Self::NAME, what });
            };
            return needles(&program.name, &lowered.code, Some(&lowered.origins), out);
        }
        let drawn = drawn_stitches(program);
        if drawn > MAX_STITCHES {
            let what = format!("{drawn} stitches, a chart holds {MAX_STITCHES}");
            return Err(Error::Unsupported { backend: Self::NAME, what });
        }
        out.write_all(self.document(program, true).as_bytes())?;
        Ok(())
    }

    fn emit_code(&self, code: &Checked<'_>, out: &mut dyn Write, _: &mut Sink<'_>) -> Result<(), Error> {
        needles(code.header("Machine").unwrap_or("program"), code, None, out)
    }
}

/// Writes the chart of a machine program.
fn needles(
    name: &str,
    code: &Code,
    origins: Option<&[lower::machine::Origin]>,
    out: &mut dyn Write,
) -> Result<(), Error> {
    let operations = code.ops().len();
    if operations > needles::MAX_OPERATIONS {
        let what = format!("{operations} operations, a chart holds {}", needles::MAX_OPERATIONS);
        return Err(Error::Unsupported { backend: Svg::NAME, what });
    }
    out.write_all(needles::draw(name, code, origins).as_bytes())?;
    Ok(())
}

impl Format for Svg {
    const NAME: &'static str = "svg";
    const EXTENSION: &'static str = "svg";
    const ABOUT: &'static str =
        "symbol chart: a spiral of rounds, or rows; with a machine or of its code, the needles of each pass";
}

/// Signs that the charts of a program have, skips included.
pub(super) fn drawn_stitches(program: &Verified<'_>) -> u64 {
    let parts = program.pattern.parts.iter().zip(&program.facts().parts);
    parts.fold(0, |sum: u64, (part, facts)| {
        let rows = part.rows.iter().zip(&facts.rows);
        rows.fold(sum.saturating_add(facts.start.into()), |sum, (row, counts)| {
            sum.saturating_add(u64::from(row.times).saturating_mul(counts.tiles.into()))
        })
    })
}

/// True when a part is better read as a spiral.
fn suits_a_spiral(part: &Part, facts: &PartFacts) -> bool {
    let rounds: u64 = part.rows.iter().map(|row| u64::from(row.times)).sum();
    matches!(part.start, Start::Ring { .. })
        && !part.flat
        && rounds < READABLE_ROUNDS as u64
        && facts.rows.iter().all(|row| row.short_rows == 0 && row.left == 0 && row.held == 0)
}

impl Svg {
    /// The whole drawing: the charts of all parts, one below the other, and the legend. In a page of its own it has a
    /// white ground and an id for each sign, inside another it takes that page's color, and signs that follow each other in
    /// a round have no id.
    pub(super) fn document(&self, program: &Verified<'_>, own_page: bool) -> String {
        let many = program.pattern.parts.len() > 1;
        let mut body = String::new();
        let (mut width, mut below) = (0.0_f64, 16.0_f64);
        let mut spirals = false;
        let mut unrolled = false;
        let mut back = false;
        for (index, (part, facts)) in program.pattern.parts.iter().zip(&program.facts().parts).enumerate() {
            let trace = trace::trace(part);
            let words = Words::new(program, part, self.terms, Language::English, Arrows::Unicode);
            let titles: Vec<String> = part
                .rows
                .iter()
                .zip(&facts.rows)
                .map(|(row, counts)| format!("{} ({})", words.row(&row.body, false), counts.produces))
                .collect();
            let spiral = match self.chart {
                Chart::Auto => suits_a_spiral(part, facts),
                Chart::Round => !part.flat,
                Chart::Rows => false,
            };
            let mut sheet = Sheet::new(index, own_page, self.sc_symbol);
            if spiral {
                if program.maker.hand == Hand::Left {
                    sheet.mirror();
                }
                round::draw(part, &trace, &titles, &mut sheet);
            } else {
                rows::draw(part, &trace, &titles, &mut sheet);
            }
            spirals |= spiral;
            unrolled |= !spiral;
            back |= facts.rows.iter().any(|row| row.short_rows > 0);
            if !sheet.low.0.is_finite() {
                continue;
            }
            if many || part.copies > 1 {
                let copies = if part.copies > 1 { format!(" (make {})", part.copies) } else { String::new() };
                let _ = writeln!(
                    body,
                    "<text x=\"16\" y=\"{}\" font-size=\"14\" font-weight=\"bold\">{}{copies}</text>",
                    N(below + 12.0),
                    Escaped(&part.name)
                );
                below += 24.0;
            }
            let (x, y) = (16.0 - sheet.low.0, below - sheet.low.1);
            let _ = writeln!(
                body,
                "<g id=\"p{index}\" transform=\"translate({} {})\">\n{}<g fill=\"none\" stroke=\"currentColor\" \
                 stroke-width=\"1.25\" stroke-linecap=\"round\">\n{}</g>\n<g fill=\"currentColor\" class=\"halo\">\n{}</g>\n</g>",
                N(x),
                N(y),
                sheet.under,
                sheet.body,
                sheet.words
            );
            width = width.max(sheet.high.0 - sheet.low.0 + 32.0);
            below += sheet.high.1 - sheet.low.1 + 24.0;
        }
        let legend =
            legend::draw(self, program, legend::Reading { spirals, unrolled, back }, width.max(340.0), below);
        width = width.max(legend.width);
        let height = legend.below + 12.0;
        let name = Escaped(&program.name);
        let mut document = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"picot-chart\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" \
             role=\"img\" aria-labelledby=\"chart-title chart-desc\" font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\"",
            N(width.ceil()),
            N(height.ceil())
        );
        let ground = if own_page { " color=\"#1d1d1f\"" } else { "" };
        let _ = writeln!(document, "{ground}>\n<title id=\"chart-title\">{name}: chart</title>");
        let _ = writeln!(document, "<desc id=\"chart-desc\">{}</desc>", Escaped(&description(program)));
        if own_page {
            document.push_str("<style>.halo text{paint-order:stroke;stroke:#fff;stroke-width:2px;stroke-linejoin:round}</style>\n");
            document.push_str("<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n");
        }
        document.push_str(&body);
        document.push_str(&legend.body);
        document.push_str("</svg>\n");
        document
    }
}

/// What a person who does not see the chart is told.
fn description(program: &Verified<'_>) -> String {
    let parts = program.pattern.parts.iter().zip(&program.facts().parts).map(|(part, facts)| {
        let rounds: u64 = part.rows.iter().map(|row| u64::from(row.times)).sum();
        let kind = if part.flat { "rows" } else { "rounds" };
        let widest = facts.rows.iter().map(|row| row.produces).max().unwrap_or(0);
        format!("{}: {rounds} {kind}, {} stitches, at most {widest} in one", part.name, facts.stitches)
    });
    let hand = match program.maker.hand {
        Hand::Right => "",
        Hand::Left => ", for left-handed work",
    };
    format!("Crochet chart{hand}. {}.", parts.collect::<Vec<_>>().join(". "))
}
