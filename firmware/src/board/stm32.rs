//! Common code of the STM32 boards: the advanced timer TIM1 drives two half bridges, another timer decodes the
//! encoder, a serial port is the link. A board is then a [`Wiring`].

mod bridge;
#[cfg(any(feature = "stm32f103", feature = "stm32f411", feature = "stm32f446"))]
pub mod module;
mod reset;
mod supervision;

use embassy_stm32::gpio::Pull;
use embassy_stm32::interrupt::Priority;
use embassy_stm32::interrupt::typelevel::Interrupt;
use embassy_stm32::peripherals::IWDG;
use embassy_stm32::timer::GeneralInstance4Channel;
use embassy_stm32::timer::qei::{self, Qei};
use embassy_stm32::usart::{self, BufferedUart};
use embassy_stm32::{Peri, pac, uid};
use shared::encoder::Extended;
use shared::wire::Reset;

pub use self::bridge::{Bridge, BridgePins};
pub use self::reset::restart;
use self::supervision::Supervision;

use super::BAUD;
use super::Board;
use super::entropy::Entropy;
use super::generic::Tick;
use super::link::Link;
use super::period::Period;
use super::port::Port;
use super::store::{LONGEST, Store};
use crate::phase::Fault;

/// The cores have a floating-point unit, but for one.
#[cfg(not(feature = "stm32f103"))]
pub type Number = f32;
/// Fixed point.
#[cfg(feature = "stm32f103")]
pub type Number = shared::scalar::Fixed;
/// Periods that they can fit.
#[cfg(not(feature = "stm32f103"))]
pub const CAPACITY: usize = 2000;
/// Periods that it can fit: it has 20 KiB of RAM.
#[cfg(feature = "stm32f103")]
pub const CAPACITY: usize = 500;

/// What the chip keeps over a power cut: nothing on the STM32F103, whose flash has no room beside the image, nor on the STM32G431, whose flash
/// interrupts a program that reads a word of which the power was cut while it was written.
#[cfg(any(feature = "stm32f103", feature = "stm32g431"))]
pub type Keeps = super::store::NoStore;
/// What the chip keeps over a power cut.
#[cfg(not(any(feature = "stm32f103", feature = "stm32g431")))]
pub type Keeps = super::stm32f4::FlashPages;

const PERIOD_US: u32 = 1000;
/// Carrier periods in a control period: 20 kHz, above hearing and below the limit of most gate drivers.
const CARRIERS: u32 = 20;

/// Board-specific connections and parts.
pub trait Wiring {
    /// See [`Board::NAME`].
    const NAME: &'static str;
    /// See [`Board::SLICE`].
    const SLICE: u32;
    /// See [`Board::SENSES_CURRENT`].
    const SENSES_CURRENT: bool = false;
    /// See [`Board::CURRENT_LIMIT_MA`].
    const CURRENT_LIMIT_MA: u32 = 0;
    /// See [`Board::CURRENT_RESOLUTION_MA`].
    const CURRENT_RESOLUTION_MA: u16 = 1;
    /// The timer that decodes the encoder.
    type EncoderTimer: GeneralInstance4Channel;
    /// The interrupt of the link's serial port.
    type LinkInterrupt: Interrupt;

    /// Lets the bridge's driver chip follow its inputs, or not.
    fn enable(&mut self, on: bool);

    /// A reading of the ADC whose last bits are noise.
    fn noise(&mut self) -> u16;

    /// True if the driver chip reports a fault on a line other than the timer's break input. Read while driving only: a
    /// driver that is asleep or wakes up may call that a fault.
    fn reports_fault(&mut self) -> bool {
        false
    }

    /// See [`Board::current_ma`]; `forward` if leg A is high for longer. The carrier is at its peak, where both low sides conduct.
    fn current_ma(&mut self, forward: bool) -> i32 {
        let _ = forward;
        0
    }

    /// See [`Board::supply_mv`].
    fn supply_mv(&mut self) -> Option<u16> {
        None
    }

    /// True if the bridge is too hot.
    fn is_hot(&mut self) -> bool {
        false
    }
}

/// Encoder decoding: every edge of both lines, with pull-ups for open-collector encoders.
pub fn encoder() -> qei::Config {
    qei::Config {
        ch1_pull: Pull::Up,
        ch2_pull: Pull::Up,
        ..Default::default()
    }
}

