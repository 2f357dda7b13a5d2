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
    /// A word or mark of a pattern is not known.
    ///
    /// Nothing that is not understood is skipped or guessed: one unread word can hide a whole increase.
    /// Where a known word is one letter away, it is offered.
    ///
    /// Wrong: `Rnd 6: (2 sc, flurb) x 6 (18)`. Right: `Rnd 6: (2 sc, dec) x 6 (18)`, on 24.
    /// A stitch of your own is declared: `def flurb = 2 -> 1`.
    UnknownTerm = "E0001", "a word that is not known";
    /// A bracket or a star has no partner.
    ///
    /// Wrong: `Rnd 5: (3 sc, inc x 4 (20)`. Right: `Rnd 5: (3 sc, inc) x 4 (20)`.
    /// Wrong: `3 sc, inc; rep from * 3 more times`. Right: `*3 sc, inc; rep from * 3 more times`.
    Unbalanced = "E0002", "a bracket or star without its partner";
    /// A multiplier is missing its number, is zero, or stands on both sides.
    ///
    /// Wrong: `(3 sc, inc) x`, `(3 sc, inc) x 0`, `3 x (sc, inc) x 4`. Right: `(3 sc, inc) x 4`.
    ///
    /// A repeat needs one number, before or behind the bracket.
    BadMultiplier = "E0003", "a multiplier that says nothing or too much";
    /// A number without a stitch, a separator without a clause, or a row without instructions.
    ///
    /// Wrong: `Rnd 4: 3, inc`. Right: `Rnd 4: 3 sc, inc`.
    ///
    /// Every number says how many of what, and every comma stands between two instructions.
    MissingOperand = "E0004", "a number or a stitch is missing";
    /// The line goes on after all that could be read.
    ///
    /// A labeled line must be read completely.
    ///
    /// Wrong: `Rnd 4: 24 sc (24) (25)`. Right: `Rnd 4: 24 sc (24)`, and remarks behind `//`.
    Leftover = "E0005", "something is left over";
    /// A number, a line, or the nesting of brackets passes a limit.
    ///
    /// A row may have 100,000 loops, a file 10 million, brackets may nest 16 deep, a line may have one megabyte.
    /// The limits keep time and memory in bounds for any text.
    ///
    /// Wrong: `(sc x 999999999) x 999999999`. Right: numbers that can be crocheted.
    Limit = "E0006", "too large";
    /// The pattern uses `dc`, `tr` or `dtr`, and nothing tells whether they are US or UK terms.
    ///
    /// A US `dc` is three times as high as a UK `dc`. A pattern with only these words needs `terms: us` or `terms: uk`.
    /// A pattern with words of both, such as `sc` and `htr`, is refused.
    TermsUndecided = "E0007", "US or UK terms";
    /// More than one reading fits, and nothing decides.
    ///
    /// Wrong, on 16 loops: `Rnd 6: 3 sc, inc around`; it may mean `(3 sc, inc) around` or `3 sc, then inc to the end`.
    /// Right: `Rnd 6: (3 sc, inc) around (20)`, or a stated count that only one reading gives, or a convention in the file.
    Ambiguous = "E0008", "more than one reading fits";
    /// The text holds bytes or characters that a pattern must not have.
    ///
    /// A pattern is UTF-8 text. Control characters, and marks that change the order in which text is shown, are refused,
    /// for what is read must be what is seen.
    ///
    /// Wrong: a file saved as `UTF-16` or `Latin-1`. Right: the same saved as `UTF-8`.
    BadText = "E0009", "not readable text";
    /// A declaration at the head of the file has a value that means nothing.
    ///
    /// Wrong: `terms: british`. Right: `terms: uk`. Wrong: `convention: star-times=some`. Right: `convention: star-times=more`.
    ///
    /// The declarations are `title`, `terms`, `lang`, `gauge`, `yarn`, `hook`, `color`, `convention` and `def`.
    BadHeader = "E0010", "a declaration that means nothing";
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
    /// A repeat that goes to the end of the row does not come out even.
    ///
    /// Wrong, on 29 loops: `*5 sc, inc; rep from * around`; it fits a multiple of 6 (24 or 30).
    /// Right: `*5 sc, inc; rep from * to last 5 sts, 5 sc`.
    Indivisible = "E0104", "a repeat that does not fit";
    /// A row works loops, but nothing lies below it.
    ///
    /// The first round of a part makes its own loops: a magic ring, a chain, or loops of another part.
    ///
    /// Wrong as a first line: `Rnd 2: [3 sc, inc] around (15)`. Right before it: `Rnd 1: 12 sc in MR (12)`.
    NoFoundation = "E0105", "nothing to work into";
    /// The foundation chain does not give the stated number of stitches.
    ///
    /// Chains that are skipped at the hook are not worked into.
    ///
    /// Wrong: `Row 1: ch 14, sc in 2nd ch from hook and in each ch across (14)` makes 13.
    /// Right: `Row 1: ch 15, sc in 2nd ch from hook and in each ch across (14)`.
    ChainLength = "E0106", "the foundation chain has the wrong length";
    /// A row has two open-ended repeats, or one inside a counted repeat: no number follows from it.
    ///
    /// Wrong: `sc around, inc around`. Right: `12 sc, inc to end`.
    ///
    /// One open end per row can be worked out from the loops below; the rest of the row needs numbers.
    TwoFills = "E0107", "an open-ended repeat that nothing limits";
    /// A range of rounds runs backward, overlaps, or does not have as many rounds as it says.
    ///
    /// Wrong: `Rnds 9-7: 24 sc`, `Rnds 7-9 (4 rnds): 24 sc`. Right: `Rnds 7-9 (3 rnds): 24 sc`.
    ///
    /// The rounds of a range follow each other, and the number in brackets is how many they are.
    BadRange = "E0201", "a range of rounds that does not add up";
    /// A range of rounds changes its count, so one count cannot vouch for all of them.
    ///
    /// Wrong, on 15 loops: `Rnds 4-6: (4 sc, inc) x 3 (18)`. Right: one line a round.
    ///
    /// Right: `Rnd 4: (4 sc, inc) x 3 (18)`, `Rnd 5: (5 sc, inc) x 3 (21)`, `Rnd 6: (6 sc, inc) x 3 (24)`.
    RangeChangesCount = "E0202", "a range of rounds that changes its count";
    /// A round is missing: the numbers have a gap.
    ///
    /// Rows are numbered without gaps, so that a dropped line shows.
    ///
    /// Wrong: `Rnd 4: ..` and then `Rnd 6: ..`. Right: `Rnd 4: ..`, `Rnd 5: ..`, `Rnd 6: ..`, or `Rnds 4-6: ..`.
    RoundMissing = "E0203", "a round is missing";
    /// A round number comes twice.
    ///
    /// A line may have been copied twice, or a new part begins that has no name.
    ///
    /// Wrong: two lines `Rnd 5: 24 sc (24)`. Right: `Rnds 5-6: 24 sc (24)`, or `Arm:` on a line before the second `Rnd 1`.
    RoundTwice = "E0204", "a round number comes twice";
    /// A part or a row that another line names does not exist before it.
    ///
    /// A part starts from parts above it, and a repeat of rows names rows above it.
    ///
    /// Wrong: `Body: join Leg + ch 3 + Leg` without a part `Leg:` before it. Right: `Leg (make 2):` first.
    NoSuchPart = "E0205", "no such part or row";
    /// A direction mark has no partner: a short row is left open, or closed without having been opened.
    ///
    /// Wrong: `10 sc -> 16 sc`
    /// Right: `18 sc <- -8 sc -> 16 sc`
    UnbalancedTurn = "E0301", "a turn without its partner";
    /// The back pass of a short row is longer than the loops that lie behind the hook.
    ///
    /// A short row works back into loops just made. It never outgrows its round.
    ///
    /// Wrong, on 26 loops: `16 sc, <- 27 sc, -> 27 sc`
    /// Right: `16 sc, <- 12 sc, -> 12 sc, 10 sc`
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
    ///
    /// Long, on 26 loops: `22 sc, <- 20 sc, -> 20 sc, 4 sc`
    /// Better: `18 sc, <- 12 sc, -> 12 sc, 8 sc`
    BackPassLong = "W0408", "the back pass of a short row is long";
    /// A decrease takes one loop from either side of a turn.
    ///
    /// At the turn of a short row neighboring loops stand one row apart; working them together pulls the fabric.
    /// Wrong, on 20: `12 sc <- -4 sc -> 3 sc, dec, 7 sc`. Right: `12 sc <- -4 sc -> 2 sc, dec, 8 sc`.
    SpansTurn = "W0409", "a stitch spans a turn";
    /// The sign of a back pass stands at a stitch that is worked forward.
    ///
    /// Wrong: `10 sc, -6 sc`. Right: `10 sc <- -6 sc -> 16 sc`.
    ///
    /// The sign repeats what the mark `<-` says, so it is right only between `<-` and `->`.
    StrayBackSign = "E0303", "the sign of a back pass outside of one";
    /// The count of loops shows that a phrase has another meaning here than its usual one.
    ///
    /// The reading that fits both the loops below and the stated count was taken. Declare it, and the warning goes away.
    ///
    /// Example: `*7 sc, sc2tog; rep from * 3 times (32)` on 36 means 4 passes; `convention: star-times=more` says so.
    ReadingOverruled = "W0401", "read otherwise than by convention, because the loops say so";
    /// Two rows of one file need different readings of the same phrase.
    ///
    /// A maker means the same phrase the same way throughout, so one of the two rows is probably wrong.
    ///
    /// Declare what is meant, for example `convention: star-times=total`, and the other row is reported.
    ReadingsMixed = "W0402", "two readings of one phrase in one file";
    /// A turning chain of three or more may or may not count as a stitch, and nothing says it.
    ///
    /// Write `ch 3 (counts as dc)` or `ch 3 (does not count)`.
    ///
    /// Chains of one or two are taken for mere height; a chain of three is as high as a US `dc` and often stands for one.
    TurningChainUnsaid = "W0403", "a turning chain that may count";
    /// Round numbers begin anew, so a new part without a name begins.
    ///
    /// Wrong: a second `Rnd 1: 6 sc in MR` in the middle of a file.
    /// Right: `Arm:` on a line of its own before it.
    PartUnnamed = "W0404", "a new part without a name";
    /// A row ends with a turn before all loops are worked.
    ///
    /// This is read only with `convention: unworked=turn`.
    /// Right: `sc in next 13 sts, leave last 7 sts unworked`.
    LoopsRemain = "W0405", "loops remain beyond a turn";
    /// The marks of a short row leave no loop for the turn itself, as the paper's tiles need one.
    ///
    /// The row can be worked. Example on 24: `6 sc <- -6 sc -> 24 sc` goes back over all stitches made so far.
    /// With `convention: turn-mark=bare` nothing is said about it.
    TurnTight = "W0406", "no loop left for the turn";
    /// Loops are held for a part that the file does not hold.
    ///
    /// The pattern is read as far as it goes; the loops wait on a piece of yarn.
    /// Right: a part such as `Arm: from Body rnd 2 sts 6-13 held`.
    HeldForNobody = "W0410", "loops held for a part that is not in the file";
    /// `evenly spaced` leaves the places open; they were spread by equal gaps.
    ///
    /// Example: `20 sc, 4 dec evenly spaced` becomes `2 sc, dec, 5 sc, dec, 5 sc, dec, 5 sc, dec, 3 sc`, half a gap at the start.
    /// Write the repeat out where the places matter, or declare `convention: evenly=refuse`.
    SpreadEvenly = "N0501", "places chosen";
    /// A row goes into chain spaces. It was checked for running past the end, but not loop by loop.
    ///
    /// Example: `(2 dc, ch 1, 2 dc) in next ch-1 sp`: a space is a place, not a loop.
    /// The stated count is still held against the stitches made.
    NotChecked = "N0502", "not checked loop by loop";
    /// A line without instructions was kept as a note.
    ///
    /// Example: `Attach the eyes between rounds 7 and 8.`
    /// A remark that begins with `//` or `note:` is kept without a word.
    LineKept = "N0503", "a line kept as a note";
    /// More than one reading was possible; the loops below and the stated count decided.
    ///
    /// Example on 32: `6 sc, dec around (28)` can only mean that the whole list is repeated.
    /// Declare the convention, here `trailing-around=list`, and nothing is left open.
    ReadingByCount = "N0504", "a reading decided by the count";
    /// A row could not be read, so the next one starts from its stated count.
    ///
    /// Nothing is filled in for a line that cannot be read. Example: after `Rnd 6: (2 sc, flurb) x 6 (18)` the next round
    /// is checked on 18 loops.
    FromStated = "N0505", "goes on from a stated count";
    /// A structure of the intermediate representation is broken: a defect of the program that made it.
    ///
    /// Graph and pattern must tell the same steps, references must point to what exists. No input can cause it.
    ///
    /// Wrong: a part that picks up loops of a part that does not exist.
    /// Right: please report it, with the input that led here.
    BrokenProgram = "E0901", "the program is inconsistent";
    /// A pattern has more loops, rows or nested repeats than Picot handles.
    ///
    /// The caps keep memory and time in bounds for any input.
    ///
    /// Wrong: `((sc) x 99999) x 99999`
    /// Right: at most 100,000 loops in a round and 50 million in all.
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
    /// Wrong: two parts with `name="leg"`
    /// Right: one part with `copies="2"`, or two names.
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
    ///
    /// Wrong: text between two rounds
    /// Right: the same as a comment, `<!-- ... -->`
    XmlText = "E3014", "text where only elements stand";
    /// A newer minor version of Picot XML wrote the file.
    ///
    /// What this version knows is read; every name that it does not know is ignored with a warning of its own.
    ///
    /// Seen: a file of version 1.1 read by a program of version 1.0
    /// Better: a newer Picot.
    XmlNewer = "W3401", "the file is of a newer minor version";
    /// A name that this version does not know, in a file of a newer minor version.
    ///
    /// The rest of the file is read without it. In a file of this version the same name is an error.
    ///
    /// Seen: an attribute such as `mood="calm"` in a file of a newer version
    /// Better: a newer Picot.
    XmlIgnored = "W3402", "an unknown name is ignored";
    /// The first round after a magic ring has the number 1.
    ///
    /// Picot counts the stitches of the ring as round 1, as written patterns do, so the round after it is round 2. The
    /// file is read as if its numbers were one higher.
    ///
    /// Read: a ring of 6, then round 1
    /// Meant: a ring of 6, then round 2
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
    /// A stitch has no counterpart on a knitting machine.
    ///
    /// Every loop of a tube stays live on its needle until it is worked, so chains inside a round, skipped stitches, rows
    /// that turn and parts that begin on loops of another part are not knit. Taller stitches and stitches into one strand
    /// can be approximated: `--set approximate=true`.
    NotKnittable = "E2201", "no counterpart in knitting";
    /// The machine cannot make the object: too wide, too narrow, too many loops on a needle, too long a short row.
    ///
    /// Part, round and stitch say where; the help names the field of the profile and what would fit.
    BeyondMachine = "E2202", "the machine cannot make this";
    /// A machine program does not make the loops of the pattern.
    ///
    /// The program is executed and its loops are compared with the pattern's: the same stitches, in the same order, each
    /// pulled through the same loops. The first difference of a part is shown.
    NotTheSame = "E2203", "the program does not make the pattern";
    /// A k-code file has no HOME line.
    ///
    /// Right: `HOME` as the first line, after the comments that one dialect begins with.
    KcodeHead = "E2301", "no HOME line";
    /// The lines of a k-code pass are incomplete, repeated or mixed with others.
    ///
    /// A pass is FRNT, STIF, REAR, STIR and a move, in any order of the first four.
    KcodePass = "E2302", "a broken pass";
    /// A FRNT or REAR line is not 15 dots, 252 cells, 15 dots, or a STIF or STIR line holds other than 0-9 and A-Z.
    ///
    /// Stop marks (`/`, `\`, digits) stand between the characters of FRNT and REAR and do not count.
    KcodeBed = "E2303", "a broken bed line";
    /// A move line has a wrong number of fields, or a type that does not fit its direction.
    ///
    /// Wrong: `>> Tr-Rl 0 300 0`. Right: `>> Tr-Rr 0 300 0`, since the last letter follows the direction.
    KcodeMove = "E2304", "a broken move";
    /// A rack, carrier, speed or roller value is no number or out of range.
    ///
    /// Wrong: `RACK:0.25`, `>> Kn-Kn 7 300 100`. Right: `RACK:0.5`, `>> Kn-Kn 2 300 100`.
    KcodeNumber = "E2305", "not a number of k-code";
    /// The carriage does not go to and fro: the first pass goes right, then directions alternate.
    ///
    /// Right: a move of the carriage alone between two passes of one direction, `<< Kn-Kn 0 300 0` with nothing marked.
    KcodeDirection = "E2306", "passes do not alternate";
    /// The stop marks of a pass contradict each other or its move.
    ///
    /// FRNT and REAR have the same marks: one `/`, one `\`, and the number of the carrier that the move names, twice.
    KcodeMarks = "E2307", "stop marks disagree";
    /// A transfer without its receiving needle, or at a rack at which needles do not face each other.
    ///
    /// At rack R the cell c of REAR faces the cell c + R of FRNT; both are marked `-`.
    KcodeTransfer = "E2308", "a broken transfer";
    /// A program has something that k-code has no words for.
    ///
    /// A Kniterate has six carriers named 1 to 6, one for each operation, no hook and no sliders, and racks by whole or half
    /// needles on a bed of 252.
    NotKcode = "E2310", "k-code cannot say this";
    /// A stitch without an exact counterpart is knit as a plain loop, as `approximate=true` asks.
    Approximated = "W2431", "a stitch is approximated";
    /// A tube has fewer loops than the machine is known to hold well (`tube.min_loops`).
    NarrowTube = "W2432", "a narrow tube";
    /// The number of stitch sizes differs from the number of cells of the bed line.
    KcodeSizes = "W2433", "stitch sizes of another length";
    /// Crochet cannot be made by a V-bed machine: each stitch is knit as one loop, and nobody has run the file.
    ///
    /// Increases, decreases and short rows stay where they are. The gauge comes from a swatch knit on that machine.
    ///
    /// Example: `picot build ball.toml --machine kniterate -o ball.kc`; the machine reads a file named `command.kc`.
    KnitInstead = "N2501", "re-lowered to knitting";
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
    /// The file is not TOML.
    ///
    /// Shape files are written in TOML: `key = value` lines under `[table]` headers, texts in quotes, lists in brackets.
    ///
    /// Wrong: `unit = cm`
    /// Right: `unit = "cm"`
    TomlSyntax = "E1001", "the file is not TOML";
    /// A key that a shape file does not know, often a slip of the finger.
    ///
    /// Nothing is skipped in silence: a misspelled key would change the object. The keys are listed in `grammar/shape.md`.
    ///
    /// Wrong: `sections = [{ at = 0, circle = 1 }]`
    /// Right: `section = [{ at = 0, circle = 1 }]`
    UnknownKey = "E1002", "unknown key";
    /// A key that must be there is missing.
    ///
    /// A shape file needs `[gauge]` and `[trunk]`; a trunk needs `curve` and `section`; a section needs `at`.
    ///
    /// Wrong: `section = [{ circle = 1 }]`
    /// Right: `section = [{ at = 0, circle = 1 }]`
    MissingKey = "E1003", "a key is missing";
    /// A value has another type than the key takes.
    ///
    /// Numbers stand without quotes and without a unit: the unit of all lengths is the file's `unit`.
    ///
    /// Wrong: `circle = "2 cm"`
    /// Right: `circle = 2`
    WrongType = "E1004", "a value of the wrong type";
    /// A word that is none of those that the key takes.
    ///
    /// `unit` is mm, cm or in; `start` and `end` are open or closed; `interpolation` is linear or smooth.
    ///
    /// Wrong: `end = "close"`
    /// Right: `end = "closed"`
    UnknownWord = "E1005", "not one of the possible words";
    /// A number that is no size: not a number, infinite, or beyond 10 km.
    ///
    /// Wrong: `circle = nan`
    /// Right: `circle = 1.5`
    BadNumber = "E1006", "not a usable number";
    /// The file does not say how large a stitch is.
    ///
    /// The same shape takes other stitches in other yarn, so a gauge is needed, in one of three ways: measured on a
    /// swatch (best), as the size of a stitch, or as yarn and hook (an estimate).
    ///
    /// Wrong: no `[gauge]`, or an empty one.
    /// Right: `[gauge]` and `swatch = { width = 6, height = 5.5, stitches = 10, rows = 10 }`
    GaugeMissing = "E1007", "the gauge is missing";
    /// The gauge is given in more than one way.
    ///
    /// `stitch`, `swatch` and `yarn` each say how large a stitch is; two of them may disagree.
    ///
    /// Wrong: `stitch = { width = 0.6, height = 0.55 }` and `yarn = { weight = 4, hook = "5 mm" }`
    /// Right: one of the two.
    GaugeConflict = "E1008", "the gauge is given more than once";
    /// A section has no profile, or more than one.
    ///
    /// A section is a `circle` with a radius, an `ellipse` with two, or a `loop` of points.
    ///
    /// Wrong: `{ at = 0, circle = 1, ellipse = [1, 2] }`
    /// Right: `{ at = 0, ellipse = [1, 2] }`
    SectionForm = "E1009", "a section needs exactly one profile";
    /// A point has too few or too many numbers.
    ///
    /// Points of a curve have three numbers, those of a loop two or three, an `offset` or an `ellipse` two.
    ///
    /// Wrong: `curve = [[0, 0], [0, 10]]`
    /// Right: `curve = [[0, 0, 0], [0, 0, 10]]`
    PointForm = "E1010", "a point with the wrong number of coordinates";
    /// A curve segment has one point only, or more than four.
    ///
    /// Two points are a straight line, three a quadratic, four a cubic Bézier segment. A longer curve is a list of
    /// segments, each starting where the one before ends.
    ///
    /// Wrong: `curve = [[0, 0, 0], [0, 0, 1], [0, 0, 2], [0, 0, 3], [0, 0, 4]]`
    /// Right: `curve = [[[0, 0, 0], [0, 0, 2]], [[0, 0, 2], [0, 0, 4]]]`
    CurveDegree = "E1011", "a curve segment has 2 to 4 points";
    /// A key or a table is given twice.
    ///
    /// Two `[gauge]` tables, or two `curve` lines in one table, leave open which is meant.
    ///
    /// Wrong: `unit = "cm"` and further down `unit = "mm"`
    /// Right: one of the two.
    DuplicateKey = "E1012", "a key is given twice";
    /// Branches are not made yet.
    ///
    /// The keys of `[[branch]]` are read and checked, but no pattern comes of them. Until it does, make the branch a
    /// shape of its own and sew it on, as most toys are made.
    ///
    /// Wrong: `[[branch]]` with `name = "arm"` in `bear.toml`
    /// Right: a file `arm.toml` with the branch as its `[trunk]`
    BranchUnsupported = "E1013", "branches are not supported yet";
    /// Meshes are not read yet.
    ///
    /// The keys of `[mesh]` are read and checked, but no pattern comes of them. Describe the shape by a curve and
    /// sections, or by loops of points cut from the mesh.
    ///
    /// Wrong: `[mesh]` with `file = "duck.obj"`
    /// Right: `[trunk]` with `curve` and `section`
    MeshUnsupported = "E1014", "meshes are not supported yet";
    /// A list is empty where something is needed.
    ///
    /// Wrong: `section = []`
    /// Right: `section = [{ at = 0, circle = 1 }]`
    EmptyList = "E1015", "a list is empty";
    /// A yarn weight that the standard does not know.
    ///
    /// Weights are 0 to 7 or their names: lace, super fine, fine, light, medium, bulky, super bulky, jumbo, and common
    /// other names such as sock, sport, dk, worsted, aran, chunky. Most labels show the number.
    ///
    /// Wrong: `weight = "worstd"`
    /// Right: `weight = "worsted"` or `weight = 4`
    UnknownYarn = "E1016", "unknown yarn weight";
    /// A hook size that is neither millimeters nor a US size.
    ///
    /// A bare number is refused: 8 is a hook of 8 mm, or a US size of 5 mm.
    ///
    /// Wrong: `hook = 8`
    /// Right: `hook = "8 mm"`, `hook = "H-8"` or `hook = "US 8"`
    UnknownHook = "E1017", "unknown hook size";
    /// A list has more entries than Picot reads.
    ///
    /// The caps keep memory and time in bounds for any input: 2048 segments, 1024 sections, 10,000 points of a loop.
    ///
    /// Wrong: a `loop` of a million points for one round of 60 stitches.
    /// Right: a `loop` of 100 points.
    TooManyEntries = "E1018", "a list is too long";
    /// A name that cannot stand in a pattern.
    ///
    /// The name becomes the title of the pattern, so it is one line of text.
    ///
    /// Wrong: `name = ""`
    /// Right: `name = "Bear's ear"`
    BadName = "E1019", "not a usable name";
    /// A size is zero or negative.
    ///
    /// Radii and stitch sizes are above zero. Only at a closed end a section may shrink to a point.
    ///
    /// Wrong: `{ at = 1, circle = 0 }` with an open end
    /// Right: the same with `end = "closed"`
    SizeNotPositive = "E1101", "a size must be above zero";
    /// A stitch that can hardly be made: below 0.2 mm or above 100 mm. Mostly the unit is another one.
    ///
    /// Wrong: `unit = "mm"` and `stitch = { width = 0.06, height = 0.055 }`
    /// Right: `unit = "cm"` and `stitch = { width = 0.6, height = 0.55 }`
    StitchSize = "E1102", "an impossible stitch size";
    /// A section lies outside of the curve.
    ///
    /// `at` is the curve parameter from 0 to 1, not a length.
    ///
    /// Wrong: `{ at = 12, circle = 1 }`
    /// Right: `{ at = 1, circle = 1 }`
    SectionPlace = "E1103", "a section lies outside of the curve";
    /// Sections are not listed from the start of the curve to its end, or two lie at the same place.
    ///
    /// Wrong: `section = [{ at = 1, circle = 1 }, { at = 0, circle = 2 }]`
    /// Right: `section = [{ at = 0, circle = 2 }, { at = 1, circle = 1 }]`
    SectionOrder = "E1104", "sections are out of order";
    /// A loop of points does not run around once.
    ///
    /// The points of a loop go around the tube in order, without crossing, and the loop is closed by itself.
    ///
    /// Wrong: `loop = [[1, 0], [-1, 0], [0, 1], [0, -1]]`, which crosses itself
    /// Right: `loop = [[1, 0], [0, 1], [-1, 0], [0, -1]]`
    SectionLoop = "E1105", "a loop does not run around once";
    /// All points of a curve segment are the same, so it has no direction.
    ///
    /// Wrong: `curve = [[0, 0, 0], [0, 0, 0]]`
    /// Right: `curve = [[0, 0, 0], [0, 0, 10]]`
    SegmentLength = "E1106", "a curve segment has no length";
    /// A curve segment does not start where the one before ends.
    ///
    /// Wrong: `curve = [[[0, 0, 0], [0, 0, 4]], [[0, 0, 5], [0, 0, 9]]]`
    /// Right: `curve = [[[0, 0, 0], [0, 0, 4]], [[0, 0, 4], [0, 0, 9]]]`
    CurveGap = "E1107", "curve segments do not meet";
    /// The curve has a corner, or turns back on the spot.
    ///
    /// A tube cannot follow a corner: the last two points of a segment and the first two of the next lie in one line.
    ///
    /// Wrong: `curve = [[[0, 0, 0], [0, 0, 5]], [[0, 0, 5], [5, 0, 5]]]`
    /// Right: `curve = [[0, 0, 0], [0, 0, 5], [5, 0, 5]]`, which rounds the corner
    CurveKink = "E1108", "the curve has a corner";
    /// The curve bends so tightly that the tube folds into itself on the inner side.
    ///
    /// Curvature x radius must stay below 1: the bend is wider than the tube.
    ///
    /// Wrong: a tube of radius 3 along `curve = [[0, 0, 0], [0, 0, 4], [4, 0, 4]]`
    /// Right: radius 1 along it, or a curve twice as wide.
    CurveTooTight = "E1109", "the curve is too tight for the tube";
    /// The tube runs through itself.
    ///
    /// Two places of the curve come nearer to each other than the tube is thick. Yarn cannot pass through a fabric.
    ///
    /// Wrong: a curve that closes a circle, with ends inside one another
    /// Right: a horseshoe with room between its ends.
    TubeCrossesItself = "E1110", "the tube runs through itself";
    /// The tube is thinner than four stitches around.
    ///
    /// Fewer than four stitches cannot be worked in the round. Closed ends may shrink to a point, of course.
    ///
    /// Wrong: `circle = 0.2` (cm) with a stitch 0.6 cm wide, 2 stitches around
    /// Right: `circle = 0.6`, 6 stitches around, or a finer yarn.
    ShapeTooNarrow = "E1111", "the tube is too narrow for the stitch";
    /// The shape is shorter than two rows.
    ///
    /// Wrong: a tube of 0.8 cm with stitches 0.55 cm high
    /// Right: 1.1 cm and more, or a finer yarn.
    ShapeTooShort = "E1112", "the shape is too short for the stitch";
    /// The shape takes more stitches than can be handled. Mostly the unit is another one.
    ///
    /// Wrong: `unit = "in"` for a ball of radius 500 with stitches of `width = 0.01`
    /// Right: `unit = "mm"` and the gauge in mm.
    ShapeTooLarge = "E1113", "the shape is too large for the stitch";
    /// The gauge is a guess from yarn and hook.
    ///
    /// Hands differ: sizes may be off by 15 % within the usual hooks of a yarn and 20 % outside of them. Toys are worked
    /// with small hooks on purpose, so out of range is normal. A swatch of 10 x 10 stitches replaces the guess.
    ///
    /// Estimated: `yarn = { weight = "worsted", hook = "3.5 mm" }`
    /// Measured: `swatch = { width = 4.7, height = 4.1, stitches = 10, rows = 10 }`
    GaugeEstimated = "W1201", "the gauge is estimated";
    /// The standard counts lace weight in double crochet, so that a single crochet is guessed from another stitch.
    ///
    /// Estimated: `yarn = { weight = 0, hook = "1.5 mm" }`
    /// Measured: `swatch = { width = 2.4, height = 2.1, stitches = 10, rows = 10 }`
    LaceGauge = "W1202", "the gauge of lace weight is weak";
    /// The object is smaller than 8 mm or larger than 3 m. Mostly the unit is another one.
    ///
    /// Wrong: `unit = "in"` for a ball with `circle = 80`, 4 m across
    /// Right: `unit = "mm"`
    UnlikelySize = "W1203", "an unlikely size";
    /// The file names no unit, so its lengths are taken as millimeters.
    ///
    /// Wrong: `circle = 4`, meant as 4 cm, without a unit
    /// Right: `unit = "cm"` at the top of the file.
    UnitAssumed = "N1204", "the unit is assumed";
    /// A file has more findings than are shown. The first ones matter most: later ones often follow from them.
    ///
    /// Shown: the first 64 findings of a file.
    /// Hidden: the rest, which a second run shows when the first are mended.
    MoreFindings = "N1205", "more findings are not shown";
    /// A file cannot be read or written.
    ///
    /// The message ends with what the system says: the file does not exist, is a folder, may not be read or written, or is
    /// larger than Picot takes. Nothing is written when one of the files of a run fails.
    ///
    /// Wrong: `picot build bal.toml` where the file is `ball.toml`.
    /// Right: `picot build shapes/ball.toml`, with the folder that the file lies in.
    FileFails = "E9001", "a file cannot be read or written";
    /// A file is not UTF-8 text.
    ///
    /// Shape files, patterns and machine code are UTF-8. Old editors may save letters with accents in another coding.
    ///
    /// Wrong: `name = "Bär"` saved as Latin-1, where the ä is the single byte 0xE4
    /// Right: the same saved as UTF-8.
    NotUtf8 = "E9002", "the file is not UTF-8";
}
