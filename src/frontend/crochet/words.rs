//! Words of a pattern: folded spellings and what they mean to the grammar.

use super::hints::Hints;
use super::lex::Tok;
use super::packed::{Packed, Table};
use crate::ir::{Kind, Language};
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// A stitch name as written: what it means in US and in UK terms. Both are equal where the terms do not matter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Spelled {
    pub us: Option<Kind>,
    pub uk: Option<Kind>,
}

impl Spelled {
    pub(crate) const fn plain(kind: Kind) -> Self {
        Self { us: Some(kind), uk: Some(kind) }
    }
    /// Either meaning, for questions that do not depend on the terms.
    pub(crate) fn any(self) -> Kind {
        self.us.or(self.uk).unwrap_or(Kind::Sc)
    }
}

/// A word or mark of the grammar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Key {
    // Marks.
    Comma,
    Semi,
    Dot,
    Colon,
    Middot,
    Star,
    Stop,
    Times,
    Hyphen,
    Dash,
    Neg,
    Back,
    Fwd,
    Eq,
    FatArrow,
    Plus,
    Slash,
    Pipe,
    Open(u8),
    Close(u8),
    Other,
    // Words.
    In,
    Next,
    Each,
    First,
    Last,
    Same,
    As,
    Join,
    From,
    Hook,
    To,
    End,
    Around,
    Across,
    Rep,
    TimesWord,
    More,
    Once,
    Twice,
    Thrice,
    For,
    With,
    Change,
    Turn,
    Sk,
    Leave,
    Hold,
    Unworked,
    Held,
    Surface,
    Fo,
    Closed,
    Pm,
    On,
    OtherWord,
    Side,
    Do,
    Not,
    Only,
    Over,
    Starting,
    Evenly,
    Spaced,
    Counts,
    Does,
    Count,
    And,
    Then,
    Rnd,
    Row,
    R,
    Rs,
    Ws,
    Make,
    Mr,
    Ring,
    Form,
    Top,
    Tch,
    Beg,
    Blo,
    Flo,
    Inc,
    Dec,
    Tog,
    Invdec,
    Even,
    St,
    Ch,
    Sp,
    Shell,
    You,
    Will,
    Have,
    Total,
    Stuff,
    AtWord,
    // Pieces of phrases that folding joins.
    Single,
    Half,
    Double,
    Treble,
    Crochet,
    Slip,
    Sl,
    Magic,
    Loop,
    FrontWord,
    BackWord,
    Post,
    Fasten,
    Off,
    Place,
    Marker,
    Adjustable,
    Extended,
    Inv,
    Tunisian,
    // Words that say nothing.
    Drop,
}

/// What a word means, and what it promises of its line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known {
    pub tok: Tok,
    pub hints: Hints,
}

impl Known {
    /// A word that means nothing.
    pub(crate) const WORD: Self = Self::new(Tok::Word, Hints::NONE);

    const fn new(tok: Tok, hints: Hints) -> Self {
        Self { tok, hints }
    }
}

impl From<Tok> for Known {
    fn from(tok: Tok) -> Self {
        Self::new(tok, Hints::of(tok))
    }
}

/// The words of one language, over those of English.
struct Vocabulary {
    map: Table,
    capitals: BTreeMap<&'static str, Tok>,
    /// Words of more letters than the table takes.
    long: BTreeMap<String, Tok>,
    language: Language,
}

/// The vocabulary of one file: English, under the words of its language, under the names it declares.
pub(crate) struct Words {
    fixed: &'static Vocabulary,
    declared: BTreeMap<String, Tok>,
    pub language: Language,
}

/// The vocabulary of a language, made when it is first asked for.
fn vocabulary(language: Language) -> &'static Vocabulary {
    static MADE: [OnceLock<Vocabulary>; Language::ALL.len()] =
        [const { OnceLock::new() }; Language::ALL.len()];
    static ENGLISH: OnceLock<Vocabulary> = OnceLock::new();
    MADE.get(language as usize).unwrap_or(&ENGLISH).get_or_init(|| Vocabulary::new(language))
}

