//! The Pico's USB port as a serial port (CDC ACM): the cable is all that a host needs.
//!
//! The control loop polls it, once in a period: an interrupt of the controller only wakes. So no transfer comes between a period's end
//! and the reading of the encoder.

use core::task::Poll;

use embassy_executor::raw::Executor;
use embassy_futures::poll_once;
use embassy_rp::peripherals::USB;
use embassy_rp::usb::Driver;
use embassy_usb::class::cdc_acm::{CdcAcmClass, State};
use embassy_usb::{Builder, Config, UsbDevice};
use heapless::Deque;
use static_cell::{ConstStaticCell, StaticCell};

use crate::board::port::Port;

/// Numbers of a serial port made with Raspberry Pi's own software, which every system knows.
const VENDOR: u16 = 0x2e8a;
#[cfg(feature = "rp2040")]
const PRODUCT: u16 = 0x000a;
#[cfg(feature = "rp2350")]
const PRODUCT: u16 = 0x0009;

/// Bytes of a packet that the endpoints have room for (full speed).
const PACKET: usize = 64;
/// Bytes that are sent in one: a packet that is not full ends a transfer, and the host's driver hands it on at once.
const SENT: usize = PACKET - 1;
/// Offers after which bytes that the host does not take are dropped, as on a wire to which nobody listens: a quarter of a second.
const PATIENCE: u16 = 250;

type Bus = Driver<'static, USB>;

static EXECUTOR: StaticCell<Executor> = StaticCell::new();
static STATE: StaticCell<State<'static>> = StaticCell::new();
static CONFIGURATION: ConstStaticCell<[u8; 128]> = ConstStaticCell::new([0; _]);
static CONTROL: ConstStaticCell<[u8; 64]> = ConstStaticCell::new([0; _]);

/// Wakes the executor: nothing to do, it is polled in every period anyway.
// Safety: the name is the executor's, which asks every program for this function; the image has no other.
#[unsafe(export_name = "__pender")]
fn pender(_: *mut ()) {}

#[embassy_executor::task]
async fn attend(mut device: UsbDevice<'static, Bus>) -> ! {
    device.run().await
}

/// The serial port.
pub struct UsbSerial {
    executor: &'static Executor,
    class: CdcAcmClass<'static, Bus>,
    received: Deque<u8, PACKET>,
    /// Offers in a row that the host did not take.
    refused: u16,
}

impl UsbSerial {
    /// Attaches to the bus. Once: it takes what is there only once.
    pub fn new(driver: Bus, product: &'static str) -> Self {
        let mut config = Config::new(VENDOR, PRODUCT);
        config.manufacturer = Some("servoid");
        config.product = Some(product);
        let (configuration, control) = (CONFIGURATION.take(), CONTROL.take());
        let mut builder = Builder::new(driver, config, configuration, &mut [], &mut [], control);
        let class = CdcAcmClass::new(&mut builder, STATE.init(State::new()), PACKET as u16);
        let executor = EXECUTOR.init(Executor::new(core::ptr::null_mut()));
        let attend = attend(builder.build()).expect("a board is put together once");
        executor.spawner().spawn(attend);
        Self {
            executor,
            class,
            received: Deque::new(),
            refused: 0,
        }
    }

    /// Lets the bus go on, and takes a packet if one has come. A port that is not configured has none.
    fn poll(&mut self) {
        // Safety: an executor must not be polled from within itself. Only this line polls it, which needs the port for itself, and its
        // one task has no way to come by that.
        unsafe { self.executor.poll() };
        let mut packet = [0; PACKET];
        if let Poll::Ready(Ok(length)) = poll_once(self.class.read_packet(&mut packet)) {
            // Empty until here: a packet fits.
            self.received.extend(&packet[..length]);
        }
    }
}

impl Port for UsbSerial {
    fn receive(&mut self) -> Option<u8> {
        if self.received.is_empty() {
            self.poll();
        }
        self.received.pop_front()
    }

    fn send(&mut self, bytes: &[u8]) -> usize {
        if bytes.is_empty() {
            return 0;
        }
        let packet = &bytes[..bytes.len().min(SENT)];
        if let Poll::Ready(Ok(())) = poll_once(self.class.write_packet(packet)) {
            self.refused = 0;
            return packet.len();
        }
        self.refused = (self.refused + 1).min(PATIENCE);
        if self.refused < PATIENCE {
            0
        } else {
            bytes.len()
        }
    }
}
