//! How far each unknown may go: two linear programs an unknown.

use super::ParameterBounds;
use super::centre::Centre;
use super::linearised::{Scale, above};
use super::program::{Goal, Program, Solution};
use crate::error::Error;
use rayon::prelude::*;
use servoid_engine::problem::FitProblem;

/// Rounds in which the room for what is not linear is found: a wider set is less linear.
const ROUNDS: usize = 4;
/// The bounds are stated where the readings are linear to this, counts: elsewhere the polytope is not the set.
const LINEAR: f64 = 0.25;
/// An edge of a cell is no more exact than this, counts: the events within a sample are located by arithmetic, too.
const EXACT: f64 = 1e-4;
/// What is not linear by less is not waited for, counts.
const LEAST_NONLINEARITY: f64 = 1e-6;
/// What remains of the integration error is less than so many times what half the step changes.
const INTEGRATION: f64 = 3.0;
/// A solution nearer than this part to the end of a range is at the end.
const AT_END: f64 = 1e-6;

/// The bounds of each unknown, and by how much the readings are not linear within them, counts.
pub fn bounds(
    problem: &FitProblem<'_>,
    scale: &Scale,
    centre: &Centre,
    integration: f64,
) -> Result<(Vec<ParameterBounds>, f64), Error> {
    let program = &centre.program(scale);
    let unknowns = &problem.structure.unknowns;
    let sides = (0..2 * unknowns.len()).into_par_iter();
    let exact = EXACT + INTEGRATION * integration;
    let ends = sides.map(|side| farthest(problem, program, side / 2, side % 2 == 1, exact));
    let ends: Vec<Option<End>> = ends.collect::<Result<_, _>>()?;
    let stated = ends.iter().flatten();
    let nonlinear = stated.fold(0.0, |most: f64, end| most.max(end.nonlinearity));
    let of_unknown = |(k, ends): (usize, &[Option<End>])| ParameterBounds {
        name: unknowns[k].name.clone(),
        unit: problem.data.drive.unit(unknowns[k].unit),
        low: ends[0].as_ref().map(|end| end.value),
        high: ends[1].as_ref().map(|end| end.value),
    };
    let searched = |(k, _): &(usize, &[Option<End>])| centre.range[*k].0 < centre.range[*k].1;
    let all = ends.chunks(2).enumerate().filter(searched).map(of_unknown);
    Ok((all.collect(), nonlinear))
}

/// The end of a parameter's interval.
struct End {
    value: f64,
    /// By how much the readings are not linear from the best model to here, counts.
    nonlinearity: f64,
}

/// The greatest value of an unknown, or the least, with which a model meets every reading to within `exact` counts. `None` where the
/// search range ends before, or the readings are not linear enough.
fn farthest(
    problem: &FitProblem<'_>,
    program: &Program<'_>,
    unknown: usize,
    greatest: bool,
    exact: f64,
) -> Result<Option<End>, Error> {
    let (low, high) = program.range[unknown];
    let mut within = exact + LEAST_NONLINEARITY;
    for _ in 0..ROUNDS {
        let goal = Goal::Farthest {
            unknown,
            greatest,
            within,
        };
        let Some(solution) = program.solve(goal).filter(|_| low < high) else {
            return Ok(None);
        };
        let step = solution.steps[unknown];
        let end = if greatest { high } else { low };
        if (end - step).abs() <= AT_END * end.abs() {
            return Ok(None);
        }
        let nonlinearity = nonlinearity(problem, program, &solution)?;
        if nonlinearity > LINEAR {
            return Ok(None);
        }
        if exact + nonlinearity <= within {
            let value = program.readings.values[unknown] + program.scale.units[unknown] * step;
            return Ok(Some(End {
                value,
                nonlinearity,
            }));
        }
        // A little more, since the wider set has its end further out.
        within = exact + 1.5 * nonlinearity;
    }
    Ok(None)
}

/// Largest distance between the model at a solution and its linear form, counts, about a common shift where one is free.
fn nonlinearity(
    problem: &FitProblem<'_>,
    program: &Program<'_>,
    solution: &Solution,
) -> Result<f64, Error> {
    let values = program
        .scale
        .moved(problem, &program.readings.values, &solution.steps);
    let linear = program.readings.at(&solution.steps, 0.0);
    let model = above(problem, &values)?;
    Ok(program.scale.apart(&model, &linear))
}
