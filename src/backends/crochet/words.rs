//! The words of a row: clauses, repeats and direction marks as `grammar/crochet.ebnf` has them.

use super::Arrows;
use crate::ir::dialect::{Forms, fill};
use crate::ir::{Block, Direction, Entry, Kind, Language, Op, Part, Program, Step, Stitch, Terms};
use std::borrow::Cow;
use std::fmt::Write as _;
use std::ops::Range;

/// How rows are put into words.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Words<'p> {
    pub(crate) program: &'p Program,
    pub(crate) terms: Terms,
    pub(crate) language: Language,
    pub(crate) arrows: Arrows,
    /// A stitch other than single crochet is about, so that `inc` alone would not say of what.
    pub(crate) mixed: bool,
}

impl<'p> Words<'p> {
    /// The words for a part.
    pub(crate) fn new(
        program: &'p Program,
        part: &Part,
        terms: Terms,
        language: Language,
        arrows: Arrows,
    ) -> Self {
        Self { program, terms, language, arrows, mixed: part.rows.iter().any(|row| mixed(&row.body)) }
    }

    /// A row, folded as it is.
    pub(crate) fn row(&self, block: &Block, begins: bool) -> String {
        let mut line = self.line(block, begins);
        for op in block.ops() {
            self.op(op, &mut line);
        }
        self.settle(&mut line);
        line.text
    }

    /// An empty line; a row that begins a part in a ring says so first.
    fn line(&self, block: &Block, begins: bool) -> Line {
        let text = if begins { self.forms().ring.to_owned() } else { String::new() };
        let spelled = self.arrows == Arrows::Words && turns_inside(block);
        Line { text, ring: begins, stands: !begins && stands(block), spelled, ..Line::default() }
    }

    /// A row with runs counted and nothing else folded.
    pub(crate) fn plain_row(&self, block: &Block, begins: bool) -> String {
        let mut line = self.line(block, begins);
        let mut run: Option<(Stitch, u32)> = None;
        for step in block.steps() {
            match (step, &mut run) {
                (Step::Work(stitch), Some((same, times))) if stitch == *same => *times += 1,
                (step, _) => {
                    if let Some((stitch, times)) = run.take() {
                        self.op(&Op::Work { stitch, times }, &mut line);
                    }
                    match step {
                        Step::Work(stitch) => run = Some((stitch, 1)),
                        Step::Turn(direction) => self.op(&Op::Turn(direction), &mut line),
                        Step::Hold { loops, by } => self.op(&Op::Hold { loops, by }, &mut line),
                        Step::Leave { loops } => self.op(&Op::Leave { loops }, &mut line),
                        Step::Color(color) => self.op(&Op::Color(color), &mut line),
                    }
                }
            }
        }
        if let Some((stitch, times)) = run {
            self.op(&Op::Work { stitch, times }, &mut line);
        }
        self.settle(&mut line);
        line.text
    }

    /// A row as [`Words::row`], with the place of each run of stitches in it, in order.
    pub(crate) fn runs(&self, block: &Block, begins: bool) -> (String, Vec<Range<usize>>) {
        let mut line = self.line(block, begins);
        for op in block.ops() {
            self.op(op, &mut line);
        }
        self.settle(&mut line);
        (line.text, line.runs)
    }

    fn op(&self, op: &Op, line: &mut Line) {
        let (from, before) = (line.text.len(), line.runs.len());
        self.write(op, line);
        if let Op::Work { .. } = op {
            line.runs.truncate(before);
            line.runs.push(from..line.text.len());
        }
    }

