//! A plan as text, as a document, and as the comments above its commands.

mod document;
mod text;

use servoid_identify::plan::{
    Hypothesis, Limits, PlanTask, Ranked, SEPARABLE_COUNTS, Usage, remedy, why,
};
use std::path::Path;

/// Below this the separation is told with a doubt: the refit of an effect with a knee may miss a minimum
/// that leaves less, by a few counts in what was tried.
const SURE_COUNTS: f64 = 10.0;

/// What `simulate --plan` found.
pub struct Plan<'a> {
    /// The best candidates, best first; never empty.
    pub ranked: Vec<Ranked>,
    /// What it was asked.
    pub work: &'a PlanTask<'a>,
    /// Armature resistance, Ω, where the user told it.
    pub resistance_ohm: Option<f64>,
    /// Where the commands go.
    pub out: &'a Path,
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
        if self.separable() && self.best().least() < SURE_COUNTS {
            advice.push(format!(
                "{:.1} counts are an upper bound that is not far from the threshold: a refit that finds a better \
                 minimum may leave less; more voltage, travel or time would make surer",
                self.best().least()
            ));
        }
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

    fn samples(&self) -> usize {
        let best = self.best();
        best.excitation
            .drive(self.work.setup.sample_s, self.work.seed)
            .len()
    }
}
