//! The canonical form of a pattern, printed from its tree: comments, notes and what could not be read stay as they are.

use super::Document;
use super::lex::At;
use super::lines::Tree;
use super::syntax::{
    AgainLine, Clause, Content, Count, CountUnit, Counts, Fill, Header, Label, Node, Nodes, Num, Op, Origin,
    Pair, Place, RowKind, RowLine, Shape, Times, Word,
};
use super::words::Spelled;
use crate::ir::{Direction, Entry, Kind, Language, Terms};
use std::fmt::Write;

impl Document<'_> {
    /// The text in canonical form. Formatting it again changes nothing.
    pub fn format(&self) -> String {
        let printer = Printer { text: self.text, tree: &self.tree };
        let mut out = String::with_capacity(self.text.len() + self.text.len() / 8);
        let mut blank = true;
        for line in &self.tree.lines {
            let start = out.len();
            printer.line(line, &mut out);
            if let Some(remark) = line.remark
                && !matches!(line.what, Content::Broken(_) | Content::Prose)
            {
                let said = printer.raw(remark).trim_end();
                out.push_str(if out.len() > start { "  " } else { "" });
                out.push_str(said);
            }
            let empty = out.len() == start;
            if empty && blank {
                continue;
            }
            blank = empty;
            out.push('\n');
        }
        while out.ends_with("\n\n") {
            out.pop();
        }
        out
    }
}

struct Printer<'p> {
    text: &'p str,
    tree: &'p Tree,
}