    fn write(&self, op: &Op, line: &mut Line) {
        let forms = self.forms();
        match op {
            Op::Work { stitch, times } => {
                let arity = (stitch.kind, stitch.works, stitch.makes);
                if line.stands && !line.worked && arity == (Kind::Ch, 1, 1) {
                    line.worked = true;
                    let chains = line.standing.take().unwrap_or(0).saturating_add(1);
                    line.clause(&self.standing(chains));
                    if *times > 1 {
                        self.op(&Op::Work { stitch: *stitch, times: times - 1 }, line);
                    }
                    return;
                }
                self.settle(line);
                let loose = arity == (Kind::Ch, 0, 0);
                if line.stands && !line.worked && loose {
                    // A chain that stands for the first stitch is told in one clause.
                    line.standing = Some(*times);
                    return;
                }
                let words = self.clause(*stitch, *times, line);
                let hook = !matches!(stitch.kind, Kind::Ch | Kind::Skip) && !is_joint(*stitch);
                let sign = line.direction == Direction::Back && !line.spelled && hook;
                line.clause(if sign { "-" } else { "" });
                line.text.push_str(&words);
                line.worked |= !loose && !is_joint(*stitch);
            }
            Op::Repeat { body, times } => {
                self.settle(line);
                line.clause("(");
                line.open = true;
                body.ops().iter().for_each(|op| self.op(op, line));
                let _ = write!(line.text, ") x {times}");
                line.open = false;
            }
            Op::Turn(direction) => {
                self.settle(line);
                line.direction = *direction;
                if line.spelled {
                    return line.clause(forms.turn);
                }
                line.mark(match (self.arrows, direction) {
                    (Arrows::Ascii, Direction::Back) => "<-",
                    (Arrows::Ascii, Direction::Forward) => "->",
                    (Arrows::Unicode | Arrows::Words, Direction::Back) => "←",
                    (Arrows::Unicode | Arrows::Words, Direction::Forward) => "→",
                });
            }
            Op::Hold { loops, by } => {
                self.settle(line);
                line.worked = true;
                let part = self.program.pattern.parts.get(by.0 as usize).map_or("?", |part| &part.name);
                let part = super::rows::name(part, self.language);
                line.clause(&self.counted(forms.hold, *loops, &[("part", &part)]));
            }
            Op::Leave { loops } => {
                self.settle(line);
                line.clause(&self.counted(forms.leave, *loops, &[]));
            }
            Op::Color(color) => {
                self.settle(line);
                let [first, later] = forms.color;
                let template = if line.text.is_empty() { first } else { later };
                let color = super::rows::color(self.program, *color, self.language);
                line.clause(&fill(template, &[("color", &color)]));
            }
        }
    }

    /// Writes chains that turned out to stand for no stitch.
    fn settle(&self, line: &mut Line) {
        if let Some(chains) = line.standing.take() {
            line.clause(&self.chains(chains));
        }
    }

