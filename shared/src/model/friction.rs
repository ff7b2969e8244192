//! Friction within a substep, by event location: a substep that holds a stop, a release or a contact
//! is halved until the event is in the shortest one, and each half is taken by its exact map. No root
//! finding, and one path for all lanes.

use super::dyadic::LEVELS;
use super::mechanics::Mechanics;
use super::state::Motion;
use super::substep_iter::SubstepIter;
use crate::effects::Budget;
use crate::scalar::{Angle, Mask, Scalar, lanes};

/// Forces, held over a substep.
#[derive(Clone, Copy, Debug)]
pub struct Forces<S> {
    /// Voltage at the winding.
    pub volts: S,
    /// Torque on the shaft, against positive rotation.
    pub torque: S,
    /// Budget of friction.
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

/// Whether a number is zero, of either sign.
#[inline(always)]
pub fn is_zero<S: Scalar>(x: S) -> S::Mask {
    x.less(S::zero()).or(S::zero().less(x)).not()
}

/// A substep, taken as if it held no event.
struct Trial<S: Scalar> {
    /// The motion at its end.
    end: Motion<S>,
    /// Angle that the shaft travelled.
    travel: S,
    /// Net torque on a resting shaft before and after.
    pull: (S, S),
    /// Friction holds the shaft.
    holds: S::Mask,
    /// The shaft stopped or reversed.
    turns_back: S::Mask,
    /// The pull outgrew what friction can hold.
    breaks_loose: S::Mask,
    /// The load stopped or reversed.
    load_turns_back: S::Mask,
}

impl<S: Scalar> Trial<S> {
    /// Takes it from `from`, with the load against the flank on `side`: under `forces`, of which the budget is the motor's, and with friction of
    /// at most `behind` on the load.
    #[inline(always)]
    fn take<M: Mechanics<S>>(
        mechanics: &M,
        level: usize,
        from: &Motion<S>,
        side: S,
        forces: &Forces<S>,
        behind: S,
        open: bool,
    ) -> Self {
        let Forces {
            volts,
            torque,
            budget,
        } = *forces;
        let zero = S::zero();
        let pull = from.current - torque - mechanics.load(from, side);
        let sense = direction(from.speed, pull, &budget);
        let holds = is_zero(sense);
        let against = torque + sense * budget.moving;
        let free = mechanics.step_free(level, from, side, volts, against, open);
        let stuck = mechanics.step_stuck(level, from, side, volts, open);
        let mut end = Motion {
            current: from.current + S::select(holds, stuck.current, free.current),
            speed: from.speed + S::select(holds, zero, free.speed),
            ..*from
        };
        if M::COUPLED {
            end.twist = from.twist + S::select(holds, stuck.twist, free.twist);
            end.slip = from.slip + S::select(holds, stuck.slip, free.slip);
        }
        let mut travel = S::select(holds, zero, free.angle);
        let mut load_turns_back = zero.less(zero);
        if let Some((by, turns_back)) =
            mechanics.brake(level, from, &end, side, holds, behind, open)
        {
            end.current = end.current + by.current;
            end.speed = end.speed + by.speed;
            end.twist = end.twist + by.twist;
            end.slip = end.slip + by.slip;
            travel = travel + by.angle;
            load_turns_back = turns_back;
        }
        let pull_after = end.current - torque - mechanics.load(&end, side);
        Trial {
            end,
            travel,
            pull: (pull, pull_after),
            holds,
            turns_back: (end.speed * sense).less(zero),
            breaks_loose: budget.holding.less(pull_after.abs()).and(holds),
            load_turns_back,
        }
    }

    /// Whether the shaft stopped, reversed or broke loose.
    #[inline(always)]
    fn has_event(&self) -> bool {
        self.turns_back.or(self.breaks_loose).any()
    }

    /// Corrects the speed at the end of a shortest substep that holds a stop or a release: the event
    /// is located well enough.
    #[inline(always)]
    fn resolve_event<M: Mechanics<S>>(&mut self, mechanics: &M, level: usize, budget: &Budget<S>) {
        let started = started(self.pull, budget, || mechanics.speed_per_torque(level));
        let passed = passed_through(self.end.speed, self.pull.1, budget);
        let sliding = S::select(self.turns_back, passed, self.end.speed);
        let held = S::select(self.breaks_loose, started, S::zero());
        let speed = S::select(self.holds, held, sliding);
        // What friction did to the motor it did not do to the load.
        self.end.slip = self.end.slip + (speed - self.end.speed);
        self.end.speed = speed;
    }

