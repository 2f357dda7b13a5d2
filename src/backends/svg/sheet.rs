//! What a chart of one part is drawn on: layers, extents, and the group of a round.

use super::ScSymbol;
use super::pen::{Escaped, N, P, Path};
use super::symbols;
use super::trace::Worked;
use std::borrow::Cow;
use std::fmt::Write as _;

/// Width of a cell, in user units (pixels at 100 %).
pub(super) const UNIT: f64 = 16.0;
/// Color of what short rows do.
pub(super) const ACCENT: &str = "#b8500f";

/// The drawing of one part.
#[derive(Debug)]
pub(super) struct Sheet {
    /// Behind the signs.
    pub(super) under: String,
    /// The signs, one group a round.
    pub(super) body: String,
    /// Words and numbers.
    pub(super) words: String,
    pub(super) low: P,
    pub(super) high: P,
    part: usize,
    /// Whether each sign has an id, or only those that do not follow the one before.
    ids: bool,
    last: Option<u32>,
    sc: ScSymbol,
    open: Option<bool>,
    /// Left and right change places.
    mirror: bool,
}

/// Where a text stands to its point.
#[derive(Clone, Copy, Debug)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Sheet {
    /// A sheet for a part; where not all signs have `ids`, the reader counts on from the one before.
    pub(super) fn new(part: usize, ids: bool, sc: ScSymbol) -> Self {
        Self {
            under: String::new(),
            body: String::new(),
            words: String::new(),
            low: P(f64::INFINITY, f64::INFINITY),
            high: P(f64::NEG_INFINITY, f64::NEG_INFINITY),
            part,
            ids,
            last: None,
            sc,
            open: None,
            mirror: false,
        }
    }

    /// From here on draws the mirror image, with words that can be read.
    pub(super) fn mirror(&mut self) {
        self.mirror = true;
    }

    /// A point or a direction as it is drawn.
    pub(super) fn seen(&self, at: P) -> P {
        if self.mirror { P(-at.0, at.1) } else { at }
    }

    fn all_seen<'p>(&self, points: &'p [P]) -> Cow<'p, [P]> {
        if self.mirror {
            return points.iter().map(|at| self.seen(*at)).collect();
        }
        Cow::Borrowed(points)
    }

    /// Makes room for a point.
    pub(super) fn hold(&mut self, at: P, around: f64) {
        let at = self.seen(at);
        self.low = P(self.low.0.min(at.0 - around), self.low.1.min(at.1 - around));
        self.high = P(self.high.0.max(at.0 + around), self.high.1.max(at.1 + around));
    }

    /// Opens the group of a round; `title` is shown on hover and read aloud.
    pub(super) fn begin_round(&mut self, number: u32, title: &str) {
        let _ = writeln!(self.body, "<g id=\"p{}r{number}\"><title>{}</title>", self.part, Escaped(title));
        self.open = Some(false);
        self.last = None;
    }

    /// Closes it.
    pub(super) fn end_round(&mut self) {
        if self.open.take() == Some(true) {
            self.body.push_str("</g>");
        }
        self.body.push_str("</g>\n");
    }

    /// Draws a stitch; those of a back pass are colored.
    pub(super) fn stitch(&mut self, worked: &Worked, base: &[P], tops: &[P], up: P) {
        let mut path = Path::default();
        let [drawn, ends] = [self.all_seen(base), self.all_seen(tops)];
        let filled = symbols::draw(worked.stitch, self.sc, &drawn, &ends, self.seen(up), UNIT, &mut path);
        if path.is_empty() {
            return;
        }
        if self.open != Some(worked.back) {
            match (self.open, worked.back) {
                (_, true) => {
                    let _ = writeln!(self.body, "<g stroke=\"{ACCENT}\">");
                }
                (Some(true), false) => self.body.push_str("</g>"),
                (_, false) => {}
            }
            self.open = Some(worked.back);
        }
        self.path(Some(worked.tile), &path, filled);
        tops.iter().chain(base).for_each(|point| self.hold(*point, UNIT * 0.5));
    }

    /// A sign of the start, which has no tile.
    pub(super) fn sign(&mut self, stitch: crate::ir::Stitch, base: &[P], top: P, up: P) {
        let mut path = Path::default();
        let (base, up) = (self.all_seen(base), self.seen(up));
        let filled = symbols::draw(stitch, self.sc, &base, &[self.seen(top)], up, UNIT, &mut path);
        self.path(None, &path, filled);
        self.hold(top, UNIT);
    }

    fn path(&mut self, tile: Option<u32>, path: &Path, filled: bool) {
        self.body.push_str("<path");
        let follows = |tile: u32| self.last.is_some_and(|last| last + 1 == tile);
        if let Some(tile) = tile.filter(|tile| self.ids || !follows(*tile)) {
            let _ = write!(self.body, " id=\"p{}s{tile}\"", self.part);
        }
        self.last = tile;
        if filled {
            self.body.push_str(" fill=\"currentColor\"");
        }
        let _ = writeln!(self.body, " d=\"{}\"/>", path.data());
    }

    /// Writes a text of `size` with halo, so that it can be read over lines.
    pub(super) fn text(&mut self, at: P, size: f64, anchor: Anchor, accent: bool, text: &str) {
        let wide = text.chars().count() as f64 * size * 0.6;
        let x = match anchor {
            Anchor::Start => at.0 + wide,
            Anchor::Middle => at.0 + wide / 2.0,
            Anchor::End => at.0 - wide,
        };
        self.hold(P(x, at.1), size);
        let at = self.seen(at);
        let anchor = match (anchor, self.mirror) {
            (Anchor::Start, false) | (Anchor::End, true) => "",
            (Anchor::Middle, _) => " text-anchor=\"middle\"",
            (Anchor::End, false) | (Anchor::Start, true) => " text-anchor=\"end\"",
        };
        let color = if accent { format!(" fill=\"{ACCENT}\"") } else { String::new() };
        let _ = writeln!(
            self.words,
            "<text x=\"{}\" y=\"{}\" font-size=\"{}\"{anchor}{color}>{}</text>",
            N(at.0),
            N(at.1),
            N(size),
            Escaped(text)
        );
    }

    /// A line behind the signs.
    pub(super) fn line(&mut self, from: P, to: P, look: &str) {
        let mut path = Path::default();
        path.line(self.seen(from), self.seen(to));
        let _ = writeln!(self.under, "<path {look} d=\"{}\"/>", path.data());
    }

    /// A box behind the signs.
    pub(super) fn area(&mut self, low: P, high: P, look: &str) {
        let (a, b) = (self.seen(low), self.seen(high));
        let (low, high) = (P(a.0.min(b.0), a.1), P(a.0.max(b.0), b.1));
        let _ = writeln!(
            self.under,
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"3\" {look}/>",
            N(low.0),
            N(low.1),
            N(high.0 - low.0),
            N(high.1 - low.1)
        );
    }

    /// An arrow of the length of half a cell around a point.
    pub(super) fn arrow(&mut self, at: P, along: P) {
        self.hold(at, UNIT);
        let (at, along) = (self.seen(at), self.seen(along));
        let up = P(along.1, -along.0);
        let (tail, tip) = (at.plus(along, -0.42 * UNIT), at.plus(along, 0.42 * UNIT));
        let mut path = Path::default();
        path.line(tail, tip);
        for side in [-0.22, 0.22] {
            path.line(tip, tip.plus(along, -0.28 * UNIT).plus(up, side * UNIT));
        }
        let _ = writeln!(
            self.under,
            "<path fill=\"none\" stroke=\"{ACCENT}\" stroke-width=\"1.4\" stroke-linecap=\"round\" d=\"{}\"/>",
            path.data()
        );
    }
}
