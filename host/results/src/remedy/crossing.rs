//! Crossing the gap of a coupling: its flanks change where the wanted acceleration reverses, and there the motor is sent
//! ahead of its load by the gap, instead of falling through it and knocking (Nordin, Gutman, *Controlling mechanical
//! systems with backlash – a survey*, Automatica 38(10), 2002, on inverses).

use servoid_engine::problem::Candidate;
use shared::effects::Kind;
use std::f64::consts::TAU;

/// Time of the crossing, as a multiple of what the loop's crossover frequency has as its inverse.
const SLOWER: f64 = 10.0;

/// A motion across the gap: a speed `gap/T·(1 − cos 2πt/T)` that is added to the wanted one, in the direction of the wanted
/// acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The gap, rad.
    pub gap_rad: f64,
    /// `T`, s.
    pub time_s: f64,
    /// The part of the inertia that is moved across it: the motor's without its load.
    pub motor_share: f64,
}

impl Crossing {
    /// Across the gap of a model, if it has one, as fast as a loop of this crossover (rad/s) follows.
    pub(super) fn of(candidate: &Candidate, crossover: f64) -> Option<Self> {
        let mut effects = candidate.effects.iter();
        let (_, values) = effects.find(|(kind, _)| *kind == Kind::Backlash)?;
        Some(Crossing {
            gap_rad: values[0],
            time_s: SLOWER / crossover,
            motor_share: 1.0 - values[1],
        })
    }

    /// Speed and acceleration to add, rad/s and rad/s², this long after the wanted acceleration became positive.
    pub(super) fn motion(&self, since_s: f64) -> [f64; 2] {
        if !(0.0..self.time_s).contains(&since_s) {
            return [0.0, 0.0];
        }
        let mean = self.gap_rad / self.time_s;
        let rate = TAU / self.time_s;
        let (sin, cos) = (rate * since_s).sin_cos();
        [mean * (1.0 - cos), mean * rate * sin]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_leads_across_the_gap_and_stops_there() {
        let crossing = Crossing {
            gap_rad: 0.06,
            time_s: 0.04,
            motor_share: 0.5,
        };
        let step = 1e-5;
        let (mut angle, mut speed) = (0.0, 0.0);
        for k in 0..5000 {
            let [now, acceleration] = crossing.motion((f64::from(k) + 0.5) * step);
            angle += now * step;
            speed += acceleration * step;
        }
        assert!((angle - 0.06).abs() < 1e-6, "{angle}");
        assert!(speed.abs() < 1e-6, "{speed}");
    }
}
