//! Bytes on their way to the host.

use heapless::Deque;
use shared::wire::{LONGEST_FRAME, ToHost, encode};

/// Bytes that wait; a few frames.
const ROOM: usize = 1024;

/// A queue of whole frames.
#[derive(Debug)]
pub struct Outbox {
    bytes: Deque<u8, ROOM>,
}

impl Outbox {
    /// Empty.
    pub const fn new() -> Self {
        Outbox {
            bytes: Deque::new(),
        }
    }

    /// True if nothing waits.
    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    /// Queues a message as a whole, or drops it if there is no room: the host asks again for what it misses.
    pub fn post(&mut self, message: &ToHost) {
        let mut buffer = [0; LONGEST_FRAME];
        let Some(frame) = encode(message, &mut buffer) else {
            return;
        };
        if self.bytes.capacity() - self.bytes.len() >= frame.len() {
            for &byte in frame {
                let _ = self.bytes.push_back(byte);
            }
        }
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
