//! ESP32-C6 (DevKitC-1) with a bridge module of two half bridges and an enable input, such as two BTS7960 on one board. Not yet run
//! on hardware, and in no emulator: of all the boards this one is the least tried.
//!
//! | pin | what |
//! |---|---|
//! | GPIO18 | half bridge of motor lead + (RPWM) |
//! | GPIO19 | half bridge of motor lead − (LPWM) |
//! | GPIO20 | enables both half bridges (R_EN and L_EN), pulled down by 10 kΩ to ground |
//! | GPIO21 | fault output of the bridge, active low; may stay open |
//! | GPIO22, GPIO23 | encoder A and B |
//! | USB (the chip's own) | link |
//! | GPIO16, GPIO17 | the same, transmit and receive: the other USB socket; whichever spoke last is answered |
//!
//! A [`Generic`] board of `esp-hal`'s parts. The dead time is the module's business.

mod clock;
mod encoder;
mod ports;
mod reset;

use esp_hal::gpio::{Input, InputConfig, Level, Output, OutputConfig, Pull};
use esp_hal::mcpwm::operator::{PwmPin, PwmPinConfig};
use esp_hal::mcpwm::timer::PwmWorkingMode;
use esp_hal::mcpwm::{McPwm, PeripheralClockConfig};
use esp_hal::peripherals::{GPIO, MCPWM0};
use esp_hal::rng::Rng;
use esp_hal::timer::timg::TimerGroup;
use esp_hal::uart::{self, Uart};
use esp_hal::usb::usb_serial_jtag::UsbSerialJtag;

use self::clock::Clock;
use self::encoder::Encoder;
use self::ports::{Serial, Usb};
pub use self::reset::restart;
use super::BAUD;
use super::entropy::Entropy;
use super::generic::{Generic, HBridge, Parts, Turn};
use super::modulation::HalfBridges;
use super::port::EitherPort;
use super::sensors::NoSensors;
use super::store::NoStore;

/// Fixed point: the core has no floating-point unit.
pub type Number = shared::scalar::Fixed;
/// Periods that it can fit.
pub const CAPACITY: usize = 1000;

/// Compare value of an output that is always high: the carrier counts 160 MHz up to it and down again, at 20 kHz.
const FULL: u16 = 4000;
/// Number of the pin that enables the bridge.
const ENABLE: u32 = 20;

// What the second stage of the boot loader asks of an image.
esp_bootloader_esp_idf::esp_app_desc!();

/// ESP32-C6 and its bridge.
pub type Esp32c6 = Generic<DevKit>;

/// The types of its parts.
pub struct DevKit;

impl Parts for DevKit {
    const NAME: &'static str = "ESP32-C6";
    const PERIOD_US: u32 = 1000;
    const CARRIERS: u16 = 20;
    // As the F103, whose multiplier is as good, at twice its clock.
    const SLICE: u32 = 120;
    type LegA = PwmPin<'static, MCPWM0<'static>, 0, true>;
    type LegB = PwmPin<'static, MCPWM0<'static>, 0, false>;
    type Enable = Output<'static>;
    type Fault = Input<'static>;
    type Modulation = HalfBridges;
    type Port = EitherPort<Usb, Serial>;
    type Position = Encoder;
    type Turn = Carrier;
    type Tick = Clock;
    type Sensors = NoSensors;
    type Store = NoStore;
}

impl Esp32c6 {
    /// Takes the microcontroller over. Once: a second call would find its peripherals taken, and panics.
    pub fn start() -> Self {
        // Before anything else.
        open_bridge();
        let reset = reset::reason();
        let p = esp_hal::init(esp_hal::Config::default());
        let enable = Output::new(p.GPIO20, Level::Low, OutputConfig::default());
        let clock = PeripheralClockConfig::with_prescaler(0);
        let mut pwm = McPwm::new(p.MCPWM0, clock);
        pwm.operator0.set_timer(&pwm.timer0);
        let (a, b) = pwm.operator0.with_pins(
            p.GPIO18,
            PwmPinConfig::UP_DOWN_ACTIVE_HIGH,
            p.GPIO19,
            PwmPinConfig::UP_DOWN_ACTIVE_HIGH,
        );
        // Its period first: a leg's longest duty is read from there.
        pwm.timer0
            .start(clock.timer_clock_with_prescaler(FULL, PwmWorkingMode::UpDown, 0));
        let pulled_up = InputConfig::default().with_pull(Pull::Up);
        let fault = Input::new(p.GPIO21, pulled_up);
        let lines = [
            Input::new(p.GPIO22, pulled_up),
            Input::new(p.GPIO23, pulled_up),
        ];
        let uart = Uart::new(p.UART0, uart::Config::default().with_baudrate(BAUD))
            .expect("the clock suits the link's speed")
            .with_tx(p.GPIO16)
            .with_rx(p.GPIO17);
        let mut entropy = Entropy::default();
        for _ in 0..4 {
            entropy.stir(Rng::new().random());
        }
        Generic {
            bridge: HBridge::new(a, b, enable, fault, FULL),
            link: EitherPort::new(Usb(UsbSerialJtag::new(p.USB_DEVICE)), Serial(uart)),
            position: Encoder::new(p.PCNT, &lines),
            turn: Carrier,
            tick: Clock::begin(TimerGroup::new(p.TIMG0).wdt, &mut Carrier),
            sensors: NoSensors,
            store: NoStore,
            entropy,
            reset,
        }
    }
}

/// The carrier, whose counter at zero takes new compare values over. `esp-hal` has no mark of that, so it is asked for by register.
pub struct Carrier;

impl Turn for Carrier {
    fn begin(&mut self) {
        MCPWM0::regs()
            .int_clr()
            .write(|w| w.timer0_tez().clear_bit_by_one());
    }

    fn wait(&mut self) {
        // It always runs, whether the bridge is open or not.
        while MCPWM0::regs().int_raw().read().timer0_tez().bit_is_clear() {}
    }
}

/// Opens the bridge when all else has failed: whatever the PWM does, the module does not follow it any more.
pub fn open_bridge() {
    // Safety: a register of which each bit that is set lets one pin go low, and no other bit does anything.
    GPIO::regs()
        .out_w1tc()
        .write(|w| unsafe { w.bits(1 << ENABLE) });
}
