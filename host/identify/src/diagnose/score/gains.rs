//! The observer's gains: the Riccati recursion of the linear motor's angle and speed. They are the same for all models, so that a model
//! costs one run and all are measured alike.

use super::noise::Noise;
use super::readings::Readings;
use super::settings::{SHORT, SHORTEST_S, UNDAMPED_INTERVAL_S, UNDAMPED_S};
use servoid_engine::problem::Data;
use servoid_engine::simulation::Correction;
use servoid_io::recording::Drive;
use shared::motor::Machine;
use std::f64::consts::TAU;
use std::sync::Arc;

/// What the gains need of the motor: how fast its speed decays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plant {
    /// Mechanical time constant, s.
    pub time_constant_s: f64,
}

impl Plant {
    /// That of a machine; one that nothing damps has a time constant far beyond any recording.
    pub fn of(machine: &Machine<f64>) -> Self {
        let seconds = machine.inertia / (machine.kb + machine.damping);
        Plant {
            time_constant_s: if seconds.is_finite() {
                seconds.clamp(SHORTEST_S, UNDAMPED_S)
            } else {
                UNDAMPED_S
            },
        }
    }

    /// Time between two corrections, s, before it is confined to what is useful: the time constant where a back-EMF damps the motor.
    pub fn interval_s(self, drive: Drive) -> f64 {
        if drive.is_voltage() {
            self.time_constant_s
        } else {
            UNDAMPED_INTERVAL_S
        }
    }
}

/// An observer for the readings of recordings.
#[derive(Clone)]
pub struct Filter {
    /// What it corrects.
    pub corrections: Arc<[Correction]>,
    /// The variance of each innovation, counts².
    pub variances: Vec<f64>,
}

/// Part of a start speed, and rad/s, that its standard deviation is where the motor starts in motion.
const START_SPEED_ERROR: (f64, f64) = (0.2, 0.1);

impl Filter {
    /// The observer of each recording, of which `noise` has an entry each.
    pub fn new(readings: &Readings<'_>, plant: Plant, noise: &[Noise]) -> Self {
        let mut corrections = Vec::with_capacity(readings.samples.len());
        let mut variances = Vec::with_capacity(readings.samples.len());
        for (own, noise) in readings.recordings.iter().zip(noise) {
            let samples = &readings.samples[own.clone()];
            let at_rest = &readings.at_rest[own.clone()];
            let mut state = Covariance::at_start(readings, samples[0]);
            let mut before = samples[0];
            for (&sample, &at_rest) in samples.iter().zip(at_rest) {
                let elapsed = readings.data.time_s[sample] - readings.data.time_s[before];
                if elapsed > 0.0 {
                    state.predict(elapsed, plant.time_constant_s, noise.torque, at_rest);
                }
                before = sample;
                let (angle, speed, variance) = state.update(noise.reading);
                corrections.push(Correction {
                    sample,
                    angle,
                    speed: speed * per_unit_speed(readings.data),
                });
                variances.push(variance);
            }
        }
        Filter {
            corrections: corrections.into(),
            variances,
        }
    }
}

/// Per-unit speed of one count a second.
fn per_unit_speed(data: &Data) -> f64 {
    TAU / data.units.counts_per_rev / data.units.speed
}

/// Covariance of angle and speed: counts², counts²/s, counts²/s².
pub(super) struct Covariance {
    /// Of the angle.
    pub(super) angle: f64,
    cross: f64,
    speed: f64,
}

impl Covariance {
    /// Of a state that is known but for the variance of its angle, counts².
    pub(super) fn known(angle: f64) -> Self {
        Covariance {
            angle,
            cross: 0.0,
            speed: 0.0,
        }
    }

    fn at_start(readings: &Readings<'_>, first: usize) -> Self {
        let data = readings.data;
        let speed = data.start_speed(first).abs();
        let (part, least) = START_SPEED_ERROR;
        let error = if speed > 0.0 {
            (part * speed + least) * data.units.counts_per_rev / TAU
        } else {
            0.0
        };
        Covariance {
            angle: readings.floor,
            cross: 0.0,
            speed: error * error,
        }
    }

    /// Over `elapsed` s. A motor that is seen to rest is driven by nothing, and its speed is known.
    pub(super) fn predict(&mut self, elapsed: f64, tau: f64, torque: f64, at_rest: bool) {
        if at_rest {
            (self.cross, self.speed) = (0.0, 0.0);
            return;
        }
        let x = elapsed / tau;
        let decay = libm::exp(-x);
        // Angle that a speed of one passes before it has decayed.
        let travel = -tau * libm::expm1(-x);
        self.angle += travel * (2.0 * self.cross + travel * self.speed);
        self.cross = decay * (self.cross + travel * self.speed);
        self.speed *= decay * decay;
        let spread = -0.5 * tau * libm::expm1(-2.0 * x);
        self.speed += torque * spread;
        self.cross += torque * 0.5 * travel * travel;
        self.angle += torque
            * if x < SHORT {
                elapsed.powi(3) / 3.0
            } else {
                tau * tau * (elapsed - 2.0 * travel + spread)
            };
    }

    /// Takes in a reading; returns the gains of angle and speed and the variance of the innovation.
    fn update(&mut self, reading: f64) -> (f64, f64, f64) {
        let variance = self.angle + reading;
        let (angle, speed) = (self.angle / variance, self.cross / variance);
        self.speed -= speed * self.cross;
        self.cross -= angle * self.cross;
        self.angle -= angle * self.angle;
        (angle, speed, variance)
    }
}
