//! Moves the plant forward in time, with every stop, release and contact located.
//!
//! A substep in which the shaft stops, the torque outgrows the friction that holds it, a flank touches
//! or parts, or a law bends sharply is cut where that happens (Filippov's solution, as in Karnopp's
//! friction model but without his velocity band). Between such cuts the right-hand side is smooth and
//! the method keeps its order.

use super::BenchError;
use super::plant::{Feed, Grip, Plant, State};

/// Substeps in the shortest time constant at [`DEFAULT_SUBSTEP_HZ`].
const STEPS_PER_TIME_CONSTANT: f64 = 4.0;
/// Times as many where a bridge switches: after each of its edges the current is far from rest.
const FINER_BEHIND_A_BRIDGE: f64 = 4.0;
/// The substep rate unless the bench asks for another, Hz.
pub(super) const DEFAULT_SUBSTEP_HZ: f64 = 40_000.0;
/// Shorter substeps than this would take minutes, and mean that some parameter is far off, s.
const SHORTEST_STEP_S: f64 = 2e-7;
/// A stop, a release or a bend is located to this share of the substep.
const EVENT_TOLERANCE: f64 = 1e-9;

impl Plant<'_> {
    /// Advances by `duration` s while the bridge feeds the armature with `feed`.
    ///
    /// # Errors
    /// [`BenchError::TooStiff`].
    pub(super) fn advance(&mut self, feed: Feed, duration: f64) -> Result<(), BenchError> {
        match feed {
            Feed::Volts(_) => {}
            Feed::Amps(current) => self.state.current = current,
            Feed::Open => self.state.current = 0.0,
        }
        self.drive_v = self.driven(feed);
        if self.grip == Grip::Held {
            self.settle();
        }
        self.look_around();
        let mut left = duration;
        while left > 0.0 {
            let longest = self.longest_step(feed);
            if longest < SHORTEST_STEP_S {
                return Err(BenchError::TooStiff { step_s: longest });
            }
            let steps = (left / longest).ceil();
            let until_edge = self.connect(feed);
            let taken = self.step(feed, (left / steps).min(until_edge));
            self.clock_s += taken;
            left -= taken;
        }
        Ok(())
    }

    /// One substep of `dt` s, or less if the right-hand side bends within; returns the time taken.
    fn step(&mut self, feed: Feed, dt: f64) -> f64 {
        let whole = self.runge_kutta(feed, dt);
        if !self.bends_before(&whole) {
            self.state = whole;
            return dt;
        }
        let (mut before, mut after) = (0.0, dt);
        while after - before > EVENT_TOLERANCE * dt {
            let middle = 0.5 * (before + after);
            if self.bends_before(&self.runge_kutta(feed, middle)) {
                after = middle;
            } else {
                before = middle;
            }
        }
        let bend = self.runge_kutta(feed, after);
        let settles = self.grip_changes(&bend);
        let load_settles = self.load_grip_changes(&bend);
        self.state = bend;
        if settles {
            self.settle();
        }
        if load_settles {
            self.settle_load();
        }
        self.look_around();
        after
    }

    /// Switches the bridge, if one switches; returns the time to its next edge, s.
    fn connect(&mut self, feed: Feed) -> f64 {
        let (Some((index, bridge)), Feed::Volts(command)) = (self.bridge, feed) else {
            self.legs = None;
            return f64::INFINITY;
        };
        let mean = self.behind(command, &self.effects[..index]);
        let (until_edge, legs) = bridge.until_edge(mean, self.clock_s);
        self.legs = Some(legs);
        // What the current chooses may differ from the last stretch without a bend of anything.
        self.look_around();
        until_edge
    }

    /// Notes which flank, which pieces of the effects' laws and which side of the bridge apply now.
    fn look_around(&mut self) {
        self.flank = self.flank_at(&self.state);
        self.pieces = self.pieces_at(&self.state);
        self.side = self.side_at(&self.state);
    }

    /// True if the right-hand side has a kink or a jump between the present state and `next`.
    fn bends_before(&self, next: &State) -> bool {
        self.grip_changes(next)
            || self.load_grip_changes(next)
            || self.flank_at(next) != self.flank
            || self.pieces_at(next) != self.pieces
            || self.side_at(next) != self.side
    }

    /// True if the shaft has stopped sliding, or the torque exceeds the holding friction.
    fn grip_changes(&self, state: &State) -> bool {
        match self.grip {
            Grip::None => false,
            Grip::Sliding(direction) => state.speed * direction < 0.0,
            Grip::Held => !self.holds(state),
        }
    }

    /// True if the load has stopped sliding, or the torque on it exceeds the friction that holds it.
    fn load_grip_changes(&self, state: &State) -> bool {
        match self.load_grip {
            Grip::None => false,
            Grip::Sliding(direction) => state.load_speed * direction < 0.0,
            Grip::Held => self.on_load(state).1,
        }
    }

    /// Torque on the load, N·m, but for its friction, and whether it exceeds that.
    fn on_load(&self, state: &State) -> (f64, bool) {
        let torque = self.torques(state, &self.winding(state)).shaft;
        let friction = self.shaft.map_or(0.0, |shaft| shaft.friction_n_m);
        (torque, torque.abs() > friction)
    }

    /// Decides if friction holds a load at rest, or which way it slides.
    fn settle_load(&mut self) {
        self.state.load_speed = 0.0;
        self.load_grip = match self.on_load(&self.state) {
            (torque, true) => Grip::Sliding(torque.signum()),
            _ => Grip::Held,
        };
    }

    fn holds(&self, state: &State) -> bool {
        let torques = self.torques(state, &self.winding(state));
        let direction = torques.net.signum();
        torques.net.abs() <= self.budget(direction, 0.0, torques.transmitted, state.angle)
    }

    /// Decides if friction holds a shaft at rest, or which way it slides.
    fn settle(&mut self) {
        self.state.speed = 0.0;
        self.grip = if self.holds(&self.state) {
            Grip::Held
        } else {
            let torques = self.torques(&self.state, &self.winding(&self.state));
            Grip::Sliding(torques.net.signum())
        };
    }

    /// The classical fourth-order method (Hairer, Nørsett and Wanner, "Solving ODEs I", table II.1.2).
    fn runge_kutta(&self, feed: Feed, dt: f64) -> State {
        let state = &self.state;
        let k1 = self.rate(feed, state);
        let k2 = self.rate(feed, &state.ahead(&k1, 0.5 * dt));
        let k3 = self.rate(feed, &state.ahead(&k2, 0.5 * dt));
        let k4 = self.rate(feed, &state.ahead(&k3, dt));
        let sixth = dt / 6.0;
        state
            .ahead(&k1, sixth)
            .ahead(&k2, 2.0 * sixth)
            .ahead(&k3, 2.0 * sixth)
            .ahead(&k4, sixth)
    }

    /// The longest substep that resolves the fastest dynamics at this instant, s.
    fn longest_step(&self, feed: Feed) -> f64 {
        let mut fastest = self.machine.viscous_n_m_s / self.motor_inertia_kg_m2;
        fastest += self.shaft.map_or(0.0, |shaft| shaft.stiffness_per_s());
        if let Feed::Volts(_) = feed {
            let winding = self.winding(&self.state);
            let speed_constants = winding.kt_n_m_a * winding.kb_v_s_rad;
            fastest += winding.resistance_ohm / winding.inductance_h;
            fastest += (speed_constants / (winding.inductance_h * self.motor_inertia_kg_m2)).sqrt();
        }
        for (index, effect) in self.effects.iter().enumerate() {
            fastest += effect.stiffness_per_s(&self.at(index, &self.state));
        }
        if self.bridge.is_some() {
            fastest *= FINER_BEHIND_A_BRIDGE;
        }
        let refinement = self.substep_hz / DEFAULT_SUBSTEP_HZ;
        1.0 / self
            .substep_hz
            .max(STEPS_PER_TIME_CONSTANT * refinement * fastest)
    }
}
