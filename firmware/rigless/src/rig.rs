//! The board around the microcontroller, as `firmware/src/board/stm32f427.rs` describes it: what each pin means, read and
//! driven through the emulator's models of the peripherals.

use std::num::{NonZeroU32, NonZeroU64};

use rigless::chip::uart::TcpPeer;
use rigless::device::Level;
use rigless::machine::{Board, Crystal, Target, armv7m};
use rigless::mcu::{Mcu, Operate};
use rigless::soc::st::tim::Channel;
use rigless::soc::stm32f427::Stm32f427;
use rigless::soc::stm32f427::generated::tim1;
use rigless::soc::stm32f427::peripherals::adc;
use rigless::soc::stm32f427::peripherals::gpio::{Gpio, Pin};
use rigless::time::VirtualNanos;

/// TIM1 among the advanced timers, TIM3 among the others, USART2, ADC1, port E: their places in the emulator's lists.
const TIM1: usize = 0;
const TIM3: usize = 1;
const USART2: usize = 1;
const ADC1: usize = 0;
const PORT_E: usize = 4;
/// High and low side of both legs, and the alternate function that hands them to TIM1.
const LEG_PINS: [u8; 4] = [8, 9, 10, 11];
const TIM1_FUNCTION: u8 = 1;
const ENABLE_PIN: u8 = 7;
const CRYSTAL_HZ: u64 = 8_000_000;
/// The current sensor is on channel 10: 1650 mV at zero, 100 mV/A.
const CURRENT_CHANNEL: u8 = 10;

/// The board.
#[derive(Debug)]
pub struct Rig {
    mcu: Stm32f427,
}

rigless::snapshot::store!(Rig {
    values: [],
    parts: [mcu],
    built: []
});

impl Rig {
    /// The board, out of reset, its serial port connected to `link`.
    pub fn new(link: TcpPeer) -> Result<Self, rigless::soc::Error> {
        let mut mcu = Stm32f427::new()?;
        mcu.rcc.attach_crystals(CRYSTAL_HZ, Crystal::NONE.0);
        mcu.set_supply(3300);
        mcu.usart[USART2].attach(link);
        Ok(Self { mcu })
    }

    /// The part of the supply that the firmware asks for across the winding, or `None` while the bridge is open: the
    /// timer's outputs off, a pin not in the timer's hands, or the driver not enabled.
    pub fn duty(&mut self) -> Option<f64> {
        let (_, timer) = self.mcu.advanced_timer(TIM1);
        let outputs_on = timer.get(tim1::Register::Bdtr) >> 15 & 1 == 1;
        let channels_on = timer.get(tim1::Register::Ccer) & 0x55 == 0x55;
        let running = timer.get(tim1::Register::Cr1) & 1 == 1;
        if !(outputs_on && channels_on && running) {
            return None;
        }
        let centred = timer.get(tim1::Register::Cr1) >> 5 & 3 != 0;
        let steps = timer.get(tim1::Register::Arr) + u64::from(!centred);
        let high = |register| timer.get(register).min(steps) as f64 / steps as f64;
        let duty = high(tim1::Register::Ccr1) - high(tim1::Register::Ccr2);
        let (port, pins) = self.mcu.port(PORT_E);
        let wired = LEG_PINS
            .iter()
            .all(|&pin| Gpio::function(at(pin), pins) == Some(TIM1_FUNCTION));
        (wired && port.level(at(ENABLE_PIN), pins) == Level::High).then_some(duty)
    }

    /// Puts the encoder's lines A and B to these levels.
    pub fn drive_encoder(&mut self, at: VirtualNanos, lines: [bool; 2]) {
        for (number, level) in [(1, lines[0]), (2, lines[1])] {
            let channel = Channel::new(number).expect("a timer has four channels");
            self.mcu.drive_timer(at, TIM3, |timer, registers, context| {
                timer.drive_input(channel, Level::from(level), registers, context);
            });
        }
    }

    /// The encoder timer's counter.
    pub fn hardware_count(&mut self, at: VirtualNanos) -> u16 {
        let base = rigless::soc::stm32f427::generated::TIM3.base;
        let value = Operate::read(&mut self.mcu, at, base + 0x24, rigless::soc::Width::W32);
        value.map_or(0, |value| value as u16)
    }

    /// Lets the bridge's driver report a fault, or none.
    pub fn drive_fault(&mut self, at: VirtualNanos, fault: bool) {
        self.mcu
            .drive_advanced_timer(at, TIM1, |timer, registers, context| {
                timer.drive_break(Level::from(!fault), registers, context);
            });
    }

    /// Lets the current sensor show `amperes`, or the top of its range.
    pub fn sense(&mut self, amperes: f64) {
        let millivolts = (1650.0 + 100.0 * amperes).clamp(0.0, 3300.0);
        let channel = adc::Channel::new(CURRENT_CHANNEL).expect("an input on a pin");
        self.mcu.adc[ADC1].set_input(channel, millivolts.round() as u32);
    }
}

fn at(pin: u8) -> Pin {
    Pin::new(pin).expect("a port has sixteen pins")
}

impl Board for Rig {
    fn name(&self) -> &'static str {
        "servoid"
    }

    fn target_names(&self) -> Vec<&'static str> {
        vec!["stm32f427"]
    }

    fn mcu(&mut self, target: usize) -> Option<&mut dyn Mcu> {
        (target == 0).then_some(&mut self.mcu)
    }

    fn targets(&mut self) -> Vec<Target<'_>> {
        let lines = u32::from(Operate::cpu(&self.mcu).interrupt_lines);
        let core = armv7m::Core {
            variant: armv7m::Variant::M4,
            clock_hz: NonZeroU64::new(168_000_000).expect("it runs"),
            interrupt_lines: NonZeroU32::new(lines).expect("it has interrupts"),
            priority_bits: 4,
            refclk_divider: NonZeroU32::new(8).expect("not zero"),
            instructions_per_second: INSTRUCTIONS_PER_SECOND,
            boot: "flash",
        }
        .spec_with_parts(
            &rigless::cpu::armv7m::windows(Mcu::bus(&self.mcu)),
            armv7m::Fpu::FpV4Sp,
            armv7m::MpuRegions::Eight,
        );
        vec![Target::new("stm32f427", &mut self.mcu, core)]
    }
}

/// Instructions that the core retires in a second: about two cycles each, which is what an M4 takes of mixed code from
/// flash. The emulator counts no cycles; faster code on the real part only gets more done.
const INSTRUCTIONS_PER_SECOND: NonZeroU64 = NonZeroU64::new(84_000_000).expect("it runs");
