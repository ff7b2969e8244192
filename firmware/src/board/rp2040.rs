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

use embassy_rp::clocks::RoscRng;
use embassy_rp::gpio::{Input, Level, Output, Pull};
use embassy_rp::peripherals::{PIO0, UART0};
use embassy_rp::pio::{self, Direction, FifoJoin, Pio, ShiftDirection, StateMachine};
use embassy_rp::pwm::{self, Pwm};
use embassy_rp::uart::{self, BufferedUart};
use embassy_rp::{bind_interrupts, pac};
use static_cell::ConstStaticCell;

use super::Board;
use super::entropy::Entropy;
use super::half_bridges::HalfBridges;
use super::link::{self, Link};
use super::period::Period;
use crate::phase::Fault;

const CORE_HZ: u32 = 125_000_000;
const PERIOD_US: u32 = 1000;
/// Compare value of an output that is always high: the carrier counts up to the step before it and down again, at 20 kHz.
const FULL: u16 = 3125;
/// Number of the pin that enables the bridge.
const ENABLE: usize = 18;

/// The chip's microseconds, for the pause that the serial port's driver makes while it is set up. The time driver of
/// `embassy-rp` can wake tasks as well, of which there are none here, and takes a kilobyte.
struct Microseconds;

impl embassy_time_driver::Driver for Microseconds {
    fn now(&self) -> u64 {
        loop {
            let high = pac::TIMER.timerawh().read();
            let low = pac::TIMER.timerawl().read();
            if high == pac::TIMER.timerawh().read() {
                return (u64::from(high) << 32) | u64::from(low);
            }
        }
    }

    fn schedule_wake(&self, _: u64, _: &core::task::Waker) {}
}

embassy_time_driver::time_driver_impl!(static CLOCK: Microseconds = Microseconds);

bind_interrupts!(struct Interrupts {
    UART0_IRQ => uart::BufferedInterruptHandler<UART0>;
    PIO0_IRQ_0 => pio::InterruptHandler<PIO0>;
});

static SEND: ConstStaticCell<[u8; link::SEND_BUFFER]> = ConstStaticCell::new([0; _]);
static RECEIVE: ConstStaticCell<[u8; link::RECEIVE_BUFFER]> = ConstStaticCell::new([0; _]);

/// Raspberry Pi Pico and its bridge.
pub struct Rp2040 {
    pwm: Pwm<'static>,
    carrier: pwm::Config,
    enable: Output<'static>,
    fault: Input<'static>,
    encoder: Encoder,
    link: Link<BufferedUart>,
    period: Period,
    entropy: Entropy,
}

impl Rp2040 {
    /// Takes the microcontroller over. Once: a second call would find its peripherals taken, and panics.
    pub fn start() -> Self {
        let p = embassy_rp::init(Default::default());
        let enable = Output::new(p.PIN_18, Level::Low);
        let mut carrier = pwm::Config::default();
        carrier.enable = false;
        carrier.phase_correct = true;
        carrier.top = FULL - 1;
        let pwm = Pwm::new_output_ab(p.PWM_SLICE0, p.PIN_16, p.PIN_17, carrier.clone());
        let mut pio = Pio::new(p.PIO0, Interrupts);
        let lines = [
            pio.common.make_pio_pin(p.PIN_20),
            pio.common.make_pio_pin(p.PIN_21),
        ];
        let encoder = Encoder::new(&mut pio.common, pio.sm0, lines);
        // They stay for good: without this, the image would hold what frees them.
        core::mem::forget((pio.common, pio.sm1, pio.sm2, pio.sm3));
        let mut config = uart::Config::default();
        config.baudrate = link::BAUD;
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
        let mut board = Self {
            pwm,
            carrier,
            enable,
            fault: Input::new(p.PIN_19, Pull::Up),
            encoder,
            link: Link::new(uart),
            period: Period::new(core.SYST, CORE_HZ / 1_000_000 * PERIOD_US),
            entropy,
        };
        // The carrier begins with the control period: a new duty, of both legs at once, takes effect when it has come down
        // again, 50 µs after the period's start, every time.
        board.carrier.enable = true;
        board.coast();
        board
    }

