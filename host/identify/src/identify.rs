//! The front door of a fit: every face (command line, workbench, check of a device, library user) comes through here.

use crate::certificate::{self, certify};
use crate::check;
use crate::diagnose::{Budget, Span, built_up, is_lost};
use crate::error::Error;
use crate::fit::integration::Refined;
use crate::fit::interval::{self, most_likely};
use crate::fit::own_parameters::{self, fit_own};
use crate::fit::profile::{self, Profile};
use crate::fit::recordings::{add_spread, loop_remarks, recording_errors};
use crate::fit::report::Solved;
use crate::fit::systematic::add_systematic;
use crate::fit::{self, Fit, Options};
use crate::likelihood;
use crate::progress::Progress;
use crate::repeats::{LackOfFit, Repeats};
use servoid_engine::problem::{Candidate, Data, FitProblem};
use servoid_engine::solve::{self, Found, Solver};
use servoid_io::recording::Recording;
use shared::cost::Cost;

/// The search method that starts from regression: only it depends on where it starts.
pub const LEAST_SQUARES: &str = "lm";

/// Fits a model to a recording.
///
/// The model is the linear motor with the effects that `options` name. The result has parameters in SI with standard
/// errors, and says in words what the recording does not determine.
///
/// # Errors
/// [`Error::Model`] where the recording has no command, no motion or no samples; [`Error::Failed`] where no motor fits it
/// even roughly; [`Error::Usage`] where an option cannot be used.
///
/// # Example
/// ```
/// use servoid_identify::{Silent, fit::Options, identify};
/// use servoid_io::showcase;
/// use servoid_plant::Hidden;
/// use shared::effects::Kind;
///
/// // Twenty seconds of a gearmotor with Coulomb friction, from the virtual bench.
/// let friction = Hidden::typical("coulomb", &showcase::machine())?;
/// let recording = showcase::record(std::slice::from_ref(&friction), 1, "bench")?;
///
/// let linear = identify(&recording, &Options::default(), &Silent::default())?;
/// let with_friction = Options { effects: vec![Kind::Coulomb], ..Options::default() };
/// let fit = identify(&recording, &with_friction, &Silent::default())?;
///
/// assert!(linear.rms_counts > 10.0);
/// assert!(fit.rms_counts < 0.3, "at the encoder's floor");
/// for parameter in &fit.parameters {
///     println!("{} = {} {}", parameter.name, parameter.value, parameter.unit);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn identify(
    recording: &Recording,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Fit, Error> {
    check::passed(recording, options.force)?;
    identify_data(&Data::new(recording)?, None, options, progress)
}

