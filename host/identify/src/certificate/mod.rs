//! The certificate of a fit: whether one motor reproduces every reading, and how far each of its parameters may go.
//!
//! A counter that rounds down makes two inequalities of a reading `n`: `n ≤ y(p) < n + 1` for the model's angle `y`, counts, with
//! parameters `p`. The models that meet all of them are a set, which is a polytope where `y` is linear in `p`; the set of a
//! noise-free recording is far smaller than any standard error says. Bounds of such a set by linear programming are bounded-error
//! identification (Milanese and Vicino, *Automatica* 27(6), 1991). Where no model meets them, the fewest readings that
//! already contradict each other are at most one more than there are unknowns (Helly's theorem).
//!
//! | file | holds |
//! |---|---|
//! | `linearised` | the readings as inequalities in the unknowns about a point |
//! | `program` | linear programs over them, by cutting planes |
//! | `centre` | the point that leaves most room, by a sequence of linear programs |
//! | `bounds` | how far each unknown may go |
//! | `contradiction` | the fewest readings that no model meets |

mod bounds;
mod centre;
mod contradiction;
mod linearised;
mod program;

use crate::error::Error;
use crate::fit::report::Solved;
use centre::{Centre, centre};
use linearised::{Scale, above};
use servoid_engine::problem::{FitProblem, Horizon};
use shared::discretise::Discretisation;

/// Readings are met to this, counts: the arithmetic of model and linear program is no better.
const TOLERANCE: f64 = 1e-6;

/// What is certain of a recording and a model.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// Number of readings.
    pub readings: usize,
    /// How many of them the best model reproduces.
    pub reproduced: usize,
    /// Distance of the best model from the nearest edge of any cell, counts. Below zero it is the least by which every model
    /// misses some reading.
    pub room_counts: f64,
    /// How far each unknown may go; empty where no model meets all readings.
    pub bounds: Vec<ParameterBounds>,
    /// By how much the readings are not linear in the parameters over these bounds, counts. The bounds have room for it.
    pub nonlinearity_counts: f64,
    /// By how much the readings change when the model's step is halved, counts. The bounds have room for it.
    pub integration_counts: f64,
    /// The fewest readings that no model meets together; empty where one meets all.
    pub contradiction: Vec<Contradicting>,
}

/// Beyond these any model contradicts a reading.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterBounds {
    /// Name of the unknown.
    pub name: String,
    /// Unit symbol.
    pub unit: &'static str,
    /// Least value; `None` where the search range ends before the readings say so.
    pub low: Option<f64>,
    /// Greatest value, likewise.
    pub high: Option<f64>,
}

/// A reading that contradicts others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contradicting {
    /// Sample.
    pub sample: usize,
    /// Its time, s.
    pub time_s: f64,
    /// The reading, counts.
    pub counts: f64,
    /// Whether models that meet the others lie above its cell; else below.
    pub above: bool,
}

impl Certificate {
    /// Whether a model meets every reading.
    pub fn is_feasible(&self) -> bool {
        self.room_counts >= -TOLERANCE
    }
}

/// Refuses what makes no inequalities.
///
/// # Errors
/// [`Error::Usage`] for an angle that is no whole count, several recordings, and windows.
pub fn check(problem: &FitProblem<'_>) -> Result<(), Error> {
    let why = if !problem.data.quantised {
        "the angle is no whole count, whose edges it needs"
    } else if problem.data.recordings.are_several() {
        "it is of one recording; give one"
    } else if problem.horizon != Horizon::Whole {
        "it is of the whole run; leave out --window"
    } else {
        return Ok(());
    };
    Err(Error::Usage(format!("--certificate: {why}")))
}

/// A model that misses a reading by less than this may be stepped too coarsely, counts.
const NEARLY: f64 = 0.1;
/// Steps are short enough where half of them change no reading by more, counts.
const STEPPED: f64 = 1e-4;
/// Most steps to a sample.
const FINEST: u16 = 32;

/// The certificate of a fitted problem. Where its model misses some readings by little, with shorter and shorter steps: the
/// integration error of a fit is small beside the readings' own and not beside a certificate's.
///
/// # Errors
/// Where the model cannot run.
pub(crate) fn certify(problem: &FitProblem<'_>, solved: &Solved) -> Result<Certificate, Error> {
    let values = solved.values.clone();
    let x = problem.structure.coordinates(&values);
    let mut problem = problem.with_structure(problem.structure.clone(), x);
    let scale = Scale::new(&problem, &values, solved.uncertainty.as_ref());
    let exact = problem.structure.effects.is_empty()
        || problem.method.discretisation != Discretisation::Exact;
    let mut centre = centre(&problem, &scale, values)?;
    let mut integration = 0.0;
    while !exact && centre.room > -NEARLY && problem.method.substeps < FINEST {
        problem.method.substeps = 2 * problem.method.substeps.max(1);
        integration = apart(&problem, &scale, &centre)?;
        centre = self::centre::centre(&problem, &scale, centre.readings.values)?;
        if centre.room >= 0.0 && integration < STEPPED {
            break;
        }
    }
    let (problem, centre) = (&problem, centre);
    let mut certificate = Certificate {
        readings: problem.data.len(),
        reproduced: centre.reproduced(),
        room_counts: centre.room,
        bounds: Vec::new(),
        nonlinearity_counts: 0.0,
        integration_counts: integration,
        contradiction: Vec::new(),
    };
    if certificate.is_feasible() {
        (certificate.bounds, certificate.nonlinearity_counts) =
            bounds::bounds(problem, &scale, &centre, integration)?;
    } else {
        certificate.contradiction = contradiction::fewest(problem, &scale, &centre);
    }
    Ok(certificate)
}

/// Largest change of a reading's model from `centre`, which was run with other steps, counts.
fn apart(problem: &FitProblem<'_>, scale: &Scale, centre: &Centre) -> Result<f64, Error> {
    let finer = above(problem, &centre.readings.values)?;
    Ok(scale.apart(&finer, &centre.readings.above))
}
