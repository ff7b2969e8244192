//! The watchdog (RP2350 data sheet, 12.9), whose time and reasons `rp2350-emu` has not.

/// Where it is.
pub const BASE: u32 = 0x400d_8000;

/// Registers.
const CONTROL: u32 = 0x00;
const LOAD: u32 = 0x04;
const REASON: u32 = 0x08;
const SCRATCH: u32 = 0x0c;

/// Bits of the control register.
const ENABLE: u32 = 1 << 30;
const TRIGGER: u32 = 1 << 31;

/// Why it reset the chip.
const TIMED_OUT: u32 = 1 << 0;
const FORCED: u32 = 1 << 1;

/// Cycles in a microsecond, which is its step.
const MICROSECOND: u64 = 150;

/// The watchdog.
#[derive(Debug, Default)]
pub struct Watchdog {
    control: u32,
    reason: u32,
    scratch: [u32; 8],
    loaded_us: u32,
    loaded_at: u64,
}

impl Watchdog {
    /// What a register shows.
    pub fn read(&self, offset: u32) -> u32 {
        match offset {
            CONTROL => self.control,
            REASON => self.reason,
            _ => self.place(offset).map_or(0, |at| self.scratch[at]),
        }
    }

    /// Takes what the program writes, at `now`, cycles.
    pub fn write(&mut self, offset: u32, value: u32, now: u64) {
        match offset {
            CONTROL => self.control = value,
            LOAD => (self.loaded_us, self.loaded_at) = (value & 0xff_ffff, now),
            _ => {
                if let Some(at) = self.place(offset) {
                    self.scratch[at] = value;
                }
            }
        }
    }

    fn place(&self, offset: u32) -> Option<usize> {
        let at = offset.checked_sub(SCRATCH)? as usize / 4;
        (at < self.scratch.len()).then_some(at)
    }

    /// When it resets the chip unless it is fed, cycles.
    pub fn due(&self) -> u64 {
        if self.control & TRIGGER != 0 {
            0
        } else if self.control & ENABLE != 0 {
            self.loaded_at + u64::from(self.loaded_us) * MICROSECOND
        } else {
            u64::MAX
        }
    }

    /// As it is after it has reset the chip: it keeps what was left in it, and says why.
    #[must_use]
    pub fn after_reset(&self) -> Self {
        Self {
            reason: if self.control & TRIGGER != 0 {
                FORCED
            } else {
                TIMED_OUT
            },
            scratch: self.scratch,
            ..Self::default()
        }
    }
}
