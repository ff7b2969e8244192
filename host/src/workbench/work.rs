//! The pieces of work on the bench.

use super::job::Teller;
use super::model::{Model, USUAL};
use super::recordings::{Recordings, options};
use super::state::{Bench, Proposed};
use crate::error::Error;
use crate::twins::Twin;
use rayon::prelude::*;
use serde_json::{Value, json};
use servoid_engine::compare::{self, Contest};
use servoid_engine::solve::{self, Objective};
use servoid_identify::diagnose::{self, Budget, Diagnosis, Suggestion};
use servoid_identify::fit::{Fit, Options};
use servoid_identify::{Diagnosed, Progress, bounded_problem, diagnose_data, identify_data};
use servoid_results::report::diagnosis::DiagnosisReport;
use servoid_results::schema;
use shared::effects::Kind;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Instant;

/// Fits a model with these effects, puts it on the bench, and looks for what would explain more.
pub(super) fn fit(bench: &Arc<Bench>, effects: &[Kind], algorithm: &str) -> Result<(), Error> {
    let id = fit_alone(bench, effects, algorithm)?;
    further(bench, id)
}

/// Looks for what would explain more than a model, if it leaves something and nobody has asked to stop.
pub(super) fn further(bench: &Arc<Bench>, id: usize) -> Result<(), Error> {
    let more = bench.state().model(id)?.leaves_something();
    if more && !bench.job.flag().load(Ordering::Relaxed) {
        suggest(bench, id)?;
    }
    Ok(())
}

/// Fits a model with these effects and puts it on the bench; its number there.
pub(super) fn fit_alone(
    bench: &Arc<Bench>,
    effects: &[Kind],
    algorithm: &str,
) -> Result<usize, Error> {
    let (recordings, parent, suggestion) = {
        let state = bench.state();
        let proposals = state.proposed.values().flat_map(|proposed| &proposed.list);
        let suggestion = proposals
            .filter(|suggestion| diagnose::same(&suggestion.model.effects, effects))
            .min_by(|a, b| a.model.by_score(&b.model))
            .cloned();
        (state.recordings()?, state.chosen, suggestion)
    };
    let fit = fitted(bench, &recordings, effects, algorithm, suggestion.as_ref())?;
    let predicted = suggestion.map(|s| s.model.predicted_rms_counts);
    let model = Model::new(effects.to_vec(), fit, predicted, parent, &recordings)?;
    Ok(bench.change(|state| state.put(model)))
}

fn fitted(
    bench: &Bench,
    recordings: &Recordings,
    effects: &[Kind],
    algorithm: &str,
    suggestion: Option<&Suggestion>,
) -> Result<Fit, Error> {
    let options = Options {
        algorithm: algorithm.to_owned(),
        start: suggestion.map(|suggestion| suggestion.model.candidate),
        ..recordings.options(effects)
    };
    let (data, held_out) = recordings.parts();
    let watched = Watched::new(bench, data.len());
    Ok(identify_data(data, Some(held_out), &options, &watched)?)
}

/// Tells the page how the work goes on; stopped by the page.
pub(super) struct Watched<'a> {
    bench: &'a Bench,
    teller: Teller<'a>,
    samples: f64,
    tried: AtomicUsize,
}

impl<'a> Watched<'a> {
    /// Work on a recording of so many samples.
    pub(super) fn new(bench: &'a Bench, samples: usize) -> Self {
        Watched {
            bench,
            teller: Teller::new(bench),
            samples: samples as f64,
            tried: AtomicUsize::new(0),
        }
    }
}

impl Progress for Watched<'_> {
    fn evaluated(&self, evaluations: usize, cost: f64) {
        let rms = finite((cost / self.samples).sqrt());
        self.teller
            .tell(|| json!({ "evaluations": evaluations, "rms_counts": rms }));
    }

    fn tried(&self) {
        let tried = self.tried.fetch_add(1, Ordering::Relaxed) + 1;
        self.teller.tell(|| json!({ "tried": tried }));
    }

    fn stop(&self) -> &AtomicBool {
        self.bench.job.flag()
    }
}

/// Looks for what would explain more than a model does.
pub(super) fn suggest(bench: &Arc<Bench>, id: usize) -> Result<(), Error> {
    let (recordings, candidate) = {
        let state = bench.state();
        (state.recordings()?, state.model(id)?.fit.candidate)
    };
    let (data, held_out) = recordings.parts();
    let options = recordings.options(&[]);
    let watched = Watched::new(bench, data.len());
    let done = || watched.tried();
    let began = Instant::now();
    let found = diagnose::suggest(
        data,
        held_out,
        &candidate,
        recordings.criterion(),
        &options,
        &Budget::usual(bench.job.flag()),
        &done,
    )?;
    let proposed = Proposed {
        list: found.list,
        floor: found.floor,
        tried: watched.tried.load(Ordering::Relaxed),
        seconds: began.elapsed().as_secs_f64(),
    };
    bench.change(|state| {
        // It may have been taken away meanwhile.
        if state.model(id).is_ok() {
            state.proposed.insert(id, Arc::new(proposed));
        }
    });
    Ok(())
}

