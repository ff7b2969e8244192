//! What the current says as a torque: inertia and viscous friction over the torque constant.

use super::plane::Plane;
use crate::fit::physical::Estimate;
use crate::fit::uncertainty::Uncertainty;
use nalgebra::DVector;
use servoid_engine::problem::{Candidate, Data, FitProblem};
use servoid_engine::simulation::{Method, Simulation};
use servoid_io::channel::Measured;
use servoid_io::recording::Drive;

/// A reading at an end of all readings is the sensor's end, and no measurement, where the model has by this part more current.
const BEYOND: f64 = 0.05;
/// Rounds until those are found: each leaves out what the one before has made visible.
const ROUNDS: usize = 20;
/// A slope whose standard error is so large a part of it says nothing.
const UNKNOWN: f64 = 0.3;

/// Inertia and viscous friction over the torque constant.
pub struct Torque {
    /// `J/Kt`, A·s²/rad.
    pub inertia: Estimate,
    /// `f/Kt`, A·s/rad.
    pub friction: Estimate,
}

/// Inertia and viscous friction over the torque constant. `None` without a current, or where it says little of the inertia.
///
/// The torques on the shaft are `Kt·i = J·dω/dt + f·ω + T`. The model's `R·i` holds all of these but for the viscous friction that
/// it has taken for back-EMF, which depends on the speed. So the measured current is regressed on the model's `R·i`, the speed, and a
/// constant, which is the sensor's zero.
pub fn torque_evidence(
    problem: &FitProblem<'_>,
    candidate: &Candidate,
    spread: &Uncertainty,
) -> Option<Torque> {
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
        estimate.std = libm::hypot(estimate.std, variance.sqrt());
    }
    Some(found)
}

/// The same at a model, as if that were the true one.
fn at(data: &Data, candidate: &Candidate, method: Method) -> Option<Torque> {
    let measured = data
        .measured
        .get(Measured::Current)
        .filter(|_| data.drive == Drive::Voltage)?;
    let simulation = Simulation::new(data, candidate, method).ok()?;
    let model = simulation.currents_and_speeds(data.centre(0));
    let [slope, friction] = regressed(&model, measured)?;
    let machine = &candidate.machine;
    let known = slope.std < UNKNOWN * slope.value && machine.inertia > 0.0;
    known.then(|| Torque {
        inertia: Estimate {
            value: slope.value * machine.inertia,
            std: slope.std * machine.inertia,
        },
        friction: Estimate {
            value: friction.value + slope.value * machine.damping,
            std: libm::hypot(friction.std, slope.std * machine.damping),
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The viscous friction that the model takes for back-EMF, A per rad/s.
    const FRICTION: f64 = 0.01;

    /// Currents of one ohm and a half, and speeds: short peaks above long slow waves.
    fn model() -> Vec<(f64, f64)> {
        (0..4000)
            .map(|k| {
                let wave = libm::sin(k as f64 * 0.01);
                let peak = if k % 200 < 4 {
                    40.0 / (1.0 + f64::from(k % 200))
                } else {
                    0.0
                };
                (
                    wave + peak * wave.signum(),
                    30.0 * libm::cos(k as f64 * 0.01),
                )
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
