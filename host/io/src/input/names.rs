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

/// A long word may stand anywhere in a name, one of two or three letters must be a part of it, and a single letter the first one.
pub(super) fn is_called(name: &str, word: &str) -> bool {
    match word.len() {
        0 => false,
        1 => parts(name).first().is_some_and(|first| first == word),
        2 | 3 => parts(name).iter().any(|part| part == word),
        _ => folded(name).contains(word) || parts(name).join("_").contains(word),
    }
}

/// Whether one of these words is a part of a name, or a long one stands in it.
pub(super) fn speaks_of(name: &str, words: &[&str]) -> bool {
    let long = |word: &&&str| word.len() >= LONG;
    has_part(name, words)
        || words
            .iter()
            .filter(long)
            .any(|word| folded(name).contains(word))
}

/// Whether one of these words is a part of a name.
pub(super) fn has_part(name: &str, words: &[&str]) -> bool {
    parts(name)
        .iter()
        .any(|part| words.contains(&part.as_str()))
}

impl Facts {
    /// How surely a name means this quantity, and the place of the word that says so: of several the likeliest.
    pub(super) fn called(&self, name: &str) -> Option<(Match, usize)> {
        if speaks_of(name, self.others) {
            return None;
        }
        let whole = folded(name.trim());
        let place = |is: &dyn Fn(&str) -> bool| self.words.iter().position(|word| is(word));
        if let Some(place) = place(&|word| whole == word) {
            return Some((Match::Whole, place));
        }
        if let Some(place) = place(&|word| is_called(name, word)) {
            return Some((Match::Part, place));
        }
        let nearly = match whole.len() {
            0 | 1 => false,
            2 => self
                .words
                .iter()
                .any(|word| word.len() == 1 && whole.starts_with(word)),
            _ => {
                let long = self.words.iter().copied().filter(|word| word.len() > 2);
                nearest(&whole, long).is_some()
            }
        };
        nearly.then_some((Match::Nearly, self.words.len()))
    }
}
