//! An H bridge of a HAL's parts: two outputs of its PWM, an enable pin and a fault pin.

use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal::pwm::SetDutyCycle;

use super::modulation::{HalfBridges, Modulation};

/// An H bridge behind two outputs of one carrier, an enable input (high: on) and a fault output (low: fault). How the outputs make a duty
/// is the bridge's [`Modulation`].
#[derive(Debug)]
pub struct HBridge<A, B, E, F, M = HalfBridges> {
    legs: M,
    pub(super) a: A,
    pub(super) b: B,
    pub(super) enable: E,
    pub(super) fault: F,
    /// A duty was given: the bridge closes when that acts.
    driven: bool,
    closed: bool,
    /// A part refused what it was told.
    failed: bool,
}

impl<A: SetDutyCycle, B: SetDutyCycle, E: OutputPin, F: InputPin, M: Modulation>
    HBridge<A, B, E, F, M>
{
    /// Opens the bridge. `full` is the carrier's compare value for a leg that is high all the time; a HAL whose largest duty
    /// cycle is less costs as much of the largest duty, and nothing below it.
    pub fn new(a: A, b: B, enable: E, fault: F, full: u16) -> Self {
        let longest = a.max_duty_cycle().min(b.max_duty_cycle());
        let mut bridge = HBridge {
            legs: M::new(full, longest),
            a,
            b,
            enable,
            fault,
            driven: false,
            closed: false,
            failed: false,
        };
        bridge.open();
        bridge
    }

    /// The rule by which it makes a duty.
    pub fn legs(&self) -> &M {
        &self.legs
    }

    /// Gives both legs a duty. They take it over at the carrier's next turn, which must not pass in between.
    pub fn drive(&mut self, duty: i16) {
        self.set(duty);
        self.driven = true;
    }

    /// Closes an open bridge that is to drive. After the carrier's turn: before, it would brake until then.
    pub fn close(&mut self) {
        if self.driven && !self.closed {
            self.failed |= self.enable.set_high().is_err();
            self.closed = true;
        }
    }

    /// Opens the bridge at once.
    pub fn open(&mut self) {
        self.failed |= self.enable.set_low().is_err();
        (self.driven, self.closed) = (false, false);
        self.give(self.legs.open());
    }

    /// True while it drives.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// True while driving if the bridge reports a fault or one of its parts failed.
    pub fn tripped(&mut self) -> bool {
        self.closed && (self.failed || self.fault.is_low().unwrap_or(true))
    }

    fn set(&mut self, duty: i16) {
        self.give(self.legs.compares(duty));
    }

    fn give(&mut self, (a, b): (u16, u16)) {
        self.failed |= self.a.set_duty_cycle(a).is_err() | self.b.set_duty_cycle(b).is_err();
    }
}
