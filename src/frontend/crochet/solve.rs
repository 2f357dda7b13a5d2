//! One row on the loops below it: open ends closed, loops followed, faults named.

use super::conventions::{Conventions, Setting};
use super::effect::{self, Effect};
use super::gather::stated;
use super::lex::At;
use super::lower::{Begin, Below, Change, File, Lower, Lowered, Place0, Site, Trouble};
use super::syntax::{Count, CountUnit, Node};
use crate::diag::Code;
use crate::ir::{Block, Direction, Kind, MAX_ROW, Op, Stitch};

/// A row whose operations are complete.
#[derive(Clone, Debug)]
pub(crate) struct Solved {
    /// The row with its operations.
    pub lowered: Lowered,
    /// Loops below that are used up; held ones are, left ones are not.
    pub works: i64,
    /// Loops that the row leaves made.
    pub makes: i64,
    pub left: i64,
    pub stated: Option<u32>,
    /// Loops below, where they are known.
    pub have: Option<i64>,
    /// What is wrong, if anything.
    pub fault: Option<Box<Trouble>>,
}

impl Solved {
    /// Loops that the next row works on.
    pub(crate) fn leaves(&self, flat: bool) -> i64 {
        if flat { self.makes } else { self.makes + self.left }
    }
}

/// A row to be solved.
#[derive(Clone, Copy)]
pub(crate) struct Job<'j> {
    pub body: &'j [Node],
    pub count: Option<&'j Count>,
    pub at: At,
    /// How the row is called in messages.
    pub file: &'j File<'j>,
    pub place: &'j Place0<'j>,
    /// Loops below; `None` where they are not known.
    pub have: Option<i64>,
}

/// What a row turned out to be, and how.
pub(crate) enum Reading {
    /// As the conventions say.
    Plain(Solved),
    /// The loops and the count decided a setting.
    Decided(Solved, Setting, &'static str),
    /// The row has no meaning.
    Trouble(Trouble),
}

impl Job<'_> {
    /// Solves the row under the conventions, and under others where the loops show that they do not hold.
    pub(crate) fn read(&self, conventions: &Conventions, colors: &mut Vec<String>) -> Reading {
        let first = self.solve(conventions, colors, None);
        let undecided = match &first {
            Ok(solved) => solved.lowered.undecided,
            Err(_) => None,
        };
        if let Some(setting) = undecided {
            return self.decide(setting, conventions, colors);
        }
        match first {
            Ok(solved) if solved.fault.is_none() && !tail_first(&solved) => Reading::Plain(solved),
            Ok(solved) => self.otherwise(solved, conventions, colors),
            Err(trouble) => Reading::Trouble(trouble),
        }
    }

