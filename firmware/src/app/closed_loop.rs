//! What tuning and following share.

/// Part of the limits of travel and speed that a loop may ask for.
pub(super) const OF_LIMITS: f32 = 0.8;

/// A part of the supply as a duty, which is never the one that stands for an open bridge.
pub(super) fn as_duty(part: f32) -> i16 {
    (part * 32_767.0) as i16
}

/// A duty as a part of the supply.
pub(super) fn as_part(duty: i16) -> f32 {
    f32::from(duty) * (1.0 / 32_768.0)
}
