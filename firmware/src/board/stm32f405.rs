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
//! | PH0, PH1 | crystal, 8 MHz |
//!
//! Its shunts are below the low sides and show the current only while those conduct, so it is not sensed.

use embassy_stm32::adc::{Adc, SampleTime, Temperature};
use embassy_stm32::bind_interrupts;
use embassy_stm32::gpio::{Input, Level, Output, Pull, Speed};
use embassy_stm32::peripherals::{ADC1, TIM4, USART6};
use embassy_stm32::rcc::HseMode;
use embassy_stm32::timer::qei::Qei;
use embassy_stm32::usart::{self, BufferedUart};
use static_cell::ConstStaticCell;

use super::link;
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
    thermometer: Temperature,
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
        let adc = Adc::new(p.ADC1);
        let wiring = Connections {
            fault: Input::new(p.PC12, Pull::Up),
            thermometer: adc.enable_temperature(),
            adc,
            _held: held,
        };
        Stm32::new(bridge, encoder, uart, p.IWDG, wiring)
    }
}

impl Wiring for Connections {
    const NAME: &'static str = "STM32F405";
    const SLICE: u32 = 1000;
    type EncoderTimer = TIM4;

    fn enable(&mut self, _on: bool) {}

    fn noise(&mut self) -> u16 {
        let time = SampleTime::CYCLES3;
        self.adc.blocking_read(&mut self.thermometer, time)
    }

    fn reports_fault(&mut self) -> bool {
        self.fault.is_low()
    }
}
