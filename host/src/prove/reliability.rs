//! Whether the probabilities of sets of effects are as often right as they say.

use super::Outcome;
use super::interval::Count;
use servoid_results::schema::diagnosis::Hypothesis;
use servoid_results::schema::proof::{Bin, Reliability};
use std::collections::BTreeSet;

/// Bins of the probabilities, of equal width.
const BINS: usize = 5;

/// A probability that was stated, and whether what it was stated of is true.
#[derive(Clone, Copy)]
struct Statement {
    probability: f64,
    is_true: bool,
}

/// Over all sets that diagnoses of these cases hold for possible; the Brier score is that of the most probable ones (G. W. Brier,
/// *Monthly Weather Review* 78, 1, 1950). `None` where no diagnosis has any.
pub fn reliability<'a>(outcomes: impl Iterator<Item = &'a Outcome>) -> Option<Reliability> {
    let outcomes: Vec<&Outcome> = outcomes.filter(|o| o.failure.is_none()).collect();
    let all: Vec<Statement> = outcomes.iter().flat_map(|o| statements(o)).collect();
    let first: Vec<Statement> = outcomes
        .iter()
        .filter_map(|o| statements(o).next())
        .collect();
    if first.is_empty() {
        return None;
    }
    let error = |s: &Statement| (s.probability - f64::from(u8::from(s.is_true))).powi(2);
    let bin = |k: usize| {
        let (low, high) = (k as f64 / BINS as f64, (k + 1) as f64 / BINS as f64);
        let last = k + 1 == BINS;
        let within = |p: f64| p >= low && (p < high || last);
        let own: Vec<Statement> = (all.iter().copied())
            .filter(|s| within(s.probability))
            .collect();
        let sum: f64 = own.iter().map(|s| s.probability).sum();
        (!own.is_empty()).then(|| Bin {
            low,
            high,
            probability: sum / own.len() as f64,
            right: Count::of(&own, |s| s.is_true).share("right"),
        })
    };
    Some(Reliability {
        brier: first.iter().map(error).sum::<f64>() / first.len() as f64,
        diagnoses: first.len() as u64,
        bins: (0..BINS).filter_map(bin).collect(),
    })
}

/// What one diagnosis says, the most probable first.
fn statements(outcome: &Outcome) -> impl Iterator<Item = Statement> {
    let truth: BTreeSet<&str> = outcome.drawn.names().into_iter().collect();
    let statement = move |hypothesis: &Hypothesis| {
        let set: BTreeSet<&str> = hypothesis.effects.iter().map(String::as_str).collect();
        Statement {
            probability: hypothesis.probability,
            is_true: set == truth,
        }
    };
    outcome.hypotheses.iter().map(statement)
}
