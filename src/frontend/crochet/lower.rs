//! A row as written to operations: what its words mean under given conventions, before its open ends are closed.

use super::conventions::{Conventions, Setting};
use super::gather::{JOIN, is_work, tail_count, two_fills};
use super::lex::At;
use super::lines::fold_name;
use super::syntax::{Clause, Count, Fill, Node, Num, Place, Shape, Word};
use super::words::Spelled;
use crate::diag::{Code, Source};
use crate::ir::{Block, Direction, Entry, Kind, Op, PartId, Segment, Stitch, Terms};
use smallvec::SmallVec;
use std::collections::BTreeMap;

/// Why a row has no meaning.
#[derive(Clone, Debug)]
pub(crate) struct Trouble {
    pub code: Code,
    pub at: At,
    pub message: String,
    pub help: Option<String>,
}

impl Trouble {
    pub(crate) fn new(code: Code, at: At, message: impl Into<String>) -> Self {
        Self { code, at, message: message.into(), help: None }
    }
    pub(crate) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

/// Facts of the file that all rows share.
pub(crate) struct File<'f> {
    pub source: &'f Source,
    pub text: &'f str,
    pub terms: Terms,
    pub defs: &'f [super::lines::Definition],
    /// The clauses of all rows.
    pub nodes: &'f [Node],
    pub parts: &'f BTreeMap<String, PartId>,
}

/// What lies below a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Below {
    Nothing,
    /// Loops; their number is known elsewhere.
    Loops,
    Chain {
        chains: u32,
        joined: bool,
    },
}

/// How a row begins its part.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Begin {
    Ring,
    Chain { chains: u32, joined: bool },
}

/// A trial change of the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Change {
    /// Another number.
    Number(At, u32),
    /// `inc` for `dec`, and the other way around.
    Flip(At),
}

/// Where the row stands.
#[derive(Clone, Debug)]
pub(crate) struct Place0<'p> {
    pub below: Below,
    pub flat: bool,
    /// The rounds of the part are joined with a slip stitch.
    pub joined: bool,
    /// The row below began with a chain that counts.
    pub chain_counted: bool,
    pub dominant: Kind,
    pub color: Option<u16>,
    /// Chain spaces of the row below, where they can be told.
    pub spaces: Option<u32>,
    /// Loops behind those of the row below that earlier flat rows left.
    pub beyond: i64,
    pub segments: &'p [(String, Segment)],
}

/// An open end that the loops below decide.
#[derive(Clone, Debug)]
pub(crate) struct Site {
    /// Operation before which it stands.
    pub index: usize,
    pub body: Block,
    /// What the last pass works before its `**`.
    pub partial: Option<Block>,
    /// Loops that must be left for the clauses behind it.
    pub last: Option<Num>,
    pub at: At,
    /// Chain spaces that one pass goes into.
    pub spaces: u32,
    /// Spread this stitch so often among the rest.
    pub even: Option<(Stitch, u32)>,
}

/// A row in operations.
#[derive(Clone, Debug, Default)]
#[expect(clippy::struct_excessive_bools, reason = "independent facts of a row")]
pub(crate) struct Lowered {
    pub block: Block,
    pub site: Option<Box<Site>>,
    pub begin: Option<Begin>,
    /// Chains of the foundation that are worked into, both sides counted.
    pub usable: Option<u32>,
    pub other_side: bool,
    /// Loops may remain.
    pub leave_rest: bool,
    /// Chain spaces that the row goes into, without what an open end adds; `None` where it has none to do with spaces.
    pub spaces: Option<u32>,
    pub shut: bool,
    /// A count that stood as the last clause.
    pub tail: Option<Num>,
    /// Settings that the outcome depends on.
    pub touched: SmallVec<[Setting; 8]>,
    /// A setting that has to be decided first.
    pub undecided: Option<Setting>,
    pub evenly: Option<At>,
    /// Turning chain of three or more of which nothing is said.
    pub silent_chain: Option<At>,
    pub ends_in_turn: bool,
    pub turns: bool,
    pub joins: bool,
    pub chain_counted: bool,
    pub dominant: Option<Kind>,
    pub color: Option<u16>,
    /// Loops before each hold, its number, and the part that takes it.
    pub first_work: Option<At>,
}

