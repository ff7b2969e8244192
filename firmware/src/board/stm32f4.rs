//! What the STM32F4 boards share.

use embassy_stm32::Config;
use embassy_stm32::rcc::{
    AHBPrescaler, APBPrescaler, Hse, HseMode, Pll, PllMul, PllPDiv, PllPreDiv, PllSource, Sysclk,
};
use embassy_stm32::time::mhz;
#[cfg(any(feature = "stm32f411", feature = "stm32f446"))]
use embassy_stm32::{
    Peri,
    adc::{Adc, SampleTime, Temperature},
    peripherals::ADC1,
};

/// 168 MHz, the fastest that all but the F411 run at, from 8 MHz on the pins of the external oscillator: the internal one
/// would let every time constant that is identified be wrong by up to a percent.
#[cfg(not(feature = "stm32f411"))]
pub fn clocks(external: HseMode) -> Config {
    from_external(
        8,
        external,
        PllPreDiv::DIV4,
        PllMul::MUL168,
        APBPrescaler::DIV4,
        APBPrescaler::DIV2,
    )
}

/// 100 MHz, the fastest of the F411, from a crystal of 25 MHz.
#[cfg(feature = "stm32f411")]
pub fn clocks() -> Config {
    from_external(
        25,
        HseMode::Oscillator,
        PllPreDiv::DIV25,
        PllMul::MUL200,
        APBPrescaler::DIV2,
        APBPrescaler::DIV1,
    )
}

/// Half of `oscillator_mhz / divider * multiplier`; the peripherals' two buses are slower.
fn from_external(
    oscillator_mhz: u32,
    mode: HseMode,
    divider: PllPreDiv,
    multiplier: PllMul,
    apb1: APBPrescaler,
    apb2: APBPrescaler,
) -> Config {
    let mut config = Config::default();
    config.rcc.hse = Some(Hse {
        freq: mhz(oscillator_mhz),
        mode,
    });
    config.rcc.pll_src = PllSource::HSE;
    config.rcc.pll = Some(Pll {
        prediv: divider,
        mul: multiplier,
        divp: Some(PllPDiv::DIV2),
        divq: None,
        divr: None,
    });
    config.rcc.ahb_pre = AHBPrescaler::DIV1;
    config.rcc.apb1_pre = apb1;
    config.rcc.apb2_pre = apb2;
    config.rcc.sys = Sysclk::PLL1_P;
    config
}

/// The chip's own, whose last bits are noise.
#[cfg(any(feature = "stm32f411", feature = "stm32f446"))]
pub struct Thermometer {
    adc: Adc<'static, ADC1>,
    channel: Temperature,
}

#[cfg(any(feature = "stm32f411", feature = "stm32f446"))]
impl Thermometer {
    /// Takes the ADC.
    pub fn new(adc: Peri<'static, ADC1>) -> Self {
        let adc = Adc::new(adc);
        Self {
            channel: adc.enable_temperature(),
            adc,
        }
    }
}

#[cfg(any(feature = "stm32f411", feature = "stm32f446"))]
impl super::stm32::module::Noise for Thermometer {
    fn read(&mut self) -> u16 {
        self.adc
            .blocking_read(&mut self.channel, SampleTime::CYCLES3)
    }
}
