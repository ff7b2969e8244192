//! The bench: it moves the motor from one instant to the next, between the image's bridge and the image's encoder.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::thread;
use std::time::{Duration, Instant};

use rigless::emulator::{Driver, Error, Host, Stop};
use rigless::session::Session;
use rigless::time::VirtualNanos;
use servoid_rigless::plant::{Motor, State, Terminal};
use servoid_rigless::switch::PowerSwitch;

use crate::faults::{Faults, begun};
use crate::rig::Rig;
use crate::stack;
use crate::unkind::Unkind;

/// Settings of the bench.
#[derive(Debug)]
pub struct Settings {
    /// The motor.
    pub motor: Motor,
    /// Supply, V.
    pub supply: f64,
    /// Counts of the encoder in a revolution: four for each of its lines.
    pub counts_per_rev: u32,
    /// Time between two looks at the bridge, ns.
    pub step_ns: u64,
    /// Virtual time at which the run ends, ns.
    pub end_ns: u64,
    /// Virtual seconds that may pass in a second; infinite to run as fast as it goes.
    pub pace: f64,
    /// How unkind it is.
    pub unkind: Unkind,
    /// Faults to inject.
    pub faults: Faults,
    /// Counts the stack used if set.
    pub measure_stack: bool,
}

/// The motor, the encoder and wall-clock time.
#[derive(Debug)]
pub struct Bench {
    settings: Settings,
    state: State,
    /// The count that the encoder's lines show.
    shown: i64,
    fault_shown: bool,
    restarts: usize,
    switch: PowerSwitch,
    /// Time until the bridge's carrier turns round, ns.
    turns_in: u64,
    /// The last stop, ns.
    last: u64,
    started: Instant,
    stack: Option<Result<u64, Error>>,
    log: Option<BufWriter<File>>,
}

/// A millisecond, ns.
const MS: u64 = 1_000_000;

impl Bench {
    /// A motor at rest at angle zero. Its trajectory goes to `log`, a line a millisecond.
    pub fn new(settings: Settings, log: Option<File>) -> Self {
        let mut log = log.map(BufWriter::new);
        if let Some(log) = &mut log {
            let _ = writeln!(log, "time_s,duty,current_a,speed_rad_s,angle_rad,count");
        }
        Self {
            settings,
            state: State::default(),
            shown: 0,
            fault_shown: false,
            restarts: usize::MAX,
            switch: PowerSwitch::watch(),
            turns_in: u64::MAX,
            last: 0,
            started: Instant::now(),
            stack: None,
            log,
        }
    }

    /// The count that the encoder shows.
    pub fn count(&self) -> i64 {
        self.shown
    }

    /// The motor's state.
    pub fn state(&self) -> State {
        self.state
    }

    /// Wall-clock time since the first instruction.
    pub fn elapsed(&self) -> Duration {
        self.started.elapsed()
    }

    /// Bytes of stack that the image had used by the end, if they were counted.
    pub fn stack(&self) -> Result<Option<u64>, &Error> {
        self.stack
            .as_ref()
            .map(|used| used.as_ref().copied())
            .transpose()
    }

    /// Paints the stack before the first instruction, looks at it after the last.
    fn watch_stack(&mut self, at: VirtualNanos, host: &mut dyn Host) {
        if self.settings.measure_stack {
            if self.last == 0 {
                self.stack = stack::paint(host).err().map(Err);
            } else if at.0 >= self.settings.end_ns && self.stack.is_none() {
                self.stack = Some(stack::used(host));
            }
        }
    }

    fn turn(&mut self, rig: &mut Rig, at: VirtualNanos) {
        let now = at.0 as f64 * 1e-9;
        let faults = &self.settings.faults;
        // First the drive that acted until now, then the next one.
        let duty = rig.duty();
        self.turns_in = rig.take_over(at).0;
        let unkind = self.settings.unkind;
        let supply = faults.supply(self.settings.supply, now);
        let bus = unkind.bus(supply, now, duty, self.state.current);
        let terminal = match duty {
            Some(duty) => Terminal::Driven(unkind.volts(bus, duty, self.state.current)),
            None => Terminal::Open(supply),
        };
        let locked = begun(faults.rotor_locked_at, now);
        let seconds = (at.0 - self.last) as f64 * 1e-9;
        self.state
            .advance(&self.settings.motor, terminal, locked, seconds);
        let over = begun(faults.over_current_at, now);
        let current = if over {
            f64::INFINITY
        } else {
            self.state.current + unkind.sensor_offset
        };
        rig.sense(current, bus);
        self.show_fault(rig, at, now);
        self.show_count(rig, at, now);
        if at.0 / MS != self.last / MS {
            self.write(at, duty);
            self.keep_pace(at);
        }
        self.last = at.0;
    }

