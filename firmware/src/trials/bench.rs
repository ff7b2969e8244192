//! A bench in memory: a motor, a link of two queues, and their faults.

use core::cell::RefCell;

use heapless::{Deque, Vec};
use shared::rng;

use crate::board::Board;
use crate::board::store::{LONGEST, Store};
use crate::phase::Fault;
use crate::plant::{CARRIERS, Motor};

/// Bytes that wait on one direction of the link.
const ROOM: usize = 2048;
const PERIOD_S: f32 = 1e-3;
/// Smallest change of a duty.
const STEP: i16 = 7;

/// Motor, link and injected faults.
#[derive(Debug)]
pub struct Bench {
    /// Bytes that the host has sent.
    pub to_device: Deque<u8, ROOM>,
    /// Bytes that the device has sent.
    pub to_host: Deque<u8, ROOM>,
    /// State of the bridge: a duty, or open.
    pub driven: Option<i16>,
    /// Control periods so far.
    pub period: u32,
    /// Sign of the encoder, or 0 for one that stands still.
    pub encoder: i32,
    /// True if the shaft is locked.
    pub locked: bool,
    /// Reading of the current sensor in place of the true current.
    pub current_ma: Option<i32>,
    /// Reading of the supply in place of the true one, mV.
    pub supply_mv: Option<u16>,
    /// True if one of the encoder's lines is dead.
    pub line_dead: bool,
    /// True if a lead of the motor is cut.
    pub lead_cut: bool,
    /// Error of the current sensor, mA.
    pub offset_ma: i32,
    /// Of 65,536 readings of the encoder so many are a count off, as one that stands on an edge is.
    pub glitches: u32,
    /// Largest current so far, mA.
    pub peak_ma: i32,
    noise: rng::Generator,
    /// Fault to report at the end of a period.
    pub fails: Option<Fault>,
    /// Time from the end of a period to the carrier's turn, s: the next duty acts then, and the count is the count then.
    pub turn_s: f32,
    /// What outlives a power cut.
    pub saved: Saved,
    /// A duty that waits for the turn.
    waits: Option<i16>,
    turned: bool,
    motor: Motor,
    count: i32,
}

impl Bench {
    /// With a motor, and nothing wrong.
    pub fn new(motor: Motor) -> Self {
        Bench {
            to_device: Deque::new(),
            to_host: Deque::new(),
            driven: None,
            period: 0,
            encoder: 1,
            locked: false,
            current_ma: None,
            supply_mv: None,
            line_dead: false,
            lead_cut: false,
            offset_ma: 0,
            glitches: 0,
            peak_ma: 0,
            noise: rng::seeded(1),
            fails: None,
            turn_s: 0.0,
            saved: Saved::default(),
            waits: None,
            turned: true,
            motor,
            count: -5,
        }
    }

    /// Lets the motor run on.
    fn advance(&mut self, seconds: f32) {
        let before = self.motor.state.count;
        if seconds > 0.0 {
            let driven = self.driven.filter(|_| !self.lead_cut);
            if self.locked {
                self.motor.hold(driven, seconds);
            } else {
                self.motor.advance(driven, seconds);
            }
        }
        self.peak_ma = self.peak_ma.max(self.motor.peak_ma());
        let after = self.motor.state.count;
        let travelled = match self.line_dead {
            false => after.wrapping_sub(before),
            // The other line's edges count up and down.
            true => level(after) - level(before),
        };
        self.count = self.count.wrapping_add(self.encoder * travelled);
    }

    /// A disturbance makes the counter count.
    pub fn jump(&mut self, counts: i32) {
        self.count = self.count.wrapping_add(counts);
    }

    /// What the encoder has counted.
    pub fn counts(&self) -> i32 {
        self.count
    }

    /// The motor as it is now.
    pub fn motor(&self) -> &Motor {
        &self.motor
    }

