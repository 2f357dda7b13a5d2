//! The row table: where along the tube each row lies, so that the least distance of two rows is one stitch height.

use crate::ir::Gauge;
use crate::math;
use crate::shape::{End, Jet, ParametricSurface, girth};

pub(crate) use crate::shape::row_speed;

/// Share of the mean row distance in the spacing rule; the rest is the least distance around the row.
/// The paper's rule is 0; a fifth opens fewer short rows at no cost elsewhere.
const MEAN_SHARE: f64 = 0.2;
/// Samples around a row.
const AROUND: usize = 24;
const FEW: usize = 8;
/// Most rows that one side may be ahead at the end; in rounds of more than so many stitches the share of the mean shrinks
/// for it. Shorter rounds have no room for the short rows that this opens.
const MOST_AHEAD: f64 = 1.15;
const LONG_ROUND: f64 = 60.0;
/// Farthest against closest distance of two rows, on average, over which a surface is harsh.
const HARSH: f64 = 1.72;
/// Even rounds toward a pole are all shaped, and wales over shapings slant: by so much of a row they come out lower.
const SLANT: f64 = 0.15;
/// Most rows that are tabulated, against surfaces whose derivative by u is next to nothing.
const MAX_ROWS: usize = 2_000_000;

/// The reparametrization u -> tau (paper, section 3.2): u as a piecewise linear function of the row number.
#[derive(Debug)]
pub(crate) struct Rows {
    knots: Vec<f64>,
    /// Table rows per row of the pattern.
    scale: f64,
    /// Table rows before row 0 and behind the last: see [`lead`].
    lead: f64,
    tail: f64,
    /// Farthest against closest distance of two rows, on average.
    unevenness: f64,
    /// The farthest distance of two rows from each knot on, in their spacing.
    farthest: Vec<f32>,
    /// Number of rows; whole.
    pub count: f64,
}

/// Rows beyond an end: half a row at a pole, where the ring next to it lies one row off on average.
pub(crate) fn lead(end: End) -> f64 {
    if end == End::Closed { 0.5 } else { 0.0 }
}

impl Rows {
    /// Spaces rows of the height of a stitch over the tube, of which the first and the last lie so many rows off its ends ([`lead`]). `None` when not even two rows fit or the surface has no length.
    pub(crate) fn new(
        surface: &dyn ParametricSurface,
        [lead, tail]: [f64; 2],
        gauge: &Gauge,
    ) -> Option<Self> {
        let height = gauge.height;
        let first = table(surface, height, MEAN_SHARE)?;
        let (ahead, unevenness) = (first.ahead, first.unevenness);
        let Table { knots, farthest, .. } =
            if ahead > MOST_AHEAD && mean_girth(surface, &first.knots) > LONG_ROUND * gauge.width {
                table(surface, height, MEAN_SHARE * MOST_AHEAD / ahead)?
            } else {
                first
            };
        let last = knots.len() - 1;
        let partial = (1.0 - knots[last - 1]) / (knots[last] - knots[last - 1]);
        let total = last as f64 - 1.0 + partial;
        let count = (total - lead - tail).round().max(1.0);
        let scale = total / (count + lead + tail);
        (total >= 0.75).then_some(Self { knots, scale, lead, tail, unevenness, farthest, count })
    }

    /// One row more, closer together, where even rounds that close would else come out short; `None` elsewhere.
    pub(crate) fn of_even(&self, ends: [End; 2]) -> Option<Self> {
        let lost: f64 = ends.map(|end| if end == End::Closed { SLANT } else { 0.0 }).iter().sum();
        let off_ends = self.lead + self.tail;
        let total = self.scale * (self.count + off_ends);
        let count = (total - off_ends + lost).round().max(1.0);
        let scale = total / (count + off_ends);
        (count > self.count).then(|| {
            let (knots, farthest) = (self.knots.clone(), self.farthest.clone());
            Self { knots, scale, farthest, count, ..*self }
        })
    }

    /// True where rows lie far closer on one side than on the other nearly everywhere, as in a sharp bend.
    pub(crate) fn is_harsh(&self) -> bool {
        self.unevenness > HARSH
    }

    /// The farthest distance of neighboring rows around the tube between two rows, in their spacing.
    pub(crate) fn farthest(&self, between: [f64; 2]) -> f64 {
        let last = self.farthest.len() - 1;
        let [first, end] = between.map(|tau| (((tau + self.lead) * self.scale).max(0.0) as usize).min(last));
        let all = &self.farthest[first..=end.max(first)];
        f64::from(all.iter().copied().fold(0.0, f32::max))
    }

