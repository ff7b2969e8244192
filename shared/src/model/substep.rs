//! One substep: moved under its predicted forces, or halved.

use super::Model;
use super::dyadic::LEVELS;
use super::friction::{Forces, step_sliding, step_with_events};
use super::mechanics::{Increment, Mechanics};
use super::predict::Prediction;
use super::state::{Motion, State};
use super::substep_iter::SubstepIter;
use crate::scalar::{Angle, Mask, Scalar};

impl<S: Scalar> Model<S> {
    /// Takes a substep of `level` with the drive at `volts`.
    pub(super) fn substep<M: Mechanics<S>>(
        &self,
        mechanics: &M,
        level: usize,
        state: &mut State<S>,
        volts: S,
        open: bool,
    ) {
        S::routine(
            #[inline(always)]
            || {
                let needs = self.effects.needs;
                if !(needs.mean || needs.memory) {
                    let forces = Forces {
                        volts,
                        ..self.constant
                    };
                    self.move_under(mechanics, level, &mut state.motion, &forces, open);
                    return;
                }
                let mut substeps = SubstepIter::new(level, LEVELS - 1);
                while let Some(level) = substeps.next() {
                    let timing = mechanics.timing(level);
                    let start = self.start(state, volts, timing, open);
                    let forces = if needs.mean {
                        let Prediction {
                            forces,
                            needs_halving,
                        } = self.predict(mechanics, level, state, &start, volts, open);
                        if needs_halving.any() && substeps.halve() {
                            continue;
                        }
                        forces
                    } else {
                        self.forces(state, &start, volts, S::zero(), open)
                    };
                    let travel =
                        self.move_under(mechanics, level, &mut state.motion, &forces, open);
                    if needs.memory {
                        let by = Increment {
                            current: state.motion.current - start.current,
                            speed: state.motion.speed - start.speed,
                            angle: travel,
                            ..Increment::default()
                        };
                        let shaft = self.mean(&start, &by, forces.volts, timing, open);
                        self.effects.remember(&mut state.memory, &shaft);
                    }
                    substeps.pass();
                }
            },
        )
    }

    /// Moves under `forces`, which are held. Returns the travel, in base speed × interval.
    #[inline(always)]
    fn move_under<M: Mechanics<S>>(
        &self,
        mechanics: &M,
        level: usize,
        motion: &mut Motion<S>,
        forces: &Forces<S>,
        open: bool,
    ) -> S {
        let scale = self.counts_per_unit;
        if self.effects.needs.friction || M::COUPLED {
            return step_sliding(mechanics, level, motion, forces, open, scale).unwrap_or_else(
                || step_with_events(mechanics, level, motion, forces, open, scale),
            );
        }
        let (volts, torque) = (forces.volts, forces.torque);
        let by = mechanics.step_free(level, motion, S::zero(), volts, torque, open);
        motion.current = motion.current + by.current;
        motion.speed = motion.speed + by.speed;
        motion.angle = motion.angle.advance(by.angle, scale);
        by.angle
    }
}
