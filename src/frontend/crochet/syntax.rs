//! The tree of a pattern as written: comments, notes and places are kept, so that `fmt` can print from it.

use super::lex::At;
use super::words::Spelled;
use crate::ir::{Direction, Entry, Kind};
use smallvec::SmallVec;

/// A number and where it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Num {
    pub value: u32,
    pub at: At,
}

/// One line of a file.
#[derive(Debug)]
pub(crate) struct Line {
    /// The whole line without its end.
    pub at: At,
    pub what: Content,
    /// A `//` remark behind the content.
    pub remark: Option<At>,
}

/// What stands on a line.
#[derive(Debug)]
pub(crate) enum Content {
    Blank,
    /// Text for people that is marked as such: a comment, a note, a known heading.
    Comment,
    /// Text that is read as prose because nothing in it is an instruction.
    Prose,
    Header(Box<Header>),
    Part(Box<PartHead>),
    /// An instruction, by its place among the rows of the file.
    Row(u32),
    Again(Box<AgainLine>),
    /// A line that could not be read; its finding has been reported. What is left tells which row it was meant to be.
    Broken(Option<Box<Stump>>),
}

/// What is left of a row that could not be read.
#[derive(Debug)]
pub(crate) struct Stump {
    pub label: Label,
    pub count: Option<Count>,
}

/// A declaration.
#[derive(Debug)]
pub(crate) enum Header {
    /// `key: value`.
    Pair {
        key: Pair,
        value: At,
    },
    Color {
        name: At,
        value: At,
    },
    Convention {
        settings: Vec<(At, At)>,
    },
    Def {
        name: At,
        works: Num,
        makes: Num,
        text: At,
    },
}

/// The keys of simple headers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pair {
    Title,
    Terms,
    Lang,
    Gauge,
    Lean,
    Yarn,
    Hook,
}

/// The line that opens a part.
#[derive(Debug)]
pub(crate) struct PartHead {
    pub name: At,
    pub copies: Option<Num>,
    pub origin: Origin,
}

/// Where a part comes from.
#[derive(Debug)]
pub(crate) enum Origin {
    Own,
    /// `from Body rnd 2 sts 6-13 held`.
    From {
        name: At,
        spots: Vec<Spot>,
    },
    /// `join Leg + ch 3 + Leg`.
    Join {
        pieces: Vec<Piece>,
    },
}

/// Stitches of one round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Spot {
    pub round: Num,
    pub first: Num,
    /// Less than `first` where they are taken against the direction of the round.
    pub last: Num,
    /// Set aside by a `hold`; else worked around as they stand.
    pub held: bool,
}

/// One piece of a join.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Piece {
    Part(At),
    Chain(Num),
}

/// What a row is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RowKind {
    Rnd,
    Row,
    R,
    None,
}

/// Row numbers: single ones and ranges.
pub(crate) type Numbers = SmallVec<[(Num, Option<Num>); 1]>;

/// `Rnds 7-12 (6 rnds):`.
#[derive(Clone, Debug)]
pub(crate) struct Label {
    pub kind: RowKind,
    /// Single numbers and ranges.
    pub set: Numbers,
    /// What stands in brackets behind the numbers, if anything.
    pub tags: Option<Box<Tags>>,
    pub at: At,
}

/// What stands in brackets behind the numbers of a label.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tags {
    /// `(6 rnds)`.
    pub rounds: Option<Num>,
    pub others: Vec<At>,
}

impl Label {
    /// The first number.
    pub(crate) fn first(&self) -> u32 {
        self.set.first().map_or(0, |(from, _)| from.value)
    }
}

/// The count at the end of a row.
#[derive(Clone, Debug)]
pub(crate) struct Count {
    pub total: Num,
    pub unit: CountUnit,
    /// Further amounts with their unit: `6 dc, 2 ch-sp`; hardly ever any.
    pub others: Box<[(Num, CountUnit)]>,
    pub at: At,
}

impl Count {
    /// All amounts with what they count.
    pub(crate) fn units(&self) -> impl Iterator<Item = (Num, CountUnit)> {
        std::iter::once((self.total, self.unit)).chain(self.others.iter().copied())
    }
}

/// What an amount counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CountUnit {
    Stitches,
    Kind(Spelled),
    Chains,
    Spaces,
    Rounds,
}

/// An instruction.
#[derive(Debug)]
pub(crate) struct RowLine {
    pub label: Option<Label>,
    pub body: Nodes,
    pub count: Option<Count>,
    pub cue: Option<At>,
}

