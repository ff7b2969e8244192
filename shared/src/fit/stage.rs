//! The stages of a fit, which share the same memory.

use super::polish::Polish;
use super::prediction::Prediction;
use super::{MOST, Method, POPULATION, Settings, Stop};
use crate::optim::{Firefly, FireflySettings, Optimiser, Pso, PsoSettings};
use crate::rng;

/// The swarm's settings for a population of 20: Clerc and Kennedy's constriction (2002).
const SWARM: PsoSettings = PsoSettings {
    inertia: 0.7298,
    cognitive: 1.496,
    social: 1.496,
    fastest: 1.0,
};

/// The stage of the fit; all stages share the same memory.
// The first is a zero at the front, see `Room`.
#[allow(
    clippy::large_enum_variant,
    reason = "there is no heap to put the larger ones on"
)]
#[derive(Clone, Debug)]
#[repr(u8)]
pub(super) enum Stage {
    Idle,
    Pso(Pso<f32, POPULATION, MOST>),
    Firefly(Firefly<f32, POPULATION, MOST>),
    Polish(Polish),
    /// A search is over: another from elsewhere, or none. By the next slice, for the sake of the stack.
    Over(Stop),
    Done(Stop),
    Predict(Prediction),
}

impl Stage {
    /// Begins the search.
    // Out of line: what it needs of the stack is free again when the search runs.
    #[inline(never)]
    pub(super) fn search(&mut self, settings: &Settings, dim: usize) {
        let population = settings.population.clamp(2, POPULATION as u8) as usize;
        let (evaluations, seed) = (settings.evaluations, settings.seed);
        match settings.method {
            Method::Pso => self.swarm(seed),
            Method::Firefly => self.fireflies(seed),
        }
        match self {
            Stage::Pso(pso) => pso.begin(dim, population, SWARM),
            Stage::Firefly(firefly) => {
                let cooled = FireflySettings {
                    evaluations: evaluations.into(),
                    ..FireflySettings::default()
                };
                firefly.begin(dim, population, cooled);
            }
            _ => {}
        }
    }

    // Each is made on the stack and moved here: apart, so that there is never room for both.
    #[inline(never)]
    fn swarm(&mut self, seed: u64) {
        *self = Stage::Pso(Pso::idle(rng::seeded(seed)));
    }

    #[inline(never)]
    fn fireflies(&mut self, seed: u64) {
        *self = Stage::Firefly(Firefly::idle(rng::seeded(seed)));
    }

    /// Becomes a prediction of nothing yet.
    #[inline(never)]
    pub(super) fn clear_prediction(&mut self) {
        *self = Stage::Predict(Prediction::EMPTY);
    }

    /// The search, while it runs.
    pub(super) fn searching(&mut self) -> Option<&mut dyn Optimiser<f32, MOST>> {
        match self {
            Stage::Pso(pso) => Some(pso),
            Stage::Firefly(firefly) => Some(firefly),
            _ => None,
        }
    }
}
