//! Profile likelihood: how much worse a fit becomes as one parameter is held away from its best value and all others follow.
//!
//! A standard error is a parabola. Where a parameter is curved in the others, or ends at zero, the profile says what the data allow.
//! Of least squares it is the sum of squares, scaled for each parameter so that it bends at its minimum as the standard error says: errors
//! that are correlated over time count once (R. E. Chandler and S. Bate, *Biometrika* 94(1), 167, 2007). Of the likelihood of the
//! cells it is twice the logarithm of the likelihood. The interval is where it rises by the 95 % point of χ² with one degree of
//! freedom (D. M. Bates and D. G. Watts, *Nonlinear Regression Analysis*, 1988, ch. 6).

use super::options::Options;
use super::report::Solved;
use crate::error::Error;
use crate::identify::LEAST_SQUARES;
use rayon::prelude::*;
use servoid_engine::problem::{FitProblem, Unknown};
use servoid_engine::solve::Found;
use shared::cost::Cost;
use std::sync::atomic::{AtomicBool, Ordering};

/// The 95 % point of χ² with one degree of freedom.
pub const RISE_95: f64 = 3.841_458_820_694_124;
/// The profile is drawn on to this.
const DRAWN: f64 = 9.0;
/// Distances of its points, standard errors; then each is so many times the last.
const DISTANCES: [f64; 6] = [0.5, 1.0, 1.5, 2.0, 2.5, 3.0];
const FARTHER: f64 = 1.5;
/// Most points to a side.
const MOST: usize = 16;
/// First distance where there is no standard error, as a part of the search range.
const PART_OF_RANGE: f64 = 1e-3;

/// The profile of one unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Name of the unknown.
    pub name: String,
    /// Unit symbol.
    pub unit: &'static str,
    /// Where the fit ended.
    pub best: f64,
    /// Its standard error, if it has one.
    pub std: Option<f64>,
    /// Values with the rise of the deviance there, in the order of the values.
    pub points: Vec<(f64, f64)>,
    /// Ends of the 95 % interval; `None` where the search range ends before.
    pub interval: [Option<f64>; 2],
}

/// Refuses what has no likelihood.
///
/// # Errors
/// [`Error::Usage`] for parameters of each recording, another search than least squares, and another cost.
pub(crate) fn check(problem: &FitProblem<'_>, options: &Options) -> Result<(), Error> {
    let why = if !options.own.is_empty() {
        "it is of one model; leave out --own"
    } else if options.algorithm != LEAST_SQUARES {
        "every point of it is a fit by least squares; leave out --algorithm"
    } else if problem.cost != Cost::Squared {
        "this cost is no likelihood; take --cost squared or interval"
    } else {
        return Ok(());
    };
    Err(Error::Usage(format!("--profile: {why}")))
}

/// The profile of each unknown that is no whole number and is not held. `fit` ends the search of a problem from its start.
pub(crate) fn profiles(
    problem: &FitProblem<'_>,
    found: &Found,
    solved: &Solved,
    fit: &(dyn Fn(&FitProblem<'_>) -> Option<Found> + Sync),
    stop: &AtomicBool,
) -> Vec<Profile> {
    let free =
        |(_, unknown): &(usize, &Unknown)| !unknown.whole && unknown.range.0 < unknown.range.1;
    let unknowns: Vec<usize> = (problem.structure.unknowns.iter().enumerate())
        .filter(free)
        .map(|(k, _)| k)
        .collect();
    let profile = |&k: &usize| {
        let search = Search {
            problem,
            k,
            best: found,
            fit,
            stop,
        };
        search.profile(solved)
    };
    unknowns.par_iter().filter_map(profile).collect()
}

struct Search<'s, 'a> {
    problem: &'s FitProblem<'a>,
    k: usize,
    best: &'s Found,
    fit: &'s (dyn Fn(&FitProblem<'_>) -> Option<Found> + Sync),
    stop: &'s AtomicBool,
}

/// The points to one side of the best value.
struct Side {
    sign: f64,
    /// Value and rise of the cost.
    points: Vec<(f64, f64)>,
    /// Where the last search ended, a point of the unit cube.
    x: Vec<f64>,
    /// Whether the range ends here, or nothing fits.
    ended: bool,
}

