//! The parameter along a surface: from u in [0, 1] to the parameter of its curve, even where the curve is not.

use super::bezier::integrate;
use std::ops::Range;

/// A monotone map from the surface parameter to the curve parameter.
#[derive(Clone, Debug)]
pub(super) struct Meridian {
    body: Range<f64>,
    /// Empty for a linear map of the body.
    cells: Vec<Cell>,
    /// First cell of equal shares of u.
    index: Vec<u32>,
}

/// A stretch of the map. With x in [0, 1] along it: a cubic, or at an end where the meridian's speed is a power of the
/// distance, the root that makes it even.
#[derive(Clone, Copy, Debug)]
struct Cell {
    start: f64,
    inverse: f64,
    from: f64,
    width: f64,
    form: Form,
}

#[derive(Clone, Copy, Debug)]
enum Form {
    Cubic([f64; 3]),
    /// `x^power (1 + mend (x - 1))`, seen from the start or, mirrored, from the end.
    Root {
        power: f64,
        mend: f64,
        mirrored: bool,
    },
}

/// Where a root with infinite slope is taken instead of at its very end, in its cell.
const ROOT_FLOOR: f64 = 1e-6;
/// Ratio of meridian speeds that a single segment may have before it is made even.
const UNEVEN: f64 = 8.0;

impl Meridian {
    /// The map for a meridian with speed `pace(w)` (mm a unit of the curve parameter), smooth between `breaks`,
    /// with `caps` (mm) before and after the curve. A single segment (`plain`) of moderate speeds keeps its parameter.
    pub(super) fn new(breaks: &[f64], plain: bool, caps: [f64; 2], pace: impl Fn(f64) -> f64) -> Self {
        let linear = Self { body: 0.0..1.0, cells: Vec::new(), index: Vec::new() };
        let panels = breaks.len().saturating_sub(1);
        if panels == 0 {
            return linear;
        }
        let first = exponent(|x| pace(breaks[0] + x * (breaks[1] - breaks[0])));
        let last = exponent(|x| pace(breaks[panels] - x * (breaks[panels] - breaks[panels - 1])));
        if plain && caps == [0.0; 2] && first == 1.0 && last == 1.0 {
            let samples = breaks.windows(2).flat_map(|pair| {
                (0..16).map(|k| pair[0] + (pair[1] - pair[0]) * (f64::from(k) + 0.5) / 16.0).map(&pace)
            });
            let (low, high) =
                samples.fold((f64::INFINITY, 0.0_f64), |(low, high), p| (low.min(p), high.max(p)));
            if high <= UNEVEN * low {
                return linear;
            }
        }
        let steps = (96 / panels).clamp(4, 24);
        let mut cells = Vec::with_capacity(panels * steps);
        let mut at = caps[0];
        for panel in 0..panels {
            let (low, high) = (breaks[panel], breaks[panel + 1]);
            let width = high - low;
            let start = if panel == 0 { first } else { 1.0 };
            let end = if panel + 1 == panels { last } else { 1.0 };
            let inside = |x: f64| pace(low + width * x.clamp(1e-9, 1.0 - 1e-9)).max(1e-12);
            let node = |k: usize| {
                let x = k as f64 / steps as f64;
                match (start == 1.0, end == 1.0) {
                    (true, true) => x,
                    (false, true) => x * x,
                    (true, false) => 1.0 - (1.0 - x) * (1.0 - x),
                    (false, false) => x * x * (3.0 - 2.0 * x),
                }
            };
            for k in 0..steps {
                let (a, b) = (node(k), node(k + 1));
                let root = |power: f64, mirrored: bool| {
                    let size = width
                        * integrate(0.0, 1.0, |x| {
                            let (x, rate) = (
                                (b - a) * crate::math::pow(x, power),
                                power * crate::math::pow(x, power - 1.0),
                            );
                            inside(if mirrored { b - x } else { a + x }) * rate * (b - a)
                        });
                    let slope = size / (inside(if mirrored { a } else { b }) * width * (b - a));
                    (size, Form::Root { power, mend: (slope - power).clamp(-0.9, 0.9), mirrored })
                };
                let (size, form) = if k == 0 && start != 1.0 {
                    root(start, false)
                } else if k + 1 == steps && end != 1.0 {
                    root(end, true)
                } else {
                    let size = width * integrate(a, b, inside);
                    let slope = |x: f64| (size / (inside(x) * width * (b - a))).min(3.0);
                    let (p, q) = (slope(a), slope(b));
                    (size, Form::Cubic([p, 3.0 - 2.0 * p - q, p + q - 2.0]))
                };
                cells.push(Cell {
                    start: at,
                    inverse: size,
                    from: low + width * a,
                    width: width * (b - a),
                    form,
                });
                at += size;
            }
        }
        let total = at + caps[1];
        if !(total.is_finite() && total > 0.0) {
            return linear;
        }
        for cell in &mut cells {
            cell.start /= total;
            cell.inverse = total / cell.inverse;
        }
        let buckets = 2 * cells.len();
        let index = (0..buckets)
            .map(|b| {
                let u = b as f64 / buckets as f64;
                (cells.partition_point(|cell| cell.start <= u).max(1) - 1) as u32
            })
            .collect();
        let body = caps[0] / total..(at / total).min(1.0);
        let body = if caps[1] == 0.0 { body.start..1.0 } else { body };
        Self { body, cells, index }
    }

