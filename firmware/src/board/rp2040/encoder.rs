//! Counts every edge of both lines of the encoder, in a state machine of the chip's PIO that does nothing else.

use rp_pac::PIO0;

/// Which state machine.
const MACHINE: usize = 0;

/// What a state machine does next, as far as it is asked here (RP2040 data sheet, 3.4).
#[expect(
    clippy::unusual_byte_groupings,
    reason = "grouped by the fields of the data sheet"
)]
mod instruction {
    /// To another place.
    pub const fn jump(to: usize) -> u16 {
        to as u16
    }
    /// There unless Y was zero; either way Y is one less.
    pub const fn jump_y_less(to: usize) -> u16 {
        0b000_00000_100_00000 | to as u16
    }
    pub const MOV_ISR_Y: u16 = 0b101_00000_110_00_010;
    pub const PUSH_NOBLOCK: u16 = 0b100_00000_0_0_0_00000;
    pub const OUT_ISR_2: u16 = 0b011_00000_110_00010;
    pub const IN_PINS_2: u16 = 0b010_00000_000_00010;
    pub const MOV_OSR_ISR: u16 = 0b101_00000_111_00_110;
    pub const MOV_PC_ISR: u16 = 0b101_00000_101_00_110;
    pub const MOV_Y_NOT_Y: u16 = 0b101_00000_010_01_010;
}

const DOWN: usize = 16;
const TELL: usize = 17;
const UP: usize = 23;
const END: usize = 25;

/// The state machine keeps the count in Y and pushes it again and again, ten million times a second; what finds no room is
/// lost. The lines before and after an edge, two bits each, are the address of what to do about it.
#[rustfmt::skip]
const PROGRAM: [u16; END + 1] = {
    use instruction::*;
    [
        jump(TELL), // 00 stays
        jump(UP),   // 00 to 01: A rises while B is low
        jump(DOWN), // 00 to 10
        jump(TELL), // 00 to 11: two edges at once, which way is unknown
        jump(DOWN), // 01 to 00
        jump(TELL), // 01 stays
        jump(TELL), // 01 to 10
        jump(UP),   // 01 to 11
        jump(UP),   // 10 to 00
        jump(TELL), // 10 to 01
        jump(TELL), // 10 stays
        jump(DOWN), // 10 to 11
        jump(TELL), // 11 to 00
        jump(DOWN), // 11 to 01
        jump(UP),   // 11 to 10
        jump(TELL), // 11 stays
        // DOWN
        jump_y_less(TELL),
        // TELL
        MOV_ISR_Y,
        PUSH_NOBLOCK,
        OUT_ISR_2,  // the lines as they were
        IN_PINS_2,  // and as they are
        MOV_OSR_ISR,
        MOV_PC_ISR,
        // UP: y + 1 is not(not(y) - 1)
        MOV_Y_NOT_Y,
        jump_y_less(END),
        // END, from where it goes on at TELL
        MOV_Y_NOT_Y,
    ]
};

/// The encoder.
pub struct Encoder {
    last: i32,
}

impl Encoder {
    /// Of the lines at a pin and the one after it.
    pub fn start(pin: u8) -> Self {
        for (at, &instruction) in PROGRAM.iter().enumerate() {
            PIO0.instr_mem(at).write(|w| w.set_instr_mem(instruction));
        }
        let machine = PIO0.sm(MACHINE);
        // At the core's own speed, which is what it has after a reset.
        machine.execctrl().write(|w| {
            w.set_wrap_bottom(TELL as u8);
            w.set_wrap_top(END as u8);
        });
        machine.shiftctrl().write(|w| {
            w.set_fjoin_rx(true);
            w.set_out_shiftdir(true);
        });
        machine.pinctrl().write(|w| w.set_in_base(pin));
        PIO0.ctrl().write(|w| w.set_sm_enable(1 << MACHINE));
        Self { last: 0 }
    }

    /// The count as it is now: what waits in the queue is older, so the one after that is it. It comes within a tenth of a
    /// microsecond.
    pub fn count(&mut self) -> i32 {
        let mut older = u32::from(PIO0.flevel().read().rx0());
        for _ in 0..100 {
            if PIO0.flevel().read().rx0() > 0 {
                self.last = PIO0.rxf(MACHINE).read().cast_signed();
                if older == 0 {
                    break;
                }
                older -= 1;
            }
        }
        self.last
    }
}
