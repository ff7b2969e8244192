//! The excitations to choose from: every shape at several amplitudes and rates, and short sequences of
//! them for what one shape cannot show: hot after cold, coasting after creeping, a hold after motion.

use super::excitation::{COAST, Excitation};
use shared::excite::{COMMISSIONING, COMMISSIONING_COAST, Experiment, Shape};

/// Amplitudes of single shapes, parts of the largest command.
const LEVELS: [f64; 3] = [1.0, 0.4, 0.12];
/// Amplitudes of sequences.
const SEQUENCE_LEVELS: [f64; 2] = [1.0, 0.4];
/// A triangle or reversals that creep, relative to the rest of their sequence.
const CREEP: f64 = 0.25;
/// Repetitions of a coast, in place of one long coast: short ones travel less.
const REPEATS: [usize; 3] = [5, 20, 100];
/// A reversal is held for at least this many samples: shorter ones do not reach the shaft.
const SHORTEST_HOLD_SAMPLES: f64 = 4.0;

/// Length of a candidate, and the times that scale its shapes.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Length of the whole, s.
    pub seconds: f64,
    /// Sample interval, s.
    pub sample_s: f64,
    /// Mechanical time constant of the motor, s.
    pub response_s: f64,
    /// Largest command, part of the supply.
    pub largest: f64,
}

impl Frame {
    /// Full reversals every `responses` mechanical time constants in an experiment of `seconds`.
    fn reversals(&self, responses: f64, seconds: f64) -> Shape {
        let shortest = (SHORTEST_HOLD_SAMPLES * self.sample_s).min(seconds / 2.0);
        let hold = (responses * self.response_s).clamp(shortest, seconds / 2.0);
        Shape::Reversals {
            count: (seconds / hold).round().max(2.0) as u32 - 1,
        }
    }

    fn triangle(&self, period_s: f64) -> Shape {
        Shape::Triangle {
            waves: (self.seconds / period_s).round().max(1.0) as u32,
        }
    }

    /// A sweep that stays well below half the sampling rate.
    fn chirp(&self) -> Shape {
        let to_hz = 60f64.min(0.2 / self.sample_s);
        Shape::Chirp {
            from_hz: to_hz / 120.0,
            to_hz,
        }
    }

    /// A shape, its share of the time and of the largest command.
    fn part(&self, shape: Shape, share: f64, amplitude: f64) -> Experiment {
        Experiment {
            shape,
            seconds: self.seconds * share,
            amplitude: self.largest * amplitude,
        }
    }

    /// Six levels and as many pauses, none shorter than a reversal may be, s.
    fn shortest_coast(&self) -> f64 {
        12.0 * SHORTEST_HOLD_SAMPLES * self.sample_s
    }

    /// Coasting so many times, each time from every level.
    fn coasts(&self, times: usize, amplitude: f64) -> Excitation {
        Excitation {
            parts: vec![self.part(COAST, 1.0 / times as f64, amplitude); times],
        }
    }

    /// `list` at this length and amplitude.
    pub fn stretched(&self, list: &[Experiment], amplitude: f64) -> Excitation {
        let usual: f64 = list.iter().map(|part| part.seconds).sum();
        let part = |e: &Experiment| self.part(e.shape, e.seconds / usual, e.amplitude * amplitude);
        Excitation {
            parts: list.iter().map(part).collect(),
        }
    }
}

const BRAKE: Shape = Shape::Steps { open: false };
const TELEGRAPH: Shape = Shape::Telegraph {
    levels: 7,
    hold_s: 0.08,
};

/// Every candidate for the frame.
pub fn all(frame: &Frame) -> Vec<Excitation> {
    let single = |(shape, level)| Excitation {
        parts: vec![frame.part(shape, 1.0, level)],
    };
    let mut found: Vec<Excitation> = (shapes(frame).into_iter())
        .flat_map(|shape| LEVELS.map(|level| (shape, level)))
        .map(single)
        .collect();
    for level in SEQUENCE_LEVELS {
        found.extend(sequences(frame, level));
        found.push(frame.stretched(&COMMISSIONING, level));
        found.push(frame.stretched(&COMMISSIONING_COAST, level));
        let long_enough = |times: &usize| frame.seconds / *times as f64 >= frame.shortest_coast();
        let repeats = REPEATS.into_iter().filter(long_enough);
        found.extend(repeats.map(|times| frame.coasts(times, level)));
    }
    // In a short recording of a slow motor several rates are the same.
    let mut distinct: Vec<Excitation> = Vec::with_capacity(found.len());
    for excitation in found {
        if !distinct.contains(&excitation) {
            distinct.push(excitation);
        }
    }
    distinct
}

