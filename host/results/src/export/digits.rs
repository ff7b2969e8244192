//! Numbers as they are written where they were multiplied and divided on the way.

/// The number with twelve digits, which is more than is known of any motor: `2.299999999999999` is 2.3 again.
pub fn rounded(x: f64) -> f64 {
    format!("{x:.11e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::rounded;

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
