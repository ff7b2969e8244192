//! Excitations: what to command so that the motor shows what it is.
//!
//! An [`Experiment`] is a shape with a length and an amplitude; a plan is a list of them, and
//! [`commands`] turns a plan into one command a sample. Amplitudes are parts of the supply.

use crate::rng::{self, Generator};
use crate::scalar::Real;

/// One command, held for one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Command<R> {
    /// Drive, as a part of the supply, in `[-1, 1]`.
    pub drive: R,
    /// False while the bridge is to be open, so that the motor coasts.
    pub enabled: bool,
}

/// The form of an experiment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape<R = f64> {
    /// Nothing.
    Rest,
    /// One step at the start.
    Step,
    /// Steps of both signs at 30, 65 and 100 %, each followed by as long a pause at 0 V (or with the bridge open).
    Steps {
        /// Open the bridge in the pauses.
        open: bool,
    },
    /// Up and down through both signs in this many levels.
    Staircase {
        /// Levels from zero to the top.
        levels: u32,
    },
    /// Triangle waves through both signs.
    Triangle {
        /// Number of whole waves.
        waves: u32,
    },
    /// Full reversals.
    Reversals {
        /// Number of reversals.
        count: u32,
    },
    /// Sine of rising frequency (logarithmic).
    Chirp {
        /// Frequency at the start, Hz.
        from_hz: R,
        /// Frequency at the end, Hz.
        to_hz: R,
    },
    /// Random levels held for random times.
    Telegraph {
        /// Number of levels, from −1 to 1.
        levels: u32,
        /// Mean holding time, s.
        hold_s: R,
    },
    /// Sum of odd sine lines with phases that keep the crest low (Schroeder, 1970).
    Multisine {
        /// Lowest line, Hz.
        base_hz: R,
        /// Number of odd lines.
        lines: u32,
    },
}

/// A shape, its length and its amplitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Experiment<R = f64> {
    /// The form.
    pub shape: Shape<R>,
    /// Length, s.
    pub seconds: R,
    /// Largest drive, as a part of the supply.
    pub amplitude: R,
}

impl Experiment {
    /// In single precision.
    pub const fn narrowed(&self) -> Experiment<f32> {
        Experiment {
            shape: self.shape.narrowed(),
            seconds: self.seconds as f32,
            amplitude: self.amplitude as f32,
        }
    }
}

/// A plan in single precision, ready for a device: rounded by the compiler, it spares a small core the routine for it. One
/// with a shape that [`device_commands`] does not have does not compile.
pub const fn narrowed<const N: usize>(plan: [Experiment; N]) -> [Experiment<f32>; N] {
    let mut narrowed = [Experiment {
        shape: Shape::Rest,
        seconds: 0.0,
        amplitude: 0.0,
    }; N];
    let mut k = 0;
    while k < N {
        assert!(plan[k].shape.is_devices(), "no shape of a device's");
        narrowed[k] = plan[k].narrowed();
        k += 1;
    }
    narrowed
}

const fn experiment(shape: Shape, seconds: f64, amplitude: f64) -> Experiment {
    Experiment {
        shape,
        seconds,
        amplitude,
    }
}

/// The twenty seconds that tell effects apart: at least four magnitudes of both signs, slow and
/// fast, hot after cold.
pub const COMMISSIONING: [Experiment; 7] = [
    experiment(Shape::Triangle { waves: 1 }, 3.2, 0.25),
    experiment(Shape::Triangle { waves: 1 }, 2.6, 1.0),
    experiment(Shape::Steps { open: false }, 5.2, 1.0),
    experiment(Shape::Reversals { count: 5 }, 2.0, 1.0),
    experiment(
        Shape::Telegraph {
            levels: 7,
            hold_s: 0.08,
        },
        3.0,
        1.0,
    ),
    experiment(
        Shape::Chirp {
            from_hz: 1.0,
            to_hz: 60.0,
        },
        2.4,
        0.8,
    ),
    experiment(Shape::Steps { open: false }, 1.6, 1.0),
];

/// The same, with the bridge open in the pauses: it parts electrical effects from mechanical ones.
pub const COMMISSIONING_COAST: [Experiment; 7] = [
    COMMISSIONING[0],
    COMMISSIONING[1],
    experiment(Shape::Steps { open: true }, 5.2, 1.0),
    COMMISSIONING[3],
    COMMISSIONING[4],
    COMMISSIONING[5],
    experiment(Shape::Steps { open: true }, 1.6, 1.0),
];

