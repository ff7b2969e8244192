//! The exact maps of a motor and its load while the flanks touch, made in scaled units (see the module above).

use super::SubstepTiming;
use super::load_friction::{Brake, Brakes};
use crate::discretise::{Discretisation, LinearMap, LinearSystem, scaled};
use crate::effects::Coupling;
use crate::error::ModelError;
use crate::motor::Machine;
use crate::scalar::{Real, Scalar, lanes};

/// Maps of one substep while the flanks touch.
#[derive(Clone, Copy, Debug)]
pub struct Touching<S: Scalar> {
    /// Length of the substep, and constants of its mean current.
    pub timing: SubstepTiming<S>,
    /// Rows of current, speed, twist, slip and angle; columns `[c, ω, x, s, v, τ]`. The bridge is closed.
    pub driven: [[S::Coefficient; 6]; 5],
    /// Rows of speed, twist, slip and angle; columns `[ω, x, s, τ]`. The bridge is open.
    pub coast: [[S::Coefficient; 4]; 4],
    /// Rows of twist and slip; columns `[x, s]`. Friction holds the motor.
    pub held: [[S::Coefficient; 2]; 2],
    /// Twist per slip while the load is free.
    pub flight: S::Coefficient,
}

lanes!(Touching {
    timing,
    driven,
    coast,
    held,
    flight
});

/// A machine split into motor and load, per unit.
pub struct Split<R> {
    /// The motor alone.
    pub motor: Machine<R>,
    /// Share of the inertia that is the load's.
    pub share: R,
    /// `Ω`, per interval.
    pub frequency: R,
    /// `2ζ`.
    pub twice_damping: R,
    /// `σ/Ω`.
    pub scale: R,
}

impl<R: Real> Split<R> {
    /// Splits a machine by its coupling.
    ///
    /// # Errors
    /// A load share that is not between 0 and 1.
    pub fn new(machine: &Machine<R>, coupling: &Coupling<R>) -> Result<Self, ModelError> {
        let one = R::from_f64(1.0);
        let share = coupling.load_share;
        if !(share > R::zero() && share < one) {
            return Err(ModelError::Parameter {
                name: "load share",
                value: share.to_f64(),
            });
        }
        let mut motor = *machine;
        motor.inertia = (one - share) * machine.inertia;
        let reduced = share * motor.inertia;
        let frequency = one / (reduced * coupling.compliance).sqrt();
        Ok(Split {
            motor,
            share,
            frequency,
            scale: one / (coupling.half_gap * frequency).max(one),
            twice_damping: coupling.damping_ratio + coupling.damping_ratio,
        })
    }

    /// Speed that a torque takes of the free load within `length` intervals.
    fn load_push(&self, machine: &Machine<R>, length: R) -> R {
        let load = R::from_f64(1.0) - self.share;
        length / machine.inertia * load / self.share
    }

    /// Discretises a substep of `length` intervals while the flanks touch.
    ///
    /// # Errors
    /// Rates that the format cannot follow.
    pub fn maps(
        &self,
        machine: &Machine<R>,
        length: R,
        how: Discretisation,
    ) -> Result<RealMaps<R>, ModelError> {
        let zero = R::zero();
        let rate = length / machine.electrical;
        let push = length / machine.inertia;
        let drag = machine.damping * push;
        let turn = self.frequency * length;
        let (x, s) = (turn, self.twice_damping * turn);
        let (mx, ms) = (self.share * x, self.share * s);
        let load = R::from_f64(1.0) - self.share;
        let behind = self.load_push(machine, length);
        let driven = LinearSystem {
            states: [
                [-rate, -(machine.kb * rate), zero, zero],
                [push, -drag, -mx, -ms],
                [zero, zero, zero, turn],
                [push, -drag, -x, -s],
            ],
            inputs: [
                [rate, zero, zero],
                [zero, -push, zero],
                [zero, zero, zero],
                [zero, -push, behind],
            ],
            speed: 1,
        };
        let coast = LinearSystem {
            states: [[-drag, -mx, -ms], [zero, zero, turn], [-drag, -x, -s]],
            inputs: [[-push, zero], [zero, zero], [-push, behind]],
            speed: 0,
        };
        let held = LinearSystem {
            states: [[zero, turn], [-(load * x), -(load * s)]],
            inputs: [[zero], [behind]],
            speed: 0,
        };
        Ok(RealMaps {
            driven: driven.step(length, how)?,
            coast: coast.step(length, how)?,
            held: held.step(length, how)?,
        })
    }
}

