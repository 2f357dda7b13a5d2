//! From a surface to a stitch graph: rows, first row, shaping, short rows and relaxation.
//!
//! The tube is covered by one helix (paper, section 3.2): row `tau` of the helix lies at u = U(tau), and H(tau) = S(U(tau),
//! frac tau). Nodes are open loops. Surfaces of revolution get clean repeats (`symmetric`); all others are woven
//! row by row (`weave`). In the end all nodes settle on the surface (`relax`).

mod batch;
pub mod capunaman;
mod even;
mod finish;
mod first_row;
mod marker;
mod options;
mod paper;
mod patches;
mod relax;
mod ridges;
mod rows;
mod score;
mod seam;
mod sheet;
mod short_rows;
mod stacked;
mod staircase;
mod stout;
mod symmetric;
mod top;
mod tries;
mod untangle;
mod weave;

pub use options::{Options, Preset};

use crate::diag::{Code, Diagnostic, Sink};
use crate::ir::increases::Increases;
use crate::ir::maker::mirrored;
use crate::ir::{Gauge, Graph, Hand, MAX_LOOPS};
use crate::shape::{Attachment, End, Joint, ParametricSurface, Tube, area, for_maker, is_revolution};
use glam::DVec3;
use patches::Patches;
use relax::{Brink, Effort, Ends, Firm, Mark, Relaxer, Stretch};
use rows::Rows;
use seam::Turned;
use sheet::{Foot, Sheet};
use std::borrow::Cow;
use stout::Stout;
use tries::{Judge, Part};
use untangle::Untangler;
use weave::{Outcome, Weaver};

/// Nodes may slide this far over an open end while they settle.
const OVERHANG: [f64; 2] = [-0.02, 1.06];
/// At a pole they keep this share of the first row's distance.
const POLE_DISTANCE: f64 = 0.3;

/// Factor of the weight of square tiles in even rounds without and with one or two open ends: there lengths can give.
const EVEN_SQUARENESS: [f64; 3] = [0.9, 1.0, 1.1];
/// Rows by which a given first row counts as higher, for each turn that a try would turn another one by.
const LIFT: f64 = 1.0;

/// Drift, in turns, that is worth a word.
const MUCH_DRIFT: f64 = 0.75;

const GENTLER: &str = "bend the curve less, or make the sections change more gently";

/// The stitch graph of one tube; `None` with the reason in the sink when it cannot be made.
///
/// Equal input gives the same graph, bit for bit.
pub fn generate(tube: &Tube, gauge: &Gauge, options: &Options, sink: &mut Sink<'_>) -> Option<Graph> {
    lay(tube, None, gauge, options, sink)
}

/// The stitch graph of a tube whose first row is given: loops of another part beside its start, in working order (mm).
pub fn generate_on(
    tube: &Tube,
    loops: &[DVec3],
    gauge: &Gauge,
    options: &Options,
    sink: &mut Sink<'_>,
) -> Option<Graph> {
    lay(tube, Some(loops), gauge, options, sink)
}

fn lay(
    tube: &Tube,
    loops: Option<&[DVec3]>,
    gauge: &Gauge,
    options: &Options,
    sink: &mut Sink<'_>,
) -> Option<Graph> {
    if let Some((name, right)) = options.fault() {
        let message = format!("the option `{name}` is out of range");
        let diagnostic = Diagnostic::new(Code::OptionOutOfRange, message).in_round(&tube.name, None);
        sink.push(diagnostic.help(format!("give it a value {right}")));
        return None;
    }
    let options = &options.resolved();
    // What the left hand works comes out mirrored, so its pattern is made for the mirror image.
    let hand = options.maker().hand;
    let loops: Option<Cow<'_, [DVec3]>> = match hand {
        Hand::Right => loops.map(Cow::Borrowed),
        Hand::Left => loops.map(|loops| loops.iter().copied().map(mirrored).collect()),
    };
    // What leans twists as it is worked, so its pattern is made for the shape twisted the other way.
    let graph = for_maker(&*tube.surface, gauge, options.maker(), |target, drift| {
        if let Some(drift) = drift {
            warn_of(drift.turns(1.0), &tube.name, sink);
        }
        let even = options.symmetric && loops.is_none() && !begins_in_slit(tube) && is_revolution(target);
        let graph = lay_on(target, tube, loops.as_deref(), gauge, options, even, sink)?;
        Some(match drift {
            Some(drift) => drift.come_out(graph),
            None => graph,
        })
    })?;
    Some(match hand {
        Hand::Right => graph,
        Hand::Left => graph.mirrored(),
    })
}

/// A branch in a slit begins at an end of it, with as many loops below as above.
fn begins_in_slit(tube: &Tube) -> bool {
    matches!(tube.attachment, Some(Attachment { joint: Joint::Opening, .. }))
}

