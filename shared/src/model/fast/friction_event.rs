//! Event location on one rigid body, for one candidate. The substeps are those of [`friction`](crate::model::friction), bit for bit,
//! but only what decides is computed: the speed alone of a substep that is then halved, and the current alone of a stuck shaft.

use crate::model::Motion;
use crate::model::dyadic::LEVELS;
use crate::model::friction::{Forces, direction, is_zero, passed_through, started};
use crate::model::step_map::StepMap;
use crate::model::substep_iter::SubstepIter;
use crate::scalar::{Angle, Scalar};

/// Takes a step in the longest substeps that hold no stop and no release.
#[inline(always)]
pub fn step_with_events<S: Scalar<Mask = bool>>(
    maps: &[StepMap<S>; LEVELS],
    motion: &mut Motion<S>,
    forces: &Forces<S>,
    open: bool,
    counts_per_unit: S::Coefficient,
) {
    let mut substeps = SubstepIter::new(0, LEVELS - 1);
    while !substeps.done() {
        let sense = direction(motion.speed, motion.current - forces.torque, &forces.budget);
        if is_zero(sense) {
            step_stuck(maps, &mut substeps, motion, forces, open);
        } else {
            let travel = step_sliding(maps, &mut substeps, motion, sense, forces, open);
            motion.angle = motion.angle.advance(travel, counts_per_unit);
        }
        substeps.pass();
    }
}

/// Takes the longest next substep in which the shaft does not turn back, or the shortest. Returns the travel.
#[inline(always)]
fn step_sliding<S: Scalar<Mask = bool>>(
    maps: &[StepMap<S>; LEVELS],
    substeps: &mut SubstepIter,
    motion: &mut Motion<S>,
    sense: S,
    forces: &Forces<S>,
    open: bool,
) -> S {
    let Forces {
        volts,
        torque,
        budget,
    } = *forces;
    let against = torque + sense * budget.moving;
    loop {
        let map = &maps[substeps.level()];
        let speed = motion.speed + map.free_speed(motion, volts, against, open);
        let turns_back = (speed * sense).less(S::zero());
        if turns_back && substeps.halve() {
            continue;
        }
        let (current, angle) = map.free_current_and_angle(motion, volts, against, open);
        motion.current = motion.current + current;
        motion.speed = if turns_back {
            passed_through(speed, motion.current - torque, &budget)
        } else {
            speed
        };
        return angle;
    }
}

/// Takes the longest next substep in which friction holds the shaft throughout, or the shortest.
#[inline(always)]
fn step_stuck<S: Scalar<Mask = bool>>(
    maps: &[StepMap<S>; LEVELS],
    substeps: &mut SubstepIter,
    motion: &mut Motion<S>,
    forces: &Forces<S>,
    open: bool,
) {
    let Forces {
        volts,
        torque,
        budget,
    } = *forces;
    let pull = motion.current - torque;
    loop {
        let map = &maps[substeps.level()];
        let current = motion.current + map.step_stuck(motion.current, volts, open);
        let after = current - torque;
        let breaks_loose = budget.holding.less(after.abs());
        if breaks_loose && substeps.halve() {
            continue;
        }
        motion.current = current;
        motion.speed = if breaks_loose {
            started((pull, after), &budget, || map.speed_per_torque())
        } else {
            S::zero()
        };
        return;
    }
}
