//! One cell to one finite number or switch.

use super::read_error::ReadFault;
use super::shown::shown;

/// A finite number.
pub(super) fn number(text: &str) -> Result<f64, ReadFault> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(value) if value.is_nan() => Err(ReadFault::Nan { text: shown(text) }),
        Ok(_) => Err(ReadFault::Infinite { text: shown(text) }),
        Err(_) if text.is_empty() => Err(ReadFault::EmptyCell),
        Err(_) => Err(ReadFault::NotANumber {
            text: shown(text),
            remedy: remedy(text),
        }),
    }
}

/// What loggers and spreadsheets write where a slow sensor has nothing new; lower case.
const NOTHING: [&str; 10] = [
    "", "nan", "na", "n/a", "#n/a", "null", "nil", "none", "-", "--",
];

/// Whether a cell says something.
pub(super) fn is_told(text: &str) -> bool {
    let text = text.trim();
    !NOTHING.iter().any(|none| text.eq_ignore_ascii_case(none))
}

/// A number in our unit.
///
/// # Errors
/// It, or what is made of it, is not finite.
pub(super) fn converted(
    value: f64,
    to: impl FnOnce(f64) -> Result<f64, ReadFault>,
) -> Result<f64, ReadFault> {
    checked(value).and_then(to).and_then(checked)
}

/// A number from memory; what is none is refused as its text would be.
pub(super) fn checked(value: f64) -> Result<f64, ReadFault> {
    if value.is_finite() {
        Ok(value)
    } else {
        number(&value.to_string())
    }
}

/// A number that a conversion of `text` has made, which must still be finite.
pub(super) fn finite(value: f64, text: &str) -> Result<f64, ReadFault> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(ReadFault::Infinite { text: shown(text) })
    }
}

/// Words for a bridge that drives, and for one that does not; lower case.
const SWITCHES: [(&[&str], bool); 2] = [
    (
        &[
            "true",
            "on",
            "yes",
            "enabled",
            "armed",
            "ein",
            "an",
            "ja",
            "marche",
            "oui",
            "encendido",
            "si",
        ],
        true,
    ),
    (
        &[
            "false", "off", "no", "disabled", "disarmed", "aus", "nein", "arret", "non", "apagado",
        ],
        false,
    ),
];

/// Whether a word says that a bridge drives, or that it does not.
pub(super) fn switch_word(text: &str) -> Option<bool> {
    let says = |words: &[&str]| words.iter().any(|word| text.eq_ignore_ascii_case(word));
    let mut found = SWITCHES.iter().filter(|(words, _)| says(words));
    found.next().map(|(_, on)| *on)
}

/// 0 or 1, or a word.
pub(super) fn switch(text: &str) -> Result<bool, ReadFault> {
    match text.parse() {
        Ok(1.0) => return Ok(true),
        Ok(0.0) => return Ok(false),
        _ => {}
    }
    if let Some(on) = switch_word(text) {
        return Ok(on);
    }
    match number(text) {
        Err(ReadFault::EmptyCell) => Err(ReadFault::EmptyCell),
        _ => Err(ReadFault::NotASwitch { text: shown(text) }),
    }
}

fn remedy(text: &str) -> &'static str {
    if text.contains(',') && text.replace(',', ".").parse::<f64>().is_ok() {
        "write a point for the decimal comma"
    } else if has_thousands_marks(text) {
        "write it without marks between the thousands"
    } else {
        "write a plain number such as 0.25 or 1e-3, without a unit"
    }
}

/// `1,234.5`, `1.234,5` or `1 234`.
fn has_thousands_marks(text: &str) -> bool {
    let bare: String = text
        .chars()
        .filter(|c| !",.' \u{a0}\u{202f}".contains(*c))
        .collect();
    bare.len() < text.len() && bare.parse::<f64>().is_ok()
}
