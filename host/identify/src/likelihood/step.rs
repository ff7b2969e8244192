//! One step of the motor under a constant command, with the stop located in it, and its Jacobian.
//!
//! At constant direction the step is exact. Where the speed reaches zero inside, the time of the stop follows in closed form,
//! `t = (a/b)·ln(1 − b·ω/f)`, and the rest of the step is rest or motion the other way. Gravity counts at the angle in the
//! middle of the step. The Jacobian is that of exactly this step, with the derivatives of the stop's time.

use super::decay::{Decay, Noise};
use super::parameters::Parameters;

/// Part of the friction around breakaway within which a resting motor counts as partly sliding.
const BREAKAWAY: f64 = 0.04;

/// A model ready to step.
#[derive(Clone, Debug)]
pub(super) struct Stepper {
    inertia: f64,
    rates: [f64; 2],
    coulomb: f64,
    offset: f64,
    gravity: Option<[f64; 2]>,
    lengths: Vec<Length>,
}

/// What does not change between steps of one length.
#[derive(Clone, Copy, Debug)]
struct Length {
    seconds: f64,
    directed: [Decay; 2],
    noise: Noise,
}

/// Angle, rad, and speed, rad/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct State {
    pub(super) angle: f64,
    pub(super) speed: f64,
}

/// What a step does.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stepped {
    pub(super) state: State,
    /// Angle and speed by angle, then by speed.
    pub(super) by_angle: [f64; 2],
    pub(super) by_speed: [f64; 2],
    /// Part of the step in which the motor slides.
    pub(super) sliding: f64,
}

/// A step at a constant force, with its derivatives.
#[derive(Clone, Copy, Debug)]
struct Forced {
    travel: f64,
    speed: f64,
    by_speed: [f64; 2],
    by_force: [f64; 2],
    sliding: f64,
}

impl Stepper {
    /// Steps of these lengths, s.
    pub(super) fn new(p: &Parameters, lengths_s: &[f64]) -> Self {
        let rates = p.directed_damping().map(|b| b.max(0.0) / p.inertia);
        let mean_rate = 0.5 * (rates[0] + rates[1]);
        let length = |&seconds: &f64| Length {
            seconds,
            directed: rates.map(|rate| Decay::new(seconds, rate)),
            noise: Noise::new(seconds, mean_rate),
        };
        Stepper {
            inertia: p.inertia,
            rates,
            coulomb: p.coulomb,
            offset: p.offset,
            gravity: (p.gravity != [0.0; 2]).then_some(p.gravity),
            lengths: lengths_s.iter().map(length).collect(),
        }
    }

    /// Noise that white acceleration of unit intensity adds in a step.
    #[inline(always)]
    pub(super) fn noise(&self, length: u32) -> &Noise {
        &self.lengths[length as usize].noise
    }

    /// One step under `volts`.
    #[inline(always)]
    pub(super) fn step(&self, state: State, volts: f64, length: u32) -> Stepped {
        let length = &self.lengths[length as usize];
        let (pull, slope) = match self.gravity {
            None => (0.0, 0.0),
            Some([sine, cosine]) => {
                let (s, c) = libm::sincos(state.angle + 0.5 * length.seconds * state.speed);
                (sine * s + cosine * c, sine * c - cosine * s)
            }
        };
        let f = self.forced(state.speed, volts + self.offset - pull, length);
        let mut by_angle = [1.0, 0.0];
        let mut by_speed = f.by_speed;
        if self.gravity.is_some() {
            for k in 0..2 {
                by_angle[k] -= f.by_force[k] * slope;
                by_speed[k] -= f.by_force[k] * slope * 0.5 * length.seconds;
            }
        }
        Stepped {
            state: State {
                angle: state.angle + f.travel,
                speed: f.speed,
            },
            by_angle,
            by_speed,
            sliding: f.sliding,
        }
    }

    #[inline(always)]
    fn forced(&self, speed: f64, volts: f64, length: &Length) -> Forced {
        let forward = if speed == 0.0 {
            if self.coulomb > 0.0 && volts.abs() <= self.coulomb {
                return self.resting(volts);
            }
            volts > 0.0
        } else {
            speed > 0.0
        };
        let direction = usize::from(!forward);
        let decay = &length.directed[direction];
        let friction = if forward { self.coulomb } else { -self.coulomb };
        let per_inertia = 1.0 / self.inertia;
        let push = (volts - friction) * per_inertia;
        let end = speed * decay.speed + push * decay.angle;
        if speed * end < 0.0 {
            return self.stopping(speed, volts, push, direction, length.seconds);
        }
        Forced {
            travel: speed * decay.angle + push * decay.angle_by_force,
            speed: end,
            by_speed: [decay.angle, decay.speed],
            by_force: [
                decay.angle_by_force * per_inertia,
                decay.angle * per_inertia,
            ],
            sliding: 1.0,
        }
    }

