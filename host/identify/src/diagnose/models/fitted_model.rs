//! One model with one set of effects, fitted to one recording and judged on the other.

use super::errors::Errors;
use super::losses::Losses;
use super::observer_errors::ObserverErrors;
use crate::diagnose::settings::PROOF;
use servoid_engine::problem::{Candidate, Structure};
use servoid_engine::simulation::Method;
use shared::effects::Kind;
use shared::encoder::FLOOR_RMS_COUNTS;
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// A fitted model with its errors.
#[derive(Clone, Debug)]
pub struct FittedModel {
    /// The effects in the order in which they are told, the newest last; one that its structure holds several times stands here once.
    pub effects: Vec<Kind>,
    /// The model.
    pub candidate: Candidate,
    /// The unknowns.
    pub structure: Structure,
    /// Where it stands in the unknowns' unit cube.
    pub x: Vec<f64>,
    /// Values of the effects' parameters, SI.
    pub parameters: Vec<f64>,
    /// The counts that were lost, where [`Kind::MissedCounts`] is among the effects: then all errors are
    /// those with the lost counts put back, and `candidate` and `structure` are without that effect.
    pub losses: Option<Losses>,
    /// RMS error on the fitted recording, open loop, counts.
    pub rms_counts: f64,
    /// RMS error on the held-out recording, counts.
    pub validate_rms_counts: f64,
    /// Errors in windows, each run from the measured state, where whole runs say little.
    pub windowed: Option<Errors>,
    /// Whether its fit found that its free run loses its way.
    pub chaotic: bool,
    /// Errors that are soon forgotten, where free runs are chaotic.
    pub observed: Option<ObserverErrors>,
    /// The same for every memory that was asked for, so that none is computed again whenever models are compared.
    pub(in crate::diagnose) observed_runs: Vec<ObserverErrors>,
    /// The part of the recording, from its begin, over which a chaotic free run was followed and leaves the reading's own error.
    pub followed_fraction: f64,
    /// Its errors once it is fitted to both recordings, where those tell what the held-out error alone does not.
    pub on_both: Option<Errors>,
    /// RMS error that was predicted before the refit, counts.
    pub predicted_rms_counts: f64,
    /// Evaluations spent on it.
    pub evaluations: usize,
    /// How it was run.
    pub method: Method,
    /// Standard errors of its unknowns from the curvature of a score, by name, each in the unknown's unit; empty where no score decided.
    pub standard_errors: BTreeMap<String, f64>,
}

impl FittedModel {
    /// Errors of the free runs.
    pub fn free(&self) -> Errors {
        Errors {
            fitted: self.rms_counts,
            held_out: self.validate_rms_counts,
            floor: FLOOR_RMS_COUNTS,
        }
    }

    /// The errors of the runs that were fitted: in windows if there are any.
    pub fn ran(&self) -> Errors {
        self.windowed.unwrap_or_else(|| self.free())
    }

    /// The errors that it is judged by: those of the runs that were fitted, unless they are chaotic.
    pub fn judged(&self) -> Errors {
        match self.observed {
            Some(tracked) if !self.ran().at_floor() => tracked.errors,
            _ => self.ran(),
        }
    }

    /// Whether it leaves the reading's own error only, by what it is judged by.
    pub fn explains(&self) -> bool {
        self.is_proven() || self.judged().at_floor()
    }

    /// Whether it does so running on its own: to the end, or as far as a chaotic run can be followed.
    pub fn is_proven(&self) -> bool {
        self.ran().at_floor() || self.explains_both() || self.followed_fraction >= PROOF
    }

    /// Whether one set of parameters leaves the reading's own error only on both recordings, although those of the fitted one do not.
    pub fn explains_both(&self) -> bool {
        self.on_both.is_some_and(|errors| errors.at_floor())
    }

    /// Number of its effects' parameters that were searched for: a form that is held at the textbook's is none.
    pub fn freedom(&self) -> usize {
        self.parameters.len() - self.structure.held()
    }

    /// Order by what they are judged by, best first.
    pub fn by_score(&self, other: &FittedModel) -> Ordering {
        self.judged().score().total_cmp(&other.judged().score())
    }

    /// Whether any of its effects is as large as is searched for: then it does another one's work.
    pub fn any_at_wall(&self) -> bool {
        self.effects.iter().any(|kind| self.is_at_wall(*kind))
    }

    fn is_at_wall(&self, kind: Kind) -> bool {
        let values = self.structure.values_of(
            &self.candidate.machine,
            &self.parameters,
            self.candidate.start_speed,
        );
        let amplitude = |name: &str| {
            let parameters = kind.parameters();
            name.split_once('.').is_some_and(|(effect, name)| {
                effect == kind.name() && parameters.iter().any(|p| p.amplitude && p.name == name)
            })
        };
        let unknowns = self.structure.unknowns.iter().zip(&values);
        unknowns.into_iter().any(|(unknown, &value)| {
            let x = unknown.coordinate(value);
            amplitude(&unknown.name) && (x == 1.0 || (x == 0.0 && unknown.range.0 < 0.0))
        })
    }

    /// Values of the parameters of one of its effects; none where it has not got it.
    pub fn values_of(&self, kind: Kind) -> Vec<f64> {
        let mut effects = self.candidate.effects.iter();
        let found = effects.find(|(own, _)| *own == kind);
        found.map_or(Vec::new(), |(_, values)| values.to_vec())
    }

    /// The model with the parameters that it has, less one effect.
    pub fn without(&self, place: Kind) -> FittedModel {
        let mut rest = &self.parameters[..];
        let mut model = self.clone();
        model.effects.clear();
        model.parameters.clear();
        model.structure.effects.clear();
        for &kind in &self.structure.effects {
            let (own, further) = rest.split_at(kind.parameters().len());
            rest = further;
            if kind != place {
                if !model.effects.contains(&kind) {
                    model.effects.push(kind);
                }
                model.structure.effects.push(kind);
                model.parameters.extend_from_slice(own);
            }
        }
        model
    }
}

/// Whether two lists hold the same effects.
pub fn same(a: &[Kind], b: &[Kind]) -> bool {
    a.len() == b.len() && a.iter().all(|kind| b.contains(kind))
}

/// Each effect once, in order.
pub fn distinct(effects: &[Kind]) -> Vec<Kind> {
    let mut distinct: Vec<Kind> = Vec::new();
    for &kind in effects {
        if !distinct.contains(&kind) {
            distinct.push(kind);
        }
    }
    distinct
}
