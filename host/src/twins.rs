//! Twins of a motor that was identified: motors of the virtual bench with its constants and its effects, driven by its own commands and read
//! by its own encoder. What a diagnosis names of them says how far its name for the motor can be trusted.

use crate::error::Error;
use servoid_engine::problem::{Candidate, Data};
use servoid_identify::fit::Options;
use servoid_identify::{Progress, diagnose, truth};
use servoid_io::record::Record;
use servoid_io::recording::Recording;
use servoid_plant::{Amplifier, Bench, DriveSample, Hidden, Machine};
use shared::effects::Kind;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::atomic::Ordering;

/// Least electrical time constant that the bench integrates, s.
const FASTEST_WINDING_S: f64 = 2e-5;

/// What was named in twins.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Found {
    /// Twins that were diagnosed.
    pub tried: usize,
    /// Those in which just the motor's own effects were named.
    pub same: usize,
    /// What was named in the others, and how often; nothing named is `none`.
    pub others: BTreeMap<String, usize>,
}

/// A motor like one that was identified, on the virtual bench.
#[derive(Clone)]
pub struct Twin {
    bench: Bench,
    effects: Vec<Kind>,
    fitted: Vec<DriveSample>,
    held_out: Option<Vec<DriveSample>>,
}

impl Twin {
    /// The twin of `model`, which is driven as in `fitted`, and once more as in `held_out` where that is a recording of its own.
    ///
    /// # Errors
    /// A model that cannot be put on the bench, in words.
    pub fn of(model: &Candidate, fitted: &Data, held_out: Option<&Data>) -> Result<Self, Error> {
        let counts_per_rev = fitted.units.counts_per_rev.round() as u32;
        let machine = machine(model, fitted.supply);
        let mut bench = Bench::new(machine);
        bench.counts_per_rev = counts_per_rev;
        bench.sample_s = fitted.units.interval;
        if !fitted.drive.is_voltage() {
            bench.amplifier = Amplifier::Current;
        }
        let mut effects = Vec::new();
        for (kind, values) in model.effects.iter() {
            let hidden = truth::hidden(kind, values, &machine, counts_per_rev);
            let hidden: Hidden = hidden.ok_or_else(|| {
                Error::Failed(format!(
                    "the virtual bench has no {} like the one that was fitted",
                    kind.name()
                ))
            })?;
            bench.effects.push(hidden);
            effects.push(kind);
        }
        if !truth::share_friction(&mut bench.effects, model) {
            return Err(Error::Failed(
                "the virtual bench has no other than Coulomb friction on a load".to_owned(),
            ));
        }
        effects.sort_unstable();
        Ok(Twin {
            bench,
            effects,
            fitted: commands(fitted),
            held_out: held_out.map(commands),
        })
    }

    /// Diagnoses as many twins, each at another angle of the shaft; `each` is told after each.
    ///
    /// # Errors
    /// A motion that the bench cannot run.
    pub fn diagnosed(
        &self,
        count: usize,
        seed: u64,
        progress: &dyn Progress,
        mut each: impl FnMut(&Found),
    ) -> Result<Found, Error> {
        let mut found = Found::default();
        for number in 0..count as u64 {
            let seed = seed + 2 * number;
            let fitted = self.recorded(&self.fitted, seed, "twin")?;
            let held_out = (self.held_out.as_ref())
                .map(|drive| self.recorded(drive, seed + 1, "twin, once more"))
                .transpose()?;
            let options = Options {
                seed,
                ..Options::default()
            };
            let diagnosed = diagnose(&fitted, held_out.as_ref(), &options, progress);
            if progress.stop().load(Ordering::Relaxed) {
                break;
            }
            let mut named: Vec<Kind> = match diagnosed {
                Ok(diagnosed) => {
                    let steps = diagnosed.diagnosis.steps.iter();
                    steps.map(|step| step.added).collect()
                }
                // What cannot be diagnosed is not named.
                Err(_) => Vec::new(),
            };
            named.sort_unstable();
            found.tried += 1;
            if named == self.effects {
                found.same += 1;
            } else {
                *found.others.entry(listed(&named)).or_default() += 1;
            }
            each(&found);
        }
        Ok(found)
    }

    fn recorded(&self, drive: &[DriveSample], seed: u64, name: &str) -> Result<Recording, Error> {
        let bench = Bench {
            seed,
            ..self.bench.clone()
        };
        Ok(bench.record(drive, name, false)?)
    }
}

fn listed(named: &[Kind]) -> String {
    if named.is_empty() {
        return "none".to_owned();
    }
    let names: Vec<&str> = named.iter().map(|kind| kind.name()).collect();
    names.join(" + ")
}

/// A machine that is the model's to its terminals. What these do not show is chosen: an ohm, and a torque constant equal to the back-EMF
/// constant.
fn machine(model: &Candidate, supply_v: f64) -> Machine {
    let own = &model.machine;
    Machine {
        supply_v,
        resistance_ohm: 1.0,
        inductance_h: own.electrical.max(FASTEST_WINDING_S),
        kt_n_m_a: own.kb,
        kb_v_s_rad: own.kb,
        inertia_kg_m2: own.inertia * own.kb,
        viscous_n_m_s: own.damping * own.kb,
    }
}

/// The commands of the first of the recordings.
fn commands(data: &Data) -> Vec<DriveSample> {
    let first: Range<usize> = data.recordings.ranges().next().unwrap_or(0..data.len());
    first
        .map(|k| DriveSample {
            volts: data.command[k] * data.units.volts,
            enabled: !data.is_open(k),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use servoid_identify::Silent;
    use servoid_io::showcase;

    #[test]
    fn twins_of_a_motor_with_an_effect_are_named_as_it() {
        let hidden = Hidden::typical("coulomb", &showcase::machine()).expect("an effect");
        let data = |seed| {
            let recording = showcase::record(std::slice::from_ref(&hidden), seed, "bench")
                .expect("a recording");
            Data::new(&recording).expect("data")
        };
        let model = truth::model(
            &showcase::machine(),
            std::slice::from_ref(&hidden),
            showcase::COUNTS_PER_REV,
        )
        .expect("a valid effect");
        let twin = Twin::of(&model, &data(1), Some(&data(2))).expect("a twin");
        let mut told = 0;
        let found = twin
            .diagnosed(2, 1, &Silent::default(), |_| told += 1)
            .expect("it runs");
        assert_eq!((found.tried, told), (2, 2));
        assert!(found.same >= 1, "{found:?}");
    }
}
