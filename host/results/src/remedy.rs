//! What knowing a motor's effects is good for: its speed loop on the fitted model, with the feed-forward of a linear motor, and with friction,
//! constant load and cogging compensated as well.
//!
//! The loop is the one that the format `gains` writes for volts. It reads the speed as the encoder's counts over a period, its command acts
//! one period later, and the model follows it with all its effects. The wanted speed is slow and reverses: there friction and cogging tell.

use crate::export::gains::feed_forward::FeedForward;
use crate::export::gains::{self, Asked, Loops, Section};
use crate::export::{ExportError, Options, Subject, Written};
use servoid_engine::problem::Candidate;
use servoid_io::recording::Drive;
use shared::effects::{EffectSet, Lowered, Shaft};
use shared::model::{Model, Plan, State};
use shared::units::PerUnit;
use std::f64::consts::TAU;

/// Amplitude of the wanted speed, as a part of the speed on the whole supply.
const AMPLITUDE: f64 = 0.03;
/// Periods of the wanted speed: the first settles, the second is judged.
const PERIODS: f64 = 2.0;
/// Shortest and longest of these periods, s, and as many of the motor's time constants.
const PERIOD_S: [f64; 2] = [1.0, 20.0];
const TIME_CONSTANTS: f64 = 40.0;
/// Substeps of the model: a controller excites it harder than a recording.
const SUBSTEPS: u16 = 8;
/// Samples that are drawn.
const DRAWN: usize = 600;

/// A motor in a speed loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Remedy {
    /// Proportional and integral gain, V per rad/s and V per rad.
    pub gains: [f64; 2],
    /// What is fed forward.
    pub feed_forward: FeedForward,
    /// Effects of the angle that are compensated by a table.
    pub by_angle: Vec<&'static str>,
    /// Times of the samples that are drawn, s.
    pub time_s: Vec<f64>,
    /// Speed that is wanted there, rad/s.
    pub wanted: Vec<f64>,
    /// The motor's speed there with a linear motor's feed-forward, rad/s.
    pub before: Vec<f64>,
    /// With what is known of its effects, rad/s.
    pub after: Vec<f64>,
    /// RMS of wanted less true speed before and after, rad/s.
    pub rms: [f64; 2],
}

/// Tries the loop of a motor that was driven by volts.
///
/// # Errors
/// A response or a loop that is not determined; a model that cannot run.
pub fn remedy(
    subject: &Subject,
    candidate: &Candidate,
    units: PerUnit<f64>,
) -> Result<Remedy, ExportError> {
    if subject.drive != Drive::Voltage {
        return Err(ExportError::CurrentDriven {
            format: "the speed loop",
        });
    }
    let options = Options {
        sample_s: Some(units.interval),
        gains: Asked {
            loops: Some(Loops::Voltage),
            ..Asked::default()
        },
    };
    let controllers = gains::design(subject, &options)?;
    let speed: &Section = controllers
        .section("speed_loop")
        .ok_or_else(|| ExportError::Loop("there is no speed loop for this motor".to_owned()))?;
    let pi = speed.closed.pi;
    let feed_forward = FeedForward::of(subject, &mut Written::new(subject));
    let bench = Bench::new(candidate, units, [pi.kp, pi.ki], &feed_forward)?;
    let (wanted, before) = bench.run(false);
    let (_, after) = bench.run(true);
    let step = wanted.len().div_ceil(DRAWN).max(1);
    let pick = |of: &[f64]| of.iter().copied().step_by(step).collect::<Vec<f64>>();
    let judged = wanted.len() / 2;
    let rms = |speed: &[f64]| {
        let errors = wanted.iter().zip(speed).skip(judged);
        let squares: f64 = errors.map(|(wanted, speed)| (wanted - speed).powi(2)).sum();
        (squares / (wanted.len() - judged) as f64).sqrt()
    };
    Ok(Remedy {
        gains: [pi.kp, pi.ki],
        by_angle: bench.by_angle.iter().map(|(kind, _)| kind.name()).collect(),
        time_s: (0..wanted.len())
            .step_by(step)
            .map(|k| k as f64 * units.interval)
            .collect(),
        rms: [rms(&before), rms(&after)],
        wanted: pick(&wanted),
        before: pick(&before),
        after: pick(&after),
        feed_forward,
    })
}

/// The model in its loop.
struct Bench<'a> {
    model: Model<f64>,
    units: PerUnit<f64>,
    pi: [f64; 2],
    feed_forward: &'a FeedForward,
    by_angle: EffectSet<f64>,
    amplitude: f64,
    period_s: f64,
}

