//! What each hidden effect was called.

use super::Outcome;
use super::interval::Count;
use servoid_plant::effects::CATALOGUE;
use servoid_results::schema::proof::Confusion;
use std::collections::BTreeMap;

/// What is said of a case in which no effect is named.
pub const NOTHING: &str = "nothing";

/// The table over `outcomes`, the effect that fares worst first.
pub fn confusions(outcomes: &[Outcome]) -> Vec<Confusion> {
    let mut rows: Vec<Confusion> = CATALOGUE
        .iter()
        .map(|kind| confusion(kind.name, outcomes))
        .filter(|row| row.alone + row.paired > 0)
        .collect();
    rows.sort_by(|a, b| part(a).total_cmp(&part(b)));
    rows
}

fn confusion(effect: &'static str, outcomes: &[Outcome]) -> Confusion {
    let hiding = |many: usize| -> Vec<&Outcome> {
        let cases = outcomes.iter().filter(|outcome| outcome.detectable);
        cases
            .filter(|outcome| outcome.drawn.hidden.len() == many)
            .filter(|outcome| outcome.drawn.names().contains(&effect))
            .collect()
    };
    let (alone, paired) = (hiding(1), hiding(2));
    let named = |outcome: &Outcome| outcome.named.iter().any(|naming| naming.effect == effect);
    let mut called: BTreeMap<&str, u64> = BTreeMap::new();
    for outcome in alone.iter().filter(|outcome| !outcome.right_first()) {
        *called
            .entry(outcome.first().unwrap_or(NOTHING))
            .or_default() += 1;
    }
    let mut called: Vec<(String, u64)> = called
        .into_iter()
        .map(|(name, count)| (name.to_owned(), count))
        .collect();
    called.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let missed = alone
        .iter()
        .chain(&paired)
        .filter(|outcome| !named(outcome));
    Confusion {
        effect: effect.to_owned(),
        alone: alone.len() as u64,
        right: Count::of(alone.iter().copied(), Outcome::right_first).hits,
        in_set: Count::of(alone.iter().copied(), Outcome::right_in_set).hits,
        called,
        paired: paired.len() as u64,
        paired_named: Count::of(paired.iter().copied(), |outcome| named(outcome)).hits,
        missed_cases: missed.map(|outcome| outcome.case).collect(),
    }
}

/// Part of the cases in which it is named.
fn part(row: &Confusion) -> f64 {
    (row.right + row.paired_named) as f64 / (row.alone + row.paired).max(1) as f64
}
