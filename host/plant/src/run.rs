//! The bench itself: plays a drive into the plant and reads the encoder.

use super::chance::Chance;
use super::effects::{CATALOGUE, Effect};
use super::encoder::Encoder;
use super::integrate::DEFAULT_SUBSTEP_HZ;
use super::plant::{Feed, Plant};
use super::position::{Controller, PositionControl};
use super::timeline::Timeline;
use super::{BenchError, DriveSample, Hidden, Machine, OutsideLaw, Stated};
use std::f64::consts::TAU;
use std::sync::Arc;

/// What the command sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amplifier {
    /// The armature voltage, V.
    Voltage,
    /// The armature current, A: an ideal current loop, so that neither L nor back-EMF shows.
    Current,
    /// A target angle, rad, from the counter's zero: a loop sets the armature voltage.
    Position(PositionControl),
}

/// A motor on the bench, with its hidden effects, its encoder and its sources of chance.
#[derive(Clone, Debug)]
pub struct Bench {
    /// The motor.
    pub machine: Machine,
    /// What is hidden in it, each effect at most once; the order does not matter.
    pub effects: Vec<Hidden>,
    /// What the command sets.
    pub amplifier: Amplifier,
    /// Encoder counts per revolution of the motor shaft, after quadrature.
    pub counts_per_rev: u32,
    /// Sample interval, s.
    pub sample_s: f64,
    /// Largest deviation of a sample's time from its multiple of the interval, s. The true time is recorded.
    pub jitter_s: f64,
    /// Substeps of the integration per second; at least 20 000.
    pub substep_hz: f64,
    /// Seed of everything random.
    pub seed: u64,
    /// Angle at the start, rad; `None` draws one revolution's angle from the seed.
    pub start_angle_rad: Option<f64>,
    /// Standard deviation of the current sensor's noise, A.
    pub current_noise_a: f64,
    /// What the current sensor reads at no current, A.
    pub current_zero_a: f64,
    /// Standard deviation of the angle sensor's noise before it is floored, counts, independent from sample to sample.
    pub angle_noise_counts: f64,
    /// Standard deviation of a load torque that is another one in each sample interval, N·m.
    pub torque_noise_n_m: f64,
    /// A law that is hidden and that the catalogue does not hold.
    pub outside: Option<OutsideLaw>,
    /// Effects that the caller brings along; together they remember at most [`STATED_MEMORIES`](crate::STATED_MEMORIES) numbers.
    pub stated: Vec<Stated>,
}

/// A run on the bench: one entry of each column per drive sample.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    /// Time of the sample, s.
    pub time_s: Vec<f64>,
    /// Command, V (or A or rad, see [`Amplifier`]), given just after the reading and held until the next row.
    pub voltage_v: Vec<f64>,
    /// Whether the bridge is told to drive.
    pub enabled: Vec<bool>,
    /// The encoder's counter.
    pub counts: Vec<i64>,
    /// Reading of the current sensor, A.
    pub current_a: Vec<f64>,
    /// True angle of the motor shaft, rad.
    pub angle_rad: Vec<f64>,
    /// True speed of the motor shaft, rad/s.
    pub speed_rad_s: Vec<f64>,
}

/// What there is to read at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Time of the sample, s.
    pub time_s: f64,
    /// The encoder's counter.
    pub counts: i64,
    /// Reading of the current sensor, A.
    pub current_a: f64,
    /// True angle of the motor shaft, rad.
    pub angle_rad: f64,
    /// True speed of the motor shaft, rad/s.
    pub speed_rad_s: f64,
}

impl Bench {
    /// The plain machine under voltage control: 4096 counts, 1 ms, no jitter, no noise, seed 0.
    pub fn new(machine: Machine) -> Self {
        Bench {
            machine,
            effects: Vec::new(),
            amplifier: Amplifier::Voltage,
            counts_per_rev: 4096,
            sample_s: 1e-3,
            jitter_s: 0.0,
            substep_hz: DEFAULT_SUBSTEP_HZ,
            seed: 0,
            start_angle_rad: None,
            current_noise_a: 0.0,
            current_zero_a: 0.0,
            angle_noise_counts: 0.0,
            torque_noise_n_m: 0.0,
            outside: None,
            stated: Vec::new(),
        }
    }