/// The maps of a substep in a real format, before they are lowered.
#[derive(Clone, Copy)]
pub struct RealMaps<R> {
    driven: LinearMap<R, 4, 3>,
    coast: LinearMap<R, 3, 2>,
    held: LinearMap<R, 2, 1>,
}

impl<R: Real> RealMaps<R> {
    /// The maps of a substep twice as long.
    #[must_use]
    pub fn twice(&self) -> Self {
        RealMaps {
            driven: self.driven.twice(),
            coast: self.coast.twice(),
            held: self.held.twice(),
        }
    }

    /// The multipliers of a substep of `length` intervals in the format `S`.
    ///
    /// # Errors
    /// A multiplier beyond the range of `S`.
    pub fn lower<S: Scalar>(
        &self,
        split: &Split<R>,
        machine: &Machine<R>,
        length: R,
    ) -> Result<Touching<S>, ModelError> {
        let (own, one) = (split.scale, R::from_f64(1.0));
        // The third row gives a twist in units of the state, and the third column takes one.
        let (rows, columns) = (
            [one, one, own, one, one],
            [one, one, one / own, one, one, one],
        );
        let driven = |k: usize| {
            let map = &self.driven;
            let (x, u) = match k {
                4 => (map.angle_by_states, map.angle_by_inputs),
                _ => (map.states[k], map.inputs[k]),
            };
            let row = [x[0], x[1], x[2], x[3], u[0], u[1]];
            scaled::<S, R, 6>("coupled increment", row, rows[k], columns)
        };
        let coast = |k: usize| {
            let map = &self.coast;
            let (x, u) = match k {
                3 => (map.angle_by_states, map.angle_by_inputs),
                _ => (map.states[k], map.inputs[k]),
            };
            let columns = [one, one / own, one, one];
            let row = [x[0], x[1], x[2], u[0]];
            scaled::<S, R, 4>("coupled coasting increment", row, rows[k + 1], columns)
        };
        let held = |k: usize| {
            let columns = [one / own, one];
            let row = self.held.states[k];
            scaled::<S, R, 2>("held load increment", row, rows[k + 2], columns)
        };
        let flight = split.frequency * own * length;
        let [angle_per_volt, angle_per_torque, _] = self.driven.angle_by_inputs;
        Ok(Touching {
            timing: SubstepTiming::new(
                machine,
                length,
                self.driven.inputs[0][0],
                [angle_per_volt, angle_per_torque],
            ),
            driven: [driven(0)?, driven(1)?, driven(2)?, driven(3)?, driven(4)?],
            coast: [coast(0)?, coast(1)?, coast(2)?, coast(3)?],
            held: [held(0)?, held(1)?],
            flight: S::coefficient(flight.to_f64()),
        })
    }

    /// The responses to dry friction on the load. Where the substep is so long that the load swings back within it, motor and load lose
    /// their speed together.
    pub fn brakes<S: Scalar>(
        &self,
        split: &Split<R>,
        machine: &Machine<R>,
        length: R,
    ) -> Result<Brakes<S>, ModelError> {
        let (zero, one) = (R::zero(), R::from_f64(1.0));
        let together = split.frequency * length > R::from_f64(core::f64::consts::FRAC_PI_2);
        let half = length * R::from_f64(0.5);
        let brake = |response: [R; 5]| {
            let [_, speed, _, slip, _] = response;
            let taken = slip - speed;
            let (per_torque, response) = if together {
                let rigid = length / machine.inertia * (one - split.share);
                (rigid, [zero, -one, zero, zero, -half])
            } else {
                (taken, response.map(|by| by / taken))
            };
            Ok(Brake {
                per_torque: scaled::<S, R, 1>("load friction", [per_torque], one, [one])?[0],
                response: scaled::<S, R, 5>(
                    "response to load friction",
                    response,
                    one,
                    [one, one, split.scale, one, one],
                )?,
            })
        };
        let (driven, coast, held) = (&self.driven, &self.coast, &self.held);
        let [current, speed, twist, slip] = [0, 1, 2, 3].map(|k| driven.inputs[k][2]);
        let driven = [current, speed, twist, slip, driven.angle_by_inputs[2]];
        let [speed, twist, slip] = [0, 1, 2].map(|k| coast.inputs[k][1]);
        let coasting = [zero, speed, twist, slip, coast.angle_by_inputs[1]];
        let held = [zero, zero, held.inputs[0][0], held.inputs[1][0], zero];
        let behind = split.load_push(machine, length);
        let twist = split.frequency * half * behind;
        Ok(Brakes {
            driven: brake(driven)?,
            coasting: brake(coasting)?,
            held: brake(held)?,
            free: brake([zero, zero, twist, behind, zero])?,
        })
    }
}
