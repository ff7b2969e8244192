//! A number format that a device can fit in, and the few operations of its hot loop.

use super::Evaluation;
use crate::model::{Motion, Rigid, RigidPlan};
use crate::scalar::{Fixed, FixedCoefficient, Readable, Scalar, product};
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
    /// A period without torque on the shaft: pull, speed and lead at its end. With `APART` shorter, where that is slower.
    fn follow<const APART: bool>(
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
    fn follow<const APART: bool>(
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

/// A row times current, speed and duty, with the bits below the point of all of them.
#[inline(always)]
#[cfg(not(short_multiplier))]
fn inlined(row: &Row<i32>, current: i32, speed: i32, duty: i16) -> i64 {
    let duty = i32::from(duty) << DUTY_SHIFT;
    product(row[0], current) + product(row[1], speed) + product(row[2], duty)
}

/// The same of halves: those of one weight are summed first, and moved to their place together. The product with a duty is
/// half the bits, and half the work.
#[inline(always)]
#[cfg(short_multiplier)]
fn inlined(row: &Row<i32>, current: i32, speed: i32, duty: i16) -> i64 {
    let halves = |x: i32| (x & 0xffff, x >> 16);
    let ((c_low, c_high), (s_low, s_high)) = (halves(current), halves(speed));
    let ((a_low, a_high), (b_low, b_high)) = (halves(row[0]), halves(row[1]));
    let (d_low, d_high) = halves(row[2]);
    let times = |a: i32, b: i32| i64::from(a.wrapping_mul(b));
    let high = (a_high.wrapping_mul(c_high)).wrapping_add(b_high.wrapping_mul(s_high));
    let cross =
        times(a_high, c_low) + times(a_low, c_high) + times(b_high, s_low) + times(b_low, s_high);
    let low =
        i64::from(a_low.wrapping_mul(c_low) as u32) + i64::from(b_low.wrapping_mul(s_low) as u32);
    let duty = i32::from(duty);
    // In all 45 bits: shifted as one.
    let by_duty = (times(d_high, duty) << 16) + times(d_low, duty);
    (i64::from(high) << 32)
        .wrapping_add(cross << 16)
        .wrapping_add(low)
        .wrapping_add(raised(by_duty, DUTY_SHIFT))
}

/// The same as a routine.
#[cfg_attr(short_multiplier, inline(never))]
#[cfg_attr(not(short_multiplier), inline(always))]
fn apart(row: &Row<i32>, current: i32, speed: i32, duty: i16) -> i64 {
    inlined(row, current, speed, duty)
}

/// The same, `APART` if speed matters less than length.
#[inline(always)]
fn weighed<const APART: bool>(row: &Row<i32>, current: i32, speed: i32, duty: i16) -> i64 {
    if APART {
        apart(row, current, speed, duty)
    } else {
        inlined(row, current, speed, duty)
    }
}

/// Where leads saturate, in 1024ths of a count: beyond 65,536 counts. One of more than two million wraps, but it gets there through
/// dozens of periods with leads that rule the model out.
const MOST: i32 = 1 << 26;

/// A lead as far as it counts: an instruction where there is one for it.
#[cfg(not(short_multiplier))]
#[inline(always)]
fn limited(lead: i32) -> i32 {
    saturated(lead)
}

/// The same where a choice in place would cost each period three times as much as a look: few saturate.
#[cfg(short_multiplier)]
#[inline(always)]
fn limited(lead: i32) -> i32 {
    if (-MOST..MOST).contains(&lead) {
        lead
    } else {
        saturated(lead)
    }
}

#[cfg_attr(short_multiplier, cold, inline(never))]
#[cfg_attr(not(short_multiplier), inline(always))]
fn saturated(lead: i32) -> i32 {
    lead.clamp(-MOST, MOST - 1)
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
    /// With 32 bits below the point.
    type Lead = i64;
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

    fn turning(_: &FixedRows, sense: Fixed, by: (Fixed, Fixed, i64)) -> Turning<Fixed> {
        let (pull, speed, lead) = by;
        Turning {
            push: Fixed::default(),
            pull,
            speed,
            lead,
            sense,
        }
    }

    #[inline(always)]
    fn turned((pull, speed): (Fixed, Fixed), by: &Turning<Fixed>) -> (Fixed, Fixed) {
        (pull + by.pull, speed + by.speed)
    }

    #[inline(always)]
    fn follow<const APART: bool>(
        rows: &FixedRows,
        (current, speed, lead): (Fixed, Fixed, i64),
        duty: i16,
        step: i16,
    ) -> (Fixed, Fixed, i64) {
        let (c, s) = (current.word(), speed.word());
        // Upper words have 28 bits below the point, leads 32.
        let travel = weighed::<APART>(&rows.travel, c, s, duty) >> (TRAVEL_POINT - 4);
        (
            current
                + Fixed::from_bits(raised(
                    weighed::<APART>(&rows.current, c, s, duty),
                    CURRENT_SHIFT,
                )),
            speed
                + Fixed::from_bits(raised(
                    weighed::<APART>(&rows.speed, c, s, duty),
                    SPEED_SHIFT,
                )),
            lead.wrapping_add(travel)
                .wrapping_sub(i64::from(step) << 32),
        )
    }

    fn ahead(lead: i64, angle: Self::Angle, step: i16) -> i64 {
        let by = angle.bits().wrapping_sub(i64::from(step) << 32);
        lead.wrapping_add(by)
    }

    fn counts(lead: i64) -> f32 {
        lead as f32 * (1.0 / 4_294_967_296.0)
    }

    #[inline(always)]
    fn along(speed: Fixed, sense: Fixed) -> bool {
        // A speed below what the upper word holds counts as none.
        let (speed, sense) = (speed.word(), sense.word());
        speed != 0 && (speed ^ sense) >= 0
    }

    #[inline(always)]
    fn collect(sums: &mut Self::Sums, lead: i64) {
        let lead = limited((lead >> 22) as i32);
        sums.0 = sums.0.wrapping_add(lead);
        // 2⁵² each at most: a device's recording has less than 2¹¹ periods.
        sums.1 = sums.1.wrapping_add(product(lead, lead));
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
