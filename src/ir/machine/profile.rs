//! Machine profiles: what a machine can do, as TOML, with every field documented in [`FIELDS`].

use super::hand::Hand;
use super::{Direction, MAX_NEEDLE};
use crate::diag::{Code, Diagnostic, Sink, Source};
use serde::Deserialize;
use serde::de::DeserializeOwned;

/// The built-in profiles, as name and text.
pub static MACHINES: &[(&str, &str)] =
    &[("swg091n2", include_str!("swg091n2.toml")), ("kniterate", include_str!("kniterate.toml"))];

/// One field of a profile with what it means; `picot list machines` prints the table.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// The key, with its table.
    pub key: &'static str,
    /// Meaning and unit.
    pub about: &'static str,
}

const fn field(key: &'static str, about: &'static str) -> Field {
    Field { key, about }
}

/// Every field of a profile. Those of `stitch_number`, `speed`, `roller` and `waste` may be left out.
pub static FIELDS: &[Field] = &[
    field("name", "name of the machine, compared with the Machine header without regard to case"),
    field("header", "the name as the Machine header of Knitout spells it; the name itself when left out"),
    field(
        "kind",
        "\"v-bed\", a weft-knitting machine with two facing beds; \"hand\", a hand or a machine that crochets as one, with name and the six fields below only",
    ),
    field(
        "stitches",
        "of a hand: what it makes, as US abbreviations, and inc, dec, ring (a magic ring), turn (short rows)",
    ),
    field("max_increases", "of a hand: most increases in a round; 0: no limit"),
    field("max_decreases", "of a hand: most decreases in a round; 0: no limit"),
    field("min_round", "of a hand: fewest stitches of a round"),
    field("max_round", "of a hand: most stitches of a round; 0: no limit"),
    field(
        "gauge",
        "of a hand: least and greatest width and height of a stitch, in millimeters; may be left out",
    ),
    field("operations", "Knitout operations that it performs"),
    field("extensions", "x-* operations that its tools understand"),
    field("bed.needles", "first and last needle number of each bed"),
    field("bed.gauge", "needles per inch"),
    field(
        "bed.half_gauge",
        "true: tubes lie on every second needle, which leaves needles for transfers; false: on all needles, where only \
         sliders let loops move: without them tubes are plain and end on waste yarn",
    ),
    field("bed.sliders", "true when each needle has a slider that can hold transferred loops"),
    field("carriers.names", "the carriers, front rail first"),
    field("carriers.per_op", "most carriers that one operation may use"),
    field(
        "carriers.yarn",
        "the carrier of the first color; the others follow in order, but for those of waste",
    ),
    field("entry.bring_in", "\"hook\" (inhook, releasehook, outhook) or \"gripper\" (in, out)"),
    field("entry.parking", "side on which carriers wait: \"left\" or \"right\""),
    field("entry.first_direction", "direction of the first pass of a yarn, \"+\" or \"-\""),
    field(
        "entry.hook_width",
        "needles right of the first stitch that the inserting hook covers until releasehook",
    ),
    field("rack.max", "largest rack either way, in needles"),
    field(
        "rack.preferred",
        "largest rack with which loops are moved sideways, in needles, as far as limits.link_stretch lets it; at least 2",
    ),
    field("rack.step", "racks are multiples of this, in needles; the all-needle racks come on top"),
    field("rack.all_needle", "racks at which both beds knit in one pass"),
    field(
        "limits.loops_per_needle",
        "most loops that a needle holds; what is lowered stays one below it, but takes 3; 0: no limit",
    ),
    field("limits.float", "longest float, in needles; 0: no limit"),
    field(
        "limits.link_stretch",
        "widest distance of two neighboring loops of one yarn, in needles; 0: no limit",
    ),
    field("limits.short_row_depth", "most courses that a needle is held while others are knit; 0: no limit"),
    field("limits.shapings_per_course", "most increases and decreases of one course; 0: no limit"),
    field("tube.min_loops", "fewest loops of a tube; narrower ones give a warning"),
    field("tube.max_loops", "most loops of a tube"),
    field(
        "methods.increase",
        "\"tuck\" (a tuck against the pass), or \"split\" where the two needles are neighbors",
    ),
    field(
        "methods.transfer",
        "of k-code: \"four-pass\" (even, then odd needles) or \"two-pass\" (all at once)",
    ),
    field("stitch_number.default", "stitch size while knitting, 0 to 35"),
    field("stitch_number.xfer", "stitch size while transferring"),
    field("stitch_number.bind_off", "stitch size of the bind-off chain"),
    field("speed.default", "carriage speed, in machine units"),
    field("speed.range", "least and greatest speed"),
    field("roller.default", "take-down of a knitting pass, in machine units"),
    field("roller.xfer", "take-down of a transfer pass"),
    field("waste.rows", "rounds of waste yarn before the piece"),
    field("waste.carrier", "the carrier with waste yarn"),
    field("waste.draw", "the carrier with the draw thread between waste and piece"),
];

