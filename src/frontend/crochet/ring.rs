//! The magic ring, and `MC`, which may mean the magic circle or the main color.

use super::conventions::Setting;
use super::lex::At;
use super::lower::{Begin, Below, Lower, Trouble};
use super::syntax::{Num, Word};
use crate::diag::Code;
use crate::ir::{Block, Stitch};

impl Lower<'_> {
    /// `MR 7`, or the ring alone.
    pub(crate) fn ring(
        &mut self,
        n: Option<Num>,
        word: Option<Word>,
        at: At,
        out: &mut Block,
    ) -> Result<(), Trouble> {
        if self.main_color(at, n.is_some())? {
            let name = At::new(at.start as usize, at.start as usize + 2);
            self.color(name, true, out);
            return match (n, word) {
                (Some(_), Some(word)) => self.placed(word, n, None, None, at, out),
                (Some(n), None) => Err(Trouble::new(Code::MissingOperand, n.at, "a number without a stitch")),
                (None, _) => Ok(()),
            };
        }
        self.need_ring();
        let Some(n) = n else { return Ok(()) };
        let stitch = match word {
            Some(word) => self.stitch(word, None)?.0,
            None => Stitch { entry: self.entry.unwrap_or_default(), ..Stitch::plain(self.dominant()) },
        };
        let count = self.num(n);
        if count == 0 {
            return Err(Trouble::new(Code::MissingOperand, n.at, "0 stitches in the ring"));
        }
        self.work(Stitch { works: 0, ..stitch }, count, at, out);
        Ok(())
    }

    /// True where `MC` is the main color and not the magic circle.
    pub(super) fn main_color(&mut self, at: At, counted: bool) -> Result<bool, Trouble> {
        let said = self.file.text.get(at.range()).unwrap_or_default().as_bytes();
        let short = said.get(..2).is_some_and(|word| word.eq_ignore_ascii_case(b"mc"))
            && !said.get(2).is_some_and(u8::is_ascii_alphabetic);
        if !short {
            return Ok(false);
        }
        self.touch(Setting::Mc);
        match self.conventions.get(Setting::Mc) {
            "ring" => Ok(false),
            "color" => Ok(true),
            _ if self.row.below == Below::Nothing && !self.worked && counted => Ok(false),
            _ if !self.colors.is_empty() => Ok(true),
            _ => Err(Trouble::new(Code::Ambiguous, at, "`MC` may be the magic circle or the main color")
                .help("declare `convention: mc=ring` or `convention: mc=color`, or write `MR`")),
        }
    }

    /// Begins with a ring unless the part already did.
    pub(crate) fn need_ring(&mut self) {
        if self.row.below == Below::Nothing && self.out.begin.is_none() {
            self.out.begin = Some(Begin::Ring);
        }
    }
}
