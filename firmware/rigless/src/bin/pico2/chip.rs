//! A Pico 2 with an image in its flash: one core of `rp2350-emu`, the bench's own serial port, carrier and watchdog, and pins.

use std::sync::atomic::Ordering;

use rp2350_emu::{Config, Emulator};

use crate::bus::{Peripherals, Wired};
use crate::rom;
use crate::uart;
use crate::watchdog::Watchdog;

/// Core clock, Hz.
pub const HZ: f64 = 150e6;

/// Pins: see the firmware's `board/pico.rs`.
const ENABLE: u32 = 1 << 18;
const FAULT: u32 = 1 << 19;
const LINES: [u32; 2] = [1 << 20, 1 << 21];

/// The flash and the table of vectors at its beginning; where the core looks for that; a register that tells about the chip.
const FLASH: u32 = 0x1000_0000;
/// The Pico 2's.
const FLASH_SIZE: usize = 4 << 20;
const VECTOR_TABLE: u32 = 0xe000_ed08;
const CHIP_ID: u32 = 0x4000_0000;
/// Cycles that the encoder's state machine gets when a line has changed: a few rounds of its program.
const SETTLING: u32 = 64;
/// The most cycles without a look at what is due.
const LONGEST: u64 = 150;

/// The chip, and what it has on its pins.
pub struct Chip {
    flash: Vec<u8>,
    emulator: Emulator,
    /// Serial port, carrier and watchdog.
    pub own: Peripherals,
    inputs: u32,
    /// Cycles since power-up.
    pub now: u64,
    /// The core stands still until a reset, and all around it goes on: so looks a program that never comes back.
    pub wedged: bool,
}

/// What stopped the chip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// The carrier is at zero; a new duty has not yet been taken over.
    Turn,
    /// The watchdog has reset the chip.
    Reset,
    /// The time is over.
    Time,
}

impl Chip {
    /// After power-up, with `flash` from the flash's beginning on.
    pub fn new(mut flash: Vec<u8>) -> Self {
        flash.resize(FLASH_SIZE, 0xff);
        let own = Peripherals::default();
        let emulator = boot(&flash);
        Self {
            flash,
            emulator,
            own,
            inputs: FAULT,
            now: 0,
            wedged: false,
        }
    }

    /// Runs until the carrier turns, the chip resets or `end`, cycles.
    pub fn run(&mut self, end: u64) -> Stop {
        loop {
            let interrupt = self.own.uart.carry(self.now);
            if self.now >= self.own.watchdog.due() {
                self.reset();
                return Stop::Reset;
            }
            if self.now >= self.own.carrier.due() {
                return Stop::Turn;
            }
            if self.now >= end {
                return Stop::Time;
            }
            self.advance(interrupt, end);
        }
    }

    /// Lets the core run until something is due.
    fn advance(&mut self, interrupt: bool, end: u64) {
        let Self { emulator, own, .. } = self;
        // The emulator's oscillators and loops lock by this clock, which a read takes over.
        emulator.clock.cycles = self.now;
        emulator.mmio_read32(CHIP_ID);
        let (cores, bus) = (emulator.cores.expect_arm_mut(), &mut emulator.bus);
        let core = &mut cores[0];
        if interrupt {
            bus.atomics.assert_irq(0, uart::INTERRUPT);
        }
        let timer = u64::from(core.ppb.syst_cvr) + 1;
        let due = (self.now + timer)
            .min(own.carrier.due())
            .min(own.uart.due(self.now))
            .min(own.watchdog.due())
            .min(end)
            .max(self.now + 1);
        // Masked or not, an interrupt ends a sleep.
        if interrupt || timer_is_pending(core.ppb.read32(0xe000_ed04)) {
            bus.atomics.clear_halted(0);
        }
        if self.wedged || core.is_halted() {
            self.now = due;
        } else if rom::is_at(core.regs.r[15]) {
            self.now += rom::run(emulator, &mut self.flash);
            let core = &mut emulator.cores.expect_arm_mut()[0];
            core.ppb.systick_advance(self.now);
            return self.show();
        } else {
            let (until, before) = (due.min(self.now + LONGEST), core.cycles());
            let start = self.now;
            while self.now < until && !core.is_halted() && !rom::is_at(core.regs.r[15]) {
                core.ppb.update_latest_cycles(core.cycles());
                core.step(&mut Wired::new(bus, own, self.now));
                self.now = start + core.cycles() - before;
            }
        }
        core.ppb.systick_advance(self.now);
        self.show();
    }

    /// The power goes and comes back: the flash is as it was.
    pub fn cut_power(&mut self) {
        self.reset();
        self.own.watchdog = Watchdog::default();
    }

    /// As after power-up, but for what the watchdog keeps and what is on its way on the line.
    fn reset(&mut self) {
        self.emulator = boot(&self.flash);
        let Peripherals { uart, watchdog, .. } = std::mem::take(&mut self.own);
        self.own.watchdog = watchdog.after_reset();
        self.own.uart = uart.after_reset();
        self.emulator.cores.expect_arm_mut()[0]
            .ppb
            .last_systick_cycles = self.now;
        self.wedged = false;
        self.show();
    }

    /// What the pins show the program.
    fn show(&mut self) {
        let bus = &mut self.emulator.bus;
        let driven = bus.sio.gpio_out & bus.sio.gpio_oe;
        let outside = FAULT | LINES[0] | LINES[1];
        bus.gpio_in
            .store(driven & !outside | self.inputs, Ordering::Relaxed);
    }

    /// The lines of the encoder.
    pub fn encoder(&mut self, lines: [bool; 2]) {
        for (mask, level) in LINES.into_iter().zip(lines) {
            self.inputs = self.inputs & !mask | if level { mask } else { 0 };
        }
        self.show();
        let Self {
            emulator, own, now, ..
        } = self;
        Wired::new(&mut emulator.bus, own, *now).settle(SETTLING);
    }

    /// The fault line of the bridge, active low.
    pub fn fault(&mut self, is: bool) {
        self.inputs = self.inputs & !FAULT | if is { 0 } else { FAULT };
        self.show();
    }

    /// The part of the supply across the winding, as the carrier has it now; nothing while the bridge is open.
    pub fn duty(&self) -> Option<f64> {
        let sio = &self.emulator.bus.sio;
        (sio.gpio_out & sio.gpio_oe & ENABLE != 0).then(|| self.own.carrier.duty())
    }
}

fn timer_is_pending(control: u32) -> bool {
    control & 1 << 26 != 0
}

/// A core about to run the image, as the boot ROM leaves it.
fn boot(flash: &[u8]) -> Emulator {
    let mut emulator = Emulator::new(Config::default());
    emulator.load_bootrom(&rom::image());
    emulator.load_flash(flash);
    let core = &mut emulator.cores.expect_arm_mut()[0];
    let word = |at: usize| u32::from_le_bytes(flash[at..at + 4].try_into().expect("four bytes"));
    core.ppb.write32(VECTOR_TABLE, FLASH);
    (core.regs.r[13], core.regs.msp) = (word(0), word(0));
    core.regs.r[15] = word(4) & !1;
    emulator
}