    fn set(&mut self, duty: i16) {
        let (a, b) = LEGS.compares(duty);
        (self.carrier.compare_a, self.carrier.compare_b) = (a, b);
        self.pwm.set_config(&self.carrier);
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
        self.set(duty);
        self.enable.set_high();
    }

    fn full(&self) -> u16 {
        LEGS.full_duty()
    }

    fn nearest(&self, duty: i16) -> i16 {
        LEGS.nearest(duty)
    }

    fn coast(&mut self) {
        self.enable.set_low();
        self.set(0);
    }

    fn count(&mut self) -> i32 {
        self.encoder.count()
    }

    fn tick(&mut self) -> Result<(), Fault> {
        self.period.end()?;
        if self.enable.is_set_high() && self.fault.is_low() {
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
    pac::SIO.gpio_out(0).value_clr().write_value(1 << ENABLE);
}

/// Counts every edge of both lines, in a state machine of the chip's PIO that does nothing else.
struct Encoder {
    machine: StateMachine<'static, PIO0, 0>,
    last: i32,
}

impl Encoder {
    /// The state machine keeps the count in Y and pushes it again and again, ten million times a second; what finds no
    /// room is lost. The lines before and after an edge, two bits each, are the address of what to do about it.
    fn new(
        common: &mut pio::Common<'static, PIO0>,
        mut machine: StateMachine<'static, PIO0, 0>,
        mut lines: [pio::Pin<'static, PIO0>; 2],
    ) -> Self {
        let program = embassy_rp::pio::program::pio_asm!(
            ".origin 0",
            "jmp tell", // 00 stays
            "jmp up",   // 00 to 01: A rises while B is low
            "jmp down", // 00 to 10
            "jmp tell", // 00 to 11: two edges at once, which way is unknown
            "jmp down", // 01 to 00
            "jmp tell", // 01 stays
            "jmp tell", // 01 to 10
            "jmp up",   // 01 to 11
            "jmp up",   // 10 to 00
            "jmp tell", // 10 to 01
            "jmp tell", // 10 stays
            "jmp down", // 10 to 11
            "jmp tell", // 11 to 00
            "jmp down", // 11 to 01
            "jmp up",   // 11 to 10
            "jmp tell", // 11 stays
            "down:",
            "jmp y-- tell",
            ".wrap_target",
            "tell:",
            "mov isr, y",
            "push noblock",
            "out isr, 2", // the lines as they were
            "in pins, 2", // and as they are
            "mov osr, isr",
            "mov pc, isr",
            "up:", // y + 1 is not(not(y) - 1)
            "mov y, ~y",
            "jmp y-- turn",
            "turn:",
            "mov y, ~y",
            ".wrap",
        );
        for line in &mut lines {
            line.set_pull(Pull::Up);
        }
        let [a, b] = &lines;
        machine.set_pin_dirs(Direction::In, &[a, b]);
        let mut config = pio::Config::default();
        config.set_in_pins(&[a, b]);
        config.fifo_join = FifoJoin::RxOnly;
        config.shift_in.direction = ShiftDirection::Left;
        config.shift_out.direction = ShiftDirection::Right;
        config.use_program(&common.load_program(&program.program), &[]);
        machine.set_config(&config);
        machine.set_enable(true);
        Self { machine, last: 0 }
    }

    /// The count as it is now: what waits in the queue is older, so that is thrown away first.
    fn count(&mut self) -> i32 {
        let queue = self.machine.rx();
        for _ in 0..queue.level() {
            queue.try_pull();
        }
        // The next one comes within a tenth of a microsecond.
        for _ in 0..100 {
            if let Some(count) = queue.try_pull() {
                self.last = count as i32;
                break;
            }
        }
        self.last
    }
}
