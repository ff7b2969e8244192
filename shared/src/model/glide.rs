//! Many steps of a shaft that slides on, or that friction holds, under forces that do not depend on the state: three sums of
//! products each, or one, of which the products with voltage and friction are made once. They are those of
//! [`Model::step`], in its order, and so the bits are the same; a step in which the shaft might stop or start is left to that.

use super::friction::is_zero;
use super::rung::Rung;
use super::state::Motion;
use super::{Model, State};
use crate::effects::Lowered;
use crate::scalar::{Angle, Mask, Scalar};

/// A shaft that goes on as it does, with the bridge closed.
#[derive(Clone, Copy, Debug)]
pub struct Glide<'m, S: Scalar> {
    rung: &'m Rung<S>,
    effects: &'m Lowered<S>,
    counts_per_unit: S::Coefficient,
    manner: Manner,
    /// Sense of the motion that friction opposes.
    sense: S,
    /// On the shaft, against positive rotation, without friction.
    torque: S,
    /// Largest pull that friction holds.
    holding: S,
    volts: S,
    /// What voltage, and what torque and friction add to current, speed and angle.
    by_volts: [S; 3],
    by_torque: [S; 3],
}

/// What goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Manner {
    /// There is no friction.
    Free,
    /// The shaft slides, in every lane.
    Slides,
    /// Friction holds it, in every lane.
    Rests,
}

impl<S: Scalar> Model<S> {
    /// `None` where more must be looked at in each step.
    #[inline(always)]
    pub fn glide(&self, state: &State<S>) -> Option<Glide<'_, S>> {
        let needs = &self.effects.needs;
        let looked_at = needs.mean || needs.memory || needs.current || needs.sensed;
        let late = self.late > 0 || self.first.is_some();
        if looked_at || late || self.rest.coupled.is_some() || self.rest.parts > 1 {
            return None;
        }
        let forces = &self.constant;
        let sense = state.motion.speed.signum();
        let still = is_zero(sense);
        let manner = if !needs.friction {
            Manner::Free
        } else if !still.any() {
            Manner::Slides
        } else if !still.not().any() {
            Manner::Rests
        } else {
            return None;
        };
        let torque = if needs.friction {
            forces.torque + sense * forces.budget.moving
        } else {
            forces.torque
        };
        let rung = &self.rest.motor[0];
        Some(Glide {
            rung,
            effects: &self.effects,
            counts_per_unit: self.counts_per_unit,
            manner,
            sense,
            torque: forces.torque,
            holding: forces.budget.holding,
            volts: state.volts,
            by_volts: [S::zero(); 3],
            by_torque: rung.by_torque(torque),
        })
    }
}

