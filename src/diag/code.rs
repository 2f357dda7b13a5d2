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
}
