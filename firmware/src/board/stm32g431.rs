//! ST's B-G431B-ESC1: STM32G431 and three half bridges, of which the motor uses the first two. Not yet run on hardware.
//!
//! | pin | what |
//! |---|---|
//! | PA8, PC13 | high side and low side of phase U (motor lead +) |
//! | PA9, PA12 | high side and low side of phase V (motor lead −) |
//! | PA10, PB15 | high side and low side of phase W, held off |
//! | PB6, PB7 | encoder A and B, on the hall connector |
//! | PB3, PB4 | link, transmit and receive, over the ST-LINK's USB |
//! | PF0, PF1 | crystal, 8 MHz |
//!
//! Its gate drivers L6387 keep the two transistors of a leg from conducting together, hold them off without a supply,
//! and have no enable input. Their high sides live on capacitors that recharge while the low side conducts. Its shunts
//! are below the low sides and show the current only while those conduct, so it is not sensed.

use embassy_stm32::adc::{Adc, SampleTime, Temperature};
use embassy_stm32::gpio::{Level, Output, Speed};
use embassy_stm32::peripherals::{ADC1, TIM4, USART2};
use embassy_stm32::rcc::{Hse, HseMode, Pll, PllMul, PllPreDiv, PllRDiv, PllSource, Sysclk, mux};
use embassy_stm32::time::mhz;
use embassy_stm32::timer::qei::Qei;
use embassy_stm32::usart::{self, BufferedUart};
use embassy_stm32::{Config, bind_interrupts};
use static_cell::ConstStaticCell;

use super::link;
use super::stm32::{self, Bridge, BridgePins, Stm32, Wiring};

/// B-G431B-ESC1.
pub type Stm32g431 = Stm32<Connections>;

bind_interrupts!(struct Interrupts {
    USART2 => usart::BufferedInterruptHandler<USART2>;
});

static SEND: ConstStaticCell<[u8; link::SEND_BUFFER]> = ConstStaticCell::new([0; _]);
static RECEIVE: ConstStaticCell<[u8; link::RECEIVE_BUFFER]> = ConstStaticCell::new([0; _]);

/// The pins that are not one timer's or the link's.
pub struct Connections {
    adc: Adc<'static, ADC1>,
    thermometer: Temperature,
    _held: [Output<'static>; 2],
}

impl Stm32g431 {
    /// Takes the microcontroller over. Once: a second call would find its peripherals taken, and panics.
    pub fn start() -> Self {
        let p = embassy_stm32::init(clocks());
        let held = [
            Output::new(p.PA10, Level::Low, Speed::Low),
            Output::new(p.PB15, Level::Low, Speed::Low),
        ];
        let legs = BridgePins::new(p.PA8, p.PC13, p.PA9, p.PA12);
        let bridge = Bridge::new(p.TIM1, legs, 700, 1000);
        let encoder = Qei::new(p.TIM4, p.PB6, p.PB7, stm32::encoder());
        let uart = BufferedUart::new(
            p.USART2,
            p.PB4,
            p.PB3,
            SEND.take(),
            RECEIVE.take(),
            Interrupts,
            stm32::uart(),
        )
        .expect("the clock suits the link's speed");
        let adc = Adc::new(p.ADC1, Default::default());
        let wiring = Connections {
            thermometer: adc.enable_temperature(),
            adc,
            _held: held,
        };
        Stm32::new(bridge, encoder, uart, p.IWDG, wiring)
    }
}

/// 170 MHz, the fastest it runs at, from the crystal.
fn clocks() -> Config {
    let mut config = Config::default();
    config.rcc.hse = Some(Hse {
        freq: mhz(8),
        mode: HseMode::Oscillator,
    });
    config.rcc.pll = Some(Pll {
        source: PllSource::HSE,
        prediv: PllPreDiv::DIV2,
        mul: PllMul::MUL85,
        divp: None,
        divq: None,
        divr: Some(PllRDiv::DIV2),
    });
    config.rcc.sys = Sysclk::PLL1_R;
    config.rcc.boost = true;
    config.rcc.mux.adc12sel = mux::Adcsel::SYS;
    config
}

impl Wiring for Connections {
    const NAME: &'static str = "B-G431B-ESC1";
    const SLICE: u32 = 1000;
    type EncoderTimer = TIM4;

    fn enable(&mut self, _on: bool) {}

    fn noise(&mut self) -> u16 {
        let time = SampleTime::CYCLES2_5;
        self.adc.blocking_read(&mut self.thermometer, time)
    }
}
