//! Linear programs over the readings. Of some thousand inequalities a dozen hold at the solution, so a program begins with few
//! and takes in those that its solution violates most, until none is violated (cutting planes: Kelley, *J. SIAM* 8(4), 1960).

use super::linearised::{Linearised, Scale};
use microlp::{ComparisonOp, LinearExpr, OptimizationDirection, Problem, Variable};

/// Stretches of the recording, each of which gives its worst reading at a time.
const STRETCHES: usize = 48;
/// Most rounds; a program of a dozen unknowns takes five.
const ROUNDS: usize = 60;
/// A violation that is smaller is none, counts.
const VIOLATED: f64 = 1e-8;
/// A start angle is no further from the fitted one, counts: any is allowed, and a linear program wants an end.
const FARTHEST_SHIFT: f64 = 1e6;
/// Bounds of the room, counts: half a cell is the most that there can be.
const ROOM: (f64, f64) = (-1e6, 0.5);

/// The edge of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// The model must not lie below it.
    Lower,
    /// The model must not lie above it.
    Upper,
}

/// One inequality: a reading and an edge of its cell.
pub type Inequality = (usize, Edge);

/// What is wanted.
#[derive(Clone, Copy, Debug)]
pub enum Goal {
    /// Most distance from every edge.
    Room,
    /// The greatest value of an unknown (or the least) where every reading is met to within so many counts.
    Farthest {
        unknown: usize,
        greatest: bool,
        within: f64,
    },
}

/// A solution.
#[derive(Clone, Debug)]
pub struct Solution {
    /// Steps of each unknown, units.
    pub steps: Vec<f64>,
    /// Shift of the start angle, counts.
    pub shift: f64,
    /// Distance from the nearest edge, counts; below zero where an edge is violated. Only of [`Goal::Room`].
    pub room: f64,
}

/// The inequalities of some readings and the search ranges.
pub struct Program<'a> {
    pub readings: &'a Linearised,
    pub scale: &'a Scale,
    /// How far each unknown may go, units.
    pub range: Vec<(f64, f64)>,
}

impl Program<'_> {
    /// Solves over all readings. `None` where no model meets them, or the arithmetic fails.
    pub fn solve(&self, goal: Goal) -> Option<Solution> {
        let mut taken = self.begun();
        for _ in 0..ROUNDS {
            let solution = self.solve_over(goal, &taken)?;
            let further = self.violated(goal, &solution, &taken);
            if further.is_empty() {
                return Some(solution);
            }
            taken.extend(further);
        }
        None
    }

    /// Solves over some inequalities.
    pub fn solve_over(&self, goal: Goal, taken: &[Inequality]) -> Option<Solution> {
        let mut problem = Problem::new(OptimizationDirection::Maximize);
        let wanted = |k: usize| match goal {
            Goal::Farthest {
                unknown, greatest, ..
            } if unknown == k => {
                if greatest {
                    1.0
                } else {
                    -1.0
                }
            }
            _ => 0.0,
        };
        let unknowns: Vec<Variable> = (self.range.iter().enumerate())
            .map(|(k, &range)| problem.add_var(wanted(k), range))
            .collect();
        let farthest = if self.scale.shift {
            FARTHEST_SHIFT
        } else {
            0.0
        };
        let shift = problem.add_var(0.0, (-farthest, farthest));
        let room = match goal {
            Goal::Room => problem.add_var(1.0, ROOM),
            Goal::Farthest { within, .. } => problem.add_var(0.0, (-within, -within)),
        };
        for &(k, edge) in taken {
            let mut row = LinearExpr::empty();
            for (&unknown, column) in unknowns.iter().zip(&self.readings.columns) {
                if column[k] != 0.0 {
                    row.add(unknown, column[k]);
                }
            }
            row.add(shift, 1.0);
            let above = self.readings.above[k];
            match edge {
                Edge::Lower => {
                    row.add(room, -1.0);
                    problem.add_constraint(row, ComparisonOp::Ge, -above);
                }
                Edge::Upper => {
                    row.add(room, 1.0);
                    problem.add_constraint(row, ComparisonOp::Le, 1.0 - above);
                }
            }
        }
        let solution = problem.solve().ok()?.into_solution().ok()?;
        Some(Solution {
            steps: unknowns.iter().map(|&v| solution.var_value(v)).collect(),
            shift: solution.var_value(shift),
            room: solution.var_value(room),
        })
    }

    /// The inequalities that hold with equality at a solution of [`Goal::Room`].
    pub fn holding(&self, solution: &Solution, slack: f64) -> Vec<Inequality> {
        let above = self.readings.at(&solution.steps, solution.shift);
        let mut all = Vec::new();
        for (k, above) in above.iter().enumerate() {
            if above - solution.room < slack {
                all.push((k, Edge::Lower));
            }
            if 1.0 - above - solution.room < slack {
                all.push((k, Edge::Upper));
            }
        }
        all
    }

    /// The lowest and the highest reading of each stretch.
    fn begun(&self) -> Vec<Inequality> {
        let nothing = Solution {
            steps: vec![0.0; self.range.len()],
            shift: 0.0,
            room: f64::INFINITY,
        };
        self.worst(&nothing, f64::INFINITY, &[])
    }

    /// The inequality of each stretch and edge that a solution violates most.
    fn violated(&self, goal: Goal, solution: &Solution, taken: &[Inequality]) -> Vec<Inequality> {
        let room = match goal {
            Goal::Room => solution.room,
            Goal::Farthest { within, .. } => -within,
        };
        self.worst(solution, room - VIOLATED, taken)
    }

    /// Of each stretch and edge the reading with the least distance, where that is below `limit` and it is not taken yet.
    fn worst(&self, solution: &Solution, limit: f64, taken: &[Inequality]) -> Vec<Inequality> {
        let above = self.readings.at(&solution.steps, solution.shift);
        let stretch = above.len().div_ceil(STRETCHES).max(1);
        let mut all = Vec::new();
        for (first, stretch) in above
            .chunks(stretch)
            .enumerate()
            .map(|(i, s)| (i * stretch, s))
        {
            for edge in [Edge::Lower, Edge::Upper] {
                let distance = |above: f64| match edge {
                    Edge::Lower => above,
                    Edge::Upper => 1.0 - above,
                };
                let least = (stretch.iter().enumerate())
                    .map(|(k, &above)| (first + k, distance(above)))
                    .min_by(|a, b| a.1.total_cmp(&b.1));
                let Some((k, distance)) = least else { continue };
                if distance < limit && !taken.contains(&(k, edge)) {
                    all.push((k, edge));
                }
            }
        }
        all
    }
}
