//! From what the data determine to the six physical parameters, with the help of known facts.
//!
//! The machine in coordinates that the data and the facts can each speak about:
//! `ln R`, `ln Kt`, `D = Kb + b`, `m`, `τe`, and the viscous part `p = b/D`. The data say something
//! about `D`, `m`, `τe` (and sometimes `p`), each fact about one combination; what neither speaks
//! about stays in the null space of the normal equations, and every physical parameter that leans
//! on it is reported as undetermined. Gauss–Newton, since `J = m·Kt/R` and the like are products.

use crate::input::Known;
use nalgebra::{DMatrix, SMatrix, SVector};
use shared::motor::Machine;

/// Number of coordinates.
const N: usize = 6;
type Vector = SVector<f64, N>;
type Matrix = SMatrix<f64, N, N>;

/// A constant is a prior with this relative standard error.
const CONSTANT: f64 = 1e-9;
/// Information (in relative units) below which a direction is not determined: a standard error of
/// a thousand per cent.
const FLAT: f64 = 1e-2;

/// The six, in the order of `[known]`.
pub const NAMES: [(&str, &str); N] = [
    ("resistance", "ohm"),
    ("inductance", "H"),
    ("kt", "N*m/A"),
    ("kb", "V*s/rad"),
    ("inertia", "kg*m^2"),
    ("viscous", "N*m*s/rad"),
];

/// A value with its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Value, SI.
    pub value: f64,
    /// Standard error.
    pub std: f64,
}

/// What the data say: a machine, how well, and a resistance if the current was measured.
#[derive(Clone, Debug)]
pub struct Evidence {
    /// The machine that was fitted.
    pub machine: Machine<f64>,
    /// Covariance of `(D, m, τe)`, or of `(D, m, τe, p)` where the viscous part was fitted too.
    pub covariance: DMatrix<f64>,
    /// Resistance from measured current, Ω.
    pub resistance: Option<Estimate>,
}

/// What data and facts say together.
#[derive(Clone, Debug)]
pub struct Reconciled {
    /// Each of [`NAMES`], where it is determined.
    pub physical: [Option<Estimate>; N],
    /// Volts at the winding per newton metre on the shaft, `R/Kt`, where it is determined.
    pub volts_per_torque: Option<Estimate>,
    /// How far the facts pull the data's own values, in standard errors: above about five they
    /// contradict each other.
    pub strain: f64,
}

/// A statement that `model(u) = value`, give or take `std`.
struct Statement {
    model: Box<dyn Fn(&Vector) -> f64>,
    value: f64,
    std: f64,
}

fn physical(u: &Vector) -> [f64; N] {
    let (r, kt, total, m, lag, part) = (u[0].exp(), u[1].exp(), u[2], u[3], u[4], u[5]);
    [
        r,
        r * lag,
        kt,
        total * (1.0 - part),
        m * kt / r,
        part * total * kt / r,
    ]
}

/// Typical size of each coordinate, so that information is relative.
fn sizes(start: &Vector) -> Vector {
    let lag = start[4]
        .abs()
        .max(1e-3 * start[3].abs() / start[2].abs().max(f64::MIN_POSITIVE));
    Vector::from([1.0, 1.0, start[2].abs(), start[3].abs(), lag, 1.0])
        .map(|x| x.max(f64::MIN_POSITIVE))
}

fn gradient(model: &dyn Fn(&Vector) -> f64, u: &Vector, sizes: &Vector) -> Vector {
    Vector::from_fn(|k, _| {
        let step = 1e-6 * sizes[k];
        let (mut up, mut down) = (*u, *u);
        up[k] += step;
        down[k] -= step;
        (model(&up) - model(&down)) / 2e-6
    })
}

/// Statements of the facts.
fn facts(known: &Known, resistance: Option<Estimate>) -> Vec<Statement> {
    let mut statements = Vec::new();
    for (k, (_, fact)) in known.facts().into_iter().enumerate() {
        if let Some(fact) = fact {
            statements.push(Statement {
                model: Box::new(move |u| physical(u)[k]),
                value: fact.value,
                std: (fact.value.abs() * fact.tolerance.unwrap_or(0.0).max(CONSTANT)).max(1e-15),
            });
        }
    }
    if let Some(r) = resistance {
        statements.push(Statement {
            model: Box::new(|u| physical(u)[0]),
            value: r.value,
            std: r.std.max(CONSTANT * r.value),
        });
    }
    if known.kt_equals_kb {
        statements.push(Statement {
            model: Box::new(|u| {
                let p = physical(u);
                (p[2] / p[3].max(f64::MIN_POSITIVE)).ln()
            }),
            value: 0.0,
            std: CONSTANT,
        });
    }
    statements
}

