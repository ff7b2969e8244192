//! Many steps under forces that do not depend on the state, of a shaft that slides on or that friction holds. A step is three
//! sums of products, or one if the shaft is stuck; the products with voltage and friction are made once. They are those of
//! [`Model::step`], in its order, so the bits are the same. A step in which the shaft might stop or start is left to
//! [`Model::step`].

use crate::effects::Lowered;
use crate::model::friction::is_zero;
use crate::model::step_map::StepMap;
use crate::model::{Model, Motion, State};
use crate::scalar::{Angle, Mask, Scalar};

/// A shaft that stays in its regime of friction, with the bridge closed.
#[derive(Clone, Copy, Debug)]
pub struct ConstantForce<'m, S: Scalar> {
    map: &'m StepMap<S>,
    effects: &'m Lowered<S>,
    counts_per_unit: S::Coefficient,
    regime: Regime,
    /// Sense of the motion that friction opposes.
    sense: S,
    /// Torque on the shaft without friction, against positive rotation.
    torque: S,
    /// Largest pull that friction holds.
    holding: S,
    volts: S,
    /// Increments of current, speed and angle by the voltage, and by torque and friction.
    by_volts: [S; 3],
    by_torque: [S; 3],
}

/// The regime of friction.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Regime {
    /// There is no friction.
    Frictionless,
    /// The shaft slides, in every lane.
    Sliding,
    /// Friction holds it, in every lane.
    Stuck,
}

impl<S: Scalar> Model<S> {
    /// The fast form of the steps that follow, with the bridge closed; `None` where effects depend on the state, or
    /// lanes differ in their regime.
    #[inline(always)]
    pub fn constant_force(&self, state: &State<S>) -> Option<ConstantForce<'_, S>> {
        let needs = &self.effects.needs;
        let depends_on_state = needs.mean || needs.memory || needs.current || needs.sensed;
        let late = self.late > 0 || self.first.is_some();
        if depends_on_state || late || self.rest.coupled.is_some() || self.rest.substeps > 1 {
            return None;
        }
        let forces = &self.constant;
        let sense = state.motion.speed.signum();
        let at_rest = is_zero(sense);
        let regime = if !needs.friction {
            Regime::Frictionless
        } else if !at_rest.any() {
            Regime::Sliding
        } else if !at_rest.not().any() {
            Regime::Stuck
        } else {
            return None;
        };
        let torque = if needs.friction {
            forces.torque + sense * forces.budget.moving
        } else {
            forces.torque
        };
        let map: &StepMap<S> = self.rest.motor.whole();
        Some(ConstantForce {
            map,
            effects: &self.effects,
            counts_per_unit: self.counts_per_unit,
            regime,
            sense,
            torque: forces.torque,
            holding: forces.budget.holding,
            volts: state.volts,
            by_volts: [S::zero(); 3],
            by_torque: map.by_torque(torque),
        })
    }
}

impl<S: Scalar> ConstantForce<'_, S> {
    /// Sets the command of the steps that follow.
    #[inline(always)]
    pub fn set_command(&mut self, command: S) {
        self.volts = self.effects.drive(command);
        self.by_volts = self.map.by_volts(self.volts);
        if self.regime == Regime::Stuck {
            self.by_volts[0] = self.map.held_by_volts(self.volts);
        }
    }

    /// The motion at the end of a step; `None` where the shaft may stop, turn back or break loose within it.
    #[inline(always)]
    pub fn step(&self, from: &Motion<S>) -> Option<Motion<S>> {
        if self.regime == Regime::Stuck {
            return self.step_stuck(from);
        }
        let [current, speed, angle] = self.map.by_state(from);
        let (volts, torque) = (&self.by_volts, &self.by_torque);
        let current = current + volts[0] + torque[0];
        let angle = angle + volts[2] + torque[2];
        let speed = from.speed + (speed + volts[1] + torque[1]);
        let slides_on = S::zero().less(speed * self.sense);
        if self.regime == Regime::Sliding && slides_on.not().any() {
            return None;
        }
        Some(Motion {
            current: from.current + current,
            speed,
            angle: from.angle.advance(angle, self.counts_per_unit),
            ..*from
        })
    }

    #[inline(always)]
    fn step_stuck(&self, from: &Motion<S>) -> Option<Motion<S>> {
        let current = from.current + (self.map.held_by_current(from.current) + self.by_volts[0]);
        let loose = self.holding.less((from.current - self.torque).abs());
        let breaks_loose = self.holding.less((current - self.torque).abs());
        if loose.or(breaks_loose).any() {
            return None;
        }
        Some(Motion { current, ..*from })
    }

    /// Writes the motion that the steps reached back into the state.
    #[inline(always)]
    pub fn store(&self, state: &mut State<S>, motion: Motion<S>) {
        state.motion = motion;
        state.volts = self.volts;
        state.open = false;
    }
}
