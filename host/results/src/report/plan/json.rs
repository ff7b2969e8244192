//! A plan as JSON.

use super::Plan;
use serde::Serialize;
use servoid_identify::plan::{Hypothesis, Ranked, SEPARABLE_COUNTS, Separation};

/// `servoid.plan/1`.
#[derive(Debug, Serialize)]
pub struct PlanJson {
    schema: &'static str,
    separable: bool,
    separation_counts: f64,
    threshold_counts: f64,
    hypotheses: Vec<HypothesisJson>,
    candidates: Vec<CandidateJson>,
    plan: Option<String>,
    samples: usize,
    sample_s: f64,
    reason: Option<String>,
    advice: Vec<String>,
    seed: u64,
    version: &'static str,
}

#[derive(Debug, Serialize)]
struct HypothesisJson {
    effects: Vec<&'static str>,
    parameters: Vec<ParameterJson>,
}

#[derive(Debug, Serialize)]
struct ParameterJson {
    name: String,
    value: f64,
    unit: &'static str,
}

#[derive(Debug, Serialize)]
struct CandidateJson {
    excitation: String,
    separation_counts: f64,
    pairs: Vec<PairJson>,
    coasts: bool,
    peak_voltage_v: f64,
    peak_current_a: Option<f64>,
    peak_current_of_stall: f64,
    travel_rev: f64,
    peak_speed_rad_s: f64,
}

#[derive(Debug, Serialize)]
struct PairJson {
    truth: String,
    fitted: String,
    counts: f64,
}

impl Plan<'_> {
    fn candidate(&self, ranked: &Ranked) -> CandidateJson {
        let usage = &ranked.usage;
        let pair = |pair: &Separation| PairJson {
            truth: self.hypothesis(pair.truth).name(),
            fitted: self.hypothesis(pair.fitted).name(),
            counts: pair.counts,
        };
        CandidateJson {
            excitation: ranked.excitation.to_string(),
            separation_counts: ranked.least(),
            pairs: ranked.separations.iter().map(pair).collect(),
            coasts: ranked.excitation.coasts(),
            peak_voltage_v: usage.voltage_v,
            peak_current_a: self.resistance_ohm.map(|ohm| usage.current_v / ohm),
            peak_current_of_stall: usage.current_v / self.work.setup.supply_v,
            travel_rev: usage.travel_rev,
            peak_speed_rad_s: usage.speed_rad_s,
        }
    }

    /// As JSON.
    pub fn json(&self) -> PlanJson {
        PlanJson {
            schema: "servoid.plan/1",
            separable: self.separable(),
            separation_counts: self.best().least(),
            threshold_counts: SEPARABLE_COUNTS,
            hypotheses: self.work.hypotheses.iter().map(hypothesis).collect(),
            candidates: self.ranked.iter().map(|r| self.candidate(r)).collect(),
            plan: self.separable().then(|| self.out.display().to_string()),
            samples: self.samples(),
            sample_s: self.work.setup.sample_s,
            reason: self.reason(),
            advice: self.advice(),
            seed: self.work.seed,
            version: env!("CARGO_PKG_VERSION"),
        }
    }
}

fn hypothesis(hypothesis: &Hypothesis) -> HypothesisJson {
    let named = hypothesis.effects.iter().flat_map(|kind| {
        let parameters = kind.description().parameters.iter();
        parameters.map(|p| (format!("{}.{}", kind.name(), p.name), p.quantity.unit()))
    });
    HypothesisJson {
        effects: hypothesis.effects.iter().map(|kind| kind.name()).collect(),
        parameters: named
            .zip(&hypothesis.values)
            .map(|((name, unit), &value)| ParameterJson { name, value, unit })
            .collect(),
    }
}
