//! One term of a law: a product of simple functions of speed, current, angle and one state.

use super::motion::Motion;
use super::state::along;
use core::f64::consts::PI;

/// Where a term acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A torque on the shaft.
    Torque,
    /// A voltage beside the commanded one; the term's load is the command instead of the current.
    Voltage,
    /// A voltage that the winding is short of by the current.
    Drop,
    /// A moment of inertia that goes with the angle, as a part of the motor's; the term depends on nothing else.
    Inertia,
}

/// A term's dependence on the speed. Powers are of the speed as a part of `reference`, rad/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Speed {
    /// None.
    One,
    /// Direction of the motion.
    Sign,
    /// `w/reference`.
    Plain {
        /// Speed at which it is one, rad/s.
        reference: f64,
    },
    /// `|w/reference|^exponent`, with the motion's sign where `odd`.
    Power {
        /// Power.
        exponent: f64,
        /// Whether it has a sign.
        odd: bool,
        /// Where its size is one.
        reference: f64,
    },
    /// `exp(-|w|/scale)`, with the motion's sign where `odd`.
    Decay {
        /// Speed at which it is down to 1/e, rad/s.
        scale: f64,
        /// Whether it has the motion's sign.
        odd: bool,
    },
    /// `(|w|/scale)^exponent*exp(-|w|/scale)`, with the motion's sign.
    Hump {
        /// Power.
        exponent: f64,
        /// Speed by which it is greatest, where the power is one, rad/s.
        scale: f64,
    },
    /// `(w/scale)/(1 + (w/scale)^2)`, as of eddy currents in a brake (Wouterse, *IEE Proc. B* 138, 153, 1991).
    Eddy {
        /// Speed at which it is greatest, rad/s.
        scale: f64,
    },
    /// `(w/scale)/(1 + |w|/scale)`.
    Saturating {
        /// Speed at which it bends, rad/s.
        scale: f64,
    },
    /// `tanh(w/scale)`.
    Tanh {
        /// Speed at which it bends, rad/s.
        scale: f64,
    },
    /// `(max(±w, 0)/reference)^exponent`.
    OneSided {
        /// Power.
        exponent: f64,
        /// Whether it acts forward.
        forward: bool,
        /// Speed at which it is one, rad/s.
        reference: f64,
    },
    /// Direction of the motion, where it is faster than `threshold`.
    Above {
        /// Speed from which it acts, rad/s.
        threshold: f64,
    },
    /// By how much it is faster than `threshold`, as a part of that, with the motion's sign.
    Beyond {
        /// Speed from which it acts, rad/s.
        threshold: f64,
    },
}

/// A term's dependence on the current, V across the resistance, or on the command, V; or on how far a drive is behind the command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    /// None.
    One,
    /// Its value.
    Plain,
    /// Its size.
    Size,
    /// `|i/reference|^exponent`, with its sign where `odd`.
    Power {
        /// Power.
        exponent: f64,
        /// Whether it has a sign.
        odd: bool,
        /// Where its size is one.
        reference: f64,
    },
    /// `(i/scale)/(1 + |i|/scale)`, as the drop of a contact whose resistance falls with the current.
    Saturating {
        /// Current at which it bends, V.
        scale: f64,
    },
    /// What a drive gives that changes by `rate` V/s at most, less the command.
    Slewed {
        /// Most that it changes by the second, V/s.
        rate: f64,
    },
    /// What a drive gives that follows with the time constant `time`, s, less the command.
    Lagging {
        /// Its time constant, s.
        time: f64,
    },
}

/// A term's dependence on the state `z' = (w - |w|*z)/distance`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Memory {
    /// Distance over which it follows a reversal, rad.
    pub distance: f64,
    /// Whether it stands squared.
    pub squared: bool,
}

/// A term's dependence on one place of the revolution: `exp((cos(theta - place) - 1)/width)`, the density of von Mises's distribution, one
/// at the place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bump {
    /// The place, rad.
    pub place: f64,
    /// About the square of the angle, rad, at which it is down to 0.6.
    pub width: f64,
}

