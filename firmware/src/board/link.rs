//! The link over a serial port with the asynchronous traits of `embedded-io`, used without an executor: polled once, they never wait.
//! (The blocking ones wait, unless a HAL has `ReadReady` and `WriteReady` too; those for the STM32s and the Pico lack the latter.)

use core::slice;
use core::task::Poll;

use embassy_futures::poll_once;
use embedded_io_async::{Read, Write};

use super::port::Port;

/// Bytes that wait to be sent. At this speed the line empties 92 of them in a millisecond.
pub const SEND_BUFFER: usize = 512;
/// Bytes that wait to be received: what comes in two milliseconds, and some.
pub const RECEIVE_BUFFER: usize = 256;

/// A serial port with a buffer each way, filled and emptied by its interrupt.
#[derive(Debug)]
pub struct Link<U> {
    uart: U,
}

impl<U> Link<U> {
    /// The link over `uart`.
    pub fn new(uart: U) -> Self {
        Self { uart }
    }
}

impl<U: Read + Write> Port for Link<U> {
    /// A byte that came damaged is lost: what frames the bytes finds out.
    fn receive(&mut self) -> Option<u8> {
        let mut byte = 0;
        match poll_once(self.uart.read(slice::from_mut(&mut byte))) {
            Poll::Ready(Ok(1)) => Some(byte),
            _ => None,
        }
    }

    /// Byte by byte, because a driver takes all of a slice or none of it.
    fn send(&mut self, bytes: &[u8]) -> usize {
        bytes
            .iter()
            .take_while(|&byte| {
                matches!(
                    poll_once(self.uart.write(slice::from_ref(byte))),
                    Poll::Ready(Ok(1))
                )
            })
            .count()
    }
}
