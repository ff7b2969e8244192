//! Running state: of the motor, of its load and of the effects' memories.

use crate::effects::{MAX_EFFECTS, Memory};
use crate::scalar::{Scalar, lanes};

/// Motion of winding, shaft and load.
#[derive(Clone, Copy, Debug, Default)]
pub struct Motion<S: Scalar> {
    /// Current, as the voltage across the resistance; per unit.
    pub current: S,
    /// Speed, per unit. Exactly zero while friction holds the shaft.
    pub speed: S,
    /// Shaft angle.
    pub angle: S::Angle,
    /// Twist between motor and load, as the speed at which its oscillation would pass zero.
    pub twist: S,
    /// Speed of the motor less that of its load, per unit.
    pub slip: S,
}

lanes!(Motion {
    current,
    speed,
    angle,
    twist,
    slip
});

/// Running state of a [`Model`](super::Model). `Default` is rest at angle zero, with everything cold and relaxed. Nothing in it
/// depends on the sample interval, so models of one motor at different intervals can share it.
#[derive(Clone, Copy, Debug, Default)]
pub struct State<S: Scalar> {
    /// Winding, shaft and load.
    pub motion: Motion<S>,
    /// Voltage that acted last, per unit: a jump of it is followed in graded substeps.
    pub volts: S,
    /// Temperature that the recording tells, which whoever steps the model sets; zero where it tells none.
    pub temperature: S,
    /// Whether the bridge was open last.
    pub open: bool,
    /// Memory of the effects, in the order in which they act.
    pub memory: [Memory<S>; MAX_EFFECTS],
    /// Commands on their way to the bridge.
    pub past: Past<S>,
}

lanes!(State {
    motion,
    volts,
    temperature,
    open,
    memory,
    past
});

impl<S: Scalar> State<S> {
    /// A motor without current that passes `angle` at `speed`; its load turns with it.
    #[inline(always)]
    pub fn at(angle: S::Angle, speed: S) -> Self {
        State {
            motion: Motion {
                speed,
                angle,
                ..Motion::default()
            },
            ..State::default()
        }
    }
}

/// Most samples by which a command can be late, rounded up to whole ones.
pub const MAX_DELAY: usize = 15;

/// The last commands, newest first to ask for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Past<S> {
    volts: [S; MAX_DELAY + 1],
    open: [bool; MAX_DELAY + 1],
    newest: usize,
}

lanes!(Past {
    volts,
    open,
    newest
});

impl<S: Copy> Past<S> {
    /// Takes the next command.
    pub fn push(&mut self, volts: S, open: bool) {
        self.newest = (self.newest + 1) % self.volts.len();
        self.volts[self.newest] = volts;
        self.open[self.newest] = open;
    }

    /// The command of `samples` ago, at most [`MAX_DELAY`].
    #[inline(always)]
    pub fn ago(&self, samples: usize) -> (S, bool) {
        let len = self.volts.len();
        let k = (self.newest + len - samples.min(len - 1)) % len;
        (self.volts[k], self.open[k])
    }
}
