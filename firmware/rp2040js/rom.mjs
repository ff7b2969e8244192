// What the firmware asks of the RP2040's boot ROM, whose code is not here: where a function is, and those that write the flash. The core
// that gets to one of their addresses finds it done (data sheet, 2.8.3).

// Pointers of the ROM: its tables, which nobody reads here, and the function that looks a code up in one.
const LOOK_UP_AT = 0x18;
const LOOK_UP = 0x100;
const FUNCTIONS = 0x200;
const END = 0x300;
// Longest times of the flash, ns: to erase a sector of 4 KiB, and to write a page of 256 bytes (W25Q16JV, 9.6).
const [SECTOR, ERASING] = [4096, 400e6];
const [PAGE, WRITING] = [256, 3e6];

// Where the emulator would keep the registers of the flash's cache: its address without the last three digits. Nothing streams from the flash.
const CACHE = 0x14000;

export class Rom {
  constructor(mcu, clock) {
    this.mcu = mcu;
    this.clock = clock;
    const nothing = () => {};
    this.functions = {
      IF: nothing,
      EX: nothing,
      FC: nothing,
      CX: nothing,
      C4: (to, from, length) => {
        for (let k = 0; k < length; k += 1) mcu.writeUint8(to + k, mcu.readUint8(from + k));
      },
      RE: (at, length) => {
        mcu.flash.fill(0xff, at, at + length);
        this.wait((length / SECTOR) * ERASING);
      },
      RP: (at, from, length) => {
        for (let k = 0; k < length; k += 1) mcu.flash[at + k] &= mcu.readUint8(from + k);
        this.wait((length / PAGE) * WRITING);
      },
    };
    mcu.bootrom[LOOK_UP_AT >> 2] = LOOK_UP | 1;
    mcu.peripherals[CACHE] = { readUint32: () => 0, writeUint32: nothing, writeUint32Atomic: nothing };
  }

  // The core stands still, and the watchdog does not.
  wait(ns) {
    this.clock.tick(ns);
  }

  // True if the core was in the ROM, and is back.
  ran(core) {
    const at = core.PC;
    if (at < LOOK_UP || at >= END) return false;
    const [a, b, c] = core.registers;
    const codes = Object.keys(this.functions);
    if (at === LOOK_UP) {
      const code = String.fromCharCode(b & 0xff, b >> 8);
      if (!codes.includes(code)) throw new Error(`the program asks the boot ROM for ${code}`);
      core.registers[0] = (FUNCTIONS + 4 * codes.indexOf(code)) | 1;
    } else {
      this.functions[codes[(at - FUNCTIONS) >> 2]](a, b, c);
    }
    core.PC = core.LR & ~1;
    return true;
  }
}
