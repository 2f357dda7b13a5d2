//! Phrases of several words that mean one thing: `half double crochet`, `sl st`, `magic ring`, `fasten off`.

use super::lex::{Tok, Token};
use super::words::{Key, Spelled};
use crate::ir::Kind;

/// True for a word that a phrase may begin with.
pub(crate) fn starts_phrase(key: Key) -> bool {
    matches!(
        key,
        Key::Single
            | Key::Half
            | Key::Double
            | Key::Treble
            | Key::Crochet
            | Key::Slip
            | Key::Sl
            | Key::Magic
            | Key::Loop
            | Key::FrontWord
            | Key::BackWord
            | Key::Fasten
            | Key::Place
            | Key::Adjustable
            | Key::Extended
            | Key::Inv
            | Key::Turn
            | Key::Change
            | Key::Evenly
            | Key::Do
            | Key::Does
            | Key::Blo
            | Key::Flo
    )
}

const fn both(us: Kind, uk: Kind) -> Tok {
    Tok::Stitch(Spelled { us: Some(us), uk: Some(uk) })
}

/// Replaces phrases by single tokens, in place and in one sweep.
pub(crate) fn fold(tokens: &mut Vec<Token>) {
    let (mut read, mut write) = (0, 0);
    while let Some(rest) = tokens.get(read..).filter(|rest| !rest.is_empty()) {
        let (taken, tok) = phrase(rest);
        let (Some(first), Some(last)) = (rest.first().copied(), rest.get(taken - 1).copied()) else { break };
        if let Some(tok) = tok
            && let Some(slot) = tokens.get_mut(write)
        {
            *slot = Token { tok, at: first.at.to(last.at), glued: first.glued };
            write += 1;
        }
        read += taken;
    }
    tokens.truncate(write);
}

/// Number of tokens that make up the next phrase, and what they mean together; `None` drops them.
fn phrase(rest: &[Token]) -> (usize, Option<Tok>) {
    let key = |index: usize| match rest.get(index).map(|token| token.tok) {
        Some(Tok::Key(key)) => Some(key),
        _ => None,
    };
    let Some(first) = rest.first() else { return (1, None) };
    let Tok::Key(word) = first.tok else { return (1, Some(first.tok)) };
    match word {
        Key::Single | Key::Half | Key::Double | Key::Treble | Key::Extended => {
            if let Some((taken, tok)) = long_name(&key) {
                return (taken, Some(tok));
            }
        }
        Key::Slip | Key::Sl => {
            let hyphen = usize::from(key(1) == Some(Key::Hyphen));
            match (rest.get(1 + hyphen).map(|token| token.tok), key(1 + hyphen)) {
                (_, Some(Key::St)) => return (2 + hyphen, Some(both(Kind::SlSt, Kind::SlSt))),
                // In a language whose `st` is a stitch of its own.
                (Some(Tok::Stitch(_)), _) if word == Key::Sl => {
                    return (2 + hyphen, Some(both(Kind::SlSt, Kind::SlSt)));
                }
                _ => {}
            }
            if key(1) == Some(Key::Marker) {
                return (2, Some(Tok::Key(Key::Pm)));
            }
        }
        Key::Magic | Key::Adjustable => match key(1) {
            Some(Key::Ring | Key::Loop) => return (2, Some(Tok::Key(Key::Mr))),
            _ => return (1, Some(Tok::Key(Key::Mr))),
        },
        Key::FrontWord | Key::BackWord if key(1) == Some(Key::Loop) => {
            let blo = if word == Key::BackWord { Key::Blo } else { Key::Flo };
            return (2 + usize::from(key(2) == Some(Key::Only)), Some(Tok::Key(blo)));
        }
        Key::FrontWord | Key::BackWord if key(1) == Some(Key::Post) => {
            let after = |index: usize| key(index + 2);
            let base = long_name(&after).or(match rest.get(2).map(|token| token.tok) {
                Some(tok @ Tok::Stitch(_)) => Some((1, tok)),
                _ => None,
            });
            if let Some((taken, Tok::Stitch(spelled))) = base {
                let front = word == Key::FrontWord;
                let post = |kind: Option<Kind>| kind.and_then(|kind| post(kind, front));
                return (
                    2 + taken,
                    Some(Tok::Stitch(Spelled { us: post(spelled.us), uk: post(spelled.uk) })),
                );
            }
        }
        // French puts the adjective last: `boucle arrière`.
        Key::Loop => match key(1) {
            Some(Key::BackWord) => return (2, Some(Tok::Key(Key::Blo))),
            Some(Key::FrontWord) => return (2, Some(Tok::Key(Key::Flo))),
            _ => {}
        },
        Key::Blo | Key::Flo if key(1) == Some(Key::Only) => return (2, Some(first.tok)),
        Key::Fasten if key(1) == Some(Key::Off) => return (2, Some(Tok::Key(Key::Fo))),
        Key::Place if key(1) == Some(Key::Marker) => return (2, Some(Tok::Key(Key::Pm))),
        Key::Inv if matches!(key(1), Some(Key::Dec)) => return (2, Some(Tok::Key(Key::Invdec))),
        Key::Turn if key(1) == Some(Key::Ch) => return (2, Some(Tok::Key(Key::Tch))),
        Key::Change if matches!(key(1), Some(Key::To | Key::For)) => return (2, Some(first.tok)),
        Key::Evenly if key(1) == Some(Key::Spaced) => return (2, Some(first.tok)),
        _ => {}
    }
    (1, Some(first.tok))
}

