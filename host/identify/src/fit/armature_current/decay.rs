//! The electrical time constant that the current itself shows, from one sample to the next.
//!
//! With the voltage held over an interval, `i(h) = E·i(0) + (1 − E)/R·(u − Kb·ω)` with `E = exp(−h·R/L)`: a regression of each current
//! on the one before, the voltage and the speed (an ARX model: Ljung, *System Identification*, 2nd ed., 1999, §4.2).

use super::least_squares::LeastSquares;
use crate::fit::physical::Estimate;
use nalgebra::Vector4;

/// One interval: the current at its end, A; the current at its begin, A, the voltage, V, and the speed, rad/s.
pub type Row = (f64, [f64; 3]);

/// Part of the current that is left after an interval of `interval` seconds, as an electrical time constant, s, with the largest
/// error that its own standard error makes. `None` where the columns do not tell.
pub fn electrical(rows: &[Option<Row>], interval: f64) -> Option<Estimate> {
    let used: Vec<Row> = rows.iter().flatten().copied().collect();
    let largest = |k: usize| used.iter().map(|(_, row)| row[k].abs()).fold(0.0, f64::max);
    let scales = [0, 1, 2].map(largest);
    let column = |(_, row): &Row| {
        let [a, b, c] = [0, 1, 2].map(|k| row[k] / scales[k].max(f64::MIN_POSITIVE));
        Vector4::new(a, b, c, 1.0)
    };
    let columns: Vec<Vector4<f64>> = used.iter().map(column).collect();
    let currents: Vec<f64> = used.iter().map(|(current, _)| *current).collect();
    let fitted = LeastSquares::through(&columns, &currents, |_| true)?;
    let errors = fitted.errors(&columns, &currents);
    let variance = fitted.sandwich(&columns, &errors)[(0, 0)];
    let (decay, std) = (fitted.slopes[0] / scales[0], variance.sqrt() / scales[0]);
    let seconds = |decay: f64| {
        if decay > 0.0 {
            -interval / libm::log(decay)
        } else {
            0.0
        }
    };
    let known = decay.is_finite() && std.is_finite() && decay + std < 1.0;
    known.then(|| Estimate {
        value: seconds(decay),
        std: seconds(decay + std) - seconds(decay),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use shared::rng;

    #[test]
    fn it_is_the_one_that_made_the_currents() {
        let (resistance, kb, interval) = (2.0, 0.05, 1e-3_f64);
        for (seed, constant) in [(1, 2e-4_f64), (2, 1e-3), (3, 8e-3)] {
            let mut generator = rng::seeded(seed);
            let mut draw = || 2.0 * rng::uniform::<f64>(&mut generator) - 1.0;
            let decay = libm::exp(-interval / constant);
            let (mut current, mut volts, mut speed) = (0.0, 0.0, 0.0);
            let rows: Vec<Option<Row>> = (0..5000)
                .map(|k| {
                    if k % 20 == 0 {
                        volts = 12.0 * draw();
                    }
                    speed += 0.02 * (volts / kb - speed);
                    let before = current;
                    current = decay * before + (1.0 - decay) / resistance * (volts - kb * speed);
                    let noise = 1e-3;
                    Some((
                        current + noise * draw(),
                        [before + noise * draw(), volts, speed],
                    ))
                })
                .collect();
            let found = electrical(&rows, interval).unwrap();
            assert!(
                (found.value - constant).abs() < 4.0 * found.std + 1e-3 * constant,
                "seed {seed}, {constant}: {found:?}"
            );
            assert!(found.std < 0.05 * constant, "seed {seed}: {found:?}");
        }
    }
}
