//! One term of a law: a product of simple functions of speed, current, angle and one state.

mod load;
mod speed;

pub use load::Load;
pub use speed::Speed;

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
    /// A moment of inertia that depends on the angle, as a part of the motor's; the term depends on nothing else.
    Inertia,
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

    /// An inertia that depends on cosine and sine of a multiple of the angle.
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

    /// Whether another differs by its numbers alone, beside what the motor's own back-EMF and viscous friction make up.
    pub fn is_alike(&self, other: &Term) -> bool {
        let own = self.shapes().len();
        let ones = vec![1.0; own];
        let plain = |term: &Term| {
            let mut term = term.shaped(&ones);
            term.amplitudes.clear();
            term.speed = term.speed.beside_linear();
            term
        };
        own == other.shapes().len() && plain(self) == plain(other)
    }

    /// Whether it depends on the current.
    pub fn sees_the_current(&self) -> bool {
        self.place == Place::Torque && self.load != Load::One
    }

    /// The same as a drop of the winding: a torque that depends on the current and not on the motion's direction is that, but for how late
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
