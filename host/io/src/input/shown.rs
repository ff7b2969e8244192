//! Foreign text and numbers, made fit for one line of a message.

/// `` `a`, `b`, `c` ``; a long list is cut at twelve names and says how many more there are.
pub(super) fn quoted_list<S: AsRef<str>>(names: &[S]) -> String {
    const SHOWN: usize = 12;
    let quoted = |name: &S| format!("`{}`", shown(name.as_ref()));
    let mut list: Vec<String> = names.iter().take(SHOWN).map(quoted).collect();
    if names.len() > SHOWN {
        list.push(format!("and {} more", names.len() - SHOWN));
    }
    list.join(", ")
}

/// Control characters escaped, so that a file cannot steer the terminal; cut at 60 characters.
pub(super) fn shown(text: &str) -> String {
    const SHOWN: usize = 60;
    let mut out = String::new();
    for c in text.chars().take(SHOWN) {
        if c.is_control() {
            out.extend(c.escape_default());
        } else {
            out.push(c);
        }
    }
    if text.chars().nth(SHOWN).is_some() {
        out.push('…');
    }
    out
}

/// A number in plain digits, with an exponent where those would be long.
pub(super) fn plain(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || (1e-6..1e15).contains(&size) || !value.is_finite() {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn foreign_text_stays_on_one_short_line() {
        assert_eq!(shown("a\nb\u{1b}[31m"), "a\\nb\\u{1b}[31m");
        assert!(shown(&"x".repeat(1000)).chars().count() <= 61);
        let many: Vec<String> = (0..1000).map(|k| k.to_string()).collect();
        assert!(quoted_list(&many).ends_with("`11`, and 988 more"));
    }

    #[test]
    fn numbers_stay_short_and_read_back() {
        for value in [0.0, -1.5, 2048.0, 3e9, 1e300, -1e-300, f64::MIN_POSITIVE] {
            assert!(plain(value).len() < 30);
            assert_eq!(plain(value).parse(), Ok(value));
        }
    }
}
