//! The paper's contest, run again: a 1 V step, a shaft angle read in whole degrees, six unknowns in
//! one box, GA against PSO against FA.
//!
//! The recording comes from the virtual bench, not from the model. "QU" compares the floored reading
//! with the unfloored model, as the paper's figures do; "QQ" floors both.

use super::table::PRINTED;
use crate::error::Error;
use crate::fit::regression;
use servoid_engine::problem::{Base, Data, FitProblem, Horizon, StartAngle, Structure};
use servoid_engine::simulation::Method;
use servoid_engine::solve::Solver;
use servoid_engine::solve::ga::Ga;
use servoid_engine::solve::swarm::{Fireflies, ParticleSwarm};
use servoid_io::record::Record;
use servoid_plant::{Bench, DriveSample, Machine};
use shared::cost::Cost;
use shared::discretise::Discretisation;

/// The paper's box of the six unknowns.
pub const BOX: (f64, f64) = (1e-4, 1.5);

/// The paper reads degrees.
const COUNTS_PER_REV: u32 = 360;
/// The paper's step, V.
const STEP_V: f64 = 1.0;

/// What is floored before angles are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantiser {
    /// The reading only: the truth costs half a degree throughout.
    Reading,
    /// Reading and model: the truth costs nothing.
    Both,
}

impl Quantiser {
    /// Both treatments.
    pub const ALL: [Quantiser; 2] = [Quantiser::Reading, Quantiser::Both];

    /// Short name.
    pub fn name(self) -> &'static str {
        match self {
            Quantiser::Reading => "QU",
            Quantiser::Both => "QQ",
        }
    }
}

/// One way to run the contest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variant {
    /// What is floored.
    pub quantiser: Quantiser,
    /// The model's step.
    pub discretisation: Discretisation,
}

impl Variant {
    /// All four; the first is the one that the paper's figures are compared with.
    pub fn all() -> impl Iterator<Item = Variant> {
        Quantiser::ALL.into_iter().flat_map(|quantiser| {
            [Discretisation::Exact, Discretisation::Euler].map(|discretisation| Variant {
                quantiser,
                discretisation,
            })
        })
    }

    /// Short name.
    pub fn name(self) -> String {
        let step = match self.discretisation {
            Discretisation::Exact => "exact",
            Discretisation::Euler => "euler",
        };
        format!("{} {step}", self.quantiser.name())
    }
}

/// The experiment: its length and its sample interval, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Experiment {
    /// Length, s.
    pub seconds: f64,
    /// Sample interval, s.
    pub sample_s: f64,
}

/// Largest number of samples.
const MOST_SAMPLES: f64 = 2e7;

impl Experiment {
    /// The step response of the paper's motor as the virtual bench gives it.
    ///
    /// # Errors
    /// [`Error::Usage`] for times that make no recording.
    pub fn record(self) -> Result<Data, Error> {
        let samples = (self.seconds / self.sample_s).round();
        if !(self.sample_s > 0.0 && (10.0..=MOST_SAMPLES).contains(&samples)) {
            return Err(Error::Usage(format!(
                "--seconds {} --sample {}: must give between 10 and {MOST_SAMPLES:e} samples",
                self.seconds, self.sample_s
            )));
        }
        let mut bench = Bench::new(Machine::paper());
        bench.counts_per_rev = COUNTS_PER_REV;
        bench.sample_s = self.sample_s;
        bench.start_angle_rad = Some(0.0);
        let step = DriveSample {
            volts: STEP_V,
            enabled: true,
        };
        let recording = bench.record(&vec![step; samples as usize], "the paper's step", false)?;
        Ok(Data::new(&recording)?)
    }
}

/// The paper's problem: six unknowns in a box.
pub fn paper_problem<'a>(data: &'a Data, variant: Variant, bounds: (f64, f64)) -> FitProblem<'a> {
    let centre = PRINTED[0].machine();
    let base = Base::Physical { range: bounds };
    problem(
        data,
        variant,
        Structure::around(data, base, &[], &centre, false),
        None,
    )
}

/// The same data in the three combinations that they determine, started from regression.
pub fn identifiable_problem<'a>(data: &'a Data, variant: Variant) -> Option<FitProblem<'a>> {
    let base = Base::Response { damping: false };
    let sketch = Structure::around(data, base, &[], &PRINTED[0].machine(), false);
    regression::guesses(data, &sketch)
        .into_iter()
        .map(|guess| {
            let structure = Structure::around(data, base, &[], &guess.machine, false);
            let start = structure.coordinates(&structure.values_of(&guess.machine, &[], 0.0));
            problem(data, variant, structure, Some(start))
        })
        .min_by(|a, b| {
            let cost = |p: &FitProblem<'_>| {
                use servoid_engine::solve::Objective;
                p.start.as_ref().map_or(f64::INFINITY, |x| p.cost(x))
            };
            cost(a).total_cmp(&cost(b))
        })
}

fn problem<'a>(
    data: &'a Data,
    variant: Variant,
    structure: Structure,
    start: Option<Vec<f64>>,
) -> FitProblem<'a> {
    FitProblem {
        data,
        structure,
        cost: Cost::Absolute {
            model_floored: variant.quantiser == Quantiser::Both,
        },
        weight: data.units.interval,
        horizon: Horizon::Whole,
        start_angle: StartAngle::Known,
        method: Method {
            discretisation: variant.discretisation,
            substeps: 1,
        },
        start,
    }
}

/// The paper's three methods with a population of their own size.
pub fn solvers(population: usize) -> Vec<Box<dyn Solver>> {
    vec![
        Box::new(Ga {
            population,
            ..Ga::default()
        }),
        Box::new(ParticleSwarm {
            population,
            ..ParticleSwarm::default()
        }),
        Box::new(Fireflies {
            population,
            ..Fireflies::default()
        }),
    ]
}
