//! The counter misses counts.

use super::{Effect, Kind, Param};
use crate::Chance;
use std::f64::consts::TAU;

/// Bursts of lost counts arrive at random (Poisson), the more often the faster the shaft turns: at
/// r·|ω|/ω0 per second, with ω0 the machine's top speed. A burst loses 1 … N counts, all sizes alike, in the
/// direction of motion, and they stay lost.
struct MissedCounts {
    rate_per_rad: f64,
    largest: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "missed_counts",
    about: "now and then the counter loses some counts for good",
    electrical: None,
    params: &[
        Param {
            name: "rate",
            unit: "1/s",
            about: "bursts per second r at top speed",
            scales: true,
            range: (0.0, 1e4),
            typical: |_| 3.0,
        },
        Param {
            name: "largest",
            unit: "counts",
            about: "counts N in the largest burst",
            scales: false,
            range: (1.0, 1e6),
            typical: |_| 12.0,
        },
    ],
    other_laws: &[],
    build: |values, machine| {
        Box::new(MissedCounts {
            rate_per_rad: values[0] / machine.top_speed_rad_s(),
            largest: values[1].floor(),
        })
    },
    draw: |_, _, random| vec![("largest", random.log_uniform(4.0, 40.0).round())],
    truth: |values, machine, counts_per_rev| {
        // Mean size of a burst, and bursts per radian; they begin at no speed.
        let size = (1.0 + values[1]) / 2.0;
        let per_rad = values[0] / machine.top_speed_rad_s();
        vec![size * per_rad * TAU / f64::from(counts_per_rev), 0.0]
    },
};

impl Effect for MissedCounts {
    fn lost_counts(&self, speed: f64, dt: f64, chance: &mut Chance) -> i64 {
        let expected = self.rate_per_rad * speed.abs() * dt;
        let lost = chance.uniform() < -(-expected).exp_m1();
        let size = 1 + (chance.uniform() * self.largest) as i64;
        if !lost {
            0
        } else if speed > 0.0 {
            size
        } else {
            -size
        }
    }
}
