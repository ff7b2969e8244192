//! Lines of the missing volts in the angle, forward and backward apart: a torque of the magnets stands at the
//! same angles in both directions.

use crate::fit::scores::EquationResidual;
use servoid_engine::problem::Data;

/// Highest order that is looked for.
const HIGHEST: usize = 128;
/// A line is taken where it turns by less than this many radians within the filter's time.
const FASTEST: f64 = 0.35;
/// Fewest samples slow enough for a line to count.
const FEWEST: f64 = 200.0;

/// One line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Waves a revolution.
    pub order: usize,
    /// Amplitude, V.
    pub volts: f64,
    /// Angle of its first crest, degrees of the wave.
    pub phase_deg: f64,
    /// Part of the missing volts' square that it explains where it can be seen, friction taken off.
    pub share: f64,
}

/// All lines of each direction, strongest first.
#[derive(Clone, Debug, Default)]
pub struct Spectrum {
    /// In forward motion.
    pub forward: Vec<Line>,
    /// In backward motion.
    pub backward: Vec<Line>,
}

impl Spectrum {
    /// The lines of `residuals`, which were filtered with `time` (s).
    pub fn new(data: &Data, residuals: &[EquationResidual], time: f64) -> Self {
        let of = |sign: f64| lines(data, residuals, time, sign);
        Spectrum {
            forward: of(1.0),
            backward: of(-1.0),
        }
    }

    /// The line of this order in both directions.
    pub fn both(&self, order: usize) -> Option<(Line, Line)> {
        let find = |lines: &[Line]| lines.iter().find(|line| line.order == order).copied();
        Some((find(&self.forward)?, find(&self.backward)?))
    }
}

fn lines(data: &Data, residuals: &[EquationResidual], time: f64, sign: f64) -> Vec<Line> {
    let moving: Vec<&EquationResidual> = residuals
        .iter()
        .filter(|r| r.speed * sign > super::bins::REST * data.units.speed)
        .collect();
    let mean = moving.iter().map(|r| r.volts).sum::<f64>() / moving.len().max(1) as f64;
    // Positions within the revolution, not since the start.
    let first = data.centre(0) / data.units.counts_per_rev * core::f64::consts::TAU;
    let mut sums = vec![[0.0f64; 4]; HIGHEST + 1];
    for r in moving {
        let (sine, cosine) = libm::sincos(r.angle + first);
        let volts = r.volts - mean;
        let (mut c, mut s) = (1.0, 0.0);
        let reach = (FASTEST / (r.speed.abs() * time).max(1e-9)) as usize;
        for sums in sums.iter_mut().take(HIGHEST.min(reach) + 1).skip(1) {
            (c, s) = (c * cosine - s * sine, s * cosine + c * sine);
            sums[0] += volts * c;
            sums[1] += volts * s;
            sums[2] += volts * volts;
            sums[3] += 1.0;
        }
    }
    let mut lines: Vec<Line> = sums
        .iter()
        .enumerate()
        .filter(|(_, sums)| sums[3] > FEWEST && sums[2] > 0.0)
        .map(|(order, [c, s, squares, n])| {
            let (c, s) = (2.0 * c / n, 2.0 * s / n);
            Line {
                order,
                volts: libm::hypot(c, s),
                phase_deg: libm::atan2(s, c).to_degrees(),
                share: (0.5 * n * (c * c + s * s) / squares).min(1.0),
            }
        })
        .collect();
    lines.sort_by(|a, b| b.share.total_cmp(&a.share));
    lines
}