impl Vocabulary {
    fn new(language: Language) -> Self {
        let mut words =
            Self { map: Table::new(), capitals: BTreeMap::new(), long: BTreeMap::new(), language };
        for (word, spellings) in Language::English.vocabulary().words {
            let Some((_, key)) = KEYS.iter().find(|(name, _)| name == word) else { continue };
            for spelling in *spellings {
                words.set(spelling, Tok::Key(*key));
            }
        }
        for (index, number) in NUMBERS.iter().enumerate() {
            words.set(number, Tok::Int(index as u32 + 2));
        }
        words.set("one", Tok::Int(1));
        for kind in
            Kind::ALL.iter().copied().filter(|kind| !matches!(kind, Kind::Special | Kind::Ch | Kind::Skip))
        {
            words.english(kind);
        }
        for (spelling, us, uk) in EXTRA {
            words.set(spelling, Tok::Stitch(Spelled { us: *us, uk: *uk }));
        }
        let table = language.vocabulary();
        let english = |words: &Self, word: &str| words.of(word);
        let own: Vec<(&str, Tok)> = table
            .words
            .iter()
            .filter_map(|(word, spellings)| Some((english(&words, word)?, spellings)))
            .flat_map(|(tok, spellings)| spellings.iter().map(move |spelling| (*spelling, tok)))
            .collect();
        for (spelling, tok) in own {
            words.own(spelling, tok);
        }
        for (kind, spellings) in table.stitches {
            let tok = match kind {
                Kind::Ch => Tok::Key(Key::Ch),
                Kind::Skip => Tok::Key(Key::Sk),
                _ => Tok::Stitch(Spelled::plain(*kind)),
            };
            for spelling in *spellings {
                words.own(spelling, tok);
            }
        }
        for (letters, kind, works, makes) in table.shaped {
            words.capitals.insert(letters, Tok::Shaped(*kind, *works, *makes));
        }
        words
    }

    fn own(&mut self, spelling: &'static str, tok: Tok) {
        if self.language == Language::Letters {
            self.capitals.insert(spelling, tok);
        } else {
            self.set(&fold_word(spelling), tok);
        }
    }

    /// Enters the US and UK abbreviations of a kind.
    fn english(&mut self, kind: Kind) {
        let (us, uk) = (fold_word(kind.us()).replace(' ', ""), fold_word(kind.uk()).replace(' ', ""));
        if us == uk {
            self.set(&us, Tok::Stitch(Spelled::plain(kind)));
            return;
        }
        let known = |words: &Self, word: &str| match words.of(word) {
            Some(Tok::Stitch(spelled)) => spelled,
            _ => Spelled { us: None, uk: None },
        };
        let spelled = known(self, &us);
        self.set(&us, Tok::Stitch(Spelled { us: Some(kind), ..spelled }));
        let spelled = known(self, &uk);
        self.set(&uk, Tok::Stitch(Spelled { uk: Some(kind), ..spelled }));
    }

    /// Enters a word; the plural in `s` is found by [`Vocabulary::get`].
    fn set(&mut self, word: &str, tok: Tok) {
        match Packed::of(word.as_bytes()) {
            Some(packed) => self.map.set(&packed, tok.into()),
            None => {
                self.long.insert(word.to_owned(), tok);
            }
        }
    }

    /// The meaning of a folded word.
    #[inline]
    fn get(&self, word: &Packed) -> Known {
        match self.map.get(word) {
            Some(known) => known,
            None => self.plural(*word).unwrap_or(Known::WORD),
        }
    }

    /// `dcs`, `increases`: a plural means what its singular means.
    #[cold]
    fn plural(&self, word: Packed) -> Option<Known> {
        self.singular(word.singular()?)
    }

    fn singular(&self, word: Packed) -> Option<Known> {
        self.map.get(&word).filter(|known| matches!(known.tok, Tok::Stitch(_) | Tok::Key(_)))
    }

    /// The meaning of a short word of the table.
    fn of(&self, word: &str) -> Option<Tok> {
        let known = self.get(&Packed::of(word.as_bytes())?).tok;
        (known != Tok::Word).then_some(known)
    }
}

impl Words {
    pub(crate) fn new(language: Language) -> Self {
        Self { fixed: vocabulary(language), declared: BTreeMap::new(), language }
    }

    /// Goes on in another language, with the names declared so far.
    pub(crate) fn change(&mut self, language: Language) {
        (self.fixed, self.language) = (vocabulary(language), language);
    }

