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
    let size = value.abs().max(std).max(f64::MIN_POSITIVE);
    let exponent = size.log10().floor() as i32;
    // Plain notation for what reads well plainly, else a power of ten.
    let shift = if (-3..6).contains(&exponent) {
        0
    } else {
        exponent
    };
    let (value, std) = (value / 10f64.powi(shift), std / 10f64.powi(shift));
    let digits = (1 - std.log10().floor() as i32).clamp(0, 12) as usize;
    let uncertain = (std * 10f64.powi(digits as i32)).round();
    let tail = if shift == 0 {
        String::new()
    } else {
        format!("e{shift}")
    };
    if digits == 0 {
        format!("{value:.0}({std:.0}){tail}")
    } else {
        format!("{value:.digits$}({uncertain:.0}){tail}")
    }
}

/// A value whose last digit is the second one of an error that is larger than its standard error.
pub fn to_error(value: f64, error: f64) -> String {
    let text = with_error(value, Some(error));
    match (text.find('('), text.find(')')) {
        (Some(from), Some(to)) => text[..from].to_owned() + &text[to + 1..],
        _ => text,
    }
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
