//! A motor controller of the VESC 4 kind: STM32F405, the gate driver DRV8302 and three half bridges, of which the
//! motor uses the first two. Not yet run on hardware.
//!
//! | pin | what |
//! |---|---|
//! | PA8, PB13 | high side and low side of phase 1 (motor lead +) |
//! | PA9, PB14 | high side and low side of phase 2 (motor lead −) |
//! | PA10, PB15 | high side and low side of phase 3, held off |
//! | PC10 | wakes the gate driver |
//! | PC12 | the gate driver's fault output, active low |
//! | PB12 | calibrates the gate driver's amplifiers, held off |
//! | PB6, PB7 | encoder A and B, on the hall connector |
//! | PC6, PC7 | link, transmit and receive |
//! | PA6, PA5 | amplifiers of the shunts below phases 1 and 2: 1 mΩ, ten times |
//! | PC2 | supply, by 39 kΩ and 2.2 kΩ |
//! | PA3 | thermistor of the transistors, 10 kΩ at 25 °C, to 3.3 V; 10 kΩ to ground |
//! | PH0, PH1 | crystal, 8 MHz |
//!
//! Shunts, dividers and signs are those that the VESC project's own firmware has for hardware 4.10 (`hw_410.h`).

use embassy_stm32::Peri;
use embassy_stm32::adc::{Adc, SampleTime};
use embassy_stm32::gpio::{Input, Level, Output, Pull, Speed};
use embassy_stm32::peripherals::{ADC1, PA3, PA5, PA6, PC2, TIM4, USART6};
use embassy_stm32::rcc::HseMode;
use embassy_stm32::timer::qei::Qei;
use embassy_stm32::usart::{self, BufferedUart};
use embassy_stm32::{bind_interrupts, interrupt};
use static_cell::ConstStaticCell;

use super::link;
use super::shunts::Shunts;
use super::stm32::{self, Bridge, BridgePins, Stm32, Wiring};
use super::stm32f4;

/// STM32F405 and its bridge.
pub type Stm32f405 = Stm32<Connections>;

bind_interrupts!(struct Interrupts {
    USART6 => usart::BufferedInterruptHandler<USART6>;
});

static SEND: ConstStaticCell<[u8; link::SEND_BUFFER]> = ConstStaticCell::new([0; _]);
static RECEIVE: ConstStaticCell<[u8; link::RECEIVE_BUFFER]> = ConstStaticCell::new([0; _]);

/// The pins that are not one timer's or the link's.
pub struct Connections {
    fault: Input<'static>,
    adc: Adc<'static, ADC1>,
    amplifiers: (Peri<'static, PA6>, Peri<'static, PA5>),
    supply: Peri<'static, PC2>,
    thermistor: Peri<'static, PA3>,
    shunts: Shunts,
    _held: [Output<'static>; 4],
}

impl Stm32f405 {
    /// Takes the microcontroller over. Once: a second call would find its peripherals taken, and panics.
    pub fn start() -> Self {
        let p = embassy_stm32::init(stm32f4::clocks(HseMode::Oscillator));
        let held = [
            Output::new(p.PA10, Level::Low, Speed::Low),
            Output::new(p.PB15, Level::Low, Speed::Low),
            Output::new(p.PB12, Level::Low, Speed::Low),
            // It takes the driver milliseconds to wake, so it stays awake; the timer's outputs open the bridge.
            Output::new(p.PC10, Level::High, Speed::Low),
        ];
        let legs = BridgePins::new(p.PA8, p.PB13, p.PA9, p.PB14);
        let bridge = Bridge::new(p.TIM1, legs, 400, 0);
        let encoder = Qei::new(p.TIM4, p.PB6, p.PB7, stm32::encoder());
        let uart = BufferedUart::new(
            p.USART6,
            p.PC7,
            p.PC6,
            SEND.take(),
            RECEIVE.take(),
            Interrupts,
            stm32::uart(),
        )
        .expect("the clock suits the link's speed");
        let mut adc = Adc::new(p.ADC1);
        let mut amplifiers = (p.PA6, p.PA5);
        // The bridge is open: no current flows.
        let shunts = Shunts::new(STEP_UA, || readings(&mut adc, &mut amplifiers));
        let wiring = Connections {
            fault: Input::new(p.PC12, Pull::Up),
            adc,
            amplifiers,
            supply: p.PC2,
            thermistor: p.PA3,
            shunts,
            _held: held,
        };
        Stm32::new(
            bridge,
            encoder,
            uart,
            p.IWDG,
            stm32f4::store(p.FLASH),
            wiring,
        )
    }
}

/// A step of the ADC: 3.3 V by 4096, a shunt of a milliohm and an amplifier of ten, µA.
const STEP_UA: i32 = 80_566;
/// Reading of the thermistor at 85 °C, where it has 1.45 kΩ (B = 3434 K).
const HOT: u16 = 3_576;
const SAMPLING: SampleTime = SampleTime::CYCLES15;

/// Readings of both amplifiers.
fn readings(
    adc: &mut Adc<'static, ADC1>,
    (a, b): &mut (Peri<'static, PA6>, Peri<'static, PA5>),
) -> [u16; 2] {
    [
        adc.blocking_read(a, SAMPLING),
        adc.blocking_read(b, SAMPLING),
    ]
}

impl Wiring for Connections {
    const NAME: &'static str = "STM32F405";
    const SLICE: u32 = 1000;
    const SENSES_CURRENT: bool = true;
    const CURRENT_LIMIT_MA: u32 = 50_000;
    const CURRENT_RESOLUTION_MA: u16 = 81;
    type EncoderTimer = TIM4;
    type LinkInterrupt = interrupt::typelevel::USART6;

    fn enable(&mut self, _on: bool) {}

    fn noise(&mut self) -> u16 {
        self.adc.blocking_read(&mut self.amplifiers.0, SAMPLING)
    }

    fn reports_fault(&mut self) -> bool {
        self.fault.is_low()
    }

    fn current_ma(&mut self, forward: bool) -> i32 {
        let readings = readings(&mut self.adc, &mut self.amplifiers);
        self.shunts.ma(readings, forward)
    }

    fn supply_mv(&mut self) -> Option<u16> {
        let reading = self.adc.blocking_read(&mut self.supply, SAMPLING);
        // 3.3 V are 4096 steps, behind a divider by 412 / 22.
        u16::try_from(u32::from(reading) * 3_300 * 412 / (4_096 * 22)).ok()
    }

    fn is_hot(&mut self) -> bool {
        self.adc.blocking_read(&mut self.thermistor, SAMPLING) > HOT
    }
}
