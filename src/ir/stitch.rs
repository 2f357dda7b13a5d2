//! The one table of stitch kinds, and what a stitch does to the loops.

/// Declares the stitch kinds. A kind is added here and nowhere else.
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
