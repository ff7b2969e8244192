//! Numbers as people read them.

/// A value with as many digits as its standard error deserves: `58.35908(3)`.
pub fn with_error(value: f64, std: Option<f64>) -> String {
    let Some(std) = std.filter(|std| *std > 0.0 && std.is_finite()) else {
        return if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
            format!("{value}")
        } else {
            format!("{value:e}")
        };
    };
    let shift = shift(value.abs().max(std));
    let (value, std) = (value / 10f64.powi(shift), std / 10f64.powi(shift));
    let digits = (1 - std.log10().floor() as i32).clamp(0, 12) as usize;
    let uncertain = (std * 10f64.powi(digits as i32)).round();
    let tail = tail(shift);
    if digits == 0 {
        format!("{value:.0}({std:.0}){tail}")
    } else {
        format!("{value:.digits$}({uncertain:.0}){tail}")
    }
}

/// A value with as many digits as it deserves, and what is to be said of its error behind the unit: with its standard error in
/// brackets, or, where an error of the recording may well be a power of ten larger (`systematic`, the largest of them), with the digits that
/// that one leaves.
pub fn stated(value: f64, std: f64, systematic: f64) -> (String, String) {
    let text = with_error(value, Some(std));
    if !(std > 0.0 && systematic.log10().floor() > std.log10().floor()) {
        return (text, String::new());
    }
    let error = format!(", std {}", rough(std));
    let text = with_error(value, Some(systematic));
    match (text.find('('), text.find(')')) {
        (Some(from), Some(to)) => (text[..from].to_owned() + &text[to + 1..], error),
        _ => (text, error),
    }
}

/// The power of ten that numbers of this size are written with: none for what reads well plainly.
fn shift(size: f64) -> i32 {
    let exponent = size.max(f64::MIN_POSITIVE).log10().floor() as i32;
    if (-3..6).contains(&exponent) {
        0
    } else {
        exponent
    }
}

/// The power of ten behind such a number.
fn tail(shift: i32) -> String {
    if shift == 0 {
        String::new()
    } else {
        format!("e{shift}")
    }
}

/// An interval, both ends with as many digits as tell them apart, or its only end. `None` where it has none.
pub fn interval(ends: [Option<f64>; 2], unit: &str) -> Option<String> {
    let (low, high) = match ends {
        [Some(low), Some(high)] => (low, high),
        [Some(low), None] => return Some(format!("above {} {unit}", short(low))),
        [None, Some(high)] => return Some(format!("below {} {unit}", short(high))),
        [None, None] => return None,
    };
    let size = low.abs().max(high.abs()).max(f64::MIN_POSITIVE);
    let shift = shift(size);
    let power = 10f64.powi(shift);
    let width = (high - low).max(1e-15 * size) / power;
    let digits = (2.0 - width.log10().floor()).clamp(0.0, 15.0) as usize;
    let tail = tail(shift);
    Some(format!(
        "{:.digits$}{tail} to {:.digits$}{tail} {unit}",
        low / power,
        high / power
    ))
}

/// Two significant digits.
pub fn rough(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return short(x);
    }
    let exponent = x.abs().log10().floor() as i32;
    if (-3..6).contains(&exponent) {
        format!("{x:.*}", (1 - exponent).max(0) as usize)
    } else {
        format!("{x:.1e}")
    }
}

/// Four significant digits or more in at most ten columns.
pub fn short(x: f64) -> String {
    if !x.is_finite() {
        "-".to_owned()
    } else if x == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e6).contains(&x.abs()) {
        let digits = (4 - x.abs().max(1e-3).log10().floor() as i32).clamp(0, 7) as usize;
        format!("{x:.digits$}")
    } else {
        format!("{x:.3e}")
    }
}
