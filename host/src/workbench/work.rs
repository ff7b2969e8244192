//! The pieces of work on the bench.

use super::job::Teller;
use super::model::{Model, Recordings, USUAL, options};
use super::state::Bench;
use crate::error::Error;
use rayon::prelude::*;
use serde_json::{Value, json};
use servoid_engine::compare::{self, Contest};
use servoid_engine::problem::FitProblem;
use servoid_engine::solve::{self, Found, Objective};
use servoid_identify::diagnose::{self, Diagnosis, Effort, Suggestion};
use servoid_identify::fit::{self, Fit, Options};
use servoid_results::report::diagnosis::DiagnosisReport;
use servoid_results::schema;
use shared::effects::Kind;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Evaluations of a fit at most; least squares needs a tenth of it where it gets anywhere at all.
const BUDGET: usize = 5000;
/// Evaluations from regression, where a look for effects has found a better start.
const FIRST: usize = 60;
/// Evaluations from there.
const SECOND: usize = 400;

/// Fits a model with these effects, and puts it on the bench.
pub(super) fn fit(bench: &Arc<Bench>, effects: &[Kind], algorithm: &str) -> Result<(), Error> {
    let (recordings, suggestion) = {
        let state = bench.state();
        let suggestion = (state.suggested.iter())
            .flat_map(|(_, list)| list)
            .find(|suggestion| diagnose::same(&suggestion.refit.effects, effects))
            .cloned();
        (state.recordings()?, suggestion)
    };
    let fit = fitted(bench, &recordings, effects, algorithm, suggestion.as_ref())?;
    let model = Model {
        id: 0,
        effects: effects.to_vec(),
        fit: Arc::new(fit),
        foreseen: suggestion.map(|s| s.refit.foreseen_rms_counts),
    };
    bench.change(|state| {
        state.put(model);
        state.suggested = None;
    });
    Ok(())
}

fn fitted(
    bench: &Bench,
    recordings: &Recordings,
    effects: &[Kind],
    algorithm: &str,
    suggestion: Option<&Suggestion>,
) -> Result<Fit, Error> {
    let mut options = options(&recordings.fitted, effects, 1);
    let (data, held_out) = recordings.parts();
    let solver = solve::by_name(algorithm)
        .ok_or_else(|| Error::Usage(format!("there is no search method `{algorithm}`")))?;
    // Only least squares begins anywhere in particular.
    let suggestion = suggestion.filter(|_| algorithm == USUAL);
    options.budget = if suggestion.is_some() { FIRST } else { BUDGET };
    let teller = Teller::new(bench);
    let samples = data.len() as f64;
    let mut spent = 0;
    let mut search = |problem: &FitProblem<'_>, options: &Options| -> Found {
        let before = spent;
        let mut observer = |count: usize, cost: f64| {
            let rms = finite((cost / samples).sqrt());
            teller.tell(|| json!({ "evaluations": before + count, "rms_counts": rms }));
        };
        let stop = bench.job.flag();
        let found = fit::search(problem, solver.as_ref(), options, stop, &mut observer);
        spent += found.evaluations;
        found
    };
    let mut problem = fit::problem(data, &options)?;
    let mut found = search(&problem, &options);
    // Regression may start in another valley than the one that was found.
    if algorithm == USUAL
        && diagnose::is_lost(found.cost, data.len())
        && let Some(candidate) = suggestion
            .map(|suggestion| suggestion.refit.candidate)
            .or_else(|| {
                let effort = Effort::usual(bench.job.flag());
                diagnose::built_up(data, effects, &options, &effort)
            })
    {
        let start = problem.begun_at(&candidate);
        options.budget = SECOND;
        let again = search(&start, &options);
        if again.cost < found.cost {
            problem = start;
            found = again;
        }
    }
    Ok(Fit::conclude(
        &problem,
        algorithm,
        "squared",
        &found,
        &options,
        Some(held_out),
    )?)
}

/// Tells how many models were tried, each time it is called.
fn counting<'a>(teller: &'a Teller<'a>) -> impl Fn() + Sync + 'a {
    let tried = AtomicUsize::new(0);
    move || {
        let tried = tried.fetch_add(1, Ordering::Relaxed) + 1;
        teller.tell(|| json!({ "tried": tried }));
    }
}

/// Looks for what would explain more than a model does.
pub(super) fn suggest(bench: &Arc<Bench>, id: usize) -> Result<(), Error> {
    let (recordings, candidate) = {
        let state = bench.state();
        (state.recordings()?, state.model(id)?.fit.candidate)
    };
    let (data, held_out) = recordings.parts();
    let options = options(&recordings.fitted, &[], 1);
    let teller = Teller::new(bench);
    let done = counting(&teller);
    let found = diagnose::suggest(
        data,
        held_out,
        &candidate,
        &options,
        &Effort::usual(bench.job.flag()),
        &done,
    )?;
    bench.change(|state| state.suggested = Some((id, found.list)));
    Ok(())
}