/// A product, times one amplitude; or two, of cosine and sine of a multiple of the angle.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// Where it acts.
    pub place: Place,
    /// Speed.
    pub speed: Speed,
    /// Current or command.
    pub load: Load,
    /// Cycles in a revolution.
    pub order: Option<u32>,
    /// Place of the revolution.
    pub bump: Option<Bump>,
    /// State.
    pub memory: Option<Memory>,
    /// Amplitudes: V, or without unit beside a plain load.
    pub amplitudes: Vec<f64>,
}

/// One number that shapes a term.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// Its value.
    pub value: f64,
    /// Least.
    pub low: f64,
    /// Greatest.
    pub high: f64,
    /// How it is varied.
    pub varied: Varied,
}

/// How a number is varied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Varied {
    /// By factors.
    Factor,
    /// By angles.
    Angle,
}

/// Exponents that are sensible.
const EXPONENTS: (f64, f64) = (0.1, 4.0);
/// Scales of the speed in which a bend shows, parts of the scale that the library starts from.
const SCALES: (f64, f64) = (0.02, 10.0);
/// Widths of a bump.
const WIDTHS: (f64, f64) = (0.01, 4.0);
/// Distances that a state follows, rad.
pub const DISTANCES: (f64, f64) = (1e-3, 10.0);

impl Speed {
    /// At a speed, rad/s.
    pub fn at(self, w: f64) -> f64 {
        let size = w.abs();
        let sign = if w == 0.0 { 0.0 } else { w.signum() };
        let signed = |odd: bool| if odd { sign } else { 1.0 };
        match self {
            Speed::One => 1.0,
            Speed::Sign => sign,
            Speed::Plain { reference } => w / reference,
            Speed::Power {
                exponent,
                odd,
                reference,
            } => signed(odd) * libm::pow(size / reference, exponent),
            Speed::Decay { scale, odd } => signed(odd) * libm::exp(-size / scale),
            Speed::Hump { exponent, scale } => {
                sign * libm::pow(size / scale, exponent) * libm::exp(-size / scale)
            }
            Speed::Eddy { scale } => (w / scale) / (1.0 + (w / scale) * (w / scale)),
            Speed::Saturating { scale } => w / (scale + size),
            Speed::Tanh { scale } => libm::tanh(w / scale),
            Speed::OneSided {
                exponent,
                forward,
                reference,
            } => {
                let ahead = if forward { w } else { -w };
                libm::pow(ahead.max(0.0) / reference, exponent)
            }
            Speed::Above { threshold } => {
                if size > threshold {
                    sign
                } else {
                    0.0
                }
            }
            Speed::Beyond { threshold } => sign * (size / threshold - 1.0).max(0.0),
        }
    }

    /// Its numbers, each with its range.
    fn shapes(&mut self) -> impl Iterator<Item = (&mut f64, (f64, f64))> {
        let (exponent, scale) = match self {
            Speed::Power { exponent, .. } | Speed::OneSided { exponent, .. } => {
                (Some(exponent), None)
            }
            Speed::Hump { exponent, scale } => (Some(exponent), Some(scale)),
            Speed::Decay { scale, .. }
            | Speed::Eddy { scale }
            | Speed::Saturating { scale }
            | Speed::Tanh { scale }
            | Speed::Above { threshold: scale }
            | Speed::Beyond { threshold: scale } => (None, Some(scale)),
            Speed::One | Speed::Sign | Speed::Plain { .. } => (None, None),
        };
        let scale = scale.map(|scale| {
            let range = (SCALES.0 * *scale, SCALES.1 * *scale);
            (scale, range)
        });
        exponent.map(|p| (p, EXPONENTS)).into_iter().chain(scale)
    }
}

impl Load {
    /// Whether it goes with the commands before.
    pub fn remembers(self) -> bool {
        matches!(self, Load::Slewed { .. } | Load::Lagging { .. })
    }

