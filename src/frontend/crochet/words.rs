//! Words of a pattern: folded spellings and what they mean to the grammar.

use crate::ir::{Kind, Language};
use std::collections::BTreeMap;

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

/// What a word is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Meaning {
    Key(Key),
    Stitch(Spelled),
    Shaped(Kind, u16, u16),
    Number(u32),
    Color(u16),
    Def(u16),
}

/// The vocabulary of one file: English, under the words of its language, under the names it declares.
pub(crate) struct Words {
    map: Table,
    capitals: BTreeMap<&'static str, Meaning>,
    long: BTreeMap<String, Meaning>,
    /// The file declared names, of any length.
    declares: bool,
    pub language: Language,
}

/// Folded words of up to 16 bytes in one open-addressed table.
struct Table {
    slots: Vec<(u128, Meaning)>,
}

const SLOTS: usize = 2048;

fn pack(word: &[u8]) -> Option<u128> {
    let mut bytes = [0_u8; 16];
    bytes.get_mut(..word.len())?.copy_from_slice(word);
    Some(u128::from_le_bytes(bytes))
}

fn slot(key: u128) -> usize {
    let folded = (key as u64) ^ ((key >> 64) as u64).rotate_left(29);
    (folded.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 53) as usize
}

impl Table {
    fn new() -> Self {
        Self { slots: vec![(0, Meaning::Key(Key::Drop)); SLOTS] }
    }
    fn get(&self, key: u128) -> Option<Meaning> {
        let mut at = slot(key);
        for _ in 0..SLOTS {
            match self.slots.get(at) {
                Some((found, meaning)) if *found == key => return Some(*meaning),
                Some((0, _)) | None => return None,
                Some(_) => at = (at + 1) % SLOTS,
            }
        }
        None
    }
    fn set(&mut self, key: u128, meaning: Meaning) {
        let mut at = slot(key);
        for _ in 0..SLOTS {
            match self.slots.get_mut(at) {
                Some(found) if found.0 == key || found.0 == 0 => {
                    *found = (key, meaning);
                    return;
                }
                _ => at = (at + 1) % SLOTS,
            }
        }
    }
}

impl Words {
    pub(crate) fn new(language: Language) -> Self {
        let mut words = Self {
            map: Table::new(),
            capitals: BTreeMap::new(),
            long: BTreeMap::new(),
            declares: false,
            language,
        };
        for (word, spellings) in Language::English.vocabulary().words {
            let Some((_, key)) = KEYS.iter().find(|(name, _)| name == word) else { continue };
            for spelling in *spellings {
                words.set(spelling, Meaning::Key(*key));
            }
        }
        for (index, number) in NUMBERS.iter().enumerate() {
            words.set(number, Meaning::Number(index as u32 + 2));
        }
        words.set("one", Meaning::Number(1));
        for kind in
            Kind::ALL.iter().copied().filter(|kind| !matches!(kind, Kind::Special | Kind::Ch | Kind::Skip))
        {
            words.english(kind);
        }
        for (spelling, us, uk) in EXTRA {
            words.set(spelling, Meaning::Stitch(Spelled { us: *us, uk: *uk }));
        }
        let vocabulary = language.vocabulary();
        let english = |words: &Self, word: &str| words.get(word.as_bytes());
        let own: Vec<(&str, Meaning)> = vocabulary
            .words
            .iter()
            .filter_map(|(word, spellings)| Some((english(&words, word)?, spellings)))
            .flat_map(|(meaning, spellings)| spellings.iter().map(move |spelling| (*spelling, meaning)))
            .collect();
        for (spelling, meaning) in own {
            words.own(spelling, meaning);
        }
        for (kind, spellings) in vocabulary.stitches {
            let meaning = match kind {
                Kind::Ch => Meaning::Key(Key::Ch),
                Kind::Skip => Meaning::Key(Key::Sk),
                _ => Meaning::Stitch(Spelled::plain(*kind)),
            };
            for spelling in *spellings {
                words.own(spelling, meaning);
            }
        }
        for (letters, kind, works, makes) in vocabulary.shaped {
            words.capitals.insert(letters, Meaning::Shaped(*kind, *works, *makes));
        }
        words
    }

    fn own(&mut self, spelling: &'static str, meaning: Meaning) {
        if self.language == Language::Letters {
            self.capitals.insert(spelling, meaning);
        } else {
            self.set(&fold_word(spelling), meaning);
        }
    }

    /// Enters the US and UK abbreviations of a kind.
    fn english(&mut self, kind: Kind) {
        let (us, uk) = (fold_word(kind.us()).replace(' ', ""), fold_word(kind.uk()).replace(' ', ""));
        if us == uk {
            self.set(&us, Meaning::Stitch(Spelled::plain(kind)));
            return;
        }
        let known = |words: &Self, word: &str| match words.get(word.as_bytes()) {
            Some(Meaning::Stitch(spelled)) => spelled,
            _ => Spelled { us: None, uk: None },
        };
        let spelled = known(self, &us);
        self.set(&us, Meaning::Stitch(Spelled { us: Some(kind), ..spelled }));
        let spelled = known(self, &uk);
        self.set(&uk, Meaning::Stitch(Spelled { uk: Some(kind), ..spelled }));
    }

    /// A stitch by its English abbreviation, whatever the language of the file.
    pub(crate) fn english_stitch(word: &str) -> Option<Spelled> {
        let of = |name: fn(Kind) -> &'static str| {
            Kind::ALL.iter().copied().find(|kind| fold_word(name(*kind)).replace(' ', "") == word)
        };
        let (us, uk) = (of(Kind::us), of(Kind::uk));
        (us.is_some() || uk.is_some()).then_some(Spelled { us, uk })
    }

    /// Enters a word; the plural in `s` is found by [`Words::get`].
    pub(crate) fn set(&mut self, word: &str, meaning: Meaning) {
        match pack(word.as_bytes()) {
            Some(key) if key != 0 => self.map.set(key, meaning),
            _ => {
                self.long.insert(word.to_owned(), meaning);
            }
        }
    }

    /// Enters a name that the file declares.
    pub(crate) fn declare(&mut self, name: &str, meaning: Meaning) {
        self.long.insert(fold_word(name), meaning);
        self.declares = true;
    }

    /// The names that the file declared so far.
    pub(crate) fn declared(self) -> impl Iterator<Item = (String, Meaning)> {
        self.long.into_iter().filter(|(_, meaning)| matches!(meaning, Meaning::Color(_) | Meaning::Def(_)))
    }

    /// The meaning of a folded word.
    pub(crate) fn get(&self, word: &[u8]) -> Option<Meaning> {
        if self.declares || word.len() > size_of::<u128>() {
            let declared = std::str::from_utf8(word).ok().and_then(|word| self.long.get(word));
            if declared.is_some() {
                return declared.copied();
            }
        }
        let found = pack(word).and_then(|key| self.map.get(key));
        if found.is_some() {
            return found;
        }
        // `dcs`, `increases`: a plural means what its singular means.
        let singular = word.strip_suffix(b"s").filter(|singular| singular.len() >= 2)?;
        match pack(singular).and_then(|key| self.map.get(key)) {
            Some(meaning @ (Meaning::Stitch(_) | Meaning::Key(_))) => Some(meaning),
            _ => None,
        }
    }

    /// The meaning of a word in capitals, in a notation where case matters.
    pub(crate) fn capital(&self, word: &str) -> Option<Meaning> {
        self.capitals.get(word).copied()
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