    /// A step in which the motor stops: `push` is the acceleration before, rad/s², without damping.
    #[cold]
    fn stopping(
        &self,
        speed: f64,
        volts: f64,
        push: f64,
        direction: usize,
        seconds: f64,
    ) -> Forced {
        let (rate, per_inertia) = (self.rates[direction], 1.0 / self.inertia);
        let ratio = -speed * rate / push;
        let logarithm = if ratio < 1e-9 {
            1.0
        } else {
            libm::log1p(ratio) / ratio
        };
        let stop = (-speed / push * logarithm).clamp(0.0, seconds);
        let before = Decay::new(stop, rate);
        // Of the travel the time of the stop moves nothing: the speed there is zero.
        let travel = speed * before.angle + push * before.angle_by_force;
        let mut by_speed = [before.angle, 0.0];
        let mut by_force = [before.angle_by_force * per_inertia, 0.0];
        if volts.abs() <= self.coulomb {
            let slid = stop / seconds;
            return Forced {
                travel,
                speed: 0.0,
                by_speed,
                by_force,
                sliding: slid + (1.0 - slid) * self.breaking_away(volts),
            };
        }
        let stop_by_speed = -before.speed / push;
        let stop_by_force = -before.angle / push * per_inertia;
        let friction = self.coulomb.copysign(volts);
        let push = (volts - friction) * per_inertia;
        let after = Decay::new(seconds - stop, self.rates[usize::from(volts < 0.0)]);
        let end = push * after.angle;
        let end_by_stop = -push * after.speed;
        by_speed[0] -= end * stop_by_speed;
        by_speed[1] += end_by_stop * stop_by_speed;
        by_force[0] += after.angle_by_force * per_inertia - end * stop_by_force;
        by_force[1] += after.angle * per_inertia + end_by_stop * stop_by_force;
        Forced {
            travel: travel + push * after.angle_by_force,
            speed: end,
            by_speed,
            by_force,
            sliding: 1.0,
        }
    }

    #[cold]
    fn resting(&self, volts: f64) -> Forced {
        Forced {
            travel: 0.0,
            speed: 0.0,
            by_speed: [0.0; 2],
            by_force: [0.0; 2],
            sliding: self.breaking_away(volts),
        }
    }

    /// The part of the noise that acts on a motor at rest: half of it at breakaway. All of it throughout would let the perfect
    /// rest in every recording drive the intensity to nothing.
    fn breaking_away(&self, volts: f64) -> f64 {
        let margin = (self.coulomb - volts.abs()) / (BREAKAWAY * self.coulomb);
        0.5 * (1.0 - margin).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn model(asymmetry: f64, gravity: [f64; 2], coulomb: f64) -> Parameters {
        Parameters {
            inertia: 6e-4,
            damping: 0.045,
            asymmetry,
            coulomb,
            offset: 0.1,
            gravity,
            delays: vec![0.0],
            process_noise: 0.01,
            reading_noise: 1e-4,
        }
    }

    /// States and volts so that the motor slides, stops and rests, stops and turns back, breaks away.
    const STATES: [(f64, f64); 12] = [
        (100.0, 12.0),
        (-100.0, 12.0),
        (0.5, -6.0),
        (-0.5, 6.0),
        (0.3, 0.0),
        (-0.3, 0.2),
        (2.0, -12.0),
        (-2.0, 12.0),
        (1e-3, -0.9),
        (0.01, 5.0),
        (-7.0, 0.0),
        (1.2, -2.0),
    ];

    #[test]
    fn the_jacobian_is_that_of_finite_differences() {
        for (asymmetry, gravity, coulomb) in [
            (0.0, [0.0; 2], 0.7),
            (0.01, [0.0; 2], 0.7),
            (0.0, [2.0, -1.0], 0.3),
            (0.0, [0.0; 2], 0.0),
        ] {
            let stepper = Stepper::new(&model(asymmetry, gravity, coulomb), &[1e-3]);
            for (speed, volts) in STATES {
                let at = |angle: f64, speed: f64| stepper.step(State { angle, speed }, volts, 0);
                let found = at(0.4, speed);
                let step = 1e-6;
                for (k, is) in [found.by_angle, found.by_speed].into_iter().enumerate() {
                    let [da, ds] = [[step, 0.0], [0.0, step]][k];
                    let (up, down) = (
                        at(0.4 + da, speed + ds).state,
                        at(0.4 - da, speed - ds).state,
                    );
                    let should = [
                        (up.angle - down.angle) / (2.0 * step),
                        (up.speed - down.speed) / (2.0 * step),
                    ];
                    for (is, should) in is.into_iter().zip(should) {
                        let close = 1e-5 * (1e-3 + should.abs());
                        assert!(
                            (is - should).abs() < close.max(2e-9),
                            "{speed} rad/s, {volts} V, by {k}: {is} for {should}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn a_step_is_two_halves_and_many_small_ones() {
        let p = model(0.01, [0.0; 2], 0.7);
        let (whole, fine) = (Stepper::new(&p, &[1e-3]), Stepper::new(&p, &[1e-6]));
        for (speed, volts) in STATES {
            let start = State { angle: 0.0, speed };
            let one = whole.step(start, volts, 0).state;
            let many = (0..1000).fold(start, |state, _| fine.step(state, volts, 0).state);
            assert!((one.angle - many.angle).abs() < 1e-9, "{speed}, {volts}");
            assert!((one.speed - many.speed).abs() < 1e-6, "{speed}, {volts}");
        }
    }
}
