//! The model that leaves most room between the readings' edges, by a sequence of linear programs within a trust region.

use super::linearised::{Linearised, Scale, above};
use super::program::{Goal, Program};
use crate::error::Error;
use servoid_engine::problem::FitProblem;

/// First trust region, units.
const TRUST: f64 = 10.0;
/// Most linear programs.
const ROUNDS: usize = 12;
/// The room is known to this, counts.
const SETTLED: f64 = 1e-5;

/// The best model, and the readings about it.
pub struct Centre {
    /// The readings about the best model.
    pub readings: Linearised,
    /// How far each unknown may go from it, units.
    pub range: Vec<(f64, f64)>,
    /// Its distance from the nearest edge, counts; below zero where it violates one.
    pub room: f64,
    /// The start angle that leaves that room, counts from the fitted one.
    pub shift: f64,
}

impl Centre {
    /// The linear programs about it.
    pub fn program<'a>(&'a self, scale: &'a Scale) -> Program<'a> {
        Program {
            readings: &self.readings,
            scale,
            range: self.range.clone(),
        }
    }

    /// How many readings it reproduces.
    pub fn reproduced(&self) -> usize {
        let inside = |above: &&f64| (0.0..1.0).contains(&(**above + self.shift));
        self.readings.above.iter().filter(inside).count()
    }
}

/// Goes from the fitted `values` to the model with the most room.
pub fn centre(problem: &FitProblem<'_>, scale: &Scale, values: Vec<f64>) -> Result<Centre, Error> {
    let mut readings = Linearised::about(problem, scale, values)?;
    let (mut room, mut shift) = room_of(&readings.above, scale.shift);
    let mut trust = TRUST;
    for _ in 0..ROUNDS {
        let within = |(low, high): (f64, f64)| (low.max(-trust), high.min(trust));
        let program = Program {
            readings: &readings,
            scale,
            range: scale
                .room(problem, &readings.values)
                .into_iter()
                .map(within)
                .collect(),
        };
        let Some(solution) = program.solve(Goal::Room) else {
            break;
        };
        let values = scale.moved(problem, &readings.values, &solution.steps);
        let (reached, to) = room_of(&above(problem, &values)?, scale.shift);
        if reached <= room {
            trust *= 0.2;
            if solution.room - room < SETTLED {
                break;
            }
            continue;
        }
        let gained = reached - room;
        (room, shift) = (reached, to);
        readings = Linearised::about(problem, scale, values)?;
        if gained < SETTLED {
            break;
        }
    }
    Ok(Centre {
        range: scale.room(problem, &readings.values),
        readings,
        room,
        shift,
    })
}

/// Distance from the nearest edge, counts, and the shift that makes it largest where one is free.
fn room_of(above: &[f64], free: bool) -> (f64, f64) {
    let (low, high) = above
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &above| {
            (low.min(above), high.max(above))
        });
    if free {
        (0.5 * (1.0 - (high - low)), 0.5 * (1.0 - high - low))
    } else {
        (low.min(1.0 - high), 0.0)
    }
}
