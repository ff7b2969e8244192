//! The chip's two ports as streams that never wait: both have their bytes in hardware queues.

use core::slice;

use esp_hal::Blocking;
use esp_hal::uart::Uart;
use esp_hal::usb::usb_serial_jtag::UsbSerialJtag;

use crate::board::port::Port;

/// The serial port, with a queue of 128 bytes each way: what comes in 1.4 ms.
pub struct Serial(pub Uart<'static, Blocking>);

impl Port for Serial {
    fn receive(&mut self) -> Option<u8> {
        let mut byte = 0;
        let taken =
            self.0.read_ready() && self.0.read_buffered(slice::from_mut(&mut byte)) == Ok(1);
        taken.then_some(byte)
    }

    fn send(&mut self, bytes: &[u8]) -> usize {
        bytes
            .iter()
            .take_while(|&byte| {
                self.0.write_ready() && self.0.write(slice::from_ref(byte)) == Ok(1)
            })
            .count()
    }
}

/// The USB port that the chip is also flashed by.
pub struct Usb(pub UsbSerialJtag<'static, Blocking>);

impl Port for Usb {
    fn receive(&mut self) -> Option<u8> {
        self.0.read_byte().ok()
    }

    fn send(&mut self, bytes: &[u8]) -> usize {
        let sent = bytes
            .iter()
            .take_while(|&&byte| self.0.write_byte_nb(byte).is_ok())
            .count();
        // What waits goes to the host now, and not when the queue is full.
        let _ = self.0.flush_tx_nb();
        sent
    }
}
