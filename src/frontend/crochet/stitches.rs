//! Stitches and chains of a row to operations: which stitch, how often, in which place.

use super::conventions::Setting;
use super::lex::At;
use super::lower::{Begin, Below, Change, Lower, Trouble};
use super::syntax::{Clause, Counts, Node, Num, Op as OpClause, Place, Shape, Word};
use crate::diag::{Code, Span};
use crate::ir::{Block, Direction, Entry, Kind, Op, Segment, Stitch};

/// Kinds that an `inc` or `dec` without a name may be made of.
const BASIC: [Kind; 6] = [Kind::Sc, Kind::Hdc, Kind::Dc, Kind::Tr, Kind::Dtr, Kind::Trtr];

impl Lower<'_> {
    pub(crate) fn span(&self, at: At) -> Span {
        self.file.source.span(at.range())
    }

    /// Notes that the row goes into one more chain space.
    pub(crate) fn enter_space(&mut self) {
        self.out.spaces = Some(self.out.spaces.unwrap_or(0).saturating_add(1));
    }

    /// A number of the text, or what a trial puts in its place.
    pub(crate) fn num(&self, n: Num) -> u32 {
        match self.change {
            Some(Change::Number(at, value)) if at == n.at => value,
            _ => n.value,
        }
    }

    pub(crate) fn number(&self, n: Option<Num>, or: u32) -> u32 {
        n.map_or(or, |n| self.num(n))
    }

    pub(crate) fn work(&mut self, stitch: Stitch, times: u32, at: At, out: &mut Block) {
        self.worked = true;
        self.push_work(stitch, times, at, out);
    }

    pub(crate) fn push_work(&mut self, stitch: Stitch, times: u32, at: At, out: &mut Block) {
        if times > 0 {
            let span = self.span(at);
            out.push(Op::Work { stitch, times }, span);
        }
    }

    /// Changes the color; `always` writes a step even where it does not change.
    pub(crate) fn color(&mut self, name: At, always: bool, out: &mut Block) {
        let said = self.file.text.get(name.range()).unwrap_or_default().trim_matches('"');
        let known = self.colors.iter().position(|color| color.eq_ignore_ascii_case(said));
        let index = known.unwrap_or_else(|| {
            self.colors.push(said.to_owned());
            self.colors.len() - 1
        });
        let color = index.min(usize::from(u16::MAX)) as u16;
        if always || self.out.color != Some(color) {
            let span = self.span(name);
            out.push(Op::Color(color), span);
        }
        self.out.color = Some(color);
    }

    /// The stitch that `inc`, `dec` and `even` are made of.
    pub(crate) fn dominant(&mut self) -> Kind {
        if let Some(kind) = self.out.dominant {
            return kind;
        }
        self.touch(Setting::ShapingHeight);
        let kind = if self.conventions.is(Setting::ShapingHeight, "sc") {
            Kind::Sc
        } else {
            let mut counts = [0_u64; BASIC.len()];
            self.count_basic(self.body, &mut counts);
            let most = counts.iter().copied().max().unwrap_or(0);
            let index = counts.iter().position(|count| *count == most && most > 0);
            index.and_then(|index| BASIC.get(index).copied()).unwrap_or(self.row.dominant)
        };
        self.out.dominant = Some(kind);
        kind
    }

    fn count_basic(&self, nodes: &[Node], counts: &mut [u64; BASIC.len()]) {
        for node in nodes {
            match &node.what {
                Clause::Op(op) => {
                    let kind = op.word.base.and_then(|base| self.kind(base, op.word.at).ok());
                    if let Some(index) = kind.and_then(|kind| BASIC.iter().position(|basic| *basic == kind))
                        && let Some(count) = counts.get_mut(index)
                    {
                        *count += u64::from(self.number(op.n, 1));
                    }
                }
                Clause::Group { body, .. } | Clause::Star { body, .. } => {
                    self.count_basic(body.of(self.file.nodes), counts);
                }
                _ => {}
            }
        }
    }

    /// The stitch of a word, and how often one mention stands for it.
    pub(crate) fn stitch(&mut self, word: Word, entry: Option<Entry>) -> Result<(Stitch, u32), Trouble> {
        let entry = entry.or(self.entry).unwrap_or_default();
        if let (Shape::Plain, Some(base)) = (word.shape, word.base) {
            let kind = self.kind(base, word.at)?;
            return Ok((Stitch { kind, works: kind.works(), makes: kind.makes(), entry }, 1));
        }
        let base = match word.base {
            Some(base) => Some(self.kind(base, word.at)?),
            None => None,
        };
        let narrow = |n: u32| {
            u16::try_from(n)
                .map_err(|_| Trouble::new(Code::Limit, word.at, format!("{n} stitches in one place")))
        };
        let flipped = self.change == Some(Change::Flip(word.at));
        let shape = match (word.shape, flipped) {
            (Shape::Inc(n), true) => Shape::Dec(n),
            (Shape::Dec(n), true) => Shape::Inc(n),
            (shape, _) => shape,
        };
        let (kind, works, makes, times) = match shape {
            Shape::Plain => {
                let kind = base.unwrap_or(Kind::Sc);
                (kind, kind.works(), kind.makes(), 1)
            }
            Shape::Even => {
                let kind = self.dominant();
                (kind, 1, 1, 1)
            }
            Shape::Inc(n) | Shape::Dec(n) => {
                let kind = match base {
                    Some(kind) => kind,
                    None => self.dominant(),
                };
                let inc = matches!(shape, Shape::Inc(_));
                let (wide, times) = match n {
                    None => (2, 1),
                    Some(n) => {
                        self.touch(Setting::IncGlued);
                        let value = self.num(n);
                        if self.conventions.is(Setting::IncGlued, "times") {
                            (2, value)
                        } else {
                            (narrow(value)?, 1)
                        }
                    }
                };
                if wide == 0 || times == 0 {
                    return Err(Trouble::new(Code::MissingOperand, word.at, "a stitch made of nothing"));
                }
                if inc { (kind, 1, wide, times) } else { (kind, wide, 1, times) }
            }
            Shape::Tog(n) => {
                let wide = narrow(self.num(n))?;
                if wide == 0 {
                    return Err(Trouble::new(Code::MissingOperand, word.at, "nothing worked together"));
                }
                (base.unwrap_or(Kind::Sc), wide, 1, 1)
            }
            Shape::Def(index) => {
                let Some(def) = self.file.defs.get(usize::from(index)) else {
                    return Err(Trouble::new(Code::UnknownTerm, word.at, "a stitch that is not declared"));
                };
                let kind = def.base.map_or(Ok(Kind::Special), |base| self.kind(base, word.at))?;
                (kind, def.works, def.makes, 1)
            }
            Shape::Letter(kind, works, makes) => (kind, works, makes, 1),
        };
        Ok((Stitch { kind, works, makes, entry }, times))
    }

    pub(crate) fn op(&mut self, op: &OpClause, at: At, out: &mut Block) -> Result<(), Trouble> {
        if let Some(sign) = op.back
            && self.direction == Direction::Forward
        {
            return Err(Trouble::new(
                Code::StrayBackSign,
                sign,
                "the sign of a back pass, but the hook works forward",
            )
            .help("put `<-` before the back pass and `->` behind it"));
        }
        self.last_word = Some(op.word);
        if let Some(hue) = op.hue {
            self.color(hue, false, out);
        }
        if op.evenly {
            return self.evenly(op, at, out);
        }
        match op.place {
            Some(_) => self.placed(op.word, op.n, op.place, op.entry, at, out),
            None => self.in_turn(op.word, op.n, op.entry, at, out),
        }
    }

    /// Stitches in the loops that come next.
    fn in_turn(
        &mut self,
        word: Word,
        n: Option<Num>,
        entry: Option<Entry>,
        at: At,
        out: &mut Block,
    ) -> Result<(), Trouble> {
        let (stitch, each) = self.stitch(word, entry)?;
        let count = self.number(n, 1);
        if count == 0 {
            return Err(nothing(n, at));
        }
        if count > 1 && word.shape == Shape::Plain && stitch.works == 1 && stitch.makes == 1 {
            self.touch(Setting::NStitch);
            if self.conventions.is(Setting::NStitch, "one-place") {
                self.work(fan(stitch, count, at)?, 1, at, out);
                return Ok(());
            }
        }
        self.work(stitch, count.saturating_mul(each), at, out);
        Ok(())
    }

    /// Stitches in a place.
    #[expect(clippy::too_many_lines, reason = "one arm a kind of place")]
    pub(crate) fn placed(
        &mut self,
        word: Word,
        n: Option<Num>,
        place: Option<Place>,
        entry: Option<Entry>,
        at: At,
        out: &mut Block,
    ) -> Result<(), Trouble> {
        let Some(place) = place else { return self.in_turn(word, n, entry, at, out) };
        let (stitch, each) = self.stitch(word, entry)?;
        let count = self.number(n, 1);
        if count == 0 {
            return Err(nothing(n, at));
        }
        let plain = word.shape == Shape::Plain && stitch.works == 1 && stitch.makes == 1;
        let times = count.saturating_mul(each);
        let fan = |count: u32| fan(stitch, count, at);
        match place {
            Place::Next(m, only) => {
                self.out.leave_rest |= only;
                let m_value = self.number(m, 1);
                self.next_loops(
                    stitch,
                    n,
                    m,
                    plain && !(m.is_some() && count == m_value && count > 1),
                    at,
                    out,
                )?;
            }
            Place::Last(m) => self.next_loops(stitch, n, m, plain, at, out)?,
            Place::Each(m) | Place::Held(m) => self.next_loops(stitch, n, Some(m), plain, at, out)?,
            Place::EachFill(end) | Place::Fill(end) => {
                let each_one = matches!(place, Place::EachFill(_));
                let (stitch, times) =
                    if each_one && plain && count > 1 { (fan(count)?, 1) } else { (stitch, times) };
                let span = self.span(at);
                let mut block = Block::default();
                block.push(Op::Work { stitch, times }, span);
                return self.fill(end, block, None, at, out);
            }
            Place::EveryNth(nth) => {
                let nth_value = self.num(nth);
                if stitch.works != 1 || nth_value < 2 {
                    return Err(Trouble::new(Code::Ambiguous, at, "which stitches this takes is not clear")
                        .help("write the repeat out: `(3 sc, inc) around`"));
                }
                let base = Stitch::plain(stitch.kind);
                let span = self.span(at);
                let mut block = Block::default();
                block.push(Op::Work { stitch: base, times: nth_value - 1 }, span);
                block.push(Op::Work { stitch, times: 1 }, span);
                return self.fill(super::syntax::Fill::End, block, None, at, out);
            }
            Place::Same | Place::SameAsJoin => {
                if self.worked {
                    self.work(Stitch { works: 0, ..stitch }, times, at, out);
                } else {
                    let stitch = if plain { fan(count)? } else { stitch };
                    self.work(stitch, if plain { 1 } else { times }, at, out);
                }
            }
            Place::FromHook(k, starting) => {
                if !starting && count > 1 && self.is_fan(k) {
                    self.out.begin = Some(Begin::Ring);
                    self.work(Stitch { works: 0, ..stitch }, times, at, out);
                    return Ok(());
                }
                self.enter_chain(k, stitch.kind, at, out)?;
                if starting || !plain {
                    self.work(stitch, times, at, out);
                } else {
                    let stitch = fan(count)?;
                    self.work(stitch, 1, at, out);
                }
            }
            Place::Space(_) => {
                self.enter_space();
                self.work(Stitch { works: 0, entry: Entry::Space, ..stitch }, times, at, out);
            }
            Place::Ring => {
                if stitch.works > 1 {
                    let message = "a decrease in a ring has no stitches to work together";
                    return Err(Trouble::new(Code::NoFoundation, at, message));
                }
                // `6 sc in MC` on loops may mean the main color.
                let tail = At::new(at.end().saturating_sub(2).max(at.start) as usize, at.end() as usize);
                let worked = self.row.below != Below::Nothing && self.out.begin.is_none();
                if worked && self.main_color(tail, false)? {
                    self.color(tail, false, out);
                    self.work(stitch, times, at, out);
                    return Ok(());
                }
                self.need_ring();
                self.work(Stitch { works: 0, ..stitch }, times, at, out);
            }
            Place::TopOfChain => {
                let works = u16::from(self.row.chain_counted);
                let stitch = if plain { fan(count)? } else { stitch };
                self.work(Stitch { works, ..stitch }, 1, at, out);
            }
            Place::Over(m) => {
                let m = self.num(m);
                let over = Self::divide(stitch, m, at)?;
                self.work(stitch, over, at, out);
            }
            Place::OverChain => self.over(None, stitch, n, times, at, out)?,
            Place::OverPart(name) => self.over(Some(name), stitch, n, times, at, out)?,
        }
        Ok(())
    }

    /// Stitches in the next loops: `n` in each of `m`.
    fn next_loops(
        &mut self,
        stitch: Stitch,
        n: Option<Num>,
        m: Option<Num>,
        plain: bool,
        at: At,
        out: &mut Block,
    ) -> Result<(), Trouble> {
        let (count, loops) = (self.number(n, 1), self.number(m, 1));
        if loops == 0 {
            return Err(Trouble::new(
                Code::MissingOperand,
                m.map_or(at, |m| m.at),
                "0 stitches to work into",
            ));
        }
        if plain {
            let makes = u16::try_from(count)
                .map_err(|_| Trouble::new(Code::Limit, at, format!("{count} stitches in one place")))?;
            self.work(Stitch { makes, ..stitch }, loops, at, out);
        } else {
            let times =
                if m.is_some() && stitch.works > 0 { Self::divide(stitch, loops, at)? } else { count };
            self.work(stitch, times, at, out);
        }
        Ok(())
    }

    /// How often a stitch fits over some loops.
    fn divide(stitch: Stitch, loops: u32, at: At) -> Result<u32, Trouble> {
        let works = u32::from(stitch.works.max(1));
        if loops == 0 || !loops.is_multiple_of(works) {
            return Err(Trouble::new(
                Code::Indivisible,
                at,
                format!("a stitch over {works} loops does not fit {loops}"),
            )
            .help(format!("it fits a multiple of {works}")));
        }
        Ok(loops / works)
    }

    /// Stitches over the loops of one joined piece.
    fn over(
        &mut self,
        name: Option<At>,
        stitch: Stitch,
        n: Option<Num>,
        times: u32,
        at: At,
        out: &mut Block,
    ) -> Result<(), Trouble> {
        let said =
            name.map(|name| super::lines::fold_name(self.file.text.get(name.range()).unwrap_or_default()));
        let Some((piece, segment)) = self.row.segments.get(self.segment) else {
            return Err(Trouble::new(Code::JoinLoops, at, "no joined piece is left to work over")
                .help("`over` works the pieces of a joined part in the order of its first line"));
        };
        let chain = matches!(segment, Segment::Chain { .. });
        let fits = said.as_ref().map_or(chain, |said| !chain && said == piece);
        if !fits {
            let next = if chain { "the chain".to_owned() } else { format!("`{piece}`") };
            return Err(Trouble::new(Code::JoinLoops, at, format!("the next piece is {next}")));
        }
        let loops = segment.loops();
        let works = u32::from(stitch.works.max(1));
        let times = if n.is_none() && times == 1 { Self::divide(stitch, loops, at)? } else { times };
        if times.saturating_mul(works) != loops {
            let message = format!("works {} of the {loops} loops of the piece", times.saturating_mul(works));
            return Err(Trouble::new(Code::JoinLoops, at, message).help("`over` uses up a whole piece"));
        }
        self.segment += 1;
        self.work(stitch, times, at, out);
        Ok(())
    }

    /// `4 dec evenly spaced`.
    fn evenly(&mut self, op: &OpClause, at: At, out: &mut Block) -> Result<(), Trouble> {
        self.touch(Setting::Evenly);
        if self.conventions.is(Setting::Evenly, "refuse") {
            return Err(
                Trouble::new(Code::Ambiguous, at, "`evenly` does not say where").help("write the repeat out")
            );
        }
        let (stitch, each) = self.stitch(op.word, op.entry)?;
        let count = self.number(op.n, 1).saturating_mul(each);
        if count == 0 || count > crate::ir::MAX_ROW {
            return Err(Trouble::new(Code::MissingOperand, at, format!("{count} stitches to spread")));
        }
        self.out.evenly = Some(at);
        self.worked = true;
        let plain = match out.ops().last() {
            Some(Op::Work { stitch, times }) if stitch.works == 1 && stitch.makes == 1 => {
                Some((*stitch, *times))
            }
            _ => None,
        };
        if let Some((base, times)) = plain {
            let _ = out.split_off(out.ops().len() - 1);
            let span = self.span(at);
            spread(base, times, stitch, count, span, out);
            return Ok(());
        }
        let base = Stitch::plain(self.dominant());
        let span = self.span(at);
        let mut body = Block::default();
        body.push(Op::Work { stitch: base, times: 1 }, span);
        self.fill(super::syntax::Fill::End, body, None, at, out)?;
        if let Some(site) = &mut self.out.site {
            site.even = Some((stitch, count));
        }
        Ok(())
    }

    /// Chains of the foundation that this row works into, if it has one.
    fn foundation(&self) -> Option<u32> {
        match (&self.out.begin, &self.row.below) {
            (Some(Begin::Chain { chains, .. }), _) | (None, Below::Chain { chains, .. }) => Some(*chains),
            _ => None,
        }
    }

    fn is_fan(&self, k: Num) -> bool {
        self.foundation() == Some(self.num(k))
    }

    /// The first stitch into a chain leaves out the chains at the hook.
    pub(crate) fn enter_chain(&mut self, k: Num, kind: Kind, at: At, out: &mut Block) -> Result<(), Trouble> {
        let Some(chains) = self.foundation() else {
            return Err(
                Trouble::new(Code::NoFoundation, at, "no chain to work into").help("begin with `ch N`")
            );
        };
        let skipped = self.num(k);
        if skipped == 0 || skipped > chains || self.worked {
            let message =
                format!("the chain has {chains} chains, and this is the one {skipped} from the hook");
            return Err(Trouble::new(Code::ChainLength, at, message));
        }
        self.out.usable = Some(chains - skipped + 1);
        if kind != Kind::Sc && skipped > 1 {
            self.touch(Setting::FoundationSkip);
            if self.conventions.is(Setting::FoundationSkip, "counted") {
                let chain = Stitch { makes: 1, ..Stitch::plain(Kind::Ch) };
                self.push_work(chain, 1, at, out);
                self.out.chain_counted = true;
            }
        }
        Ok(())
    }

    #[expect(clippy::too_many_arguments, reason = "a chain means what stands around it")]
    /// Chains: a foundation, a turning chain, or chains between stitches.
    pub(crate) fn chain(
        &mut self,
        n: Option<Num>,
        counts: Counts,
        node: &Node,
        leading: bool,
        trailing: bool,
        next: Option<&Clause>,
        out: &mut Block,
    ) -> Result<(), Trouble> {
        let chains = self.number(n, 1);
        let at = node.at;
        if chains == 0 {
            return Err(Trouble::new(Code::MissingOperand, at, "a chain of nothing"));
        }
        if self.row.below == Below::Nothing && self.out.begin.is_none() {
            self.out.begin = Some(Begin::Chain { chains, joined: false });
            return Ok(());
        }
        let plain = Stitch::plain(Kind::Ch);
        let starts = (leading || !self.worked) && self.counted == 0;
        match counts {
            Counts::Not => self.push_work(plain, chains, at, out),
            Counts::Stitches(k) => {
                let made = self.num(k);
                self.worked = true;
                self.push_work(plain, chains.saturating_sub(made), at, out);
                self.push_work(Stitch { makes: 1, ..plain }, made, at, out);
            }
            Counts::As(_) => self.standing(chains, starts, next, at, out),
            Counts::Unsaid if starts => {
                if chains >= 2 {
                    self.touch(Setting::Tch);
                }
                if chains >= 2 && self.conventions.is(Setting::Tch, "counts") {
                    self.standing(chains, true, next, at, out);
                } else {
                    if chains >= 3 && !self.conventions.declared(Setting::Tch) {
                        self.out.silent_chain = Some(at);
                    }
                    self.push_work(plain, chains, at, out);
                }
            }
            Counts::Unsaid if trailing => self.push_work(plain, chains, at, out),
            Counts::Unsaid => {
                self.touch(Setting::ChSp);
                let makes = u16::from(self.conventions.is(Setting::ChSp, "chains"));
                self.push_work(Stitch { makes, ..plain }, chains, at, out);
            }
        }
        Ok(())
    }

    /// A chain that stands for a stitch.
    fn standing(&mut self, chains: u32, starts: bool, next: Option<&Clause>, at: At, out: &mut Block) {
        let plain = Stitch::plain(Kind::Ch);
        // In a ring, and before a stitch that is skipped for it, the chain works no loop.
        let skipped = matches!(next, Some(Clause::Skip { space: false, .. }));
        let works = u16::from(starts && !skipped && self.row.below != Below::Nothing);
        self.worked = true;
        self.out.chain_counted |= starts;
        self.push_work(plain, chains.saturating_sub(1), at, out);
        self.push_work(Stitch { works, makes: 1, ..plain }, 1, at, out);
    }
}

