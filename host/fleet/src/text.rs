//! A fleet and a population as the command line prints them.

use crate::population::{Member, Population};
use crate::summary::Summary;
use servoid_results::number_text::short;
use std::collections::BTreeMap;

/// Odd units that are printed.
const SHOWN: usize = 12;
/// p-values below this are said.
pub(crate) const SAID: f64 = 0.01;

/// `servoid fleet`.
pub fn summary_text(found: &Summary) -> String {
    let mut text = lead(found).join("\n") + "\n";
    text += "\nparameters of the recordings (median, and what 95 of 100 lie between)\n";
    for quantity in &found.quantities {
        text += &format!(
            "  {:<28} {:>10} {:<9} {} .. {}\n",
            quantity.name,
            short(quantity.median),
            unit(&quantity.unit),
            short(quantity.low),
            short(quantity.high)
        );
    }
    if !found.odd.is_empty() {
        text += "\nodd\n";
        for odd in found.odd.iter().take(SHOWN) {
            let first = odd.reasons.first().map_or("", |reason| &reason.text);
            text += &format!("  {}: {first}\n", odd.unit);
        }
        if let Some(more) = found.odd.len().checked_sub(SHOWN).filter(|more| *more > 0) {
            text += &format!("  and {more} more: --json FILE or --report FILE has all\n");
        }
    }
    let said = findings(found);
    if !said.is_empty() {
        text += "\nlots, stations and time\n";
        for line in said {
            text += &format!("  {line}\n");
        }
    }
    if !found.gauges.is_empty() {
        text += "\nrepeatability and reproducibility (part of all that recordings differ by)\n";
        for gauge in &found.gauges {
            text += &format!(
                "  {:<28} {:.1} % of {} motors\n",
                gauge.quantity, gauge.percent, gauge.motors
            );
        }
    }
    for cause in &found.refused {
        text += &format!(
            "\n{} recordings gave an error ({}), as {}: {}\n",
            cause.recordings, cause.cause, cause.example, cause.message
        );
    }
    text
}

/// What it comes to, in sentences.
pub(crate) fn lead(found: &Summary) -> Vec<String> {
    let refused: usize = found.refused.iter().map(|cause| cause.recordings).sum();
    let of_motors = if found.motors == found.recordings {
        String::new()
    } else {
        format!(" of {} motors", found.motors)
    };
    let mut lead = vec![format!(
        "{} recordings{of_motors} have a result, {refused} have none; {} are not like the others.",
        found.recordings,
        found.odd.len()
    )];
    if let Some(most) = found.effects.first() {
        lead.push(format!(
            "{} of {} recordings show {}.",
            most.recordings,
            found.recordings,
            effects(&most.effects)
        ));
    }
    if found.other_rows > 0 {
        lead.push(format!(
            "{} rows of the folder are of another task or version, and do not count.",
            found.other_rows
        ));
    }
    if found.unused_labels > 0 {
        lead.push(format!(
            "{} labels are of no recording of the folder.",
            found.unused_labels
        ));
    }
    lead
}

/// Effects in words.
pub(crate) fn effects(effects: &[String]) -> String {
    if effects.is_empty() {
        "a linear motor".to_owned()
    } else {
        effects.join(", ")
    }
}

/// What differs between lots and stations and what drifts, as sentences.
pub(crate) fn findings(found: &Summary) -> Vec<String> {
    let mut said = Vec::new();
    for (what, differences) in [
        ("lot", &found.lot_differences),
        ("station", &found.station_differences),
    ] {
        for one in differences.iter().filter(|one| one.p_value < SAID) {
            said.push(format!(
                "{what} {}: {} is {} the mean of all by {} {} (p = {})",
                one.farthest,
                one.quantity,
                if one.by > 0.0 { "above" } else { "below" },
                short(one.by.abs()),
                one.by_unit,
                short(one.p_value)
            ));
        }
    }
    for drift in found.drifts.iter().filter(|drift| drift.p_value < SAID) {
        let station = match drift.station.as_str() {
            "" => String::new(),
            station => format!("station {station}: "),
        };
        said.push(format!(
            "{station}{} has {} by {} {} in {} days (p = {})",
            drift.quantity,
            if drift.change > 0.0 {
                "risen"
            } else {
                "fallen"
            },
            short(drift.change.abs()),
            drift.change_unit,
            short(drift.days),
            short(drift.p_value)
        ));
    }
    said
}

/// `servoid population`.
pub fn population_text(found: &Population) -> String {
    let mut text = format!(
        "{} motors ({} recordings) with {}; {} odd recordings and {} with other effects are left out\n",
        found.motors,
        found.recordings,
        effects(&found.effects),
        found.odd,
        found.other_effects
    );
    text += &format!(
        "{:<28} {:>10} {:>23}  {:>10} {:>23}\n",
        "", "mean", "95 %", "std", "95 %"
    );
    for member in &found.parameters {
        let Member { mean, std, .. } = member;
        text += &format!(
            "{:<28} {:>10} {:>10} .. {:>9}  {:>10} {:>10} .. {:>9} {}\n",
            member.name,
            short(mean.value),
            short(mean.low),
            short(mean.high),
            short(std.value),
            short(std.low),
            short(std.high),
            unit(&member.unit)
        );
    }
    for fixed in &found.fixed {
        text += &format!(
            "{:<28} {:>10} in all motors {}\n",
            fixed.name,
            short(fixed.value),
            unit(&fixed.unit)
        );
    }
    for equal in &found.equal {
        text += &format!("{:<28} equals {}\n", equal.name, equal.to);
    }
    let strong = strong(found);
    if !strong.is_empty() {
        text += "correlations\n";
        for (pair, r) in strong {
            text += &format!("  {pair:<50} {r:.2}\n");
        }
    }
    text
}

/// The pairs that go together most, and their correlations.
fn strong(found: &Population) -> Vec<(String, f64)> {
    let mut pairs: BTreeMap<(usize, usize), f64> = BTreeMap::new();
    for (j, row) in found.correlation.iter().enumerate() {
        for (k, r) in row.iter().enumerate().take(j) {
            let bounded = &found.covariance[j][k];
            if bounded.low > 0.0 || bounded.high < 0.0 {
                pairs.insert((j, k), *r);
            }
        }
    }
    let name = |k: usize| found.parameters[k].name.as_str();
    let mut pairs: Vec<(String, f64)> = pairs
        .into_iter()
        .map(|((j, k), r)| (format!("{} and {}", name(k), name(j)), r))
        .collect();
    pairs.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    pairs
}

fn unit(unit: &str) -> &str {
    if unit == "1" { "" } else { unit }
}
