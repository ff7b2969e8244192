//! Genetic algorithm with real numbers for genes: the paper's third contender.
//!
//! Selection and crossover are the field's usual ones. What decides the precision that a small
//! population reaches is the mutation: a step of fixed size can only ever find the optimum to that
//! size. The breeder's mutation draws steps of all sizes, `0.5 · 2^(-precision_bits · u)` with `u`
//! uniform, so that the same setting explores and polishes. On the paper's problem (5000
//! evaluations, 300 seeds) the median cost is 3.3 with five individuals, 2.8 with twenty and 3.4 with
//! fifty, where a mutation of fixed width came to about 15. Roulette in place of the tournament did as
//! well with five (3.0), but pressed too little on fifty (107).
//!
//! Sources: D. E. Goldberg, *Genetic Algorithms in Search, Optimization, and Machine Learning*,
//! 1989; L. J. Eshelman and J. D. Schaffer, 1993, doi:10.1016/B978-0-08-094832-4.50018-0 (BLX);
//! H. Mühlenbein and D. Schlierkamp-Voosen, 1993, doi:10.1162/evco.1993.1.1.25 (the breeder's mutation).

use super::{Evaluator, Solver, Stop};
use shared::rng::{self, Generator};

/// Individuals of which the best becomes a parent, drawn with replacement.
const TOURNAMENT: usize = 3;
/// BLX-α: a child's gene is uniform over the parents' interval, widened by this part of it at both ends.
const WIDENING: f64 = 0.5;
/// Probability of a crossover; otherwise the child starts as a copy of its first parent.
const CROSSOVER_RATE: f64 = 0.9;
/// The smallest mutation is 2^-(1 + this) of a gene's range.
const PRECISION_BITS: f64 = 18.0;

/// The genetic algorithm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ga {
    /// Individuals, at least 2.
    pub population: usize,
    /// Best individuals that live on unchanged, below `population`. They are not evaluated again.
    pub elites: usize,
    /// Probability that a gene mutates; `None` for one gene a child on average.
    pub mutation_rate: Option<f64>,
}

impl Default for Ga {
    fn default() -> Self {
        Ga {
            population: 20,
            elites: 1,
            mutation_rate: None,
        }
    }
}

/// A point and its cost.
#[derive(Clone, Debug)]
struct Individual {
    genes: Vec<f64>,
    cost: f64,
}

impl Solver for Ga {
    fn name(&self) -> &'static str {
        "ga"
    }

    fn search(&self, evaluator: &mut Evaluator<'_>, seed: u64) {
        let mut rng = rng::seeded(seed);
        // The only way out is the end of the budget.
        let Err(Stop) = self.evolve(evaluator, &mut rng);
    }
}

impl Ga {
    fn evolve(
        &self,
        evaluator: &mut Evaluator<'_>,
        rng: &mut Generator,
    ) -> Result<std::convert::Infallible, Stop> {
        let size = self.population.max(2);
        let elites = self.elites.min(size - 1);
        let mut population = Vec::with_capacity(size);
        for _ in 0..size {
            let genes = (0..evaluator.dim()).map(|_| rng::uniform(rng)).collect();
            population.push(Individual::evaluated(genes, evaluator)?);
        }
        loop {
            population.sort_by(|a, b| a.cost.total_cmp(&b.cost));
            let mut children = Vec::with_capacity(size);
            for _ in elites..size {
                let genes = self.child(&population, rng);
                children.push(Individual::evaluated(genes, evaluator)?);
            }
            population.truncate(elites);
            population.append(&mut children);
        }
    }

    fn child(&self, sorted: &[Individual], rng: &mut Generator) -> Vec<f64> {
        let first = tournament(sorted, rng);
        let second = tournament(sorted, rng);
        let mut genes = if rng::uniform::<f64>(rng) < CROSSOVER_RATE {
            blend(&first.genes, &second.genes, rng)
        } else {
            first.genes.clone()
        };
        let rate = self.mutation_rate.unwrap_or(1.0 / genes.len() as f64);
        for gene in &mut genes {
            if rng::uniform::<f64>(rng) < rate {
                *gene += mutation(rng);
            }
            *gene = reflected(*gene);
        }
        genes
    }
}

impl Individual {
    fn evaluated(genes: Vec<f64>, evaluator: &mut Evaluator<'_>) -> Result<Self, Stop> {
        let cost = evaluator.evaluate(&genes)?;
        Ok(Individual { genes, cost })
    }
}

/// A parent out of a population sorted by cost, best first.
fn tournament<'p>(sorted: &'p [Individual], rng: &mut Generator) -> &'p Individual {
    let drawn = (0..TOURNAMENT).map(|_| rng::below(rng, sorted.len() as u32) as usize);
    &sorted[drawn.fold(sorted.len() - 1, usize::min)]
}

/// A child of `a` and `b`; its genes may lie outside `[0, 1]`.
fn blend(a: &[f64], b: &[f64], rng: &mut Generator) -> Vec<f64> {
    // Not used; drawn so that a seed keeps its children.
    rng::uniform::<f64>(rng);
    let child = |(a, b): (&f64, &f64)| {
        let along = rng::uniform::<f64>(rng) * (1.0 + 2.0 * WIDENING) - WIDENING;
        a + along * (b - a)
    };
    a.iter().zip(b).map(child).collect()
}

/// A step whose size is log-uniform between 2^-(1 + PRECISION_BITS) and one half.
fn mutation(rng: &mut Generator) -> f64 {
    let step = 0.5 * libm::exp2(-PRECISION_BITS * rng::uniform::<f64>(rng));
    if rng::uniform::<f64>(rng) < 0.5 {
        step
    } else {
        -step
    }
}

/// Mirrored at the walls of `[0, 1]`; what lies farther off than one width ends on a wall.
fn reflected(gene: f64) -> f64 {
    let inside = if gene < 0.0 {
        -gene
    } else if gene > 1.0 {
        2.0 - gene
    } else {
        gene
    };
    inside.clamp(0.0, 1.0)
}