fn nothing(n: Option<Num>, at: At) -> Trouble {
    Trouble::new(Code::MissingOperand, n.map_or(at, |n| n.at), "0 stitches")
        .help("leave the clause out, or say how many")
}

/// So many of a stitch in one place.
fn fan(stitch: Stitch, count: u32, at: At) -> Result<Stitch, Trouble> {
    u16::try_from(count)
        .map(|makes| Stitch { makes, ..stitch })
        .map_err(|_| Trouble::new(Code::Limit, at, format!("{count} stitches in one place")))
}

/// Spreads `count` stitches among `times` others by equal gaps, half a gap at the start.
pub(crate) fn spread(base: Stitch, times: u32, stitch: Stitch, count: u32, span: Span, out: &mut Block) {
    let place = |index: u32| {
        let doubled = (2 * u64::from(index) + 1) * u64::from(times);
        (doubled / (2 * u64::from(count.max(1)))) as u32
    };
    let mut done = 0;
    for index in 0..count {
        let until = place(index);
        if until > done {
            out.push(Op::Work { stitch: base, times: until - done }, span);
        }
        out.push(Op::Work { stitch, times: 1 }, span);
        done = until;
    }
    if times > done {
        out.push(Op::Work { stitch: base, times: times - done }, span);
    }
}
