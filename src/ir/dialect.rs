//! Vocabularies: how each language names stitches and the words around them, for reading and for writing alike.

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
    /// Other words: the English word, and the spellings here.
    pub words: &'static [(&'static str, &'static [&'static str])],
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
            Self::English => &ENGLISH,
            Self::Spanish => &SPANISH,
            Self::Portuguese => &PORTUGUESE,
            Self::French => &FRENCH,
            Self::German => &GERMAN,
            Self::Norwegian => &NORWEGIAN,
            Self::Letters => &LETTERS,
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

static ENGLISH: Vocabulary =
    Vocabulary { code: "en", name: "English", stitches: &[], shaped: &[], words: &[] };

static SPANISH: Vocabulary = Vocabulary {
    code: "es",
    name: "Spanish",
    stitches: &[
        (Kind::Ch, &["cad", "pc", "cadena", "cadenas", "cadeneta", "cadenetas"]),
        (Kind::SlSt, &["pd", "pr"]),
        (Kind::Sc, &["pb"]),
        (Kind::Hdc, &["pma", "mp", "mv"]),
        (Kind::Dc, &["pa"]),
        (Kind::Tr, &["pad", "dv"]),
        (Kind::Popcorn, &["pop"]),
    ],
    shaped: &[],
    words: &[
        ("inc", &["aum", "aumento", "aumentos", "aumentar"]),
        ("dec", &["dism", "disminucion", "disminuciones", "disminuir"]),
        ("mr", &["AM", "aro"]),
        ("magic", &["anillo"]),
        ("ring", &["magico"]),
        ("rnd", &["V", "vuelta", "vueltas", "vta", "vtas", "ronda", "rondas"]),
        ("row", &["fila", "filas", "hilera", "hileras"]),
        ("st", &["punto", "puntos", "pt", "pts", "p"]),
        ("in", &["en"]),
        ("next", &["siguiente", "siguientes", "sig", "proximo", "proximos"]),
        ("each", &["cada"]),
        ("times", &["veces"]),
        ("rep", &["repetir", "repite", "repita"]),
        ("around", &["alrededor"]),
        ("first", &["primer", "primero", "primera"]),
        ("last", &["ultimo", "ultimos", "ultima", "ultimas"]),
        ("same", &["mismo", "misma"]),
        ("turn", &["girar", "gira", "voltear"]),
        ("sk", &["saltar", "salta", "omitir"]),
        ("from", &["desde"]),
        ("to", &["hasta"]),
        ("end", &["final"]),
        ("and", &["y"]),
        ("then", &["luego"]),
        ("with", &["con"]),
        ("fo", &["rematar"]),
    ],
};

static PORTUGUESE: Vocabulary = Vocabulary {
    code: "pt",
    name: "Portuguese",
    stitches: &[
        (Kind::Ch, &["corr", "corrente", "correntes", "correntinha", "correntinhas"]),
        (Kind::SlSt, &["pbx"]),
        (Kind::Sc, &["pb"]),
        (Kind::Hdc, &["mpa", "pm"]),
        (Kind::Dc, &["pa"]),
        (Kind::Tr, &["pad"]),
    ],
    shaped: &[],
    words: &[
        ("inc", &["aum", "aumento", "aumentos"]),
        ("dec", &["dim", "diminuicao", "diminuicoes"]),
        ("mr", &["AM"]),
        ("magic", &["anel"]),
        ("ring", &["magico"]),
        ("rnd", &["carr", "carreira", "carreiras", "volta", "voltas"]),
        ("row", &["fileira", "fileiras"]),
        ("st", &["ponto", "pontos", "pt", "pts", "p"]),
        ("in", &["em", "no", "na", "nos", "nas"]),
        ("next", &["proximo", "proximos", "seguinte", "seguintes"]),
        ("each", &["cada"]),
        ("times", &["vezes"]),
        ("rep", &["repetir", "repita", "repete"]),
        ("first", &["primeiro", "primeira"]),
        ("last", &["ultimo", "ultimos", "ultima", "ultimas"]),
        ("same", &["mesmo", "mesma"]),
        ("turn", &["virar", "vire"]),
        ("sk", &["pular", "pule"]),
        ("to", &["ate"]),
        ("and", &["e"]),
        ("with", &["com"]),
        ("blo", &["AP"]),
        ("flo", &["AF"]),
        ("fo", &["arrematar"]),
    ],
};

