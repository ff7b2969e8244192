//! A bridge module with an enable input, on a board that has nothing else special.

use core::marker::PhantomData;

use embassy_stm32::Peri;
use embassy_stm32::gpio::{Level, Output, Pin, Speed};
use embassy_stm32::interrupt::typelevel::Interrupt;
use embassy_stm32::timer::GeneralInstance4Channel;

use super::Wiring;

/// What tells such boards apart.
pub trait ModuleBoard {
    /// See [`Board::NAME`](crate::board::Board::NAME).
    const NAME: &'static str;
    /// See [`Board::SLICE`](crate::board::Board::SLICE).
    const SLICE: u32;
    /// The timer that decodes the encoder.
    type EncoderTimer: GeneralInstance4Channel;
    /// See [`Wiring::LinkInterrupt`].
    type LinkInterrupt: Interrupt;
    /// Where its noise comes from.
    type Noise: Noise;
}

/// A reading whose last bits are noise.
pub trait Noise {
    /// One of them.
    fn read(&mut self) -> u16;
}

/// The enable pin and the noise of a board of the kind `B`.
pub struct Module<B: ModuleBoard> {
    enable: Output<'static>,
    noise: B::Noise,
    board: PhantomData<B>,
}

impl<B: ModuleBoard> Module<B> {
    /// Disables the module.
    pub fn new(enable: Peri<'static, impl Pin>, noise: B::Noise) -> Self {
        Self {
            enable: Output::new(enable, Level::Low, Speed::Low),
            noise,
            board: PhantomData,
        }
    }
}

impl<B: ModuleBoard> Wiring for Module<B> {
    const NAME: &'static str = B::NAME;
    const SLICE: u32 = B::SLICE;
    type EncoderTimer = B::EncoderTimer;
    type LinkInterrupt = B::LinkInterrupt;

    fn enable(&mut self, on: bool) {
        self.enable.set_level(on.into());
    }

    fn noise(&mut self) -> u16 {
        self.noise.read()
    }
}
