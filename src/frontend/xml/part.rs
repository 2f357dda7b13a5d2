//! One part: its start, rounds and steps, with the counts that the file states about them.

use super::cursor::{Element, Stop};
use super::values::{Children, Model, quoted};
use super::{Document, Parts};
use crate::diag::{Code, Span, did_you_mean};
use crate::ir::exchange::Counts;
use crate::ir::{
    Block, Direction, Entry, Finish, Graph, MAX_LOOPS, MAX_NESTING, Op, Part, PartId, Row, Segment, Start,
    Stitch,
};

static PART: Model =
    Model { names: &["start", "round", "finish", "graph"], once: &["start", "finish", "graph"], ordered: 4 };
static START: Model = Model { names: &["open", "held", "surface", "chain"], once: &[], ordered: 0 };
static STEPS: Model =
    Model { names: &["work", "repeat", "turn", "hold", "leave", "color"], once: &[], ordered: 0 };

const VERBS: [&str; 2] = ["work", "make"];

/// Where the rounds of a part stand.
struct Rounds {
    /// Number that the next round has: by counting, and after the number that the file gave the round before.
    number: Option<[u32; 2]>,
    /// Loops open before the next round.
    open: i64,
}

impl<'t> Document<'t, '_, '_> {
    /// The part with this index, and its graph when it has one.
    pub(super) fn part(&mut self, element: Element<'t>, index: u32) -> Result<(Part, Option<Graph>), Stop> {
        self.cursor.only(element, &["name", "flat", "copies"])?;
        let (name, span) = self.cursor.text_of(element, "name")?;
        let mut part = Part {
            name: name.clone().into_owned(),
            start: Start::Ring { loops: 0 },
            rows: Vec::new(),
            finish: Finish::Open,
            flat: self.cursor.flag("flat", false)?,
            copies: self.cursor.count("copies", 1..=MAX_LOOPS)?.unwrap_or(1),
        };
        self.cursor.place = Some((part.name.clone(), None));
        let id = self.parts.mention(name, span);
        if self.parts.index_of(id).is_some() && !span.is_none() {
            let message = format!("a second part is named {}", quoted(&part.name));
            self.cursor.at(Code::XmlDuplicate, message, span, "give each part a name of its own")?;
        }
        self.parts.define(id, index);
        let mut graph = None;
        let mut rounds = Rounds { number: None, open: 0 };
        let mut children = Children::of(element, &PART);
        while let Some(child) = self.cursor.child(&mut children)? {
            match child.name {
                "start" => {
                    part.start = self.start(child)?;
                    rounds.open = part.start.loops().into();
                }
                "round" => {
                    if part.rows.is_empty() && !children.had("start") {
                        self.no_start(element)?;
                    }
                    let first = part.first_number();
                    let row = self.round(child, first, part.flat, id, &mut rounds)?;
                    part.rows.push(row);
                }
                "finish" => {
                    self.cursor.only(child, &["kind"])?;
                    let words = Finish::ALL.map(|finish| (finish.word(), finish));
                    part.finish = self.cursor.word_of(child, "kind", &words)?.unwrap_or_default();
                    self.cursor.leaf(child)?;
                }
                _ => graph = Some(self.graph(child)?),
            }
        }
        if part.rows.is_empty() && !children.had("start") {
            self.no_start(element)?;
        }
        self.cursor.place = None;
        Ok((part, graph))
    }

    fn no_start(&mut self, part: Element<'t>) -> Result<(), Stop> {
        self.cursor.at(Code::XmlMissing, "<part> lacks <start>", part.span, "say how the part begins")
    }

