//! One part of a step: moved under what was foreseen for it, or halved.

use super::Model;
use super::body::{Body, Increment};
use super::foresee::Foreseen;
use super::friction::{Forces, slide_and_stick, slide_on};
use super::pieces::Pieces;
use super::rung::RUNGS;
use super::state::{Motion, State};
use crate::scalar::{Angle, Mask, Scalar};

impl<S: Scalar> Model<S> {
    /// Takes one part of a step, `level` halvings of it, with the drive at `volts`.
    pub(super) fn part<B: Body<S>>(
        &self,
        body: &B,
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
                    self.follow(body, level, &mut state.motion, &forces, open);
                    return;
                }
                let mut pieces = Pieces::new(level, RUNGS - 1);
                while let Some(level) = pieces.next() {
                    let start = self.start(&state.motion, body.timing(level), open);
                    let forces = if needs.mean {
                        let Foreseen { forces, doubtful } =
                            self.foresee(body, level, state, &start, volts, open);
                        if doubtful.any() && pieces.halve() {
                            continue;
                        }
                        forces
                    } else {
                        self.forces(state, &start, volts, S::zero(), open)
                    };
                    let travel = self.follow(body, level, &mut state.motion, &forces, open);
                    if needs.memory {
                        let by = Increment {
                            current: state.motion.current - start.current,
                            speed: state.motion.speed - start.speed,
                            angle: travel,
                            ..Increment::default()
                        };
                        let shaft = self.mean(&start, &by, forces.volts, body.timing(level), open);
                        self.effects.remember(&mut state.memory, &shaft);
                    }
                    pieces.pass();
                }
            },
        )
    }

    /// Moves under `forces`. Gives the angle travelled, in base speed × interval.
    #[inline(always)]
    fn follow<B: Body<S>>(
        &self,
        body: &B,
        level: usize,
        motion: &mut Motion<S>,
        forces: &Forces<S>,
        open: bool,
    ) -> S {
        let scale = self.counts_per_unit;
        if self.effects.needs.friction || B::COUPLED {
            return slide_on(body, level, motion, forces, open, scale)
                .unwrap_or_else(|| slide_and_stick(body, level, motion, forces, open, scale));
        }
        let by = body.slide(level, motion, S::zero(), forces.volts, forces.torque, open);
        motion.current = motion.current + by.current;
        motion.speed = motion.speed + by.speed;
        motion.angle = motion.angle.advance(by.angle, scale);
        by.angle
    }
}
