//! Counts every edge of both lines of the encoder, in a state machine of the chip's PIO that does nothing else.

use embassy_rp::gpio::Pull;
use embassy_rp::peripherals::PIO0;
use embassy_rp::pio::program::pio_asm;
use embassy_rp::pio::{self, Direction, FifoJoin, ShiftDirection, StateMachine};

use crate::board::generic::Position;

/// The encoder.
pub struct Encoder {
    machine: StateMachine<'static, PIO0, 0>,
    last: i32,
}

impl Encoder {
    /// The state machine keeps the count in Y and pushes it again and again, ten million times a second; what finds no
    /// room is lost. The lines before and after an edge, two bits each, are the address of what to do about it.
    pub fn new(
        common: &mut pio::Common<'static, PIO0>,
        mut machine: StateMachine<'static, PIO0, 0>,
        mut lines: [pio::Pin<'static, PIO0>; 2],
    ) -> Self {
        let program = pio_asm!(
            ".origin 0",
            "jmp post", // 00 stays
            "jmp up",   // 00 to 01: A rises while B is low
            "jmp down", // 00 to 10
            "jmp post", // 00 to 11: two edges at once, which way is unknown
            "jmp down", // 01 to 00
            "jmp post", // 01 stays
            "jmp post", // 01 to 10
            "jmp up",   // 01 to 11
            "jmp up",   // 10 to 00
            "jmp post", // 10 to 01
            "jmp post", // 10 stays
            "jmp down", // 10 to 11
            "jmp post", // 11 to 00
            "jmp down", // 11 to 01
            "jmp up",   // 11 to 10
            "jmp post", // 11 stays
            "down:",
            "jmp y-- post",
            ".wrap_target",
            "post:",
            "mov isr, y",
            "push noblock",
            "out isr, 2", // the lines as they were
            "in pins, 2", // and as they are
            "mov osr, isr",
            "mov pc, isr",
            "up:", // y + 1 is not(not(y) - 1)
            "mov y, ~y",
            "jmp y-- end",
            "end:",
            "mov y, ~y",
            ".wrap",
        );
        for line in &mut lines {
            line.set_pull(Pull::Up);
        }
        let [a, b] = &lines;
        machine.set_pin_dirs(Direction::In, &[a, b]);
        let mut config = pio::Config::default();
        config.set_in_pins(&[a, b]);
        config.fifo_join = FifoJoin::RxOnly;
        config.shift_in.direction = ShiftDirection::Left;
        config.shift_out.direction = ShiftDirection::Right;
        config.use_program(&common.load_program(&program.program), &[]);
        machine.set_config(&config);
        machine.set_enable(true);
        Self { machine, last: 0 }
    }
}

impl Position for Encoder {
    /// The count as it is now: what waits in the queue is older, so that is thrown away first.
    fn count(&mut self) -> i32 {
        let queue = self.machine.rx();
        for _ in 0..queue.level() {
            queue.try_pull();
        }
        // The next one comes within a tenth of a microsecond.
        for _ in 0..100 {
            if let Some(count) = queue.try_pull() {
                self.last = count.cast_signed();
                break;
            }
        }
        self.last
    }
}
