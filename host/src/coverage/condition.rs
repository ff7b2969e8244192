//! Drives and encoders, and the recordings of random motors under them.

use crate::error::Error;
use crate::prove::{Draws, Motor, draw_hidden};
use servoid_engine::problem::Data;
use servoid_identify::fit::{EXPLAINED_COUNTS, Options};
use servoid_identify::{Silent, identify_data, truth};
use servoid_io::excitation;
use servoid_io::input::Known;
use servoid_io::record::Record;
use servoid_plant::{Bench, Hidden, Machine};
use shared::effects::{Kind, Pair};
use shared::motor::Response;
use shared::units::Quantity;

/// Sample interval, s.
const INTERVAL_S: f64 = 1e-3;
/// Part of the supply.
const AMPLITUDE: f64 = 0.8;
/// Noise of the current sensor, standard deviation, as a part of the stall current.
const CURRENT_NOISE: f64 = 0.002;
/// Encoders, counts per revolution.
const ENCODERS: [u32; 2] = [2000, 200];

/// Drives, with their lengths, s.
const DRIVES: [(&str, f64); 4] = [
    ("commissioning", 20.0),
    ("commissioning", 3.0),
    ("step", 10.0),
    ("triangle", 10.0),
];

/// A drive and an encoder.
pub struct Condition {
    /// `commissioning`, or the name of a shape.
    pub excitation: &'static str,
    /// Length, s.
    pub seconds: f64,
    /// Encoder counts per revolution.
    pub counts_per_rev: u32,
    /// The effect that is hidden, and fitted.
    pub effect: Option<Kind>,
}

/// The error of one parameter in its standard errors.
pub struct Standardised {
    /// The parameter.
    pub name: String,
    /// Estimate less truth over the standard error; `None` where the fit states none.
    pub z: Option<f64>,
}

impl Condition {
    /// Every drive with every encoder, of a linear motor.
    pub fn linear() -> Vec<Condition> {
        let with = |counts_per_rev| {
            DRIVES.map(|(excitation, seconds)| Condition {
                excitation,
                seconds,
                counts_per_rev,
                effect: None,
            })
        };
        ENCODERS.into_iter().flat_map(with).collect()
    }

    /// The first drive and encoder, with an effect of random size that is fitted as well.
    pub fn with_effect(kind: Kind) -> Condition {
        let (excitation, seconds) = DRIVES[0];
        Condition {
            excitation,
            seconds,
            counts_per_rev: ENCODERS[0],
            effect: Some(kind),
        }
    }

    /// Records motor `number` of the seed and fits it. `None` where it cannot be recorded or fitted.
    ///
    /// # Errors
    /// None, as long as the catalogues agree with each other.
    pub fn errors(&self, seed: u64, number: u64) -> Result<Option<Vec<Standardised>>, Error> {
        let mut draws = Draws::of(&[seed, number]);
        let machine = Motor::draw(&mut draws)?.machine;
        let hidden = match self.effect {
            Some(kind) => Some(draw_hidden(kind.name(), &machine, &mut draws)?),
            None => None,
        };
        let Some(data) = self.record(machine, hidden.clone(), draws.seed()) else {
            return Ok(None);
        };
        let known = Known {
            kt_equals_kb: true,
            ..Known::default()
        };
        let options = Options {
            effects: self.effect.into_iter().collect(),
            known,
            ..Options::default()
        };
        let Ok(fit) = identify_data(&data, None, &options, &Silent::default()) else {
            return Ok(None);
        };
        let truth: Vec<(String, f64)> = match (self.effect, hidden) {
            (Some(kind), Some(hidden)) => {
                own_truth(kind, &hidden.truth(&machine, self.counts_per_rev))
            }
            _ => truth(&machine)
                .map(|(name, value)| (name.to_owned(), value))
                .into(),
        };
        // A torque is the volts that the winding spends on it, until the facts tell N·m.
        let in_unit = |value: f64, unit: &str| match unit {
            "N*m" => value / machine.winding_volts(1.0),
            _ => value,
        };
        // Far from the encoder's floor another valley was found, which no standard error is about.
        let explained = fit.rms_counts < EXPLAINED_COUNTS;
        let error = |(name, truth): (String, f64)| {
            let parameter = fit.parameters.iter().find(|p| p.name == name);
            let z = parameter.and_then(|p| Some((p.value - in_unit(truth, p.unit)) / p.std?));
            let z = z.filter(|z| explained && z.is_finite());
            Standardised { name, z }
        };
        Ok(Some(truth.into_iter().map(error).collect()))
    }

    fn record(&self, machine: Machine, hidden: Option<Hidden>, seed: u64) -> Option<Data> {
        let mut bench = Bench::new(machine);
        bench.effects = hidden.into_iter().collect();
        bench.counts_per_rev = self.counts_per_rev;
        bench.sample_s = INTERVAL_S;
        bench.seed = seed;
        bench.current_noise_a = CURRENT_NOISE * machine.stall_current_a();
        let usual = excitation::named(self.excitation)?;
        let plan = excitation::stretched(&usual, self.seconds, AMPLITUDE);
        let drive = excitation::drive(&plan, INTERVAL_S, seed, machine.supply_v);
        let recording = bench.record(&drive, self.excitation, true).ok()?;
        Data::new(&recording).ok()
    }
}

/// Sizes and shapes of an effect in the model's terms, and of the machine what an effect takes nothing of. A whole number has no
/// error, and of a pair that shares its common part with the machine no part has one.
fn own_truth(kind: Kind, values: &[f64]) -> Vec<(String, f64)> {
    if kind.facts().pair == Some(Pair::Difference) {
        return Vec::new();
    }
    let parameters = kind.parameters().iter().zip(values);
    parameters
        .filter(|(parameter, _)| !parameter.form && parameter.quantity != Quantity::PerRev)
        .map(|(parameter, &value)| (format!("{}.{}", kind.name(), parameter.name), value))
        .collect()
}

/// What a fit of the linear motor states, of the bench's machine: what voltage and angle determine, and what the current shows
/// where Kt = Kb.
fn truth(machine: &Machine) -> [(&'static str, f64); 8] {
    let physical = truth::physical(machine);
    let Response { gain, a1, a2 } = physical.machine().response();
    [
        ("gain", gain),
        ("a1", a1),
        ("electrical_time_constant", a2 / a1),
        ("resistance", physical.resistance),
        ("inductance", physical.inductance),
        ("kt", physical.kt),
        ("inertia", physical.inertia),
        ("viscous", physical.viscous),
    ]
}
