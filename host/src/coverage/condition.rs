//! Drives and encoders, and the recordings of random motors under them.

use crate::error::Error;
use crate::prove::{Draws, Motor, draw_hidden};
use servoid_engine::problem::Data;
use servoid_identify::fit::{EXPLAINED_COUNTS, Options};
use servoid_identify::{Silent, identify_data, truth};
use servoid_io::excitation;
use servoid_io::input::Known;
use servoid_io::record::Record;
use servoid_plant::{Amplifier, Bench, Hidden, Machine, PositionControl};
use shared::cost::Cost;
use shared::effects::{Kind, Pair};
use shared::motor::Response;
use shared::units::Quantity;
use std::f64::consts::TAU;

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

/// Noise of the angle sensor where the likelihood of the cells is maximised, standard deviation, counts.
const ANGLE_NOISES: [f64; 4] = [0.01, 0.03, 0.1, 0.3];
/// Lengths of these recordings, s.
const NOISY_SECONDS: [f64; 2] = [20.0, 3.0];
/// Load torque that is another one in each sample interval, standard deviation, as a part of the stall torque.
const TORQUE_NOISE: f64 = 0.01;
/// Part of the supply that a revolution of position error asks for.
const LOOP_GAIN: f64 = 2.0;
/// Largest target of the position loop, revolutions.
const REACH: f64 = 2.0;

/// A drive and an encoder, and what disturbs them.
#[derive(Clone, Debug)]
pub struct Condition {
    /// `commissioning`, or the name of a shape.
    pub excitation: &'static str,
    /// Length, s.
    pub seconds: f64,
    /// Encoder counts per revolution.
    pub counts_per_rev: u32,
    /// The effect that is hidden, and fitted.
    pub effect: Option<Kind>,
    /// What is minimised.
    pub cost: Cost,
    /// Noise of the angle sensor, standard deviation, counts.
    pub angle_noise_counts: f64,
    /// Load torque of each sample interval, standard deviation, as a part of the stall torque.
    pub torque_noise: f64,
    /// Whether the drive sets the target of a position loop.
    pub closed_loop: bool,
}

/// The error of one parameter in its standard errors.
pub struct Standardised {
    /// The parameter.
    pub name: String,
    /// Estimate less truth over the standard error; `None` where the fit states none.
    pub z: Option<f64>,
}

impl Condition {
    fn plain((excitation, seconds): (&'static str, f64), counts_per_rev: u32) -> Condition {
        Condition {
            excitation,
            seconds,
            counts_per_rev,
            effect: None,
            cost: Cost::Squared,
            angle_noise_counts: 0.0,
            torque_noise: 0.0,
            closed_loop: false,
        }
    }

    /// Every drive with every encoder, of a linear motor; then one with a torque that fluctuates, under voltage and behind a
    /// position loop.
    pub fn linear() -> Vec<Condition> {
        let with = |counts| DRIVES.map(|drive| Condition::plain(drive, counts));
        let disturbed = [false, true].map(|closed_loop| Condition {
            torque_noise: TORQUE_NOISE,
            closed_loop,
            ..Condition::plain(DRIVES[0], ENCODERS[0])
        });
        let drives = ENCODERS.into_iter().flat_map(with);
        drives.chain(disturbed).collect()
    }

    /// The first drive and encoder, with an effect of random size that is fitted as well.
    pub fn with_effect(kind: Kind) -> Condition {
        Condition {
            effect: Some(kind),
            ..Condition::plain(DRIVES[0], ENCODERS[0])
        }
    }

    /// Angle sensors of several noises, fitted by the likelihood of the cells that were read.
    pub fn noisy(cost: Cost) -> Vec<Condition> {
        let (excitation, _) = DRIVES[0];
        let with = |seconds| {
            ANGLE_NOISES.map(|angle_noise_counts| Condition {
                cost,
                angle_noise_counts,
                ..Condition::plain((excitation, seconds), ENCODERS[0])
            })
        };
        NOISY_SECONDS.into_iter().flat_map(with).collect()
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
            cost: self.cost,
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
        let beyond = EXPLAINED_COUNTS.hypot(self.angle_noise_counts);
        let explained = self.torque_noise > 0.0 || fit.rms_counts < beyond;
        let error = |(name, truth): (String, f64)| {
            let parameter = fit.parameters.iter().find(|p| p.name == name);
            let z = parameter.and_then(|p| Some((p.value - in_unit(truth, p.unit)) / p.std?));
            let z = z.filter(|z| explained && z.is_finite());
            Standardised { name, z }
        };
        let noise = fit.reading_noise.map(|noise| Standardised {
            name: "noise before the counter".to_owned(),
            z: (noise.std).map(|std| (noise.counts - self.angle_noise_counts) / std),
        });
        Ok(Some(truth.into_iter().map(error).chain(noise).collect()))
    }

    fn record(&self, machine: Machine, hidden: Option<Hidden>, seed: u64) -> Option<Data> {
        let mut bench = Bench::new(machine);
        bench.effects = hidden.into_iter().collect();
        bench.counts_per_rev = self.counts_per_rev;
        bench.sample_s = INTERVAL_S;
        bench.seed = seed;
        bench.current_noise_a = CURRENT_NOISE * machine.stall_current_a();
        bench.angle_noise_counts = self.angle_noise_counts;
        bench.torque_noise_n_m = self.torque_noise * machine.stall_torque_n_m();
        let mut largest = machine.supply_v;
        if self.closed_loop {
            let gain = LOOP_GAIN * machine.supply_v / TAU;
            let control = PositionControl::proportional(gain, machine.supply_v);
            bench.amplifier = Amplifier::Position(control);
            largest = REACH * TAU;
        }
        let usual = excitation::named(self.excitation)?;
        let plan = excitation::stretched(&usual, self.seconds, AMPLITUDE);
        let drive = excitation::drive(&plan, INTERVAL_S, seed, largest);
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
        .filter(|(parameter, _)| parameter.form.is_none() && parameter.quantity != Quantity::PerRev)
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
