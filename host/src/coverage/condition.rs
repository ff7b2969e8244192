//! Drives and encoders, and the recordings of random motors under them.

use crate::error::Error as Failure;
use crate::prove::{Draws, Motor};
use servoid_engine::problem::Data;
use servoid_identify::fit::Options;
use servoid_identify::{Silent, identify_data};
use servoid_io::input::Known;
use servoid_io::record::Record;
use servoid_plant::{Bench, DriveSample, Machine};
use shared::excite::{COMMISSIONING, Experiment, Shape, commands};

/// Sample interval, s.
const INTERVAL_S: f64 = 1e-3;
/// Part of the supply.
const AMPLITUDE: f64 = 0.8;
/// Noise of the current sensor, standard deviation, as a part of the stall current.
const CURRENT_NOISE: f64 = 0.002;
/// Encoders, counts per revolution.
const ENCODERS: [u32; 2] = [2000, 200];

/// A drive and an encoder.
pub struct Condition {
    /// `commissioning`, or the name of one of [`Shape::ALL`].
    pub excitation: &'static str,
    /// Length, s.
    pub seconds: f64,
    /// Encoder counts per revolution.
    pub counts_per_rev: u32,
}

/// The error of one parameter.
pub struct Error {
    /// The parameter.
    pub name: &'static str,
    /// In standard errors; `None` where the fit states none.
    pub z: Option<f64>,
}

impl Condition {
    /// All that are tried.
    pub fn all() -> Vec<Condition> {
        let drives = [
            ("commissioning", 20.0),
            ("commissioning", 3.0),
            ("step", 10.0),
            ("triangle", 10.0),
        ];
        let with = |counts_per_rev| {
            drives.map(|(excitation, seconds)| Condition {
                excitation,
                seconds,
                counts_per_rev,
            })
        };
        ENCODERS.into_iter().flat_map(with).collect()
    }

    /// Records motor `number` of the seed and fits it. `None` where it cannot be recorded or fitted.
    ///
    /// # Errors
    /// None, as long as the catalogues agree with each other.
    pub fn errors(&self, seed: u64, number: u64) -> Result<Option<Vec<Error>>, Failure> {
        let mut draws = Draws::of(&[seed, number]);
        let machine = Motor::draw(&mut draws)?.machine;
        let Some(data) = self.record(machine, draws.seed()) else {
            return Ok(None);
        };
        let known = Known {
            kt_equals_kb: true,
            ..Known::default()
        };
        let options = Options {
            known,
            ..Options::default()
        };
        let Ok(fit) = identify_data(&data, None, &options, &Silent::default()) else {
            return Ok(None);
        };
        let error = |(name, truth): (&'static str, f64)| {
            let parameter = fit.parameters.iter().find(|p| p.name == name);
            let z = parameter.and_then(|p| Some((p.value - truth) / p.std?));
            Error { name, z }
        };
        Ok(Some(truth(&machine).map(error).into()))
    }

    fn record(&self, machine: Machine, seed: u64) -> Option<Data> {
        let mut bench = Bench::new(machine);
        bench.counts_per_rev = self.counts_per_rev;
        bench.sample_s = INTERVAL_S;
        bench.seed = seed;
        bench.current_noise_a = CURRENT_NOISE * machine.stall_current_a();
        let drive: Vec<DriveSample> = commands::<f64>(&self.plan(), INTERVAL_S, seed)
            .map(|command| DriveSample {
                volts: command.drive * machine.supply_v,
                enabled: command.enabled,
            })
            .collect();
        let recording = bench.record(&drive, self.excitation, true).ok()?;
        Data::new(&recording).ok()
    }

    fn plan(&self) -> Vec<Experiment> {
        let shape = Shape::ALL.iter().find(|(name, _)| *name == self.excitation);
        if let Some(&(_, shape)) = shape {
            return vec![Experiment {
                shape,
                seconds: self.seconds,
                amplitude: AMPLITUDE,
            }];
        }
        let usual: f64 = COMMISSIONING.iter().map(|part| part.seconds).sum();
        let part = |part: &Experiment| Experiment {
            seconds: part.seconds * self.seconds / usual,
            amplitude: part.amplitude * AMPLITUDE,
            ..*part
        };
        COMMISSIONING.iter().map(part).collect()
    }
}

/// What a fit of the linear motor states, of the bench's machine: gain Kt/D, a1 = (R·J + L·f)/D, a2/a1 with a2 = L·J/D, where
/// D = Kt·Kb + R·f; and what the current shows where Kt = Kb.
fn truth(machine: &Machine) -> [(&'static str, f64); 8] {
    let m = machine;
    let total = m.kt_n_m_a * m.kb_v_s_rad + m.resistance_ohm * m.viscous_n_m_s;
    let a1 = (m.resistance_ohm * m.inertia_kg_m2 + m.inductance_h * m.viscous_n_m_s) / total;
    let a2 = m.inductance_h * m.inertia_kg_m2 / total;
    [
        ("gain", m.kt_n_m_a / total),
        ("a1", a1),
        ("electrical_time_constant", a2 / a1),
        ("resistance", m.resistance_ohm),
        ("inductance", m.inductance_h),
        ("kt", m.kt_n_m_a),
        ("inertia", m.inertia_kg_m2),
        ("viscous", m.viscous_n_m_s),
    ]
}
