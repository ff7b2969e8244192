//! One case: a motor on the virtual bench with what is hidden in it, and its two recordings.

use super::draws::{Draws, rounded};
use super::law::DrawnLaw;
use super::motor::Motor;
use super::{Excite, HowMany, SetUp, hide};
use crate::error::Error;
use serde::{Deserialize, Serialize};
use servoid_engine::problem::Data;
use servoid_io::excitation;
use servoid_io::record::Record;
use servoid_plant::{Bench, BenchError, DriveSample, Hidden};
use shared::excite::Shape;

/// Sample interval, s.
const INTERVAL_S: f64 = 1e-3;
/// Length of a recording, s.
const SECONDS: f64 = 20.0;
/// Encoder counts per revolution.
const COUNTS_PER_REV: (f64, f64) = (1000.0, 16384.0);
/// A coarse encoder, and how often the mixed excitations meet it.
const COARSE: (u32, f64) = (360, 1.0 / 6.0);
/// Amplitudes, as parts of the supply.
const COMMISSIONING_AMPLITUDE: (f64, f64) = (0.6, 1.0);
const MIXED_AMPLITUDE: (f64, f64) = (0.2, 1.0);
/// Purpose of the stream that draws the curves.
const LAWS: u64 = 0x6c61_7773;
/// Draws of a case before it is given up.
const MOST_ATTEMPTS: u32 = 200;

/// All that was drawn for a case, in a form that prints and reads back.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Drawn {
    /// How often the draw was refused before and repeated.
    pub redrawn: u32,
    /// The motor.
    pub motor: Motor,
    /// The hidden effects, as [`Hidden`] prints them.
    pub hidden: Vec<String>,
    /// The hidden law that is none of the catalogue.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub law: Option<DrawnLaw>,
    /// Encoder counts per revolution.
    pub counts_per_rev: u32,
    /// `commissioning` or the name of one of [`Shape::ALL`], never of rest.
    pub excitation: String,
    /// Its amplitude, as a part of the supply.
    pub amplitude: f64,
    /// Seeds of the fitted and of the held-out recording.
    pub recording_seeds: [u64; 2],
}

/// A case, recorded.
pub struct Case {
    /// Its number under the seed.
    pub number: u64,
    /// What was drawn.
    pub drawn: Drawn,
    /// The recording to fit.
    pub fitted: Data,
    /// The recording to hold out.
    pub held_out: Data,
}

impl Case {
    /// Draws and records case `number`. What cannot be recorded (too stiff for the bench, or a motor that never
    /// moves) is drawn anew with the same effects.
    ///
    /// # Errors
    /// [`Error::Failed`] where no draw can be recorded.
    pub fn record(set_up: &SetUp, number: u64) -> Result<Case, Error> {
        let mut last = None;
        for redrawn in 0..MOST_ATTEMPTS {
            let drawn = Drawn::draw(set_up, number, redrawn)?;
            match (drawn.data(0), drawn.data(1)) {
                (Ok(fitted), Ok(held_out)) => {
                    return Ok(Case {
                        number,
                        drawn,
                        fitted,
                        held_out,
                    });
                }
                (Err(error), _) | (_, Err(error)) => last = Some(error),
            }
        }
        let reason = last.map_or(String::new(), |error| error.to_string());
        Err(Error::Failed(format!(
            "case {number} of seed {}: none of {MOST_ATTEMPTS} draws can be recorded; the last: {reason}",
            set_up.seed
        )))
    }
}

