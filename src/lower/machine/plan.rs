//! From rows to legs: what the needles have to do, and which stitches have no counterpart in knitting.

use super::Options;
use crate::diag::{Code as Finding, Diagnostic, Sink};
use crate::ir::{Direction, Entry, Kind, Part, PartId, Row, Step, Stitch};

/// A run of stitches without a turn and without loops set aside.
#[derive(Clone, Debug, PartialEq)]
pub struct Leg {
    /// Direction of work; another one than that of the leg before means a turn.
    pub direction: Direction,
    /// Loops set aside for another part before the first stitch.
    pub hold: Option<(u32, PartId)>,
    /// The stitches in working order.
    pub actions: Vec<Action>,
}

impl Leg {
    fn new(direction: Direction) -> Self {
        Self { direction, hold: None, actions: Vec::new() }
    }

    /// A plain course.
    pub(super) fn plain(loops: usize, color: u16) -> Self {
        Self { actions: vec![Action { color, ..PLAIN }; loops], ..Self::new(Direction::Forward) }
    }
}

/// One stitch as the needles see it: loops that come together, and loops that are made of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Action {
    /// Loops worked together; 0 for chains, which are loops on empty needles.
    pub works: u16,
    /// Loops made; at least 1.
    pub makes: u16,
    /// The color, as its place in the program's colors.
    pub color: u16,
}

/// The plain stitch.
pub const PLAIN: Action = Action { works: 1, makes: 1, color: 0 };

/// One row, ready to be knit.
#[derive(Clone, Debug, PartialEq)]
pub struct RowPlan {
    /// Its legs; the first and the last are worked forward.
    pub legs: Vec<Leg>,
    /// The color at its end.
    pub color: u16,
    /// Plain rounds to be knit after it, which stand for the height of tall stitches.
    pub plain_rounds: u32,
}

/// Plans one row, begun in this color. `None` with the reason in the sink when a stitch has no counterpart.
pub fn row(
    part: &Part,
    row: &Row,
    number: u32,
    color: u16,
    options: &Options,
    sink: &mut Sink<'_>,
) -> Option<RowPlan> {
    let mut planner = Planner { part, number, color, options, sink, refused: false, stitch: 0 };
    let mut legs = vec![Leg::new(Direction::Forward)];
    let mut height = Height::default();
    for step in row.body.steps() {
        planner.stitch += u32::from(matches!(step, Step::Work(_)));
        match step {
            Step::Work(stitch) => planner.work(stitch, &mut legs, &mut height),
            Step::Turn(direction) => legs.push(Leg::new(direction)),
            Step::Hold { .. } if part.flat => {
                planner
                    .refuse("loops set aside in a flat piece", "only a tube can leave loops to another part");
            }
            Step::Hold { loops, by } => {
                let direction = legs.last().map_or(Direction::Forward, |leg| leg.direction);
                legs.push(Leg { hold: Some((loops, by)), ..Leg::new(direction) });
            }
            // They stay open on their needles, and the next row begins with them.
            Step::Leave { .. } => {}
            Step::Color(color) => planner.color = color,
        }
        if planner.refused {
            return None;
        }
    }
    let color = planner.color;
    let plain_rounds = if legs.len() == 1 { height.courses().saturating_sub(1) } else { 0 };
    Some(RowPlan { legs, color, plain_rounds })
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
    color: u16,
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
            (0, 0) if stitch.kind == Kind::Ch && (leg.actions.is_empty() || self.part.flat) => return,
            (0, makes) if stitch.kind == Kind::Ch => {
                if leg.direction == Direction::Back {
                    return self.refuse(name, "chains can be cast on only while the row goes forward");
                }
                leg.actions.push(Action { works: 0, makes, color: self.color });
                return;
            }
            (0, 0) => return self.approximate(name, "it makes no loop and is left out"),
            (_, 0) => {
                return self.refuse(name, "every loop of a tube stays on its needle until it is worked");
            }
            (0, makes) => match leg.actions.last_mut() {
                Some(last) => last.makes = last.makes.saturating_add(makes),
                None => self.refuse(name, "it works no loop, and no stitch stands before it"),
            },
            (works, makes) => leg.actions.push(Action { works, makes, color: self.color }),
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