/// Names everything that is missing, step by step; each step becomes a model on the bench.
pub(super) fn diagnose(bench: &Arc<Bench>) -> Result<(), Error> {
    let recordings = bench.state().recordings()?;
    let (data, held_out) = recordings.parts();
    let options = options(&recordings.fitted, &[], 1);
    let teller = Teller::new(bench);
    let done = counting(&teller);
    let stop = bench.job.flag();
    let found = diagnose::diagnose(data, held_out, &options, &Effort::usual(stop), &done)?;
    let interrupted = stop.load(Ordering::Relaxed);
    let last = diagnose::settle(&found, data, held_out, &options, stop)?;
    let findings = diagnose::findings(&found, data, held_out)?;
    let kind = recordings.kind();
    let report = DiagnosisReport {
        data,
        held_out: &kind,
        diagnosis: &found,
        last: &last,
        findings: &findings,
        remarks: Vec::new(),
        seed: options.seed,
        interrupted,
        json: None,
    };
    let json = serde_json::to_value(schema::Diagnosis::from(&report))
        .map_err(|error| Error::Failed(error.to_string()))?;
    let models = if interrupted {
        as_found(&recordings, &found, last)?
    } else {
        on_the_way(bench, &recordings, &found, last)?
    };
    bench.change(|state| {
        for model in models {
            state.put(model);
        }
        // The whole way is what is looked at: the last model beside the linear motor.
        state.against = (state.models.iter())
            .find(|model| model.effects.is_empty())
            .map(|model| model.id)
            .filter(|id| state.chosen != Some(*id));
        state.suggested = None;
        state.diagnosis = Some(json);
    });
    Ok(())
}

/// The models of a diagnosis' steps, from the linear motor on.
fn on_the_way(
    bench: &Bench,
    recordings: &Recordings,
    found: &Diagnosis,
    last: Fit,
) -> Result<Vec<Model>, Error> {
    let mut models = vec![Model {
        id: 0,
        effects: Vec::new(),
        fit: Arc::new(fitted(bench, recordings, &[], USUAL, None)?),
        foreseen: None,
    }];
    let mut effects = Vec::new();
    for (depth, step) in found.steps.iter().enumerate() {
        effects.push(step.added);
        let Some(after) = step.candidates.first() else {
            continue;
        };
        let fit = if depth + 1 == found.steps.len() {
            last.clone()
        } else {
            let suggestion = Suggestion {
                effect: step.added,
                refit: after.clone(),
                evidence: None,
                p_value: 0.0,
                believed: true,
            };
            fitted(bench, recordings, &effects, USUAL, Some(&suggestion))?
        };
        models.push(Model {
            id: 0,
            effects: effects.clone(),
            fit: Arc::new(fit),
            foreseen: Some(after.foreseen_rms_counts),
        });
    }
    Ok(models)
}

/// The first and the last model of a diagnosis that was stopped, as they were found: there is no time to fit those
/// between.
fn as_found(recordings: &Recordings, found: &Diagnosis, last: Fit) -> Result<Vec<Model>, Error> {
    let base = schema::Model::of(&found.base.candidate, found.base.method);
    let mut models = vec![Model::again(0, &base, USUAL, recordings)?];
    let effects: Vec<Kind> = last
        .candidate
        .effects
        .iter()
        .map(|(kind, _)| kind)
        .collect();
    if !effects.is_empty() {
        models.push(Model {
            id: 0,
            effects,
            fit: Arc::new(last),
            foreseen: None,
        });
    }
    Ok(models)
}

/// Search methods side by side on the chosen model's unknowns, told as they go.
pub(super) fn race(
    bench: &Arc<Bench>,
    effects: &[Kind],
    algorithms: &[String],
    budget: usize,
    seeds: u64,
) -> Result<(), Error> {
    let recordings = bench.state().recordings()?;
    let mut options = options(&recordings.fitted, effects, 1);
    options.budget = budget;
    let (data, _) = recordings.parts();
    let problem = fit::problem(data, &options)?;
    let mut solvers = Vec::new();
    for name in algorithms {
        solvers.push(
            solve::by_name(name)
                .ok_or_else(|| Error::Usage(format!("there is no search method `{name}`")))?,
        );
    }
    let seeds: Vec<u64> = (1..=seeds).collect();
    // The first seed is run where everyone can watch; it is run again among all for the table.
    let samples = data.len() as f64;
    solvers.par_iter().for_each(|solver| {
        let teller = Teller::new(bench);
        let quick = servoid_engine::problem::Quick::new(&problem);
        let mut observer = |count: usize, cost: f64| {
            let rms = finite((cost / samples).sqrt());
            let name = solver.name();
            teller.tell(|| json!({ "algorithm": name, "evaluations": count, "rms_counts": rms }));
        };
        let mut evaluator = solve::Evaluator::new(
            &quick as &dyn Objective,
            budget,
            bench.job.flag(),
            &mut observer,
        );
        solver.search(&mut evaluator, seeds[0]);
    });
    let contest = Contest {
        problem: &problem,
        budget,
        seeds,
    };
    let rows = compare::run(&contest, &solvers, bench.job.flag(), &|| {});
    let json = serde_json::to_value(schema::Contest::new(&contest, &rows))
        .map_err(|error| Error::Failed(error.to_string()))?;
    bench.change(|state| state.race = Some(json));
    Ok(())
}

fn finite(x: f64) -> Value {
    if x.is_finite() { json!(x) } else { Value::Null }
}
