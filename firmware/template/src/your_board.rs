//! A board of your own, out of a HAL's parts: here those of `embassy-rp` on a Pico, wired as in `board/rp2040.rs`. Whoever calls the
//! application keeps the time.

use embassy_rp::bind_interrupts;
use embassy_rp::gpio::{Input, Level, Output, Pull};
use embassy_rp::interrupt::{self, InterruptExt, Priority};
use embassy_rp::peripherals::{PIO0, UART0};
use embassy_rp::pio::{self, Pio};
use embassy_rp::pwm::{self, Pwm, PwmOutput};
use embassy_rp::uart::{self, BufferedUart};
use embassy_time::Delay;
use firmware::board::generic::{AfterDelay, CallersClock, Generic, HBridge, Parts};
use firmware::board::link::{Link, RECEIVE_BUFFER, SEND_BUFFER};
use firmware::board::modulation::HalfBridges;
use firmware::board::pio_encoder::Encoder;
use firmware::board::sensors::NoSensors;
use firmware::board::store::NoStore;
use static_cell::ConstStaticCell;

/// Compare value of an output that is always high: 20 kHz at 125 MHz.
const FULL: u16 = 3125;

bind_interrupts!(struct Interrupts {
    UART0_IRQ => uart::BufferedInterruptHandler<UART0>;
    PIO0_IRQ_0 => pio::InterruptHandler<PIO0>;
});

static SEND: ConstStaticCell<[u8; SEND_BUFFER]> = ConstStaticCell::new([0; _]);
static RECEIVE: ConstStaticCell<[u8; RECEIVE_BUFFER]> = ConstStaticCell::new([0; _]);

/// The types of its parts.
pub struct Yours;

impl Parts for Yours {
    const NAME: &'static str = "your board";
    const PERIOD_US: u32 = 1000;
    const SLICE: u32 = 20;
    type LegA = PwmOutput<'static>;
    type LegB = PwmOutput<'static>;
    type Enable = Output<'static>;
    type Fault = Input<'static>;
    type Modulation = HalfBridges;
    type Port = Link<BufferedUart>;
    type Position = Encoder;
    type Turn = AfterDelay<Delay>;
    type Tick = CallersClock;
    type Sensors = NoSensors;
    type Store = NoStore;
}

/// Puts it together, with the bridge open. Once: a second call finds the chip's parts taken.
pub fn start() -> Generic<Yours> {
    let p = embassy_rp::init(Default::default());
    let mut carrier = pwm::Config::default();
    (carrier.phase_correct, carrier.top) = (true, FULL - 1);
    let pwm = Pwm::new_output_ab(p.PWM_SLICE0, p.PIN_16, p.PIN_17, carrier);
    let (Some(a), Some(b)) = pwm.split() else {
        unreachable!("both outputs were asked for")
    };
    let (enable, fault) = (
        Output::new(p.PIN_18, Level::Low),
        Input::new(p.PIN_19, Pull::Up),
    );
    let mut pio = Pio::new(p.PIO0, Interrupts);
    let lines = [
        pio.common.make_pio_pin(p.PIN_20),
        pio.common.make_pio_pin(p.PIN_21),
    ];
    let position = Encoder::new(&mut pio.common, pio.sm0, lines);
    core::mem::forget((pio.common, pio.sm1, pio.sm2, pio.sm3));
    let mut config = uart::Config::default();
    config.baudrate = firmware::board::BAUD;
    // Below whatever calls the application once a control period.
    interrupt::UART0_IRQ.set_priority(Priority::P3);
    let (send, receive) = (SEND.take(), RECEIVE.take());
    let uart = BufferedUart::new(p.UART0, p.PIN_0, p.PIN_1, Interrupts, send, receive, config);
    Generic {
        bridge: HBridge::new(a, b, enable, fault, FULL),
        link: Link::new(uart),
        position,
        // Two turns of the carrier: the duty has acted.
        turn: AfterDelay {
            delay: Delay,
            ns: 50_000,
        },
        tick: CallersClock::default(),
        sensors: NoSensors,
        store: NoStore,
        entropy: Default::default(),
        reset: Default::default(),
    }
}

/// Yours opens your bridge here, too.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    cortex_m::peripheral::SCB::sys_reset()
}
