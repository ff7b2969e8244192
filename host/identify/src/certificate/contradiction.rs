//! The fewest readings that no model meets: those that hold the best one back, less each without which none would be met either
//! (deletion filter: Chinneck and Dravnieks, *ORSA J. Computing* 3(2), 1991).

use super::centre::Centre;
use super::linearised::Scale;
use super::program::{Edge, Goal, Inequality};
use super::{Contradicting, TOLERANCE};
use servoid_engine::problem::FitProblem;

/// An inequality with less slack than this holds the best model back, counts.
const HOLDING: f64 = 1e-6;

/// The fewest readings that contradict each other about the best model.
pub fn fewest(problem: &FitProblem<'_>, scale: &Scale, centre: &Centre) -> Vec<Contradicting> {
    let program = centre.program(scale);
    let Some(solution) = program.solve(Goal::Room) else {
        return Vec::new();
    };
    let mut holding = program.holding(&solution, HOLDING);
    let contradict = |some: &[Inequality]| {
        let solution = program.solve_over(Goal::Room, some);
        solution.is_some_and(|solution| solution.room < -TOLERANCE)
    };
    if !contradict(&holding) {
        return Vec::new();
    }
    let mut at = 0;
    while at < holding.len() {
        let mut others = holding.clone();
        others.remove(at);
        if contradict(&others) {
            holding = others;
        } else {
            at += 1;
        }
    }
    holding.sort_by_key(|(sample, _)| *sample);
    let data = problem.data;
    let reading = |&(sample, edge): &Inequality| Contradicting {
        sample,
        time_s: data.time_s[sample],
        counts: data.counts[sample],
        above: edge == Edge::Upper,
    };
    holding.iter().map(reading).collect()
}