    /// A stitch by its English abbreviation, whatever the language of the file.
    pub(crate) fn english_stitch(word: &str) -> Option<Spelled> {
        let of = |name: fn(Kind) -> &'static str| {
            Kind::ALL.iter().copied().find(|kind| fold_word(name(*kind)).replace(' ', "") == word)
        };
        let (us, uk) = (of(Kind::us), of(Kind::uk));
        (us.is_some() || uk.is_some()).then_some(Spelled { us, uk })
    }

    /// Enters a name that the file declares.
    pub(crate) fn declare(&mut self, name: &str, tok: Tok) {
        self.declared.insert(fold_word(name), tok);
    }

    /// The meaning of a folded word.
    #[inline]
    pub(crate) fn get(&self, word: &Packed) -> Known {
        if !self.declared.is_empty()
            && let Some(tok) = self.name(*word)
        {
            return tok.into();
        }
        self.fixed.get(word)
    }

    /// A name of the file.
    #[cold]
    #[inline(never)]
    fn name(&self, word: Packed) -> Option<Tok> {
        let (bytes, length) = word.bytes();
        self.declared.get(std::str::from_utf8(bytes.get(..length)?).ok()?).copied()
    }

    /// The meaning of a word of any length and in any letters.
    pub(crate) fn spelled(&self, written: &str) -> Known {
        let word = fold_word(written);
        if let Some(tok) = self.declared.get(&word).or_else(|| self.fixed.long.get(&word)) {
            return (*tok).into();
        }
        let singular = || self.fixed.singular(Packed::of(word.strip_suffix('s')?.as_bytes())?);
        match Packed::of(word.as_bytes()) {
            Some(word) => self.fixed.get(&word),
            None => singular().unwrap_or(Known::WORD),
        }
    }

    /// The meaning of a word in capitals, in a notation where case matters.
    pub(crate) fn capital(&self, word: &str) -> Option<Known> {
        self.fixed.capitals.get(word).map(|tok| (*tok).into())
    }

    /// Words for stitches, increases and decreases.
    pub(crate) fn stitch_words(&self) -> impl Iterator<Item = &'static str> {
        let vocabulary = self.language.vocabulary();
        let own = vocabulary.stitches.iter().flat_map(|(_, words)| words.iter().copied());
        let shaping = vocabulary.words.iter().filter(|(word, _)| matches!(*word, "inc" | "dec"));
        let english =
            Kind::ALL.iter().flat_map(|kind| [kind.us(), kind.uk()]).chain(["inc", "dec", "invdec"]);
        own.chain(shaping.flat_map(|(_, words)| words.iter().copied())).chain(english)
    }

    /// All words that a misspelled one may have meant.
    pub(crate) fn known(&self) -> impl Iterator<Item = &'static str> {
        let vocabulary = self.language.vocabulary();
        let english =
            Language::English.vocabulary().words.iter().flat_map(|(_, words)| words.iter().copied());
        let english = english.filter(|word| word.len() > 1);
        let stitches = Kind::ALL.iter().flat_map(|kind| [kind.us(), kind.uk()]);
        let own = vocabulary.stitches.iter().flat_map(|(_, words)| words.iter().copied());
        let other = vocabulary.words.iter().flat_map(|(_, words)| words.iter().copied());
        english.chain(stitches).chain(own).chain(other)
    }
}

/// Folds a spelling: lower case, no accents.
pub(crate) fn fold_word(word: &str) -> String {
    word.chars().filter_map(fold_char).flat_map(Folded::chars).collect()
}

/// What a letter folds to; `None` for a combining accent.
pub(crate) fn fold_char(c: char) -> Option<Folded> {
    let ascii = match c {
        'A'..='Z' => c.to_ascii_lowercase(),
        'à'..='å' | 'À'..='Å' | 'ā' | 'Ā' | 'ą' | 'Ą' | 'ă' | 'Ă' => 'a',
        'ç' | 'Ç' | 'ć' | 'Ć' | 'č' | 'Č' => 'c',
        'è'..='ë' | 'È'..='Ë' | 'ē' | 'Ē' | 'ę' | 'Ę' | 'ě' | 'Ě' => 'e',
        'ì'..='ï' | 'Ì'..='Ï' | 'ı' | 'İ' => 'i',
        'ñ' | 'Ñ' | 'ń' | 'Ń' => 'n',
        'ò'..='ö' | 'Ò'..='Ö' | 'ø' | 'Ø' | 'ő' | 'Ő' => 'o',
        'ù'..='ü' | 'Ù'..='Ü' | 'ů' | 'Ů' | 'ű' | 'Ű' => 'u',
        'ý' | 'ÿ' | 'Ý' | 'Ÿ' => 'y',
        'ş' | 'Ş' | 'š' | 'Š' | 'ś' | 'Ś' => 's',
        'ğ' | 'Ğ' => 'g',
        'ž' | 'Ž' | 'ź' | 'Ź' | 'ż' | 'Ż' => 'z',
        'ł' | 'Ł' => 'l',
        '\u{300}'..='\u{36f}' => return None,
        'ß' => return Some(Folded::Two('s', 's')),
        'æ' | 'Æ' => return Some(Folded::Two('a', 'e')),
        'œ' | 'Œ' => return Some(Folded::Two('o', 'e')),
        // Full-width letters of East Asian text.
        '\u{ff21}'..='\u{ff3a}' => char::from((c as u32 - 0xff21) as u8 + b'a'),
        '\u{ff41}'..='\u{ff5a}' => char::from((c as u32 - 0xff41) as u8 + b'a'),
        _ => c,
    };
    Some(Folded::One(ascii))
}

