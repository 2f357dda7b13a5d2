//! The one table of diagnostics: a code, its title, and the page that `picot explain` shows.

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Something the reader assumed or did not check.
    Note,
    /// It works, but the outcome may not be what is wanted.
    Warning,
    /// Nothing is written.
    Error,
}

impl Severity {
    /// `error`, `warning` or `note`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

/// Declares all diagnostics. The first letter of a code is its severity: E, W or N. Codes keep their meaning once published.
macro_rules! codes {
    ($($(#[doc = $doc:literal])+ $name:ident = $code:literal, $title:literal;)+) => {
        /// What is wrong. One row of the table each.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Code { $($(#[doc = $doc])+ $name,)+ }

        impl Code {
            /// Every code, in the order of the table.
            pub const ALL: &'static [Self] = &[$(Self::$name,)+];
            /// The published code, such as `E0101`.
            pub fn as_str(self) -> &'static str {
                match self { $(Self::$name => $code,)+ }
            }
            /// A short title.
            pub fn title(self) -> &'static str {
                match self { $(Self::$name => $title,)+ }
            }
            /// The page that `picot explain` shows: what it means, a wrong and a right example.
            pub fn explanation(self) -> &'static str {
                match self { $(Self::$name => concat!($($doc, "\n",)+),)+ }
            }
        }
    };
}

impl Code {
    /// The severity that the first letter names.
    pub fn severity(self) -> Severity {
        match self.as_str().as_bytes()[0] {
            b'E' => Severity::Error,
            b'W' => Severity::Warning,
            _ => Severity::Note,
        }
    }
    /// The code with this published name, in any case.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|code| code.as_str().eq_ignore_ascii_case(name))
    }
}