static FRENCH: Vocabulary = Vocabulary {
    code: "fr",
    name: "French",
    stitches: &[
        (Kind::Ch, &["ml", "ch"]),
        (Kind::SlSt, &["mc", "mcoul"]),
        (Kind::Sc, &["ms"]),
        (Kind::Hdc, &["demi-b", "demi-br", "demi-bride", "demi-brides"]),
        (Kind::Dc, &["br", "bride", "brides"]),
    ],
    shaped: &[],
    words: &[
        ("inc", &["aug", "augmentation", "augmentations"]),
        ("dec", &["dim", "diminution", "diminutions"]),
        ("mr", &["CM"]),
        ("magic", &["cercle", "anneau"]),
        ("ring", &["magique"]),
        ("rnd", &["tour", "tours", "rng"]),
        ("row", &["rang", "rangs"]),
        ("st", &["m", "maille", "mailles"]),
        ("in", &["dans"]),
        ("next", &["suivant", "suivante", "suivantes", "suivants", "prochaine", "prochaines"]),
        ("each", &["chaque"]),
        ("times", &["fois"]),
        ("rep", &["repeter", "repetez"]),
        ("first", &["premier", "premiere"]),
        ("last", &["dernier", "derniere", "dernieres", "derniers"]),
        ("same", &["meme"]),
        ("turn", &["tourner", "tournez"]),
        ("sk", &["sauter", "sautez", "passer"]),
        ("and", &["et"]),
        ("then", &["puis"]),
        ("with", &["avec"]),
        ("back", &["arriere"]),
        ("front", &["avant"]),
        ("loop", &["boucle"]),
    ],
};

static GERMAN: Vocabulary = Vocabulary {
    code: "de",
    name: "German",
    stitches: &[
        (Kind::Ch, &["Lm", "Lfm", "Luftmasche", "Luftmaschen"]),
        (Kind::SlSt, &["Km", "Ktm", "Kettm", "Kettmasche", "Kettmaschen"]),
        (Kind::Sc, &["fM"]),
        (Kind::Hdc, &["hStb"]),
        (Kind::Dc, &["Stb"]),
        (Kind::Tr, &["DStb"]),
    ],
    shaped: &[],
    words: &[
        ("inc", &["zun", "zunahme", "zunahmen", "verdoppeln", "verd"]),
        ("dec", &["abn", "abnahme", "abnahmen", "abmaschen"]),
        ("mr", &["FR", "fadenring", "magischer"]),
        ("rnd", &["Rd", "Rde", "Runde", "Runden"]),
        ("row", &["Reihe", "Reihen"]),
        ("st", &["M", "Masche", "Maschen"]),
        ("next", &["naechste", "naechsten", "nachste", "nachsten"]),
        ("each", &["jede", "jeder", "jedes", "jeden"]),
        ("times", &["mal"]),
        ("rep", &["wdh", "wiederholen"]),
        ("first", &["erste", "ersten"]),
        ("last", &["letzte", "letzten"]),
        ("same", &["gleiche", "gleichen", "dieselbe"]),
        ("turn", &["wenden", "wende"]),
        ("sk", &["uberspringen", "auslassen"]),
        ("from", &["ab"]),
        ("to", &["bis"]),
        ("end", &["ende"]),
        ("and", &["und"]),
        ("then", &["dann"]),
        ("with", &["mit"]),
        ("blo", &["hMg"]),
        ("flo", &["vMg"]),
    ],
};

static NORWEGIAN: Vocabulary = Vocabulary {
    code: "no",
    name: "Norwegian",
    stitches: &[
        (Kind::Ch, &["lm", "luftmaske", "luftmasker"]),
        (Kind::SlSt, &["kjm", "kjedemaske", "kjedemasker"]),
        (Kind::Sc, &["fm", "fastmaske", "fastmasker"]),
        (Kind::Hdc, &["hst", "halvstav", "halvstaver"]),
        (Kind::Dc, &["st", "stav", "staver"]),
    ],
    shaped: &[],
    words: &[
        ("inc", &["økn", "økning", "økninger", "øk"]),
        ("dec", &["mink", "minking", "fell", "felling"]),
        ("magic", &["magisk"]),
        ("rnd", &["omg", "omgang", "omganger"]),
        ("row", &["rad", "rader"]),
        ("st", &["m", "maske", "masker"]),
        ("in", &["i"]),
        ("next", &["neste"]),
        ("each", &["hver"]),
        ("times", &["ganger"]),
        ("rep", &["gjenta"]),
        ("first", &["forste"]),
        ("last", &["siste"]),
        ("same", &["samme"]),
        ("turn", &["snu"]),
        ("sk", &["hopp"]),
        ("and", &["og"]),
        ("with", &["med"]),
    ],
};

static LETTERS: Vocabulary = Vocabulary {
    code: "letters",
    name: "letters",
    stitches: &[
        (Kind::Ch, &["CH"]),
        (Kind::SlSt, &["SL"]),
        (Kind::Sc, &["X"]),
        (Kind::Hdc, &["T"]),
        (Kind::Dc, &["F"]),
        (Kind::Tr, &["E"]),
        (Kind::Fpsc, &["FX"]),
        (Kind::Bpsc, &["BX"]),
    ],
    shaped: &[
        ("V", Kind::Sc, 1, 2),
        ("A", Kind::Sc, 2, 1),
        ("W", Kind::Sc, 1, 3),
        ("M", Kind::Sc, 3, 1),
        ("TV", Kind::Hdc, 1, 2),
        ("TA", Kind::Hdc, 2, 1),
        ("FV", Kind::Dc, 1, 2),
        ("FA", Kind::Dc, 2, 1),
        ("EV", Kind::Tr, 1, 2),
        ("EA", Kind::Tr, 2, 1),
    ],
    words: &[("rnd", &["R"]), ("mr", &["MR"])],
};
