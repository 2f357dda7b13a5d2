//! The machine level: needles, carriers, racks and instructions of a V-bed knitting machine.
//!
//! `.k` (Knitout) and `.kc` (k-code) are two spellings of [`Code`]. The meaning of code is what it does to the loops on
//! the needles, one instruction after the other; [`execute`] is that meaning as a function, and only [`check`] makes
//! the [`Checked`] token that says a program keeps the rules of its machine.
//!
//! - A **needle** lies on the front or the back bed and has a number that rises to the right; it may be negative.
//! - At **rack** R the back needle B faces the front needle B + R.
//! - A **carrier** holds a yarn. It is out until it is brought in, by the gripper or with the inserting hook.
//! - To **knit** pulls a new loop through all loops on the needle and lets those go; to **tuck** adds a loop; to
//!   **split** knits while the old loops move to the facing needle; to **transfer** moves loops to the facing needle.

mod execute;
mod findings;
pub mod hand;
pub mod passes;
pub mod profile;
mod state;
mod yarn;

pub use execute::{Checked, Report, Run, check, execute};
pub use hand::Hand;
pub use profile::{Choice, MACHINES, Machine, Profile};
pub use state::{Loop, LoopId, Made, NONE, Needles};

use crate::diag::Span;
use std::fmt;

/// Needle numbers reach from minus this to plus this; no machine comes near.
pub const MAX_NEEDLE: i32 = 32_767;
/// Most carriers that one operation may name.
pub const MAX_CARRIERS_PER_OP: usize = 15;
/// Most carriers that a file may declare.
pub const MAX_CARRIERS: usize = 250;

/// One of the two needle beds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Bed {
    /// The bed nearest to the operator.
    Front,
    /// The other one, which racks.
    Back,
}

impl Bed {
    /// The facing bed.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Front => Self::Back,
            Self::Back => Self::Front,
        }
    }
}

/// A needle, or the slider beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Needle {
    /// The bed on which it lies.
    pub bed: Bed,
    /// True for the slider, which can hold transferred loops but form none.
    pub slider: bool,
    /// Its number, rising to the right.
    pub index: i32,
}

impl Needle {
    /// A needle of the front bed.
    pub fn front(index: i32) -> Self {
        Self { bed: Bed::Front, slider: false, index }
    }
    /// A needle of the back bed.
    pub fn back(index: i32) -> Self {
        Self { bed: Bed::Back, slider: false, index }
    }
    /// A needle of this bed.
    pub fn on(bed: Bed, index: i32) -> Self {
        Self { bed, slider: false, index }
    }
    /// The place along the front bed, in quarter needles, at this rack.
    pub fn place(self, rack: Rack) -> i32 {
        match self.bed {
            Bed::Front => self.index.saturating_mul(4),
            Bed::Back => self.index.saturating_mul(4).saturating_add(rack.0),
        }
    }
    /// Reads `f10`, `bs-2` and their like.
    pub fn parse(text: &str) -> Option<Self> {
        let (bed, rest) = match text.as_bytes().first()? {
            b'f' => (Bed::Front, text.get(1..)?),
            b'b' => (Bed::Back, text.get(1..)?),
            _ => return None,
        };
        let (slider, digits) = match rest.strip_prefix('s') {
            Some(digits) => (true, digits),
            None => (false, rest),
        };
        let magnitude = digits.strip_prefix('-').unwrap_or(digits);
        if magnitude.is_empty() || magnitude.len() > 9 || !magnitude.bytes().all(|byte| byte.is_ascii_digit())
        {
            return None;
        }
        let number: i32 = magnitude.parse().ok()?;
        let index = if digits.len() > magnitude.len() { -number } else { number };
        Some(Self { bed, slider, index })
    }
}

impl fmt::Display for Needle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bed = match self.bed {
            Bed::Front => 'f',
            Bed::Back => 'b',
        };
        write!(f, "{bed}{}{}", if self.slider { "s" } else { "" }, self.index)
    }
}

/// Direction of the carriage: towards rising or falling needle numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Direction {
    /// `+`, to the right.
    Plus,
    /// `-`, to the left.
    Minus,
}

impl Direction {
    /// The opposite one.
    #[must_use]
    pub fn reverse(self) -> Self {
        match self {
            Self::Plus => Self::Minus,
            Self::Minus => Self::Plus,
        }
    }
    /// `+` or `-`.
    pub fn sign(self) -> char {
        match self {
            Self::Plus => '+',
            Self::Minus => '-',
        }
    }
}

/// Offset of the back bed, in quarters of a needle: at 4 the back needle 1 faces the front needle 2.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Rack(pub i32);

