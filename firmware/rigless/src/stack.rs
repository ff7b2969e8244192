//! Measures an image's stack: paints memory before the run and inspects it afterwards. Or spoils it.

use rigless::emulator::{Error, Host};
use rigless::soc::Width;

const FLASH: u64 = 0x0800_0000;
const RAM: u64 = 0x2000_0000;
const WORD: u64 = 4;
/// Nothing that a program would write.
const PAINT: u64 = 0xc5a3_c5a3;

/// Paints all RAM below the stack's start, which the first word of the vector table names. The program's variables are
/// there too; it sets them up after this.
pub fn paint(memory: &mut dyn Host) -> Result<(), Error> {
    let top = memory.read(FLASH, Width::W32)?;
    for address in (RAM..top).step_by(WORD as usize) {
        memory.write(address, Width::W32, PAINT)?;
    }
    Ok(())
}

/// Bytes between the stack's start and the lowest word of it that was written. Between the stack and the variables lies
/// the unused part: the longest stretch that is still painted.
pub fn used(memory: &mut dyn Host) -> Result<u64, Error> {
    let top = memory.read(FLASH, Width::W32)?;
    let (mut run, mut longest, mut end) = (0, 0, RAM);
    for address in (RAM..top).step_by(WORD as usize) {
        run = if memory.read(address, Width::W32)? == PAINT {
            run + WORD
        } else {
            0
        };
        if run > longest {
            longest = run;
            end = address + WORD;
        }
    }
    Ok(top - end)
}

/// No memory is there, no instruction may be, and no length is as large.
const NOWHERE: u64 = 0xffff_ffff;
/// Bytes of the stack in which a program that sleeps has its return addresses.
const DEPTH: u64 = 512;

/// Lets all that is on the stack point nowhere.
pub fn spoil(memory: &mut dyn Host) -> Result<(), Error> {
    let top = memory.read(FLASH, Width::W32)?;
    for address in (top - DEPTH..top).step_by(WORD as usize) {
        memory.write(address, Width::W32, NOWHERE)?;
    }
    Ok(())
}