    /// A setting that has no default reading: exactly one value must fit.
    fn decide(&self, setting: Setting, conventions: &Conventions, colors: &mut Vec<String>) -> Reading {
        let values = setting.values().iter().skip(1);
        let mut readings: Vec<(&'static str, Solved)> = Vec::new();
        let mut trouble = None;
        for value in values {
            let job = conventions.with(setting, value);
            match self.solve(&job, colors, None) {
                Ok(solved) => readings.push((value, solved)),
                Err(found) => trouble = Some(found),
            }
        }
        let known =
            |solved: &Solved| solved.fault.is_none() && (self.have.is_some() || solved.stated.is_some());
        let fitting: Vec<usize> = readings
            .iter()
            .enumerate()
            .filter(|(_, (_, solved))| known(solved))
            .map(|(index, _)| index)
            .collect();
        let same = |a: usize, b: usize| match (readings.get(a), readings.get(b)) {
            (Some((_, a)), Some((_, b))) => a.lowered.block == b.lowered.block,
            _ => false,
        };
        let one = match fitting.as_slice() {
            [] => None,
            [index] => Some(*index),
            [index, rest @ ..] => rest.iter().all(|other| same(*index, *other)).then_some(*index),
        };
        match one {
            Some(index) => {
                let (value, solved) = readings.swap_remove(index);
                Reading::Decided(solved, setting, value)
            }
            None if fitting.is_empty()
                && (self.have.is_some() || self.count.is_some())
                && !readings.is_empty() =>
            {
                Reading::Plain(readings.swap_remove(0).1)
            }
            None if readings.is_empty() => {
                Reading::Trouble(trouble.unwrap_or_else(|| self.ambiguous(setting, &readings)))
            }
            None => Reading::Trouble(self.ambiguous(setting, &readings)),
        }
    }

    fn ambiguous(&self, setting: Setting, readings: &[(&'static str, Solved)]) -> Trouble {
        let makes: Vec<String> =
            readings.iter().map(|(value, solved)| format!("{value} makes {}", solved.makes)).collect();
        let example = readings.first().map_or("", |(value, _)| value);
        let help =
            format!("say it otherwise, state a count, or declare `convention: {}={example}`", setting.name());
        Trouble::new(Code::Ambiguous, self.at, format!("more than one reading fits: {}", makes.join(", ")))
            .help(help)
    }

    /// Other readings of a row that does not fit as it is.
    fn otherwise(&self, solved: Solved, conventions: &Conventions, colors: &mut Vec<String>) -> Reading {
        let mut fitting: Option<(Solved, Setting, &'static str)> = None;
        let mut several = false;
        for setting in &solved.lowered.touched {
            let tail = *setting == Setting::TailCount;
            if conventions.declared(*setting) || !overrulable(*setting) {
                continue;
            }
            for value in
                setting.values().iter().filter(|value| !conventions.is(*setting, value) && **value != "count")
            {
                let Ok(other) = self.solve(&conventions.with(*setting, value), colors, None) else {
                    continue;
                };
                let vouched = tail || *setting == Setting::ImplicitRepeat || other.stated.is_some();
                if other.fault.is_none()
                    && other.lowered.undecided.is_none()
                    && self.have.is_some()
                    && vouched
                {
                    several |= fitting
                        .as_ref()
                        .is_some_and(|(found, ..)| found.lowered.block != other.lowered.block);
                    fitting.get_or_insert((other, *setting, value));
                }
            }
        }
        match fitting {
            Some((found, setting, value)) if !several => Reading::Decided(found, setting, value),
            _ => Reading::Plain(solved),
        }
    }

    /// Solves the row under exactly these conventions.
    pub(crate) fn solve(
        &self,
        conventions: &Conventions,
        colors: &mut Vec<String>,
        change: Option<Change>,
    ) -> Result<Solved, Trouble> {
        let lower = Lower::new(self.file, conventions, self.place, colors, change);
        let mut lowered = lower.row(self.body, self.count)?;
        let mut stated_count = self.count.and_then(stated).map(|n| changed(change, n.at, n.value));
        if let Some(tail) = lowered.tail {
            stated_count = Some(changed(change, tail.at, tail.value));
        }
        let have = self.loops(&lowered, conventions);
        if self.place.beyond > 0 && lowered.site.is_some() {
            lowered.touched.push(Setting::AcrossStep);
        }
        if conventions.is(Setting::ImplicitRepeat, "fill") {
            implicit(&mut lowered, have);
        }
        let nothing = self.place.below == Below::Nothing && lowered.begin.is_none();
        if let (Some(site), true) = (&lowered.site, nothing) {
            return Err(no_foundation(site.at));
        }
        if let Some(site) = &mut lowered.site {
            let (body, partial) = (std::mem::take(&mut site.body), site.partial.take());
            let site = Site { body, partial, ..**site };
            let spaces = (lowered.spaces, self.place.spaces);
            super::close::close(&mut lowered.block, site, have, spaces, stated_count)?;
        }
        let mut direction = Direction::Forward;
        let effect = effect::of(&lowered.block, &mut direction, false)
            .map_err(|fault| self.loop_fault(fault, &lowered.block))?;
        if direction == Direction::Back {
            return Err(Trouble::new(
                Code::UnbalancedTurn,
                self.last_turn(&lowered.block),
                "this back pass never turns forward",
            )
            .help("close the short row with `->`, and work on to the end of the round"));
        }
        let mut solved = Solved {
            works: effect.works() - effect.left,
            makes: effect.behind,
            left: effect.left,
            stated: stated_count,
            have,
            fault: None,
            lowered,
        };
        solved.fault = self.judge(&mut solved, effect, conventions).map(Box::new);
        Ok(solved)
    }

    /// Loops that the row has before it.
    fn loops(&self, lowered: &Lowered, conventions: &Conventions) -> Option<i64> {
        let all = self.place.beyond > 0 && conventions.is(Setting::AcrossStep, "all");
        if let Some(usable) = lowered.usable {
            return Some(i64::from(usable));
        }
        match (&lowered.begin, &self.place.below) {
            (Some(Begin::Chain { chains, .. }), _) | (None, Below::Chain { chains, .. }) => {
                Some(i64::from(*chains))
            }
            (Some(Begin::Ring), _) | (None, Below::Nothing) => Some(0),
            (None, Below::Loops) if all => self.have.map(|have| have + self.place.beyond),
            (None, Below::Loops) => self.have,
        }
    }

    fn judge(&self, solved: &mut Solved, effect: Effect, conventions: &Conventions) -> Option<Trouble> {
        let begun = solved.lowered.begin.is_some();
        let only_chain = matches!(solved.lowered.begin, Some(Begin::Chain { .. }))
            && effect.works() == 0
            && effect.behind == 0;
        if only_chain {
            // A foundation alone: its chains are what the next row works into.
            solved.makes = solved.have.unwrap_or(0);
            return self.differs(solved, Code::ChainLength);
        }
        if effect.works() > i64::from(MAX_ROW) || effect.behind > i64::from(MAX_ROW) {
            let most = effect.works().max(effect.behind);
            let message = format!("{} has {most} loops, more than {MAX_ROW}", "the row");
            return Some(Trouble::new(Code::Limit, self.at, message));
        }
        if self.place.below == Below::Nothing && !begun && effect.need_ahead > 0 {
            return Some(no_foundation(solved.lowered.first_work.unwrap_or(self.at)));
        }
        if effect.need_behind > 0 {
            let message = "the back pass is longer than what lies behind it";
            return Some(
                Trouble::new(Code::BackPassTooLong, self.first_turn(&solved.lowered.block), message)
                    .help(format!("shorten it by {}", effect.need_behind)),
            );
        }
        let have = solved.have?;
        if solved.lowered.leave_rest && solved.works < have {
            let loops = (have - solved.works).min(i64::from(u32::MAX)) as u32;
            solved.left = i64::from(loops);
            solved.lowered.block.push(Op::Leave { loops }, self.file.source.span(self.at.range()));
        }
        let used = solved.works + solved.left;
        // Behind the loops of the row below a flat row may find others, and need not work them.
        let found = solved.lowered.begin.is_none() && solved.lowered.usable.is_none();
        let (least, most) = match self.have {
            Some(own) if found && self.place.beyond > 0 => (own, own + self.place.beyond),
            _ => (have, have),
        };
        let fits = (least..=most).contains(&used) && effect.need_ahead <= most;
        if !fits && (used > have || effect.need_ahead > have) {
            return Some(self.over(solved, used, effect.need_ahead, (have, most)));
        }
        if !fits && used < have && solved.lowered.spaces.is_some() {
            // What lies between the spaces is passed over.
            let loops = (have - used).min(i64::from(u32::MAX)) as u32;
            let skip = Op::Work { stitch: Stitch::plain(Kind::Skip), times: loops };
            let tail = solved.lowered.block.ops().iter().rev().take_while(|op| ends(op)).count();
            let after = solved.lowered.block.split_off(solved.lowered.block.ops().len() - tail);
            solved.lowered.block.push(skip, self.file.source.span(self.at.range()));
            solved.lowered.block.append(after);
            solved.works += i64::from(loops);
        } else if !fits && used < have {
            let turned = solved.lowered.ends_in_turn && conventions.is(Setting::Unworked, "turn");
            if turned || conventions.is(Setting::Unworked, "any") {
                let loops = (have - used).min(i64::from(u32::MAX)) as u32;
                solved.left += i64::from(loops);
                solved.lowered.block.push(Op::Leave { loops }, self.file.source.span(self.at.range()));
            } else {
                let code = if solved.lowered.usable.is_some() { Code::ChainLength } else { Code::LoopsLeft };
                let message = format!("works {} of the {have} loops below", solved.works);
                return Some(Trouble::new(code, self.at, message).help(format!(
                    "work the other {} too, or `leave {} sts unworked`",
                    have - used,
                    have - used
                )));
            }
        }
        let foundation = solved.lowered.usable.is_some();
        let code = if foundation { Code::ChainLength } else { Code::CountDiffers };
        self.differs(solved, code)
    }

    fn over(&self, solved: &Solved, used: i64, need: i64, (have, most): (i64, i64)) -> Trouble {
        let code = if solved.lowered.usable.is_some() { Code::ChainLength } else { Code::LoopsExhausted };
        if effect::has_turn(&solved.lowered.block) && used <= have {
            let message = format!("runs out of loops: the {have} below do not reach to the turn");
            return Trouble::new(Code::LoopsExhausted, self.at, message)
                .help(format!("{need} loops are needed before the turn"));
        }
        let further = match most - have {
            further @ 1.. => format!(", and {further} further on"),
            _ => String::new(),
        };
        let message = format!("works {used} loops, {have} are there{further}");
        Trouble::new(code, self.at, message).help(format!("the row can work {most} loops"))
    }

    /// The stated count against the loops made.
    fn differs(&self, solved: &Solved, code: Code) -> Option<Trouble> {
        let at = self
            .count
            .map_or_else(|| solved.lowered.tail.map_or(self.at, |tail| tail.at), |count| count.total.at);
        if let Some(stated) = solved.stated
            && i64::from(stated) != self.counted(solved)
        {
            let message = format!("makes {} loops, {stated} stated", self.counted(solved));
            let help = if code == Code::ChainLength {
                "chains that are skipped at the hook are not worked into".to_owned()
            } else {
                format!("the row makes {} as written", self.counted(solved))
            };
            return Some(Trouble::new(code, at, message).help(help));
        }
        let single = self.count.is_none_or(|count| count.others.is_empty());
        for (n, unit) in self.count.iter().flat_map(|count| count.units()) {
            let made = match unit {
                CountUnit::Kind(spelled) => {
                    let kind = if self.file.terms == crate::ir::Terms::Us { spelled.us } else { spelled.uk };
                    let Some(kind) = kind else { continue };
                    if single && solved.lowered.begin.is_none() && !mixes(&solved.lowered.block) {
                        continue;
                    }
                    made(&solved.lowered.block, &|stitch| stitch == kind)
                }
                CountUnit::Chains => made_chains(&solved.lowered.block),
                CountUnit::Stitches | CountUnit::Spaces | CountUnit::Rounds => continue,
            };
            if made != u64::from(n.value) {
                let message = format!("makes {made} of these stitches, {} stated", n.value);
                return Some(Trouble::new(Code::CountDiffers, n.at, message));
            }
        }
        None
    }

    /// Loops that the stated count refers to.
    fn counted(&self, solved: &Solved) -> i64 {
        let Some(count) = self.count else { return solved.makes };
        match count.unit {
            CountUnit::Kind(spelled) if !count.others.is_empty() || mixes(&solved.lowered.block) => {
                let kind = if self.file.terms == crate::ir::Terms::Us { spelled.us } else { spelled.uk };
                kind.map_or(solved.makes, |kind| made(&solved.lowered.block, &|stitch| stitch == kind) as i64)
            }
            _ => solved.makes,
        }
    }

    fn loop_fault(&self, fault: effect::Fault, block: &Block) -> Trouble {
        match fault {
            effect::Fault::TooLarge => {
                let message = format!("the numbers multiply to more than {MAX_ROW} loops");
                Trouble::new(Code::Limit, self.at, message)
            }
            effect::Fault::Mark(index) => {
                let forward = matches!(block.ops().get(index), Some(Op::Turn(Direction::Forward)));
                let at = self.op_at(block, index);
                let (message, help) = if forward {
                    ("`->`, but no short row was opened", "a short row is opened by `<-`")
                } else {
                    ("`<-` inside of a back pass", "close the short row with `->` first")
                };
                Trouble::new(Code::UnbalancedTurn, at, message).help(help)
            }
            effect::Fault::Unbalanced(index) => Trouble::new(
                Code::UnbalancedTurn,
                self.op_at(block, index),
                "a repeat that turns and does not turn back",
            ),
        }
    }

    fn op_at(&self, block: &Block, index: usize) -> At {
        let span = block.spanned().nth(index).map(|(_, span)| span);
        self.range(span)
    }

    fn range(&self, span: Option<crate::diag::Span>) -> At {
        span.and_then(|span| self.file.source.range(span))
            .map_or(self.at, |range| At::new(range.start, range.end))
    }

    fn first_turn(&self, block: &Block) -> At {
        self.range(block.spanned().find(|(op, _)| matches!(op, Op::Turn(_))).map(|(_, span)| span))
    }

    fn last_turn(&self, block: &Block) -> At {
        self.range(block.spanned().filter(|(op, _)| matches!(op, Op::Turn(_))).last().map(|(_, span)| span))
    }
}

fn no_foundation(at: At) -> Trouble {
    Trouble::new(Code::NoFoundation, at, "nothing lies below to work into")
        .help("begin the part with a ring (`6 sc in MR`), a chain (`ch 20`), or loops of another part")
}

/// A row whose last clause was taken for its count, though it does not fit so.
fn tail_first(solved: &Solved) -> bool {
    solved.lowered.tail.is_some() && solved.fault.is_some()
}

fn overrulable(setting: Setting) -> bool {
    !matches!(
        setting,
        Setting::Terms
            | Setting::ShapingHeight
            | Setting::Restart
            | Setting::Unworked
            | Setting::Evenly
            | Setting::TurnMark
            | Setting::AfterFault
    )
}

fn changed(change: Option<Change>, at: At, value: u32) -> u32 {
    match change {
        Some(Change::Number(place, other)) if place == at => other,
        _ => value,
    }
}

/// A list that does not use up the row is repeated to its end.
fn implicit(lowered: &mut Lowered, have: Option<i64>) {
    let Some(have) = have else { return };
    let mut direction = Direction::Forward;
    let Ok(effect) = effect::of(&lowered.block, &mut direction, false) else { return };
    let works = effect.works();
    if lowered.site.is_none()
        && works > 0
        && works < have
        && lowered.begin.is_none()
        && !effect::has_turn(&lowered.block)
    {
        let body = std::mem::take(&mut lowered.block);
        let at = lowered.first_work.unwrap_or_default();
        let site = Site { index: 0, body, partial: None, last: None, at, spaces: 0, even: None };
        lowered.site = Some(Box::new(site));
    }
}

/// Loops that stitches of some kinds make.
fn made(block: &Block, wanted: &dyn Fn(Kind) -> bool) -> u64 {
    block.ops().iter().fold(0_u64, |sum, op| {
        sum.saturating_add(match op {
            Op::Work { stitch, times } if wanted(stitch.kind) => u64::from(stitch.makes) * u64::from(*times),
            Op::Repeat { body, times } => made(body, wanted).saturating_mul(u64::from(*times)),
            _ => 0,
        })
    })
}

fn made_chains(block: &Block) -> u64 {
    block.ops().iter().fold(0_u64, |sum, op| {
        sum.saturating_add(match op {
            Op::Work { stitch, times } if stitch.kind == Kind::Ch => u64::from(*times),
            Op::Repeat { body, times } => made_chains(body).saturating_mul(u64::from(*times)),
            _ => 0,
        })
    })
}

/// True when stitches of several kinds make loops.
fn mixes(block: &Block) -> bool {
    let mut first = None;
    mixed(block, &mut first)
}

fn mixed(block: &Block, first: &mut Option<Kind>) -> bool {
    block.ops().iter().any(|op| match op {
        Op::Work { stitch, .. } if stitch.makes > 0 => *first.get_or_insert(stitch.kind) != stitch.kind,
        Op::Repeat { body, .. } => mixed(body, first),
        _ => false,
    })
}

/// True for what ends a row without working a loop.
fn ends(op: &Op) -> bool {
    match op {
        Op::Work { stitch, .. } => stitch.works + stitch.makes == 0,
        Op::Leave { .. } | Op::Color(_) => true,
        Op::Repeat { .. } | Op::Turn(_) | Op::Hold { .. } => false,
    }
}

/// Chain spaces that a row makes. `None` where a repeat hides too many.
pub(crate) fn spaces(block: &Block) -> Option<u32> {
    /// Spaces, whether the block begins with chains, and whether it ends with them.
    fn of(block: &Block) -> Option<(u64, Option<bool>, bool)> {
        let (mut sum, mut first, mut chain) = (0_u64, None, false);
        for op in block.ops() {
            let (more, begins, ends) = match op {
                Op::Work { stitch, .. } if stitch.kind == Kind::Ch => (1, Some(true), true),
                Op::Work { stitch, .. } if stitch.works + stitch.makes > 0 => (0, Some(false), false),
                Op::Repeat { body, times } => {
                    let (one, begins, ends) = of(body)?;
                    let seam = u64::from(begins == Some(true) && ends);
                    let times = u64::from(*times);
                    let all = one.checked_mul(times)?.checked_sub(seam * times.saturating_sub(1))?;
                    (all, begins, ends)
                }
                _ => continue,
            };
            let Some(starts) = begins else { continue };
            sum = sum.checked_add(more)?.checked_sub(u64::from(chain && starts))?;
            first.get_or_insert(starts);
            chain = ends;
        }
        Some((sum, first, chain))
    }
    // A chain that stands for the first stitch is no space.
    let first = block.ops().iter().take_while(|op| match op {
        Op::Work { stitch, .. } => stitch.kind == Kind::Ch || stitch.works + stitch.makes == 0,
        Op::Color(_) => true,
        Op::Repeat { .. } | Op::Turn(_) | Op::Hold { .. } | Op::Leave { .. } => false,
    });
    let stands = |op: &Op| matches!(op, Op::Work { stitch, .. } if stitch.makes > 0);
    let standing = u64::from(first.into_iter().any(stands));
    u32::try_from(of(block)?.0.checked_sub(standing)?).ok()
}
