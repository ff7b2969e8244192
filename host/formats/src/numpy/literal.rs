//! Literals of Python, in which the header of a NumPy file is written.

/// Depth to which literals are nested.
const DEEPEST: usize = 32;

/// A literal of Python.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Literal {
    /// A text.
    Text(String),
    /// A number without sign or fraction.
    Count(u64),
    /// `True` or `False`.
    Flag(bool),
    /// `None`.
    Nothing,
    /// A list or a tuple.
    List(Vec<Literal>),
    /// A dictionary.
    Pairs(Vec<(Literal, Literal)>),
}

impl Literal {
    /// Reads the only literal of a text; `None` where it is none.
    pub(crate) fn parse(text: &str) -> Option<Self> {
        let mut rest = Rest(text);
        let literal = rest.literal(DEEPEST)?;
        rest.skip_blanks();
        rest.0.is_empty().then_some(literal)
    }

    /// The value of a dictionary under `key`.
    pub(crate) fn get(&self, key: &str) -> Option<&Literal> {
        let Literal::Pairs(pairs) = self else {
            return None;
        };
        let is_it = |name: &Literal| matches!(name, Literal::Text(text) if text == key);
        pairs
            .iter()
            .find_map(|(name, value)| is_it(name).then_some(value))
    }

    /// The numbers of a list of numbers.
    pub(crate) fn counts(&self) -> Option<Vec<u64>> {
        let Literal::List(list) = self else {
            return None;
        };
        let count = |literal: &Literal| match literal {
            Literal::Count(count) => Some(*count),
            _ => None,
        };
        list.iter().map(count).collect()
    }
}

/// What is left of a text.
struct Rest<'t>(&'t str);

impl Rest<'_> {
    fn skip_blanks(&mut self) {
        self.0 = self.0.trim_start();
    }

    fn take(&mut self, token: &str) -> bool {
        self.skip_blanks();
        match self.0.strip_prefix(token) {
            Some(rest) => {
                self.0 = rest;
                true
            }
            None => false,
        }
    }

    fn literal(&mut self, depth: usize) -> Option<Literal> {
        let inner = depth.checked_sub(1)?;
        if self.take("{") {
            return self.pairs(inner);
        }
        if self.take("[") {
            return Some(Literal::List(self.list("]", inner)?.0));
        }
        if self.take("(") {
            let (mut list, is_tuple) = self.list(")", inner)?;
            // One value in brackets is that value.
            return match (list.len(), is_tuple) {
                (1, false) => list.pop(),
                _ => Some(Literal::List(list)),
            };
        }
        for (word, literal) in [
            ("True", Literal::Flag(true)),
            ("False", Literal::Flag(false)),
            ("None", Literal::Nothing),
        ] {
            if self.take(word) {
                return Some(literal);
            }
        }
        if self.0.starts_with(|first: char| first.is_ascii_digit()) {
            return self.count();
        }
        self.text()
    }

    /// The literals up to `end`, and whether there was a comma.
    fn list(&mut self, end: &str, depth: usize) -> Option<(Vec<Literal>, bool)> {
        let (mut list, mut comma) = (Vec::new(), false);
        while !self.take(end) {
            list.push(self.literal(depth)?);
            if self.take(",") {
                comma = true;
            } else if !self.0.trim_start().starts_with(end) {
                return None;
            }
        }
        Some((list, comma))
    }

    fn pairs(&mut self, depth: usize) -> Option<Literal> {
        let mut pairs = Vec::new();
        while !self.take("}") {
            let key = self.literal(depth)?;
            if !self.take(":") {
                return None;
            }
            pairs.push((key, self.literal(depth)?));
            if !self.take(",") && !self.0.trim_start().starts_with('}') {
                return None;
            }
        }
        Some(Literal::Pairs(pairs))
    }

    fn count(&mut self) -> Option<Literal> {
        let end = self
            .0
            .find(|next: char| !next.is_ascii_digit())
            .unwrap_or(self.0.len());
        let (digits, rest) = self.0.split_at_checked(end)?;
        // Python 2 marked long integers.
        self.0 = rest.strip_prefix('L').unwrap_or(rest);
        digits.parse().ok().map(Literal::Count)
    }

    fn text(&mut self) -> Option<Literal> {
        let marked = self.0.strip_prefix(['u', 'b']).unwrap_or(self.0);
        let mut letters = marked.chars();
        let quote = letters.next().filter(|first| ['\'', '"'].contains(first))?;
        let mut text = String::new();
        loop {
            match letters.next()? {
                letter if letter == quote => break,
                '\\' => text.push(escaped(&mut letters)?),
                letter => text.push(letter),
            }
        }
        self.0 = letters.as_str();
        Some(Literal::Text(text))
    }
}

/// The letter behind a backslash.
fn escaped(letters: &mut std::str::Chars<'_>) -> Option<char> {
    let digits = match letters.next()? {
        'n' => return Some('\n'),
        't' => return Some('\t'),
        'r' => return Some('\r'),
        'x' => 2,
        'u' => 4,
        'U' => 8,
        letter => return Some(letter),
    };
    let code = (0..digits).try_fold(0_u32, |code, _| {
        Some((code << 4) | letters.next()?.to_digit(16)?)
    });
    char::from_u32(code?)
}
