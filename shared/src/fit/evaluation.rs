//! One candidate along the trace, so many samples at a time.

use super::Arithmetic;
use super::arithmetic::Sliding;
use super::motor::Motor;
use crate::model::{Motion, Rigid};
use crate::scalar::Angle;
use crate::trace::{OPEN, Trace};

/// Samples between two looks at the bound: as many whole turns of any format's loop.
const BLOCK: usize = 72;

/// What a period costs, in samples of the hot loop, in which the dead time has to be looked up, or the shaft stops or starts: a slice of work
/// must not last longer than a device's watchdog.
const SLOW: u32 = 12;

/// Cost of building a model, in samples: with friction there are eight maps to make.
pub(super) const BUILD: u32 = 100;

/// Largest mean error that the unknown start within a count can explain, counts.
const UNKNOWN_START: f32 = 0.5;

/// The part of a mean error that the unknown start can explain, counts.
#[inline(never)]
pub(super) fn explained(mean: f32) -> f32 {
    if mean.abs() > UNKNOWN_START {
        UNKNOWN_START.copysign(mean)
    } else {
        mean
    }
}

/// The current behind a bridge with dead time, in the measure of [`Arithmetic::drive`].
// Not in an `Option`, as of `Room`.
#[derive(Clone, Copy, Debug)]
struct Drawn<S> {
    /// Whether it flows backward.
    backward: bool,
    /// What it was a period before.
    before: S,
    /// Sum of two beyond which the dead time takes all that it ever does.
    sure: S,
}

impl<S: Arithmetic> Drawn<S> {
    /// Not known yet.
    const fn none(zero: S) -> Self {
        Drawn {
            backward: false,
            before: zero,
            sure: zero,
        }
    }

    /// Goes on to the next current, if the dead time takes all of its share up to there.
    #[inline(always)]
    fn keeps_sense(&mut self, next: S) -> bool {
        let sum = self.before + next;
        let along = if self.backward { -sum } else { sum };
        let keeps = self.sure.less(along);
        if keeps {
            self.before = next;
        }
        keeps
    }
}

/// Room for a model. Not an `Option`, whose nothing may be marked by any number in any place: an empty room is all zeros, so
/// that a static of it is memory that starts as zeros, and no image is copied there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Room<S: Arithmetic> {
    taken: bool,
    run: Evaluation<S>,
}

impl<S: Arithmetic> Room<S> {
    /// With nothing in it.
    pub(super) const EMPTY: Self = Room {
        taken: false,
        run: S::EMPTY,
    };

    /// Takes the model out.
    pub(super) fn clear(&mut self) {
        self.taken = false;
    }

    /// The model in it.
    pub(super) fn model(&mut self) -> Option<&mut Evaluation<S>> {
        self.taken.then_some(&mut self.run)
    }
}

/// Room for as many models as ever run side by side.
pub(super) type Runs<S> = [Room<S>; 3];

/// Puts `motor` into `room`; says whether there is one. In place: to hand a model on costs as much as to make it.
// Out of line, so that what it needs of the stack is free again when the model runs.
#[inline(never)]
pub(super) fn build<S: Arithmetic>(room: &mut Room<S>, motor: &Motor, bound: f32) -> bool {
    let run = &mut room.run;
    room.taken = motor.set(&mut run.model) && run.begin(bound);
    room.taken
}

/// A rigid motor that follows a trace from standstill, and its error.
///
/// Its cost is the variance of the error: where within a count the shaft stood at the start is not known, so a constant
/// difference does not count.
///
/// A period in which the bridge is closed and the shaft slides on takes the hot loop of [`Arithmetic`], which differs from
/// [`Rigid::step`] in rounding only.
#[derive(Clone, Copy, Debug)]
pub struct Evaluation<S: Arithmetic> {
    model: Rigid<S>,
    rows: S::Rows,
    /// `None` if the sense of the motion is not known, or friction holds the shaft.
    sliding: Option<Sliding<S>>,
    /// Behind a bridge with dead time, while the shaft slides.
    drawn: Drawn<S>,
    /// See [`Arithmetic::pull`].
    pull: S,
    speed: S,
    error: S::AngleError,
    at: usize,
    /// Periods in which the dead time had to be looked up.
    slow: u32,
    sums: S::Sums,
    /// Mean square above which the candidate does not matter.
    bound: f32,
    result: Option<f32>,
}

impl<S: Arithmetic> Evaluation<S> {
    /// Of nothing: of zeros in its format.
    pub(super) const fn of(
        zero: S,
        none: S::Coefficient,
        rows: S::Rows,
        error: S::AngleError,
        sums: S::Sums,
    ) -> Self {
        Evaluation {
            model: Rigid::of(zero, none),
            rows,
            sliding: None,
            drawn: Drawn::none(zero),
            pull: zero,
            speed: zero,
            error,
            at: 0,
            slow: 0,
            sums,
            bound: 0.0,
            result: None,
        }
    }

    /// Of a model; none if it is beyond the format.
    pub fn new(model: Rigid<S>) -> Option<Self> {
        let mut evaluation = Evaluation { model, ..S::EMPTY };
        evaluation.begin(f32::INFINITY).then_some(evaluation)
    }

