//! The short way in f32.

use super::{Arithmetic, Row, Turning, compiled_here};
use crate::fit::Evaluation;
use crate::model::{Motion, Rigid, RigidPlan};
use crate::scalar::Readable;
use crate::wire::Format;

impl Arithmetic for f32 {
    const FORMAT: Format = Format::F32;
    const EMPTY: Evaluation<f32> = Evaluation::of(0.0, 0.0, [[0.0; 3]; 3], 0.0, (0.0, 0.0));
    type Rows = [Row<f32>; 3];
    type Lead = f32;
    type Sums = (f32, f32);

    compiled_here!(6);

    /// The pull is what current and speed add to the speed in a period: by it the speed needs a product less, and is rounded
    /// once, where a row of three products would round it three times. In a recording of 2,000 periods the speed's rounding is
    /// what f32 costs: the shaft has turned by the sum of it.
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

    /// What it adds to the speed is part of the pull.
    fn turning(
        &[[a, _, _], [p, q, _], [u, _, _]]: &Self::Rows,
        sense: f32,
        (current, speed, lead): (f32, f32, f32),
    ) -> Turning<f32> {
        Turning {
            push: speed,
            // The current keeps a - q of itself.
            pull: speed * (1.0 - (a - q)) + p * current,
            speed: 0.0,
            lead: lead - u * speed,
            sense,
        }
    }

    #[inline(always)]
    fn turned((pull, speed): (f32, f32), by: &Turning<f32>) -> (f32, f32) {
        (pull + by.pull, speed)
    }

    #[inline(always)]
    fn follow(
        &[[a, b, c], [_, _, r], [u, v, w]]: &Self::Rows,
        (pull, speed, lead): (f32, f32, f32),
        duty: i16,
        step: i16,
    ) -> (f32, f32, f32) {
        let (duty, step) = (f32::from(duty), f32::from(step));
        (
            a * pull + b * speed + c * duty,
            speed + (pull + r * duty),
            // Here two hundred counts and more cancel, whatever the order.
            lead - step + u * pull + v * speed + w * duty,
        )
    }

    fn ahead(lead: f32, angle: Self::Angle, step: i16) -> f32 {
        lead + angle.minus(step.into())
    }

    #[inline(always)]
    fn counts(lead: f32) -> f32 {
        lead
    }

    #[inline(always)]
    fn along(speed: f32, sense: f32) -> bool {
        speed * sense > 0.0
    }

    #[inline(always)]
    fn collect(sums: &mut Self::Sums, lead: f32) {
        sums.0 += lead;
        sums.1 += lead * lead;
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
