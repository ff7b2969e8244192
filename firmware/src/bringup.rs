//! The first program on a new board: the bridge stays open and the position is printed, until somebody presses a key.
//!
//! It needs a terminal and no host program. It says what made the board start (`reset: power-up`). Every 100 ms it prints a
//! line such as
//!
//! ```text
//! count -1204 current 250 mA duty 512 ok
//! ```
//!
//! `+` and `-` change the duty by a 64th of the supply, at most to a quarter, and drive with it for half a second;
//! any other key opens the bridge, and `r` also has it say again what made the board start. Without keys the motor coasts. After a fault it coasts, and keys do nothing until the
//! fault has been printed.

use core::fmt::{self, Write};

use crate::board::Board;
use crate::phase::Fault;

/// The whole supply, in the unit of the printed duty.
const FULL: i32 = 32_768;
/// Change of the duty per key press.
const STEP: i16 = 512;
/// The largest duty, either way.
const LIMIT: i16 = 8192;
/// Drive time per key press, ms.
const HOLD_MS: u32 = 500;
/// Time between two lines, ms.
const LINE_MS: u32 = 100;

/// A board that is driven by keys.
#[derive(Debug)]
pub struct Bringup<B> {
    board: B,
    duty: i16,
    /// Periods for which the bridge is still driven.
    left: u32,
    until_line: u32,
    fault: Option<Fault>,
    /// Set once the fault has been printed.
    reported: bool,
    line: Line,
}

impl<B: Board> Bringup<B> {
    const HOLD: u32 = HOLD_MS * 1000 / B::PERIOD_US;
    const LINE: u32 = LINE_MS * 1000 / B::PERIOD_US;

    /// Takes the board over and opens its bridge.
    pub fn new(mut board: B) -> Self {
        board.coast();
        let mut bringup = Self {
            board,
            duty: 0,
            left: 0,
            until_line: Self::LINE,
            fault: None,
            reported: false,
            line: Line::default(),
        };
        bringup.introduce();
        bringup
    }

    /// Says what made the board start.
    fn introduce(&mut self) {
        self.line = Line::default();
        let _ = write!(self.line, "reset: {}\r\n", self.board.reset());
    }

    /// One control period.
    pub fn period(&mut self) {
        while let Some(key) = self.board.receive() {
            self.press(key);
        }
        if self.left > 0 {
            self.left -= 1;
            let duty = i32::from(self.duty) * i32::from(self.board.full()) / FULL;
            self.board.drive(duty as i16);
        } else {
            self.coast();
        }
        if let Err(fault) = self.board.tick() {
            self.fault = Some(fault);
            self.reported = false;
            self.coast();
        }
        let count = self.board.count();
        self.until_line -= 1;
        if self.until_line == 0 {
            self.until_line = Self::LINE;
            self.print(count);
        }
        let sent = self.board.send(self.line.rest());
        self.line.sent += sent;
    }

    fn press(&mut self, key: u8) {
        if self.fault.is_some() && !self.reported {
            // The user has not seen the fault yet.
            return;
        }
        self.fault = None;
        self.left = Self::HOLD;
        match key {
            b'+' => self.duty = (self.duty + STEP).min(LIMIT),
            b'-' => self.duty = (self.duty - STEP).max(-LIMIT),
            key => {
                self.coast();
                if key == b'r' {
                    self.introduce();
                }
            }
        }
    }

    fn coast(&mut self) {
        self.board.coast();
        self.duty = 0;
        self.left = 0;
    }

    fn print(&mut self, count: i32) {
        self.reported = true;
        let current = self.board.current_ma();
        self.line = Line::default();
        // A line that does not fit is cut: its longest form has room.
        let _ = write!(
            self.line,
            "count {count} current {current} mA duty {} {}\r\n",
            self.duty,
            match self.fault {
                None => "ok",
                Some(Fault::Overrun) => "OVERRUN",
                Some(_) => "BRIDGE FAULT",
            }
        );
    }
}

/// A line of text, sent piece by piece.
#[derive(Debug)]
struct Line {
    text: [u8; 80],
    len: usize,
    sent: usize,
}

impl Default for Line {
    fn default() -> Self {
        Self {
            text: [0; 80],
            len: 0,
            sent: 0,
        }
    }
}

impl Line {
    fn rest(&self) -> &[u8] {
        &self.text[self.sent..self.len]
    }
}