    /// Along the currents or the commands, V, of intervals so many seconds long.
    fn along(self, volts: &[f64], seconds: &[f64]) -> Vec<f64> {
        let each = |at: &dyn Fn(f64) -> f64| volts.iter().map(|&i| at(i)).collect();
        match self {
            Load::One => each(&|_| 1.0),
            Load::Plain => each(&|i| i),
            Load::Size => each(&f64::abs),
            Load::Power {
                exponent,
                odd,
                reference,
            } => each(&|i| {
                let sign = if odd && i < 0.0 { -1.0 } else { 1.0 };
                sign * libm::pow(i.abs() / reference, exponent)
            }),
            Load::Saturating { scale } => each(&|i| i / (scale + i.abs())),
            Load::Slewed { rate } => behind(volts, seconds, |missing, seconds| {
                let full = (missing.abs() / rate).min(seconds);
                let left = missing - missing.signum() * rate * full;
                let sum = 0.5 * full * (missing + left) + (seconds - full) * left;
                (left, sum)
            }),
            Load::Lagging { time } => behind(volts, seconds, |missing, seconds| {
                let left = missing * libm::exp(-seconds / time);
                (left, time * (missing - left))
            }),
        }
    }

    fn shape(&mut self) -> Option<(&mut f64, (f64, f64))> {
        match self {
            Load::Power { exponent, .. } => Some((exponent, EXPONENTS)),
            Load::Saturating { scale }
            | Load::Slewed { rate: scale }
            | Load::Lagging { time: scale } => {
                let range = (SCALES.0 * *scale, SCALES.1 * *scale);
                Some((scale, range))
            }
            Load::One | Load::Plain | Load::Size => None,
        }
    }
}

/// How far a drive is behind the command, as a mean over each interval, less than zero where the command is the larger: from what it
/// lacks, V, at an interval's begin and the interval's length to what it lacks at the end, and the integral between.
fn behind(command: &[f64], seconds: &[f64], follows: impl Fn(f64, f64) -> (f64, f64)) -> Vec<f64> {
    let mut drive = 0.0;
    let pairs = command.iter().zip(seconds);
    pairs
        .map(|(&command, &seconds)| {
            let (left, sum) = follows(command - drive, seconds);
            drive = command - left;
            if seconds > 0.0 { -sum / seconds } else { -left }
        })
        .collect()
}

impl Term {
    /// A torque without amplitudes.
    pub fn torque(speed: Speed, load: Load) -> Self {
        Term {
            place: Place::Torque,
            speed,
            load,
            order: None,
            bump: None,
            memory: None,
            amplitudes: vec![0.0],
        }
    }

    /// An inertia that goes with cosine and sine of a multiple of the angle.
    pub fn inertia(order: u32) -> Self {
        Term {
            place: Place::Inertia,
            ..Term::torque(Speed::One, Load::One).by_angle(order)
        }
    }

    /// The same, going with cosine and sine of a multiple of the angle.
    pub fn by_angle(self, order: u32) -> Self {
        Term {
            order: Some(order),
            amplitudes: vec![0.0; 2],
            ..self
        }
    }

    /// The same at one place of the revolution.
    pub fn at_place(self, place: f64, width: f64) -> Self {
        Term {
            bump: Some(Bump { place, width }),
            ..self
        }
    }

    /// The same, going with the state.
    pub fn with_memory(self, distance: f64, squared: bool) -> Self {
        Term {
            memory: Some(Memory { distance, squared }),
            ..self
        }
    }

