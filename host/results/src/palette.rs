//! Colours of all drawings: the colour-blind tell them apart (Okabe and Ito, 2008), and they show on white and on black.

/// What was measured: grey, since colours are models.
pub const MEASURED: &str = "#7f8790";
/// The first model, which lacks something.
pub const BASE: &str = "#d55e00";
/// The best model.
pub const MODEL: &str = "#0072b2";
/// The encoder's own error.
pub const FLOOR: &str = "#7f8790";
/// A further series.
pub const OTHER: &str = "#009e73";
/// Marks and frames, and models on the way.
pub const QUIET: &str = "#7f8790";
/// For as many series as come, the best first.
pub const LIST: [&str; 8] = [
    MODEL, BASE, OTHER, "#cc79a7", "#e69f00", "#56b4e9", "#8a6d3b", QUIET,
];

/// The colour of series `k`.
pub fn of(k: usize) -> &'static str {
    LIST[k % LIST.len()]
}

/// Red, green and blue of a colour of this file.
pub fn rgb(colour: &str) -> (u8, u8, u8) {
    let part = |at: usize| {
        let digits = colour.get(at..at + 2).unwrap_or_default();
        u8::from_str_radix(digits, 16).unwrap_or_default()
    };
    (part(1), part(3), part(5))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_colour_is_its_three_numbers() {
        for colour in LIST {
            let (r, g, b) = rgb(colour);
            assert_eq!(format!("#{r:02x}{g:02x}{b:02x}"), colour);
        }
    }
}