/// One or two characters.
#[derive(Clone, Copy)]
pub(crate) enum Folded {
    One(char),
    Two(char, char),
}

impl Folded {
    pub(crate) fn chars(self) -> impl Iterator<Item = char> {
        let (first, second) = match self {
            Self::One(c) => (c, None),
            Self::Two(c, d) => (c, Some(d)),
        };
        std::iter::once(first).chain(second)
    }
}

const NUMBERS: &[&str] =
    &["two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve"];

/// Stitch words beyond the abbreviations of the table of kinds: spelling, US meaning, UK meaning.
const EXTRA: &[(&str, Option<Kind>, Option<Kind>)] = &[
    ("ss", Some(Kind::SlSt), Some(Kind::SlSt)),
    ("slst", Some(Kind::SlSt), Some(Kind::SlSt)),
    ("sl-st", Some(Kind::SlSt), Some(Kind::SlSt)),
    ("ttr", None, Some(Kind::Dtr)),
    ("quadtr", None, Some(Kind::Trtr)),
    ("bobble", Some(Kind::Bobble), Some(Kind::Bobble)),
    ("popcorn", Some(Kind::Popcorn), Some(Kind::Popcorn)),
    ("ps", Some(Kind::Puff), Some(Kind::Puff)),
    ("cluster", Some(Kind::Cluster), Some(Kind::Cluster)),
];

/// The key of each English word of the table, named by its first spelling.
const KEYS: &[(&str, Key)] = &[
    ("in", Key::In),
    ("next", Key::Next),
    ("each", Key::Each),
    ("first", Key::First),
    ("last", Key::Last),
    ("same", Key::Same),
    ("as", Key::As),
    ("join", Key::Join),
    ("from", Key::From),
    ("hook", Key::Hook),
    ("to", Key::To),
    ("end", Key::End),
    ("around", Key::Around),
    ("across", Key::Across),
    ("rep", Key::Rep),
    ("times", Key::TimesWord),
    ("more", Key::More),
    ("once", Key::Once),
    ("twice", Key::Twice),
    ("thrice", Key::Thrice),
    ("for", Key::For),
    ("with", Key::With),
    ("change", Key::Change),
    ("turn", Key::Turn),
    ("sk", Key::Sk),
    ("leave", Key::Leave),
    ("hold", Key::Hold),
    ("unworked", Key::Unworked),
    ("held", Key::Held),
    ("surface", Key::Surface),
    ("fo", Key::Fo),
    ("close", Key::Closed),
    ("pm", Key::Pm),
    ("on", Key::On),
    ("other", Key::OtherWord),
    ("side", Key::Side),
    ("do", Key::Do),
    ("not", Key::Not),
    ("only", Key::Only),
    ("over", Key::Over),
    ("starting", Key::Starting),
    ("evenly", Key::Evenly),
    ("spaced", Key::Spaced),
    ("counts", Key::Counts),
    ("does", Key::Does),
    ("count", Key::Count),
    ("and", Key::And),
    ("then", Key::Then),
    ("rnd", Key::Rnd),
    ("row", Key::Row),
    ("r", Key::R),
    ("rs", Key::Rs),
    ("ws", Key::Ws),
    ("make", Key::Make),
    ("mr", Key::Mr),
    ("ring", Key::Ring),
    ("form", Key::Form),
    ("top", Key::Top),
    ("tch", Key::Tch),
    ("beg", Key::Beg),
    ("blo", Key::Blo),
    ("flo", Key::Flo),
    ("inc", Key::Inc),
    ("dec", Key::Dec),
    ("tog", Key::Tog),
    ("invdec", Key::Invdec),
    ("even", Key::Even),
    ("at", Key::AtWord),
    ("st", Key::St),
    ("ch", Key::Ch),
    ("sp", Key::Sp),
    ("shell", Key::Shell),
    ("you", Key::You),
    ("will", Key::Will),
    ("have", Key::Have),
    ("total", Key::Total),
    ("stuff", Key::Stuff),
    ("single", Key::Single),
    ("half", Key::Half),
    ("double", Key::Double),
    ("treble", Key::Treble),
    ("crochet", Key::Crochet),
    ("slip", Key::Slip),
    ("sl", Key::Sl),
    ("magic", Key::Magic),
    ("loop", Key::Loop),
    ("front", Key::FrontWord),
    ("back", Key::BackWord),
    ("post", Key::Post),
    ("fasten", Key::Fasten),
    ("off", Key::Off),
    ("place", Key::Place),
    ("marker", Key::Marker),
    ("adjustable", Key::Adjustable),
    ("extended", Key::Extended),
    ("inv", Key::Inv),
    ("etss", Key::Tunisian),
    ("the", Key::Drop),
    ("x", Key::Times),
];