    /// Goes to the start of the trace, and gives up as soon as its cost must exceed `bound`. False if the model is beyond the
    /// format.
    fn begin(&mut self, bound: f32) -> bool {
        let Some(rows) = S::rows(self.model.increments(), self.model.counts_per_unit()) else {
            return false;
        };
        self.rows = rows;
        self.sliding = None;
        (self.pull, self.speed, self.error) = (S::zero(), S::zero(), Default::default());
        (self.at, self.slow, self.sums) = (0, 0, Default::default());
        (self.bound, self.result) = (bound, None);
        true
    }

    /// What it has cost so far beside its samples, in samples.
    pub(super) fn extra(&self) -> u32 {
        SLOW * self.slow
    }

    /// Runs along at most about `samples` of the trace; returns how many it ran, or what they cost.
    pub fn run(&mut self, trace: &Trace<'_>, samples: u32) -> u32 {
        let len = trace.len();
        let most = self.bound * len as f32;
        let mut ran = 0;
        while self.result.is_none() && ran < samples {
            let (from, extra) = (self.at, self.extra());
            let free = from < trace.closed.min(len) && self.model.is_free();
            let to = if free {
                // To the end of a block, so that where one looks does not depend on the slices.
                let blocks = (samples - ran).div_ceil(BLOCK as u32) as usize;
                (from + blocks * BLOCK).min(trace.closed).min(len)
            } else {
                ((from / BLOCK + 1) * BLOCK).min(len)
            };
            let rows = (trace.duties.get(from..to), trace.steps.get(from..to));
            let (Some(duties), Some(steps)) = rows else {
                break;
            };
            if free {
                self.at += S::run_frictionless(self, duties, steps, most);
            } else {
                let most_slow = (samples - ran) / SLOW + 1;
                self.at += self.run_rows(duties, steps, to <= trace.closed, most_slow);
            }
            ran += (self.at - from) as u32 + (self.extra() - extra);
            if self.at < to && !free {
                continue;
            }
            // The sum about the mean of what was seen only grows, so it may be compared before the end; and it is at most the
            // plain one.
            if self.at < len && S::surely_below(&self.sums, most) {
                continue;
            }
            let so_far = self.spread(self.at.max(1) as f32);
            if self.at == len || so_far > most {
                self.result = Some(so_far / len.max(1) as f32);
            }
        }
        ran
    }

    /// Mean squared error, counts², once it is known (or known to exceed the bound).
    pub fn result(&self) -> Option<f32> {
        self.result
    }

    /// One period: the duty acts, the count is read at its end.
    pub fn step(&mut self, duty: i16, step: i16) {
        self.run_rows(&[duty], &[step], duty != OPEN, u32::MAX);
    }

    /// What the last [`step`](Self::step) cost, in samples of the hot loop.
    pub(super) fn cost_of_step(&self) -> u32 {
        let general = self.sliding.is_none() && !self.model.is_free();
        if general { SLOW } else { 1 }
    }

    /// Counts by which the model is ahead of the reading now.
    pub fn error(&self) -> f32 {
        S::counts(self.error)
    }

    /// Mean squared error over the `periods` stepped so far, counts².
    pub fn mean_square(&self, periods: u32) -> f32 {
        let periods = periods.max(1) as f32;
        self.spread(periods) / periods
    }

    /// Runs along rows of duties and steps; `closed` if the bridge is closed in all of them. Returns how many it ran: not all, once so many
    /// were slow.
    fn run_rows(&mut self, duties: &[i16], steps: &[i16], closed: bool, most_slow: u32) -> usize {
        let (mut at, slow) = (0, self.slow);
        while self.slow - slow < most_slow
            && let (Some(&duty), Some(&step)) = (duties.get(at), steps.get(at))
        {
            let on = match (closed, duty) {
                (true, _) => (&duties[at..], &steps[at..]),
                (false, OPEN) => (&duties[..0], &steps[..0]),
                (false, _) => (&duties[at..=at], &steps[at..=at]),
            };
            let taken = if self.model.is_free() {
                S::run_frictionless(self, on.0, on.1, f32::INFINITY)
            } else {
                if self.sliding.is_none() && !self.model.sags() {
                    self.enter_sliding();
                }
                S::run_sliding(self, on.0, on.1)
            };
            at += taken;
            if taken == 0 {
                self.step_general(duty, step);
                at += 1;
            }
        }
        at
    }

    /// Enters the hot loop: makes the increments by load, friction and dead time in the senses in which the shaft turns, if it does, and the
    /// current flows.
    #[inline(never)]
    fn enter_sliding(&mut self) {
        let now = S::current(&self.rows, self.pull, self.speed, S::zero());
        let Some((sense, [current, speed, angle])) = self.model.sliding(self.speed, now) else {
            return;
        };
        let angle = S::Angle::default().advance(angle, self.model.counts_per_unit());
        let error = S::advance_error(Default::default(), angle, 0);
        let sliding = S::sliding(&self.rows, sense, (current, speed, error));
        if self.model.loses() {
            let sure = self.model.sure_current();
            self.drawn = Drawn {
                backward: now.less(S::zero()),
                before: S::drive_of(&self.rows, now),
                sure: S::drive_of(&self.rows, sure + sure),
            };
        }
        self.pull = self.pull + sliding.push;
        self.sliding = Some(sliding);
    }