/// Lays the stitches of a tube on `exact`: its surface, or what becomes of that for this maker; in `even` repeats if may be.
fn lay_on(
    exact: &dyn ParametricSurface,
    tube: &Tube,
    loops: Option<&[DVec3]>,
    gauge: &Gauge,
    options: &Options,
    even: bool,
    sink: &mut Sink<'_>,
) -> Option<Graph> {
    let fail = |sink: &mut Sink<'_>, code, message: String, help: &str| {
        sink.push(Diagnostic::new(code, message).in_round(&tube.name, None).help(help));
        None
    };
    let slit = begins_in_slit(tube);
    let ends = [tube.start, tube.end];
    let look_up = |surface| if even { None } else { looked_up(surface, ends, gauge, options) };
    let patches = look_up(exact);
    let stout = if options.paper {
        None
    } else {
        Stout::new(exact, patches.as_ref().map(|patches| patches.thinnest), gauge)
    };
    let outside = exact;
    let (exact, patches) = match &stout {
        Some(stout) => {
            let stout: &dyn ParametricSurface = stout;
            (stout, look_up(stout))
        }
        None => (exact, patches),
    };
    let picked_up = loops.map(|loops| first_row::picked_up(exact, loops));
    let target = patches.as_ref().map_or(exact, |patches| patches as &dyn ParametricSurface);
    let by = picked_up.as_ref().map(|(by, _)| *by);
    let turned = begin(target, exact, by, slit, options.maker().hand);
    let fixed = slit || picked_up.is_some();
    let first = picked_up.as_ref().map(|(_, feet)| feet.as_slice());
    let surface: &dyn ParametricSurface = &turned;
    let expected = area(surface, 4, 16) / (gauge.width * gauge.height);
    if let Err((code, message, help)) = fits(expected) {
        return fail(sink, code, message, help);
    }
    sink.stage("rows");
    let mut leads = ends.map(rows::lead);
    if let Some(feet) = first {
        leads[0] = first_row::lead(surface, feet, gauge.height);
    }
    let Some(rows) = Rows::new(surface, leads, gauge) else {
        let message = format!("a stitch of {:.2} mm height is too high for this tube", gauge.height);
        return fail(sink, Code::TooFewRows, message, "use a smaller stitch or a longer shape");
    };
    sink.stage("stitches");
    let most = (3.0 * expected) as usize + 10_000;
    let even_rounds = |options: &Options, sink: &Sink<'_>| {
        let lifted = rows.of_even(ends);
        let ground = Ground::new(surface, ends, lifted.as_ref().unwrap_or(&rows), gauge, options);
        let (mut sheet, start) = ground.lay_evenly(sink)?;
        if patches.is_some() {
            sheet.put_on(exact, turned.by);
        }
        Some(Laid { sheet, start, spread: 0.0, turn: turned.by, lifted })
    };
    let laid = if even { even_rounds(&options.hurried(), sink) } else { None };
    let laid = laid.or_else(|| {
        let part = Part { expected, given: first.is_some(), harsh: rows.is_harsh() };
        let lay = |options: &Options, turn: f64, judge: Judge, sink: &Sink<'_>| {
            // Where the place of the first row is given, its height is varied.
            let lifted = first.and_then(|_| Rows::new(surface, [leads[0] + LIFT * turn, leads[1]], gauge));
            let turned = Turned { surface: turned.surface, by: turned.by + if fixed { 0.0 } else { turn } };
            let rows = lifted.as_ref().unwrap_or(&rows);
            let mut ground = Ground {
                slit,
                first,
                expected: expected as usize,
                ..Ground::new(&turned, ends, rows, gauge, options)
            };
            for foot in first.unwrap_or_default() {
                ground.range[0] = ground.range[0].min(foot.u);
            }
            let (mut sheet, start, spread) = ground.weave(most, judge, sink)?;
            // In a hurry they stay on the patches.
            if options.preset == Preset::Std {
                sheet.put_on(exact, turned.by);
            }
            Some(Laid { sheet, start, spread, turn: turned.by, lifted })
        };
        let even = |sink: &Sink<'_>| if fixed || options.paper { None } else { even_rounds(options, sink) };
        tries::best(options, part, sink, lay, even)
    });
    let Some(Laid { mut sheet, start, turn, lifted, .. }) = laid else {
        if options.preset == Preset::Fast {
            return lay_on(outside, tube, loops, gauge, &options.unhurried(), even, sink);
        }
        let message =
            "the rows run away: this surface folds over itself, or changes faster than stitches follow";
        return fail(sink, Code::SurfaceBroken, message.into(), GENTLER);
    };
    let Ground { poles, mut range, .. } = Ground::new(surface, ends, &rows, gauge, options);
    range[0] = first.unwrap_or_default().iter().fold(range[0], |least, foot| least.min(foot.u));
    // What is to be seen as it was laid stays so.
    if !options.paper && options.sweeps > 0 {
        let close = stout.is_some() || rows.is_harsh();
        let untangler = Untangler { on: exact, outside, turn, range, start, pole: poles[0], close };
        let [before, after] = untangler.untangle(&mut sheet);
        if even && before > 0 && (after > 0 || !tries::is_sound(&sheet)) {
            return lay_on(outside, tube, loops, gauge, options, false, sink);
        }
    }
    if let Some((code, message, help)) = fault(&sheet, gauge) {
        return fail(sink, code, message, help);
    }
    tell_wider(stout.as_ref(), gauge, &tube.name, sink);
    Some(finish::graph(&sheet, lifted.as_ref().unwrap_or(&rows), start, poles, turn))
}

