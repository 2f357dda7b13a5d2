//! Why a machine cannot knit a part, told at its round and stitch with the limit that stands in the way.

use super::begin::Source;
use super::emit::Origin;
use super::tube::Stuck;
use crate::diag::{Code as Finding, Diagnostic, Sink};
use crate::ir::machine::Machine;
use crate::ir::{PartId, Pattern};

/// Why a part cannot be knit.
#[derive(Debug)]
pub(super) enum Reason {
    /// The sink has it.
    Told,
    Stuck(Stuck),
    /// This many needles on each bed are needed.
    Wide(i32),
    /// A tube of this many loops.
    Loops(u32),
    Shapings(u32),
    Depth(u32),
    /// A color beyond the carriers, counted from 1.
    Colors(u32),
    /// The loops do not wait on their needles.
    NotWaiting(Source),
    /// The yarn would lie across waiting loops of this part.
    Across(PartId),
    /// Loops of this part wait between two that are to be joined.
    Between(PartId),
    ThreeLimbs,
    /// A flat piece on loops of another part.
    FlatJoin,
    /// Chains with nothing before them.
    NoLoopBefore,
    /// Every loop is set aside.
    NothingLeft,
}

impl From<Stuck> for Reason {
    fn from(stuck: Stuck) -> Self {
        Self::Stuck(stuck)
    }
}

/// Tells the reason; `part` is the place of the part.
pub(super) fn refuse(
    reason: &Reason,
    origin: Origin,
    pattern: &Pattern,
    machine: &Machine,
    sink: &mut Sink<'_>,
) {
    let name = &machine.name;
    let [first, last] = machine.bed.needles;
    let limit = |field: &str, value: u32| format!("`{field}` of `{name}` is {value}");
    let (finding, message, help) = match *reason {
        Reason::Told => return,
        Reason::Stuck(Stuck::Narrow) => (
            Finding::BeyondMachine,
            "the tube is too narrow to lie on two beds".to_owned(),
            "4 loops are the least; close the tube earlier".to_owned(),
        ),
        Reason::Stuck(Stuck::Stack(loops, _)) => (
            Finding::BeyondMachine,
            format!("a needle would hold {loops} loops"),
            format!(
                "{}; a plain round between decreases helps",
                limit("limits.loops_per_needle", machine.limits.loops_per_needle)
            ),
        ),
        Reason::Stuck(Stuck::Underflow) => (
            Finding::BrokenProgram,
            "the row works loops that are not there".to_owned(),
            "check the pattern first".to_owned(),
        ),
        Reason::Stuck(Stuck::Packed) => (
            Finding::BeyondMachine,
            "loops of a tube on all needles cannot change their needle".to_owned(),
            format!(
                "`bed.half_gauge` and `bed.sliders` of `{name}` are false: plain tubes can be knit, which end on waste \
                 yarn (`waste.rows`) or drawn shut over at most {} loops; flat pieces can be shaped",
                super::bind_off::FLAT
            ),
        ),
        Reason::Wide(needles) => (
            Finding::BeyondMachine,
            format!("{needles} needles are needed; `{name}` has {}", last - first + 1),
            format!(
                "`bed.needles` is {first} to {last}: the widest round this machine can hold is about {}; \
                 use coarser stitches, or split the tube",
                last - first
            ),
        ),
        Reason::Loops(loops) => (
            Finding::BeyondMachine,
            format!("the round has {loops} loops"),
            format!(
                "{}, the widest round this machine can hold; use coarser stitches, or split the tube",
                limit("tube.max_loops", machine.tube.max_loops)
            ),
        ),
        Reason::Shapings(count) => (
            Finding::BeyondMachine,
            format!("the course has {count} increases and decreases or more"),
            limit("limits.shapings_per_course", machine.limits.shapings_per_course),
        ),
        Reason::Depth(courses) => (
            Finding::BeyondMachine,
            format!("needles wait while others knit {courses} courses"),
            limit("limits.short_row_depth", machine.limits.short_row_depth),
        ),
        Reason::Colors(color) => (
            Finding::TooFewCarriers,
            format!("color {color} has no carrier"),
            format!(
                "`carriers.names` of `{name}` leaves {} for pieces; use fewer colors",
                super::yarns::palette(machine).len()
            ),
        ),
        Reason::NotWaiting(_)
        | Reason::Across(_)
        | Reason::Between(_)
        | Reason::FlatJoin
        | Reason::NoLoopBefore
        | Reason::ThreeLimbs
        | Reason::NothingLeft => limbs(reason, pattern, name),
    };
    let Origin { round, stitch, .. } = origin;
    let at = if stitch > 0 { format!(" at stitch {stitch}") } else { String::new() };
    let name = pattern.parts.get(origin.part as usize).map_or("", |part| part.name.as_str());
    sink.push(Diagnostic::new(finding, format!("{message}{at}")).in_round(name, Some(round)).help(help));
}

/// What limbs and flat pieces come to grief on.
fn limbs(reason: &Reason, pattern: &Pattern, name: &str) -> (Finding, String, String) {
    let part = |id: PartId| pattern.parts.get(id.0 as usize).map_or("?", |part| part.name.as_str());
    match *reason {
        Reason::NotWaiting(source) => (
            Finding::LimbsInTheWay,
            match source {
                Source::Held(from, loops) => {
                    format!("{loops} loops of {} do not wait together", part(from))
                }
                Source::Open(from) => {
                    format!("the loops of {} do not wait on their needles", part(from))
                }
                Source::Chain(_) => "the chain is not there".to_owned(),
            },
            "take the loops as they were set aside, one stretch for each `hold`".to_owned(),
        ),
        Reason::Across(from) => (
            Finding::LimbsInTheWay,
            format!("the yarn would lie across open loops of {}", part(from)),
            format!(
                "`entry.bring_in` of `{name}` is gripper: work the limb nearest to the carriers first, and end it before the next"
            ),
        ),
        Reason::Between(from) => (
            Finding::LimbsInTheWay,
            format!("loops of {} hang between the two that are joined", part(from)),
            "join parts that were made one after the other".to_owned(),
        ),
        Reason::FlatJoin => (
            Finding::NotKnittable,
            "a flat piece on loops of another part cannot be knit".to_owned(),
            "loops of a tube hang on both beds; work the part in the round".to_owned(),
        ),
        Reason::NoLoopBefore => (
            Finding::NotKnittable,
            "chains at the beginning of the part cannot be knit".to_owned(),
            "begin the part with more chains, or with a stitch".to_owned(),
        ),
        Reason::NothingLeft => (
            Finding::NotKnittable,
            "every loop of the part is set aside, and none stays on the yarn".to_owned(),
            "let the part go on as one of those that it is set aside for".to_owned(),
        ),
        Reason::ThreeLimbs => (
            Finding::LimbsInTheWay,
            "more than two stretches of loops are joined to one tube".to_owned(),
            "on two beds only two tubes lie side by side around one round; join them two by two".to_owned(),
        ),
        Reason::Told
        | Reason::Stuck(_)
        | Reason::Wide(_)
        | Reason::Loops(_)
        | Reason::Shapings(_)
        | Reason::Depth(_)
        | Reason::Colors(_) => (
            Finding::BeyondMachine,
            "the part cannot be knit".to_owned(),
            "check the pattern first".to_owned(),
        ),
    }
}
