//! What the STM32F4 boards share.

use embassy_stm32::flash::{Blocking, Flash};
use embassy_stm32::pac;
use embassy_stm32::peripherals::FLASH;
use embassy_stm32::rcc::{
    AHBPrescaler, APBPrescaler, Hse, HseMode, Pll, PllMul, PllPDiv, PllPreDiv, PllSource, Sysclk,
};
use embassy_stm32::time::mhz;
use embassy_stm32::{Config, Peri};
#[cfg(any(feature = "stm32f411", feature = "stm32f446"))]
use embassy_stm32::{
    adc::{Adc, SampleTime, Temperature},
    peripherals::ADC1,
};

#[cfg(not(feature = "stm32f427"))]
use embassy_stm32::flash::Bank1Region3 as Pages;
#[cfg(feature = "stm32f427")]
use embassy_stm32::flash::Bank2Region1 as Pages;

use super::store::{FlashStore, LONGEST, Store};

/// The sectors behind the image, the first two of 128 KiB; on the STM32F427 the first two of the second bank, of 16 KiB each, which are written
/// while the program goes on in the first.
pub struct FlashPages(Option<FlashStore<Pages<'static, Blocking>>>);

/// Takes the flash.
pub fn store(flash: Peri<'static, FLASH>) -> FlashPages {
    // Reading the second bank of older ones fails while PA12 is in use (erratum 2.2.11 of the STM32F42xx), and the HAL does not try.
    #[cfg(feature = "stm32f427")]
    if pac::DBGMCU.idcode().read().rev_id() < 0x2001 {
        return FlashPages(None);
    }
    let regions = Flash::new_blocking(flash).into_blocking_regions();
    #[cfg(not(feature = "stm32f427"))]
    let pages = regions.bank1_region3;
    #[cfg(feature = "stm32f427")]
    let pages = regions.bank2_region1;
    FlashPages(Some(FlashStore::new(pages, 0)))
}

impl Store for FlashPages {
    fn load(&mut self, key: u8, into: &mut [u8; LONGEST]) -> Option<usize> {
        self.0.as_mut()?.load(key, into)
    }

    fn save(&mut self, key: u8, value: &[u8]) -> bool {
        let Some(pages) = &mut self.0 else {
            return false;
        };
        // What was read before it was written stays in the cache of the data (RM0090, 3.5.2).
        let control = pac::FLASH.acr();
        control.modify(|w| w.set_dcen(false));
        let saved = pages.save(key, value);
        control.modify(|w| w.set_dcrst(true));
        control.modify(|w| w.set_dcrst(false));
        control.modify(|w| w.set_dcen(true));
        saved
    }
}

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
