//! The resistance from a measured current.

use super::physical::Estimate;
use super::sensitivity::SEGMENTS;
use servoid_engine::problem::{Candidate, Data};
use servoid_engine::simulation::{Method, Simulation};
use servoid_io::recording::Drive;

/// A reading at an end of all readings is the sensor's end, and no measurement, where the model has by this part more current.
const BEYOND: f64 = 0.05;
/// Rounds until those are found: each leaves out what the one before has made visible.
const ROUNDS: usize = 20;

/// Resistance from a measured current, Ω. `None` without a current, or where it says little.
pub fn resistance(data: &Data, candidate: &Candidate, method: Method) -> Option<Estimate> {
    let measured = data
        .current_a
        .as_ref()
        .filter(|_| data.drive == Drive::Voltage)?;
    let simulation = Simulation::new(data, candidate, method).ok()?;
    let found = regressed(&simulation.currents(data.centre(0)), measured)?;
    (found.std < 0.3 * found.value).then_some(found)
}

/// The model's `R·i` has no noise, the sensor's `i` has: so `i` is regressed on `R·i`, with a free zero, and the slope is `1/R`.
/// A sensor that cannot show more than so many amperes would make the slope less: readings at its end are left out.
fn regressed(volts: &[f64], measured: &[f64]) -> Option<Estimate> {
    let ends = measured
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &i| {
            [low.min(i), high.max(i)]
        });
    let mut used = vec![true; measured.len()];
    for _ in 0..ROUNDS {
        let line = Line::through(volts, measured, &used)?;
        let beyond =
            |v: f64, i: f64| ends.contains(&i) && (line.at(v) - i) * i.signum() > BEYOND * i.abs();
        let mut found = false;
        for ((used, &v), &i) in used.iter_mut().zip(volts).zip(measured) {
            if *used && beyond(v, i) {
                (*used, found) = (false, true);
            }
        }
        if !found {
            return Some(line.resistance(volts, measured, &used));
        }
    }
    None
}

/// `i` over `R·i`.
struct Line {
    centre: [f64; 2],
    squares: f64,
    slope: f64,
}

impl Line {
    fn through(volts: &[f64], measured: &[f64], used: &[bool]) -> Option<Self> {
        let pairs = || {
            let rows = volts.iter().zip(measured).zip(used);
            rows.filter(|&(_, &used)| used).map(|((&v, &i), _)| (v, i))
        };
        let n = pairs().count() as f64;
        let centre = [
            pairs().map(|(v, _)| v).sum::<f64>() / n,
            pairs().map(|(_, i)| i).sum::<f64>() / n,
        ];
        let off = || pairs().map(|(v, i)| (v - centre[0], i - centre[1]));
        let squares: f64 = off().map(|(v, _)| v * v).sum();
        let slope = off().map(|(v, i)| v * i).sum::<f64>() / squares;
        (slope > 0.0 && slope.is_finite()).then_some(Line {
            centre,
            squares,
            slope,
        })
    }

    fn at(&self, volts: f64) -> f64 {
        self.centre[1] + self.slope * (volts - self.centre[0])
    }

    /// Errors that are correlated over time count once a segment, as for the other parameters.
    fn resistance(&self, volts: &[f64], measured: &[f64], used: &[bool]) -> Estimate {
        let rows: Vec<_> = volts.iter().zip(measured).zip(used).collect();
        let segments = rows.chunks(rows.len().div_ceil(SEGMENTS).max(1));
        let middle: f64 = segments
            .map(|rows| {
                let errors = rows
                    .iter()
                    .filter(|&&(_, &used)| used)
                    .map(|&((&v, &i), _)| (v - self.centre[0]) * (i - self.at(v)));
                errors.sum::<f64>().powi(2)
            })
            .sum();
        Estimate {
            value: 1.0 / self.slope,
            std: middle.sqrt() / self.squares / self.slope.powi(2),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Currents of one ohm and a half: short peaks above long slow waves.
    fn volts() -> Vec<f64> {
        (0..4000)
            .map(|k| {
                let wave = (k as f64 * 0.01).sin();
                let peak = if k % 200 < 4 {
                    40.0 / (1.0 + f64::from(k % 200))
                } else {
                    0.0
                };
                wave + peak * wave.signum()
            })
            .collect()
    }

    #[test]
    fn where_the_sensor_ends_does_not_matter() {
        let volts = volts();
        for end in [f64::INFINITY, 20.0, 10.0, 5.0, 2.0] {
            // In steps of eight milliamperes, off by fifty.
            let shown = |v: &f64| ((v / 1.5 + 0.05) / 0.008).round() * 0.008;
            let measured: Vec<f64> = volts.iter().map(|v| shown(v).clamp(-end, end)).collect();
            let found = regressed(&volts, &measured).expect("found");
            assert!(
                (found.value - 1.5).abs() < 1e-3 && found.std < 1e-3,
                "{found:?} with an end at {end} A"
            );
        }
    }

    #[test]
    fn a_current_that_goes_the_wrong_way_is_no_resistance() {
        let volts = volts();
        let measured: Vec<f64> = volts.iter().map(|v| -v).collect();
        assert_eq!(regressed(&volts, &measured), None);
        assert_eq!(regressed(&volts, &vec![0.0; volts.len()]), None);
        assert_eq!(regressed(&[], &[]), None);
    }
}