// E00 words of a pattern, E01 its loops, E02 its numbering and parts, E03 its short rows; W04 and N05 readings of it.
// E10 shape files, E11 the geometry of a shape, W12 and N12 remarks on it. E30 and W34 Picot XML. E90 files and usage.
// E20 reading Knitout, E21 running machine code, E22 what a machine cannot make, E23 k-code; W24 and N25 remarks on these.
codes! {
    /// A row works more loops than the row below left.
    ///
    /// Every stitch is worked into loops of the row below. When those run out, the row cannot be worked.
    ///
    /// Wrong, on 35 loops: `Rnd 8: (4 sc, dec) x 7 (35)` works 42.
    /// Right: `Rnd 8: (3 sc, dec) x 7 (28)` works 35.
    LoopsExhausted = "E0101", "not enough loops to work into";
    /// A round ends although loops of the round below are left.
    ///
    /// Wrong, on 40 loops: `Rnd 9: (6 sc, dec) x 4 (28)` works 32.
    /// Right: `Rnd 9: (6 sc, dec) x 5 (35)`.
    LoopsLeft = "E0102", "loops of the round below are left unworked";
    /// The stated stitch count is not the number of loops that the row makes.
    ///
    /// Wrong, on 21 loops: `Rnd 4: (2 sc, inc) x 7 (27)` makes 28.
    /// Right: `Rnd 4: (2 sc, inc) x 7 (28)`.
    CountDiffers = "E0103", "the stated count differs from the loops made";
    /// A direction mark has no partner: a short row is left open, or closed without having been opened.
    ///
    /// Wrong: `10 sc -> 16 sc`. Right: `18 sc <- -8 sc -> 16 sc`.
    UnbalancedTurn = "E0301", "a turn without its partner";
    /// The back pass of a short row is longer than the loops that lie behind the hook.
    ///
    /// A short row works back into loops just made. It never outgrows its round.
    BackPassTooLong = "E0302", "the back pass of a short row is too long";
    /// Loops that are held for a part are not picked up by it, or are picked up twice.
    ///
    /// Wrong: `5 sc, hold 8 sts for Arm, 21 sc`, and no part `Arm` that is worked from these loops.
    /// Right: the same, and later `Arm: from Body rnd 3 sts 6-13 held`.
    HeldLoops = "E0206", "held loops are not used exactly once";
    /// A part starts from loops that the part it names does not leave.
    ///
    /// A joined part begins with the open loops of finished parts, each used once, and the chains between them. The numbers
    /// of loops must agree: two legs that end on 14 give 28, and 3 chains between and behind them 34.
    JoinLoops = "E0207", "joined loops do not add up";
    /// A back pass is worked over more than 0.6 of its round.
    ///
    /// It can be worked, but a short row that long is hard to count and rarely lies flat.
    BackPassLong = "W0408", "the back pass of a short row is long";
    /// A decrease takes one loop from either side of a turn.
    ///
    /// At the turn of a short row neighboring loops stand one row apart; working them together pulls the fabric.
    /// Wrong, on 20: `12 sc <- -4 sc -> 3 sc, dec, 7 sc`. Right: `12 sc <- -4 sc -> 2 sc, dec, 8 sc`.
    SpansTurn = "W0409", "a stitch spans a turn";
    /// A structure of the intermediate representation is broken: a defect of the program that made it.
    ///
    /// Graph and pattern must tell the same steps, references must point to what exists. Please report it.
    BrokenProgram = "E0901", "the program is inconsistent";
    /// A pattern has more loops, rows or nested repeats than Picot handles.
    ///
    /// The caps keep memory and time in bounds for any input.
    TooLarge = "E0902", "too large";
    /// An option of the generator is out of its range.
    ///
    /// Wrong: `--set max-short-row=2`. Right: `--set max-short-row=0.5`.
    /// `picot build --help` names the options; the message names the range.
    OptionOutOfRange = "E1301", "an option is out of range";
    /// The tube is too short for its stitch: not even one round can be worked.
    ///
    /// A tube needs at least two rows from end to end, a closed end half a row more.
    ///
    /// Wrong: a tube 3 mm long with stitches 5 mm high.
    /// Right: a smaller stitch, or a longer tube.
    TooFewRows = "E1302", "too few rows";
    /// The surface cannot be covered: it folds over itself, jumps, or has no finite size.
    ///
    /// Rows are laid at equal distance along the surface. Where it bends more sharply than its own radius allows, or where
    /// neighboring sections differ by far more than a row can follow, stitches run away.
    ///
    /// Wrong: a tube of radius 3 around a bend of radius 1.
    /// Right: a wider bend, or a thinner tube.
    SurfaceBroken = "E1303", "the surface cannot be covered";
    /// The file is not well-formed XML.
    ///
    /// Tags must nest and be closed, an attribute stands once and has quotes, there is one root element, and only
    /// characters of XML 1.0 occur.
    ///
    /// Wrong: `<round number="1"><work op="sc"></round>`
    /// Right: `<round number="1"><work op="sc"/></round>`
    XmlSyntax = "E3001", "not well-formed XML";
    /// XML allows it, Picot does not: a DOCTYPE, a processing instruction, an entity of one's own.
    ///
    /// They can pull in other files or blow up a small file to a huge one, and say nothing about a pattern.
    ///
    /// Wrong: `<!DOCTYPE program SYSTEM "picot.dtd">`
    /// Right: the file begins with `<program xmlns="urn:picot:program:1" ..>`; the schemas are in `grammar/`.
    XmlForbidden = "E3002", "a construct that Picot XML does not allow";
    /// The file is not UTF-8, or its XML declaration names another encoding.
    ///
    /// Wrong: `<?xml version="1.0" encoding="ISO-8859-1"?>`
    /// Right: `<?xml version="1.0" encoding="UTF-8"?>`, saved as UTF-8.
    XmlEncoding = "E3003", "the file is not UTF-8";
    /// The root element is not `program` in the namespace of Picot.
    ///
    /// Wrong: `<program version="1.0" name="cup" unit="mm">`
    /// Right: `<program xmlns="urn:picot:program:1" version="1.0" name="cup" unit="mm">`
    XmlNamespace = "E3004", "not a Picot XML file";
    /// The major version is not the one that this Picot reads.
    ///
    /// Another major version is another language. A newer minor version is read with a warning.
    ///
    /// Wrong: `version="2.0"`. Right: `version="1.0"`.
    XmlVersion = "E3005", "unknown version of Picot XML";
    /// An element that does not belong here, or not in this place.
    ///
    /// Wrong: `<round ..><wrok op="sc"/></round>`
    /// Right: `<round ..><work op="sc"/></round>`
    XmlElement = "E3006", "an unknown or misplaced element";
    /// An attribute that the element does not have.
    ///
    /// Wrong: `<work op="sc" time="6"/>`
    /// Right: `<work op="sc" times="6"/>`
    XmlAttribute = "E3007", "an unknown attribute";
    /// An attribute or an element that must be there is not.
    ///
    /// Wrong: `<turn/>`
    /// Right: `<turn direction="back"/>`
    XmlMissing = "E3008", "a required attribute or element is missing";
    /// The value of an attribute is not of its kind: no number, no such word, out of range.
    ///
    /// Wrong: `<work op="sc" times="six"/>`, `<work op="xc"/>`
    /// Right: `<work op="sc" times="6"/>`, `<work op="sc"/>`
    XmlValue = "E3009", "a bad value";
    /// A count, the depth of nesting or the number of attributes passes its cap.
    ///
    /// The caps keep memory and time in bounds for any file: nothing is allocated by a number that a file only claims.
    ///
    /// Wrong: `<repeat times="4000000000">`, or repeats 17 deep.
    XmlTooLarge = "E3010", "larger than Picot reads";
    /// A reference to a part, a yarn or a node that does not exist.
    ///
    /// Wrong: `<hold loops="6" by="amr"/>` where the part is named `arm`.
    /// Right: `<hold loops="6" by="arm"/>`
    XmlReference = "E3011", "a reference to what does not exist";
    /// A name or an id that must be unique stands twice, or an element that stands once.
    ///
    /// Wrong: two parts with `name="leg"`. Right: one part with `copies="2"`, or two names.
    XmlDuplicate = "E3012", "given twice";
    /// The counts that the file states do not fit its steps.
    ///
    /// Rounds are numbered without gaps, each consumes what the one below produces, and produces what its steps leave.
    ///
    /// Wrong: `<round number="2" consumes="6" produces="12"><work op="inc" times="5"/></round>`
    /// Right: `<round number="2" consumes="6" produces="12"><work op="inc" times="6"/></round>`
    XmlCounts = "E3013", "the counts do not fit";
    /// Text between elements.
    ///
    /// All values stand in attributes; text would be lost, so it is refused. Comments are allowed.
    XmlText = "E3014", "text where only elements stand";
    /// A newer minor version of Picot XML wrote the file.
    ///
    /// What this version knows is read; every name that it does not know is ignored with a warning of its own.
    XmlNewer = "W3401", "the file is of a newer minor version";
    /// A name that this version does not know, in a file of a newer minor version.
    XmlIgnored = "W3402", "an unknown name is ignored";
    /// The first round after a magic ring has the number 1.
    ///
    /// Picot counts the stitches of the ring as round 1, as written patterns do, so the round after it is round 2. The
    /// file is read as if its numbers were one higher.
    XmlRingNumber = "W3403", "the rounds do not count the magic ring";
    /// The first line of a Knitout file is not `;!knitout-2`.
    ///
    /// The magic line names the format and its version. Nothing may stand before it, not even a byte order mark.
    ///
    /// Wrong: `;;Carriers: 1 2 3` as line 1. Right: `;!knitout-2` as line 1, the headers below.
    KnitoutMagic = "E2001", "the magic line is missing";
    /// An operation that Knitout does not have.
    ///
    /// Opcodes are lower case: in, inhook, releasehook, out, outhook, stitch, rack, knit, tuck, split, drop, amiss, xfer,
    /// miss, pause, and extensions that begin with `x-`.
    ///
    /// Wrong: `purl - f10 1`. Right: `knit - b10 1`.
    UnknownOperation = "E2002", "no such operation";
    /// An operation has too few or too many arguments.
    ///
    /// Wrong: `knit +`. Right: `knit + f10 1`; direction, needle, carriers.
    WrongArguments = "E2003", "wrong number of arguments";
    /// A needle is not `f`, `b`, `fs` or `bs` with a number.
    ///
    /// Wrong: `drop 10`. Right: `drop f10`, `drop bs-2`.
    BadNeedle = "E2004", "not a needle";
    /// A direction is neither `+` nor `-`.
    ///
    /// Wrong: `knit f10 1`. Right: `knit + f10 1`.
    BadDirection = "E2005", "not a direction";
    /// A number is not one, or a rack is no multiple of a quarter needle.
    ///
    /// Wrong: `rack left`, `rack 0.3`. Right: `rack -1`, `rack 0.25`.
    BadMachineNumber = "E2006", "not a number";
    /// A carrier does not stand in the `Carriers` header.
    ///
    /// Wrong, with `;;Carriers: 1 2 3`: `inhook 11`. Right: `inhook 1`, or add the carrier to the header.
    UnknownCarrier = "E2007", "carrier not in the header";
    /// A carrier is named twice: in one operation, or in the header.
    ///
    /// Wrong: `in 1 1`. Right: `in 1`.
    RepeatedCarrier = "E2008", "carrier named twice";
    /// A file of machine code is not UTF-8 text.
    ///
    /// Knitout and k-code are plain text; the label shows the first byte that is not.
    MachineCodeNotText = "E2009", "not text";
    /// A pattern is wanted and the file is machine code.
    ///
    /// Which crochet stitches a knitting program stands for cannot be told. It can be checked (`picot check in.k`) and
    /// converted (`picot build in.k -o out.kc`).
    NoPattern = "E2010", "machine code holds no pattern";
    /// A carrier is used although it is out.
    ///
    /// Wrong: `knit - f10 1` with no `in 1` or `inhook 1` before it, or after `out 1`.
    CarrierOut = "E2101", "carrier used while out";
    /// A carrier is brought in although it is in.
    ///
    /// Wrong: `in 1`, `in 1`. Right: `in 1`, knit, `out 1`, `in 1`.
    CarrierInTwice = "E2102", "carrier brought in twice";
    /// A carrier is taken out although it is not in.
    ///
    /// Wrong: `outhook 2` with no `inhook 2` before it.
    CarrierNotIn = "E2103", "carrier taken out while out";
    /// A `releasehook` names carriers that the hook does not hold.
    ///
    /// Right: `inhook 1`, the first loops, `releasehook 1`.
    HookEmpty = "E2104", "the hook does not hold this yarn";
    /// The hook lets go of a yarn that has made no loop.
    ///
    /// Wrong: `inhook 1`, `releasehook 1`, `tuck - f10 1`. Right: the `releasehook` after the first bed of loops.
    HookReleasedEarly = "E2105", "the hook is released too early";
    /// A yarn comes in with the hook while the hook holds another.
    ///
    /// There is one inserting hook. Right: `inhook 1`, loops, `releasehook 1`, `inhook 2`.
    HookOccupied = "E2106", "the hook is occupied";
    /// A carrier is taken out while the inserting hook still holds its yarn.
    ///
    /// Right: `releasehook 1` before `outhook 1`.
    CarrierInHook = "E2107", "the yarn is still in the hook";
    /// A transfer or a split within one bed.
    ///
    /// Wrong: `xfer f10 f11`. Right: `xfer f10 b10`, `rack 1`, `xfer b10 f11`, `rack 0`.
    TransferWithinBed = "E2108", "transfer within a bed";
    /// A transfer or a split between needles that do not face each other.
    ///
    /// At rack R the back needle B faces the front needle B + R.
    ///
    /// Wrong, at rack 0: `xfer f10 b11`. Right: `rack -1`, `xfer f10 b11`.
    TransferUnaligned = "E2109", "the needles do not face each other";
    /// A loop is formed on a slider, or the machine has no sliders.
    ///
    /// Sliders hold loops that were transferred to them; they cannot form one.
    LoopOnSlider = "E2110", "a loop on a slider";
    /// A needle lies beyond the bed (`bed.needles` of the profile).
    ///
    /// Center the program on the bed, or make the object narrower.
    NeedleOffBed = "E2111", "needle beyond the bed";
    /// A rack is beyond the machine (`rack.max`), or between its steps (`rack.step`).
    ///
    /// Racks of `rack.all_needle` are fine too.
    RackBeyond = "E2112", "rack beyond the machine";
    /// A hook operation on a machine without inserting hook (`entry.bring_in`).
    ///
    /// Wrong, on a Kniterate: `inhook 1`. Right: `in 1`.
    NoHook = "E2113", "the machine has no inserting hook";
    /// More carriers than the machine takes: in one operation (`carriers.per_op`), or in all (`carriers.names`).
    ///
    /// Wrong, on a Kniterate: `tuck + f100 1 2`. Right: `tuck + f100 1`, `tuck + f100 2`.
    TooManyCarriers = "E2114", "too many carriers";
    /// The first pass of a yarn goes the wrong way (`entry.first_direction`).
    ///
    /// The carrier comes from the side where it parks: from the right, its first pass must go left.
    FirstDirection = "E2115", "the first pass goes the wrong way";
    /// A needle is worked that the parked inserting hook covers (`entry.hook_width`).
    ///
    /// The hook parks just right of the first stitch until `releasehook`.
    NeedleUnderHook = "E2116", "needle under the parked hook";
    /// An operation that the machine does not perform (`operations`).
    ///
    /// The profile lists what it does.
    OperationNotPerformed = "E2117", "operation not performed by the machine";
    /// A machine profile cannot be read.
    ///
    /// A profile is TOML; `picot list machines` shows every field with its meaning.
    BadProfile = "E2190", "the machine profile is broken";
    /// A Knitout file has no `Carriers` header.
    ///
    /// Without it, which carriers exist is guessed from their use. Right: `;;Carriers: 1 2 3 4 5 6` below the magic line.
    CarriersHeaderMissing = "W2401", "no Carriers header";
    /// A header line stands after the comment header, where it is only a comment.
    ///
    /// The comment header ends at the first line that does not begin with `;;`.
    LateHeader = "W2402", "header line after the comment header";
    /// Lines end in CR LF; the format wants LF.
    ///
    /// Some tools stop at the CR.
    CarriageReturns = "W2403", "CR LF line ends";
    /// The magic line names a version that is newer than Picot knows.
    ///
    /// The file is read as version 2.
    NewerKnitout = "W2404", "newer version of the format";
    /// An extension that nobody in sight understands; it is ignored.
    ///
    /// The profile lists the ones of its machine (`extensions`).
    UnknownExtension = "W2405", "unknown extension";
    /// A header that the format does not have; it is ignored.
    ///
    /// Known are Carriers, Machine, Gauge, Yarn-C, Position and Width; others should begin with `X-`.
    UnknownHeader = "W2406", "unknown header";
    /// A header stands twice; the last one counts.
    DuplicateHeader = "W2407", "header given twice";
    /// A line begins with `;;` and is no header, which ends the comment header.
    ///
    /// Wrong: `;;Carriers 1 2 3`. Right: `;;Carriers: 1 2 3`.
    MalformedHeader = "W2408", "a `;;` line that is no header";
    /// An operation on carriers names none, so it does nothing.
    NoCarrier = "W2409", "no carrier named";
    /// Loops hang on needles when the program ends.
    ///
    /// Bind off, or drop what is secured; else the piece unravels when it is taken off.
    LoopsLeftOnNeedles = "W2411", "loops left on needles";
    /// A carrier is in when the program ends.
    ///
    /// The next program meets it in its way. Right: `out` or `outhook` at the end.
    CarrierLeftIn = "W2412", "carrier left in";
    /// A needle without loops is knit: the loop hangs in nothing, and may not form at all.
    ///
    /// Start a wale with a tuck.
    KnitOnEmpty = "W2413", "knit on an empty needle";
    /// A drop, transfer or split from a needle that holds no loop.
    NeedleEmpty = "W2414", "the needle is empty";
    /// Loops are transferred while the yarn is held by the inserting hook, which is in the way.
    TransferWithHook = "W2415", "transfer with the yarn in the hook";
    /// A needle holds more loops than it can knit (`limits.loops_per_needle`).
    StackTooLarge = "W2416", "too many loops on a needle";
    /// The yarn floats over more needles than is good (`limits.float`).
    LongFloat = "W2417", "long float";
    /// Racking or a transfer pulls two neighboring loops too far apart (`limits.link_stretch`).
    LinkStretched = "W2418", "stretched link";
    /// The bed is racked to where it stands.
    RackRedundant = "W2419", "redundant rack";
    /// A carrier is brought in and taken out unused.
    CarrierUnused = "W2420", "carrier not used";
    /// A yarn comes in by the gripper on a machine with a hook: its end is loose.
    LooseYarn = "W2421", "loose yarn end";
    /// The value of an extension lies outside the range of the profile.
    ValueOutOfRange = "W2422", "value out of range";
}