    /// Plays the drive and records. Row k is read at its time before its command acts.
    ///
    /// # Errors
    /// A setting, command or effect that makes no sense; [`BenchError::TooStiff`]; [`BenchError::Diverged`].
    pub fn run(&self, drive: &[DriveSample]) -> Result<Run, BenchError> {
        self.check_commands(drive)?;
        let mut run = Run::default();
        let mut samples = drive.iter();
        self.follow(|reading| {
            let sample = samples.next()?;
            run.time_s.push(reading.time_s);
            run.voltage_v.push(sample.volts);
            run.enabled.push(sample.enabled);
            run.counts.push(reading.counts);
            run.current_a.push(reading.current_a);
            run.angle_rad.push(reading.angle_rad);
            run.speed_rad_s.push(reading.speed_rad_s);
            Some(*sample)
        })?;
        Ok(run)
    }

    /// Runs in step with whoever drives: shows each reading and asks for the command from then on, until there is none.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn follow(
        &self,
        mut next: impl FnMut(&Reading) -> Option<DriveSample>,
    ) -> Result<(), BenchError> {
        self.check()?;
        let effects = self.assemble()?;
        let latency_s = effects.iter().map(|effect| effect.latency_s()).sum();
        let mut timeline = Timeline::new(latency_s);
        let mut plant = Plant::new(self.machine, &effects, self.substep_hz, self.start_angle());
        let mut encoder = Encoder::new(&effects, self.counts_per_rev, self.seed);
        let mut controller = match self.amplifier {
            Amplifier::Position(control) => Some(Controller::new(control, self.counts_per_rev)),
            Amplifier::Voltage | Amplifier::Current => None,
        };
        let mut noise = Chance::new(self.seed, "current noise");
        let mut angle_noise = Chance::new(self.seed, "angle noise");
        let mut torque_noise = Chance::new(self.seed, "torque noise");
        let mut times = self.sample_times();
        let mut now = times(0);
        for row in 1.. {
            let state = plant.state;
            if !(state.angle.is_finite() && state.speed.is_finite() && state.current.is_finite()) {
                return Err(BenchError::Diverged { time_s: now });
            }
            let reading = Reading {
                time_s: now,
                counts: encoder.read(state.angle, self.angle_noise_counts * angle_noise.normal()),
                current_a: state.current
                    + self.current_zero_a
                    + self.current_noise_a * noise.normal(),
                angle_rad: state.angle,
                speed_rad_s: state.speed,
            };
            let Some(sample) = next(&reading) else {
                return Ok(());
            };
            let then = times(row);
            plant.disturbance_n_m = self.torque_noise_n_m * torque_noise.normal();
            if controller.is_none() {
                timeline.send(now, sample);
            }
            let mut begin = now;
            while let Some(controller) = &mut controller
                && let Some(next) = controller.next_before(then)
            {
                let instant = next.max(begin);
                timeline.play(begin, instant, |sample, dt| {
                    plant.advance(self.feed(sample), dt)
                })?;
                timeline.send(
                    instant,
                    controller.act(sample, encoder.read(plant.state.angle, 0.0)),
                );
                begin = instant;
            }
            timeline.play(begin, then, |sample, dt| {
                plant.advance(self.feed(sample), dt)
            })?;
            encoder.pass((plant.state.angle - state.angle) / (then - now), then - now);
            now = then;
        }
        Ok(())
    }

    fn feed(&self, sample: DriveSample) -> Feed {
        match (sample.enabled, self.amplifier) {
            (false, _) => Feed::Open,
            (true, Amplifier::Voltage | Amplifier::Position(_)) => Feed::Volts(sample.volts),
            (true, Amplifier::Current) => Feed::Amps(sample.volts),
        }
    }

    /// The time of each row, asked for in order.
    fn sample_times(&self) -> impl FnMut(usize) -> f64 {
        let mut chance = Chance::new(self.seed, "sample times");
        let (interval, jitter) = (self.sample_s, self.jitter_s);
        move |row| {
            let late = if row == 0 {
                0.0
            } else {
                jitter * (2.0 * chance.uniform() - 1.0)
            };
            row as f64 * interval + late
        }
    }

    fn start_angle(&self) -> f64 {
        let drawn = TAU * Chance::new(self.seed, "start angle").uniform();
        self.start_angle_rad.unwrap_or(drawn)
    }

    /// The effects in the order of the catalogue, and the law from outside it.
    fn assemble(&self) -> Result<Vec<Arc<dyn Effect>>, BenchError> {
        let mut effects: Vec<Arc<dyn Effect>> = Vec::new();
        for kind in CATALOGUE {
            let mut orders = self
                .effects
                .iter()
                .filter(|hidden| hidden.name() == kind.name);
            if let Some(hidden) = orders.next() {
                effects.push(hidden.build(&self.machine)?.into());
            }
            if orders.next().is_some() {
                return Err(BenchError::Twice(kind.name));
            }
        }
        if let Some(law) = &self.outside {
            effects.push(Arc::new(law.clone()));
        }
        let stated = self.stated.iter().map(|Stated(effect)| effect.clone());
        effects.extend(stated);
        Ok(effects)
    }

    fn check_commands(&self, drive: &[DriveSample]) -> Result<(), BenchError> {
        if let Some(row) = drive.iter().position(|sample| !sample.volts.is_finite()) {
            return Err(BenchError::BadCommand {
                row,
                value: drive[row].volts,
            });
        }
        Ok(())
    }

    fn check(&self) -> Result<(), BenchError> {
        self.machine.check()?;
        let interval = self.sample_s;
        let counts = f64::from(self.counts_per_rev);
        let at_least_zero = |value: f64| value >= 0.0 && value.is_finite();
        let start = self.start_angle_rad.unwrap_or(0.0);
        let settings = [
            ("counts_per_rev", counts, counts >= 1.0, "at least 1"),
            (
                "sample_s",
                interval,
                interval > 0.0 && interval.is_finite(),
                "above zero",
            ),
            (
                "jitter_s",
                self.jitter_s,
                at_least_zero(self.jitter_s) && self.jitter_s < 0.5 * interval,
                "zero to less than half the sample interval",
            ),
            (
                "substep_hz",
                self.substep_hz,
                (20e3..=10e6).contains(&self.substep_hz),
                "20 000 to 10 000 000",
            ),
            (
                "start_angle_rad",
                start,
                start.is_finite(),
                "a finite number",
            ),
            (
                "current_noise_a",
                self.current_noise_a,
                at_least_zero(self.current_noise_a),
                "zero or above",
            ),
            (
                "angle_noise_counts",
                self.angle_noise_counts,
                at_least_zero(self.angle_noise_counts),
                "zero or above",
            ),
            (
                "torque_noise_n_m",
                self.torque_noise_n_m,
                at_least_zero(self.torque_noise_n_m),
                "zero or above",
            ),
            (
                "current_zero_a",
                self.current_zero_a,
                self.current_zero_a.is_finite(),
                "a finite number",
            ),
        ];
        for (setting, value, holds, need) in settings {
            BenchError::require(holds, setting, value, need)?;
        }
        if let Amplifier::Position(control) = self.amplifier {
            control.check()?;
        }
        let electrical = self.effects.iter().find(|hidden| hidden.is_electrical());
        match (self.amplifier, electrical) {
            (Amplifier::Current, Some(hidden)) => {
                Err(BenchError::HiddenByCurrentLoop(hidden.name()))
            }
            _ => Ok(()),
        }
    }
}
