//! Errors as bars, on a logarithmic scale from the encoder's own.

use crate::report::style::{GOOD, HEADING, painted};
use shared::encoder::FLOOR_RMS_COUNTS;

/// Widest bar, characters.
pub const WIDTH: usize = 24;

/// A bar for `rms`, full at `most`, empty at the encoder's floor.
pub fn bar(rms: f64, most: f64) -> String {
    let above = |rms: f64| (rms / FLOOR_RMS_COUNTS).ln().max(0.0);
    let part = above(rms) / above(most).max(f64::MIN_POSITIVE);
    let length = (part.clamp(0.0, 1.0) * WIDTH as f64).round() as usize;
    "#".repeat(length)
}

/// Heights of a line of text.
const HEIGHTS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

/// Sizes of an error over time in so many characters, logarithmic from the encoder's own to `most`: the RMS of each
/// stretch.
pub fn sparkline(errors: &[f64], most: f64, characters: usize) -> String {
    let stretch = errors.len().div_ceil(characters.max(1)).max(1);
    let span = (most / FLOOR_RMS_COUNTS).ln().max(f64::MIN_POSITIVE);
    errors
        .chunks(stretch)
        .map(|part| {
            let square = part.iter().map(|e| e * e).sum::<f64>() / part.len() as f64;
            height((square.sqrt() / FLOOR_RMS_COUNTS).ln() / span)
        })
        .collect()
}

/// The character for a part of the greatest height; for what is no number, the highest.
pub fn height(part: f64) -> char {
    let most = HEIGHTS.len() - 1;
    let part = if part.is_nan() { 1.0 } else { part };
    HEIGHTS[(part.clamp(0.0, 1.0) * most as f64).round() as usize]
}

/// An error with the digits that tell.
pub fn counts(rms: f64) -> String {
    if !rms.is_finite() {
        "-".to_owned()
    } else if rms < 10.0 {
        format!("{rms:.3}")
    } else if rms < 1e5 {
        format!("{rms:.1}")
    } else {
        format!("{rms:.2e}")
    }
}

/// The error ladder: a line for each model with its error where it was fitted, its error on what was held out
/// (not a number where nothing was), and a bar for the latter. Errors of runs through windows of `window_s`, s; of whole runs for none.
pub fn ladder(entries: &[(String, f64, f64)], window_s: Option<f64>) -> String {
    let errors = entries.iter().flat_map(|entry| [entry.1, entry.2]);
    let most = errors.filter(|rms| rms.is_finite()).fold(0.0, f64::max);
    let head = format!("{:28}{:>10}{:>11}", "error ladder", "fitted", "held out");
    let mut out = format!(
        "{}   counts RMS{}, bars logarithmic\n",
        painted(HEADING, head),
        window_s.map_or(String::new(), |window_s| format!(" in {window_s:.2} s")),
    );
    for (name, fitted, held_out) in entries {
        let shown = if held_out.is_finite() {
            *held_out
        } else {
            *fitted
        };
        out += &format!(
            "  {name:26}{:>10}{:>11}",
            counts(*fitted),
            counts(*held_out)
        );
        let bar = bar(shown, most);
        if !bar.is_empty() {
            out += &format!("   {}", painted(GOOD, bar));
        }
        out.push('\n');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_as_wide_as_asked_and_as_high_as_the_error() {
        for (samples, wide) in [(1, 1), (10, 10), (1000, 50), (1001, 48), (0, 0)] {
            let errors = vec![FLOOR_RMS_COUNTS; samples];
            let line = sparkline(&errors, 100.0, 50);
            assert_eq!(line.chars().count(), wide, "{samples}");
            assert!(line.chars().all(|c| c == HEIGHTS[0]));
        }
        let rising: Vec<f64> = (0..800).map(|k| 0.3 * 1.01f64.powi(k)).collect();
        let line: Vec<char> = sparkline(&rising, rising[799], 8).chars().collect();
        assert!(line.is_sorted() && line[0] < HEIGHTS[2] && line[7] == HEIGHTS[7]);
    }
}