    fn forms(&self) -> &'static Forms {
        self.language.vocabulary().forms
    }

    /// A template with a number and the word for so many stitches.
    fn counted(&self, template: &str, loops: u32, more: &[(&str, &str)]) -> String {
        let count = loops.to_string();
        let mut values = vec![("n", count.as_str()), ("st", stitches(loops, self.forms()))];
        values.extend_from_slice(more);
        fill(template, &values)
    }

    fn chains(&self, times: u32) -> String {
        fill(self.forms().chain, &[("n", &times.to_string())])
    }

    /// `ch 3 (counts as dc)`: the stitch as high as the chains, which is what most makers write.
    fn standing(&self, chains: u32) -> String {
        let high = |kind: &&Kind| (kind.height() - f64::from(chains)).abs() < 0.5;
        let kind = [Kind::Sc, Kind::Hdc, Kind::Dc, Kind::Tr, Kind::Dtr, Kind::Trtr].iter().find(high);
        let what = self.base(*kind.unwrap_or(&Kind::Sc));
        format!("{} ({})", self.chains(chains), fill(self.forms().counts, &[("what", what)]))
    }

    /// `6 sc`, `inc`, `2 hdc2tog`.
    fn clause(&self, stitch: Stitch, times: u32, line: &Line) -> String {
        let forms = self.forms();
        let arity = (stitch.works, stitch.makes);
        match (stitch.kind, arity) {
            (Kind::Skip, (1, 0)) => {
                return fill(forms.skip, &[("sk", self.base(Kind::Skip)), ("n", &times.to_string())]);
            }
            (Kind::Ch, (0, 0)) => return self.chains(times),
            (Kind::Ch, (0, 1)) => {
                let what = format!("{times} {}", stitches(times, forms));
                return format!("{} ({})", self.chains(times), fill(forms.counts, &[("what", &what)]));
            }
            _ if is_joint(stitch) && times == 1 => return forms.join.to_owned(),
            _ => {}
        }
        let own = arity == (stitch.kind.works(), stitch.kind.makes());
        let places = match (stitch.entry, arity) {
            (Entry::Space, _) => Some(forms.space),
            (_, (0, 1)) if own => Some(""),
            (_, (0, 1)) if line.worked && !line.ring && stitch.kind != Kind::Special => Some(forms.same),
            _ => None,
        };
        let plain = Stitch { works: stitch.kind.works(), makes: stitch.kind.makes(), ..stitch };
        let (name, place) = match places {
            Some(place) if stitch.makes == 1 && stitch.kind != Kind::Special => (self.stitch(plain), place),
            _ => (self.stitch(stitch), places.unwrap_or("")),
        };
        let entry = match stitch.entry {
            Entry::Both | Entry::Space => "",
            Entry::Front => forms.strands[0],
            Entry::Back => forms.strands[1],
        };
        // A slip stitch without a number at the end of a round would close it.
        let bare = times == 1 && stitch.kind != Kind::SlSt;
        let space = if forms.glued { "" } else { " " };
        let mut named = String::with_capacity(16);
        if !bare {
            let _ = write!(named, "{times}");
            named.push_str(space);
        }
        let count = named.len();
        for word in [&*name, entry, place] {
            named.push_str(word);
        }
        if line.ring
            && arity == (0, 1)
            && !own
            && stitch.kind != Kind::Special
            && stitch.entry != Entry::Space
        {
            let plain = format!("{}{}{entry}", &named[..count], self.stitch(plain));
            return fill(forms.in_ring, &[("stitch", &plain)]);
        }
        named
    }

    /// Name of a stitch.
    fn stitch(&self, stitch: Stitch) -> Cow<'static, str> {
        if let Some(letters) = self.language.letters(stitch) {
            return letters.into();
        }
        let base = self.base(stitch.kind);
        let plain = !self.mixed && stitch.kind == Kind::Sc;
        let own = (stitch.kind.works(), stitch.kind.makes());
        let (inc, dec) = (|| self.language.say("inc"), || self.language.say("dec"));
        match (stitch.works, stitch.makes) {
            arity if arity == own && stitch.kind != Kind::Special => base.into(),
            arity if !is_common(stitch.kind, arity) => {
                super::rows::special(stitch.kind, arity.0, arity.1, self.terms).into()
            }
            (1, 2) if plain => inc().into(),
            (1, 2) => format!("{base} {}", inc()).into(),
            (1, makes) if plain => format!("{}{makes}", inc()).into(),
            (1, makes) => format!("{base} {}{makes}", inc()).into(),
            (2, _) if plain => dec().into(),
            (works, _) => format!("{base}{works}{}", self.forms().together).into(),
        }
    }

    /// Abbreviation of a kind in the language and terms of the text.
    pub(crate) fn base(&self, kind: Kind) -> &'static str {
        abbreviation(kind, self.language, self.terms)
    }
}

/// Abbreviation of a kind in a language.
pub(super) fn abbreviation(kind: Kind, language: Language, terms: Terms) -> &'static str {
    match (kind, language) {
        (Kind::Skip, Language::English | Language::Letters) => language.abbreviation(kind, terms),
        (Kind::Skip, _) => language.say("sk"),
        _ => language.abbreviation(kind, terms),
    }
}

