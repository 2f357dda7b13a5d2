//! Vocabularies: how each language names stitches and the words around them, for reading and for writing alike.

mod english;
mod forms;
mod prose;
mod tables;

pub use forms::Forms;
pub use prose::Prose;

use super::{Kind, Stitch};

/// Which of the two English vocabularies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Terms {
    /// United States: the basic stitch is `sc`.
    #[default]
    Us,
    /// United Kingdom: the same stitch is `dc`.
    Uk,
}

impl Terms {
    /// `us` or `uk`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Us => "us",
            Self::Uk => "uk",
        }
    }
}

/// A language that patterns are read and written in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Deserialize)]
pub enum Language {
    /// English, in US or UK terms.
    #[default]
    #[serde(rename = "en")]
    English,
    /// Spanish.
    #[serde(rename = "es")]
    Spanish,
    /// Portuguese of Brazil.
    #[serde(rename = "pt")]
    Portuguese,
    /// French.
    #[serde(rename = "fr")]
    French,
    /// German.
    #[serde(rename = "de")]
    German,
    /// Norwegian.
    #[serde(rename = "no")]
    Norwegian,
    /// The letter notation of Chinese and Turkish patterns: X, V, A.
    #[serde(rename = "letters")]
    Letters,
}

/// One language: its own words. What a table lacks is said in English.
#[derive(Debug)]
pub struct Vocabulary {
    /// Code, as in `lang: de`.
    pub code: &'static str,
    /// Name in English.
    pub name: &'static str,
    /// Stitches; the first spelling of a kind is the one that is written.
    pub stitches: &'static [(Kind, &'static [&'static str])],
    /// Single letters or pairs that name a shaped stitch: kind, loops worked, loops made.
    pub shaped: &'static [(&'static str, Kind, u16, u16)],
    /// Full names of stitches.
    pub names: &'static [(Kind, &'static str)],
    /// Other words: the English word, and the spellings here.
    pub words: &'static [(&'static str, &'static [&'static str])],
    /// How instructions are put.
    pub forms: &'static Forms,
    /// What is told beside them.
    pub prose: &'static Prose,
}

impl Language {
    /// All languages.
    pub const ALL: &'static [Self] = &[
        Self::English,
        Self::Spanish,
        Self::Portuguese,
        Self::French,
        Self::German,
        Self::Norwegian,
        Self::Letters,
    ];

    /// The language's table.
    pub fn vocabulary(self) -> &'static Vocabulary {
        match self {
            Self::English => &tables::ENGLISH,
            Self::Spanish => &tables::SPANISH,
            Self::Portuguese => &tables::PORTUGUESE,
            Self::French => &tables::FRENCH,
            Self::German => &tables::GERMAN,
            Self::Norwegian => &tables::NORWEGIAN,
            Self::Letters => &tables::LETTERS,
        }
    }

    /// The language with this code or English name.
    pub fn parse(text: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|language| {
            let table = language.vocabulary();
            table.code.eq_ignore_ascii_case(text) || table.name.eq_ignore_ascii_case(text)
        })
    }

    /// How this language says an English structural word (`rnd`, `inc`, `mr`); the word itself where it has no own.
    pub fn say(self, english: &'static str) -> &'static str {
        let words = self.vocabulary().words.iter();
        words
            .filter(|(word, _)| *word == english)
            .find_map(|(_, spellings)| spellings.first().copied())
            .unwrap_or(english)
    }

    /// The abbreviation of a plain stitch in this language. English terms stand in where the language has none.
    pub fn abbreviation(self, kind: Kind, terms: Terms) -> &'static str {
        let own = self.vocabulary().stitches.iter().find(|(own, _)| *own == kind);
        own.and_then(|(_, spellings)| spellings.first().copied()).unwrap_or(match terms {
            Terms::Us => kind.us(),
            Terms::Uk => kind.uk(),
        })
    }

    /// The full name of a stitch.
    pub fn full_name(self, kind: Kind, terms: Terms) -> &'static str {
        let own = self.vocabulary().names.iter().find(|(own, _)| *own == kind);
        own.map_or_else(
            || match terms {
                Terms::Us => kind.us_name(),
                Terms::Uk => kind.uk_name(),
            },
            |(_, name)| *name,
        )
    }

    /// True for a word that means something in a pattern of this language, so that a bare name cannot have it.
    pub fn knows(self, word: &str) -> bool {
        let is = |known: &str| {
            word.eq_ignore_ascii_case(known)
                || word.strip_suffix(['s', 'S']).is_some_and(|singular| singular.eq_ignore_ascii_case(known))
        };
        let tables = [Self::English.vocabulary(), self.vocabulary()];
        !word.is_ascii()
            || HEADINGS.iter().copied().any(is)
            || Kind::ALL.iter().any(|kind| is(kind.us()) || is(kind.uk()))
            || tables.iter().any(|table| {
                let words = table.words.iter().flat_map(|(_, words)| words.iter());
                let stitches = table.stitches.iter().flat_map(|(_, words)| words.iter());
                words.chain(stitches).copied().any(is) || table.shaped.iter().any(|(letters, ..)| is(letters))
            })
    }

    /// The letters that name this shaped stitch, if the language has any.
    pub fn letters(self, stitch: Stitch) -> Option<&'static str> {
        let shaped = self.vocabulary().shaped.iter();
        shaped
            .filter(|(_, kind, works, makes)| {
                *kind == stitch.kind && *works == stitch.works && *makes == stitch.makes
            })
            .map(|(letters, ..)| *letters)
            .next()
    }
}

/// Words that open a line of their own kind, or stand for numbers and stitches beyond the tables.
const HEADINGS: &[&str] = &[
    "title",
    "terms",
    "lang",
    "language",
    "gauge",
    "yarn",
    "hook",
    "convention",
    "color",
    "colour",
    "def",
    "note",
    "tip",
    "size",
    "finished",
    "materials",
    "abbreviations",
    "stuffing",
    "assembly",
    "finishing",
    "difficulty",
    "skill",
    "designer",
    "copyright",
    "tension",
    "stitches",
    "special",
    "stitch",
    "one",
    "two",
    "three",
    "four",
    "five",
    "six",
    "seven",
    "eight",
    "nine",
    "ten",
    "eleven",
    "twelve",
    "ss",
    "slst",
    "ttr",
    "quadtr",
    "bobble",
    "popcorn",
    "ps",
    "cluster",
];

/// A template with the names in its braces replaced.
pub fn fill(template: &str, values: &[(&str, &str)]) -> String {
    let mut out = String::with_capacity(template.len());
    let mut rest = template;
    while let Some((before, after)) = rest.split_once('{') {
        out.push_str(before);
        let Some((name, after)) = after.split_once('}') else { break };
        out.push_str(values.iter().find(|(known, _)| *known == name).map_or("", |(_, value)| value));
        rest = after;
    }
    out.push_str(rest);
    out
}
