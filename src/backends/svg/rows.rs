//! The unrolled chart: x is the place in the round, y the round; short rows are segments of their own with arrows.

use super::pen::P;
use super::sheet::{Anchor, Sheet, UNIT};
use super::spread::spread;
use super::symbols;
use super::trace::{Loop, Round, Trace, Worked, rings};
use crate::ir::{Kind, Part, Stitch};

/// Height of a row of single crochet.
const ROW: f64 = 17.0;
/// Room between rounds, in rows.
const BETWEEN: f64 = 0.3;
const UP: P = P(0.0, -1.0);
const STEM: &str =
    "stroke=\"currentColor\" stroke-opacity=\".3\" stroke-width=\".8\" stroke-dasharray=\"1 3\"";
const START: &str =
    "stroke=\"currentColor\" stroke-opacity=\".45\" stroke-width=\"1.2\" stroke-linecap=\"round\"";

/// Draws a part; `titles` has a line for each of its rows.
pub(super) fn draw(part: &Part, trace: &Trace, titles: &[String], sheet: &mut Sheet) {
    let loops = trace.loops as usize;
    let mut plan =
        Plan { x: vec![0.0; loops], y: vec![0.0; loops], as_base: vec![0.0; loops], height: 0.0, end: 0.0 };
    plan.start(part, trace, sheet);
    let mut shade = Vec::new();
    let mut begins: Option<P> = None;
    for (index, round) in trace.rounds.iter().enumerate() {
        let low = plan.height;
        let title = titles.get(round.row).map_or("", String::as_str);
        sheet.begin_round(round.number, &label(part, round.number, title));
        let first = plan.round(part, round, sheet);
        sheet.end_round();
        if index % 2 == 0 {
            shade.push((low, plan.height));
        }
        if let Some(first) = first.filter(|_| !part.flat)
            && let Some(before) = begins.replace(first)
        {
            sheet.line(before, first, START);
        }
    }
    if sheet.low.0.is_finite() {
        let (left, right) = (sheet.low.0 - 4.0, sheet.high.0 + 4.0);
        let below = std::mem::take(&mut sheet.under);
        for (low, high) in shade {
            let (top, bottom) = (P(left, -high * ROW), P(right, -low * ROW));
            sheet.area(top, bottom, "fill=\"currentColor\" fill-opacity=\".045\"");
        }
        sheet.under.push_str(&below);
    }
}

/// `Rnd 7: 6 sc (6)`.
pub(super) fn label(part: &Part, number: u32, row: &str) -> String {
    format!("{} {number}: {row}", if part.flat { "Row" } else { "Rnd" })
}

/// Where the loops are: x in cells, y in rows, upward.
struct Plan {
    x: Vec<f64>,
    y: Vec<f64>,
    /// Where a loop is for the stitches worked into it: rows that grow narrower draw together.
    as_base: Vec<f64>,
    height: f64,
    /// Where the round under way has come to at its lowest level.
    end: f64,
}

impl Plan {
    fn point(x: f64, y: f64) -> P {
        P(x * UNIT, -y * ROW)
    }

    fn at(places: &[f64], of: Loop) -> f64 {
        places.get(of as usize).copied().unwrap_or_default()
    }

    fn start(&mut self, part: &Part, trace: &Trace, sheet: &mut Sheet) {
        let ring = rings(part);
        let stitch = if ring { Stitch::SC } else { Stitch::plain(Kind::Ch) };
        let high = if ring { 1.0 } else { 0.8 };
        if trace.start == 0 {
            return;
        }
        let (number, title) = if ring {
            (1, format!("Rnd 1: {} in a magic ring", trace.start))
        } else {
            (0, format!("{} loops to begin with", trace.start))
        };
        sheet.begin_round(number, &title);
        for index in 0..trace.start {
            let x = f64::from(index);
            let top = Self::point(x, high);
            sheet.sign(stitch, &[], if ring { top } else { Self::point(x, 1.0) }, UP);
            self.x[index as usize] = x;
            self.y[index as usize] = high;
        }
        sheet.end_round();
        let (left, right) = (-1.1, f64::from(trace.start) + 0.1);
        if ring {
            sheet.text(Self::point(left, 0.25), 10.0, Anchor::End, false, "1");
            let words = format!("({}) in a magic ring", trace.start);
            sheet.text(Self::point(right, 0.25), 9.0, Anchor::Start, false, &words);
        } else {
            sheet.text(Self::point(right, 0.2), 9.0, Anchor::Start, false, &format!("{}", trace.start));
        }
        self.height = high + BETWEEN;
    }