    /// Resolves a contact within a shortest substep: for the `share` of it after the contact the
    /// motion is that of `touching`, whose flanks touched all along.
    #[inline(always)]
    fn resolve_contact(&mut self, touching: &Self, share: S) {
        self.travel = blend(self.travel, touching.travel, share);
        let (end, other) = (&mut self.end, &touching.end);
        end.current = blend(end.current, other.current, share);
        end.speed = blend(end.speed, other.speed, share);
        end.twist = blend(end.twist, other.twist, share);
        end.slip = blend(end.slip, other.slip, share);
    }
}

/// Linear interpolation from `a` to `b`.
#[inline(always)]
fn blend<S: Scalar>(a: S, b: S, share: S) -> S {
    a + (b - a) * share
}

/// Takes a substep in which the shaft slides on throughout, as in most; `None` if it may not.
/// Returns the travel.
#[inline(always)]
pub fn step_sliding<S: Scalar, M: Mechanics<S>>(
    mechanics: &M,
    level: usize,
    motion: &mut Motion<S>,
    forces: &Forces<S>,
    open: bool,
    counts_per_unit: S::Coefficient,
) -> Option<S> {
    if M::COUPLED {
        return None;
    }
    let zero = S::zero();
    let sense = motion.speed.signum();
    let torque = forces.torque + sense * forces.budget.moving;
    let by = mechanics.step_free(level, motion, zero, forces.volts, torque, open);
    let speed = motion.speed + by.speed;
    if is_zero(sense).or((speed * sense).less(zero)).any() {
        return None;
    }
    motion.current = motion.current + by.current;
    motion.speed = speed;
    motion.angle = motion.angle.advance(by.angle, counts_per_unit);
    Some(by.angle)
}

/// Takes a substep of `level` in the longest shorter ones that hold no stop, no release and no
/// contact. Returns the travel, in base speed × interval.
// Rare and long, so kept out of line.
#[inline(never)]
pub fn step_with_events<S: Scalar, M: Mechanics<S>>(
    mechanics: &M,
    level: usize,
    motion: &mut Motion<S>,
    forces: &Forces<S>,
    open: bool,
    counts_per_unit: S::Coefficient,
) -> S {
    S::routine(
        #[inline(always)]
        || {
            let mut substeps = SubstepIter::new(level, LEVELS - 1);
            let mut travel = S::zero();
            let (budget, behind) = mechanics.shared(&forces.budget);
            let forces = &Forces { budget, ..*forces };
            while let Some(level) = substeps.next() {
                let side = mechanics.side(motion);
                let mut trial = Trial::take(mechanics, level, motion, side, forces, behind, open);
                let end_side = mechanics.side(&trial.end);
                let contact = M::COUPLED && is_zero(end_side - side).not().any();
                let located = trial.has_event() || trial.load_turns_back.any() || contact;
                if (located || level < mechanics.longest()) && substeps.halve() {
                    continue;
                }
                if contact {
                    // Flanks part without a jump of the torque, but they touch with one.
                    let touching =
                        Trial::take(mechanics, level, motion, end_side, forces, behind, open);
                    let beyond = mechanics.beyond(&trial.end, end_side);
                    let share = beyond.part_of(beyond - mechanics.beyond(motion, end_side));
                    let lands = is_zero(side).and(is_zero(end_side).not());
                    trial.resolve_contact(&touching, S::select(lands, share, S::zero()));
                }
                if trial.has_event() {
                    trial.resolve_event(mechanics, level, &forces.budget);
                }
                trial.end.angle = motion.angle.advance(trial.travel, counts_per_unit);
                *motion = trial.end;
                travel = travel + trial.travel;
                substeps.pass();
            }
            travel
        },
    )
}

/// Speed of a shaft that broke loose within a shortest substep, in which the pull rose evenly from
/// `pull.0` to `pull.1`: the excess over friction acts for the rest of the substep.
#[inline(always)]
pub fn started<S: Scalar>(
    pull: (S, S),
    budget: &Budget<S>,
    speed_per_torque: impl FnOnce() -> S::Coefficient,
) -> S {
    let (before, pull) = pull;
    let excess = pull.abs() - budget.holding;
    let rest = excess.part_of(pull.abs() - before.abs());
    let mean = excess * S::from_f64(0.5) + (budget.holding - budget.moving);
    (-(mean * rest * pull.signum())).times(speed_per_torque())
}

/// Speed after a reversal within a shortest substep, which was taken with friction on the old side
/// throughout. Beyond the reversal the same pull meets friction on the new side, so the speed
/// gained there shrinks as the net torque does. Zero if friction holds the pull.
#[inline(always)]
pub fn passed_through<S: Scalar>(speed: S, pull: S, budget: &Budget<S>) -> S {
    let pull = pull.abs();
    let share = (pull - budget.moving).part_of(pull + budget.moving);
    let held = budget.holding.less(pull).not();
    S::select(held, S::zero(), speed * share)
}
