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
mod rows;
mod score;
mod seam;
mod sheet;
mod short_rows;
mod site;
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
use crate::ir::maker::mirrored;
use crate::ir::{Gauge, Graph, Hand, MAX_LOOPS};
use crate::shape::{Attachment, End, Joint, ParametricSurface, Tube, area, for_maker, is_revolution};
use glam::DVec3;
use patches::Patches;
use rows::Rows;
use seam::Turned;
use sheet::Sheet;
use site::{Laid, Site};
use std::borrow::Cow;
use stout::Stout;
use tries::Part;

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
    let on_patches = patches.is_some();
    let site = Site {
        turned: &turned,
        exact,
        outside,
        on_patches,
        ends,
        rows: &rows,
        leads,
        gauge,
        slit,
        first,
        expected,
    };
    // What is to be seen as it was laid stays so.
    let mends = !options.paper && options.sweeps > 0;
    let close = stout.is_some() || rows.is_harsh();
    let laid = if even { site.lay_evenly(&options.hurried(), sink) } else { None };
    let laid = laid.or_else(|| {
        let part = Part { expected, given: first.is_some(), harsh: rows.is_harsh() };
        let uneven = slit || first.is_some() || options.paper;
        let lay_evenly = |sink: &Sink<'_>| if uneven { None } else { site.lay_evenly(options, sink) };
        let mend = |laid: &mut Laid| {
            if mends {
                site.untangle(laid, close);
            }
        };
        let weave = |options: &Options, turn, judge, sink: &Sink<'_>| site.weave(options, turn, judge, sink);
        tries::best(options, part, sink, weave, mend, lay_evenly)
    });
    let Some(mut laid) = laid else {
        if options.preset == Preset::Fast {
            return lay_on(outside, tube, loops, gauge, &options.unhurried(), even, sink);
        }
        let message =
            "the rows run away: this surface folds over itself, or changes faster than stitches follow";
        return fail(sink, Code::SurfaceBroken, message.into(), GENTLER);
    };
    if mends {
        let [before, after] = site.untangle(&mut laid, close);
        if even && before > 0 && (after > 0 || !tries::is_sound(&laid.sheet)) {
            return lay_on(outside, tube, loops, gauge, options, false, sink);
        }
    }
    let Laid { sheet, start, turn, lifted, .. } = laid;
    if let Some((code, message, help)) = fault(&sheet, gauge) {
        return fail(sink, code, message, help);
    }
    tell_wider(stout.as_ref(), gauge, &tube.name, sink);
    Some(finish::graph(sheet, lifted.as_ref().unwrap_or(&rows), start, site.poles(), turn))
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
