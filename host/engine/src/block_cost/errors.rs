//! The errors of a block of samples, a stride at a time.

use super::zero_order_hold::{LinearState, STRIDE, Span, StrideAngles};
use crate::lanes::with_vectors;

/// A motor's response to one command, over a stride.
pub(super) struct Motion<'m> {
    /// What a stride adds.
    pub(super) stride: &'m Span,
    /// The angles in it.
    pub(super) ahead: &'m StrideAngles,
    /// The command.
    pub(super) command: f64,
}

/// Model minus reading at each sample of a block that starts in the state `motor`, counts.
pub(super) fn errors(
    motion: &Motion<'_>,
    motor: LinearState,
    readings: &[f64],
    errors: &mut [f64],
) {
    with_vectors(
        #[inline(always)]
        || of_block(motion, motor, readings, errors),
    );
}

#[inline(always)]
fn of_block(motion: &Motion<'_>, mut motor: LinearState, readings: &[f64], errors: &mut [f64]) {
    let (ahead, command) = (motion.ahead, motion.command);
    let [by_current, by_speed] = &ahead.by_state;
    let mut driven = ahead.by_command;
    for driven in &mut driven {
        *driven *= command;
    }
    let (strides, rest) = errors.as_chunks_mut::<STRIDE>();
    let (read, last) = readings.as_chunks::<STRIDE>();
    for (errors, readings) in strides.iter_mut().zip(read) {
        let LinearState { state, angle } = motor;
        for k in 0..STRIDE {
            let transient = by_current[k] * state[0] + by_speed[k] * state[1];
            errors[k] = ((driven[k] + angle) - readings[k]) + transient;
        }
        motor = motion.stride.advance(motor, command);
    }
    let LinearState { state, angle } = motor;
    for (k, (error, reading)) in rest.iter_mut().zip(last).enumerate() {
        let transient = by_current[k] * state[0] + by_speed[k] * state[1];
        *error = ((driven[k] + angle) - reading) + transient;
    }
}
