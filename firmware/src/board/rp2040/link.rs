//! The serial port. Two channels of the DMA carry its bytes: no interrupt, so nothing of the program's to wait for.

use core::sync::atomic::{AtomicU8, Ordering};

use rp_pac::dma::Channel;
use rp_pac::dma::regs::CtrlTrig;
use rp_pac::dma::vals::{DataSize, TreqSel};
use rp_pac::{DMA, UART0};

use crate::board::BAUD;

/// Bytes of which the logarithm is the size of the ring, as the DMA wants it: what comes in two milliseconds, and some.
const RING_BITS: u8 = 8;
const RING: usize = 1 << RING_BITS;
/// Most bytes on their way at a time, so the line rests for less than a millisecond in three.
const SEND: usize = 256;

const TO_RAM: usize = 0;
const TO_LINE: usize = 1;

/// Where the DMA writes to, at a multiple of its size. Atomics, because the DMA writes while the program reads.
#[repr(align(256))]
struct Ring([AtomicU8; RING]);

static RECEIVED: Ring = Ring([const { AtomicU8::new(0) }; RING]);
static SENDING: [AtomicU8; SEND] = [const { AtomicU8::new(0) }; SEND];

/// The serial port, with a buffer each way.
pub struct Link {
    /// Where in the ring the next byte is.
    next: usize,
}

impl Link {
    /// At [`BAUD`], from a clock of so many Hz.
    pub fn start(clock_hz: u32) -> Self {
        // In 64ths, rounded.
        let divider = (8 * clock_hz / BAUD).div_ceil(2);
        UART0
            .uartibrd()
            .write(|w| w.set_baud_divint((divider >> 6) as u16));
        UART0
            .uartfbrd()
            .write(|w| w.set_baud_divfrac((divider & 63) as u8));
        UART0.uartlcr_h().write(|w| {
            w.set_wlen(0b11);
            w.set_fen(true);
        });
        UART0.uartcr().write(|w| {
            w.set_uarten(true);
            w.set_txe(true);
            w.set_rxe(true);
        });
        UART0.uartdmacr().write(|w| {
            w.set_txdmae(true);
            w.set_rxdmae(true);
        });
        let port = UART0.uartdr().as_ptr() as u32;
        let ring = RECEIVED.0.as_ptr() as u32;
        let from_line = channel(TO_RAM, port, ring, |w| {
            w.set_treq_sel(TreqSel::UART0_RX);
            w.set_incr_write(true);
            w.set_ring_sel(true);
            w.set_ring_size(RING_BITS);
        });
        channel(TO_LINE, SENDING.as_ptr() as u32, port, |w| {
            w.set_treq_sel(TreqSel::UART0_TX);
            w.set_incr_read(true);
        });
        from_line.al1_trans_count_trig().write_value(u32::MAX);
        Self { next: 0 }
    }

    /// See [`Board::receive`](crate::board::Board::receive). A byte that came damaged is in it: what frames the bytes finds out.
    pub fn receive(&mut self) -> Option<u8> {
        let channel = DMA.ch(TO_RAM);
        if !channel.ctrl_trig().read().busy() {
            // After half a day of bytes.
            channel.al1_trans_count_trig().write_value(u32::MAX);
        }
        let written = channel.write_addr().read() as usize % RING;
        if written == self.next {
            return None;
        }
        let byte = RECEIVED.0[self.next].load(Ordering::Acquire);
        self.next = (self.next + 1) % RING;
        Some(byte)
    }

    /// See [`Board::send`](crate::board::Board::send): nothing while bytes are on their way, then as many as there is room for.
    pub fn send(&mut self, bytes: &[u8]) -> usize {
        let channel = DMA.ch(TO_LINE);
        if channel.ctrl_trig().read().busy() {
            return 0;
        }
        let mut taken = 0;
        for (slot, &byte) in SENDING.iter().zip(bytes) {
            slot.store(byte, Ordering::Release);
            taken += 1;
        }
        if taken > 0 {
            channel.read_addr().write_value(SENDING.as_ptr() as u32);
            // The bytes are in memory before the DMA hears of them.
            cortex_m::asm::dmb();
            channel.al1_trans_count_trig().write_value(taken);
        }
        taken as usize
    }
}

/// Sets a channel up that carries bytes, and starts nothing.
fn channel(number: usize, from: u32, to: u32, how: impl FnOnce(&mut CtrlTrig)) -> Channel {
    let channel = DMA.ch(number);
    channel.read_addr().write_value(from);
    channel.write_addr().write_value(to);
    let mut control = CtrlTrig(0);
    control.set_en(true);
    control.set_data_size(DataSize::SIZE_BYTE);
    // To itself: to nothing.
    control.set_chain_to(number as u8);
    how(&mut control);
    channel.al1_ctrl().write_value(control.0);
    channel
}