/// A V-bed knitting machine. [`FIELDS`] says what each field means.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(
    missing_docs,
    reason = "the fields are documented once, in FIELDS, which is also what the user sees"
)]
pub struct Machine {
    pub name: String,
    pub header: Option<String>,
    pub kind: Kind,
    pub operations: Vec<String>,
    #[serde(default)]
    pub extensions: Vec<String>,
    pub bed: BedFacts,
    pub carriers: Carriers,
    pub entry: Entry,
    pub rack: RackFacts,
    pub limits: Limits,
    pub tube: Tube,
    pub methods: Methods,
    pub stitch_number: Option<StitchNumber>,
    pub speed: Option<Speed>,
    pub roller: Option<Roller>,
    pub waste: Option<Waste>,
}

/// A machine as an option names it: a built-in one by its name, or a whole profile as a table.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Named")]
pub struct Choice(pub Machine);

#[derive(Deserialize)]
#[serde(untagged)]
enum Named {
    Name(String),
    Profile(Box<Machine>),
}

impl TryFrom<Named> for Choice {
    type Error = String;
    fn try_from(named: Named) -> Result<Self, String> {
        match named {
            Named::Name(name) => Machine::named(&name).map(Self).ok_or_else(|| {
                let known: Vec<&str> = MACHINES.iter().map(|(name, _)| *name).collect();
                format!("there is no machine `{name}`; built in are {}", known.join(" and "))
            }),
            Named::Profile(machine) => match machine.fault() {
                None => Ok(Self(*machine)),
                Some((key, what)) => Err(format!("`{key}` {what}")),
            },
        }
    }
}

macro_rules! tables {
    ($($(#[$meta:meta])* $name:ident { $($field:ident: $kind:ty),+ $(,)? })+) => { $(
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq, Deserialize)]
        #[serde(deny_unknown_fields)]
        #[expect(missing_docs, reason = "the fields are documented once, in FIELDS")]
        pub struct $name { $(pub $field: $kind),+ }
    )+ };
}

tables! {
    /// The beds.
    BedFacts { needles: [i32; 2], gauge: f64, half_gauge: bool, sliders: bool }
    /// The yarn carriers.
    Carriers { names: Vec<String>, per_op: u32, yarn: String }
    /// How yarn comes in.
    Entry { bring_in: BringIn, parking: Side, first_direction: Sign, hook_width: i32 }
    /// Racking.
    RackFacts { max: f64, preferred: f64, step: f64, all_needle: Vec<f64> }
    /// What yarn and needles bear.
    Limits { loops_per_needle: u32, float: u32, link_stretch: u32, short_row_depth: u32, shapings_per_course: u32 }
    /// Sizes of tubes.
    Tube { min_loops: u32, max_loops: u32 }
    /// Ways of working.
    Methods { increase: Increase, transfer: Transfer }
    /// Stitch sizes.
    StitchNumber { default: u8, xfer: u8, bind_off: u8 }
    /// Take-down.
    Roller { default: u32, xfer: u32 }
    /// Waste section.
    Waste { rows: u32, carrier: String, draw: String }
}

/// Carriage speed.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields are documented once, in FIELDS")]
pub struct Speed {
    pub default: Option<u32>,
    pub range: [u32; 2],
}

