//! One page with everything: the object to turn around, the pattern to tick off and print, charts and numbers.
//!
//! It needs no network and no other file. The viewer's script is built from `viewer/` and taken in as it is.

mod data;
mod pattern;

use super::crochet::Crochet;
use super::svg::pen::Escaped;
use super::svg::{self, Chart, ScSymbol, Svg};
use super::{Backend, Error, Format};
use crate::diag::Sink;
use crate::ir::verify::Verified;
use crate::ir::{GaugeOrigin, Hand, Terms};
use crate::preview::{Places, Refused, Scene};
use serde::Deserialize;
use std::fmt::Write as _;
use std::io::Write;

/// Most stitches of a page. Pictures and models hold more.
pub const MAX_STITCHES: u64 = 60_000;

const SCRIPT: &str = include_str!("../../viewer/dist/viewer.js");
const STYLE: &str = include_str!("../../viewer/src/page.css");

/// Options of the target `html`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Html {
    /// The vocabulary; US by default.
    pub terms: Terms,
    /// What kind of chart.
    pub chart: Chart,
    /// The sign of single crochet.
    pub sc_symbol: ScSymbol,
    /// Thickness of the yarn in mm.
    pub yarn: Option<f64>,
    /// Where the stitches are drawn; `predicted` has the strain of each stitch too.
    pub places: Places,
    /// How the pattern is set on paper.
    pub print: Print,
    /// Whether the printed pattern has a picture; by default it has.
    pub photo: Option<bool>,
}

/// How large the printed pattern is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Print {
    /// Ten points.
    #[default]
    Normal,
    /// Small, in two columns, without a picture.
    Compact,
    /// Eighteen points, for tired eyes.
    Large,
}

impl Backend for Html {
    fn emit(&self, program: &Verified<'_>, out: &mut dyn Write, sink: &mut Sink<'_>) -> Result<(), Error> {
        let drawn = svg::drawn_stitches(program);
        if drawn > MAX_STITCHES {
            let what = format!("{drawn} stitches, a page holds {MAX_STITCHES}");
            return Err(Error::Unsupported { backend: Self::NAME, what });
        }
        let scene = Scene::new(program, self.yarn, self.places, sink);
        if let Ok(scene) = &scene {
            scene.remark(sink);
        }
        out.write_all(self.page(program, &scene).as_bytes())?;
        Ok(())
    }
}

impl Format for Html {
    const NAME: &'static str = "html";
    const EXTENSION: &'static str = "html";
    const ABOUT: &'static str =
        "one page, no network: the object in 3D, the pattern to tick off and print, charts";
}

