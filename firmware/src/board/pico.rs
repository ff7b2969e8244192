//! Raspberry Pi Pico or Pico 2 with a bridge module of two half bridges and an enable input, such as two BTS7960 on one board. Not
//! yet run on hardware.
//!
//! | pin | what |
//! |---|---|
//! | GP16 | half bridge of motor lead + (RPWM) |
//! | GP17 | half bridge of motor lead − (LPWM) |
//! | GP18 | enables both half bridges (R_EN and L_EN), pulled down by 10 kΩ to ground |
//! | GP19 | fault output of the bridge, active low; may stay open |
//! | GP20, GP21 | encoder A and B |
//! | USB | link |
//! | GP0, GP1 | the same, transmit and receive, for an adapter that isolates; whichever spoke last is answered |
//!
//! The two boards have the same pins. The dead time is the module's business: their chips' PWM has none. So all but the encoder is a [`Generic`] board of
//! `embassy-rp`'s parts.

#[cfg_attr(feature = "rp2040", path = "pico/rp2040.rs")]
#[cfg_attr(feature = "rp2350", path = "pico/rp2350.rs")]
mod chip;
mod reset;
mod supervision;
mod usb;

use embassy_rp::bind_interrupts;
use embassy_rp::clocks::RoscRng;
use embassy_rp::flash::{Blocking, ERASE_SIZE, Flash};
use embassy_rp::gpio::{Input, Level, Output, Pull};
use embassy_rp::interrupt::{self, InterruptExt, Priority};
use embassy_rp::pac::{PWM, SIO};
use embassy_rp::peripherals::{FLASH, PIO0, UART0, USB};
use embassy_rp::pio::{self, Pio};
use embassy_rp::pwm::{self, Pwm, PwmOutput};
use embassy_rp::uart::{self, BufferedUart};
use embassy_rp::usb::{self as usb_controller, Driver};
use static_cell::ConstStaticCell;

use self::chip::CORE_HZ;
pub use self::chip::{CAPACITY, Number};
pub use self::reset::restart;
use self::supervision::Supervised;
use self::usb::UsbSerial;
use super::BAUD;
use super::entropy::Entropy;
use super::generic::{Generic, HBridge, Parts, Turn};
use super::link::{self, Link};
use super::modulation::HalfBridges;
use super::period::Period;
use super::pio_encoder::Encoder;
use super::port::EitherPort;
use super::sensors::NoSensors;
use super::store::FlashStore;

/// Compare value of an output that is always high: the carrier counts up to the step before it and down again, at 20 kHz.
const FULL: u16 = (CORE_HZ / (1000 * CARRIERS) / 2) as u16;
/// Its waves in a control period.
const CARRIERS: u32 = 20;
/// Number of the pin that enables the bridge.
const ENABLE: usize = 18;
/// Part of the PWM that has the bridge's pins.
const SLICE: usize = 0;

/// Flash that every board with this chip has, at least.
const FLASH_SIZE: usize = 2 << 20;
/// Its last two pages.
const PAGES: u32 = (FLASH_SIZE - 2 * ERASE_SIZE) as u32;
type OnBoardFlash = Flash<'static, FLASH, Blocking, FLASH_SIZE>;

bind_interrupts!(struct Interrupts {
    UART0_IRQ => uart::BufferedInterruptHandler<UART0>;
    PIO0_IRQ_0 => pio::InterruptHandler<PIO0>;
    USBCTRL_IRQ => usb_controller::InterruptHandler<USB>;
});

static SEND: ConstStaticCell<[u8; link::SEND_BUFFER]> = ConstStaticCell::new([0; _]);
static RECEIVE: ConstStaticCell<[u8; link::RECEIVE_BUFFER]> = ConstStaticCell::new([0; _]);

/// Raspberry Pi Pico or Pico 2 and its bridge.
pub type PicoBoard = Generic<Pico>;

/// The types of its parts.
pub struct Pico;

impl Parts for Pico {
    const NAME: &'static str = chip::NAME;
    const PERIOD_US: u32 = 1000;
    const SLICE: u32 = chip::SAMPLES;
    const CARRIERS: u16 = CARRIERS as u16;
    type LegA = PwmOutput<'static>;
    type LegB = PwmOutput<'static>;
    type Enable = Output<'static>;
    type Fault = Input<'static>;
    type Modulation = HalfBridges;
    type Port = EitherPort<UsbSerial, Link<BufferedUart>>;
    type Position = Encoder;
    type Turn = Carrier;
    type Tick = Supervised;
    type Sensors = NoSensors;
    type Store = FlashStore<OnBoardFlash>;
}

