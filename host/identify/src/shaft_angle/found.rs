//! By how much the shaft's angle in one recording is ahead of that in another, as torques that repeat with it show.

use super::settings::{
    AGREE, ALIKE, BESIDE, BETTER, CLEAR, LEAST_COUNTS, MEMORY_S, REACH, RUNS, STEPS, TRIED_PER_WAVE,
};
use crate::diagnose::{Budget, Line, built_up, order_lines};
use crate::fit::{self, Options};
use crate::golden_section::golden_section;
use servoid_engine::problem::{Candidate, Data, Horizon, StartAngle, errors, rms_counts};
use servoid_engine::simulation::Method;
use shared::cost::Cost;
use shared::effects::Kind;
use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

/// A wave that two recordings show.
#[derive(Clone, Copy, Debug)]
struct Shared {
    /// Waves a revolution.
    order: f64,
    /// Amplitude in the first, cosine and sine, V.
    first: [f64; 2],
    /// The same in the second.
    second: [f64; 2],
    /// Part of the residuals that it explains.
    weight: f64,
}

impl Shared {
    /// From 1, where the second is the first, shifted by `ahead` rad, to −1.
    fn agreement(&self, ahead: f64) -> f64 {
        let ([a, b], [c, d]) = (self.first, self.second);
        let (sine, cosine) = libm::sincos(self.order * ahead);
        // The first as it stands in the second's angle.
        let (a, b) = (a * cosine + b * sine, b * cosine - a * sine);
        let squares = a * a + b * b + c * c + d * d;
        2.0 * (a * c + b * d) / squares
    }
}

/// The waves by which recordings are compared with a first one.
pub(super) struct Reference<'a> {
    first: &'a Data,
    /// A motor with friction, beside which the waves are seen.
    model: Candidate,
    lines: Vec<Line>,
}

impl<'a> Reference<'a> {
    /// Those of `first`; `None` where it shows none, or no motor can be fitted to it.
    pub(super) fn of(first: &'a Data) -> Option<Self> {
        let options = with(&[Kind::Coulomb]);
        let problem = fit::problem(first, &options).ok()?;
        let model = problem.structure.candidate_at(problem.start.as_ref()?);
        let lines = clear(first, &model);
        (!lines.is_empty()).then_some(Reference {
            first,
            model,
            lines,
        })
    }

    /// By how much the shaft is ahead of the first recording's angle where each of the `others` reads the same, rad, from −π to π; `None` where
    /// nothing shows that it is.
    pub(super) fn ahead(&self, others: &[Data]) -> Vec<Option<f64>> {
        let roughly: Vec<_> = others.iter().map(|other| self.by_waves(other)).collect();
        if roughly.iter().all(Option::is_none) {
            return vec![None; others.len()];
        }
        let models = (
            self.built_up(&[Kind::Coulomb]),
            self.built_up(&self.with_waves()),
        );
        let (Some(without), Some(model)) = models else {
            return vec![None; others.len()];
        };
        let each = others.iter().zip(roughly);
        each.map(|(other, near)| ahead_near(other, &without, &model, near?))
            .collect()
    }

    /// The angle at which the waves of `other` agree best with those of the first, and its uncertainty, rad; `None` where they agree as they were
    /// read, or at no angle.
    fn by_waves(&self, other: &Data) -> Option<(f64, f64)> {
        let lines = clear(other, &self.model);
        let shared = self.lines.iter().filter_map(|first| {
            let second = lines.iter().find(|line| line.order == first.order)?;
            Some(Shared {
                order: first.order as f64,
                first: [first.cosine, first.sine],
                second: [second.cosine, second.sine],
                weight: (first.explains * second.explains).sqrt(),
            })
        });
        let shared: Vec<Shared> = shared.collect();
        let highest = shared.iter().map(|wave| wave.order).fold(0.0, f64::max);
        let weights: f64 = shared.iter().map(|wave| wave.weight).sum();
        let agreement = |ahead: f64| {
            let each = shared
                .iter()
                .map(|wave| wave.weight * wave.agreement(ahead));
            each.sum::<f64>() / weights
        };
        let tries = TRIED_PER_WAVE * highest as usize;
        // From no shift on: of equal ones the least is found.
        let angles = (0..=tries / 2).flat_map(|k| {
            let angle = TAU * k as f64 / tries as f64;
            [angle, -angle]
        });
        let mut best = (AGREE, None);
        for angle in angles {
            let agreement = agreement(angle);
            if agreement > best.0 + SAME {
                best = (agreement, Some(angle));
            }
        }
        let alike = agreement(0.0) > ALIKE;
        (best.1.filter(|_| !alike)).map(|angle| (angle, REACH * TAU / highest))
    }

    /// Friction and the torques whose waves the first recording shows.
    fn with_waves(&self) -> Vec<Kind> {
        let mut effects = vec![Kind::Coulomb];
        let is_once = |line: &Line| line.order == 1;
        if self.lines.iter().any(is_once) {
            effects.push(Kind::Unbalance);
        }
        if !self.lines.iter().all(is_once) {
            effects.push(Kind::Cogging);
        }
        effects
    }

    /// The first recording's motor with these effects.
    fn built_up(&self, effects: &[Kind]) -> Option<Candidate> {
        let stop = AtomicBool::new(false);
        let budget = Budget::of(RUNS * self.first.len() as u64, &stop);
        built_up(self.first, effects, &with(effects), &budget)
    }
}

/// Agreements that differ by less are the same.
const SAME: f64 = 1e-9;

/// The angle within reach of `near` at which a model of the first recording errs least along `other`; `None` where it errs hardly more as the angles
/// were read, or hardly less than a model `without` torques that repeat with the angle.
fn ahead_near(
    other: &Data,
    without: &Candidate,
    model: &Candidate,
    (near, reach): (f64, f64),
) -> Option<f64> {
    let counts = |ahead: f64| ahead / TAU * other.units.counts_per_rev;
    let error_of = |model: &Candidate, ahead: f64| {
        let turned = other.turned(counts(ahead));
        let model = Candidate {
            start_speed: other.start_speed(0),
            ..*model
        };
        let (method, start) = (Method::default(), StartAngle::Free);
        let held = Horizon::Observer(MEMORY_S);
        let errors = errors(&turned, &model, method, &held, start, Cost::Squared);
        errors.map_or(f64::INFINITY, |errors| rms_counts(&turned, &errors))
    };
    let error = |ahead: f64| error_of(model, ahead);
    let ahead = golden_section(error, near - reach..near + reach, STEPS);
    let rival = error(0.0).min(error_of(without, 0.0));
    (counts(ahead).abs() > LEAST_COUNTS && error(ahead) < BETTER * rival).then_some(ahead)
}

/// Of a fit with these effects.
fn with(effects: &[Kind]) -> Options {
    Options {
        effects: effects.to_vec(),
        // A motor that is refused is refused where it is fitted, with the reason.
        force: true,
        ..Options::default()
    }
}

/// The waves that explain much of what a model leaves.
fn clear(data: &Data, model: &Candidate) -> Vec<Line> {
    let mut lines = order_lines(data, model);
    let clearest = lines.first().map_or(0.0, |line| line.explains);
    lines.retain(|line| line.explains > CLEAR.max(BESIDE * clearest));
    lines
}
