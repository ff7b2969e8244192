//! The table of coverage as text.

use crate::prove::report::folded;
use servoid_results::plot::{ReliabilityLine, Statement};
use servoid_results::schema::coverage::{Condition, Coverage, Covered};
use statrs::distribution::{ContinuousCDF, Normal};

/// What a drawing of the intervals shows.
pub const AXES: [&str; 2] = [
    "level of the stated interval",
    "part of the intervals that hold the truth",
];

/// Levels that are drawn.
const LEVELS: [f64; 10] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95];

/// The intervals of all parameters of each condition as a drawing has them.
pub fn lines(coverage: &Coverage) -> Vec<ReliabilityLine> {
    let normal = Normal::standard();
    let line = |condition: &Condition| {
        let z: Vec<f64> = (condition.parameters.iter())
            .flat_map(|covered| covered.z.iter().copied())
            .collect();
        let held = |level: f64| {
            let width = normal.inverse_cdf(0.5 + 0.5 * level);
            let inside = z.iter().filter(|z| z.abs() <= width).count();
            inside as f64 / z.len() as f64
        };
        let points = LEVELS.map(|level| Statement {
            stated: level,
            found: held(level),
            interval: None,
        });
        ReliabilityLine {
            name: title(condition).replace('\n', ""),
            points: if z.is_empty() {
                Vec::new()
            } else {
                points.to_vec()
            },
        }
    };
    coverage.conditions.iter().map(line).collect()
}

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
    let mut out = format!(
        "\n{}\n  {:28}{:>6}{:>6}   {:11}{:>7}{:>7}{:>8}\n",
        title(condition),
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

/// Drive and encoder, and what stands beside them.
fn title(condition: &Condition) -> String {
    let effect = condition.effect.as_ref();
    let effect = effect.map_or_else(String::new, |name| format!(", with {name}"));
    format!(
        "{}, {} s, {} counts a revolution{effect}{}",
        condition.excitation,
        condition.seconds,
        condition.counts_per_rev,
        disturbed(condition)
    )
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
