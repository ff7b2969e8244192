//! A second opinion on an effect: the drive that it asks for as a curve of the variable that carries it, of no stated form. A torque
//! against positive rotation counts positive, as in every drawing of what a model misses.
//!
//! ```text
//! law = drive missing without the effect − drive missing with it,    found = law + drive missing with it
//! ```
//!
//! Both pass the same filter, and both are smoothed alike, by lines between knots beside the linear motor's own columns: a partial
//! residual (Larsen and McCleary, *Technometrics* 14, 781, 1972), by ordinary least squares. Where the found curve leaves its band
//! around the law, the law is not the whole story.

use super::equation::{Equation, dot, orthonormal, take_out};
use super::judge::independent_part;
use super::term::Place;
use nalgebra::{DMatrix, DVector};
use servoid_engine::problem::{Candidate, Data};
use shared::effects::Kind;
use std::f64::consts::TAU;

/// Knots on each side of zero, or in a revolution.
const KNOTS: usize = 10;
/// Fewest rows at a knot.
const FEWEST: f64 = 20.0;
/// Standard errors of a band of 95 %.
const BAND: f64 = 1.96;
/// Least part of an effect's variance that one variable carries, for a curve to say something.
const CARRIED: f64 = 0.5;
/// A curve that leaves its band by less than this part of the law's greatest size says nothing.
const NOTICED: f64 = 0.05;
/// Part of the curve that may be outside a band of 95 %, before the law is doubted.
const CHANCE: f64 = 0.2;

/// The variable that carries an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carrier {
    /// Speed, rad/s.
    Speed,
    /// Angle within the revolution, rad.
    Angle,
    /// Volts across the resistance.
    Current,
}

/// One point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// Value of the variable.
    pub at: f64,
    /// Drive that the law asks for there, V.
    pub law: f64,
    /// Drive that the recording asks for there, V.
    pub found: f64,
    /// Half of the band of 95 % around `found`, V.
    pub band: f64,
}

/// An effect beside the curve that was found without its form.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The effect.
    pub effect: Kind,
    /// What carries it.
    pub carrier: Carrier,
    /// Part of the effect's variance that this variable carries.
    pub carried: f64,
    /// The curve, by rising values of the variable.
    pub points: Vec<CurvePoint>,
}

impl Carrier {
    /// Each.
    pub const ALL: [Carrier; 3] = [Carrier::Speed, Carrier::Angle, Carrier::Current];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Carrier::Speed => "speed",
            Carrier::Angle => "angle",
            Carrier::Current => "current",
        }
    }

    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            Carrier::Speed => "rad/s",
            Carrier::Angle => "rad",
            Carrier::Current => "V",
        }
    }
}

impl Curve {
    /// Of each of some effects of a candidate, along a recording. `None` where the motor turned too little, or no variable alone
    /// carries the effect.
    pub fn of_each(data: &Data, candidate: &Candidate, effects: &[Kind]) -> Vec<Option<Curve>> {
        // A friction leaves out where the shaft may rest, so that the rows are the whole model's.
        let equation = Equation::new(data, candidate);
        let of = |&effect: &Kind| Curve::of(equation.as_ref()?, candidate, effect);
        effects.iter().map(of).collect()
    }

    fn of(equation: &Equation<'_>, candidate: &Candidate, effect: Kind) -> Option<Curve> {
        let left = asked(&equation.missing);
        let without = asked(&equation.missing_by(&candidate.without(effect))?);
        let law: Vec<f64> = without.iter().zip(&left).map(|(a, b)| a - b).collect();
        let curves = Carrier::ALL.iter().filter_map(|&carrier| {
            let (carried, points) = smoothed(equation, &law, &left, carrier)?;
            Some(Curve {
                effect,
                carrier,
                carried,
                points,
            })
        });
        curves
            .filter(|curve| curve.carried > CARRIED)
            .max_by(|a, b| a.carried.total_cmp(&b.carried))
    }

    /// What a candidate misses along each variable, as a curve of no stated form beside a law that gives nothing; none where the motor
    /// turned too little.
    pub fn missing(data: &Data, candidate: &Candidate) -> Vec<(Carrier, Vec<CurvePoint>)> {
        let Some(equation) = Equation::new(data, candidate) else {
            return Vec::new();
        };
        let left = asked(&equation.missing);
        let nothing = vec![0.0; left.len()];
        let along = |&carrier: &Carrier| {
            let (_, points) = smoothed(&equation, &nothing, &left, carrier)?;
            Some((carrier, points))
        };
        Carrier::ALL.iter().filter_map(along).collect()
    }

    /// The range of the variable in which the curve leaves its band, if that is more than chance and noticeable.
    pub fn leaves(&self) -> Option<[f64; 2]> {
        let size = self.points.iter().map(|p| p.law.abs()).fold(0.0, f64::max);
        let outside = self.points.iter().filter(|p| {
            let off = (p.found - p.law).abs();
            off > p.band && off > NOTICED * size
        });
        let outside: Vec<f64> = outside.map(|point| point.at).collect();
        let (first, last) = (outside.first()?, outside.last()?);
        let beyond_chance = outside.len() as f64 > CHANCE * self.points.len() as f64;
        beyond_chance.then_some([*first, *last])
    }
}

