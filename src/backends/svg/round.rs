//! The round chart: one spiral outward from the start, counterclockwise from the top (clockwise on a mirrored sheet), counts
//! at the marker.

use super::pen::P;
use super::rows::label;
use super::sheet::{Anchor, Sheet, UNIT};
use super::spread::spread;
use super::symbols;
use super::trace::{Loop, Round, Trace, Worked, rings};
use crate::ir::{Kind, Part, Stitch};
use crate::math::sin_cos_turns;
use std::f64::consts::TAU;

/// From one turn of the spiral to the next.
const PITCH: f64 = 19.0;
/// Room of a stitch along the spiral, at least.
const ROOM: f64 = 12.5;
/// Room for the count where a round begins.
const MARKER: f64 = 19.0;
const GUIDE: &str = "fill=\"none\" stroke=\"currentColor\" stroke-opacity=\".16\" stroke-width=\".9\"";

/// Draws a part; `titles` has a line for each of its rows.
pub(super) fn draw(part: &Part, trace: &Trace, titles: &[String], sheet: &mut Sheet) {
    let loops = trace.loops as usize;
    let mut plan = Plan { turn: vec![0.0; loops], inner: 0.0, begin: 0.0, end: 0.0 };
    plan.start(part, trace, sheet);
    for round in &trace.rounds {
        let title = titles.get(round.row).map_or("", String::as_str);
        sheet.begin_round(round.number, &label(part, round.number, title));
        plan.round(round, sheet);
        sheet.end_round();
    }
}

/// Where the loops are, in turns from the start of the spiral, and how far it has come.
struct Plan {
    turn: Vec<f64>,
    /// Foot of the round under way, at its beginning.
    inner: f64,
    /// Where the round under way begins, in turns.
    begin: f64,
    /// Where the last stitch lies, in turns.
    end: f64,
}

/// How the lowest level of a round goes around, in turns.
struct Course {
    first: f64,
    /// From one stitch to the next where they lie evenly.
    step: f64,
    /// From one to the next at least.
    room: f64,
}

/// The point at so many turns, counterclockwise from the top as it is seen.
fn point(turn: f64, radius: f64) -> P {
    let (sine, cosine) = sin_cos_turns(turn);
    P(-radius * sine, -radius * cosine)
}

fn up(turn: f64) -> P {
    point(turn, 1.0)
}

impl Plan {
    fn at(places: &[f64], of: Loop) -> f64 {
        places.get(of as usize).copied().unwrap_or_default()
    }

    fn start(&mut self, part: &Part, trace: &Trace, sheet: &mut Sheet) {
        let ring = rings(part);
        let count = f64::from(trace.start);
        let foot = if ring { 9.0_f64 } else { 14.0 }
            .max((count * ROOM + MARKER) / TAU - if ring { PITCH } else { 8.0 });
        let high = if ring { PITCH } else { 10.0 };
        self.inner = foot + high + 2.0;
        if ring {
            sheet.spiral(foot.min(9.0) - 3.0);
        }
        if trace.start == 0 {
            return;
        }
        let (number, title, stitch) = if ring {
            (1, format!("Rnd 1: {} in a magic ring", trace.start), Stitch::SC)
        } else {
            (0, format!("{} loops to begin with", trace.start), Stitch::plain(Kind::Ch))
        };
        // The count stands where the spiral begins.
        let gap = (MARKER / (TAU * (foot + high / 2.0))).min(0.25);
        let turn = |index: u32| gap / 2.0 + (1.0 - gap) * (f64::from(index) + 0.5) / count;
        sheet.begin_round(number, &title);
        for index in 0..trace.start {
            let turn = turn(index);
            let top = if ring { foot + high * 0.95 } else { foot + high * 0.8 };
            sheet.sign(stitch, &[], point(turn, top), up(turn));
            self.turn[index as usize] = turn;
            self.end = turn;
        }
        sheet.end_round();
        Self::count(gap * 0.05, foot + high / 2.0, number, trace.start, sheet);
    }

