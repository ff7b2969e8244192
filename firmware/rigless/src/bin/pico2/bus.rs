//! The bus between the core and all else: that of `rp2350-emu`, but for the peripherals that the bench has of its own.

use std::sync::Arc;

use rp2350_emu::Bus;
use rp2350_emu::core::CoreBus;
use rp2350_emu::threaded::CoreAtomics;

use crate::carrier::{self, Carrier};
use crate::decode::understood;
use crate::uart::{self, Uart};
use crate::watchdog::{self, Watchdog};

/// PIO0, and how many cycles the state machine of the encoder gets before its queue is read: half a round of its program.
const PIO: u32 = 0x5020_0000;
const PIO_CYCLES: u32 = 8;
/// Where its first state machine is given an instruction from outside, and `set x, 2` and `mov y, ::x`.
const PIO_INSTRUCTION: u32 = 0xd8;
const COUNT_FROM_HIGH: [u32; 2] = [0xe022, 0xa051];

/// The peripherals that are the bench's.
#[derive(Debug, Default)]
pub struct Peripherals {
    pub uart: Uart,
    pub carrier: Carrier,
    pub watchdog: Watchdog,
    /// The encoder's state machine has begun.
    counts: bool,
}

/// Where the boot ROM leaves a function that gets the flash ready to be read, and a whole one: `bx lr`, twice.
const BOOT_RAM: u32 = 0x400e_0000;
const RETURN: u32 = 0x4770_4770;

/// A bus for an instruction, at `now`, cycles.
pub struct Wired<'a> {
    bus: &'a mut Bus,
    own: &'a mut Peripherals,
    now: u64,
    /// Where the instruction is.
    pc: u32,
}

/// A word's address without the bits that choose what a write does to it, and those: set to it, exclusive or, or, and not.
fn place(address: u32) -> (u32, u32, u32) {
    (address & !0x3fff, address & 0xffc, (address >> 12) & 3)
}

impl<'a> Wired<'a> {
    /// This bus, before the next instruction.
    pub fn new(bus: &'a mut Bus, own: &'a mut Peripherals, now: u64) -> Self {
        Self {
            bus,
            own,
            now,
            pc: u32::MAX,
        }
    }

    /// A word of the bench's own peripherals.
    fn own(&mut self, address: u32) -> Option<u32> {
        let (base, offset, _) = place(address);
        match base {
            BOOT_RAM => Some(RETURN),
            uart::BASE => Some(self.own.uart.read(offset, self.now)),
            carrier::BASE => Some(self.own.carrier.read(offset)),
            watchdog::BASE => Some(self.own.watchdog.read(offset)),
            PIO => {
                self.settle(PIO_CYCLES);
                None
            }
            _ => None,
        }
    }

    /// Writes one of them; false if it is not one.
    fn write_own(&mut self, address: u32, value: u32) -> bool {
        let (base, offset, how) = place(address);
        if ![uart::BASE, carrier::BASE, watchdog::BASE].contains(&base) {
            return false;
        }
        let value = match how {
            0 => value,
            _ => {
                let old = self.own(address).unwrap_or(0);
                [value, old ^ value, old | value, old & !value][how as usize]
            }
        };
        match base {
            uart::BASE => self.own.uart.write(offset, value),
            carrier::BASE => self.own.carrier.write(offset, value, self.now),
            _ => self.own.watchdog.write(offset, value, self.now),
        }
        true
    }

    /// Lets the state machines run. They stand still but where that shows: when a line has changed, and when they are asked.
    pub fn settle(&mut self, cycles: u32) {
        let pins = self.gpio_read_in().into();
        let pio = &mut self.bus.pio[0];
        if !self.own.counts && pio.sm_enabled_mask() & 1 != 0 {
            self.own.counts = true;
            // The emulator's `jmp y--` leaves a zero as it is; a chip's does not (data sheet, 11.4.2.2). From 2³⁰ on, it meets none.
            for instruction in COUNT_FROM_HIGH {
                pio.write32(PIO_INSTRUCTION, instruction, 0);
                pio.step_with_pins(pins);
            }
        }
        pio.step_n_with_pins(cycles, pins);
    }
}

/// The bits of a word that a narrower read of it gives.
fn narrow(word: u32, address: u32, mask: u32) -> u32 {
    (word >> (8 * (address & 3))) & mask
}

