//! Common code of the STM32 boards: the advanced timer TIM1 drives two half bridges, another timer decodes the
//! encoder, a serial port is the link. A board is then a [`Wiring`].

mod reset;
mod supervision;

use embassy_stm32::gpio::{AfType, Flex, OutputType, Pull, Speed};
use embassy_stm32::pac::timer::vals::{Bkp, Ckd, FilterValue, Ossi, Ossr};
use embassy_stm32::peripherals::{IWDG, TIM1};
use embassy_stm32::timer::low_level::{CountingMode, OutputCompareMode, Timer};
use embassy_stm32::timer::qei::{self, Qei};
use embassy_stm32::timer::{
    BkIn1, BreakInputPin, Ch1, Ch2, Channel, GeneralInstance4Channel, TimerComplementaryPin,
    TimerPin,
};
use embassy_stm32::usart::{self, BufferedUart};
use embassy_stm32::{Peri, pac, uid};
use shared::encoder::Extended;
use shared::wire::Reset;

pub use self::reset::restart;
use self::supervision::Supervision;

use super::BAUD;
use super::Board;
use super::entropy::Entropy;
use super::generic::Tick;
use super::half_bridges::HalfBridges;
use super::link::Link;
use super::period::Period;
use crate::phase::Fault;

/// The cores have a floating-point unit.
pub type Number = f32;
/// Periods that they can fit.
pub const CAPACITY: usize = 2000;

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

/// The pins of the two half bridges: an input for the high side and one for the low side of each.
pub struct BridgePins {
    pins: [Flex<'static>; 4],
    functions: [u8; 4],
}

impl BridgePins {
    /// Leg A is high while TIM1's first output is, leg B while its second is.
    pub fn new(
        a_high: Peri<'static, impl TimerPin<TIM1, Ch1>>,
        a_low: Peri<'static, impl TimerComplementaryPin<TIM1, Ch1>>,
        b_high: Peri<'static, impl TimerPin<TIM1, Ch2>>,
        b_low: Peri<'static, impl TimerComplementaryPin<TIM1, Ch2>>,
    ) -> Self {
        Self {
            functions: [
                a_high.af_num(),
                a_low.af_num(),
                b_high.af_num(),
                b_low.af_num(),
            ],
            pins: [
                Flex::new(a_high),
                Flex::new(a_low),
                Flex::new(b_high),
                Flex::new(b_low),
            ],
        }
    }
}

/// Two half bridges on TIM1. All four outputs are low, and so all four transistors off, unless it drives.
pub struct Bridge {
    timer: Timer<'static, TIM1>,
    legs: HalfBridges,
    driven: bool,
    /// Leg A is high for longer.
    forward: bool,
    /// It is to drive from the carrier's next turn on.
    begins: bool,
    _pins: BridgePins,
    _break_pin: Option<Flex<'static>>,
}

impl Bridge {
    /// Takes the timer and its pins over. They float from reset until here, and in a microcontroller without power: the
    /// board's resistors must hold the bridge off.
    ///
    /// `dead_time_ns` passes between the end of one transistor of a leg and the start of the other; in every carrier
    /// period `refresh_ns` belongs to the low side (see [`HalfBridges::refresh`]).
    pub fn new(
        timer: Peri<'static, TIM1>,
        mut pins: BridgePins,
        dead_time_ns: u32,
        refresh_ns: u32,
    ) -> Self {
        let timer = Timer::new(timer);
        let clock_mhz = timer.get_clock_frequency().0 / 1_000_000;
        // The carrier counts up to this and down again.
        let full = clock_mhz * PERIOD_US / CARRIERS / 2;
        timer.set_counting_mode(CountingMode::CenterAlignedBothInterrupts);
        timer.set_max_compare_value(full as u16);
        timer.set_autoreload_preload(true);
        timer.set_dead_time_clock_division(Ckd::DIV4);
        timer.set_dead_time_value(dead_time(dead_time_ns, clock_mhz));
        // Off means low, not floating. The idle levels are low after reset and nobody changes them.
        timer.set_ossi(Ossi::IDLE_LEVEL);
        timer.set_ossr(Ossr::IDLE_LEVEL);
        // The clock security system acts through the break, pin or no pin. Without one the break's input is low; were it not,
        // the bridge would never close.
        timer.set_break_polarity(Bkp::ACTIVE_HIGH);
        timer.set_break_enable(true);
        for channel in [Channel::Ch1, Channel::Ch2] {
            timer.set_output_compare_mode(channel, OutputCompareMode::PwmMode1);
            timer.set_output_compare_preload(channel, true);
            timer.enable_channel(channel, true);
            timer.enable_complementary_channel(channel, true);
        }
        timer.generate_update_event();
        timer.start();
        // Only now, when the timer holds all four low.
        for (pin, function) in pins.pins.iter_mut().zip(pins.functions) {
            pin.set_as_af_unchecked(function, AfType::output(OutputType::PushPull, Speed::High));
        }
        let mut bridge = Self {
            timer,
            legs: HalfBridges {
                full: full as u16,
                // Half of it before the peak of the carrier, half after.
                refresh: (refresh_ns * clock_mhz).div_ceil(2000) as u16,
            },
            driven: false,
            forward: true,
            begins: false,
            _pins: pins,
            _break_pin: None,
        };
        bridge.coast();
        bridge
    }

