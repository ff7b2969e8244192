//! What made the device start.

use core::fmt;
use serde::{Deserialize, Serialize};

/// What made the device start, as far as its chip can tell. Append only.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Reset {
    /// The chip does not say, or the board does not ask it.
    #[default]
    Unknown,
    /// Its supply came up; on chips that do not tell them apart, also after a brown-out.
    PowerUp,
    /// The supply sagged below what the chip needs.
    BrownOut,
    /// The reset pin: a button, or a debugger.
    Pin,
    /// The watchdog: the control loop did not come round in time.
    Watchdog,
    /// The program or a debugger asked for it.
    Software,
    /// The program panicked.
    Panic,
    /// The processor met an instruction or an address that it could not obey.
    HardFault,
    /// The clock's crystal stopped.
    ClockFailure,
}

impl Reset {
    /// All of them, in the order of the wire.
    pub const ALL: [Reset; 9] = [
        Reset::Unknown,
        Reset::PowerUp,
        Reset::BrownOut,
        Reset::Pin,
        Reset::Watchdog,
        Reset::Software,
        Reset::Panic,
        Reset::HardFault,
        Reset::ClockFailure,
    ];
}

impl fmt::Display for Reset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Reset::Unknown => "unknown",
            Reset::PowerUp => "power-up",
            Reset::BrownOut => "brown-out",
            Reset::Pin => "reset pin",
            Reset::Watchdog => "watchdog",
            Reset::Software => "software",
            Reset::Panic => "panic",
            Reset::HardFault => "hard fault",
            Reset::ClockFailure => "clock failure",
        })
    }
}
