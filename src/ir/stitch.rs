//! The one table of stitch kinds, and what a stitch does to the loops.

/// Declares the stitch kinds. A kind is added here and nowhere else: readers and writers take its abbreviations from this row.
macro_rules! stitches {
    ($($(#[doc = $doc:literal])+ $kind:ident { us: $us:literal, uk: $uk:literal, us_name: $us_name:literal,
        uk_name: $uk_name:literal, works: $works:literal, makes: $makes:literal, height: $height:literal })+) => {
        /// A kind of stitch. Facts about it stand in one row of one table.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Kind { $($(#[doc = $doc])+ $kind,)+ }

        impl Kind {
            /// All kinds in the order of the table.
            pub const ALL: &'static [Self] = &[$(Self::$kind,)+];
            /// Abbreviation in US terms (Craft Yarn Council master list).
            pub fn us(self) -> &'static str { match self { $(Self::$kind => $us,)+ } }
            /// Abbreviation in UK terms.
            pub fn uk(self) -> &'static str { match self { $(Self::$kind => $uk,)+ } }
            /// Full name in US terms.
            pub fn us_name(self) -> &'static str { match self { $(Self::$kind => $us_name,)+ } }
            /// Full name in UK terms.
            pub fn uk_name(self) -> &'static str { match self { $(Self::$kind => $uk_name,)+ } }
            /// Loops of the row below that the plain stitch works.
            pub fn works(self) -> u16 { match self { $(Self::$kind => $works,)+ } }
            /// Loops that the plain stitch makes.
            pub fn makes(self) -> u16 { match self { $(Self::$kind => $makes,)+ } }
            /// Height in single crochets (chains of the usual turning chain).
            pub fn height(self) -> f64 { match self { $(Self::$kind => $height,)+ } }
        }
    };
}