impl Rack {
    /// A rack of whole needles.
    pub fn whole(needles: i32) -> Self {
        Self(needles.saturating_mul(4))
    }
    /// The rack in needles.
    pub fn needles(self) -> f64 {
        f64::from(self.0) / 4.0
    }
    /// The rack nearest to a number of needles; `None` when it is no multiple of a quarter or beyond every bed.
    pub fn from_needles(needles: f64) -> Option<Self> {
        let quarters = needles * 4.0;
        (quarters.fract() == 0.0 && quarters.abs() <= f64::from(4 * MAX_NEEDLE))
            .then_some(Self(quarters as i32))
    }
    /// True when back needles face front needles, so that loops can be transferred.
    pub fn is_whole(self) -> bool {
        self.0 % 4 == 0
    }
}

impl fmt::Display for Rack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.needles())
    }
}

/// A carrier, as its place in [`Code::carriers`].
pub type CarrierId = u8;

/// The carriers of one operation in the order in which they are named.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub struct CarrierSet {
    ids: [CarrierId; MAX_CARRIERS_PER_OP],
    len: u8,
}

impl CarrierSet {
    /// One carrier.
    pub fn one(id: CarrierId) -> Self {
        let mut set = Self::default();
        set.push(id);
        set
    }
    /// Adds a carrier; false when the set is full.
    pub fn push(&mut self, id: CarrierId) -> bool {
        match self.ids.get_mut(usize::from(self.len)) {
            Some(place) => {
                *place = id;
                self.len += 1;
                true
            }
            None => false,
        }
    }
}

impl std::ops::Deref for CarrierSet {
    type Target = [CarrierId];
    fn deref(&self) -> &[CarrierId] {
        self.ids.get(..usize::from(self.len)).unwrap_or_default()
    }
}

impl fmt::Debug for CarrierSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

/// One operation. Loops, needles and carriers are all it may touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Instruction {
    /// Bring carriers in from the gripper when they are next used.
    In(CarrierSet),
    /// Bring carriers in with the inserting hook when they are next used.
    InHook(CarrierSet),
    /// Let go of the yarns in the hook.
    ReleaseHook(CarrierSet),
    /// Take carriers out to the gripper.
    Out(CarrierSet),
    /// Take carriers out by the hook.
    OutHook(CarrierSet),
    /// Needle retraction before and after loop forming, in machine units.
    Stitch(f64, f64),
    /// Move the back bed.
    Rack(Rack),
    /// Pull a new loop through the loops of a needle; without carriers, drop them.
    Knit(Direction, Needle, CarrierSet),
    /// Add a loop to a needle.
    Tuck(Direction, Needle, CarrierSet),
    /// Knit while the old loops move to the facing needle; without carriers, transfer them.
    Split(Direction, Needle, Needle, CarrierSet),
    /// Let the loops of a needle go.
    Drop(Needle),
    /// Move a needle as if to tuck, without yarn.
    Amiss(Needle),
    /// Move the loops of a needle to the facing one.
    Xfer(Needle, Needle),
    /// Move carriers as if they had made a loop.
    Miss(Direction, Needle, CarrierSet),
    /// Stop for the operator; the words stand in [`Code::texts`].
    Pause(TextId),
    /// An extension (`x-...`); the whole operation stands in [`Code::texts`].
    Extension(TextId),
}

/// A text, as its place in [`Code::texts`].
pub type TextId = u32;

/// One line of the comment header.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// Name, such as `Carriers`.
    pub name: String,
    /// Everything after the colon and the blank.
    pub value: String,
    /// The line.
    pub span: Span,
}

/// A comment of the body.
#[derive(Clone, Debug, PartialEq)]
pub struct Comment {
    /// It stands before this instruction, or on its line.
    pub at: u32,
    /// True when it stands on the line of the instruction.
    pub trailing: bool,
    /// The words after the `;`.
    pub text: String,
}

/// A machine program.
#[derive(Clone, Debug, PartialEq)]
pub struct Code {
    /// The number of the magic line.
    pub version: u32,
    /// The comment header in order.
    pub headers: Vec<Header>,
    /// Names of the carriers, front rail first, left to right.
    pub carriers: Vec<String>,
    /// Words of pauses and extensions.
    pub texts: Vec<String>,
    /// Comments in the order of their places.
    pub comments: Vec<Comment>,
    ops: Vec<Instruction>,
    spans: Vec<Span>,
}

impl Default for Code {
    fn default() -> Self {
        Self {
            version: 2,
            headers: Vec::new(),
            carriers: Vec::new(),
            texts: Vec::new(),
            comments: Vec::new(),
            ops: Vec::new(),
            spans: Vec::new(),
        }
    }
}