impl<S: Scalar> Glide<'_, S> {
    /// Takes the command of the steps that follow.
    #[inline(always)]
    pub fn set(&mut self, command: S) {
        self.volts = self.effects.drive(command);
        self.by_volts = self.rung.by_volts(self.volts);
        if self.manner == Manner::Rests {
            self.by_volts[0] = self.rung.held_by_volts(self.volts);
        }
    }

    /// Where a step leads; `None` where the shaft may stop, turn back or break loose within it.
    #[inline(always)]
    pub fn step(&self, from: &Motion<S>) -> Option<Motion<S>> {
        if self.manner == Manner::Rests {
            return self.rest(from);
        }
        let [current, speed, angle] = self.rung.by_state(from);
        let (volts, torque) = (&self.by_volts, &self.by_torque);
        let current = current + volts[0] + torque[0];
        let angle = angle + volts[2] + torque[2];
        let speed = from.speed + (speed + volts[1] + torque[1]);
        let slides = S::zero().less(speed * self.sense);
        if self.manner == Manner::Slides && slides.not().any() {
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
    fn rest(&self, from: &Motion<S>) -> Option<Motion<S>> {
        let current = from.current + (self.rung.held_by_current(from.current) + self.by_volts[0]);
        let loose = self.holding.less((from.current - self.torque).abs());
        let breaks_loose = self.holding.less((current - self.torque).abs());
        if loose.or(breaks_loose).any() {
            return None;
        }
        Some(Motion { current, ..*from })
    }

    /// Leaves a state as the steps so far do.
    #[inline(always)]
    pub fn leave(&self, state: &mut State<S>, motion: Motion<S>) {
        state.motion = motion;
        state.volts = self.volts;
        state.open = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::discretise::Discretisation;
    use crate::effects::{EffectSet, Kind};
    use crate::model::Plan;
    use crate::motor::Machine;
    use crate::rng;
    use crate::scalar::Fixed;
    use crate::units::PerUnit;
    use std::format;
    use std::string::String;
    use std::vec::Vec;

    const SAMPLES: usize = 4000;

    /// Steps and how many of them were glided over; at each the text of the state.
    fn run<S: Scalar>(model: &Model<S>, glides: bool) -> (Vec<String>, usize) {
        let mut generator = rng::seeded(5);
        let (mut command, mut open) = (S::zero(), false);
        let mut state = State::<S>::default();
        let mut glided = 0;
        let mut seen = Vec::new();
        for k in 0..SAMPLES {
            if k % 23 == 0 {
                // Small ones too, at which the shaft rests.
                let size = rng::uniform::<f64>(&mut generator);
                let sign = 2.0 * rng::uniform::<f64>(&mut generator) - 1.0;
                command = S::from_f64(size * size * sign);
                open = rng::below(&mut generator, 9) == 0;
            }
            let glide = model.glide(&state).filter(|_| glides && !open);
            let next = glide.and_then(|mut glide| {
                glide.set(command);
                let next = glide.step(&state.motion)?;
                Some((glide, next))
            });
            match next {
                Some((glide, next)) => {
                    glide.leave(&mut state, next);
                    glided += 1;
                }
                None => model.step(&mut state, command, open),
            }
            seen.push(format!("{:?}", state.motion));
        }
        (seen, glided)
    }

    fn same<S: Scalar>(plan: &Plan<f64>, label: &str) -> usize {
        // What does not fit a format is no motor in it.
        let Ok(model) = Model::<S>::new(plan) else {
            return 0;
        };
        let (stepped, _) = run(&model, false);
        let (glided, steps) = run(&model, true);
        assert!(stepped == glided, "{label}");
        steps
    }

    /// With every effect, and in every format.
    #[test]
    fn gliding_is_stepping_to_the_bit() {
        let units = PerUnit::new(12.0, 240.0, 1e-3, 2000.0).expect("bases");
        let machine = Machine {
            kb: 0.05,
            damping: 0.002,
            inertia: 0.0025,
            electrical: 0.0016,
        };
        let single = Kind::ALL.iter().map(std::slice::from_ref);
        let both = [Kind::Coulomb, Kind::LoadTorque];
        for kinds in [&[][..], &both[..]].into_iter().chain(single) {
            let mut effects = EffectSet::default();
            for &kind in kinds {
                let values: Vec<f64> = kind
                    .description()
                    .parameters
                    .iter()
                    .map(|p| p.scaled(p.typical, 12.0, 240.0))
                    .collect();
                effects.push(kind, &values).expect("a valid effect");
            }
            for discretisation in [Discretisation::Exact, Discretisation::Euler] {
                let plan = Plan {
                    effects,
                    discretisation,
                    ..Plan::linear(machine, units)
                };
                let label = format!("{kinds:?}, {discretisation:?}");
                let steps = same::<f64>(&plan, &label);
                same::<f32>(&plan, &label);
                same::<Fixed>(&plan, &label);
                if kinds
                    .iter()
                    .all(|&kind| kind == Kind::Coulomb || kind == Kind::LoadTorque)
                {
                    assert!(steps > SAMPLES / 2, "{label}: only {steps}");
                }
            }
        }
    }
}