stitches! {
    /// Single crochet.
    Sc { us: "sc", uk: "dc", us_name: "single crochet", uk_name: "double crochet", works: 1, makes: 1, height: 1.0 }
    /// Skipped loops: nothing is worked, nothing is made.
    Skip { us: "sk", uk: "miss", us_name: "skip", uk_name: "miss", works: 1, makes: 0, height: 0.0 }
    /// Chain; it makes a loop only where the pattern counts it as a stitch.
    Ch { us: "ch", uk: "ch", us_name: "chain", uk_name: "chain", works: 0, makes: 0, height: 1.0 }
    /// Slip stitch.
    SlSt { us: "sl st", uk: "ss", us_name: "slip stitch", uk_name: "slip stitch", works: 1, makes: 1, height: 0.3 }
    /// Half double crochet.
    Hdc { us: "hdc", uk: "htr", us_name: "half double crochet", uk_name: "half treble", works: 1, makes: 1, height: 2.0 }
    /// Double crochet.
    Dc { us: "dc", uk: "tr", us_name: "double crochet", uk_name: "treble", works: 1, makes: 1, height: 3.0 }
    /// Treble crochet.
    Tr { us: "tr", uk: "dtr", us_name: "treble crochet", uk_name: "double treble", works: 1, makes: 1, height: 4.0 }
    /// Double treble crochet.
    Dtr { us: "dtr", uk: "trtr", us_name: "double treble crochet", uk_name: "triple treble", works: 1, makes: 1, height: 5.0 }
    /// Triple treble crochet.
    Trtr { us: "trtr", uk: "qtr", us_name: "triple treble crochet", uk_name: "quadruple treble", works: 1, makes: 1, height: 6.0 }
    /// Extended single crochet.
    Esc { us: "esc", uk: "edc", us_name: "extended single crochet", uk_name: "extended double crochet", works: 1, makes: 1, height: 2.0 }
    /// Extended half double crochet.
    Ehdc { us: "ehdc", uk: "ehtr", us_name: "extended half double crochet", uk_name: "extended half treble", works: 1, makes: 1, height: 3.0 }
    /// Extended double crochet.
    Edc { us: "edc", uk: "etr", us_name: "extended double crochet", uk_name: "extended treble", works: 1, makes: 1, height: 4.0 }
    /// Extended treble crochet.
    Etr { us: "etr", uk: "edtr", us_name: "extended treble crochet", uk_name: "extended double treble", works: 1, makes: 1, height: 5.0 }
    /// Reverse single crochet (crab stitch).
    Rsc { us: "rsc", uk: "rdc", us_name: "reverse single crochet", uk_name: "reverse double crochet", works: 1, makes: 1, height: 1.0 }
    /// Front post single crochet.
    Fpsc { us: "FPsc", uk: "FPdc", us_name: "front post single crochet", uk_name: "front post double crochet", works: 1, makes: 1, height: 1.0 }
    /// Front post half double crochet.
    Fphdc { us: "FPhdc", uk: "FPhtr", us_name: "front post half double crochet", uk_name: "front post half treble", works: 1, makes: 1, height: 2.0 }
    /// Front post double crochet.
    Fpdc { us: "FPdc", uk: "FPtr", us_name: "front post double crochet", uk_name: "front post treble", works: 1, makes: 1, height: 3.0 }
    /// Front post treble crochet.
    Fptr { us: "FPtr", uk: "FPdtr", us_name: "front post treble crochet", uk_name: "front post double treble", works: 1, makes: 1, height: 4.0 }
    /// Front post double treble crochet.
    Fpdtr { us: "FPdtr", uk: "FPtrtr", us_name: "front post double treble crochet", uk_name: "front post triple treble", works: 1, makes: 1, height: 5.0 }
    /// Back post single crochet.
    Bpsc { us: "BPsc", uk: "BPdc", us_name: "back post single crochet", uk_name: "back post double crochet", works: 1, makes: 1, height: 1.0 }
    /// Back post half double crochet.
    Bphdc { us: "BPhdc", uk: "BPhtr", us_name: "back post half double crochet", uk_name: "back post half treble", works: 1, makes: 1, height: 2.0 }
    /// Back post double crochet.
    Bpdc { us: "BPdc", uk: "BPtr", us_name: "back post double crochet", uk_name: "back post treble", works: 1, makes: 1, height: 3.0 }
    /// Back post treble crochet.
    Bptr { us: "BPtr", uk: "BPdtr", us_name: "back post treble crochet", uk_name: "back post double treble", works: 1, makes: 1, height: 4.0 }
    /// Back post double treble crochet.
    Bpdtr { us: "BPdtr", uk: "BPtrtr", us_name: "back post double treble crochet", uk_name: "back post triple treble", works: 1, makes: 1, height: 5.0 }
    /// Bobble: several stitches closed together in one loop, counted as one stitch.
    Bobble { us: "bo", uk: "bo", us_name: "bobble", uk_name: "bobble", works: 1, makes: 1, height: 3.0 }
    /// Popcorn: several stitches in one loop, drawn together, counted as one stitch.
    Popcorn { us: "pc", uk: "pc", us_name: "popcorn", uk_name: "popcorn", works: 1, makes: 1, height: 3.0 }
    /// Puff stitch, counted as one stitch.
    Puff { us: "puff", uk: "puff", us_name: "puff stitch", uk_name: "puff stitch", works: 1, makes: 1, height: 3.0 }
    /// Cluster in one loop, counted as one stitch.
    Cluster { us: "cl", uk: "cl", us_name: "cluster", uk_name: "cluster", works: 1, makes: 1, height: 3.0 }
    /// Picot: a knot of chains that neither works nor makes a loop.
    Picot { us: "picot", uk: "picot", us_name: "picot", uk_name: "picot", works: 0, makes: 0, height: 1.0 }
    /// Foundation single crochet: a stitch that brings its own chain.
    Fsc { us: "fsc", uk: "fdc", us_name: "foundation single crochet", uk_name: "foundation double crochet", works: 0, makes: 1, height: 1.0 }
    /// A stitch that the pattern defines itself by the loops it works and makes.
    Special { us: "special", uk: "special", us_name: "special stitch", uk_name: "special stitch", works: 1, makes: 1, height: 1.0 }
}

/// Where the hook goes in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Entry {
    /// Under both strands of the loop.
    #[default]
    Both,
    /// The front strand only (FLO).
    Front,
    /// The back strand only (BLO).
    Back,
    /// A chain space, not a loop.
    Space,
}

/// A stitch as it is worked: its kind, and how many loops it works and makes. An increase is two stitches of a kind in
/// one loop (1, 2), a decrease works two loops together (2, 1); 0 worked loops mean the same place as the stitch before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Stitch {
    /// What is worked.
    pub kind: Kind,
    /// Loops of the row below that it works.
    pub works: u16,
    /// Loops that it makes.
    pub makes: u16,
    /// Where the hook goes in.
    pub entry: Entry,
}

impl Stitch {
    /// Single crochet.
    pub const SC: Self = Self { kind: Kind::Sc, works: 1, makes: 1, entry: Entry::Both };
    /// Increase: two single crochets in one loop.
    pub const INC: Self = Self { kind: Kind::Sc, works: 1, makes: 2, entry: Entry::Both };
    /// Decrease: two loops single-crocheted together.
    pub const DEC: Self = Self { kind: Kind::Sc, works: 2, makes: 1, entry: Entry::Both };

    /// The plain stitch of a kind.
    pub fn plain(kind: Kind) -> Self {
        Self { kind, works: kind.works(), makes: kind.makes(), entry: Entry::Both }
    }
    /// True when it makes more loops than it works.
    pub fn is_increase(self) -> bool {
        self.works >= 1 && self.makes > self.works
    }
    /// True when it works more loops than it makes.
    pub fn is_decrease(self) -> bool {
        self.makes >= 1 && self.works > self.makes
    }
}
