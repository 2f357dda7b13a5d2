//! A small reader of EBNF files, and a sampler that draws sentences from the grammar it finds there.

use std::collections::BTreeMap;

/// An expression of the grammar.
#[derive(Clone, Debug)]
pub(crate) enum Expr {
    Word(String),
    Terminal(String),
    Rule(String),
    Sequence(Vec<Expr>),
    /// The alternatives; the number is the index of this choice in the whole grammar.
    Choice(usize, Vec<Expr>),
    Optional(usize, Box<Expr>),
    Many(usize, Box<Expr>),
}

/// A grammar: its rules, and how many choices it has.
pub(crate) struct Grammar {
    pub(crate) rules: BTreeMap<String, Expr>,
    pub(crate) choices: usize,
}

struct Reader {
    tokens: Vec<String>,
    at: usize,
    choices: usize,
}

impl Grammar {
    pub(crate) fn read(text: &str) -> Self {
        let mut reader = Reader { tokens: tokens(text), at: 0, choices: 0 };
        let mut rules = BTreeMap::new();
        while reader.at < reader.tokens.len() {
            let name = reader.next();
            assert_eq!(reader.next(), "=", "after {name}");
            let expr = reader.choice();
            assert_eq!(reader.next(), ";", "after the rule {name}");
            assert!(rules.insert(name.clone(), expr).is_none(), "{name} is defined twice");
        }
        let grammar = Self { rules, choices: reader.choices };
        grammar.rules.values().for_each(|rule| grammar.complete(rule));
        grammar
    }

    fn complete(&self, expr: &Expr) {
        match expr {
            Expr::Rule(name) => assert!(self.rules.contains_key(name), "rule {name} is missing"),
            Expr::Sequence(parts) | Expr::Choice(_, parts) => {
                for part in parts {
                    self.complete(part);
                }
            }
            Expr::Optional(_, part) | Expr::Many(_, part) => self.complete(part),
            Expr::Word(_) | Expr::Terminal(_) => {}
        }
    }
}

fn tokens(text: &str) -> Vec<String> {
    let mut out = Vec::new();
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        match c {
            '(' if chars.peek() == Some(&'*') => {
                let mut last = ' ';
                for c in chars.by_ref() {
                    if last == '*' && c == ')' {
                        break;
                    }
                    last = c;
                }
            }
            '"' => out.push(format!("\"{}", chars.by_ref().take_while(|c| *c != '"').collect::<String>())),
            c if c.is_whitespace() => {}
            c if c.is_alphanumeric() => {
                let mut word = String::from(c);
                while let Some(c) = chars.next_if(|c| c.is_alphanumeric()) {
                    word.push(c);
                }
                out.push(word);
            }
            c => out.push(c.to_string()),
        }
    }
    out
}

impl Reader {
    fn next(&mut self) -> String {
        let token = self.tokens.get(self.at).cloned().unwrap_or_default();
        self.at += 1;
        token
    }
    fn peek(&self) -> &str {
        self.tokens.get(self.at).map_or("", String::as_str)
    }
    fn number(&mut self) -> usize {
        self.choices += 1;
        self.choices - 1
    }
    fn choice(&mut self) -> Expr {
        let mut parts = vec![self.sequence()];
        while self.peek() == "|" {
            self.at += 1;
            parts.push(self.sequence());
        }
        if parts.len() == 1 { parts.remove(0) } else { Expr::Choice(self.number(), parts) }
    }
    fn sequence(&mut self) -> Expr {
        let mut parts = Vec::new();
        while !matches!(self.peek(), "" | ";" | "|" | ")" | "]" | "}") {
            parts.push(self.item());
        }
        Expr::Sequence(parts)
    }
    fn item(&mut self) -> Expr {
        let token = self.next();
        let close = |reader: &mut Self, mark: &str| assert_eq!(reader.next(), mark);
        match token.as_str() {
            "(" => {
                let inner = self.choice();
                close(self, ")");
                inner
            }
            "[" => {
                let inner = self.choice();
                close(self, "]");
                Expr::Optional(self.number(), Box::new(inner))
            }
            "{" => {
                let inner = self.choice();
                close(self, "}");
                Expr::Many(self.number(), Box::new(inner))
            }
            _ if token.starts_with('"') => Expr::Word(token[1..].to_owned()),
            _ if token.chars().all(char::is_uppercase) => Expr::Terminal(token),
            _ => Expr::Rule(token),
        }
    }
}

