//! Slice 0 of the PWM (RP2350 data sheet, 12.5), of which `rp2350-emu` has no centred carrier, and takes new compare values over at
//! once.

/// Where the PWM is.
pub const BASE: u32 = 0x400a_8000;

/// Registers of slice 0, and of all.
const CONTROL: u32 = 0x00;
const COUNTER: u32 = 0x08;
const COMPARE: u32 = 0x0c;
const TOP: u32 = 0x10;
const ENABLED: u32 = 0xf0;
const TURNED: u32 = 0xf4;

/// Bits of the control register.
const ENABLE: u32 = 1 << 0;
const CENTRED: u32 = 1 << 1;

/// The carrier.
#[derive(Debug, Default)]
pub struct Carrier {
    /// Registers of the slice, by number.
    kept: [u32; 5],
    /// The marks of a turn at zero.
    turned: u32,
    /// Compare values and largest count that act.
    active: [u32; 2],
    /// When it is at zero next, if it runs.
    zero_at: Option<u64>,
}

impl Carrier {
    /// What a register shows.
    pub fn read(&self, offset: u32) -> u32 {
        match offset {
            TURNED => self.turned,
            ENABLED => u32::from(self.zero_at.is_some()),
            _ => self.kept.get(offset as usize / 4).copied().unwrap_or(0),
        }
    }

    /// Takes what the program writes, at `now`, cycles.
    pub fn write(&mut self, offset: u32, value: u32, now: u64) {
        match offset {
            TURNED => self.turned &= !value,
            ENABLED => self.enable(value & 1 != 0, now),
            _ => {
                if let Some(kept) = self.kept.get_mut(offset as usize / 4) {
                    *kept = value;
                }
                if offset == CONTROL {
                    self.enable(value & ENABLE != 0, now);
                }
            }
        }
    }

    fn enable(&mut self, on: bool, now: u64) {
        match (on, self.zero_at) {
            (true, None) => {
                self.take_over();
                let counted = u64::from(self.kept[COUNTER as usize / 4]);
                self.zero_at = Some(now + self.period() - counted);
            }
            (false, _) => self.zero_at = None,
            _ => {}
        }
    }

    /// When it is at zero next, cycles.
    pub fn due(&self) -> u64 {
        self.zero_at.unwrap_or(u64::MAX)
    }

    /// It is at zero: new compare values act from here on.
    pub fn turn(&mut self) {
        self.take_over();
        self.turned |= 1;
        self.zero_at = self.zero_at.map(|at| at + self.period());
    }

    /// The part of a period for which output A is high for longer than B.
    pub fn duty(&self) -> f64 {
        let [compare, top] = self.active;
        (f64::from(compare & 0xffff) - f64::from(compare >> 16)) / f64::from(top + 1)
    }

    fn take_over(&mut self) {
        self.active = [COMPARE, TOP].map(|offset| self.kept[offset as usize / 4]);
    }

    fn period(&self) -> u64 {
        let centred = self.kept[CONTROL as usize / 4] & CENTRED != 0;
        (u64::from(self.active[1]) + 1) * if centred { 2 } else { 1 }
    }
}
