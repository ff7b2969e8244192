//! The phases of a self-identification, and the one rule that leads from each to the next.
//!
//! ```text
//! Idle → Probe → Excite → Record → Fit → Verify → Simulate → Tune → Keep → Follow → Report → Idle
//!          └────────┴────────┴──────┴───────┴────────┴────────┴───────┴──────┴───────↗  any fault, at any time
//! ```
//!
//! The rule is two pure functions, [`Phase::after`] an event and [`Phase::failed`] by a fault, and whether the bridge may
//! drive is a function of the phase alone. A fault leads to [`Phase::Report`], where it may not, and cannot be refused:
//! so there is no path on which a fault leaves the motor driven.

use core::fmt;
use shared::wire::Stage;

pub use shared::wire::Fault;

/// Phase of the device.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Phase {
    /// Waits for a start; the bridge is open.
    Idle,
    /// Drives in small growing steps until the shaft moves, which sets the amplitude of the excitation.
    Probe,
    /// Plays the long excitation, which is streamed to the host and not stored.
    Excite,
    /// Plays a short one from standstill, and stores the duty and the count of every period.
    Record,
    /// Fits the model to the recording; the bridge is open and the motor coasts.
    Fit,
    /// Drives a recording that the fit has not seen, and compares it with the model's prediction.
    Verify,
    /// Computes gains, and simulates a step with them; the bridge is open and the motor coasts.
    Simulate,
    /// Drives that step in a closed loop.
    Tune,
    /// Saves the servo where it outlives a power cut; the bridge is open and the motor coasts.
    Keep,
    /// Follows set-points in a closed loop.
    Follow,
    /// Repeats the report until the host acknowledges it; the bridge is open.
    Report(Result<(), Fault>),
}

/// Event that leads from a phase to the next when all goes well.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Event {
    /// The user asks for a self-identification.
    Start,
    /// The phase has done its work.
    Done,
}

/// Permission of the bridge to drive the motor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bridge {
    /// Open: the motor coasts.
    Open,
    /// The phase's duty reaches the motor.
    Driven,
}

impl Phase {
    /// The phase that follows this one when `event` happens.
    ///
    /// # Errors
    ///
    /// [`Refused`] if the event has no meaning in this phase: a start while one is running, an end of nothing.
    pub fn after(self, event: Event) -> Result<Phase, Refused> {
        match (self, event) {
            (Phase::Idle, Event::Start) => Ok(Phase::Probe),
            (Phase::Probe, Event::Done) => Ok(Phase::Excite),
            (Phase::Excite, Event::Done) => Ok(Phase::Record),
            (Phase::Record, Event::Done) => Ok(Phase::Fit),
            (Phase::Fit, Event::Done) => Ok(Phase::Verify),
            (Phase::Verify, Event::Done) => Ok(Phase::Simulate),
            (Phase::Simulate, Event::Done) => Ok(Phase::Tune),
            (Phase::Tune, Event::Done) => Ok(Phase::Keep),
            (Phase::Keep, Event::Done) => Ok(Phase::Follow),
            (Phase::Follow, Event::Done) => Ok(Phase::Report(Ok(()))),
            (Phase::Report(_), Event::Done) => Ok(Phase::Idle),
            (phase, event) => Err(Refused { phase, event }),
        }
    }

    /// The phase that follows this one, whichever it is, when `fault` happens. A second fault does not hide the first,
    /// which is its likely cause.
    #[must_use]
    pub fn failed(self, fault: Fault) -> Phase {
        match self {
            Phase::Report(Err(first)) => Phase::Report(Err(first)),
            _ => Phase::Report(Err(fault)),
        }
    }

    /// Permission of the bridge to drive the motor in this phase.
    #[must_use]
    pub fn bridge(self) -> Bridge {
        match self {
            Phase::Probe
            | Phase::Excite
            | Phase::Record
            | Phase::Verify
            | Phase::Tune
            | Phase::Follow => Bridge::Driven,
            Phase::Idle | Phase::Fit | Phase::Simulate | Phase::Keep | Phase::Report(_) => {
                Bridge::Open
            }
        }
    }
}

/// An event that has no meaning in the phase in which it came.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Refused {
    /// The phase, which stays as it was.
    pub phase: Phase,
    /// The event that was refused.
    pub event: Event,
}

impl Phase {
    /// The refusal as a message to the host.
    #[must_use]
    pub fn stage(self) -> Stage {
        match self {
            Phase::Idle => Stage::Idle,
            Phase::Probe => Stage::Probe,
            Phase::Excite => Stage::Excite,
            Phase::Record => Stage::Record,
            Phase::Fit => Stage::Fit,
            Phase::Verify => Stage::Verify,
            Phase::Simulate => Stage::Simulate,
            Phase::Tune => Stage::Tune,
            Phase::Keep => Stage::Keep,
            Phase::Follow => Stage::Follow,
            Phase::Report(_) => Stage::Report,
        }
    }
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.event {
            Event::Start => write!(
                f,
                "cannot start in phase {:?}: stop it or wait until it is idle",
                self.phase
            ),
            Event::Done => write!(
                f,
                "nothing runs in phase {:?} that could be done: start it first",
                self.phase
            ),
        }
    }
}

impl core::error::Error for Refused {}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every phase that can be reached from idle, found by trying everything: a new phase cannot be forgotten here.
    fn reachable() -> Vec<Phase> {
        let mut phases = vec![Phase::Idle];
        let mut seen = 0;
        while let Some(&phase) = phases.get(seen) {
            let events = [Event::Start, Event::Done]
                .into_iter()
                .filter_map(|event| phase.after(event).ok());
            for next in events.chain(Fault::ALL.map(|fault| phase.failed(fault))) {
                if !phases.contains(&next) {
                    phases.push(next);
                }
            }
            seen += 1;
        }
        phases
    }

    #[test]
    fn every_fault_in_every_phase_opens_the_bridge_and_is_reported() {
        for phase in reachable() {
            for fault in Fault::ALL {
                let next = phase.failed(fault);
                assert_eq!(next.bridge(), Bridge::Open, "{phase:?} failed by {fault:?}");
                let reported = match phase {
                    Phase::Report(Err(first)) => first,
                    _ => fault,
                };
                assert_eq!(
                    next,
                    Phase::Report(Err(reported)),
                    "{phase:?} failed by {fault:?}"
                );
            }
        }
    }

    #[test]
    fn without_faults_the_phases_follow_each_other_round_to_idle() {
        let mut passed = vec![Phase::Idle.after(Event::Start).unwrap()];
        while let Some(&phase) = passed.last()
            && phase != Phase::Idle
        {
            passed.push(phase.after(Event::Done).unwrap());
        }
        use Phase::*;
        assert_eq!(
            passed,
            [
                Probe,
                Excite,
                Record,
                Fit,
                Verify,
                Simulate,
                Tune,
                Keep,
                Follow,
                Report(Ok(())),
                Idle
            ]
        );
    }

    #[test]
    fn only_an_idle_device_starts_and_only_a_busy_one_is_done() {
        for phase in reachable() {
            assert_eq!(
                phase.after(Event::Start).is_ok(),
                phase == Phase::Idle,
                "{phase:?}"
            );
            assert_eq!(
                phase.after(Event::Done).is_ok(),
                phase != Phase::Idle,
                "{phase:?}"
            );
        }
    }
}