    fn start(&mut self, element: Element<'t>) -> Result<Start, Stop> {
        let kinds = [("ring", 0), ("chain", 1), ("pickup", 2)];
        let kind = self.cursor.word_of(element, "kind", &kinds)?;
        let names: &[&str] = if kind == Some(1) { &["kind", "loops", "joined"] } else { &["kind", "loops"] };
        self.cursor.only(element, names)?;
        let loops = self.cursor.count_of(element, "loops", 0..=MAX_LOOPS)?;
        let loops_span =
            self.cursor.get("loops").map_or(element.span, |attribute| self.cursor.value_span(attribute));
        let joined = self.cursor.flag("joined", false)?;
        if kind != Some(2) {
            self.cursor.leaf(element)?;
            let chain = kind == Some(1);
            return Ok(if chain { Start::Chain { loops, joined } } else { Start::Ring { loops } });
        }
        let mut segments = Vec::new();
        let mut children = Children::of(element, &START);
        while let Some(child) = self.cursor.child(&mut children)? {
            segments.push(self.segment(child)?);
        }
        let start = Start::Join { segments };
        if start.loops() != loops {
            let message = format!("the start says {loops} loops, its stretches have {}", start.loops());
            self.cursor.at(Code::XmlCounts, message, loops_span, "`loops` is the sum of all stretches")?;
        }
        Ok(start)
    }

    fn segment(&mut self, element: Element<'t>) -> Result<Segment, Stop> {
        let names: &[&str] = match element.name {
            "open" | "held" => &["part", "loops"],
            "surface" => &["part", "round", "first", "loops", "direction"],
            _ => &["loops"],
        };
        self.cursor.only(element, names)?;
        let loops = self.cursor.count_of(element, "loops", 1..=MAX_LOOPS)?;
        let segment = match element.name {
            "open" => Segment::Open { part: self.part_ref(element, "part")?, loops },
            "held" => Segment::Held { part: self.part_ref(element, "part")?, loops },
            "surface" => Segment::Surface {
                part: self.part_ref(element, "part")?,
                round: self.cursor.count_of(element, "round", 0..=MAX_LOOPS)?,
                first: self.cursor.count_of(element, "first", 1..=MAX_LOOPS)?,
                loops,
                back: {
                    let words = Direction::ALL.map(|direction| (direction.word(), direction));
                    self.cursor.word("direction", &words)? == Some(Direction::Back)
                },
            },
            _ => Segment::Chain { loops },
        };
        self.cursor.leaf(element)?;
        Ok(segment)
    }

    fn part_ref(&mut self, element: Element<'t>, attribute: &str) -> Result<PartId, Stop> {
        let (name, span) = self.cursor.text_of(element, attribute)?;
        Ok(if span.is_none() { PartId(0) } else { self.parts.mention(name, span) })
    }

    fn round(
        &mut self,
        element: Element<'t>,
        first: u32,
        flat: bool,
        part: PartId,
        rounds: &mut Rounds,
    ) -> Result<Row, Stop> {
        self.cursor.only(element, &["number", "last", "consumes", "produces", "stated"])?;
        let number = self.cursor.count_of(element, "number", 1..=MAX_LOOPS)?;
        if let Some((_, round)) = &mut self.cursor.place {
            *round = Some(number);
        }
        let span_of = |document: &Self, name: &str| {
            document.cursor.get(name).map_or(element.span, |attribute| document.cursor.value_span(attribute))
        };
        let number_span = span_of(self, "number");
        let due = rounds.number.unwrap_or([first; 2]);
        if rounds.number.is_none() && first == 2 && number == 1 {
            let message = "the rounds count the magic ring as round 0";
            self.cursor.at(
                Code::XmlRingNumber,
                message,
                number_span,
                "the ring's stitches are round 1 for Picot",
            )?;
            self.parts.shift(part);
        } else if !due.contains(&number)
            && self.cursor.get("number").is_some()
            && (rounds.number.is_some() || self.cursor.clean())
        {
            let message = format!("round {number} stands where round {} is due", due[1]);
            self.cursor.at(Code::XmlCounts, message, number_span, "number the rounds without gaps")?;
        }
        let last = self.cursor.count("last", 1..=MAX_LOOPS)?;
        if let Some(last) = last.filter(|&last| last <= number) {
            let message = format!("a round from {number} to {last}");
            let span = span_of(self, "last");
            self.cursor.at(Code::XmlCounts, message, span, "`last` is greater than `number`, or left out")?;
        }
        let times = last.unwrap_or(number).saturating_sub(number) + 1;
        let counted = if rounds.number.is_none() { number } else { due[0] };
        rounds.number = Some([counted, number].map(|number| number.saturating_add(times)));
        let stated_counts = ["consumes", "produces"].map(|name| (name, span_of(self, name)));
        let mut given = [0; 2];
        for (slot, (name, _)) in given.iter_mut().zip(stated_counts) {
            *slot = self.cursor.count_of(element, name, 0..=MAX_LOOPS)?.into();
        }
        let stated =
            self.cursor.count("stated", 0..=MAX_LOOPS)?.map(|stated| (stated, span_of(self, "stated")));
        let body = self.steps(element, 0)?;
        self.count_steps(&body, times, element.span)?;
        let row = Row { body, times, stated, span: element.span };
        if self.cursor.clean() {
            self.counts(&row, flat, given, stated_counts, rounds)?;
        }
        if let Some((_, round)) = &mut self.cursor.place {
            *round = None;
        }
        Ok(row)
    }

