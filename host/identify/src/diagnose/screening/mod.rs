//! A model with one effect more, fitted roughly: in series-parallel form, along the measured motion, where that is possible.
//! It predicts what the effect can explain, and is where the full fit starts.

mod series_parallel;
mod settings;
mod starts;

use crate::diagnose::candidate::descent::Settings;
use crate::diagnose::candidate::fit::LOST;
use crate::diagnose::candidate::search::{fit_problem, search};
use crate::diagnose::context::Context;
use crate::diagnose::models::{FittedModel, NOISE_COUNTS, ScreenedModel};
use crate::diagnose::spectrum::spectrum;
use crate::fit::base_for;
use series_parallel::SeriesParallel;
pub use series_parallel::follows;
use servoid_engine::problem::{Scale, Structure};
use servoid_engine::solve::Objective;
pub use settings::FORMS;
use settings::{FRICTION_SHARE, GLANCED, MOST_ORDERS, PROMISING};
use shared::effects::{Form, Kind, MAX_EFFECTS, Starts};
use shared::units::Quantity;
use starts::starts;

const SCREENING: Settings = Settings {
    tolerance: 5e-3,
    ..Settings::ROUGH
};

/// The model `parent` with `kind` added. An effect that starts from a simpler one, as bristles do from dry friction, is screened after that.
pub fn screen(context: &Context<'_>, parent: &FittedModel, kind: Kind) -> Option<ScreenedModel> {
    let begun = begin(context, parent, kind)?;
    screen_begun(context, parent, kind, begun)
}

/// The models `parent` with `kind` added, where their fits start.
pub fn begin(
    context: &Context<'_>,
    parent: &FittedModel,
    kind: Kind,
) -> Option<Vec<ScreenedModel>> {
    let first = kind.facts().starts.after();
    let first = first.and_then(|simpler| screen(context, parent, simpler));
    let mut effects = parent.structure.effects.clone();
    let starts = match cogging_orders(context, parent, kind) {
        Some(orders) => vec![orders],
        None => starts(context, parent, kind, first.as_ref()),
    };
    let own = kind.parameters().len();
    let times = starts.first()?.len().div_ceil(own);
    effects.extend(std::iter::repeat_n(kind, times));
    let structure = structure_near(context, &effects, parent);
    let mut begun: Vec<ScreenedModel> = Vec::new();
    for &form in forms(parent, kind) {
        let structure = structure.clone().with_form_at(kind, form);
        begun.extend(starts.iter().map(|start| {
            let mut parameters = parent.parameters.clone();
            parameters.extend(start);
            if form != 0.0 && shares_friction(kind) {
                parameters.pop();
                parameters.push(FRICTION_SHARE);
            }
            ScreenedModel::standing(structure.clone(), &parent.candidate, &parameters)
        }));
    }
    Some(begun)
}

/// The best of models that were [begun](begin) after a rough fit.
pub fn screen_begun(
    context: &Context<'_>,
    parent: &FittedModel,
    kind: Kind,
    mut begun: Vec<ScreenedModel>,
) -> Option<ScreenedModel> {
    // Where every fit is a simulation, a glance at each start shows which of them is worth one.
    if !follows(kind) && begun.len() > 1 {
        for screened in &mut begun {
            screened.simulated = free_run_error(context, screened, f64::INFINITY);
        }
        begun.sort_by(|a, b| a.simulated.total_cmp(&b.simulated));
        begun.truncate(GLANCED);
    }
    let mut best: Option<ScreenedModel> = None;
    for start in begun {
        let Some(screened) = screen_from(context, &start.structure, start.x) else {
            continue;
        };
        if best
            .as_ref()
            .is_none_or(|b| screened.predicted() < b.predicted())
        {
            best = Some(screened);
        }
        // Further starts are for effects that promise something from the first one, or that do nothing there.
        let leaves = best.as_ref().map_or(1.0, ScreenedModel::predicted) / parent.rms_counts;
        if !follows(kind) && leaves > PROMISING {
            break;
        }
    }
    best
}

/// The forms in which `kind` is begun beside `parent`: friction is shared where there is any.
fn forms(parent: &FittedModel, kind: Kind) -> &'static [f64] {
    let rubs = |kind: &Kind| kind.needs().friction;
    let both =
        kind.facts().both_forms && (!shares_friction(kind) || parent.effects.iter().any(rubs));
    if both { &FORMS } else { &FORMS[..1] }
}

