//! The application: a board, the phase it is in, and one control period after another.
//!
//! It holds the invariant that the rest relies on: the bridge drives only while the phase allows it, and it is open when
//! the call returns that leaves such a phase, not a period later.

use crate::board::Board;
use crate::phase::{Bridge, Event, Fault, Phase, Refused};

/// A board that is taken through the phases.
#[derive(Debug)]
pub struct App<B> {
    board: B,
    phase: Phase,
}

impl<B: Board> App<B> {
    /// Takes the board over, opens its bridge and waits in [`Phase::Idle`].
    pub fn new(mut board: B) -> Self {
        board.coast();
        Self {
            board,
            phase: Phase::Idle,
        }
    }

    /// The phase that the device is in.
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// Goes to the phase that follows when `event` happens.
    ///
    /// # Errors
    ///
    /// [`Refused`] if the event has no meaning now; phase and bridge stay as they were.
    pub fn handle(&mut self, event: Event) -> Result<(), Refused> {
        self.enter(self.phase.after(event)?);
        Ok(())
    }

    /// Gives up because of `fault`: opens the bridge, and has the fault to report.
    pub fn fail(&mut self, fault: Fault) {
        self.enter(self.phase.failed(fault));
    }

    /// One control period: `duty` during it (Q15 of the supply, see [`Board::drive`]), the encoder's position in counts
    /// at its end. In a phase that does not drive, the bridge stays open whatever the duty.
    ///
    /// A fault of the board ends the run as [`fail`](Self::fail) does; [`phase`](Self::phase) tells.
    pub fn period(&mut self, duty: i16) -> i32 {
        if self.phase.bridge() == Bridge::Driven {
            self.board.drive(duty);
        }
        if let Err(fault) = self.board.tick() {
            self.fail(fault);
        }
        self.board.count()
    }

    fn enter(&mut self, phase: Phase) {
        if phase.bridge() == Bridge::Open {
            self.board.coast();
        }
        self.phase = phase;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DUTY: i16 = 16_384;
    const PERIODS_PER_PHASE: u32 = 5;

    /// A motor without inertia, on a board that can be told to fail at a chosen period.
    #[derive(Default)]
    struct Toy {
        duty: Option<i16>,
        count: i32,
        periods: u32,
        fails: Option<(u32, Fault)>,
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
            self.count
        }

        fn tick(&mut self) -> Result<(), Fault> {
            self.count = self
                .count
                .wrapping_add(i32::from(self.duty.unwrap_or(0)) / 1024);
            self.periods += 1;
            match self.fails {
                Some((period, fault)) if period == self.periods => Err(fault),
                _ => Ok(()),
            }
        }

        fn receive(&mut self) -> Option<u8> {
            None
        }

        fn send(&mut self, bytes: &[u8]) -> usize {
            bytes.len()
        }

        fn entropy(&mut self) -> u32 {
            0
        }
    }

    /// Runs from the start until there is something to report, and returns what it is. After every call the bridge may
    /// be driven only in a phase that drives.
    fn run(app: &mut App<Toy>) -> Result<(), Fault> {
        app.handle(Event::Start).expect("the device is idle");
        loop {
            for _ in 0..PERIODS_PER_PHASE {
                app.period(DUTY);
                assert_bridge_obeys(app);
            }
            if let Phase::Report(outcome) = app.phase() {
                return outcome;
            }
            app.handle(Event::Done)
                .expect("a running phase can be done");
            assert_bridge_obeys(app);
        }
    }

    fn assert_bridge_obeys(app: &App<Toy>) {
        let driven = app.board.duty.is_some();
        assert!(
            !driven || app.phase.bridge() == Bridge::Driven,
            "driven in {:?}",
            app.phase
        );
    }

    #[test]
    fn a_run_without_faults_moves_the_shaft_and_ends_with_the_bridge_open() {
        let mut app = App::new(Toy::default());
        assert_eq!(run(&mut app), Ok(()));
        let driven_phases = 4; // probe, excite, record, verify
        assert_eq!(
            app.board.count,
            i32::from(DUTY) / 1024 * driven_phases * PERIODS_PER_PHASE as i32
        );
        assert_eq!(app.board.duty, None);
        app.handle(Event::Done).unwrap();
        assert_eq!(app.phase(), Phase::Idle);
    }

    #[test]
    fn a_board_that_fails_in_any_period_is_left_with_the_bridge_open() {
        let mut whole = App::new(Toy::default());
        run(&mut whole).unwrap();
        for fault in [Fault::Overrun, Fault::Bridge] {
            for period in 1..=whole.board.periods {
                let mut app = App::new(Toy {
                    fails: Some((period, fault)),
                    ..Toy::default()
                });
                assert_eq!(run(&mut app), Err(fault), "period {period}");
                let at_rest = app.board.count;
                assert_eq!(
                    app.period(DUTY),
                    at_rest,
                    "the shaft was driven after {fault:?} in period {period}"
                );
            }
        }
    }

    #[test]
    fn a_stop_opens_the_bridge_at_once_and_a_new_run_can_follow() {
        let mut app = App::new(Toy::default());
        app.handle(Event::Start).unwrap();
        app.period(DUTY);
        app.fail(Fault::Stopped);
        assert_eq!(
            (app.board.duty, app.phase()),
            (None, Phase::Report(Err(Fault::Stopped)))
        );
        app.handle(Event::Done).unwrap();
        assert_eq!(run(&mut app), Ok(()));
    }

    #[test]
    fn an_idle_device_does_not_drive_and_a_running_one_does_not_start_again() {
        let mut app = App::new(Toy::default());
        assert_eq!(app.period(DUTY), 0);
        assert_eq!(app.board.duty, None);
        app.handle(Event::Start).unwrap();
        let refused = app.handle(Event::Start).unwrap_err();
        assert_eq!(
            refused,
            Refused {
                phase: Phase::Probe,
                event: Event::Start
            }
        );
        assert_eq!(app.phase(), Phase::Probe);
    }
}
