//! The hot loop in fixed point.

use super::{Arithmetic, Row, Sliding, compiled_here};
use crate::fit::Evaluation;
use crate::model::{Motion, Rigid, RigidPlan};
use crate::scalar::{Fixed, FixedCoefficient, product};
use crate::wire::Format;

/// Rows in fixed point: mantissas, which the upper words of current and speed and the duty are multiplied by.
#[derive(Clone, Copy, Debug, Default)]
pub struct FixedRows {
    current: Row<i32>,
    speed: Row<i32>,
    travel: Row<i32>,
}

/// Left shifts after the products: an increment of the current takes up to four times the speed, one of the speed less
/// than all of anything. The fewer, the more bits of a slow motor's small multipliers are left.
const CURRENT_SHIFT: i32 = 3;
const SPEED_SHIFT: i32 = 1;
/// Bits of the multipliers of the travel below the point: motors up to 8,192 counts a period fit, and half a bit is off by
/// less than a hundredth of a count after 4,000 periods.
const TRAVEL_POINT: i32 = 18;
/// Left shift that makes a duty in Q15 an upper word, which has 28 bits below the point.
const DUTY_SHIFT: i32 = 28 - 15;

/// A row times current, speed and duty; the bits below the point add up.
#[inline(always)]
fn weighted_sum(row: &Row<i32>, current: i32, speed: i32, duty: i16) -> i64 {
    let duty = i32::from(duty) << DUTY_SHIFT;
    product(row[0], current) + product(row[1], speed) + product(row[2], duty)
}

/// Where errors saturate, in 1024ths of a count: beyond 65,536 counts. One of more than two million wraps, but it gets there
/// through dozens of periods whose errors rule the model out.
const MOST: i32 = 1 << 26;

/// An error, saturated.
#[inline(always)]
fn limited(error: i32) -> i32 {
    error.clamp(-MOST, MOST - 1)
}

/// `x · 2ⁿ`, word by word: as one shift the compiler would put it into the multipliers, which then had 64 bits.
#[inline(always)]
fn raised(x: i64, n: i32) -> i64 {
    let (high, low) = ((x >> 32) as u32, x as u32);
    let high = (high << n) | (low >> (32 - n));
    (i64::from(high as i32) << 32) | i64::from(low << n)
}

/// A row of a map as mantissas with so many bits below the point.
fn mantissas(of: &[FixedCoefficient; 4], bits: i32) -> Option<Row<i32>> {
    let [a, b, c, _] = of;
    Some([a.mantissa(bits)?, b.mantissa(bits)?, c.mantissa(bits)?])
}

impl Arithmetic for Fixed {
    const FORMAT: Format = Format::Fixed;
    const EMPTY: Evaluation<Fixed> = Evaluation::of(
        Fixed::from_bits(0),
        FixedCoefficient::ZERO,
        FixedRows {
            current: [0; 3],
            speed: [0; 3],
            travel: [0; 3],
        },
        0,
        (0, 0),
    );
    type Rows = FixedRows;
    /// Counts with 32 bits below the point.
    type AngleError = i64;
    /// With 10 and 20 bits below the point. The sum wraps beyond a mean of 1,024 counts, where all that it could take off the
    /// squares is less than a thousandth of them: 32 bits save each period three instructions.
    type Sums = (i32, i64);

    compiled_here!(1);

    fn rows(
        increments: [&[Self::Coefficient; 4]; 3],
        counts_per_unit: Self::Coefficient,
    ) -> Option<FixedRows> {
        let [current, speed, angle] = increments;
        let travel = angle.map(|k| k.by(counts_per_unit));
        Some(FixedRows {
            current: mantissas(current, 32 - CURRENT_SHIFT)?,
            speed: mantissas(speed, 32 - SPEED_SHIFT)?,
            travel: mantissas(&travel, TRAVEL_POINT)?,
        })
    }

    fn pull(_: &FixedRows, current: Fixed, _: Fixed) -> Fixed {
        current
    }

    fn current(_: &FixedRows, pull: Fixed, _: Fixed, _: Fixed) -> Fixed {
        pull
    }

    #[inline(always)]
    fn drive(_: &FixedRows, pull: Fixed, _: Fixed, _: Fixed) -> Fixed {
        pull
    }

    fn drive_of(_: &FixedRows, current: Fixed) -> Fixed {
        current
    }

    fn sliding(_: &FixedRows, sense: Fixed, by: (Fixed, Fixed, i64)) -> Sliding<Fixed> {
        let (pull, speed, error) = by;
        Sliding {
            push: Fixed::default(),
            pull,
            speed,
            error,
            sense,
        }
    }

    #[inline(always)]
    fn add_sliding((pull, speed): (Fixed, Fixed), by: &Sliding<Fixed>) -> (Fixed, Fixed) {
        (pull + by.pull, speed + by.speed)
    }

    #[inline(always)]
    fn step_row(
        rows: &FixedRows,
        (current, speed, error): (Fixed, Fixed, i64),
        duty: i16,
        step: i16,
    ) -> (Fixed, Fixed, i64) {
        let (c, s) = (current.word(), speed.word());
        // Upper words have 28 bits below the point, errors 32.
        let travel = weighted_sum(&rows.travel, c, s, duty) >> (TRAVEL_POINT - 4);
        (
            current
                + Fixed::from_bits(raised(
                    weighted_sum(&rows.current, c, s, duty),
                    CURRENT_SHIFT,
                )),
            speed + Fixed::from_bits(raised(weighted_sum(&rows.speed, c, s, duty), SPEED_SHIFT)),
            error
                .wrapping_add(travel)
                .wrapping_sub(i64::from(step) << 32),
        )
    }

    fn advance_error(error: i64, angle: Self::Angle, step: i16) -> i64 {
        let by = angle.bits().wrapping_sub(i64::from(step) << 32);
        error.wrapping_add(by)
    }

    fn counts(error: i64) -> f32 {
        error as f32 * (1.0 / 4_294_967_296.0)
    }

    #[inline(always)]
    fn along(speed: Fixed, sense: Fixed) -> bool {
        // A speed below what the upper word holds counts as none.
        let (speed, sense) = (speed.word(), sense.word());
        speed != 0 && (speed ^ sense) >= 0
    }

    #[inline(always)]
    fn collect(sums: &mut Self::Sums, error: i64) {
        let error = limited((error >> 22) as i32);
        sums.0 = sums.0.wrapping_add(error);
        // 2⁵² each at most: a device's recording has less than 2¹¹ periods.
        sums.1 = sums.1.wrapping_add(product(error, error));
    }

    #[inline(always)]
    fn sums(sums: &Self::Sums) -> (f32, f32) {
        (
            sums.0 as f32 * (1.0 / 1024.0),
            sums.1 as u64 as f32 * (1.0 / 1_048_576.0),
        )
    }

    #[inline(always)]
    fn surely_below(sums: &Self::Sums, most: f32) -> bool {
        // Whole counts², rounded down on either side.
        ((sums.1 as u64 >> 20) as u32) < most as u32 && sums.1 >> 52 == 0
    }
}
