//! Stage 6: the verdict on the named model, and what to do next.

use super::context::{Span, together_move_both_ways};
use super::explain::advice::advise;
use super::hypotheses::{probability_of, probable_sets};
use super::models::{Errors, FittedModel};
use super::naming::Named;
use super::outcome::{Diagnosis, Floor, FloorKind, Repeated, Verdict};
use crate::diagnose::settings::STRAYED;
use crate::repeats::Repeats;

/// The diagnosis with its verdict and advice.
pub fn conclude(named: Named<'_>) -> Diagnosis {
    let both_ways = together_move_both_ways(named.context.data, named.context.held_out);
    let budget = named.context.budget;
    let named = Named {
        floor: by_repeats(&named).or(named.floor),
        ..named
    };
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
    if is_at_encoder(&diagnosis) {
        let errors = diagnosis.last.ran();
        diagnosis.floor = Some(Floor {
            kind: FloorKind::Encoder,
            counts: errors.floor,
            window_s: diagnosis.span.window_s,
            foretold: None,
            repeats: None,
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

/// The floor that repeats of a command show, where the recordings hold any. It is told in windows: over whole runs parameters drift.
fn by_repeats(named: &Named<'_>) -> Option<Floor> {
    let context = &named.context;
    let repeats = Repeats::among(&[context.data, context.held_out])?;
    let window_s = (context.span.window_s).unwrap_or_else(|| Span::usual_window_s(context.data));
    let of = |model: &FittedModel| repeats.lack_of_fit(&model.candidate, context.method, window_s);
    let (base, last) = (of(&named.base)?, of(&named.last)?);
    Some(Floor {
        kind: FloorKind::Repeatability,
        counts: last.noise_counts,
        window_s: Some(window_s),
        foretold: named.floor.and_then(|floor| floor.foretold),
        repeats: Some(Repeated { base, last }),
    })
}

/// Whether a model that is at the floor in windows runs away over the whole recording.
fn strays(diagnosis: &Diagnosis) -> bool {
    let whole = diagnosis.last.free();
    let floor = |windowed: Errors| STRAYED * windowed.floor;
    diagnosis
        .last
        .windowed
        .is_some_and(|windowed| whole.fitted.max(whole.held_out) > floor(windowed))
}

/// Whether the last model leaves the reading's own error only.
fn is_at_encoder(diagnosis: &Diagnosis) -> bool {
    diagnosis.last.explains() && !strays(diagnosis)
}

/// What the recording says of the last model.
fn verdict(diagnosis: &Diagnosis, both_ways: bool) -> Verdict {
    let at_floor = diagnosis.floor.is_some_and(|floor| floor.is_reached());
    let explains = at_floor || is_at_encoder(diagnosis);
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
