//! Friction inside a part of a step: stops and releases are located by halving it, and its pieces
//! are taken by the exact maps of the halves. No root finding; and the same path for every lane.

use super::body::Body;
use super::pieces::Pieces;
use super::rung::RUNGS;
use super::state::Motion;
use crate::effects::Budget;
use crate::scalar::{Angle, Mask, Scalar, lanes};

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

lanes!(Forces {
    volts,
    torque,
    budget
});

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
}

impl<S: Scalar> Piece<S> {
    /// With the load against the flank on `side`.
    #[inline(always)]
    fn take<B: Body<S>>(
        body: &B,
        level: usize,
        from: &Motion<S>,
        side: S,
        forces: &Forces<S>,
        open: bool,
    ) -> Self {
        let Forces {
            volts,
            torque,
            budget,
        } = *forces;
        let zero = S::zero();
        let pull = from.current - torque - body.load(from, side);
        let sense = direction(from.speed, pull, &budget);
        let holds = is_zero(sense);
        let against = torque + sense * budget.moving;
        let slide = body.slide(level, from, side, volts, against, open);
        let settle = body.settle(level, from, side, volts, open);
        let mut end = Motion {
            current: from.current + S::select(holds, settle.current, slide.current),
            speed: from.speed + S::select(holds, zero, slide.speed),
            ..*from
        };
        if B::COUPLED {
            end.twist = from.twist + S::select(holds, settle.twist, slide.twist);
            end.slip = from.slip + S::select(holds, settle.slip, slide.slip);
        }
        let pull_after = end.current - torque - body.load(&end, side);
        Piece {
            end,
            turned: S::select(holds, zero, slide.angle),
            pull: (pull, pull_after),
            holds,
            turns_back: (end.speed * sense).less(zero),
            breaks_loose: budget.holding.less(pull_after.abs()).and(holds),
        }
    }

    /// Whether the shaft stopped, reversed or broke loose.
    #[inline(always)]
    fn eventful(&self) -> bool {
        self.turns_back.or(self.breaks_loose).any()
    }

    /// The end of a piece so short that the stop or the release in it need not be located any
    /// better.
    #[inline(always)]
    fn settle_speed<B: Body<S>>(&mut self, body: &B, level: usize, budget: &Budget<S>) {
        let started = started(self.pull, budget, |torque| body.yields(level, torque));
        let passed = passed_through(self.end.speed, self.pull.1, budget);
        let sliding = S::select(self.turns_back, passed, self.end.speed);
        let held = S::select(self.breaks_loose, started, S::zero());
        let speed = S::select(self.holds, held, sliding);
        // What friction did to the motor it did not do to the load.
        self.end.slip = self.end.slip + (speed - self.end.speed);
        self.end.speed = speed;
    }

    /// A piece so short that the contact within it need not be located any better: for the `share`
    /// of it after the contact the motion is that of `touching`, which touched all along.
    #[inline(always)]
    fn land(&mut self, touching: &Self, share: S) {
        self.turned = blend(self.turned, touching.turned, share);
        let (end, other) = (&mut self.end, &touching.end);
        end.current = blend(end.current, other.current, share);
        end.speed = blend(end.speed, other.speed, share);
        end.twist = blend(end.twist, other.twist, share);
        end.slip = blend(end.slip, other.slip, share);
    }
}

/// `a`, or as much as the `share` says of `b`.
#[inline(always)]
fn blend<S: Scalar>(a: S, b: S, share: S) -> S {
    a + (b - a) * share
}

/// Takes a part of a step if the shaft slides on throughout; most do. Gives the angle travelled.
#[inline(always)]
pub fn slide_on<S: Scalar, B: Body<S>>(
    body: &B,
    level: usize,
    motion: &mut Motion<S>,
    forces: &Forces<S>,
    open: bool,
    counts_per_unit: S::Coefficient,
) -> Option<S> {
    if B::COUPLED {
        return None;
    }
    let zero = S::zero();
    let sense = motion.speed.signum();
    let torque = forces.torque + sense * forces.budget.moving;
    let slide = body.slide(level, motion, zero, forces.volts, torque, open);
    let speed = motion.speed + slide.speed;
    if is_zero(sense).or((speed * sense).less(zero)).any() {
        return None;
    }
    motion.current = motion.current + slide.current;
    motion.speed = speed;
    motion.angle = motion.angle.advance(slide.angle, counts_per_unit);
    Some(slide.angle)
}

/// Takes a part of a step (`level` halvings of it) in the largest pieces that hold no stop, no
/// release and no contact. Gives the angle travelled, in base speed × interval.
// Rare, and long: out of the way of what is neither.
#[inline(never)]
pub fn slide_and_stick<S: Scalar, B: Body<S>>(
    body: &B,
    level: usize,
    motion: &mut Motion<S>,
    forces: &Forces<S>,
    open: bool,
    counts_per_unit: S::Coefficient,
) -> S {
    S::routine(
        #[inline(always)]
        || {
            let mut pieces = Pieces::new(level, RUNGS - 1);
            let mut travel = S::zero();
            while let Some(level) = pieces.next() {
                let side = body.side(motion);
                let mut piece = Piece::take(body, level, motion, side, forces, open);
                let end_side = body.side(&piece.end);
                let contact = B::COUPLED && is_zero(end_side - side).not().any();
                if (piece.eventful() || contact) && pieces.halve() {
                    continue;
                }
                if contact {
                    // Flanks part without a jump of the torque, but they touch with one.
                    let touching = Piece::take(body, level, motion, end_side, forces, open);
                    let beyond = body.beyond(&piece.end, end_side);
                    let share = beyond.part_of(beyond - body.beyond(motion, end_side));
                    let lands = is_zero(side).and(is_zero(end_side).not());
                    piece.land(&touching, S::select(lands, share, S::zero()));
                }
                if piece.eventful() {
                    piece.settle_speed(body, level, &forces.budget);
                }
                piece.end.angle = motion.angle.advance(piece.turned, counts_per_unit);
                *motion = piece.end;
                travel = travel + piece.turned;
                pieces.pass();
            }
            travel
        },
    )
}

/// Speed of a shaft that broke loose within the smallest piece, in which the pull rose evenly from
/// `pull.0` to `pull.1`: the excess over friction acts for the rest of the piece.
#[inline(always)]
pub fn started<S: Scalar>(pull: (S, S), budget: &Budget<S>, yields: impl FnOnce(S) -> S) -> S {
    let (before, pull) = pull;
    let excess = pull.abs() - budget.holding;
    let rest = excess.part_of(pull.abs() - before.abs());
    let mean = excess * S::from_f64(0.5) + (budget.holding - budget.moving);
    yields(-(mean * rest * pull.signum()))
}

/// Speed after a reversal within the smallest piece. It was run with friction on the old side
/// throughout; beyond the reversal the same pull meets friction on the new side, so the speed
/// gained there shrinks as the net torque does. Zero if friction holds the pull.
#[inline(always)]
pub fn passed_through<S: Scalar>(speed: S, pull: S, budget: &Budget<S>) -> S {
    let pull = pull.abs();
    let share = (pull - budget.moving).part_of(pull + budget.moving);
    let held = budget.holding.less(pull).not();
    S::select(held, S::zero(), speed * share)
}