    /// Lays and draws a round.
    fn round(&mut self, round: &Round, sheet: &mut Sheet) {
        let kinds = round.stitches.iter().map(|worked| symbols::height(worked.stitch.kind));
        let high = PITCH * kinds.fold(1.0, f64::max);
        let lowest = round.stitches.iter().filter(|worked| worked.level == 0);
        let slots = lowest.map(|worked| f64::from(worked.stitch.makes.max(1))).sum::<f64>().max(1.0);
        // Where many stitches are made at once the round moves outward until they have room.
        let inner = self.inner.max((slots * ROOM + MARKER) / TAU - high / 2.0);
        let middle = TAU * (inner + high / 2.0);
        let marker = (MARKER / middle).min(0.2);
        // Loops that the round before left are worked first: this one begins where they lie.
        let left = round.below.first().filter(|_| round.left > 0).map(|it| Self::at(&self.turn, *it) + 1.0);
        let begin = left.unwrap_or(self.begin + 1.0).max(self.end);
        let below = round.below.len().max(1) as f64;
        let share = 1.0 - round.unworked as f64 / below;
        let course = Course {
            first: begin + marker,
            step: (share - marker).max(0.05) / slots,
            room: (ROOM / middle).min(0.9 * (1.0 - marker) / slots),
        };
        let rise = f64::from(round.levels) * high;
        // Within a round the spiral rises by one row; what short rows pile up on it is left free behind its end.
        let foot = |turn: f64| inner + high * (turn - begin).clamp(0.0, 1.2);
        let mut nth = 0.0;
        let mut ground: Option<(f64, f64)> = None;
        self.end = begin;
        for pass in round.passes() {
            let back = pass.first().is_some_and(|worked| worked.back);
            let centers = self.lay(pass, back, &course, &mut nth);
            for (worked, center) in pass.iter().zip(&centers) {
                let low = foot(*center) + f64::from(worked.level) * high;
                self.stitch(worked, *center, low, high, sheet);
                if worked.level == 0 {
                    let (from, to) = ground.get_or_insert((*center, *center));
                    (*from, *to) = (from.min(*center), to.max(*center));
                }
            }
            if let (Some(first), Some(center)) = (pass.first().filter(|first| first.turned), centers.first())
            {
                let sign = if back { -1.0 } else { 1.0 };
                let turn = center - sign * 0.9 * course.room;
                let low = foot(turn) + (f64::from(first.level) + 0.5) * high;
                sheet.arrow(point(turn, low), up(turn + 0.25 * sign));
            }
        }
        if let Some((from, to)) = ground {
            let parts = ((to - from) * 72.0).ceil().max(1.0);
            let at = |k: u32| from + (to - from) * f64::from(k) / parts;
            let guide: Vec<P> = (0..=parts as u32).map(|k| point(at(k), foot(at(k)) - 0.5)).collect();
            sheet.guide(&guide, GUIDE);
        }
        Self::count(begin + 0.4 * marker, inner + high / 2.0, round.number, round.made as u32, sheet);
        self.begin = begin;
        self.inner = inner + rise;
    }

    fn count(turn: f64, radius: f64, number: u32, count: u32, sheet: &mut Sheet) {
        let at = point(turn, radius);
        sheet.text(P(at.0, at.1 - 0.5), 7.5, Anchor::Middle, true, &number.to_string());
        sheet.text(P(at.0, at.1 + 6.5), 6.0, Anchor::Middle, false, &format!("({count})"));
    }