/// Draws sentences. Every alternative is drawn in turn, so that a few thousand sentences cover the grammar.
pub(crate) struct Sampler<'g> {
    grammar: &'g Grammar,
    /// How often each alternative of each choice was taken.
    pub(crate) taken: Vec<Vec<u32>>,
    random: u64,
    out: String,
    glue: bool,
}

impl<'g> Sampler<'g> {
    pub(crate) fn new(grammar: &'g Grammar, seed: u64) -> Self {
        let taken = vec![Vec::new(); grammar.choices];
        Self { grammar, taken, random: seed | 1, out: String::new(), glue: true }
    }

    pub(crate) fn draw(&mut self, rule: &str) -> String {
        self.out.clear();
        self.glue = true;
        let expr = &self.grammar.rules[rule];
        self.expand(expr, 0);
        std::mem::take(&mut self.out)
    }

    fn random(&mut self, below: u64) -> u64 {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        (self.random >> 11) % below
    }

    fn pick(&mut self, choice: usize, of: usize, depth: usize) -> usize {
        if self.taken[choice].is_empty() {
            self.taken[choice] = vec![0; of];
        }
        // Deep inside, the first alternatives are the short ones; else what was drawn least comes next, mostly.
        let index = if depth > 36 {
            0
        } else if self.random(3) == 0 {
            self.random(of as u64) as usize
        } else {
            let least = self.taken[choice].iter().min().copied().unwrap_or(0);
            self.taken[choice].iter().position(|taken| *taken == least).unwrap_or(0)
        };
        self.taken[choice][index] += 1;
        index
    }

    fn expand(&mut self, expr: &Expr, depth: usize) {
        match expr {
            Expr::Word(word) => self.word(word),
            Expr::Terminal(terminal) => self.terminal(terminal),
            Expr::Rule(name) => {
                let rule = &self.grammar.rules[name];
                self.expand(rule, depth + 1);
            }
            Expr::Sequence(parts) => parts.iter().for_each(|part| self.expand(part, depth + 1)),
            Expr::Choice(index, parts) => {
                let pick = self.pick(*index, parts.len(), depth);
                self.expand(&parts[pick], depth + 1);
            }
            Expr::Optional(index, part) => {
                if self.pick(*index, 2, depth) == 1 {
                    self.expand(part, depth + 1);
                }
            }
            Expr::Many(index, part) => {
                let count = if depth > 26 { 0 } else { self.pick(*index, 3, depth) };
                (0..count).for_each(|_| self.expand(part, depth + 1));
            }
        }
    }

    fn word(&mut self, word: &str) {
        if !self.glue && !matches!(word, ")" | "]" | "}" | "," | ";" | "." | ":") {
            self.out.push(' ');
        }
        self.out.push_str(word);
        self.glue = matches!(word, "(" | "[" | "{" | "//" | "#");
    }

    fn terminal(&mut self, terminal: &str) {
        let random = self.random(30) as usize;
        let number = (2 + random).to_string();
        match terminal {
            "INT" => self.word(&number),
            "GLUED" => {
                self.out.push_str(&number);
                self.glue = false;
            }
            "ORD" => {
                let ordinal = ["2nd", "3rd", "4th", "21st", "6ª"][random % 5];
                self.word(ordinal);
            }
            "HYPHEN" => {
                self.out.push('-');
                self.glue = true;
            }
            "NEG" => {
                self.word("-");
                self.glue = true;
            }
            "DASH" => self.word(["-", "—", "--"][random % 3]),
            "BACK" => self.word(["<-", "←"][random % 2]),
            "FWD" => self.word(["->", "→"][random % 2]),
            "TIMES" => self.word(["x", "×"][random % 2]),
            "DECLARED" => self.word("white"),
            "COLOR" => self.word(["B", "D", "white"][random % 3]),
            "DEFINED" => self.word("flurb"),
            "WORD" => self.word(["Zebra", "Knopf"][random % 2]),
            "NAME" => self.word(["frill", "mauve"][random % 2]),
            "QUOTED" => self.word("\"Left Leg\""),
            "HEX" => self.word("#c0ffee"),
            "SETTING" => self.word(["star-times=more", "ch-sp = chains"][random % 2]),
            "TEXT" => self.word("made for a friend, 3 evenings"),
            "BULLET" => self.word("•"),
            "NL" => self.word("\n"),
            other => panic!("the sampler does not know the terminal {other}"),
        }
        if matches!(terminal, "INT" | "ORD") {
            self.glue = false;
        }
    }
}
