//! A plan as the document that is written.

use super::Plan;
use crate::schema::plan::{Candidate, Hypothesis, Pair};
use crate::schema::{self, VERSION, finite};
use servoid_identify::plan::{Ranked, SEPARABLE_COUNTS, Separation};

impl Plan<'_> {
    fn candidate(&self, ranked: &Ranked) -> Candidate {
        let usage = &ranked.usage;
        let pair = |pair: &Separation| Pair {
            truth: self.hypothesis(pair.truth).name(),
            fitted: self.hypothesis(pair.fitted).name(),
            counts: finite(pair.counts),
        };
        Candidate {
            excitation: ranked.excitation.to_string(),
            separation_counts: finite(ranked.least()),
            pairs: ranked.separations.iter().map(pair).collect(),
            coasts: ranked.excitation.coasts(),
            peak_voltage_v: usage.voltage_v,
            peak_current_a: self.resistance_ohm.map(|ohm| usage.current_v / ohm),
            peak_current_of_stall: usage.current_v / self.work.setup.supply_v,
            travel_rev: usage.travel_rev,
            peak_speed_rad_s: usage.speed_rad_s,
        }
    }

    /// As the document that is written.
    pub fn document(&self) -> schema::Plan {
        let hypotheses = self.work.hypotheses.iter();
        schema::Plan {
            schema: "servoid.plan/1".to_owned(),
            separable: self.separable(),
            separation_counts: finite(self.best().least()),
            threshold_counts: SEPARABLE_COUNTS,
            hypotheses: hypotheses.map(Hypothesis::from).collect(),
            candidates: self.ranked.iter().map(|r| self.candidate(r)).collect(),
            plan: self.separable().then(|| self.out.display().to_string()),
            samples: self.samples(),
            sample_s: self.work.setup.sample_s,
            reason: self.reason(),
            advice: self.advice(),
            seed: self.work.seed,
            version: VERSION.to_owned(),
        }
    }
}
