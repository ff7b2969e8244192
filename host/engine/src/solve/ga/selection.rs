//! Which individuals become parents.

use super::Individual;
use shared::rng::{self, Generator};

/// How parents are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Selection {
    /// The best of `size` drawn with replacement. Only compares costs.
    Tournament {
        /// Number drawn; 1 means no selection pressure.
        size: usize,
    },
    /// In proportion to how far the cost lies below the worst of the population. Needs exact costs.
    Roulette,
}

impl Selection {
    /// Index of a parent in a population sorted by cost, best first.
    pub(super) fn pick(self, sorted: &[Individual], rng: &mut Generator) -> usize {
        let any = |rng: &mut Generator| rng::below(rng, sorted.len() as u32) as usize;
        match self {
            Selection::Tournament { size } => {
                let first = any(rng);
                (1..size).fold(first, |best, _| best.min(any(rng)))
            }
            Selection::Roulette => spin(sorted, rng).unwrap_or_else(|| any(rng)),
        }
    }
}

/// Roulette over the distances below the worst finite cost; `None` where all costs are alike.
fn spin(sorted: &[Individual], rng: &mut Generator) -> Option<usize> {
    let worst = sorted
        .iter()
        .rev()
        .map(|i| i.cost)
        .find(|cost| cost.is_finite())?;
    let fitness = |individual: &Individual| (worst - individual.cost).max(0.0);
    let total: f64 = sorted.iter().map(fitness).sum();
    if total <= 0.0 {
        return None;
    }
    let mut ball = rng::uniform::<f64>(rng) * total;
    sorted.iter().position(|individual| {
        ball -= fitness(individual);
        ball < 0.0
    })
}
