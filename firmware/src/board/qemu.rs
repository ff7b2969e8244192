//! QEMU's netduinoplus2, an STM32F405 with little around it: the link on USART1, a plant in lock step on USART2.

use super::Board;
use super::lockstep::{Answer, Reading, ask};
use crate::phase::Fault;

/// A serial port of the STM32F4, polled. Its clock and pins need no setting up in QEMU.
#[derive(Debug)]
struct Usart {
    base: usize,
}

const STATUS: usize = 0x00;
const DATA: usize = 0x04;
const CONTROL: usize = 0x0c;
const RECEIVED: u32 = 1 << 5;
const EMPTY: u32 = 1 << 7;
/// Enabled, sending, receiving.
const ON: u32 = 1 << 13 | 1 << 3 | 1 << 2;

impl Usart {
    fn new(base: usize) -> Self {
        let port = Usart { base };
        port.write(CONTROL, ON);
        port
    }

    #[allow(unsafe_code)]
    fn read(&self, register: usize) -> u32 {
        // Safety: the address is that of a register of a USART of the STM32F405 (RM0090, §30.6), aligned, and reading it
        // touches no memory. Each port has one owner.
        unsafe { ((self.base + register) as *const u32).read_volatile() }
    }

    #[allow(unsafe_code)]
    fn write(&self, register: usize, value: u32) {
        // Safety: as above; no DMA is set up, so writing it touches no memory either.
        unsafe { ((self.base + register) as *mut u32).write_volatile(value) }
    }

    fn receive(&self) -> Option<u8> {
        (self.read(STATUS) & RECEIVED != 0).then(|| self.read(DATA) as u8)
    }

    fn send(&self, byte: u8) {
        while self.read(STATUS) & EMPTY == 0 {}
        self.write(DATA, byte.into());
    }
}

/// The emulated board.
#[derive(Debug)]
pub struct Qemu {
    link: Usart,
    plant: Usart,
    duty: Option<i16>,
    reading: Reading,
    answer: Answer,
}

impl Qemu {
    /// Takes both ports; there is one board, so call it once.
    pub fn start() -> Self {
        Qemu {
            link: Usart::new(0x4001_1000),
            plant: Usart::new(0x4000_4400),
            duty: None,
            reading: Reading::default(),
            answer: Answer::default(),
        }
    }
}

impl Board for Qemu {
    const NAME: &'static str = "QEMU netduinoplus2";
    const PERIOD_US: u32 = 1000;
    const SLICE: u32 = 20_000;
    const SENSES_CURRENT: bool = true;

    fn drive(&mut self, duty: i16) {
        self.duty = Some(duty);
    }

    fn coast(&mut self) {
        self.duty = None;
    }

    fn count(&mut self) -> i32 {
        self.reading.count
    }

    fn current_ma(&mut self) -> i32 {
        self.reading.current_ma.into()
    }

    fn tick(&mut self) -> Result<(), Fault> {
        for byte in ask(self.duty) {
            self.plant.send(byte);
        }
        loop {
            if let Some(reading) = self.plant.receive().and_then(|byte| self.answer.push(byte)) {
                self.reading = reading;
                return Ok(());
            }
        }
    }

    fn receive(&mut self) -> Option<u8> {
        self.link.receive()
    }

    fn send(&mut self, bytes: &[u8]) -> usize {
        for &byte in bytes {
            self.link.send(byte);
        }
        bytes.len()
    }

    fn entropy(&mut self) -> u32 {
        // The plant stands anywhere at power-up, and nothing else differs between two emulations.
        let _ = self.tick();
        (self.reading.count as u32).wrapping_mul(0x9e37_79b9)
    }
}