/// A spelled-out stitch name: `half double crochet`, `double treble`.
fn long_name(key: &dyn Fn(usize) -> Option<Key>) -> Option<(usize, Tok)> {
    let crochet = |index: usize| usize::from(key(index) == Some(Key::Crochet));
    let pair = |us: Option<Kind>, uk: Option<Kind>| Tok::Stitch(Spelled { us, uk });
    Some(match (key(0)?, key(1), key(2)) {
        (Key::Extended, ..) => {
            let inner = |index: usize| key(index + 1);
            let (taken, tok) = long_name(&inner)?;
            let Tok::Stitch(spelled) = tok else { return None };
            let extend = |kind: Option<Kind>| kind.and_then(extended);
            (1 + taken, pair(extend(spelled.us), extend(spelled.uk)))
        }
        (Key::Single, Some(Key::Crochet), _) => (2, pair(Some(Kind::Sc), None)),
        (Key::Half, Some(Key::Double), _) => (2 + crochet(2), pair(Some(Kind::Hdc), None)),
        (Key::Half, Some(Key::Treble), _) => (2 + crochet(2), pair(None, Some(Kind::Hdc))),
        (Key::Double, Some(Key::Treble), _) => (2 + crochet(2), both(Kind::Dtr, Kind::Tr)),
        (Key::Treble, Some(Key::Treble), _) => (2 + crochet(2), both(Kind::Trtr, Kind::Dtr)),
        (Key::Double, Some(Key::Crochet), _) => (2, both(Kind::Dc, Kind::Sc)),
        (Key::Treble, ..) => (1 + crochet(1), both(Kind::Tr, Kind::Dc)),
        _ => return None,
    })
}

fn extended(kind: Kind) -> Option<Kind> {
    [(Kind::Sc, Kind::Esc), (Kind::Hdc, Kind::Ehdc), (Kind::Dc, Kind::Edc), (Kind::Tr, Kind::Etr)]
        .iter()
        .find_map(|(base, extended)| (*base == kind).then_some(*extended))
}

fn post(kind: Kind, front: bool) -> Option<Kind> {
    [
        (Kind::Sc, Kind::Fpsc, Kind::Bpsc),
        (Kind::Hdc, Kind::Fphdc, Kind::Bphdc),
        (Kind::Dc, Kind::Fpdc, Kind::Bpdc),
        (Kind::Tr, Kind::Fptr, Kind::Bptr),
        (Kind::Dtr, Kind::Fpdtr, Kind::Bpdtr),
    ]
    .iter()
    .find_map(|(base, fp, bp)| (*base == kind).then_some(if front { *fp } else { *bp }))
}