/// Whether the last parameter of an effect is a share of the dry friction of others.
fn shares_friction(kind: Kind) -> bool {
    kind.form() == Some(Form::FrictionShare)
}

/// A model that has lost effects, or has others in their place, where it stands.
pub fn restart(context: &Context<'_>, rest: &FittedModel) -> ScreenedModel {
    let structure = structure_near(context, &rest.structure.effects, rest);
    ScreenedModel::standing(structure, &rest.candidate, &rest.parameters)
}

/// The unknowns of a model with `effects` and a machine near that of `there`, with the forms that it has.
fn structure_near(context: &Context<'_>, effects: &[Kind], there: &FittedModel) -> Structure {
    let windows = context.span.window_s.is_some();
    let mut structure = Structure::around(
        context.data,
        base_for(context.data, effects, windows),
        effects,
        &there.candidate.machine,
        there.structure.start_speed,
    );
    structure.take_forms_of(&there.structure);
    if windows {
        widen(&mut structure, context.data.supply);
    }
    structure
}

/// Parameters of a cogging torque of several orders: in windows, far above the reading's floor, its
/// strongest order alone may leave more than it explains.
fn cogging_orders(context: &Context<'_>, parent: &FittedModel, kind: Kind) -> Option<Vec<f64>> {
    if kind.facts().starts != Starts::AngleOrders || context.span.window_s.is_none() {
        return None;
    }
    let room = MAX_EFFECTS - parent.structure.effects.len();
    let lines = spectrum(context.data, &parent.candidate).lines;
    let values = lines
        .iter()
        .filter(|line| line.order > 1)
        .take(room.min(MOST_ORDERS))
        .flat_map(|line| [line.cosine, line.sine, line.order as f64]);
    Some(values.collect()).filter(|values: &Vec<f64>| !values.is_empty())
}

/// The same model, fitted roughly from `x`.
pub fn screen_from(
    context: &Context<'_>,
    structure: &Structure,
    x: Vec<f64>,
) -> Option<ScreenedModel> {
    let samples = context.samples() as f64;
    if !structure.effects.iter().all(|&kind| follows(kind)) {
        let found = search(
            context,
            &fit_problem(context, structure, context.method),
            &x,
            SCREENING,
            context.method,
        )?;
        return Some(ScreenedModel {
            structure: structure.clone(),
            x: found.x,
            series_parallel: f64::INFINITY,
            simulated: (found.squares / samples).sqrt(),
        });
    }
    let series_parallel = SeriesParallel {
        data: context.data,
        motion: &context.motion,
        horizon: &context.fitted_horizon,
        structure: structure.clone(),
        method: context.method,
    };
    let found = search(context, &series_parallel, &x, SCREENING, context.method)?;
    let mut screened = ScreenedModel::at(structure.clone(), found.x);
    screened.series_parallel = (found.squares / samples).sqrt();
    screened.simulated = free_run_error(
        context,
        &screened,
        LOST * screened.series_parallel.max(NOISE_COUNTS),
    );
    Some(screened)
}

/// RMS error of a free run from where a screened model stands, counts; infinite where it is above `limit`.
pub fn free_run_error(context: &Context<'_>, screened: &ScreenedModel, limit: f64) -> f64 {
    let samples = context.samples() as f64;
    let most = limit * limit * samples;
    fit_problem(context, &screened.structure, context.method)
        .residuals_within(&screened.x, most)
        .filter(|(_, squares)| *squares <= most)
        .map_or(f64::INFINITY, |(_, squares)| (squares / samples).sqrt())
}

/// A motor under a controller may carry whatever it can hold: torques and voltages are searched for up to the
/// supply.
fn widen(structure: &mut Structure, supply: f64) {
    let volts = Quantity::Torque.unit();
    for unknown in &mut structure.unknowns {
        let (low, high) = unknown.range;
        if unknown.unit == volts && unknown.scale == Scale::Linear {
            unknown.confine((
                if low < 0.0 { low.min(-supply) } else { low },
                high.max(supply),
            ));
        }
    }
}
