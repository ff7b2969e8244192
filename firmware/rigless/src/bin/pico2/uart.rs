//! The serial port UART0 (a PL011; RP2350 data sheet, 12.1), which `rp2350-emu` has only for sending, to nobody.

use std::collections::VecDeque;

/// Where it is.
pub const BASE: u32 = 0x4007_0000;
/// Its interrupt.
pub const INTERRUPT: u32 = 33;

/// Registers.
const DATA: u32 = 0x00;
const FLAGS: u32 = 0x18;
const INTERRUPT_LEVELS: u32 = 0x34;
const MASK: u32 = 0x38;
const RAW: u32 = 0x3c;
const MASKED: u32 = 0x40;
const CLEAR: u32 = 0x44;

/// Flags.
const BUSY: u32 = 1 << 3;
const NOTHING_RECEIVED: u32 = 1 << 4;
const SEND_FULL: u32 = 1 << 5;
const NOTHING_TO_SEND: u32 = 1 << 7;

/// Interrupts.
const RECEIVED: u32 = 1 << 4;
const SENT: u32 = 1 << 5;
const RECEIVE_TIMEOUT: u32 = 1 << 6;

/// Bytes in a queue.
const DEPTH: usize = 32;
/// Cycles that a byte takes on the line at 921,600 baud and 150 MHz: ten bits.
const BYTE: u64 = 1628;
/// Cycles without a byte after which those received are worth an interrupt: 32 bits.
const SILENCE: u64 = 5208;

/// The port, and both ends of the line.
#[derive(Debug, Default)]
pub struct Uart {
    /// Registers that only keep what is written, by number.
    kept: [u32; 32],
    sending: VecDeque<u8>,
    received: VecDeque<u8>,
    /// Has sent so many that an interrupt says so, until that is cleared.
    sent: bool,
    send_due: u64,
    receive_due: u64,
    /// Bytes on their way to the chip.
    pub to_chip: VecDeque<u8>,
    /// Bytes that came from it.
    pub from_chip: Vec<u8>,
}

impl Uart {
    /// What a register shows; a byte received is gone then.
    pub fn read(&mut self, offset: u32, now: u64) -> u32 {
        match offset {
            DATA => self.received.pop_front().map_or(0, u32::from),
            FLAGS => {
                let flag = |is: bool, flag: u32| if is { flag } else { 0 };
                flag(!self.sending.is_empty(), BUSY)
                    | flag(self.sending.is_empty(), NOTHING_TO_SEND)
                    | flag(self.sending.len() == DEPTH, SEND_FULL)
                    | flag(self.received.is_empty(), NOTHING_RECEIVED)
            }
            RAW => self.raw(now),
            MASKED => self.raw(now) & self.kept[MASK as usize / 4],
            _ => self.kept.get(offset as usize / 4).copied().unwrap_or(0),
        }
    }

    /// Takes what the program writes.
    pub fn write(&mut self, offset: u32, value: u32) {
        match offset {
            DATA => {
                if self.sending.len() < DEPTH {
                    self.sending.push_back(value as u8);
                }
                self.sent &= self.sending.len() <= self.send_level();
            }
            CLEAR => self.sent &= value & SENT == 0,
            _ => {
                if let Some(kept) = self.kept.get_mut(offset as usize / 4) {
                    *kept = value;
                }
            }
        }
    }

    /// Lets the line carry what it can by now; says if there is an interrupt.
    pub fn carry(&mut self, now: u64) -> bool {
        while !self.sending.is_empty() && now >= self.send_due {
            self.from_chip.extend(self.sending.pop_front());
            self.send_due = now + BYTE;
            self.sent |= self.sending.len() == self.send_level();
        }
        while !self.to_chip.is_empty() && now >= self.receive_due {
            // One that finds no room is lost.
            if let Some(byte) = self
                .to_chip
                .pop_front()
                .filter(|_| self.received.len() < DEPTH)
            {
                self.received.push_back(byte);
            }
            self.receive_due = now + BYTE;
        }
        self.raw(now) & self.kept[MASK as usize / 4] != 0
    }

    /// When the line next has something to carry or to say.
    pub fn due(&self, now: u64) -> u64 {
        let sending = (!self.sending.is_empty()).then_some(self.send_due);
        let receiving = (!self.to_chip.is_empty()).then_some(self.receive_due);
        let silence =
            Some(self.receive_due + SILENCE).filter(|&due| due > now && !self.received.is_empty());
        [sending, receiving, silence]
            .into_iter()
            .flatten()
            .min()
            .unwrap_or(u64::MAX)
    }

    /// As it is after a reset of the chip: what is on the line stays there.
    #[must_use]
    pub fn after_reset(self) -> Self {
        Self {
            to_chip: self.to_chip,
            from_chip: self.from_chip,
            ..Self::default()
        }
    }

    fn raw(&self, now: u64) -> u32 {
        let level = (self.kept[INTERRUPT_LEVELS as usize / 4] >> 3) & 7;
        let received = self.received.len() >= part(level);
        let silent = !self.received.is_empty() && now >= self.receive_due + SILENCE;
        (if received { RECEIVED } else { 0 })
            | (if silent { RECEIVE_TIMEOUT } else { 0 })
            | (if self.sent { SENT } else { 0 })
    }

    fn send_level(&self) -> usize {
        part(self.kept[INTERRUPT_LEVELS as usize / 4] & 7)
    }
}

/// Bytes in a queue that is as full as an interrupt level says.
fn part(level: u32) -> usize {
    [
        DEPTH / 8,
        DEPTH / 4,
        DEPTH / 2,
        DEPTH * 3 / 4,
        DEPTH * 7 / 8,
    ][level.min(4) as usize]
}