macro_rules! words {
    ($($(#[$meta:meta])* $name:ident { $($(#[$doc:meta])* $variant:ident = $word:literal),+ $(,)? })+) => { $(
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
        pub enum $name { $($(#[$doc])* #[serde(rename = $word)] $variant),+ }
    )+ };
}

words! {
    /// What kind of machine a profile describes.
    Kind {
        /// A weft-knitting machine with two facing beds.
        VBed = "v-bed",
    }
    /// How yarn is brought in.
    BringIn {
        /// With the inserting hook.
        Hook = "hook",
        /// By the gripper.
        Gripper = "gripper",
    }
    /// A side of the machine.
    Side {
        /// Where needle numbers are small.
        Left = "left",
        /// Where they are large.
        Right = "right",
    }
    /// A direction as a sign.
    Sign {
        /// To the right.
        Plus = "+",
        /// To the left.
        Minus = "-",
    }
    /// How the second loop of an increase is made.
    Increase {
        /// A tuck against the pass.
        Tuck = "tuck",
        /// A split.
        Split = "split",
    }
    /// How transfers are spread over passes.
    Transfer {
        /// Even needles, then odd ones.
        FourPass = "four-pass",
        /// All at once.
        TwoPass = "two-pass",
    }
}

impl Sign {
    /// The direction.
    pub fn direction(self) -> Direction {
        match self {
            Self::Plus => Direction::Plus,
            Self::Minus => Direction::Minus,
        }
    }
}

/// What a profile file describes.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// A knitting machine.
    VBed(Box<Machine>),
    /// A hand, or a machine that crochets as one.
    Hand(Hand),
}

impl Profile {
    /// Reads a profile of either kind; faults go to the sink.
    pub fn read(source: &Source, sink: &mut Sink<'_>) -> Option<Self> {
        let table: toml::Table = parse(text(source, sink)?, source, sink)?;
        if table.get("kind").and_then(toml::Value::as_str) != Some("hand") {
            return Machine::read(source, sink).map(|machine| Self::VBed(Box::new(machine)));
        }
        let hand: Hand = parse(text(source, sink)?, source, sink)?;
        match hand.fault() {
            None => Some(Self::Hand(hand)),
            Some(what) => broken(&what, source, sink),
        }
    }
}

fn text<'s>(source: &'s Source, sink: &mut Sink<'_>) -> Option<&'s str> {
    match source.text() {
        Ok(text) => Some(text),
        Err(offset) => {
            let message = "the machine profile is not UTF-8 text";
            sink.push(Diagnostic::new(Code::BadProfile, message).at(source.span(offset..offset + 1), ""));
            None
        }
    }
}

fn parse<T: DeserializeOwned>(text: &str, source: &Source, sink: &mut Sink<'_>) -> Option<T> {
    match toml::from_str(text) {
        Ok(value) => Some(value),
        Err(error) => {
            let span = error.span().map_or(crate::diag::Span::NONE, |range| source.span(range));
            let message = error.message().lines().next().unwrap_or("not a machine profile").to_owned();
            let help = "`picot list machines` shows every field; the built-in profiles are examples";
            sink.push(Diagnostic::new(Code::BadProfile, message).at(span, "").help(help));
            None
        }
    }
}

fn broken<T>(what: &str, source: &Source, sink: &mut Sink<'_>) -> Option<T> {
    sink.push(Diagnostic::new(Code::BadProfile, what).at(source.span(0..0), "in this profile"));
    None
}

impl Machine {
    /// A built-in profile by its name, in any case.
    pub fn named(name: &str) -> Option<Self> {
        let (_, text) = MACHINES.iter().find(|(known, _)| known.eq_ignore_ascii_case(name.trim()))?;
        toml::from_str(text).ok()
    }

    /// Reads the profile of a V-bed machine; faults go to the sink.
    pub fn read(source: &Source, sink: &mut Sink<'_>) -> Option<Self> {
        let machine: Self = parse(text(source, sink)?, source, sink)?;
        match machine.fault() {
            None => Some(machine),
            Some((key, what)) => broken(&format!("`{key}` {what}"), source, sink),
        }
    }

    /// The first field whose value makes no sense, with what is wrong.
    fn fault(&self) -> Option<(&'static str, String)> {
        let [first, last] = self.bed.needles;
        let reach = -MAX_NEEDLE..=MAX_NEEDLE;
        if first > last || !reach.contains(&first) || !reach.contains(&last) {
            let what = format!("must rise, within {MAX_NEEDLE} either way");
            return Some(("bed.needles", what));
        }
        let positive = |value: f64| value.is_finite() && value > 0.0;
        if !positive(self.bed.gauge) {
            return Some(("bed.gauge", "must be a positive number of needles per inch".to_owned()));
        }
        if self.carriers.names.is_empty() || self.carriers.names.len() > super::MAX_CARRIERS {
            return Some(("carriers.names", format!("must name 1 to {} carriers", super::MAX_CARRIERS)));
        }
        let known = |name: &String| self.carriers.names.contains(name);
        if !known(&self.carriers.yarn) {
            return Some(("carriers.yarn", "is not among carriers.names".to_owned()));
        }
        if self.carriers.per_op == 0 {
            return Some(("carriers.per_op", "must be at least 1".to_owned()));
        }
        if let Some(waste) = &self.waste
            && !(known(&waste.carrier) && known(&waste.draw))
        {
            return Some(("waste", "names a carrier that is not among carriers.names".to_owned()));
        }
        if self.waste.as_ref().is_some_and(|waste| waste.rows > 10_000) {
            return Some(("waste.rows", "is more than 10000".to_owned()));
        }
        if !positive(self.rack.max) || !positive(self.rack.step) || !positive(self.rack.preferred) {
            return Some(("rack", "needs positive numbers for max, preferred and step".to_owned()));
        }
        if !(0..=1000).contains(&self.entry.hook_width) {
            return Some(("entry.hook_width", "must lie between 0 and 1000".to_owned()));
        }
        if self.tube.max_loops < self.tube.min_loops {
            return Some(("tube.max_loops", "is less than tube.min_loops".to_owned()));
        }
        None
    }

    /// True when the machine performs this Knitout operation.
    pub fn performs(&self, opcode: &str) -> bool {
        let named = |name: &str| self.operations.iter().any(|known| known == name);
        match opcode {
            "amiss" => named("tuck"),
            "drop" => named("drop") || named("knit"),
            "knit" | "tuck" | "split" | "xfer" | "miss" => named(opcode),
            _ => true,
        }
    }

    /// True when the back bed can stand at this rack.
    pub fn can_rack(&self, needles: f64) -> bool {
        let steps = needles / self.rack.step;
        let regular = needles.abs() <= self.rack.max && (steps - steps.round()).abs() < 1e-9;
        regular || self.rack.all_needle.contains(&needles)
    }
}
