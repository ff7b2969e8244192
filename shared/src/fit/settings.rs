//! What a device is to search for, and how.

use serde::{Deserialize, Serialize};

/// Largest population.
pub const POPULATION: usize = 20;

/// How to search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Method {
    /// Particle swarm.
    Pso,
    /// Fireflies.
    Firefly,
}

/// What to search for, and how. Hosts keep it in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Settings {
    /// The method.
    pub method: Method,
    /// Particles or fireflies, at most [`POPULATION`].
    pub population: u8,
    /// Evaluations of the search; those of the polish come on top.
    pub evaluations: u16,
    /// Seed of the search.
    pub seed: u64,
    /// Search for Coulomb friction.
    pub coulomb: bool,
    /// Search for a constant load.
    pub load: bool,
    /// Waves of the bridge's carrier in a control period, to fit what its dead time takes; zero takes a bridge that loses nothing.
    pub carriers: u16,
    /// What the dead time takes by the board's own figure, as a duty: the search takes it for granted, and the polish begins there.
    pub dead_time: u16,
    /// Fit the resistance of a supply that is not measured.
    pub supply: bool,
    /// Duty that is the whole supply, which the carrier's ripple and the supply's current depend on; zero for 32,768.
    pub full: u16,
}

impl Settings {
    /// Of nothing: all zeros.
    pub(super) const NONE: Settings = Settings {
        method: Method::Pso,
        population: 0,
        evaluations: 0,
        seed: 0,
        coulomb: false,
        load: false,
        carriers: 0,
        dead_time: 0,
        supply: false,
        full: 0,
    };

    /// Settings that suit most motors.
    pub const USUAL: Settings = Settings {
        method: Method::Firefly,
        population: 20,
        evaluations: 4000,
        seed: 1,
        coulomb: true,
        load: false,
        carriers: 0,
        dead_time: 0,
        supply: false,
        full: 0,
    };
}

impl Default for Settings {
    fn default() -> Self {
        Self::USUAL
    }
}
