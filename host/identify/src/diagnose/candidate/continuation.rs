//! Fitting a chaotic free run by following it: as far as the model keeps to the readings, then a little further, and so on to
//! the recording's end.
//!
//! Where a shaft may or may not slip over a detent, errors of the unknowns grow exponentially along the run. So the cost of the
//! whole run has no slope that leads anywhere, but that of a run that is cut where it departs has; and what one stretch teaches
//! carries the next one further, since each tells the unknowns better by as much as it asks for.

use super::descent::{Descent, FINEST, Settings, descend};
use super::score::score_candidate;
use super::search::fit_problem;
use super::settings::{FAR, FEWEST, MOST, SHORTEST};
use crate::diagnose::context::Context;
use crate::diagnose::models::{FittedModel, ROOM};
use crate::fit::{START_OFFSETS, departure, scores};
use servoid_engine::problem::{FitProblem, Horizon, Structure};
use servoid_engine::simulation::Method;

/// Of each stretch.
const STRETCH: Settings = Settings {
    evaluations: 120,
    // Far along the run a usual step would slip a detent.
    probe: 1e-7,
    probed: Some(0.02),
    ..Settings::THOROUGH
};

/// A model that follows the readings to their end, or as far as can be, from one that does not; `None` where they are lost
/// early.
pub fn follow_by_continuation(context: &Context<'_>, model: &FittedModel) -> Option<FittedModel> {
    let structure = &model.structure;
    // What the arithmetic leaves would grow along the run like any other error.
    let method = Method {
        substeps: FINEST,
        ..model.method
    };
    let book = |samples: usize, runs: usize| {
        context
            .budget
            .book((samples * usize::from(method.substeps) * runs) as u64);
    };
    let departs = |x: &[f64]| {
        book(context.data.len(), 1);
        let candidate = structure.candidate_at(x);
        let errors = scores::whole(context.data, &candidate, method).ok()?;
        Some(departure(context.data, &errors))
    };
    // Where it began in its cell an observer has forgotten.
    let starts = starts(structure, &model.x);
    let evaluations = starts.len();
    let furthest = starts.into_iter().max_by_key(|x| departs(x))?;
    let mut here = Descent {
        x: furthest,
        squares: f64::INFINITY,
        evaluations,
    };
    let noise = context.floor * ROOM;
    let (mut reached, mut tries) = (0, 0);
    let mut to = departs(&here.x)?;
    while tries < MOST && to >= FEWEST && to > reached + context.data.len() / SHORTEST {
        if context.budget.exhausted() {
            break;
        }
        tries += 1;
        let stretch = context.data.first(to);
        let problem = FitProblem {
            data: &stretch,
            horizon: Horizon::Whole,
            ..fit_problem(context, structure, method)
        };
        let found = descend(&problem, &here.x, STRETCH, context.budget)?;
        book(to, found.evaluations);
        let evaluations = here.evaluations + found.evaluations;
        if found.squares <= noise * noise * to as f64 {
            here = Descent {
                evaluations,
                ..found
            };
            reached = to;
            to = departs(&here.x)?.max(reached);
        } else {
            // It departs faster than the fit can go after it.
            here.evaluations = evaluations;
            to = reached + (to - reached) / 2;
        }
    }
    let part = reached as f64 / context.data.len() as f64;
    if part < FAR {
        return None;
    }
    let predicted = model.predicted_rms_counts;
    let followed = score_candidate(context, structure.clone(), &here, predicted, method).ok()?;
    Some(FittedModel {
        followed_fraction: part,
        chaotic: model.chaotic,
        ..followed
    })
}

/// The point, and others that begin elsewhere in the first cell.
fn starts(structure: &Structure, x: &[f64]) -> Vec<Vec<f64>> {
    let mut starts = vec![x.to_vec()];
    if let (true, Some(unknown)) = (structure.start_offset, structure.unknowns.last()) {
        starts.extend(START_OFFSETS.map(|offset| {
            let mut other = x.to_vec();
            other[x.len() - 1] = unknown.coordinate(offset);
            other
        }));
    }
    starts
}