impl Code {
    /// An empty program for these carriers, front rail first, with the header that says so.
    pub fn with_carriers(names: Vec<String>) -> Self {
        let mut code = Self::default();
        code.set_header("Carriers", names.join(" "));
        code.carriers = names;
        code
    }
    /// The instructions.
    pub fn ops(&self) -> &[Instruction] {
        &self.ops
    }
    /// Where an instruction was read; [`Span::NONE`] when no one wrote it.
    pub fn span(&self, op: usize) -> Span {
        self.spans.get(op).copied().unwrap_or_default()
    }
    /// Adds an instruction.
    pub fn push(&mut self, instruction: Instruction, span: Span) {
        self.ops.push(instruction);
        self.spans.push(span);
    }
    /// The same program as if no one had written it.
    #[must_use]
    pub fn without_spans(&self) -> Self {
        Self { spans: vec![Span::NONE; self.ops.len()], ..self.clone() }
    }
    /// Adds a comment line before the next instruction.
    pub fn remark(&mut self, text: impl Into<String>) {
        self.comments.push(Comment { at: self.ops.len() as u32, trailing: false, text: text.into() });
    }
    /// Sets a header; the line is added when there is none of that name.
    pub fn set_header(&mut self, name: &str, value: impl Into<String>) {
        let value = value.into();
        match self.headers.iter_mut().rev().find(|header| header.name == name) {
            Some(header) => header.value = value,
            None => self.headers.push(Header { name: name.to_owned(), value, span: Span::NONE }),
        }
    }
    /// The value of a header; of several, the last one counts.
    pub fn header(&self, name: &str) -> Option<&str> {
        self.headers.iter().rev().find(|header| header.name == name).map(|header| header.value.as_str())
    }
    /// Keeps a text and returns its place.
    pub fn text(&mut self, text: impl Into<String>) -> TextId {
        self.texts.push(text.into());
        (self.texts.len() - 1) as TextId
    }
    /// Moves every needle by `by`, so that a program laid out anywhere comes to its place on the bed.
    pub fn shift(&mut self, by: i32) {
        self.ops.iter_mut().for_each(|op| op.shift(by));
    }
    /// The name of a carrier.
    pub fn carrier(&self, id: CarrierId) -> &str {
        self.carriers.get(usize::from(id)).map_or("?", String::as_str)
    }
}

impl Instruction {
    /// Moves its needles by `by`.
    pub fn shift(&mut self, by: i32) {
        let moved = |needle: &mut Needle| needle.index = needle.index.saturating_add(by);
        match self {
            Self::Knit(_, needle, _)
            | Self::Tuck(_, needle, _)
            | Self::Miss(_, needle, _)
            | Self::Drop(needle)
            | Self::Amiss(needle) => moved(needle),
            Self::Split(_, from, to, _) | Self::Xfer(from, to) => {
                moved(from);
                moved(to);
            }
            Self::In(_)
            | Self::InHook(_)
            | Self::ReleaseHook(_)
            | Self::Out(_)
            | Self::OutHook(_)
            | Self::Stitch(..)
            | Self::Rack(_)
            | Self::Pause(_)
            | Self::Extension(_) => {}
        }
    }
    /// The needles that it touches.
    pub fn needles(&self) -> impl Iterator<Item = Needle> {
        let (a, b) = match *self {
            Self::Knit(_, needle, _)
            | Self::Tuck(_, needle, _)
            | Self::Miss(_, needle, _)
            | Self::Drop(needle)
            | Self::Amiss(needle) => (Some(needle), None),
            Self::Split(_, from, to, _) | Self::Xfer(from, to) => (Some(from), Some(to)),
            Self::In(_)
            | Self::InHook(_)
            | Self::ReleaseHook(_)
            | Self::Out(_)
            | Self::OutHook(_)
            | Self::Stitch(..)
            | Self::Rack(_)
            | Self::Pause(_)
            | Self::Extension(_) => (None, None),
        };
        a.into_iter().chain(b)
    }
    /// Its opcode; `x-` for every extension.
    pub fn opcode(&self) -> &'static str {
        match self {
            Self::In(_) => "in",
            Self::InHook(_) => "inhook",
            Self::ReleaseHook(_) => "releasehook",
            Self::Out(_) => "out",
            Self::OutHook(_) => "outhook",
            Self::Stitch(..) => "stitch",
            Self::Rack(_) => "rack",
            Self::Knit(..) => "knit",
            Self::Tuck(..) => "tuck",
            Self::Split(..) => "split",
            Self::Drop(_) => "drop",
            Self::Amiss(_) => "amiss",
            Self::Xfer(..) => "xfer",
            Self::Miss(..) => "miss",
            Self::Pause(_) => "pause",
            Self::Extension(_) => "x-",
        }
    }
}
