//! Pin maps of the boards, retyped from the tables in `firmware/src/board/stm32f4*.rs`: the
//! firmware's own map is under test.

use clap::ValueEnum;

/// A pin and the alternate function that connects it to its peripheral.
#[derive(Debug, Clone, Copy)]
pub struct PinAt {
    /// Port A is 0.
    pub port: usize,
    /// Number in the port.
    pub pin: u8,
    /// Alternate function; 0 for a pin that the program reads or writes.
    pub function: u8,
}

/// Fault output of the bridge's driver.
#[derive(Debug, Clone, Copy)]
pub enum FaultLine {
    /// On the break input of TIM1.
    Break(PinAt),
    /// On a pin that the program reads.
    Read(PinAt),
}

/// A board.
#[derive(Debug, Clone, Copy)]
pub struct Wiring {
    /// Of the microcontroller's external oscillator, Hz.
    pub crystal_hz: u64,
    /// What its program makes of that for the core, Hz.
    pub core_hz: u64,
    /// High and low side of leg A, of leg B: TIM1's first two outputs and their complements.
    pub legs: [PinAt; 4],
    /// Lets the bridge's driver follow them.
    pub enable: PinAt,
    /// Active low.
    pub fault: FaultLine,
    /// TIM2 is 0.
    pub encoder_timer: usize,
    /// A and B.
    pub encoder: [PinAt; 2],
    /// USART1 is 0, USART6 is 3.
    pub serial_port: usize,
    /// Transmit and receive.
    pub link: [PinAt; 2],
    /// What the ADC is connected to.
    pub sensing: Sensing,
}

/// The sensors of a board, by the ADC's channels.
#[derive(Debug, Clone, Copy)]
pub enum Sensing {
    /// None.
    Nothing,
    /// An amplifier of the armature current: 1650 mV at zero, 100 mV/A.
    Armature(u8),
    /// Shunts below legs A and B, 1650 mV at zero and 10 mV for an ampere out of the leg; the supply by 22/412; a thermistor at 25 °C.
    Legs {
        /// Of each leg.
        shunts: [u8; 2],
        /// Of the supply.
        supply: u8,
        /// Of the thermistor.
        thermistor: u8,
    },
}

/// The boards whose images run here. The STM32F427 has all that the others' programs use of theirs, at the same addresses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Model {
    /// STM32F405, VESC 4
    Stm32f405,
    /// STM32F411, Black Pill
    Stm32f411,
    /// STM32F427
    Stm32f427,
    /// Nucleo-F446RE
    Stm32f446,
}

impl Model {
    /// Its pin map.
    pub fn wiring(self) -> Wiring {
        match self {
            Self::Stm32f405 => Wiring {
                crystal_hz: 8_000_000,
                core_hz: 168_000_000,
                legs: [a(8, 1), b(13, 1), a(9, 1), b(14, 1)],
                enable: c(10, 0),
                fault: FaultLine::Read(c(12, 0)),
                encoder_timer: 2,
                encoder: [b(6, 2), b(7, 2)],
                serial_port: 3,
                link: [c(6, 8), c(7, 8)],
                sensing: Sensing::Legs {
                    shunts: [6, 5],
                    supply: 12,
                    thermistor: 3,
                },
            },
            Self::Stm32f411 => Wiring {
                crystal_hz: 25_000_000,
                core_hz: 100_000_000,
                encoder: [a(6, 2), a(7, 2)],
                ..Self::Stm32f446.wiring()
            },
            Self::Stm32f427 => Wiring {
                crystal_hz: 8_000_000,
                core_hz: 168_000_000,
                legs: [e(9, 1), e(8, 1), e(11, 1), e(10, 1)],
                enable: e(7, 0),
                fault: FaultLine::Break(e(15, 1)),
                encoder_timer: 1,
                encoder: [c(6, 2), c(7, 2)],
                serial_port: 1,
                link: [d(5, 7), d(6, 7)],
                sensing: Sensing::Armature(10),
            },
            Self::Stm32f446 => Wiring {
                crystal_hz: 8_000_000,
                core_hz: 168_000_000,
                legs: [a(8, 1), b(13, 1), a(9, 1), b(14, 1)],
                enable: b(10, 0),
                fault: FaultLine::Break(b(12, 1)),
                encoder_timer: 1,
                encoder: [c(6, 2), c(7, 2)],
                serial_port: 1,
                link: [a(2, 7), a(3, 7)],
                sensing: Sensing::Nothing,
            },
        }
    }
}

const fn at(port: usize, pin: u8, function: u8) -> PinAt {
    PinAt {
        port,
        pin,
        function,
    }
}

const fn a(pin: u8, function: u8) -> PinAt {
    at(0, pin, function)
}

const fn b(pin: u8, function: u8) -> PinAt {
    at(1, pin, function)
}

const fn c(pin: u8, function: u8) -> PinAt {
    at(2, pin, function)
}

const fn d(pin: u8, function: u8) -> PinAt {
    at(3, pin, function)
}

const fn e(pin: u8, function: u8) -> PinAt {
    at(4, pin, function)
}
