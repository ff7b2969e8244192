//! Friction inside a part of a step: stops and releases are located by halving it, and its pieces
//! are taken by the exact maps of the halves. No root finding; and the same path for every lane.

use super::body::Body;
use super::rung::RUNGS;
use super::state::Motion;
use crate::effects::Budget;
use crate::scalar::{Angle, Mask, Scalar};

/// What is held over a part of a step.
#[derive(Clone, Copy, Debug)]
pub struct Forces<S> {
    /// At the winding.
    pub volts: S,
    /// On the shaft, against positive rotation.
    pub torque: S,
    /// Friction.
    pub budget: Budget<S>,
}

/// Sense of the motion that friction opposes: of the speed, or of the `pull` that breaks a resting
/// shaft loose; zero while it is held.
#[inline(always)]
pub fn direction<S: Scalar>(speed: S, pull: S, budget: &Budget<S>) -> S {
    let loose = budget.holding.less(pull.abs());
    let start = S::select(loose, pull.signum(), S::zero());
    S::select(is_zero(speed), start, speed.signum())
}

#[inline(always)]
pub fn is_zero<S: Scalar>(x: S) -> S::Mask {
    x.less(S::zero()).or(S::zero().less(x)).not()
}

/// Halvings of a step to which a stop or a release of a rigid motor is located.
pub const FINEST: usize = 5;

/// One piece, taken as if nothing happened within it.
struct Piece<S: Scalar> {
    /// Where it ends.
    end: Motion<S>,
    /// Angle that the shaft turned.
    turned: S,
    /// Net torque on a resting shaft before and after.
    pull: (S, S),
    /// Friction holds the shaft.
    holds: S::Mask,
    /// The shaft stopped or reversed.
    turns_back: S::Mask,
    /// The pull outgrew what friction can hold.
    breaks_loose: S::Mask,
    /// A flank touched or parted.
    meets: S::Mask,
}

impl<S: Scalar> Piece<S> {
    #[inline(always)]
    fn take<B: Body<S>>(
        body: &B,
        level: usize,
        from: &Motion<S>,
        forces: &Forces<S>,
        open: bool,
    ) -> Self {
        let Forces {
            volts,
            torque,
            budget,
        } = *forces;
        let zero = S::zero();
        let pull = from.current - torque - body.load(from);
        let sense = direction(from.speed, pull, &budget);
        let holds = is_zero(sense);
        let slide = body.slide(level, from, volts, torque + sense * budget.moving, open);
        let settle = body.settle(level, from, volts, open);
        let either = |settle, slide| S::select(holds, settle, slide);
        let mut end = Motion {
            current: from.current + either(settle.current, slide.current),
            speed: from.speed + either(zero, slide.speed),
            ..*from
        };
        if B::COUPLED {
            end.twist = from.twist + either(settle.twist, slide.twist);
            end.slip = from.slip + either(settle.slip, slide.slip);
        }
        let pull_after = end.current - torque - body.load(&end);
        let met = if B::COUPLED {
            body.side(&end) - body.side(from)
        } else {
            zero
        };
        Piece {
            end,
            turned: either(zero, slide.angle),
            pull: (pull, pull_after),
            holds,
            turns_back: (end.speed * sense).less(zero),
            breaks_loose: budget.holding.less(pull_after.abs()).and(holds),
            meets: is_zero(met).not(),
        }
    }

    /// Speed at the end of a piece so short that the stop or the release in it need not be located
    /// any better.
    fn settled_speed<B: Body<S>>(&self, body: &B, level: usize, budget: &Budget<S>) -> S {
        let started = started(body, level, self.pull, budget);
        let passed = passed_through(self.end.speed, self.pull.1, budget);
        let sliding = S::select(self.turns_back, passed, self.end.speed);
        let held = S::select(self.breaks_loose, started, S::zero());
        S::select(self.holds, held, sliding)
    }
}

/// Takes a part of a step (`level` halvings of it) in the largest pieces that hold no stop, no
/// release and no contact. Gives the angle travelled, in base speed × interval.
#[inline]
pub fn slide_and_stick<S: Scalar, B: Body<S>>(
    body: &B,
    level: usize,
    motion: &mut Motion<S>,
    forces: &Forces<S>,
    open: bool,
    counts_per_unit: S::Coefficient,
) -> S {
    if !B::COUPLED {
        // Most parts hold nothing of the kind.
        let sense = motion.speed.signum();
        let torque = forces.torque + sense * forces.budget.moving;
        let slide = body.slide(level, motion, forces.volts, torque, open);
        let speed = motion.speed + slide.speed;
        if !is_zero(sense).or((speed * sense).less(S::zero())).any() {
            motion.current = motion.current + slide.current;
            motion.speed = speed;
            motion.angle = motion.angle.advance(slide.angle, counts_per_unit);
            return slide.angle;
        }
    }
    let base = level;
    let finest = if B::COUPLED {
        RUNGS - 1
    } else {
        FINEST.max(base)
    };
    let whole = 1u32 << (finest - base);
    let mut level = base;
    let mut done = 0;
    let mut now = *motion;
    let mut travel = S::zero();
    while done < whole {
        let mut piece = Piece::take(body, level, &now, forces, open);
        let event = piece.turns_back.or(piece.breaks_loose).any();
        let contact = B::COUPLED && piece.meets.any();
        if (event || contact) && level < finest {
            level += 1;
            continue;
        }
        if event {
            let speed = piece.settled_speed(body, level, &forces.budget);
            if B::COUPLED {
                // What friction did to the motor it did not do to the load.
                piece.end.slip = piece.end.slip + (speed - piece.end.speed);
            }
            piece.end.speed = speed;
        }
        piece.end.angle = now.angle.advance(piece.turned, counts_per_unit);
        now = piece.end;
        travel = travel + piece.turned;
        done += whole >> (level - base);
        while level > base && done.is_multiple_of(whole >> (level - 1 - base)) {
            level -= 1;
        }
    }
    *motion = now;
    travel
}

/// Speed of a shaft that broke loose within the smallest piece, in which the pull rose evenly from
/// `pull.0` to `pull.1`: the excess over friction acts for the rest of the piece.
fn started<S: Scalar, B: Body<S>>(body: &B, level: usize, pull: (S, S), budget: &Budget<S>) -> S {
    let (before, pull) = pull;
    let excess = pull.abs() - budget.holding;
    let rest = excess.part_of(pull.abs() - before.abs());
    let mean = excess * S::from_f64(0.5) + (budget.holding - budget.moving);
    body.yields(level, -(mean * rest * pull.signum()))
}

/// Speed after a reversal within the smallest piece. It was run with friction on the old side
/// throughout; beyond the reversal the same pull meets friction on the new side, so the speed
/// gained there shrinks as the net torque does. Zero if friction holds the pull.
fn passed_through<S: Scalar>(speed: S, pull: S, budget: &Budget<S>) -> S {
    let pull = pull.abs();
    let share = (pull - budget.moving).part_of(pull + budget.moving);
    let held = budget.holding.less(pull).not();
    S::select(held, S::zero(), speed * share)
}