impl Printer<'_> {
    fn raw(&self, at: At) -> &str {
        self.text.get(at.range()).unwrap_or_default()
    }

    /// The text with its spaces folded.
    fn folded(&self, at: At, out: &mut String) {
        for (index, word) in self.raw(at).split_whitespace().enumerate() {
            if index > 0 {
                out.push(' ');
            }
            out.push_str(word);
        }
    }

    fn say(&self, english: &'static str) -> &'static str {
        match (self.tree.language, english) {
            (Language::English, "mr") => "MR",
            (Language::English, "blo") => "BLO",
            (Language::English, "flo") => "FLO",
            (Language::English, "st") => "sts",
            _ => self.tree.language.say(english),
        }
    }

    fn line(&self, line: &super::syntax::Line, out: &mut String) {
        match &line.what {
            Content::Blank => {}
            Content::Comment | Content::Prose | Content::Broken(_) => {
                out.push_str(self.raw(line.at).trim_end());
            }
            Content::Header(header) => self.header(header, out),
            Content::Part(head) => {
                self.folded(head.name, out);
                if let Some(copies) = head.copies {
                    let _ = write!(out, " (make {})", copies.value);
                }
                out.push(':');
                self.origin(&head.origin, out);
            }
            Content::Row(_) => {
                if let Some(row) = self.tree.row(&line.what) {
                    self.row(row, out);
                }
            }
            Content::Again(again) => self.again(again, out),
        }
    }

    fn header(&self, header: &Header, out: &mut String) {
        match header {
            Header::Pair { key, value } => {
                let key = match key {
                    Pair::Title => "title",
                    Pair::Terms => "terms",
                    Pair::Lang => "lang",
                    Pair::Gauge => "gauge",
                    Pair::Lean => "lean",
                    Pair::Yarn => "yarn",
                    Pair::Hook => "hook",
                };
                let _ = write!(out, "{key}: ");
                self.value(*value, out);
            }
            Header::Color { name, value } => {
                out.push_str("color ");
                self.folded(*name, out);
                out.push_str(" = ");
                self.value(*value, out);
            }
            Header::Convention { settings } => {
                out.push_str("convention: ");
                for (index, (key, value)) in settings.iter().enumerate() {
                    out.push_str(if index > 0 { ", " } else { "" });
                    self.folded(*key, out);
                    out.push('=');
                    self.folded(*value, out);
                }
            }
            Header::Def { name, works, makes, text } => {
                out.push_str("def ");
                self.folded(*name, out);
                let _ = write!(out, " = {} -> {}", works.value, makes.value);
                if !self.raw(*text).is_empty() {
                    out.push(' ');
                    self.folded(*text, out);
                }
            }
        }
    }

    /// A value without the remark behind it.
    fn value(&self, at: At, out: &mut String) {
        let said = self.raw(at);
        let end = said.find("//").filter(|end| !said.get(..*end).is_some_and(|before| before.ends_with(':')));
        let words = said.get(..end.unwrap_or(said.len())).unwrap_or_default().split_whitespace();
        for (index, word) in words.enumerate() {
            out.push_str(if index > 0 { " " } else { "" });
            out.push_str(word);
        }
    }

    fn origin(&self, origin: &Origin, out: &mut String) {
        match origin {
            Origin::Own => {}
            Origin::From { name, spots } => {
                out.push_str(" from ");
                self.folded(*name, out);
                let mut kind = None;
                let word = |held: bool| if held { " held" } else { " surface" };
                for (index, spot) in spots.iter().enumerate() {
                    if let Some(before) = kind.replace(spot.held).filter(|before| *before != spot.held) {
                        out.push_str(word(before));
                    }
                    out.push_str(if index > 0 { "," } else { "" });
                    let _ = write!(out, " rnd {} sts {}", spot.round.value, spot.first.value);
                    if spot.last.value != spot.first.value {
                        let _ = write!(out, "-{}", spot.last.value);
                    }
                }
                out.push_str(kind.map_or(" held", word));
            }
            Origin::Join { pieces } => {
                out.push_str(" join ");
                for (index, piece) in pieces.iter().enumerate() {
                    out.push_str(if index > 0 { " + " } else { "" });
                    match piece {
                        super::syntax::Piece::Chain(n) => {
                            let _ = write!(out, "ch {}", n.value);
                        }
                        super::syntax::Piece::Part(name) => self.folded(*name, out),
                    }
                }
            }
        }
    }

    fn label(&self, label: &Label, out: &mut String) {
        let several = label.set.len() > 1 || label.set.iter().any(|(_, to)| to.is_some());
        let english = matches!(self.tree.language, Language::English);
        let word = match (label.kind, english, several) {
            (RowKind::Rnd, true, false) => "Rnd ",
            (RowKind::Rnd, true, true) => "Rnds ",
            (RowKind::Row, true, false) => "Row ",
            (RowKind::Row, true, true) => "Rows ",
            (RowKind::R | RowKind::None, ..) => "R",
            (RowKind::Rnd, false, _) => self.tree.language.say("rnd"),
            (RowKind::Row, false, _) => self.tree.language.say("row"),
        };
        out.push_str(word);
        if !english && !matches!(label.kind, RowKind::R | RowKind::None) {
            out.push(' ');
        }
        for (index, (from, to)) in label.set.iter().enumerate() {
            let last = index + 1 == label.set.len();
            out.push_str(match (index, last) {
                (0, _) => "",
                (_, true) => " and ",
                (_, false) => ", ",
            });
            let _ = write!(out, "{}", from.value);
            if let Some(to) = to {
                let _ = write!(out, "-{}", to.value);
            }
        }
        for tag in label.tags.iter().flat_map(|tags| &tags.others) {
            out.push_str(" (");
            self.folded(*tag, out);
            out.push(')');
        }
        if let Some(rounds) = label.tags.as_ref().and_then(|tags| tags.rounds) {
            let word = if label.kind == RowKind::Row { "rows" } else { "rnds" };
            let _ = write!(out, " ({} {word})", rounds.value);
        }
        out.push_str(": ");
    }

    fn row(&self, row: &RowLine, out: &mut String) {
        if let Some(label) = &row.label {
            self.label(label, out);
        }
        let whole = row.body.of(&self.tree.nodes);
        let split =
            row.count.as_ref().and_then(|count| whole.iter().position(|node| node.at.start > count.at.end()));
        let (body, after) = split.and_then(|split| whole.split_at_checked(split)).unwrap_or((whole, &[]));
        self.nodes(body, true, out);
        if let Some(count) = &row.count {
            out.push(' ');
            self.count(count, out);
        }
        if !after.is_empty() {
            out.push_str(". ");
            self.nodes(after, false, out);
        }
        if let Some(cue) = row.cue {
            out.push_str(". ");
            self.folded(cue, out);
        }
    }

    fn again(&self, again: &AgainLine, out: &mut String) {
        if let Some(label) = &again.label {
            self.label(label, out);
        }
        out.push_str("rep rows ");
        for (index, (from, to)) in again.set.iter().enumerate() {
            let last = index + 1 == again.set.len();
            out.push_str(if index == 0 {
                ""
            } else if last {
                " and "
            } else {
                ", "
            });
            let _ = write!(out, "{}", from.value);
            if let Some(to) = to {
                let _ = write!(out, "-{}", to.value);
            }
        }
        if let Some(times) = again.times {
            let _ = write!(out, " {}{} times", times.value, if again.more { " more" } else { "" });
        }
        if let Some(count) = &again.count {
            out.push(' ');
            self.count(count, out);
        }
    }

    fn count(&self, count: &Count, out: &mut String) {
        out.push('(');
        for (index, (n, unit)) in count.units().enumerate() {
            out.push_str(if index > 0 { ", " } else { "" });
            let _ = write!(out, "{}", n.value);
            match unit {
                CountUnit::Stitches => {}
                CountUnit::Kind(spelled) => {
                    let _ = write!(out, " {}", self.spelled(spelled));
                }
                CountUnit::Chains => out.push_str(" ch"),
                CountUnit::Spaces => out.push_str(" ch-sp"),
                CountUnit::Rounds => out.push_str(" rnds"),
            }
        }
        out.push(')');
    }

    fn nodes(&self, nodes: &[Node], outer: bool, out: &mut String) {
        for (index, node) in nodes.iter().enumerate() {
            if index > 0 {
                let before = nodes.get(index - 1).map(|node| &node.what);
                let mark = matches!(node.what, Clause::Mark(_))
                    || matches!(before, Some(Clause::Mark(_) | Clause::Stop));
                let last = outer && index + 1 == nodes.len();
                out.push_str(match (mark, &node.what, node.sep) {
                    (true, ..) => " ",
                    (false, Clause::Again(_), _) => " and ",
                    // A last clause behind a period may be a count.
                    (false, Clause::Op(op), super::syntax::Sep::Dot) if last && op.n.is_some() => ". ",
                    _ => ", ",
                });
            }
            self.clause(node, out);
        }
    }

    fn clause(&self, node: &Node, out: &mut String) {
        match &node.what {
            Clause::Ring { n, word } => match (n, word) {
                (Some(n), Some(word)) => {
                    let _ = write!(out, "{} ", n.value);
                    self.word(*word, out);
                    let _ = write!(out, " {} {}", self.say("in"), self.say("mr"));
                }
                (Some(n), None) => {
                    let _ = write!(out, "{} {}", self.say("mr"), n.value);
                }
                (None, _) => out.push_str(self.say("mr")),
            },
            Clause::Group { brace, body, times } => self.group(*brace, *body, *times, out),
            Clause::Star { body, times, to_stop } => self.star(*body, *times, *to_stop, out),
            Clause::Op(op) => self.op(op, out),
            Clause::Again(place) => self.place(*place, out),
            Clause::RepeatAll => out.push_str("rep around"),
            Clause::Loop(entry) => {
                let _ = write!(out, "in {}", self.entry(*entry));
            }
            Clause::Color(name) => {
                out.push_str("with ");
                self.folded(*name, out);
            }
            Clause::Turn => out.push_str(self.say("turn")),
            Clause::Chain { n, counts } => {
                let _ = write!(out, "{} {}", self.abbreviation(Kind::Ch), n.map_or(1, |n| n.value));
                match counts {
                    Counts::Unsaid => {}
                    Counts::As(spelled) => {
                        let _ = write!(out, " (counts as {})", self.spelled(*spelled));
                    }
                    Counts::Stitches(n) => {
                        let _ = write!(out, " (counts as {} {})", n.value, self.say("st"));
                    }
                    Counts::Not => out.push_str(" (does not count)"),
                }
            }
            Clause::Skip { n, space: false } => {
                let _ = write!(out, "{} {} {}", self.say("sk"), n.map_or(1, |n| n.value), self.say("st"));
            }
            Clause::Leave { n } => {
                let _ = write!(out, "leave {} {} unworked", n.value, self.say("st"));
            }
            Clause::Hold { n, name } => {
                let _ = write!(out, "hold {} {} for ", n.value, self.say("st"));
                self.folded(*name, out);
            }
            Clause::FastenOff => {
                out.push_str(if self.tree.language == Language::English { "FO" } else { self.say("fo") });
            }
            Clause::DrawShut => out.push_str("close"),
            Clause::Marker => out.push_str("pm"),
            Clause::Mark(Direction::Back) => out.push_str("<-"),
            Clause::Mark(Direction::Forward) => out.push_str("->"),
            Clause::Stop => out.push_str("**"),
            Clause::Skip { space: true, .. } | Clause::Join { .. } | Clause::OtherSide | Clause::DoNot => {
                self.folded(node.at, out);
            }
        }
    }

    fn group(&self, brace: u8, body: Nodes, times: Times, out: &mut String) {
        let kept = matches!(times, Times::Unsaid | Times::Place(_));
        let (open, close) = match brace {
            b'[' if kept => ('[', ']'),
            b'{' if kept => ('{', '}'),
            _ => ('(', ')'),
        };
        out.push(open);
        self.nodes(body.of(&self.tree.nodes), false, out);
        out.push(close);
        match times {
            Times::Unsaid => {}
            Times::N(n) | Times::Rep(n) => {
                let _ = write!(out, " x {}", n.value);
            }
            Times::More(n) => {
                let _ = write!(out, " {} more times", n.value);
            }
            Times::Fill(end) => {
                out.push(' ');
                self.fill(end, out);
            }
            Times::Place(place) => {
                out.push(' ');
                self.place(place, out);
            }
        }
    }

    fn star(&self, body: Nodes, times: Times, to_stop: bool, out: &mut String) {
        if !to_stop && matches!(times, Times::N(_) | Times::Fill(_)) {
            return self.group(b'(', body, times, out);
        }
        out.push('*');
        self.nodes(body.of(&self.tree.nodes), false, out);
        out.push_str("; rep from * ");
        match times {
            Times::N(n) | Times::Rep(n) => {
                let _ = write!(out, "{} times", n.value);
            }
            Times::More(n) => {
                let _ = write!(out, "{} more times", n.value);
            }
            Times::Fill(end) => self.fill(end, out),
            Times::Unsaid | Times::Place(_) => {}
        }
        if to_stop {
            out.push_str(", ending at **");
        }
    }

    fn fill(&self, end: Fill, out: &mut String) {
        match end {
            Fill::End => out.push_str(self.say("around")),
            Fill::Last(n) => {
                let _ = write!(out, "{} {} {} {}", self.say("to"), self.say("last"), n.value, self.say("st"));
            }
        }
    }

    fn op(&self, op: &Op, out: &mut String) {
        if let Some(entry) = op.entry {
            let _ = write!(out, "{} ", self.entry(entry));
        }
        if op.back.is_some() {
            out.push('-');
        }
        let run = match (op.n, op.place, op.word.shape) {
            // `sc in next 9 sts` and `9 sc` are the same stitches.
            (None, Some(Place::Next(Some(m), false) | Place::Each(m)), Shape::Plain | Shape::Inc(None)) => {
                Some(m)
            }
            (Some(n), Some(Place::Next(Some(m), false) | Place::Each(m)), Shape::Plain) if n.value == 1 => {
                Some(m)
            }
            _ => None,
        };
        if let Some(run) = run {
            let _ = write!(out, "{} ", run.value);
            self.word(op.word, out);
        } else {
            if let Some(n) = op.n {
                let _ = write!(out, "{} ", n.value);
            }
            self.word(op.word, out);
            if op.evenly {
                out.push_str(" evenly spaced");
            }
            if let Some(place) = op.place {
                out.push(' ');
                self.place(place, out);
            }
        }
        if let Some(hue) = op.hue {
            out.push(' ');
            self.folded(hue, out);
        }
    }

    fn place(&self, place: Place, out: &mut String) {
        let (to, next, st, each) = (self.say("in"), self.say("next"), self.say("st"), self.say("each"));
        let one = if self.tree.language == Language::English { "st" } else { st };
        let some = |n: Option<Num>, word: &str| match n {
            Some(n) => format!("{to} {word} {} {st}", n.value),
            None => format!("{to} {word} {one}"),
        };
        let said = match place {
            Place::Next(n, only) => format!("{}{}", some(n, next), if only { " only" } else { "" }),
            Place::Each(n) => format!("{to} {each} {next} {} {st}", n.value),
            Place::EachFill(end) => {
                let _ = write!(out, "{to} {each} {one} ");
                return self.fill(end, out);
            }
            Place::EveryNth(n) => format!("{to} {each} {}{} {one}", n.value, suffix(n.value)),
            Place::Last(n) => some(n, self.say("last")),
            Place::Same => format!("{to} {} {one}", self.say("same")),
            Place::SameAsJoin => format!("{to} {} {one} as join", self.say("same")),
            Place::FromHook(n, starting) => {
                let lead = if starting { "starting " } else { "" };
                format!(
                    "{lead}{to} {}{} {} {} hook",
                    n.value,
                    suffix(n.value),
                    self.abbreviation(Kind::Ch),
                    self.say("from")
                )
            }
            Place::Space(Some(n)) => format!("{to} {next} ch-{} sp", n.value),
            Place::Space(None) => format!("{to} {next} ch sp"),
            Place::Ring => format!("{to} {}", self.say("mr")),
            Place::Held(n) => format!("{to} {} held {st}", n.value),
            Place::TopOfChain => format!("{to} top tch"),
            Place::Over(n) => format!("over {next} {} {st}", n.value),
            Place::OverChain => "over ch".to_owned(),
            Place::OverPart(name) => {
                out.push_str("over ");
                return self.folded(name, out);
            }
            Place::Fill(end) => return self.fill(end, out),
        };
        out.push_str(&said);
    }

    fn entry(&self, entry: Entry) -> &'static str {
        if entry == Entry::Front { self.say("flo") } else { self.say("blo") }
    }

    fn word(&self, word: Word, out: &mut String) {
        let base = |out: &mut String| {
            if let Some(spelled) = word.base {
                out.push_str(self.spelled(spelled));
            }
        };
        let gap = if word.base.is_some() { " " } else { "" };
        match word.shape {
            Shape::Plain => base(out),
            Shape::Inc(n) | Shape::Dec(n) => {
                base(out);
                out.push_str(gap);
                let inc = matches!(word.shape, Shape::Inc(_));
                let invisible = self.raw(word.at).to_ascii_lowercase().starts_with("inv") && n.is_none();
                out.push_str(match (inc, invisible) {
                    (true, _) => self.say("inc"),
                    (false, true) => "invdec",
                    (false, false) => self.say("dec"),
                });
                if let Some(n) = n {
                    let _ = write!(out, "{}", n.value);
                }
            }
            Shape::Tog(n) => {
                base(out);
                let _ = write!(out, "{}tog", n.value);
            }
            Shape::Even => out.push_str("even"),
            Shape::Def(_) | Shape::Letter(..) => self.folded(word.at, out),
        }
    }

    fn abbreviation(&self, kind: Kind) -> &'static str {
        self.tree.language.abbreviation(kind, Terms::Us)
    }

    /// A stitch in the words it was written in.
    fn spelled(&self, spelled: Spelled) -> &'static str {
        match (spelled.us, spelled.uk) {
            (Some(us), Some(uk)) if us == uk => self.abbreviation(us),
            (Some(us), _) => us.us(),
            (None, Some(uk)) => uk.uk(),
            (None, None) => "",
        }
    }
}

/// The ending of an ordinal.
fn suffix(n: u32) -> &'static str {
    match (n % 10, n % 100) {
        (_, 11..=13) => "th",
        (1, _) => "st",
        (2, _) => "nd",
        (3, _) => "rd",
        _ => "th",
    }
}
