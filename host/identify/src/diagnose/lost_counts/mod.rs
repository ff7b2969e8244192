//! Counts that the encoder's counter lost: found one by one, not simulated.
//!
//! When a counter loses counts is chance, so no model can foretell it. But each loss is a jump of the
//! residual by whole counts between two readings, for good, where a wrong model drifts or rings. The losses
//! are nuisances of a recording, like its start angle: each recording has its own, and what is fitted and
//! judged is the recording with the lost counts put back.
//!
//! The jumps bend the fit by which they are looked for. So the bend is taken off to first order
//! ([`fit_influence`]), the clear jumps are found ([`detect`]), the counts are put back, the model is fitted
//! again, and so on until nothing changes.

mod detect;
mod fit_influence;
mod jump_sizes;
#[cfg(test)]
mod laws;
mod levels;
mod rate;
mod repaired;
mod settings;
mod step;

use crate::diagnose::candidate::descent::Settings;
use crate::diagnose::candidate::polish::polish;
use crate::diagnose::candidate::search::search;
use crate::diagnose::context::Context;
use crate::diagnose::models::{FittedModel, Loss, Losses};
use crate::fit::SPEED_HALF_WIDTH;
use detect::Depth;
use fit_influence::FitInfluence;
use repaired::{Repaired, lost, repaired};
use servoid_engine::problem::{Data, FitProblem, Horizon, StartAngle, Structure};
use servoid_engine::simulation::Method;
use servoid_engine::solve::Objective;
use settings::{NEAR, PROMISING, REPAIR_ROUNDS, SAMPLES_EACH};
use shared::cost::Cost;
use shared::effects::Kind;

/// Of the fit to a repaired recording.
const FIT: Settings = Settings {
    evaluations: 60,
    ..Settings::THOROUGH
};

/// Samples over which a bend is looked for, at first and when losses are known.
const LAGS: (usize, usize) = (8, 64);
/// Where the rest is not the encoder's own error, only losses of so many counts are beyond doubt, and there
/// must be so many of them in the fitted recording and in the held-out one.
const STRONG: (f64, usize, usize) = (5.0, 3, 2);
/// The model `parent` with the losses that its residuals show; its parameters are fitted again. `None`
/// where there are too few jumps, or too many, or where it has losses already.
pub fn found(context: &Context<'_>, parent: &FittedModel) -> Option<FittedModel> {
    if !context.data.quantised || parent.losses.is_some() {
        return None;
    }
    with_losses(context, parent, parent.effects.len(), &[])
}

/// The model `parent` with losses after `place` of its effects, `known` being those that it was fitted with.
fn with_losses(
    context: &Context<'_>,
    parent: &FittedModel,
    place: usize,
    known: &[Loss],
) -> Option<FittedModel> {
    [Depth::Single, Depth::Clear]
        .into_iter()
        .find_map(|depth| to_depth(context, parent, place, known, depth))
}

fn to_depth(
    context: &Context<'_>,
    parent: &FittedModel,
    place: usize,
    known: &[Loss],
    depth: Depth,
) -> Option<FittedModel> {
    let mut found = repair(context, parent, known, depth)?;
    // A better model shows the losses better, and those bring forth a better model.
    if !found.model.ran().at_floor()
        && found.model.rms_counts < PROMISING
        && let Some(again) = repair(context, &found.model, &found.losses.fitted, depth)
        && again.model.rms_counts < found.model.rms_counts
    {
        found = again;
    }
    let near = found.model.rms_counts < NEAR && found.model.validate_rms_counts < NEAR;
    (near || depth == Depth::Clear).then(|| found.with(place))
}

/// A model of the recordings with their lost counts put back.
struct Repair {
    model: FittedModel,
    losses: Losses,
    share: f64,
    /// Of the speed, rad/s.
    threshold: f64,
}

impl Repair {
    /// The same as a model of the recordings with losses, which come after `place` others.
    fn with(self, place: usize) -> FittedModel {
        let mut model = FittedModel {
            predicted_rms_counts: self.model.rms_counts,
            losses: Some(self.losses),
            ..self.model
        };
        let before = parameters_of(&model.effects[..place]);
        model.effects.insert(place, Kind::MissedCounts);
        let parameters = [self.share, self.threshold];
        model.parameters.splice(before..before, parameters);
        model
    }
}

