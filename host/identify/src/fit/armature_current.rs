//! What a measured armature current says: inertia and viscous friction over the torque constant.

use super::physical::{CurrentEvidence, Estimate};
use super::sensitivity::SEGMENTS;
use super::uncertainty::Uncertainty;
use nalgebra::{DVector, Matrix3, Vector3};
use servoid_engine::problem::{Candidate, Data, FitProblem};
use servoid_engine::simulation::{Method, Simulation};
use servoid_io::recording::Drive;

/// A reading at an end of all readings is the sensor's end, and no measurement, where the model has by this part more current.
const BEYOND: f64 = 0.05;
/// Rounds until those are found: each leaves out what the one before has made visible.
const ROUNDS: usize = 20;
/// A slope whose standard error is so large a part of it says nothing.
const UNKNOWN: f64 = 0.3;
/// Least part of the squared determinant that three columns of length one must span.
const SPANS: f64 = 1e-12;

/// Inertia and viscous friction over the torque constant. `None` without a current, or where it says little of the inertia.
///
/// The torques on the shaft are `Kt·i = J·dω/dt + f·ω + T`. The model's `R·i` holds all of these but for the viscous friction that
/// it has taken for back-EMF, which goes with the speed. So the measured current is regressed on the model's `R·i`, the speed, and a
/// constant, which is the sensor's zero.
pub fn current_evidence(
    problem: &FitProblem<'_>,
    candidate: &Candidate,
    spread: &Uncertainty,
) -> Option<CurrentEvidence> {
    let mut found = at(problem.data, candidate, problem.method)?;
    // It is read from the fitted model's current, and changes with that.
    let values = problem
        .structure
        .values(&problem.structure.point(candidate));
    let slopes = |k: usize| {
        let std = spread.std(k).filter(|std| *std > 0.0)?;
        // No further than the model reaches: an inductance is not negative.
        let (low, high) = problem.structure.unknowns[k].range;
        let (up, down) = ((values[k] + std).min(high), (values[k] - std).max(low));
        let moved = |to: f64| {
            let mut values = values.clone();
            values[k] = to;
            let moved = problem.structure.candidate(&values);
            let found = at(problem.data, &moved, problem.method)?;
            Some([found.inertia.value, found.friction.value])
        };
        let (above, below) = (moved(up)?, moved(down)?);
        (up > down).then(|| [0, 1].map(|n| (above[n] - below[n]) / (up - down)))
    };
    let slopes: Vec<[f64; 2]> = (0..values.len())
        .map(|k| slopes(k).unwrap_or_default())
        .collect();
    let covariance = spread.finite_covariance();
    for (n, estimate) in [&mut found.inertia, &mut found.friction]
        .into_iter()
        .enumerate()
    {
        let slopes = DVector::from_iterator(slopes.len(), slopes.iter().map(|slope| slope[n]));
        let variance = slopes.dot(&(&covariance * &slopes)).max(0.0);
        estimate.std = estimate.std.hypot(variance.sqrt());
    }
    Some(found)
}

/// The same at a model, as if that were the true one.
fn at(data: &Data, candidate: &Candidate, method: Method) -> Option<CurrentEvidence> {
    let measured = data
        .current_a
        .as_ref()
        .filter(|_| data.drive == Drive::Voltage)?;
    let simulation = Simulation::new(data, candidate, method).ok()?;
    let model = simulation.currents_and_speeds(data.centre(0));
    let [slope, friction] = regressed(&model, measured)?;
    let machine = &candidate.machine;
    let known = slope.std < UNKNOWN * slope.value && machine.inertia > 0.0;
    known.then(|| CurrentEvidence {
        inertia: Estimate {
            value: slope.value * machine.inertia,
            std: slope.std * machine.inertia,
        },
        friction: Estimate {
            value: friction.value + slope.value * machine.damping,
            std: friction.std.hypot(slope.std * machine.damping),
        },
    })
}

/// The model's `R·i` and speed have no noise, the sensor's current has: so that is regressed on them, with a free zero. A sensor that
/// cannot show more than so many amperes would make the slope less: readings at its end are left out.
///
/// Returns the slopes over `R·i`, 1/Ω, and over the speed, A·s/rad.
fn regressed(model: &[(f64, f64)], measured: &[f64]) -> Option<[Estimate; 2]> {
    let ends = measured
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &i| {
            [low.min(i), high.max(i)]
        });
    let mut used = vec![true; measured.len()];
    for _ in 0..ROUNDS {
        let plane = Plane::through(model, measured, &used)?;
        let beyond = |at: (f64, f64), i: f64| {
            ends.contains(&i) && (plane.at(at) - i) * i.signum() > BEYOND * i.abs()
        };
        let mut found = false;
        for ((used, &at), &i) in used.iter_mut().zip(model).zip(measured) {
            if *used && beyond(at, i) {
                (*used, found) = (false, true);
            }
        }
        if !found {
            return Some(plane.slopes(model, measured, &used));
        }
    }
    None
}