    /// Compares what a round says of itself with its steps and with the round below. What cannot be worked for other
    /// reasons is left to the verifier.
    fn counts(
        &mut self,
        row: &Row,
        flat: bool,
        given: [i64; 2],
        stated: [(&str, Span); 2],
        rounds: &mut Rounds,
    ) -> Result<(), Stop> {
        let Some(counts) = Counts::of(&row.body) else { return Ok(()) };
        let steps = [counts.consumes, counts.produces];
        let differs: Vec<_> = (0..2).filter(|&index| given[index] != steps[index]).collect();
        if let Some(&first) = differs.first() {
            let list = |words: Vec<String>| words.join(" and ");
            let told =
                list(differs.iter().map(|&index| format!("{} {}", VERBS[index], steps[index])).collect());
            let given = list(differs.iter().map(|&index| given[index].to_string()).collect());
            let message = format!("the steps {told} loops, the round says {given}");
            let (name, span) = stated[first];
            self.cursor.at(Code::XmlCounts, message, span, format!("put right the steps or `{name}`"))?;
        }
        let below = given[0].saturating_add(counts.left);
        // A row of flat work may go on over loops that earlier rows left.
        if !flat && below != rounds.open && self.cursor.clean() {
            let message =
                format!("this round works or leaves {below} loops, the round below has {}", rounds.open);
            self.cursor.at(
                Code::XmlCounts,
                message,
                stated[0].1,
                "`consumes` is what the round below produces",
            )?;
        }
        rounds.open = given[1].saturating_add(counts.left);
        if !flat && row.times > 1 && rounds.open != below && self.cursor.clean() {
            let message = format!("equal rounds on {below} loops leave {}", rounds.open);
            self.cursor.at(
                Code::XmlCounts,
                message,
                stated[1].1,
                "a round with `last` produces what it consumes",
            )?;
        }
        Ok(())
    }

    /// Repeats may claim any number of steps in a few bytes.
    fn count_steps(&mut self, body: &Block, times: u32, span: Span) -> Result<(), Stop> {
        let steps = body.step_count().and_then(|steps| steps.checked_mul(times.into()));
        let total = steps.and_then(|steps| steps.checked_add(self.steps));
        match total {
            Some(total) if total <= u64::from(MAX_LOOPS) => {
                self.steps = total;
                Ok(())
            }
            _ => {
                let message = format!("more than {MAX_LOOPS} steps in all");
                self.cursor.at(
                    Code::XmlTooLarge,
                    message,
                    span,
                    "Picot handles no pattern as large as that",
                )?;
                Err(Stop)
            }
        }
    }

    fn steps(&mut self, parent: Element<'t>, depth: u32) -> Result<Block, Stop> {
        let mut block = Block::default();
        let mut children = Children::of(parent, &STEPS);
        while let Some(step) = self.cursor.child(&mut children)? {
            if let Some(op) = self.step(step, depth)? {
                block.push(op, step.span);
            }
        }
        if block.is_empty() && self.cursor.clean() {
            let message = format!("<{}> has no steps", parent.name);
            self.cursor.at(Code::XmlMissing, message, parent.span, "add steps such as <work op=\"sc\"/>")?;
        }
        Ok(block)
    }

