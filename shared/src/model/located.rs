//! Friction on one rigid body, of one candidate. The pieces are those of [`friction`](super::friction), to the bit, but of each only as
//! much is computed as is asked: of seven that are halved the speed alone, and nothing of a sliding shaft where it is held.

use super::friction::{Forces, direction, is_zero, passed_through, started};
use super::pieces::Pieces;
use super::rung::{RUNGS, Rung};
use super::state::Motion;
use crate::scalar::{Angle, Scalar};

/// Takes a step in the largest pieces that hold no stop and no release.
#[inline(always)]
pub fn slide_and_stick<S: Scalar<Mask = bool>>(
    rungs: &[Rung<S>; RUNGS],
    motion: &mut Motion<S>,
    forces: &Forces<S>,
    open: bool,
    counts_per_unit: S::Coefficient,
) {
    let mut pieces = Pieces::new(0, RUNGS - 1);
    while !pieces.done() {
        let sense = direction(motion.speed, motion.current - forces.torque, &forces.budget);
        if is_zero(sense) {
            rest(rungs, &mut pieces, motion, forces, open);
        } else {
            let turned = slide(rungs, &mut pieces, motion, sense, forces, open);
            motion.angle = motion.angle.advance(turned, counts_per_unit);
        }
        pieces.pass();
    }
}

/// The largest next piece in which the shaft does not turn back, or the shortest. Gives the angle travelled.
#[inline(always)]
fn slide<S: Scalar<Mask = bool>>(
    rungs: &[Rung<S>; RUNGS],
    pieces: &mut Pieces,
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
        let rung = &rungs[pieces.level()];
        let speed = motion.speed + rung.slide_speed(motion, volts, against, open);
        let turns_back = (speed * sense).less(S::zero());
        if turns_back && pieces.halve() {
            continue;
        }
        let (current, angle) = rung.slide_rest(motion, volts, against, open);
        motion.current = motion.current + current;
        motion.speed = if turns_back {
            passed_through(speed, motion.current - torque, &budget)
        } else {
            speed
        };
        return angle;
    }
}

/// The largest next piece in which friction holds the shaft throughout, or the shortest.
#[inline(always)]
fn rest<S: Scalar<Mask = bool>>(
    rungs: &[Rung<S>; RUNGS],
    pieces: &mut Pieces,
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
        let level = pieces.level();
        let current = motion.current + rungs[level].settle(motion.current, volts, open);
        let after = current - torque;
        let breaks_loose = budget.holding.less(after.abs());
        if breaks_loose && pieces.halve() {
            continue;
        }
        motion.current = current;
        motion.speed = if breaks_loose {
            started((pull, after), &budget, |torque| rungs[level].yields(torque))
        } else {
            S::zero()
        };
        return;
    }
}