    /// Lets a low level on `pin` switch the outputs off, in hardware, without the program and even without its clock.
    pub fn with_break_input(mut self, pin: Peri<'static, impl BreakInputPin<TIM1, BkIn1>>) -> Self {
        let function = pin.af_num();
        let mut pin = Flex::new(pin);
        pin.set_as_af_unchecked(function, AfType::input(Pull::Up));
        self._break_pin = Some(pin);
        self.timer.set_break_polarity(Bkp::ACTIVE_LOW);
        // Eight samples in a row, about 50 ns each: shorter than any short circuit that a transistor survives.
        self.timer.set_break_filter(FilterValue::FDTS_DIV2_N8);
        self
    }

    fn drive(&mut self, duty: i16) {
        self.set(duty);
        self.begins = !self.driven;
    }

    /// Closes an open bridge that is to drive. After the carrier's turn: before, it would brake until then.
    fn begin(&mut self) {
        self.timer.set_moe(true);
        (self.driven, self.begins) = (true, false);
    }

    fn coast(&mut self) {
        self.timer.set_moe(false);
        (self.driven, self.begins) = (false, false);
        self.set(0);
    }

    fn set(&mut self, duty: i16) {
        self.forward = duty >= 0;
        let (a, b) = self.legs.compares(duty);
        self.timer.set_compare_value(Channel::Ch1, a);
        self.timer.set_compare_value(Channel::Ch2, b);
    }

    /// Shifts the carrier so that its next peak is 4/5 of the way from valley to peak away. At the start of a control
    /// period this leaves the program time to set the duty of both legs in the same half of the carrier, every time.
    fn align(&mut self) {
        self.timer.generate_update_event();
        pac::TIM1.cnt().write(|w| w.set_cnt(self.legs.full / 5));
    }

    /// True once the carrier has passed a peak or a valley, where it takes a new duty over, in this control period. It always
    /// runs, whether the bridge is open or not.
    fn updated(&self) -> bool {
        pac::TIM1.sr().read().uif()
    }

    /// True while driving if the break input has switched the outputs off.
    fn tripped(&self) -> bool {
        self.driven && !self.timer.get_moe()
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

/// The timer's code for a dead time, rounded up: steps of four clocks, of which it can count 127 one by one.
fn dead_time(ns: u32, clock_mhz: u32) -> u8 {
    let steps = (ns * clock_mhz).div_ceil(4 * 1000);
    assert!(steps < 128, "a dead time too long for this timer");
    steps as u8
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

    fn reset(&self) -> Reset {
        self.reset
    }
}
