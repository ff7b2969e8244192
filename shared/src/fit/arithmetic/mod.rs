//! A number format that a device can fit in, and the few operations of its hot loop.

mod fixed;
mod float;

use super::Evaluation;
use crate::model::{Motion, Rigid, RigidPlan};
use crate::scalar::{Readable, Scalar};
use crate::wire::Format;
use core::ops::Add;

/// By current (or [pull](Arithmetic::pull)), by speed and by the winding's voltage.
pub type Row<C> = [C; 3];

/// What load and friction add in each period while the shaft turns one way.
#[derive(Clone, Copy, Debug, Default)]
pub struct Turning<S: Arithmetic> {
    /// To the pull, once.
    pub push: S,
    /// To the pull.
    pub pull: S,
    /// To the speed.
    pub speed: S,
    /// To the lead.
    pub lead: S::Lead,
    /// Sense of the motion.
    pub sense: S,
}

/// A number format that a device can fit in.
///
/// While the bridge is closed and the shaft neither stops nor turns back, a motor is three sums of products a period, with
/// multipliers that are made once: [`Rows`](Self::Rows). An associated type, because a core without a floating-point unit
/// wants them in another shape than the general multipliers of its format.
pub trait Arithmetic: Scalar<Mask = bool, Angle: Readable<Self>> + 'static {
    /// As the host is told.
    const FORMAT: Format;
    /// Of nothing, all of it zero.
    const EMPTY: Evaluation<Self>;
    /// Multipliers of current, speed and duty.
    type Rows: Copy + Default + core::fmt::Debug;
    /// Counts by which a model is ahead of the reading.
    type Lead: Copy + Default + core::fmt::Debug + Add<Output = Self::Lead>;
    /// Sum and sum of squares of leads.
    type Sums: Copy + Default + core::fmt::Debug;

    /// Rows for the increments of current, speed and angle (in units of angle, of which each is so many counts) by current,
    /// speed, voltage and torque. None if the format does not hold them.
    fn rows(
        increments: [&[Self::Coefficient; 4]; 3],
        counts_per_unit: Self::Coefficient,
    ) -> Option<Self::Rows>;
    /// What the short way keeps beside the speed for a current: itself, or something else that says as much.
    fn pull(rows: &Self::Rows, current: Self, speed: Self) -> Self;
    /// The current again, while the pull has a push in it.
    fn current(rows: &Self::Rows, pull: Self, speed: Self, push: Self) -> Self;
    /// What a torque that adds so much to current, speed and lead in each period adds on the short way.
    fn turning(rows: &Self::Rows, sense: Self, by: (Self, Self, Self::Lead)) -> Turning<Self>;
    /// Adds that to pull and speed, if anything is to be added.
    fn turned(to: (Self, Self), by: &Turning<Self>) -> (Self, Self);
    /// A period without torque on the shaft: pull, speed and lead at its end.
    fn follow(
        rows: &Self::Rows,
        from: (Self, Self, Self::Lead),
        duty: i16,
        step: i16,
    ) -> (Self, Self, Self::Lead);
    /// A lead a period later: the model turned by `angle`, and the reading went `step` counts further.
    fn ahead(lead: Self::Lead, angle: Self::Angle, step: i16) -> Self::Lead;
    /// A lead in counts.
    fn counts(lead: Self::Lead) -> f32;
    /// Whether a speed has the sign of `sense`.
    fn along(speed: Self, sense: Self) -> bool;
    /// Adds a lead to the sums.
    fn collect(sums: &mut Self::Sums, lead: Self::Lead);
    /// Sum in counts, and of squares in counts².
    fn sums(sums: &Self::Sums) -> (f32, f32);

    /// Whether the squares are below `most` counts² beyond doubt; cheaper than to ask how many they are.
    fn surely_below(sums: &Self::Sums, most: f32) -> bool;

    /// Whether [`Rigid::set`] succeeds in this format. Here, and not where it is called, because this crate is compiled for
    /// speed and a device's application for size; so are the next three.
    fn set(model: &mut Rigid<Self>, plan: &RigidPlan<f32>) -> bool;
    /// [`Rigid::step`] in this format.
    fn step(model: &Rigid<Self>, motion: &mut Motion<Self>, command: Self, open: bool);
    /// [`Evaluation`](super::Evaluation)'s short way in this format.
    fn glide(run: &mut Evaluation<Self>, duties: &[i16], steps: &[i16]) -> usize;
    /// The same for a motor without friction and load.
    fn glide_free(run: &mut Evaluation<Self>, duties: &[i16], steps: &[i16], most: f32) -> usize;
}

/// What is compiled here; without friction so many periods a turn of the loop, whose counter costs as much as one of f32's sums.
macro_rules! compiled_here {
    ($at_a_time:literal) => {
        fn set(model: &mut Rigid<Self>, plan: &RigidPlan<f32>) -> bool {
            model.set(plan).is_ok()
        }

        fn step(model: &Rigid<Self>, motion: &mut Motion<Self>, command: Self, open: bool) {
            model.step(motion, command, open);
        }

        fn glide(run: &mut Evaluation<Self>, duties: &[i16], steps: &[i16]) -> usize {
            run.glide(duties, steps)
        }

        fn glide_free(
            run: &mut Evaluation<Self>,
            duties: &[i16],
            steps: &[i16],
            most: f32,
        ) -> usize {
            run.glide_free::<$at_a_time>(duties, steps, most)
        }
    };
}

use compiled_here;
