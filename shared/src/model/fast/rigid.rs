//! A motor that is one rigid body, with Coulomb friction and a constant load, behind a bridge with dead time: as much of [`Model`](crate::model::Model) as
//! fits beside a recording on a small device. It has the same maps and the same friction, so the same bits.

use super::dead_time::DeadTime;
use super::friction_event::step_with_events;
use crate::discretise::Discretisation;
use crate::effects::Budget;
use crate::error::ModelError;
use crate::model::Motion;
use crate::model::dyadic::{LEVELS, build_step_maps};
use crate::model::friction::{Forces, direction, is_zero};
use crate::model::step_map::StepMap;
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
    /// What the bridge's dead time takes against the current, V.
    pub dead_time: R,
    /// The command that is the whole supply, V.
    pub full: R,
    /// Resistance of the supply as a part of the winding's: a bridge at the duty `d` takes `d·i` of it, so the winding loses `d²` of that.
    pub supply: R,
    /// Waves of the bridge's carrier in an interval; at least one where dead time takes anything.
    pub carriers: R,
    /// Bases of the per-unit system; one interval is one step.
    pub units: PerUnit<R>,
}

/// Coefficients of a rigid motor in the number format `S`. Immutable.
#[derive(Clone, Copy, Debug)]
pub struct Rigid<S: Scalar> {
    motor: [StepMap<S>; LEVELS],
    /// The load, and friction.
    forces: Forces<S>,
    dead_time: DeadTime<S>,
    /// See [`RigidPlan::supply`].
    supply: S::Coefficient,
    /// Part of the supply by command.
    duty_by_command: S::Coefficient,
    /// Whether there is a supply that gives way.
    sags: bool,
    /// Whether there is friction.
    has_friction: bool,
    /// Whether there is neither friction, nor a load, nor dead time.
    free: bool,
    counts_per_unit: S::Coefficient,
}

impl<S: Scalar> Rigid<S> {
    /// A motor that nothing moves, of zeros in its format; to be [`set`](Self::set).
    pub const fn of(zero: S, none: S::Coefficient) -> Self {
        Rigid {
            motor: [StepMap::of(none); LEVELS],
            forces: Forces {
                volts: zero,
                torque: zero,
                budget: Budget {
                    moving: zero,
                    holding: zero,
                    bias: zero,
                },
            },
            dead_time: DeadTime::none(zero, none),
            supply: none,
            duty_by_command: none,
            sags: false,
            has_friction: false,
            free: false,
            counts_per_unit: none,
        }
    }
}

impl<S: Scalar<Mask = bool>> Rigid<S> {
    /// Discretises and lowers a plan, in place. After an error the coefficients are not usable.
    ///
    /// # Errors
    /// A parameter that is not physical, or a coefficient beyond the range of `S`.
    pub fn set<R: Real>(&mut self, plan: &RigidPlan<R>) -> Result<(), ModelError> {
        plan.machine.check()?;
        let units = &plan.units;
        self.has_friction = plan.coulomb != R::zero();
        let loses = plan.dead_time != R::zero();
        self.sags = plan.supply != R::zero();
        self.free = !self.has_friction && !loses && !self.sags && plan.load == R::zero();
        let depth = if self.has_friction { LEVELS - 1 } else { 0 };
        let machine = plan.machine.lower(units);
        let one = R::from_f64(1.0);
        build_step_maps(&mut self.motor, &machine, one, depth, Discretisation::Exact)?;
        self.forces.torque = units.number(plan.load, Quantity::Torque);
        self.forces.budget = Budget::even(units.number(plan.coulomb, Quantity::Torque));
        self.counts_per_unit = S::coefficient_of(units.counts_per_unit());
        let none = S::Coefficient::default();
        self.dead_time = DeadTime::none(S::zero(), none);
        if loses {
            let waves = machine.electrical * plan.carriers;
            let by_volts = self.motor[0].current_by_volts();
            let lost = plan.dead_time / units.volts;
            self.dead_time.set(lost, waves, by_volts);
        }
        self.supply = S::coefficient_of(plan.supply);
        self.duty_by_command = S::coefficient_of(units.volts / plan.full);
        Ok(())
    }