/// Shapes that make a recording by themselves.
fn shapes(frame: &Frame) -> Vec<Shape> {
    vec![
        Shape::Step,
        BRAKE,
        COAST,
        Shape::Staircase { levels: 5 },
        frame.triangle(frame.seconds),
        frame.triangle(5.0),
        frame.triangle(1.0),
        frame.reversals(40.0, frame.seconds),
        frame.reversals(8.0, frame.seconds),
        frame.reversals(2.0, frame.seconds),
        frame.reversals(0.5, frame.seconds),
        frame.chirp(),
        TELEGRAPH,
        Shape::Multisine {
            base_hz: 0.5,
            lines: 20,
        },
    ]
}

/// Two or three shapes in turn.
fn sequences(frame: &Frame, level: f64) -> Vec<Excitation> {
    let creep = Shape::Triangle { waves: 1 };
    let half = frame.seconds / 2.0;
    let bursts = frame.reversals(0.5, half);
    let reversals = frame.reversals(8.0, half);
    let heating = frame.reversals(1.0, frame.seconds * 0.6);
    let lists: [&[(Shape, f64, f64)]; 12] = [
        &[(creep, 0.4, CREEP), (COAST, 0.6, 1.0)],
        &[(creep, 0.5, CREEP), (reversals, 0.5, CREEP)],
        &[
            (creep, 0.3, CREEP),
            (Shape::Rest, 0.2, 0.0),
            (COAST, 0.5, 1.0),
        ],
        &[(COAST, 0.6, 1.0), (Shape::Rest, 0.4, 0.0)],
        &[(bursts, 0.5, 1.0), (COAST, 0.5, 1.0)],
        &[(reversals, 0.5, 1.0), (COAST, 0.5, 1.0)],
        &[(frame.chirp(), 0.4, 1.0), (COAST, 0.6, 1.0)],
        &[(TELEGRAPH, 0.5, 1.0), (COAST, 0.5, 1.0)],
        &[(COAST, 0.25, 1.0), (COAST, 0.25, 0.5), (COAST, 0.5, 0.25)],
        &[
            (Shape::Staircase { levels: 5 }, 0.5, 1.0),
            (COAST, 0.5, 1.0),
        ],
        // Cold, warmed up, and the same again.
        &[(BRAKE, 0.2, 0.5), (heating, 0.6, 1.0), (BRAKE, 0.2, 0.5)],
        &[(COAST, 0.2, 0.5), (heating, 0.6, 1.0), (COAST, 0.2, 0.5)],
    ];
    let part = |&(shape, share, amplitude)| frame.part(shape, share, amplitude * level);
    lists
        .iter()
        .map(|list| Excitation {
            parts: list.iter().map(part).collect(),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_candidate_is_as_long_as_asked_and_no_command_is_larger() {
        for (seconds, sample_s, largest) in [(20.0, 1e-3, 1.0), (2.0, 1e-3, 0.3), (0.5, 5e-3, 0.7)]
        {
            let frame = Frame {
                seconds,
                sample_s,
                response_s: 0.025,
                largest,
            };
            for excitation in all(&frame) {
                let drive = excitation.drive(sample_s, 1);
                let length = drive.len() as f64 * sample_s;
                let rounding = 0.5 * sample_s * (excitation.parts.len() + 1) as f64;
                assert!(
                    (length - seconds).abs() <= rounding,
                    "{excitation}: {length}"
                );
                for command in drive {
                    assert!(command.drive.abs() <= largest, "{excitation}");
                }
            }
        }
    }

    #[test]
    fn no_two_candidates_are_the_same() {
        for response_s in [0.025, 10.0] {
            let frame = Frame {
                seconds: 20.0,
                sample_s: 1e-3,
                response_s,
                largest: 1.0,
            };
            let all = all(&frame);
            for (k, one) in all.iter().enumerate() {
                assert!(!all[..k].contains(one), "{one}");
            }
        }
    }
}
