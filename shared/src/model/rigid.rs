//! A motor that is one rigid body, with Coulomb friction and a constant load: as much of [`Model`](super::Model) as fits
//! beside a recording on a small device. The same maps and the same friction, and so the same bits.

use super::friction::Forces;
use super::located::slide_and_stick;
use super::rung::{self, RUNGS, Rung};
use super::state::Motion;
use crate::discretise::Discretisation;
use crate::effects::Budget;
use crate::error::ModelError;
use crate::motor::Machine;
use crate::scalar::{Angle, Real, Scalar};
use crate::units::{PerUnit, Quantity};

/// What a [`Rigid`] motor is made of, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidPlan<R> {
    /// The linear machine.
    pub machine: Machine<R>,
    /// Coulomb friction, V referred to the winding.
    pub coulomb: R,
    /// Constant torque against positive rotation, V referred to the winding.
    pub load: R,
    /// Bases of the per-unit system; one interval is one step.
    pub units: PerUnit<R>,
}

/// Coefficients of a rigid motor in the number format `S`. Immutable.
#[derive(Clone, Copy, Debug)]
pub struct Rigid<S: Scalar> {
    motor: [Rung<S>; RUNGS],
    /// The load, and friction; a motor without friction takes the short way.
    forces: Forces<S>,
    rubs: bool,
    /// Neither friction nor a load.
    free: bool,
    counts_per_unit: S::Coefficient,
}

impl<S: Scalar> Rigid<S> {
    /// A motor that nothing moves, of zeros in its format, to be [`set`](Self::set).
    pub const fn of(zero: S, none: S::Coefficient) -> Self {
        Rigid {
            motor: [Rung::of(none); RUNGS],
            forces: Forces {
                volts: zero,
                torque: zero,
                budget: Budget {
                    moving: zero,
                    holding: zero,
                    bias: zero,
                },
            },
            rubs: false,
            free: false,
            counts_per_unit: none,
        }
    }
}

impl<S: Scalar<Mask = bool>> Rigid<S> {
    /// Discretises and lowers a plan, in place. After an error it is no motor.
    ///
    /// # Errors
    /// A parameter that is not physical, or a coefficient beyond the range of `S`.
    pub fn set<R: Real>(&mut self, plan: &RigidPlan<R>) -> Result<(), ModelError> {
        plan.machine.check()?;
        let units = &plan.units;
        self.rubs = plan.coulomb != R::zero();
        self.free = !self.rubs && plan.load == R::zero();
        let depth = if self.rubs { RUNGS - 1 } else { 0 };
        let machine = plan.machine.lower(units);
        let one = R::from_f64(1.0);
        rung::bare_ladder(&mut self.motor, &machine, one, depth, Discretisation::Exact)?;
        self.forces.torque = units.number(plan.load, Quantity::Torque);
        self.forces.budget = Budget::even(units.number(plan.coulomb, Quantity::Torque));
        self.counts_per_unit = S::coefficient_of(units.counts_per_unit());
        Ok(())
    }

    /// [`set`](Self::set) from nothing.
    ///
    /// # Errors
    /// As there.
    pub fn new<R: Real>(plan: &RigidPlan<R>) -> Result<Self, ModelError> {
        let mut rigid = Rigid::of(S::zero(), S::Coefficient::default());
        rigid.set(plan)?;
        Ok(rigid)
    }

    /// What current, speed, command and torque each add to current, speed and angle in an interval with the bridge closed.
    pub fn increments(&self) -> [&[S::Coefficient; 4]; 3] {
        self.motor[0].increments()
    }

    /// Counts in a unit of angle.
    pub fn counts_per_unit(&self) -> S::Coefficient {
        self.counts_per_unit
    }

    /// Whether there is neither friction nor a load.
    pub fn is_free(&self) -> bool {
        self.free
    }

    /// Sense of the motion at `speed`, and what load and friction add to current, speed and angle in each interval for as
    /// long as the shaft turns on in that sense; none if friction may hold it.
    pub fn turning(&self, speed: S) -> Option<(S, [S; 3])> {
        let sense = speed.signum();
        let torque = if !self.rubs {
            self.forces.torque
        } else if sense.less(S::zero()) || S::zero().less(sense) {
            self.forces.torque + sense * self.forces.budget.moving
        } else {
            return None;
        };
        Some((sense, self.motor[0].by_torque(torque)))
    }

    /// Advances by one interval with `command` held; `open` while the bridge is open.
    #[inline(always)]
    pub fn step(&self, motion: &mut Motion<S>, command: S, open: bool) {
        let scale = self.counts_per_unit;
        if !self.rubs {
            let by = self.motor[0].slide(motion, command, self.forces.torque, open);
            motion.current = motion.current + by.current;
            motion.speed = motion.speed + by.speed;
            motion.angle = motion.angle.advance(by.angle, scale);
            return;
        }
        let forces = Forces {
            volts: command,
            ..self.forces
        };
        slide_and_stick(&self.motor, motion, &forces, open, scale);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{EffectSet, Kind};
    use crate::model::{Model, Plan, State};
    use crate::rng;
    use crate::scalar::Fixed;

    const SAMPLES: usize = 3_000;

    /// Angles of both models over random commands with coasting, in units of their formats' text.
    fn angles<S: Scalar<Mask = bool>>(plan: &RigidPlan<f64>) -> (Vec<String>, Vec<String>) {
        let mut effects = EffectSet::default();
        effects.push(Kind::Coulomb, &[plan.coulomb]).unwrap();
        effects.push(Kind::LoadTorque, &[plan.load]).unwrap();
        let whole = Model::<S>::new(&Plan {
            effects,
            ..Plan::linear(plan.machine, plan.units)
        })
        .unwrap();
        let rigid = Rigid::<S>::new(plan).unwrap();
        let (mut state, mut motion) = (State::default(), Motion::default());
        let mut rng = rng::seeded(7);
        let (mut command, mut open) = (S::zero(), false);
        let mut seen = (Vec::new(), Vec::new());
        for k in 0..SAMPLES {
            if k % 37 == 0 {
                command = S::from_f64(rng::uniform::<f64>(&mut rng) * 1.6 - 0.8);
                open = rng::below(&mut rng, 5) == 0;
            }
            whole.step(&mut state, command, open);
            rigid.step(&mut motion, command, open);
            seen.0.push(format!("{:?}", state.motion.angle));
            seen.1.push(format!("{:?}", motion.angle));
        }
        seen
    }

    #[test]
    fn it_moves_bit_for_bit_as_the_whole_model_does() {
        for (coulomb, load) in [(0.0, 0.0), (0.9, 0.0), (0.0, 0.4), (1.3, -0.5)] {
            let plan = RigidPlan {
                machine: Machine {
                    kb: 0.03,
                    damping: 0.002,
                    inertia: 0.0011,
                    electrical: 0.7e-3,
                },
                coulomb,
                load,
                units: PerUnit::new(24.0, 1024.0, 1e-3, 4096.0).unwrap(),
            };
            let (whole, rigid) = angles::<f64>(&plan);
            assert!(
                whole == rigid,
                "f64 with friction {coulomb} V, load {load} V"
            );
            let (whole, rigid) = angles::<f32>(&plan);
            assert!(
                whole == rigid,
                "f32 with friction {coulomb} V, load {load} V"
            );
            let (whole, rigid) = angles::<Fixed>(&plan);
            assert!(
                whole == rigid,
                "fixed point with friction {coulomb} V, load {load} V"
            );
        }
    }
}
