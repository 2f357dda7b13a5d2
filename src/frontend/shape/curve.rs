//! `curve`: one Bézier segment, or a list of them.

use super::walk::{Value, Walk, count};
use crate::diag::{Code, Diagnostic, Span};
use crate::shape::Bezier;
use glam::DVec3;

/// Most segments of a curve.
const MOST_SEGMENTS: usize = 2048;
/// Ends of segments nearer than this, in mm, are the same point.
const SAME_POINT: f64 = 1e-6;

/// A segment with its place.
#[derive(Debug)]
pub(super) struct Segment {
    /// The segment in mm.
    pub(super) bezier: Bezier,
    /// Where it stands.
    pub(super) span: Span,
}

const EXPECTED: &str = "a list of 2 to 4 points, or a list of such segments";

/// Reads `curve`.
pub(super) fn read(walk: &mut Walk<'_>, value: &Value<'_>) -> Option<Vec<Segment>> {
    let entries = walk.list(value, "curve", EXPECTED, MOST_SEGMENTS)?;
    let nested = |value: &Value<'_>| value.get_ref().is_array();
    let chain =
        entries.iter().any(|entry| entry.get_ref().as_array().is_some_and(|inner| inner.iter().any(nested)));
    if !chain {
        return segment(walk, value).map(|segment| vec![segment]);
    }
    let read: Vec<Option<Segment>> = entries.iter().map(|entry| segment(walk, entry)).collect();
    let segments: Vec<Segment> = read.into_iter().collect::<Option<_>>()?;
    joined(walk, &segments).then_some(segments)
}

/// One segment of degree 1 to 3.
fn segment(walk: &mut Walk<'_>, value: &Value<'_>) -> Option<Segment> {
    let entries = walk.list(value, "curve", "a list of 2 to 4 points", MOST_SEGMENTS)?;
    let span = walk.of(value);
    if !(2..=4).contains(&entries.len()) {
        let message = format!("a curve segment has {}, expected 2, 3 or 4", count(entries.len(), "point"));
        let help = "two points are a line, three a quadratic and four a cubic Bézier segment; longer curves are lists of segments, each starting where the last one ended";
        walk.fault(Code::CurveDegree, span, message, "", help);
        return None;
    }
    let read: Vec<Option<DVec3>> = entries.iter().map(|entry| point(walk, entry, "curve", 3)).collect();
    let points: Vec<DVec3> = read.into_iter().collect::<Option<_>>()?;
    if points.windows(2).all(|pair| pair[0] == pair[1]) {
        let message = "a curve segment has no length".to_owned();
        walk.fault(Code::SegmentLength, span, message, "all its points are the same", "");
        return None;
    }
    Bezier::new(&points).map(|bezier| Segment { bezier, span })
}

/// A point in mm: three numbers, or from `least` on with the missing ones 0.
pub(super) fn point(walk: &mut Walk<'_>, value: &Value<'_>, what: &str, least: usize) -> Option<DVec3> {
    const EXPECTED: &str = "a point [x, y, z]";
    let Some(entries) = value.get_ref().as_array() else {
        walk.mismatch(value, what, EXPECTED);
        return None;
    };
    if !(least..=3).contains(&entries.len()) {
        let span = walk.of(value);
        let message = format!("a point of `{what}` has {}", count(entries.len(), "number"));
        walk.fault(Code::PointForm, span, message, &format!("expected {EXPECTED}"), "");
        return None;
    }
    // All are read before one that is wrong counts.
    let mut number = |index: usize| {
        entries.get(index).map_or(Some(0.0), |entry| walk.length(entry, what).map(|number| number.value))
    };
    let [x, y, z] = [number(0), number(1), number(2)];
    Some(DVec3::new(x?, y?, z?))
}

/// Checks that every segment starts where the one before ends.
fn joined(walk: &mut Walk<'_>, segments: &[Segment]) -> bool {
    let mut whole = true;
    for (index, pair) in segments.windows(2).enumerate() {
        let (Some(end), Some(start)) = (pair[0].bezier.points().last(), pair[1].bezier.points().first())
        else {
            continue;
        };
        let gap = end.distance(*start);
        if gap > SAME_POINT {
            whole = false;
            let (gap, unit) = (gap / walk.unit.mm(), walk.unit.word());
            let message = format!(
                "segment {} starts {} {unit} away from the end of segment {}",
                index + 2,
                super::short(gap),
                index + 1
            );
            walk.report(
                Diagnostic::new(Code::CurveGap, message)
                    .at(pair[1].span, "starts here")
                    .at(pair[0].span, "ends elsewhere")
                    .help("repeat the last point of a segment as the first of the next"),
            );
        }
    }
    whole
}