impl CoreBus for Wired<'_> {
    fn read8(&mut self, address: u32, core: u8) -> u8 {
        match self.own(address & !3) {
            Some(word) => narrow(word, address, 0xff) as u8,
            None => self.bus.read8(address, core),
        }
    }
    fn read16(&mut self, address: u32, core: u8) -> u16 {
        match self.own(address & !3) {
            Some(word) => narrow(word, address, 0xffff) as u16,
            // The core asks for an instruction by halves.
            None if address.wrapping_sub(self.pc) < 4 => {
                let words = [0, 2].map(|at| self.bus.read16(self.pc + at, core));
                understood(words)[(address - self.pc) as usize / 2]
            }
            None => self.bus.read16(address, core),
        }
    }
    fn read32(&mut self, address: u32, core: u8) -> u32 {
        match self.own(address) {
            Some(word) => word,
            None => self.bus.read32(address, core),
        }
    }
    // A narrow write reaches a peripheral as a word that repeats it (RP2350 data sheet, 2.1.5).
    fn write8(&mut self, address: u32, value: u8, core: u8) {
        if !self.write_own(address & !3, u32::from(value) * 0x0101_0101) {
            self.bus.write8(address, value, core);
        }
    }
    fn write16(&mut self, address: u32, value: u16, core: u8) {
        if !self.write_own(address & !3, u32::from(value) * 0x0001_0001) {
            self.bus.write16(address, value, core);
        }
    }
    fn write32(&mut self, address: u32, value: u32, core: u8) {
        if !self.write_own(address, value) {
            self.bus.write32(address, value, core);
        }
    }
    fn set_active_pc(&mut self, pc: u32, core: u8) {
        self.pc = pc;
        self.bus.set_active_pc(pc, core);
    }
    fn bus_fault(&self, core: u8) -> bool {
        self.bus.bus_fault(core.into())
    }
    fn bus_fault_addr(&self, core: u8) -> u32 {
        self.bus.bus_fault_addr(core.into())
    }
    fn clear_bus_fault(&mut self, core: u8) {
        self.bus.clear_bus_fault(core.into());
    }
    fn set_burst_mode(&mut self, on: bool) {
        CoreBus::set_burst_mode(self.bus, on);
    }
    fn add_extra_wait_states(&mut self, n: u32) {
        self.bus.add_extra_wait_states(n);
    }
    fn take_extra_wait_states(&mut self) -> u32 {
        self.bus.take_extra_wait_states()
    }
    fn atomics(&self) -> &Arc<CoreAtomics> {
        self.bus.atomics()
    }
    fn gpio_read_out(&self) -> u32 {
        self.bus.gpio_read_out()
    }
    fn gpio_write_out(&mut self, value: u32) {
        self.bus.gpio_write_out(value);
    }
    fn gpio_set_out(&mut self, mask: u32) {
        self.bus.gpio_set_out(mask);
    }
    fn gpio_clear_out(&mut self, mask: u32) {
        self.bus.gpio_clear_out(mask);
    }
    fn gpio_xor_out(&mut self, mask: u32) {
        self.bus.gpio_xor_out(mask);
    }
    fn gpio_read_oe(&self) -> u32 {
        self.bus.gpio_read_oe()
    }
    fn gpio_write_oe(&mut self, value: u32) {
        self.bus.gpio_write_oe(value);
    }
    fn gpio_set_oe(&mut self, mask: u32) {
        self.bus.gpio_set_oe(mask);
    }
    fn gpio_clear_oe(&mut self, mask: u32) {
        self.bus.gpio_clear_oe(mask);
    }
    fn gpio_xor_oe(&mut self, mask: u32) {
        self.bus.gpio_xor_oe(mask);
    }
    fn gpio_read_in(&self) -> u32 {
        self.bus.gpio_read_in()
    }
    fn extra_wait_states(&self) -> u32 {
        self.bus.extra_wait_states()
    }
    fn reset_extra_wait_states(&mut self) {
        self.bus.reset_extra_wait_states();
    }
    fn last_fetch_addr(&self) -> u32 {
        self.bus.last_fetch_addr()
    }
    fn set_last_fetch_addr(&mut self, address: u32) {
        self.bus.set_last_fetch_addr(address);
    }
    fn mmio_trace_enabled(&self) -> bool {
        false
    }
    fn emit_mmio_trace(&mut self, _: char, _: u32, _: u32, _: u32, _: u8) {}
}