impl<'a> Bench<'a> {
    fn new(
        candidate: &Candidate,
        units: PerUnit<f64>,
        pi: [f64; 2],
        feed_forward: &'a FeedForward,
    ) -> Result<Self, ExportError> {
        let plan = Plan {
            effects: candidate.effects,
            substeps: SUBSTEPS,
            ..Plan::linear(candidate.machine, units)
        };
        let model = Model::new(&plan).map_err(|error| ExportError::Loop(error.to_string()))?;
        let by_angle = candidate.keeping(|kind| kind.periodic_torque().is_some());
        let lag = feed_forward.k_a / feed_forward.k_v;
        Ok(Bench {
            model,
            units,
            pi,
            feed_forward,
            by_angle: by_angle.effects,
            amplitude: AMPLITUDE * units.volts / feed_forward.k_v,
            period_s: (TIME_CONSTANTS * lag).clamp(PERIOD_S[0], PERIOD_S[1]),
        })
    }

    /// Wanted and true speeds, rad/s, a sample a control period.
    fn run(&self, helped: bool) -> (Vec<f64>, Vec<f64>) {
        let interval = self.units.interval;
        let radians = TAU / self.units.counts_per_rev;
        let samples = (PERIODS * self.period_s / interval).round() as usize;
        let table = Lowered::<f64>::new(&self.by_angle, &self.units);
        let mut state = State::at(0.0, 0.0);
        let (mut wanted, mut speeds) = (Vec::new(), Vec::new());
        let (mut angle, mut count, mut sum, mut command) = (0.0, 0.0f64, 0.0, 0.0);
        for k in 0..samples {
            // What was computed a period ago acts now.
            let acts = command;
            let phase = TAU * (k as f64 * interval) / self.period_s;
            let aim = self.amplitude * phase.sin();
            let gain = self.amplitude * TAU / self.period_s * phase.cos();
            let read = self.model.reading(&state).floor();
            let error = aim - (read - count) * radians / interval;
            count = read;
            let [kp, ki] = self.pi;
            let forward = self.forward(aim, gain, helped)
                + if helped {
                    let turns = (read / self.units.counts_per_rev).rem_euclid(1.0);
                    let shaft = Shaft::at(turns, 0.0, 0.0);
                    table.torque(&shaft, &Default::default()) * self.units.volts
                } else {
                    0.0
                };
            let limit = self.units.volts;
            let unlimited = kp * error + ki * sum + forward;
            command = unlimited.clamp(-limit, limit);
            // The integral stands still while the command is at its limit.
            if command == unlimited {
                sum += error * interval;
            }
            self.model.step(&mut state, acts / self.units.volts, false);
            let now = self.model.reading(&state);
            wanted.push(aim);
            speeds.push((now - angle) * radians / interval);
            angle = now;
        }
        (wanted, speeds)
    }

    fn forward(&self, speed: f64, acceleration: f64, helped: bool) -> f64 {
        let own = self.feed_forward;
        let linear = own.k_v * speed + own.k_a * acceleration;
        if !helped {
            return linear;
        }
        let dry = own.k_s.unwrap_or(0.0) * if speed == 0.0 { 0.0 } else { speed.signum() };
        linear + dry + own.k_g.unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::Side;
    use crate::schema;
    use servoid_engine::problem::Data;
    use servoid_identify::fit::Options as FitOptions;
    use servoid_identify::{Silent, identify};
    use servoid_io::showcase;
    use servoid_plant::Hidden;
    use shared::effects::Kind;

    #[test]
    fn what_is_known_of_an_effect_makes_the_loop_follow_better() {
        // A load that is constant is the integrator's already.
        for (name, kind, least) in [
            ("coulomb", Kind::Coulomb, 2.0),
            ("cogging", Kind::Cogging, 1.5),
            ("load_torque", Kind::LoadTorque, 0.9),
        ] {
            let hidden = Hidden::typical(name, &showcase::machine()).expect("an effect");
            let recording = showcase::record(&hidden, 1, "bench").expect("a recording");
            let asked = FitOptions {
                effects: vec![kind],
                ..FitOptions::default()
            };
            let fit = identify(&recording, &asked, &Silent::default()).expect("a fit");
            let data = Data::new(&recording).expect("data");
            let json = serde_json::to_string(&schema::Fit::new(&fit, &data, None)).expect("JSON");
            let result = schema::Identified::parse(&json).expect("a result");
            let subject = Subject::new(&result, "test", Side::Motor).expect("a subject");
            let found = remedy(&subject, &fit.candidate, data.units).expect("a loop");
            let [before, after] = found.rms;
            println!("{name}: {before:.3} to {after:.3} rad/s");
            assert!(before >= least * after, "{name}: {before} to {after} rad/s");
            assert!(after < 0.5 * found.wanted.iter().fold(0.0, |m, w| w.max(m)));
        }
    }
}
