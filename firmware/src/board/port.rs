//! Where the bytes of the link come and go.

/// A stream of bytes each way that never waits.
pub trait Port {
    /// See [`Board::receive`](super::Board::receive).
    fn receive(&mut self) -> Option<u8>;

    /// See [`Board::send`](super::Board::send).
    fn send(&mut self, bytes: &[u8]) -> usize;
}

/// Two ports of a board: whoever spoke last is answered, and until somebody has spoken both hear what there is to say.
#[derive(Debug)]
pub struct EitherPort<A, B> {
    a: A,
    b: B,
    last: Option<Last>,
}

/// The port that was heard last.
#[derive(Debug)]
enum Last {
    A,
    B,
}

impl<A, B> EitherPort<A, B> {
    /// Of `a`, which drops what nobody takes sooner or later, and `b`, whose bytes go out on a wire.
    pub fn new(a: A, b: B) -> Self {
        Self { a, b, last: None }
    }
}

impl<A: Port, B: Port> Port for EitherPort<A, B> {
    /// Both are asked, so that neither one's bus stands still.
    fn receive(&mut self) -> Option<u8> {
        if let Some(byte) = self.a.receive() {
            self.last = Some(Last::A);
            return Some(byte);
        }
        let byte = self.b.receive()?;
        self.last = Some(Last::B);
        Some(byte)
    }

    fn send(&mut self, bytes: &[u8]) -> usize {
        match self.last {
            Some(Last::A) => self.a.send(bytes),
            Some(Last::B) => self.b.send(bytes),
            // The wire sets the pace: the other one misses what it cannot take at once.
            None => {
                let taken = self.b.send(bytes);
                self.a.send(&bytes[..taken]);
                taken
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::VecDeque;

    #[derive(Default)]
    struct Loopback {
        received: VecDeque<u8>,
        sent: Vec<u8>,
    }

    impl Port for Loopback {
        fn receive(&mut self) -> Option<u8> {
            self.received.pop_front()
        }

        fn send(&mut self, bytes: &[u8]) -> usize {
            self.sent.extend(bytes);
            bytes.len()
        }
    }

    #[test]
    fn whoever_spoke_last_is_answered() {
        let mut ports = EitherPort::new(Loopback::default(), Loopback::default());
        ports.send(b"hello");
        ports.b.received.extend(b"b");
        assert_eq!(ports.receive(), Some(b'b'));
        assert_eq!(ports.receive(), None);
        ports.send(b"to b");
        ports.a.received.extend(b"a");
        assert_eq!(ports.receive(), Some(b'a'));
        ports.send(b"!");
        assert_eq!(ports.a.sent, b"hello!");
        assert_eq!(ports.b.sent, b"helloto b");
    }
}