impl Shape {
    /// One of each, with usual settings, by name.
    pub const ALL: [(&'static str, Shape); 9] = [
        ("rest", Shape::Rest),
        ("step", Shape::Step),
        ("steps", Shape::Steps { open: false }),
        ("coast", Shape::Steps { open: true }),
        ("staircase", Shape::Staircase { levels: 5 }),
        ("triangle", Shape::Triangle { waves: 2 }),
        ("reversals", Shape::Reversals { count: 8 }),
        (
            "chirp",
            Shape::Chirp {
                from_hz: 0.5,
                to_hz: 60.0,
            },
        ),
        (
            "telegraph",
            Shape::Telegraph {
                levels: 7,
                hold_s: 0.08,
            },
        ),
    ];

    /// Whether a device's own plans may have it.
    const fn is_devices(&self) -> bool {
        match self {
            Shape::Steps { .. }
            | Shape::Triangle { .. }
            | Shape::Reversals { .. }
            | Shape::Chirp { .. }
            | Shape::Telegraph { .. } => true,
            Shape::Rest | Shape::Step | Shape::Staircase { .. } | Shape::Multisine { .. } => false,
        }
    }

    const fn narrowed(self) -> Shape<f32> {
        match self {
            Shape::Rest => Shape::Rest,
            Shape::Step => Shape::Step,
            Shape::Steps { open } => Shape::Steps { open },
            Shape::Staircase { levels } => Shape::Staircase { levels },
            Shape::Triangle { waves } => Shape::Triangle { waves },
            Shape::Reversals { count } => Shape::Reversals { count },
            Shape::Chirp { from_hz, to_hz } => Shape::Chirp {
                from_hz: from_hz as f32,
                to_hz: to_hz as f32,
            },
            Shape::Telegraph { levels, hold_s } => Shape::Telegraph {
                levels,
                hold_s: hold_s as f32,
            },
            Shape::Multisine { base_hz, lines } => Shape::Multisine {
                base_hz: base_hz as f32,
                lines,
            },
        }
    }

    /// What it reveals.
    pub fn reveals(self) -> &'static str {
        match self {
            Shape::Rest => "drift, offsets of the drive, a load at rest",
            Shape::Step => "gain and time constants; nothing that needs a reversal",
            Shape::Steps { open: false } => "gain, time constants, friction of both directions",
            Shape::Steps { open: true } => {
                "friction apart from back-EMF and from electrical effects"
            }
            Shape::Staircase { .. } => "curvature of speed against voltage, dead zone",
            Shape::Triangle { .. } => "friction against speed, dead zone, stiction",
            Shape::Reversals { .. } => "currents near stall: saturation, supply sag",
            Shape::Chirp { .. } => "delay, inductance, compliance",
            Shape::Telegraph { .. } => "everything a little, at many levels",
            Shape::Multisine { .. } => "frequency response, and nonlinearity at the even lines",
        }
    }
}

/// The commands of a plan, one a sample of `interval` seconds. The seed matters to telegraphs only.
pub fn commands<R: Real>(plan: &[Experiment<R>], interval: R, seed: u64) -> Commands<'_, R> {
    begun(plan, interval, seed)
}

/// Of a [`narrowed`] plan: the same without the shapes that no device plays, which take 300 bytes of its flash.
pub fn device_commands(
    plan: &[Experiment<f32>],
    interval: f32,
    seed: u64,
) -> Commands<'_, f32, false> {
    begun(plan, interval, seed)
}

fn begun<R: Real, const EVERY: bool>(
    plan: &[Experiment<R>],
    interval: R,
    seed: u64,
) -> Commands<'_, R, EVERY> {
    Commands {
        plan,
        interval,
        sample: 0,
        rng: rng::seeded(seed),
        level: R::zero(),
        hold: 0,
    }
}

/// Iterator over the commands of a plan, of every shape or of those that a device plays.
#[derive(Clone, Debug)]
pub struct Commands<'a, R, const EVERY: bool = true> {
    plan: &'a [Experiment<R>],
    interval: R,
    sample: u32,
    rng: Generator,
    level: R,
    hold: u32,
}

