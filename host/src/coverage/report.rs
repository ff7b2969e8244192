//! The table of coverage as text.

use crate::prove::report::folded;
use servoid_results::schema::coverage::{Condition, Coverage, Covered};

/// The table.
pub fn text(coverage: &Coverage) -> String {
    let title = format!(
        "{} recordings of random motors, seed {}: how often the stated intervals hold the truth",
        coverage.recordings, coverage.seed
    );
    let mut out = folded(&title, "");
    if coverage.failures > 0 {
        out += &format!("{} could not be recorded or fitted\n", coverage.failures);
    }
    for condition in &coverage.conditions {
        out += &rows(condition);
    }
    out += "\n";
    out + &folded(
        "right are 68 % within one standard error, 95 % within 1.96 (in brackets what so few recordings can say), and errors \
         in standard errors with mean 0 and deviation 1",
        "",
    )
}

fn rows(condition: &Condition) -> String {
    let effect = condition.effect.as_ref();
    let effect = effect.map_or_else(String::new, |name| format!(", with {name}"));
    let disturbed = disturbed(condition);
    let mut out = format!(
        "\n{}, {} s, {} counts a revolution{effect}{disturbed}\n  {:28}{:>6}{:>6}   {:11}{:>7}{:>7}{:>8}\n",
        condition.excitation,
        condition.seconds,
        condition.counts_per_rev,
        "",
        "68 %",
        "95 %",
        "",
        "mean",
        "sd",
        "none",
    );
    for covered in &condition.parameters {
        out += &row(covered);
    }
    out
}

/// What stands beside drive and encoder.
fn disturbed(condition: &Condition) -> String {
    let mut out = String::new();
    if let Some(noise) = condition.angle_noise_counts {
        out += &format!(", noise {noise} counts");
    }
    if let Some(part) = condition.torque_noise {
        out += &format!(",\n  torque noise of {} % of stall", 100.0 * part);
    }
    if condition.closed_loop {
        out += " in a position loop";
    }
    out
}

fn row(covered: &Covered) -> String {
    let percent = |part: f64| format!("{:.0}", 100.0 * part);
    let number = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.2}"));
    let part = |rate: Option<f64>| rate.map_or("-".to_owned(), percent);
    let (one, two) = (covered.within_1.rate, covered.within_2.rate);
    let interval = two.map_or(String::new(), |rate| {
        format!("({}-{})", percent(rate.low), percent(rate.high))
    });
    format!(
        "  {:28}{:>6}{:>6}   {interval:11}{:>7}{:>7}{:>8}\n",
        covered.name,
        part(one.map(|rate| rate.part)),
        part(two.map(|rate| rate.part)),
        number(covered.z_mean),
        number(covered.z_sd),
        covered.not_stated,
    )
}
