//! Nucleo-F446RE with a bridge module for brushed motors, such as two BTS7960 on one board. Not yet run on hardware.
//!
//! | pin | Arduino | what |
//! |---|---|---|
//! | PA8 | D7 | half bridge of motor lead + (RPWM) |
//! | PA9 | D8 | half bridge of motor lead − (LPWM) |
//! | PB13, PB14 | – | the same inverted with a dead time, for a bridge with an input for each low side |
//! | PB10 | D6 | enables both half bridges (R_EN and L_EN), pulled down by 10 kΩ to ground |
//! | PB12 | – | fault output of the bridge, active low; may stay open |
//! | PC6, PC7 | –, D9 | encoder A and B |
//! | PA2, PA3 | – | link, over the ST-LINK's USB |
//! | PH0 | – | clock, 8 MHz, from the ST-LINK |

use embassy_stm32::peripherals::{TIM3, USART2};
use embassy_stm32::rcc::HseMode;
use embassy_stm32::timer::qei::Qei;
use embassy_stm32::usart::{self, BufferedUart};
use embassy_stm32::{bind_interrupts, interrupt};
use static_cell::ConstStaticCell;

use super::link;
use super::stm32::module::{Module, ModuleBoard};
use super::stm32::{self, Bridge, BridgePins, Stm32};
use super::stm32f4::{self, Thermometer};

/// Nucleo-F446RE and its bridge.
pub type Stm32f446 = Stm32<Module<Nucleo>>;

/// The board.
pub struct Nucleo;

impl ModuleBoard for Nucleo {
    const NAME: &'static str = "Nucleo-F446RE";
    const SLICE: u32 = 1000;
    type EncoderTimer = TIM3;
    type LinkInterrupt = interrupt::typelevel::USART2;
    type Noise = Thermometer;
}

bind_interrupts!(struct Interrupts {
    USART2 => usart::BufferedInterruptHandler<USART2>;
});

static SEND: ConstStaticCell<[u8; link::SEND_BUFFER]> = ConstStaticCell::new([0; _]);
static RECEIVE: ConstStaticCell<[u8; link::RECEIVE_BUFFER]> = ConstStaticCell::new([0; _]);

impl Stm32f446 {
    /// Takes the microcontroller over. Once: a second call would find its peripherals taken, and panics.
    pub fn start() -> Self {
        let p = embassy_stm32::init(stm32f4::clocks(HseMode::Bypass));
        let legs = BridgePins::new(p.PA8, p.PB13, p.PA9, p.PB14);
        let bridge = Bridge::new(p.TIM1, legs, 1000, 0).with_break_input(p.PB12);
        let encoder = Qei::new(p.TIM3, p.PC6, p.PC7, stm32::encoder());
        let uart = BufferedUart::new(
            p.USART2,
            p.PA3,
            p.PA2,
            SEND.take(),
            RECEIVE.take(),
            Interrupts,
            stm32::uart(),
        )
        .expect("the clock suits the link's speed");
        let wiring = Module::new(p.PB10, Thermometer::new(p.ADC1));
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
