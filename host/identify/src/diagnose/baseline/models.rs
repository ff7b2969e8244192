//! The linear motor with Coulomb friction, an offset and a delay, singly and together.

use super::settings::{DELAYS_S, FRICTION};
use crate::diagnose::built_up::added;
use crate::diagnose::candidate::fit::fit_screened;
use crate::diagnose::candidate::polish::polish;
use crate::diagnose::context::{Context, constant_drive, moves_both_ways};
use crate::diagnose::models::{FittedModel, ScreenedModel};
use crate::fit::base_for;
use rayon::prelude::*;
use servoid_engine::problem::{ELECTRICAL_TIME_CONSTANT, Structure, VISCOUS_PART};
use shared::effects::Kind;

/// All that the baseline may add to the linear motor.
pub const TERMS: [Kind; 4] = [
    Kind::Coulomb,
    Kind::Delay,
    Kind::OffsetVoltage,
    Kind::LoadTorque,
];

/// What it adds. A motor that never reverses
/// in either recording shows only the sum of Coulomb friction and offset, along which a fit would run away: it gets no offset.
fn terms(context: &Context<'_>) -> Vec<Kind> {
    let constant = constant_drive(context.data.drive);
    if moves_both_ways(context.data) || moves_both_ways(context.held_out) {
        vec![Kind::Coulomb, Kind::Delay, constant]
    } else {
        vec![Kind::Coulomb, Kind::Delay]
    }
}

/// The models with every set of the terms. None has an electrical time constant:
/// beside a delay no recording without edges tells the two apart. Without one, viscous friction is damping like any other.
pub fn baseline_models(context: &Context<'_>, base: &FittedModel) -> Vec<FittedModel> {
    let terms = terms(context);
    let fitted = |set: u32| {
        let chosen = terms
            .iter()
            .enumerate()
            .filter(|(at, _)| set >> at & 1 == 1);
        let effects: Vec<Kind> = chosen.map(|(_, &kind)| kind).collect();
        let delays = if effects.contains(&Kind::Delay) {
            &DELAYS_S[..]
        } else {
            &DELAYS_S[..1]
        };
        let starts = delays.par_iter();
        let models = starts.filter_map(|&delay_s| fit_terms(context, base, &effects, delay_s));
        models.min_by(|a, b| a.ran().fitted.total_cmp(&b.ran().fitted))
    };
    let sets = 1..1u32 << terms.len();
    sets.into_par_iter().filter_map(fitted).collect()
}

/// The linear motor with `effects`, which are among the baseline's terms.
fn fit_terms(
    context: &Context<'_>,
    base: &FittedModel,
    effects: &[Kind],
    delay_s: f64,
) -> Option<FittedModel> {
    if context.budget.exhausted() {
        return None;
    }
    let data = context.data;
    let machine = &base.candidate.machine;
    let speed = base.structure.start_speed;
    let structure = Structure::around(
        data,
        base_for(data, effects, false),
        effects,
        machine,
        speed,
    )
    .with_fixed(ELECTRICAL_TIME_CONSTANT, 0.0)
    .with_fixed(VISCOUS_PART, 0.0);
    let parameters: Vec<f64> = effects
        .iter()
        .map(|kind| match kind {
            Kind::Coulomb => FRICTION * data.supply,
            Kind::Delay => delay_s,
            _ => 0.0,
        })
        .collect();
    let start = ScreenedModel::standing(structure, &base.candidate, &parameters);
    let fitted = fit_screened(context, &start).ok()?;
    polish(context, &fitted).ok()
}

/// `model` with each of the terms that it lacks, one after the other and all together.
pub fn with_baseline_terms(context: &Context<'_>, model: &FittedModel) -> Vec<FittedModel> {
    if model.effects.is_empty() {
        return Vec::new();
    }
    let mut all = Vec::new();
    let mut level = vec![model.clone()];
    while let Some(best) = level
        .iter()
        .min_by(|a, b| a.ran().fitted.total_cmp(&b.ran().fitted))
    {
        level = extended(context, best);
        all.extend(level.iter().cloned());
    }
    all
}

/// `model` with each of the terms that neither it nor one of its effects has.
fn extended(context: &Context<'_>, model: &FittedModel) -> Vec<FittedModel> {
    let has = |kind: Kind| {
        model.effects.iter().any(|own| {
            *own == kind || (own.facts().contains.iter()).any(|simpler| simpler.name == kind.name())
        })
    };
    terms(context)
        .into_par_iter()
        .filter(|&kind| !has(kind) && !context.budget.exhausted())
        .filter_map(|kind| added(context, model, kind))
        .collect()
}