/// Lowers one row.
pub(crate) struct Lower<'l> {
    pub file: &'l File<'l>,
    pub conventions: &'l Conventions,
    pub row: &'l Place0<'l>,
    pub colors: &'l mut Vec<String>,
    pub change: Option<Change>,
    pub out: Lowered,
    pub entry: Option<Entry>,
    pub worked: bool,
    pub counted: u32,
    pub last_word: Option<Word>,
    pub direction: Direction,
    pub body: &'l [Node],
    pub segment: usize,
}

impl<'l> Lower<'l> {
    pub(crate) fn new(
        file: &'l File<'l>,
        conventions: &'l Conventions,
        row: &'l Place0<'l>,
        colors: &'l mut Vec<String>,
        change: Option<Change>,
    ) -> Self {
        Self {
            file,
            conventions,
            row,
            colors,
            change,
            out: Lowered { color: row.color, ..Lowered::default() },
            entry: None,
            worked: false,
            counted: 0,
            last_word: None,
            direction: Direction::Forward,
            body: &[],
            segment: 0,
        }
    }

    /// Lowers the clauses of a row.
    pub(crate) fn row(mut self, body: &'l [Node], count: Option<&Count>) -> Result<Lowered, Trouble> {
        self.body = body;
        let work = |node: &Node| is_work(&node.what);
        let first = body.iter().position(work);
        let mut last = body.iter().rposition(work);
        let mut body = body;
        self.out.first_work = first.and_then(|first| body.get(first)).map(|node| node.at);
        if let (Some(index), None) = (last, count)
            && index > first.unwrap_or(index)
            && let Some(tail) = body.get(index).and_then(tail_count)
        {
            self.touch(Setting::TailCount);
            if !self.conventions.is(Setting::TailCount, "stitches") {
                self.out.tail = Some(tail);
                body = body.get(..index).unwrap_or_default();
                last = body.iter().rposition(work);
            }
        }
        let mut block = Block::default();
        if let Some(list) = self.trailing_list(body, first, last) {
            let (lead, list) = list;
            self.each(lead, first, last, &mut block)?;
            let mut fill = Block::default();
            self.counted += 1;
            self.each_inner(list, &mut fill)?;
            self.counted -= 1;
            let at = list
                .iter()
                .fold(At::default(), |at, node| if at.end() == 0 { node.at } else { at.to(node.at) });
            self.site(block.ops().len(), fill, None, None, at)?;
            let after = body.get(lead.len() + list.len()..).unwrap_or_default();
            self.each(after, None, None, &mut block)?;
        } else {
            self.each(body, first, last, &mut block)?;
        }
        self.out.ends_in_turn = body.last().is_some_and(|node| matches!(node.what, Clause::Turn));
        self.out.turns = body.iter().any(|node| matches!(node.what, Clause::Turn));
        self.out.block = block;
        if self.conventions.is(Setting::ImplicitRepeat, "fill") && self.out.site.is_none() {
            self.touch(Setting::ImplicitRepeat);
        }
        Ok(self.out)
    }

    pub(crate) fn touch(&mut self, setting: Setting) {
        if !self.out.touched.contains(&setting) {
            self.out.touched.push(setting);
        }
    }

