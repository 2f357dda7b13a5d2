//! The one table of conventions: where makers disagree, a named setting decides.

use crate::ir::Language;

/// Declares the settings. The first value of a row is its default.
macro_rules! settings {
    ($($(#[doc = $doc:literal])+ $name:ident = $key:literal [$($value:literal)+];)+) => {
        /// A question on which makers of patterns disagree.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Setting { $($(#[doc = $doc])+ $name,)+ }

        impl Setting {
            /// Every setting.
            pub const ALL: &'static [Self] = &[$(Self::$name,)+];
            /// The name, as in `convention: NAME=VALUE`.
            pub fn name(self) -> &'static str { match self { $(Self::$name => $key,)+ } }
            /// The values; the first is the default.
            pub fn values(self) -> &'static [&'static str] { match self { $(Self::$name => &[$($value,)+],)+ } }
            /// What it decides.
            pub fn about(self) -> &'static str { match self { $(Self::$name => concat!($($doc,)+),)+ } }
        }
    };
}

settings! {
    /// US or UK meaning of dc, tr and dtr; auto looks at the whole file.
    Terms = "terms" ["auto" "us" "uk"];
    /// `rep from * 3 times`: 3 passes in total, or 3 more after the first.
    StarTimes = "star-times" ["total" "more"];
    /// `(sc, hdc, sc)` without number or place: once, or all in one place; count lets the loops decide.
    BareBracket = "bare-bracket" ["count" "once" "one-place"];
    /// `2 sc`: one in each of two stitches, or both in one.
    NStitch = "n-stitch" ["each" "one-place"];
    /// Whether chains between stitches count as stitches.
    ChSp = "ch-sp" ["none" "chains"];
    /// Turning and standing chains: they count where the row says so, always, or never.
    Tch = "tch" ["stated" "counts" "never"];
    /// Whether the chains skipped at the hook are a stitch; for sc they never are.
    FoundationSkip = "foundation-skip" ["uncounted" "counted"];
    /// A `sl st` that ends a round: joins it, or is a stitch; auto looks at the row and its loops.
    FinalSlst = "final-slst" ["auto" "join" "stitch"];
    /// What `inc` and `dec` are made of: the stitch most used in the row, or sc.
    ShapingHeight = "shaping-height" ["dominant" "sc"];
    /// `inc3`: three in one stitch, or three incs.
    IncGlued = "inc-glued" ["into-one" "times"];
    /// A second `Rnd 1` with a start of its own: a new part, or an error.
    Restart = "restart" ["part" "error"];
    /// Loops may remain where `only` or `leave` says so, also before a `turn`, or anywhere.
    Unworked = "unworked" ["explicit" "turn" "any"];
    /// After short flat rows: `across` ends with the loops of the row below, or takes those left before.
    AcrossStep = "across-step" ["own" "all"];
    /// `MC`: the magic ring, or the main color; auto takes it for the ring at the start of a part with a number.
    Mc = "mc" ["auto" "ring" "color"];
    /// `4 dec evenly spaced`: spread by equal gaps, or refused.
    Evenly = "evenly" ["spread" "refuse"];
    /// A list that does not use up the row: an error, or repeated to the end. Off in English, fill in Portuguese, Spanish, French.
    ImplicitRepeat = "implicit-repeat" ["off" "fill"];
    /// `6 sc, dec around`: the last clause fills the row, or the whole list; count lets the loops decide.
    TrailingAround = "trailing-around" ["count" "clause" "list"];
    /// A last `13 sc.` behind a period: a count if the rest works out with it, or stitches.
    TailCount = "tail-count" ["count" "stitches"];
    /// Short rows: each turn takes a loop for itself, as the tiles of the paper do, or none.
    TurnMark = "turn-mark" ["bridge" "bare"];
    /// The hand that holds the hook: the same words give the mirror image in the other one.
    Hand = "hand" ["right" "left"];
    /// What the row after a faulty row starts from: what fits best, the stated count, or the count made.
    AfterFault = "after-fault" ["best" "stated" "made"];
}

/// The settings in force, and which of them someone declared.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Conventions {
    values: [(u8, bool); Setting::ALL.len()],
    /// Language of the text until the file names one.
    pub language: Language,
}

impl Default for Conventions {
    fn default() -> Self {
        Self { values: [(0, false); Setting::ALL.len()], language: Language::English }
    }
}

impl Conventions {
    /// The value of a setting.
    pub fn get(&self, setting: Setting) -> &'static str {
        let index = self.values.get(setting as usize).map_or(0, |(value, _)| usize::from(*value));
        setting.values().get(index).copied().unwrap_or_default()
    }

    /// True when a setting has this value.
    pub(crate) fn is(&self, setting: Setting, value: &str) -> bool {
        self.get(setting) == value
    }

    /// True when someone chose the value.
    pub fn declared(&self, setting: Setting) -> bool {
        self.values.get(setting as usize).is_some_and(|(_, declared)| *declared)
    }

    /// Declares a setting by name. The error says what would be right.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), String> {
        let folded = name.trim().to_ascii_lowercase().replace('_', "-");
        if folded == "lang" || folded == "language" {
            let language = Language::parse(value.trim());
            self.language =
                language.ok_or_else(|| "a language: en, es, pt, fr, de, no, letters".to_owned())?;
            return Ok(());
        }
        let Some(setting) = Setting::ALL.iter().copied().find(|setting| setting.name() == folded) else {
            let near = crate::diag::did_you_mean(&folded, Setting::ALL.iter().map(|setting| setting.name()));
            return Err(near.map_or_else(
                || format!("one of {}", names(Setting::ALL.iter().map(|setting| setting.name()))),
                |near| format!("`{near}`"),
            ));
        };
        let value = value.trim().to_ascii_lowercase();
        let Some(index) = setting.values().iter().position(|known| *known == value) else {
            return Err(format!("`{}` to be {}", setting.name(), names(setting.values().iter().copied())));
        };
        self.choose(setting, index, true);
        Ok(())
    }

    fn choose(&mut self, setting: Setting, index: usize, declared: bool) {
        if let Some(slot) = self.values.get_mut(setting as usize) {
            *slot = (index as u8, declared);
        }
    }

    /// These settings with one of them otherwise, for trying a reading.
    pub(crate) fn with(&self, setting: Setting, value: &str) -> Self {
        let mut other = self.clone();
        if let Some(index) = setting.values().iter().position(|known| *known == value) {
            other.choose(setting, index, true);
        }
        other
    }

    /// Sets a default that no one declared.
    pub(crate) fn default_to(&mut self, setting: Setting, value: &str) {
        if !self.declared(setting)
            && let Some(index) = setting.values().iter().position(|known| *known == value)
        {
            self.choose(setting, index, false);
        }
    }
}

fn names<'n>(all: impl Iterator<Item = &'n str>) -> String {
    all.collect::<Vec<_>>().join(", ")
}
