//! The bytes of a message of ROS, taken from its front.

/// What is left of a message.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cdr<'m> {
    bytes: &'m [u8],
    at: usize,
    is_big: bool,
    is_aligned: bool,
}

impl<'m> Cdr<'m> {
    /// A message of ROS 2, whose first bytes say its byte order; `None` where they say another encoding than plain CDR.
    pub(super) fn ros2(message: &'m [u8]) -> Option<Self> {
        let (&[_, kind, ..], bytes) = message.split_first_chunk::<4>()?;
        (kind <= 1).then_some(Cdr {
            bytes,
            at: 0,
            is_big: kind == 0,
            is_aligned: true,
        })
    }

    /// A message of ROS 1: little-endian, without gaps.
    pub(super) fn ros1(message: &'m [u8]) -> Self {
        Cdr {
            bytes: message,
            at: 0,
            is_big: false,
            is_aligned: false,
        }
    }

    /// Bytes that are left.
    pub(super) fn left(&self) -> usize {
        self.bytes.len().saturating_sub(self.at)
    }

    /// The next number of `N` bytes, in little-endian order.
    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.align(N);
        let mut bytes = *self.bytes.get(self.at..)?.first_chunk::<N>()?;
        self.at = self.at.checked_add(N)?;
        if self.is_big {
            bytes.reverse();
        }
        Some(bytes)
    }

    /// Numbers lie at multiples of their size.
    fn align(&mut self, size: usize) {
        if self.is_aligned {
            self.at = self.at.next_multiple_of(size.max(1));
        }
    }

    /// Leaves out `count` numbers of `size` bytes.
    pub(super) fn skip(&mut self, count: usize, size: usize) -> Option<()> {
        if count > 0 {
            self.align(size);
            self.at = self.at.checked_add(count.checked_mul(size)?)?;
        }
        (self.at <= self.bytes.len()).then_some(())
    }

    pub(super) fn u8(&mut self) -> Option<u8> {
        self.array().map(u8::from_le_bytes)
    }

    pub(super) fn i8(&mut self) -> Option<i8> {
        self.array().map(i8::from_le_bytes)
    }

    pub(super) fn u16(&mut self) -> Option<u16> {
        self.array().map(u16::from_le_bytes)
    }

    pub(super) fn i16(&mut self) -> Option<i16> {
        self.array().map(i16::from_le_bytes)
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub(super) fn i32(&mut self) -> Option<i32> {
        self.array().map(i32::from_le_bytes)
    }

    pub(super) fn u64(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }

    pub(super) fn i64(&mut self) -> Option<i64> {
        self.array().map(i64::from_le_bytes)
    }

    pub(super) fn f32(&mut self) -> Option<f32> {
        self.array().map(f32::from_le_bytes)
    }

    pub(super) fn f64(&mut self) -> Option<f64> {
        self.array().map(f64::from_le_bytes)
    }

    /// The length of a list, which cannot have more elements than there are bytes.
    pub(super) fn length(&mut self) -> Option<usize> {
        let length = usize::try_from(self.u32()?).ok()?;
        (length <= self.left()).then_some(length)
    }

    /// A text, without the zero that ends it in ROS 2.
    pub(super) fn text(&mut self) -> Option<&'m [u8]> {
        let length = self.length()?;
        let text = self.bytes.get(self.at..self.at.checked_add(length)?)?;
        self.at = self.at.checked_add(length)?;
        match text.split_last() {
            Some((0, text)) if self.is_aligned => Some(text),
            _ => Some(text),
        }
    }
}