/// Names everything that is missing, step by step; each step becomes a model on the bench.
pub(super) fn diagnose(bench: &Arc<Bench>) -> Result<(), Error> {
    let recordings = bench.state().recordings()?;
    let (data, held_out) = recordings.parts();
    let options = options(&recordings.fitted, &[]);
    let kind = recordings.kind();
    let watched = Watched::new(bench, data.len());
    let budget = Budget::usual(bench.job.flag());
    let found = diagnose_data(data, held_out, &kind, &options, &budget, &watched)?;
    let report = DiagnosisReport::new(&found, data, &kind, options.seed, None);
    let json = serde_json::to_value(schema::Diagnosis::from(&report))
        .map_err(|error| Error::Failed(error.to_string()))?;
    let Diagnosed {
        diagnosis,
        last,
        interrupted,
        ..
    } = found;
    let models = if interrupted {
        as_found(&recordings, &diagnosis, last)?
    } else {
        on_the_way(bench, &recordings, &diagnosis, last)?
    };
    let last = bench.change(|state| {
        let mut before = None;
        for mut model in models {
            model.parent = before;
            before = Some(state.put(model));
        }
        // The whole way is what is looked at: the last model beside the linear motor.
        state.against = (state.models.iter())
            .find(|model| model.effects.is_empty())
            .map(|model| model.id)
            .filter(|id| state.chosen != Some(*id));
        state.diagnosis = Some(json);
        before.filter(|id| state.model(*id).is_ok_and(Model::leaves_something))
    });
    match last {
        Some(id) if !interrupted => suggest(bench, id),
        _ => Ok(()),
    }
}

/// Twins of a motor that are diagnosed.
pub(super) const TWINS: usize = 20;

/// Diagnoses twins of a model, and says what was named in them as they come.
pub(super) fn twins(bench: &Arc<Bench>, id: usize) -> Result<(), Error> {
    let (recordings, candidate) = {
        let state = bench.state();
        (state.recordings()?, state.model(id)?.fit.candidate)
    };
    let fitted = recordings.shown();
    let twin = Twin::of(&candidate, fitted, recordings.judge())?;
    let watched = Watched::new(bench, fitted.len());
    twin.diagnosed(TWINS, 1, &watched, |found| {
        bench.change(|state| {
            if state.model(id).is_ok() {
                state.twins.insert(id, found.clone());
            }
        });
    })?;
    Ok(())
}

/// The models of a diagnosis' steps, from the linear motor on.
fn on_the_way(
    bench: &Bench,
    recordings: &Recordings,
    found: &Diagnosis,
    last: Fit,
) -> Result<Vec<Model>, Error> {
    let first = fitted(bench, recordings, &[], USUAL, None)?;
    let mut models = vec![Model::new(Vec::new(), first, None, None, recordings)?];
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
                model: after.clone(),
                errors: after.ran(),
                evidence: None,
                signature: None,
                p_value: 0.0,
                believed: true,
            };
            fitted(bench, recordings, &effects, USUAL, Some(&suggestion))?
        };
        let foreseen = Some(after.predicted_rms_counts);
        models.push(Model::new(
            effects.clone(),
            fit,
            foreseen,
            None,
            recordings,
        )?);
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
        models.push(Model::new(effects, last, None, None, recordings)?);
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
    let mut options = recordings.options(effects);
    options.budget = budget;
    let (data, _) = recordings.parts();
    let problem = bounded_problem(data, &options)?;
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
        let quick = servoid_engine::block_cost::BlockCost::new(&problem);
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

#[cfg(test)]
mod tests {
    use super::super::blind::recorded;
    use super::*;
    use servoid_io::showcase;
    use servoid_plant::Hidden;

    /// One front door: what the page fits is what a call of the library, and so the command line, fits.
    #[test]
    fn the_bench_fits_to_the_bits_of_the_front_door() {
        for (name, effects) in [
            ("coulomb", vec![]),
            ("coulomb", vec![Kind::Coulomb]),
            ("cogging", vec![Kind::Cogging]),
        ] {
            let hidden = Hidden::typical(name, &showcase::machine()).expect("an effect");
            let [first, second] = [(1, "a.csv"), (2, "b.csv")].map(|(seed, name)| {
                recorded(std::slice::from_ref(&hidden), seed, name).expect("a recording")
            });
            let recordings = Recordings::new(first, Some(second));
            let bench = Bench::new(None, None);
            let shown = fitted(&bench, &recordings, &effects, USUAL, None).expect("a fit");
            let asked = Options {
                effects: effects.clone(),
                ..Options::default()
            };
            let (data, held_out) = recordings.parts();
            let silent = servoid_identify::Silent::default();
            let called = identify_data(data, Some(held_out), &asked, &silent).expect("a fit");
            assert_eq!(shown.parameters, called.parameters, "{name}: {effects:?}");
            assert_eq!(shown.validate_rms_counts, called.validate_rms_counts);
        }
    }
}