    /// The carrier turns, if it has not in this period.
    fn turn(&mut self) {
        if !self.turned {
            self.turned = true;
            self.advance(self.turn_s);
            self.driven = self.waits.take().or(self.driven);
        }
    }
}

/// A memory that loses nothing.
#[derive(Clone, Debug, Default)]
pub struct Saved(Option<(u8, Vec<u8, LONGEST>)>);

impl Store for Saved {
    fn load(&mut self, key: u8, into: &mut [u8; LONGEST]) -> Option<usize> {
        let (_, value) = self.0.as_ref().filter(|(saved, _)| *saved == key)?;
        into.get_mut(..value.len())?.copy_from_slice(value);
        Some(value.len())
    }

    fn save(&mut self, key: u8, value: &[u8]) -> bool {
        self.0 = Vec::from_slice(value).ok().map(|value| (key, value));
        self.0.is_some()
    }
}

/// Level of the encoder's first line at a position.
fn level(count: i32) -> i32 {
    i32::from(count.rem_euclid(4) >= 2)
}

/// The bench as a board, with sensors of current and supply or without.
#[derive(Debug, Clone, Copy)]
pub struct OnBench<'b, const SENSES: bool = true>(pub &'b RefCell<Bench>);

impl<const SENSES: bool> Board for OnBench<'_, SENSES> {
    const NAME: &'static str = "bench";
    const PERIOD_US: u32 = 1000;
    const SLICE: u32 = 20_000;
    const SENSES_CURRENT: bool = SENSES;
    const SAVES: bool = true;

    fn drive(&mut self, duty: i16) {
        let bench = &mut *self.0.borrow_mut();
        if bench.turn_s == 0.0 {
            bench.driven = Some(duty);
        } else {
            bench.waits = Some(duty);
        }
    }

    /// In steps, as a real bridge.
    fn nearest(&self, duty: i16) -> i16 {
        duty / STEP * STEP
    }

    fn coast(&mut self) {
        let bench = &mut *self.0.borrow_mut();
        (bench.driven, bench.waits) = (None, None);
    }

    fn count(&mut self) -> i32 {
        let bench = &mut *self.0.borrow_mut();
        bench.turn();
        let off = rng::below(&mut bench.noise, 65_536) < bench.glitches;
        bench.count.wrapping_add(i32::from(off))
    }

    fn current_ma(&mut self) -> i32 {
        let bench = self.0.borrow();
        let seen = bench.motor.current_ma().saturating_add(bench.offset_ma);
        bench.current_ma.unwrap_or(seen)
    }

    fn supply_mv(&mut self) -> Option<u16> {
        let bench = self.0.borrow();
        SENSES.then_some(bench.supply_mv.unwrap_or(bench.motor.supply_mv()))
    }

    fn carriers(&self) -> u16 {
        CARRIERS as u16
    }

    fn tick(&mut self) -> Result<(), Fault> {
        let bench = &mut *self.0.borrow_mut();
        bench.turn();
        bench.advance(PERIOD_S - bench.turn_s);
        bench.turned = bench.turn_s == 0.0;
        bench.period += 1;
        bench.fails.map_or(Ok(()), Err)
    }

    fn receive(&mut self) -> Option<u8> {
        self.0.borrow_mut().to_device.pop_front()
    }

    fn send(&mut self, bytes: &[u8]) -> usize {
        let queue = &mut self.0.borrow_mut().to_host;
        bytes
            .iter()
            .take_while(|&&byte| queue.push_back(byte).is_ok())
            .count()
    }

    fn load(&mut self, key: u8, into: &mut [u8; LONGEST]) -> Option<usize> {
        self.0.borrow_mut().saved.load(key, into)
    }

    fn save(&mut self, key: u8, value: &[u8]) -> bool {
        self.0.borrow_mut().saved.save(key, value)
    }

    fn entropy(&mut self) -> u32 {
        7 + self.0.borrow().period
    }
}