    /// Runs a motor without friction and load along periods with the bridge closed, `N` at a time, until after a block the sum of
    /// squares may exceed `most`; returns how many periods those were.
    #[inline(always)]
    pub(super) fn run_frictionless<const N: usize>(
        &mut self,
        duties: &[i16],
        steps: &[i16],
        most: f32,
    ) -> usize {
        let rows = self.rows;
        let (mut at, mut sums) = ((self.pull, self.speed, self.error), self.sums);
        let len = duties.len().min(steps.len());
        let (duties, rest) = duties[..len].as_chunks::<N>();
        let (steps, rest_steps) = steps[..len].as_chunks::<N>();
        let mut left = duties.len();
        for (duties, steps) in duties.chunks(BLOCK / N).zip(steps.chunks(BLOCK / N)) {
            if N == 1 {
                // No compiler that minds the size sees that the loop in the loop is none.
                let turns = duties.as_flattened().iter().zip(steps.as_flattened());
                for (&duty, &step) in turns {
                    at = S::step_row(&rows, at, duty, step);
                    S::collect(&mut sums, at.2);
                }
            } else {
                for (duties, steps) in duties.iter().zip(steps) {
                    for (&duty, &step) in duties.iter().zip(steps) {
                        at = S::step_row(&rows, at, duty, step);
                        S::collect(&mut sums, at.2);
                    }
                }
            }
            left -= duties.len();
            if !S::surely_below(&sums, most) {
                break;
            }
        }
        let mut periods = (duties.len() - left) * N;
        if N > 1 && left == 0 {
            for (&duty, &step) in rest.iter().zip(rest_steps) {
                at = S::step_row(&rows, at, duty, step);
                S::collect(&mut sums, at.2);
            }
            periods += rest.len();
        }
        ((self.pull, self.speed, self.error), self.sums) = (at, sums);
        periods
    }

    /// Runs along periods in which the shaft slides on, with the bridge closed; returns how many those were.
    #[inline(always)]
    pub(super) fn run_sliding(&mut self, duties: &[i16], steps: &[i16]) -> usize {
        // What a supply loses changes with every duty.
        let (Some(sliding), false) = (self.sliding, self.model.sags()) else {
            return 0;
        };
        if !self.model.loses() {
            return self.slide(duties, steps, sliding, |_| true);
        }
        let (rows, push, mut drawn) = (self.rows, sliding.push, self.drawn);
        let periods = self.slide(duties, steps, sliding, |to| {
            drawn.keeps_sense(S::drive(&rows, to.0, to.1, push))
        });
        self.drawn = drawn;
        periods
    }

    /// The same, as long as the current `goes_on`.
    #[inline(always)]
    fn slide(
        &mut self,
        duties: &[i16],
        steps: &[i16],
        sliding: Sliding<S>,
        mut goes_on: impl FnMut(&(S, S, S::AngleError)) -> bool,
    ) -> usize {
        let rows = self.rows;
        let (mut at, mut sums) = ((self.pull, self.speed, self.error), self.sums);
        let mut periods = 0;
        for (&duty, &step) in duties.iter().zip(steps) {
            let mut to = S::step_row(&rows, at, duty, step);
            (to.0, to.1) = S::add_sliding((to.0, to.1), &sliding);
            if !(S::along(to.1, sliding.sense) && goes_on(&to)) {
                break;
            }
            to.2 = to.2 + sliding.error;
            at = to;
            S::collect(&mut sums, at.2);
            periods += 1;
        }
        ((self.pull, self.speed, self.error), self.sums) = (at, sums);
        periods
    }

    /// Takes a period in which the shaft may stop, start or coast.
    #[inline(never)]
    fn step_general(&mut self, duty: i16, step: i16) {
        let open = duty == OPEN;
        let command = S::from_q15(if open { 0 } else { duty });
        let push = self.sliding.map_or(S::zero(), |sliding| sliding.push);
        let mut motion = Motion {
            current: S::current(&self.rows, self.pull, self.speed, push),
            speed: self.speed,
            ..Motion::default()
        };
        if self.model.loses() || self.model.sags() {
            self.slow += 1;
        }
        S::step(&self.model, &mut motion, command, open);
        self.pull = S::pull(&self.rows, motion.current, motion.speed);
        self.speed = motion.speed;
        self.error = S::advance_error(self.error, motion.angle, step);
        S::collect(&mut self.sums, self.error);
        self.sliding = None;
    }

    /// Sum of the squared errors about their mean, as far as the unknown start explains that mean.
    fn spread(&self, periods: f32) -> f32 {
        let (sum, squares) = S::sums(&self.sums);
        let mean = explained(sum / periods);
        squares - mean * (sum + sum - mean * periods)
    }
}