    /// The factors along a motion, one for each amplitude.
    pub fn factors(&self, motion: &Motion) -> Vec<Vec<f64>> {
        let load = match self.place {
            Place::Torque | Place::Drop | Place::Inertia => &motion.current,
            Place::Voltage => &motion.command,
        };
        let load = self.load.along(load, &motion.seconds);
        let pairs = motion.speed.iter().zip(load);
        let mut product: Vec<f64> = pairs.map(|(&w, load)| self.speed.at(w) * load).collect();
        if let Some(memory) = self.memory {
            for (value, z) in product.iter_mut().zip(along(motion, memory.distance)) {
                *value *= if memory.squared { z * z } else { z };
            }
        }
        if let Some(Bump { place, width }) = self.bump {
            for (value, angle) in product.iter_mut().zip(&motion.angle) {
                *value *= libm::exp((libm::cos(angle - place) - 1.0) / width);
            }
        }
        let Some(order) = self.order else {
            return vec![product];
        };
        let order = f64::from(order);
        let waves = [libm::cos, libm::sin];
        let times = |wave: fn(f64) -> f64| {
            let pairs = product.iter().zip(&motion.angle);
            pairs
                .map(|(value, angle)| value * wave(order * angle))
                .collect()
        };
        waves.into_iter().map(times).collect()
    }

    fn shapes_mut(&mut self) -> impl Iterator<Item = (&mut f64, (f64, f64), Varied)> {
        let (place, width) = match &mut self.bump {
            Some(bump) => (Some(&mut bump.place), Some((&mut bump.width, WIDTHS))),
            None => (None, None),
        };
        let memory = self.memory.as_mut().map(|m| (&mut m.distance, DISTANCES));
        let factors = self.speed.shapes().chain(self.load.shape()).chain(memory);
        let factors = factors.chain(width);
        let factors = factors.map(|(value, range)| (value, range, Varied::Factor));
        let place = place.map(|place| {
            let range = (*place - PI, *place + PI);
            (place, range, Varied::Angle)
        });
        factors.chain(place)
    }

    /// The numbers that shape it.
    pub fn shapes(&self) -> Vec<Shape> {
        let mut copy = self.clone();
        let shapes = copy.shapes_mut();
        shapes
            .map(|(value, (low, high), varied)| Shape {
                value: *value,
                low,
                high,
                varied,
            })
            .collect()
    }

    /// The same with other numbers.
    pub fn shaped(&self, values: &[f64]) -> Self {
        let mut copy = self.clone();
        for ((own, ..), value) in copy.shapes_mut().zip(values) {
            *own = *value;
        }
        copy
    }

    /// Whether another differs by its numbers alone.
    pub fn is_alike(&self, other: &Term) -> bool {
        let own = self.shapes().len();
        let ones = vec![1.0; own];
        let plain = |term: &Term| Term {
            amplitudes: Vec::new(),
            ..term.shaped(&ones)
        };
        own == other.shapes().len() && plain(self) == plain(other)
    }

    /// Whether it depends on the current.
    pub fn sees_the_current(&self) -> bool {
        self.place == Place::Torque && self.load != Load::One
    }

    /// The same as a drop of the winding: a torque that goes with the current and not with the motion's direction is that, but for how late
    /// the current follows. `None` of other terms.
    pub fn as_drop(&self) -> Option<Term> {
        let of_the_current = self.speed == Speed::One && self.sees_the_current();
        (of_the_current && self.memory.is_none()).then(|| Term {
            place: Place::Drop,
            ..self.clone()
        })
    }

    /// Whether an effect of the catalogue says all of it, whatever its numbers: Coulomb friction, or a constant torque.
    pub fn is_in_the_catalogue(&self) -> bool {
        let plain = matches!(self.speed, Speed::One | Speed::Sign) && self.load == Load::One;
        let everywhere = self.order.is_none() && self.bump.is_none();
        plain && self.place == Place::Torque && everywhere && self.memory.is_none()
    }

    /// Whether it is a friction: with the direction of the motion, of one sign, and not vanishing at rest.
    pub fn is_dry(&self) -> bool {
        let dry = match self.speed {
            Speed::Sign | Speed::Decay { odd: true, .. } => true,
            Speed::Power { exponent, odd, .. } => odd && exponent < 1.0,
            _ => false,
        };
        let even = match self.load {
            Load::One | Load::Size => true,
            Load::Power { odd, .. } => !odd,
            Load::Plain | Load::Saturating { .. } | Load::Slewed { .. } | Load::Lagging { .. } => {
                false
            }
        };
        dry && even && self.place == Place::Torque && self.memory.is_none()
    }
}
