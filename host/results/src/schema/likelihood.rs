//! The fit with process noise, beside the free run of a `servoid.fit/1`.

use super::finite;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use servoid_identify::likelihood;

/// The fit by the likelihood of a Kalman filter's innovations; what it takes for noise is torque as well as reading.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Likelihood {
    /// Inertia referred to the winding, `J·R/Kt`; the electrical time constant is neglected.
    pub inertia: Bounded,
    /// Back-EMF and viscous friction together.
    pub back_emf_viscous: Bounded,
    /// Coulomb friction.
    pub coulomb: Bounded,
    /// Offset that adds to the command.
    pub offset: Bounded,
    /// Delay from command to drive.
    pub delay: Bounded,
    /// Delay and time constant added up: what a command without edges shows of the two.
    pub delay_plus_time_constant: Bounded,
    /// Whether the recording tells the delay from inertia; if not, neither has an error.
    pub delay_separable: bool,
    /// Correlation of the errors of delay and inertia.
    pub delay_inertia_correlation: Option<f64>,
    /// Intensity of the white torque noise, referred to the winding.
    pub process_noise: Bounded,
    /// Standard deviation of the readings beyond quantisation.
    pub reading_noise: Bounded,
    /// Whether the innovations are white.
    pub whiteness: Option<Whiteness>,
    /// The numbers with readings used at a least distance of 10 and of 50 ms.
    pub updates: Vec<Update>,
    /// Where the free run differs by more than the 95 % intervals: errors of the model.
    pub disagreements: Vec<Disagreement>,
    /// Bayesian information criterion of the first of `updates`.
    pub bic: Option<f64>,
    /// Readings that were predicted.
    pub readings: usize,
    /// Part of the recording that was used, from its begin, s.
    pub duration_s: Option<f64>,
    /// Whether the search converged.
    pub converged: bool,
}

/// A number with its error and its 95 % interval.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Bounded {
    /// The number.
    pub value: Option<f64>,
    /// Standard error, the larger of curvature and sandwich; null where the recording does not determine the number.
    pub std: Option<f64>,
    /// Lower and upper end of the 95 % interval.
    pub interval: Option<[f64; 2]>,
    /// Its unit.
    pub unit: String,
}

/// How white the innovations are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Whiteness {
    /// Correlation of neighbours.
    pub neighbours: Option<f64>,
    /// Probability of as much correlation over 20 lags if they were white, by Ljung and Box.
    pub p_value: Option<f64>,
}

/// The numbers with readings at a least distance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Update {
    /// Least time between the readings that are used, s.
    pub update_s: f64,
    /// Inertia, in the unit of the section.
    pub inertia: Option<f64>,
    /// Back-EMF and viscous friction, in the unit of the section.
    pub back_emf_viscous: Option<f64>,
    /// Coulomb friction, in the unit of the section.
    pub coulomb: Option<f64>,
    /// Offset, in the unit of the section.
    pub offset: Option<f64>,
    /// Delay, s.
    pub delay_s: Option<f64>,
    /// Bayesian information criterion; comparable only at the same distance.
    pub bic: Option<f64>,
}

/// A number on which the two fits differ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Disagreement {
    /// Key of the number in this section.
    pub name: String,
    /// By the likelihood.
    pub likelihood: Option<f64>,
    /// By the free run.
    pub free_run: Option<f64>,
    /// Their unit.
    pub unit: String,
}

impl From<likelihood::Value> for Bounded {
    fn from(value: likelihood::Value) -> Self {
        Bounded {
            value: finite(value.value),
            std: value.std.and_then(finite),
            interval: value
                .interval
                .filter(|ends| ends.iter().all(|end| end.is_finite())),
            unit: value.unit.to_owned(),
        }
    }
}

impl From<&likelihood::Likelihood> for Likelihood {
    fn from(own: &likelihood::Likelihood) -> Self {
        Likelihood {
            inertia: own.inertia.into(),
            back_emf_viscous: own.damping.into(),
            coulomb: own.coulomb.into(),
            offset: own.offset.into(),
            delay: own.delay.into(),
            delay_plus_time_constant: own.total_lag.into(),
            delay_separable: own.delay_separable,
            delay_inertia_correlation: own.delay_inertia_correlation.and_then(finite),
            process_noise: own.process_noise.into(),
            reading_noise: own.reading_noise.into(),
            whiteness: own.whiteness.map(|w| Whiteness {
                neighbours: finite(w.neighbours),
                p_value: finite(w.p_value),
            }),
            updates: (own.checks.iter())
                .map(|check| Update {
                    update_s: check.update_s,
                    inertia: finite(check.inertia),
                    back_emf_viscous: finite(check.damping),
                    coulomb: finite(check.coulomb),
                    offset: finite(check.offset),
                    delay_s: finite(check.delay),
                    bic: finite(check.bic),
                })
                .collect(),
            disagreements: (own.disagreements.iter())
                .map(|other| Disagreement {
                    name: other.name.to_owned(),
                    likelihood: finite(other.likelihood),
                    free_run: finite(other.free_run),
                    unit: other.unit.to_owned(),
                })
                .collect(),
            bic: finite(own.bic),
            readings: own.readings,
            duration_s: finite(own.duration_s),
            converged: own.converged,
        }
    }
}