/// Settings of the link's serial port: see [`BAUD`].
pub fn uart() -> usart::Config {
    let mut config = usart::Config::default();
    config.baudrate = BAUD;
    config
}

/// Opens the bridge when all else has failed. Whatever the program was doing, nothing switches it on again.
pub fn open_bridge() {
    pac::TIM1.bdtr().modify(|w| w.set_moe(false));
}

/// An STM32 and what its pins are connected to.
pub struct Stm32<W: Wiring> {
    bridge: Bridge,
    encoder: Qei<'static, W::EncoderTimer>,
    position: Extended,
    link: Link<BufferedUart<'static>>,
    period: Period,
    entropy: Entropy,
    supervision: Supervision,
    store: Keeps,
    reset: Reset,
    wiring: W,
}

impl<W: Wiring> Stm32<W> {
    /// Puts a board together and lets its control periods begin, with the bridge open.
    pub fn new(
        mut bridge: Bridge,
        encoder: Qei<'static, W::EncoderTimer>,
        uart: BufferedUart<'static>,
        watchdog: Peri<'static, IWDG>,
        store: Keeps,
        mut wiring: W,
    ) -> Self {
        wiring.enable(false);
        let reset = reset::reason();
        let mut entropy = Entropy::default();
        for word in uid::uid().chunks_exact(4) {
            entropy.stir(u32::from_le_bytes([word[0], word[1], word[2], word[3]]));
        }
        for _ in 0..64 {
            entropy.stir(wiring.noise().into());
        }
        let core = cortex_m::Peripherals::take().expect("a board is put together once");
        let cycles = bridge.timer.get_clock_frequency().0 / 1_000_000 * PERIOD_US;
        // The end of a control period, at the reset priority, is above the link: a burst of bytes must not put it off.
        W::LinkInterrupt::set_priority(Priority::P6);
        let period = Period::new(core.SYST, cycles);
        bridge.align();
        Self {
            bridge,
            encoder,
            position: Extended::default(),
            link: Link::new(uart),
            period,
            entropy,
            supervision: Supervision::begin(watchdog),
            store,
            reset,
            wiring,
        }
    }
}

impl<W: Wiring> Board for Stm32<W> {
    const NAME: &'static str = W::NAME;
    const PERIOD_US: u32 = PERIOD_US;
    const SLICE: u32 = W::SLICE;
    const SENSES_CURRENT: bool = W::SENSES_CURRENT;
    const CURRENT_LIMIT_MA: u32 = W::CURRENT_LIMIT_MA;
    const CURRENT_RESOLUTION_MA: u16 = W::CURRENT_RESOLUTION_MA;
    const SAVES: bool = Keeps::KEEPS;

    fn drive(&mut self, duty: i16) {
        self.bridge.drive(duty);
    }

    fn full(&self) -> u16 {
        self.bridge.legs.full_duty()
    }

    fn nearest(&self, duty: i16) -> i16 {
        self.bridge.legs.nearest(duty)
    }

    fn coast(&mut self) {
        self.bridge.coast();
        self.wiring.enable(false);
    }

    fn count(&mut self) -> i32 {
        while !self.bridge.updated() {}
        let count = self.encoder.count();
        if self.bridge.begins {
            self.bridge.begin();
            self.wiring.enable(true);
        }
        self.position.read(count)
    }

    fn carriers(&self) -> u16 {
        CARRIERS as u16
    }

    fn dead_time(&self) -> u16 {
        self.bridge.dead_time()
    }

    fn current_ma(&mut self) -> i32 {
        self.wiring.current_ma(self.bridge.forward)
    }

    fn supply_mv(&mut self) -> Option<u16> {
        self.wiring.supply_mv()
    }

    fn tick(&mut self) -> Result<(), Fault> {
        let ended = self.period.end();
        self.supervision.feed();
        ended?;
        self.bridge.timer.clear_update_interrupt();
        if self.bridge.tripped() || (self.bridge.driven && self.wiring.reports_fault()) {
            return Err(Fault::Bridge);
        }
        if self.bridge.driven && self.wiring.is_hot() {
            return Err(Fault::BridgeHot);
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

    fn load(&mut self, key: u8, into: &mut [u8; LONGEST]) -> Option<usize> {
        self.store.load(key, into)
    }

    fn save(&mut self, key: u8, value: &[u8]) -> bool {
        self.supervision.pause();
        let saved = self.store.save(key, value);
        self.supervision.resume();
        saved
    }

    fn reset(&self) -> Reset {
        self.reset
    }
}
