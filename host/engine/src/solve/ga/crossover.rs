//! How the genes of two parents mix.

use shared::rng::{self, Generator};

/// How two parents make a child.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Crossover {
    /// BLX-α: each gene uniform over the parents' interval, widened by `alpha` of it at both ends.
    Blend {
        /// Widening as a share of the interval.
        alpha: f64,
    },
    /// SBX: spread about the parents as by single-point crossover of binary numbers.
    SimulatedBinary {
        /// Distribution index; larger keeps children nearer to their parents.
        eta: f64,
    },
    /// A point on the straight line between the parents.
    Arithmetic,
}

impl Crossover {
    /// A child of `a` and `b`; its genes may lie outside `[0, 1]`.
    pub(super) fn cross(self, a: &[f64], b: &[f64], rng: &mut Generator) -> Vec<f64> {
        let common: f64 = rng::uniform(rng);
        let pairs = a.iter().zip(b);
        match self {
            Crossover::Blend { alpha } => pairs
                .map(|(a, b)| {
                    let along = rng::uniform::<f64>(rng) * (1.0 + 2.0 * alpha) - alpha;
                    a + along * (b - a)
                })
                .collect(),
            Crossover::SimulatedBinary { eta } => pairs
                .map(|(&a, &b)| simulated_binary(a, b, eta, rng))
                .collect(),
            Crossover::Arithmetic => pairs.map(|(a, b)| a + common * (b - a)).collect(),
        }
    }
}

fn simulated_binary(a: f64, b: f64, eta: f64, rng: &mut Generator) -> f64 {
    let u: f64 = rng::uniform(rng);
    let power = 1.0 / (eta + 1.0);
    let spread = if u < 0.5 {
        (2.0 * u).powf(power)
    } else {
        (0.5 / (1.0 - u)).powf(power)
    };
    let side = if rng::uniform::<f64>(rng) < 0.5 {
        0.5
    } else {
        -0.5
    };
    0.5 * (a + b) + side * spread * (a - b)
}