    /// Lays and draws a round; returns its starting mark.
    fn round(&mut self, part: &Part, round: &Round, sheet: &mut Sheet) -> Option<P> {
        self.approach(round);
        self.end = f64::NEG_INFINITY;
        let kinds = round.stitches.iter().map(|worked| symbols::height(worked.stitch.kind));
        let high = kinds.fold(1.0, f64::max);
        let ground = self.height;
        let forward = if round.reversed { -1.0 } else { 1.0 };
        let mut ends: Option<(f64, f64)> = None;
        let mut begin = None;
        for pass in round.passes() {
            let sign = if pass.first().is_some_and(|worked| worked.back) { -forward } else { forward };
            let centers = self.lay(pass, sign, ground, high);
            if let (Some(first), Some(center)) = (pass.first(), centers.first()) {
                let middle = ground + (f64::from(first.level) + 0.5) * high;
                if first.turned {
                    sheet.arrow(Self::point(center - sign * 0.95, middle), P(sign, 0.0));
                } else {
                    begin = Some(Self::point(center - sign * 0.55, ground));
                }
            }
            for (worked, center) in pass.iter().zip(&centers) {
                self.stitch(worked, *center, ground, high, sheet);
                if worked.level == 0 {
                    let (least, most) = ends.get_or_insert((*center, *center));
                    (*least, *most) = (least.min(*center), most.max(*center));
                }
            }
            raised(pass, &centers, ground, high, sheet);
        }
        if let Some((least, most)) = ends {
            let count = format!("({})", round.made);
            let (number, low) = (round.number.to_string(), ground + 0.28 * high);
            let (left, right) = (Self::point(least - 1.6, low), Self::point(most + 1.6, low));
            if round.reversed {
                sheet.text(right, 10.0, Anchor::Start, false, &number);
                sheet.text(left, 9.0, Anchor::End, false, &count);
            } else {
                sheet.text(left, 10.0, Anchor::End, false, &number);
                sheet.text(right, 9.0, Anchor::Start, false, &count);
            }
            if part.flat {
                let x = if round.reversed { most + 1.1 } else { least - 1.1 };
                sheet.arrow(Self::point(x, ground + 0.5 * high), P(forward, 0.0));
            }
        }
        self.height = ground + f64::from(round.levels) * high + BETWEEN;
        begin
    }

    /// Brings the loops below to where this round finds them: those that were left come before the others, and where
    /// they stand far apart they draw together a little.
    fn approach(&mut self, round: &Round) {
        for below in &round.below {
            let place = Self::at(&self.x, *below);
            if let Some(as_base) = self.as_base.get_mut(*below as usize) {
                *as_base = place;
            }
        }
        let (left, own) = round.below.split_at(round.left.min(round.below.len()));
        let range = |loops: &[Loop], places: &[f64]| {
            loops
                .iter()
                .map(|it| Self::at(places, *it))
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
        };
        if !left.is_empty() && !own.is_empty() {
            let shift = range(own, &self.as_base).0 - 1.0 - range(left, &self.as_base).1;
            for it in left {
                if let Some(x) = self.as_base.get_mut(*it as usize) {
                    *x += shift;
                }
            }
        }
        let (low, high) = range(&round.below, &self.as_base);
        let (wide, count) = (high - low + 1.0, round.below.len() as f64);
        if wide > 1.1 * count && count > 0.0 {
            let scale = (1.04 * count / wide).max(0.9);
            let middle = f64::midpoint(low, high);
            for it in &round.below {
                if let Some(x) = self.as_base.get_mut(*it as usize) {
                    *x = middle + (*x - middle) * scale;
                }
            }
        }
    }

    /// Places the loops of a pass over those that they are worked into; returns the middle of each stitch.
    fn lay(&mut self, pass: &[Worked], sign: f64, ground: f64, high: f64) -> Vec<f64> {
        let mut wished = Vec::new();
        let mut slots = Vec::new();
        let mut before = None;
        for (index, worked) in pass.iter().enumerate() {
            let sum: f64 = worked.base.iter().map(|it| Self::at(&self.as_base, *it)).sum();
            let center = match (worked.base.len(), before) {
                (0, None) => 0.0,
                (0, Some(before)) => before + sign,
                (count, _) => sum / count as f64,
            };
            before = Some(center);
            let makes = f64::from(worked.stitch.makes);
            for (nth, made) in worked.tops().enumerate() {
                wished.push(sign * center + nth as f64 - (makes - 1.0) / 2.0);
                slots.push((index, Some(made)));
            }
            // What makes no loop needs room all the same.
            if worked.stitch.makes == 0 && worked.stitch.kind != Kind::Skip {
                wished.push(sign * center);
                slots.push((index, None));
            }
        }
        let places = self.places(pass, &wished, &slots);
        let mut centers: Vec<(f64, f64)> = vec![(0.0, 0.0); pass.len()];
        for ((index, made), place) in slots.into_iter().zip(places) {
            let x = sign * place;
            if let Some((sum, count)) = centers.get_mut(index) {
                (*sum, *count) = (*sum + x, *count + 1.0);
            }
            let level = pass.get(index).map_or(0, |worked| worked.level);
            if let Some(made) = made.map(|it| it as usize).filter(|it| *it < self.x.len()) {
                self.x[made] = x;
                self.as_base[made] = x;
                self.y[made] = ground + (f64::from(level) + 1.0) * high;
            }
        }
        let of = |worked: &Worked| {
            let sum: f64 = worked.base.iter().map(|it| Self::at(&self.as_base, *it)).sum();
            sum / worked.base.len().max(1) as f64
        };
        let places = centers.iter().zip(pass);
        places.map(|((sum, count), worked)| if *count > 0.0 { sum / count } else { of(worked) }).collect()
    }

