//! STM32F427 with a bridge of separate high-side and low-side inputs and an amplifier for the armature current. This is
//! the board that tests on the PC run in an emulator, image and all.
//!
//! | pin | what |
//! |---|---|
//! | PE9, PE8 | high side and low side of leg A (motor lead +) |
//! | PE11, PE10 | high side and low side of leg B (motor lead −) |
//! | PE7 | enables the bridge's driver, active high, pulled down on the board |
//! | PE15 | the driver's fault output, active low, open drain |
//! | PC6, PC7 | encoder A and B |
//! | PC0 | armature current: 1.65 V at zero, 100 mV/A |
//! | PD5, PD6 | link, transmit and receive |
//! | PH0, PH1 | crystal, 8 MHz |

use embassy_stm32::adc::{Adc, SampleTime};
use embassy_stm32::gpio::{Level, Output, Speed};
use embassy_stm32::peripherals::{ADC1, PC0, TIM3, USART2};
use embassy_stm32::rcc::HseMode;
use embassy_stm32::timer::qei::Qei;
use embassy_stm32::usart::{self, BufferedUart};
use embassy_stm32::{Peri, bind_interrupts, interrupt};
use static_cell::ConstStaticCell;

use super::current::CurrentSensor;
use super::link;
use super::stm32::{self, Bridge, BridgePins, Stm32, Wiring};
use super::stm32f4;

/// STM32F427 and its bridge.
pub type Stm32f427 = Stm32<Connections>;

bind_interrupts!(struct Interrupts {
    USART2 => usart::BufferedInterruptHandler<USART2>;
});

static SEND: ConstStaticCell<[u8; link::SEND_BUFFER]> = ConstStaticCell::new([0; _]);
static RECEIVE: ConstStaticCell<[u8; link::RECEIVE_BUFFER]> = ConstStaticCell::new([0; _]);

const SAMPLING: SampleTime = SampleTime::CYCLES15;

/// The pins that are not one timer's or the link's.
pub struct Connections {
    enable: Output<'static>,
    adc: Adc<'static, ADC1>,
    current: Peri<'static, PC0>,
    sensor: CurrentSensor,
}

impl Stm32f427 {
    /// Takes the microcontroller over. Once: a second call would find its peripherals taken, and panics.
    pub fn start() -> Self {
        let p = embassy_stm32::init(stm32f4::clocks(HseMode::Oscillator));
        let enable = Output::new(p.PE7, Level::Low, Speed::Low);
        let legs = BridgePins::new(p.PE9, p.PE8, p.PE11, p.PE10);
        let bridge = Bridge::new(p.TIM1, legs, 500, 0).with_break_input(p.PE15);
        let encoder = Qei::new(p.TIM3, p.PC6, p.PC7, stm32::encoder());
        let uart = BufferedUart::new(
            p.USART2,
            p.PD6,
            p.PD5,
            SEND.take(),
            RECEIVE.take(),
            Interrupts,
            stm32::uart(),
        )
        .expect("the clock suits the link's speed");
        let (mut adc, mut current) = (Adc::new(p.ADC1), p.PC0);
        // The bridge is open: no current flows.
        let sensor = CurrentSensor::new(|| adc.blocking_read(&mut current, SAMPLING));
        let wiring = Connections {
            enable,
            adc,
            current,
            sensor,
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

impl Connections {
    fn reading(&mut self) -> u16 {
        self.adc.blocking_read(&mut self.current, SAMPLING)
    }
}

impl Wiring for Connections {
    const NAME: &'static str = "STM32F427";
    const SLICE: u32 = 1000;
    const SENSES_CURRENT: bool = true;
    // The amplifier shows up to 16.5 A.
    const CURRENT_LIMIT_MA: u32 = 14_000;
    const CURRENT_RESOLUTION_MA: u16 = 9;
    type EncoderTimer = TIM3;
    type LinkInterrupt = interrupt::typelevel::USART2;

    fn enable(&mut self, on: bool) {
        self.enable.set_level(on.into());
    }

    fn noise(&mut self) -> u16 {
        self.reading()
    }

    fn current_ma(&mut self, _forward: bool) -> i32 {
        let reading = self.reading();
        self.sensor.ma(reading)
    }
}