/// True when the first thing that works a loop is a chain that counts as a stitch, and no skip follows it, which would
/// take that loop.
pub(super) fn stands(block: &Block) -> bool {
    let mut direct = block.ops().iter().skip_while(|op| match op {
        Op::Color(_) => true,
        Op::Work { stitch, .. } => (stitch.kind, stitch.works, stitch.makes) == (Kind::Ch, 0, 0),
        Op::Repeat { .. } | Op::Turn(_) | Op::Hold { .. } | Op::Leave { .. } => false,
    });
    let stood = |op: &Op| matches!(op, Op::Work { stitch, .. } if (stitch.kind, stitch.works, stitch.makes) == (Kind::Ch, 1, 1));
    fn skips(op: &Op) -> bool {
        match op {
            Op::Work { stitch, .. } => stitch.kind == Kind::Skip,
            Op::Repeat { body, .. } => body.ops().first().is_some_and(skips),
            Op::Turn(_) | Op::Hold { .. } | Op::Leave { .. } | Op::Color(_) => false,
        }
    }
    direct.next().is_some_and(stood) && !direct.next().is_some_and(skips)
}

/// True when every turn of a row stands between stitches, so that the word alone cannot be taken for the turn between
/// two rows.
fn turns_inside(block: &Block) -> bool {
    let works = |step: &Step| match step {
        Step::Work(stitch) => stitch.kind != Kind::Ch && !is_joint(*stitch),
        Step::Hold { .. } | Step::Leave { .. } => true,
        Step::Turn(_) | Step::Color(_) => false,
    };
    let (mut seen, mut open) = (false, false);
    for step in block.steps() {
        if matches!(step, Step::Turn(_)) {
            if !seen {
                return false;
            }
            open = true;
        } else if works(&step) {
            (seen, open) = (true, false);
        }
    }
    !open
}

/// A slip stitch that joins and neither works nor makes a loop.
fn is_joint(stitch: Stitch) -> bool {
    stitch.kind == Kind::SlSt && stitch.works + stitch.makes == 0
}

/// True for the arities that have a way of saying for every stitch; others are declared in the head of the file.
pub(super) fn is_common(kind: Kind, arity: (u16, u16)) -> bool {
    if kind == Kind::Special {
        return false;
    }
    if matches!(kind, Kind::Skip | Kind::Ch | Kind::Picot | Kind::Fsc) {
        return arity == (kind.works(), kind.makes());
    }
    match arity {
        (1, makes) => makes >= 1,
        (works, 1) => works >= 1,
        _ => arity == (kind.works(), kind.makes()),
    }
}

fn stitches(count: u32, forms: &Forms) -> &'static str {
    if count == 1 { forms.st[0] } else { forms.st[1] }
}

/// True when something else than single crochet is worked.
fn mixed(block: &Block) -> bool {
    block.ops().iter().any(|op| match op {
        Op::Work { stitch, .. } => !matches!(stitch.kind, Kind::Sc | Kind::Skip | Kind::Ch | Kind::SlSt),
        Op::Repeat { body, .. } => mixed(body),
        Op::Turn(_) | Op::Hold { .. } | Op::Leave { .. } | Op::Color(_) => false,
    })
}

/// A line under way.
#[derive(Default)]
#[expect(clippy::struct_excessive_bools, reason = "independent facts of a line")]
struct Line {
    /// Places of the runs of stitches in the text.
    runs: Vec<Range<usize>>,
    text: String,
    /// A bracket or a mark was just written, so no comma comes.
    open: bool,
    direction: Direction,
    /// Something was worked already, so that there is a stitch before.
    worked: bool,
    /// The row goes into a ring.
    ring: bool,
    /// The row begins with a chain that stands for a stitch.
    stands: bool,
    /// Turns are words.
    spelled: bool,
    /// Chains at the beginning, held back until it is known whether they stand for a stitch.
    standing: Option<u32>,
}

impl Line {
    fn clause(&mut self, start: &str) {
        if !self.text.is_empty() && !self.open {
            self.text.push_str(", ");
        }
        self.open = false;
        self.text.push_str(start);
    }

    fn mark(&mut self, mark: &str) {
        if !self.text.is_empty() && !self.open {
            self.text.push(' ');
        }
        self.text.push_str(mark);
        self.text.push(' ');
        self.open = true;
    }
}
