//! Numbers as they are written where they were multiplied and divided on the way.

/// The number with twelve digits, which is more than is known of any motor: `2.299999999999999` is 2.3 again.
pub fn rounded(x: f64) -> f64 {
    format!("{x:.11e}").parse().unwrap_or(x)
}

/// A number that YAML takes for one: with a point, and with a sign in its exponent.
pub fn yaml(x: f64) -> String {
    let text = format!("{x:?}");
    let Some((digits, power)) = text.split_once('e') else {
        return text;
    };
    let point = if digits.contains('.') { "" } else { ".0" };
    let sign = if power.starts_with('-') { "" } else { "+" };
    format!("{digits}{point}e{sign}{power}")
}

#[cfg(test)]
mod tests {
    use super::{rounded, yaml};

    #[test]
    fn yaml_takes_numbers_of_every_size_for_numbers() {
        for (x, text) in [
            (1e-7, "1.0e-7"),
            (-2.5e-9, "-2.5e-9"),
            (3e20, "3.0e+20"),
            (0.5, "0.5"),
            (12.0, "12.0"),
        ] {
            assert_eq!(yaml(x), text);
            assert_eq!(text.parse(), Ok(x));
        }
    }

    #[test]
    fn what_was_multiplied_and_divided_is_as_it_was_typed() {
        for k in 1..2000 {
            let typed = f64::from(k) / 100.0;
            for factor in [std::f64::consts::TAU, 0.0171, 3.0, 1e-9] {
                assert_eq!(rounded(typed * factor / factor), typed, "{typed} {factor}");
            }
        }
        for x in [0.0, 1e-300, -1e300, 0.1 + 0.2] {
            assert!((rounded(x) - x).abs() <= 1e-11 * x.abs());
        }
    }
}