impl Html {
    /// What the style sheet knows of the options.
    fn classes(self) -> &'static str {
        match (self.print, self.photo.unwrap_or(self.print != Print::Compact)) {
            (Print::Normal, true) => "",
            (Print::Normal, false) => "no-photo",
            (Print::Compact, true) => "compact",
            (Print::Compact, false) => "compact no-photo",
            (Print::Large, true) => "large",
            (Print::Large, false) => "large no-photo",
        }
    }

    fn page(self, program: &Verified<'_>, scene: &Result<Scene, Refused>) -> String {
        let name = Escaped(&program.name);
        let mut page = String::with_capacity(SCRIPT.len() + (1 << 16));
        let _ = write!(
            page,
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; \
             style-src 'unsafe-inline'; img-src data: blob:\">\n\
             <meta name=\"generator\" content=\"picot {}\">\n<title>{name}</title>\n<style>\n{STYLE}\
             @page {{ @top-left {{ content: \"{}\" }} }}\n@page :first {{ @top-left {{ content: none }} }}\n</style>\n</head>\n<body class=\"{}\">\n",
            env!("CARGO_PKG_VERSION"),
            StyleText(&program.name),
            self.classes()
        );
        let _ =
            write!(page, "<header><h1>{name}</h1><p>{}</p></header>\n<main>\n", Escaped(&summary(program)));
        page.push_str(include_str!("html/view.html"));
        page.push_str(
            "<div id=\"panels\">\n<div id=\"tabs\" role=\"tablist\" aria-label=\"What to show\"></div>\n",
        );
        let mut panel = |id: &str, title: &str, body: &dyn Fn(&mut String)| {
            let _ = writeln!(
                page,
                "<section id=\"{id}\" class=\"panel\" role=\"tabpanel\" aria-labelledby=\"tab-{id}\" data-title=\"{title}\">\n\
                 <h2>{title}</h2>"
            );
            body(&mut page);
            page.push_str("</section>\n");
        };
        let chart = Svg { chart: self.chart, sc_symbol: self.sc_symbol, terms: self.terms, ..Svg::default() };
        panel("pattern", "Pattern", &|page| {
            page.push_str("<p id=\"progress\" role=\"status\"></p>\n");
            pattern::write(program, self.terms, page);
        });
        panel("chart", "Chart", &|page| {
            page.push_str("<div class=\"scroll\" tabindex=\"0\" aria-label=\"Chart\">\n");
            page.push_str(&chart.document(program, false));
            page.push_str("</div>\n");
        });
        panel("materials", "Materials", &|page| materials(program, self.terms, page));
        panel("numbers", "Numbers", &|page| numbers(program, page));
        panel("about", "About", &|page| about(program, scene, page));
        page.push_str("</div>\n</main>\n<script type=\"application/json\" id=\"picot-data\">");
        let text = Crochet { terms: self.terms, ..Crochet::default() };
        data::write(program, scene.as_ref().ok(), &text, &mut page);
        page.push_str("</script>\n<script>\n");
        page.push_str(SCRIPT);
        page.push_str("</script>\n</body>\n</html>\n");
        page
    }
}

/// `371 stitches in 11 rounds`.
fn summary(program: &Verified<'_>) -> String {
    let stitches = program.facts().stitches(program);
    let rounds: u64 =
        program.pattern.parts.iter().flat_map(|part| &part.rows).map(|row| u64::from(row.times)).sum();
    let rings = program.pattern.parts.iter().filter(|part| part.first_number() == 2).count() as u64;
    let parts = program.pattern.parts.len();
    let parts = if parts > 1 { format!(" in {parts} parts") } else { String::new() };
    format!("{stitches} stitches, {} rounds{parts}", rounds + rings)
}

/// The list of the pattern's head, alone.
fn materials(program: &Verified<'_>, terms: Terms, out: &mut String) {
    let options = Crochet { terms, ..Crochet::default() };
    let (lines, head) = options.lines(program);
    let list = lines.iter().take(head).find_map(|line| match line {
        super::crochet::Line::Prose(text) => text.strip_prefix("Materials: "),
        super::crochet::Line::Code(_) | super::crochet::Line::Gap | super::crochet::Line::Round { .. } => {
            None
        }
    });
    match list {
        Some(list) => {
            out.push_str("<ul>");
            for item in list.trim_end_matches('.').split("; ") {
                let _ = write!(out, "<li>{}</li>", Escaped(item));
            }
            out.push_str("</ul>\n");
        }
        None => out.push_str("<p>The pattern does not tell its gauge, so no yarn length is estimated.</p>\n"),
    }
    if !program.colors.is_empty() {
        out.push_str("<p>Colors:</p><ul>");
        for color in &program.colors {
            let _ = write!(out, "<li>{}</li>", Escaped(color));
        }
        out.push_str("</ul>\n");
    }
}

/// Counts of every round.
fn numbers(program: &Verified<'_>, out: &mut String) {
    for (part, facts) in program.pattern.parts.iter().zip(&program.facts().parts) {
        let kind = if part.flat { "Row" } else { "Round" };
        let _ = writeln!(
            out,
            "<div class=\"scroll\"><table><caption>{}</caption><thead><tr><th>{kind}</th><th>Works</th><th>Makes</th>\
             <th>Short rows</th><th>Stitches so far</th></tr></thead><tbody>",
            Escaped(&part.name)
        );
        if part.first_number() == 2 {
            let _ =
                writeln!(out, "<tr><td>1</td><td></td><td>{0}</td><td></td><td>{0}</td></tr>", facts.start);
        }
        for (row, counts) in part.rows.iter().zip(&facts.rows) {
            let last = counts.number.saturating_add(row.times.saturating_sub(1));
            let label =
                if row.times > 1 { format!("{}\u{2013}{last}", counts.number) } else { last.to_string() };
            let short = if counts.short_rows > 0 { counts.short_rows.to_string() } else { String::new() };
            let _ = writeln!(
                out,
                "<tr><td>{label}</td><td>{}</td><td>{}</td><td>{short}</td><td>{}</td></tr>",
                counts.consumes, counts.produces, counts.total
            );
        }
        out.push_str("</tbody></table></div>\n");
    }
}

