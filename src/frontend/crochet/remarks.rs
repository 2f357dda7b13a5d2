//! Warnings and notes of rows that fit.

use super::check::{Checker, body_at};
use super::conventions::Setting;
use super::lex::At;
use super::plan::{Item, Part};
use super::solve::Solved;
use super::syntax::{Clause, Content, Node, RowLine};
use crate::diag::{Code, Diagnostic};
use crate::ir;

impl Checker<'_> {
    /// Warnings and notes of a row that fits.
    pub(super) fn remarks(&mut self, part: &Part<'_>, item: &Item<'_>, row: &RowLine, solved: &Solved) {
        let round = item.first;
        if let Some(at) = solved.lowered.silent_chain
            && solved.stated.is_none()
        {
            let found = Diagnostic::new(Code::TurningChainUnsaid, "this chain is not counted as a stitch");
            let help = "say `(counts as dc)` or `(does not count)`, or declare `convention: tch=never`";
            self.say(found.help(help).in_round(&part.name, round), at, "");
        }
        if let Some(at) = solved.lowered.evenly {
            let found = Diagnostic::new(Code::SpreadEvenly, "spread by equal gaps, half a gap at the start");
            self.say(found.in_round(&part.name, round), at, "");
        }
        if solved.lowered.spaces.is_some() {
            let found = Diagnostic::new(
                Code::NotChecked,
                "goes into chain spaces: checked by count, not loop by loop",
            );
            self.say(found.in_round(&part.name, round), body_at(row.body.of(self.file.nodes), item.at), "");
        }
        if solved.left > 0
            && solved.lowered.ends_in_turn
            && !said_leave(row.body.of(self.file.nodes))
            && !solved.lowered.leave_rest
        {
            let message = format!("{} loops remain beyond the turn", solved.left);
            self.say(
                Diagnostic::new(Code::LoopsRemain, message).in_round(&part.name, round),
                body_at(row.body.of(self.file.nodes), item.at),
                "",
            );
        }
        if super::effect::has_turn(&solved.lowered.block) && self.conventions.is(Setting::TurnMark, "bridge")
        {
            let mut direction = ir::Direction::Forward;
            let tight = super::effect::of(&solved.lowered.block, &mut direction, true).is_ok_and(|effect| {
                effect.need_behind > 0 || solved.have.is_some_and(|have| effect.need_ahead > have)
            });
            if tight {
                let found = Diagnostic::new(Code::TurnTight, "the back pass leaves no loop for the turn");
                let help = "it can be worked; the stitch graph of the paper would need one loop more (`convention: turn-mark=bare`)";
                self.say(
                    found.help(help).in_round(&part.name, round),
                    body_at(row.body.of(self.file.nodes), item.at),
                    "",
                );
            }
        }
    }

    /// Tells that the loops decided how a row is read.
    pub(super) fn decided(
        &mut self,
        part: &Part<'_>,
        setting: Setting,
        value: &'static str,
        item: &Item<'_>,
        at: At,
    ) {
        let open = matches!(
            setting,
            Setting::BareBracket
                | Setting::TrailingAround
                | Setting::TailCount
                | Setting::FinalSlst
                | Setting::ImplicitRepeat
        );
        let declare = format!("declare `convention: {}={value}`", setting.name());
        let found = if open {
            Diagnostic::new(
                Code::ReadingByCount,
                format!("read as {}={value}, the only reading that fits", setting.name()),
            )
        } else {
            let usual = self.conventions.get(setting);
            let message = format!(
                "read as {}={value}, not {usual}: only this fits the loops and the count",
                setting.name()
            );
            Diagnostic::new(Code::ReadingOverruled, message).help(declare.clone())
        };
        let found = Diagnostic {
            place: Some(crate::diag::Place { part: part.name.clone(), round: item.first }),
            ..found
        };
        self.say(found, at, "");
        match self.decided.get(&setting) {
            Some(before) if *before != value => {
                let message = format!("{} is read as `{before}` above and as `{value}` here", setting.name());
                self.say(Diagnostic::new(Code::ReadingsMixed, message).help(declare), at, "");
            }
            Some(_) => {}
            None => {
                self.decided.insert(setting, value);
            }
        }
    }

    /// Lines that are kept as text.
    pub(super) fn prose(&mut self) {
        for line in &self.document.tree.lines {
            if matches!(line.what, Content::Prose) {
                let text = self.document.text.get(line.at.range()).unwrap_or_default();
                let lead = text.len() - text.trim_start().len();
                let at =
                    At::new(line.at.start as usize + lead, line.at.start as usize + text.trim_end().len());
                let found = Diagnostic::new(Code::LineKept, "kept as a note: no instruction in it");
                self.say(found, at, "");
            }
        }
    }
}

fn said_leave(body: &[Node]) -> bool {
    body.iter().any(|node| matches!(node.what, Clause::Leave { .. }))
}
