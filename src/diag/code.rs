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
// E10 shape files, E11 the geometry of a shape, W12 and N12 remarks on it. E90 files and usage.
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
}
