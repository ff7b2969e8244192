//! Raspberry Pi Pico with a bridge module of two half bridges and an enable input, such as two BTS7960 on one board. Not
//! yet run on hardware.
//!
//! | pin | what |
//! |---|---|
//! | GP16 | half bridge of motor lead + (RPWM) |
//! | GP17 | half bridge of motor lead − (LPWM) |
//! | GP18 | enables both half bridges (R_EN and L_EN), pulled down by 10 kΩ to ground |
//! | GP19 | fault output of the bridge, active low; may stay open |
//! | GP20, GP21 | encoder A and B |
//! | GP0, GP1 | link, transmit and receive |
//!
//! The dead time is the module's business: this chip's PWM has none.

mod clocks;
mod divider;
mod encoder;
mod link;

use rp_pac::{IO_BANK0, PADS_BANK0, PWM, ROSC, SIO};

use self::clocks::CORE_HZ;
use self::encoder::Encoder;
use self::link::Link;
use super::Board;
use super::entropy::Entropy;
use super::half_bridges::HalfBridges;
use super::period::Period;
use crate::phase::Fault;

const PERIOD_US: u32 = 1000;
/// Compare value of an output that is always high: the carrier counts up to the step before it and down again, at 20 kHz.
const FULL: u16 = 3125;

/// Pins.
const LINK: [usize; 2] = [0, 1];
const BRIDGE: [usize; 2] = [16, 17];
const ENABLE: usize = 18;
const FAULT: usize = 19;
const ENCODER: [usize; 2] = [20, 21];
/// Part of the PWM that has the bridge's pins.
const SLICE: usize = 0;
/// Mark of the PWM that its counter has come to zero again, where it takes new compare values over (RP2040 data sheet, 4.5.2.3
/// and 4.5.2.7).
const TAKEN_OVER: u32 = 1 << SLICE;

/// What a pin is for (RP2040 data sheet, 2.19.2).
#[derive(Clone, Copy)]
enum Function {
    Uart = 2,
    Pwm = 4,
    Program = 5,
    Pio = 6,
}

/// The second stage of the boot loader, for the Pico's flash. Unsafe, because the chip runs what stands in this section.
#[unsafe(link_section = ".boot2")]
#[used]
static BOOT2: [u8; 256] = rp2040_boot2::BOOT_LOADER_W25Q080;

/// Raspberry Pi Pico and its bridge. By the chip's registers: what a library for all of its uses asks and holds would be a
/// tenth of the image.
pub struct Rp2040 {
    encoder: Encoder,
    link: Link,
    period: Period,
    entropy: Entropy,
    /// Whether the bridge is to be closed from the carrier's next turn on.
    drives: bool,
}

impl Rp2040 {
    /// Takes the microcontroller over. Once: a second call would find its peripherals taken, and panics.
    pub fn start() -> Self {
        let core = cortex_m::Peripherals::take().expect("a board is put together once");
        // Before anything else, and before the pin leaves its reset.
        open_bridge();
        clocks::start();
        SIO.gpio_oe(0).value_set().write_value(1 << ENABLE);
        connect(&[ENABLE], Function::Program, false);
        let carrier = PWM.ch(SLICE);
        carrier.top().write(|w| w.set_top(FULL - 1));
        connect(&BRIDGE, Function::Pwm, false);
        connect(&[FAULT], Function::Program, true);
        connect(&ENCODER, Function::Pio, true);
        connect(&LINK, Function::Uart, true);
        let mut entropy = Entropy::default();
        for _ in 0..4 {
            let noise = (0..32).fold(0, |noise, _| {
                (noise << 1) | u32::from(ROSC.randombit().read().randombit())
            });
            entropy.stir(noise);
        }
        let mut board = Self {
            encoder: Encoder::start(ENCODER[0] as u8),
            link: Link::start(CORE_HZ),
            period: Period::new(core.SYST, CORE_HZ / 1_000_000 * PERIOD_US),
            entropy,
            drives: false,
        };
        // The carrier begins at its peak, with the control period. A new duty, of both legs at once, takes effect when it has
        // come down, 25 µs and the little that passes here after the period's end, every time: so the program has time to give it.
        board.coast();
        carrier.ctr().write(|w| w.set_ctr(FULL - 1));
        carrier.csr().write(|w| {
            w.set_ph_correct(true);
            w.set_en(true);
        });
        board
    }
}

/// Gives pins a function; those that are pulled up are inputs.
fn connect(pins: &[usize], function: Function, pulled_up: bool) {
    for &pin in pins {
        PADS_BANK0.gpio(pin).modify(|w| {
            w.set_pde(!pulled_up);
            w.set_pue(pulled_up);
            w.set_ie(true);
        });
        IO_BANK0
            .gpio(pin)
            .ctrl()
            .write(|w| w.set_funcsel(function as u8));
    }
}

/// Its two half bridges.
const LEGS: HalfBridges = HalfBridges {
    full: FULL,
    refresh: 0,
};

impl Board for Rp2040 {
    const NAME: &'static str = "Raspberry Pi Pico";
    const PERIOD_US: u32 = PERIOD_US;
    // A core without a floating-point unit: some 1,500 instructions a sample.
    const SLICE: u32 = 20;

    fn drive(&mut self, duty: i16) {
        let (a, b) = LEGS.compares(duty);
        PWM.ch(SLICE).cc().write(|w| {
            w.set_a(a);
            w.set_b(b);
        });
        self.drives = true;
    }

    fn full(&self) -> u16 {
        LEGS.full_duty()
    }

    fn nearest(&self, duty: i16) -> i16 {
        LEGS.nearest(duty)
    }

    fn coast(&mut self) {
        open_bridge();
        self.drives = false;
        // Both low: no voltage.
        PWM.ch(SLICE).cc().write(|w| w.0 = 0);
    }

    fn count(&mut self) -> i32 {
        // The carrier always runs, whether the bridge is open or not.
        while PWM.intr().read().0 & TAKEN_OVER == 0 {}
        if self.drives {
            SIO.gpio_out(0).value_set().write_value(1 << ENABLE);
        }
        self.encoder.count()
    }

    fn tick(&mut self) -> Result<(), Fault> {
        self.period.end()?;
        PWM.intr().write(|w| w.0 = TAKEN_OVER);
        let enabled = SIO.gpio_out(0).value().read() & 1 << ENABLE != 0;
        if enabled && SIO.gpio_in(0).read() & 1 << FAULT == 0 {
            return Err(Fault::Bridge);
        }
        Ok(())
    }

    fn receive(&mut self) -> Option<u8> {
        self.link.receive()
    }

    fn send(&mut self, bytes: &[u8]) -> usize {
        self.link.send(bytes)
    }

    fn entropy(&mut self) -> u32 {
        self.entropy.draw(self.period.time())
    }
}

/// Opens the bridge when all else has failed: whatever the PWM does, the module does not follow it any more.
pub fn open_bridge() {
    SIO.gpio_out(0).value_clr().write_value(1 << ENABLE);
}
