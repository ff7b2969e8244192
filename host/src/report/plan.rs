//! A plan as text, as JSON, and as the comments above its commands.

use crate::plan::{
    Hypothesis, Limits, Ranked, SEPARABLE_COUNTS, Separation, Usage, Work, remedy, why,
};
use serde::Serialize;
use std::path::Path;

/// What `simulate --plan` found.
pub struct Plan<'a> {
    /// The best candidates, best first; never empty.
    pub ranked: Vec<Ranked>,
    /// What it was asked.
    pub work: &'a Work<'a>,
    /// Armature resistance, Ω, where the user told it.
    pub resistance_ohm: Option<f64>,
    /// Where the commands go.
    pub out: &'a Path,
}

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
    /// The best candidate.
    pub fn best(&self) -> &Ranked {
        &self.ranked[0]
    }

    /// Whether the best candidate separates every pair.
    pub fn separable(&self) -> bool {
        self.best().least() >= SEPARABLE_COUNTS
    }

    fn hypothesis(&self, index: usize) -> &Hypothesis {
        &self.work.hypotheses[index]
    }

    fn names(&self) -> Vec<String> {
        self.work.hypotheses.iter().map(Hypothesis::name).collect()
    }

    /// Pairs that the best candidate leaves alike, each once.
    fn alike(&self) -> Vec<(usize, usize)> {
        let mut found = Vec::new();
        for pair in &self.best().separations {
            let both = (pair.truth.min(pair.fitted), pair.truth.max(pair.fitted));
            if pair.counts < SEPARABLE_COUNTS && !found.contains(&both) {
                found.push(both);
            }
        }
        found
    }

    /// What would separate the pairs that stay alike.
    fn advice(&self) -> Vec<String> {
        let wider = if self.work.limits == Limits::default() {
            ""
        } else {
            ", or wider limits"
        };
        let one = |&(a, b): &(usize, usize)| {
            let (a, b) = (self.hypothesis(a), self.hypothesis(b));
            format!(
                "{} and {} cannot be separated with voltage and angle within these limits; what would: {}{wider}",
                a.name(),
                b.name(),
                remedy(a, b)
            )
        };
        let mut advice: Vec<String> = self.alike().iter().map(one).collect();
        let hypotheses = self.work.hypotheses;
        for general in hypotheses {
            for special in hypotheses {
                if general != special && general.contains(special) {
                    advice.push(format!(
                        "{} can become {}: where the latter is true both explain everything, and the one with fewer \
                         parameters is to be taken",
                        general.name(),
                        special.name()
                    ));
                }
            }
        }
        advice
    }

    fn reason(&self) -> Option<String> {
        self.separable()
            .then(|| why(&self.best().excitation, self.work.hypotheses))
    }

    /// Comments above the commands.
    pub fn provenance(&self) -> Vec<String> {
        vec![
            format!(
                "made by servoid {} simulate --plan: separates {}, seed {}",
                env!("CARGO_PKG_VERSION"),
                self.names().join(", "),
                self.work.seed
            ),
            format!("excitation: {}", self.best().excitation),
            format!(
                "expected: {:.1} counts RMS at least if the wrong one is fitted; {}",
                self.best().least(),
                self.usage(&self.best().usage)
            ),
        ]
    }

    /// What an excitation asks for.
    fn usage(&self, usage: &Usage) -> String {
        let limits = &self.work.limits;
        let of = |limit: Option<f64>, unit: &str| {
            limit.map_or_else(String::new, |limit| format!(" of {limit} {unit}"))
        };
        let current = match self.resistance_ohm {
            Some(ohm) => format!(
                "{:.2} A{}",
                usage.current_v / ohm,
                of(limits.current_v.map(|volts| volts / ohm), "A")
            ),
            None => format!(
                "{:.0} % of the stall current",
                100.0 * usage.current_v / self.work.setup.supply_v
            ),
        };
        format!(
            "peak {:.2} V{}, about {current}, travel {:.2} rev{}, up to {:.0} rad/s",
            usage.voltage_v,
            of(limits.voltage_v, "V"),
            usage.travel_rev,
            of(limits.travel_rev, "rev"),
            usage.speed_rad_s
        )
    }

    fn pair(&self, pair: &Separation) -> String {
        format!(
            "     {} if {} is true: {:.2} counts left\n",
            self.hypothesis(pair.fitted).name(),
            self.hypothesis(pair.truth).name(),
            pair.counts
        )
    }

    /// As text for a terminal.
    pub fn text(&self) -> String {
        let mut text = format!(
            "to separate {}, RMS error left above the encoder's own when the wrong one is fitted:\n",
            self.names().join(", ")
        );
        for (place, ranked) in self.ranked.iter().enumerate() {
            text += &format!("  {}. {}\n", place + 1, ranked.excitation);
            for pair in &ranked.separations {
                text += &self.pair(pair);
            }
        }
        text += &format!("the best: {}\n", self.usage(&self.best().usage));
        if let Some(reason) = self.reason() {
            text += &format!("why: {reason}\n");
            text += &format!(
                "{}: {} commands, {:.3} s; record them and run `servoid diagnose` on the recording\n",
                self.out.display(),
                self.samples(),
                self.samples() as f64 * self.work.setup.sample_s
            );
        } else {
            text += &format!(
                "even the best leaves less than {SEPARABLE_COUNTS} count: nothing was written\n"
            );
        }
        for advice in self.advice() {
            text += &format!("{advice}\n");
        }
        text
    }

    fn samples(&self) -> usize {
        let best = self.best();
        best.excitation
            .drive(self.work.setup.sample_s, self.work.seed)
            .len()
    }

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
