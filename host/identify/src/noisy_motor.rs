//! A linear motor that torque noise drives, for the laws of what a motor does not repeat.

use servoid_engine::problem::{Candidate, Data};
use servoid_io::channel::Series;
use servoid_io::recording::{Drive, Recording};
use shared::effects::EffectSet;
use shared::motor::Machine;
use shared::rng;
use std::f64::consts::TAU;

const COUNTS_PER_REV: f64 = 8192.0;
const SAMPLE_S: f64 = 1e-3;
/// Steps of the simulation to a sample.
const FINER: usize = 10;
/// A period longer than any recording.
pub(crate) const ONCE: usize = 1 << 20;
/// Samples at rest before the first command, and between two: no window of half a second begins at an edge, where a speed is hard to tell.
const REST: usize = 170;

pub(crate) fn machine() -> Machine<f64> {
    Machine {
        kb: 0.045,
        damping: 0.0,
        inertia: 0.045 * 0.012,
        electrical: 0.0,
    }
}

/// The model that lacks nothing but the ripple.
pub(crate) fn candidate() -> Candidate {
    Candidate {
        machine: machine(),
        effects: EffectSet::default(),
        start_speed: 0.0,
        start_offset: 0.0,
    }
}

/// One run under steps of both signs.
#[derive(Clone, Copy)]
pub(crate) struct Run {
    pub(crate) seconds: f64,
    /// Intensity of the torque noise, counts²/s³.
    pub(crate) noise: f64,
    /// A torque that repeats three times a revolution, V.
    pub(crate) ripple_v: f64,
    pub(crate) command_seed: u64,
    /// Holds after which the steps come again.
    pub(crate) period: usize,
    pub(crate) noise_seed: u64,
}

impl Run {
    pub(crate) fn recorded(self) -> Data {
        Data::new(&self.recording()).expect("a recording")
    }

    pub(crate) fn recording(self) -> Recording {
        let mut commands = rng::seeded(self.command_seed);
        // Another stream than that of the commands.
        let mut kicks = rng::seeded(!self.noise_seed);
        let Machine { kb, inertia, .. } = machine();
        let step = SAMPLE_S / FINER as f64;
        let tau = inertia / kb;
        // Of the linear motor over a step, exactly.
        let decay = libm::exp(-step / tau);
        let travel = tau * (1.0 - decay);
        let kick = self.noise.sqrt() * TAU / COUNTS_PER_REV * step.sqrt();
        let samples = (self.seconds / SAMPLE_S) as usize;
        let (mut angle, mut speed, mut volts) = (0.0f64, 0.0f64, 0.0f64);
        let (mut time_s, mut command, mut counts) = (Vec::new(), Vec::new(), Vec::new());
        for k in 0..samples {
            if k >= REST && k % REST == 0 {
                if (k / REST - 1).is_multiple_of(self.period) {
                    commands = rng::seeded(self.command_seed);
                }
                volts = 12.0 * (2.0 * rng::uniform::<f64>(&mut commands) - 1.0);
            }
            time_s.push(k as f64 * SAMPLE_S);
            command.push(volts);
            counts.push((angle / TAU * COUNTS_PER_REV).floor());
            for _ in 0..FINER {
                let steady = (volts - self.ripple_v * libm::sin(3.0 * angle)) / kb;
                angle += steady * step + (speed - steady) * travel;
                speed = steady + (speed - steady) * decay;
                if k >= REST {
                    speed += kick * rng::normal::<f64>(&mut kicks);
                }
            }
        }
        Recording {
            source: format!("command {}, noise {}", self.command_seed, self.noise_seed),
            time_s,
            command,
            counts,
            measured: Series::NONE,
            enabled: None,
            counts_per_rev: COUNTS_PER_REV,
            quantised: true,
            supply_v: None,
            drive: Drive::Voltage,
            position: None,
        }
    }
}
