//! Blue Pill (STM32F103C8, 8 MHz crystal) with a bridge module for brushed motors, such as two BTS7960 on one board. Not yet run on
//! hardware. The smallest of the boards: no floating-point unit, 64 KiB of flash and 20 KiB of RAM, so that half a second of its
//! recording can be fitted.
//!
//! | pin | what |
//! |---|---|
//! | PA8 | half bridge of motor lead + (RPWM) |
//! | PA9 | half bridge of motor lead − (LPWM) |
//! | PB13, PB14 | the same inverted with a dead time, for a bridge with an input for each low side |
//! | PB10 | enables both half bridges (R_EN and L_EN), pulled down by 10 kΩ to ground |
//! | PB12 | fault output of the bridge, active low; may stay open |
//! | PA6, PA7 | encoder A and B |
//! | PA2, PA3 | link, transmit and receive, to a 3.3 V adapter |

use embassy_futures::block_on;
use embassy_stm32::adc::{self, Adc, SampleTime, Temperature};
use embassy_stm32::gpio::{AfioRemap, AfioRemapBool};
use embassy_stm32::peripherals::{ADC1, TIM3, USART2};
use embassy_stm32::rcc::{
    ADCPrescaler, AHBPrescaler, APBPrescaler, Hse, HseMode, Pll, PllMul, PllPreDiv, PllSource,
    Sysclk,
};
use embassy_stm32::time::mhz;
use embassy_stm32::timer::qei::Qei;
use embassy_stm32::usart::{self, BufferedUart};
use embassy_stm32::{Config, bind_interrupts, interrupt};
use static_cell::ConstStaticCell;

use super::link;
use super::stm32::module::{Module, ModuleBoard, Noise};
use super::stm32::{self, Bridge, BridgePins, Stm32};
use super::store::NoStore;

/// Blue Pill and its bridge.
pub type Stm32f103 = Stm32<Module<BluePill>>;

/// The board.
pub struct BluePill;

impl ModuleBoard for BluePill {
    const NAME: &'static str = "Blue Pill (STM32F103)";
    // Some 250 instructions a sample in fixed point.
    const SLICE: u32 = 60;
    type EncoderTimer = TIM3;
    type LinkInterrupt = interrupt::typelevel::USART2;
    type Noise = Thermometer;
}

bind_interrupts!(struct Interrupts {
    USART2 => usart::BufferedInterruptHandler<USART2>;
    ADC1_2 => adc::InterruptHandler<ADC1>;
});

static SEND: ConstStaticCell<[u8; link::SEND_BUFFER]> = ConstStaticCell::new([0; _]);
static RECEIVE: ConstStaticCell<[u8; link::RECEIVE_BUFFER]> = ConstStaticCell::new([0; _]);

impl Stm32f103 {
    /// Takes the microcontroller over. Once: a second call would find its peripherals taken, and panics.
    pub fn start() -> Self {
        let p = embassy_stm32::init(clocks());
        let legs = BridgePins::new(p.PA8, p.PB13, p.PA9, p.PB14);
        let bridge = Bridge::new(p.TIM1, legs, 1000, 0).with_break_input(p.PB12);
        let encoder = Qei::new::<_, _, AfioRemap<0>>(p.TIM3, p.PA6, p.PA7, stm32::encoder());
        let uart = BufferedUart::new::<_, AfioRemapBool<false>>(
            p.USART2,
            p.PA3,
            p.PA2,
            SEND.take(),
            RECEIVE.take(),
            Interrupts,
            stm32::uart(),
        )
        .expect("the clock suits the link's speed");
        let adc = Adc::new(p.ADC1);
        let channel = adc.enable_temperature();
        let wiring = Module::new(p.PB10, Thermometer { adc, channel });
        Stm32::new(bridge, encoder, uart, p.IWDG, NoStore, wiring)
    }
}

/// 72 MHz, the fastest that it runs at, from its crystal.
fn clocks() -> Config {
    let mut config = Config::default();
    config.rcc.hse = Some(Hse {
        freq: mhz(8),
        mode: HseMode::Oscillator,
    });
    config.rcc.pll = Some(Pll {
        src: PllSource::HSE,
        prediv: PllPreDiv::DIV1,
        mul: PllMul::MUL9,
    });
    config.rcc.sys = Sysclk::PLL1_P;
    config.rcc.ahb_pre = AHBPrescaler::DIV1;
    config.rcc.apb1_pre = APBPrescaler::DIV2;
    config.rcc.apb2_pre = APBPrescaler::DIV1;
    config.rcc.adc_pre = ADCPrescaler::DIV6;
    config
}

/// The chip's own, whose last bits are noise.
pub struct Thermometer {
    adc: Adc<'static, ADC1>,
    channel: Temperature,
}

impl Noise for Thermometer {
    fn read(&mut self) -> u16 {
        block_on(self.adc.read(&mut self.channel, SampleTime::CYCLES1_5))
    }
}