    /// Discretises and lowers a plan.
    ///
    /// # Errors
    /// Those of [`set`](Self::set).
    pub fn new<R: Real>(plan: &RigidPlan<R>) -> Result<Self, ModelError> {
        let mut rigid = Rigid::of(S::zero(), S::Coefficient::default());
        rigid.set(plan)?;
        Ok(rigid)
    }

    /// Increments of current, speed and angle in an interval with the bridge closed, each by current, speed, command and
    /// torque.
    pub fn increments(&self) -> [&[S::Coefficient; 4]; 3] {
        self.motor[0].increments()
    }

    /// Counts in a unit of angle.
    pub fn counts_per_unit(&self) -> S::Coefficient {
        self.counts_per_unit
    }

    /// Whether there is neither friction, nor a load, nor dead time.
    pub fn is_free(&self) -> bool {
        self.free
    }

    /// Sense of the motion at `speed`, and the increments of current, speed and angle by load, friction and dead time in each interval
    /// in which the shaft turns on in that sense, and the current, if there is dead time, keeps its sense; `None` if
    /// friction may hold it.
    pub fn sliding(&self, speed: S, current: S) -> Option<(S, [S; 3])> {
        let sense = speed.signum();
        let torque = if !self.has_friction {
            self.forces.torque
        } else if sense.less(S::zero()) || S::zero().less(sense) {
            self.forces.torque + sense * self.forces.budget.moving
        } else {
            return None;
        };
        let mut by = self.motor[0].by_torque(torque);
        if self.loses() {
            let lost = self.dead_time.lost * current.signum();
            for (by, lost) in by.iter_mut().zip(self.motor[0].by_volts(-lost)) {
                *by = *by + lost;
            }
        }
        Some((sense, by))
    }

    /// Whether a bridge with dead time stands before it.
    #[inline(always)]
    pub fn loses(&self) -> bool {
        self.dead_time.is_any()
    }

    /// Mean of the current over an interval beyond which the dead time takes all that it ever does.
    pub fn sure_current(&self) -> S {
        self.dead_time.sure
    }

    /// Whether the supply gives way.
    #[inline(always)]
    pub fn sags(&self) -> bool {
        self.sags
    }

    /// The duty that the winding sees of `command`.
    #[inline(never)]
    fn behind_bridge(&self, motion: &Motion<S>, command: S) -> S {
        let Forces { torque, budget, .. } = self.forces;
        let map = &self.motor[0];
        let sense = direction(motion.speed, motion.current - torque, &budget);
        let held = self.has_friction && is_zero(sense);
        let by = if held {
            map.step_stuck(motion.current, command, false)
        } else {
            let against = torque + sense * budget.moving;
            map.free_current_and_angle(motion, command, against, false)
                .0
        };
        let half = S::from_f64(0.5);
        let duty = command.times(self.duty_by_command);
        let mut mean = motion.current + by * half;
        let mut sag = S::zero();
        if self.sags {
            // What is lost lowers the current that loses it: two terms of the series.
            let by_volts = map.current_by_volts()[usize::from(held)];
            let square = duty * duty;
            let first = (square * mean).times(self.supply);
            let less = mean - first.times(by_volts) * half;
            sag = (square * less).times(self.supply);
            mean = less;
        }
        if self.loses() {
            sag = sag + self.dead_time.of(duty, mean, held);
        }
        command - sag
    }

    /// Advances by one interval with `command` held; `open` while the bridge is open.
    #[inline(always)]
    pub fn step(&self, motion: &mut Motion<S>, command: S, open: bool) {
        let scale = self.counts_per_unit;
        let command = if (self.loses() || self.sags) && !open {
            self.behind_bridge(motion, command)
        } else {
            command
        };
        if !self.has_friction {
            let by = self.motor[0].step_free(motion, command, self.forces.torque, open);
            motion.current = motion.current + by.current;
            motion.speed = motion.speed + by.speed;
            motion.angle = motion.angle.advance(by.angle, scale);
            return;
        }
        let forces = Forces {
            volts: command,
            ..self.forces
        };
        step_with_events(&self.motor, motion, &forces, open, scale);
    }
}
