//! Where a model fails, as tables.

use crate::report::fold::folded;
use servoid_identify::diagnose::evidence::plain;
use servoid_identify::residual_analysis::whiteness::{AUTOCORRELATION_LIMIT, INPUT_LIMIT};
use servoid_identify::residual_analysis::{Against, Map, ResidualAnalysis, Whiteness};

/// Half the width of a bar, characters.
const HALF: usize = 12;

/// The shares of all quantities, and the table of the `wanted` one, or of that which explains most.
pub(super) fn table(
    found: &ResidualAnalysis,
    wanted: Option<Against>,
    symbol: &'static str,
) -> String {
    let mut out = format!(
        "   missing along the measured motion: {} {symbol} RMS\n   (a perfect model would show {} {symbol} here)\n",
        plain(found.volts_rms),
        plain(found.perfect_volts_rms)
    );
    let Some(most) = found.most() else {
        return out + "   it depends on none of speed, voltage, current and time\n";
    };
    out += &(folded(&format!("   {}", explained(found)), "     ") + "\n");
    let own = wanted.and_then(|against| found.map(against));
    let most = own.filter(|map| map.beyond_chance).unwrap_or(most);
    let (name, unit) = (most.against.name().0, most.against.unit(symbol));
    out += &format!(
        "   {:>22}   {:>9}\n",
        format!("{}, {unit}", name.replace('_', " ")),
        format!("missing, {symbol}")
    );
    let sizes = most.bins.iter().map(|bin| bin.mean_v.abs());
    let largest = sizes.fold(f64::MIN_POSITIVE, f64::max);
    for bin in &most.bins {
        let length = (bin.mean_v.abs() / largest * HALF as f64).round() as usize;
        let bar = if bin.mean_v < 0.0 {
            format!("{:>HALF$}|", "#".repeat(length))
        } else {
            format!("{:HALF$}|{}", "", "#".repeat(length))
        };
        let line = format!(
            "   {:>9} .. {:>9}   {:>+9.4}  {bar}",
            short(bin.low),
            short(bin.high),
            bin.mean_v
        );
        out += line.trim_end();
        out.push('\n');
    }
    out
}

/// What depends on which quantity, each of what the ones before leave, so that the parts sum.
fn explained(found: &ResidualAnalysis) -> String {
    let mut maps: Vec<&Map> = (found.maps.iter())
        .filter(|map| map.beyond_chance && map.own_share >= LEAST)
        .collect();
    maps.sort_by_key(|map| map.against.turned());
    let parts: Vec<(&str, f64)> = (maps.iter())
        .map(|map| (map.against.name().0, 100.0 * map.own_share))
        .collect();
    let each: Vec<String> = (parts.iter())
        .map(|(name, percent)| format!("{} {percent:.0} %", name.replace('_', " ")))
        .collect();
    // The sum of what is printed.
    let sum: f64 = parts.iter().map(|(_, percent)| percent.round()).sum();
    match each.len() {
        0 => "none of these explains a noticeable part of it".to_owned(),
        1 => format!("explained: {}", each.concat()),
        _ => format!(
            "explained, each of what the ones before leave: {}; together {sum:.0} %",
            each.join(", ")
        ),
    }
}

/// Smaller parts are not told.
const LEAST: f64 = 0.005;

/// Three digits, with the sign of a negative number.
fn short(x: f64) -> String {
    let sign = if x < 0.0 { "-" } else { "" };
    format!("{sign}{}", plain(x.abs()))
}

/// One line on what is left of an error.
pub(super) fn whiteness_text(found: Option<&Whiteness>) -> String {
    match found {
        None => {
            "the motor moved too little to tell whether its error is the encoder's alone".to_owned()
        }
        Some(found) if found.is_white() => format!(
            "what is left is correlated neither in time (mean autocorrelation {:.2}, limit {AUTOCORRELATION_LIMIT}) nor \
             with the command ({:.1} standard deviations, limit {INPUT_LIMIT})",
            found.autocorrelation, found.input
        ),
        Some(found) => format!(
            "what is left is no noise: mean autocorrelation {:.2} (limit {AUTOCORRELATION_LIMIT}), correlation with \
             the command {:.1} standard deviations (limit {INPUT_LIMIT})",
            found.autocorrelation, found.input
        ),
    }
}