impl Write for Line {
    fn write_str(&mut self, s: &str) -> fmt::Result {
        let room = &mut self.text[self.len..];
        let fits = s.len().min(room.len());
        room[..fits].copy_from_slice(&s.as_bytes()[..fits]);
        self.len += fits;
        if fits == s.len() {
            Ok(())
        } else {
            Err(fmt::Error)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::VecDeque;

    /// A motor without inertia whose link takes seven bytes a period.
    #[derive(Default)]
    struct Toy {
        duty: Option<i16>,
        count: i32,
        keys: VecDeque<u8>,
        text: Vec<u8>,
        fails: bool,
    }

    impl Board for Toy {
        const NAME: &'static str = "toy";
        const PERIOD_US: u32 = 1000;
        const SLICE: u32 = 1000;

        fn drive(&mut self, duty: i16) {
            self.duty = Some(duty);
        }

        fn coast(&mut self) {
            self.duty = None;
        }

        fn count(&mut self) -> i32 {
            self.count += i32::from(self.duty.unwrap_or(0)) / 512;
            self.count
        }

        fn tick(&mut self) -> Result<(), Fault> {
            if self.fails && self.duty.is_some() {
                return Err(Fault::Bridge);
            }
            Ok(())
        }

        fn receive(&mut self) -> Option<u8> {
            self.keys.pop_front()
        }

        fn send(&mut self, bytes: &[u8]) -> usize {
            let taken = bytes.len().min(7);
            self.text.extend_from_slice(&bytes[..taken]);
            taken
        }

        fn entropy(&mut self) -> u32 {
            0
        }
    }

    fn run(bringup: &mut Bringup<Toy>, keys: &str, periods: u32) {
        bringup.board.keys.extend(keys.bytes());
        for _ in 0..periods {
            bringup.period();
        }
    }

    #[test]
    fn a_key_drives_for_half_a_second_and_then_the_motor_coasts() {
        let mut bringup = Bringup::new(Toy::default());
        run(&mut bringup, "", 100);
        assert_eq!((bringup.board.duty, bringup.board.count), (None, 0));
        run(&mut bringup, "++", 500);
        assert_eq!(bringup.board.duty, Some(2 * STEP));
        run(&mut bringup, "", 1);
        assert_eq!(bringup.board.duty, None);
        assert_eq!(bringup.board.count, 2 * 500);
        run(&mut bringup, "-", 10);
        assert_eq!(bringup.board.duty, Some(-STEP));
        run(&mut bringup, " ", 1);
        assert_eq!(bringup.board.duty, None);
    }

    #[test]
    fn it_says_what_made_the_board_start_at_first_and_when_asked() {
        let mut bringup = Bringup::new(Toy::default());
        run(&mut bringup, "", 10);
        run(&mut bringup, "+r", 10);
        assert_eq!(bringup.board.duty, None);
        assert_eq!(bringup.board.text, b"reset: unknown\r\n".repeat(2));
    }

    #[test]
    fn however_many_keys_come_the_duty_stays_within_a_quarter() {
        let mut bringup = Bringup::new(Toy::default());
        run(&mut bringup, &"+".repeat(1000), 1);
        assert_eq!(bringup.board.duty, Some(LIMIT));
        run(&mut bringup, &"-".repeat(1000), 1);
        assert_eq!(bringup.board.duty, Some(-LIMIT));
    }

    #[test]
    fn a_fault_opens_the_bridge_at_once_and_is_printed_until_the_next_key() {
        let mut bringup = Bringup::new(Toy {
            fails: true,
            ..Toy::default()
        });
        run(&mut bringup, "+", 1);
        assert_eq!(bringup.board.duty, None);
        run(&mut bringup, &"+".repeat(90), 90);
        assert_eq!(
            bringup.board.duty, None,
            "nobody has been told of the fault"
        );
        run(&mut bringup, "", 50);
        let text = String::from_utf8(bringup.board.text.clone()).unwrap();
        let last = text.lines().last().unwrap();
        assert_eq!(last, "count 0 current 0 mA duty 0 BRIDGE FAULT");
    }

    #[test]
    fn the_longest_line_fits() {
        let mut bringup = Bringup::new(Toy::default());
        bringup.fault = Some(Fault::Bridge);
        bringup.duty = -LIMIT;
        bringup.print(i32::MIN);
        assert!(bringup.line.rest().ends_with(b"FAULT\r\n"));
        assert!(bringup.line.len + 10 < bringup.line.text.len());
    }
}
