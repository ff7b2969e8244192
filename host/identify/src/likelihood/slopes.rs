//! Gradient and Fisher information of the likelihood, by differences of the innovations.

use super::huber::HUBER;
use super::objective::{Evaluated, Objective};
use super::parameters::{Coordinate, Scale};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// How differences are taken.
#[derive(Clone, Copy, Debug)]
pub(super) struct Differences {
    /// To one side, at half the cost.
    pub(super) forward: bool,
    /// Width, of the usual one.
    pub(super) width: f64,
}

impl Differences {
    /// For a search from afar.
    pub(super) const COARSE: Differences = Differences {
        forward: true,
        width: 2.0,
    };
    /// For its end.
    pub(super) const FINE: Differences = Differences {
        forward: false,
        width: 1.0,
    };
    /// For the curvature, over the corners that reversals make in the likelihood of friction.
    pub(super) const WIDE: Differences = Differences {
        forward: false,
        width: 10.0,
    };
}

/// Derivatives of innovations and of the logarithms of their variances by one coordinate, for each innovation.
#[derive(Clone, Debug)]
struct Slope {
    error: Vec<f64>,
    log_variance: Vec<f64>,
}

/// The score of every innovation, and sums of them.
#[derive(Clone, Debug)]
pub(super) struct Slopes {
    /// Part of each innovation in the gradient, one column a coordinate, per unit of it.
    pub(super) scores: Vec<Vec<f64>>,
    /// Sum of the scores with the prior's part.
    pub(super) gradient: DVector<f64>,
    /// `Σ ε′·ε′ᵀ/S + ½·(ln S)′·(ln S)′ᵀ` with the prior's part.
    pub(super) information: DMatrix<f64>,
}

/// At `here`; `None` where a model nearby cannot run.
pub(super) fn slopes(
    objective: &Objective<'_>,
    here: &Evaluated,
    coordinates: &[(Coordinate, Scale)],
    differences: Differences,
) -> Option<Slopes> {
    let each: Vec<Slope> = coordinates
        .par_iter()
        .map(|(c, scale)| slope(objective, here, *c, scale, differences))
        .collect::<Option<_>>()?;
    let count = coordinates.len();
    let mut information = DMatrix::zeros(count, count);
    let mut scores = vec![Vec::with_capacity(objective.count()); count];
    let mut weighted = vec![0.0; count];
    for (k, (error, variance)) in here.each().enumerate() {
        let square = error * error / variance;
        let weight = if square < HUBER * HUBER {
            1.0
        } else {
            HUBER / square.sqrt()
        };
        for (i, slope) in each.iter().enumerate() {
            let (e, s) = (slope.error[k], slope.log_variance[k]);
            scores[i].push(e * weight * error / variance + 0.5 * s * (1.0 - weight * square));
            weighted[i] = e * weight / variance;
            for (j, other) in each[..=i].iter().enumerate() {
                information[(i, j)] +=
                    weighted[i] * other.error[k] + 0.5 * s * other.log_variance[k];
            }
        }
    }
    let mut gradient = DVector::from_iterator(count, scores.iter().map(|s| s.iter().sum::<f64>()));
    for (i, (c, scale)) in coordinates.iter().enumerate() {
        let weight = objective.prior_weight(*c) * scale.unit;
        gradient[i] += c.get(&here.parameters) * weight;
        information[(i, i)] += weight * scale.unit;
        for j in 0..i {
            information[(j, i)] = information[(i, j)];
        }
    }
    (information
        .iter()
        .chain(gradient.iter())
        .all(|x| x.is_finite()))
    .then_some(Slopes {
        scores,
        gradient,
        information,
    })
}

fn slope(
    objective: &Objective<'_>,
    here: &Evaluated,
    c: Coordinate,
    scale: &Scale,
    differences: Differences,
) -> Option<Slope> {
    let at = |units: f64| {
        let mut p = here.parameters.clone();
        let moved = scale.moved(c, &mut p, units);
        (moved, objective.at(p, Some(here)))
    };
    let (up, above) = at(differences.width * scale.difference);
    // At a bound the difference is to one side.
    let below = (!differences.forward)
        .then(|| at(-differences.width * scale.difference))
        .filter(|(moved, _)| *moved < 0.0);
    let (down, below) = match &below {
        Some((down, below)) => (*down, below),
        None => (0.0, here),
    };
    let width = up - down;
    if width == 0.0 || !above.cost.is_finite() || !below.cost.is_finite() {
        return None;
    }
    let pairs = || above.each().zip(below.each());
    Some(Slope {
        error: pairs().map(|(a, b)| (a.0 - b.0) / width).collect(),
        log_variance: pairs().map(|(a, b)| libm::log(a.1 / b.1) / width).collect(),
    })
}