/// `Rows 6-9: rep rows 4 and 5 twice`.
#[derive(Debug)]
pub(crate) struct AgainLine {
    pub label: Option<Label>,
    pub set: Numbers,
    pub times: Option<Num>,
    pub more: bool,
    pub count: Option<Count>,
    pub at: At,
}

/// How a clause is set off from the one before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Sep {
    #[default]
    None,
    Comma,
    Dot,
    And,
}

/// Clauses that stand in a row, among all clauses of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Nodes {
    pub from: u32,
    pub count: u32,
}

impl Nodes {
    /// The clauses themselves, out of all.
    pub(crate) fn of(self, all: &[Node]) -> &[Node] {
        let from = self.from as usize;
        all.get(from..from + self.count as usize).unwrap_or_default()
    }
}

/// A clause with its place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub at: At,
    pub sep: Sep,
    pub what: Clause,
}

/// One clause of a row.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Clause {
    /// `MR 7`, `magic ring, 7 sc`; no number for the ring alone.
    Ring {
        n: Option<Num>,
        word: Option<Word>,
    },
    /// Something in brackets.
    Group {
        brace: u8,
        body: Nodes,
        times: Times,
    },
    /// `*3 sc, inc; rep from * around`.
    Star {
        body: Nodes,
        times: Times,
        to_stop: bool,
    },
    /// Stitches.
    Op(Op),
    /// `and in each ch across`: the stitch just named.
    Again(Place),
    /// `rep around` without a star: the row from its start.
    RepeatAll,
    Loop(Entry),
    Color(At),
    Turn,
    Chain {
        n: Option<Num>,
        counts: Counts,
    },
    Skip {
        n: Option<Num>,
        space: bool,
    },
    Leave {
        n: Num,
    },
    Hold {
        n: Num,
        name: At,
    },
    /// A joining slip stitch.
    Join {
        ring: bool,
    },
    FastenOff,
    DrawShut,
    Marker,
    OtherSide,
    DoNot,
    Mark(Direction),
    /// `**`.
    Stop,
}

/// Whether chains count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Counts {
    Unsaid,
    /// `(counts as dc)`.
    As(Spelled),
    /// `(counts as 3 sts)`.
    Stitches(Num),
    Not,
}

/// How often a group is worked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Times {
    /// Nothing is said.
    Unsaid,
    /// `x 7`, `7 times`.
    N(Num),
    /// `rep from * 3 times`.
    Rep(Num),
    /// `3 more times`.
    More(Num),
    /// `around`.
    Fill(Fill),
    /// `in next st`.
    Place(Place),
}

/// An open end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fill {
    /// `around`, `across`, `to end`, a bare `rep`.
    End,
    /// `to last 3 sts`.
    Last(Num),
}

/// Stitches of one kind.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Op {
    pub entry: Option<Entry>,
    /// The sign of a back pass.
    pub back: Option<At>,
    pub n: Option<Num>,
    pub word: Word,
    pub place: Option<Place>,
    pub evenly: bool,
    pub hue: Option<At>,
}

/// A stitch name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Word {
    /// `None` where only `inc` or `dec` is said.
    pub base: Option<Spelled>,
    pub shape: Shape,
    pub at: At,
}

/// What a stitch name says beside its base.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    Plain,
    /// `inc`, `inc3`.
    Inc(Option<Num>),
    /// `dec`, `dec3`, `invdec`.
    Dec(Option<Num>),
    /// `sc4tog`.
    Tog(Num),
    /// The stitch of the row: `even`.
    Even,
    /// A `def` of the file.
    Def(u16),
    /// A letter for a shaped stitch.
    Letter(Kind, u16, u16),
}

/// Where stitches go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// `in next 9 sts`, `in first st`; the flag is `only`.
    Next(Option<Num>, bool),
    /// `in each of next 9 sts`.
    Each(Num),
    /// `in each st around`.
    EachFill(Fill),
    /// `in every 4th st`.
    EveryNth(Num),
    /// `in last 3 ch`.
    Last(Option<Num>),
    Same,
    SameAsJoin,
    /// `in 2nd ch from hook`; the flag is `starting`.
    FromHook(Num, bool),
    /// `in next ch-1 sp`.
    Space(Option<Num>),
    Ring,
    /// `in 4 held sts`.
    Held(Num),
    TopOfChain,
    /// `over next 2 sts`.
    Over(Num),
    OverChain,
    OverPart(At),
    /// `around`, after a bare stitch.
    Fill(Fill),
}
