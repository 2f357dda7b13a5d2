//! From rows to legs: what the needles have to do, and which stitches have no counterpart in knitting.

use super::Options;
use crate::diag::{Code as Finding, Diagnostic, Sink};
use crate::ir::{Direction, Entry, Kind, Part, Row, Start, Step, Stitch};

/// A run of stitches between two turns.
#[derive(Clone, Debug, PartialEq)]
pub struct Leg {
    /// Direction of work.
    pub direction: Direction,
    /// The stitches in working order.
    pub actions: Vec<Action>,
}

/// One stitch as the needles see it: loops that come together, and loops that are made of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Action {
    /// Loops worked together; at least 1.
    pub works: u16,
    /// Loops made; at least 1.
    pub makes: u16,
}

/// The plain stitch.
pub const PLAIN: Action = Action { works: 1, makes: 1 };

/// One row, ready to be knit.
#[derive(Clone, Debug, PartialEq)]
pub struct RowPlan {
    /// Its legs; the first and the last are worked forward.
    pub legs: Vec<Leg>,
    /// Plain rounds to be knit after it, which stand for the height of tall stitches.
    pub plain_rounds: u32,
}

/// Loops of the cast-on, and how many rows of the part it already stands for.
pub fn cast_on(part: &Part) -> (u32, usize) {
    let first_makes = || {
        let steps = part.rows.first().map(|row| row.body.steps());
        steps.into_iter().flatten().fold(0_u32, |sum, step| match step {
            Step::Work(stitch) => sum.saturating_add(u32::from(stitch.makes)),
            Step::Turn(_) | Step::Hold { .. } | Step::Leave { .. } | Step::Color(_) => sum,
        })
    };
    match part.start.loops() {
        0 if !matches!(part.start, Start::Join { .. }) => (first_makes(), 1),
        loops => (loops, 0),
    }
}

/// Plans one row. `None` with the reason in the sink when a stitch has no counterpart.
pub fn row(part: &Part, row: &Row, number: u32, options: &Options, sink: &mut Sink<'_>) -> Option<RowPlan> {
    let mut planner = Planner { part, number, options, sink, refused: false, stitch: 0 };
    let mut legs = vec![Leg { direction: Direction::Forward, actions: Vec::new() }];
    let mut height = Height::default();
    for step in row.body.steps() {
        planner.stitch += u32::from(matches!(step, Step::Work(_)));
        match step {
            Step::Work(stitch) => planner.work(stitch, &mut legs, &mut height),
            Step::Turn(direction) => legs.push(Leg { direction, actions: Vec::new() }),
            Step::Hold { .. } => planner.refuse("loops set aside for another part", ""),
            // They stay open on their needles, and the next row begins with them.
            Step::Leave { .. } => {}
            Step::Color(_) => planner.approximate("a change of color", "one color is knit throughout"),
        }
        if planner.refused {
            return None;
        }
    }
    let plain_rounds = if legs.len() == 1 { height.courses().saturating_sub(1) } else { 0 };
    Some(RowPlan { legs, plain_rounds })
}

/// The common height of a row's stitches, in single crochets.
#[derive(Default)]
struct Height {
    common: Option<f64>,
    mixed: bool,
}

impl Height {
    fn add(&mut self, height: f64) {
        self.mixed |= self.common.is_some_and(|common| common != height);
        self.common = Some(height);
    }
    /// Courses that stand for a row of these stitches.
    fn courses(&self) -> u32 {
        match self.common {
            Some(height) if !self.mixed => height.round().clamp(1.0, 10.0) as u32,
            _ => 1,
        }
    }
}

struct Planner<'a, 's, 'o> {
    part: &'a Part,
    number: u32,
    options: &'a Options,
    sink: &'s mut Sink<'o>,
    refused: bool,
    stitch: u32,
}

impl Planner<'_, '_, '_> {
    fn work(&mut self, stitch: Stitch, legs: &mut [Leg], height: &mut Height) {
        let Some(leg) = legs.last_mut() else { return };
        let name = stitch.kind.us_name();
        match (stitch.works, stitch.makes) {
            // A turning chain that is not counted stands only for height, which a knit loop brings itself.
            (0, 0) if stitch.kind == Kind::Ch && leg.actions.is_empty() => return,
            (0, 0) => return self.approximate(name, "it makes no loop and is left out"),
            (_, 0) => {
                return self.refuse(name, "every loop of a tube stays on its needle until it is worked");
            }
            (0, makes) => match leg.actions.last_mut() {
                Some(last) => last.makes = last.makes.saturating_add(makes),
                None => self.refuse(name, "it works no loop, and no stitch stands before it"),
            },
            (works, makes) => leg.actions.push(Action { works, makes }),
        }
        height.add(stitch.kind.height());
        let most = |loops: u16| loops <= super::MOST_IN_ONE;
        if !most(stitch.works) || !leg.actions.last().is_none_or(|action| most(action.makes)) {
            let what = format!("{} loops worked to {}", stitch.works, stitch.makes);
            return self.refuse(&what, "at most 3 loops come together or are made in one place");
        }
        if stitch.kind != Kind::Sc {
            self.approximate(name, "a knit loop stands for it");
        } else if stitch.entry != Entry::Both {
            self.approximate("a stitch into one strand", "knit loops have no strands to choose");
        }
    }

    fn say(&mut self, finding: Finding, what: &str, help: &str) {
        let message = match self.stitch {
            0 => what.to_owned(),
            stitch => format!("{what} at stitch {stitch}"),
        };
        let mut diagnostic = Diagnostic::new(finding, message).in_round(&self.part.name, Some(self.number));
        if !help.is_empty() {
            diagnostic = diagnostic.help(help);
        }
        self.sink.push(diagnostic);
    }

    fn refuse(&mut self, what: &str, help: &str) {
        self.refused = true;
        self.say(Finding::NotKnittable, &format!("{what} cannot be knit"), help);
    }

    fn approximate(&mut self, what: &str, how: &str) {
        if self.options.approximate {
            self.say(Finding::Approximated, &format!("{what} is approximated"), how);
        } else {
            let help = format!("--set approximate=true accepts that {how}");
            self.refused = true;
            self.say(Finding::NotKnittable, &format!("{what} has no exact counterpart in knitting"), &help);
        }
    }
}
