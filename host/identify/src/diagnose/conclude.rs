//! Stage 6: the verdict on the named model, and what to do next.

use super::context::together_move_both_ways;
use super::explain::advice::advise;
use super::hypotheses::{probability_of, probable_sets};
use super::models::Errors;
use super::naming::Named;
use super::outcome::{Diagnosis, Floor, FloorKind, Verdict};

/// The diagnosis with its verdict and advice.
pub fn conclude(named: Named<'_>) -> Diagnosis {
    let both_ways = together_move_both_ways(named.context.data, named.context.held_out);
    let budget = named.context.budget;
    let hypotheses = probable_sets(&named);
    let mut steps = named.steps;
    for step in &mut steps {
        step.confidence = probability_of(step.added, &hypotheses);
    }
    let mut diagnosis = Diagnosis {
        hypotheses,
        span: named.context.span,
        base: named.base,
        verdict: Verdict::Complete,
        steps,
        last: named.last,
        rivals: named.rivals,
        not_named: named.not_named,
        predicts: named.predicts,
        baseline: named.baseline,
        floor: named.floor,
        advice: Vec::new(),
        ran_out: budget.ran_out(),
        steps_taken: budget.spent(),
    };
    diagnosis.verdict = verdict(&diagnosis, both_ways);
    if let (Some(floor), Some(before), Some(after)) = (
        &mut diagnosis.floor,
        diagnosis.base.windowed,
        diagnosis.last.windowed,
    ) {
        floor.explained_share = explained_share(before.fitted, after.fitted, floor.counts);
    }
    if diagnosis.last.explains() && !strays(&diagnosis) {
        let errors = diagnosis.last.ran();
        diagnosis.floor = Some(Floor {
            kind: FloorKind::Encoder,
            counts: errors.floor,
            window_s: diagnosis.span.window_s,
            explained_share: 1.0,
            foretold: None,
        });
    }
    if !both_ways {
        diagnosis.advice.push(
            "the motor never reverses, in neither recording: friction, an offset and a load look alike, and may pass for \
             another gain; record steps of both signs, or a slow triangle through zero"
                .to_owned(),
        );
    }
    advise(&mut diagnosis);
    diagnosis
}

/// Part of what can be explained of an error, as squares, that was taken away.
fn explained_share(before: f64, after: f64, floor: f64) -> f64 {
    let explainable = (before.powi(2) - floor.powi(2)).max(f64::MIN_POSITIVE);
    ((before.powi(2) - after.powi(2)) / explainable).clamp(0.0, 1.0)
}

/// A whole run further from the readings than so many times the floor of its windows says that the floor was none: a sensor that
/// holds its value looks like noise from which no window can stray.
const STRAYED: f64 = 10.0;

/// Whether a model that is at the floor in windows runs away over the whole recording.
fn strays(diagnosis: &Diagnosis) -> bool {
    let whole = diagnosis.last.free();
    let floor = |windowed: Errors| STRAYED * windowed.floor;
    diagnosis
        .last
        .windowed
        .is_some_and(|windowed| whole.fitted.max(whole.held_out) > floor(windowed))
}

/// What the recording says of the last model.
fn verdict(diagnosis: &Diagnosis, both_ways: bool) -> Verdict {
    let repeats = diagnosis
        .floor
        .is_some_and(|floor| floor.kind == FloorKind::Repeatability);
    let explains = repeats || diagnosis.last.explains() && !strays(diagnosis);
    let verdict = match (explains, diagnosis.steps.is_empty()) {
        (true, true) => Verdict::Complete,
        (true, false) => Verdict::MissingEffects,
        (false, _) => Verdict::Unexplained,
    };
    // In windows a one-sided run may look complete that is not.
    let sure = verdict == Verdict::Complete && diagnosis.last.free().at_floor();
    if both_ways || sure {
        verdict
    } else {
        Verdict::Inconclusive
    }
}