    /// The part of [0, 1] that belongs to the curve.
    pub(super) fn body(&self) -> Range<f64> {
        self.body.clone()
    }

    /// Curve parameter at `u` and its derivative by u.
    #[inline]
    pub(super) fn eval(&self, u: f64) -> (f64, f64) {
        if self.cells.is_empty() {
            return (u.clamp(0.0, 1.0), 1.0);
        }
        let bucket = ((u * self.index.len() as f64) as usize).min(self.index.len() - 1);
        let mut k = self.index[bucket] as usize;
        while k + 1 < self.cells.len() && self.cells[k + 1].start <= u {
            k += 1;
        }
        let cell = &self.cells[k];
        let x = ((u - cell.start) * cell.inverse).clamp(0.0, 1.0);
        let (value, slope) = match cell.form {
            Form::Cubic([a, b, c]) => (x * (a + x * (b + x * c)), a + x * (2.0 * b + x * 3.0 * c)),
            Form::Root { power, mend, mirrored } => {
                let x = if mirrored { 1.0 - x } else { x };
                let x = if power < 1.0 { x.max(ROOT_FLOOR) } else { x };
                let (root, rate) = match power {
                    2.0 => (x * x, 2.0 * x),
                    0.5 => (x.sqrt(), 0.5 / x.sqrt()),
                    _ => (crate::math::pow(x, power), power * crate::math::pow(x, power - 1.0)),
                };
                let factor = 1.0 + mend * (x - 1.0);
                let (value, slope) = (root * factor, rate * factor + root * mend);
                (if mirrored { 1.0 - value } else { value }, slope)
            }
        };
        (cell.from + cell.width * value, cell.width * slope * cell.inverse)
    }

    /// The u at which the map reaches curve parameter `w`.
    pub(super) fn invert(&self, w: f64) -> f64 {
        if self.cells.is_empty() {
            return w.clamp(0.0, 1.0);
        }
        let (mut low, mut high) = (self.body.start, self.body.end);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.eval(middle).0 < w {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }
}

/// The power p for which w = x^p makes a meridian even whose speed near 0 is like a power of the distance.
fn exponent(pace: impl Fn(f64) -> f64) -> f64 {
    let ratio = pace(1e-4) / pace(1e-8);
    match ratio {
        r if r < 0.1 => 2.0,
        r if r > 3e6 => 1.0 / 3.0,
        r if r > 30.0 => 0.5,
        _ => 1.0,
    }
}
