//! No diagnosis predicts worse than the baseline, the model that an engineer fits in an afternoon: a linear motor
//! with Coulomb friction, an offset and a delay.
//!
//! Where the model that was chosen reaches the encoder's floor there is nothing to do. Elsewhere something is missing that no
//! effect of the catalogue explains, and selection by one measure may have ended with a model that predicts worse over
//! another span than simpler ones do.

mod models;
mod prediction;
mod settings;

use super::candidate::several_horizons::fit_over_horizons;
use super::chosen::Chosen;
use super::context::{Budget, Context, together_move_both_ways};
use super::models::{FittedModel, same};
use crate::fit::contradictions;
use models::{TERMS, baseline_models, with_baseline_terms};
pub use prediction::Prediction;
use prediction::Windows;
use servoid_engine::problem::{Data, Horizon};
use settings::{AS_GOOD, CHAOTIC, ONE_WAY_GAIN, PART};
use shared::effects::Kind;

/// The best of the baseline's models.
#[derive(Clone, Debug, PartialEq)]
pub struct Baseline {
    /// Those of Coulomb friction, offset and delay that it has.
    pub effects: Vec<Kind>,
    /// What it predicts.
    pub prediction: Prediction,
}

/// A model and what it predicts.
struct Rated {
    model: FittedModel,
    prediction: Prediction,
}

/// Holds the chosen model against the baseline, on both recordings, in windows and over whole runs.
pub fn hold_to_baseline(held: Chosen<'_>) -> Chosen<'_> {
    let mut held = held;
    let chosen = held.model.as_ref().unwrap_or(&held.base).clone();
    if is_explained(&held.context, &chosen) || chosen.losses.is_some() {
        return held;
    }
    // The search may have used up its own.
    let budget = held.context.budget;
    let own = Budget::of((PART * budget.most() as f64) as u64, budget.stop());
    let context = &held.context.with_budget(&own);
    let windows = Windows::of(context);
    let rate = |model: FittedModel| -> Option<Rated> {
        let prediction = windows.prediction(context, &model)?;
        Some(Rated { model, prediction })
    };
    // Each as it was fitted, and fitted anew over windows, over the whole recording, and over both together.
    let spans = [windows.fitted.clone(), Horizon::Whole];
    let rate_all = |models: &[FittedModel]| -> Vec<Rated> {
        let refitted = models.iter().flat_map(|model| {
            own.checkpoint();
            [&spans[..], &spans[..1], &spans[1..]]
                .into_iter()
                .filter_map(|horizons| fit_over_horizons(context, model, horizons))
        });
        let all: Vec<FittedModel> = refitted.chain(models.iter().cloned()).collect();
        all.into_iter().filter_map(rate).collect()
    };
    let baseline = baseline_models(context, &held.base);
    let mut rated = rate_all(&baseline);
    let held_out = |rated: &&Rated| rated.prediction.held_out_score();
    let by_held_out = |a: &&Rated, b: &&Rated| held_out(a).total_cmp(&held_out(b));
    let Some(limit) = rated.iter().min_by(by_held_out) else {
        return held;
    };
    let limit_ran = limit.model.ran();
    let limit = Baseline {
        effects: limit.model.effects.clone(),
        prediction: limit.prediction,
    };
    let further = with_baseline_terms(context, &chosen);
    rated.extend(rate_all(std::slice::from_ref(&chosen)));
    rated.extend(rate_all(&further));
    // A set that a score chose keeps its names: what was held out is evidence in it, no veto. How it is fitted the baseline decides, and
    // which of the baseline's terms are fitted with it.
    if names_are_sure(&held) {
        let kept =
            |rated: &Rated| (chosen.effects.iter()).all(|kind| rated.model.effects.contains(kind));
        // A set whose runs are worse than the baseline's on both recordings is no better one, whatever its score.
        let holds = |rated: &Rated| {
            let own = rated.model.ran();
            own.fitted <= limit_ran.fitted || own.held_out <= limit_ran.held_out
        };
        let mut of_its_own = rated.iter().filter(|rated| kept(rated)).peekable();
        let is_worse = of_its_own.peek().is_some() && !of_its_own.any(holds);
        if !is_worse {
            rated.retain(kept);
        }
    }
    budget.book(own.spent());
    held.known.extend(further);
    held.known.extend(baseline);
    held.baseline = Some(limit.clone());
    if let Some(best) = select(held.context.data, rated, &chosen, &limit.prediction) {
        held.predicts = Some(best.prediction);
        if best.model.effects.is_empty() {
            held.base = best.model;
            held.model = None;
        } else {
            held.as_one |= !same(&best.model.effects, &chosen.effects);
            held.model = Some(best.model);
        }
    }
    held
}

/// Whether a score chose the effects beyond doubt. Where the motor never reverses friction, a constant and a torque that repeats with the
/// angle look alike: there what they gain beyond the baseline's terms must count beside what those gain.
fn names_are_sure(held: &Chosen<'_>) -> bool {
    let scores = &held.scores;
    let Some((_, linear)) = scores.iter().find(|(effects, _)| effects.is_empty()) else {
        return false;
    };
    let is_baseline = |effects: &[Kind]| effects.iter().all(|kind| TERMS.contains(kind));
    let most = |some: &mut dyn Iterator<Item = f64>| some.fold(f64::MIN, f64::max);
    let best = most(&mut scores.iter().map(|(_, nats)| *nats));
    let baseline = scores.iter().filter(|(effects, _)| is_baseline(effects));
    let limit = most(&mut baseline.map(|(_, nats)| *nats));
    let Context { data, held_out, .. } = held.context;
    together_move_both_ways(data, held_out) || best - limit > ONE_WAY_GAIN * (best - linear)
}

/// Whether nothing is left to explain on the recording that was fitted: what then fails on the held-out recording is
/// something that only that one shows, and a worse model of the first is no answer. In windows the floor is that of the
/// start states, which a noisy sensor raises: there only a whole run at the encoder's own error is sure.
fn is_explained(context: &Context<'_>, chosen: &FittedModel) -> bool {
    if context.span.window_s.is_some() {
        return chosen.explains() && chosen.free().at_floor();
    }
    chosen.explains() || chosen.free().fitted_at_floor()
}

/// The best of those that predict no worse than the baseline; of these the ones with the chosen effects first.
fn select(
    data: &Data,
    rated: Vec<Rated>,
    chosen: &FittedModel,
    limit: &Prediction,
) -> Option<Rated> {
    // A machine that cannot be is taken only where no other is left.
    let (possible, impossible): (Vec<Rated>, Vec<Rated>) = rated
        .into_iter()
        .partition(|rated| contradictions(data, &rated.model.candidate).is_empty());
    let rated = if possible.is_empty() {
        impossible
    } else {
        possible
    };
    // Each parameter has its price: of models that predict alike the simplest is taken.
    let penalty = |rated: &Rated| rated.prediction.score() + AS_GOOD * rated.model.freedom() as f64;
    let allowed = if chosen.observed.is_some() {
        CHAOTIC
    } else {
        AS_GOOD
    };
    let (feasible, others): (Vec<Rated>, Vec<Rated>) = rated
        .into_iter()
        .partition(|rated| rated.prediction.no_worse_than(limit, allowed));
    let best = |from: Vec<Rated>| {
        from.into_iter()
            .min_by(|a, b| penalty(a).total_cmp(&penalty(b)))
    };
    let (own, rest): (Vec<Rated>, Vec<Rated>) = feasible
        .into_iter()
        .partition(|rated| same(&rated.model.effects, &chosen.effects));
    best(own).or_else(|| best(rest)).or_else(|| best(others))
}