/// How honest the page is, and where it comes from.
fn about(program: &Verified<'_>, scene: &Result<Scene, Refused>, out: &mut String) {
    let gauge = match program.gauge.map(|gauge| gauge.origin) {
        None => "not told by the pattern; the view assumes one",
        Some(GaugeOrigin::Given) => "given",
        Some(GaugeOrigin::Swatch) => "measured on a swatch",
        Some(GaugeOrigin::Estimated { in_range: true, .. }) => "estimated from yarn and hook",
        Some(GaugeOrigin::Estimated { in_range: false, .. }) => {
            "estimated, with a hook that is not usual for this yarn"
        }
    };
    let places = match scene {
        Err(why) => format!("no view: {why}"),
        Ok(scene) => match scene.predicted {
            Some(rest) if rest.converged => format!(
                "predicted from the stitches alone, which stretch by {:.1} % in the mean; the made object may differ",
                100.0 * rest.strain
            ),
            Some(rest) => format!(
                "predicted from the stitches alone, and not converged: forces of {:.1e} are left, so the form is a rough one",
                rest.residual
            ),
            None => "on the shape that the pattern was generated from; yarn that relaxes is not simulated"
                .to_owned(),
        },
    };
    let hand = match program.maker.hand {
        Hand::Right => "",
        Hand::Left => "<dt>Hand</dt><dd>for left-handed work; the view shows what comes out then</dd>",
    };
    let lean = match program.maker.lean {
        0.0 => String::new(),
        lean => format!("<dt>Lean</dt><dd>for stitches that drift by {lean:+} stitches a round</dd>"),
    };
    let _ = write!(
        out,
        "<dl><dt>Pattern</dt><dd>verified by working every loop</dd>{hand}{lean}\
         <dt>Gauge</dt><dd>{gauge}</dd><dt>Places of the stitches</dt><dd>{}</dd>\
         <dt>Yarn length</dt><dd>an estimate from one measured yarn</dd>\
         <dt>Yarn in the view</dt><dd>drawn to the stitch size; strands may touch or pass through each other</dd></dl>\n\
         <p>Made by Picot {}. This page needs no network and sends nothing.</p>\n\
         <details><summary>three.js</summary><p>The view uses three.js. Copyright \u{a9} 2010-2026 three.js authors. The MIT \
         License: Permission is hereby granted, free of charge, to any person obtaining a copy of this software and associated \
         documentation files (the \"Software\"), to deal in the Software without restriction, including without limitation the \
         rights to use, copy, modify, merge, publish, distribute, sublicense, and/or sell copies of the Software, and to permit \
         persons to whom the Software is furnished to do so, subject to the following conditions: The above copyright notice and \
         this permission notice shall be included in all copies or substantial portions of the Software. THE SOFTWARE IS PROVIDED \
         \"AS IS\", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF \
         MERCHANTABILITY, FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE AUTHORS OR COPYRIGHT \
         HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, \
         ARISING FROM, OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE SOFTWARE.</p></details>\n",
        Escaped(&places),
        env!("CARGO_PKG_VERSION")
    );
}

/// Text within a quoted string of a style sheet: all but letters and digits by their number.
struct StyleText<'t>(&'t str);

impl std::fmt::Display for StyleText<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for c in self.0.chars().take(120) {
            if c.is_ascii_alphanumeric() {
                write!(f, "{c}")?;
            } else if !c.is_control() {
                write!(f, "\\{:06x}", u32::from(c))?;
            }
        }
        Ok(())
    }
}