    fn show_fault(&mut self, rig: &mut Rig, at: VirtualNanos, now: f64) {
        let faults = &self.settings.faults;
        let fault =
            begun(faults.bridge_fault_at, now) && !begun(faults.bridge_fault_at, now - 1e-3);
        if fault != self.fault_shown {
            self.fault_shown = fault;
            rig.drive_fault(at, fault);
        }
    }

    /// Turns the encoder's disc to where the rotor is, edge by edge: the timer must see each of them.
    fn show_count(&mut self, rig: &mut Rig, at: VirtualNanos, now: f64) {
        // Even without an edge: the image may only now have connected the pins.
        rig.drive_encoder(at, self.lines());
        if begun(self.settings.faults.encoder_stuck_at, now) {
            return;
        }
        let counts =
            self.state.angle / std::f64::consts::TAU * f64::from(self.settings.counts_per_rev);
        let unkind = self.settings.unkind;
        for _ in 0..unkind.glitches_between(self.last as f64 * 1e-9, now) {
            let [a, b] = self.lines();
            rig.drive_encoder(at, [!a, b]);
            rig.drive_encoder(at, [a, b]);
        }
        let target = unkind.count(counts, self.settings.counts_per_rev);
        while self.shown != target {
            self.shown += (target - self.shown).signum();
            rig.drive_encoder(at, self.lines());
        }
    }

    fn lines(&self) -> [bool; 2] {
        let [a, b] = match self.shown.rem_euclid(4) {
            0 => [false, false],
            1 => [true, false],
            2 => [true, true],
            _ => [false, true],
        };
        if self.settings.faults.encoder_line_dead {
            [a, false]
        } else if self.settings.faults.encoder_reversed {
            [b, a]
        } else {
            [a, b]
        }
    }

    fn write(&mut self, at: VirtualNanos, duty: Option<f64>) {
        let Some(log) = &mut self.log else { return };
        let State {
            current,
            speed,
            angle,
        } = self.state;
        let duty = duty.map_or(String::from("open"), |duty| format!("{duty:.6}"));
        let time = at.0 as f64 * 1e-9;
        let _ = writeln!(
            log,
            "{time:.3},{duty},{current:.6},{speed:.6},{angle:.8},{}",
            self.shown
        );
    }

    fn keep_pace(&self, at: VirtualNanos) {
        let due = Duration::from_secs_f64(at.0 as f64 * 1e-9 / self.settings.pace);
        thread::sleep(due.saturating_sub(self.started.elapsed()));
    }
}

impl Driver<Rig> for Bench {
    fn on_stop(
        &mut self,
        session: &mut Session<Rig>,
        stop: Stop,
        host: &mut dyn Host,
    ) -> Option<VirtualNanos> {
        let at = stop.at;
        if session.resets().len() != self.restarts {
            // Out of reset the models have forgotten what their pins show; the bench has not.
            self.restarts = session.resets().len();
            session.board_mut().drive_fault(at, self.fault_shown);
            host.hold(false);
        }
        self.watch_stack(at, host);
        let Faults {
            reset_at,
            wedged_at,
            crashes_at,
            crystal_stops_at,
            ..
        } = self.settings.faults;
        let (before, now) = (self.last as f64 * 1e-9, at.0 as f64 * 1e-9);
        let begins = |fault| begun(fault, now) && !begun(fault, before);
        self.turn(session.board_mut(), at);
        if begins(wedged_at) {
            host.hold(true);
        }
        if begins(crashes_at) {
            stack::spoil(host).expect("an image has a stack");
        }
        if begins(crystal_stops_at) {
            session.board_mut().stop_crystal(at);
        }
        // To a program that keeps nothing in its RAM the pin is as good.
        if begins(reset_at) || self.switch.was_cut() {
            session.reset_by_pin(at, stop.instruction_count, host);
        }
        // A stop falls between two instructions, so it may come a little late; the next one does not.
        let step = self.settings.step_ns;
        let next = ((at.0 / step + 1) * step).min(at.0.saturating_add(self.turns_in));
        (at.0 < self.settings.end_ns).then_some(VirtualNanos(next))
    }
}
