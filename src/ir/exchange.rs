//! The vocabulary that the XML writer and the XML reader share, so that neither can drift from the other.

use super::{Block, Direction, Entry, Finish, Kind, Op, Stitch};

/// Namespace of Picot XML; an identifier only, nothing is fetched from it.
pub const NAMESPACE: &str = "urn:picot:program:1";
/// Major version: another one is another language.
pub const MAJOR: u32 = 1;
/// Minor version: a newer one may add names that this version does not know.
pub const MINOR: u32 = 0;

/// The words for stitches: `inc` and `dec` for single crochet, else the US abbreviation without its spaces.
#[derive(Clone, Debug)]
pub struct Words {
    /// In the order of [`Kind::ALL`], then `inc` and `dec`.
    rows: Vec<(String, Stitch)>,
}

impl Default for Words {
    fn default() -> Self {
        Self::new()
    }
}

impl Words {
    /// The words of all kinds in the table of stitches.
    pub fn new() -> Self {
        let plain = Kind::ALL.iter().map(|&kind| (kind.us().replace(' ', ""), Stitch::plain(kind)));
        let shaped = [("inc".to_owned(), Stitch::INC), ("dec".to_owned(), Stitch::DEC)];
        Self { rows: plain.chain(shaped).collect() }
    }
    /// The stitch that a word alone means.
    pub fn stitch(&self, word: &str) -> Option<Stitch> {
        self.rows.iter().find(|(name, _)| name == word).map(|(_, stitch)| *stitch)
    }
    /// The word for a stitch, and what that word alone means: where the two differ, more must be said.
    pub fn word(&self, stitch: Stitch) -> (&str, Stitch) {
        let kinds = Kind::ALL.len();
        let row = match (stitch.kind, stitch.works, stitch.makes) {
            (Kind::Sc, 1, 2..) => kinds,
            (Kind::Sc, 2.., 1) => kinds + 1,
            (kind, ..) => kind as usize,
        };
        self.rows.get(row).map_or(("", stitch), |(name, plain)| (name, *plain))
    }
    /// Every word.
    pub fn all(&self) -> impl Iterator<Item = &str> {
        self.rows.iter().map(|(name, _)| name.as_str())
    }
}

impl Direction {
    /// Both directions.
    pub const ALL: [Self; 2] = [Self::Forward, Self::Back];
    /// `forward` or `back`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Forward => "forward",
            Self::Back => "back",
        }
    }
}

impl Entry {
    /// Every place of entry.
    pub const ALL: [Self; 4] = [Self::Both, Self::Front, Self::Back, Self::Space];
    /// `both`, `front`, `back` or `space`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Both => "both",
            Self::Front => "front",
            Self::Back => "back",
            Self::Space => "space",
        }
    }
}

impl Finish {
    /// Every kind of end.
    pub const ALL: [Self; 2] = [Self::Open, Self::DrawnShut];
    /// `open` or `drawn-shut`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Open => "open",
            Self::DrawnShut => "drawn-shut",
        }
    }
}

/// What a row does to the loops, told from its steps alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Loops of the row below that are used up, held ones included.
    pub consumes: i64,
    /// Loops made that are there when the row ends.
    pub produces: i64,
    /// Loops of the row below that stay unworked.
    pub left: i64,
}

impl Counts {
    /// Counts a row without unfolding it; `None` on overflow and for turns that do not stand in pairs.
    pub fn of(body: &Block) -> Option<Self> {
        let mut direction = Direction::Forward;
        let counts = Self::under(body, &mut direction)?;
        (direction == Direction::Forward).then_some(counts)
    }

    fn under(block: &Block, direction: &mut Direction) -> Option<Self> {
        let mut sum = Self::default();
        for op in block.ops() {
            let (counts, times) = match op {
                Op::Work { stitch, times } => {
                    let (works, makes) = (i64::from(stitch.works), i64::from(stitch.makes));
                    let counts = match direction {
                        Direction::Forward => Self { consumes: works, produces: makes, left: 0 },
                        Direction::Back => Self { consumes: -makes, produces: -works, left: 0 },
                    };
                    (counts, *times)
                }
                Op::Repeat { body, times } => {
                    let before = *direction;
                    let counts = Self::under(body, direction)?;
                    (before == *direction).then_some(())?;
                    (counts, *times)
                }
                Op::Turn(to) => {
                    *direction = *to;
                    continue;
                }
                Op::Hold { loops, .. } => (Self { consumes: 1, ..Self::default() }, *loops),
                Op::Leave { loops } => (Self { left: 1, ..Self::default() }, *loops),
                Op::Color(_) => continue,
            };
            let add = |sum: i64, one: i64| sum.checked_add(one.checked_mul(times.into())?);
            sum = Self {
                consumes: add(sum.consumes, counts.consumes)?,
                produces: add(sum.produces, counts.produces)?,
                left: add(sum.left, counts.left)?,
            };
        }
        Some(sum)
    }
}
