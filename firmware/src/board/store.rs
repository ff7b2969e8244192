//! What outlives a power cut: one value in a flash, in two copies.
//!
//! ```text
//! page 0   number of the save, length, key, value, CRC-32
//! page 1   the same of the save before
//! ```
//!
//! A save erases the page of the older copy and writes there; the other one is not touched. Whenever the power is cut, one of both is whole:
//! a page that was half erased or half written has another checksum. `sequential-storage` 8.0.2 was tried, which appends values and erases
//! less often: where a cut leaves bits that are neither, it lost both values in one of some hundred erasures, and it does not write to pages
//! that hold anything else. A motor is tuned a few times a year, and a page bears 10,000 erasures.

use core::ops::Range;
use embedded_storage::nor_flash::NorFlash;
use shared::wire::CRC;

/// Longest value, bytes.
pub const LONGEST: usize = 256;
/// Longest time that it takes to save one, s: an STM32F4 erases a sector of 128 KiB in at most 4 s (STM32F405 data sheet, table 42), and the
/// oscillator of its watchdog may be twice as fast as the nominal one.
pub const LONGEST_SAVE_S: u32 = 8;

/// Number, length, key and a byte beside.
const HEAD: usize = 8;
const CHECK: usize = 4;
/// A copy, in whole words of any flash here.
const COPY: usize = (HEAD + LONGEST + CHECK).next_multiple_of(16);

/// Keeps one value.
pub trait Store {
    /// False if it keeps nothing.
    const KEEPS: bool = true;

    /// Writes what was saved last to the front of `into`; its length, or `None` if there is nothing, or it was saved under another key.
    fn load(&mut self, key: u8, into: &mut [u8; LONGEST]) -> Option<usize>;

    /// Saves `value` under a key in place of what was there. It may take [seconds](LONGEST_SAVE_S), in which the core may stand still. Returns
    /// false if it is not saved; then what was there still is.
    fn save(&mut self, key: u8, value: &[u8]) -> bool;
}

/// Forgets all.
#[derive(Debug, Default)]
pub struct NoStore;

impl Store for NoStore {
    const KEEPS: bool = false;

    fn load(&mut self, _key: u8, _into: &mut [u8; LONGEST]) -> Option<usize> {
        None
    }

    fn save(&mut self, _key: u8, _value: &[u8]) -> bool {
        false
    }
}

/// Two pages of a flash that nothing else writes to.
#[derive(Debug)]
pub struct FlashStore<F> {
    flash: F,
    pages: Range<u32>,
}

/// A page's copy, if it is whole.
struct Copy {
    number: u32,
    key: u8,
    bytes: [u8; COPY],
    length: usize,
}

impl Copy {
    fn of(bytes: [u8; COPY]) -> Option<Self> {
        let (head, rest) = bytes.split_first_chunk::<HEAD>()?;
        let [a, b, c, d, low, high, key, _] = *head;
        let length = usize::from(u16::from_le_bytes([low, high]));
        let value = rest.get(..length).filter(|value| value.len() <= LONGEST)?;
        let check = rest.get(length..)?.first_chunk::<CHECK>()?;
        let whole = check_of(head, value) == *check;
        whole.then_some(Copy {
            number: u32::from_le_bytes([a, b, c, d]),
            key,
            bytes,
            length,
        })
    }

    fn value(&self) -> &[u8] {
        self.bytes.get(HEAD..HEAD + self.length).unwrap_or_default()
    }
}

fn check_of(head: &[u8; HEAD], value: &[u8]) -> [u8; CHECK] {
    let mut digest = CRC.digest();
    digest.update(head);
    digest.update(value);
    digest.finalize().to_le_bytes()
}

impl<F: NorFlash> FlashStore<F> {
    /// In the first two pages of `flash` from an address on.
    pub fn new(flash: F, from: u32) -> Self {
        const {
            assert!(F::ERASE_SIZE >= COPY && COPY.is_multiple_of(F::WRITE_SIZE));
            assert!(COPY.is_multiple_of(F::READ_SIZE));
        }
        let pages = from..from + F::ERASE_SIZE as u32;
        Self { flash, pages }
    }

    /// Address of one of both pages.
    fn page(&self, second: bool) -> u32 {
        if second {
            self.pages.end
        } else {
            self.pages.start
        }
    }

    #[inline(never)]
    fn read(&mut self, second: bool) -> Option<Copy> {
        let mut bytes = [0; COPY];
        self.flash.read(self.page(second), &mut bytes).ok()?;
        Copy::of(bytes)
    }

    /// Which page has the last copy, and its number.
    fn last(&mut self) -> Option<(bool, u32)> {
        let [first, second] = [false, true].map(|second| self.read(second).map(|copy| copy.number));
        match (first, second) {
            (None, None) => None,
            (Some(number), None) => Some((false, number)),
            (None, Some(number)) => Some((true, number)),
            (Some(first), Some(second)) => {
                let later = second.wrapping_sub(first) < u32::MAX / 2;
                Some((later, if later { second } else { first }))
            }
        }
    }
}

impl<F: NorFlash> Store for FlashStore<F> {
    #[inline(never)]
    fn load(&mut self, key: u8, into: &mut [u8; LONGEST]) -> Option<usize> {
        let (second, _) = self.last()?;
        let copy = self.read(second).filter(|copy| copy.key == key)?;
        into.get_mut(..copy.length)?.copy_from_slice(copy.value());
        Some(copy.length)
    }

    #[inline(never)]
    fn save(&mut self, key: u8, value: &[u8]) -> bool {
        let last = self.last();
        let number = last.map_or(0, |(_, number)| number.wrapping_add(1));
        let second = last.is_some_and(|(second, _)| !second);
        let Ok(length) = u16::try_from(value.len()) else {
            return false;
        };
        let ([a, b, c, d], [low, high]) = (number.to_le_bytes(), length.to_le_bytes());
        let head = [a, b, c, d, low, high, key, 0xff];
        let mut bytes = [0xff; COPY];
        let parts = [&head[..], value, &check_of(&head, value)];
        let mut to = &mut bytes[..];
        for part in parts {
            let Some((here, rest)) = to.split_at_mut_checked(part.len()) else {
                return false;
            };
            here.copy_from_slice(part);
            to = rest;
        }
        let from = self.page(second);
        let whole = self.flash.erase(from, from + F::ERASE_SIZE as u32).is_ok()
            && self.flash.write(from, &bytes).is_ok();
        // A cell that is worn out takes no bits.
        whole && self.read(second).is_some_and(|copy| copy.value() == value)
    }
}
