//! The values of a model, and the coordinates in which they are searched.

use super::terms::{Delays, Terms};

/// Least intensity of the process noise, V·√s: far below what any recording shows.
const LEAST_PROCESS_NOISE: f64 = 1e-7;
/// Longest delay, s.
const LONGEST_DELAY_S: f64 = 0.15;

/// A model with all its numbers, SI. Behind a current loop volts are amperes.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameters {
    /// Inertia `a` = `J·R/Kt`, V·s²/rad; the electrical time constant is neglected.
    pub inertia: f64,
    /// Back-EMF and viscous friction `b`, V·s/rad.
    pub damping: f64,
    /// By how much `b` is larger forward and smaller backward, V·s/rad.
    pub asymmetry: f64,
    /// Coulomb friction `c`, V.
    pub coulomb: f64,
    /// Offset that adds to the command, V.
    pub offset: f64,
    /// Gravity by sine and cosine of the angle from the first reading, V, against the motion.
    pub gravity: [f64; 2],
    /// Delay of each recording, s.
    pub delays: Vec<f64>,
    /// Intensity of the white torque noise referred to the winding, V·√s.
    pub process_noise: f64,
    /// Standard deviation of readings beyond quantisation, rad.
    pub reading_noise: f64,
}

impl Parameters {
    /// `b` while turning forward and backward.
    pub(super) fn directed_damping(&self) -> [f64; 2] {
        [self.damping + self.asymmetry, self.damping - self.asymmetry]
    }

    /// Inertia over damping, s.
    pub fn time_constant(&self) -> f64 {
        self.inertia / self.damping.max(f64::MIN_POSITIVE)
    }
}

/// One number that is searched for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinate {
    /// See [`Parameters::inertia`].
    Inertia,
    /// See [`Parameters::damping`].
    Damping,
    /// See [`Parameters::coulomb`].
    Coulomb,
    /// See [`Parameters::offset`].
    Offset,
    /// See [`Parameters::asymmetry`].
    Asymmetry,
    /// See [`Parameters::gravity`]: of the sine, or of the cosine.
    Gravity(usize),
    /// See [`Parameters::delays`]: of all recordings, where they share it.
    CommonDelay,
    /// See [`Parameters::delays`]: of one recording.
    Delay(usize),
    /// See [`Parameters::process_noise`].
    ProcessNoise,
    /// See [`Parameters::reading_noise`].
    ReadingNoise,
}

use Coordinate as C;

impl Coordinate {
    /// Those of a model of so many recordings.
    pub(super) fn all(terms: Terms, delays: Delays, recordings: usize) -> Vec<Coordinate> {
        let mut all = vec![C::Inertia, C::Damping];
        all.extend(terms.coulomb.then_some(C::Coulomb));
        all.extend(terms.offset.then_some(C::Offset));
        all.extend(terms.asymmetric_viscous.then_some(C::Asymmetry));
        if terms.gravity {
            all.extend([C::Gravity(0), C::Gravity(1)]);
        }
        match (terms.delay, delays) {
            (false, _) => {}
            (true, Delays::Common) => all.push(C::CommonDelay),
            (true, Delays::Each) => all.extend((0..recordings).map(C::Delay)),
        }
        all.extend([C::ProcessNoise, C::ReadingNoise]);
        all
    }

    /// Whether it is searched by its logarithm.
    fn is_logarithmic(self) -> bool {
        matches!(self, C::Inertia | C::ProcessNoise | C::ReadingNoise)
    }

    /// Whether it is an intensity of noise.
    pub(super) fn is_noise(self) -> bool {
        matches!(self, C::ProcessNoise | C::ReadingNoise)
    }

    /// Whether it is a delay.
    pub(super) fn is_delay(self) -> bool {
        matches!(self, C::CommonDelay | C::Delay(_))
    }