impl PicoBoard {
    /// Takes the microcontroller over. Once: a second call would find its peripherals taken, and panics.
    pub fn start() -> Self {
        // Before anything else.
        open_bridge();
        let reset = reset::reason();
        let p = embassy_rp::init(Default::default());
        let enable = Output::new(p.PIN_18, Level::Low);
        let mut carrier = pwm::Config::default();
        carrier.enable = false;
        carrier.phase_correct = true;
        carrier.top = FULL - 1;
        let pwm = Pwm::new_output_ab(p.PWM_SLICE0, p.PIN_16, p.PIN_17, carrier);
        let (Some(a), Some(b)) = pwm.split() else {
            unreachable!("both outputs were asked for")
        };
        let fault = Input::new(p.PIN_19, Pull::Up);
        let mut pio = Pio::new(p.PIO0, Interrupts);
        let lines = [
            pio.common.make_pio_pin(p.PIN_20),
            pio.common.make_pio_pin(p.PIN_21),
        ];
        let encoder = Encoder::new(&mut pio.common, pio.sm0, lines);
        // They stay for good: without this, the image would hold what frees them.
        core::mem::forget((pio.common, pio.sm1, pio.sm2, pio.sm3));
        let mut config = uart::Config::default();
        config.baudrate = BAUD;
        let uart = BufferedUart::new(
            p.UART0,
            p.PIN_0,
            p.PIN_1,
            Interrupts,
            SEND.take(),
            RECEIVE.take(),
            config,
        );
        let mut entropy = Entropy::default();
        for _ in 0..4 {
            entropy.stir(RoscRng.next_u32());
        }
        let core = cortex_m::Peripherals::take().expect("a board is put together once");
        let bridge = HBridge::new(a, b, enable, fault, FULL);
        let usb = UsbSerial::new(Driver::new(p.USB, Interrupts), chip::NAME);
        let link = EitherPort::new(usb, Link::new(uart));
        // The end of a control period, at the reset priority, is above the link: a burst of bytes must not put it off.
        interrupt::UART0_IRQ.set_priority(Priority::P2);
        interrupt::USBCTRL_IRQ.set_priority(Priority::P2);
        // At once one after the other: the carrier's phase in the control period is what passes in between.
        let period = Period::new(core.SYST, CORE_HZ / 1_000_000 * Pico::PERIOD_US);
        let turn = Carrier::start();
        Generic {
            bridge,
            link,
            position: encoder,
            turn,
            tick: Supervised::begin(period, p.WATCHDOG),
            sensors: NoSensors,
            store: FlashStore::new(Flash::new_blocking(p.FLASH), PAGES),
            entropy,
            reset,
        }
    }
}

/// The carrier. `embassy-rp` gives its counter and its mark to whoever holds both legs, so they are asked for by register.
pub struct Carrier;

/// Mark of the PWM that its counter has come to zero again, where it takes new compare values over (RP2040 data sheet, 4.5.2.3
/// and 4.5.2.7; RP2350 data sheet, 12.5.2).
const TAKEN_OVER: u32 = 1 << SLICE;

impl Carrier {
    /// The carrier begins at its peak, with the control period. A new duty, of both legs at once, takes effect when it has
    /// come down, 25 µs and the little that passes here after the period's end, every time: so the program has time to give it.
    fn start() -> Self {
        let carrier = PWM.ch(SLICE);
        carrier.ctr().write(|w| w.set_ctr(FULL - 1));
        carrier.csr().modify(|w| w.set_en(true));
        Carrier
    }
}

impl Turn for Carrier {
    fn begin(&mut self) {
        PWM.intr().write(|w| w.0 = TAKEN_OVER);
    }

    fn wait(&mut self) {
        // It always runs, whether the bridge is open or not.
        while PWM.intr().read().0 & TAKEN_OVER == 0 {}
    }
}

/// True while the module follows the PWM.
fn bridge_is_closed() -> bool {
    SIO.gpio_out(0).value().read() & 1 << ENABLE != 0
}

/// Opens the bridge when all else has failed: whatever the PWM does, the module does not follow it any more.
pub fn open_bridge() {
    SIO.gpio_out(0).value_clr().write_value(1 << ENABLE);
}
