//! What a run has shown of its motor, so that the next one need not probe.

use super::response::Acceleration;
use serde::{Deserialize, Serialize};

/// What the probe and the drive have shown of a motor.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct Learned {
    pub(super) motion: OfMotion,
    pub(super) current: OfCurrent,
    /// Largest current in the probe's last step, mA.
    pub(super) step_ma: u32,
}

/// How its shaft follows the drive.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct OfMotion {
    pub(super) window: u32,
    pub(super) strong: i16,
    pub(super) turning: i16,
    pub(super) dithers: bool,
    pub(super) acceleration: Acceleration,
}

/// What its winding draws, and how fast which drive makes it.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct OfCurrent {
    pub(super) stall_ma: u32,
    pub(super) fastest: [u32; 2],
    pub(super) strongest: u16,
}

impl Learned {
    /// Nothing: all zeros.
    pub const NOTHING: Self = Learned {
        motion: OfMotion {
            window: 0,
            strong: 0,
            turning: 0,
            dithers: false,
            acceleration: Acceleration { motion: 0, time: 0 },
        },
        current: OfCurrent {
            stall_ma: 0,
            fastest: [0; 2],
            strongest: 0,
        },
        step_ma: 0,
    };
}
