//! Whether a shape and a stitch fit each other: enough stitches around, enough rows, not more than can be handled.

use super::short;
use super::tube::Places;
use super::walk::Walk;
use crate::diag::{Code, Diagnostic, Span};
use crate::ir::{Gauge, MAX_LOOPS, MAX_ROW};
use crate::shape::beads::Beads;
use crate::shape::{End, Sweep};
use glam::DVec3;

/// Fewest stitches around an open tube.
const LEAST_AROUND: f64 = 4.0;
/// Fewest rows from end to end.
const LEAST_ROWS: f64 = 2.0;
/// Stations along the tube and points around it at which it is measured.
const STATIONS: usize = 64;
const AROUND: usize = 24;
/// Longest side, in mm, of what people crochet by hand; outside of it the unit may be wrong.
const LIKELY: std::ops::RangeInclusive<f64> = 8.0..=3000.0;

/// Rough measures of a tube, in mm.
struct Measures {
    girths: Vec<f64>,
    length: f64,
    area: f64,
    extent: f64,
}

/// Points around a tube at many places.
pub(super) struct Rings {
    points: Vec<DVec3>,
}

impl Rings {
    /// Balls that hold the tube.
    pub(super) fn beads(&self) -> Beads {
        Beads::new(&self.points, AROUND)
    }
}

/// Checks the tube against the gauge; of a sound one, points around it.
pub(super) fn check(
    walk: &mut Walk<'_>,
    surface: &Sweep,
    places: &Places,
    gauge: &Gauge,
    gauge_span: Span,
) -> Option<Rings> {
    let (measures, rings) = measure(surface);
    let loops = measures.area / (gauge.width * gauge.height);
    let widest = measures.girths.iter().copied().fold(0.0, f64::max) / gauge.width;
    let station = |index: usize| surface.curve_parameter(index as f64 / STATIONS as f64);
    let section = |index: usize| places.section(station(index));
    if !(loops <= f64::from(MAX_LOOPS) && widest <= f64::from(MAX_ROW)) {
        let message = format!("the shape takes {loops:.0} stitches, at most {MAX_LOOPS} are made");
        let message = if loops <= f64::from(MAX_LOOPS) {
            format!("the widest round has {widest:.0} stitches, at most {MAX_ROW} are made")
        } else {
            message
        };
        walk.report(
            Diagnostic::new(Code::ShapeTooLarge, message)
                .at(section(widest_station(&measures)), "too large")
                .at(gauge_span, "for this stitch")
                .help(unit_help(walk)),
        );
        return None;
    }
    let rows = measures.length / gauge.height;
    if rows < LEAST_ROWS {
        let message = format!("the shape has {rows:.1} rows, at least {LEAST_ROWS} are needed");
        walk.report(
            Diagnostic::new(Code::ShapeTooShort, message)
                .at(section(STATIONS / 2), format!("{:.1} mm from end to end", measures.length))
                .at(gauge_span, format!("a stitch is {} mm high", short(gauge.height)))
                .help(unit_help(walk)),
        );
        return None;
    }
    let narrow = narrowest_station(&measures.girths, places);
    let girth = measures.girths.get(narrow).copied().unwrap_or_default();
    let around = girth / gauge.width;
    if around < LEAST_AROUND {
        let u = station(narrow);
        let message = format!(
            "{around:.1} stitches go around the tube at u = {u:.2}, at least {LEAST_AROUND} are needed"
        );
        walk.report(
            Diagnostic::new(Code::ShapeTooNarrow, message)
                .at(section(narrow), format!("{girth:.1} mm around"))
                .at(gauge_span, format!("a stitch is {} mm wide", short(gauge.width)))
                .help(unit_help(walk)),
        );
        return None;
    }
    if !LIKELY.contains(&measures.extent) {
        let (mm, unit) = (short(measures.extent), walk.unit.name());
        walk.report(
            Diagnostic::new(Code::UnlikelySize, format!("the object measures {mm} mm"))
                .at(section(0), "")
                .help(format!("this file counts in {unit}, is that right?")),
        );
    }
    Some(rings)
}

fn unit_help(walk: &Walk<'_>) -> String {
    format!("change the stitch or the shape; this file counts in {}, is that right?", walk.unit.name())
}

fn widest_station(measures: &Measures) -> usize {
    let stations = measures.girths.iter().enumerate();
    stations.max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(index, _)| index)
}

/// The station with the least girth, cones of closed ends left out: they shrink to nothing by design.
fn narrowest_station(girths: &[f64], places: &Places) -> usize {
    let rising = girths.windows(2).take_while(|pair| pair[1] >= pair[0]).count();
    let falling = girths.windows(2).rev().take_while(|pair| pair[0] >= pair[1]).count();
    let first = if places.start == End::Closed { rising } else { 0 };
    let last = girths.len().saturating_sub(1) - if places.end == End::Closed { falling } else { 0 };
    let stations =
        girths.iter().enumerate().filter(|(index, _)| (first.min(last)..=last.max(first)).contains(index));
    stations.min_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(index, _)| index)
}

fn measure(surface: &Sweep) -> (Measures, Rings) {
    let ring = |station: usize| {
        let mut points = [DVec3::ZERO; AROUND];
        surface.points_around(station as f64 / STATIONS as f64, &mut points);
        points
    };
    let girth = |ring: &[DVec3]| -> f64 {
        ring.iter().zip(ring.iter().cycle().skip(1)).map(|(a, b)| a.distance(*b)).sum()
    };
    let mut below = ring(0);
    let mut points = Vec::with_capacity((STATIONS + 1) * AROUND);
    points.extend_from_slice(&below);
    let mut measures = Measures { girths: vec![girth(&below)], length: 0.0, area: 0.0, extent: 0.0 };
    let mut meridians = vec![0.0; AROUND];
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for station in 1..=STATIONS {
        let above = ring(station);
        points.extend_from_slice(&above);
        measures.girths.push(girth(&above));
        let next = |ring: &[DVec3], k: usize| ring.get((k + 1) % AROUND).copied().unwrap_or_default();
        for (k, ((a, b), meridian)) in below.iter().zip(&above).zip(&mut meridians).enumerate() {
            *meridian += a.distance(*b);
            measures.area += (next(&above, k) - *a).cross(*b - next(&below, k)).length() / 2.0;
            (low, high) = (low.min(*a).min(*b), high.max(*a).max(*b));
        }
        below = above;
    }
    measures.length = meridians.into_iter().fold(0.0, f64::max);
    measures.extent = (high - low).max_element();
    (measures, Rings { points })
}
