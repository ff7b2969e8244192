//! How surely a column's name means a quantity.

use super::suggest::nearest;
use crate::channel::Facts;

/// How surely a name means a quantity, the surest last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Match {
    /// The name is nearly the word, or a symbol with an index.
    Nearly,
    /// The name begins with the word, or a long word stands somewhere in it.
    Part,
    /// The name is the word.
    Whole,
}

/// Words of so many letters are told in the middle of others, as in `Batteriespannung`.
const LONG: usize = 4;

/// A name in lower case, without accents.
pub(super) fn folded(name: &str) -> String {
    let mut out = String::with_capacity(name.len());
    for c in name.chars().flat_map(char::to_lowercase) {
        match c {
            'á' | 'à' | 'â' | 'ä' | 'ã' => out.push('a'),
            'é' | 'è' | 'ê' | 'ë' => out.push('e'),
            'í' | 'ì' | 'î' | 'ï' => out.push('i'),
            'ó' | 'ò' | 'ô' | 'ö' | 'õ' => out.push('o'),
            'ú' | 'ù' | 'û' | 'ü' => out.push('u'),
            'ñ' => out.push('n'),
            'ç' => out.push('c'),
            'ß' => out.push_str("ss"),
            c => out.push(c),
        }
    }
    out
}

/// A name cut at what is no letter or digit, and where a small letter is followed by a large one: `LeftAppliedVolts` has three parts.
pub(super) fn parts(name: &str) -> Vec<String> {
    let mut parts: Vec<String> = Vec::new();
    let mut before: Option<char> = None;
    for c in name.chars() {
        let is_word = c.is_alphanumeric() || matches!(c, '%' | '\u{b0}');
        // In `u_mV` the small letter is the unit's prefix.
        let is_prefix = parts.last().is_some_and(|last| last.chars().count() == 1);
        let begins = before.is_none_or(|b| b.is_lowercase() && c.is_uppercase() && !is_prefix);
        if is_word {
            if begins {
                parts.push(String::new());
            }
            if let Some(last) = parts.last_mut() {
                last.push(c);
            }
        }
        before = is_word.then_some(c);
    }
    parts.iter().map(|part| folded(part)).collect()
}

/// A name as words are looked for in it: folded and cut once, however many they are.
pub(super) struct Spelling {
    folded: String,
    parts: Vec<String>,
    joined: String,
}

impl Spelling {
    pub(super) fn of(name: &str) -> Self {
        let parts = parts(name);
        Spelling {
            folded: folded(name),
            joined: parts.join("_"),
            parts,
        }
    }

    /// Its parts with one mark between them.
    pub(super) fn joined(&self) -> &str {
        &self.joined
    }

    /// A long word may stand anywhere in a name, one of two or three letters must be a part of it, and a single letter the first one.
    fn is_called(&self, word: &str) -> bool {
        match word.len() {
            0 => false,
            1 => self.parts.first().is_some_and(|first| first == word),
            2 | 3 => self.has_part(&[word]),
            _ => self.folded.contains(word) || self.joined.contains(word),
        }
    }

    /// Whether one of these words is a part of a name, or a long one stands in it.
    fn speaks_of(&self, words: &[&str]) -> bool {
        let mut long = words.iter().filter(|word| word.len() >= LONG);
        self.has_part(words) || long.any(|word| self.folded.contains(word))
    }

    /// Whether one of these words is a part of a name.
    pub(super) fn has_part(&self, words: &[&str]) -> bool {
        self.parts.iter().any(|part| words.contains(&part.as_str()))
    }

    /// How surely a name means one of these words and none of the others, and the place of the word: of several the likeliest.
    pub(super) fn called(&self, words: &[&str], others: &[&str]) -> Option<(Match, usize)> {
        if self.speaks_of(others) {
            return None;
        }
        let whole = self.folded.trim();
        let place = |is: &dyn Fn(&str) -> bool| words.iter().position(|word| is(word));
        let found = place(&|word| whole == word).map(|place| (Match::Whole, place));
        found.or_else(|| place(&|word| self.is_called(word)).map(|place| (Match::Part, place)))
    }
}

impl Facts {
    /// How surely a name means this quantity, and the place of the word that says so: of several the likeliest.
    pub(super) fn called(&self, name: &str) -> Option<(Match, usize)> {
        let spelling = Spelling::of(name);
        if spelling.speaks_of(self.others) {
            return None;
        }
        spelling.called(self.words, &[]).or_else(|| {
            let whole = spelling.folded.trim();
            let mut words = self.words.iter().copied();
            let nearly = match whole.len() {
                0 | 1 => false,
                2 => words.any(|word| word.len() == 1 && whole.starts_with(word)),
                _ => nearest(whole, words.filter(|word| word.len() > 2)).is_some(),
            };
            nearly.then_some((Match::Nearly, self.words.len()))
        })
    }
}