/// As [`identify()`], for a recording that is ready for simulation; `validation` is scored and never fitted.
///
/// # Errors
/// As [`identify()`].
pub fn identify_data(
    data: &Data,
    validation: Option<&Data>,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Fit, Error> {
    let searched = search_model(data, options, progress)?;
    let Refined {
        problem,
        found,
        solved: solved_at,
        left,
    } = &searched;
    let notes = [
        fit::integration::note(options.method, &searched),
        interval::note(problem, options),
    ];
    // Everything after the search runs the model with the steps that it ended with.
    let options = &Options {
        method: problem.method,
        ..options.clone()
    };
    let mut fit = if options.own.is_empty() {
        let certificate = options.certificate.then(|| certify(problem, solved_at));
        let solved = match left {
            Some(error) => solved_at.clone().with_error(error),
            None => solved_at.clone(),
        };
        let mut fit = conclude(problem, found, options, validation, &solved)?;
        add_systematic(&mut fit.parameters, problem, &solved, options);
        fit.certificate = certificate.transpose()?;
        if options.profile {
            fit.profiles = profiles_of(problem, found, solved_at, options, progress);
        }
        if options.error_ladder && !options.effects.is_empty() {
            fit.error_ladder = fit::error_ladder(data, validation, &fit, options, progress.stop());
        }
        fit.recordings = recording_errors(data, validation, &fit.candidate, options.method)?;
        add_spread(&mut fit, data, options, progress.stop());
        fit.likelihood = likelihood::section(data, &fit, &options.effects, progress.stop());
        fit
    } else {
        let own = fit_own(problem, found, options, progress.stop())?;
        let mut fit = conclude(problem, &own.found, options, validation, &own.solved)?;
        fit.recordings = recording_errors(data, validation, &fit.candidate, options.method)?;
        own.recordings.write_into(&mut fit);
        fit
    };
    fit.lack_of_fit = lack_of_fit(&fit, data, validation, options);
    fit.notes.extend(notes.into_iter().flatten());
    fit.notes.extend(loop_remarks(&fit.recordings));
    Ok(fit)
}

/// What repeats of a command say of a fit.
fn lack_of_fit(
    fit: &Fit,
    data: &Data,
    validation: Option<&Data>,
    options: &Options,
) -> Option<LackOfFit> {
    let sets: Vec<&Data> = std::iter::once(data).chain(validation).collect();
    let window_s = options
        .window_s
        .unwrap_or_else(|| Span::usual_window_s(data));
    Repeats::among(&sets)?.lack_of_fit(&fit.candidate, options.method, window_s)
}

/// The profile of each parameter, by the search that has found the best model.
fn profiles_of(
    problem: &FitProblem<'_>,
    found: &Found,
    solved: &Solved,
    options: &Options,
    progress: &dyn Progress,
) -> Vec<Profile> {
    let by_cells = solved.reading_noise.is_some();
    let few = Options {
        budget: fit::integration::evaluations(problem),
        ..options.clone()
    };
    let again = |problem: &FitProblem<'_>| {
        let solver = solve::by_name(LEAST_SQUARES)?;
        let found = fit::search(
            problem,
            solver.as_ref(),
            &few,
            progress.stop(),
            &mut |_, _| {},
        );
        if by_cells {
            return most_likely(problem, &found, progress.stop())
                .ok()
                .map(|(found, _)| found);
        }
        Some(found)
    };
    profile::profiles(problem, found, solved, &again, progress.stop())
}

fn conclude(
    problem: &FitProblem<'_>,
    found: &Found,
    options: &Options,
    validation: Option<&Data>,
    solved: &Solved,
) -> Result<Fit, Error> {
    let (algorithm, cost) = (&options.algorithm, options.cost_name());
    Fit::of_solved(problem, algorithm, cost, found, options, validation, solved)
}

/// The search: from regression, from a second start, in wider ranges, with other forms, with shorter steps, each where the one
/// before leaves something to gain.
fn search_model<'a>(
    data: &'a Data,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Refined<'a>, Error> {
    let solver = solve::by_name(&options.algorithm)
        .ok_or_else(|| Error::Usage(format!("--algorithm {}: unknown", options.algorithm)))?;
    let mut problem = bounded_problem(data, options)?;
    own_parameters::check(&problem, options)?;
    let by_cells = interval::applies(&problem, options);
    if by_cells {
        // Least squares end near enough for its steps.
        problem.cost = Cost::Squared;
    }
    if options.profile {
        profile::check(&problem, options)?;
    }
    if options.certificate {
        certificate::check(&problem)?;
    }
    let mut found = search(&problem, solver.as_ref(), options, 0, progress);
    if let Some(start) = second_start(&problem, &found, options, progress) {
        let again = problem.begun_at(&start);
        let spent = found.evaluations;
        let better = search(&again, solver.as_ref(), options, spent, progress);
        if better.cost < found.cost {
            problem = again;
            found = better;
        }
    }
    // Each round has a wider range, up to what physics allows.
    while let Some(wider) = problem.structure.widened_at(&found.x) {
        if found.interrupted {
            break;
        }
        let start = wider.coordinates(&problem.structure.values(&found.x));
        let again = problem.with_structure(wider, start);
        let better = search(
            &again,
            solver.as_ref(),
            options,
            found.evaluations,
            progress,
        );
        if better.cost >= found.cost {
            break;
        }
        problem = again;
        found = better;
    }
    if !found.interrupted
        && let Some(again) = fit::forms::with_forms_free(&problem, &found)
    {
        let spent = found.evaluations;
        let freed = search(&again, solver.as_ref(), options, spent, progress);
        if fit::forms::earned(&problem, &found, &freed) {
            problem = again;
            found = freed;
        }
    }
    let ended = |problem: &FitProblem<'_>, found: Found| {
        if by_cells && !found.interrupted {
            return most_likely(problem, &found, progress.stop());
        }
        let solved = Solved::of(problem, &options.algorithm, &found)?;
        Ok((found, solved))
    };
    let (found, solved) = ended(&problem, found)?;
    let most = fit::integration::evaluations(&problem);
    let searched = Refined {
        problem,
        found,
        solved,
        left: None,
    };
    if options.algorithm != LEAST_SQUARES {
        return Ok(searched);
    }
    Ok(fit::integration::refined(searched, |finer, spent| {
        let few = Options {
            budget: options.budget.saturating_sub(spent).min(most),
            ..options.clone()
        };
        ended(finer, search(finer, solver.as_ref(), &few, spent, progress))
    }))
}

