//! Waves of the missing volts in the shaft's angle, forward and backward apart.
//!
//! The residual is filtered by four lags of time `T`, and the angle with it. Of a wave of order `k` at speed `ω`, with
//! `x = k·ω·T`, the filter leaves `(1 + x²)⁻²`, late by `4·atan x`, and it shows the angle late by `4·ω·T`. Both are put
//! into the wave that is looked for, so that quicker waves are seen, too. That holds for even speeds: where a wave makes
//! the shaft itself uneven, its size comes out up to a quarter too small. Waves for which the shaft was never slow
//! enough are not seen.

use servoid_engine::problem::{Candidate, Data};
use servoid_identify::fit::scores::{EquationResidual, equation_residuals};
use servoid_identify::residual_analysis::{Line, Spectrum};
use std::f64::consts::TAU;

/// Highest order that is looked for.
const HIGHEST: usize = 128;
/// Filter time of the residual, sample intervals.
const FILTER_SAMPLES: f64 = 3.0;
/// Lags of the filter.
const LAGS: i32 = 4;
/// Largest `x`: of faster waves too little is left.
const FASTEST: f64 = 1.0;
/// Slower than this part of the fastest counts as rest, where friction answers whatever the wave asks for.
const REST: f64 = 0.01;
/// Fewest samples for a wave to count.
const FEWEST: usize = 200;
/// Fewest turns that must have been seen for it, so that it is not one bump of the road.
const FEWEST_TURNS: f64 = 0.5;

/// The waves in what `candidate` misses, those that explain most first.
pub(super) fn waves(data: &Data, candidate: &Candidate) -> Spectrum {
    let time = FILTER_SAMPLES * data.units.interval;
    let residuals = equation_residuals(data, candidate, time);
    // Positions within the revolution, not since the start.
    let first = data.centre(0) / data.units.counts_per_rev * TAU;
    let of = |sign: f64| {
        let moving: Vec<&EquationResidual> = (residuals.iter())
            .filter(|r| r.speed * sign > REST * data.units.speed)
            .collect();
        lines(&moving, first, time, data.units.interval)
    };
    Spectrum {
        forward: of(1.0),
        backward: of(-1.0),
    }
}

/// Normal equations of one wave.
#[derive(Clone, Copy, Default)]
struct Sums {
    cc: f64,
    cs: f64,
    ss: f64,
    cv: f64,
    sv: f64,
    vv: f64,
    count: usize,
    turned: f64,
}

fn lines(moving: &[&EquationResidual], first: f64, time: f64, interval: f64) -> Vec<Line> {
    let mean = moving.iter().map(|r| r.volts).sum::<f64>() / moving.len().max(1) as f64;
    let mut sums = [Sums::default(); HIGHEST + 1];
    for r in moving {
        let volts = r.volts - mean;
        let step = r.speed * time;
        let reach = (FASTEST / step.abs().max(1e-9)) as usize;
        for (order, sums) in sums
            .iter_mut()
            .enumerate()
            .take(HIGHEST.min(reach) + 1)
            .skip(1)
        {
            let order = order as f64;
            let x = order * step;
            let late = f64::from(LAGS) * (x - x.atan());
            let left = (1.0 + x * x).powi(-LAGS / 2);
            let (sine, cosine) = (order * (r.angle + first) + late).sin_cos();
            let (c, s) = (left * cosine, left * sine);
            sums.cc += c * c;
            sums.cs += c * s;
            sums.ss += s * s;
            sums.cv += c * volts;
            sums.sv += s * volts;
            sums.vv += volts * volts;
            sums.count += 1;
            sums.turned += r.speed.abs() * interval / TAU;
        }
    }
    let all = sums.iter().enumerate().skip(1);
    let mut lines: Vec<Line> = all.filter_map(|(order, sums)| sums.line(order)).collect();
    lines.sort_by(|a, b| b.share.total_cmp(&a.share));
    lines
}

impl Sums {
    fn line(&self, order: usize) -> Option<Line> {
        let determinant = self.cc * self.ss - self.cs * self.cs;
        let seen = self.count > FEWEST && self.turned > FEWEST_TURNS;
        if !(seen && self.vv > 0.0 && determinant > 0.0) {
            return None;
        }
        let c = (self.cv * self.ss - self.sv * self.cs) / determinant;
        let s = (self.sv * self.cc - self.cv * self.cs) / determinant;
        let share = ((c * self.cv + s * self.sv) / self.vv).clamp(0.0, 1.0);
        Some(Line {
            order,
            volts: c.hypot(s),
            phase_deg: s.atan2(c).to_degrees(),
            share,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servoid_identify::truth;
    use servoid_io::showcase;
    use servoid_plant::{Hidden, Machine};
    use shared::effects::EffectSet;

    #[test]
    fn the_order_of_cogging_is_the_strongest_line_in_both_directions_with_its_size() {
        let motor = Machine::gearmotor();
        for order in [3, 7, 12] {
            let spec = format!("cogging:order={order}");
            let hidden = Hidden::parse(&spec, &motor).expect("an effect");
            let recording =
                showcase::record(std::slice::from_ref(&hidden), 1, &spec).expect("a recording");
            let data = Data::new(&recording).expect("data");
            let candidate = Candidate {
                machine: truth::physical(&motor).machine(),
                effects: EffectSet::default(),
                start_speed: 0.0,
                start_offset: 0.0,
            };
            let found = waves(&data, &candidate);
            let values = hidden.truth(&motor, showcase::COUNTS_PER_REV);
            let size = values[0].hypot(values[1]);
            for lines in [&found.forward, &found.backward] {
                let strongest: Vec<_> = lines.iter().take(4).collect();
                let line = lines.first().expect("lines");
                assert_eq!(line.order, order, "{strongest:?}");
                assert!(
                    (line.volts / size - 1.0).abs() < 0.25,
                    "{size} V: {strongest:?}"
                );
            }
        }
    }
}