/// Where around the tube the helix begins: `by` where its first row is picked up.
fn begin<'s>(
    target: &'s dyn ParametricSurface,
    exact: &dyn ParametricSurface,
    by: Option<f64>,
    slit: bool,
    hand: Hand,
) -> Turned<'s> {
    match (by, hand) {
        (Some(by), _) => Turned { surface: target, by },
        (None, Hand::Right) if slit => Turned { surface: target, by: 0.0 },
        // Rounds of the left hand come to the other end of the slit first.
        (None, Hand::Left) if slit => Turned { surface: target, by: first_row::opposite(exact) },
        (None, _) => Turned::to_slowest_side(target),
    }
}

/// What is wrong with a finished sheet, and what to say.
fn fault(sheet: &Sheet, gauge: &Gauge) -> Option<(Code, String, &'static str)> {
    if sheet.main.is_empty() {
        let message =
            format!("a stitch of {:.2} mm height leaves no round to work on this tube", gauge.height);
        return Some((Code::TooFewRows, message, "use a smaller stitch or a longer shape"));
    }
    let ran_off = sheet.point.iter().any(|p| !p.is_finite());
    ran_off.then(|| (Code::SurfaceBroken, "stitches ran off this surface".into(), GENTLER))
}

/// Whether so many stitches can be laid; else what to say.
fn fits(expected: f64) -> Result<(), (Code, String, &'static str)> {
    if !expected.is_finite() {
        let help = "look for control points or sections that are far too large, or no numbers";
        return Err((Code::SurfaceBroken, "the surface has no finite area".into(), help));
    }
    if expected > f64::from(MAX_LOOPS) {
        let message =
            format!("this takes about {expected:.0} stitches, more than the {MAX_LOOPS} that Picot handles");
        return Err((Code::TooLarge, message, "use a larger stitch, or check the unit of the file"));
    }
    Ok(())
}

/// What the general generator looks up instead of a surface; `None` where the surface itself is as quick, or asked for.
fn looked_up<'s>(
    surface: &'s dyn ParametricSurface,
    ends: [End; 2],
    gauge: &Gauge,
    options: &Options,
) -> Option<Patches<'s>> {
    let stitches = if options.preset == Preset::Fast { patches::LARGE } else { patches::USUAL };
    if options.paper { None } else { Patches::new(surface, ends, gauge, stitches) }
}

/// Warns of a drift that no one would have overlooked.
fn warn_of(turns: f64, part: &str, sink: &mut Sink<'_>) {
    if turns.abs() > MUCH_DRIFT {
        let message = format!("stitches that lean so turn {part} by {turns:.2} of a turn");
        let help = "work 20 rounds of a tube, and see by how many stitches a column has moved: `lean` is a twentieth of it";
        sink.push(Diagnostic::new(Code::MuchLean, message).in_round(part, None).help(help));
    }
}

/// Tells of a stretch that comes out thicker than it is.
fn tell_wider(stout: Option<&Stout<'_>>, gauge: &Gauge, part: &str, sink: &mut Sink<'_>) {
    let Some((length, most)) = stout.and_then(|stout| stout.wider(gauge)) else { return };
    let message = format!(
        "{length:.0} mm of {part} are thinner than {} stitches around, and made up to {most:.1} times as thick",
        stout::LEAST_LOOPS
    );
    let help = "use a smaller stitch or a thicker tube there, if it shall keep its proportions";
    sink.push(Diagnostic::new(Code::MadeThicker, message).in_round(part, None).help(help));
}

/// A finished sheet, the stitches of its first row, and where around the tube the helix began.
struct Laid {
    sheet: Sheet,
    start: usize,
    /// Rows between the highest and the lowest loop of the last turn.
    spread: f64,
    turn: f64,
    /// Other rows than planned.
    lifted: Option<Rows>,
}