    /// The value of a setting; where it is `count` the loops have to decide.
    pub(crate) fn decide(&mut self, setting: Setting) -> &'static str {
        self.touch(setting);
        let value = self.conventions.get(setting);
        if value == "count" {
            self.out.undecided = Some(setting);
        }
        value
    }

    /// `6 sc, dec around`, when the whole list fills the row: what leads up to it, and the list.
    fn trailing_list(
        &mut self,
        body: &'l [Node],
        first: Option<usize>,
        last: Option<usize>,
    ) -> Option<(&'l [Node], &'l [Node])> {
        let (first, last) = (first?, last?);
        let Clause::Op(op) = &body.get(last)?.what else { return None };
        if first == last || op.place != Some(Place::Fill(Fill::End)) {
            return None;
        }
        (self.decide(Setting::TrailingAround) == "list")
            .then_some((body.get(..first)?, body.get(first..=last)?))
    }

    /// The inside of a list that fills the row: its last clause is one stitch.
    fn each_inner(&mut self, list: &[Node], out: &mut Block) -> Result<(), Trouble> {
        let Some((last, before)) = list.split_last() else { return Ok(()) };
        self.nodes(before, out)?;
        if let Clause::Op(op) = &last.what {
            let stitch = self.stitch(op.word, op.entry)?;
            self.work(stitch.0, self.number(op.n, 1).saturating_mul(stitch.1), last.at, out);
        }
        Ok(())
    }

    /// The clauses of the row itself.
    fn each(
        &mut self,
        body: &[Node],
        first: Option<usize>,
        last: Option<usize>,
        out: &mut Block,
    ) -> Result<(), Trouble> {
        for (index, node) in body.iter().enumerate() {
            let leading = first.is_none_or(|first| index < first);
            let trailing = last.is_none_or(|last| index > last);
            match &node.what {
                Clause::Turn => {
                    if !leading && !trailing {
                        let to = match self.direction {
                            Direction::Forward => Direction::Back,
                            Direction::Back => Direction::Forward,
                        };
                        self.turn(to, node.at, out);
                    }
                }
                Clause::RepeatAll => {
                    let from = Self::lead(out);
                    let fill = out.split_off(from);
                    self.site(from, fill, None, None, node.at)?;
                }
                Clause::Chain { n, counts } => {
                    let behind = body.iter().skip(index + 1).map(|node| &node.what);
                    let next = behind.into_iter().find(|what| !matches!(what, Clause::Turn));
                    self.chain(*n, *counts, node, leading, trailing, next, out)?;
                }
                Clause::Op(op)
                    if Some(index) == last
                        && index > 0
                        && op.place.is_none()
                        && op.n.is_none()
                        && op.word.shape == Shape::Plain
                        && op.word.base.is_some_and(|base| base.us == Some(Kind::SlSt)) =>
                {
                    self.final_slip(node.at, out);
                }
                _ => self.clause(node, out)?,
            }
        }
        Ok(())
    }

    /// A `sl st` that ends a round.
    fn final_slip(&mut self, at: At, out: &mut Block) {
        let opens_with_chain = matches!(self.body.first().map(|node| &node.what), Some(Clause::Chain { .. }));
        // A row that opens with a chain, or a part whose rounds are joined, leaves no doubt.
        if self.conventions.declared(Setting::FinalSlst) || !(self.row.joined || opens_with_chain) {
            self.touch(Setting::FinalSlst);
        }
        let stitch = match self.conventions.get(Setting::FinalSlst) {
            "stitch" => true,
            "join" => false,
            _ => self.row.flat,
        };
        if stitch {
            self.work(Stitch::plain(Kind::SlSt), 1, at, out);
        } else {
            self.out.joins = true;
            self.push_work(JOIN, 1, at, out);
        }
    }

    /// Operations before the first that works loops.
    fn lead(out: &Block) -> usize {
        out.ops()
            .iter()
            .position(|op| match op {
                Op::Work { stitch, .. } => stitch.kind != Kind::Ch && stitch.works + stitch.makes > 0,
                Op::Repeat { .. } | Op::Hold { .. } | Op::Leave { .. } | Op::Turn(_) => true,
                Op::Color(_) => false,
            })
            .unwrap_or(out.ops().len())
    }

    pub(crate) fn nodes(&mut self, nodes: &[Node], out: &mut Block) -> Result<(), Trouble> {
        for node in nodes {
            match &node.what {
                Clause::Chain { n, counts } => self.chain(*n, *counts, node, false, false, None, out)?,
                Clause::Turn => {
                    let to = if self.direction == Direction::Forward {
                        Direction::Back
                    } else {
                        Direction::Forward
                    };
                    self.turn(to, node.at, out);
                }
                _ => self.clause(node, out)?,
            }
        }
        Ok(())
    }

    fn turn(&mut self, to: Direction, at: At, out: &mut Block) {
        self.direction = to;
        let span = self.span(at);
        out.push(Op::Turn(to), span);
    }

    pub(crate) fn clause(&mut self, node: &Node, out: &mut Block) -> Result<(), Trouble> {
        let at = node.at;
        match &node.what {
            Clause::Ring { n, word } => self.ring(*n, *word, at, out),
            Clause::Group { brace, body, times } => {
                self.group(*brace, body.of(self.file.nodes), *times, at, out)
            }
            Clause::Star { body, times, to_stop } => {
                self.star(body.of(self.file.nodes), *times, *to_stop, at, out)
            }
            Clause::Op(op) => self.op(op, at, out),
            Clause::Again(place) => {
                let Some(word) = self.last_word else {
                    return Err(Trouble::new(
                        Code::MissingOperand,
                        at,
                        "no stitch is named before this place",
                    ));
                };
                self.placed(word, None, Some(*place), None, at, out)
            }
            Clause::RepeatAll => Err(two_fills(at)),
            Clause::Loop(entry) => {
                self.entry = Some(*entry);
                Ok(())
            }
            Clause::Color(name) => {
                self.color(*name, true, out);
                Ok(())
            }
            Clause::Skip { n, space } => {
                if *space {
                    self.enter_space();
                } else {
                    let n = self.number(*n, 1);
                    self.work(Stitch::plain(Kind::Skip), n, at, out);
                }
                Ok(())
            }
            Clause::Leave { n } => {
                let loops = self.num(*n);
                let span = self.span(at);
                out.push(Op::Leave { loops }, span);
                Ok(())
            }
            Clause::Hold { n, name } => {
                let loops = self.num(*n);
                let part = fold_name(self.file.text.get(name.range()).unwrap_or_default());
                let by = self.file.parts.get(&part).copied().unwrap_or(PartId(u32::MAX));
                let span = self.span(at);
                self.worked = true;
                out.push(Op::Hold { loops, by }, span);
                Ok(())
            }
            Clause::Join { ring } => {
                if !self.join_chain(*ring) {
                    self.out.joins = true;
                    self.push_work(JOIN, 1, at, out);
                }
                Ok(())
            }
            Clause::DrawShut => {
                self.out.shut = true;
                Ok(())
            }
            Clause::OtherSide => self.other_side(at),
            Clause::Mark(to) => {
                self.turn(*to, at, out);
                Ok(())
            }
            Clause::Turn
            | Clause::Chain { .. }
            | Clause::FastenOff
            | Clause::Marker
            | Clause::DoNot
            | Clause::Stop => Ok(()),
        }
    }

    /// Work into the free side of the foundation chain.
    fn other_side(&mut self, at: At) -> Result<(), Trouble> {
        let Some(usable) = self.out.usable else {
            return Err(Trouble::new(Code::ChainLength, at, "no chain whose other side could be worked"));
        };
        self.out.other_side = true;
        self.out.usable = Some(usable.saturating_mul(2).saturating_sub(1));
        Ok(())
    }

    /// A slip stitch that closes a chain to a ring.
    fn join_chain(&mut self, ring: bool) -> bool {
        if self.worked {
            return false;
        }
        match &mut self.out.begin {
            Some(Begin::Chain { joined, .. }) => {
                *joined = true;
                return true;
            }
            Some(Begin::Ring) => return false,
            None => {}
        }
        if let Below::Chain { chains, joined: false } = self.row.below
            && (ring || !self.row.flat)
        {
            self.out.begin = Some(Begin::Chain { chains, joined: true });
            return true;
        }
        false
    }

    /// A kind in the terms of the file.
    pub(crate) fn kind(&self, spelled: Spelled, at: At) -> Result<Kind, Trouble> {
        let kind = match self.file.terms {
            Terms::Us => spelled.us,
            Terms::Uk => spelled.uk,
        };
        kind.ok_or_else(|| {
            let (here, there) = if self.file.terms == Terms::Us { ("US", "UK") } else { ("UK", "US") };
            let said = self.file.text.get(at.range()).unwrap_or_default();
            Trouble::new(
                Code::TermsUndecided,
                at,
                format!("`{said}` is a {there} term in a pattern in {here} terms"),
            )
        })
    }
}