    fn step(&mut self, element: Element<'t>, depth: u32) -> Result<Option<Op>, Stop> {
        let op = match element.name {
            "work" => {
                self.cursor.only(element, &["op", "works", "makes", "into", "times"])?;
                let stitch = self.stitch(element)?;
                Op::Work { stitch, times: self.cursor.count("times", 1..=MAX_LOOPS)?.unwrap_or(1) }
            }
            "repeat" => {
                if depth == MAX_NESTING {
                    let message = format!("repeats are nested more than {MAX_NESTING} deep");
                    self.cursor.at(
                        Code::XmlTooLarge,
                        message,
                        element.span,
                        "write out the innermost repeat",
                    )?;
                    self.cursor.skip()?;
                    return Ok(None);
                }
                self.cursor.only(element, &["times"])?;
                let times = self.cursor.count_of(element, "times", 1..=MAX_LOOPS)?;
                return Ok(Some(Op::repeat(self.steps(element, depth + 1)?, times)));
            }
            "turn" => {
                self.cursor.only(element, &["direction"])?;
                let words = Direction::ALL.map(|direction| (direction.word(), direction));
                Op::Turn(self.cursor.word_of(element, "direction", &words)?.unwrap_or_default())
            }
            "hold" => {
                self.cursor.only(element, &["loops", "by"])?;
                let loops = self.cursor.count_of(element, "loops", 1..=MAX_LOOPS)?;
                Op::Hold { loops, by: self.part_ref(element, "by")? }
            }
            "leave" => {
                self.cursor.only(element, &["loops"])?;
                Op::Leave { loops: self.cursor.count_of(element, "loops", 1..=MAX_LOOPS)? }
            }
            _ => {
                self.cursor.only(element, &["yarn"])?;
                let (id, span) = self.cursor.text_of(element, "yarn")?;
                let color = self.yarns.get(&id).copied();
                if color.is_none() && !span.is_none() {
                    let help = match did_you_mean(&id, self.yarns.keys().map(|id| &**id)) {
                        Some(id) => format!("did you mean {}?", quoted(id)),
                        None => "declare it with <yarn id=\"..\" name=\"..\"/> before the parts".to_owned(),
                    };
                    self.cursor.at(
                        Code::XmlReference,
                        format!("there is no yarn {}", quoted(&id)),
                        span,
                        help,
                    )?;
                }
                Op::Color(color.unwrap_or(0))
            }
        };
        self.cursor.leaf(element)?;
        Ok(Some(op))
    }

    /// The stitch that the attributes of an element name.
    pub(super) fn stitch(&mut self, element: Element<'t>) -> Result<Stitch, Stop> {
        let (word, span) = self.cursor.text_of(element, "op")?;
        let mut stitch = self.words.stitch(&word).unwrap_or(Stitch::SC);
        if !span.is_none() && self.words.stitch(&word).is_none() {
            let help = match did_you_mean(&word, self.words.all()) {
                Some(word) => format!("did you mean `{word}`?"),
                None => format!("the stitches are `{}`", self.words.all().collect::<Vec<_>>().join("`, `")),
            };
            self.cursor.at(Code::XmlValue, format!("there is no stitch {}", quoted(&word)), span, help)?;
        }
        for (name, count) in [("works", &mut stitch.works), ("makes", &mut stitch.makes)] {
            if let Some(given) = self.cursor.count(name, 0..=u16::MAX.into())? {
                *count = given as u16;
            }
        }
        let entries = Entry::ALL.map(|entry| (entry.word(), entry));
        stitch.entry = self.cursor.word("into", &entries)?.unwrap_or_default();
        Ok(stitch)
    }
}

impl Parts<'_> {
    fn index_of(&self, id: PartId) -> Option<u32> {
        self.mentions.get(id.0 as usize)?.index
    }
    fn define(&mut self, id: PartId, index: u32) {
        if let Some(mention) = self.mentions.get_mut(id.0 as usize) {
            mention.index.get_or_insert(index);
        }
    }
    fn shift(&mut self, id: PartId) {
        if let Some(mention) = self.mentions.get_mut(id.0 as usize) {
            mention.shifted = true;
        }
    }
}