impl Drawn {
    /// Draws case `number` for the time `redrawn` (from 0): a function of nothing but these.
    ///
    /// # Errors
    /// None, as long as the catalogues agree with each other.
    pub fn draw(set_up: &SetUp, number: u64, redrawn: u32) -> Result<Drawn, BenchError> {
        let mut draws = Draws::of(&[set_up.seed, number, u64::from(redrawn)]);
        let motor = Motor::draw(&mut draws)?;
        let machine = motor.machine;
        let fine = draws.log_uniform(COUNTS_PER_REV.0, COUNTS_PER_REV.1) as u32;
        let (counts_per_rev, excitation, amplitude) = match set_up.excite {
            Excite::Commissioning => {
                let (low, high) = COMMISSIONING_AMPLITUDE;
                (fine, "commissioning", draws.uniform(low, high))
            }
            Excite::Mixed => {
                let coarse = draws.chance(COARSE.1);
                // At rest nothing is commanded: there is no motor to identify.
                let driven = Shape::ALL.iter().filter(|(_, shape)| *shape != Shape::Rest);
                let names: Vec<&str> = driven.map(|(name, _)| *name).collect();
                let name = draws.pick(&names).unwrap_or_default();
                let (low, high) = MIXED_AMPLITUDE;
                let counts = if coarse { COARSE.0 } else { fine };
                (counts, name, draws.log_uniform(low, high))
            }
        };
        let hidden = hide::names(set_up, number)
            .into_iter()
            .map(|name| {
                let hidden = hide::draw(name, &machine, &mut draws)?;
                // A stream of its own, so that whatever else is drawn does not depend on the laws.
                let mut curves = Draws::of(&[set_up.seed, number, u64::from(redrawn), LAWS]);
                Ok(hide::by_law(hidden, set_up.laws, &mut curves)?.to_string())
            })
            .collect::<Result<_, BenchError>>()?;
        let law = (set_up.hidden == HowMany::Formula)
            .then(|| DrawnLaw::draw(number, &machine, &mut draws));
        Ok(Drawn {
            redrawn,
            motor,
            hidden,
            law: law.flatten(),
            counts_per_rev,
            excitation: excitation.to_owned(),
            amplitude: rounded(amplitude),
            recording_seeds: [draws.seed(), draws.seed()],
        })
    }

    /// The hidden effects.
    ///
    /// # Errors
    /// Those of [`Hidden::parse`], where the text did not come from here.
    pub fn hidden(&self) -> Result<Vec<Hidden>, BenchError> {
        let machine = self.motor.machine;
        let specs = self.hidden.iter();
        specs.map(|spec| Hidden::parse(spec, &machine)).collect()
    }

    /// The same case with one of what it hides and nothing else, for each: the effects in order, then the law.
    pub(super) fn apart(&self) -> Vec<Drawn> {
        let one = |hidden: Vec<String>, law: Option<DrawnLaw>| Drawn {
            hidden,
            law,
            ..self.clone()
        };
        let effects = self.hidden.iter();
        let effects = effects.map(|effect| one(vec![effect.clone()], None));
        let law = self
            .law
            .iter()
            .map(|law| one(Vec::new(), Some(law.clone())));
        effects.chain(law).collect()
    }

    /// Names of the hidden effects.
    pub fn names(&self) -> Vec<&str> {
        let name = |spec: &'_ String| spec.find(':').unwrap_or(spec.len());
        let specs = self.hidden.iter();
        specs.map(|spec| &spec[..name(spec)]).collect()
    }

    /// Recording 0, to fit, or 1, to hold out.
    pub(super) fn data(&self, which: usize) -> Result<Data, Error> {
        let (bench, drive) = self.bench(which)?;
        let source = ["fitted recording", "held-out recording"][which];
        Ok(Data::new(&bench.record(&drive, source, false)?)?)
    }

    /// The bench and the drive of a recording.
    pub(super) fn bench(&self, which: usize) -> Result<(Bench, Vec<DriveSample>), BenchError> {
        let seed = self.recording_seeds[which];
        let machine = self.motor.machine;
        let mut bench = Bench::new(machine);
        bench.counts_per_rev = self.counts_per_rev;
        bench.sample_s = INTERVAL_S;
        bench.seed = seed;
        bench.effects = self.hidden()?;
        bench.outside = self.law.as_ref().and_then(|law| law.hidden(&machine));
        let usual = excitation::named(&self.excitation).unwrap_or_default();
        let plan = excitation::stretched(&usual, SECONDS, self.amplitude);
        let drive = excitation::drive(&plan, INTERVAL_S, seed, machine.supply_v);
        Ok((bench, drive))
    }
}