    /// Places the loops of a pass a turn behind those that they are worked into, and draws them towards even places.
    fn lay(&mut self, pass: &[Worked], back: bool, course: &Course, nth: &mut f64) -> Vec<f64> {
        let sign = if back { -1.0 } else { 1.0 };
        let mut wished: Vec<f64> = Vec::new();
        let mut slots: Vec<(usize, Option<Loop>)> = Vec::new();
        let mut before = None;
        for (index, worked) in pass.iter().enumerate() {
            let sum: f64 = worked.base.iter().map(|it| Self::at(&self.turn, *it)).sum();
            let ahead = if worked.level == 0 { 1.0 } else { 0.0 };
            let center = match (worked.base.len(), before) {
                (0, None) => course.first,
                (0, Some(before)) => before + sign * course.step,
                (count, _) => sum / count as f64 + ahead,
            };
            before = Some(center);
            let made = worked.tops().map(Some).chain((worked.stitch.makes == 0).then_some(None));
            if worked.stitch.kind == Kind::Skip {
                continue;
            }
            for (place, made) in made.enumerate() {
                let apart =
                    (place as f64 - (f64::from(worked.stitch.makes.max(1)) - 1.0) / 2.0) * course.room;
                let mut wish = sign * center + apart;
                if worked.level == 0 && !back {
                    wish = 0.4 * wish + 0.6 * (course.first + course.step * (*nth + 0.5));
                    *nth += 1.0;
                }
                wished.push(wish);
                slots.push((index, made));
            }
        }
        let raised = pass.first().is_some_and(|worked| worked.level > 0);
        let least = if back || raised { f64::NEG_INFINITY } else { self.end + 0.5 * course.room };
        let places = spread(&wished, |_| course.room, least);
        let mut centers = vec![(0.0, 0.0); pass.len()];
        for ((index, made), place) in slots.into_iter().zip(places) {
            let turn = sign * place;
            if let Some((sum, count)) = centers.get_mut(index) {
                (*sum, *count) = (*sum + turn, *count + 1.0);
            }
            if let Some(slot) = made.and_then(|it| self.turn.get_mut(it as usize)) {
                *slot = turn;
            }
            if pass.get(index).is_some_and(|worked| worked.level == 0 && !worked.back) {
                self.end = self.end.max(turn);
            }
        }
        let of = |worked: &Worked| {
            let sum: f64 = worked.base.iter().map(|it| Self::at(&self.turn, *it)).sum();
            sum / worked.base.len().max(1) as f64 + 1.0
        };
        let places = centers.iter().zip(pass);
        places.map(|((sum, count), worked)| if *count > 0.0 { sum / count } else { of(worked) }).collect()
    }

    fn stitch(&self, worked: &Worked, center: f64, low: f64, high: f64, sheet: &mut Sheet) {
        // Legs that share a loop stay close together, however far apart the next stitches lie.
        let fan = |turns: &[f64], radius: f64| -> Vec<P> {
            let mean = turns.iter().sum::<f64>() / turns.len().max(1) as f64;
            let most = 0.55 * ROOM / (TAU * radius.max(1.0));
            let widest = turns.iter().map(|turn| (turn - mean).abs()).fold(most, f64::max);
            turns.iter().map(|turn| point(center + (turn - mean) * most / widest, radius)).collect()
        };
        let of = |loops: &mut dyn Iterator<Item = Loop>| -> Vec<f64> {
            loops.map(|it| Self::at(&self.turn, it)).collect()
        };
        let tops = fan(&of(&mut worked.tops()), low + high - 1.5);
        let base = match worked.base.len() {
            _ if worked.stitch.makes == 0 => vec![point(center, low + high - 1.5)],
            0 | 1 => vec![point(center, low + 0.5)],
            _ => fan(&of(&mut worked.base.iter().copied()), low + 0.5),
        };
        sheet.stitch(worked, &base, &tops, up(center));
        if let Some(color) = worked.color {
            let letter = char::from(b'A' + (color % 26) as u8).to_string();
            sheet.text(point(center, low + high), 6.0, Anchor::Middle, true, &letter);
        }
    }
}

impl Sheet {
    /// A smooth line through points, behind the signs.
    fn guide(&mut self, points: &[P], look: &str) {
        use super::pen::N;
        use std::fmt::Write as _;
        let [first, rest @ ..] = points else { return };
        let first = self.seen(*first);
        let _ = write!(self.under, "<path {look} d=\"M{} {}", N(first.0), N(first.1));
        for point in rest {
            let point = self.seen(*point);
            let _ = write!(self.under, "L{} {}", N(point.0), N(point.1));
        }
        self.under.push_str("\"/>\n");
    }

    /// The magic ring in the middle.
    fn spiral(&mut self, radius: f64) {
        let points: Vec<P> = (0..=36)
            .map(|step| {
                let turn = f64::from(step) / 20.0;
                point(turn, radius * (0.35 + 0.65 * f64::from(step) / 36.0))
            })
            .collect();
        self.guide(
            &points,
            "fill=\"none\" stroke=\"currentColor\" stroke-width=\"1.2\" stroke-linecap=\"round\"",
        );
        self.hold(P(0.0, 0.0), UNIT);
    }
}
