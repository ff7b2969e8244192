//! A number format that a device can fit in, and the few operations of its hot loop.
//!
//! The loop stands here and not in `model/fast`, because it is no form of the model's step. It takes raw duties and counts,
//! accumulates the error and not the angle, orders its products for one core's multiplier, and differs from
//! [`Rigid::step`] in rounding. `shared/tests/device_fit.rs` holds its laws.

mod fixed;
mod float;

use super::Evaluation;
use crate::model::{Motion, Rigid, RigidPlan};
use crate::scalar::{Readable, Scalar};
use crate::wire::Format;
use core::ops::Add;

/// By current (or [pull](Arithmetic::pull)), by speed and by the winding's voltage.
pub type Row<C> = [C; 3];

/// Increments of one period by load, friction and dead time, while the shaft slides on in one sense and the current flows in one.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sliding<S: Arithmetic> {
    /// Of the pull, once, when the shaft begins to slide.
    pub push: S,
    /// Of the pull.
    pub pull: S,
    /// Of the speed.
    pub speed: S,
    /// Of the error.
    pub error: S::AngleError,
    /// Sense of the motion.
    pub sense: S,
}

/// A number format that a device can fit in.
///
/// While the bridge is closed and the shaft neither stops nor turns back, a motor is three sums of products a period, with
/// multipliers that are made once: [`Rows`](Self::Rows). An associated type, because a core without a floating-point unit
/// wants them in another shape than the general multipliers of its format.
pub trait Arithmetic: Scalar<Mask = bool, Angle: Readable<Self>> + 'static {
    /// This number format, as it is reported to the host.
    const FORMAT: Format;
    /// Of nothing, all of it zero.
    const EMPTY: Evaluation<Self>;
    /// Multipliers of current, speed and duty.
    type Rows: Copy + Default + core::fmt::Debug;
    /// Error of the angle: counts by which the model is ahead of the reading.
    type AngleError: Copy + Default + core::fmt::Debug + Add<Output = Self::AngleError>;
    /// Sum and sum of squares of errors.
    type Sums: Copy + Default + core::fmt::Debug;

    /// Rows for the increments of current, speed and angle (in units of angle, of which each is so many counts) by current,
    /// speed, voltage and torque. None if the format does not hold them.
    fn rows(
        increments: [&[Self::Coefficient; 4]; 3],
        counts_per_unit: Self::Coefficient,
    ) -> Option<Self::Rows>;
    /// State that the hot loop keeps in place of the current: the current itself, or a combination of current and speed.
    fn pull(rows: &Self::Rows, current: Self, speed: Self) -> Self;
    /// The current from that state, while the state contains a push.
    fn current(rows: &Self::Rows, pull: Self, speed: Self, push: Self) -> Self;
    /// The same in a measure of the format's own, which needs no division.
    fn drive(rows: &Self::Rows, pull: Self, speed: Self, push: Self) -> Self;
    /// A current in that measure.
    fn drive_of(rows: &Self::Rows, current: Self) -> Self;
    /// Increments in the hot loop by a torque that adds `by` to current, speed and error in each period.
    fn sliding(rows: &Self::Rows, sense: Self, by: (Self, Self, Self::AngleError))
    -> Sliding<Self>;
    /// Adds these increments to pull and speed.
    fn add_sliding(to: (Self, Self), by: &Sliding<Self>) -> (Self, Self);
    /// One period without torque on the shaft: pull, speed and error at its end.
    fn step_row(
        rows: &Self::Rows,
        from: (Self, Self, Self::AngleError),
        duty: i16,
        step: i16,
    ) -> (Self, Self, Self::AngleError);
    /// The error a period later: the model turned by `angle`, and the reading by `step` counts.
    fn advance_error(error: Self::AngleError, angle: Self::Angle, step: i16) -> Self::AngleError;
    /// An error in counts.
    fn counts(error: Self::AngleError) -> f32;
    /// Whether a speed has the sign of `sense`.
    fn along(speed: Self, sense: Self) -> bool;
    /// Adds an error to the sums.
    fn collect(sums: &mut Self::Sums, error: Self::AngleError);
    /// Sum in counts, and of squares in counts².
    fn sums(sums: &Self::Sums) -> (f32, f32);

    /// Whether the squares are surely below `most` counts²; cheaper than to compute them.
    fn surely_below(sums: &Self::Sums, most: f32) -> bool;

    /// Whether [`Rigid::set`] succeeds in this format. Here, and not where it is called, because this crate is compiled for
    /// speed and a device's application for size; so are the next three.
    fn set(model: &mut Rigid<Self>, plan: &RigidPlan<f32>) -> bool;
    /// [`Rigid::step`] in this format.
    fn step(model: &Rigid<Self>, motion: &mut Motion<Self>, command: Self, open: bool);
    /// [`Evaluation`](super::Evaluation)'s hot loop in this format.
    fn run_sliding(run: &mut Evaluation<Self>, duties: &[i16], steps: &[i16]) -> usize;
    /// The same for a motor without friction and load.
    fn run_frictionless(
        run: &mut Evaluation<Self>,
        duties: &[i16],
        steps: &[i16],
        most: f32,
    ) -> usize;
}

/// Compiles the hot loops in this crate. A motor without friction and load takes `$at_a_time` periods a turn of the loop, whose
/// counter costs as much as one sum in f32.
macro_rules! compiled_here {
    ($at_a_time:literal) => {
        fn set(model: &mut Rigid<Self>, plan: &RigidPlan<f32>) -> bool {
            model.set(plan).is_ok()
        }

        fn step(model: &Rigid<Self>, motion: &mut Motion<Self>, command: Self, open: bool) {
            model.step(motion, command, open);
        }

        fn run_sliding(run: &mut Evaluation<Self>, duties: &[i16], steps: &[i16]) -> usize {
            run.run_sliding(duties, steps)
        }

        fn run_frictionless(
            run: &mut Evaluation<Self>,
            duties: &[i16],
            steps: &[i16],
            most: f32,
        ) -> usize {
            run.run_frictionless::<$at_a_time>(duties, steps, most)
        }
    };
}

use compiled_here;