/// What the shaft is given is asked of the drive with the other sign.
fn asked(given: &[f64]) -> Vec<f64> {
    given.iter().map(|volts| -volts).collect()
}

/// Part of the law that the variable carries (not a number of no law), and both curves.
fn smoothed(
    equation: &Equation<'_>,
    law: &[f64],
    left: &[f64],
    carrier: Carrier,
) -> Option<(f64, Vec<CurvePoint>)> {
    let at = equation.along(carrier);
    let knots = knots(&at, carrier);
    if knots.len() < 3 {
        return None;
    }
    let mut columns: Vec<Vec<f64>> = vec![vec![0.0; at.len()]; knots.len()];
    for (row, &x) in at.iter().enumerate() {
        for (knot, weight) in weights(&knots, x, carrier) {
            columns[knot][row] = weight;
        }
    }
    let own = orthonormal(equation.linear());
    // The law's curve is told beside what a linear motor could give of it, which is told as nothing: what is left of the volts
    // is put to the law.
    let mut rest = left.to_vec();
    take_out(&own, &mut rest);
    let n = knots.len();
    let products = DMatrix::from_fn(n, n, |a, b| {
        dot(&columns[a], &columns[b]) + if a == b { 1e-9 } else { 0.0 }
    });
    let inverse = products.cholesky()?.inverse();
    let fitted = |target: &[f64]| -> DVector<f64> {
        &inverse * DVector::from_fn(n, |k, _| dot(&columns[k], target))
    };
    let (by_law, by_rest) = (fitted(law), fitted(&rest));
    let unexplained = |target: &[f64], by: &DVector<f64>| -> Vec<f64> {
        let row = |row: usize| {
            columns
                .iter()
                .zip(by.iter())
                .map(|(c, b)| c[row] * b)
                .sum::<f64>()
        };
        target.iter().enumerate().map(|(k, x)| x - row(k)).collect()
    };
    let off = unexplained(law, &by_law);
    let carried = 1.0 - dot(&off, &off) / dot(law, law);
    let noise = unexplained(&rest, &by_rest);
    let independent = independent_part(&noise);
    let square = dot(&noise, &noise) / noise.len() as f64 / independent;
    let rows = |knot: usize| columns[knot].iter().sum::<f64>();
    let points = (0..n).filter(|&k| rows(k) > FEWEST).map(|k| CurvePoint {
        at: knots[k],
        law: by_law[k],
        found: by_law[k] + by_rest[k],
        band: BAND * (square * inverse[(k, k)]).sqrt(),
    });
    let points: Vec<CurvePoint> = points.collect();
    (points.len() > 2).then_some((carried, points))
}

/// Values of the variable between which curves are straight: as many rows between each, on each side of zero, where friction jumps.
fn knots(at: &[f64], carrier: Carrier) -> Vec<f64> {
    if carrier == Carrier::Angle {
        let knots = 2 * KNOTS;
        return (0..knots).map(|k| TAU * k as f64 / knots as f64).collect();
    }
    let side = |sign: f64| {
        let mut values: Vec<f64> = at.iter().map(|x| sign * x).filter(|x| *x > 0.0).collect();
        values.sort_by(f64::total_cmp);
        let last = values.len().saturating_sub(1);
        let mut knots: Vec<f64> = (0..KNOTS)
            .filter(|_| last > 0)
            .map(|k| sign * values[last * k / (KNOTS - 1)])
            .collect();
        knots.dedup();
        knots
    };
    let mut knots = [side(-1.0), side(1.0)].concat();
    knots.sort_by(f64::total_cmp);
    knots.dedup();
    knots
}

/// The knots beside a value, with their weights.
fn weights(knots: &[f64], x: f64, carrier: Carrier) -> Vec<(usize, f64)> {
    let n = knots.len();
    if carrier == Carrier::Angle {
        let place = x / TAU * n as f64;
        let low = place.floor();
        let part = place - low;
        let low = low as usize % n;
        return vec![(low, 1.0 - part), ((low + 1) % n, part)];
    }
    let high = knots.partition_point(|&knot| knot <= x).clamp(1, n - 1);
    let (below, above) = (knots[high - 1], knots[high]);
    let part = ((x - below) / (above - below)).clamp(0.0, 1.0);
    // No line crosses zero: a friction jumps there.
    if below < 0.0 && above > 0.0 {
        let nearest = if x < 0.0 { high - 1 } else { high };
        return vec![(nearest, 1.0)];
    }
    vec![(high - 1, 1.0 - part), (high, part)]
}

impl Equation<'_> {
    /// The variable at the rows, as late as the volts.
    fn along(&self, carrier: Carrier) -> Vec<f64> {
        match carrier {
            Carrier::Speed => self.own[0].clone(),
            Carrier::Angle => {
                let angle = self.angle();
                angle.iter().map(|angle| angle.rem_euclid(TAU)).collect()
            }
            Carrier::Current => self.seen(&self.motion.current, Place::Voltage),
        }
    }
}