    /// Spreads the wished places of a pass, one level after the other.
    fn places(&mut self, pass: &[Worked], wished: &[f64], slots: &[(usize, Option<Loop>)]) -> Vec<f64> {
        let level = |slot: &(usize, Option<Loop>)| pass.get(slot.0).map_or(0, |worked| worked.level);
        let back = pass.first().is_some_and(|worked| worked.back);
        let mut places: Vec<f64> = Vec::with_capacity(wished.len());
        for run in slots.chunk_by(|a, b| level(a) == level(b)) {
            let mut wished = wished.get(places.len()..places.len() + run.len()).unwrap_or_default().to_vec();
            let ground = run.first().map_or(0, level) == 0 && !back;
            if ground {
                together(&mut wished);
            }
            let least = if ground { self.end + 1.0 } else { f64::NEG_INFINITY };
            let run = spread(&wished, |_| 1.0, least);
            if let (true, Some(last)) = (ground, run.last()) {
                self.end = *last;
            }
            places.extend(run);
        }
        places
    }

    fn stitch(&self, worked: &Worked, center: f64, ground: f64, high: f64, sheet: &mut Sheet) {
        let foot = ground + f64::from(worked.level) * high;
        let tops: Vec<P> = if worked.stitch.makes == 0 {
            Vec::new()
        } else {
            worked.tops().map(|it| Self::point(Self::at(&self.x, it), foot + high)).collect()
        };
        let base: Vec<P> = match worked.base.as_slice() {
            [] | [_] => vec![Self::point(center, foot)],
            several => {
                let mean =
                    several.iter().map(|it| Self::at(&self.as_base, *it)).sum::<f64>() / several.len() as f64;
                let near = |it: &Loop| center + (Self::at(&self.as_base, *it) - mean).clamp(-1.2, 1.2);
                several.iter().map(|it| Self::point(near(it), foot)).collect()
            }
        };
        for it in &worked.base {
            let (x, y) = (Self::at(&self.x, *it), Self::at(&self.y, *it));
            if foot - y > BETWEEN + 0.2 && (x - center).abs() < 4.0 {
                sheet.line(Self::point(x, y + 0.1), Self::point(center, foot), STEM);
            }
        }
        let base = if worked.stitch.makes == 0 { vec![Self::point(center, foot + high)] } else { base };
        sheet.stitch(worked, &base, &tops, UP);
        if let Some(color) = worked.color {
            let letter = char::from(b'A' + (color % 26) as u8).to_string();
            sheet.text(Self::point(center, foot + high - 0.05), 7.0, Anchor::Middle, true, &letter);
        }
    }
}

/// Draws places a little together where they lie farther apart than they need, so that gaps close over some rounds.
fn together(wished: &mut [f64]) {
    let [first, .., last] = wished else { return };
    let (from, to) = (*first, *last);
    let steps = wished.len() as f64 - 1.0;
    let step = (0.96 * (to - from) / steps).max(1.0);
    let begin = f64::midpoint(from, to) - step * steps / 2.0;
    for (nth, place) in wished.iter_mut().enumerate() {
        *place = 0.8 * *place + 0.2 * (begin + step * nth as f64);
    }
}

/// A box behind the stitches of a pass that lie on others of their round.
fn raised(pass: &[Worked], centers: &[f64], ground: f64, high: f64, sheet: &mut Sheet) {
    let mut from = 0;
    while let Some(first) = pass.get(from) {
        let rest = pass.get(from..).unwrap_or_default();
        let to = from + rest.iter().take_while(|worked| worked.level == first.level).count();
        let places = centers.get(from..to).unwrap_or_default();
        let low = places.iter().copied().fold(f64::INFINITY, f64::min);
        let far = places.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if first.level > 0 && low.is_finite() {
            let foot = ground + f64::from(first.level) * high;
            let (a, b) = (Plan::point(low - 0.55, foot + high - 0.04), Plan::point(far + 0.55, foot + 0.04));
            sheet.area(a, b, "fill=\"#b8500f\" fill-opacity=\".1\"");
        }
        from = to;
    }
}
