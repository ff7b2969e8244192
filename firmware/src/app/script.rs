//! Generates the next duty of each driving phase.

use shared::excite::{
    self, COMMISSIONING, COMMISSIONING_COAST, Commands, Experiment, Shape, narrowed,
};
use shared::trace::OPEN;
use shared::wire::{PLAN_SEGMENTS, PlanStore, Segment};

/// A plan to play.
pub type Plan = PlanStore<PLAN_SEGMENTS>;

/// The short excitation that is fitted: levels of both signs for the time constants, a slow triangle for friction. Two
/// seconds; longer or shorter recordings stretch it.
const RECORD: [Experiment<f32>; 2] = narrowed([
    Experiment {
        shape: Shape::Telegraph {
            levels: 9,
            hold_s: 0.06,
        },
        seconds: 1.4,
        amplitude: 1.0,
    },
    Experiment {
        shape: Shape::Triangle { waves: 1 },
        seconds: 0.6,
        amplitude: 0.6,
    },
]);

/// The long ones.
const EXCITE: [Experiment<f32>; 7] = narrowed(COMMISSIONING);
const EXCITE_COAST: [Experiment<f32>; 7] = narrowed(COMMISSIONING_COAST);

/// Held-out excitation: steps, and levels in another order.
const VERIFY: [Experiment<f32>; 2] = narrowed([
    Experiment {
        shape: Shape::Steps { open: false },
        seconds: 1.2,
        amplitude: 0.9,
    },
    Experiment {
        shape: Shape::Telegraph {
            levels: 7,
            hold_s: 0.08,
        },
        seconds: 0.8,
        amplitude: 0.9,
    },
]);

/// A source of duties.
#[derive(Debug, Clone)]
pub enum Script {
    /// Small growing steps up to a duty.
    Growing {
        /// Duty of the present step.
        duty: i16,
        /// Where it ends.
        to: i16,
        /// Periods left in the present step.
        left: u32,
        /// Periods of a step.
        hold: u32,
    },
    /// The probe's last step: a brake, then a duty.
    Step {
        /// Periods of braking left.
        brake: u32,
        /// The duty.
        duty: i16,
        /// Periods of it left.
        left: u32,
    },
    /// An excitation.
    Excitation {
        /// Its commands.
        commands: Commands<'static, f32, false>,
        /// Duty of its largest command.
        amplitude: i16,
        /// Periods left.
        left: u32,
    },
    /// A closed loop makes the duties.
    Servo,
    /// The plan that the host sent: the segment, and the periods of it that are done.
    Plan {
        /// Index of the present segment.
        at: usize,
        /// Periods of it that are over.
        done: u16,
    },
}

/// Which excitation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Which {
    /// The long one.
    Excite {
        /// Open the bridge in its pauses.
        coast: bool,
    },
    /// The one that is fitted.
    Record,
    /// The one that the fit is tried on.
    Verify,
}

impl Script {
    /// Most steps of [`growing`](Self::growing).
    pub const GROWING_STEPS: u32 = 70;

    /// Growing steps up to `to`, `hold` periods each: by an eighth of themselves from a 320th of `to` on, so that the current of a
    /// motor that nothing is known of grows as slowly, and by no more than a 40th of `to`.
    pub fn growing(to: i16, hold: u32) -> Self {
        Script::Growing {
            duty: 0,
            to,
            left: 0,
            hold,
        }
    }

    /// An excitation stretched to `periods`, with `amplitude` as its largest duty.
    pub fn excitation(which: Which, periods: u32, amplitude: i16, seed: u64) -> Self {
        let plan: &'static [Experiment<f32>] = match which {
            Which::Excite { coast: true } => &EXCITE_COAST,
            Which::Excite { coast: false } => &EXCITE,
            Which::Record => &RECORD,
            Which::Verify => &VERIFY,
        };
        let seconds = plan.iter().fold(0.0, |sum, part| sum + part.seconds);
        let interval = seconds / periods.max(1) as f32;
        // The verification is drawn from another seed, or its levels would be those of the fit.
        let seed = match which {
            Which::Verify => seed ^ 0x5eed_0f7e_57ed,
            _ => seed,
        };
        Script::Excitation {
            commands: excite::device_commands(plan, interval, seed),
            amplitude,
            left: periods,
        }
    }

    /// The plan from its start.
    pub fn plan() -> Self {
        Script::Plan { at: 0, done: 0 }
    }

    /// The duty of the next period, [`OPEN`] for an open bridge; `None` at the end.
    pub fn next(&mut self, plan: &[Segment]) -> Option<i16> {
        match self {
            Script::Growing {
                duty,
                to,
                left,
                hold,
            } => {
                if *left == 0 {
                    if *duty >= *to {
                        return None;
                    }
                    let by = (*duty / 8).clamp((*to / 320).max(1), (*to / 40).max(1));
                    *duty = duty.saturating_add(by).min(*to);
                    *left = *hold;
                }
                *left -= 1;
                Some(*duty)
            }
            Script::Step { brake, duty, left } => {
                if *brake > 0 {
                    *brake -= 1;
                    return Some(0);
                }
                *left = left.checked_sub(1)?;
                Some(*duty)
            }
            Script::Excitation {
                commands,
                amplitude,
                left,
            } => {
                *left = left.checked_sub(1)?;
                let command = commands.next()?;
                if !command.enabled {
                    return Some(OPEN);
                }
                Some((command.drive * f32::from(*amplitude)) as i16)
            }
            Script::Servo => None,
            Script::Plan { at, done } => {
                while plan.get(*at)?.periods <= *done {
                    *at += 1;
                    *done = 0;
                }
                *done += 1;
                plan.get(*at).map(|segment| segment.duty)
            }
        }
    }
}
