//! A simulated motor for tests of the application and for images without a bench.
//!
//! Plain equations in SI, integrated in short steps; it shares nothing with the model that is fitted to it. What the host's
//! virtual bench can do (every effect of the catalogue), this does not: an image reaches that over a link instead.

mod switched;

use switched::Wave;

/// Steps of the integration in a control period: waves of the bridge's carrier.
pub const CARRIERS: u32 = 20;

/// A brushed motor behind an H bridge, with an encoder.
#[derive(Debug, Clone)]
pub struct Motor {
    /// V.
    pub supply: f32,
    /// Ω, of the supply and its leads.
    pub supply_resistance: f32,
    /// Dead times of both legs in a wave of the carrier, as a part of it: what they take of the supply, against a current that flows all the
    /// time. Without any the bridge gives its mean.
    pub dead_time: f32,
    /// Ω.
    pub resistance: f32,
    /// H.
    pub inductance: f32,
    /// N·m/A, and V·s/rad.
    pub constant: f32,
    /// kg·m².
    pub inertia: f32,
    /// N·m·s/rad.
    pub viscous: f32,
    /// N·m.
    pub coulomb: f32,
    /// Amplitude of the cogging, N·m, with [`cogging_order`](Self::cogging_order) periods a revolution.
    pub cogging: f32,
    /// Periods a revolution.
    pub cogging_order: f32,
    /// Counts a revolution.
    pub counts_per_rev: f32,
    /// Its state.
    pub state: Shaft,
}

/// State of the motor.
#[derive(Debug, Clone, Default)]
pub struct Shaft {
    /// A.
    pub current: f32,
    /// Largest of the current in the last [`Motor::advance`], A.
    pub peak: f32,
    /// Voltage of the supply at the bridge, V; zero before it has driven.
    pub bus: f32,
    /// rad/s.
    pub speed: f32,
    /// Whole counts.
    pub count: i32,
    /// The rest, in counts from 0 to 1.
    pub fraction: f32,
    /// Within a revolution, rad.
    pub angle: f32,
}

/// A motor of 24 V and some ten watts, on a 2000-count encoder.
pub const SMALL: Motor = Motor {
    supply: 24.0,
    supply_resistance: 0.0,
    dead_time: 0.0,
    resistance: 2.3,
    inductance: 1.1e-3,
    constant: 0.052,
    inertia: 1.9e-5,
    viscous: 1.2e-5,
    coulomb: 0.008,
    cogging: 0.0,
    cogging_order: 14.0,
    counts_per_rev: 2000.0,
    state: Shaft {
        current: 0.0,
        peak: 0.0,
        bus: 0.0,
        speed: 0.0,
        count: 0,
        fraction: 0.4,
        angle: 0.0,
    },
};

impl Motor {
    /// Moves on by `seconds` with a duty in Q15, or with an open bridge.
    pub fn advance(&mut self, duty: Option<i16>, seconds: f32) {
        let (dt, decay) = self.wave(seconds);
        self.state.peak = 0.0;
        for _ in 0..CARRIERS {
            let current = self.electrical(duty, dt, decay);
            self.mechanical(current, dt);
        }
    }

    /// The same while something holds the shaft.
    pub fn hold(&mut self, duty: Option<i16>, seconds: f32) {
        let (dt, decay) = self.wave(seconds);
        (self.state.speed, self.state.peak) = (0.0, 0.0);
        for _ in 0..CARRIERS {
            self.electrical(duty, dt, decay);
        }
    }

    /// Length of a wave, s, and what is left of a current after it.
    fn wave(&self, seconds: f32) -> (f32, f32) {
        let dt = seconds / CARRIERS as f32;
        (dt, libm::expf(-dt * self.resistance / self.inductance))
    }

    /// Largest of the current in the last step of time, mA.
    pub fn peak_ma(&self) -> i32 {
        (self.state.peak * 1000.0) as i32
    }

    /// mA.
    pub fn current_ma(&self) -> i32 {
        (self.state.current * 1000.0) as i32
    }

    /// Voltage of the supply at the bridge, mV.
    pub fn supply_mv(&self) -> u16 {
        let bus = if self.state.bus > 0.0 {
            self.state.bus
        } else {
            self.supply
        };
        (bus * 1000.0) as u16
    }

    /// The current over a wave of the carrier, while the speed is held; returns what makes torque.
    fn electrical(&mut self, duty: Option<i16>, dt: f32, decay: f32) -> f32 {
        let state = &mut self.state;
        let Some(duty) = duty else {
            state.current = 0.0;
            return 0.0;
        };
        let part = f32::from(duty) / 32_768.0;
        state.bus = self.supply - self.supply_resistance * part * state.current;
        let emf = self.constant * state.speed;
        if self.dead_time > 0.0 {
            let wave = Wave {
                bus: state.bus,
                duty: part,
                length: dt,
                dead: 0.5 * self.dead_time * dt,
                emf,
                resistance: self.resistance,
                inductance: self.inductance,
            };
            let (current, mean, peak) = wave.pass(state.current);
            state.current = current;
            state.peak = state.peak.max(peak);
            return mean;
        }
        let end = (state.bus * part - emf) / self.resistance;
        state.current = end + (state.current - end) * decay;
        state.peak = state.peak.max(state.current.abs());
        state.current
    }

    /// Semi-implicit Euler; friction takes up to all of the momentum.
    fn mechanical(&mut self, current: f32, dt: f32) {
        let state = &mut self.state;
        let cogging = if self.cogging == 0.0 {
            0.0
        } else {
            self.cogging * libm::sinf(self.cogging_order * state.angle)
        };
        let torque = self.constant * current - self.viscous * state.speed - cogging;
        let free = state.speed + torque / self.inertia * dt;
        let grip = self.coulomb / self.inertia * dt;
        let speed = if free > grip {
            free - grip
        } else if free < -grip {
            free + grip
        } else {
            0.0
        };
        let turned = 0.5 * (state.speed + speed) * dt;
        state.speed = speed;
        let tau = core::f32::consts::TAU;
        state.angle += turned;
        if state.angle.abs() > tau {
            state.angle -= tau * state.angle.signum();
        }
        state.fraction += turned * self.counts_per_rev / tau;
        let whole = libm::floorf(state.fraction);
        state.fraction -= whole;
        state.count = state.count.wrapping_add(whole as i32);
    }
}
