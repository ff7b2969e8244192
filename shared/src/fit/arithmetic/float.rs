//! The hot loop in f32.

use super::{Arithmetic, Row, Sliding, compiled_here};
use crate::fit::Evaluation;
use crate::model::{Motion, Rigid, RigidPlan};
use crate::scalar::Readable;
use crate::wire::Format;

impl Arithmetic for f32 {
    const FORMAT: Format = Format::F32;
    const EMPTY: Evaluation<f32> = Evaluation::of(0.0, 0.0, [[0.0; 3]; 3], 0.0, (0.0, 0.0));
    type Rows = [Row<f32>; 3];
    type AngleError = f32;
    type Sums = (f32, f32);

    compiled_here!(6);

    /// The pull is the increment of the speed by current and speed in a period. With it the speed needs one product less and is
    /// rounded once; a row of three products would round it three times. Over 2,000 periods the rounding of the speed is what
    /// f32 costs, because the angle is its sum.
    fn rows(increments: [&[f32; 4]; 3], counts_per_unit: f32) -> Option<Self::Rows> {
        let [[forgotten, b, c, _], [p, q, r, _], angle] = increments;
        let [u, v, w, _] = angle.map(|k| k * counts_per_unit);
        // q·speed + p·current a period later; of the current, what is not forgotten.
        let pull = [1.0 + forgotten + q, p * b - q * forgotten, p * c + q * r];
        // current = (pull - q·speed) / p
        let by_pull = u / p;
        let mut rows = [pull, [*p, *q, *r], [by_pull, v - by_pull * q, w]];
        for row in &mut rows {
            row[2] *= 1.0 / 32_768.0;
        }
        by_pull.is_finite().then_some(rows)
    }

    fn pull(&[_, [p, q, _], _]: &Self::Rows, current: f32, speed: f32) -> f32 {
        q * speed + p * current
    }

    fn current(&[_, [p, q, _], _]: &Self::Rows, pull: f32, speed: f32, push: f32) -> f32 {
        (pull - push - q * speed) / p
    }

    #[inline(always)]
    fn drive(&[_, [_, q, _], _]: &Self::Rows, pull: f32, speed: f32, push: f32) -> f32 {
        pull - push - q * speed
    }

    fn drive_of(&[_, [p, _, _], _]: &Self::Rows, current: f32) -> f32 {
        p * current
    }

    /// The increment of the speed is part of the pull.
    fn sliding(
        &[[a, _, _], [p, q, _], [u, _, _]]: &Self::Rows,
        sense: f32,
        (current, speed, error): (f32, f32, f32),
    ) -> Sliding<f32> {
        Sliding {
            push: speed,
            // The current keeps a - q of itself.
            pull: speed * (1.0 - (a - q)) + p * current,
            speed: 0.0,
            error: error - u * speed,
            sense,
        }
    }

    #[inline(always)]
    fn add_sliding((pull, speed): (f32, f32), by: &Sliding<f32>) -> (f32, f32) {
        (pull + by.pull, speed)
    }

    #[inline(always)]
    fn step_row(
        &[[a, b, c], [_, _, r], [u, v, w]]: &Self::Rows,
        (pull, speed, error): (f32, f32, f32),
        duty: i16,
        step: i16,
    ) -> (f32, f32, f32) {
        let (duty, step) = (f32::from(duty), f32::from(step));
        (
            a * pull + b * speed + c * duty,
            speed + (pull + r * duty),
            // Here two hundred counts and more cancel, whatever the order.
            error - step + u * pull + v * speed + w * duty,
        )
    }

    fn advance_error(error: f32, angle: Self::Angle, step: i16) -> f32 {
        error + angle.minus(step.into())
    }

    #[inline(always)]
    fn counts(error: f32) -> f32 {
        error
    }

    #[inline(always)]
    fn along(speed: f32, sense: f32) -> bool {
        speed * sense > 0.0
    }

    #[inline(always)]
    fn collect(sums: &mut Self::Sums, error: f32) {
        sums.0 += error;
        sums.1 += error * error;
    }

    #[inline(always)]
    fn sums(sums: &Self::Sums) -> (f32, f32) {
        *sums
    }

    #[inline(always)]
    fn surely_below(sums: &Self::Sums, most: f32) -> bool {
        sums.1 < most
    }
}