/// The problem that `options` state, with the bounds that they set; a start outside moves to the nearest bound.
///
/// # Errors
/// As [`identify()`].
pub fn bounded_problem<'a>(data: &'a Data, options: &Options) -> Result<FitProblem<'a>, Error> {
    data.check_told(options.effects.iter().copied())?;
    let mut problem = fit::problem(data, options)?;
    if options.bounds.is_empty() {
        return Ok(problem);
    }
    let start = problem.start.as_ref().map(|x| problem.structure.values(x));
    for bound in &options.bounds {
        bound.apply(&mut problem.structure)?;
    }
    problem.start = start.map(|values| problem.structure.coordinates(&values));
    Ok(problem)
}

fn search(
    problem: &FitProblem<'_>,
    solver: &dyn Solver,
    options: &Options,
    spent: usize,
    progress: &dyn Progress,
) -> Found {
    let mut observer = |count: usize, cost: f64| progress.evaluated(spent + count, cost);
    fit::search(problem, solver, options, progress.stop(), &mut observer)
}

/// Where least squares starts once more: it may have ended in another valley than the effects' own, since regression
/// knows nothing of most of them. The start that the caller knows, else the model that is reached by adding the effects
/// one by one. `None` where the first fit is at the encoder's floor.
fn second_start(
    problem: &FitProblem<'_>,
    found: &Found,
    options: &Options,
    progress: &dyn Progress,
) -> Option<Candidate> {
    let least_squares = options.algorithm == LEAST_SQUARES && problem.cost == Cost::Squared;
    if !least_squares || found.interrupted || !is_lost(found.cost, problem.data.len()) {
        return None;
    }
    options.start.or_else(|| {
        let budget = Budget::usual(progress.stop());
        built_up(problem.data, &options.effects, options, &budget)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use servoid_io::showcase;
    use servoid_plant::Hidden;
    use std::sync::atomic::AtomicBool;

    struct StoppedAtOnce(AtomicBool);

    impl Progress for StoppedAtOnce {
        fn stop(&self) -> &AtomicBool {
            &self.0
        }
    }

    #[test]
    fn a_search_that_was_stopped_before_its_first_model_is_an_error() {
        let friction = Hidden::typical("coulomb", &showcase::machine()).unwrap();
        let recording = showcase::record(std::slice::from_ref(&friction), 1, "bench").unwrap();
        let stopped = StoppedAtOnce(AtomicBool::new(true));
        let error = identify(&recording, &Options::default(), &stopped).unwrap_err();
        assert!(
            error.to_string().contains("no model with a finite cost"),
            "{error}"
        );
    }
}
