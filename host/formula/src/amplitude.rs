//! With which parameters a law vanishes.

use crate::definition::Definition;
use crate::value::Point;
use shared::effects::formula::Output;

/// Points at which a law is tried.
const POINTS: usize = 24;
/// Differences below this part of the values are rounding.
const ROUNDING: f64 = 1e-9;

/// Which parameters are amplitudes: the law is zero where all of them are, and rises with each in proportion. Found by trial at
/// points over the ranges.
pub(crate) fn amplitudes(definition: &Definition) -> Vec<bool> {
    let points: Vec<Point> = (0..POINTS).map(point).collect();
    let starts: Vec<f64> = definition.parameters.iter().map(|p| p.start).collect();
    let mut amplitudes: Vec<bool> = (0..starts.len())
        .map(|k| {
            let (low, high) = definition.parameters[k].range;
            let step = 0.5 * high.abs().max(low.abs());
            let at = |x: f64, point: &Point| {
                let mut values = starts.clone();
                values[k] = x;
                definition.value(&values, point)
            };
            (low..=high).contains(&0.0)
                && points.iter().all(|point| {
                    let (none, one, two) = (at(0.0, point), at(step, point), at(2.0 * step, point));
                    let size = none.abs().max(one.abs()).max(two.abs());
                    (two - 2.0 * one + none).abs() <= ROUNDING * size
                })
        })
        .collect();
    let vanishes = |amplitudes: &[bool]| {
        let values: Vec<f64> = (starts.iter().zip(amplitudes))
            .map(|(start, amplitude)| if *amplitude { 0.0 } else { *start })
            .collect();
        let nothing = match definition.output {
            Output::TorqueConstant => 1.0,
            _ => 0.0,
        };
        (points.iter()).all(|point| (definition.value(&values, point) - nothing).abs() <= ROUNDING)
    };
    if !vanishes(&amplitudes) {
        return vec![false; starts.len()];
    }
    // One without which it vanishes all the same is none.
    for k in 0..amplitudes.len() {
        if amplitudes[k] {
            amplitudes[k] = false;
            if !vanishes(&amplitudes) {
                amplitudes[k] = true;
            }
        }
    }
    amplitudes
}

/// Points of the motion, spread evenly by multiples of irrational numbers.
fn point(k: usize) -> Point {
    let spread = |by: f64| 2.0 * ((k as f64 + 0.5) * by).fract() - 1.0;
    Point {
        speed: 200.0 * spread(0.618_033_988_7),
        angle: std::f64::consts::PI * (1.0 + spread(0.754_877_666_2)),
        current: 12.0 * spread(0.569_840_290_9),
        transmitted: 12.0 * spread(0.819_172_513_4),
        command: 12.0 * spread(0.671_043_606_7),
        time: 10.0 * (1.0 + spread(0.450_869_376_1)),
        temperature: 50.0 * (1.0 + spread(0.324_717_957_2)),
        states: [spread(0.549_700_477_9), spread(0.302_775_637_7)],
    }
}