/// Reconciles the evidence of the data with the known facts.
pub fn reconcile(evidence: &Evidence, known: &Known) -> Reconciled {
    let machine = &evidence.machine;
    let total = machine.kb + machine.damping;
    let part = if total > 0.0 {
        machine.damping / total
    } else {
        0.0
    };
    let resistance = known
        .resistance_ohm
        .map(|f| f.value)
        .or(evidence.resistance.map(|r| r.value));
    let kt = known.kt_n_m_a.map_or(total, |f| f.value);
    let start = Vector::from([
        resistance.unwrap_or(1.0).max(1e-12).ln(),
        kt.abs().max(1e-12).ln(),
        total,
        machine.inertia,
        machine.electrical,
        part,
    ]);
    let sizes = sizes(&start);
    let measured = start;
    let weight = data_information(&evidence.covariance, &sizes);
    let statements = facts(known, evidence.resistance);

    let mut u = start;
    let mut inverse = Matrix::zeros();
    let mut null = Vec::new();
    for _ in 0..30 {
        let mut information = weight;
        let mut pull = weight * (measured - u).component_div(&sizes);
        for statement in &statements {
            let slope = gradient(&*statement.model, &u, &sizes) / statement.std;
            information += slope * slope.transpose();
            pull += slope * ((statement.value - (statement.model)(&u)) / statement.std);
        }
        (inverse, null) = pseudo_inverse(&information);
        // Logarithms may be far off at the start: one unit a step at most.
        let step = (inverse * pull).map(|x| x.clamp(-1.0, 1.0));
        u += step.component_mul(&sizes);
        if step.norm() < 1e-13 {
            break;
        }
    }
    let estimate = |model: &dyn Fn(&Vector) -> f64| {
        let slope = gradient(model, &u, &sizes);
        let leans = null
            .iter()
            .any(|v: &Vector| slope.dot(v).abs() > 1e-6 * slope.norm());
        let variance = slope.dot(&(inverse * slope));
        let value = model(&u);
        let determined = !leans && value.is_finite() && variance.is_finite();
        determined.then(|| Estimate {
            value,
            std: variance.max(0.0).sqrt(),
        })
    };
    let pulled = (measured - u).component_div(&sizes);
    Reconciled {
        physical: std::array::from_fn(|k| estimate(&move |u| physical(u)[k])),
        volts_per_torque: estimate(&|u| (u[0] - u[1]).exp()),
        strain: pulled.dot(&(weight * pulled)).max(0.0).sqrt(),
    }
}

/// Information of the data about the coordinates, relative to their sizes.
fn data_information(covariance: &DMatrix<f64>, sizes: &Vector) -> Matrix {
    let rows = covariance.nrows().min(4);
    let relative = DMatrix::from_fn(rows, rows, |i, k| {
        let floor = if i == k { CONSTANT * CONSTANT } else { 0.0 };
        covariance[(i, k)] / (sizes[i + 2] * sizes[k + 2]) + floor
    });
    let mut information = Matrix::zeros();
    if let Some(inverse) = relative.try_inverse() {
        for i in 0..rows {
            for k in 0..rows {
                information[(i + 2, k + 2)] = inverse[(i, k)];
            }
        }
    }
    information
}

/// Inverse on the determined directions, and the directions that are not.
fn pseudo_inverse(information: &Matrix) -> (Matrix, Vec<Vector>) {
    // Constants carry 1e18 times the information of a weak measurement: balance the rows first, or
    // the eigenvectors of the weak directions drown in rounding.
    let balance = Vector::from_fn(|k, _| {
        let d = information[(k, k)];
        if d > FLAT { 1.0 / d.sqrt() } else { 1.0 }
    });
    let balanced = Matrix::from_fn(|i, k| information[(i, k)] * balance[i] * balance[k]);
    let eigen = balanced.symmetric_eigen();
    let mut inverse = Matrix::zeros();
    let mut null = Vec::new();
    for (value, vector) in eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
    {
        let direction = vector.component_mul(&balance);
        if *value > 1e-12 {
            inverse += direction * direction.transpose() / *value;
        } else {
            null.push(direction.normalize());
        }
    }
    (inverse, null)
}