    /// Its value.
    pub fn get(self, p: &Parameters) -> f64 {
        match self {
            C::Inertia => p.inertia,
            C::Damping => p.damping,
            C::Coulomb => p.coulomb,
            C::Offset => p.offset,
            C::Asymmetry => p.asymmetry,
            C::Gravity(k) => p.gravity[k],
            C::CommonDelay => p.delays.first().copied().unwrap_or(0.0),
            C::Delay(k) => p.delays[k],
            C::ProcessNoise => p.process_noise,
            C::ReadingNoise => p.reading_noise,
        }
    }

    /// Sets its value.
    pub(super) fn set(self, p: &mut Parameters, value: f64) {
        match self {
            C::Inertia => p.inertia = value,
            C::Damping => p.damping = value,
            C::Coulomb => p.coulomb = value,
            C::Offset => p.offset = value,
            C::Asymmetry => p.asymmetry = value,
            C::Gravity(k) => p.gravity[k] = value,
            C::CommonDelay => p.delays.fill(value),
            C::Delay(k) => p.delays[k] = value,
            C::ProcessNoise => p.process_noise = value,
            C::ReadingNoise => p.reading_noise = value,
        }
    }
}

/// The unit of each coordinate, so that a step of one is a moderate change, and its bounds.
#[derive(Clone, Debug)]
pub(super) struct Scale {
    /// Size of one unit: a part for what is searched by its logarithm, else SI.
    pub(super) unit: f64,
    /// Step of finite differences, units.
    pub(super) difference: f64,
    least: f64,
    most: f64,
}

impl Scale {
    /// For a model near `p` under commands up to `largest` V, read every `interval_s` with resolution `lsb` rad.
    pub(super) fn new(
        c: Coordinate,
        p: &Parameters,
        largest: f64,
        interval_s: f64,
        lsb: f64,
    ) -> Self {
        const EVERYWHERE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);
        let inertia = p.inertia;
        let (unit, (least, most)) = match c {
            C::Inertia => (0.05, (1e-4 * inertia, 1e4 * inertia)),
            C::Damping => (
                0.03 * p.damping.abs().max(1e-9),
                (1e-4 * p.damping, f64::INFINITY),
            ),
            C::Asymmetry => (
                0.03 * p.damping.abs().max(1e-9),
                (-0.9 * p.damping, 0.9 * p.damping),
            ),
            C::Coulomb => (4e-3 * largest, (0.0, largest)),
            C::Offset => (2e-3 * largest, EVERYWHERE),
            C::Gravity(_) => (0.02 * largest, EVERYWHERE),
            C::CommonDelay | C::Delay(_) => (3e-4, (0.0, LONGEST_DELAY_S)),
            C::ProcessNoise => (0.2, (LEAST_PROCESS_NOISE * largest, largest * 1e2)),
            C::ReadingNoise => (0.2, (1e-3 * lsb, 1e4 * lsb)),
        };
        let difference = if c.is_delay() {
            // Within one sample, where the mean is straight.
            (0.02 * interval_s).clamp(1e-6, 5e-5) / unit
        } else {
            0.02
        };
        Scale {
            unit,
            difference,
            least,
            most,
        }
    }

    /// Moves a coordinate by so many units, within its bounds; how far it moved.
    pub(super) fn moved(&self, c: Coordinate, p: &mut Parameters, units: f64) -> f64 {
        let was = c.get(p);
        let wanted = if c.is_logarithmic() {
            was * libm::exp(units * self.unit)
        } else {
            was + units * self.unit
        };
        let is = wanted.clamp(self.least, self.most);
        c.set(p, is);
        if c.is_logarithmic() {
            libm::log(is / was) / self.unit
        } else {
            (is - was) / self.unit
        }
    }

    /// Change of the value with one unit.
    pub(super) fn slope(&self, c: Coordinate, p: &Parameters) -> f64 {
        if c.is_logarithmic() {
            self.unit * c.get(p)
        } else {
            self.unit
        }
    }

    /// Whether the value stands at its lower bound.
    pub(super) fn at_least(&self, c: Coordinate, p: &Parameters) -> bool {
        c.get(p) <= self.least * (1.0 + 1e-9)
    }
}
