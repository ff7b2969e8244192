//! ST's B-G431B-ESC1: STM32G431 and three half bridges, of which the motor uses the first two. Not yet run on hardware.
//!
//! | pin | what |
//! |---|---|
//! | PA8, PC13 | high side and low side of phase U (motor lead +) |
//! | PA9, PA12 | high side and low side of phase V (motor lead −) |
//! | PA10, PB15 | high side and low side of phase W, held off |
//! | PB6, PB7 | encoder A and B, on the hall connector |
//! | PB3, PB4 | link, transmit and receive, over the ST-LINK's USB |
//! | PA1, PA3, PA2 | shunt of phase U: the amplifier's inputs and output |
//! | PA7, PA5, PA6 | shunt of phase V: the amplifier's inputs and output |
//! | PA0 | supply, by 169 kΩ and 18 kΩ |
//! | PB14 | thermistor, 10 kΩ at 25 °C, to 3.3 V; 4.7 kΩ to ground |
//! | PF0, PF1 | crystal, 8 MHz |
//!
//! Its gate drivers L6387 keep the two transistors of a leg from conducting together, hold them off without a supply,
//! and have no enable input. Their high sides live on capacitors that recharge while the low side conducts.
//!
//! Shunts of 3 mΩ are below the low sides. The chip's own amplifiers and the board's resistors make 64/7 of that, inverted; the signs and
//! the dividers are those of ST's motor control kit for this board.

use embassy_stm32::adc::{Adc, SampleTime};
use embassy_stm32::gpio::{Level, Output, Speed};
use embassy_stm32::opamp::{OpAmp, OpAmpGain, OpAmpOutput, OpAmpSpeed};
use embassy_stm32::peripherals::{ADC1, ADC2, OPAMP1, OPAMP2, PA0, PB14, TIM4, USART2};
use embassy_stm32::rcc::{Hse, HseMode, Pll, PllMul, PllPreDiv, PllRDiv, PllSource, Sysclk, mux};
use embassy_stm32::time::mhz;
use embassy_stm32::timer::qei::Qei;
use embassy_stm32::usart::{self, BufferedUart};
use embassy_stm32::{Config, Peri, bind_interrupts, interrupt};
use static_cell::{ConstStaticCell, StaticCell};

use super::link;
use super::shunts::Shunts;
use super::stm32::{self, Bridge, BridgePins, Stm32, Wiring};
use super::store::NoStore;

/// B-G431B-ESC1.
pub type Stm32g431 = Stm32<Connections>;

bind_interrupts!(struct Interrupts {
    USART2 => usart::BufferedInterruptHandler<USART2>;
});

static SEND: ConstStaticCell<[u8; link::SEND_BUFFER]> = ConstStaticCell::new([0; _]);
static RECEIVE: ConstStaticCell<[u8; link::RECEIVE_BUFFER]> = ConstStaticCell::new([0; _]);

/// The pins that are not one timer's or the link's.
pub struct Connections {
    amplifiers: Amplifiers,
    supply: Peri<'static, PA0>,
    thermistor: Peri<'static, PB14>,
    shunts: Shunts,
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
        let u = OPAMP_U.init(OpAmp::new(p.OPAMP1, OpAmpSpeed::HighSpeed));
        let v = OPAMP_V.init(OpAmp::new(p.OPAMP2, OpAmpSpeed::HighSpeed));
        let mut amplifiers = Amplifiers {
            u: u.pga_biased_ext(p.PA1, p.PA3, p.PA2, OpAmpGain::Mul16),
            v: v.pga_biased_ext(p.PA7, p.PA5, p.PA6, OpAmpGain::Mul16),
            adc_u: Adc::new(p.ADC1, Default::default()),
            adc_v: Adc::new(p.ADC2, Default::default()),
        };
        // The bridge is open: no current flows.
        let shunts = Shunts::new(STEP_UA, || amplifiers.readings());
        let wiring = Connections {
            amplifiers,
            supply: p.PA0,
            thermistor: p.PB14,
            shunts,
            _held: held,
        };
        Stm32::new(bridge, encoder, uart, p.IWDG, NoStore, wiring)
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

/// The amplifiers of the shunts, each before an ADC of its own.
struct Amplifiers {
    u: OpAmpOutput<'static, OPAMP1>,
    v: OpAmpOutput<'static, OPAMP2>,
    adc_u: Adc<'static, ADC1>,
    adc_v: Adc<'static, ADC2>,
}

impl Amplifiers {
    fn readings(&mut self) -> [u16; 2] {
        [
            self.adc_u.blocking_read(&mut self.u, SAMPLING),
            self.adc_v.blocking_read(&mut self.v, SAMPLING),
        ]
    }
}

static OPAMP_U: StaticCell<OpAmp<'static, OPAMP1>> = StaticCell::new();
static OPAMP_V: StaticCell<OpAmp<'static, OPAMP2>> = StaticCell::new();

const SAMPLING: SampleTime = SampleTime::CYCLES24_5;
/// A step of the ADC: 3.3 V by 4096, a shunt of three milliohms and a gain of -64/7, µA.
const STEP_UA: i32 = -29_372;
/// Reading of the thermistor at 85 °C, where it has 1.45 kΩ (B = 3435 K).
const HOT: u16 = 3_130;

impl Wiring for Connections {
    const NAME: &'static str = "B-G431B-ESC1";
    const SLICE: u32 = 1000;
    const SENSES_CURRENT: bool = true;
    const CURRENT_LIMIT_MA: u32 = 20_000;
    const CURRENT_RESOLUTION_MA: u16 = 30;
    type EncoderTimer = TIM4;
    type LinkInterrupt = interrupt::typelevel::USART2;

    fn enable(&mut self, _on: bool) {}

    fn noise(&mut self) -> u16 {
        let [u, v] = self.amplifiers.readings();
        u ^ v
    }

    fn current_ma(&mut self, forward: bool) -> i32 {
        self.shunts.ma(self.amplifiers.readings(), forward)
    }

    fn supply_mv(&mut self) -> Option<u16> {
        let adc = &mut self.amplifiers.adc_u;
        let reading = adc.blocking_read(&mut self.supply, SAMPLING);
        // 3.3 V are 4096 steps, behind a divider by 187 / 18.
        u16::try_from(u32::from(reading) * 3_300 * 187 / (4_096 * 18)).ok()
    }

    fn is_hot(&mut self) -> bool {
        let adc = &mut self.amplifiers.adc_u;
        adc.blocking_read(&mut self.thermistor, SAMPLING) > HOT
    }
}