    /// The surface parameter of row `tau`.
    #[inline]
    pub(crate) fn at(&self, tau: f64) -> f64 {
        let x = ((tau + self.lead) * self.scale).max(0.0);
        let last = self.knots.len() - 2;
        let (i, rest) = math::split(x);
        let (i, rest) = if i <= last { (i, rest) } else { (last, x - last as f64) };
        let [low, high] = [self.knots[i], self.knots[i + 1]];
        low + rest * (high - low)
    }

    /// The row number of a surface parameter: the inverse of [`Rows::at`]. `knot` is where the last one was found, from
    /// which it is looked for.
    pub(crate) fn tau(&self, u: f64, knot: &mut usize) -> f64 {
        const FAR: usize = 8;
        let last = self.knots.len() - 2;
        let first = (*knot).min(last);
        let mut i = first;
        while i < last && self.knots[i + 1] <= u && i < first + FAR {
            i += 1;
        }
        while i > 0 && self.knots[i] > u && i + FAR > first {
            i -= 1;
        }
        if i.abs_diff(first) == FAR {
            i = self.knots.partition_point(|knot| *knot <= u).clamp(1, last + 1) - 1;
        }
        *knot = i;
        let x = i as f64 + (u - self.knots[i]) / (self.knots[i + 1] - self.knots[i]);
        x / self.scale - self.lead
    }
}

/// A pole proper has no direction around; look a hair beside it.
fn inside(u: f64) -> f64 {
    u.clamp(1e-6, 1.0 - 1e-6)
}

/// Mean girth at some of the rows, in mm.
fn mean_girth(surface: &dyn ParametricSurface, knots: &[f64]) -> f64 {
    let step = (knots.len() / 16).max(1);
    let girths = knots.iter().step_by(step).map(|u| girth(surface, inside(*u), 8));
    let (sum, count) = girths.fold((0.0, 0.0), |(sum, count), girth| (sum + girth, count + 1.0));
    sum / count
}

/// Where rows lie, and how unevenly.
struct Table {
    knots: Vec<f64>,
    /// By how many rows one side is ahead at the end: where rows lie closer than their spacing it gains on them, and short
    /// rows on the other side cannot hold it back; where they lie farther apart, short rows keep it level.
    ahead: f64,
    unevenness: f64,
    farthest: Vec<f32>,
}

/// The table of rows with a share of the mean distance in their spacing. `None` when the surface has no length.
fn table(surface: &dyn ParametricSurface, height: f64, mean_share: f64) -> Option<Table> {
    let spacing = |speeds: &[f64]| {
        let least = speeds.iter().copied().fold(f64::MAX, f64::min);
        let mean = speeds.iter().sum::<f64>() / speeds.len() as f64;
        (1.0 - mean_share) * least + mean_share * mean
    };
    let mut knots = vec![0.0];
    let mut u = 0.0;
    let mut ahead = [0.0_f64; AROUND];
    let mut few = [Jet::default(); FEW];
    let mut all = [Jet::default(); AROUND];
    let mut unevenness = 0.0;
    let mut farthest = Vec::new();
    while u < 1.0 {
        // A few looks lead to the middle of the row, where all are taken.
        surface.ring(inside(u), 0.0, &mut few);
        let middle = (u + 0.5 * height / spacing(&few.each_ref().map(row_speed))).min(1.0);
        surface.ring(inside(middle), 0.0, &mut all);
        let speeds = all.each_ref().map(row_speed);
        let spacing = spacing(&speeds);
        let step = height / spacing;
        if !step.is_finite() || step <= 0.0 || knots.len() > MAX_ROWS {
            return None;
        }
        u += step.min(1.0);
        let [least, most] = [f64::min, f64::max].map(|of| speeds.iter().copied().reduce(of).unwrap_or(1.0));
        unevenness += most / least;
        farthest.push((most / spacing) as f32);
        for (ahead, speed) in ahead.iter_mut().zip(speeds) {
            *ahead = (*ahead + 1.0 - speed / spacing).max(0.0);
        }
        knots.push(u);
    }
    let unevenness = unevenness / (knots.len() - 1) as f64;
    Some(Table { knots, ahead: ahead.into_iter().fold(0.0, f64::max), unevenness, farthest })
}