impl<R: Real, const EVERY: bool> Iterator for Commands<'_, R, EVERY> {
    type Item = Command<R>;

    fn next(&mut self) -> Option<Command<R>> {
        let (first, rest) = self.plan.split_first()?;
        let samples = rounded(first.seconds / self.interval);
        if self.sample >= samples {
            self.plan = rest;
            self.sample = 0;
            self.hold = 0;
            return self.next();
        }
        let k = self.sample;
        self.sample += 1;
        let whole = R::from_whole(k) / R::from_whole(samples);
        let seconds = R::from_whole(k) * self.interval;
        let (value, enabled) = self.value(first, whole, seconds);
        let limit = R::from_f64(1.0);
        let drive = (value * first.amplitude).min(limit).max(-limit);
        Some(Command { drive, enabled })
    }
}

impl<R: Real, const EVERY: bool> Commands<'_, R, EVERY> {
    /// Value in `[-1, 1]` at the part `whole` of the experiment, `seconds` after its start.
    fn value(&mut self, experiment: &Experiment<R>, whole: R, seconds: R) -> (R, bool) {
        let one = R::from_f64(1.0);
        let real = R::from_f64;
        match experiment.shape {
            Shape::Rest | Shape::Step | Shape::Staircase { .. } | Shape::Multisine { .. }
                if !EVERY =>
            {
                (R::zero(), true)
            }
            Shape::Rest => (R::zero(), true),
            Shape::Step => (one, true),
            Shape::Steps { open } => {
                // Forward, pause, back, pause.
                let twelfth = slot(whole, 12);
                let level = match twelfth / 4 {
                    0 => real(0.30),
                    1 => real(0.65),
                    _ => one,
                };
                match twelfth % 4 {
                    0 => (level, true),
                    2 => (-level, true),
                    _ => (R::zero(), !open),
                }
            }
            Shape::Staircase { levels } => {
                let levels = levels.max(1);
                let k = slot(whole, 4 * levels);
                let (up, down) = if k < levels {
                    (k + 1, 0)
                } else if k < 3 * levels {
                    (2 * levels, k + 1)
                } else {
                    (k, 4 * levels)
                };
                let climbed = R::from_whole(up) - R::from_whole(down);
                (climbed / R::from_whole(levels), true)
            }
            Shape::Triangle { waves } => {
                let phase = whole * R::from_whole(waves);
                let phase = phase - R::from_whole(phase.whole());
                let quarter = phase * real(4.0);
                let value = if quarter < one {
                    quarter
                } else if quarter < real(3.0) {
                    real(2.0) - quarter
                } else {
                    quarter - real(4.0)
                };
                (value, true)
            }
            Shape::Reversals { count } => {
                let k = slot(whole, count + 1);
                (if k.is_multiple_of(2) { one } else { -one }, true)
            }
            Shape::Chirp { from_hz, to_hz } => {
                // Phase of a logarithmic sweep: f0·T/ln(f1/f0)·((f1/f0)^(t/T) − 1).
                let ratio = (to_hz / from_hz).ln();
                let span = from_hz * experiment.seconds / ratio;
                let turns = span * ((ratio * whole).exp() - one);
                // The duty that is played is what is recorded: its shape need not be a sine to the last bit.
                (turns.sin_turns_approx(), true)
            }
            Shape::Telegraph { levels, hold_s } => {
                if self.hold == 0 {
                    let levels = levels.max(2);
                    let k = rng::below(&mut self.rng, levels);
                    self.level = R::from_whole(2 * k) / R::from_whole(levels - 1) - one;
                    let mean = hold_s / self.interval;
                    let part = real(0.5) + rng::uniform::<R>(&mut self.rng);
                    self.hold = rounded(mean * part).max(1);
                }
                self.hold -= 1;
                (self.level, true)
            }
            Shape::Multisine { base_hz, lines } => {
                let mut sum = R::zero();
                for line in 0..lines {
                    let hz = base_hz * R::from_whole(2 * line + 1);
                    let lag = R::from_whole(line * (line + 1)) / R::from_whole(2 * lines);
                    sum = sum + (hz * seconds - lag).sin_turns_approx();
                }
                // The crest of such a sum stays below 1.7 times its RMS, √(lines/2).
                let crest = real(1.7) * (R::from_whole(lines.max(1)) * real(0.5)).sqrt();
                ((sum / crest).min(one).max(-one), true)
            }
        }
    }
}

/// Which of `slots` equal parts holds the part `whole`.
fn slot<R: Real>(whole: R, slots: u32) -> u32 {
    (whole * R::from_whole(slots))
        .whole()
        .min(slots.saturating_sub(1))
}

/// To the nearest whole number.
fn rounded<R: Real>(x: R) -> u32 {
    (x + R::from_f64(0.5)).whole()
}
