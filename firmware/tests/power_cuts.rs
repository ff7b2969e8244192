//! Whenever the power is cut while a value is saved, the old value or the new one is there afterwards, and saving goes on.

use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash, check_erase, check_read,
    check_write,
};
use firmware::board::store::{FlashStore, LONGEST, Store};
use shared::rng::{self, Rng};

/// As an STM32F4's: words, and pages small enough that many are erased.
const WORD: usize = 4;
const PAGE: usize = 2048;

/// A flash of two pages whose power fails after so many operations, in the middle of one.
struct Flash<'c> {
    cells: &'c mut [u8],
    left: u32,
    noise: rng::Generator,
}

#[derive(Debug)]
struct Dark;

impl NorFlashError for Dark {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

impl ErrorType for Flash<'_> {
    type Error = Dark;
}

impl Flash<'_> {
    /// Whether the power fails in this operation. Without power nothing happens any more.
    fn fails(&mut self) -> Result<bool, Dark> {
        self.left = self.left.checked_sub(1).ok_or(Dark)?;
        Ok(self.left == 0)
    }
}

impl ReadNorFlash for Flash<'_> {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Dark> {
        check_read(self, offset, bytes.len()).expect("it reads its own");
        if self.left == 0 {
            return Err(Dark);
        }
        let from = offset as usize;
        bytes.copy_from_slice(&self.cells[from..from + bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.cells.len()
    }
}

impl NorFlash for Flash<'_> {
    const WRITE_SIZE: usize = WORD;
    const ERASE_SIZE: usize = PAGE;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Dark> {
        check_erase(self, from, to).expect("whole pages");
        for page in (from..to).step_by(PAGE) {
            let fails = self.fails()?;
            let cells = &mut self.cells[page as usize..page as usize + PAGE];
            if !fails {
                cells.fill(0xff);
                continue;
            }
            // Bits rise one by one: some have, some have not.
            for cell in cells {
                *cell |= self.noise.next_u32() as u8;
            }
            return Err(Dark);
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Dark> {
        check_write(self, offset, bytes.len()).expect("whole words");
        for (k, word) in bytes.chunks(WORD).enumerate() {
            let fails = self.fails()?;
            let from = offset as usize + k * WORD;
            for (cell, byte) in self.cells[from..from + WORD].iter_mut().zip(word) {
                let unsure = if fails {
                    self.noise.next_u32() as u8
                } else {
                    0
                };
                *cell &= byte | unsure;
            }
            if fails {
                return Err(Dark);
            }
        }
        Ok(())
    }
}

fn store<'c>(cells: &'c mut [u8], left: u32, seed: u64) -> FlashStore<Flash<'c>> {
    let noise = rng::seeded(seed);
    FlashStore::new(Flash { cells, left, noise }, 0)
}

const KEY: u8 = 1;

fn load(cells: &mut [u8]) -> Option<Vec<u8>> {
    let mut into = [0; LONGEST];
    let length = store(cells, u32::MAX, 0).load(KEY, &mut into)?;
    Some(into[..length].to_vec())
}

/// A value that no other is.
fn value(number: u32, rng: &mut rng::Generator) -> Vec<u8> {
    let length = 180 + rng::below(rng, 60) as usize;
    let mut value = number.to_le_bytes().to_vec();
    value.resize_with(length, || rng.next_u32() as u8);
    value
}

#[test]
fn a_power_cut_leaves_the_old_value_or_the_new_one() {
    let cuts = testing::length::cases(20_000, 1_000) as u32;
    let seed = 44;
    let mut rng = rng::seeded(seed);
    let mut cells = vec![0xff; 2 * PAGE];
    let mut before = value(0, &mut rng);
    assert!(store(&mut cells, u32::MAX, 0).save(KEY, &before));
    let (mut old, mut new, mut erased) = (0, 0, 0);
    for cut in 1..=cuts {
        let next = value(cut, &mut rng);
        // A save erases a page and writes 68 words.
        let left = 1 + rng::below(&mut rng, 80);
        let noise = u64::from(rng.next_u32());
        let saved = store(&mut cells, left, noise).save(KEY, &next);
        let now = load(&mut cells);
        match now {
            Some(now) if now == next => new += 1,
            Some(now) if now == before && !saved => old += 1,
            now => panic!(
                "seed {seed}, cut {cut} after {left} operations: {:?} for {} or {}",
                now.map(|now| now.len()),
                before.len(),
                next.len()
            ),
        }
        before = load(&mut cells).expect("it was there");
        // And now and then all goes well.
        if rng::below(&mut rng, 4) == 0 {
            let next = value(cut + cuts, &mut rng);
            let from = cells.clone();
            assert!(
                store(&mut cells, u32::MAX, 0).save(KEY, &next),
                "seed {seed}, after cut {cut}"
            );
            assert_eq!(
                load(&mut cells).as_ref(),
                Some(&next),
                "seed {seed}, after cut {cut}"
            );
            erased += u32::from(from.iter().zip(&cells).any(|(from, to)| to & !from != 0));
            before = next;
        }
    }
    println!(
        "{cuts} cuts: {old} left the old value, {new} the new one; {erased} whole saves erased a page"
    );
    assert!(old > cuts / 10 && new > cuts / 10 && erased > 10);
}

#[test]
fn what_is_not_a_store_holds_nothing_and_becomes_one() {
    for seed in 0..100 {
        let mut rng = rng::seeded(seed);
        let mut cells: Vec<u8> = (0..2 * PAGE).map(|_| rng.next_u32() as u8).collect();
        assert_eq!(load(&mut cells), None, "seed {seed}");
        let value = value(1, &mut rng);
        assert!(
            store(&mut cells, u32::MAX, 0).save(KEY, &value),
            "seed {seed}"
        );
        assert_eq!(load(&mut cells), Some(value), "seed {seed}");
    }
}