impl Search<'_, '_> {
    /// `None` where the user stopped it, and where nothing tells the scale.
    fn profile(&self, solved: &Solved) -> Option<Profile> {
        let unknown = &self.problem.structure.unknowns[self.k];
        let best = solved.values[self.k];
        let spread = solved.uncertainty.as_ref();
        let std = spread.and_then(|s| s.std(self.k));
        let std = std.filter(|std| *std > 0.0 && !unknown.ends_at(best));
        let unit = std.unwrap_or(PART_OF_RANGE * (unknown.range.1 - unknown.range.0));
        let mut sides = [-1.0, 1.0].map(|sign| Side {
            sign,
            points: Vec::new(),
            x: self.best.x.clone(),
            ended: false,
        });
        for side in &mut sides {
            self.step(side, best, DISTANCES[0] * unit);
        }
        let scale = if solved.reading_noise.is_some() {
            // The cost is minus the logarithm of a likelihood.
            2.0
        } else if std.is_some() {
            bend(&sides, best, unit)?
        } else {
            spread?.effective_samples / self.best.cost
        };
        for side in &mut sides {
            let mut farther = DISTANCES[DISTANCES.len() - 1];
            for number in 1..MOST {
                let high = side
                    .points
                    .last()
                    .is_some_and(|(_, rise)| scale * rise > DRAWN);
                if side.ended || high {
                    break;
                }
                let distance = DISTANCES.get(number).copied().unwrap_or_else(|| {
                    farther *= FARTHER;
                    farther
                });
                self.step(side, best, distance * unit);
            }
        }
        if self.stop.load(Ordering::Relaxed) {
            return None;
        }
        let interval = [0, 1].map(|side| crossing(&sides[side].points, best, scale));
        let [below, above] = sides;
        let points = (below.points.iter().rev())
            .chain([&(best, 0.0)])
            .chain(&above.points)
            .map(|&(value, rise)| (value, scale * rise))
            .collect();
        Some(Profile {
            name: unknown.name.clone(),
            unit: self.problem.data.drive.unit(unknown.unit),
            best,
            std,
            points,
            interval,
        })
    }

    /// Adds the point at `distance` from the best value, or at the end of the range.
    fn step(&self, side: &mut Side, best: f64, distance: f64) {
        if self.stop.load(Ordering::Relaxed) {
            side.ended = true;
            return;
        }
        let (low, high) = self.problem.structure.unknowns[self.k].range;
        let wanted = best + side.sign * distance;
        let value = wanted.clamp(low, high);
        side.ended = value != wanted;
        if value == best {
            return;
        }
        let mut structure = self.problem.structure.clone();
        structure.unknowns[self.k].confine((value, value));
        match (self.fit)(&self.problem.with_structure(structure, side.x.clone())) {
            Some(found) if found.cost.is_finite() => {
                side.points
                    .push((value, (found.cost - self.best.cost).max(0.0)));
                side.x = found.x;
            }
            _ => side.ended = true,
        }
    }
}

/// The factor with which the cost bends at its minimum as the standard error `unit` says. `None` where it does not bend.
fn bend(sides: &[Side], best: f64, unit: f64) -> Option<f64> {
    let rises: Vec<f64> = (sides.iter().flat_map(|side| &side.points))
        .map(|(value, rise)| rise / ((value - best) / unit).powi(2))
        .collect();
    let mean = rises.iter().sum::<f64>() / rises.len() as f64;
    (mean > 0.0).then(|| 1.0 / mean)
}

/// Where the rise passes the 95 % point, between two points on a straight line of its root. `None` where it does not.
fn crossing(points: &[(f64, f64)], best: f64, scale: f64) -> Option<f64> {
    let mut last = (best, 0.0);
    for &(value, rise) in points {
        let here = (value, (scale * rise).sqrt());
        let wanted = RISE_95.sqrt();
        if here.1 >= wanted {
            return Some(last.0 + (here.0 - last.0) * (wanted - last.1) / (here.1 - last.1));
        }
        last = here;
    }
    None
}
