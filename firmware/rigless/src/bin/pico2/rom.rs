//! What the firmware asks of the RP2350's boot ROM, whose code is not here: where a function is, and those that write the flash. A core that
//! gets to one of their addresses finds it done (data sheet, 5.4 and 5.5).

use rp2350_emu::Emulator;

use crate::chip::HZ;

/// Where the ROM has the pointer to the function that looks a code up.
const LOOK_UP_AT: usize = 0x16;
const LOOK_UP: u32 = 0x100;
const FUNCTIONS: u32 = 0x200;
/// Connect the flash, leave its fast mode, erase, write, flush the cache, and enter the fast mode.
const CODES: [[u8; 2]; 6] = [*b"IF", *b"EX", *b"RE", *b"RP", *b"FC", *b"CX"];
const ERASE: u32 = 2;
const WRITE: u32 = 3;
/// Version 2 of the ROM.
const VERSION_AT: usize = 0x13;

/// Longest times of the flash, s: to erase a sector of 4 KiB, and to write a page of 256 bytes (W25Q32JV, 9.6).
const ERASING: f64 = 0.4 / 4096.0;
const WRITING: f64 = 3e-3 / 256.0;

/// The ROM as far as it is data.
pub fn image() -> [u8; 0x20] {
    let mut rom = [0; 0x20];
    rom[VERSION_AT] = 2;
    rom[LOOK_UP_AT..LOOK_UP_AT + 2].copy_from_slice(&(LOOK_UP as u16 | 1).to_le_bytes());
    rom
}

/// Whether the core is about to run the ROM.
pub fn is_at(pc: u32) -> bool {
    (LOOK_UP..FUNCTIONS + 4 * CODES.len() as u32).contains(&(pc & !1))
}

/// Does what the ROM does; gives the cycles that it takes.
pub fn run(emulator: &mut Emulator, flash: &mut [u8]) -> u64 {
    let core = &mut emulator.cores.expect_arm_mut()[0];
    let [a, b, c] = [core.regs.r[0], core.regs.r[1], core.regs.r[2]];
    let at = core.regs.r[15] & !1;
    core.regs.r[15] = core.regs.r[14] & !1;
    if at == LOOK_UP {
        let code = (a as u16).to_le_bytes();
        let known = CODES.iter().position(|known| *known == code);
        let index = known.unwrap_or_else(|| panic!("the program asks the boot ROM for {code:?}"));
        core.regs.r[0] = (FUNCTIONS + 4 * index as u32) | 1;
        return 0;
    }
    let seconds = match (at - FUNCTIONS) / 4 {
        ERASE => {
            flash[a as usize..][..b as usize].fill(0xff);
            f64::from(b) * ERASING
        }
        WRITE => {
            for (k, cell) in flash[a as usize..][..c as usize].iter_mut().enumerate() {
                *cell &= emulator.bus.read8(b + k as u32, 0);
            }
            f64::from(c) * WRITING
        }
        _ => return 0,
    };
    emulator.load_flash(flash);
    (seconds * HZ) as u64
}
