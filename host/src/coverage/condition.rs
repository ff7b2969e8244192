//! Drives and encoders, and the recordings of random motors under them.

use crate::error::Error;
use crate::prove::{Draws, Motor};
use servoid_engine::problem::Data;
use servoid_identify::fit::Options;
use servoid_identify::{Silent, identify_data, truth};
use servoid_io::excitation;
use servoid_io::input::Known;
use servoid_io::record::Record;
use servoid_plant::{Bench, Machine};
use shared::motor::Response;

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
    /// `commissioning`, or the name of a shape.
    pub excitation: &'static str,
    /// Length, s.
    pub seconds: f64,
    /// Encoder counts per revolution.
    pub counts_per_rev: u32,
}

/// The error of one parameter in its standard errors.
pub struct Standardised {
    /// The parameter.
    pub name: &'static str,
    /// Estimate less truth over the standard error; `None` where the fit states none.
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
    pub fn errors(&self, seed: u64, number: u64) -> Result<Option<Vec<Standardised>>, Error> {
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
            Standardised { name, z }
        };
        Ok(Some(truth(&machine).map(error).into()))
    }

    fn record(&self, machine: Machine, seed: u64) -> Option<Data> {
        let mut bench = Bench::new(machine);
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
