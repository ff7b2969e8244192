//! Two half bridges on the advanced timer TIM1, with a transistor a pin.

#[cfg(feature = "stm32f103")]
use embassy_stm32::gpio::AfioRemap;
use embassy_stm32::gpio::{AfType, Flex, OutputType, Pull, Speed};
use embassy_stm32::pac::timer::vals::{Bkp, Ckd, FilterValue, Ossi, Ossr};
use embassy_stm32::peripherals::TIM1;
use embassy_stm32::timer::low_level::{CountingMode, OutputCompareMode, Timer};
use embassy_stm32::timer::{
    BkIn1, BreakInputPin, Ch1, Ch2, Channel, TimerComplementaryPin, TimerPin,
};
use embassy_stm32::{Peri, pac};

use super::{CARRIERS, PERIOD_US};
use crate::board::half_bridges::HalfBridges;

/// The pins of the two half bridges: an input for the high side and one for the low side of each.
pub struct BridgePins {
    pins: [Flex<'static>; 4],
    #[cfg(not(feature = "stm32f103"))]
    functions: [u8; 4],
}

#[cfg(not(feature = "stm32f103"))]
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

    /// Lets the timer have them.
    fn connect(&mut self) {
        for (pin, function) in self.pins.iter_mut().zip(self.functions) {
            pin.set_as_af_unchecked(function, LEG);
        }
    }
}

/// The F1 has all pins of a timer at one place, and none of the others' numbers.
#[cfg(feature = "stm32f103")]
impl BridgePins {
    /// Leg A is high while TIM1's first output is, leg B while its second is.
    pub fn new(
        a_high: Peri<'static, impl TimerPin<TIM1, Ch1, AfioRemap<0>>>,
        a_low: Peri<'static, impl TimerComplementaryPin<TIM1, Ch1, AfioRemap<0>>>,
        b_high: Peri<'static, impl TimerPin<TIM1, Ch2, AfioRemap<0>>>,
        b_low: Peri<'static, impl TimerComplementaryPin<TIM1, Ch2, AfioRemap<0>>>,
    ) -> Self {
        a_high.afio_remap();
        Self {
            pins: [
                Flex::new(a_high),
                Flex::new(a_low),
                Flex::new(b_high),
                Flex::new(b_low),
            ],
        }
    }

    /// Lets the timer have them.
    fn connect(&mut self) {
        for pin in &mut self.pins {
            pin.set_as_af_unchecked(LEG);
        }
    }
}

/// How the timer drives a pin of the bridge: edges of some tens of nanoseconds.
#[cfg(not(feature = "stm32f103"))]
const LEG: AfType = AfType::output(OutputType::PushPull, Speed::High);
#[cfg(feature = "stm32f103")]
const LEG: AfType = AfType::output(OutputType::PushPull, Speed::Medium);

/// Two half bridges on TIM1. All four outputs are low, and so all four transistors off, unless it drives.
pub struct Bridge {
    pub(super) timer: Timer<'static, TIM1>,
    pub(super) legs: HalfBridges,
    pub(super) driven: bool,
    /// Leg A is high for longer.
    pub(super) forward: bool,
    /// It is to drive from the carrier's next turn on.
    pub(super) begins: bool,
    /// Clocks of the dead time in a period.
    dead_clocks: u32,
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
        let steps = dead_time_steps(dead_time_ns, clock_mhz);
        timer.set_dead_time_value(steps);
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
        pins.connect();
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
            dead_clocks: u32::from(steps) * DEAD_STEP,
            _pins: pins,
            _break_pin: None,
        };
        bridge.coast();
        bridge
    }

    /// Lets a low level on `pin` switch the outputs off, in hardware, without the program and even without its clock.
    #[cfg(not(feature = "stm32f103"))]
    pub fn with_break_input(self, pin: Peri<'static, impl BreakInputPin<TIM1, BkIn1>>) -> Self {
        let function = pin.af_num();
        let mut pin = Flex::new(pin);
        pin.set_as_af_unchecked(function, AfType::input(Pull::Up));
        self.broken_by(pin)
    }

    /// Lets a low level on `pin` switch the outputs off, in hardware, without the program and even without its clock.
    #[cfg(feature = "stm32f103")]
    pub fn with_break_input(
        self,
        pin: Peri<'static, impl BreakInputPin<TIM1, BkIn1, AfioRemap<0>>>,
    ) -> Self {
        let mut pin = Flex::new(pin);
        pin.set_as_af_unchecked(AfType::input(Pull::Up));
        self.broken_by(pin)
    }

    fn broken_by(mut self, pin: Flex<'static>) -> Self {
        self._break_pin = Some(pin);
        self.timer.set_break_polarity(Bkp::ACTIVE_LOW);
        // Eight samples in a row, about 50 ns each: shorter than any short circuit that a transistor survives.
        self.timer.set_break_filter(FilterValue::FDTS_DIV2_N8);
        self
    }

    pub(super) fn drive(&mut self, duty: i16) {
        self.set(duty);
        self.begins = !self.driven;
    }

    /// Closes an open bridge that is to drive. After the carrier's turn: before, it would brake until then.
    pub(super) fn begin(&mut self) {
        self.timer.set_moe(true);
        (self.driven, self.begins) = (true, false);
    }

    pub(super) fn coast(&mut self) {
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
    pub(super) fn align(&mut self) {
        self.timer.generate_update_event();
        pac::TIM1.cnt().write(|w| w.set_cnt(self.legs.full / 5));
    }

    /// True once the carrier has passed a peak or a valley, where it takes a new duty over, in this control period. It always
    /// runs, whether the bridge is open or not.
    pub(super) fn updated(&self) -> bool {
        pac::TIM1.sr().read().uif()
    }

    /// What two dead times take of a wave of the carrier, as a duty.
    pub(super) fn dead_time(&self) -> u16 {
        let wave = 2 * u32::from(self.legs.full);
        (2 * self.dead_clocks * u32::from(self.legs.full_duty()) / wave.max(1)) as u16
    }

    /// True while driving if the break input has switched the outputs off.
    pub(super) fn tripped(&self) -> bool {
        self.driven && !self.timer.get_moe()
    }
}

/// Clocks in a step of the dead time.
const DEAD_STEP: u32 = 4;

/// The timer's code for a dead time, rounded up: steps of four clocks, of which it can count 127 one by one.
fn dead_time_steps(ns: u32, clock_mhz: u32) -> u8 {
    let steps = (ns * clock_mhz).div_ceil(DEAD_STEP * 1000);
    assert!(steps < 128, "a dead time too long for this timer");
    steps as u8
}
