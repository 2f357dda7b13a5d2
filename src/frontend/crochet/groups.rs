//! Brackets and stars to operations: repeats, open ends, and several stitches in one place.

use super::conventions::Setting;
use super::gather::{gather, is_work, space, two_fills};
use super::lex::At;
use super::lower::{Lower, Site, Trouble};
use super::syntax::{Clause, Fill, Node, Num, Place, Times};
use crate::diag::Code;
use crate::ir::{Block, Direction, Kind, Op};

impl Lower<'_> {
    /// A bracket, worked as often as it says.
    pub(crate) fn group(
        &mut self,
        brace: u8,
        body: &[Node],
        times: Times,
        at: At,
        out: &mut Block,
    ) -> Result<(), Trouble> {
        match times {
            Times::Unsaid => {
                let single = body.iter().filter(|node| is_work(&node.what)).count() <= 1;
                let once = brace != b'(' || single || self.decide(Setting::BareBracket) != "one-place";
                if once {
                    let entry = self.entry;
                    self.nodes(body, out)?;
                    self.entry = entry;
                    return Ok(());
                }
                self.gathered(body, Place::Next(None, false), at, out)
            }
            Times::N(n) => self.repeated(body, self.num(n), n.at, at, out),
            Times::Rep(n) => {
                self.touch(Setting::StarTimes);
                let more = u32::from(self.conventions.is(Setting::StarTimes, "more"));
                self.repeated(body, self.num(n).saturating_add(more), n.at, at, out)
            }
            Times::More(n) => self.repeated(body, self.num(n).saturating_add(1), n.at, at, out),
            Times::Fill(fill) => {
                let before = self.out.spaces;
                let block = self.inner(body)?;
                self.fill(fill, block, None, at, out)?;
                self.take_spaces(before);
                Ok(())
            }
            Times::Place(place) => self.gathered(body, place, at, out),
        }
    }

    pub(crate) fn star(
        &mut self,
        body: &[Node],
        times: Times,
        to_stop: bool,
        at: At,
        out: &mut Block,
    ) -> Result<(), Trouble> {
        let stop = body.iter().position(|node| matches!(node.what, Clause::Stop));
        match (stop, times, to_stop) {
            (Some(stop), Times::Fill(fill), true) => {
                let partial = self.inner(body.get(..stop).unwrap_or_default())?;
                let before = self.out.spaces;
                let block = self.inner(body)?;
                self.fill(fill, block, Some(partial), at, out)?;
                self.take_spaces(before);
                Ok(())
            }
            (None, _, true) => {
                Err(Trouble::new(Code::Unbalanced, at, "`ending at **`, but the repeat has no `**`"))
            }
            _ => self.group(b'*', body, times, at, out),
        }
    }

    /// The operations of a repeated body.
    fn inner(&mut self, body: &[Node]) -> Result<Block, Trouble> {
        let (entry, worked, color) = (self.entry, self.worked, self.out.color);
        let mut block = Block::default();
        self.counted += 1;
        let done = self.nodes(body, &mut block);
        self.counted -= 1;
        self.entry = entry;
        if body.iter().any(|node| matches!(node.what, Clause::Color(_))) {
            // The next pass begins in another color than this one did.
            let _ = color;
        }
        let _ = worked;
        done.map(|()| block)
    }

    fn repeated(
        &mut self,
        body: &[Node],
        times: u32,
        number: At,
        at: At,
        out: &mut Block,
    ) -> Result<(), Trouble> {
        if times == 0 {
            return Err(Trouble::new(Code::BadMultiplier, number, "repeated 0 times")
                .help("leave the repeat out, or say how often it is worked"));
        }
        let before = self.out.spaces;
        let block = self.inner(body)?;
        if self.out.spaces != before {
            let own = before.unwrap_or(0);
            let pass = self.out.spaces.unwrap_or(0).saturating_sub(own);
            self.out.spaces = Some(own.saturating_add(pass.saturating_mul(times)));
        }
        if block.is_empty() {
            return Err(Trouble::new(Code::MissingOperand, at, "nothing to repeat"));
        }
        let span = self.span(at);
        if let [Op::Work { stitch, times: once }] = block.ops()
            && let Some(times) = once.checked_mul(times)
        {
            out.push(Op::Work { stitch: *stitch, times }, span);
        } else if times == 1 {
            out.append(block);
        } else {
            out.push(Op::repeat(block, times), span);
        }
        Ok(())
    }

    /// The chain spaces named since `before` belong to the passes of the open end.
    fn take_spaces(&mut self, before: Option<u32>) {
        let all = self.out.spaces.unwrap_or(0);
        if let Some(site) = &mut self.out.site {
            site.spaces = all.saturating_sub(before.unwrap_or(0));
            if self.out.spaces.is_some() {
                self.out.spaces = Some(before.unwrap_or(0));
            }
        }
    }

    /// An open end at this place of the row.
    pub(crate) fn fill(
        &mut self,
        fill: Fill,
        body: Block,
        partial: Option<Block>,
        at: At,
        out: &Block,
    ) -> Result<(), Trouble> {
        if self.counted > 0 {
            return Err(two_fills(at));
        }
        let last = match fill {
            Fill::End => None,
            Fill::Last(n) => Some(n),
        };
        self.site(out.ops().len(), body, partial, last, at)
    }

    pub(crate) fn site(
        &mut self,
        index: usize,
        body: Block,
        partial: Option<Block>,
        last: Option<Num>,
        at: At,
    ) -> Result<(), Trouble> {
        if self.out.site.is_some() || self.direction == Direction::Back {
            return Err(two_fills(at));
        }
        self.worked = true;
        self.out.site = Some(Box::new(Site { index, body, partial, last, at, spaces: 0, even: None }));
        Ok(())
    }

    /// Several stitches in one place.
    fn gathered(&mut self, body: &[Node], place: Place, at: At, out: &mut Block) -> Result<(), Trouble> {
        let mut block = self.inner(body)?;
        let first = match place {
            Place::Space(_) => {
                self.enter_space();
                block = space(&block);
                0
            }
            Place::Ring => {
                self.need_ring();
                0
            }
            Place::Same | Place::SameAsJoin => u16::from(!self.worked),
            Place::TopOfChain => u16::from(self.row.chain_counted),
            Place::FromHook(n, _) => {
                self.enter_chain(n, Kind::Dc, at, out)?;
                1
            }
            _ => 1,
        };
        let Some(gathered) = gather(&block, first) else {
            return Err(Trouble::new(
                Code::Leftover,
                at,
                "loops are skipped or turned over inside of one stitch",
            )
            .help("list only stitches and chains in a bracket that goes into one place"));
        };
        self.worked = true;
        match place {
            Place::Each(n) | Place::Over(n) | Place::Held(n) => {
                self.push_repeat(gathered, self.num(n), at, out);
            }
            Place::Next(n, _) | Place::Last(n) => self.push_repeat(gathered, self.number(n, 1), at, out),
            Place::EachFill(fill) | Place::Fill(fill) => return self.fill(fill, gathered, None, at, out),
            Place::EveryNth(_) | Place::OverChain | Place::OverPart(_) => {
                return Err(Trouble::new(Code::Leftover, at, "a bracket goes into a stitch, not there"));
            }
            _ => out.append(gathered),
        }
        Ok(())
    }

    fn push_repeat(&mut self, body: Block, times: u32, at: At, out: &mut Block) {
        let span = self.span(at);
        if times == 1 { out.append(body) } else { out.push(Op::repeat(body, times), span) }
    }
}