/// Finds the losses that the `parent` shows, and fits it to what it then is about.
fn repair(
    context: &Context<'_>,
    parent: &FittedModel,
    known: &[Loss],
    depth: Depth,
) -> Option<Repair> {
    let structure = &parent.structure;
    let (fitted, x) = settled(context, parent, known, depth)?;
    let values = structure.values(&x);
    let held_out = starts(context.held_out, structure, &values)
        .into_iter()
        .filter_map(|x| in_recording(context.held_out, structure, parent.method, &x, &[], depth))
        .max_by_key(Vec::len)?;
    let enough = |losses: &[Loss], least: usize| depth == Depth::Single || strong(losses) >= least;
    if held_out.len() > most(context.held_out)
        || !enough(&fitted, STRONG.1)
        || !enough(&held_out, STRONG.2)
    {
        return None;
    }
    let losses = Losses { fitted, held_out };
    let repaired = Repaired::new(context, &losses);
    let (residual, squares) =
        problem(&repaired.data, structure, parent.method).residuals_and_cost(&x)?;
    let rms = (squares / residual.len() as f64).sqrt();
    if depth == Depth::Single && rms > PROMISING {
        return None;
    }
    let speed = speeds(&repaired.data, &residual);
    let (share, threshold) = rate::share_and_threshold(&losses.fitted, &speed);
    let units = &context.data.units;
    let per_s = threshold / units.interval;
    let bare = FittedModel {
        candidate: structure.candidate(&values),
        parameters: structure.effect_values(&values).to_vec(),
        ..parent.clone()
    };
    Some(Repair {
        model: polish(&repaired.context(context), &bare).ok()?,
        losses,
        share,
        threshold: per_s / units.counts_per_rev * core::f64::consts::TAU,
    })
}

/// The losses of the fitted recording and the point where the model stands with them.
fn settled(
    context: &Context<'_>,
    parent: &FittedModel,
    known: &[Loss],
    depth: Depth,
) -> Option<(Vec<Loss>, Vec<f64>)> {
    let structure = &parent.structure;
    let mut x = parent.x.clone();
    let mut losses = known.to_vec();
    for _ in 0..REPAIR_ROUNDS {
        let next = in_recording(context.data, structure, parent.method, &x, &losses, depth)?;
        let few = match depth {
            Depth::Clear => strong(&next) < STRONG.1,
            // One is enough where nothing else is left: the repaired recordings must come down to the encoder's error.
            Depth::Single => next.is_empty(),
        };
        if few || next.len() > most(context.data) {
            return None;
        }
        let same = next == losses;
        losses = next;
        if same {
            break;
        }
        let data = repaired(context.data, &losses);
        let problem = problem(&data, structure, parent.method);
        x = search(context, &problem, &x, FIT, parent.method)?.x;
    }
    Some((losses, x))
}

fn most(data: &Data) -> usize {
    data.len() / SAMPLES_EACH
}

/// All losses of a recording under the model at `x`, of which `known` are known. `None` where there is
/// nothing to be told from the model's own error.
fn in_recording(
    data: &Data,
    structure: &Structure,
    method: Method,
    x: &[f64],
    known: &[Loss],
    depth: Depth,
) -> Option<Vec<Loss>> {
    let repaired = repaired(data, known);
    let mut influence = FitInfluence::at(&problem(&repaired, structure, method), x)?;
    let speed = speeds(&repaired, &influence.residual);
    let lag = if known.is_empty() { LAGS.0 } else { LAGS.1 };
    let mut straight = influence.without_influence(lag);
    let lost = lost(known, data.len());
    for ((straight, residual), lost) in straight.iter_mut().zip(&mut influence.residual).zip(lost) {
        *straight += lost;
        *residual += lost;
    }
    let found = detect::losses(&straight, &speed, depth)?;
    Some(match depth {
        Depth::Clear => found,
        Depth::Single => jump_sizes::rounded(&influence.residual, &influence.columns, found),
    })
}

fn strong(losses: &[Loss]) -> usize {
    let counts = losses.iter().filter(|loss| loss.counts.abs() >= STRONG.0);
    counts.count()
}

/// The model's travel before each sample, counts.
fn speeds(data: &Data, residual: &[f64]) -> Vec<f64> {
    let angle = |k: usize| residual[k] + data.counts[k];
    let travel = |k: usize| {
        if data.recordings.is_first(k) {
            0.0
        } else {
            angle(k) - angle(k - 1)
        }
    };
    (0..data.len()).map(travel).collect()
}

/// Points to run a recording from that is not the fitted one: at rest, and in motion where it may be.
fn starts(data: &Data, structure: &Structure, values: &[f64]) -> Vec<Vec<f64>> {
    if !structure.start_speed {
        return vec![structure.coordinates(values)];
    }
    let now = data.speed_counts_s(0, SPEED_HALF_WIDTH) / data.units.counts_per_rev
        * core::f64::consts::TAU;
    let speeds = if data.may_start_moving(0) {
        vec![0.0, now]
    } else {
        vec![0.0]
    };
    let at = |speed: f64| {
        let mut values = values.to_vec();
        if let Some(last) = values.last_mut() {
            *last = speed;
        }
        structure.coordinates(&values)
    };
    speeds.into_iter().map(at).collect()
}

/// The whole recording, run freely.
fn problem<'d>(data: &'d Data, structure: &Structure, method: Method) -> FitProblem<'d> {
    FitProblem {
        data,
        structure: structure.clone(),
        cost: Cost::Squared,
        weight: 1.0,
        horizon: Horizon::Whole,
        start_angle: StartAngle::Free,
        method,
        start: None,
    }
}

/// How many parameters some effects have.
fn parameters_of(effects: &[Kind]) -> usize {
    let each = effects.iter().map(|kind| kind.parameters());
    each.map(<[_]>::len).sum()
}
