//! Cosines and sines of the shaft's angle and its multiples, as the filter of the equation's residual leaves them.
//!
//! A torque that repeats with the angle acts on the shaft with its mean over each interval, `(sin kθ₁ − sin kθ₀)/(k(θ₁ − θ₀))`
//! for a cosine; and what is left of a quick wave, late and worn away, is what the same filter makes of that mean.

use super::settings::SLOW;
pub use super::settings::{HIGHEST, LANES, ROWS};
use crate::fit::filter::{Behind, Filter};
use core::array::from_fn;
use core::f64::consts::TAU;
use servoid_engine::lanes::with_vectors;
use servoid_engine::problem::Data;

/// Cosine and sine of one row of orders.
pub type Row = [[f64; LANES]; 2];
/// Those of all orders, from the first.
pub type Rows = [Row; ROWS];

/// Calls `at` with each sample and the waves there, through the filter of time `time`, s.
pub fn each_sample(data: &Data, time: f64, mut at: impl FnMut(usize, &Rows)) {
    if data.len() < 2 {
        return;
    }
    with_vectors(
        #[inline(always)]
        || {
            let filter = Filter::<LANES>::new(data, [time; LANES]);
            let turns = |k: usize| data.centre(k) / data.units.counts_per_rev;
            let multiples = |turns: f64| multiples(turns.rem_euclid(1.0) * TAU);
            let mut behind = [[Behind::<LANES>::default(); 2]; ROWS];
            let mut seen: Rows = [Row::default(); ROWS];
            let mut begins = (turns(0), multiples(turns(0)));
            let mut before: Option<Rows> = None;
            for k in 0..data.len() - 1 {
                let ends = (turns(k + 1), multiples(turns(k + 1)));
                let travel = (ends.0 - begins.0) * TAU;
                let now: Rows = from_fn(|row| means(row, &begins.1[row], &ends.1[row], travel));
                for row in 0..ROWS {
                    for wave in 0..2 {
                        let (behind, now) = (&mut behind[row][wave], &now[row][wave]);
                        if let Some(before) = &before {
                            // The wave jumps, the lags do not.
                            let before = &before[row][wave];
                            for stage in behind.iter_mut() {
                                *stage = from_fn(|lane| stage[lane] - (now[lane] - before[lane]));
                            }
                        }
                        seen[row][wave] = filter.output(behind, *now).value;
                    }
                }
                at(k, &seen);
                for behind in behind.as_flattened_mut() {
                    filter.pass(data, k, behind, [0.0; LANES]);
                }
                (begins, before) = (ends, Some(now));
            }
        },
    );
}

/// Cosines and sines of the multiples of an angle.
#[inline(always)]
fn multiples(angle: f64) -> Rows {
    let (sine, cosine) = libm::sincos(angle);
    let (mut c, mut s) = (1.0, 0.0);
    let mut rows: Rows = [Row::default(); ROWS];
    for [cosines, sines] in &mut rows {
        for lane in 0..LANES {
            (c, s) = (c * cosine - s * sine, s * cosine + c * sine);
            (cosines[lane], sines[lane]) = (c, s);
        }
    }
    rows
}

/// Means over an interval in which the shaft travels by so many radians.
#[inline(always)]
fn means(row: usize, from: &Row, to: &Row, travel: f64) -> Row {
    let ([c0, s0], [c1, s1]) = (from, to);
    let phase: [f64; LANES] = from_fn(|lane| travel * (row * LANES + lane + 1) as f64);
    let mean = |lane: usize, integral: f64, ends: f64| {
        if phase[lane].abs() > SLOW {
            integral / phase[lane]
        } else {
            0.5 * ends
        }
    };
    [
        from_fn(|lane| mean(lane, s1[lane] - s0[lane], c0[lane] + c1[lane])),
        from_fn(|lane| mean(lane, c0[lane] - c1[lane], s0[lane] + s1[lane])),
    ]
}
