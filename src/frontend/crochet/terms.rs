//! US or UK: the whole file is looked at, for one word alone does not tell.

use super::hints::Hints;
use super::lex::{At, Tok};
use super::syntax::{Clause, Counts, Node, Nodes, Num};
use super::words::Spelled;
use crate::ir::Terms;

/// What the words of a file tell.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Evidence {
    /// The first word that only US patterns have.
    pub us: Option<At>,
    /// The first word that only UK patterns have.
    pub uk: Option<At>,
    /// The first word that means another stitch in each.
    pub open: Option<At>,
}

impl Evidence {
    /// The terms, where they can be told.
    pub(crate) fn terms(self) -> Option<Terms> {
        match (self.us, self.uk, self.open) {
            (None, Some(_), _) => Some(Terms::Uk),
            (Some(_), Some(_), _) | (None, None, Some(_)) => None,
            _ => Some(Terms::Us),
        }
    }

    fn word(&mut self, spelled: Spelled, at: At) {
        match Hints::of(Tok::Stitch(spelled)) {
            Hints::OPEN => self.open = self.open.or(Some(at)),
            Hints::US => self.us = self.us.or(Some(at)),
            Hints::UK => self.uk = self.uk.or(Some(at)),
            _ => {}
        }
    }

    /// True when a line with such words may tell what is not known yet.
    pub(crate) fn wants(self, seen: Hints) -> bool {
        // A phrase may be any stitch; a chain that counts as one tells by its height.
        let any = seen.has(Hints::PHRASE) || seen.has(Hints::COUNTS);
        (any || seen.has(Hints::US)) && self.us.is_none()
            || (any || seen.has(Hints::UK)) && self.uk.is_none()
            || (any || seen.has(Hints::OPEN)) && self.open.is_none()
    }

    /// `ch 3 (counts as dc)`: the chain is as high as the stitch it stands for.
    fn chain(&mut self, n: Option<Num>, counts: Counts, at: At) {
        let (Some(n), Counts::As(Spelled { us: Some(us), uk: Some(uk) })) = (n, counts) else { return };
        let height = |kind: crate::ir::Kind| (kind.height() - f64::from(n.value)).abs() < 0.5;
        if us != uk {
            match (height(us), height(uk)) {
                (true, false) => self.us = self.us.or(Some(at)),
                (false, true) => self.uk = self.uk.or(Some(at)),
                _ => self.open = self.open.or(Some(at)),
            }
        }
    }

    /// Takes the words of a row.
    pub(crate) fn nodes(&mut self, nodes: Nodes, all: &[Node]) {
        for node in nodes.of(all) {
            match &node.what {
                Clause::Op(op) => {
                    if let Some(base) = op.word.base {
                        self.word(base, op.word.at);
                    }
                }
                Clause::Ring { word: Some(word), .. } => {
                    if let Some(base) = word.base {
                        self.word(base, word.at);
                    }
                }
                Clause::Group { body, .. } | Clause::Star { body, .. } => self.nodes(*body, all),
                Clause::Chain { n, counts } => self.chain(*n, *counts, node.at),
                _ => {}
            }
        }
    }
}
