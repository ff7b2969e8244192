//! The fitted model in its speed loop, while a slow sine of speed is wanted.

use super::Crossing;
use crate::export::ExportError;
use crate::export::gains::feed_forward::FeedForward;
use crate::export::gains::loops::Pi;
use servoid_engine::problem::Candidate;
use servoid_engine::simulation::step;
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

/// A model and its controller.
pub(super) struct ClosedLoop<'a> {
    pub(super) candidate: &'a Candidate,
    pub(super) units: PerUnit<f64>,
    pub(super) pi: Pi,
    pub(super) feed_forward: &'a FeedForward,
    pub(super) crossing: Option<Crossing>,
}

/// The effects that a table of the angle compensates.
pub(super) fn by_angle(candidate: &Candidate) -> EffectSet<f64> {
    let periodic = candidate.keeping(|kind| kind.periodic_torque().is_some());
    periodic.effects
}

/// What is wanted at a moment: speed and acceleration, rad/s and rad/s².
struct Wanted {
    amplitude: f64,
    period_s: f64,
}

impl Wanted {
    fn at(&self, time_s: f64) -> [f64; 2] {
        let rate = TAU / self.period_s;
        let (sin, cos) = (rate * time_s).sin_cos();
        [self.amplitude * sin, self.amplitude * rate * cos]
    }

    /// Time since the acceleration reversed last, s; none before it did.
    fn since_reversal(&self, time_s: f64) -> Option<f64> {
        let half = 0.5 * self.period_s;
        let after = time_s - 0.5 * half;
        (after >= 0.0).then(|| after % half)
    }
}

impl ClosedLoop<'_> {
    /// Wanted and true speeds, rad/s, a sample a control period; with what is known of the effects, or without.
    ///
    /// # Errors
    /// A model that cannot run.
    pub(super) fn run(&self, helped: bool) -> Result<(Vec<f64>, Vec<f64>), ExportError> {
        let (units, own) = (self.units, self.feed_forward);
        let plan = Plan {
            effects: self.candidate.effects,
            substeps: SUBSTEPS,
            ..Plan::linear(self.candidate.machine, units)
        };
        for (kind, _) in self.candidate.effects.iter() {
            let told = kind.check_without_temperature();
            told.map_err(|error| ExportError::Loop(error.to_string()))?;
        }
        let model =
            Model::<f64>::new(&plan).map_err(|error| ExportError::Loop(error.to_string()))?;
        let table = Lowered::<f64>::new(&by_angle(self.candidate), &units);
        let by_table = |read: f64| {
            let turns = (read / units.counts_per_rev).rem_euclid(1.0);
            let shaft = Shaft::at(turns, 0.0, 0.0);
            table.torque(&shaft, &Default::default()) * units.volts
        };
        let lag = own.k_a / own.k_v;
        let wanted = Wanted {
            amplitude: AMPLITUDE * units.volts / own.k_v,
            period_s: (TIME_CONSTANTS * lag).clamp(PERIOD_S[0], PERIOD_S[1]),
        };
        let interval = units.interval;
        let radians = TAU / units.counts_per_rev;
        let samples = (PERIODS * wanted.period_s / interval).round() as usize;
        let mut state = State::at(0.0, 0.0);
        let (mut aims, mut speeds) = (Vec::new(), Vec::new());
        let (mut angle, mut count, mut sum, mut command) = (0.0, 0.0f64, 0.0, 0.0);
        for k in 0..samples {
            // What was computed a period ago acts now.
            let acts = command;
            let now = k as f64 * interval;
            let [load, load_gain] = wanted.at(now);
            let [ahead, ahead_gain] = if helped {
                self.ahead(&wanted, now)
            } else {
                [0.0, 0.0]
            };
            let aim = load + ahead;
            let read = model.reading(&state).floor();
            let error = aim - (read - count) * radians / interval;
            count = read;
            let mut forward = own.k_v * aim + own.k_a * (load_gain + ahead_gain);
            if helped {
                let against = if load == 0.0 { 0.0 } else { load.signum() };
                forward += own.k_s.unwrap_or(0.0) * against;
                forward += own.k_g.unwrap_or(0.0) + by_table(read);
            }
            let Pi { kp, ki } = self.pi;
            let unlimited = kp * error + ki * sum + forward;
            command = unlimited.clamp(-units.volts, units.volts);
            // The integral stands still while the command is at its limit.
            if command == unlimited {
                sum += error * interval;
            }
            step(&model, &mut state, acts / units.volts, false);
            let turned = model.reading(&state);
            aims.push(load);
            speeds.push(match self.crossing {
                None => (turned - angle) * radians / interval,
                // The load behind the gap is what turns.
                Some(_) => (state.motion.speed - state.motion.slip) * units.speed,
            });
            angle = turned;
        }
        Ok((aims, speeds))
    }

    /// What the motor is sent ahead of its load: a speed, and the acceleration that would cost as much with the whole inertia.
    fn ahead(&self, wanted: &Wanted, now: f64) -> [f64; 2] {
        let since = self.crossing.zip(wanted.since_reversal(now));
        let Some((crossing, since)) = since else {
            return [0.0, 0.0];
        };
        let [_, acceleration] = wanted.at(now);
        let [speed, gain] = crossing.motion(since);
        let side = acceleration.signum();
        [side * speed, side * gain * crossing.motor_share]
    }
}