/// Current over `R·i` and speed.
struct Plane {
    /// Of `R·i`, V, and of the speed, rad/s, so that columns are of one size.
    scales: [f64; 2],
    inverse: Matrix3<f64>,
    slopes: Vector3<f64>,
}

impl Plane {
    fn through(model: &[(f64, f64)], measured: &[f64], used: &[bool]) -> Option<Self> {
        let size = |of: &dyn Fn(&(f64, f64)) -> f64| {
            let largest = model.iter().map(|at| of(at).abs()).fold(0.0, f64::max);
            if largest > 0.0 { largest } else { 1.0 }
        };
        let scales = [size(&|at| at.0), size(&|at| at.1)];
        let mut squares = Matrix3::zeros();
        let mut products = Vector3::zeros();
        let rows = model.iter().zip(measured).zip(used);
        for ((&at, &i), _) in rows.filter(|&(_, &used)| used) {
            let row = row(at, scales);
            squares += row * row.transpose();
            products += row * i;
        }
        let diagonal: f64 = squares.diagonal().iter().product();
        let spans = squares.determinant() > SPANS * diagonal;
        let inverse = squares.try_inverse().filter(|_| spans)?;
        let slopes = inverse * products;
        (slopes[0] > 0.0 && slopes.iter().all(|slope| slope.is_finite())).then_some(Plane {
            scales,
            inverse,
            slopes,
        })
    }

    fn at(&self, at: (f64, f64)) -> f64 {
        self.slopes.dot(&row(at, self.scales))
    }

    /// The slopes, with the larger of two standard errors: errors that are correlated over time count once a segment, as for the other
    /// parameters; and where one segment holds all that is known of the slope, each error counts alone.
    fn slopes(&self, model: &[(f64, f64)], measured: &[f64], used: &[bool]) -> [Estimate; 2] {
        let mut squares = 0.0;
        let length = measured.len().div_ceil(SEGMENTS).max(1);
        let mut gradients = vec![Vector3::zeros(); measured.len().div_ceil(length)];
        for k in (0..measured.len()).filter(|&k| used[k]) {
            let error = measured[k] - self.at(model[k]);
            gradients[k / length] += row(model[k], self.scales) * error;
            squares += error * error;
        }
        let middle: Matrix3<f64> = gradients.iter().map(|g| g * g.transpose()).sum();
        let sandwich = self.inverse * middle * self.inverse;
        let count = used.iter().filter(|&&used| used).count() as f64;
        let alone = self.inverse * (squares / (count - 3.0).max(1.0));
        [0, 1].map(|k| Estimate {
            value: self.slopes[k] / self.scales[k],
            std: sandwich[(k, k)].max(alone[(k, k)]).sqrt() / self.scales[k],
        })
    }
}

/// A row of the regression.
fn row((volts, speed): (f64, f64), scales: [f64; 2]) -> Vector3<f64> {
    Vector3::new(volts / scales[0], speed / scales[1], 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The viscous friction that the model takes for back-EMF, A per rad/s.
    const FRICTION: f64 = 0.01;

    /// Currents of one ohm and a half, and speeds: short peaks above long slow waves.
    fn model() -> Vec<(f64, f64)> {
        (0..4000)
            .map(|k| {
                let wave = (k as f64 * 0.01).sin();
                let peak = if k % 200 < 4 {
                    40.0 / (1.0 + f64::from(k % 200))
                } else {
                    0.0
                };
                (wave + peak * wave.signum(), 30.0 * (k as f64 * 0.01).cos())
            })
            .collect()
    }

    #[test]
    fn where_the_sensor_ends_does_not_matter_nor_does_friction_that_the_model_has_not() {
        let model = model();
        for end in [f64::INFINITY, 20.0, 10.0, 5.0, 2.0] {
            // In steps of eight milliamperes, off by fifty.
            let shown = |&(volts, speed): &(f64, f64)| {
                ((volts / 1.5 + FRICTION * speed + 0.05) / 0.008).round() * 0.008
            };
            let measured: Vec<f64> = model.iter().map(|at| shown(at).clamp(-end, end)).collect();
            let [slope, friction] = regressed(&model, &measured).expect("found");
            assert!(
                (slope.value * 1.5 - 1.0).abs() < 1e-3 && slope.std < 1e-3,
                "{slope:?} with an end at {end} A"
            );
            assert!(
                (friction.value / FRICTION - 1.0).abs() < 1e-2,
                "{friction:?} with an end at {end} A"
            );
        }
    }

    #[test]
    fn a_current_that_goes_the_wrong_way_is_no_resistance() {
        let model = model();
        let measured: Vec<f64> = model.iter().map(|at| -at.0).collect();
        assert_eq!(regressed(&model, &measured), None);
        assert_eq!(regressed(&model, &vec![0.0; model.len()]), None);
        assert_eq!(regressed(&[], &[]), None);
    }
}
