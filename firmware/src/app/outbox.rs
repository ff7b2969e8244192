//! Bytes on their way to the host.

use heapless::Deque;
use shared::wire::{LONGEST_FRAME, ToHost, encode};

/// Bytes that wait; a few frames.
const ROOM: usize = 1024;

/// A queue of whole frames.
#[derive(Debug)]
pub struct Outbox {
    bytes: Deque<u8, ROOM>,
    refused: u32,
}

impl Outbox {
    /// Empty.
    pub const fn new() -> Self {
        Outbox {
            bytes: Deque::new(),
            refused: 0,
        }
    }

    /// Queues a message as a whole; says whether there was room.
    pub fn post(&mut self, message: &ToHost) -> bool {
        let mut buffer = [0; LONGEST_FRAME];
        let Some(frame) = encode(message, &mut buffer) else {
            self.refused = self.refused.saturating_add(1);
            return false;
        };
        if self.bytes.capacity() - self.bytes.len() < frame.len() {
            self.refused = self.refused.saturating_add(1);
            return false;
        }
        for &byte in frame {
            let _ = self.bytes.push_back(byte);
        }
        true
    }

    /// Offers what waits to `send`, which says how much it took.
    pub fn flush(&mut self, mut send: impl FnMut(&[u8]) -> usize) {
        loop {
            let front = self.bytes.as_slices().0;
            if front.is_empty() {
                return;
            }
            let taken = send(front).min(front.len());
            if taken == 0 {
                return;
            }
            for _ in 0..taken {
                self.bytes.pop_front();
            }
        }
    }
}
