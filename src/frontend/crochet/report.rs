//! Faults of single lines as diagnostics.

use super::lex::{At, Tok};
use super::lines::LineFault;
use super::parse::FaultKind;
use super::words::{Key, Words};
use crate::diag::{Code, Diagnostic, Edit, Fix, Source, did_you_mean};

pub(crate) fn line_fault(fault: &LineFault, source: &Source, text: &str, words: &Words) -> Diagnostic {
    let span = |at: At| source.span(at.range());
    match fault {
        LineFault::Character(at) => {
            let c = text.get(at.range()).and_then(|text| text.chars().next()).unwrap_or('\0');
            let message = format!("character U+{:04X} does not belong into a pattern", c as u32);
            Diagnostic::new(Code::BadText, message).at(span(*at), "").help("remove it")
        }
        LineFault::Long(at) => {
            let message = format!("a line longer than {} bytes", super::lines::MAX_LINE);
            Diagnostic::new(Code::Limit, message).at(span(*at), "").help("write one round a line")
        }
        LineFault::Header { at, what } => {
            Diagnostic::new(Code::BadHeader, format!("expected {what}")).at(span(*at), "")
        }
        LineFault::Syntax { kind, token, line } => syntax(*kind, *token, *line, source, text, words),
    }
}

fn syntax(
    kind: FaultKind,
    token: Option<(Tok, At)>,
    line: At,
    source: &Source,
    text: &str,
    words: &Words,
) -> Diagnostic {
    let span = |at: At| source.span(at.range());
    let trimmed = text.get(line.range()).map_or(0, |line| line.trim_end().len());
    let end = At::new(line.start as usize + trimmed, line.start as usize + trimmed);
    if let Some((Tok::Word | Tok::Key(Key::Tunisian), at)) = token
        && !matches!(kind, FaultKind::Deep(_))
    {
        return unknown(at, token, source, text, words);
    }
    let at = token.map_or(end, |(_, at)| at);
    match kind {
        FaultKind::Unbalanced(open) => {
            let mark = text.get(open.range()).unwrap_or("(");
            Diagnostic::new(Code::Unbalanced, format!("`{mark}` is never closed"))
                .at(span(open), "opened here")
                .help("close the bracket behind what is repeated")
        }
        FaultKind::Star(at) if text.get(at.range()) == Some("*") => {
            Diagnostic::new(Code::Unbalanced, "`*` without `rep from *`")
                .at(span(at), "the repeat begins here")
                .help("say how often: `*3 sc, inc; rep from * around`")
        }
        FaultKind::Star(at) => Diagnostic::new(Code::Unbalanced, "`rep from *` without a `*` before it")
            .at(span(at), "")
            .help("put a `*` where the repeat begins"),
        FaultKind::Multiplier(at) => Diagnostic::new(Code::BadMultiplier, "a multiplier without its number")
            .at(span(at), "")
            .help("say how often: `x 6`"),
        FaultKind::TwoMultipliers(at) => Diagnostic::new(Code::BadMultiplier, "a multiplier on both sides")
            .at(span(at), "")
            .help("keep one of them"),
        FaultKind::NoStitch(at) => Diagnostic::new(Code::MissingOperand, "a number without a stitch")
            .at(span(at), "of what?")
            .help("name the stitch: `3 sc`"),
        FaultKind::Deep(at) => {
            let message = format!("brackets nest deeper than {}", crate::ir::MAX_NESTING);
            Diagnostic::new(Code::Limit, message).at(span(at), "")
        }
        FaultKind::Expected(what) => expected(what, token, at, source, text),
    }
}

fn expected(what: &str, token: Option<(Tok, At)>, at: At, source: &Source, text: &str) -> Diagnostic {
    let span = source.span(at.range());
    let said = text.get(at.range()).unwrap_or_default();
    match token {
        None => Diagnostic::new(Code::MissingOperand, format!("the line ends where {what} should follow"))
            .at(span, ""),
        Some((Tok::Key(Key::Close(_)), _)) => {
            Diagnostic::new(Code::Unbalanced, format!("`{said}` closes nothing that is open, or too early"))
                .at(span, "")
                .help(format!("expected {what}"))
        }
        Some((Tok::Key(Key::Star), _)) => Diagnostic::new(Code::Unbalanced, "`*` without its partner")
            .at(span, "")
            .help(format!("expected {what}")),
        Some((Tok::Key(Key::Other), _)) => {
            Diagnostic::new(Code::UnknownTerm, format!("`{said}` means nothing here")).at(span, "")
        }
        Some((Tok::Key(Key::Times), _)) => {
            Diagnostic::new(Code::BadMultiplier, format!("`{said}` multiplies nothing")).at(span, "")
        }
        Some((Tok::Int(_) | Tok::Ord(_), _)) => {
            Diagnostic::new(Code::Leftover, format!("`{said}` stands where {what} should follow"))
                .at(span, "")
        }
        Some((Tok::Key(Key::Comma | Key::Semi | Key::Dot | Key::Colon | Key::Dash), _)) => {
            Diagnostic::new(Code::MissingOperand, format!("`{said}` where {what} should stand")).at(span, "")
        }
        Some(_) => {
            Diagnostic::new(Code::Leftover, format!("`{said}` where {what} should stand")).at(span, "")
        }
    }
}

fn unknown(at: At, token: Option<(Tok, At)>, source: &Source, text: &str, words: &Words) -> Diagnostic {
    let span = source.span(at.range());
    let said = text.get(at.range()).unwrap_or_default();
    if let Some((Tok::Key(Key::Tunisian), _)) = token {
        return Diagnostic::new(Code::UnknownTerm, format!("Tunisian crochet (`{said}`) is not supported"))
            .at(span, "")
            .help("only ordinary crochet is read");
    }
    let short: String = said.chars().take(40).collect();
    let found = Diagnostic::new(Code::UnknownTerm, format!("`{short}` is not known")).at(span, "");
    let folded = super::words::fold_word(&short);
    let near = did_you_mean(&folded, words.stitch_words()).or_else(|| did_you_mean(&folded, words.known()));
    match near {
        Some(near) => found.help(format!("did you mean `{near}`?")).fix(Fix {
            title: format!("write `{near}`"),
            edits: vec![Edit { span, replacement: near.to_owned() }],
            certain: false,
        }),
        None => found.help(format!(
            "a stitch of your own is declared as `def {folded} = 1 -> 1`; a remark goes behind `//`"
        )),
    }
}
