//! The measured motion, as a law sees it.

use core::f64::consts::TAU;
use servoid_engine::problem::{Candidate, Data};
use shared::effects::Lowered;

/// Half the samples over which a speed is taken, and over which a reading that moves by a count at most is at rest: short against the
/// filter behind it, which averages the counts.
const HALF_WIDTH: usize = 2;

/// What a law sees in the interval that begins at each sample, as its mean. A command that jumps at the sample makes the
/// current jump: what is held over the interval has the right mean, whatever the winding's time constant.
pub struct Motion {
    /// Speed, rad/s; zero at rest.
    pub speed: Vec<f64>,
    /// Angle within the revolution, rad.
    pub angle: Vec<f64>,
    /// Volts across the resistance.
    pub current: Vec<f64>,
    /// Commanded volts.
    pub command: Vec<f64>,
    /// Length of the interval, s.
    pub seconds: Vec<f64>,
    /// Whether the shaft rests.
    pub rests: Vec<bool>,
}

impl Motion {
    /// Of a recording; the current is what the candidate's winding makes of command and speed.
    pub fn new(data: &Data, candidate: &Candidate) -> Self {
        let per_count = TAU / data.units.counts_per_rev;
        let n = data.len();
        let rests: Vec<bool> = (0..n).map(|k| rests(data, k)).collect();
        let at: Vec<f64> = (0..n)
            .map(|k| {
                if rests[k] {
                    return 0.0;
                }
                data.rate_of(&data.counts, k, HALF_WIDTH) * per_count
            })
            .collect();
        let next = |k: usize| if data.recordings.is_last(k) { k } else { k + 1 };
        let middle = |of: &dyn Fn(usize) -> f64, k: usize| 0.5 * (of(k) + of(next(k)));
        let speed: Vec<f64> = (0..n).map(|k| middle(&|k| at[k], k)).collect();
        let angle = |k: usize| (middle(&|k| data.centre(k), k) * per_count).rem_euclid(TAU);
        let seconds: Vec<f64> = (0..n)
            .map(|k| data.lengths[data.length_of[k] as usize] * data.units.interval)
            .collect();
        Motion {
            angle: (0..n).map(angle).collect(),
            current: current(data, candidate, &speed, &seconds),
            command: data.command.iter().map(|u| u * data.units.volts).collect(),
            speed,
            seconds,
            rests,
        }
    }
}

fn rests(data: &Data, k: usize) -> bool {
    let near = data.recordings.around(k, HALF_WIDTH);
    let readings = &data.counts[near];
    let low = readings.iter().copied().fold(f64::INFINITY, f64::min);
    let high = readings.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    high - low <= 1.0
}

/// A lag of the winding's time constant behind drive less back-EMF, as its mean over each interval.
fn current(data: &Data, candidate: &Candidate, speed: &[f64], seconds: &[f64]) -> Vec<f64> {
    let machine = &candidate.machine;
    let lowered = Lowered::<f64>::new(&candidate.effects, &data.units);
    let mut now = 0.0;
    (0..data.len())
        .map(|k| {
            if data.recordings.is_first(k) {
                now = 0.0;
            }
            if data.is_open(k) {
                now = 0.0;
                return 0.0;
            }
            let drive = lowered.drive(data.command[k]) * data.units.volts;
            let target = drive - machine.kb * speed[k];
            let parts = seconds[k] / machine.electrical.max(1e-9);
            let left = now - target;
            let mean = target - left * libm::expm1(-parts) / parts;
            now = target + left * libm::exp(-parts);
            mean
        })
        .collect()
}
