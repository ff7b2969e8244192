//! What a term makes of the current, or of the command.

use super::{EXPONENTS, SCALES};

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

impl Load {
    /// Whether it depends on the commands before.
    pub fn remembers(self) -> bool {
        matches!(self, Load::Slewed { .. } | Load::Lagging { .. })
    }

    /// Along the currents or the commands, V, of intervals so many seconds long.
    pub(super) fn along(self, volts: &[f64], seconds: &[f64]) -> Vec<f64> {
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

    pub(super) fn shape(&mut self) -> Option<(&mut f64, (f64, f64))> {
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
