//! `servoid paper`: the paper's table from its own digits, and its contest run again.

use super::model::range;
use super::report as page;
use crate::cli::PaperArgs;
use crate::error::Error;
use crate::session::Session;
use servoid_engine::compare::{self, Contest};
use servoid_engine::problem::{Candidate, Data, FitProblem};
use servoid_engine::solve::{self, Objective};
use servoid_identify::fit::margins::Loop;
use servoid_identify::paper::{self, Experiment, PRINTED, Variant};
use servoid_results::plot;
use servoid_results::report;
use servoid_results::report::html::Recordings;
use servoid_results::report::paper::{PrintedCosts, Round, Strong};
use servoid_results::schema::{self, contest::least_cost};
use shared::effects::EffectSet;
use std::path::Path;

/// The stronger methods and the budget that each gets: their point is to need few evaluations.
const STRONG: [&str; 4] = ["lm", "cmaes", "de", "nelder_mead"];
const STRONG_BUDGET: usize = 5000;

pub(super) fn run(session: &Session, args: &PaperArgs) -> Result<(), Error> {
    let bounds = range("--bounds", &args.bounds)?;
    if bounds.0 <= 0.0 {
        return Err(Error::Usage(format!(
            "--bounds {}: the lower bound must be above zero: a resistance or an inertia of nothing is no motor",
            args.bounds
        )));
    }
    if let Some(folder) = &args.plots
        && !folder.is_dir()
    {
        return Err(Error::Usage(format!(
            "--plots {}: no such folder; make it first",
            folder.display()
        )));
    }
    let drawing = args.plots.as_ref().map(|folder| folder.join("bode.svg"));
    let drawing = drawing.as_deref().map(|path| ("--plots", path));
    let outputs: Vec<_> = drawing
        .into_iter()
        .chain(page::output(&args.page))
        .collect();
    session.check_outputs(&outputs, &[])?;
    let data = Experiment {
        seconds: args.seconds,
        sample_s: args.sample,
    }
    .record()?;
    let population = usize::try_from(args.population).unwrap_or(usize::MAX);
    let budget = population.saturating_mul(usize::try_from(args.iterations).unwrap_or(usize::MAX));
    let seeds = session.seeds(args.seeds);

    let problems: Vec<(Variant, FitProblem<'_>)> = Variant::all()
        .map(|v| (v, paper::paper_problem(&data, v, bounds)))
        .collect();
    let contests: Vec<(Variant, Contest<'_>)> = problems
        .iter()
        .map(|(variant, problem)| {
            (
                *variant,
                Contest {
                    problem,
                    budget,
                    seeds: seeds.clone(),
                },
            )
        })
        .collect();
    let solvers = paper::solvers(population);
    let runs = (contests.len() * solvers.len() + STRONG.len()) as u64 * args.seeds;
    let bar = session.progress(runs, "paper");
    let rounds: Vec<Round<'_>> = contests
        .iter()
        .map(|(variant, contest)| Round {
            variant: *variant,
            truth_cost: truth_cost(contest.problem),
            rows: compare::run(contest, &solvers, session.stop(), &|| bar.inc(1)),
            contest,
        })
        .collect();
    let strong = strong(session, &data, &seeds, &|| bar.inc(1))?;
    bar.finish_and_clear();

    let json = report::paper::document(&rounds, &strong);
    if let Some(folder) = &args.plots {
        draw(folder, &rounds, &json, session)?;
    }
    let text = report::paper::text(&rounds, &strong, &printed_costs(&data));
    page::write(session, &args.page, None, &json, Recordings::default())?;
    session.deliver(&text, &json)
}

/// Cost of the true motor.
fn truth_cost(problem: &FitProblem<'_>) -> f64 {
    let values = PRINTED[0].values();
    let inside = problem
        .structure
        .unknowns
        .iter()
        .zip(values)
        .all(|(unknown, value)| (unknown.range.0..=unknown.range.1).contains(&value));
    if inside {
        problem.cost(&problem.structure.coordinates(&values))
    } else {
        f64::NAN
    }
}

/// What the paper's printed digits cost on our recording.
fn printed_costs(data: &Data) -> Vec<PrintedCosts> {
    PRINTED
        .iter()
        .map(|column| {
            let candidate = Candidate {
                machine: column.machine(),
                effects: EffectSet::default(),
                start_speed: 0.0,
                start_offset: 0.0,
            };
            let ours = Variant::all()
                .map(|variant| paper::paper_problem(data, variant, paper::BOX).cost_of(&candidate))
                .collect();
            PrintedCosts {
                algorithm: column.algorithm,
                printed: column.cost,
                ours,
            }
        })
        .collect()
}

/// The stronger methods on the same data in identifiable coordinates.
fn strong(
    session: &Session,
    data: &Data,
    seeds: &[u64],
    done: &(dyn Fn() + Sync),
) -> Result<Strong, Error> {
    let variant = Variant::all()
        .next()
        .ok_or_else(|| Error::Failed("no variant".to_owned()))?;
    let problem = paper::identifiable_problem(data, variant)
        .ok_or_else(|| Error::Failed("regression finds no start on the paper's step".to_owned()))?;
    let solvers: Vec<_> = STRONG
        .iter()
        .filter_map(|name| solve::by_name(name))
        .collect();
    let contest = Contest {
        problem: &problem,
        budget: STRONG_BUDGET,
        seeds: seeds.to_vec(),
    };
    let rows = compare::run(&contest, &solvers, session.stop(), done);
    Ok(Strong {
        budget: STRONG_BUDGET,
        rows,
    })
}

/// The Bode plot (true motor, the paper's three, our three) and the cost curves.
fn draw(
    folder: &Path,
    rounds: &[Round<'_>],
    json: &schema::Contest,
    session: &Session,
) -> Result<(), Error> {
    let mut loops: Vec<(String, Loop)> = PRINTED
        .iter()
        .map(|column| {
            let name = if column.cost.is_some() {
                "paper's "
            } else {
                ""
            };
            (
                format!("{name}{}", column.algorithm),
                Loop::from(&column.machine()),
            )
        })
        .collect();
    let Some(first) = rounds.first() else {
        return Ok(());
    };
    let structure = &first.contest.problem.structure;
    for row in &first.rows {
        if let Some(run) = row.typical().filter(|run| run.cost.is_finite()) {
            let machine = structure.candidate_at(&run.x).machine;
            loops.push((
                format!("our {} (median run)", row.algorithm),
                Loop::from(&machine),
            ));
        }
    }
    session.write_plot(&folder.join("bode.svg"), &plot::bode(&loops, 0.1, 1e3)?)?;
    // A round that the user stopped before its first run has no curves.
    for (round, variant) in (rounds.iter().zip(json.variants()))
        .filter(|(round, _)| least_cost(&round.rows).is_finite())
    {
        let name = format!(
            "cost-curves-{}.svg",
            round.variant.name().to_lowercase().replace(' ', "-")
        );
        let cost = format!("{}, deg s", round.variant.name());
        let drawing = plot::cost_curves(&variant.rows, json.budget, &cost)?;
        session.write_plot(&folder.join(name), &drawing)?;
    }
    Ok(())
}