impl Laid {
    fn increases(&self) -> Increases {
        finish::increases(&self.sheet, self.start)
    }
}

/// What all ways of laying stitches share.
struct Ground<'s> {
    surface: &'s dyn ParametricSurface,
    rows: &'s Rows,
    gauge: &'s Gauge,
    options: &'s Options,
    /// The points at the closed ends.
    poles: [Option<DVec3>; 2],
    /// Least and greatest u of a node.
    range: [f64; 2],
    /// The first row is worked into a slit.
    slit: bool,
    /// The first row, where it is picked up.
    first: Option<&'s [Foot]>,
    /// About how many stitches there will be.
    expected: usize,
}

impl<'s> Ground<'s> {
    fn new(
        surface: &'s dyn ParametricSurface,
        ends: [End; 2],
        rows: &'s Rows,
        gauge: &'s Gauge,
        options: &'s Options,
    ) -> Self {
        let pole = |end: End, u: f64| (end == End::Closed).then(|| surface.point(u, 0.0));
        let poles = [pole(ends[0], 0.0), pole(ends[1], 1.0)];
        let limit = |end: End, open: f64, row: f64, pole: f64| {
            if end == End::Closed { pole + POLE_DISTANCE * (row - pole) } else { open }
        };
        let range = [
            limit(ends[0], OVERHANG[0], rows.at(0.0), 0.0),
            limit(ends[1], OVERHANG[1], rows.at(rows.count), 1.0),
        ];
        Self { surface, rows, gauge, options, poles, range, slit: false, first: None, expected: 0 }
    }

    /// Even repeats on a surface of revolution, settled; with the stitches of the first row. `None` elsewhere.
    fn lay_evenly(&self, sink: &Sink<'_>) -> Option<(Sheet, usize)> {
        let Self { surface, rows, options, .. } = *self;
        let rounds = rows.count as u32;
        let girths: Vec<f64> =
            (0..rounds).map(|k| first_row::turn_length(surface, rows, k) / self.gauge.width).collect();
        let ring = self.poles[0].map(|_| first_row::ring_size(surface, rows, self.gauge));
        let counts = symmetric::plan_counts(&girths, ring, options.ease())?;
        let start = counts[0] as usize;
        let mut sheet = Sheet::new(self.gauge, counts.iter().map(|count| *count as usize).sum());
        first_row::lay(surface, &mut sheet, first_row::centered_places(counts[0]), rows);
        symmetric::lay_rounds(surface, &mut sheet, rows, &counts, |done| {
            sink.step(u64::from(done), u64::from(rounds));
        });
        let free = if self.poles[0].is_some() { 0 } else { start };
        let top = sheet.len() - counts[counts.len() - 1] as usize;
        let square = EVEN_SQUARENESS[self.poles.iter().filter(|pole| pole.is_none()).count()];
        let all = Stretch::since(Mark { nodes: free, ..Mark::default() }, &sheet);
        Relaxer::default().relax(
            surface,
            &mut sheet,
            all,
            0,
            Effort { sweeps: options.sweeps_over(all.until.nodes), squareness: options.squareness * square },
            Ends {
                range: self.range,
                ring: self.poles[0].map(|pole| (pole, start)),
                level: Some(Brink { rows, lag: 0.0, top, firm: Firm::No, tail: true }),
                opens: false,
            },
        );
        Some((sheet, start))
    }

    /// Row by row, for any surface; with the stitches of the first row, and the rows between the highest and the lowest loop
    /// of the last turn. `None` when the rows run away.
    fn weave(&self, most: usize, judge: Judge, sink: &Sink<'_>) -> Option<(Sheet, usize, f64)> {
        let Self { surface, rows, options, .. } = *self;
        let mut sheet = Sheet::new(self.gauge, self.expected);
        if let Some(first) = self.first {
            first_row::lay_picked_up(&mut sheet, first);
        } else if self.poles[0].is_some() {
            let ring = first_row::ring_size(surface, rows, self.gauge);
            first_row::lay(surface, &mut sheet, first_row::centered_places(ring), rows);
        } else {
            let places =
                first_row::even_places(surface, rows, self.gauge.width, if self.slit { 2 } else { 1 });
            first_row::lay(surface, &mut sheet, places.into_iter(), rows);
        }
        let start = sheet.len();
        let mut weaver = Weaver::new(surface, rows, options, sheet, self.poles, self.range, most);
        match weaver.run(judge, |done, total| sink.step(done, total)) {
            Outcome::Done => {
                let spread = weaver.spread();
                Some((weaver.sheet, start, spread))
            }
            Outcome::Runaway | Outcome::Outdone => None,
        }
    }
}
