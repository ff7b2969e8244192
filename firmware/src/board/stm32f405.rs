//! A motor controller of the VESC 4 kind: STM32F405, the gate driver DRV8302 and three half bridges, of which the
//! motor uses the first two. Not yet run on hardware.
//!
//! | pin | what |
//! |---|---|
//! | PA8, PB13 | high side and low side of phase 1 (motor lead +) |
//! | PA9, PB14 | high side and low side of phase 2 (motor lead −) |
//! | PA10, PB15 | high side and low side of phase 3, held off |
//! | PC10 | enables the gate driver |
//! | PC12 | the driver's fault output, active low |
//! | PB12 | calibrates the driver's amplifiers, held off |
//! | PB6, PB7 | encoder A and B, on the hall connector |
//! | PC6, PC7 | link, transmit and receive |
//! | PH0, PH1 | crystal, 8 MHz |

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
        let low = |pin| Output::new(pin, Level::Low, Speed::Low);
        let _third_phase = [low(p.PA10.into()), low(p.PB15.into())];
        todo!()
    }
}
