//! The genetic algorithm with real numbers for genes: the paper's third contender.

use super::{Evaluator, Solver};
use shared::rng::{self, Generator};

/// How parents are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Selection {
    /// The best of a few drawn at random (Goldberg, Deb, 1991).
    Tournament {
        /// How many are drawn.
        size: usize,
    },
    /// With a chance in proportion to fitness, here the rank, so that the scale of the cost does not
    /// matter (Baker, 1985).
    Roulette,
}

/// Settings of the genetic algorithm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ga {
    /// Individuals.
    pub population: usize,
    /// How parents are chosen.
    pub selection: Selection,
    /// Chance that a child has two parents.
    pub crossover: f64,
    /// How far a child may lie beyond its parents, as a part of their distance (blend crossover;
    /// Eshelman, Schaffer, 1993).
    pub blend: f64,
    /// Genes that mutate in each child, on average.
    pub mutations: f64,
    /// Width of a mutation at the start and at the end of the budget, as a part of the cube's edge.
    pub mutation: (f64, f64),
    /// Best individuals that live on unchanged; they are not evaluated again.
    pub elite: usize,
}

impl Default for Ga {
    fn default() -> Self {
        Ga {
            population: 20,
            selection: Selection::Tournament { size: 2 },
            crossover: 0.9,
            blend: 0.5,
            mutations: 1.0,
            mutation: (0.2, 1e-4),
            elite: 1,
        }
    }
}

#[derive(Clone, Debug)]
struct Individual {
    genes: Vec<f64>,
    cost: f64,
}

impl Ga {
    fn parent<'p>(&self, people: &'p [Individual], rng: &mut Generator) -> &'p Individual {
        // The population is sorted, best first: a lower index is a fitter individual.
        let count = people.len() as u32;
        let chosen = match self.selection {
            Selection::Tournament { size } => (0..size.max(1))
                .map(|_| rng::below(rng, count))
                .min()
                .unwrap_or(0),
            Selection::Roulette => {
                // Slots of the wheel: n for the best, down to 1 for the worst.
                let mut ball = rng::below(rng, count * (count + 1) / 2);
                let mut rank = 0;
                while ball >= count - rank {
                    ball -= count - rank;
                    rank += 1;
                }
                rank
            }
        };
        &people[chosen as usize]
    }

    /// A child: a blend of two parents (or a copy of one), then mutated.
    fn child(&self, people: &[Individual], width: f64, rng: &mut Generator) -> Vec<f64> {
        let mother = self.parent(people, rng);
        let mut genes = mother.genes.clone();
        if rng::uniform::<f64>(rng) < self.crossover {
            let father = self.parent(people, rng);
            for (gene, other) in genes.iter_mut().zip(&father.genes) {
                let share = (1.0 + 2.0 * self.blend) * rng::uniform::<f64>(rng) - self.blend;
                *gene += share * (other - *gene);
            }
        }
        let chance = self.mutations / genes.len().max(1) as f64;
        for gene in &mut genes {
            if rng::uniform::<f64>(rng) < chance {
                *gene += width * rng::normal::<f64>(rng);
            }
            *gene = reflected(*gene);
        }
        genes
    }
}

/// Back into the cube off its walls.
fn reflected(x: f64) -> f64 {
    let folded = x.rem_euclid(2.0);
    if folded > 1.0 { 2.0 - folded } else { folded }
}

impl Solver for Ga {
    fn name(&self) -> &'static str {
        "ga"
    }

    fn search(&self, evaluator: &mut Evaluator<'_>, seed: u64) {
        let mut rng = rng::seeded(seed);
        let budget = evaluator.left().max(1);
        let population = self.population.max(2);
        let mut people = Vec::new();
        for _ in 0..population {
            let genes: Vec<f64> = (0..evaluator.dim())
                .map(|_| rng::uniform(&mut rng))
                .collect();
            let Ok(cost) = evaluator.evaluate(&genes) else {
                return;
            };
            people.push(Individual { genes, cost });
        }
        loop {
            people.sort_by(|a, b| a.cost.total_cmp(&b.cost));
            let spent = 1.0 - evaluator.left() as f64 / budget as f64;
            let (first, last) = self.mutation;
            let width = first * (last / first).powf(spent);
            let mut next: Vec<Individual> = people[..self.elite.min(population - 1)].to_vec();
            while next.len() < population {
                let genes = self.child(&people, width, &mut rng);
                let Ok(cost) = evaluator.evaluate(&genes) else {
                    return;
                };
                next.push(Individual { genes, cost });
            }
            people = next;
        }
    }
}
